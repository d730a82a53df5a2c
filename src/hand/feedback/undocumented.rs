//! Values outside the manual's ranges, as every file names them: `angle[4]`, or with what the hand sent `angle[4]=1203`.

use crate::hand::dof::Dof;
use crate::hand::feedback::sample::{Group, Groups, HandSample};
use std::fmt;

/// A value of a joint that is outside the manual's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Undocumented {
    /// What it is a value of.
    pub group: Group,
    /// Joint whose register held it.
    pub dof: Dof,
    /// What the hand sent; not kept of set points.
    pub raw: Option<i16>,
}

/// The groups that have a range, and their names in files.
const NAMES: [(Group, &str); 8] = [
    (Group::AngleSet, "angle_set"),
    (Group::ForceSet, "force_set"),
    (Group::SpeedSet, "speed_set"),
    (Group::Position, "position"),
    (Group::Angle, "angle"),
    (Group::Force, "force"),
    (Group::Current, "current"),
    (Group::Temperature, "temperature"),
];

impl HandSample {
    /// The values of these groups that are outside the manual's ranges.
    pub fn undocumented(&self, fresh: Groups) -> impl Iterator<Item = Undocumented> {
        let groups = NAMES.into_iter().map(|(group, _)| group);
        let sample = *self;
        groups
            .filter(move |group| fresh.contains(*group))
            .flat_map(move |group| {
                Dof::ALL.map(|dof| {
                    let raw = sample.out_of_range(group, dof)?;
                    Some(Undocumented { group, dof, raw })
                })
            })
            .flatten()
    }

    /// `None` if the value is in its range or was never read; what was sent, as far as it is kept.
    fn out_of_range(&self, group: Group, dof: Dof) -> Option<Option<i16>> {
        match group {
            Group::AngleSet => self.angle_set?.value[dof].is_none().then_some(None),
            Group::ForceSet => self.force_set?.value[dof].is_none().then_some(None),
            Group::SpeedSet => self.speed_set?.value[dof].is_none().then_some(None),
            Group::Position => {
                let value = self.position?.value[dof];
                value.documented().is_none().then(|| Some(value.raw()))
            }
            Group::Angle => {
                let value = self.angle?.value[dof];
                value.documented().is_none().then(|| Some(value.raw()))
            }
            Group::Force => {
                let value = self.force?.value[dof];
                value.documented().is_none().then(|| Some(value.raw()))
            }
            Group::Current => {
                let value = self.current?.value[dof];
                value.documented().is_none().then(|| Some(value.raw()))
            }
            Group::Temperature => {
                let value = self.temperature?.value[dof];
                let raw = || Some(i16::from(value.raw()));
                value.documented().is_none().then(raw)
            }
            Group::Faults | Group::Status | Group::Tactile(_) => None,
        }
    }
}

impl Undocumented {
    /// Its name without what was sent.
    pub fn name(&self) -> String {
        let named = NAMES.iter().find(|(group, _)| *group == self.group);
        let name = named.map_or("", |(_, name)| name);
        format!("{name}[{}]", self.dof.index())
    }

    /// Reads what [`fmt::Display`] writes.
    pub fn parse(text: &str) -> Option<Self> {
        let (name, raw) = match text.split_once('=') {
            Some((name, raw)) => (name, Some(raw.parse().ok()?)),
            None => (text, None),
        };
        let (name, place) = name.strip_suffix(']')?.split_once('[')?;
        let place: usize = place.parse().ok()?;
        Some(Self {
            group: NAMES.iter().find(|(_, known)| *known == name)?.0,
            dof: Dof::ALL.get(place).copied()?,
            raw,
        })
    }
}

impl fmt::Display for Undocumented {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.name())?;
        match self.raw {
            Some(raw) => write!(out, "={raw}"),
            None => Ok(()),
        }
    }
}
