//! The forces of several trials in one plot of a session page. Measures nothing.

use crate::hand::Dof;
use crate::trials::measure::curve::{JointCurves, TimeSeries};
use crate::trials::plan::TrialSetting;
use crate::trials::recording::TrialRecording;
use crate::trials::report::plot::{Plot, STROKES};
use crate::trials::summary::TrialSummary;

/// Time shown before the command, s.
pub(crate) const BEFORE_S: f64 = 0.5;
/// Maximum number of lines in the plot; more would be unreadable.
const LINES_MAX: usize = 24;

#[derive(Debug)]
struct ForceLine {
    setting: TrialSetting,
    dof: Dof,
    force: TimeSeries,
}

/// The lines of the plot.
#[derive(Debug, Default)]
pub(crate) struct Overlay {
    lines: Vec<ForceLine>,
    /// Lines dropped beyond [`LINES_MAX`].
    pub(crate) left_out: usize,
}

impl Overlay {
    /// Adds the forces of a trial, up to [`LINES_MAX`] lines.
    pub(crate) fn add(&mut self, trial: &TrialSummary, recording: &TrialRecording) {
        for joint in &trial.joints {
            if self.lines.len() >= LINES_MAX {
                self.left_out += 1;
                continue;
            }
            let force = JointCurves::of(recording, joint.dof).force;
            self.lines.push(ForceLine {
                setting: trial.setting,
                dof: joint.dof,
                force: force.from(-BEFORE_S),
            });
        }
    }

    /// All lines in one plot; `None` for fewer than two.
    pub(crate) fn plot(&self) -> Option<Plot> {
        if self.lines.len() < 2 {
            return None;
        }
        let ends = self
            .lines
            .iter()
            .filter_map(|own| own.force.points().last());
        let to_s = ends.map(|point| point.t).fold(0.0, f64::max);
        let mut plot = Plot::new("Force, g", -BEFORE_S, to_s);
        for own in &self.lines {
            plot.add(self.key(own).0, &own.force);
        }
        Some(plot)
    }

    /// The legend: a stroke per joint, or per setting if only one joint was tried.
    pub(crate) fn keys(&self) -> Vec<(usize, String)> {
        let mut keys: Vec<(usize, String)> = self.lines.iter().map(|own| self.key(own)).collect();
        keys.sort();
        keys.dedup();
        keys
    }

    fn key(&self, own: &ForceLine) -> (usize, String) {
        if self.lines.iter().any(|other| other.dof != own.dof) {
            return (own.dof.index(), own.dof.name().to_owned());
        }
        let mut settings: Vec<TrialSetting> = self.lines.iter().map(|own| own.setting).collect();
        settings.sort_unstable();
        settings.dedup();
        let at = settings.binary_search(&own.setting).unwrap_or_default();
        (at % STROKES, own.setting.to_string())
    }
}
