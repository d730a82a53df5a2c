//! How a peak grows with the speed: what was measured on this object, continued along the shapes that two hands of the family
//! showed. The shapes choose the next trial; a claim takes no more of them than the least scatter of its peaks. Pure.

use crate::hand::impact::{overshoot_g, second_hand_overshoot_g};

/// Mixtures of the two published shapes that are tried.
const MIXTURES: u32 = 20;
/// How fast this hand may be for each unit of speed, of what the published ones are.
const PACES: [f64; 4] = [0.85, 0.9, 0.95, 1.0];
/// A peak repeats itself to this share of its overshoot, as far as nothing else is known; that counts as so many closes.
const REPEATS_TO: f64 = 0.035;
const REPEATS_TRUST: f64 = 6.0;
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
    /// The shapes, fitted to what was seen.
    fits: Vec<Fit>,
}

/// A mixture of the shapes, fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Fit {
    shape: Shape,
    scale: f64,
    /// Standard deviation of the scale.
    unsure: f64,
    misfit: f64,
}

impl PeakGrowth {
    /// Takes one close.
    pub fn add(&mut self, contact: Contact, over_g: f64) {
        self.seen.push((contact, over_g));
        self.fit_all();
    }

    /// Takes over the noise of the force, g.
    pub fn set_noise(&mut self, noise_g: f64) {
        self.noise_g = noise_g;
        self.fit_all();
    }

    /// What is likely above the threshold, g; `None` before anything was measured.
    pub fn likely(&self, at: Contact) -> Option<f64> {
        let best = self.best()?;
        Some(best.scale * best.shape.over_g(at) * self.correction(best, at.speed))
    }

    /// What the nearest trials on either side were of what the fit says of them.
    fn correction(&self, fit: &Fit, speed: f64) -> f64 {
        let side = |is_on_it: &dyn Fn(f64) -> bool, nearer: &dyn Fn(f64, f64) -> bool| {
            let on_it = self.seen.iter().map(|(at, _)| at.speed);
            let nearest = on_it.filter(|own| is_on_it(*own));
            let nearest = nearest.reduce(|a, b| if nearer(a, b) { a } else { b })?;
            let there = self.seen.iter().filter(|(at, _)| at.speed == nearest);
            let (mut over, mut fitted) = (0.0, 0.0);
            for (at, own) in there {
                over += own;
                fitted += fit.scale * fit.shape.over_g(*at);
            }
            // Of peaks that are no more than noise nothing can be said.
            let tells = fitted > 5.0 * self.noise_g && over > 0.0;
            tells.then(|| (nearest, over / fitted))
        };
        let below = side(&|own| own <= speed, &|a, b| a >= b);
        let above = side(&|own| own >= speed, &|a, b| a <= b);
        match (below, above) {
            (Some((low, first)), Some((high, second))) if high > low => {
                first + (second - first) * (speed - low) / (high - low)
            }
            (Some((_, own)), _) | (None, Some((_, own))) => own,
            (None, None) => 1.0,
        }
    }

    /// The most that is possible above the threshold on average, g.
    pub fn upper(&self, at: Contact) -> Option<f64> {
        let best = self.best()?;
        let trials: f64 = self.seen.iter().map(|_| 1.0).sum();
        let is_strange = best.misfit > STRANGE * trials;
        let possible = self
            .fits
            .iter()
            .filter(|fit| is_strange || fit.misfit <= best.misfit + POSSIBLE);
        let most = possible.map(|fit| {
            if is_strange {
                STRANGE_MORE * self.grown_from_fastest(at, fit.shape)
            } else {
                (fit.scale + 2.0 * fit.unsure) * fit.shape.over_g(at)
            }
        });
        most.reduce(f64::max)
    }

    /// Standard deviation of single closes around what is likely, g.
    pub fn scatter(&self, at: Contact) -> f64 {
        let over = self.likely(at).unwrap_or_default();
        self.noise_g.hypot(self.repeats_to() * over)
    }

    /// To what share of its overshoot a peak repeats itself, from the settings that were closed more than once.
    fn repeats_to(&self) -> f64 {
        let (mut squares, mut freedom) = (REPEATS_TRUST * REPEATS_TO.powi(2), REPEATS_TRUST);
        for (nth, (at, _)) in self.seen.iter().enumerate() {
            let is_first = self.seen.iter().take(nth).all(|(other, _)| other != at);
            let same = self.seen.iter().filter(|(other, _)| other == at);
            let same: Vec<f64> = same.map(|(_, over)| *over).collect();
            let n: f64 = same.iter().map(|_| 1.0).sum();
            let mean = same.iter().sum::<f64>() / n;
            if is_first && n > 1.0 && mean > 10.0 * self.noise_g {
                squares += same
                    .iter()
                    .map(|own| (own / mean - 1.0).powi(2))
                    .sum::<f64>();
                freedom += n - 1.0;
            }
        }
        (squares / freedom).sqrt()
    }

    fn best(&self) -> Option<&Fit> {
        let fits = self.fits.iter();
        fits.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    fn fit_all(&mut self) {
        let mixtures = (0..=MIXTURES).map(|n| f64::from(n) / f64::from(MIXTURES));
        let shapes = mixtures.flat_map(|second| PACES.map(|pace| Shape { second, pace }));
        self.fits = shapes.filter_map(|shape| self.fit(shape)).collect();
    }

    /// The scale by weighted least squares.
    fn fit(&self, shape: Shape) -> Option<Fit> {
        let weighted = |over: f64| {
            let error = (self.noise_g + 1.0).hypot(SHAPE_ERROR * over);
            1.0 / (error * error)
        };
        let (mut xy, mut xx) = (0.0, 0.0);
        for (at, over) in &self.seen {
            let (x, weight) = (shape.over_g(*at), weighted(*over));
            xy += weight * x * over;
            xx += weight * x * x;
        }
        if xx <= 0.0 {
            return None;
        }
        let scale = (xy / xx).max(0.0);
        let misfits = self.seen.iter().map(|(at, over)| {
            let miss = over - scale * shape.over_g(*at);
            weighted(*over) * miss * miss
        });
        Some(Fit {
            shape,
            scale,
            unsure: 1.0 / xx.sqrt(),
            misfit: misfits.sum(),
        })
    }

    /// The fastest trial's overshoot, continued along a shape.
    fn grown_from_fastest(&self, at: Contact, shape: Shape) -> f64 {
        let fastest = self.seen.iter();
        let fastest = fastest.max_by(|(a, _), (b, _)| a.speed.total_cmp(&b.speed));
        fastest.map_or(0.0, |(from, over)| {
            let grown = shape.over_g(at) / shape.over_g(*from).max(f64::EPSILON);
            (over + self.noise_g).max(1.0) * grown
        })
    }
}

/// Grams above the threshold on the published block.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shape {
    /// How much of it is as on the second hand, 0..=1.
    second: f64,
    /// How fast the hand is of what the published ones are.
    pace: f64,
}

impl Shape {
    fn over_g(self, at: Contact) -> f64 {
        let speed = at.speed * self.pace;
        (1.0 - self.second) * overshoot_g(speed, at.threshold_g)
            + self.second * second_hand_overshoot_g(speed)
    }
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
