//! A figure over the last check-ups as a small line of a page, and in a sentence.

use crate::checkup::check::Check;
use crate::checkup::trend::day;

/// Size of the line, points.
const WIDTH: f64 = 96.0;
const HEIGHT: f64 = 20.0;
const MARGIN: f64 = 2.0;

/// Where the line of a trend goes, `x,y x,y …`; `None` for fewer than two points.
pub(super) fn line(check: &Check) -> Option<String> {
    let points = &check.trend.points;
    let (least, most) = check.trend.range().filter(|_| points.len() >= 2)?;
    let steps = u32::try_from(points.len() - 1).map_or(1.0, f64::from);
    // What does not change lies in the middle.
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

/// The days and values of a trend, a line each.
pub fn past_words(check: &Check) -> String {
    let row = check.measured.what.row();
    let points = check.trend.points.iter();
    let lines = points.map(|point| format!("{}: {}", day(&point.at), row.text(point.value)));
    lines.collect::<Vec<_>>().join("\n")
}

/// That a figure goes one way, if it does.
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

/// What a figure was measured to be, with the channels that it counts.
pub fn value_words(check: &Check) -> String {
    let value = check.measured.what.row().known(&check.measured.value);
    if check.measured.channels.is_empty() {
        value
    } else {
        format!("{value} ({})", check.measured.channels)
    }
}
