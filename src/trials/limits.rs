//! What ends a trial before its time: faults, heat, force, a lost or disarmed link, old readings. Pure; stops nothing itself.

use crate::hand::heat::HOT;
use crate::hand::{ArmEpoch, Dof, Fault, Faults, HandSample, Moment, PerDof, Timed};
use crate::record::{Disarmed, LinkState, SetpointConflict};
use crate::trials::plan::Limits;
use std::time::Duration;

/// Forces and angles older than this are not watched any more, so nothing may go on by them.
pub const BLIND_AFTER: Duration = Duration::from_millis(600);
/// On a slow line faults take turns with the fingertips while something moves.
pub const FAULT_BLIND_AFTER: Duration = Duration::from_secs(2);
/// After a time in which this program did not run, readings are awaited for so long.
const CATCH_UP: Duration = Duration::from_millis(150);
/// Temperatures are read more seldom.
pub const HEAT_BLIND_AFTER: Duration = Duration::from_secs(3);

/// Why a trial, and its series, ended early. Only the user who arms starts another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Abort {
    /// The user ended it.
    #[error("ended by a person")]
    Person,
    /// Stop, disarming, old feedback.
    #[error("the hand is no longer armed{}", why.map(|why| format!(": {why}")).unwrap_or_default())]
    Disarmed {
        /// As the link has it.
        why: Option<Disarmed>,
    },
    /// Another arming is not the one that the user gave for this.
    #[error("the hand was armed anew")]
    ArmedAnew,
    /// Another controller talks to the hand.
    #[error("another controller {}", wrote.map_or_else(|| "talks to the hand".into(), |wrote| format!("wrote {wrote}")))]
    OtherController {
        /// What it was seen to write; `None` if it was only heard.
        wrote: Option<SetpointConflict>,
    },
    /// The link was lost. Where the hand is now is not known.
    #[error("the link was lost")]
    LinkLost,
    /// A drive reports a fault.
    #[error("{} reports a fault: {}", dof.name(), faults.iter().map(Fault::name).collect::<Vec<_>>().join(", "))]
    Fault {
        /// The first such joint.
        dof: Dof,
        faults: Faults,
    },
    /// A joint is as warm as the limit.
    #[error("{} is at {celsius} °C, the limit is {limit}", dof.name())]
    Heat {
        /// The joint.
        dof: Dof,
        /// Its temperature.
        celsius: u8,
        limit: u8,
    },
    /// The force of a joint reached the ceiling.
    #[error("{} presses with {grams} g, the ceiling is {ceiling}", dof.name())]
    Ceiling {
        /// The joint.
        dof: Dof,
        /// Force above its reading at rest.
        grams: i32,
        ceiling: i16,
    },
    /// A joint did not reach its target in time.
    #[error("{} did not reach {target} in time", dof.name())]
    Unreached {
        /// The joint.
        dof: Dof,
        /// Where it should be.
        target: i16,
    },
    /// The speed and threshold that were set are not confirmed by reading back.
    #[error("the hand does not confirm the speed and force threshold that were set for {}", dof.name())]
    LimitsRefused {
        /// The joint.
        dof: Dof,
    },
    /// Readings of all joints that the limits depend on are missing or old.
    #[error("the {what} readings cannot be watched: {}", not_read(*age, *stall))]
    NotRead {
        what: &'static str,
        /// How old the last is; `None` if none came.
        age: Option<Duration>,
        /// How long this program did not run meanwhile, if that is why.
        stall: Option<Duration>,
    },
    /// A reading that the limits depend on makes no sense.
    #[error("the {what} of {} cannot be watched: it makes no sense", dof.name())]
    Blind {
        what: &'static str,
        /// The joint.
        dof: Dof,
    },
    /// The hand stayed too warm to begin.
    #[error("{} stayed at {celsius} °C or more; trials begin below {limit}", dof.name())]
    TooWarm {
        /// The joint.
        dof: Dof,
        /// Its temperature.
        celsius: u8,
        /// Where it may begin.
        limit: u8,
    },
    /// The samples could not be stored or shown.
    #[error("the samples could not be stored or shown")]
    NotKept,
    /// A joint of a hand that should be empty pressed on something.
    #[error("the hand is not empty, or something is in its way: {} pressed with {grams} g at {angle}", dof.name())]
    NotEmpty {
        /// The joint.
        dof: Dof,
        /// Where, units of ANGLE_ACT.
        angle: i16,
        /// Force above its reading at rest.
        grams: i16,
    },
    /// The slow trial that should measure the contact found none.
    #[error("{} found no contact to approach", dof.name())]
    NoContact {
        /// The joint.
        dof: Dof,
    },
}

/// Why readings are old, in words.
fn not_read(age: Option<Duration>, stall: Option<Duration>) -> String {
    match (age, stall) {
        (None, _) => "none came yet".into(),
        (Some(age), None) => format!(
            "the last is {:.1} s old, and the hand sends no newer one in time",
            age.as_secs_f64()
        ),
        (Some(age), Some(stall)) => format!(
            "the last is {:.1} s old, because this computer was busy: the program did not run for {:.1} s",
            age.as_secs_f64(),
            stall.as_secs_f64()
        ),
    }
}

/// A time in which this program did not run: the computer was busy with something else, or its output was not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stall {
    pub lasted: Duration,
    pub ended: Moment,
}

impl Stall {
    /// How much older readings may be so soon after it: what the hand sent meanwhile is still to be read.
    fn excuses(self, now: Moment) -> Duration {
        if now.since(self.ended) <= CATCH_UP {
            self.lasted
        } else {
            Duration::ZERO
        }
    }
}

/// The link as a trial sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkView {
    /// Where it stands.
    pub state: LinkState,
    /// The current arming.
    pub armed: Option<ArmEpoch>,
    /// Why the hand is not armed, if it was.
    pub disarmed: Option<Disarmed>,
    /// What another controller was last seen to write.
    pub foreign_setpoint: Option<SetpointConflict>,
    /// The last time in which this program did not run.
    pub stall: Option<Stall>,
}

impl LinkView {
    /// Why this arming is over, if it is.
    pub(crate) fn arming_ended(&self, epoch: ArmEpoch) -> Option<Abort> {
        if self.armed.is_some() {
            return (self.armed != Some(epoch)).then_some(Abort::ArmedAnew);
        }
        Some(if self.disarmed == Some(Disarmed::OtherController) {
            Abort::OtherController {
                wrote: self.foreign_setpoint,
            }
        } else {
            Abort::Disarmed { why: self.disarmed }
        })
    }
}

/// The first reason to end now, gravest first.
pub fn reason(
    link: LinkView,
    epoch: ArmEpoch,
    seen: &Feedback<'_>,
    limits: &Limits,
) -> Option<Abort> {
    if !link.state.is_live() {
        return Some(Abort::LinkLost);
    }
    // Heat disarms as well; the reading says more than that.
    let by_heat = matches!(link.disarmed, Some(Disarmed::Hot | Disarmed::HeatUnknown));
    let by_heat = link.armed.is_none() && by_heat;
    let heated = by_heat.then(|| blind(seen, link.stall).or_else(|| heat(seen.sample, HOT)));
    fault(seen.sample)
        .or(heated.flatten())
        .or_else(|| link.arming_ended(epoch))
        .or_else(|| blind(seen, link.stall))
        .or_else(|| ceiling(seen, limits.ceiling_g))
        .or_else(|| heat(seen.sample, limits.stop_c))
}

/// The readings, and the time at which they are judged.
#[derive(Debug, Clone, Copy)]
pub struct Feedback<'a> {
    /// The newest of everything.
    pub sample: &'a HandSample,
    /// Force of each joint at rest, g, once it is known.
    pub rest_g: &'a PerDof<Option<f64>>,
    pub now: Moment,
}

fn fault(sample: &HandSample) -> Option<Abort> {
    let faults = sample.faults?.value;
    let (dof, faults) = faults.iter().find(|(_, faults)| !faults.is_empty())?;
    let faults = *faults;
    Some(Abort::Fault { dof, faults })
}

/// The first group whose readings are missing or too old.
fn not_watched(seen: &Feedback<'_>, stall: Option<Stall>) -> Option<Abort> {
    fn age<T>(group: &Option<Timed<T>>, now: Moment) -> Option<Duration> {
        group.as_ref().map(|group| group.age(now))
    }
    let Feedback { sample, now, .. } = *seen;
    let excused = stall.map_or(Duration::ZERO, |stall| stall.excuses(now));
    let groups = [
        ("angle", age(&sample.angle, now), BLIND_AFTER),
        ("force", age(&sample.force, now), BLIND_AFTER),
        ("fault", age(&sample.faults, now), FAULT_BLIND_AFTER),
        (
            "temperature",
            age(&sample.temperature, now),
            HEAT_BLIND_AFTER,
        ),
    ];
    let mut groups = groups.into_iter();
    let (what, age, _) =
        groups.find(|(_, age, most)| age.is_none_or(|age| age > *most + excused))?;
    // Only what was in the time since the last reading is its cause.
    let stall = stall.filter(|stall| age.is_some_and(|age| now.since(stall.ended) < age));
    Some(Abort::NotRead {
        what,
        age,
        stall: stall.map(|stall| stall.lasted),
    })
}

fn blind(seen: &Feedback<'_>, stall: Option<Stall>) -> Option<Abort> {
    if let Some(why) = not_watched(seen, stall) {
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
    // The sensor's range is some thousand grams either way.
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

/// The warmest joint whose temperature makes sense.
pub fn warmest(sample: &HandSample) -> Option<(Dof, u8)> {
    let temperatures = sample.temperature?.value;
    temperatures
        .iter()
        .filter_map(|(dof, celsius)| Some((dof, celsius.documented()?)))
        .max_by_key(|(_, celsius)| *celsius)
}
