//! Columns of the trial table, with the text and order of their values. Draws nothing.

use crate::hand::Status;
use crate::trials::TrialSetting;
use crate::trials::columns::{COLUMNS, Metric, TrialColumn};
use crate::trials::measure::metrics::{DEAD_DRIVE, JointMetrics};
use crate::ui::kit::{Look, format};
use crate::ui::text::{Text, tune, words};
use std::cmp::Ordering;

/// Heading of a column with its unit; `None` if the window does not show it.
const fn title(metric: Metric) -> Option<Text> {
    match metric {
        Metric::Overshoot => Some(tune::COLUMN_OVER),
        Metric::Peak => Some(tune::COLUMN_PEAK),
        Metric::Steady => Some(tune::COLUMN_STEADY),
        Metric::Contact => Some(tune::COLUMN_CONTACT),
        Metric::Settle => Some(tune::COLUMN_SETTLE),
        Metric::DeadTime => Some(tune::COLUMN_DEAD),
        Metric::Relaxation => Some(tune::COLUMN_RELAX),
        Metric::Slips => Some(tune::COLUMN_SLIPS),
        Metric::Current => Some(tune::COLUMN_CURRENT),
        Metric::Heat => Some(tune::COLUMN_HEAT),
        Metric::Touch | Metric::Rate => None,
    }
}

/// Heading of the column with the same in newtons; `None` if there is none.
const fn newtons_title(metric: Metric) -> Option<Text> {
    match metric {
        Metric::Peak => Some(tune::COLUMN_PEAK_N),
        Metric::Steady => Some(tune::COLUMN_STEADY_N),
        _ => None,
    }
}

/// Unit of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum ColumnUnit {
    /// That of the quantity.
    #[default]
    Own,
    /// Newtons, of a force.
    Newtons,
}

/// A column shown in the window, with its heading.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShownColumn {
    pub(crate) column: &'static TrialColumn,
    pub(crate) unit: ColumnUnit,
    pub(crate) title: Text,
}

impl ShownColumn {
    /// The value of a joint with these newtons for a gram.
    pub(crate) fn value(&self, joint: &JointMetrics, per_g: Option<f64>) -> Option<f64> {
        match self.unit {
            ColumnUnit::Own => (self.column.value)(joint),
            ColumnUnit::Newtons => self.column.newtons(joint, per_g),
        }
    }

    /// The same as text.
    pub(crate) fn text(&self, joint: &JointMetrics, per_g: Option<f64>) -> String {
        match self.unit {
            ColumnUnit::Own => self.column.text(joint),
            ColumnUnit::Newtons => self.column.newtons_text(joint, per_g),
        }
    }
}

/// Columns shown in the window. Those in newtons are for hands that were measured on a scale.
pub(crate) fn shown() -> impl Iterator<Item = ShownColumn> {
    let titled = |column: &'static TrialColumn| {
        let units = [
            (ColumnUnit::Own, title(column.metric)),
            (ColumnUnit::Newtons, newtons_title(column.metric)),
        ];
        units.into_iter().filter_map(move |(unit, title)| {
            let title = title?;
            Some(ShownColumn {
                column,
                unit,
                title,
            })
        })
    };
    COLUMNS.iter().flat_map(titled)
}

/// Orders numbers; unknown values go last.
pub(crate) fn order(a: Option<f64>, b: Option<f64>, falling: bool) -> Ordering {
    match (a, b) {
        (Some(a), Some(b)) if falling => b.total_cmp(&a),
        (Some(a), Some(b)) => a.total_cmp(&b),
        (a, b) => b.is_some().cmp(&a.is_some()),
    }
}

/// Final state of the drive as text; an unknown name is returned unchanged.
pub(crate) fn end_words(look: Look, name: Option<&str>) -> String {
    let Some(name) = name else {
        return format::UNKNOWN.to_owned();
    };
    if name == DEAD_DRIVE {
        return look.tr(tune::END_DEAD_DRIVE).to_owned();
    }
    let mut known = (0..=u8::MAX).map(Status::from_raw);
    known
        .find(|status| !matches!(status, Status::Unknown(_)) && status.name() == name)
        .map_or_else(
            || name.to_owned(),
            |status| words::status(status, look.language).title.to_owned(),
        )
}

/// Speed and threshold.
pub(crate) fn setting_words(setting: TrialSetting) -> String {
    format!("{} / {} g", setting.speed.get(), setting.force.get())
}
