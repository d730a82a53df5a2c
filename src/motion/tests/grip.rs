//! What a grip by size sends and how it ends, on a hand that only notes what it is told.

use crate::fake::{Asked, FakeHand, WELL};
use crate::hand::feedback::tactile::TactileBlock;
use crate::hand::gap::Gap;
use crate::hand::grip::GripEstimator;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, Finger, Force, ForceReading, HandSample, PerDof, Setpoints,
    Speed, Status, Target, Timed,
};
use crate::link::Owner;
use crate::motion::drive::Armed;
use crate::motion::grip::{GripEnd, GripReport, GripStart, grip};
use crate::record::{Abort, Disarmed, LinkState, Rest};
use futures::{StreamExt as _, stream};
use std::cell::Cell;
use std::time::Duration;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;
use tokio::time::sleep;

/// A grip to 30 mm that goes on.
struct Bench {
    hand: FakeHand,
    /// What the hand holds of what it was told.
    holds: Cell<Option<Setpoints>>,
    /// Until a joint is told something, its ANGLE_SET holds "no action" (-1), as a stop without a known pose leaves it.
    begins_left_alone: Cell<bool>,
    /// Another controller writes so to its little finger: an angle, and a speed.
    foreign: Cell<[Option<i16>; 2]>,
    end: Option<oneshot::Sender<()>>,
    task: JoinHandle<GripReport>,
}

impl Bench {
    fn start() -> Self {
        let hand = FakeHand::new();
        hand.arm_as(1);
        let start = GripStart {
            gap: Gap::nearest(30.0),
            speed: Speed::nearest(100),
            force: Force::nearest(400),
            grip: GripEstimator::default(),
        };
        let armed = Armed {
            epoch: ArmEpoch(1),
            lease: hand.grant(Owner::Task),
            seen: HandSample::default(),
            clock: hand.clock,
        };
        let (end, ended) = oneshot::channel::<()>();
        let link = hand.clone();
        let task = tokio::spawn(async move {
            let ends = stream::once(async {
                ended.await.unwrap();
                Abort::Person
            });
            grip(&link, armed, start, ends.chain(stream::pending())).await
        });
        Self {
            hand,
            holds: Cell::new(None),
            begins_left_alone: Cell::new(false),
            foreign: Cell::new([None; 2]),
            end: Some(end),
            task,
        }
    }

    /// The hand is there for so many readings, 10 ms apart; `held` says whether thumb and index press on something.
    async fn at(&self, angles: PerDof<i16>, held: bool, readings: usize) {
        for _ in 0..readings {
            let now = self.hand.clock.now();
            let mut sample = WELL.sample(now);
            let timed = |angles| Timed {
                value: angles,
                asked: now,
                received: now,
            };
            sample.angle = Some(timed(angles.map(AngleReading::new)));
            self.read_back(&mut sample);
            if held {
                let block = TactileBlock::decode(&[0; 58]).unwrap();
                let pressed = TactileBlock {
                    normal_n: 4.0,
                    ..block
                };
                let mut status = PerDof::splat(Status::PositionReached);
                let mut force = PerDof::splat(ForceReading::new(3));
                for dof in [Dof::Index, Dof::ThumbBend] {
                    status[dof] = Status::ForceReached;
                    force[dof] = ForceReading::new(450);
                }
                sample.status = Some(Timed {
                    value: status,
                    asked: now,
                    received: now,
                });
                sample.force = Some(Timed {
                    value: force,
                    asked: now,
                    received: now,
                });
                for finger in [Finger::Index, Finger::Thumb] {
                    sample.tactile[finger] = Some(Timed {
                        value: pressed,
                        asked: now,
                        received: now,
                    });
                }
            }
            self.hand.tells(sample);
            sleep(Duration::from_millis(10)).await;
        }
    }

    /// The setpoints that the hand holds now.
    fn read_back(&self, sample: &mut HandSample) {
        let moved = self.hand.last_move();
        let known = self.holds.get();
        let told = moved.map(|moved| self.taken(&moved, known.as_ref()));
        self.holds.set(told.or(known));
        let Some(holds) = self.holds.get() else {
            return;
        };
        let [angle, speed] = self.foreign.get();
        let (mut angles, mut speeds) = (holds.angle, holds.speed);
        if let Some(angle) = angle {
            angles[Dof::Little] = Some(Target::Go(Angle::nearest(angle)));
        }
        if let Some(speed) = speed {
            speeds[Dof::Little] = Some(Speed::nearest(speed));
        }
        let now = self.hand.clock.now();
        sample.angle_set = Some(Timed {
            value: angles,
            asked: now,
            received: now,
        });
        sample.speed_set = Some(Timed {
            value: speeds,
            asked: now,
            received: now,
        });
    }

    /// What the hand holds once it was told this.
    fn taken(&self, told: &Setpoints, known: Option<&Setpoints>) -> Setpoints {
        let mut taken = known.copied().unwrap_or(*told);
        for dof in Dof::ALL {
            let leave = self.begins_left_alone.get().then_some(Target::Leave);
            let known = known.and_then(|known| known.angle[dof]);
            taken.angle[dof] = told.angle[dof].or(known).or(leave);
            taken.speed[dof] = told.speed[dof].or(taken.speed[dof]);
        }
        taken
    }

    fn moves(&self, yes: bool) {
        self.hand
            .change(|status| status.rest = if yes { Rest::Moving } else { Rest::Resting });
    }

    /// Index and thumb bend as they were sent since the last call, each with its speed.
    fn sent(&self) -> Vec<[(i16, i16); 2]> {
        let asked = self.hand.asked().into_iter();
        let moves = asked.filter_map(|asked| match asked {
            Asked::Move(setpoints) => Some(setpoints),
            _ => None,
        });
        let of = |all: Setpoints| {
            [Dof::Index, Dof::ThumbBend].map(|dof| {
                assert_eq!(all.force[dof], Some(Force::nearest(400)));
                let to = all.angle[dof].map_or(-1, Target::raw);
                (to, all.speed[dof].map_or(-1, Speed::get))
            })
        };
        moves.map(of).collect()
    }

    /// On the way, with the first part of the path sent.
    async fn opened() -> Self {
        let bench = Self::start();
        bench.moves(true);
        bench.at(PerDof::splat(1000), false, 3).await;
        assert_eq!(bench.sent(), [[(810, 100), (1000, 100)]], "open first");
        bench.at(angles(120.0), false, 20).await;
        assert_eq!(bench.sent(), [[(660, 100), (1000, 100)]], "the index alone");
        bench
    }
}

fn angles(gap_mm: f32) -> PerDof<i16> {
    Gap::nearest(gap_mm).angles().map(Angle::get)
}

#[tokio::test(start_paused = true)]
async fn it_opens_then_closes_along_the_path_and_ends_at_rest() {
    let bench = Bench::opened().await;
    bench.at(angles(90.5), false, 20).await;
    let end = angles(30.0);
    let sent = bench.sent();
    let [[(index, slower), (bend, faster)]] = sent[..] else {
        panic!("{sent:?}")
    };
    assert_eq!((index, bend), (end[Dof::Index], end[Dof::ThumbBend]));
    assert_eq!((slower, faster), (50, 100), "both arrive together");
    bench.at(end, false, 100).await;
    assert!(!bench.task.is_finished(), "it moves still");
    bench.moves(false);
    bench.at(end, false, 3).await;
    let report = bench.task.await.unwrap();
    assert_eq!((report.end, report.stop), (Ok(GripEnd::Reached), None));
    assert!((report.gap.unwrap().mm - 30.0).abs() < 0.2);
    assert_eq!(bench.hand.asked(), [Asked::Disarm]);
}

#[tokio::test(start_paused = true)]
async fn what_thumb_and_index_hold_ends_it_with_its_size() {
    let bench = Bench::opened().await;
    bench.at(angles(90.5), false, 20).await;
    bench.at(angles(45.0), true, 60).await;
    bench.moves(false);
    bench.at(angles(45.0), true, 3).await;
    let report = bench.task.await.unwrap();
    assert_eq!(report.end, Ok(GripEnd::Held));
    assert!((report.gap.unwrap().mm - 45.0).abs() < 0.2);
    let asked = bench.hand.asked();
    assert_eq!(asked.last(), Some(&Asked::Disarm));
    assert!(!asked.contains(&Asked::Stop), "it goes on holding");
}

#[tokio::test(start_paused = true)]
async fn what_is_in_the_way_and_not_held_is_told_apart() {
    let bench = Bench::opened().await;
    bench.moves(false);
    bench.at(angles(100.0), false, 60).await;
    let report = bench.task.await.unwrap();
    assert_eq!(report.end, Ok(GripEnd::Stopped));
    assert!(report.stop.is_some(), "it presses nothing on");

    let bench = Bench::start();
    bench.at(PerDof::splat(400), false, 60).await;
    let report = bench.task.await.unwrap();
    assert_eq!((report.end, report.gap), (Ok(GripEnd::NotOpened), None));
    assert!(report.stop.is_some());
}

#[tokio::test(start_paused = true)]
async fn a_hand_on_the_path_does_not_open_first() {
    let bench = Bench::start();
    bench.moves(true);
    bench.at(angles(60.0), false, 3).await;
    let sent = bench.sent();
    assert_eq!(sent.len(), 1);
    assert_eq!(sent[0][0].0, angles(30.0)[Dof::Index]);
}

#[tokio::test(start_paused = true)]
async fn whatever_ends_it_nothing_is_sent_afterwards() {
    type Break = fn(&mut Bench);
    let ways: [(Break, Abort); 5] = [
        (
            |bench| bench.end.take().unwrap().send(()).unwrap(),
            Abort::Person,
        ),
        (
            |bench| bench.hand.disarm(),
            Abort::Disarmed {
                why: Some(Disarmed::Person),
            },
        ),
        (
            |bench| bench.hand.change(|status| status.state = LinkState::Fault),
            Abort::Fault { joint: None },
        ),
        (
            |bench| {
                bench
                    .hand
                    .change(|status| status.state = LinkState::Offline)
            },
            Abort::LinkLost,
        ),
        (
            |bench| {
                bench.hand.grant(Owner::Person);
            },
            Abort::TakenOver,
        ),
    ];
    for (break_off, want) in ways {
        let mut bench = Bench::opened().await;
        break_off(&mut bench);
        bench.at(angles(90.5), false, 20).await;
        let asked = bench.hand.asked();
        assert!(
            !asked.iter().any(|asked| matches!(asked, Asked::Move(_))),
            "{want:?}: {asked:?}"
        );
        let report = bench.task.await.unwrap();
        assert_eq!(report.end, Err(want));
        let is_left = want == Abort::TakenOver;
        assert_eq!(report.stop.is_none(), is_left, "{want:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_never_arrives_is_stopped_when_its_time_is_over() {
    let bench = Bench::opened().await;
    bench.at(angles(110.0), false, 800).await;
    let report = bench.task.await.unwrap();
    assert_eq!(report.end, Ok(GripEnd::Late));
    assert!(report.stop.is_some());
    assert!(bench.hand.asked().contains(&Asked::Stop));
}

#[tokio::test(start_paused = true)]
async fn what_another_writes_to_any_joint_ends_it_even_where_the_next_part_would_overwrite_it() {
    let foreign = [[Some(500), None], [None, Some(900)]];
    for write in foreign {
        // In the middle of a part, and just before the end of one; also of one that takes long.
        for (place, steps) in [(100.0, 20), (90.5, 20), (90.5, 200)] {
            let bench = Bench::opened().await;
            bench.at(angles(110.0), false, steps).await;
            bench.foreign.set(write);
            bench.at(angles(place), false, 5).await;
            let asked = bench.hand.asked();
            let moved = asked.iter().any(|asked| matches!(asked, Asked::Move(_)));
            assert!(!moved, "{write:?} {place}: {asked:?}");
            bench.foreign.set([None; 2]);
            let report = bench.task.await.unwrap();
            let by_other = matches!(report.end, Err(Abort::OtherController { wrote: Some(_) }));
            assert!(by_other, "{write:?} {place}: {:?}", report.end);
            assert!(report.stop.is_some());
        }
    }
}

#[tokio::test(start_paused = true)]
async fn one_wrong_reading_and_a_hand_that_rounds_end_nothing() {
    let bench = Bench::start();
    bench.moves(true);
    let rounds = [Some(997), Some(103)];
    bench.foreign.set(rounds);
    bench.at(PerDof::splat(1000), false, 3).await;
    bench.at(angles(120.0), false, 20).await;
    bench.at(angles(110.0), false, 20).await;
    bench.foreign.set([Some(500), Some(103)]);
    bench.at(angles(105.0), false, 1).await;
    bench.foreign.set(rounds);
    bench.at(angles(90.5), false, 20).await;
    assert_eq!(bench.sent().len(), 3, "it goes on along the path");
    assert!(!bench.task.is_finished());
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_holds_no_action_where_it_was_told_nothing_is_not_another_controller() {
    let bench = Bench::start();
    bench.begins_left_alone.set(true);
    bench.moves(true);
    // The maker's fist: the thumb turns out before the fingers open, so that each joint is left alone once.
    let fist = PerDof::new([0, 0, 0, 0, 400, 600]);
    let mut at = fist;
    let mut parts = 0;
    for _ in 0..10 {
        bench.at(at, false, 3).await;
        let holds = bench.holds.get().unwrap();
        let to = |dof: Dof| holds.angle[dof].and_then(Target::angle);
        at = PerDof::from_fn(|dof| to(dof).map_or(at[dof], Angle::get));
        bench.at(at, false, 30).await;
        let asked = bench.hand.asked().into_iter();
        parts += asked
            .filter(|asked| matches!(asked, Asked::Move(_)))
            .count();
        if at == angles(30.0) {
            break;
        }
    }
    assert!(parts >= 3, "each part was sent: {parts}");
    bench.moves(false);
    bench.at(at, false, 60).await;
    let report = bench.task.await.unwrap();
    assert_eq!(report.end, Ok(GripEnd::Reached));
}

#[tokio::test(start_paused = true)]
async fn a_disarming_for_another_controller_is_called_so() {
    let bench = Bench::opened().await;
    bench.hand.disarm_for(Disarmed::OtherController);
    bench.at(angles(90.5), false, 20).await;
    let report = bench.task.await.unwrap();
    assert_eq!(report.end, Err(Abort::OtherController { wrote: None }));
    assert!(report.stop.is_some());
}
