//! What one recorded close says about a joint and the object. Pure.

use crate::hand::statistics::median;
use crate::hand::{Dof, Status};
use crate::trials::measure::curve::{JointCurves, TimeSeries};
use crate::trials::measure::metrics::JointMetrics;
use crate::trials::recording::{TrialEvent, seconds};
use crate::trials::summary::Trial;

/// The last part of the dwell in which the joint is taken to rest, s.
const REST_S: f64 = 0.3;
/// The least way into an object that tells its stiffness, units of ANGLE_ACT; an angle is a whole number.
const PRESSED_LEAST: f64 = 4.0;

/// Readings of the force no further apart than this miss no peak: a grip stays where the impact took it for longer, s.
pub(crate) const GAP_S: f64 = 0.025;
/// So many times what is usual between two readings, a gap is unusual.
const GAP_TIMES: f64 = 2.5;
/// A peak may come this long after the drive reports its stop, s: a report is not read at once.
const PEAK_LATE_S: f64 = 0.05;
/// A reading after the highest that is lower than this share of it: the impact was shorter than the time between two.
const BRIEF_BELOW: f64 = 0.7;
/// So much lower, as a multiple of the noise and some grams, it is no noise.
const BRIEF_SIGMAS: f64 = 6.0;
const BRIEF_G: f64 = 20.0;

/// One joint in one close. Forces are above the reading at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloseFacts {
    pub dof: Dof,
    /// It was told to close and never moved.
    pub is_dead: bool,
    /// Its drive reports that a force stopped it.
    pub stopped_by_force: bool,
    /// The fingertip felt something before it moved.
    pub touched_before: bool,
    /// Where it met the object, units of ANGLE_ACT.
    pub contact: Option<f64>,
    /// From the command to the contact, s.
    pub to_contact_s: Option<f64>,
    /// From the command to the motion, s.
    pub dead_time_s: Option<f64>,
    /// From the command to the stop, s.
    pub close_s: Option<f64>,
    /// From the order to go on slowly to the stop, s; `None` in one stage.
    pub slow_s: Option<f64>,
    /// Highest force, g.
    pub peak_g: Option<f64>,
    /// What that may have been more between two readings, g.
    pub missed_g: f64,
    /// The readings stopped at the peak for longer than they usually do: what it was is not known.
    pub is_uncertain: bool,
    /// What the force sensor read at rest, g.
    pub offset_g: f64,
    /// The sensor was at its end.
    pub is_clipped: bool,
    /// What was left at the end of the dwell, g.
    pub steady_g: Option<f64>,
    /// Noise of the force at rest, g: standard deviation.
    pub noise_g: f64,
    /// g for each unit of ANGLE_ACT, at rest; `None` where it gave too little to tell.
    pub stiffness: Option<f64>,
    /// What it is at least, where it gave too little to tell.
    pub stiffness_at_least: Option<f64>,
    /// Slips while it was held; `None` if touch told too little.
    pub slips: Option<usize>,
    /// Usual time between two readings, s.
    pub reading_s: Option<f64>,
    /// Longest time between two readings of the force, s.
    pub longest_gap_s: Option<f64>,
}

impl CloseFacts {
    /// The joints of a trial, in register order.
    pub fn of(trial: &Trial) -> Vec<Self> {
        let joints = trial.summary.joints.iter();
        joints.map(|joint| Self::joint(trial, joint)).collect()
    }

    fn joint(trial: &Trial, joint: &JointMetrics) -> Self {
        let zero = trial.recording.zero();
        let when = |what| trial.recording.when(what).map(|at| seconds(zero, at));
        let slow = when(TrialEvent::Slow(joint.dof));
        let end = when(TrialEvent::Release).or_else(|| when(TrialEvent::Aborted));
        let curves = JointCurves::of(&trial.recording, joint.dof);
        let resting = end.and_then(|end| median(&curves.angle.values(end - REST_S, end)));
        let unseen = unseen(&curves.force, joint);
        let pressed = joint.contact_angle.zip(resting);
        let pressed = pressed.map(|(contact, resting)| contact - resting);
        let pressed = joint.steady_force_g.zip(pressed);
        let (told, untold): (Option<_>, Option<_>) = match pressed {
            Some((_, pressed)) if pressed < PRESSED_LEAST => (None, joint.steady_force_g),
            told => (told, None),
        };
        Self {
            dof: joint.dof,
            is_dead: joint.dead_drive,
            stopped_by_force: joint.end_status.as_deref() == Some(Status::ForceReached.name()),
            touched_before: joint.contact_at_start == Some(true),
            contact: joint.contact_angle,
            to_contact_s: joint.time_to_contact_s,
            dead_time_s: joint.dead_time_s,
            close_s: joint.time_to_stop_s,
            slow_s: joint
                .time_to_stop_s
                .zip(slow)
                .map(|(stop, slow)| stop - slow),
            peak_g: joint.peak_force_g,
            missed_g: unseen.missed_g,
            is_uncertain: unseen.is_unusual,
            offset_g: joint.rest_force_g.unwrap_or_default(),
            is_clipped: joint.clipped == Some(true),
            steady_g: joint.steady_force_g,
            noise_g: joint.noise_g.unwrap_or_default(),
            stiffness: told.map(|(steady, pressed)| steady / pressed),
            stiffness_at_least: untold.map(|steady| steady / PRESSED_LEAST),
            slips: joint.slip_count,
            reading_s: joint.rate_hz.map(|rate| 1.0 / rate.max(1.0)),
            longest_gap_s: joint.longest_gap_s,
        }
    }
}

/// What readings of a rising force may not have shown.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Unseen {
    missed_g: f64,
    is_unusual: bool,
}

/// What may have been missed from the contact to the stop. Between two readings that are far apart, or beside a single one that is
/// far above the next, the force may have risen on as fast as it ever rose.
fn unseen(force: &TimeSeries, joint: &JointMetrics) -> Unseen {
    let contact = joint.time_to_contact_s.or(joint.time_to_touch_s);
    let Some((from, stop)) = contact.zip(joint.time_to_stop_s) else {
        return Unseen::default();
    };
    let usual = joint.rate_hz.map_or(GAP_S, |rate| 1.0 / rate.max(1.0));
    let rest = joint.rest_force_g.unwrap_or_default();
    let points: Vec<(f64, f64)> = force
        .between(from - 2.0 * usual - GAP_S, stop + PEAK_LATE_S + GAP_S)
        .map(|point| (point.t, point.v - rest))
        .collect();
    let pairs = points.iter().zip(points.iter().skip(1));
    let slopes = pairs
        .clone()
        .map(|((t, v), (t2, v2))| (v2 - v) / (t2 - t).max(1e-3));
    let steepest = slopes.fold(0.0, f64::max);
    let peak = points.iter().map(|(_, v)| *v).fold(0.0, f64::max);
    let told = BRIEF_SIGMAS * joint.noise_g.unwrap_or_default() + BRIEF_G;
    let mut unseen = Unseen::default();
    for ((t, v), (t2, v2)) in
        pairs.filter(|((t, _), (t2, _))| *t2 >= from && *t <= stop + PEAK_LATE_S)
    {
        let apart = t2 - t;
        let is_brief = *v >= peak && *v2 < BRIEF_BELOW * peak && v - v2 > told;
        if apart > GAP_S || is_brief {
            let missed = v.max(0.0) + steepest * apart - peak;
            unseen.missed_g = unseen.missed_g.max(missed);
        }
        unseen.is_unusual |= apart > GAP_S.max(GAP_TIMES * usual) || is_brief;
    }
    unseen
}
