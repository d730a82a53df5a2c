//! A calibration of one joint in newtons: the finger presses a kitchen scale at five loads, and at each the user types what the scale
//! shows. Between the loads it lets go, so that the zero of the force is measured just before each.

use crate::hand::newtons::{Contradiction, ForceScale, LOADS, ScalePoint, loads};
use crate::hand::{
    Angle, ArmEpoch, Dof, Finger, Force, Group, Groups, HandSample, Moment, Setpoints, Speed,
    Target,
};
use crate::link::{LinkHandle, PollRates};
use crate::motion::drive::{Armed, Driven, drive};
use crate::motion::program::{Ended, LEG_SPARE, Order, Program, Progress, Seen};
use crate::motion::series;
use crate::record::Abort;
use futures::Stream;
use std::collections::VecDeque;
use std::ops::RangeInclusive;
use std::time::Duration;

/// Speed at the contact: its overshoot is small and known.
const SPEED: Speed = Speed::SLOWEST_MEASURED;
/// Counts of ANGLE_ACT by which the finger lifts off the scale between two loads: more than it sank in, plus backlash.
const LIFT: i16 = 60;
/// Force over the zero from which the finger touches the scale, g.
const CONTACT_G: f64 = 30.0;
/// Zeros with which the loads can be pressed, g: published ones go from -60 to 241.
const ZEROS_G: RangeInclusive<f64> = -80.0..=400.0;
/// A load that stays this far below its threshold was stopped by the zero, which the drive counts as force, g.
const SHORT_G: f64 = 40.0;
/// Minimum time of a press before that is judged: a joint may take up its backlash first.
const SHORT_DELAY: Duration = Duration::from_secs(3);
/// Minimum threshold, g: below it, noise alone would stop the joint.
const LEAST_THRESHOLD_G: f64 = 20.0;
/// Minimum time before a motion is judged: the hand acts late.
const START_DELAY: Duration = Duration::from_millis(1000);
/// A joint is at rest if it stayed within one count for this time.
const STILL_DURATION: Duration = Duration::from_millis(300);
/// A joint that meets nothing for this time after the start of a press does not press the scale.
const CONTACT_TIMEOUT: Duration = Duration::from_secs(5);
/// Measuring time of the zero, and of each mean that shows whether the force is steady.
const MEAN_DURATION: Duration = Duration::from_millis(500);
/// Readings that a mean needs at least.
const READINGS_MIN: f64 = 5.0;
/// Two means in a row may differ by this much, g.
const STEADY_G: f64 = 4.0;
/// Maximum time for the force to become steady.
const STEADY_TIMEOUT: Duration = Duration::from_secs(20);
/// Maximum time for the user to answer: the drive warms while it presses.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(120);
/// Time that a motion may take beyond the time its speed implies.
/// Readings that may be typed again before the points are rejected.
const RETYPED_MAX: u8 = 3;

/// Settings with which a calibration starts.
#[derive(Debug, Clone)]
pub struct ScaleStart {
    /// The joint that bends a finger.
    pub dof: Dof,
    /// Limit of the loads.
    pub limit: Force,
    /// Points that were accepted earlier, with the same limit.
    pub points: Vec<ScalePoint>,
}

/// User input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ScaleInput {
    /// Reading of the scale, g.
    Reading(f64),
    /// Press this load again.
    Again,
    /// Leave this load out.
    Skip,
    /// Let go, and end.
    Finish,
    /// End at once.
    Abort(Abort),
}

/// Something that the user needs to know, or that is stored.
#[derive(Debug, Clone, PartialEq)]
pub enum ScaleEvent {
    /// The force is steady: the user reads the scale.
    Asked {
        /// Number of the load, from 0.
        load: usize,
        /// Force over the zero, g.
        hand_g: f64,
    },
    /// An answer came while none was asked for, and is not used.
    NotAsked,
    /// A reading contradicts the others; its load is pressed again, or no point remains.
    Doubted(Contradiction),
    /// The accepted points changed.
    Points(Vec<ScalePoint>),
}

/// Outcome of a calibration that was not aborted. The finger lifted off the scale and the hand is disarmed, unless it says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScaleEnd {
    /// All loads are accepted.
    Done,
    /// The user ended it, or left out a load. The accepted points remain.
    Incomplete,
    /// The points contradict each other. None remains.
    Contradicted,
    /// The finger met nothing.
    NoContact,
    /// The force reads too much or too little without a load.
    ZeroOff,
    /// The joint could not be opened. The hand was stopped.
    NotOpened,
    /// The force did not become steady.
    Unsteady,
    /// A motion took too long. The hand was stopped if it could not open.
    Late,
    /// The user did not answer.
    NoAnswer,
}

/// Calibrates. At the end the hand is disarmed. `report` is as for [`drive`].
pub async fn calibrate(
    hand: &LinkHandle,
    armed: Armed,
    start: ScaleStart,
    inputs: impl Stream<Item = ScaleInput>,
    report: impl FnMut(Progress<(), ScaleEvent>) -> bool,
) -> Driven<ScaleRun> {
    drive(
        hand,
        armed,
        ScaleRun::new(armed.epoch, start),
        inputs,
        report,
    )
    .await
}

/// MeanForce of readings.
#[derive(Debug, Clone, Copy, Default)]
struct MeanForce {
    sum: f64,
    count: f64,
}

impl MeanForce {
    fn push(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    /// `None` while there are too few readings.
    fn value(self) -> Option<f64> {
        (self.count >= READINGS_MIN).then(|| self.sum / self.count)
    }
}

/// Force of the joint over its zero, g, and normal force of the fingertip, N.
#[derive(Debug, Clone, Copy, Default)]
struct TipFelt {
    hand: MeanForce,
    tip: MeanForce,
}

#[derive(Debug, Clone, Copy)]
enum ScalePhase {
    Opening {
        since: Moment,
        to: Angle,
    },
    Zeroing {
        since: Moment,
        mean: MeanForce,
    },
    Pressing {
        since: Moment,
    },
    /// Waits for two means that agree.
    Settling {
        pressed: Moment,
        since: Moment,
        felt: TipFelt,
        before: Option<f64>,
    },
    /// Waits for the user, and continues to measure.
    Asking {
        since: Moment,
        felt: TipFelt,
    },
}

/// A calibration as a program.
#[derive(Debug)]
pub struct ScaleRun {
    dof: Dof,
    limit: Force,
    epoch: ArmEpoch,
    /// `None` until the position of the hand is known.
    phase: Option<ScalePhase>,
    /// Loads that are not measured, the current one first.
    left: VecDeque<usize>,
    points: Vec<ScalePoint>,
    zero_g: f64,
    /// The drive compares its threshold with FORCE_ACT as read, zero included.
    counts_zero: bool,
    /// Angle at which the finger first touched the scale.
    contact: Option<i16>,
    /// Angle of the joint, and the time since which it is unchanged.
    pose: Option<(Moment, i16)>,
    retyped: u8,
    events: VecDeque<ScaleEvent>,
    /// Outcome, once the finger has lifted off.
    ending: Option<ScaleEnd>,
    end: Option<Ended<ScaleEnd>>,
}

impl Program for ScaleRun {
    type Input = ScaleInput;
    type Outcome = ScaleEnd;
    type View = ();
    type Event = ScaleEvent;
    const RATES: Option<PollRates> = Some(series::RATES);

    fn input(&mut self, input: ScaleInput, seen: &Seen<'_>) -> Option<Order> {
        self.answer(input, seen.now)
    }

    fn read(&mut self, sample: &HandSample, fresh: Groups, _now: Moment) {
        if fresh.contains(Group::Angle)
            && let Some(angle) = sample.angle
        {
            let at = angle.value[self.dof].raw();
            let kept = self.pose.filter(|(_, pose)| pose.abs_diff(at) <= 1);
            self.pose = Some(kept.unwrap_or((angle.received, at)));
        }
        if fresh.contains(Group::Force)
            && let Some(force) = sample.force
        {
            self.read_force(force.value[self.dof].raw().into());
        }
        let finger = Finger::ALL.into_iter().find(|own| own.bend() == self.dof);
        if let Some(finger) = finger.filter(|own| fresh.contains(Group::Tactile(*own)))
            && let Some(newtons) = sample.tactile[finger].and_then(|own| own.value.normal())
            && let Some(ScalePhase::Settling { felt, .. } | ScalePhase::Asking { felt, .. }) =
                &mut self.phase
        {
            felt.tip.push(newtons.into());
        }
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let now = seen.now;
        let (_, at) = self.pose?;
        match self.phase {
            None => self.open(now),
            Some(ScalePhase::Opening { since, to }) => self.tick_opening(since, to, now),
            Some(ScalePhase::Zeroing { since, mean }) => {
                let zero = mean.value().filter(|_| now.since(since) >= MEAN_DURATION);
                let Some(zero_g) = zero else {
                    return self.late(since, LEG_SPARE, now);
                };
                self.zero_g = zero_g;
                if !ZEROS_G.contains(&zero_g) {
                    return self.finish(ScaleEnd::ZeroOff, now);
                }
                self.press(now)
            }
            Some(ScalePhase::Pressing { since }) => {
                if !self.rests(since, now) {
                    return self.late(since, SPEED.stroke() + LEG_SPARE, now);
                }
                self.phase = Some(ScalePhase::Settling {
                    pressed: since,
                    since: now,
                    felt: TipFelt::default(),
                    before: None,
                });
                None
            }
            Some(ScalePhase::Settling { pressed, .. }) => self.tick_settling(pressed, at, now),
            Some(ScalePhase::Asking { since, .. }) => {
                let is_late = now.since(since) > ANSWER_TIMEOUT;
                is_late.then(|| self.finish(ScaleEnd::NoAnswer, now))?
            }
        }
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.end.get_or_insert(Err(why));
    }

    fn view(&self, _now: Moment) {}

    fn event(&mut self) -> Option<ScaleEvent> {
        self.events.pop_front()
    }

    fn ended(&self) -> Option<Ended<ScaleEnd>> {
        self.end
    }
}

impl ScaleRun {
    /// Starts a calibration. Nothing is sent before the first tick.
    pub fn new(epoch: ArmEpoch, start: ScaleStart) -> Self {
        let is_left = |load: &usize| start.points.iter().all(|own| own.load != *load);
        let mut run = Self {
            dof: start.dof,
            limit: start.limit,
            epoch,
            phase: None,
            left: (0..LOADS).filter(is_left).collect(),
            points: start.points,
            zero_g: 0.0,
            counts_zero: false,
            contact: None,
            pose: None,
            retyped: 0,
            events: VecDeque::new(),
            ending: None,
            end: None,
        };
        run.judge();
        run
    }

    /// The accepted points.
    pub fn points(&self) -> &[ScalePoint] {
        &self.points
    }

    /// Receives user input.
    pub fn answer(&mut self, input: ScaleInput, now: Moment) -> Option<Order> {
        match input {
            ScaleInput::Abort(why) => {
                self.abort(why, now);
                return None;
            }
            ScaleInput::Finish => return self.finish(ScaleEnd::Incomplete, now),
            ScaleInput::Reading(_) | ScaleInput::Again | ScaleInput::Skip => {}
        }
        let Some(ScalePhase::Asking { felt, .. }) = self.phase else {
            self.events.push_back(ScaleEvent::NotAsked);
            return None;
        };
        match input {
            ScaleInput::Reading(scale_g) => {
                self.accept(scale_g, felt);
                self.judge();
            }
            ScaleInput::Skip => drop(self.left.pop_front()),
            ScaleInput::Again | ScaleInput::Finish | ScaleInput::Abort(_) => {}
        }
        if self.left.is_empty() {
            self.ending.get_or_insert(ScaleEnd::Incomplete);
        }
        self.open(now)
    }

    fn accept(&mut self, scale_g: f64, felt: TipFelt) {
        let Some((load, hand_g)) = self.left.pop_front().zip(felt.hand.value()) else {
            return;
        };
        self.points.push(ScalePoint {
            load,
            hand_g,
            scale_g,
            tip_n: felt.tip.value(),
        });
        self.points.sort_by_key(|own| own.load);
        self.publish();
    }

    /// Judges the points once there is one for each load. A reading that contradicts the others is removed, to be typed again.
    fn judge(&mut self) {
        match ForceScale::fit(&self.points) {
            Ok(_) => self.ending = Some(ScaleEnd::Done),
            Err(Contradiction::TooFew { .. }) => {}
            Err(why @ Contradiction::Point { load, .. }) if self.retyped < RETYPED_MAX => {
                self.retyped += 1;
                self.points.retain(|own| own.load != load);
                self.left.push_back(load);
                self.events.push_back(ScaleEvent::Doubted(why));
                self.publish();
            }
            Err(why) => {
                self.points.clear();
                self.events.push_back(ScaleEvent::Doubted(why));
                self.publish();
                self.ending = Some(ScaleEnd::Contradicted);
            }
        }
    }

    fn publish(&mut self) {
        let points = self.points.clone();
        self.events.push_back(ScaleEvent::Points(points));
    }

    fn read_force(&mut self, raw: f64) {
        let over = raw - self.zero_g;
        match &mut self.phase {
            Some(ScalePhase::Zeroing { mean, .. }) => mean.push(raw),
            Some(ScalePhase::Pressing { .. }) if over >= CONTACT_G => {
                self.contact = self.contact.or(self.pose.map(|(_, at)| at));
            }
            Some(ScalePhase::Settling { felt, .. } | ScalePhase::Asking { felt, .. }) => {
                felt.hand.push(over)
            }
            Some(ScalePhase::Opening { .. } | ScalePhase::Pressing { .. }) | None => {}
        }
    }

    /// True if the joint moved for long enough and is still.
    fn rests(&self, since: Moment, now: Moment) -> bool {
        let still = self.pose.map(|(since, _)| now.since(since));
        now.since(since) >= START_DELAY && still.is_some_and(|still| still >= STILL_DURATION)
    }

    fn tick_opening(&mut self, since: Moment, to: Angle, now: Moment) -> Option<Order> {
        if !self.rests(since, now) {
            return self.late(since, Speed::GENTLE.stroke() + LEG_SPARE, now);
        }
        let (_, at) = self.pose?;
        if !to.is_reached_at(at) {
            return Some(self.stop(ScaleEnd::NotOpened));
        }
        if let Some(end) = self.ending {
            self.end = Some(Ok(end));
            return Some(Order::Disarm);
        }
        self.phase = Some(ScalePhase::Zeroing {
            since: now,
            mean: MeanForce::default(),
        });
        None
    }

    fn tick_settling(&mut self, pressed: Moment, at: i16, now: Moment) -> Option<Order> {
        let Some(ScalePhase::Settling {
            since,
            felt,
            before,
            ..
        }) = self.phase
        else {
            return None;
        };
        let force = felt.hand.value();
        let force = force.filter(|_| now.since(since) >= MEAN_DURATION);
        let Some(hand_g) = force else {
            return self.late(since, LEG_SPARE, now);
        };
        let is_bent = Angle::MIN.is_reached_at(at);
        let pressed_for = now.since(pressed);
        if !is_bent && pressed_for >= SHORT_DELAY && self.is_short(hand_g) {
            self.counts_zero = true;
            return self.press(now);
        }
        if is_bent || hand_g < CONTACT_G {
            if is_bent || pressed_for > CONTACT_TIMEOUT {
                return self.finish(ScaleEnd::NoContact, now);
            }
            // It may still take up its backlash.
            self.phase = Some(ScalePhase::Pressing { since: pressed });
            return None;
        }
        let is_steady = before.is_some_and(|before| (before - hand_g).abs() <= STEADY_G);
        if is_steady {
            let load = *self.left.front()?;
            self.events.push_back(ScaleEvent::Asked { load, hand_g });
            self.phase = Some(ScalePhase::Asking { since: now, felt });
            return None;
        }
        if pressed_for > SPEED.stroke() + STEADY_TIMEOUT {
            return self.finish(ScaleEnd::Unsteady, now);
        }
        self.phase = Some(ScalePhase::Settling {
            pressed,
            since: now,
            felt: TipFelt::default(),
            before: Some(hand_g),
        });
        None
    }

    /// Opens the joint: completely at first and at the end, and otherwise only off the scale.
    fn open(&mut self, now: Moment) -> Option<Order> {
        let lifted = self.contact.filter(|_| self.ending.is_none());
        let to = lifted.map_or(Angle::MAX, |at| Angle::nearest(at.saturating_add(LIFT)));
        self.phase = Some(ScalePhase::Opening { since: now, to });
        Some(self.go(to, Speed::GENTLE, self.limit))
    }

    /// Presses up to the threshold of the current load.
    fn press(&mut self, now: Moment) -> Option<Order> {
        let threshold = self.threshold_g()?;
        #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
        let threshold = Force::nearest(threshold.round() as i64);
        self.phase = Some(ScalePhase::Pressing { since: now });
        Some(self.go(Angle::MIN, SPEED, threshold))
    }

    /// Threshold of the current load, g. A positive zero is added only once the drive is known to count it: the load exceeds its
    /// own on no hand.
    // Manual 2.6.12: FORCE_SET is compared with FORCE_ACT; whether its offset counts is not stated.
    fn threshold_g(&self) -> Option<f64> {
        let load = *self.left.front()?;
        let load = loads(self.limit).get(load).copied()?;
        let zero_g = if self.counts_zero {
            self.zero_g
        } else {
            self.zero_g.min(0.0)
        };
        Some((f64::from(load.get()) + zero_g).max(LEAST_THRESHOLD_G))
    }

    /// True if the joint stopped at its threshold as FORCE_ACT shows it, and far below it as a load.
    fn is_short(&self, hand_g: f64) -> bool {
        let threshold = self.threshold_g().unwrap_or_default() - SHORT_G;
        !self.counts_zero && hand_g < threshold && hand_g + self.zero_g >= threshold
    }

    fn go(&self, to: Angle, speed: Speed, force: Force) -> Order {
        let mut setpoints = Setpoints::none(self.epoch);
        setpoints.angle[self.dof] = Some(Target::Go(to));
        setpoints.speed[self.dof] = Some(speed);
        setpoints.force[self.dof] = Some(force);
        Order::Set(setpoints)
    }

    /// Lifts the finger off the scale, and ends.
    fn finish(&mut self, end: ScaleEnd, now: Moment) -> Option<Order> {
        self.ending.get_or_insert(end);
        self.open(now)
    }

    /// Ends a step that exceeded its time limit.
    fn late(&mut self, since: Moment, limit: Duration, now: Moment) -> Option<Order> {
        if now.since(since) <= limit {
            return None;
        }
        match self.phase {
            Some(ScalePhase::Opening { .. }) => Some(self.stop(ScaleEnd::Late)),
            _ => self.finish(ScaleEnd::Late, now),
        }
    }

    fn stop(&mut self, end: ScaleEnd) -> Order {
        self.end = Some(Ok(end));
        Order::Stop
    }
}
