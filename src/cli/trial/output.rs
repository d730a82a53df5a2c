//! Trials and series as JSON, a contract with scripts, and as lines of text. Pure.

use crate::cli::trial::args::TrialArgs;
use crate::hand::newtons::newtons;
use crate::hand::{Dof, PerDof};
use crate::motion::drive::EndReport;
use crate::trials::best::{MetricSpread, Score, best, scores};
use crate::trials::columns::COLUMNS;
use crate::trials::measure::unseen::PeakDoubt;
use crate::trials::{Criterion, JointMetrics, TrialPlan, TrialSetting, TrialSummary};
use serde_json::{Value, json};

/// A finished series, and the scores of its settings.
pub(crate) struct SeriesResult {
    trials: Vec<TrialSummary>,
    pub(crate) report: EndReport,
    scores: Vec<Score>,
    pub(crate) criterion: Option<Criterion>,
    pub(crate) best: Option<TrialSetting>,
}

impl SeriesResult {
    /// Scores the settings that were tried, and finds the best one if there is a criterion.
    pub(crate) fn of(
        trials: Vec<TrialSummary>,
        report: EndReport,
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

    /// Text about an early end.
    pub(crate) fn aborted_words(&self) -> Option<String> {
        self.report.aborted.map(|why| format!("ended early: {why}"))
    }

    /// Reason why nothing was measured, if no trial has any result.
    pub(crate) fn nothing_words(&self) -> Option<String> {
        let joints = self.trials.iter().flat_map(|trial| &trial.joints);
        let empty = joints.map(|joint| Some((joint.dof, joint.dead_drive, joint.why_empty()?)));
        let mut empty = empty.collect::<Option<Vec<_>>>()?;
        empty.sort_unstable_by_key(|(dof, ..)| dof.index());
        empty.dedup();
        let advice = if empty.iter().any(|(_, is_dead, _)| *is_dead) {
            "; check STATUS, ERROR and the supply, and move the joint from the window"
        } else {
            ""
        };
        let why = empty.iter();
        let why: Vec<String> = why
            .map(|(dof, _, why)| format!("{}: {why}", dof.name()))
            .collect();
        Some(if why.is_empty() {
            "nothing was measured: no trial reached its closing phase".into()
        } else {
            format!("nothing was measured of {}{advice}", why.join("; "))
        })
    }

    /// The last line: `{"session": {…}}`.
    pub(crate) fn json(&self, args: &TrialArgs) -> Value {
        let best = self.criterion.map(|criterion| {
            json!({
                "criterion": criterion.to_string(),
                "speed": self.best.map(|setting| setting.speed),
                "force_threshold_g": self.best.map(|setting| setting.force),
            })
        });
        json!({ "session": {
            "hand": args.series.hand.to_string(),
            "folder": args.series.out.as_ref().map(|folder| folder.display().to_string()),
            "trials": self.trials.len(),
            "aborted": self.aborted_words(),
            "stop": self.report.stop,
            "settings": self.scores,
            "best": best,
        }})
    }

    /// The same as text: the scores if there were several trials, and the best setting.
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

/// Newtons of a gram of each joint; `None` where they are not known.
type NewtonsPerG = PerDof<Option<f64>>;

/// One trial: `{"trial": {…}}`. Unknown values are null.
pub(crate) fn trial_json(trial: &TrialSummary, per_g: &NewtonsPerG) -> Value {
    let mut line = json!(trial);
    if let Some(line) = line.as_object_mut() {
        // In a file each joint is a separate table `joint`.
        let mut joints = line.remove("joint").unwrap_or_else(|| json!([]));
        let rows = joints.as_array_mut().into_iter().flatten();
        for (row, joint) in rows.zip(&trial.joints) {
            let in_newtons = |force_g: Option<f64>| Some(newtons(force_g?, per_g[joint.dof]?));
            if let Some(row) = row.as_object_mut() {
                let (peak, steady) = (joint.peak_force_g, joint.steady_force_g);
                row.insert("peak_force_n".into(), json!(in_newtons(peak)));
                row.insert("steady_force_n".into(), json!(in_newtons(steady)));
            }
        }
        line.insert("joints".into(), joints);
    }
    json!({"trial": line})
}

/// Names of the joints that close.
pub(crate) fn joints(plan: &TrialPlan) -> String {
    plan.joints().map(Dof::name).collect::<Vec<_>>().join(", ")
}

/// One line per joint.
pub(crate) fn trial_lines(trial: &TrialSummary, of: usize, per_g: &NewtonsPerG) -> Vec<String> {
    let head = format!("trial {} of {of}, {}:", trial.number, trial.setting);
    if let Some(why) = &trial.aborted {
        return vec![format!("{head} ended early: {why}")];
    }
    let joints = trial.joints.iter();
    let joints = joints.map(|joint| format!("{head} {}", joint_words(joint, per_g[joint.dof])));
    joints.chain(disturbed(trial)).collect()
}

/// Reason why a trial does not count, or why this program stalled during it.
fn disturbed(trial: &TrialSummary) -> Option<String> {
    let busy = trial.stall_s.map(|stall_s| {
        format!("this computer was busy: the program did not run for {stall_s:.2} s")
    });
    let number = trial.number;
    match (trial.repeated, busy) {
        (false, None) => None,
        (false, Some(busy)) => Some(format!("trial {number}: {busy}")),
        (true, busy) => {
            let why = busy.unwrap_or_else(|| "the hand sent none for a while".into());
            Some(format!(
                "trial {number} does not count and is repeated: the readings stopped at its peak; {why}"
            ))
        }
    }
}

/// `per_g` is the newtons of a gram, if they are known.
fn joint_words(joint: &JointMetrics, per_g: Option<f64>) -> String {
    let values = COLUMNS.iter().filter_map(|column| {
        let word = column.word?;
        let in_newtons = column.newtons(joint, per_g);
        let in_newtons = in_newtons.map(|newtons| format!(" ({newtons:.1} N)"));
        Some(format!(
            "{word} {} {}{}",
            column.text(joint),
            column.unit,
            in_newtons.unwrap_or_default()
        ))
    });
    let values: Vec<String> = values.collect();
    let end = if joint.dead_drive {
        "dead drive: it never moved"
    } else {
        joint.end_status.as_deref().unwrap_or("-")
    };
    let doubt = match joint.peak_doubt {
        None => "",
        Some(PeakDoubt::Gap) => "; the readings stopped at the peak, which may have been higher",
        Some(PeakDoubt::Brief) => "; the force fell at once, and may have been higher for a moment",
    };
    format!("{} {}, {end}{doubt}", joint.dof.name(), values.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Force, Speed};
    use crate::trials::TrialKind;
    use crate::trials::measure::curve::JointCurves;
    use crate::trials::measure::metrics::{DwellSpan, measure_joint};

    fn trial(stops_s: &[(Dof, Option<f64>)]) -> TrialSummary {
        let span = DwellSpan {
            slow_s: None,
            end_s: 1.0,
            threshold_g: 200.0,
        };
        let joints = stops_s.iter().map(|(dof, stop_s)| JointMetrics {
            time_to_stop_s: *stop_s,
            ..measure_joint(*dof, &JointCurves::default(), span)
        });
        TrialSummary {
            number: 1,
            kind: TrialKind::Trial,
            repeat: Some(1),
            setting: TrialSetting {
                speed: Speed::MAX,
                force: Force::GENTLE,
            },
            aborted: None,
            samples: None,
            rows: 0,
            rows_lost: 0,
            repeated: false,
            stall_s: None,
            joints: joints.collect(),
            others: toml::Table::new(),
        }
    }

    const NONE: NewtonsPerG = PerDof::splat(None);

    #[test]
    fn newtons_stand_beside_the_grams_of_joints_that_were_measured_and_replace_none() {
        let mut trial = trial(&[(Dof::Index, Some(0.5)), (Dof::Ring, Some(0.5))]);
        for joint in &mut trial.joints {
            (joint.peak_force_g, joint.steady_force_g) = (Some(566.0), Some(465.0));
        }
        let per_g = PerDof::from_fn(|dof| (dof == Dof::Index).then_some(0.007));
        let lines = trial_lines(&trial, 1, &per_g);
        assert!(lines[0].contains("peak 566 g (4.0 N), steady 465 g (3.3 N)"));
        assert!(lines[1].contains("peak 566 g, steady 465 g"), "{lines:?}");
        let json = trial_json(&trial, &per_g)["trial"]["joints"].clone();
        assert_eq!(json[0]["peak_force_g"], 566.0);
        assert_eq!(json[0]["peak_force_n"], 3.962);
        assert_eq!(json[0]["steady_force_n"], 3.255);
        assert_eq!(json[1]["peak_force_n"], Value::Null);
    }

    fn words(trials: Vec<TrialSummary>) -> Option<String> {
        let report = EndReport {
            aborted: None,
            stop: None,
        };
        SeriesResult::of(trials, report, None).nothing_words()
    }

    #[test]
    fn trials_of_which_nothing_is_known_are_no_result_and_the_joints_are_named() {
        let none = trial(&[(Dof::Index, None), (Dof::Ring, None)]);
        let said = words(vec![none.clone(), none.clone()]).unwrap();
        assert_eq!(
            said,
            "nothing was measured of ring: too few force readings; index: too few force readings"
        );
        let some = trial(&[(Dof::Index, Some(0.5)), (Dof::Ring, None)]);
        assert_eq!(words(vec![none, some]), None);
    }

    #[test]
    fn a_trial_that_is_repeated_says_why() {
        let mut gap = trial(&[]);
        (gap.repeated, gap.stall_s) = (true, Some(0.31));
        let said = trial_lines(&gap, 1, &NONE).join(" ");
        assert!(said.contains("does not count and is repeated"), "{said}");
        assert!(said.contains("did not run for 0.31 s"), "{said}");
        gap.stall_s = None;
        let said = trial_lines(&gap, 1, &NONE).join(" ");
        assert!(said.contains("the hand sent none for a while"), "{said}");
    }
}
