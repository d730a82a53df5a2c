//! The rows: every persistent register element in the manual, from the register table. Holds no values.

use crate::hand::register::{
    DEFAULT_FORCE_SET, DEFAULT_SPEED_SET, HAND_ID, REDU_RATIO, Register, by_address,
};
use crate::hand::setting::IP_PARTS;
use crate::hand::{Dof, SerialSpeed};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::net::Ipv4Addr;

/// One parameter. Serialized as its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(into = "String")]
pub enum ParamId {
    /// The bus id (manual 2.6.1).
    HandId,
    /// The code of the serial speed (manual 2.6.2).
    ReduRatio,
    /// The IP address (manual 2.6).
    IpAddress,
    /// A joint's speed after power-up (manual 2.6.8).
    DefaultSpeed(Dof),
    /// A joint's force threshold after power-up (manual 2.6.9).
    DefaultForce(Dof),
}

/// The value of a parameter, as read from the hand: it may be outside the documented range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    Number(i32),
    Address(Ipv4Addr),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Address(address) => address.fmt(f),
        }
    }
}

impl From<Value> for toml::Value {
    fn from(value: Value) -> Self {
        match value {
            Value::Number(number) => i64::from(number).into(),
            Value::Address(address) => address.to_string().into(),
        }
    }
}

/// The table of power-up speeds in files.
pub const DEFAULT_SPEED: &str = "default_speed";
/// The table of power-up force thresholds in files.
pub const DEFAULT_FORCE: &str = "default_force";

impl ParamId {
    /// All rows: id, serial speed and IP address, then the defaults in register order.
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::HandId, Self::ReduRatio, Self::IpAddress];
        all.extend(Dof::ALL.map(Self::DefaultSpeed));
        all.extend(Dof::ALL.map(Self::DefaultForce));
        all
    }

    /// Stable name in files, on the command line and in JSON.
    pub fn name(self) -> String {
        match self {
            Self::HandId => "hand_id".into(),
            Self::ReduRatio => "redu_ratio".into(),
            Self::IpAddress => "ip_address".into(),
            Self::DefaultSpeed(dof) => format!("{DEFAULT_SPEED}.{}", dof.name()),
            Self::DefaultForce(dof) => format!("{DEFAULT_FORCE}.{}", dof.name()),
        }
    }

    /// The rows with this name: a single one, or the six of a group.
    pub fn named(name: &str) -> Vec<Self> {
        let all = Self::all().into_iter();
        let is_meant = |id: &Self| {
            let own = id.name();
            own == name || own.split('.').next() == Some(name)
        };
        all.filter(is_meant).collect()
    }

    /// Its register; the first of four for an IP address.
    pub fn register(self) -> &'static Register {
        let address = match self {
            Self::HandId => HAND_ID.address,
            Self::ReduRatio => REDU_RATIO.address,
            Self::IpAddress => IP_PARTS.address,
            Self::DefaultSpeed(_) => DEFAULT_SPEED_SET.address,
            Self::DefaultForce(_) => DEFAULT_FORCE_SET.address,
        };
        by_address(address).unwrap_or(&HAND_ID)
    }

    /// Smallest and largest value that may be written; `None` for an IP address.
    pub fn range(self) -> Option<(i32, i32)> {
        match self {
            Self::IpAddress => None,
            _ => self.register().range,
        }
    }

    /// The unit; empty if there is none.
    pub fn unit(self) -> &'static str {
        self.register().unit
    }

    /// The factory value; `None` if the manual gives none.
    pub fn factory(self) -> Option<Value> {
        if self != Self::IpAddress {
            return self.register().default.map(Value::Number);
        }
        let mut parts = [0; 4];
        for (part, address) in parts.iter_mut().zip(IP_PARTS.address..) {
            *part = u8::try_from(by_address(address)?.default?).ok()?;
        }
        Some(Value::Address(parts.into()))
    }

    /// True for the rows that define how the hand is reached: id, serial speed, IP address. They belong to one hand and are not copied
    /// to another along with the rest.
    pub const fn is_place(self) -> bool {
        matches!(self, Self::HandId | Self::ReduRatio | Self::IpAddress)
    }

    /// True if this value may be written.
    pub fn allows(self, value: Value) -> bool {
        match (self, value) {
            (Self::IpAddress, Value::Address(address)) => is_host(address),
            (Self::ReduRatio, Value::Number(code)) => SerialSpeed::of_code(code.into()).is_some(),
            (Self::IpAddress, _) | (_, Value::Address(_)) => false,
            (_, Value::Number(number)) => self
                .range()
                .is_some_and(|(min, max)| (min..=max).contains(&number)),
        }
    }

    /// The allowed values, as text.
    pub fn allowed(self) -> String {
        match (self, self.range()) {
            (Self::IpAddress, _) | (_, None) => {
                "an address of one computer, for example 192.168.11.210".into()
            }
            (_, Some((min, max))) => format!("a whole number from {min} to {max}"),
        }
    }
}

impl From<ParamId> for String {
    fn from(id: ParamId) -> Self {
        id.name()
    }
}

/// True for an IP address that a host can have.
fn is_host(address: Ipv4Addr) -> bool {
    let [first, .., last] = address.octets();
    !matches!(first, 0 | 127 | 224..) && !matches!(last, 0 | 255)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register::{Access, Origin, Persistence, REGISTERS};

    #[test]
    fn every_kept_register_of_the_manual_has_its_rows() {
        let kept = REGISTERS
            .iter()
            .filter(|row| row.persistence == Persistence::Saved && row.origin == Origin::Manual);
        for row in kept {
            assert_eq!(row.access, Access::ReadWrite);
            let is_part = IP_PARTS.covers(row.span());
            let rows = ParamId::all()
                .into_iter()
                .filter(|id| id.register() == row || is_part && *id == ParamId::IpAddress);
            let expected = if is_part { 1 } else { usize::from(row.count()) };
            assert_eq!(rows.count(), expected, "{row}");
        }
        assert_eq!(ParamId::all().len(), 15);
    }

    #[test]
    fn names_are_found_again_alone_and_as_groups() {
        for id in ParamId::all() {
            assert_eq!(ParamId::named(&id.name()), [id]);
            assert!(!id.register().section.is_empty());
        }
        assert_eq!(ParamId::named(DEFAULT_FORCE).len(), 6);
        assert!(ParamId::named("default").is_empty() && ParamId::named("").is_empty());
    }

    #[test]
    fn what_may_be_written_is_the_manuals_range_and_one_computers_address() {
        let speed = ParamId::DefaultSpeed(Dof::Index);
        for (id, value, allowed) in [
            (speed, Value::Number(1000), true),
            (speed, Value::Number(1001), false),
            (speed, Value::Number(-1), false),
            (ParamId::HandId, Value::Number(0), false),
            (ParamId::HandId, Value::Number(254), true),
            (ParamId::ReduRatio, Value::Number(4), false),
            (ParamId::IpAddress, Value::Number(7), false),
            (speed, Value::Address([10, 0, 0, 9].into()), false),
        ] {
            assert_eq!(id.allows(value), allowed, "{id:?} {value}");
        }
        for (address, allowed) in [
            ([10, 0, 0, 9], true),
            ([0, 1, 2, 3], false),
            ([127, 0, 0, 1], false),
            ([224, 0, 0, 1], false),
            ([255, 255, 255, 255], false),
            ([10, 0, 0, 0], false),
            ([10, 0, 0, 255], false),
        ] {
            let value = Value::Address(address.into());
            assert_eq!(ParamId::IpAddress.allows(value), allowed, "{value}");
        }
        assert_eq!(
            ParamId::IpAddress.factory().unwrap().to_string(),
            "192.168.11.210"
        );
        assert_eq!(speed.factory(), None, "the manual prints none");
    }
}
