//! What a series sends and what ends it, on a hand that only notes what it is told.

use crate::fake::{Asked, FakeHand, Said, WELL};
use crate::hand::{Angle, ArmEpoch, Dof, Fault, Faults, Force, HandSample, PerDof, Speed, Target};
use crate::link::Stop;
use crate::link::{Owner, PollRates};
use crate::motion::drive::{Armed, Driven, EndReport};
use crate::motion::program::Progress;
use crate::motion::series::{RATES, SeriesEvent, SeriesProgram, SeriesProgress, trials};
use crate::record::{Abort, Disarmed, LinkState};
use crate::trials::plan::{Approach, Limits, TrialGrid, TrialPlan};
use crate::trials::runner::Stage;
use crate::trials::series::TrialSeries;
use futures::future::ready;
use futures::{StreamExt as _, stream};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;
use tokio::time::sleep;

const SLOW: Speed = Speed::SLOWEST_MEASURED;
const SPOKEN: Said = Said {
    limits: Some((SLOW, Force::GENTLE)),
    ..WELL
};

fn plan() -> TrialPlan {
    let index = |angle| PerDof::from_fn(|dof| (dof == Dof::Index).then_some(angle));
    TrialPlan {
        start: index(Angle::MAX),
        close: index(Angle::MIN),
        approach: Approach::OneStage,
        dwell: Duration::from_secs(1),
        grid: TrialGrid {
            speeds: vec![SLOW],
            forces: vec![Force::GENTLE],
            repeats: 1,
            rest: Duration::from_secs(1),
        },
        limits: Limits::default(),
        ..TrialPlan::default()
    }
}

/// A series that began, on a hand that said that it is well.
struct Bench {
    hand: FakeHand,
    person: Option<oneshot::Sender<Abort>>,
    steps: Arc<Mutex<Vec<SeriesProgress>>>,
    task: JoinHandle<Driven<SeriesProgram>>,
}

impl Bench {
    fn start(plan: TrialPlan) -> Self {
        let hand = FakeHand::new();
        hand.arm_as(1);
        let series = TrialSeries::start(plan, ArmEpoch(1), hand.clock.now()).unwrap();
        let armed = Armed {
            epoch: ArmEpoch(1),
            lease: hand.grant(Owner::Task),
            seen: HandSample::default(),
            clock: hand.clock,
        };
        let (person, ended) = oneshot::channel();
        let ends = stream::once(ended).filter_map(|sent| ready(sent.ok()));
        let ends = ends.chain(stream::pending());
        let steps = Arc::new(Mutex::new(Vec::new()));
        let (told, link) = (Arc::clone(&steps), hand.clone());
        let task = tokio::spawn(async move {
            let tell = |step| {
                told.lock().unwrap().push(step);
                true
            };
            trials(&link, armed, series, ends, tell).await
        });
        Self {
            hand,
            person: Some(person),
            steps,
            task,
        }
    }

    async fn running() -> Self {
        let bench = Self::start(plan());
        sleep(Duration::from_millis(1)).await;
        bench.say(SPOKEN).await;
        assert!(!bench.task.is_finished());
        bench
    }

    async fn say(&self, said: Said) {
        self.hand.says(said);
        sleep(Duration::from_millis(10)).await;
    }

    fn stage(&self) -> Stage {
        let steps = self.steps.lock().unwrap();
        let mut views = steps.iter().rev().filter_map(|step| match step {
            Progress::View(view) => Some(view.stage),
            _ => None,
        });
        views.next().unwrap()
    }

    fn trials(&self) -> usize {
        let steps = self.steps.lock().unwrap();
        let trials = steps
            .iter()
            .filter(|step| matches!(step, Progress::Event(SeriesEvent::Trial(_))));
        trials.count()
    }

    async fn end(self) -> EndReport {
        self.task.await.unwrap().report()
    }
}

fn is_move(asked: &Asked) -> bool {
    matches!(asked, Asked::Move(_))
}

#[tokio::test(start_paused = true)]
async fn a_plan_that_makes_no_sense_sends_nothing() {
    let mut senseless = plan();
    senseless.grid.speeds = vec![Speed::MIN];
    // There is no series then that a task could be given.
    let hand = FakeHand::new();
    hand.arm_as(1);
    TrialSeries::start(senseless, ArmEpoch(1), hand.clock.now()).unwrap_err();
    assert_eq!(hand.asked(), []);
}

#[tokio::test(start_paused = true)]
async fn the_orders_of_a_trial_go_over_the_link_and_closing_comes_last() {
    let bench = Bench::running().await;
    for _ in 0..100 {
        bench.say(SPOKEN).await;
    }
    assert_eq!(bench.stage(), Stage::Closing);
    let asked = bench.hand.asked();
    let sets: Vec<_> = asked
        .iter()
        .filter(|asked| **asked != Asked::ReadAt(RATES))
        .map(|asked| match asked {
            Asked::Move(set) => (
                set.speed[Dof::Index],
                set.angle[Dof::Index].map(Target::raw),
            ),
            other => panic!("{other:?}"),
        })
        .collect();
    let wanted = [
        (Some(Speed::GENTLE), Some(1000)),
        (Some(SLOW), None),
        (None, Some(0)),
    ];
    assert_eq!(sets, wanted);
}

#[tokio::test(start_paused = true)]
async fn the_hand_is_read_at_full_rate_exactly_while_a_series_runs() {
    let bench = Bench::running().await;
    let hand = bench.hand.clone();
    let rates = |asked: Vec<Asked>| -> Vec<Asked> {
        let rates = asked.into_iter();
        rates
            .filter(|one| matches!(one, Asked::ReadAt(_)))
            .collect()
    };
    bench.say(SPOKEN).await;
    assert_eq!(rates(hand.asked()), [Asked::ReadAt(RATES)], "told once");
    bench
        .say(Said {
            faults: 1,
            ..SPOKEN
        })
        .await;
    bench.end().await;
    assert_eq!(rates(hand.asked()), [Asked::ReadAt(PollRates::default())]);
}

#[tokio::test(start_paused = true)]
async fn a_stop_goes_out_first_and_ends_it_by_a_person() {
    let mut bench = Bench::running().await;
    let hand = bench.hand.clone();
    hand.asked();
    // A reading that waits is not looked at any more.
    hand.says(Said {
        faults: 1,
        ..SPOKEN
    });
    bench.person.take().unwrap().send(Abort::Person).unwrap();
    sleep(Duration::from_millis(10)).await;
    assert_eq!(bench.trials(), 1, "what was read is kept");
    let end = bench.end().await;
    assert_eq!(end.aborted, Some(Abort::Person));
    assert!(matches!(end.stop, Some(Stop::Confirmed { .. })));
    let default = Asked::ReadAt(PollRates::default());
    assert_eq!(hand.asked(), [Asked::Stop, default]);
}

#[tokio::test(start_paused = true)]
async fn what_is_wrong_stops_the_hand_and_is_said() {
    let fault = Faults::from_raw(1);
    let dof = Dof::Little;
    for (said, why) in [
        (
            Said {
                faults: 1,
                ..SPOKEN
            },
            Abort::Fault {
                joint: Some((dof, fault)),
            },
        ),
        (
            Said {
                celsius: 61,
                ..SPOKEN
            },
            Abort::Heat {
                dof: Dof::ThumbRotate,
                celsius: 61,
                limit: 60,
            },
        ),
        (
            Said {
                grams: 2100,
                ..SPOKEN
            },
            Abort::Ceiling {
                dof,
                grams: 2100,
                ceiling: 2000,
            },
        ),
    ] {
        let bench = Bench::running().await;
        let hand = bench.hand.clone();
        bench.say(said).await;
        assert_eq!(bench.end().await.aborted, Some(why));
        let asked = hand.asked();
        let stop = asked.iter().position(|one| *one == Asked::Stop).unwrap();
        assert!(!asked[stop..].iter().any(is_move), "{why:?}");
    }
    assert!(fault.iter().eq([Fault::Stall]), "the bit of this test");
}

#[tokio::test(start_paused = true)]
async fn a_peak_between_two_readings_is_seen() {
    let bench = Bench::running().await;
    bench.hand.says(Said {
        grams: 2500,
        ..SPOKEN
    });
    bench.hand.says(SPOKEN);
    let end = bench.end().await;
    assert!(matches!(end.aborted, Some(Abort::Ceiling { .. })));
}

#[tokio::test(start_paused = true)]
async fn a_lost_link_and_another_arming_end_it() {
    type Break = fn(&FakeHand);
    let ways: [(Break, Abort, Option<Stop>); 3] = [
        (
            |hand| hand.change(|status| status.state = LinkState::Offline),
            Abort::LinkLost,
            Some(Stop::LinkLost),
        ),
        (|hand| hand.arm_as(2), Abort::ArmedAnew, None),
        (
            |hand| hand.disarm(),
            Abort::Disarmed {
                why: Some(Disarmed::Person),
            },
            None,
        ),
    ];
    for (break_off, why, stop) in ways {
        let bench = Bench::running().await;
        let hand = bench.hand.clone();
        break_off(&hand);
        let end = bench.end().await;
        assert_eq!(end.aborted, Some(why));
        assert!(hand.asked().contains(&Asked::Stop), "{why:?}");
        match stop {
            Some(stop) => assert_eq!(end.stop, Some(stop)),
            None => assert!(matches!(end.stop, Some(Stop::Confirmed { .. }))),
        }
        assert_eq!(hand.status().armed, None);
    }
}

#[tokio::test(start_paused = true)]
async fn readings_that_stay_away_end_it() {
    let bench = Bench::running().await;
    let end = bench.end().await;
    assert!(matches!(end.aborted, Some(Abort::NotRead { .. })));
}

#[tokio::test(start_paused = true)]
async fn setpoints_of_a_series_do_not_pass_once_another_took_the_turn() {
    let bench = Bench::running().await;
    bench.hand.asked();
    let _another = bench.hand.grant(Owner::Person);
    for _ in 0..100 {
        bench.say(SPOKEN).await;
    }
    assert_eq!(bench.hand.asked(), [Asked::ReadAt(PollRates::default())]);
    assert_eq!(bench.end().await.aborted, Some(Abort::TakenOver));
}
