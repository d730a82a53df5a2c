//! The cards of procedures that need confirmation: a change of the hand's address, and a factory reset of its parameters. The
//! text for each state, and its buttons.

use crate::app::action::Action;
use crate::app::procedures::{
    PlaceProcedure, Procedure, ProcedureAction, ProcedureStage, ResetProcedure,
};
use crate::app::state::State;
use crate::hand::Moment;
use crate::params::place::{PlacePair, WhichPlace};
use crate::params::rows::ParamId;
use crate::record::Saved;
use crate::tasks::place::{CONFIRM_TIMEOUT, PlaceChange, PlaceEnd, PlaceReport, taken_back_at};
use crate::tasks::reset::{ResetEnd, ResetProof, ResetReport};
use crate::tasks::{Question, TaskError, TaskStep};
use crate::transport::Endpoint;
use crate::ui::kit::{ButtonRole, Card, CardButton, Look};
use crate::ui::params::calibration;
use crate::ui::params::card as device_card;
use crate::ui::params::choices::{answer, asking, close, step};
use crate::ui::params::table::value_text;
use crate::ui::text::{Text, cards, device, errors, main};
use std::path::Path;

/// The word that a factory reset requires to be typed, in every language.
pub(crate) const RESET_WORD: &str = "RESET";

/// Card of the procedure in progress, if there is one.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    Some(match state.hand().procedures.card.as_ref()? {
        Procedure::Calibrate(run) => calibration::card(state, look, run),
        Procedure::Place(run) => place_card(state, look, run),
        Procedure::Reset(run) => reset_card(state, look, run),
    })
}

/// Adds the reason why nothing was written.
fn not_begun(look: Look, card: Card, error: &TaskError) -> Card {
    let card = match error {
        TaskError::NoBackup(why) => card
            .warning(cards::NO_BACKUP)
            .note(errors::backup(look, why)),
        TaskError::NotRead { .. } => {
            let why = errors::task(look, error);
            card.warning(cards::NO_BACKUP).note(why)
        }
        _ => card.warning(cards::OVER_NOT_WRITTEN),
    };
    card.choice(close())
}

/// Old and new value of a change.
fn from_to(look: Look, change: &PlaceChange) -> String {
    let (from, to) = (change.before, change.wanted);
    let [from, to] = [from, to].map(|value| value_text(change.id, Some(value)));
    let name = look.tr(device::name(change.id));
    look.pair(name, &format!("{from} -> {to}"))
}

/// Adds the hand's current address, and its future one if that differs.
fn now_and_then(card: Card, places: &PlacePair) -> Card {
    let card = card.note((cards::NOW_AT, &places.old));
    if places.new == places.old {
        card
    } else {
        card.note((cards::THEN_AT, &places.new))
    }
}

fn confirm_change(state: &State, look: Look, run: &PlaceProcedure) -> Card {
    let (change, places) = (&run.change, &run.change.places);
    let card = Card::new(look, cards::CHANGE_ASKED).words(from_to(look, change));
    let mut card = now_and_then(card, places);
    if change.id == ParamId::IpAddress {
        card = card.warning(cards::SAME_NETWORK);
    }
    let card = card.words(match change.id {
        ParamId::IpAddress => cards::POWERED,
        _ if places.new == places.old => cards::POWERED,
        _ => cards::FOLLOWED,
    });
    asking(state, card, begin(cards::CHANGE))
}

/// The button that begins an irreversible step.
fn begin(text: Text) -> CardButton {
    step(text, ButtonRole::Danger, ProcedureAction::Begin)
}

fn place_card(state: &State, look: Look, run: &PlaceProcedure) -> Card {
    let change = &run.change;
    let places = &change.places;
    let card = Card::new(look, cards::CHANGING);
    match run.question() {
        Some((Question::KeepPlace(place), since)) => {
            return keep_card(state, change, *place, since);
        }
        Some((question, _)) => return offer_card(look, run, question),
        None => {}
    }
    match &run.stage {
        ProcedureStage::Asking => confirm_change(state, look, run),
        ProcedureStage::Over(Ok(report)) => change_over(look, card, places, report),
        ProcedureStage::Over(Err(error)) => not_begun(look, card, error),
        ProcedureStage::Doing(step, _) => progress(look, card, step, places),
    }
}

/// The card of a task in progress.
fn progress(look: Look, card: Card, step: &TaskStep, places: &PlacePair) -> Card {
    match step {
        TaskStep::Looking(place) => card.progress(0.6, (cards::LOOKING, places.endpoint(*place))),
        TaskStep::Writing(place) => card.progress(0.4, (cards::WRITING, places.endpoint(*place))),
        TaskStep::Resetting => card.progress(0.4, cards::RESET_SENDING),
        TaskStep::Returning => Card::new(look, cards::GOING_BACK).progress(0.9, String::new()),
        TaskStep::Kept(_) | TaskStep::Saving => {
            Card::new(look, cards::OFFER_TITLE).progress(0.8, device::SAVING)
        }
        TaskStep::BackingUp
        | TaskStep::BackedUp(..)
        | TaskStep::Read(..)
        | TaskStep::Row(_)
        | TaskStep::Calibrating
        | TaskStep::Measuring => card.progress(0.1, device::BACKING_UP),
    }
}

fn keep_card(state: &State, change: &PlaceChange, place: WhichPlace, since: Moment) -> Card {
    let look = Look::of(state);
    let seconds = taken_back_at(since).since(state.now).as_secs_f32();
    let part = seconds / CONFIRM_TIMEOUT.as_secs_f32();
    let left = format!("{:.0} s", seconds.ceil());
    let lost = (!state.hand().connection.status.state.is_live()).then_some(main::REFUSED_OFFLINE);
    let question = Question::KeepPlace(place);
    let keep = answer(cards::KEEP, ButtonRole::Main, &question, true);
    let back = answer(cards::GO_BACK, ButtonRole::Plain, &question, false);
    Card::new(look, cards::KEEP_TITLE)
        .words(from_to(look, change))
        .words(match place {
            WhichPlace::New => cards::KEEP_THERE,
            WhichPlace::Old => cards::KEEP_WAITS,
        })
        .note((cards::NOW_AT, change.places.endpoint(place)))
        .progress(part, (cards::GOES_BACK_IN, left))
        .choice(back)
        .choice(keep.disabled(lost))
}

fn offer_card(look: Look, run: &PlaceProcedure, question: &Question) -> Card {
    let mut card =
        Card::new(look, cards::OFFER_TITLE).words((cards::OFFER, &run.change.places.old));
    let (mut text, mut role) = (cards::SAVE, ButtonRole::Main);
    if !run.dangers.is_empty() {
        card = device_card::dangers(look, card.words(cards::OFFER_ALL), &run.dangers);
        (text, role) = (device::AGREE_SAVE, ButtonRole::Danger);
    }
    card.choice(answer(cards::UNSAVED, ButtonRole::Safe, question, false))
        .choice(answer(text, role, question, true))
}

fn change_over(look: Look, card: Card, places: &PlacePair, report: &PlaceReport) -> Card {
    let now_at = (cards::NOW_AT, &places.old);
    let card = card.choice(close());
    match &report.end {
        PlaceEnd::NotWritten => card.words(cards::OVER_NOT_WRITTEN).note(now_at),
        PlaceEnd::Occupied => card
            .warning(cards::OVER_OCCUPIED)
            .note(places.new.to_string())
            .note(now_at),
        PlaceEnd::NotTaken { reason } => {
            let card = card.warning(cards::OVER_NOT_TAKEN);
            let reason = reason.map(|reason| errors::reason(look, reason));
            reason.into_iter().fold(card, Card::note)
        }
        PlaceEnd::Back => card.words(cards::OVER_BACK).note(now_at),
        PlaceEnd::NotBack(place) => {
            let card = card.warning((cards::OVER_NOT_BACK, places.endpoint(*place)));
            backup(card.words(cards::OVER_NOT_BACK_POWER), &report.backup)
        }
        PlaceEnd::Unseen(saved) => {
            let card = both(ways(card, places).warning(cards::OVER_UNSEEN), places);
            let card = match saved {
                Saved::Unknown { .. } => card,
                saved => save_end(look, card, places, Some(saved)),
            };
            backup(card, &report.backup)
        }
        PlaceEnd::Nowhere => {
            let card = ways(card, places).warning(cards::OVER_NOWHERE);
            backup(card.note(now_at), &report.backup)
        }
        PlaceEnd::Kept { at: place, saved } => {
            let card = card.words((cards::OVER_KEPT, places.endpoint(*place)));
            let mut card = save_end(look, card, places, saved.as_ref());
            let is_saved = saved.as_ref().is_some_and(Saved::may_be_in_flash);
            if is_saved && places.new != places.old {
                if *place == WhichPlace::Old {
                    card = card.words((cards::OVER_WAITS, &places.new));
                }
                card = ways(card, places);
            }
            backup(card, &report.backup)
        }
    }
}

/// Adds the state of the flash after a change was confirmed.
fn save_end(look: Look, card: Card, places: &PlacePair, saved: Option<&Saved>) -> Card {
    match saved {
        None => card.words(cards::OVER_UNSAVED),
        Some(Saved::Unknown { .. }) => both(card.warning(cards::SAVED_UNKNOWN), places),
        Some(saved) => card.words(device::saved(look, saved)),
    }
}

/// Adds both possible addresses of the hand.
fn both(card: Card, places: &PlacePair) -> Card {
    card.note(places.old.to_string())
        .note(places.new.to_string())
}

fn backup(card: Card, backup: &Path) -> Card {
    card.note((cards::BACKUP, backup.display()))
}

/// Adds buttons that connect to each possible address of the hand.
fn ways(card: Card, places: &PlacePair) -> Card {
    let connect = |text, place: &Endpoint| {
        CardButton::new(text, ButtonRole::Plain, Action::Connect(place.clone()))
    };
    let card = card.choice(connect(cards::TO_OLD, &places.old));
    if places.new == places.old {
        card
    } else {
        card.choice(connect(cards::TO_NEW, &places.new))
    }
}

fn reset_card(state: &State, look: Look, run: &ResetProcedure) -> Card {
    let (card, places) = (Card::new(look, cards::RESETTING_TITLE), &run.places);
    match &run.stage {
        ProcedureStage::Asking => {
            let card = Card::new(look, cards::RESET_TITLE).words(cards::RESET_WORDS);
            let card = now_and_then(card, places).typed(RESET_WORD);
            asking(state, card, begin(cards::RESET))
        }
        ProcedureStage::Doing(step, _) => progress(look, card, step, places),
        ProcedureStage::Over(Ok(report)) => reset_over(look, card, places, report),
        ProcedureStage::Over(Err(error)) => not_begun(look, card, error),
    }
}

fn reset_over(look: Look, card: Card, places: &PlacePair, report: &ResetReport) -> Card {
    let card = card.choice(close());
    let card = match &report.end {
        ResetEnd::NotSent(_) => return card.warning(cards::RESET_NOT_SENT),
        ResetEnd::Refused { reason } => {
            return card
                .warning(cards::RESET_REFUSED)
                .note(errors::reason(look, *reason));
        }
        ResetEnd::Found {
            at, left, proof, ..
        } => {
            let at = places.endpoint(*at);
            let names: Vec<String> = left.iter().map(|id| id.name()).collect();
            let answers = |card| ways(card, places).words((cards::OVER_KEPT, at));
            match proof {
                ResetProof::Done if left.is_empty() => card.words((cards::RESET_FOUND, at)),
                ResetProof::Done => answers(card).warning((cards::RESET_LEFT, names.join(", "))),
                ResetProof::Ignored => {
                    answers(card).warning((cards::RESET_IGNORED, names.join(", ")))
                }
                ResetProof::Unchanged => answers(card).warning(cards::RESET_UNCHANGED),
                ResetProof::NotRead(why) => answers(card)
                    .warning(cards::RESET_NOT_READ)
                    .note(errors::request(look, why)),
            }
        }
        ResetEnd::Nowhere => ways(card, places).warning(cards::RESET_NOWHERE),
    };
    backup(card, &report.backup)
}
