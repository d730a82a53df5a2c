//! Readings that end a trial early: faults, heat, force, outdated or implausible values. Pure; stops nothing itself.

use crate::hand::heat::HOT;
use crate::hand::{Dof, HandSample, Moment, PerDof, Timed};
use crate::record::Abort;
use crate::trials::plan::Limits;
use std::time::Duration;

/// Forces and angles older than this are outdated; a trial must not continue with them.
pub const READING_MAX_AGE: Duration = Duration::from_millis(600);
/// On a slow line, fault reads alternate with fingertip reads during motion.
pub const FAULT_MAX_AGE: Duration = Duration::from_secs(2);
/// Grace time for readings after a stall of the program.
const CATCH_UP: Duration = Duration::from_millis(150);
/// Temperatures are read less often.
pub const HEAT_MAX_AGE: Duration = Duration::from_secs(3);

/// An interval in which this program did not run: the computer was busy, or the program's output was blocked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TaskStall {
    pub lasted: Duration,
    pub ended: Moment,
}

impl TaskStall {
    /// Extra age allowed for readings shortly after a stall: the replies that arrived during it are still unread.
    fn excuses(self, now: Moment) -> Duration {
        if now.since(self.ended) <= CATCH_UP {
            self.lasted
        } else {
            Duration::ZERO
        }
    }
}

/// The first reason to end the trial now, gravest first.
pub fn reason(seen: &Feedback<'_>, limits: &Limits) -> Option<Abort> {
    fault(seen.sample)
        .or_else(|| blind(seen))
        .or_else(|| ceiling(seen, limits.ceiling_g))
        .or_else(|| heat(seen.sample, limits.stop_c))
}

/// The reason after the link disarmed a hand for heat, if a reading shows it.
pub fn heat_reason(sample: &HandSample, stall: Option<TaskStall>, now: Moment) -> Option<Abort> {
    let rest_g = &PerDof::splat(None);
    let seen = Feedback {
        sample,
        rest_g,
        stall,
        now,
    };
    blind(&seen).or_else(|| heat(sample, HOT))
}

/// The readings, and the time of the judgement.
#[derive(Debug, Clone, Copy)]
pub struct Feedback<'a> {
    /// The newest readings.
    pub sample: &'a HandSample,
    /// Force of each joint at rest, g; `None` until it is known.
    pub rest_g: &'a PerDof<Option<f64>>,
    /// The last stall of the program.
    pub stall: Option<TaskStall>,
    pub now: Moment,
}

/// The first joint that reports a fault.
pub fn fault(sample: &HandSample) -> Option<Abort> {
    let faults = sample.faults?.value;
    let (dof, faults) = faults.iter().find(|(_, faults)| !faults.is_empty())?;
    let joint = Some((dof, *faults));
    Some(Abort::Fault { joint })
}

/// The first group whose readings are missing or outdated.
fn not_watched(seen: &Feedback<'_>) -> Option<Abort> {
    fn age<T>(group: &Option<Timed<T>>, now: Moment) -> Option<Duration> {
        group.as_ref().map(|group| group.age(now))
    }
    let Feedback {
        sample, stall, now, ..
    } = *seen;
    let excused = stall.map_or(Duration::ZERO, |stall| stall.excuses(now));
    let groups = [
        ("angle", age(&sample.angle, now), READING_MAX_AGE),
        ("force", age(&sample.force, now), READING_MAX_AGE),
        ("fault", age(&sample.faults, now), FAULT_MAX_AGE),
        ("temperature", age(&sample.temperature, now), HEAT_MAX_AGE),
    ];
    let mut groups = groups.into_iter();
    let (what, age, _) =
        groups.find(|(_, age, most)| age.is_none_or(|age| age > *most + excused))?;
    // Only a stall since the last reading is its cause.
    let stall = stall.filter(|stall| age.is_some_and(|age| now.since(stall.ended) < age));
    Some(Abort::NotRead {
        what,
        age,
        stall: stall.map(|stall| stall.lasted),
    })
}

fn blind(seen: &Feedback<'_>) -> Option<Abort> {
    if let Some(why) = not_watched(seen) {
        return Some(why);
    }
    let sample = seen.sample;
    let forces = sample.force?.value;
    let senseless = forces
        .iter()
        .find(|(_, force)| force.documented().is_none());
    if let Some((dof, _)) = senseless {
        return Some(Abort::Blind { what: "force", dof });
    }
    let temperatures = sample.temperature?.value;
    let mut unknown = temperatures.iter();
    let (dof, _) = unknown.find(|(_, celsius)| celsius.documented().is_none())?;
    Some(Abort::Blind {
        what: "temperature",
        dof,
    })
}

fn ceiling(seen: &Feedback<'_>, ceiling: i16) -> Option<Abort> {
    let forces = seen.sample.force?.value;
    let above = |dof: Dof, raw: i16| f64::from(raw) - seen.rest_g[dof].unwrap_or(0.0);
    let (dof, grams) = forces
        .iter()
        .map(|(dof, force)| (dof, above(dof, force.raw())))
        .find(|(_, grams)| *grams >= f64::from(ceiling))?;
    // The sensor's range is a few thousand grams either way.
    #[expect(clippy::cast_possible_truncation, reason = "a float cast saturates")]
    let grams = grams.round() as i32;
    Some(Abort::Ceiling {
        dof,
        grams,
        ceiling,
    })
}

fn heat(sample: &HandSample, limit: u8) -> Option<Abort> {
    let (dof, celsius) = warmest(sample)?;
    (celsius >= limit).then_some(Abort::Heat {
        dof,
        celsius,
        limit,
    })
}

/// The warmest joint with a plausible temperature.
pub fn warmest(sample: &HandSample) -> Option<(Dof, u8)> {
    let temperatures = sample.temperature?.value;
    temperatures
        .iter()
        .filter_map(|(dof, celsius)| Some((dof, celsius.documented()?)))
        .max_by_key(|(_, celsius)| *celsius)
}
