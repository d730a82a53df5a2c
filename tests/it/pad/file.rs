//! Files of what the controls do: taken whole, or refused with the line and the field.

use handscope::inputs::pad::file::{read, write};
use handscope::inputs::pad::{PadAction, PadControl, PadMap};

const HEAD: &str = "format = \"handscope-gamepad\"\nversion = 1\n";

fn needed(more: &str) -> String {
    format!("{HEAD}[controls]\nleft_bumper = \"dead-man\"\neast = \"stop\"\n{more}")
}

#[test]
fn a_map_is_the_same_after_it_was_written_and_read() {
    let named = |name: &str| PadAction::Pose(name.into());
    let odd = PadMap::usual().with(PadControl::Start, named("\"a\" = 'b' \\ 张开"));
    for map in [PadMap::usual(), odd.unwrap()] {
        assert_eq!(read(&write(&map)), Ok(map));
    }
}

#[test]
fn the_map_of_the_manual_is_the_usual_one() {
    let page = handscope::manual::topic("gamepad").unwrap().text;
    let example = page.split("```toml\n").nth(1).unwrap();
    let example = example.split("```").next().unwrap();
    assert_eq!(read(example), Ok(PadMap::usual()));
}

#[test]
fn a_control_that_is_not_named_does_nothing() {
    let map = read(&needed("south = \"nothing\"\n")).unwrap();
    for control in [PadControl::South, PadControl::RightTrigger] {
        assert_eq!(*map.action(control), PadAction::Nothing);
    }
}

#[test]
fn what_is_wrong_is_told_with_its_line_and_its_field() {
    let only = |line: &str| format!("{HEAD}[controls]\n{line}\n");
    for (text, said) in [
        (String::new(), "`format`"),
        (
            "format = \"handscope-exhibit\"\nversion = 1\n".into(),
            "line 1, `format`: this is another kind of file",
        ),
        (
            "format = \"handscope-gamepad\"\nversion = 2\n".into(),
            "line 2, `version`: version 2 cannot be read",
        ),
        (HEAD.into(), "`controls`"),
        (format!("{HEAD}speed = 3\n[controls]\n"), "line 3, `speed`"),
        (
            needed("soth = \"nothing\"\n"),
            "line 6, `controls`: \"soth\" is not a control: south, east",
        ),
        (
            needed("south = \"jump\"\n"),
            "line 6, `south`: \"jump\" is not what this control can do: \"nothing\", \"dead-man\", \"stop\", \"pose NAME\"",
        ),
        (
            needed("left_trigger = \"pose Open\"\n"),
            "line 6, `left_trigger`: \"pose Open\" is not what this control can do: \"nothing\", \"close fingers\", \"bend thumb\"",
        ),
        (needed("south = \"pose \"\n"), "line 6, `south`: \"pose \""),
        (needed("south = 3\n"), "line 6, `south`"),
        (
            needed("west = \"stop\"\n"),
            "the name \"stop\" is used twice",
        ),
        (
            needed("west = \"dead-man\"\n"),
            "the name \"dead-man\" is used twice",
        ),
        (
            only("east = \"stop\""),
            "line 3, `controls`: there is no \"dead-man\" in this file",
        ),
        (
            only("east = \"dead-man\""),
            "there is no \"stop\" in this file",
        ),
        (needed("east = \"stop\"\n"), "line 6"),
        ("\u{0}".into(), "line 1"),
    ] {
        let error = read(&text).unwrap_err().to_string();
        assert!(error.contains(said), "{text:?}: {error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

#[test]
fn no_text_is_taken_by_half_or_brings_the_reader_down() {
    let whole = write(&PadMap::usual());
    for at in 0..whole.len() {
        if let Some(start) = whole.get(..at) {
            // A file that ends early lacks controls; it is a map only if the needed ones are there.
            let _either = read(start);
        }
    }
    let mut random = fastrand::Rng::with_seed(11);
    for _ in 0..3000 {
        let mut bytes = whole.clone().into_bytes();
        for _ in 0..random.usize(1..6) {
            let at = random.usize(..bytes.len());
            bytes[at] = random.u8(..);
        }
        if let Ok(map) = read(&String::from_utf8_lossy(&bytes)) {
            assert_eq!(map.doing(&PadAction::Stop).count(), 1);
            assert_eq!(map.doing(&PadAction::DeadMan).count(), 1);
        }
    }
}
