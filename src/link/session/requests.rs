//! Requests in progress: writes that are sent one per step, and reads of arbitrary memory. A request that moves the
//! hand needs arming, like all motion.

use crate::hand::{HandCommand, HandSample, Moment, Reply, Span};
use crate::link::bus::late_replies::LATE_HORIZON;
use crate::link::bus::{Bus, BusError};
use crate::link::lease::Lease;
use crate::link::request::{Answer, Request, RequestError};
use crate::link::session::conversation::{Session, WireEnd};
use crate::link::session::job::{ReadJob, SessionJob, WriteJob};
use crate::record::{LinkState, WriteCause};
use std::sync::Arc;

impl Session {
    /// True if a request is in progress or was waiting.
    pub(crate) fn next_job(&mut self) -> bool {
        // A request that is answered at once yields the turn to the next.
        while self.job.is_none()
            && let Ok(request) = self.ends.requests.try_recv()
        {
            self.accept_job(request);
        }
        self.job.is_some()
    }

    /// Accepts a request, unless its requester no longer waits for the reply; then nothing is sent.
    pub(crate) fn accept_job(&mut self, request: Request) {
        if request.is_abandoned() {
            return;
        }
        match request {
            Request::Read(span, answer) => {
                self.job = Some(SessionJob::Read(ReadJob {
                    span,
                    cleared: false,
                    answer,
                }));
            }
            Request::Command(command, lease, answer) => self.accept_command(command, lease, answer),
            request => self.job = Some(SessionJob::Alone(request)),
        }
    }

    fn accept_command(&mut self, command: HandCommand, lease: Option<Lease>, answer: Answer<()>) {
        let is_motion = command.is_motion();
        if let Err(refused) = self.may_write(is_motion, lease) {
            let _sent = answer.send(Err(refused));
            return;
        }
        self.job = Some(SessionJob::Write(WriteJob {
            writes: command.writes(),
            // Clearing a fault may release a move to an old target.
            holds_first: command == HandCommand::ClearErrors,
            is_motion,
            answer,
        }));
    }

    /// Checks that a write may be sent: motion needs a valid lease and an armed hand.
    fn may_write(&self, is_motion: bool, lease: Option<Lease>) -> Result<(), RequestError> {
        match lease {
            Some(lease) => self.ends.wanted.borrow().book.check(lease)?,
            None if is_motion => return Err(RequestError::NotArmed),
            None => {}
        }
        if is_motion && self.status.state != LinkState::Armed {
            Err(RequestError::NotArmed)
        } else {
            Ok(())
        }
    }

    /// Sends the next write of the current request, or its read, and answers when all is done.
    pub(crate) async fn work(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        match self.job.take() {
            None => Ok(()),
            Some(SessionJob::Alone(request)) => self.alone(bus, request).await,
            Some(SessionJob::Read(job)) => self.read_for(bus, job).await,
            Some(SessionJob::Write(job)) => self.write_next(bus, job).await,
        }
    }

    async fn write_next(&mut self, bus: &mut dyn Bus, mut job: WriteJob) -> Result<(), WireEnd> {
        if std::mem::take(&mut job.holds_first) {
            return self.hold_for(bus, job).await;
        }
        let Some(write) = job.writes.pop_at(0) else {
            let _sent = job.answer.send(Ok(()));
            return Ok(());
        };
        if job.is_motion {
            self.moving.commanded(self.now());
        }
        match self.write(bus, &write, WriteCause::Request).await {
            Ok(()) if job.writes.is_empty() => {
                let _sent = job.answer.send(Ok(()));
            }
            Ok(()) => self.job = Some(SessionJob::Write(job)),
            Err(error) => {
                let _sent = job.answer.send(Err(request_error(&error, write.span())));
                self.failed(bus, &error).await?;
            }
        }
        Ok(())
    }

    /// Makes the present pose the target, because the request may have waited for a stop.
    async fn hold_for(&mut self, bus: &mut dyn Bus, job: WriteJob) -> Result<(), WireEnd> {
        let hold = HandCommand::Angles(self.hold_targets(self.now()).map(Some));
        for write in hold.writes() {
            if let Err(error) = self.write(bus, &write, WriteCause::Request).await {
                let _sent = job.answer.send(Err(request_error(&error, write.span())));
                return self.failed(bus, &error).await;
            }
        }
        self.job = Some(SessionJob::Write(job));
        Ok(())
    }

    async fn read_for(&mut self, bus: &mut dyn Bus, mut job: ReadJob) -> Result<(), WireEnd> {
        let span = job.span;
        if bus.choose(&[span]).is_none() && !job.cleared {
            // The same read was answered just now; any other reply flushes duplicates from the line.
            job.cleared = true;
            self.job = Some(SessionJob::Read(job));
            return self.poll_motion(bus).await;
        }
        if bus.choose(&[span]).is_none() || self.looks_like_save(span) {
            let (address, wait_s) = (span.address, LATE_HORIZON.as_secs());
            let _sent = job
                .answer
                .send(Err(RequestError::Ambiguous { address, wait_s }));
            return Ok(());
        }
        let limit = self.reply_limit(bus, span.len);
        let asked = self.now();
        let wanted = Arc::clone(&self.ends.wanted);
        let read = bus.read_unless(span, limit, &|| wanted.borrow().stop).await;
        match read {
            // Restarted once the stop has been handled.
            Ok(None) => {
                job.cleared = false;
                self.job = Some(SessionJob::Read(job));
            }
            Ok(Some(bytes)) => {
                let received = self.now();
                let took = received.since(asked);
                self.answered(took);
                self.watch_ticks(span.len, took);
                let mut sample = HandSample::default();
                let bytes = bytes.as_slice();
                let fresh = sample.apply(&Reply {
                    span,
                    bytes,
                    asked,
                    received,
                });
                self.counters.judge(&sample, fresh);
                self.store_read(span, asked, Ok(bytes.to_vec()));
                let _sent = job.answer.send(Ok(bytes.to_vec()));
            }
            Err(error) => {
                let failure = request_error(&error, span);
                self.store_read(span, asked, Err(failure.clone()));
                let _sent = job.answer.send(Err(failure));
                self.failed(bus, &error).await?;
            }
        }
        Ok(())
    }

    fn store_read(&self, span: Span, asked: Moment, read: Result<Vec<u8>, RequestError>) {
        let image = &self.ends.image;
        image.send_modify(|image| image.store_area(span, asked, read));
    }
}

pub(crate) fn request_error(error: &BusError, span: Span) -> RequestError {
    let address = span.address;
    match error {
        BusError::Timeout { after } => {
            let after_ms = u64::try_from(after.as_millis()).unwrap_or(u64::MAX);
            RequestError::Timeout { address, after_ms }
        }
        BusError::Refused { reason } => RequestError::Refused {
            address,
            reason: *reason,
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
