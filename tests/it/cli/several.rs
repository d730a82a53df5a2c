//! Several simulated hands on one bus: each wire leads to all of them, and each answers only what is meant for it.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, run, sim_on_all};
use std::path::Path;
use std::time::Duration;

/// Looks of which one must be undisturbed.
const RUNS: usize = 6;

/// The hands with these ids on four wires; the endpoint of each wire without an id.
fn bus(folder: &Path, ids: &str) -> (Running, [String; 4]) {
    let (sim, wires) = sim_on_all(folder, &["--id", ids]);
    let with_id = |wire: &String| format!("{wire}?id=");
    let serial = [&wires.rs485, &wires.rtu, &wires.slcan].map(with_id);
    let [rs485, rtu, slcan] = serial;
    (sim, [rs485, rtu, slcan, format!("{}?unit=", wires.tcp)])
}

fn id_read(hand: &str) -> serde_json::Value {
    let ended = run(&["read", "HAND_ID", "--hand", hand, "--json"]).ok();
    ended.lines().remove(0)["HAND_ID"].take()
}

#[test]
fn each_of_three_hands_answers_to_its_own_id_on_every_wire() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, wires) = bus(folder.path(), "1,2,3");
        for wire in &wires {
            for id in 1..=3 {
                assert_eq!(id_read(&format!("{wire}{id}")), id, "{wire}");
            }
        }
        assert_eq!(id_read(&format!("{}255", wires[3])), 1, "255 is the first");
    });
}

#[test]
fn an_id_that_no_hand_has_stays_without_answer() {
    unless_busy(|| {
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
    });
}

/// Statistics of a short look, in which nothing may go wrong.
fn watched(hand: &str) -> serde_json::Value {
    let ended = run(&["watch", "--hand", hand, "--for", "0.4", "--json"]).ok();
    let stats = ended.lines().pop().unwrap()["stats"].take();
    for key in ["checksum_errors", "refusals", "reconnects", "writes"] {
        assert_eq!(stats[key], 0, "{hand} {key}: {stats}");
    }
    stats
}

#[test]
fn hands_of_one_bus_are_watched_one_after_another_without_loss() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, wires) = bus(folder.path(), "1,2");
        for wire in &wires {
            for id in [1, 2, 1] {
                let hand = format!("{wire}{id}");
                // A process that gets no processor reads little, and this machine has other work: of a few looks one is lively.
                let lively = (0..RUNS).any(|_| watched(&hand)["state_reads"].as_u64().unwrap() > 3);
                assert!(lively, "{hand}");
            }
        }
    });
}

#[test]
fn more_hands_than_a_window_has_room_for_are_wrong_usage() {
    unless_busy(|| {
        for (words, count) in [(&[][..], 9), (&["exhibit", "--check"][..], 2)] {
            let hands = (0..count).flat_map(|_| ["--hand", "sim:"]);
            let words: Vec<&str> = words.iter().copied().chain(hands).collect();
            let ended = run(&words);
            assert_eq!(ended.code, Some(2), "{words:?}: {}", ended.err);
            assert!(ended.err.contains("--hand was given"), "{}", ended.err);
        }
    });
}
