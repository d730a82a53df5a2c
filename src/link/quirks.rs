//! What one hand answers in its own way, where the manual leaves room. Plain values; asks nothing.

use crate::codec::modbus::BytePacking;

/// What was found about a hand when the link got to know it. `None` is what the wire does not ask, or the hand did not
/// answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Quirks {
    /// HAND_ID as the hand gives it (manual 2.6.1).
    pub hand_id: Option<u8>,
    /// REDU_RATIO as the hand gives it (manual 2.6.2). What a code means depends on the manual's edition.
    pub baud_code: Option<u8>,
    /// How the hand puts single bytes into Modbus words.
    pub packing: Option<BytePacking>,
    /// Whether the unused addresses between ANGLE_ACT and FORCE_ACT can be read through.
    pub gap: Option<GapRead>,
    /// What kind of fingertips the tactile block looks like.
    pub touch: Option<TouchVariant>,
}

/// How a hand takes a read across the unused addresses 1558 to 1581.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum GapRead {
    /// It answers: one window holds the whole motion state.
    #[default]
    Through,
    /// It refuses: windows end before the gap and begin behind it.
    Split,
}

/// What the addresses from 3000 on hold, judged by their values: no register tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TouchVariant {
    /// Five blocks of 58 bytes (manual 2.6.21).
    Capacitive,
    /// Zones of 16-bit words up to 4095, as the maker's other fingertips have.
    Resistive,
    /// Neither fits, and the reason.
    Unknown(TouchDoubt),
}

/// Why a tactile block tells no kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TouchDoubt {
    /// All bytes are zero: no sensor, or none that speaks.
    Empty,
    /// A force is no finite number within the sensor's range.
    Force,
    /// A direction is neither an angle nor the word for none.
    Direction,
    /// Check sums differ from the bytes before them.
    Check,
    /// The hand does not let the block be read.
    Refused,
}
