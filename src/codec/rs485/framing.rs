//! Finding whole frames in a stream that may hold noise, shared by client and device. What a frame means is not known here.

use arrayvec::ArrayVec;

/// A whole frame, header to checksum; the longest has 260 bytes.
pub type Frame = ArrayVec<u8, 261>;
/// The data bytes of a frame.
pub type Payload = ArrayVec<u8, 252>;
/// Most bytes that one read can ask for: the length byte of the reply is this plus three.
pub const READ_LEN_MAX: u16 = 252;
/// Bytes that a decoder keeps: two of the longest frames, so that a frame behind a false header still fits.
pub const BUFFER_LEN: usize = 520;

/// Frames of the other way that wait to be looked at; more at once only count.
const OVERHEARD_MAX: usize = 4;

/// Command byte of a read.
pub(super) const READ: u8 = 0x11;
/// Command byte of a write.
pub(super) const WRITE: u8 = 0x12;

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
pub enum Way {
    /// To the hand.
    Request,
    /// From the hand.
    Reply,
}

impl Way {
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
pub struct NoiseCounts {
    /// Good frames handed out.
    pub frames: u64,
    /// Frames of the other way, whole and good: an adapter that echoes, or another speaker on the bus.
    pub echoes: u64,
    /// Headers with a possible length whose checksum was wrong.
    pub checksum_errors: u64,
    /// Runs of bytes that had to be skipped to find the next frame.
    pub resyncs: u64,
    /// Bytes skipped.
    pub skipped_bytes: u64,
}

/// The parts of a good frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Parts {
    pub(super) id: u8,
    pub(super) command: u8,
    pub(super) address: u16,
    pub(super) data: Payload,
}

/// What stands at the beginning of a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scan {
    /// No frame begins here.
    Bad,
    /// A possible frame of this way and length whose checksum is wrong.
    BadSum(Way, usize),
    /// A possible frame that is not whole yet.
    NeedMore,
    /// A good frame of this way and length in bytes.
    Frame(Way, usize),
}

/// The low byte of the sum of all bytes after the header (manual 2.2.1).
pub(super) fn checksum(body: &[u8]) -> u8 {
    body.iter().fold(0, |sum, byte| sum.wrapping_add(*byte))
}

/// Bytes of a frame with this length byte, header to checksum.
pub(super) fn total(len: u8) -> usize {
    usize::from(len) + AROUND
}

pub(super) fn scan(bytes: &[u8]) -> Scan {
    let way = match bytes {
        [] => return Scan::NeedMore,
        [first, ..] if *first == REQUEST_HEADER[0] => Way::Request,
        [first, ..] if *first == REPLY_HEADER[0] => Way::Reply,
        _ => return Scan::Bad,
    };
    if bytes.get(1).is_some_and(|byte| *byte != way.header()[1]) {
        return Scan::Bad;
    }
    let Some(&len) = bytes.get(3) else {
        return Scan::NeedMore;
    };
    if len < SHORTEST {
        return Scan::Bad;
    }
    if bytes
        .get(4)
        .is_some_and(|command| !way.allows(*command, len))
    {
        return Scan::Bad;
    }
    let total = total(len);
    match bytes.get(2..total) {
        Some([body @ .., sum]) if checksum(body) == *sum => Scan::Frame(way, total),
        Some(_) => Scan::BadSum(way, total),
        None => Scan::NeedMore,
    }
}

pub(super) fn parts(frame: &[u8]) -> Option<Parts> {
    let [_, _, id, _, command, low, high, data @ .., _sum] = frame else {
        return None;
    };
    Some(Parts {
        id: *id,
        command: *command,
        address: u16::from_le_bytes([*low, *high]),
        data: Payload::try_from(data).ok()?,
    })
}

/// A whole frame; `None` unless there are 1 to 252 bytes of data.
pub(super) fn build(way: Way, id: u8, command: u8, address: u16, data: &[u8]) -> Option<Frame> {
    let len = u8::try_from(data.len()).ok()?.checked_add(3)?;
    if len < SHORTEST {
        return None;
    }
    let [low, high] = address.to_le_bytes();
    let mut body = Frame::new();
    body.try_extend_from_slice(&[id, len, command, low, high])
        .ok()?;
    body.try_extend_from_slice(data).ok()?;
    let sum = checksum(&body);
    let mut frame = Frame::new();
    frame.try_extend_from_slice(&way.header()).ok()?;
    frame.try_extend_from_slice(&body).ok()?;
    frame.try_push(sum).ok()?;
    Some(frame)
}

/// A frame with one byte of data, which always fits.
pub(super) fn build_short(way: Way, id: u8, command: u8, address: u16, value: u8) -> Frame {
    let [low, high] = address.to_le_bytes();
    let [first, second] = way.header();
    let body = [id, SHORTEST, command, low, high, value];
    let mut frame = Frame::from_iter([first, second]);
    frame.extend(body);
    frame.push(checksum(&body));
    frame
}

/// A bounded buffer and the search for the next good frame of one way.
#[derive(Debug, Clone)]
pub(super) struct Framer {
    way: Way,
    buffer: ArrayVec<u8, BUFFER_LEN>,
    /// Leading bytes that came before a silence: a frame that began there and is not whole will not become so.
    stale: usize,
    /// True while skipping, so that a run is counted once.
    skipping: bool,
    /// Whole frames of the other way.
    overheard: ArrayVec<Frame, OVERHEARD_MAX>,
    counts: NoiseCounts,
}

impl Framer {
    pub(super) const fn new(way: Way) -> Self {
        Self {
            way,
            buffer: ArrayVec::new_const(),
            stale: 0,
            skipping: false,
            overheard: ArrayVec::new_const(),
            counts: NoiseCounts {
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

    pub(super) fn next(&mut self) -> Option<Parts> {
        let mut at = 0;
        let found = loop {
            let rest = self.buffer.get(at..).unwrap_or_default();
            match scan(rest) {
                Scan::Frame(way, total) => {
                    self.skipping = false;
                    let whole = rest.get(..total).unwrap_or_default();
                    at += total;
                    if way == self.way {
                        self.counts.frames += 1;
                        break parts(whole);
                    }
                    self.counts.echoes += 1;
                    if let Ok(frame) = Frame::try_from(whole) {
                        // Too many at once are counted all the same.
                        let _full = self.overheard.try_push(frame);
                    }
                }
                Scan::NeedMore if rest.is_empty() || at >= self.stale => break None,
                Scan::NeedMore | Scan::Bad => self.skip(&mut at),
                Scan::BadSum(..) => {
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
    pub(super) fn overheard(&mut self) -> Option<Frame> {
        self.overheard.pop_at(0)
    }

    pub(super) const fn flush_pending(&mut self) {
        self.stale = self.buffer.len();
    }

    pub(super) const fn counts(&self) -> NoiseCounts {
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
    ($(#[$doc:meta])* $name:ident, $way:expr, $item:ty, $decode:expr) => {
        $(#[$doc])*
        #[derive(Debug, Clone)]
        pub struct $name(Framer);

        impl Default for $name {
            fn default() -> Self {
                Self(Framer::new($way))
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
            #[must_use]
            pub const fn counts(&self) -> NoiseCounts {
                self.0.counts()
            }

            /// Forgets all bytes that are kept; counts stay.
            pub fn clear(&mut self) {
                self.0.clear();
            }

            /// Bytes kept because they may be the beginning of a frame.
            #[must_use]
            pub const fn buffered(&self) -> usize {
                self.0.buffered()
            }
        }
    };
}
pub(super) use decoder;
