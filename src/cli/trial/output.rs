//! Trials and series as JSON, a contract with scripts, and as lines of text. Pure.

use crate::cli::trial::args::TrialArgs;
use crate::hand::Dof;
use crate::link::Stop;
use crate::tasks::series::SeriesReport;
use crate::trials::best::{MetricSpread, Score, best, scores};
use crate::trials::columns::COLUMNS;
use crate::trials::{Criterion, JointMetrics, TrialPlan, TrialSetting, TrialSummary};
use serde_json::{Value, json};

/// A series that is over, and what its settings came to.
pub(crate) struct Outcome {
    trials: Vec<TrialSummary>,
    pub(crate) report: SeriesReport,
    scores: Vec<Score>,
    pub(crate) criterion: Option<Criterion>,
    pub(crate) best: Option<TrialSetting>,
}

impl Outcome {
    /// Scores the settings that were tried, and finds the best if a criterion asks for it.
    pub(crate) fn of(
        trials: Vec<TrialSummary>,
        report: SeriesReport,
        criterion: Option<Criterion>,
    ) -> Self {
        let scores = scores(&trials);
        let best = criterion.and_then(|criterion| best(&scores, criterion));
        Self {
            best: best.map(|score| score.setting),
            trials,
            report,
            scores,
            criterion,
        }
    }

    /// Why it ended early, in words.
    pub(crate) fn aborted_words(&self) -> Option<String> {
        self.report.aborted.map(|why| format!("ended early: {why}"))
    }

    /// The joints of which nothing was measured because none of their trials moved them, if no joint at all moved.
    pub(crate) fn dead_words(&self) -> Option<String> {
        let joints = || self.trials.iter().flat_map(|trial| &trial.joints);
        let are_dead = joints().next().is_some() && joints().all(|joint| joint.dead_drive);
        let mut names: Vec<&str> = joints().map(|joint| joint.dof.name()).collect();
        names.sort_unstable();
        names.dedup();
        are_dead.then(|| {
            format!(
                "nothing was measured: told to close, {} never moved; look at STATUS, ERROR and the supply, and move the joint from the window",
                names.join(", ")
            )
        })
    }

    /// The last line: `{"session": {…}}`.
    pub(crate) fn json(&self, args: &TrialArgs) -> Value {
        let stop = self.report.stop.map(|stop| {
            let after_s = match stop {
                Stop::Confirmed { after } => Some(after.as_secs_f64()),
                Stop::NotConfirmed | Stop::LinkLost => None,
            };
            json!({ "confirmed": after_s.is_some(), "after_s": after_s })
        });
        let best = self.criterion.map(|criterion| {
            json!({
                "criterion": criterion.to_string(),
                "speed": self.best.map(|setting| setting.speed),
                "force_threshold_g": self.best.map(|setting| setting.force),
            })
        });
        json!({ "session": {
            "hand": args.hand.to_string(),
            "folder": args.out.as_ref().map(|folder| folder.display().to_string()),
            "trials": self.trials.len(),
            "aborted": self.aborted_words(),
            "stop": stop,
            "settings": self.scores,
            "best": best,
        }})
    }

    /// The same for people: the settings, where there were several trials, and the best.
    pub(crate) fn lines(&self) -> Vec<String> {
        let spread = |spread: Option<MetricSpread>| match spread {
            None => "-".to_owned(),
            Some(MetricSpread { median, min, max }) => {
                format!("{median:.0} ({min:.0} to {max:.0})")
            }
        };
        let scores = self.scores.iter().filter(|_| self.trials.len() > 1);
        let scores = scores.map(|score| {
            format!(
                "speed {:4}, threshold {:4} g: overshoot {} g, steady {} g, {} trials",
                score.setting.speed.get(),
                score.setting.force.get(),
                spread(score.overshoot_g),
                spread(score.steady_force_g),
                score.trials,
            )
        });
        let best = self.criterion.zip(self.best);
        let best = best.map(|(criterion, setting)| format!("best by {criterion}: {setting}"));
        scores.chain(best).collect()
    }
}

/// One trial: `{"trial": {…}}`. What is not known is null.
pub(crate) fn trial_json(trial: &TrialSummary) -> Value {
    let mut line = json!(trial);
    if let Some(line) = line.as_object_mut() {
        // In a file each joint is a table `joint` of its own.
        let joints = line.remove("joint").unwrap_or_else(|| json!([]));
        line.insert("joints".into(), joints);
    }
    json!({"trial": line})
}

/// The joints that close, in words.
pub(crate) fn joints(plan: &TrialPlan) -> String {
    plan.joints().map(Dof::name).collect::<Vec<_>>().join(", ")
}

/// One line for each joint.
pub(crate) fn trial_lines(trial: &TrialSummary, of: usize) -> Vec<String> {
    let head = format!("trial {} of {of}, {}:", trial.number, trial.setting);
    if let Some(why) = &trial.aborted {
        return vec![format!("{head} ended early: {why}")];
    }
    let joints = trial.joints.iter();
    joints
        .map(|joint| format!("{head} {}", joint_words(joint)))
        .collect()
}

fn joint_words(joint: &JointMetrics) -> String {
    let values = COLUMNS.iter().filter_map(|column| {
        let word = column.word?;
        Some(format!("{word} {} {}", column.text(joint), column.unit))
    });
    let values: Vec<String> = values.collect();
    let end = if joint.dead_drive {
        "dead drive: it never moved"
    } else {
        joint.end_status.as_deref().unwrap_or("-")
    };
    format!("{} {}, {end}", joint.dof.name(), values.join(", "))
}
