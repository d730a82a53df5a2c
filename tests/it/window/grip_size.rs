//! Grips by size in the window: asked for on the drawn hand, sent while armed, and the size of what is held.

use crate::setup::window::{ANGLE_SET, Bench, LARGE};
use egui::{Key, Role};
use handscope::app::action::Action;
use handscope::app::hand::grip::is_open_for_pinch;
use handscope::hand::gap::Gap;
use handscope::hand::grip::GripThresholds;
use handscope::hand::{Angle, Dof, Force, PerDof, Speed};
use handscope::poses::Preset;
use handscope::poses::edit::LibraryEdit;
use handscope::poses::library::{LibraryPose, StepGoal};
use handscope::poses::player::{PlayEnd, PlayPhase};
use handscope::sim::{Object, Obstacle, Scenario, SimConfig};
use handscope::ui::View;

const BLOCK: &str = "Size of a block that is held, mm";

fn free() -> Bench {
    let config = SimConfig {
        scenario: Scenario::Free,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(1000);
    bench
}

/// Armed, with thumb and index open for any gap.
fn opened() -> Bench {
    let mut bench = free();
    bench.gentle();
    bench.click("Arm the hand");
    bench.run(300);
    bench.click("Grip by size");
    bench.run(100);
    bench.click_button("Open for the grip");
    bench.until(10_000, |bench| is_open_for_pinch(bench.state().hand()));
    bench.run(3000);
    bench
}

/// A block between thumb and index that the model finds so wide.
fn hold(bench: &mut Bench, mm: f32) {
    let at = Gap::nearest(mm).angles();
    let contacts = PerDof::from_fn(|dof| {
        matches!(dof, Dof::Index | Dof::ThumbBend)
            .then(|| Obstacle::at(f64::from(at[dof].get()), 40.0))
    });
    bench.act(Action::Pinch(Gap::MAX));
    bench.wait(6000);
    bench.hand(|hand, _| hand.set_object(&Object::touched_at(contacts)));
    bench.act(Action::Pinch(Gap::nearest(mm - 15.0)));
    bench.until(20_000, |bench| {
        let word = bench.reading("Grip");
        word.starts_with("Holding, ") && word.ends_with(" mm")
    });
}

#[test]
fn unarmed_the_gap_is_only_a_wish_on_the_drawn_hand() {
    let mut bench = free();
    bench.click("Grip by size");
    bench.run(100);
    let writes = bench.writes().len();
    bench.drag("Gap, mm", 0.9, 0.3);
    bench.run(300);
    assert!(bench.shows("Not armed: the drawn hand shows where it would go."));
    bench.click("Keep as pose");
    bench.run(100);
    let pose = &bench.state().poses.library.poses[0];
    let mm = pose.gap.unwrap().mm();
    assert!((20.0..80.0).contains(&mm), "{mm}");
    assert_eq!(pose.name, format!("Pinch {mm} mm"));
    assert_eq!(bench.writes().len(), writes, "nothing is sent");
}

#[test]
fn the_slider_stays_where_it_is_when_the_hand_is_armed_and_when_it_is_open() {
    let mut bench = free();
    bench.click("Grip by size");
    bench.run(100);
    let unarmed = bench.rect(Role::Slider, "Gap, mm");
    let mut bench = opened();
    assert_eq!(bench.rect(Role::Slider, "Gap, mm"), unarmed);
    bench.act(Action::Preset(Preset::Open));
    bench.until(10_000, |bench| bench.shows("Open for the grip"));
    assert_eq!(bench.rect(Role::Slider, "Gap, mm"), unarmed);
}

#[test]
fn while_armed_the_slider_sends_thumb_and_index_along_their_path() {
    let mut bench = opened();
    let before = bench.writes().len();
    bench.drag("Gap, mm", 0.9, 0.3);
    bench.run(300);
    let writes = bench.writes().split_off(before);
    let mut angles = writes
        .iter()
        .filter(|write| (ANGLE_SET..ANGLE_SET + 12).contains(&write.address));
    assert!(angles.next().is_some());
    let joints = bench.state().hand().controls.joints;
    let target = |dof: Dof| joints[dof].target.unwrap().get();
    assert!(target(Dof::Index) < 660 && target(Dof::ThumbBend) < 1000);
    assert!(target(Dof::ThumbRotate) == 0 && target(Dof::Ring) == 1000);
}

/// The view of poses with one pose, which is open to be edited.
fn edited() -> Bench {
    let mut bench = free();
    let pose = LibraryPose {
        name: "Block".into(),
        ..LibraryPose::at(PerDof::splat(Angle::MAX))
    };
    bench.act(Action::Library(LibraryEdit::Add(vec![pose])));
    bench.show(View::Poses);
    bench.run(100);
    bench.click("Pose Block");
    bench.run(100);
    bench
}

fn enter(bench: &mut Bench, field: &str, text: &str) {
    bench.type_into(field, text);
    bench.key(Key::Enter);
    bench.run(100);
}

#[test]
fn a_pose_is_made_one_by_size_and_closes_along_the_path() {
    let mut bench = edited();
    bench.click_button("By size");
    bench.run(100);
    let pose = |bench: &Bench| bench.state().poses.library.poses[0].clone();
    let known = pose(&bench).gap.unwrap();
    enter(&mut bench, "Pose Gap, mm", "130");
    assert_eq!(pose(&bench).gap, Some(known), "no such gap");
    enter(&mut bench, "Pose Gap, mm", "25.5");
    assert_eq!(pose(&bench).gap.map(Gap::mm), Some(25.5));
    assert_eq!(pose(&bench).angles, Gap::nearest(25.5).angles());
    bench.click("Arm the hand");
    bench.run(300);
    let recall = Action::Recall(pose(&bench).id);
    bench.act(recall.clone());
    let end = f64::from(Gap::nearest(25.5).angles()[Dof::ThumbBend].get());
    let arrived = |bench: &Bench| (f64::from(bench.angle(Dof::ThumbBend)) - end).abs() <= 20.0;
    let before = bench.writes().len();
    bench.until(30_000, arrived);
    let writes = bench.writes().split_off(before);
    let moves = writes.iter().filter(|write| write.address == ANGLE_SET);
    assert!(moves.count() >= 2, "opens, then closes");
    bench.act(Action::Lock(Dof::Index, true));
    bench.run(100);
    bench.act(recall);
    bench.run(1000);
    let run = bench.state().hand().running.sequence().unwrap();
    let ended = PlayPhase::Ended(Ok(PlayEnd::Locked));
    assert_eq!(run.view.phase, ended, "not without the index");
    bench.act(Action::Lock(Dof::Index, false));
    bench.click_button("By size");
    bench.run(100);
    assert_eq!(pose(&bench).gap, None, "and a pose of its angles again");
}

#[test]
fn a_step_by_size_is_added_and_changed_and_has_room() {
    let mut bench = edited();
    bench.click("Sequences");
    bench.run(60);
    bench.click("New sequence");
    bench.run(60);
    bench.click_button("Add grip by size");
    bench.run(60);
    bench.click("Step 1 Until holding");
    bench.run(60);
    enter(&mut bench, "Step 1 Gap, mm", "12.5");
    enter(&mut bench, "Step 1 Force, g", "300");
    enter(&mut bench, "Step 1 speed", "150");
    let step = bench.state().poses.library.sequences[0].steps[0];
    let force = Force::nearest(300);
    let gap = Gap::nearest(12.5);
    assert_eq!(step.goal, StepGoal::Gap { gap, force });
    assert_eq!(step.speed.get(), 150);
    assert!(bench.shows("Step 1: Pinch 12.5 mm"));
    let last = bench.rect(Role::TextInput, "Step 1 retries");
    assert!(last.right() < LARGE.x, "{last}");
}

#[test]
fn the_thresholds_of_a_pose_are_shown_and_count_while_it_is_what_was_asked_for() {
    let mut bench = free();
    let thresholds = GripThresholds {
        contact_g: 30,
        least_fingers: 2,
        ..GripThresholds::default()
    };
    let pose = LibraryPose {
        name: "Soft".into(),
        thresholds: Some(thresholds),
        speed: Speed::MAX,
        ..LibraryPose::at(PerDof::splat(Angle::nearest(800)))
    };
    bench.act(Action::Library(LibraryEdit::Add(vec![pose])));
    bench.show(View::Poses);
    bench.run(100);
    bench.click("Pose Soft");
    bench.run(100);
    assert!(bench.shows("Grip told by: contact_g 30, least_fingers 2"));
    bench.gentle();
    bench.click("Arm the hand");
    bench.run(300);
    let now = |bench: &Bench| bench.state().hand().readings.grip.thresholds();
    assert_eq!(now(&bench), GripThresholds::default());
    let id = bench.state().poses.library.poses[0].id;
    bench.act(Action::Recall(id));
    bench.run(500);
    assert_eq!(now(&bench), thresholds);
    bench.wait(3000);
    assert_eq!(now(&bench), thresholds, "it is what was asked for still");
    bench.act(Action::Target(Dof::Ring, Angle::MAX));
    bench.run(200);
    assert_eq!(now(&bench), GripThresholds::default());
}

#[test]
fn the_size_of_what_is_held_is_told_and_two_blocks_make_it_true() {
    let mut bench = opened();
    assert!(bench.shows("Held: nothing between thumb and index"));
    hold(&mut bench, 40.0);
    let told = bench.reading("Grip details");
    assert!(told.contains("by the model"), "{told}");
    for (gap, size) in [(40.0, "30"), (80.0, "70")] {
        hold(&mut bench, gap);
        bench.run(300);
        bench.type_into(BLOCK, size);
        bench.key(Key::Enter);
        bench.run(300);
    }
    let told = bench.reading("Grip details");
    assert!(told.contains("about 70 mm, measured"), "{told}");
    assert_eq!(bench.reading("Grip"), "Holding, 70 mm");
    assert!(bench.shows("Blocks measured: 30 mm, 70 mm"));
    bench.click_button("Forget");
    bench.run(300);
    let told = bench.reading("Grip details");
    assert!(told.contains("by the model"), "{told}");
}
