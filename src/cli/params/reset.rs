//! `params reset`: back to the factory parameters, with a backup first, and where the hand answers then.

use crate::cli::out::{Out, end, say};
use crate::cli::params::args::FlashArgs;
use crate::cli::params::reach::{self, Places};
use crate::cli::session;
use crate::params::rows::ParamId;
use crate::tasks::reset::{self, ResetEnd};
use anyhow::bail;
use serde_json::json;

/// Resets. Fails unless the hand is found afterwards and holds the factory parameters.
pub(crate) fn run(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    args.consented(
        "reset returns the hand to its factory parameters, including id, serial speed and IP address",
    )?;
    session::runtime()?.block_on(reset_now(out, args))
}

async fn reset_now(out: &mut Out, args: &FlashArgs) -> anyhow::Result<()> {
    let hand = &args.common.hand;
    let files = args.common.backups()?;
    // Says why, if nobody answers.
    drop(reach::open(hand).await?);
    let places = reset::places(hand);
    let report = reset::reset(&mut Places::default(), &places, &files, |_| ()).await?;
    let backup = report.backup.display();
    let (at, params, left) = match report.end {
        ResetEnd::NotSent(Some(why)) => bail!("not reset, nothing was written: {why}"),
        ResetEnd::NotSent(None) => bail!("not reset, nothing was written"),
        ResetEnd::Refused { reason } => bail!("not reset: {reason}"),
        ResetEnd::Nowhere => bail!(
            "the reset was sent, and no hand answers at {hand} or at the factory id and speed. Switch the hand off and on, then look for it with 'handscope scan': the factory id is 1, the speed 115200 baud, the address 192.168.11.210:6000. Its former parameters are in {backup}"
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
    if args.common.json {
        out.object(&json!({
            "hand": hand.to_string(),
            "backup": report.backup,
            "result": result,
            "answers_at": place.to_string(),
            "params": params,
        }))?;
    } else {
        out.line(&format!("reset ({result}); the hand answers at {place}"))?;
        out.line(&format!("backup: {backup}"))?;
    }
    let is_reset = left
        .iter()
        .all(|id| *id == ParamId::IpAddress || id.is_place() && place != hand);
    if !is_reset {
        say(
            "the hand does not hold the factory parameters: it may need a power cycle, or did not accept the reset",
        );
    }
    end(is_reset)
}
