//! A change of what a hand is found by, from the question to the end: go there, keep it or go back, save it. Pure: moments and
//! answers come in, the next step comes out. Where the hand went is decided in [`guard`](crate::app::params::guard).

use crate::app::params::guard::{Guard, Moved, Place, Step};
use crate::app::params::table::{ParamId, Value};
use crate::hand::Moment;
use crate::link::Saved;
use std::time::Duration;

/// A person has this long to say that the hand is where it should be.
pub const KEEP_WITHIN: Duration = Duration::from_secs(15);
/// Rounds of looking where the hand is before it is taken back.
const ROUNDS: u8 = 3;

/// What is to be done now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// Look for a hand there, and read what it holds.
    Look(Place),
    /// Write this where the hand is.
    Write(Place, Value),
    /// SAVE, where the hand is.
    Save(Place),
    /// A person decides.
    Person,
    /// Nothing more.
    Nothing,
}

/// How it ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// A person said no, or the hand was not reached for the write. Nothing was written.
    NotWritten,
    /// Another hand answers at the new place. Nothing was written.
    Occupied,
    /// The hand said no, or did not take it, and is where it was.
    NotTaken {
        /// The protocol's word for it, if the hand said no.
        reason: Option<String>,
    },
    /// It was taken back: the hand is as it was before.
    Back,
    /// It could not be taken back: the hand is there and holds the new value.
    NotBack(Place),
    /// Kept; with what is known of flash, if SAVE was asked for.
    Kept {
        /// Where the hand answers now.
        at: Place,
        /// What came of SAVE.
        saved: Option<Saved>,
    },
    /// Kept, and SAVE went out where it was; since then no hand answers at either place.
    Unseen(Saved),
    /// No hand answers at either place.
    Nowhere,
}

impl End {
    /// Where the hand is; `None` = nobody knows.
    #[must_use]
    pub const fn place(&self) -> Option<Place> {
        match self {
            Self::NotWritten | Self::Occupied | Self::NotTaken { .. } | Self::Back => {
                Some(Place::Old)
            }
            Self::NotBack(at) | Self::Kept { at, .. } => Some(*at),
            Self::Unseen(_) | Self::Nowhere => None,
        }
    }
}

/// Where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stage {
    /// A person is asked.
    Asking,
    /// On the way to the new place.
    Going(Guard),
    /// There, or held and waiting for power: a person says whether it stays.
    Keeping {
        /// Where the hand answers.
        at: Place,
        /// When it is taken back by itself.
        until: Moment,
    },
    /// Kept: a person says whether it goes into flash.
    Offering(Place),
    /// SAVE is under way.
    Saving(Place),
    /// SAVE may have made the change act: where is the hand.
    Locating {
        /// Where it is looked for.
        at: Place,
        /// What came of SAVE.
        saved: Saved,
        /// Rounds left.
        rounds: u8,
    },
    /// Where is the hand, before it is taken back.
    Finding {
        /// Where it is looked for.
        at: Place,
        /// Where it answered last.
        last: Place,
        /// Rounds left.
        rounds: u8,
    },
    /// On the way back from there.
    Returning(Guard, Place),
    /// It is over.
    Over(End),
}

/// One change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// Which row.
    pub id: ParamId,
    /// What it held.
    pub before: Value,
    /// What it is to hold.
    pub wanted: Value,
    /// Whether this wire finds the hand by it, and the change may act at once.
    is_followed: bool,
    stage: Stage,
}

impl Change {
    /// Asks first. `is_followed` is whether this wire finds the hand at its new place.
    #[must_use]
    pub const fn new(id: ParamId, before: Value, wanted: Value, follow: Follow) -> Self {
        Self {
            id,
            before,
            wanted,
            is_followed: matches!(follow, Follow::Wire),
            stage: Stage::Asking,
        }
    }

    /// Where it stands.
    #[must_use]
    pub const fn stage(&self) -> &Stage {
        &self.stage
    }

    /// What is to be done now.
    #[must_use]
    pub const fn next(&self) -> Next {
        match &self.stage {
            Stage::Asking | Stage::Keeping { .. } | Stage::Offering(_) => Next::Person,
            Stage::Going(guard) => match guard.step() {
                Step::Look(place) => Next::Look(*place),
                Step::Write => Next::Write(Place::Old, self.wanted),
                Step::Over(_) => Next::Nothing,
            },
            Stage::Finding { at, .. } | Stage::Locating { at, .. } => Next::Look(*at),
            Stage::Returning(guard, from) => match guard.step() {
                Step::Look(Place::Old) => Next::Look(*from),
                Step::Look(Place::New) => Next::Look(Place::Old),
                Step::Write => Next::Write(*from, self.before),
                Step::Over(_) => Next::Nothing,
            },
            Stage::Saving(at) => Next::Save(*at),
            Stage::Over(_) => Next::Nothing,
        }
    }

    /// A person said yes.
    pub fn begin(&mut self) {
        if self.stage == Stage::Asking {
            self.stage = Stage::Going(self.guard(self.wanted));
        }
    }

    /// A person said no, before anything was written.
    pub fn cancel(&mut self) {
        if self.stage == Stage::Asking {
            self.stage = Stage::Over(End::NotWritten);
        }
    }

    /// A person keeps it.
    pub fn keep(&mut self) {
        if let Stage::Keeping { at, .. } = self.stage {
            self.stage = Stage::Offering(at);
        }
    }

    /// A person takes it back, or time does.
    pub fn go_back(&mut self) {
        if let Stage::Keeping { at, .. } = self.stage {
            self.stage = Stage::Finding {
                at,
                last: at,
                rounds: ROUNDS,
            };
        }
    }

    /// A person wants it in flash.
    pub fn save(&mut self) {
        if let Stage::Offering(at) = self.stage {
            self.stage = Stage::Saving(at);
        }
    }

    /// A person wants it only until the hand is switched off.
    pub fn leave_unsaved(&mut self) {
        if let Stage::Offering(at) = self.stage {
            self.stage = Stage::Over(End::Kept { at, saved: None });
        }
    }

    /// Time goes by.
    pub fn tick(&mut self, now: Moment) {
        if matches!(self.stage, Stage::Keeping { until, .. } if until <= now) {
            self.go_back();
        }
    }

    /// The hand was not reached where the write was to go: nothing was written.
    pub fn unreached(&mut self) {
        self.stage = match &self.stage {
            Stage::Going(_) => Stage::Over(End::NotWritten),
            Stage::Returning(_, from) => Stage::Finding {
                at: *from,
                last: *from,
                rounds: ROUNDS,
            },
            Stage::Saving(at) => Stage::Over(End::Kept {
                at: *at,
                saved: None,
            }),
            _ => return,
        };
    }

    /// The write went out; with a reason if it was refused.
    pub fn wrote(&mut self, refused: Option<String>) {
        if let Stage::Going(guard) | Stage::Returning(guard, _) = &mut self.stage {
            guard.wrote(refused);
        }
    }

    /// Someone answers where was looked, and holds this; or nobody does.
    pub fn heard(&mut self, holds: Option<Value>, now: Moment) {
        let next = match &mut self.stage {
            Stage::Going(guard) => {
                guard.heard(holds);
                match went(guard.step(), now) {
                    // A third value: it is where it was, and would be lost once somebody saves.
                    Some(Stage::Over(End::NotTaken { .. }))
                        if holds.is_some_and(|holds| holds != self.before) =>
                    {
                        Some(Stage::Returning(self.way_back(Place::Old), Place::Old))
                    }
                    other => other,
                }
            }
            Stage::Finding { at, last, rounds } => match holds {
                Some(holds) if holds == self.before => Some(Stage::Over(End::Back)),
                Some(_) => {
                    let from = *at;
                    Some(Stage::Returning(self.way_back(from), from))
                }
                None if at == last && self.is_followed => {
                    *at = at.other();
                    None
                }
                None if *rounds > 1 => {
                    (*at, *rounds) = (*last, *rounds - 1);
                    None
                }
                None => Some(Stage::Over(End::Nowhere)),
            },
            Stage::Locating { at, saved, rounds } => match holds {
                Some(_) => {
                    let (at, saved) = (*at, Some(saved.clone()));
                    Some(Stage::Over(End::Kept { at, saved }))
                }
                None if *at == Place::New && *rounds == 1 => {
                    Some(Stage::Over(End::Unseen(saved.clone())))
                }
                None => {
                    *rounds -= u8::from(*at == Place::New);
                    *at = at.other();
                    None
                }
            },
            Stage::Returning(guard, from) => {
                guard.heard(holds);
                let from = *from;
                came_back(guard.step(), from).map(Stage::Over)
            }
            _ => None,
        };
        self.stage = next.unwrap_or_else(|| self.stage.clone());
    }

    /// SAVE came to its end.
    pub fn saved(&mut self, saved: Saved) {
        let Stage::Saving(at) = self.stage else {
            return;
        };
        self.stage = match saved {
            // Some hands let a new id or speed act at SAVE.
            Saved::Confirmed | Saved::ReadBack | Saved::Unknown { .. }
                if at == Place::Old && self.is_followed =>
            {
                let rounds = ROUNDS;
                Stage::Locating { at, saved, rounds }
            }
            saved => {
                let saved = Some(saved);
                Stage::Over(End::Kept { at, saved })
            }
        };
    }

    const fn guard(&self, wanted: Value) -> Guard {
        if self.is_followed {
            Guard::new(self.id, wanted)
        } else {
            Guard::staying(wanted)
        }
    }

    /// From the new place the old one is the new one; at the old place the value is only put back.
    const fn way_back(&self, from: Place) -> Guard {
        match from {
            Place::New => self.guard(self.before),
            Place::Old => Guard::staying(self.before),
        }
    }
}

/// Whether the hand can be looked for at its new place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Follow {
    /// Over this wire.
    Wire,
    /// Not before the next power-up, or not by this.
    No,
}

fn went(step: &Step, now: Moment) -> Option<Stage> {
    let Step::Over(moved) = step else {
        return None;
    };
    let until = now.plus(KEEP_WITHIN);
    Some(match moved {
        Moved::There => Stage::Keeping {
            at: Place::New,
            until,
        },
        Moved::Waits => Stage::Keeping {
            at: Place::Old,
            until,
        },
        Moved::Occupied => Stage::Over(End::Occupied),
        Moved::Stayed => Stage::Over(End::NotTaken { reason: None }),
        Moved::Refused { reason } => Stage::Over(End::NotTaken {
            reason: Some(reason.clone()),
        }),
        Moved::Nowhere => Stage::Over(End::Nowhere),
    })
}

fn came_back(step: &Step, from: Place) -> Option<End> {
    let Step::Over(moved) = step else {
        return None;
    };
    Some(match moved {
        // At a place of its own, or held where it is: both is as before.
        Moved::There | Moved::Waits => End::Back,
        Moved::Occupied | Moved::Stayed | Moved::Refused { .. } => End::NotBack(from),
        Moved::Nowhere => End::Nowhere,
    })
}
