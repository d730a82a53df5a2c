//! The card over the body of the window, one at a time.

use crate::app::action::Action;
use crate::app::state::State;
use crate::ui::kit::{ButtonRole, Card, CardButton, Look};
use crate::ui::params::card as device_card;
use crate::ui::params::procedures;
use crate::ui::recordings;
use crate::ui::text::window;
use crate::ui::trials::compare;

pub(super) fn is_covered(state: &State) -> bool {
    state.hand().procedures.card.is_some()
        || state.hand().params.question().is_some()
        || state.trials.to_confirm.is_some()
        || state.recordings.to_delete.is_some()
        || state.leave.is_some()
}

/// Returns the card to show. The question before closing takes precedence over all others.
pub(super) fn card_of(state: &State, look: Look) -> Option<Card> {
    leave_card(state, look)
        .or_else(|| procedures::card_of(state, look))
        .or_else(|| device_card::card_of(state, look))
        .or_else(|| compare::card_of(state, look))
        .or_else(|| recordings::card_of(state, look))
}

/// Question before the window closes, listing what would be lost.
fn leave_card(state: &State, look: Look) -> Option<Card> {
    let question = state.leave?;
    let mut card = Card::new(look, window::LEAVE_TITLE);
    if question.series {
        card = card.warning(window::LEAVE_SERIES);
    }
    if question.edits > 0 {
        card = card.warning(look.fill(window::LEAVE_EDITS, &[&question.edits]));
    }
    let stay = CardButton::new(window::STAY, ButtonRole::Safe, Action::Stay);
    let leave = CardButton::new(window::LEAVE, ButtonRole::Danger, Action::Leave);
    Some(card.choice(stay).choice(leave))
}
