//! Contents and length of a Modbus PDU, for both sides (manual 2.4, 2.5). RTU and TCP add their own envelope.

use crate::hand::ModbusException;

/// Maximum number of memory bytes in one message: 125 words (manual 2.5.1).
const BYTES_MAX: u8 = 250;
/// Maximum number of bytes in one write: 123 words, by the standard.
const WRITTEN_MAX: u8 = 246;

/// Side of the conversation that sends a PDU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModbusRole {
    /// The side that sends requests: this program, or a client of the gateway.
    Client,
    /// The hand.
    Server,
}

/// Parsed PDU. Addresses are the manual's byte addresses; bytes are in wire order, high byte first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pdu<'a> {
    /// Request of function 03.
    Read {
        /// Address of the first byte.
        address: u16,
        /// Number of words.
        count: u16,
    },
    /// Reply to function 03.
    Words(&'a [u8]),
    /// Request or reply of function 06.
    WriteOne {
        /// Byte address in the hand's memory.
        address: u16,
        /// The word.
        value: u16,
    },
    /// Request of function 16.
    Write {
        /// Address of the first byte.
        address: u16,
        /// Announced number of words.
        count: u16,
        /// Words in wire order, high byte first.
        words: &'a [u8],
    },
    /// Reply to function 16.
    Written {
        /// Address of the first byte.
        address: u16,
        /// Number of words.
        count: u16,
    },
    /// The hand rejected the request.
    Exception {
        /// Function code of the request, without the top bit.
        function: u8,
        /// Exception code.
        code: u8,
    },
    /// A function that this hand does not support, or a PDU of the wrong length.
    Other {
        /// Function code of the request.
        function: u8,
    },
}

/// Builds the exception reply to this function.
pub const fn exception_reply(exception: ModbusException, function: u8) -> [u8; 2] {
    [function | 0x80, exception.code()]
}

/// Length of a PDU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Len {
    /// Total number of bytes, including the function code.
    Known(usize),
    /// More bytes are needed.
    Open,
    /// Not the start of a PDU of this side.
    None,
}

/// Returns the length of the PDU that begins here.
pub fn len(side: ModbusRole, pdu: &[u8]) -> Len {
    match (side, pdu) {
        (_, []) => Len::Open,
        (ModbusRole::Client, [3 | 6, ..]) | (ModbusRole::Server, [6 | 16, ..]) => Len::Known(5),
        (ModbusRole::Client, [16, rest @ ..]) => match rest.get(4) {
            None => Len::Open,
            Some(bytes) if is_words(*bytes, WRITTEN_MAX) => Len::Known(6 + usize::from(*bytes)),
            Some(_) => Len::None,
        },
        (ModbusRole::Server, [3]) => Len::Open,
        (ModbusRole::Server, [3, bytes, ..]) if is_words(*bytes, BYTES_MAX) => {
            Len::Known(2 + usize::from(*bytes))
        }
        (ModbusRole::Server, [0x83 | 0x86 | 0x90, ..]) => Len::Known(2),
        _ => Len::None,
    }
}

const fn is_words(bytes: u8, max: u8) -> bool {
    bytes.is_multiple_of(2) && bytes >= 2 && bytes <= max
}

/// Parses a whole PDU.
pub fn parse(side: ModbusRole, pdu: &[u8]) -> Pdu<'_> {
    let word = |high: &u8, low: &u8| u16::from_be_bytes([*high, *low]);
    match (side, pdu) {
        (ModbusRole::Client, [3, a, b, c, d]) => Pdu::Read {
            address: word(a, b),
            count: word(c, d),
        },
        (ModbusRole::Server, [3, len, words @ ..]) if usize::from(*len) == words.len() => {
            Pdu::Words(words)
        }
        (_, [6, a, b, c, d]) => Pdu::WriteOne {
            address: word(a, b),
            value: word(c, d),
        },
        (ModbusRole::Client, [16, a, b, c, d, len, words @ ..])
            if usize::from(*len) == words.len() =>
        {
            Pdu::Write {
                address: word(a, b),
                count: word(c, d),
                words,
            }
        }
        (ModbusRole::Server, [16, a, b, c, d]) => Pdu::Written {
            address: word(a, b),
            count: word(c, d),
        },
        (ModbusRole::Server, [function @ 0x80..=0xFF, code]) => Pdu::Exception {
            function: function & 0x7F,
            code: *code,
        },
        (_, [function, ..]) => Pdu::Other {
            function: *function,
        },
        (_, []) => Pdu::Other { function: 0 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manuals_messages_are_told_apart_and_measured() {
        // Manual 2.5.1 to 2.5.3 without header.
        for (side, bytes, expected) in [
            (
                ModbusRole::Client,
                &[3, 0x06, 0x0A, 0, 3][..],
                Pdu::Read {
                    address: 1546,
                    count: 3,
                },
            ),
            (
                ModbusRole::Server,
                &[3, 6, 2, 0x2B, 0, 0, 0, 0x64],
                Pdu::Words(&[2, 0x2B, 0, 0, 0, 0x64]),
            ),
            (
                ModbusRole::Client,
                &[6, 0x03, 0xED, 0, 1],
                Pdu::WriteOne {
                    address: 1005,
                    value: 1,
                },
            ),
            (
                ModbusRole::Client,
                &[16, 5, 0xCE, 0, 1, 2, 3, 0xE8],
                Pdu::Write {
                    address: 1486,
                    count: 1,
                    words: &[3, 0xE8],
                },
            ),
            (
                ModbusRole::Server,
                &[16, 5, 0xCE, 0, 1],
                Pdu::Written {
                    address: 1486,
                    count: 1,
                },
            ),
            (
                ModbusRole::Server,
                &[0x83, 2],
                Pdu::Exception {
                    function: 3,
                    code: 2,
                },
            ),
        ] {
            assert_eq!(parse(side, bytes), expected);
            assert_eq!(len(side, bytes), Len::Known(bytes.len()), "{bytes:?}");
        }
    }

    #[test]
    fn what_no_side_says_has_no_length() {
        assert_eq!(len(ModbusRole::Server, &[3, 7]), Len::None);
        assert_eq!(len(ModbusRole::Server, &[43]), Len::None);
        assert_eq!(len(ModbusRole::Client, &[0x83, 2]), Len::None);
        assert_eq!(len(ModbusRole::Client, &[16, 0, 0, 0, 1]), Len::Open);
        assert_eq!(
            parse(ModbusRole::Server, &[3, 4, 1, 2]),
            Pdu::Other { function: 3 }
        );
    }
}
