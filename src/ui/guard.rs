//! The cards of what is done under one: a change of the hand's place and the return to the factory's parameters. The words for
//! each state, and what can be done about it.

use crate::app::action::Action;
use crate::app::guard::change::{Change, End, KEEP_WITHIN, Next, Stage};
use crate::app::guard::reset::{FactoryReset, ResetEnd, ResetStage};
use crate::app::guard::{Doing, Flow, GuardStep, Guarded, NotNow, WayTo, not_now};
use crate::app::params::guard::Place;
use crate::app::params::table::ParamId;
use crate::app::state::State;
use crate::link::Saved;
use crate::ui::calibration;
use crate::ui::card::{Card, Choice, Line, Manner, Progress};
use crate::ui::device_card;
use crate::ui::look::Look;
use crate::ui::text::{Text, cards, device};

/// The word that a return to the factory's parameters wants typed, in every language.
pub(crate) const RESET_WORD: &str = "RESET";

/// The card of what is under way, if something is.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let guarded = state.guard.as_ref()?;
    let card = match (&guarded.doing, &guarded.flow) {
        (_, Flow::Calibration(run)) => calibration::card(state, look, run),
        (Doing::Asking, Flow::Change(change)) => ask_change(state, look, guarded, change),
        (Doing::Asking, Flow::Reset(_)) => ask_reset(state, look, guarded),
        (Doing::BackingUp, flow) => under_way(look, title(flow), look.say(cards::BACKING_UP), 0.1),
        (Doing::NoBackup { why }, flow) => Card {
            title: look.say(title(flow)).into(),
            lines: vec![
                Line::Warning(look.say(cards::NO_BACKUP).into()),
                Line::Note(why.clone()),
            ],
            choices: vec![close()],
            ..Card::default()
        },
        (Doing::Running, Flow::Change(change)) => change_card(state, look, guarded, change),
        (Doing::Running, Flow::Reset(reset)) => reset_card(look, guarded, reset),
    };
    Some(card)
}

const fn title(flow: &Flow) -> Text {
    match flow {
        Flow::Change(change) => match change.id {
            ParamId::HandId => cards::CHANGE_ID,
            ParamId::IpAddress => cards::CHANGE_IP,
            _ => cards::CHANGE_BAUD,
        },
        Flow::Reset(_) => cards::RESET_TITLE,
        Flow::Calibration(_) => cards::CALIBRATE_TITLE,
    }
}

/// A card of something that goes on by itself.
pub(crate) fn under_way(look: Look, title: Text, words: &str, part: f32) -> Card {
    Card {
        title: look.say(title).into(),
        progress: Some(Progress {
            part,
            words: words.into(),
        }),
        ..Card::default()
    }
}

/// The way out of a card that was read.
pub(crate) fn close() -> Choice {
    Choice::new(cards::CLOSE, cards::CLOSE_TIP, Manner::Safe).does(Action::Guard(GuardStep::Close))
}

/// The way out of a card that asks.
pub(crate) fn cancel() -> Choice {
    Choice::cancel().does(Action::Guard(GuardStep::Close))
}

fn step(text: Text, tip: Text, manner: Manner, step: GuardStep) -> Choice {
    Choice::new(text, tip, manner).does(Action::Guard(step))
}

/// Why nothing can begin now, in words.
pub(crate) fn reason(state: &State, look: Look) -> Option<String> {
    let why = match not_now(state)? {
        NotNow::NoHand => cards::NO_HAND,
        NotNow::Armed => cards::ARMED,
        NotNow::Holding => cards::HOLDING,
        NotNow::Moving => cards::MOVING,
    };
    Some(look.say(why).into())
}

fn at(look: Look, caption: Text, guarded: &Guarded, place: Place) -> String {
    format!("{} {}", look.say(caption), guarded.endpoint(place))
}

/// What is changed, from what to what.
fn from_to(look: Look, change: &Change) -> Line {
    let name = match change.id {
        ParamId::HandId => cards::FROM_TO_ID,
        ParamId::IpAddress => cards::FROM_TO_IP,
        _ => cards::FROM_TO_BAUD,
    };
    let (from, to) = (change.before, change.wanted);
    Line::Words(format!("{}: {from} -> {to}", look.say(name)))
}

fn ask_change(state: &State, look: Look, guarded: &Guarded, change: &Change) -> Card {
    let mut lines = vec![
        from_to(look, change),
        Line::Note(at(look, cards::NOW_AT, guarded, Place::Old)),
    ];
    if guarded.new != guarded.old {
        lines.push(Line::Note(at(look, cards::THEN_AT, guarded, Place::New)));
    }
    lines.extend(guarded.way.as_ref().map(|way| way_line(look, way)));
    let words = match change.id {
        ParamId::IpAddress => cards::POWERED,
        _ if guarded.new == guarded.old => cards::POWERED,
        _ => cards::FOLLOWED,
    };
    lines.push(Line::Words(look.say(words).into()));
    let begin = step(
        cards::CHANGE,
        cards::CHANGE_TIP,
        Manner::Danger,
        GuardStep::Begin,
    );
    Card {
        title: look.say(title(&guarded.flow)).into(),
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

fn change_card(state: &State, look: Look, guarded: &Guarded, change: &Change) -> Card {
    match change.stage() {
        Stage::Asking => ask_change(state, look, guarded, change),
        Stage::Keeping { at: place, until } => {
            let left = until.since(state.now);
            let seconds = left.as_secs_f32();
            let words = match place {
                Place::New => cards::KEEP_THERE,
                Place::Old => cards::KEEP_WAITS,
            };
            let keep = step(cards::KEEP, cards::KEEP_TIP, Manner::Main, GuardStep::Keep);
            let reached = state.link.state.is_live();
            let lost = (!reached).then(|| look.say(cards::NO_HAND).to_owned());
            Card {
                title: look.say(cards::KEEP_TITLE).into(),
                lines: vec![
                    from_to(look, change),
                    Line::Words(look.say(words).into()),
                    Line::Note(at(look, cards::NOW_AT, guarded, *place)),
                ],
                progress: Some(Progress {
                    part: seconds / KEEP_WITHIN.as_secs_f32(),
                    words: format!("{} {:.0} s", look.say(cards::GOES_BACK_IN), seconds.ceil()),
                }),
                choices: vec![
                    step(
                        cards::GO_BACK,
                        cards::GO_BACK_TIP,
                        Manner::Plain,
                        GuardStep::GoBack,
                    ),
                    keep.disabled(lost),
                ],
                ..Card::default()
            }
        }
        Stage::Offering(_) => offer_card(look, guarded),
        Stage::Saving(_) => under_way(look, cards::OFFER_TITLE, look.say(cards::SAVING), 0.8),
        Stage::Going(_) | Stage::Finding { .. } | Stage::Returning(..) | Stage::Locating { .. } => {
            let is_back = matches!(change.stage(), Stage::Finding { .. } | Stage::Returning(..));
            let title = if is_back {
                cards::GOING_BACK
            } else {
                title(&guarded.flow)
            };
            let (words, part) = match change.next() {
                Next::Look(place) => (at(look, cards::LOOKING, guarded, place), 0.6),
                Next::Write(place, _) => (at(look, cards::WRITING, guarded, place), 0.4),
                _ => (String::new(), 0.9),
            };
            under_way(look, title, &words, part)
        }
        Stage::Over(end) => change_over(look, guarded, end),
    }
}

/// SAVE writes all that the hand holds: what could hurt among it is told before.
fn offer_card(look: Look, guarded: &Guarded) -> Card {
    let unsaved = step(
        cards::UNSAVED,
        cards::UNSAVED_TIP,
        Manner::Safe,
        GuardStep::LeaveUnsaved,
    );
    let mut lines = vec![Line::Words(at(look, cards::OFFER, guarded, Place::Old))];
    let (text, manner) = match guarded.dangers.is_empty() {
        true => (cards::SAVE, Manner::Main),
        false => {
            lines.push(Line::Words(look.say(cards::OFFER_ALL).into()));
            lines.extend(device_card::lines(look, &guarded.dangers));
            (device::AGREE_SAVE, Manner::Danger)
        }
    };
    Card {
        title: look.say(cards::OFFER_TITLE).into(),
        lines,
        choices: vec![
            unsaved,
            step(text, cards::SAVE_TIP, manner, GuardStep::Save),
        ],
        ..Card::default()
    }
}

fn change_over(look: Look, guarded: &Guarded, end: &End) -> Card {
    let words = |text| Line::Words(look.say(text).into());
    let warning = |text| Line::Warning(look.say(text).into());
    let mut choices = vec![close()];
    let lines = match end {
        End::NotWritten => vec![words(cards::OVER_NOT_WRITTEN), from_line(look, guarded)],
        End::Occupied => vec![
            warning(cards::OVER_OCCUPIED),
            Line::Note(guarded.new.to_string()),
            from_line(look, guarded),
        ],
        End::NotTaken { reason } => {
            let mut lines = vec![warning(cards::OVER_NOT_TAKEN)];
            lines.extend(reason.clone().map(Line::Note));
            lines
        }
        End::Back => vec![words(cards::OVER_BACK), from_line(look, guarded)],
        End::NotBack(place) => vec![
            Line::Warning(at(look, cards::OVER_NOT_BACK, guarded, *place)),
            words(cards::OVER_NOT_BACK_POWER),
            backup_line(look, guarded),
        ],
        End::Unseen(saved) => {
            choices.extend(ways(guarded));
            let mut lines = vec![
                warning(cards::OVER_UNSEEN),
                Line::Note(guarded.old.to_string()),
                Line::Note(guarded.new.to_string()),
            ];
            if !matches!(saved, Saved::Unknown { .. }) {
                lines.extend(saved_lines(look, guarded, Some(saved)));
            }
            lines.push(backup_line(look, guarded));
            lines
        }
        End::Nowhere => {
            choices.extend(ways(guarded));
            vec![
                warning(cards::OVER_NOWHERE),
                from_line(look, guarded),
                backup_line(look, guarded),
            ]
        }
        End::Kept { at: place, saved } => {
            let mut lines = vec![Line::Words(at(look, cards::OVER_KEPT, guarded, *place))];
            lines.extend(saved_lines(look, guarded, saved.as_ref()));
            let is_saved = saved.as_ref().is_some_and(may_be_in_flash);
            if *place == Place::Old && guarded.new != guarded.old && is_saved {
                lines.push(Line::Words(at(
                    look,
                    cards::OVER_WAITS,
                    guarded,
                    Place::New,
                )));
            }
            if is_saved && guarded.new != guarded.old {
                choices.extend(ways(guarded));
            }
            lines.push(backup_line(look, guarded));
            lines
        }
    };
    Card {
        title: look.say(title(&guarded.flow)).into(),
        lines,
        choices,
        ..Card::default()
    }
}

const fn may_be_in_flash(saved: &Saved) -> bool {
    matches!(
        saved,
        Saved::Confirmed | Saved::ReadBack | Saved::Unknown { .. }
    )
}

fn saved_lines(look: Look, guarded: &Guarded, saved: Option<&Saved>) -> Vec<Line> {
    let text = match saved {
        None => cards::OVER_UNSAVED,
        Some(Saved::Confirmed) => cards::SAVED_OK,
        Some(Saved::ReadBack) => cards::SAVED_READ,
        Some(Saved::Failed { .. }) => cards::SAVED_FAILED,
        Some(Saved::Refused { .. } | Saved::NotSent(_)) => cards::SAVED_NOT_SENT,
        Some(Saved::Unknown { .. }) => {
            return vec![
                Line::Warning(look.say(cards::SAVED_UNKNOWN).into()),
                Line::Note(guarded.old.to_string()),
                Line::Note(guarded.new.to_string()),
            ];
        }
    };
    vec![Line::Words(look.say(text).into())]
}

fn from_line(look: Look, guarded: &Guarded) -> Line {
    Line::Note(at(look, cards::NOW_AT, guarded, Place::Old))
}

fn backup_line(look: Look, guarded: &Guarded) -> Line {
    let path = guarded.backup.as_ref();
    let path = path.map(|path| path.display().to_string());
    Line::Note(format!(
        "{}: {}",
        look.say(cards::BACKUP),
        path.unwrap_or_else(|| "-".into())
    ))
}

fn connect(text: Text, guarded: &Guarded, place: Place) -> Choice {
    let there = guarded.endpoint(place).clone();
    Choice::new(text, cards::CONNECT_TIP, Manner::Plain).does(Action::Connect(there))
}

/// The ways back to a hand: each place where it may be.
fn ways(guarded: &Guarded) -> Vec<Choice> {
    let mut ways = vec![connect(cards::TO_OLD, guarded, Place::Old)];
    if guarded.new != guarded.old {
        ways.push(connect(cards::TO_NEW, guarded, Place::New));
    }
    ways
}

fn ask_reset(state: &State, look: Look, guarded: &Guarded) -> Card {
    let mut lines = vec![
        Line::Words(look.say(cards::RESET_WORDS).into()),
        Line::Note(at(look, cards::NOW_AT, guarded, Place::Old)),
    ];
    if guarded.new != guarded.old {
        lines.push(Line::Note(at(look, cards::THEN_AT, guarded, Place::New)));
    }
    let begin = step(
        cards::RESET,
        cards::RESET_TIP,
        Manner::Danger,
        GuardStep::Begin,
    );
    Card {
        title: look.say(cards::RESET_TITLE).into(),
        lines,
        word: Some(RESET_WORD),
        choices: vec![cancel(), begin.disabled(reason(state, look))],
        ..Card::default()
    }
}

fn reset_card(look: Look, guarded: &Guarded, reset: &FactoryReset) -> Card {
    let title = cards::RESET_TITLE;
    let end = match reset.stage() {
        ResetStage::Asking | ResetStage::Sending => {
            return under_way(look, title, look.say(cards::RESET_SENDING), 0.4);
        }
        ResetStage::Finding(place) => {
            return under_way(look, title, &at(look, cards::LOOKING, guarded, *place), 0.7);
        }
        ResetStage::Over(end) => end,
    };
    let mut choices = vec![close()];
    let lines = match end {
        ResetEnd::NotSent(_) => vec![Line::Warning(look.say(cards::RESET_NOT_SENT).into())],
        ResetEnd::Refused { reason } => vec![
            Line::Warning(look.say(cards::RESET_REFUSED).into()),
            Line::Note(reason.clone()),
        ],
        ResetEnd::Found { at: place, left } if left.is_empty() => {
            vec![
                Line::Words(at(look, cards::RESET_FOUND, guarded, *place)),
                backup_line(look, guarded),
            ]
        }
        ResetEnd::Found { at: place, left } => {
            choices.extend(ways(guarded));
            let names: Vec<String> = left.iter().map(|id| id.name()).collect();
            vec![
                Line::Words(at(look, cards::OVER_KEPT, guarded, *place)),
                Line::Warning(format!(
                    "{} {}",
                    look.say(cards::RESET_LEFT),
                    names.join(", ")
                )),
                backup_line(look, guarded),
            ]
        }
        ResetEnd::Nowhere => {
            choices.extend(ways(guarded));
            vec![
                Line::Warning(look.say(cards::RESET_NOWHERE).into()),
                backup_line(look, guarded),
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
