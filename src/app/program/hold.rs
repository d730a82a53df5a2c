//! Holds between two forces with the shown hand.

use crate::app::env::Env;
use crate::app::hand::Hand;
use crate::app::hand::hold::{HoldAction, HoldMotion};
use crate::app::hand::running::MotionRun;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Angle, PerDof};
use crate::motion::drive::Armed;
use crate::motion::hold::{HoldClose, HoldStart};
use crate::record::Abort;

/// Carries out an action on a hold.
pub(super) fn hold(hand: &mut Hand, action: HoldAction, env: &Env) {
    match action {
        HoldAction::Forces(forces) => hand.controls.set_hold_forces(forces),
        HoldAction::Start(close) => start(hand, close, env),
        HoldAction::End => {
            if let Some(run) = hand.running.hold_mut() {
                run.end(Abort::Person);
            }
        }
    }
}

/// Starts a hold, if the hand is armed.
fn start(hand: &mut Hand, close: HoldClose, env: &Env) {
    let Some(epoch) = hand.own_epoch() else {
        return;
    };
    hand.take_over();
    // The user's own speeds and thresholds are restored when the user moves a joint next.
    hand.controls
        .override_limits(&PerDof::splat(Some(Angle::MAX)));
    let start = HoldStart {
        close,
        forces: hand.controls.hold_forces(),
        duration: None,
        reading_per_g: PerDof::splat(1.0),
        locked: hand.controls.locked(),
        overshoot: OvershootMap::clone(&hand.overshoot.map),
        grip: hand.readings.grip.clone(),
    };
    let Some(open) = &mut hand.connection.open else {
        return;
    };
    let armed = Armed {
        epoch,
        lease: open.lend_lease(),
        seen: hand.readings.sample,
        clock: env.clock,
    };
    let run = HoldMotion::begin(open.link.clone(), armed, start, env);
    hand.running.0 = Some(MotionRun::Hold(run));
}
