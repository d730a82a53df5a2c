//! The window's end of a link: what may be said to it and what is heard. Never waits for a wire.

use crate::hand::{Force, PerDof, Speed, Target};
use crate::link::clock::Clock;
use crate::link::event::{LinkEvent, Request, RequestError, Ticket};
use crate::link::plan::PollRates;
use crate::link::session::Session;
use crate::link::stats::LinkStats;
use crate::link::status::{ArmEpoch, ArmRequest, LinkStatus};
use crate::link::tap::WireTap;
use crate::transport::{Dial, Endpoint};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use tokio::sync::{mpsc, watch};

/// Requests that may wait: a person cannot ask faster than this drains.
pub const REQUESTS_MAX: usize = 16;
/// Events that may wait for the window: ten seconds of samples at full rate of a serial line.
pub const EVENTS_MAX: usize = 1024;

/// Called when something new is there, from any thread. Must return at once.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// What a link is opened with.
#[derive(Clone)]
pub struct LinkConfig {
    /// The hand.
    pub endpoint: Endpoint,
    /// How often to read what.
    pub rates: PollRates,
    /// The program's clock.
    pub clock: Clock,
    /// How wires are opened.
    pub dial: Arc<dyn Dial>,
    /// Called when an event waits.
    pub wake: Wake,
}

/// New targets and limits for an armed hand. Joints that are `None` keep what they were told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setpoints {
    /// The arming they belong to; in any other they are dropped.
    pub epoch: ArmEpoch,
    /// Angles to go to.
    pub angle: PerDof<Option<Target>>,
    /// Force thresholds.
    pub force: PerDof<Option<Force>>,
    /// Speeds.
    pub speed: PerDof<Option<Speed>>,
}

impl Setpoints {
    /// Nothing new, for one arming.
    #[must_use]
    pub const fn none(epoch: ArmEpoch) -> Self {
        Self {
            epoch,
            angle: PerDof::splat(None),
            force: PerDof::splat(None),
            speed: PerDof::splat(None),
        }
    }

    /// True if there is nothing to send.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::none(self.epoch)
    }

    /// Puts newer values over older ones, joint by joint. Another arming replaces all.
    pub fn merge(&mut self, newer: &Self) {
        if self.epoch != newer.epoch {
            *self = *newer;
            return;
        }
        put(&mut self.angle, &newer.angle);
        put(&mut self.force, &newer.force);
        put(&mut self.speed, &newer.speed);
    }
}

fn put<T: Copy>(older: &mut PerDof<Option<T>>, newer: &PerDof<Option<T>>) {
    for (dof, value) in newer.iter() {
        if value.is_some() {
            older[dof] = *value;
        }
    }
}

/// What the window wants and the session has not taken yet. One slot, so that nothing queues up, and
/// a stop empties it in the same step.
#[derive(Debug, Default)]
pub(crate) struct Wanted {
    pub(crate) stop: bool,
    pub(crate) disarm: bool,
    pub(crate) arm: Option<ArmRequest>,
    pub(crate) setpoints: Option<Setpoints>,
    pub(crate) rates: Option<PollRates>,
    pub(crate) closed: bool,
}

impl Wanted {
    /// True if the window wants anything at all.
    pub(crate) const fn is_any(&self) -> bool {
        let moves = self.arm.is_some() || self.setpoints.is_some();
        self.stop || self.disarm || self.closed || moves || self.rates.is_some()
    }
}

/// The session's ends of what the handle holds.
pub(crate) struct Ends {
    pub(crate) wanted: Arc<watch::Sender<Wanted>>,
    pub(crate) requests: mpsc::Receiver<(Ticket, Request)>,
    pub(crate) events: mpsc::Sender<LinkEvent>,
    pub(crate) status: watch::Sender<LinkStatus>,
    pub(crate) stats: watch::Sender<LinkStats>,
    pub(crate) tap: WireTap,
}

/// One open link. Dropping it closes the wire; the hand keeps what it was told last.
#[derive(Debug)]
pub struct LinkHandle {
    wanted: Arc<watch::Sender<Wanted>>,
    requests: mpsc::Sender<(Ticket, Request)>,
    events: mpsc::Receiver<LinkEvent>,
    status: watch::Receiver<LinkStatus>,
    stats: watch::Receiver<LinkStats>,
    tickets: AtomicU64,
    tap: WireTap,
}

/// Opens a link on this runtime and keeps it open until the handle is dropped. Writes nothing by itself.
#[must_use]
pub fn open(config: LinkConfig, runtime: &tokio::runtime::Handle) -> LinkHandle {
    let wanted = Arc::new(watch::Sender::new(Wanted::default()));
    let (requests, asked) = mpsc::channel(REQUESTS_MAX);
    let (told, events) = mpsc::channel(EVENTS_MAX);
    let (status_in, status) = watch::channel(LinkStatus::default());
    let (stats_in, stats) = watch::channel(LinkStats::default());
    let tap = WireTap::default();
    let ends = Ends {
        wanted: Arc::clone(&wanted),
        requests: asked,
        events: told,
        status: status_in,
        stats: stats_in,
        tap: tap.clone(),
    };
    runtime.spawn(Session::new(config, ends).run());
    LinkHandle {
        wanted,
        requests,
        events,
        status,
        stats,
        tickets: AtomicU64::new(0),
        tap,
    }
}

impl LinkHandle {
    /// Where the link stands now.
    #[must_use]
    pub fn status(&self) -> LinkStatus {
        self.status.borrow().clone()
    }

    /// What the link measured of itself until now.
    #[must_use]
    pub fn stats(&self) -> LinkStats {
        *self.stats.borrow()
    }

    /// Holds the hand where it is, before anything else, and disarms. Everything not yet sent is forgotten.
    pub fn stop(&self) {
        self.wanted.send_modify(|wanted| {
            wanted.stop = true;
            wanted.arm = None;
            wanted.setpoints = None;
        });
    }

    /// Asks to arm. The answer is the state `Armed`, or an event that says why not.
    pub fn arm(&self, request: ArmRequest) {
        self.wanted.send_modify(|wanted| wanted.arm = Some(request));
    }

    /// Lets no setpoint pass any more. The hand keeps what it was told.
    pub fn disarm(&self) {
        self.wanted.send_modify(|wanted| {
            wanted.disarm = true;
            wanted.arm = None;
            wanted.setpoints = None;
        });
    }

    /// Sets targets and limits: the newest of each joint is sent, at most [`SETPOINT_HZ_MAX`] times a second.
    ///
    /// [`SETPOINT_HZ_MAX`]: crate::link::motion::SETPOINT_HZ_MAX
    pub fn set(&self, setpoints: &Setpoints) {
        self.wanted
            .send_modify(|wanted| match &mut wanted.setpoints {
                Some(older) => older.merge(setpoints),
                none => *none = Some(*setpoints),
            });
    }

    /// Reads at other rates from now on, reconnects included. Only what is asked for changes; nothing is written.
    pub fn read_at(&self, rates: PollRates) {
        self.wanted.send_modify(|wanted| wanted.rates = Some(rates));
    }

    /// Asks for one thing. The answer is an event with the ticket.
    ///
    /// # Errors
    /// [`RequestError::NotConnected`] at once while there is no live hand; [`RequestError::Full`] if too many wait.
    pub fn ask(&self, request: Request) -> Result<Ticket, RequestError> {
        if !self.status.borrow().state.is_live() {
            return Err(RequestError::NotConnected);
        }
        let ticket = Ticket(self.tickets.fetch_add(1, Ordering::Relaxed));
        match self.requests.try_send((ticket, request)) {
            Ok(()) => Ok(ticket),
            Err(mpsc::error::TrySendError::Full(_)) => Err(RequestError::Full {
                limit: REQUESTS_MAX,
            }),
            Err(mpsc::error::TrySendError::Closed(_)) => Err(RequestError::NotConnected),
        }
    }

    /// What went over the wire; copies go on recording with the link.
    #[must_use]
    pub fn tap(&self) -> WireTap {
        self.tap.clone()
    }

    /// The next event, if one waits.
    pub fn try_event(&mut self) -> Option<LinkEvent> {
        self.events.try_recv().ok()
    }

    /// Waits for the next event. `None` once the session has ended.
    pub async fn event(&mut self) -> Option<LinkEvent> {
        self.events.recv().await
    }
}

impl Drop for LinkHandle {
    fn drop(&mut self) {
        self.wanted.send_modify(|wanted| wanted.closed = true);
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::indexing_slicing,
        clippy::panic,
        reason = "a test may"
    )]
    use super::*;
    use crate::hand::{Angle, Dof};

    fn one(epoch: u64, dof: Dof, angle: i16) -> Setpoints {
        let mut setpoints = Setpoints::none(ArmEpoch(epoch));
        setpoints.angle[dof] = Some(Target::Go(Angle::nearest(angle)));
        setpoints
    }

    #[test]
    fn the_newest_value_of_each_joint_wins() {
        let mut all = one(1, Dof::Little, 100);
        all.merge(&one(1, Dof::Index, 300));
        all.merge(&one(1, Dof::Little, 200));
        assert_eq!(all.angle[Dof::Little].unwrap().raw(), 200);
        assert_eq!(all.angle[Dof::Index].unwrap().raw(), 300);
    }

    #[test]
    fn another_arming_forgets_older_setpoints() {
        let mut all = one(1, Dof::Little, 100);
        all.merge(&one(2, Dof::Index, 300));
        assert_eq!(all, one(2, Dof::Index, 300));
    }
}
