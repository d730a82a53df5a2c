//! The simulated hand behind serial CAN adapters on pseudo-terminals, read by the other commands.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, run, start};
use std::path::Path;

/// A simulated hand behind an adapter of this kind linked at `link`, with its endpoint.
fn sim_on_adapter(kind: &str, link: &Path, more: &[&str]) -> (Running, String) {
    let (link, option) = (link.to_str().unwrap(), format!("--{kind}"));
    let mut sim = start(&[&["sim", &option, link], more].concat());
    assert_eq!(sim.line(), format!("ready {kind} {link}"));
    (sim, format!("{kind}:{link}"))
}

#[test]
fn watch_and_read_work_through_an_adapter() {
    for kind in ["slcan", "usbcan"] {
        unless_busy(|| watch_and_read(kind));
    }
}

fn watch_and_read(kind: &str) {
    let folder = tempfile::tempdir().unwrap();
    let (_sim, hand) = sim_on_adapter(kind, &folder.path().join("adapter"), &["--id", "7"]);
    let hand = format!("{hand}?id=7");
    let watched = run(&["watch", "--json", "--for", "1", "--hand", &hand]).ok();
    let mut lines = watched.lines();
    let stats = lines.pop().unwrap()["stats"].take();
    assert!(stats["state_reads"].as_u64().unwrap() > 10, "{stats}");
    assert!(stats["tactile_reads"].as_u64().unwrap() > 2, "{stats}");
    for key in ["writes", "refusals", "reconnects", "resyncs"] {
        assert_eq!(stats[key], 0, "{key}: {stats}");
    }
    let last = lines.pop().unwrap();
    assert_eq!(last["tactile"].as_array().unwrap().len(), 5);
    // A fingertip comes in pieces, between which it may change: then its check does not fit.
    assert!(last["tactile"][4]["check_ok"].is_boolean(), "{last}");
    let names = ["HAND_ID", "ANGLE_ACT", "TEMP", "FINGERONE_TOUCH"];
    let args = [&["read", "--json", "--hand", &hand], &names[..]].concat();
    let read = run(&args).ok().lines().remove(0);
    assert_eq!(read["HAND_ID"], 7);
    assert_eq!(read["ANGLE_ACT"].as_array().unwrap().len(), 6);
    assert_eq!(read["FINGERONE_TOUCH"]["finger"], "little");
}

#[test]
fn a_wrong_bit_rate_or_id_is_silence_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let (_sim, hand) = sim_on_adapter("slcan", &folder.path().join("adapter"), &[]);
    for wrong in ["bitrate=500000", "id=2"] {
        let ended = run(&["watch", "--hand", &format!("{hand}?{wrong}")]);
        assert_eq!(ended.code, Some(1));
        assert!(ended.err.contains("no answer from id"), "{}", ended.err);
    }
    run(&["read", "HAND_ID", "--hand", &hand]).ok();
}

#[test]
fn the_makers_adapter_is_looked_at_by_doctor_traffic_and_scan() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hand) = sim_on_adapter("usbcan", &folder.path().join("adapter"), &["--id", "7"]);
        let hand = format!("{hand}?id=7");
        run(&["doctor", "--for", "1", "--hand", &hand]).ok();
        let wire = run(&["watch", "--wire", "--for", "1", "--hand", &hand]).ok();
        let asked = "-> read          id 7   HAND_ID  [AA AA 07 00 FA 00 01 ";
        assert!(wire.out.contains(asked), "{}", wire.out);
        let wrong = run(&["read", "TEMP", "--hand", &hand.replace("id=7", "id=2")]);
        assert!(wrong.err.contains("no answer from id 2"), "{}", wrong.err);
        let port = hand["usbcan:".len()..].split('?').next().unwrap();
        let scan = [
            "scan", "--json", "--ids", "6-8", "--serial", port, "--usbcan", port,
        ];
        let found = run(&scan).ok();
        let url = &found.lines()[0]["hand"]["url"];
        assert_eq!(*url, format!("usbcan:{port}?baud=115200&id=7"));
    });
}

#[test]
fn serving_on_an_interface_that_is_not_there_is_told() {
    let ended = run(&["sim", "--can", "nocan9"]);
    assert_eq!(ended.code, Some(1));
    let words = if cfg!(target_os = "linux") {
        "there is no CAN interface nocan9"
    } else {
        "need Linux"
    };
    assert!(ended.err.contains(words), "{}", ended.err);
}
