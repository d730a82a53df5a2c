//! A series of trials in a folder of its own, readable without this program.
//!
//! | file | what |
//! |---|---|
//! | `session.toml` | what was planned, the hand, and for each trial its setting and what was measured ([`TrialSessionFile`]) |
//! | `trial-001.csv` … | what was read, [`crate::trials::recording::csv`]: `time_s` from the closing command, an empty cell where nothing was read |
//! | `report.html` | all of it for the user, in one file without links ([`crate::trials::report`]) |
//!
//! A value that is not known has no key in TOML. Keys of a later version survive.

#[cfg(test)]
pub(crate) mod session_tests;

use crate::record::QuirkSheet;
use crate::store::calendar::day;
use crate::store::{FileCause, FileError, FileText};
use crate::trials::plan::TrialPlan;
use crate::trials::summary::{EarlyEnd, TrialSummary};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;
use std::time::Duration;

/// What a session says it is.
pub const FORMAT: &str = "handscope-trials";
/// The version that is written, and the newest that is read.
pub const VERSION: i64 = 1;
/// A thousand trials of six joints are a tenth of this; anything longer is not ours.
const FILE_LEN_MAX: u64 = 64 * 1024 * 1024;
/// The name of the file that says what a session is.
pub const SESSION_FILE: &str = "session.toml";

/// What is known of a session besides its trials.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SessionHead {
    /// The endpoint.
    pub hand: String,
    /// Whether it is the built-in hand.
    pub simulated: bool,
    /// Day of its beginning, `2026-11-21`, in universal time.
    pub day: String,
    /// Its beginning, seconds since 1970.
    pub begun_unix_s: u64,
    /// In the words of the user.
    #[serde(default)]
    pub note: String,
    /// Words to find it by.
    #[serde(default)]
    pub tags: Vec<String>,
    /// Why it ended early.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aborted: Option<EarlyEnd>,
    pub plan: TrialPlan,
    /// What was found about the hand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quirks: Option<QuirkSheet>,
    /// Keys of a later version, kept as they are.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl SessionHead {
    /// Of a session that begins now, `now` since 1970, on a hand that is still to be named. Note and tags of the plan are
    /// the session's; what this version does not know of the plan was not done.
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

/// `session.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialSessionFile {
    /// [`FORMAT`].
    pub format: String,
    /// [`VERSION`].
    pub version: i64,
    /// All but the trials.
    #[serde(flatten)]
    pub head: SessionHead,
    /// The trials in their order.
    #[serde(default, rename = "trial", skip_serializing_if = "Vec::is_empty")]
    pub trials: Vec<TrialSummary>,
}

/// Reads a session's `session.toml`.
///
/// # Errors
/// What the system or the reader of the format says; another format, or a later version.
pub fn load(folder: &Path) -> Result<TrialSessionFile, FileError> {
    let path = folder.join(SESSION_FILE);
    let text = crate::store::read_text(&path, FILE_LEN_MAX)?;
    let text = text.ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))?;
    let file: TrialSessionFile = FileText::plain(&text).parse()?;
    if file.format != FORMAT {
        let (got, wanted) = (file.format, FORMAT);
        return Err(FileCause::Format { got, wanted }.into());
    }
    if file.version > VERSION {
        return Err(FileCause::Version { got: file.version }.into());
    }
    Ok(file)
}
