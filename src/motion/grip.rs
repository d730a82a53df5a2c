//! A grip by size on a hand that the user armed: open, then close along the path on which the pads of thumb and index meet, to
//! the gap or to what stands between them.

use crate::hand::gap::{Gap, PinchGap, held_gap, pinch_gap};
use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Force, Group, Groups, HandCommand, HandSample, Moment, PerDof,
    Setpoints, Speed, Target,
};
use crate::link::session::watch::other_controller::OtherController;
use crate::link::{LinkHandle, Stop};
use crate::motion::drive::{Armed, drive};
use crate::motion::program::{Ended, Order, Program, Seen};
use crate::poses::way::{WayPart, pinch_way};
use crate::record::{Abort, Rest};
use futures::Stream;
use std::collections::VecDeque;
use std::time::Duration;

/// A part of the way is not judged before this: the hand acts late.
const START_DELAY: Duration = Duration::from_millis(500);
/// Setpoints that are read back sooner after they were written may be those of before.
const ACT_DELAY: Duration = Duration::from_millis(150);
/// A part of the way that is done waits no longer than this, counted from its start, for what is read back.
const READ_BACK_TIMEOUT: Duration = Duration::from_millis(1500);
/// A part of the way may take so much longer than its speed says.
const SPARE: Duration = Duration::from_secs(4);

/// What a grip begins with.
#[derive(Debug, Clone)]
pub struct GripStart {
    /// The gap to close, or open, to.
    pub gap: Gap,
    /// Speed of the fastest joint.
    pub speed: Speed,
    /// Force threshold of all joints.
    pub force: Force,
    /// What tells the grip.
    pub grip: GripEstimator,
}

/// How a grip ended that nothing aborted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GripEnd {
    /// Thumb and index hold something.
    Held,
    /// At the gap, and nothing is held.
    Reached,
    /// Something stopped a joint before the gap, but it is not held by thumb and index. The hand was stopped.
    Stopped,
    /// Something stopped a joint before the hand was open for the grip. The hand was stopped.
    NotOpened,
    /// It took too long. The hand was stopped.
    Late,
}

/// The result of a grip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GripReport {
    /// How it ended.
    pub end: Ended<GripEnd>,
    /// What is between the pads then, by the model; `None` where they do not face each other, or angles are old.
    pub gap: Option<PinchGap>,
    /// What the hand gripped then.
    pub grip: Grip,
    /// What feedback says of the stop that followed, if one did.
    pub stop: Option<Stop>,
}

/// Grips. At the end the hand is not armed any more. Of a grip that was [held](GripEnd::Held) or [reached](GripEnd::Reached) it keeps its
/// targets: it goes on pressing what it holds, up to the force threshold.
pub async fn grip(
    hand: &LinkHandle,
    armed: Armed,
    start: GripStart,
    ends: impl Stream<Item = Abort>,
) -> GripReport {
    let program = GripRun {
        setpoints: SentSetpoints::default(),
        legs: None,
        sent: armed.clock.now(),
        epoch: armed.epoch,
        angles: None,
        end: None,
        start,
    };
    let driven = drive(hand, armed, program, ends, |_, _| true).await;
    let angles = driven.program.angles;
    GripReport {
        end: driven.end,
        gap: angles.and_then(|angles| pinch_gap(&angles.map(f32::from))),
        grip: driven.program.start.grip.grip(),
        stop: driven.stop,
    }
}

struct GripRun {
    start: GripStart,
    epoch: ArmEpoch,
    setpoints: SentSetpoints,
    /// What is left of the way, the first of it sent; `None` until it is known where the hand is.
    legs: Option<VecDeque<WayPart>>,
    /// When the part under way was sent.
    sent: Moment,
    /// Where the joints were in the last step, if that was known.
    angles: Option<PerDof<i16>>,
    end: Option<Ended<GripEnd>>,
}

impl Program for GripRun {
    type Input = Abort;
    type Outcome = GripEnd;

    fn input(&mut self, why: Abort, seen: &Seen<'_>) -> Option<Order> {
        self.abort(why, seen.now);
        None
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        self.setpoints.read(sample, fresh);
        self.start.grip.apply(sample, fresh, now);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        if self.setpoints.others.changes > 0 {
            let wrote = self.setpoints.others.foreign;
            self.abort(Abort::OtherController { wrote }, seen.now);
            return None;
        }
        let angles = seen.angles();
        self.angles = angles.and_then(|angles| angles.value.map(AngleReading::documented).all());
        let since = seen.now.since(self.sent);
        let Some(angles) = self.angles else {
            return self.late(since, SPARE);
        };
        let Some(leg) = self.legs.as_ref().and_then(|legs| legs.front()).copied() else {
            let (gap, speed) = (self.start.gap, self.start.speed);
            let way = pinch_way(&angles.map(Some), gap, speed, &PerDof::splat(true));
            self.legs = Some(way.into());
            return self.send(seen.now);
        };
        let arrived = leg.targets.iter().all(|(dof, to)| {
            to.is_none_or(|to| angles[dof].abs_diff(to.get()) <= Angle::ARRIVED_TOLERANCE)
        });
        let is_last = self.legs.as_ref().is_some_and(|legs| legs.len() == 1);
        // What another wrote meanwhile would be overwritten unseen.
        let is_unread = since >= READ_BACK_TIMEOUT && !self.setpoints.others.is_doubted();
        if arrived && !is_last {
            if self.setpoints.is_seen() || is_unread {
                self.legs.as_mut().and_then(VecDeque::pop_front);
                return self.send(seen.now);
            }
            return self.late(since, limit(&leg));
        }
        let begins = START_DELAY + seen.status.slow_allowance();
        let rests = since >= begins && seen.status.rest == Rest::Resting;
        if rests && !self.setpoints.others.is_doubted() {
            return self.at_rest(seen.sample, leg, arrived);
        }
        self.late(since, limit(&leg))
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.end.get_or_insert(Err(why));
    }

    fn ended(&self) -> Option<Ended<GripEnd>> {
        self.end
    }
}

impl GripRun {
    fn late(&mut self, since: Duration, limit: Duration) -> Option<Order> {
        (since > limit).then(|| self.end(GripEnd::Late))
    }

    /// Ends it where the hand rests now.
    fn at_rest(&mut self, sample: &HandSample, leg: WayPart, arrived: bool) -> Option<Order> {
        let angle = sample.angle.map(|angle| angle.value);
        let grip = self.start.grip.grip();
        let gap = angle.and_then(|angle| held_gap(&grip, &angle));
        Some(self.end(match gap {
            Some(_) => GripEnd::Held,
            None if arrived => GripEnd::Reached,
            None if leg.is_pinching => GripEnd::Stopped,
            None => GripEnd::NotOpened,
        }))
    }

    fn end(&mut self, end: GripEnd) -> Order {
        self.end = Some(Ok(end));
        match end {
            GripEnd::Held | GripEnd::Reached => Order::Disarm,
            // Nothing goes on pressing what is not held.
            GripEnd::Stopped | GripEnd::NotOpened | GripEnd::Late => Order::Stop,
        }
    }

    /// Sends the first part of what is left.
    fn send(&mut self, now: Moment) -> Option<Order> {
        let leg = self.legs.as_ref().and_then(|legs| legs.front())?;
        let mut setpoints = Setpoints::none(self.epoch);
        for (dof, to) in leg.targets.iter() {
            if let Some(to) = *to {
                setpoints.angle[dof] = Some(Target::Go(to));
                setpoints.speed[dof] = Some(leg.speeds[dof]);
                setpoints.force[dof] = Some(self.start.force);
            }
        }
        self.sent = now;
        self.setpoints.sent(&setpoints, now);
        Some(Order::Set(setpoints))
    }
}

/// The setpoints of this grip, against what is read back of them: by the rule that the session itself judges by.
#[derive(Debug, Default)]
struct SentSetpoints {
    at: Option<Moment>,
    others: OtherController,
    /// Angles and speeds were read back since the last of them were sent.
    is_read: [bool; 2],
}

impl SentSetpoints {
    fn sent(&mut self, setpoints: &Setpoints, now: Moment) {
        for write in setpoints.commands().iter().flat_map(HandCommand::writes) {
            self.others.wrote(&write, now);
        }
        (self.at, self.is_read) = (Some(now), [false; 2]);
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups) {
        self.others.read(sample, fresh);
        let Some(acted) = self.at.map(|at| at.plus(ACT_DELAY)) else {
            return;
        };
        let angles = sample.angle_set.map(|set| set.asked);
        let speeds = sample.speed_set.map(|set| set.asked);
        let groups = [(Group::AngleSet, angles), (Group::SpeedSet, speeds)];
        for (is_read, (group, asked)) in self.is_read.iter_mut().zip(groups) {
            *is_read |= fresh.contains(group) && asked.is_some_and(|asked| asked >= acted);
        }
    }

    /// Both groups were read since the joints were told something, with nothing strange.
    fn is_seen(&self) -> bool {
        self.is_read == [true; 2] && !self.others.is_doubted()
    }
}

/// How long a part of the way may take: the whole stroke at its speed, and some time to spare.
fn limit(leg: &WayPart) -> Duration {
    let fastest = leg.speeds.as_array().iter().max().copied();
    fastest.unwrap_or(Speed::MIN).stroke() + SPARE
}
