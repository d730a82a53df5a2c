//! Splits a stream into whole Modbus TCP messages (manual 2.5). Does not interpret their functions.

use arrayvec::ArrayVec;

/// Maximum length of a message: six header bytes and the 254 that its length field can count.
pub const ADU_LEN_MAX: usize = 260;
/// Capacity of the splitter's buffer: one message and the beginning of the next.
pub const BUFFER_LEN: usize = 2 * ADU_LEN_MAX;

/// Bytes before those that the length field counts.
const HEADER_LEN: usize = 6;
/// Unit and function.
const LENGTH_MIN: u16 = 2;
/// Unit, function and 252 bytes of data.
const LENGTH_MAX: u16 = 254;

/// One Modbus TCP message: header, unit and PDU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adu {
    /// Transaction id, which matches a reply to its request.
    pub transaction: u16,
    /// Unit id.
    pub unit: u8,
    /// All bytes, header included.
    pub bytes: ArrayVec<u8, ADU_LEN_MAX>,
}

impl Adu {
    /// Function code; the top bit marks an exception.
    pub fn function(&self) -> u8 {
        self.pdu().first().copied().unwrap_or_default()
    }

    /// PDU: function code and data.
    pub fn pdu(&self) -> &[u8] {
        self.bytes.get(HEADER_LEN + 1..).unwrap_or_default()
    }

    /// Builds a reply to this message from `unit`, with this PDU.
    pub fn reply(&self, unit: u8, pdu: &[u8]) -> Vec<u8> {
        let len = u16::try_from(pdu.len() + 1).unwrap_or(u16::MAX);
        let head = [self.transaction, 0, len].map(u16::to_be_bytes);
        [head.as_flattened(), &[unit], pdu].concat()
    }
}

/// Reason why the stream is not Modbus TCP. The splitter cannot resynchronise; the connection must be closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum MbapError {
    /// The protocol id is not 0.
    #[error("the other side does not speak Modbus TCP: protocol id {got} instead of 0")]
    Protocol {
        /// Value of the header's field as received.
        got: u16,
    },
    /// The length field is impossible.
    #[error("a Modbus TCP message says {got} bytes; possible are 2 to 254")]
    Length {
        /// Value of the header's field as received.
        got: u16,
    },
}

/// Splits a stream into messages, regardless of how it was split or merged in transit.
#[derive(Debug, Clone, Default)]
pub struct MbapSplitter {
    buffer: ArrayVec<u8, BUFFER_LEN>,
}

impl MbapSplitter {
    /// Accepts received bytes and returns how many fit. Push the rest again after [`Self::next`] returned `Ok(None)`.
    pub fn push(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(self.buffer.remaining_capacity());
        self.buffer.extend(bytes.iter().take(taken).copied());
        taken
    }

    /// Returns the next whole message; `None` if more bytes are needed.
    ///
    /// # Errors
    /// An invalid header, as soon as it is seen, and again at each further call: the connection must be closed.
    #[expect(
        clippy::should_implement_trait,
        reason = "None is not the end: more may come after a push"
    )]
    pub fn next(&mut self) -> Result<Option<Adu>, MbapError> {
        let field = |at: usize| match self.buffer.get(at..at + 2) {
            Some(&[high, low]) => Some(u16::from_be_bytes([high, low])),
            _ => None,
        };
        if let Some(got) = field(2).filter(|protocol| *protocol != 0) {
            return Err(MbapError::Protocol { got });
        }
        let (Some(transaction), Some(length)) = (field(0), field(4)) else {
            return Ok(None);
        };
        if !(LENGTH_MIN..=LENGTH_MAX).contains(&length) {
            return Err(MbapError::Length { got: length });
        }
        let total = HEADER_LEN + usize::from(length);
        let unit = self.buffer.get(HEADER_LEN).copied();
        let (Some(unit), true) = (unit, self.buffer.len() >= total) else {
            return Ok(None);
        };
        let bytes = self.buffer.drain(..total).collect();
        Ok(Some(Adu {
            transaction,
            unit,
            bytes,
        }))
    }

    /// Discards all buffered bytes, for a new connection.
    pub fn clear(&mut self) {
        self.buffer.clear();
    }

    /// Buffered bytes of an incomplete message.
    pub const fn buffered(&self) -> usize {
        self.buffer.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The manual's read of 2.5.1 and its reply, with a header each.
    const READ: [u8; 12] = [0, 7, 0, 0, 0, 6, 0xFF, 3, 0x00, 0x6B, 0x00, 0x03];
    const REPLY: [u8; 15] = [
        0, 8, 0, 0, 0, 9, 0xFF, 3, 6, 0x02, 0x2B, 0x00, 0x00, 0x00, 0x64,
    ];

    fn split(stream: &[u8], piece: usize) -> Result<Vec<Adu>, MbapError> {
        let mut splitter = MbapSplitter::default();
        let mut out = Vec::new();
        for mut chunk in stream.chunks(piece) {
            while !chunk.is_empty() {
                chunk = &chunk[splitter.push(chunk)..];
                while let Some(adu) = splitter.next()? {
                    out.push(adu);
                }
                assert!(splitter.buffered() < ADU_LEN_MAX);
            }
        }
        Ok(out)
    }

    #[test]
    fn messages_come_out_whole_however_they_were_cut() {
        let stream = [READ.as_slice(), &REPLY, &READ].concat();
        for piece in 1..=stream.len() {
            let adus = split(&stream, piece).unwrap();
            let seen: Vec<_> = adus
                .iter()
                .map(|adu| (adu.transaction, adu.unit, adu.function()))
                .collect();
            assert_eq!(seen, [(7, 0xFF, 3), (8, 0xFF, 3), (7, 0xFF, 3)]);
            assert_eq!(adus[1].bytes.as_slice(), REPLY);
            assert_eq!(adus[1].reply(0xFF, adus[1].pdu()), REPLY);
        }
    }

    #[test]
    fn a_foreign_protocol_is_an_error_at_once_and_stays_one() {
        let mut splitter = MbapSplitter::default();
        splitter.push(b"HTTP");
        let error = MbapError::Protocol { got: 0x5450 };
        assert_eq!(splitter.next(), Err(error));
        splitter.push(&READ);
        assert_eq!(splitter.next(), Err(error));
        splitter.clear();
        splitter.push(&READ);
        assert_eq!(splitter.next().unwrap().unwrap().transaction, 7);
    }

    #[test]
    fn impossible_lengths_are_errors_and_the_longest_is_not() {
        for got in [0, 1, 255, u16::MAX] {
            let [high, low] = got.to_be_bytes();
            assert_eq!(
                split(&[0, 0, 0, 0, high, low], 6),
                Err(MbapError::Length { got })
            );
        }
        let mut longest = vec![0, 1, 0, 0, 0, 254];
        longest.resize(ADU_LEN_MAX, 3);
        assert_eq!(split(&longest.repeat(4), 1000).unwrap().len(), 4);
    }

    proptest! {
        #[test]
        fn random_bytes_never_panic(stream in prop::collection::vec(0..4u8, 0..900), piece in 1..300usize) {
            let whole = split(&stream, stream.len().max(1));
            prop_assert_eq!(split(&stream, piece), whole);
        }
    }
}
