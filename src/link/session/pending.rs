//! A stop that feedback had not confirmed when the link was lost, or that was requested while it was lost. Nothing else
//! survives a lost link.

use crate::hand::Moment;
use crate::link::session::conversation::Session;
use crate::link::session::hold::{HoldWatch, PendingStop};
use crate::link::stop::STOP_PENDING;
use crate::record::{Hold, LinkState};

impl Session {
    /// Keeps a stop requested at `at` pending, and raises the alarm, because it may not have reached the hand.
    pub(crate) fn keep_stop(&mut self, at: Moment) {
        let until = self.now().plus(STOP_PENDING);
        self.pending_stop = Some(PendingStop { at, until });
        self.status.hold = Hold::Alarm { at };
        self.publish();
    }

    /// Keeps a stop pending that was requested while there was no live hand, if there was one.
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

    /// True while a stop is pending until the hand answers again.
    pub(crate) fn has_pending_stop(&self) -> bool {
        let now = self.now();
        self.pending_stop.is_some_and(|stop| now <= stop.until)
    }

    /// Called when the hand answers again: sends the pending stop first if it has not expired. Otherwise the alarm
    /// stays until the hand shows rest.
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

    /// Ends the alarm of a stop that could not be sent, once the hand rests.
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
