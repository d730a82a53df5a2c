//! Trials and sessions as JSON and as lines for a person. Pure; a contract with scripts.

use crate::app::trial::best::{Score, Spread};
use crate::app::trial::{Criterion, JointMetrics, Kind, Trial, TrialPlan};
use crate::cli::out::Out;
use crate::cli::trial::args::TrialArgs;
use crate::cli::trial::{Outcome, Stop, words};
use crate::hand::Dof;
use serde_json::{Value, json};

/// One trial: `{"trial": {…}}`. What is not known is null.
pub(crate) fn trial_json(trial: &Trial, kept: bool) -> Value {
    let repeat = match trial.kind {
        Kind::Probe => None,
        Kind::Trial { repeat } => Some(repeat),
    };
    json!({"trial": {
        "number": trial.number,
        "kind": if repeat.is_some() { "trial" } else { "probe" },
        "repeat": repeat,
        "speed": trial.setting.speed.get(),
        "force_threshold_g": trial.setting.force.get(),
        "aborted": trial.aborted.map(|why| why.to_string()),
        "samples": kept.then(|| format!("trial-{:03}.csv", trial.number)),
        "rows": trial.recording.rows().len(),
        "rows_lost": trial.recording.lost(),
        "joints": trial.metrics.joints,
    }})
}

/// The last line: `{"session": {…}}`.
pub(crate) fn session_json(
    args: &TrialArgs,
    outcome: &Outcome,
    scores: &[Score],
    found: Option<(Criterion, Option<&Score>)>,
) -> Value {
    let best = found.map(|(criterion, score)| {
        json!({
            "criterion": words(criterion),
            "speed": score.map(|score| score.setting.speed.get()),
            "force_threshold_g": score.map(|score| score.setting.force.get()),
        })
    });
    json!({"session": {
        "hand": args.hand.to_string(),
        "folder": args.out.as_ref().map(|folder| folder.display().to_string()),
        "trials": outcome.trials.len(),
        "aborted": outcome.aborted,
        "stop": outcome.stop.map(stop_json),
        "settings": scores.iter().map(score_json).collect::<Vec<_>>(),
        "best": best,
    }})
}

fn stop_json(stop: Stop) -> Value {
    match stop {
        Stop::Confirmed { after_s } => json!({"confirmed": true, "after_s": after_s}),
        Stop::NotConfirmed | Stop::LinkLost => json!({"confirmed": false, "after_s": null}),
    }
}

fn score_json(score: &Score) -> Value {
    json!({
        "speed": score.setting.speed.get(),
        "force_threshold_g": score.setting.force.get(),
        "trials": score.trials,
        "aborted": score.aborted,
        "clipped": score.clipped,
        "overshoot_g": score.overshoot_g,
        "steady_force_g": score.steady_force_g,
        "time_to_stop_s": score.time_to_stop_s,
    })
}

/// What feedback says of a stop, to follow a sentence.
pub(crate) fn stop_words(stop: Option<Stop>) -> String {
    match stop {
        None => String::new(),
        Some(Stop::Confirmed { after_s }) => {
            format!("; stopped: feedback shows rest after {after_s:.2} s")
        }
        Some(Stop::NotConfirmed) => "; the stop is not confirmed by feedback".into(),
        Some(Stop::LinkLost) => {
            "; the link is gone, so that a stop cannot be confirmed: switch off the 24 V supply if it moves".into()
        }
    }
}

/// The joints that close, in words.
pub(crate) fn joints(plan: &TrialPlan) -> String {
    plan.joints().map(Dof::name).collect::<Vec<_>>().join(", ")
}

/// One line for each joint.
pub(crate) fn trial_lines(trial: &Trial, of: usize) -> Vec<String> {
    let head = format!(
        "trial {} of {of}, speed {}, threshold {} g:",
        trial.number,
        trial.setting.speed.get(),
        trial.setting.force.get()
    );
    if let Some(why) = trial.aborted {
        return vec![format!("{head} ended early: {why}")];
    }
    let joints = trial.metrics.joints.iter();
    joints
        .map(|joint| format!("{head} {}", line(joint)))
        .collect()
}

fn line(joint: &JointMetrics) -> String {
    let number = |value: Option<f64>, digits: usize| {
        value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
    };
    format!(
        "{} contact {} s, peak {} g, overshoot {} g, steady {} g, dead time {} s, {}",
        joint.dof.name(),
        number(joint.time_to_contact_s, 3),
        number(joint.peak_force_g, 0),
        number(joint.overshoot_g, 0),
        number(joint.steady_force_g, 0),
        number(joint.dead_time_s, 3),
        joint.end_status.as_deref().unwrap_or("-"),
    )
}

/// What all trials come to.
pub(crate) fn session_text(
    out: &mut Out,
    outcome: &Outcome,
    scores: &[Score],
    found: Option<(Criterion, Option<&Score>)>,
) -> anyhow::Result<()> {
    let spread = |spread: Option<Spread>| match spread {
        None => "-".to_owned(),
        Some(Spread { median, min, max }) => format!("{median:.0} ({min:.0} to {max:.0})"),
    };
    if outcome.trials.len() > 1 {
        for score in scores {
            out.line(&format!(
                "speed {:4}, threshold {:4} g: overshoot {} g, steady {} g, {} trials",
                score.setting.speed.get(),
                score.setting.force.get(),
                spread(score.overshoot_g),
                spread(score.steady_force_g),
                score.trials,
            ))?;
        }
    }
    if let Some((criterion, Some(score))) = found {
        out.line(&format!(
            "best by {}: speed {}, threshold {} g",
            words(criterion),
            score.setting.speed.get(),
            score.setting.force.get()
        ))?;
    }
    Ok(())
}
