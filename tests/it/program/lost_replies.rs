//! One reply that is lost on the way costs a moment and nothing else: every wire, dump, apply and save.

use crate::program::spoil;
use crate::setup::hand;
use crate::setup::line::{Dialled, Line, Trouble};
use crate::setup::link::{config, opened};
use handscope::hand::{Dof, PerDof, Setting, Speed};
use handscope::link::{LinkHandle, RequestError, open};
use handscope::params::backups::Backups;
use handscope::params::rows::{ParamId, Value};
use handscope::params::values::Params;
use handscope::record::{SaveDoubt, Saved, Verdict};
use handscope::sim::{Personality, SaveAnswer};
use handscope::tasks::apply::{Apply, Otherwise, apply};
use handscope::tasks::hand::{REACH_TIMEOUT, answers};
use handscope::tasks::read::rows;
use handscope::tasks::save::{Save, save};
use handscope::tasks::{Question, Risks};
use handscope::transport::{Pipe, pair};
use std::sync::Arc;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::runtime::Handle;
use tokio::time::{Duration, Instant, sleep};

const WIRES: [&str; 4] = ["rs485:x", "rtu:x", "tcp:x", "can:x"];
const INDEX: ParamId = ParamId::DefaultSpeed(Dof::Index);

async fn on_line(wire: &str) -> (LinkHandle, Arc<Line>) {
    let mut line = Line::new(Personality::default(), 1032, Trouble::None);
    line.nth = 0;
    let line = Arc::new(line);
    let (link, _) = open(
        config(wire, Arc::new(Dialled(Arc::clone(&line)))),
        &Handle::current(),
    );
    assert!(answers(&link, REACH_TIMEOUT).await);
    sleep(Duration::from_secs(1)).await;
    (link, line)
}

/// Loses one answer after so long.
fn lose_after(line: &Arc<Line>, wait: Duration) {
    let line = Arc::clone(line);
    tokio::spawn(async move {
        sleep(wait).await;
        spoil(&line, Trouble::LoseAnswer);
    });
}

#[tokio::test(start_paused = true)]
async fn one_lost_reply_makes_no_dump_fail() {
    for wire in WIRES {
        let (link, line) = on_line(wire).await;
        let mut longest = Duration::ZERO;
        for ms in (0..36).step_by(3) {
            lose_after(&line, Duration::from_millis(ms));
            let begun = Instant::now();
            let read = rows(&link, |_, _| ()).await;
            assert_eq!(read.troubles, [], "{wire} after {ms} ms");
            assert_eq!(read.params.iter().count(), ParamId::all().len());
            longest = longest.max(begun.elapsed());
            sleep(Duration::from_secs(3)).await;
        }
        assert!(
            longest >= Duration::from_millis(200),
            "{wire}: an answer to a row was lost, {longest:?}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn one_lost_reply_makes_neither_apply_nor_save_fail() {
    for wire in WIRES {
        let (link, line) = on_line(wire).await;
        let folder = tempfile::tempdir().unwrap();
        let backups = Backups::new(folder.path(), &wire.parse().unwrap());
        for (ms, speed) in (0..60).step_by(15).zip(100..) {
            let mut wanted = Params::default();
            wanted.put(INDEX, Value::Number(speed));
            let task = Apply {
                overshoot: std::sync::Arc::default(),
                wanted,
                agreed: Risks::default(),
                backups: Some(backups.clone()),
                otherwise: Otherwise::Undo,
            };
            lose_after(&line, Duration::from_millis(ms));
            let applied = apply(&link, &task, &mut |_: &Question| true, |_| ())
                .await
                .unwrap();
            assert!(applied.is_whole(), "{wire} after {ms} ms: {applied:?}");
            sleep(Duration::from_secs(5)).await;
            let task = Save {
                overshoot: std::sync::Arc::default(),
                backups: backups.clone(),
                before: applied.before,
                agreed: Risks::default(),
            };
            lose_after(&line, Duration::from_millis(ms));
            let saved = save(&link, &task, &mut |_: &Question| true, |_| ())
                .await
                .unwrap();
            let unanswered = Saved::Unknown {
                why: SaveDoubt::Unanswered,
            };
            // The acknowledgement of SAVE itself is all there is on wires without a result.
            let is_known = matches!(saved.saved, Saved::Confirmed | Saved::ReadBack);
            let may_be_unknown = wire != "rs485:x" && saved.saved == unanswered;
            assert!(
                is_known || may_be_unknown,
                "{wire} after {ms} ms: {saved:?}"
            );
            sleep(Duration::from_secs(10)).await;
        }
    }
}

/// A line on which every acknowledgement of a write to SAVE says 0.
async fn nulled(mut ours: Pipe, mut hands: Pipe) {
    let ack = |value: u8| {
        let mut frame = vec![0x90, 0xEB, 1, 4, 0x12, 0xED, 0x03, value];
        let sum = frame[2..]
            .iter()
            .fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        frame.push(sum);
        frame
    };
    let (mut asked, mut answered) = ([0; 512], [0; 512]);
    loop {
        tokio::select! {
            read = hands.read(&mut answered) => {
                let Ok(len @ 1..) = read else { return };
                let frame = match answered[..len] == ack(1)[..] {
                    true => ack(0),
                    false => answered[..len].to_vec(),
                };
                if ours.write_all(&frame).await.is_err() { return }
            }
            read = ours.read(&mut asked) => {
                let Ok(len @ 1..) = read else { return };
                if hands.write_all(&asked[..len]).await.is_err() { return }
            }
        }
    }
}

#[tokio::test(start_paused = true)]
async fn an_acknowledgement_of_0_is_no_result_of_a_save() {
    for (save_frame, expected) in [
        (
            SaveAnswer::Never,
            Saved::Unknown {
                why: SaveDoubt::Unanswered,
            },
        ),
        (SaveAnswer::Command12, Saved::Confirmed),
        (SaveAnswer::Failed, Saved::Failed { code: 0xFF }),
    ] {
        let personality = Personality {
            save_frame,
            ..Personality::default()
        };
        let hand = hand::shared(hand::like(personality));
        let dial = crate::setup::link::dial(move |endpoint| {
            let (near, ours) = pair();
            let (far, at_hand) = pair();
            hand::serve(hand.clone(), endpoint, at_hand);
            tokio::spawn(nulled(ours, far));
            opened(near)
        });
        let (link, _) = open(config("rs485:x", dial), &Handle::current());
        assert!(answers(&link, REACH_TIMEOUT).await);
        sleep(Duration::from_secs(1)).await;
        assert_eq!(link.save().await, Ok(expected), "{save_frame:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_setting_is_verified_though_its_answer_is_lost() {
    for wire in WIRES {
        let (link, line) = on_line(wire).await;
        for speed in 100..104 {
            lose_after(&line, Duration::from_millis(5));
            let speeds = PerDof::splat(Some(Speed::nearest(speed)));
            let setting = Setting::DefaultSpeeds(speeds);
            let written = link.set_kept(setting).await;
            let verdict = written.map(|written| written.verdict);
            let is_refused = matches!(verdict, Err(RequestError::Ambiguous { .. }));
            assert!(
                !is_refused && verdict == Ok(Verdict::Applied),
                "{wire}: {verdict:?}"
            );
            sleep(Duration::from_secs(3)).await;
        }
    }
}
