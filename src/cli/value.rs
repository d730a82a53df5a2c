//! The decoded value of a register, as text and as JSON. Pure.

use crate::cli::watch::telemetry::{fault_names, status_name, tactile_json};
use crate::hand::register::{self, Element, Register};
use crate::hand::{Faults, Finger, Group, Status, TactileBlock};
use serde_json::{Value, json};

/// A register's bytes as a JSON value: a number, a list of numbers or words, or a fingertip. Null if the length does
/// not match.
pub(crate) fn value_json(row: &Register, bytes: &[u8]) -> Value {
    if bytes.len() != usize::from(row.len) {
        return Value::Null;
    }
    if row.element == Element::Tactile {
        let finger = Finger::ALL
            .into_iter()
            .find(|finger| Group::Tactile(*finger).span() == row.span());
        let block = TactileBlock::decode(bytes);
        return finger.map_or(Value::Null, |finger| tactile_json(finger, block.as_ref()));
    }
    let mut values = elements(row, bytes);
    match values.len() {
        1 => values.pop().unwrap_or_default(),
        _ => Value::Array(values),
    }
}

fn elements(row: &Register, bytes: &[u8]) -> Vec<Value> {
    match row.element {
        Element::Short => {
            let (pairs, _) = bytes.as_chunks::<2>();
            let shorts = pairs.iter().map(|pair| i16::from_le_bytes(*pair));
            shorts.map(Value::from).collect()
        }
        _ if *row == register::STATUS => {
            let states = bytes.iter().map(|raw| Status::from_raw(*raw));
            states.map(|status| status_name(status).into()).collect()
        }
        _ if *row == register::ERROR => {
            let faults = bytes.iter().map(|raw| Faults::from_raw(*raw));
            faults.map(|faults| json!(fault_names(faults))).collect()
        }
        _ => bytes.iter().map(|raw| Value::from(*raw)).collect(),
    }
}

/// One line of text: name, address, values, unit.
pub(crate) fn value_text(row: &Register, bytes: &[u8]) -> String {
    let value = words(&value_json(row, bytes), " ");
    let line = format!("{:<18} {:>5}  {value} {}", row.name, row.address, row.unit);
    line.trim_end().to_owned()
}

/// Separates elements by `between`, and the faults of one joint by `+`.
fn words(value: &Value, between: &str) -> String {
    match value {
        Value::Null => "-".into(),
        Value::String(word) => word.clone(),
        Value::Array(all) if all.is_empty() => "none".into(),
        Value::Array(all) => {
            let all: Vec<String> = all.iter().map(|one| words(one, "+")).collect();
            all.join(between)
        }
        Value::Object(fields) => {
            let fields = fields.iter();
            let fields = fields.map(|(name, value)| format!("{name} {}", words(value, " ")));
            fields.collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::REGISTERS;

    #[test]
    fn every_kind_of_register_is_decoded() {
        for (row, bytes, json, text) in [
            (
                register::HAND_ID,
                vec![1],
                json!(1),
                "HAND_ID             1000  1",
            ),
            (
                register::FORCE_ACT,
                [100i16, -1, 0, 0, 0, 7].map(i16::to_le_bytes).concat(),
                json!([100, -1, 0, 0, 0, 7]),
                "FORCE_ACT           1582  100 -1 0 0 0 7 g",
            ),
            (
                register::TEMP,
                vec![30, 31, 32, 33, 34, 255],
                json!([30, 31, 32, 33, 34, 255]),
                "TEMP                1618  30 31 32 33 34 255 °C",
            ),
            (
                register::STATUS,
                vec![0, 1, 2, 3, 4, 7],
                json!([
                    "releasing",
                    "grasping",
                    "position_reached",
                    "force_reached",
                    "unknown(4)",
                    "drive_fault"
                ]),
                "STATUS              1612  releasing grasping position_reached force_reached unknown(4) drive_fault",
            ),
            (
                register::ERROR,
                vec![0, 1, 6, 0, 0, 32],
                json!([
                    [],
                    ["stall"],
                    ["over_temperature", "over_current"],
                    [],
                    [],
                    ["unknown_bit_5"]
                ]),
                "ERROR               1606  none stall over_temperature+over_current none none unknown_bit_5",
            ),
        ] {
            assert_eq!(value_json(&row, &bytes), json, "{row}");
            assert_eq!(value_text(&row, &bytes), text);
        }
    }

    #[test]
    fn a_fingertip_is_named_and_decoded() {
        let row = REGISTERS.last().unwrap();
        let mut bytes = vec![0; 58];
        bytes[0] = 9;
        let value = value_json(row, &bytes);
        assert_eq!(value["finger"], "thumb");
        assert_eq!(value["raw"][0], 9);
        assert_eq!(value["check_ok"], false);
        let text = value_text(row, &bytes);
        for name in value.as_object().unwrap().keys() {
            assert!(text.contains(name), "{name} in {text}");
        }
    }

    #[test]
    fn bytes_that_do_not_fit_are_no_value() {
        assert_eq!(value_json(&register::TEMP, &[1, 2]), Value::Null);
        assert_eq!(
            value_text(&register::HAND_ID, &[]),
            "HAND_ID             1000  -"
        );
    }
}
