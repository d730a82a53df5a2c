//! Which setting is best by a stated criterion, over all trials of it. Pure.

use crate::hand::statistics::median;
use crate::trials::measure::metrics::JointMetrics;
use crate::trials::plan::TrialSetting;
use crate::trials::summary::TrialSummary;
use serde::Serialize;

/// What is wanted of a setting. A setting counts if every trial of it ended well, touched with every joint, and, where
/// the criterion asks for it, stayed within its bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Criterion {
    /// The least overshoot, with at least this steady force, g.
    LeastOvershoot {
        /// Steady force wanted, g.
        steady_g: f64,
    },
    /// The shortest time to the stop, with at most this overshoot and at least this steady force, g.
    Fastest {
        /// Overshoot allowed, g.
        overshoot_g: f64,
        /// Steady force wanted, g.
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

/// Middle, lowest and highest of a metric over repeats and joints.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MetricSpread {
    pub median: f64,
    /// The lowest.
    pub min: f64,
    /// The highest.
    pub max: f64,
}

impl MetricSpread {
    /// Of some values; `None` of nothing.
    pub fn of(values: &[f64]) -> Option<Self> {
        Some(Self {
            median: median(values)?,
            min: values.iter().copied().reduce(f64::min)?,
            max: values.iter().copied().reduce(f64::max)?,
        })
    }
}

/// What the trials of one setting come to. Each spread is known only if every joint of every trial told it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Score {
    #[serde(flatten)]
    pub setting: TrialSetting,
    pub trials: usize,
    /// Trials of it that ended early.
    pub aborted: usize,
    /// Overshoot, g.
    pub overshoot_g: Option<MetricSpread>,
    /// Steady force, g.
    pub steady_force_g: Option<MetricSpread>,
    /// Time to the stop, s.
    pub time_to_stop_s: Option<MetricSpread>,
    /// Whether a peak was beyond the sensor's end.
    pub clipped: bool,
}

/// The settings that were tried, in the order of first trial; looking for the contact does not count.
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

/// The best setting, judged by the worst of its trials; the gentler one of two that are equal. `None` if none will do.
pub fn best(scores: &[Score], criterion: Criterion) -> Option<&Score> {
    let rated = scores
        .iter()
        .filter_map(|score| Some((score, rate(score, criterion)?)));
    let least = rated.min_by(|(a, x), (b, y)| x.total_cmp(y).then(a.setting.cmp(&b.setting)));
    least.map(|(score, _)| score)
}

/// The number that is to be small; `None` if the setting does not count.
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

    /// A trial with this overshoot, steady force and time to the stop.
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
