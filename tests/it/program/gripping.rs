//! Sequences that wait for the grip: when they go on, when they try again, and what ends the wait. Judged by what was written to the hand.

use crate::program::playing::{ENDINGS, stays_ended};
use crate::program::playing::{library, phase};
use crate::program::{ANGLE_SET, Bench, angles_told, shorts, spoil};
use crate::setup::line::Trouble;
use handscope::app::action::Action;
use handscope::app::notices::NoticeKind;
use handscope::hand::Dof;
use handscope::hand::grip::GripState;
use handscope::poses::Play;
use handscope::poses::edit::{LibraryEdit, SequenceEdit};
use handscope::poses::library::{EntryId, Millis, Retries, SequenceId, SequenceStep, UntilHolding};
use handscope::poses::player::{PlayEnd, PlayPhase};
use handscope::record::Abort;
use handscope::sim::Object;
use tokio::time::Duration;

const OPENS: i16 = 1000;

/// A sequence to 700, then to 300 until holding, then to 700.
fn gripping(bench: &mut Bench, within_ms: i64, retries: i64) -> SequenceId {
    let (open, own) = library(bench);
    let sequence = bench.state().poses.library.sequence(own).unwrap();
    let waits = SequenceStep {
        until: Some(UntilHolding {
            within: Millis::try_from(within_ms).unwrap(),
            retries: Retries::try_from(retries).unwrap(),
        }),
        ..sequence.steps[1]
    };
    for edit in [SequenceEdit::Change(1, waits), SequenceEdit::Add(open)] {
        bench.act(Action::Library(LibraryEdit::Sequence(own, edit)));
    }
    own
}

/// Where the index finger was sent since the journal was forgotten, and when, ms.
fn sent(bench: &Bench) -> Vec<(i16, u64)> {
    let written = bench.written().into_iter();
    let index = ANGLE_SET + 2 * Dof::Index.index() as u16;
    let sent = written.filter_map(|entry| {
        let at = usize::from(index.checked_sub(entry.address)?) / 2;
        let to = *shorts(&entry).get(at)?;
        (to >= 0).then_some((to, entry.at.micros() / 1000))
    });
    sent.collect()
}

fn places(bench: &Bench) -> Vec<i16> {
    sent(bench).into_iter().map(|(to, _)| to).collect()
}

fn is_over(bench: &Bench) -> bool {
    matches!(phase(bench), Some(PlayPhase::Ended(_)))
}

async fn play_to_the_end(bench: &mut Bench, own: SequenceId) {
    bench.act(Action::Play(Play::Start(EntryId::Sequence(own))));
    bench.run(100).await;
    for _ in 0..600 {
        if is_over(bench) {
            return;
        }
        bench.run(100).await;
    }
    panic!("{:?}", phase(bench));
}

#[tokio::test(start_paused = true)]
async fn a_step_goes_on_once_the_hand_holds_and_waits_for_no_place_behind_the_object() {
    let mut bench = Bench::live().await;
    bench
        .hand
        .with(|hand, _| hand.set_object(&Object::rigid(600.0)));
    let own = gripping(&mut bench, 3000, 3);
    bench.arm().await;
    play_to_the_end(&mut bench, own).await;
    assert_eq!(phase(&bench), Some(PlayPhase::Ended(Ok(PlayEnd::Finished))));
    let sent = sent(&bench);
    assert_eq!(places(&bench), [700, 300, 700]);
    let took_ms = sent[2].1 - sent[1].1;
    assert!((500..4000).contains(&took_ms), "{took_ms} ms");
    let late = bench.hand().running.sequence().unwrap().view.late;
    assert_eq!(late, 0, "a held object is no pose that was not reached");
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_closes_on_nothing_opens_and_tries_again_so_often_and_no_more() {
    let mut bench = Bench::live().await;
    let own = gripping(&mut bench, 1000, 2);
    bench.arm().await;
    play_to_the_end(&mut bench, own).await;
    let end = PlayEnd::NotHolding(GripState::Empty);
    assert_eq!(phase(&bench), Some(PlayPhase::Ended(Ok(end))));
    assert_eq!(places(&bench), [700, 300, OPENS, 300, OPENS, 300]);
    let turned = angles_told(&bench)
        .into_iter()
        .any(|told| told[Dof::ThumbRotate as usize] == OPENS);
    assert!(!turned, "the thumb keeps its rotation");
    let grip = GripState::Empty;
    assert!(bench.told().contains(&NoticeKind::NotHolding { grip }));
    bench.forget();
    bench.run(5000).await;
    assert_eq!(places(&bench), [0_i16; 0], "and nothing more");
}

#[tokio::test(start_paused = true)]
async fn a_try_that_holds_is_the_last() {
    let mut bench = Bench::live().await;
    let own = gripping(&mut bench, 1000, 5);
    bench.arm().await;
    bench.act(Action::Play(Play::Start(EntryId::Sequence(own))));
    let mut is_there = false;
    for _ in 0..600 {
        bench.run(50).await;
        let is_open = bench.angle(Dof::Index) > 900 && places(&bench).contains(&OPENS);
        if is_open && !is_there {
            is_there = true;
            // The thumb's rotation, which stays, is in nobody's way.
            let mut object = Object::rigid(600.0);
            object.contacts[Dof::ThumbRotate] = None;
            bench.hand.with(|hand, _| hand.set_object(&object));
        }
    }
    assert_eq!(phase(&bench), Some(PlayPhase::Ended(Ok(PlayEnd::Finished))));
    assert_eq!(places(&bench), [700, 300, OPENS, 300, 700]);
}

/// A sequence that waits at its second step for what does not come, with nothing that is looked at before.
async fn waiting(bench: &mut Bench) {
    let own = gripping(bench, 600_000, 0);
    bench.arm().await;
    bench.act(Action::Play(Play::Start(EntryId::Sequence(own))));
    for _ in 0..100 {
        bench.run(100).await;
        if matches!(phase(bench), Some(PlayPhase::Waiting { .. })) {
            bench.run(1000).await;
            bench.forget();
            return;
        }
    }
    panic!("{:?}", phase(bench));
}

#[tokio::test(start_paused = true)]
async fn a_wait_moves_nothing_and_whatever_ends_a_sequence_ends_it() {
    for (break_off, want) in ENDINGS {
        let mut bench = Bench::live().await;
        waiting(&mut bench).await;
        bench.run(60_000).await;
        assert_eq!(bench.addresses(), [0_u16; 0], "{want:?}");
        break_off(&mut bench);
        // What it waited for does not bring it back.
        let comes = |bench: &mut Bench| {
            let object = Object::rigid(600.0);
            bench.hand.with(|hand, _| hand.set_object(&object));
        };
        stays_ended(&mut bench, want, comes).await;
    }
}

#[tokio::test(start_paused = true)]
async fn a_lost_link_ends_a_wait() {
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    bench.hand.with(|hand, _| hand.set_object(&Object::none()));
    waiting(&mut bench).await;
    spoil(&line, Trouble::Gone(Duration::from_secs(2)));
    bench.run(9000).await;
    let ended = phase(&bench);
    let by_loss = |why| matches!(why, Abort::LinkLost | Abort::Disarmed { .. });
    assert!(
        matches!(ended, Some(PlayPhase::Ended(Err(why))) if by_loss(why)),
        "{ended:?}"
    );
    assert_eq!(bench.addresses(), [0_u16; 0]);
}

#[tokio::test(start_paused = true)]
async fn who_goes_on_after_a_pause_in_a_wait_waits_again() {
    let mut bench = Bench::live().await;
    waiting(&mut bench).await;
    bench.act(Action::Play(Play::Pause));
    bench.run(1000).await;
    assert_eq!(phase(&bench), Some(PlayPhase::Paused));
    bench.forget();
    bench.act(Action::Play(Play::Resume));
    bench.run(2000).await;
    assert_eq!(places(&bench), [300], "the same pose, and not the next");
    assert!(matches!(phase(&bench), Some(PlayPhase::Waiting { .. })));
}
