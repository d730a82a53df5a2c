//! A change of what a hand is found by on a bus, so that nobody is left with a hand they cannot reach: look whether the new place is
//! free, write, look at the new place and at the old one. Pure; asks nobody itself.

use crate::app::params::table::{ParamId, Value};
use crate::hand::SerialSpeed;
use crate::transport::Endpoint;

/// Rounds of looking after the write: a hand that changes its speed may need a moment.
const ROUNDS: u8 = 3;

/// Where the hand is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// Where it was.
    Old,
    /// Where it will be, if the change acts at once.
    New,
}

impl Place {
    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Old => Self::New,
            Self::New => Self::Old,
        }
    }
}

/// What is to be done now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Look for a hand there, and read what it holds.
    Look(Place),
    /// Write, at the old place.
    Write,
    /// It is over.
    Over(Moved),
}

/// How the change ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Moved {
    /// Another hand answers at the new place. Nothing was written.
    Occupied,
    /// The hand said no, and is where it was.
    Refused {
        /// The protocol's word for it.
        reason: String,
    },
    /// The hand answers at the new place.
    There,
    /// The hand answers at the old place and holds the new value: it acts at a SAVE or at the next power-up.
    Waits,
    /// The hand answers at the old place and holds what it held.
    Stayed,
    /// No hand answers at either place.
    Nowhere,
}

impl Moved {
    /// The stable word for JSON.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Occupied => "occupied",
            Self::Refused { .. } => "refused",
            Self::There => "moved",
            Self::Waits => "waits",
            Self::Stayed => "stayed",
            Self::Nowhere => "nowhere",
        }
    }
}

/// One change under way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Guard {
    wanted: Value,
    step: Step,
    rounds: u8,
    /// Whether a change can act at once, so that the hand is looked for at the new place after the write.
    is_followed: bool,
    is_written: bool,
    refused: Option<String>,
}

impl Guard {
    /// Begins. A new id may be another hand's, so it is looked for first; a hand of another serial speed cannot be heard here.
    #[must_use]
    pub const fn new(id: ParamId, wanted: Value) -> Self {
        let step = match id {
            ParamId::HandId => Step::Look(Place::New),
            _ => Step::Write,
        };
        Self {
            wanted,
            step,
            rounds: ROUNDS,
            is_followed: true,
            is_written: false,
            refused: None,
        }
    }

    /// Begins a change that cannot act before the next power-up, or that this wire does not find the hand by: only the
    /// place where the hand is now is looked at.
    #[must_use]
    pub const fn staying(wanted: Value) -> Self {
        Self {
            wanted,
            step: Step::Write,
            rounds: ROUNDS,
            is_followed: false,
            is_written: false,
            refused: None,
        }
    }

    /// What is to be done now.
    #[must_use]
    pub const fn step(&self) -> &Step {
        &self.step
    }

    /// The write went out; with a reason if it was refused. An answer that is missing proves nothing.
    pub fn wrote(&mut self, refused: Option<String>) {
        self.is_written = true;
        self.step = Step::Look(match refused {
            None if self.is_followed => Place::New,
            _ => Place::Old,
        });
        self.refused = refused;
    }

    /// Someone answers where was looked, and holds this; or nobody does.
    pub fn heard(&mut self, holds: Option<Value>) {
        let Step::Look(place) = self.step else {
            return;
        };
        self.step = match (self.is_written, place, holds) {
            (false, _, Some(_)) => Step::Over(Moved::Occupied),
            (false, _, None) => Step::Write,
            (true, Place::New, Some(_)) => Step::Over(Moved::There),
            (true, Place::New, None) => Step::Look(Place::Old),
            (true, Place::Old, Some(holds)) => Step::Over(match self.refused.take() {
                _ if holds == self.wanted => Moved::Waits,
                Some(reason) => Moved::Refused { reason },
                None => Moved::Stayed,
            }),
            (true, Place::Old, None) => {
                self.rounds -= 1;
                match self.rounds {
                    0 => Step::Over(Moved::Nowhere),
                    _ if self.is_followed => Step::Look(Place::New),
                    _ => Step::Look(Place::Old),
                }
            }
        };
    }
}

/// Where the hand will be found over the same wire; none if this row does not say it there, or this wire cannot follow.
#[must_use]
pub fn new_place(hand: &Endpoint, id: ParamId, wanted: Value) -> Option<Endpoint> {
    let Value::Number(number) = wanted else {
        return None;
    };
    let byte = u8::try_from(number).ok()?;
    let mut place = hand.clone();
    match (&mut place, id) {
        (Endpoint::Rs485(line) | Endpoint::Rtu(line), ParamId::HandId) => line.id = byte,
        (Endpoint::Rs485(line) | Endpoint::Rtu(line), ParamId::ReduRatio) => {
            let mut speeds = SerialSpeed::ALL.into_iter();
            line.baud = speeds.find(|speed| speed.code() == byte)?.baud();
        }
        (Endpoint::Can { id: at, .. } | Endpoint::Slcan { id: at, .. }, ParamId::HandId) => {
            *at = u16::from(byte);
        }
        _ => return None,
    }
    Some(place)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    const OLD: Value = Value::Number(1);
    const NEW: Value = Value::Number(7);

    /// Runs a change where these answer: before, and at each look after the write.
    fn run(
        before: Option<Value>,
        refused: bool,
        after: &[(Option<Value>, Option<Value>)],
    ) -> (Moved, u32) {
        let mut guard = Guard::new(ParamId::HandId, NEW);
        let (mut writes, mut rounds) = (0, after.iter());
        let mut round = (None, None);
        for _ in 0..40 {
            match guard.step().clone() {
                Step::Over(moved) => return (moved, writes),
                Step::Write => {
                    writes += 1;
                    guard.wrote(refused.then(|| "no".into()));
                }
                Step::Look(Place::New) if writes == 0 => guard.heard(before),
                Step::Look(Place::New) => {
                    round = rounds.next().copied().unwrap_or_default();
                    guard.heard(round.0);
                }
                Step::Look(Place::Old) if refused => {
                    guard.heard(after.first().and_then(|round| round.1))
                }
                Step::Look(Place::Old) => guard.heard(round.1),
            }
        }
        unreachable!("every change comes to an end");
    }

    #[test]
    fn every_end_of_a_change_is_told_as_it_is_and_nothing_is_written_twice() {
        let reason = String::from("no");
        for (before, refused, after, expected, writes) in [
            (Some(NEW), false, &[][..], Moved::Occupied, 0),
            (None, false, &[(Some(NEW), None)], Moved::There, 1),
            (None, false, &[(None, Some(NEW))], Moved::Waits, 1),
            (None, false, &[(None, Some(OLD))], Moved::Stayed, 1),
            (
                None,
                false,
                &[(None, None), (None, None), (Some(NEW), None)],
                Moved::There,
                1,
            ),
            (
                None,
                false,
                &[(None, None), (None, Some(OLD))],
                Moved::Stayed,
                1,
            ),
            (None, false, &[], Moved::Nowhere, 1),
            (
                None,
                true,
                &[(None, Some(OLD))],
                Moved::Refused { reason },
                1,
            ),
            (None, true, &[(None, Some(NEW))], Moved::Waits, 1),
        ] {
            assert_eq!(
                run(before, refused, after),
                (expected, writes),
                "{before:?} {refused} {after:?}"
            );
        }
    }

    #[test]
    fn whoever_answers_in_whatever_order_the_end_is_true() {
        let answers = [None, Some(OLD), Some(NEW)];
        let mut ends = 0;
        for new in answers {
            for old in answers {
                for later_new in answers {
                    for later_old in answers {
                        let after = [(new, old), (later_new, later_old)];
                        let (moved, writes) = run(None, false, &after);
                        assert_eq!(writes, 1);
                        let heard_new = new.is_some() || old.is_none() && later_new.is_some();
                        assert_eq!(moved == Moved::There, heard_new, "{after:?}");
                        ends += 1;
                    }
                }
            }
        }
        assert_eq!(ends, 81);
    }

    #[test]
    fn a_change_that_waits_for_power_is_looked_for_only_where_the_hand_is() {
        for (holds, expected) in [
            (Some(NEW), Moved::Waits),
            (Some(OLD), Moved::Stayed),
            (None, Moved::Nowhere),
        ] {
            let mut guard = Guard::staying(NEW);
            assert_eq!(*guard.step(), Step::Write);
            guard.wrote(None);
            while !matches!(guard.step(), Step::Over(_)) {
                assert_eq!(*guard.step(), Step::Look(Place::Old));
                guard.heard(holds);
            }
            assert_eq!(*guard.step(), Step::Over(expected));
        }
    }

    #[test]
    fn the_new_place_is_on_the_same_wire_and_unknown_where_it_cannot_follow() {
        let place = |hand: &str, id, number| {
            let hand = hand.parse().unwrap();
            new_place(&hand, id, Value::Number(number)).map(|place| place.to_string())
        };
        let rtu = "rtu:/dev/x?baud=115200&id=1";
        let at = |text: &str| text.parse::<Endpoint>().ok().map(|place| place.to_string());
        assert_eq!(
            place(rtu, ParamId::HandId, 7),
            at("rtu:/dev/x?baud=115200&id=7")
        );
        assert_eq!(
            place(rtu, ParamId::ReduRatio, 2),
            at("rtu:/dev/x?baud=19200&id=1")
        );
        assert_eq!(
            place("slcan:/dev/x?id=1", ParamId::HandId, 7),
            at("slcan:/dev/x?id=7")
        );
        assert_eq!(place("slcan:/dev/x?id=1", ParamId::ReduRatio, 1), None);
        assert_eq!(place("tcp:h", ParamId::HandId, 7), None);
        assert_eq!(place(rtu, ParamId::ReduRatio, 4), None);
    }
}
