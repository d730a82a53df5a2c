//! One running trial: takes samples and time, returns setpoints. Sends nothing, reads no clock, arms nothing.

use crate::hand::{
    Angle, AngleReading, Dof, Force, Groups, HandSample, Moment, PerDof, Speed, Status, Target,
};
use crate::hand::{ArmEpoch, Setpoints};
use crate::record::Abort;
use crate::trials::limits::{Feedback, TaskStall, reason};
use crate::trials::plan::{Approach, TrialPlan, TrialSetting, Until};
use crate::trials::recording::{TrialEvent, TrialRecording};
use std::time::Duration;

/// Rest before the closing command; its readings are the zero of all forces.
pub const QUIET: Duration = Duration::from_millis(500);
/// Longest wait for the hand to confirm speed and threshold.
const LIMITS_TIMEOUT: Duration = Duration::from_secs(4);
/// Longest travel to the start and back, at a gentle speed.
const TRAVEL_TIMEOUT: Duration = Duration::from_secs(20);
/// Time recorded after the release.
const AFTER: Duration = Duration::from_millis(300);
/// Angles within this distance count as equal.
const STILL_COUNTS: i16 = 2;
/// A joint that reports a stop and is still for this long has stopped.
const STILL_DURATION: Duration = Duration::from_millis(200);
/// A joint that is still for this long has stopped, whatever it reports: at speed 1 it moves three counts in that time.
const STILL_ANYWAY: Duration = Duration::from_millis(1800);
/// Extra time for closing: dead time, ramps, a slow wire.
const CLOSE_SLACK: Duration = Duration::from_secs(4);
/// Newtons per gram.
const N_PER_G: f64 = 0.009_806_65;

/// State of one closing joint.
#[derive(Debug, Clone, Copy)]
struct ClosingJoint {
    dof: Dof,
    close: Angle,
    /// First target, if it does not close all the way at once.
    halt: Option<Angle>,
    slow: bool,
    moved: bool,
    still: Option<(Moment, i16)>,
    from: i16,
    /// Proximity at the closing command.
    proximity: Option<i32>,
}

/// Activity of the hand in a series, for display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Between two trials: rests, or cools.
    Resting,
    /// Moves to its start.
    Preparing,
    /// Is still while its limits are confirmed.
    Quiet,
    Closing,
    /// Holds.
    Dwelling,
    /// Opens.
    Releasing,
    /// Finished.
    Over,
}

/// End of a trial; `Err` with the reason if it ended early.
pub type TrialEnd = Result<(), Abort>;

#[derive(Debug, Clone)]
pub struct Runner {
    plan: TrialPlan,
    setting: TrialSetting,
    epoch: ArmEpoch,
    stage: Stage,
    /// Start of the stage; zero before the trial begins.
    since: Moment,
    joints: PerDof<Option<ClosingJoint>>,
    rest: PerDof<Mean>,
    /// Angles at which all joints are still on the way to the start, and since when.
    pose: Option<(Moment, PerDof<i16>)>,
    recording: TrialRecording,
    ending: Option<TrialEnd>,
}

#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count = self.count.saturating_add(1);
    }

    fn get(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / f64::from(self.count))
    }
}

impl Runner {
    /// A trial of a checked plan. `contact`: angles at which a first trial met the object.
    pub fn new(
        plan: &TrialPlan,
        setting: TrialSetting,
        contact: &PerDof<Option<Angle>>,
        epoch: ArmEpoch,
    ) -> Self {
        let joints = PerDof::from_fn(|dof| {
            let close = plan.close[dof]?;
            Some(ClosingJoint {
                dof,
                close,
                halt: halt(plan, contact[dof], dof),
                slow: plan.approach == Approach::OneStage,
                moved: false,
                still: None,
                from: 0,
                proximity: None,
            })
        });
        Self {
            plan: plan.clone(),
            setting,
            epoch,
            stage: Stage::Resting,
            since: Moment::ZERO,
            joints,
            rest: PerDof::splat(Mean::default()),
            pose: None,
            recording: TrialRecording::default(),
            ending: None,
        }
    }

    pub const fn recording(&self) -> &TrialRecording {
        &self.recording
    }

    /// The current activity of the hand.
    pub const fn stage(&self) -> Stage {
        self.stage
    }

    /// The end of the trial; `None` while it runs.
    pub const fn ending(&self) -> Option<TrialEnd> {
        self.ending
    }

    pub fn into_recording(self) -> TrialRecording {
        self.recording
    }

    /// Ends the trial early. The first reason is kept.
    pub fn abort(&mut self, why: Abort, now: Moment) {
        if self.ending.is_none() {
            self.enter(Stage::Over, TrialEvent::Aborted, now);
            self.ending = Some(Err(why));
        }
    }

    pub fn apply(&mut self, sample: &HandSample, fresh: Groups) {
        if self.ending.is_some() {
            return;
        }
        self.recording.push(sample, fresh);
        if self.stage == Stage::Quiet && fresh.contains(crate::hand::Group::Force) {
            for (dof, mean) in self.rest.iter_mut() {
                let force = sample.force.and_then(|force| force.value[dof].documented());
                if let Some(force) = force {
                    mean.add(force.into());
                }
            }
        }
    }

    /// Advances the time. Returns the setpoints to send now, if any.
    pub fn tick(
        &mut self,
        sample: &HandSample,
        stall: Option<TaskStall>,
        now: Moment,
    ) -> Option<Setpoints> {
        if self.ending.is_some() {
            return None;
        }
        let rest_g = self.rest.map(Mean::get);
        let seen = Feedback {
            sample,
            rest_g: &rest_g,
            stall,
            now,
        };
        if let Some(why) = reason(&seen, &self.plan.limits) {
            self.abort(why, now);
            return None;
        }
        let lasted = now.since(self.since);
        match self.stage {
            Stage::Resting => {
                self.enter(Stage::Preparing, TrialEvent::Prepare, now);
                Some(self.to_start())
            }
            Stage::Preparing => self.preparing(sample, now),
            Stage::Quiet => self.quiet(sample, now),
            Stage::Closing => self.closing(sample, now),
            Stage::Dwelling if lasted >= self.plan.dwell => {
                self.enter(Stage::Releasing, TrialEvent::Release, now);
                Some(self.to_start())
            }
            Stage::Releasing if self.recording.when(TrialEvent::Released).is_some() => {
                if lasted >= AFTER {
                    self.stage = Stage::Over;
                    self.ending = Some(Ok(()));
                }
                None
            }
            Stage::Releasing => {
                if self.there(sample, now) {
                    self.enter(Stage::Releasing, TrialEvent::Released, now);
                }
                None
            }
            Stage::Dwelling | Stage::Over => None,
        }
    }

    fn enter(&mut self, stage: Stage, what: TrialEvent, now: Moment) {
        self.recording.mark(now, what);
        (self.stage, self.since) = (stage, now);
    }

    fn setpoints(&self) -> Setpoints {
        Setpoints::none(self.epoch)
    }

    fn to_start(&self) -> Setpoints {
        let mut setpoints = self.setpoints();
        for (dof, start) in self.plan.start.iter() {
            if let Some(start) = start {
                setpoints.speed[dof] = Some(Speed::GENTLE);
                setpoints.force[dof] = Some(self.setting.force.min(Force::GENTLE));
                setpoints.angle[dof] = Some(Target::Go(*start));
            }
        }
        setpoints
    }

    /// True if all joints are still at their starts; ends the trial if that takes too long. A joint that still moves would finish
    /// its way at the closing speed.
    fn there(&mut self, sample: &HandSample, now: Moment) -> bool {
        let since = self.since;
        // Only replies to requests made after the command show its effect.
        let angle = sample.angle.filter(|angle| angle.asked >= since);
        let away = self.plan.start.iter().find_map(|(dof, start)| {
            let start = (*start)?;
            let near = angle.is_some_and(|angle| {
                let seen = angle.value[dof].documented();
                seen.is_some_and(|seen| start.is_reached_at(seen))
            });
            (!near).then_some((dof, start.get()))
        });
        let still = angle.is_some_and(|angle| self.is_still(&angle.value.map(|v| v.raw()), now));
        let (dof, target) = match away {
            None if still => return true,
            None => self.first_start(),
            Some(away) => away,
        };
        if now.since(since) >= TRAVEL_TIMEOUT {
            self.abort(Abort::Unreached { dof, target }, now);
        }
        false
    }

    /// The joint to report when all are at their starts and one still moves.
    fn first_start(&self) -> (Dof, i16) {
        let mut starts = self.plan.start.iter();
        let first = starts.find_map(|(dof, start)| Some((dof, (*start)?.get())));
        first.unwrap_or((Dof::Little, Angle::MAX.get()))
    }

    fn is_still(&mut self, pose: &PerDof<i16>, now: Moment) -> bool {
        let near = |from: &PerDof<i16>| {
            let mut joints = Dof::ALL.into_iter();
            joints.all(|dof| from[dof].abs_diff(pose[dof]) <= STILL_COUNTS.unsigned_abs())
        };
        match self.pose {
            Some((since, from)) if near(&from) => now.since(since) >= STILL_DURATION,
            _ => {
                self.pose = Some((now, *pose));
                false
            }
        }
    }

    fn preparing(&mut self, sample: &HandSample, now: Moment) -> Option<Setpoints> {
        if !self.there(sample, now) {
            return None;
        }
        self.enter(Stage::Quiet, TrialEvent::Limits, now);
        let mut setpoints = self.setpoints();
        for (dof, _) in self.joints.iter().filter(|(_, joint)| joint.is_some()) {
            setpoints.speed[dof] = Some(self.first_speed());
            setpoints.force[dof] = Some(self.setting.force);
        }
        Some(setpoints)
    }

    const fn first_speed(&self) -> Speed {
        match self.plan.approach {
            Approach::OneStage => self.setting.speed,
            Approach::TwoStage { fast, .. } => fast,
        }
    }

    /// Closes once the hand was quiet and confirmed its limits: no finger closes with an unknown threshold.
    fn quiet(&mut self, sample: &HandSample, now: Moment) -> Option<Setpoints> {
        if now.since(self.since) < QUIET {
            return None;
        }
        if let Some(dof) = self.unconfirmed(sample) {
            if now.since(self.since) >= LIMITS_TIMEOUT {
                self.abort(Abort::LimitsRefused { dof }, now);
            }
            return None;
        }
        let angle = sample.angle?.value;
        self.enter(Stage::Closing, TrialEvent::Close, now);
        let mut setpoints = self.setpoints();
        for (dof, joint) in self.joints.iter_mut() {
            let Some(joint) = joint else { continue };
            joint.from = angle[dof].raw();
            let tip = sample.tactile[dof.finger()].as_ref();
            joint.proximity = tip.map(|tip| tip.value.proximity);
            setpoints.angle[dof] = Some(Target::Go(joint.halt.unwrap_or(joint.close)));
        }
        Some(setpoints)
    }

    /// The first joint whose limits were not read back since they were set.
    fn unconfirmed(&self, sample: &HandSample) -> Option<Dof> {
        let (speed, force) = (self.first_speed(), self.setting.force);
        let speeds = sample.speed_set.filter(|read| read.asked > self.since);
        let forces = sample.force_set.filter(|read| read.asked > self.since);
        self.plan.joints().find(|dof| {
            speeds.is_none_or(|read| read.value[*dof] != Some(speed))
                || forces.is_none_or(|read| read.value[*dof] != Some(force))
        })
    }

    fn closing(&mut self, sample: &HandSample, now: Moment) -> Option<Setpoints> {
        let since = self.since;
        let mut setpoints = self.setpoints();
        let rest_g = self.rest.map(Mean::get);
        let mut all_stopped = true;
        for (dof, joint) in self.joints.iter_mut() {
            let Some(joint) = joint else { continue };
            joint.update(sample, since, now);
            // A joint that stopped earlier, at an obstacle or for lack of accuracy, continues from where it is.
            if !joint.slow
                && (joint.begins_slow(self.plan.approach, sample, rest_g[dof])
                    || joint.is_still(sample, now))
            {
                joint.slow = true;
                joint.still = None;
                setpoints.speed[dof] = Some(self.setting.speed);
                setpoints.angle[dof] = Some(Target::Go(joint.close));
                self.recording.mark(now, TrialEvent::Slow(dof));
            }
            all_stopped &= joint.has_stopped(sample, now);
        }
        let too_late = now.since(since) >= self.close_within();
        if all_stopped || too_late {
            let what = if all_stopped {
                TrialEvent::Stopped
            } else {
                TrialEvent::NotStopped
            };
            self.enter(Stage::Dwelling, what, now);
        }
        (!setpoints.is_empty()).then_some(setpoints)
    }

    /// The longest time that the full way can take at the setting's speed.
    fn close_within(&self) -> Duration {
        let way = f64::from(Angle::MAX.get());
        Duration::from_secs_f64(way / self.setting.speed.angle_per_s()) + CLOSE_SLACK
    }
}

/// Angle at which a joint halts before its slow stage; `None` without a halt.
fn halt(plan: &TrialPlan, contact: Option<Angle>, dof: Dof) -> Option<Angle> {
    let Approach::TwoStage { until, .. } = plan.approach else {
        return None;
    };
    match until {
        Until::Angle(angle) => Some(angle),
        Until::Measured { margin } => {
            let start = plan.start[dof].unwrap_or(Angle::MAX);
            let before = Angle::nearest(contact?.get().saturating_add(margin));
            Some(before.min(start))
        }
        Until::Proximity(_) | Until::Touch(_) => None,
    }
}

impl ClosingJoint {
    /// True once its fast stage is over.
    fn begins_slow(&self, approach: Approach, sample: &HandSample, rest_g: Option<f64>) -> bool {
        let Approach::TwoStage { until, .. } = approach else {
            return false;
        };
        let tip = sample.tactile[self.dof.finger()].map(|tip| tip.value);
        match until {
            Until::Angle(_) | Until::Measured { .. } => {
                self.halt.is_none_or(|halt| self.has_halted(halt, sample))
            }
            Until::Proximity(rise) => {
                let now = tip.map(|tip| tip.proximity);
                let risen = now.zip(self.proximity);
                risen.is_some_and(|(now, before)| now.saturating_sub(before) >= rise)
            }
            Until::Touch(grams) => {
                let grams = f64::from(grams.get());
                let felt = tip.and_then(|tip| tip.normal()).map(f64::from);
                let force = sample
                    .force
                    .and_then(|force| force.value[self.dof].documented());
                felt.is_some_and(|newtons| newtons >= grams * N_PER_G)
                    || force
                        .zip(rest_g)
                        .is_some_and(|(force, rest)| f64::from(force) - rest >= grams)
            }
        }
    }

    /// Updates its motion state.
    fn update(&mut self, sample: &HandSample, since: Moment, now: Moment) {
        let Some(angle) = sample.angle.filter(|angle| angle.asked >= since) else {
            return;
        };
        let seen = angle.value[self.dof].raw();
        let status = sample.status.filter(|status| status.asked >= since);
        let status = status.map(|status| status.value[self.dof]);
        self.moved |= status == Some(Status::Grasping)
            || seen.abs_diff(self.from) > STILL_COUNTS.unsigned_abs() + 1;
        match self.still {
            Some((_, at)) if seen.abs_diff(at) <= STILL_COUNTS.unsigned_abs() => {}
            _ => self.still = Some((now, seen)),
        }
    }

    /// True at its halt or past it. A drive resting short of its target has arrived once it reports a stop.
    fn has_halted(&self, halt: Angle, sample: &HandSample) -> bool {
        let angle = sample.angle.map(|angle| angle.value[self.dof]);
        angle.and_then(AngleReading::documented).is_some_and(|at| {
            let short = at.saturating_sub(halt.get());
            let is_near = short <= Angle::ARRIVED_TOLERANCE.cast_signed();
            short <= STILL_COUNTS || (is_near && self.reports_stop(sample))
        })
    }

    /// True if it has moved and its drive reports a stop.
    fn reports_stop(&self, sample: &HandSample) -> bool {
        let status = sample.status.map(|status| status.value[self.dof]);
        self.moved && status.is_some_and(Status::is_stopped)
    }

    /// True once it has finally stopped: at its target, at its force, or at an obstacle.
    fn has_stopped(&self, sample: &HandSample, now: Moment) -> bool {
        self.slow && self.is_still(sample, now)
    }

    fn is_still(&self, sample: &HandSample, now: Moment) -> bool {
        let still = self.still.map(|(since, _)| now.since(since));
        still.is_some_and(|still| {
            still >= STILL_ANYWAY || (self.reports_stop(sample) && still >= STILL_DURATION)
        })
    }
}
