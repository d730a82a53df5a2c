//! `tune` as a person at a terminal has it: only with their word, refused where it makes no sense, ended by Ctrl-C.

use crate::cli::refuses_unarmed;
use crate::setup::busy::unless_busy;
use crate::setup::process::{run, sim_on_tcp, start};
use handscope::trials::session;
use nix::sys::signal::Signal;

const WAY: [&str; 6] = ["--joint", "index", "--start", "600", "--limit", "500"];

#[test]
fn without_a_persons_word_nothing_moves() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "rigid"]);
        refuses_unarmed(&hand, &[&["tune", "--hand", &hand], &WAY[..]].concat());
    });
}

#[test]
fn a_wish_that_makes_no_sense_is_wrong_usage() {
    unless_busy(|| {
        for (more, words) in [
            (
                &["--limit", "20"][..],
                "a limit of 20 g is not between 30 and 2000",
            ),
            (&["--limit", "heavy"], "heavy"),
            (&["--limit", "500", "--hold", "450"], "at most 400 g"),
            (&["--limit", "500", "--closes", "4"], "5 and 100"),
            (
                &["--limit", "500", "--closes", "10", "--distribution-free"],
                "22 prove 90 of 100",
            ),
            (&["--limit", "500", "--start", "10"], "would close"),
            (&["--limit", "500", "--joint", "pinky"], "not a joint"),
        ] {
            let mut line = vec!["tune", "--hand", "sim:", "--joint", "index", "--arm"];
            line.extend(more);
            let ended = run(&line);
            assert_eq!(ended.code, Some(2), "{more:?} {}", ended.err);
            assert!(ended.err.contains(words), "{more:?} {}", ended.err);
        }
    });
}

#[test]
fn ctrl_c_holds_the_hand_and_keeps_what_was_tried() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("egg");
        let (_sim, hand) = sim_on_tcp(&["--scenario", "rigid"]);
        let out_text = out.display().to_string();
        let line = [
            &[
                "tune", "--hand", &hand, "--arm", "--json", "--out", &out_text,
            ],
            &WAY[..],
        ]
        .concat();
        let mut tune = start(&line);
        let first = tune.line();
        assert!(first.contains("\"trial\""), "{first}");
        tune.signal(Signal::SIGINT);
        let ended = tune.end();
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        assert!(
            ended
                .err
                .contains("ended early after 1 closes: ended by the user"),
            "{}",
            ended.err
        );
        assert!(ended.err.contains("feedback shows rest"), "{}", ended.err);
        let last = ended.lines().pop().unwrap()["tune"].take();
        assert!(
            last["speed"].is_null() && last["stop"]["confirmed"] == true,
            "{last}"
        );
        assert_eq!(last["trials"], 1);
        let kept = session::load(&out).unwrap();
        assert!(!kept.trials.is_empty());
        assert_eq!(kept.head.others["tune"]["limit_g"].as_integer(), Some(500));
    });
}

#[test]
fn no_object_is_said_in_a_sentence_and_the_hand_is_left_open() {
    unless_busy(|| {
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let way = [
            "--joint", "index", "--start", "300", "--close", "200", "--limit", "500",
        ];
        let ended = run(&[&["tune", "--hand", &hand, "--arm", "--json"], &way[..]].concat());
        assert_eq!(ended.code, Some(1), "{}", ended.err);
        assert!(
            ended
                .err
                .contains("index met nothing on its way: put the object"),
            "{}",
            ended.err
        );
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    });
}
