//! Outcome of a stop according to feedback.

use crate::link::status::LinkStatus;
use crate::record::Hold;
use serde::ser::SerializeStruct as _;
use std::time::Duration;
use tokio::time::{Instant, sleep};

/// A hand that answers again within this time after its link was lost, or after a stop was requested while it was, is
/// stopped before anything else. Later the user may have moved or opened it: it is only watched until it rests.
pub const STOP_PENDING: Duration = Duration::from_secs(3);
/// Time within which feedback of a live link must show rest; the link raises its alarm after half a second.
const REST_TIMEOUT: Duration = Duration::from_secs(3);
/// Time from the first reply of a reconnected hand to a live link.
const IDENTIFY_TIMEOUT: Duration = Duration::from_millis(700);
/// Total time limit, also for a link that fails repeatedly.
const STOP_TIMEOUT: Duration = Duration::from_secs(10);
/// Interval at which the status is polled.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// Outcome of a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stop {
    /// The hand rests.
    Confirmed {
        /// Time from the stop to rest.
        after: Duration,
    },
    /// The hand does not show rest.
    NotConfirmed,
    /// The link was lost, and did not come back in time.
    LinkLost,
}

/// One JSON form everywhere: `{"confirmed": true, "after_s": 0.12}`.
impl serde::Serialize for Stop {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let after_s = match self {
            Self::Confirmed { after } => Some(after.as_secs_f64()),
            Self::NotConfirmed | Self::LinkLost => None,
        };
        let mut fields = serializer.serialize_struct("Stop", 2)?;
        fields.serialize_field("confirmed", &after_s.is_some())?;
        fields.serialize_field("after_s", &after_s)?;
        fields.end()
    }
}

/// Waits for the outcome of a stop that was requested just now.
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
