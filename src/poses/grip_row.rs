//! Grips by size and their detection thresholds in a pose file.

use crate::hand::gap::{Gap, GripKind};
use crate::hand::grip::{GripThreshold, GripThresholds};
use crate::hand::units::decimal;
use crate::store::{FileCause, FileError, FileText};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toml::{Spanned, Value};

/// A grip by size.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GripRow {
    kind: Spanned<GripKind>,
    gap_mm: Spanned<f64>,
}

impl GripRow {
    pub(super) fn of(gap: Gap) -> Self {
        Self {
            kind: unplaced(GripKind::Pinch),
            gap_mm: unplaced(decimal(gap.mm())),
        }
    }

    /// The gap; kinds without one are rejected with the reason.
    pub(super) fn read(&self, source: FileText<'_>) -> Result<Gap, FileError> {
        let kind = self.kind.get_ref().offered();
        kind.map_err(|why| source.blame(self.kind.span(), "kind", FileCause::NotOffered(why)))?;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the range is checked after it"
        )]
        let gap = Gap::new(*self.gap_mm.get_ref() as f32);
        gap.map_err(|out| {
            let cause = FileCause::Range {
                got: format!("{} mm", out.got),
                range: format!("{} to {} mm", Gap::MIN.mm(), Gap::MAX.mm()),
            };
            source.blame(self.gap_mm.span(), "gap_mm", cause)
        })
    }
}

/// Thresholds by name; defaults are left out.
pub(super) type ThresholdsRow = BTreeMap<Spanned<String>, Spanned<Value>>;

pub(super) fn thresholds_row(thresholds: &GripThresholds) -> ThresholdsRow {
    let own = thresholds.unusual();
    own.map(|(one, is)| (unplaced(one.name().to_owned()), unplaced(value(is))))
        .collect()
}

pub(super) fn read_thresholds(
    row: &ThresholdsRow,
    source: FileText<'_>,
) -> Result<GripThresholds, FileError> {
    let mut thresholds = GripThresholds::default();
    for (name, value) in row {
        let Some(one) = GripThreshold::named(name.get_ref()) else {
            let known = GripThreshold::ALL.map(GripThreshold::name).join(", ");
            let cause = FileCause::Unknown { known };
            return Err(source.blame(name.span(), name.get_ref(), cause));
        };
        let number = number(value.get_ref());
        if !number.is_some_and(|number| one.set(&mut thresholds, number)) {
            let (least, most) = one.range();
            let cause = FileCause::Range {
                got: value.get_ref().to_string(),
                range: format!("{least} to {most}"),
            };
            return Err(source.blame(value.span(), one.name(), cause));
        }
    }
    Ok(thresholds)
}

#[expect(
    clippy::cast_precision_loss,
    reason = "what is in range is far below that"
)]
const fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(whole) => Some(*whole as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

/// A number; whole ones are written without a decimal point.
fn value(number: f64) -> Value {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a threshold is a small number"
    )]
    let whole = number as i64;
    if number.fract() == 0.0 {
        Value::Integer(whole)
    } else {
        Value::Float(number)
    }
}

/// A value without a position in a file.
pub(super) fn unplaced<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
}
