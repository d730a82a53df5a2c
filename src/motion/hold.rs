//! A hold on a hand that the user armed: close until the fingers press with *at least*, then keep what is held with the least force that
//! holds, and never with more than *at most*. The hand itself enforces *at most* by its force threshold, also if this program dies.

use crate::hand::feedback::tactile::spot_mm;
use crate::hand::gap::{Gap, SizeBlocks};
use crate::hand::grip::{Grip, GripEstimator, Tightened};
use crate::hand::hold_forces::HoldForces;
use crate::hand::newtons::N_PER_G;
use crate::hand::overshoot::{MeasuredOn, OvershootMap, Stages};
use crate::hand::statistics::{count, mean, spread};
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, Finger, Force, ForceReading, Group, Groups, HandSample,
    Moment, PerDof, PerFinger, Setpoints, Speed, Target, heat,
};
use crate::link::PollRates;
use crate::motion::held_object::{HeldObject, ObjectWatch, TipLoad};
use crate::motion::hold_finger::{FingerHold, FingerReading, ForceRange, TipForces};
use crate::motion::program::{Ended, LEG_SPARE, Order, Program, Seen};
use crate::poses::way::{Targets, pinch_way, way};
use crate::record::{Abort, Rest};
use serde::Serialize;
use std::collections::VecDeque;
use std::time::Duration;

/// Poll rates while a hold lasts: slips show first on the fingertips.
pub const RATES: PollRates = PollRates {
    state_hz: 100.0,
    tactile_hz: 60.0,
    settings_hz: 2.0,
};

/// Time for which the zero of the force sensors is measured before anything moves, and the fewest readings for it.
const ZERO_DURATION: Duration = Duration::from_millis(400);
const ZERO_READINGS: usize = 5;
/// Maximum time until they were read.
const ZERO_TIMEOUT: Duration = Duration::from_secs(3);
/// A joint rests when its angle has not changed for this time, and not before this time after a command.
const STILL: Duration = Duration::from_millis(300);
const STILL_READINGS: u32 = 4;
const START_DELAY: Duration = Duration::from_millis(500);
/// Speed of joints that open, and of the thumb's rotation: if feedback freezes, it goes on for half a second.
const CLEAR_SPEED: i16 = 200;
const ROTATE_SPEED: i16 = 50;
/// Speed of a close without a measurement, and of a finger that presses on.
const SLOW_SPEED: i16 = 25;
/// A close stops at this multiple of *at least*: the grip relaxes a little afterwards.
const CLOSE_FACTOR: f64 = 1.1;
/// A finger presses with *at least* from this share of it on.
const NEARLY: f64 = 0.9;
/// Delay from the targets of the held position to the thresholds at *at most*: a drive that still had the target of the close would
/// press on.
const THRESHOLD_DELAY: Duration = Duration::from_millis(150);
/// A finger that presses with less than this share of *at least* for this time has lost the object.
const GONE_SHARE: f64 = 0.2;
const GONE_AFTER: Duration = Duration::from_millis(400);
/// Temperature from which the hold is reduced, °C.
const WARM: u8 = heat::WARM;
/// Normal force from which a fingertip touches something, N.
const TOUCH_N: f32 = 0.15;

/// Forces as a sensor reads them.
fn range(forces: HoldForces, reading_per_g: f64) -> ForceRange {
    ForceRange {
        least_g: f64::from(forces.at_least().get()) * reading_per_g,
        most_g: f64::from(forces.at_most().get()) * reading_per_g,
    }
}

/// How a hold begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HoldClose {
    /// It takes over what the hand holds.
    TakeOver,
    /// It closes to these angles, until the object stops the fingers.
    To(Targets),
    /// It closes along the path on which the pads of thumb and index meet.
    Pinch(Gap),
}

/// Settings with which a hold starts.
#[derive(Debug, Clone)]
pub struct HoldStart {
    /// How it begins. An object that is held already is taken over in any case.
    pub close: HoldClose,
    /// Its forces.
    pub forces: HoldForces,
    /// Time for which the object is held; `None` until it is ended.
    pub duration: Option<Duration>,
    /// Reading of each joint for one gram of its forces: 1, or what was measured with a kitchen scale for forces in newtons.
    pub reading_per_g: PerDof<f64>,
    /// Joints that do not move.
    pub locked: PerDof<bool>,
    /// Overshoot measured on this hand, which sets the speed of the close.
    pub overshoot: OvershootMap,
    /// Blocks measured with this hand: sizes are by the model without them.
    pub blocks: SizeBlocks,
    /// Grip estimate from the readings so far.
    pub grip: GripEstimator,
}

/// Outcome of a hold that was not aborted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldEnd {
    /// Its time is over; the hand keeps what it holds.
    Held,
    /// The fingers met nothing. The hand was stopped.
    Nothing,
    /// The object left the hand. The hand was stopped.
    Lost,
    /// The close did not end in time. The hand was stopped.
    Late,
}

/// Phase of a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldPhase {
    /// It measures the zero of the force sensors.
    Measuring,
    /// The fingers close.
    Closing,
    /// It holds.
    Holding,
    /// *At most* does not suffice: the object slides, or is about to.
    CannotHold,
}

/// A hold for display.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HoldView {
    /// Its phase.
    pub phase: HoldPhase,
    /// Forces between which it holds.
    pub forces: HoldForces,
    /// Force of each finger that holds, g above its zero.
    pub force_g: PerFinger<Option<i16>>,
    /// Smallest reserve of friction of all fingers, percent; `None` if no fingertip shows it.
    pub margin_percent: Option<i16>,
    /// Number of times that a finger pressed harder.
    pub tightened: u32,
    /// The last finger that did, and why.
    pub last: Option<Tightened>,
    /// A drive is warm.
    pub is_warm: bool,
    /// What is held; `None` before it is.
    pub object: Option<HeldObject>,
}

impl HoldView {
    /// A hold that has just started.
    pub const fn first(forces: HoldForces) -> Self {
        Self {
            phase: HoldPhase::Measuring,
            forces,
            force_g: PerFinger::splat(None),
            margin_percent: None,
            tightened: 0,
            last: None,
            is_warm: false,
            object: None,
        }
    }

    /// Mean force of the fingers that hold, g; `None` if none does.
    pub fn mean_g(&self) -> Option<i16> {
        let forces = self.force_g.as_array().iter().flatten();
        let (sum, count) = forces.fold((0, 0), |(sum, count), own| {
            (sum + i32::from(*own), count + 1)
        });
        (count > 0).then(|| i16::try_from(sum / count).unwrap_or(i16::MAX))
    }
}

/// The zero of a joint's force sensor, as measured before the close.
#[derive(Debug, Clone, Default)]
struct Zero {
    readings: Vec<f64>,
}

impl Zero {
    fn mean(&self) -> Option<f64> {
        mean(&self.readings)
    }

    /// Amplitude of the noise, g.
    fn noise_g(&self) -> f64 {
        let variance = spread(&self.readings) / (count(&self.readings) - 1.0).max(1.0);
        (2.0 * variance.sqrt()).clamp(2.0, 100.0)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum HoldStage {
    Measuring,
    Closing,
    /// The held position is the target; the thresholds follow.
    TakingOver,
    Holding,
}

/// The program of a hold.
#[derive(Debug)]
pub struct HoldRun {
    start: HoldStart,
    epoch: ArmEpoch,
    step: HoldStage,
    begun: Moment,
    /// Time at which the last targets were given.
    sent: Moment,
    zeros: PerDof<Zero>,
    /// Channels of each fingertip while it touched nothing.
    free_tips: PerFinger<Option<[u32; 8]>>,
    legs: Option<VecDeque<Targets>>,
    /// Last angle of each joint, since when, and the number of readings that show it.
    still: PerDof<Option<(i16, Moment, u32)>>,
    /// Time of the newest angles.
    angles_at: Option<Moment>,
    /// FORCE_SET as given.
    threshold_g: PerDof<f64>,
    /// Part of a threshold that the drive counts although the finger does not press, g.
    shift_g: PerDof<f64>,
    /// Angle and force at which a contact began.
    touched: PerFinger<Option<(i16, f64)>>,
    fingers: PerFinger<Option<FingerHold>>,
    held_from: PerFinger<i16>,
    gone_since: PerFinger<Option<Moment>>,
    fresh: Groups,
    held_since: Option<Moment>,
    tightened: u32,
    last: Option<Tightened>,
    events: VecDeque<Tightened>,
    force_g: PerFinger<Option<i16>>,
    is_warm: bool,
    shown: ObjectWatch,
    object: Option<HeldObject>,
    end: Option<Ended<HoldEnd>>,
}

impl HoldRun {
    /// A hold under this arming.
    pub fn new(epoch: ArmEpoch, start: HoldStart, now: Moment) -> Self {
        Self {
            shown: ObjectWatch::new(start.blocks.clone()),
            start,
            epoch,
            step: HoldStage::Measuring,
            begun: now,
            sent: now,
            zeros: PerDof::from_fn(|_| Zero::default()),
            free_tips: PerFinger::splat(None),
            legs: None,
            still: PerDof::splat(None),
            angles_at: None,
            threshold_g: PerDof::splat(0.0),
            shift_g: PerDof::splat(0.0),
            touched: PerFinger::splat(None),
            fingers: PerFinger::from_fn(|_| None),
            held_from: PerFinger::splat(0),
            gone_since: PerFinger::splat(None),
            fresh: Groups::default(),
            held_since: None,
            tightened: 0,
            last: None,
            events: VecDeque::new(),
            force_g: PerFinger::splat(None),
            is_warm: false,
            object: None,
            end: None,
        }
    }

    /// Forces of a joint, as its sensor reads them.
    fn range(&self, dof: Dof) -> ForceRange {
        range(self.start.forces, self.start.reading_per_g[dof])
    }

    /// Time for which it has held; `None` if it never did.
    pub fn held_for(&self, now: Moment) -> Option<Duration> {
        self.held_since.map(|since| now.since(since))
    }

    /// Grip at the end of the readings.
    pub fn grip(&self) -> Grip {
        self.start.grip.grip()
    }

    /// True once it closed by itself, rather than taking over what the hand held.
    pub const fn has_closed(&self) -> bool {
        self.legs.is_some()
    }

    /// Stiffness of each contact, g per unit of angle; `None` where the close and the steps did not show it.
    pub fn stiffness_g(&self) -> PerFinger<Option<f64>> {
        PerFinger::from_fn(|finger| self.fingers[finger].as_ref()?.measured_stiffness())
    }
}

impl Program for HoldRun {
    type Input = Abort;
    type Outcome = HoldEnd;
    type View = HoldView;
    type Event = Tightened;
    const RATES: Option<PollRates> = Some(RATES);

    fn input(&mut self, why: Abort, seen: &Seen<'_>) -> Option<Order> {
        self.abort(why, seen.now);
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        self.start.grip.apply(sample, fresh, now);
        self.fresh = self.fresh.and(fresh);
        self.watch_stillness(sample, now);
        self.is_warm = Dof::ALL.into_iter().any(|dof| is_warm(sample, dof));
        for finger in Finger::ALL {
            if fresh.contains(Group::Tactile(finger)) {
                self.feel(sample, finger);
            }
        }
        if self.step == HoldStage::Measuring && fresh.contains(Group::Force) {
            self.measure_zero(sample);
        }
        self.force_g = PerFinger::from_fn(|finger| {
            let hold = self.fingers[finger].as_ref();
            let hold = hold.filter(|_| self.gone_since[finger].is_none())?;
            let force = self.force_g(sample, finger.bend())?;
            Some(whole(force + hold.drift_g()))
        });
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let fresh = std::mem::take(&mut self.fresh);
        if self.end.is_some() {
            return None;
        }
        let Some(angles) = seen.angles().map(|angles| angles.value) else {
            let is_late = seen.now.since(self.sent) > LEG_SPARE + ZERO_TIMEOUT;
            return (is_late && self.step != HoldStage::Holding)
                .then(|| self.finish(HoldEnd::Late));
        };
        match self.step {
            HoldStage::Measuring => self.begin(seen, &angles),
            HoldStage::Closing => self.close(seen, &angles),
            HoldStage::TakingOver => self.raise_thresholds(seen),
            HoldStage::Holding => self.regulate(seen, &angles, fresh),
        }
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.end.get_or_insert(Err(why));
    }

    fn view(&self, _now: Moment) -> HoldView {
        let holding = || self.fingers.as_array().iter().flatten();
        let margin = holding().filter_map(FingerHold::margin).reduce(f64::min);
        HoldView {
            phase: match self.step {
                HoldStage::Measuring => HoldPhase::Measuring,
                HoldStage::Closing | HoldStage::TakingOver => HoldPhase::Closing,
                HoldStage::Holding if holding().any(FingerHold::is_short) => HoldPhase::CannotHold,
                HoldStage::Holding => HoldPhase::Holding,
            },
            forces: self.start.forces,
            force_g: self.force_g,
            margin_percent: margin.map(|margin| whole(100.0 * margin)),
            tightened: self.tightened,
            last: self.last,
            is_warm: self.is_warm,
            object: self.object,
        }
    }

    fn event(&mut self) -> Option<Tightened> {
        self.events.pop_front()
    }

    fn ended(&self) -> Option<Ended<HoldEnd>> {
        self.end
    }
}

/// What the readings show.
impl HoldRun {
    fn watch_stillness(&mut self, sample: &HandSample, now: Moment) {
        let Some(angles) = sample.angle else {
            return;
        };
        if self.angles_at.replace(angles.received) == Some(angles.received) {
            return;
        }
        for (dof, still) in self.still.iter_mut() {
            let at = angles.value[dof].raw();
            *still = match *still {
                Some((before, since, readings)) if at.abs_diff(before) <= 1 => {
                    Some((before, since, readings + 1))
                }
                _ => Some((at, now, 1)),
            };
        }
    }

    fn measure_zero(&mut self, sample: &HandSample) {
        let Some(forces) = sample.force else {
            return;
        };
        for (dof, zero) in self.zeros.iter_mut() {
            let tip_n = sample.tactile[dof.finger()].and_then(|tip| tip.value.normal());
            // A finger that presses already shows its zero by what its fingertip feels.
            let pressed_g = tip_n
                .filter(|n| *n > TOUCH_N)
                .map_or(0.0, |n| f64::from(n) / N_PER_G);
            if let Some(force) = forces.value[dof].documented() {
                zero.readings.push(f64::from(force) - pressed_g);
            }
        }
    }

    /// Force of a joint above its zero, g.
    pub fn force_g(&self, sample: &HandSample, dof: Dof) -> Option<f64> {
        let force = ForceReading::documented(sample.force?.value[dof])?;
        let angle = sample.angle?.value[dof].documented()?;
        let free = self
            .start
            .grip
            .free_force()
            .at(dof, angle)
            .unwrap_or_default();
        Some(f64::from(force) - self.zeros[dof].mean()? - f64::from(free))
    }

    /// Applies a new reading of a fingertip.
    fn feel(&mut self, sample: &HandSample, finger: Finger) {
        let Some(tip) = sample.tactile[finger] else {
            return;
        };
        let (Some(normal_n), Some(tangential_n)) = (tip.value.normal(), tip.value.tangential())
        else {
            return;
        };
        if normal_n < TOUCH_N {
            self.free_tips[finger] = Some(tip.value.raw);
        }
        let free = self.free_tips[finger];
        if let Some(hold) = &mut self.fingers[finger] {
            hold.feel(TipForces {
                at: tip.received,
                normal_g: f64::from(normal_n) / N_PER_G,
                tangential_g: f64::from(tangential_n) / N_PER_G,
                spot_mm: free.and_then(|free| spot_mm(&tip.value.raw, &free)),
            });
        }
    }

    fn is_still(&self, dof: Dof, now: Moment) -> bool {
        // A hand that is not read is not known to rest.
        self.still[dof].is_some_and(|(_, since, readings)| {
            now.since(since) >= STILL && readings >= STILL_READINGS
        })
    }

    /// True once the joints had time to move and rest.
    fn is_at_rest(&self, seen: &Seen<'_>, moves: impl Fn(Dof) -> bool) -> bool {
        let begins = START_DELAY + seen.status.slow_allowance();
        let mut moving = Dof::ALL.into_iter().filter(|dof| moves(*dof));
        // Replies that come late show an old pose again; the link knows of them.
        let is_moving = seen.status.rest == Rest::Moving;
        let is_due = seen.now.since(self.sent) >= begins && !is_moving;
        is_due && moving.all(|dof| self.is_still(dof, seen.now))
    }

    fn holds(&self, sample: &HandSample, finger: Finger) -> bool {
        let is_held = self.start.grip.grip().fingers[finger].state.is_held();
        let force = self.force_g(sample, finger.bend());
        let presses = |force: f64| force >= self.range(finger.bend()).least_g / 2.0;
        (is_held || force.is_some_and(presses)) && !self.start.locked[finger.bend()]
    }
}

/// The close.
impl HoldRun {
    /// Begins once the zero of the force sensors is known.
    fn begin(&mut self, seen: &Seen<'_>, angles: &PerDof<AngleReading>) -> Option<Order> {
        let waited = seen.now.since(self.begun);
        let is_known = self
            .zeros
            .as_array()
            .iter()
            .all(|zero| zero.readings.len() >= ZERO_READINGS);
        if waited < ZERO_DURATION || !is_known {
            return (waited > ZERO_TIMEOUT).then(|| self.finish(HoldEnd::Late));
        }
        for dof in Dof::ALL {
            let zero = self.zeros[dof].mean().unwrap_or_default();
            self.shift_g[dof] = zero.min(0.0);
        }
        let is_held = self.start.grip.grip().grasp.state.is_held();
        let targets = match self.start.close {
            _ if is_held => return self.take_over(seen, angles),
            HoldClose::TakeOver => return Some(self.finish(HoldEnd::Nothing)),
            HoldClose::To(targets) => {
                let from = angles.map(|at| at.hold().map(Angle::get));
                way(&from, &targets)
            }
            HoldClose::Pinch(gap) => {
                let from = angles.map(|at| at.hold().map(Angle::get));
                let parts = pinch_way(&from, gap, Speed::MAX, &PerDof::splat(true));
                parts.into_iter().map(|part| part.targets).collect()
            }
        };
        let locked = self.start.locked;
        let free = |targets: Targets| PerDof::from_fn(|dof| targets[dof].filter(|_| !locked[dof]));
        self.legs = Some(targets.into_iter().map(free).collect());
        self.step = HoldStage::Closing;
        self.send_leg(seen.now, angles)
    }

    fn send_leg(&mut self, now: Moment, angles: &PerDof<AngleReading>) -> Option<Order> {
        let leg = self.legs.as_ref()?.front().copied()?;
        let mut setpoints = Setpoints::none(self.epoch);
        for (dof, to) in leg.iter() {
            let Some(to) = *to else {
                continue;
            };
            let range = self.range(dof);
            let close_g = (range.least_g * CLOSE_FACTOR).min(range.most_g);
            self.threshold_g[dof] = close_g + self.shift_g[dof];
            setpoints.angle[dof] = Some(Target::Go(to));
            setpoints.force[dof] = Some(Force::nearest(rounded(self.threshold_g[dof])));
            setpoints.speed[dof] = Some(self.close_speed(dof, to, angles[dof]));
        }
        self.sent = now;
        Some(Order::Set(setpoints))
    }

    /// Speed of a joint: the fastest whose overshoot, as measured on this hand, stays under *at most*; slow without a measurement.
    fn close_speed(&self, dof: Dof, to: Angle, at: AngleReading) -> Speed {
        if at.hold().is_some_and(|at| to >= at) {
            return Speed::nearest(CLEAR_SPEED);
        }
        if dof == Dof::ThumbRotate {
            return Speed::nearest(ROTATE_SPEED);
        }
        let range = self.range(dof);
        let threshold_g = range.least_g * CLOSE_FACTOR;
        let fits = |speed: i16| {
            let expected =
                self.start
                    .overshoot
                    .expected(dof, Stages::One, speed.into(), threshold_g);
            let is_own = matches!(expected.on, MeasuredOn::ThisHand { .. });
            is_own && threshold_g + expected.over_g <= range.most_g
        };
        let speeds = (SLOW_SPEED..=CLEAR_SPEED).rev().step_by(25);
        Speed::nearest(
            speeds
                .into_iter()
                .find(|speed| fits(*speed))
                .unwrap_or(SLOW_SPEED),
        )
    }

    fn close(&mut self, seen: &Seen<'_>, angles: &PerDof<AngleReading>) -> Option<Order> {
        let leg = self.legs.as_ref().and_then(|legs| legs.front()).copied()?;
        self.watch_contacts(seen.sample, angles);
        if self.is_at_rest(seen, |dof| leg[dof].is_some()) {
            if let Some(order) = self.press_on(seen, angles, &leg) {
                return Some(order);
            }
            self.legs.as_mut().and_then(VecDeque::pop_front);
            return match self.legs.as_ref().is_some_and(VecDeque::is_empty) {
                true => self.take_over(seen, angles),
                false => self.send_leg(seen.now, angles),
            };
        }
        let slowest = Speed::nearest(SLOW_SPEED).stroke();
        (seen.now.since(self.sent) > slowest + LEG_SPARE).then(|| self.finish(HoldEnd::Late))
    }

    /// Notes where contacts begin: the stiffness follows from there.
    fn watch_contacts(&mut self, sample: &HandSample, angles: &PerDof<AngleReading>) {
        for finger in Finger::ALL {
            let dof = finger.bend();
            let force = self.force_g(sample, dof);
            let begins = force.filter(|force| *force > 3.0 * self.zeros[dof].noise_g() + 5.0);
            if let (None, Some(force)) = (self.touched[finger], begins) {
                self.touched[finger] = Some((angles[dof].raw(), force));
                self.shown.met(finger, angles[dof].raw(), force);
            }
        }
    }

    /// A drive that counts the zero of its sensor stops too early by as much: its threshold rises until the joint arrives or presses.
    fn press_on(
        &mut self,
        seen: &Seen<'_>,
        angles: &PerDof<AngleReading>,
        leg: &Targets,
    ) -> Option<Order> {
        let mut setpoints = Setpoints::none(self.epoch);
        for dof in Dof::ALL {
            let range = self.range(dof);
            let (Some(to), Some(force)) = (leg[dof], self.force_g(seen.sample, dof)) else {
                continue;
            };
            let is_short = i32::from(angles[dof].raw()) > i32::from(to.get()) + 5;
            let highest = range.most_g + self.zeros[dof].mean().unwrap_or_default().max(0.0);
            let raised = (self.threshold_g[dof] + (range.least_g - force).max(20.0)).min(highest);
            let can_rise = raised > self.threshold_g[dof] + 1.0;
            if !is_short || force >= NEARLY * range.least_g || !can_rise {
                continue;
            }
            self.shift_g[dof] =
                self.shift_g[dof].max(self.threshold_g[dof] - force.max(0.0) - 20.0);
            self.threshold_g[dof] = raised;
            setpoints.angle[dof] = Some(Target::Go(to));
            setpoints.force[dof] = Some(Force::nearest(rounded(raised)));
            setpoints.speed[dof] = Some(Speed::nearest(match dof {
                Dof::ThumbRotate => ROTATE_SPEED,
                _ => SLOW_SPEED,
            }));
        }
        if setpoints.is_empty() {
            return None;
        }
        self.sent = seen.now;
        Some(Order::Set(setpoints))
    }
}

/// The hold.
impl HoldRun {
    /// Makes the held position the target of the fingers that hold.
    fn take_over(&mut self, seen: &Seen<'_>, angles: &PerDof<AngleReading>) -> Option<Order> {
        let mut setpoints = Setpoints::none(self.epoch);
        for finger in Finger::ALL {
            if !self.holds(seen.sample, finger) {
                continue;
            }
            let dof = finger.bend();
            let Some(at) = angles[dof].hold() else {
                continue;
            };
            let (zero, range) = (&self.zeros[dof], self.range(dof));
            // A drive that counts its zero may stop earlier by as much.
            let early_g = (zero.mean().unwrap_or_default() - self.shift_g[dof]).max(0.0);
            let usable = ForceRange {
                most_g: (range.most_g - early_g - zero.noise_g()).max(range.least_g),
                ..range
            };
            let mut hold = FingerHold::new(usable, zero.noise_g(), at.get(), seen.now);
            let force = self.force_g(seen.sample, dof);
            if let Some(((began, began_g), force)) = self.touched[finger].zip(force) {
                let way = f64::from(began) - f64::from(at.get());
                // Angles are whole units and forces have noise: the stiffest of the possible values.
                if way >= 2.0 && force > began_g {
                    hold.know_stiffness((force - began_g + zero.noise_g()) / (way - 1.0));
                }
            }
            self.fingers[finger] = Some(hold);
            self.held_from[finger] = at.get();
            setpoints.angle[dof] = Some(Target::Go(at));
            setpoints.speed[dof] = Some(Speed::nearest(SLOW_SPEED));
        }
        if setpoints.is_empty() {
            return Some(self.finish(HoldEnd::Nothing));
        }
        (self.step, self.sent) = (HoldStage::TakingOver, seen.now);
        Some(Order::Set(setpoints))
    }

    /// Raises the thresholds to *at most* once the held position is the target.
    fn raise_thresholds(&mut self, seen: &Seen<'_>) -> Option<Order> {
        if seen.now.since(self.sent) < THRESHOLD_DELAY {
            return None;
        }
        let mut setpoints = Setpoints::none(self.epoch);
        for (finger, _) in self.fingers.iter().filter(|(_, hold)| hold.is_some()) {
            let dof = finger.bend();
            self.threshold_g[dof] = self.range(dof).most_g + self.shift_g[dof];
            setpoints.force[dof] = Some(Force::nearest(rounded(self.threshold_g[dof])));
        }
        (self.step, self.held_since) = (HoldStage::Holding, Some(seen.now));
        Some(Order::Set(setpoints))
    }

    fn regulate(
        &mut self,
        seen: &Seen<'_>,
        angles: &PerDof<AngleReading>,
        fresh: Groups,
    ) -> Option<Order> {
        let held = self
            .held_since
            .map_or(Duration::ZERO, |since| seen.now.since(since));
        if self.start.duration.is_some_and(|duration| held >= duration) {
            self.end = Some(Ok(HoldEnd::Held));
            return Some(Order::Disarm);
        }
        if !fresh.contains(Group::Force) && !fresh.has_tactile() {
            return None;
        }
        let mut setpoints = Setpoints::none(self.epoch);
        for finger in Finger::ALL {
            let dof = finger.bend();
            let Some((force_g, at)) = self.force_g(seen.sample, dof).zip(angles[dof].hold()) else {
                continue;
            };
            self.watch_loss(seen, finger, force_g);
            let is_gone = self.gone_since[finger].is_some();
            let Some(hold) = &mut self.fingers[finger] else {
                continue;
            };
            let is_far = f64::from(self.held_from[finger] - at.get()) > hold.travel_max();
            let step = hold.apply(FingerReading {
                at: seen.now,
                force_g,
                angle: at.get(),
                is_warm: is_warm(seen.sample, dof),
            });
            if let Some((settled_g, angle)) = hold.settled() {
                self.shown.rests(finger, angle, settled_g);
            }
            // What has lost the object, or followed it too far, opens at most.
            let Some(step) = step.filter(|step| step.cause.is_none() || !(is_gone || is_far))
            else {
                continue;
            };
            setpoints.angle[dof] = Some(Target::Go(step.to));
            setpoints.speed[dof] = Some(step.speed);
            if let Some(cause) = step.cause {
                self.tightened += 1;
                let tightened = Tightened { finger, cause };
                self.last = Some(tightened);
                self.events.push_back(tightened);
            }
        }
        self.object = Some(self.held_object(angles, seen.now));
        if self.is_lost(seen.now) {
            return Some(self.finish(HoldEnd::Lost));
        }
        Some(Order::Set(setpoints))
    }

    fn watch_loss(&mut self, seen: &Seen<'_>, finger: Finger, force_g: f64) {
        let tip_n = seen.sample.tactile[finger].and_then(|tip| tip.value.normal());
        let least = GONE_SHARE * self.range(finger.bend()).least_g;
        let has_felt = self.fingers[finger]
            .as_ref()
            .is_some_and(FingerHold::has_felt);
        // The zero of a drive drifts: a fingertip that felt the object and feels nothing any more is believed.
        let is_gone = match tip_n {
            Some(n) if n >= TOUCH_N => false,
            Some(_) if has_felt => true,
            _ => force_g < least,
        };
        let since = &mut self.gone_since[finger];
        *since = is_gone.then(|| since.unwrap_or(seen.now));
    }

    fn held_object(&self, angles: &PerDof<AngleReading>, now: Moment) -> HeldObject {
        let holding = || self.fingers.as_array().iter().flatten();
        let is_quiet = holding().all(|finger| finger.is_quiet(now));
        let loads: Option<Vec<TipLoad>> = holding().map(FingerHold::tip_load).collect();
        self.shown.object(
            PerFinger::from_fn(|finger| self.fingers[finger].is_some()),
            angles[Dof::ThumbRotate].documented(),
            loads.as_deref().filter(|_| is_quiet),
        )
    }

    /// True once every finger that held presses on nothing.
    fn is_lost(&self, now: Moment) -> bool {
        let mut holding = self.fingers.iter().filter(|(_, hold)| hold.is_some());
        let is_gone = |since: Moment| now.since(since) >= GONE_AFTER;
        holding.all(|(finger, _)| self.gone_since[finger].is_some_and(is_gone))
    }

    fn finish(&mut self, end: HoldEnd) -> Order {
        self.end = Some(Ok(end));
        Order::Stop
    }
}

fn is_warm(sample: &HandSample, dof: Dof) -> bool {
    let celsius = sample
        .temperature
        .and_then(|six| six.value[dof].documented());
    celsius.is_some_and(|celsius| celsius >= WARM)
}

#[expect(clippy::cast_possible_truncation, reason = "clamped to a small range")]
fn whole(value: f64) -> i16 {
    value.clamp(-9999.0, 9999.0).round() as i16
}

fn rounded(value: f64) -> i64 {
    whole(value).into()
}
