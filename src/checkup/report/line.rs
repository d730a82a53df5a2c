//! The history of a figure: a small line on a page, and a sentence.

use crate::checkup::check::Check;
use crate::checkup::trend::day;

/// Size of the line, points.
const WIDTH: f64 = 96.0;
const HEIGHT: f64 = 20.0;
const MARGIN: f64 = 2.0;

/// Points of the trend line, `x,y x,y …`; `None` for fewer than two check-ups.
pub(super) fn line(check: &Check) -> Option<String> {
    let points = &check.trend.points;
    let (least, most) = check.trend.range().filter(|_| points.len() >= 2)?;
    let steps = u32::try_from(points.len() - 1).map_or(1.0, f64::from);
    // A constant value lies in the middle.
    let part = |value: f64| match most - least {
        0.0 => 0.5,
        height => (value - least) / height,
    };
    let mut x = MARGIN;
    let places = points.iter().map(|point| {
        let y = HEIGHT - MARGIN - part(point.value) * (HEIGHT - 2.0 * MARGIN);
        let place = format!("{x:.1},{y:.1}");
        x += (WIDTH - 2.0 * MARGIN) / steps;
        place
    });
    Some(places.collect::<Vec<_>>().join(" "))
}

/// Dates and values of a trend, one per line.
pub fn past_words(check: &Check) -> String {
    let row = check.measured.what.row();
    let points = check.trend.points.iter();
    let lines = points.map(|point| format!("{}: {}", day(&point.at), row.text(point.value)));
    lines.collect::<Vec<_>>().join("\n")
}

/// A sentence about the drift of a figure; `None` if it does not drift.
pub fn drift_words(check: &Check) -> Option<String> {
    let (row, drift) = (check.measured.what.row(), check.drift()?);
    Some(format!(
        "drifts from {} to {} over {} check-ups since {}",
        row.text(drift.from),
        row.text(drift.to),
        drift.checks,
        drift.since
    ))
}

/// The measured value with its unit, and the channels that it counts.
pub fn value_words(check: &Check) -> String {
    let value = check.measured.what.row().known(&check.measured.value);
    if check.measured.channels.is_empty() {
        value
    } else {
        format!("{value} ({})", check.measured.channels)
    }
}
