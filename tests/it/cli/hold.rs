//! `hold` at a terminal: only with `--arm`, refused where it makes no sense, and its outcome.

use crate::cli::{refuses_unarmed, stops_unread};
use crate::setup::busy::unless_busy;
use crate::setup::grasp;
use crate::setup::process::{Running, handscope, listen, run, sim_on_tcp, start};
use nix::sys::signal::Signal;
use serde_json::Value;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;

/// Near the open hand, so that the slow close is short.
const BALL: &str = "stiffness = 10.0
mass_g = 60.0
friction = 0.6
contact = { little = 900, ring = 900, middle = 900, index = 900, thumb_bend = 900 }
";

pub(super) fn ball(folder: &Path) -> String {
    let path = folder.join("ball.toml");
    std::fs::write(&path, BALL).unwrap();
    format!("sim:?scenario=free&object={}", path.display())
}

#[test]
fn unarmed_it_moves_nothing() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        refuses_unarmed(&hand, &["hold", "--hand", &hand, "--gap", "30"]);
    });
}

#[test]
fn forces_and_poses_that_make_no_sense_are_wrong_usage() {
    for (more, words) in [
        (
            &["--at-least", "300", "--at-most", "200"][..],
            "no room for a hold",
        ),
        (&["--at-least", "20"], "choose at least 40 g or more"),
        (&["--at-most", "2500"], "at most 100 to 2000 g"),
        (
            &["--at-most", "9000"],
            "more than a threshold can be: at most 3000 g",
        ),
        (&["--at-most", "-5"], "'-5' is not a force"),
        (&["--at-least", "nan"], "'nan' is not a force"),
        (&["--newtons"], "--at-least <FORCE>"),
        (&["--newtons", "--at-least", "2"], "--at-most <FORCE>"),
        (&["--pose", "Handshake"], "there is no pose 'Handshake'"),
        (&["--gap", "2"], "a pinch opens from 3 to 120 mm, not 2"),
        (&["--pose", "Fist", "--gap", "30"], "cannot be used with"),
    ] {
        let ended = run(&[&["hold", "--hand", "sim:", "--arm"], more].concat());
        assert_eq!(ended.code, Some(2), "{more:?} {}", ended.err);
        assert!(ended.err.contains(words), "{more:?} {}", ended.err);
        // The parser of the arguments adds where to find help.
        let is_sentence = ended.err.lines().count() == 1;
        assert!(is_sentence || ended.err.starts_with("error:"), "{more:?}");
    }
}

#[test]
fn newtons_of_a_hand_that_was_not_measured_move_nothing() {
    let line = ["hold", "--hand", "sim:", "--newtons", "--at-least", "2"];
    let ended = run(&[&line[..], &["--at-most", "4", "--arm"]].concat());
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    assert!(ended.err.contains("nothing was moved"), "{}", ended.err);
    assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
}

#[test]
fn a_hold_whose_output_is_closed_stops_the_hand_and_fails() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        for more in [&[][..], &["--json"]] {
            let hold = ["hold", "--hand", &hand, "--pose", "Fist", "--arm"];
            stops_unread(&[&hold[..], more].concat());
        }
    });
}

#[test]
fn it_ends_held_or_ended_by_the_user_or_with_nothing() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let ball = ball(folder.path());
        let curled = ["hold", "--hand", &ball, "--pose", "Curled", "--arm"];
        let timed = start(&[&curled[..], &["--for", "2", "--json"]].concat());
        let mut endless = start(&curled);
        let empty = start(&["hold", "--hand", "sim:?scenario=free", "--arm", "--json"]);

        let empty = empty.end();
        assert_eq!(empty.code, Some(1), "{}", empty.err);
        assert!(empty.err.contains("holds nothing"), "{}", empty.err);
        assert_eq!(empty.lines().pop().unwrap()["hold"]["end"], "nothing");

        endless.until(|line| line.contains(" g, margin"));
        endless.signal(Signal::SIGINT);
        let endless = endless.end();
        assert_eq!(endless.code, Some(0), "{}", endless.err);
        let said = &endless.err;
        assert!(said.contains("ended by the user"), "{said}");
        assert!(said.contains("feedback shows rest"), "{said}");

        let timed = timed.end().ok();
        let lines = timed.lines();
        let holding = lines
            .iter()
            .filter(|line| line["holding"]["phase"] == "holding");
        assert!(holding.count() >= 2, "{}", timed.out);
        let told: Value = lines.last().unwrap()["hold"].clone();
        assert_eq!(
            (&told["end"], &told["state"]),
            (&"held".into(), &"holding".into())
        );
        assert!(told["seconds_held"].as_f64().unwrap() >= 2.0, "{told}");
        let forces = told["last"]["force_g"].as_array().unwrap();
        for force_g in forces {
            let force_g = force_g.as_i64().unwrap();
            assert!((120..=400).contains(&force_g), "{told}");
        }
        assert_eq!(forces.len(), 5, "{told}");
    });
}

/// The program of a user whose files are in this folder.
fn at_home(home: &Path, args: &[&str]) -> Running {
    let mut command = handscope();
    command.env("HOME", home).args(args);
    listen(command)
}

#[test]
fn a_hold_that_worked_is_saved_and_repeated_by_the_same_hand_only() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let home = folder.path();
        let ball = ball(home);
        let save = [
            "hold", "--hand", &ball, "--pose", "Curled", "--arm", "--json",
        ];
        let more = ["--for", "3", "--save", "ball", "--note", "red"];
        let empty = [
            "hold",
            "--hand",
            "sim:?scenario=free",
            "--arm",
            "--json",
            "--save",
            "air",
        ];
        let saves = at_home(home, &[&save[..], &more].concat());
        let empty = at_home(home, &empty).end();
        assert_eq!(empty.code, Some(1), "{}", empty.err);
        let told: Value = empty.lines().last().unwrap()["hold"].clone();
        assert_eq!(told["not_saved"], "it did not end well", "{told}");
        assert_eq!(told["saved"], Value::Null);

        let told: Value = saves.end().ok().lines().last().unwrap()["hold"].clone();
        let file = told["saved"].as_str().unwrap();
        assert!(file.ends_with("grasps/ball.grasp.toml"), "{file}");
        let text = std::fs::read_to_string(file).unwrap();
        for line in [
            "note = \"red\"",
            "pose = \"Curled\"",
            "[finger.thumb]",
            "at_most_g = 400",
        ] {
            assert!(text.contains(line), "{line} {text}");
        }
        let again = at_home(home, &[&save[..], &more].concat()).end();
        assert_eq!(again.code, Some(1), "{}", again.err);
        assert!(again.err.contains("already exists"), "{}", again.err);

        let repeats = [
            "hold", "--grasp", "ball", "--arm", "--for", "2", "--json", "--hand",
        ];
        let own = at_home(home, &[&repeats[..], &[&ball]].concat());
        let other = ball.replacen('?', "?seed=7&", 1);
        let other = at_home(home, &[&repeats[..], &[&other]].concat()).end();
        assert_eq!(other.code, Some(1), "{}", other.err);
        assert!(
            other.err.contains("nothing was moved: 'ball'"),
            "{}",
            other.err
        );
        assert!(other.err.contains("handscope scale"), "{}", other.err);
        let told: Value = own.end().ok().lines().last().unwrap()["hold"].clone();
        assert_eq!(told["trust"], "same_hand", "{told}");
        assert_eq!(told["end"], "held", "{told}");
    });
}

#[test]
fn a_wrong_grasp_moves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("egg.grasp.toml");
    std::fs::write(&path, "format = \"handscope-grasp\"\nversion = 1\n").unwrap();
    let path = path.to_str().unwrap();
    let too_long = format!("/tmp/{}.grasp.toml", "n".repeat(300));
    for (more, code, words) in [
        (&["--save", &too_long][..], 1, "File name too long"),
        (&["--save", "/proc/egg.grasp.toml"], 1, "cannot write /proc"),
        (&["--grasp", path][..], 1, "`name`: it is missing: add it"),
        (
            &["--grasp", "none"],
            2,
            "there is no grasp 'none' in the pose library",
        ),
        (&["--grasp", "none.grasp.toml"], 1, "no such file"),
        (
            &["--save", "/nowhere/egg.grasp.toml"],
            1,
            "there is no folder /nowhere",
        ),
        (
            &["--save", ".grasp.toml"],
            2,
            "a name of 1 to 32 characters",
        ),
        (&["--grasp", "a/b"], 2, "a name of 1 to 32 characters"),
        (&["--grasp", path, "--gap", "30"], 2, "cannot be used with"),
        (&["--note", "red"], 2, "--save"),
        (
            &["--save", path],
            1,
            "already exists and is not overwritten",
        ),
        (
            &["--save", "new", "--tuned", "/nowhere"],
            1,
            "cannot read /nowhere/session.toml; --tuned is",
        ),
    ] {
        let ended = run(&[&["hold", "--hand", "sim:", "--arm"], more].concat());
        assert_eq!(ended.code, Some(code), "{more:?} {}", ended.err);
        assert!(ended.err.contains(words), "{more:?} {}", ended.err);
    }
}

/// A ball that is put down 1.5 s after it is held, a hand that holds it, and the grasp `ball` of another hand, which it confirms.
fn unconfirmed(home: &Path) -> (Running, String) {
    let path = home.join("put-down.toml");
    let turn = |at_s: f64, share: f64| {
        format!("[[turn]]\nat_s = {at_s:.1}\ndirection_deg = 270.0\nshare = {share:.1}\n")
    };
    let turns = turn(1.5, 1.0) + &turn(2.0, 0.0);
    std::fs::write(&path, format!("{BALL}lift_after_s = 1.0\n{turns}")).unwrap();
    let object = path.to_str().unwrap();
    let (sim, hand) = sim_on_tcp(&["--scenario", "free", "--object", object]);
    let settings = home.join(".config/handscope/settings.toml");
    grasp::store(&settings, &hand, "ball");
    (sim, hand)
}

#[test]
fn a_grasp_of_another_hand_moves_nothing_where_nobody_can_say_that_the_object_stands() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hand) = unconfirmed(folder.path());
        let args = ["hold", "--hand", &hand, "--grasp", "ball", "--arm"];
        let ended = at_home(folder.path(), &args).end();
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        assert!(ended.err.contains("nothing was moved"), "{}", ended.err);
        assert!(ended.err.contains("--consent stdin"), "{}", ended.err);
        assert_eq!(ended.out, "");
    });
}

#[test]
fn a_confirmation_opens_the_hand_only_on_a_line_after_its_question() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hand) = unconfirmed(folder.path());
        let (input, mut person) = std::io::pipe().unwrap();
        let mut command = handscope();
        command.env("HOME", folder.path()).stdin(Stdio::from(input));
        command.args(["hold", "--hand", &hand, "--grasp", "ball", "--arm"]);
        command.args(["--json", "--consent", "stdin"]);
        let mut running = listen(command);
        person.write_all(b"\n\nyes\n").unwrap();
        let step = |line: &str| -> Value {
            let line: Value = serde_json::from_str(line).unwrap();
            line["holding"]["confirming"]["step"].clone()
        };
        running.until(|line| step(line) == "lift");
        person.write_all(b"\n").unwrap();
        let asked = running.until(|line| line.contains("\"ask\""));
        assert_eq!(asked, r#"{"ask":{"close":1,"of":5}}"#);
        // It waits, whatever was typed before.
        assert_eq!(
            step(&running.until(|line| step(line) != Value::Null)),
            "release"
        );
        person.write_all(b"\n").unwrap();
        running.until(|line| step(line) == "open");
        running.until(|line| step(line) == "close");
        running.until(|line| line.contains("\"ask\""));
        drop(person);
        let ended = running.end();
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        let told: Value = ended.lines().last().unwrap()["hold"].clone();
        let why = "standard input ended without an answer";
        assert_eq!(told["doubt"], why, "{told}");
        assert!(ended.err.contains(why), "{}", ended.err);
    });
}
