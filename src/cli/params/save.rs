//! `params save`: the hand's parameters into its flash, with a backup first and a note of what came of it.

use crate::app::calendar::since_1970;
use crate::app::params::danger::dangers;
use crate::app::params::record::saved_name;
use crate::cli::out::{Out, Told, WrongUsage, say};
use crate::cli::params::args::FlashArgs;
use crate::cli::params::show;
use crate::cli::params::talk::Talk;
use crate::cli::params::words::{self, record};
use crate::cli::session;
use crate::link::Saved;
use anyhow::Context as _;
use serde_json::json;
use std::time::{Duration, SystemTime};
use tokio::time::sleep;

/// The result of a SAVE may come this late; another process must not take it for the result of its own.
const APART: Duration = Duration::from_secs(6);

/// Saves. Fails unless it is saved as far as the wire can tell.
pub(crate) fn run(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    if !args.yes {
        return Err(WrongUsage(
            "save writes the hand's flash: add --yes if you mean it; nothing was written".into(),
        )
        .into());
    }
    session::runtime()?.block_on(save(out, args))
}

async fn save(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let record = record(common)?;
    let mut talk = Talk::open(&common.hand).await?;
    let params = talk.read_whole().await?;
    for danger in dangers(&params) {
        say(&format!("warning: {}", words::danger(&danger)));
    }
    let kept = "nothing was written to the hand";
    let backup = record
        .back_up(&params, "before save", since_1970())
        .with_context(|| format!("cannot make a backup, {kept}"))?;
    if let Some(ago) = record.since_attempt(SystemTime::now()) {
        sleep(APART.saturating_sub(ago)).await;
    }
    record
        .attempt(&params, since_1970())
        .with_context(|| format!("cannot note the SAVE, {kept}"))?;
    let saved = talk.save().await?;
    record
        .end(&saved)
        .with_context(|| format!("{}; and this could not be noted", words::saved(&saved)))?;
    let done = matches!(saved, Saved::Confirmed | Saved::ReadBack);
    let sentence = words::saved(&saved);
    if common.json {
        let object = json!({
            "hand": common.hand.to_string(),
            "backup": backup,
            "result": saved_name(&saved),
            "words": sentence,
            "params": show::params_json(&params),
        });
        out.line(&object.to_string())?;
    } else if done {
        out.line(&sentence)?;
        out.line(&format!("backup: {}", backup.display()))?;
    } else {
        say(&sentence);
    }
    match done {
        true => Ok(()),
        false => Err(Told.into()),
    }
}
