//! The next small step of a hand that is to go to a gap: open first, until thumb and index cannot meet, then to the path on
//! which their pads do and along it.

use crate::hand::gap::{Gap, is_open_for_pinch, pad_distance};
use crate::hand::{Angle, Dof, PerDof};
use crate::poses::way::{Targets, way};

/// Targets nearer to the path than this, in counts, are on it; a part of it that is nearer is done.
const NEAR: f32 = 1.5;

/// A gap that is gone to, and the joints that may move.
#[derive(Debug, Clone, Copy)]
pub(super) struct PinchAim {
    pub(super) gap: Gap,
    pub(super) moves: PerDof<bool>,
}

/// Where the joints go next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum PinchStep {
    /// Thumb and index could meet still: these joints, each by itself.
    Open(Targets),
    /// Along the path: thumb and index together, in a straight line to here; the others by themselves.
    Along(PerDof<Angle>),
}

/// How far a target may go at once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// Counts at this step.
    pub(super) step: f32,
    /// Counts ahead of the joint.
    pub(super) lead: f32,
}

/// Whether thumb and index can go to any gap from where they are; `None` where that is not known.
pub(super) fn is_open(pose: &Targets) -> Option<bool> {
    Some(is_open_for_pinch(&pinching(pose)?))
}

/// The way to where they can, from where the joints are; its first part.
pub(super) fn opening(pose: &Targets) -> PinchStep {
    let from = pose.map(|at| at.map(Angle::get));
    let open = way(&from, &Gap::MAX.angles().map(Some));
    PinchStep::Open(open.first().copied().unwrap_or(PerDof::splat(None)))
}

/// The next part of the path from where the joints were sent.
pub(super) fn along(sent: &PerDof<f32>, to: Gap) -> PinchStep {
    let near = Gap::nearest(pad_distance(sent));
    let is_far = |angles: &PerDof<Angle>| distance(sent, angles) > NEAR;
    if is_far(&near.angles()) {
        return PinchStep::Along(near.angles());
    }
    let parts = near.legs_to(to).into_iter().map(|leg| leg.to);
    PinchStep::Along(parts.clone().find(is_far).unwrap_or_else(|| to.angles()))
}

/// How much of the straight line to `to` thumb and index may go at once, 0 to 1.
pub(super) fn share(sent: &PerDof<f32>, to: &PerDof<Angle>, at: &PerDof<f32>, reach: Reach) -> f32 {
    let share = |dof: Dof| {
        let way = f32::from(to[dof].get()) - sent[dof];
        let ahead = (sent[dof] - at[dof]) * way.signum();
        let free = reach.step.min(reach.lead - ahead).max(0.0);
        if way == 0.0 { 1.0 } else { free / way.abs() }
    };
    Gap::JOINTS.into_iter().map(share).fold(1.0, f32::min)
}

/// Counts of all joints, where those that pinch are known; the others count as open.
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
