//! A check-up on bodies that it does not know: healthy ones, and each kind of wear at the size that it is to be found at.

use crate::trials::virtual_hand::{VirtualHand, object};
use crate::trials::worn::{JOINT, WEARS, checked, checked_with, finds, started, told};
use handscope::checkup::check::{checks, stopped_early};
use handscope::checkup::free_file;
use handscope::checkup::report::{CheckupReport, Keeping};
use handscope::checkup::{Checkup, CheckupPlan, Grade, HandPart, Subject};
use handscope::hand::register::FORCE_ACT;
use handscope::hand::{ArmEpoch, Dof, Fault, Finger, Moment, Span};
use handscope::motion::checkup::{CheckupFiles, EndedCheckup};
use handscope::motion::drive::Driven;
use handscope::record::Abort;
use handscope::sim::body_params::random::random;
use handscope::sim::{BodyParams, ForceCompared, Object};
use handscope::transport::Endpoint;

/// Noise of a force sensor, either way.
const NOISE_G: f64 = 8.0;
/// What drives compare their thresholds with, the manual's first.
const DRIVES: [ForceCompared; 2] = [ForceCompared::AsRead, ForceCompared::Load];

#[test]
fn healthy_bodies_are_told_to_be_healthy() {
    let (mut figures, mut wrong) = (0, Vec::new());
    for seed in 0..25 {
        let checks = checked(random(seed), seed, &[]);
        figures += checks.len();
        wrong.extend(told(&checks));
    }
    assert_eq!(figures, 25 * (6 * 16 + 5 * 3 + 1));
    assert!(wrong.len() * 50 < 25, "{wrong:?}");
}

#[test]
fn both_kinds_of_drives_get_the_same_verdicts() {
    let verdicts = |compared, body, seed| {
        let told = told(&checked_with(compared, (body, seed), &[]));
        let whats = told.into_iter().map(|(what, of, _)| (what, of));
        whats.collect::<Vec<_>>()
    };
    let healthy = (0..4).map(|seed| ("healthy", random(seed), seed));
    let worn = (4..).zip(WEARS).map(|(seed, (name, wear, _))| {
        let mut body = random(seed);
        wear(&mut body);
        (name, body, seed)
    });
    for (name, body, seed) in healthy.chain(worn) {
        let [as_read, load] = DRIVES.map(|compared| verdicts(compared, body, seed));
        assert_eq!(as_read, load, "{name}, {seed}");
    }
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
    assert_eq!(whats, [(Subject::ClosingCurrent, HandPart::Joint(JOINT))]);
}

#[test]
fn nothing_goes_beyond_its_limits_and_a_fault_ends_it() {
    let mut hand = VirtualHand::counting(BodyParams::default(), 1, &Object::none());
    let (checkup, _) = hand.run(started(), |_, _| ());
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
    let mut hand = VirtualHand::counting(BodyParams::default(), 1, &Object::none());
    let (checkup, stopped) = hand.run(started(), |hand, checkup| {
        if checkup.view().joint == Some(Dof::Index) {
            hand.inject_fault(Dof::Index, Fault::OverCurrent);
        }
    });
    assert!(
        stopped
            && matches!(
                checkup.aborted(),
                Some(Abort::Fault {
                    joint: Some((Dof::Index, _))
                })
            )
    );
    // What was not measured is not known, and is not called good.
    let checks = checks(checkup.measured(), "", &[]);
    let supply = checks
        .iter()
        .find(|check| check.measured.what == Subject::SlowerTogether);
    assert_eq!(supply.unwrap().grade, Grade::Unknown);
}

#[test]
fn no_joint_moves_while_another_does_not_open() {
    let mut hand = VirtualHand::counting(BodyParams::default(), 1, &Object::none());
    let (checkup, stopped) = hand.run(started(), |hand, checkup| {
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

/// The most that a fingertip was pressed with in a check-up of a hand with something in it, and how it ended, g.
fn pressed(
    compared: ForceCompared,
    (zero_g, stiffness): (f64, f64),
) -> (f64, Checkup, VirtualHand) {
    let mut body = BodyParams::default();
    for (_, joint) in body.joints.iter_mut() {
        joint.force_zero_g = zero_g;
    }
    let mut hand = VirtualHand::with(compared, (body, 1), &object(stiffness, None));
    let mut most = 0.0_f64;
    let (checkup, _) = hand.run(started(), |hand, _| {
        let loads = hand.true_loads();
        most = loads.iter().map(|(_, grams)| *grams).fold(most, f64::max);
    });
    (most, checkup, hand)
}

#[test]
fn what_stands_in_the_hand_ends_it_at_once_whatever_the_sensors_say_of_nothing() {
    for compared in DRIVES {
        for zero_g in [-170.0, -50.0, 0.0, 75.0, 110.0, 145.0, 240.0, 400.0] {
            for stiffness in [0.3, 1.0, 3.0] {
                something_ends_it(compared, zero_g, stiffness);
            }
        }
    }
}

fn something_ends_it(compared: ForceCompared, zero_g: f64, stiffness: f64) {
    let case = format!("{compared:?} {zero_g} {stiffness}");
    let (most, checkup, hand) = pressed(compared, (zero_g, stiffness));
    // What is too soft to be felt stops a joint early all the same.
    let why = checkup.aborted();
    let said = matches!(why, Some(Abort::NotEmpty { .. } | Abort::Ceiling { .. }));
    let all = checks(checkup.measured(), "", &[]);
    let early = stopped_early(&all).is_some();
    assert!(said || early, "{case}: {why:?}");
    assert!(said || zero_g < -100.0, "{case}");
    assert!(most <= 300.0, "{case}: {most}");
    let highest = forces_written(&hand).into_iter().max();
    // A drive that counts its zero is given as much above that.
    let above = match compared {
        ForceCompared::AsRead => 500.0,
        ForceCompared::Load => 150.0,
    };
    let limit = (zero_g + 165.0).clamp(20.0, above);
    let limit = limit.max(if zero_g > -50.0 { 150.0 } else { 20.0 });
    assert!(f64::from(highest.unwrap()) <= limit, "{case}: {highest:?}");
}

/// The force thresholds that were sent for closing: for the little finger, which closes first.
fn forces_written(hand: &VirtualHand) -> Vec<i16> {
    let journal = hand.hand.journal().iter();
    let forces = journal.filter(|own| (1498..1510).contains(&own.address));
    let all = forces.map(|own| {
        let (shorts, _) = own.bytes.as_chunks::<2>();
        let shorts = shorts.iter().map(|short| i16::from_le_bytes(*short));
        shorts.collect::<Vec<_>>()
    });
    // The first write is for opening from wherever the joints are.
    all.skip(1).flatten().collect()
}

/// What the force sensor of the default body reads at rest, to half a gram.
fn reads_at_rest() -> f64 {
    let mut body = BodyParams::default();
    body.joints[JOINT].force_noise_g = 0.0;
    let mut hand = VirtualHand::counting(body, 1, &Object::none()).hand;
    let at = FORCE_ACT.address + 2 * u16::try_from(JOINT.index()).unwrap();
    let read = hand.read(Span::new(at, 2), Moment::ZERO).unwrap();
    i16::from_le_bytes([read[0], read[1]]).into()
}

/// Checks up a hand that touches nothing, one of whose sensors reads so much at rest; whether its joint turned back on its way.
fn turned_back(zero_g: f64) -> bool {
    let mut body = BodyParams::default();
    body.joints[JOINT].force_zero_g = zero_g;
    body.joints[JOINT].force_noise_g = NOISE_G;
    let mut hand = VirtualHand::counting(body, 1, &Object::none());
    let (mut least, mut turned) = (1000.0_f64, false);
    let (checkup, stopped) = hand.run(started(), |hand, _| {
        let angle = hand.true_angles()[JOINT];
        least = if angle > 990.0 {
            angle
        } else {
            least.min(angle)
        };
        // All six go to 700 once and back.
        let on_its_way = (50.0..980.0).contains(&least) && (least - 700.0).abs() > 5.0;
        turned |= on_its_way && angle > least + 20.0;
    });
    assert_eq!((checkup.aborted(), stopped), (None, false), "{zero_g}");
    let told = told(&checks(checkup.measured(), "", &[]));
    assert_eq!(told, [], "{zero_g}");
    turned
}

#[test]
fn a_joint_that_its_own_offset_stops_anywhere_on_its_way_goes_the_whole_way() {
    for zero_g in [152.0, 200.0, 240.0] {
        assert!(!turned_back(zero_g), "{zero_g}: it did not begin");
    }
    // Seldom does the noise reach the threshold, and then it is anywhere.
    let reaches = 150.0 - NOISE_G - reads_at_rest();
    let zeros = (-2..=4).map(|quarters| reaches + f64::from(quarters) / 4.0);
    let turned = zeros.filter(|zero_g| turned_back(*zero_g)).count();
    assert!(turned >= 2, "{turned}");
}

#[test]
fn a_joint_whose_zero_is_far_off_is_left_alone_and_told() {
    for zero_g in [-600.0, -300.0, 700.0] {
        let (most, checkup, _) = pressed(ForceCompared::AsRead, (zero_g, 3.0));
        assert!(most < 1.0, "{zero_g}: {most}");
        assert_eq!(checkup.left_alone().len(), 6, "{zero_g}");
        let all = checks(checkup.measured(), "", &[]);
        assert_eq!(stopped_early(&all), Some(Dof::Little), "no birth record");
    }
    let mut body = BodyParams::default();
    body.joints[JOINT].force_zero_g = -600.0;
    let mut hand = VirtualHand::counting(body, 1, &Object::none());
    let (checkup, stopped) = hand.run(started(), |hand, _| {
        assert!(hand.true_angles()[JOINT] > 990.0);
    });
    assert_eq!((checkup.aborted(), stopped), (None, false));
    let [(dof, _)] = checkup.left_alone()[..] else {
        panic!("{:?}", checkup.left_alone());
    };
    assert_eq!(dof, JOINT);
    let all = checks(checkup.measured(), "", &[]);
    let of = |what: Subject, of: HandPart| {
        let own = all
            .iter()
            .find(|own| (own.measured.what, own.measured.of) == (what, of));
        own.unwrap().grade
    };
    assert_eq!(of(Subject::ForceZero, HandPart::Joint(JOINT)), Grade::Act);
    assert_eq!(
        of(Subject::ClosingSpeed, HandPart::Joint(JOINT)),
        Grade::Unknown
    );
    assert_eq!(
        of(Subject::ClosingSpeed, HandPart::Joint(Dof::Index)),
        Grade::Fine
    );
}

#[test]
fn a_joint_that_is_jammed_is_measured_so_and_makes_no_birth_record() {
    let mut hand = VirtualHand::counting(BodyParams::default(), 1, &Object::none());
    hand.hand.set_jam(JOINT, Some(300.0));
    let (checkup, _) = hand.run(started(), |hand, _| {
        // The drive calls that a stall before it is told to open.
        hand.set_jam(JOINT, Some(300.0));
    });
    let all = checks(checkup.measured(), "", &[]);
    assert_eq!(stopped_early(&all), Some(JOINT), "{:?}", checkup.aborted());
}

#[test]
fn pressed_fingertips_answer_and_a_dead_channel_is_named() {
    let plan = CheckupPlan { press: true };
    let mut body = BodyParams::default();
    body.fingertips[Finger::Ring].dead[3] = true;
    let mut hand = VirtualHand::counting(body, 1, &Object::none());
    let mut asked = Vec::new();
    let (mut held, mut open) = (0, true);
    let (checkup, stopped) = hand.run(Checkup::start(ArmEpoch(1), plan), |hand, checkup| {
        let finger = checkup.view().press;
        if let Some(finger) = finger.filter(|finger| asked.last() != Some(finger)) {
            asked.push(finger);
            held = 0;
        }
        held += 1;
        // The little finger is forgotten; the others are pressed for a second.
        for tip in Finger::ALL {
            let is_pressed = finger == Some(tip) && tip != Finger::Little && held < 100;
            hand.press_tip(tip, if is_pressed { 800.0 } else { 0.0 });
        }
        open &= finger.is_none() || hand.true_angles().iter().all(|(_, angle)| *angle > 990.0);
    });
    assert_eq!(
        (checkup.aborted(), stopped, hand.disarmed),
        (None, false, true)
    );
    assert!(open, "nothing moves");
    assert_eq!(asked.first(), Some(&Finger::Thumb));
    assert_eq!(asked.len(), 5);
    let all = checks(checkup.measured(), "", &[]);
    let silent = |finger: Finger| {
        let mut own = all
            .iter()
            .filter(|own| own.measured.what == Subject::SilentChannels);
        let own = own
            .find(|own| own.measured.of == HandPart::Fingertip(finger))
            .unwrap();
        (own.grade, own.measured.channels.to_string())
    };
    assert_eq!(silent(Finger::Ring), (Grade::Act, "4".to_owned()));
    assert_eq!(silent(Finger::Thumb), (Grade::Fine, String::new()));
    assert_eq!(silent(Finger::Little), (Grade::Unknown, String::new()));
}

/// Checks a body up, and makes of it what the program does.
fn concluded(files: &CheckupFiles, backlash: f64, jam: Option<f64>) -> CheckupReport {
    let mut body = BodyParams::default();
    body.joints[JOINT].backlash = backlash;
    let mut hand = VirtualHand::counting(body, 1, &Object::none());
    hand.hand.set_jam(JOINT, jam);
    let (checkup, _) = hand.run(started(), |_, _| ());
    let driven = Driven {
        end: checkup.aborted().map_or(Ok(()), Err),
        program: checkup,
        stop: None,
    };
    let done = files.conclude(EndedCheckup {
        driven,
        recording: None,
    });
    done.written.unwrap().unwrap();
    done.report
}

#[test]
fn what_is_kept_makes_a_birth_record_of_a_whole_hand_and_a_trend_of_later_ones() {
    let folder = tempfile::tempdir().unwrap();
    let hand: Endpoint = "rtu:/dev/ttyUSB0".parse().unwrap();
    let files = CheckupFiles {
        free_force: Some(folder.path().join("free.json")),
        kept: CheckupFiles::kept_in(folder.path(), &hand),
        report: Some(folder.path().join("out")),
        recordings: None,
        hand,
    };
    assert_eq!(files.last().unwrap(), None);
    // A jam in the way of the first is no birth record; in the way of a later one it is part of the trend.
    let first = concluded(&files, 0.0, Some(300.0));
    let keeping = match first.aborted {
        None => Keeping::NotAsFirst { dof: JOINT },
        Some(_) => Keeping::Partial,
    };
    assert_eq!(first.keeping, keeping);
    assert_eq!(files.earlier().unwrap(), []);
    let free = || free_file::read(files.free_force.as_deref().unwrap()).unwrap();
    assert_eq!(free().known().next(), None);
    for (earlier, backlash) in [0.0, 3.0, 6.0, 9.0, 12.0].into_iter().enumerate() {
        let report = concluded(&files, backlash, None);
        assert_eq!(
            report.keeping,
            Keeping::Kept { earlier },
            "{:?}",
            report.aborted
        );
        assert_eq!(report.earlier, earlier);
    }
    // Nothing was in the way, so what the joints read then is their free motion.
    for dof in Dof::ALL {
        for angle in [100, 500, 900] {
            let known = free().at(dof, angle);
            assert!(
                known.is_some_and(|g| g.abs() < 30.0),
                "{dof:?} {angle}: {known:?}"
            );
        }
    }
    let (last, page) = files.last().unwrap().unwrap();
    assert_eq!(page, files.report);
    let of = HandPart::Joint(JOINT);
    let mut own = last.checks.iter();
    let own = own.find(|own| (own.measured.what, own.measured.of) == (Subject::Backlash, of));
    let own = own.unwrap();
    assert_eq!(own.trend.points.len(), 5);
    let drift = own.drift().unwrap();
    assert!(drift.from < 1.0 && drift.to > 11.0, "{drift:?}");
    let drifting = last.checks.iter().filter(|own| own.drift().is_some());
    assert_eq!(drifting.count(), 1, "nothing else drifts");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("<polyline") && page.contains("counts over 5 check-ups since"));
}
