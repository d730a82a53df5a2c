//! The plan of a series as a person writes it: everything that the form holds. Sends nothing.

use crate::app::trial::plan::MARGIN;
use crate::app::trial::{Approach, Grid, Limits, PlanError, Setting, TrialPlan, Until};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use std::time::Duration;

/// Numbers in one list.
pub const LIST_MAX: usize = 20;

/// How the object is reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reach {
    /// At the setting's speed all the way.
    OneStage,
    /// Fast to a distance before the contact that a first, slow trial measures.
    Measured,
    /// Fast to an angle.
    Angle,
    /// Fast until the fingertip feels it come near.
    Proximity,
    /// Fast until the fingertip or the force sensor feels it.
    Touch,
}

impl Reach {
    /// All, the plain one first.
    pub const ALL: [Self; 5] = [
        Self::OneStage,
        Self::Measured,
        Self::Angle,
        Self::Proximity,
        Self::Touch,
    ];
}

/// A place in the form, to show there what is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
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
    /// Time held.
    Dwell,
    /// Time between.
    Rest,
    /// Speed of the first stage.
    Fast,
    /// When the first stage ends.
    Until,
    /// The force that ends it.
    Ceiling,
    /// The temperatures.
    Heat,
}

impl Field {
    /// Where what is wrong with a plan stands.
    #[must_use]
    pub const fn of(error: &PlanError) -> Self {
        match error {
            PlanError::NoJoint => Self::Joints,
            PlanError::NoWay { dof, .. } | PlanError::NoStart { dof } => Self::Way(*dof),
            PlanError::Stage { .. } | PlanError::Until { .. } | PlanError::NoTouch => Self::Until,
            PlanError::SlowApproach { .. } => Self::Fast,
            PlanError::NoSpeed | PlanError::Empty => Self::Speeds,
            PlanError::TooMany { .. } => Self::Repeats,
            PlanError::Dwell { .. } => Self::Dwell,
            PlanError::Rest { .. } => Self::Rest,
            PlanError::Ceiling { .. } => Self::Ceiling,
            PlanError::Temperature { .. } => Self::Heat,
        }
    }
}

/// The form of a series.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    /// Which joints close.
    pub joints: PerDof<bool>,
    /// Where each stands before; `None` = where it is.
    pub start: PerDof<Option<Angle>>,
    /// Where those that take part close to.
    pub close: PerDof<Angle>,
    /// How the object is reached.
    pub reach: Reach,
    /// Speed of the first of two stages.
    pub fast: Speed,
    /// Where the first stage ends, by angle.
    pub until_angle: Angle,
    /// How far before the contact it ends, units of ANGLE_ACT.
    pub until_margin: i16,
    /// At what rise of proximity it ends, counts.
    pub until_proximity: i32,
    /// At what touch it ends, g.
    pub until_touch: Force,
    /// Speeds at the contact.
    pub speeds: Vec<Speed>,
    /// Force thresholds.
    pub forces: Vec<Force>,
    /// Trials of each setting.
    pub repeats: usize,
    /// Time held.
    pub dwell: Duration,
    /// Time between two trials.
    pub rest: Duration,
    /// What ends it.
    pub limits: Limits,
    /// In the words of a person.
    pub note: String,
    /// Words to find it by.
    pub tags: Vec<String>,
}

impl Default for Draft {
    /// One gentle trial of the index finger, from open.
    fn default() -> Self {
        Self {
            joints: PerDof::from_fn(|dof| dof == Dof::Index),
            start: PerDof::from_fn(|dof| (dof == Dof::Index).then_some(Angle::MAX)),
            close: PerDof::splat(Angle::MIN),
            reach: Reach::OneStage,
            fast: Speed::nearest(250),
            until_angle: Angle::nearest(600),
            until_margin: MARGIN,
            until_proximity: 8000,
            until_touch: Force::nearest(20),
            speeds: vec![Speed::SLOWEST_MEASURED],
            forces: vec![Force::GENTLE],
            repeats: 1,
            dwell: Duration::from_secs(1),
            rest: Duration::from_secs(1),
            limits: Limits::default(),
            note: String::new(),
            tags: Vec::new(),
        }
    }
}

impl Draft {
    /// What it means, unchecked.
    #[must_use]
    pub fn plan(&self) -> TrialPlan {
        TrialPlan {
            start: self.start,
            close: PerDof::from_fn(|dof| self.joints[dof].then_some(self.close[dof])),
            approach: self.approach(),
            dwell: self.dwell,
            grid: Grid {
                speeds: self.speeds.clone(),
                forces: self.forces.clone(),
                repeats: self.repeats,
                rest: self.rest,
            },
            limits: self.limits,
        }
    }

    fn approach(&self) -> Approach {
        let until = match self.reach {
            Reach::OneStage => return Approach::OneStage,
            Reach::Measured => Until::Measured {
                margin: self.until_margin,
            },
            Reach::Angle => Until::Angle(self.until_angle),
            Reach::Proximity => Until::Proximity(self.until_proximity),
            Reach::Touch => Until::Touch(self.until_touch),
        };
        let fast = self.fast;
        Approach::TwoStage { fast, until }
    }

    /// Lets a joint take part, from open if it has no start yet, or leaves it where it is.
    #[must_use]
    pub fn with_joint(mut self, dof: Dof, takes_part: Take) -> Self {
        self.joints[dof] = takes_part == Take::Part;
        self.start[dof] = match takes_part {
            Take::Part => self.start[dof].or(Some(Angle::MAX)),
            Take::NoPart => None,
        };
        self
    }

    /// The same with the angles of a pose at its start or its end. What the pose leaves alone stays as it is.
    #[must_use]
    pub fn with_pose(mut self, side: Side, angles: &PerDof<Option<Angle>>) -> Self {
        for (dof, angle) in angles.iter() {
            let Some(angle) = *angle else { continue };
            match side {
                Side::Start => self.start[dof] = Some(angle),
                Side::Close if self.joints[dof] => self.close[dof] = angle,
                Side::Close => {}
            }
        }
        self
    }

    /// The first joint that would have to move and is locked.
    #[must_use]
    pub fn locked(&self, locked: &PerDof<bool>) -> Option<Dof> {
        let moves = |dof: &Dof| self.joints[*dof] || self.start[*dof].is_some();
        Dof::ALL.into_iter().find(|dof| moves(dof) && locked[*dof])
    }

    /// What a person should expect at most above the threshold on a rigid object, g, and the setting it is of.
    #[must_use]
    pub fn expected(&self) -> Option<(Setting, f64)> {
        let peak = |setting: Setting| {
            let (speed, force) = (setting.speed.get().into(), setting.force.get().into());
            match self.reach {
                Reach::OneStage => crate::hand::impact::overshoot_g(speed, force),
                _ => crate::hand::impact::two_stage_overshoot_g(speed, force),
            }
        };
        let settings = self.plan().grid.settings().into_iter();
        settings
            .map(|setting| (setting, peak(setting)))
            .max_by(|(_, a), (_, b)| a.total_cmp(b))
    }
}

/// Whether a joint takes part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Take {
    /// It closes.
    Part,
    /// It stays.
    NoPart,
}

/// One end of the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// Before.
    Start,
    /// At the end.
    Close,
}

/// Why a list of numbers cannot be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ListError {
    /// Something in it is no whole number of the range.
    NotInRange {
        /// The largest.
        most: i16,
    },
    /// More than [`LIST_MAX`].
    TooLong,
    /// Nothing in it.
    Empty,
}

/// Whole numbers of 0 to `most`, separated by commas or spaces.
///
/// # Errors
/// [`ListError`]: nothing of it is taken.
pub fn list(text: &str, most: i16) -> Result<Vec<i16>, ListError> {
    let words = text.split([',', ' ', '，', '、', ';']).map(str::trim);
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    if words.is_empty() {
        return Err(ListError::Empty);
    }
    if words.len() > LIST_MAX {
        return Err(ListError::TooLong);
    }
    let number = |word: &&str| {
        let digits = word.bytes().all(|byte| byte.is_ascii_digit());
        let number = digits.then(|| word.parse::<i16>().ok()).flatten();
        number.filter(|number| *number <= most)
    };
    let numbers: Option<Vec<i16>> = words.iter().map(number).collect();
    let mut numbers = numbers.ok_or(ListError::NotInRange { most })?;
    numbers.sort_unstable();
    numbers.dedup();
    Ok(numbers)
}

/// Words between commas.
#[must_use]
pub fn tags(words: &str) -> Vec<String> {
    let words = words.split([',', '，']).map(str::trim);
    let words = words.filter(|word| !word.is_empty());
    words.map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_plan_of_all_can_be_run_and_is_gentle() {
        let draft = Draft::default();
        assert_eq!(draft.plan().check(), Ok(()));
        assert!(draft.expected().is_some_and(|(_, peak)| peak < 100.0));
    }

    #[test]
    fn lists_are_taken_whole_or_not_at_all() {
        assert_eq!(list("250, 25 25，100", 1000), Ok(vec![25, 100, 250]));
        let most = 1000;
        for bad in ["25, x", "1001", "-1", "2.5", "99999"] {
            assert_eq!(
                list(bad, most),
                Err(ListError::NotInRange { most }),
                "{bad}"
            );
        }
        assert_eq!(list(" , ", most), Err(ListError::Empty));
        let long = vec!["1"; LIST_MAX + 1].join(",");
        assert_eq!(list(&long, most), Err(ListError::TooLong));
    }

    #[test]
    fn every_mistake_has_its_place() {
        let wrong = |change: fn(&mut Draft)| {
            let mut draft = Draft::default();
            change(&mut draft);
            draft.plan().check().map_err(|error| Field::of(&error))
        };
        let dof = Dof::Index;
        for (change, field) in [
            (
                (|d| d.joints = PerDof::splat(false)) as fn(&mut Draft),
                Field::Joints,
            ),
            (|d| d.start[Dof::Index] = None, Field::Way(dof)),
            (|d| d.close[Dof::Index] = Angle::MAX, Field::Way(dof)),
            (|d| d.speeds = vec![Speed::MIN], Field::Speeds),
            (|d| d.repeats = 2000, Field::Repeats),
            (|d| d.dwell = Duration::ZERO, Field::Dwell),
            (|d| d.rest = Duration::from_secs(700), Field::Rest),
            (|d| d.limits.ceiling_g = 100, Field::Ceiling),
            (|d| d.limits.start_c = 70, Field::Heat),
            (
                |d| (d.reach, d.fast) = (Reach::Angle, Speed::nearest(5)),
                Field::Fast,
            ),
            (
                |d| (d.reach, d.until_angle) = (Reach::Angle, Angle::MAX),
                Field::Until,
            ),
        ] {
            assert_eq!(wrong(change), Err(field));
        }
    }

    #[test]
    fn a_pose_gives_starts_to_all_and_targets_to_those_that_close() {
        let mut angles = PerDof::splat(Some(Angle::nearest(400)));
        angles[Dof::Ring] = None;
        let draft = Draft::default().with_pose(Side::Start, &angles);
        let draft = draft.with_pose(Side::Close, &angles);
        assert_eq!(draft.start[Dof::ThumbRotate], Some(Angle::nearest(400)));
        assert_eq!(draft.start[Dof::Ring], None);
        assert_eq!(draft.close[Dof::Index], Angle::nearest(400));
        assert_eq!(draft.close[Dof::Little], Angle::MIN);
    }

    #[test]
    fn a_locked_joint_that_would_move_is_found() {
        let draft = Draft::default();
        let only = |dof| PerDof::from_fn(|each| each == dof);
        assert_eq!(draft.locked(&only(Dof::Ring)), None);
        assert_eq!(draft.locked(&only(Dof::Index)), Some(Dof::Index));
    }
}
