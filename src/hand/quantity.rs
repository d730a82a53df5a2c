//! The table of measured quantities: names, units, digits and scales for history, plots, tables and text.

use crate::hand::dof::PerDof;
use crate::hand::feedback::group::Group;
use crate::hand::feedback::reading::{
    AngleReading, CurrentReading, ForceReading, TemperatureReading,
};
use crate::hand::feedback::sample::HandSample;
use crate::hand::moment::Timed;

/// A quantity measured at each joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// ANGLE_ACT, 0..=1000.
    Angle,
    /// FORCE_ACT, g.
    Force,
    /// CURRENT, mA.
    Current,
    /// TEMP, °C.
    Temperature,
    /// ANGLE_SET as stored in the hand, 0..=1000; none for a joint that is left alone.
    TargetAngle,
}

/// A quantity measured at each fingertip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Touch {
    /// Normal force, N.
    Normal,
    /// Tangential force, N.
    Tangential,
}

/// One row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantityRow {
    /// Stable name in tables.
    pub name: &'static str,
    /// Stable name of the six values in the JSON of a sample; empty where a sample does not contain them in this form.
    pub json_name: &'static str,
    /// Unit in ASCII, for tables and text; empty if there is none.
    pub unit: &'static str,
    /// Digits after the decimal point when shown.
    pub decimals: usize,
    /// Smallest range of a plot's scale.
    pub least_scale: (f64, f64),
}

const ANGLE: QuantityRow = QuantityRow {
    name: "angle",
    json_name: "angle",
    unit: "",
    decimals: 0,
    least_scale: (0.0, 1000.0),
};
const FORCE: QuantityRow = QuantityRow {
    name: "force",
    json_name: "force_g",
    unit: "g",
    decimals: 0,
    least_scale: (0.0, 200.0),
};
const CURRENT: QuantityRow = QuantityRow {
    name: "current",
    json_name: "current_ma",
    unit: "mA",
    ..FORCE
};
const TEMPERATURE: QuantityRow = QuantityRow {
    name: "temperature",
    json_name: "temp_c",
    unit: "C",
    decimals: 0,
    least_scale: (20.0, 40.0),
};
const TARGET_ANGLE: QuantityRow = QuantityRow {
    name: "target_angle",
    json_name: "",
    ..ANGLE
};
const NORMAL: QuantityRow = QuantityRow {
    name: "normal",
    json_name: "",
    unit: "N",
    decimals: 2,
    least_scale: (0.0, 2.0),
};
const TANGENTIAL: QuantityRow = QuantityRow {
    name: "tangential",
    least_scale: (0.0, 1.0),
    ..NORMAL
};

impl Quantity {
    /// All quantities, in the order of the variants.
    pub const ALL: [Self; 5] = [
        Self::Angle,
        Self::Force,
        Self::Current,
        Self::Temperature,
        Self::TargetAngle,
    ];

    /// Quantities that the hand measures.
    pub const MEASURED: [Self; 4] = [Self::Angle, Self::Force, Self::Current, Self::Temperature];

    /// Row of this quantity in the table.
    pub const fn row(self) -> &'static QuantityRow {
        match self {
            Self::Angle => &ANGLE,
            Self::Force => &FORCE,
            Self::Current => &CURRENT,
            Self::Temperature => &TEMPERATURE,
            Self::TargetAngle => &TARGET_ANGLE,
        }
    }

    /// Group of a sample that holds it.
    pub const fn group(self) -> Group {
        match self {
            Self::Angle => Group::Angle,
            Self::Force => Group::Force,
            Self::Current => Group::Current,
            Self::Temperature => Group::Temperature,
            Self::TargetAngle => Group::AngleSet,
        }
    }

    /// Numbers of a sample within the manual's range; only these may feed logic.
    pub fn documented(self, sample: &HandSample) -> Option<Timed<PerDof<Option<i16>>>> {
        match self {
            Self::Angle => six(sample.angle, AngleReading::documented),
            Self::Force => six(sample.force, ForceReading::documented),
            Self::Current => six(sample.current, CurrentReading::documented),
            Self::Temperature => six(sample.temperature, |value| {
                TemperatureReading::documented(value).map(i16::from)
            }),
            Self::TargetAngle => six(sample.angle_set, |target| {
                target?.angle().map(|angle| angle.get())
            }),
        }
    }
}

fn six<T, U>(
    group: Option<Timed<PerDof<T>>>,
    value: impl FnMut(T) -> U,
) -> Option<Timed<PerDof<U>>> {
    group.map(|group| Timed {
        value: group.value.map(value),
        asked: group.asked,
        received: group.received,
    })
}

impl Touch {
    /// All quantities, in the order of the variants.
    pub const ALL: [Self; 2] = [Self::Normal, Self::Tangential];

    /// Row of this quantity in the table.
    pub const fn row(self) -> &'static QuantityRow {
        match self {
            Self::Normal => &NORMAL,
            Self::Tangential => &TANGENTIAL,
        }
    }
}
