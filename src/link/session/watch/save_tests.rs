//! Every interleaving of two SAVEs, their frames, a stop and a lost link on a small model: what is said is true.

use crate::codec::rs485::SaveResult;
use crate::hand::{ModbusException, Moment, Refusal};
use crate::link::bus::ResultFrame;
use crate::link::session::watch::save::{Ack, Next, SaveWatch};
use crate::record::{SaveDoubt, Saved};

/// What the model's hand does with one SAVE, times in steps after it.
#[derive(Debug, Clone, Copy)]
struct Answer {
    /// Whether its acknowledgement comes in time.
    acked: bool,
    /// What it did with its flash.
    wrote: bool,
    /// When its result comes, if it does, …
    result: Option<u64>,
    /// … and when it comes once more.
    double: Option<u64>,
}

/// A step of the model.
const STEP_MS: u64 = 100;
/// Steps after which all is over.
const STEPS: u64 = 160;

fn at(step: u64) -> Moment {
    Moment::from_micros(step * STEP_MS * 1000)
}

/// A SAVE that the hand never hears is one that is not acknowledged, not written and has no result.
fn answers() -> Vec<Answer> {
    let mut all = Vec::new();
    for acked in [true, false] {
        for wrote in [true, false] {
            for result in [None, Some(0), Some(10), Some(29), Some(31), Some(50)] {
                for double in [None, Some(1), Some(5)] {
                    // A double needs a first.
                    if double.is_some() && result.is_none() {
                        continue;
                    }
                    let double = result.zip(double).map(|(at, after)| at + after);
                    all.push(Answer {
                        acked,
                        wrote,
                        result,
                        double,
                    });
                }
            }
        }
    }
    all
}

/// One run: the second SAVE is wanted at `second`, a stop has the line for five steps from `stop`, in which nobody listens
/// for its own sake, and the link is lost at `loss` and back a step later. Gives the two verdicts and which were sent.
fn run(
    answers: [Answer; 2],
    second: u64,
    stop: Option<u64>,
    loss: Option<u64>,
) -> [Option<(Saved, u64)>; 2] {
    let mut watch = SaveWatch::default();
    let mut sent: [Option<u64>; 2] = [None, None];
    let mut ends: [Option<(Saved, u64)>; 2] = [None, None];
    let mut open: Option<usize> = None;
    for step in 0..STEPS {
        let now = at(step);
        let wanted = (
            usize::from(sent[0].is_some()),
            step >= second || sent[0].is_none(),
        );
        if let (nth @ 0..=1, true) = wanted
            && sent[nth].is_none()
            && open.is_none()
            && watch.may_send(now).is_ok()
        {
            watch.send(now, ResultFrame::Comes);
            watch.written(if answers[nth].acked {
                Ack::Acknowledged
            } else {
                Ack::Unanswered
            });
            sent[nth] = Some(step);
            open = Some(nth);
        }
        // Frames come when they come, whoever listens; while the link is down they are lost.
        if loss != Some(step) {
            for (answer, sent) in answers.iter().zip(sent) {
                let came = |after: Option<u64>| {
                    sent.zip(after)
                        .is_some_and(|(sent, after)| sent + after == step)
                };
                let frame = if answer.wrote {
                    SaveResult::Ok
                } else {
                    SaveResult::Failed
                };
                for _ in [answer.result, answer.double]
                    .into_iter()
                    .filter(|at| came(*at))
                {
                    watch.result(frame);
                }
            }
        }
        if loss == Some(step)
            && let Some(end) = watch.lost()
        {
            ends[open.take().unwrap()] = Some((end, step));
        }
        let stopping = stop.is_some_and(|stop| (stop..stop + 5).contains(&step));
        if let Some(nth) = open
            && !stopping
            && let Next::Done(end) = watch.next(now)
        {
            ends[nth] = Some((end, step));
            open = None;
        }
    }
    assert!(open.is_none(), "every SAVE comes to an end");
    ends
}

#[test]
fn in_every_interleaving_what_is_said_of_a_save_is_true_of_that_save() {
    let answers = answers();
    let (mut confirmed, mut failed, mut unknown, mut runs) = (0, 0, 0, 0_u64);
    for first in &answers {
        for other in &answers {
            for second in [1, 5, 12, 31, 40, 61] {
                for stop in [None, Some(1), Some(9), Some(28)] {
                    for loss in [None, Some(0), Some(10), Some(30)] {
                        let ends = run([*first, *other], second, stop, loss);
                        runs += 1;
                        for (end, answer) in ends.iter().zip([first, other]) {
                            let (end, _) = end.as_ref().unwrap();
                            match end {
                                Saved::Confirmed => {
                                    confirmed += 1;
                                    assert!(answer.wrote && answer.result.is_some());
                                }
                                Saved::Failed { code: 0xFF } => {
                                    failed += 1;
                                    assert!(!answer.wrote && answer.result.is_some());
                                }
                                Saved::Unknown { .. } => unknown += 1,
                                other => unreachable!("{other:?}"),
                            }
                        }
                    }
                }
            }
        }
    }
    assert!(
        confirmed > runs / 10 && failed > runs / 10 && unknown > runs / 10,
        "{confirmed} {failed} {unknown} of {runs}"
    );
}

#[test]
fn a_result_in_time_is_always_said_and_without_loss_nothing_takes_longer_than_three_seconds_and_the_stop()
 {
    for answer in answers() {
        for stop in [None, Some(1), Some(9), Some(28)] {
            let [Some((end, ended)), _] = run([answer, answer], 70, stop, None) else {
                unreachable!("the first is sent at once");
            };
            let in_time = answer.result.is_some_and(|at| at < 30);
            assert_eq!(
                matches!(end, Saved::Confirmed | Saved::Failed { .. }),
                in_time || answer.result == Some(31) && stop == Some(28),
                "{answer:?} {stop:?}"
            );
            assert!(ended <= if stop == Some(28) { 33 } else { 30 });
        }
    }
}

#[test]
fn without_a_result_frame_the_parameters_are_read_back_and_no_frame_counts() {
    for (ack, same, expected) in [
        (Ack::Acknowledged, true, Saved::ReadBack),
        (
            Ack::Acknowledged,
            false,
            Saved::Unknown {
                why: SaveDoubt::NotReadBack,
            },
        ),
        (
            Ack::Unanswered,
            true,
            Saved::Unknown {
                why: SaveDoubt::Unanswered,
            },
        ),
    ] {
        let mut watch = SaveWatch::default();
        watch.send(at(0), ResultFrame::None);
        watch.written(ack);
        watch.result(SaveResult::Ok);
        assert!(matches!(watch.next(at(11)), Next::Listen { .. }));
        assert_eq!(watch.next(at(12)), Next::ReadBack);
        watch.read_back(same);
        assert_eq!(watch.next(at(13)), Next::Done(expected));
    }
    let mut watch = SaveWatch::default();
    watch.send(at(0), ResultFrame::None);
    let reason = Refusal::Exception(ModbusException::Failure);
    watch.written(Ack::Refused { reason });
    assert_eq!(watch.next(at(0)), Next::Done(Saved::Refused { reason }));
}
