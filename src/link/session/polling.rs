//! Reading by plan: which question goes out now, and what its answer changes. What else may go out first is decided
//! elsewhere.

use crate::hand::{DriveHeat, Group, Moment, Reply, Span};
use crate::link::bus::Bus;
use crate::link::bus::client::Urgent;
use crate::link::poll::plan::{NextRead, Tempo};
use crate::link::session::conversation::{Session, WireEnd};
use crate::link::session::stall::watched;
use crate::link::status::LinkTrouble;
use crate::record::{Disarmed, LinkState, Record};
use std::sync::Arc;
use std::time::Duration;

/// A group that cannot be requested now is tried again after this: often enough, and not in a busy loop.
const AMBIGUOUS_WAIT: Duration = Duration::from_millis(50);
/// Setpoints that nobody here wrote are read again after this: one reading may be wrong.
const LOOK_AGAIN: Duration = Duration::from_millis(30);

impl Session {
    /// What to ask now. While a stop is being confirmed only motion and faults count; once it failed, the rest gets its
    /// turns again.
    pub(crate) fn next_poll(&mut self) -> Option<NextRead> {
        let now = self.now();
        let tempo = self.tempo(now);
        self.plan.prefer(self.ends.wanted.borrow().priority);
        // Elsewhere requests of others are heard.
        let is_tcp = self.dialled.host().is_some();
        let watched = is_tcp && self.status.armed.is_some();
        self.plan.watch_setpoints(watched, now);
        if self.motion.hold.is_none() {
            if self.motion.wants_pose(now) {
                return Some(self.plan.motion(now, tempo));
            }
            if self.motion.wants_others(now) {
                match self.plan.others(now) {
                    Some(question) => return Some(question),
                    None => self.motion.nothing_else(),
                }
            }
        }
        self.plan.next(now, tempo)
    }

    /// When the next read is due.
    pub(crate) fn next_read(&self) -> Moment {
        let now = self.now();
        self.plan.next_due(now, self.tempo(now))
    }

    fn tempo(&self, now: Moment) -> Tempo {
        match &self.motion.hold {
            Some(hold) if !hold.alarmed => Tempo::Stopping,
            Some(_) => Tempo::Motion,
            None if self.moving.moves(now) => Tempo::Motion,
            None => Tempo::Rest,
        }
    }

    /// Asks where the hand is, due or not.
    pub(crate) async fn poll_motion(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        let now = self.now();
        let question = self.plan.motion(now, self.tempo(now));
        self.poll(bus, &question).await
    }

    /// The same, for a stop: another stop is no reason to leave it.
    pub(crate) async fn read_pose(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        let now = self.now();
        let question = self.plan.motion(now, self.tempo(now));
        self.poll_unless(bus, &question, &|| false).await
    }

    /// One read of a window, and what its answer changes.
    pub(crate) async fn poll(
        &mut self,
        bus: &mut dyn Bus,
        question: &NextRead,
    ) -> Result<(), WireEnd> {
        let wanted = Arc::clone(&self.ends.wanted);
        self.poll_unless(bus, question, &|| wanted.borrow().stop)
            .await
    }

    async fn poll_unless(
        &mut self,
        bus: &mut dyn Bus,
        question: &NextRead,
        urgent: Urgent<'_>,
    ) -> Result<(), WireEnd> {
        self.motion.asked(question.is_motion);
        let Some(span) = bus.choose(&question.shapes) else {
            return self.ambiguous(question);
        };
        let limit = self.reply_limit(bus, span.len);
        let asked = self.now();
        let (result, late) = watched(bus.read_unless(span, limit, urgent)).await;
        self.stalled(late);
        let received = self.now();
        let took = received.since(asked);
        match result {
            Ok(None) => Ok(()),
            Ok(Some(bytes)) => {
                // What we stalled says nothing of how slow the hand is.
                self.answered(took.saturating_sub(late));
                self.watch_ticks(span.len, took);
                self.counters.line.read(self.plan.cost(), span, took);
                let bytes = &bytes;
                self.take(&Reply {
                    span,
                    bytes,
                    asked,
                    received,
                });
                Ok(())
            }
            Err(error) => {
                self.counters.line.failed(took);
                self.plan.failed(span, received);
                self.failed(bus, &error).await
            }
        }
    }

    fn take(&mut self, reply: &Reply<'_>) {
        let now = reply.received;
        self.plan
            .answered(reply.span, reply.asked, now.since(reply.asked));
        self.ends.image.send_modify(|image| image.take(reply));
        let fresh = self.sample.take(reply);
        if self.others.read(&self.sample, fresh) {
            self.plan.look_at_settings(now.plus(LOOK_AGAIN));
            self.plan.doubt_setpoints(now);
        }
        self.moving.take(&self.sample, fresh, now);
        let doubted = self.feedback.doubted();
        self.feedback.take(&self.sample, fresh);
        self.watch_feedback(&doubted);
        self.heat.take(&self.sample, fresh, now);
        let heat = DriveHeat::warmest(&self.sample, now);
        if self.status.heat != heat {
            self.status.heat = heat;
            self.publish();
        }
        self.counters.fresh(fresh, now);
        self.counters.judge(&self.sample, fresh);
        let sample = Arc::new(self.sample);
        self.tell(Record::Reading { sample, fresh });
        if fresh.contains(Group::Faults) {
            self.watch_faults();
        }
        self.watch_hold(fresh);
    }

    /// Every way to ask could be answered by a late reply. The motion state is worth a new wire; the rest waits.
    fn ambiguous(&mut self, question: &NextRead) -> Result<(), WireEnd> {
        let now = self.now();
        let window = question.shapes.first().copied();
        let window = window.unwrap_or(Span::new(0, 0));
        self.plan.failed_to_ask(window, now.plus(AMBIGUOUS_WAIT));
        if question.is_motion {
            return Err(WireEnd::Lost(LinkTrouble::Ambiguous));
        }
        Ok(())
    }

    fn watch_faults(&mut self) {
        match (self.sample.has_fault(), self.status.state) {
            (true, LinkState::Armed) => self.begin_hold(Disarmed::Fault),
            (true, LinkState::Monitoring) => {
                self.disarm(Disarmed::Fault);
                self.go(LinkState::Fault);
            }
            (false, LinkState::Fault) => self.go(LinkState::Monitoring),
            _ => {}
        }
    }
}
