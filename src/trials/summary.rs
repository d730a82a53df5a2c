//! One finished trial without its samples: a row of `session.toml`, of the window's table, of the report and of the command
//! line's JSON.

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
    /// Tries one cell of the grid.
    Trial,
}

/// Reason for the early end of a trial or series. Stored as a sentence in files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum EarlyEnd {
    /// Observed in this run.
    Here(Abort),
    /// Text from a file.
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

/// One finished trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialSummary {
    /// Number in the session, from 1.
    pub number: usize,
    pub kind: TrialKind,
    /// Number of this trial among those of its setting, from 1; `None` for a probe.
    pub repeat: Option<usize>,
    /// Speed and threshold.
    #[serde(flatten)]
    pub setting: TrialSetting,
    /// Reason for an early end.
    pub aborted: Option<EarlyEnd>,
    /// File of the samples in the session folder.
    pub samples: Option<String>,
    /// Number of recorded rows.
    pub rows: usize,
    /// Rows dropped for lack of space.
    pub rows_lost: u64,
    /// The readings have a gap at a peak: the trial does not count and was repeated.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub repeated: bool,
    /// Longest stall of this program during the trial, s.
    #[serde(default)]
    pub stall_s: Option<f64>,
    /// Metrics of the joints, in register order.
    #[serde(default, rename = "joint", skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<JointMetrics>,
    /// Keys of a later version, preserved.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl TrialSummary {
    /// True for a probe.
    pub fn is_probe(&self) -> bool {
        self.kind == TrialKind::Probe
    }

    /// True if it counts for its setting: probes and repeated trials do not.
    pub fn counts(&self) -> bool {
        !self.is_probe() && !self.repeated
    }

    /// True if the readings of a joint have a gap at its peak.
    pub fn has_gap(&self) -> bool {
        let mut joints = self.joints.iter();
        joints.any(|joint| joint.peak_doubt == Some(PeakDoubt::Gap))
    }

    /// Copies the row counts of a recording.
    pub fn count(&mut self, recording: &TrialRecording) {
        (self.rows, self.rows_lost) = (recording.rows().len(), recording.lost());
    }

    /// Its number, purpose and setting.
    pub fn title(&self) -> String {
        let what = match self.kind {
            TrialKind::Probe => "contact sought",
            TrialKind::Trial => "trial",
        };
        format!("{} ({what}): {}", self.number, self.setting)
    }

    /// Name of its samples file.
    pub fn samples_file(&self) -> String {
        format!("trial-{:03}.csv", self.number)
    }
}

/// A finished trial with all its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    pub summary: TrialSummary,
    pub recording: TrialRecording,
}
