//! Moving the hand: nothing before a person arms, exactly what they ask afterwards, and a stop from everywhere.

use crate::program::{ANGLE_SET, Bench, angles_told, shorts, spoil};
use crate::setup::hand;
use crate::setup::line::Trouble;
use crate::setup::link::{missing, to_hand};
use crate::setup::program::{env, start};
use handscope::app::action::Action;
use handscope::app::env::Env;
use handscope::app::hand::mover::Mover;
use handscope::app::notices::{NoticeKind, RequestKind};
use handscope::app::settings::Settings;
use handscope::hand::{Angle, Dof, Force, Gesture, GestureRoute, HandSample, Moment, Speed, Timed};
use handscope::link::{Owner, RequestError};
use handscope::poses::Preset;
use handscope::record::{ArmRefusal, Hold, LinkState, Record, WriteFate};
use handscope::sim::SimConfig;
use handscope::transport::Endpoint;
use tokio::time::{Duration, sleep};

const SPEED_SET: u16 = 1522;
const FORCE_SET: u16 = 1498;
const GESTURE: u16 = 1008;

#[tokio::test(start_paused = true)]
async fn nothing_is_told_by_starting_connecting_or_dragging_while_not_armed() {
    let mut bench = Bench::live().await;
    for dof in Dof::ALL {
        bench.act(Action::Target(dof, Angle::MIN));
        bench.act(Action::Force(Some(dof), Force::RATED));
        bench.act(Action::Speed(Some(dof), Speed::MAX));
        bench.act(Action::Lock(dof, true));
        bench.act(Action::Lock(dof, false));
    }
    bench.act(Action::Preset(Preset::Open));
    bench.act(Action::Gesture(Gesture::MIN));
    bench.run(500).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
    let at = bench.angle(Dof::Index);
    assert_eq!(
        bench.target(Dof::Index),
        Some(at),
        "the slider shows where the joint is"
    );
    let kept = bench.hand().controls.joints[Dof::Index].force;
    assert_eq!(kept, Some(Force::RATED), "kept for arming");
}

#[tokio::test(start_paused = true)]
async fn arming_sends_the_staged_limits_and_no_angle() {
    let mut bench = Bench::live().await;
    bench.act(Action::Speed(Some(Dof::Ring), Speed::MIN));
    bench.act(Action::Arm);
    bench.run(300).await;
    assert!(bench.hand().connection.is_armed());
    let mut speeds = [Speed::GENTLE.get(); 6];
    speeds[Dof::Ring as usize] = Speed::MIN.get();
    let written = bench.written();
    let sent: Vec<_> = written
        .iter()
        .map(|one| (one.address, shorts(one)))
        .collect();
    let forces = vec![Force::GENTLE.get(); 6];
    assert_eq!(sent, [(SPEED_SET, speeds.to_vec()), (FORCE_SET, forces)]);
    assert_eq!(bench.target(Dof::Ring), Some(bench.angle(Dof::Ring)));
}

#[tokio::test(start_paused = true)]
async fn wishes_are_gentle_at_most_and_what_the_hand_holds_is_told_until_it_holds_them() {
    let mut bench = Bench::live().await;
    let joint = bench.hand().controls.joints[Dof::Index];
    let gentle = (Some(Speed::GENTLE), Some(Force::GENTLE));
    assert_eq!((joint.speed, joint.force), gentle);
    let held = bench.hand().held_otherwise(Dof::Index).speed;
    assert_eq!(held, Some(Speed::MAX), "and it is told what it holds");
    bench.act(Action::Arm);
    bench.run(1500).await;
    assert_eq!(bench.hand().held_otherwise(Dof::Index).speed, None);
}

#[tokio::test(start_paused = true)]
async fn a_wish_that_the_hand_does_not_hold_is_told_apart_until_it_does() {
    let mut bench = Bench::live().await;
    let slow = Speed::nearest(200);
    bench.act(Action::Speed(Some(Dof::Index), slow));
    assert_eq!(
        bench.hand().held_otherwise(Dof::Index).speed,
        Some(Speed::MAX)
    );
    bench.act(Action::Arm);
    bench.run(1500).await;
    assert_eq!(
        bench.hand().held_otherwise(Dof::Index).speed,
        None,
        "it holds it"
    );
    let other = 25_i16.to_le_bytes();
    let index = SPEED_SET + 2 * Dof::Index as u16;
    bench
        .hand
        .with(|hand, now| hand.write(index, &other, now))
        .unwrap();
    bench.run(1500).await;
    let joint = bench.hand().controls.joints[Dof::Index];
    assert_eq!(joint.speed, Some(slow), "another program changes no wish");
    assert_eq!(
        bench.hand().held_otherwise(Dof::Index).speed,
        Some(Speed::nearest(25))
    );
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_is_not_there_cannot_be_armed_nor_asked_and_a_stop_says_so() {
    let env = Env {
        dial: crate::setup::link::dial(|_| missing("x".into())),
        ..env()
    };
    let clock = env.clock;
    let mut app = start(env, Settings::default(), Some("rs485:x"));
    for action in [Action::Arm, Action::Stop, Action::ClearErrors] {
        app.act(action, clock.now());
    }
    let told: Vec<_> = app
        .state()
        .notices
        .iter()
        .map(|one| one.what.clone())
        .collect();
    let (what, error) = (RequestKind::ClearErrors, RequestError::NotConnected);
    assert_eq!(
        told,
        [
            NoticeKind::RequestFailed { what, error },
            NoticeKind::StopNotSent,
            NoticeKind::ArmRefused(ArmRefusal::Offline),
        ],
        "the newest first"
    );
}

#[tokio::test(start_paused = true)]
async fn an_armed_joint_goes_where_it_is_told_and_a_locked_one_never() {
    let mut bench = Bench::armed().await;
    bench.act(Action::Target(Dof::Index, Angle::nearest(300)));
    bench.run(100).await;
    let [only] = &bench.written()[..] else {
        panic!("{:?}", bench.written());
    };
    assert_eq!(only.address, ANGLE_SET + 2 * Dof::Index as u16);
    assert_eq!(shorts(only), [300], "and nothing to the others");
    bench.act(Action::Lock(Dof::Ring, true));
    bench.run(1000).await;
    bench.forget();
    bench.act(Action::Target(Dof::Ring, Angle::MIN));
    bench.act(Action::Force(Some(Dof::Ring), Force::MIN));
    bench.act(Action::Speed(Some(Dof::Ring), Speed::MAX));
    bench.run(300).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
    let ring = bench.angle(Dof::Ring);
    assert_eq!(
        (bench.target(Dof::Index), bench.target(Dof::Ring)),
        (Some(300), Some(ring))
    );
    bench.act(Action::Preset(Preset::Close));
    bench.run(300).await;
    let told = angles_told(&bench);
    assert!(told.iter().any(|told| told[Dof::Little as usize] == 0));
    assert!(
        told.iter().all(|told| told[Dof::Ring as usize] == -1),
        "{told:?}"
    );
}

#[tokio::test(start_paused = true)]
async fn an_armed_joint_moves_and_stop_holds_it() {
    let mut bench = Bench::armed().await;
    let start = bench.angle(Dof::Index);
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(700).await;
    let under_way = bench.angle(Dof::Index);
    assert!(
        under_way < start - 50 && under_way > 100,
        "{start} {under_way}"
    );
    bench.act(Action::Stop);
    assert!(!bench.hand().connection.is_armed());
    bench.act(Action::Target(Dof::Index, Angle::MAX));
    bench.run(1500).await;
    let hand = bench.hand();
    assert!(
        matches!(hand.connection.status.hold, Hold::Confirmed { .. }),
        "{:?}",
        hand.connection.status
    );
    let is_told = |what: &NoticeKind| matches!(what, NoticeKind::HoldConfirmed { .. });
    assert!(bench.told().iter().any(is_told));
    let rest = bench.angle(Dof::Index);
    assert!(rest < start, "nothing passes after stop");
    bench.run(500).await;
    assert!((bench.angle(Dof::Index) - rest).abs() <= 3);
    assert_eq!(bench.target(Dof::Index), Some(bench.angle(Dof::Index)));
}

#[tokio::test(start_paused = true)]
async fn stop_works_in_every_live_state_and_again() {
    let mut bench = Bench::live().await;
    for _ in 0..3 {
        bench.forget();
        bench.act(Action::Stop);
        bench.run(30).await;
        assert_eq!(bench.hand().connection.status.state, LinkState::Holding);
        bench.act(Action::Stop);
        bench.run(1000).await;
        assert!(bench.addresses().contains(&ANGLE_SET), "the pose is held");
    }
    assert!(!bench.told().contains(&NoticeKind::StopNotSent));
}

#[tokio::test(start_paused = true)]
async fn messages_of_the_former_hand_carry_its_name_under_the_next() {
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    spoil(&line, Trouble::Gone(Duration::from_secs(60)));
    bench.run(2000).await;
    let lost = |bench: &Bench| {
        let mut log = bench.state().notices.log();
        let lost = log.find(|notice| matches!(notice.what, NoticeKind::LinkLost(_)));
        lost.unwrap().hand.clone()
    };
    assert_eq!(lost(&bench), None, "there is only one");
    let name = bench.hand().label.name.clone();
    bench.act(Action::Connect("rs485:y".parse().unwrap()));
    bench.run(500).await;
    assert_eq!(lost(&bench).map(|hand| hand.name), Some(name));
}

#[tokio::test(start_paused = true)]
async fn what_another_controller_moves_is_not_said_to_be_moved_from_here() {
    let mut bench = Bench::armed().await;
    bench.act(Action::Speed(None, Speed::nearest(50)));
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(300).await;
    let mover = |bench: &Bench| Mover::of(bench.hand(), bench.state().now);
    assert_eq!(mover(&bench), Some(Mover::Setpoints));
    let others = [100_i16, 100, 100, 900, 1000, 1000];
    let others: Vec<u8> = others
        .iter()
        .flat_map(|angle| angle.to_le_bytes())
        .collect();
    bench
        .hand
        .with(|hand, now| hand.write(ANGLE_SET, &others, now).unwrap());
    bench
        .until("not armed", |state| !state.hand().connection.is_armed())
        .await;
    for _ in 0..20 {
        bench.run(50).await;
        let moves = mover(&bench);
        assert!(
            matches!(moves, None | Some(Mover::Unknown | Mover::Stop)),
            "{moves:?}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn another_hand_inherits_nothing() {
    let mut bench = Bench::armed().await;
    bench.act(Action::Target(Dof::Index, Angle::nearest(900)));
    bench.run(20).await;
    bench.act(Action::Connect("rs485:y".parse().unwrap()));
    let other: Endpoint = "rs485:y".parse().unwrap();
    while bench.hand().connection.endpoint.as_ref() != Some(&other) {
        bench.run(10).await;
    }
    assert_eq!(bench.hand().readings.sample, HandSample::default());
    assert_eq!(bench.target(Dof::Index), None);
    assert!(!bench.hand().connection.is_armed());
    let speed = bench.hand().controls.joints[Dof::Index].speed;
    assert_eq!(speed, None, "nothing is known of it");
    let first = bench.hand().measured.history.first_secs();
    assert_eq!(first, None, "its curves are not shown under the new name");
    bench.run(1000).await;
    bench.forget();
    bench.run(1000).await;
    assert!(!bench.hand().connection.is_armed());
    assert_eq!(bench.addresses(), [0_u16; 0]);
}

#[tokio::test(start_paused = true)]
async fn leaving_an_armed_hand_holds_it_first() {
    let mut bench = Bench::armed().await;
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(300).await;
    bench.act(Action::Disconnect);
    assert!(bench.hand().connection.endpoint.is_some());
    bench.run(700).await;
    assert_eq!(bench.hand().connection.endpoint, None);
    bench.act(Action::Connect("rs485:x".parse().unwrap()));
    bench.run(500).await;
    assert_eq!(bench.hand().connection.status.state, LinkState::Monitoring);
    let history = &bench.hand().measured.history;
    let first = history.first_secs().expect("measurements");
    let last = bench.state().now.secs();
    assert!(last - first > 1.2, "and its curves: {first} to {last}");
    let rest = bench.angle(Dof::Index);
    assert!(rest > 300, "the same hand, where it was held: {rest}");
    bench.run(500).await;
    assert!((bench.angle(Dof::Index) - rest).abs() <= 3);
}

#[tokio::test(start_paused = true)]
async fn closing_holds_an_armed_hand_first_and_ends_in_time() {
    let mut bench = Bench::armed().await;
    bench.act(Action::Speed(Some(Dof::Index), Speed::MAX));
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(150).await;
    let asked = bench.clock.now();
    assert!(!bench.app.close(asked), "the hand is under way");
    while !bench.app.close(bench.clock.now()) {
        bench.run(10).await;
    }
    assert!(bench.clock.now().since(asked) <= Duration::from_millis(620));
    assert_ne!(bench.hand().connection.status.hold, Hold::None);
    let mut idle = Bench::live().await;
    let now = idle.clock.now();
    while !idle.app.close(idle.clock.now()) {
        // Settings may have to be written.
        tokio::task::yield_now().await;
    }
    assert!(
        idle.clock.now().since(now) < Duration::from_millis(100),
        "a hand that was only watched is left at once"
    );
    idle.run(100).await;
    assert_eq!(idle.addresses(), [0_u16; 0]);
}

#[tokio::test(start_paused = true)]
async fn gestures_need_arming_a_route_and_free_joints() {
    let mut bench = Bench::armed().await;
    bench.act(Action::GestureRoute(GestureRoute::Off));
    bench.act(Action::Gesture(Gesture::MIN));
    bench.act(Action::GestureRoute(GestureRoute::Register1008));
    bench.act(Action::Lock(Dof::Ring, true));
    bench.act(Action::Gesture(Gesture::MIN));
    bench.run(300).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
    let dof = Dof::Ring;
    for told in [
        NoticeKind::GesturesOff,
        NoticeKind::GestureWouldMoveLocked { dof },
    ] {
        assert!(bench.told().contains(&told), "{told:?}");
    }
    bench.act(Action::Lock(Dof::Ring, false));
    bench.run(100).await;
    bench.forget();
    bench.act(Action::Gesture(Gesture::MIN));
    bench.run(300).await;
    assert_eq!(bench.addresses(), [GESTURE]);
    let what = RequestKind::Gesture(Gesture::MIN);
    assert!(bench.told().contains(&NoticeKind::Acknowledged { what }));
    let at = bench.angle(Dof::Index);
    assert_eq!(bench.target(Dof::Index), Some(at), "the sliders go along");
}

#[tokio::test(start_paused = true)]
async fn a_flood_of_records_is_taken_a_frame_at_a_time_and_nothing_is_lost() {
    let mut bench = Bench::live_without_delay().await;
    let before = bench.hand().readings.sample.angle.unwrap().asked;
    sleep(Duration::from_secs(3)).await;
    let now = bench.clock.now();
    let age = |angle: Option<Timed<_>>| -> Duration { now.since(angle.unwrap().asked) };
    bench.app.logic(now);
    let first = age(bench.hand().readings.sample.angle);
    assert!(
        first > Duration::from_millis(100),
        "the rest waits: {first:?}"
    );
    for _ in 0..20 {
        bench.app.logic(now);
    }
    let last = age(bench.hand().readings.sample.angle);
    assert!(last < Duration::from_millis(50), "{last:?}");
    assert!(bench.hand().readings.sample.angle.unwrap().asked > before);
    assert_eq!(bench.hand().connection.stats.dropped_events, 0);
}

#[tokio::test(start_paused = true)]
async fn a_request_that_the_lost_link_took_along_is_told() {
    let (mut bench, line) = Bench::on_line("rs485:x", 1).await;
    // The pose is held before anything is cleared; with that the line goes.
    spoil(&line, Trouble::Gone(Duration::from_secs(2)));
    bench.act(Action::ClearErrors);
    bench.run(1000).await;
    assert!(!bench.hand().connection.status.state.is_live());
    let told = bench.told();
    let failed = told.iter().find_map(|what| match what {
        NoticeKind::RequestFailed { what, error } => Some((*what, error.clone())),
        _ => None,
    });
    assert_eq!(
        failed,
        Some((RequestKind::ClearErrors, RequestError::LinkLost))
    );
    bench.run(5000).await;
    bench.forget();
    bench.run(1000).await;
    assert_eq!(bench.hand().connection.status.state, LinkState::Monitoring);
    assert_eq!(
        bench.addresses(),
        [0_u16; 0],
        "it is not sent once the hand is back"
    );
}

#[tokio::test(start_paused = true)]
async fn a_stop_while_the_link_is_gone_says_so_and_goes_first_when_it_is_back() {
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    bench.arm().await;
    bench.act(Action::Target(Dof::Index, Angle::MIN));
    bench.run(100).await;
    spoil(&line, Trouble::Gone(Duration::from_secs(2)));
    bench.run(500).await;
    assert!(!bench.hand().connection.status.state.is_live());
    assert_eq!(bench.target(Dof::Index), None);
    bench.forget();
    bench.act(Action::Stop);
    assert!(bench.told().contains(&NoticeKind::StopNotSent));
    bench.run(5000).await;
    assert_eq!(bench.hand().connection.status.state, LinkState::Monitoring);
    assert!(!bench.hand().connection.is_armed());
    assert!(bench.told().contains(&NoticeKind::Reconnected));
    let told = bench.addresses();
    assert!(
        !told.is_empty() && told.iter().all(|address| *address == 1486),
        "{told:?}"
    );
    let before = bench.angle(Dof::Index);
    bench.run(1000).await;
    assert_eq!(bench.angle(Dof::Index), before);
}

#[tokio::test(start_paused = true)]
async fn records_come_in_the_order_in_which_it_happened() {
    let hand = hand::begin(hand::free(SimConfig::default()));
    let config = crate::setup::link::config("rs485:x", to_hand(hand));
    let (link, mut records) = handscope::link::open(config, &tokio::runtime::Handle::current());
    sleep(Duration::from_secs(1)).await;
    let lease = link.grant(Owner::Person);
    link.arm(lease, crate::setup::link::gentle()).unwrap();
    sleep(Duration::from_millis(200)).await;
    link.stop();
    sleep(Duration::from_secs(1)).await;
    let all: Vec<Record> = std::iter::from_fn(|| records.try_next()).collect();
    let states = all.iter().filter_map(|record| match record {
        Record::State { state, .. } => Some(*state),
        _ => None,
    });
    assert_eq!(
        states.collect::<Vec<_>>(),
        [
            LinkState::Identifying,
            LinkState::Monitoring,
            LinkState::Armed,
            // A stop disarms first, in the same step.
            LinkState::Monitoring,
            LinkState::Holding,
            LinkState::Monitoring,
        ]
    );
    let at = |record: &Record| -> Moment {
        match record {
            Record::Reading { sample, .. } => sample.angle.map_or(Moment::ZERO, |all| all.received),
            Record::State { at, .. }
            | Record::Sent { at, .. }
            | Record::Answered { at, .. }
            | Record::ArmRefused { at, .. } => *at,
        }
    };
    let is_write = |record: &&Record| !matches!(record, Record::Reading { .. });
    let moments: Vec<_> = all.iter().filter(is_write).map(at).collect();
    assert!(moments.is_sorted(), "{moments:?}");
    let (mut open, mut last) = (None, 0);
    for record in &all {
        match record {
            Record::Sent { number, .. } => {
                assert_eq!((open.replace(*number), *number), (None, last + 1));
                last = *number;
            }
            Record::Answered { number, fate, .. } => {
                assert_eq!(open.take(), Some(*number), "each right after its write");
                assert_eq!(*fate, WriteFate::Acknowledged);
            }
            _ => {}
        }
    }
    assert!(last >= 3 && open.is_none(), "limits and a stop");
    assert_eq!(records.lost(), 0);
}

#[tokio::test(start_paused = true)]
async fn an_armed_hand_that_is_asked_nothing_is_told_of_and_disarmed_only_if_that_is_set() {
    async fn minutes(bench: &mut Bench, minutes: u64) {
        for _ in 0..minutes * 120 {
            sleep(Duration::from_millis(500)).await;
            bench.run(10).await;
        }
    }
    let mut bench = Bench::armed().await;
    minutes(&mut bench, 4).await;
    assert_eq!(bench.hand().connection.idle(bench.state().now), None);
    minutes(&mut bench, 2).await;
    assert!(bench.hand().connection.idle(bench.state().now).is_some());
    assert!(bench.hand().connection.is_armed(), "off by default");
    bench.act(Action::Target(Dof::Index, Angle::nearest(900)));
    bench.run(100).await;
    assert_eq!(bench.hand().connection.idle(bench.state().now), None);
    bench.act(Action::DisarmIdle(true));
    minutes(&mut bench, 6).await;
    assert!(!bench.hand().connection.is_armed());
    assert!(bench.told().contains(&NoticeKind::IdleDisarmed));
}
