//! The pinch by size: on no part of its path, and on no way to it, do thumb and fingers meet; and no joint leaves its range.

use crate::program::starter::{along, least_room, room};
use handscope::hand::gap::Gap;
use handscope::hand::{Angle, Dof, PerDof};
use handscope::poses::starter::starter;
use handscope::poses::way::way;

/// Gaps from the narrowest to the widest, mm.
fn gaps() -> impl Iterator<Item = Gap> {
    (30..=1200)
        .step_by(5)
        .map(|tenths: u16| Gap::new(f32::from(tenths) / 10.0).unwrap())
}

fn counts(gap: Gap) -> PerDof<i16> {
    gap.angles().map(Angle::get)
}

#[test]
fn thumb_and_index_never_cross_on_the_path_and_are_as_far_apart_as_is_said() {
    for gap in gaps() {
        let angles = counts(gap).map(f32::from);
        let free = room(Dof::Index, &angles);
        assert!(free > 0.0, "{gap:?}: {free:.1} mm");
        if gap.mm() < 60.0 {
            let off = free - gap.mm();
            assert!((-2.0..3.0).contains(&off), "{gap:?}: {free:.1} mm of room");
        }
        for others in [Dof::Middle, Dof::Ring, Dof::Little] {
            assert!(room(others, &angles) > 20.0, "{gap:?} {others:?}");
        }
    }
}

#[test]
fn whichever_joint_is_faster_nothing_meets_between_any_two_gaps() {
    for from in gaps().step_by(6) {
        for to in gaps().step_by(6) {
            let least = least_room(&counts(from), &counts(to));
            assert!(least > 0.0, "{from:?} to {to:?}: {least:.1} mm");
            let legs = from.legs_to(to);
            assert_eq!(legs.last().map(|leg| leg.to), Some(to.angles()));
        }
    }
}

#[test]
fn from_any_shipped_pose_the_hand_opens_for_the_path_without_a_meeting() {
    let open = Gap::MAX.angles().map(Some);
    for pose in &starter().poses {
        let from = pose.angles.map(Angle::get);
        let least = along(&from, &way(&from.map(Some), &open));
        assert!(least >= 0.0, "{}: {least:.1} mm", pose.name);
    }
}
