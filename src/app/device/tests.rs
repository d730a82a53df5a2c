//! The rules of reading, staging, applying and saving, on a link that only notes what it is told.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::indexing_slicing,
    reason = "a test may"
)]

use crate::app::device::book::{Doing, SaveEnd, Wanted};
use crate::app::device::keeper::FileJob;
use crate::app::device::refusal::Refusal;
use crate::app::device::wish::DeviceWish;
use crate::app::fake_link::{Bench, Told};
use crate::app::params::plan::RowVerdict;
use crate::app::params::table::{ParamId, Value};
use crate::app::params::values::SPANS;
use crate::app::state::Freshness;
use crate::hand::{Dof, Setting};
use crate::link::{
    Doubt, LinkEvent, LinkState, Outcome, Request, RequestError, Saved, Ticket, Verdict, Written,
};

const INDEX: ParamId = ParamId::DefaultSpeed(Dof::Index);

/// Every short reads 100, gentle as it is; id, serial speed and the parts of the address read 1.
fn memory(len: u16) -> Vec<u8> {
    match len {
        1 | 4 => vec![1; usize::from(len)],
        _ => 100_i16.to_le_bytes().repeat(usize::from(len / 2)),
    }
}

impl Bench {
    fn wish(&mut self, wish: &DeviceWish) {
        let now = self.now();
        self.desk.device(wish, now);
    }

    fn answer(&mut self, result: Result<Outcome, RequestError>) {
        let ticket = Ticket(7);
        let done = LinkEvent::Done { ticket, result };
        self.wire.borrow_mut().events.push_back(done);
        self.step();
    }

    fn asked(&self) -> Vec<Request> {
        let asked = self.told().into_iter().map(|told| match told {
            Told::Ask(request) => request,
            other => panic!("{other:?}"),
        });
        asked.collect()
    }

    /// Answers the reads of all groups, one after the other.
    fn answer_reads(&mut self) {
        for span in SPANS {
            assert_eq!(self.asked(), [Request::Read(span)]);
            let bytes = memory(span.len);
            self.answer(Ok(Outcome::Memory { span, bytes }));
        }
    }

    fn read(&mut self) {
        self.wish(&DeviceWish::Read);
        self.answer_reads();
    }

    /// Answers the write that was asked, with what the hand holds then for every joint.
    fn answer_write(&mut self, verdict: Verdict, holds: Option<i16>) {
        let asked = self.asked();
        let [Request::Set(setting)] = asked.as_slice() else {
            panic!("{asked:?}");
        };
        let holds = holds.map(|raw| raw.to_le_bytes().repeat(6));
        let span = setting.span();
        let written = Written {
            span,
            verdict,
            holds,
        };
        self.answer(Ok(Outcome::Written(written)));
    }

    fn stage(&mut self, id: ParamId, number: i32) {
        self.desk.stage(id, Some(Value::Number(number)));
    }

    fn live(&self, id: ParamId) -> Option<Value> {
        self.desk.state.device.live(id).map(|(value, _)| value)
    }

    fn verdict(&self, id: ParamId) -> Option<&'static str> {
        self.desk.state.device.end(id).map(|end| end.verdict.name())
    }
}

#[test]
fn connecting_staging_and_copying_ask_the_hand_for_nothing() {
    let mut bench = Bench::monitoring(500);
    bench.stage(INDEX, 250);
    bench.wish(&DeviceWish::CopyLive(None));
    bench.wish(&DeviceWish::StageTicked);
    bench.wish(&DeviceWish::Tick(INDEX));
    bench.step();
    assert_eq!(bench.asked(), []);
    let book = &bench.desk.state.device;
    assert_eq!(book.staged(INDEX), Some(Value::Number(250)));
    assert_eq!(bench.live(INDEX), None);
    let freshness = bench.desk.state.param_freshness(INDEX);
    assert_eq!(freshness, Freshness::Unknown);
}

#[test]
fn what_may_not_be_written_is_not_staged() {
    let mut bench = Bench::monitoring(500);
    for (id, number) in [
        (INDEX, 1001),
        (INDEX, -1),
        (ParamId::HandId, 0),
        (ParamId::ReduRatio, 4),
    ] {
        bench.stage(id, number);
        assert_eq!(bench.desk.state.device.staged(id), None, "{id:?} {number}");
    }
    bench.stage(INDEX, 1000);
    bench.stage(INDEX, 1001);
    let staged = bench.desk.state.device.staged(INDEX);
    assert_eq!(staged, Some(Value::Number(1000)), "the last good one stays");
    bench.desk.stage(INDEX, None);
    assert_eq!(bench.desk.state.device.staged(INDEX), None);
}

#[test]
fn a_reading_asks_every_group_once_and_old_values_are_told_apart() {
    let mut bench = Bench::monitoring(500);
    bench.read();
    assert_eq!(bench.asked(), []);
    assert_eq!(bench.live(INDEX), Some(Value::Number(100)));
    assert_eq!(bench.desk.state.param_freshness(INDEX), Freshness::Live);
    bench.millis += 61_000;
    bench.step();
    assert_eq!(bench.desk.state.param_freshness(INDEX), Freshness::Stale);
    bench.read();
    assert_eq!(bench.desk.state.param_freshness(INDEX), Freshness::Live);
    bench.state(LinkState::Offline);
    bench.step();
    bench.state(LinkState::Monitoring);
    bench.step();
    assert_eq!(
        bench.desk.state.param_freshness(INDEX),
        Freshness::Stale,
        "the hand that came back may hold something else"
    );
    assert!(bench.desk.state.device.is_due(bench.now()));
}

#[test]
fn a_group_that_gives_no_answer_is_asked_again_and_then_left() {
    let mut bench = Bench::monitoring(500);
    bench.wish(&DeviceWish::Read);
    let error = RequestError::Timeout {
        address: SPANS[0].address,
        after_ms: 100,
    };
    for _ in 0..4 {
        assert_eq!(bench.asked(), [Request::Read(SPANS[0])]);
        bench.answer(Err(error.clone()));
        bench.millis += 200;
        bench.step();
    }
    for span in &SPANS[1..] {
        assert_eq!(bench.asked(), [Request::Read(*span)]);
        let bytes = memory(span.len);
        bench.answer(Ok(Outcome::Memory { span: *span, bytes }));
    }
    let book = &bench.desk.state.device;
    assert_eq!((book.doing, &book.trouble), (Doing::Nothing, &Some(error)));
    assert_eq!(
        (bench.live(ParamId::HandId), bench.live(INDEX)),
        (None, Some(Value::Number(100)))
    );
}

#[test]
fn apply_reads_first_writes_what_differs_and_undo_puts_it_back() {
    let mut bench = Bench::monitoring(500);
    bench.stage(INDEX, 50);
    bench.stage(ParamId::DefaultSpeed(Dof::Ring), 100);
    bench.stage(ParamId::HandId, 9);
    bench.wish(&DeviceWish::Apply);
    bench.answer_reads();
    let asked = bench.asked();
    let [Request::Set(Setting::DefaultSpeeds(speeds))] = asked.as_slice() else {
        panic!("{asked:?}");
    };
    let written: Vec<_> = speeds.iter().filter(|(_, speed)| speed.is_some()).collect();
    assert_eq!(written.len(), 1, "only the row that differs");
    let mut bytes = 100_i16.to_le_bytes().repeat(6);
    bytes[6..8].copy_from_slice(&50_i16.to_le_bytes());
    let written = Written {
        span: Setting::DefaultSpeeds(*speeds).span(),
        verdict: Verdict::Applied,
        holds: Some(bytes),
    };
    bench.answer(Ok(Outcome::Written(written)));
    assert_eq!(bench.live(INDEX), Some(Value::Number(50)));
    assert_eq!(bench.verdict(INDEX), Some("applied"));
    assert_eq!(
        bench.verdict(ParamId::DefaultSpeed(Dof::Ring)),
        Some("applied")
    );
    let book = &bench.desk.state.device;
    assert_eq!(book.staged(INDEX), None);
    assert_eq!(
        book.staged(ParamId::HandId),
        Some(Value::Number(9)),
        "where the hand is goes another way"
    );
    assert_eq!(book.undo.get(INDEX), Some(Value::Number(100)));

    bench.wish(&DeviceWish::Undo);
    let staged = bench.desk.state.device.staged(INDEX);
    assert_eq!(staged, Some(Value::Number(100)));
    for span in SPANS {
        assert_eq!(bench.asked(), [Request::Read(span)]);
        let mut bytes = memory(span.len);
        if span == SPANS[2] {
            bytes[6..8].copy_from_slice(&50_i16.to_le_bytes());
        }
        bench.answer(Ok(Outcome::Memory { span, bytes }));
    }
    bench.answer_write(Verdict::Applied, Some(100));
    assert_eq!(bench.live(INDEX), Some(Value::Number(100)));
}

#[test]
fn a_row_that_was_not_taken_shows_what_the_hand_holds() {
    let refused = Verdict::Refused {
        reason: "0x04".into(),
    };
    for (verdict, holds, name) in [
        (refused, 100, "refused"),
        (Verdict::Differs, 100, "dropped"),
        (Verdict::Differs, 70, "altered"),
    ] {
        let mut bench = Bench::monitoring(500);
        bench.stage(INDEX, 50);
        bench.wish(&DeviceWish::Apply);
        bench.answer_reads();
        bench.answer_write(verdict, Some(holds));
        assert_eq!(bench.verdict(INDEX), Some(name));
        assert_eq!(bench.live(INDEX), Some(Value::Number(i32::from(holds))));
        assert_eq!(bench.desk.state.device.staged(INDEX), None);
    }
}

#[test]
fn what_could_not_be_verified_is_read_once_more_and_else_not_known() {
    let why = Doubt::NotReadBack;
    let unverified = Verdict::Unverified { why };
    let mut bench = Bench::monitoring(500);
    bench.stage(INDEX, 50);
    bench.wish(&DeviceWish::Apply);
    bench.answer_reads();
    bench.answer_write(unverified.clone(), None);
    assert_eq!(
        (bench.live(INDEX), bench.verdict(INDEX)),
        (None, Some("unverified"))
    );
    bench.answer_reads();
    assert_eq!(
        bench.verdict(INDEX),
        Some("dropped"),
        "it holds what it held"
    );
    assert!(bench.desk.state.device.undo.is_empty());

    let mut bench = Bench::monitoring(500);
    bench.stage(INDEX, 50);
    bench.wish(&DeviceWish::Apply);
    bench.answer_reads();
    bench.answer_write(unverified, None);
    for span in SPANS {
        assert_eq!(bench.asked(), [Request::Read(span)]);
        bench.answer(Err(RequestError::Refused {
            address: span.address,
            reason: "no".into(),
        }));
    }
    assert_eq!(
        (bench.live(INDEX), bench.verdict(INDEX)),
        (None, Some("unverified"))
    );
    let book = &bench.desk.state.device;
    assert_eq!(
        book.staged(INDEX),
        Some(Value::Number(50)),
        "the wish stays"
    );
    assert_eq!(
        book.undo.get(INDEX),
        Some(Value::Number(100)),
        "it may have changed"
    );
}

#[test]
fn nothing_is_written_on_the_strength_of_a_row_that_cannot_be_read() {
    let mut bench = Bench::monitoring(500);
    bench.stage(INDEX, 50);
    bench.wish(&DeviceWish::Apply);
    for span in SPANS {
        assert_eq!(bench.asked(), [Request::Read(span)]);
        let bytes = memory(span.len);
        let refused = RequestError::Refused {
            address: span.address,
            reason: "no".into(),
        };
        bench.answer(if span == SPANS[2] {
            Err(refused)
        } else {
            Ok(Outcome::Memory { span, bytes })
        });
    }
    assert_eq!(bench.asked(), []);
    let book = &bench.desk.state.device;
    assert!(book.trouble.is_some() && !book.is_busy());
    assert_eq!(book.staged(INDEX), Some(Value::Number(50)));
}

#[test]
fn what_could_hurt_is_asked_first_and_written_only_when_meant() {
    let mut bench = Bench::monitoring(500);
    bench.stage(INDEX, 1000);
    bench.stage(ParamId::DefaultForce(Dof::Index), 1000);
    bench.wish(&DeviceWish::Apply);
    bench.answer_reads();
    assert_eq!(bench.asked(), [], "nothing before the answer");
    let question = bench.desk.state.device.question.clone().unwrap();
    assert!(matches!(question.what, Wanted::Apply(_)));
    assert_eq!(
        question
            .dangers
            .iter()
            .map(|danger| danger.dof)
            .collect::<Vec<_>>(),
        [Dof::Index]
    );
    bench.wish(&DeviceWish::Decline);
    bench.wish(&DeviceWish::Agree);
    assert_eq!(bench.asked(), []);

    bench.wish(&DeviceWish::Apply);
    bench.answer_reads();
    bench.wish(&DeviceWish::Agree);
    bench.answer_reads();
    bench.answer_write(Verdict::Applied, Some(1000));
    bench.answer_write(Verdict::Applied, Some(1000));
    assert_eq!(bench.verdict(INDEX), Some("applied"));
}

#[test]
fn no_write_begins_while_the_hand_is_armed_or_something_is_under_way() {
    let mut bench = Bench::armed(500);
    bench.stage(INDEX, 50);
    bench.wish(&DeviceWish::Apply);
    bench.wish(&DeviceWish::Save);
    assert_eq!(bench.asked(), []);
    assert_eq!(bench.desk.state.apply_refusal(), Some(Refusal::Armed));

    let mut bench = Bench::monitoring(500);
    assert_eq!(
        bench.desk.state.apply_refusal(),
        Some(Refusal::NothingStaged)
    );
    bench.stage(INDEX, 50);
    bench.wish(&DeviceWish::Apply);
    bench.wish(&DeviceWish::Apply);
    bench.wish(&DeviceWish::Read);
    assert_eq!(bench.asked(), [Request::Read(SPANS[0])], "one at a time");
    assert_eq!(bench.desk.state.write_refusal(), Some(Refusal::Busy));
}

#[test]
fn no_save_goes_out_without_a_backup_and_its_result_is_noted() {
    let saves = || {
        let mut bench = Bench::monitoring(500);
        assert_eq!(bench.desk.state.save_refusal(), Some(Refusal::NoFolder));
        bench.desk.state.device.folder = Some("/somewhere".into());
        bench.wish(&DeviceWish::Save);
        bench.answer_reads();
        assert_eq!(bench.asked(), []);
        let params = bench.desk.state.device.live_params();
        assert_eq!(bench.desk.work.files.take(), Some(FileJob::Before(params)));
        bench
    };
    let mut bench = saves();
    let failed = SaveEnd::NoBackup {
        message: "no room".into(),
    };
    bench.desk.backed_up(Err(failed.clone()), bench.now());
    assert_eq!(bench.asked(), []);
    assert_eq!(bench.desk.state.device.save.clone().unwrap().0, failed);

    let mut bench = saves();
    bench.desk.backed_up(Ok(()), bench.now());
    assert_eq!(bench.asked(), [Request::Save]);
    assert_eq!(bench.desk.state.device.doing, Doing::Saving);
    bench.answer(Ok(Outcome::Saved(Saved::Confirmed)));
    assert_eq!(
        bench.desk.work.files.take(),
        Some(FileJob::After(Saved::Confirmed))
    );
    bench.desk.noted(Ok(()), bench.now());
    let end = bench.desk.state.device.save.clone().unwrap().0;
    assert_eq!(end, SaveEnd::Told(Saved::Confirmed));
    assert!(!bench.desk.state.device.is_busy());
}

#[test]
fn another_hand_takes_over_nothing_of_the_old_one() {
    let mut bench = Bench::monitoring(500);
    bench.read();
    bench.stage(INDEX, 50);
    bench.wish(&DeviceWish::Apply);
    bench.desk.replace(None, None, bench.now());
    let book = &bench.desk.state.device;
    assert!(book.all_staged().is_empty() && book.live(INDEX).is_none() && !book.is_busy());
    assert!(!matches!(
        book.end(INDEX).map(|end| &end.verdict),
        Some(RowVerdict::Applied)
    ));
}
