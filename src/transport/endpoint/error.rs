//! Errors for texts that are not an endpoint, with messages for the user who wrote them. Parses nothing.

use std::fmt;

/// Permitted form of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Want {
    /// A whole number.
    Whole,
    /// A whole number in this range, both ends included.
    Between(u32, u32),
    /// A speed in bits per second in this range.
    Speed(u32, u32),
    /// One of these, as a list in words.
    OneOf(&'static str),
}

impl fmt::Display for Want {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => write!(f, "a whole number"),
            Self::Between(from, to) => write!(f, "a whole number from {from} to {to}"),
            Self::Speed(from, to) => write!(f, "a speed from {from} to {to}"),
            Self::OneOf(all) => write!(f, "{all}"),
        }
    }
}

/// Reason why a text is not an endpoint.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum EndpointError {
    /// The part before the colon is unknown or missing.
    #[error(
        "'{text}' does not name a kind of link: write sim:, rs485:PORT, rtu:PORT, rtu+tcp:HOST:PORT, tcp:HOST, can:INTERFACE, slcan:PORT or usbcan:PORT"
    )]
    Kind {
        /// The given text.
        text: String,
    },
    /// The part after the colon is missing.
    #[error("'{text}' is incomplete: write for example {example}")]
    Place {
        /// The given text.
        text: String,
        /// The kind of link.
        kind: &'static str,
        /// A valid example.
        example: &'static str,
    },
    /// A key that this kind of link does not have.
    #[error("'{key}' is not a setting of '{kind}:'; the settings are {known}")]
    Key {
        /// The given key.
        key: String,
        /// The kind of link.
        kind: &'static str,
        /// The keys it has.
        known: &'static str,
    },
    /// A duplicate key: it would be ambiguous.
    #[error("duplicate key '{key}'; write it once")]
    Twice { key: String },
    /// A value that does not fit its key.
    #[error("invalid value {key}={value}: {key} is {want}")]
    Value {
        key: String,
        /// The given value.
        value: String,
        /// The permitted form.
        want: Want,
    },
}
