//! What the user wants of a close, checked once, and the plan that its trials are made from. Runs nothing.

use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::plan::{
    Approach, Limits, PlanError, TrialGrid, TrialPlan, TrialSetting, WAY_MIN,
};
use crate::trials::search::tolerance::{Assurance, FREE_90, FREE_95};
use std::time::Duration;

/// The smallest limit that can be asked for, g: sensors rarely tell less from their noise.
pub const LIMIT_MIN_G: i16 = 30;
/// The limit if nobody says, g.
const LIMIT_G: i16 = 500;
/// What a grasp holds with if nobody says: this share of the limit.
pub const HOLD_SHARE: f64 = 0.4;
/// The most that a grasp may be asked to hold with: the rest is for what a drive runs past its threshold.
pub const HOLD_SHARE_MAX: f64 = 0.8;
/// The first threshold is at most this share of the limit: how far a drive runs past it, and what it compares it with, is not known.
const FIRST_SHARE: f64 = 0.3;
/// Closes that confirm a setting.
pub const CLOSES_MIN: usize = 5;
pub const CLOSES_MAX: usize = 100;
pub const CLOSES: usize = FREE_95;
/// How far past the limit a force may be before the hand is stopped: a trial over the limit is told from a crash.
const CEILING_SHARE: f64 = 1.4;
const CEILING_MORE_G: f64 = 100.0;
/// Held so long in each trial: long enough to see what is left once the grip has relaxed.
const DWELL: Duration = Duration::from_millis(700);
/// Between two trials.
const REST: Duration = Duration::from_millis(300);

/// The fastest close that is wanted: its peak stays under a limit, and it holds with some force.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchGoal {
    /// Limit of the peak on each joint, g.
    pub limit_g: i16,
    /// What is left on each joint once the grip has relaxed, g at least.
    pub hold_g: i16,
    /// Closes that confirm the setting.
    pub closes: usize,
    /// The bound is the largest of all closes, whatever their distribution.
    pub distribution_free: bool,
    /// Start angle of each joint; `None` leaves it where it is.
    pub start: PerDof<Option<Angle>>,
    /// Angle that each joint closes to at most; `None` leaves it out.
    pub close: PerDof<Option<Angle>>,
    /// The temperatures; the ceiling of the force comes from the limit.
    pub limits: Limits,
    /// In the words of the user.
    pub note: String,
    /// Words to find it by.
    pub tags: Vec<String>,
}

/// Why a goal cannot be tried.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GoalError {
    /// A limit outside what can be measured and set.
    #[error("a limit of {got} g is not between {LIMIT_MIN_G} and {} g", Force::RATED.get())]
    Limit { got: i16 },
    /// More to hold than the limit leaves room for.
    #[error(
        "holding with {hold} g leaves too little room under a limit of {limit} g: hold with at most {most} g, or raise the limit"
    )]
    Hold { hold: i16, limit: i16, most: i16 },
    /// Too few or too many closes.
    #[error("{got} closes are not between {CLOSES_MIN} and {CLOSES_MAX}")]
    Closes { got: usize },
    /// Too few closes to say anything without a distribution.
    #[error(
        "{got} closes say nothing without a distribution: {FREE_90} say 90 of 100 closes with 90 %, {FREE_95} say 95 of 100 with 95 %"
    )]
    TooFew { got: usize },
    /// What makes no plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

impl Default for SearchGoal {
    fn default() -> Self {
        Self::new(&[Dof::Index], LIMIT_G)
    }
}

impl SearchGoal {
    /// A goal for some joints from open, with what is usual for the rest.
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

    /// What is held with if nobody says, g.
    pub fn usual_hold_g(limit_g: i16) -> i16 {
        whole(f64::from(limit_g) * HOLD_SHARE)
    }

    /// What the confirming closes will say.
    pub const fn assurance(&self) -> Assurance {
        if !self.distribution_free {
            return Assurance::USUAL;
        }
        match Assurance::distribution_free(self.closes) {
            Some(assurance) => assurance,
            None => Assurance::USUAL,
        }
    }

    /// Checks it.
    ///
    /// # Errors
    /// [`GoalError`]: what has to change.
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

    /// What the first, slow trial is made with.
    pub fn first_setting(&self) -> TrialSetting {
        let force = (1.1 * f64::from(self.hold_g)).min(FIRST_SHARE * f64::from(self.limit_g));
        TrialSetting {
            speed: Speed::SLOWEST_MEASURED,
            force: Force::nearest(whole(force.max(f64::from(LIMIT_MIN_G) / 2.0))),
        }
    }

    /// A trial of this setting in one stage.
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

    /// Where a joint's way begins and how far it leads, units of ANGLE_ACT.
    pub(crate) fn way(&self, dof: Dof) -> (f64, f64) {
        let start = self.start[dof].unwrap_or(Angle::MAX).get();
        let close = self.close[dof].unwrap_or(Angle::MIN).get();
        (start.into(), f64::from((start - close).max(WAY_MIN)))
    }
}

/// To the nearest whole number; runs past the ends stay at the ends.
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
                "59 say 95 of 100",
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
