//! Single bytes over Modbus, whose packing the manual leaves undefined: splits reads into pieces, and decides which
//! writes are safe. Sends nothing itself.

use crate::hand::register::BytePacking;
use crate::hand::register::{ERROR, Element, STATUS, TEMP, by_address};
use crate::hand::{Refusal, RegisterWrite, Span};
use crate::link::bus::error::BusError;
use crate::transport::Endpoint;
use arrayvec::ArrayVec;

/// The groups of single bytes: ERROR, STATUS, TEMP, at consecutive addresses.
const BYTE_GROUPS: [Span; 3] = [ERROR.span(), STATUS.span(), TEMP.span()];
/// Maximum pieces of a read: each group, and the parts before, between and after.
const PIECES_MAX: usize = 5;

/// A part of a read that is one request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ReadPiece {
    /// Two bytes per word.
    Memory(Span),
    /// The requested bytes of a group of six with one byte per word.
    Group {
        group: Span,
        skip: usize,
        take: usize,
    },
}

/// Byte packing of one bus: chosen by the user, and detected from the hand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WordUse {
    chosen: Option<BytePacking>,
    pub(crate) found: Option<BytePacking>,
}

impl WordUse {
    pub(crate) fn new(endpoint: &Endpoint) -> Self {
        Self {
            chosen: chosen(endpoint),
            found: None,
        }
    }

    /// Packing used for reads; if unknown, that of most hands.
    pub(crate) fn reading(&self) -> BytePacking {
        self.chosen.or(self.found).unwrap_or_default()
    }

    /// The requests that a read needs.
    pub(crate) fn pieces(&self, span: Span) -> ArrayVec<ReadPiece, PIECES_MAX> {
        let mut pieces = ArrayVec::new();
        if self.reading() != BytePacking::OnePerWord {
            pieces.push(ReadPiece::Memory(span));
            return pieces;
        }
        let mut at = span.address;
        for group in BYTE_GROUPS {
            if u32::from(at) >= span.end() || group.end() <= u32::from(at) {
                continue;
            }
            if at < group.address {
                let until = group.address.min(end(span));
                pieces.push(ReadPiece::Memory(Span::new(at, until - at)));
                at = until;
            }
            if u32::from(at) < span.end() {
                let until = end(group).min(end(span));
                pieces.push(ReadPiece::Group {
                    group,
                    skip: usize::from(at - group.address),
                    take: usize::from(until - at),
                });
                at = until;
            }
        }
        if u32::from(at) < span.end() {
            pieces.push(ReadPiece::Memory(Span::new(at, end(span) - at)));
        }
        pieces
    }

    /// Refuses writes of single bytes where they could change a neighbour: SAVE is next to RESET_PARA. They are
    /// permitted only if the hand was detected to put the low byte first, or could not be judged and the user says so.
    pub(crate) fn allows(&self, write: &RegisterWrite) -> Result<(), BusError> {
        if !is_bytes(write) {
            return Ok(());
        }
        let reason = match (self.chosen, self.found) {
            (None | Some(BytePacking::LowFirst), Some(BytePacking::LowFirst))
            | (Some(BytePacking::LowFirst), None) => return Ok(()),
            (None, None) => Refusal::PackingUnknown,
            (None, Some(BytePacking::OnePerWord | BytePacking::HighFirst))
            | (Some(BytePacking::OnePerWord | BytePacking::HighFirst), _)
            | (Some(BytePacking::LowFirst), Some(_)) => Refusal::PackingUnsafe,
        };
        Err(BusError::Refused { reason })
    }
}

/// The packing that the user chose in the endpoint.
pub(crate) fn chosen(endpoint: &Endpoint) -> Option<BytePacking> {
    match endpoint {
        Endpoint::Tcp { packing, .. } => *packing,
        Endpoint::Rtu(line) | Endpoint::RtuTcp(line) => line.packing,
        _ => None,
    }
}

/// One past the last byte, which is below 65536 for every span that Modbus can address.
fn end(span: Span) -> u16 {
    u16::try_from(span.end()).unwrap_or(u16::MAX)
}

/// True if the write goes to registers of single bytes.
fn is_bytes(write: &RegisterWrite) -> bool {
    by_address(write.address()).is_some_and(|row| row.element == Element::Byte)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register::STATE;
    use crate::hand::{HandCommand, Setting, Trigger};

    fn word_use(endpoint: &str, found: Option<BytePacking>) -> WordUse {
        let mut word_use = WordUse::new(&endpoint.parse().unwrap());
        word_use.found = found;
        word_use
    }

    #[test]
    fn single_bytes_are_written_only_where_the_low_byte_is_known_to_come_first() {
        use BytePacking::{HighFirst, LowFirst, OnePerWord};
        for (endpoint, found, allowed) in [
            ("tcp:h", Some(LowFirst), true),
            ("rtu:p", Some(LowFirst), true),
            ("tcp:h", None, false),
            ("tcp:h", Some(OnePerWord), false),
            ("rtu:p", Some(HighFirst), false),
            ("tcp:h?packing=low", None, true),
            ("tcp:h?packing=low", Some(LowFirst), true),
            ("rtu:p?packing=low", Some(OnePerWord), false),
            ("tcp:h?packing=low", Some(HighFirst), false),
            ("tcp:h?packing=high", Some(LowFirst), false),
            ("tcp:h?packing=high", None, false),
            ("rtu:p?packing=one", None, false),
        ] {
            let word_use = word_use(endpoint, found);
            for write in [
                Trigger::Save.write(),
                HandCommand::ClearErrors.writes().remove(0),
                Setting::IpAddress([192, 168, 11, 211].into())
                    .writes()
                    .remove(0),
            ] {
                let result = word_use.allows(&write);
                assert_eq!(result.is_ok(), allowed, "{endpoint} {found:?} {write:?}");
            }
            let speeds = HandCommand::Speeds(crate::hand::PerDof::splat(None));
            for write in speeds.writes() {
                assert_eq!(word_use.allows(&write), Ok(()), "words of two bytes pass");
            }
        }
    }

    #[test]
    fn a_read_of_one_byte_a_word_falls_into_groups_and_covers_all() {
        let word_use = word_use("tcp:h", Some(BytePacking::OnePerWord));
        for span in [STATE, TEMP.span(), Span::new(1607, 12), Span::new(1000, 4)] {
            let mut at = span.address;
            for piece in word_use.pieces(span) {
                let (from, len) = match piece {
                    ReadPiece::Memory(part) => (part.address, usize::from(part.len)),
                    ReadPiece::Group { group, skip, take } => {
                        (group.address + u16::try_from(skip).unwrap(), take)
                    }
                };
                assert_eq!(from, at, "{span:?}");
                at += u16::try_from(len).unwrap();
            }
            assert_eq!(u32::from(at), span.end());
        }
        assert_eq!(word_use.pieces(STATE).len(), 4);
    }

    #[test]
    fn a_person_decides_how_words_are_read() {
        let found = Some(BytePacking::LowFirst);
        let high = word_use("tcp:h?packing=high", found);
        assert_eq!(high.reading(), BytePacking::HighFirst);
        assert_eq!(word_use("tcp:h", None).reading(), BytePacking::LowFirst);
        assert_eq!(
            word_use("rtu:p", Some(BytePacking::OnePerWord)).reading(),
            BytePacking::OnePerWord
        );
    }
}
