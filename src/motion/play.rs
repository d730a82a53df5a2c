//! A sequence of poses on a hand that the user armed: each pose with its speed and force, then its dwell. The sequence ends when
//! another party moves the hand.

use crate::hand::gap::{Gap, SizeBlocks};
use crate::hand::grip::{GripEstimator, Tightened};
use crate::hand::overshoot::OvershootMap;
use crate::hand::{
    Angle, ArmEpoch, Dof, Force, Groups, HandSample, Moment, PerDof, Setpoints, Target,
};
use crate::link::{ArmRequest, LinkHandle, PollRates};
use crate::motion::drive::{Armed, drive};
use crate::motion::hold::{self, HoldClose, HoldEnd, HoldStart, HoldView};
use crate::motion::hosted_hold::{HostedHold, stay};
use crate::motion::program::{AfterAbort, Ended, Order, Program, Progress, Seen};
use crate::poses::player::{PlayEnd, PlayMode, PlayPhase, PlayPlan, PlayView, Player, ReactionCue};
use crate::poses::reaction::TouchWatch;
use crate::poses::way::Targets;
use crate::record::Abort;
use futures::Stream;
use std::time::Duration;

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
    /// Overshoot measured on this hand.
    pub overshoot: OvershootMap,
    /// Blocks measured with this hand, for the size of what a hold holds.
    pub blocks: SizeBlocks,
    /// Highest force threshold of a hold.
    pub force_limit: Force,
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

/// Progress of a sequence, and of the hold of its step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlayingView {
    /// The step.
    pub play: PlayView,
    /// The hold; `None` while there is none.
    pub hold: Option<HoldView>,
}

/// Progress of a sequence; its events are the fingers that pressed harder in a hold.
pub type PlayProgress = Progress<PlayingView, Tightened>;

/// Plays a sequence to its end.
pub async fn play(
    hand: &LinkHandle,
    armed: Armed,
    start: PlayStart,
    commands: impl Stream<Item = PlayCommand>,
    mut report: impl FnMut(PlayProgress),
) -> Ended<PlayEnd> {
    let program = Playing::new(armed.epoch, start, armed.clock.now());
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
    overshoot: OvershootMap,
    blocks: SizeBlocks,
    force_limit: Force,
    /// The hold of the current step, and when the step began.
    hold: Option<(Moment, HostedHold)>,
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
            overshoot: start.overshoot,
            blocks: start.blocks,
            force_limit: start.force_limit,
            hold: None,
        }
    }

    /// The sequence and its current step.
    pub(crate) const fn player(&self) -> &Player {
        &self.player
    }

    /// Arming under which it moves the hand.
    pub(crate) const fn epoch(&self) -> ArmEpoch {
        self.epoch
    }
}

impl Program for Playing {
    type Input = PlayCommand;
    type Outcome = PlayEnd;
    type View = PlayingView;
    type Event = Tightened;
    const AFTER_ABORT: AfterAbort = AfterAbort::Nothing;

    fn rates(&self) -> Option<PollRates> {
        self.hold.as_ref().map(|_| hold::RATES)
    }

    fn input(&mut self, command: PlayCommand, seen: &Seen<'_>) -> Option<Order> {
        match command {
            PlayCommand::Pause if self.player.pause() => return self.rest_here(seen),
            PlayCommand::Pause => {}
            PlayCommand::Resume(pace) => self.player.resume(pace, seen.now),
            PlayCommand::End => {
                self.player.end(Ok(PlayEnd::Person));
                return self.rest_here(seen);
            }
            PlayCommand::Lock(locked) => self.locked = locked,
        }
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        let read = sample.newest(fresh).unwrap_or_default();
        self.grip.apply(sample, fresh, read);
        if let Some((_, hold)) = &mut self.hold {
            hold.read(sample, fresh, now);
        }
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        if let PlayPhase::Holding { since } = self.player.view().phase
            && !self.lacks_a_joint()
        {
            return self.hold_on(since, seen);
        }
        self.hold = None;
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

    fn view(&self, now: Moment) -> PlayingView {
        PlayingView {
            play: self.player.view(),
            hold: self.hold.as_ref().map(|(_, hold)| hold.view(now)),
        }
    }

    fn event(&mut self) -> Option<Tightened> {
        self.hold.as_mut()?.1.event()
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

    /// Advances the hold of the step. If nothing is held, the sequence ends.
    fn hold_on(&mut self, since: Moment, seen: &Seen<'_>) -> Option<Order> {
        if self.hold.as_ref().is_none_or(|(begun, _)| *begun != since) {
            self.hold = Some((since, self.new_hold(seen.now)?));
        }
        let (_, hold) = self.hold.as_mut()?;
        let sent = hold.tick(seen, &self.locked);
        match hold.end() {
            None => {}
            Some(HoldEnd::Held) => self.player.held(seen.now),
            Some(HoldEnd::Nothing | HoldEnd::Lost | HoldEnd::Late) => {
                let grip = self.grip.known(seen.status.is_believed(), seen.now);
                self.player.end(Ok(PlayEnd::NotHolding(grip.grasp.state)));
            }
        }
        sent.map(Order::Set)
    }

    /// The hold of the current step.
    fn new_hold(&mut self, now: Moment) -> Option<HostedHold> {
        let cue = self.player.cue()?;
        self.grip.judge_by(cue.thresholds.unwrap_or_default());
        let moves = cue.targets.iter().any(|(_, to)| to.is_some());
        let start = HoldStart {
            close: match cue.gap {
                Some(gap) => HoldClose::Pinch(gap),
                None if moves => HoldClose::To(cue.targets),
                None => HoldClose::TakeOver,
            },
            forces: cue.hold?,
            duration: Some(cue.dwell).filter(|dwell| *dwell < Duration::MAX),
            reading_per_g: PerDof::splat(1.0),
            locked: self.locked,
            overshoot: self.overshoot.clone(),
            blocks: self.blocks.clone(),
            grip: self.grip.clone(),
        };
        let limits = ArmRequest {
            speed: PerDof::splat(cue.speed),
            force: PerDof::splat(self.force_limit),
        };
        Some(HostedHold::new(self.epoch, start, limits, now))
    }

    /// As [`Self::hold_here`]; a hand that holds an object keeps its targets, and so the object.
    fn rest_here(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let hold = self.hold.take();
        let is_holding = hold.is_some_and(|(_, hold)| hold.is_holding(seen.now));
        if is_holding {
            None
        } else {
            self.hold_here(seen)
        }
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
        let mut setpoints = stay(self.epoch, seen)?;
        for (dof, to) in setpoints.angle.iter_mut() {
            *to = to.filter(|_| !self.locked[dof]);
        }
        Some(Order::Set(setpoints))
    }
}
