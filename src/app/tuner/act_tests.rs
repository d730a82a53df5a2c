//! Proves what a series in the window sends and what ends it, against a link that only notes what it is told.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "a test may"
)]

use crate::app::fake_link::{Bench, FakeLink, Told};
use crate::app::trial::{self, Abort, Stage};
use crate::app::tuner::act::StartRefusal;
use crate::app::tuner::book::{Ended, Session, SessionId};
use crate::app::tuner::draft::Draft;
use crate::app::tuner::wish::TrialWish;
use crate::hand::{
    Angle, AngleReading, Dof, Fault, Faults, ForceReading, Group, Groups, HandSample, Moment,
    PerDof, Speed, Status, TemperatureReading, Timed,
};
use crate::link::{LinkEvent, LinkState, PollRates};
use std::time::Duration;

/// What a well hand says; each test spoils one thing.
#[derive(Debug, Clone, Copy)]
struct Said {
    angle: i16,
    grams: i16,
    celsius: u8,
    faults: u8,
}

const WELL: Said = Said {
    angle: 1000,
    grams: 3,
    celsius: 30,
    faults: 0,
};

fn timed<T>(value: T, at: Moment) -> Option<Timed<T>> {
    Some(Timed {
        value,
        asked: at,
        received: at,
    })
}

fn say(bench: &mut Bench, said: Said) {
    bench.millis += 1;
    let at = bench.now();
    let draft = &bench.desk.state.tuner.draft;
    let (speed, force) = (draft.speeds[0], draft.forces[0]);
    let mut sample = HandSample {
        angle: timed(PerDof::splat(AngleReading::new(said.angle)), at),
        force: timed(PerDof::splat(ForceReading::new(said.grams)), at),
        status: timed(PerDof::splat(Status::PositionReached), at),
        faults: timed(PerDof::splat(Faults::from_raw(said.faults)), at),
        temperature: timed(PerDof::splat(TemperatureReading::new(said.celsius)), at),
        ..HandSample::default()
    };
    sample.speed_set = timed(PerDof::splat(Some(speed)), at);
    sample.force_set = timed(PerDof::splat(Some(force)), at);
    let mut fresh = Groups::NONE;
    for group in [
        Group::Angle,
        Group::Force,
        Group::Status,
        Group::Faults,
        Group::Temperature,
    ] {
        fresh.insert(group);
    }
    bench.wire.borrow_mut().events.push_back(LinkEvent::Sample {
        sample: Box::new(sample),
        fresh,
    });
    bench.step();
}

fn start(bench: &mut Bench) {
    let now = bench.now();
    bench
        .desk
        .trial_wish(TrialWish::Start, Duration::from_secs(86_400), now);
}

/// A series that began, on a hand that said that it is well.
fn running() -> Bench {
    let mut bench = Bench::armed(1000);
    say(&mut bench, WELL);
    bench.told();
    start(&mut bench);
    say(&mut bench, WELL);
    assert!(bench.desk.state.tuner.is_running());
    bench
}

fn stage(bench: &Bench) -> Stage {
    bench.desk.state.tuner.run.as_ref().unwrap().series.stage()
}

fn session(bench: &Bench) -> &Session {
    bench.desk.state.tuner.session(SessionId(1)).unwrap()
}

fn ended_by(bench: &Bench) -> Option<Ended> {
    assert!(!bench.desk.state.tuner.is_running());
    session(bench).ended.clone()
}

#[test]
fn a_series_needs_an_arming_and_free_joints() {
    let mut bench = Bench::monitoring(1000);
    start(&mut bench);
    assert_eq!(
        bench.desk.state.start_refusal(),
        Some(StartRefusal::NotArmed)
    );
    assert!(bench.desk.state.tuner.sessions.is_empty());
    assert_eq!(bench.told(), [], "writing a plan and asking sends nothing");
    let mut bench = Bench::armed(1000);
    bench.desk.lock(Dof::Index, true);
    bench.told();
    start(&mut bench);
    let locked = Some(StartRefusal::Locked(Dof::Index));
    assert_eq!(bench.desk.state.start_refusal(), locked);
    assert_eq!(bench.told(), []);
}

#[test]
fn a_plan_that_makes_no_sense_sends_nothing() {
    let mut bench = Bench::armed(1000);
    bench.desk.state.tuner.draft.speeds = vec![Speed::MIN];
    start(&mut bench);
    say(&mut bench, WELL);
    assert!(!bench.desk.state.tuner.is_running());
    assert_eq!(bench.told(), []);
}

#[test]
fn the_orders_of_a_trial_go_over_the_link_and_closing_comes_last() {
    let mut bench = running();
    for _ in 0..100 {
        say(&mut bench, WELL);
    }
    assert_eq!(stage(&bench), Stage::Closing);
    let told = bench.told();
    let sets: Vec<_> = told
        .iter()
        .filter(|told| **told != Told::ReadAt(trial::RATES))
        .map(|told| match told {
            Told::Set(set) => (
                set.speed[Dof::Index],
                set.angle[Dof::Index].map(|to| to.raw()),
            ),
            other => panic!("{other:?}"),
        })
        .collect();
    let slow = Speed::SLOWEST_MEASURED;
    let wanted = [
        (Some(Speed::GENTLE), Some(1000)),
        (Some(slow), None),
        (None, Some(0)),
    ];
    assert_eq!(sets, wanted);
}

#[test]
fn nothing_else_moves_the_hand_while_a_series_runs() {
    let mut bench = running();
    bench.told();
    bench.desk.target(Dof::Ring, Angle::MIN);
    bench.desk.preset(crate::app::action::Preset::Close);
    bench.desk.try_angles(PerDof::splat(Angle::MIN));
    bench.desk.speed(Dof::Index, Speed::MAX);
    assert_eq!(bench.told(), []);
}

#[test]
fn a_stop_goes_out_first_and_ends_it_by_a_person() {
    let mut bench = running();
    bench.told();
    bench.desk.stop(bench.now());
    assert_eq!(bench.told(), [Told::Stop]);
    assert_eq!(ended_by(&bench), Some(Ended::Here(Abort::Person)));
    assert_eq!(session(&bench).trials.len(), 1, "what was read is kept");
    say(&mut bench, WELL);
    assert_eq!(bench.told(), [Told::ReadAt(PollRates::default())]);
}

#[test]
fn the_hand_is_read_at_full_rate_exactly_while_a_series_runs() {
    let mut bench = Bench::armed(1000);
    let at_rates = |bench: &Bench| -> Vec<_> {
        let told = bench.told().into_iter();
        told.filter(|told| matches!(told, Told::ReadAt(_)))
            .collect()
    };
    say(&mut bench, WELL);
    assert_eq!(at_rates(&bench), [], "an armed hand alone is no reason");
    start(&mut bench);
    say(&mut bench, WELL);
    say(&mut bench, WELL);
    assert_eq!(at_rates(&bench), [Told::ReadAt(trial::RATES)], "told once");
    say(&mut bench, Said { faults: 1, ..WELL });
    assert_eq!(at_rates(&bench), [Told::ReadAt(PollRates::default())]);
}

#[test]
fn another_hand_begins_at_the_rates_of_a_window() {
    let mut bench = running();
    let wire = bench.wire.clone();
    let link = Box::new(FakeLink::on(wire));
    bench.told();
    bench.desk.replace(None, Some(link), bench.now());
    bench.step();
    assert_eq!(bench.told(), [], "a new link has them from its opening");
}

#[test]
fn what_is_wrong_stops_the_hand_and_is_said() {
    let fault = Faults::from_raw(1);
    let dof = Dof::Little;
    for (said, why) in [
        (
            Said { faults: 1, ..WELL },
            Abort::Fault { dof, faults: fault },
        ),
        (
            Said {
                celsius: 61,
                ..WELL
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
                ..WELL
            },
            Abort::Ceiling {
                dof,
                grams: 2100,
                ceiling: 2000,
            },
        ),
    ] {
        let mut bench = running();
        bench.told();
        say(&mut bench, said);
        assert!(bench.told().contains(&Told::Stop), "{why:?}");
        assert_eq!(ended_by(&bench), Some(Ended::Here(why)));
    }
    assert!(fault.iter().eq([Fault::Stall]), "the bit of this test");
}

#[test]
fn a_peak_between_two_frames_is_seen() {
    let mut bench = running();
    let at = bench.now();
    let mut sample = bench.desk.state.sample;
    sample.force = timed(PerDof::splat(ForceReading::new(2500)), at);
    let mut fresh = Groups::NONE;
    fresh.insert(Group::Force);
    let event = LinkEvent::Sample {
        sample: Box::new(sample),
        fresh,
    };
    bench.wire.borrow_mut().events.push_back(event);
    say(&mut bench, WELL);
    assert!(matches!(
        ended_by(&bench),
        Some(Ended::Here(Abort::Ceiling { .. }))
    ));
}

#[test]
fn a_lost_link_and_another_arming_end_it() {
    let mut bench = running();
    bench.state(LinkState::Offline);
    bench.step();
    assert_eq!(ended_by(&bench), Some(Ended::Here(Abort::LinkLost)));
    let mut bench = running();
    bench.epoch(2);
    bench.step();
    assert_eq!(ended_by(&bench), Some(Ended::Here(Abort::Disarmed)));
    let mut bench = running();
    bench.desk.disarm(bench.now());
    bench.step();
    assert_eq!(ended_by(&bench), Some(Ended::Here(Abort::Disarmed)));
    assert!(bench.told().contains(&Told::Stop));
    let mut bench = running();
    bench.desk.replace(None, None, bench.now());
    assert_eq!(ended_by(&bench), Some(Ended::Here(Abort::LinkLost)));
}

#[test]
fn readings_that_stay_away_end_it() {
    let mut bench = running();
    for _ in 0..80 {
        bench.step();
    }
    assert!(matches!(
        ended_by(&bench),
        Some(Ended::Here(Abort::Blind { .. }))
    ));
}

#[test]
fn note_and_tags_stay_with_their_session() {
    let mut bench = running();
    let (id, at) = (SessionId(1), bench.now());
    let day = Duration::ZERO;
    bench
        .desk
        .trial_wish(TrialWish::Note(id, "an egg".into()), day, at);
    bench
        .desk
        .trial_wish(TrialWish::Tags(id, " egg, raw ,".into()), day, at);
    assert_eq!(session(&bench).head.note, "an egg");
    assert_eq!(session(&bench).head.tags, ["egg", "raw"]);
    bench.desk.trial_wish(TrialWish::Forget(id), day, at);
    assert_eq!(bench.desk.state.tuner.question, None);
    assert_eq!(session(&bench).id, id, "what runs is not forgotten");
    bench.desk.stop(at);
    for (answer, left) in [(TrialWish::Decline, 1), (TrialWish::Agree, 0)] {
        bench.desk.trial_wish(TrialWish::Forget(id), day, at);
        assert_eq!(bench.desk.state.tuner.question, Some(id));
        bench.desk.trial_wish(answer, day, at);
        assert_eq!(bench.desk.state.tuner.sessions.len(), left);
        assert_eq!(bench.desk.state.tuner.question, None);
    }
    assert_eq!(bench.desk.state.tuner.draft, Draft::default());
}
