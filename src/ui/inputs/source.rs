//! What the cards of several sources have in common: the switch, how it goes, and whether it may move the hand.

use crate::app::action::Action;
use crate::app::inputs::{InputAction, InputKind, InputSource};
use crate::link::Owner;
use crate::record::ArmRefusal;
use crate::ui::kit::{self, Button, Label, Pane, Weight};
use crate::ui::text::{Text, errors, inputs, words};
use crate::ui::theme;
use egui::{Color32, Ui};

/// A switch at the head of a card.
pub(crate) struct Switch {
    /// The name of the card, and what it is.
    pub(crate) title: Text,
    /// What turning it on does.
    pub(crate) turns_on: Text,
    pub(crate) is_on: bool,
    pub(crate) action: InputAction,
    /// Why it cannot be turned.
    pub(crate) wrong: Option<Text>,
}

/// The name of a card with its switch, and what it is.
pub(crate) fn switch_ui(ui: &mut Ui, pane: &mut Pane<'_>, switch: Switch) {
    let look = pane.look;
    let wrong = switch.wrong.filter(|_| !switch.is_on);
    let wrong = wrong.map(|wrong| look.say(wrong));
    let reason = pane.recorded().or(no_hand(pane)).or(wrong);
    let tip = if switch.is_on {
        inputs::ON
    } else {
        switch.turns_on
    };
    let button = Button::new(look.say(switch.turns_on), look.tip(tip));
    let button = button.selected(switch.is_on).disabled(reason);
    let title = look.say(switch.title);
    let pressed = kit::head_ui(ui, look, title, |ui| button.toggle_ui(ui, look).clicked());
    if pressed {
        pane.actions.push(Action::Input(switch.action));
    }
    about_ui(ui, pane, switch.title);
}

/// What a card is about, in the room of two lines, so that what is below stands in one row with that of its neighbours.
pub(crate) fn about_ui(ui: &mut Ui, pane: &Pane<'_>, title: Text) {
    let look = pane.look;
    ui.scope(|ui| {
        ui.set_min_height(2.0 * theme::TEXT_LINE);
        kit::say_ui(ui, look.tip(title), look.palette.muted);
    });
}

/// How it goes in one line, or why it could not be opened.
pub(crate) fn state_ui(ui: &mut Ui, pane: &Pane<'_>, kind: Option<InputKind>, words: &str) {
    let look = pane.look;
    let refused = pane.state.hand().inputs.refused.as_ref();
    let refused = refused.filter(|(refused, _)| Some(*refused) == kind);
    let (words, color): (String, Color32) = match refused {
        Some((_, why)) => (errors::not_opened(look, why), look.palette.warn),
        None => (words.to_owned(), look.palette.text),
    };
    Label::new(&words, color).wrap().ui(ui);
}

/// True if this may move the hand now.
fn moves(pane: &Pane<'_>, action: &InputAction) -> bool {
    let owner = pane.state.hand().connection.outside_owner();
    matches!(
        (action, owner),
        (
            InputAction::Grant(InputSource::Stream),
            Some(Owner::Stream(_))
        ) | (InputAction::Grant(InputSource::Dds), Some(Owner::Dds))
            | (InputAction::Grant(InputSource::Pad), Some(Owner::Gamepad))
            | (InputAction::Grant(InputSource::Mirror), Some(Owner::Mirror))
    )
}

/// Lets a source move the hand, or says that it does.
pub(crate) fn grant_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    (source, action): (&str, InputAction),
    missing: Option<&str>,
) {
    let look = pane.look;
    let hand = pane.state.hand();
    if moves(pane, &action) {
        Label::new(look.say(inputs::MOVES), look.palette.accent).ui(ui);
        return;
    }
    // What has to be held can still be held once it may.
    let refusal = hand.arm_refusal(pane.state.now);
    let refusal = refusal.filter(|reason| *reason != ArmRefusal::LetGo);
    let refusal = refusal.map(|reason| words::refusal(look, reason));
    let taken = hand
        .connection
        .outside_owner()
        .map(|_| look.say(inputs::TAKEN));
    let reason = no_hand(pane).or(taken).or(missing);
    let reason = reason.map(ToOwned::to_owned).or(refusal);
    let name = look.pair(look.say(inputs::GRANT), source);
    let button = Button::said(look, inputs::GRANT)
        .named(&name)
        .weight(Weight::Strong)
        .large();
    let button = button.disabled(reason.as_deref());
    button.on_click(ui, pane, Action::Input(action));
}

/// Why nothing can be opened without a hand.
fn no_hand(pane: &Pane<'_>) -> Option<&'static str> {
    let is_live = pane.state.hand().connection.status.state.is_live();
    (!is_live).then(|| pane.look.say(inputs::NO_HAND))
}
