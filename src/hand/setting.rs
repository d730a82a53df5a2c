//! Persistent settings, one register group each, and functions that a hand performs on its own, at rest. No motion.

use crate::hand::command::{RegisterWrite, Writes, runs};
use crate::hand::dof::PerDof;
use crate::hand::register::{self, Span};
use crate::hand::units::{Force, HandId, SerialSpeed, Speed};
use std::net::Ipv4Addr;

/// The four parts of the IP address (manual 2.6, 1700 to 1703).
pub const IP_PARTS: Span = Span::new(1700, 4);

/// A persistent register group and its new values. Joints that are `None` are unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(test, derive(strum::VariantNames, strum::IntoStaticStr))]
pub enum Setting {
    /// Speeds after power-up (manual 2.6.8).
    DefaultSpeeds(PerDof<Option<Speed>>),
    /// Force thresholds after power-up, grams (manual 2.6.9).
    DefaultForces(PerDof<Option<Force>>),
    /// Id on the bus (manual 2.6.1).
    Id(HandId),
    /// Serial speed (manual 2.6.2).
    SerialSpeed(SerialSpeed),
    /// IP address, which takes effect at the next power-up (manual 2.6).
    IpAddress(Ipv4Addr),
}

impl Setting {
    /// Returns the register writes in order. Joints without a value are not written.
    pub fn writes(&self) -> Writes {
        let mut out = Writes::new();
        match self {
            Self::DefaultSpeeds(values) => {
                let values = values.map(|value| value.map(Speed::get));
                runs(&register::DEFAULT_SPEED_SET, values, &mut out);
            }
            Self::DefaultForces(values) => {
                let values = values.map(|value| value.map(Force::get));
                runs(&register::DEFAULT_FORCE_SET, values, &mut out);
            }
            Self::Id(id) => out.push(RegisterWrite::byte(&register::HAND_ID, id.get())),
            Self::SerialSpeed(speed) => {
                out.push(RegisterWrite::byte(&register::REDU_RATIO, speed.code()));
            }
            Self::IpAddress(address) => {
                out.push(RegisterWrite::run(IP_PARTS.address, address.octets()));
            }
        }
        out
    }

    /// Range of the whole group, for reading back.
    pub const fn span(&self) -> Span {
        match self {
            Self::DefaultSpeeds(_) => register::DEFAULT_SPEED_SET.span(),
            Self::DefaultForces(_) => register::DEFAULT_FORCE_SET.span(),
            Self::Id(_) => register::HAND_ID.span(),
            Self::SerialSpeed(_) => register::REDU_RATIO.span(),
            Self::IpAddress(_) => IP_PARTS,
        }
    }

    /// True if the group's bytes match every value to be set.
    pub fn is_held_by(&self, bytes: &[u8]) -> bool {
        let whole = self.span();
        self.writes()
            .iter()
            .all(|write| whole.slice(bytes, write.span()) == Some(write.bytes()))
    }
}

/// A function that a hand performs on its own, once, and at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(test, derive(strum::VariantNames, strum::IntoStaticStr))]
pub enum Trigger {
    /// Write the parameters to flash (manual 2.6.4).
    Save,
    /// Restore the factory parameters (manual 2.6.5).
    ResetParameters,
    /// Calibrate the force sensors (manual 2.6.6).
    CalibrateForce,
}

impl Trigger {
    /// Returns the register write that starts it.
    pub fn write(self) -> RegisterWrite {
        let row = match self {
            Self::Save => &register::SAVE,
            Self::ResetParameters => &register::RESET_PARA,
            Self::CalibrateForce => &register::GESTURE_FORCE_CLB,
        };
        RegisterWrite::byte(row, 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::dof::Dof;
    use crate::hand::register::{Persistence, by_address};

    fn all() -> [Setting; 5] {
        [
            Setting::DefaultSpeeds(PerDof::splat(Some(Speed::GENTLE))),
            Setting::DefaultForces(PerDof::splat(Some(Force::GENTLE))),
            Setting::Id(HandId::nearest(7)),
            Setting::SerialSpeed(SerialSpeed::Baud19200),
            Setting::IpAddress(Ipv4Addr::new(10, 0, 0, 9)),
        ]
    }

    #[test]
    fn a_setting_writes_only_what_is_kept_and_only_inside_its_group() {
        for setting in all() {
            for write in setting.writes() {
                assert!(!write.is_motion());
                assert!(setting.span().covers(write.span()), "{setting:?}");
                let row = by_address(write.address()).unwrap();
                assert_eq!(row.persistence, Persistence::Saved, "{row}");
            }
        }
    }

    #[test]
    fn joints_that_are_not_given_are_not_compared() {
        let mut speeds = PerDof::splat(None);
        speeds[Dof::Middle] = Some(Speed::GENTLE);
        let setting = Setting::DefaultSpeeds(speeds);
        let mut bytes = [9; 12];
        assert!(!setting.is_held_by(&bytes));
        bytes[4] = 200;
        bytes[5] = 0;
        assert!(setting.is_held_by(&bytes));
        assert!(
            !setting.is_held_by(&bytes[..4]),
            "what is short holds nothing"
        );
        let nothing = Setting::DefaultForces(PerDof::splat(None));
        assert!(nothing.is_held_by(&bytes));
    }
}
