//! Predictions from closes of a setting and of similar ones: the bound of future peaks, and the remaining grip. Pure.
//!
//! One rule decides on the bound: with 59 relevant closes, or with one peak far above the others, it is the largest peak,
//! whatever the distribution; with fewer requested closes and no such peak, a normal distribution is assumed, and the
//! claim states that. Stops are assumed to be equally late at all speeds; so closes at other speeds count, scaled
//! along the growth of the peaks, and a close over the limit stays relevant when the setting changes.

use crate::hand::Dof;
use crate::hand::statistics::{count, mean, spread};
use crate::trials::search::close::CloseFacts;
use crate::trials::search::finding::JointClaim;
use crate::trials::search::joint::JointModel;
use crate::trials::search::peak::ContactSetting;
use crate::trials::search::tolerance::{Assurance, tolerance_factor};

/// The largest peak is not an exact bound: readings may miss the top of a peak, and scaled peaks are uncertain. This many
/// standard deviations of all peaks are added.
const LARGEST_MORE: f64 = 1.0;
/// A peak this many standard deviations above the mean of the others does not fit their normal distribution, in which one peak in
/// thousands is this high.
const TAIL_SIGMAS: f64 = 4.5;
/// Fewer peaks do not show a tail.
const TAIL_LEAST: usize = 8;

/// One joint's closes.
#[derive(Debug, Clone, PartialEq)]
struct JointCloses {
    dof: Dof,
    peaks_g: Vec<f64>,
    holds_g: Vec<f64>,
}

/// The closes of one setting.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Confirmation {
    joints: Vec<JointCloses>,
    closes_s: Vec<f64>,
}

impl Confirmation {
    pub(crate) fn new(dofs: impl Iterator<Item = Dof>) -> Self {
        let joints = dofs.map(|dof| JointCloses {
            dof,
            peaks_g: Vec::new(),
            holds_g: Vec::new(),
        });
        Self {
            joints: joints.collect(),
            closes_s: Vec::new(),
        }
    }

    /// Adds a completely measured close.
    pub(crate) fn add(&mut self, facts: &[CloseFacts]) {
        for (joint, facts) in self.joints.iter_mut().zip(facts) {
            joint.peaks_g.extend(facts.peak_g);
            joint.holds_g.extend(facts.steady_g);
        }
        let last = facts.iter().filter_map(|joint| joint.close_s);
        self.closes_s.extend(last.reduce(f64::max));
    }

    pub(crate) fn closes(&self) -> usize {
        self.closes_s.len()
    }

    /// The joint with the weakest hold, and its force, g.
    pub(crate) fn least_hold(&self) -> (Dof, f64) {
        let least = self.joints.iter().map(|joint| (joint.dof, joint.least()));
        let least = least.min_by(|(_, a), (_, b)| a.total_cmp(b));
        least.unwrap_or((Dof::Index, 0.0))
    }

    /// Mean time from the command to the stop, s.
    pub(crate) fn close_s(&self) -> f64 {
        mean(&self.closes_s).unwrap_or_default()
    }

    /// The claim about each joint.
    pub(crate) fn claims(
        &self,
        models: &[JointModel],
        now: ContactSetting,
        is_free: bool,
    ) -> Vec<JointClaim> {
        let joints = self.joints.iter().zip(models);
        let claim = |(joint, model): (&JointCloses, &JointModel)| JointClaim {
            dof: joint.dof,
            contact_angle: model.contact().unwrap_or_default(),
            peak_bound_g: bound_g(model, now, is_free),
            peaks_g: joint.peaks_g.clone(),
            hold_g: joint.least(),
            stiffness_g: model.stiffness(),
        };
        joints.map(claim).collect()
    }
}

impl JointCloses {
    fn least(&self) -> f64 {
        self.holds_g.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Bound of the future peaks of a setting, g.
pub(crate) fn bound_g(model: &JointModel, now: ContactSetting, is_free: bool) -> f64 {
    if is_free {
        return largest_g(model, now);
    }
    let carried = model.growth.carried(now);
    let highest = carried.peaks_g.iter().copied().fold(0.0, f64::max);
    let sigma = deviation(&carried.peaks_g);
    // Ten closes may be alike by chance, so their deviation counts as at least that of all, and that of the model.
    let here = &carried.here_g;
    let sigma = sigma.max(deviation(here)).max(model.growth.scatter(now));
    let factor = tolerance_factor(here.len(), Assurance::USUAL);
    let bound = mean(here).zip(factor);
    let bound = bound.map_or(f64::INFINITY, |(mean, factor)| mean + factor * sigma);
    bound.max(highest)
}

/// The distribution-free bound, g; 0 without peaks.
pub(crate) fn largest_g(model: &JointModel, now: ContactSetting) -> f64 {
    let peaks = model.growth.carried(now).peaks_g;
    let highest = peaks.iter().copied().fold(0.0, f64::max);
    highest + LARGEST_MORE * deviation(&peaks)
}

/// True if one of the peaks was far above the others.
pub(crate) fn has_tail(model: &JointModel, now: ContactSetting) -> bool {
    is_far_above(&model.growth.carried(now).peaks_g, model.noise_g())
}

fn is_far_above(peaks_g: &[f64], noise_g: f64) -> bool {
    let mut peaks = peaks_g.to_vec();
    peaks.sort_by(f64::total_cmp);
    let Some((highest, others)) = peaks.split_last() else {
        return false;
    };
    let sigma = deviation(others).max(noise_g);
    others.len() >= TAIL_LEAST
        && mean(others).is_some_and(|mean| highest - mean > TAIL_SIGMAS * sigma)
}

/// Standard deviation; 0 for fewer than two values.
fn deviation(values: &[f64]) -> f64 {
    (spread(values) / (count(values) - 1.0).max(1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_stop_is_told_from_peaks_that_vary_normally() {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut normal = |mean: f64, sigma: f64| {
            let sum: f64 = (0..12).map(|_| rng.f64()).sum();
            mean + sigma * (sum - 6.0)
        };
        let mut false_alarms = 0;
        let mut found = 0;
        for _ in 0..2000 {
            let mut peaks: Vec<f64> = (0..15).map(|_| normal(450.0, 10.0)).collect();
            false_alarms += usize::from(is_far_above(&peaks, 3.0));
            // A stop of 60 ms that comes 20 ms late.
            peaks.push(normal(450.0 + 0.33 * 240.0, 10.0));
            found += usize::from(is_far_above(&peaks, 3.0));
        }
        assert!(false_alarms <= 20, "{false_alarms}");
        assert!(found >= 1900, "{found}");
    }
}
