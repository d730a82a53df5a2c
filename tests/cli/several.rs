//! Several simulated hands on one bus: each wire leads to all of them, and each answers only what is meant for it.

use crate::program::{Running, run, start};
use std::path::Path;
use std::time::Duration;

/// The hands with these ids on all wires of a system that has no CAN; the endpoint of each wire without an id.
fn bus(folder: &Path, ids: &str) -> (Running, [String; 4]) {
    let link = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (rs485, rtu, slcan) = (link("rs485"), link("rtu"), link("slcan"));
    let mut sim = start(&[
        "sim",
        "--tcp",
        "127.0.0.1:0",
        "--rs485",
        &rs485,
        "--rtu",
        &rtu,
        "--slcan",
        &slcan,
        "--id",
        ids,
    ]);
    let tcp = sim.line();
    let tcp = format!("tcp:{}", tcp.strip_prefix("ready tcp ").expect(&tcp));
    for _ in 0..3 {
        sim.line();
    }
    let hands = [
        format!("rs485:{rs485}?id="),
        format!("rtu:{rtu}?id="),
        format!("slcan:{slcan}?id="),
        format!("{tcp}?unit="),
    ];
    (sim, hands)
}

fn id_read(hand: &str) -> serde_json::Value {
    let ended = run(&["read", "HAND_ID", "--hand", hand, "--json"]).ok();
    ended.lines().remove(0)["HAND_ID"].take()
}

#[test]
fn each_of_three_hands_answers_to_its_own_id_on_every_wire() {
    let folder = tempfile::tempdir().unwrap();
    let (_sim, wires) = bus(folder.path(), "1,2,3");
    for wire in &wires {
        for id in 1..=3 {
            assert_eq!(id_read(&format!("{wire}{id}")), id, "{wire}");
        }
    }
    assert_eq!(id_read(&format!("{}255", wires[3])), 1, "255 is the first");
}

#[test]
fn an_id_that_no_hand_has_stays_without_answer() {
    let folder = tempfile::tempdir().unwrap();
    let (_sim, wires) = bus(folder.path(), "1,3");
    for wire in &wires {
        let ended = run(&["read", "HAND_ID", "--hand", &format!("{wire}2")]);
        assert_eq!(ended.code, Some(1), "{wire}");
        let words = ["no answer from id 2", "Gateway target device"];
        assert!(
            words.iter().any(|words| ended.err.contains(words)),
            "{}",
            ended.err
        );
        assert!(ended.took < Duration::from_secs(5), "{:?}", ended.took);
    }
}

#[test]
fn hands_of_one_bus_are_watched_one_after_another_without_loss() {
    let folder = tempfile::tempdir().unwrap();
    let (_sim, wires) = bus(folder.path(), "1,2");
    for wire in &wires {
        for id in [1, 2, 1] {
            let hand = format!("{wire}{id}");
            let ended = run(&["watch", "--hand", &hand, "--for", "0.4", "--json"]).ok();
            let stats = ended.lines().pop().unwrap()["stats"].take();
            assert!(stats["state_reads"].as_u64().unwrap() >= 1, "{stats}");
            for key in ["checksum_errors", "refusals", "reconnects", "writes"] {
                assert_eq!(stats[key], 0, "{hand} {key}: {stats}");
            }
        }
    }
}
