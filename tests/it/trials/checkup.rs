//! A check-up on bodies that it does not know: healthy ones, and each kind of wear at the size that it is to be found at.

use crate::trials::virtual_hand::VirtualHand;
use handscope::checkup::run::LIMITS;
use handscope::checkup::{Check, Checkup, Light, Of, Subject};
use handscope::hand::{ArmEpoch, Dof, Fault, Finger};
use handscope::sim::body_params::JointBody;
use handscope::sim::body_params::random::random;
use handscope::sim::{BodyParams, Object};
use handscope::trials::Abort;
use handscope::trials::series::Steered;

const JOINT: Dof = Dof::Middle;

/// Checks a body; what it was at its first check-up is compared where it is given.
fn checked(body: BodyParams, seed: u64, first: &[Check]) -> Vec<Check> {
    let first: Vec<_> = first.iter().map(|check| check.measured).collect();
    let mut hand = VirtualHand::new(body, seed, &Object::none());
    let (checkup, stopped) = hand.steer(Checkup::start(ArmEpoch(1)), |_, _| ());
    assert_eq!((checkup.aborted(), stopped), (None, false));
    checkup.checks(&first, &first)
}

/// What is not as it should be.
fn told(checks: &[Check]) -> Vec<(Subject, Of, Option<f64>)> {
    let told = checks.iter().filter(|check| check.light != Light::Fine);
    let told = told.map(|check| (check.measured.what, check.measured.of, check.measured.value));
    told.collect()
}

/// A healthy body; zeros up to 241 g were seen of one.
fn healthy(seed: u64) -> BodyParams {
    random(seed)
}

#[test]
fn healthy_bodies_are_told_to_be_healthy() {
    let (mut figures, mut wrong) = (0, Vec::new());
    for seed in 0..25 {
        let checks = checked(healthy(seed), seed, &[]);
        figures += checks.len();
        wrong.extend(told(&checks));
    }
    assert_eq!(figures, 25 * (6 * 16 + 5 * 2 + 1));
    assert!(wrong.len() * 50 < 25, "{wrong:?}");
}

#[test]
fn a_hand_that_did_not_change_is_as_it_was_at_first() {
    for seed in 0..5 {
        let first = checked(healthy(seed), seed, &[]);
        let again = checked(healthy(seed), seed + 100, &first);
        assert_eq!(told(&again), [], "{seed}");
    }
}

/// A wear: what is worn how, and by which figure it is found.
type Wear = (&'static str, fn(&mut BodyParams), Subject);

fn joint(body: &mut BodyParams) -> &mut JointBody {
    &mut body.joints[JOINT]
}

const WEARS: [Wear; 14] = [
    (
        "backlash of 40 counts",
        |body| joint(body).backlash = 40.0,
        Subject::Backlash,
    ),
    (
        "closing takes 400 mA",
        |body| joint(body).friction_ma = 400.0,
        Subject::ClosingCurrent,
    ),
    (
        "opening takes 400 mA",
        |body| joint(body).opening_friction_ma = 400.0,
        Subject::OpeningCurrent,
    ),
    (
        "0.4 mA more a unit of speed",
        |body| joint(body).friction_ma_per_speed = 0.4,
        Subject::CurrentPerSpeed,
    ),
    (
        "a quarter slower",
        |body| joint(body).counts_per_speed = 2.3,
        Subject::ClosingSpeed,
    ),
    (
        "faster",
        |body| joint(body).counts_per_speed = 4.2,
        Subject::OpeningSpeed,
    ),
    (
        "120 ms late",
        |body| joint(body).latency_ms = 120.0,
        Subject::DeadTime,
    ),
    (
        "late by chance",
        |body| joint(body).latency_scatter_ms = 60.0,
        Subject::DeadTimeScatter,
    ),
    (
        "a zero of 300 g",
        |body| joint(body).force_zero_g = 320.0,
        Subject::ForceZero,
    ),
    (
        "noise of 25 g either way",
        |body| joint(body).force_noise_g = 25.0,
        Subject::ForceNoise,
    ),
    (
        "30 degrees warmer",
        |body| joint(body).warmer_by_c = 26.0,
        Subject::WarmerThanOthers,
    ),
    (
        "a dead channel",
        |body| body.fingertips[Finger::Ring].dead[3] = true,
        Subject::DeadChannels,
    ),
    (
        "a channel that drifts",
        |body| body.fingertips[Finger::Ring].drift[5] = -3000.0,
        Subject::ChannelDrift,
    ),
    (
        "a weak supply",
        |body| body.supply.sag = 0.4,
        Subject::SlowerTogether,
    ),
];

#[test]
fn each_wear_is_found_where_it_is() {
    for (words, wear, subject) in WEARS {
        for seed in 0..4 {
            let mut body = healthy(seed);
            wear(&mut body);
            let told = told(&checked(body, seed, &[]));
            let of = match subject {
                Subject::DeadChannels | Subject::ChannelDrift => Of::Fingertip(Finger::Ring),
                Subject::SlowerTogether => Of::Hand,
                _ => Of::Joint(JOINT),
            };
            let is_it = |own: &(Subject, Of, Option<f64>)| (own.0, own.1) == (subject, of);
            assert!(told.iter().any(is_it), "{words}, {seed}: {told:?}");
        }
    }
}

#[test]
fn what_changed_since_the_first_is_told_though_it_is_still_good() {
    let mut body = healthy(3);
    body.joints[JOINT].friction_ma = 100.0;
    let first = checked(body, 3, &[]);
    assert_eq!(told(&first), []);
    body.joints[JOINT].friction_ma = 180.0;
    let later = told(&checked(body, 4, &first));
    let whats: Vec<_> = later.iter().map(|(what, of, _)| (*what, *of)).collect();
    assert_eq!(whats, [(Subject::ClosingCurrent, Of::Joint(JOINT))]);
}

#[test]
fn nothing_goes_beyond_its_limits_and_a_fault_or_an_object_ends_it() {
    let mut hand = VirtualHand::new(BodyParams::default(), 1, &Object::none());
    let (checkup, _) = hand.steer(Checkup::start(ArmEpoch(1)), |_, _| ());
    assert_eq!(checkup.aborted(), None);
    for entry in hand.hand.journal() {
        let (shorts, _) = entry.bytes.as_chunks::<2>();
        let most = match entry.address {
            1486..=1497 => 1000,
            // Forces, and speeds.
            1498..=1509 | 1522..=1533 => 500,
            address => panic!("{address}"),
        };
        for raw in shorts.iter().map(|short| i16::from_le_bytes(*short)) {
            assert!((-1..=most).contains(&raw), "{entry:?}");
        }
    }
    let block = crate::trials::virtual_hand::object(13.0, None);
    let mut hand = VirtualHand::new(BodyParams::default(), 1, &block);
    let (checkup, stopped) = hand.steer(Checkup::start(ArmEpoch(1)), |_, _| ());
    let Some(Abort::Ceiling { grams, .. }) = checkup.aborted() else {
        panic!("{:?}", checkup.aborted());
    };
    assert!(
        stopped && grams < 2 * i32::from(LIMITS.ceiling_g),
        "{grams}"
    );
    let mut hand = VirtualHand::new(BodyParams::default(), 1, &Object::none());
    let (checkup, stopped) = hand.steer(Checkup::start(ArmEpoch(1)), |hand, checkup| {
        if checkup.view().joint == Some(Dof::Index) {
            hand.inject_fault(Dof::Index, Fault::OverCurrent);
        }
    });
    assert!(
        stopped
            && matches!(
                checkup.aborted(),
                Some(Abort::Fault {
                    dof: Dof::Index,
                    ..
                })
            )
    );
    // What was not measured is not known, and is not called good.
    let checks = checkup.checks(&[], &[]);
    let supply = checks
        .iter()
        .find(|check| check.measured.what == Subject::SlowerTogether);
    assert_eq!(supply.unwrap().light, Light::Unknown);
}
