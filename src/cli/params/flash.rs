//! `params save` and `params reset`: the hand's flash written or back to the factory parameters, each with a backup first.

use crate::cli::out::{Out, end, say};
use crate::cli::params::args::FlashArgs;
use crate::cli::params::reach::{self, LinkOpener};
use crate::cli::params::words;
use crate::params::backups::saved_name;
use crate::params::rows::ParamId;
use crate::record::Saved;
use crate::tasks::reset::{self, ResetEnd};
use crate::tasks::save::{self, Save};
use crate::tasks::{Consent, ParamStep};
use anyhow::bail;
use serde_json::json;

/// Saves. Fails unless the parameters are saved, as far as the wire can tell.
pub(crate) async fn save(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    args.consented("save writes the hand's flash")?;
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
            words::warn(&risks);
        }
    };
    let report = save::save(&link, &task, told).await?;
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
        out.lines([sentence, words::backup(&report.backup)])?;
    } else {
        say(&sentence);
    }
    end(is_saved)
}

/// Resets, and tells where the hand answers then. Fails unless it is found and holds the factory parameters.
pub(crate) async fn reset(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    args.consented(
        "reset returns the hand to its factory parameters, including id, serial speed and IP address",
    )?;
    let hand = &args.common.hand;
    let files = args.common.backups()?;
    // Says why, if nobody answers.
    drop(reach::open(hand).await?);
    let places = reset::places(hand);
    let report = reset::reset(&mut LinkOpener::default(), &places, &files, |_| ()).await?;
    let (at, params, left) = match report.end {
        ResetEnd::NotSent(Some(why)) => bail!("not reset, nothing was written: {why}"),
        ResetEnd::NotSent(None) => bail!("not reset, nothing was written"),
        ResetEnd::Refused { reason } => bail!("not reset: {reason}"),
        ResetEnd::Nowhere => bail!(
            "the reset was sent, and no hand answers at {hand} or at the factory id and speed. Switch the hand off and on, then look for it with 'handscope scan': the factory id is 1, the speed 115200 baud, the address 192.168.11.210:6000. Its former parameters are in {}",
            report.backup.display()
        ),
        ResetEnd::Found { at, params, left } => (at, params, left),
    };
    if let Some(why) = report.not_noted {
        bail!("the hand was reset, and its files could not be kept up: {why}");
    }
    let result = match report.is_acknowledged {
        true => "acknowledged",
        false => "unanswered",
    };
    let place = places.endpoint(at);
    out.result(
        args.common.json,
        &json!({
            "hand": hand.to_string(),
            "backup": report.backup,
            "result": result,
            "answers_at": place.to_string(),
            "params": params,
        }),
        [
            format!("reset ({result}); the hand answers at {place}"),
            words::backup(&report.backup),
        ],
    )?;
    let mut left = left.iter();
    let is_reset = left.all(|id| *id == ParamId::IpAddress || id.is_place() && place != hand);
    if !is_reset {
        say(
            "the hand does not hold the factory parameters: it may need a power cycle, or did not accept the reset",
        );
    }
    end(is_reset)
}
