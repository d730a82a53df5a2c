//! The metrics of one recorded trial, joint by joint. Pure; an unknown value is `None`, never zero.
//!
//! Times are arrival times of replies, counted from the moment at which the closing command was handed to the
//! link. Errors, with T the time between two reads (see `rate_hz`, `longest_gap_s`) and S the noise of the force at rest:
//!
//! * times: late by T at most; contact and motion by less, as they are extrapolated back along the rise where T is up to 60 ms. T of
//!   touch is that of the fingertips, which a slow line reads less often than forces. A command waits for the current request on
//!   the wire, so dead time and time to contact include up to one more transaction (15 ms on a slow hand);
//! * motion: half a unit of ANGLE_ACT more, which is 12 ms at speed 25 and negligible at 250;
//! * forces: the reading at rest is subtracted, so a sensor's offset does not count. A peak is the highest reading: too
//!   low if the force peaked between two reads (`peak_doubt`, if by much), too high by up to 2 S. At the
//!   sensor's limit it is a lower bound (`clipped`);
//! * contact by force: at 15 g or 5 S, whichever is larger; by touch: at 0.1 N;
//! * steady force: a median, within S; settle time: until the median of three readings stays within 5 %, 3 S or 10 g of it, whichever
//!   is largest: a single outlier does not count;
//! * temperatures are whole degrees, read a few times per second.

use crate::hand::statistics::median;
use crate::hand::{Angle, Dof, Status};
use crate::trials::measure::curve::{CurvePoint, JointCurves, TimeSeries};
use crate::trials::measure::detect::{RestLevel, begins, passes, rest};
use crate::trials::measure::slip::{SlipEvent, slips};
use crate::trials::measure::unseen::{PeakDoubt, RiseSpan, unseen};
use crate::trials::plan::{TrialPlan, TrialSetting};
use crate::trials::recording::{TrialEvent, TrialRecording, seconds};
use serde::{Deserialize, Serialize};

/// Length of the rest before the command.
const REST_S: f64 = 0.45;
/// STATUS text of a joint that never moved.
pub const DEAD_DRIVE: &str = "dead_drive";
/// Change of angle that is motion, units of ANGLE_ACT: midway between two whole readings.
const MOTION: f64 = 2.5;
/// Smallest force that is contact, g, and as a multiple of the noise.
const CONTACT_G: f64 = 15.0;
const CONTACT_SIGMAS: f64 = 5.0;
/// Normal force of a fingertip that is contact, N.
const TOUCH_N: f64 = 0.1;
/// Readings from this on are at the sensor's limit (manual 2.6.16), g.
const FORCE_END_G: f64 = 4000.0;
/// The steady force is measured over the end of the dwell, s at most …
const STEADY_S: f64 = 0.5;
/// … with at least this many readings.
const STEADY_LEAST: usize = 5;
/// Tolerance of settling: share of the steady force, g, and multiples of the noise.
const SETTLED_SHARE: f64 = 0.05;
const SETTLED_G: f64 = 10.0;
const SETTLED_SIGMAS: f64 = 3.0;
/// A joint is still if its angle stays within 2 for this long, s.
const STILL_S: f64 = 0.1;
const STILL: f64 = 2.0;

/// The metrics of one joint in a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointMetrics {
    /// The joint.
    #[serde(rename = "joint")]
    pub dof: Dof,
    /// Reading of the force sensor before the command, g; all forces below are relative to it.
    pub rest_force_g: Option<f64>,
    /// Noise of that reading, g: standard deviation.
    pub noise_g: Option<f64>,
    /// From the command to the start of motion, s.
    pub dead_time_s: Option<f64>,
    /// True if the fingertip felt a force before the command; `None` without touch readings.
    pub contact_at_start: Option<bool>,
    /// From the command to the contact, by force, s.
    pub time_to_contact_s: Option<f64>,
    /// From the command to the contact, by touch, s.
    pub time_to_touch_s: Option<f64>,
    /// Angle at the contact, by force, or else by touch; units of ANGLE_ACT.
    pub contact_angle: Option<f64>,
    /// From the command to the stop, s: as reported by the drive, else by its angle.
    pub time_to_stop_s: Option<f64>,
    /// Highest force, g.
    pub peak_force_g: Option<f64>,
    /// Reason why the peak may exceed all readings; `None` if the readings were as dense as usual.
    #[serde(default)]
    pub peak_doubt: Option<PeakDoubt>,
    /// Possible extra height of the peak between two readings, g.
    #[serde(default)]
    pub peak_missed_g: Option<f64>,
    /// True if the sensor was at its limit, so that the force was higher.
    pub clipped: Option<bool>,
    /// Highest force minus the threshold, g; negative if it stayed below.
    pub overshoot_g: Option<f64>,
    /// From the contact until the force stays near its steady value, s.
    pub settle_time_s: Option<f64>,
    /// Force at the end of the dwell, g.
    pub steady_force_g: Option<f64>,
    /// Drop from peak to steady force, g.
    pub relaxation_g: Option<f64>,
    /// Highest current, mA.
    pub peak_current_ma: Option<f64>,
    /// Highest temperature during and after the close, minus that before, °C.
    pub temperature_rise_c: Option<f64>,
    /// STATUS at the end of the dwell, as text; [`DEAD_DRIVE`] for a joint that never moved.
    pub end_status: Option<String>,
    /// The joint was commanded to close and free to move, but never moved: its close has no results, whatever its drive reports.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub dead_drive: bool,
    /// Slips during the dwell; `None` with too few touch readings.
    pub slip_count: Option<usize>,
    /// Force readings per second.
    pub rate_hz: Option<f64>,
    /// Longest gap between them, s.
    pub longest_gap_s: Option<f64>,
    #[serde(default, rename = "slip", skip_serializing_if = "Vec::is_empty")]
    pub slips: Vec<SlipEvent>,
}

impl JointMetrics {
    /// The reason if the close has no results. A finger that met nothing still has a stop.
    pub fn why_empty(&self) -> Option<&'static str> {
        let has_none = self.time_to_stop_s.is_none() && self.peak_force_g.is_none();
        let why = if self.dead_drive {
            "it was commanded to close and never moved"
        } else if self.rate_hz.is_none() {
            "too few force readings"
        } else if self.rest_force_g.is_none() {
            "too few force readings before the command"
        } else {
            "it met nothing, and no stop was seen, before it was opened again"
        };
        has_none.then_some(why)
    }
}

/// Measures a recorded trial, joint by joint in register order.
pub fn measure(
    recording: &TrialRecording,
    plan: &TrialPlan,
    setting: TrialSetting,
) -> Vec<JointMetrics> {
    let Some(command) = recording.when(TrialEvent::Close) else {
        return Vec::new();
    };
    let ends = [TrialEvent::Release, TrialEvent::Aborted];
    let end = ends.into_iter().find_map(|what| recording.when(what));
    let end = end.or_else(|| recording.rows().last().map(|row| row.at));
    let end_s = end.map_or(0.0, |end| seconds(command, end));
    let threshold_g = f64::from(setting.force.get());
    // A trial that ended early may have ended before any motion.
    let is_whole = recording.when(TrialEvent::Release).is_some();
    plan.joints()
        .map(|dof| {
            let curves = JointCurves::of(recording, dof);
            let slow = recording.when(TrialEvent::Slow(dof));
            let span = DwellSpan {
                slow_s: slow.map(|slow| seconds(command, slow)),
                end_s,
                threshold_g,
            };
            let mut joint = measure_joint(dof, &curves, span);
            let target = plan.close[dof].filter(|_| is_whole);
            if target.is_some_and(|target| never_moved(&curves.angle, target, end_s))
                && !is_held(joint.end_status.as_deref())
            {
                joint.dead_drive = true;
                joint.end_status = Some(DEAD_DRIVE.into());
            }
            joint
        })
        .collect()
}

/// True if a joint had a long way to go, was read often enough, and did not move.
fn never_moved(angle: &TimeSeries, target: Angle, end: f64) -> bool {
    let Some(still) = rest(angle, -REST_S, 0.0) else {
        return false;
    };
    let stays = |point: CurvePoint| (point.v - still.level).abs() < MOTION;
    let way = (still.level - f64::from(target.get())).abs();
    way >= f64::from(Angle::ARRIVED_TOLERANCE)
        && angle.between(0.0, end).count() >= STEADY_LEAST
        && angle.between(0.0, end).all(stays)
}

/// True if the drive reports the reason of its stop.
fn is_held(end_status: Option<&str>) -> bool {
    let held = [
        Status::ForceReached,
        Status::CurrentProtection,
        Status::Stalled,
        Status::DriveFault,
    ];
    held.iter().any(|status| end_status == Some(status.name()))
}

/// Times of a close, in seconds from the command, and its threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DwellSpan {
    /// Order to continue slowly, in an approach of two stages: an earlier halt is not a stop.
    pub slow_s: Option<f64>,
    /// Release, or early end of the trial.
    pub end_s: f64,
    /// FORCE_SET, g.
    pub threshold_g: f64,
}

/// Measures one joint; the command is at 0.
pub fn measure_joint(dof: Dof, curves: &JointCurves, span: DwellSpan) -> JointMetrics {
    let end = span.end_s;
    let at_rest = rest(&curves.force, -REST_S, 0.0);
    let force = at_rest.map(|rest| curves.force.less(rest.level));
    let force = force.unwrap_or_default();
    let motion = motion_start(&curves.angle);
    let touched = touched_before(&curves.normal);
    let (contact, touch) = match touched {
        Some(true) => (None, None),
        _ => (
            at_rest.and_then(|rest| contact(&force, rest, end)),
            passes(curves.normal.between(-REST_S, end), TOUCH_N).filter(|at| *at >= 0.0),
        ),
    };
    let pressed = contact.is_some() || touched == Some(true);
    // A hand that moves within one reading of the command shows no dead time, but does move.
    let moves_from = motion.or_else(|| moved(&curves.angle, end).then_some(0.0));
    let stop = match span.slow_s {
        None => moves_from.and_then(|from| stop(curves, from, end)),
        Some(slow) => stop_after_slow(curves, slow, end),
    };
    let peak = highest(&force, end).filter(|_| pressed);
    let steady = stop.and_then(|stop| steady(&force, stop, end));
    let steady = steady.filter(|_| pressed);
    let held = stop.and_then(|stop| slips(curves, stop, end));
    let rate_hz = rate(&force, end);
    let rise = contact.or(touch).zip(stop).zip(rate_hz.zip(at_rest));
    let rise = rise.map(|((contact_s, stop_s), (rate_hz, rest))| RiseSpan {
        contact_s,
        stop_s,
        rate_hz,
        noise_g: rest.sigma,
    });
    let hidden = rise
        .filter(|_| peak.is_some())
        .map(|rise| unseen(&force, rise));
    JointMetrics {
        dof,
        rest_force_g: at_rest.map(|rest| rest.level),
        noise_g: at_rest.map(|rest| rest.sigma),
        dead_time_s: motion,
        contact_at_start: touched,
        time_to_contact_s: contact,
        time_to_touch_s: touch,
        contact_angle: contact.or(touch).and_then(|at| curves.angle.at(at)),
        time_to_stop_s: stop,
        peak_force_g: peak,
        peak_doubt: hidden.and_then(|own| own.doubt),
        peak_missed_g: hidden.map(|own| own.missed_g),
        clipped: peak.map(|_| is_clipped(&curves.force, end)),
        overshoot_g: peak.map(|peak| peak - span.threshold_g),
        settle_time_s: settle(&force, contact, steady.zip(at_rest), end),
        steady_force_g: steady,
        relaxation_g: peak.zip(steady).map(|(peak, steady)| peak - steady),
        peak_current_ma: highest(&curves.current, end),
        temperature_rise_c: temperature_rise(&curves.temperature),
        end_status: status_at(&curves.status, end),
        dead_drive: false,
        slip_count: held.as_ref().map(Vec::len),
        rate_hz,
        longest_gap_s: longest_gap(&force, end),
        slips: held.unwrap_or_default(),
    }
}

fn motion_start(angle: &TimeSeries) -> Option<f64> {
    let still = rest(angle, -REST_S, 0.0)?;
    let away: TimeSeries = angle
        .points()
        .iter()
        .map(|point| (point.t, (point.v - still.level).abs()))
        .collect();
    begins(&away, 0.0, MOTION)
}

/// True if a reading after the command differs from the rest before it.
fn moved(angle: &TimeSeries, end: f64) -> bool {
    let still = rest(angle, -REST_S, 0.0);
    let is_away = |still: RestLevel| {
        let mut after = angle.between(0.0, end);
        after.any(|point| (point.v - still.level).abs() >= MOTION)
    };
    still.is_some_and(is_away)
}

/// True if the fingertip felt a force before the command; `None` without readings.
fn touched_before(normal: &TimeSeries) -> Option<bool> {
    let before = median(&normal.values(-REST_S, 0.0))?;
    Some(before >= TOUCH_N)
}

fn contact(force: &TimeSeries, rest: RestLevel, end: f64) -> Option<f64> {
    let level = CONTACT_G.max(CONTACT_SIGMAS * rest.sigma);
    passes(force.between(-REST_S, end), level).filter(|at| *at >= 0.0)
}

/// Time at which the drive first reports a stop after motion; without status readings, at which the angle is still.
fn stop(curves: &JointCurves, from: f64, end: f64) -> Option<f64> {
    let stopped = |point: &CurvePoint| status(point.v).is_some_and(Status::is_stopped);
    let mut later = curves.status.between(0.0, end).skip_while(stopped);
    if later.next().is_some() {
        return later.find(stopped).map(|point| point.t);
    }
    let still = rest(&curves.angle, -REST_S, 0.0)?.level;
    let angles: Vec<CurvePoint> = curves.angle.between(from, end).collect();
    angles.iter().enumerate().find_map(|(at, first)| {
        let rest = angles.get(at..)?;
        let last = rest.last()?;
        let mut soon = rest.iter().take_while(|p| p.t <= first.t + STILL_S);
        let moved = (first.v - still).abs() >= MOTION;
        let is_still = soon.all(|p| (p.v - first.v).abs() <= STILL);
        (moved && is_still && last.t >= first.t + STILL_S).then_some(first.t)
    })
}

/// Time of the final stop: the halt between two stages ends when the drive reports motion again.
fn stop_after_slow(curves: &JointCurves, slow: f64, end: f64) -> Option<f64> {
    let moves = |point: &CurvePoint| status(point.v).is_some_and(Status::is_moving);
    let last = curves.status.between(slow, end).rfind(moves);
    let Some(last) = last else {
        return stop(curves, slow, end);
    };
    let stopped = |point: &CurvePoint| status(point.v).is_some_and(Status::is_stopped);
    let mut after = curves.status.between(last.t, end);
    after.find(stopped).map(|point| point.t)
}

fn highest(curve: &TimeSeries, end: f64) -> Option<f64> {
    curve
        .between(0.0, end)
        .map(|point| point.v)
        .reduce(f64::max)
}

fn is_clipped(raw: &TimeSeries, end: f64) -> bool {
    raw.between(0.0, end).any(|point| point.v >= FORCE_END_G)
}

fn steady(force: &TimeSeries, stop: f64, end: f64) -> Option<f64> {
    let window = STEADY_S.min((end - stop) / 2.0);
    let values = force.values(end - window, end);
    median(&values).filter(|_| values.len() >= STEADY_LEAST)
}

fn settle(
    force: &TimeSeries,
    contact: Option<f64>,
    steady: Option<(f64, RestLevel)>,
    end: f64,
) -> Option<f64> {
    let (contact, (steady, rest)) = (contact?, steady?);
    let band = (SETTLED_SHARE * steady.abs())
        .max(SETTLED_G)
        .max(SETTLED_SIGMAS * rest.sigma);
    let outside = |point: &CurvePoint| (point.v - steady).abs() > band;
    let after: Vec<CurvePoint> = force.between(contact, end).collect();
    let middles = middle_of_three(&after);
    let last = middles.iter().rfind(|point| outside(point));
    let settled = match last {
        None => contact,
        Some(last) => after.iter().find(|point| point.t > last.t)?.t,
    };
    Some(settled - contact)
}

/// Each value replaced by the median of itself and its neighbours; the ends unchanged.
fn middle_of_three(points: &[CurvePoint]) -> Vec<CurvePoint> {
    let middle = |at: usize, point: &CurvePoint| {
        let around = at.checked_sub(1).and_then(|from| points.get(from..at + 2));
        let values = around.map(|own| own.iter().map(|point| point.v).collect::<Vec<_>>());
        CurvePoint {
            t: point.t,
            v: values.and_then(|own| median(&own)).unwrap_or(point.v),
        }
    };
    let points = points.iter().enumerate();
    points.map(|(at, point)| middle(at, point)).collect()
}

/// Followed to the end of the recording, since heat arrives late.
fn temperature_rise(temperature: &TimeSeries) -> Option<f64> {
    let before = median(&temperature.values(f64::NEG_INFINITY, 0.0))?;
    Some(highest(temperature, f64::INFINITY)? - before)
}

fn status(code: f64) -> Option<Status> {
    // The curve holds bytes.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked to be a byte"
    )]
    let raw = (0.0..=255.0).contains(&code).then_some(code as u8)?;
    Some(Status::from_raw(raw))
}

fn status_at(codes: &TimeSeries, end: f64) -> Option<String> {
    let last = codes.between(0.0, end).next_back()?;
    Some(match status(last.v)? {
        Status::Unknown(raw) => format!("unknown_{raw}"),
        known => known.name().into(),
    })
}

fn rate(force: &TimeSeries, end: f64) -> Option<f64> {
    let count = u32::try_from(force.between(0.0, end).count()).ok()?;
    (count > 1 && end > 0.0).then(|| f64::from(count) / end)
}

fn longest_gap(force: &TimeSeries, end: f64) -> Option<f64> {
    let times = force.between(0.0, end).map(|point| point.t);
    let next = times.clone().skip(1);
    times.zip(next).map(|(a, b)| b - a).reduce(f64::max)
}
