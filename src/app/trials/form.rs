//! Form for the plan of a series: approaches, targets and poses, typed lists. Sends nothing.

use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::plan::MARGIN;
use crate::trials::plan_settings::LIST_MAX;
use crate::trials::{Approach, TrialPlan, Until};

/// Available approaches, with typical ends of the fast stage.
pub fn approaches(fast: Speed) -> [Approach; 5] {
    let two = |until| Approach::TwoStage { fast, until };
    [
        Approach::OneStage,
        two(Until::Measured { margin: MARGIN }),
        two(Until::Angle(Angle::nearest(600))),
        two(Until::Proximity(8000)),
        two(Until::Touch(Force::nearest(20))),
    ]
}

/// Sets the closing target of a joint, starting from open if it has no start yet; `None` excludes the joint.
pub fn set_target(plan: &mut TrialPlan, dof: Dof, target: Option<Angle>) {
    plan.close[dof] = target;
    plan.start[dof] = target.and(plan.start[dof].or(Some(Angle::MAX)));
}

/// Copies the angles of a pose to the start or the end. Joints that the pose omits are unchanged; an end applies only to
/// joints that close.
pub fn copy_pose(plan: &mut TrialPlan, side: PlanSide, angles: &PerDof<Option<Angle>>) {
    for (dof, angle) in angles.iter() {
        let place = match side {
            PlanSide::Start => Some(&mut plan.start[dof]),
            PlanSide::Close => Some(&mut plan.close[dof]).filter(|target| target.is_some()),
        };
        if let (Some(place), Some(_)) = (place, angle) {
            *place = *angle;
        }
    }
}

/// Start or end of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PlanSide {
    Start,
    Close,
}

/// Reason why a list of numbers is rejected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ListError {
    /// An entry is not a whole number in range.
    NotInRange {
        /// Upper limit of the range.
        most: i16,
    },
    /// More than [`LIST_MAX`] entries.
    TooLong,
    /// No entries.
    Empty,
}

/// Parses whole numbers from 0 to `most`, separated by commas or spaces.
///
/// # Errors
/// [`ListError`] if the list is rejected as a whole.
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

/// Splits a text at commas into tags.
pub fn tags(words: &str) -> Vec<String> {
    let words = words.split([',', '，']).map(str::trim);
    let words = words.filter(|word| !word.is_empty());
    words.map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Speed;
    use crate::trials::plan::PlanField;
    use std::time::Duration;

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
        let wrong = |change: fn(&mut TrialPlan)| {
            let mut plan = TrialPlan::default();
            change(&mut plan);
            plan.check().map_err(|error| error.field())
        };
        let dof = Dof::Index;
        for (change, field) in [
            (
                (|own| own.close = PerDof::splat(None)) as fn(&mut TrialPlan),
                PlanField::Joints,
            ),
            (|own| own.start[Dof::Index] = None, PlanField::Way(dof)),
            (
                |own| own.close[Dof::Index] = Some(Angle::MAX),
                PlanField::Way(dof),
            ),
            (|own| own.grid.speeds = vec![Speed::MIN], PlanField::Speeds),
            (|own| own.grid.repeats = 2000, PlanField::Repeats),
            (|own| own.dwell = Duration::ZERO, PlanField::Dwell),
            (
                |own| own.grid.rest = Duration::from_secs(700),
                PlanField::Rest,
            ),
            (|own| own.limits.ceiling_g = 100, PlanField::Ceiling),
            (|own| own.limits.start_c = 70, PlanField::Heat),
            (
                |own| {
                    own.approach = Approach::TwoStage {
                        fast: Speed::nearest(5),
                        until: Until::Angle(Angle::nearest(600)),
                    };
                },
                PlanField::Fast,
            ),
            (
                |own| {
                    own.approach = Approach::TwoStage {
                        fast: Speed::nearest(250),
                        until: Until::Angle(Angle::MAX),
                    };
                },
                PlanField::Until,
            ),
        ] {
            assert_eq!(wrong(change), Err(field));
        }
    }

    #[test]
    fn a_pose_gives_starts_to_all_and_targets_to_those_that_close() {
        let mut angles = PerDof::splat(Some(Angle::nearest(400)));
        angles[Dof::Ring] = None;
        let mut plan = TrialPlan::default();
        copy_pose(&mut plan, PlanSide::Start, &angles);
        copy_pose(&mut plan, PlanSide::Close, &angles);
        assert_eq!(plan.start[Dof::ThumbRotate], Some(Angle::nearest(400)));
        assert_eq!(plan.start[Dof::Ring], None);
        assert_eq!(plan.close[Dof::Index], Some(Angle::nearest(400)));
        assert_eq!(plan.close[Dof::Little], None);
    }
}
