//! A series against a hand that is only numbers: what is sent when, and what ends it. No link and no simulated hand.

use crate::hand::{
    Angle, AngleReading, Dof, Faults, Force, ForceReading, Group, Groups, HandSample, Moment,
    PerDof, Speed, Status, Target, TemperatureReading, Timed,
};
use crate::hand::{ArmEpoch, Setpoints};
use crate::record::{Abort, Disarmed};
use crate::trials::best::scores;
use crate::trials::limits::TaskStall;
use crate::trials::plan::{Approach, Limits, TrialGrid, TrialPlan, TrialSetting, Until};
use crate::trials::recording::{TrialEvent, seconds};
use crate::trials::series::TrialSeries;
use crate::trials::summary::{Trial, TrialKind};
use std::time::Duration;

const EPOCH: ArmEpoch = ArmEpoch(3);
const STEP: Duration = Duration::from_millis(10);

/// Angles that follow their targets at 500 a second, and readings that can be spoilt.
#[derive(Debug, Clone)]
struct Hand {
    now: Moment,
    angle: PerDof<i16>,
    target: PerDof<i16>,
    speed: PerDof<Option<Speed>>,
    force: PerDof<Option<Force>>,
    grams: i16,
    celsius: u8,
    /// The force was last read then.
    force_at: Option<Moment>,
    takes_limits: bool,
    /// The force is not read.
    hides_force: bool,
    /// How far before its target a closing joint comes to rest, as one with backlash does.
    rests_short: i16,
    /// Where something is in the way.
    blocked_at: i16,
    stall: Option<TaskStall>,
}

impl Hand {
    fn new() -> Self {
        Self {
            now: Moment::from_micros(1_000_000),
            angle: PerDof::splat(700),
            target: PerDof::splat(700),
            speed: PerDof::splat(None),
            force: PerDof::splat(None),
            grams: -7,
            celsius: 31,
            force_at: None,
            takes_limits: true,
            hides_force: false,
            rests_short: 0,
            blocked_at: -1,
            stall: None,
        }
    }

    fn apply(&mut self, setpoints: &Setpoints) {
        for dof in Dof::ALL {
            if let Some(Target::Go(angle)) = setpoints.angle[dof] {
                self.target[dof] = angle.get();
            }
            if self.takes_limits {
                self.speed[dof] = setpoints.speed[dof].or(self.speed[dof]);
                self.force[dof] = setpoints.force[dof].or(self.force[dof]);
            }
        }
    }

    fn step(&mut self) {
        self.now = self.now.plus(STEP);
        for dof in Dof::ALL {
            self.angle[dof] += self.way(dof).clamp(-5, 5);
        }
    }

    fn way(&self, dof: Dof) -> i16 {
        let way = self.target[dof] - self.angle[dof];
        if way >= 0 {
            return way;
        }
        let free = self.angle[dof] - self.blocked_at;
        (way + self.rests_short).max(-free.max(0)).min(0)
    }

    fn sample(&self) -> HandSample {
        fn timed<T>(value: T, at: Moment) -> Option<Timed<T>> {
            Some(Timed {
                value,
                asked: at,
                received: at,
            })
        }
        let now = self.now;
        let status = |dof: Dof| match self.way(dof) {
            0 => Status::PositionReached,
            way if way < 0 => Status::Grasping,
            _ => Status::Releasing,
        };
        HandSample {
            angle: timed(self.angle.map(AngleReading::new), now),
            force: timed(
                PerDof::splat(ForceReading::new(self.grams)),
                self.force_at.unwrap_or(now),
            ),
            faults: timed(PerDof::splat(Faults::default()), now),
            status: timed(PerDof::from_fn(status), now),
            temperature: timed(PerDof::splat(TemperatureReading::new(self.celsius)), now),
            speed_set: timed(self.speed, now),
            force_set: timed(self.force, now),
            ..HandSample::default()
        }
    }
}

fn plan(speed: i16, repeats: usize) -> TrialPlan {
    let mut plan = TrialPlan {
        start: PerDof::splat(None),
        close: PerDof::splat(None),
        approach: Approach::OneStage,
        dwell: Duration::from_millis(600),
        grid: TrialGrid {
            repeats,
            rest: Duration::from_secs(2),
            ..TrialGrid::once(TrialSetting {
                speed: Speed::nearest(speed),
                force: Force::nearest(400),
            })
        },
        limits: Limits::default(),
        ..TrialPlan::default()
    };
    plan.start[Dof::Index] = Some(Angle::MAX);
    plan.close[Dof::Index] = Some(Angle::nearest(200));
    plan
}

/// What was sent, with its time, and how it went.
struct Ran {
    sent: Vec<(Moment, Setpoints)>,
    trials: Vec<Trial>,
    aborted: Option<Abort>,
}

/// Runs for at most two minutes. `meanwhile` spoils the hand; it is told how far the index finger is.
fn run(plan: TrialPlan, mut meanwhile: impl FnMut(&mut Hand)) -> Ran {
    let mut hand = Hand::new();
    let fresh = Groups::from_iter([
        Group::Angle,
        Group::Force,
        Group::Status,
        Group::Temperature,
    ]);
    let without_force = Groups::from_iter([Group::Angle, Group::Status, Group::Temperature]);
    let mut series = TrialSeries::start(plan, EPOCH, hand.now).unwrap();
    let mut sent = Vec::new();
    for _ in 0..12_000 {
        hand.step();
        meanwhile(&mut hand);
        let sample = hand.sample();
        let fresh = if hand.hides_force {
            without_force
        } else {
            fresh
        };
        series.read(&sample, fresh);
        if let Some(setpoints) = series.tick(&sample, hand.stall, hand.now) {
            assert_eq!(series.aborted(), None, "nothing is sent after its end");
            sent.push((hand.now, setpoints));
            assert_eq!(setpoints.epoch, EPOCH);
            hand.apply(&setpoints);
        }
    }
    assert!(series.is_over());
    let trials = std::iter::from_fn(|| series.finished()).collect();
    Ran {
        sent,
        trials,
        aborted: series.aborted(),
    }
}

/// Ends by this reason.
fn check(why: Abort, plan: TrialPlan, meanwhile: impl FnMut(&mut Hand)) {
    let ran = run(plan, meanwhile);
    assert_eq!(ran.aborted, Some(why));
}

#[test]
fn each_trial_opens_sets_the_limits_closes_by_angle_alone_and_opens() {
    let ran = run(plan(250, 2), |_| ());
    assert_eq!(ran.aborted, None);
    assert_eq!(ran.sent.len(), 8);
    let one: Vec<Setpoints> = ran.sent[..4]
        .iter()
        .map(|(_, setpoints)| *setpoints)
        .collect();
    let index = |n: usize| {
        let set = one[n];
        (
            set.speed[Dof::Index].map(Speed::get),
            set.force[Dof::Index].map(Force::get),
            set.angle[Dof::Index].map(|target: Target| target.raw()),
        )
    };
    assert_eq!(index(0), (Some(200), Some(400), Some(1000)));
    assert_eq!(index(1), (Some(250), Some(400), None));
    assert_eq!(index(2), (None, None, Some(200)));
    assert_eq!(index(3), (Some(200), Some(400), Some(1000)));
    for set in &one {
        let others = Dof::ALL.into_iter().filter(|dof| *dof != Dof::Index);
        for dof in others {
            assert!(
                set.angle[dof].is_none() && set.speed[dof].is_none() && set.force[dof].is_none()
            );
        }
    }
    let dwelt = ran.sent[3].0.since(ran.sent[2].0);
    // 800 at 500 a second, the stillness of 200 ms, the dwell of 600.
    assert!((2300..2600).contains(&dwelt.as_millis()), "{dwelt:?}");
    // The way back, its stillness, what is recorded after, the rest.
    let rested = ran.sent[4].0.since(ran.sent[3].0);
    assert!((3900..4500).contains(&rested.as_millis()), "{rested:?}");
    let summaries = ran.trials.iter().map(|trial| &trial.summary);
    let kinds: Vec<(TrialKind, Option<usize>)> =
        summaries.map(|own| (own.kind, own.repeat)).collect();
    assert_eq!(
        kinds,
        [(TrialKind::Trial, Some(1)), (TrialKind::Trial, Some(2))]
    );
}

fn closing(hand: &Hand) -> bool {
    hand.target[Dof::Index] == 200 && hand.angle[Dof::Index] < 900
}

#[test]
fn what_cannot_be_watched_ends_it() {
    let dof = Dof::Little;
    let what = "force";
    let age = Some(Duration::from_millis(610));
    let stall = None;
    check(Abort::NotRead { what, age, stall }, plan(250, 2), |hand| {
        if closing(hand) && hand.force_at.is_none() {
            hand.force_at = Some(hand.now);
        }
    });
    check(Abort::Blind { what, dof }, plan(250, 2), |hand| {
        if closing(hand) {
            hand.grams = 5000;
        }
    });
    let what = "temperature";
    check(Abort::Blind { what, dof }, plan(250, 2), |hand| {
        if closing(hand) {
            hand.celsius = 255;
        }
    });
}

#[test]
fn readings_are_awaited_after_a_stall_of_this_program_and_a_stall_is_named_as_the_cause() {
    // Nothing is read for 0.8 s, because the program does not run; the hand is read on 0.1 s after it, or not at all.
    let stalled = |is_read_again: bool| {
        let mut begun = None;
        run(plan(250, 2), move |hand| {
            let now = hand.now;
            if closing(hand) && begun.is_none() {
                begun = Some(now);
                hand.now = now.plus(Duration::from_millis(800));
                hand.force_at = Some(now);
                hand.stall = Some(TaskStall {
                    lasted: Duration::from_millis(800),
                    ended: hand.now,
                });
            }
            let since = begun.map_or(Duration::ZERO, |begun| now.since(begun));
            if is_read_again && since >= Duration::from_millis(900) {
                hand.force_at = None;
            }
        })
    };
    assert_eq!(stalled(true).aborted, None);
    let why = stalled(false).aborted.unwrap();
    let Abort::NotRead { what, age, stall } = why else {
        panic!("{why}");
    };
    assert_eq!((what, stall), ("force", Some(Duration::from_millis(800))));
    assert!(age > Some(Duration::from_millis(940)), "{age:?}");
    let words = why.to_string();
    assert!(words.contains("this computer was busy"), "{words}");
    assert!(words.contains("did not run for 0.8 s"), "{words}");
}

#[test]
fn the_longest_stall_of_a_trial_is_kept_with_it() {
    let mut hand = Hand::new();
    let mut series = TrialSeries::start(plan(250, 2), EPOCH, hand.now).unwrap();
    let mut stalls = vec![80, 300, 60];
    while !series.is_over() {
        hand.step();
        if closing(&hand)
            && series.view().number == 1
            && let Some(ms) = stalls.pop()
        {
            series.stalled(TaskStall {
                lasted: Duration::from_millis(ms),
                ended: hand.now,
            });
        }
        if let Some(set) = series.tick(&hand.sample(), hand.stall, hand.now) {
            hand.apply(&set);
        }
    }
    let stalls = std::iter::from_fn(|| series.finished()).map(|trial| trial.summary.stall_s);
    assert_eq!(stalls.collect::<Vec<_>>(), [Some(0.3), None]);
}

#[test]
fn every_early_end_names_its_cause() {
    let age = Some(Duration::from_millis(710));
    for (why, words) in [
        (
            Abort::Disarmed {
                why: Some(Disarmed::Stale),
            },
            "the hand is no longer armed: feedback became stale",
        ),
        (Abort::ArmedAnew, "the hand was rearmed"),
        (
            Abort::NotRead {
                what: "angle",
                age,
                stall: None,
            },
            "the last is 0.7 s old, and the hand sent no newer one in time",
        ),
        (
            Abort::NotRead {
                what: "angle",
                age: None,
                stall: None,
            },
            "none received yet",
        ),
    ] {
        let said = why.to_string();
        assert!(said.contains(words), "{said}");
    }
}

/// Readings at the peak of the first so many trials are missing.
fn with_gaps(plan: TrialPlan, gaps: usize) -> Ran {
    let mut count = 0;
    let mut was_closing = false;
    run(plan, move |hand| {
        let is_closing = hand.target[Dof::Index] == 200;
        if is_closing && !was_closing {
            count += 1;
        }
        was_closing = is_closing;
        let at = hand.angle[Dof::Index];
        hand.blocked_at = 400;
        // 20 g for each count from 500 on.
        hand.grams = -7 + 5 * (500 - at).max(0);
        let is_gap = is_closing && count <= gaps && (401..480).contains(&at);
        if !is_gap {
            hand.force_at = None;
        } else if hand.force_at.is_none() {
            hand.force_at = Some(hand.now);
        }
        hand.hides_force = is_gap;
    })
}

#[test]
fn a_trial_without_readings_at_its_peak_is_repeated_and_does_not_count() {
    let kinds = |ran: &Ran| -> Vec<(Option<usize>, bool)> {
        let trials = ran.trials.iter().map(|trial| &trial.summary);
        trials.map(|own| (own.repeat, own.repeated)).collect()
    };
    let whole = with_gaps(plan(250, 2), 0);
    assert_eq!(kinds(&whole), [(Some(1), false), (Some(2), false)]);
    let once = with_gaps(plan(250, 2), 1);
    assert_eq!(
        kinds(&once),
        [(Some(1), true), (Some(1), false), (Some(2), false)]
    );
    let scores = scores(once.trials.iter().map(|trial| &trial.summary));
    assert_eq!(scores[0].trials, 2);
    // What is always so is not repeated for ever: it counts, and is marked.
    let always = with_gaps(plan(250, 1), usize::MAX);
    assert_eq!(
        kinds(&always),
        [
            (Some(1), true),
            (Some(1), true),
            (Some(1), true),
            (Some(1), false)
        ]
    );
    assert!(always.trials[3].summary.has_gap());
}

#[test]
fn no_finger_closes_before_the_hand_shows_the_limits() {
    let dof = Dof::Index;
    let ran = run(plan(250, 2), |hand| hand.takes_limits = false);
    assert_eq!(ran.aborted, Some(Abort::LimitsRefused { dof }));
    let sent = ran.sent.iter();
    let closed = sent.filter_map(|(_, set)| set.angle[dof].map(|target| target.raw()));
    assert!(closed.into_iter().all(|angle| angle == 1000));
}

#[test]
fn heat_and_force_end_it_and_force_counts_from_rest() {
    let dof = Dof::Little;
    let (celsius, limit) = (60, 60);
    let heat = Abort::Heat {
        dof: Dof::ThumbRotate,
        celsius,
        limit,
    };
    check(heat, plan(250, 2), |hand| {
        if closing(hand) {
            hand.celsius = 60;
        }
    });
    let (grams, ceiling) = (2000, 2000);
    let force = Abort::Ceiling {
        dof,
        grams,
        ceiling,
    };
    check(force, plan(250, 2), |hand| {
        hand.grams = if closing(hand) { 1993 } else { -7 };
    });
    let ran = run(plan(250, 1), |hand| {
        hand.grams = if closing(hand) { 1992 } else { -7 };
    });
    assert_eq!(ran.aborted, None, "1999 g above rest");
}

fn two_stage(until: Until) -> TrialPlan {
    TrialPlan {
        approach: Approach::TwoStage {
            fast: Speed::MAX,
            until,
        },
        ..plan(25, 1)
    }
}

/// When a trial's joint went on slowly and when it stopped, s after the command.
fn stages(trial: &Trial) -> (f64, f64) {
    let recording = &trial.recording;
    let when = |what| {
        let at = recording.when(what);
        seconds(recording.zero(), at.unwrap_or_else(|| panic!("{what:?}")))
    };
    (
        when(TrialEvent::Slow(Dof::Index)),
        when(TrialEvent::Stopped),
    )
}

#[test]
fn a_joint_that_rests_short_of_its_halt_goes_on_slowly() {
    let halt = Until::Angle(Angle::nearest(600));
    for rests_short in 0..=20 {
        let ran = run(two_stage(halt), |hand| hand.rests_short = rests_short);
        assert_eq!(ran.aborted, None, "{rests_short}");
        // 400 at 500 a second, and the same again.
        let (slow, stopped) = stages(&ran.trials[0]);
        assert!((0.75..0.85).contains(&slow), "{rests_short}: {slow}");
        assert!((1.75..1.9).contains(&stopped), "{rests_short}: {stopped}");
    }
}

#[test]
fn a_joint_that_is_stopped_before_its_halt_does_not_wait_for_it() {
    for until in [
        Until::Angle(Angle::nearest(600)),
        Until::Proximity(1000),
        Until::Touch(Force::nearest(100)),
    ] {
        let ran = run(two_stage(until), |hand| hand.blocked_at = 800);
        let (slow, stopped) = stages(&ran.trials[0]);
        assert!((0.5..0.8).contains(&slow), "{until:?}: {slow}");
        assert!(stopped < slow + 0.5, "{until:?}: {stopped}");
    }
}

#[test]
fn a_contact_that_was_not_found_is_not_approached() {
    let mut plan = plan(25, 3);
    plan.approach = Approach::TwoStage {
        fast: Speed::MAX,
        until: Until::Measured { margin: 40 },
    };
    let dof = Dof::Index;
    let ran = run(plan, |_| ());
    assert_eq!(ran.aborted, Some(Abort::NoContact { dof }));
    assert_eq!(ran.trials.len(), 1);
    assert_eq!(ran.trials[0].summary.kind, TrialKind::Probe);
}

#[test]
fn a_hand_that_stays_warm_is_waited_for_a_quarter_of_an_hour() {
    let mut series = TrialSeries::start(plan(250, 1), EPOCH, Moment::ZERO).unwrap();
    let mut hand = Hand::new();
    hand.celsius = 55;
    let later = |s: u64| Moment::from_micros(s * 1_000_000);
    assert_eq!(series.tick(&hand.sample(), hand.stall, later(899)), None);
    assert!(!series.is_over());
    assert_eq!(series.tick(&hand.sample(), hand.stall, later(901)), None);
    assert!(matches!(series.aborted(), Some(Abort::TooWarm { .. })));
}

#[test]
fn a_person_ends_it_at_any_time_and_only_once() {
    let mut series = TrialSeries::start(plan(250, 1), EPOCH, Moment::ZERO).unwrap();
    series.abort(Abort::Person, Moment::ZERO);
    series.abort(Abort::NotKept, Moment::ZERO);
    let hand = Hand::new();
    assert_eq!(series.tick(&hand.sample(), hand.stall, hand.now), None);
    assert_eq!(series.aborted(), Some(Abort::Person));
}
