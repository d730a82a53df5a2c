//! A running check-up: the next step, the end of a step, and reasons for an early end. Sends nothing and reads no clock.

use crate::checkup::measure::{JointReadings, Measured, StepRecord, StepResults, measured};
use crate::checkup::steps::{CheckupPlan, CheckupStep, PRESS_TIMEOUT, REST, Way, slow, steps};
use crate::checkup::tips::TipReading;
use crate::hand::grip::FreeForce;
use crate::hand::{
    Angle, ArmEpoch, Dof, Finger, Force, Group, Groups, HandSample, Moment, PerDof, Setpoints,
    Target, TemperatureReading,
};
use crate::record::Abort;
use crate::trials::Limits;
use crate::trials::limits::{Feedback, TaskStall, reason, warmest};
use std::collections::VecDeque;
use std::ops::RangeInclusive;
use std::time::Duration;

/// Limits that end it at once: an empty hand meets no resistance, and warms little.
pub const LIMITS: Limits = Limits {
    ceiling_g: 300,
    stop_c: 60,
    start_c: 55,
};
/// Threshold of each joint above its zero, g.
const THRESHOLD_G: f64 = 150.0;
/// Minimum threshold regardless of the zero, g: below it, noise alone would stop a joint.
const LEAST_G: i64 = 20;
/// Permitted threshold above the zero, g. A joint outside this range is not moved: it would stop at nothing, or press too hard.
const OWN_STOP_G: RangeInclusive<f64> = 60.0..=200.0;
/// Maximum time for the hand to confirm a speed and a threshold.
const CONFIRM_TIMEOUT: Duration = Duration::from_secs(3);
/// A joint is at rest if it stayed within [`STILL`] for this time, and [`START_DELAY`] has passed.
const STILL_DURATION: Duration = Duration::from_millis(300);
const START_DELAY: Duration = Duration::from_millis(1000);
/// Units of ANGLE_ACT.
const STILL: i16 = 1;
/// Tolerance at a target.
const ARRIVED: i16 = 3;
/// Tolerance at the open end within which a joint has not begun to close.
const STUCK_TOLERANCE: i16 = 10;
/// A joint that rests at most this far below its threshold may have been stopped by its own offset, g: more than the noise of a worn
/// sensor.
const OFFSET_STOPS_WITHIN_G: f64 = 40.0;
/// Angle from which a joint obstructs no other.
const OPEN_ENOUGH: i16 = 900;
/// A fingertip counts as released this long after its last pressed reading.
const LET_GO: Duration = Duration::from_millis(500);
/// Maximum duration of a stroke.
const STROKE_MAX: Duration = Duration::from_secs(20);

/// Progress of a check-up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CheckupView {
    /// Completed steps.
    pub done: usize,
    /// Total number of steps.
    pub total: usize,
    /// The joint that is moving alone.
    pub joint: Option<Dof>,
    /// The fingertip that the user should press now; nothing moves, and the hand is disarmed.
    pub press: Option<Finger>,
    /// Estimated duration from the start of this step to the end, if nothing ends it early.
    pub left: Duration,
}

#[derive(Debug, Clone, Copy)]
enum StepPhase {
    /// Speed and threshold were sent at this time, and await readback.
    Confirming {
        since: Moment,
    },
    /// The targets were sent.
    Moving,
    Resting,
    /// Waiting for a press of a fingertip, or the time of its last pressed reading.
    Pressing {
        last: Option<Moment>,
    },
}

#[derive(Debug, Clone)]
struct RunningStep {
    stage: StepPhase,
    record: StepRecord,
    /// Targets of the joints that move in this step.
    targets: PerDof<Option<Angle>>,
    /// Thresholds that were sent for it.
    forces: PerDof<Option<Force>>,
    /// Angles at which all joints rest, and the time since then.
    pose: Option<(Moment, PerDof<i16>)>,
}

impl RunningStep {
    /// Returns a joint that should be open now and is far from it: the next joint would collide with it.
    fn blocked(&self) -> Option<Dof> {
        let opens = |dof: &Dof| self.targets[*dof] == Some(Angle::MAX);
        let is_open = |dof: &Dof| {
            let (_, pose) = self.pose.as_ref()?;
            (pose[*dof] >= OPEN_ENOUGH).then_some(())
        };
        let mut opening = Dof::ALL.into_iter().filter(opens);
        opening.find(|dof| is_open(dof).is_none())
    }
}

/// A check-up under an arming by the user.
#[derive(Debug, Clone)]
pub struct Checkup {
    epoch: ArmEpoch,
    left: VecDeque<CheckupStep>,
    total: usize,
    running: Option<RunningStep>,
    zero_g: PerDof<Option<f64>>,
    /// Joints that stopped without an obstacle: their drives count the resting value of the sensor as force.
    counts_zero: PerDof<bool>,
    figures: StepResults,
    free: FreeForce,
    plan: CheckupPlan,
    is_over: bool,
    aborted: Option<Abort>,
}

impl Checkup {
    /// Starts a check-up. Nothing is sent before the first tick.
    pub fn start(epoch: ArmEpoch, plan: CheckupPlan) -> Self {
        let left = steps(plan);
        Self {
            epoch,
            plan,
            total: left.len(),
            left,
            running: None,
            zero_g: PerDof::splat(None),
            counts_zero: PerDof::splat(false),
            figures: StepResults::default(),
            free: FreeForce::default(),
            is_over: false,
            aborted: None,
        }
    }

    /// Current progress.
    pub fn view(&self) -> CheckupView {
        let running = self.running.as_ref().map(|running| running.record.step);
        let (joint, press) = match running {
            Some(CheckupStep::Stroke(dof, _, _)) => (Some(dof), None),
            Some(CheckupStep::Press(finger)) => (None, Some(finger)),
            Some(CheckupStep::Open | CheckupStep::Rest | CheckupStep::Together(_)) | None => {
                (None, None)
            }
        };
        CheckupView {
            done: self.total - self.left.len() - usize::from(running.is_some()),
            total: self.total,
            joint,
            press,
            left: running
                .iter()
                .chain(&self.left)
                .map(|own| own.expected())
                .sum(),
        }
    }

    /// Measurements so far.
    pub fn measured(&self) -> Vec<Measured> {
        measured(&self.figures, self.plan.press)
    }

    /// Forces of the closing joints while they touched nothing.
    pub const fn free_force(&self) -> &FreeForce {
        &self.free
    }

    /// Joints that were not moved because they could not be stopped gently, with their zeros.
    pub fn left_alone(&self) -> Vec<(Dof, f64)> {
        let known = |dof: Dof| Some((dof, self.zero_g[dof]?));
        let all = Dof::ALL.into_iter().filter_map(known);
        all.filter(|(dof, _)| !self.may_move(*dof)).collect()
    }

    fn fail(&mut self, why: Abort) {
        self.aborted.get_or_insert(why);
        self.is_over = true;
        self.running = None;
    }

    fn next(&mut self, now: Moment) -> Option<Setpoints> {
        let Some(step) = self.left.pop_front() else {
            self.is_over = true;
            return None;
        };
        let may_move = |dof: Dof| step == CheckupStep::Open || self.may_move(dof);
        let wanted = step.targets();
        let targets = PerDof::from_fn(|dof| wanted[dof].filter(|_| may_move(dof)));
        let force = |dof: Dof| match step.closes() && !self.counts_zero[dof] {
            true => self.threshold(dof).min(threshold(0.0)),
            false => self.threshold(dof),
        };
        let forces = PerDof::from_fn(|dof| targets[dof].map(|_| force(dof)));
        let stands_still = targets.iter().all(|(_, target)| target.is_none());
        let stage = match step {
            CheckupStep::Rest => StepPhase::Resting,
            CheckupStep::Press(_) => StepPhase::Pressing { last: None },
            // A joint that may not move.
            CheckupStep::Open | CheckupStep::Stroke(..) | CheckupStep::Together(_)
                if stands_still =>
            {
                return self.next(now);
            }
            CheckupStep::Open | CheckupStep::Stroke(..) | CheckupStep::Together(_) => {
                StepPhase::Confirming { since: now }
            }
        };
        self.running = Some(RunningStep {
            stage,
            record: StepRecord::new(step, now),
            targets,
            forces,
            pose: None,
        });
        match stage {
            StepPhase::Confirming { .. } => Some(Setpoints {
                force: forces,
                speed: targets.map(|target| target.map(|_| step.speed())),
                ..Setpoints::none(self.epoch)
            }),
            StepPhase::Pressing { .. } | StepPhase::Moving | StepPhase::Resting => None,
        }
    }

    /// True if the threshold of a joint stops it early enough, given the resting value of its sensor.
    fn may_move(&self, dof: Dof) -> bool {
        let zero = self.zero_g[dof].unwrap_or_default();
        OWN_STOP_G.contains(&(f64::from(self.threshold(dof).get()) - zero))
    }

    /// Threshold above the resting value of its sensor.
    fn threshold(&self, dof: Dof) -> Force {
        threshold(self.zero_g[dof].unwrap_or_default())
    }

    /// True if a closing joint stopped because its drive counts the sensor's offset: it met nothing, and reads about its threshold.
    // Manual 2.6.12: FORCE_SET is compared with FORCE_ACT; whether its offset counts is not stated. The lower threshold is gentle
    // either way.
    fn stopped_by_offset(&self, running: &RunningStep, dof: Dof) -> Option<bool> {
        let (since, pose) = running.pose?;
        let (target, force) = (running.targets[dof]?, running.forces[dof]?);
        let is_short = pose[dof] - target.get() > ARRIVED;
        let can_rise = running.record.step.closes() && force != self.threshold(dof);
        let reads = running.record.mean_force(dof, since)?;
        let reaches = reads >= f64::from(force.get()) - OFFSET_STOPS_WITHIN_G;
        let met = running.record.met(dof, self.zero_g[dof]?);
        Some(is_short && can_rise && reaches && met.is_none())
    }

    /// Restarts the step with thresholds above the zero, for joints that their own offset stopped.
    fn raise(&mut self, now: Moment) -> Option<Setpoints> {
        let running = self.running.as_ref()?;
        let (step, (_, pose)) = (running.record.step, running.pose?);
        let stopped = |dof| self.stopped_by_offset(running, dof).unwrap_or_default();
        let stopped = PerDof::from_fn(stopped);
        if !stopped.iter().any(|(_, is_stopped)| *is_stopped) {
            return None;
        }
        self.counts_zero = PerDof::from_fn(|dof| self.counts_zero[dof] || stopped[dof]);
        self.left.push_front(step);
        // The measurements of a step are those of a full stroke.
        let is_open = |dof: Dof| pose[dof] >= Angle::MAX.get() - STUCK_TOLERANCE;
        let moved = |dof: &Dof| running.targets[*dof].is_some();
        if !Dof::ALL.into_iter().filter(moved).all(is_open) {
            self.left.push_front(CheckupStep::Open);
        }
        self.running = None;
        self.next(now)
    }

    fn confirm(&mut self, sample: &HandSample, since: Moment, now: Moment) -> Option<Setpoints> {
        let running = self.running.as_ref()?;
        let targets = running.targets;
        let speed = running.record.step.speed();
        let holds = |dof: Dof| {
            let speeds = sample.speed_set.filter(|own| own.asked >= since);
            let forces = sample.force_set.filter(|own| own.asked >= since);
            let has_speed = speeds.is_some_and(|own| own.value[dof] == Some(speed));
            has_speed && forces.is_some_and(|own| own.value[dof] == running.forces[dof])
        };
        let mut moved = Dof::ALL.into_iter().filter(|dof| targets[*dof].is_some());
        if let Some(dof) = moved.find(|dof| !holds(*dof)) {
            if now.since(since) >= CONFIRM_TIMEOUT {
                self.fail(Abort::LimitsRefused { dof });
            }
            return None;
        }
        let running = self.running.as_mut()?;
        running.stage = StepPhase::Moving;
        running.record.sent = now;
        Some(Setpoints {
            angle: targets.map(|target| target.map(Target::Go)),
            ..Setpoints::none(self.epoch)
        })
    }

    fn close_step(&mut self, sample: &HandSample) {
        let Some(mut running) = self.running.take() else {
            return;
        };
        if running.record.step == CheckupStep::Rest {
            let temperature = sample.temperature.map(|read| read.value);
            let known = |six: PerDof<TemperatureReading>| six.map(TemperatureReading::documented);
            running.record.warmth = temperature.map(known);
            for (dof, zero) in running.record.zeros().iter() {
                self.zero_g[dof] = zero.or(self.zero_g[dof]);
            }
        }
        if let CheckupStep::Stroke(dof, speed, Way::Closing) = running.record.step
            && speed == slow()
            && let Some(zero_g) = self.zero_g[dof]
        {
            self.free.put(dof, &running.record.free_close(dof, zero_g));
        }
        self.figures.add(&running.record);
    }

    /// Reason to end if a closing joint met an object, where there should be none.
    fn met(&self) -> Option<Abort> {
        let running = self.running.as_ref()?;
        let closes = running.record.step.closes();
        let mut closing = Dof::ALL
            .into_iter()
            .filter(|dof| closes && running.targets[*dof].is_some());
        closing.find_map(|dof| {
            let (angle, grams) = running.record.met(dof, self.zero_g[dof]?)?;
            #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
            let (angle, grams) = (angle.round() as i16, grams.round() as i16);
            Some(Abort::NotEmpty { dof, angle, grams })
        })
    }

    /// True while the user presses fingertips: the hand must be disarmed then, so that it cannot close on the user.
    pub fn is_pressing(&self) -> bool {
        matches!(
            self.running.as_ref().map(|own| own.stage),
            Some(StepPhase::Pressing { .. })
        )
    }

    fn tick_press(&mut self, now: Moment) -> Option<Setpoints> {
        let running = self.running.as_ref()?;
        let StepPhase::Pressing { last } = running.stage else {
            return None;
        };
        let is_let_go = last.is_some_and(|last| now.since(last) >= LET_GO);
        if !is_let_go && now.since(running.record.sent) < PRESS_TIMEOUT {
            return None;
        }
        if let Some(running) = self.running.take() {
            self.figures.add(&running.record);
        }
        self.next(now)
    }

    /// Receives a reading of the fingertip that should be pressed.
    fn apply_press(&mut self, finger: Finger, sample: &HandSample, fresh: Groups) {
        let fresh = fresh.contains(Group::Tactile(finger));
        let Some(tip) = TipReading::of(sample, finger).filter(|_| fresh) else {
            return;
        };
        let unpressed = self.figures.unpressed();
        let is_pressed = unpressed.is_some_and(|unpressed| unpressed.is_pressed(&tip));
        let asked = sample.tactile[finger].map(|block| block.asked);
        let Some(running) = &mut self.running else {
            return;
        };
        running.record.tips.push(tip);
        if is_pressed {
            running.stage = StepPhase::Pressing { last: asked };
        }
    }
}

/// Threshold at its distance above a zero.
fn threshold(zero_g: f64) -> Force {
    #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
    let grams = (zero_g + THRESHOLD_G).round() as i64;
    Force::nearest(grams.clamp(LEAST_G, Force::GENTLE.get().into()))
}

impl Checkup {
    /// True once nothing further is sent.
    pub const fn is_over(&self) -> bool {
        self.is_over
    }

    /// Reason for an early end; `None` if there is none. The hand must then be stopped.
    pub const fn aborted(&self) -> Option<Abort> {
        self.aborted
    }

    /// Ends the check-up early, unless it is over.
    pub fn abort(&mut self, why: Abort) {
        if !self.is_over {
            self.fail(why);
        }
    }

    /// Receives readings.
    pub fn read(&mut self, sample: &HandSample, fresh: Groups) {
        if fresh.contains(Group::Force)
            && let Some(force) = sample.force
        {
            for (dof, reading) in force.value.iter() {
                self.zero_g[dof].get_or_insert_with(|| f64::from(reading.raw()));
            }
        }
        if let Some(CheckupStep::Press(finger)) = self.running.as_ref().map(|own| own.record.step) {
            return self.apply_press(finger, sample, fresh);
        }
        let Some(running) = &mut self.running else {
            return;
        };
        running
            .record
            .readings
            .extend(JointReadings::of(sample, fresh));
        if running.record.step == CheckupStep::Rest {
            let tips = Finger::ALL.into_iter();
            let fresh_tips = tips.filter(|finger| fresh.contains(Group::Tactile(*finger)));
            let tips = fresh_tips.filter_map(|finger| TipReading::of(sample, finger));
            running.record.tips.extend(tips);
        }
        if fresh.contains(Group::Angle)
            && let Some(angle) = sample.angle
        {
            let raw = angle.value.map(|reading| reading.raw());
            let stands = |pose: &PerDof<i16>| {
                Dof::ALL
                    .into_iter()
                    .all(|dof| (raw[dof] - pose[dof]).abs() <= STILL)
            };
            let kept = running.pose.filter(|(_, pose)| stands(pose));
            running.pose = Some(kept.unwrap_or((angle.asked, raw)));
        }
    }

    /// Advances the time. Returns the setpoints to send now, if any. `stall` is the most recent interval in which this program did not
    /// run.
    pub fn tick(
        &mut self,
        sample: &HandSample,
        stall: Option<TaskStall>,
        now: Moment,
    ) -> Option<Setpoints> {
        if self.is_over {
            return None;
        }
        if let Some(CheckupStep::Press(_)) = self.running.as_ref().map(|own| own.record.step) {
            return self.tick_press(now);
        }
        let seen = Feedback {
            sample,
            rest_g: &self.zero_g,
            stall,
            now,
        };
        if let Some(why) = reason(&seen, &LIMITS) {
            self.fail(why);
            return None;
        }
        if self.zero_g.iter().any(|(_, zero)| zero.is_none()) {
            return None;
        }
        let Some(running) = &self.running else {
            let warm = warmest(sample).filter(|(_, celsius)| *celsius >= LIMITS.start_c);
            if let Some((dof, celsius)) = warm.filter(|_| self.left.len() == self.total) {
                let limit = LIMITS.start_c;
                self.fail(Abort::TooWarm {
                    dof,
                    celsius,
                    limit,
                });
                return None;
            }
            return self.next(now);
        };
        let sent = running.record.sent;
        let is_over = match running.stage {
            StepPhase::Confirming { since } => return self.confirm(sample, since, now),
            StepPhase::Resting => now.since(sent) >= REST,
            StepPhase::Pressing { .. } => false,
            StepPhase::Moving => {
                let targets = running.targets;
                let still = running
                    .pose
                    .filter(|(since, _)| now.since(*since) >= STILL_DURATION);
                let near = |pose: &PerDof<i16>, dof: Dof| {
                    let target = targets[dof].map(Angle::get);
                    target.is_none_or(|target| (target - pose[dof]).abs() <= ARRIVED)
                };
                let arrived = |pose: &PerDof<i16>| Dof::ALL.iter().all(|dof| near(pose, *dof));
                let waited = now.since(sent);
                still.is_some_and(|(_, pose)| arrived(&pose) || waited >= START_DELAY)
                    || waited >= STROKE_MAX
            }
        };
        if !is_over {
            return None;
        }
        let blocked = running.blocked();
        if let Some(order) = self.raise(now) {
            return Some(order);
        }
        if let Some(dof) = blocked {
            let target = Angle::MAX.get();
            self.fail(Abort::Unreached { dof, target });
            return None;
        }
        if let Some(why) = self.met() {
            self.fail(why);
            return None;
        }
        self.close_step(sample);
        self.next(now)
    }
}
