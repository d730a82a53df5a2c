//! Return to the factory parameters, with a backup first, and a search for the hand's address afterwards (manual 2.6.5).

use crate::hand::Refusal;
use crate::link::RequestError;
use crate::params::backups::Backups;
use crate::params::place::{PlacePair, WhichPlace, factory_place};
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::record::{NotSent, Reset};
use crate::store::on_thread;
use crate::system::SystemError;
use crate::tasks::hand::{Reach, once_at_rest};
use crate::tasks::read::ReadRows;
use crate::tasks::save::back_up;
use crate::tasks::{TaskError, TaskStep, read};
use crate::transport::Endpoint;
use std::path::PathBuf;

/// Rounds of the search for the hand: a restart takes a few seconds.
const ROUNDS: u8 = 3;

/// Outcome of a reset, with the address of the hand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ResetEnd {
    /// It was not sent, with the link's reason.
    NotSent(Option<NotSent>),
    /// The hand refused it.
    Refused {
        /// The hand's reason.
        reason: Refusal,
    },
    /// A hand answers at one of the addresses.
    Found {
        /// Address at which it answers.
        at: WhichPlace,
        /// Its parameters, as far as they could be read.
        params: Params,
        /// Rows that were read and differ from the factory values.
        left: Vec<ParamId>,
        /// Evidence that these parameters give of the reset.
        proof: ResetProof,
    },
    /// No hand answers at either address.
    Nowhere,
}

/// Evidence of a reset in the parameters of a hand. The manual prints no factory value for speeds and forces, so for those only a
/// change is evidence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ResetProof {
    /// Read back: the rows whose factory value is known hold it, and the parameters differ from those before.
    Done,
    /// Some rows hold values other than the factory's: the hand ignored the reset, in whole or in part.
    Ignored,
    /// The parameters are unchanged, and may have been the factory's before: the hand may have ignored the reset.
    Unchanged,
    /// Not every row could be read, so the result is not known.
    NotRead(RequestError),
}

impl ResetProof {
    /// Stable name in JSON.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Ignored => "ignored",
            Self::Unchanged => "unchanged",
            Self::NotRead(_) => "not_known",
        }
    }
}

/// Outcome of a return to the factory parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResetReport {
    /// Backup of the previous parameters.
    pub backup: PathBuf,
    /// True if the hand acknowledged the reset.
    pub is_acknowledged: bool,
    /// Outcome, with the address of the hand.
    pub end: ResetEnd,
    /// Error if the files of the hand could not be updated.
    pub not_noted: Option<SystemError>,
}

/// Endpoints of a hand before and after a reset.
pub fn places(hand: &Endpoint) -> PlacePair {
    PlacePair {
        old: hand.clone(),
        new: factory_place(hand),
    }
}

/// Resets the hand to its factory parameters.
///
/// # Errors
/// [`TaskError`]: nothing was written.
pub async fn reset<R: Reach>(
    reach: &mut R,
    places: &PlacePair,
    backups: &Backups,
    mut notify: impl FnMut(TaskStep),
) -> Result<ResetReport, TaskError> {
    notify(TaskStep::BackingUp);
    let hand = reach.reach(&places.old).await;
    let hand = hand.ok_or(TaskError::NotReached)?;
    let before = read::rows(&hand, |_, _| ()).await.with(|_| true)?;
    let backup = back_up(backups, &before, "before reset").await?;
    notify(TaskStep::Resetting);
    let not_sent = |reset: &Reset| match reset {
        Reset::NotSent(why) => Some(*why),
        _ => None,
    };
    let sent = once_at_rest(|| hand.reset(), not_sent).await;
    drop(hand);
    let mut report = ResetReport {
        backup,
        is_acknowledged: matches!(sent, Ok(Reset::Acknowledged)),
        end: ResetEnd::Nowhere,
        not_noted: None,
    };
    match sent {
        Ok(Reset::NotSent(why)) => report.end = ResetEnd::NotSent(Some(why)),
        Ok(Reset::Refused { reason }) => report.end = ResetEnd::Refused { reason },
        // Without a reply the hand may have acted.
        Ok(Reset::Acknowledged | Reset::Unanswered) | Err(RequestError::LinkLost) => {
            // Regardless of the reply, flash no longer holds what was saved.
            let noting = backups.clone();
            let forgotten = on_thread(move || noting.forget_saved()).await;
            report.end = find(reach, places, &before, &mut notify).await;
            let adopted = adopt(backups, places, &report.end).await;
            report.not_noted = forgotten.and(adopted).err().map(SystemError::from);
        }
        Err(error) => return Err(error.into()),
    }
    Ok(report)
}

/// Searches at the factory's address first, then at the previous one.
async fn find<R: Reach>(
    reach: &mut R,
    places: &PlacePair,
    before: &Params,
    notify: &mut impl FnMut(TaskStep),
) -> ResetEnd {
    let mut answered = None;
    for _round in 0..ROUNDS {
        for at in [WhichPlace::New, WhichPlace::Old] {
            if at == WhichPlace::Old && places.old == places.new {
                continue;
            }
            notify(TaskStep::Looking(at));
            let Some(hand) = reach.reach(places.endpoint(at)).await else {
                continue;
            };
            let rows = read::rows(&hand, |_, _| ()).await;
            let is_read = !rows.params.is_empty();
            let end = found(rows, before, places, at);
            if is_read {
                return end;
            }
            answered = Some(end);
        }
    }
    answered.unwrap_or(ResetEnd::Nowhere)
}

/// Interprets the rows that were read from a hand at this address.
fn found(rows: ReadRows, before: &Params, places: &PlacePair, at: WhichPlace) -> ResetEnd {
    let ReadRows { params, troubles } = rows;
    let differing = params.differences(&Params::factory()).into_iter();
    let left: Vec<ParamId> = differing
        .filter(|row| row.ours.is_some())
        .map(|row| row.id)
        .collect();
    // Some of these take effect, and can be read, only after the next power-up.
    let is_there = *places.endpoint(at) != places.old;
    let may_stay = |id: &ParamId| *id == ParamId::IpAddress || id.is_place() && is_there;
    let proof = match troubles.into_iter().next_back() {
        Some(why) => ResetProof::NotRead(why),
        None if params == *before && left.is_empty() => ResetProof::Unchanged,
        None if params == *before || !left.iter().all(may_stay) => ResetProof::Ignored,
        None => ResetProof::Done,
    };
    ResetEnd::Found {
        at,
        params,
        left,
        proof,
    }
}

/// Copies the stored files of the hand to its new endpoint.
async fn adopt(backups: &Backups, places: &PlacePair, end: &ResetEnd) -> std::io::Result<()> {
    let ResetEnd::Found { at, .. } = end else {
        return Ok(());
    };
    let there = backups.beside(places.endpoint(*at));
    let former = backups.clone();
    on_thread(move || there.adopt(&former)).await
}
