//! Hands shared by other Handscopes: the interface to listen on, and the hands found.

use crate::app::action::Action;
use crate::share::fleet::{FleetHand, reachable};
use crate::ui::connection::hand_tiles::{HandTile, side_words};
use crate::ui::connection::link_words::state_color;
use crate::ui::kit::{self, Button, Label, Look, Pane};
use crate::ui::text::{Text, errors, inputs, main, scan};
use egui::Ui;

/// The network interface on which shared hands are looked for.
#[derive(Debug)]
pub(super) struct SharedInterface(String);

impl Default for SharedInterface {
    /// Loopback by default; other interfaces are the user's choice.
    fn default() -> Self {
        Self("127.0.0.1".into())
    }
}

impl SharedInterface {
    /// The name to look on; `None` if nothing is typed.
    pub(super) fn typed(&self) -> Option<String> {
        let name = self.0.trim();
        (!name.is_empty()).then(|| name.to_owned())
    }

    /// Draws the field, or the button that leaves the interface.
    pub(super) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        Label::muted(look, scan::SHARED)
            .ui(ui)
            .on_hover_text(look.tip(scan::SHARED));
        if pane.state.fleet.interface().is_some() {
            let leave = Button::text(look, scan::SHARED_STOP);
            leave.on_click(ui, pane, Action::FindShared(None));
            return;
        }
        let name = look.tr(inputs::DDS_AT);
        ui.scope(|ui| {
            ui.set_max_width(140.0);
            kit::edit_ui(ui, name, name, &mut self.0);
        });
    }
}

/// Draws why the interface cannot be used, or that no hand is shared at it.
pub(super) fn remark_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, fleet) = (pane.look, &pane.state.fleet);
    if let Some(error) = &fleet.refused {
        let text = errors::dds(look, error);
        Label::new(&text, look.palette.warn).wrap().ui(ui);
    }
    if fleet.interface().is_some() && fleet.hands.is_empty() {
        Label::muted(look, scan::SHARED_NONE).wrap().ui(ui);
    }
}

/// Hands that other Handscopes share.
pub(super) fn shared_hands(pane: &Pane<'_>) -> Vec<HandTile> {
    let hands = pane.state.fleet.hands.iter();
    hands.map(|hand| tile(pane, hand)).collect()
}

/// Tile of a hand that connects to its gateway.
fn tile(pane: &Pane<'_>, hand: &FleetHand) -> HandTile {
    let (look, card) = (pane.look, &hand.card);
    let state = look.tr(main::link_state(hand.state)).to_owned();
    HandTile {
        endpoint: hand.endpoint(),
        name: card.name.clone(),
        side: card.side,
        title: format!("{} · {}", card.name, card.host),
        place: about(look, hand).join(" · "),
        state: (state, state_color(look, hand.state)),
        refusal: refusal(pane, hand),
    }
}

/// Name of a hand, its owner or that it is free, and its address.
fn about(look: Look, hand: &FleetHand) -> Vec<String> {
    let card = &hand.card;
    let owner = match hand.owner {
        Some(owner) => scan::mover(look, owner),
        None => look.tr(scan::NOBODY_MOVES).to_owned(),
    };
    let first = card.first_may_move.then(|| look.tr(scan::FIRST_MOVES));
    let at = card.at.map(|at| at.to_string());
    let all = [
        Some(look.tr(side_words(card.side)).to_owned()),
        Some(owner),
        first.map(str::to_owned),
        at,
    ];
    all.into_iter().flatten().collect()
}

/// Reason why this hand cannot be connected to; `None` if it can.
fn refusal(pane: &Pane<'_>, hand: &FleetHand) -> Option<Text> {
    let Some(at) = hand.card.at else {
        return Some(scan::SHARED_UNREACHABLE);
    };
    let interface = pane.state.fleet.interface()?;
    let gateways = pane.state.hands.iter().map(|own| own.inputs.gateway_at);
    let mut own = gateways.flatten().map(|at| reachable(at, interface));
    own.any(|own| own == Some(at)).then_some(scan::SHARED_OWN)
}
