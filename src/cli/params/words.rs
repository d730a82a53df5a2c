//! What is said of parameters, in sentences; and where the records lie. Reads and writes nothing.

use crate::app::config;
use crate::app::params::danger::Danger;
use crate::app::params::plan::{RowEnd, RowVerdict};
use crate::app::params::record::{Record, folder_beside};
use crate::app::params::table::Value;
use crate::cli::params::args::Common;
use crate::link::Saved;
use anyhow::Context as _;

/// This program's record of the hand.
pub(crate) fn record(common: &Common) -> anyhow::Result<Record> {
    let folder = match &common.folder {
        Some(folder) => folder.clone(),
        None => {
            let settings = config::default_path();
            let settings = settings
                .context("no home folder for records and backups: name one with --folder")?;
            folder_beside(&settings)
        }
    };
    Ok(Record::new(&folder, &common.hand))
}

/// A value, or that it is not known.
pub(crate) fn or_dash(value: Option<Value>) -> String {
    value.map_or_else(|| "-".into(), |value| value.to_string())
}

/// What a person should know before a hand wakes up so.
pub(crate) fn danger(danger: &Danger) -> String {
    let joint = danger.dof.name();
    let (speed, force) = (danger.speed, danger.force_g);
    let strong = if danger.is_above_rated() {
        ", above the rated grip of 2000 g"
    } else {
        ""
    };
    format!(
        "{joint} would wake up with speed {speed} and a force threshold of {force} g{strong}; on a rigid block such a finger was measured to press {:.0} g harder than its threshold",
        danger.overshoot_g
    )
}

/// What came of a row, in words.
pub(crate) fn verdict(end: &RowEnd) -> String {
    match &end.verdict {
        RowVerdict::Applied => "applied".into(),
        RowVerdict::Refused { reason } => format!("refused: {reason}"),
        RowVerdict::Dropped => {
            "not applied: the hand did not object, and keeps what it held".into()
        }
        RowVerdict::Altered => "not applied: the hand took another value".into(),
        RowVerdict::Unverified(why) => format!("not known: {why}"),
        RowVerdict::NotSent(why) => format!("not written: {why}"),
    }
}

/// What is known of a SAVE, in one sentence.
pub(crate) fn saved(saved: &Saved) -> String {
    match saved {
        Saved::Confirmed => "saved: the hand says that its parameters are in flash".into(),
        Saved::ReadBack => "saved as far as this wire tells: the hand acknowledged it and holds the same parameters; only the next power-up shows what is in flash".into(),
        Saved::Failed { code } => format!(
            "not saved: the hand says that writing its flash failed (code {code}); what was in flash before should still be there"
        ),
        Saved::Unknown { why } => format!(
            "whether it was saved is not known: {why}; switch the hand off and on, then compare with 'handscope params diff'"
        ),
        Saved::Refused { reason } => format!("not saved: {reason}"),
        Saved::NotSent(why) => format!("not saved, nothing was written: {why}"),
    }
}
