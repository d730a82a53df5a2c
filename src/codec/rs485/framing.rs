//! Finds whole frames in a stream that may contain noise; shared by client and device. Does not interpret them.

use arrayvec::ArrayVec;

/// A whole frame, header to checksum; at most 260 bytes.
pub type Rs485Frame = ArrayVec<u8, 261>;
/// Data bytes of a frame.
pub type Payload = ArrayVec<u8, 252>;
/// Maximum number of bytes in one read: the length byte of the reply is this plus three.
pub const READ_LEN_MAX: u16 = 252;
/// Capacity of a decoder's buffer: two of the longest frames, so that a frame behind a false header still fits.
pub const BUFFER_LEN: usize = 520;

/// Maximum number of queued frames of the opposite direction; further ones are only counted.
const OVERHEARD_MAX: usize = 4;

/// Command byte of a read.
pub const READ: u8 = 0x11;
/// Command byte of a write.
pub const WRITE: u8 = 0x12;

/// Value in the address field of the frame that ends a calibration.
pub(super) const CALIBRATION_END: u16 = 2;

const REQUEST_HEADER: [u8; 2] = [0xEB, 0x90];
const REPLY_HEADER: [u8; 2] = [0x90, 0xEB];
/// Header, id and length byte before the counted bytes, checksum after them.
const AROUND: usize = 5;
/// Command, address and one byte of data: the minimum of a frame.
const SHORTEST: u8 = 4;

/// Direction of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameDirection {
    /// To the hand.
    Request,
    /// From the hand.
    Reply,
}

impl FrameDirection {
    const fn header(self) -> [u8; 2] {
        match self {
            Self::Request => REQUEST_HEADER,
            Self::Reply => REPLY_HEADER,
        }
    }

    /// True if a frame of this direction may have this command and length byte.
    const fn allows(self, command: u8, len: u8) -> bool {
        match (self, command) {
            (Self::Request, READ) | (Self::Reply, WRITE) => len == SHORTEST,
            (Self::Request, WRITE) | (Self::Reply, READ) => len >= SHORTEST,
            _ => false,
        }
    }
}

/// Statistics of a decoder. Counters never decrease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FramerCounts {
    /// Valid frames returned.
    pub frames: u64,
    /// Whole, valid frames of the opposite direction: from an echoing adapter, or another device on the bus.
    pub echoes: u64,
    /// Headers with a possible length, but a wrong checksum.
    pub checksum_errors: u64,
    /// Runs of bytes skipped to find the next frame.
    pub resyncs: u64,
    /// Skipped bytes.
    pub skipped_bytes: u64,
}

/// Fields of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameParts {
    /// Id of the hand that is addressed or that replies.
    pub id: u8,
    /// 0x11 reads, 0x12 writes.
    pub command: u8,
    /// Address of the first byte.
    pub address: u16,
    /// 1 to 252 bytes of data; the requested length in a read request.
    pub data: Payload,
}

/// Result of [`scan`]: interpretation of the leading bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameStart {
    /// A valid frame of this direction and length in bytes.
    Frame(FrameDirection, usize),
    /// A frame with a wrong checksum.
    BadSum {
        /// Length in bytes, header to checksum.
        len: usize,
        /// Received checksum.
        got: u8,
        /// Checksum computed over the received bytes.
        want: u8,
    },
    /// Beginning of a frame; its total length if already known.
    Open(Option<usize>),
    /// A header with an invalid length or command.
    BadHead {
        /// Received length byte.
        len: u8,
        /// Received command byte, if already received.
        command: Option<u8>,
    },
    /// Not a header.
    Nothing,
}

/// Checksum: low byte of the sum of all bytes after the header (manual 2.2.1).
pub(super) fn checksum(body: &[u8]) -> u8 {
    body.iter().fold(0, |sum, byte| sum.wrapping_add(*byte))
}

/// Inspects the leading bytes. Empty input gives [`FrameStart::Open`].
pub fn scan(bytes: &[u8]) -> FrameStart {
    let direction = match bytes {
        [] => return FrameStart::Open(None),
        [first, ..] if *first == REQUEST_HEADER[0] => FrameDirection::Request,
        [first, ..] if *first == REPLY_HEADER[0] => FrameDirection::Reply,
        _ => return FrameStart::Nothing,
    };
    let second = direction.header()[1];
    if bytes.get(1).is_some_and(|byte| *byte != second) {
        return FrameStart::Nothing;
    }
    let Some(&len) = bytes.get(3) else {
        return FrameStart::Open(None);
    };
    let command = bytes.get(4).copied();
    let is_allowed = |command| direction.allows(command, len);
    if len < SHORTEST || !command.is_none_or(is_allowed) {
        return FrameStart::BadHead { len, command };
    }
    let total = usize::from(len) + AROUND;
    match bytes.get(2..total) {
        Some([body @ .., got]) => match checksum(body) {
            want if want == *got => FrameStart::Frame(direction, total),
            want => FrameStart::BadSum {
                len: total,
                got: *got,
                want,
            },
        },
        _ => FrameStart::Open(Some(total)),
    }
}

/// Splits a whole frame into its fields without checking the checksum; `None` if it is too short.
pub fn parts(frame: &[u8]) -> Option<FrameParts> {
    let [_, _, id, _, command, low, high, data @ .., _sum] = frame else {
        return None;
    };
    Some(FrameParts {
        id: *id,
        command: *command,
        address: u16::from_le_bytes([*low, *high]),
        data: Payload::try_from(data).ok()?,
    })
}

/// Builds a whole frame; `None` unless there are 1 to 252 bytes of data.
pub(super) fn build(
    direction: FrameDirection,
    id: u8,
    command: u8,
    address: u16,
    data: &[u8],
) -> Option<Rs485Frame> {
    let len = u8::try_from(data.len()).ok()?.checked_add(3)?;
    if len < SHORTEST {
        return None;
    }
    let [low, high] = address.to_le_bytes();
    let mut body = Rs485Frame::new();
    body.try_extend_from_slice(&[id, len, command, low, high])
        .ok()?;
    body.try_extend_from_slice(data).ok()?;
    let sum = checksum(&body);
    let mut frame = Rs485Frame::new();
    frame.try_extend_from_slice(&direction.header()).ok()?;
    frame.try_extend_from_slice(&body).ok()?;
    frame.try_push(sum).ok()?;
    Some(frame)
}

/// Builds a frame with one byte of data, which always fits.
pub(super) fn build_short(
    direction: FrameDirection,
    id: u8,
    command: u8,
    address: u16,
    value: u8,
) -> Rs485Frame {
    let [low, high] = address.to_le_bytes();
    let [first, second] = direction.header();
    let body = [id, SHORTEST, command, low, high, value];
    let mut frame = Rs485Frame::from_iter([first, second]);
    frame.extend(body);
    frame.push(checksum(&body));
    frame
}

/// A bounded buffer with a search for the next valid frame of one direction.
#[derive(Debug, Clone)]
pub(super) struct Framer {
    direction: FrameDirection,
    buffer: ArrayVec<u8, BUFFER_LEN>,
    /// Number of leading bytes received before a silence: a partial frame among them will never be completed.
    stale: usize,
    /// True within a run of skipped bytes, which counts once.
    skipping: bool,
    /// Whole frames of the opposite direction.
    overheard: ArrayVec<Rs485Frame, OVERHEARD_MAX>,
    counts: FramerCounts,
}

impl Framer {
    pub(super) const fn new(direction: FrameDirection) -> Self {
        Self {
            direction,
            buffer: ArrayVec::new_const(),
            stale: 0,
            skipping: false,
            overheard: ArrayVec::new_const(),
            counts: FramerCounts {
                frames: 0,
                echoes: 0,
                checksum_errors: 0,
                resyncs: 0,
                skipped_bytes: 0,
            },
        }
    }

    pub(super) fn push(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(self.buffer.remaining_capacity());
        self.buffer.extend(bytes.iter().take(taken).copied());
        taken
    }

    pub(super) fn next(&mut self) -> Option<FrameParts> {
        let mut at = 0;
        let found = loop {
            let rest = self.buffer.get(at..).unwrap_or_default();
            match scan(rest) {
                FrameStart::Frame(direction, total) => {
                    self.skipping = false;
                    let whole = rest.get(..total).unwrap_or_default();
                    at += total;
                    if direction == self.direction {
                        self.counts.frames += 1;
                        break parts(whole);
                    }
                    self.counts.echoes += 1;
                    if let Ok(frame) = Rs485Frame::try_from(whole) {
                        // Frames beyond the limit have still been counted.
                        let _full = self.overheard.try_push(frame);
                    }
                }
                FrameStart::Open(_) if rest.is_empty() || at >= self.stale => break None,
                FrameStart::Open(_) | FrameStart::Nothing | FrameStart::BadHead { .. } => {
                    self.skip(&mut at)
                }
                FrameStart::BadSum { .. } => {
                    self.counts.checksum_errors += 1;
                    self.skip(&mut at);
                }
            }
        };
        self.buffer.drain(..at.min(self.buffer.len()));
        self.stale = self.stale.saturating_sub(at);
        found
    }

    /// Skips only one byte: the next header may be inside an apparent frame.
    const fn skip(&mut self, at: &mut usize) {
        if !self.skipping {
            self.counts.resyncs += 1;
        }
        self.skipping = true;
        self.counts.skipped_bytes += 1;
        *at += 1;
    }

    /// Returns the oldest queued frame of the opposite direction.
    pub(super) fn overheard(&mut self) -> Option<Rs485Frame> {
        self.overheard.pop_at(0)
    }

    pub(super) const fn flush_pending(&mut self) {
        self.stale = self.buffer.len();
    }

    pub(super) const fn counts(&self) -> FramerCounts {
        self.counts
    }

    pub(super) fn clear(&mut self) {
        self.buffer.clear();
        self.stale = 0;
        self.skipping = false;
    }

    pub(super) const fn buffered(&self) -> usize {
        self.buffer.len()
    }
}

/// Defines the methods that both decoders share, each for its own frame type.
macro_rules! decoder {
    ($(#[$doc:meta])* $name:ident, $direction:expr, $item:ty, $decode:expr) => {
        $(#[$doc])*
        #[derive(Debug, Clone)]
        pub struct $name(Framer);

        impl Default for $name {
            fn default() -> Self {
                Self(Framer::new($direction))
            }
        }

        impl $name {
            /// Accepts received bytes and returns how many fit. Push the rest again after [`Self::next`] returned `None`, which always
            /// makes room: at most [`BUFFER_LEN`] bytes are buffered.
            ///
            /// [`BUFFER_LEN`]: crate::codec::rs485::framing::BUFFER_LEN
            pub fn push(&mut self, bytes: &[u8]) -> usize {
                self.0.push(bytes)
            }

            /// Returns the next valid frame; `None` if more bytes are needed.
            #[expect(
                clippy::should_implement_trait,
                reason = "None is not the end: more may come after a push"
            )]
            pub fn next(&mut self) -> Option<$item> {
                self.0.next().map($decode)
            }

            /// Reports that the line fell silent: a partial frame will never be completed.
            ///
            /// Noise may look like the header of a long frame; the decoder then waits for its end, and valid frames behind it wait too.
            /// Call this when a reply is late, then [`Self::next`] until `None`: it returns the frames inside the incomplete one.
            pub fn flush_pending(&mut self) {
                self.0.flush_pending();
            }

            /// Statistics since creation; [`Self::clear`] does not reset them.
            pub const fn counts(&self) -> FramerCounts {
                self.0.counts()
            }

            /// Discards all buffered bytes; counters are unchanged.
            pub fn clear(&mut self) {
                self.0.clear();
            }

            /// Buffered bytes that may be the beginning of a frame.
            pub const fn buffered(&self) -> usize {
                self.0.buffered()
            }
        }
    };
}
pub(super) use decoder;
