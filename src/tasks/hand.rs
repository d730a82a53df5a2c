//! A hand as tasks see it, how one is reached, and the waits that tasks share.

use crate::link::{LinkHandle, RequestError};
use crate::record::{LinkState, NotSent, Rest};
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

/// Goes where a hand may be. A port has room for one link, so the one of before is given up.
pub trait Reach: Send {
    /// The hand that answers at a place; `None` if none does within [`REACH_TIMEOUT`].
    fn reach(&mut self, place: &Endpoint) -> impl Future<Output = Option<LinkHandle>> + Send;
}

/// Waits until the hand answers; false if it does not in time.
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

/// Waits for a while until a hand that answers is known to rest and nobody moves it; false if it does not come to that.
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
