//! Messages as Unitree's xr_teleoperate and ROS 2's controllers send them, at a simulated hand behind a real link, in virtual time: what goes over the wire
//! whatever becomes of the sender.

use crate::inputs::follow::{Sent, Stage, check};
use crate::setup::link::gentle;
use crate::setup::time::in_virtual_time;
use handscope::hand::kinematics::{RANGE, Side, driven_radians};
use handscope::hand::{Dof, Force, PerDof, Speed};
use handscope::inputs::dds::ctrl::CtrlFault;
use handscope::inputs::dds::source::{DdsCommands, DdsSource};
use handscope::inputs::offer::SourceSite;
use handscope::link::{ArmRequest, Owner};
use handscope::motion::follow::step::FollowPhase;
use handscope::record::Abort;
use handscope::record::file::format::cdr;
use handscope::record::file::format::message::{Header, JointState};
use handscope::record::{Disarmed, Record, WriteCause};
use handscope::transport::dds::{DdsMessage, DdsWriterId};
use std::sync::Arc;
use tokio::sync::mpsc;

/// Two runs of one program: another writer each time.
const FIRST: DdsWriterId = DdsWriterId([1; 16]);
const SECOND: DdsWriterId = DdsWriterId([2; 16]);

/// As CycloneDDS writes it: angles, forces and speeds, and positions that are not meant.
fn message(from: DdsWriterId, [angle, force, speed]: [i16; 3], mode: u8) -> DdsMessage {
    let mut bytes = vec![0, 1, 0, 0];
    for value in [0, angle, force, speed] {
        bytes.extend(6u32.to_le_bytes());
        bytes.extend([value; 6].iter().flat_map(|value| value.to_le_bytes()));
    }
    bytes.push(mode);
    DdsMessage { from, bytes }
}

/// The topics of a source without a network.
struct Topics {
    ctrl: mpsc::Sender<DdsMessage>,
    trajectories: mpsc::Sender<DdsMessage>,
    positions: mpsc::Sender<DdsMessage>,
}

fn topics(stage: &Stage, allowed: ArmRequest) -> (Topics, DdsSource) {
    let (ctrl, ctrl_commands) = mpsc::channel(64);
    let (trajectories, trajectory_commands) = mpsc::channel(64);
    let (positions, position_commands) = mpsc::channel(64);
    let (_none, motors) = mpsc::channel(1);
    let site = SourceSite::of(stage.link(), Side::Right, Arc::new(|| ()));
    let commands = DdsCommands {
        ctrl: ctrl_commands,
        motors,
        trajectories: trajectory_commands,
        positions: position_commands,
    };
    let topics = Topics {
        ctrl,
        trajectories,
        positions,
    };
    (topics, DdsSource::open(allowed, site, commands))
}

/// A source of Unitree's commands.
fn source(stage: &Stage, allowed: ArmRequest) -> (mpsc::Sender<DdsMessage>, DdsSource) {
    let (topics, source) = topics(stage, allowed);
    (topics.ctrl, source)
}

/// Sends these angles a hundred times a second.
async fn send(
    stage: &mut Stage,
    to: &mpsc::Sender<DdsMessage>,
    from: DdsWriterId,
    angles: impl IntoIterator<Item = i16>,
) {
    for angle in angles {
        to.try_send(message(from, [angle, 0, 0], 1)).unwrap();
        stage.pass(10).await;
    }
}

/// Tracking that trembles by some counts.
fn about(angle: i16, ms: i16) -> impl Iterator<Item = i16> {
    (0..ms / 10).map(move |n| angle + n % 5)
}

#[test]
fn a_sender_that_starts_freezes_is_killed_and_restarts_never_jumps_the_hand() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let (messages, source) = source(&stage, gentle());
        let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
        // It asks for a fist in its first message.
        send(&mut stage, &messages, FIRST, about(0, 700)).await;
        // Tracking is lost: the same pose for two seconds, and then one far away.
        send(&mut stage, &messages, FIRST, vec![640; 200]).await;
        send(&mut stage, &messages, FIRST, about(200, 800)).await;
        // It is killed, and started again within a second: open at start, which nobody follows before it is its turn.
        stage.pass(400).await;
        send(&mut stage, &messages, SECOND, vec![1000; 50]).await;
        stage.pass(300).await;
        assert_eq!(source.view().refused, [(CtrlFault::OtherSender, 50)].into());
        let (end, phases) = task.await.unwrap();
        assert_eq!(end, Ok(()));
        for phase in [FollowPhase::Frozen, FollowPhase::Silent] {
            assert!(phases.contains(&phase), "{phase:?}: {phases:?}");
        }
        assert_eq!(stage.link().status().disarmed, Some(Disarmed::Silent));
        stage.pass(600).await;
        let moved = stage.index();
        assert!(moved.len() > 60, "{}", moved.len());
        // It moves nothing before a person lets it.
        send(&mut stage, &messages, SECOND, vec![1000; 100]).await;
        assert_eq!(stage.index().len(), moved.len());
        assert_eq!(source.view().sender.unwrap().0, SECOND);
        let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
        send(&mut stage, &messages, SECOND, vec![1000; 200]).await;
        assert_eq!(stage.index().last().unwrap().to, 1000);
        drop(messages);
        stage.pass(1500).await;
        assert_eq!(task.await.unwrap().0, Ok(()));
        check(&stage.index());
    });
}

#[test]
fn what_is_refused_moves_nothing_and_is_counted() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let (messages, source) = source(&stage, gentle());
        let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
        for (values, mode) in [
            ([500, 0, 0], 3),
            ([1001, 0, 0], 1),
            ([-2, 0, 0], 1),
            ([500, 0, 0], 32),
            ([500, 3000, 0], 5),
            ([500, 0, 1000], 9),
        ] {
            messages.try_send(message(FIRST, values, mode)).unwrap();
            stage.pass(10).await;
        }
        let mut cut = message(FIRST, [500, 0, 0], 1);
        cut.bytes.truncate(30);
        messages.try_send(cut).unwrap();
        stage.pass(100).await;
        let refused = [
            (CtrlFault::Malformed, 1),
            (CtrlFault::Mode, 1),
            (CtrlFault::Position, 1),
            (CtrlFault::Range, 2),
            (CtrlFault::AboveLimit, 2),
        ];
        let view = source.view();
        assert_eq!((view.taken, view.refused), (0, refused.into()));
        stage.pass(1000).await;
        assert_eq!(task.await.unwrap().0, Ok(()));
        // A stop, where it stands.
        let sent = stage.index();
        assert!(
            sent.iter().all(|sent| sent.cause == WriteCause::Hold),
            "{sent:?}"
        );
    });
}

#[test]
fn speeds_and_forces_within_what_a_person_allows_reach_the_hand_once() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let allowed = ArmRequest {
            speed: PerDof::splat(Speed::MAX),
            force: PerDof::splat(Force::nearest(1000)),
        };
        let (messages, source) = source(&stage, allowed);
        let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
        for n in 0..50 {
            let values = [900 - n % 3, 321, 432];
            messages.try_send(message(FIRST, values, 13)).unwrap();
            stage.pass(10).await;
        }
        // -1 leaves the joints alone, and nothing more is said of limits.
        for _ in 0..30 {
            messages.try_send(message(FIRST, [-1, 0, 0], 1)).unwrap();
            stage.pass(10).await;
        }
        let sample = stage.sample();
        let (force, speed) = (sample.force_set.unwrap(), sample.speed_set.unwrap());
        assert_eq!(force.value[Dof::Index], Some(Force::nearest(321)));
        assert_eq!(speed.value[Dof::Index], Some(Speed::nearest(432)));
        // Twice each: with the arming, and as the message asks.
        for address in [1498, 1522] {
            let sent = stage.records().iter().filter(
                |record| matches!(record, Record::Sent { write, .. } if write.address == address),
            );
            assert_eq!(sent.count(), 2, "{address}");
        }
        drop((messages, source));
        stage.pass(100).await;
        assert_eq!(task.await.unwrap().0, Ok(()));
    });
}

#[test]
fn speeds_of_zero_stop_the_hand_whoever_sends_them_and_whatever_else_is_in_the_message() {
    in_virtual_time(async {
        for (nth, (values, mode, is_odd)) in [
            ([500, 0, 0], 8, false),
            ([500, 0, 0], 9, false),
            ([1001, 9999, 0], 15, true),
            ([500, 0, 0], 0x88, true),
        ]
        .into_iter()
        .enumerate()
        {
            let mut stage = Stage::begin().await;
            let (messages, source) = source(&stage, gentle());
            let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
            send(&mut stage, &messages, FIRST, about(300, 400)).await;
            messages.try_send(message(SECOND, values, mode)).unwrap();
            send(&mut stage, &messages, FIRST, about(300, 300)).await;
            let end = task.await.unwrap().0;
            let why = Some(Disarmed::Stop);
            assert_eq!(end, Err(Abort::Disarmed { why }), "{nth}");
            let view = source.view();
            assert_eq!(view.odd_stops, u64::from(is_odd), "{nth}: {view:?}");
            let last = *stage.index().last().unwrap();
            assert_eq!(last.cause, WriteCause::Hold, "{nth}");
            assert!(last.to > 400, "{nth}: {last:?}");
        }
    });
}

/// A trajectory for the index finger, due in these nanoseconds.
fn trajectory(from: DdsWriterId, points: &[(f64, u32)]) -> DdsMessage {
    let none: [Vec<f64>; 3] = Default::default();
    let points = points
        .iter()
        .map(|(radians, nanos)| (vec![*radians], &none, (0, *nanos)));
    let points: Vec<_> = points.collect();
    let bytes = cdr::encode(&(
        Header::default(),
        ["right_index_1_joint"].as_slice(),
        points,
    ));
    DdsMessage { from, bytes }
}

/// Positions of the index and its coupled joint.
fn positions(from: DdsWriterId, radians: f64) -> DdsMessage {
    let names = ["right_index_1_joint", "right_index_2_joint"];
    let state = JointState {
        name: names.map(str::to_owned).to_vec(),
        position: vec![radians, radians * 1.0843],
        ..JointState::default()
    };
    let bytes = cdr::encode(&state);
    DdsMessage { from, bytes }
}

/// Radians of the index finger's joint at this angle, which trembles.
fn radians(angle: i16, n: i16) -> f64 {
    driven_radians(Dof::Index, angle + n % 5)
}

#[test]
fn a_trajectory_of_one_point_moves_a_granted_hand_as_every_source_does_and_no_other() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let (topics, source) = topics(&stage, gentle());
        // Without a user who grants control nothing moves.
        for n in 0..50 {
            let point = [(radians(400, n), 34_000_000)];
            topics
                .trajectories
                .try_send(trajectory(FIRST, &point))
                .unwrap();
            stage.pass(10).await;
        }
        assert!(stage.index().is_empty(), "{:?}", stage.index());
        stage.pass(100).await;
        assert_eq!((source.view().taken, source.view().not_granted), (50, 50));
        let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
        for n in 0..300 {
            let point = [(radians(400, n), 34_000_000)];
            topics
                .trajectories
                .try_send(trajectory(FIRST, &point))
                .unwrap();
            stage.pass(10).await;
        }
        let near = |to: i16| (395..=405).contains(&to);
        assert!(near(stage.index().last().unwrap().to));
        // The same joints by positions; another writer waits for its turn.
        topics.positions.try_send(positions(SECOND, 0.0)).unwrap();
        stage.pass(100).await;
        assert_eq!(source.view().refused, [(CtrlFault::OtherSender, 1)].into());
        for n in 0..200 {
            topics
                .positions
                .try_send(positions(FIRST, radians(600, n)))
                .unwrap();
            stage.pass(10).await;
        }
        assert!((595..=605).contains(&stage.index().last().unwrap().to));
        // Silence holds the hand, and then takes control from it.
        stage.pass(1500).await;
        assert_eq!(task.await.unwrap().0, Ok(()));
        assert_eq!(stage.link().status().disarmed, Some(Disarmed::Silent));
        check(&stage.index());
    });
}

#[test]
fn a_trajectory_of_several_points_or_a_later_one_is_refused_whole() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let (topics, source) = topics(&stage, gentle());
        let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
        let beyond = 1.01 * f64::from(RANGE[Dof::Index]);
        for points in [
            vec![(0.5, 0), (0.6, 10_000_000)],
            vec![(0.5, 900_000_000)],
            vec![(beyond, 0)],
        ] {
            topics
                .trajectories
                .try_send(trajectory(FIRST, &points))
                .unwrap();
            stage.pass(10).await;
        }
        let refused = [
            (CtrlFault::Range, 1),
            (CtrlFault::Points, 1),
            (CtrlFault::Timing, 1),
        ];
        stage.pass(100).await;
        let view = source.view();
        assert_eq!((view.taken, view.refused), (0, refused.into()));
        stage.pass(1000).await;
        assert_eq!(task.await.unwrap().0, Ok(()));
        let sent = stage.index();
        let is_hold = |sent: &Sent| sent.cause == WriteCause::Hold;
        assert!(sent.iter().all(is_hold), "{sent:?}");
    });
}

#[test]
fn a_trajectory_without_points_stops_the_hand_whoever_sends_it() {
    in_virtual_time(async {
        let mut stage = Stage::begin().await;
        let (topics, source) = topics(&stage, gentle());
        let task = stage.follow(stage.link().grant(Owner::Dds), source.follow());
        for n in 0..40 {
            topics
                .positions
                .try_send(positions(FIRST, radians(300, n)))
                .unwrap();
            stage.pass(10).await;
        }
        topics
            .trajectories
            .try_send(trajectory(SECOND, &[]))
            .unwrap();
        stage.pass(100).await;
        let why = Some(Disarmed::Stop);
        assert_eq!(task.await.unwrap().0, Err(Abort::Disarmed { why }));
        let last = *stage.index().last().unwrap();
        assert_eq!(last.cause, WriteCause::Hold);
        assert!(last.to > 400, "{last:?}");
        assert_eq!(source.view().odd_stops, 0);
    });
}
