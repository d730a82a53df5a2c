//! Common parts of all sources: row in the list, switch, state, and grant of control.

use crate::app::action::Action;
use crate::app::inputs::{InputAction, InputKind};
use crate::motion::source::SourceKind;
use crate::record::ArmRefusal;
use crate::share::gateway::GatewayClient;
use crate::ui::kit::{self, Button, Label, Pane, Weight};
use crate::ui::text::{Text, errors, inputs, words};
use crate::ui::theme;
use egui::{Color32, Id, Rect, Response, Ui, UiBuilder, vec2};

/// A source or reader in the list: its switch and its state.
pub(crate) struct SourceRow {
    /// Name, with its description as tip.
    pub(crate) title: Text,
    /// `None` for what is not switched.
    pub(crate) switch: Option<SourceSwitch>,
    pub(crate) kind: Option<InputKind>,
    /// Its state in a few words.
    pub(crate) words: String,
}

/// Switch of a source.
pub(crate) struct SourceSwitch {
    /// Effect of turning it on.
    pub(crate) turns_on: Text,
    pub(crate) is_on: bool,
    pub(crate) action: InputAction,
    /// Reason why it cannot be turned on.
    pub(crate) wrong: Option<Text>,
}

/// Height of a row in the list.
const ROW: f32 = 52.0;

impl SourceRow {
    /// Draws the row in the list. True if it was clicked.
    pub(crate) fn ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, is_chosen: bool) -> bool {
        let look = pane.look;
        let title = look.tr(self.title);
        let (_, place) = ui.allocate_space(vec2(ui.available_width(), ROW));
        let end = place.right() - theme::SWITCH - theme::GAP;
        let (place, end) = place.split_left_right_at_x(end);
        let name = look.pair(look.tr(inputs::TITLE), title);
        let button = Button::new(title, "").named(&name).switch(is_chosen);
        let id = Id::unique(("source", title));
        let mut clicked = button.ground(ui, look, place, id).clicked();
        if let Some(switch) = &self.switch {
            let size = vec2(theme::SWITCH, theme::CONTROL);
            let corner = Rect::from_center_size(end.center(), size);
            // A child moves no cursor.
            let mut inner = ui.new_child(UiBuilder::new().max_rect(corner));
            clicked |= switch.ui(&mut inner, pane).clicked();
        }
        let inner = place.shrink2(vec2(theme::PAD, theme::STEP));
        let (upper, lower) = inner.split_top_bottom_at_fraction(0.5);
        Label::new(title, look.palette.text).paint(ui, upper);
        let (words, color) = self.state(pane, look.palette.muted);
        Label::new(&words, color).small().put(ui, lower);
        clicked
    }

    /// Draws name, description and state of the chosen source above its settings.
    pub(crate) fn head_ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let title = Label::text(look, self.title).large();
        title.ui(ui);
        kit::small_text_ui(ui, look.tip(self.title), look.palette.muted);
        ui.add_space(theme::STEP);
    }

    /// State in words, or the reason why it could not be opened.
    fn state(&self, pane: &Pane<'_>, live: Color32) -> (String, Color32) {
        let look = pane.look;
        let refused = pane.hand().inputs.refused.as_ref();
        let refused = refused.filter(|(refused, _)| Some(*refused) == self.kind);
        match refused {
            Some((_, why)) => (errors::not_opened(look, why), look.palette.warn),
            None => (self.words.clone(), live),
        }
    }

    /// Draws the state in full, below the settings of the chosen source.
    pub(crate) fn state_ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let (words, color) = self.state(pane, pane.look.palette.text);
        Label::new(&words, color).wrap().ui(ui);
    }
}

impl SourceSwitch {
    fn ui(&self, ui: &mut Ui, pane: &mut Pane<'_>) -> Response {
        let look = pane.look;
        let wrong = self.wrong.filter(|_| !self.is_on);
        let wrong = wrong.map(|wrong| look.tr(wrong));
        let reason = pane.recorded().or(no_hand(pane)).or(wrong);
        let tip = if self.is_on {
            inputs::ON
        } else {
            self.turns_on
        };
        let button = Button::new(look.tr(self.turns_on), look.tip(tip));
        let button = button.selected(self.is_on).disabled(reason);
        let response = button.toggle_ui(ui, look);
        if response.clicked() {
            pane.actions.push(Action::Input(self.action.clone()));
        }
        response
    }
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
