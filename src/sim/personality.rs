//! What the manual leaves open, as switches. Only the simulated hand has them.

use std::time::Duration;

/// A write outside an element's range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OutOfRangeWrite {
    /// Acknowledged, without effect.
    #[default]
    Drop,
    /// Taken as the nearest allowed value.
    Clamp,
}

/// What -1 in ANGLE_SET does to a joint that moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MinusOne {
    /// The joint stops where it is.
    Freeze,
    /// The joint goes on to its former target.
    // Manual: 2.6.11 says "no action"; whether that ends a running action is open.
    #[default]
    Ignore,
}

/// What SPEED_SET 0 means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpeedZero {
    /// The joint does not move.
    #[default]
    Freeze,
    /// The joint creeps.
    Slowest,
}

/// The second frame after SAVE (manual 2.2.2 prints the command byte in two ways).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SaveAnswer {
    /// Command byte 0x11, success.
    Command11,
    /// Command byte 0x12, success.
    #[default]
    Command12,
    /// The parameters are saved, but no frame follows.
    Never,
    /// Nothing is saved, and the frame says so.
    Failed,
}

/// How single bytes become Modbus words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ByteWords {
    /// Two a word, low byte first.
    #[default]
    Packed,
    /// One a word where a read begins at ERROR, STATUS or TEMP, as one real hand was seen to do.
    OnePerWord,
}

/// One reading of everything the manual leaves open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Personality {
    /// Writes outside a range.
    pub out_of_range: OutOfRangeWrite,
    /// -1 in the middle of a move.
    pub minus_one_mid_move: MinusOne,
    /// SPEED_SET 0.
    pub speed_zero: SpeedZero,
    /// The late frame after SAVE.
    pub save_frame: SaveAnswer,
    /// Whether 1558 to 1581 can be read through.
    pub gap_readable: bool,
    /// Whether 1558 to 1565 hold the moment of the read in microseconds, low byte first; for tests.
    pub stamp_gap: bool,
    /// How ERROR, STATUS and TEMP are read over Modbus.
    pub byte_words: ByteWords,
    /// From the end of a request to the reply on a serial line.
    pub turnaround: Duration,
}

impl Default for Personality {
    fn default() -> Self {
        Self {
            out_of_range: OutOfRangeWrite::default(),
            minus_one_mid_move: MinusOne::default(),
            speed_zero: SpeedZero::default(),
            save_frame: SaveAnswer::default(),
            byte_words: ByteWords::default(),
            gap_readable: true,
            stamp_gap: false,
            turnaround: Duration::ZERO,
        }
    }
}
