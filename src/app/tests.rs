//! Proves the rules of motion against a link that only notes what it is told.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may")]

use crate::app::action::Preset;
use crate::app::gestures::GestureProgress;
use crate::app::notices::{Asked, Level, NoticeKind, Notices};
use crate::hand::{
    Angle, Dof, Faults, Force, Gesture, GestureRoute, Group, Groups, HandCommand, HandSample,
    PerDof, Speed, Target, Timed,
};
use crate::link::{
    ArmRefusal, ArmRequest, Disarmed, Hold, LinkEvent, LinkState, LinkTrouble, Outcome, Request,
    RequestError, Ticket,
};
use crate::transport::Endpoint;

use crate::app::fake_link::*;
#[test]
fn nothing_is_told_by_starting_connecting_or_dragging_while_not_armed() {
    let mut bench = Bench::monitoring(400);
    for dof in Dof::ALL {
        bench.desk.target(dof, Angle::MIN);
        bench.desk.force(dof, Force::RATED);
        bench.desk.speed(dof, Speed::MAX);
        bench.desk.lock(dof, true);
        bench.desk.lock(dof, false);
    }
    bench.desk.preset(Preset::Open);
    bench.desk.gesture(Gesture::MIN, bench.now());
    bench.step();
    assert_eq!(bench.told(), []);
    assert_eq!(
        bench.target(Dof::Index),
        Some(400),
        "the slider shows where the joint is"
    );
    assert_eq!(
        bench.desk.state.joints[Dof::Index].force,
        Force::RATED,
        "kept for arming"
    );
}

#[test]
fn sliders_follow_the_hand_until_it_is_armed() {
    let mut bench = Bench::new();
    assert_eq!(bench.target(Dof::Little), None);
    bench.state(LinkState::Monitoring);
    for angle in [400, 650] {
        bench.angles(angle);
        bench.step();
        assert_eq!(bench.target(Dof::Little), Some(angle));
    }
    bench.angles(-999);
    bench.step();
    assert_eq!(
        bench.target(Dof::Little),
        None,
        "a value far outside the manual is no pose"
    );
}

#[test]
fn arming_sends_the_staged_limits_and_no_angle() {
    let mut bench = Bench::monitoring(400);
    bench.desk.speed(Dof::Ring, Speed::MIN);
    bench.desk.arm(bench.now());
    let mut speed = PerDof::splat(Speed::GENTLE);
    speed[Dof::Ring] = Speed::MIN;
    assert_eq!(
        bench.told(),
        [Told::Arm(ArmRequest {
            speed,
            force: PerDof::splat(Force::GENTLE)
        })]
    );
    bench.epoch(1);
    bench.step();
    assert_eq!(bench.told(), []);
    assert_eq!(bench.target(Dof::Ring), Some(400));
}

#[test]
fn an_old_or_unknown_pose_cannot_be_armed() {
    let mut bench = Bench::monitoring(400);
    bench.millis += 300;
    bench.step();
    bench.desk.arm(bench.now());
    assert_eq!(bench.told(), []);
    assert_eq!(
        bench.notices(),
        [NoticeKind::ArmRefused(ArmRefusal::UnknownPose {
            dof: Dof::Little
        })]
    );
    let mut nowhere = Bench::new();
    nowhere.desk.arm(nowhere.now());
    assert_eq!(
        nowhere.notices(),
        [NoticeKind::ArmRefused(ArmRefusal::Offline)]
    );
}

#[test]
fn an_armed_joint_goes_where_it_is_told_and_a_locked_one_never() {
    let mut bench = Bench::armed(400);
    bench.desk.target(Dof::Index, Angle::MAX);
    assert_eq!(
        bench.told(),
        [set(1, |all| all.angle[Dof::Index] =
            Some(Target::Go(Angle::MAX)))]
    );
    bench.desk.lock(Dof::Ring, true);
    bench.desk.target(Dof::Ring, Angle::MIN);
    bench.desk.force(Dof::Ring, Force::MIN);
    bench.desk.speed(Dof::Ring, Speed::MAX);
    assert_eq!(bench.told(), []);
    bench.angles(500);
    bench.step();
    assert_eq!(
        (bench.target(Dof::Index), bench.target(Dof::Ring)),
        (Some(1000), Some(500))
    );
    bench.desk.preset(Preset::Open);
    let [Told::Set(all)] = bench.told()[..] else {
        panic!("one write")
    };
    assert_eq!(all.angle[Dof::Ring], None);
    assert_eq!(
        all.angle
            .iter()
            .filter(|(_, angle)| angle.is_some())
            .count(),
        5
    );
}

#[test]
fn stop_works_in_every_state_and_disarms_at_once() {
    for state in [
        LinkState::Offline,
        LinkState::Identifying,
        LinkState::Monitoring,
        LinkState::Holding,
        LinkState::Fault,
    ] {
        let mut bench = Bench::monitoring(400);
        bench.state(state);
        bench.step();
        bench.desk.stop(bench.now());
        assert_eq!(bench.told(), [Told::Stop], "{state:?}");
    }
    let mut bench = Bench::armed(400);
    bench.desk.target(Dof::Index, Angle::MIN);
    bench.desk.stop(bench.now());
    bench.told();
    assert!(!bench.desk.state.is_armed());
    assert_eq!(
        bench.target(Dof::Index),
        Some(400),
        "the slider is back at the hand"
    );
    bench.desk.target(Dof::Index, Angle::MIN);
    // The link's own word comes later: until then it still says armed.
    bench.step();
    bench.desk.target(Dof::Index, Angle::MIN);
    assert!(!bench.desk.state.is_armed());
    assert_eq!(bench.told(), [], "nothing passes after stop");
    bench.epoch(2);
    bench.step();
    assert!(bench.desk.state.is_armed(), "a later arming counts");
}

#[test]
fn after_disarming_the_sliders_follow_again() {
    let mut bench = Bench::armed(400);
    bench.desk.target(Dof::Index, Angle::MAX);
    bench.desk.disarm(bench.now());
    bench.state(LinkState::Monitoring);
    bench.angles(450);
    bench.step();
    assert_eq!(bench.target(Dof::Index), Some(450));
    assert_eq!(bench.told().last(), Some(&Told::Disarm));
}

#[test]
fn a_lost_link_forgets_targets_and_a_found_one_is_not_armed() {
    let mut bench = Bench::armed(400);
    bench.desk.target(Dof::Index, Angle::MIN);
    bench.told();
    bench.state(LinkState::Offline);
    let trouble = LinkTrouble::Silent { silent: 5 };
    bench.wire.borrow_mut().status.trouble = Some(trouble.clone());
    bench.wire.borrow_mut().status.disarmed = Some(Disarmed::LinkLost);
    bench.step();
    assert_eq!(bench.target(Dof::Index), None);
    assert!(
        bench.desk.state.sample.angle.is_some(),
        "kept, and shown as old"
    );
    assert!(bench.notices().contains(&NoticeKind::LinkLost(trouble)));
    assert!(
        bench
            .notices()
            .contains(&NoticeKind::Disarmed(Disarmed::LinkLost))
    );
    bench.state(LinkState::Monitoring);
    bench.step();
    assert_eq!(
        bench.target(Dof::Index),
        None,
        "not before the hand was read again"
    );
    bench.angles(700);
    bench.step();
    assert_eq!(bench.target(Dof::Index), Some(700));
    assert!(!bench.desk.state.is_armed());
    assert_eq!(bench.told(), []);
    assert!(bench.notices().contains(&NoticeKind::Reconnected));
}

#[test]
fn another_hand_inherits_nothing() {
    let mut bench = Bench::armed(400);
    let now = bench.now();
    bench.desk.replace(Some(Endpoint::sim()), None, now);
    assert_eq!(bench.desk.state.sample, HandSample::default());
    assert_eq!(bench.target(Dof::Index), None);
    assert!(!bench.desk.state.is_armed());
}

#[test]
fn a_hand_that_was_never_reached_is_not_called_lost() {
    let mut bench = Bench::new();
    let trouble = LinkTrouble::NoAnswer { id: 1 };
    bench.wire.borrow_mut().status.trouble = Some(trouble.clone());
    bench.step();
    assert_eq!(bench.notices(), [NoticeKind::NoLink(trouble)]);
    bench.state(LinkState::Monitoring);
    bench.step();
    assert_eq!(bench.notices(), [], "it is reached now, for the first time");
}

#[test]
fn an_adapter_that_keeps_replies_back_is_told_of_with_its_port_of_now() {
    let mut bench = Bench::new();
    bench.desk.state.endpoint = "rs485:/dev/ttyUSB0".parse().ok();
    let told = |ms| NoticeKind::LatencyTimer {
        port: "/dev/ttyUSB1".into(),
        ms,
    };
    for (timer, ticks, wanted) in [
        (Some(1), false, vec![]),
        (Some(16), false, vec![told(Some(16))]),
        (None, true, vec![told(None)]),
    ] {
        bench.state(LinkState::Offline);
        bench.step();
        bench.desk.state.notices = Notices::default();
        bench.state(LinkState::Monitoring);
        {
            let mut wire = bench.wire.borrow_mut();
            wire.status.latency_timer_ms = timer;
            wire.status.latency_ticks = ticks;
            wire.status.moved_to = Some("/dev/ttyUSB1".into());
        }
        bench.step();
        bench.step();
        let slow: Vec<_> = bench
            .notices()
            .into_iter()
            .filter(|kind| matches!(kind, NoticeKind::LatencyTimer { .. }))
            .collect();
        assert_eq!(slow, wanted);
    }
}

#[test]
fn holds_and_faults_are_told() {
    let mut bench = Bench::monitoring(400);
    let at = bench.now();
    bench.wire.borrow_mut().status.hold = Hold::Alarm { at };
    bench.step();
    assert_eq!(
        bench
            .desk
            .state
            .notices
            .iter()
            .next()
            .map(|notice| notice.level),
        Some(Level::Alarm)
    );
    let rest = bench.now();
    bench.wire.borrow_mut().status.hold = Hold::Confirmed { at, rest };
    bench.step();
    assert_eq!(
        bench.notices(),
        [NoticeKind::HoldConfirmed {
            after: rest.since(at)
        }]
    );
    let faults = Timed {
        value: PerDof::splat(Faults::from_raw(1)),
        asked: rest,
        received: rest,
    };
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Faults);
    let sample = Box::new(HandSample {
        faults: Some(faults),
        ..HandSample::default()
    });
    for _ in 0..3 {
        bench.wire.borrow_mut().events.push_back(LinkEvent::Sample {
            sample: sample.clone(),
            fresh,
        });
    }
    bench.step();
    let is_fault = |what: &NoticeKind| matches!(what, NoticeKind::Fault { .. });
    let log = bench.desk.state.notices.log();
    let told = log.filter(|notice| is_fault(&notice.what)).count();
    assert_eq!(told, 6, "once a joint");
    assert_eq!(bench.desk.state.faults.unseen().count(), 6);
    assert!(
        !bench.notices().iter().any(is_fault),
        "the list of faults asks for attention"
    );
}

#[test]
fn gestures_need_arming_a_route_and_free_joints() {
    let mut bench = Bench::armed(400);
    let what = Asked::Gesture(Gesture::MIN);
    bench.desk.state.gestures.route = GestureRoute::Off;
    bench.desk.gesture(Gesture::MIN, bench.now());
    bench.desk.state.gestures.route = GestureRoute::Register1008;
    bench.desk.lock(Dof::Ring, true);
    bench.desk.gesture(Gesture::MIN, bench.now());
    assert_eq!(bench.told(), []);
    bench.desk.lock(Dof::Ring, false);
    bench.told();
    bench.desk.gesture(Gesture::MIN, bench.now());
    let command = HandCommand::Gesture(Gesture::MIN, GestureRoute::Register1008);
    assert_eq!(bench.told(), [Told::Ask(Request::Command(command))]);
    bench.angles(900);
    bench.wire.borrow_mut().events.push_back(LinkEvent::Done {
        ticket: Ticket(7),
        result: Ok(Outcome::Acknowledged),
    });
    bench.step();
    assert_eq!(
        bench.desk.state.gestures.last.map(|last| last.progress),
        Some(GestureProgress::Acknowledged)
    );
    assert_eq!(bench.target(Dof::Index), Some(900), "the sliders go along");
    assert!(bench.notices().contains(&NoticeKind::Acknowledged { what }));
}

#[test]
fn what_could_not_be_asked_is_told() {
    let mut bench = Bench::monitoring(400);
    bench.wire.borrow_mut().refuse = Some(RequestError::Full { limit: 16 });
    bench.desk.clear_errors(bench.now());
    assert_eq!(
        bench.told(),
        [Told::Ask(Request::Command(HandCommand::ClearErrors))]
    );
    let error = RequestError::Full { limit: 16 };
    assert_eq!(
        bench.notices(),
        [NoticeKind::RequestFailed {
            what: Asked::ClearErrors,
            error
        }]
    );
}

#[test]
fn a_flood_of_events_is_taken_a_frame_at_a_time_and_nothing_is_lost() {
    let mut bench = Bench::monitoring(400);
    for angle in 0..600 {
        bench.angles(angle);
    }
    bench.step();
    assert_eq!(bench.wire.borrow().events.len(), 600 - 256);
    bench.step();
    bench.step();
    assert_eq!(bench.target(Dof::Index), Some(599));
}

#[test]
fn a_hand_at_rest_that_was_only_watched_needs_no_stop_to_leave() {
    let mut bench = Bench::monitoring(400);
    assert!(!bench.desk.may_move());
    bench.epoch(1);
    bench.step();
    assert!(bench.desk.may_move());
    let told = bench.now();
    bench.desk.stop(told);
    assert!(!bench.desk.is_at_rest(told));
    bench.state(LinkState::Monitoring);
    bench.wire.borrow_mut().status.hold = Hold::Confirmed {
        at: told,
        rest: bench.now(),
    };
    bench.step();
    assert!(bench.desk.is_at_rest(told));
}

#[test]
fn a_request_that_the_lost_link_took_along_is_told() {
    let mut bench = Bench::monitoring(400);
    bench.desk.clear_errors(bench.now());
    bench.state(LinkState::Offline);
    bench.step();
    let result = Err(RequestError::LinkLost);
    bench.wire.borrow_mut().events.push_back(LinkEvent::Done {
        ticket: Ticket(7),
        result,
    });
    bench.step();
    let (what, error) = (Asked::ClearErrors, RequestError::LinkLost);
    assert_eq!(bench.notices(), [NoticeKind::RequestFailed { what, error }]);
}
