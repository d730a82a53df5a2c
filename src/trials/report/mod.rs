//! A session as one self-contained HTML page for the user, without scripts: parameters, metrics, curves, the hand's quirks. Its
//! layout is `report.html` and `plot.svg` beside this file. Writes no file itself.

pub(crate) mod overlay;
pub(crate) mod plot;

use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::best::{Criterion, MetricSpread, Score, best, scores};
use crate::trials::columns::{COLUMNS, Metric, number};
use crate::trials::measure::curve::{JointCurves, TimeSeries};
use crate::trials::plan::{Approach, TrialPlan};
use crate::trials::recording::{TrialEvent, TrialRecording, seconds};
use crate::trials::report::overlay::{BEFORE_S, Overlay};
use crate::trials::report::plot::Plot;
use crate::trials::session::{SessionHead, TrialSessionFile};
use crate::trials::summary::TrialSummary;
use askama::Template;

/// Maximum number of trials with curves; the samples of the others are in files beside the page.
pub const DRAWN_MAX: usize = 60;

/// The report of a session, drawn trial by trial.
#[derive(Debug, Default)]
pub struct Report {
    criterion: Option<Criterion>,
    curves: Vec<TrialCurves>,
    left_out: usize,
    overlay: Overlay,
}

#[derive(Debug)]
struct TrialCurves {
    title: String,
    plots: [Plot; 3],
}

/// Data for the template.
#[derive(Template)]
#[template(path = "report.html", config = "trials/report/askama.toml")]
struct TrialReportPage<'a> {
    head: &'a SessionHead,
    plan: &'a TrialPlan,
    trials: &'a [TrialSummary],
    scores: &'a [Score],
    criterion: Option<Criterion>,
    report: &'a Report,
}

impl Report {
    /// An empty report. It names the best setting by `criterion`.
    pub fn new(criterion: Option<Criterion>) -> Self {
        Self {
            criterion,
            ..Self::default()
        }
    }

    /// Draws the curves of a trial.
    pub fn add(&mut self, trial: &TrialSummary, recording: &TrialRecording) {
        self.overlay.add(trial, recording);
        if self.curves.len() >= DRAWN_MAX {
            self.left_out += 1;
            return;
        }
        self.curves.push(TrialCurves {
            title: trial.title(),
            plots: plots(trial, recording),
        });
    }

    /// Renders the page of the session.
    ///
    /// # Errors
    /// A template error.
    pub fn html(&self, session: &TrialSessionFile) -> Result<String, askama::Error> {
        let page = TrialReportPage {
            head: &session.head,
            plan: &session.head.plan,
            trials: &session.trials,
            scores: &scores(&session.trials),
            criterion: self.criterion,
            report: self,
        };
        // Control characters other than line breaks are not allowed in a page.
        let is_control = |letter: char| letter.is_control() && letter != '\n';
        Ok(page.render()?.replace(is_control, "\u{FFFD}"))
    }
}

impl TrialReportPage<'_> {
    fn angles(&self, angles: &PerDof<Option<Angle>>) -> String {
        let word = |(dof, angle): (Dof, &Option<Angle>)| {
            angle.map(|angle| format!("{} {}", dof.name(), angle.get()))
        };
        angles
            .iter()
            .filter_map(word)
            .collect::<Vec<_>>()
            .join(", ")
    }

    fn known(&self, value: &Option<u8>) -> String {
        number(value.map(f64::from), 0)
    }

    fn spread(&self, spread: &Option<MetricSpread>, digits: usize) -> String {
        match spread {
            None => "-".into(),
            Some(MetricSpread { median, min, max }) => {
                format!("{median:.digits$} ({min:.digits$} to {max:.digits$})")
            }
        }
    }

    fn best(&self, criterion: &Criterion) -> Option<&Score> {
        best(self.scores, *criterion)
    }

    fn speeds(&self) -> Vec<Speed> {
        let mut speeds: Vec<Speed> = self.scores.iter().map(|own| own.setting.speed).collect();
        speeds.sort_unstable();
        speeds.dedup();
        speeds
    }

    fn forces(&self) -> Vec<Force> {
        let mut forces: Vec<Force> = self.scores.iter().map(|own| own.setting.force).collect();
        forces.sort_unstable();
        forces.dedup();
        forces
    }

    fn overshoot(&self, speed: &Speed, force: &Force) -> String {
        let of = |own: &&Score| own.setting.speed == *speed && own.setting.force == *force;
        let score = self.scores.iter().find(of);
        number(
            score
                .and_then(|own| own.overshoot_g)
                .map(|over| over.median),
            0,
        )
    }
}

fn plots(trial: &TrialSummary, recording: &TrialRecording) -> [Plot; 3] {
    let zero = recording.zero();
    let last = recording.rows().last();
    let last_s = last.map_or(0.0, |row| seconds(zero, row.at));
    let joints = trial.joints.iter().map(|joint| joint.dof);
    let all: Vec<(Dof, JointCurves)> = joints
        .map(|dof| (dof, JointCurves::of(recording, dof)))
        .collect();
    let plot = |name, pick: fn(&JointCurves) -> &TimeSeries| {
        let mut plot = Plot::new(name, -BEFORE_S, last_s);
        for (dof, curves) in &all {
            plot.add(dof.index(), &pick(curves).from(-BEFORE_S));
        }
        for mark in recording.marks() {
            if !matches!(mark.what, TrialEvent::Prepare | TrialEvent::Limits) {
                plot.mark(seconds(zero, mark.at), mark.what.name());
            }
        }
        plot
    };
    let mut force = plot("Force, g", |curves| &curves.force);
    force.set_level(trial.setting.force.get().into());
    [
        force,
        plot("Angle", |curves| &curves.angle),
        plot("Current, mA", |curves| &curves.current),
    ]
}
