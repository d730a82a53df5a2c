//! Back to the factory's parameters, with a backup first, and where the hand answers then (manual 2.6.5).

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
use crate::tasks::{TaskError, read};
use crate::transport::Endpoint;
use std::path::PathBuf;

/// Rounds of looking for the hand: one that starts again needs a few seconds.
const ROUNDS: u8 = 3;

/// What is told on the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResetStep {
    /// Its parameters are read and kept in a file.
    BackingUp,
    /// RESET_PARA goes out.
    Sending,
    /// The hand is looked for there; the new place is the factory's.
    Looking(WhichPlace),
}

/// How the reset ended, and where the hand is now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ResetEnd {
    /// It was not sent, and why, if the link says so.
    NotSent(Option<NotSent>),
    /// The hand said no.
    Refused {
        /// The hand's reason.
        reason: Refusal,
    },
    /// A hand answers there.
    Found {
        /// Place at which it answers.
        at: WhichPlace,
        /// What it holds, as far as it could be read.
        params: Params,
        /// Rows that were read and are not as at delivery.
        left: Vec<ParamId>,
        /// What that shows of the reset.
        proof: ResetProof,
    },
    /// No hand answers at either place.
    Nowhere,
}

/// What the parameters of a hand show of a reset. The manual prints no factory value for speeds and forces, so of those only
/// a change shows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ResetProof {
    /// Read back: the rows whose factory value is known hold it, and the hand does not hold what it held before.
    Done,
    /// The hand holds other values than the factory's in some rows: it ignored the reset, as a whole or in part.
    Ignored,
    /// The hand holds what it held before, and that may have been the factory's parameters: it may have ignored the reset.
    Unchanged,
    /// Not every row could be read, so it is not known.
    NotRead(RequestError),
}

impl ResetProof {
    /// The stable name for JSON.
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
    /// What the hand held before.
    pub backup: PathBuf,
    /// Whether the hand acknowledged it.
    pub is_acknowledged: bool,
    /// How the reset ended, and where the hand is now.
    pub end: ResetEnd,
    /// Why the files of the hand could not be kept up, if they could not.
    pub not_noted: Option<SystemError>,
}

/// Where a hand is found before and after a reset.
pub fn places(hand: &Endpoint) -> PlacePair {
    PlacePair {
        old: hand.clone(),
        new: factory_place(hand),
    }
}

/// Resets.
///
/// # Errors
/// [`TaskError`]: then nothing was written.
pub async fn reset<R: Reach>(
    reach: &mut R,
    places: &PlacePair,
    backups: &Backups,
    mut notify: impl FnMut(ResetStep),
) -> Result<ResetReport, TaskError> {
    notify(ResetStep::BackingUp);
    let hand = reach.reach(&places.old).await;
    let hand = hand.ok_or(TaskError::NotReached)?;
    let before = read::rows(&hand, |_, _| ()).await.with(|_| true)?;
    let backup = back_up(backups, &before, "before reset").await?;
    notify(ResetStep::Sending);
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
        // Without an answer it may have acted.
        Ok(Reset::Acknowledged | Reset::Unanswered) | Err(RequestError::LinkLost) => {
            // Whatever the answer was: what is in flash now is not what was saved.
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

/// Looks at the factory's place first, then where the hand was.
async fn find<R: Reach>(
    reach: &mut R,
    places: &PlacePair,
    before: &Params,
    notify: &mut impl FnMut(ResetStep),
) -> ResetEnd {
    let mut answered = None;
    for _round in 0..ROUNDS {
        for at in [WhichPlace::New, WhichPlace::Old] {
            if at == WhichPlace::Old && places.old == places.new {
                continue;
            }
            notify(ResetStep::Looking(at));
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

/// What the rows show that a hand holds at this place.
fn found(rows: ReadRows, before: &Params, places: &PlacePair, at: WhichPlace) -> ResetEnd {
    let ReadRows { params, troubles } = rows;
    let differing = params.differences(&Params::factory()).into_iter();
    let left: Vec<ParamId> = differing
        .filter(|row| row.ours.is_some())
        .map(|row| row.id)
        .collect();
    // Some of these act, and are shown, only after the next power-up.
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

/// What is known of the hand is found at its new place too.
async fn adopt(backups: &Backups, places: &PlacePair, end: &ResetEnd) -> std::io::Result<()> {
    let ResetEnd::Found { at, .. } = end else {
        return Ok(());
    };
    let there = backups.beside(places.endpoint(*at));
    let former = backups.clone();
    on_thread(move || there.adopt(&former)).await
}
