//! The steps of a check-up, in order. One joint moves while the others are open, so that thumb and fingers never meet. Fingertips are
//! pressed last, once all motion has ended.

use crate::hand::{Angle, Dof, Finger, PerDof, Speed};
use std::collections::VecDeque;
use std::time::Duration;

/// The two speeds at which each joint is moved.
pub(crate) const SPEEDS: [i16; 2] = [200, 500];
/// Common target angle when all six move: well before thumb and fingers meet.
const TOGETHER: i16 = 700;
/// Duration of a rest.
pub(crate) const REST: Duration = Duration::from_secs(3);
/// Time allowed for the press of a fingertip.
pub(crate) const PRESS_TIMEOUT: Duration = Duration::from_secs(12);
/// Units of ANGLE_ACT per second for each unit of SPEED_SET, on the slower of the measured hands.
const UNITS_PER_SPEED: f64 = 1.52;
/// Time to confirm limits before a motion and to settle after it.
const AROUND_MOTION: Duration = Duration::from_millis(700);

/// Optional parts of a check-up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CheckupPlan {
    /// Request a press of each fingertip, once all motion has ended and the hand is not armed.
    pub press: bool,
}

/// Direction of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    Closing,
    Opening,
}

/// One part of a check-up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CheckupStep {
    /// All joints open, from wherever they are.
    Open,
    /// Nothing moves.
    Rest,
    /// One joint moves through its whole stroke.
    Stroke(Dof, Speed, Way),
    /// All six joints move part of their strokes at once.
    Together(Way),
    /// The user presses a fingertip; the hand is not armed.
    Press(Finger),
}

impl CheckupStep {
    /// Targets of the joints that move.
    pub(crate) fn targets(self) -> PerDof<Option<Angle>> {
        let end = |way| match way {
            Way::Closing => Angle::MIN,
            Way::Opening => Angle::MAX,
        };
        match self {
            Self::Rest | Self::Press(_) => PerDof::splat(None),
            Self::Open | Self::Together(Way::Opening) => PerDof::splat(Some(Angle::MAX)),
            Self::Together(Way::Closing) => PerDof::splat(Some(Angle::nearest(TOGETHER))),
            Self::Stroke(moved, _, way) => PerDof::from_fn(|dof| (dof == moved).then(|| end(way))),
        }
    }

    /// Speed of the joints that move.
    pub(crate) fn speed(self) -> Speed {
        match self {
            Self::Stroke(_, speed, _) => speed,
            Self::Open | Self::Rest | Self::Together(_) | Self::Press(_) => slow(),
        }
    }

    /// True if joints close, and may meet something.
    pub(crate) const fn closes(self) -> bool {
        matches!(
            self,
            Self::Stroke(_, _, Way::Closing) | Self::Together(Way::Closing)
        )
    }

    /// Expected duration, unless the check-up ends early.
    pub(crate) fn expected(self) -> Duration {
        let way = match self {
            Self::Rest => return REST,
            Self::Press(_) => return PRESS_TIMEOUT,
            // The joints are usually open already.
            Self::Open => 0,
            Self::Stroke(..) => Angle::MAX.get(),
            Self::Together(_) => Angle::MAX.get() - TOGETHER,
        };
        let a_second = UNITS_PER_SPEED * f64::from(self.speed().get());
        AROUND_MOTION + Duration::from_secs_f64(f64::from(way) / a_second)
    }
}

/// The slower speed.
pub(crate) fn slow() -> Speed {
    let [slow, _] = SPEEDS;
    Speed::nearest(slow)
}

/// All steps of a check-up.
pub(crate) fn steps(plan: CheckupPlan) -> VecDeque<CheckupStep> {
    let ways = [Way::Closing, Way::Opening];
    let strokes = Dof::ALL.into_iter().flat_map(|dof| {
        let speeds = SPEEDS.map(Speed::nearest).into_iter();
        speeds.flat_map(move |speed| ways.map(|way| CheckupStep::Stroke(dof, speed, way)))
    });
    let together = ways.map(CheckupStep::Together);
    let pressed = Finger::ALL.into_iter().rev().filter(|_| plan.press);
    [CheckupStep::Open, CheckupStep::Rest]
        .into_iter()
        .chain(strokes)
        .chain(together)
        .chain([CheckupStep::Rest])
        .chain(pressed.map(CheckupStep::Press))
        .collect()
}

/// Expected duration of a check-up.
pub fn expected(plan: CheckupPlan) -> Duration {
    steps(plan).into_iter().map(CheckupStep::expected).sum()
}
