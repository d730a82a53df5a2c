//! What is heard of a hand: records and the state of its link, for everything that reads them.

use crate::app::hand::HandState;
use crate::app::notices::{NoticeKind, Notices};
use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment, PerDof};
use crate::history::MarkKind;
use crate::link::{LinkStatus, LinkTrouble};
use crate::record::{Disarmed, Hold, LinkState, Record};
use crate::transport::Endpoint;
use std::collections::VecDeque;

/// Records taken in one frame: a tenth of a second of the fastest link and far more than a frame brings. The rest waits
/// for the next frame, so that a window that was held up catches up without a jerk.
const RECORDS_PER_FRAME: usize = 256;
/// An adapter may keep what it got for so long without harm.
const TIMER_MS_MAX: u16 = 2;

impl HandState {
    /// Takes in what happened on the link.
    pub(crate) fn take_news(&mut self, notices: &mut Notices, now: Moment) {
        self.now = now;
        let Some(open) = &mut self.open else {
            self.follow();
            return;
        };
        let status = open.link.status();
        self.stats = open.link.stats();
        let next = || open.records.try_next();
        let records: VecDeque<Record> = std::iter::from_fn(next).take(RECORDS_PER_FRAME).collect();
        self.stats.dropped_events = open.records.lost();
        for record in &records {
            self.take(record, notices);
        }
        self.take_status(status, notices);
        self.follow();
    }

    pub(crate) fn take(&mut self, record: &Record, notices: &mut Notices) {
        match record {
            Record::Reading { sample, fresh } => self.take_reading(sample, *fresh, notices),
            Record::State {
                at,
                state: LinkState::Holding,
            } => self.history.mark(*at, MarkKind::Stop),
            Record::Sent { at, write, .. } => self.history.sent(*at, write),
            Record::State { .. } | Record::Answered { .. } => {}
            Record::ArmRefused { at, reason } => {
                notices.push(*at, NoticeKind::ArmRefused(*reason));
            }
        }
    }

    fn take_reading(&mut self, sample: &HandSample, fresh: Groups, notices: &mut Notices) {
        // Dated by the reading, not by the frame that takes it in: a replay tells the same.
        let now = sample.newest(fresh).unwrap_or(self.now);
        self.sample = *sample;
        if let Some(angle) = sample.angle.filter(|_| fresh.contains(Group::Angle)) {
            self.pace.take(angle.asked);
        }
        for finger in Finger::ALL {
            let block = sample.tactile[finger].filter(|_| fresh.contains(Group::Tactile(finger)));
            if let Some(block) = block {
                self.tip_pace[finger].take(block.asked);
            }
        }
        self.tare.begin(sample);
        if fresh.contains(Group::Force) {
            self.peaks.update(sample);
        }
        self.history.push(sample, fresh);
        self.recorder.sample(sample, fresh, now);
        if !self.faults.update(sample, fresh, now) {
            return;
        }
        self.history.mark(now, MarkKind::Fault);
        for entry in self.faults.active().filter(|entry| entry.since == now) {
            let (dof, what) = (entry.dof, entry.what);
            self.recorder.fault(dof, what, now);
            notices.push(now, NoticeKind::Fault { dof, what });
        }
    }

    /// A stop or disarm counts here at once, although the link's own word for it comes a moment later.
    pub(crate) fn take_status(&mut self, mut status: LinkStatus, notices: &mut Notices) {
        let outdated = self.disarmed_at.is_some_and(|at| status.since <= at);
        if outdated && (status.state == LinkState::Armed || status.armed.is_some()) {
            status.state = self.link.state;
            status.armed = None;
        }
        let before = std::mem::replace(&mut self.link, status);
        self.tell_reached(&before, notices);
        self.tell_latency(&before, notices);
        self.tell_hold(&before, notices);
        self.tell_arming(&before, notices);
    }

    /// An adapter that keeps replies back is told of once a connection.
    fn tell_latency(&self, before: &LinkStatus, notices: &mut Notices) {
        let link = &self.link;
        let told = |link: &LinkStatus| link.latency_timer_ms.filter(|ms| *ms > TIMER_MS_MAX);
        let is_news = link.state.is_live()
            && (told(link).is_some() && !before.state.is_live()
                || link.latency_ticks && !before.latency_ticks);
        let asked = self.endpoint.as_ref().and_then(Endpoint::port);
        let port = link.moved_to.as_deref().or(asked).map(str::to_owned);
        if let Some(port) = port.filter(|_| is_news) {
            let ms = told(link);
            notices.push(self.now, NoticeKind::LatencyTimer { port, ms });
        }
    }

    fn tell_reached(&mut self, before: &LinkStatus, notices: &mut Notices) {
        let live = self.link.state.is_live();
        let trouble = self.link.trouble.clone();
        if before.state.is_live() && !live {
            self.lost(trouble, notices);
        } else if !before.state.is_live() && live {
            self.found(notices);
        } else if let Some(trouble) =
            trouble.filter(|_| !live && before.trouble != self.link.trouble)
        {
            notices.push(
                self.now,
                if self.was_live {
                    NoticeKind::LinkLost(trouble)
                } else {
                    NoticeKind::NoLink(trouble)
                },
            );
        }
    }

    fn lost(&mut self, trouble: Option<LinkTrouble>, notices: &mut Notices) {
        let now = self.now;
        self.was_live = true;
        self.seen_from = Some(now);
        self.commanded = false;
        self.params.link_lost(now);
        self.history.gap(now);
        self.history.mark(now, MarkKind::LinkLost);
        if let Some(trouble) = trouble {
            notices.push(now, NoticeKind::LinkLost(trouble));
        }
    }

    fn found(&mut self, notices: &mut Notices) {
        notices.withdraw(|what| matches!(what, NoticeKind::NoLink(_) | NoticeKind::StopNotSent));
        if self.was_live {
            self.history.mark(self.now, MarkKind::Reconnected);
            notices.push(self.now, NoticeKind::Reconnected);
        }
        self.was_live = true;
    }

    fn tell_hold(&mut self, before: &LinkStatus, notices: &mut Notices) {
        if before.hold == self.link.hold {
            return;
        }
        match self.link.hold {
            Hold::Confirmed { at, rest } => {
                self.history.mark(rest, MarkKind::HoldConfirmed);
                notices.withdraw(|what| *what == NoticeKind::HoldAlarm);
                let after = rest.since(at);
                notices.push(self.now, NoticeKind::HoldConfirmed { after });
            }
            Hold::Alarm { .. } => notices.push(self.now, NoticeKind::HoldAlarm),
            Hold::None | Hold::Asked { .. } => {}
        }
    }

    fn tell_arming(&mut self, before: &LinkStatus, notices: &mut Notices) {
        let armed = self.link.armed;
        if armed.is_some() && armed != before.armed {
            self.history.mark(self.now, MarkKind::Armed);
            if let Some(why) = self.link.unguarded.clone() {
                notices.push(self.now, NoticeKind::Unguarded { why });
            }
            self.steered = self
                .joints
                .map(|joint| !joint.locked && joint.target.is_some());
        }
        if before.armed.is_some() && armed.is_none() {
            let is_known = |why: &Disarmed| why.is_asked_for() && *why != Disarmed::Silent;
            if let Some(why) = self.link.disarmed.filter(|why| !is_known(why)) {
                let foreign = self.link.foreign_setpoint;
                let foreign = foreign.filter(|_| why == Disarmed::OtherController);
                let what = foreign.map_or(NoticeKind::Disarmed(why), NoticeKind::DisarmedByOther);
                notices.push(self.now, what);
            }
        }
    }

    /// Sliders that no person holds stand at the actual angle, so that arming and taking over never jump.
    pub(crate) fn follow(&mut self) {
        let armed = self.is_armed();
        let live = self.link.state.is_live();
        let seen_from = self.seen_from;
        let angle = self
            .sample
            .angle
            .filter(|angle| live && seen_from.is_none_or(|from| angle.received > from));
        for dof in Dof::ALL {
            if !armed || !self.steered[dof] {
                self.joints[dof].target = angle.and_then(|angle| angle.value[dof].hold());
            }
        }
        if !armed {
            self.steered = PerDof::default();
        }
    }
}

#[cfg(test)]
mod tests;
