//! Newtons of one joint: the factor between the hand's own grams (FORCE_ACT above its zero) and a kitchen scale, fitted to five loads.
//! Pure: moves nothing and reads no clock.
//!
//! The line goes through the origin: the joint's zero is measured unloaded before each load, and the scale shows 0 then. A fitted
//! offset would cost precision (three times the bound between 100 and 400 g) and would absorb a mistyped reading of the first or the
//! last load.

use crate::hand::statistics::median;
use crate::hand::{Dof, Finger, Force, PerDof};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Number of loads of a calibration.
pub const LOADS: usize = 5;
/// Smallest load, g.
pub const LEAST_LOAD_G: i16 = 100;
/// Smallest limit: below it five loads are too close to each other.
pub const LEAST_LIMIT_G: i16 = 250;
/// Largest limit, g: what a finger may press a kitchen scale with.
pub const MOST_LIMIT_G: i16 = 1000;
/// Largest reading of a scale that can be typed, g.
pub const READING_MAX_G: f64 = 100_000.0;
/// Share of newtons by which the fit may be uncertain.
pub const BOUND_MAX: f64 = 0.08;
/// Deviation of the fingertip's normal force from the fit that is reported, as a share.
pub const TIP_DEVIATION_MAX: f64 = 0.15;
/// Overshoot of the slowest approach on a hard scale, g: kept free below the limit.
const OVERSHOOT_G: i16 = 64;
/// Degrees of freedom of the fit.
const FREEDOM: f64 = 4.0;
/// Two-sided 95 % factor of Student's t for [`LOADS`] points and one parameter.
const STUDENT_95: f64 = 2.776;
/// Newtons of a gram on a scale.
pub const N_PER_G: f64 = 0.009_806_65;

/// A force in newtons, at these newtons for a gram; rounded to millinewtons.
pub fn newtons(force_g: f64, per_g: f64) -> f64 {
    (force_g * per_g * 1000.0).round() / 1000.0
}

/// Unit in which the forces of a hold are set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ForceUnit {
    /// Grams of each finger as this hand reads them.
    #[default]
    Grams,
    /// Newtons; the two forces are then grams of a scale.
    Newtons,
}

impl ForceUnit {
    /// Value in this unit of one gram of the two forces.
    pub const fn per_g(self) -> f64 {
        match self {
            Self::Grams => 1.0,
            Self::Newtons => N_PER_G,
        }
    }

    /// Reading of each joint for one gram of the two forces; `None` if the newtons of a finger are missing. The rotation of the thumb
    /// presses on nothing, and needs none.
    pub fn reading_per_g(self, newtons: &PerDof<Option<f64>>) -> Option<PerDof<f64>> {
        let is_known = Finger::ALL.map(Finger::bend).into_iter();
        let is_known = is_known.map(|dof| newtons[dof]).all(|own| own.is_some());
        match self {
            Self::Grams => Some(PerDof::splat(1.0)),
            Self::Newtons if is_known => {
                Some(newtons.map(|own| own.map_or(1.0, |own| N_PER_G / own)))
            }
            Self::Newtons => None,
        }
    }
}

/// Expected noise of the force reading, g: the noisiest of the known sensors.
const FORCE_NOISE_G: f64 = 8.0;
/// Standard deviation of a scale that rounds to 5 g.
const ROUNDING_G: f64 = 1.45;
/// Standard deviations that a reading may be off the line of the others: 1 in 80 calibrations at the expected noise exceeds it.
const DEVIATIONS: f64 = 3.0;
/// Grams of the scale for a gram of the hand; outside, the scale shows another unit. The published hands range from 0.66 to 1.32.
const PLAUSIBLE: RangeInclusive<f64> = 0.2..=4.0;

/// One load: what the hand felt, and what the scale showed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScalePoint {
    /// Number of the load, from 0.
    pub load: usize,
    /// FORCE_ACT above its zero, g of the hand.
    pub hand_g: f64,
    /// Reading of the scale, g.
    pub scale_g: f64,
    /// Normal force of the fingertip, N; `None` if it was not read.
    pub tip_n: Option<f64>,
}

/// Newtons of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ForceScale {
    /// Newtons of a gram of the hand.
    pub newtons_per_g: f64,
    /// Half of the 95 % interval of [`newtons_per_g`](Self::newtons_per_g), as a share of it.
    pub bound: f64,
    /// Deviation of the fingertip's normal force from the fit, as a share: 0.2 = the fingertip reports 20 % more. `None` if it was
    /// not read.
    pub tip_deviation: Option<f64>,
}

/// Reason why the points do not give newtons.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Contradiction {
    /// Fewer points than loads.
    #[error("{points} of {LOADS} loads are measured")]
    TooFew {
        /// Number of points.
        points: usize,
    },
    /// One point contradicts the others, or they scatter too much and it is the farthest.
    #[error("{scale_g} g does not fit the other four, which suggest {expected_g:.0} g")]
    Point {
        /// Number of its load.
        load: usize,
        /// Reading of the scale, g.
        scale_g: f64,
        /// Reading that the others suggest, g.
        expected_g: f64,
    },
    /// The factor is implausible.
    #[error(
        "the scale shows {factor:.2} g for each g of the hand: it does not show grams, or presses elsewhere"
    )]
    NotGrams {
        /// Grams of the scale for a gram of the hand.
        factor: f64,
    },
}

impl ForceScale {
    /// Fits the points of all loads.
    ///
    /// # Errors
    /// The points contradict each other, or there are fewer.
    pub fn fit(points: &[ScalePoint]) -> Result<Self, Contradiction> {
        let line = FittedLine::through(points.iter());
        if points.len() < LOADS {
            let points = points.len();
            return Err(Contradiction::TooFew { points });
        }
        let (distance, misfit) = farthest(points)?;
        if distance > DEVIATIONS {
            return Err(misfit);
        }
        let factor = line.factor;
        if !PLAUSIBLE.contains(&factor) {
            return Err(Contradiction::NotGrams { factor });
        }
        let residuals = points.iter().map(|own| line.residual(own).powi(2));
        let scatter = (residuals.sum::<f64>() / FREEDOM).sqrt();
        let bound = STUDENT_95 * scatter.max(ROUNDING_G) / line.squares.sqrt() / factor;
        if bound > BOUND_MAX {
            return Err(misfit);
        }
        let newtons_per_g = factor * N_PER_G;
        Ok(Self {
            newtons_per_g,
            bound,
            tip_deviation: tip_deviation(points, newtons_per_g),
        })
    }

    /// True if the fingertip's normal force contradicts the fit.
    pub fn tip_deviates(&self) -> bool {
        let deviation = self.tip_deviation.unwrap_or_default();
        deviation.abs() > TIP_DEVIATION_MAX
    }
}

/// A least-squares line through the origin.
#[derive(Debug, Clone, Copy)]
struct FittedLine {
    /// Grams of the scale for a gram of the hand.
    factor: f64,
    /// Sum of the squares of the hand's grams.
    squares: f64,
}

impl FittedLine {
    fn through<'a>(points: impl Iterator<Item = &'a ScalePoint> + Clone) -> Self {
        let squares: f64 = points.clone().map(|own| own.hand_g.powi(2)).sum();
        let products: f64 = points.map(|own| own.hand_g * own.scale_g).sum();
        Self {
            factor: products / squares,
            squares,
        }
    }

    fn residual(&self, point: &ScalePoint) -> f64 {
        point.scale_g - self.factor * point.hand_g
    }

    /// Distance of a point that the line was not fitted to, in standard deviations of a force with this noise in g of the scale.
    fn deviations(&self, point: &ScalePoint, force: f64) -> f64 {
        let own = force.powi(2) + ROUNDING_G.powi(2);
        let of_line = force.powi(2) * point.hand_g.powi(2) / self.squares;
        self.residual(point) / (own + of_line).sqrt()
    }
}

/// The point that is farthest from the line of the others, and its distance in standard deviations. A mistyped reading is far from a
/// line without it, while it draws a line of all points towards itself.
fn farthest(points: &[ScalePoint]) -> Result<(f64, Contradiction), Contradiction> {
    let ratios: Vec<f64> = points.iter().map(|own| own.scale_g / own.hand_g).collect();
    // Not of the lines: one that a wrong reading draws down would make the noise small, and right readings the farthest.
    let noise = FORCE_NOISE_G * median(&ratios).unwrap_or(1.0);
    let others = |load| points.iter().filter(move |own| own.load != load);
    let distances = points.iter().map(|own| {
        let line = FittedLine::through(others(own.load));
        let misfit = Contradiction::Point {
            load: own.load,
            scale_g: own.scale_g,
            expected_g: line.factor * own.hand_g,
        };
        (line.deviations(own, noise).abs(), misfit)
    });
    let farthest = distances.max_by(|one, two| one.0.total_cmp(&two.0));
    farthest.ok_or(Contradiction::TooFew { points: 0 })
}

/// Deviation of the fingertip's normal force; `None` unless it was read at every load.
fn tip_deviation(points: &[ScalePoint], newtons_per_g: f64) -> Option<f64> {
    let (mut products, mut squares) = (0.0, 0.0);
    for own in points {
        let newtons = own.hand_g * newtons_per_g;
        products += newtons * own.tip_n?;
        squares += newtons.powi(2);
    }
    Some(products / squares - 1.0)
}

/// Thresholds of the loads, g, evenly from the smallest to the largest whose overshoot on a hard scale stays below the limit.
pub fn loads(limit: Force) -> [Force; LOADS] {
    let most = limit.get() - OVERSHOOT_G;
    let mut part = 0;
    [(); LOADS].map(|()| {
        let load = LEAST_LOAD_G + (most - LEAST_LOAD_G) * part / 4;
        part += 1;
        Force::nearest(load.max(LEAST_LOAD_G))
    })
}

/// Points of a joint as stored. Complete once there is one for each load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointPoints {
    /// Limit of the loads, g.
    pub limit: Force,
    /// Day of the newest point.
    pub day: String,
    /// The accepted points.
    pub points: Vec<ScalePoint>,
}

impl JointPoints {
    /// Newtons of the joint.
    ///
    /// # Errors
    /// As [`ForceScale::fit`].
    pub fn scale(&self) -> Result<ForceScale, Contradiction> {
        ForceScale::fit(&self.points)
    }
}

/// Newtons of the joints of one hand.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct NewtonsMap {
    joints: BTreeMap<Dof, JointPoints>,
}

impl NewtonsMap {
    /// Points of a joint; `None` if it has none.
    pub fn points(&self, dof: Dof) -> Option<&JointPoints> {
        self.joints.get(&dof)
    }

    /// Joints with points, in register order.
    pub fn joints(&self) -> impl Iterator<Item = (Dof, &JointPoints)> {
        self.joints.iter().map(|(dof, own)| (*dof, own))
    }

    /// Newtons of a gram of each joint; `None` where they are unknown.
    pub fn per_g(&self) -> PerDof<Option<f64>> {
        PerDof::from_fn(|dof| Some(self.points(dof)?.scale().ok()?.newtons_per_g))
    }

    /// Replaces the points of a joint.
    pub fn put(&mut self, dof: Dof, points: JointPoints) {
        self.joints.insert(dof, points);
    }

    /// Removes a joint.
    pub fn forget(&mut self, dof: Dof) {
        self.joints.remove(&dof);
    }

    /// True if no joint has points.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fastrand::Rng;

    /// A normally distributed number with this standard deviation.
    fn normal(rng: &mut Rng, deviation: f64) -> f64 {
        let radius = (-2.0 * (1.0 - rng.f64()).ln()).sqrt();
        deviation * radius * (std::f64::consts::TAU * rng.f64()).cos()
    }

    /// Five loads as a hand with this factor and noise reads them, and a scale that rounds to 5 g shows them.
    fn measured(rng: &mut Rng, factor: f64, noise: f64) -> Vec<ScalePoint> {
        let loads = loads(Force::nearest(400)).into_iter().enumerate();
        let points = loads.map(|(load, threshold)| {
            let felt = f64::from(threshold.get()) + 60.0 * rng.f64();
            ScalePoint {
                load,
                hand_g: felt + normal(rng, noise),
                scale_g: (felt * factor / 5.0).round() * 5.0,
                tip_n: Some(felt * factor * N_PER_G),
            }
        });
        points.collect()
    }

    /// The number with a digit dropped or doubled, two neighbours swapped, or in another decade.
    fn mistyped(rng: &mut Rng, right: f64) -> f64 {
        loop {
            let digits = right.to_string().into_bytes();
            let (mut wrong, at) = (digits.clone(), rng.usize(..digits.len()));
            let mut decade = 1.0;
            match rng.u8(..4) {
                0 => drop(wrong.remove(at)),
                1 => wrong.insert(at, digits[at]),
                2 => wrong.swap(at.saturating_sub(1), at),
                _ => decade = if rng.bool() { 10.0 } else { 0.1 },
            }
            let text = String::from_utf8(wrong).unwrap();
            let typed = decade * text.parse::<f64>().unwrap_or_default();
            if (typed - right).abs() > 0.01 {
                return typed;
            }
        }
    }

    fn off(points: &[ScalePoint], factor: f64) -> f64 {
        (FittedLine::through(points.iter()).factor / factor - 1.0).abs()
    }

    #[test]
    fn a_mistyped_reading_is_named_and_newtons_are_within_8_percent() {
        const RUNS: usize = 10_000;
        let mut rng = Rng::with_seed(45);
        let (mut wrong, mut found, mut matter, mut matter_found) = (0, 0, 0, 0);
        let (mut alarms, mut beyond, mut worst, mut outside, mut refused) = (0, 0, 0.0_f64, 0, 0);
        for run in 0..RUNS {
            let factor = 0.5 + 0.9 * rng.f64();
            let noise = 3.0 + 5.0 * rng.f64();
            let mut points = measured(&mut rng, factor, noise);
            let right = points.clone();
            let at = (run % 5 == 0).then(|| rng.usize(..LOADS));
            if let Some(at) = at {
                points[at].scale_g = mistyped(&mut rng, points[at].scale_g);
            }
            let matters = at.is_some() && off(&points, factor) > 0.04;
            let fit = ForceScale::fit(&points);
            let named = match fit {
                Err(Contradiction::Point { load, .. }) => Some(load),
                _ => None,
            };
            if let Some(at) = at {
                let is_found = named == Some(at);
                wrong += 1;
                found += usize::from(is_found);
                matter += usize::from(matters);
                matter_found += usize::from(matters && is_found);
            } else {
                alarms += usize::from(named.is_some());
            }
            // The user types the named reading again, now correctly.
            let fit = if let Some(named) = named {
                points[named] = right[named];
                ForceScale::fit(&points)
            } else {
                fit
            };
            let Ok(fit) = fit else {
                refused += 1;
                continue;
            };
            let error = (fit.newtons_per_g / N_PER_G / factor - 1.0).abs();
            worst = worst.max(error);
            beyond += usize::from(error > 0.08);
            outside += usize::from(error > fit.bound);
        }
        println!(
            "{RUNS} calibrations: {found} of {wrong} mistypes found, {matter_found} of {matter} that matter; {alarms} false alarms; {refused} refused; {beyond} beyond 8 %, worst {:.1} %, {outside} outside their bound",
            100.0 * worst
        );
        assert!(matter_found * 100 >= matter * 98, "{matter_found}/{matter}");
        assert!(found * 100 >= wrong * 90, "{found}/{wrong}");
        assert!(alarms * 100 <= RUNS, "{alarms}");
        assert!(refused * 100 <= RUNS, "{refused}");
        assert_eq!(beyond, 0, "{worst}");
        assert!(outside * 100 <= 6 * RUNS, "{outside}");
    }

    #[test]
    fn the_loads_are_spread_below_the_limit() {
        let grams = |limit| loads(Force::nearest(limit)).map(Force::get);
        assert_eq!(grams(400), [100, 159, 218, 277, 336]);
        assert_eq!(grams(LEAST_LIMIT_G), [100, 121, 143, 164, 186]);
        assert_eq!(grams(1000)[4], 936);
    }

    #[test]
    fn what_contradicts_has_a_name() {
        let points = |factors: [f64; LOADS]| {
            let each = factors.into_iter().enumerate();
            let each = each.map(|(load, factor)| {
                let hand_g = [150.0, 210.0, 270.0, 330.0, 390.0][load];
                ScalePoint {
                    load,
                    hand_g,
                    scale_g: hand_g * factor,
                    tip_n: Some(hand_g * N_PER_G),
                }
            });
            each.collect::<Vec<_>>()
        };
        let fit = |factors| ForceScale::fit(&points(factors));
        let good = fit([0.8; LOADS]).unwrap();
        assert!((good.newtons_per_g - 0.8 * N_PER_G).abs() < 1e-9);
        assert!(good.tip_deviates(), "{good:?}");
        assert!((good.tip_deviation.unwrap() - 0.25).abs() < 1e-9);
        assert!(!fit([1.1; LOADS]).unwrap().tip_deviates());
        let words = fit([1.0, 1.0, 1.0, 0.1, 1.0]).unwrap_err().to_string();
        assert_eq!(
            words,
            "33 g does not fit the other four, which suggest 330 g"
        );
        let ounces = fit([0.035; LOADS]).unwrap_err();
        assert!(matches!(ounces, Contradiction::NotGrams { .. }));
        let few = ForceScale::fit(&points([1.0; LOADS])[..4]).unwrap_err();
        assert_eq!(few, Contradiction::TooFew { points: 4 });
        let mut untouched = points([1.0; LOADS]);
        untouched[2].tip_n = None;
        let fit = ForceScale::fit(&untouched).unwrap();
        assert_eq!(fit.tip_deviation, None);
        assert!(!fit.tip_deviates());
    }

    #[test]
    fn forces_in_newtons_need_those_of_all_fingers_and_no_rotation() {
        let of_fingers = |missing: Option<Dof>| {
            PerDof::from_fn(|dof| {
                let is_known = dof != Dof::ThumbRotate && Some(dof) != missing;
                is_known.then_some(2.0 * N_PER_G)
            })
        };
        let reading = |unit: ForceUnit, missing| unit.reading_per_g(&of_fingers(missing));
        let half = reading(ForceUnit::Newtons, None).unwrap();
        assert_eq!(half[Dof::Index], 0.5, "2 g of a scale are one of the hand");
        for finger in Finger::ALL {
            let missing = Some(finger.bend());
            assert_eq!(reading(ForceUnit::Newtons, missing), None, "{finger:?}");
            assert_eq!(reading(ForceUnit::Grams, missing), Some(PerDof::splat(1.0)));
        }
    }
}
