//! The hand behind every wire of the schedules: the simulated body, its memory stamped with the time of the reading, so
//! that a test can tell a fresh value from an old one, whatever piece of it came when.

use handscope::hand::{Finger, Moment, Span};
use handscope::sim::SharedHand;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use tokio::time::Duration;

/// FORCE_ACT and CURRENT, each short of which is a stamp: no rule of the link looks at them.
const SHORTS: Span = Span::new(1582, 24);
/// The fingertips, and the raw channels at the start of each, every one a stamp.
const TOUCH: u16 = 3000;
const TIP: u16 = 58;
const CHANNELS: u16 = 32;
/// A stamp counts in these.
const TICK_MICROS: u64 = 100;
/// A virtual time that no schedule reaches: where a stamp of 16 bits begins anew.
pub(crate) const STAMPS_END: Duration = Duration::from_micros(TICK_MICROS * 65_536);

/// What is spoken on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Protocol {
    Rs485,
    Rtu,
    Tcp,
    Can,
    Slcan,
}

impl Protocol {
    pub(crate) const ALL: [Self; 5] = [Self::Rs485, Self::Rtu, Self::Tcp, Self::Can, Self::Slcan];

    /// True if a read goes out in pieces of at most eight bytes.
    pub(crate) const fn in_pieces(self) -> bool {
        matches!(self, Self::Can | Self::Slcan)
    }
}

/// What the device does wrong; for TCP it is all there is, as that loses nothing.
#[derive(Debug, Clone, Default)]
pub(crate) struct Quirks {
    pub(crate) turnaround: Duration,
    /// One reply in so many is late, doubled, cut, refused or in odd company; 0 = none.
    pub(crate) one_in: Arc<AtomicU32>,
    /// How often that happened.
    pub(crate) struck: Arc<AtomicU64>,
    /// The adapter's ways, on a wire that has one.
    pub(crate) adapter: Adapter,
    /// The device lies: what it tells was so much earlier. Only to see that the oracles notice.
    pub(crate) lag: Duration,
    /// Nothing is stamped: what the hand tells may stand still.
    pub(crate) unstamped: bool,
}

/// What serial CAN adapters differ in.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Adapter {
    /// Sends each frame back before anything else.
    pub(crate) echoes: bool,
    /// Acknowledges nothing.
    pub(crate) mute: bool,
    /// Adds time stamps to frames.
    pub(crate) stamps: bool,
}

impl Quirks {
    /// True if this reply is to go wrong.
    pub(crate) fn strike(&self, rng: &mut fastrand::Rng) -> bool {
        let one_in = self.one_in.load(Ordering::Relaxed);
        let struck = one_in != 0 && rng.u32(..one_in) == 0;
        self.struck.fetch_add(u64::from(struck), Ordering::Relaxed);
        struck
    }
}

/// The hand's memory with its stamps; none where it does not answer.
pub(crate) fn memory(hand: &SharedHand, quirks: &Quirks, span: Span) -> Option<Vec<u8>> {
    hand.with(|hand, now| {
        let mut bytes = hand.read(span, now).ok()?;
        if quirks.unstamped {
            return Some(bytes);
        }
        let lag = u64::try_from(quirks.lag.as_micros()).unwrap();
        let stamp = (now.micros().saturating_sub(lag) / TICK_MICROS) as u32;
        if overlaps(span, SHORTS) {
            put(&mut bytes, span, SHORTS, &stamp.to_le_bytes()[..2]);
        }
        if span.address >= TOUCH {
            for finger in 0..5 {
                let channels = Span::new(TOUCH + TIP * finger, CHANNELS);
                put(&mut bytes, span, channels, &stamp.to_le_bytes());
            }
        }
        Some(bytes)
    })
}

const fn overlaps(a: Span, b: Span) -> bool {
    (a.address as u32) < b.end() && (b.address as u32) < a.end()
}

/// Puts the stamp on every element of `marked` that `span` covers whole.
fn put(bytes: &mut [u8], span: Span, marked: Span, stamp: &[u8]) {
    let len = stamp.len() as u16;
    for element in (marked.address..marked.address + marked.len).step_by(stamp.len()) {
        if span.covers(Span::new(element, len)) {
            let at = usize::from(element - span.address);
            bytes[at..at + stamp.len()].copy_from_slice(stamp);
        }
    }
}

/// The moment a stamp was made, to a tenth of a millisecond.
pub(crate) fn stamped(stamp: u32) -> Moment {
    Moment::from_micros(u64::from(stamp) * TICK_MICROS)
}

/// The fingers, for those who count asks.
pub(crate) fn tip_span(finger: Finger) -> Span {
    Span::new(TOUCH + TIP * finger as u16, TIP)
}
