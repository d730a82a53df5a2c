//! Trials and series as JSON, a contract with scripts, and as lines of text. Pure.

use crate::cli::out::Out;
use crate::hand::{Dof, Force, Speed};
use crate::tasks::series::Stop;
use crate::trials::best::{MetricSpread, Score, best, scores};
use crate::trials::columns::COLUMNS;
use crate::trials::{Abort, Criterion, JointMetrics, TrialPlan, TrialSummary};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::PathBuf;

/// The outcome of a series.
pub(crate) struct Outcome {
    pub(crate) hand: String,
    pub(crate) folder: Option<PathBuf>,
    pub(crate) trials: Vec<TrialSummary>,
    pub(crate) aborted: Option<Abort>,
    /// What feedback showed after the stop, if there was one.
    pub(crate) stop: Option<Stop>,
}

impl Outcome {
    /// Why it ended early, in words.
    pub(crate) fn aborted_words(&self) -> Option<String> {
        self.aborted.map(|why| format!("ended early: {why}"))
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

/// The last line: `{"session": {…}}`.
#[derive(Debug, Serialize)]
pub(crate) struct SessionLine<'a> {
    hand: String,
    folder: Option<String>,
    trials: usize,
    aborted: Option<String>,
    stop: Option<StopLine>,
    settings: &'a [Score],
    best: Option<BestLine>,
}

#[derive(Debug, Serialize)]
struct StopLine {
    confirmed: bool,
    after_s: Option<f64>,
}

#[derive(Debug, Serialize)]
struct BestLine {
    criterion: String,
    speed: Option<Speed>,
    force_threshold_g: Option<Force>,
}

impl<'a> SessionLine<'a> {
    /// Of a series that is over.
    pub(crate) fn of(outcome: &Outcome, found: &'a Findings) -> Self {
        let after_s = |stop: Stop| match stop {
            Stop::Confirmed { after } => Some(after.as_secs_f64()),
            Stop::NotConfirmed | Stop::LinkLost => None,
        };
        let setting = found.best.as_ref().map(|score| score.setting);
        Self {
            hand: outcome.hand.clone(),
            folder: outcome
                .folder
                .as_ref()
                .map(|folder| folder.display().to_string()),
            trials: outcome.trials.len(),
            aborted: outcome.aborted_words(),
            stop: outcome.stop.map(|stop| StopLine {
                confirmed: after_s(stop).is_some(),
                after_s: after_s(stop),
            }),
            settings: &found.scores,
            best: found.criterion.map(|criterion| BestLine {
                criterion: criterion.to_string(),
                speed: setting.map(|own| own.speed),
                force_threshold_g: setting.map(|own| own.force),
            }),
        }
    }

    /// As a line.
    pub(crate) fn json(&self) -> Value {
        json!({"session": self})
    }
}

/// What the settings came to, and which is the best, if that was asked.
#[derive(Debug)]
pub(crate) struct Findings {
    pub(crate) scores: Vec<Score>,
    pub(crate) criterion: Option<Criterion>,
    pub(crate) best: Option<Score>,
}

impl Findings {
    /// Of a series that is over.
    pub(crate) fn of(outcome: &Outcome, criterion: Option<Criterion>) -> Self {
        let scores = scores(&outcome.trials);
        let best = criterion.and_then(|criterion| best(&scores, criterion));
        Self {
            best: best.cloned(),
            scores,
            criterion,
        }
    }
}

/// What feedback showed after a stop, to follow a sentence.
pub(crate) fn stop_words(stop: Option<Stop>) -> String {
    match stop {
        None => String::new(),
        Some(Stop::Confirmed { after }) => {
            let after_s = after.as_secs_f64();
            format!("; stopped: feedback shows rest after {after_s:.2} s")
        }
        Some(Stop::NotConfirmed) => "; the stop is not confirmed by feedback".into(),
        Some(Stop::LinkLost) => {
            "; the link is lost, so a stop cannot be confirmed: switch off the 24 V supply if the hand moves".into()
        }
    }
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
    let end = joint.end_status.as_deref().unwrap_or("-");
    format!("{} {}, {end}", joint.dof.name(), values.join(", "))
}

/// The summary of all trials.
pub(crate) fn write_found(out: &mut Out, found: &Findings, trials: usize) -> anyhow::Result<()> {
    let spread = |spread: Option<MetricSpread>| match spread {
        None => "-".to_owned(),
        Some(MetricSpread { median, min, max }) => format!("{median:.0} ({min:.0} to {max:.0})"),
    };
    for score in found.scores.iter().filter(|_| trials > 1) {
        out.line(&format!(
            "speed {:4}, threshold {:4} g: overshoot {} g, steady {} g, {} trials",
            score.setting.speed.get(),
            score.setting.force.get(),
            spread(score.overshoot_g),
            spread(score.steady_force_g),
            score.trials,
        ))?;
    }
    if let (Some(criterion), Some(best)) = (found.criterion, &found.best) {
        out.line(&format!("best by {criterion}: {}", best.setting))?;
    }
    Ok(())
}
