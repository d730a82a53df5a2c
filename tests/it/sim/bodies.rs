//! Bodies that differ from the default: each number of the file is felt in the registers or in the motion.

use handscope::hand::impact::RIGID_G_PER_COUNT;
use handscope::hand::{Dof, Finger, Moment, PerDof, Span, TactileBlock};
use handscope::sim::body_params::STROKE;
use handscope::sim::body_params::random::random;
use handscope::sim::body_params::{BodyParams, JointBody};
use handscope::sim::drive::{Drive, DriveGoal, DriveSettings};
use handscope::sim::{Object, Obstacle, Personality, Scenario, SimConfig, SimHand};

const SLOW: DriveSettings = DriveSettings {
    speed: 100.0,
    threshold_g: 500.0,
};

/// What one close on a block came to.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Close {
    began_ms: u64,
    contact: f64,
    peak_g: f64,
    ms: u64,
}

fn on_block(drive: &mut Drive, from: u64) -> Close {
    drive.set_contact(Some(Obstacle::at(500.0, RIGID_G_PER_COUNT)));
    drive.command(DriveGoal::Position(STROKE), from);
    let start = drive.position();
    let mut close = Close {
        began_ms: 0,
        contact: 0.0,
        peak_g: 0.0,
        ms: 0,
    };
    for ms in 0..30_000 {
        drive.step(from + ms, SLOW);
        if close.began_ms == 0 && drive.position() > start {
            close.began_ms = ms;
        }
        if close.contact == 0.0 && drive.load_g() > 0.0 {
            close.contact = drive.position();
            close.ms = ms;
        }
        close.peak_g = close.peak_g.max(drive.load_g());
    }
    close
}

fn of(change: impl Fn(&mut JointBody)) -> Close {
    let mut joint = JointBody::default();
    change(&mut joint);
    on_block(&mut Drive::of(joint, 25.0, 7), 0)
}

fn open(drive: &mut Drive, from: u64) {
    drive.command(DriveGoal::Position(0.0), from);
    for ms in 0..30_000 {
        drive.step(from + ms, SLOW);
    }
}

#[test]
fn each_number_of_a_joint_is_felt() {
    let usual = of(|_| ());
    assert_eq!(usual, on_block(&mut Drive::new(25.0), 0));
    let over = |close: Close| close.peak_g - SLOW.threshold_g;
    let late = of(|joint| joint.latency_ms = 128.0);
    assert_eq!(late.began_ms, usual.began_ms + 64);
    assert!((over(late) / over(usual) - 2.0).abs() < 0.05, "{late:?}");
    let stiff = of(|joint| joint.stiffness_factor = 2.0);
    assert!((over(stiff) / over(usual) - 2.0).abs() < 0.05, "{stiff:?}");
    let deeper = of(|joint| joint.contact_offset = 30.0);
    assert!((deeper.contact - usual.contact - 30.0).abs() < 1.0);
    let second = of(|joint| joint.run_on = 1.0);
    assert!(over(second) > over(usual) + 50.0, "{second:?}");
    let slow = of(|joint| joint.counts_per_speed /= 2.0);
    assert!(slow.ms > 19 * usual.ms / 10, "{slow:?} {usual:?}");
    let slack = of(|joint| joint.backlash = 20.0);
    assert!(slack.ms > usual.ms + 40, "{slack:?} {usual:?}");
}

#[test]
fn contact_and_latency_are_drawn_anew_each_close_and_the_same_seed_draws_the_same() {
    let joint = JointBody {
        contact_scatter: 7.5,
        latency_scatter_ms: 3.0,
        ..JointBody::default()
    };
    let closes = |seed| -> Vec<Close> {
        let mut drive = Drive::of(joint, 25.0, seed);
        let close = |nth: u64| {
            let close = on_block(&mut drive, nth * 60_000);
            open(&mut drive, nth * 60_000 + 30_000);
            close
        };
        (0..12).map(close).collect()
    };
    let first = closes(1);
    assert_eq!(first, closes(1));
    assert_ne!(first, closes(2));
    let mean = first.iter().map(|close| close.contact).sum::<f64>() / 12.0;
    let spread = first.iter().map(|close| (close.contact - mean).powi(2));
    let sigma = (spread.sum::<f64>() / 11.0).sqrt();
    assert!((4.0..12.0).contains(&sigma), "{sigma}");
    let mut peaks: Vec<f64> = first.iter().map(|close| close.peak_g).collect();
    peaks.dedup();
    assert_eq!(peaks.len(), 12, "{peaks:?}");
}

fn hand(body: BodyParams) -> SimHand {
    SimHand::new(SimConfig {
        scenario: Scenario::Free,
        body,
        ..SimConfig::default()
    })
}

fn at(ms: u64) -> Moment {
    Moment::ZERO.plus(std::time::Duration::from_millis(ms))
}

#[test]
fn a_weak_supply_slows_all_joints_at_once_and_one_alone_not() {
    let mut body = BodyParams::default();
    body.supply.sag = 0.5;
    let reached = |joints: usize| {
        let mut hand = hand(body);
        hand.write(1522, &[100, 0].repeat(6), at(10)).unwrap();
        let mut angles = vec![];
        for nth in 0..6 {
            let target: i16 = if nth < joints { 0 } else { -1 };
            angles.extend(target.to_le_bytes());
        }
        hand.write(1486, &angles, at(20)).unwrap();
        hand.advance_to(at(1500));
        1000.0 - hand.true_angles()[Dof::Little]
    };
    let (alone, all) = (reached(1), reached(6));
    assert!((all / alone - 0.5).abs() < 0.02, "{alone} {all}");
}

#[test]
fn dead_and_drifting_channels_show_in_the_fingertips_block() {
    let mut body = BodyParams::default();
    body.fingertips[Finger::Index].dead[2] = true;
    body.fingertips[Finger::Index].drift[4] = 10_000.0;
    let mut hand = hand(body);
    let span = handscope::hand::Group::Tactile(Finger::Index).span();
    let mut block = |ms| TactileBlock::decode(&hand.read(span, at(ms)).unwrap()).unwrap();
    let (early, late) = (block(100), block(10_100));
    assert_eq!((early.raw[2], late.raw[2]), (0, 0));
    assert!(late.raw[4] - early.raw[4] > 98_000);
    assert!(late.raw[5].abs_diff(early.raw[5]) < 1000);
}

#[test]
fn zero_and_noise_of_the_force_are_the_bodys() {
    let mut body = BodyParams::default();
    body.joints[Dof::Ring].force_zero_g = 220.0;
    body.joints[Dof::Ring].force_noise_g = 0.0;
    let mut hand = hand(body);
    let mut forces = |ms| -> PerDof<i16> {
        let bytes = hand.read(Span::new(1582, 12), at(ms)).unwrap();
        let (pairs, _) = bytes.as_chunks::<2>();
        PerDof::from_fn(|dof| i16::from_le_bytes(pairs[dof.index()]))
    };
    let (first, second) = (forces(100), forces(200));
    assert_eq!(first[Dof::Ring], second[Dof::Ring]);
    assert!((212..=224).contains(&first[Dof::Ring]), "{first:?}");
    assert_ne!(first[Dof::Index], second[Dof::Index]);
}

#[test]
fn a_drawn_body_stays_within_what_the_manual_allows() {
    for seed in 0..5 {
        let mut hand = SimHand::new(SimConfig {
            scenario: Scenario::Rigid,
            body: random(seed),
            ..SimConfig::default()
        });
        hand.set_object(&Object::rigid(500.0));
        hand.write(1486, &[0; 12], at(10)).unwrap();
        for ms in (20..6000).step_by(50) {
            let position = hand.read(Span::new(1534, 12), at(ms)).unwrap();
            let (pairs, _) = position.as_chunks::<2>();
            for pair in pairs {
                assert!((0..=2000).contains(&i16::from_le_bytes(*pair)));
            }
        }
    }
}

/// The highest load of a close on a block, where FORCE_SET is 400 g and the sensor reads about `zero_g` at rest.
fn load_at_400(zero_g: f64, compared: &str) -> (f64, i16) {
    let mut personality = Personality::default();
    personality.set("force-compared", compared).unwrap();
    let mut body = BodyParams::default();
    body.joints[Dof::Index].force_zero_g = zero_g;
    let mut hand = SimHand::new(SimConfig {
        scenario: Scenario::Free,
        personality,
        body,
        ..SimConfig::default()
    });
    hand.set_object(&Object::rigid(500.0));
    let six = |value: i16| -> Vec<u8> { value.to_le_bytes().repeat(6) };
    hand.write(1522, &six(25), at(10)).unwrap();
    hand.write(1498, &six(400), at(10)).unwrap();
    hand.write(1486, &six(0), at(20)).unwrap();
    let mut highest: f64 = 0.0;
    for ms in (30..30_000).step_by(10) {
        hand.advance_to(at(ms));
        highest = highest.max(hand.true_loads()[Finger::Index]);
    }
    let angle = hand.read(Span::new(1552, 2), at(30_000)).unwrap();
    (highest, i16::from_le_bytes([angle[0], angle[1]]))
}

#[test]
fn a_drive_compares_its_threshold_with_force_act_as_read_or_with_the_load() {
    let (usual, _) = load_at_400(0.0, "as-read");
    for zero_g in [-60.0, 150.0, 230.0] {
        let (counted, _) = load_at_400(zero_g, "as-read");
        let (load, _) = load_at_400(zero_g, "load");
        // Less is run past a lower threshold, too.
        let less = usual - counted;
        assert!(
            (less / zero_g - 1.1).abs() < 0.2,
            "{zero_g}: {usual} {counted}"
        );
        assert!((load - usual).abs() < 15.0, "{zero_g}: {usual} {load}");
    }
    // What it reads without a load is above the threshold: it does not close at all.
    assert_eq!(load_at_400(450.0, "as-read"), (0.0, 1000));
    assert!(load_at_400(450.0, "load").0 > 400.0);
}
