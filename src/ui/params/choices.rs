//! Common buttons of all procedure cards.

use crate::app::action::Action;
use crate::app::params::rest_refusal;
use crate::app::procedures::ProcedureAction;
use crate::app::state::State;
use crate::tasks::Question;
use crate::ui::kit::{ButtonRole, Card, CardButton};
use crate::ui::text::{Text, cards, device};

/// A button that advances the procedure by one step.
pub(crate) fn step(text: Text, role: ButtonRole, step: ProcedureAction) -> CardButton {
    CardButton::new(text, role, Action::Procedure(step))
}

/// A button that answers a question of a task.
pub(crate) fn answer(text: Text, role: ButtonRole, question: &Question, yes: bool) -> CardButton {
    CardButton::new(text, role, Action::Answer(question.clone(), yes))
}

/// The button that closes a card.
pub(crate) fn close() -> CardButton {
    step(cards::CLOSE, ButtonRole::Safe, ProcedureAction::Close)
}

/// Adds *Cancel* and `begin` to a card; `begin` is disabled unless a hand is connected, disarmed and at rest.
pub(crate) fn asking(state: &State, card: Card, begin: CardButton) -> Card {
    let refusal = rest_refusal(&state.hand().connection.status).map(device::refusal);
    let cancel = step(cards::CANCEL, ButtonRole::Safe, ProcedureAction::Close);
    card.choice(cancel).choice(begin.disabled(refusal))
}
