//! Hand-made states for tests of the window.

use handscope::app::notices::NoticeKind;
use handscope::app::state::State;
use handscope::hand::*;
use handscope::history::{History, MarkKind};
use handscope::link::*;
use handscope::record::*;
use handscope::transport::Endpoint;
use handscope::transport::{PortFound, UsbFound};
use std::time::Duration;

fn timed<T>(value: T, asked: Moment) -> Option<Timed<T>> {
    Some(Timed {
        value,
        asked,
        received: asked.plus(Duration::from_millis(5)),
    })
}

pub(crate) fn empty() -> State {
    State {
        now: Moment::from_micros(60_000_000),
        ..State::default()
    }
}

pub(crate) fn tactile(i: u32) -> TactileBlock {
    let mut raw = [0u32; 8];
    for (k, raw) in raw.iter_mut().enumerate() {
        *raw = 2_900_000 + (k as u32 + 1) * i * 30_000;
    }
    let f = i as f32;
    TactileBlock {
        raw,
        normal_n: f * 1.7,
        normal_delta: 1200 * i as i32,
        tangential_n: f * 0.6,
        tangential_delta: -33 * i as i32,
        direction_raw: if i == 0 { 65535 } else { (i * 71 % 360) as u16 },
        proximity: 600_000 * i as i32,
        check: 1,
        sum: if i == 3 { 2 } else { 1 },
        reserved: [0; 2],
    }
}

pub(crate) fn live() -> State {
    let mut state = empty();
    let asked = Moment::from_micros(59_990_000);
    state.hand_mut().connection.endpoint = Some(Endpoint::sim());
    state.hand_mut().connection.status.state = LinkState::Monitoring;
    state.hand_mut().connection.status.since = Moment::from_micros(20_000_000);
    state.hand_mut().connection.status.rest = Rest::Resting;
    state.hand_mut().connection.stats = LinkStats {
        state_reads: 8123,
        tactile_reads: 4033,
        state_hz: 196.4,
        tactile_hz: 98.2,
        rtt_p50: Some(Duration::from_micros(2100)),
        rtt_p99: Some(Duration::from_micros(4700)),
        timeouts: 2,
        writes: 431,
        ..LinkStats::default()
    };
    let angle = [982, 874, 402, 377, 510, 655];
    state.hand_mut().readings.sample.angle =
        timed(PerDof::new(angle.map(AngleReading::new)), asked);
    state.hand_mut().readings.sample.force = timed(
        PerDof::new([-5, 12, 488, 512, 260, 0].map(ForceReading::new)),
        asked,
    );
    state.hand_mut().readings.sample.current = timed(
        PerDof::new([0, 42, 318, 0, 120, 7].map(CurrentReading::new)),
        asked,
    );
    state.hand_mut().readings.sample.temperature = timed(
        PerDof::new([31, 32, 35, 36, 34, 31].map(TemperatureReading::new)),
        asked,
    );
    state.hand_mut().readings.sample.status =
        timed(PerDof::new([2, 0, 1, 3, 1, 2].map(Status::from_raw)), asked);
    state.hand_mut().readings.sample.faults = timed(PerDof::splat(Faults::from_raw(0)), asked);
    for (finger, block) in state.hand_mut().readings.sample.tactile.iter_mut() {
        *block = timed(tactile(finger.index() as u32), asked);
    }
    for (dof, joint) in state.hand_mut().controls.joints.iter_mut() {
        joint.target = Some(Angle::nearest(angle[dof.index()]));
        (joint.speed, joint.force) = (Some(Speed::GENTLE), Some(Force::GENTLE));
    }

    fill(&mut state.hand_mut().measured.history);
    for (number, name) in [
        (1, "open"),
        (2, "two-finger pinch"),
        (3, "fist"),
        (14, "cup"),
    ] {
        state
            .settings
            .name_gesture(Gesture::nearest(i64::from(number)), name);
    }
    state
}

fn fill(history: &mut History) {
    let fresh = Groups::from_iter([
        Group::Angle,
        Group::Force,
        Group::Current,
        Group::Temperature,
    ]);
    for tick in 0..3000u32 {
        let t = 30.0 + f64::from(tick) * 0.01;
        if (54.2..55.1).contains(&t) {
            continue;
        }
        let at = Moment::from_micros((t * 1e6) as u64);
        let wave = |dof: Dof| (((t * 0.8 + dof.index() as f64 * 0.4).sin() + 1.0) / 2.0).powi(2);
        let noise = |dof: Dof| (t * 37.0 + dof.index() as f64 * 2.0).sin();
        let whole = |value: f64| value as i16;
        let sample = HandSample {
            angle: timed(
                PerDof::from_fn(|dof| AngleReading::new(whole(1000.0 - 700.0 * wave(dof)))),
                at,
            ),
            force: timed(
                PerDof::from_fn(|dof| {
                    ForceReading::new(whole(wave(dof).powi(2) * 600.0 - 8.0 + 5.0 * noise(dof)))
                }),
                at,
            ),
            current: timed(
                PerDof::from_fn(|dof| {
                    CurrentReading::new(whole(wave(dof) * (280.0 + 30.0 * noise(dof))))
                }),
                at,
            ),
            temperature: timed(
                PerDof::from_fn(|dof| {
                    TemperatureReading::new(31 + dof.index() as u8 + (tick / 2000) as u8)
                }),
                at,
            ),
            ..HandSample::default()
        };
        history.push(&sample, fresh);
    }
    history.mark(Moment::from_micros(53_000_000), MarkKind::Gesture(9));
    history.mark(Moment::from_micros(57_500_000), MarkKind::Stop);
}

pub(crate) fn armed() -> State {
    let mut state = live();
    state.hand_mut().connection.status.state = LinkState::Armed;
    state.hand_mut().connection.status.armed = Some(ArmEpoch(1));
    for (dof, joint) in state.hand_mut().controls.joints.iter_mut() {
        joint.target = Some(Angle::nearest(
            [1000, 1000, 300, 300, 420, 655][dof.index()],
        ));
    }
    state.hand_mut().controls.joints[Dof::Index].speed = Some(Speed::nearest(600));
    state.hand_mut().controls.joints[Dof::Index].force = Some(Force::nearest(900));
    state.hand_mut().controls.joints[Dof::ThumbRotate].locked = true;
    state
}

pub(crate) fn faulted() -> State {
    let mut state = live();
    state.hand_mut().connection.status.state = LinkState::Fault;
    let mut faults = PerDof::splat(Faults::from_raw(0));
    faults[Dof::Index] = Faults::from_raw(1);
    faults[Dof::ThumbBend] = Faults::from_raw(2);
    state.hand_mut().readings.sample.faults = timed(faults, Moment::from_micros(59_990_000));
    let at = |s: u64| Moment::from_micros(s * 1_000_000);
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Faults);
    let mut earlier = state.hand().readings.sample;
    let mut one = PerDof::splat(Faults::from_raw(0));
    one[Dof::Ring] = Faults::from_raw(4);
    earlier.faults = timed(one, at(12));
    state
        .hand_mut()
        .readings
        .faults
        .update(&earlier, fresh, at(12));
    let mut two = PerDof::splat(Faults::from_raw(0));
    two[Dof::ThumbBend] = Faults::from_raw(2);
    earlier.faults = timed(two, at(51));
    state
        .hand_mut()
        .readings
        .faults
        .update(&earlier, fresh, at(51));
    let now = state.hand().readings.sample;
    state.hand_mut().readings.faults.update(&now, fresh, at(56));
    state
        .notices
        .push(at(50), NoticeKind::Disarmed(Disarmed::Fault));
    state.notices.push(
        at(55),
        NoticeKind::HoldConfirmed {
            after: Duration::from_millis(180),
        },
    );
    state
}

pub(crate) fn lost() -> State {
    let mut state = live();
    state.now = Moment::from_micros(62_400_000);
    state.hand_mut().connection.endpoint =
        Some("rs485:/dev/ttyUSB0?baud=115200&id=1".parse().unwrap());
    state.hand_mut().connection.status.state = LinkState::Offline;
    state.hand_mut().connection.status.trouble = Some(LinkTrouble::Silent { silent: 5 });
    state.hand_mut().connection.status.dialling = Dialling::Waiting {
        attempt: 3,
        until: Moment::from_micros(63_000_000),
    };
    state.ports = vec![usb_port("/dev/ttyUSB0")];
    state
}

/// A port that is a USB adapter.
pub(crate) fn usb_port(path: &str) -> PortFound {
    PortFound {
        path: path.into(),
        usb: Some(UsbFound {
            vendor_id: 0x0403,
            product_id: 0x6001,
            serial: Some("A50285BI".into()),
            maker: Some("FTDI".into()),
            product: Some("FT232R".into()),
            ..UsbFound::default()
        }),
    }
}

/// Three hands: one armed, one with a fault and a name, one that is not reached; the first is shown.
pub(crate) fn several() -> State {
    let mut state = armed();
    let mut other = faulted();
    state.hands.add(Moment::ZERO);
    let slot = state.hand().label.slot;
    *state.hand_mut() = std::mem::take(other.hand_mut());
    state.hand_mut().label.slot = slot;
    state.hand_mut().label.name = "bench at the window".into();
    state.hand_mut().side = handscope::hand::kinematics::Side::Left;
    state.hands.add(Moment::ZERO);
    let hand = state.hand_mut();
    hand.connection.endpoint = Some("tcp:192.168.11.210:6000?unit=255".parse().unwrap());
    hand.label.name = "192.168.11.210:6000".into();
    hand.connection.status.dialling = Dialling::Trying { attempt: 2 };
    let first = state.hands.iter().next().unwrap().label.slot;
    state.hands.show(first);
    state.hand_mut().label.name = "sim:?seed=1".into();
    state
}
