//! One finger that holds an object: the force it should press with, and the steps of its angle target that lead there. Pure.

use crate::hand::grip::TightenCause;
use crate::hand::statistics::{mean, median};
use crate::hand::{Angle, Moment, Speed};
use crate::motion::held_object::TipLoad;
use std::collections::VecDeque;
use std::time::Duration;

/// Stiffness assumed before the first step shows it: that of a hard block, g per unit of angle.
const HARD_G: f64 = 60.0;
/// Possible stiffness of a contact, g per unit of angle.
const STIFFNESS_G: std::ops::RangeInclusive<f64> = 1.0..=120.0;
/// Ratio of tangential to normal force that is expected to hold on any object, before this one has shown more or less.
pub(crate) const USUAL_FRICTION: f64 = 0.35;
/// Share of the friction that is kept in reserve.
pub(crate) const MARGIN: f64 = 0.15;
/// The same while the load rises.
const MOVING_MARGIN: f64 = 0.34;
/// Share of the ratio at which an object slid that still holds it.
const BELOW_SLIP: f64 = 0.85;
/// The wanted force changes only if the need differs by this factor.
const HYSTERESIS: f64 = 1.05;
/// *At most* does not suffice for a load that needs more than this multiple of it.
const SHORT_FACTOR: f64 = 1.08;
/// A finger is no longer short once the load needs less than this share of *at most*.
const NO_LONGER_SHORT: f64 = 0.95;
/// Increase of the force after a slip, at least.
const SLIP_FACTOR: f64 = 1.25;
/// A step of [`STEP_S`] has its effect after this time: the hand acts 66 ms late, and the reading comes later still.
const EFFECT: Duration = Duration::from_millis(180);
/// Time in which a step should be completed.
const STEP_S: f64 = 0.08;
/// Counts per second of a unit of speed, as published.
const COUNTS_PER_SPEED: f64 = 3.04;
/// Speed limit of a step times the stiffness: a stiff contact is approached slowly, because a drive that meets its threshold runs on.
const SPEED_BY_STIFFNESS: f64 = 8000.0;
/// Share of *at most* from which steps are slower, and by how much.
const NEAR_MOST: f64 = 0.7;
const NEAR_SLOWER: f64 = 5.0;
/// A rising load is extrapolated over this time: until a step acts.
const AHEAD_S: f64 = 0.2;
/// Time without a disturbance after which the force is reduced, and the time between two reductions of the wanted force.
const QUIET: Duration = Duration::from_millis(350);
const RELAX_INTERVAL: Duration = Duration::from_millis(400);
/// Longest such time: it grows with the surges of the load, each of which counts for about this time, s.
const QUIET_LONGEST: Duration = Duration::from_secs(3);
const SURGE_S: f64 = 3.0;
/// A reduction that had to be taken back is not tried again for this time, or until the load changes.
const RELAX_PAUSE: Duration = Duration::from_secs(60);
/// Share of the expected rise of the force below which a step had no effect, and the time after which it is tried again.
const BLOCKED_SHARE: f64 = 0.3;
const BLOCKED_PAUSE: Duration = Duration::from_secs(2);
/// Time after which a blocked drive is opened again.
const OPEN_PAUSE: Duration = Duration::from_secs(20);
/// Share of what a finger presses too hard that one reduction takes away.
const RELAX_PART: f64 = 0.8;
/// Readings of this time make a settled force: their mean is free of noise.
const SETTLED: Duration = Duration::from_millis(400);
/// Fewest of them.
const SETTLED_READINGS: usize = 5;
/// Two settled forces show the stiffness if their angles differ by this many units; the share of the new value that is learned.
const SETTLED_WAY: f64 = 2.0;
const LEARN: f64 = 0.8;
/// Dead band of a settled force: twice the noise of the mean of the fewest readings, as a share of that of one, and at least this, g.
const SETTLED_NOISE: f64 = 0.9;
const SETTLED_DEAD_G: f64 = 4.0;
/// Factor of the dead band for a force that has settled too low: the zero drifts, and a reduction is not taken back for that.
const LOW_DEAD: f64 = 1.5;
/// Share of the wanted force that is corrected at once.
const URGENT: f64 = 0.3;
/// Change of the tangential force that is a disturbance: as a share of the normal force, and at least this, g.
const JUMP_SHARE: f64 = 0.025;
const JUMP_LEAST_G: f64 = 2.5;
/// Possible ratios of the force of the drive to that on the fingertip, and the share of a new one that is learned: each hand has its
/// own grams, and the fingertip measures newtons.
const GAIN: std::ops::RangeInclusive<f64> = 0.5..=2.0;
const LEARN_GAIN: f64 = 0.3;
/// Share by which a drive may read less than its fingertip before that is drift of its zero, and the share of a new drift that each
/// reading shows.
const DRIFT_DEAD: f64 = 0.1;
const LEARN_DRIFT: f64 = 0.02;
/// Largest drift that is corrected, g: more is a contact that moved onto the fingertip.
const DRIFT_MAX: f64 = 100.0;
/// Normal force below which a ratio says nothing, g.
const RATIO_FROM_G: f64 = 30.0;
/// A step may meet an object that is stiffer by this factor: before its stiffness is known, once the close or a step showed it, and
/// once two settled forces did.
const STIFFER_UNKNOWN: f64 = 2.0;
const STIFFER_SHOWN: f64 = 1.35;
const STIFFER_SETTLED: f64 = 1.15;
/// Share of the stiffness that a step showed that is still believed after the next one.
const SHOWN_KEPT: f64 = 0.9;
/// Units of angle by which a finger follows an object beyond what its force explains.
const FOLLOW: f64 = 40.0;
/// A finger is still blocked at this share of the force at which steps had no effect.
const NEARLY_BLOCKED: f64 = 0.9;
/// Largest single step, units of angle.
const STEP_MAX: f64 = 40.0;
/// The same of a reduction: what is soft presses too hard by many units.
const RELAX_MAX: f64 = 120.0;
/// Travel of the contact on the fingertip that is a slip, mm, and the time in which it must happen.
const SLIDE_MM: f64 = 0.7;
const SLIDE_WITHIN_S: f64 = 0.25;
/// Readings over which the force is filtered.
const FORCES: usize = 3;
/// Readings of the fingertip that are kept.
const TIPS: usize = 16;

/// Forces between which a hold keeps each finger, g above its zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ForceRange {
    pub(crate) least_g: f64,
    pub(crate) most_g: f64,
}

/// A reading of the fingertip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TipForces {
    pub(crate) at: Moment,
    /// Normal and tangential force, g.
    pub(crate) normal_g: f64,
    pub(crate) tangential_g: f64,
    /// Place of the contact on the fingertip, mm; `None` if the channels do not show it.
    pub(crate) spot_mm: Option<(f64, f64)>,
}

/// A reading of a finger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FingerReading {
    pub(crate) at: Moment,
    /// Force above the finger's zero, g.
    pub(crate) force_g: f64,
    /// Angle, units of ANGLE_ACT.
    pub(crate) angle: i16,
    /// The drive is warm.
    pub(crate) is_warm: bool,
}

/// A step of the angle target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HoldStep {
    pub(crate) to: Angle,
    pub(crate) speed: Speed,
    /// Reason for pressing harder; `None` for a reduction.
    pub(crate) cause: Option<TightenCause>,
}

/// A step whose effect is not known yet.
#[derive(Debug, Clone, Copy)]
struct Underway {
    /// Time by which it has acted.
    until: Moment,
    /// Force and angle before the step.
    from_g: f64,
    from_angle: i16,
    /// Force that it should lead to, and the highest to which it may, g.
    aim_g: f64,
    highest_g: f64,
}

/// One finger that holds an object.
#[derive(Debug, Clone)]
pub(crate) struct FingerHold {
    range: ForceRange,
    noise_g: f64,
    /// The current target.
    target: f64,
    /// g per unit of angle.
    stiffness: f64,
    /// Factor by which the contact may be stiffer.
    stiffer: f64,
    /// Stiffness that single steps showed, at least, g per unit of angle: of an object that gives way slowly, settled forces show less.
    shown: f64,
    wanted_g: f64,
    cause: TightenCause,
    forces: VecDeque<(Moment, f64)>,
    tips: VecDeque<TipForces>,
    /// Force of the drive for each gram on the fingertip; `None` before the fingertip felt the object.
    gain: Option<f64>,
    /// The same when the hold began.
    first_gain: Option<f64>,
    /// By how much the drive reads less since then, g.
    drift_g: f64,
    /// Tangential and normal force while nothing happens, g.
    base_g: Option<(f64, f64)>,
    /// Largest ratio of tangential to normal force at which the object did not slide.
    held_ratio: f64,
    /// Smallest ratio at which it slid.
    slid_ratio: Option<f64>,
    underway: Option<Underway>,
    quiet_since: Moment,
    /// Recent surges of the load, and the time of the last.
    surges: (f64, Moment),
    is_warm: bool,
    relaxed: Option<Moment>,
    /// The last settled force, and its angle.
    settled: Option<(f64, i16)>,
    /// Time by which the last step has acted.
    acted: Option<Moment>,
    relaxes_from: Moment,
    is_short: bool,
    /// Force at which steps had no effect: its threshold or its stroke stops the drive.
    blocked: Option<(f64, Moment)>,
    /// A drive that its threshold stopped may ignore further closing until it opens: it opens by one unit first.
    opens_first: bool,
    /// Time at which it last did.
    opened: Option<Moment>,
}

impl FingerHold {
    /// Starts at this angle, where it presses with `force_g`.
    pub(crate) fn new(range: ForceRange, noise_g: f64, angle: i16, now: Moment) -> Self {
        Self {
            range,
            noise_g,
            target: angle.into(),
            stiffness: HARD_G,
            stiffer: STIFFER_UNKNOWN,
            shown: 0.0,
            wanted_g: range.least_g,
            cause: TightenCause::TooLittle,
            forces: VecDeque::new(),
            tips: VecDeque::new(),
            gain: None,
            first_gain: None,
            drift_g: 0.0,
            base_g: None,
            held_ratio: 0.0,
            slid_ratio: None,
            underway: None,
            quiet_since: now,
            surges: (0.0, now),
            is_warm: false,
            relaxed: None,
            settled: None,
            acted: None,
            relaxes_from: now,
            is_short: false,
            blocked: None,
            opens_first: false,
            opened: None,
        }
    }

    /// Uses the stiffness that the close showed, g per unit of angle.
    pub(crate) fn know_stiffness(&mut self, g_per_angle: f64) {
        self.stiffness = g_per_angle.clamp(*STIFFNESS_G.start(), *STIFFNESS_G.end());
        self.stiffer = self.stiffer.min(STIFFER_SHOWN);
    }

    /// Largest stiffness that the contact may have, g per unit of angle.
    fn stiffest(&self) -> f64 {
        (self.stiffness * self.stiffer).max(self.shown)
    }

    /// Force by which its drive reads too little by now, g.
    pub(crate) const fn drift_g(&self) -> f64 {
        self.drift_g
    }

    /// Force that it presses with, g; `None` before the first reading.
    pub(crate) fn force_g(&self) -> Option<f64> {
        let recent = self.forces.iter().rev().take(FORCES);
        let forces: Vec<f64> = recent.map(|(_, force)| *force).collect();
        median(&forces)
    }

    /// Units of angle by which it may follow an object that gives way: those that lead to *at most*, and some more.
    pub(crate) fn travel_max(&self) -> f64 {
        FOLLOW + 1.5 * (self.range.most_g - self.range.least_g) / self.stiffness
    }

    /// Stiffness of the contact, g per unit of angle; `None` before the close or a step showed it.
    pub(crate) fn measured_stiffness(&self) -> Option<f64> {
        (self.stiffer < STIFFER_UNKNOWN).then_some(self.stiffness)
    }

    /// True once its fingertip felt the object.
    pub(crate) const fn has_felt(&self) -> bool {
        self.gain.is_some()
    }

    /// The last force at rest, g, and its angle.
    pub(crate) const fn settled(&self) -> Option<(f64, i16)> {
        self.settled
    }

    /// Mean load of the fingertip in the readings that are kept; `None` before the first.
    pub(crate) fn tip_load(&self) -> Option<TipLoad> {
        let mean_of = |force: fn(&TipForces) -> f64| {
            let forces: Vec<f64> = self.tips.iter().map(force).collect();
            mean(&forces)
        };
        Some(TipLoad {
            normal_g: mean_of(|tip| tip.normal_g)?,
            tangential_g: mean_of(|tip| tip.tangential_g)?,
        })
    }

    /// Tangential force on the fingertip, g; `None` before it was read.
    pub(crate) fn tangential_g(&self) -> Option<f64> {
        let recent = self.tips.iter().rev().take(FORCES);
        let loads: Vec<f64> = recent.map(|tip| tip.tangential_g).collect();
        median(&loads)
    }

    /// True if no load changed for a while.
    pub(crate) fn is_quiet(&self, now: Moment) -> bool {
        // A warm drive rests as soon as it can.
        let surges = if self.is_warm {
            0.0
        } else {
            self.surges_at(now)
        };
        let quiet = QUIET.mul_f64(surges.max(1.0)).min(QUIET_LONGEST);
        now.since(self.quiet_since) >= quiet
    }

    /// Number of recent surges of the load, of which old ones count less and less.
    fn surges_at(&self, now: Moment) -> f64 {
        let (count, at) = self.surges;
        count * (-now.since(at).as_secs_f64() / SURGE_S).exp()
    }

    /// Ratio of tangential to normal force up to which the object is expected to hold.
    pub(crate) fn friction(&self) -> f64 {
        let held = self.held_ratio.max(USUAL_FRICTION);
        self.slid_ratio.map_or(held, |slid| slid * BELOW_SLIP)
    }

    /// Share of the friction that is in reserve: 1 without tangential force, 0 or less where the object is about to slide.
    pub(crate) fn margin(&self) -> Option<f64> {
        let ratio = ratio(self.tips.back()?)?;
        Some(1.0 - ratio / self.friction())
    }

    /// True if it would have to press harder than allowed.
    pub(crate) const fn is_short(&self) -> bool {
        self.is_short
    }

    /// Applies a new reading of the fingertip.
    pub(crate) fn feel(&mut self, tip: TipForces) {
        if self.tips.len() >= TIPS {
            self.tips.pop_front();
        }
        self.tips.push_back(tip);
        let Some(ratio) = ratio(&tip) else {
            return;
        };
        let forces = (tip.tangential_g, tip.normal_g);
        let (base, base_normal) = *self.base_g.get_or_insert(forces);
        // A finger that presses harder also drags more: that is no load.
        let explained = base * (tip.normal_g / base_normal).max(1.0);
        let jump = match tip.tangential_g > base {
            true => (tip.tangential_g - explained).max(0.0),
            false => tip.tangential_g - base,
        };
        let is_jump = jump.abs() > (JUMP_SHARE * tip.normal_g).max(JUMP_LEAST_G);
        let share = if is_jump { 0.3 } else { 0.1 };
        self.base_g = Some((
            base + (tip.tangential_g - base) * share,
            base_normal + (tip.normal_g - base_normal) * share,
        ));
        if is_jump {
            if jump > 0.0 && tip.at.since(self.quiet_since) >= QUIET {
                self.surges = (self.surges_at(tip.at) + 1.0, tip.at);
            }
            self.quiet_since = tip.at;
            self.relaxes_from = self.relaxes_from.min(tip.at);
        }
        if self.slides() {
            let slid = self.slid_ratio.map_or(ratio, |before| before.min(ratio));
            self.slid_ratio = Some(slid.max(0.05));
            self.quiet_since = tip.at;
            let more = self.force_g().unwrap_or_default() * SLIP_FACTOR;
            self.want(more.max(self.coming_g()), TightenCause::Slip);
            return;
        }
        if self.slid_ratio.is_none_or(|slid| ratio < slid) {
            self.held_ratio = self.held_ratio.max(ratio);
        }
        if is_jump && jump > 0.0 {
            self.want(self.coming_g(), TightenCause::Load);
        } else if self.steady_g() > self.wanted_g * HYSTERESIS {
            self.want(self.steady_g() * HYSTERESIS, TightenCause::Margin);
        }
        self.is_short &= self.steady_g() > self.range.most_g * NO_LONGER_SHORT;
    }

    /// Force that the current load needs.
    fn steady_g(&self) -> f64 {
        self.drive_g(self.tangential_g().unwrap_or_default() / (self.friction() * (1.0 - MARGIN)))
    }

    /// Force that the load needs when a step acts, if it rises on.
    fn coming_g(&self) -> f64 {
        let Some(last) = self.tips.back() else {
            return 0.0;
        };
        let before = self.tips.iter().rev().nth(2).or(self.tips.front());
        let rise = before.map_or(0.0, |before| {
            let seconds = last.at.since(before.at).as_secs_f64();
            let rise = last.tangential_g - before.tangential_g;
            // Noise is no trend.
            let is_rise = rise > (JUMP_SHARE * last.normal_g).max(JUMP_LEAST_G) && seconds > 0.0;
            if is_rise {
                rise / seconds * AHEAD_S
            } else {
                0.0
            }
        });
        self.drive_g((last.tangential_g + rise) / (self.friction() * (1.0 - MOVING_MARGIN)))
    }

    fn want(&mut self, force_g: f64, cause: TightenCause) {
        // What is pressed beforehand, because the load may rise on, is not needed yet.
        let needed_g = match cause {
            TightenCause::Load => self.steady_g(),
            _ => force_g,
        };
        self.is_short |= needed_g > self.range.most_g * SHORT_FACTOR;
        let force_g = force_g.clamp(self.range.least_g, self.range.most_g);
        if force_g > self.wanted_g {
            (self.wanted_g, self.cause) = (force_g, cause);
        }
    }

    /// True if the place of the contact moved more than it does at rest.
    fn slides(&self) -> bool {
        let Some((last, spot)) = self.tips.back().and_then(|tip| Some((tip, tip.spot_mm?))) else {
            return false;
        };
        let recent = self.tips.iter().rev().skip(1);
        let mut recent =
            recent.take_while(|tip| last.at.since(tip.at).as_secs_f64() <= SLIDE_WITHIN_S);
        recent.any(|tip| {
            tip.spot_mm
                .is_some_and(|before| (spot.0 - before.0).hypot(spot.1 - before.1) > SLIDE_MM)
        })
    }

    /// Applies a new reading of the drive; returns the next step.
    pub(crate) fn apply(&mut self, reading: FingerReading) -> Option<HoldStep> {
        let reading = FingerReading {
            force_g: reading.force_g + self.drift_g,
            ..reading
        };
        self.forces.push_back((reading.at, reading.force_g));
        let is_old = |(at, _): &(Moment, f64)| reading.at.since(*at) > SETTLED;
        while self.forces.len() > SETTLED_READINGS && self.forces.front().is_some_and(is_old) {
            self.forces.pop_front();
        }
        let force_g = self.force_g()?;
        let is_acting = |step: &Underway| reading.at < step.until;
        if let Some(step) = self.underway.take_if(|step| !is_acting(step)) {
            self.learn(step, force_g, reading.angle);
        }
        let under_way = self.underway;
        let seen = HoldNow {
            force_g,
            expected_g: under_way.map_or(force_g, |step| step.aim_g),
            highest_g: under_way.map_or(force_g, |step| step.highest_g.max(force_g)),
            settled_g: self.settled_g(reading.at),
            reading,
        };
        if self.gain.is_none() {
            self.learn_gain(force_g);
        }
        self.learn_drift();
        if let Some(settled_g) = seen.settled_g {
            self.learn_gain(settled_g);
            self.learn_settled(settled_g, reading.angle);
        }
        self.is_warm = reading.is_warm;
        let is_quiet = self.is_quiet(reading.at);
        if is_quiet {
            self.relax_wish(reading);
        }
        self.tighten(seen).or_else(|| self.relax(seen, is_quiet))
    }

    /// Mean force since the last step acted; `None` before it has settled.
    fn settled_g(&self, now: Moment) -> Option<f64> {
        let acted = self.acted.unwrap_or(Moment::ZERO);
        let from = self.forces.front()?.0;
        let is_settled = self.forces.len() >= SETTLED_READINGS
            && from >= acted
            && now.since(from) >= SETTLED.mul_f64(0.8);
        let forces: Vec<f64> = self.forces.iter().map(|(_, force)| *force).collect();
        mean(&forces).filter(|_| is_settled)
    }

    /// Smallest difference of a settled force that is not noise, g.
    fn settled_dead_g(&self) -> f64 {
        (self.noise_g * SETTLED_NOISE).max(SETTLED_DEAD_G)
    }

    /// Learns the force of the drive for each gram on the fingertip.
    fn learn_gain(&mut self, force_g: f64) {
        let Some(tip) = self.tips.back().filter(|tip| tip.normal_g >= RATIO_FROM_G) else {
            return;
        };
        let measured = (force_g / tip.normal_g).clamp(*GAIN.start(), *GAIN.end());
        let gain = self.gain.get_or_insert(measured);
        *gain += (measured - *gain) * LEARN_GAIN;
    }

    /// Learns by how much the drive reads less than when the hold began, while the fingertip does not: what drifts towards less would press
    /// harder and harder. The opposite is not corrected: the contact may have left the fingertip.
    fn learn_drift(&mut self) {
        let forces: Vec<f64> = self.forces.iter().map(|(_, force)| *force).collect();
        let load = self.tip_load().filter(|tip| tip.normal_g >= RATIO_FROM_G);
        let is_known = self.tips.len() >= TIPS && forces.len() >= SETTLED_READINGS;
        let Some((force_g, tip)) = mean(&forces).zip(load).filter(|_| is_known) else {
            return;
        };
        let first_gain = *self.first_gain.get_or_insert(force_g / tip.normal_g);
        // Above it more than the fingertip touches; below it the zero has drifted during the close.
        if first_gain > *GAIN.end() {
            return;
        }
        let by_tip = first_gain.max(*GAIN.start()) * tip.normal_g;
        let less = by_tip - (force_g - self.drift_g);
        let dead = DRIFT_DEAD * by_tip + self.settled_dead_g();
        self.drift_g += ((less - dead).clamp(0.0, DRIFT_MAX) - self.drift_g) * LEARN_DRIFT;
    }

    /// Force of the drive at which the fingertip presses with `tip_g`.
    fn drive_g(&self, tip_g: f64) -> f64 {
        tip_g * self.gain.unwrap_or(1.0)
    }

    /// Learns the stiffness from two settled forces at different angles.
    fn learn_settled(&mut self, force_g: f64, angle: i16) {
        let Some((before_g, before)) = self.settled else {
            self.settled = Some((force_g, angle));
            return;
        };
        let way = f64::from(before) - f64::from(angle);
        if way.abs() < SETTLED_WAY {
            return;
        }
        self.settled = Some((force_g, angle));
        let change = force_g - before_g;
        if change * way > 0.0 && change.abs() > self.settled_dead_g() {
            // Angles are whole units: the farther, the truer.
            let weight = LEARN * (1.0 - 1.0 / way.abs());
            self.know_stiffness(self.stiffness + (change / way - self.stiffness) * weight);
            let unsure = 1.0 + self.settled_dead_g() / change.abs();
            self.stiffer = unsure.clamp(STIFFER_SETTLED, STIFFER_UNKNOWN);
        }
    }

    /// Learns the stiffness from a step that has acted.
    fn learn(&mut self, step: Underway, force_g: f64, angle: i16) {
        let rise = step.aim_g - step.from_g;
        let is_blocked = rise > self.noise_g && force_g < step.from_g + BLOCKED_SHARE * rise;
        let blocked = (force_g.max(step.from_g), step.until.plus(BLOCKED_PAUSE));
        self.blocked = is_blocked.then_some(blocked);
        let may_open = |opened: Moment| step.until.since(opened) >= OPEN_PAUSE;
        self.opens_first = is_blocked && self.opened.is_none_or(may_open);
        let way = f64::from(step.from_angle) - f64::from(angle);
        let change = force_g - step.from_g;
        if way.abs() >= 1.0 && change * way > 0.0 {
            let surely = (change.abs() - self.noise_g) / (way.abs() + 1.0);
            self.shown = (self.shown * SHOWN_KEPT).max(surely.min(HARD_G));
        }
        if way.abs() >= 1.0 && change > self.stiffness * way && way > 0.0 {
            // A force that is still rising shows a lower bound.
            self.know_stiffness(self.stiffness + (change / way - self.stiffness) * 0.4);
        } else if way == 0.0 && change.abs() <= self.noise_g {
            // The step was lost in the backlash, or the drive rests elsewhere.
            self.target = self
                .target
                .min(f64::from(angle) + 4.0)
                .max(f64::from(angle) - 4.0);
        }
    }

    /// Lowers the wanted force towards what the load needs.
    fn relax_wish(&mut self, reading: FingerReading) {
        let since = self
            .relaxed
            .map_or(RELAX_INTERVAL, |at| reading.at.since(at));
        if since < RELAX_INTERVAL {
            return;
        }
        self.relaxed = Some(reading.at);
        let least = (self.steady_g() * HYSTERESIS).max(self.range.least_g);
        self.wanted_g = self.wanted_g.min(least);
    }

    fn tighten(&mut self, seen: HoldNow) -> Option<HoldStep> {
        let missing = self.missing_g(seen)?;
        let is_blocked = |(force_g, until): (f64, Moment)| {
            seen.expected_g >= NEARLY_BLOCKED * force_g && seen.reading.at < until
        };
        if self.opens_first && self.underway.is_none() {
            self.opens_first = false;
            self.opened = Some(seen.reading.at);
            self.target = f64::from(seen.reading.angle);
            return self.step(seen, 1.0, None);
        }
        if self.blocked.is_some_and(is_blocked) {
            return None;
        }
        let room = self.range.most_g - seen.highest_g;
        let steps = (missing / self.stiffness).round().max(1.0);
        let allowed = (room / self.stiffest()).floor();
        // Rather one step that the threshold of the drive may have to end than an object that drops.
        let is_needed = self.is_short || missing >= self.stiffness;
        let least = if is_needed && room >= self.stiffness.max(self.shown) {
            1.0
        } else {
            0.0
        };
        let steps = steps.min(allowed.max(least)).min(STEP_MAX);
        if steps < 1.0 {
            return None;
        }
        if self.relaxed.is_some()
            && matches!(self.cause, TightenCause::TooLittle | TightenCause::Margin)
            && self.is_quiet(seen.reading.at)
        {
            self.relaxes_from = seen.reading.at.plus(RELAX_PAUSE);
        }
        let cause = if seen.expected_g < self.range.least_g && self.wanted_g <= self.range.least_g {
            TightenCause::TooLittle
        } else {
            self.cause
        };
        self.step(seen, -steps, Some(cause))
    }

    /// Force that is missing by more than the noise. What is not urgent waits until the force has settled.
    fn missing_g(&self, seen: HoldNow) -> Option<f64> {
        let missing = self.wanted_g - seen.expected_g;
        let is_urgent = self.cause != TightenCause::TooLittle || missing > URGENT * self.wanted_g;
        let noise = (2.0 * self.noise_g).max(6.0);
        let at_once = Some(missing).filter(|missing| is_urgent && *missing > noise);
        let settled = seen.settled_g.map(|settled| self.wanted_g - settled);
        let dead = LOW_DEAD * self.settled_dead_g();
        at_once.or(settled.filter(|missing| *missing > dead))
    }

    fn relax(&mut self, seen: HoldNow, is_quiet: bool) -> Option<HoldStep> {
        let is_allowed = self.underway.is_none() && seen.reading.at >= self.relaxes_from;
        let over = seen.force_g - self.range.most_g;
        let dead = (2.0 * self.noise_g).max(6.0);
        if over > dead && self.underway.is_none() {
            return self.step(seen, (over / self.stiffness).ceil().min(STEP_MAX), None);
        }
        let spare = seen.settled_g? - self.wanted_g - self.settled_dead_g();
        let steps = (spare / self.stiffest()).floor().min(RELAX_MAX);
        let steps = if steps > 2.0 {
            (steps * RELAX_PART).floor()
        } else {
            steps
        };
        (is_quiet && is_allowed && steps >= 1.0).then_some(())?;
        self.step(seen, steps, None)
    }

    fn step(&mut self, seen: HoldNow, by: f64, cause: Option<TightenCause>) -> Option<HoldStep> {
        // A drive that was stopped rests beside its target.
        let from = match self.underway {
            Some(_) => self.target,
            None => self.target.clamp(
                f64::from(seen.reading.angle) - 4.0,
                f64::from(seen.reading.angle) + 4.0,
            ),
        };
        self.target = (from + by).clamp(0.0, 1000.0);
        let counts = (self.target - f64::from(seen.reading.angle)).abs() * 2.0;
        let aim_g = seen.expected_g - by * self.stiffness;
        // Halfway to the stiffest, or what a slip needs would have to wait for the effect of its first step.
        let likely = f64::midpoint(self.stiffness, self.stiffest());
        let highest_g = seen.highest_g - by.min(0.0) * likely;
        let is_near = aim_g > NEAR_MOST * self.range.most_g;
        let fastest = SPEED_BY_STIFFNESS / self.stiffness / if is_near { NEAR_SLOWER } else { 1.0 };
        let speed = (counts / STEP_S / COUNTS_PER_SPEED).min(fastest.clamp(25.0, 1000.0));
        let longer_s = (counts / (speed.max(25.0) * COUNTS_PER_SPEED) - STEP_S).max(0.0);
        let duration = EFFECT + Duration::from_secs_f64(longer_s);
        let until = seen.reading.at.plus(duration);
        self.acted = Some(until);
        let begun = self.underway;
        self.underway = Some(Underway {
            until,
            from_g: begun.map_or(seen.force_g, |step| step.from_g),
            from_angle: begun.map_or(seen.reading.angle, |step| step.from_angle),
            aim_g,
            highest_g,
        });
        Some(HoldStep {
            to: nearest_angle(self.target),
            speed: nearest_speed(speed),
            cause,
        })
    }
}

#[derive(Debug, Clone, Copy)]
struct HoldNow {
    force_g: f64,
    /// Force once the step under way has acted.
    expected_g: f64,
    /// The highest that it may be then.
    highest_g: f64,
    /// Mean force since the last step acted; `None` if it has not settled.
    settled_g: Option<f64>,
    reading: FingerReading,
}

fn ratio(tip: &TipForces) -> Option<f64> {
    (tip.normal_g >= RATIO_FROM_G).then(|| tip.tangential_g / tip.normal_g)
}

#[expect(clippy::cast_possible_truncation, reason = "clamped to 0..=1000")]
fn nearest_angle(angle: f64) -> Angle {
    Angle::nearest(angle.round() as i64)
}

/// Speed of a step: never below the slowest at which drives were measured.
#[expect(clippy::cast_possible_truncation, reason = "clamped")]
fn nearest_speed(speed: f64) -> Speed {
    Speed::nearest(speed.max(25.0).round() as i64)
}
