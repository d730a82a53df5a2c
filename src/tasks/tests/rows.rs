//! Reading, applying, saving and resetting: what is asked in which order, and what is said of what was lost.

use crate::fake::{Asked, FakeHand, Fate};
use crate::hand::{Dof, ModbusException, Setting, Span};
use crate::link::RequestError;
use crate::params::backups::Backups;
use crate::params::changes::{RowOutcome, undo_of};
use crate::params::place::WhichPlace;
use crate::params::rows::{ParamId, Value};
use crate::params::values::{Params, SPANS};
use crate::record::{Doubt, NotSent, Saved, Verdict};
use crate::tasks::apply::{Applied, Apply, Otherwise, apply};
use crate::tasks::read::{group, rows};
use crate::tasks::reset::{ResetEnd, ResetReport, places, reset};
use crate::tasks::save::{Save, SaveReport, save};
use crate::tasks::tests::reach::FakeReach;
use crate::tasks::{Question, Risks, TaskError, TaskStep};
use tempfile::TempDir;

const INDEX: ParamId = ParamId::DefaultSpeed(Dof::Index);

fn one(id: ParamId, number: i32) -> Params {
    let mut params = Params::default();
    params.put(id, Value::Number(number));
    params
}

/// A user who agrees to nothing.
fn nobody(_: &Question) -> bool {
    false
}

fn reads() -> Vec<Asked> {
    SPANS.map(Asked::Read).to_vec()
}

async fn applied(hand: &FakeHand, wanted: Params) -> Result<Applied, TaskError> {
    let task = Apply {
        overshoot: std::sync::Arc::default(),
        wanted,
        agreed: Risks::default(),
        backups: None,
        otherwise: Otherwise::Stay,
    };
    apply(hand, &task, &mut nobody, |_| ()).await
}

fn row(applied: &Applied, id: ParamId) -> &RowOutcome {
    let mut rows = applied.rows.iter();
    rows.find(|row| row.id == id).unwrap()
}

/// Ends the n-th request of this kind so.
fn nth(nth: usize, is_it: fn(&Asked) -> bool, fate: Fate) -> impl FnMut(&Asked) -> Fate + Send {
    let mut left = nth;
    move |asked| {
        if is_it(asked) {
            left = left.wrapping_sub(1);
            if left == 0 {
                return fate.clone();
            }
        }
        Fate::Answered
    }
}

const IS_READ: fn(&Asked) -> bool = |asked| matches!(asked, Asked::Read(_));
const IS_KEEP: fn(&Asked) -> bool = |asked| matches!(asked, Asked::Keep(_));

#[tokio::test(start_paused = true)]
async fn a_group_that_gives_no_answer_is_asked_again_and_then_left() {
    let hand = FakeHand::new();
    hand.script(|asked| match asked {
        Asked::Read(span) if *span == SPANS[0] => Fate::Unheard,
        _ => Fate::Answered,
    });
    let read = rows(&hand, |_, _| ()).await;
    let first = vec![Asked::Read(SPANS[0]); 4];
    let others = SPANS[1..].iter().map(|span| Asked::Read(*span));
    assert_eq!(
        hand.asked(),
        first.into_iter().chain(others).collect::<Vec<_>>()
    );
    assert!(matches!(read.troubles[..], [RequestError::Timeout { .. }]));
    assert_eq!(read.params.get(ParamId::HandId), None);
    assert_eq!(read.params.get(INDEX), Some(Value::Number(100)));
}

#[tokio::test(start_paused = true)]
async fn what_a_late_answer_could_be_taken_for_is_asked_again_once_none_can_come() {
    let hand = FakeHand::new();
    let mut lost_at = None;
    let clock = hand.clock;
    hand.script(move |asked| {
        if *asked != Asked::Read(SPANS[2]) {
            return Fate::Answered;
        }
        let lost = *lost_at.get_or_insert(clock.now());
        let since = clock.now().since(lost);
        match since.as_millis() {
            0 => Fate::Unheard,
            1..2000 => Fate::Fails(RequestError::Ambiguous {
                address: SPANS[2].address,
                wait_s: 2,
            }),
            _ => Fate::Answered,
        }
    });
    assert_eq!(rows(&hand, |_, _| ()).await.troubles, []);
    let span = Span::new(1, 1);
    let always = RequestError::Ambiguous {
        address: 1,
        wait_s: 2,
    };
    let fails = Fate::Fails(always.clone());
    hand.script(move |_| fails.clone());
    assert_eq!(group(&hand, span).await, Err(always), "but not for ever");
}

#[tokio::test(start_paused = true)]
async fn apply_reads_first_writes_what_differs_and_undo_puts_it_back() {
    let hand = FakeHand::new();
    let mut wanted = one(INDEX, 50);
    wanted.put(ParamId::DefaultSpeed(Dof::Ring), Value::Number(100));
    let end = applied(&hand, wanted).await.unwrap();
    let asked = hand.asked();
    let (first, then) = asked.split_at(SPANS.len());
    assert_eq!(first, reads());
    let [Asked::Keep(Setting::DefaultSpeeds(speeds))] = then else {
        panic!("{then:?}");
    };
    let written = speeds.iter().filter(|(_, speed)| speed.is_some()).count();
    assert_eq!(written, 1, "only the row that differs");
    assert!(end.is_whole());
    assert_eq!(end.rows.len(), 2);
    let undo = undo_of(&end.rows);
    assert_eq!(undo, one(INDEX, 100));
    assert!(applied(&hand, undo).await.unwrap().is_whole());
    assert_eq!(hand.holds(INDEX), Some(Value::Number(100)));
}

#[tokio::test(start_paused = true)]
async fn a_row_that_was_not_taken_shows_what_the_hand_holds() {
    let refused = Verdict::Refused {
        reason: ModbusException::Failure.into(),
    };
    for (fate, holds, name) in [
        (Fate::Verdict(refused), 100, "refused"),
        (Fate::Verdict(Verdict::Differs), 100, "dropped"),
        (Fate::Takes(70), 70, "altered"),
    ] {
        let hand = FakeHand::new();
        hand.script(nth(1, IS_KEEP, fate));
        let end = applied(&hand, one(INDEX, 50)).await.unwrap();
        let row = row(&end, INDEX);
        assert_eq!(row.verdict.name(), name);
        assert_eq!(row.holds, Some(Value::Number(holds)));
        assert!(!end.is_whole());
    }
}

#[tokio::test(start_paused = true)]
async fn what_could_not_be_verified_is_read_once_more_and_else_not_known() {
    let why = Doubt::NotReadBack;
    let hand = FakeHand::new();
    hand.script(nth(1, IS_KEEP, Fate::Verdict(Verdict::Unverified { why })));
    let end = applied(&hand, one(INDEX, 50)).await.unwrap();
    assert_eq!(
        row(&end, INDEX).verdict.name(),
        "dropped",
        "it holds what it held"
    );
    assert!(undo_of(&end.rows).is_empty());

    let hand = FakeHand::new();
    let mut is_written = false;
    hand.script(move |asked| match asked {
        Asked::Keep(_) => {
            is_written = true;
            Fate::Verdict(Verdict::Unverified { why })
        }
        Asked::Read(span) if is_written => Fate::Fails(RequestError::Refused {
            address: span.address,
            reason: ModbusException::Failure.into(),
        }),
        _ => Fate::Answered,
    });
    let end = applied(&hand, one(INDEX, 50)).await.unwrap();
    let row = row(&end, INDEX);
    assert_eq!((row.verdict.name(), row.holds), ("unverified", None));
    let may_have_changed = undo_of(&end.rows);
    assert_eq!(may_have_changed, one(INDEX, 100));
}

#[tokio::test(start_paused = true)]
async fn nothing_is_written_on_the_strength_of_a_row_that_cannot_be_read() {
    let hand = FakeHand::new();
    hand.script(|asked| match asked {
        Asked::Read(span) if *span == SPANS[2] => Fate::Fails(RequestError::Refused {
            address: span.address,
            reason: ModbusException::Failure.into(),
        }),
        _ => Fate::Answered,
    });
    let end = applied(&hand, one(INDEX, 50)).await;
    assert!(matches!(end, Err(TaskError::NotRead { .. })), "{end:?}");
    assert_eq!(hand.asked(), reads());
}

#[tokio::test(start_paused = true)]
async fn what_could_hurt_is_asked_first_and_written_only_when_meant() {
    let hand = FakeHand::new();
    let mut wanted = one(INDEX, 1000);
    wanted.put(ParamId::DefaultForce(Dof::Index), Value::Number(1000));
    let Err(TaskError::Declined(risks)) = applied(&hand, wanted.clone()).await else {
        panic!("nobody agreed");
    };
    assert_eq!(hand.asked(), reads(), "nothing before the answer");
    let joints: Vec<_> = risks.dangers.iter().map(|danger| danger.dof).collect();
    assert_eq!(joints, [Dof::Index]);
    let task = Apply {
        overshoot: std::sync::Arc::default(),
        wanted,
        agreed: risks,
        backups: None,
        otherwise: Otherwise::Stay,
    };
    assert!(
        apply(&hand, &task, &mut nobody, |_| ())
            .await
            .unwrap()
            .is_whole()
    );
    assert_eq!(hand.holds(INDEX), Some(Value::Number(1000)));

    let elsewhere = applied(&hand, one(ParamId::HandId, 7)).await;
    assert!(
        matches!(elsewhere, Err(TaskError::Declined(_))),
        "where the hand is goes another way"
    );
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_applied_whole_is_put_back_where_that_is_wanted() {
    let hand = FakeHand::new();
    let mut wanted = one(INDEX, 50);
    wanted.put(ParamId::DefaultForce(Dof::Index), Value::Number(50));
    hand.script(nth(2, IS_KEEP, Fate::Verdict(Verdict::Differs)));
    let task = Apply {
        overshoot: std::sync::Arc::default(),
        wanted,
        agreed: Risks::default(),
        backups: None,
        otherwise: Otherwise::Undo,
    };
    let end = apply(&hand, &task, &mut |_: &Question| true, |_| ())
        .await
        .unwrap();
    assert_eq!((end.is_whole(), end.undone), (false, Some(true)));
    assert_eq!(hand.holds(INDEX), Some(Value::Number(100)));
}

fn files() -> (TempDir, Backups) {
    let folder = TempDir::new().unwrap();
    let backups = Backups::new(folder.path(), &"rs485:/dev/x?id=7".parse().unwrap());
    (folder, backups)
}

async fn saved(
    hand: &FakeHand,
    backups: Backups,
) -> (Result<SaveReport, TaskError>, Vec<TaskStep>) {
    let task = Save {
        overshoot: std::sync::Arc::default(),
        backups,
        before: Params::default(),
        agreed: Risks::default(),
    };
    let mut steps = Vec::new();
    let end = save(hand, &task, &mut nobody, |step| steps.push(step)).await;
    (end, steps)
}

#[tokio::test(start_paused = true)]
async fn no_save_goes_out_without_a_backup_and_its_result_is_noted() {
    let (folder, _) = files();
    let blocked = folder.path().join("file");
    std::fs::write(&blocked, "").unwrap();
    let nowhere = Backups::new(&blocked, &"rs485:/dev/x?id=7".parse().unwrap());
    let hand = FakeHand::new();
    let (end, _) = saved(&hand, nowhere).await;
    assert!(matches!(end, Err(TaskError::NoBackup { .. })), "{end:?}");
    assert_eq!(hand.asked(), reads(), "no SAVE");

    let (_folder, backups) = files();
    let (end, steps) = saved(&hand, backups.clone()).await;
    let end = end.unwrap();
    assert_eq!((end.saved, end.not_noted), (Saved::Confirmed, None));
    assert!(end.backup.exists());
    assert_eq!(steps.last(), Some(&TaskStep::Saving));
    assert_eq!(hand.asked().last(), Some(&Asked::Save));
    let known = backups.known().unwrap();
    assert_eq!(known.saved.unwrap().params, end.params);
    assert_eq!(known.doubtful, None);
}

#[tokio::test(start_paused = true)]
async fn a_save_of_unknown_result_is_noted_as_such_and_one_that_never_went_out_is_not() {
    let (_folder, backups) = files();
    let hand = FakeHand::new();
    hand.script(nth(1, |asked| *asked == Asked::Save, Fate::AnswerLost));
    let (end, _) = saved(&hand, backups.clone()).await;
    assert!(matches!(end.unwrap().saved, Saved::Unknown { .. }));
    let known = backups.known().unwrap();
    assert!(known.saved.is_none() && known.doubtful.is_some());

    let (_folder, backups) = files();
    let why = NotSent::Moving;
    hand.script(move |asked| match asked {
        Asked::Save => Fate::NotSent(why),
        _ => Fate::Answered,
    });
    let (end, _) = saved(&hand, backups.clone()).await;
    assert_eq!(end.unwrap().saved, Saved::NotSent(why));
    let known = backups.known().unwrap();
    assert!(known.saved.is_none() && known.doubtful.is_none());
}

/// A reset of a hand with id 7 whose answer has this fate; `is_there` says at which looks it answers.
async fn reset_of(
    place: &str,
    fate: Fate,
    mut is_there: impl FnMut(usize) -> bool + Send,
) -> (Result<ResetReport, TaskError>, Vec<TaskStep>) {
    let (_folder, backups) = files();
    let hand = FakeHand::new();
    hand.put(ParamId::HandId, Value::Number(7));
    hand.script(nth(1, |asked| *asked == Asked::Reset, fate));
    let mut looks = 0;
    let mut reach = FakeReach {
        hand,
        is_there: move |_: &_| {
            looks += 1;
            looks == 1 || is_there(looks - 2)
        },
    };
    let places = places(&place.parse().unwrap());
    let mut steps = Vec::new();
    let end = reset(&mut reach, &places, &backups, |step| steps.push(step)).await;
    (end, steps)
}

fn places_tried(steps: &[TaskStep]) -> Vec<WhichPlace> {
    let looks = steps.iter().filter_map(|step| match step {
        TaskStep::Looking(place) => Some(*place),
        _ => None,
    });
    looks.collect()
}

#[tokio::test(start_paused = true)]
async fn the_hand_is_looked_for_at_the_factorys_place_first_and_in_rounds() {
    let (end, steps) = reset_of("rs485:/dev/x?id=7", Fate::AnswerLost, |_| false).await;
    assert_eq!(end.unwrap().end, ResetEnd::Nowhere);
    assert_eq!(
        places_tried(&steps),
        [WhichPlace::New, WhichPlace::Old].repeat(3)
    );

    let (end, steps) = reset_of("rs485:/dev/x?id=1", Fate::Answered, |look| look == 1).await;
    assert_eq!(places_tried(&steps), [WhichPlace::New; 2]);
    let report = end.unwrap();
    assert!(report.is_acknowledged);
    let ResetEnd::Found { at, left, .. } = report.end else {
        panic!("{:?}", report.end);
    };
    assert_eq!((at, left), (WhichPlace::New, Vec::new()));
}

#[tokio::test(start_paused = true)]
async fn what_was_not_taken_is_told_as_it_is() {
    let why = NotSent::Armed;
    let (end, steps) = reset_of("rs485:/dev/x?id=7", Fate::NotSent(why), |_| true).await;
    assert_eq!(end.unwrap().end, ResetEnd::NotSent(Some(why)));
    assert_eq!(places_tried(&steps), []);

    let (end, _) = reset_of("rs485:/dev/x?id=7", Fate::Unheard, |look| look == 1).await;
    let ResetEnd::Found { at, left, .. } = end.unwrap().end else {
        panic!("it answers at its old place");
    };
    assert_eq!((at, left), (WhichPlace::Old, vec![ParamId::HandId]));
}

#[tokio::test(start_paused = true)]
async fn reading_writes_nothing() {
    let hand = FakeHand::new();
    rows(&hand, |_, _| ()).await;
    assert!(hand.asked().iter().all(IS_READ));
}
