//! Requests of the window on their way: writes that go out one a step, and reads of any memory. Motion among them
//! needs arming, like every other.

use crate::hand::{HandCommand, RegisterWrite, Span, Writes};
use crate::link::bus::{Bus, BusError};
use crate::link::event::{Outcome, Request, RequestError, Ticket};
use crate::link::late::LATE_HORIZON;
use crate::link::motion::hold_targets;
use crate::link::session::{End, Session};
use crate::link::status::LinkState;
use arrayvec::ArrayVec;
use std::sync::Arc;

/// Writes of one job: those of the longest command, and the hold before clearing errors.
const JOB_MAX: usize = 7;

/// A request that is under way: its writes go out one a step.
pub(crate) struct Job {
    pub(crate) ticket: Ticket,
    writes: ArrayVec<RegisterWrite, JOB_MAX>,
    read: Option<Span>,
    /// Another answer was asked for, so that the read cannot be taken for a double of the last.
    cleared: bool,
    pub(crate) is_motion: bool,
}

impl Job {
    const fn reading(ticket: Ticket, span: Span) -> Self {
        Self {
            ticket,
            writes: ArrayVec::new_const(),
            read: Some(span),
            cleared: false,
            is_motion: false,
        }
    }
}

impl Session {
    /// True if a request is under way or one was waiting. Settings have a place of their own.
    pub(crate) fn next_job(&mut self) -> bool {
        // One that is answered at once leaves the turn to the next.
        while self.job.is_none()
            && self.settling.is_none()
            && let Ok((ticket, request)) = self.ends.requests.try_recv()
        {
            self.take_job(ticket, request);
        }
        self.job.is_some() || self.settling.is_some()
    }

    pub(crate) fn take_job(&mut self, ticket: Ticket, request: Request) {
        let mut job = Job {
            ticket,
            writes: ArrayVec::new(),
            read: None,
            cleared: false,
            is_motion: false,
        };
        match request {
            Request::Read(span) => job.read = Some(span),
            Request::Set(_) | Request::Save | Request::Reset | Request::Calibrate => {
                self.take_settling(ticket, request);
                return;
            }
            Request::Command(command) => {
                job.is_motion = command.is_motion();
                if job.is_motion && self.status.state != LinkState::Armed {
                    self.answer(ticket, Err(RequestError::NotArmed));
                    return;
                }
                // A cleared fault may set free a move to an old target: the pose is made the target first.
                if command == HandCommand::ClearErrors {
                    extend(
                        &mut job.writes,
                        HandCommand::Angles(hold_targets(&self.sample, self.now())).writes(),
                    );
                }
                extend(&mut job.writes, command.writes());
            }
        }
        self.job = Some(job);
    }

    /// Sends the next write of the request under way, or its read, and answers when all is done.
    pub(crate) async fn work(&mut self, bus: &mut Bus) -> Result<(), End> {
        let Some(mut job) = self.job.take() else {
            return self.settle(bus).await;
        };
        if let Some(span) = job.read {
            if !job.cleared && bus.choose(&[span]).is_none() {
                // The same question was answered just now; any other answer clears the line of doubles.
                job.cleared = true;
                self.job = Some(job);
                return self.poll_motion(bus).await;
            }
            return self.read_for(bus, job.ticket, span).await;
        }
        let Some(write) = job.writes.pop_at(0) else {
            self.answer(job.ticket, Ok(Outcome::Acknowledged));
            return Ok(());
        };
        if job.is_motion {
            self.moving.commanded(self.now());
        }
        let result = self.write(bus, &write).await;
        match result {
            Ok(()) if job.writes.is_empty() => self.answer(job.ticket, Ok(Outcome::Acknowledged)),
            Ok(()) => self.job = Some(job),
            Err(error) => {
                self.answer(job.ticket, Err(request_error(&error, write.span())));
                self.failed(bus, &error).await?;
            }
        }
        Ok(())
    }

    async fn read_for(&mut self, bus: &mut Bus, ticket: Ticket, span: Span) -> Result<(), End> {
        if bus.choose(&[span]).is_none() || self.looks_like_save(span) {
            let (address, wait_s) = (span.address, LATE_HORIZON.as_secs());
            self.answer(ticket, Err(RequestError::Ambiguous { address, wait_s }));
            return Ok(());
        }
        let limit = self.reply_limit(bus, span.len);
        let asked = self.now();
        let wanted = Arc::clone(&self.ends.wanted);
        let read = bus.read_unless(span, limit, || wanted.borrow().stop).await;
        match read {
            // Asked again from its start, once the stop is through.
            Ok(None) => self.job = Some(Job::reading(ticket, span)),
            Ok(Some(bytes)) => {
                let took = self.now().since(asked);
                self.answered(took);
                self.watch_ticks(span.len, took);
                self.answer(
                    ticket,
                    Ok(Outcome::Memory {
                        span,
                        bytes: bytes.to_vec(),
                    }),
                );
            }
            Err(error) => {
                self.answer(ticket, Err(request_error(&error, span)));
                self.failed(bus, &error).await?;
            }
        }
        Ok(())
    }
}

fn extend(into: &mut ArrayVec<RegisterWrite, JOB_MAX>, writes: Writes) {
    for write in writes {
        let full = into.try_push(write).is_err();
        debug_assert!(!full, "a job holds the longest command and a hold");
    }
}

fn request_error(error: &BusError, span: Span) -> RequestError {
    let address = span.address;
    match error {
        BusError::Timeout { after } => {
            let after_ms = u64::try_from(after.as_millis()).unwrap_or(u64::MAX);
            RequestError::Timeout { address, after_ms }
        }
        BusError::Refused { reason } => RequestError::Refused {
            address,
            reason: reason.clone(),
        },
        BusError::WrongLength { got, want } => RequestError::WrongLength {
            address,
            got: *got,
            want: *want,
        },
        BusError::TooLong => RequestError::TooLong {
            address,
            len: span.len,
        },
        BusError::Ambiguous => RequestError::Ambiguous {
            address,
            wait_s: LATE_HORIZON.as_secs(),
        },
        BusError::Lost(_) => RequestError::LinkLost,
    }
}
