//! The plan of a series of grasp trials: one type for window, command line and files. Checked once; runs nothing.

use crate::hand::overshoot::{Expected, OvershootMap, Stages};
use crate::hand::{Angle, Dof, Force, OutOfRange, PerDof, Speed};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::time::Duration;

/// Maximum number of trials in one series: about a day.
pub const TRIALS_MAX: u16 = 1000;
/// Longest dwell or rest in a plan.
pub const WAIT_MAX: Duration = Duration::from_secs(600);
/// Shortest dwell: a shorter one leaves no steady force to measure.
pub const DWELL_MIN: Duration = Duration::from_millis(300);
/// Shortest way of a joint, so that its motion is distinct from noise, units of ANGLE_ACT.
pub const WAY_MIN: i16 = 30;
/// Highest temperature limit, °C: beyond it the hand is close to its own fault.
pub const TEMPERATURE_MAX: u8 = 75;
/// Default margin before a measured contact at which the fast approach ends, units of ANGLE_ACT.
pub const MARGIN: i16 = 40;

/// A series of grasp trials. In files it is the table `plan` of `session.toml` and `trial_plan` of the settings.
///
/// ```
/// use handscope_core::hand::{Angle, Dof, Speed};
/// use handscope_core::trials::TrialPlan;
///
/// let mut plan = TrialPlan::default();
/// plan.grid.speeds = vec![Speed::new(100)?, Speed::new(400)?];
/// plan.start[Dof::Index] = Some(Angle::new(1000)?);
/// plan.close[Dof::Index] = Some(Angle::new(0)?);
/// assert_eq!(plan.check(), Ok(()));
/// // So short a way is not distinct from noise.
/// plan.close[Dof::Index] = Some(Angle::new(990)?);
/// assert!(plan.check().is_err());
/// # Ok::<(), handscope_core::hand::OutOfRange>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialPlan {
    /// Speeds, thresholds and the number of repeats.
    #[serde(flatten)]
    pub grid: TrialGrid,
    /// Holding time after the stop.
    #[serde(rename = "dwell_s", with = "seconds")]
    pub dwell: Duration,
    /// Limits that end a trial.
    #[serde(flatten)]
    pub limits: Limits,
    /// Approach to the object.
    #[serde(flatten)]
    pub approach: Approach,
    /// Start angle of each joint; `None` leaves it where it is.
    #[serde(with = "by_joint")]
    pub start: PerDof<Option<Angle>>,
    /// Closing target of each joint; `None` leaves it out.
    #[serde(with = "by_joint")]
    pub close: PerDof<Option<Angle>>,
    /// The user's text.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// Search terms.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tags: Vec<String>,
    /// Keys of a later version, preserved.
    #[serde(flatten)]
    pub others: toml::Table,
}

/// Approach to the object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "ApproachKeys", into = "ApproachKeys")]
pub enum Approach {
    /// At the setting's speed all the way.
    OneStage,
    /// Fast at first, then at the setting's speed.
    TwoStage {
        /// Speed of the first stage.
        fast: Speed,
        /// Start of the second stage, per joint.
        until: Until,
    },
}

/// Start of the slow stage of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// At this angle, where the joint stops by itself.
    Angle(Angle),
    /// At this distance before the contact that a first, slow trial of the series measured.
    Measured {
        /// Units of ANGLE_ACT, 0..=500.
        margin: i16,
    },
    /// Once the proximity of its fingertip has risen by this many counts.
    Proximity(i32),
    /// Once its fingertip feels this force, g, or its force sensor reads this much above rest.
    Touch(Force),
}

/// One cell of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct TrialSetting {
    /// SPEED_SET at the contact.
    pub speed: Speed,
    /// FORCE_SET.
    #[serde(rename = "force_threshold_g")]
    pub force: Force,
}

impl std::fmt::Display for TrialSetting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (speed, force) = (self.speed.get(), self.force.get());
        write!(f, "speed {speed}, threshold {force} g")
    }
}

/// Every speed with every threshold, repeated.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrialGrid {
    /// Speeds at the contact.
    pub speeds: Vec<Speed>,
    /// Force thresholds.
    #[serde(rename = "forces_g")]
    pub forces: Vec<Force>,
    /// Trials per cell.
    pub repeats: usize,
    /// Time between two trials.
    #[serde(rename = "rest_s", with = "seconds")]
    pub rest: Duration,
}

impl TrialGrid {
    /// A single trial of one setting.
    pub fn once(setting: TrialSetting) -> Self {
        Self {
            speeds: vec![setting.speed],
            forces: vec![setting.force],
            repeats: 1,
            rest: Duration::ZERO,
        }
    }

    /// Settings in trial order: gentlest first, all repeats of one before the next.
    pub fn settings(&self) -> Vec<TrialSetting> {
        let each = |speed: &Speed| {
            let speed = *speed;
            self.forces.iter().map(move |force| TrialSetting {
                speed,
                force: *force,
            })
        };
        let mut cells: Vec<TrialSetting> = self.speeds.iter().flat_map(each).collect();
        cells.sort_unstable();
        cells.dedup();
        let repeated = |cell| std::iter::repeat_n(cell, self.repeats);
        cells.into_iter().flat_map(repeated).collect()
    }
}

/// Limits that end a trial and its series.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Limits {
    /// Force on any joint, g above its reading at rest, that stops the trial. It reacts to readings: a peak that is over between
    /// two reads is recorded and not prevented.
    pub ceiling_g: i16,
    /// Temperature of any joint, °C, that stops it …
    pub stop_c: u8,
    /// … and below which all joints must be before the next trial starts.
    pub start_c: u8,
}

impl Default for Limits {
    /// The rated grip of a finger, and temperatures well below those at which the hand protects itself.
    fn default() -> Self {
        Self {
            ceiling_g: Force::RATED.get(),
            stop_c: 60,
            start_c: 50,
        }
    }
}

impl Default for TrialPlan {
    /// One gentle trial of the index finger, from open.
    fn default() -> Self {
        let index = |angle| PerDof::from_fn(|dof| (dof == Dof::Index).then_some(angle));
        Self {
            grid: TrialGrid {
                rest: Duration::from_secs(1),
                ..TrialGrid::once(TrialSetting {
                    speed: Speed::SLOWEST_MEASURED,
                    force: Force::GENTLE,
                })
            },
            dwell: Duration::from_secs(1),
            limits: Limits::default(),
            approach: Approach::OneStage,
            start: index(Angle::MAX),
            close: index(Angle::MIN),
            note: String::new(),
            tags: Vec::new(),
            others: toml::Table::new(),
        }
    }
}

impl Approach {
    /// Start of its slow stage; `None` with one stage.
    pub const fn until(self) -> Option<Until> {
        match self {
            Self::OneStage => None,
            Self::TwoStage { until, .. } => Some(until),
        }
    }
}

/// The keys of an approach in files: none for one stage.
#[derive(Debug, Default, Serialize, Deserialize)]
struct ApproachKeys {
    #[serde(skip_serializing_if = "Option::is_none")]
    fast_speed: Option<Speed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    until: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    until_value: Option<i64>,
}

impl From<Approach> for ApproachKeys {
    fn from(approach: Approach) -> Self {
        match approach {
            Approach::OneStage => Self::default(),
            Approach::TwoStage { fast, until } => Self {
                fast_speed: Some(fast),
                until: Some(until.name().into()),
                until_value: Some(until.value().into()),
            },
        }
    }
}

impl TryFrom<ApproachKeys> for Approach {
    type Error = UntilError;

    fn try_from(keys: ApproachKeys) -> Result<Self, UntilError> {
        match (keys.fast_speed, keys.until, keys.until_value) {
            (None, None, None) => Ok(Self::OneStage),
            (Some(fast), Some(name), Some(value)) => Ok(Self::TwoStage {
                fast,
                until: Until::new(&name, value)?,
            }),
            _ => Err(UntilError::Incomplete),
        }
    }
}

/// Reason why the end of a fast approach is invalid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UntilError {
    /// Only some of the three keys of an approach in two stages.
    #[error("an approach in two stages needs fast_speed, until and until_value")]
    Incomplete,
    /// An unknown name.
    #[error("'{0}' is not an end of an approach: choose angle, proximity, touch or measured")]
    Name(String),
    /// An angle or a force out of range.
    #[error(transparent)]
    Range(#[from] OutOfRange),
    /// A margin or counts that do not fit their type.
    #[error("{0} is too large")]
    TooLarge(i64),
}

impl Until {
    /// From its name in files and its number.
    ///
    /// # Errors
    /// [`UntilError`]: an unknown name, or a number out of range.
    pub fn new(name: &str, value: i64) -> Result<Self, UntilError> {
        let too_large = |_| UntilError::TooLarge(value);
        match name {
            "angle" => Ok(Self::Angle(Angle::new(value)?)),
            "measured" => i16::try_from(value)
                .map(|margin| Self::Measured { margin })
                .map_err(too_large),
            "proximity" => i32::try_from(value).map(Self::Proximity).map_err(too_large),
            "touch_g" => Ok(Self::Touch(Force::new(value)?)),
            _ => Err(UntilError::Name(name.into())),
        }
    }

    /// Stable name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Angle(_) => "angle",
            Self::Measured { .. } => "measured",
            Self::Proximity(_) => "proximity",
            Self::Touch(_) => "touch_g",
        }
    }

    /// Its number in files.
    pub fn value(self) -> i32 {
        match self {
            Self::Angle(angle) => angle.get().into(),
            Self::Measured { margin } => margin.into(),
            Self::Proximity(counts) => counts,
            Self::Touch(force) => force.get().into(),
        }
    }
}

/// Serializes a time as seconds.
mod seconds {
    use crate::trials::plan::WAIT_MAX;
    use serde::de::Error as _;
    use serde::{Deserialize as _, Deserializer, Serializer};
    use std::time::Duration;

    pub(super) fn serialize<S: Serializer>(time: &Duration, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_f64(time.as_secs_f64())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Duration, D::Error> {
        let seconds = f64::deserialize(from)?;
        let time = Duration::try_from_secs_f64(seconds).map_err(D::Error::custom)?;
        if time <= WAIT_MAX {
            Ok(time)
        } else {
            Err(D::Error::custom(format!("{seconds} s is too long")))
        }
    }
}

/// Serializes angles by joint name; a joint without an angle has no key.
mod by_joint {
    use crate::hand::{Angle, Dof, PerDof};
    use serde::{Deserialize as _, Deserializer, Serializer};
    use std::collections::BTreeMap;

    pub(super) fn serialize<S: Serializer>(
        angles: &PerDof<Option<Angle>>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        let known = angles.iter();
        to.collect_map(known.filter_map(|(dof, angle)| Some((dof, (*angle)?))))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<PerDof<Option<Angle>>, D::Error> {
        let named = BTreeMap::<Dof, Angle>::deserialize(from)?;
        Ok(PerDof::from_fn(|dof| named.get(&dof).copied()))
    }
}

/// The part of a plan that an error refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PlanField {
    /// The choice of joints.
    Joints,
    /// Start and target of a joint.
    Way(Dof),
    /// Speeds at the contact.
    Speeds,
    /// Force thresholds.
    Forces,
    /// Trials of each setting.
    Repeats,
    /// The dwell.
    Dwell,
    /// Time between trials.
    Rest,
    /// Speed of the first stage.
    Fast,
    /// End of the first stage.
    Until,
    /// The force ceiling.
    Ceiling,
    /// The temperature limits.
    Heat,
}

/// Reason why a plan cannot run.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// No joint closes.
    #[error("no joint takes part: name at least one")]
    NoJoint,
    /// A joint whose start is not far enough above its target.
    #[error(
        "{} would close from {start} to {close}: it needs a start at least {WAY_MIN} above its target, 1000 is open", dof.name()
    )]
    NoWay {
        /// The joint.
        dof: Dof,
        /// Start angle.
        start: i16,
        /// Target angle.
        close: i16,
    },
    /// A closing joint without a start.
    #[error("{} takes part and has no start", dof.name())]
    NoStart {
        /// The joint.
        dof: Dof,
    },
    /// The slow stage would start outside the way.
    #[error("the slow stage of {} would begin at {at}, outside its way from {start} to {close}", dof.name())]
    Stage {
        /// The joint.
        dof: Dof,
        /// Start of the slow stage.
        at: i16,
        /// Start angle.
        start: i16,
        /// Target angle.
        close: i16,
    },
    /// The first stage is slower than the second.
    #[error("the approach at {fast} is slower than the contact at {speed}")]
    SlowApproach {
        /// Speed of the first stage.
        fast: i16,
        /// Speed of the second stage.
        speed: i16,
    },
    /// The grid has no cell.
    #[error(
        "there is nothing to try: name a speed and a force threshold, and try them at least once"
    )]
    Empty,
    /// A number out of range.
    #[error("{what} of {got} is not between {least} and {most}")]
    Range {
        /// The field of the number.
        field: PlanField,
        /// Its name in the message.
        what: &'static str,
        /// The number given.
        got: f64,
        /// The smallest.
        least: f64,
        /// The largest.
        most: f64,
    },
    /// Temperatures in the wrong order.
    #[error("the temperatures {start} and {stop} must rise and stay at or below {TEMPERATURE_MAX}")]
    Temperature {
        /// Below which trials start.
        start: u8,
        /// At which they stop.
        stop: u8,
    },
}

impl PlanError {
    /// The part of the plan to change.
    pub const fn field(&self) -> PlanField {
        match self {
            Self::NoJoint => PlanField::Joints,
            Self::NoWay { dof, .. } | Self::NoStart { dof } => PlanField::Way(*dof),
            Self::Stage { .. } => PlanField::Until,
            Self::SlowApproach { .. } => PlanField::Fast,
            Self::Empty => PlanField::Speeds,
            Self::Range { field, .. } => *field,
            Self::Temperature { .. } => PlanField::Heat,
        }
    }
}

fn within(
    field: PlanField,
    what: &'static str,
    got: f64,
    range: RangeInclusive<f64>,
) -> Result<(), PlanError> {
    let (least, most) = range.into_inner();
    if (least..=most).contains(&got) {
        Ok(())
    } else {
        Err(PlanError::Range {
            field,
            what,
            got,
            least,
            most,
        })
    }
}

impl TrialPlan {
    /// Checks everything that does not depend on the hand.
    ///
    /// # Errors
    /// [`PlanError`]: the first error.
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
        let range = DWELL_MIN.as_secs_f64()..=WAIT_MAX.as_secs_f64();
        within(
            PlanField::Dwell,
            "a dwell in s",
            self.dwell.as_secs_f64(),
            range,
        )?;
        self.check_limits()
    }

    fn check_grid(&self) -> Result<(), PlanError> {
        let grid = &self.grid;
        if grid.speeds.is_empty() || grid.forces.is_empty() || grid.repeats == 0 {
            return Err(PlanError::Empty);
        }
        let cells = grid.speeds.len().saturating_mul(grid.forces.len());
        let trials = u32::try_from(cells.saturating_mul(grid.repeats)).unwrap_or(u32::MAX);
        let range = 1.0..=f64::from(TRIALS_MAX);
        within(
            PlanField::Repeats,
            "a number of trials",
            trials.into(),
            range,
        )?;
        for speed in &grid.speeds {
            let range = 1.0..=f64::from(Speed::MAX.get());
            within(PlanField::Speeds, "a speed", speed.get().into(), range)?;
        }
        let range = 0.0..=WAIT_MAX.as_secs_f64();
        within(
            PlanField::Rest,
            "a rest in s",
            grid.rest.as_secs_f64(),
            range,
        )
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
        let most = match until {
            Until::Angle(at) => return self.check_stage(at),
            Until::Measured { .. } => 500.0,
            Until::Proximity(_) => 16e6,
            Until::Touch(_) => f64::from(Force::MAX.get()),
        };
        let what = "an end of the approach";
        within(PlanField::Until, what, until.value().into(), 1.0..=most)
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
        let range = f64::from(least)..=4000.0;
        within(
            PlanField::Ceiling,
            "a force ceiling in g",
            got.into(),
            range,
        )?;
        if start >= stop || stop > TEMPERATURE_MAX {
            return Err(PlanError::Temperature { start, stop });
        }
        Ok(())
    }

    /// The joints that close, in register order.
    pub fn joints(&self) -> impl Iterator<Item = Dof> {
        self.ways().map(|(dof, ..)| dof)
    }

    /// The first joint that would have to move and is locked.
    pub fn locked(&self, locked: &PerDof<bool>) -> Option<Dof> {
        let moves = |dof: &Dof| self.close[*dof].is_some() || self.start[*dof].is_some();
        Dof::ALL.into_iter().find(|dof| moves(dof) && locked[*dof])
    }

    /// The largest expected overshoot on a rigid object, and its setting; `None` without joints or settings.
    pub fn expected(&self, map: &OvershootMap) -> Option<(TrialSetting, Expected)> {
        let stages = match self.approach {
            Approach::OneStage => Stages::One,
            Approach::TwoStage { .. } => Stages::Two,
        };
        let of = |setting: TrialSetting, dof| {
            let (speed, force) = (setting.speed.get().into(), setting.force.get().into());
            (setting, map.expected(dof, stages, speed, force))
        };
        let settings = self.grid.settings().into_iter();
        settings
            .flat_map(|setting| self.joints().map(move |dof| of(setting, dof)))
            .max_by(|(_, a), (_, b)| a.over_g.total_cmp(&b.over_g))
    }

    /// True if a first, slow trial must find the contact.
    pub const fn measures_contact(&self) -> bool {
        matches!(
            self.approach,
            Approach::TwoStage {
                until: Until::Measured { .. },
                ..
            }
        )
    }

    fn ways(&self) -> impl Iterator<Item = (Dof, Option<Angle>, Angle)> {
        Dof::ALL
            .into_iter()
            .filter_map(|dof| Some((dof, self.start[dof], self.close[dof]?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn index(speed: i16, force: i16) -> TrialPlan {
        let mut plan = TrialPlan {
            grid: TrialGrid::once(TrialSetting {
                speed: Speed::nearest(speed),
                force: Force::nearest(force),
            }),
            limits: Limits {
                ceiling_g: 4000,
                ..Limits::default()
            },
            ..TrialPlan::default()
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
        for (change, field, least, most) in [
            (
                (|p| p.grid.repeats = 1001) as fn(&mut TrialPlan),
                PlanField::Repeats,
                1.0,
                1000.0,
            ),
            (
                |p| p.grid.speeds.push(Speed::MIN),
                PlanField::Speeds,
                1.0,
                1000.0,
            ),
            (|p| p.dwell = Duration::ZERO, PlanField::Dwell, 0.3, 600.0),
            (
                |p| p.grid.rest = Duration::from_secs(601),
                PlanField::Rest,
                0.0,
                600.0,
            ),
            (
                |p| p.limits.ceiling_g = 499,
                PlanField::Ceiling,
                500.0,
                4000.0,
            ),
        ] {
            let error = wrong(change);
            let PlanError::Range {
                least: low,
                most: high,
                ..
            } = error
            else {
                unreachable!("{error}");
            };
            assert_eq!((error.field(), low, high), (field, least, most), "{error}");
        }
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
        let grid = TrialGrid {
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

    #[test]
    fn the_first_plan_of_all_can_be_run_and_is_gentle() {
        let plan = TrialPlan::default();
        assert_eq!(plan.check(), Ok(()));
        let expected = plan.expected(&OvershootMap::default());
        assert!(expected.is_some_and(|(_, expected)| expected.over_g < 100.0));
    }

    #[test]
    fn a_locked_joint_that_would_move_is_found() {
        let plan = TrialPlan::default();
        let only = |dof| PerDof::from_fn(|each| each == dof);
        assert_eq!(plan.locked(&only(Dof::Ring)), None);
        assert_eq!(plan.locked(&only(Dof::Index)), Some(Dof::Index));
    }
}
