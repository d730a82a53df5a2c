//! `params save` and `params reset`: write the hand's flash or reset it to factory parameters, each with a backup first.

use crate::cli::out::{Out, end, notify};
use crate::cli::params::args::FlashArgs;
use crate::cli::params::patience::Patience;
use crate::cli::params::reach::{self, LinkOpener};
use crate::cli::params::words;
use crate::params::file::SaveVerdict;
use crate::params::place::PlacePair;
use crate::record::Saved;
use crate::tasks::reset::{self, ResetEnd, ResetProof, ResetReport};
use crate::tasks::save::{self, Save};
use crate::tasks::{Risks, TaskStep};
use anyhow::bail;
use serde_json::json;

/// Messages if the user does not wait for the end.
const UNKNOWN_SAVE: &str = "it is not known whether the parameters are in flash: switch the hand off and on, then compare with 'handscope params diff'";
const UNKNOWN_RESET: &str = "it is not known whether the hand was reset, and where it answers: look for it with 'handscope scan'; 'handscope params backups' names what it held before";

/// Saves. Fails unless the parameters are saved, as far as the wire can show.
pub(crate) async fn save(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    args.consented("save writes the hand's flash")?;
    let common = &args.common;
    let backups = common.backups()?;
    let known = backups.known().unwrap_or_default();
    let mut patience = Patience::begin()?;
    let written = patience.written();
    let link = patience
        .see_through(reach::open(&common.hand), "")
        .await??;
    let task = Save {
        backups,
        before: known.saved.map(|file| file.params).unwrap_or_default(),
        agreed: Risks::default(),
        overshoot: reach::overshoot(&common.hand),
    };
    let watch = |step| {
        if step == TaskStep::Saving {
            written.set(true);
        }
    };
    let mut user = reach::answers_of(args.yes);
    let save = save::save(&link, &task, &mut user, watch);
    let report = patience.see_through(save, UNKNOWN_SAVE).await??;
    let sentence = words::saved(&report.saved);
    if let Some(why) = report.not_noted {
        bail!("{sentence}; and this could not be recorded: {why}");
    }
    let is_saved = matches!(report.saved, Saved::Confirmed | Saved::ReadBack);
    let object = json!({
        "hand": common.hand.to_string(),
        "backup": report.backup,
        "result": SaveVerdict::from(&report.saved).to_string(),
        "words": sentence,
        "params": report.params,
    });
    if common.json || is_saved {
        let lines = [sentence, words::backup(&report.backup)];
        words::show(out, common.json, &object, &lines)?;
    } else {
        notify(&sentence);
    }
    end(is_saved)
}

/// Resets, and reports the hand's new address. Fails unless the hand is found, and the values read back show that it was
/// reset.
pub(crate) async fn reset(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    args.consented(
        "reset returns the hand to its factory parameters, including id, serial speed and IP address",
    )?;
    let hand = &args.common.hand;
    let files = args.common.backups()?;
    let mut patience = Patience::begin()?;
    let written = patience.written();
    // Reports the reason if the hand does not answer.
    drop(patience.see_through(reach::open(hand), "").await??);
    let places = reset::places(hand);
    let watch = |step| {
        if step == TaskStep::Resetting {
            written.set(true);
        }
    };
    let mut links = LinkOpener::default();
    let reset = reset::reset(&mut links, &places, &files, watch);
    let report = patience.see_through(reset, UNKNOWN_RESET).await??;
    match &report.end {
        ResetEnd::NotSent(Some(why)) => bail!("not reset, nothing was written: {why}"),
        ResetEnd::NotSent(None) => bail!("not reset, nothing was written"),
        ResetEnd::Refused { reason } => bail!("not reset: {reason}"),
        ResetEnd::Nowhere => bail!(
            "the reset was sent, and no hand answers at {hand} or at the factory id and speed. Switch the hand off and on, then look for it with 'handscope scan': the factory id is 1, the speed 115200 baud, the address 192.168.11.210:6000. Its former parameters are in {}",
            report.backup.display()
        ),
        ResetEnd::Found { .. } => {}
    }
    if let Some(why) = &report.not_noted {
        notify(&format!(
            "the files of the hand could not be updated: {why}"
        ));
    }
    let is_reset = report_reset(out, args, &places, &report)?;
    end(is_reset && report.not_noted.is_none())
}

/// Reports the parameters of a hand that answers after the reset. Returns true if they show that it was reset.
fn report_reset(
    out: &mut Out,
    args: &FlashArgs,
    places: &PlacePair,
    report: &ResetReport,
) -> anyhow::Result<bool> {
    let ResetEnd::Found {
        at,
        params,
        left,
        proof,
    } = &report.end
    else {
        return Ok(false);
    };
    let result = if report.is_acknowledged {
        "acknowledged"
    } else {
        "unanswered"
    };
    let place = places.endpoint(*at);
    let names: Vec<String> = left.iter().map(|id| id.name()).collect();
    let names = names.join(", ");
    let sentence = match proof {
        ResetProof::Done => format!("reset ({result}); the hand answers at {place}"),
        ResetProof::Ignored => format!(
            "not reset ({result}): the hand at {place} still holds other values than the factory's in {names}; it ignored the reset, as a whole or in part, or needs a power cycle"
        ),
        ResetProof::Unchanged => format!(
            "not known whether it was reset ({result}): the hand at {place} holds what it held before; either that is what the factory set, or it ignored the reset. The manual prints no factory speeds and forces"
        ),
        ResetProof::NotRead(why) => format!(
            "not known whether it was reset ({result}): the hand answers at {place}, and not everything could be read back: {why}"
        ),
    };
    let object = json!({
        "hand": args.common.hand.to_string(),
        "backup": report.backup,
        "result": result,
        "outcome": proof.name(),
        "words": sentence,
        "left": left,
        "answers_at": place.to_string(),
        "params": params,
    });
    let is_reset = *proof == ResetProof::Done;
    let lines = [sentence, words::backup(&report.backup)];
    if is_reset || args.common.json {
        words::show(out, args.common.json, &object, &lines)?;
    }
    if !is_reset {
        lines.iter().for_each(|line| notify(line));
    }
    Ok(is_reset)
}
