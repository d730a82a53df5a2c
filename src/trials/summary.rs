//! What one trial was and came to, without its samples: a row of `session.toml`, of the window's table, of the report and of
//! the command line's JSON.

use crate::record::Abort;
use crate::trials::measure::metrics::JointMetrics;
use crate::trials::measure::unseen::PeakDoubt;
use crate::trials::plan::TrialSetting;
use crate::trials::recording::TrialRecording;
use serde::{Deserialize, Serialize};

/// The purpose of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrialKind {
    /// Finds the contact, slowly.
    Probe,
    /// Tries a cell of the grid.
    Trial,
}

/// Why a trial or a series ended early. In files it is a sentence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum EarlyEnd {
    /// As it was seen here.
    Here(Abort),
    /// In the words of a file.
    FromFile(String),
}

impl From<String> for EarlyEnd {
    fn from(words: String) -> Self {
        Self::FromFile(words)
    }
}

impl From<EarlyEnd> for String {
    fn from(end: EarlyEnd) -> Self {
        end.to_string()
    }
}

impl std::fmt::Display for EarlyEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Here(why) => why.fmt(f),
            Self::FromFile(words) => f.write_str(words),
        }
    }
}

/// One trial that is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialSummary {
    /// From 1.
    pub number: usize,
    /// Its purpose.
    pub kind: TrialKind,
    /// How often this setting was tried, this one included; `None` for a probe.
    pub repeat: Option<usize>,
    /// Speed and threshold.
    #[serde(flatten)]
    pub setting: TrialSetting,
    /// Why it ended early, if it did.
    pub aborted: Option<EarlyEnd>,
    /// The file of its samples, in the folder of its session.
    pub samples: Option<String>,
    /// Rows that hold readings.
    pub rows: usize,
    /// Rows that had no place.
    pub rows_lost: u64,
    /// The readings stopped at a peak, so that it counts for nothing and was tried again.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub repeated: bool,
    /// The longest time in it in which this program did not run, s.
    #[serde(default)]
    pub stall_s: Option<f64>,
    /// What was measured, joint by joint, in register order.
    #[serde(default, rename = "joint", skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<JointMetrics>,
    /// Keys of a later version, kept as they are.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl TrialSummary {
    /// Whether it looks for the contact.
    pub fn is_probe(&self) -> bool {
        self.kind == TrialKind::Probe
    }

    /// Whether it counts for its setting: looking for the contact does not, nor what was tried again.
    pub fn counts(&self) -> bool {
        !self.is_probe() && !self.repeated
    }

    /// Whether the readings of a joint stopped at its peak.
    pub fn has_gap(&self) -> bool {
        let mut joints = self.joints.iter();
        joints.any(|joint| joint.peak_doubt == Some(PeakDoubt::Gap))
    }

    /// Takes over how many rows a recording holds.
    pub fn count(&mut self, recording: &TrialRecording) {
        (self.rows, self.rows_lost) = (recording.rows().len(), recording.lost());
    }

    /// Its number, what it was for, and its setting.
    pub fn title(&self) -> String {
        let what = match self.kind {
            TrialKind::Probe => "contact sought",
            TrialKind::Trial => "trial",
        };
        format!("{} ({what}): {}", self.number, self.setting)
    }

    /// The name of the file that its samples are written to.
    pub fn samples_file(&self) -> String {
        format!("trial-{:03}.csv", self.number)
    }
}

/// A trial that is over, with everything that was read in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// What it was and came to.
    pub summary: TrialSummary,
    /// What was read.
    pub recording: TrialRecording,
}
