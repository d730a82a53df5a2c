//! What is known of one joint and the object before it, from the closes so far. Pure.

use crate::hand::Dof;
use crate::hand::statistics::{count, mean, median, spread};
use crate::trials::search::close::CloseFacts;
use crate::trials::search::finding::NoClaim;
use crate::trials::search::growth::{Contact, PeakGrowth};

/// Scatter of a contact as published, units of ANGLE_ACT (7.5 counts of the position), and for how many closes that counts.
const CONTACT_SCATTER: f64 = 3.75;
const CONTACT_TRUST: f64 = 4.0;
/// The slow stage begins so many standard deviations before the mean contact.
const MARGIN_SIGMAS: f64 = 3.3;
/// An angle is a whole number, and a joint is sent on two units before its halt.
const MARGIN_MORE: f64 = 2.0;
/// A contact is told from this force on, g, or this many times the noise …
const CONTACT_G: f64 = 15.0;
const CONTACT_SIGMAS: f64 = 5.0;
/// … which is so much too late at most, units of ANGLE_ACT.
const LATE_MOST: f64 = 12.0;
/// A stiffness below this share of what it was means that the object gives.
const GIVES_BELOW: f64 = 0.5;
/// Left of the grip, as a share of the threshold, below which the object gave.
const GONE_BELOW: f64 = 0.4;
/// What is left of a threshold on the published hand.
const USUALLY_LEFT: f64 = 0.92;
/// Added to a threshold, g, so that the grip is left in each close.
const HOLD_MORE_G: f64 = 4.0;

/// One joint.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointModel {
    pub(crate) dof: Dof,
    pub(crate) growth: PeakGrowth,
    contacts: Vec<f64>,
    stiffnesses: Vec<f64>,
    noises: Vec<f64>,
    /// What was left of the threshold in each close, as a share.
    left: Vec<f64>,
    /// Units of ANGLE_ACT a second for each unit of SPEED_SET.
    rates: Vec<f64>,
}

impl JointModel {
    pub(crate) fn new(dof: Dof) -> Self {
        Self {
            dof,
            growth: PeakGrowth::default(),
            contacts: Vec::new(),
            stiffnesses: Vec::new(),
            noises: Vec::new(),
            left: Vec::new(),
            rates: Vec::new(),
        }
    }

    /// Takes what a close says; the reason to end if the object gave.
    pub(crate) fn learn(&mut self, facts: &CloseFacts, at: Contact) -> Option<NoClaim> {
        let dof = self.dof;
        let gives = self.gives(facts, at);
        self.noises.push(facts.noise_g);
        self.growth.set_noise(self.noise_g());
        if let Some(peak) = facts.peak_g {
            self.growth.add(at, peak - at.threshold_g);
        }
        self.stiffnesses.extend(facts.stiffness);
        if let Some(contact) = facts.contact {
            self.contacts.push(contact);
        }
        let left = facts
            .steady_g
            .map(|steady| steady / at.threshold_g.max(1.0));
        self.left.extend(left);
        gives.map(|(before_g, now_g)| NoClaim::Gives {
            dof,
            before_g,
            now_g,
        })
    }

    /// Takes how fast a joint went that has one speed from `start` to the contact.
    pub(crate) fn learn_rate(&mut self, facts: &CloseFacts, start: f64, speed: f64) {
        let way = facts.contact.map(|contact| start - contact);
        let time = facts.to_contact_s.zip(facts.dead_time_s);
        let time = time.map(|(contact, dead)| contact - dead);
        if let Some((way, time)) = way.zip(time).filter(|(_, time)| *time > 0.05) {
            self.rates.push(way / time / speed.max(1.0));
        }
    }

    /// Stiffness before and now, where it dropped.
    fn gives(&self, facts: &CloseFacts, at: Contact) -> Option<(f64, f64)> {
        let gone = facts.peak_g.zip(facts.steady_g).filter(|(peak, steady)| {
            *peak >= at.threshold_g && *steady < GONE_BELOW * at.threshold_g
        });
        let before = median(&self.stiffnesses);
        if let Some((_, steady)) = gone {
            return Some((before.unwrap_or_default(), steady.max(0.0)));
        }
        let (before, now) = (before?, facts.stiffness?);
        (now < GIVES_BELOW * before).then_some((before, now))
    }

    /// Noise of the force, g.
    pub(crate) fn noise_g(&self) -> f64 {
        median(&self.noises).unwrap_or_default()
    }

    /// g for each unit of ANGLE_ACT.
    pub(crate) fn stiffness(&self) -> Option<f64> {
        median(&self.stiffnesses)
    }

    /// Units of ANGLE_ACT a second for each unit of SPEED_SET.
    pub(crate) fn rate(&self) -> f64 {
        median(&self.rates).unwrap_or(1.5)
    }

    /// The mean contact, units of ANGLE_ACT; brought back from the force that told it to where it began.
    pub(crate) fn contact(&self) -> Option<f64> {
        Some(mean(&self.contacts)? + self.late())
    }

    fn late(&self) -> f64 {
        let level = CONTACT_G.max(CONTACT_SIGMAS * self.noise_g());
        let late = self
            .stiffness()
            .map(|stiffness| level / stiffness.max(0.01));
        late.unwrap_or(1.0).min(LATE_MOST)
    }

    /// How far before the mean contact the slow stage begins, units of ANGLE_ACT. While little is known it is wider.
    pub(crate) fn margin(&self) -> f64 {
        let n = count(&self.contacts).max(1.0);
        let spread = spread(&self.contacts);
        let known = CONTACT_TRUST * CONTACT_SCATTER.powi(2);
        let sigma = ((known + spread) / (CONTACT_TRUST + n - 1.0)).sqrt();
        MARGIN_SIGMAS * sigma * (1.0 + 2.0 / n).sqrt() + MARGIN_MORE
    }

    /// The least threshold that leaves this much of the grip, g.
    pub(crate) fn threshold_for(&self, hold_g: f64) -> f64 {
        let least = self.left.iter().copied().reduce(f64::min);
        let left = least.unwrap_or(USUALLY_LEFT).clamp(0.3, 1.0);
        hold_g / left + HOLD_MORE_G
    }
}
