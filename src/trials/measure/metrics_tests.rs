//! The metrics on curves whose answers are known: noise, missing readings, no contact, contact at the start, a clipped
//! peak.

use crate::hand::{Dof, Status};
use crate::trials::measure::curve::{JointCurves, TimeSeries};
use crate::trials::measure::metrics::{DwellSpan, JointMetrics, measure_joint};
use crate::trials::measure::unseen::PeakDoubt;

const DEAD_S: f64 = 0.064;
const CONTACT_S: f64 = 0.664;
const STOP_S: f64 = 0.71;
const END_S: f64 = 2.0;
const REST_G: f64 = -6.0;
const STEADY_G: f64 = 460.0;
const TAU_S: f64 = 0.15;

/// A grasp with known answers: at rest until 64 ms, 400 counts/s, contact at 760, a rise of 20 g/ms to the peak, then an
/// exponential fall.
#[derive(Debug, Clone, Copy)]
struct Grasp {
    peak_g: f64,
    noise_g: f64,
    rate_hz: f64,
}

const PLAIN: Grasp = Grasp {
    peak_g: 900.0,
    noise_g: 0.0,
    rate_hz: 200.0,
};

impl Grasp {
    fn force(self, t: f64) -> f64 {
        let rising = 20_000.0 * (t - CONTACT_S);
        let peak_at = CONTACT_S + self.peak_g / 20_000.0;
        let load = if t < peak_at {
            rising.max(0.0)
        } else {
            STEADY_G + (self.peak_g - STEADY_G) * (-(t - peak_at) / TAU_S).exp()
        };
        (load + REST_G).min(4000.0)
    }

    fn angle(t: f64) -> f64 {
        1000.0 - 400.0 * (t - DEAD_S).clamp(0.0, CONTACT_S - DEAD_S)
    }

    fn curves(self, keep: impl Fn(f64) -> bool) -> JointCurves {
        let mut rng = fastrand::Rng::with_seed(7);
        let step = 1.0 / self.rate_hz;
        let count = ((END_S + 1.0) * self.rate_hz).round();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some hundreds"
        )]
        let times: Vec<f64> = (0..count as u32)
            .map(|n| f64::from(n) * step - 0.9987)
            .filter(|t| keep(*t))
            .collect();
        let curve = |value: &dyn Fn(f64) -> f64| -> TimeSeries {
            times.iter().map(|t| (*t, value(*t))).collect()
        };
        let noise = std::cell::RefCell::new(&mut rng);
        let status = |t: f64| match t {
            t if t < DEAD_S => Status::PositionReached,
            t if t < STOP_S => Status::Grasping,
            _ => Status::ForceReached,
        };
        JointCurves {
            angle: curve(&|t| Self::angle(t).round()),
            force: curve(&|t| {
                let noise = (2.0 * noise.borrow_mut().f64() - 1.0) * self.noise_g;
                (self.force(t) + noise).round().min(4000.0)
            }),
            current: curve(&|t| {
                if (DEAD_S..STOP_S).contains(&t) {
                    480.0
                } else {
                    0.0
                }
            }),
            status: curve(&|t| status(t).raw().into()),
            temperature: curve(&|t| if t < 1.5 { 31.0 } else { 33.0 }),
            normal: curve(&|t| ((self.force(t) - REST_G) * 0.0098).max(0.0)),
            tangential: curve(&|t| ((self.force(t) - REST_G) * 0.002).max(0.0)),
            direction: curve(&|_| 10.0),
            proximity: TimeSeries::default(),
        }
    }

    fn measured(self) -> JointMetrics {
        measured(&self.curves(|_| true))
    }
}

fn measured(curves: &JointCurves) -> JointMetrics {
    measured_until(curves, END_S)
}

fn measured_until(curves: &JointCurves, end_s: f64) -> JointMetrics {
    let span = DwellSpan {
        slow_s: None,
        end_s,
        threshold_g: 500.0,
    };
    measure_joint(Dof::Index, curves, span)
}

#[track_caller]
fn near(what: &str, got: Option<f64>, wanted: f64, within: f64) {
    let got = got.unwrap_or_else(|| unreachable!("{what} is not known"));
    assert!(
        (got - wanted).abs() <= within,
        "{what}: {got}, not {wanted} within {within}"
    );
}

/// The promised errors: `t_s` for times, `g` for forces.
#[track_caller]
fn check(metrics: &JointMetrics, grasp: Grasp, t_s: f64, g: f64) {
    near("dead time", metrics.dead_time_s, DEAD_S, t_s);
    near("contact", metrics.time_to_contact_s, CONTACT_S, t_s);
    near("touch", metrics.time_to_touch_s, CONTACT_S, t_s);
    near("angle", metrics.contact_angle, 760.0, 3.0 + 400.0 * t_s);
    near("stop", metrics.time_to_stop_s, STOP_S, t_s);
    near("steady", metrics.steady_force_g, STEADY_G, g.min(4.0));
    near("peak", metrics.peak_force_g, grasp.peak_g, g);
    near("over", metrics.overshoot_g, grasp.peak_g - 500.0, g);
    near(
        "relaxation",
        metrics.relaxation_g,
        grasp.peak_g - STEADY_G,
        2.0 * g,
    );
    near("current", metrics.peak_current_ma, 480.0, 0.0);
    near("heat", metrics.temperature_rise_c, 2.0, 0.0);
    assert_eq!(metrics.end_status.as_deref(), Some("force_reached"));
    assert_eq!(metrics.contact_at_start, Some(false));
    assert_eq!(metrics.slip_count, Some(0));
    assert_eq!(metrics.clipped, Some(false));
}

#[test]
fn a_clean_grasp_gives_its_numbers_within_a_reading() {
    let metrics = PLAIN.measured();
    // Between two readings the force falls by 3 % of what it will lose, or has not come to its peak.
    check(&metrics, PLAIN, 0.005, 100.0);
    near("rest", metrics.rest_force_g, REST_G, 0.5);
    near("rate", metrics.rate_hz, 200.0, 1.0);
    near("gap", metrics.longest_gap_s, 0.005, 1e-6);
    // The band is 5 % of 460: 440 fall to 23 in 2.95 time constants.
    near("settle", metrics.settle_time_s, 0.045 + 2.95 * TAU_S, 0.01);
}

#[test]
fn noise_moves_times_by_a_reading_and_the_peak_by_the_noise() {
    for noise_g in [3.0, 10.0] {
        let grasp = Grasp { noise_g, ..PLAIN };
        let metrics = grasp.measured();
        check(&metrics, grasp, 0.0075, 100.0 + noise_g);
        near("noise", metrics.noise_g, noise_g * 0.577, noise_g * 0.08);
    }
}

#[test]
fn a_single_wild_reading_does_not_move_the_settle_time() {
    let settle = |wild_at: Option<f64>| {
        let mut curves = PLAIN.curves(|_| true);
        let wild = |t: f64| wild_at.is_some_and(|at| (t - at).abs() < 0.0026);
        let points = curves.force.points().iter();
        curves.force = points
            .map(|p| (p.t, if wild(p.t) { p.v + 80.0 } else { p.v }))
            .collect();
        measured(&curves).settle_time_s
    };
    let plain = settle(None).unwrap();
    for at in [1.3, 1.5, 1.7, 1.95] {
        near("settle", settle(Some(at)), plain, 0.0051);
    }
}

#[test]
fn a_hand_that_moves_within_a_reading_of_the_command_has_a_stop_and_a_steady_force() {
    // Without a dead time; read every 25 ms, it is far from its rest in the first reading, and its drive reports nothing but the stop.
    for says_that_it_moves in [true, false] {
        let rare = Grasp {
            rate_hz: 40.0,
            ..PLAIN
        };
        let mut curves = rare.curves(|_| true);
        let early = |t: f64| if t > 0.0 { t + DEAD_S } else { t };
        let points = |curve: &TimeSeries| curve.points().to_vec();
        let times = points(&curves.angle);
        curves.angle = times
            .iter()
            .map(|p| (p.t, Grasp::angle(early(p.t)).round()))
            .collect();
        curves.force = times
            .iter()
            .map(|p| (p.t, rare.force(early(p.t))))
            .collect();
        let status = |t: f64| match t {
            t if t < 0.0 => Status::PositionReached,
            t if t < STOP_S - DEAD_S && says_that_it_moves => Status::Grasping,
            _ => Status::ForceReached,
        };
        curves.status = times
            .iter()
            .map(|p| (p.t, status(p.t).raw().into()))
            .collect();
        let metrics = measured(&curves);
        assert_eq!(metrics.dead_time_s, None);
        near("stop", metrics.time_to_stop_s, STOP_S - DEAD_S, 0.075);
        near("steady", metrics.steady_force_g, STEADY_G, 4.0);
        assert!(metrics.settle_time_s.is_some());
    }
}

#[test]
fn missing_readings_cost_their_own_time_and_are_told() {
    let slow = Grasp {
        rate_hz: 100.0,
        ..PLAIN
    };
    let hole = |t: f64| !(0.3..0.45).contains(&t);
    let metrics = measured(&slow.curves(hole));
    check(&metrics, slow, 0.011, 200.0);
    assert_eq!(metrics.peak_doubt, None);
    near("gap", metrics.longest_gap_s, 0.16, 0.011);
    // A hole over the contact: its time is somewhere in the hole, the peak is too low, nothing else suffers.
    let blind = |t: f64| !(0.65..0.75).contains(&t);
    let metrics = measured(&slow.curves(blind));
    near("contact", metrics.time_to_contact_s, CONTACT_S, 0.1);
    assert!(metrics.peak_force_g.unwrap() < 900.0);
    assert_eq!(metrics.peak_doubt, Some(PeakDoubt::Gap));
    near("steady", metrics.steady_force_g, STEADY_G, 4.0);
    near("dead time", metrics.dead_time_s, DEAD_S, 0.011);
}

#[test]
fn nothing_touched_leaves_all_that_needs_a_contact_unknown() {
    let grasp = PLAIN.curves(|_| true);
    let free = JointCurves {
        force: grasp.force.points().iter().map(|p| (p.t, REST_G)).collect(),
        normal: grasp.normal.points().iter().map(|p| (p.t, 0.0)).collect(),
        ..grasp
    };
    let metrics = measured(&free);
    for (what, value) in [
        ("contact", metrics.time_to_contact_s),
        ("touch", metrics.time_to_touch_s),
        ("angle", metrics.contact_angle),
        ("peak", metrics.peak_force_g),
        ("overshoot", metrics.overshoot_g),
        ("steady", metrics.steady_force_g),
        ("settle", metrics.settle_time_s),
        ("relaxation", metrics.relaxation_g),
    ] {
        assert_eq!(value, None, "{what}");
    }
    assert_eq!(metrics.clipped, None);
    assert_eq!(metrics.slip_count, None);
    near("dead time", metrics.dead_time_s, DEAD_S, 0.005);
    near("stop", metrics.time_to_stop_s, STOP_S, 0.005);
}

#[test]
fn what_was_touched_from_the_start_has_no_time_of_contact_but_a_peak() {
    let grasp = PLAIN.curves(|_| true);
    let held = JointCurves {
        normal: grasp
            .normal
            .points()
            .iter()
            .map(|p| (p.t, 1.0 + p.v))
            .collect(),
        ..grasp
    };
    let metrics = measured(&held);
    assert_eq!(metrics.contact_at_start, Some(true));
    assert_eq!(metrics.time_to_contact_s, None);
    assert_eq!(metrics.time_to_touch_s, None);
    assert_eq!(metrics.contact_angle, None);
    assert_eq!(metrics.settle_time_s, None);
    near("peak", metrics.peak_force_g, 900.0, 100.0);
}

#[test]
fn a_peak_at_the_sensors_end_is_said_to_be_clipped() {
    let hard = Grasp {
        peak_g: 6000.0,
        ..PLAIN
    };
    let metrics = hard.measured();
    assert_eq!(metrics.clipped, Some(true));
    near("peak", metrics.peak_force_g, 4000.0 - REST_G, 1.0);
}

#[test]
fn of_nothing_nothing_is_known() {
    let metrics = measured(&JointCurves::default());
    let known = serde_json::to_value(&metrics).unwrap();
    let known: Vec<&String> = known
        .as_object()
        .unwrap()
        .iter()
        .filter(|(_, value)| !value.is_null())
        .map(|(key, _)| key)
        .collect();
    assert_eq!(known, ["joint"]);
    assert_eq!(metrics.why_empty(), Some("too few force readings"));
}

#[test]
fn a_close_of_which_something_is_known_is_not_empty() {
    let whole = PLAIN.curves(|_| true);
    let free = JointCurves {
        force: whole.force.points().iter().map(|p| (p.t, REST_G)).collect(),
        normal: TimeSeries::default(),
        ..whole.clone()
    };
    assert_eq!(measured(&whole).why_empty(), None);
    assert_eq!(measured(&free).why_empty(), None, "it stopped");
    let moves_on = JointCurves {
        angle: free
            .angle
            .points()
            .iter()
            .map(|p| (p.t, 900.0 - 50.0 * p.t))
            .collect(),
        status: TimeSeries::default(),
        ..free
    };
    let why = measured(&moves_on).why_empty().unwrap();
    assert!(why.contains("no stop was seen"), "{why}");
}

#[test]
fn without_status_the_stop_is_where_the_angle_stands_still() {
    let grasp = JointCurves {
        status: TimeSeries::default(),
        ..PLAIN.curves(|_| true)
    };
    let metrics = measured(&grasp);
    near("stop", metrics.time_to_stop_s, CONTACT_S, 0.01);
    assert_eq!(metrics.end_status, None);
}

#[test]
fn a_dwell_too_short_for_it_has_no_steady_force() {
    let metrics = measured_until(&PLAIN.curves(|_| true), STOP_S + 0.02);
    assert_eq!(metrics.steady_force_g, None);
    assert_eq!(metrics.settle_time_s, None);
    near("peak", metrics.peak_force_g, 900.0, 100.0);
}

#[test]
fn a_halt_between_two_stages_is_no_stop() {
    let mut curves = PLAIN.curves(|_| true);
    // It halts from 0.3 to 0.4 s, and is told to go on just before it says so.
    let status = |point: &crate::trials::measure::curve::CurvePoint| {
        let halts = (0.3..0.4).contains(&point.t);
        let code = f64::from(Status::PositionReached.raw());
        (point.t, if halts { code } else { point.v })
    };
    curves.status = curves.status.points().iter().map(status).collect();
    let stop = |slow_s| {
        let span = DwellSpan {
            slow_s,
            end_s: END_S,
            threshold_g: 500.0,
        };
        measure_joint(Dof::Index, &curves, span).time_to_stop_s
    };
    near("without its stages", stop(None), 0.3, 0.01);
    near("with its stages", stop(Some(0.29)), STOP_S, 0.01);
}
