//! `params reset`: back to the factory's parameters, with a backup first, and where the hand answers then.

use crate::app::calendar::since_1970;
use crate::app::guard::reset::factory_place;
use crate::app::params::table::ParamId;
use crate::app::params::values::Params;
use crate::cli::out::{Out, Told, WrongUsage, say};
use crate::cli::params::args::FlashArgs;
use crate::cli::params::show;
use crate::cli::params::talk::Talk;
use crate::cli::params::words::record;
use crate::cli::session;
use crate::link::Reset;
use crate::transport::Endpoint;
use anyhow::{Context as _, bail};
use serde_json::json;
use std::path::Path;

/// Resets. Fails unless the hand holds the factory's parameters afterwards and is found.
pub(crate) fn run(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    if !args.yes {
        return Err(WrongUsage(
            "reset returns the hand to the factory's parameters, id, serial speed and IP address included: add --yes if you mean it; nothing was written".into(),
        )
        .into());
    }
    session::runtime()?.block_on(reset(out, args))
}

async fn reset(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let record = record(common)?;
    let mut talk = Talk::open(&common.hand).await?;
    let before = talk.read_whole().await?;
    let backup = record
        .back_up(&before, "before reset", since_1970())
        .context("cannot make a backup, nothing was written to the hand")?;
    let reset = talk.reset().await?;
    // The port must be free for the other places.
    drop(talk);
    let name = match &reset {
        Reset::NotSent(why) => bail!("not reset, nothing was written: {why}"),
        Reset::Refused { reason } => bail!("not reset: {reason}"),
        Reset::Acknowledged => "acknowledged",
        Reset::Unanswered => "unanswered",
    };
    // Whatever the answer was: what is in flash now is not what was saved.
    record
        .forget_saved()
        .context("the hand was reset, and this could not be noted")?;
    let Some((place, live)) = found(&common.hand).await else {
        say(&way_back(&common.hand, &backup));
        return Err(Told.into());
    };
    record
        .beside(&place)
        .adopt(&record)
        .context("the hand was reset, and its backups could not be taken along")?;
    let left = live.differences(&Params::factory());
    let done = left
        .iter()
        .all(|row| row.id == ParamId::IpAddress || row.id.is_place() && place != common.hand);
    if common.json {
        let object = json!({
            "hand": common.hand.to_string(),
            "backup": backup,
            "result": name,
            "answers_at": place.to_string(),
            "params": show::params_json(&live),
        });
        out.line(&object.to_string())?;
    } else {
        out.line(&format!("reset ({name}); the hand answers at {place}"))?;
        out.line(&format!("backup: {}", backup.display()))?;
    }
    if !done {
        say(
            "the hand does not hold the factory's parameters: it may need a power cycle, or did not take the reset",
        );
        return Err(Told.into());
    }
    Ok(())
}

/// Where the hand answers after a reset, and what it holds there: at the factory's id and speed, else where it was.
async fn found(hand: &Endpoint) -> Option<(Endpoint, Params)> {
    for place in [factory_place(hand), hand.clone()] {
        let Ok(mut talk) = Talk::open_next(&place).await else {
            continue;
        };
        if let Ok((live, _)) = talk.read().await {
            return Some((place, live));
        }
    }
    None
}

fn way_back(hand: &Endpoint, backup: &Path) -> String {
    format!(
        "the reset was sent, and no hand answers at {hand} or at the factory's id and speed. Switch the hand off and on, then look for it with 'handscope scan': the factory's id is 1, its speed 115200, its address 192.168.11.210:6000. What it held is in {}",
        backup.display()
    )
}
