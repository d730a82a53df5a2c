//! What a hand keeps, in the window: read when asked, staged without a word to the hand, written at rest, and never shown
//! as it was before.

use crate::program::{Bench, spoil};
use crate::setup::line::Trouble;
use handscope::app::action::Action;
use handscope::app::params::state::Doing;
use handscope::app::params::{ParamAction, ParamRefusal};
use handscope::app::procedures::{Procedure, ProcedureAction};
use handscope::app::readings::Freshness;
use handscope::hand::{Dof, Span};
use handscope::params::rows::{ParamId, Value};
use handscope::record::Saved;
use handscope::tasks::Question;
use handscope::tasks::reset::ResetEnd;
use tokio::time::Duration;

const INDEX: ParamId = ParamId::DefaultSpeed(Dof::Index);
const SAVE: u16 = 1005;

fn ask(bench: &mut Bench, action: ParamAction) {
    bench.act(Action::Param(action));
}

/// Answers the open question; its joints that would hit harder.
fn answer(bench: &mut Bench, yes: bool) -> Vec<Dof> {
    let question = bench.hand().params.question().unwrap().clone();
    let (Question::Apply(risks) | Question::Save(risks)) = &question else {
        panic!("{question:?}");
    };
    let joints = risks.dangers.iter().map(|danger| danger.dof).collect();
    bench.act(Action::Answer(question, yes));
    joints
}

fn stage(bench: &mut Bench, id: ParamId, number: i32) {
    bench.act(Action::Stage(id, Some(Value::Number(number))));
}

fn live(bench: &Bench, id: ParamId) -> Option<Value> {
    bench.hand().params.live(id).map(|(value, _)| value)
}

fn fresh(bench: &Bench, id: ParamId) -> Freshness {
    let hand = bench.hand();
    let is_live = hand.connection.is_live();
    hand.params.freshness(id, is_live, bench.app.state().now)
}

fn staged(bench: &Bench, id: ParamId) -> Option<Value> {
    bench.hand().params.staged(id)
}

async fn done(bench: &mut Bench) {
    bench.run(10).await;
    let idle = |hand: &handscope::app::hand::Hand| {
        !hand.params.is_busy() || hand.params.question().is_some()
    };
    bench
        .until("it ends or asks", |state| idle(state.hand()))
        .await;
}

async fn read(bench: &mut Bench) {
    ask(bench, ParamAction::Read);
    done(bench).await;
}

/// A hand with gentle defaults, so that nothing has to be asked about.
async fn gentle() -> Bench {
    let bench = Bench::live().await;
    for address in [1032, 1044] {
        let raw = 100_i16.to_le_bytes().repeat(6);
        let taken = bench.hand.with(|hand, now| hand.write(address, &raw, now));
        taken.unwrap();
    }
    let mut bench = bench;
    bench.forget();
    bench
}

#[tokio::test(start_paused = true)]
async fn connecting_staging_and_copying_ask_the_hand_for_nothing() {
    let mut bench = gentle().await;
    stage(&mut bench, INDEX, 250);
    ask(&mut bench, ParamAction::CopyLive);
    ask(&mut bench, ParamAction::StageTicked);
    ask(&mut bench, ParamAction::Tick(INDEX));
    stage(&mut bench, INDEX, 250);
    bench.run(1000).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
    assert_eq!(staged(&bench, INDEX), Some(Value::Number(250)));
    assert_eq!(live(&bench, INDEX), None, "nor was anything read");
    assert_eq!(fresh(&bench, INDEX), Freshness::Unknown);
}

#[tokio::test(start_paused = true)]
async fn what_may_not_be_written_is_not_staged() {
    let mut bench = gentle().await;
    for (id, number) in [
        (INDEX, 1001),
        (INDEX, -1),
        (ParamId::HandId, 0),
        (ParamId::ReduRatio, 4),
    ] {
        stage(&mut bench, id, number);
        assert_eq!(staged(&bench, id), None, "{id:?} {number}");
    }
    stage(&mut bench, INDEX, 1000);
    stage(&mut bench, INDEX, 1001);
    let last = Some(Value::Number(1000));
    assert_eq!(staged(&bench, INDEX), last, "the last good one stays");
    bench.act(Action::Stage(INDEX, None));
    assert_eq!(staged(&bench, INDEX), None);
}

#[tokio::test(start_paused = true)]
async fn a_reading_makes_rows_live_and_old_values_are_told_apart() {
    let mut bench = gentle().await;
    read(&mut bench).await;
    assert_eq!(live(&bench, INDEX), Some(Value::Number(100)));
    assert_eq!(fresh(&bench, INDEX), Freshness::Live);
    let now = bench.clock.now();
    assert!(!bench.hand().params.is_due(now));
    bench.run(61_000).await;
    assert_eq!(fresh(&bench, INDEX), Freshness::Stale);
    let now = bench.clock.now();
    assert!(bench.hand().params.is_due(now));
    read(&mut bench).await;
    assert_eq!(fresh(&bench, INDEX), Freshness::Live);
}

#[tokio::test(start_paused = true)]
async fn what_was_read_before_a_loss_is_old_until_it_is_read_again() {
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    read(&mut bench).await;
    assert_eq!(fresh(&bench, INDEX), Freshness::Live);
    spoil(&line, Trouble::Gone(Duration::from_secs(1)));
    bench.run(5000).await;
    assert!(bench.hand().connection.status.state.is_live());
    assert_eq!(fresh(&bench, INDEX), Freshness::Stale);
    let now = bench.clock.now();
    assert!(bench.hand().params.is_due(now));
}

#[tokio::test(start_paused = true)]
async fn apply_writes_what_is_staged_and_leaves_where_the_hand_is_alone() {
    let mut bench = gentle().await;
    stage(&mut bench, INDEX, 50);
    stage(&mut bench, ParamId::DefaultSpeed(Dof::Ring), 100);
    stage(&mut bench, ParamId::HandId, 9);
    ask(&mut bench, ParamAction::Apply);
    done(&mut bench).await;
    assert_eq!(bench.written().len(), 1, "only the row that differs");
    let params = &bench.hand().params;
    let verdict = |id| params.outcome(id).map(|row| row.verdict.name());
    assert_eq!(verdict(INDEX), Some("applied"));
    let ring = ParamId::DefaultSpeed(Dof::Ring);
    assert_eq!(verdict(ring), Some("applied"));
    assert_eq!(live(&bench, INDEX), Some(Value::Number(50)));
    assert_eq!(staged(&bench, INDEX), None);
    assert_eq!(
        staged(&bench, ParamId::HandId),
        Some(Value::Number(9)),
        "where the hand is goes another way"
    );
    assert_eq!(params.undo.get(INDEX), Some(Value::Number(100)));
    ask(&mut bench, ParamAction::Undo);
    done(&mut bench).await;
    assert_eq!(live(&bench, INDEX), Some(Value::Number(100)));
    let raw = bench
        .hand
        .with(|hand, now| hand.read(Span::new(1038, 2), now));
    assert_eq!(raw.unwrap(), 100_i16.to_le_bytes());
}

#[tokio::test(start_paused = true)]
async fn what_could_hurt_is_asked_first_and_written_only_when_meant() {
    let mut bench = gentle().await;
    stage(&mut bench, INDEX, 1000);
    stage(&mut bench, ParamId::DefaultForce(Dof::Index), 1000);
    ask(&mut bench, ParamAction::Apply);
    done(&mut bench).await;
    assert_eq!(bench.addresses(), [0_u16; 0], "nothing before the answer");
    let question = bench.hand().params.question().unwrap().clone();
    assert!(matches!(question, Question::Apply(_)));
    let Question::Apply(mut other) = question.clone() else {
        panic!("{question:?}");
    };
    other.dangers.clear();
    bench.act(Action::Answer(Question::Apply(other), true));
    bench.run(100).await;
    assert_eq!(
        bench.hand().params.question(),
        Some(&question),
        "an answer to another question"
    );
    assert_eq!(answer(&mut bench, false), [Dof::Index]);
    bench.act(Action::Answer(question, true));
    done(&mut bench).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
    ask(&mut bench, ParamAction::Apply);
    done(&mut bench).await;
    answer(&mut bench, true);
    done(&mut bench).await;
    assert_eq!(live(&bench, INDEX), Some(Value::Number(1000)));
}

#[tokio::test(start_paused = true)]
async fn no_write_begins_while_the_hand_is_armed_or_something_is_under_way() {
    let mut bench = gentle().await;
    assert_eq!(
        bench
            .hand()
            .params
            .apply_refusal(&bench.hand().connection.status),
        Some(ParamRefusal::NothingStaged)
    );
    stage(&mut bench, INDEX, 50);
    ask(&mut bench, ParamAction::Apply);
    ask(&mut bench, ParamAction::Save);
    assert_eq!(bench.hand().params.doing, Doing::Applying, "one at a time");
    assert_eq!(
        bench
            .hand()
            .params
            .write_refusal(&bench.hand().connection.status),
        Some(ParamRefusal::Busy)
    );
    done(&mut bench).await;
    bench.run(1000).await;
    stage(&mut bench, INDEX, 60);
    bench.arm().await;
    ask(&mut bench, ParamAction::Apply);
    ask(&mut bench, ParamAction::Save);
    bench.run(1000).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
    assert_eq!(
        bench
            .hand()
            .params
            .apply_refusal(&bench.hand().connection.status),
        Some(ParamRefusal::Armed)
    );
}

#[tokio::test(start_paused = true)]
async fn a_save_is_told_and_noted_beside_its_backup() {
    let mut bench = gentle().await;
    ask(&mut bench, ParamAction::Save);
    done(&mut bench).await;
    assert_eq!(bench.addresses(), [0_u16; 0], "nothing was read yet");
    read(&mut bench).await;
    ask(&mut bench, ParamAction::Save);
    done(&mut bench).await;
    assert_eq!(bench.addresses(), [0_u16; 0], "it asks first");
    answer(&mut bench, true);
    done(&mut bench).await;
    assert_eq!(bench.addresses(), [SAVE]);
    let end = bench.hand().params.save.clone().unwrap().0;
    assert_eq!(end.map(|report| report.saved), Ok(Saved::Confirmed));
    bench
        .until("its files are read", |state| {
            state.hand().params.known.saved.is_some()
        })
        .await;
    let saved = bench.hand().params.saved(INDEX);
    assert_eq!(saved, Some(Value::Number(100)));
    assert_eq!(bench.hand().params.backups.len(), 1);
}

#[tokio::test(start_paused = true)]
async fn another_hand_takes_over_nothing_of_the_old_one() {
    let mut bench = gentle().await;
    read(&mut bench).await;
    stage(&mut bench, INDEX, 50);
    ask(&mut bench, ParamAction::Apply);
    bench.act(Action::Connect("rs485:y".parse().unwrap()));
    let params = &bench.hand().params;
    assert!(params.all_staged().is_empty() && params.live(INDEX).is_none() && !params.is_busy());
    assert!(params.outcome(INDEX).is_none());
    bench.run(2000).await;
    assert_eq!(
        bench.addresses(),
        [0_u16; 0],
        "what was not written then is not written now"
    );
}

#[tokio::test(start_paused = true)]
async fn after_a_factory_reset_no_row_is_shown_as_it_was() {
    let mut bench = gentle().await;
    read(&mut bench).await;
    assert_eq!(fresh(&bench, INDEX), Freshness::Live);
    bench.act(Action::FactoryReset);
    bench.act(Action::Procedure(ProcedureAction::Begin));
    let is_over = |hand: &handscope::app::hand::Hand| match &hand.procedures.card {
        Some(Procedure::Reset(card)) => card.stage.end().is_some(),
        _ => false,
    };
    bench
        .until("the reset ends", |state| is_over(state.hand()))
        .await;
    let Some(Procedure::Reset(card)) = &bench.hand().procedures.card else {
        panic!("the card stays");
    };
    let end = card.stage.end().unwrap().as_ref().unwrap().end.clone();
    assert!(matches!(end, ResetEnd::Found { .. }), "{end:?}");
    let raw = bench
        .hand
        .with(|hand, now| hand.read(Span::new(1038, 2), now));
    assert_ne!(
        raw.unwrap(),
        100_i16.to_le_bytes(),
        "the hand holds another"
    );
    assert_ne!(fresh(&bench, INDEX), Freshness::Live);
    for _ in 0..500 {
        bench.run(10).await;
        bench.app.read_params_if_due(bench.clock.now());
    }
    assert_eq!(fresh(&bench, INDEX), Freshness::Live);
    let read = live(&bench, INDEX);
    assert_ne!(read, Some(Value::Number(100)), "the hand holds another");
}

#[tokio::test(start_paused = true)]
async fn after_a_change_of_address_no_row_is_shown_as_it_was() {
    let mut bench = gentle().await;
    read(&mut bench).await;
    let ip = ParamId::IpAddress;
    let before = live(&bench, ip).unwrap();
    let wanted = Value::Address([192, 168, 11, 99].into());
    assert_ne!(before, wanted);
    bench.act(Action::ChangePlace(ip, wanted));
    bench.act(Action::Procedure(ProcedureAction::Begin));
    let is_there = |hand: &handscope::app::hand::Hand| match &hand.procedures.card {
        Some(Procedure::Place(card)) => card.stage.end().is_some() || card.question().is_some(),
        _ => false,
    };
    bench
        .until("a person is asked", |state| is_there(state.hand()))
        .await;
    let held = bench
        .hand
        .with(|hand, now| hand.read(Span::new(1700, 4), now));
    assert_eq!(held.unwrap(), [192, 168, 11, 99]);
    let shown = (live(&bench, ip), fresh(&bench, ip));
    assert_ne!(shown, (Some(before), Freshness::Live));
}
