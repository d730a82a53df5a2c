//! Claims about grasp trials in the window: planned, armed by a person, run on the simulated hand, ended by what is wrong.

use crate::setup::window::{Bench, Role};
use egui::Key;
use handscope::app::trials::TrialSession;
use handscope::hand::{Dof, Fault};
use handscope::record::Rest;
use handscope::sim::{Scenario, SimConfig};
use handscope::trials::{Abort, EarlyEnd, TrialPlan};
use handscope::ui::View;
use std::time::Duration;

/// A short way onto the object, held shortly.
pub(crate) fn short(bench: &mut Bench) {
    for (field, text) in [
        ("Index from", "620"),
        ("Index to", "300"),
        ("Hold, s", "0.5"),
        ("Rest, s", "0"),
        ("Force limit, g", "4000"),
    ] {
        enter(bench, field, text);
    }
}

pub(crate) fn enter(bench: &mut Bench, field: &str, text: &str) {
    bench.type_into(field, text);
    bench.key(Key::Enter);
    bench.run(60);
}

/// A live hand with a hard block in it, on the view of the plan.
pub(crate) fn on_block() -> Bench {
    let config = SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, crate::setup::window::LARGE);
    bench.wait(1000);
    bench.show(View::Tune);
    bench
}

pub(crate) fn arm(bench: &mut Bench) {
    bench.click("Arm the hand");
    bench.run(300);
    assert!(bench.state().hand().connection.is_armed());
}

/// A short series that runs.
fn running() -> Bench {
    let mut bench = on_block();
    short(&mut bench);
    arm(&mut bench);
    bench.click("Start trials");
    bench.run(200);
    assert!(runs(&bench));
    bench
}

fn runs(bench: &Bench) -> bool {
    bench.state().hand().series.is_some()
}

fn plan(bench: &Bench) -> &TrialPlan {
    &bench.state().trials.plan
}

fn last(bench: &Bench) -> &TrialSession {
    bench.state().trials.sessions.last().unwrap()
}

fn ended_by(bench: &Bench) -> Abort {
    assert!(!runs(bench));
    match &last(bench).head.aborted {
        Some(EarlyEnd::Here(why)) => *why,
        other => panic!("{other:?}"),
    }
}

/// Lets time pass until the series is over.
pub(crate) fn finish(bench: &mut Bench, within_ms: u64) {
    bench.run(60);
    let start = bench.now();
    while runs(bench) {
        bench.wait(500);
        let took = bench.now().since(start);
        assert!(took < Duration::from_millis(within_ms), "{took:?}");
    }
}

#[test]
fn starting_needs_an_armed_hand_and_says_so() {
    let mut bench = on_block();
    assert!(bench.is_disabled(Role::Button, "Start trials"));
    assert!(bench.shows("Press Arm first: each series needs a person who arms it."));
    assert!(bench.writes().is_empty());
    arm(&mut bench);
    assert!(!bench.is_disabled(Role::Button, "Start trials"));
    bench.click("Index lock");
    bench.run(60);
    assert!(bench.is_disabled(Role::Button, "Start trials"));
    assert!(bench.shows("Index is locked and would have to move."));
}

#[test]
fn a_plan_says_what_it_will_do_and_how_hard_it_may_hit() {
    let mut bench = on_block();
    assert!(bench.shows("Closes Index. Trials: 1, at most about 20 s."));
    enter(&mut bench, "Speeds to try", "25, 250");
    enter(&mut bench, "Force thresholds to try", "250, 500");
    enter(&mut bench, "Repeats", "3");
    assert_eq!(plan(&bench).grid.settings().len(), 12);
    assert_eq!(bench.texts_with("Trials: 12, at most about").len(), 1);
    assert_eq!(
        bench.texts_with("637 g (speed 250, threshold 500 g)").len(),
        1
    );
    bench.choose("Approach", "Fast to the measured contact");
    assert!(bench.shows("The first, slow one measures the contact."));
    assert!(bench.writes().is_empty(), "planning sends nothing");
}

#[test]
fn what_makes_no_sense_is_said_at_its_field() {
    let mut bench = on_block();
    arm(&mut bench);
    for (field, bad, why, good) in [
        (
            "Index to",
            "990",
            "Index needs a start at least 30 above its target.",
            "0",
        ),
        ("Speeds to try", "0", "Choose between 1 and 1000.", "25"),
        (
            "Force limit, g",
            "100",
            "Choose between 500 and 4000.",
            "2000",
        ),
        ("Hold, s", "0.1", "Choose between 0.3 and 600.", "1"),
    ] {
        enter(&mut bench, field, bad);
        assert!(bench.shows(why), "{why}");
        assert!(bench.is_disabled(Role::Button, "Start trials"), "{why}");
        let below =
            bench.rect(Role::Label, why).top() - bench.rect(Role::TextInput, field).bottom();
        assert!((0.0..12.0).contains(&below), "{why}: {below}");
        enter(&mut bench, field, good);
        assert!(!bench.shows(why));
    }
    enter(&mut bench, "Speeds to try", "25, fast");
    assert!(bench.shows("Write whole numbers with commas, none above 1000."));
    assert_eq!(plan(&bench).grid.speeds.len(), 1, "nothing of it is taken");
}

#[test]
fn joints_and_poses_make_the_way() {
    let mut bench = on_block();
    bench.click("Middle takes part");
    bench.run(60);
    assert!(plan(&bench).close[Dof::Middle].is_some());
    assert_eq!(bench.typed("Middle from"), "1000");
    bench.click("Index takes part");
    bench.click("Middle takes part");
    bench.run(60);
    assert!(bench.shows("Choose at least one joint."));
    bench.click("Start from a pose");
    bench.run(60);
    bench.click("The pose the hand has now");
    bench.run(60);
    let open = bench.angle(Dof::ThumbRotate);
    assert_eq!(
        plan(&bench).start[Dof::ThumbRotate].map(|at| at.get()),
        Some(open)
    );
}

#[test]
fn a_series_runs_to_its_end_and_leaves_the_hand_disarmed() {
    let mut bench = on_block();
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "50, 250");
    arm(&mut bench);
    bench.click("Start trials");
    bench.run(400);
    assert_eq!(bench.texts_with("Trial 1 of 2").len(), 1);
    assert!(bench.shows("End with a stop") && bench.shows("Force now, g"));
    assert!(
        bench.is_disabled(Role::Slider, "Ring angle target"),
        "sliders rest"
    );
    assert!(bench.all_disabled("Open all").iter().all(|off| *off));
    for field in [
        "Index force number",
        "Index speed number",
        "All speed number",
    ] {
        assert_eq!(bench.typed(field), "-", "{field}: each trial sets its own");
    }
    finish(&mut bench, 60_000);
    assert!(
        !bench.state().hand().connection.is_armed(),
        "each series wants its own arming"
    );
    let session = last(&bench);
    assert_eq!((session.trials.len(), &session.head.aborted), (2, &None));
    let peaks: Vec<f64> = session
        .trials
        .iter()
        .map(|tried| tried.summary.joints[0].overshoot_g.unwrap())
        .collect();
    assert!(peaks[0] < 250.0 && peaks[1] > 350.0, "{peaks:?}");
    assert!(bench.shows("Last series: all trials done."));
    assert!(
        (bench.angle(Dof::Index) - 620).abs() < 25,
        "back at its start"
    );
    bench.click("Opens what was measured.");
    bench.run(60);
    assert_eq!(bench.view(), View::Compare);
}

#[test]
fn after_a_series_nothing_is_said_to_move_a_hand_that_came_to_rest() {
    let mut bench = on_block();
    short(&mut bench);
    arm(&mut bench);
    bench.click("Start trials");
    bench.until(60_000, |bench| !runs(bench));
    let stands = |bench: &Bench| {
        let status = bench.state().hand().readings.sample.status.unwrap();
        status.value.iter().all(|(_, status)| status.is_stopped())
    };
    bench.until(2000, stands);
    assert_eq!(
        bench.state().hand().connection.status.rest,
        Rest::Moving,
        "not yet"
    );
    bench.run(20);
    assert_eq!(bench.texts_with("The hand moves"), [""; 0]);
}

#[test]
fn what_was_tried_is_saved_by_itself_and_the_views_say_where() {
    let mut bench = Bench::keeping(SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    });
    bench.show(View::Tune);
    short(&mut bench);
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    bench.until(10_000, |bench| last(bench).origin.is_in_files());
    for view in [View::Tune, View::Compare] {
        bench.show(view);
        let said = bench.texts_with("Saved in ");
        assert!(
            said.iter()
                .any(|text| text.contains("documents/Handscope/")),
            "{said:?}"
        );
    }
}

#[test]
fn what_came_out_is_staged_and_leads_to_the_parameters_and_nothing_is_written() {
    let mut bench = on_block();
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "50, 250");
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    assert_eq!(bench.texts_with("Least overshoot: 50 / 500 g").len(), 1);
    let writes = bench.writes().len();
    bench.click("Stages speed and threshold of the best as those after power-up, for the joints tried. Nothing is written.");
    bench.run(100);
    assert_eq!(bench.texts_with("Staged, nothing is written yet.").len(), 1);
    bench.click("Opens the parameters, where what is staged is checked, applied and saved.");
    bench.run(60);
    assert_eq!(bench.view(), View::Device);
    assert_eq!(bench.writes().len(), writes);
}

#[test]
fn any_key_stops_it_and_does_nothing_else() {
    for key in [Key::L, Key::F7, Key::Enter, Key::ArrowLeft] {
        let mut bench = running();
        bench.key(key);
        finish(&mut bench, 1000);
        assert_eq!(ended_by(&bench), Abort::Person, "{key:?}");
        assert!(!bench.state().hand().connection.is_armed());
        assert!(bench.shows("Last series: Ended by a person."), "{key:?}");
    }
}

#[test]
fn stop_ends_it_wherever_it_is_pressed() {
    for name in ["STOP", "End with a stop"] {
        let mut bench = running();
        bench.click_button(name);
        finish(&mut bench, 1000);
        assert_eq!(ended_by(&bench), Abort::Person, "{name}");
    }
}

#[test]
fn disarming_ends_it_with_a_stop() {
    let mut bench = running();
    bench.click("Disarm the hand");
    finish(&mut bench, 1000);
    assert_eq!(ended_by(&bench), Abort::Disarmed);
    assert!(!bench.texts_with("no longer armed for it").is_empty());
}

#[test]
fn a_fault_ends_it() {
    let mut bench = running();
    bench.hand(|hand, _| hand.inject_fault(Dof::Middle, Fault::OverCurrent));
    bench.wait(400);
    assert!(matches!(
        ended_by(&bench),
        Abort::Fault {
            dof: Dof::Middle,
            ..
        }
    ));
    assert_eq!(bench.texts_with("Middle reports a fault:").len(), 1);
}

#[test]
fn a_lost_link_ends_it() {
    let mut bench = running();
    bench.unplug();
    bench.wait(1500);
    let why = ended_by(&bench);
    assert!(
        matches!(why, Abort::LinkLost | Abort::NotRead { .. }),
        "{why:?}"
    );
    assert!(bench.is_disabled(Role::Button, "Start trials"));
}

#[test]
fn the_force_ceiling_ends_it_while_it_closes() {
    let mut bench = on_block();
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "250");
    enter(&mut bench, "Force limit, g", "700");
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 20_000);
    assert!(matches!(
        ended_by(&bench),
        Abort::Ceiling {
            dof: Dof::Index,
            ceiling: 700,
            ..
        }
    ));
    assert_eq!(last(&bench).trials.len(), 1, "what was read is kept");
}

#[test]
fn a_fast_approach_to_the_measured_contact_is_gentle() {
    let mut bench = on_block();
    short(&mut bench);
    bench.choose("Approach", "Fast to the measured contact");
    arm(&mut bench);
    bench.click("Start trials");
    bench.run(200);
    assert_eq!(bench.texts_with("looks for the contact").len(), 1);
    finish(&mut bench, 60_000);
    let session = last(&bench);
    assert_eq!(session.head.aborted, None);
    let repeats: Vec<_> = session
        .trials
        .iter()
        .map(|tried| tried.summary.repeat)
        .collect();
    assert_eq!(repeats, [None, Some(1)]);
    assert!(session.trials[1].summary.joints[0].overshoot_g.unwrap() < 100.0);
}

#[test]
fn nothing_moves_by_opening_the_view_or_by_arming() {
    let mut bench = on_block();
    arm(&mut bench);
    bench.wait(500);
    assert!(bench.state().hand().series.is_none());
    assert_eq!(bench.angle(Dof::Index), 1000);
}

#[test]
fn start_and_target_of_a_joint_have_room_in_the_smallest_window() {
    let mut bench = Bench::open(SimConfig::default(), egui::vec2(1024.0, 640.0));
    bench.wait(1000);
    bench.show(View::Tune);
    for field in ["Index from", "Index to"] {
        assert!(
            bench.rect(Role::TextInput, field).width() >= 48.0,
            "{field}"
        );
    }
    enter(&mut bench, "Index to", "300");
    assert_eq!(plan(&bench).close[Dof::Index].unwrap().get(), 300);
}
