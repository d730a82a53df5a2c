//! What a motion to targets sends and how it ends, on a hand that only notes what it is told.

use crate::fake::{Asked, FakeHand, Said, WELL};
use crate::hand::grip::GripEstimator;
use crate::hand::{Angle, ArmEpoch, Dof, Force, HandSample, PerDof, Speed, Target};
use crate::link::{ArmRequest, Owner};
use crate::motion::drive::Armed;
use crate::motion::move_to::{MoveEnd, MoveReport, MoveStart, move_to};
use crate::poses::way::Targets;
use crate::record::{Abort, Disarmed, LinkState, Rest};
use std::time::Duration;
use tokio::task::JoinHandle;
use tokio::time::sleep;

struct Bench {
    hand: FakeHand,
    task: JoinHandle<MoveReport>,
}

impl Bench {
    /// A motion of the whole hand, which is open.
    fn start(to: [Option<i16>; 6], settles: bool) -> Self {
        let hand = FakeHand::new();
        hand.arm_as(1);
        let targets: Targets = PerDof::new(to.map(|to| to.map(Angle::nearest)));
        let start = MoveStart {
            targets,
            limits: ArmRequest {
                speed: PerDof::splat(Speed::nearest(100)),
                force: PerDof::splat(Force::nearest(400)),
            },
            settles,
            grip: GripEstimator::default(),
        };
        let armed = Armed {
            epoch: ArmEpoch(1),
            lease: hand.grant(Owner::Task),
            seen: HandSample::default(),
            clock: hand.clock,
        };
        hand.change(|status| status.rest = Rest::Moving);
        let link = hand.clone();
        let task = tokio::spawn(async move { move_to(&link, armed, start).await });
        Self { hand, task }
    }

    /// All joints are there for so many readings, 10 ms apart.
    async fn at(&self, angle: i16, readings: usize) {
        for _ in 0..readings {
            self.hand.says(Said { angle, ..WELL });
            sleep(Duration::from_millis(10)).await;
        }
    }

    /// Index and thumb bend as they were sent since the last call.
    fn sent(&self) -> Vec<[Option<i16>; 2]> {
        let asked = self.hand.asked().into_iter();
        let moves = asked.filter_map(|asked| match asked {
            Asked::Move(setpoints) => {
                for (dof, to) in setpoints.angle.iter() {
                    let speed = to.map(|_| Speed::nearest(100));
                    let force = to.map(|_| Force::nearest(400));
                    assert_eq!((setpoints.speed[dof], setpoints.force[dof]), (speed, force));
                }
                Some(setpoints.angle)
            }
            _ => None,
        });
        let of = |angle: PerDof<Option<Target>>| {
            [Dof::Index, Dof::ThumbBend].map(|dof| angle[dof].map(Target::raw))
        };
        moves.map(of).collect()
    }
}

const INDEX: [Option<i16>; 6] = [None, None, None, Some(400), None, None];
const ALL: [Option<i16>; 6] = [Some(400); 6];

#[tokio::test(start_paused = true)]
async fn it_is_over_where_the_joints_are_and_not_before_it_was_sent() {
    let bench = Bench::start(INDEX, false);
    bench.at(1000, 3).await;
    assert_eq!(
        bench.sent(),
        [[Some(400), None]],
        "the others are left alone"
    );
    bench.at(500, 3).await;
    assert!(!bench.task.is_finished());
    bench.at(410, 3).await;
    assert_eq!(bench.task.await.unwrap().end, Ok(MoveEnd::Reached));
    assert!(
        bench.hand.asked().is_empty(),
        "it stays armed, and is told nothing"
    );
}

#[tokio::test(start_paused = true)]
async fn one_that_settles_waits_for_rest() {
    let bench = Bench::start(ALL, true);
    bench.at(400, 80).await;
    assert!(!bench.task.is_finished());
    bench.hand.change(|status| status.rest = Rest::Resting);
    bench.at(400, 3).await;
    assert_eq!(bench.task.await.unwrap().end, Ok(MoveEnd::Reached));
}

#[tokio::test(start_paused = true)]
async fn a_joint_that_rests_elsewhere_was_stopped() {
    let bench = Bench::start(ALL, false);
    // What is read right after it was sent shows a hand that does not move yet.
    bench.hand.change(|status| status.rest = Rest::Resting);
    bench.at(1000, 20).await;
    assert!(!bench.task.is_finished());
    bench.at(700, 60).await;
    assert_eq!(bench.task.await.unwrap().end, Ok(MoveEnd::Stopped));
}

#[tokio::test(start_paused = true)]
async fn thumb_and_index_do_not_meet_on_the_way() {
    // From a bent index and an open thumb to the reverse.
    let bench = Bench::start([None, None, None, Some(1000), Some(0), Some(0)], false);
    bench.at(300, 2).await;
    let sent = bench.sent();
    assert_eq!(
        sent[0],
        [None, Some(800)],
        "first the thumb goes out of the way"
    );
}

#[tokio::test(start_paused = true)]
async fn whatever_ends_it_nothing_is_sent_afterwards() {
    type Break = fn(&FakeHand);
    let ways: [(Break, Abort); 4] = [
        (
            |hand| hand.disarm(),
            Abort::Disarmed {
                why: Some(Disarmed::Person),
            },
        ),
        (
            |hand| hand.change(|status| status.state = LinkState::Fault),
            Abort::Fault { joint: None },
        ),
        (
            |hand| hand.change(|status| status.state = LinkState::Offline),
            Abort::LinkLost,
        ),
        (
            |hand| {
                hand.grant(Owner::Person);
            },
            Abort::TakenOver,
        ),
    ];
    for (break_off, want) in ways {
        let bench = Bench::start(ALL, false);
        bench.at(1000, 3).await;
        break_off(&bench.hand);
        bench.sent();
        bench.at(700, 5).await;
        assert_eq!(bench.sent(), [[None; 2]; 0], "{want:?}");
        assert_eq!(bench.task.await.unwrap().end, Err(want));
    }
}

#[tokio::test(start_paused = true)]
async fn one_that_never_arrives_ends_when_its_time_is_over() {
    let bench = Bench::start(ALL, false);
    // The whole stroke at this speed takes 6.6 s.
    bench.at(700, 1000).await;
    assert!(!bench.task.is_finished());
    bench.at(700, 100).await;
    assert_eq!(bench.task.await.unwrap().end, Ok(MoveEnd::Late));
}
