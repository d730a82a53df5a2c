//! The next small step of a hand moving to a gap: open first, until thumb and index cannot collide, then to the path on
//! which their pads meet, and along it.

use crate::hand::gap::{Gap, is_open_for_pinch, pad_distance};
use crate::hand::{Angle, Dof, PerDof};
use crate::poses::way::{Targets, way};

/// Distance from the path, in counts, within which targets are on it, and within which a leg of it is completed.
const NEAR: f32 = 1.5;

/// Target gap and the joints that may move.
#[derive(Debug, Clone, Copy)]
pub(super) struct PinchAim {
    pub(super) gap: Gap,
    pub(super) moves: PerDof<bool>,
}

/// Next motion of the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PinchStep {
    /// Thumb and index could still collide: these joints, each independently.
    Open(Targets),
    /// Along the path: thumb and index together, in a straight line to here; the other joints independently.
    Along(PerDof<Angle>),
}

/// Limits of one step of a target.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepLimits {
    /// Counts in this step.
    pub(super) step: f32,
    /// Counts ahead of the joint's actual position.
    pub(super) lead: f32,
}

/// True if thumb and index can move to any gap from this pose; `None` if their position is not known.
pub(super) fn is_open(pose: &Targets) -> Option<bool> {
    Some(is_open_for_pinch(&pinching(pose)?))
}

/// First leg from the actual pose to one from which they can.
pub(super) fn opening(pose: &Targets) -> PinchStep {
    let from = pose.map(|at| at.map(Angle::get));
    let open = way(&from, &Gap::MAX.angles().map(Some));
    PinchStep::Open(open.first().copied().unwrap_or(PerDof::splat(None)))
}

/// Next leg of the path from the last targets.
pub(super) fn along(sent: &PerDof<f32>, to: Gap) -> PinchStep {
    let near = Gap::nearest(pad_distance(sent));
    let is_far = |angles: &PerDof<Angle>| distance(sent, angles) > NEAR;
    if is_far(&near.angles()) {
        return PinchStep::Along(near.angles());
    }
    let parts = near.legs_to(to).into_iter().map(|leg| leg.to);
    PinchStep::Along(parts.clone().find(is_far).unwrap_or_else(|| to.angles()))
}

/// Share of the straight line to `to` that thumb and index may move in one step, 0 to 1.
pub(super) fn share(
    sent: &PerDof<f32>,
    to: &PerDof<Angle>,
    at: &PerDof<f32>,
    reach: StepLimits,
) -> f32 {
    let share = |dof: Dof| {
        let way = f32::from(to[dof].get()) - sent[dof];
        let ahead = (sent[dof] - at[dof]) * way.signum();
        let free = reach.step.min(reach.lead - ahead).max(0.0);
        if way == 0.0 { 1.0 } else { free / way.abs() }
    };
    Gap::JOINTS.into_iter().map(share).fold(1.0, f32::min)
}

/// Counts of all joints if the pinching ones are known; the others count as open.
fn pinching(pose: &Targets) -> Option<PerDof<f32>> {
    let known = PerDof::from_fn(|dof| match Gap::JOINTS.contains(&dof) {
        true => pose[dof],
        false => Some(Angle::MAX),
    });
    Some(known.all()?.map(|at| f32::from(at.get())))
}

fn distance(sent: &PerDof<f32>, to: &PerDof<Angle>) -> f32 {
    let way = |dof: Dof| (f32::from(to[dof].get()) - sent[dof]).abs();
    Gap::JOINTS.into_iter().map(way).fold(0.0, f32::max)
}
