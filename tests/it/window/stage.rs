//! The drawn hand as the stage of the live view: fingers are dragged on it, and their figures stand beside it.

use crate::setup::window::{ANGLE_SET, Bench, LARGE, Role};
use egui::{CursorIcon, Pos2, Rect, pos2, vec2};
use handscope::hand::Dof;
use handscope::sim::{Scenario, SimConfig};

const FINGERS: [&str; 5] = ["Little", "Ring", "Middle", "Index", "Thumb"];

fn stage(bench: &Bench) -> Rect {
    bench.rect(Role::Image, "Picture of the hand")
}

/// A place on the first finger that can be dragged, from the right, near the top of an open hand: the index.
fn index(bench: &mut Bench) -> Pos2 {
    let place = stage(bench);
    let y = place.top() + place.height() * 0.16;
    let mut x = place.right() - 4.0;
    while x > place.left() {
        bench.point(pos2(x, y));
        if bench.cursor() == CursorIcon::Grab {
            return pos2(x - 4.0, y);
        }
        x -= 4.0;
    }
    panic!("no finger can be dragged at {y} of {place}");
}

fn targets(bench: &Bench) -> Vec<i16> {
    let joints = bench.state().hand().controls.joints;
    let target = |dof: Dof| joints[dof].target.map_or(-1, |target| target.get());
    Dof::ALL.into_iter().map(target).collect()
}

/// What was written to angles from this write on.
fn angles(bench: &Bench, from: usize) -> Vec<(u16, Vec<i16>)> {
    let writes = bench.writes().split_off(from);
    let is_angle = |address: u16| (ANGLE_SET..ANGLE_SET + 12).contains(&address);
    let written = writes.iter().filter(|write| is_angle(write.address));
    written
        .map(|write| (write.address, write.shorts()))
        .collect()
}

#[test]
fn a_finger_that_is_dragged_is_sent_where_the_pointer_is_and_no_other() {
    let config = SimConfig {
        scenario: Scenario::Free,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(1000);
    bench.gentle();
    bench.click("Arm the hand");
    bench.run(200);
    let from = index(&mut bench);
    let (before, writes) = (targets(&bench), bench.writes().len());
    bench.press_at(from);
    let mut last = before[Dof::Index as usize];
    for step in 1..=10_u8 {
        let down = stage(&bench).height() * 0.03 * f32::from(step);
        bench.point(from + vec2(0.0, down));
        let now = targets(&bench);
        let index = now[Dof::Index as usize];
        assert!((0..=last).contains(&index), "{step}: {index} after {last}");
        last = index;
        for dof in Dof::ALL.into_iter().filter(|dof| *dof != Dof::Index) {
            assert_eq!(now[dof as usize], before[dof as usize], "{step} {dof:?}");
        }
    }
    assert_eq!(bench.cursor(), CursorIcon::Grabbing);
    assert!(last < 600, "{last}");
    bench.release_at(from);
    bench.wait(4000);
    assert!((bench.angle(Dof::Index) - last).abs() < 40);
    let sent = angles(&bench, writes);
    assert!(!sent.is_empty());
    let at = ANGLE_SET + 2 * Dof::Index as u16;
    let only_index = |(address, values): &(u16, Vec<i16>)| {
        let first = usize::from((at - address) / 2);
        let mut others = values.iter().enumerate().filter(|(at, _)| *at != first);
        others.all(|(_, value)| *value == -1)
    };
    assert!(sent.iter().all(only_index), "{sent:?}");
}

#[test]
fn without_arming_and_while_locked_a_drag_on_a_finger_sends_nothing_and_says_why() {
    let mut bench = Bench::armed();
    let from = index(&mut bench);
    let to = from + vec2(0.0, stage(&bench).height() * 0.3);
    bench.click("Index lock");
    // Right after a click no tooltip comes.
    bench.run(300);
    let (before, writes) = (targets(&bench), bench.writes().len());
    bench.point(from);
    bench.run(1500);
    let told = bench.texts_with("Index: This joint is locked");
    assert!(!told.is_empty(), "{:?}", bench.texts());
    bench.drag_from_to(from, to);
    bench.wait(500);
    assert_eq!(targets(&bench), before);
    assert_eq!(angles(&bench, writes), []);
    assert_eq!(labels(&bench, "Index: This joint is locked.").len(), 1);
    let mut bench = Bench::live();
    bench.point(from);
    bench.run(1500);
    assert_ne!(bench.cursor(), CursorIcon::Grab);
    let told = bench.texts_with("Index: Press Arm to move");
    assert!(!told.is_empty(), "{:?}", bench.texts());
    bench.drag_from_to(from, to);
    bench.wait(500);
    assert_eq!(bench.writes(), []);
}

#[test]
fn a_drag_beside_the_fingers_turns_the_picture_and_a_turned_finger_is_dragged_as_well() {
    let mut bench = Bench::armed();
    let place = stage(&bench);
    let (before, writes) = (targets(&bench), bench.writes().len());
    for from in [vec2(0.48, 0.6), vec2(0.1, 0.9)] {
        let from = place.lerp_inside(from);
        bench.drag_from_to(from, from - vec2(40.0, 10.0));
    }
    bench.wait(300);
    assert_eq!(targets(&bench), before);
    assert_eq!(angles(&bench, writes), []);
    let from = index(&mut bench);
    bench.drag_from_to(from, from + vec2(0.0, place.height() * 0.3));
    let now = targets(&bench);
    assert!(now[Dof::Index as usize] < 700, "{now:?}");
    assert_eq!(now[..3], before[..3]);
}

#[test]
fn fingers_that_are_seen_to_be_linked_are_dragged_together() {
    let mut bench = Bench::armed();
    bench.click("Link");
    bench.run(60);
    let from = index(&mut bench);
    bench.drag_from_to(from, from + vec2(0.0, stage(&bench).height() * 0.25));
    let now = targets(&bench);
    for dof in [Dof::Little, Dof::Ring, Dof::Middle] {
        let apart = now[dof as usize] - now[Dof::Index as usize];
        assert!(apart.abs() <= 12, "{dof:?} {now:?}");
    }
    assert!(now[Dof::Index as usize] < 750 && now[Dof::ThumbBend as usize] > 950);
}

fn figure(finger: &str) -> String {
    format!("{finger} force at the drawn finger")
}

/// Where each label of this name is.
fn labels(bench: &Bench, name: &str) -> Vec<Rect> {
    let all = bench.all(Role::Label).into_iter();
    let named = all.filter(|(own, _)| own == name);
    named.map(|(_, place)| place).collect()
}

#[test]
fn every_finger_has_its_force_in_a_place_that_stays_while_the_hand_moves() {
    let mut bench = Bench::armed();
    let places = |bench: &Bench| FINGERS.map(|finger| labels(bench, &figure(finger))[0]);
    let before = places(&bench);
    for (at, one) in before.iter().enumerate() {
        assert!(stage(&bench).contains_rect(*one), "{one}");
        let mut others = before.iter().skip(at + 1);
        assert!(others.all(|other| !other.intersects(*one)), "{before:?}");
    }
    for finger in FINGERS {
        assert!(bench.reading(&figure(finger)).ends_with(" g"));
    }
    bench.click("Close");
    bench.wait(3000);
    assert_eq!(places(&bench), before);
}

#[test]
fn a_fault_stands_at_its_finger_until_it_is_old() {
    let config = SimConfig {
        scenario: Scenario::Faults,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    let troubles = |bench: &Bench| {
        let name = |finger: &str| format!("{finger} trouble at the drawn finger");
        let has = |finger: &&str| !labels(bench, &name(finger)).is_empty();
        FINGERS.into_iter().filter(has).count()
    };
    bench.until(20_000, |bench| troubles(bench) > 0);
    bench.unplug();
    bench.wait(3000);
    assert_eq!(troubles(&bench), 0);
    assert_eq!(labels(&bench, &figure("Index")).len(), 1);
}

#[test]
fn the_shelf_has_no_parts_of_demos_and_no_numbers_and_goes_with_the_wheel() {
    let mut bench = Bench::live();
    for part in [
        "Go to Wave 1",
        "Go to Relaxed",
        "Go to Curled",
        "Go to Loosened",
        "Gesture 1",
    ] {
        assert!(bench.buttons_with(part).is_empty(), "{part}");
    }
    let open = |bench: &Bench| bench.rect(Role::Button, "Go to Open");
    let before = open(&bench);
    bench.wheel_at(before.center(), -3.0);
    bench.run(300);
    assert!(open(&bench).left() < before.left() - 40.0);
}

#[test]
fn a_demo_that_runs_has_a_ring() {
    let mut bench = Bench::armed();
    let ring = |bench: &Bench, name: &str| {
        let edges = bench.edges(bench.rect(Role::Button, name));
        edges.len()
    };
    bench.scroll_shelf();
    let before = ring(&bench, "Start Wave");
    bench.click("Start Wave");
    bench.run(300);
    assert!(ring(&bench, "End Wave") > before);
}

#[test]
fn what_is_gripped_is_told_at_the_fingers_and_in_one_line() {
    let config = SimConfig {
        scenario: Scenario::Grasp,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.until(8000, |bench| bench.reading("Grip") == "Holding");
    let index = "Index grip at the drawn finger";
    bench.until(4000, |bench| bench.reading(index) == "Holding");
    bench.unplug();
    bench.until(3000, |bench| bench.reading("Grip") == "Grip: Unknown");
    assert!(!bench.shows(index), "nothing is told of old readings");
}

#[test]
fn no_grip_is_told_of_feedback_that_does_not_follow() {
    let config = SimConfig {
        scenario: Scenario::Frozen,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(1000);
    assert_eq!(bench.reading("Grip"), "Open");
    bench.click("Arm the hand");
    bench.run(300);
    bench.click_button("Close");
    bench.until(20_000, |bench| {
        bench.state().hand().connection.status.feedback_in_doubt
    });
    bench.run(100);
    assert_eq!(bench.reading("Grip"), "Grip: Unknown");
}
