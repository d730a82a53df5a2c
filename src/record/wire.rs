//! What went over a wire, as raw pieces with their times. Nothing is decoded here.

use crate::hand::Moment;

/// Which way bytes went.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// From this program to the hand.
    ToHand,
    /// From the hand, or whoever else speaks on the wire.
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

    /// Two signs that point to or from the hand.
    pub const fn arrow(self) -> &'static str {
        match self {
            Self::ToHand => "->",
            Self::FromHand => "<-",
        }
    }
}

/// What happened on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PieceKind {
    /// The wire was opened.
    Opened,
    /// Bytes passed.
    Bytes(Direction),
    /// The other side hung up, or the wire broke.
    Broken,
    /// This program closed the wire.
    Closed,
}

/// Bytes that passed at once, or a change of the wire itself, which has none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Piece {
    pub at: Moment,
    pub kind: PieceKind,
    /// The bytes; at most what one call moved.
    pub bytes: Vec<u8>,
}
