//! The plan in the user's editor as a table of the settings, restored at the next start of the program.
//! Opens no file; a restored plan moves nothing before the user arms and starts it.

use crate::trials::plan::{TRIALS_MAX, TrialPlan};
use toml::{Table, Value};

/// Maximum number of speeds or thresholds in a list.
pub const LIST_MAX: usize = 20;
/// Maximum length of the note and all tags together, bytes.
const WORDS_MAX: usize = 2000;

/// Reason why a table is not a plan of this version.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanReadError {
    /// A key is missing or has an invalid value.
    #[error("{}", .0.message())]
    Form(#[from] toml::de::Error),
    /// A list or a text is too long or empty, or the number of repeats is out of range.
    #[error("{0} is out of range")]
    Range(&'static str),
}

/// The plan in the settings; the default plan if there is none. Missing keys take the values of the default plan.
///
/// # Errors
/// [`PlanReadError`]: a plan of another version, or an invalid one.
pub fn from_settings(stored: Option<&Value>) -> Result<TrialPlan, PlanReadError> {
    let Some(stored) = stored else {
        return Ok(TrialPlan::default());
    };
    let mut table: Table = stored.clone().try_into()?;
    if table.contains_key("approach") || table.contains_key("joints") {
        table = from_first_form(table);
    }
    let mut all: Table = to_settings(&TrialPlan::default())
        .and_then(|first| first.try_into().ok())
        .unwrap_or_default();
    all.extend(table);
    let plan: TrialPlan = all.try_into()?;
    let is_list = |len: usize| (1..=LIST_MAX).contains(&len);
    let words = plan.note.len() + plan.tags.iter().map(String::len).sum::<usize>();
    for (key, fits) in [
        ("speeds", is_list(plan.grid.speeds.len())),
        ("forces_g", is_list(plan.grid.forces.len())),
        (
            "repeats",
            (1..=TRIALS_MAX.into()).contains(&plan.grid.repeats),
        ),
        ("note", words <= WORDS_MAX),
    ] {
        if !fits {
            return Err(PlanReadError::Range(key));
        }
    }
    Ok(plan)
}

/// The plan as a table of the settings; `None` if it cannot be serialized.
pub fn to_settings(plan: &TrialPlan) -> Option<Value> {
    Value::try_from(plan).ok()
}

/// Converts the form of the first versions: targets of all joints beside the list of closing joints, and one number per
/// kind of approach.
fn from_first_form(mut table: Table) -> Table {
    let index = || Value::Array(vec!["index".into()]);
    let close = match table.remove("joints").unwrap_or_else(index) {
        Value::Array(joints) => Value::Table(targets_of(&joints, table.remove("close"))),
        no_list => no_list,
    };
    table.insert("close".into(), close);
    let numbers = [
        ("angle", "angle", table.remove("until_angle")),
        ("measured", "measured", table.remove("until_margin")),
        ("proximity", "proximity", table.remove("until_proximity")),
        ("touch", "touch_g", table.remove("until_touch_g")),
    ];
    let approach = table.remove("approach");
    let approach = approach.unwrap_or_else(|| "one_stage".into());
    if approach.as_str() == Some("one_stage") {
        table.remove("fast_speed");
        return table;
    }
    let chosen = numbers
        .into_iter()
        .find(|(old, ..)| approach.as_str() == Some(*old));
    let (name, value) = chosen.map_or((approach, None), |(_, name, value)| (name.into(), value));
    table.insert("until".into(), name);
    table.extend(value.map(|value| ("until_value".to_owned(), value)));
    table
}

/// The targets of the closing joints.
fn targets_of(joints: &[Value], all: Option<Value>) -> Table {
    let all = all.as_ref();
    let target = |joint: &Value| {
        let name = joint.as_str().unwrap_or_default();
        let angle = all.and_then(|all| all.get(name));
        let angle = angle.cloned().unwrap_or(Value::Integer(0));
        (name.to_owned(), angle)
    };
    joints.iter().map(target).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Angle, Dof, Force, PerDof, Speed};
    use crate::trials::plan::{Approach, Limits, TrialGrid, Until};
    use std::time::Duration;

    fn written() -> TrialPlan {
        let mut plan = TrialPlan {
            approach: Approach::TwoStage {
                fast: Speed::nearest(700),
                until: Until::Touch(Force::nearest(45)),
            },
            grid: TrialGrid {
                speeds: vec![Speed::nearest(25), Speed::nearest(50)],
                forces: vec![Force::nearest(300)],
                repeats: 4,
                rest: Duration::from_millis(1500),
            },
            dwell: Duration::from_millis(700),
            limits: Limits {
                ceiling_g: 900,
                stop_c: 55,
                start_c: 44,
            },
            note: "鸡蛋 \"raw\"".into(),
            tags: vec!["egg".into(), "生".into()],
            ..TrialPlan::default()
        };
        plan.start = PerDof::splat(None);
        plan.start[Dof::Ring] = Some(Angle::nearest(10));
        plan.close[Dof::ThumbBend] = Some(Angle::MIN);
        plan
    }

    fn table(text: &str) -> Value {
        text.parse::<Table>().unwrap().into()
    }

    #[test]
    fn a_plan_comes_back_from_the_settings_as_it_was_written() {
        assert_eq!(from_settings(None), Ok(TrialPlan::default()));
        let untils = [
            Until::Touch(Force::nearest(45)),
            Until::Angle(Angle::nearest(444)),
            Until::Proximity(12_345),
            Until::Measured { margin: 33 },
        ];
        let fast = Speed::nearest(700);
        let plans = untils.map(|until| TrialPlan {
            approach: Approach::TwoStage { fast, until },
            ..written()
        });
        for plan in plans.into_iter().chain([TrialPlan::default()]) {
            let text = toml::to_string_pretty(&to_settings(&plan).unwrap()).unwrap();
            assert_eq!(from_settings(Some(&table(&text))), Ok(plan));
        }
    }

    #[test]
    fn the_first_form_of_the_settings_is_still_read() {
        let old = table(
            "joints = [\"index\", \"thumb_bend\"]\napproach = \"touch\"\nfast_speed = 700\nuntil_angle = 444\n\
             until_margin = 33\nuntil_proximity = 12345\nuntil_touch_g = 45\nspeeds = [25, 50]\nforces_g = [300]\n\
             repeats = 4\ndwell_s = 0.7\nrest_s = 1.5\nceiling_g = 900\nstop_c = 55\nstart_c = 44\n\
             note = \"鸡蛋 \\\"raw\\\"\"\ntags = [\"egg\", \"生\"]\n[start]\nring = 10\n\
             [close]\nindex = 0\nlittle = 77\nmiddle = 0\nring = 0\nthumb_bend = 0\nthumb_rotate = 0\n",
        );
        assert_eq!(from_settings(Some(&old)), Ok(written()));
        let mut one_stage = old.as_table().unwrap().clone();
        one_stage.insert("approach".into(), "one_stage".into());
        let read = from_settings(Some(&one_stage.into())).unwrap();
        assert_eq!(read.approach, Approach::OneStage);
        assert!(read.others.is_empty(), "{:?}", read.others);
    }

    #[test]
    fn keys_of_a_newer_plan_survive_and_missing_ones_are_as_in_the_first() {
        let newer = table("speeds = [50]\nwobble = 3\n[spring]\nstiff = true");
        let mut plan = from_settings(Some(&newer)).unwrap();
        assert_eq!(plan.grid.speeds, [Speed::nearest(50)]);
        assert_eq!(plan.grid.forces, TrialPlan::default().grid.forces);
        plan.grid.repeats = 2;
        let stored = to_settings(&plan).unwrap();
        assert_eq!(stored.get("wobble").and_then(Value::as_integer), Some(3));
        assert!(stored.get("spring").is_some_and(Value::is_table));
        assert_eq!(from_settings(Some(&stored)), Ok(plan));
        let unreadable = table("until = \"by_ear\"\nstop_c = 300\nwobble = 3");
        assert!(from_settings(Some(&unreadable)).is_err());
    }

    #[test]
    fn what_makes_no_sense_is_refused_whole() {
        for bad in [
            "speeds = []",
            "speeds = [1001]",
            "forces_g = [-1]",
            "repeats = 0",
            "repeats = 1001",
            "dwell_s = nan",
            "dwell_s = -1.0",
            "rest_s = 1e30",
            "approach = \"by_ear\"",
            "joints = [\"wrist\"]",
            "joints = 3",
            "start = { index = 1001 }",
            "stop_c = 300",
            "speeds = \"fast\"",
            "fast_speed = 50",
            "fast_speed = 50\nuntil = \"by_ear\"\nuntil_value = 1",
        ] {
            assert!(from_settings(Some(&table(bad))).is_err(), "{bad}");
        }
        assert!(from_settings(Some(&Value::Integer(7))).is_err());
    }
}
