//! From trials to a hand that wakes up tuned, by scripts only: on a cup that breaks, over each wire, in other processes.

use crate::setup::busy::unless_busy;
use crate::setup::process::{run, sim_on_all};
use nix::sys::signal::Signal;
use serde_json::Value;

/// What the cup is held with at least, and may be pressed with beyond the threshold, g.
const HOLD_G: &str = "100";
const OVERSHOOT_G: f64 = 100.0;
/// Those of `Wires::all`.
const WIRES: usize = 4;
/// A step of the way that other work on this machine held up may be done again.
const RUNS: usize = 3;

fn last(lines: Vec<Value>) -> Value {
    lines.into_iter().next_back().unwrap()
}

/// Finds the quickest setting that holds the cup with little overshoot; none if this run was disturbed.
fn quickest(hand: &str) -> Option<Value> {
    let ended = run(&[
        "trial",
        "--hand",
        hand,
        "--json",
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
        "--speed",
        "25,250",
        "--force",
        "200",
        "--best",
        "fastest",
        "--overshoot",
        "100",
        "--hold",
        HOLD_G,
        "--ceiling",
        "1500",
    ]);
    let session = last(ended.lines())["session"].take();
    let best = session["best"].clone();
    let settings = session["settings"].as_array()?.iter();
    let mut chosen = settings.filter(|row| {
        row["speed"] == best["speed"] && row["force_threshold_g"] == best["force_threshold_g"]
    });
    let over = chosen.next()?["overshoot_g"]["max"].as_f64()?;
    (ended.code == Some(0) && over < OVERSHOOT_G).then_some(best)
}

#[test]
fn a_setting_that_trials_found_is_saved_and_the_hand_wakes_up_with_it() {
    unless_busy(|| {
        // Closing takes its time, and each wire has a hand of its own.
        std::thread::scope(|scope| {
            for nth in 0..WIRES {
                scope.spawn(move || check_found_setting(nth));
            }
        });
    });
}

fn check_found_setting(nth: usize) {
    let folder = tempfile::tempdir().unwrap();
    let (mut sim, wires) = sim_on_all(folder.path(), &["--scenario", "fragile"]);
    let records = folder.path().join("records");
    let records = records.to_str().unwrap();
    let hand = wires.all()[nth];
    let best = (0..RUNS).find_map(|_| quickest(hand));
    let best = best.unwrap_or_else(|| panic!("{hand}: no setting holds the cup"));
    let (speed, force) = (&best["speed"], &best["force_threshold_g"]);
    let wanted = folder.path().join("wanted.toml");
    let rows = format!("[default_speed]\nindex = {speed}\n[default_force]\nindex = {force}");
    let text = format!("format = \"handscope-params\"\nversion = 1\n{rows}\n");
    std::fs::write(&wanted, text).unwrap();
    let wanted = wanted.to_str().unwrap();
    let params = |args: &[&str]| {
        let common = ["--hand", hand, "--json", "--folder", records];
        run(&[&["params"], args, &common].concat())
    };
    params(&["apply", wanted]).ok();
    params(&["save", "--yes"]).ok();
    sim.signal(Signal::SIGUSR1);
    sim.until(|line| line == "power cycled");
    let woken = last(params(&["diff", wanted]).ok().lines());
    assert_eq!(woken["differences"], 0, "{hand}");
    for (register, value) in [("SPEED_SET", speed), ("FORCE_SET", force)] {
        let read = run(&["read", register, "--json", "--hand", hand]).ok();
        assert_eq!(last(read.lines())[register][3], *value, "{hand} {register}");
    }
}
