//! What a hand keeps, tuned, saved and compared by scripts, on a hand in another process, over every wire.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Ended, Running, run, sim_on_all};
use nix::sys::signal::Signal;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A simulated hand on four wires, and a folder for files and records.
struct Bench {
    folder: tempfile::TempDir,
    sim: Running,
    wires: [String; 4],
}

impl Bench {
    fn new(quirks: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let quirks = quirks.iter().flat_map(|quirk| ["--quirk", quirk]);
        let (sim, wires) = sim_on_all(folder.path(), &quirks.collect::<Vec<_>>());
        let wires = wires.all().map(str::to_owned);
        Self { folder, sim, wires }
    }

    fn rs485(&self) -> &str {
        let of_kind = |wire: &&String| wire.starts_with("rs485:");
        self.wires.iter().find(of_kind).unwrap()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self, rows: &str) -> PathBuf {
        let path = self.path("wanted.toml");
        let text = format!("format = \"handscope-params\"\nversion = 1\n{rows}\n");
        std::fs::write(&path, text).unwrap();
        path
    }

    fn params(&self, hand: &str, args: &[&str]) -> Ended {
        let records = self.path("records");
        let records = records.to_str().unwrap();
        let common = ["--hand", hand, "--json", "--folder", records];
        run(&[&["params"], args, &common].concat())
    }

    fn words(&self, hand: &str, args: &[&str]) -> Ended {
        let records = self.path("records");
        let records = records.to_str().unwrap();
        run(&[&["params"], args, &["--hand", hand, "--folder", records]].concat())
    }

    fn power_cycle(&mut self) {
        self.sim.signal(Signal::SIGUSR1);
        self.sim.until(|line| line == "power cycled");
    }
}

fn json(ended: &Ended) -> Value {
    ended.lines().pop().expect("one object")
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn rows(object: &Value) -> Vec<(String, String)> {
    let rows = object["rows"].as_array().unwrap().iter();
    let word = |value: &Value| value.as_str().unwrap().to_owned();
    rows.map(|row| (word(&row["name"]), word(&row["verdict"])))
        .collect()
}

const GENTLE: &str = "[default_speed]\nindex = 150\nmiddle = 150\n[default_force]\nindex = 300";

#[test]
fn what_is_saved_wakes_up_and_what_is_not_does_not_and_diff_proves_it_over_every_wire() {
    unless_busy(|| {
        for nth in 0..4 {
            let mut bench = Bench::new(&[]);
            let hand = bench.wires[nth].clone();
            let wanted = bench.file(GENTLE);

            let applied = json(&bench.params(&hand, &["apply", text(&wanted)]).ok());
            assert_eq!(applied["applied"], true, "{hand} {applied}");
            assert_eq!(rows(&applied).len(), 3);
            assert!(
                rows(&applied)
                    .iter()
                    .all(|(_, verdict)| verdict == "applied")
            );
            bench.params(&hand, &["diff", text(&wanted)]).ok();
            bench.power_cycle();
            let lost = bench.params(&hand, &["diff", text(&wanted)]);
            assert_eq!(lost.code, Some(1), "what is not saved is gone");
            assert_eq!(json(&lost)["differences"], 3);

            bench.params(&hand, &["apply", text(&wanted)]).ok();
            let saved = json(&bench.params(&hand, &["save", "--yes"]).ok());
            let expected = if hand.starts_with("rs485:") {
                "confirmed"
            } else {
                "read_back"
            };
            assert_eq!(saved["result"], expected, "{hand}");
            bench.power_cycle();
            let woken = json(&bench.params(&hand, &["diff", "--saved"]).ok());
            assert_eq!(woken["differences"], 0, "{hand}");
            bench.params(&hand, &["diff", text(&wanted)]).ok();
            let live = json(&bench.params(&hand, &["dump"]).ok());
            assert_eq!(live["params"]["default_force.index"], 300);
            // The hand's own limits follow its defaults at power-up.
            let speeds = run(&["read", "SPEED_SET", "--json", "--hand", &hand]).ok();
            assert_eq!(json(&speeds)["SPEED_SET"][3], 150);
            // Nothing moved: no angle was written, and the hand is open as it was.
            let pose = run(&["read", "ANGLE_ACT", "--json", "--hand", &hand]).ok();
            let open = json(&pose);
            let open = open["ANGLE_ACT"].as_array().unwrap();
            assert!(
                open.iter().all(|angle| angle.as_i64().unwrap() > 900),
                "{open:?}"
            );
        }
    });
}

#[test]
fn a_dump_is_a_file_that_brings_the_hand_back_and_leaves_alone_where_it_is() {
    unless_busy(|| {
        let bench = Bench::new(&[]);
        let hand = bench.rs485();
        let dump = bench.path("dump.toml");
        let told = json(&bench.params(hand, &["dump", "--out", text(&dump)]).ok());
        assert_eq!(told["params"]["hand_id"], 1);
        assert_eq!(told["params"]["ip_address"], "192.168.11.210");
        bench
            .params(hand, &["apply", text(&bench.file(GENTLE))])
            .ok();
        let other = std::fs::read_to_string(&dump).unwrap();
        std::fs::write(&dump, other.replace("hand_id = 1", "hand_id = 9")).unwrap();
        let back = bench.words(hand, &["apply", text(&dump), "--yes"]).ok();
        assert!(
            back.err
                .contains("unchanged: hand_id (9 in the file, 1 in the hand)"),
            "{}",
            back.err
        );
        let diff = json(&bench.params(hand, &["diff", text(&dump)]));
        assert_eq!(diff["rows"].as_array().unwrap().len(), 1, "{diff}");
    });
}

#[test]
fn what_hits_hard_or_moves_the_hand_elsewhere_needs_a_yes_and_says_why() {
    unless_busy(|| {
        let bench = Bench::new(&[]);
        let hand = bench.rs485();
        // What hits less hard than before needs none.
        bench
            .params(hand, &["apply", text(&bench.file(GENTLE))])
            .ok();
        for (rows, more, words) in [
            (
                "[default_speed]\nindex = 900",
                &[][..],
                "index would start with speed 900",
            ),
            (
                "[default_force]\nring = 2500",
                &[],
                "above the rated grip of 2000 g",
            ),
            (
                "ip_address = \"10.0.0.9\"",
                &["--only", "ip_address"],
                "the hand may be found elsewhere",
            ),
        ] {
            let path = bench.file(rows);
            let args = [&["apply", text(&path)], more].concat();
            let ended = bench.words(hand, &args);
            assert_eq!(ended.code, Some(2), "{}", ended.err);
            assert!(
                ended.err.contains(words) && ended.err.contains("--yes"),
                "{}",
                ended.err
            );
            assert!(ended.err.contains("nothing was written"), "{}", ended.err);
        }
        let elsewhere = bench.file("hand_id = 9");
        for bus in bench.wires.iter().filter(|hand| !hand.starts_with("tcp:")) {
            let ended = bench.words(bus, &["apply", text(&elsewhere), "--only", "hand_id"]);
            assert_eq!(ended.code, Some(2), "{bus}");
            assert!(ended.err.contains("hand_id becomes 9"), "{}", ended.err);
        }
        for command in ["save", "reset"] {
            let ended = bench.words(hand, &[command]);
            assert_eq!(ended.code, Some(2));
            assert!(ended.err.contains("--yes") && ended.err.contains("nothing was written"));
        }
        let gentle = bench.file(GENTLE);
        bench.params(hand, &["diff", text(&gentle)]).ok();
        let live = json(&bench.params(hand, &["diff", "--factory"]).ok());
        assert_eq!(live["differences"], 0);
    });
}

#[test]
fn a_bad_file_is_told_by_its_field_and_nothing_is_written() {
    unless_busy(|| {
        let bench = Bench::new(&[]);
        let hand = bench.rs485();
        for (rows, words) in [
            (
                "[default_speed]\nindex = 1001\nring = 100",
                "`default_speed.index`: 1001 is not a whole number from 0 to 1000",
            ),
            ("[default_speed]\nindex = 1.5", "`default_speed.index`: 1.5"),
            ("hand_id = 0", "`hand_id`: 0"),
            ("crew = 3", "it is empty"),
            ("crew = ", "line 3"),
            ("hand_id = 1", "holds no speeds or forces"),
        ] {
            let path = bench.file(rows);
            let ended = bench.words(hand, &["apply", text(&path), "--yes"]);
            assert_eq!(ended.code, Some(1), "{rows}");
            assert!(ended.err.contains(words), "{}", ended.err);
            assert!(ended.err.contains("nothing was written"), "{}", ended.err);
        }
        let ended = bench.words(hand, &["apply", text(&bench.path("none.toml"))]);
        assert!(
            ended.code == Some(1) && ended.err.contains("there is no such file"),
            "{}",
            ended.err
        );
        let none = bench.words(hand, &["diff", "--saved"]);
        assert!(
            none.code == Some(1) && none.err.contains("has no confirmed save"),
            "{}",
            none.err
        );
        for wrong in [&["diff"][..], &["apply"], &["apply", "x", "--only", "warp"]] {
            assert_eq!(bench.words(hand, wrong).code, Some(2), "{wrong:?}");
        }
    });
}

#[test]
fn what_the_hand_does_not_take_is_told_row_by_row_and_the_rest_is_put_back() {
    unless_busy(|| {
        for (quirk, verdict, modbus_verdict) in [
            ("defaults=drop", "dropped", "dropped"),
            ("defaults=clamp", "altered", "altered"),
            ("defaults=exception", "dropped", "refused"),
        ] {
            let mut bench = Bench::new(&[quirk]);
            for hand in &bench.wires.clone() {
                bench.power_cycle();
                let before = json(&bench.params(hand, &["dump"]).ok());
                let path = bench.file("[default_speed]\nindex = 600\n[default_force]\nring = 450");
                let ended = bench.params(hand, &["apply", text(&path), "--yes"]);
                assert_eq!(ended.code, Some(1), "{hand} {quirk}");
                let told = json(&ended);
                let is_modbus = hand.starts_with("tcp:") || hand.starts_with("rtu:");
                let expected = if is_modbus { modbus_verdict } else { verdict };
                let (name, got) = rows(&told).remove(0);
                assert_eq!(
                    (name.as_str(), got.as_str()),
                    ("default_speed.index", expected),
                    "{hand} {quirk}"
                );
                // A hand that clamps cannot be brought back to 1000, and that is said; the others hold what they held.
                let after = json(&bench.params(hand, &["dump"]).ok());
                assert_eq!(
                    told["undone"] == true,
                    after["params"] == before["params"],
                    "{hand} {quirk} {told}"
                );
            }
        }
    });
}

#[test]
fn the_result_of_a_save_the_file_and_the_hand_agree_whatever_the_hand_says() {
    unless_busy(|| {
        for (quirk, result, code, wakes_up) in [
            ("save-result=command-11", "confirmed", 0, true),
            ("save-result=twice", "confirmed", 0, true),
            ("save-result=failed", "failed", 1, false),
            ("save-result=never", "unknown: no result", 1, true),
        ] {
            let mut bench = Bench::new(&[quirk]);
            let hand = bench.rs485().to_owned();
            bench
                .params(&hand, &["apply", text(&bench.file(GENTLE))])
                .ok();
            let ended = bench.params(&hand, &["save", "--yes"]);
            assert_eq!(ended.code, Some(code), "{quirk} {}", ended.err);
            assert_eq!(json(&ended)["result"], result, "{quirk}");
            let listed = json(&bench.params(&hand, &["backups"]).ok());
            let backups = listed["backups"].as_array().unwrap();
            assert_eq!(backups.last().unwrap()["why"], "before save");
            assert_eq!(listed["saved"].is_object(), code == 0, "{quirk} {listed}");
            assert_eq!(
                listed["doubtful"].is_object(),
                result.starts_with("unknown"),
                "{quirk}"
            );
            bench.power_cycle();
            let diff = bench.params(&hand, &["diff", text(&bench.path("wanted.toml"))]);
            assert_eq!(diff.code == Some(0), wakes_up, "{quirk}");
        }
    });
}

#[test]
fn a_reset_makes_a_backup_that_brings_everything_back() {
    unless_busy(|| {
        for nth in 0..4 {
            let bench = Bench::new(&[]);
            let hand = &bench.wires[nth];
            bench
                .params(hand, &["apply", text(&bench.file(GENTLE))])
                .ok();
            bench.params(hand, &["save", "--yes"]).ok();
            let reset = json(&bench.params(hand, &["reset", "--yes"]).ok());
            assert_eq!(reset["result"], "acknowledged", "{hand}");
            assert_eq!(reset["params"]["default_force.index"], 1000);
            let saved = bench.params(hand, &["diff", "--saved"]);
            assert_eq!(
                saved.code,
                Some(1),
                "what was saved is not in flash any more"
            );
            let backup = reset["backup"].as_str().unwrap();
            bench.params(hand, &["apply", backup]).ok();
            bench
                .params(hand, &["diff", text(&bench.path("wanted.toml"))])
                .ok();
        }
    });
}

#[test]
fn a_new_id_is_followed_kept_if_saved_and_gone_with_the_power_if_not() {
    unless_busy(|| {
        // A hand takes its time to write its flash and to wake up.
        std::thread::scope(|scope| {
            for kind in ["rs485:", "rtu:", "slcan:"] {
                scope.spawn(move || check_new_id(kind));
            }
        });
    });
}

fn check_new_id(kind: &str) {
    let mut bench = Bench::new(&[]);
    let hand = bench.wires.iter().find(|hand| hand.starts_with(kind));
    let hand = hand.unwrap().clone();
    let path = bench.file("hand_id = 9");
    let args = ["apply", text(&path), "--only", "hand_id", "--yes"];
    let moved = json(&bench.params(&hand, &args).ok());
    assert_eq!(moved["rows"][0]["verdict"], "moved", "{moved}");
    let place = moved["answers_at"].as_str().unwrap().to_owned();
    assert!(place.contains("id=9"), "{place}");
    let why = |bench: &Bench, place: &str| {
        let listed = json(&bench.params(place, &["backups"]).ok());
        let last = listed["backups"].as_array().unwrap().last().cloned();
        last.map(|backup| backup["why"].clone())
    };
    let taken_along = Some(Value::from("before apply"));
    assert_eq!(why(&bench, &place), taken_along, "{kind}");
    bench.power_cycle();
    bench.params(&hand, &["dump"]).ok();
    bench.params(&hand, &args).ok();
    bench.params(&place, &["save", "--yes"]).ok();
    bench.power_cycle();
    let kept = json(&bench.params(&place, &["dump"]).ok());
    assert_eq!(kept["params"]["hand_id"], 9, "{kind}");
    // The reset brings the factory's id back, and the hand is found there.
    let reset = json(&bench.params(&place, &["reset", "--yes"]).ok());
    assert_eq!(reset["params"]["hand_id"], 1, "{kind}");
    let again = reset["answers_at"].as_str().unwrap();
    assert!(!again.contains("id=9"), "{again}");
    let taken_along = Some(Value::from("before reset"));
    assert_eq!(why(&bench, again), taken_along, "{kind}");
}

#[test]
fn an_id_that_another_hand_has_or_that_waits_for_a_save_is_told() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, wires) = sim_on_all(folder.path(), &["--id", "1,9"]);
        let path = folder.path().join("id.toml");
        std::fs::write(
            &path,
            "format = \"handscope-params\"\nversion = 1\nhand_id = 9\n",
        )
        .unwrap();
        let records = folder.path().join("records");
        let common = [
            "--json",
            "--folder",
            text(&records),
            "--only",
            "hand_id",
            "--yes",
        ];
        let ended = run(&[
            &["params", "apply", text(&path), "--hand", &wires.rs485][..],
            &common,
        ]
        .concat());
        assert_eq!(ended.code, Some(1));
        assert_eq!(json(&ended)["rows"][0]["verdict"], "occupied");
        assert!(ended.err.contains("another hand answers"), "{}", ended.err);
        let unchanged = run(&["read", "HAND_ID", "--json", "--hand", &wires.rs485]).ok();
        assert_eq!(json(&unchanged)["HAND_ID"], 1);

        let bench = Bench::new(&["id-effect=after-save", "change-ack=none"]);
        let path = bench.file("hand_id = 9");
        let args = ["apply", text(&path), "--only", "hand_id", "--yes"];
        let waits = json(&bench.params(bench.rs485(), &args).ok());
        assert_eq!(waits["rows"][0]["verdict"], "waits", "{waits}");
        let place = waits["answers_at"].as_str().unwrap();
        assert!(
            place.starts_with(bench.rs485()) && !place.contains("id=9"),
            "{place}"
        );
    });
}

#[test]
fn the_example_of_the_manual_is_a_file_that_is_taken_whole() {
    unless_busy(|| {
        let page = include_str!("../../../assets/manual/files.md");
        let section = page.split("## Parameters\n").nth(1).unwrap();
        let example = section.split("```").nth(1).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("example.toml");
        std::fs::write(&file, example.strip_prefix("toml").unwrap()).unwrap();
        let ended = run(&["params", "diff", text(&file), "--json", "--hand", "sim:"]);
        assert_eq!(ended.code, Some(1), "it differs: {}", ended.err);
        assert_eq!(json(&ended)["differences"], 7, "{}", ended.out);
    });
}
