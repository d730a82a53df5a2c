//! Exceptions instead of replies: time for which a gateway may answer for a hand before the hand counts as gone. Pure.

use crate::hand::{ModbusException, Moment, Presence, Refusal};
use std::time::Duration;

/// A gateway that reports the hand absent for this long is believed; silence takes as long to detect.
const ABSENT_MAX: Duration = Duration::from_millis(288);
/// Time for which a device may report busy; with the time before the first reply, the loss shows within a second.
const BUSY_MAX: Duration = Duration::from_millis(800);
/// Minimum count: a single exception may be a frame that was lost behind the gateway.
const REFUSED_LEAST: u32 = 2;
/// Pause before the next request, so as not to flood a gateway that has no hand behind it.
pub(crate) const REFUSED_PAUSE: Duration = Duration::from_millis(20);

/// Verdict on a refused request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refused {
    /// Refused by the hand, which is therefore present.
    ByHand,
    /// Refused by this program's own rules; nothing was sent.
    Unsent,
    /// Not refused by the hand, which may still answer.
    Unsure,
    /// The hand counts as gone; carries the last exception.
    Gone(ModbusException),
}

/// Consecutive exceptions without an answer of the hand.
#[derive(Debug, Default)]
pub(crate) struct Absence {
    since: Option<Moment>,
    replies: u32,
    last: Option<ModbusException>,
}

impl Absence {
    /// Resets the count: the hand answered.
    pub(crate) fn answered(&mut self) {
        *self = Self::default();
    }

    /// The last exception since the hand answered that did not come from the hand itself.
    pub(crate) const fn last(&self) -> Option<ModbusException> {
        self.last
    }

    /// Records a refusal and judges it.
    pub(crate) fn refused(&mut self, reason: Refusal, now: Moment) -> Refused {
        let Refusal::Exception(exception) = reason else {
            return Refused::Unsent;
        };
        let longest = match exception.presence() {
            Presence::Answers => {
                self.answered();
                return Refused::ByHand;
            }
            Presence::Busy => BUSY_MAX,
            Presence::Absent => ABSENT_MAX,
        };
        self.last = Some(exception);
        self.replies = self.replies.saturating_add(1);
        let since = *self.since.get_or_insert(now);
        if self.replies >= REFUSED_LEAST && now.since(since) >= longest {
            Refused::Gone(exception)
        } else {
            Refused::Unsure
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gone_after(code: u8) -> Option<u64> {
        let mut absence = Absence::default();
        let exception = ModbusException::of(code);
        (0..2000).step_by(20).find(|ms| {
            let now = Moment::from_micros(ms * 1000);
            absence.refused(exception.into(), now) == Refused::Gone(exception)
        })
    }

    #[test]
    fn a_gateway_is_believed_within_a_second_and_the_hands_own_refusals_never_count() {
        for (code, after) in [
            (1, None),
            (2, None),
            (3, None),
            (8, None),
            (0xC8, None),
            (4, Some(300)),
            (10, Some(300)),
            (11, Some(300)),
            (5, Some(800)),
            (6, Some(800)),
        ] {
            assert_eq!(gone_after(code), after, "exception {code}");
        }
    }

    #[test]
    fn an_answer_or_a_refusal_of_the_hand_between_begins_anew() {
        let no_answer = Refusal::Exception(ModbusException::NoAnswer);
        let own = Refusal::Exception(ModbusException::IllegalAddress);
        let mut absence = Absence::default();
        for ms in (0..3000u64).step_by(20) {
            let now = Moment::from_micros(ms * 1000);
            let refused = absence.refused(no_answer, now);
            assert_eq!(refused, Refused::Unsure, "{ms}");
            match ms % 200 {
                0 => absence.answered(),
                100 => assert_eq!(absence.refused(own, now), Refused::ByHand),
                _ => {}
            }
        }
    }
}
