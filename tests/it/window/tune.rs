//! Claims about grasp trials in the window: planned, armed by a person, run on the simulated hand, ended by what is wrong.

use crate::setup::window::{ANGLE_SET, Bench, FORCE_SET, Role, SPEED_SET, Write};
use egui::Key;
use handscope::app::action::Action;
use handscope::app::trials::{TrialAction, TrialSession};
use handscope::hand::{Dof, Fault};
use handscope::params::rows::{ParamId, Value};
use handscope::record::Abort;
use handscope::record::{Disarmed, Rest};
use handscope::sim::{Scenario, SimConfig};
use handscope::trials::{EarlyEnd, TrialPlan};
use handscope::ui::View;
use std::time::Duration;

/// The button that is held.
const GUARDED: &str = "Arm and start";

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

/// Shows the plan of a grid.
pub(crate) fn grid(bench: &mut Bench) {
    bench.show(View::Tune);
    bench.click("Try a grid");
}

/// A live hand with a hard block in it, on the view of the plan.
pub(crate) fn on_block() -> Bench {
    let config = SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, crate::setup::window::LARGE);
    bench.wait(1000);
    grid(&mut bench);
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
    bench.state().hand().running.series().is_some()
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

/// Presses the guarded button and holds it for so long.
fn hold(bench: &mut Bench, millis: u64) {
    bench.press(GUARDED);
    bench.run(millis);
}

/// Nothing was armed, begun or written.
fn check_nothing(bench: &Bench, why: &str) {
    assert!(!runs(bench), "{why}");
    assert!(!bench.state().hand().connection.is_armed(), "{why}");
    let arms = |write: &Write| [SPEED_SET, FORCE_SET].contains(&write.address);
    assert!(!bench.writes().iter().any(arms), "{why}");
    assert_eq!(bench.angle(Dof::Index), 1000, "{why}");
}

/// After a short series, in a window that keeps what it did in a folder.
fn tried() -> Bench {
    let mut bench = Bench::keeping(SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    });
    grid(&mut bench);
    short(&mut bench);
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    bench
}

#[test]
fn held_for_a_second_the_button_arms_the_hand_and_then_starts() {
    let mut bench = on_block();
    short(&mut bench);
    assert!(bench.shows("Hold for 1 s, by mouse or Enter: then the hand moves."));
    hold(&mut bench, 900);
    check_nothing(&bench, "not yet");
    bench.until(1000, runs);
    let is_angle = |write: &Write| (ANGLE_SET..ANGLE_SET + 12).contains(&write.address);
    let writes = bench.writes();
    let limits = |address| writes.iter().position(|write| write.address == address);
    let first_angle = writes.iter().position(is_angle);
    for address in [SPEED_SET, FORCE_SET] {
        let limit = limits(address);
        assert!(limit.is_some() && first_angle.is_none_or(|angle| limit < Some(angle)));
    }
    let at = bench.rect(Role::Button, "End with a stop").center();
    bench.release_at(at + egui::vec2(0.0, 300.0));
    bench.run(300);
    assert!(runs(&bench), "letting go afterwards ends nothing");
    finish(&mut bench, 60_000);
    assert_eq!(last(&bench).head.aborted, None);
    bench.run(2000);
    assert!(!runs(&bench), "once is once");
}

#[test]
fn no_tooltip_covers_the_warning_while_the_button_is_held() {
    let mut bench = on_block();
    let tip = |bench: &Bench| !bench.texts_with("Held for 1 s, arms the hand").is_empty();
    // Soon after a click there is no tooltip.
    bench.run(500);
    bench.point(bench.rect(Role::Button, GUARDED).center());
    bench.run(1500);
    assert!(tip(&bench), "{:?}", bench.texts());
    hold(&mut bench, 300);
    assert!(!tip(&bench), "{:?}", bench.texts());
}

#[test]
fn the_enter_key_held_on_the_button_does_the_same() {
    let mut bench = on_block();
    short(&mut bench);
    bench.focus_button(GUARDED);
    bench.key_down(Key::Enter);
    bench.run(500);
    bench.key_up(Key::Enter);
    bench.run(1000);
    check_nothing(&bench, "let go too early");
    bench.focus_button(GUARDED);
    bench.key_down(Key::Enter);
    // As keyboards do.
    let repeat = |bench: &mut Bench| {
        bench.run(90);
        bench.key_down(Key::Enter);
    };
    (0..8).for_each(|_| repeat(&mut bench));
    bench.until(800, runs);
    (0..5).for_each(|_| repeat(&mut bench));
    assert!(runs(&bench), "it is no new key");
}

#[test]
fn a_hold_that_is_let_go_left_or_stopped_does_nothing() {
    let early = "Let go too early: hold for 1 s. Nothing was started.";
    for why in ["let go", "left", "stopped", "clicked"] {
        let mut bench = on_block();
        let at = bench.rect(Role::Button, GUARDED).center();
        match why {
            "clicked" => bench.click_button(GUARDED),
            _ => hold(&mut bench, 800),
        }
        match why {
            "let go" => bench.release_at(at),
            "left" => bench.point(at - egui::vec2(0.0, 200.0)),
            "stopped" => bench.key(Key::Space),
            _ => {}
        }
        bench.run(60);
        assert_eq!(bench.shows(early), why != "stopped", "{why}");
        bench.point(at);
        bench.run(2000);
        check_nothing(&bench, why);
    }
}

#[test]
fn what_forbids_arming_or_the_series_forbids_the_hold() {
    let mut bench = on_block();
    bench.act(Action::Lock(Dof::Index, true));
    bench.run(60);
    assert!(bench.is_disabled(Role::Button, GUARDED));
    assert!(bench.shows("Index is locked and would have to move."));
    bench.act(Action::Lock(Dof::Index, false));
    bench.run(60);
    assert!(!bench.is_disabled(Role::Button, GUARDED));
    hold(&mut bench, 800);
    bench.unplug();
    bench.run(2000);
    assert!(bench.is_disabled(Role::Button, GUARDED), "feedback is old");
    check_nothing(&bench, "the cable was pulled in the hold");
}

#[test]
fn an_armed_hand_starts_by_a_click() {
    let mut bench = on_block();
    arm(&mut bench);
    assert!(!bench.is_disabled(Role::Button, "Start trials"));
    bench.click("Start trials");
    bench.run(60);
    assert!(runs(&bench));
}

#[test]
fn a_plan_says_what_it_will_do_and_how_hard_it_may_hit() {
    let mut bench = on_block();
    assert!(bench.shows("Trials: 1, at most about 36 s."));
    enter(&mut bench, "Speeds to try", "25, 250");
    enter(&mut bench, "Force thresholds to try", "250, 500");
    enter(&mut bench, "times each", "3");
    assert_eq!(plan(&bench).grid.settings().len(), 12);
    assert_eq!(bench.texts_with("Trials: 12, at most about").len(), 1);
    assert_eq!(
        bench
            .texts_with("637 g over the threshold (speed 250, threshold 500 g)")
            .len(),
        1
    );
    for (field, limit) in [
        ("Force limit, g", "2000"),
        ("Begin below, \u{b0}C", "50"),
        ("Stop at, \u{b0}C", "60"),
    ] {
        assert_eq!(bench.typed(field), limit);
    }
    bench.choose("Approach", "Fast to the measured contact");
    let probe = "The first, slow one measures the contact.";
    assert_eq!(bench.texts_with(probe).len(), 1);
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
        (
            "Speeds to try",
            "0",
            "Speeds to try: choose between 1 and 1000.",
            "25",
        ),
        (
            "Force limit, g",
            "100",
            "Force limit, g: choose between 500 and 4000.",
            "2000",
        ),
        (
            "Hold, s",
            "0.1",
            "Hold, s: choose between 0.3 and 600.",
            "1",
        ),
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
fn what_was_refused_keeps_a_series_from_starting_with_what_stood_there_before() {
    let mut bench = on_block();
    enter(&mut bench, "Force thresholds to try", "3000");
    assert_eq!(
        plan(&bench).grid.forces[0].get(),
        3000,
        "as far as a hand takes them"
    );
    enter(&mut bench, "Force thresholds to try", "500");
    for (field, bad) in [("Speeds to try", "25, fast"), ("Force limit, g", "99999")] {
        assert!(!bench.is_disabled(Role::Button, GUARDED));
        enter(&mut bench, field, bad);
        assert!(bench.shows("Correct the plan first."), "{field}");
        assert!(bench.is_disabled(Role::Button, GUARDED), "{field}");
        bench.click("Middle takes part");
        bench.run(60);
        assert_ne!(bench.typed(field), bad, "what is tried is shown again");
    }
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
    assert_eq!(bench.typed("Thumb rotate from"), open.to_string());
    bench.click("Thumb rotate: leave it alone");
    bench.run(60);
    assert_eq!(plan(&bench).start[Dof::ThumbRotate], None);
}

#[test]
fn what_is_wrong_in_a_plan_from_elsewhere_is_seen() {
    let mut bench = on_block();
    let mut wrong = plan(&bench).clone();
    wrong.limits.ceiling_g = 100;
    let plan = TrialAction::Plan(Box::new(wrong));
    bench.act(Action::Trial(plan));
    bench.run(400);
    assert!(bench.shows("Force limit, g: choose between 500 and 4000."));
    assert_eq!(bench.typed("Force limit, g"), "100");
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
    bench.show(View::Live);
    bench.run(60);
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
    grid(&mut bench);
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
    bench.click("Hide the plan");
    bench.run(60);
    assert_eq!(bench.view(), View::Compare);
    bench.click("Show the plan");
    bench.run(60);
    assert_eq!(bench.view(), View::Tune);
}

#[test]
fn what_was_measured_stands_below_the_series_that_runs() {
    let mut bench = on_block();
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "200, 250");
    arm(&mut bench);
    bench.click("Start trials");
    let rows = |bench: &Bench| bench.all(Role::Row).len();
    assert_eq!(rows(&bench), 0);
    bench.until(60_000, |bench| rows(bench) == 1);
    assert!(runs(&bench) && bench.shows("Force now, g"));
    finish(&mut bench, 60_000);
    assert_eq!(rows(&bench), 2);
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
    let mut bench = tried();
    bench.until(10_000, |bench| last(bench).origin.is_in_files());
    for view in [View::Tune, View::Compare] {
        bench.show(view);
        let said = bench.value(Role::Button, "Save session");
        let is_told = said.starts_with("Saved in ") && said.contains("documents/Handscope/");
        assert!(is_told, "{said:?}");
    }
}

#[test]
fn the_best_is_made_the_default_by_a_click_and_the_yes_of_its_card() {
    let mut bench = Bench::keeping(SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    });
    grid(&mut bench);
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "50, 250");
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    assert_eq!(bench.reading("Best"), "50 / 500 g");
    let stars = bench.all(Role::Label).into_iter();
    let stars = stars.filter(|(name, _)| name == "Best setting").count();
    assert_eq!(stars, 2, "beside the best, and in its row");
    let button = "Make it the default";
    bench.until(5000, |bench| !bench.is_disabled(Role::Button, button));
    let writes = bench.writes().len();
    bench.click(button);
    bench.run(100);
    assert!(bench.shows("Save these changes to flash?"));
    assert_eq!(bench.writes().len(), writes, "it was only asked");
    bench.click("Back");
    bench.run(100);
    let staged = bench.state().hand().params.all_staged();
    assert!(staged.is_empty(), "declined, nothing waits in Device");
    bench.click(button);
    bench.run(100);
    bench.click("Apply and save");
    bench.until(10_000, |bench| {
        let params = &bench.state().hand().params;
        !params.is_busy() && params.save.is_some()
    });
    bench.run(100);
    let live = |id| bench.state().hand().params.live(id).map(|(value, _)| value);
    let number = |number| Some(Value::Number(number));
    assert_eq!(live(ParamId::DefaultSpeed(Dof::Index)), number(50));
    assert_eq!(live(ParamId::DefaultForce(Dof::Index)), number(500));
    assert_eq!(bench.view(), View::Tune);
    assert!(bench.is_disabled(Role::Button, button), "it is already");
}

#[test]
fn nothing_is_made_the_default_of_an_armed_hand() {
    let mut bench = tried();
    let button = "Make it the default";
    bench.until(5000, |bench| !bench.is_disabled(Role::Button, button));
    arm(&mut bench);
    assert!(bench.is_disabled(Role::Button, button));
}

#[test]
fn any_key_stops_it_and_does_nothing_else() {
    for key in [Key::L, Key::F7, Key::Enter, Key::ArrowLeft] {
        let mut bench = running();
        bench.key(key);
        finish(&mut bench, 1000);
        assert_eq!(ended_by(&bench), Abort::Person, "{key:?}");
        assert!(!bench.state().hand().connection.is_armed());
        assert!(bench.shows("Last series: Ended by the user."), "{key:?}");
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
    let why = Some(Disarmed::Person);
    assert_eq!(ended_by(&bench), Abort::Disarmed { why });
    assert!(
        !bench
            .texts_with("No longer armed: it was disarmed")
            .is_empty()
    );
}

#[test]
fn a_fault_ends_it() {
    let mut bench = running();
    bench.hand(|hand, _| hand.inject_fault(Dof::Middle, Fault::OverCurrent));
    bench.wait(400);
    assert!(matches!(
        ended_by(&bench),
        Abort::Fault {
            joint: Some((Dof::Middle, _))
        }
    ));
    assert_eq!(bench.texts_with("Middle reports a fault:").len(), 1);
}

#[test]
fn a_lost_link_ends_it() {
    let mut bench = running();
    bench.unplug();
    // A stop stays pending for three seconds.
    bench.wait(5000);
    let why = ended_by(&bench);
    assert!(
        matches!(why, Abort::LinkLost | Abort::NotRead { .. }),
        "{why:?}"
    );
    assert!(bench.is_disabled(Role::Button, GUARDED));
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
    assert!(bench.state().hand().running.series().is_none());
    assert_eq!(bench.angle(Dof::Index), 1000);
}

#[test]
fn start_and_target_of_a_joint_have_room_in_the_smallest_window() {
    let mut bench = Bench::open(SimConfig::default(), egui::vec2(1024.0, 640.0));
    bench.wait(1000);
    grid(&mut bench);
    for field in ["Index from", "Index to"] {
        assert!(
            bench.rect(Role::TextInput, field).width() >= 48.0,
            "{field}"
        );
    }
    enter(&mut bench, "Index to", "300");
    assert_eq!(plan(&bench).close[Dof::Index].unwrap().get(), 300);
}
