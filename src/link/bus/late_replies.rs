//! Requests that may still be answered: timed out, or answered once and possibly duplicated. On lines without sequence
//! numbers such a reply cannot be distinguished from a fresh one, so the request is not repeated for a while.

use crate::hand::{ModbusException, Moment, Span};
use arrayvec::ArrayVec;
use std::time::Duration;

/// Time within which a late reply may arrive: the slowest known is half a second, during flash writing; doubled twice.
pub(crate) const LATE_HORIZON: Duration = Duration::from_secs(2);
/// Maximum open requests: more than there are read shapes; the oldest is dropped then, and the link is reopened before that.
const QUESTIONS_MAX: usize = 32;

/// Replies that a duplicated run may contain: more than an adapter forwards at once.
const ANSWERED_MAX: usize = 6;

/// Shortest wait for a reply: a hand takes up to 15 ms, a USB adapter up to 16 more.
pub(crate) const REPLY_LIMIT_MIN: Duration = Duration::from_millis(50);
/// Longest wait for a reply that is known to be late: two of them show silence within a second.
const SLOW_LIMIT_MAX: Duration = Duration::from_millis(450);

/// A reply that came after its request timed out. Only identifiable where replies carry numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LateReply {
    /// Time from the request to the reply.
    pub(crate) took: Duration,
    /// The exception, if the reply is one.
    pub(crate) exception: Option<ModbusException>,
}

/// Wait for the next reply after one that took this long.
pub(crate) fn slow_limit(took: Duration) -> Duration {
    (took + took / 4 + REPLY_LIMIT_MIN).min(SLOW_LIMIT_MAX)
}

/// The spans that a late reply may still answer.
#[derive(Debug, Default)]
pub(crate) struct LateReplies {
    asked: ArrayVec<(Span, Moment), QUESTIONS_MAX>,
    /// The last answered reads, oldest first. A duplicate precedes the reply to any later request …
    answered: ArrayVec<Span, ANSWERED_MAX>,
    /// … unless a whole run of replies was duplicated: then an unrequested reply was received first, at this time.
    unasked: Option<Moment>,
}

impl LateReplies {
    /// Records that a read of this span timed out at `now`.
    pub(crate) fn gave_up(&mut self, span: Span, now: Moment) {
        self.forget(now);
        if self.asked.is_full() {
            self.asked.remove(0);
        }
        self.asked.push((span, now));
    }

    /// Records that a request was answered; `span` if it was a read.
    pub(crate) fn answered(&mut self, span: Option<Span>) {
        let Some(span) = span else {
            // The reply to a write ends the run.
            self.answered.clear();
            return;
        };
        if self.answered.is_full() {
            self.answered.remove(0);
        }
        self.answered.push(span);
    }

    /// Records an unexpected reply to a known request: that request is closed, and duplicates must be expected.
    pub(crate) fn arrived(&mut self, span: Span, now: Moment) {
        self.unasked = Some(now);
        if let Some(at) = self.asked.iter().position(|(asked, _)| *asked == span) {
            self.asked.remove(at);
        }
    }

    /// Records an unexpected reply that does not identify its request: all stay open, and duplicates must be expected.
    pub(crate) fn strayed(&mut self, now: Moment) {
        self.unasked = Some(now);
    }

    /// The first of these spans that no late or duplicate reply can answer.
    pub(crate) fn first_clear(&mut self, shapes: &[Span], now: Moment) -> Option<Span> {
        self.forget(now);
        let wary = self.unasked.is_some_and(|at| now.since(at) < LATE_HORIZON);
        let doubtful = if wary { ANSWERED_MAX } else { 1 };
        shapes.iter().copied().find(|shape| {
            self.asked.iter().all(|(asked, _)| asked != shape)
                && self
                    .answered
                    .iter()
                    .rev()
                    .take(doubtful)
                    .all(|answered| answered != shape)
        })
    }

    fn forget(&mut self, now: Moment) {
        self.asked.retain(|(_, at)| now.since(*at) < LATE_HORIZON);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_question_answered_is_not_asked_again_at_once() {
        let (a, b) = (Span::new(1546, 78), Span::new(1546, 72));
        let mut late = LateReplies::default();
        late.answered(Some(a));
        assert_eq!(late.first_clear(&[a], Moment::ZERO), None);
        assert_eq!(late.first_clear(&[a, b], Moment::ZERO), Some(b));
        late.answered(Some(b));
        assert_eq!(late.first_clear(&[a], Moment::ZERO), Some(a));
        late.answered(None);
        assert_eq!(late.first_clear(&[b], Moment::ZERO), Some(b));
    }

    #[test]
    fn after_a_reply_that_nobody_asked_for_older_questions_are_avoided_too() {
        let (a, b, c) = (
            Span::new(1546, 78),
            Span::new(1546, 72),
            Span::new(1544, 80),
        );
        let mut late = LateReplies::default();
        late.answered(Some(a));
        late.answered(Some(b));
        late.arrived(c, Moment::ZERO);
        assert_eq!(late.first_clear(&[a, b, c], Moment::ZERO), Some(c));
        let later = Moment::ZERO.plus(LATE_HORIZON);
        assert_eq!(late.first_clear(&[a, b, c], later), Some(a));
    }

    #[test]
    fn a_question_given_up_is_not_asked_again_within_the_horizon() {
        let (a, b) = (Span::new(1546, 78), Span::new(1546, 72));
        let mut late = LateReplies::default();
        assert_eq!(late.first_clear(&[a, b], Moment::ZERO), Some(a));
        late.gave_up(a, Moment::ZERO);
        assert_eq!(late.first_clear(&[a, b], Moment::ZERO), Some(b));
        late.gave_up(b, Moment::ZERO);
        assert_eq!(late.first_clear(&[a, b], Moment::ZERO), None);
        late.arrived(a, Moment::ZERO);
        assert_eq!(late.first_clear(&[b, a], Moment::ZERO), Some(a));
        assert_eq!(
            late.first_clear(&[b], Moment::ZERO.plus(LATE_HORIZON)),
            Some(b)
        );
    }
}
