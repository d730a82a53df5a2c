//! Grasp trials on the simulated hand through the whole link, in virtual time: the published overshoot and its cure, and
//! what ends a series.

use crate::setup::hand;
use crate::setup::link::{self, Client};
use futures::stream::pending;
use handscope::hand::register::GESTURE_FORCE_CLB;
use handscope::hand::{Angle, Dof, Fault, Force, HandSample, PerDof, Speed};
use handscope::link::{ArmRequest, Clock, LinkConfig};
use handscope::motion::drive::{Armed, EndReport};
use handscope::motion::program::Progress;
use handscope::motion::series::{self, RATES, SeriesEvent, SeriesProgress};
use handscope::record::Abort;
use handscope::record::{Disarmed, Hold, LinkState, Record};
use handscope::sim::{BodyParams, Personality, Scenario, SharedHand, SimConfig, SimHand};
use handscope::trials::best::{best, scores};
use handscope::trials::{
    Approach, Criterion, EarlyEnd, Limits, Trial, TrialEvent, TrialGrid, TrialKind, TrialPlan,
    TrialSeries, Until,
};
use std::cell::Cell;
use tokio::time::{Duration, Instant, timeout};

/// As a real hand on RS485 answers: 6 to 15 ms (see the table's source).
const TURNAROUND: Duration = Duration::from_millis(6);
/// From GESTURE_FORCE_CLB to the new zero, and a little more.
const CALIBRATES_WITHIN: Duration = Duration::from_secs(7);

/// A hand, a link to it, and the trial's view of both.
struct Bench {
    hand: SharedHand,
    link: Client,
    clock: Clock,
    sample: HandSample,
}

impl Bench {
    async fn new(scenario: Scenario) -> Self {
        Self::with(scenario, BodyParams::default()).await
    }

    /// The published block, and sensors that read the load alone: the drive compares what they read, and between two cells of the
    /// table 1 g of threshold is up to 20 g of overshoot.
    async fn of_the_table() -> Self {
        let mut body = BodyParams::default();
        for (_, joint) in body.joints.iter_mut() {
            joint.force_noise_g = 0.0;
        }
        let mut bench = Self::with(Scenario::Rigid, body).await;
        let calibrate = &GESTURE_FORCE_CLB;
        let written = |hand: &mut SimHand, now| hand.write(calibrate.address, &[1], now);
        bench.hand.with(written).unwrap();
        let until = bench.clock.now().plus(CALIBRATES_WITHIN);
        while bench.clock.now() < until {
            bench.next().await;
        }
        bench
    }

    async fn with(scenario: Scenario, body: BodyParams) -> Self {
        let config = SimConfig {
            scenario,
            body,
            personality: Personality {
                turnaround: TURNAROUND,
                ..Personality::default()
            },
            ..SimConfig::default()
        };
        let hand = hand::shared(config);
        let config = LinkConfig {
            rates: RATES,
            ..link::config("rs485:test", link::to_hand(hand.clone()))
        };
        let clock = config.clock;
        let mut bench = Self {
            link: link::open(config),
            hand,
            clock,
            sample: HandSample::default(),
        };
        let known =
            |bench: &Self| bench.sample.faults.is_some() && bench.sample.temperature.is_some();
        while !known(&bench) {
            bench.next().await;
        }
        bench
    }

    async fn arm(&mut self) {
        self.link.arm(ArmRequest {
            speed: PerDof::splat(Speed::GENTLE),
            force: PerDof::splat(Force::nearest(100)),
        });
        while self.link.status().state != LinkState::Armed {
            self.next().await;
        }
    }

    /// Takes the next event, or 10 ms.
    async fn next(&mut self) {
        let event = timeout(Duration::from_millis(10), self.link.records.next()).await;
        if let Ok(Some(Record::Reading { sample, .. })) = event {
            self.sample = *sample;
        }
    }

    /// Arms and runs a series to its end. `meanwhile` may interfere, and is told the number of the trial.
    async fn run(&mut self, plan: TrialPlan, mut meanwhile: impl FnMut(&Self, usize)) -> Run {
        self.arm().await;
        let epoch = self.link.status().armed.unwrap();
        let series = TrialSeries::start(plan, epoch, self.clock.now()).unwrap();
        let armed = Armed {
            epoch,
            lease: self.link.lease(),
            seen: self.sample,
            clock: self.clock,
        };
        let (mut trials, number) = (Vec::new(), Cell::new(0));
        let report = |progress: SeriesProgress| {
            match progress {
                Progress::View(view) => number.set(view.number),
                Progress::Event(SeriesEvent::Trial(trial)) => trials.push(*trial),
                Progress::Event(SeriesEvent::Search(_)) | Progress::Sent(_) => {}
            }
            true
        };
        let interferes = async {
            loop {
                if self.link.status().armed.is_some() {
                    meanwhile(self, number.get());
                }
                tokio::time::sleep(Duration::from_millis(2)).await;
            }
        };
        let driven = tokio::select! {
            driven = series::trials(&self.link, armed, series, pending(), report) => driven,
            () = interferes => unreachable!("it has no end"),
        };
        let EndReport { aborted, stop } = driven.report();
        Run {
            trials,
            aborted,
            stopped: stop.is_some(),
        }
    }
}

#[derive(Debug)]
struct Run {
    trials: Vec<Trial>,
    aborted: Option<Abort>,
    stopped: bool,
}

/// The index finger onto what stands at 500, from near enough not to make the slow trials long.
fn plan(speeds: &[i16], forces: &[i16]) -> TrialPlan {
    let mut plan = TrialPlan {
        start: PerDof::splat(None),
        close: PerDof::splat(None),
        approach: Approach::OneStage,
        dwell: Duration::from_millis(1500),
        grid: TrialGrid {
            speeds: speeds.iter().map(|speed| Speed::nearest(*speed)).collect(),
            forces: forces.iter().map(|force| Force::nearest(*force)).collect(),
            repeats: 1,
            rest: Duration::from_millis(500),
        },
        limits: Limits {
            ceiling_g: 4000,
            ..Limits::default()
        },
        ..TrialPlan::default()
    };
    plan.start[Dof::Index] = Some(Angle::nearest(640));
    plan.close[Dof::Index] = Some(Angle::nearest(300));
    plan
}

fn fast_until(mut plan: TrialPlan, until: Until) -> TrialPlan {
    plan.approach = Approach::TwoStage {
        fast: Speed::MAX,
        until,
    };
    plan
}

const THRESHOLDS: [i16; 5] = [100, 250, 500, 750, 1000];
/// Median peak above the threshold, g: one real hand of the family, index finger, rigid block.
const TABLE: [(i16, [f64; 5]); 3] = [
    (25, [7.0, 29.0, 64.0, 73.0, 69.0]),
    (250, [36.0, 336.0, 637.0, 1108.0, 1640.0]),
    (1000, [36.0, 3263.0, 2917.0, 2865.0, 2502.0]),
];
const TWO_STAGE: [f64; 5] = [2.0, 25.0, 39.0, 71.0, 92.0];

/// Within 15 %, or 5 g where that is more: the force sensor reads in whole grams, at rest as at the peak. (The drive itself is within
/// 15 % in every cell: `tests/it/sim/drive.rs`.)
#[track_caller]
fn like_the_table(what: &str, trial: &Trial, wanted: f64) {
    let joint = &trial.summary.joints[0];
    let over = joint.overshoot_g.expect(what);
    println!("{what}: {over:.1} g, published {wanted} g");
    assert!(
        (over - wanted).abs() <= (0.15 * wanted).max(5.0),
        "{what}: {over} g, published {wanted}"
    );
    // 64 +- 8 ms were measured from the command on the wire; to it come one transaction and a reading's time.
    let dead = joint.dead_time_s.expect(what);
    assert!((0.056..=0.092).contains(&dead), "{what}: dead time {dead}");
    assert_eq!(joint.end_status.as_deref(), Some("force_reached"), "{what}");
    assert_eq!(joint.clipped, Some(false), "{what}");
    let steady = joint.steady_force_g.expect(what);
    let peak = joint.peak_force_g.expect(what);
    assert!(steady < peak && steady > 0.8 * f64::from(trial.summary.setting.force.get()));
}

#[tokio::test(start_paused = true)]
async fn every_cell_of_the_impact_table_comes_out_of_trials_over_the_link() {
    let mut bench = Bench::of_the_table().await;
    let speeds = TABLE.map(|(speed, _)| speed);
    let run = bench.run(plan(&speeds, &THRESHOLDS), |_, _| ()).await;
    assert_eq!(run.aborted, None);
    assert!(!run.stopped);
    assert_eq!(run.trials.len(), 15);
    let wanted = TABLE.iter().flat_map(|(speed, peaks)| {
        let cells = THRESHOLDS.into_iter().zip(peaks);
        cells.map(move |(force, peak)| (*speed, force, *peak))
    });
    for (trial, (speed, force, peak)) in run.trials.iter().zip(wanted) {
        let setting = trial.summary.setting;
        assert_eq!((setting.speed.get(), setting.force.get()), (speed, force));
        like_the_table(&format!("speed {speed} at {force} g"), trial, peak);
    }
}

#[tokio::test(start_paused = true)]
async fn a_fast_approach_with_a_slow_contact_is_the_cure_however_its_end_is_known() {
    let angle = Until::Angle(Angle::nearest(520));
    for (until, first) in [(angle, 0), (Until::Measured { margin: 20 }, 1)] {
        let mut bench = Bench::of_the_table().await;
        let plan = fast_until(plan(&[25], &THRESHOLDS), until);
        let run = bench.run(plan, |_, _| ()).await;
        assert_eq!(run.aborted, None, "{until:?}");
        assert_eq!(run.trials.len(), 5 + first);
        assert_eq!(run.trials[0].summary.kind == TrialKind::Probe, first == 1);
        for ((trial, force), peak) in run.trials[first..].iter().zip(THRESHOLDS).zip(TWO_STAGE) {
            like_the_table(&format!("{until:?} at {force} g"), trial, peak);
            let slow = trial.recording.when(TrialEvent::Slow(Dof::Index));
            assert!(slow.is_some(), "{until:?}");
        }
    }
    // A block gives no warning by touch, and proximity tells of it early enough.
    let mut bench = Bench::of_the_table().await;
    let mut plan = fast_until(plan(&[25], &[500]), Until::Proximity(8000));
    plan.start[Dof::Index] = Some(Angle::MAX);
    let run = bench.run(plan, |_, _| ()).await;
    like_the_table("by proximity", &run.trials[0], 39.0);
}

#[tokio::test(start_paused = true)]
async fn a_setting_is_found_that_holds_a_fragile_cup_with_little_overshoot() {
    let mut bench = Bench::new(Scenario::Fragile).await;
    let run = bench
        .run(plan(&[25, 250, 1000], &[200, 400]), |_, _| ())
        .await;
    assert_eq!(run.aborted, None);
    let scores = scores(run.trials.iter().map(|trial| &trial.summary));
    let found = best(&scores, Criterion::LeastOvershoot { steady_g: 300.0 }).unwrap();
    assert_eq!(
        (found.setting.speed.get(), found.setting.force.get()),
        (25, 400)
    );
    assert!(found.overshoot_g.unwrap().max < 100.0, "{found:?}");
    let broken = &run.trials.last().unwrap().summary.joints[0];
    assert!(
        broken.steady_force_g.is_none_or(|grams| grams < 20.0),
        "{broken:?}"
    );
}

/// Runs until something ends it, and checks that a stop followed and the hand rests.
async fn ended_by(
    plan: TrialPlan,
    scenario: Scenario,
    meanwhile: impl FnMut(&Bench, usize),
) -> Abort {
    let mut bench = Bench::new(scenario).await;
    let run = bench.run(plan, meanwhile).await;
    assert!(run.stopped);
    let last = run.trials.last().expect("what was read is kept");
    assert_eq!(last.summary.aborted, run.aborted.map(EarlyEnd::Here));
    assert!(last.recording.when(TrialEvent::Aborted).is_some());
    let hold = bench.link.status().hold;
    assert!(matches!(hold, Hold::Confirmed { .. }), "{hold:?}");
    assert_eq!(bench.link.status().armed, None, "nothing arms it again");
    let index = || bench.hand.with(|hand, _| hand.true_angles()[Dof::Index]);
    let rest = index();
    tokio::time::sleep(Duration::from_secs(1)).await;
    // It closes no further and does not open by itself; a grip may relax.
    let moved = index() - rest;
    assert!((-2.0..=20.0).contains(&moved), "{moved} {:?}", run.aborted);
    run.aborted.unwrap()
}

fn closing(number: usize, bench: &Bench) -> bool {
    let angle = bench.hand.with(|hand, _| hand.true_angles()[Dof::Index]);
    number == 1 && angle < 620.0
}

#[tokio::test(start_paused = true)]
async fn a_stop_a_fault_heat_and_force_end_the_series_with_a_stop() {
    let slow = || plan(&[25], &[500, 750]);
    let why = ended_by(slow(), Scenario::Rigid, |bench, number| {
        if closing(number, bench) {
            bench.link.stop();
        }
    });
    let why_disarmed = Some(Disarmed::Stop);
    assert_eq!(why.await, Abort::Disarmed { why: why_disarmed });
    let why = ended_by(slow(), Scenario::Rigid, |bench, number| {
        if closing(number, bench) {
            bench
                .hand
                .with(|hand, _| hand.inject_fault(Dof::Ring, Fault::Motor));
        }
    });
    let why = why.await;
    assert!(
        matches!(
            why,
            Abort::Fault {
                joint: Some((Dof::Ring, _))
            }
        ),
        "{why}"
    );
    let why = ended_by(slow(), Scenario::Rigid, |bench, number| {
        if closing(number, bench) {
            bench.hand.with(|hand, _| hand.warm(Dof::ThumbBend, 61.0));
        }
    });
    let why = why.await;
    assert!(
        matches!(
            why,
            Abort::Heat {
                dof: Dof::ThumbBend,
                ..
            }
        ),
        "{why}"
    );
    let mut low = plan(&[1000], &[250]);
    low.limits.ceiling_g = 300;
    let why = ended_by(low, Scenario::Rigid, |_, _| ()).await;
    assert!(
        matches!(
            why,
            Abort::Ceiling {
                dof: Dof::Index,
                ..
            }
        ),
        "{why}"
    );
}

#[tokio::test(start_paused = true)]
async fn a_jammed_joint_on_its_way_back_ends_the_series() {
    let mut plan = plan(&[250], &[500]);
    // It is to begin further bent than its linkage lets it.
    plan.start[Dof::Middle] = Some(Angle::nearest(100));
    let mut bench = Bench::new(Scenario::Rigid).await;
    bench
        .hand
        .with(|hand, _| hand.set_jam(Dof::Middle, Some(800.0)));
    let run = bench.run(plan, |_, _| ()).await;
    assert!(run.stopped && run.trials.len() == 1);
    let closed = run.trials[0].recording.when(TrialEvent::Close);
    assert_eq!(closed, None, "nothing closed");
}

#[tokio::test(start_paused = true)]
async fn the_next_trial_waits_until_the_hand_is_cool() {
    let mut bench = Bench::new(Scenario::Rigid).await;
    bench.hand.with(|hand, _| hand.warm(Dof::Index, 55.0));
    for _ in 0..50 {
        bench.next().await;
    }
    // The rest alone would be over at once; from 55 °C to 50 takes some seconds.
    let begun = Instant::now();
    let run = bench.run(plan(&[1000], &[100]), |_, _| ()).await;
    assert_eq!(run.aborted, None);
    assert!(
        begun.elapsed() > Duration::from_secs(8),
        "{:?}",
        begun.elapsed()
    );
}

#[tokio::test(start_paused = true)]
async fn one_trial_records_from_before_the_command_to_after_the_release() {
    let mut bench = Bench::new(Scenario::Rigid).await;
    let run = bench.run(plan(&[250], &[500]), |_, _| ()).await;
    let recording = &run.trials[0].recording;
    let what: Vec<String> = recording
        .marks()
        .iter()
        .map(|mark| mark.what.name())
        .collect();
    assert_eq!(
        what,
        [
            "prepare", "limits", "close", "stopped", "release", "released"
        ]
    );
    let (first, last) = (
        recording.rows().first().unwrap(),
        recording.rows().last().unwrap(),
    );
    let close = recording.when(TrialEvent::Close).unwrap();
    let released = recording.when(TrialEvent::Released).unwrap();
    assert!(close.since(first.at) > Duration::from_millis(450));
    assert!(last.at.since(released) > Duration::from_millis(250));
    assert!(run.trials[0].summary.joints[0].rate_hz.unwrap() > 60.0);
    assert_eq!(recording.lost(), 0);
}

#[tokio::test(start_paused = true)]
async fn a_joint_that_never_moves_is_a_dead_drive_and_one_that_moves_is_none() {
    for dead in [true, false] {
        let mut bench = Bench::new(Scenario::Free).await;
        let mut plan = plan(&[250], &[500]);
        plan.start[Dof::Index] = Some(Angle::MAX);
        bench.hand.with(|hand, _| hand.set_dead(Dof::Index, dead));
        let run = bench.run(plan, |_, _| ()).await;
        assert_eq!(run.aborted, None);
        let joint = &run.trials[0].summary.joints[0];
        let end = joint.end_status.as_deref();
        let wanted = if dead {
            "dead_drive"
        } else {
            "position_reached"
        };
        assert_eq!((joint.dead_drive, end), (dead, Some(wanted)));
        assert_eq!(joint.time_to_stop_s.is_none(), dead);
    }
}
