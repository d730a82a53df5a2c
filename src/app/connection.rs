//! One connection with a hand: its link, pending requests, and the state of the link, whose changes become marks in the history and
//! notices. A new connection replaces it as a whole.

use crate::app::env::Env;
use crate::app::notices::{HandNotices, NoticeKind, RequestKind};
use crate::hand::{AngleReading, HandCommand, HandSample, Moment, PerDof, Setpoints};
use crate::history::{History, MarkKind};
use crate::link::{
    self, ArmRequest, HoldToRun, Lease, LinkConfig, LinkHandle, LinkStats, LinkStatus, LinkTrouble,
    Owner, PollRates, Records, RequestError, Traffic,
};
use crate::record::{Disarmed, Hold, LinkState, Record, Rest};
use crate::transport::Endpoint;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc;

/// Maximum number of records per frame: a tenth of a second of the fastest link, far more than a frame brings. The rest waits for the
/// next frame, so that a delayed window catches up smoothly.
const RECORDS_PER_FRAME: usize = 256;
/// Maximum number of ended requests that wait for the next frame; the link itself allows fewer.
const REQUESTS_MAX: usize = 32;

/// The user is notified of an armed hand that has received no command for this long.
const IDLE_TIMEOUT: Duration = Duration::from_secs(300);

/// One connection with a hand.
#[derive(Debug, Default)]
pub struct Connection {
    /// Endpoint of the requested hand; `None` after a disconnect.
    pub endpoint: Option<Endpoint>,
    /// Status of the link. A stop or a disarming applies here at once, although the link reports it a moment later.
    pub status: LinkStatus,
    /// Statistics of the link.
    pub stats: LinkStats,
    /// Wire traffic, as far as it was read.
    pub traffic: Traffic,
    pub(crate) open: Option<OpenLink>,
    requests: EndedRequests,
    /// No arming from before this moment counts, regardless of the link's status.
    disarmed_at: Option<Moment>,
    /// A command was sent that may move the hand.
    pub(crate) commanded: bool,
    /// Angles received before this belong to an earlier link.
    pub(crate) seen_from: Option<Moment>,
    pub(crate) was_live: bool,
    /// Time of the arming or of the last command since.
    pub(crate) asked_at: Moment,
}

impl Connection {
    /// A connection without a hand.
    pub(crate) fn none(now: Moment) -> Self {
        Self {
            status: LinkStatus {
                since: now,
                ..LinkStatus::default()
            },
            seen_from: Some(now),
            asked_at: now,
            ..Self::default()
        }
    }

    /// Opens a link to this hand.
    pub(crate) fn open(endpoint: Endpoint, env: &Env, now: Moment) -> Self {
        let config = LinkConfig {
            endpoint: endpoint.clone(),
            rates: PollRates::default(),
            clock: env.clock,
            dial: Arc::clone(&env.dial),
            wake: Arc::clone(&env.wake),
        };
        let open = OpenLink::new(link::open(config, &env.runtime));
        Self {
            traffic: Traffic::of(open.link.tap(), &endpoint),
            endpoint: Some(endpoint),
            open: Some(open),
            ..Self::none(now)
        }
    }

    /// Name of the hand in files and lists; empty without a hand.
    pub fn name(&self) -> String {
        let endpoint = self.endpoint.as_ref();
        endpoint.map(ToString::to_string).unwrap_or_default()
    }

    /// True for the built-in hand.
    pub fn is_simulated(&self) -> bool {
        self.endpoint.as_ref().is_some_and(Endpoint::is_sim)
    }

    /// True while the hand answers.
    pub const fn is_live(&self) -> bool {
        self.status.state.is_live()
    }

    /// True while setpoints pass.
    pub fn is_armed(&self) -> bool {
        self.status.state == LinkState::Armed
    }

    /// True if the hand was stopped or disarmed from this window since `then`.
    pub fn is_disarmed_since(&self, then: Moment) -> bool {
        self.disarmed_at.is_some_and(|at| at >= then)
    }

    /// Time without a command to an armed hand; `None` below five minutes.
    pub fn idle(&self, now: Moment) -> Option<Duration> {
        let idle = now.since(self.asked_at);
        (self.is_armed() && idle >= IDLE_TIMEOUT).then_some(idle)
    }

    pub(crate) fn link(&self) -> Option<&LinkHandle> {
        self.open.as_ref().map(|open| &open.link)
    }

    /// True if closing now could leave the hand in a motion that this program started; also true if feedback is too old to decide.
    pub(crate) fn may_move(&self) -> bool {
        let may_still_move = self.commanded && self.status.rest != Rest::Resting;
        let holding = self.status.state == LinkState::Holding;
        self.is_live() && (self.is_armed() || holding || may_still_move)
    }

    /// True once a hand that was stopped at this moment rests or has disconnected.
    pub(crate) fn is_held(&self, told: Moment) -> bool {
        let rests = matches!(self.status.hold, Hold::Confirmed { rest, .. } if rest >= told);
        !self.is_live() || rests
    }

    /// Party outside this window that has control of the hand, if any.
    pub fn outside_owner(&self) -> Option<Owner> {
        let holder = self.status.holder.filter(|_| self.is_live())?;
        holder.owner.is_outside().then_some(holder.owner)
    }

    /// Ends the control of a party outside this window, for this reason; the hand is stopped.
    pub(crate) fn end_outside(&self, why: Disarmed) {
        let Some(link) = self.link() else { return };
        if let Some(holder) = link.status().holder
            && holder.owner.is_outside()
        {
            // A lease that ended meanwhile has already stopped the hand.
            let _done = link.give_back(holder.lease, why);
        }
    }

    /// Gives control to the user at this window.
    pub(crate) fn take_over(&mut self) {
        if let Some(open) = &mut self.open {
            let _lease = open.take_lease();
        }
    }

    /// Asks the link to pass setpoints of the user at this window.
    pub(crate) fn arm(&mut self, request: ArmRequest) {
        if let Some(open) = &mut self.open {
            let lease = open.take_lease();
            // The lease was just granted, so it is valid.
            let _asked = open.link.arm(lease, request);
        }
    }

    /// Sends setpoints, if the hand is armed and the lease is valid.
    pub(crate) fn send(&mut self, setpoints: &Setpoints) {
        if let Some(open) = &self.open {
            let set = open.lease.map(|lease| open.link.set(lease, setpoints));
            self.commanded |= matches!(set, Some(Ok(())));
        }
    }

    /// Stops (holds) the hand; any arming ends at once. False without a live link: then the stop stays pending for a while.
    pub(crate) fn stop(&mut self, now: Moment) -> bool {
        let _acts_unawaited = self.link().map(LinkHandle::stop);
        let is_sent = self.is_live();
        self.mark_disarmed(LinkState::Holding, now);
        is_sent
    }

    /// Passes no further setpoints. The hand keeps its targets.
    pub(crate) fn disarm(&mut self, now: Moment) {
        if let Some(link) = self.link() {
            link.disarm();
        }
        self.mark_disarmed(LinkState::Monitoring, now);
    }

    fn mark_disarmed(&mut self, state: LinkState, now: Moment) {
        self.disarmed_at = Some(now);
        if self.is_armed() {
            self.status.state = state;
        }
        self.status.armed = None;
    }

    /// Key that has to be held now. A gamepad has its own button for that, and an exhibition is operated by visitors.
    pub(crate) fn holds(&self, held: HoldToRun) -> HoldToRun {
        match self.status.holder.map(|holder| holder.owner) {
            Some(Owner::Gamepad | Owner::Exhibition) => HoldToRun::Off,
            _ => held,
        }
    }

    pub(crate) fn hold_to_run(&self, held: HoldToRun) {
        if let Some(link) = self.link() {
            link.hold_to_run(self.holds(held));
        }
    }

    /// Writes a command; [`Self::ended_requests`] returns its result.
    ///
    /// # Errors
    /// [`RequestError::NotConnected`], if no hand is connected.
    pub(crate) fn request(
        &mut self,
        what: RequestKind,
        command: HandCommand,
        env: &Env,
    ) -> Result<(), RequestError> {
        let live = self.is_live();
        let open = self.open.as_ref().filter(|_| live);
        let open = open.ok_or(RequestError::NotConnected)?;
        let (link, lease) = (open.link.clone(), open.lease);
        let lease: Option<Lease> = lease.filter(|_| command.is_motion());
        let (ended, wake) = (self.requests.sender.clone(), Arc::clone(&env.wake));
        env.runtime.spawn(async move {
            let end = match lease {
                Some(lease) => link.write_as(lease, command).await,
                None => link.write(command).await,
            };
            // A dropped receiver means that the connection was replaced.
            let _sent = ended.send((what, end)).await;
            wake();
        });
        Ok(())
    }

    /// Requests that ended since the last call, with their results.
    pub(crate) fn ended_requests(&mut self) -> Vec<EndedRequest> {
        let ended = &mut self.requests.receiver;
        std::iter::from_fn(|| ended.try_recv().ok()).collect()
    }

    /// Records since the last call, and the link's current status; `None` without a link.
    pub(crate) fn received(&mut self) -> Option<(Vec<Record>, LinkStatus)> {
        let open = self.open.as_mut()?;
        let status = open.link.status();
        self.stats = open.link.stats();
        let next = || open.records.try_next();
        let records = std::iter::from_fn(next).take(RECORDS_PER_FRAME).collect();
        self.stats.dropped_events = open.records.lost();
        Some((records, status))
    }

    /// Replaces the status, and returns the previous one. No arming from before the last disarming counts.
    pub(crate) fn replace_status(&mut self, mut status: LinkStatus) -> LinkStatus {
        let outdated = self.disarmed_at.is_some_and(|at| status.since <= at);
        if outdated && (status.state == LinkState::Armed || status.armed.is_some()) {
            status.state = self.status.state;
            status.armed = None;
        }
        std::mem::replace(&mut self.status, status)
    }

    /// Angles that were read through this link, if it is live.
    pub(crate) fn angles<'a>(&self, sample: &'a HandSample) -> Option<&'a PerDof<AngleReading>> {
        let angle = sample.angle.as_ref().filter(|_| self.is_live())?;
        let is_of_now = self.seen_from.is_none_or(|from| angle.received > from);
        is_of_now.then_some(&angle.value)
    }
}

#[derive(Debug)]
pub(crate) struct OpenLink {
    pub(crate) link: LinkHandle,
    pub(crate) records: Records,
    /// Newest lease of the user at this window, or of a task that the user started.
    pub(crate) lease: Option<Lease>,
}

impl OpenLink {
    /// Wraps a link and its records.
    pub(crate) fn new((link, records): (LinkHandle, Records)) -> Self {
        Self {
            lease: None,
            link,
            records,
        }
    }

    /// Lease of the user at this window; granted anew if the user does not hold control.
    pub(crate) fn take_lease(&mut self) -> Lease {
        let held = self.link.status().holder;
        let held = held.filter(|holder| holder.owner == Owner::Person);
        self.granted(held.map(|holder| holder.lease), Owner::Person)
    }

    /// Lease for a task that the user starts. Setpoints of the user pass under it too.
    pub(crate) fn lend_lease(&mut self) -> Lease {
        self.granted(None, Owner::Task)
    }

    fn granted(&mut self, held: Option<Lease>, owner: Owner) -> Lease {
        let lease = held.unwrap_or_else(|| self.link.grant(owner));
        self.lease = Some(lease);
        lease
    }
}

/// A hand that was stopped and is being disconnected.
#[derive(Debug)]
pub(crate) struct Leaving {
    /// Endpoint to open afterwards; `None` for none.
    pub(crate) to: Option<Endpoint>,
    pub(crate) told: Moment,
}

/// A request that has ended, with its result.
pub(crate) type EndedRequest = (RequestKind, Result<(), RequestError>);

/// Results of this connection's requests, in order of arrival.
#[derive(Debug)]
struct EndedRequests {
    sender: mpsc::Sender<EndedRequest>,
    receiver: mpsc::Receiver<EndedRequest>,
}

impl Default for EndedRequests {
    fn default() -> Self {
        let (sender, receiver) = mpsc::channel(REQUESTS_MAX);
        Self { sender, receiver }
    }
}

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
        // The window disarms its own status at once: the link's reason follows. The others have marks of their own.
        let has_mark =
            |why: Disarmed| matches!(why, Disarmed::Stop | Disarmed::Fault | Disarmed::LinkLost);
        let is_news = before.state.is_live() && link.disarmed != before.disarmed;
        if is_news && link.disarmed.is_some_and(|why| !has_mark(why)) {
            self.history.mark(self.now, MarkKind::Disarmed);
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
