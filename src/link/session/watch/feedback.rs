//! Detects frozen feedback, and estimates the joint positions in that case. Pure; the session acts on it.
//!
//! Each joint is judged by itself: if its commands must have moved it visibly, its drive reports no reason for staying,
//! and its own angle is unchanged, the frames may be valid and the angle old all the same, whatever else in the hand
//! changes.

use crate::hand::{Angle, AngleReading, Dof, Finger, Group, Groups, HandSample, Moment, PerDof};
use crate::hand::{RegisterWrite, Speed, Status, Target, register};
use crate::record::SetpointRegister;
use std::collections::VecDeque;
use std::time::Duration;

/// An angle that is unchanged for this long, counted from when motion should have been seen, is doubted: about half a
/// second from the last change or the command.
pub(crate) const FREEZE_TIMEOUT: Duration = Duration::from_millis(450);
/// Minimum readings of the angles in this time: a pause in polling proves nothing.
const READINGS_MIN: u32 = 5;
/// After a pause in readings of this length, a joint that reads the same may have moved and returned.
const PAUSE: Duration = Duration::from_millis(250);
/// Readings after which a stop already ignores all that this joint reports …
const SUSPECT_READINGS: u32 = 2;
/// … over this time: a hand that reacts later than most is not frozen.
const SUSPECT_DELAY: Duration = Duration::from_millis(30);
/// Counts of ANGLE_ACT that are a visible move: more than noise, and more than a joint's steady-state error.
const VISIBLE: f64 = 25.0;
/// Counts by which a joint may miss its target though its drive reports arrival: some joints end before the range does.
const ARRIVED_TOLERANCE: f64 = 50.0;
/// Longest time that a stop waits for joints to return.
const WAY_BACK_MAX: Duration = Duration::from_secs(1);
/// A joint that moves this many counts away from its target is moved by something else …
const AWAY: f64 = 5.0;
/// … if the command is this old: the dead time, and as much for a late frame.
const TURN_TIMEOUT: Duration = Duration::from_millis(130);
/// Time from a command to the motion (measured: 64 +- 8 ms).
const DEAD_TIME: Duration = Duration::from_millis(64);
/// Maximum commands kept: more than setpoint rounds fit into the time after which feedback is doubted.
const COMMANDS_MAX: usize = 512;

/// Targets and speeds of the joints, in effect from one moment on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TimedCommand {
    at: Moment,
    targets: PerDof<Option<i16>>,
    speeds: PerDof<Option<i16>>,
    /// A gesture moves the joints to unknown positions.
    gesture: bool,
}

/// A target of a joint, the time of its command, and the joint's reading at that time.
#[derive(Debug, Clone, Copy)]
struct Aim {
    target: i16,
    at: Moment,
    from: i16,
}

/// Unchanged readings of one joint that should have shown motion.
#[derive(Debug, Clone, Copy)]
struct Unchanged {
    since: Moment,
    last: Moment,
    readings: u32,
    /// Another value that the hand reports changed meanwhile.
    hand_lives: bool,
}

/// One joint: its last reading and its estimated position.
#[derive(Debug, Clone, Copy)]
struct JointEstimate {
    seen: i16,
    /// The previous reading.
    before: Option<(i16, Moment)>,
    /// Its estimated position at `at`, from its commands since its last live reading.
    estimate: f64,
    at: Moment,
    unchanged: Option<Unchanged>,
    /// It moved, or its drive reported motion, since it was last at rest at its estimated position.
    began: bool,
    /// Its readings are ignored until its angle changes.
    doubted: bool,
    /// Time by which it is back at its last reading, should its angle and its status be old.
    back_at: Moment,
}

/// Watches the feedback of one session.
#[derive(Debug, Default)]
pub(crate) struct FeedbackWatch {
    last: HandSample,
    joints: PerDof<Option<JointEstimate>>,
    /// Oldest first.
    commands: VecDeque<TimedCommand>,
    speeds_written: Option<Moment>,
    /// It is unknown whether this joint follows its command: the newest write to it was not acknowledged, or it was
    /// seen to move elsewhere.
    unsure: PerDof<bool>,
    aims: PerDof<Option<Aim>>,
}

impl FeedbackWatch {
    /// Records a write that was sent, or may have been. A joint that it does not cover keeps its last target.
    pub(crate) fn wrote(&mut self, write: &RegisterWrite, now: Moment) {
        self.forget_unsure(write);
        self.mark(write, true);
        let within = |row: &register::Register| row.span().covers(write.span());
        if within(&register::ANGLE_SET) {
            let targets = write.shorts(&register::ANGLE_SET);
            let targets = targets.map(|target| target.filter(|target| *target >= 0));
            self.aim(&targets, now);
            self.push_command(now, |command| put(&mut command.targets, &targets));
        } else if within(&register::SPEED_SET) {
            self.speeds_written = Some(now);
            let speeds = write.shorts(&register::SPEED_SET);
            self.push_command(now, |command| put(&mut command.speeds, &speeds));
        } else if write.is_motion() {
            // A gesture: the hand may move anywhere.
            self.push_command(now, |command| {
                command.targets = PerDof::splat(None);
                command.gesture = true;
            });
            self.aims = PerDof::default();
        }
    }

    /// Records that the hand acknowledged this write.
    pub(crate) fn acknowledged(&mut self, write: &RegisterWrite) {
        self.mark(write, false);
    }

    fn aim(&mut self, targets: &PerDof<Option<i16>>, at: Moment) {
        for (dof, target) in targets.iter() {
            let is_new = |target: &i16| self.aims[dof].is_none_or(|aim| aim.target != *target);
            if let (Some(target), Some(joint)) = (target.filter(is_new), self.joints[dof]) {
                let from = joint.seen;
                self.aims[dof] = Some(Aim { target, at, from });
            }
        }
    }

    fn mark(&mut self, write: &RegisterWrite, unsure: bool) {
        for (dof, is_written) in written(write).iter() {
            if *is_written {
                self.unsure[dof] = unsure;
            }
        }
    }

    /// Drops the earlier targets of a joint that moved elsewhere: only the new command counts.
    fn forget_unsure(&mut self, write: &RegisterWrite) {
        for (dof, is_written) in written(write).iter() {
            if *is_written && self.unsure[dof] {
                for command in &mut self.commands {
                    command.targets[dof] = None;
                }
                self.aims[dof] = None;
            }
        }
    }

    fn push_command(&mut self, at: Moment, change: impl FnOnce(&mut TimedCommand)) {
        let before = self.commands.back().copied();
        let mut command = TimedCommand {
            at,
            targets: before.map_or(PerDof::splat(None), |command| command.targets),
            speeds: before.map_or(PerDof::splat(None), |command| command.speeds),
            gesture: before.is_some_and(|command| command.gesture),
        };
        change(&mut command);
        let is_same = |before: TimedCommand| command == TimedCommand { at, ..before };
        if before.is_some_and(is_same) {
            return;
        }
        if self.commands.len() == COMMANDS_MAX {
            self.commands.pop_front();
        }
        self.commands.push_back(command);
    }

    /// Applies a reading.
    pub(crate) fn apply(&mut self, sample: &HandSample, fresh: Groups) {
        self.apply_speeds(sample, fresh);
        let before = std::mem::replace(&mut self.last, *sample);
        if has_changed(&before, sample, fresh) {
            let unchanged = self
                .joints
                .iter_mut()
                .filter_map(|(_, joint)| joint.as_mut());
            for unchanged in unchanged.filter_map(|joint| joint.unchanged.as_mut()) {
                unchanged.hand_lives = true;
            }
        }
        if fresh.contains(Group::AngleSet) {
            for dof in Dof::ALL {
                self.unsure[dof] |= self.is_sent_elsewhere(dof, &before, sample);
            }
        }
        let Some(angle) = sample.angle.filter(|_| fresh.contains(Group::Angle)) else {
            return;
        };
        for dof in Dof::ALL {
            self.unsure[dof] |= self.goes_elsewhere(dof, angle.value[dof], angle.asked);
            // An implausible angle does not show the joint's position.
            if angle.value[dof].hold().is_some() {
                self.joints[dof] = Some(self.judged(dof, angle.value[dof], angle.asked));
            }
        }
        self.forget_old(angle.asked);
    }

    /// True if the hand's target changed to one that this program did not write: another controller set it, or the hand
    /// limits its targets.
    fn is_sent_elsewhere(&self, dof: Dof, before: &HandSample, now: &HandSample) -> bool {
        let target = |sample: &HandSample| match sample.angle_set?.value[dof] {
            Some(Target::Go(angle)) => Some(angle.get()),
            _ => None,
        };
        let Some(holds) = target(now).filter(|_| target(before) != target(now)) else {
            return false;
        };
        let within = SetpointRegister::AngleSet.rounds_by().unsigned_abs();
        let is_ours = |command: &TimedCommand| {
            command.targets[dof].is_some_and(|target| target.abs_diff(holds) <= within)
        };
        let last = self
            .commands
            .back()
            .and_then(|command| command.targets[dof]);
        last.is_some() && !self.commands.iter().any(is_ours)
    }

    /// True if a joint moves away from its target, or is farther from it than its own speed allows.
    fn goes_elsewhere(&self, dof: Dof, angle: AngleReading, asked: Moment) -> bool {
        let (Some(joint), Some(aim)) = (self.joints[dof], self.aims[dof]) else {
            return false;
        };
        let way = |from: i16| (f64::from(aim.target) - f64::from(from)).abs();
        let goes_away = way(angle.raw()) > way(joint.seen) + AWAY;
        let speed = self.commands.back().and_then(|command| command.speeds[dof]);
        let speed = f64::from(speed.unwrap_or(Speed::MAX.get())) * Speed::ANGLE_PER_UNIT;
        let farthest = way(aim.from) + VISIBLE + speed * TURN_TIMEOUT.as_secs_f64();
        goes_away && asked.since(aim.at) >= TURN_TIMEOUT || way(angle.raw()) > farthest
    }

    /// The state of a joint after this reading of its angle.
    fn judged(&self, dof: Dof, angle: AngleReading, asked: Moment) -> JointEstimate {
        let seen = angle.raw();
        let status = self.last.status.map(|status| status.value[dof]);
        let is_stopped = status.is_some_and(Status::is_stopped);
        let known = self.joints[dof].filter(|joint| joint.seen == seen);
        let Some(mut joint) = known else {
            return JointEstimate {
                seen,
                before: self.joints[dof].map(|before| (before.seen, before.at)),
                estimate: f64::from(seen),
                at: asked,
                unchanged: None,
                began: !is_stopped && self.joints[dof].is_some(),
                doubted: false,
                back_at: asked,
            };
        };
        joint.before = Some((seen, joint.at));
        let paused = asked.since(joint.at) > PAUSE;
        joint.estimate = self.estimate(dof, &joint, asked);
        joint.at = asked;
        let way = joint.estimate - f64::from(seen);
        let is_unsure = self.unsure[dof] || self.is_led_by_gesture(dof);
        // It is seen at its commanded position.
        joint.doubted &= is_unsure || way.abs() >= VISIBLE;
        joint.unchanged = joint.unchanged.filter(|_| !paused);
        // A doubted joint follows its commands: a missing acknowledgement does not refresh an old angle.
        let goes_by_sight = is_unsure && !joint.doubted || self.is_led_by_gesture(dof);
        if goes_by_sight || self.has_reason(dof, &joint) {
            let back = self.back_from(dof, way);
            joint.back_at = joint.back_at.max(asked.plus(back));
            joint.estimate = f64::from(seen);
            joint.unchanged = None;
            joint.began = false;
            return joint;
        }
        let is_visible = way.abs() >= VISIBLE;
        joint.began |= status.is_some_and(Status::is_moving);
        joint.began &= is_visible || !is_stopped;
        // With the estimate back at its reading, the joint may have been there all the time, unless nothing in the hand
        // changes.
        if !is_visible
            && joint
                .unchanged
                .is_some_and(|unchanged| unchanged.hand_lives)
        {
            joint.unchanged = None;
        }
        if is_visible || joint.unchanged.is_some() {
            let unchanged = joint.unchanged.get_or_insert(Unchanged {
                since: asked,
                last: asked,
                readings: 0,
                hand_lives: false,
            });
            unchanged.last = asked;
            unchanged.readings = unchanged.readings.saturating_add(1);
        }
        joint
    }

    /// True if a gesture moves this joint to an unknown position.
    fn is_led_by_gesture(&self, dof: Dof) -> bool {
        let command = self.commands.back();
        command.is_some_and(|command| command.gesture && command.targets[dof].is_none())
    }

    /// True if the drive itself reports why the joint does not move further as commanded.
    fn has_reason(&self, dof: Dof, joint: &JointEstimate) -> bool {
        let Some(status) = self.last.status.map(|status| status.value[dof]) else {
            return false;
        };
        let target = self
            .commands
            .back()
            .and_then(|command| command.targets[dof]);
        match status {
            Status::ForceReached => joint.estimate < f64::from(joint.seen),
            Status::CurrentProtection | Status::Stalled | Status::DriveFault => true,
            // A doubted joint was commanded to its estimated position: its arrival there does not confirm its reading.
            Status::PositionReached => target.is_some_and(|target| {
                let way = (f64::from(target) - f64::from(joint.seen)).abs();
                !joint.doubted && way <= ARRIVED_TOLERANCE
            }),
            Status::Releasing | Status::Grasping | Status::Unknown(_) => false,
        }
    }

    /// Applies speeds that another controller set, or that this program never wrote.
    fn apply_speeds(&mut self, sample: &HandSample, fresh: Groups) {
        let Some(speeds) = sample.speed_set.filter(|_| fresh.contains(Group::SpeedSet)) else {
            return;
        };
        let ours = self.speeds_written;
        if ours.is_none_or(|at| speeds.asked.since(at) >= Duration::from_secs(1)) {
            let read = speeds.value.map(|speed| speed.map(Speed::get));
            self.push_command(speeds.asked, |command| put(&mut command.speeds, &read));
        }
    }

    /// Drops commands that later ones have replaced in every estimate.
    fn forget_old(&mut self, asked: Moment) {
        let at = self
            .joints
            .iter()
            .filter_map(|(_, joint)| Some(joint.as_ref()?.at))
            .min();
        let at = at.unwrap_or(asked);
        while let Some(second) = self.commands.get(1)
            && second.at.plus(DEAD_TIME) <= at
        {
            self.commands.pop_front();
        }
    }

    fn unchanged(&self) -> impl Iterator<Item = (&JointEstimate, &Unchanged)> {
        let joints = self.joints.iter().filter_map(|(_, joint)| joint.as_ref());
        joints.filter_map(|joint| Some((joint, joint.unchanged.as_ref()?)))
    }

    /// True if a joint was commanded to move, and its angle is unchanged for long enough to count as frozen. A joint
    /// that never began to move and whose drive reports rest may as well be a dead drive, while the rest of the hand is
    /// live: that is no reason to end the motion.
    pub(crate) fn is_frozen(&self) -> bool {
        let is_stopped = |(dof, _): &(Dof, JointEstimate)| {
            let status = self.last.status.map(|status| status.value[*dof]);
            status.is_some_and(Status::is_stopped)
        };
        let joints = self
            .joints
            .iter()
            .filter_map(|(dof, joint)| Some((dof, (*joint)?)));
        let mut frozen = joints.filter(|(_, joint)| joint.unchanged.is_some_and(|it| it.is_long()));
        frozen.any(|own| {
            let hand_lives = own
                .1
                .unchanged
                .is_some_and(|unchanged| unchanged.hand_lives);
            !hand_lives || own.1.began || !is_stopped(&own)
        })
    }

    /// True if a joint should have shown motion and did not: no proof yet, but a stop must not rely on its readings.
    pub(crate) fn is_suspect(&self) -> bool {
        self.unchanged()
            .any(|(_, unchanged)| unchanged.is_suspect())
    }

    /// True if a stop in progress must not rely on the readings either: nothing in the hand changes, or a joint has not
    /// for long.
    pub(crate) fn is_suspect_in_stop(&self) -> bool {
        let is_new = |joint: &JointEstimate| !joint.doubted;
        self.unchanged().any(|(joint, unchanged)| {
            is_new(joint)
                && (unchanged.is_long() || unchanged.is_suspect() && !unchanged.hand_lives)
        })
    }

    /// Ignores the readings of the suspect joints until their angles change.
    pub(crate) fn doubt(&mut self) {
        for joint in self
            .joints
            .iter_mut()
            .filter_map(|(_, joint)| joint.as_mut())
        {
            joint.doubted |= joint
                .unchanged
                .is_some_and(|unchanged| unchanged.is_suspect());
        }
    }

    /// The state that a reconnected link needs for a pending stop: the suspect joints and their commands.
    pub(crate) fn after_loss(mut self) -> Self {
        self.doubt();
        let doubted = self.doubted();
        for command in &mut self.commands {
            keep(&mut command.targets, &doubted);
        }
        keep(&mut self.joints, &doubted);
        keep(&mut self.aims, &doubted);
        for (_, joint) in self.joints.iter_mut() {
            *joint = joint.map(|joint| JointEstimate {
                unchanged: None,
                ..joint
            });
        }
        Self {
            last: HandSample::default(),
            ..self
        }
    }

    /// True if any joint is doubted.
    pub(crate) fn is_doubted(&self) -> bool {
        self.doubted().iter().any(|(_, doubted)| *doubted)
    }

    /// The doubted joints.
    pub(crate) fn doubted(&self) -> PerDof<bool> {
        self.joints
            .map(|joint| joint.is_some_and(|joint| joint.doubted))
    }

    /// Estimated position of a doubted joint at this time; `None` for other joints.
    pub(crate) fn hold_target(&self, dof: Dof, now: Moment) -> Option<Target> {
        let is_doubted = self.joints[dof].is_some_and(|joint| joint.doubted);
        self.expected(dof, now).filter(|_| is_doubted)
    }

    /// Estimated position of a joint at this time; `None` if it was never read, or a gesture may have moved it since.
    pub(crate) fn expected(&self, dof: Dof, now: Moment) -> Option<Target> {
        let joint = self.joints[dof]?;
        let ends = self.commands.iter().skip(1).map(|next| next.at);
        let ends = ends.map(|at| at.plus(DEAD_TIME)).chain([now]);
        let mut since = self
            .commands
            .iter()
            .zip(ends)
            .filter(|(_, end)| *end > joint.at);
        if since.any(|(command, _)| command.gesture && command.targets[dof].is_none()) {
            return None;
        }
        Some(Target::Go(nearest(self.estimate(dof, &joint, now))))
    }

    /// Extrapolated position of a joint that was seen moving, at its measured speed; never beyond its target. `None`
    /// for a joint that is at rest or may be. The hand sampled the reading at the latest when it was received.
    pub(crate) fn gone_on(&self, dof: Dof, now: Moment) -> Option<Target> {
        let (joint, aim) = (self.joints[dof]?, self.aims[dof]?);
        let (from, since) = joint.before?;
        let seen = f64::from(joint.seen);
        let (left, way) = (f64::from(aim.target) - seen, seen - f64::from(from));
        let is_on_its_way = way.abs() >= AWAY && left * way > 0.0;
        if !is_on_its_way || self.unsure[dof] || self.has_reason(dof, &joint) {
            return None;
        }
        let age = now.since(self.last.angle?.received).as_secs_f64();
        let took = joint.at.since(since).max(Duration::from_millis(1));
        let speed = self.commands.back().and_then(|command| command.speeds[dof]);
        let commanded = f64::from(speed.unwrap_or_default()) * Speed::ANGLE_PER_UNIT;
        let gone = (way.abs() / took.as_secs_f64()).min(commanded) * age;
        let gone = gone.min(left.abs()).copysign(left);
        Some(Target::Go(nearest(seen + gone)))
    }

    /// Time that the joints need from their estimated positions to their last readings, dead time included; zero if
    /// that distance is too short to be visible.
    pub(crate) fn way_back(&self, now: Moment) -> Duration {
        let own = self.joints.iter().filter_map(|(dof, joint)| {
            let joint = joint.as_ref()?;
            let way = self.estimate(dof, joint, now) - f64::from(joint.seen);
            Some(self.back_from(dof, way).max(joint.back_at.since(now)))
        });
        own.max().unwrap_or_default()
    }

    /// Time that a joint needs for this distance, in counts; zero if it is too short to be visible.
    fn back_from(&self, dof: Dof, way: f64) -> Duration {
        let speed = self.commands.back().and_then(|command| command.speeds[dof]);
        let counts_per_s = f64::from(speed.unwrap_or_default()) * Speed::ANGLE_PER_UNIT;
        if way.abs() < VISIBLE || counts_per_s <= 0.0 {
            return Duration::ZERO;
        }
        let back = Duration::from_secs_f64(way.abs() / counts_per_s);
        (back + DEAD_TIME).min(WAY_BACK_MAX)
    }

    /// Estimated position of a joint: from its previous estimate towards its commanded targets at the commanded speeds,
    /// and never beyond.
    fn estimate(&self, dof: Dof, joint: &JointEstimate, now: Moment) -> f64 {
        let mut angle = joint.estimate;
        let begins = self
            .commands
            .iter()
            .map(|command| command.at.plus(DEAD_TIME));
        let ends = begins.clone().skip(1).chain([now]);
        for ((command, begin), end) in self.commands.iter().zip(begins).zip(ends) {
            let (Some(target), Some(speed)) = (command.targets[dof], command.speeds[dof]) else {
                continue;
            };
            let lasts = end.min(now).since(begin.max(joint.at)).as_secs_f64();
            let most = f64::from(speed) * Speed::ANGLE_PER_UNIT * lasts;
            angle += (f64::from(target) - angle).clamp(-most, most);
        }
        angle
    }
}

/// The joints whose targets or speeds this write sets.
fn written(write: &RegisterWrite) -> PerDof<bool> {
    let rows = [&register::ANGLE_SET, &register::SPEED_SET];
    let row = rows.into_iter().find(|row| row.span().covers(write.span()));
    row.map_or(PerDof::splat(write.is_motion()), |row| {
        let values = write.shorts(row);
        values.map(|value| value.is_some_and(|value| value >= 0))
    })
}

impl Unchanged {
    fn is_suspect(&self) -> bool {
        self.readings >= SUSPECT_READINGS && self.last.since(self.since) >= SUSPECT_DELAY
    }

    fn is_long(&self) -> bool {
        self.readings >= READINGS_MIN && self.last.since(self.since) >= FREEZE_TIMEOUT
    }
}

fn put(into: &mut PerDof<Option<i16>>, newer: &PerDof<Option<i16>>) {
    for (dof, value) in newer.iter() {
        if value.is_some() {
            into[dof] = *value;
        }
    }
}

fn keep<T>(all: &mut PerDof<Option<T>>, kept: &PerDof<bool>) {
    for (dof, one) in all.iter_mut() {
        if !kept[dof] {
            *one = None;
        }
    }
}

/// True if any measured value differs from the previous one, or is the first.
fn has_changed(before: &HandSample, now: &HandSample, fresh: Groups) -> bool {
    let differs = |group: Group| fresh.contains(group) && before.memory(group) != now.memory(group);
    let measured = [Group::Angle, Group::Force, Group::Current].into_iter();
    let touch = Finger::ALL.map(Group::Tactile);
    measured.chain(touch).any(differs)
}

fn nearest(angle: f64) -> Angle {
    #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
    let counts = angle.round() as i16;
    Angle::nearest(counts)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::{AngleReading, ForceReading, Gesture, GestureRoute, HandCommand, Timed};

    fn ms(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    /// Noise-free feedback of a hand at one time.
    #[derive(Clone, Copy)]
    struct JointFeedback {
        angle: i16,
        force: i16,
        status: u8,
    }

    /// Command to a hand, its feedback, and the time of doubt, in ms from the command.
    struct Case {
        name: &'static str,
        speed: i16,
        target: Target,
        tells: fn(u64) -> JointFeedback,
        frozen: Option<std::ops::Range<u64>>,
    }

    fn at(angle: i16, status: u8) -> JointFeedback {
        JointFeedback {
            angle,
            force: 0,
            status,
        }
    }

    fn sample(feedback: JointFeedback, now: Moment) -> (HandSample, Groups) {
        fn timed<T>(value: T, now: Moment) -> Option<Timed<PerDof<T>>>
        where
            T: Copy,
        {
            Some(Timed {
                value: PerDof::splat(value),
                asked: now,
                received: now,
            })
        }
        let sample = HandSample {
            angle: timed(AngleReading::new(feedback.angle), now),
            force: timed(ForceReading::new(feedback.force), now),
            status: timed(Status::from_raw(feedback.status), now),
            ..HandSample::default()
        };
        let groups = [Group::Angle, Group::Force, Group::Status];
        (sample, groups.into_iter().collect())
    }

    fn watch(speed: i16, target: Target) -> FeedbackWatch {
        let mut watch = FeedbackWatch::default();
        let (first, fresh) = sample(at(1000, 2), ms(0));
        watch.apply(&first, fresh);
        let speeds = HandCommand::Speeds(PerDof::splat(Some(Speed::nearest(speed))));
        let angles = HandCommand::Angles(PerDof::splat(Some(target)));
        for command in [speeds, angles] {
            send(&mut watch, &command, ms(0));
        }
        watch
    }

    /// Writes a command and acknowledges it.
    fn send(watch: &mut FeedbackWatch, command: &HandCommand, at: Moment) {
        let writes = command.writes();
        watch.wrote(&writes[0], at);
        watch.acknowledged(&writes[0]);
    }

    fn go(angle: i16) -> Target {
        Target::Go(Angle::nearest(angle))
    }

    /// Position of a joint at speed 250, `t` in milliseconds.
    fn moving(t: u64) -> i16 {
        let way = i16::try_from(t.saturating_sub(64) * 400 / 1000).unwrap();
        (1000 - way).max(0)
    }

    #[test]
    fn a_write_without_acknowledgement_puts_no_joint_in_doubt() {
        let mut watch = watch(250, go(1000));
        let close = HandCommand::Angles(PerDof::splat(Some(go(0))));
        watch.wrote(&close.writes()[0], ms(0));
        for t in (20..900).step_by(20) {
            let (unmoved, fresh) = sample(at(1000, 2), ms(t));
            watch.apply(&unmoved, fresh);
            assert!(!watch.is_suspect() && !watch.is_frozen(), "{t}");
        }
        send(&mut watch, &close, ms(900));
        for t in (900..1700).step_by(20) {
            let (unmoved, fresh) = sample(at(1000, 2), ms(t));
            watch.apply(&unmoved, fresh);
        }
        assert!(watch.is_frozen());
    }

    #[test]
    fn a_joint_that_another_program_moved_is_not_in_doubt_where_it_rests() {
        let mut watch = watch(250, go(1000));
        for t in (20..2000).step_by(20) {
            let (moved, fresh) = sample(at((1000 - i16::try_from(t).unwrap()).max(600), 2), ms(t));
            watch.apply(&moved, fresh);
            assert!(!watch.is_suspect(), "{t}");
        }
    }

    #[test]
    fn where_a_gesture_moves_a_joint_is_not_known_until_it_is_read() {
        let mut watch = watch(250, go(0));
        let gesture = HandCommand::Gesture(Gesture::MIN, GestureRoute::Register1008);
        send(&mut watch, &gesture, ms(300));
        assert_eq!(watch.expected(Dof::Index, ms(400)), None);
        let (read, fresh) = sample(at(700, 1), ms(500));
        watch.apply(&read, fresh);
        assert_eq!(watch.expected(Dof::Index, ms(600)), None, "it goes on");
        let hold = HandCommand::Angles(PerDof::splat(Some(go(700))));
        send(&mut watch, &hold, ms(600));
        let (read, fresh) = sample(at(690, 1), ms(700));
        watch.apply(&read, fresh);
        assert!(watch.expected(Dof::Index, ms(750)).is_some());
    }

    #[test]
    fn the_way_back_takes_as_long_as_the_way_that_was_not_seen() {
        let mut watch = watch(250, go(0));
        assert_eq!(watch.way_back(ms(100)), Duration::ZERO, "14 counts");
        // 120 counts in 300 ms, and the dead time.
        assert_eq!(watch.way_back(ms(364)).as_millis(), 364);
        assert_eq!(watch.way_back(ms(3000)), WAY_BACK_MAX);
        // It is sent back to its reading: it counts as at rest there only once it had the time to return, whatever its
        // drive reports.
        let back = HandCommand::Angles(PerDof::splat(Some(go(1000))));
        send(&mut watch, &back, ms(300));
        let (frozen, fresh) = sample(at(1000, 2), ms(400));
        watch.apply(&frozen, fresh);
        let left = watch.way_back(ms(400)).as_millis();
        assert!((300..400).contains(&left), "{left}");
    }

    #[test]
    fn only_feedback_that_stands_still_where_motion_was_asked_for_is_in_doubt() {
        let cases = [
            Case {
                name: "moves",
                speed: 250,
                target: go(0),
                tells: |t| at(moving(t), 1),
                frozen: None,
            },
            Case {
                name: "freezes before it moves",
                speed: 250,
                target: go(0),
                tells: |_| at(1000, 2),
                frozen: Some(500..650),
            },
            Case {
                name: "freezes in motion",
                speed: 250,
                target: go(0),
                tells: |t| at(moving(t.min(300)), 1),
                frozen: Some(740..860),
            },
            Case {
                name: "rests: it is where it was told to be",
                speed: 1000,
                target: go(1000),
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "a few counts beside its target",
                speed: 1000,
                target: go(980),
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "left alone",
                speed: 1000,
                target: Target::Leave,
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "does not move at speed 0",
                speed: 0,
                target: go(0),
                tells: |_| at(1000, 2),
                frozen: None,
            },
            Case {
                name: "creeps at speed 1, one count in 0.6 s",
                speed: 1,
                target: go(0),
                tells: |t| at(1000 - i16::try_from(t / 600).unwrap(), 1),
                frozen: None,
            },
            Case {
                name: "stands at speed 10: asked for longer than at full speed",
                speed: 10,
                target: go(0),
                tells: |_| at(1000, 2),
                frozen: Some(2000..2400),
            },
            Case {
                name: "stopped by its force threshold",
                speed: 250,
                target: go(0),
                tells: |t| at(moving(t.min(500)), if t < 500 { 1 } else { 3 }),
                frozen: None,
            },
            Case {
                name: "pushes without a word of its drive: only its force changes",
                speed: 250,
                target: go(0),
                tells: |t| JointFeedback {
                    force: i16::try_from(t / 100 % 3).unwrap(),
                    ..at(1000, 1)
                },
                frozen: Some(500..650),
            },
        ];
        for case in cases {
            let mut watch = watch(case.speed, case.target);
            let seen = (10..5000).step_by(10).find(|t| {
                let (sample, fresh) = sample((case.tells)(*t), ms(*t));
                watch.apply(&sample, fresh);
                watch.is_frozen()
            });
            let is_right = match (&case.frozen, seen) {
                (Some(range), Some(at)) => range.contains(&at),
                (None, None) => true,
                _ => false,
            };
            assert!(is_right, "{}: {seen:?}", case.name);
        }
    }

    #[test]
    fn a_frozen_angle_stays_in_doubt_where_the_drive_arrived_at_the_hold() {
        let mut watch = watch(250, go(0));
        let read = |watch: &mut FeedbackWatch, t: std::ops::Range<u64>, status| {
            for t in t.step_by(10) {
                let (sample, fresh) = sample(at(moving(t.min(300)), status), ms(t));
                watch.apply(&sample, fresh);
            }
        };
        read(&mut watch, 10..420, 1);
        watch.doubt();
        let held = watch.hold_target(Dof::Index, ms(420)).unwrap();
        let way = moving(300) - held.angle().unwrap().get();
        assert!((30..=50).contains(&way), "{way}");
        send(
            &mut watch,
            &HandCommand::Angles(PerDof::splat(Some(held))),
            ms(420),
        );
        read(&mut watch, 430..1200, 2);
        assert_eq!(watch.hold_target(Dof::Index, ms(1200)), Some(held));
    }

    #[test]
    fn a_frozen_angle_stays_in_doubt_where_a_hold_is_not_acknowledged() {
        let mut watch = watch(250, go(0));
        let read = |watch: &mut FeedbackWatch, t: std::ops::Range<u64>| {
            for t in t.step_by(10) {
                let (sample, fresh) = sample(at(moving(t.min(300)), 1), ms(t));
                watch.apply(&sample, fresh);
            }
        };
        read(&mut watch, 10..600);
        watch.doubt();
        let held = watch.hold_target(Dof::Index, ms(600)).unwrap();
        let hold = HandCommand::Angles(PerDof::splat(Some(held)));
        watch.wrote(&hold.writes()[0], ms(600));
        read(&mut watch, 610..700);
        send(&mut watch, &hold, ms(700));
        read(&mut watch, 710..1500);
        let kept = watch.hold_target(Dof::Index, ms(1500)).unwrap();
        let [held, kept] = [held, kept].map(|target| target.angle().unwrap().get());
        assert!(held.abs_diff(kept) <= 40, "{held} {kept}");
        assert!(
            kept < moving(300) - 80,
            "{kept}: not back where it was seen"
        );
    }

    #[test]
    fn a_pause_in_reading_is_no_frozen_feedback() {
        let mut watch = watch(250, go(0));
        for t in [100, 900, 1700] {
            let (sample, fresh) = sample(at(1000, 2), ms(t));
            watch.apply(&sample, fresh);
            assert!(!watch.is_frozen());
        }
    }

    #[test]
    fn the_joints_are_reckoned_from_where_they_were_seen_to_what_they_were_told_and_not_beyond() {
        let mut watch = watch(500, go(200));
        let held = |watch: &FeedbackWatch, t| {
            let joint = watch.joints[Dof::Index].unwrap();
            go(nearest(watch.estimate(Dof::Index, &joint, ms(t))).get())
        };
        assert_eq!(held(&watch, 64), go(1000));
        // 760 counts per second after the dead time.
        assert_eq!(held(&watch, 564), go(620));
        assert_eq!(held(&watch, 3000), go(200));
        let (seen, fresh) = sample(at(900, 1), ms(200));
        watch.apply(&seen, fresh);
        assert_eq!(held(&watch, 300), go(824));
        // The hold takes effect late too.
        let hold = HandCommand::Angles(PerDof::splat(Some(go(824))));
        send(&mut watch, &hold, ms(300));
        assert_eq!(held(&watch, 364), go(775));
        assert_eq!(held(&watch, 1000), go(824));
        assert_eq!(
            watch.hold_target(Dof::Index, ms(1000)),
            None,
            "it is not in doubt"
        );
    }
}
