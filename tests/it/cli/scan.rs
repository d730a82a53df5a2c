//! `scan` as scripts meet it: hands in other processes, on pseudo-terminals and on loopback, and every wrong word.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Ended, run, sim_on_link, sim_on_rtu, sim_on_tcp, start};
use nix::sys::signal::Signal;
use serde_json::Value;
use std::collections::BTreeSet;
use std::net::TcpListener;
use std::path::Path;
use std::time::Duration;

/// A wrong word is answered this soon, on a machine with other work too.
const SOON: Duration = Duration::from_secs(3);

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The hands that a `scan --json` found, and its summary, which is the last line.
fn hands(ended: &Ended) -> (BTreeSet<String>, Value) {
    let mut lines = ended.lines();
    let summary = lines.pop().unwrap()["summary"].take();
    let hands: BTreeSet<String> = lines
        .iter()
        .filter_map(|line| line["hand"]["url"].as_str())
        .map(str::to_owned)
        .collect();
    assert_eq!(summary["found"], hands.len());
    (hands, summary)
}

#[test]
fn three_hands_are_found_on_every_wire_and_each_can_be_read() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let (rs485, rtu, slcan) = (path("rs485"), path("rtu"), path("slcan"));
        let mut sim = start(&[
            "sim",
            "--id",
            "1,2,3",
            "--tcp",
            "127.0.0.1:0",
            "--rs485",
            text(&rs485),
            "--rtu",
            text(&rtu),
            "--slcan",
            text(&slcan),
        ]);
        let tcp = sim.line();
        let tcp = tcp.strip_prefix("ready tcp ").expect(&tcp).to_owned();
        (0..3).for_each(|_| drop(sim.line()));
        let ended = run(&[
            "scan",
            "--json",
            "--ids",
            "1-4",
            "--serial",
            text(&rs485),
            "--serial",
            text(&rtu),
            "--slcan",
            text(&slcan),
            "--tcp",
            &tcp,
        ])
        .ok();
        let (found, summary) = hands(&ended);
        let mut wanted = BTreeSet::from([format!("tcp:{tcp}?unit=255")]);
        for id in 1..=3 {
            wanted.insert(format!("rs485:{}?baud=115200&id={id}", text(&rs485)));
            wanted.insert(format!("rtu:{}?baud=115200&id={id}", text(&rtu)));
            wanted.insert(format!("slcan:{}?bitrate=1000000&id={id}", text(&slcan)));
        }
        assert_eq!(found, wanted);
        assert_eq!(summary["complete"], true);
        assert_eq!(
            (&summary["places"], &summary["failed"]),
            (&4.into(), &0.into())
        );
        assert_eq!(ended.err, "");
        for hand in &found {
            run(&["read", "HAND_ID", "--hand", hand]).ok();
        }
    });
}

#[test]
fn a_range_of_addresses_finds_the_one_hand_and_says_nothing_of_the_rest() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--id", "9"]);
        let port = hand.rsplit(':').next().unwrap();
        let ended = run(&["scan", "--json", "--tcp", &format!("127.0.0.0/29:{port}")]).ok();
        let (found, summary) = hands(&ended);
        assert_eq!(found, BTreeSet::from([format!("{hand}?unit=255")]));
        assert_eq!(summary["places"], 6);
        assert_eq!(ended.lines()[0]["hand"]["hand_id"], 9);
        assert_eq!(ended.err, "");
        let ended = run(&["scan", "--tcp", &format!("127.0.0.1:{port}")]).ok();
        assert_eq!(ended.out.lines().count(), 1);
        assert!(
            ended
                .out
                .starts_with(&format!("{hand}?unit=255  HAND_ID 9"))
        );
    });
}

#[test]
fn a_hand_that_was_scanned_for_was_never_written_to() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("hand");
        let (_sim, hand) = sim_on_link(&link, &["--id", "5"]);
        let names = ["ANGLE_SET", "FORCE_SET", "SPEED_SET", "HAND_ID", "IP_PART4"];
        let values = || {
            let hand = format!("{hand}?id=5");
            let args = [&["read", "--json", "--hand", &hand], &names[..]].concat();
            run(&args).ok().out
        };
        let before = values();
        let (found, _) =
            hands(&run(&["scan", "--json", "--ids", "4-9", "--serial", text(&link)]).ok());
        assert_eq!(found.len(), 1);
        assert_eq!(values(), before);
    });
}

#[test]
fn nobody_there_is_no_failure_and_is_said() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("hand");
        let (_sim, _) = sim_on_rtu(&link, &["--id", "7"]);
        let ended = run(&["scan", "--ids", "1", "--serial", text(&link)]).ok();
        assert_eq!(ended.out, "");
        assert!(
            ended.err.contains("no hand answered (8 questions"),
            "{}",
            ended.err
        );
        let nobody = TcpListener::bind("127.0.0.1:0")
            .unwrap()
            .local_addr()
            .unwrap();
        let ended = run(&["scan", "--json", "--tcp", &nobody.to_string()]).ok();
        let lines = ended.lines();
        assert_eq!(lines[0]["trouble"]["place"], nobody.to_string());
        assert!(
            lines[0]["trouble"]["words"]
                .as_str()
                .unwrap()
                .contains("refused")
        );
        assert_eq!(lines[1]["summary"]["found"], 0);
    });
}

#[test]
fn what_cannot_be_looked_at_is_one_sentence_and_the_rest_is_looked_at() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "x").unwrap();
        for (args, words) in [
            (
                ["--serial", "/nowhere/ttyUSB0"],
                "/nowhere/ttyUSB0 is not there",
            ),
            (["--serial", text(folder.path())], "is not a serial port"),
            (["--slcan", text(&file)], "is not a serial port"),
            (["--tcp", "no-such-host.invalid"], "could not be resolved"),
            (
                ["--can", "nocan9"],
                if cfg!(target_os = "linux") {
                    "nocan9"
                } else {
                    "need Linux"
                },
            ),
        ] {
            let ended = run(&["scan", args[0], args[1]]);
            assert_eq!(ended.code, Some(1), "{args:?}: {}", ended.err);
            assert!(ended.err.contains(words), "{args:?}: {}", ended.err);
            assert_eq!(ended.err.lines().count(), 1, "{args:?}: {}", ended.err);
            assert!(ended.took < SOON, "{args:?}: {:?}", ended.took);
            assert_eq!(ended.out, "");
        }
        let link = folder.path().join("hand");
        let (_sim, _) = sim_on_link(&link, &[]);
        let ended = run(&[
            "scan",
            "--serial",
            "/nowhere",
            "--serial",
            text(&link),
            "--ids",
            "1,2",
        ])
        .ok();
        assert!(ended.out.contains("HAND_ID 1"), "{}", ended.out);
        assert!(ended.err.contains("/nowhere is not there"), "{}", ended.err);
    });
}

#[test]
fn a_port_that_another_program_holds_is_said_to_be_busy() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("hand");
        let (_sim, hand) = sim_on_link(&link, &[]);
        let mut watch = start(&["watch", "--json", "--hand", &hand]);
        watch.line();
        let ended = run(&["scan", "--serial", text(&link)]);
        assert_eq!(ended.code, Some(1));
        assert!(ended.err.contains("is in use by"), "{}", ended.err);
        watch.line();
    });
}

#[test]
fn wrong_usage_is_one_sentence_and_two() {
    unless_busy(|| {
        for (args, words) in [
            (&["--ids", "0"][..], "numbers from 1 to 254"),
            (&["--ids", "5-1"], "write 1-5"),
            (&["--ids", "1,1"], "named twice"),
            (&["--ids", "1", "--all-ids"], "cannot be used with"),
            (&["--tcp", ""], "is not a host"),
            (&["--tcp", "127.0.0.0/8"], "more than 1024 addresses"),
            (&["--tcp", "127.0.0.1/x"], "is not an address range"),
            (&["--tcp", "127.0.0.1:0"], "'0' is not a port"),
            (
                &["--tcp", "127.0.0.0/22", "--tcp", "127.0.4.0/22"],
                "at most 1024",
            ),
            (&["--serial", ""], "a value is required"),
            (&["/dev/ttyUSB0"], "unexpected argument"),
        ] {
            let ended = run(&[&["scan"], args].concat());
            assert_eq!(ended.code, Some(2), "{args:?}: {}", ended.err);
            assert!(ended.err.contains(words), "{args:?}: {}", ended.err);
            assert!(ended.took < SOON, "{args:?}: {:?}", ended.took);
            assert_eq!(ended.out, "");
        }
    });
}

#[test]
fn ctrl_c_ends_a_long_scan_at_once_with_what_was_found() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (link, empty) = (folder.path().join("hand"), folder.path().join("empty"));
        let (_sim, hand) = sim_on_link(&link, &["--id", "3"]);
        let (_other, _) = sim_on_rtu(&empty, &["--id", "250"]);
        let mut scan = start(&[
            "scan",
            "--json",
            "--serial",
            text(&link),
            "--serial",
            text(&empty),
            "--ids",
            "3,5-249",
        ]);
        assert!(scan.line().contains("id=3"));
        scan.signal(Signal::SIGINT);
        let ended = scan.end().ok();
        let (found, summary) = hands(&ended);
        assert_eq!(found.len(), 1);
        assert_eq!(summary["complete"], false);
        assert_eq!(summary["took_s"], Value::Null);
        // The ports are free again.
        run(&["read", "HAND_ID", "--hand", &format!("{hand}?id=3")]).ok();
        let scan = start(&["scan", "--serial", text(&empty), "--ids", "1-200"]);
        std::thread::sleep(Duration::from_millis(500));
        scan.signal(Signal::SIGINT);
        let ended = scan.end();
        assert_eq!(ended.code, Some(1));
        assert!(
            ended.err.contains("before it found a hand"),
            "{}",
            ended.err
        );
        assert!(ended.took < SOON, "{:?}", ended.took);
    });
}
