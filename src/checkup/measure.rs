//! Figures with units, computed from the readings of a check-up. Judges nothing.

use crate::checkup::steps::{CheckupStep, SPEEDS, Way};
use crate::checkup::subject::{HandPart, Subject};
use crate::checkup::tips::{ChannelSet, TipReading, TipsAtRest, Unpressed};
use crate::hand::grip::FreeClose;
use crate::hand::statistics::{count, mean, median, spread};
use crate::hand::{
    AngleReading, CurrentReading, Dof, Finger, ForceReading, Group, Groups, HandSample, Moment,
    PerDof, PositionReading, Timed,
};
use crate::trials::measure::curve::{CurvePoint, TimeSeries};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Counts of POS_ACT for each unit of ANGLE_ACT (manual 2.6.10, 2.6.11).
const COUNTS: f64 = 2.0;
/// The angle at which the closing and the opening position are compared.
const HALF_WAY: f64 = 500.0;
/// The middle of a stroke, where a joint moves at full speed.
const MIDDLE: RangeInclusive<f64> = 0.25..=0.75;
/// A joint met something if its force is this far above its zero before it is nearly bent, g. A nearly bent joint may meet the palm.
const MET_G: f64 = 80.0;
const NEARLY_BENT: f64 = 100.0;

/// One figure; `None` where it could not be measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    pub what: Subject,
    /// The joint, the fingertip or the hand.
    pub of: HandPart,
    /// In the unit of its subject.
    pub value: Option<f64>,
    /// The channels counted by a figure of a fingertip.
    #[serde(default, skip_serializing_if = "ChannelSet::is_empty")]
    pub channels: ChannelSet,
}

impl Measured {
    /// A figure without channels.
    pub fn new(what: Subject, of: HandPart, value: Option<f64>) -> Self {
        let channels = ChannelSet::default();
        Self {
            what,
            of,
            value,
            channels,
        }
    }

    /// A figure that counts channels of a fingertip.
    fn counted(what: Subject, finger: Finger, channels: Option<ChannelSet>) -> Self {
        Self {
            channels: channels.unwrap_or_default(),
            ..Self::new(
                what,
                HandPart::Fingertip(finger),
                channels.map(ChannelSet::count),
            )
        }
    }
}

/// Joint values read at one time; `None` for a group that this reading lacks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointReadings {
    at_s: f64,
    position: Option<PerDof<f64>>,
    angle: Option<PerDof<f64>>,
    force: Option<PerDof<f64>>,
    current: Option<PerDof<f64>>,
}

/// Time of a value, s: midway between request and reply.
fn at_s<T>(read: &Timed<T>) -> f64 {
    f64::midpoint(read.asked.secs(), read.received.secs())
}

impl JointReadings {
    /// The fresh groups of a sample; `None` if no joint group is fresh.
    pub(crate) fn of(sample: &HandSample, fresh: Groups) -> Option<Self> {
        fn raw<T: Copy>(read: Timed<PerDof<T>>, raw: fn(T) -> i16) -> (f64, PerDof<f64>) {
            (at_s(&read), read.value.map(|own| raw(own).into()))
        }
        let new = |group| fresh.contains(group);
        let position = sample.position.filter(|_| new(Group::Position));
        let position = position.map(|read| raw(read, PositionReading::raw));
        let angle = sample.angle.filter(|_| new(Group::Angle));
        let angle = angle.map(|read| raw(read, AngleReading::raw));
        let force = sample.force.filter(|_| new(Group::Force));
        let force = force.map(|read| raw(read, ForceReading::raw));
        let current = sample.current.filter(|_| new(Group::Current));
        let current = current.map(|read| raw(read, CurrentReading::raw));
        let all = [position, angle, force, current];
        Some(Self {
            at_s: all.into_iter().flatten().map(|(at_s, _)| at_s).next()?,
            position: position.map(|(_, six)| six),
            angle: angle.map(|(_, six)| six),
            force: force.map(|(_, six)| six),
            current: current.map(|(_, six)| six),
        })
    }
}

/// Readings of one step.
#[derive(Debug, Clone)]
pub(crate) struct StepRecord {
    pub(crate) step: CheckupStep,
    /// Time at which its targets were sent.
    pub(crate) sent: Moment,
    pub(crate) readings: Vec<JointReadings>,
    pub(crate) tips: Vec<TipReading>,
    /// Drive temperatures at the end of a rest, °C; `None` for other steps.
    pub(crate) warmth: Option<PerDof<Option<u8>>>,
}

impl StepRecord {
    pub(crate) const fn new(step: CheckupStep, sent: Moment) -> Self {
        Self {
            step,
            sent,
            readings: Vec::new(),
            tips: Vec::new(),
            warmth: None,
        }
    }

    /// One quantity of a joint from the command on; times by the program's clock.
    fn curve(&self, dof: Dof, of: fn(&JointReadings) -> Option<PerDof<f64>>) -> TimeSeries {
        let sent = self.sent.secs();
        let later = self.readings.iter().filter(|own| own.at_s >= sent);
        later
            .filter_map(|own| Some((own.at_s, of(own)?[dof])))
            .collect()
    }

    /// The force of a joint above its zero on the way, by angle.
    pub(crate) fn free_close(&self, dof: Dof, zero_g: f64) -> FreeClose {
        // Angle and force may have been read one after the other.
        let angle = self.curve(dof, |own| own.angle);
        let mut close = FreeClose::default();
        for force in self.curve(dof, |own| own.force).points() {
            if let Some(angle) = angle.at(force.t) {
                #[expect(clippy::cast_possible_truncation, reason = "both were 16 bits")]
                close.push(angle as i16, (force.v - zero_g) as f32);
            }
        }
        close
    }

    /// Mean reading of a force sensor from `since` on, g.
    pub(crate) fn mean_force(&self, dof: Dof, since: Moment) -> Option<f64> {
        let force = self.curve(dof, |own| own.force);
        let later = force.points().iter();
        let later = later.filter(|own| own.t >= since.secs());
        mean(&later.map(|own| own.v).collect::<Vec<_>>())
    }

    /// Reading of each force sensor at rest, g.
    pub(crate) fn zeros(&self) -> PerDof<Option<f64>> {
        PerDof::from_fn(|dof| mean(&values(&self.curve(dof, |own| own.force))))
    }

    /// The angle at which a closing joint pressed on something before it was nearly bent, and the force above its zero, g.
    pub(crate) fn met(&self, dof: Dof, zero_g: f64) -> Option<(f64, f64)> {
        let angle = self.curve(dof, |own| own.angle);
        let force = self.curve(dof, |own| own.force);
        let pressed = force.points().windows(3).filter_map(|own| {
            let rise = mean(&own.iter().map(|point| point.v).collect::<Vec<_>>())? - zero_g;
            let at = angle.at(own.last()?.t)?;
            (at >= NEARLY_BENT && rise >= MET_G).then_some((at, rise))
        });
        pressed.reduce(|most, own| if own.1 > most.1 { own } else { most })
    }

    fn stroke(&self, dof: Dof) -> Stroke {
        let angle = self.curve(dof, |own| own.angle);
        // Angles are read often, positions rarely.
        let ends = angle.points().first().zip(angle.points().last());
        let part =
            |at: &CurvePoint| ends.map(|(first, last)| (at.v - first.v) / (last.v - first.v));
        let is_middle = |at: &CurvePoint| part(at).is_some_and(|part| MIDDLE.contains(&part));
        let middle: Vec<CurvePoint> = angle.points().iter().copied().filter(is_middle).collect();
        let fit = LineFit::of(&middle);
        let begins_s = fit
            .zip(ends)
            .map(|(fit, (first, _))| fit.at_s + (first.v - fit.value) / fit.slope);
        let during = middle.first().zip(middle.last());
        let current = during.map(|(from, to)| {
            let current = self.curve(dof, |own| own.current);
            current.values(from.t, to.t)
        });
        let position = self.curve(dof, |own| own.position);
        Stroke {
            end: ends.map(|(_, last)| last.v),
            speed: fit.map(|fit| COUNTS * fit.slope.abs()),
            dead_ms: begins_s.map(|begins| 1000.0 * (begins - self.sent.secs())),
            current: current.as_deref().and_then(mean),
            half_way: crossing(&angle, HALF_WAY).and_then(|at| position.at(at)),
        }
    }

    /// The largest motion of the other joints meanwhile, units of ANGLE_ACT.
    fn others(&self, moved: Dof) -> Option<f64> {
        let others = Dof::ALL.into_iter().filter(|dof| *dof != moved);
        let spans = others.map(|dof| {
            let angles = values(&self.curve(dof, |own| own.angle));
            let most = angles.iter().copied().reduce(f64::max)?;
            Some(most - angles.iter().copied().reduce(f64::min)?)
        });
        spans.flatten().reduce(f64::max)
    }
}

/// Measurements of one stroke.
#[derive(Debug, Clone, Copy)]
struct Stroke {
    /// The angle at its end.
    end: Option<f64>,
    /// Counts a second.
    speed: Option<f64>,
    /// From the command until the joint moves.
    dead_ms: Option<f64>,
    /// mA, at full speed.
    current: Option<f64>,
    /// Counts where the angle is 500.
    half_way: Option<f64>,
}

fn values(curve: &TimeSeries) -> Vec<f64> {
    curve.points().iter().map(|point| point.v).collect()
}

/// A straight line fitted to points by least squares.
#[derive(Debug, Clone, Copy)]
struct LineFit {
    at_s: f64,
    value: f64,
    slope: f64,
}

impl LineFit {
    fn of(points: &[CurvePoint]) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let at_s = mean(&points.iter().map(|point| point.t).collect::<Vec<_>>())?;
        let value = mean(&points.iter().map(|point| point.v).collect::<Vec<_>>())?;
        let away = |point: &CurvePoint| (point.t - at_s, point.v - value);
        let across: f64 = points.iter().map(away).map(|(t, v)| t * v).sum();
        let along: f64 = points.iter().map(away).map(|(t, _)| t * t).sum();
        let slope = across / along;
        (slope.is_finite() && slope != 0.0).then_some(Self { at_s, value, slope })
    }
}

/// Time at which a curve first crosses a level, in either direction, interpolated between readings.
fn crossing(curve: &TimeSeries, level: f64) -> Option<f64> {
    curve.points().windows(2).find_map(|pair| {
        let [from, to] = pair else { return None };
        let is_between = (from.v - level) * (to.v - level) <= 0.0 && from.v != to.v;
        is_between.then(|| from.t + (level - from.v) / (to.v - from.v) * (to.t - from.t))
    })
}

/// Results of the finished steps.
#[derive(Debug, Clone)]
pub(crate) struct StepResults {
    /// Strokes of each joint: at both speeds, closing and opening.
    strokes: PerDof<Vec<(i16, Way, Stroke)>>,
    others: PerDof<Option<f64>>,
    together: PerDof<Option<f64>>,
    /// One at the beginning and one at the end.
    rests: Vec<RestValues>,
    /// For each fingertip that had to be pressed, its readings meanwhile.
    presses: Vec<(Finger, Vec<TipReading>)>,
}

#[derive(Debug, Clone)]
struct RestValues {
    zero_g: PerDof<Option<f64>>,
    noise_g: PerDof<Option<f64>>,
    tips: TipsAtRest,
    warmth: PerDof<Option<f64>>,
}

impl Default for StepResults {
    fn default() -> Self {
        Self {
            strokes: PerDof::from_fn(|_| Vec::new()),
            others: PerDof::splat(None),
            together: PerDof::splat(None),
            rests: Vec::new(),
            presses: Vec::new(),
        }
    }
}

impl StepResults {
    pub(crate) fn add(&mut self, record: &StepRecord) {
        match record.step {
            CheckupStep::Open => {}
            CheckupStep::Rest => self.rests.push(RestValues::of(record)),
            CheckupStep::Stroke(dof, speed, way) => {
                self.strokes[dof].push((speed.get(), way, record.stroke(dof)));
                let others = record.others(dof);
                self.others[dof] = self.others[dof].into_iter().chain(others).reduce(f64::max);
            }
            CheckupStep::Together(Way::Closing) => {
                self.together = PerDof::from_fn(|dof| record.stroke(dof).speed);
            }
            CheckupStep::Together(Way::Opening) => {}
            CheckupStep::Press(finger) => self.presses.push((finger, record.tips.clone())),
        }
    }

    /// Expected readings of untouched fingertips; `None` before the last rest.
    pub(crate) fn unpressed(&self) -> Option<Unpressed<'_>> {
        let [first, last] = self.rests.as_slice() else {
            return None;
        };
        let (first, last) = (&first.tips, &last.tips);
        Some(Unpressed { first, last })
    }

    /// One figure of a joint's strokes, at both speeds.
    fn of(&self, dof: Dof, get: fn(&Stroke) -> Option<f64>) -> [BothWays; 2] {
        let find = |wanted_speed, wanted_way| {
            let mut own = self.strokes[dof].iter();
            let found = own.find(|(speed, way, _)| (*speed, *way) == (wanted_speed, wanted_way));
            found.and_then(|(_, _, stroke)| get(stroke))
        };
        SPEEDS.map(|speed| BothWays {
            speed,
            closing: find(speed, Way::Closing),
            opening: find(speed, Way::Opening),
        })
    }
}

/// One figure of a joint's strokes at one speed.
#[derive(Debug, Clone, Copy)]
struct BothWays {
    speed: i16,
    closing: Option<f64>,
    opening: Option<f64>,
}

impl RestValues {
    fn of(record: &StepRecord) -> Self {
        let noise = |dof| {
            let forces = values(&record.curve(dof, |own| own.force));
            let degrees = count(&forces) - 1.0;
            (degrees >= 1.0).then(|| (spread(&forces) / degrees).sqrt())
        };
        Self {
            zero_g: record.zeros(),
            noise_g: PerDof::from_fn(noise),
            tips: TipsAtRest::of(&record.tips, record.sent.secs()),
            warmth: PerDof::from_fn(|dof| record.warmth?[dof].map(f64::from)),
        }
    }
}

/// All figures; with `presses`, also the channels that do not answer a press.
pub(crate) fn measured(figures: &StepResults, presses: bool) -> Vec<Measured> {
    let joints = Dof::ALL.into_iter().flat_map(|dof| {
        let all = joint(figures, dof).into_iter().chain(heat(figures, dof));
        all.map(move |(what, value)| Measured::new(what, HandPart::Joint(dof), value))
    });
    let tips = Finger::ALL.into_iter().flat_map(|finger| {
        let pressed = presses.then(|| pressed(figures, finger));
        fingertip(figures, finger).into_iter().chain(pressed)
    });
    let together = slower_together(figures);
    let hand = Measured::new(Subject::SlowerTogether, HandPart::Hand, together);
    joints.chain(tips).chain([hand]).collect()
}

fn heat(figures: &StepResults, dof: Dof) -> [(Subject, Option<f64>); 2] {
    let at = |nth: usize| figures.rests.get(nth).map(|rest| &rest.warmth);
    let own = at(0).and_then(|all| all[dof]);
    let all: Option<Vec<f64>> = at(0).map(|all| all.iter().filter_map(|(_, own)| *own).collect());
    let middle = all.as_deref().and_then(median);
    let later = at(1).and_then(|all| all[dof]);
    [
        (
            Subject::WarmerThanOthers,
            own.zip(middle).map(|(own, middle)| own - middle),
        ),
        (
            Subject::WarmedBy,
            own.zip(later).map(|(own, later)| later - own),
        ),
    ]
}

fn joint(figures: &StepResults, dof: Dof) -> [(Subject, Option<f64>); 14] {
    let [ends, _] = figures.of(dof, |own| own.end);
    let [half_way, _] = figures.of(dof, |own| own.half_way);
    let backlash = half_way.closing.zip(half_way.opening);
    let [current, fast_current] = figures.of(dof, |own| own.current);
    let per_speed = current.closing.zip(fast_current.closing);
    let faster = f64::from(fast_current.speed - current.speed);
    let speeds = figures.of(dof, |own| own.speed);
    let law = |way: fn(&BothWays) -> Option<f64>| {
        let per_unit = speeds
            .iter()
            .filter_map(|own| Some(way(own)? / f64::from(own.speed)));
        mean(&per_unit.collect::<Vec<_>>())
    };
    // The time in which the drive takes up slack is not dead time of the hand.
    let slack = backlash.map_or(0.0, |(closing, opening)| (closing - opening).max(0.0));
    let own = figures.strokes[dof].iter().map(|(_, _, stroke)| stroke);
    let dead = own.filter_map(|own| Some(own.dead_ms? - 1000.0 * slack / own.speed?));
    let dead: Vec<f64> = dead.collect();
    let scatter = (dead.len() >= 3).then(|| (spread(&dead) / (count(&dead) - 1.0)).sqrt());
    let first = figures.rests.first();
    let last = figures.rests.get(1);
    let zero = first.and_then(|rest| rest.zero_g[dof]);
    let drift = last.and_then(|rest| rest.zero_g[dof]).zip(zero);
    [
        (Subject::OpenEnd, ends.opening),
        (Subject::BentEnd, ends.closing),
        (
            Subject::Backlash,
            backlash.map(|(closing, opening)| closing - opening),
        ),
        (Subject::ClosingCurrent, current.closing),
        (Subject::OpeningCurrent, current.opening),
        (
            Subject::CurrentPerSpeed,
            per_speed.map(|(at_slow, at_fast)| (at_fast - at_slow) / faster),
        ),
        (Subject::ClosingSpeed, law(|own| own.closing)),
        (Subject::OpeningSpeed, law(|own| own.opening)),
        (Subject::DeadTime, mean(&dead)),
        (Subject::DeadTimeScatter, scatter),
        (Subject::OthersMoved, figures.others[dof]),
        (Subject::ForceZero, zero),
        (
            Subject::ForceNoise,
            first.and_then(|rest| rest.noise_g[dof]),
        ),
        (
            Subject::ForceDrift,
            drift.map(|(after, before)| after - before),
        ),
    ]
}

fn fingertip(figures: &StepResults, finger: Finger) -> [Measured; 3] {
    let first = figures.rests.first().map(|rest| &rest.tips);
    let dead = first.and_then(|tips| tips.dead(finger));
    let noisy = first.and_then(|tips| tips.noisy(finger));
    let last = figures.rests.get(1).map(|rest| &rest.tips);
    let drift = first.zip(last);
    let drift = drift.and_then(|(before, after)| before.drift(after, finger));
    [
        Measured::counted(Subject::DeadChannels, finger, dead),
        Measured::counted(Subject::NoisyChannels, finger, noisy),
        Measured::new(Subject::ChannelDrift, HandPart::Fingertip(finger), drift),
    ]
}

fn pressed(figures: &StepResults, finger: Finger) -> Measured {
    let mut presses = figures.presses.iter();
    let own = presses.find(|(pressed, _)| *pressed == finger);
    let silent = own
        .zip(figures.unpressed())
        .and_then(|((_, readings), unpressed)| unpressed.silent(readings, finger));
    Measured::counted(Subject::SilentChannels, finger, silent)
}

/// Median loss of speed when all joints move together, percent.
fn slower_together(figures: &StepResults) -> Option<f64> {
    let ratios = Dof::ALL.into_iter().filter_map(|dof| {
        let [alone, _] = figures.of(dof, |own| own.speed);
        Some(figures.together[dof]? / alone.closing?)
    });
    let ratio = median(&ratios.collect::<Vec<_>>())?;
    Some((1.0 - ratio) * 100.0)
}
