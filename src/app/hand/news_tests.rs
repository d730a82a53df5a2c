//! What is heard of a link changes what is shown and told, and nothing else. No link is open here.

use crate::app::controls::JointChange;
use crate::app::env::Ctx;
use crate::app::env::{Env, LostSteps, NoChoice, no_reveal};
use crate::app::hand::Hand;
use crate::app::notices::{Level, NoticeKind, Notices};
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, Faults, Group, Groups, HandSample, Moment, PerDof, Timed,
};
use crate::inputs::pad::device::system_pads;
use crate::link::{Clock, LinkStatus, LinkTrouble};
use crate::record::{ArmRefusal, Disarmed, Hold, LinkState, Record, Rest};
use crate::transport::SystemDial;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};

struct Bench {
    hand: Hand,
    notices: Notices,
    millis: u64,
    env: Env,
    _runtime: Runtime,
}

impl Bench {
    fn new() -> Self {
        let mut hand = Hand::default();
        hand.connection.endpoint = "rs485:/dev/ttyUSB0".parse().ok();
        let runtime = Builder::new_current_thread().build().unwrap();
        hand.follow();
        Self {
            hand,
            notices: Notices::default(),
            millis: 1,
            env: Env {
                runtime: runtime.handle().clone(),
                clock: Clock::start(),
                dial: Arc::new(SystemDial),
                pads: system_pads(),
                wake: Arc::new(|| ()),
                files: Arc::new(NoChoice),
                reveal: no_reveal(),
                settings_path: None,
                documents: None,
                lost_steps: LostSteps::default(),
            },
            _runtime: runtime,
        }
    }

    fn monitoring(angle: i16) -> Self {
        let mut bench = Self::new();
        bench.state(LinkState::Monitoring);
        bench.angles(angle);
        bench
    }

    fn stop(&mut self) {
        let mut ctx = Ctx {
            now: self.now(),
            env: &self.env,
            notices: self.notices.about(None),
        };
        self.hand.stop(&mut ctx);
    }

    fn now(&self) -> Moment {
        Moment::from_micros(self.millis * 1000)
    }

    /// The link says so, and nothing else of before.
    fn status(&mut self, status: LinkStatus) {
        self.millis += 10;
        let now = self.now();
        self.hand
            .apply_status(status, &mut self.notices.about(None), now);
        self.hand.follow();
    }

    fn state(&mut self, state: LinkState) {
        self.status(self.in_state(state));
    }

    fn in_state(&self, state: LinkState) -> LinkStatus {
        LinkStatus {
            state,
            since: self.now(),
            ..LinkStatus::default()
        }
    }

    fn epoch(&mut self, epoch: u64) {
        self.millis += 1;
        let armed = Some(ArmEpoch(epoch));
        self.status(LinkStatus {
            armed,
            ..self.in_state(LinkState::Armed)
        });
    }

    fn read(&mut self, sample: HandSample, group: Group) {
        let mut fresh = Groups::NONE;
        fresh.insert(group);
        let sample = Arc::new(sample);
        let record = Record::Reading { sample, fresh };
        let now = self.now();
        self.hand.apply(&record, &mut self.notices.about(None), now);
        self.hand.follow();
    }

    fn angles(&mut self, angle: i16) {
        self.millis += 1;
        let at = self.now();
        let sample = HandSample {
            angle: Some(Timed {
                value: PerDof::splat(AngleReading::new(angle)),
                asked: at,
                received: at,
            }),
            ..self.hand.readings.sample
        };
        self.read(sample, Group::Angle);
    }

    fn target(&self, dof: Dof) -> Option<i16> {
        self.hand.controls.joints[dof].target.map(Angle::get)
    }

    fn told(&self) -> Vec<NoticeKind> {
        let notices = self.notices.iter();
        notices.map(|notice| notice.what.clone()).collect()
    }
}

#[test]
fn sliders_follow_the_hand_until_it_is_armed() {
    let mut bench = Bench::new();
    assert_eq!(bench.target(Dof::Little), None);
    bench.state(LinkState::Monitoring);
    for angle in [400, 650] {
        bench.angles(angle);
        assert_eq!(bench.target(Dof::Little), Some(angle));
    }
    bench.angles(-999);
    assert_eq!(
        bench.target(Dof::Little),
        None,
        "a value far outside the manual is no pose"
    );
}

#[test]
fn an_old_or_unknown_pose_cannot_be_armed() {
    let bench = Bench::monitoring(400);
    let later = bench.now().plus(Duration::from_millis(300));
    let unread = Some(ArmRefusal::NotRead);
    assert_eq!(bench.hand.arm_refusal(later), unread);
    assert_eq!(bench.hand.pose_now(later), None, "nor kept as a pose");
    let nowhere = Bench::new();
    assert_eq!(
        nowhere.hand.arm_refusal(nowhere.now()),
        Some(ArmRefusal::Offline)
    );
}

#[test]
fn the_links_own_word_comes_later_and_arms_nothing_after_a_stop() {
    let mut bench = Bench::monitoring(400);
    bench.epoch(1);
    assert!(bench.hand.connection.is_armed());
    let armed = bench.hand.connection.status.clone();
    bench.stop();
    assert!(!bench.hand.connection.is_armed(), "at once");
    // Until then it still says armed.
    bench.status(armed);
    assert!(!bench.hand.connection.is_armed() && bench.hand.connection.status.armed.is_none());
    assert_eq!(bench.target(Dof::Index), Some(400));
    bench.epoch(2);
    assert!(bench.hand.connection.is_armed(), "a later arming counts");
}

#[test]
fn after_disarming_the_sliders_follow_again() {
    let mut bench = Bench::monitoring(400);
    bench.epoch(1);
    bench
        .hand
        .change_joint(Dof::Index, JointChange::Target(Angle::MAX));
    bench.angles(410);
    assert_eq!(
        (bench.target(Dof::Index), bench.target(Dof::Ring)),
        (Some(1000), Some(400)),
        "where a person has them while it is armed"
    );
    bench.hand.disarm(bench.now());
    bench.state(LinkState::Monitoring);
    bench.angles(450);
    assert_eq!(bench.target(Dof::Index), Some(450));
}

#[test]
fn a_lost_link_forgets_targets_and_a_found_one_is_not_armed() {
    let mut bench = Bench::monitoring(400);
    bench.epoch(1);
    bench
        .hand
        .change_joint(Dof::Index, JointChange::Target(Angle::MIN));
    let trouble = LinkTrouble::Silent { silent: 5 };
    bench.status(LinkStatus {
        trouble: Some(trouble.clone()),
        disarmed: Some(Disarmed::LinkLost),
        ..bench.in_state(LinkState::Offline)
    });
    assert_eq!(bench.target(Dof::Index), None);
    assert!(
        bench.hand.readings.sample.angle.is_some(),
        "kept, and shown as old"
    );
    let lost = NoticeKind::LinkLost(trouble);
    assert!(bench.told().contains(&lost));
    let disarmed = NoticeKind::Disarmed(Disarmed::LinkLost);
    assert!(bench.told().contains(&disarmed));
    bench.state(LinkState::Monitoring);
    assert_eq!(
        bench.target(Dof::Index),
        None,
        "not before the hand was read again"
    );
    bench.angles(700);
    assert_eq!(bench.target(Dof::Index), Some(700));
    assert!(!bench.hand.connection.is_armed());
    assert!(bench.told().contains(&NoticeKind::Reconnected));
    bench.epoch(2);
    assert!(
        !bench.told().contains(&NoticeKind::Reconnected),
        "it says that the hand is not armed"
    );
}

#[test]
fn a_hand_that_was_never_reached_is_not_called_lost() {
    let mut bench = Bench::new();
    let trouble = LinkTrouble::NoAnswer { id: 1 };
    bench.status(LinkStatus {
        trouble: Some(trouble.clone()),
        ..bench.in_state(LinkState::Offline)
    });
    assert_eq!(bench.told(), [NoticeKind::NoLink(trouble)]);
    bench.state(LinkState::Monitoring);
    assert_eq!(bench.told(), [], "it is reached now, for the first time");
}

#[test]
fn an_adapter_that_keeps_replies_back_is_told_of_with_its_port_of_now() {
    let mut bench = Bench::new();
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
        bench.notices = Notices::default();
        for _ in 0..2 {
            bench.status(LinkStatus {
                latency_timer_ms: timer,
                latency_ticks: ticks,
                moved_to: Some("/dev/ttyUSB1".into()),
                ..bench.in_state(LinkState::Monitoring)
            });
        }
        let slow = |what: &NoticeKind| matches!(what, NoticeKind::LatencyTimer { .. });
        let mut slow_ones = bench.told();
        slow_ones.retain(slow);
        assert_eq!(slow_ones, wanted, "once a connection");
    }
}

#[test]
fn holds_and_faults_are_told() {
    let mut bench = Bench::monitoring(400);
    let at = bench.now();
    bench.status(LinkStatus {
        hold: Hold::Alarm { at },
        ..bench.in_state(LinkState::Holding)
    });
    let level = bench.notices.iter().next().map(|notice| notice.level);
    assert_eq!(level, Some(Level::Alarm));
    let rest = bench.now();
    bench.status(LinkStatus {
        hold: Hold::Confirmed { at, rest },
        ..bench.in_state(LinkState::Monitoring)
    });
    let after = rest.since(at);
    assert_eq!(bench.told(), [NoticeKind::HoldConfirmed { after }]);
    let faults = Timed {
        value: PerDof::splat(Faults::from_raw(1)),
        asked: rest,
        received: rest,
    };
    let sample = HandSample {
        faults: Some(faults),
        ..bench.hand.readings.sample
    };
    for _ in 0..3 {
        bench.read(sample, Group::Faults);
    }
    let is_fault = |what: &NoticeKind| matches!(what, NoticeKind::Fault { .. });
    let log = bench.notices.log();
    let told = log.filter(|notice| is_fault(&notice.what)).count();
    assert_eq!(told, 6, "once a joint");
    assert_eq!(bench.hand.readings.faults.unseen().count(), 6);
    assert!(
        !bench.told().iter().any(is_fault),
        "the list of faults asks for attention"
    );
}

#[test]
fn stop_without_a_live_link_says_that_nothing_was_sent() {
    for state in [LinkState::Offline, LinkState::Identifying] {
        let mut bench = Bench::new();
        bench.state(state);
        bench.stop();
        assert_eq!(bench.told(), [NoticeKind::StopNotSent], "{state:?}");
    }
}

#[test]
fn a_hand_that_was_moved_and_is_not_known_to_rest_is_stopped_before_it_is_left() {
    let mut bench = Bench::monitoring(400);
    for (rest, may_move) in [
        (Rest::Moving, true),
        (Rest::Unknown, true),
        (Rest::Resting, false),
    ] {
        bench.hand.connection.commanded = true;
        bench.status(LinkStatus {
            rest,
            ..bench.in_state(LinkState::Monitoring)
        });
        assert_eq!(bench.hand.connection.may_move(), may_move, "{rest:?}");
    }
}

#[test]
fn a_hand_at_rest_that_was_only_watched_needs_no_stop_to_leave() {
    let mut bench = Bench::monitoring(400);
    assert!(!bench.hand.connection.may_move());
    bench.epoch(1);
    assert!(bench.hand.connection.may_move());
    let told = bench.now();
    bench.stop();
    assert!(!bench.hand.connection.is_held(told));
    let rest = bench.now().plus(Duration::from_millis(1));
    bench.status(LinkStatus {
        hold: Hold::Confirmed { at: told, rest },
        ..bench.in_state(LinkState::Monitoring)
    });
    assert!(bench.hand.connection.is_held(told));
}
