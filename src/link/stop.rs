//! How a stop ends, as feedback shows it.

use crate::link::status::LinkStatus;
use crate::record::Hold;
use serde::ser::SerializeStruct as _;
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

/// The same in JSON everywhere: `{"confirmed": true, "after_s": 0.12}`.
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
