//! One motion of a hand that the user armed: to targets, along a path on which thumb and index do not collide, until it arrives or is
//! stopped by an obstacle.

use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::{Angle, ArmEpoch, Groups, HandSample, Moment, Setpoints, Speed, Target};
use crate::link::{ArmRequest, LinkHandle};
use crate::motion::drive::{Armed, drive};
use crate::motion::program::{AfterAbort, Ended, LEG_SPARE, Order, Program, Seen};
use crate::poses::way::{Targets, way};
use crate::record::{Abort, Rest};
use futures::stream::pending;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::time::Duration;

/// Minimum time before a leg is judged at rest: the hand acts late.
const START_DELAY: Duration = Duration::from_millis(500);

/// Settings with which a motion starts.
#[derive(Debug, Clone)]
pub struct MoveStart {
    /// Target of each joint; `None` leaves a joint unchanged. Without any target, the end of what already moves is awaited.
    pub targets: Targets,
    /// Speeds and force thresholds of the moving joints.
    pub limits: ArmRequest,
    /// The motion ends only once the hand rests, so that the grip is known.
    pub settles: bool,
    /// Grip estimate from the readings so far.
    pub grip: GripEstimator,
}

/// Outcome of a motion that was not aborted. Nothing further is sent: the hand stays armed and keeps its targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveEnd {
    /// Every joint is at its target.
    Reached,
    /// The hand rests, and a joint is not at its target: something, or its force threshold, stopped it.
    Stopped,
    /// The time limit expired.
    Late,
}

/// The result of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveReport {
    /// Its outcome, or the reason for an early end.
    pub end: Ended<MoveEnd>,
    /// Grip at the end of the motion.
    pub grip: Grip,
}

/// Moves until the joints are at their targets or the hand rests elsewhere.
pub async fn move_to(hand: &LinkHandle, armed: Armed, start: MoveStart) -> MoveReport {
    let program = Moving::new(armed.epoch, start, armed.clock.now());
    let driven = drive(hand, armed, program, pending(), |_| true).await;
    let estimator = &driven.program.start.grip;
    MoveReport {
        end: driven.end,
        grip: estimator.known(hand.status().is_believed(), armed.clock.now()),
    }
}

/// The program of a motion; another program may host it.
#[derive(Debug)]
pub(crate) struct Moving {
    start: MoveStart,
    epoch: ArmEpoch,
    /// Remaining legs, the first of them sent; `None` until the position of the hand is known.
    legs: Option<VecDeque<Targets>>,
    /// Time at which the current leg was sent.
    sent: Moment,
    end: Option<Ended<MoveEnd>>,
}

impl Program for Moving {
    type Input = Abort;
    type Outcome = MoveEnd;
    type View = ();
    type Event = Infallible;
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
            self.end_if(since > LEG_SPARE, MoveEnd::Late);
            return None;
        };
        let angles = angle.value.map(|at| at.hold().map(Angle::get));
        let Some(leg) = self.legs.as_ref().and_then(|legs| legs.front()).copied() else {
            self.legs = Some(way(&angles, &self.start.targets).into());
            return self.send(seen.now);
        };
        let arrived = leg.iter().all(|(dof, to)| {
            to.is_none_or(|to| angles[dof].is_some_and(|at| to.is_reached_at(at)))
        });
        let is_last = self.legs.as_ref().is_some_and(|legs| legs.len() == 1);
        // A reading from before the leg was sent says nothing about it.
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
        self.end_if(since > self.slowest().stroke() + LEG_SPARE, MoveEnd::Late);
        None
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.end.get_or_insert(Err(why));
    }

    fn view(&self, _now: Moment) {}

    fn ended(&self) -> Option<Ended<MoveEnd>> {
        self.end
    }
}

impl Moving {
    /// A motion under this arming.
    pub(crate) const fn new(epoch: ArmEpoch, start: MoveStart, now: Moment) -> Self {
        Self {
            start,
            epoch,
            legs: None,
            sent: now,
            end: None,
        }
    }

    /// Ends the motion if `is_over`. The first end is final.
    fn end_if(&mut self, is_over: bool, end: MoveEnd) {
        if is_over {
            self.end.get_or_insert(Ok(end));
        }
    }

    /// The speed of the slowest joint that moves; without targets, any may.
    fn slowest(&self) -> Speed {
        let all = self.start.targets.iter().all(|(_, to)| to.is_none());
        let goes = self.start.targets.iter();
        let goes = goes.filter(|(_, to)| all || to.is_some());
        let speeds = goes.map(|(dof, _)| self.start.limits.speed[dof]);
        speeds.min().unwrap_or(Speed::GENTLE)
    }

    /// Sends the first remaining leg.
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
