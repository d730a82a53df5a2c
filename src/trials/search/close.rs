//! Facts about a joint and the object from one recorded close. Pure.

use crate::hand::statistics::median;
use crate::hand::{Dof, Status};
use crate::trials::measure::curve::JointCurves;
use crate::trials::measure::metrics::JointMetrics;
use crate::trials::recording::{TrialEvent, seconds};
use crate::trials::summary::Trial;

/// Final part of the dwell, in which the joint counts as at rest, s.
const REST_S: f64 = 0.3;
/// Smallest way into an object that determines its stiffness, units of ANGLE_ACT; an angle is a whole number.
const PRESSED_LEAST: f64 = 4.0;

/// One joint in one close. Forces are relative to the reading at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloseFacts {
    pub dof: Dof,
    /// Commanded to close, but it never moved.
    pub is_dead: bool,
    /// Its drive reports a stop by force.
    pub stopped_by_force: bool,
    /// The fingertip felt a force before the joint moved.
    pub touched_before: bool,
    /// Angle at the contact, units of ANGLE_ACT.
    pub contact: Option<f64>,
    /// From the command to the contact, s.
    pub to_contact_s: Option<f64>,
    /// From the command to the start of motion, s.
    pub dead_time_s: Option<f64>,
    /// From the command to the stop, s.
    pub close_s: Option<f64>,
    /// From the order to continue slowly to the stop, s; `None` in one stage.
    pub slow_s: Option<f64>,
    /// Highest force, g.
    pub peak_g: Option<f64>,
    /// Possible extra height of the peak between two readings, g.
    pub missed_g: f64,
    /// The readings may have missed the peak: its height is unknown.
    pub is_uncertain: bool,
    /// Reading of the force sensor at rest, g.
    pub offset_g: f64,
    /// The sensor was at its limit.
    pub is_clipped: bool,
    /// Force at the end of the dwell, g.
    pub steady_g: Option<f64>,
    /// Noise of the force at rest, g: standard deviation.
    pub noise_g: f64,
    /// Stiffness, g per unit of ANGLE_ACT, at rest; `None` if the object gave too little to determine it.
    pub stiffness: Option<f64>,
    /// Lower bound of the stiffness, if the object gave too little to determine it.
    pub stiffness_at_least: Option<f64>,
    /// Slips during the dwell; `None` with too few touch readings.
    pub slips: Option<usize>,
    /// Usual interval of readings, s.
    pub reading_s: Option<f64>,
    /// Longest gap between readings of the force, s.
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
        let pressed = joint.contact_angle.zip(resting);
        let pressed = pressed.map(|(contact, resting)| contact - resting);
        let pressed = joint.steady_force_g.zip(pressed);
        let (measured, unmeasured): (Option<_>, Option<_>) = match pressed {
            Some((_, pressed)) if pressed < PRESSED_LEAST => (None, joint.steady_force_g),
            measured => (measured, None),
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
            missed_g: joint.peak_missed_g.unwrap_or_default(),
            is_uncertain: joint.peak_doubt.is_some(),
            offset_g: joint.rest_force_g.unwrap_or_default(),
            is_clipped: joint.clipped == Some(true),
            steady_g: joint.steady_force_g,
            noise_g: joint.noise_g.unwrap_or_default(),
            stiffness: measured.map(|(steady, pressed)| steady / pressed),
            stiffness_at_least: unmeasured.map(|steady| steady / PRESSED_LEAST),
            slips: joint.slip_count,
            reading_s: joint.rate_hz.map(|rate| 1.0 / rate.max(1.0)),
            longest_gap_s: joint.longest_gap_s,
        }
    }
}
