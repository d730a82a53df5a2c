//! The simulated hand on a pseudo-terminal and on TCP, read by the other commands: both wires tell the same.

use crate::setup::busy::unless_busy;
use crate::setup::process::{
    Ended, Running, run, sim_on_all, sim_on_link, sim_on_rtu, sim_on_tcp, start,
};
use serde_json::Value;
use std::time::Duration;

/// Runs of which one must be undisturbed.
const RUNS: usize = 6;

/// One hand on both wires: the process and its two endpoints.
fn both(folder: &tempfile::TempDir) -> (Running, [String; 2]) {
    let (sim, wires) = sim_on_all(folder.path(), &[]);
    (sim, [wires.tcp, wires.rs485])
}

/// Checks a whole `watch --json` and gives its statistics. Timeouts, and the reconnects that come of several in a row,
/// are for the caller to judge.
fn lossless(ended: &Ended) -> Value {
    let mut lines = ended.lines();
    let stats = lines.pop().unwrap()["stats"].take();
    assert_eq!(stats["state_reads"], lines.len(), "each read is a line");
    for key in ["checksum_errors", "dropped_samples", "refusals", "writes"] {
        assert_eq!(stats[key], 0, "{key}: {stats}");
    }
    let times: Vec<f64> = lines
        .iter()
        .map(|line| line["t_s"].as_f64().unwrap())
        .collect();
    assert!(
        times.windows(2).all(|pair| pair[0] < pair[1]),
        "time goes on"
    );
    stats
}

/// Watches each hand at the same time. A process that gets no processor for 50 ms is a timeout, and this machine has
/// other work: of a few runs, one must be without.
fn watch_all(hands: &[String; 2], more: &[&str]) -> [Ended; 2] {
    for _ in 0..RUNS {
        let watches = hands
            .each_ref()
            .map(|hand| start(&[&["watch", "--json", "--hand", hand], more].concat()));
        let ended = watches.map(|watch| watch.end().ok());
        let stats = ended.each_ref().map(lossless);
        if stats.iter().all(|stats| stats["timeouts"] == 0) {
            let again = stats.each_ref().map(|stats| &stats["reconnects"]);
            assert_eq!(again, [0, 0], "nothing was lost, and nothing came back");
            return ended;
        }
    }
    panic!("no run of {RUNS} was without timeouts");
}

#[test]
fn both_wires_at_once_agree_and_lose_nothing() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hands) = both(&folder);
        let [one, other] = watch_all(&hands, &["--for", "1"]).map(|ended| {
            let mut lines = ended.lines();
            let stats = lines.pop().unwrap()["stats"].take();
            assert!(stats["state_reads"].as_u64().unwrap() > 30, "{stats}");
            assert!(stats["tactile_reads"].as_u64().unwrap() > 5, "{stats}");
            lines.pop().unwrap()
        });
        for line in [&one, &other] {
            assert_eq!(line["tactile"].as_array().unwrap().len(), 5);
            assert_eq!(line["tactile"][4]["finger"], "thumb");
            assert_eq!(line["tactile"][4]["check_ok"], true);
            assert_eq!(line["temp_c"].as_array().unwrap().len(), 6);
            assert_eq!(line["grip"]["fingers"][4]["finger"], "thumb");
            assert!(line["grip"]["state"].is_string(), "{line}");
        }
        for key in [
            "angle",
            "status",
            "status_raw",
            "faults",
            "error_raw",
            "current_ma",
        ] {
            assert_eq!(one[key], other[key], "{key}");
        }
    });
}

#[test]
fn full_rate_loses_nothing_either() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hands) = both(&folder);
        for ended in watch_all(&hands, &["--for", "0.5", "--full-rate"]) {
            let stats = lossless(&ended);
            assert!(stats["state_reads"].as_u64().unwrap() > 60, "{stats}");
        }
    });
}

#[test]
fn every_register_reads_the_same_over_both_wires() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hands) = both(&folder);
        let rows: Vec<Value> =
            serde_json::from_str(&run(&["registers", "--json"]).ok().out).unwrap();
        let names: Vec<&str> = rows
            .iter()
            .map(|row| row["name"].as_str().unwrap())
            .collect();
        let [tcp, rs485] = hands.map(|hand| {
            let args = [&["read", "--json", "--hand", &hand], &names[..]].concat();
            run(&args).ok().lines().remove(0)
        });
        for row in &rows {
            let name = row["name"].as_str().unwrap();
            let (one, other) = (&tcp[name], &rs485[name]);
            assert!(!one.is_null(), "{name}");
            let measured =
                row["kept"] == "live" && !["ANGLE_ACT", "STATUS", "ERROR"].contains(&name);
            if !measured {
                assert_eq!(one, other, "{name}");
            } else if row["element"] == "tactile" {
                assert_eq!(one["finger"], other["finger"], "{name}");
            } else {
                assert_eq!(one.as_array().unwrap().len(), 6, "{name}");
                assert_eq!(other.as_array().unwrap().len(), 6, "{name}");
            }
        }
        assert_eq!(tcp["HAND_ID"], 1);
        assert_eq!(tcp["IP_PART4"], 210);
    });
}

#[test]
fn read_prints_a_line_a_register_in_the_order_asked() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--id", "7"]);
        let text = run(&["read", "hand_id", "ANGLE_ACT", "ERROR", "--hand", &hand])
            .ok()
            .out;
        let lines: Vec<Vec<&str>> = text
            .lines()
            .map(|line| line.split_whitespace().collect())
            .collect();
        assert_eq!(lines[0], ["HAND_ID", "1000", "7"]);
        assert_eq!(
            lines[1],
            [
                "ANGLE_ACT",
                "1546",
                "1000",
                "1000",
                "1000",
                "1000",
                "1000",
                "1000"
            ]
        );
        assert_eq!(
            lines[2],
            [
                "ERROR", "1606", "none", "none", "none", "none", "none", "none"
            ]
        );
        assert_eq!(lines.len(), 3);
    });
}

#[test]
fn a_hand_of_another_id_is_told_in_words() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hand) = sim_on_link(&folder.path().join("hand"), &["--id", "7"]);
        run(&["read", "HAND_ID", "--hand", &format!("{hand}?id=7")]).ok();
        let ended = run(&["watch", "--hand", &format!("{hand}?id=2")]);
        assert_eq!(ended.code, Some(1));
        assert!(ended.err.contains("no answer from id 2"), "{}", ended.err);
        assert!(ended.took < Duration::from_secs(5), "{:?}", ended.took);
    });
}

#[test]
fn text_is_ten_lines_a_second_at_most_and_ends_with_statistics() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&[]);
        let text = run(&["watch", "--hand", &hand, "--for", "1"]).ok().out;
        let lines = text.lines().filter(|line| line.contains("angle")).count();
        assert!((2..=11).contains(&lines), "{text}");
        assert!(text.contains("round trip"), "{text}");
    });
}

#[test]
fn a_wire_open_to_the_network_is_warned_of() {
    unless_busy(|| {
        let mut sim = start(&["sim", "--tcp", "0.0.0.0:0"]);
        assert!(sim.complaint().contains("anyone in the network"));
        assert!(sim.line().starts_with("ready tcp 0.0.0.0:"));
    });
}

#[test]
fn modbus_rtu_tells_the_same_as_the_other_wires() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, wires) = sim_on_all(folder.path(), &[]);
        let hands = [wires.rtu, wires.rs485];
        let names = [
            "HAND_ID",
            "REDU_RATIO",
            "ANGLE_SET",
            "FORCE_SET",
            "SPEED_SET",
            "IP_PART4",
        ];
        let read = hands.each_ref().map(|hand| {
            let args = [&["read", "--json", "--hand", hand], &names[..]].concat();
            run(&args).ok().lines().remove(0)
        });
        assert_eq!(read[0], read[1]);
        for ended in watch_all(&hands, &["--for", "1"]) {
            let mut lines = ended.lines();
            let stats = lines.pop().unwrap()["stats"].take();
            assert!(stats["state_reads"].as_u64().unwrap() > 30, "{stats}");
            assert!(stats["tactile_reads"].as_u64().unwrap() > 5, "{stats}");
            assert_eq!(lines.pop().unwrap()["tactile"][4]["check_ok"], true);
        }
    });
}

#[test]
fn an_rtu_line_answers_one_id_and_survives_noise_and_a_foreign_protocol() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("hand");
        let (_sim, hand) = sim_on_rtu(&link, &["--id", "7"]);
        // More noise than the server skips, and the head of a frame that never ends.
        for noise in [&[0x5A; 100][..], &[7, 16, 0, 0, 0, 100, 200]] {
            std::fs::write(&link, noise).unwrap();
            std::thread::sleep(Duration::from_millis(200));
            run(&["read", "HAND_ID", "--hand", &format!("{hand}?id=7")]).ok();
        }
        for wrong in [
            format!("{hand}?id=2"),
            format!("rs485:{}?id=7", link.display()),
        ] {
            let ended = run(&["read", "HAND_ID", "--hand", &wrong]);
            assert_eq!(ended.code, Some(1));
            assert!(ended.err.contains("no answer from id"), "{}", ended.err);
            assert!(ended.took < Duration::from_secs(5), "{:?}", ended.took);
        }
        run(&["read", "HAND_ID", "--hand", &format!("{hand}?id=7")]).ok();
    });
}
