#![allow(clippy::unwrap_used, reason = "a test may")]
use crate::exhibit::file::{ExhibitFile, built_in};
use crate::exhibit::pin::Pin;
use crate::exhibit::plan::ExhibitPlan;
use crate::hand::{Force, Speed};
use crate::poses::library::PoseLibrary;
use crate::store::FileError;
use std::path::Path;
use std::time::Duration;

/// Every field, on lines of their own.
const FILE: &str = r#"format = "handscope-exhibit"
version = 1
title = "Touch"
title_zh = "点"
logo = "logo.png"
poses = "poses.toml"
pin = "4711"
tiles = ["Fist", "Point", "V", "OK", "Rock", "Touch me"]
speed = 250
force = 700
visit_s = 90
visitor_restart = true
[attract]
pieces = ["Wave", "Wave"]
after_s = 5
play_s = 3600
rest_s = 30
"#;

/// All that is looked at of a text in this folder.
fn read(text: &str, folder: &Path, own: &PoseLibrary) -> Result<ExhibitPlan, FileError> {
    let file = ExhibitFile::parse(text, folder)?;
    file.logo()?;
    file.plan(own)
}

fn error(text: &str) -> FileError {
    read(text, Path::new(""), &PoseLibrary::default()).unwrap_err()
}

#[test]
fn a_tile_that_waits_for_the_grip_waits_within_the_limits_too() {
    let waits = r#"format = "handscope-poses"
version = 1
pose = [{ name = "Close", speed = 900, force = 900, angles = { little = 1, ring = 1, middle = 1, index = 1, thumb_bend = 1, thumb_rotate = 1 } }]
[[sequence]]
name = "Grab"
step = [{ pose = "Close", speed = 900, dwell_ms = 0, limit_ms = 3000, until = { grip = "holding", within_ms = 2000, retries = 2 } }]
"#;
    let own = crate::poses::file::read(waits).unwrap();
    let text = FILE.replacen("Fist", "Grab", 1);
    let plan = read(&text, Path::new(""), &own).unwrap();
    let cue = &plan.tiles[0].plan.cues[0];
    let until = cue.until.unwrap();
    assert_eq!((until.within.get(), until.retries.get()), (2000, 2));
    assert_eq!((cue.speed.get(), cue.force.get()), (250, 700));
}

#[test]
fn a_tile_that_holds_holds_within_the_force_of_the_file() {
    let tiles = FILE.replacen("Fist", "Pull it out", 1);
    let own = PoseLibrary::default();
    for (force, want) in [("800", [150, 600]), ("250", [150, 250]), ("100", [40, 100])] {
        let text = tiles.replacen("force = 700", &format!("force = {force}"), 1);
        let plan = read(&text, Path::new(""), &own).unwrap();
        let mut holds = plan.tiles[0].plan.cues().filter_map(|cue| cue.hold);
        let hold = holds.next().unwrap();
        let both = [hold.at_least(), hold.at_most()].map(Force::get);
        assert_eq!(both, want, "{force}");
    }
    let refused = error(&tiles.replacen("force = 700", "force = 99", 1));
    assert_eq!(
        (refused.line, refused.field.as_deref()),
        (Some(8), Some("tiles"))
    );
    assert!(
        refused.to_string().contains("a hold needs 100 g"),
        "{refused}"
    );
}

#[test]
fn every_field_is_taken_and_most_may_be_left_out() {
    let folder = Path::new("booth");
    let plan = read(FILE, folder, &PoseLibrary::default()).unwrap();
    assert_eq!(
        (plan.title.en.as_str(), plan.title.zh.as_str()),
        ("Touch", "点")
    );
    assert_eq!(plan.pin, Pin::try_from("4711".to_owned()).ok());
    assert_eq!(plan.tiles.len(), 6);
    assert_eq!(plan.limits.speed, Speed::nearest(250));
    assert_eq!(plan.limits.force, Force::nearest(700));
    assert_eq!(
        (plan.visit, plan.visitor_restart),
        (Duration::from_secs(90), true)
    );
    let attract = plan.attract.unwrap();
    let times = [attract.after, attract.play, attract.rest].map(|time| time.as_secs());
    assert_eq!((attract.pieces.len(), times), (2, [5, 3600, 30]));
    let file = ExhibitFile::parse(FILE, folder).unwrap();
    let named = [file.poses(), file.logo()].map(|named| named.unwrap().unwrap().path);
    assert_eq!(
        named,
        ["poses.toml", "logo.png"].map(|name| folder.join(name))
    );
    let short = FILE.lines().filter(|line| {
        ["format", "version", "tiles"]
            .iter()
            .any(|key| line.starts_with(key))
    });
    let short = short.collect::<Vec<_>>().join("\n");
    let plan = read(&short, folder, &PoseLibrary::default()).unwrap();
    assert_eq!((plan.pin, plan.attract), (None, None));
    assert_eq!(
        (plan.limits.speed, plan.limits.force),
        (Speed::nearest(300), Force::nearest(800))
    );
    assert_eq!(
        (plan.visit, plan.visitor_restart),
        (Duration::from_secs(120), false)
    );
    let file = ExhibitFile::parse(&short, folder).unwrap();
    assert!(file.poses().unwrap().is_none() && file.logo().unwrap().is_none());
}

#[test]
fn the_built_in_exhibition_is_whole() {
    let plan = built_in().unwrap();
    assert_eq!(plan.tiles.len(), 11);
    assert!(plan.tiles.iter().all(|tile| !tile.name.zh.is_empty()));
    assert!(plan.tiles.iter().any(|tile| tile.plan.reaction.is_some()));
    assert_eq!(
        (plan.pin, plan.visitor_restart),
        (None, false),
        "staff choose"
    );
    assert_eq!(plan.attract.unwrap().pieces.len(), 5);
}

const THIRTEEN: &str = "tiles = [\"1\", \"2\", \"3\", \"4\", \"5\", \"6\", \"7\", \"8\", \"9\", \"10\", \"11\", \"12\", \"13\"]";

/// What is put in place of what, and the line, the field and the words that are told then.
const WRONG: &[(&str, &str, usize, &str, &str)] = &[
    (
        "handscope-exhibit",
        "handscope-poses",
        1,
        "format",
        "another kind of file",
    ),
    (
        "version = 1",
        "version = 2",
        2,
        "version",
        "version 2 cannot be read",
    ),
    (
        "version = 1",
        "version = \"1\"",
        2,
        "version",
        "is not a whole number",
    ),
    (
        "\"Touch\"",
        "\"a\\nb\"",
        3,
        "title",
        "\"a\\nb\" is not one line of at most 60 characters",
    ),
    ("\"点\"", "\"\\u001b[2J\"", 4, "title_zh", "is not one line"),
    (
        "logo.png",
        "logo.svg",
        5,
        "logo",
        "\"logo.svg\" is not a file that ends in .png",
    ),
    ("logo.png", "png", 5, "logo", "\"png\" is not a file"),
    (
        "poses.toml\"",
        "poses.toml\"\nposes = \"x\"",
        7,
        "poses",
        "duplicate key",
    ),
    (
        "tiles = ",
        "tilse = ",
        8,
        "tilse",
        "unknown key, known here",
    ),
    (
        "\"Fist\", ",
        "",
        8,
        "tiles",
        "5 is not a number of tiles from 6 to 12",
    ),
    (
        r#"tiles = ["Fist", "Point", "V", "OK", "Rock", "Touch me"]"#,
        THIRTEEN,
        8,
        "tiles",
        "13 is not a number of tiles",
    ),
    (
        "\"Fist\"",
        "\"Fits\"",
        8,
        "tiles",
        "\"Fits\" is not the name of a pose, sequence or reaction",
    ),
    (
        "\"Fist\"",
        "\"fist\"",
        8,
        "tiles",
        "\"fist\" is not the name",
    ),
    (
        "\"Fist\"",
        "\"Rock\"",
        8,
        "tiles",
        "the name \"Rock\" is used twice",
    ),
    ("\"Fist\"", "7", 8, "tiles", "is not a text in quotes"),
    (
        "speed = 250",
        "speed = 0",
        9,
        "speed",
        "0 is not allowed here: nothing could move",
    ),
    (
        "speed = 250",
        "speed = 1001",
        9,
        "speed",
        "1001 is outside 0 to 1000",
    ),
    (
        "speed = 250",
        "speed = -1",
        9,
        "speed",
        "-1 is outside 0 to 1000",
    ),
    (
        "force = 700",
        "force = 3001",
        10,
        "force",
        "3001 is outside 0 to 3000",
    ),
    (
        "force = 700",
        "force = 0",
        10,
        "force",
        "nothing could move",
    ),
    (
        "visit_s = 90",
        "visit_s = 4",
        11,
        "visit_s",
        "4 is not a time from 5 to 3600 s",
    ),
    (
        "visit_s = 90",
        "visit_s = 3601",
        11,
        "visit_s",
        "3601 is not a time",
    ),
    (
        "visit_s = 90",
        "visit_s = -9",
        11,
        "visit_s",
        "-9 is not a time",
    ),
    (
        "restart = true",
        "restart = 1",
        12,
        "visitor_restart",
        "is not true or false",
    ),
    (
        "[\"Wave\", \"Wave\"]",
        "[]",
        14,
        "pieces",
        "0 is not a number of pieces from 1 to 40",
    ),
    (
        "\"Wave\", ",
        "\"Tango\", ",
        14,
        "pieces",
        "\"Tango\" is not the name",
    ),
    (
        "after_s = 5",
        "after_s = 0",
        15,
        "after_s",
        "0 is not a time",
    ),
    (
        "play_s = 3600",
        "play_s = 3601",
        16,
        "play_s",
        "3601 is not a time",
    ),
    (
        "rest_s = 30",
        "rest = 30",
        17,
        "rest",
        "unknown key, known here",
    ),
];

#[test]
fn a_wrong_file_is_refused_with_line_field_and_one_sentence() {
    let long = format!("title = \"{}\"", "x".repeat(61));
    let many = format!("pieces = [{}]", "\"Wave\", ".repeat(41));
    let start = format!("\"{}…\" is not one line of at most 60", "x".repeat(40));
    let rows = WRONG.iter().copied().chain([
        (
            "title = \"Touch\"",
            long.as_str(),
            3,
            "title",
            start.as_str(),
        ),
        (
            "pieces = [\"Wave\", \"Wave\"]",
            many.as_str(),
            14,
            "pieces",
            "41 is not a number of pieces",
        ),
    ]);
    for (from, to, line, field, said) in rows {
        let bad = FILE.replacen(from, to, 1);
        assert_ne!(bad, FILE, "{from}");
        let error = error(&bad);
        let (at, told) = ((error.line, error.field.as_deref()), error.to_string());
        assert_eq!(at, (Some(line), Some(field)), "{told}");
        assert!(told.contains(said), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
    let none = FILE.lines().filter(|line| !line.starts_with("tiles"));
    let error = error(&none.collect::<Vec<_>>().join("\n"));
    assert_eq!(error.field.as_deref(), Some("tiles"));
    assert_eq!(error.to_string(), "line 1, `tiles`: it is missing: add it");
}

#[test]
fn a_bad_pin_is_told_without_its_digits() {
    for bad in [
        "\"913\"",
        "\"913913913\"",
        "\"9139x\"",
        "9139",
        "-9139",
        "9139.5",
        "0x9139",
        "09139",
        "9139 9139",
        "\"9139",
        "'9139",
        "9139-01-01",
        "true9139",
        "[9139]",
        "[\"9139\"]",
        "{ pin = 9139 }",
        "{ \"9139\" = 9139 }",
        "\"9139\\q\"",
        "\"9139\" \"9139\"",
    ] {
        let error = error(&FILE.replacen("\"4711\"", bad, 1));
        let told = format!("{error} {error:?}");
        assert!(!told.contains("913"), "{bad}: {told}");
        assert_eq!(error.line, Some(7), "{told}");
        assert_eq!(error.to_string().lines().count(), 1, "{told}");
    }
    let error = error(&FILE.replacen("\"4711\"", "4711", 1));
    assert_eq!(
        error.to_string(),
        "line 7, `pin`: this is not a PIN: 4 to 8 digits in quotation marks"
    );
}
