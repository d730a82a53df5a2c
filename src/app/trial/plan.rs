//! What a series of grasp trials is to do, checked once. Runs nothing.

use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use std::time::Duration;

/// Trials in one series: a day of them.
pub const TRIALS_MAX: usize = 1000;
/// Longest dwell, rest or wait that a plan may ask for.
pub const WAIT_MAX: Duration = Duration::from_secs(600);
/// Shortest dwell: less leaves no steady force to measure.
pub const DWELL_MIN: Duration = Duration::from_millis(300);
/// A joint has at least this way to close, so that its motion can be told from noise.
pub const WAY_MIN: i16 = 30;
/// Highest temperature that a limit may be set to, °C: from here on the hand itself is near its fault.
pub const TEMPERATURE_MAX: u8 = 75;
/// A measured contact is approached fast up to this far before it, units of ANGLE_ACT, unless said otherwise.
pub const MARGIN: i16 = 40;

/// A series of grasp trials.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialPlan {
    /// Where each joint stands before; `None` = where it is.
    pub start: PerDof<Option<Angle>>,
    /// Where each closes to; `None` = it takes no part.
    pub close: PerDof<Option<Angle>>,
    /// How the object is reached.
    pub approach: Approach,
    /// Time held, from the stop on.
    pub dwell: Duration,
    /// Speeds, thresholds and how often each.
    pub grid: Grid,
    /// What ends it.
    pub limits: Limits,
}

/// How the object is reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Approach {
    /// At the setting's speed all the way.
    OneStage,
    /// Fast at first, then at the setting's speed.
    TwoStage {
        /// Speed of the first stage.
        fast: Speed,
        /// When the second begins, joint by joint.
        until: Until,
    },
}

/// When the slow stage of a joint begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// At this angle, where the joint stops by itself.
    Angle(Angle),
    /// So far before the contact that a first, slow trial of the series measured.
    Measured {
        /// Units of ANGLE_ACT, 0..=500.
        margin: i16,
    },
    /// When the proximity of its fingertip has risen by this many counts.
    Proximity(i32),
    /// When its fingertip feels this, g, or its force sensor so much more than before.
    Touch(Force),
}

/// One cell of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Setting {
    /// SPEED_SET at the contact.
    pub speed: Speed,
    /// FORCE_SET.
    pub force: Force,
}

/// Every speed with every threshold, so many times.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    /// Speeds at the contact.
    pub speeds: Vec<Speed>,
    /// Force thresholds.
    pub forces: Vec<Force>,
    /// Times that each cell is tried.
    pub repeats: usize,
    /// Time between two trials.
    pub rest: Duration,
}

impl Grid {
    /// One setting, tried once.
    #[must_use]
    pub fn once(setting: Setting) -> Self {
        Self {
            speeds: vec![setting.speed],
            forces: vec![setting.force],
            repeats: 1,
            rest: Duration::ZERO,
        }
    }

    /// Settings in the order of trial: the gentlest first, each as often as asked before the next.
    #[must_use]
    pub fn settings(&self) -> Vec<Setting> {
        let each = |speed: &Speed| {
            let speed = *speed;
            self.forces.iter().map(move |force| Setting {
                speed,
                force: *force,
            })
        };
        let mut cells: Vec<Setting> = self.speeds.iter().flat_map(each).collect();
        cells.sort_unstable();
        cells.dedup();
        let repeated = |cell| std::iter::repeat_n(cell, self.repeats);
        cells.into_iter().flat_map(repeated).collect()
    }
}

/// What ends a trial and the series with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Force on any joint, g above its reading at rest, at which the trial is stopped. It comes after the force: a
    /// peak that is over between two reads is seen and not prevented.
    pub ceiling_g: i16,
    /// Temperature of any joint, °C, at which it is stopped …
    pub stop_c: u8,
    /// … and below which all joints must be before the next trial begins.
    pub start_c: u8,
}

impl Default for Limits {
    /// The rated grip of a finger; temperatures well below those at which the hand protects itself.
    fn default() -> Self {
        Self {
            ceiling_g: Force::RATED.get(),
            stop_c: 60,
            start_c: 50,
        }
    }
}

/// Why a plan cannot be run. Nothing of it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// No joint closes.
    #[error("no joint takes part: name at least one")]
    NoJoint,
    /// A joint whose start is not known to be further open than its target.
    #[error(
        "{} would close from {start} to {close}: it needs a start at least {WAY_MIN} above its target, 1000 is open", dof.name()
    )]
    NoWay {
        /// The joint.
        dof: Dof,
        /// Where it stands.
        start: i16,
        /// Where it goes.
        close: i16,
    },
    /// A joint takes part and no start is given for it.
    #[error("{} takes part and has no start", dof.name())]
    NoStart {
        /// The joint.
        dof: Dof,
    },
    /// The stages change outside the way.
    #[error("the slow stage of {} would begin at {at}, outside its way from {start} to {close}", dof.name())]
    Stage {
        /// The joint.
        dof: Dof,
        /// Where the stages change.
        at: i16,
        /// Where it stands.
        start: i16,
        /// Where it goes.
        close: i16,
    },
    /// The first stage is slower than the second.
    #[error("the approach at {fast} is slower than the contact at {speed}")]
    SlowApproach {
        /// Of the first stage.
        fast: i16,
        /// Of the second.
        speed: i16,
    },
    /// A proximity or a margin that means nothing.
    #[error("the approach ends at {got}, which is not between 1 and {most}")]
    Until {
        /// What was given.
        got: i32,
        /// The largest.
        most: i32,
    },
    /// A touch that is no touch.
    #[error("a touch of 0 g is there before anything is touched")]
    NoTouch,
    /// No cell in the grid.
    #[error(
        "there is nothing to try: name a speed and a force threshold, and try them at least once"
    )]
    Empty,
    /// Speed 0 never arrives.
    #[error("speed 0 does not move")]
    NoSpeed,
    /// More than a series holds.
    #[error("{got} trials are too many: {TRIALS_MAX} at most")]
    TooMany {
        /// How many.
        got: usize,
    },
    /// A dwell that is too short or too long.
    #[error("a dwell of {ms} ms is not between 300 and 600000")]
    Dwell {
        /// Milliseconds.
        ms: u128,
    },
    /// A rest that is too long.
    #[error("a rest of {ms} ms is longer than 600000")]
    Rest {
        /// Milliseconds.
        ms: u128,
    },
    /// A force ceiling that is below the threshold, or that the sensor cannot show.
    #[error("a force ceiling of {got} g is not between {least} (the largest threshold) and 4000")]
    Ceiling {
        /// What was given.
        got: i16,
        /// Smallest that makes sense.
        least: i16,
    },
    /// Temperatures in the wrong order.
    #[error("the temperatures {start} and {stop} must rise and stay at or below {TEMPERATURE_MAX}")]
    Temperature {
        /// At which trials begin.
        start: u8,
        /// At which they end.
        stop: u8,
    },
}

impl TrialPlan {
    /// Checks everything that can be checked without the hand.
    ///
    /// # Errors
    /// [`PlanError`]: the first thing that is wrong.
    pub fn check(&self) -> Result<(), PlanError> {
        if self.joints().next().is_none() {
            return Err(PlanError::NoJoint);
        }
        for (dof, start, close) in self.ways() {
            let start = start.ok_or(PlanError::NoStart { dof })?.get();
            let close = close.get();
            if start - close < WAY_MIN {
                return Err(PlanError::NoWay { dof, start, close });
            }
        }
        self.check_grid()?;
        self.check_approach()?;
        let ms = self.dwell.as_millis();
        if !(DWELL_MIN..=WAIT_MAX).contains(&self.dwell) {
            return Err(PlanError::Dwell { ms });
        }
        self.check_limits()
    }

    fn check_grid(&self) -> Result<(), PlanError> {
        let grid = &self.grid;
        if grid.speeds.is_empty() || grid.forces.is_empty() || grid.repeats == 0 {
            return Err(PlanError::Empty);
        }
        let cells = grid.speeds.len().saturating_mul(grid.forces.len());
        let got = cells.saturating_mul(grid.repeats);
        if got > TRIALS_MAX {
            return Err(PlanError::TooMany { got });
        }
        if grid.speeds.contains(&Speed::MIN) {
            return Err(PlanError::NoSpeed);
        }
        if grid.rest > WAIT_MAX {
            let ms = grid.rest.as_millis();
            return Err(PlanError::Rest { ms });
        }
        Ok(())
    }

    fn check_approach(&self) -> Result<(), PlanError> {
        let Approach::TwoStage { fast, until } = self.approach else {
            return Ok(());
        };
        let slowest_first = self.grid.speeds.iter().find(|speed| **speed > fast);
        if let Some(speed) = slowest_first {
            let (fast, speed) = (fast.get(), speed.get());
            return Err(PlanError::SlowApproach { fast, speed });
        }
        let within = |got: i32, most: i32| match (1..=most).contains(&got) {
            true => Ok(()),
            false => Err(PlanError::Until { got, most }),
        };
        match until {
            Until::Angle(at) => self.check_stage(at),
            Until::Measured { margin } => within(margin.into(), 500),
            Until::Proximity(counts) => within(counts, 16_000_000),
            Until::Touch(Force::MIN) => Err(PlanError::NoTouch),
            Until::Touch(_) => Ok(()),
        }
    }

    fn check_stage(&self, at: Angle) -> Result<(), PlanError> {
        let outside = |(_, start, close): &(Dof, Option<Angle>, Angle)| {
            at <= *close || start.is_none_or(|start| at >= start)
        };
        match self.ways().find(outside) {
            None => Ok(()),
            Some((dof, start, close)) => Err(PlanError::Stage {
                dof,
                at: at.get(),
                start: start.map_or(0, Angle::get),
                close: close.get(),
            }),
        }
    }

    fn check_limits(&self) -> Result<(), PlanError> {
        let Limits {
            ceiling_g: got,
            stop_c: stop,
            start_c: start,
        } = self.limits;
        let least = self.grid.forces.iter().map(|force| force.get()).max();
        let least = least.unwrap_or_default().max(1);
        if !(least..=4000).contains(&got) {
            return Err(PlanError::Ceiling { got, least });
        }
        if start >= stop || stop > TEMPERATURE_MAX {
            return Err(PlanError::Temperature { start, stop });
        }
        Ok(())
    }

    /// The joints that take part, in register order.
    pub fn joints(&self) -> impl Iterator<Item = Dof> {
        self.ways().map(|(dof, ..)| dof)
    }

    fn ways(&self) -> impl Iterator<Item = (Dof, Option<Angle>, Angle)> {
        Dof::ALL
            .into_iter()
            .filter_map(|dof| Some((dof, self.start[dof], self.close[dof]?)))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    /// The index finger from open to bent, once.
    fn index(speed: i16, force: i16) -> TrialPlan {
        let mut plan = TrialPlan {
            start: PerDof::splat(None),
            close: PerDof::splat(None),
            approach: Approach::OneStage,
            dwell: Duration::from_secs(1),
            grid: Grid::once(Setting {
                speed: Speed::nearest(speed),
                force: Force::nearest(force),
            }),
            limits: Limits {
                ceiling_g: 4000,
                ..Limits::default()
            },
        };
        plan.start[Dof::Index] = Some(Angle::MAX);
        plan.close[Dof::Index] = Some(Angle::nearest(100));
        plan
    }

    fn two_stage(mut plan: TrialPlan, until: Until) -> TrialPlan {
        plan.approach = Approach::TwoStage {
            fast: Speed::MAX,
            until,
        };
        plan
    }

    fn wrong(change: impl Fn(&mut TrialPlan)) -> PlanError {
        let mut plan = index(250, 500);
        plan.check().unwrap();
        change(&mut plan);
        plan.check().unwrap_err()
    }

    #[test]
    fn a_plan_that_makes_no_sense_is_refused_with_the_reason() {
        let dof = Dof::Index;
        assert_eq!(wrong(|p| p.close[dof] = None), PlanError::NoJoint);
        assert_eq!(wrong(|p| p.start[dof] = None), PlanError::NoStart { dof });
        let near = wrong(|p| p.start[dof] = Some(Angle::nearest(129)));
        let (start, close) = (129, 100);
        assert_eq!(near, PlanError::NoWay { dof, start, close });
        assert_eq!(wrong(|p| p.grid.repeats = 0), PlanError::Empty);
        assert_eq!(wrong(|p| p.grid.forces.clear()), PlanError::Empty);
        let got = 1001;
        assert_eq!(wrong(|p| p.grid.repeats = 1001), PlanError::TooMany { got });
        assert_eq!(
            wrong(|p| p.grid.speeds.push(Speed::MIN)),
            PlanError::NoSpeed
        );
        assert!(matches!(
            wrong(|p| p.dwell = Duration::ZERO),
            PlanError::Dwell { ms: 0 }
        ));
        assert!(matches!(
            wrong(|p| p.grid.rest = Duration::from_secs(601)),
            PlanError::Rest { .. }
        ));
        let (got, least) = (499, 500);
        assert_eq!(
            wrong(|p| p.limits.ceiling_g = 499),
            PlanError::Ceiling { got, least }
        );
        assert!(matches!(
            wrong(|p| p.limits.stop_c = 76),
            PlanError::Temperature { .. }
        ));
        assert!(matches!(
            wrong(|p| p.limits.start_c = 60),
            PlanError::Temperature { .. }
        ));
    }

    #[test]
    fn stages_that_make_no_sense_are_refused() {
        for until in [
            Until::Angle(Angle::MAX),
            Until::Angle(Angle::nearest(100)),
            Until::Measured { margin: 0 },
            Until::Proximity(0),
            Until::Touch(Force::MIN),
        ] {
            assert!(
                two_stage(index(25, 500), until).check().is_err(),
                "{until:?}"
            );
        }
        let mut slow = two_stage(index(250, 500), Until::Proximity(5000));
        slow.check().unwrap();
        slow.approach = Approach::TwoStage {
            fast: Speed::nearest(100),
            until: Until::Proximity(5000),
        };
        let (fast, speed) = (100, 250);
        assert_eq!(slow.check(), Err(PlanError::SlowApproach { fast, speed }));
    }

    #[test]
    fn a_grid_tries_each_cell_as_often_as_asked_the_gentlest_first() {
        let grid = Grid {
            speeds: [250, 25, 250].map(Speed::nearest).into(),
            forces: [500, 100].map(Force::nearest).into(),
            repeats: 2,
            rest: Duration::ZERO,
        };
        let order: Vec<(i16, i16)> = grid
            .settings()
            .iter()
            .map(|setting| (setting.speed.get(), setting.force.get()))
            .collect();
        let cells = [(25, 100), (25, 500), (250, 100), (250, 500)];
        let twice: Vec<(i16, i16)> = cells.into_iter().flat_map(|cell| [cell, cell]).collect();
        assert_eq!(order, twice);
    }
}
