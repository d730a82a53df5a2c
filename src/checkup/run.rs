//! A running check-up: which step is next, when one is over, what ends it early. Sends nothing and reads no clock.

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

/// What ends it at once: an empty hand meets nothing, and warms little.
pub const LIMITS: Limits = Limits {
    ceiling_g: 300,
    stop_c: 60,
    start_c: 55,
};
/// Each joint stops by itself this far above its zero, g.
const THRESHOLD_G: f64 = 150.0;
/// No threshold is lower, whatever the zero, g: noise alone would stop a joint.
const LEAST_G: i64 = 20;
/// A joint is not moved whose threshold cannot stand between these above its zero, g: it would stop at nothing, or press too hard.
const OWN_STOP_G: RangeInclusive<f64> = 60.0..=200.0;
/// How long the hand may take to confirm a speed and a threshold.
const CONFIRM_TIMEOUT: Duration = Duration::from_secs(3);
/// A joint stands still that stayed so long within [`STILL`], and that had so long to begin.
const STILL_DURATION: Duration = Duration::from_millis(300);
const START_DELAY: Duration = Duration::from_millis(1000);
/// Units of ANGLE_ACT.
const STILL: i16 = 1;
/// A joint this near to its target has arrived.
const ARRIVED: i16 = 3;
/// A joint this near to its open end did not begin to close.
const STUCK_TOLERANCE: i16 = 10;
/// A joint may have been stopped by its own offset that rests so far below its threshold at most, g: more than the noise of a
/// worn sensor.
const OFFSET_STOPS_WITHIN_G: f64 = 40.0;
/// The angle from which on a joint is in no other's way.
const OPEN_ENOUGH: i16 = 900;
/// A fingertip is let go so long after its last pressed reading.
const LET_GO: Duration = Duration::from_millis(500);
/// No stroke takes longer.
const STROKE_MAX: Duration = Duration::from_secs(20);

/// Where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CheckupView {
    /// Steps that are over.
    pub done: usize,
    /// Steps in all.
    pub total: usize,
    /// The joint that moves alone now.
    pub joint: Option<Dof>,
    /// The fingertip that is to be pressed now; nothing moves, and the hand is not armed.
    pub press: Option<Finger>,
    /// About how long the rest takes from when this step began, if nothing ends it.
    pub left: Duration,
}

#[derive(Debug, Clone, Copy)]
enum StepPhase {
    /// Speed and threshold were sent at this time, and are to be read back.
    Confirming {
        since: Moment,
    },
    /// The targets were sent.
    Moving,
    Resting,
    /// A fingertip is waited for, or was pressed last at this time.
    Pressing {
        last: Option<Moment>,
    },
}

#[derive(Debug, Clone)]
struct RunningStep {
    stage: StepPhase,
    record: StepRecord,
    /// Where the joints go that move in it.
    targets: PerDof<Option<Angle>>,
    /// The thresholds that were sent for it.
    forces: PerDof<Option<Force>>,
    /// Where all joints stand still, and since when.
    pose: Option<(Moment, PerDof<i16>)>,
}

impl RunningStep {
    /// A joint that should be open now and is far from it: the next would meet it on its way.
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

/// A check-up in an arming that the user gave.
#[derive(Debug, Clone)]
pub struct Checkup {
    epoch: ArmEpoch,
    left: VecDeque<CheckupStep>,
    total: usize,
    running: Option<RunningStep>,
    zero_g: PerDof<Option<f64>>,
    /// Joints that stopped with nothing in their way: their drives count what their sensors read at rest as force.
    counts_zero: PerDof<bool>,
    figures: StepResults,
    free: FreeForce,
    plan: CheckupPlan,
    is_over: bool,
    aborted: Option<Abort>,
}

impl Checkup {
    /// Nothing is sent before the first tick.
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

    /// Where it stands.
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

    /// What was measured until now.
    pub fn measured(&self) -> Vec<Measured> {
        measured(&self.figures, self.plan.press)
    }

    /// What the joints that closed read when they touched nothing.
    pub const fn free_force(&self) -> &FreeForce {
        &self.free
    }

    /// The joints that were left alone, with their zeros: they could not be stopped gently.
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
            // A joint that is left alone.
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

    /// Whether the threshold of a joint stops it early enough, whatever its sensor reads at rest.
    fn may_move(&self, dof: Dof) -> bool {
        let zero = self.zero_g[dof].unwrap_or_default();
        OWN_STOP_G.contains(&(f64::from(self.threshold(dof).get()) - zero))
    }

    /// Above what its sensor reads at rest.
    fn threshold(&self, dof: Dof) -> Force {
        threshold(self.zero_g[dof].unwrap_or_default())
    }

    /// Whether a closing joint stopped because its drive counts the sensor's offset: it met nothing, and reads about its threshold.
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

    /// Begins the step anew with thresholds above the zero, for joints that their own offset stopped.
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
        // Its figures are those of a whole stroke.
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

    /// What a joint met that closes, where nothing should be.
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

    /// True while fingertips are to be pressed: the hand must not be armed then, so that it cannot close on the user.
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

    /// Takes a reading of the fingertip that is to be pressed.
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

/// So far above a zero.
fn threshold(zero_g: f64) -> Force {
    #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
    let grams = (zero_g + THRESHOLD_G).round() as i64;
    Force::nearest(grams.clamp(LEAST_G, Force::GENTLE.get().into()))
}

impl Checkup {
    /// True once nothing is sent any more.
    pub const fn is_over(&self) -> bool {
        self.is_over
    }

    /// Why it ended early, if it did. The hand is to be stopped then.
    pub const fn aborted(&self) -> Option<Abort> {
        self.aborted
    }

    /// Ends it early, if it is not over.
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

    /// Advances the time. Returns what to send now, if anything. `stall` is the last time in which this program did not run.
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
