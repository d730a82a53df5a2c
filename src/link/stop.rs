//! A stop as whoever asked for it sees it: it acts at once, and can be awaited until feedback says how it went.

use crate::hand::Moment;
use crate::link::handle::LinkHandle;
use crate::link::status::LinkStatus;
use crate::record::Hold;
use futures::FutureExt as _;
use futures::future::BoxFuture;
use std::time::Duration;
use tokio::time::{Instant, sleep};

/// A hand that answers again within this time after its link was lost, or after the press while it was, is stopped before anything
/// else. Later its user may have moved or opened it: it is only watched until it rests.
pub const STOP_PENDING: Duration = Duration::from_secs(3);
/// How long feedback of a live link may take to show rest; the link raises its alarm after half a second.
const REST_TIMEOUT: Duration = Duration::from_secs(3);
/// From the first answer of a hand that is back to a link that is live.
const IDENTIFY_TIMEOUT: Duration = Duration::from_millis(700);
/// All of that, also of a link that comes and goes.
const STOP_TIMEOUT: Duration = Duration::from_secs(10);
/// How often the status is inspected.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// What feedback says of a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    /// The hand rests, so long after the stop.
    Confirmed {
        /// From the stop to rest.
        after: Duration,
    },
    /// It does not show rest.
    NotConfirmed,
    /// The link is gone, and did not come back in time.
    LinkLost,
}

/// A stop that was asked for. It acts whether it is awaited or not; awaited it says what feedback says of it. It stays pending while a
/// link that was lost comes back within [`STOP_PENDING`].
#[derive(Debug)]
pub struct StopRequest {
    pub(crate) link: LinkHandle,
    pub(crate) pressed: Moment,
}

impl IntoFuture for StopRequest {
    type Output = Stop;
    type IntoFuture = BoxFuture<'static, Stop>;

    fn into_future(self) -> Self::IntoFuture {
        let Self { link, pressed } = self;
        async move { until_rest(|| link.status_since(pressed)).await }.boxed()
    }
}

/// Waits until feedback says how a stop went that was asked for just now.
pub(crate) async fn until_rest(status: impl Fn() -> LinkStatus + Send) -> Stop {
    let begun = Instant::now();
    let (mut live_since, mut lost_since) = (begun, None);
    loop {
        let status = status();
        if let Hold::Confirmed { at, rest } = status.hold
            && status.armed.is_none()
            && status.state.is_live()
        {
            return Stop::Confirmed {
                after: rest.since(at),
            };
        }
        let now = Instant::now();
        let is_over = now - begun >= STOP_TIMEOUT;
        if status.state.is_live() {
            if lost_since.take().is_some() {
                live_since = now;
            }
            if is_over || now - live_since >= REST_TIMEOUT {
                return Stop::NotConfirmed;
            }
        } else {
            let since = *lost_since.get_or_insert(now);
            if is_over || now - since >= STOP_PENDING + IDENTIFY_TIMEOUT {
                return Stop::LinkLost;
            }
        }
        sleep(POLL_INTERVAL).await;
    }
}
