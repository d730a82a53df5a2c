//! A change of the address of a hand (id, serial speed or IP address) that cannot leave it unreachable: backup, check that the new
//! address is free, write, search at both addresses, let the user keep or revert the change, and save it on request.

use crate::hand::{Moment, Refusal};
use crate::link::RequestError;
use crate::params::backups::Backups;
use crate::params::place::{Moved, PlacePair, WhichPlace, setting};
use crate::params::rows::{ParamId, Value};
use crate::params::values::{Params, decoded, span_of};
use crate::record::Saved;
use crate::store::on_thread;
use crate::tasks::hand::{Reach, rests};
use crate::tasks::save::{back_up, save_noted};
use crate::tasks::{Question, TaskError, TaskStep, User, read};
use std::path::PathBuf;
use std::time::Duration;
use tokio::time::timeout;

/// Time within which the user has to confirm that the hand works at its new address.
pub const CONFIRM_TIMEOUT: Duration = Duration::from_secs(15);
/// Rounds of the search for a hand: one that changes its serial speed may need a moment.
const ROUNDS: u8 = 3;

/// The requested change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceChange {
    /// Parameter that holds the address: id, serial speed or IP address.
    pub id: ParamId,
    /// Value before the change.
    pub before: Value,
    /// Requested value.
    pub wanted: Value,
    /// Endpoints of the hand before and after.
    pub places: PlacePair,
    /// True if this wire addresses the hand by the parameter, and the change may act at once.
    pub is_followed: bool,
}

/// Outcome of the change, with the address of the hand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PlaceEnd {
    /// The hand was not reached for the write, or was not known to rest. Nothing was written.
    NotWritten,
    /// Another hand answers at the new address. Nothing was written.
    Occupied,
    /// The hand refused or ignored the value, and is at its previous address.
    NotTaken {
        /// Reason, if the hand refused it.
        reason: Option<Refusal>,
    },
    /// The change was reverted: the hand is as it was before.
    Back,
    /// The change could not be reverted: the hand is at this address and holds the new value.
    NotBack(WhichPlace),
    /// Kept; with the result of SAVE, if that was requested.
    Kept {
        /// Address at which the hand answers now.
        at: WhichPlace,
        /// Result of SAVE; `None` if it was not sent.
        saved: Option<Saved>,
    },
    /// Kept, and SAVE was sent to the previous address; since then no hand answers at either address.
    Unseen(Saved),
    /// No hand answers at either address.
    Nowhere,
}

impl PlaceEnd {
    /// Address of the hand; `None` if it is not known.
    pub const fn place(&self) -> Option<WhichPlace> {
        match self {
            Self::NotWritten | Self::Occupied | Self::NotTaken { .. } | Self::Back => {
                Some(WhichPlace::Old)
            }
            Self::NotBack(at) | Self::Kept { at, .. } => Some(*at),
            Self::Unseen(_) | Self::Nowhere => None,
        }
    }
}

/// Outcome of a change of id, serial speed or address.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceReport {
    /// Backup of the previous parameters.
    pub backup: PathBuf,
    /// Effect of the write; `None` if nothing was written.
    pub moved: Option<Moved>,
    /// Outcome, with the address of the hand.
    pub end: PlaceEnd,
    /// Error if the files of the hand could not be updated.
    pub not_noted: Option<String>,
}

/// Changes the address of a hand.
///
/// # Errors
/// [`TaskError`]: nothing was written.
pub async fn change_place<R: Reach>(
    reach: &mut R,
    change: &PlaceChange,
    backups: &Backups,
    user: &mut impl User,
    mut notify: impl FnMut(TaskStep),
) -> Result<PlaceReport, TaskError> {
    notify(TaskStep::BackingUp);
    let hand = reach.reach(&change.places.old).await;
    let hand = hand.ok_or(TaskError::NotReached)?;
    let params = read::rows(&hand, |_, _| ()).await.with(|_| true)?;
    drop(hand);
    // The value shown to the user may be outdated: a revert restores the value read now.
    let change = &PlaceChange {
        before: params.get(change.id).unwrap_or(change.before),
        ..change.clone()
    };
    let backup = back_up(backups, &params, "before apply").await?;
    notify(TaskStep::BackedUp(backup.clone(), params.clone()));
    let mut run = ChangeRun {
        reach,
        change,
        backups,
        notify: &mut notify,
        seen: None,
        not_noted: None,
    };
    let moved = run.go(WhichPlace::Old, change.wanted).await;
    let end = match &moved {
        None => PlaceEnd::NotWritten,
        Some(Moved::Occupied) => PlaceEnd::Occupied,
        Some(Moved::Nowhere) => PlaceEnd::Nowhere,
        Some(Moved::Stayed | Moved::Refused { .. }) if run.seen != Some(change.before) => {
            run.bring_back(WhichPlace::Old).await
        }
        Some(Moved::Stayed) => PlaceEnd::NotTaken { reason: None },
        Some(Moved::Refused { reason }) => PlaceEnd::NotTaken {
            reason: Some(*reason),
        },
        Some(Moved::There) => run.decide(WhichPlace::New, params, user).await,
        Some(Moved::Waits) => run.decide(WhichPlace::Old, params, user).await,
    };
    Ok(PlaceReport {
        backup,
        moved,
        end,
        not_noted: run.not_noted,
    })
}

struct ChangeRun<'a, R, T> {
    reach: &'a mut R,
    change: &'a PlaceChange,
    backups: &'a Backups,
    notify: &'a mut T,
    /// Value read in the last search; `None` if the hand did not answer.
    seen: Option<Value>,
    not_noted: Option<String>,
}

impl<R: Reach, T: FnMut(TaskStep)> ChangeRun<'_, R, T> {
    /// Value of the row in the hand that answers at this address; `None` if none answers.
    async fn holds(&mut self, at: WhichPlace) -> Option<Value> {
        (self.notify)(TaskStep::Looking(at));
        self.seen = None;
        let hand = self.reach.reach(self.change.places.endpoint(at)).await?;
        let span = span_of(self.change.id);
        let bytes = read::group(&hand, span).await.ok()?;
        self.seen = decoded(self.change.id, span, &bytes);
        self.seen
    }

    /// Writes a value to the hand and searches for it afterwards; `None` if nothing could be written.
    async fn go(&mut self, from: WhichPlace, value: Value) -> Option<Moved> {
        // At the previous address, the previous value is only restored.
        let is_back_there = from == WhichPlace::Old && value == self.change.before;
        let follows = self.change.is_followed && !is_back_there;
        // A new id may belong to another hand; a hand with another serial speed cannot be heard here.
        let may_be_taken = follows && self.change.id == ParamId::HandId;
        if may_be_taken && self.holds(from.other()).await.is_some() {
            return Some(Moved::Occupied);
        }
        (self.notify)(TaskStep::Writing(from));
        let hand = self.reach.reach(self.change.places.endpoint(from)).await?;
        if !rests(&hand).await {
            return None;
        }
        let refused = match hand.set_unread(setting(self.change.id, value)?).await {
            Err(RequestError::Refused { reason, .. }) => Some(reason),
            Err(
                RequestError::NotConnected | RequestError::NotNow(_) | RequestError::Full { .. },
            ) => return None,
            // A missing answer proves nothing.
            Ok(()) | Err(_) => None,
        };
        drop(hand);
        for round in 0..ROUNDS {
            let may_be_there = follows && (round > 0 || refused.is_none());
            if may_be_there && self.holds(from.other()).await.is_some() {
                return Some(Moved::There);
            }
            match self.holds(from).await {
                Some(holds) if holds == value => return Some(Moved::Waits),
                Some(_) => {
                    let stayed = refused.map(|reason| Moved::Refused { reason });
                    return Some(stayed.unwrap_or(Moved::Stayed));
                }
                None => {}
            }
        }
        Some(Moved::Nowhere)
    }

    /// The hand answers: the user keeps the change, or it is reverted.
    async fn decide(&mut self, at: WhichPlace, params: Params, user: &mut impl User) -> PlaceEnd {
        let keeps = timeout(CONFIRM_TIMEOUT, user.ask(Question::KeepPlace(at))).await;
        if !keeps.unwrap_or(false) {
            (self.notify)(TaskStep::Returning);
            return self.revert(at).await;
        }
        if at == WhichPlace::New {
            self.adopt(WhichPlace::New, WhichPlace::Old).await;
        }
        (self.notify)(TaskStep::Kept(at));
        if user.ask(Question::SavePlace(at)).await {
            self.save(at, params).await
        } else {
            PlaceEnd::Kept { at, saved: None }
        }
    }

    /// Copies the stored files of the hand to its other endpoint.
    async fn adopt(&mut self, to: WhichPlace, from: WhichPlace) {
        let places = &self.change.places;
        let former = self.backups.beside(places.endpoint(from));
        let there = self.backups.beside(places.endpoint(to));
        if let Err(error) = on_thread(move || there.adopt(&former)).await {
            self.not_noted.get_or_insert(error.to_string());
        }
    }

    /// Finds the hand and restores its previous value.
    async fn revert(&mut self, last: WhichPlace) -> PlaceEnd {
        let mut end = PlaceEnd::Nowhere;
        for _round in 0..ROUNDS {
            end = PlaceEnd::Nowhere;
            let others = self.change.is_followed.then(|| last.other());
            for at in [last].into_iter().chain(others) {
                match self.holds(at).await {
                    Some(holds) if holds == self.change.before => return PlaceEnd::Back,
                    Some(_) => match self.bring_back(at).await {
                        PlaceEnd::NotWritten => end = PlaceEnd::NotBack(at),
                        end => return end,
                    },
                    None => {}
                }
            }
        }
        end
    }

    async fn bring_back(&mut self, from: WhichPlace) -> PlaceEnd {
        match self.go(from, self.change.before).await {
            None => PlaceEnd::NotWritten,
            // At its own address, or with the value held where it is: both restore the previous state.
            Some(Moved::There | Moved::Waits) => PlaceEnd::Back,
            Some(Moved::Occupied | Moved::Stayed | Moved::Refused { .. }) => {
                PlaceEnd::NotBack(from)
            }
            Some(Moved::Nowhere) => PlaceEnd::Nowhere,
        }
    }

    async fn save(&mut self, at: WhichPlace, mut params: Params) -> PlaceEnd {
        let unsaved = PlaceEnd::Kept { at, saved: None };
        let place = self.change.places.endpoint(at);
        let Some(hand) = self.reach.reach(place).await else {
            return unsaved;
        };
        params.put(self.change.id, self.change.wanted);
        let there = self.backups.beside(place);
        let notify = &mut self.notify;
        let ended = save_noted(&hand, &there, &params, || notify(TaskStep::Saving)).await;
        drop(hand);
        let (saved, not_noted) = match ended {
            Ok(ended) => ended,
            Err(error) => {
                self.not_noted.get_or_insert(error.to_string());
                return unsaved;
            }
        };
        if let Some(why) = not_noted {
            self.not_noted.get_or_insert(why.to_string());
        }
        // After a power cycle the hand may be at the other address.
        if !(at == WhichPlace::New && saved == Saved::Confirmed) {
            self.adopt(at.other(), at).await;
        }
        // On some hands a new id or speed takes effect at SAVE.
        let acts = matches!(
            saved,
            Saved::Confirmed | Saved::ReadBack | Saved::Unknown { .. }
        );
        if at == WhichPlace::Old && self.change.is_followed && acts {
            return self.locate(saved).await;
        }
        let saved = Some(saved);
        PlaceEnd::Kept { at, saved }
    }

    async fn locate(&mut self, saved: Saved) -> PlaceEnd {
        for _round in 0..ROUNDS {
            for at in [WhichPlace::Old, WhichPlace::New] {
                if self.holds(at).await.is_some() {
                    let saved = Some(saved);
                    return PlaceEnd::Kept { at, saved };
                }
            }
        }
        PlaceEnd::Unseen(saved)
    }
}

/// Deadline of the user's confirmation, for a question asked at this moment; then the change is reverted.
pub fn taken_back_at(asked: Moment) -> Moment {
    asked.plus(CONFIRM_TIMEOUT)
}
