//! What the cards of all procedures have in common.

use crate::app::action::Action;
use crate::app::params::Refusal;
use crate::app::procedures::ProcedureAction;
use crate::app::state::State;
use crate::ui::kit::{Card, Choice, Look, Manner, Progress};
use crate::ui::text::{Text, cards, device};

/// A card of something that goes on by itself.
pub(crate) fn under_way(look: Look, title: Text, words: &str, part: f32) -> Card {
    Card {
        title: look.say(title).into(),
        progress: Some(Progress {
            part,
            words: words.into(),
        }),
        ..Card::default()
    }
}

/// The way out of a card that was read.
pub(crate) fn close() -> Choice {
    Choice::new(cards::CLOSE, Manner::Safe).does(Action::Procedure(ProcedureAction::Close))
}

/// The way out of a card that asks.
pub(crate) fn cancel() -> Choice {
    Choice::cancel().does(Action::Procedure(ProcedureAction::Close))
}

/// Why nothing can begin now, in words.
pub(crate) fn reason(state: &State, look: Look) -> Option<String> {
    let why: Refusal = state.hand().rest_refusal()?;
    Some(look.say(device::refusal(why)).into())
}
