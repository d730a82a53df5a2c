//! The user's goal for a close, checked once, and the plan of its trials. Runs nothing.

use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::plan::{
    Approach, Limits, PlanError, TrialGrid, TrialPlan, TrialSetting, WAY_MIN,
};
use crate::trials::search::tolerance::{Assurance, FREE_90, FREE_95};
use std::time::Duration;

/// Smallest limit, g: a lower one is rarely distinct from sensor noise.
pub const LIMIT_MIN_G: i16 = 30;
/// Default limit, g.
const LIMIT_G: i16 = 500;
/// Default grasp force, as a share of the limit.
pub const HOLD_SHARE: f64 = 0.4;
/// Largest grasp force, as a share of the limit: the rest is room for the overshoot of a drive.
pub const HOLD_SHARE_MAX: f64 = 0.8;
/// Largest share of the limit for the first threshold: the overshoot and the reference of the drive are not known yet.
const FIRST_SHARE: f64 = 0.3;
/// Number of closes that confirm a setting.
pub const CLOSES_MIN: usize = 5;
pub const CLOSES_MAX: usize = 100;
pub const CLOSES: usize = FREE_95;
/// Force ceiling at which the hand is stopped, relative to the limit: separates a trial over the limit from a crash.
const CEILING_SHARE: f64 = 1.4;
const CEILING_MORE_G: f64 = 100.0;
/// Dwell of each trial: long enough to see the grip after it relaxed.
const DWELL: Duration = Duration::from_millis(700);
/// Rest between two trials.
const REST: Duration = Duration::from_millis(300);

/// Goal: the fastest close with its peak under a limit and a minimum hold.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchGoal {
    /// Limit of the peak on each joint, g.
    pub limit_g: i16,
    /// Smallest force on each joint after the grip has relaxed, g.
    pub hold_g: i16,
    /// Closes that confirm the setting.
    pub closes: usize,
    /// The bound is the largest of all closes, whatever their distribution.
    pub distribution_free: bool,
    /// Start angle of each joint; `None` leaves it where it is.
    pub start: PerDof<Option<Angle>>,
    /// Closing limit of each joint; `None` leaves it out.
    pub close: PerDof<Option<Angle>>,
    /// The temperature limits; the force ceiling follows from the limit.
    pub limits: Limits,
    /// The user's text.
    pub note: String,
    /// Search terms.
    pub tags: Vec<String>,
}

/// Reason why a goal is invalid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GoalError {
    /// A limit outside the measurable and settable range.
    #[error("a limit of {got} g is not between {LIMIT_MIN_G} and {} g", Force::RATED.get())]
    Limit { got: i16 },
    /// A hold that leaves no room under the limit.
    #[error(
        "holding with {hold} g leaves too little room under a limit of {limit} g: hold with at most {most} g, or raise the limit"
    )]
    Hold { hold: i16, limit: i16, most: i16 },
    /// Too few or too many closes.
    #[error("{got} closes are not between {CLOSES_MIN} and {CLOSES_MAX}")]
    Closes { got: usize },
    /// Too few closes for a distribution-free bound.
    #[error(
        "{got} closes prove nothing without a distribution: {FREE_90} prove 90 of 100 closes with 90 %, {FREE_95} prove 95 of 100 with 95 %"
    )]
    TooFew { got: usize },
    /// An invalid plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

impl Default for SearchGoal {
    fn default() -> Self {
        Self::new(&[Dof::Index], LIMIT_G)
    }
}

impl SearchGoal {
    /// A goal for some joints from open, with defaults for the rest.
    pub fn new(joints: &[Dof], limit_g: i16) -> Self {
        let of = |angle| PerDof::from_fn(|dof| joints.contains(&dof).then_some(angle));
        Self {
            limit_g,
            hold_g: Self::usual_hold_g(limit_g),
            closes: CLOSES,
            distribution_free: false,
            start: of(Angle::MAX),
            close: of(Angle::MIN),
            limits: Limits::default(),
            note: String::new(),
            tags: Vec::new(),
        }
    }

    /// Default hold, g.
    pub fn usual_hold_g(limit_g: i16) -> i16 {
        whole(f64::from(limit_g) * HOLD_SHARE)
    }

    /// The assurance of the confirming closes.
    pub const fn assurance(&self) -> Assurance {
        if !self.distribution_free {
            return Assurance::USUAL;
        }
        match Assurance::distribution_free(self.closes) {
            Some(assurance) => assurance,
            None => Assurance::USUAL,
        }
    }

    /// Checks the goal.
    ///
    /// # Errors
    /// [`GoalError`]: the first error.
    pub fn check(&self) -> Result<(), GoalError> {
        let (limit, hold, got) = (self.limit_g, self.hold_g, self.closes);
        if !(LIMIT_MIN_G..=Force::RATED.get()).contains(&limit) {
            return Err(GoalError::Limit { got: limit });
        }
        let most = whole(f64::from(limit) * HOLD_SHARE_MAX);
        if !(0..=most).contains(&hold) {
            return Err(GoalError::Hold { hold, limit, most });
        }
        if !(CLOSES_MIN..=CLOSES_MAX).contains(&got) {
            return Err(GoalError::Closes { got });
        }
        if self.distribution_free && got < FREE_90 {
            return Err(GoalError::TooFew { got });
        }
        Ok(self.plan(self.first_setting()).check()?)
    }

    /// The setting of the first, slow trial.
    pub fn first_setting(&self) -> TrialSetting {
        let force = (1.1 * f64::from(self.hold_g)).min(FIRST_SHARE * f64::from(self.limit_g));
        TrialSetting {
            speed: Speed::SLOWEST_MEASURED,
            force: Force::nearest(whole(force.max(f64::from(LIMIT_MIN_G) / 2.0))),
        }
    }

    /// The plan of a trial with this setting in one stage.
    pub fn plan(&self, setting: TrialSetting) -> TrialPlan {
        let limit = f64::from(self.limit_g);
        let ceiling = (limit * CEILING_SHARE).max(limit + CEILING_MORE_G);
        TrialPlan {
            grid: TrialGrid {
                rest: REST,
                ..TrialGrid::once(setting)
            },
            dwell: DWELL,
            limits: Limits {
                ceiling_g: whole(ceiling.min(f64::from(Force::MAX.get()))),
                ..self.limits
            },
            approach: Approach::OneStage,
            start: self.start,
            close: self.close,
            note: self.note.clone(),
            tags: self.tags.clone(),
            others: toml::Table::new(),
        }
    }

    /// The joints that close, in register order.
    pub fn joints(&self) -> impl Iterator<Item = Dof> {
        let joints = self.close.iter();
        joints.filter_map(|(dof, target)| target.map(|_| dof))
    }

    /// Start and length of a joint's way, units of ANGLE_ACT.
    pub(crate) fn way(&self, dof: Dof) -> (f64, f64) {
        let start = self.start[dof].unwrap_or(Angle::MAX).get();
        let close = self.close[dof].unwrap_or(Angle::MIN).get();
        (start.into(), f64::from((start - close).max(WAY_MIN)))
    }
}

/// Rounds to a whole number; saturates at the ends of the range.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a float cast saturates, which is what is wanted"
)]
pub fn whole(value: f64) -> i16 {
    value.round() as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wish_that_cannot_be_tried_is_refused_with_what_has_to_change() {
        let good = SearchGoal::new(&[Dof::Index], 500);
        assert_eq!(good.check(), Ok(()));
        assert_eq!(good.hold_g, 200);
        for (change, words) in [
            ((|w| w.limit_g = 29) as fn(&mut SearchGoal), "30 and 2000"),
            (|w| w.limit_g = 2001, "30 and 2000"),
            (|w| w.hold_g = 401, "at most 400 g"),
            (|w| w.closes = 4, "5 and 100"),
            (
                |w| (w.distribution_free, w.closes) = (true, 21),
                "59 prove 95 of 100",
            ),
            (|w| w.close = PerDof::splat(None), "no joint takes part"),
        ] {
            let mut goal = good.clone();
            change(&mut goal);
            let error = goal.check().unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
