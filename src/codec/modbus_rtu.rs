//! Splits a stream that may contain noise into whole Modbus RTU replies (manual 2.4). Does not interpret registers.

use crate::codec::NoiseCounts;
use arrayvec::ArrayVec;

/// Maximum length of a frame: unit, 253 bytes of function and data, CRC.
pub const FRAME_LEN_MAX: usize = 256;
/// Capacity of the splitter's buffer: one frame and the beginning of the next.
pub const BUFFER_LEN: usize = 2 * FRAME_LEN_MAX;

/// Length of the CRC at the end of a frame.
const CHECK_LEN: usize = 2;
/// Unit, function, exception code, CRC.
const EXCEPTION_LEN: usize = 5;
/// Unit, function, address, count or value, CRC.
const WRITTEN_LEN: usize = 8;
/// Unit, function, address, count or value, CRC.
const REQUEST_LEN: usize = 8;
/// Unit, function, address, count, number of bytes.
const WRITE_HEAD_LEN: usize = 7;
/// Unit, function, number of bytes.
const READ_HEAD_LEN: usize = 3;
/// Maximum number of bytes in a read reply: 125 words (manual 2.5.1).
const READ_BYTES_MAX: u8 = 250;

/// CRC over all preceding bytes; sent low byte first (manual 2.4: CRC).
pub fn crc16(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |mut crc, byte| {
        crc ^= u16::from(*byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ if crc & 1 == 1 { 0xA001 } else { 0 };
        }
        crc
    })
}

/// One whole reply with a valid CRC.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RtuReply {
    /// All bytes, including unit and CRC.
    pub bytes: ArrayVec<u8, FRAME_LEN_MAX>,
}

impl RtuReply {
    /// Number of memory bytes in a read reply; `None` for other replies.
    pub fn read_len(&self) -> Option<u16> {
        match self.bytes.as_slice() {
            [_, 3, len, ..] => Some(u16::from(*len)),
            _ => None,
        }
    }
}

/// Requests seen on the line: our own, echoed by an adapter, or another controller's.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RtuRequests {
    /// Requests announced by [`RtuSplitter::expect_echo`].
    pub echoes: u64,
    /// Other requests that could be distinguished from replies.
    pub foreign: u64,
}

/// Splits a stream into the replies of one unit. RTU marks the start of a frame only by a silence, which adapters do not preserve, so a
/// reply is found where unit, function, length and CRC agree; other bytes are skipped.
#[derive(Debug, Clone)]
pub struct RtuSplitter {
    unit: u8,
    buffer: ArrayVec<u8, BUFFER_LEN>,
    noise: NoiseCounts,
    /// True within a run of skipped bytes, which counts once.
    skipping: bool,
    /// Request whose echo may arrive; empty if no echo is expected.
    echo: ArrayVec<u8, FRAME_LEN_MAX>,
    requests: RtuRequests,
}

/// Possible interpretation of the bytes at the front of the buffer.
enum ReplyStart {
    /// A whole, valid reply of this many bytes.
    Good(usize),
    /// Looks like a reply, but its CRC is wrong.
    Bad,
    /// Echo of our own request, of this many bytes.
    Echo(usize),
    /// Too few bytes to decide.
    Open,
    /// Not the start of a reply.
    None,
}

impl RtuSplitter {
    /// Creates a splitter for replies of this unit; those of other units are skipped.
    pub const fn new(unit: u8) -> Self {
        Self {
            unit,
            buffer: ArrayVec::new_const(),
            noise: NoiseCounts {
                checksum_errors: 0,
                resyncs: 0,
                skipped_bytes: 0,
            },
            skipping: false,
            echo: ArrayVec::new_const(),
            requests: RtuRequests {
                echoes: 0,
                foreign: 0,
            },
        }
    }

    /// Announces that `request` is being sent and that an adapter may echo it. For function 06, whose reply equals its request, call this
    /// only if the adapter is known to echo.
    pub fn expect_echo(&mut self, request: &[u8]) {
        self.echo = request.iter().copied().take(FRAME_LEN_MAX).collect();
    }

    /// Cancels the expected echo.
    pub fn expect_no_echo(&mut self) {
        self.echo.clear();
    }

    /// Requests seen so far.
    pub const fn requests(&self) -> RtuRequests {
        self.requests
    }

    /// Accepts received bytes and returns how many fit. Push the rest again after [`Self::next`] returned `None`.
    pub fn push(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(self.buffer.remaining_capacity());
        self.buffer.extend(bytes.iter().take(taken).copied());
        taken
    }

    /// Returns the next whole reply; `None` if more bytes are needed.
    #[expect(
        clippy::should_implement_trait,
        reason = "None is not the end: more may come after a push"
    )]
    pub fn next(&mut self) -> Option<RtuReply> {
        loop {
            match self.start() {
                ReplyStart::Good(len) => return Some(self.split_reply(len)),
                ReplyStart::Open => return None,
                ReplyStart::Echo(len) => self.drop_echo(len),
                ReplyStart::Bad | ReplyStart::None if self.drop_foreign() => {}
                ReplyStart::Bad => {
                    self.noise.checksum_errors += u64::from(!self.skipping);
                    self.skip();
                }
                ReplyStart::None => self.skip(),
            }
        }
    }

    /// Reports that the line is silent, so a partial frame stays incomplete: skips to the next whole reply, or everything.
    pub fn flush_pending(&mut self) {
        while !self.buffer.is_empty() {
            match self.start() {
                ReplyStart::Good(_) => return,
                ReplyStart::Echo(len) => self.drop_echo(len),
                ReplyStart::Bad | ReplyStart::Open | ReplyStart::None if self.drop_foreign() => {}
                ReplyStart::Bad | ReplyStart::Open | ReplyStart::None => self.skip(),
            }
        }
    }

    /// Noise skipped so far.
    pub const fn noise(&self) -> NoiseCounts {
        self.noise
    }

    /// Buffered bytes of an incomplete reply.
    pub const fn buffered(&self) -> usize {
        self.buffer.len()
    }

    fn start(&self) -> ReplyStart {
        let bytes = self.buffer.as_slice();
        if !self.echo.is_empty() {
            if bytes.starts_with(&self.echo) {
                return ReplyStart::Echo(self.echo.len());
            }
            if self.echo.starts_with(bytes) {
                return ReplyStart::Open;
            }
        }
        if bytes.first().is_some_and(|unit| *unit != self.unit) {
            return ReplyStart::None;
        }
        let len = match bytes {
            [] | [_] | [_, 3] => return ReplyStart::Open,
            [_, 3, count, ..] if count % 2 == 0 && (2..=READ_BYTES_MAX).contains(count) => {
                READ_HEAD_LEN + usize::from(*count) + CHECK_LEN
            }
            [_, 6 | 16, ..] => WRITTEN_LEN,
            [_, 0x83 | 0x86 | 0x90, ..] => EXCEPTION_LEN,
            _ => return ReplyStart::None,
        };
        match bytes.get(..len).and_then(<[u8]>::split_last_chunk) {
            None => ReplyStart::Open,
            Some((body, check)) if crc16(body) == u16::from_le_bytes(*check) => {
                ReplyStart::Good(len)
            }
            Some(_) => ReplyStart::Bad,
        }
    }

    fn drop_echo(&mut self, len: usize) {
        self.requests.echoes += 1;
        self.echo.clear();
        self.skipping = false;
        self.buffer.drain(..len);
    }

    /// Removes another controller's whole request from the front of the buffer; returns false if there is none.
    fn drop_foreign(&mut self) -> bool {
        let bytes = self.buffer.as_slice();
        let len = match bytes {
            [1..=247, 3 | 6, ..] => REQUEST_LEN,
            [1..=247, 16, _, _, _, _, count, ..] => {
                WRITE_HEAD_LEN + usize::from(*count) + CHECK_LEN
            }
            _ => return false,
        };
        let whole = bytes.get(..len).and_then(<[u8]>::split_last_chunk);
        let is_good = whole.is_some_and(|(body, check)| crc16(body) == u16::from_le_bytes(*check));
        if is_good {
            self.requests.foreign += 1;
            self.skipping = false;
            self.buffer.drain(..len);
        }
        is_good
    }

    fn split_reply(&mut self, len: usize) -> RtuReply {
        self.skipping = false;
        RtuReply {
            bytes: self.buffer.drain(..len).collect(),
        }
    }

    fn skip(&mut self) {
        self.noise.resyncs += u64::from(!self.skipping);
        self.noise.skipped_bytes += 1;
        self.skipping = true;
        self.buffer.remove(0);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::cast_possible_truncation, reason = "a test may")]
    use super::*;
    use proptest::prelude::*;

    /// The replies of manual 2.4.1 to 2.4.3, with the check that it leaves open, reckoned by hand.
    const READ: [u8; 9] = [1, 3, 4, 0, 1, 0, 2, 0x2A, 0x32];
    const ZEROS: [u8; 8] = [1, 6, 0, 0, 0, 0, 0x89, 0xCA];
    const WRITTEN: [u8; 8] = [1, 16, 0, 1, 0, 2, 0x10, 0x08];

    fn split(stream: &[u8], piece: usize) -> (Vec<Vec<u8>>, NoiseCounts) {
        let mut splitter = RtuSplitter::new(1);
        let mut out = Vec::new();
        for mut chunk in stream.chunks(piece) {
            while !chunk.is_empty() {
                chunk = &chunk[splitter.push(chunk)..];
                while let Some(reply) = splitter.next() {
                    out.push(reply.bytes.to_vec());
                }
                assert!(splitter.buffered() < FRAME_LEN_MAX);
            }
        }
        loop {
            splitter.flush_pending();
            let Some(reply) = splitter.next() else { break };
            out.push(reply.bytes.to_vec());
        }
        assert_eq!(splitter.buffered(), 0);
        (out, splitter.noise())
    }

    fn checked(body: &[u8]) -> Vec<u8> {
        [body, &crc16(body).to_le_bytes()].concat()
    }

    #[test]
    fn the_check_is_that_of_the_standard() {
        assert_eq!(crc16(b"123456789"), 0x4B37);
        // The read of the standard's own example: 11 03 00 6B 00 03 76 87.
        assert_eq!(crc16(&[0x11, 3, 0, 0x6B, 0, 3]), 0x8776);
    }

    #[test]
    fn the_manuals_replies_come_out_whole_however_they_were_cut() {
        let stream = [READ.as_slice(), &ZEROS, &WRITTEN].concat();
        let want = vec![READ.to_vec(), ZEROS.to_vec(), WRITTEN.to_vec()];
        for piece in 1..=stream.len() {
            assert_eq!(
                split(&stream, piece),
                (want.clone(), NoiseCounts::default())
            );
        }
    }

    #[test]
    fn a_wrong_check_is_counted_once_and_the_next_reply_found() {
        let mut bad = READ;
        bad[4] ^= 0x10;
        let (replies, noise) = split(&[bad.as_slice(), &READ].concat(), 5);
        assert_eq!(replies, [READ.to_vec()]);
        assert_eq!((noise.checksum_errors, noise.resyncs), (1, 1));
    }

    #[test]
    fn a_cut_reply_hides_the_next_only_until_the_line_is_silent() {
        let long = checked(&[[1, 3, 78].as_slice(), &[7; 78]].concat());
        let (replies, noise) = split(&[&long[..40], &READ].concat(), 7);
        assert_eq!(replies, [READ.to_vec()]);
        assert_eq!((noise.checksum_errors, noise.resyncs), (0, 1));
    }

    #[test]
    fn replies_of_other_units_are_skipped() {
        let other = checked(&[2, 3, 2, 0, 9]);
        let (replies, noise) = split(&[other.as_slice(), &READ].concat(), 3);
        assert_eq!(replies, [READ.to_vec()]);
        assert_eq!(noise.resyncs, 1);
    }

    /// Replies and request counts of a stream that is pushed in pieces, with an expected echo.
    fn sorted(stream: &[u8], piece: usize, echo: &[u8]) -> (Vec<Vec<u8>>, RtuRequests) {
        let mut splitter = RtuSplitter::new(1);
        splitter.expect_echo(echo);
        let mut out = Vec::new();
        for chunk in stream.chunks(piece) {
            assert_eq!(splitter.push(chunk), chunk.len());
            while let Some(reply) = splitter.next() {
                out.push(reply.bytes.to_vec());
            }
        }
        assert_eq!(splitter.noise(), NoiseCounts::default());
        (out, splitter.requests())
    }

    #[test]
    fn an_echo_is_left_out_once_and_the_same_bytes_behind_it_are_the_reply() {
        let six = checked(&[1, 6, 3, 0xEC, 0, 1]);
        let read = checked(&[1, 3, 0, 0x6B, 0, 2]);
        for piece in 1..=16 {
            for (sent, reply) in [(&six, six.as_slice()), (&read, &READ)] {
                let (replies, requests) = sorted(&[sent, reply].concat(), piece, sent);
                assert_eq!((replies, requests.echoes), (vec![reply.to_vec()], 1));
                assert_eq!(requests.foreign, 0);
            }
            let (replies, requests) = sorted(&six, piece, &[]);
            assert_eq!((replies, requests.echoes), (vec![six.clone()], 0));
        }
    }

    #[test]
    fn requests_of_another_controller_are_counted_and_hide_no_reply() {
        let read = checked(&[1, 3, 6, 0x0A, 0, 6]);
        let write = checked(&[1, 16, 5, 0xCE, 0, 1, 2, 0, 7]);
        let to_another = checked(&[9, 3, 6, 0x0A, 0, 6]);
        for piece in 1..=20 {
            let (replies, requests) = sorted(&[&read, READ.as_slice()].concat(), piece, &[]);
            assert_eq!((replies, requests.foreign), (vec![READ.to_vec()], 1));
        }
        // Those that look like no reply at all are told only where they come whole.
        let stream = [&write, &to_another, READ.as_slice()].concat();
        let (replies, requests) = sorted(&stream, stream.len(), &[]);
        assert_eq!((replies, requests.foreign), (vec![READ.to_vec()], 2));
    }

    #[test]
    fn exceptions_come_out_too() {
        let refusal = checked(&[1, 0x83, 2]);
        assert_eq!(split(&refusal, 1).0, [refusal]);
    }

    proptest! {
        #[test]
        fn random_bytes_never_panic(
            stream in prop::collection::vec(prop_oneof![Just(1u8), Just(3u8), any::<u8>()], 0..1200),
            piece in 1..300usize,
        ) {
            split(&stream, piece);
        }

        #[test]
        fn each_reply_of_a_clean_stream_comes_out(
            lens in prop::collection::vec(1..=125u8, 1..8), piece in 1..300usize,
        ) {
            let replies: Vec<Vec<u8>> = lens
                .iter()
                .map(|words| {
                    let data = (0..words * 2).map(|n| n.wrapping_mul(37));
                    checked(&[1, 3, words * 2].into_iter().chain(data).collect::<Vec<u8>>())
                })
                .collect();
            prop_assert_eq!(split(&replies.concat(), piece), (replies, NoiseCounts::default()));
        }
    }
}
