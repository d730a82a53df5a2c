//! Why a text is no endpoint, in words for the user who wrote it. Reads no text.

use std::fmt;

/// What a value must be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Want {
    /// A whole number.
    Whole,
    /// A whole number in this range, both ends included.
    Between(u32, u32),
    /// A speed in bits a second in this range.
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

/// Why a text is no endpoint.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum EndpointError {
    /// The part before the colon is unknown or missing.
    #[error(
        "'{text}' names no kind of link: write sim:, rs485:PORT, rtu:PORT, rtu+tcp:HOST:PORT, tcp:HOST, can:INTERFACE, slcan:PORT or usbcan:PORT"
    )]
    Kind {
        /// What was given.
        text: String,
    },
    /// The part after the colon is missing.
    #[error("'{text}' is incomplete: write for example {example}")]
    Place {
        /// What was given.
        text: String,
        /// The kind of link.
        kind: &'static str,
        /// A right one.
        example: &'static str,
    },
    /// A key that this kind does not have.
    #[error("'{key}' is not a setting of '{kind}:'; the settings are {known}")]
    Key {
        /// What was given.
        key: String,
        /// The kind of link.
        kind: &'static str,
        /// The keys it has.
        known: &'static str,
    },
    /// A key that is given twice: which of both is meant, nobody knows.
    #[error("'{key}' stands there twice; write it once")]
    Twice { key: String },
    /// A value that does not fit its key.
    #[error("{key}={value} is not possible: {key} is {want}")]
    Value {
        key: String,
        /// What was given.
        value: String,
        /// What it must be.
        want: Want,
    },
}
