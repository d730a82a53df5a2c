//! Which frames of the traffic view pass, and the list of those that do, kept up to date without going through all of
//! them for each frame of the window. Draws nothing.

use crate::hand::{REGISTERS, Span};
use crate::link::tap::Direction;
use crate::link::traffic::frame::Frame;
use std::collections::VecDeque;
use std::sync::Arc;

/// The newest frames may still change, or be sorted in: as many as the reader looks back, and some.
const UNSETTLED: u64 = 128;

/// What a person wants to see.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Filter {
    /// Part of a register's name, or bytes in hex; empty for all.
    pub(crate) text: String,
    /// Only this way.
    pub(crate) direction: Option<Direction>,
    /// Only with something wrong.
    pub(crate) wrong_only: bool,
    /// Without the regular reads.
    pub(crate) hide_polling: bool,
    /// Only with a larger number: the list was cleared at this one.
    pub(crate) cleared: u64,
}

/// A filter that was looked through once, for thousands of frames.
struct Test<'a> {
    filter: &'a Filter,
    /// The registers whose name has the text in it.
    spans: Vec<Span>,
    /// The text as hex digits, if it is.
    digits: Vec<u8>,
    any: bool,
}

impl<'a> Test<'a> {
    fn new(filter: &'a Filter) -> Self {
        let text = filter.text.trim().to_ascii_uppercase();
        let digits: Vec<u8> = text.bytes().filter(|sign| *sign != b' ').collect();
        let is_hex = digits.len() >= 2 && digits.iter().all(u8::is_ascii_hexdigit);
        let named = REGISTERS.iter().filter(|row| row.name.contains(&text));
        Self {
            filter,
            spans: named.map(|row| row.span()).collect(),
            digits: if is_hex { digits } else { Vec::new() },
            any: text.is_empty(),
        }
    }

    fn passes(&self, frame: &Frame) -> bool {
        let filter = self.filter;
        frame.number > filter.cleared
            && filter.direction.is_none_or(|way| way == frame.direction)
            && !(filter.wrong_only && frame.wrong.is_none())
            && !(filter.hide_polling && frame.is_polling())
            && (self.any || self.has_name(frame) || self.has_bytes(frame))
    }

    fn has_name(&self, frame: &Frame) -> bool {
        frame.span.is_some_and(|span| {
            let touches = |row: &Span| {
                u32::from(row.address) < span.end() && u32::from(span.address) < row.end()
            };
            self.spans.iter().any(touches)
        })
    }

    fn has_bytes(&self, frame: &Frame) -> bool {
        let half = |at: usize| {
            let byte = frame.bytes.get(at / 2).copied().unwrap_or_default();
            let half = if at.is_multiple_of(2) {
                byte >> 4
            } else {
                byte & 15
            };
            if half < 10 {
                b'0' + half
            } else {
                b'A' + half - 10
            }
        };
        let len = self.digits.len();
        let last = (frame.bytes.len() * 2).checked_sub(len);
        // Hex is searched byte by byte, as it is shown.
        !self.digits.is_empty()
            && last.is_some_and(|last| {
                (0..=last).step_by(2).any(|from| {
                    (from..)
                        .zip(&self.digits)
                        .all(|(at, digit)| half(at) == *digit)
                })
            })
    }
}

/// The frames that pass, oldest first.
#[derive(Debug, Default)]
pub(crate) struct Passed {
    frames: VecDeque<Arc<Frame>>,
    filter: Filter,
    changes: u64,
    newest: u64,
}

impl Passed {
    /// Brings the list up to date with `all`, which have seen so many changes.
    pub(crate) fn update(&mut self, all: &VecDeque<Arc<Frame>>, changes: u64, filter: &Filter) {
        let newest = all.iter().rev().take(64).map(|frame| frame.number).max();
        let newest = newest.unwrap_or_default();
        let same = self.filter == *filter && newest >= self.newest && changes >= self.changes;
        if same && changes == self.changes {
            return;
        }
        let test = Test::new(filter);
        if same {
            self.go_on(all, newest, &test);
        } else {
            let passing = all.iter().filter(|frame| test.passes(frame));
            self.frames = passing.cloned().collect();
            self.filter.clone_from(filter);
        }
        self.changes = changes;
        self.newest = newest;
    }

    fn go_on(&mut self, all: &VecDeque<Arc<Frame>>, newest: u64, test: &Test<'_>) {
        let settled = self.newest.saturating_sub(UNSETTLED);
        while self
            .frames
            .back()
            .is_some_and(|frame| frame.number > settled)
        {
            self.frames.pop_back();
        }
        let oldest = all.front().map_or(0, |frame| frame.number);
        while self
            .frames
            .front()
            .is_some_and(|frame| frame.number < oldest)
        {
            self.frames.pop_front();
        }
        let behind = usize::try_from(newest - settled + UNSETTLED).unwrap_or(usize::MAX);
        let from = all.len().saturating_sub(behind);
        let fresh = all.range(from..).filter(|frame| frame.number > settled);
        self.frames
            .extend(fresh.filter(|frame| test.passes(frame)).cloned());
    }

    /// Oldest first.
    pub(crate) const fn frames(&self) -> &VecDeque<Arc<Frame>> {
        &self.frames
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Moment;
    use crate::link::tap::{PieceKind, WireTap};
    use crate::link::traffic::Traffic;
    use crate::link::traffic::frame::Wrong;

    const ASK: [u8; 9] = [0xEB, 0x90, 1, 4, 0x11, 0x0A, 0x06, 12, 0x32];
    const SAVE: [u8; 9] = [0xEB, 0x90, 1, 4, 0x12, 0xED, 3, 1, 0x08];

    fn numbers(passed: &Passed) -> Vec<u64> {
        passed.frames().iter().map(|frame| frame.number).collect()
    }

    fn traffic() -> (WireTap, Traffic) {
        let tap = WireTap::default();
        let traffic = Traffic::of(tap.clone(), &"rs485:x".parse().unwrap());
        (tap, traffic)
    }

    fn record(tap: &WireTap, n: u64) {
        let (kind, bytes): (_, &[u8]) = match n % 4 {
            0 => (PieceKind::Bytes(Direction::ToHand), &ASK),
            1 => (PieceKind::Bytes(Direction::FromHand), &[1, 2, 3]),
            2 => (PieceKind::Bytes(Direction::ToHand), &SAVE),
            _ => (PieceKind::Opened, &[]),
        };
        tap.record(Moment::from_micros(n * 9_000), kind, bytes);
    }

    #[test]
    fn each_filter_lets_pass_what_it_says() {
        let (tap, mut traffic) = traffic();
        (0..3).for_each(|n| record(&tap, n));
        traffic.read_on(Moment::from_micros(900_000));
        let with = |change: fn(&mut Filter)| {
            let mut filter = Filter::default();
            change(&mut filter);
            let mut passed = Passed::default();
            passed.update(traffic.frames(), traffic.changes(), &filter);
            let frames = passed.frames().iter();
            frames.map(|frame| frame.hex()).collect::<Vec<_>>()
        };
        let [ask, noise, save] =
            [&ASK[..], &[1, 2, 3], &SAVE].map(crate::link::traffic::frame::hex);
        assert_eq!(with(|_| {}).len(), 3);
        assert_eq!(
            with(|filter| filter.text = "angle".into()),
            vec![ask.clone()]
        );
        assert_eq!(
            with(|filter| filter.text = "01 02".into()),
            vec![noise.clone()]
        );
        assert_eq!(with(|filter| filter.text = "eb90".into()).len(), 2);
        assert_eq!(with(|filter| filter.text = "b901".into()).len(), 0);
        let out = |filter: &mut Filter| filter.direction = Some(Direction::ToHand);
        assert_eq!(with(out), [ask.clone(), save.clone()]);
        assert_eq!(with(|filter| filter.cleared = 1).len(), 2);
        // The read that got no answer is not plain polling.
        assert_eq!(with(|filter| filter.hide_polling = true).len(), 3);
        assert!(with(|filter| filter.wrong_only = true).contains(&noise));
    }

    #[test]
    fn a_list_that_is_kept_up_to_date_equals_one_made_anew() {
        for change in [
            |_: &mut Filter| {},
            |filter: &mut Filter| filter.wrong_only = true,
            |filter: &mut Filter| filter.text = "save".into(),
        ] {
            let mut filter = Filter::default();
            change(&mut filter);
            let (tap, mut traffic) = traffic();
            let mut kept = Passed::default();
            for n in 0..13_000 {
                record(&tap, n);
                if n % 37 == 0 {
                    traffic.read_on(Moment::from_micros(n * 9_000));
                    kept.update(traffic.frames(), traffic.changes(), &filter);
                }
                if n % 1480 == 0 {
                    let mut anew = Passed::default();
                    anew.update(traffic.frames(), traffic.changes(), &filter);
                    assert_eq!(numbers(&kept), numbers(&anew));
                    let wrongs = |passed: &Passed| -> Vec<Option<Wrong>> {
                        passed.frames().iter().map(|frame| frame.wrong).collect()
                    };
                    assert_eq!(wrongs(&kept), wrongs(&anew));
                }
            }
        }
    }
}
