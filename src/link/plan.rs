//! What to read next, and when. Pure: time comes in, spans go out; nothing is sent here.

use crate::hand::register::{SETPOINTS, STATE, TOUCH};
use crate::hand::{Moment, Span};
use arrayvec::ArrayVec;
use std::time::Duration;

/// STATE without TEMP: temperatures need no second read in a row, and two shapes in turn keep a
/// doubled reply from being taken for the next one.
const STATE_SHORT_LEN: u16 = 72;
/// POS_ACT may be read along in steps of a joint: more shapes for a line that carries late replies.
const POSITIONS: u16 = 6;
/// Bytes of one fingertip.
const TIP: u16 = 58;
/// Ways to split five fingertips into two reads of at most 250 bytes.
const SPLITS: [u16; 4] = [4, 3, 2, 1];

/// Groups that are wanted without limit count as this fast when they are weighed against slow ones.
const SHORTEST_PERIOD: Duration = Duration::from_millis(5);

/// How often each group is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PollRates {
    /// Motion states a second; infinite = as fast as the wire goes.
    pub state_hz: f64,
    /// Sweeps over all fingertips a second; infinite = as fast as the wire goes.
    pub tactile_hz: f64,
    /// Reads of the setpoints that the hand holds, a second.
    pub settings_hz: f64,
}

impl Default for PollRates {
    fn default() -> Self {
        Self {
            state_hz: 100.0,
            tactile_hz: 30.0,
            settings_hz: 2.0,
        }
    }
}

impl PollRates {
    /// As fast as the wire goes, states and fingertips in turn.
    pub const FULL: Self = Self {
        state_hz: f64::INFINITY,
        tactile_hz: f64::INFINITY,
        settings_hz: 2.0,
    };
}

/// One group of reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Poll {
    State,
    Tactile,
    Settings,
}

/// Due times of one group.
#[derive(Debug, Clone, Copy)]
struct Due {
    poll: Poll,
    period: Duration,
    next: Moment,
}

/// Decides what is read next.
#[derive(Debug)]
pub(crate) struct PollPlan {
    groups: [Due; 3],
    turn: usize,
    split: usize,
    second_half: bool,
}

impl PollPlan {
    pub(crate) fn new(rates: PollRates, now: Moment) -> Self {
        let due = |poll, hz: f64| Due {
            poll,
            period: period(hz),
            next: now,
        };
        Self {
            groups: [
                due(Poll::State, rates.state_hz),
                due(Poll::Tactile, rates.tactile_hz),
                due(Poll::Settings, rates.settings_hz),
            ],
            turn: 0,
            split: 0,
            second_half: false,
        }
    }

    /// The group whose turn it is, if any is due: the one that waited longest measured in its own
    /// periods, so that a full line serves all in proportion and none starves.
    pub(crate) fn due(&self, now: Moment) -> Option<Poll> {
        self.groups
            .iter()
            .filter(|group| group.next <= now)
            .max_by_key(|group| group.lateness(now))
            .map(|group| group.poll)
    }

    /// When the next group is due.
    pub(crate) fn next_due(&self) -> Moment {
        self.groups
            .iter()
            .map(|group| group.next)
            .min()
            .unwrap_or(Moment::ZERO)
    }

    /// The group was asked at `now`: its next time is one period on, without catching up. A sweep of
    /// fingertips takes two reads, of which the first only turns the page.
    pub(crate) fn done(&mut self, poll: Poll, now: Moment) {
        match poll {
            Poll::State => self.turn += 1,
            Poll::Tactile if !self.second_half => {
                self.second_half = true;
                return;
            }
            Poll::Tactile => {
                self.second_half = false;
                self.split += 1;
            }
            Poll::Settings => {}
        }
        for group in &mut self.groups {
            if group.poll == poll {
                group.next = group.next.plus(group.period).max(now);
            }
        }
    }

    /// Reads a group as soon as possible: something was just written that it shows.
    pub(crate) fn hasten(&mut self, poll: Poll, now: Moment) {
        for group in &mut self.groups {
            if group.poll == poll {
                group.next = group.next.min(now);
            }
        }
    }

    /// Does not read a group before `until`.
    pub(crate) fn postpone(&mut self, poll: Poll, until: Moment) {
        for group in &mut self.groups {
            if group.poll == poll {
                group.next = group.next.max(until);
            }
        }
    }

    /// When this group is due.
    pub(crate) fn next_due_of(&self, poll: Poll) -> Moment {
        let due = self.groups.iter().find(|group| group.poll == poll);
        due.map_or(Moment::ZERO, |group| group.next)
    }

    /// The span to read for a group, in the order of preference; the caller takes the first that no
    /// late reply can be mistaken for.
    pub(crate) fn shapes(&self, poll: Poll) -> ArrayVec<Span, 16> {
        match poll {
            Poll::State => self.state_shapes(),
            Poll::Tactile => self.tactile_shapes(),
            Poll::Settings => (0..POSITIONS)
                .map(|n| Span::new(SETPOINTS.address, SETPOINTS.len + 2 * n))
                .collect(),
        }
    }

    /// True while the second half of a sweep is to be read.
    pub(crate) fn in_second_half(&self) -> bool {
        self.second_half
    }

    fn state_shapes(&self) -> ArrayVec<Span, 16> {
        let mut shapes = ArrayVec::new();
        let lens = [STATE.len, STATE_SHORT_LEN];
        let ordered = if self.turn.is_multiple_of(2) {
            lens
        } else {
            [lens[1], lens[0]]
        };
        for joints in 0..=POSITIONS {
            for len in ordered {
                let ahead = 2 * joints;
                shapes.push(Span::new(STATE.address - ahead, len + ahead));
            }
        }
        shapes
    }

    fn tactile_shapes(&self) -> ArrayVec<Span, 16> {
        let ways = SPLITS.len();
        let turns = if self.second_half { 0..1 } else { 0..ways };
        turns
            .filter_map(|turn| SPLITS.get((self.split + turn) % ways))
            .map(|fingers| {
                if self.second_half {
                    Span::new(TOUCH.address + TIP * fingers, TIP * (5 - fingers))
                } else {
                    Span::new(TOUCH.address, TIP * fingers)
                }
            })
            .collect()
    }

    /// The first half was read with this shape: the second half is what it left.
    pub(crate) fn split_at(&mut self, span: Span) {
        if let Some(split) = SPLITS.iter().position(|fingers| fingers * TIP == span.len) {
            self.split = split;
        }
    }

    /// Gives a sweep up after its first half, so that the next begins anew with another split.
    pub(crate) fn drop_sweep(&mut self, now: Moment) {
        self.second_half = true;
        self.done(Poll::Tactile, now);
    }
}

impl Due {
    fn lateness(&self, now: Moment) -> u128 {
        let late = now.since(self.next).as_micros() + 1;
        late * 1_000_000 / self.period.max(SHORTEST_PERIOD).as_micros()
    }
}

fn period(hz: f64) -> Duration {
    if hz > 0.0 {
        Duration::try_from_secs_f64(1.0 / hz).unwrap_or(Duration::MAX)
    } else {
        Duration::from_secs(u64::from(u32::MAX))
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        reason = "a test may"
    )]
    use super::*;

    const EXCHANGE: Duration = Duration::from_micros(200);

    /// Runs the plan on a line where each read takes `EXCHANGE`; counts whole polls per group.
    fn run(rates: PollRates, exchange: Duration, length: Duration) -> (Vec<Poll>, [u32; 3]) {
        let mut now = Moment::ZERO;
        let mut plan = PollPlan::new(rates, now);
        let (mut order, mut counts) = (Vec::new(), [0; 3]);
        while now < Moment::ZERO.plus(length) {
            let Some(poll) = plan.due(now) else {
                now = plan.next_due();
                continue;
            };
            now = now.plus(exchange);
            let whole = poll != Poll::Tactile || plan.in_second_half();
            plan.done(poll, now);
            order.push(poll);
            counts[poll as usize] += u32::from(whole);
        }
        (order, counts)
    }

    #[test]
    fn rates_are_kept_where_the_line_allows() {
        let (_, [state, tactile, settings]) =
            run(PollRates::default(), EXCHANGE, Duration::from_secs(10));
        assert!((990..=1001).contains(&state), "{state}");
        assert!((290..=301).contains(&tactile), "{tactile}");
        assert!((19..=21).contains(&settings), "{settings}");
    }

    #[test]
    fn nothing_starves_on_a_line_that_is_too_slow() {
        let (_, [state, tactile, settings]) = run(
            PollRates::default(),
            Duration::from_millis(15),
            Duration::from_secs(10),
        );
        assert!(
            state > 200 && tactile > 60 && settings >= 10,
            "{state} {tactile} {settings}"
        );
    }

    #[test]
    fn at_full_rate_states_and_sweeps_take_turns() {
        let (order, [state, tactile, settings]) =
            run(PollRates::FULL, EXCHANGE, Duration::from_secs(2));
        assert!(state.abs_diff(tactile) <= 1 + settings, "{state} {tactile}");
        assert!((3..=5).contains(&settings));
        assert_eq!(
            order[..4]
                .iter()
                .filter(|poll| **poll == Poll::State)
                .count(),
            1
        );
    }

    #[test]
    fn two_states_in_a_row_never_have_the_same_shape() {
        let mut plan = PollPlan::new(PollRates::FULL, Moment::ZERO);
        let mut last = None;
        for _ in 0..10 {
            let shape = plan.shapes(Poll::State)[0];
            assert_ne!(last, Some(shape));
            assert!(shape.covers(Span::new(1546, 72)));
            last = Some(shape);
            plan.done(Poll::State, Moment::ZERO);
        }
        assert_eq!(plan.shapes(Poll::State).len(), 14);
    }

    #[test]
    fn both_halves_of_every_split_cover_all_fingers_within_the_limits() {
        let mut plan = PollPlan::new(PollRates::FULL, Moment::ZERO);
        for _ in 0..SPLITS.len() {
            for first in plan.shapes(Poll::Tactile) {
                let mut half = PollPlan::new(PollRates::FULL, Moment::ZERO);
                half.split_at(first);
                half.done(Poll::Tactile, Moment::ZERO);
                let second = half.shapes(Poll::Tactile)[0];
                assert_eq!((first.address, second.end()), (TOUCH.address, TOUCH.end()));
                assert_eq!(first.end(), u32::from(second.address));
                assert!(first.len <= 250 && second.len <= 250);
            }
            plan.drop_sweep(Moment::ZERO);
        }
    }
}
