//! Values outside the manual's ranges, as every file names them: `angle[4]`, or with what the hand sent `angle[4]=1203`.

use crate::hand::dof::Dof;
use crate::hand::feedback::group::{Group, Groups};
use crate::hand::feedback::sample::HandSample;
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

impl HandSample {
    /// The values of these groups that are outside the manual's ranges.
    pub fn undocumented(&self, fresh: Groups) -> impl Iterator<Item = Undocumented> {
        let sample = *self;
        let groups = Group::ALL.into_iter();
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
}

impl Undocumented {
    /// Its name without what was sent.
    pub fn name(&self) -> String {
        format!("{}[{}]", self.group.name(), self.dof.index())
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
            group: Group::ALL.into_iter().find(|group| group.name() == name)?,
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
