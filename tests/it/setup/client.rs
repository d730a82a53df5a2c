//! A link as a queue of questions and events, for tests that ask many things at once and look at what comes, in order.

use futures::FutureExt as _;
use handscope::hand::{Groups, HandCommand, HandSample, Moment, Setpoints, Setting, Span};
use handscope::link;
use handscope::link::{ArmRequest, Lease, LinkConfig, LinkHandle, Owner, Records, RequestError};
use handscope::record::{ArmRefusal, Calibrated, LinkState, Record, Reset, Saved, Written};
use std::cell::Cell;
use std::ops::Deref;
use std::sync::Arc;
use tokio::sync::mpsc;

/// The number of one request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Ticket(pub u64);

/// One thing asked of the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Request {
    Command(HandCommand),
    Read(Span),
    Set(Setting),
    Save,
    Reset,
    Calibrate,
}

/// How a request ended well.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Outcome {
    Acknowledged,
    Memory { span: Span, bytes: Vec<u8> },
    Written(Written),
    Saved(Saved),
    Reset(Reset),
    Calibrated(Calibrated),
}

/// One thing that happened, in order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LinkEvent {
    Sample {
        sample: Arc<HandSample>,
        fresh: Groups,
    },
    State {
        at: Moment,
        state: LinkState,
    },
    ArmRefused {
        at: Moment,
        reason: ArmRefusal,
    },
    Done {
        ticket: Ticket,
        result: Result<Outcome, RequestError>,
    },
}

/// An open link with everything that was heard of it.
pub(crate) struct Client {
    link: LinkHandle,
    records: Records,
    lease: Cell<Lease>,
    tickets: u64,
    ends: mpsc::UnboundedSender<LinkEvent>,
    ended: mpsc::UnboundedReceiver<LinkEvent>,
}

/// Opens a link on the runtime of now.
pub(crate) fn open(config: LinkConfig) -> Client {
    let (link, records) = link::open(config, &tokio::runtime::Handle::current());
    let (ends, ended) = mpsc::unbounded_channel();
    Client {
        lease: Cell::new(link.grant(Owner::Person)),
        link,
        records,
        tickets: 0,
        ends,
        ended,
    }
}

impl Deref for Client {
    type Target = LinkHandle;

    fn deref(&self) -> &LinkHandle {
        &self.link
    }
}

async fn done(link: LinkHandle, lease: Lease, request: Request) -> Result<Outcome, RequestError> {
    match request {
        Request::Command(command) => {
            let written = match command.is_motion() {
                true => link.write_as(lease, command).await,
                false => link.write(command).await,
            };
            written.map(|()| Outcome::Acknowledged)
        }
        Request::Read(span) => {
            let bytes = link.read(span).await?;
            Ok(Outcome::Memory { span, bytes })
        }
        Request::Set(setting) => link.set_kept(setting).await.map(Outcome::Written),
        Request::Save => link.save().await.map(Outcome::Saved),
        Request::Reset => link.reset().await.map(Outcome::Reset),
        Request::Calibrate => link.calibrate().await.map(Outcome::Calibrated),
    }
}

impl Client {
    pub(crate) fn set(&self, setpoints: &Setpoints) {
        // One that ended is refused, and that is what is tried.
        let _set = self.link.set(self.lease.get(), setpoints);
    }

    /// A person grants the right to move the hand, and arms.
    pub(crate) fn arm(&self, request: ArmRequest) {
        if self.link.check(self.lease.get()).is_err() {
            self.lease.set(self.link.grant(Owner::Person));
        }
        self.link.arm(self.lease.get(), request).unwrap();
    }

    /// Asks at once. What is refused at once comes back at once.
    pub(crate) fn ask(&mut self, request: Request) -> Result<Ticket, RequestError> {
        let mut asked = Box::pin(done(self.link.clone(), self.lease.get(), request));
        let ticket = Ticket(self.tickets);
        self.tickets += 1;
        if let Some(end) = asked.as_mut().now_or_never() {
            end?;
            panic!("a hand answers not before it is asked");
        }
        let ends = self.ends.clone();
        tokio::spawn(async move {
            let result = asked.await;
            let _told = ends.send(LinkEvent::Done { ticket, result });
        });
        Ok(ticket)
    }

    pub(crate) fn try_event(&mut self) -> Option<LinkEvent> {
        while let Some(record) = self.records.try_next() {
            if let Some(event) = event(record) {
                return Some(event);
            }
        }
        self.ended.try_recv().ok()
    }

    /// The next event. `None` once the session has ended.
    pub(crate) async fn event(&mut self) -> Option<LinkEvent> {
        loop {
            tokio::select! {
                biased;
                record = self.records.next() => match record {
                    Some(record) => if let Some(event) = event(record) {
                        return Some(event);
                    },
                    None => return self.ended.try_recv().ok(),
                },
                Some(done) = self.ended.recv() => return Some(done),
            }
        }
    }
}

fn event(record: Record) -> Option<LinkEvent> {
    match record {
        Record::Reading { sample, fresh } => Some(LinkEvent::Sample { sample, fresh }),
        Record::State { at, state } => Some(LinkEvent::State { at, state }),
        Record::ArmRefused { at, reason } => Some(LinkEvent::ArmRefused { at, reason }),
        Record::Sent { .. } | Record::Answered { .. } => None,
    }
}
