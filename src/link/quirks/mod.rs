//! What one hand answers in its own way, where the manual leaves room. Plain values; asks nothing.

pub mod book;

use crate::hand::TactileBlock;
use crate::hand::feedback::tactile::BLOCK_LEN;
use crate::hand::register::BytePacking;

/// What was found about a hand when the link got to know it. `None` is what the wire does not ask, or the hand did not
/// answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
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
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
pub enum GapRead {
    /// It answers: one window holds the whole motion state.
    #[default]
    Through,
    /// It refuses: windows end before the gap and begin behind it.
    Split,
}

/// What the addresses from 3000 on hold, judged by their values: no register tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum TouchVariant {
    /// Five blocks of 58 bytes (manual 2.6.21).
    Capacitive,
    /// Zones of 16-bit words up to 4095, as the maker's other fingertips have.
    Resistive,
    /// Neither fits, and the reason.
    Unknown(TouchDoubt),
}

/// Why a tactile block tells no kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
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

/// What a code of REDU_RATIO means by this manual (2.6.2), bits a second; `None` for codes it does not explain.
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

/// Largest force that a fingertip is believed, newtons: five times what the sensor is rated for (manual 1.1).
const FORCE_MAX_N: f32 = 100.0;
/// Smallest force other than zero: what two small words of another layout look like as a number is far below.
const FORCE_MIN_N: f32 = 1e-6;
/// Largest word of the other layout.
const ZONE_MAX: u16 = 4095;
/// The word for "no direction".
const NO_DIRECTION: u16 = 65535;

impl TouchVariant {
    /// Judges by the bytes that begin where a fingertip's block begins, at least 58 of them.
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
    !(newtons == 0.0 || (FORCE_MIN_N..=FORCE_MAX_N).contains(&size))
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
