//! What a read costs on a wire, and how long a reply may be so that a stop gets through in time. Pure: learns from
//! given round trips, sends and times nothing.

use crate::codec::usbcan::PACKET_MIN;
use crate::transport::endpoint::DEFAULT_BITRATE;
use std::collections::VecDeque;
use std::time::Duration;

/// Above this baud the silence between frames does not shrink any more (Modbus over serial line 1.02, 2.5.1.1).
const FIXED_GAP_ABOVE: u32 = 19_200;
pub(crate) const FIXED_GAP: Duration = Duration::from_micros(1750);
/// Bits of a byte on a serial line: start, eight, stop.
const BITS: u64 = 10;
/// Longest reply frame of a serial line while a stop waits to be confirmed: one fingertip in the private framing.
const MOVING_FRAME: u16 = 66;
/// Most data bytes of a read while something may move: three fingertips, between which the motion state comes often.
const MOVING_DATA: u16 = 3 * 58;
/// Slowest turnaround seen in a hand: assumed until one is known, and the most that is ever assumed. What an adapter adds
/// to it cannot be won back by shorter replies.
const TURNAROUND_MAX: Duration = Duration::from_millis(15);
/// What a stop may cost besides the hand's turnaround: this computer's part …
const STOP_SLACK: Duration = Duration::from_millis(2);
/// … and this many bytes on the line. With 15 ms of turnaround that is 19 ms from the press to the last byte of the hold
/// at 921600 baud, 29 at 115200, 41 at 57600 and 89 at 19200.
const STOP_BYTES: u64 = 138;
/// Bytes of the longer form of a hold frame, Modbus RTU.
const HOLD_FRAME: u64 = 21;
/// The longest turnaround is judged from this many answers: some seconds.
const RECENT: usize = 256;
/// Of a hundred answers, this many count: the few slowest are mostly delays of this computer, against which shorter
/// replies would not help.
const COUNTED_OF_100: usize = 95;
/// It is judged again after this many answers.
const JUDGED_ANSWERS: u32 = 16;
/// Answers after which the longest turnaround counts as known.
const ANSWERS_MIN: u32 = 64;
/// A learnt turnaround follows new ones by one part in this many.
const FOLLOW: u32 = 8;
/// Data bytes of a CAN frame.
const CAN_PIECE: u16 = 8;
/// Bits of a CAN request and its reply of 8 bytes, stuffed.
const CAN_PIECE_BITS: u64 = 80 + 160;

/// The cost model of one wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct WireCost {
    /// Time of one byte; none where the wire has no speed of its own or it is unknown.
    byte: Duration,
    /// Bytes of a read request.
    request: u16,
    /// Bytes of a reply around its data.
    around: u16,
    /// Silence that the protocol wants between frames.
    gap: Duration,
    /// Most data bytes that one read may ask for.
    window_max: u16,
    /// Most of them that are always in time.
    moving_max: u16,
    /// A window is read in pieces of this many bytes, each of which takes this long on the wire.
    piece: Option<(u16, Duration)>,
    /// A read begins with a group of registers. What a hand makes of a Modbus address inside one is open (manual 2.5): it
    /// may count on in words.
    pub(crate) begins_groups: bool,
}

impl WireCost {
    /// The private framing. Without a baud the line takes no time that is known.
    pub(crate) fn rs485(baud: Option<u32>) -> Self {
        Self {
            byte: baud.map_or(Duration::ZERO, byte_time),
            request: 9,
            around: 8,
            gap: Duration::ZERO,
            window_max: 252,
            moving_max: MOVING_FRAME - 8,
            piece: None,
            begins_groups: false,
        }
    }

    /// Modbus RTU with this silence between frames.
    pub(crate) fn rtu(baud: u32, gap: Duration) -> Self {
        Self {
            byte: byte_time(baud),
            request: 8,
            around: 5,
            gap,
            window_max: 250,
            // An even number of bytes.
            moving_max: MOVING_FRAME - 6,
            piece: None,
            begins_groups: true,
        }
    }

    /// Modbus TCP: a reply takes no time by its length, so that long ones delay no stop.
    pub(crate) const fn tcp() -> Self {
        Self {
            byte: Duration::ZERO,
            request: 12,
            around: 9,
            gap: Duration::ZERO,
            window_max: 250,
            moving_max: 250,
            piece: None,
            begins_groups: true,
        }
    }

    /// CAN: each piece is a transaction of its own, after which a stop may go out.
    pub(crate) fn can(bitrate: u32) -> Self {
        let bits = CAN_PIECE_BITS * 1_000_000_000 / u64::from(bitrate.max(1));
        Self {
            byte: Duration::ZERO,
            request: 0,
            around: 0,
            gap: Duration::ZERO,
            window_max: 250,
            moving_max: MOVING_FRAME - 8,
            piece: Some((CAN_PIECE, Duration::from_nanos(bits))),
            begins_groups: false,
        }
    }

    /// CAN at the rate of delivery behind the maker's adapter, whose serial side is the slower one by far.
    pub(crate) fn usb_can(baud: u32) -> Self {
        let mut cost = Self::can(DEFAULT_BITRATE);
        if let Some((_, time)) = &mut cost.piece {
            *time += packets_time(baud);
        }
        cost
    }

    /// Time that a read of so many bytes keeps the line, given the hand's turnaround.
    pub(crate) fn read(&self, len: u16, turnaround: Duration) -> Duration {
        self.on_wire(len) + turnaround * self.turns(len) + self.gap
    }

    /// The part of it in which bits are on the line.
    pub(crate) fn on_wire(&self, len: u16) -> Duration {
        match self.piece {
            Some((_, time)) => time * self.turns(len),
            None => self.byte * (u32::from(self.request) + u32::from(self.around) + u32::from(len)),
        }
    }

    /// Time in which bits are on the line for a write of this many bytes and its acknowledgement.
    pub(crate) fn write_on_wire(&self, len: u16) -> Duration {
        match self.piece {
            Some((_, time)) => time * self.turns(len),
            None => self.byte * (2 * u32::from(self.around) + u32::from(len) + 1),
        }
    }

    /// True if the speed of the wire is known.
    pub(crate) fn has_speed(&self) -> bool {
        self.piece.is_some() || !self.byte.is_zero()
    }

    /// The silence that follows each reply.
    pub(crate) const fn gap(&self) -> Duration {
        self.gap
    }

    /// Requests that a read of this many bytes takes.
    pub(crate) fn turns(&self, len: u16) -> u32 {
        self.piece
            .map_or(1, |(piece, _)| u32::from(len.div_ceil(piece)).max(1))
    }

    /// Most data bytes of a read while nothing seems to move. A reply is part of what a stop waits for, and a hand may
    /// begin to move at any time, by another master too: so even then no reply is longer than the stop's time allows.
    pub(crate) fn window(&self, longest_turnaround: Duration) -> u16 {
        let byte = u64::try_from(self.byte.as_nanos()).unwrap_or(u64::MAX);
        if byte == 0 {
            return self.window_max;
        }
        let spare = TURNAROUND_MAX.saturating_sub(longest_turnaround) + STOP_SLACK;
        let spare = spare.saturating_sub(self.gap);
        let spare = u64::try_from(spare.as_nanos()).unwrap_or(u64::MAX) / byte;
        let others = u64::from(self.request + self.around) + HOLD_FRAME;
        let most = (STOP_BYTES + spare).saturating_sub(others);
        let most = u16::try_from(most).unwrap_or(u16::MAX) / 2 * 2;
        most.clamp(self.moving_max, self.window_max)
    }

    /// Most data bytes of a read while something may move: some fingertips at once, if a stop is in time behind them.
    /// Pieces of a CAN bus let a stop pass, but come one by one.
    pub(crate) fn window_moving(&self, longest_turnaround: Duration) -> u16 {
        if self.byte.is_zero() {
            return self.moving_max;
        }
        let most = self.window(longest_turnaround).min(MOVING_DATA);
        most.max(self.moving_max)
    }

    /// Most data bytes of a read while a stop waits to be confirmed.
    pub(crate) const fn window_stopping(&self) -> u16 {
        self.moving_max
    }
}

impl Default for WireCost {
    fn default() -> Self {
        Self::rs485(None)
    }
}

/// Time of one byte on a serial line.
pub(crate) fn byte_time(baud: u32) -> Duration {
    Duration::from_nanos(BITS * 1_000_000_000 / u64::from(baud.max(1)))
}

/// Time of the packets that ask for one piece and bring it, on the serial side of the maker's adapter.
pub(crate) fn packets_time(baud: u32) -> Duration {
    byte_time(baud) * u32::try_from(2 * PACKET_MIN).unwrap_or_default()
}

/// The hand's turnaround, as round trips show it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Turnaround {
    typical: Option<Duration>,
    answers: u32,
    /// The last ones, oldest first.
    recent: VecDeque<Duration>,
    longest: Duration,
}

impl Turnaround {
    /// A read of this many bytes was answered after `took`.
    pub(crate) fn learn(&mut self, cost: &WireCost, len: u16, took: Duration) {
        let each = took.saturating_sub(cost.on_wire(len)) / cost.turns(len);
        self.typical = Some(match self.typical {
            Some(typical) => (typical * (FOLLOW - 1) + each) / FOLLOW,
            None => each,
        });
        self.answers = self.answers.saturating_add(1);
        if self.recent.len() == RECENT {
            self.recent.pop_front();
        }
        self.recent.push_back(each);
        if self.answers.is_multiple_of(JUDGED_ANSWERS) {
            let mut sorted: Vec<Duration> = self.recent.iter().copied().collect();
            sorted.sort_unstable();
            let counted = sorted.len() * COUNTED_OF_100 / 100;
            self.longest = sorted.get(counted).copied().unwrap_or(TURNAROUND_MAX);
        }
    }

    /// The turnaround to assume; `None` before the first answer.
    pub(crate) const fn typical(&self) -> Option<Duration> {
        self.typical
    }

    /// The longest of late, without the few slowest; that of the slowest hands as long as not enough is known.
    pub(crate) fn longest(&self) -> Duration {
        if self.answers < ANSWERS_MIN {
            return TURNAROUND_MAX;
        }
        self.longest.min(TURNAROUND_MAX)
    }
}

/// Silence between frames of Modbus RTU: 3.5 characters.
pub(crate) fn rtu_gap(baud: u32) -> Duration {
    if baud > FIXED_GAP_ABOVE {
        FIXED_GAP
    } else {
        byte_time(baud) * 7 / 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// From the press to the last byte of the hold, at worst: the read under way, the gap, the hold frame.
    fn stop(cost: &WireCost, window: u16, turnaround: Duration) -> Duration {
        cost.read(window, turnaround) + cost.byte * u32::try_from(HOLD_FRAME).unwrap_or(0)
    }

    #[test]
    fn a_stop_is_in_time_behind_the_longest_window_at_every_baud_and_turnaround() {
        for (baud, limit) in [(921_600, 19), (115_200, 29), (57_600, 41), (19_200, 89)] {
            let gap = Duration::from_micros(1750);
            for cost in [WireCost::rs485(Some(baud)), WireCost::rtu(baud, gap)] {
                for turnaround in (0..=15).map(|ms| MS * ms) {
                    let window = cost.window(turnaround);
                    let took = stop(&cost, window, turnaround);
                    assert!(
                        took <= MS * limit,
                        "{baud} {turnaround:?} {window} {took:?}"
                    );
                    let moving = stop(&cost, cost.window_moving(turnaround), turnaround);
                    let stopping = cost.window_stopping() + cost.around;
                    assert!(moving <= took && stopping <= MOVING_FRAME);
                }
            }
        }
    }

    #[test]
    fn a_quick_hand_may_be_asked_for_all_that_the_protocol_carries() {
        let cost = WireCost::rs485(Some(115_200));
        assert!(cost.window(MS * 6) >= 174, "three fingertips");
        assert_eq!(cost.window(Duration::ZERO), 252);
        assert!((116..232).contains(&cost.window(MS * 15)), "two fingertips");
        assert_eq!(WireCost::tcp().window(MS * 15), 250);
    }

    #[test]
    fn the_cost_of_a_read_is_that_of_the_manuals_frames() {
        let cost = WireCost::rs485(Some(115_200));
        // Manual 2.2.1: 9 bytes asked, 8 around 12.
        let took = cost.read(12, MS * 3);
        let bits = Duration::from_micros(290 * 1_000_000 / 115_200);
        assert!(
            took.abs_diff(bits + MS * 3) < Duration::from_micros(3),
            "{took:?}"
        );
        let can = WireCost::can(1_000_000);
        assert_eq!(can.read(12, MS), (MS + Duration::from_micros(240)) * 2);
    }

    #[test]
    fn the_turnaround_is_learnt_from_round_trips_and_the_longest_is_kept() {
        let cost = WireCost::rs485(Some(115_200));
        let mut turnaround = Turnaround::default();
        assert_eq!(turnaround.longest(), TURNAROUND_MAX);
        // A slow answer in twenty counts, one in a hundred does not.
        for (one_in, longest) in [(100, MS * 3), (10, MS * 9), (100, MS * 3)] {
            for n in 0..400 {
                let hand = if n % one_in == 0 { MS * 9 } else { MS * 3 };
                turnaround.learn(&cost, 72, cost.on_wire(72) + hand);
            }
            let off = turnaround.longest().abs_diff(longest);
            assert!(
                off < Duration::from_micros(5),
                "{one_in}: {:?}",
                turnaround.longest()
            );
            let typical = turnaround.typical().unwrap_or_default();
            assert!(typical.abs_diff(MS * 3) < MS * 2, "{typical:?}");
        }
    }
}
