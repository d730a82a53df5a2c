//! What `params` says when a hand ignores what it was told, when others of its rows cannot be applied, and when a person or the
//! system ends the command half-way: always what the hand holds.

use crate::setup::between::{Asked, Fate, between};
use crate::setup::busy::unless_busy;
use crate::setup::process::{Ended, Running, handscope, listen, run, sim_on_tcp, start};
use nix::sys::signal::Signal;
use serde_json::Value;
use std::process::Stdio;
use std::sync::mpsc::{Receiver, Sender, channel};

const SPEEDS: u16 = 1032;
const INDEX_SPEED: u16 = 1038;
const INDEX_FORCE: u16 = 1050;
const SAVE: u16 = 1005;
const RESET: u16 = 1006;

/// A hand behind a wire, and a folder for files and records.
struct Bench {
    folder: tempfile::TempDir,
    _sim: Running,
    direct: String,
    hand: String,
}

impl Bench {
    fn new(fate: impl FnMut(Asked) -> Fate + Send + 'static) -> Self {
        let (sim, direct) = sim_on_tcp(&[]);
        Self {
            folder: tempfile::tempdir().unwrap(),
            hand: between(&direct, fate),
            _sim: sim,
            direct,
        }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().unwrap().into()
    }

    fn file(&self, rows: &str) -> String {
        let text = format!("format = \"handscope-params\"\nversion = 1\n{rows}\n");
        let path = self.path("wanted.toml");
        std::fs::write(&path, text).unwrap();
        path
    }

    fn args<'a>(&'a self, args: &[&'a str], records: &'a str) -> Vec<&'a str> {
        [
            &["params"],
            args,
            &["--hand", &self.hand, "--folder", records],
        ]
        .concat()
    }

    fn params(&self, args: &[&str]) -> Ended {
        run(&self.args(args, &self.path("records")))
    }

    /// What the hand itself holds in the speeds after power-up.
    fn speeds(&self) -> Vec<i64> {
        let read = run(&[
            "read",
            "DEFAULT_SPEED_SET",
            "--json",
            "--hand",
            &self.direct,
        ])
        .ok();
        let speeds = read.lines().pop().unwrap();
        let speeds = speeds["DEFAULT_SPEED_SET"].as_array().unwrap().clone();
        speeds.iter().map(|speed| speed.as_i64().unwrap()).collect()
    }
}

const GENTLE: &str = "[default_speed]\nindex = 150\n[default_force]\nindex = 300";
const OF_DELIVERY: [i64; 6] = [1000; 6];
const TUNED: [i64; 6] = [1000, 1000, 1000, 150, 1000, 1000];

#[test]
fn a_reset_that_was_taken_ignored_or_not_read_back_are_told_apart() {
    unless_busy(|| {
        type Fates = fn(&mut bool, Asked) -> Fate;
        let passes: Fates = |_, _| Fate::Passed;
        let ignored: Fates = |_, asked| match asked {
            (true, RESET) => Fate::Ignored,
            _ => Fate::Passed,
        };
        let unread: Fates = |is_reset, asked| match asked {
            (true, RESET) => {
                *is_reset = true;
                Fate::Passed
            }
            (false, SPEEDS) if *is_reset => Fate::Refused,
            _ => Fate::Passed,
        };
        let other_address = "ip_address = \"10.0.0.9\"";
        for (rows, fates, outcome, code, words) in [
            (GENTLE, passes, "done", 0, "reset (acknowledged)"),
            (GENTLE, ignored, "unchanged", 1, "holds what it held before"),
            (
                other_address,
                ignored,
                "ignored",
                1,
                "still holds other values than the factory's in ip_address",
            ),
            (
                GENTLE,
                unread,
                "not_known",
                1,
                "not everything could be read back",
            ),
        ] {
            let mut is_reset = false;
            let bench = Bench::new(move |asked| fates(&mut is_reset, asked));
            let only = [
                "--only",
                "default_speed",
                "--only",
                "default_force",
                "--only",
                "ip_address",
            ];
            let file = bench.file(rows);
            bench
                .params(&[&["apply", &file, "--yes"], &only[..]].concat())
                .ok();
            let ended = bench.params(&["reset", "--yes", "--json"]);
            assert_eq!(ended.code, Some(code), "{outcome} {}", ended.err);
            let told = ended.lines().pop().unwrap();
            assert_eq!(told["outcome"], outcome, "{told}");
            assert!(told["words"].as_str().unwrap().contains(words), "{told}");
            assert_eq!(ended.err.contains(words), code != 0, "{}", ended.err);
            let is_tuned = bench.speeds() == TUNED;
            assert_eq!(
                is_tuned,
                rows == GENTLE && outcome == "unchanged",
                "{outcome}"
            );
        }
    });
}

#[test]
fn a_row_that_was_put_back_is_told_as_the_hand_holds_it() {
    unless_busy(|| {
        // The forces are refused: the speed is put back, or the hand ignores that it should be.
        for (ignores_undo, verdict, holds) in [(false, "put_back", 1000), (true, "applied", 150)] {
            let mut writes = 0;
            let bench = Bench::new(move |asked| match asked {
                (true, INDEX_FORCE) => Fate::Refused,
                (true, INDEX_SPEED) => {
                    writes += 1;
                    match ignores_undo && writes > 1 {
                        true => Fate::Ignored,
                        false => Fate::Passed,
                    }
                }
                _ => Fate::Passed,
            });
            let file = bench.file(GENTLE);
            let ended = bench.params(&["apply", &file, "--json"]);
            assert_eq!(ended.code, Some(1), "{}", ended.err);
            let told = ended.lines().pop().unwrap();
            let row = &told["rows"][0];
            assert_eq!(row["name"], "default_speed.index", "{told}");
            assert_eq!(
                (&row["verdict"], &row["holds"]),
                (&verdict.into(), &holds.into()),
                "{told}"
            );
            assert_eq!(told["undone"], !ignores_undo, "{told}");
            assert_eq!(bench.speeds()[3], holds, "as the hand has it");
            if !ignores_undo {
                let words = bench.params(&["apply", &file]);
                let told = words.out.lines().next().unwrap();
                assert!(
                    told.contains("put back") && told.contains("holds 1000"),
                    "{told}"
                );
            }
        }
    });
}

/// A hand whose wire stops at one request until the test lets it go on.
fn stopping_at(at: Asked) -> (Bench, Receiver<()>, Sender<()>) {
    let ((reached, is_reached), (go, goes)) = (channel(), channel::<()>());
    let mut is_over = false;
    let bench = Bench::new(move |asked| {
        if asked == at && !std::mem::replace(&mut is_over, true) {
            reached.send(()).unwrap();
            // A test that is over lets go, too.
            let _gone = goes.recv();
        }
        Fate::Passed
    });
    (bench, is_reached, go)
}

#[test]
fn a_signal_lets_a_write_end_and_tells_what_the_hand_holds_a_second_one_does_not_wait() {
    unless_busy(|| {
        use Signal::{SIGHUP, SIGINT, SIGTERM};
        let rows: [(&[&str], Asked, Signal, bool, &str); 7] = [
            (
                &["apply", "FILE"],
                (true, INDEX_SPEED),
                SIGINT,
                false,
                "holds 150",
            ),
            (
                &["apply", "FILE"],
                (true, INDEX_SPEED),
                SIGTERM,
                false,
                "holds 150",
            ),
            (
                &["apply", "FILE"],
                (true, INDEX_SPEED),
                SIGHUP,
                false,
                "holds 150",
            ),
            (
                &["apply", "FILE"],
                (true, INDEX_SPEED),
                SIGINT,
                true,
                "what the hand holds is unknown",
            ),
            (
                &["save", "--yes"],
                (true, SAVE),
                SIGINT,
                false,
                "saved as far as this wire tells",
            ),
            (
                &["save", "--yes"],
                (true, SAVE),
                SIGTERM,
                true,
                "not known whether the parameters are in flash",
            ),
            (
                &["reset", "--yes"],
                (true, RESET),
                SIGINT,
                true,
                "not known whether the hand was reset",
            ),
        ];
        for (args, at, signal, is_twice, words) in rows {
            let (bench, is_reached, go) = stopping_at(at);
            let (file, records) = (bench.file(GENTLE), bench.path("records"));
            let args: Vec<&str> = args
                .iter()
                .map(|arg| if *arg == "FILE" { &*file } else { *arg })
                .collect();
            let mut command = start(&bench.args(&args, &records));
            is_reached.recv().unwrap();
            command.signal(signal);
            while !command.complaint().contains("finished first") {}
            if is_twice {
                command.signal(signal);
                let ended = command.end();
                assert_eq!(ended.code, Some(1), "{args:?}");
                assert!(
                    ended.err.contains("ended at once") && ended.err.contains(words),
                    "{}",
                    ended.err
                );
                drop(go);
            } else {
                go.send(()).unwrap();
                let ended = command.end().ok();
                assert!(ended.out.contains(words), "{args:?} {}", ended.out);
            }
            if args[0] == "apply" && !is_twice {
                assert_eq!(bench.speeds(), TUNED);
            }
        }
    });
}

#[test]
fn a_signal_before_the_first_write_ends_the_command_and_nothing_is_written() {
    unless_busy(|| {
        for args in [
            &["apply", "FILE"][..],
            &["save", "--yes"],
            &["reset", "--yes"],
        ] {
            let (bench, is_reached, go) = stopping_at((false, SPEEDS));
            let (file, records) = (bench.file(GENTLE), bench.path("records"));
            let args: Vec<&str> = args
                .iter()
                .map(|arg| if *arg == "FILE" { &*file } else { *arg })
                .collect();
            let command = start(&bench.args(&args, &records));
            is_reached.recv().unwrap();
            command.signal(Signal::SIGINT);
            let ended = command.end();
            assert_eq!(ended.code, Some(1), "{args:?}");
            assert!(
                ended.err.contains("before anything was written"),
                "{}",
                ended.err
            );
            drop(go);
            assert_eq!(bench.speeds(), OF_DELIVERY);
        }
    });
}

#[test]
fn where_nobody_reads_the_result_it_is_told_on_standard_error() {
    unless_busy(|| {
        let bench = Bench::new(|_| Fate::Passed);
        let (file, records) = (bench.file(GENTLE), bench.path("records"));
        let mut command = handscope();
        command.args(bench.args(&["apply", &file], &records));
        // A pipe that nobody reads any more.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let child = command
            .stdout(writer)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let ended = child.wait_with_output().unwrap();
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.success(), "{said}");
        assert!(said.contains("holds 150"), "{said}");
        assert_eq!(bench.speeds(), TUNED);
    });
}

#[test]
fn an_id_that_is_being_changed_stays_where_a_signal_comes_before_the_write() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hand) = crate::setup::process::sim_on_link(&folder.path().join("hand"), &[]);
        let file = folder.path().join("id.toml");
        std::fs::write(
            &file,
            "format = \"handscope-params\"\nversion = 1\nhand_id = 9\n",
        )
        .unwrap();
        let records = folder.path().join("records");
        let mut command = handscope();
        command.args([
            "params",
            "apply",
            file.to_str().unwrap(),
            "--only",
            "hand_id",
            "--yes",
        ]);
        command.args(["--hand", &hand, "--folder", records.to_str().unwrap()]);
        let command = listen(command);
        // The backup is there; whether another hand has the id is found out for three seconds.
        while !std::fs::read_dir(&records).is_ok_and(|mut hands| hands.next().is_some()) {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        command.signal(Signal::SIGTERM);
        let ended = command.end();
        assert_eq!(ended.code, Some(1));
        assert!(
            ended.err.contains("before anything was written"),
            "{}",
            ended.err
        );
        let id = run(&["read", "HAND_ID", "--json", "--hand", &hand]).ok();
        assert_eq!(id.lines()[0]["HAND_ID"], Value::from(1));
    });
}
