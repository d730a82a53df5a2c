//! ERROR bits as text (manual 2.6.18). Unknown bits are preserved.

use crate::hand::feedback::status::Words;

/// One fault that a drive can report (manual 2.6.18).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Fault {
    /// Bit 0: 堵转故障.
    Stall,
    /// Bit 1: 过温故障.
    OverTemperature,
    /// Bit 2: 过流故障.
    OverCurrent,
    /// Bit 3: 电机异常.
    Motor,
    /// Bit 4: 通讯故障.
    Communication,
    /// Bits 5 to 7, not in the manual.
    Unknown(u8),
}

impl Fault {
    /// From a bit number, 0..=7.
    pub const fn from_bit(bit: u8) -> Self {
        match bit {
            0 => Self::Stall,
            1 => Self::OverTemperature,
            2 => Self::OverCurrent,
            3 => Self::Motor,
            4 => Self::Communication,
            other => Self::Unknown(other),
        }
    }

    /// The bit number, 0..=7.
    pub const fn bit(self) -> u8 {
        match self {
            Self::Stall => 0,
            Self::OverTemperature => 1,
            Self::OverCurrent => 2,
            Self::Motor => 3,
            Self::Communication => 4,
            Self::Unknown(bit) => bit,
        }
    }

    /// Stable lower-case name for files and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stall => "stall",
            Self::OverTemperature => "over_temperature",
            Self::OverCurrent => "over_current",
            Self::Motor => "motor",
            Self::Communication => "communication",
            Self::Unknown(5) => "unknown_bit_5",
            Self::Unknown(6) => "unknown_bit_6",
            Self::Unknown(_) => "unknown_bit_7",
        }
    }

    /// Returns whether CLEAR_ERROR can clear the fault (manual 2.6.3); `None` for unknown bits.
    pub const fn clearable(self) -> Option<bool> {
        match self {
            Self::OverTemperature => Some(false),
            Self::Unknown(_) => None,
            _ => Some(true),
        }
    }

    /// English text: meaning and advice.
    pub const fn words(self) -> Words {
        match self {
            Self::Stall => Words::new(
                "Stall",
                "The drive pushed and could not move.",
                "Free the finger or open it, then clear errors.",
            ),
            Self::OverTemperature => Words::new(
                "Over-temperature",
                "The drive is too hot.",
                "Let it cool: this fault cannot be cleared and ends by itself.",
            ),
            Self::OverCurrent => Words::new(
                "Over-current",
                "The drive drew too much current.",
                "Reduce load, speed or force threshold, then clear errors.",
            ),
            Self::Motor => Words::new(
                "Motor fault",
                "The drive reports an abnormal motor.",
                "Clear errors. If it returns, switch the hand off and on, then ask the maker.",
            ),
            Self::Communication => Words::new(
                "Drive communication",
                "The hand's board lost contact with the drive.",
                "Clear errors. If it returns, check supply and cable, then ask the maker.",
            ),
            Self::Unknown(bit) => Words::new(
                match bit {
                    5 => "Unknown fault, bit 5",
                    6 => "Unknown fault, bit 6",
                    _ => "Unknown fault, bit 7",
                },
                "The manual does not list this bit.",
                "Stop and note the code for the maker.",
            ),
        }
    }
}

/// The fault byte of one drive, with all its bits, known or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Faults(u8);

impl Faults {
    /// Wraps the register's byte.
    pub const fn from_raw(raw: u8) -> Self {
        Self(raw)
    }

    /// The register's byte.
    pub const fn raw(self) -> u8 {
        self.0
    }

    /// True if no bit is set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True if this fault's bit is set.
    pub const fn contains(self, fault: Fault) -> bool {
        self.0 >> fault.bit() & 1 == 1
    }

    /// Iterates over the faults that are set, lowest bit first.
    pub fn iter(self) -> impl Iterator<Item = Fault> {
        (0..8)
            .map(Fault::from_bit)
            .filter(move |fault| self.contains(*fault))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manuals_example_names_two_faults() {
        let faults: Vec<_> = Faults::from_raw(0x06).iter().collect();
        assert_eq!(faults, [Fault::OverTemperature, Fault::OverCurrent]);
    }

    #[test]
    fn every_bit_of_every_byte_is_kept() {
        for raw in 0..=255u8 {
            let back = Faults::from_raw(raw)
                .iter()
                .fold(0, |sum, fault| sum | 1 << fault.bit());
            assert_eq!(back, raw);
        }
    }

    #[test]
    fn over_temperature_cannot_be_cleared() {
        assert_eq!(Fault::OverTemperature.clearable(), Some(false));
        assert_eq!(Fault::Stall.clearable(), Some(true));
        assert_eq!(Fault::from_bit(6).clearable(), None);
    }
}
