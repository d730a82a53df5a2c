//! Gamepads from the command line, on folders without any.

use crate::setup::busy::unless_busy;
use crate::setup::process::{run, start};
use nix::sys::signal::Signal;
use std::fs;

#[test]
fn a_folder_without_a_gamepad_is_told_in_one_sentence() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().to_str().unwrap();
        let ended = run(&["inputs", "--devices", place]);
        assert_eq!((ended.code, ended.out.as_str()), (Some(0), ""));
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
        assert!(ended.err.contains(place), "{}", ended.err);
        let missing = folder.path().join("none");
        let ended = run(&["inputs", "--devices", missing.to_str().unwrap()]);
        assert_eq!(ended.code, Some(1));
        assert!(ended.err.contains("cannot be listed"), "{}", ended.err);
        let ended = run(&["inputs", "--watch", "--devices", missing.to_str().unwrap()]);
        assert_eq!(ended.code, Some(1));
        assert!(ended.err.contains("there is no folder"), "{}", ended.err);
    });
}

#[test]
fn a_map_that_cannot_be_taken_is_told_with_its_line() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pad.toml");
        let text = "format = \"handscope-gamepad\"\nversion = 1\n[controls]\neast = \"jump\"\n";
        fs::write(&path, text).unwrap();
        let path = path.to_str().unwrap();
        let ended = run(&["inputs", "--watch", "--map", path]);
        assert_eq!((ended.code, ended.out.as_str()), (Some(1), ""));
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
        assert!(
            ended.err.contains("pad.toml: line 4, `east`"),
            "{}",
            ended.err
        );
    });
}

#[test]
fn the_watch_waits_for_a_gamepad_until_ctrl_c() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().to_str().unwrap();
        let mut running = start(&["inputs", "--watch", "--devices", place]);
        assert!(running.complaint().contains("hold left_bumper"));
        running.signal(Signal::SIGINT);
        let ended = running.end();
        assert_eq!((ended.code, ended.out.as_str()), (Some(0), ""));
    });
}
