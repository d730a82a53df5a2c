//! Addresses of a hand: its id, serial speed and IP address, and its endpoint after one of them changes.

use crate::hand::{HandId, Refusal, SerialSpeed, Setting};
use crate::params::rows::{ParamId, Value};
use crate::transport::Endpoint;

/// The place to search for the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WhichPlace {
    Old,
    /// Its place if the change takes effect immediately.
    New,
}

impl WhichPlace {
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Old => Self::New,
            Self::New => Self::Old,
        }
    }
}

/// Result of a written address change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Moved {
    /// Another hand answers at the new place. Nothing was written.
    Occupied,
    /// The hand refused the change and stays at its old place.
    Refused { reason: Refusal },
    /// The hand answers at the new place.
    There,
    /// The hand answers at the old place and holds the new value, which takes effect with a SAVE or at the next power-up.
    Waits,
    /// The hand answers at the old place with its old value.
    Stayed,
    /// No hand answers at either place.
    Nowhere,
}

impl Moved {
    /// Stable name in JSON.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Occupied => "occupied",
            Self::Refused { .. } => "refused",
            Self::There => "moved",
            Self::Waits => "waits",
            Self::Stayed => "stayed",
            Self::Nowhere => "nowhere",
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlacePair {
    pub old: Endpoint,
    /// The new place; equal to the old one if the changed row does not affect this wire.
    pub new: Endpoint,
}

impl PlacePair {
    pub const fn endpoint(&self, place: WhichPlace) -> &Endpoint {
        match place {
            WhichPlace::Old => &self.old,
            WhichPlace::New => &self.new,
        }
    }
}

/// The setting that writes an address row; `None` for other rows and for values outside the manual's ranges.
pub fn setting(id: ParamId, value: Value) -> Option<Setting> {
    match (id, value) {
        (ParamId::HandId, Value::Number(number)) => {
            HandId::new(i64::from(number)).ok().map(Setting::Id)
        }
        (ParamId::ReduRatio, Value::Number(number)) => {
            SerialSpeed::of_code(number.into()).map(Setting::SerialSpeed)
        }
        (ParamId::IpAddress, Value::Address(address)) => Some(Setting::IpAddress(address)),
        _ => None,
    }
}

/// The hand's endpoint on the same wire after the change; `None` if the row does not affect this wire, or the wire cannot follow.
pub fn new_place(hand: &Endpoint, id: ParamId, wanted: Value) -> Option<Endpoint> {
    let Value::Number(number) = wanted else {
        return None;
    };
    let byte = u8::try_from(number).ok()?;
    let mut place = hand.clone();
    match (&mut place, id) {
        (Endpoint::Rs485(line) | Endpoint::Rtu(line), ParamId::ReduRatio) => {
            line.baud = SerialSpeed::of_code(byte.into())?.baud();
        }
        (hand, ParamId::HandId) => *hand = hand.with_bus_id(byte)?,
        _ => return None,
    }
    Some(place)
}

/// The same wire with the factory id and serial speed. A factory IP address takes effect only at the next power-up.
pub fn factory_place(hand: &Endpoint) -> Endpoint {
    let mut place = hand.clone();
    let id = match ParamId::HandId.factory() {
        Some(Value::Number(id)) => u8::try_from(id).unwrap_or(1),
        _ => 1,
    };
    // The serial speed behind a device server or an adapter is configured there.
    if let Endpoint::Rs485(line) | Endpoint::Rtu(line) = &mut place {
        line.baud = SerialSpeed::Baud115200.baud();
    }
    place.with_bus_id(id).unwrap_or(place)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    #[test]
    fn the_new_place_is_on_the_same_wire_and_unknown_where_it_cannot_follow() {
        let place = |hand: &str, id, number| {
            let hand = hand.parse().unwrap();
            new_place(&hand, id, Value::Number(number)).map(|place| place.to_string())
        };
        let rtu = "rtu:/dev/x?baud=115200&id=1";
        let at = |text: &str| text.parse::<Endpoint>().ok().map(|place| place.to_string());
        assert_eq!(
            place(rtu, ParamId::HandId, 7),
            at("rtu:/dev/x?baud=115200&id=7")
        );
        assert_eq!(
            place(rtu, ParamId::ReduRatio, 2),
            at("rtu:/dev/x?baud=19200&id=1")
        );
        assert_eq!(
            place("slcan:/dev/x?id=1", ParamId::HandId, 7),
            at("slcan:/dev/x?id=7")
        );
        assert_eq!(place("slcan:/dev/x?id=1", ParamId::ReduRatio, 1), None);
        assert_eq!(
            place("usbcan:/dev/x?id=1", ParamId::HandId, 7),
            at("usbcan:/dev/x?id=7")
        );
        assert_eq!(place("usbcan:/dev/x?id=1", ParamId::ReduRatio, 1), None);
        assert_eq!(place("tcp:h", ParamId::HandId, 7), None);
        assert_eq!(place(rtu, ParamId::ReduRatio, 4), None);
    }
}
