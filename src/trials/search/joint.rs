//! The model of one joint and the object before it, from the closes so far. Pure.

use crate::hand::Dof;
use crate::hand::statistics::{count, mean, median, spread};
use crate::trials::search::close::CloseFacts;
use crate::trials::search::finding::{ComparedThreshold, NoClaim};
use crate::trials::search::growth::PeakGrowth;
use crate::trials::search::offset::ThresholdReference;
use crate::trials::search::peak::{ContactSetting, SeenPeak};

/// Published scatter of a contact, units of ANGLE_ACT (7.5 counts of the position), and its weight in closes.
const CONTACT_SCATTER: f64 = 3.75;
const CONTACT_TRUST: f64 = 4.0;
/// The slow stage begins this many standard deviations before the mean contact.
const MARGIN_SIGMAS: f64 = 3.3;
/// An angle is a whole number, and a joint is sent two units past its halt.
const MARGIN_MORE: f64 = 2.0;
/// A contact is detected from this force on, g, or from this many times the noise …
const CONTACT_G: f64 = 15.0;
const CONTACT_SIGMAS: f64 = 5.0;
/// … which delays it by at most this, units of ANGLE_ACT.
const LATE_MOST: f64 = 12.0;
/// A contact counts if the joint moves less than this between two readings, units of ANGLE_ACT; a stiffness, if that is less than
/// this share of the way into the object.
const SHARP: f64 = 5.0;
const SHARP_SHARE: f64 = 0.25;
/// The object gives if its stiffness falls below this share of its earlier value.
const GIVES_BELOW: f64 = 0.5;
/// The object gave if the remaining grip is below this share of the force that stopped the drive.
const GONE_BELOW: f64 = 0.4;
/// Remaining share of a peak before any was measured.
const USUALLY_LEFT: f64 = 0.92;
/// Added to the hold, g, so that every close keeps enough grip.
const HOLD_MORE_G: f64 = 4.0;
/// Closes whose overshoots, as shares of the peak, differ by less do not show how overshoot relaxes.
const OVER_SPREAD: f64 = 0.05;
/// Lower bounds of the force that stops a drive: absolute, as a multiple of the noise, and as a share of the limit.
const STOPS_MIN_G: f64 = 15.0;
const STOPS_SIGMAS: f64 = 6.0;
const STOPS_SHARE: f64 = 0.06;
/// Smallest FORCE_SET, g, whatever a sensor reads at rest.
const THRESHOLD_MIN_G: f64 = 5.0;

/// The object creeps if the trend of its contact exceeds this many of its standard deviations, and this total, units of ANGLE_ACT.
const CREEP_SIGMAS: f64 = 4.5;
const CREEP_LEAST: f64 = 8.0;
/// Fewer closes show no trend.
const CREEP_CLOSES: usize = 10;

/// Peak and remaining force of one close.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Left {
    threshold_g: f64,
    offset_g: f64,
    peak_g: f64,
    steady_g: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointModel {
    pub(crate) dof: Dof,
    pub(crate) growth: PeakGrowth,
    contacts: Vec<f64>,
    stiffnesses: Vec<f64>,
    noises: Vec<f64>,
    left: Vec<Left>,
    /// Units of ANGLE_ACT per second for each unit of SPEED_SET.
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

    /// Learns from a close. Returns the reason to end the search if the object gave.
    pub(crate) fn learn(&mut self, facts: &CloseFacts, at: ContactSetting) -> Option<NoClaim> {
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

    /// Learns the rate of a joint that moves at one speed from `start` to the contact.
    pub(crate) fn learn_rate(&mut self, facts: &CloseFacts, start: f64, speed: f64) {
        let way = facts.contact.map(|contact| start - contact);
        // A hand that moves within one reading of the command shows no dead time.
        let dead = facts.dead_time_s.unwrap_or_default();
        let time = facts.to_contact_s.map(|contact| contact - dead);
        if let Some((way, time)) = way.zip(time).filter(|(_, time)| *time > 0.05) {
            self.rates.push(way / time / speed.max(1.0));
        }
    }

    /// The stiffness before and now, if it dropped.
    fn gives(&self, facts: &CloseFacts, at: ContactSetting) -> Option<(f64, f64)> {
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

    /// Motion of a joint between two readings, units of ANGLE_ACT.
    fn step(&self, facts: &CloseFacts, at: ContactSetting) -> f64 {
        facts.reading_s.unwrap_or_default() * at.speed * self.rate()
    }

    /// The stiffness shown by a close; `None` if the error of the contact is a large part of the way into the object.
    fn stiffness_in(&self, facts: &CloseFacts, at: ContactSetting) -> Option<f64> {
        let pressed = facts.steady_g.zip(facts.stiffness);
        let (steady, stiffness) = pressed.filter(|_| !facts.is_uncertain)?;
        let pressed = steady / stiffness.max(0.01);
        (self.step(facts, at) < SHARP_SHARE * pressed).then_some(stiffness)
    }

    /// Upper bound of the stiffness in a close: interpolation places a contact early, never late.
    fn stiffness_most(&self, facts: &CloseFacts, at: ContactSetting) -> Option<f64> {
        let pressed = facts.steady_g.zip(facts.stiffness);
        let (steady, stiffness) = pressed.filter(|_| !facts.is_uncertain)?;
        let pressed = steady / stiffness.max(0.01) - self.step(facts, at);
        (pressed > 0.0).then(|| steady / pressed)
    }

    /// The trend of the contact from close to close, if the object does not stay in place.
    pub(crate) fn creeps(&self) -> Option<NoClaim> {
        let (counts, unsure) = trend(&self.contacts)?;
        let is_certain = counts.abs() > CREEP_SIGMAS * unsure;
        let way = counts.abs() * count(&self.contacts);
        (is_certain && way > CREEP_LEAST).then_some(NoClaim::Creeps {
            dof: self.dof,
            counts,
        })
    }

    pub(crate) fn noise_g(&self) -> f64 {
        median(&self.noises).unwrap_or_default()
    }

    /// Median stiffness, g per unit of ANGLE_ACT.
    pub(crate) fn stiffness(&self) -> Option<f64> {
        median(&self.stiffnesses)
    }

    /// Units of ANGLE_ACT per second for each unit of SPEED_SET.
    pub(crate) fn rate(&self) -> f64 {
        median(&self.rates).unwrap_or(1.5)
    }

    /// The mean contact, units of ANGLE_ACT, corrected for the force needed to detect it.
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

    /// Start of the slow stage before the mean contact, units of ANGLE_ACT. It is wider with few closes.
    pub(crate) fn margin(&self) -> f64 {
        let n = count(&self.contacts).max(1.0);
        let spread = spread(&self.contacts);
        let known = CONTACT_TRUST * CONTACT_SCATTER.powi(2);
        let sigma = ((known + spread) / (CONTACT_TRUST + n - 1.0)).sqrt();
        MARGIN_SIGMAS * sigma * (1.0 + 2.0 / n).sqrt() + MARGIN_MORE
    }

    /// The lowest force above rest that may stop a drive, g, so that noise does not.
    pub(crate) fn stops_least(&self, limit_g: f64) -> f64 {
        let noise = STOPS_SIGMAS * self.noise_g();
        STOPS_MIN_G.max(noise).max(STOPS_SHARE * limit_g)
    }

    /// The lowest threshold that stops the drive above its noise, for every reference it may have, g.
    pub(crate) fn threshold_least(&self, limit_g: f64) -> f64 {
        let offset = self.growth.offset_g();
        let stops_at = self.stops_least(limit_g);
        let compared = self.growth.compared();
        let counted = match compared {
            Some(ThresholdReference::AsRead) => offset,
            Some(ThresholdReference::AboveRest | ThresholdReference::Unknown) => 0.0,
            None => offset.max(0.0),
        };
        (stops_at + counted).max(THRESHOLD_MIN_G)
    }

    /// The threshold that stops the drive at this force above rest, g; without the offset unless its drive is known to count it.
    pub(crate) fn threshold_for(&self, force_g: f64) -> f64 {
        let compared = self
            .growth
            .compared()
            .unwrap_or(ThresholdReference::AboveRest);
        compared.threshold_for(force_g, self.growth.offset_g())
    }

    /// The reference of its drive's threshold, as found.
    pub(crate) fn compared(&self) -> ComparedThreshold {
        ComparedThreshold {
            dof: self.dof,
            compared: self.growth.compared(),
            offset_g: self.growth.offset_g(),
        }
    }

    /// Lower bound of the remaining grip, g; `None` before any peak was measured.
    pub(crate) fn holds(&self, at: ContactSetting) -> Option<f64> {
        let peak = self.growth.likely(at)?;
        let over = (1.0 - self.growth.stops_at(at.threshold_g) / peak.max(1.0)).clamp(0.0, 1.0);
        Some(self.left_of_peak(over) * peak - HOLD_MORE_G - self.noise_g())
    }

    /// Remaining share of a peak with this share of overshoot: some drives keep their overshoot, others relax to the threshold. Fits a
    /// line to the closes; if they do not show it, further overshoot is assumed to relax fully.
    fn left_of_peak(&self, over: f64) -> f64 {
        let seen = self.left.iter().filter(|own| own.peak_g > 1.0);
        let seen: Vec<(f64, f64)> = seen
            .map(|own| {
                let compared = self
                    .growth
                    .compared()
                    .unwrap_or(ThresholdReference::AboveRest);
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

/// Slope of the values per close, and its standard deviation; `None` for too few.
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
