//! The rules that hold for every program, on a hand that only notes what it is told.

use crate::fake::{Asked, FakeHand, Said, WELL};
use crate::hand::{
    Angle, ArmEpoch, Dof, Fault, Faults, Groups, HandSample, Moment, Setpoints, Target,
};
use crate::link::{Owner, Stop};
use crate::motion::drive::{Armed, EndReport, drive};
use crate::motion::program::{Ended, Order, Program, Progress, Seen};
use crate::record::{Abort, Disarmed, LinkState, SetpointConflict, SetpointRegister};
use futures::stream::pending;
use std::convert::Infallible;
use std::time::Duration;
use tokio::task::JoinHandle;
use tokio::time::{advance, sleep};

const EPOCH: ArmEpoch = ArmEpoch(1);
/// What another controller wrote.
const FOREIGN: SetpointConflict = SetpointConflict {
    register: SetpointRegister::AngleSet,
    dof: Dof::Index,
    holds: Some(300),
    wrote: Some(1000),
};

/// Moves the index finger in each step, without end; `pauses` disarms first.
struct Restless {
    pauses: bool,
    aborted: Option<Abort>,
}

impl Program for Restless {
    type Input = Abort;
    type Outcome = ();
    type View = ();
    type Event = Infallible;

    fn input(&mut self, why: Abort, seen: &Seen<'_>) -> Option<Order> {
        self.abort(why, seen.now);
        None
    }

    fn read(&mut self, _sample: &HandSample, _fresh: Groups, _now: Moment) {}

    fn tick(&mut self, _seen: &Seen<'_>) -> Option<Order> {
        if std::mem::take(&mut self.pauses) {
            return Some(Order::Disarm);
        }
        let mut setpoints = Setpoints::none(EPOCH);
        setpoints.angle[Dof::Index] = Some(Target::Go(Angle::MAX));
        Some(Order::Set(setpoints))
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.aborted.get_or_insert(why);
    }

    fn view(&self, _now: Moment) {}

    fn ended(&self) -> Option<Ended<()>> {
        self.aborted.map(Err)
    }
}

/// One that runs, and its output that is not taken from some step on.
fn start(hand: &FakeHand, pauses: bool, reports: usize) -> JoinHandle<EndReport> {
    hand.arm_as(EPOCH.0);
    let armed = Armed {
        epoch: EPOCH,
        lease: hand.grant(Owner::Task),
        seen: HandSample::default(),
        clock: hand.clock,
    };
    let program = Restless {
        pauses,
        aborted: None,
    };
    let link = hand.clone();
    let mut left = reports;
    tokio::spawn(async move {
        let report = |_: Progress<(), Infallible>| {
            left = left.saturating_sub(1);
            left > 0
        };
        drive(&link, armed, program, pending(), report)
            .await
            .report()
    })
}

#[tokio::test(start_paused = true)]
async fn whatever_breaks_a_program_off_it_is_named_and_the_hand_is_stopped() {
    type Break = fn(&FakeHand);
    let fault = Faults::from_raw(1);
    let wrote = Some(FOREIGN);
    let ways: [(Break, Abort); 8] = [
        (
            |hand| hand.change(|status| status.state = LinkState::Offline),
            Abort::LinkLost,
        ),
        (|hand| hand.arm_as(2), Abort::ArmedAnew),
        (
            |hand| hand.disarm(),
            Abort::Disarmed {
                why: Some(Disarmed::Person),
            },
        ),
        (
            |hand| hand.disarm_for(Disarmed::Stale),
            Abort::Disarmed {
                why: Some(Disarmed::Stale),
            },
        ),
        (
            |hand| hand.change(|status| status.state = LinkState::Fault),
            Abort::Fault { joint: None },
        ),
        (
            |hand| {
                // The reading waits when the link tells of the fault.
                hand.says(Said { faults: 1, ..WELL });
                hand.change(|status| status.state = LinkState::Fault);
            },
            Abort::Fault {
                joint: Some((Dof::Little, fault)),
            },
        ),
        (
            |hand| {
                hand.says(Said {
                    celsius: 71,
                    ..WELL
                });
                hand.disarm_for(Disarmed::Hot);
            },
            Abort::Heat {
                dof: Dof::ThumbRotate,
                celsius: 71,
                limit: 70,
            },
        ),
        (
            |hand| {
                hand.disarm_for(Disarmed::OtherController);
                hand.change(|status| status.foreign_setpoint = Some(FOREIGN));
            },
            Abort::OtherController { wrote },
        ),
    ];
    for (break_off, why) in ways {
        let hand = FakeHand::new();
        let task = start(&hand, false, usize::MAX);
        sleep(Duration::from_millis(30)).await;
        assert!(!task.is_finished(), "{why}");
        hand.asked();
        break_off(&hand);
        let end = task.await.unwrap();
        assert_eq!(end.aborted, Some(why));
        assert!(end.stop.is_some(), "{why}");
        let asked = hand.asked();
        let stop = asked.iter().position(|one| *one == Asked::Stop).unwrap();
        let moves = |one: &Asked| matches!(one, Asked::Move(_));
        assert!(!asked[stop..].iter().any(moves), "{why}: {asked:?}");
    }
    assert!(fault.iter().eq([Fault::Stall]), "the bit of this test");
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_another_controller_was_granted_is_left_to_it() {
    let hand = FakeHand::new();
    let task = start(&hand, false, usize::MAX);
    sleep(Duration::from_millis(30)).await;
    let _another = hand.grant(Owner::Person);
    hand.asked();
    let end = task.await.unwrap();
    assert_eq!((end.aborted, end.stop), (Some(Abort::TakenOver), None));
    assert_eq!(hand.asked(), []);
}

/// A program would take its own time limits for exceeded, and end with the wrong reason.
#[tokio::test(start_paused = true)]
async fn after_a_stall_the_link_decides_first_whether_the_computer_slept() {
    let hand = FakeHand::new();
    let task = start(&hand, false, usize::MAX);
    let moves = |hand: &FakeHand| {
        let asked = hand.asked();
        asked.iter().any(|one| matches!(one, Asked::Move(_)))
    };
    sleep(Duration::from_millis(30)).await;
    assert!(moves(&hand));
    advance(Duration::from_secs(10)).await;
    moves(&hand);
    sleep(Duration::from_millis(60)).await;
    assert!(!moves(&hand), "nothing is decided yet");
    sleep(Duration::from_millis(100)).await;
    assert!(moves(&hand), "it did not sleep");
    advance(Duration::from_millis(500)).await;
    moves(&hand);
    sleep(Duration::from_millis(30)).await;
    assert!(moves(&hand), "nobody takes half a second for sleep");
    advance(Duration::from_secs(10)).await;
    hand.disarm_for(Disarmed::Resume);
    let end = task.await.unwrap();
    let why = Some(Disarmed::Resume);
    assert_eq!(end.aborted, Some(Abort::Disarmed { why }));
}

#[tokio::test(start_paused = true)]
async fn a_report_that_is_not_taken_stops_the_hand() {
    let hand = FakeHand::new();
    let end = start(&hand, false, 4).await.unwrap();
    assert_eq!(end.aborted, Some(Abort::NotKept));
    assert!(matches!(end.stop, Some(Stop::Confirmed { .. })));
}

#[tokio::test(start_paused = true)]
async fn while_a_program_keeps_the_hand_disarmed_whoever_moves_it_ends_it_with_a_stop() {
    type Break = fn(&FakeHand);
    let wrote = Some(FOREIGN);
    let ways: [(Break, Abort); 2] = [
        (|hand| hand.arm_as(2), Abort::ArmedAnew),
        (
            |hand| {
                hand.change(|status| status.foreign_setpoint = Some(FOREIGN));
            },
            Abort::OtherController { wrote },
        ),
    ];
    for (break_off, why) in ways {
        let hand = FakeHand::new();
        let task = start(&hand, true, usize::MAX);
        sleep(Duration::from_millis(100)).await;
        assert!(!task.is_finished(), "{why}");
        let asked = hand.asked();
        assert_eq!(
            asked,
            [Asked::Disarm],
            "nothing passes a hand that is not armed"
        );
        break_off(&hand);
        let end = task.await.unwrap();
        assert_eq!(end.aborted, Some(why));
        assert!(hand.asked().contains(&Asked::Stop), "{why}");
    }
}
