//! Grips by size in the window: asked for on the drawn hand, sent while armed, and the size of what is held.

use crate::setup::window::{ANGLE_SET, Bench, LARGE};
use egui::{Key, Role};
use handscope::app::action::Action;
use handscope::app::hands::grip::is_open_for_pinch;
use handscope::hand::gap::Gap;
use handscope::hand::{Dof, PerDof};
use handscope::poses::Preset;
use handscope::sim::{Contact, Object, Scenario, SimConfig};

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
        matches!(dof, Dof::Index | Dof::ThumbBend).then(|| Contact {
            angle: f64::from(at[dof].get()),
            stiffness: 40.0,
            breaks_at_g: None,
        })
    });
    bench.act(Action::Pinch(Gap::MAX));
    bench.wait(6000);
    bench.hand(|hand, _| hand.set_object(&Object { contacts }));
    bench.act(Action::Pinch(Gap::nearest(mm - 15.0)));
    bench.until(20_000, |bench| bench.reading("Grip").contains("about"));
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

#[test]
fn the_size_of_what_is_held_is_told_and_two_blocks_make_it_true() {
    let mut bench = opened();
    assert!(bench.shows("Held: nothing between thumb and index"));
    hold(&mut bench, 40.0);
    let told = bench.reading("Grip");
    assert!(told.contains("by the model"), "{told}");
    for (gap, size) in [(40.0, "30"), (80.0, "70")] {
        hold(&mut bench, gap);
        bench.run(300);
        bench.type_into(BLOCK, size);
        bench.key(Key::Enter);
        bench.run(300);
    }
    let told = bench.reading("Grip");
    assert!(told.contains("about 70 mm, measured"), "{told}");
    assert!(bench.shows("Blocks measured: 30 mm, 70 mm"));
    bench.click_button("Forget");
    bench.run(300);
    let told = bench.reading("Grip");
    assert!(told.contains("by the model"), "{told}");
}
