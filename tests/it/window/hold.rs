//! A hold between two forces in the Live view: its forces, its start, what it says, and how it ends.

use crate::setup::grasp;
use crate::setup::window::{Bench, LARGE};
use egui::{Key, Role};
use handscope::app::action::Action;
use handscope::app::hand::hold::HoldAction;
use handscope::hand::hold_forces::HoldForces;
use handscope::hand::{Angle, Dof, Force, PerDof};
use handscope::history::MarkKind;
use handscope::motion::grasp::run::ConfirmStep;
use handscope::motion::hold::HoldPhase;
use handscope::poses::Preset;
use handscope::poses::edit::LibraryEdit;
use handscope::poses::library::{LibraryPose, StepGoal};
use handscope::poses::player::{PlayEnd, PlayPhase};
use handscope::sim::SimConfig;
use handscope::sim::object::{HandTurn, Loads, Object, Obstacle, PullLoad, listed};
use handscope::ui::View;

/// An object near all open fingers, lifted once it is held and pulled then.
fn pulled() -> Object {
    pulled_at(920.0)
}

/// The same, touched at this angle.
fn pulled_at(angle: f64) -> Object {
    let contacts = PerDof::from_fn(|dof| match dof {
        Dof::ThumbRotate => None,
        _ => Some(Obstacle::at(angle, 10.0)),
    });
    Object {
        mass_g: 200.0,
        loads: Loads {
            lift_after_s: Some(1.0),
            pulls: listed(&[PullLoad {
                at_s: 1.0,
                force_g: 400.0,
                direction_deg: 270.0,
                rise_ms: 300.0,
                lasts_ms: 1000.0,
            }]),
            ..Loads::NONE
        },
        ..Object::touched_at(contacts)
    }
}

/// Armed, with the popup of Hold open.
fn opened() -> Bench {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.wait(1000);
    bench.hand(|hand, _| hand.set_object(&pulled()));
    bench.click("Arm the hand");
    bench.run(300);
    bench.click("Hold");
    bench.run(100);
    bench
}

#[test]
fn unarmed_no_hold_can_be_started_and_its_forces_send_nothing() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.wait(1000);
    bench.click("Hold");
    bench.run(100);
    let writes = bench.writes().len();
    bench.click("Close all fingers");
    bench.run(300);
    assert!(bench.state().hand().running.hold().is_none());
    assert_eq!(bench.writes().len(), writes, "nothing is sent");
}

#[test]
fn a_pulled_object_is_held_tighter_and_each_time_is_a_mark() {
    let mut bench = opened();
    bench.click("Close all fingers");
    let phase = |bench: &Bench| {
        bench
            .state()
            .hand()
            .running
            .hold()
            .map(|run| run.view.phase)
    };
    bench.until(20_000, |bench| phase(bench) == Some(HoldPhase::Holding));
    bench.wait(4000);
    let view = bench.state().hand().running.hold().unwrap().view;
    assert!(view.tightened > 0, "{view:?}");
    let history = &bench.state().hand().measured.history;
    let is_tightened = |kind: &MarkKind| matches!(kind, MarkKind::Tightened(_));
    assert!(
        history
            .marks(0.0, f64::MAX)
            .any(|mark| is_tightened(&mark.kind))
    );
    assert!(bench.hand(|hand, _| hand.held().lost).is_none());
    bench.click("End the hold");
    bench.run(1000);
    assert!(!bench.state().hand().running.holds());
    assert!(bench.state().hand().connection.status.armed.is_none());
    let pressed = bench.hand(|hand, _| hand.true_loads());
    assert!(pressed.as_array().iter().all(|g| *g > 50.0), "{pressed:?}");
    assert!(bench.shows("Hold ended: the hand keeps its position"));
}

#[test]
fn moving_a_joint_takes_the_hand_over_from_a_hold() {
    let mut bench = opened();
    bench.click("Close all fingers");
    bench.run(2000);
    assert!(bench.state().hand().running.holds());
    bench.act(Action::Preset(Preset::Open));
    bench.run(300);
    assert!(!bench.state().hand().running.holds());
    assert!(
        bench.state().hand().connection.is_armed(),
        "the user moves it now"
    );
    bench.wait(3000);
    let angles = bench.hand(|hand, _| hand.true_angles());
    assert!(
        angles.as_array().iter().all(|angle| *angle > 950.0),
        "{angles:?}"
    );
}

#[test]
fn a_hold_that_worked_is_saved_and_held_with_again() {
    let mut bench = Bench::keeping(SimConfig::default());
    bench.wait(1000);
    bench.hand(|hand, _| hand.set_object(&pulled()));
    bench.click("Arm the hand");
    bench.run(300);
    bench.click("Hold");
    bench.run(100);
    assert!(!bench.shows("Save this grasp"));
    bench.click("Close all fingers");
    let phase = |bench: &Bench| {
        bench
            .state()
            .hand()
            .running
            .hold()
            .map(|run| run.view.phase)
    };
    bench.until(20_000, |bench| phase(bench) == Some(HoldPhase::Holding));
    bench.wait(6000);
    bench.click("End the hold");
    bench.run(1000);
    bench.click("Save this grasp");
    bench.until(5000, |bench| !bench.state().hand().grasps.all().is_empty());
    let grasp = bench.state().hand().grasps.all()[0].clone();
    assert_eq!(grasp.close.pose.as_deref(), Some("Power grasp"));
    assert!(grasp.result.tightened > 0, "{grasp:?}");
    assert!(bench.shows("Saved grasps"));

    bench.hand(|hand, _| hand.set_object(&Object::none()));
    bench.act(Action::Arm);
    bench.run(300);
    bench.act(Action::Preset(Preset::Open));
    bench.wait(4000);
    bench.hand(|hand, _| hand.set_object(&pulled()));
    bench.act(Action::Hold(HoldAction::Repeat(grasp.name)));
    bench.until(20_000, |bench| phase(bench) == Some(HoldPhase::Holding));
    let run = bench.state().hand().running.hold().unwrap();
    assert_eq!(run.confirming, None, "it is the same hand");
    assert_eq!(run.view.forces, grasp.forces);
}

#[test]
fn a_confirmation_opens_the_hand_only_on_put_down_and_only_while_the_load_is_gone() {
    let hand = "tcp:10.0.0.1";
    let mut bench = Bench::kept(SimConfig::default(), hand, LARGE);
    bench.wait(1000);
    grasp::store(&bench.folder().join("kept/settings.toml"), hand, "Ball");
    bench.act(Action::Disconnect);
    bench.wait(500);
    bench.act(Action::Connect(hand.parse().unwrap()));
    bench.wait(1500);
    let turn = |at_s, share| HandTurn {
        at_s,
        direction_deg: 270.0,
        share,
    };
    let mut object = pulled();
    object.mass_g = 60.0;
    object.loads.pulls = Default::default();
    object.loads.turns = listed(&[turn(3.0, 1.0), turn(4.0, 0.0)]);
    bench.hand(|hand, _| hand.set_object(&object));
    bench.click("Arm the hand");
    bench.run(300);
    bench.click("Hold");
    bench.run(100);
    bench.click("Ball");
    let step = |bench: &Bench| {
        let run = bench.state().hand().running.hold()?;
        run.confirming.map(|own| own.step)
    };
    bench.until(20_000, |bench| step(bench) == Some(ConfirmStep::Lift));
    // It loads the fingertips: the button does nothing.
    bench.click_button("Put down");
    bench.until(20_000, |bench| step(bench) == Some(ConfirmStep::Release));
    bench.wait(5000);
    assert_eq!(step(&bench), Some(ConfirmStep::Release));
    assert!(bench.hand(|hand, _| hand.held().held));
    bench.click_button("Put down");
    bench.until(2000, |bench| step(bench) == Some(ConfirmStep::Open));
    bench.until(20_000, |bench| step(bench) == Some(ConfirmStep::Close));
    let confirming = bench.state().hand().running.hold().unwrap().confirming;
    assert_eq!(confirming.unwrap().close, 2);
}

/// The view of poses with one pose that closes, which is open to be edited.
fn edited() -> Bench {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.wait(1000);
    bench.hand(|hand, _| hand.set_object(&pulled()));
    let pose = LibraryPose {
        name: "Grasp".into(),
        ..LibraryPose::at(PerDof::splat(Angle::nearest(300)))
    };
    bench.act(Action::Library(LibraryEdit::Add(vec![pose])));
    bench.show(View::Poses);
    bench.run(100);
    bench.click("Pose Grasp");
    bench.run(100);
    bench
}

fn enter(bench: &mut Bench, field: &str, text: &str) {
    bench.type_into(field, text);
    bench.key(Key::Enter);
    bench.run(100);
}

fn forces(least: i16, most: i16) -> HoldForces {
    HoldForces::new(Force::nearest(least), Force::nearest(most)).unwrap()
}

#[test]
fn a_pose_ends_in_a_hold_between_the_forces_that_are_typed() {
    let mut bench = edited();
    let hold = |bench: &Bench| bench.state().poses.library.poses[0].hold;
    assert_eq!(hold(&bench), None);
    bench.click_button("Ends in a hold");
    bench.run(100);
    assert_eq!(hold(&bench), Some(forces(150, 400)));
    enter(&mut bench, "Pose At most, g", "500");
    enter(&mut bench, "Pose At least, g", "200");
    assert_eq!(hold(&bench), Some(forces(200, 500)));
    bench.click("Arm the hand");
    bench.run(300);
    let id = bench.state().poses.library.poses[0].id;
    bench.act(Action::Recall(id));
    let phase = |bench: &Bench| {
        let run = bench.state().hand().running.sequence();
        run.and_then(|run| run.hold).map(|hold| hold.phase)
    };
    bench.until(20_000, |bench| phase(bench) == Some(HoldPhase::Holding));
    bench.wait(4000);
    assert_eq!(phase(&bench), Some(HoldPhase::Holding), "until it is ended");
    bench.click_button("Ends in a hold");
    bench.run(100);
    assert_eq!(hold(&bench), None);
}

#[test]
fn steps_that_hold_are_added_edited_and_played_and_each_tightening_is_a_mark() {
    let mut bench = edited();
    // Hardly bent fingers count as open, also with an object between them.
    bench.hand(|hand, _| hand.set_object(&pulled_at(700.0)));
    bench.click("Sequences");
    bench.run(60);
    bench.click("New sequence");
    bench.run(60);
    bench.click_button("Add");
    bench.click_button("Add hold");
    bench.run(60);
    bench.click("Step 1 Until holding");
    bench.run(60);
    bench.click("Step 1 Ends in a hold");
    bench.run(60);
    enter(&mut bench, "Step 1 At most, g", "450");
    enter(&mut bench, "Step 1 dwell, ms", "4000");
    enter(&mut bench, "Step 2 At least, g", "100");
    let steps = bench.state().poses.library.sequences[0].steps.clone();
    assert_eq!(
        (steps[0].hold, steps[0].until),
        (Some(forces(150, 450)), None)
    );
    assert_eq!(steps[1].goal, StepGoal::Hold(forces(100, 400)));
    assert!(bench.shows("Step 2: Hold what is held"));
    let last = bench.rect(Role::TextInput, "Step 1 At most, g");
    assert!(last.right() < LARGE.x, "{last}");
    bench.click("Arm the hand");
    bench.run(300);
    bench.click_button("Start");
    let run = |bench: &Bench| bench.state().hand().running.sequence().unwrap().view;
    let holds = |bench: &Bench| {
        let run = bench.state().hand().running.sequence().unwrap();
        run.hold
            .is_some_and(|hold| hold.phase == HoldPhase::Holding)
    };
    bench.until(20_000, holds);
    bench.until(20_000, |bench| run(bench).at == 1);
    bench.until(20_000, |bench| {
        run(bench).phase == PlayPhase::Ended(Ok(PlayEnd::Finished))
    });
    let history = &bench.state().hand().measured.history;
    let is_tightened = |kind: &MarkKind| matches!(kind, MarkKind::Tightened(_));
    assert!(
        history
            .marks(0.0, f64::MAX)
            .any(|mark| is_tightened(&mark.kind))
    );
    let pressed = bench.hand(|hand, _| hand.true_loads());
    assert!(pressed.as_array().iter().all(|g| *g > 50.0), "{pressed:?}");
}
