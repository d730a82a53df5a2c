//! Reading the persistent parameters of a hand. Writes nothing.

use crate::hand::Span;
use crate::link::{LinkHandle, RequestError};
use crate::params::rows::ParamId;
use crate::params::values::{Params, SPANS};
use crate::tasks::TaskError;
use crate::tasks::hand::{REACH_TIMEOUT, RETRY_DELAY, answers};
use std::time::Duration;
use tokio::time::sleep;

/// Attempts to read a group: a reply may get lost, and a lost link may return.
const TRIES: u32 = 4;
/// Maximum waits for a late reply to an earlier request: one after each lost reply.
const WAITS: u32 = TRIES;

/// Parameters that were read, and the errors for the others.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReadRows {
    /// Rows that could be read.
    pub params: Params,
    /// Errors of the groups that could not be read.
    pub troubles: Vec<RequestError>,
}

impl ReadRows {
    /// Returns the parameters if all needed rows were read.
    ///
    /// # Errors
    /// [`TaskError::NotRead`] with the first missing row.
    pub fn with(self, is_needed: impl Fn(ParamId) -> bool) -> Result<Params, TaskError> {
        let missing = |id: &ParamId| is_needed(*id) && self.params.get(*id).is_none();
        let Some(id) = ParamId::all().into_iter().find(missing) else {
            return Ok(self.params);
        };
        let why = self.troubles.into_iter().next();
        Err(TaskError::NotRead {
            id,
            why: why.unwrap_or(RequestError::LinkLost),
        })
    }
}

/// Reads all rows, group by group; `on_read` receives each group as it arrives.
pub async fn rows(hand: &LinkHandle, mut on_read: impl FnMut(Span, &[u8])) -> ReadRows {
    let mut rows = ReadRows::default();
    for span in SPANS {
        match group(hand, span).await {
            Ok(bytes) => {
                rows.params.apply(span, &bytes);
                on_read(span, &bytes);
            }
            Err(error) => rows.troubles.push(error),
        }
    }
    rows
}

/// Reads a span of memory, with retries where they may help.
///
/// # Errors
/// The link's error at the last attempt.
pub async fn group(hand: &LinkHandle, span: Span) -> Result<Vec<u8>, RequestError> {
    let (mut tries, mut waits) = (TRIES, WAITS);
    loop {
        match hand.read(span).await {
            Ok(bytes) => return Ok(bytes),
            Err(error @ (RequestError::Refused { .. } | RequestError::TooLong { .. })) => {
                return Err(error);
            }
            // Nothing was sent, so this does not count as an attempt.
            Err(RequestError::Ambiguous { wait_s, .. }) if waits > 0 => {
                waits -= 1;
                sleep(Duration::from_secs(wait_s)).await;
                continue;
            }
            Err(error @ RequestError::Ambiguous { .. }) => return Err(error),
            Err(error) if tries <= 1 => return Err(error),
            Err(error) => {
                tries -= 1;
                sleep(RETRY_DELAY).await;
                if !answers(hand, REACH_TIMEOUT).await {
                    return Err(error);
                }
            }
        }
    }
}
