//! What trials measured of this hand: it replaces another hand's figures in the warnings, is shown, exported, forgotten, and
//! found again at the next connection.

use crate::setup::window::{Bench, LARGE, Role};
use crate::window::tune::{arm, enter, finish, grid, on_block, short};
use handscope::app::action::Action;
use handscope::hand::overshoot::{MeasuredOn, Stages};
use handscope::hand::{Dof, Speed};
use handscope::sim::{Scenario, SimConfig};
use handscope::ui::View;

const SPEED: f64 = 250.0;
const THRESHOLD_G: f64 = 500.0;

/// What the warnings of the index finger go by at what was tried.
fn measured_on(bench: &Bench) -> MeasuredOn {
    let map = &bench.state().hand().overshoot.map;
    map.expected(Dof::Index, Stages::One, SPEED, THRESHOLD_G).on
}

/// Three closes on a block.
fn try_three_times(bench: &mut Bench) {
    short(bench);
    enter(bench, "Speeds to try", "250");
    enter(bench, "times each", "3");
    arm(bench);
    bench.click("Start trials");
    finish(bench, 60_000);
}

#[test]
fn warnings_go_by_this_hand_once_it_was_tried_and_by_another_once_that_is_forgotten() {
    let mut bench = on_block();
    bench.click("This hand");
    bench.run(60);
    assert!(bench.shows("Nothing measured of this hand yet"));
    assert_eq!(measured_on(&bench), MeasuredOn::AnotherHand);
    bench.click("Trials");
    bench.run(60);
    try_three_times(&mut bench);
    assert!(matches!(
        measured_on(&bench),
        MeasuredOn::ThisHand { closes: 3, .. }
    ));
    bench.click("This hand");
    bench.run(60);
    assert!(bench.shows("Overshoot of this hand over speed") && bench.shows("rigid"));
    let map = bench.state().hand().overshoot.map.clone();
    let [kind] = map.kinds() else {
        panic!("{map:?}")
    };
    let row = format!("{:+.0} g", kind.most_over_g);
    assert!(bench.shows(&row), "{row}: {:?}", bench.texts());
    bench.click("Forget");
    bench.run(60);
    bench.click("Keep it");
    bench.run(60);
    assert!(
        !bench.state().hand().overshoot.map.is_empty(),
        "it was only asked"
    );
    bench.click("Forget");
    bench.run(60);
    bench.click("Forget all of it");
    bench.run(60);
    assert!(bench.shows("Nothing measured of this hand yet"));
    assert_eq!(measured_on(&bench), MeasuredOn::AnotherHand);
}

#[test]
fn the_slanted_part_of_a_track_begins_where_this_hand_was_measured_to_be_rough() {
    let mut bench = on_block();
    let rough = |bench: &Bench| {
        let hand = bench.state().hand();
        let threshold = handscope::hand::Force::GENTLE;
        hand.overshoot.map.rough_from_speed(Dof::Index, threshold)
    };
    let before = rough(&bench).map(Speed::get).unwrap();
    bench.click("Trials");
    try_three_times(&mut bench);
    let after = rough(&bench).map(Speed::get).unwrap();
    assert_ne!(
        before, after,
        "the block of the simulated hand is not the published one"
    );
    bench.show(View::Live);
    bench.run(60);
    assert!(
        bench
            .all(Role::Slider)
            .iter()
            .any(|(name, _)| name == "Index speed")
    );
}

#[test]
fn it_is_kept_for_its_place_and_for_no_other() {
    let config = SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    };
    let mut bench = Bench::kept(config, "tcp:127.0.0.1:6000", LARGE);
    bench.wait(2000);
    grid(&mut bench);
    try_three_times(&mut bench);
    let of_here = measured_on(&bench);
    assert!(matches!(of_here, MeasuredOn::ThisHand { .. }));
    let file = |bench: &Bench| {
        let kept = bench.folder().join("kept/overshoot");
        let files = std::fs::read_dir(kept).map(Iterator::count);
        files.unwrap_or(0)
    };
    bench.until(10_000, |bench| file(bench) == 1);
    bench.wait(500);
    bench.act(Action::Disconnect);
    bench.wait(1000);
    assert_eq!(measured_on(&bench), MeasuredOn::AnotherHand);
    bench.act(Action::Connect("tcp:127.0.0.1:6000".parse().unwrap()));
    bench.until(10_000, |bench| measured_on(bench) == of_here);
    bench.open_another("tcp:127.0.0.1:6001");
    bench.wait(2000);
    assert_eq!(measured_on(&bench), MeasuredOn::AnotherHand);
}

#[test]
fn the_axes_follow_what_is_measured_while_the_chart_is_open() {
    let mut bench = on_block();
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "25");
    bench.click("This hand");
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    bench.run(60);
    // Neither number stands in the table.
    assert!(bench.is_bright("20") && !bench.is_bright("200"));
    enter(&mut bench, "Speeds to try", "250");
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    bench.run(60);
    assert!(bench.is_bright("200"), "the speed axis");
}
