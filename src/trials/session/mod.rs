//! A session: a series of trials in its own folder, readable without this program.
//!
//! | file | what |
//! |---|---|
//! | `session.toml` | the plan, the hand, and for each trial its setting and metrics ([`TrialSessionFile`]) |
//! | `trial-001.csv` … | the readings ([`crate::trials::recording::csv`]): `time_s` from the closing command, empty cells for missing values |
//! | `report.html` | all of it for the user, in one self-contained file ([`crate::trials::report`]) |
//!
//! An unknown value has no key in TOML. Keys of a later version are preserved.

#[cfg(test)]
pub(crate) mod session_tests;

use crate::record::QuirkSheet;
use crate::store::calendar::day;
use crate::store::{FileCause, FileError, FileText, toml_file};
use crate::trials::plan::TrialPlan;
use crate::trials::summary::{EarlyEnd, TrialSummary};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::time::Duration;

/// The `format` value of a session file.
pub const FORMAT: &str = "handscope-trials";
/// The version written, and the newest that can be read.
pub const VERSION: i64 = 1;
/// A thousand trials of six joints are a tenth of this; a larger file is not a session.
const FILE_LEN_MAX: u64 = 64 * 1024 * 1024;
/// The main file of a session.
pub const SESSION_FILE: &str = "session.toml";

/// All facts of a session except its trials.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SessionHead {
    /// The hand, as an endpoint.
    pub hand: String,
    /// True for the built-in hand.
    pub simulated: bool,
    /// Date of its start in UTC, `2026-11-21`.
    pub day: String,
    /// Its start, seconds since 1970.
    pub begun_unix_s: u64,
    /// The user's text.
    #[serde(default)]
    pub note: String,
    /// Search terms.
    #[serde(default)]
    pub tags: Vec<String>,
    /// Reason for an early end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aborted: Option<EarlyEnd>,
    pub plan: TrialPlan,
    /// Findings about the hand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quirks: Option<QuirkSheet>,
    /// Keys of a later version, preserved.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl SessionHead {
    /// The head of a session that starts now, `now` since 1970; the hand is filled in later. Note and tags move from the plan to the
    /// session; keys of the plan that this version does not know are dropped, since they had no effect.
    pub fn begin(mut plan: TrialPlan, now: Duration) -> Self {
        plan.others.clear();
        Self {
            day: day(now),
            begun_unix_s: now.as_secs(),
            note: std::mem::take(&mut plan.note),
            tags: std::mem::take(&mut plan.tags),
            plan,
            ..Self::default()
        }
    }
}

/// The content of `session.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialSessionFile {
    /// [`FORMAT`].
    pub format: String,
    /// [`VERSION`].
    pub version: i64,
    /// All fields except the trials.
    #[serde(flatten)]
    pub head: SessionHead,
    /// The trials in order.
    #[serde(default, rename = "trial", skip_serializing_if = "Vec::is_empty")]
    pub trials: Vec<TrialSummary>,
}

/// Reads a session's `session.toml`.
///
/// # Errors
/// An I/O or parse error; another format, or a later version.
pub fn load(folder: &Path) -> Result<TrialSessionFile, FileError> {
    let path = folder.join(SESSION_FILE);
    let file = toml_file::load(&path, FILE_LEN_MAX, |text| {
        FileText::plain(text).parse::<TrialSessionFile>()
    })?;
    if file.format != FORMAT {
        let (got, wanted) = (file.format, FORMAT);
        return Err(FileCause::Format { got, wanted }.into());
    }
    if file.version > VERSION {
        return Err(FileCause::Version { got: file.version }.into());
    }
    Ok(file)
}
