//! Claims about the check-up in the window: asked for, armed by its own button, ended by a key, and what is told of it.

use crate::setup::window::{Bench, Role};
use egui::Key;
use handscope::app::checkup::ShownCheckup;
use handscope::checkup::report::Keeping;
use handscope::checkup::usage::Usage;
use handscope::checkup::{Grade, HandPart, Subject};
use handscope::hand::{Dof, Finger};
use handscope::record::Abort;
use handscope::sim::{BodyParams, Object, Scenario, SimConfig};
use handscope::ui::View;
use std::path::PathBuf;

const EMPTY: &str = "The hand is empty, and nothing is in its way";
const START: &str = "Arm and check up";

fn with(body: BodyParams) -> Bench {
    let config = SimConfig {
        scenario: Scenario::Free,
        body,
        ..SimConfig::default()
    };
    let mut bench = Bench::keeping(config);
    bench.wait(1000);
    bench.show(View::Checkup);
    bench.run(200);
    bench
}

fn said(bench: &Bench, part: &str) {
    assert!(
        !bench.texts_with(part).is_empty(),
        "{part}: {:?}",
        bench.texts()
    );
}

fn runs(bench: &Bench) -> bool {
    bench.state().hand().running.checkup_run().is_some()
}

fn hold(bench: &mut Bench) {
    let at = bench.rect(Role::Button, START).center();
    bench.press_at(at);
    bench.run(1500);
    bench.release_at(at);
    bench.run(100);
}

fn begin(bench: &mut Bench) {
    bench.click_box(EMPTY);
    bench.run(60);
    hold(bench);
    assert!(runs(bench), "it runs");
}

/// Waits for the end of the check-up, and what it came to.
fn finish(bench: &mut Bench, within_ms: u64) -> ShownCheckup {
    let mut left = within_ms;
    while runs(bench) {
        assert!(left > 0, "it does not end");
        bench.wait(500);
        left = left.saturating_sub(500);
    }
    bench.run(100);
    assert!(!bench.state().hand().connection.is_armed());
    bench.state().hand().checkup.last.clone().unwrap()
}

fn folder(shown: &ShownCheckup) -> PathBuf {
    shown.page.as_ref().unwrap().parent().unwrap().to_owned()
}

#[test]
fn a_hand_that_was_never_checked_says_so_and_nothing_begins_before_it_is_said_to_be_empty() {
    let mut bench = with(BodyParams::default());
    said(&bench, "No check-up of this hand yet");
    said(&bench, "Confirm that the hand is empty.");
    hold(&mut bench);
    assert!(!runs(&bench) && !bench.state().hand().connection.is_armed());
    bench.click_box(EMPTY);
    bench.run(60);
    assert!(!bench.is_disabled(Role::Button, START));
}

#[test]
fn a_check_up_is_told_joint_by_joint_and_its_figures_report_and_recording_stay() {
    let mut body = BodyParams::default();
    body.joints[Dof::Middle].backlash = 30.0;
    let mut bench = with(body);
    begin(&mut bench);
    bench.wait(12_000);
    said(&bench, "of 29: Little");
    said(&bench, "Any key ends it with a stop.");
    let run = bench.state().hand().running.checkup_run().unwrap();
    let left = run.left(bench.now()).as_secs();
    assert!((40..80).contains(&left), "{left}");
    let shown = finish(&mut bench, 120_000);
    assert_eq!(shown.report.aborted, None);
    assert_eq!(shown.report.keeping, Keeping::BuiltIn);
    assert!(shown.report.count(Grade::Watch) >= 1);
    let names = ["report.html", "check.json", "check.mcap"];
    for name in names {
        assert!(folder(&shown).join(name).is_file(), "{name}");
    }
    let item = handscope::record::file::RecordingFile::open(&folder(&shown).join("check.mcap"));
    let item = item.unwrap();
    assert!(item.overview().counts.writes > 50 && item.is_closed());
    assert_eq!(item.overview().counts.missing, 0);
    // From such a recording its use is counted: each joint closed at both speeds.
    let hand = bench.state().hand().connection.endpoint.clone().unwrap();
    let usage = Usage::of(&folder(&shown), &hand).unwrap();
    assert!(
        usage.closes.iter().all(|(_, closes)| *closes == 2),
        "{usage:?}"
    );
    assert!(usage.moved_s > 20 && usage.read_s >= usage.moved_s);
    let other = "tcp:127.0.0.1:9".parse().unwrap();
    assert_eq!(Usage::of(&folder(&shown), &other), None);
    bench.click("Only what is not fine");
    bench.run(60);
    let measured = bench.reading("Middle backlash measured");
    let counts: f64 = measured.trim_end_matches(" counts").parse().unwrap();
    assert!((24.0..36.0).contains(&counts), "{measured}");
    assert_eq!(bench.reading("Middle backlash good"), "-8 to 14");
    let advice = bench.reading("Middle backlash what to do");
    assert!(advice.starts_with("inspect the linkage"), "{advice}");
    // What was said of that hand is to be said again.
    said(&bench, "Confirm that the hand is empty.");
}

#[test]
fn any_key_ends_it_with_a_held_hand_and_a_partial_report() {
    let mut bench = with(BodyParams::default());
    begin(&mut bench);
    bench.wait(9000);
    bench.key(Key::A);
    let shown = finish(&mut bench, 5000);
    assert_eq!(shown.report.aborted, Some(Abort::Person));
    assert_eq!(shown.report.keeping, Keeping::Partial);
    said(&bench, "Partial, it ended early: Ended by the user.");
    let figures = bench.labels_below(0.0).into_iter();
    let figures: Vec<_> = figures
        .filter(|(name, _)| name.ends_with(" measured"))
        .collect();
    assert!(!figures.is_empty(), "what was measured is listed");
    let missing = figures.iter().filter(|(_, figure)| figure == "-");
    assert_eq!(missing.count(), 0, "{figures:?}");
    let page = std::fs::read_to_string(shown.page.unwrap()).unwrap();
    assert!(page.contains("Partial: it ended early, ended by the user"));
}

#[test]
fn a_hand_with_something_in_it_is_not_checked_on() {
    let mut bench = with(BodyParams::default());
    bench.hand(|hand, _| hand.set_object(&Object::soft_ball()));
    begin(&mut bench);
    let shown = finish(&mut bench, 60_000);
    assert!(
        matches!(
            shown.report.aborted,
            Some(Abort::NotEmpty { .. } | Abort::Ceiling { .. })
        ),
        "{:?}",
        shown.report.aborted
    );
}

#[test]
fn each_fingertip_is_asked_for_and_a_dead_channel_is_named() {
    let mut body = BodyParams::default();
    body.fingertips[Finger::Index].dead[1] = true;
    let mut bench = with(body);
    bench.click_box("Then press each fingertip");
    begin(&mut bench);
    let mut asked = Vec::new();
    for _ in 0..2000 {
        let Some(run) = bench.state().hand().running.checkup_run() else {
            break;
        };
        let press = run.view.press;
        if let Some(finger) = press.filter(|finger| asked.last() != Some(finger)) {
            asked.push(finger);
            assert!(!bench.state().hand().connection.is_armed());
            said(&bench, "Nothing moves now.");
            bench.hand(|hand, _| hand.press_tip(finger, 800.0));
            bench.wait(1000);
            bench.hand(|hand, _| hand.press_tip(finger, 0.0));
        }
        bench.wait(200);
    }
    assert_eq!(asked.len(), 5);
    let shown = finish(&mut bench, 5000);
    let mut checks = shown.report.checks.iter();
    let of = HandPart::Fingertip(Finger::Index);
    let silent = checks
        .find(|own| (own.measured.what, own.measured.of) == (Subject::SilentChannels, of))
        .unwrap();
    assert_eq!(silent.grade, Grade::Act);
    assert_eq!(silent.measured.channels.to_string(), "2");
    bench.click("Only what is not fine");
    bench.run(60);
    let advice = bench.reading("Index channels that do not answer a press what to do");
    assert!(advice.starts_with("channels 2: clean"), "{advice}");
}
