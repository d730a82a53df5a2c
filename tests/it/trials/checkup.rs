//! A check-up on bodies that it does not know: healthy ones, and each kind of wear at the size that it is to be found at.

use crate::trials::virtual_hand::{VirtualHand, object};
use crate::trials::worn::{JOINT, WEARS, checked, finds, told};
use handscope::checkup::run::LIMITS;
use handscope::checkup::{Checkup, Light, Part, Subject};
use handscope::hand::{ArmEpoch, Dof, Fault};
use handscope::sim::body_params::random::random;
use handscope::sim::{BodyParams, Object};
use handscope::trials::Abort;
use handscope::trials::series::Series;

#[test]
fn healthy_bodies_are_told_to_be_healthy() {
    let (mut figures, mut wrong) = (0, Vec::new());
    for seed in 0..25 {
        let checks = checked(random(seed), seed, &[]);
        figures += checks.len();
        wrong.extend(told(&checks));
    }
    assert_eq!(figures, 25 * (6 * 16 + 5 * 2 + 1));
    assert!(wrong.len() * 50 < 25, "{wrong:?}");
}

#[test]
fn a_hand_that_did_not_change_is_as_it_was_at_first() {
    for seed in 0..5 {
        let first = checked(random(seed), seed, &[]);
        let again = checked(random(seed), seed + 100, &first);
        assert_eq!(told(&again), [], "{seed}");
    }
}

#[test]
fn each_wear_is_found_where_it_is() {
    for wear in WEARS {
        for seed in 0..4 {
            assert!(finds(wear, seed), "{}, {seed}", wear.0);
        }
    }
}

#[test]
fn what_changed_since_the_first_is_told_though_it_is_still_good() {
    let mut body = random(3);
    body.joints[JOINT].friction_ma = 100.0;
    let first = checked(body, 3, &[]);
    assert_eq!(told(&first), []);
    body.joints[JOINT].friction_ma = 180.0;
    let later = told(&checked(body, 4, &first));
    let whats: Vec<_> = later.iter().map(|(what, of, _)| (*what, *of)).collect();
    assert_eq!(whats, [(Subject::ClosingCurrent, Part::Joint(JOINT))]);
}

#[test]
fn nothing_goes_beyond_its_limits_and_a_fault_or_an_object_ends_it() {
    let mut hand = VirtualHand::new(BodyParams::default(), 1, &Object::none());
    let (checkup, _) = hand.run(Checkup::start(ArmEpoch(1)), |_, _| ());
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
    let block = object(13.0, None);
    let mut hand = VirtualHand::new(BodyParams::default(), 1, &block);
    let (checkup, stopped) = hand.run(Checkup::start(ArmEpoch(1)), |_, _| ());
    let Some(Abort::Ceiling { grams, .. }) = checkup.aborted() else {
        panic!("{:?}", checkup.aborted());
    };
    assert!(
        stopped && grams < 2 * i32::from(LIMITS.ceiling_g),
        "{grams}"
    );
    let mut hand = VirtualHand::new(BodyParams::default(), 1, &Object::none());
    let (checkup, stopped) = hand.run(Checkup::start(ArmEpoch(1)), |hand, checkup| {
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

#[test]
fn no_joint_moves_while_another_does_not_open() {
    let mut hand = VirtualHand::new(BodyParams::default(), 1, &Object::none());
    let (checkup, stopped) = hand.run(Checkup::start(ArmEpoch(1)), |hand, checkup| {
        let is_bent = hand.true_angles()[Dof::Index] < 500.0;
        if is_bent && checkup.view().joint == Some(Dof::Index) {
            hand.set_dead(Dof::Index, true);
        }
    });
    let target = 1000;
    let dof = Dof::Index;
    assert_eq!(checkup.aborted(), Some(Abort::Unreached { dof, target }));
    assert!(stopped && hand.hand.true_angles()[Dof::ThumbBend] > 990.0);
}
