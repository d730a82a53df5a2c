//! A sequence of poses on a hand that the user armed: each pose with its speed and force, then its dwell. Whoever else moves
//! the hand ends it.

use crate::hand::gap::Gap;
use crate::hand::grip::GripEstimator;
use crate::hand::{Angle, AngleReading, ArmEpoch, Dof, HandSample, PerDof, Setpoints, Target};
use crate::link::{Clock, Lease, LinkStatus};
use crate::poses::player::{PlayEnd, PlayMode, PlayPhase, PlayPlan, PlayView, Player, ReactionCue};
use crate::poses::reaction::TouchWatch;
use crate::poses::way::Targets;
use crate::record::{Disarmed, LinkState, Record};
use crate::tasks::hand::TaskHand;
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::time::timeout;

/// How often time is looked at where nothing is read.
const TICK: Duration = Duration::from_millis(10);

/// What a sequence begins with.
#[derive(Debug, Clone)]
pub struct PlayStart {
    /// Sequence to play.
    pub plan: PlayPlan,
    /// Plays to the end, or stops after each step.
    pub pace: PlayMode,
    /// The arming that the user gave for it.
    pub epoch: ArmEpoch,
    /// The right to move the hand.
    pub lease: Lease,
    /// Joints that are left alone.
    pub locked: PerDof<bool>,
    /// What was read until now.
    pub seen: HandSample,
    /// What is gripped, from that.
    pub grip: GripEstimator,
    /// The program's clock.
    pub clock: Clock,
}

/// What the user may want while it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlayCommand {
    /// Hold where the hand is, until resumed.
    Pause,
    /// Goes on after a pause.
    Resume(PlayMode),
    /// End it and hold where the hand is.
    End,
    /// Leave these joints alone.
    Lock(PerDof<bool>),
}

/// What is told on the way.
#[derive(Debug, Clone, PartialEq)]
pub enum PlayStep {
    /// The position in the sequence changed.
    View(PlayView),
    /// The hand was told this; joints that are `None` were left alone.
    Sent(Setpoints),
}

/// Plays. Ends with the reason.
pub async fn play<H: TaskHand>(
    hand: &H,
    start: PlayStart,
    mut commands: mpsc::Receiver<PlayCommand>,
    mut tell: impl FnMut(PlayStep),
) -> PlayEnd {
    let clock = start.clock;
    let mut records = hand.records();
    let plan = start.plan;
    let rest = plan.cues.first().map(|cue| cue.targets);
    let mut run = Playing {
        lease: start.lease,
        hand,
        reaction: plan.reaction.zip(rest).map(|(cue, rest)| Reacting {
            watch: TouchWatch::new(cue.threshold),
            cue,
            rest,
        }),
        player: Player::start(plan.cues, plan.looped, start.pace, clock.now()),
        epoch: start.epoch,
        locked: start.locked,
        sample: start.seen,
        grip: start.grip,
        clock,
    };
    let mut shown = None;
    loop {
        run.tick(&mut tell);
        let view = run.player.view();
        if shown.replace(view) != Some(view) {
            tell(PlayStep::View(view));
        }
        if let PlayPhase::Ended(end) = view.phase {
            return end;
        }
        tokio::select! {
            biased;
            command = commands.recv() => match command {
                Some(command) => run.obey(command, &mut tell),
                None => run.player.end(PlayEnd::TakenOver),
            },
            record = timeout(TICK, records.next()) => {
                if let Ok(Some(Record::Reading { sample, fresh })) = record {
                    run.sample = *sample;
                    run.grip.take(&sample, fresh, sample.newest(fresh).unwrap_or_default());
                }
            }
        }
    }
}

/// Fingers that answer a touch.
struct Reacting {
    watch: TouchWatch,
    cue: ReactionCue,
    rest: Targets,
}

struct Playing<'a, H> {
    hand: &'a H,
    lease: Lease,
    player: Player,
    reaction: Option<Reacting>,
    epoch: ArmEpoch,
    locked: PerDof<bool>,
    sample: HandSample,
    grip: GripEstimator,
    clock: Clock,
}

impl<H: TaskHand> Playing<'_, H> {
    fn obey(&mut self, command: PlayCommand, tell: &mut impl FnMut(PlayStep)) {
        match command {
            PlayCommand::Pause => {
                if self.player.pause() {
                    self.hold_here(tell);
                }
            }
            PlayCommand::Resume(pace) => self.player.resume(pace, self.clock.now()),
            PlayCommand::End => {
                self.player.end(PlayEnd::Person);
                self.hold_here(tell);
            }
            PlayCommand::Lock(locked) => self.locked = locked,
        }
    }

    fn tick(&mut self, tell: &mut impl FnMut(PlayStep)) {
        if self.player.is_over() {
            return;
        }
        let status = self.hand.status();
        if let Some(why) = reason(&status, self.epoch) {
            self.player.end(why);
            return;
        }
        let Some(angles) = self.angles() else { return };
        // A locked joint never arrives and is not waited for: it counts as where it should be.
        let targets = self.player.targets();
        let seen = PerDof::from_fn(|dof| {
            let target = targets[dof].filter(|_| self.locked[dof]).map(Angle::get);
            Some(target.unwrap_or_else(|| angles[dof].raw()))
        });
        let now = self.clock.now();
        let grip = self.grip.known(status.is_believed(), now);
        let part = self.player.tick(now, &seen, &grip.grasp);
        if self.lacks_a_joint() {
            self.player.end(PlayEnd::Locked);
            self.hold_here(tell);
            return;
        }
        if let Some((part, cue)) = part.zip(self.player.cue()) {
            self.grip.judge_by(cue.thresholds.unwrap_or_default());
            let force = cue.force;
            let mut setpoints = Setpoints::none(self.epoch);
            for (dof, to) in self.free(&part.targets) {
                setpoints.speed[dof] = Some(part.speeds[dof]);
                setpoints.force[dof] = Some(force);
                setpoints.angle[dof] = Some(Target::Go(to));
            }
            self.send(setpoints, tell);
        }
        if matches!(self.player.view().phase, PlayPhase::Dwelling { .. }) {
            self.react(tell);
        }
    }

    /// A grip by size is asked for, and a joint that pinches is locked.
    fn lacks_a_joint(&self) -> bool {
        let is_grip = self.player.cue().is_some_and(|cue| cue.gap.is_some());
        let lacks = Gap::JOINTS.into_iter().any(|dof| self.locked[dof]);
        is_grip && lacks && !self.player.is_over()
    }

    /// Sends the fingers whose tip was touched or let go.
    fn react(&mut self, tell: &mut impl FnMut(PlayStep)) {
        let (now, fresh_for) = (self.clock.now(), self.hand.status().fresh_for());
        let Some(reacting) = &mut self.reaction else {
            return;
        };
        let mut setpoints = Setpoints::none(self.epoch);
        for (finger, tip) in self.sample.tactile.iter() {
            let fresh = tip.filter(|tip| tip.age(now) <= fresh_for);
            let Some(newtons) = fresh.and_then(|tip| tip.value.normal()) else {
                continue;
            };
            let dof = finger.bend();
            let targets = match reacting.watch.take(finger, newtons, now) {
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
        self.send(setpoints, tell);
    }

    /// Angles that are fresh enough to go by.
    fn angles(&self) -> Option<PerDof<AngleReading>> {
        let (now, fresh_for) = (self.clock.now(), self.hand.status().fresh_for());
        let angle = self
            .sample
            .angle
            .filter(|angle| angle.age(now) <= fresh_for)?;
        Some(angle.value)
    }

    fn free(&self, targets: &Targets) -> Vec<(Dof, Angle)> {
        let free = targets.iter().filter(|(dof, _)| !self.locked[*dof]);
        free.filter_map(|(dof, to)| Some((dof, (*to)?))).collect()
    }

    /// The targets of the free joints become where they are. Nothing is sent that is not fresh.
    fn hold_here(&self, tell: &mut impl FnMut(PlayStep)) {
        let Some(pose) = self
            .angles()
            .and_then(|all| all.map(AngleReading::hold).all())
        else {
            return;
        };
        let mut setpoints = Setpoints::none(self.epoch);
        for (dof, at) in self.free(&pose.map(Some)) {
            setpoints.angle[dof] = Some(Target::Go(at));
        }
        if self.hand.set(self.lease, &setpoints).is_ok() {
            tell(PlayStep::Sent(setpoints));
        }
    }

    fn send(&mut self, setpoints: Setpoints, tell: &mut impl FnMut(PlayStep)) {
        if setpoints.is_empty() {
            return;
        }
        if self.hand.set(self.lease, &setpoints).is_ok() {
            tell(PlayStep::Sent(setpoints));
        } else {
            self.player.end(PlayEnd::TakenOver);
        }
    }
}

/// Why what moves the hand in this arming must end now, if it must.
pub(crate) fn reason(status: &LinkStatus, epoch: ArmEpoch) -> Option<PlayEnd> {
    let is_armed = status.armed == Some(epoch);
    // While it is stopped for a fault its state says so of the stop alone.
    let by_fault = !is_armed && status.disarmed == Some(Disarmed::Fault);
    if !status.state.is_live() {
        Some(PlayEnd::LinkLost)
    } else if status.state == LinkState::Fault || by_fault {
        Some(PlayEnd::Fault)
    } else if !is_armed {
        Some(PlayEnd::Disarmed)
    } else {
        None
    }
}
