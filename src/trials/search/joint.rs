//! What is known of one joint and the object before it, from the closes so far. Pure.

use crate::hand::Dof;
use crate::hand::statistics::{count, mean, median, spread};
use crate::trials::search::close::CloseFacts;
use crate::trials::search::finding::{ComparedThreshold, NoClaim};
use crate::trials::search::growth::PeakGrowth;
use crate::trials::search::offset::Compared;
use crate::trials::search::peak::{Contact, SeenPeak};

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
/// A contact is told where a joint goes less than this between two readings, units of ANGLE_ACT; a stiffness, where that is less
/// than this share of the way into the object.
const SHARP: f64 = 5.0;
const SHARP_SHARE: f64 = 0.25;
/// A stiffness below this share of what it was means that the object gives.
const GIVES_BELOW: f64 = 0.5;
/// Left of the grip, as a share of the force that stopped the drive, below which the object gave.
const GONE_BELOW: f64 = 0.4;
/// What is left of a peak before any was measured.
const USUALLY_LEFT: f64 = 0.92;
/// Added to what is to be held, g, so that the grip is left in each close.
const HOLD_MORE_G: f64 = 4.0;
/// Closes whose overshoots differ less than this, as a share of the peak, do not show what is left of an overshoot.
const OVER_SPREAD: f64 = 0.05;
/// A force that stops a drive is at least this, this many times the noise, and this share of the limit.
const STOPS_MIN_G: f64 = 15.0;
const STOPS_SIGMAS: f64 = 6.0;
const STOPS_SHARE: f64 = 0.06;
/// FORCE_SET is at least this, g, whatever a sensor reads at rest.
const THRESHOLD_MIN_G: f64 = 5.0;

/// A contact that moves so many standard deviations of its trend, and so far in all, units of ANGLE_ACT, does not stay where it is.
const CREEP_SIGMAS: f64 = 4.5;
const CREEP_LEAST: f64 = 8.0;
/// Of fewer closes no trend is told.
const CREEP_CLOSES: usize = 10;

/// What one close left of its peak.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Left {
    threshold_g: f64,
    offset_g: f64,
    peak_g: f64,
    steady_g: f64,
}

/// One joint.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointModel {
    pub(crate) dof: Dof,
    pub(crate) growth: PeakGrowth,
    contacts: Vec<f64>,
    stiffnesses: Vec<f64>,
    noises: Vec<f64>,
    left: Vec<Left>,
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
        self.noises.push(facts.noise_g);
        self.growth.set_noise(self.noise_g());
        if let Some(peak_g) = facts.peak_g {
            self.growth.add(SeenPeak {
                at,
                offset_g: facts.offset_g,
                peak_g,
                missed_g: facts.missed_g,
                is_certain: !facts.is_uncertain,
            });
        }
        let gives = self.gives(facts, at);
        self.stiffnesses.extend(self.stiffness_in(facts, at));
        let is_sharp = self.contacts.is_empty() || self.step(facts, at) < SHARP;
        self.contacts.extend(facts.contact.filter(|_| is_sharp));
        let left = facts.peak_g.zip(facts.steady_g);
        self.left.extend(left.map(|(peak_g, steady_g)| Left {
            threshold_g: at.threshold_g,
            offset_g: facts.offset_g,
            peak_g,
            steady_g,
        }));
        gives.map(|(before_g, now_g)| NoClaim::Gives {
            dof,
            before_g,
            now_g,
        })
    }

    /// Takes how fast a joint went that has one speed from `start` to the contact.
    pub(crate) fn learn_rate(&mut self, facts: &CloseFacts, start: f64, speed: f64) {
        let way = facts.contact.map(|contact| start - contact);
        // A hand that moves within one reading of the command shows no dead time.
        let dead = facts.dead_time_s.unwrap_or_default();
        let time = facts.to_contact_s.map(|contact| contact - dead);
        if let Some((way, time)) = way.zip(time).filter(|(_, time)| *time > 0.05) {
            self.rates.push(way / time / speed.max(1.0));
        }
    }

    /// Stiffness before and now, where it dropped.
    fn gives(&self, facts: &CloseFacts, at: Contact) -> Option<(f64, f64)> {
        let stops_at = self.growth.stops_at(at.threshold_g);
        let gone = facts.peak_g.zip(facts.steady_g).filter(|(peak, steady)| {
            *peak >= stops_at && *steady < GONE_BELOW * stops_at && peak - steady > stops_at / 4.0
        });
        let before = median(&self.stiffnesses);
        if let Some((_, steady)) = gone {
            return Some((before.unwrap_or_default(), steady.max(0.0)));
        }
        let (before, now) = (before?, self.stiffness_most(facts, at)?);
        (now < GIVES_BELOW * before).then_some((before, now))
    }

    /// The way of a joint between two readings, units of ANGLE_ACT.
    fn step(&self, facts: &CloseFacts, at: Contact) -> f64 {
        facts.reading_s.unwrap_or_default() * at.speed * self.rate()
    }

    /// The stiffness that a close tells: none if the contact may be off by much of the way into the object.
    fn stiffness_in(&self, facts: &CloseFacts, at: Contact) -> Option<f64> {
        let pressed = facts.steady_g.zip(facts.stiffness);
        let (steady, stiffness) = pressed.filter(|_| !facts.is_uncertain)?;
        let pressed = steady / stiffness.max(0.01);
        (self.step(facts, at) < SHARP_SHARE * pressed).then_some(stiffness)
    }

    /// The highest stiffness that a close may be of: between two readings a contact is drawn early, never late.
    fn stiffness_most(&self, facts: &CloseFacts, at: Contact) -> Option<f64> {
        let pressed = facts.steady_g.zip(facts.stiffness);
        let (steady, stiffness) = pressed.filter(|_| !facts.is_uncertain)?;
        let pressed = steady / stiffness.max(0.01) - self.step(facts, at);
        (pressed > 0.0).then(|| steady / pressed)
    }

    /// How the contact moves from close to close, where it does: the object does not stay where it is.
    pub(crate) fn creeps(&self) -> Option<NoClaim> {
        let (counts, unsure) = trend(&self.contacts)?;
        let is_told = counts.abs() > CREEP_SIGMAS * unsure;
        let way = counts.abs() * count(&self.contacts);
        (is_told && way > CREEP_LEAST).then_some(NoClaim::Creeps {
            dof: self.dof,
            counts,
        })
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

    /// The force above rest, g, that a drive has at least to be stopped by: noise must not do it.
    pub(crate) fn stops_least(&self, limit_g: f64) -> f64 {
        let noise = STOPS_SIGMAS * self.noise_g();
        STOPS_MIN_G.max(noise).max(STOPS_SHARE * limit_g)
    }

    /// The least threshold that stops it above its noise, whatever it is compared with, g.
    pub(crate) fn threshold_least(&self, limit_g: f64) -> f64 {
        let offset = self.growth.offset_g();
        let stops_at = self.stops_least(limit_g);
        let compared = self.growth.compared();
        let counted = match compared {
            Some(Compared::AsRead) => offset,
            Some(Compared::AboveRest | Compared::Unknown) => 0.0,
            None => offset.max(0.0),
        };
        (stops_at + counted).max(THRESHOLD_MIN_G)
    }

    /// The threshold that stops it at this force above rest, g; where its drive is not known to count the offset, not above it.
    pub(crate) fn threshold_for(&self, force_g: f64) -> f64 {
        let compared = self.growth.compared().unwrap_or(Compared::AboveRest);
        compared.threshold_for(force_g, self.growth.offset_g())
    }

    /// What its drive was found to compare its threshold with.
    pub(crate) fn compared(&self) -> ComparedThreshold {
        ComparedThreshold {
            dof: self.dof,
            compared: self.growth.compared(),
            offset_g: self.growth.offset_g(),
        }
    }

    /// What is left of the grip at least, g.
    pub(crate) fn holds(&self, at: Contact) -> Option<f64> {
        let peak = self.growth.likely(at)?;
        let over = (1.0 - self.growth.stops_at(at.threshold_g) / peak.max(1.0)).clamp(0.0, 1.0);
        Some(self.left_of_peak(over) * peak - HOLD_MORE_G - self.noise_g())
    }

    /// What is left of a peak, as a share, of which this share is overshoot: some drives keep what they ran past their threshold,
    /// others relax to it. A line through what was seen; where that does not show it, nothing is left of more overshoot.
    fn left_of_peak(&self, over: f64) -> f64 {
        let seen = self.left.iter().filter(|own| own.peak_g > 1.0);
        let seen: Vec<(f64, f64)> = seen
            .map(|own| {
                let compared = self.growth.compared().unwrap_or(Compared::AboveRest);
                let stops_at = compared.stops_at(own.threshold_g, own.offset_g);
                let over = (1.0 - stops_at / own.peak_g).clamp(0.0, 1.0);
                (over, own.steady_g / own.peak_g)
            })
            .collect();
        let overs: Vec<f64> = seen.iter().map(|(over, _)| *over).collect();
        let shares: Vec<f64> = seen.iter().map(|(_, share)| *share).collect();
        let Some((mean_over, mean_share)) = mean(&overs).zip(mean(&shares)) else {
            return USUALLY_LEFT * (1.0 - over);
        };
        let sum = spread(&overs);
        let slope = if sum > OVER_SPREAD.powi(2) * count(&overs) {
            let products = seen.iter();
            let products = products.map(|(o, s)| (o - mean_over) * (s - mean_share));
            products.sum::<f64>() / sum
        } else if over > mean_over {
            -mean_share / (1.0 - mean_over).max(0.05)
        } else {
            0.0
        };
        let line = mean_share + slope.min(0.0) * (over - mean_over);
        line.clamp(0.0, 1.0)
    }
}

/// By how much values rise from one to the next, and the standard deviation of that; `None` of too few.
fn trend(values: &[f64]) -> Option<(f64, f64)> {
    if values.len() < CREEP_CLOSES {
        return None;
    }
    let n = count(values);
    let middle = mean(values)?;
    let at = |nth: usize| u32::try_from(nth).map_or(0.0, f64::from) - (n - 1.0) / 2.0;
    let points = || {
        values
            .iter()
            .enumerate()
            .map(|(nth, own)| (at(nth), own - middle))
    };
    let width: f64 = points().map(|(x, _)| x * x).sum();
    let slope = points().map(|(x, y)| x * y).sum::<f64>() / width;
    let rest: f64 = points().map(|(x, y)| (y - slope * x).powi(2)).sum();
    Some((slope, (rest / (n - 2.0) / width).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_that_creeps_is_told_from_one_that_scatters() {
        let mut rng = fastrand::Rng::with_seed(9);
        let mut contacts = |creep: f64, closes: u32| {
            let mut joint = JointModel::new(Dof::Index);
            joint.contacts = (0..closes)
                .map(|n| {
                    let sum: f64 = (0..12).map(|_| rng.f64()).sum();
                    (500.0 + creep * f64::from(n) + 3.75 * (sum - 6.0)).round()
                })
                .collect();
            joint.creeps()
        };
        let told = |creeps: Vec<Option<NoClaim>>| creeps.into_iter().flatten().count();
        let still: Vec<_> = (0..300).map(|_| contacts(0.0, 25)).collect();
        assert!(told(still) <= 1);
        for creep in [1.0, -1.0] {
            let creeping: Vec<_> = (0..100).map(|_| contacts(creep, 25)).collect();
            assert!(told(creeping) >= 97);
            let Some(NoClaim::Creeps { counts, .. }) = contacts(creep, 40) else {
                panic!("{creep}");
            };
            assert!((counts - creep).abs() < 0.25, "{counts}");
        }
    }
}
