//! Fingers of a hold that press harder, each with its cause.

use crate::hand::dof::Finger;
use serde::Serialize;

/// Why a finger presses harder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TightenCause {
    /// It pressed with less than *at least*.
    TooLittle,
    /// The tangential force came too close to the friction.
    Margin,
    /// The tangential force rose quickly.
    Load,
    /// The object slid on the fingertip.
    Slip,
}

impl TightenCause {
    /// Stable lower-case name, as in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::TooLittle => "too_little",
            Self::Margin => "margin",
            Self::Load => "load",
            Self::Slip => "slip",
        }
    }
}

/// A finger that pressed harder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
pub struct Tightened {
    /// The finger.
    pub finger: Finger,
    /// Its reason.
    pub cause: TightenCause,
}
