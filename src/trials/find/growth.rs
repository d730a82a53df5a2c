//! How a peak grows with the speed: what was measured on this object, continued along the shapes that two hands of the family
//! showed. The shapes choose the next trial; no claim rests on them. Pure.

use crate::hand::impact::{overshoot_g, second_hand_overshoot_g};

/// Mixtures of the two published shapes that are tried.
const MIXTURES: u32 = 20;
/// A peak repeats itself to this share of its overshoot, as far as nothing else is known.
pub const REPEATS_TO: f64 = 0.035;
/// What a shape may differ from this hand's, as a share of the overshoot.
const SHAPE_ERROR: f64 = 0.10;
/// How much worse than the best a mixture may fit and still be possible (chi-square).
const POSSIBLE: f64 = 4.0;
/// A best fit worse than this for each trial means that no mixture is like this hand.
const STRANGE: f64 = 6.0;
/// Then the worst shape is taken, and so much more.
const STRANGE_MORE: f64 = 1.3;

/// A speed and a threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Units of SPEED_SET.
    pub speed: f64,
    /// FORCE_SET, g.
    pub threshold_g: f64,
}

/// What one joint's closes measured.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PeakGrowth {
    /// What was tried, and grams above the threshold.
    seen: Vec<(Contact, f64)>,
    /// Noise of the force, g.
    noise_g: f64,
}

/// A mixture of the shapes, fitted.
#[derive(Debug, Clone, Copy)]
struct Fit {
    second: f64,
    scale: f64,
    /// Standard deviation of the scale.
    unsure: f64,
    misfit: f64,
}

impl PeakGrowth {
    /// Takes one close.
    pub fn add(&mut self, contact: Contact, over_g: f64) {
        self.seen.push((contact, over_g));
    }

    /// Takes over the noise of the force, g.
    pub const fn set_noise(&mut self, noise_g: f64) {
        self.noise_g = noise_g;
    }

    /// What is likely above the threshold, g; `None` before anything was measured.
    pub fn likely(&self, at: Contact) -> Option<f64> {
        let best = self.best()?;
        Some(best.scale * shape(at, best.second))
    }

    /// The most that is possible above the threshold on average, g.
    pub fn upper(&self, at: Contact) -> Option<f64> {
        let best = self.best()?;
        let trials: f64 = self.seen.iter().map(|_| 1.0).sum();
        let is_strange = best.misfit > STRANGE * trials;
        let fits = self.fits();
        let fits = fits.iter();
        let possible = fits.filter(|fit| is_strange || fit.misfit <= best.misfit + POSSIBLE);
        let most = possible.map(|fit| {
            if is_strange {
                STRANGE_MORE * self.from_fastest(at, fit.second)
            } else {
                (fit.scale + 2.0 * fit.unsure) * shape(at, fit.second)
            }
        });
        most.reduce(f64::max)
    }

    /// Standard deviation of single closes around what is likely, g.
    pub fn scatter(&self, at: Contact) -> f64 {
        let over = self.likely(at).unwrap_or_default();
        self.noise_g.hypot(REPEATS_TO * over)
    }

    fn best(&self) -> Option<Fit> {
        let fits = self.fits().into_iter();
        fits.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    fn fits(&self) -> Vec<Fit> {
        let mixtures = (0..=MIXTURES).map(|n| f64::from(n) / f64::from(MIXTURES));
        mixtures.filter_map(|second| self.fit(second)).collect()
    }

    /// The scale by weighted least squares.
    fn fit(&self, second: f64) -> Option<Fit> {
        let weighted = |over: f64| {
            let error = (self.noise_g + 1.0).hypot(SHAPE_ERROR * over);
            1.0 / (error * error)
        };
        let (mut xy, mut xx) = (0.0, 0.0);
        for (at, over) in &self.seen {
            let (x, weight) = (shape(*at, second), weighted(*over));
            xy += weight * x * over;
            xx += weight * x * x;
        }
        if xx <= 0.0 {
            return None;
        }
        let scale = (xy / xx).max(0.0);
        let misfits = self.seen.iter().map(|(at, over)| {
            let miss = over - scale * shape(*at, second);
            weighted(*over) * miss * miss
        });
        Some(Fit {
            second,
            scale,
            unsure: 1.0 / xx.sqrt(),
            misfit: misfits.sum(),
        })
    }

    /// The fastest trial's overshoot, continued along a shape.
    fn from_fastest(&self, at: Contact, second: f64) -> f64 {
        let fastest = self.seen.iter();
        let fastest = fastest.max_by(|(a, _), (b, _)| a.speed.total_cmp(&b.speed));
        fastest.map_or(0.0, |(from, over)| {
            let grown = shape(at, second) / shape(*from, second).max(f64::EPSILON);
            (over + self.noise_g).max(1.0) * grown
        })
    }
}

/// Grams above the threshold on the published block, `second` of it as on the second hand.
fn shape(at: Contact, second: f64) -> f64 {
    (1.0 - second) * overshoot_g(at.speed, at.threshold_g)
        + second * second_hand_overshoot_g(at.speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(speed: f64) -> Contact {
        Contact {
            speed,
            threshold_g: 220.0,
        }
    }

    #[test]
    fn nothing_is_expected_before_anything_was_measured() {
        assert_eq!(PeakGrowth::default().likely(at(50.0)), None);
        assert_eq!(PeakGrowth::default().upper(at(50.0)), None);
    }

    #[test]
    fn one_slow_trial_allows_for_the_worse_hand_and_a_second_tells_them_apart() {
        let mut growth = PeakGrowth::default();
        growth.set_noise(2.0);
        growth.add(at(25.0), second_hand_overshoot_g(25.0));
        let worst = second_hand_overshoot_g(50.0);
        assert!(growth.upper(at(50.0)).unwrap() >= worst);
        let gentle = overshoot_g(25.0, 220.0) * 1.3;
        let mut known = PeakGrowth::default();
        known.set_noise(2.0);
        known.add(at(25.0), gentle);
        let before = known.upper(at(200.0)).unwrap();
        for speed in [35.0, 60.0] {
            known.add(at(speed), 1.3 * overshoot_g(speed, 220.0));
        }
        let after = known.upper(at(200.0)).unwrap();
        assert!(after < 0.6 * before, "{after} {before}");
        let truth = 1.3 * overshoot_g(200.0, 220.0);
        assert!(after >= truth, "{after} {truth}");
        assert!((known.likely(at(200.0)).unwrap() - truth).abs() < 0.15 * truth);
    }

    #[test]
    fn a_hand_like_neither_is_met_with_the_worst_of_both() {
        let mut growth = PeakGrowth::default();
        growth.set_noise(1.0);
        for (speed, over) in [(25.0, 300.0), (40.0, 20.0), (60.0, 250.0)] {
            growth.add(at(speed), over);
        }
        assert!(growth.upper(at(100.0)).unwrap() > 250.0);
    }
}
