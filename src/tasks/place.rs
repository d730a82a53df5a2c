//! A change of what a hand is found by, so that nobody is left with a hand they cannot reach: backup, look whether the new place
//! is free, write, look at both places, let the user keep it or take it back, and save it if they want.

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
use crate::tasks::{TaskError, read};
use futures::future::BoxFuture;
use std::path::PathBuf;
use std::time::Duration;
use tokio::time::timeout;

/// The user has this long to say that the hand is where it should be.
pub const CONFIRM_TIMEOUT: Duration = Duration::from_secs(15);
/// Rounds of looking for a hand: one that changes its speed may need a moment.
const ROUNDS: u8 = 3;

/// What is to be changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceChange {
    /// Parameter that holds the place: id, serial speed or address.
    pub id: ParamId,
    /// Value before the change.
    pub before: Value,
    /// What it is to hold.
    pub wanted: Value,
    /// Where the hand is found before and after.
    pub places: PlacePair,
    /// Whether this wire finds the hand by it, and the change may act at once.
    pub is_followed: bool,
}

/// What the user decides. Neither is waited for before the hand was found again.
pub struct Decisions {
    /// Whether the change stays; false takes it back.
    pub keeps: BoxFuture<'static, bool>,
    /// Whether a change that stays goes into flash.
    pub saves: BoxFuture<'static, bool>,
}

/// What is told on the way.
#[derive(Debug, Clone, PartialEq)]
pub enum PlaceStep {
    /// Its parameters are read and kept in a file.
    BackingUp,
    /// What the hand holds, once it is kept.
    BackedUp(PathBuf, Params),
    /// The hand, or another one, is looked for there.
    Looking(WhichPlace),
    /// The value is written there.
    Writing(WhichPlace),
    /// There, or held and waiting for power: the user says whether it stays, within [`CONFIRM_TIMEOUT`].
    Keeping(WhichPlace),
    /// The old value is being written back.
    Returning,
    /// Kept: the user says whether it goes into flash.
    Offering(WhichPlace),
    /// SAVE is under way.
    Saving(WhichPlace),
}

/// Where the hand is after the change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PlaceEnd {
    /// The hand was not reached for the write, or was not known to rest. Nothing was written.
    NotWritten,
    /// Another hand answers at the new place. Nothing was written.
    Occupied,
    /// The hand said no, or did not take it, and is where it was.
    NotTaken {
        /// Why, if the hand said no.
        reason: Option<Refusal>,
    },
    /// It was taken back: the hand is as it was before.
    Back,
    /// It could not be taken back: the hand is there and holds the new value.
    NotBack(WhichPlace),
    /// Kept; with what is known of flash, if SAVE was asked for.
    Kept {
        /// Where the hand answers now.
        at: WhichPlace,
        /// Result of SAVE; `None` if it was not sent.
        saved: Option<Saved>,
    },
    /// Kept, and SAVE went out where it was; since then no hand answers at either place.
    Unseen(Saved),
    /// No hand answers at either place.
    Nowhere,
}

impl PlaceEnd {
    /// Where the hand is; `None` = nobody knows.
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
    /// What the hand held before.
    pub backup: PathBuf,
    /// Where the write sent the hand; `None` if there was none.
    pub moved: Option<Moved>,
    /// Where the hand is after the change.
    pub end: PlaceEnd,
    /// Why the files of the hand could not be kept up, if they could not.
    pub not_noted: Option<String>,
}

/// Changes it.
///
/// # Errors
/// [`TaskError`]: then nothing was written.
pub async fn change_place<R: Reach>(
    reach: &mut R,
    change: &PlaceChange,
    backups: &Backups,
    decisions: Decisions,
    mut notify: impl FnMut(PlaceStep),
) -> Result<PlaceReport, TaskError> {
    notify(PlaceStep::BackingUp);
    let hand = reach.reach(&change.places.old).await;
    let hand = hand.ok_or(TaskError::NotReached)?;
    let params = read::rows(&hand, |_, _| ()).await.with(|_| true)?;
    drop(hand);
    // What the user was shown may be older: what the hand holds now is what it gets back.
    let change = &PlaceChange {
        before: params.get(change.id).unwrap_or(change.before),
        ..change.clone()
    };
    let backup = back_up(backups, &params, "before apply").await?;
    notify(PlaceStep::BackedUp(backup.clone(), params.clone()));
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
        Some(Moved::There) => run.decide(WhichPlace::New, params, decisions).await,
        Some(Moved::Waits) => run.decide(WhichPlace::Old, params, decisions).await,
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
    /// What the hand held where it was looked for last, if it answered.
    seen: Option<Value>,
    not_noted: Option<String>,
}

impl<R: Reach, T: FnMut(PlaceStep)> ChangeRun<'_, R, T> {
    /// What a hand that answers there holds in the row; `None` if nobody does.
    async fn holds(&mut self, at: WhichPlace) -> Option<Value> {
        (self.notify)(PlaceStep::Looking(at));
        self.seen = None;
        let hand = self.reach.reach(self.change.places.endpoint(at)).await?;
        let span = span_of(self.change.id);
        let bytes = read::group(&hand, span).await.ok()?;
        self.seen = decoded(self.change.id, span, &bytes);
        self.seen
    }

    /// Writes a value where the hand is and looks where it answers then; `None` if nothing could be written.
    async fn go(&mut self, from: WhichPlace, value: Value) -> Option<Moved> {
        // Back at its old place, a value is only put back.
        let is_back_there = from == WhichPlace::Old && value == self.change.before;
        let follows = self.change.is_followed && !is_back_there;
        // A new id may be another hand's; a hand of another serial speed cannot be heard here.
        let may_be_taken = follows && self.change.id == ParamId::HandId;
        if may_be_taken && self.holds(from.other()).await.is_some() {
            return Some(Moved::Occupied);
        }
        (self.notify)(PlaceStep::Writing(from));
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

    /// The hand answers: the user keeps the change, or it is taken back.
    async fn decide(&mut self, at: WhichPlace, params: Params, decisions: Decisions) -> PlaceEnd {
        (self.notify)(PlaceStep::Keeping(at));
        let keeps = timeout(CONFIRM_TIMEOUT, decisions.keeps).await;
        if !keeps.unwrap_or(false) {
            (self.notify)(PlaceStep::Returning);
            return self.revert(at).await;
        }
        if at == WhichPlace::New {
            self.adopt(WhichPlace::New, WhichPlace::Old).await;
        }
        (self.notify)(PlaceStep::Offering(at));
        if decisions.saves.await {
            self.save(at, params).await
        } else {
            PlaceEnd::Kept { at, saved: None }
        }
    }

    /// What is known of the hand at one place is found at another too.
    async fn adopt(&mut self, to: WhichPlace, from: WhichPlace) {
        let places = &self.change.places;
        let former = self.backups.beside(places.endpoint(from));
        let there = self.backups.beside(places.endpoint(to));
        if let Err(error) = on_thread(move || there.adopt(&former)).await {
            self.not_noted.get_or_insert(error.to_string());
        }
    }

    /// Finds the hand and gives it back what it held.
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
            // At a place of its own, or held where it is: both is as before.
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
        let ended = save_noted(&hand, &there, &params, || notify(PlaceStep::Saving(at))).await;
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
        // Once it is switched off and on the hand may be at the other place.
        if !(at == WhichPlace::New && saved == Saved::Confirmed) {
            self.adopt(at.other(), at).await;
        }
        // Some hands let a new id or speed act at SAVE.
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

/// When a change that waits for the user is taken back, if the question was asked at this moment.
pub fn taken_back_at(asked: Moment) -> Moment {
    asked.plus(CONFIRM_TIMEOUT)
}
