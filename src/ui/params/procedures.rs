//! The cards of what is done under one: a change of the hand's place and the return to the factory's parameters. The words for
//! each state, and what can be done about it.

use crate::app::action::Action;
use crate::app::procedures::{
    PlaceProcedure, Procedure, ProcedureAction, ProcedureStage, ResetProcedure, WayTo,
};
use crate::app::state::State;
use crate::hand::Moment;
use crate::params::place::{Place, Places};
use crate::params::rows::ParamId;
use crate::record::Saved;
use crate::tasks::TaskError;
use crate::tasks::place::{
    KEEP_WITHIN, PlaceChange, PlaceEnd, PlaceReport, PlaceStep, taken_back_at,
};
use crate::tasks::reset::{ResetEnd, ResetReport, ResetStep};
use crate::ui::kit::{Card, Choice, Line, Look, Manner, Progress};
use crate::ui::params::calibration;
use crate::ui::params::card as device_card;
use crate::ui::params::choices::{cancel, close, reason, under_way};
use crate::ui::params::table::value_text;
use crate::ui::text::{Text, cards, device, errors};
use std::path::Path;

/// The word that a return to the factory's parameters wants typed, in every language.
pub(crate) const RESET_WORD: &str = "RESET";

/// The card of what is under way, if something is.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    Some(match state.hand().procedure.as_ref()? {
        Procedure::Calibrate(run) => calibration::card(state, look, run),
        Procedure::Place(run) => place_card(state, look, run),
        Procedure::Reset(run) => reset_card(state, look, run),
    })
}

/// The title as a question, and once it was answered.
const fn titles(change: &PlaceChange) -> [Text; 2] {
    match change.id {
        ParamId::HandId => [cards::CHANGE_ID, cards::CHANGING_ID],
        ParamId::IpAddress => [cards::CHANGE_IP, cards::CHANGING_IP],
        _ => [cards::CHANGE_BAUD, cards::CHANGING_BAUD],
    }
}

/// Nothing was written: why.
fn not_begun(look: Look, title: Text, error: &TaskError) -> Card {
    let (text, note) = match error {
        TaskError::NoBackup { message } => (cards::NO_BACKUP, Some(message.clone())),
        TaskError::NotRead { .. } => (cards::NO_BACKUP, Some(errors::task(look, error))),
        _ => (cards::OVER_NOT_WRITTEN, None),
    };
    let mut lines = vec![Line::Warning(look.say(text).into())];
    lines.extend(note.map(Line::Note));
    Card {
        title: look.say(title).into(),
        lines,
        choices: vec![close()],
        ..Card::default()
    }
}

fn step(text: Text, manner: Manner, step: ProcedureAction) -> Choice {
    Choice::new(text, manner).does(Action::Procedure(step))
}

fn at(look: Look, caption: Text, places: &Places, place: Place) -> String {
    format!("{} {}", look.say(caption), places.endpoint(place))
}

/// What is changed, from what to what.
fn from_to(look: Look, change: &PlaceChange) -> Line {
    let name = match change.id {
        ParamId::HandId => cards::FROM_TO_ID,
        ParamId::IpAddress => cards::FROM_TO_IP,
        _ => cards::FROM_TO_BAUD,
    };
    let (from, to) = (change.before, change.wanted);
    let [from, to] = [from, to].map(|value| value_text(change.id, Some(value)));
    Line::Words(format!("{}: {from} -> {to}", look.say(name)))
}

fn ask_change(state: &State, look: Look, run: &PlaceProcedure) -> Card {
    let (change, places) = (&run.change, &run.change.places);
    let mut lines = vec![
        from_to(look, change),
        Line::Note(at(look, cards::NOW_AT, places, Place::Old)),
    ];
    if places.new != places.old {
        lines.push(Line::Note(at(look, cards::THEN_AT, places, Place::New)));
    }
    lines.extend(run.way.as_ref().map(|way| way_line(look, way)));
    let words = match change.id {
        ParamId::IpAddress => cards::POWERED,
        _ if places.new == places.old => cards::POWERED,
        _ => cards::FOLLOWED,
    };
    lines.push(Line::Words(look.say(words).into()));
    let begin = step(cards::CHANGE, Manner::Danger, ProcedureAction::Begin);
    Card {
        title: look.say(titles(change)[0]).into(),
        lines,
        choices: vec![cancel(), begin.disabled(reason(state, look))],
        ..Card::default()
    }
}

fn way_line(look: Look, way: &WayTo) -> Line {
    match way {
        WayTo::Asked => Line::Note(look.say(cards::WAY_ASKED).into()),
        WayTo::None => Line::Warning(look.say(cards::WAY_NONE).into()),
        WayTo::Known(route) => {
            let from = route.from;
            match route.is_direct() {
                Some(true) => Line::Note(format!("{} {from}", look.say(cards::WAY_DIRECT))),
                Some(false) => Line::Warning(format!("{} {from}", look.say(cards::WAY_ROUTED))),
                None => Line::Note(format!("{} {from}", look.say(cards::WAY_UNSURE))),
            }
        }
    }
}

fn place_card(state: &State, look: Look, run: &PlaceProcedure) -> Card {
    let change = &run.change;
    let places = &change.places;
    match &run.stage {
        ProcedureStage::Asking => ask_change(state, look, run),
        ProcedureStage::Over(Ok(report)) => change_over(look, change, report),
        ProcedureStage::Over(Err(error)) => not_begun(look, titles(change)[1], error),
        ProcedureStage::Doing(step, since) => match step {
            PlaceStep::BackingUp | PlaceStep::BackedUp(..) => {
                under_way(look, titles(change)[1], look.say(cards::BACKING_UP), 0.1)
            }
            PlaceStep::Looking(place) => {
                let words = at(look, cards::LOOKING, places, *place);
                under_way(look, titles(change)[1], &words, 0.6)
            }
            PlaceStep::Writing(place) => {
                let words = at(look, cards::WRITING, places, *place);
                under_way(look, titles(change)[1], &words, 0.4)
            }
            PlaceStep::Keeping(place) => keep_card(state, look, change, (*place, *since)),
            PlaceStep::Returning => under_way(look, cards::GOING_BACK, "", 0.9),
            PlaceStep::Offering(_) => offer_card(look, run),
            PlaceStep::Saving(_) => {
                under_way(look, cards::OFFER_TITLE, look.say(cards::SAVING), 0.8)
            }
        },
    }
}

fn keep_card(
    state: &State,
    look: Look,
    change: &PlaceChange,
    (place, since): (Place, Moment),
) -> Card {
    let seconds = taken_back_at(since).since(state.now).as_secs_f32();
    let words = match place {
        Place::New => cards::KEEP_THERE,
        Place::Old => cards::KEEP_WAITS,
    };
    let keep = step(cards::KEEP, Manner::Main, ProcedureAction::Keep);
    let go_back = step(cards::GO_BACK, Manner::Plain, ProcedureAction::GoBack);
    let reached = state.hand().link.state.is_live();
    let lost = (!reached).then(|| look.say(cards::NO_HAND).to_owned());
    Card {
        title: look.say(cards::KEEP_TITLE).into(),
        lines: vec![
            from_to(look, change),
            Line::Words(look.say(words).into()),
            Line::Note(at(look, cards::NOW_AT, &change.places, place)),
        ],
        progress: Some(Progress {
            part: seconds / KEEP_WITHIN.as_secs_f32(),
            words: format!("{} {:.0} s", look.say(cards::GOES_BACK_IN), seconds.ceil()),
        }),
        choices: vec![go_back, keep.disabled(lost)],
        ..Card::default()
    }
}

/// SAVE writes all that the hand holds: what could hurt among it is told before.
fn offer_card(look: Look, run: &PlaceProcedure) -> Card {
    let places = &run.change.places;
    let unsaved = step(cards::UNSAVED, Manner::Safe, ProcedureAction::LeaveUnsaved);
    let mut lines = vec![Line::Words(at(look, cards::OFFER, places, Place::Old))];
    let (text, manner) = match run.dangers.is_empty() {
        true => (cards::SAVE, Manner::Main),
        false => {
            lines.push(Line::Words(look.say(cards::OFFER_ALL).into()));
            lines.extend(device_card::lines(look, &run.dangers));
            (device::AGREE_SAVE, Manner::Danger)
        }
    };
    Card {
        title: look.say(cards::OFFER_TITLE).into(),
        lines,
        choices: vec![unsaved, step(text, manner, ProcedureAction::Save)],
        ..Card::default()
    }
}

fn change_over(look: Look, change: &PlaceChange, report: &PlaceReport) -> Card {
    let places = &change.places;
    let backup = report.backup.as_path();
    let words = |text| Line::Words(look.say(text).into());
    let warning = |text| Line::Warning(look.say(text).into());
    let mut choices = vec![close()];
    let lines = match &report.end {
        PlaceEnd::NotWritten => vec![words(cards::OVER_NOT_WRITTEN), from_line(look, places)],
        PlaceEnd::Occupied => vec![
            warning(cards::OVER_OCCUPIED),
            Line::Note(places.new.to_string()),
            from_line(look, places),
        ],
        PlaceEnd::NotTaken { reason } => {
            let mut lines = vec![warning(cards::OVER_NOT_TAKEN)];
            lines.extend(reason.clone().map(Line::Note));
            lines
        }
        PlaceEnd::Back => vec![words(cards::OVER_BACK), from_line(look, places)],
        PlaceEnd::NotBack(place) => vec![
            Line::Warning(at(look, cards::OVER_NOT_BACK, places, *place)),
            words(cards::OVER_NOT_BACK_POWER),
            backup_line(look, backup),
        ],
        PlaceEnd::Unseen(saved) => {
            choices.extend(ways(places));
            let mut lines = vec![
                warning(cards::OVER_UNSEEN),
                Line::Note(places.old.to_string()),
                Line::Note(places.new.to_string()),
            ];
            if !matches!(saved, Saved::Unknown { .. }) {
                lines.extend(saved_lines(look, places, Some(saved)));
            }
            lines.push(backup_line(look, backup));
            lines
        }
        PlaceEnd::Nowhere => {
            choices.extend(ways(places));
            vec![
                warning(cards::OVER_NOWHERE),
                from_line(look, places),
                backup_line(look, backup),
            ]
        }
        PlaceEnd::Kept { at: place, saved } => {
            let mut lines = vec![Line::Words(at(look, cards::OVER_KEPT, places, *place))];
            lines.extend(saved_lines(look, places, saved.as_ref()));
            let is_saved = saved.as_ref().is_some_and(Saved::may_be_in_flash);
            if *place == Place::Old && places.new != places.old && is_saved {
                lines.push(Line::Words(at(look, cards::OVER_WAITS, places, Place::New)));
            }
            if is_saved && places.new != places.old {
                choices.extend(ways(places));
            }
            lines.push(backup_line(look, backup));
            lines
        }
    };
    Card {
        title: look.say(titles(change)[1]).into(),
        lines,
        choices,
        ..Card::default()
    }
}

fn saved_lines(look: Look, places: &Places, saved: Option<&Saved>) -> Vec<Line> {
    let text = match saved {
        None => cards::OVER_UNSAVED,
        Some(Saved::Confirmed) => cards::SAVED_OK,
        Some(Saved::ReadBack) => cards::SAVED_READ,
        Some(Saved::Failed { .. }) => cards::SAVED_FAILED,
        Some(Saved::Refused { .. } | Saved::NotSent(_)) => cards::SAVED_NOT_SENT,
        Some(Saved::Unknown { .. }) => {
            return vec![
                Line::Warning(look.say(cards::SAVED_UNKNOWN).into()),
                Line::Note(places.old.to_string()),
                Line::Note(places.new.to_string()),
            ];
        }
    };
    vec![Line::Words(look.say(text).into())]
}

fn from_line(look: Look, places: &Places) -> Line {
    Line::Note(at(look, cards::NOW_AT, places, Place::Old))
}

fn backup_line(look: Look, backup: &Path) -> Line {
    Line::Note(format!("{}: {}", look.say(cards::BACKUP), backup.display()))
}

fn connect(text: Text, places: &Places, place: Place) -> Choice {
    let there = places.endpoint(place).clone();
    Choice::new(text, Manner::Plain).does(Action::Connect(there))
}

/// The ways back to a hand: each place where it may be.
fn ways(places: &Places) -> Vec<Choice> {
    let mut ways = vec![connect(cards::TO_OLD, places, Place::Old)];
    if places.new != places.old {
        ways.push(connect(cards::TO_NEW, places, Place::New));
    }
    ways
}

fn ask_reset(state: &State, look: Look, places: &Places) -> Card {
    let mut lines = vec![
        Line::Words(look.say(cards::RESET_WORDS).into()),
        Line::Note(at(look, cards::NOW_AT, places, Place::Old)),
    ];
    if places.new != places.old {
        lines.push(Line::Note(at(look, cards::THEN_AT, places, Place::New)));
    }
    let begin = step(cards::RESET, Manner::Danger, ProcedureAction::Begin);
    Card {
        title: look.say(cards::RESET_TITLE).into(),
        lines,
        word: Some(RESET_WORD),
        choices: vec![cancel(), begin.disabled(reason(state, look))],
        ..Card::default()
    }
}

fn reset_card(state: &State, look: Look, run: &ResetProcedure) -> Card {
    let (title, places) = (cards::RESETTING_TITLE, &run.places);
    match &run.stage {
        ProcedureStage::Asking => ask_reset(state, look, places),
        ProcedureStage::Doing(ResetStep::BackingUp, _) => {
            under_way(look, title, look.say(cards::BACKING_UP), 0.1)
        }
        ProcedureStage::Doing(ResetStep::Sending, _) => {
            under_way(look, title, look.say(cards::RESET_SENDING), 0.4)
        }
        ProcedureStage::Doing(ResetStep::Looking(place), _) => {
            under_way(look, title, &at(look, cards::LOOKING, places, *place), 0.7)
        }
        ProcedureStage::Over(Ok(report)) => reset_over(look, places, report),
        ProcedureStage::Over(Err(error)) => not_begun(look, title, error),
    }
}

fn reset_over(look: Look, places: &Places, report: &ResetReport) -> Card {
    let (title, backup) = (cards::RESETTING_TITLE, report.backup.as_path());
    let mut choices = vec![close()];
    let lines = match &report.end {
        ResetEnd::NotSent(_) => vec![Line::Warning(look.say(cards::RESET_NOT_SENT).into())],
        ResetEnd::Refused { reason } => vec![
            Line::Warning(look.say(cards::RESET_REFUSED).into()),
            Line::Note(reason.clone()),
        ],
        ResetEnd::Found {
            at: place, left, ..
        } if left.is_empty() => {
            vec![
                Line::Words(at(look, cards::RESET_FOUND, places, *place)),
                backup_line(look, backup),
            ]
        }
        ResetEnd::Found {
            at: place, left, ..
        } => {
            choices.extend(ways(places));
            let names: Vec<String> = left.iter().map(|id| id.name()).collect();
            vec![
                Line::Words(at(look, cards::OVER_KEPT, places, *place)),
                Line::Warning(format!(
                    "{} {}",
                    look.say(cards::RESET_LEFT),
                    names.join(", ")
                )),
                backup_line(look, backup),
            ]
        }
        ResetEnd::Nowhere => {
            choices.extend(ways(places));
            vec![
                Line::Warning(look.say(cards::RESET_NOWHERE).into()),
                backup_line(look, backup),
            ]
        }
    };
    Card {
        title: look.say(title).into(),
        lines,
        choices,
        ..Card::default()
    }
}
