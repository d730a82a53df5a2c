//! One setting, closed again and again: the bound of its peaks, and what is left of the grip. Pure.

use crate::hand::Dof;
use crate::hand::statistics::{count, mean, spread};
use crate::trials::search::close::CloseFacts;
use crate::trials::search::finding::JointClaim;
use crate::trials::search::goal::SearchGoal;
use crate::trials::search::growth::Contact;
use crate::trials::search::joint::JointModel;
use crate::trials::search::tolerance::tolerance_factor;

/// One joint's closes.
#[derive(Debug, Clone, PartialEq)]
struct JointCloses {
    dof: Dof,
    /// Standard deviation that the peaks are taken to have at least, g: by the search as a whole.
    least_sigma_g: f64,
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
            least_sigma_g: 0.0,
            peaks_g: Vec::new(),
            holds_g: Vec::new(),
        });
        Self {
            joints: joints.collect(),
            closes_s: Vec::new(),
        }
    }

    /// Takes a close of which all was measured, and what scatter the whole search expects at this setting.
    pub(crate) fn add(&mut self, facts: &[CloseFacts], models: &[JointModel], at: Contact) {
        for ((joint, facts), model) in self.joints.iter_mut().zip(facts).zip(models) {
            joint.least_sigma_g = model.growth.scatter(at);
            joint.peaks_g.extend(facts.peak_g);
            joint.holds_g.extend(facts.steady_g);
        }
        let last = facts.iter().filter_map(|joint| joint.close_s);
        self.closes_s.extend(last.reduce(f64::max));
    }

    pub(crate) fn closes(&self) -> usize {
        self.closes_s.len()
    }

    /// The highest bound of all joints, g.
    pub(crate) fn bound(&self, goal: &SearchGoal) -> f64 {
        let bounds = self.joints.iter().map(|joint| joint.bound(goal));
        bounds.fold(0.0, f64::max)
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
    pub(crate) fn claims(&self, models: &[JointModel], goal: &SearchGoal) -> Vec<JointClaim> {
        let joints = self.joints.iter().zip(models);
        let claim = |(joint, model): (&JointCloses, &JointModel)| JointClaim {
            dof: joint.dof,
            contact_angle: model.contact().unwrap_or_default(),
            peak_bound_g: joint.bound(goal),
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

    /// What peaks to come stay below, by these: g.
    fn bound(&self, goal: &SearchGoal) -> f64 {
        let peaks = &self.peaks_g;
        let highest = peaks.iter().copied().fold(0.0, f64::max);
        if goal.distribution_free {
            return highest;
        }
        let factor = tolerance_factor(peaks.len(), goal.assurance());
        let Some((mean, factor)) = mean(peaks).zip(factor) else {
            return f64::INFINITY;
        };
        // Ten closes may happen to be alike; no bound is below what was seen.
        let sigma = (spread(peaks) / (count(peaks) - 1.0)).sqrt();
        let sigma = sigma.max(self.least_sigma_g);
        (mean + factor * sigma).max(highest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_is_mean_and_factor_or_the_largest() {
        let mut closes = JointCloses {
            dof: Dof::Index,
            least_sigma_g: 0.0,
            peaks_g: vec![480.0, 470.0, 475.0, 478.0, 472.0],
            holds_g: Vec::new(),
        };
        let mut goal = SearchGoal::new(&[Dof::Index], 500);
        let s = (68.0_f64 / 4.0).sqrt();
        assert!((closes.bound(&goal) - (475.0 + 4.20 * s)).abs() < 0.1);
        closes.least_sigma_g = 10.0;
        assert!((closes.bound(&goal) - (475.0 + 42.0)).abs() < 0.1);
        goal.distribution_free = true;
        assert_eq!(closes.bound(&goal), 480.0);
    }
}
