//! Reaching a hand, and the waits that tasks share.

use crate::link::{LinkHandle, RequestError};
use crate::record::{LinkState, NotSent, Rest};
use crate::transport::Endpoint;
use std::time::Duration;
use tokio::time::{Instant, sleep};

/// A connected hand answers within this time, also on a port that was released a moment ago.
pub const REACH_TIMEOUT: Duration = Duration::from_secs(3);
/// Maximum wait for a hand that still moves, or that saved just now.
const REST_TIMEOUT: Duration = Duration::from_secs(8);
/// Interval between attempts.
pub(crate) const RETRY_DELAY: Duration = Duration::from_millis(200);
/// Polling interval of a wait.
const POLL_INTERVAL: Duration = Duration::from_millis(10);

/// Connects to a hand at an endpoint. A port has room for one link, so the previous link is closed.
pub trait Reach: Send {
    /// The hand that answers at an endpoint; `None` if none does within [`REACH_TIMEOUT`].
    fn reach(&mut self, place: &Endpoint) -> impl Future<Output = Option<LinkHandle>> + Send;
}

/// Waits until the hand answers; false after `within`.
pub async fn answers(hand: &LinkHandle, within: Duration) -> bool {
    let until = Instant::now() + within;
    while !hand.status().state.is_live() {
        if Instant::now() >= until {
            return false;
        }
        sleep(POLL_INTERVAL).await;
    }
    true
}

/// Waits until a live hand is known to rest and is neither armed nor holding; false after [`REST_TIMEOUT`].
pub(crate) async fn rests(hand: &LinkHandle) -> bool {
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

/// Sends a request, and repeats it for a while if the hand still moves or an earlier SAVE is too recent.
///
/// # Errors
/// As returned by the link.
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
