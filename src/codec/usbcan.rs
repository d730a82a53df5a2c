//! The packets of the maker's own USB-CAN adapter, identical in both directions. No port, no clock.
//!
//! Known from the maker's public CAN demos and from records of a hand behind such an adapter: `AA AA`, the identifier (4 bytes, low byte
//! first), 8 data bytes of which the first `length` are valid, the length, `00 01 00`, the sum of all these, `55 55`; from the adapter,
//! AA, 55 and A5 between head and tail are escaped by a preceding A5; the serial side runs at 115200 bit/s. Robotell adapters, which
//! python-can supports, use the same packets; there the three bytes are the channel (FF: the adapter's own settings), 29 or 11 bits, and
//! data or remote frame, and both directions are escaped.
//!
//! Not known: whether the maker's adapter accepts settings at all, such as a bit rate; its report when the bus rejects a frame; and
//! whether it requires escaping: the demos do not escape, so both forms are accepted here. Settings are never sent.

use crate::codec::NoiseCounts;
use crate::codec::can::{CanData, CanFrame};
use arrayvec::ArrayVec;

/// Maximum length of a packet: every byte between head and tail escaped.
pub const PACKET_MAX: usize = 2 * AROUND + 2 * BODY;
/// Length of a packet without escapes.
pub const PACKET_MIN: usize = 2 * AROUND + BODY;

/// Length of the head or the tail.
const AROUND: usize = 2;
/// Identifier, data, length, channel, bits, kind, sum.
const BODY: usize = 17;
const HEAD: u8 = 0xAA;
const TAIL: u8 = 0x55;
/// Escape byte before a data byte that equals head, tail or the escape itself.
const ESCAPE: u8 = 0xA5;
/// Channel of the adapter's own settings.
const SETTINGS: u8 = 0xFF;
/// Kind byte of a 29-bit identifier, and of a data frame.
const LONG_ID: u8 = 1;
const DATA: u8 = 0;

/// A packet ready to send.
pub type Packet = ArrayVec<u8, PACKET_MAX>;

/// Content of a packet from the adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PacketContent {
    /// A data frame with a 29-bit identifier.
    Frame(CanFrame),
    /// Any other well-formed packet: 11-bit and remote frames, the adapter's settings.
    Other,
}

/// Result of [`inspect`]: interpretation of the leading bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PacketStart {
    /// A valid packet of this many bytes.
    Packet(usize, PacketContent),
    /// A packet with a wrong checksum.
    BadSum {
        /// Length in bytes.
        len: usize,
        /// Received checksum.
        got: u8,
        /// Checksum computed over the packet.
        want: u8,
    },
    /// Too few bytes to decide.
    Open,
    /// Not the start of a packet.
    Nothing,
}

/// Builds the packet that carries a frame.
pub fn encode(frame: &CanFrame) -> Packet {
    let len = u8::try_from(frame.data.len()).unwrap_or_default();
    let data = frame.data.iter().copied().chain(std::iter::repeat(0));
    let mut body: ArrayVec<u8, BODY> = frame.id.to_le_bytes().into_iter().collect();
    body.extend(data.take(8).chain([len, 0, LONG_ID, DATA]));
    body.push(sum(&body));
    let mut packet = Packet::from_iter([HEAD, HEAD]);
    for byte in body {
        if is_special(byte) {
            packet.push(ESCAPE);
        }
        packet.push(byte);
    }
    packet.extend([TAIL, TAIL]);
    packet
}

/// Inspects the leading bytes for a packet, escaped or not.
pub fn inspect(bytes: &[u8]) -> PacketStart {
    let rest = match bytes {
        [] | [HEAD] => return PacketStart::Open,
        [HEAD, HEAD, rest @ ..] => rest,
        _ => return PacketStart::Nothing,
    };
    if let Some((body, [TAIL, TAIL, ..])) = rest.split_first_chunk::<BODY>()
        && let PacketStart::Packet(_, content) = judged(PACKET_MIN, body)
    {
        return PacketStart::Packet(PACKET_MIN, content);
    }
    match unescaped(rest) {
        Ok(Some((body, len))) => judged(len + 2 * AROUND, &body),
        Ok(None) => PacketStart::Open,
        Err(NoBody) if rest.len() < BODY + AROUND => PacketStart::Open,
        Err(NoBody) => PacketStart::Nothing,
    }
}

/// Error for bytes that cannot continue the packet.
struct NoBody;

/// Returns the unescaped body and the number of bytes that it occupies; `None` if it is incomplete.
fn unescaped(bytes: &[u8]) -> Result<Option<([u8; BODY], usize)>, NoBody> {
    let (mut body, mut len) = (ArrayVec::<u8, BODY>::new(), 0);
    for (taken, byte) in split_escapes(bytes).take(BODY) {
        if taken == 1 && is_special(byte) {
            let is_open = byte == ESCAPE && len + 1 == bytes.len();
            return if is_open { Ok(None) } else { Err(NoBody) };
        }
        body.push(byte);
        len += taken;
    }
    match (body.into_inner(), bytes.get(len..)) {
        (Ok(body), Some([TAIL, TAIL, ..])) => Ok(Some((body, len))),
        (Ok(_), Some([] | [TAIL])) | (Err(_), _) => Ok(None),
        _ => Err(NoBody),
    }
}

/// Yields each byte with the number of bytes that it occupies: two if it was escaped.
pub fn split_escapes(mut bytes: &[u8]) -> impl Iterator<Item = (usize, u8)> {
    std::iter::from_fn(move || {
        let (taken, byte, after) = match bytes {
            [ESCAPE, byte, after @ ..] if is_special(*byte) => (2, *byte, after),
            [byte, after @ ..] => (1, *byte, after),
            [] => return None,
        };
        bytes = after;
        Some((taken, byte))
    })
}

fn judged(len: usize, body: &[u8; BODY]) -> PacketStart {
    let [a, b, c, d, data @ .., count, channel, bits, kind, got] = body;
    let want = sum(body.split_last().map_or(&[], |(_, summed)| summed));
    if *got != want {
        return PacketStart::BadSum {
            len,
            got: *got,
            want,
        };
    }
    let id = u32::from_le_bytes([*a, *b, *c, *d]);
    let data = data.get(..usize::from(*count)).map(CanData::try_from);
    PacketStart::Packet(
        len,
        match (data, *channel != SETTINGS, *bits, *kind) {
            (Some(Ok(data)), true, LONG_ID, DATA) if id <= 0x1FFF_FFFF => {
                PacketContent::Frame(CanFrame { id, data })
            }
            _ => PacketContent::Other,
        },
    )
}

fn sum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum.wrapping_add(*byte))
}

/// True for a byte that must be escaped.
const fn is_special(byte: u8) -> bool {
    matches!(byte, HEAD | TAIL | ESCAPE)
}

/// Decodes packets of either direction.
#[derive(Debug, Clone, Default)]
pub struct PacketDecoder {
    buffer: Packet,
    /// True within a run of skipped bytes, which counts once.
    skipping: bool,
    counts: NoiseCounts,
}

impl PacketDecoder {
    /// Accepts the next byte; returns the packet that it completes.
    pub fn push(&mut self, byte: u8) -> Option<PacketContent> {
        if self.buffer.is_full() {
            self.skip();
        }
        self.buffer.push(byte);
        loop {
            match inspect(&self.buffer) {
                PacketStart::Packet(len, content) => {
                    self.buffer.drain(..len);
                    self.skipping = false;
                    return Some(content);
                }
                PacketStart::Open => return None,
                PacketStart::BadSum { .. } => {
                    self.counts.checksum_errors += 1;
                    self.skip();
                }
                PacketStart::Nothing => self.skip(),
            }
        }
    }

    /// Errors met so far.
    pub const fn counts(&self) -> NoiseCounts {
        self.counts
    }

    /// Skips only one byte: the next packet may begin inside an apparent one.
    fn skip(&mut self) {
        self.counts.resyncs += u64::from(!self.skipping);
        self.counts.skipped_bytes += 1;
        self.skipping = true;
        self.buffer.remove(0);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]
    use super::*;
    use crate::codec::can;
    use crate::hand::Span;
    use proptest::prelude::*;

    fn hex(text: &str) -> Vec<u8> {
        let bytes = text.split_whitespace();
        bytes
            .map(|byte| u8::from_str_radix(byte, 16).unwrap())
            .collect()
    }

    fn frame(id: u32, data: &[u8]) -> PacketContent {
        PacketContent::Frame(CanFrame {
            id,
            data: CanData::try_from(data).unwrap(),
        })
    }

    fn read(bytes: &[u8]) -> (Vec<PacketContent>, NoiseCounts) {
        let mut decoder = PacketDecoder::default();
        let found = bytes
            .iter()
            .filter_map(|byte| decoder.push(*byte))
            .collect();
        (found, decoder.counts())
    }

    /// ANGLE_ACT(3) of hand 1 and its answer 969, as a hand gave it; its sum is 55.
    const ASKED: &str = "AA AA 01 00 84 01 02 00 00 00 00 00 00 00 01 00 01 00 8A 55 55";
    const ANSWERED: &str = "AA AA 01 00 84 01 C9 03 00 00 00 00 00 00 02 00 01 00 A5 55 55 55";

    #[test]
    fn the_packets_of_a_real_hand_and_of_the_makers_demos_are_understood() {
        for (text, content) in [
            (ASKED, frame(0x0184_0001, &[2])),
            (ANSWERED, frame(0x0184_0001, &[0xC9, 3])),
            // 500 to ANGLE_SET(0), the rest as padding that counts, and the hand's answer to it.
            (
                "AA AA 01 80 73 05 F4 01 FF FF FF FF FF FF 08 00 01 00 F1 55 55",
                frame(0x0573_8001, &[0xF4, 1, 255, 255, 255, 255, 255, 255]),
            ),
            (
                "AA AA 01 80 73 05 08 00 00 00 00 00 00 00 01 00 01 00 03 55 55",
                frame(0x0573_8001, &[8]),
            ),
            // A sum of 55, and data of AA, 55 and A5, as the demos send them.
            (
                "AA AA 01 00 84 01 C9 03 00 00 00 00 00 00 02 00 01 00 55 55 55",
                frame(0x0184_0001, &[0xC9, 3]),
            ),
            (
                "AA AA 01 00 75 05 AA 55 A5 55 00 00 00 00 04 00 01 00 79 55 55",
                frame(0x0575_0001, &[0xAA, 0x55, 0xA5, 0x55]),
            ),
            // 11 bits, a remote frame, a setting (1 Mbit/s, as Robotell's adapters take it), a length of 9.
            (
                "AA AA 23 01 00 00 00 00 00 00 00 00 00 00 01 00 00 00 25 55 55",
                PacketContent::Other,
            ),
            (
                "AA AA 01 00 84 01 00 00 00 00 00 00 00 00 01 00 01 01 89 55 55",
                PacketContent::Other,
            ),
            (
                "AA AA D0 FE FF 01 40 42 0F 00 00 00 00 00 04 FF 01 00 63 55 55",
                PacketContent::Other,
            ),
            (
                "AA AA 01 00 84 01 00 00 00 00 00 00 00 00 09 00 01 00 90 55 55",
                PacketContent::Other,
            ),
        ] {
            let (found, noise) = read(&hex(text));
            assert_eq!(
                (found, noise),
                (vec![content], NoiseCounts::default()),
                "{text}"
            );
        }
    }

    #[test]
    fn what_is_sent_are_the_bytes_that_worked() {
        let ask = can::read_request(1, Span::new(1552, 2)).unwrap();
        assert_eq!(encode(&ask)[..], hex(ASKED)[..]);
        let answer = can::frame(can::CanFunction::Read, 1, 1552, &[0xC9, 3]).unwrap();
        assert_eq!(encode(&answer)[..], hex(ANSWERED)[..]);
        let all = can::frame(can::CanFunction::Write, 0xAA, 1492, &[0x55; 8]).unwrap();
        assert!(encode(&all).len() <= PACKET_MAX);
    }

    #[test]
    fn packets_come_out_of_glued_cut_and_damaged_streams() {
        let (ask, answer) = (hex(ASKED), hex(ANSWERED));
        let good = [frame(0x0184_0001, &[2]), frame(0x0184_0001, &[0xC9, 3])];
        let (found, noise) = read(&[&ask[..], &answer].concat());
        assert_eq!((&found[..], noise), (&good[..], NoiseCounts::default()));
        let mut bad_sum = ask.clone();
        bad_sum[6] ^= 1;
        let mut no_tail = ask.clone();
        no_tail[20] = 0;
        for (noise, sums) in [
            (&b"\x00\xFF"[..], 0),
            (b"\xAA", 0),
            (b"\xAA\xAA", 0),
            (b"\xAA\xAA\xA5", 0),
            (b"\xAA\xAA\x01\x00\x84", 0),
            (&answer[..20], 0),
            (&ask[5..], 0),
            (&bad_sum, 1),
            (&no_tail, 0),
            (&[0x11; 300], 0),
            (&[HEAD; 300], 0),
        ] {
            let (found, counts) = read(&[noise, &ask, &answer].concat());
            assert_eq!(found, good, "{noise:02X?}");
            let want = NoiseCounts {
                checksum_errors: sums,
                resyncs: 1,
                skipped_bytes: noise.len() as u64,
            };
            assert_eq!(counts, want, "{noise:02X?}");
        }
    }

    proptest! {
        #[test]
        fn frames_read_back(id in 0_u32..=0x1FFF_FFFF, data in prop::collection::vec(prop_oneof![Just(0xA5), Just(0x55), Just(0xAA), any::<u8>()], 0..9)) {
            let frame = CanFrame { id, data: CanData::try_from(&data[..]).unwrap() };
            let (found, noise) = read(&encode(&frame));
            prop_assert_eq!((found, noise), (vec![PacketContent::Frame(frame)], NoiseCounts::default()));
        }

        #[test]
        fn no_bytes_make_it_panic_or_grow(bytes in prop::collection::vec(prop_oneof![Just(0xA5), Just(0x55), Just(0xAA), any::<u8>()], 0..400)) {
            let (found, noise) = read(&bytes);
            prop_assert!((found.len() * PACKET_MIN) as u64 + noise.skipped_bytes <= bytes.len() as u64);
        }
    }
}
