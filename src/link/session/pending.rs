//! A stop that no feedback had confirmed when its link was lost, or that was asked for while it was. Nothing else outlives a lost
//! link.

use crate::hand::Moment;
use crate::link::session::conversation::Session;
use crate::link::session::hold::HoldWatch;
use crate::link::stop::STOP_PENDING;
use crate::record::{Hold, LinkState};

/// A stop without a link.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PendingStop {
    /// When it was asked for.
    at: Moment,
    /// A hand that answers until then is stopped first.
    until: Moment,
}

impl Session {
    /// Keeps a stop that was asked for at `at`, and raises the alarm: it may not have reached the hand.
    pub(crate) fn keep_stop(&mut self, at: Moment) {
        let until = self.now().plus(STOP_PENDING);
        self.pending_stop = Some(PendingStop { at, until });
        self.status.hold = Hold::Alarm { at };
        self.publish();
    }

    /// Keeps a stop that was asked for while there is no live hand, if one was.
    pub(crate) fn keep_pressed_stop(&mut self) {
        let mut is_pressed = false;
        self.ends.wanted.send_if_modified(|wanted| {
            is_pressed = std::mem::take(&mut wanted.stop);
            false
        });
        if is_pressed {
            self.keep_stop(self.now());
        }
    }

    /// True while a stop waits for the hand to answer again.
    pub(crate) fn has_pending_stop(&self) -> bool {
        let now = self.now();
        self.pending_stop.is_some_and(|stop| now <= stop.until)
    }

    /// The hand answers again: it is stopped first, if it came back in time. Otherwise the alarm stays until it shows rest.
    pub(crate) fn resume_stop(&mut self) {
        let is_in_time = self.has_pending_stop();
        let Some(stop) = self.pending_stop.take() else {
            return;
        };
        let at = stop.at;
        self.status.hold = Hold::Alarm { at };
        if is_in_time {
            self.motion.hold = Some(HoldWatch::resumed(at, self.now()));
            self.status.hold = Hold::Asked { at, sent: 0 };
            self.go(LinkState::Holding);
        }
        self.publish();
    }

    /// The hand rests: so ends the alarm of a stop that could not be sent.
    pub(crate) fn end_late_alarm(&mut self) {
        if let Hold::Alarm { at } = self.status.hold
            && self.motion.hold.is_none()
        {
            let rest = self.now();
            self.status.hold = Hold::Confirmed { at, rest };
            self.publish();
        }
    }
}
