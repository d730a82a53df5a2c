//! `params apply` for a row by which the hand is found on its bus: the wire is given up and taken again at each place. What a place
//! that answers means is decided in `app::params::guard`.

use crate::app::calendar::since_1970;
use crate::app::params::guard::{Guard, Moved, Place, Step, new_place};
use crate::app::params::record::Record;
use crate::app::params::table::{ParamId, Value};
use crate::app::params::values::{Params, decoded, span_of};
use crate::cli::out::{Out, Told, say};
use crate::cli::params::args::ApplyArgs;
use crate::cli::params::show;
use crate::cli::params::talk::Talk;
use crate::hand::{HandCommand, HandId, SerialSpeed};
use crate::transport::Endpoint;
use anyhow::{Context as _, anyhow};
use serde_json::json;
use std::path::Path;

/// A change of where the hand is found.
pub(crate) struct Change {
    pub(crate) id: ParamId,
    pub(crate) wanted: Value,
    pub(crate) new: Endpoint,
}

/// Changes it, and says where the hand answers then. Fails unless it is there, or will be after a SAVE or a power-up.
pub(crate) async fn run(
    out: &mut Out,
    args: &ApplyArgs,
    record: &Record,
    before: &Params,
    change: &Change,
) -> anyhow::Result<()> {
    let old = &args.common.hand;
    let backup = record
        .back_up(before, "before apply", since_1970())
        .context("cannot make a backup, nothing was written to the hand")?;
    let moved = moved(old, change).await?;
    if matches!(moved, Moved::There | Moved::Waits) {
        let new = record.beside(&change.new);
        new.adopt(record).with_context(|| {
            format!(
                "the hand was changed, and its backups could not be taken along: they are in {}",
                record.folder().display()
            )
        })?;
    }
    let answers_at = match moved {
        Moved::There => Some(change.new.to_string()),
        Moved::Nowhere => None,
        _ => Some(old.to_string()),
    };
    let sentence = words(&moved, old, change, &backup);
    let done = matches!(moved, Moved::There | Moved::Waits);
    if args.common.json {
        let row = json!({
            "name": change.id.name(),
            "before": show::json_of(before.get(change.id)),
            "wanted": show::json_of(Some(change.wanted)),
            "verdict": moved.name(),
        });
        let object = json!({
            "hand": old.to_string(),
            "backup": backup,
            "rows": [row],
            "applied": done,
            "answers_at": answers_at,
            "words": sentence,
        });
        out.line(&object.to_string())?;
    } else if done {
        out.line(&sentence)?;
        out.line(&format!("backup: {}", backup.display()))?;
    }
    if done {
        return Ok(());
    }
    say(&sentence);
    Err(Told.into())
}

async fn moved(old: &Endpoint, change: &Change) -> anyhow::Result<Moved> {
    let mut guard = Guard::new(change.id, change.wanted);
    loop {
        match guard.step() {
            Step::Over(moved) => return Ok(moved.clone()),
            Step::Look(place) => {
                let at = match place {
                    Place::Old => old,
                    Place::New => &change.new,
                };
                let holds = holds_at(at, change.id).await;
                guard.heard(holds);
            }
            Step::Write => {
                let mut talk = Talk::open_next(old).await?;
                let refused = talk.tell(command(change)?).await;
                drop(talk);
                guard.wrote(refused);
            }
        }
    }
}

/// What a hand that answers there holds in the row; nothing if nobody does.
async fn holds_at(place: &Endpoint, id: ParamId) -> Option<Value> {
    let mut talk = Talk::open_next(place).await.ok()?;
    let span = span_of(id);
    let bytes = talk.read_again(span).await?;
    decoded(id, span, &bytes)
}

fn command(change: &Change) -> anyhow::Result<HandCommand> {
    let number = match change.wanted {
        Value::Number(number) => i64::from(number),
        Value::Address(_) => -1,
    };
    let known = match change.id {
        ParamId::HandId => HandId::new(number).ok().map(HandCommand::Id),
        _ => {
            let mut speeds = SerialSpeed::ALL.into_iter();
            let speed = speeds.find(|speed| i64::from(speed.code()) == number);
            speed.map(HandCommand::SerialSpeed)
        }
    };
    known.ok_or_else(|| anyhow!("{} cannot be {}", change.id.name(), change.wanted))
}

fn words(moved: &Moved, old: &Endpoint, change: &Change, backup: &Path) -> String {
    let (name, wanted, new) = (change.id.name(), change.wanted, &change.new);
    match moved {
        Moved::There => format!(
            "{name} is {wanted}: the hand answers at {new} now. Not in flash: switched off and on it is at {old} again, unless 'handscope params save --yes --hand {new}' keeps it"
        ),
        Moved::Waits => format!(
            "{name} is {wanted} and does not act yet: the hand still answers at {old}. After a SAVE, or a SAVE and a power-up, look for it at {new}"
        ),
        Moved::Stayed => {
            format!("{name} was not changed: the hand answers at {old} and did not take it")
        }
        Moved::Refused { reason } => {
            format!("{name} was not changed: {reason}; the hand answers at {old}")
        }
        Moved::Occupied => {
            format!("{name} was not changed, nothing was written: another hand answers at {new}")
        }
        Moved::Nowhere => format!(
            "{name} was written, and the hand answers neither at {new} nor at {old}. Nothing is in flash: switch it off and on, and it is at {old} again; if it is not, look for it with 'handscope scan --all-ids'. What it held is in {}",
            backup.display()
        ),
    }
}

/// The change that a file wants in one of these rows, if this wire finds the hand by it.
pub(crate) fn wanted_change(hand: &Endpoint, chosen: &Params) -> anyhow::Result<Option<Change>> {
    let moves = [ParamId::HandId, ParamId::ReduRatio];
    let is_bus = !matches!(hand, Endpoint::Tcp { .. });
    let Some(id) = moves
        .into_iter()
        .find(|id| is_bus && chosen.get(*id).is_some())
    else {
        return Ok(None);
    };
    let name = id.name();
    if chosen.iter().count() > 1 {
        return Err(anyhow!(
            "{name} is changed alone: name no other row with --only; nothing was written"
        ));
    }
    let value = chosen.get(id);
    let place = value.and_then(|value| {
        let new = new_place(hand, id, value)?;
        Some(Change {
            id,
            wanted: value,
            new,
        })
    });
    place.map(Some).ok_or_else(|| {
        anyhow!("{name} cannot be changed through {hand}: the hand could not be followed there; nothing was written")
    })
}
