//! The program's end of a link: what may be said to it and what is heard. Only a request waits, for its answer.

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
use crate::link::wanted::{AskedArm, Ends, PendingControl};
use crate::record::{ArmRefusal, Calibrated, Disarmed, Hold, Record, Reset, Saved, Written};
use futures::FutureExt as _;
use futures::future::BoxFuture;
use std::sync::{Arc, Weak};
use std::time::Duration;
use tokio::sync::{broadcast, mpsc, oneshot, watch};
use tokio::time::timeout;

/// Requests that may wait: the user cannot ask faster than this drains.
pub const REQUESTS_MAX: usize = 16;
/// Records that may wait for a reader: ten seconds of samples at full rate of a serial line.
pub const RECORDS_MAX: usize = 1024;

/// An arming that has no answer by then has none: longer than one takes on the slowest way to a hand.
const ARM_TIMEOUT: Duration = Duration::from_secs(5);

/// One open link, for as many as want to use it. The wire closes with the last of its handles; the hand keeps what it was
/// told last.
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

/// Opens a link on this runtime and keeps it open until the last handle is dropped. Gives its records from the first on.
/// Writes nothing by itself.
pub fn open(config: LinkConfig, runtime: &tokio::runtime::Handle) -> (LinkHandle, Records) {
    let (handle, ends, records) = channels(config.clock);
    runtime.spawn(Session::new(config, ends).run());
    (handle, records)
}

/// A handle, the ends that its session holds, and its records from the first on.
pub(crate) fn channels(clock: Clock) -> (LinkHandle, Ends, Records) {
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
    let ends = Ends {
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
    /// Where the link stands now.
    pub fn status(&self) -> LinkStatus {
        let mut status = self.0.status.borrow().clone();
        // Granted at once, and not when the session next looks.
        status.holder = self.0.wanted.borrow().book.holder();
        status
    }

    /// The link's statistics so far.
    pub fn stats(&self) -> LinkStats {
        *self.0.stats.borrow()
    }

    /// Stops the hand where it is, before anything else, and disarms. Everything not yet sent is dropped, and whoever might move
    /// the hand may no more. It acts at once, also if the request is dropped; awaited, it ends with what feedback says of the stop.
    /// Without a live link it stays pending for [`STOP_PENDING`].
    ///
    /// [`STOP_PENDING`]: crate::link::STOP_PENDING
    pub fn stop(&self) -> StopRequest {
        let pressed = self.0.clock.now();
        self.end(Disarmed::Stop, PendingControl::stop);
        let link = self.clone();
        StopRequest { link, pressed }
    }

    /// The status, in which no stop is confirmed by rest that was seen before `pressed`, or while the session has not taken the stop.
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

    /// Disarms: no more setpoints pass, and whoever might move the hand may no more. The hand keeps its last targets.
    pub fn disarm(&self) {
        self.end(Disarmed::Person, PendingControl::disarm);
    }

    fn end(&self, why: Disarmed, how: fn(&mut PendingControl, Disarmed)) {
        self.0.wanted.send_modify(|wanted| {
            how(wanted, why);
            wanted.book.end(why);
        });
    }

    /// Grants the right to move the hand. The user must have asked for it. Nothing that the holder before sent passes any more;
    /// an armed hand stays armed.
    pub fn grant(&self, owner: Owner) -> Lease {
        let mut granted = None;
        self.0
            .wanted
            .send_modify(|wanted| granted = Some(wanted.grant(owner)));
        granted.unwrap_or_else(|| unreachable!("the slot is modified at once"))
    }

    /// Whether a lease still holds.
    ///
    /// # Errors
    /// Why not.
    pub fn check(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.0.wanted.borrow().book.check(lease)
    }

    /// Asks to arm. It happens whether the answer is awaited or not.
    ///
    /// # Errors
    /// Nothing is asked under a lease that does not hold.
    pub fn arm(&self, lease: Lease, request: ArmRequest) -> Result<Arming, LeaseRefusal> {
        let (answer, answered) = oneshot::channel();
        let asked = AskedArm {
            lease,
            request,
            answer,
        };
        self.under(lease, |wanted| wanted.arm = Some(asked))?;
        Ok(Arming(answered))
    }

    /// Sets targets and limits: the newest of each joint is sent, at most [`SETPOINT_HZ_MAX`] times a second.
    ///
    /// # Errors
    /// Nothing is sent under a lease that does not hold.
    ///
    /// [`SETPOINT_HZ_MAX`]: crate::link::session::motion::SETPOINT_HZ_MAX
    pub fn set(&self, lease: Lease, setpoints: &Setpoints) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.set(setpoints))
    }

    /// From now on the hand is stopped at this moment, unless it is put off before: while the user holds what has to be held.
    /// The lease outlasts that, so that who holds again may arm again.
    ///
    /// # Errors
    /// Nothing is changed under a lease that does not hold.
    pub fn run_until(&self, lease: Lease, until: Moment) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.runs_until = Some(until))
    }

    /// Whether the user has to hold something while the hand moves. Let go, an armed hand is stopped and disarmed before anything
    /// else; leases outlast that.
    pub fn hold_to_run(&self, hold: HoldToRun) {
        self.0
            .wanted
            .send_if_modified(|wanted| std::mem::replace(&mut wanted.hold_to_run, hold) != hold);
    }

    /// Stops the hand where it is, before anything else, and disarms. The lease outlasts it.
    ///
    /// # Errors
    /// Nothing is stopped under a lease that does not hold.
    pub fn halt(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.stop(Disarmed::Released))
    }

    /// Disarms a hand that has nothing to do. The lease outlasts it.
    ///
    /// # Errors
    /// Nothing is changed under a lease that does not hold.
    pub fn rest(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.under(lease, |wanted| wanted.disarm(Disarmed::Released))
    }

    /// Ends a lease for this reason: the hand is stopped and disarmed, and the user has to grant it again.
    ///
    /// # Errors
    /// Nothing is stopped under a lease that does not hold.
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

    /// Reads at other rates from now on, reconnects included. Only what is asked for changes; nothing is written.
    pub fn read_at(&self, rates: PollRates) {
        self.0
            .wanted
            .send_modify(|wanted| wanted.rates = Some(rates));
    }

    /// Reads this first while something moves, reconnects included.
    pub fn read_first(&self, priority: PollPriority) {
        // Looked at before each read, so that nobody has to be woken for it.
        self.0.wanted.send_if_modified(|wanted| {
            wanted.priority = priority;
            false
        });
    }

    /// Writes, and waits until the hand acknowledged. It does not say that the value is in force. What moves the hand is
    /// refused: that needs a lease.
    ///
    /// # Errors
    /// [`RequestError`]: [`RequestError::NotConnected`] at once while there is no live hand, [`RequestError::Full`] if too
    /// many wait. Nothing is tried again by itself.
    pub async fn write(&self, command: HandCommand) -> Result<(), RequestError> {
        self.request(|answer| Request::Command(command, None, answer))
            .await
    }

    /// Writes under a lease, and waits as [`Self::write`] does. What moves the hand needs arming too.
    ///
    /// # Errors
    /// As [`Self::write`], and [`RequestError::NotOwner`] if the lease does not hold when it is this command's turn.
    pub async fn write_as(&self, lease: Lease, command: HandCommand) -> Result<(), RequestError> {
        self.request(|answer| Request::Command(command, Some(lease), answer))
            .await
    }

    /// Reads some memory.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn read(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        self.request(|answer| Request::Read(span, answer)).await
    }

    /// Writes one kept group at rest, reads it back, and says what the hand holds.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn set_kept(&self, setting: Setting) -> Result<Written, RequestError> {
        self.request(|answer| Request::Set(setting, answer)).await
    }

    /// Writes one kept group at rest, once. It is not read back: the hand may answer elsewhere then.
    ///
    /// # Errors
    /// As [`Self::write`], and [`RequestError::NotNow`] while the hand is armed or not known to rest.
    pub async fn set_unread(&self, setting: Setting) -> Result<(), RequestError> {
        self.request(|answer| Request::SetUnread(setting, answer))
            .await
    }

    /// Writes the hand's parameters to its flash, and says what is known of it (manual 2.6.4).
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn save(&self) -> Result<Saved, RequestError> {
        self.request(Request::Save).await
    }

    /// Returns to the factory's parameters. The hand may be found at another id, speed or address afterwards.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn reset(&self) -> Result<Reset, RequestError> {
        self.request(Request::Reset).await
    }

    /// Calibrates the force sensors. The line is left to the hand, and nothing arms, until that is over.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub async fn calibrate(&self) -> Result<Calibrated, RequestError> {
        self.request(Request::Calibrate).await
    }

    /// Asks one thing and waits for its end. What is dropped before it was sent is not sent.
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
            // The session ended with the request in its hands.
            Err(_gone) => Err(RequestError::LinkLost),
        }
    }

    /// Everything that happens from now on.
    pub fn records(&self) -> Records {
        match self.0.records.upgrade() {
            Some(records) => Records::of(records.subscribe()),
            None => Records::of(broadcast::channel(1).1),
        }
    }

    /// What may be watched of the link without keeping it open.
    pub fn observe(&self) -> LinkObserver {
        LinkObserver {
            records: self.records(),
            tap: self.tap(),
            status: self.0.status.clone(),
            stats: self.0.stats.clone(),
        }
    }

    /// What stops the hand from elsewhere without keeping the link open.
    pub fn stopper(&self) -> LinkStopper {
        LinkStopper(Arc::downgrade(&self.0))
    }

    /// The memory as it was read last.
    pub(crate) fn image(&self) -> watch::Receiver<RegisterImage> {
        self.0.image.clone()
    }

    /// The clock of this link.
    pub fn clock(&self) -> Clock {
        self.0.clock
    }

    /// The recorded traffic; copies go on recording with the link.
    pub fn tap(&self) -> WireTap {
        self.0.tap.clone()
    }
}

/// An arming that was asked for. Awaited, it ends with the epoch that setpoints belong to, or why the hand was not armed.
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

/// A stop that was asked for. It acts whether it is awaited or not; awaited it says what feedback says of it. It stays pending while a
/// link that was lost comes back within [`STOP_PENDING`](crate::link::STOP_PENDING).
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

/// Stops a hand from elsewhere. The wire closes with the last handle, whoever still has this.
#[derive(Debug, Clone)]
pub struct LinkStopper(Weak<LinkShared>);

impl LinkStopper {
    /// Stops the hand as [`LinkHandle::stop`] does if anybody may move it over this link, or it may still go on, and writes nothing
    /// otherwise. True if it was told to stop.
    pub fn stop_if_moved(&self) -> bool {
        let link = self.0.upgrade().map(LinkHandle);
        let moved = link.filter(|link| link.status().goes_on());
        let stop = moved.map(|link| link.stop());
        stop.is_some()
    }
}
