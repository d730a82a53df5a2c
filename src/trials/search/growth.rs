//! Growth of a peak with the speed: measurements on this object, extrapolated along shapes seen on hands of the family,
//! above the force at which the drive stops. The shapes choose the next trial; a claim uses them only for the
//! minimum scatter of its peaks. Pure.

use crate::hand::impact::{overshoot_g, second_hand_overshoot_g};
use crate::hand::statistics::{count, mean, median, spread};
use crate::trials::search::offset::{OffsetEvidence, ThresholdReference};
use crate::trials::search::peak::{CarriedPeaks, ContactSetting, SeenPeak};

/// Number of mixtures of the two published shapes.
const MIXTURES: u32 = 10;
/// Candidate paces of this hand, relative to the published ones.
const PACES: [f64; 4] = [0.85, 0.9, 0.95, 1.0];
/// Powers for constantly late stops: the way grows with the speed, and the force with a power of the way, above one for an object
/// that stiffens as it is pressed.
const POWERS: [f64; 4] = [1.0, 1.25, 1.5, 2.0];
/// Below this threshold, g, the published peaks are not reliable; a lower one is extrapolated from here.
const LIGHT_G: f64 = 100.0;
/// Prior scatter of a peak, as a share of its overshoot, and its weight in closes.
const REPEATS_TO: f64 = 0.035;
const REPEATS_TRUST: f64 = 6.0;
/// Degrees of freedom used by a fit: scale, shape, reference.
const FITTED: f64 = 2.0;
/// Possible deviation of a shape from this hand's, as a share of the overshoot.
const SHAPE_ERROR: f64 = 0.10;
/// A shape whose fit is this much worse than the best is still possible (chi-square).
const POSSIBLE: f64 = 4.0;
/// A reference whose fit is this much worse than the best is still possible: an offset resembles a slower start.
const COMPARED_POSSIBLE: f64 = 25.0;
/// A reference whose fit is this much worse is excluded.
const COMPARED_TOLD: f64 = 9.0;
/// A best fit worse than this per trial means that no shape matches this hand.
const STRANGE: f64 = 6.0;
/// Closes slower than this share of the speed do not count for it.
const NEAR: f64 = 0.3;
/// Number of closes with a reliable median, and the largest correction by it.
const MIDDLE_LEAST: usize = 5;
const CARRY_MOST: f64 = 2.0;
/// In that case the worst shape is used, with this factor.
const STRANGE_MORE: f64 = 1.3;

/// Peak model of one joint, from its closes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PeakGrowth {
    seen: Vec<SeenPeak>,
    evidence: OffsetEvidence,
    noise_g: f64,
    /// The fitted shapes: the best, and all that are possible.
    best: Option<GrowthFit>,
    possible: Vec<GrowthFit>,
    is_strange: bool,
    /// Scatter of a peak, as a share of its overshoot.
    repeats_to: f64,
    /// Misfit of the best fit for each reference.
    as_read: Option<f64>,
    above_rest: Option<f64>,
}

/// A fitted shape.
#[derive(Debug, Clone, Copy, PartialEq)]
struct GrowthFit {
    compared: ThresholdReference,
    shape: GrowthShape,
    scale: f64,
    unsure: f64,
    misfit: f64,
    /// The misfit with one mean close per setting: a shape has the same error in each repeat, so repeats do not discriminate.
    misfit_of_settings: f64,
}

impl PeakGrowth {
    /// Adds a close.
    pub fn add(&mut self, seen: SeenPeak) {
        self.seen.push(seen);
        self.evidence.add(&seen, self.noise_g);
        self.fit_all();
    }

    /// Sets the noise of the force for further closes, g.
    pub const fn set_noise(&mut self, noise_g: f64) {
        self.noise_g = noise_g;
    }

    /// Notes a drive that stopped with nothing in its way, because its sensor reads its threshold at rest.
    pub fn stopped_in_air(&mut self, offset_g: f64) {
        self.evidence.stopped_in_air(offset_g);
    }

    /// Reading of the sensor at rest before the last close, g.
    pub fn offset_g(&self) -> f64 {
        self.evidence.offset_g()
    }

    /// The reference of the drive's threshold; `None` if the closes do not determine it.
    pub fn compared(&self) -> Option<ThresholdReference> {
        self.evidence.reference().or_else(|| {
            let (as_read, above_rest) = (self.as_read?, self.above_rest?);
            if as_read + COMPARED_TOLD < above_rest {
                Some(ThresholdReference::AsRead)
            } else if above_rest + COMPARED_TOLD < as_read {
                Some(ThresholdReference::AboveRest)
            } else {
                None
            }
        })
    }

    /// The fastest speed so far; `None` without closes.
    pub fn fastest(&self) -> Option<f64> {
        let speeds = self.seen.iter().map(|own| own.at.speed);
        speeds.reduce(f64::max)
    }

    /// The highest force above rest at which a threshold has probably stopped it, g.
    pub fn stopped_most(&self) -> f64 {
        let thresholds = self.seen.iter().map(|own| own.at.threshold_g);
        self.stops_at(thresholds.fold(0.0, f64::max))
    }

    /// The force above rest at which a threshold probably stops the drive, g.
    pub fn stops_at(&self, threshold_g: f64) -> f64 {
        let compared = self.best.map(|fit| fit.compared);
        let compared = compared.or(self.compared()).unwrap_or_default();
        compared.stops_at(threshold_g, self.offset_g())
    }

    /// The expected peak, g; `None` before any was measured.
    pub fn likely(&self, at: ContactSetting) -> Option<f64> {
        let best = self.best.as_ref()?;
        let stops_at = best.compared.stops_at(at.threshold_g, self.offset_g());
        let over = best.shape.peak_g(at.speed, stops_at, best.scale) - stops_at;
        Some(stops_at + over * self.correction(best, at.speed))
    }

    /// Ratio of measured to fitted overshoot, interpolated between the nearest trials on both sides.
    fn correction(&self, fit: &GrowthFit, speed: f64) -> f64 {
        let side = |is_on_it: &dyn Fn(f64) -> bool, nearer: &dyn Fn(f64, f64) -> bool| {
            let on_it = self.seen.iter().map(|own| own.at.speed);
            let nearest = on_it.filter(|own| is_on_it(*own));
            let nearest = nearest.reduce(|a, b| if nearer(a, b) { a } else { b })?;
            let there = self.seen.iter().filter(|own| own.at.speed == nearest);
            let (mut over, mut fitted) = (0.0, 0.0);
            for own in there {
                over += fit.compared.over_g(own);
                fitted += fit.over_g(own);
            }
            // Overshoots no larger than noise carry no information.
            let is_significant = fitted > 5.0 * self.noise_g && over > 0.0;
            is_significant.then(|| (nearest, over / fitted))
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

    /// The highest possible mean peak, g; `None` without a fit.
    pub fn upper(&self, at: ContactSetting) -> Option<f64> {
        let most = self.possible.iter().map(|fit| {
            let stops_at = fit.compared.stops_at(at.threshold_g, self.offset_g());
            if self.is_strange {
                let scale = self.scale_of_fastest(fit);
                let peak = fit.shape.peak_g(at.speed, stops_at, scale);
                stops_at + STRANGE_MORE * (peak - stops_at)
            } else {
                let scale = fit.scale + 2.0 * fit.unsure;
                fit.shape.peak_g(at.speed, stops_at, scale)
            }
        });
        most.reduce(f64::max)
    }

    /// The peaks of all relevant closes, those at this speed or faster and somewhat slower ones, scaled to it along the best
    /// shape: a stop that was late in one of them would be equally late here. Once there are several closes at this setting, their
    /// median corrects the scaling.
    pub fn carried(&self, at: ContactSetting) -> CarriedPeaks {
        let Some(best) = self.best.as_ref() else {
            return CarriedPeaks::default();
        };
        let stops_at = best.compared.stops_at(at.threshold_g, self.offset_g());
        let there = best.shape.peak_g(at.speed, stops_at, best.scale) - stops_at;
        let mut carried = CarriedPeaks::default();
        let mut elsewhere = Vec::new();
        for own in self
            .seen
            .iter()
            .filter(|own| own.at.speed >= NEAR * at.speed)
        {
            carried.certain += usize::from(own.is_certain);
            if own.at == at {
                carried.here_g.push(own.peak_g);
                continue;
            }
            let from = best.over_g(own);
            let over = best.compared.over_g(own);
            let grown = if over > 0.0 {
                there / from.max(f64::EPSILON)
            } else {
                1.0
            };
            elsewhere.push(over * grown);
        }
        let least = elsewhere.len().min(carried.here_g.len());
        let middles = median(&carried.here_g).zip(median(&elsewhere));
        let carry = middles
            .filter(|_| least >= MIDDLE_LEAST)
            .map_or(1.0, |(here, other)| {
                ((here - stops_at) / other.max(1.0)).clamp(1.0 / CARRY_MOST, CARRY_MOST)
            });
        let here = carried.here_g.iter().copied();
        let elsewhere = elsewhere.iter().map(|over| stops_at + over * carry);
        carried.peaks_g = here.chain(elsewhere).collect();
        carried
    }

    pub fn closes(&self) -> usize {
        self.seen.len()
    }

    /// Standard deviation of single closes around the expected peak, g.
    pub fn scatter(&self, at: ContactSetting) -> f64 {
        let over = self.likely(at).unwrap_or_default() - self.stops_at(at.threshold_g);
        self.noise_g.hypot(self.repeats_to * over)
    }

    /// Scatter from repeated settings, and from the deviation of single closes from the best fit.
    fn repeated(&self) -> f64 {
        let (mut squares, mut freedom) = (REPEATS_TRUST * REPEATS_TO.powi(2), REPEATS_TRUST);
        let mut fitted = FITTED;
        let compared = self
            .best
            .map_or(ThresholdReference::AboveRest, |fit| fit.compared);
        for (nth, own) in self.seen.iter().enumerate() {
            let is_first = self.seen.iter().take(nth).all(|other| other.at != own.at);
            let same = self.seen.iter().filter(|other| other.at == own.at);
            let same: Vec<f64> = same.map(|own| compared.over_g(own)).collect();
            let mean = mean(&same).unwrap_or_default();
            if is_first && same.len() > 1 && mean > 10.0 * self.noise_g {
                squares += spread(&same) / mean.powi(2);
                freedom += count(&same) - 1.0;
            }
            let single = self.best.filter(|_| same.len() == 1);
            let over = single.map(|fit| (compared.over_g(own), fit.over_g(own)));
            if let Some((over, fit)) = over.filter(|(_, fit)| *fit > 10.0 * self.noise_g) {
                squares += (over / fit - 1.0).powi(2);
                // As many closes as the fit has parameters add no degrees of freedom.
                freedom += if fitted > 0.0 { 0.0 } else { 1.0 };
                fitted -= 1.0;
            }
        }
        (squares / freedom).sqrt()
    }

    fn fit_all(&mut self) {
        let mixtures = (0..=MIXTURES).map(|n| f64::from(n) / f64::from(MIXTURES));
        let mixtures =
            mixtures.flat_map(|second| PACES.map(|pace| GrowthShape::Published { second, pace }));
        let shapes: Vec<GrowthShape> = mixtures.chain(POWERS.map(GrowthShape::Late)).collect();
        let repeats = self.repeats();
        let fits_of = |compared: ThresholdReference| -> Vec<GrowthFit> {
            let shapes = shapes.iter();
            let fits = shapes.filter_map(|shape| self.fit(compared, *shape, &repeats));
            fits.collect()
        };
        let all: Vec<Vec<GrowthFit>> = self.evidence.possible().into_iter().map(fits_of).collect();
        let best = all
            .iter()
            .flatten()
            .min_by(|a, b| a.misfit.total_cmp(&b.misfit));
        let best = best.copied();
        let least = best.map_or(0.0, |fit| fit.misfit);
        let misfit_of = |compared: ThresholdReference| {
            let own = all.iter().flatten().filter(|fit| fit.compared == compared);
            own.map(|fit| fit.misfit).reduce(f64::min)
        };
        let evidence_of = |compared: ThresholdReference| {
            let own = all.iter().flatten().filter(|fit| fit.compared == compared);
            own.map(|fit| fit.misfit_of_settings).reduce(f64::min)
        };
        self.as_read = evidence_of(ThresholdReference::AsRead);
        self.above_rest = evidence_of(ThresholdReference::AboveRest);
        let trials: f64 = self.seen.iter().map(|_| 1.0).sum();
        self.is_strange = least > STRANGE * trials;
        let possible = all.iter().flatten().filter(|fit| {
            let own = misfit_of(fit.compared).unwrap_or_default();
            let fits = self.is_strange || fit.misfit <= own + POSSIBLE;
            fits && own <= least + COMPARED_POSSIBLE
        });
        self.possible = possible.copied().collect();
        self.best = best;
        self.repeats_to = self.repeated();
    }

    /// Number of closes with the same speed and threshold, for each close.
    fn repeats(&self) -> Vec<f64> {
        let same = |own: &SeenPeak| {
            let same = self.seen.iter().filter(|other| other.at == own.at);
            same.map(|_| 1.0).sum()
        };
        self.seen.iter().map(same).collect()
    }

    /// Fits the scale by weighted least squares. A peak below the force that stops the drive shows no overshoot and is skipped.
    fn fit(
        &self,
        compared: ThresholdReference,
        shape: GrowthShape,
        repeats: &[f64],
    ) -> Option<GrowthFit> {
        let noise = self.noise_g + 1.0;
        let (mut xy, mut xx) = (0.0, 0.0);
        let is_consistent = |own: &&SeenPeak| !compared.is_contradicted_by(own, self.noise_g);
        let points: Vec<(f64, (f64, f64, f64))> = self
            .seen
            .iter()
            .zip(repeats)
            .filter(|(own, _)| is_consistent(own))
            .map(|(own, repeats)| {
                let over = compared.over_g(own);
                let error = noise.hypot(SHAPE_ERROR * over).hypot(own.missed_g / 2.0);
                let peak = own.peak_g + own.missed_g / 2.0;
                let point = shape.point(own.at.speed, compared.stops_at_in(own), (peak, error));
                (*repeats, point)
            })
            .collect();
        for (_, (x, over, weight)) in &points {
            xy += weight * x * over;
            xx += weight * x * x;
        }
        if xx <= 0.0 {
            return None;
        }
        let scale = (xy / xx).max(0.0);
        let (mut misfit, mut misfit_of_settings) = (0.0, 0.0);
        for (repeats, (x, over, weight)) in &points {
            let own = weight * (over - scale * x).powi(2);
            misfit += own;
            misfit_of_settings += own / repeats;
        }
        Some(GrowthFit {
            compared,
            shape,
            scale,
            unsure: 1.0 / xx.sqrt(),
            misfit,
            misfit_of_settings,
        })
    }

    /// The scale at which a shape passes through the fastest trial.
    fn scale_of_fastest(&self, fit: &GrowthFit) -> f64 {
        let fastest = self.seen.iter();
        let fastest = fastest.max_by(|a, b| a.at.speed.total_cmp(&b.at.speed));
        fastest.map_or(0.0, |from| {
            let stops_at = fit.compared.stops_at_in(from);
            let over = (fit.compared.over_g(from).max(0.0) + self.noise_g + from.missed_g).max(1.0);
            let (x, y, _) = fit
                .shape
                .point(from.at.speed, stops_at, (stops_at + over, 1.0));
            y / x.max(f64::EPSILON)
        })
    }
}

impl GrowthFit {
    /// The fitted overshoot of a close, g.
    fn over_g(&self, seen: &SeenPeak) -> f64 {
        let stops_at = self.compared.stops_at_in(seen);
        self.shape.peak_g(seen.at.speed, stops_at, self.scale) - stops_at
    }
}

/// Shape of the growth of a peak with the speed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum GrowthShape {
    /// As measured on the published block.
    Published {
        /// Share of the second hand's shape, 0..=1.
        second: f64,
        /// Speed of this hand relative to the published ones.
        pace: f64,
    },
    /// The way is proportional to the speed, and the force grows with this power of the way.
    Late(f64),
}

impl GrowthShape {
    /// The peak of a drive that is stopped at this force, g.
    fn peak_g(self, speed: f64, stops_at: f64, scale: f64) -> f64 {
        match self {
            Self::Published { second, pace } => {
                stops_at + scale * published_g(speed * pace, stops_at, second)
            }
            Self::Late(power) => (stops_at.powf(1.0 / power) + scale * speed)
                .max(0.0)
                .powf(power),
        }
    }

    /// A peak and its error as a point on a line through zero, whose slope is the scale: x, y, and the weight of y.
    fn point(self, speed: f64, stops_at: f64, (peak_g, error_g): (f64, f64)) -> (f64, f64, f64) {
        match self {
            Self::Published { second, pace } => (
                published_g(speed * pace, stops_at, second),
                peak_g - stops_at,
                error_g.powi(-2),
            ),
            Self::Late(power) => {
                let way = |force: f64| force.max(1.0).powf(1.0 / power);
                let error = error_g * way(peak_g) / (power * peak_g.max(1.0));
                let y = way(peak_g) - stops_at.powf(1.0 / power);
                (speed, y, error.powi(-2))
            }
        }
    }
}

/// Overshoot on the published block, g.
fn published_g(speed: f64, threshold_g: f64, second: f64) -> f64 {
    (1.0 - second) * overshoot_g(speed, threshold_g.max(LIGHT_G))
        + second * second_hand_overshoot_g(speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(speed: f64) -> ContactSetting {
        ContactSetting {
            speed,
            threshold_g: 220.0,
        }
    }

    fn seen(at: ContactSetting, offset_g: f64, peak_g: f64) -> SeenPeak {
        SeenPeak {
            at,
            offset_g,
            peak_g,
            missed_g: 0.0,
            is_certain: true,
        }
    }

    fn known(noise_g: f64, closes: &[SeenPeak]) -> PeakGrowth {
        let mut growth = PeakGrowth::default();
        growth.set_noise(noise_g);
        for close in closes {
            growth.add(*close);
        }
        growth
    }

    #[test]
    fn nothing_is_expected_before_anything_was_measured() {
        assert_eq!(PeakGrowth::default().likely(at(50.0)), None);
        assert_eq!(PeakGrowth::default().upper(at(50.0)), None);
    }

    #[test]
    fn one_slow_trial_allows_for_the_worse_hand_and_a_second_tells_them_apart() {
        let first = known(
            2.0,
            &[seen(at(25.0), 0.0, 220.0 + second_hand_overshoot_g(25.0))],
        );
        let worst = 220.0 + second_hand_overshoot_g(50.0);
        assert!(first.upper(at(50.0)).unwrap() >= worst);
        let peak = |speed: f64| 220.0 + 1.3 * overshoot_g(speed, 220.0);
        let closes = [25.0, 35.0, 60.0].map(|speed| seen(at(speed), 0.0, peak(speed)));
        let before = known(2.0, &closes[..1]).upper(at(200.0)).unwrap();
        let after = known(2.0, &closes);
        let upper = after.upper(at(200.0)).unwrap();
        assert!(upper < 0.6 * before, "{upper} {before}");
        let truth = peak(200.0);
        assert!(upper >= truth, "{upper} {truth}");
        assert!((after.likely(at(200.0)).unwrap() - truth).abs() < 0.1 * truth);
    }

    #[test]
    fn a_hand_like_neither_is_met_with_the_worst_of_both() {
        let closes = [(25.0, 300.0), (40.0, 20.0), (60.0, 250.0)];
        let closes = closes.map(|(speed, over)| seen(at(speed), 0.0, 220.0 + over));
        let growth = known(1.0, &closes);
        assert!(growth.upper(at(100.0)).unwrap() > 220.0 + 250.0);
    }

    /// A drive with 60 ms of overrun at 1.5 units per second for each unit of speed, on 25 g per unit.
    fn late_g(speed: f64) -> f64 {
        speed * 1.5 * 0.06 * 25.0
    }

    #[test]
    fn a_peak_below_the_threshold_is_no_leave_to_go_faster() {
        // The sensor reads 146 g at rest, and the drive counts them: a threshold of 220 g stops it at 74.
        let stops_at = 220.0 - 146.0;
        let closes = [25.0, 8.0].map(|speed| seen(at(speed), 146.0, stops_at + late_g(speed)));
        let growth = known(3.0, &closes);
        assert_eq!(growth.compared(), Some(ThresholdReference::AsRead));
        for speed in [50.0, 200.0, 434.0, 1000.0] {
            let (upper, truth) = (growth.upper(at(speed)).unwrap(), stops_at + late_g(speed));
            assert!(upper > truth, "{speed}: {upper} {truth}");
        }
    }

    #[test]
    fn a_drive_that_does_not_count_the_offset_is_told_by_a_negative_one() {
        let closes = [25.0, 8.0].map(|speed| seen(at(speed), -60.0, 220.0 + 0.2 * late_g(speed)));
        let growth = known(3.0, &closes);
        assert_eq!(growth.compared(), Some(ThresholdReference::AboveRest));
    }

    #[test]
    fn where_the_closes_do_not_tell_the_higher_peak_of_both_is_allowed_for() {
        let growth = known(3.0, &[seen(at(25.0), 60.0, 220.0 + 40.0)]);
        assert_eq!(growth.compared(), None);
        // With the offset counted, the overshoot is 100 g, and twice that at twice the speed.
        assert!(growth.upper(at(50.0)).unwrap() >= 160.0 + 200.0);
    }

    #[test]
    fn a_peak_below_both_is_all_taken_for_overshoot() {
        let growth = known(3.0, &[seen(at(25.0), 0.0, 120.0)]);
        assert_eq!(growth.compared(), None);
        assert!(growth.upper(at(50.0)).unwrap() >= 240.0);
    }

    #[test]
    fn what_may_have_been_missed_between_two_readings_is_allowed_for() {
        let close = seen(at(25.0), 0.0, 240.0);
        let missed = SeenPeak {
            missed_g: 60.0,
            ..close
        };
        let upper = |close| known(2.0, &[close]).upper(at(50.0)).unwrap();
        assert!(upper(missed) > upper(close) + 60.0);
    }
}
