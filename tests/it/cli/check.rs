//! A check-up by script: what it needs before anything moves, and a person who ends it.

use crate::cli::refuses_unarmed;
use crate::setup::busy::unless_busy;
use crate::setup::process::{run, sim_on_link, sim_on_tcp, start};
use handscope::checkup::kept::file_of;
use handscope::record::file::RecordingFile;
use handscope::transport::Endpoint;
use nix::sys::signal::Signal;

#[test]
fn nothing_moves_before_all_is_in_order() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().to_str().unwrap();
        let full = folder.path().join("full");
        std::fs::create_dir(&full).unwrap();
        std::fs::write(full.join("x"), "x").unwrap();
        let unreadable = file_of(folder.path(), &hand.parse().unwrap());
        refuses_unarmed(&hand, &["check", "--hand", &hand, "--folder", place]);
        let check = |more: &[&str]| {
            let args = ["check", "--hand", &hand, "--folder", place, "--arm"];
            let ended = run(&[&args[..], more].concat());
            assert_eq!(ended.code, Some(1), "{}", ended.err);
            assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
            ended.err
        };
        let refused = check(&["--out", full.to_str().unwrap()]);
        assert!(refused.contains("not empty"), "{refused}");
        let refused = check(&["--recordings", "/nowhere"]);
        assert!(refused.contains("/nowhere is not a folder"), "{refused}");
        std::fs::write(&unreadable, "no JSON\n").unwrap();
        let refused = check(&[]);
        assert!(refused.contains("--folder"), "{refused}");
        let watched = run(&["watch", "--hand", &hand, "--json", "--for", "0.2"]).ok();
        assert_eq!(watched.lines().last().unwrap()["stats"]["writes"], 0);
        let nobody = run(&[
            "check",
            "--hand",
            "tcp:127.0.0.1:9",
            "--folder",
            place,
            "--arm",
        ]);
        assert_eq!((nobody.code, nobody.err.lines().count()), (Some(1), 1));
    });
}

#[test]
fn who_ends_it_gets_a_held_hand_and_a_report_that_says_it_is_partial() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        // A slow line: the first force is read after the first steps.
        let (_sim, hand) = sim_on_link(&folder.path().join("line"), &["--scenario", "free"]);
        let kept = folder.path().join("kept");
        let out = folder.path().join("out");
        let none = folder.path().join("none");
        std::fs::create_dir(&none).unwrap();
        let mut checks = start(&[
            "check",
            "--hand",
            &hand,
            "--arm",
            "--folder",
            kept.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
            "--recordings",
            none.to_str().unwrap(),
        ]);
        while !checks.complaint().contains("3 of 29") {}
        checks.signal(Signal::SIGINT);
        let ended = checks.end();
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        let why = "partial: ended by the user; stopped: feedback shows rest";
        assert!(ended.err.contains(why), "{}", ended.err);
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains("Partial: it ended early, ended by the user"));
        let json = std::fs::read_to_string(out.join("check.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(json["check"]["complete"], false);
        assert_eq!(json["check"]["kept"], false);
        assert!(json["check"]["usage"].is_null(), "there are no recordings");
        let recorded = RecordingFile::open(&out.join("check.mcap")).unwrap();
        assert!(recorded.is_closed() && recorded.overview().counts.writes > 0);
        let canonical = hand.parse::<Endpoint>().unwrap().to_string();
        assert_eq!(recorded.opening().hand, canonical);
        let files = std::fs::read_dir(&kept).unwrap().count();
        assert_eq!(files, 0, "nothing partial is kept");
    });
}
