//! Quirks of one hand, where the manual leaves room. Plain values; sends nothing.

pub mod book;

use crate::hand::TactileBlock;
use crate::hand::feedback::tactile::{BLOCK_LEN, NO_DIRECTION, TIP_FORCE_MAX_N};
use crate::hand::register::BytePacking;

/// Quirks detected when the link identified a hand. `None` if the wire does not need it, or the hand did not answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Quirks {
    /// HAND_ID as read from the hand (manual 2.6.1).
    pub hand_id: Option<u8>,
    /// REDU_RATIO as read from the hand (manual 2.6.2). The meaning of a code depends on the manual's edition.
    pub baud_code: Option<u8>,
    /// Packing of single bytes in Modbus words.
    pub packing: Option<BytePacking>,
    /// Behaviour of reads across the unused addresses between ANGLE_ACT and FORCE_ACT.
    pub gap: Option<GapRead>,
    /// Kind of fingertips, judged by the tactile block.
    pub touch: Option<TouchVariant>,
}

/// Behaviour of a hand on a read across the unused addresses 1558 to 1581.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
pub enum GapRead {
    /// It answers: one window covers the whole motion state.
    #[default]
    Through,
    /// It refuses: windows end before the gap and begin after it.
    Split,
}

/// Layout of the addresses from 3000 on, judged by their values: no register indicates it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum TouchVariant {
    /// Five blocks of 58 bytes (manual 2.6.21).
    Capacitive,
    /// Zones of 16-bit words up to 4095, as the maker's other fingertips have.
    Resistive,
    /// Neither layout matches; carries the reason.
    Unknown(TouchDoubt),
}

/// Reason why a tactile block is inconclusive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum TouchDoubt {
    /// All bytes are zero: no sensor, or an inactive one.
    Empty,
    /// A force is not a finite number within the sensor's range.
    Force,
    /// A direction is neither an angle nor the code for none.
    Direction,
    /// Checksums do not match the bytes before them.
    Check,
    /// The hand refuses to read the block.
    Refused,
}

/// Bit rate for a code of REDU_RATIO by this manual (2.6.2), in bits per second; `None` for codes it does not explain.
///
/// Manual: other editions number differently. That of August 2024 gives 921600 the code 4 and swaps the two of CAN.
pub const fn baud_of_code(code: u8, is_can: bool) -> Option<u32> {
    match (code, is_can) {
        (0, false) => Some(115_200),
        (1, false) => Some(57_600),
        (2, false) => Some(19_200),
        (3, false) => Some(921_600),
        (0, true) => Some(1_000_000),
        (1, true) => Some(500_000),
        _ => None,
    }
}

/// Smallest plausible force other than zero: two small words of another layout, read as a float, are far below.
const FORCE_MIN_N: f32 = 1e-6;
/// Largest word of the other layout.
const ZONE_MAX: u16 = 4095;

impl TouchVariant {
    /// Judges the bytes from the start of a fingertip's block, at least 58 of them.
    pub fn judge(bytes: &[u8]) -> Self {
        let block = bytes.get(..BLOCK_LEN).and_then(TactileBlock::decode);
        let Some(block) = block else {
            return Self::Unknown(TouchDoubt::Refused);
        };
        if bytes.iter().all(|byte| *byte == 0) {
            return Self::Unknown(TouchDoubt::Empty);
        }
        let doubt = if [block.normal_n, block.tangential_n].into_iter().any(absurd) {
            TouchDoubt::Force
        } else if block.direction_raw >= 360 && block.direction_raw != NO_DIRECTION {
            TouchDoubt::Direction
        } else if !block.check_ok() {
            TouchDoubt::Check
        } else {
            return Self::Capacitive;
        };
        let (words, _) = bytes.as_chunks::<2>();
        if words
            .iter()
            .all(|word| u16::from_le_bytes(*word) <= ZONE_MAX)
        {
            return Self::Resistive;
        }
        Self::Unknown(doubt)
    }
}

fn absurd(newtons: f32) -> bool {
    let size = newtons.abs();
    !(newtons == 0.0 || (FORCE_MIN_N..=TIP_FORCE_MAX_N).contains(&size))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block() -> TactileBlock {
        TactileBlock {
            raw: [2_900_000; 8],
            normal_n: 1.5,
            normal_delta: 900,
            tangential_n: 0.0,
            tangential_delta: -4,
            direction_raw: 271,
            proximity: 12,
            check: 0,
            sum: 0,
            reserved: [0; 2],
        }
    }

    #[test]
    fn fingertips_are_judged_by_their_bytes() {
        let with = |change: fn(&mut TactileBlock)| {
            let mut block = block();
            change(&mut block);
            block.encode().to_vec()
        };
        let mut wrong_sum = block().encode().to_vec();
        wrong_sum[54] ^= 1;
        let zones: Vec<u8> = (0..29u16).flat_map(|n| (n * 140).to_le_bytes()).collect();
        let unknown = TouchVariant::Unknown;
        for (bytes, variant) in [
            (with(|_| {}), TouchVariant::Capacitive),
            (
                with(|block| block.direction_raw = 65535),
                TouchVariant::Capacitive,
            ),
            (
                with(|block| block.normal_n = f32::NAN),
                unknown(TouchDoubt::Force),
            ),
            (
                with(|block| block.tangential_n = f32::INFINITY),
                unknown(TouchDoubt::Force),
            ),
            (
                with(|block| block.normal_n = 3e9),
                unknown(TouchDoubt::Force),
            ),
            (
                with(|block| block.direction_raw = 360),
                unknown(TouchDoubt::Direction),
            ),
            (wrong_sum, unknown(TouchDoubt::Check)),
            (zones, TouchVariant::Resistive),
            (vec![0; 58], unknown(TouchDoubt::Empty)),
            (vec![0; 57], unknown(TouchDoubt::Refused)),
        ] {
            assert_eq!(TouchVariant::judge(&bytes), variant, "{bytes:?}");
        }
    }
}
