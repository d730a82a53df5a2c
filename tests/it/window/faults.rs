//! Claims about the view that explains the hand: what was missed is shown until seen, words are a click away, the log.

use crate::setup::window::{Bench, LARGE, Role};
use egui::{Key, Modifiers};
use handscope::app::action::Action;
use handscope::app::notices::NoticeKind;
use handscope::hand::{Dof, Fault};
use handscope::sim::SimConfig;
use handscope::ui::View;

/// A stall of the index finger that came and went.
fn missed() -> Bench {
    let mut bench = Bench::live();
    bench.hand(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall));
    bench.wait(1500);
    bench.hand(|hand, now| {
        let one = handscope::hand::register::CLEAR_ERROR.address;
        hand.write(one, &[1], now).map(drop).unwrap();
    });
    bench.wait(500);
    assert!(!bench.shows("FAULT"));
    bench
}

#[test]
fn a_fault_that_went_unseen_is_told_of_everywhere_until_a_person_says_that_they_saw_it() {
    let mut bench = missed();
    for view in [View::Live, View::Poses, View::Faults, View::Tune] {
        bench.show(view);
        bench.run(60);
        assert!(
            bench.shows("Faults: 1 unseen"),
            "{view:?}: opening a view is not seeing"
        );
        assert!(bench.shows("Index unseen fault"), "{view:?}");
    }
    bench.click("Faults: 1 unseen");
    bench.run(60);
    assert!(bench.shows("over, not seen yet"));
    assert!(
        !bench.texts_with("lasted 1.5 s").is_empty(),
        "{:?}",
        bench.texts_with("lasted")
    );
    bench.click("Seen: Index: Stall");
    bench.run(60);
    assert!(!bench.shows("Faults: 1 unseen") && !bench.shows("Index unseen fault"));
    assert!(bench.shows("over"), "it stays in the list");
    assert!(bench.is_disabled(Role::Button, "All seen"));
    assert!(
        bench.writes().iter().all(|write| write.bytes == [1]),
        "ours: none"
    );
}

#[test]
fn all_faults_are_seen_at_once_and_unseen_when_they_come_again() {
    let mut bench = missed();
    bench.hand(|hand, _| hand.inject_fault(Dof::Ring, Fault::Motor));
    bench.wait(200);
    bench.show(View::Faults);
    bench.run(60);
    assert!(bench.shows("Faults: 2 unseen"));
    bench.click("All seen");
    bench.run(60);
    assert!(bench.texts_with("unseen").is_empty());
    bench.hand(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall));
    bench.wait(200);
    assert!(bench.shows("Faults: 1 unseen"));
    assert!(!bench.texts_with("2 times").is_empty());
}

#[test]
fn the_list_stands_still_while_the_pointer_is_on_it() {
    let mut bench = missed();
    bench.show(View::Faults);
    bench.run(60);
    let clear = bench.rect(Role::Button, "Clear errors");
    bench.point(clear.center_bottom() + egui::vec2(0.0, 60.0));
    // The messages at the right have the same words.
    let top = |bench: &Bench, name: &str| {
        let all = bench.all(Role::Label).into_iter();
        let named = all.filter(|(other, _)| other == name).map(|(_, rect)| rect);
        let first = named.min_by(|one, other| one.left().total_cmp(&other.left()));
        first.unwrap_or_else(|| panic!("no {name}")).top()
    };
    bench.hand(|hand, _| hand.inject_fault(Dof::Ring, Fault::Motor));
    bench.run(400);
    let (index, ring) = (
        top(&bench, "Index: Stall"),
        top(&bench, "Ring: Motor fault"),
    );
    assert!(ring > index, "the new one comes last: {index} {ring}");
    bench.point_away();
    bench.run(100);
    assert!(top(&bench, "Ring: Motor fault") < top(&bench, "Index: Stall"));
}

#[test]
fn the_status_of_a_joint_is_one_click_away_from_its_explanation() {
    let mut bench = Bench::live();
    bench.hand(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall));
    bench.hand(|hand, _| hand.inject_fault(Dof::Ring, Fault::Motor));
    bench.wait(200);
    bench.click("Index status, explained");
    bench.run(60);
    assert!(bench.shows("Index · says now: Stall"));
    let labels = bench.all(Role::Label);
    let top = |text: &str| {
        labels
            .iter()
            .find(|(name, _)| name == text)
            .unwrap()
            .1
            .top()
    };
    assert!(
        top("Index: Stall") < top("Ring: Motor fault"),
        "the asked one first"
    );
    bench.click("Ring status, explained");
    bench.run(60);
    assert!(bench.shows("Ring · says now: Motor fault"));
    bench.click("Show all drives");
    bench.run(60);
    assert!(bench.texts_with("says now").is_empty());
}

#[test]
fn who_meets_a_word_for_the_first_time_finds_it_explained_without_any_fault() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.wait(500);
    bench.click_button("Faults");
    bench.run(60);
    bench.click("What the words mean");
    for stall in ["Stall: ", "堵转故障："] {
        bench.run(60);
        assert_eq!(bench.texts_with(stall).len(), 1, "{stall}");
        bench.key_with(Modifiers::COMMAND, Key::L);
        bench.run(60);
    }
    assert_eq!(bench.writes(), []);
}

#[test]
fn the_log_keeps_what_was_dismissed_and_is_filtered_and_copied() {
    let mut bench = missed();
    bench.click("Arm the hand");
    bench.run(200);
    bench.click_button("STOP");
    bench.wait(1000);
    let told = bench.state().notices.iter();
    let rest = told
        .filter(|notice| matches!(notice.what, NoticeKind::HoldConfirmed { .. }))
        .map(|notice| notice.id);
    for id in rest.collect::<Vec<_>>() {
        bench.act(Action::Dismiss(id));
    }
    bench.show(View::Faults);
    bench.run(60);
    let copy = |bench: &mut Bench| bench.click_to_copy("Copy: Messages").unwrap();
    let all = copy(&mut bench);
    assert!(
        all.contains("warning  Index: Stall") && all.contains("info  Feedback shows rest"),
        "{all}"
    );
    assert!(
        all.find("Feedback") < all.find("Index: Stall"),
        "newest first"
    );
    bench.type_into("Filter messages", "Warning");
    bench.run(60);
    let some = copy(&mut bench);
    assert!(
        some.contains("Stall") && !some.contains("Feedback"),
        "{some}"
    );
    bench.type_into("Filter messages", "REST");
    bench.run(60);
    let some = copy(&mut bench);
    assert!(
        !some.contains("Stall") && some.contains("Feedback"),
        "{some}"
    );
    bench.type_into("Filter messages", "nothing like it");
    bench.run(60);
    assert!(bench.shows("No message passes the filter."));
}

/// A stall in the middle of a movement, with a person's hand on it, and its recording's end.
fn recorded() -> Bench {
    let mut bench = Bench::armed();
    bench.drag("Index angle target", 1.0, 0.3);
    bench.wait(1500);
    bench.hand(|hand, _| hand.inject_fault(Dof::Index, Fault::Stall));
    bench.wait(2000);
    bench.show(View::Faults);
    bench.run(60);
    bench.click("Clear errors");
    bench.wait(500);
    bench.click("Fault recordings");
    bench.run(60);
    assert!(!bench.texts_with("Recording a fault, ends in").is_empty());
    bench.wait(13_000);
    bench
}

#[test]
fn what_happened_around_a_fault_can_be_looked_at_and_saved_and_nothing_is_sent() {
    let mut bench = recorded();
    let before = bench.writes().len();
    assert!(bench.shows("Fault recordings (1)"));
    bench.click("Open: Index: Stall");
    bench.run(60);
    assert!(bench.shows("Recording: Index: Stall"));
    let texts = bench.texts();
    let list = texts.iter().position(|text| text == "What happened");
    let texts = texts.get(list.unwrap()..).unwrap();
    let place = |part: &str| {
        let found = texts.iter().position(|text| text.starts_with(part));
        found.unwrap_or_else(|| panic!("no '{part}' in {texts:?}"))
    };
    let story = [
        "Index target 2",
        "Index: Stall",
        "Clear errors",
        "Index: no fault",
    ];
    let story = story.map(place);
    assert!(story.is_sorted(), "{story:?}");
    bench.click("5 s around");
    bench.run(60);
    bench.click("Save CSV");
    bench.wait(400);
    let text = std::fs::read_to_string(bench.folder().join("handscope-fault.csv")).unwrap();
    let head: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    for column in [
        "angle_index",
        "force_index_g",
        "normal_thumb_N",
        "target_angle_index",
        "status_index",
        "faults_index",
        "event",
    ] {
        assert!(head.contains(&column), "{column}");
    }
    for line in ["armed", "target index", "fault", "clear errors"] {
        assert!(
            text.lines()
                .any(|row| row.rsplit(',').next().unwrap().starts_with(line)),
            "{line}"
        );
    }
    assert!(text.lines().count() > 1500);
    assert_eq!(
        bench.writes().len(),
        before,
        "nothing is played back to the hand"
    );
    bench.click("Back");
    bench.run(60);
    assert!(bench.shows("over, not seen yet") && bench.shows("Fault recordings (1)"));
}

#[test]
fn a_recording_is_reached_from_its_fault_and_stays_when_the_hand_is_gone() {
    let mut bench = recorded();
    bench.unplug();
    bench.wait(1000);
    bench.click("Recording: Index: Stall");
    bench.run(60);
    assert!(bench.shows("What happened"));
    bench.click("Ring status, explained");
    bench.run(60);
    assert!(!bench.shows("What happened"), "a joint leads back");
}

#[test]
fn no_two_controls_overlap_in_an_opened_recording() {
    for size in [egui::vec2(1024.0, 640.0), LARGE] {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.wait(400);
        bench.hand(|hand, _| hand.inject_fault(Dof::ThumbRotate, Fault::OverTemperature));
        bench.wait(17_000);
        bench.show(View::Faults);
        bench.run(60);
        bench.click("Fault recordings (1)");
        bench.run(60);
        crate::window::layout::check(&bench, size, "STOP", &format!("{size} list"));
        bench.click("Open: Thumb rotate: Over-temperature");
        bench.run(60);
        crate::window::layout::check(&bench, size, "STOP", &format!("{size} recording"));
        bench.key_with(Modifiers::COMMAND, Key::L);
        bench.run(60);
        crate::window::layout::check(&bench, size, "停止", &format!("{size} in Chinese"));
    }
}
