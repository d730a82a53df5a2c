//! The plan that is being written, kept from one start to the next as a table of its own. Opens no file; a plan that is
//! read back moves nothing before a person arms and starts it.

use crate::app::trial::plan::{TRIALS_MAX, WAIT_MAX};
use crate::app::tuner::draft::{Draft, LIST_MAX, Reach};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Duration;
use toml::{Table, Value};

/// Characters of the note and of all tags.
const WORDS_MAX: usize = 2000;

/// Why a table is not a plan of this version.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum KeptError {
    /// A key is missing, or holds another kind of value.
    #[error("{0}")]
    Form(String),
    /// No joint, or no approach, has this name.
    #[error("'{0}' is not known")]
    Name(String),
    /// A number or a list is out of its range.
    #[error("{0} is out of range")]
    Range(&'static str),
}

/// As it is written. What is missing is as in the first plan of all.
#[derive(Debug, Serialize, Deserialize)]
#[serde(default)]
struct Row {
    joints: Vec<String>,
    start: BTreeMap<String, i64>,
    close: BTreeMap<String, i64>,
    approach: String,
    fast_speed: i64,
    until_angle: i64,
    until_margin: i16,
    until_proximity: i32,
    until_touch_g: i64,
    speeds: Vec<i64>,
    forces_g: Vec<i64>,
    repeats: usize,
    dwell_s: f64,
    rest_s: f64,
    ceiling_g: i16,
    stop_c: u8,
    start_c: u8,
    note: String,
    tags: Vec<String>,
}

impl Default for Row {
    fn default() -> Self {
        Self::of(&Draft::default())
    }
}

const fn word(reach: Reach) -> &'static str {
    match reach {
        Reach::OneStage => "one_stage",
        Reach::Measured => "measured",
        Reach::Angle => "angle",
        Reach::Proximity => "proximity",
        Reach::Touch => "touch",
    }
}

impl Row {
    fn of(draft: &Draft) -> Self {
        let named = |dof: Dof, angle: Angle| (dof.name().to_owned(), i64::from(angle.get()));
        let start = draft.start.iter();
        let start = start.filter_map(|(dof, angle)| Some(named(dof, (*angle)?)));
        let close = draft.close.iter().map(|(dof, angle)| named(dof, *angle));
        let joints = Dof::ALL.into_iter().filter(|dof| draft.joints[*dof]);
        Self {
            joints: joints.map(|dof| dof.name().to_owned()).collect(),
            start: start.collect(),
            close: close.collect(),
            approach: word(draft.reach).into(),
            fast_speed: draft.fast.get().into(),
            until_angle: draft.until_angle.get().into(),
            until_margin: draft.until_margin,
            until_proximity: draft.until_proximity,
            until_touch_g: draft.until_touch.get().into(),
            speeds: draft.speeds.iter().map(|own| own.get().into()).collect(),
            forces_g: draft.forces.iter().map(|own| own.get().into()).collect(),
            repeats: draft.repeats,
            dwell_s: draft.dwell.as_secs_f64(),
            rest_s: draft.rest.as_secs_f64(),
            ceiling_g: draft.limits.ceiling_g,
            stop_c: draft.limits.stop_c,
            start_c: draft.limits.start_c,
            note: draft.note.clone(),
            tags: draft.tags.clone(),
        }
    }

    fn draft(self) -> Result<Draft, KeptError> {
        let mut draft = Draft {
            joints: PerDof::splat(false),
            start: PerDof::splat(None),
            fast: speed("fast_speed", self.fast_speed)?,
            until_angle: angle("until_angle", self.until_angle)?,
            until_margin: self.until_margin,
            until_proximity: self.until_proximity,
            until_touch: force("until_touch_g", self.until_touch_g)?,
            speeds: list("speeds", &self.speeds, speed)?,
            forces: list("forces_g", &self.forces_g, force)?,
            repeats: self.repeats,
            dwell: time("dwell_s", self.dwell_s)?,
            rest: time("rest_s", self.rest_s)?,
            ..Draft::default()
        };
        let known = Reach::ALL
            .into_iter()
            .find(|own| word(*own) == self.approach);
        draft.reach = known.ok_or_else(|| KeptError::Name(self.approach.clone()))?;
        for name in &self.joints {
            draft.joints[joint(name)?] = true;
        }
        for (name, at) in &self.start {
            draft.start[joint(name)?] = Some(angle("start", *at)?);
        }
        for (name, at) in &self.close {
            draft.close[joint(name)?] = angle("close", *at)?;
        }
        if !(1..=TRIALS_MAX).contains(&self.repeats) {
            return Err(KeptError::Range("repeats"));
        }
        let tags: usize = self.tags.iter().map(String::len).sum();
        if self.note.len() + tags > WORDS_MAX {
            return Err(KeptError::Range("note"));
        }
        draft.limits.ceiling_g = self.ceiling_g;
        draft.limits.stop_c = self.stop_c;
        draft.limits.start_c = self.start_c;
        (draft.note, draft.tags) = (self.note, self.tags);
        Ok(draft)
    }
}

fn joint(name: &str) -> Result<Dof, KeptError> {
    let known = Dof::ALL.into_iter().find(|dof| dof.name() == name);
    known.ok_or_else(|| KeptError::Name(name.into()))
}

fn angle(key: &'static str, value: i64) -> Result<Angle, KeptError> {
    Angle::new(value).map_err(|_outside| KeptError::Range(key))
}

fn speed(key: &'static str, value: i64) -> Result<Speed, KeptError> {
    Speed::new(value).map_err(|_outside| KeptError::Range(key))
}

fn force(key: &'static str, value: i64) -> Result<Force, KeptError> {
    Force::new(value).map_err(|_outside| KeptError::Range(key))
}

fn time(key: &'static str, seconds: f64) -> Result<Duration, KeptError> {
    let time = Duration::try_from_secs_f64(seconds).ok();
    let time = time.filter(|time| *time <= WAIT_MAX);
    time.ok_or(KeptError::Range(key))
}

fn list<T>(
    key: &'static str,
    values: &[i64],
    each: fn(&'static str, i64) -> Result<T, KeptError>,
) -> Result<Vec<T>, KeptError> {
    if !(1..=LIST_MAX).contains(&values.len()) {
        return Err(KeptError::Range(key));
    }
    values.iter().map(|value| each(key, *value)).collect()
}

/// The plan that was kept; the first of all if none was.
///
/// # Errors
/// [`KeptError`]: it is of another version, or spoilt.
pub fn draft(kept: Option<&Value>) -> Result<Draft, KeptError> {
    let Some(kept) = kept else {
        return Ok(Draft::default());
    };
    let row: Row = kept
        .clone()
        .try_into()
        .map_err(|error: toml::de::Error| KeptError::Form(error.message().into()))?;
    row.draft()
}

/// A plan as it is kept. Keys that this version does not know stay as they were in `before`.
#[must_use]
pub fn value(draft: &Draft, before: Option<&Value>) -> Option<Value> {
    let mut table = match before {
        Some(Value::Table(table)) => table.clone(),
        Some(_) | None => Table::new(),
    };
    let Ok(Value::Table(own)) = Value::try_from(Row::of(draft)) else {
        return before.cloned();
    };
    table.extend(own);
    Some(Value::Table(table))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::app::settings::Settings;
    use crate::app::trial::Limits;

    fn some() -> Draft {
        let mut draft = Draft {
            reach: Reach::Touch,
            fast: Speed::nearest(700),
            until_margin: 33,
            until_proximity: 12_345,
            until_touch: Force::nearest(45),
            until_angle: Angle::nearest(444),
            speeds: vec![Speed::nearest(25), Speed::nearest(50)],
            forces: vec![Force::nearest(300)],
            repeats: 4,
            dwell: Duration::from_millis(700),
            rest: Duration::from_millis(1500),
            limits: Limits {
                ceiling_g: 900,
                stop_c: 55,
                start_c: 44,
            },
            note: "鸡蛋 \"raw\"".into(),
            tags: vec!["egg".into(), "生".into()],
            ..Draft::default()
        };
        draft.joints[Dof::ThumbBend] = true;
        draft.start[Dof::Index] = None;
        draft.start[Dof::Ring] = Some(Angle::nearest(10));
        draft.close[Dof::Little] = Angle::nearest(77);
        draft
    }

    #[test]
    fn a_plan_comes_back_from_the_settings_file_as_it_was_written() {
        assert_eq!(draft(None), Ok(Draft::default()));
        for own in [Draft::default(), some()] {
            let settings = Settings {
                trial_plan: value(&own, None),
                ..Settings::default()
            };
            let text = toml::to_string_pretty(&settings).unwrap();
            let read: Settings = toml::from_str(&text).unwrap();
            assert_eq!(draft(read.trial_plan.as_ref()), Ok(own));
        }
    }

    #[test]
    fn keys_of_a_newer_plan_survive_and_missing_ones_are_as_in_the_first() {
        let newer: Value = "speeds = [50]\nwobble = 3\n[spring]\nstiff = true"
            .parse::<Table>()
            .unwrap()
            .into();
        let mut own = draft(Some(&newer)).unwrap();
        assert_eq!(own.speeds, [Speed::nearest(50)]);
        assert_eq!(own.forces, Draft::default().forces);
        own.repeats = 2;
        let kept = value(&own, Some(&newer)).unwrap();
        assert_eq!(kept.get("wobble").and_then(Value::as_integer), Some(3));
        assert!(kept.get("spring").is_some_and(Value::is_table));
        assert_eq!(draft(Some(&kept)), Ok(own));
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
            "start = { index = 1001 }",
            "stop_c = 300",
            "speeds = \"fast\"",
        ] {
            let table: Value = bad.parse::<Table>().unwrap().into();
            assert!(draft(Some(&table)).is_err(), "{bad}");
        }
        assert!(draft(Some(&Value::Integer(7))).is_err());
    }
}
