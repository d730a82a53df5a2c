//! One thing asked of a hand at a place: the link goes there, waits for the hand, asks, and asks again while it may. Decides
//! nothing about what the answer means.

use crate::app::desk::Desk;
use crate::hand::Moment;
use crate::link::{NotSent, Outcome, Request, RequestError, Reset, Saved};
use crate::transport::Endpoint;
use std::time::Duration;

/// A hand that is there answers within this, also on a port that was given up a moment ago.
const REACHED_WITHIN: Duration = Duration::from_secs(3);
/// A hand that still moves, or saved just now, is waited for this long.
const RESTS_WITHIN: Duration = Duration::from_secs(8);
/// Longer than any request takes: a calibration is given 8 s.
const ENDS_WITHIN: Duration = Duration::from_secs(12);
/// So often it is asked again.
const AGAIN_AFTER: Duration = Duration::from_millis(200);

/// What is to be done for it now.
#[derive(Debug, PartialEq)]
pub(crate) enum Poll {
    /// Open the link there.
    Go(Endpoint),
    /// Nothing.
    Wait,
    /// It is over.
    Done(Answer),
}

/// How it ended.
#[derive(Debug, PartialEq)]
pub(crate) enum Answer {
    /// No hand was reached there. Nothing was asked.
    Unreached,
    /// As the link says.
    Ended(Result<Outcome, RequestError>),
}

/// One thing to be asked.
#[derive(Debug)]
pub(crate) struct Errand {
    place: Endpoint,
    request: Request,
    begun: Option<Moment>,
    step: Step,
}

#[derive(Debug, Clone, Copy)]
enum Step {
    New,
    Waiting { from: Moment, until: Moment },
    Asked { since: Moment },
}

impl Errand {
    pub(crate) const fn new(place: Endpoint, request: Request) -> Self {
        Self {
            place,
            request,
            begun: None,
            step: Step::New,
        }
    }

    pub(crate) fn poll(&mut self, desk: &mut Desk, now: Moment) -> Poll {
        let begun = *self.begun.get_or_insert(now);
        match self.step {
            Step::New => {
                self.wait(now);
                match desk.state.endpoint.as_ref() == Some(&self.place) {
                    true => Poll::Wait,
                    false => Poll::Go(self.place.clone()),
                }
            }
            Step::Waiting { until, .. } if until <= now => Poll::Done(Answer::Unreached),
            Step::Waiting { from, .. } if now < from || !desk.state.link.state.is_live() => {
                Poll::Wait
            }
            Step::Waiting { .. } => match desk.ask_own(self.request) {
                Ok(()) => {
                    self.step = Step::Asked { since: now };
                    Poll::Wait
                }
                // The link was lost just now.
                Err(RequestError::NotConnected) => Poll::Wait,
                Err(error) => Poll::Done(Answer::Ended(Err(error))),
            },
            Step::Asked { since } => match desk.take_own() {
                Some(end) if now.since(begun) < RESTS_WITHIN && self.may_repeat(&end) => {
                    self.wait(now.plus(AGAIN_AFTER));
                    Poll::Wait
                }
                Some(end) => Poll::Done(Answer::Ended(end)),
                None if now.since(since) >= ENDS_WITHIN => {
                    Poll::Done(Answer::Ended(Err(RequestError::LinkLost)))
                }
                None => Poll::Wait,
            },
        }
    }

    fn wait(&mut self, from: Moment) {
        let until = from.plus(REACHED_WITHIN);
        self.step = Step::Waiting { from, until };
    }

    /// Only what changes nothing, or was not sent, is asked again by itself.
    fn may_repeat(&self, end: &Result<Outcome, RequestError>) -> bool {
        use RequestError as E;
        match end {
            Ok(outcome) => is_not_yet(outcome),
            Err(E::Refused { .. } | E::TooLong { .. }) => false,
            Err(_) => matches!(self.request, Request::Read(_)),
        }
    }
}

/// Nothing was sent, and a moment later it may be.
const fn is_not_yet(outcome: &Outcome) -> bool {
    matches!(
        outcome,
        Outcome::Saved(Saved::NotSent(
            NotSent::Moving | NotSent::Holding | NotSent::TooSoon { .. }
        )) | Outcome::Reset(Reset::NotSent(
            NotSent::Moving | NotSent::Holding | NotSent::TooSoon { .. }
        ))
    )
}
