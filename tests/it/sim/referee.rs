//! The program on a hand by another author: what it reads, moves and measures is what that hand's own log says.

use crate::setup::busy::unless_busy;
use crate::setup::process::run;
use crate::setup::referee::{RefereeHand, fast_closes};
use serde_json::Value;

#[test]
fn the_referee_hand_is_read_as_ours() {
    unless_busy(|| {
        let Some(hand) = RefereeHand::start(3, &["zero=40", "only=index"]) else {
            return;
        };
        let endpoint = hand.endpoint();
        let read = run(&[
            "read",
            "ANGLE_ACT",
            "HAND_ID",
            "--hand",
            &endpoint,
            "--json",
        ])
        .ok();
        let values = &read.lines()[0];
        assert_eq!(
            values["ANGLE_ACT"],
            serde_json::json!([1000, 1000, 1000, 1000, 1000, 1000])
        );
        let watch = run(&["watch", "--hand", &endpoint, "--for", "1", "--json"]).ok();
        assert!(!watch.lines().is_empty());
    });
}

#[test]
fn what_is_changed_while_it_runs_is_read() {
    unless_busy(|| {
        let Some(mut hand) = RefereeHand::start(4, &["noise=0"]) else {
            return;
        };
        hand.send("set index dz 700");
        let endpoint = hand.endpoint();
        let index_g = || {
            let read = run(&["read", "FORCE_ACT", "--hand", &endpoint, "--json"]).ok();
            read.lines()[0]["FORCE_ACT"][3].as_i64().unwrap()
        };
        assert!((0..50).any(|_| index_g() > 650));
    });
}

#[test]
fn a_trial_measures_the_peaks_that_the_referee_hand_logs() {
    unless_busy(|| {
        let keys = ["only=index", "contact=480", "k=25", "zero=30", "noise=3"];
        let Some(hand) = RefereeHand::start(5, &keys) else {
            return;
        };
        let args = [
            "--joint", "index", "--speed", "50", "--force", "250", "--repeat", "3",
        ];
        let rest = [
            "--dwell",
            "0.5",
            "--rest",
            "0",
            "--ceiling",
            "3000",
            "--arm",
            "--json",
        ];
        let endpoint = hand.endpoint();
        let ended = run(&[&["trial", "--hand", &endpoint][..], &args, &rest].concat()).ok();
        let measured: Vec<f64> = ended.lines().iter().filter_map(peak_g).collect();
        let logged = hand.closes();
        assert_eq!(measured.len(), 3, "{}", ended.out);
        for (own, close) in measured.iter().zip(&logged) {
            let truth = close["peak"].as_f64().unwrap();
            assert!(
                (own - truth).abs() < 30.0,
                "measured {own} g, logged {truth} g"
            );
        }
    });
}

fn peak_g(line: &Value) -> Option<f64> {
    line["trial"]["joints"][0]["peak_force_g"].as_f64()
}

#[test]
fn fast_closes_are_those_of_the_readme() {
    unless_busy(|| {
        let Some(closes) = fast_closes(1, "index", 50, &["fs=25", "ft=200", "k=25"]) else {
            return;
        };
        assert_eq!(closes.len(), 50);
        assert!(
            closes
                .iter()
                .all(|close| close.peak_g > 200.0 && close.close_s > 5.0)
        );
    });
}
