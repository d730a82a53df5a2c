//! The grip of a hand as far as feedback is trusted, and motions of thumb and index to a gap.

use crate::app::hand::Hand;
use crate::hand::gap::{self, Gap, PinchGap};
use crate::hand::grip::Grip;
use crate::hand::{AngleReading, Dof, Moment, PerDof, Target};

/// Current grip; unknown while feedback does not follow the commands.
pub fn grip_now(hand: &Hand, now: Moment) -> Grip {
    let is_believed = hand.connection.status.is_believed();
    hand.readings.grip.known(is_believed, now)
}

/// Gap between the pads of thumb and index, by the model, while only these two hold an object.
pub fn held_gap(hand: &Hand, now: Moment) -> Option<PinchGap> {
    let angle = hand.readings.sample.angle?;
    gap::held_gap(&grip_now(hand, now), &angle.value)
}

/// True if a joint of the pinch is locked.
pub fn locks_pinch(hand: &Hand) -> bool {
    let mut pinching = Gap::JOINTS.into_iter();
    pinching.any(|dof| hand.controls.joints[dof].locked)
}

/// True if thumb and index can move to any gap from their current position.
pub fn is_open_for_pinch(hand: &Hand) -> bool {
    counts(hand).is_some_and(|counts| gap::is_open_for_pinch(&counts))
}

/// Measured angles; `None` unless all are known.
pub fn counts(hand: &Hand) -> Option<PerDof<f32>> {
    let angle = hand.readings.sample.angle?;
    let counts = angle.value.map(AngleReading::documented).all()?;
    Some(counts.map(f32::from))
}

/// Moves thumb and index straight to a gap, at speeds with which they arrive together.
pub(crate) fn pinch_to(hand: &mut Hand, to: Gap) {
    let Some(counts) = counts(hand) else {
        return;
    };
    let leg = Gap::nearest(gap::pad_distance(&counts)).straight_to(to);
    let own = hand.controls.limits();
    let together = [Dof::Index, Dof::ThumbBend];
    let speeds = leg.speeds(own.speed[Dof::Index].min(own.speed[Dof::ThumbBend]));
    let went = hand.go_to(|setpoints| {
        setpoints.angle = leg.to.map(|angle| Some(Target::Go(angle)));
        for dof in together {
            setpoints.speed[dof] = Some(speeds[dof]);
            setpoints.force[dof] = Some(own.force[dof]);
        }
    });
    if went {
        let targets = PerDof::from_fn(|dof| together.contains(&dof).then_some(leg.to[dof]));
        hand.controls.override_limits(&targets);
    }
}
