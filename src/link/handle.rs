//! The program's handle to a link: its requests and its records. Only a request waits, for its reply.

use crate::hand::{ArmEpoch, HandCommand, Moment, Setpoints, Setting, Span};
use crate::link::clock::Clock;
use crate::link::config::LinkConfig;
use crate::link::image::RegisterImage;
use crate::link::lease::{HoldToRun, Lease, LeaseRefusal, Owner};
use crate::link::poll::plan::{PollPriority, PollRates};
use crate::link::records::{LinkObserver, Records};
use crate::link::request::{Answer, Request, RequestError};
use crate::link::session::conversation::Session;
use crate::link::stats::LinkStats;
use crate::link::status::{ArmRequest, LinkStatus};
use crate::link::stop::{Stop, until_rest};
use crate::link::tap::WireTap;
use crate::link::wanted::{ArmCommand, PendingControl, SessionChannels};
use crate::record::{ArmRefusal, Calibrated, Disarmed, Hold, Record, Reset, Saved, Written};
use futures::FutureExt as _;
use futures::future::BoxFuture;
use std::sync::{Arc, Weak};
use std::time::Duration;
use tokio::sync::{broadcast, mpsc, oneshot, watch};
use tokio::time::timeout;

/// Capacity of the request queue: the user cannot send requests faster than it drains.
pub const REQUESTS_MAX: usize = 16;
/// Capacity of the record queue of a reader: ten seconds of samples at full rate of a serial line.
pub const RECORDS_MAX: usize = 1024;

/// Time after which an arming counts as unanswered: longer than it takes on the slowest link.
const ARM_TIMEOUT: Duration = Duration::from_secs(5);

/// One open link, shared by its copies. The wire closes with the last handle; the hand keeps its last targets.
///
/// ```no_run
/// # async fn example() -> Result<(), Box<dyn std::error::Error>> {
/// use handscope_core::hand::register;
/// use handscope_core::link::{self, Clock, LinkConfig, PollRates};
/// use handscope_core::transport::SystemDial;
/// use std::sync::Arc;
///
/// let config = LinkConfig {
///     endpoint: "rs485:/dev/ttyUSB0".parse()?,
///     rates: PollRates::default(),
///     clock: Clock::start(),
///     dial: Arc::new(SystemDial),
///     wake: Arc::new(|| ()),
/// };
/// let (hand, mut records) = link::open(config, &tokio::runtime::Handle::current());
/// println!("{:?}", hand.read(register::HAND_ID.span()).await?);
/// while let Some(record) = records.next().await {
///     println!("{record:?}");
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct LinkHandle(Arc<LinkShared>);

#[derive(Debug)]
struct LinkShared {
    wanted: Arc<watch::Sender<PendingControl>>,
    requests: mpsc::Sender<Request>,
    records: broadcast::WeakSender<Record>,
    status: watch::Receiver<LinkStatus>,
    stats: watch::Receiver<LinkStats>,
    image: watch::Receiver<RegisterImage>,
    clock: Clock,
    tap: WireTap,
}

impl Drop for LinkShared {
    fn drop(&mut self) {
        self.wanted.send_modify(|wanted| wanted.closed = true);
    }
}

/// Opens a link on this runtime and keeps it open until the last handle is dropped. Returns its records from the start.
/// Writes nothing by itself.
pub fn open(config: LinkConfig, runtime: &tokio::runtime::Handle) -> (LinkHandle, Records) {
    let (handle, ends, records) = channels(config.clock);
    runtime.spawn(Session::new(config, ends).run());
    (handle, records)
}

/// Returns a handle, the session's ends of its channels, and its records from the start.
pub(crate) fn channels(clock: Clock) -> (LinkHandle, SessionChannels, Records) {
    let wanted = Arc::new(watch::Sender::new(PendingControl::default()));
    let (requests_in, requests) = mpsc::channel(REQUESTS_MAX);
    let (records_in, records) = broadcast::channel(RECORDS_MAX);
    let (status_in, status) = watch::channel(LinkStatus {
        since: clock.now(),
        ..LinkStatus::default()
    });
    let (stats_in, stats) = watch::channel(LinkStats::default());
    let (image_in, image) = watch::channel(RegisterImage::default());
    let tap = WireTap::default();
    let shared = LinkShared {
        wanted: Arc::clone(&wanted),
        requests: requests_in,
        records: records_in.downgrade(),
        status,
        stats,
        image,
        clock,
        tap: tap.clone(),
    };
    let ends = SessionChannels {
        wanted,
        requests,
        records: records_in,
        status: status_in,
        stats: stats_in,
        image: image_in,
        tap,
    };
    (LinkHandle(Arc::new(shared)), ends, Records::of(records))
}

impl LinkHandle {
    /// The present status.
    pub fn status(&self) -> LinkStatus {
        let mut status = self.0.status.borrow().clone();
        // Visible at once, not only after the session's next step.
        status.holder = self.0.wanted.borrow().book.holder();
        status
    }

    /// The link's statistics so far.
    pub fn stats(&self) -> LinkStats {
        *self.0.stats.borrow()
    }

    /// Stops the hand in place, before anything else, and disarms. Everything not yet sent is dropped, and the lease
    /// ends. It acts at once, even if the returned request is dropped; awaiting it yields the outcome according to
    /// feedback. Without a live link it stays pending for [`STOP_PENDING`].
    ///
    /// [`STOP_PENDING`]: crate::link::STOP_PENDING
    pub fn stop(&self) -> StopRequest {
        let pressed = self.0.clock.now();
        self.end(Disarmed::Stop, PendingControl::stop);
        let link = self.clone();
        StopRequest { link, pressed }
    }

    /// The status; a stop does not count as confirmed by rest seen before `pressed`, or while the session has not
    /// applied the stop.
    pub(crate) fn status_since(&self, pressed: Moment) -> LinkStatus {
        let is_waiting = self.0.wanted.borrow().stop;
        let mut status = self.status();
        if let Hold::Confirmed { rest, .. } = status.hold
            && (is_waiting || rest < pressed)
        {
            status.hold = Hold::Asked {
                at: pressed,
                sent: 0,
            };
        }
        status
    }

    /// Disarms: setpoints are rejected from now on, and the lease ends. The hand keeps its last targets.
    pub fn disarm(&self) {
        self.end(Disarmed::Person, PendingControl::disarm);
    }

    fn end(&self, why: Disarmed, how: fn(&mut PendingControl, Disarmed)) {
        self.0.wanted.send_modify(|wanted| {
            how(wanted, why);
            wanted.book.end(why);
        });
    }

    /// Grants a lease. The user must have requested it. Nothing from the previous owner is sent after this; an armed
    /// hand stays armed.
    pub fn grant(&self, owner: Owner) -> Lease {
        let mut granted = None;
        self.0
            .wanted
            .send_modify(|wanted| granted = Some(wanted.grant(owner)));
        granted.unwrap_or_else(|| unreachable!("the slot is modified at once"))
    }

    /// Checks that a lease is still valid.
    ///
    /// # Errors
    /// The reason why it is not.
    pub fn check(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.0.wanted.borrow().book.check(lease)
    }

    /// Requests arming, which is executed even if the result is not awaited.
    ///
    /// # Errors
    /// Nothing is requested under an invalid lease.
    pub fn arm(&self, lease: Lease, request: ArmRequest) -> Result<Arming, LeaseRefusal> {
        let (answer, answered) = oneshot::channel();
        let asked = ArmCommand {
            lease,
            request,
            answer,
        };
        self.under(lease, |wanted| wanted.arm = Some(asked))?;
        Ok(Arming(answered))
    }

    /// Sets targets and limits: the newest of each joint is sent, at most [`SETPOINT_HZ_MAX`] times per second.
    ///
    /// # Errors
    /// Nothing is sent under an invalid lease.
    ///
    /// [`SETPOINT_HZ_MAX`]: crate::link::session::motion::SETPOINT_HZ_MAX
    pub fn set(&self, lease: Lease, setpoints: &Setpoints) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.set(setpoints))
    }

    /// Stops the hand at this time unless it is extended before: for use while the user holds a key. The lease remains
    /// valid, so that its owner can arm again.
    ///
    /// # Errors
    /// Nothing is changed under an invalid lease.
    pub fn run_until(&self, lease: Lease, until: Moment) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.runs_until = Some(until))
    }

    /// Sets the hold-to-run mode: the key the user has to hold while the hand moves. When it is released, an armed hand
    /// is stopped and disarmed before anything else; leases remain valid.
    pub fn hold_to_run(&self, hold: HoldToRun) {
        self.0
            .wanted
            .send_if_modified(|wanted| std::mem::replace(&mut wanted.hold_to_run, hold) != hold);
    }

    /// Stops the hand in place, before anything else, and disarms. The lease remains valid.
    ///
    /// # Errors
    /// Nothing is stopped under an invalid lease.
    pub fn halt(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.stop(Disarmed::Released))
    }

    /// Disarms an idle hand. The lease remains valid.
    ///
    /// # Errors
    /// Nothing is changed under an invalid lease.
    pub fn rest(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.disarm(Disarmed::Released))
    }

    /// Ends a lease for this reason: the hand is stopped and disarmed, and the user has to grant a lease again.
    ///
    /// # Errors
    /// Nothing is stopped under an invalid lease.
    pub fn give_back(&self, lease: Lease, why: Disarmed) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| {
            wanted.stop(why);
            wanted.book.end(why);
        })
    }

    fn under(
        &self,
        lease: Lease,
        want: impl FnOnce(&mut PendingControl),
    ) -> Result<(), LeaseRefusal> {
        let mut done = Ok(());
        self.0.wanted.send_if_modified(|wanted| {
            done = wanted.under(lease, want);
            done.is_ok()
        });
        done
    }

    /// Changes the poll rates, also for later reconnects. Writes nothing.
    pub fn read_at(&self, rates: PollRates) {
        self.0
            .wanted
            .send_modify(|wanted| wanted.rates = Some(rates));
    }

    /// Sets which reads are preferred during motion, also for later reconnects.
    pub fn read_first(&self, priority: PollPriority) {
        // Checked before each read, so the session need not be woken.
        self.0.wanted.send_if_modified(|wanted| {
            wanted.priority = priority;
            false
        });
    }

    /// Writes, and waits for the hand's acknowledgement, which does not prove that the value is in effect. Commands
    /// that move the hand are refused, because they need a lease.
    ///
    /// # Errors
    /// [`RequestError`]: [`RequestError::NotConnected`] at once while there is no live hand, [`RequestError::Full`] if
    /// the queue is full. Nothing is retried automatically.
    pub async fn write(&self, command: HandCommand) -> Result<(), RequestError> {
        self.request(|answer| Request::Command(command, None, answer))
            .await
    }

    /// Writes under a lease, and waits as [`Self::write`] does. Commands that move the hand need arming too.
    ///
    /// # Errors
    /// As [`Self::write`], and [`RequestError::NotOwner`] if the lease is invalid when the command has its turn.
    pub async fn write_as(&self, lease: Lease, command: HandCommand) -> Result<(), RequestError> {
        self.request(|answer| Request::Command(command, Some(lease), answer))
            .await
    }

    /// Reads a range of memory.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn read(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        self.request(|answer| Request::Read(span, answer)).await
    }

    /// Writes one persistent group at rest, reads it back, and returns the values that the hand holds.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn set_kept(&self, setting: Setting) -> Result<Written, RequestError> {
        self.request(|answer| Request::Set(setting, answer)).await
    }

    /// Writes one persistent group at rest, once. It is not read back: the hand may answer elsewhere afterwards.
    ///
    /// # Errors
    /// As [`Self::write`], and [`RequestError::NotNow`] while the hand is armed or not known to rest.
    pub async fn set_unread(&self, setting: Setting) -> Result<(), RequestError> {
        self.request(|answer| Request::SetUnread(setting, answer))
            .await
    }

    /// Writes the hand's parameters to its flash, and returns what is known of the result (manual 2.6.4).
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn save(&self) -> Result<Saved, RequestError> {
        self.request(Request::Save).await
    }

    /// Restores the factory parameters. The hand may have another id, speed or address afterwards.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn reset(&self) -> Result<Reset, RequestError> {
        self.request(Request::Reset).await
    }

    /// Calibrates the force sensors. Until that is over the line is reserved for the hand, and arming is refused.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn calibrate(&self) -> Result<Calibrated, RequestError> {
        self.request(Request::Calibrate).await
    }

    /// Sends one request and waits for its result. A future dropped before its request was sent cancels it.
    async fn request<T>(
        &self,
        request: impl FnOnce(Answer<T>) -> Request,
    ) -> Result<T, RequestError> {
        if !self.0.status.borrow().state.is_live() {
            return Err(RequestError::NotConnected);
        }
        let (answer, answered) = oneshot::channel();
        self.0
            .requests
            .try_send(request(answer))
            .map_err(|refused| match refused {
                mpsc::error::TrySendError::Full(_) => RequestError::Full {
                    limit: REQUESTS_MAX,
                },
                mpsc::error::TrySendError::Closed(_) => RequestError::NotConnected,
            })?;
        match answered.await {
            Ok(end) => end,
            // The session ended during the request.
            Err(_gone) => Err(RequestError::LinkLost),
        }
    }

    /// All records from now on.
    pub fn records(&self) -> Records {
        match self.0.records.upgrade() {
            Some(records) => Records::of(records.subscribe()),
            None => Records::of(broadcast::channel(1).1),
        }
    }

    /// Observes the link without keeping it open.
    pub fn observe(&self) -> LinkObserver {
        LinkObserver {
            records: self.records(),
            tap: self.tap(),
            status: self.0.status.clone(),
            stats: self.0.stats.clone(),
        }
    }

    /// Returns a stopper for the hand that does not keep the link open.
    pub fn stopper(&self) -> LinkStopper {
        LinkStopper(Arc::downgrade(&self.0))
    }

    /// The last read memory.
    pub(crate) fn image(&self) -> watch::Receiver<RegisterImage> {
        self.0.image.clone()
    }

    /// The clock of this link.
    pub fn clock(&self) -> Clock {
        self.0.clock
    }

    /// The recorded traffic; copies continue to record with the link.
    pub fn tap(&self) -> WireTap {
        self.0.tap.clone()
    }
}

/// A requested arming. Awaiting it yields the epoch for setpoints, or the reason why the hand was not armed.
#[derive(Debug)]
pub struct Arming(oneshot::Receiver<Result<ArmEpoch, ArmRefusal>>);

impl IntoFuture for Arming {
    type Output = Result<ArmEpoch, ArmRefusal>;
    type IntoFuture = BoxFuture<'static, Self::Output>;

    fn into_future(self) -> Self::IntoFuture {
        async move {
            match timeout(ARM_TIMEOUT, self.0).await {
                Ok(Ok(answer)) => answer,
                Ok(Err(_dropped)) => Err(ArmRefusal::Replaced),
                Err(_late) => Err(ArmRefusal::NoAnswer),
            }
        }
        .boxed()
    }
}

/// A requested stop. It acts even if it is not awaited; awaiting it yields the outcome according to feedback. It stays
/// pending while a lost link comes back within [`STOP_PENDING`](crate::link::STOP_PENDING).
#[derive(Debug)]
pub struct StopRequest {
    link: LinkHandle,
    pressed: Moment,
}

impl IntoFuture for StopRequest {
    type Output = Stop;
    type IntoFuture = BoxFuture<'static, Stop>;

    fn into_future(self) -> Self::IntoFuture {
        let Self { link, pressed } = self;
        async move { until_rest(|| link.status_since(pressed)).await }.boxed()
    }
}

/// Stops a hand without keeping its link open. The wire closes with the last handle, even if a stopper remains.
#[derive(Debug, Clone)]
pub struct LinkStopper(Weak<LinkShared>);

impl LinkStopper {
    /// Stops the hand as [`LinkHandle::stop`] does if a lease is held on this link, or the hand may still move, and
    /// writes nothing otherwise. True if a stop was requested.
    pub fn stop_if_moved(&self) -> bool {
        let link = self.0.upgrade().map(LinkHandle);
        let moved = link.filter(|link| link.status().may_continue());
        let stop = moved.map(|link| link.stop());
        stop.is_some()
    }
}
