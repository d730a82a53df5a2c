//! The best setting by a stated criterion, over all its trials. Pure.

use crate::hand::statistics::median;
use crate::trials::measure::metrics::JointMetrics;
use crate::trials::plan::TrialSetting;
use crate::trials::summary::TrialSummary;
use serde::Serialize;

/// A criterion for settings. A setting counts if every trial of it completed, met the object with every joint, and stayed within
/// the bounds of the criterion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Criterion {
    /// Least overshoot with at least this steady force, g.
    LeastOvershoot {
        /// Smallest steady force, g.
        steady_g: f64,
    },
    /// Shortest time to the stop, with at most this overshoot and at least this steady force, g.
    Fastest {
        /// Largest overshoot, g.
        overshoot_g: f64,
        /// Smallest steady force, g.
        steady_g: f64,
    },
}

impl std::fmt::Display for Criterion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::LeastOvershoot { steady_g } => write!(
                f,
                "least overshoot with a steady force of {steady_g} g or more"
            ),
            Self::Fastest {
                overshoot_g,
                steady_g,
            } => write!(
                f,
                "shortest time to the stop with an overshoot of {overshoot_g} g or less and a steady force of {steady_g} g or more"
            ),
        }
    }
}

/// Median, lowest and highest of a metric over repeats and joints.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MetricSpread {
    pub median: f64,
    pub min: f64,
    pub max: f64,
}

impl MetricSpread {
    /// `None` without values.
    pub fn of(values: &[f64]) -> Option<Self> {
        Some(Self {
            median: median(values)?,
            min: values.iter().copied().reduce(f64::min)?,
            max: values.iter().copied().reduce(f64::max)?,
        })
    }
}

/// Results of the trials of one setting. A spread is `None` unless every joint of every trial has a value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Score {
    #[serde(flatten)]
    pub setting: TrialSetting,
    pub trials: usize,
    /// Trials that ended early.
    pub aborted: usize,
    /// Overshoot, g.
    pub overshoot_g: Option<MetricSpread>,
    /// Steady force, g.
    pub steady_force_g: Option<MetricSpread>,
    /// Time to the stop, s.
    pub time_to_stop_s: Option<MetricSpread>,
    /// True if a peak exceeded the sensor's range.
    pub clipped: bool,
}

/// The scores of all settings, in the order of their first trial; probes do not count.
pub fn scores<'a>(trials: impl IntoIterator<Item = &'a TrialSummary>) -> Vec<Score> {
    let mut by_setting: Vec<(TrialSetting, Vec<&TrialSummary>)> = Vec::new();
    for trial in trials.into_iter().filter(|trial| trial.counts()) {
        match by_setting.iter_mut().find(|(own, _)| *own == trial.setting) {
            Some((_, all)) => all.push(trial),
            None => by_setting.push((trial.setting, vec![trial])),
        }
    }
    let score = |(setting, trials): &(TrialSetting, Vec<&TrialSummary>)| score(*setting, trials);
    by_setting.iter().map(score).collect()
}

fn score(setting: TrialSetting, trials: &[&TrialSummary]) -> Score {
    let joints = || trials.iter().flat_map(|trial| &trial.joints);
    let spread = |value: fn(&JointMetrics) -> Option<f64>| {
        let values: Option<Vec<f64>> = joints().map(value).collect();
        MetricSpread::of(&values?)
    };
    Score {
        setting,
        trials: trials.len(),
        aborted: trials.iter().filter(|own| own.aborted.is_some()).count(),
        overshoot_g: spread(|joint| joint.overshoot_g),
        steady_force_g: spread(|joint| joint.steady_force_g),
        time_to_stop_s: spread(|joint| joint.time_to_stop_s),
        clipped: joints().any(|joint| joint.clipped == Some(true)),
    }
}

/// The best setting, judged by its worst trial; of equal ones, the gentler. `None` if no setting qualifies.
pub fn best(scores: &[Score], criterion: Criterion) -> Option<&Score> {
    let rated = scores
        .iter()
        .filter_map(|score| Some((score, rate(score, criterion)?)));
    let least = rated.min_by(|(a, x), (b, y)| x.total_cmp(y).then(a.setting.cmp(&b.setting)));
    least.map(|(score, _)| score)
}

/// The number to minimize; `None` if the setting does not qualify.
fn rate(score: &Score, criterion: Criterion) -> Option<f64> {
    if score.aborted > 0 {
        return None;
    }
    let overshoot = score.overshoot_g?.max;
    let steady = score.steady_force_g?.min;
    match criterion {
        Criterion::LeastOvershoot { steady_g } => (steady >= steady_g).then_some(overshoot),
        Criterion::Fastest {
            overshoot_g,
            steady_g,
        } => {
            let fits = steady >= steady_g && overshoot <= overshoot_g && !score.clipped;
            score.time_to_stop_s.filter(|_| fits).map(|time| time.max)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Dof, Force, Speed};
    use crate::record::Abort;
    use crate::trials::measure::curve::JointCurves;
    use crate::trials::measure::metrics::{DwellSpan, measure_joint};
    use crate::trials::summary::{EarlyEnd, TrialKind};

    fn setting(speed: i16, force: i16) -> TrialSetting {
        TrialSetting {
            speed: Speed::nearest(speed),
            force: Force::nearest(force),
        }
    }

    fn trial(setting: TrialSetting, [overshoot, steady, stop]: [f64; 3]) -> TrialSummary {
        let span = DwellSpan {
            slow_s: None,
            end_s: 1.0,
            threshold_g: 0.0,
        };
        let mut joint = measure_joint(Dof::Index, &JointCurves::default(), span);
        joint.overshoot_g = Some(overshoot);
        joint.steady_force_g = Some(steady);
        joint.time_to_stop_s = Some(stop);
        TrialSummary {
            number: 1,
            kind: TrialKind::Trial,
            repeat: Some(1),
            setting,
            aborted: None,
            samples: None,
            rows: 0,
            rows_lost: 0,
            repeated: false,
            stall_s: None,
            joints: vec![joint],
            others: toml::Table::new(),
        }
    }

    #[test]
    fn the_least_overshoot_that_still_holds_wins_by_its_worst_trial() {
        let trials = [
            trial(setting(25, 100), [5.0, 90.0, 9.0]),
            trial(setting(25, 500), [60.0, 460.0, 9.0]),
            trial(setting(25, 500), [80.0, 450.0, 9.1]),
            trial(setting(250, 500), [20.0, 500.0, 2.0]),
            trial(setting(250, 500), [600.0, 500.0, 2.0]),
        ];
        let scores = scores(&trials);
        let least = |steady_g| best(&scores, Criterion::LeastOvershoot { steady_g });
        assert_eq!(least(0.0).unwrap().setting, setting(25, 100));
        assert_eq!(least(400.0).unwrap().setting, setting(25, 500));
        assert_eq!(least(490.0).unwrap().setting, setting(250, 500));
        assert_eq!(least(900.0), None);
        let fastest = Criterion::Fastest {
            overshoot_g: 100.0,
            steady_g: 400.0,
        };
        assert_eq!(best(&scores, fastest).unwrap().setting, setting(25, 500));
    }

    #[test]
    fn what_ended_early_or_is_not_known_is_never_the_best() {
        let mut early = trial(setting(25, 500), [1.0, 500.0, 1.0]);
        early.aborted = Some(EarlyEnd::Here(Abort::Person));
        let mut unknown = trial(setting(50, 500), [1.0, 500.0, 1.0]);
        unknown.joints[0].overshoot_g = None;
        let mut probe = trial(setting(75, 500), [1.0, 500.0, 1.0]);
        probe.kind = TrialKind::Probe;
        let scores = scores(&[early, unknown, probe]);
        assert_eq!(scores.len(), 2);
        let all = Criterion::LeastOvershoot { steady_g: 0.0 };
        assert_eq!(best(&scores, all), None);
        assert_eq!(scores[1].overshoot_g, None);
    }
}
