//! What the readings of a check-up come to, as figures with units. Judges nothing.

use crate::checkup::steps::{SPEEDS, Step, Way};
use crate::checkup::subject::{Of, Subject};
use crate::hand::statistics::{count, mean, median, spread};
use crate::hand::{Dof, Finger, Group, Groups, HandSample, Moment, PerDof, PerFinger, Timed};
use serde::{Deserialize, Serialize};

/// The angle of an open joint, and counts of POS_ACT for each unit of ANGLE_ACT (manual 2.6.10, 2.6.11).
const OPEN: f64 = 1000.0;
const COUNTS: f64 = 2.0;
/// The middle of a stroke, where a joint goes at its full speed.
const MIDDLE: [f64; 2] = [0.25, 0.75];
/// A channel of a fingertip is dead that never differs in so many readings.
const TIP_READINGS: usize = 20;

/// One figure; `None` where it could not be measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// What was measured.
    pub what: Subject,
    /// Of what.
    pub of: Of,
    /// In the unit of the subject.
    pub value: Option<f64>,
}

/// What was read of the joints at one time; `None` is what this reading had not.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reading {
    at_s: f64,
    position: Option<PerDof<f64>>,
    angle: Option<PerDof<f64>>,
    force: Option<PerDof<f64>>,
    current: Option<PerDof<f64>>,
}

/// The channels of one fingertip at one time, counts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TipReading {
    at_s: f64,
    finger: Finger,
    raw: [u32; 8],
}

/// When a value was true: between question and answer.
fn at_s<T>(read: &Timed<T>) -> f64 {
    f64::midpoint(read.asked.secs(), read.received.secs())
}

impl Reading {
    /// What is new; `None` if nothing of the joints is.
    pub(crate) fn of(sample: &HandSample, fresh: Groups) -> Option<Self> {
        let position = sample.position.filter(|_| fresh.contains(Group::Position));
        let angle = sample.angle.filter(|_| fresh.contains(Group::Angle));
        let force = sample.force.filter(|_| fresh.contains(Group::Force));
        let current = sample.current.filter(|_| fresh.contains(Group::Current));
        let times = [
            position.as_ref().map(at_s),
            angle.as_ref().map(at_s),
            force.as_ref().map(at_s),
            current.as_ref().map(at_s),
        ];
        Some(Self {
            at_s: times.into_iter().flatten().next()?,
            position: position.map(|own| own.value.map(|reading| reading.raw().into())),
            angle: angle.map(|own| own.value.map(|reading| reading.raw().into())),
            force: force.map(|own| own.value.map(|reading| reading.raw().into())),
            current: current.map(|own| own.value.map(|reading| reading.raw().into())),
        })
    }
}

impl TipReading {
    pub(crate) fn of(sample: &HandSample, finger: Finger) -> Option<Self> {
        let block = sample.tactile[finger]?;
        Some(Self {
            at_s: at_s(&block),
            finger,
            raw: block.value.raw,
        })
    }
}

/// What was read in one step.
#[derive(Debug, Clone)]
pub(crate) struct StepRecord {
    pub(crate) step: Step,
    /// When its targets were sent.
    pub(crate) told: Moment,
    pub(crate) readings: Vec<Reading>,
    pub(crate) tips: Vec<TipReading>,
}

/// What the readings give of one quantity of one joint, with their times.
type Line = Vec<(f64, f64)>;

impl StepRecord {
    pub(crate) const fn new(step: Step, told: Moment) -> Self {
        Self {
            step,
            told,
            readings: Vec::new(),
            tips: Vec::new(),
        }
    }

    fn line(&self, dof: Dof, of: fn(&Reading) -> Option<PerDof<f64>>) -> Line {
        let told = self.told.secs();
        let later = self.readings.iter().filter(|own| own.at_s >= told);
        later
            .filter_map(|own| Some((own.at_s, of(own)?[dof])))
            .collect()
    }

    /// What each force sensor says of nothing, g.
    pub(crate) fn zeros(&self) -> PerDof<Option<f64>> {
        PerDof::from_fn(|dof| mean(&values(&self.line(dof, |own| own.force))))
    }

    fn stroke(&self, dof: Dof) -> Stroke {
        let angle = self.line(dof, |own| own.angle);
        // Angles are read often, positions seldom.
        let way = angle
            .iter()
            .map(|(at, angle)| (*at, COUNTS * (OPEN - angle)));
        let way: Line = way.collect();
        let first = way.first().map(|(_, value)| *value);
        let last = way.last().map(|(_, value)| *value);
        let middle = first.zip(last).map(|(first, last)| {
            let inside = |value: f64| {
                let part = (value - first) / (last - first);
                (MIDDLE[0]..=MIDDLE[1]).contains(&part)
            };
            let inside = way.iter().filter(|(_, value)| inside(*value));
            inside.copied().collect::<Line>()
        });
        let middle = middle.unwrap_or_default();
        let fit = fit(&middle);
        let dead_s = fit.zip(first).map(|(fit, first)| {
            let begins = fit.at_s + (first - fit.value) / fit.slope;
            begins - self.told.secs()
        });
        let times = middle.first().zip(middle.last());
        let during = times.map(|((from, _), (to, _))| *from..=*to);
        let current = self.line(dof, |own| own.current).into_iter();
        let current =
            current.filter(|(at, _)| during.as_ref().is_some_and(|during| during.contains(at)));
        let current: Vec<f64> = current.map(|(_, value)| value).collect();
        Stroke {
            end: angle.last().map(|(_, value)| *value),
            speed: fit.map(|fit| fit.slope.abs()),
            dead_ms: dead_s.map(|dead| dead * 1000.0),
            current: mean(&current),
            half_way: crossing(&angle, OPEN / 2.0)
                .and_then(|at| value_at(&self.line(dof, |own| own.position), at)),
        }
    }

    /// How far the others went meanwhile, units of ANGLE_ACT.
    fn others(&self, moved: Dof) -> Option<f64> {
        let others = Dof::ALL.into_iter().filter(|dof| *dof != moved);
        let spans = others.map(|dof| {
            let angles = values(&self.line(dof, |own| own.angle));
            let most = angles.iter().copied().reduce(f64::max)?;
            Some(most - angles.iter().copied().reduce(f64::min)?)
        });
        spans.flatten().reduce(f64::max)
    }
}

/// What one stroke gave.
#[derive(Debug, Clone, Copy)]
struct Stroke {
    /// The angle where it ended.
    end: Option<f64>,
    /// Counts a second.
    speed: Option<f64>,
    /// From the command to the motion of the joint.
    dead_ms: Option<f64>,
    /// mA, at full speed.
    current: Option<f64>,
    /// Counts where the angle is 500.
    half_way: Option<f64>,
}

fn values(line: &Line) -> Vec<f64> {
    line.iter().map(|(_, value)| *value).collect()
}

/// A straight line through points.
#[derive(Debug, Clone, Copy)]
struct Fit {
    at_s: f64,
    value: f64,
    slope: f64,
}

fn fit(line: &Line) -> Option<Fit> {
    if line.len() < 3 {
        return None;
    }
    let at_s = mean(&line.iter().map(|(at, _)| *at).collect::<Vec<_>>())?;
    let value = mean(&values(line))?;
    let across: f64 = line
        .iter()
        .map(|(at, own)| (at - at_s) * (own - value))
        .sum();
    let along: f64 = line.iter().map(|(at, _)| (at - at_s).powi(2)).sum();
    let slope = across / along;
    (slope.is_finite() && slope != 0.0).then_some(Fit { at_s, value, slope })
}

/// When a line crosses a level first.
fn crossing(line: &Line, level: f64) -> Option<f64> {
    line.windows(2).find_map(|pair| {
        let [(from_s, from), (to_s, to)] = *pair else {
            return None;
        };
        let is_between = (from - level) * (to - level) <= 0.0 && from != to;
        is_between.then(|| from_s + (level - from) / (to - from) * (to_s - from_s))
    })
}

fn value_at(line: &Line, at_s: f64) -> Option<f64> {
    line.windows(2).find_map(|pair| {
        let [(from_s, from), (to_s, to)] = *pair else {
            return None;
        };
        let inside = (from_s..=to_s).contains(&at_s) && to_s > from_s;
        inside.then(|| from + (at_s - from_s) / (to_s - from_s) * (to - from))
    })
}

/// What the steps that are over came to.
#[derive(Debug, Clone)]
pub(crate) struct Figures {
    /// Of each joint its strokes: at both speeds, closing and opening.
    strokes: PerDof<Vec<(i16, Way, Stroke)>>,
    others: PerDof<Option<f64>>,
    together: PerDof<Option<f64>>,
    /// At the beginning, and at the end.
    rests: Vec<Rest>,
}

#[derive(Debug, Clone)]
struct Rest {
    at_s: f64,
    zero_g: PerDof<Option<f64>>,
    noise_g: PerDof<Option<f64>>,
    tips: PerFinger<[Option<ChannelRest>; 8]>,
}

#[derive(Debug, Clone, Copy)]
struct ChannelRest {
    mean: f64,
    is_dead: bool,
}

impl Default for Figures {
    fn default() -> Self {
        Self {
            strokes: PerDof::from_fn(|_| Vec::new()),
            others: PerDof::splat(None),
            together: PerDof::splat(None),
            rests: Vec::new(),
        }
    }
}

impl Figures {
    pub(crate) fn add(&mut self, record: &StepRecord) {
        match record.step {
            Step::Open => {}
            Step::Rest => self.rests.push(Rest::of(record)),
            Step::Stroke(dof, speed, way) => {
                self.strokes[dof].push((speed.get(), way, record.stroke(dof)));
                let others = record.others(dof);
                self.others[dof] = self.others[dof].into_iter().chain(others).reduce(f64::max);
            }
            Step::Together(Way::Closing) => {
                self.together = PerDof::from_fn(|dof| record.stroke(dof).speed);
            }
            Step::Together(Way::Opening) => {}
        }
    }

    /// A figure of the strokes of a joint, at both speeds.
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

/// A figure of the strokes of a joint at one speed.
#[derive(Debug, Clone, Copy)]
struct BothWays {
    speed: i16,
    closing: Option<f64>,
    opening: Option<f64>,
}

impl Rest {
    fn of(record: &StepRecord) -> Self {
        let noise = |dof| {
            let forces = values(&record.line(dof, |own| own.force));
            let degrees = count(&forces) - 1.0;
            (degrees >= 1.0).then(|| (spread(&forces) / degrees).sqrt())
        };
        let channel = |finger: Finger, nth: usize| {
            let own = record.tips.iter().filter(|tip| tip.finger == finger);
            let counts: Vec<f64> = own
                .filter_map(|tip| tip.raw.get(nth).copied().map(f64::from))
                .collect();
            let differs = counts.windows(2).any(|pair| pair.first() != pair.last());
            Some(ChannelRest {
                mean: mean(&counts)?,
                is_dead: !differs && counts.len() >= TIP_READINGS,
            })
        };
        let times: Vec<f64> = record.tips.iter().map(|tip| tip.at_s).collect();
        Self {
            at_s: mean(&times).unwrap_or_else(|| record.told.secs()),
            zero_g: record.zeros(),
            noise_g: PerDof::from_fn(noise),
            tips: PerFinger::from_fn(|finger| std::array::from_fn(|nth| channel(finger, nth))),
        }
    }
}

/// All figures; the warmth is that at the beginning and at the end, degrees.
pub(crate) fn figures(
    figures: &Figures,
    [before, after]: [Option<PerDof<Option<u8>>>; 2],
) -> Vec<Measured> {
    let mut all: Vec<Measured> = Vec::new();
    for dof in Dof::ALL {
        let warm = before.and_then(|all| all[dof]).map(f64::from);
        let others = before.map(|all| {
            let known = all.iter().filter_map(|(_, own)| own.map(f64::from));
            known.collect::<Vec<_>>()
        });
        let warmer = warm.zip(others.as_deref().and_then(median));
        let warmed = warm.zip(after.and_then(|all| all[dof]).map(f64::from));
        let of = Of::Joint(dof);
        all.extend(joint(figures, dof).map(|(what, value)| Measured { what, of, value }));
        let heat = [
            (
                Subject::WarmerThanOthers,
                warmer.map(|(own, middle)| own - middle),
            ),
            (
                Subject::WarmedBy,
                warmed.map(|(before, after)| after - before),
            ),
        ];
        all.extend(heat.map(|(what, value)| Measured { what, of, value }));
    }
    for finger in Finger::ALL {
        let of = Of::Fingertip(finger);
        all.extend(fingertip(figures, finger).map(|(what, value)| Measured { what, of, value }));
    }
    all.push(Measured {
        what: Subject::SlowerTogether,
        of: Of::Hand,
        value: slower_together(figures),
    });
    all
}

fn joint(figures: &Figures, dof: Dof) -> [(Subject, Option<f64>); 14] {
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
    // What the drive turns for nothing is no time of the hand's.
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

fn fingertip(figures: &Figures, finger: Finger) -> [(Subject, Option<f64>); 2] {
    let channels = figures.rests.first().map(|rest| rest.tips[finger]);
    let known: Option<Vec<ChannelRest>> = channels.and_then(|all| all.into_iter().collect());
    let dead = known.map(|all| {
        let dead = all.iter().filter(|channel| channel.is_dead);
        dead.map(|_| 1.0).sum()
    });
    let drift = figures.rests.first().zip(figures.rests.get(1));
    let drift = drift.and_then(|(before, after)| {
        let took = after.at_s - before.at_s;
        let pairs = before.tips[finger].iter().zip(after.tips[finger].iter());
        let each = pairs.filter_map(|(before, after)| {
            let change = (*after)?.mean - (*before)?.mean;
            Some((change / took).abs())
        });
        each.reduce(f64::max)
    });
    [
        (Subject::DeadChannels, dead),
        (Subject::ChannelDrift, drift),
    ]
}

/// Percent of their speed that the joints lose when all move.
fn slower_together(figures: &Figures) -> Option<f64> {
    let ratios = Dof::ALL.into_iter().filter_map(|dof| {
        let [alone, _] = figures.of(dof, |own| own.speed);
        Some(figures.together[dof]? / alone.closing?)
    });
    let ratio = median(&ratios.collect::<Vec<_>>())?;
    Some((1.0 - ratio) * 100.0)
}
