//! The pinch by size: on no part of its path, and on no way to it, do thumb and fingers meet; and what the window sends for it.

use crate::program::starter::{along, least_room, room};
use crate::program::{ANGLE_SET, Bench, shorts};
use handscope::app::action::Action;
use handscope::app::hand::grip::is_open_for_pinch;
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

/// The targets that were written last.
fn last_targets(bench: &Bench) -> Vec<i16> {
    let written = bench.written();
    let mut targets = written.iter().filter(|entry| entry.address == ANGLE_SET);
    shorts(targets.next_back().unwrap())
}

#[tokio::test(start_paused = true)]
async fn unarmed_a_gap_sends_nothing() {
    let mut bench = Bench::live().await;
    bench.forget();
    bench.act(Action::Pinch(Gap::nearest(30.0)));
    bench.run(500).await;
    assert!(bench.addresses().is_empty());
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_could_meet_itself_only_opens_and_goes_to_the_gap_when_asked_again() {
    let mut bench = Bench::armed().await;
    assert!(!is_open_for_pinch(bench.hand()), "the thumb is beside");
    bench.act(Action::Pinch(Gap::nearest(30.0)));
    bench.run(6000).await;
    let open = counts(Gap::MAX).as_array().to_vec();
    assert_eq!(last_targets(&bench), open, "and no further");
    assert!(is_open_for_pinch(bench.hand()));

    bench.forget();
    bench.act(Action::Pinch(Gap::nearest(30.0)));
    bench.run(200).await;
    let end = counts(Gap::nearest(30.0));
    assert_eq!(last_targets(&bench), end.as_array());
    // In the middle of the way both have gone the same part of it.
    bench.run(300).await;
    let part = |dof: Dof| {
        let [from, to] = [counts(Gap::MAX)[dof], end[dof]].map(f32::from);
        (f32::from(bench.angle(dof)) - from) / (to - from)
    };
    let (index, bend) = (part(Dof::Index), part(Dof::ThumbBend));
    assert!(index > 0.2 && index < 0.9, "{index}");
    assert!((index - bend).abs() < 0.1, "{index} and {bend}");
    bench.run(3000).await;
    let wish = bench.hand().controls.joints[Dof::Index].speed;
    assert_eq!(
        wish,
        Some(handscope::hand::Speed::GENTLE),
        "the user's stays"
    );
    bench.act(Action::Target(Dof::Index, Angle::MAX));
    bench.run(500).await;
    let held = bench.hand().held_otherwise(Dof::Index);
    assert_eq!(held.speed, None, "and is what the hand holds again");
}

#[tokio::test(start_paused = true)]
async fn with_a_locked_thumb_no_gap_is_sent() {
    let mut bench = Bench::armed().await;
    bench.act(Action::Lock(Dof::ThumbRotate, true));
    bench.run(100).await;
    bench.forget();
    bench.act(Action::Pinch(Gap::MAX));
    bench.run(500).await;
    assert!(bench.addresses().is_empty());
}

#[tokio::test(start_paused = true)]
async fn no_block_is_kept_while_nothing_is_held() {
    let mut bench = Bench::live().await;
    bench.act(Action::MeasureBlock(30.0));
    assert!(
        bench
            .state()
            .settings
            .hands
            .values()
            .all(|known| known.size_blocks.is_empty())
    );
}
