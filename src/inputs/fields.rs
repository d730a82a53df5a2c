//! Fields of one JSON object from another program: numbers in any language's notation, each name once. Pure.

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::Value;
use std::fmt;

/// Tolerance for equal numbers: the error of a division in single precision.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Error in a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum FieldFault {
    #[error("is duplicated")]
    Twice,
    #[error("has another type")]
    Type,
}

/// Fields not taken yet.
#[derive(Debug, Default)]
pub struct Fields(Vec<(String, Value)>);

impl Fields {
    /// Parses an object.
    ///
    /// # Errors
    /// The JSON parser's error.
    pub fn parse(text: &[u8]) -> Result<Self, serde_json::Error> {
        serde_json::from_slice(text)
    }

    /// Removes a field and returns it; `None` if it is absent or `null`.
    ///
    /// # Errors
    /// [`FieldFault::Twice`] if the name occurs twice, as it is ambiguous.
    pub fn take(&mut self, name: &str) -> Result<Option<Value>, FieldFault> {
        let mut found = self.0.extract_if(.., |(own, _)| own == name);
        let (first, second) = (found.next(), found.next());
        if second.is_some() {
            return Err(FieldFault::Twice);
        }
        Ok(first
            .map(|(_, value)| value)
            .filter(|value| !value.is_null()))
    }

    /// True if a field with this name is present.
    pub fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(own, _)| own == name)
    }

    /// A remaining field, not taken.
    pub fn other(&self) -> Option<&str> {
        self.0.first().map(|(name, _)| name.as_str())
    }
}

impl<'de> Deserialize<'de> for Fields {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs;
        impl<'de> Visitor<'de> for Pairs {
            type Value = Fields;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Fields, A::Error> {
                let mut fields = Vec::new();
                while let Some(pair) = map.next_entry()? {
                    fields.push(pair);
                }
                Ok(Fields(fields))
            }
        }
        deserializer.deserialize_map(Pairs)
    }
}

/// Reads a whole number, even in fractional notation: `17`, `17.0`, `17e0`, `16.9999999`.
///
/// # Errors
/// [`FieldFault::Type`] for everything else.
pub fn whole(value: &Value) -> Result<i64, FieldFault> {
    if let Some(number) = value.as_i64() {
        return Ok(number);
    }
    let number = number(value)?;
    let rounded = number.round();
    if (number - rounded).abs() > ROUNDING || rounded.abs() > EXACT_MAX {
        return Err(FieldFault::Type);
    }
    #[expect(clippy::cast_possible_truncation, reason = "whole, and in range")]
    Ok(rounded as i64)
}

/// Largest whole number up to which `f64` is exact.
const EXACT_MAX: f64 = 9_007_199_254_740_992.0;

/// Reads any number.
///
/// # Errors
/// [`FieldFault::Type`] for everything else.
pub fn number(value: &Value) -> Result<f64, FieldFault> {
    value.as_f64().ok_or(FieldFault::Type)
}

/// Clamps a number to a range; `None` if it is outside by more than rounding.
pub(crate) fn within(number: f64, (least, most): (f64, f64)) -> Option<f64> {
    let is_near = (least - ROUNDING..=most + ROUNDING).contains(&number);
    is_near.then(|| number.clamp(least, most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_are_read_as_other_languages_write_them() {
        for (text, wanted) in [
            ("17", Ok(17)),
            ("17.0", Ok(17)),
            ("17e0", Ok(17)),
            ("1.7e1", Ok(17)),
            ("-0.0", Ok(0)),
            ("16.9999999", Ok(17)),
            ("17.5", Err(FieldFault::Type)),
            ("1e300", Err(FieldFault::Type)),
            ("\"17\"", Err(FieldFault::Type)),
            ("true", Err(FieldFault::Type)),
        ] {
            let value: Value = serde_json::from_str(text).unwrap();
            assert_eq!(whole(&value), wanted, "{text}");
        }
        assert_eq!(within(1.000_000_000_2, (0.0, 1.0)), Some(1.0));
        assert_eq!(within(-1e-9, (0.0, 1.0)), Some(0.0));
        assert_eq!(within(1.001, (0.0, 1.0)), None);
        assert_eq!(within(f64::NAN, (0.0, 1.0)), None);
    }

    #[test]
    fn a_name_that_is_there_twice_is_told() {
        let mut fields = Fields::parse(br#"{"a":1,"b":null,"a":2,"c":3}"#).unwrap();
        assert!(fields.has("a") && !fields.has("d"));
        assert_eq!(fields.take("a"), Err(FieldFault::Twice));
        assert_eq!(fields.take("b"), Ok(None));
        assert_eq!(fields.take("d"), Ok(None));
        assert_eq!(fields.other(), Some("c"));
        assert_eq!(fields.take("c"), Ok(Some(json!(3))));
        assert_eq!(fields.other(), None);
        assert!(Fields::parse(b"[1]").is_err());
    }
}
