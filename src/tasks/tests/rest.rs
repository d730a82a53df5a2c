//! A hand of which it is not known whether it rests is not written, whichever task wants to.

use crate::fake::{Asked, FakeHand, Fate, WELL};
use crate::hand::{Dof, Setting};
use crate::params::backups::Backups;
use crate::params::changes::RowVerdict;
use crate::params::place::PlacePair;
use crate::params::rows::{ParamId, Value};
use crate::params::values::Params;
use crate::record::{Calibrated, NotSent, Rest, Saved};
use crate::tasks::apply::{Apply, Otherwise, apply};
use crate::tasks::calibrate::{CalibrationCondition, Checks, calibrate};
use crate::tasks::place::{PlaceChange, PlaceEnd, change_place};
use crate::tasks::reset::{ResetEnd, places, reset};
use crate::tasks::save::{Save, save};
use crate::tasks::tests::reach::FakeReach;
use crate::tasks::{Question, Risks};
use std::time::Duration;
use tempfile::TempDir;
use tokio::time::{Instant, sleep};

const WHY: NotSent = NotSent::RestUnknown;

/// A hand whose status is missing or old: the link holds back what needs rest.
fn unknown() -> FakeHand {
    let hand = FakeHand::new();
    hand.change(|status| status.rest = Rest::Unknown);
    hand.script(|asked| match asked {
        Asked::Read(_) => Fate::Answered,
        _ => Fate::NotSent(WHY),
    });
    hand
}

/// A user who agrees to everything.
fn agrees(_: &Question) -> bool {
    true
}

fn wanted() -> Params {
    let mut wanted = Params::default();
    wanted.put(ParamId::DefaultSpeed(Dof::Index), Value::Number(50));
    wanted
}

fn files() -> (TempDir, Backups) {
    let folder = TempDir::new().unwrap();
    let backups = Backups::new(folder.path(), &"rs485:/dev/x".parse().unwrap());
    (folder, backups)
}

#[tokio::test(start_paused = true)]
async fn rest_that_is_unknown_refuses_apply_save_reset_and_calibration() {
    let hand = unknown();
    let before = hand.holds(ParamId::DefaultSpeed(Dof::Index));
    let task = Apply {
        overshoot: std::sync::Arc::default(),
        wanted: wanted(),
        agreed: Risks::default(),
        backups: None,
        otherwise: Otherwise::Undo,
    };
    let applied = apply(&hand, &task, &mut agrees, |_| ()).await.unwrap();
    let verdicts: Vec<_> = applied.rows.iter().map(|row| &row.verdict).collect();
    assert_eq!(verdicts, [&RowVerdict::NotSent(WHY)]);

    let (_folder, backups) = files();
    let task = Save {
        overshoot: std::sync::Arc::default(),
        backups: backups.clone(),
        before: Params::default(),
        agreed: Risks::default(),
    };
    let saved = save(&hand, &task, &mut agrees, |_| ()).await.unwrap();
    assert_eq!(saved.saved, Saved::NotSent(WHY));
    assert!(backups.known().unwrap().doubtful.is_none());

    let mut reach = FakeReach {
        hand: hand.clone(),
        is_there: |_: &_| true,
    };
    let places = places(&"rs485:/dev/x".parse().unwrap());
    let end = reset(&mut reach, &places, &backups, |_| ()).await.unwrap();
    assert_eq!(end.end, ResetEnd::NotSent(Some(WHY)));

    let end = calibrate(&hand, hand.clock, |_| ()).await;
    assert_eq!(end.end, Ok(Calibrated::NotSent(WHY)));
    assert_eq!(hand.holds(ParamId::DefaultSpeed(Dof::Index)), before);
}

#[tokio::test(start_paused = true)]
async fn what_is_refused_for_rest_is_asked_again_for_eight_seconds_and_then_given_up() {
    let hand = unknown();
    let task = Apply {
        overshoot: std::sync::Arc::default(),
        wanted: wanted(),
        agreed: Risks::default(),
        backups: None,
        otherwise: Otherwise::Stay,
    };
    let begun = Instant::now();
    let applied = apply(&hand, &task, &mut agrees, |_| ()).await.unwrap();
    let took = begun.elapsed();
    assert!(!applied.is_whole());
    assert!((8..10).contains(&took.as_secs()), "{took:?}");

    let mut left = 5;
    hand.script(move |asked| match asked {
        Asked::Keep(_) if left > 0 => {
            left -= 1;
            Fate::NotSent(NotSent::Moving)
        }
        _ => Fate::Answered,
    });
    assert!(
        apply(&hand, &task, &mut agrees, |_| ())
            .await
            .unwrap()
            .is_whole()
    );
}

#[tokio::test(start_paused = true)]
async fn an_armed_hand_is_not_asked_again() {
    let hand = FakeHand::new();
    hand.script(|asked| match asked {
        Asked::Keep(_) => Fate::NotSent(NotSent::Armed),
        _ => Fate::Answered,
    });
    let mut wanted = wanted();
    wanted.put(ParamId::DefaultForce(Dof::Index), Value::Number(50));
    let task = Apply {
        overshoot: std::sync::Arc::default(),
        wanted,
        agreed: Risks::default(),
        backups: None,
        otherwise: Otherwise::Stay,
    };
    let applied = apply(&hand, &task, &mut agrees, |_| ()).await.unwrap();
    let asked = hand.asked();
    let writes = asked.iter().filter(|one| matches!(one, Asked::Keep(_)));
    assert_eq!(writes.count(), 1, "nor for the next group");
    assert!(!applied.is_whole());
}

#[tokio::test(start_paused = true)]
async fn where_a_hand_is_found_is_not_changed_unless_it_is_known_to_rest() {
    for rest in [Rest::Unknown, Rest::Moving] {
        let hand = FakeHand::new();
        hand.change(|status| status.rest = rest);
        let place = "rs485:/dev/x?id=1".parse().unwrap();
        let change = PlaceChange {
            id: ParamId::HandId,
            before: Value::Number(1),
            wanted: Value::Number(7),
            places: PlacePair {
                new: "rs485:/dev/x?id=7".parse().unwrap(),
                old: place,
            },
            is_followed: true,
        };
        let old = change.places.old.clone();
        let mut reach = FakeReach {
            hand: hand.clone(),
            is_there: move |place: &_| *place == old,
        };
        let (_folder, backups) = files();
        let end = change_place(&mut reach, &change, &backups, &mut agrees, |_| ()).await;
        assert_eq!(end.unwrap().end, PlaceEnd::NotWritten, "{rest:?}");
        let asked = hand.asked();
        let is_write = |one: &Asked| matches!(one, Asked::SetUnread(Setting::Id(_)));
        assert!(!asked.iter().any(is_write), "{rest:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_calibration_wants_a_hand_that_is_known_to_rest() {
    let hand = FakeHand::new();
    let mut checks = Checks::default();
    let mut sample = hand.says(WELL);
    for _ in 0..30 {
        sleep(Duration::from_millis(100)).await;
        sample = hand.says(WELL);
        checks.watch(&sample);
    }
    let mut status = hand.status();
    for (rest, want) in [
        (Rest::Resting, Some(true)),
        (Rest::Moving, Some(false)),
        (Rest::Unknown, None),
    ] {
        status.rest = rest;
        let still = checks.check(
            CalibrationCondition::Still,
            &sample,
            &status,
            hand.clock.now(),
        );
        assert_eq!(still, want);
    }
    assert_eq!(
        checks.check(
            CalibrationCondition::Steady,
            &sample,
            &status,
            hand.clock.now()
        ),
        Some(true)
    );
    sleep(Duration::from_millis(600)).await;
    for check in [
        CalibrationCondition::NoFault,
        CalibrationCondition::Open,
        CalibrationCondition::Untouched,
        CalibrationCondition::Steady,
    ] {
        let old = checks.check(check, &sample, &status, hand.clock.now());
        assert_eq!(old, None, "{check:?}: what is old says nothing of now");
    }
}
