//! `grip` as a person at a terminal has it: only with their word, refused where it makes no sense, ended by what the hand did or
//! by Ctrl-C.

use crate::cli::refuses_unarmed;
use crate::setup::busy::unless_busy;
use crate::setup::process::{handscope, listen, run, sim_on_tcp, start};
use handscope::transport::Endpoint;
use nix::sys::signal::Signal;
use serde_json::Value;

fn angles(hand: &str) -> Vec<i64> {
    let read = run(&["read", "ANGLE_ACT", "--json", "--hand", hand]).ok();
    let angles = read.lines()[0]["ANGLE_ACT"].clone();
    serde_json::from_value(angles).unwrap()
}

#[test]
fn without_a_persons_word_nothing_moves() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        refuses_unarmed(&hand, &["grip", "--hand", &hand, "--gap", "30"]);
    });
}

#[test]
fn a_wish_that_makes_no_sense_is_wrong_usage() {
    unless_busy(|| {
        for (more, words) in [
            (&["--gap", "2"][..], "a pinch opens from 3 to 120 mm, not 2"),
            (&["--gap", "wide"], "not a number of millimetres"),
            (&["--gap", "-5"], "a pinch opens from 3 to 120 mm, not -5"),
            (&["--gap", "30", "--kind", "hook"], "not one of pinch"),
            (
                &["--gap", "30", "--kind", "three-fingers"],
                "25 mm beside the middle finger's pad",
            ),
            (
                &["--gap", "30", "--kind", "around"],
                "depends on where the object lies",
            ),
            (&["--gap", "30", "--force", "2500"], "rated for 2000 g"),
            (&["--gap", "30", "--speed", "0"], "nothing moves"),
            (&[], "--gap"),
        ] {
            let mut line = vec!["grip", "--hand", "sim:", "--arm"];
            line.extend(more);
            let ended = run(&line);
            assert_eq!(ended.code, Some(2), "{more:?} {}", ended.err);
            assert!(ended.err.contains(words), "{more:?} {}", ended.err);
        }
    });
}

#[test]
fn it_closes_to_the_gap_opens_again_and_says_that_nothing_is_held() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        for (gap, index, bend) in [("30", 502, 687), ("90", 659, 997)] {
            let line = ["grip", "--hand", &hand, "--gap", gap, "--speed", "800"];
            let ended = run(&[&line[..], &["--arm", "--json"]].concat()).ok();
            let told = ended.lines().pop().unwrap()["grip"].take();
            assert_eq!(told["end"], "reached", "{told}");
            let off = told["gap_mm"].as_f64().unwrap() - gap.parse::<f64>().unwrap();
            assert!(off.abs() < 4.0, "{told}");
            assert!(
                told["size_mm"].is_null() && told["size_by"].is_null(),
                "{told}"
            );
            let now = angles(&hand);
            assert!((now[3] - index).abs() <= 20 && (now[4] - bend).abs() <= 20);
            assert!(now[5] <= 20 && now[0] >= 980, "{now:?}");
        }
        let ended = run(&["grip", "--hand", &hand, "--gap", "60", "--arm"]).ok();
        assert!(ended.out.contains("by the model"), "{}", ended.out);
    });
}

#[test]
fn what_is_in_its_way_is_told_in_a_sentence() {
    unless_busy(|| {
        // The block is in the way of the thumb's rotation.
        let (_sim, hand) = sim_on_tcp(&["--scenario", "rigid"]);
        let line = ["grip", "--hand", &hand, "--gap", "10", "--speed", "300"];
        let ended = run(&[&line[..], &["--arm", "--json"]].concat());
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        assert!(ended.err.contains("did not open"), "{}", ended.err);
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
        assert_eq!(ended.lines().pop().unwrap()["grip"]["end"], "not_opened");
        let now = angles(&hand);
        assert!(now[3] > 780 && now[5] > 470, "it went on: {now:?}");
    });
}

#[test]
fn ctrl_c_holds_the_hand() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let line = ["grip", "--hand", &hand, "--gap", "5", "--speed", "40"];
        let grip = start(&[&line[..], &["--arm", "--json"]].concat());
        while angles(&hand)[5] > 900 {}
        grip.signal(Signal::SIGINT);
        let ended = grip.end();
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        assert!(
            ended.err.contains("ended by the user") && ended.err.contains("feedback shows rest"),
            "{}",
            ended.err
        );
        let told: Value = ended.lines().pop().unwrap()["grip"].take();
        assert_eq!(
            (&told["end"], &told["stop"]["confirmed"]),
            (&"person".into(), &true.into())
        );
        let rests = angles(&hand);
        assert_eq!(rests, angles(&hand));
        assert!(rests[5] > 500, "{rests:?}");
    });
}

#[test]
fn blocks_that_were_measured_in_the_window_make_its_sizes_true() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let body = folder.path().join("near.toml");
        let near =
            "[joint.index]\ncontact_offset = -150.0\n[joint.thumb_bend]\ncontact_offset = -200.0\n";
        std::fs::write(&body, near).unwrap();
        let (_sim, hand) = sim_on_tcp(&["--body", body.to_str().unwrap()]);
        let home = folder.path().join("handscope");
        std::fs::create_dir(&home).unwrap();
        let known: Endpoint = hand.parse().unwrap();
        let settings = format!(
            "[hands.\"{known}\"]\nsize_blocks = [{{ size_mm = 10.0, gap_mm = 4.0 }}, {{ size_mm = 50.0, gap_mm = 44.0 }}]\n"
        );
        std::fs::write(home.join("settings.toml"), settings).unwrap();
        let grip = |folder: &std::path::Path| {
            let line = [
                "grip", "--hand", &hand, "--gap", "5", "--speed", "400", "--arm",
            ];
            let mut command = handscope();
            command.args([&line[..], &["--json"]].concat());
            command.env("XDG_CONFIG_HOME", folder);
            let ended = listen(command).end().ok();
            ended.lines().pop().unwrap()["grip"].take()
        };
        let told = grip(folder.path());
        assert_eq!(told["end"], "held", "{told}");
        let (gap, size) = (told["gap_mm"].as_f64(), told["size_mm"].as_f64());
        assert!((gap.unwrap() + 6.0 - size.unwrap()).abs() < 0.1, "{told}");
        assert_eq!(
            (&told["size_by"], &told["size_of"]),
            (&"blocks".into(), &"block".into())
        );
        // Below what a ball could have between the pads.
        let told = grip(&folder.path().join("empty"));
        assert_eq!(
            (&told["end"], &told["size_by"]),
            (&"held".into(), &"model".into())
        );
        assert!(
            told["size_mm"].is_null() && told["size_of"].is_null(),
            "{told}"
        );
    });
}
