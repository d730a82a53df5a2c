//! One motion of a hand that the user armed: to targets, on a way on which thumb and index do not meet, until it is there or
//! something stops it.

use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::{Angle, ArmEpoch, Groups, HandSample, Moment, Setpoints, Speed, Target};
use crate::link::{ArmRequest, LinkHandle};
use crate::motion::drive::{Armed, drive};
use crate::motion::program::{AfterAbort, Ended, Order, Program, Seen};
use crate::poses::way::{Targets, way};
use crate::record::{Abort, Rest};
use futures::stream::pending;
use std::collections::VecDeque;
use std::time::Duration;

/// A part of the way is not judged at rest before this: the hand acts late.
const START_DELAY: Duration = Duration::from_millis(500);
/// A part of the way may take so much longer than its speed says.
const SPARE: Duration = Duration::from_secs(4);

/// What a motion begins with.
#[derive(Debug, Clone)]
pub struct MoveStart {
    /// Where the joints go; `None` leaves one alone.
    pub targets: Targets,
    /// Speeds and force thresholds of the joints that go.
    pub limits: ArmRequest,
    /// Whether it is over only once the hand rests, so that it is known what it grips.
    pub settles: bool,
    /// What is gripped, from what was read until now.
    pub grip: GripEstimator,
}

/// How a motion ended that nothing aborted. No more is sent: the hand stays armed and keeps its targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveEnd {
    /// Every joint is at its target.
    Reached,
    /// The hand rests, and a joint is not at its target: something, or its force threshold, stopped it.
    Stopped,
    /// It took too long.
    Late,
}

/// The result of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveReport {
    /// How it ended.
    pub end: Ended<MoveEnd>,
    /// What the hand gripped then.
    pub grip: Grip,
}

/// Moves, until the joints are there or the hand rests elsewhere.
pub async fn move_to(hand: &LinkHandle, armed: Armed, start: MoveStart) -> MoveReport {
    let program = Moving {
        epoch: armed.epoch,
        legs: None,
        sent: armed.clock.now(),
        start,
        end: None,
    };
    let driven = drive(hand, armed, program, pending(), |_, _| true).await;
    let estimator = &driven.program.start.grip;
    MoveReport {
        end: driven.end,
        grip: estimator.known(hand.status().is_believed(), armed.clock.now()),
    }
}

struct Moving {
    start: MoveStart,
    epoch: ArmEpoch,
    /// What is left of the way, the first of it sent; `None` until it is known where the hand is.
    legs: Option<VecDeque<Targets>>,
    /// When the part under way was sent.
    sent: Moment,
    end: Option<Ended<MoveEnd>>,
}

impl Program for Moving {
    type Input = Abort;
    type Outcome = MoveEnd;
    const AFTER_ABORT: AfterAbort = AfterAbort::StopAfterLinkLoss;

    fn input(&mut self, why: Abort, seen: &Seen<'_>) -> Option<Order> {
        self.abort(why, seen.now);
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, _now: Moment) {
        let read = sample.newest(fresh).unwrap_or_default();
        self.start.grip.apply(sample, fresh, read);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let since = seen.now.since(self.sent);
        let Some(angle) = seen.angles() else {
            self.end_if(since > SPARE, MoveEnd::Late);
            return None;
        };
        let angles = angle.value.map(|at| at.hold().map(Angle::get));
        let Some(leg) = self.legs.as_ref().and_then(|legs| legs.front()).copied() else {
            self.legs = Some(way(&angles, &self.start.targets).into());
            return self.send(seen.now);
        };
        let arrived = leg.iter().all(|(dof, to)| {
            let is_there = |to: Angle, at: i16| at.abs_diff(to.get()) <= Angle::ARRIVED_TOLERANCE;
            to.is_none_or(|to| angles[dof].is_some_and(|at| is_there(to, at)))
        });
        let is_last = self.legs.as_ref().is_some_and(|legs| legs.len() == 1);
        // What was read before it was sent says nothing of it.
        let is_known = angle.asked >= self.sent;
        if arrived && is_known && !is_last {
            self.legs.as_mut().and_then(VecDeque::pop_front);
            return self.send(seen.now);
        }
        self.end_if(arrived && is_known && !self.start.settles, MoveEnd::Reached);
        let begins = START_DELAY + seen.status.slow_allowance();
        if since >= begins && seen.status.rest == Rest::Resting {
            self.end_if(arrived, MoveEnd::Reached);
            self.end_if(!arrived, MoveEnd::Stopped);
        }
        self.end_if(since > limit(self.slowest()), MoveEnd::Late);
        None
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.end.get_or_insert(Err(why));
    }

    fn ended(&self) -> Option<Ended<MoveEnd>> {
        self.end
    }
}

impl Moving {
    /// The first end stays.
    fn end_if(&mut self, is_over: bool, end: MoveEnd) {
        if is_over {
            self.end.get_or_insert(Ok(end));
        }
    }

    /// The speed of the slowest joint that moves.
    fn slowest(&self) -> Speed {
        let goes = self.start.targets.iter().filter(|(_, to)| to.is_some());
        let speeds = goes.map(|(dof, _)| self.start.limits.speed[dof]);
        speeds.min().unwrap_or(Speed::GENTLE)
    }

    /// Sends the first part of what is left.
    fn send(&mut self, now: Moment) -> Option<Order> {
        let leg = self.legs.as_ref().and_then(|legs| legs.front())?;
        let mut setpoints = Setpoints::none(self.epoch);
        for (dof, to) in leg.iter() {
            if let Some(to) = *to {
                setpoints.angle[dof] = Some(Target::Go(to));
                setpoints.speed[dof] = Some(self.start.limits.speed[dof]);
                setpoints.force[dof] = Some(self.start.limits.force[dof]);
            }
        }
        self.sent = now;
        Some(Order::Set(setpoints))
    }
}

/// How long a part of the way may take: the whole stroke at its speed, and some time to spare.
fn limit(speed: Speed) -> Duration {
    let stroke = f64::from(Angle::MAX.get());
    let longest = Duration::from_secs(600);
    let takes = Duration::try_from_secs_f64(stroke / speed.angle_per_s());
    takes.unwrap_or(longest).min(longest) + SPARE
}
