//! Changes of a link's status: marks in the history, and notices for the user.

use crate::app::hand::connection::Connection;
use crate::app::notices::{HandNotices, NoticeKind};
use crate::hand::Moment;
use crate::history::{History, MarkKind};
use crate::link::{LinkStatus, LinkTrouble};
use crate::record::{Disarmed, Hold};
use crate::transport::Endpoint;

/// An adapter may delay replies for this long without harm, ms.
const TIMER_MS_MAX: u16 = 2;

/// Changes of a status that concern other parts.
#[derive(Debug, Default)]
pub(crate) struct StatusNews {
    /// The link was lost: a hand that answers later may be another one, or have been switched off.
    pub(crate) is_lost: bool,
    /// Setpoints pass from now on.
    pub(crate) is_armed: bool,
}

/// Receivers of status changes: history and notices of one hand.
pub(crate) struct StatusReport<'a, 'n> {
    pub(crate) history: &'a mut History,
    pub(crate) notices: &'a mut HandNotices<'n>,
    pub(crate) now: Moment,
}

impl StatusReport<'_, '_> {
    /// Compares the new status with the previous one; adds marks and notices for changes.
    pub(crate) fn status(&mut self, connection: &mut Connection, status: LinkStatus) -> StatusNews {
        let before = connection.replace_status(status);
        let mut news = self.reached(connection, &before);
        self.latency(connection, &before);
        self.hold(&connection.status, &before);
        news.is_armed = self.arming(&connection.status, &before);
        news
    }

    fn push(&mut self, what: NoticeKind) {
        self.notices.push(self.now, what);
    }

    fn reached(&mut self, connection: &mut Connection, before: &LinkStatus) -> StatusNews {
        let live = connection.is_live();
        let trouble = connection.status.trouble.clone();
        if before.state.is_live() && !live {
            self.lost(connection, trouble);
            return StatusNews {
                is_lost: true,
                ..StatusNews::default()
            };
        }
        if !before.state.is_live() && live {
            self.found(connection);
        } else if !live
            && before.trouble != trouble
            && let Some(trouble) = trouble
        {
            self.push(if connection.was_live {
                NoticeKind::LinkLost(trouble)
            } else {
                NoticeKind::NoLink(trouble)
            });
        }
        StatusNews::default()
    }

    fn lost(&mut self, connection: &mut Connection, trouble: Option<LinkTrouble>) {
        connection.was_live = true;
        connection.seen_from = Some(self.now);
        connection.commanded = false;
        self.history.gap(self.now);
        self.history.mark(self.now, MarkKind::LinkLost);
        if let Some(trouble) = trouble {
            self.push(NoticeKind::LinkLost(trouble));
        }
    }

    fn found(&mut self, connection: &mut Connection) {
        self.notices
            .withdraw(|what| matches!(what, NoticeKind::NoLink(_) | NoticeKind::StopNotSent));
        if connection.was_live {
            self.history.mark(self.now, MarkKind::Reconnected);
            self.push(NoticeKind::Reconnected);
        }
        connection.was_live = true;
    }

    /// Notifies the user, once per connection, of an adapter that delays replies.
    fn latency(&mut self, connection: &Connection, before: &LinkStatus) {
        let link = &connection.status;
        let told = |link: &LinkStatus| link.latency_timer_ms.filter(|ms| *ms > TIMER_MS_MAX);
        let is_news = link.state.is_live()
            && (told(link).is_some() && !before.state.is_live()
                || link.latency_ticks && !before.latency_ticks);
        let asked = connection.endpoint.as_ref().and_then(Endpoint::port);
        let port = link.moved_to.as_deref().or(asked).map(str::to_owned);
        if let Some(port) = port.filter(|_| is_news) {
            let ms = told(link);
            self.push(NoticeKind::LatencyTimer { port, ms });
        }
    }

    fn hold(&mut self, link: &LinkStatus, before: &LinkStatus) {
        if before.hold == link.hold {
            return;
        }
        match link.hold {
            Hold::Confirmed { at, rest } => {
                self.history.mark(rest, MarkKind::HoldConfirmed);
                self.notices.withdraw(|what| *what == NoticeKind::HoldAlarm);
                let after = rest.since(at);
                self.push(NoticeKind::HoldConfirmed { after });
            }
            Hold::Alarm { .. } => self.push(NoticeKind::HoldAlarm),
            Hold::None | Hold::Asked { .. } => {}
        }
    }

    /// True if the hand was just armed.
    fn arming(&mut self, link: &LinkStatus, before: &LinkStatus) -> bool {
        let is_armed = link.armed.is_some() && link.armed != before.armed;
        if is_armed {
            // That notice says that the hand is not armed.
            self.notices
                .withdraw(|what| *what == NoticeKind::Reconnected);
            self.history.mark(self.now, MarkKind::Armed);
            if let Some(why) = link.unguarded.clone() {
                self.push(NoticeKind::Unguarded { why });
            }
        }
        if before.armed.is_some() && link.armed.is_none() {
            let is_known = |why: &Disarmed| why.is_asked_for() && *why != Disarmed::Silent;
            if let Some(why) = link.disarmed.filter(|why| !is_known(why)) {
                let foreign = link.foreign_setpoint;
                let foreign = foreign.filter(|_| why == Disarmed::OtherController);
                self.push(foreign.map_or(NoticeKind::Disarmed(why), NoticeKind::DisarmedByOther));
            }
        }
        is_armed
    }
}
