//! One set of parameter values, from a hand, a file or the factory, and the differences of two sets. Reads nothing itself.

use crate::hand::register::{DEFAULT_FORCE_SET, DEFAULT_SPEED_SET, HAND_ID, REDU_RATIO};
use crate::hand::setting::IP_PARTS;
use crate::hand::{Dof, Span};
use crate::params::rows::{ParamId, Value};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// The spans to read for all rows; each fits a frame of every protocol.
pub const SPANS: [Span; 4] = [
    HAND_ID.span(),
    REDU_RATIO.span(),
    Span::new(
        DEFAULT_SPEED_SET.address,
        DEFAULT_SPEED_SET.len + DEFAULT_FORCE_SET.len,
    ),
    IP_PARTS,
];

/// Values of some rows. Missing rows are unknown.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Params(BTreeMap<ParamId, Value>);

/// One row in which two sets differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParamDifference {
    pub id: ParamId,
    /// The value in this set; `None` if unknown.
    pub ours: Option<Value>,
    pub theirs: Value,
}

impl Params {
    /// The factory values, as far as the manual gives them.
    pub fn factory() -> Self {
        let all = ParamId::all().into_iter();
        Self(all.filter_map(|id| Some((id, id.factory()?))).collect())
    }

    /// The value of a row; `None` if unknown.
    pub fn get(&self, id: ParamId) -> Option<Value> {
        self.0.get(&id).copied()
    }

    pub fn put(&mut self, id: ParamId, value: Value) {
        self.0.insert(id, value);
    }

    /// Removes a row.
    pub fn forget(&mut self, id: ParamId) {
        self.0.remove(&id);
    }

    /// The known rows, in order.
    pub fn iter(&self) -> impl Iterator<Item = (ParamId, Value)> + '_ {
        self.0.iter().map(|(id, value)| (*id, *value))
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The rows that satisfy the predicate.
    pub fn only(&self, is_meant: impl Fn(ParamId) -> bool) -> Self {
        Self(self.iter().filter(|(id, _)| is_meant(*id)).collect())
    }

    /// These rows, overridden by `others`.
    pub fn with(&self, others: &Self) -> Self {
        let mut all = self.clone();
        others.iter().for_each(|(id, value)| all.put(id, value));
        all
    }

    /// Decodes the rows that a span of the hand's memory covers. Rows only partly in it are unchanged.
    pub fn apply(&mut self, span: Span, bytes: &[u8]) {
        for id in ParamId::all() {
            if let Some(value) = decoded(id, span, bytes) {
                self.put(id, value);
            }
        }
    }

    /// Rows known in `wanted` that are different or unknown in this set.
    pub fn differences(&self, wanted: &Self) -> Vec<ParamDifference> {
        let rows = wanted.iter().map(|(id, theirs)| ParamDifference {
            id,
            ours: self.get(id),
            theirs,
        });
        rows.filter(|row| row.ours != Some(row.theirs)).collect()
    }
}

/// All rows by name; unknown ones are null.
impl Serialize for Params {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let all = ParamId::all().into_iter();
        serializer.collect_map(all.map(|id| (id, self.get(id))))
    }
}

/// The bytes of a row.
pub fn span_of(id: ParamId) -> Span {
    let row = id.register();
    match id {
        ParamId::IpAddress => IP_PARTS,
        ParamId::HandId | ParamId::ReduRatio => row.span(),
        ParamId::DefaultSpeed(dof) | ParamId::DefaultForce(dof) => element(row.address, dof),
    }
}

fn element(address: u16, dof: Dof) -> Span {
    Span::new(address + 2 * dof as u16, 2)
}

/// The value of a row in a span of memory; `None` if the span does not cover it.
pub fn decoded(id: ParamId, span: Span, bytes: &[u8]) -> Option<Value> {
    match (id, span.slice(bytes, span_of(id))?) {
        (ParamId::IpAddress, parts) => {
            let parts: [u8; 4] = parts.try_into().ok()?;
            Some(Value::Address(parts.into()))
        }
        (_, [byte]) => Some(Value::Number(i32::from(*byte))),
        (_, [low, high]) => Some(Value::Number(i32::from(i16::from_le_bytes([*low, *high])))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spans_hold_every_row_once() {
        let mut params = Params::default();
        for span in SPANS {
            let known = params.iter().count();
            params.apply(span, &vec![1; usize::from(span.len)]);
            let inside = |id: &ParamId| span.covers(span_of(*id));
            let rows = ParamId::all().into_iter().filter(inside).count();
            assert_eq!(params.iter().count(), known + rows, "{span:?}");
        }
        assert_eq!(params.iter().count(), ParamId::all().len());
        let speed = ParamId::DefaultSpeed(Dof::Ring);
        assert_eq!(params.get(speed), Some(Value::Number(257)));
        let mut short = Params::default();
        short.apply(SPANS[2], &[1, 2, 3]);
        assert_eq!(short.iter().count(), 1, "half a value is none");
    }

    #[test]
    fn only_what_the_other_knows_is_compared() {
        let mut live = Params::default();
        live.put(ParamId::HandId, Value::Number(7));
        live.put(ParamId::DefaultSpeed(Dof::Index), Value::Number(1000));
        let differences = live.differences(&Params::factory());
        let rows: Vec<_> = differences.iter().map(|row| (row.id, row.ours)).collect();
        assert_eq!(
            rows,
            [
                (ParamId::HandId, Some(Value::Number(7))),
                (ParamId::ReduRatio, None),
                (ParamId::IpAddress, None),
            ]
        );
        assert!(live.differences(&live).is_empty());
    }
}
