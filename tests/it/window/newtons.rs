//! The calibration of a finger's force with a kitchen scale, in the window: what is asked and typed, what is stored, and how it ends.

use crate::setup::grasp;
use crate::setup::window::{Bench, LARGE, Role};
use crate::window::tune::{arm, enter, finish, grid, short};
use egui::Key;
use handscope::app::action::Action;
use handscope::hand::newtons::{ForceUnit, LOADS, N_PER_G};
use handscope::hand::{Dof, Finger, PerDof};
use handscope::poses::Preset;
use handscope::sim::object::{Object, Obstacle};
use handscope::sim::{Scenario, SimConfig};
use handscope::ui::View;

const START: &str = "Start pressing";
const SHOWS: &str = "The scale shows, g";

/// A hand whose index finger is above a scale, with the check-up shown.
fn at_a_scale() -> Bench {
    let config = SimConfig {
        scenario: Scenario::Free,
        ..SimConfig::default()
    };
    let mut bench = Bench::keeping(config);
    bench.wait(1000);
    let contacts = PerDof::from_fn(|dof| (dof == Dof::Index).then(|| Obstacle::at(900.0, 6.4)));
    bench.hand(|hand, _| hand.set_object(&Object::touched_at(contacts)));
    bench.show(View::Checkup);
    bench.run(200);
    bench
}

fn begin(bench: &mut Bench) {
    bench.click("Arm the hand");
    bench.run(300);
    bench.click_button(START);
    bench.run(300);
    assert!(bench.state().hand().running.calibrates());
}

fn asked(bench: &Bench) -> Option<usize> {
    let run = bench.state().hand().running.scale()?;
    run.asked.map(|(load, _)| load)
}

/// Types what a scale shows that reads this share of the hand's grams.
fn answer(bench: &mut Bench, share: f64) {
    bench.until(60_000, |bench| asked(bench).is_some());
    bench.wait(1500);
    let load_g = bench.hand(|hand, _| hand.true_loads())[Finger::Index];
    bench.type_into(SHOWS, &format!("{:.0}", load_g * share));
    bench.key(Key::Enter);
    bench.run(100);
}

#[test]
fn five_readings_make_newtons_which_are_shown_and_stored() {
    let mut bench = at_a_scale();
    begin(&mut bench);
    for _ in 0..LOADS {
        answer(&mut bench, 0.72);
    }
    bench.until(60_000, |bench| !bench.state().hand().running.calibrates());
    bench.run(500);
    let per_g = bench.state().hand().newtons.per_g(Dof::Index).unwrap();
    let wanted = 0.72 * N_PER_G;
    assert!((per_g / wanted - 1.0).abs() < 0.08, "{per_g} {wanted}");
    assert!(bench.state().hand().connection.status.armed.is_none());
    assert!(!bench.texts_with("Index: 100 g = 0.7").is_empty());
    assert!(bench.shows("Index: measured"), "{:?}", bench.texts());
    bench.click_button("Forget");
    bench.run(500);
    assert_eq!(bench.state().hand().newtons.per_g(Dof::Index), None);
    assert!(bench.shows("Index: not measured"));
}

#[test]
fn unarmed_nothing_is_pressed_and_a_stop_ends_a_calibration() {
    let mut bench = at_a_scale();
    let writes = bench.writes().len();
    bench.click_button(START);
    bench.run(300);
    assert_eq!(bench.writes().len(), writes, "nothing is sent");
    begin(&mut bench);
    bench.until(60_000, |bench| asked(bench).is_some());
    bench.act(Action::Stop);
    bench.run(1500);
    assert!(!bench.state().hand().running.calibrates());
    assert!(bench.state().hand().connection.status.armed.is_none());
}

#[test]
fn moving_a_joint_takes_the_hand_over_from_a_calibration() {
    let mut bench = at_a_scale();
    begin(&mut bench);
    bench.act(Action::Preset(Preset::Open));
    bench.run(300);
    assert!(!bench.state().hand().running.calibrates());
    assert!(bench.state().hand().connection.is_armed());
    bench.wait(3000);
    let angles = bench.hand(|hand, _| hand.true_angles());
    assert!(angles[Dof::Index] > 950.0, "{angles:?}");
}

#[test]
fn accepted_readings_remain_when_it_ends_early() {
    let mut bench = at_a_scale();
    begin(&mut bench);
    answer(&mut bench, 0.8);
    answer(&mut bench, 0.8);
    bench.until(60_000, |bench| asked(bench).is_some());
    bench.click_button("End");
    bench.until(60_000, |bench| !bench.state().hand().running.calibrates());
    bench.run(500);
    let points = bench.state().hand().newtons.points(Dof::Index).unwrap();
    assert_eq!(points.points.len(), 2);
    assert!(bench.shows("Index: 2 of 5 loads"));
    assert_eq!(bench.state().hand().newtons.per_g(Dof::Index), None);
}

/// Connects again, with all fingers measured: the hand reads true grams.
fn measure(bench: &mut Bench, hand: &str) {
    grasp::store(&bench.folder().join("kept/settings.toml"), hand, "Ball");
    bench.act(Action::Disconnect);
    bench.wait(500);
    bench.act(Action::Connect(hand.parse().unwrap()));
    bench.wait(1500);
}

#[test]
fn the_forces_of_a_hold_stand_in_newtons_of_the_fingers_that_were_measured() {
    let hand = "tcp:10.0.0.1";
    let mut bench = Bench::kept(SimConfig::default(), hand, LARGE);
    bench.wait(1000);
    bench.click("Hold");
    bench.run(100);
    assert!(bench.texts_with("as measured for").is_empty());
    bench.click("Hold");
    measure(&mut bench, hand);
    bench.click("Hold");
    bench.run(100);
    // 150 and 400 g.
    let shown = bench.texts_with("At least 1.5 N, at most 3.9 N, as measured for");
    assert_eq!(shown.len(), 1, "{:?}", bench.texts());
}

#[test]
fn a_hold_is_set_in_newtons_once_all_fingers_were_measured_and_nothing_is_converted() {
    let hand = "tcp:10.0.0.1";
    let mut bench = Bench::kept(SimConfig::default(), hand, LARGE);
    bench.wait(1000);
    bench.click("Hold");
    bench.run(100);
    assert!(bench.is_disabled(Role::Button, "N"));
    bench.click("Hold");
    measure(&mut bench, hand);
    bench.click("Hold");
    bench.run(100);
    enter(&mut bench, "At most, g", "500");
    bench.click_button("N");
    bench.run(100);
    assert_eq!(bench.typed("At least, N"), "1.5");
    enter(&mut bench, "At most, N", "3");
    let grams = |bench: &Bench, unit: ForceUnit| {
        let forces = bench.state().hand().controls.hold_forces_in(unit);
        (forces.at_least().get(), forces.at_most().get())
    };
    assert_eq!(grams(&bench, ForceUnit::Newtons), (150, 306));
    assert_eq!(grams(&bench, ForceUnit::Grams), (150, 500));
    bench.act(Action::Arm);
    bench.run(300);
    bench.click("Close all fingers");
    bench.run(100);
    let run = bench.state().hand().running.hold().unwrap();
    assert_eq!(run.unit, ForceUnit::Newtons);
    assert_eq!(run.view.forces.at_most().get(), 306);
    bench.click("End the hold");
    bench.run(300);
    bench.click_button("g");
    bench.run(100);
    assert_eq!(bench.typed("At most, g"), "500");
}

#[test]
fn the_table_of_trials_shows_newtons_beside_grams_of_the_hand_that_was_measured() {
    let hand = "tcp:10.0.0.1";
    let config = SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    };
    let mut bench = Bench::kept(config, hand, LARGE);
    bench.wait(1000);
    grid(&mut bench);
    short(&mut bench);
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    bench.show(View::Compare);
    let grams: f64 = bench.reading("1 Peak, g").parse().unwrap();
    assert!(bench.texts_with("Peak, N").is_empty());
    measure(&mut bench, hand);
    bench.show(View::Compare);
    bench.run(100);
    let newtons: f64 = bench.reading("1 Peak, N").parse().unwrap();
    assert!((newtons - N_PER_G * grams).abs() < 0.06, "{grams} g");
    assert_eq!(bench.reading("1 Peak, g").parse::<f64>().unwrap(), grams);
    // A session of another hand has none.
    bench.act(Action::Connect("tcp:10.0.0.2".parse().unwrap()));
    bench.wait(1500);
    bench.show(View::Compare);
    bench.run(100);
    assert!(bench.texts_with("Peak, N").is_empty());
}
