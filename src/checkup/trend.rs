//! The history of a figure over the most recent check-ups.

/// Check-ups in a trend, including the current one.
pub const TREND_MAX: usize = 12;
/// Fewer points form no trend.
const POINTS_MIN: usize = 5;
/// Share of the variance that a straight line must explain; otherwise the figures scatter.
const EXPLAINED: f64 = 0.8;
/// A figure drifts if it moved by this share of the watched change.
const PART_OF_CHANGE: f64 = 0.5;

#[derive(Debug, Clone, PartialEq)]
pub struct TrendPoint {
    /// Time of the check-up, UTC.
    pub at: String,
    pub value: f64,
}

/// The values of a figure, oldest first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trend {
    pub points: Vec<TrendPoint>,
}

/// A steady change of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// Ends of the fitted line.
    pub from: f64,
    pub to: f64,
    /// Check-ups in which it shows.
    pub checks: usize,
    /// Date of the first of them.
    pub since: String,
}

impl Trend {
    /// From the figures of all check-ups, oldest first; only the last [`TREND_MAX`] count.
    pub fn of(points: impl IntoIterator<Item = TrendPoint>) -> Self {
        let mut points: Vec<TrendPoint> = points.into_iter().collect();
        points.drain(..points.len().saturating_sub(TREND_MAX));
        Self { points }
    }

    /// Smallest and largest value; `None` without points.
    pub fn range(&self) -> Option<(f64, f64)> {
        let mut values = self.points.iter().map(|point| point.value);
        let first = values.next()?;
        Some(values.fold((first, first), |(least, most), value| {
            (least.min(value), most.max(value))
        }))
    }

    /// The drift, if the figures follow a line and moved by enough of `change`, the watched change since the first check-up.
    pub fn drift(&self, change: f64) -> Option<Drift> {
        let count = self.points.len();
        if count < POINTS_MIN || !change.is_finite() {
            return None;
        }
        let number = |nth: usize| u32::try_from(nth).map_or(f64::NAN, f64::from);
        let middle = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / number(count);
        let x = middle(&mut (0..count).map(number));
        let y = middle(&mut self.points.iter().map(|point| point.value));
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for (nth, point) in self.points.iter().enumerate() {
            let (dx, dy) = (number(nth) - x, point.value - y);
            xx += dx * dx;
            xy += dx * dy;
            yy += dy * dy;
        }
        let slope = xy / xx;
        let is_line = xy * xy >= EXPLAINED * xx * yy && yy > 0.0;
        let went = slope * number(count - 1);
        let first = self.points.first()?;
        (is_line && went.abs() >= PART_OF_CHANGE * change).then(|| Drift {
            from: y - went / 2.0,
            to: y + went / 2.0,
            checks: count,
            since: day(&first.at).to_owned(),
        })
    }
}

/// The date part of a stored time.
pub fn day(at: &str) -> &str {
    at.split_once('T').map_or(at, |(day, _)| day)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trend(values: &[f64]) -> Trend {
        let point = |(nth, value): (usize, &f64)| TrendPoint {
            at: format!("2026-11-{:02}T10:00:00Z", nth + 1),
            value: *value,
        };
        Trend::of(values.iter().enumerate().map(point))
    }

    #[test]
    fn what_goes_one_way_drifts_and_what_scatters_or_is_too_little_or_too_short_does_not() {
        let drift = trend(&[4.0, 5.0, 6.0, 7.5, 8.0, 9.0]).drift(8.0);
        let Some(drift) = drift else {
            panic!("it drifts")
        };
        assert!((drift.from - 4.0).abs() < 0.3 && (drift.to - 9.1).abs() < 0.3);
        assert_eq!((drift.checks, drift.since.as_str()), (6, "2026-11-01"));
        for still in [
            &[4.0, 9.0, 4.0, 9.0, 4.0, 9.0][..],
            &[4.0, 4.1, 4.2, 4.3, 4.4, 4.5],
            &[4.0, 6.0, 8.0, 10.0],
            &[4.0, 4.0, 4.0, 4.0, 4.0],
        ] {
            assert_eq!(trend(still).drift(8.0), None, "{still:?}");
        }
        assert_eq!(trend(&[1.0, 2.0, 3.0, 4.0, 5.0]).drift(f64::INFINITY), None);
    }

    #[test]
    fn only_the_last_count() {
        let values: Vec<f64> = (0..20_u32).map(f64::from).collect();
        let trend = trend(&values);
        assert_eq!(trend.points.len(), TREND_MAX);
        assert_eq!(trend.range(), Some((8.0, 19.0)));
    }
}
