//! Bytes on a wire, as raw pieces with their times. Nothing is decoded here.

use crate::hand::Moment;

/// Direction of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// From this program to the hand.
    ToHand,
    /// From the hand, or from any other sender on the wire.
    FromHand,
}

impl Direction {
    /// Stable lower-case name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ToHand => "to_hand",
            Self::FromHand => "from_hand",
        }
    }

    /// ASCII arrow to or from the hand.
    pub const fn arrow(self) -> &'static str {
        match self {
            Self::ToHand => "->",
            Self::FromHand => "<-",
        }
    }
}

/// Kind of an event on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PieceKind {
    /// The wire was opened.
    Opened,
    /// Bytes were transferred.
    Bytes(Direction),
    /// The other side hung up, or the wire broke.
    Broken,
    /// This program closed the wire.
    Closed,
}

/// Bytes transferred at once, or a change of the wire itself, without bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Piece {
    pub at: Moment,
    pub kind: PieceKind,
    /// At most the bytes of one call.
    pub bytes: Vec<u8>,
}
