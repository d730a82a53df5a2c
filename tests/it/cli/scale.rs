//! `scale` as a user at a terminal has it: readings by standard input, stored for the hand, resumed, exported, forgotten.

use crate::cli::refuses_unarmed;
use crate::setup::busy::unless_busy;
use crate::setup::process::{Ended, handscope, listen, run, sim_on_tcp};
use serde_json::Value;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;

/// Grams of the fake scale for a gram of the hand.
const FACTOR: f64 = 0.7;

fn at_home(home: &Path, args: &[&str]) -> Ended {
    let mut command = handscope();
    command.env("HOME", home).args(args);
    listen(command).end()
}

/// Presses with the index, and answers each question as `enters` says, from its number and what the scale shows; `None` ends
/// standard input. Returns the end and the result.
fn pressed(
    home: &Path,
    hand: &str,
    enters: impl Fn(usize, f64) -> Option<String>,
) -> (Ended, Vec<Value>) {
    let mut command = handscope();
    command.env("HOME", home);
    command.args([
        "scale", "--hand", hand, "--joint", "index", "--arm", "--json",
    ]);
    let (reader, mut writer) = std::io::pipe().unwrap();
    command.stdin(Stdio::from(reader));
    let mut running = listen(command);
    let mut asked = 0;
    loop {
        let line = running.line();
        let line: Value = serde_json::from_str(&line).unwrap();
        if line.get("scale").is_some() {
            break;
        }
        let Some(felt) = line["ask"]["hand_g"].as_f64() else {
            continue;
        };
        let shown = (felt * FACTOR / 5.0).round() * 5.0;
        let Some(typed) = enters(asked, shown) else {
            break;
        };
        asked += 1;
        writeln!(writer, "{typed}").unwrap();
    }
    drop(writer);
    let ended = running.end();
    let lines = ended.lines();
    (ended, lines)
}

fn known(home: &Path, hand: &str, more: &[&str]) -> Value {
    let args = [&["scale", "--hand", hand, "--json"], more].concat();
    let mut lines = at_home(home, &args).ok().lines();
    assert_eq!(lines.len(), 1);
    lines[0]["newtons"].take()
}

#[test]
fn without_consent_nothing_moves() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "rigid"]);
        refuses_unarmed(&hand, &["scale", "--hand", &hand, "--joint", "index"]);
    });
}

#[test]
fn nothing_is_stored_of_the_built_in_hand() {
    let ended = run(&["scale", "--hand", "sim:"]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.err.contains("differs each time"), "{}", ended.err);
}

#[test]
fn a_mistyped_reading_is_found_and_what_was_accepted_outlasts_an_early_end() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let home = folder.path();
        // Faster than real ones, so that the test does not take a minute.
        let body = home.join("fast.toml");
        std::fs::write(&body, "[joint.index]\ncounts_per_speed = 10.0\n").unwrap();
        let body = body.to_str().unwrap();
        let (_sim, hand) = sim_on_tcp(&["--scenario", "rigid", "--body", body]);
        assert_eq!(
            known(home, &hand, &[])["joints"].as_array().unwrap().len(),
            0
        );
        // The second reading lacks a digit, and after the third standard input ends.
        let (ended, lines) = pressed(home, &hand, |asked, shown| match asked {
            0 | 2 => Some(shown.to_string()),
            1 => Some((shown / 10.0).floor().to_string()),
            _ => None,
        });
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        assert!(ended.err.contains("3 of 5 loads"), "{}", ended.err);
        let result = &lines.last().unwrap()["scale"];
        assert_eq!(
            (&result["end"], &result["accepted"]),
            (&"incomplete".into(), &3.into())
        );
        let stored = known(home, &hand, &[]);
        assert_eq!(stored["joints"][0]["points"].as_array().unwrap().len(), 3);
        assert!(stored["joints"][0]["newtons_per_g"].is_null());
        // A line that is no reading is asked for again.
        let (ended, lines) = pressed(home, &hand, |asked, shown| match asked {
            0 => Some(format!("what?\n{shown}")),
            _ => Some(shown.to_string()),
        });
        let ended = ended.ok();
        assert!(ended.err.contains("that is no reading"), "{}", ended.err);
        let doubts: Vec<_> = lines
            .iter()
            .filter(|line| line.get("doubt").is_some())
            .collect();
        assert_eq!(doubts.len(), 1, "{lines:?}");
        let asked: Vec<_> = lines
            .iter()
            .filter_map(|line| line["ask"]["load"].as_u64())
            .collect();
        assert_eq!(asked, [4, 5, 2]);
        let result = &lines.last().unwrap()["scale"];
        assert_eq!(result["end"], "done");
        let per_g = result["newtons_per_g"].as_f64().unwrap();
        assert!(
            (per_g / (FACTOR * 0.009_806_65) - 1.0).abs() < 0.05,
            "{per_g}"
        );
        // Its fingertip reports the hand's grams as if they were true.
        assert!(result["fingertip_deviation"].as_f64().unwrap() > 0.3);
        shown_exported_and_forgotten(home, &hand);
    });
}

fn shown_exported_and_forgotten(home: &Path, hand: &str) {
    let watched = at_home(home, &["watch", "--hand", hand, "--json", "--for", "0.5"]).ok();
    let sample = &watched.lines()[3];
    let (grams, newtons) = (&sample["force_g"][3], &sample["force_n"][3]);
    let expected = grams.as_f64().unwrap() * FACTOR * 0.009_806_65;
    assert!(
        (newtons.as_f64().unwrap() - expected).abs() < 0.01,
        "{sample}"
    );
    assert!(sample["force_n"][0].is_null());
    let again = ["scale", "--hand", hand, "--joint", "index", "--arm"];
    let ended = at_home(home, &again).ok();
    assert!(ended.err.contains("nothing was moved"), "{}", ended.err);
    let text = at_home(home, &["scale", "--hand", hand]).ok().out;
    assert!(
        text.contains("index") && text.lines().count() == 2,
        "{text}"
    );
    let (table, object) = (home.join("n.csv"), home.join("n.json"));
    known(home, hand, &["--out", table.to_str().unwrap()]);
    let table = std::fs::read_to_string(table).unwrap();
    assert_eq!(table.lines().count(), 6, "{table}");
    known(
        home,
        hand,
        &[
            "--out",
            object.to_str().unwrap(),
            "--forget",
            "--joint",
            "index",
        ],
    );
    let object: Value = serde_json::from_str(&std::fs::read_to_string(object).unwrap()).unwrap();
    assert_eq!(object["newtons"]["joints"][0]["joint"], "index");
    assert_eq!(
        known(home, hand, &["--forget"])["joints"]
            .as_array()
            .unwrap()
            .len(),
        0
    );
}
