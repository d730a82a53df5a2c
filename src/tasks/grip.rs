//! A grip by size on a hand that the user armed: open, then close along the path on which the pads of thumb and index meet, to
//! the gap or to what stands between them.

use crate::hand::gap::{Gap, PinchGap, held_gap, pinch_gap};
use crate::hand::grip::{Grip, GripEstimator};
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Force, Group, Groups, HandCommand, HandSample, Moment, PerDof,
    Setpoints, Speed, Target,
};
use crate::link::session::watch::other_controller::OtherController;
use crate::link::{Clock, Lease, Stop};
use crate::poses::player::PlayEnd;
use crate::poses::way::{WayPart, pinch_way};
use crate::record::{Disarmed, Record, Rest, SetpointConflict};
use crate::tasks::hand::TaskHand;
use crate::tasks::play::reason;
use std::collections::VecDeque;
use std::pin::pin;
use std::time::Duration;
use tokio::time::timeout;

/// How often time is looked at where nothing is read.
const TICK: Duration = Duration::from_millis(5);
/// A part of the way is not judged before this: the hand acts late.
const BEGINS_WITHIN: Duration = Duration::from_millis(500);
/// Setpoints that are read back sooner after they were written may be those of before.
const ACTS_WITHIN: Duration = Duration::from_millis(150);
/// A part of the way that is done waits no longer than this, counted from its start, for what is read back.
const SEEN_WITHIN: Duration = Duration::from_millis(1500);
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
    /// The arming that the user gave for it.
    pub epoch: ArmEpoch,
    /// The right to move the hand.
    pub lease: Lease,
    /// What was read until now.
    pub seen: HandSample,
    /// What tells the grip.
    pub grip: GripEstimator,
    /// The program's clock.
    pub clock: Clock,
}

/// How a grip ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GripEnd {
    /// Thumb and index hold something.
    Held,
    /// At the gap, and nothing is held.
    Reached,
    /// Something stopped a joint before the gap, but it is not held by thumb and index.
    Stopped,
    /// Something stopped a joint before the hand was open for the grip.
    NotOpened,
    /// It took too long. The hand was stopped.
    Late,
    /// The user ended it. The hand was stopped.
    Person,
    /// Another controller wrote where the joints go or how fast, or talks to the hand. The hand was stopped.
    OtherWrote,
    /// The arming ended, a drive reported a fault, the link was lost, or another moves the hand.
    Broken(PlayEnd),
}

/// What came of a grip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GripReport {
    /// How it ended.
    pub end: GripEnd,
    /// Why the hand was not armed any more then, if it was not.
    pub disarmed: Option<Disarmed>,
    /// What another controller was seen to write.
    pub foreign: Option<SetpointConflict>,
    /// What is between the pads then, by the model; `None` where they do not face each other, or angles are old.
    pub gap: Option<PinchGap>,
    /// What the hand gripped then.
    pub grip: Grip,
    /// What feedback says of the stop that followed, if one did.
    pub stop: Option<Stop>,
}

/// Grips. `ended` resolves when the user ends it. At the end the hand is not armed any more, and keeps what it was told: it goes
/// on pressing what it holds, up to the force threshold.
pub async fn grip<H: TaskHand>(
    hand: &H,
    start: GripStart,
    ended: impl Future<Output = ()>,
) -> GripReport {
    let mut records = hand.records();
    let mut run = GripRun {
        hand,
        sample: start.seen,
        estimator: start.grip.clone(),
        setpoints: SentSetpoints::default(),
        legs: None,
        sent: start.clock.now(),
        start,
    };
    let mut ended = pin!(ended);
    let end = loop {
        tokio::select! {
            biased;
            () = &mut ended => break GripEnd::Person,
            record = timeout(TICK, records.next()) => {
                if let Ok(Some(Record::Reading { sample, fresh })) = record {
                    run.take(*sample, fresh);
                }
            }
        }
        if let Some(end) = run.go_on() {
            break end;
        }
    };
    let disarmed = hand.status().disarmed;
    let end = match (end, disarmed) {
        (GripEnd::Broken(PlayEnd::Disarmed), Some(Disarmed::OtherController)) => {
            GripEnd::OtherWrote
        }
        (end, _) => end,
    };
    let stop = match end {
        GripEnd::Held | GripEnd::Reached => {
            hand.disarm();
            None
        }
        // Who has the hand now moves it.
        GripEnd::Broken(PlayEnd::TakenOver) => None,
        // Nothing goes on pressing what is not held, and what another wrote is no reason to go on.
        GripEnd::Stopped
        | GripEnd::NotOpened
        | GripEnd::Late
        | GripEnd::Person
        | GripEnd::OtherWrote
        | GripEnd::Broken(_) => Some(hand.stopped().await),
    };
    let foreign = run.setpoints.others.foreign;
    GripReport {
        end,
        disarmed,
        foreign: foreign.or(hand.status().foreign_setpoint),
        gap: run
            .angles()
            .and_then(|angles| pinch_gap(&angles.map(f32::from))),
        grip: run.estimator.grip(),
        stop,
    }
}

struct GripRun<'a, H> {
    hand: &'a H,
    start: GripStart,
    sample: HandSample,
    estimator: GripEstimator,
    setpoints: SentSetpoints,
    /// What is left of the way, the first of it sent; `None` until it is known where the hand is.
    legs: Option<VecDeque<WayPart>>,
    /// When the part under way was sent.
    sent: Moment,
}

impl<H: TaskHand> GripRun<'_, H> {
    fn take(&mut self, sample: HandSample, fresh: Groups) {
        self.sample = sample;
        self.setpoints.read(&self.sample, fresh);
        self.estimator
            .take(&self.sample, fresh, self.start.clock.now());
    }

    /// Angles that are fresh enough to go by.
    fn angles(&self) -> Option<PerDof<i16>> {
        let now = self.start.clock.now();
        let angle = self.sample.angle;
        let fresh_for = self.hand.status().fresh_for();
        let angle = angle.filter(|angle| angle.age(now) <= fresh_for)?;
        angle.value.map(AngleReading::documented).all()
    }

    /// Does what is to be done now; how it ended, if it did.
    fn go_on(&mut self) -> Option<GripEnd> {
        if let Some(why) = reason(&self.hand.status(), self.start.epoch) {
            return Some(GripEnd::Broken(why));
        }
        if self.setpoints.others.changes > 0 {
            return Some(GripEnd::OtherWrote);
        }
        let now = self.start.clock.now();
        let Some(angles) = self.angles() else {
            let is_late = now.since(self.sent) > SPARE;
            return is_late.then_some(GripEnd::Late);
        };
        let Some(leg) = self.legs.as_ref().and_then(|legs| legs.front()).copied() else {
            let (gap, speed) = (self.start.gap, self.start.speed);
            let way = pinch_way(&angles.map(Some), gap, speed, &PerDof::splat(true));
            self.legs = Some(way.into());
            return self.send();
        };
        let arrived = leg.targets.iter().all(|(dof, to)| {
            to.is_none_or(|to| angles[dof].abs_diff(to.get()) <= Angle::ARRIVED_WITHIN)
        });
        let is_last = self.legs.as_ref().is_some_and(|legs| legs.len() == 1);
        let since = now.since(self.sent);
        // What another wrote meanwhile would be overwritten unseen.
        let is_unread = since >= SEEN_WITHIN && !self.setpoints.others.is_doubted();
        if arrived && !is_last {
            if self.setpoints.is_seen() || is_unread {
                self.legs.as_mut().and_then(VecDeque::pop_front);
                return self.send();
            }
            return (since > limit(&leg)).then_some(GripEnd::Late);
        }
        let status = self.hand.status();
        let rests =
            since >= BEGINS_WITHIN + status.slow_allowance() && status.rest == Rest::Resting;
        if rests && !self.setpoints.others.is_doubted() {
            return Some(self.at_rest(leg, arrived));
        }
        (since > limit(&leg)).then_some(GripEnd::Late)
    }

    /// How it ended, where the hand rests now.
    fn at_rest(&self, leg: WayPart, arrived: bool) -> GripEnd {
        let angle = self.sample.angle.map(|angle| angle.value);
        let grip = self.estimator.grip();
        let gap = angle.and_then(|angle| held_gap(&grip, &angle));
        match gap {
            Some(_) => GripEnd::Held,
            None if arrived => GripEnd::Reached,
            None if leg.is_pinching => GripEnd::Stopped,
            None => GripEnd::NotOpened,
        }
    }

    /// Sends the first part of what is left.
    fn send(&mut self) -> Option<GripEnd> {
        let leg = self.legs.as_ref().and_then(|legs| legs.front())?;
        let mut setpoints = Setpoints::none(self.start.epoch);
        for (dof, to) in leg.targets.iter() {
            if let Some(to) = *to {
                setpoints.angle[dof] = Some(Target::Go(to));
                setpoints.speed[dof] = Some(leg.speeds[dof]);
                setpoints.force[dof] = Some(self.start.force);
            }
        }
        self.sent = self.start.clock.now();
        self.setpoints.sent(&setpoints, self.sent);
        let set = self.hand.set(self.start.lease, &setpoints);
        set.is_err().then_some(GripEnd::Broken(PlayEnd::TakenOver))
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
        let Some(acted) = self.at.map(|at| at.plus(ACTS_WITHIN)) else {
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
