//! Claims about moving: arming, dragging, typing, locks, gestures, and every way to stop.

use crate::setup::window::{ANGLE_SET, Bench, FORCE_SET, GESTURE, Role, SPEED_SET, Write};
use egui::Key;
use handscope::hand::Dof;
use handscope::record::LinkState;
use handscope::ui::View;

/// ANGLE_SET of the index finger.
const INDEX: u16 = ANGLE_SET + 2 * Dof::Index as u16;

/// What is told to the index finger, alone or with all.
fn index_of(write: &Write) -> i16 {
    write.shorts()[usize::from((INDEX - write.address) / 2)]
}

/// Puts the joints somewhere, as another controller would.
fn pose(bench: &mut Bench, angle: i16) {
    let bytes: Vec<u8> = [angle; 6].into_iter().flat_map(i16::to_le_bytes).collect();
    bench.hand(|hand, now| hand.write(ANGLE_SET, &bytes, now).unwrap());
    bench.wait(2500);
    for dof in Dof::ALL {
        assert!((bench.angle(dof) - angle).abs() <= 3, "{dof:?}");
    }
}

#[test]
fn arming_writes_speeds_and_forces_and_no_angle() {
    let mut bench = Bench::live();
    bench.gentle();
    bench.click("Arm the hand");
    bench.wait(500);
    assert!(bench.shows("Disarm the hand") && bench.shows("Link state: Armed"));
    let writes = bench.writes();
    let sent: Vec<_> = writes
        .iter()
        .map(|write| (write.address, write.shorts()))
        .collect();
    assert_eq!(sent, [(SPEED_SET, vec![200; 6]), (FORCE_SET, vec![500; 6])]);
    assert_eq!(bench.angle(Dof::Index), 1000);
    bench.click("Disarm the hand");
    bench.wait(200);
    assert!(bench.shows("Link state: Monitoring"));
    assert_eq!(bench.writes().len(), 2, "disarming writes nothing");
}

#[test]
fn a_drag_starts_from_the_actual_angle_and_the_actual_follows() {
    let mut bench = Bench::armed();
    let armed = bench.writes().len();
    bench.drag("Index angle target", 1.0, 0.5);
    let writes = bench.writes().split_off(armed);
    assert!(writes.len() > 3, "{writes:?}");
    assert!(index_of(&writes[0]) >= 940, "no jump: {:?}", writes[0]);
    for write in &writes {
        let is_alone = (write.address, write.shorts().len()) == (INDEX, 1);
        assert!(is_alone, "{write:?}");
    }
    let target = bench.handle("Index angle target").unwrap();
    assert!((target - 500.0).abs() < 20.0, "{target}");
    let last = writes.last().map(index_of).unwrap();
    assert!((f64::from(last) - target).abs() < 0.5, "{last} {target}");
    bench.wait(400);
    let under_way: i16 = bench.reading("Index actual angle").parse().unwrap();
    assert!(under_way > 600 && under_way < 990, "{under_way}");
    assert_eq!(bench.reading("Index status"), "Closing");
    bench.wait(2500);
    let there: i16 = bench.reading("Index actual angle").parse().unwrap();
    assert!((f64::from(there) - target).abs() <= 5.0, "{there} {target}");
    assert_eq!(bench.reading("Index status"), "In position");
}

fn stops(stop: impl FnOnce(&mut Bench)) {
    stops_after(|_| {}, stop);
}

fn stops_after(prepare: impl FnOnce(&mut Bench), stop: impl FnOnce(&mut Bench)) {
    let mut bench = Bench::armed();
    bench.drag("Index angle target", 1.0, 0.0);
    bench.wait(600);
    prepare(&mut bench);
    let moving = bench.angle(Dof::Index);
    assert!((200..950).contains(&moving), "{moving}");
    let before = bench.writes().len();
    let pressed = bench.now();
    stop(&mut bench);
    bench.wait(1000);
    let held = bench.writes().split_off(before);
    assert!(!held.is_empty());
    assert!(
        held[0].at.since(pressed).as_millis() <= 100,
        "at once: {:?} after {pressed:?}",
        held[0].at
    );
    for write in &held {
        assert_eq!(write.address, ANGLE_SET, "nothing but hold: {write:?}");
        let shorts = write.shorts();
        assert!((index_of(write) - moving).abs() < 120, "{shorts:?}");
        assert_eq!(shorts[Dof::Ring.index()], 1000, "{shorts:?}");
    }
    let tail = &bench.seen()[bench.seen().len() - 3..];
    let want = [LinkState::Armed, LinkState::Holding, LinkState::Monitoring];
    assert_eq!(tail, want, "{:?}", bench.seen());
    assert!(bench.shows("Arm the hand") && !bench.shows("Disarm the hand"));
    let rest = bench.angle(Dof::Index);
    bench.wait(1000);
    assert!((bench.angle(Dof::Index) - rest).abs() <= 3, "it stays");
    let shown: f64 = bench.reading("Index actual angle").parse().unwrap();
    let handle = bench.handle("Index angle target").unwrap();
    assert!((handle - shown).abs() <= 1.0, "{handle} {shown}");
    assert_eq!(bench.writes().len(), before + held.len(), "and is left");
}

#[test]
fn the_stop_button_holds_a_moving_joint() {
    stops(|bench| bench.click_button("STOP"));
}

#[test]
fn a_stop_is_not_lost_in_a_slow_frame_that_sees_the_pointer_gone_already() {
    stops(|bench| bench.click_within_one_frame("STOP"));
}

#[test]
fn a_stop_does_not_wait_for_the_release() {
    stops(|bench| bench.press("STOP"));
}

#[test]
fn space_does_the_same() {
    stops(|bench| bench.key(Key::Space));
}

#[test]
fn escape_does_the_same() {
    stops(|bench| bench.key(Key::Escape));
}

#[test]
fn escape_stops_with_a_number_field_focused() {
    stops_after(
        |bench| bench.focus("Ring angle number"),
        |bench| bench.key(Key::Escape),
    );
}

#[test]
fn escape_stops_while_a_half_typed_number_stands_and_drops_it() {
    stops_after(
        |bench| bench.type_into("Index angle number", "0"),
        |bench| {
            bench.key(Key::Escape);
            bench.key(Key::Enter);
        },
    );
}

#[test]
fn a_typed_number_acts_only_on_enter() {
    let mut bench = Bench::armed();
    let armed = bench.writes().len();
    bench.type_into("Index angle number", "400");
    bench.wait(300);
    assert_eq!(bench.writes().len(), armed);
    bench.key(Key::Enter);
    bench.run(100);
    let writes = bench.writes().split_off(armed);
    assert_eq!(writes.len(), 1, "{writes:?}");
    assert_eq!((writes[0].address, writes[0].shorts()), (INDEX, vec![400]));
    assert_eq!(bench.typed("Index angle number"), "400");
    assert_eq!(bench.handle("Index angle target"), Some(400.0));
}

#[test]
fn a_number_out_of_range_is_visibly_refused_and_never_sent() {
    for (field, wrong) in [
        ("Index angle number", "1001"),
        ("Index angle number", "-1"),
        ("Index angle number", "99999999"),
        ("Index force number", "3001"),
        ("Index speed number", "1001"),
    ] {
        let mut bench = Bench::armed();
        let armed = bench.writes().len();
        bench.type_into(field, wrong);
        let place = bench.rect(Role::TextInput, field);
        let before = bench.edges(place);
        bench.key(Key::Enter);
        bench.wait(300);
        assert_eq!(bench.writes().len(), armed, "{field} {wrong}");
        assert_eq!(bench.typed(field), wrong, "what was typed still stands");
        let after = bench.edges(place);
        assert!(!after.is_empty());
        assert_ne!(before, after, "{field} {wrong}: its frame says so");
    }
}

#[test]
fn a_locked_joint_is_left_alone_by_drags_and_by_open_all() {
    let mut bench = Bench::live();
    pose(&mut bench, 500);
    bench.click("Ring lock");
    bench.click("Arm the hand");
    bench.wait(300);
    let armed = bench.writes().len();
    bench.drag("Ring angle target", 0.5, 0.9);
    bench.wait(300);
    assert_eq!(bench.writes().len(), armed);
    bench.click("Open all");
    bench.wait(5000);
    let opened = bench.writes().split_off(armed);
    let opened: Vec<_> = opened
        .iter()
        .map(|write| (write.address, write.shorts()))
        .collect();
    let (little, others) = (vec![1000], vec![1000; 4]);
    assert_eq!(opened, [(ANGLE_SET, little), (ANGLE_SET + 4, others)]);
    for dof in Dof::ALL {
        let want = if dof == Dof::Ring { 500 } else { 1000 };
        assert!((bench.angle(dof) - want).abs() <= 5, "{dof:?}");
    }
}

#[test]
fn a_gesture_needs_arming_and_then_writes_its_number() {
    let mut bench = Bench::live();
    bench.show(View::Poses);
    bench.click("In the hand");
    bench.run(60);
    assert!(bench.is_disabled(Role::Button, "Gesture 12"));
    bench.click("Gesture 12");
    bench.wait(200);
    assert_eq!(bench.writes(), []);
    bench.click("Arm the hand");
    bench.wait(200);
    let armed = bench.writes().len();
    bench.click("Gesture 12");
    bench.wait(3500);
    let writes = bench.writes().split_off(armed);
    assert_eq!(writes.len(), 1, "{writes:?}");
    assert_eq!(
        (writes[0].address, &writes[0].bytes),
        (GESTURE, &vec![12_u8])
    );
    for dof in Dof::ALL {
        assert!((bench.angle(dof) - 500).abs() <= 5, "{dof:?}");
    }
    let handle = bench.handle("Index angle target").unwrap();
    assert!((handle - 500.0).abs() <= 5.0, "the slider went along");
}
