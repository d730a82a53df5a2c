//! Calibrations with a kitchen scale, with the shown hand.

use crate::app::env::Ctx;
use crate::app::hand::Hand;
use crate::app::hand::running::MotionRun;
use crate::app::hand::scale::{ScaleAction, ScaleMotion};
use crate::hand::newtons::{JointPoints, ScalePoint};
use crate::hand::{Angle, Dof, Force, PerDof};
use crate::motion::scale::{ScaleInput, ScaleStart};
use crate::store::calendar::{day, since_1970};

/// Carries out an action on a calibration.
pub(super) fn scale(hand: &mut Hand, action: ScaleAction, ctx: &Ctx<'_>) {
    let answer = match action {
        ScaleAction::Start(dof, limit) => return start(hand, dof, limit, ctx),
        ScaleAction::Forget(dof) => {
            let none = joint(Force::GENTLE, Vec::new());
            return hand.newtons.put(dof, none, ctx);
        }
        ScaleAction::Reading(grams) => ScaleInput::Reading(grams),
        ScaleAction::Again => ScaleInput::Again,
        ScaleAction::Skip => ScaleInput::Skip,
        ScaleAction::Finish => ScaleInput::Finish,
    };
    if let Some(run) = hand.running.scale_mut() {
        run.answer(answer);
    }
}

/// Applies the progress of a calibration, and stores its points.
pub(super) fn tick(hand: &mut Hand, ctx: &Ctx<'_>) {
    let Some(run) = hand.running.scale_mut() else {
        return;
    };
    if let Some(points) = run.news() {
        let points = points.to_vec();
        let (dof, limit) = (run.dof, run.limit);
        hand.newtons.put(dof, joint(limit, points), ctx);
    }
}

fn joint(limit: Force, points: Vec<ScalePoint>) -> JointPoints {
    JointPoints {
        limit,
        day: day(since_1970()),
        points,
    }
}

/// Starts a calibration, if the hand is armed. Loads that were accepted earlier with this limit are not measured again.
fn start(hand: &mut Hand, dof: Dof, limit: Force, ctx: &Ctx<'_>) {
    let Some((link, armed)) = hand.lend_armed(ctx.env.clock) else {
        return;
    };
    // The user's own speed and threshold are restored when the user moves the joint next.
    hand.controls
        .override_limits(&PerDof::from_fn(|own| (own == dof).then_some(Angle::MAX)));
    let known = hand.newtons.points(dof);
    let known = known.filter(|own| own.limit == limit && own.scale().is_err());
    let points = known.map(|own| own.points.clone()).unwrap_or_default();
    let start = ScaleStart { dof, limit, points };
    let run = ScaleMotion::begin(link, armed, start, ctx.env);
    hand.running.0 = Some(MotionRun::Scale(Box::new(run)));
}
