//! A sequence of poses on a hand that the user armed: each pose with its speed and force, then its dwell. The sequence ends when
//! another party moves the hand.

use crate::hand::gap::Gap;
use crate::hand::grip::GripEstimator;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, Groups, HandSample, Moment, PerDof, Setpoints, Target,
};
use crate::link::LinkHandle;
use crate::motion::drive::{Armed, drive};
use crate::motion::program::{AfterAbort, Ended, Order, Program, Progress, Seen};
use crate::poses::player::{PlayEnd, PlayMode, PlayPhase, PlayPlan, PlayView, Player, ReactionCue};
use crate::poses::reaction::TouchWatch;
use crate::poses::way::Targets;
use crate::record::Abort;
use futures::stream::poll_fn;
use std::convert::Infallible;
use tokio::sync::mpsc;

/// Settings with which a sequence starts.
#[derive(Debug, Clone)]
pub struct PlayStart {
    /// Sequence to play.
    pub plan: PlayPlan,
    /// Plays to the end, or stops after each step.
    pub pace: PlayMode,
    /// Locked joints, which receive no targets.
    pub locked: PerDof<bool>,
    /// Grip estimate from the readings so far.
    pub grip: GripEstimator,
}

/// User input while a sequence runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlayCommand {
    /// Hold the current position until resumed.
    Pause,
    /// Continue after a pause.
    Resume(PlayMode),
    /// End the sequence and hold the current position.
    End,
    /// Lock these joints: they receive no further targets.
    Lock(PerDof<bool>),
}

/// Progress of a sequence.
pub type PlayProgress = Progress<PlayView, Infallible>;

/// Plays a sequence to its end.
pub async fn play(
    hand: &LinkHandle,
    armed: Armed,
    start: PlayStart,
    mut commands: mpsc::Receiver<PlayCommand>,
    mut report: impl FnMut(PlayProgress),
) -> Ended<PlayEnd> {
    let program = Playing::new(armed.epoch, start, armed.clock.now());
    let commands = poll_fn(move |context| commands.poll_recv(context));
    let driven = drive(hand, armed, program, commands, |progress| {
        report(progress);
        true
    });
    driven.await.end
}

/// Fingers that react to a touch.
#[derive(Debug)]
struct Reacting {
    watch: TouchWatch,
    cue: ReactionCue,
    rest: Targets,
}

/// A sequence that moves the hand.
#[derive(Debug)]
pub(crate) struct Playing {
    player: Player,
    reaction: Option<Reacting>,
    epoch: ArmEpoch,
    locked: PerDof<bool>,
    grip: GripEstimator,
}

impl Playing {
    pub(crate) fn new(epoch: ArmEpoch, start: PlayStart, now: Moment) -> Self {
        let plan = start.plan;
        let rest = plan.cues.first().map(|cue| cue.targets);
        Self {
            reaction: plan.reaction.zip(rest).map(|(cue, rest)| Reacting {
                watch: TouchWatch::new(cue.threshold),
                cue,
                rest,
            }),
            player: Player::start(plan.cues, plan.looped, start.pace, now),
            epoch,
            locked: start.locked,
            grip: start.grip,
        }
    }

    /// Arming under which it moves the hand.
    pub(crate) const fn epoch(&self) -> ArmEpoch {
        self.epoch
    }
}

impl Program for Playing {
    type Input = PlayCommand;
    type Outcome = PlayEnd;
    type View = PlayView;
    type Event = Infallible;
    const AFTER_ABORT: AfterAbort = AfterAbort::Nothing;

    fn input(&mut self, command: PlayCommand, seen: &Seen<'_>) -> Option<Order> {
        match command {
            PlayCommand::Pause if self.player.pause() => return self.hold_here(seen),
            PlayCommand::Pause => {}
            PlayCommand::Resume(pace) => self.player.resume(pace, seen.now),
            PlayCommand::End => {
                self.player.end(Ok(PlayEnd::Person));
                return self.hold_here(seen);
            }
            PlayCommand::Lock(locked) => self.locked = locked,
        }
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, _now: Moment) {
        let read = sample.newest(fresh).unwrap_or_default();
        self.grip.apply(sample, fresh, read);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let angles = seen.angles()?.value;
        // A locked joint never arrives and is not waited for: it counts as being at its target.
        let targets = self.player.targets();
        let at = PerDof::from_fn(|dof| {
            let target = targets[dof].filter(|_| self.locked[dof]).map(Angle::get);
            Some(target.unwrap_or_else(|| angles[dof].raw()))
        });
        let grip = self.grip.known(seen.status.is_believed(), seen.now);
        let part = self.player.tick(seen.now, &at, &grip.grasp);
        if self.lacks_a_joint() {
            self.player.end(Ok(PlayEnd::Locked));
            return self.hold_here(seen);
        }
        let mut setpoints = Setpoints::none(self.epoch);
        if let Some((part, cue)) = part.zip(self.player.cue()) {
            self.grip.judge_by(cue.thresholds.unwrap_or_default());
            let force = cue.force;
            for (dof, to) in self.free(&part.targets) {
                setpoints.speed[dof] = Some(part.speeds[dof]);
                setpoints.force[dof] = Some(force);
                setpoints.angle[dof] = Some(Target::Go(to));
            }
        }
        if matches!(self.player.view().phase, PlayPhase::Dwelling { .. }) {
            self.react(seen, &mut setpoints);
        }
        Some(Order::Set(setpoints))
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.player.end(Err(why));
    }

    fn view(&self, _now: Moment) -> PlayView {
        self.player.view()
    }

    fn ended(&self) -> Option<Ended<PlayEnd>> {
        match self.player.view().phase {
            PlayPhase::Ended(end) => Some(end),
            _ => None,
        }
    }
}

impl Playing {
    /// True if the current step is a grip by size and one of its joints is locked.
    fn lacks_a_joint(&self) -> bool {
        let is_grip = self.player.cue().is_some_and(|cue| cue.gap.is_some());
        let lacks = Gap::JOINTS.into_iter().any(|dof| self.locked[dof]);
        is_grip && lacks && !self.player.is_over()
    }

    /// Adds setpoints for fingers whose tip was touched or released.
    fn react(&mut self, seen: &Seen<'_>, setpoints: &mut Setpoints) {
        let fresh_for = seen.status.fresh_for();
        let Some(reacting) = &mut self.reaction else {
            return;
        };
        for (finger, tip) in seen.sample.tactile.iter() {
            let fresh = tip.filter(|tip| tip.age(seen.now) <= fresh_for);
            let Some(newtons) = fresh.and_then(|tip| tip.value.normal()) else {
                continue;
            };
            let dof = finger.bend();
            let targets = match reacting.watch.apply(finger, newtons, seen.now) {
                Some(true) => &reacting.cue.touched.targets,
                Some(false) => &reacting.rest,
                None => continue,
            };
            if let Some(to) = targets[dof].filter(|_| !self.locked[dof]) {
                setpoints.angle[dof] = Some(Target::Go(to));
                setpoints.speed[dof] = Some(reacting.cue.touched.speed);
                setpoints.force[dof] = Some(reacting.cue.touched.force);
            }
        }
    }

    fn free(&self, targets: &Targets) -> Vec<(Dof, Angle)> {
        let free = targets.iter().filter(|(dof, _)| !self.locked[*dof]);
        free.filter_map(|(dof, to)| Some((dof, (*to)?))).collect()
    }

    /// Sets the targets of the free joints to their measured angles, if those are fresh.
    fn hold_here(&self, seen: &Seen<'_>) -> Option<Order> {
        let pose = seen.angles()?.value.map(AngleReading::hold).all()?;
        let mut setpoints = Setpoints::none(self.epoch);
        for (dof, at) in self.free(&pose.map(Some)) {
            setpoints.angle[dof] = Some(Target::Go(at));
        }
        Some(Order::Set(setpoints))
    }
}
