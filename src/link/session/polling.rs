//! Polling by plan: picks the next read and applies its reply. What else may be sent first is decided elsewhere.

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

/// Delay before a group that cannot be requested now is tried again: often enough, without a busy loop.
const AMBIGUOUS_WAIT: Duration = Duration::from_millis(50);
/// Delay before reading setpoints again that this program did not write: one reading may be wrong.
const REREAD_DELAY: Duration = Duration::from_millis(30);

impl Session {
    /// The next read. While a stop is being confirmed only motion and faults are read; once it failed, the rest has its
    /// turns again.
    pub(crate) fn next_poll(&mut self) -> Option<NextRead> {
        let now = self.now();
        let tempo = self.tempo(now);
        self.plan.prefer(self.ends.wanted.borrow().priority);
        // On other links the requests of other controllers are overheard.
        let is_tcp = self.dialled.host().is_some();
        let watched = is_tcp && self.status.armed.is_some();
        self.plan.watch_setpoints(watched, now);
        if self.motion.hold.is_none() {
            if self.motion.waits_for_pose(now) {
                return Some(self.plan.motion(now, tempo));
            }
            if self.motion.waits_for_others(now) {
                match self.plan.others(now) {
                    Some(question) => return Some(question),
                    None => self.motion.nothing_else(),
                }
            }
        }
        self.plan.next(now, tempo)
    }

    /// Time at which the next read is due.
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

    /// Reads the pose, due or not.
    pub(crate) async fn poll_motion(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        let now = self.now();
        let question = self.plan.motion(now, self.tempo(now));
        self.poll(bus, &question).await
    }

    /// Reads the pose for a stop; another stop request does not interrupt it.
    pub(crate) async fn read_pose(&mut self, bus: &mut dyn Bus) -> Result<(), WireEnd> {
        let now = self.now();
        let question = self.plan.motion(now, self.tempo(now));
        self.poll_unless(bus, &question, &|| false).await
    }

    /// Reads one window and applies its reply.
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
        self.motion.note_request(question.is_motion);
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
                // Our own stall says nothing about how slow the hand is.
                self.answered(took.saturating_sub(late));
                self.watch_ticks(span.len, took);
                self.counters.line.read(self.plan.cost(), span, took);
                let bytes = &bytes;
                self.apply_reply(&Reply {
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

    fn apply_reply(&mut self, reply: &Reply<'_>) {
        let now = reply.received;
        self.plan
            .answered(reply.span, reply.asked, now.since(reply.asked));
        self.ends.image.send_modify(|image| image.apply(reply));
        let fresh = self.sample.apply(reply);
        if self.others.read(&self.sample, fresh) {
            self.plan.schedule_settings_read(now.plus(REREAD_DELAY));
            self.plan.doubt_setpoints(now);
        }
        self.moving.apply(&self.sample, fresh, now);
        let doubted = self.feedback.doubted();
        self.feedback.apply(&self.sample, fresh);
        self.watch_feedback(&doubted);
        self.heat.apply(&self.sample, fresh, now);
        let heat = DriveHeat::warmest(&self.sample, now);
        if self.status.heat != heat {
            self.status.heat = heat;
            self.publish();
        }
        self.counters.fresh(fresh, now);
        self.counters.judge(&self.sample, fresh);
        let sample = Arc::new(self.sample);
        self.broadcast(Record::Reading { sample, fresh });
        if fresh.contains(Group::Faults) {
            self.watch_faults();
        }
        self.watch_hold(fresh);
    }

    /// Handles a read that a late reply could answer in every shape. A read of the motion state justifies a new wire;
    /// others wait.
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
