//! A return to the factory's parameters, from the question to where the hand answers then. Pure.

use crate::app::params::guard::Place;
use crate::app::params::table::{ParamId, Value};
use crate::app::params::values::Params;
use crate::hand::SerialSpeed;
use crate::link::{NotSent, Reset};
use crate::transport::Endpoint;

/// Rounds of looking for the hand: one that starts again needs a few seconds.
const ROUNDS: u8 = 3;

/// Where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ResetStage {
    /// A person is asked.
    Asking,
    /// RESET_PARA is under way.
    Sending,
    /// The hand is looked for there; the new place is the factory's.
    Finding(Place),
    /// It is over.
    Over(ResetEnd),
}

/// How it ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ResetEnd {
    /// A person said no, or nothing could be sent.
    NotSent(Option<NotSent>),
    /// The hand said no.
    Refused {
        /// The protocol's word for it.
        reason: String,
    },
    /// A hand answers there.
    Found {
        /// Where.
        at: Place,
        /// Rows that are not as at delivery.
        left: Vec<ParamId>,
    },
    /// No hand answers at either place.
    Nowhere,
}

/// One return to the factory's parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactoryReset {
    stage: ResetStage,
    rounds: u8,
    /// The factory's place is another one than that of now.
    moves: bool,
}

impl FactoryReset {
    /// Asks first.
    #[must_use]
    pub fn new(hand: &Endpoint) -> Self {
        Self {
            stage: ResetStage::Asking,
            rounds: ROUNDS,
            moves: factory_place(hand) != *hand,
        }
    }

    /// Where it stands.
    #[must_use]
    pub const fn stage(&self) -> &ResetStage {
        &self.stage
    }

    /// A person said yes.
    pub fn begin(&mut self) {
        if self.stage == ResetStage::Asking {
            self.stage = ResetStage::Sending;
        }
    }

    /// A person said no, or nothing could be sent.
    pub fn cancel(&mut self) {
        if matches!(self.stage, ResetStage::Asking | ResetStage::Sending) {
            self.stage = ResetStage::Over(ResetEnd::NotSent(None));
        }
    }

    /// What came of sending it.
    pub fn sent(&mut self, reset: Reset) {
        if self.stage != ResetStage::Sending {
            return;
        }
        self.stage = match reset {
            Reset::NotSent(why) => ResetStage::Over(ResetEnd::NotSent(Some(why))),
            Reset::Refused { reason } => ResetStage::Over(ResetEnd::Refused { reason }),
            // Without an answer it may have acted.
            Reset::Acknowledged | Reset::Unanswered => ResetStage::Finding(Place::New),
        };
    }

    /// Someone answers where was looked, and holds this; or nobody does.
    pub fn heard(&mut self, holds: Option<&Params>) {
        let ResetStage::Finding(at) = self.stage else {
            return;
        };
        self.stage = match (holds, at) {
            (Some(holds), at) => {
                let left = holds.differences(&Params::factory());
                let left = left.into_iter().map(|row| row.id).collect();
                ResetStage::Over(ResetEnd::Found { at, left })
            }
            (None, Place::New) if self.moves => ResetStage::Finding(Place::Old),
            (None, _) if self.rounds > 1 => {
                self.rounds -= 1;
                ResetStage::Finding(Place::New)
            }
            (None, _) => ResetStage::Over(ResetEnd::Nowhere),
        };
    }
}

/// The same wire with the factory's id and serial speed. An address on the network acts from the next power-up.
#[must_use]
pub fn factory_place(hand: &Endpoint) -> Endpoint {
    let mut place = hand.clone();
    let id = match ParamId::HandId.factory() {
        Some(Value::Number(id)) => u8::try_from(id).unwrap_or(1),
        _ => 1,
    };
    match &mut place {
        Endpoint::Rs485(line) | Endpoint::Rtu(line) => {
            line.id = id;
            line.baud = SerialSpeed::Baud115200.baud();
        }
        Endpoint::Can { id: at, .. } | Endpoint::Slcan { id: at, .. } => *at = u16::from(id),
        Endpoint::Tcp { .. } | Endpoint::Sim { .. } => {}
    }
    place
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    fn sending(hand: &str) -> FactoryReset {
        let mut reset = FactoryReset::new(&hand.parse().unwrap());
        reset.sent(Reset::Acknowledged);
        assert_eq!(*reset.stage(), ResetStage::Asking, "nobody said yes");
        reset.begin();
        reset
    }

    #[test]
    fn the_hand_is_looked_for_at_the_factorys_place_first_and_in_rounds() {
        let mut reset = sending("rs485:/dev/x?id=7");
        reset.sent(Reset::Unanswered);
        for _ in 0..3 {
            assert_eq!(*reset.stage(), ResetStage::Finding(Place::New));
            reset.heard(None);
            assert_eq!(*reset.stage(), ResetStage::Finding(Place::Old));
            reset.heard(None);
        }
        assert_eq!(*reset.stage(), ResetStage::Over(ResetEnd::Nowhere));

        let mut here = sending("rs485:/dev/x?id=1");
        here.sent(Reset::Acknowledged);
        here.heard(None);
        assert_eq!(*here.stage(), ResetStage::Finding(Place::New));
        here.heard(Some(&Params::factory()));
        let (at, left) = (Place::New, Vec::new());
        assert_eq!(
            *here.stage(),
            ResetStage::Over(ResetEnd::Found { at, left })
        );
    }

    #[test]
    fn what_was_not_taken_is_told_as_it_is() {
        let mut reset = sending("rs485:/dev/x?id=7");
        let why = NotSent::Armed;
        reset.sent(Reset::NotSent(why));
        let end = ResetEnd::NotSent(Some(why));
        assert_eq!(*reset.stage(), ResetStage::Over(end));

        let mut reset = sending("rs485:/dev/x?id=7");
        reset.sent(Reset::Acknowledged);
        let mut live = Params::factory();
        live.put(ParamId::HandId, Value::Number(7));
        reset.heard(None);
        reset.heard(Some(&live));
        let end = ResetEnd::Found {
            at: Place::Old,
            left: vec![ParamId::HandId],
        };
        assert_eq!(*reset.stage(), ResetStage::Over(end));
    }
}
