//! `params save`: the hand's parameters into its flash, with a backup first and a note of the result.

use crate::cli::out::{Out, end, say};
use crate::cli::params::args::FlashArgs;
use crate::cli::params::{reach, words};
use crate::cli::session;
use crate::params::backups::saved_name;
use crate::record::Saved;
use crate::tasks::save::{Save, save};
use crate::tasks::{Consent, ParamStep};
use anyhow::bail;
use serde_json::json;

/// Saves. Fails unless the parameters are saved, as far as the wire can tell.
pub(crate) fn run(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    args.consented("save writes the hand's flash")?;
    session::runtime()?.block_on(save_now(out, args))
}

async fn save_now(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let backups = common.backups()?;
    let known = backups.known().unwrap_or_default();
    let link = reach::open(&common.hand).await?;
    let task = Save {
        backups,
        before: known.saved.map(|file| file.params).unwrap_or_default(),
        consent: Consent::Given,
    };
    let told = |step| {
        if let ParamStep::Meant(risks) = step {
            for danger in &risks.dangers {
                say(&format!("warning: {}", words::danger(danger)));
            }
        }
    };
    let report = save(&link, &task, told).await?;
    let sentence = words::saved(&report.saved);
    if let Some(why) = report.not_noted {
        bail!("{sentence}; and this could not be noted: {why}");
    }
    let is_saved = matches!(report.saved, Saved::Confirmed | Saved::ReadBack);
    if common.json {
        out.object(&json!({
            "hand": common.hand.to_string(),
            "backup": report.backup,
            "result": saved_name(&report.saved),
            "words": sentence,
            "params": report.params,
        }))?;
    } else if is_saved {
        let backup = format!("backup: {}", report.backup.display());
        out.lines([sentence, backup])?;
    } else {
        say(&sentence);
    }
    end(is_saved)
}
