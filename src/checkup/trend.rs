//! How a figure went over the last check-ups.

/// Check-ups that a trend looks back on, this one included.
pub const TREND_MAX: usize = 12;
/// Fewer make no trend.
const POINTS_MIN: usize = 5;
/// A line explains at least so much of what the figures differ by; else they scatter.
const EXPLAINED: f64 = 0.8;
/// A figure drifts that went by this part of the change that is watched for.
const PART_OF_CHANGE: f64 = 0.5;

/// A figure at one check-up.
#[derive(Debug, Clone, PartialEq)]
pub struct TrendPoint {
    /// When, universal time.
    pub at: String,
    pub value: f64,
}

/// A figure over the last check-ups, the oldest first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trend {
    pub points: Vec<TrendPoint>,
}

/// A figure that goes one way.
#[derive(Debug, Clone, PartialEq)]
pub struct Drift {
    /// By the line through all.
    pub from: f64,
    pub to: f64,
    /// Check-ups that it is seen in.
    pub checks: usize,
    /// The day of the first of them.
    pub since: String,
}

impl Trend {
    /// Of the figures of all check-ups, the newest last; only the last of them count.
    pub fn of(points: impl IntoIterator<Item = TrendPoint>) -> Self {
        let mut points: Vec<TrendPoint> = points.into_iter().collect();
        points.drain(..points.len().saturating_sub(TREND_MAX));
        Self { points }
    }

    /// Least and greatest; `None` without a point.
    pub fn range(&self) -> Option<(f64, f64)> {
        let mut values = self.points.iter().map(|point| point.value);
        let first = values.next()?;
        Some(values.fold((first, first), |(least, most), value| {
            (least.min(value), most.max(value))
        }))
    }

    /// Whether it goes one way, by an amount that matters where `change` is watched for from the first check-up on.
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

/// The day of a time as it stands in files.
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
