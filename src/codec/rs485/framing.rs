//! Finding whole frames in a stream that may hold noise, shared by client and device. What a frame means is not known here.

use arrayvec::ArrayVec;

/// A whole frame, header to checksum; the longest has 260 bytes.
pub type Rs485Frame = ArrayVec<u8, 261>;
/// The data bytes of a frame.
pub type Payload = ArrayVec<u8, 252>;
/// Most bytes that one read can ask for: the length byte of the reply is this plus three.
pub const READ_LEN_MAX: u16 = 252;
/// Bytes that a decoder keeps: two of the longest frames, so that a frame behind a false header still fits.
pub const BUFFER_LEN: usize = 520;

/// Frames of the other way that wait to be looked at; more at once only count.
const OVERHEARD_MAX: usize = 4;

/// Command byte of a read.
pub const READ: u8 = 0x11;
/// Command byte of a write.
pub const WRITE: u8 = 0x12;

/// What stands in the place of the address in the frame that ends a calibration.
pub(super) const CALIBRATION_END: u16 = 2;

const REQUEST_HEADER: [u8; 2] = [0xEB, 0x90];
const REPLY_HEADER: [u8; 2] = [0x90, 0xEB];
/// Header, id and length byte before, checksum after what the length byte counts.
const AROUND: usize = 5;
/// Command, address and one byte of data: no frame has less.
const SHORTEST: u8 = 4;

/// Which way a frame goes.
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

    /// True if a frame of this way may have this command and length byte.
    const fn allows(self, command: u8, len: u8) -> bool {
        match (self, command) {
            (Self::Request, READ) | (Self::Reply, WRITE) => len == SHORTEST,
            (Self::Request, WRITE) | (Self::Reply, READ) => len >= SHORTEST,
            _ => false,
        }
    }
}

/// What a decoder met apart from good frames. Counts only grow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FramerCounts {
    /// Good frames handed out.
    pub frames: u64,
    /// Frames of the other direction, whole and good: an adapter that echoes, or another speaker on the bus.
    pub echoes: u64,
    /// Headers with a possible length whose checksum was wrong.
    pub checksum_errors: u64,
    /// Runs of bytes that had to be skipped to find the next frame.
    pub resyncs: u64,
    /// Bytes skipped.
    pub skipped_bytes: u64,
}

/// A frame's parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameParts {
    /// The hand that is meant or that answers.
    pub id: u8,
    /// 0x11 reads, 0x12 writes.
    pub command: u8,
    /// First byte's address.
    pub address: u16,
    /// 1 to 252 bytes of data; the length wanted in a read request.
    pub data: Payload,
}

/// What some bytes begin with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameStart {
    /// A good frame of so many bytes.
    Frame(FrameDirection, usize),
    /// A frame of so many bytes whose checksum is wrong.
    BadSum {
        /// Bytes, header to checksum.
        len: usize,
        /// The checksum that was sent.
        got: u8,
        /// The checksum of what was sent.
        want: u8,
    },
    /// The beginning of a frame; its length if that is known by now.
    Open(Option<usize>),
    /// A header, but a length or command that no frame has.
    BadHead {
        /// The length byte.
        len: u8,
        /// The command byte, if it is there.
        command: Option<u8>,
    },
    /// No header.
    Nothing,
}

/// The low byte of the sum of all bytes after the header (manual 2.2.1).
pub(super) fn checksum(body: &[u8]) -> u8 {
    body.iter().fold(0, |sum, byte| sum.wrapping_add(*byte))
}

/// Looks at the beginning of some bytes. None of them is [`FrameStart::Open`].
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

/// The parts of a whole frame, whatever its checksum says; `None` if it is too short.
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

/// A whole frame; `None` unless there are 1 to 252 bytes of data.
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

/// A frame with one byte of data, which always fits.
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

/// A bounded buffer and the search for the next good frame of one direction.
#[derive(Debug, Clone)]
pub(super) struct Framer {
    direction: FrameDirection,
    buffer: ArrayVec<u8, BUFFER_LEN>,
    /// Leading bytes that came before a silence: a frame that began there and is not whole will not become so.
    stale: usize,
    /// True while skipping, so that a run is counted once.
    skipping: bool,
    /// Whole frames of the other direction.
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
                        // Too many at once are counted all the same.
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

    /// Skips one byte only: the next header may stand inside what looked like a frame.
    const fn skip(&mut self, at: &mut usize) {
        if !self.skipping {
            self.counts.resyncs += 1;
        }
        self.skipping = true;
        self.counts.skipped_bytes += 1;
        *at += 1;
    }

    /// The oldest frame of the other way that was not looked at yet.
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

/// The methods that both decoders share, each on its own type of frame.
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
            /// Takes bytes as they come; returns how many. The rest is given again after [`Self::next`] said `None`,
            /// which always makes room: at most [`BUFFER_LEN`] bytes are kept.
            ///
            /// [`BUFFER_LEN`]: crate::codec::rs485::framing::BUFFER_LEN
            pub fn push(&mut self, bytes: &[u8]) -> usize {
                self.0.push(bytes)
            }

            /// The next good frame; `None` if more bytes are needed.
            #[expect(
                clippy::should_implement_trait,
                reason = "None is not the end: more may come after a push"
            )]
            pub fn next(&mut self) -> Option<$item> {
                self.0.next().map($decode)
            }

            /// The line fell silent: a frame that is not whole by now never will be.
            ///
            /// Noise may look like the header of a long frame; the decoder then waits for its end, and good frames
            /// behind it wait too. Call this when a reply is late, then [`Self::next`] until `None`: it gives
            /// the frames that stand inside the unfinished one.
            pub fn flush_pending(&mut self) {
                self.0.flush_pending();
            }

            /// What was met since the start, [`Self::clear`] or not.
            pub const fn counts(&self) -> FramerCounts {
                self.0.counts()
            }

            /// Forgets all bytes that are kept; counts stay.
            pub fn clear(&mut self) {
                self.0.clear();
            }

            /// Bytes kept because they may be the beginning of a frame.
            pub const fn buffered(&self) -> usize {
                self.0.buffered()
            }
        }
    };
}
pub(super) use decoder;
