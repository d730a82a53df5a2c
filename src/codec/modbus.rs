//! Converts between bytes in the hand's memory and Modbus' 16-bit words (manual 2.5). No framing, no sending.

use crate::hand::register::{BytePacking, Element, by_address};
use crate::hand::{RegisterWrite, Span};
use arrayvec::ArrayVec;

/// Maximum number of words in one read (manual 2.5.1).
pub const READ_WORDS_MAX: u16 = 125;
/// Number of joints, and so of elements in the one-byte groups.
const GROUP_LEN: usize = 6;

/// The bytes of one read.
pub type WordBytes = ArrayVec<u8, 250>;

/// A range of 16-bit words of a Modbus request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WordSpan {
    /// Byte address of the first word, as in the manual.
    pub address: u16,
    /// Number of words.
    pub count: u16,
}

/// Returns the words that cover these bytes; an odd length is rounded up.
pub const fn words_for(span: Span) -> WordSpan {
    // Manual: 2.5 does not define the address unit; drivers of real hands use bytes, two per word.
    WordSpan {
        address: span.address,
        count: span.len.div_ceil(2),
    }
}

/// Returns the memory bytes of the words that begin at `address`; words past [`READ_WORDS_MAX`] are ignored.
///
/// The low byte comes first, except in byte registers with [`BytePacking::HighFirst`]. For words packed as [`BytePacking::OnePerWord`]
/// use [`group_bytes`].
pub fn bytes_from_words(address: u16, words: &[u16], packing: BytePacking) -> WordBytes {
    let addresses = (0u16..).map(|nth| address.saturating_add(2 * nth));
    words
        .iter()
        .take(usize::from(READ_WORDS_MAX))
        .zip(addresses)
        .flat_map(|(word, at)| match packing {
            BytePacking::HighFirst if holds_bytes(at) => word.to_be_bytes(),
            _ => word.to_le_bytes(),
        })
        .collect()
}

fn holds_bytes(address: u16) -> bool {
    by_address(address).is_some_and(|row| row.element == Element::Byte)
}

/// A write in Modbus terms.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ModbusWrite {
    /// Function 6 (manual 2.5.2), for one-byte registers: the value at its byte address.
    Single {
        /// Byte address in the hand's memory.
        address: u16,
        /// Byte value, 0..=255.
        value: u16,
    },
    /// Function 16 (manual 2.5.3).
    Multiple {
        /// Byte address of the first word.
        address: u16,
        /// One to six words.
        words: ArrayVec<u16, 6>,
    },
}

/// Returns the Modbus form of a write: function 6 for one byte, function 16 for words.
pub fn words_from_write(write: &RegisterWrite) -> ModbusWrite {
    let address = write.address();
    match write.bytes() {
        [value] => ModbusWrite::Single {
            address,
            value: u16::from(*value),
        },
        bytes => {
            let (pairs, odd) = bytes.as_chunks::<2>();
            debug_assert!(odd.is_empty(), "longer writes are whole words");
            ModbusWrite::Multiple {
                address,
                words: pairs
                    .iter()
                    .map(|pair| u16::from_le_bytes(*pair))
                    .take(GROUP_LEN)
                    .collect(),
            }
        }
    }
}

/// Detects the packing from the word at HAND_ID and six words at TEMP; `None` if they match no packing, or more than one.
///
/// Temperatures distinguish packed words from one byte per word. The id, whose neighbour 1001 is unused, shows the byte order: hand 1
/// reads as 1 or 256.
pub fn detect_packing(word_at_id: u16, words_at_temp: &[u16; 6]) -> Option<BytePacking> {
    let [first, second, third, behind @ ..] = words_at_temp;
    let small = words_at_temp.iter().all(|word| *word <= 0xFF);
    if small && *first != 0 && behind.iter().all(|word| *word != 0) {
        return Some(BytePacking::OnePerWord);
    }
    let packed = [first, second, third].iter().any(|word| **word > 0xFF);
    match word_at_id.to_le_bytes() {
        [1..=254, 0] if packed => Some(BytePacking::LowFirst),
        [0, 1..=254] if packed => Some(BytePacking::HighFirst),
        _ => None,
    }
}

/// Number of words that hold a group of six bytes.
pub const fn words_per_group(packing: BytePacking) -> u16 {
    match packing {
        BytePacking::LowFirst | BytePacking::HighFirst => 3,
        BytePacking::OnePerWord => 6,
    }
}

/// Returns the six bytes of a group from the words that begin at its address; `None` if there are too few words, or if a word of
/// [`BytePacking::OnePerWord`] exceeds 255.
pub fn group_bytes(packing: BytePacking, words: &[u16]) -> Option<[u8; GROUP_LEN]> {
    let words = words.get(..usize::from(words_per_group(packing)))?;
    let bytes: ArrayVec<u8, GROUP_LEN> = match packing {
        BytePacking::LowFirst => words.iter().flat_map(|word| word.to_le_bytes()).collect(),
        BytePacking::HighFirst => words.iter().flat_map(|word| word.to_be_bytes()).collect(),
        BytePacking::OnePerWord => words
            .iter()
            .map(|word| u8::try_from(*word).ok())
            .collect::<Option<_>>()?,
    };
    bytes.into_inner().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register::{STATE, TEMP};
    use crate::hand::{Angle, HandCommand, HandId, PerDof, Setting, Target, Trigger, Writes};

    #[test]
    fn spans_become_words_at_the_byte_address() {
        for (span, address, count) in [
            (STATE, 1546, 39),
            (TEMP.span(), 1618, 3),
            (Span::new(1005, 1), 1005, 1),
            (Span::new(3000, 58), 3000, 29),
            (Span::new(1000, 0), 1000, 0),
            (Span::new(0, u16::MAX), 0, 32_768),
        ] {
            assert_eq!(words_for(span), WordSpan { address, count });
        }
    }

    #[test]
    fn words_of_the_manuals_read_become_memory_bytes() {
        // Manual 2.5.1: 02 2B, 00 00, 00 64 on the wire are 555, 0, 100.
        let bytes = bytes_from_words(1546, &[555, 0, 100], BytePacking::LowFirst);
        assert_eq!(bytes.as_slice(), [0x2B, 0x02, 0x00, 0x00, 0x64, 0x00]);
        let many = bytes_from_words(0, &[1; 126], BytePacking::LowFirst);
        assert_eq!(many.len(), 250);
        // High byte first: CURRENT ends at 1605, ERROR begins at 1606.
        let bytes = bytes_from_words(1604, &[0x0102, 0x0304], BytePacking::HighFirst);
        assert_eq!(bytes.as_slice(), [2, 1, 3, 4]);
    }

    #[test]
    fn one_byte_registers_are_written_by_function_6() {
        let id = Setting::Id(HandId::new(254).unwrap()).writes();
        for (writes, address, value) in [
            (Writes::from_iter([Trigger::Save.write()]), 1005, 1),
            (HandCommand::ClearErrors.writes(), 1004, 1),
            (id, 1000, 254),
        ] {
            assert_eq!(
                words_from_write(&writes[0]),
                ModbusWrite::Single { address, value }
            );
        }
    }

    #[test]
    fn the_ip_address_is_two_words_low_byte_first() {
        let writes = Setting::IpAddress([192, 168, 11, 210].into()).writes();
        let words = ArrayVec::from_iter([0xA8C0, 0xD20B]);
        let address = 1700;
        assert_eq!(
            words_from_write(&writes[0]),
            ModbusWrite::Multiple { address, words }
        );
    }

    #[test]
    fn six_angles_are_six_words() {
        let mut targets = PerDof::splat(Some(Target::Go(Angle::MAX)));
        targets[crate::hand::Dof::Little] = Some(Target::Leave);
        let writes = HandCommand::Angles(targets).writes();
        let words = ArrayVec::from([0xFFFF, 1000, 1000, 1000, 1000, 1000]);
        assert_eq!(
            words_from_write(&writes[0]),
            ModbusWrite::Multiple {
                address: 1486,
                words
            }
        );
    }

    #[test]
    fn packing_is_detected_by_temperatures() {
        use BytePacking::{HighFirst, LowFirst, OnePerWord};
        let packed = [0x2A28, 0x2628, 0x2828, 0, 0, 0];
        // One row is a record of a real hand: 40, 42, 40, 38, 40, 40, one a word.
        for (id, words, packing) in [
            (1, [40, 42, 40, 38, 40, 40], Some(OnePerWord)),
            (0x0100, [40, 42, 40, 38, 40, 40], Some(OnePerWord)),
            (1, packed, Some(LowFirst)),
            (254, packed, Some(LowFirst)),
            (0x0100, packed, Some(HighFirst)),
            // The maker's own word for "no temperature".
            (1, [0xFFFF, 0xFFFF, 0xFFFF, 0, 0, 0], Some(LowFirst)),
            // Joints at 40, 0, 42, 0, 40, 0 degrees, or three joints at 0: both read like this.
            (1, [40, 42, 40, 0, 0, 0], None),
            (1, [40, 42, 40, 38, 0, 40], None),
            (1, [40, 42, 40, 38, 40, 256], None),
            (1, [0; 6], None),
            // No id tells the order of bytes here.
            (0, packed, None),
            (0x0101, packed, None),
            (255, packed, None),
        ] {
            assert_eq!(detect_packing(id, &words), packing, "{id} {words:?}");
        }
    }

    #[test]
    fn each_packing_gives_the_same_six_bytes() {
        let six = [30, 31, 32, 33, 34, 35];
        for (packing, words) in [
            (BytePacking::LowFirst, &[0x1F1E, 0x2120, 0x2322][..]),
            (BytePacking::HighFirst, &[0x1E1F, 0x2021, 0x2223]),
            (BytePacking::OnePerWord, &[30, 31, 32, 33, 34, 35]),
        ] {
            assert_eq!(group_bytes(packing, words), Some(six));
            assert_eq!(group_bytes(packing, &words[1..]), None);
        }
        assert_eq!(
            group_bytes(BytePacking::OnePerWord, &[1, 2, 3, 4, 5, 256]),
            None
        );
    }
}
