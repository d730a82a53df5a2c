//! Calibrations in newtons on simulated hands in virtual time, with a user who reads a scale that rounds to 5 g, and mistypes.

use crate::trials::virtual_hand::{RegisterHand, VirtualHand, object};
use handscope::hand::newtons::{Contradiction, ForceScale, N_PER_G, ScalePoint};
use handscope::hand::{ArmEpoch, Dof, Finger, Force, HandCommand, Moment};
use handscope::motion::program::{Order, Program as _};
use handscope::motion::scale::{ScaleEnd, ScaleEvent, ScaleInput, ScaleRun, ScaleStart};
use handscope::sim::body_params::random::random;
use handscope::sim::{BodyParams, ForceCompared, Object, SimHand};
use std::time::Duration;

const DOF: Dof = Dof::Index;
/// Time from the question to the answer.
const READS_FOR: Duration = Duration::from_secs(3);
const LIMIT_G: i16 = 400;

/// A user at a scale.
struct User<'a> {
    /// Grams of the scale for a gram of the hand.
    factor: f64,
    /// What the user enters: called with the number of the question, the load, and what the scale shows.
    enters: &'a mut dyn FnMut(usize, usize, f64) -> ScaleInput,
    asked: usize,
    due: Option<(Moment, usize)>,
    doubts: Vec<Contradiction>,
    most_g: f64,
    now: Moment,
}

impl<'a> User<'a> {
    fn new(factor: f64, enters: &'a mut dyn FnMut(usize, usize, f64) -> ScaleInput) -> Self {
        Self {
            factor,
            enters,
            asked: 0,
            due: None,
            doubts: Vec::new(),
            most_g: 0.0,
            now: Moment::ZERO.plus(Duration::from_millis(10)),
        }
    }

    fn watches(&mut self, hand: &mut SimHand, run: &mut ScaleRun) {
        self.now = self.now.plus(Duration::from_millis(10));
        let load_g = hand.true_loads()[Finger::Index];
        self.most_g = self.most_g.max(load_g);
        while let Some(event) = run.event() {
            match event {
                ScaleEvent::Asked { load, .. } => {
                    self.due = Some((self.now.plus(READS_FOR), load));
                }
                ScaleEvent::Doubted(why) => self.doubts.push(why),
                ScaleEvent::Points(_) => {}
                ScaleEvent::NotAsked => panic!("it is asked"),
            }
        }
        if let Some((due, load)) = self.due.filter(|(due, _)| self.now >= *due) {
            let _ = due;
            self.due = None;
            let shown = (load_g * self.factor / 5.0).round() * 5.0;
            let input = (self.enters)(self.asked, load, shown);
            self.asked += 1;
            if let Some(Order::Set(setpoints)) = run.answer(input, self.now) {
                let commands = setpoints.commands();
                for write in commands.iter().flat_map(HandCommand::writes) {
                    RegisterHand::write(hand, write.span().address, write.bytes(), self.now);
                }
            }
        }
    }
}

fn body(zero_g: f64, noise_g: f64) -> BodyParams {
    let mut body = BodyParams::default();
    for (_, joint) in body.joints.iter_mut() {
        joint.force_zero_g = zero_g;
        joint.force_noise_g = noise_g;
        joint.backlash = 30.0;
    }
    body
}

fn calibrated(
    hand: &mut VirtualHand,
    user: &mut User<'_>,
    points: Vec<ScalePoint>,
) -> (ScaleRun, Option<ScaleEnd>) {
    let start = ScaleStart {
        dof: DOF,
        limit: Force::new(LIMIT_G).unwrap(),
        points,
    };
    let run = ScaleRun::new(ArmEpoch(1), start);
    let (run, _) = hand.run(run, |hand, run| user.watches(hand, run));
    let end = run.ended().and_then(Result::ok);
    (run, end)
}

#[test]
fn newtons_are_found_on_each_kind_of_hand_though_the_user_mistypes() {
    let mut case = 0;
    for compared in [ForceCompared::AsRead, ForceCompared::Load] {
        for (zero_g, noise_g, stiffness) in [(0.0, 3.0, 6.4), (240.0, 8.0, 3.0), (-45.0, 8.0, 6.4)]
        {
            case += 1;
            let factor = 0.5 + 0.15 * f64::from(case);
            let (wrong, seed) = (case as usize % 5, 7 + case as u64);
            let mut hand = VirtualHand::with(
                compared,
                (body(zero_g, noise_g), seed),
                &object(stiffness, None),
            );
            let mut enters = |asked, _load, shown: f64| {
                // A digit too many.
                ScaleInput::Reading(if asked == wrong {
                    shown * 10.0 + 5.0
                } else {
                    shown
                })
            };
            let mut user = User::new(factor, &mut enters);
            let (run, end) = calibrated(&mut hand, &mut user, Vec::new());
            let name = format!("{compared:?} {zero_g} {noise_g} {stiffness}");
            assert_eq!(end, Some(ScaleEnd::Done), "{name}");
            let load = match user.doubts[..] {
                [Contradiction::Point { load, .. }] => load,
                ref other => panic!("{name}: {other:?}"),
            };
            assert_eq!((load, user.asked), (wrong, 6), "{name}");
            let scale = ForceScale::fit(run.points()).unwrap();
            let error = scale.newtons_per_g / N_PER_G / factor - 1.0;
            assert!(error.abs() < 0.04, "{name}: {error}");
            assert!(
                user.most_g < f64::from(LIMIT_G) + 20.0,
                "{name}: {}",
                user.most_g
            );
            assert_eq!(
                scale.tip_deviates(),
                (1.0 / factor - 1.0).abs() > 0.15,
                "{name}"
            );
            assert!(hand.disarmed, "{name}");
            assert!(hand.hand.true_angles()[DOF] > 980.0, "{name}: it lets go");
        }
    }
}

#[test]
fn hands_of_the_family_are_measured_within_8_percent() {
    let mut errors = Vec::new();
    for seed in 0..20 {
        let compared = [ForceCompared::AsRead, ForceCompared::Load][seed as usize % 2];
        let factor = 0.5 + 0.045 * seed as f64;
        let mut hand = VirtualHand::with(compared, (random(seed), seed), &object(6.4, None));
        let mut enters = |_, _, shown| ScaleInput::Reading(shown);
        let mut user = User::new(factor, &mut enters);
        let (run, end) = calibrated(&mut hand, &mut user, Vec::new());
        assert_eq!(end, Some(ScaleEnd::Done), "{seed} {:?}", user.doubts);
        assert_eq!(user.doubts, [], "{seed}");
        let scale = ForceScale::fit(run.points()).unwrap();
        errors.push(scale.newtons_per_g / N_PER_G / factor - 1.0);
        assert!(user.most_g < 500.0, "{seed}: {}", user.most_g);
    }
    let worst = errors.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
    println!("newtons of 20 bodies: worst {:.1} % off", 100.0 * worst);
    assert!(worst < 0.08, "{errors:?}");
}

#[test]
fn a_load_can_be_pressed_again_or_left_out_and_the_next_run_measures_the_others() {
    let object = object(6.4, None);
    let mut hand = VirtualHand::new(body(0.0, 3.0), 1, &object);
    let mut enters = |asked, load, shown| match asked {
        0 => {
            assert_eq!(load, 0);
            ScaleInput::Again
        }
        1 => {
            assert_eq!(load, 0);
            ScaleInput::Skip
        }
        4 => ScaleInput::Finish,
        _ => ScaleInput::Reading(shown),
    };
    let mut user = User::new(1.0, &mut enters);
    let (run, end) = calibrated(&mut hand, &mut user, Vec::new());
    assert_eq!(end, Some(ScaleEnd::Incomplete));
    let points = run.points().to_vec();
    let loads: Vec<usize> = points.iter().map(|own| own.load).collect();
    assert_eq!(loads, [1, 2]);
    assert!(hand.hand.true_angles()[DOF] > 980.0, "it lets go");
    let mut hand = VirtualHand::new(body(0.0, 3.0), 1, &object);
    let mut asked_for = Vec::new();
    let mut enters = |_, load, shown| {
        asked_for.push(load);
        ScaleInput::Reading(shown)
    };
    let mut user = User::new(1.0, &mut enters);
    let (run, end) = calibrated(&mut hand, &mut user, points);
    assert_eq!(end, Some(ScaleEnd::Done));
    assert_eq!(run.points().len(), 5);
    assert_eq!(asked_for, [0, 3, 4]);
}

#[test]
fn readings_of_nothing_end_it_and_leave_no_point() {
    let mut hand = VirtualHand::new(body(0.0, 3.0), 1, &object(6.4, None));
    let mut digits = 0.0;
    let mut enters = |_, _, _| {
        digits += 1.0;
        ScaleInput::Reading([100.0, 900.0, 3.0, 777.0][digits as usize % 4] + digits)
    };
    let mut user = User::new(1.0, &mut enters);
    let (run, end) = calibrated(&mut hand, &mut user, Vec::new());
    assert_eq!(end, Some(ScaleEnd::Contradicted));
    assert!(run.points().is_empty() && user.asked == 8, "{}", user.asked);
}

#[test]
fn without_a_scale_or_a_zero_it_asks_nothing() {
    for (zero_g, object, expected) in [
        (0.0, Object::none(), ScaleEnd::NoContact),
        (-100.0, object(6.4, None), ScaleEnd::ZeroOff),
    ] {
        let mut hand = VirtualHand::new(body(zero_g, 3.0), 1, &object);
        let mut enters = |_, _, _| panic!("nothing is asked");
        let mut user = User::new(1.0, &mut enters);
        let (_, end) = calibrated(&mut hand, &mut user, Vec::new());
        assert_eq!(end, Some(expected));
        assert!(hand.hand.true_angles()[DOF] > 980.0);
    }
}
