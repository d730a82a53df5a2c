//! Cost of a read on a wire, and the maximum length of a reply so that a stop gets through in time. Pure: learns from
//! given round trips, sends and times nothing.

use crate::codec::usbcan::PACKET_MIN;
use crate::transport::Endpoint;
use crate::transport::endpoint::DEFAULT_BITRATE;
use std::collections::VecDeque;
use std::time::Duration;

/// Above this baud rate the silence between frames is constant (Modbus over serial line 1.02, 2.5.1.1).
const FIXED_GAP_ABOVE: u32 = 19_200;
pub(crate) const FIXED_GAP: Duration = Duration::from_micros(1750);
/// Bits of a byte on a serial line: start, eight, stop.
const BITS: u64 = 10;
/// Longest reply frame of a serial line while a stop is being confirmed: one fingertip in the private framing.
const MOVING_FRAME: u16 = 66;
/// Maximum data bytes of a read while the hand may move: three fingertips, between which the motion state comes often.
const MOVING_DATA: u16 = 3 * 58;
/// Slowest turnaround seen in a hand: assumed until measured, and the maximum ever assumed. Shorter replies cannot
/// compensate for an adapter's delay.
const TURNAROUND_MAX: Duration = Duration::from_millis(15);
/// Time budget of a stop besides the hand's turnaround: this computer's part …
const STOP_SLACK: Duration = Duration::from_millis(2);
/// … and this many bytes on the line. With 15 ms of turnaround that is 19 ms from the stop request to the last byte of
/// the hold frame at 921600 baud, 29 at 115200, 41 at 57600 and 89 at 19200.
const STOP_BYTES: u64 = 138;
/// Bytes of the longest hold frame, that of Modbus RTU.
const HOLD_FRAME: u64 = 21;
/// The longest turnaround is taken from this many replies: some seconds.
const RECENT: usize = 256;
/// Percentile used: the few slowest replies are mostly delays of this computer, which shorter replies would not reduce.
const COUNTED_OF_100: usize = 95;
/// It is recomputed after this many replies.
const JUDGED_ANSWERS: u32 = 16;
/// Replies after which the longest turnaround counts as known.
const ANSWERS_MIN: u32 = 64;
/// The typical turnaround moves towards new values by one part in this many.
const FOLLOW: u32 = 8;
/// Data bytes of a CAN frame.
const CAN_PIECE: u16 = 8;
/// Bits of a CAN request and its reply of 8 bytes, with stuffing.
const CAN_PIECE_BITS: u64 = 80 + 160;

/// The cost model of one wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct WireCost {
    /// Time of one byte; zero if the wire has no bit rate or it is unknown.
    byte: Duration,
    /// Bytes of a read request.
    request: u16,
    /// Bytes of a reply around its data.
    around: u16,
    /// Silence that the protocol requires between frames.
    gap: Duration,
    /// Maximum data bytes of one read.
    window_max: u16,
    /// Maximum data bytes that are always in time for a stop.
    moving_max: u16,
    /// Set if a window is read in pieces: bytes per piece, and its time on the wire.
    piece: Option<(u16, Duration)>,
    /// Reads must start at a group of registers. The meaning of a Modbus address inside a group is undefined (manual
    /// 2.5): the hand may count in words there.
    pub(crate) begins_groups: bool,
}

impl WireCost {
    /// Cost on an endpoint's line; `None` where the speed of the line is unknown.
    pub(crate) fn of(endpoint: &Endpoint) -> Option<Self> {
        Some(match endpoint {
            Endpoint::Sim { .. } | Endpoint::Tcp { .. } => return None,
            Endpoint::Rs485(line) => Self::rs485(Some(line.baud)),
            Endpoint::Rtu(line) | Endpoint::RtuTcp(line) => {
                Self::rtu(line.baud, rtu_gap(line.baud))
            }
            // Manual: 2.3 gives the default rate; that of an interface is set outside of this program.
            Endpoint::Can { .. } => Self::can(DEFAULT_BITRATE),
            Endpoint::Slcan { bitrate, .. } => Self::can(*bitrate),
            Endpoint::UsbCan { baud, .. } => Self::usb_can(*baud),
        })
    }

    /// The private framing. Without a baud rate the line time is assumed to be zero.
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

    /// Modbus TCP: the time of a reply does not depend on its length, so that long ones do not delay a stop.
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

    /// CAN: each piece is a transaction of its own, after which a stop may be sent.
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

    /// CAN at the default bit rate behind the maker's adapter, whose serial side is much slower.
    pub(crate) fn usb_can(baud: u32) -> Self {
        let mut cost = Self::can(DEFAULT_BITRATE);
        if let Some((_, time)) = &mut cost.piece {
            *time += packets_time(baud);
        }
        cost
    }

    /// Time for which a read of this many bytes occupies the line, given the hand's turnaround.
    pub(crate) fn read(&self, len: u16, turnaround: Duration) -> Duration {
        self.on_wire(len) + turnaround * self.turns(len) + self.gap
    }

    /// The part of it with bits on the line.
    pub(crate) fn on_wire(&self, len: u16) -> Duration {
        match self.piece {
            Some((_, time)) => time * self.turns(len),
            None => self.byte * (u32::from(self.request) + u32::from(self.around) + u32::from(len)),
        }
    }

    /// Time with bits on the line for a write of this many bytes and its acknowledgement.
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

    /// Number of requests for a read of this many bytes.
    pub(crate) fn turns(&self, len: u16) -> u32 {
        self.piece
            .map_or(1, |(piece, _)| u32::from(len.div_ceil(piece)).max(1))
    }

    /// Maximum data bytes of a read while the hand seems to rest. A stop waits for the reply in progress, and a hand
    /// may start to move at any time, also by another controller: so even then no reply is longer than the stop's time
    /// budget allows.
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

    /// Maximum data bytes of a read while the hand may move: some fingertips at once, if a stop is in time after them.
    /// Pieces on a CAN bus let a stop through in between, but are sent one by one.
    pub(crate) fn window_moving(&self, longest_turnaround: Duration) -> u16 {
        if self.byte.is_zero() {
            return self.moving_max;
        }
        let most = self.window(longest_turnaround).min(MOVING_DATA);
        most.max(self.moving_max)
    }

    /// Maximum data bytes of a read while a stop is being confirmed.
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

/// Time of the request and reply packets of one piece, on the serial side of the maker's adapter.
pub(crate) fn packets_time(baud: u32) -> Duration {
    byte_time(baud) * u32::try_from(2 * PACKET_MIN).unwrap_or_default()
}

/// The hand's turnaround, measured from round trips.
#[derive(Debug, Clone, Default)]
pub(crate) struct Turnaround {
    typical: Option<Duration>,
    answers: u32,
    /// The last values, oldest first.
    recent: VecDeque<Duration>,
    longest: Duration,
}

impl Turnaround {
    /// Records that a read of this many bytes was answered after `took`.
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

    /// The typical turnaround; `None` before the first reply.
    pub(crate) const fn typical(&self) -> Option<Duration> {
        self.typical
    }

    /// The longest recent turnaround, without the few slowest; the assumed maximum until enough is known.
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

    /// Worst case from the stop request to the last byte of the hold frame: the read in progress, the gap, the hold frame.
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
        // Manual 2.2.1: 9 bytes of request, 8 around 12.
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
        // A slow reply in twenty counts, one in a hundred does not.
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
