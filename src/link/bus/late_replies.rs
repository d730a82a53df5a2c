//! Questions that may still be answered: given up, or answered once and perhaps once more. On lines without
//! sequence numbers such an answer cannot be told from a fresh one, so the question is not asked again for a while.

use crate::hand::{ModbusException, Moment, Span};
use arrayvec::ArrayVec;
use std::time::Duration;

/// How long a hand may answer late: the slowest known is half a second in flash writing; doubled twice.
pub(crate) const LATE_HORIZON: Duration = Duration::from_secs(2);
/// More open questions than there are shapes to ask; the oldest is forgotten then, and the link is reopened before.
const QUESTIONS_MAX: usize = 32;

/// Answers that a doubled run of replies may hold: more than fit into what an adapter passes on at once.
const ANSWERED_MAX: usize = 6;

/// Shortest wait for a reply: a hand takes up to 15 ms, a USB adapter up to 16 more.
pub(crate) const REPLY_LIMIT_MIN: Duration = Duration::from_millis(50);
/// Longest wait for a reply that is known to come late: two of them show silence within a second.
const SLOW_LIMIT_MAX: Duration = Duration::from_millis(450);

/// A reply that came after its request was given up. Only where replies carry numbers is it known as that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LateReply {
    /// From the request to the reply.
    pub(crate) took: Duration,
    /// What it says, if it is an exception.
    pub(crate) exception: Option<ModbusException>,
}

/// How long to wait where a reply took so long before.
pub(crate) fn slow_limit(took: Duration) -> Duration {
    (took + took / 4 + REPLY_LIMIT_MIN).min(SLOW_LIMIT_MAX)
}

/// The spans that a late reply may still answer.
#[derive(Debug, Default)]
pub(crate) struct LateReplies {
    asked: ArrayVec<(Span, Moment), QUESTIONS_MAX>,
    /// What was answered last, oldest first. A doubled reply comes before the reply to anything asked later …
    answered: ArrayVec<Span, ANSWERED_MAX>,
    /// … unless a whole run of replies was doubled: then a reply that nobody asked for came here first.
    unasked: Option<Moment>,
}

impl LateReplies {
    /// A read of this span was given up at `now`.
    pub(crate) fn gave_up(&mut self, span: Span, now: Moment) {
        self.forget(now);
        if self.asked.is_full() {
            self.asked.remove(0);
        }
        self.asked.push((span, now));
    }

    /// A request was answered; the span if it was a read.
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

    /// An unexpected reply has come: one open request less, and doubles must be expected.
    pub(crate) fn arrived(&mut self, span: Span, now: Moment) {
        self.unasked = Some(now);
        if let Some(at) = self.asked.iter().position(|(asked, _)| *asked == span) {
            self.asked.remove(at);
        }
    }

    /// An unexpected reply has come that does not identify its request: all stay open, and doubles must be expected.
    pub(crate) fn strayed(&mut self, now: Moment) {
        self.unasked = Some(now);
    }

    /// The first of these spans that no late or doubled reply can answer.
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
