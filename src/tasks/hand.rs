//! A hand as tasks see it, how one is reached, and the waits that tasks share.

use crate::hand::{HandCommand, Moment, Setpoints, Setting, Span};
use crate::link::{
    ArmRequest, Lease, LeaseRefusal, LinkHandle, LinkStatus, Owner, PollRates, Records,
    RequestError, Stop, stop::until_rest,
};
use crate::record::{Calibrated, Disarmed, LinkState, NotSent, Reset, Rest, Saved, Written};
use crate::transport::Endpoint;
use std::time::Duration;
use tokio::time::{Instant, sleep};

/// A hand that is there answers within this, also on a port that was given up a moment ago.
pub const REACH_TIMEOUT: Duration = Duration::from_secs(3);
/// A hand that still moves, or saved just now, is waited for this long.
const REST_TIMEOUT: Duration = Duration::from_secs(8);
/// So often it is asked again.
pub(crate) const RETRY_DELAY: Duration = Duration::from_millis(200);
/// How often a wait looks.
const POLL_INTERVAL: Duration = Duration::from_millis(10);

/// One hand on an open link. The fake of tests is the other one who is this.
pub trait TaskHand: Clone + Send + Sync + 'static {
    /// Status of the link now.
    fn status(&self) -> LinkStatus;
    /// Everything that happens from now on.
    fn records(&self) -> Records;
    /// Reads a span of the hand's memory.
    fn read(&self, span: Span) -> impl Future<Output = Result<Vec<u8>, RequestError>> + Send;
    /// Writes, and waits for the acknowledgement.
    fn write(&self, command: HandCommand) -> impl Future<Output = Result<(), RequestError>> + Send;
    /// Writes a kept setting and reads it back.
    fn set_kept(
        &self,
        setting: Setting,
    ) -> impl Future<Output = Result<Written, RequestError>> + Send;
    /// Writes a kept setting, by which the hand may be found elsewhere then.
    fn set_unread(&self, setting: Setting)
    -> impl Future<Output = Result<(), RequestError>> + Send;
    /// Writes the parameters to flash.
    fn save(&self) -> impl Future<Output = Result<Saved, RequestError>> + Send;
    /// Returns to the factory's parameters.
    fn reset(&self) -> impl Future<Output = Result<Reset, RequestError>> + Send;
    /// Calibrates the force sensors.
    fn calibrate(&self) -> impl Future<Output = Result<Calibrated, RequestError>> + Send;
    /// Holds before anything else, and disarms.
    fn stop(&self);
    /// The same, and waits for what feedback says of it.
    fn stopped(&self) -> impl Future<Output = Stop> + Send {
        async {
            self.stop();
            until_rest(|| self.status()).await
        }
    }
    /// Lets no setpoint pass any more.
    fn disarm(&self);
    /// Grants the right to move the hand. The user must have asked for it.
    fn grant(&self, owner: Owner) -> Lease;
    /// Whether a lease still holds.
    fn check(&self, lease: Lease) -> Result<(), LeaseRefusal>;
    /// Asks to arm, within these limits.
    fn arm(&self, lease: Lease, request: ArmRequest) -> Result<(), LeaseRefusal>;
    /// Sets targets and limits.
    fn set(&self, lease: Lease, setpoints: &Setpoints) -> Result<(), LeaseRefusal>;
    /// Stops the hand at this moment, unless it is put off before; the lease outlasts it.
    fn run_until(&self, lease: Lease, until: Moment) -> Result<(), LeaseRefusal>;
    /// Stops and disarms; the lease outlasts it.
    fn halt(&self, lease: Lease) -> Result<(), LeaseRefusal>;
    /// Disarms a hand that has nothing to do; the lease outlasts it.
    fn rest(&self, lease: Lease) -> Result<(), LeaseRefusal>;
    /// Stops, disarms and ends the lease for this reason.
    fn give_back(&self, lease: Lease, why: Disarmed) -> Result<(), LeaseRefusal>;
    /// Reads at other rates.
    fn read_at(&self, rates: PollRates);
}

impl TaskHand for LinkHandle {
    fn status(&self) -> LinkStatus {
        Self::status(self)
    }
    fn records(&self) -> Records {
        Self::records(self)
    }
    async fn read(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        Self::read(self, span).await
    }
    async fn write(&self, command: HandCommand) -> Result<(), RequestError> {
        Self::write(self, command).await
    }
    async fn set_kept(&self, setting: Setting) -> Result<Written, RequestError> {
        Self::set_kept(self, setting).await
    }
    async fn set_unread(&self, setting: Setting) -> Result<(), RequestError> {
        Self::set_unread(self, setting).await
    }
    async fn save(&self) -> Result<Saved, RequestError> {
        Self::save(self).await
    }
    async fn reset(&self) -> Result<Reset, RequestError> {
        Self::reset(self).await
    }
    async fn calibrate(&self) -> Result<Calibrated, RequestError> {
        Self::calibrate(self).await
    }
    fn stop(&self) {
        let _acts_unawaited = Self::stop(self);
    }
    async fn stopped(&self) -> Stop {
        Self::stop(self).await
    }
    fn disarm(&self) {
        Self::disarm(self);
    }
    fn grant(&self, owner: Owner) -> Lease {
        Self::grant(self, owner)
    }
    fn check(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        Self::check(self, lease)
    }
    fn arm(&self, lease: Lease, request: ArmRequest) -> Result<(), LeaseRefusal> {
        Self::arm(self, lease, request).map(drop)
    }
    fn set(&self, lease: Lease, setpoints: &Setpoints) -> Result<(), LeaseRefusal> {
        Self::set(self, lease, setpoints)
    }
    fn run_until(&self, lease: Lease, until: Moment) -> Result<(), LeaseRefusal> {
        Self::run_until(self, lease, until)
    }
    fn halt(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        Self::halt(self, lease)
    }
    fn rest(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        Self::rest(self, lease)
    }
    fn give_back(&self, lease: Lease, why: Disarmed) -> Result<(), LeaseRefusal> {
        Self::give_back(self, lease, why)
    }
    fn read_at(&self, rates: PollRates) {
        Self::read_at(self, rates);
    }
}

/// Goes where a hand may be. A port has room for one link, so the one of before is given up.
pub trait Reach: Send {
    /// Link to a hand that was found.
    type Link: TaskHand;
    /// The hand that answers at a place; `None` if none does within [`REACH_TIMEOUT`].
    fn reach(&mut self, place: &Endpoint) -> impl Future<Output = Option<Self::Link>> + Send;
}

/// Waits until the hand answers; false if it does not in time.
pub async fn answers<H: TaskHand>(hand: &H, within: Duration) -> bool {
    let until = Instant::now() + within;
    while !hand.status().state.is_live() {
        if Instant::now() >= until {
            return false;
        }
        sleep(POLL_INTERVAL).await;
    }
    true
}

/// Waits for a while until a hand that answers is known to rest and nobody moves it; false if it does not come to that.
pub(crate) async fn rests<H: TaskHand>(hand: &H) -> bool {
    let until = Instant::now() + REST_TIMEOUT;
    loop {
        let status = hand.status();
        let is_left_alone = matches!(status.state, LinkState::Monitoring | LinkState::Fault);
        if is_left_alone && status.rest == Rest::Resting {
            return true;
        }
        if Instant::now() >= until {
            return false;
        }
        sleep(POLL_INTERVAL).await;
    }
}

/// Asks, and asks again for a while where the hand still moves or an earlier SAVE is too near.
///
/// # Errors
/// As the link says.
pub(crate) async fn once_at_rest<T, F: Future<Output = Result<T, RequestError>>>(
    ask: impl Fn() -> F,
    not_sent: fn(&T) -> Option<NotSent>,
) -> Result<T, RequestError> {
    let until = Instant::now() + REST_TIMEOUT;
    loop {
        let end = ask().await?;
        let wait = match not_sent(&end) {
            None | Some(NotSent::Armed) => return Ok(end),
            Some(NotSent::TooSoon { wait }) => wait,
            Some(NotSent::Moving | NotSent::RestUnknown | NotSent::Holding) => RETRY_DELAY,
        };
        if Instant::now() >= until {
            return Ok(end);
        }
        sleep(wait).await;
    }
}
