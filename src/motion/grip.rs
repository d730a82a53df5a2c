//! A grip by size on a hand that the user armed: open, then close along the path on which the pads of thumb and index meet, to the gap
//! or to the object between them.

use crate::hand::gap::{Gap, PinchGap, held_gap, pinch_gap};
use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::{
    AngleReading, ArmEpoch, Force, Group, Groups, HandCommand, HandSample, Moment, PerDof,
    Setpoints, Speed, Target,
};
use crate::link::session::watch::other_controller::OtherController;
use crate::link::{LinkHandle, Stop};
use crate::motion::drive::{Armed, drive};
use crate::motion::program::{Ended, LEG_SPARE, Order, Program, Seen};
use crate::poses::way::{WayPart, pinch_way};
use crate::record::{Abort, Rest};
use futures::Stream;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::time::Duration;

/// Minimum time before a leg is judged: the hand acts late.
const START_DELAY: Duration = Duration::from_millis(500);
/// Setpoints read back sooner than this after a write may be the previous ones.
const ACT_DELAY: Duration = Duration::from_millis(150);
/// A completed leg waits at most this long, counted from its start, for its setpoints to be read back.
const READ_BACK_TIMEOUT: Duration = Duration::from_millis(1500);

/// Settings with which a grip starts.
#[derive(Debug, Clone)]
pub struct GripStart {
    /// Gap to close or open to.
    pub gap: Gap,
    /// Speed of the fastest joint.
    pub speed: Speed,
    /// Force threshold of all joints.
    pub force: Force,
    /// Grip estimate from the readings so far.
    pub grip: GripEstimator,
}

/// Outcome of a grip that was not aborted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GripEnd {
    /// Thumb and index hold an object.
    Held,
    /// Thumb and index are at the gap and hold nothing.
    Reached,
    /// A joint was stopped before the gap, but thumb and index hold nothing. The hand was stopped.
    Stopped,
    /// A joint was stopped before the hand was open for the grip. The hand was stopped.
    NotOpened,
    /// The time limit expired. The hand was stopped.
    Late,
}

/// The result of a grip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GripReport {
    /// Its outcome, or the reason for an early end.
    pub end: Ended<GripEnd>,
    /// Gap between the pads at the end, by the model; `None` if they do not face each other, or the angles are not known.
    pub gap: Option<PinchGap>,
    /// Grip at the end.
    pub grip: Grip,
    /// Result of the stop that followed, as feedback shows it; `None` if the hand was not stopped.
    pub stop: Option<Stop>,
}

/// Grips. At the end the hand is disarmed. After a grip that was [held](GripEnd::Held) or [reached](GripEnd::Reached) it keeps its
/// targets: it continues to press the object, up to the force threshold.
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
    let driven = drive(hand, armed, program, ends, |_| true).await;
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
    /// Remaining legs, the first of them sent; `None` until the position of the hand is known.
    legs: Option<VecDeque<WayPart>>,
    /// Time at which the current leg was sent.
    sent: Moment,
    /// Angles in the last step; `None` if they were not known.
    angles: Option<PerDof<i16>>,
    end: Option<Ended<GripEnd>>,
}

impl Program for GripRun {
    type Input = Abort;
    type Outcome = GripEnd;
    type View = ();
    type Event = Infallible;

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
            return self.late(since, LEG_SPARE);
        };
        let Some(leg) = self.legs.as_ref().and_then(|legs| legs.front()).copied() else {
            let (gap, speed) = (self.start.gap, self.start.speed);
            let way = pinch_way(&angles.map(Some), gap, speed, &PerDof::splat(true));
            self.legs = Some(way.into());
            return self.send(seen.now);
        };
        let arrived = leg
            .targets
            .iter()
            .all(|(dof, to)| to.is_none_or(|to| to.is_reached_at(angles[dof])));
        let is_last = self.legs.as_ref().is_some_and(|legs| legs.len() == 1);
        // A leg sent now would overwrite the setpoints of another controller unseen.
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

    fn view(&self, _now: Moment) {}

    fn ended(&self) -> Option<Ended<GripEnd>> {
        self.end
    }
}

impl GripRun {
    fn late(&mut self, since: Duration, limit: Duration) -> Option<Order> {
        (since > limit).then(|| self.end(GripEnd::Late))
    }

    /// Ends the grip at rest, judged by the current readings.
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
            // The hand must not continue to press if it holds nothing.
            GripEnd::Stopped | GripEnd::NotOpened | GripEnd::Late => Order::Stop,
        }
    }

    /// Sends the first remaining leg.
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

/// Setpoints of this grip compared with those read back, by the rule that the session itself uses.
#[derive(Debug, Default)]
struct SentSetpoints {
    at: Option<Moment>,
    others: OtherController,
    /// Angles and speeds were read back since the last setpoints were sent.
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

    /// True if both groups were read back since the last setpoints, without unexpected values.
    fn is_seen(&self) -> bool {
        self.is_read == [true; 2] && !self.others.is_doubted()
    }
}

/// Time limit of a leg: the full stroke at its speed, plus [`LEG_SPARE`].
fn limit(leg: &WayPart) -> Duration {
    let fastest = leg.speeds.as_array().iter().max().copied();
    fastest.unwrap_or(Speed::MIN).stroke() + LEG_SPARE
}
