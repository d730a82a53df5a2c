//! Maintains the quirk sheet of the connected hand, off the window's thread, and reports differences from the previous one. Decides
//! nothing about the hand.

use crate::app::env::{Ctx, Env};
use crate::app::hand::Hand;
use crate::app::notices::NoticeKind;
use crate::app::procedures::Procedure;
use crate::app::slot::SlotId;
use crate::link::Quirks;
use crate::link::quirks::book::{self, QuirkBook};
use crate::params::place::WhichPlace;
use crate::params::rows::{ParamId, Value};
use crate::record::{Fact, QuirkSheet, Saved};
use crate::store::calendar::{day, since_1970};
use crate::store::{JobKind, Jobs, on_thread};
use crate::tasks::place::{PlaceChange, PlaceEnd};
use crate::transport::Endpoint;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Notes each hand once per set of answers.
#[derive(Debug)]
pub(crate) struct QuirkNotes {
    path: Option<PathBuf>,
    /// The last noted hand of each slot. As many entries as slots of one run.
    noted: BTreeMap<SlotId, (Endpoint, Quirks)>,
    jobs: Jobs<KeepSheet>,
    /// A change made by this program, and whether it may be in flash: it causes no warning.
    own: Option<(PlaceChange, bool)>,
}

/// Background job of the notes: keeping the sheet of a hand.
#[derive(Debug, PartialEq, Eq)]
struct KeepSheet;

impl JobKind for KeepSheet {
    type State = QuirkNotes;
    type Ctx<'a> = Ctx<'a>;
}

impl QuirkNotes {
    /// Stores the book beside the settings; without settings nothing is stored.
    pub(crate) fn new(settings: Option<&Path>) -> Self {
        Self {
            path: settings.map(QuirkBook::path),
            noted: BTreeMap::new(),
            jobs: Jobs::default(),
            own: None,
        }
    }

    /// Notes a hand that is new or answers differently, and notifies the user of differences from last time.
    pub(crate) fn tick(&mut self, hand: &mut Hand, ctx: &mut Ctx<'_>) {
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, ctx);
        }
        if let Some(Procedure::Place(card)) = &hand.procedures.card
            && let Some(Ok(report)) = card.stage.end()
            && let PlaceEnd::Kept { saved, .. } = &report.end
        {
            let in_flash = saved.as_ref().is_some_and(Saved::may_be_in_flash);
            self.own = Some((card.change.clone(), in_flash));
        }
        let quirks = self.quirks(hand);
        let endpoint = hand
            .connection
            .endpoint
            .as_ref()
            .filter(|endpoint| !endpoint.is_sim());
        let new = endpoint.filter(|endpoint| {
            let noted = self.noted.get(&hand.label.slot);
            hand.connection.status.state.is_live()
                && noted.is_none_or(|noted| (&noted.0, noted.1) != (endpoint, quirks))
        });
        if let Some(endpoint) = new.filter(|_| self.jobs.is_empty()).cloned() {
            let noted = (endpoint.clone(), quirks);
            self.noted.insert(hand.label.slot, noted);
            self.note(endpoint, quirks, ctx.env);
        }
    }

    fn note(&mut self, endpoint: Endpoint, quirks: Quirks, env: &Env) {
        let Some(path) = self.path.clone() else {
            return;
        };
        let place = path.clone();
        let note = on_thread(move || {
            let mut now = book::sheet(&endpoint, &quirks, &day(since_1970()));
            let before = QuirkBook::keep(&place, now.clone())?;
            if let Some(before) = &before {
                now.first_seen.clone_from(&before.first_seen);
            }
            Ok((before, now))
        });
        self.jobs.start(
            KeepSheet,
            env.background(),
            note,
            move |notes, ctx, noted| match noted {
                Ok((before, now)) => {
                    if let Some(differs) = notes.difference(before.as_ref(), &now) {
                        ctx.notify(differs);
                    }
                }
                Err(error) => ctx.notify(NoticeKind::not_saved(path, &error)),
            },
        );
    }

    /// Answers of the hand; after a change that this program made and saved, the answers expected from the next query.
    fn quirks(&self, hand: &Hand) -> Quirks {
        let mut quirks = hand.connection.status.quirks;
        let Some((change, true)) = &self.own else {
            return quirks;
        };
        let is_there = hand.connection.endpoint.as_ref().is_some_and(|hand| {
            let places = [
                change.places.endpoint(WhichPlace::Old),
                change.places.endpoint(WhichPlace::New),
            ];
            places.contains(&hand)
        });
        let (Value::Number(before), Value::Number(wanted)) = (change.before, change.wanted) else {
            return quirks;
        };
        let field = match change.id {
            ParamId::HandId => &mut quirks.hand_id,
            _ => &mut quirks.baud_code,
        };
        if is_there && field.map(i32::from) == Some(before) {
            *field = u8::try_from(wanted).ok();
        }
        quirks
    }

    fn difference(&self, before: Option<&QuirkSheet>, now: &QuirkSheet) -> Option<NoticeKind> {
        let before = before?;
        let mut differences = before.differences(now);
        if let Some((change, _)) = &self.own {
            let own = [change.before, change.wanted].map(|value| value.to_string());
            let fact = match change.id {
                ParamId::HandId => Fact::HandId,
                _ => Fact::BaudCode,
            };
            differences.retain(|differs| {
                let mut values = [&differs.before, &differs.now].into_iter();
                differs.fact != fact || !values.all(|value| own.contains(value))
            });
        }
        (!differences.is_empty()).then(|| NoticeKind::HandDiffers {
            differences,
            last_seen: before.last_seen.clone(),
        })
    }
}
