//! What a hand is found by: its id, serial speed and address, and where it is found after a change of one.

use crate::hand::{HandId, Refusal, SerialSpeed, Setting};
use crate::params::rows::{ParamId, Value};
use crate::transport::Endpoint;

/// Where the hand is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WhichPlace {
    Old,
    /// Where it will be, if the change acts at once.
    New,
}

impl WhichPlace {
    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Old => Self::New,
            Self::New => Self::Old,
        }
    }
}

/// Where the hand is after a change was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Moved {
    /// Another hand answers at the new place. Nothing was written.
    Occupied,
    /// The hand said no, and is where it was.
    Refused { reason: Refusal },
    /// The hand answers at the new place.
    There,
    /// The hand answers at the old place and holds the new value: it acts at a SAVE or at the next power-up.
    Waits,
    /// The hand answers at the old place and holds what it held.
    Stayed,
    /// No hand answers at either place.
    Nowhere,
}

impl Moved {
    /// The stable word for JSON.
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

/// Both places of a hand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlacePair {
    pub old: Endpoint,
    /// Where it will be; as old where this wire finds it by something else.
    pub new: Endpoint,
}

impl PlacePair {
    /// The endpoint of a place.
    pub const fn endpoint(&self, place: WhichPlace) -> &Endpoint {
        match place {
            WhichPlace::Old => &self.old,
            WhichPlace::New => &self.new,
        }
    }
}

/// The setting that is a row by which a hand is found; none for other rows and for values outside the manual's ranges.
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

/// Where the hand will be found over the same wire; none if this row does not say it there, or this wire cannot follow.
pub fn new_place(hand: &Endpoint, id: ParamId, wanted: Value) -> Option<Endpoint> {
    let Value::Number(number) = wanted else {
        return None;
    };
    let byte = u8::try_from(number).ok()?;
    let mut place = hand.clone();
    match (&mut place, id) {
        (Endpoint::Rs485(line) | Endpoint::Rtu(line) | Endpoint::RtuTcp(line), ParamId::HandId) => {
            line.id = byte
        }
        (Endpoint::Rs485(line) | Endpoint::Rtu(line), ParamId::ReduRatio) => {
            line.baud = SerialSpeed::of_code(byte.into())?.baud();
        }
        (
            Endpoint::Can { id: at, .. }
            | Endpoint::Slcan { id: at, .. }
            | Endpoint::UsbCan { id: at, .. },
            ParamId::HandId,
        ) => {
            *at = u16::from(byte);
        }
        _ => return None,
    }
    Some(place)
}

/// The same wire with the factory's id and serial speed. An address on the network acts from the next power-up.
pub fn factory_place(hand: &Endpoint) -> Endpoint {
    let mut place = hand.clone();
    let id = match ParamId::HandId.factory() {
        Some(Value::Number(id)) => u8::try_from(id).unwrap_or(1),
        _ => 1,
    };
    match &mut place {
        Endpoint::Rs485(line) | Endpoint::Rtu(line) => {
            line.id = id;
            line.baud = SerialSpeed::Baud115200.baud();
        }
        // The speed behind a device server is set there.
        Endpoint::RtuTcp(line) => line.id = id,
        Endpoint::Can { id: at, .. }
        | Endpoint::Slcan { id: at, .. }
        | Endpoint::UsbCan { id: at, .. } => *at = u16::from(id),
        Endpoint::Tcp { .. } | Endpoint::Sim { .. } => {}
    }
    place
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
