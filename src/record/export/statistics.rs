//! Statistics of a data set's columns, in constant memory.

use serde_json::{Map, Value, json};

/// Maximum number of a column's values stored for the quantiles. When it is reached, every second one is dropped.
const VALUES_MAX: usize = 65_536;
/// Quantiles that newer policies require.
const QUANTILES: [(&str, f64); 5] = [
    ("q01", 0.01),
    ("q10", 0.10),
    ("q50", 0.50),
    ("q90", 0.90),
    ("q99", 0.99),
];

/// Statistics of some lists of numbers.
#[derive(Debug)]
pub(crate) struct Statistics {
    parts: Vec<(String, Vec<ColumnSummary>)>,
}

impl Statistics {
    /// Lists with these names and lengths.
    pub(crate) fn new(parts: impl Iterator<Item = (&'static str, usize)>) -> Self {
        let part =
            |(name, width): (&str, usize)| (name.to_owned(), vec![ColumnSummary::default(); width]);
        Self {
            parts: parts.map(part).collect(),
        }
    }

    /// Adds one row.
    pub(crate) fn push(&mut self, row: &[&[f32]]) {
        for ((_, summaries), values) in self.parts.iter_mut().zip(row) {
            for (summary, value) in summaries.iter_mut().zip(*values) {
                summary.push(*value);
            }
        }
    }

    /// Formats as in `stats.json`.
    pub(crate) fn json(&self) -> Value {
        let mut all = Map::new();
        for (name, summaries) in &self.parts {
            let each = |value: fn(&ColumnSummary) -> f64| -> Vec<f64> {
                summaries.iter().map(value).collect()
            };
            let mut part = Map::new();
            part.insert("min".into(), each(|one| f64::from(one.min)).into());
            part.insert("max".into(), each(|one| f64::from(one.max)).into());
            part.insert("mean".into(), each(ColumnSummary::mean).into());
            part.insert("std".into(), each(ColumnSummary::deviation).into());
            let count = summaries.first().map_or(0, |one| one.count);
            part.insert("count".into(), json!([count]));
            for (key, share) in QUANTILES {
                let values: Vec<f64> = summaries.iter().map(|one| one.quantile(share)).collect();
                part.insert(key.into(), values.into());
            }
            all.insert(name.clone(), part.into());
        }
        all.into()
    }
}

/// Statistics of one number.
#[derive(Debug, Clone)]
struct ColumnSummary {
    min: f32,
    max: f32,
    count: u64,
    /// Mean, and sum of squared deviations from it (Welford's method).
    mean: f64,
    squares: f64,
    kept: Vec<f32>,
    each: u64,
}

impl Default for ColumnSummary {
    fn default() -> Self {
        Self {
            min: f32::INFINITY,
            max: f32::NEG_INFINITY,
            count: 0,
            mean: 0.0,
            squares: 0.0,
            kept: Vec::new(),
            each: 1,
        }
    }
}

impl ColumnSummary {
    fn push(&mut self, value: f32) {
        if self.count.is_multiple_of(self.each) {
            if self.kept.len() >= VALUES_MAX {
                let mut odd = false;
                self.kept.retain(|_| {
                    odd = !odd;
                    odd
                });
                self.each *= 2;
            }
            self.kept.push(value);
        }
        self.count += 1;
        self.min = self.min.min(value);
        self.max = self.max.max(value);
        let apart = f64::from(value) - self.mean;
        self.mean += apart / count(self.count);
        self.squares += apart * (f64::from(value) - self.mean);
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn deviation(&self) -> f64 {
        (self.squares / count(self.count.max(1))).sqrt()
    }

    fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.kept.clone();
        sorted.sort_by(f32::total_cmp);
        let last = count(u64::try_from(sorted.len().saturating_sub(1)).unwrap_or_default());
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a place in a list of 65 536"
        )]
        let place = (last * share).round() as usize;
        sorted.get(place).map_or(0.0, |value| f64::from(*value))
    }
}

#[expect(clippy::cast_precision_loss, reason = "far below 2^53 frames")]
const fn count(frames: u64) -> f64 {
    frames as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_those_of_the_values_and_memory_is_bounded() {
        let mut all = Statistics::new([("x", 1)].into_iter());
        for number in 0..1_000_000_u32 {
            let value = f32::from(u16::try_from(number % 1001).unwrap());
            all.push(&[&[value]]);
        }
        let json = all.json();
        let x = &json["x"];
        assert_eq!((&x["min"][0], &x["max"][0]), (&json!(0.0), &json!(1000.0)));
        assert_eq!(x["count"], json!([1_000_000]));
        for (key, wanted) in [
            ("mean", 500.0),
            ("std", 289.0),
            ("q01", 10.0),
            ("q50", 500.0),
            ("q99", 990.0),
        ] {
            let value = x[key][0].as_f64().unwrap();
            assert!((value - wanted).abs() < 5.0, "{key}: {value}");
        }
        assert!(all.parts[0].1[0].kept.len() <= VALUES_MAX);
    }
}
