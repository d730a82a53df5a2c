//! The columns of the table of trials, and how what stands in them is said and ordered. Draws nothing.

use crate::app::trial::{JointMetrics, Setting};
use crate::hand::Status;
use crate::ui::format;
use crate::ui::look::Look;
use crate::ui::text::{Text, tune, words};
use std::cmp::Ordering;

/// One column.
pub(crate) struct Column {
    /// Its head, with the unit.
    pub(crate) title: Text,
    /// Digits after the point.
    pub(crate) digits: usize,
    /// What stands in it.
    pub(crate) value: fn(&JointMetrics) -> Option<f64>,
}

const fn column(title: Text, digits: usize, value: fn(&JointMetrics) -> Option<f64>) -> Column {
    Column {
        title,
        digits,
        value,
    }
}

const MS_PER_S: f64 = 1000.0;

/// All with a number.
pub(crate) static COLUMNS: [Column; 10] = [
    column(tune::COLUMN_OVER, 0, |own| own.overshoot_g),
    column(tune::COLUMN_PEAK, 0, |own| own.peak_force_g),
    column(tune::COLUMN_STEADY, 0, |own| own.steady_force_g),
    column(tune::COLUMN_CONTACT, 2, |own| own.time_to_contact_s),
    column(tune::COLUMN_SETTLE, 2, |own| own.settle_time_s),
    column(tune::COLUMN_DEAD, 0, |own| {
        own.dead_time_s.map(|s| s * MS_PER_S)
    }),
    column(tune::COLUMN_RELAX, 0, |own| own.relaxation_g),
    column(tune::COLUMN_SLIPS, 0, |own| {
        own.slip_count
            .and_then(|count| u32::try_from(count).ok())
            .map(f64::from)
    }),
    column(tune::COLUMN_CURRENT, 0, |own| own.peak_current_ma),
    column(tune::COLUMN_HEAT, 0, |own| own.temperature_rise_c),
];

/// By number; what is not known goes last.
pub(crate) fn order(a: Option<f64>, b: Option<f64>, falling: bool) -> Ordering {
    match (a, b) {
        (Some(a), Some(b)) if falling => b.total_cmp(&a),
        (Some(a), Some(b)) => a.total_cmp(&b),
        (a, b) => b.is_some().cmp(&a.is_some()),
    }
}

/// What the drive said in the end, in words; a name that this program does not know stays as it is.
pub(crate) fn end_words(look: Look, name: Option<&str>) -> String {
    let Some(name) = name else {
        return format::UNKNOWN.to_owned();
    };
    let mut known = (0..=u8::MAX).map(Status::from_raw);
    known
        .find(|status| !matches!(status, Status::Unknown(_)) && status.name() == name)
        .map_or_else(
            || name.to_owned(),
            |status| words::status(status, look.language).title.to_owned(),
        )
}

/// Speed and threshold.
pub(crate) fn setting_words(setting: Setting) -> String {
    format!("{} / {} g", setting.speed.get(), setting.force.get())
}

/// A number, or "-".
pub(crate) fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(
        || "-".to_owned(),
        |value| format!("{:.digits$}", value + 0.0),
    )
}

/// Mean, and lowest to highest; of nothing nothing.
pub(crate) fn spread(values: &[f64], digits: usize) -> (String, String) {
    let count = u32::try_from(values.len()).unwrap_or(u32::MAX);
    let low = values.iter().copied().reduce(f64::min);
    let high = values.iter().copied().reduce(f64::max);
    let (Some(low), Some(high)) = (low, high) else {
        return ("-".into(), String::new());
    };
    let mean = values.iter().sum::<f64>() / f64::from(count);
    let range = format!("{low:.digits$}..{high:.digits$}");
    (number(Some(mean), digits), range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_the_mean_and_the_ends_and_of_nothing_nothing() {
        let said = |mean: &str, range: &str| (mean.to_owned(), range.to_owned());
        assert_eq!(spread(&[10.0, 40.0, 25.0], 0), said("25", "10..40"));
        assert_eq!(spread(&[0.125, 0.5], 2), said("0.31", "0.12..0.50"));
        assert_eq!(spread(&[], 2), said("-", ""));
    }
}
