//! One drive of the simulated hand: motion, impact, protection, heat. Registers are tested elsewhere.

use handscope::hand::impact::RIGID_G_PER_COUNT;
use handscope::hand::{Fault, Status};
use handscope::sim::Obstacle;
use handscope::sim::body_params::{JointBody, STROKE};
use handscope::sim::drive::{Drive, DriveGoal, DriveSettings};

/// From a command to the motion, ms.
const DEAD_TIME_MS: u64 = 64;
const FAST: DriveSettings = DriveSettings {
    speed: 1000.0,
    threshold_g: 3000.0,
};

fn run(drive: &mut Drive, from: u64, ms: u64, setting: DriveSettings) -> f64 {
    let mut peak: f64 = 0.0;
    for now in from..from + ms {
        drive.step(now, setting);
        peak = peak.max(drive.load_g());
    }
    peak
}

fn rigid() -> Drive {
    let mut drive = Drive::new(25.0);
    drive.set_contact(Some(Obstacle::at(500.0, RIGID_G_PER_COUNT)));
    drive.command(DriveGoal::Position(STROKE), 0);
    drive
}

#[test]
fn full_stroke_at_1000_takes_600_ms_after_the_dead_time() {
    let mut drive = Drive::new(25.0);
    drive.command(DriveGoal::Position(STROKE), 0);
    run(&mut drive, 0, DEAD_TIME_MS, FAST);
    assert!(drive.position() < 1e-9);
    let mut ms = 0;
    while drive.position() < STROKE {
        drive.step(DEAD_TIME_MS + ms, FAST);
        ms += 1;
        assert!(ms < 2000);
    }
    assert!((540..=660).contains(&ms), "{ms}");
    assert!(drive.angle().abs() < 1e-9);
    assert_eq!(drive.status(), Status::PositionReached);
}

#[test]
fn the_peak_above_the_threshold_is_that_of_the_table() {
    for (speed, threshold, peak) in [
        (25.0, 100.0, 7.0),
        (25.0, 250.0, 29.0),
        (25.0, 500.0, 64.0),
        (25.0, 750.0, 73.0),
        (25.0, 1000.0, 69.0),
        (250.0, 100.0, 36.0),
        (250.0, 250.0, 336.0),
        (250.0, 500.0, 637.0),
        (250.0, 750.0, 1108.0),
        (250.0, 1000.0, 1640.0),
        (1000.0, 100.0, 36.0),
        (1000.0, 250.0, 3263.0),
        (1000.0, 500.0, 2917.0),
        (1000.0, 750.0, 2865.0),
        (1000.0, 1000.0, 2502.0),
    ] {
        let mut drive = rigid();
        let setting = DriveSettings {
            speed,
            threshold_g: threshold,
        };
        let over = run(&mut drive, 0, 20_000, setting) - threshold;
        assert!(
            (over - peak).abs() <= 0.15 * peak,
            "{speed} {threshold}: {over}"
        );
        assert_eq!(drive.status(), Status::ForceReached);
        assert!(drive.load_g() < threshold + 0.2 * peak);
        assert!(drive.current_ma() < 1e-9);
    }
}

#[test]
fn a_fast_approach_with_a_slow_contact_hits_softly() {
    let mut drive = rigid();
    let slow = DriveSettings {
        speed: 25.0,
        threshold_g: 500.0,
    };
    while drive.position() < 900.0 {
        drive.step(100, FAST);
    }
    let peak = run(&mut drive, 100, 5000, slow);
    assert!((peak - 539.0).abs() < 0.15 * 39.0, "{peak}");
    // The same way after a rest is a slow approach.
    let mut drive = rigid();
    while drive.position() < 900.0 {
        drive.step(100, FAST);
    }
    drive.command(DriveGoal::Freeze, 36);
    run(&mut drive, 100, 600, slow);
    drive.command(DriveGoal::Position(STROKE), 700);
    let peak = run(&mut drive, 700, 5000, slow);
    assert!((peak - 564.0).abs() < 0.15 * 64.0, "{peak}");
}

#[test]
fn after_the_impact_no_current_flows_and_the_grip_relaxes() {
    let mut drive = rigid();
    let setting = DriveSettings {
        speed: 1000.0,
        threshold_g: 500.0,
    };
    let mut now = 0;
    while drive.status() != Status::ForceReached {
        drive.step(now, setting);
        now += 1;
    }
    let peak = run(&mut drive, now, 25, setting);
    assert!(peak > 3000.0, "{peak}");
    assert!(
        drive.load_g() > 0.99 * peak,
        "a reader of 100 a second sees the peak"
    );
    run(&mut drive, now + 25, 100, setting);
    let (half, current) = (drive.load_g(), drive.current_ma());
    assert!(half < 0.8 * peak && half > 1000.0, "{half}");
    assert!(current < 1e-9);
    run(&mut drive, now + 125, 2000, setting);
    assert!((0.85 * 500.0..1.5 * 500.0).contains(&drive.load_g()));
}

#[test]
fn a_fragile_thing_breaks_if_pressed_too_hard_and_is_replaced_when_the_hand_opens() {
    let cup = Obstacle {
        breaks_at_g: Some(700.0),
        ..Obstacle::at(500.0, 20.0)
    };
    let mut drive = Drive::new(25.0);
    drive.set_contact(Some(cup));
    let gentle = DriveSettings {
        speed: 25.0,
        threshold_g: 400.0,
    };
    drive.command(DriveGoal::Position(STROKE), 0);
    run(&mut drive, 0, 14_000, gentle);
    assert_eq!(drive.status(), Status::ForceReached);
    assert!(drive.load_g() > 300.0, "held whole");
    let rough = DriveSettings {
        speed: 1000.0,
        threshold_g: 400.0,
    };
    drive.command(DriveGoal::Position(0.0), 14_000);
    run(&mut drive, 14_000, 2000, rough);
    drive.command(DriveGoal::Position(STROKE), 16_000);
    run(&mut drive, 16_000, 2000, rough);
    assert!(drive.load_g() < 1e-9, "broken");
    assert_eq!(drive.gap(), None);
    drive.command(DriveGoal::Position(0.0), 18_000);
    run(&mut drive, 18_000, 2000, rough);
    assert!(drive.gap().is_some(), "another one");
}

#[test]
fn a_jam_below_the_threshold_is_a_stall() {
    let mut drive = Drive::new(25.0);
    drive.set_jam(Some(600.0));
    drive.command(DriveGoal::Position(STROKE), 0);
    run(&mut drive, 0, 900, FAST);
    assert_eq!(drive.status(), Status::Grasping);
    assert!(drive.current_ma() > 900.0);
    run(&mut drive, 900, 400, FAST);
    assert_eq!(drive.status(), Status::Stalled);
    assert!(drive.faults().contains(Fault::Stall));
    drive.command(DriveGoal::Position(STROKE), 1300);
    run(&mut drive, 1300, 200, FAST);
    assert_eq!(drive.status(), Status::Stalled);
    drive.command(DriveGoal::Position(0.0), 1500);
    run(&mut drive, 1500, 1000, FAST);
    assert!(drive.position() < 1e-9);
    assert!(drive.faults().contains(Fault::Stall));
    drive.clear_errors();
    assert!(drive.faults().is_empty());
}

#[test]
fn a_slow_hard_squeeze_ends_in_current_protection() {
    let mut drive = rigid();
    let setting = DriveSettings {
        speed: 25.0,
        threshold_g: 3000.0,
    };
    run(&mut drive, 0, 14_000, setting);
    assert_eq!(drive.status(), Status::CurrentProtection);
    assert!(drive.faults().contains(Fault::OverCurrent));
}

#[test]
fn over_temperature_cannot_be_cleared_and_ends_by_itself_without_motion() {
    let mut drive = Drive::new(25.0);
    drive.command(DriveGoal::Position(STROKE), 0);
    run(&mut drive, 0, 200, FAST);
    drive.warm(90.0);
    run(&mut drive, 200, 10, FAST);
    let position = drive.position();
    assert_eq!(drive.status(), Status::DriveFault);
    drive.clear_errors();
    assert!(drive.faults().contains(Fault::OverTemperature));
    drive.command(DriveGoal::Position(STROKE), 210);
    run(&mut drive, 210, 10_000, FAST);
    assert!(drive.faults().contains(Fault::OverTemperature));
    run(&mut drive, 10_210, 20_000, FAST);
    assert!(drive.faults().is_empty());
    assert!((drive.position() - position).abs() < 1e-9);
}

#[test]
fn freeze_stops_after_the_dead_time() {
    let mut drive = Drive::new(25.0);
    drive.command(DriveGoal::Position(STROKE), 0);
    run(&mut drive, 0, 200, FAST);
    drive.command(DriveGoal::Freeze, 200);
    run(&mut drive, 200, 100, FAST);
    let position = drive.position();
    run(&mut drive, 300, 300, FAST);
    assert!((drive.position() - position).abs() < 1e-9);
    assert!(position > 300.0 && position < 1000.0);
}

#[test]
fn a_target_told_again_at_rest_draws_no_current() {
    // At the target, off it by less than ANGLE_ACT shows, and held by the force threshold.
    let setting = DriveSettings {
        speed: 250.0,
        threshold_g: 500.0,
    };
    for (mut drive, first, again) in [
        (Drive::new(25.0), 1000.0, 1000.0),
        (Drive::new(25.0), 1000.5, 1000.0),
        (rigid(), STROKE, STROKE),
    ] {
        drive.command(DriveGoal::Position(first), 0);
        run(&mut drive, 0, 6000, setting);
        let (place, load, status) = (drive.position(), drive.load_g(), drive.status());
        for now in 6000..8000 {
            if now % 20 == 0 {
                drive.command(DriveGoal::Position(again), now);
            }
            drive.step(now, setting);
            assert!(
                drive.current_ma() < 1e-9,
                "{status:?}: {}",
                drive.current_ma()
            );
        }
        assert_eq!((drive.position(), drive.status()), (place, status));
        // A higher threshold is room to close on; the way open is free.
        let more = DriveSettings {
            threshold_g: 700.0,
            ..setting
        };
        drive.command(DriveGoal::Position(STROKE), 8000);
        run(&mut drive, 8000, 3000, more);
        assert!(drive.load_g() > load + 50.0 || drive.position() >= STROKE);
        drive.command(DriveGoal::Position(0.0), 11_000);
        run(&mut drive, 11_000, 6000, more);
        assert!(drive.position() < 1e-9);
    }
}

#[test]
fn a_grip_keeps_of_what_it_ran_past_its_threshold_as_much_as_its_body_says() {
    let held = |kept_overshoot: f64| {
        let body = JointBody {
            kept_overshoot,
            ..JointBody::default()
        };
        let mut drive = Drive::of(body, 25.0, 0);
        drive.set_contact(Some(Obstacle::at(500.0, RIGID_G_PER_COUNT)));
        drive.command(DriveGoal::Position(STROKE), 0);
        let setting = DriveSettings {
            speed: 250.0,
            threshold_g: 500.0,
        };
        let peak = run(&mut drive, 0, 10_000, setting);
        (peak, drive.load_g())
    };
    let ((peak, little), (same, much)) = (held(0.05), held(0.9));
    assert!((peak - same).abs() < 1e-9);
    assert!(
        (much - little - 0.85 * (peak - 500.0)).abs() < 20.0,
        "{peak} {little} {much}"
    );
}
