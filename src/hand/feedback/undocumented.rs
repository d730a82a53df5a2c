//! Values outside the manual's ranges, as named in every file: `angle[4]`, or with the number that the hand sent, `angle[4]=1203`.

use crate::hand::dof::Dof;
use crate::hand::feedback::group::{Group, Groups};
use crate::hand::feedback::reading::AngleReading;
use crate::hand::feedback::sample::HandSample;
use std::fmt;

/// A joint's value outside the manual's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Undocumented {
    /// Group of the value.
    pub group: Group,
    /// Joint whose register held it.
    pub dof: Dof,
    /// Number that the hand sent; `None` for setpoints, which do not store it.
    pub raw: Option<i16>,
}

impl HandSample {
    /// Values of these groups that are outside the manual's ranges.
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

/// Distance outside the manual's range at which real hands have reported positions and currents.
const SLACK: i16 = 100;
/// Number that a hand sends for an unknown temperature or status.
const NOT_KNOWN: i16 = 255;

impl HandSample {
    /// True if one of these groups holds a value that no hand should send: further out of range than real hands have been seen to report,
    /// and not the code for "not known".
    pub fn is_implausible(&self, fresh: Groups) -> bool {
        self.undocumented(fresh).any(Undocumented::is_implausible)
    }
}

impl Undocumented {
    fn is_implausible(self) -> bool {
        let Some(raw) = self.raw else {
            return true;
        };
        match self.group {
            Group::Angle => AngleReading::new(raw).hold().is_none(),
            Group::Position => !(-SLACK..=2000 + SLACK).contains(&raw),
            Group::Current => !(-SLACK..=2000 + SLACK).contains(&raw),
            Group::Temperature | Group::Status => raw != NOT_KNOWN,
            _ => true,
        }
    }

    /// Name without the number that the hand sent.
    pub fn name(&self) -> String {
        format!("{}[{}]", self.group.name(), self.dof.index())
    }

    /// Parses the output of [`fmt::Display`].
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_real_hands_report_past_the_manual_is_not_implausible() {
        let implausible = |group, raw| {
            let dof = Dof::Index;
            Undocumented { group, dof, raw }.is_implausible()
        };
        for (group, raw) in [
            (Group::Position, -12),
            (Group::Angle, 1013),
            (Group::Angle, -7),
            (Group::Current, -3),
            (Group::Temperature, 255),
            (Group::Status, 255),
        ] {
            assert!(!implausible(group, Some(raw)), "{group:?} {raw}");
        }
        for (group, raw) in [
            (Group::Position, 2500),
            (Group::Angle, 2000),
            (Group::Force, 4001),
            (Group::Current, i16::MAX),
            (Group::Temperature, 128),
            (Group::Status, 8),
            (Group::Faults, 0x20),
        ] {
            assert!(implausible(group, Some(raw)), "{group:?} {raw}");
        }
        assert!(implausible(Group::SpeedSet, None));
    }
}
