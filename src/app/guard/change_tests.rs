//! Every order of losses, power cuts and answers in a change of place, against a hand of three facts.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may")]

use crate::app::guard::change::{Change, End, Follow, KEEP_WITHIN, Next, Stage};
use crate::app::params::guard::Place;
use crate::app::params::table::{ParamId, Value};
use crate::hand::Moment;
use crate::link::{SaveDoubt, Saved};
use std::time::Duration;

const OLD: Value = Value::Number(1);
const NEW: Value = Value::Number(7);

/// When a hand acts on a new id.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Moves {
    Now,
    AfterSave,
    AfterPower,
}

/// A hand, what it holds, and what was done to it.
#[derive(Clone)]
struct Model {
    change: Change,
    /// When a hand acts on a new id.
    moves: Moves,
    holds: Value,
    flash: Value,
    writes: u8,
    /// Answers, writes and acknowledgements that may still get lost.
    losses: u8,
    lost: u8,
    cuts: u8,
    looks: Vec<(Place, bool)>,
    steps: u32,
}

impl Model {
    fn place(&self) -> Place {
        match self.holds {
            NEW if self.moves == Moves::Now => Place::New,
            NEW if self.moves == Moves::AfterSave && self.flash == NEW => Place::New,
            _ => Place::Old,
        }
    }
}

fn start(follow: Follow, moves: Moves, losses: u8) -> Model {
    let id = match follow {
        Follow::Wire => ParamId::HandId,
        Follow::No => ParamId::IpAddress,
    };
    let mut change = Change::new(id, OLD, NEW, follow);
    assert_eq!(change.next(), Next::Person);
    change.begin();
    Model {
        change,
        moves,
        holds: OLD,
        flash: OLD,
        writes: 0,
        losses,
        lost: 0,
        cuts: 1,
        looks: Vec::new(),
        steps: 0,
    }
}

/// All that can come next.
fn successors(model: &Model) -> Vec<Model> {
    let mut out = Vec::new();
    if model.cuts > 0 && model.holds != model.flash {
        let mut cut = model.clone();
        cut.cuts -= 1;
        cut.holds = cut.flash;
        out.push(cut);
    }
    let mut add = |loses: u8, act: &dyn Fn(&mut Model)| {
        if model.losses >= loses {
            let mut next = model.clone();
            next.losses -= loses;
            next.lost += loses;
            next.steps += 1;
            act(&mut next);
            out.push(next);
        }
    };
    let now = Moment::ZERO;
    match model.change.next() {
        Next::Look(at) => {
            add(0, &|next| {
                let holds = (next.place() == at).then_some(next.holds);
                next.looks.push((at, holds.is_some()));
                next.change.heard(holds, now);
            });
            add(1, &|next| {
                next.looks.push((at, false));
                next.change.heard(None, now);
            });
        }
        Next::Write(at, value) => {
            add(0, &|next| {
                if next.place() == at {
                    next.holds = value;
                    next.writes += 1;
                }
                next.change.wrote(None);
            });
            add(1, &|next| next.change.wrote(None));
            add(1, &|next| next.change.wrote(Some("no".into())));
            add(1, &|next| next.change.unreached());
        }
        Next::Person => match model.change.stage() {
            Stage::Keeping { .. } => {
                add(0, &|next| next.change.keep());
                add(0, &|next| next.change.go_back());
                add(0, &|next| next.change.tick(now.plus(KEEP_WITHIN)));
            }
            Stage::Offering(_) => {
                add(0, &|next| next.change.save());
                add(0, &|next| next.change.leave_unsaved());
            }
            other => panic!("nobody is asked in {other:?}"),
        },
        Next::Save(_) => {
            add(0, &|next| {
                next.flash = next.holds;
                next.change.saved(Saved::Confirmed);
            });
            for is_taken in [false, true] {
                add(1, &|next| {
                    if is_taken {
                        next.flash = next.holds;
                    }
                    let why = SaveDoubt::LinkLost;
                    next.change.saved(Saved::Unknown { why });
                });
            }
            add(1, &|next| next.change.unreached());
        }
        Next::Nothing => {}
    }
    out
}

fn check(model: &Model, end: &End) {
    let last = model.looks.last().copied();
    match end {
        End::NotWritten | End::Occupied => {
            assert_eq!((model.writes, model.holds), (0, OLD));
        }
        End::NotTaken { .. } => assert_eq!(model.holds, OLD),
        // What is said was seen, or power took it back meanwhile.
        End::Back => assert_eq!(model.holds, OLD),
        End::NotBack(at) => {
            assert!(model.looks.contains(&(*at, true)));
        }
        End::Kept { at, saved } => {
            assert!(model.looks.contains(&(*at, true)));
            if *saved == Some(Saved::Confirmed) {
                assert_eq!(model.flash, model.holds);
            }
        }
        End::Unseen(_) => {
            assert_eq!(last.map(|look| look.1), Some(false));
            assert!(model.lost >= 3, "a hand that is there is found");
        }
        End::Nowhere => {
            assert_eq!(last.map(|look| look.1), Some(false));
            assert!(model.lost >= 3, "a hand that is there is found");
        }
    }
}

#[test]
fn however_answers_and_power_are_lost_the_end_is_true() {
    let (mut ends, mut kinds) = (0_u32, std::collections::BTreeSet::new());
    for (follow, moves) in [
        (Follow::Wire, Moves::Now),
        (Follow::Wire, Moves::AfterSave),
        (Follow::Wire, Moves::AfterPower),
        (Follow::No, Moves::AfterPower),
    ] {
        for losses in 0..=7 {
            let mut open = vec![start(follow, moves, losses)];
            while let Some(model) = open.pop() {
                assert!(model.steps < 60, "it comes to an end");
                assert!(model.writes <= 2, "there and back");
                if let Stage::Over(end) = model.change.stage() {
                    check(&model, end);
                    ends += 1;
                    let name = format!("{end:?}");
                    kinds.insert(name.split([' ', '(']).next().unwrap().to_owned());
                    continue;
                }
                open.extend(successors(&model));
            }
        }
    }
    assert!(ends > 1000, "{ends}");
    for kind in [
        "NotWritten",
        "NotTaken",
        "Back",
        "Kept",
        "Unseen",
        "Nowhere",
    ] {
        assert!(kinds.contains(kind), "{kinds:?}");
    }
}

#[test]
fn without_an_answer_it_goes_back_after_fifteen_seconds_and_not_before() {
    let mut change = Change::new(ParamId::HandId, OLD, NEW, Follow::Wire);
    change.begin();
    change.heard(None, Moment::ZERO);
    change.wrote(None);
    let there = Moment::ZERO.plus(Duration::from_secs(2));
    change.heard(Some(NEW), there);
    change.tick(there.plus(KEEP_WITHIN - Duration::from_millis(1)));
    assert_eq!(change.next(), Next::Person);
    change.tick(there.plus(KEEP_WITHIN));
    assert_eq!(change.next(), Next::Look(Place::New));
    change.heard(Some(NEW), there);
    assert_eq!(change.next(), Next::Look(Place::Old), "is the old id free");
    change.heard(None, there);
    assert_eq!(change.next(), Next::Write(Place::New, OLD));
    change.wrote(None);
    assert_eq!(change.next(), Next::Look(Place::Old));
    change.heard(Some(OLD), there);
    assert_eq!(*change.stage(), Stage::Over(End::Back));
}

#[test]
fn an_id_that_another_hand_has_is_not_written_over_it_on_the_way_there_or_back() {
    let mut change = Change::new(ParamId::HandId, OLD, NEW, Follow::Wire);
    change.begin();
    change.heard(Some(NEW), Moment::ZERO);
    assert_eq!(*change.stage(), Stage::Over(End::Occupied));

    let mut change = Change::new(ParamId::HandId, OLD, NEW, Follow::Wire);
    change.begin();
    change.heard(None, Moment::ZERO);
    change.wrote(None);
    change.heard(Some(NEW), Moment::ZERO);
    change.go_back();
    change.heard(Some(NEW), Moment::ZERO);
    change.heard(Some(OLD), Moment::ZERO);
    assert_eq!(*change.stage(), Stage::Over(End::NotBack(Place::New)));
}

#[test]
fn nothing_is_written_before_a_person_begins() {
    let mut change = Change::new(ParamId::HandId, OLD, NEW, Follow::Wire);
    for _ in 0..3 {
        change.keep();
        change.save();
        change.go_back();
        change.tick(Moment::ZERO.plus(Duration::from_secs(60)));
        change.heard(Some(NEW), Moment::ZERO);
        assert_eq!(change.next(), Next::Person);
    }
    change.cancel();
    change.begin();
    assert_eq!(*change.stage(), Stage::Over(End::NotWritten));
}

#[test]
fn a_third_value_is_put_back_before_anybody_can_save_it() {
    const THIRD: Value = Value::Number(3);
    for (refused, held_then, expected) in [
        (None, OLD, End::Back),
        (Some("no".to_owned()), OLD, End::Back),
        (None, THIRD, End::NotBack(Place::Old)),
    ] {
        let mut change = Change::new(ParamId::HandId, OLD, NEW, Follow::No);
        change.begin();
        change.wrote(refused);
        change.heard(Some(THIRD), Moment::ZERO);
        assert_eq!(change.next(), Next::Write(Place::Old, OLD));
        change.wrote(None);
        change.heard(Some(held_then), Moment::ZERO);
        assert_eq!(*change.stage(), Stage::Over(expected));
    }
}
