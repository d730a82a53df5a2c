//! What the simulated hand's bytes say over time. Servers are tested elsewhere.

use handscope::hand::register::{
    ANGLE_ACT, ANGLE_SET, CURRENT, ERROR, FORCE_ACT, FORCE_SET, POS_ACT, Register, SPEED_SET,
    STATUS, TEMP,
};
use handscope::hand::{Dof, Fault, Finger, Moment, Span, TactileBlock};
use handscope::hand::{Group, HandSample, Reply};
use handscope::sim::{
    GapAnswer, MinusOne, Object, OutOfRangeWrite, Personality, SaveAnswer, SaveFrame, Scenario,
    SimConfig, SimHand, SpeedZero,
};
use std::collections::HashSet;

fn at(ms: u64) -> Moment {
    Moment::from_micros(ms * 1000)
}

fn hand(scenario: Scenario, personality: Personality) -> SimHand {
    SimHand::new(SimConfig {
        seed: 7,
        id: 1,
        scenario,
        personality,
        ..SimConfig::default()
    })
}

fn idle() -> SimHand {
    hand(Scenario::Idle, Personality::default())
}

fn shorts(hand: &mut SimHand, row: &Register, ms: u64) -> [i16; 6] {
    let bytes = hand.read(row.span(), at(ms)).unwrap();
    std::array::from_fn(|i| i16::from_le_bytes([bytes[2 * i], bytes[2 * i + 1]]))
}

fn bytes(hand: &mut SimHand, row: &Register, ms: u64) -> Vec<u8> {
    hand.read(row.span(), at(ms)).unwrap()
}

fn put(hand: &mut SimHand, address: u16, values: &[i16], ms: u64) -> usize {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    hand.write(address, &bytes, at(ms)).unwrap().taken
}

fn block(hand: &mut SimHand, finger: Finger, ms: u64) -> TactileBlock {
    TactileBlock::decode(&hand.read(Group::Tactile(finger).span(), at(ms)).unwrap()).unwrap()
}

#[test]
fn nothing_moves_by_itself_and_power_up_targets_are_where_the_joints_are() {
    let mut hand = idle();
    assert_eq!(shorts(&mut hand, &ANGLE_SET, 0), [1000; 6]);
    assert_eq!(shorts(&mut hand, &SPEED_SET, 0), [1000; 6]);
    for ms in [0, 1000, 20_000] {
        assert_eq!(shorts(&mut hand, &ANGLE_ACT, ms), [1000; 6]);
        assert_eq!(shorts(&mut hand, &CURRENT, ms), [0; 6]);
        assert_eq!(bytes(&mut hand, &STATUS, ms), [2; 6]);
        assert_eq!(bytes(&mut hand, &ERROR, ms), [0; 6]);
        assert!(
            bytes(&mut hand, &TEMP, ms)
                .iter()
                .all(|t| (25..=30).contains(t))
        );
        assert!(
            shorts(&mut hand, &FORCE_ACT, ms)
                .iter()
                .all(|f| f.abs() < 20)
        );
        assert!(
            Finger::ALL
                .into_iter()
                .all(|f| block(&mut hand, f, ms).normal_n == 0.0)
        );
    }
}

#[test]
fn position_and_angle_run_against_each_other() {
    let mut hand = idle();
    hand.set_object(&Object::none());
    put(&mut hand, 1486, &[0, 250, 500, 750, 1000, -1], 0);
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 63), [1000; 6]);
    assert_eq!(bytes(&mut hand, &STATUS, 100)[..2], [1, 1]);
    assert_eq!(
        shorts(&mut hand, &ANGLE_ACT, 900),
        [0, 250, 500, 750, 1000, 1000]
    );
    assert_eq!(
        shorts(&mut hand, &POS_ACT, 900),
        [2000, 1500, 1000, 500, 0, 0]
    );
    put(&mut hand, 1486, &[1000], 900);
    assert_eq!(bytes(&mut hand, &STATUS, 1100)[0], 0);
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 2000)[0], 1000);
}

#[test]
fn a_closing_finger_nears_touches_and_stops_at_its_force() {
    let mut hand = idle();
    put(&mut hand, 1522, &[200; 6], 0);
    put(&mut hand, 1498, &[500; 6], 0);
    put(&mut hand, 1486, &[-1, -1, -1, 0, -1, -1], 0);
    let open = block(&mut hand, Finger::Index, 0).proximity;
    let mut before_contact = open;
    for ms in 0..4000 {
        let block = block(&mut hand, Finger::Index, ms);
        assert!(block.check_ok());
        if block.normal_n > 0.0 {
            break;
        }
        before_contact = block.proximity;
        assert_eq!((block.direction_raw, block.tangential_n), (65535, 0.0));
    }
    assert!(before_contact > open + 100_000);
    let force = shorts(&mut hand, &FORCE_ACT, 4000);
    assert!((400..600).contains(&force[3]), "{force:?}");
    assert_eq!(bytes(&mut hand, &STATUS, 4000)[3], 3);
    let held = block(&mut hand, Finger::Index, 4000);
    assert!((f64::from(held.normal_n) - f64::from(force[3]) * 0.0098).abs() < 0.2);
    assert!(held.direction_deg().is_some() && held.tangential_n > 0.0);
    assert!(block(&mut hand, Finger::Ring, 4000).normal_n == 0.0);
}

#[test]
fn every_status_and_every_fault_bit_is_reached_in_the_faults_scenario() {
    let mut hand = hand(Scenario::Faults, Personality::default());
    let (mut statuses, mut faults, mut most) = (HashSet::new(), 0, 0);
    for ms in (0..12_000).step_by(50) {
        statuses.extend(bytes(&mut hand, &STATUS, ms));
        let now = bytes(&mut hand, &ERROR, ms);
        faults |= now.iter().fold(0, |all, byte| all | byte);
        most = most.max(now.iter().filter(|byte| **byte != 0).count());
    }
    assert!(
        [0, 1, 2, 3, 5, 6, 7]
            .iter()
            .all(|code| statuses.contains(code)),
        "{statuses:?}"
    );
    assert_eq!(faults, 0x1F);
    assert!(most >= 4);
}

#[test]
fn clear_error_clears_all_but_over_temperature_which_ends_by_itself() {
    let mut hand = idle();
    for (dof, fault) in Dof::ALL.into_iter().zip([
        Fault::Stall,
        Fault::OverTemperature,
        Fault::OverCurrent,
        Fault::Motor,
        Fault::Communication,
        Fault::Stall,
    ]) {
        hand.inject_fault(dof, fault);
    }
    assert_eq!(bytes(&mut hand, &ERROR, 10), [1, 2, 4, 8, 16, 1]);
    hand.write(1004, &[1], at(20)).unwrap();
    assert_eq!(bytes(&mut hand, &ERROR, 30), [0, 2, 0, 0, 0, 0]);
    assert_eq!(bytes(&mut hand, &STATUS, 30), [2, 7, 2, 2, 2, 2]);
    assert_eq!(hand.read(Span::new(1004, 1), at(30)).unwrap(), [0]);
    assert_eq!(bytes(&mut hand, &ERROR, 40_000), [0; 6]);
}

#[test]
fn save_answers_late_and_only_saved_parameters_outlive_the_power() {
    let mut hand = idle();
    put(&mut hand, 1032, &[300; 6], 0);
    put(&mut hand, 1044, &[400; 6], 0);
    hand.write(1700, &[10, 0, 0, 9], at(0)).unwrap();
    assert_eq!(hand.write(1000, &[5], at(0)).unwrap().ack_id, 5);
    hand.write(1002, &[3], at(0)).unwrap();
    hand.write(1005, &[1], at(500)).unwrap();
    assert_eq!(
        (hand.baud_code(), hand.late_save_result(at(1499))),
        (0, None)
    );
    let ok = SaveFrame {
        command: 0x12,
        ok: true,
    };
    assert_eq!(hand.late_save_result(at(1500)), Some(ok));
    assert_eq!(hand.late_save_result(at(9000)), None);
    hand.write(1000, &[9], at(2000)).unwrap();
    put(&mut hand, 1486, &[600; 6], 2000);
    hand.power_cycle(at(4000));
    assert_eq!((hand.id(), hand.baud_code()), (5, 3));
    assert_eq!(shorts(&mut hand, &SPEED_SET, 4000), [300; 6]);
    assert_eq!(
        hand.read(Span::new(1498, 2), at(4000)).unwrap(),
        [0x90, 0x01]
    );
    assert_eq!(
        hand.read(Span::new(1700, 4), at(4000)).unwrap(),
        [10, 0, 0, 9]
    );
    assert_eq!(shorts(&mut hand, &ANGLE_SET, 4000), [600; 6]);
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 9000), [600; 6]);
    hand.write(1006, &[1], at(9000)).unwrap();
    assert_eq!(hand.id(), 1);
    assert_eq!(
        hand.read(Span::new(1032, 2), at(9000)).unwrap(),
        [0xE8, 0x03]
    );
}

#[test]
fn save_answers_as_its_personality_says() {
    for (answer, frame, kept) in [
        (SaveAnswer::Command11, Some((0x11, true)), 300),
        (SaveAnswer::Command12, Some((0x12, true)), 300),
        (SaveAnswer::Failed, Some((0x12, false)), 1000),
        (SaveAnswer::Never, None, 300),
    ] {
        let mut hand = hand(
            Scenario::Idle,
            Personality {
                save_frame: answer,
                ..Personality::default()
            },
        );
        put(&mut hand, 1032, &[300; 6], 0);
        hand.write(1005, &[1], at(0)).unwrap();
        let got = hand.late_save_result(at(1000));
        assert_eq!(got.map(|frame| (frame.command, frame.ok)), frame);
        hand.power_cycle(at(2000));
        assert_eq!(shorts(&mut hand, &SPEED_SET, 2000), [kept; 6], "{answer:?}");
    }
}

#[test]
fn force_calibration_zeroes_the_sensors_after_six_seconds() {
    let mut hand = idle();
    let before = mean_force(&mut hand, 0);
    assert!(before.iter().any(|force| force.abs() > 2.0), "{before:?}");
    hand.write(1009, &[1], at(2000)).unwrap();
    let after = mean_force(&mut hand, 8100);
    assert!(after.iter().all(|force| force.abs() < 1.0), "{after:?}");
}

fn mean_force(hand: &mut SimHand, from: u64) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for ms in (0..1000).step_by(10) {
        for (sum, force) in sum.iter_mut().zip(shorts(hand, &FORCE_ACT, from + ms)) {
            *sum += f64::from(force) / 100.0;
        }
    }
    sum
}

#[test]
fn personalities_differ_where_the_manual_is_silent() {
    let with = |personality| {
        let mut hand = hand(Scenario::Idle, personality);
        hand.set_object(&Object::none());
        hand
    };
    let plain = Personality::default();

    let mut clamps = with(Personality {
        out_of_range: OutOfRangeWrite::Clamp,
        ..plain
    });
    assert_eq!(put(&mut clamps, 1486, &[-7, 1013], 0), 2);
    assert_eq!(shorts(&mut clamps, &ANGLE_SET, 0)[..2], [0, 1000]);
    let mut drops = with(plain);
    assert_eq!(put(&mut drops, 1486, &[-7, 1013], 0), 0);
    assert_eq!(shorts(&mut drops, &ANGLE_SET, 0)[..2], [1000, 1000]);

    for (minus_one_mid_move, stops) in [(MinusOne::Freeze, true), (MinusOne::Ignore, false)] {
        let mut hand = with(Personality {
            minus_one_mid_move,
            ..plain
        });
        put(&mut hand, 1486, &[0; 6], 0);
        put(&mut hand, 1486, &[-1; 6], 200);
        assert_eq!(shorts(&mut hand, &ANGLE_ACT, 2000) != [0; 6], stops);
    }
    for (speed_zero, moves) in [(SpeedZero::Freeze, false), (SpeedZero::Slowest, true)] {
        let mut hand = with(Personality {
            speed_zero,
            ..plain
        });
        put(&mut hand, 1522, &[0; 6], 0);
        put(&mut hand, 1486, &[0; 6], 0);
        assert_eq!(shorts(&mut hand, &ANGLE_ACT, 2000) != [1000; 6], moves);
    }
    let mut closed = with(Personality {
        gap: GapAnswer::Refused,
        ..plain
    });
    assert!(closed.read(Span::new(1546, 78), at(0)).is_err());
    assert!(closed.read(Span::new(1546, 12), at(0)).is_ok());
    let mut stamps = with(Personality {
        stamp_gap: true,
        ..plain
    });
    let stamp = stamps
        .read(Span::new(1558, 8), Moment::from_micros(1_234_567))
        .unwrap();
    assert_eq!(u64::from_le_bytes(stamp.try_into().unwrap()), 1_234_567);
}

#[test]
fn equal_seeds_and_calls_give_equal_bytes_however_often_time_is_told() {
    for scenario in Scenario::ALL {
        let (mut often, mut seldom) = (
            hand(scenario, Personality::default()),
            hand(scenario, Personality::default()),
        );
        for us in (0..3_000_000).step_by(333) {
            often.advance_to(Moment::from_micros(us));
        }
        let whole = [Span::new(1474, 150), Span::new(3000, 290)];
        for span in whole {
            assert_eq!(
                often.read(span, at(3000)).unwrap(),
                seldom.read(span, at(3000)).unwrap(),
                "{scenario:?}"
            );
        }
    }
    let other = SimConfig {
        seed: 8,
        ..SimConfig::default()
    };
    let mut other = SimHand::new(other);
    assert_ne!(
        other.read(Span::new(3000, 290), at(100)).unwrap(),
        idle().read(Span::new(3000, 290), at(100)).unwrap()
    );
}

#[test]
fn the_grasp_at_three_seconds_shows_force_current_and_touch_on_all_fingers() {
    let mut hand = hand(Scenario::Grasp, Personality::default());
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 300), [1000; 6]);
    assert!(
        shorts(&mut hand, &ANGLE_ACT, 800)[..5]
            .iter()
            .all(|a| *a < 1000)
    );
    let held = shorts(&mut hand, &FORCE_ACT, 2000);
    assert!(held[..5].iter().all(|force| *force > 250), "{held:?}");
    let force = shorts(&mut hand, &FORCE_ACT, 3000);
    let distinct: HashSet<i16> = force[..5].iter().map(|force| force / 10).collect();
    assert!(distinct.len() >= 4, "{force:?}");
    assert!(
        shorts(&mut hand, &CURRENT, 3000)[..5]
            .iter()
            .all(|current| *current > 200)
    );
    for finger in Finger::ALL {
        let block = block(&mut hand, finger, 3000);
        assert!(
            block.normal_n > 2.0 && block.tangential_n > 0.2,
            "{finger:?} {block:?}"
        );
        assert!(block.direction_deg().is_some());
    }
    let turned = block(&mut hand, Finger::Index, 3000).direction_deg();
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 6800), [1000; 6]);
    assert!(shorts(&mut hand, &ANGLE_ACT, 9000)[0] < 1000);
    assert!(hand.journal().is_empty());
    assert_ne!(
        block(&mut hand, Finger::Index, 10_300).direction_deg(),
        turned
    );
}

#[test]
fn the_grasp_leaves_the_setpoint_registers_to_the_controller() {
    let mut hand = hand(Scenario::Grasp, Personality::default());
    let before = bytes(&mut hand, &ANGLE_SET, 100);
    assert_eq!(bytes(&mut hand, &ANGLE_SET, 3000), before);
    let forces = shorts(&mut hand, &FORCE_SET, 3000);
    assert_eq!(shorts(&mut hand, &FORCE_SET, 6000), forces);
    // A setpoint from outside ends the script's own limits.
    hand.write(1486, &[0xFF; 12], at(6100)).unwrap();
    assert_eq!(shorts(&mut hand, &FORCE_SET, 6200), forces);
}

#[test]
fn the_slip_costs_force_and_turns_the_tangential_force() {
    let mut hand = hand(Scenario::Grasp, Personality::default());
    let before = block(&mut hand, Finger::Index, 2400);
    let during = block(&mut hand, Finger::Index, 2700);
    let after = block(&mut hand, Finger::Index, 3100);
    assert!(during.normal_n < 0.92 * before.normal_n);
    assert!(during.tangential_n > 1.5 * before.tangential_n);
    assert!(after.normal_n > during.normal_n);
    let turn = |a: TactileBlock, b: TactileBlock| {
        (i32::from(a.direction_raw) - i32::from(b.direction_raw)).rem_euclid(360)
    };
    assert!((60..110).contains(&turn(after, before)));
}

#[test]
fn extremes_are_kept_by_the_decoders() {
    let mut hand = hand(Scenario::Extremes, Personality::default());
    let mut sample = HandSample::default();
    for span in [
        Span::new(1534, 90),
        Span::new(3000, 232),
        Span::new(3232, 58),
    ] {
        let bytes = hand.read(span, at(10)).unwrap();
        sample.apply(&Reply {
            span,
            bytes: &bytes,
            asked: at(10),
            received: at(10),
        });
    }
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 10)[..2], [1013, -7]);
    assert_eq!(bytes(&mut hand, &STATUS, 10)[..2], [4, 255]);
    assert_eq!(bytes(&mut hand, &TEMP, 10)[0], 255);
    let little = sample.tactile[Finger::Little].unwrap().value;
    assert!(little.normal_n.is_nan() && little.normal().is_none());
    assert!(!sample.tactile[Finger::Ring].unwrap().value.check_ok());
    assert!(sample.has_fault());
}

#[test]
fn the_journal_keeps_every_write_with_its_time_and_stays_bounded() {
    let mut hand = idle();
    put(&mut hand, 1546, &[1], 5);
    assert_eq!(hand.journal()[0].at, at(5));
    assert_eq!(
        (hand.journal()[0].address, &hand.journal()[0].bytes[..]),
        (1546, &[1, 0][..])
    );
    for _ in 0..20_000 {
        hand.write(1486, &[0xFF, 0xFF], at(6)).unwrap();
    }
    assert!(hand.journal().len() <= 2 * handscope::sim::hand::JOURNAL_KEEPS);
}

#[test]
fn gestures_run_from_both_addresses() {
    let mut hand = idle();
    hand.set_object(&Object::none());
    hand.write(1008, &[2], at(0)).unwrap();
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 1000), [0, 0, 0, 0, 300, 300]);
    hand.write(2320, &[1], at(1000)).unwrap();
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 2000)[0], 0);
    hand.write(2322, &[1], at(2000)).unwrap();
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 3000), [1000; 6]);
    assert_eq!(hand.read(Span::new(2322, 1), at(3000)).unwrap(), [0]);
    hand.write(1008, &[14], at(3000)).unwrap();
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 4000), [1000; 6]);
}

#[test]
fn a_taught_gesture_plays_and_another_one_stays_untaught() {
    let mut hand = idle();
    hand.set_object(&Object::none());
    put(&mut hand, 1078, &[100, 200, 300, 400, 500, 600], 0);
    assert_eq!(
        shorts(&mut hand, &ANGLE_ACT, 500),
        [1000; 6],
        "storing moves nothing"
    );
    hand.write(1008, &[14], at(1000)).unwrap();
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 2000), [1000; 6]);
    hand.write(1008, &[15], at(2000)).unwrap();
    assert_eq!(
        shorts(&mut hand, &ANGLE_ACT, 3000),
        [100, 200, 300, 400, 500, 600]
    );
}

#[test]
fn a_jammed_joint_stalls_alone() {
    let mut hand = idle();
    hand.set_jam(Dof::Middle, Some(700.0));
    put(&mut hand, 1486, &[500; 6], 0);
    assert_eq!(bytes(&mut hand, &STATUS, 900), [2, 2, 1, 2, 2, 2]);
    assert!(shorts(&mut hand, &CURRENT, 900)[2] > 900);
    assert_eq!(bytes(&mut hand, &STATUS, 2000), [2, 2, 6, 2, 2, 2]);
    assert_eq!(bytes(&mut hand, &ERROR, 2000), [0, 0, 1, 0, 0, 0]);
    assert_eq!(shorts(&mut hand, &ANGLE_ACT, 2000)[2], 700);
}

#[test]
fn frozen_feedback_stands_still_while_the_joints_go_on_and_setpoints_are_read_back() {
    let told = [ANGLE_ACT, FORCE_ACT, CURRENT, POS_ACT];
    for by_scenario in [false, true] {
        let scenario = match by_scenario {
            true => Scenario::Frozen,
            false => Scenario::Free,
        };
        let mut hand = hand(scenario, Personality::default());
        put(&mut hand, SPEED_SET.address, &[500; 6], 0);
        put(&mut hand, ANGLE_SET.address, &[0; 6], 0);
        if !by_scenario {
            hand.freeze_feedback(true, at(300));
        }
        let frozen = told.map(|row| shorts(&mut hand, &row, 400));
        let tips = block(&mut hand, Finger::Index, 400);
        let angle = frozen[0][Dof::Index.index()];
        assert!(hand.is_frozen() && (500..990).contains(&angle), "{angle}");
        assert_eq!(told.map(|row| shorts(&mut hand, &row, 3000)), frozen);
        assert_eq!(block(&mut hand, Finger::Index, 3000), tips);
        assert_eq!(shorts(&mut hand, &ANGLE_SET, 3000), [0; 6]);
        assert_eq!(hand.true_angles()[Dof::Index], 0.0);
        if by_scenario {
            hand.power_cycle(at(3001));
        } else {
            hand.freeze_feedback(false, at(3001));
        }
        assert_eq!(shorts(&mut hand, &ANGLE_ACT, 3010), [0; 6]);
    }
}
