//! Common parts of the source cards: switch, state, and grant of control.

use crate::app::action::Action;
use crate::app::inputs::{InputAction, InputKind};
use crate::motion::source::SourceKind;
use crate::record::ArmRefusal;
use crate::share::gateway::GatewayClient;
use crate::ui::kit::{self, Button, Label, Pane, Weight};
use crate::ui::text::{Text, errors, inputs, words};
use crate::ui::theme;
use egui::{Color32, Ui};

/// A switch in the heading of a card.
pub(crate) struct CardSwitch {
    /// Name of the card, with its description as tip.
    pub(crate) title: Text,
    /// Effect of turning it on.
    pub(crate) turns_on: Text,
    pub(crate) is_on: bool,
    pub(crate) action: InputAction,
    /// Reason why it cannot be turned on.
    pub(crate) wrong: Option<Text>,
}

/// Draws the name of a card with its switch, and its description.
pub(crate) fn switch_ui(ui: &mut Ui, pane: &mut Pane<'_>, switch: CardSwitch) {
    let look = pane.look;
    let wrong = switch.wrong.filter(|_| !switch.is_on);
    let wrong = wrong.map(|wrong| look.tr(wrong));
    let reason = pane.recorded().or(no_hand(pane)).or(wrong);
    let tip = if switch.is_on {
        inputs::ON
    } else {
        switch.turns_on
    };
    let button = Button::new(look.tr(switch.turns_on), look.tip(tip));
    let button = button.selected(switch.is_on).disabled(reason);
    let title = look.tr(switch.title);
    let pressed = kit::head_ui(ui, look, title, |ui| button.toggle_ui(ui, look).clicked());
    if pressed {
        pane.actions.push(Action::Input(switch.action));
    }
    about_ui(ui, pane, switch.title);
}

/// Draws the description of a card in the height of two lines, so that the content below aligns with that of its neighbours.
pub(crate) fn about_ui(ui: &mut Ui, pane: &Pane<'_>, title: Text) {
    let look = pane.look;
    ui.scope(|ui| {
        ui.set_min_height(2.0 * theme::TEXT_LINE);
        kit::small_text_ui(ui, look.tip(title), look.palette.muted);
    });
}

/// Draws the state on one line, or the reason why it could not be opened.
pub(crate) fn state_ui(ui: &mut Ui, pane: &Pane<'_>, kind: Option<InputKind>, words: &str) {
    let look = pane.look;
    let refused = pane.hand().inputs.refused.as_ref();
    let refused = refused.filter(|(refused, _)| Some(*refused) == kind);
    let (words, color): (String, Color32) = match refused {
        Some((_, why)) => (errors::not_opened(look, why), look.palette.warn),
        None => (words.to_owned(), look.palette.text),
    };
    Label::new(&words, color).wrap().ui(ui);
}

/// Draws the button that grants a source control of the hand, or the fact that it has control.
pub(crate) fn grant_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    source: SourceKind,
    missing: Option<&str>,
) {
    let look = pane.look;
    let owner = pane.hand().connection.outside_owner();
    let name = match source {
        SourceKind::Stream => inputs::STREAM,
        SourceKind::Dds => inputs::DDS,
        SourceKind::Pad => inputs::PAD,
        SourceKind::Mirror => inputs::MIRROR,
    };
    if owner.is_some_and(|owner| source.is(owner)) {
        Label::new(look.tr(inputs::MOVES), look.palette.accent).ui(ui);
        return;
    }
    let grant = Grant {
        name: look.tr(name),
        action: InputAction::Grant(source),
        missing,
    };
    grant.ui(ui, pane);
}

/// Draws the button that grants control to a client of the gateway.
pub(crate) fn grant_client_ui(ui: &mut Ui, pane: &mut Pane<'_>, client: &GatewayClient) {
    let grant = Grant {
        name: &client.address.to_string(),
        action: InputAction::GrantClient(client.id),
        missing: None,
    };
    grant.ui(ui, pane);
}

/// A grant of control, with the reason why it is not possible.
struct Grant<'a> {
    name: &'a str,
    action: InputAction,
    missing: Option<&'a str>,
}

impl Grant<'_> {
    fn ui(self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let (look, hand) = (pane.look, pane.hand());
        // A hold-to-run key can still be pressed after the grant.
        let refusal = hand.arm_refusal(pane.state.now);
        let refusal = refusal.filter(|reason| *reason != ArmRefusal::LetGo);
        let refusal = refusal.map(|reason| words::refusal(look, reason));
        let owner = hand.connection.outside_owner();
        let taken = owner.map(|_| look.tr(inputs::TAKEN));
        let reason = no_hand(pane).or(taken).or(self.missing);
        let reason = reason.map(ToOwned::to_owned).or(refusal);
        let name = look.pair(look.tr(inputs::GRANT), self.name);
        let button = Button::text(look, inputs::GRANT)
            .named(&name)
            .weight(Weight::Strong)
            .large();
        let button = button.disabled(reason.as_deref());
        button.on_click(ui, pane, Action::Input(self.action));
    }
}

/// Reason why nothing can be opened: no hand. `None` if the hand is live.
fn no_hand(pane: &Pane<'_>) -> Option<&'static str> {
    let is_live = pane.hand().connection.status.state.is_live();
    (!is_live).then(|| pane.look.tr(inputs::NO_HAND))
}
