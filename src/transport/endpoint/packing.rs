//! The endpoint's key `packing`: how a person says that a hand puts single bytes into Modbus words. Reads no word.

use std::fmt;
use std::str::FromStr;

/// The values of the key `packing` of Modbus endpoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Packing {
    /// `low`: two a word, the low byte is the lower address.
    Low,
    /// `high`: two a word, the high byte is the lower address.
    High,
    /// `one`: one a word.
    One,
}

impl Packing {
    /// All values, in the order of help texts.
    pub const ALL: [Self; 3] = [Self::Low, Self::High, Self::One];
    /// The values in words.
    pub(crate) const WANT: &'static str = "low, high or one";

    /// As it is spelled in an endpoint.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::High => "high",
            Self::One => "one",
        }
    }
}

impl fmt::Display for Packing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The text names no packing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("packing is low, high or one")]
pub struct NoPacking;

impl FromStr for Packing {
    type Err = NoPacking;

    fn from_str(text: &str) -> Result<Self, NoPacking> {
        let named = Self::ALL.into_iter().find(|packing| packing.name() == text);
        named.ok_or(NoPacking)
    }
}
