//! One motion of a hand that the user armed: to targets, on a way on which thumb and index do not meet, until it is there or
//! something stops it.

use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::{Angle, ArmEpoch, Groups, HandSample, Moment, Setpoints, Speed, Target};
use crate::link::{ArmRequest, Clock, Lease};
use crate::poses::player::PlayEnd;
use crate::poses::way::{Targets, way};
use crate::record::{Record, Rest};
use crate::tasks::hand::TaskHand;
use crate::tasks::play::reason;
use std::collections::VecDeque;
use std::time::Duration;
use tokio::time::timeout;

/// How often time is looked at where nothing is read.
const TICK: Duration = Duration::from_millis(5);
/// A part of the way is not judged at rest before this: the hand acts late.
const BEGINS_WITHIN: Duration = Duration::from_millis(500);
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
    /// The arming that the user gave for it.
    pub epoch: ArmEpoch,
    /// The right to move the hand.
    pub lease: Lease,
    /// What was read until now.
    pub seen: HandSample,
    /// What is gripped, from that.
    pub grip: GripEstimator,
    /// The program's clock.
    pub clock: Clock,
}

/// How a motion ended. The hand is told nothing more: it stays armed, and keeps what it was told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoveEnd {
    /// Every joint is at its target.
    Reached,
    /// The hand rests, and a joint is not at its target: something, or its force threshold, stopped it.
    Stopped,
    /// It took too long.
    Late,
    /// The arming ended, a drive reported a fault, the link was lost, or another moves the hand.
    Broken(PlayEnd),
}

/// What came of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveReport {
    /// How it ended.
    pub end: MoveEnd,
    /// What the hand gripped then.
    pub grip: Grip,
}

/// Moves, until the joints are there or the hand rests elsewhere.
pub async fn move_to<H: TaskHand>(hand: &H, start: MoveStart) -> MoveReport {
    let mut records = hand.records();
    let mut run = Moving {
        hand,
        sample: start.seen,
        legs: None,
        sent: start.clock.now(),
        start,
    };
    let end = loop {
        if let Some(end) = run.go_on() {
            break end;
        }
        if let Ok(Some(Record::Reading { sample, fresh })) = timeout(TICK, records.next()).await {
            run.take(*sample, fresh);
        }
    };
    let grip = run
        .start
        .grip
        .known(hand.status().is_believed(), run.start.clock.now());
    MoveReport { end, grip }
}

struct Moving<'a, H> {
    hand: &'a H,
    start: MoveStart,
    sample: HandSample,
    /// What is left of the way, the first of it sent; `None` until it is known where the hand is.
    legs: Option<VecDeque<Targets>>,
    /// When the part under way was sent.
    sent: Moment,
}

impl<H: TaskHand> Moving<'_, H> {
    fn take(&mut self, sample: HandSample, fresh: Groups) {
        self.sample = sample;
        let read = sample.newest(fresh).unwrap_or_default();
        self.start.grip.take(&self.sample, fresh, read);
    }

    /// Does what is to be done now; how it ended, if it did.
    fn go_on(&mut self) -> Option<MoveEnd> {
        if self.hand.check(self.start.lease).is_err() {
            let why = reason(&self.hand.status(), self.start.epoch);
            return Some(MoveEnd::Broken(why.unwrap_or(PlayEnd::TakenOver)));
        }
        let status = self.hand.status();
        if let Some(why) = reason(&status, self.start.epoch) {
            return Some(MoveEnd::Broken(why));
        }
        let now = self.start.clock.now();
        let since = now.since(self.sent);
        let angle = self.sample.angle;
        let Some(angle) = angle.filter(|angle| angle.age(now) <= status.fresh_for()) else {
            return (since > SPARE).then_some(MoveEnd::Late);
        };
        let angles = angle.value.map(|at| at.hold().map(Angle::get));
        let Some(leg) = self.legs.as_ref().and_then(|legs| legs.front()).copied() else {
            self.legs = Some(way(&angles, &self.start.targets).into());
            return self.send();
        };
        let arrived = leg.iter().all(|(dof, to)| {
            let is_there = |to: Angle, at: i16| at.abs_diff(to.get()) <= Angle::ARRIVED_WITHIN;
            to.is_none_or(|to| angles[dof].is_some_and(|at| is_there(to, at)))
        });
        let is_last = self.legs.as_ref().is_some_and(|legs| legs.len() == 1);
        // What was read before it was sent says nothing of it.
        let is_known = angle.asked >= self.sent;
        if arrived && is_known && !is_last {
            self.legs.as_mut().and_then(VecDeque::pop_front);
            return self.send();
        }
        if arrived && is_known && !self.start.settles {
            return Some(MoveEnd::Reached);
        }
        if since >= BEGINS_WITHIN + status.slow_allowance() && status.rest == Rest::Resting {
            return Some(if arrived {
                MoveEnd::Reached
            } else {
                MoveEnd::Stopped
            });
        }
        (since > limit(self.slowest())).then_some(MoveEnd::Late)
    }

    /// The speed of the slowest joint that goes.
    fn slowest(&self) -> Speed {
        let goes = self.start.targets.iter().filter(|(_, to)| to.is_some());
        let speeds = goes.map(|(dof, _)| self.start.limits.speed[dof]);
        speeds.min().unwrap_or(Speed::GENTLE)
    }

    /// Sends the first part of what is left.
    fn send(&mut self) -> Option<MoveEnd> {
        let leg = self.legs.as_ref().and_then(|legs| legs.front())?;
        let mut setpoints = Setpoints::none(self.start.epoch);
        for (dof, to) in leg.iter() {
            if let Some(to) = *to {
                setpoints.angle[dof] = Some(Target::Go(to));
                setpoints.speed[dof] = Some(self.start.limits.speed[dof]);
                setpoints.force[dof] = Some(self.start.limits.force[dof]);
            }
        }
        self.sent = self.start.clock.now();
        let set = self.hand.set(self.start.lease, &setpoints);
        set.is_err().then_some(MoveEnd::Broken(PlayEnd::TakenOver))
    }
}

/// How long a part of the way may take: the whole stroke at its speed, and some time to spare.
fn limit(speed: Speed) -> Duration {
    let stroke = f64::from(Angle::MAX.get());
    let longest = Duration::from_secs(600);
    let takes = Duration::try_from_secs_f64(stroke / speed.angle_per_s());
    takes.unwrap_or(longest).min(longest) + SPARE
}
