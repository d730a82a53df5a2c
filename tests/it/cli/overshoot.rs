//! What trials measured of a hand, by script: kept for its place, told, written, forgotten, and what its warnings go by.

use crate::setup::process::{handscope, listen, run, sim_on_tcp};
use serde_json::Value;
use std::path::Path;

/// A run of the program of one user, who has this home.
fn at_home(home: &Path, args: &[&str]) -> crate::setup::process::Ended {
    let mut command = handscope();
    command.env("HOME", home).args(args);
    listen(command).end()
}

fn told(home: &Path, hand: &str, more: &[&str]) -> Value {
    let args = [&["overshoot", "--hand", hand, "--json"], more].concat();
    let mut lines = at_home(home, &args).ok().lines();
    assert_eq!(lines.len(), 1);
    lines[0]["overshoot"].take()
}

#[test]
fn what_a_trial_measured_is_kept_for_its_hand_and_its_warnings_go_by_it() {
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path();
    let (_sim, hand) = sim_on_tcp(&["--scenario", "rigid"]);
    assert_eq!(told(home, &hand, &[])["closes"], 0);
    let defaults = |name: &str, speed: u16, force: u16| {
        let file = folder.path().join(name);
        let rows = format!("[default_speed]\nindex = {speed}\n[default_force]\nindex = {force}\n");
        let text = format!("format = \"handscope-params\"\nversion = 1\n{rows}");
        std::fs::write(&file, text).unwrap();
        file
    };
    let gentle = defaults("gentle.toml", 25, 100);
    let gentle = ["params", "apply", gentle.to_str().unwrap(), "--hand", &hand];
    at_home(home, &gentle).ok();
    let hard = defaults("hard.toml", 250, 500);
    let apply = || {
        let hard = hard.to_str().unwrap();
        let ended = at_home(home, &["params", "apply", hard, "--hand", &hand]);
        assert_eq!(ended.code, Some(2), "{}", ended.err);
        ended.err
    };
    assert!(apply().contains("of another hand was measured"));
    let trial = [
        "trial",
        "--hand",
        &hand,
        "--arm",
        "--joint",
        "index",
        "--start",
        "600",
        "--close",
        "300",
        "--dwell",
        "0.5",
        "--rest",
        "0",
        "--ceiling",
        "4000",
        "--speed",
        "250",
        "--force",
        "500",
        "--repeat",
        "3",
    ];
    at_home(home, &trial).ok();
    let kept = told(home, &hand, &[]);
    assert_eq!(kept["closes"], 3, "{kept}");
    let kind = &kept["kinds"][0];
    assert_eq!(
        (&kind["joint"], &kind["stages"]),
        (&"index".into(), &"one".into())
    );
    assert_eq!(
        (&kind["speed"], &kind["force_threshold_g"]),
        (&250.into(), &500.into())
    );
    assert_eq!(kind["stiffness"], "rigid");
    let told_so = "this finger was measured in 3 closes";
    assert!(apply().contains(told_so), "{}", apply());
    let table = folder.path().join("table.csv");
    told(home, &hand, &["--out", table.to_str().unwrap(), "--forget"]);
    let table = std::fs::read_to_string(table).unwrap();
    assert_eq!(table.lines().count(), 2, "{table}");
    assert!(table.contains("\nindex,1,250,500,rigid,3,"));
    assert_eq!(told(home, &hand, &[])["closes"], 0);
    assert!(apply().contains("of another hand was measured"));
}

#[test]
fn nothing_is_kept_of_the_built_in_hand() {
    let ended = run(&["overshoot", "--hand", "sim:"]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.err.contains("differs each time"), "{}", ended.err);
}
