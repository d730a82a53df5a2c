//! One connection with a hand: its link, what that says of itself, and what was asked of it. A new one takes its place whole.

use crate::app::env::Env;
use crate::app::notices::RequestKind;
use crate::hand::{AngleReading, HandCommand, HandSample, Moment, PerDof, Setpoints};
use crate::link::{
    self, ArmRequest, HoldToRun, Lease, LinkConfig, LinkHandle, LinkStats, LinkStatus, Owner,
    PollRates, Records, RequestError, Traffic,
};
use crate::record::{Disarmed, Hold, LinkState, Record, Rest};
use crate::store::BackgroundJob;
use crate::transport::Endpoint;
use std::sync::Arc;
use std::time::Duration;

/// Records taken in one frame: a tenth of a second of the fastest link and far more than a frame brings. The rest waits
/// for the next frame, so that a window that was held up catches up without a jerk.
const RECORDS_PER_FRAME: usize = 256;
/// Requests whose end is still awaited; the link itself lets fewer wait.
const REQUESTS_MAX: usize = 32;

/// An armed hand that is asked nothing for so long is told of.
const IDLE_TIMEOUT: Duration = Duration::from_secs(300);

/// One connection with a hand.
#[derive(Debug, Default)]
pub struct Connection {
    /// The hand that is wanted; `None` after a disconnect.
    pub endpoint: Option<Endpoint>,
    /// Where the link stands. A stop or a disarming counts here at once, although the link's own word for it comes a moment later.
    pub status: LinkStatus,
    /// What the link measured of itself.
    pub stats: LinkStats,
    /// What went over the wire, as far as it was looked at.
    pub traffic: Traffic,
    pub(crate) open: Option<OpenLink>,
    requests: Vec<Pending>,
    /// No arming from before this moment counts, whatever the link still says.
    disarmed_at: Option<Moment>,
    /// Something was sent that may move the hand.
    pub(crate) commanded: bool,
    /// Angles received before this belong to a link that is gone.
    pub(crate) seen_from: Option<Moment>,
    pub(crate) was_live: bool,
    /// When the hand was armed, or asked for something since.
    pub(crate) asked_at: Moment,
}

impl Connection {
    /// With no hand.
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

    /// The hand's name in files and lists; empty without one.
    pub fn name(&self) -> String {
        let endpoint = self.endpoint.as_ref();
        endpoint.map(ToString::to_string).unwrap_or_default()
    }

    /// Whether it is the built-in hand.
    pub fn is_simulated(&self) -> bool {
        self.endpoint.as_ref().is_some_and(Endpoint::is_sim)
    }

    /// Whether the hand answers.
    pub const fn is_live(&self) -> bool {
        self.status.state.is_live()
    }

    /// Whether setpoints pass.
    pub fn is_armed(&self) -> bool {
        self.status.state == LinkState::Armed
    }

    /// Whether the hand was stopped or disarmed from this window since then.
    pub fn is_disarmed_since(&self, then: Moment) -> bool {
        self.disarmed_at.is_some_and(|at| at >= then)
    }

    /// How long an armed hand was asked nothing, once that is long.
    pub fn idle(&self, now: Moment) -> Option<Duration> {
        let idle = now.since(self.asked_at);
        (self.is_armed() && idle >= IDLE_TIMEOUT).then_some(idle)
    }

    pub(crate) fn link(&self) -> Option<&LinkHandle> {
        self.open.as_ref().map(|open| &open.link)
    }

    /// True if closing or leaving now could leave a hand in motion that this program set in motion: also where feedback is too old
    /// to tell.
    pub(crate) fn may_move(&self) -> bool {
        let may_still_move = self.commanded && self.status.rest != Rest::Resting;
        let holding = self.status.state == LinkState::Holding;
        self.is_live() && (self.is_armed() || holding || may_still_move)
    }

    /// True once nothing more can be done for a hand that was told to hold at this moment: it rests, or is gone.
    pub(crate) fn is_held(&self, told: Moment) -> bool {
        let rests = matches!(self.status.hold, Hold::Confirmed { rest, .. } if rest >= told);
        !self.is_live() || rests
    }

    /// Who moves the hand from outside this window, if somebody may.
    pub fn outside_owner(&self) -> Option<Owner> {
        let holder = self.status.holder.filter(|_| self.is_live())?;
        holder.owner.is_outside().then_some(holder.owner)
    }

    /// Ends whoever moves the hand from outside, for this reason; the hand is stopped.
    pub(crate) fn end_outside(&self, why: Disarmed) {
        let Some(link) = self.link() else { return };
        if let Some(holder) = link.status().holder
            && holder.owner.is_outside()
        {
            // One that ended meanwhile has stopped already.
            let _done = link.give_back(holder.lease, why);
        }
    }

    /// The user at this window moves the hand from now on.
    pub(crate) fn take_over(&mut self) {
        if let Some(open) = &mut self.open {
            let _lease = open.take_lease();
        }
    }

    /// Asks the link to let setpoints of the user at this window pass.
    pub(crate) fn arm(&mut self, request: ArmRequest) {
        if let Some(open) = &mut self.open {
            let lease = open.take_lease();
            // Just granted: it holds.
            let _asked = open.link.arm(lease, request);
        }
    }

    /// Sends, if the hand is armed and the right to move it holds.
    pub(crate) fn send(&mut self, setpoints: &Setpoints) {
        if let Some(open) = &self.open {
            let set = open.lease.map(|lease| open.link.set(lease, setpoints));
            self.commanded |= matches!(set, Some(Ok(())));
        }
    }

    /// Holds now. Whatever was armed is not any more, at once. False without a live link: then the stop waits for the hand for a while.
    pub(crate) fn stop(&mut self, now: Moment) -> bool {
        let _acts_unawaited = self.link().map(LinkHandle::stop);
        let is_sent = self.is_live();
        self.mark_disarmed(LinkState::Holding, now);
        is_sent
    }

    /// Lets no setpoint pass any more. The hand keeps what it was told.
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

    /// What has to be held now. A gamepad has a button of its own for that, and an exhibition is for strangers.
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

    /// Writes a command; what became of it is told by [`Self::ended_requests`].
    ///
    /// # Errors
    /// [`RequestError::NotConnected`], if no hand is there to take it.
    pub(crate) fn ask(
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
        let write = async move {
            match lease {
                Some(lease) => link.write_as(lease, command).await,
                None => link.write(command).await,
            }
        };
        let end = Some(BackgroundJob::start(&env.runtime, &env.wake, write));
        if self.requests.len() >= REQUESTS_MAX {
            self.requests.remove(0);
        }
        self.requests.push(Pending { what, end });
        Ok(())
    }

    /// The requests that ended since the last call, and how.
    pub(crate) fn ended_requests(&mut self) -> Vec<(RequestKind, Result<(), RequestError>)> {
        let mut ended = Vec::new();
        self.requests.retain_mut(|asked| {
            let end = BackgroundJob::take_from(&mut asked.end);
            ended.extend(end.map(|end| (asked.what, end)));
            asked.end.is_some()
        });
        ended
    }

    /// The records since the last call, and the link's status of now; `None` without a link.
    pub(crate) fn heard(&mut self) -> Option<(Vec<Record>, LinkStatus)> {
        let open = self.open.as_mut()?;
        let status = open.link.status();
        self.stats = open.link.stats();
        let next = || open.records.try_next();
        let records = std::iter::from_fn(next).take(RECORDS_PER_FRAME).collect();
        self.stats.dropped_events = open.records.lost();
        Some((records, status))
    }

    /// Puts this status in place of the one before, which it gives. No arming from before the last disarming counts.
    pub(crate) fn take_status(&mut self, mut status: LinkStatus) -> LinkStatus {
        let outdated = self.disarmed_at.is_some_and(|at| status.since <= at);
        if outdated && (status.state == LinkState::Armed || status.armed.is_some()) {
            status.state = self.status.state;
            status.armed = None;
        }
        std::mem::replace(&mut self.status, status)
    }

    /// The angles that were read through this link, if it is live.
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
    /// The right to move the hand that the user at this window, or their task, had last.
    pub(crate) lease: Option<Lease>,
}

impl OpenLink {
    /// With this link and what is heard of it.
    pub(crate) fn new((link, records): (LinkHandle, Records)) -> Self {
        Self {
            lease: None,
            link,
            records,
        }
    }

    /// The right of the user at this window to move the hand; granted anew if another has it, or none.
    pub(crate) fn take_lease(&mut self) -> Lease {
        let held = self.link.status().holder;
        let held = held.filter(|holder| holder.owner == Owner::Person);
        self.granted(held.map(|holder| holder.lease), Owner::Person)
    }

    /// The right of a task that this person starts. What they set meanwhile passes too.
    pub(crate) fn lend_lease(&mut self) -> Lease {
        self.granted(None, Owner::Task)
    }

    fn granted(&mut self, held: Option<Lease>, owner: Owner) -> Lease {
        let lease = held.unwrap_or_else(|| self.link.grant(owner));
        self.lease = Some(lease);
        lease
    }
}

/// A hand that is being left: it was told to hold.
#[derive(Debug)]
pub(crate) struct Leaving {
    /// Where to go then; `None` = nowhere.
    pub(crate) to: Option<Endpoint>,
    pub(crate) told: Moment,
}

/// A request whose end is awaited.
#[derive(Debug)]
pub(crate) struct Pending {
    pub(crate) what: RequestKind,
    pub(crate) end: Option<BackgroundJob<Result<(), RequestError>>>,
}
