//! Modbus access to the simulated hand's memory, over a socket or a serial line (manual 2.4, 2.5). No framing.

use crate::hand::Span;
use crate::hand::register::{ERROR, Element, STATUS, TEMP, by_address};
use crate::sim::memory::AccessError;
use crate::sim::personality::{ByteWords, InnerAddress, LongRead, Personality, SingleReply};
use crate::sim::serve::shared::SharedHand;
use std::ops::RangeInclusive;

/// Most words of one read (manual 2.5, function 03).
const READ_WORDS_MAX: u16 = 125;
/// Most words of one write (manual 2.5, function 16).
const WRITE_WORDS_MAX: usize = 0x7B;
/// The network address, one byte per field (manual 2.6).
const ADDRESS: RangeInclusive<u16> = 1700..=1703;
/// Function code bit that marks an exception.
const EXCEPTION: u8 = 0x80;
const ILLEGAL_FUNCTION: u8 = 1;
const ILLEGAL_ADDRESS: u8 = 2;
const ILLEGAL_VALUE: u8 = 3;

/// Reason for a missing or negative reply.
enum No {
    Exception(u8),
    Silence,
}

impl From<AccessError> for No {
    fn from(refusal: AccessError) -> Self {
        match refusal {
            AccessError::Silent => Self::Silence,
            AccessError::Empty { .. } | AccessError::OutOfRange { .. } => {
                Self::Exception(ILLEGAL_VALUE)
            }
            AccessError::Unmapped { .. } | AccessError::Gap | AccessError::ReadOnly { .. } => {
                Self::Exception(ILLEGAL_ADDRESS)
            }
        }
    }
}

/// Reply of one hand to a request (function code and data) at its current time; `None` if it does not answer.
pub(crate) fn answer(hand: &SharedHand, request: &[u8]) -> Option<Vec<u8>> {
    let personality = hand.with(|hand, _| *hand.personality());
    let unit = Unit { hand, personality };
    let (function, body) = request.split_first()?;
    let done = match (function, body) {
        (3, [a, b, c, d]) => unit.read(word(*a, *b), word(*c, *d)),
        (6, [a, b, value @ ..]) if value.len() == 2 => unit.write_one(word(*a, *b), value),
        (16, [a, b, c, d, len, data @ ..])
            if usize::from(*len) == data.len() && data.len() == 2 * usize::from(word(*c, *d)) =>
        {
            unit.write_many(word(*a, *b), data)
        }
        (3 | 6 | 16, _) => Err(No::Exception(ILLEGAL_VALUE)),
        _ => Err(No::Exception(ILLEGAL_FUNCTION)),
    };
    match done {
        Ok(reply) => Some([&[*function][..], &reply].concat()),
        Err(No::Exception(code)) => Some(vec![function | EXCEPTION, code]),
        Err(No::Silence) => None,
    }
}

/// One hand while answering one request.
struct Unit<'a> {
    hand: &'a SharedHand,
    personality: Personality,
}

impl Unit<'_> {
    // Manual: 2.5 does not say how bytes become words; a word is byte[A] + 256 * byte[A + 1].
    fn read(&self, address: u16, count: u16) -> Result<Vec<u8>, No> {
        let count = match (count, self.personality.long_read) {
            (0, _) => return Err(No::Exception(ILLEGAL_VALUE)),
            (1..=READ_WORDS_MAX, _) => count,
            (_, LongRead::Exception) => return Err(No::Exception(ILLEGAL_VALUE)),
            (_, LongRead::Truncate) => READ_WORDS_MAX,
            (_, LongRead::Silence) => return Err(No::Silence),
        };
        let address = self.inner(address)?;
        let span = Span::new(address, 2 * count);
        let bytes = self.hand.with(|hand, now| hand.read(span, now))?;
        let data: Vec<u8> = if self.has_own_words(address) {
            let single = bytes.iter().take(usize::from(count));
            single.flat_map(|byte| [0, *byte]).collect()
        } else {
            let (pairs, _) = bytes.as_chunks::<2>();
            let at = (address..=u16::MAX).step_by(2);
            at.zip(pairs)
                .flat_map(|(at, pair)| self.swapped(at, *pair))
                .collect()
        };
        let len = u8::try_from(data.len()).unwrap_or(u8::MAX);
        Ok([&[len][..], &data].concat())
    }

    fn write_one(&self, address: u16, value: &[u8]) -> Result<Vec<u8>, No> {
        self.write(address, value)?;
        Ok(match self.personality.single_reply {
            SingleReply::Echo => [&address.to_be_bytes()[..], value].concat(),
            SingleReply::Zeros => vec![0; 4],
        })
    }

    fn write_many(&self, address: u16, data: &[u8]) -> Result<Vec<u8>, No> {
        let words = data.len() / 2;
        if !(1..=WRITE_WORDS_MAX).contains(&words) {
            return Err(No::Exception(ILLEGAL_VALUE));
        }
        self.write(address, data)?;
        let count = u16::try_from(words).unwrap_or_default();
        Ok([address.to_be_bytes(), count.to_be_bytes()].concat())
    }

    fn write(&self, address: u16, data: &[u8]) -> Result<(), No> {
        let address = self.inner(address)?;
        let Some(bytes) = self.memory_of(address, data) else {
            return Ok(());
        };
        self.hand.with(|hand, now| {
            let effect = hand.write_quietly(address, &bytes, now)?;
            if effect.is_acked {
                Ok(())
            } else {
                Err(No::Silence)
            }
        })
    }

    /// Memory bytes of written words; `None` for a word that is not a byte where one is required.
    fn memory_of(&self, address: u16, data: &[u8]) -> Option<Vec<u8>> {
        // Manual: 1000 to 1009 are adjacent single bytes, and so are 1700 to 1703; a word there is one of them.
        let single = (1000..=1009).contains(&address);
        match (data, self.personality.byte_words) {
            // The byte for this register lands in its neighbour.
            (_, ByteWords::HighFirst) => {}
            ([high, low], _) if single => return (*high == 0).then(|| vec![*low]),
            // One word addresses one field; two fields need two words.
            ([0, low], _) if ADDRESS.contains(&address) => return Some(vec![*low]),
            _ => {}
        }
        let (pairs, _) = data.as_chunks::<2>();
        let at = (address..=u16::MAX).step_by(2);
        Some(
            at.zip(pairs)
                .flat_map(|(at, pair)| self.swapped(at, *pair))
                .collect(),
        )
    }

    /// Converts between memory order and wire order, where the high byte of a word comes first.
    fn swapped(&self, at: u16, [first, second]: [u8; 2]) -> [u8; 2] {
        let is_byte = by_address(at).is_some_and(|row| row.element == Element::Byte);
        if is_byte && self.personality.byte_words == ByteWords::HighFirst {
            [first, second]
        } else {
            [second, first]
        }
    }

    fn has_own_words(&self, address: u16) -> bool {
        self.personality.byte_words == ByteWords::OnePerWord
            && [ERROR.address, STATUS.address, TEMP.address].contains(&address)
    }

    /// Address to which a request inside a group leads.
    fn inner(&self, address: u16) -> Result<u16, No> {
        let Some(row) = by_address(address).filter(|row| row.address != address) else {
            return Ok(address);
        };
        match self.personality.inner_address {
            InnerAddress::Byte => Ok(address),
            InnerAddress::Index => Ok(row.address.saturating_add(2 * (address - row.address))),
            InnerAddress::Exception => Err(No::Exception(ILLEGAL_ADDRESS)),
        }
    }
}

const fn word(high: u8, low: u8) -> u16 {
    u16::from_be_bytes([high, low])
}
