//! The subjects of a check-up: good ranges, and advice for a value outside them. The ranges cover both hands of the family that were
//! measured in public, and the figures of the manual.

use crate::hand::{Dof, Finger};
use serde::{Deserialize, Serialize};

#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, strum::EnumIter,
)]
#[serde(rename_all = "snake_case")]
pub enum Subject {
    OpenEnd,
    BentEnd,
    Backlash,
    ClosingCurrent,
    OpeningCurrent,
    CurrentPerSpeed,
    ClosingSpeed,
    OpeningSpeed,
    DeadTime,
    DeadTimeScatter,
    OthersMoved,
    ForceZero,
    ForceNoise,
    ForceDrift,
    WarmerThanOthers,
    WarmedBy,
    DeadChannels,
    NoisyChannels,
    ChannelDrift,
    SilentChannels,
    SlowerTogether,
}

/// The part of the hand that a figure describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HandPart {
    Joint(Dof),
    Fingertip(Finger),
    Hand,
}

/// Grade of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Grade {
    /// Within the good range.
    Fine,
    /// Not measured.
    Unknown,
    /// Outside the range of good hands, or changed since the first check-up: check again soon.
    Watch,
    /// Far outside the range: needs action before further use.
    Act,
}

/// One subject: name, unit, ranges and advice.
#[derive(Debug, Clone, Copy)]
pub struct SubjectRow {
    pub name: &'static str,
    pub unit: &'static str,
    pub decimals: usize,
    /// Range of good hands.
    pub good: [f64; 2],
    /// Values outside this range need action.
    pub bearable: [f64; 2],
    /// Largest change since the first check-up of a hand.
    pub change: f64,
    pub advice: &'static str,
}

impl Subject {
    /// Grades a value by the ranges, and by its change since the first check-up of this hand.
    pub fn grade(self, value: Option<f64>, first: Option<f64>) -> Grade {
        let row = self.row();
        let Some(value) = value else {
            return Grade::Unknown;
        };
        let within = |[least, most]: [f64; 2]| (least..=most).contains(&value);
        if !within(row.bearable) {
            Grade::Act
        } else if !within(row.good) || first.is_some_and(|was| (value - was).abs() > row.change) {
            Grade::Watch
        } else {
            Grade::Fine
        }
    }

    /// The name, unit, ranges and advice of this subject.
    pub const fn row(self) -> SubjectRow {
        const CLEAN: &str = "look for something in the joint's way, clean it, and check again; if it persists, have the drive inspected";
        const DRIVE: &str = "have the drive inspected";
        const LINKAGE: &str =
            "inspect the linkage of the finger: worn pins and loose screws do this";
        const SUPPLY: &str =
            "check the 24 V supply, its cable and its plug: the hand draws up to 2 A";
        const ZERO: &str = "calibrate the force sensors with an empty hand (Hand > Device)";
        const NOISE: &str = "check the hand's ground and shield, and look for a motor nearby";
        const DRIFT: &str = "let the hand warm up, calibrate the force sensors, and check again";
        const WARM: &str =
            "let the hand cool, and check again; if it persists, have the drive inspected";
        const TIP: &str =
            "clean the fingertip, check its cable, and have it replaced if this persists";
        match self {
            Self::OpenEnd => row("angle at the open end", CLEAN)
                .good(985.0, 1000.0)
                .bearable(950.0, 1000.0),
            Self::BentEnd => row("angle at the bent end", CLEAN)
                .good(0.0, 15.0)
                .bearable(0.0, 50.0),
            Self::Backlash => row("backlash", LINKAGE)
                .good(-8.0, 14.0)
                .bearable(-30.0, 40.0)
                .change(8.0)
                .unit("counts", 0),
            Self::ClosingCurrent => current("current that closing takes", CLEAN),
            Self::OpeningCurrent => current("current that opening takes", CLEAN),
            Self::CurrentPerSpeed => row("more current for each unit of speed", CLEAN)
                .good(-0.1, 0.2)
                .bearable(-0.5, 0.6)
                .change(0.1)
                .unit("mA", 2),
            Self::ClosingSpeed => speed("closing speed for each unit of SPEED_SET", SUPPLY),
            Self::OpeningSpeed => speed("opening speed for each unit of SPEED_SET", SUPPLY),
            Self::DeadTime => row("time from command to motion", DRIVE)
                .good(0.0, 90.0)
                .bearable(0.0, 160.0)
                .change(25.0)
                .unit("ms", 0),
            Self::DeadTimeScatter => row("scatter of that time", DRIVE)
                .good(0.0, 15.0)
                .bearable(0.0, 60.0)
                .change(15.0)
                .unit("ms", 0),
            Self::OthersMoved => row("how far other joints moved meanwhile", LINKAGE)
                .good(0.0, 12.0)
                .bearable(0.0, 40.0),
            Self::ForceZero => row("force at rest", ZERO)
                .good(-260.0, 260.0)
                .bearable(-500.0, 500.0)
                .change(60.0)
                .unit("g", 0),
            Self::ForceNoise => row("noise of the force", NOISE)
                .good(0.0, 8.0)
                .bearable(0.0, 40.0)
                .change(6.0)
                .unit("g", 1),
            Self::ForceDrift => row("drift of the force at rest", DRIFT)
                .good(-20.0, 20.0)
                .bearable(-80.0, 80.0)
                .unit("g", 0),
            Self::WarmerThanOthers => row("warmer than the other drives", WARM)
                .good(-12.0, 12.0)
                .bearable(-40.0, 28.0)
                .unit("°C", 0),
            Self::WarmedBy => row("warmed during the check-up", CLEAN)
                .good(-5.0, 2.0)
                .bearable(-20.0, 12.0)
                .unit("°C", 0),
            Self::DeadChannels => row("channels that never change", TIP)
                .good(0.0, 0.0)
                .bearable(0.0, 0.0),
            Self::NoisyChannels => row("channels that scatter at rest", TIP)
                .good(0.0, 0.0)
                .bearable(0.0, 7.0),
            Self::SilentChannels => row("channels that do not answer a press", TIP)
                .good(0.0, 0.0)
                .bearable(0.0, 0.0),
            Self::ChannelDrift => row("drift of the channels", TIP)
                .good(0.0, 1000.0)
                .bearable(0.0, 20_000.0)
                .unit("counts/s", 0),
            Self::SlowerTogether => row("slower when all six move", SUPPLY)
                .good(-5.0, 26.0)
                .bearable(-20.0, 45.0)
                .change(10.0)
                .unit("%", 0),
        }
    }
}

/// A row without unit and ranges.
const fn row(name: &'static str, advice: &'static str) -> SubjectRow {
    SubjectRow {
        name,
        unit: "",
        decimals: 0,
        good: [f64::NEG_INFINITY, f64::INFINITY],
        bearable: [f64::NEG_INFINITY, f64::INFINITY],
        change: f64::INFINITY,
        advice,
    }
}

const fn current(name: &'static str, advice: &'static str) -> SubjectRow {
    row(name, advice)
        .good(0.0, 260.0)
        .bearable(0.0, 450.0)
        .change(60.0)
        .unit("mA", 0)
}

/// Measured on both published hands and printed in the manual: 3.04 to 3.33.
const fn speed(name: &'static str, advice: &'static str) -> SubjectRow {
    row(name, advice)
        .good(2.7, 3.7)
        .bearable(2.0, 5.0)
        .change(0.3)
        .unit("counts/s", 2)
}

impl SubjectRow {
    const fn good(self, least: f64, most: f64) -> Self {
        let good = [least, most];
        Self { good, ..self }
    }

    const fn bearable(self, least: f64, most: f64) -> Self {
        let bearable = [least, most];
        Self { bearable, ..self }
    }

    const fn change(self, change: f64) -> Self {
        Self { change, ..self }
    }

    const fn unit(self, unit: &'static str, decimals: usize) -> Self {
        Self {
            unit,
            decimals,
            ..self
        }
    }

    /// A value with its unit.
    pub fn text(&self, value: f64) -> String {
        let decimals = self.decimals;
        format!("{value:.decimals$} {}", self.unit)
            .trim_end()
            .to_owned()
    }

    /// As [`Self::text`]; a dash for an unknown value.
    pub fn known(&self, value: &Option<f64>) -> String {
        value.map_or_else(|| "-".to_owned(), |value| self.text(value))
    }

    /// The good range, without the unit.
    pub fn range(&self) -> String {
        let ([least, most], decimals) = (self.good, self.decimals);
        format!("{least:.decimals$} to {most:.decimals$}")
    }
}

impl HandPart {
    /// The joint; `None` for a fingertip and the hand.
    pub const fn joint(self) -> Option<Dof> {
        match self {
            Self::Joint(dof) => Some(dof),
            Self::Fingertip(_) | Self::Hand => None,
        }
    }

    pub const fn name(self) -> &'static str {
        match self {
            Self::Joint(dof) => dof.name(),
            Self::Fingertip(finger) => finger.name(),
            Self::Hand => "hand",
        }
    }
}

impl Grade {
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fine => "fine",
            Self::Unknown => "unknown",
            Self::Watch => "watch",
            Self::Act => "act",
        }
    }
}
