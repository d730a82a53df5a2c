//! What closes of a setting, and of those near it, say about closes to come: the bound of the peaks, and what is left of the grip. Pure.
//!
//! One rule decides which bound: where 59 closes tell of the setting, or one of the peaks was far above the others, it is the largest
//! of them, whatever their distribution; where fewer were asked for and none was, they are taken to vary normally, and the
//! claim says so. How late stops are is the same at all speeds, as far as anybody knows; so closes at other speeds count, carried
//! along the growth of the peaks, and none that was over the limit is forgotten as the setting changes.

use crate::hand::Dof;
use crate::hand::statistics::{count, mean, spread};
use crate::trials::search::close::CloseFacts;
use crate::trials::search::finding::JointClaim;
use crate::trials::search::joint::JointModel;
use crate::trials::search::peak::Contact;
use crate::trials::search::tolerance::{Assurance, tolerance_factor};

/// A largest peak is no bound to the last gram: readings may miss the top of a peak, and what is carried is a little unsure. So
/// many standard deviations of all are added to it.
const LARGEST_MORE: f64 = 1.0;
/// A peak that is so many standard deviations above the mean of the others is not of the same normal distribution: of those, one of
/// thousands is.
const TAIL_SIGMAS: f64 = 4.5;
/// Of fewer peaks nothing of the kind can be said.
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

    /// Takes a close of which all was measured.
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

    /// The joint that holds with least, and with what, g.
    pub(crate) fn least_hold(&self) -> (Dof, f64) {
        let least = self.joints.iter().map(|joint| (joint.dof, joint.least()));
        let least = least.min_by(|(_, a), (_, b)| a.total_cmp(b));
        least.unwrap_or((Dof::Index, 0.0))
    }

    /// Mean time from the command to the stop, s.
    pub(crate) fn close_s(&self) -> f64 {
        mean(&self.closes_s).unwrap_or_default()
    }

    /// What is claimed of each joint.
    pub(crate) fn claims(
        &self,
        models: &[JointModel],
        now: Contact,
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

/// What peaks to come of a setting stay below, g.
pub(crate) fn bound_g(model: &JointModel, now: Contact, is_free: bool) -> f64 {
    if is_free {
        return largest_g(model, now);
    }
    let carried = model.growth.carried(now);
    let highest = carried.peaks_g.iter().copied().fold(0.0, f64::max);
    let sigma = deviation(&carried.peaks_g);
    // Ten closes may happen to be alike, so their standard deviation is no less than that of all, or than the whole search expects.
    let here = &carried.here_g;
    let sigma = sigma.max(deviation(here)).max(model.growth.scatter(now));
    let factor = tolerance_factor(here.len(), Assurance::USUAL);
    let bound = mean(here).zip(factor);
    let bound = bound.map_or(f64::INFINITY, |(mean, factor)| mean + factor * sigma);
    bound.max(highest)
}

/// The bound whatever the distribution, g: 0 of nothing.
pub(crate) fn largest_g(model: &JointModel, now: Contact) -> f64 {
    let peaks = model.growth.carried(now).peaks_g;
    let highest = peaks.iter().copied().fold(0.0, f64::max);
    highest + LARGEST_MORE * deviation(&peaks)
}

/// Whether one of the peaks was far above the others.
pub(crate) fn has_tail(model: &JointModel, now: Contact) -> bool {
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

/// Standard deviation; 0 of fewer than two.
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
