//! Hands shared by other Handscopes: the interface to listen on, the hands found, and a tile to connect to each.

use crate::app::action::Action;
use crate::share::fleet::{FleetHand, reachable};
use crate::ui::connection::hand_tiles::{HandTile, hand_tiles_ui, side_words};
use crate::ui::connection::link_words::state_color;
use crate::ui::kit::{self, Button, Label, Look, Pane};
use crate::ui::text::{Text, errors, inputs, main, scan};
use egui::Ui;

/// Text in progress.
#[derive(Debug)]
pub(crate) struct SharedPanel {
    interface: String,
}

impl Default for SharedPanel {
    /// Loopback by default; other interfaces are the user's choice.
    fn default() -> Self {
        Self {
            interface: "127.0.0.1".into(),
        }
    }
}

impl SharedPanel {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            kit::head_ui(ui, look, look.tr(scan::SHARED), |_| ());
            kit::small_text_ui(ui, look.tip(scan::SHARED), look.palette.muted);
            self.switch_ui(ui, pane);
            if let Some(error) = &pane.state.fleet.refused {
                let text = errors::dds(look, error);
                Label::new(&text, look.palette.warn).wrap().ui(ui);
            }
            if pane.state.fleet.interface().is_some() && pane.state.fleet.hands.is_empty() {
                Label::muted(look, scan::SHARED_NONE).wrap().ui(ui);
            }
            let hands = pane.state.fleet.hands.iter();
            let tiles: Vec<HandTile> = hands.map(|hand| tile(pane, hand)).collect();
            hand_tiles_ui(ui, pane, &tiles);
        });
    }

    fn switch_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let is_on = pane.state.fleet.interface().is_some();
        let text = if is_on {
            scan::SHARED_STOP
        } else {
            scan::SHARED_FIND
        };
        ui.horizontal(|ui| {
            ui.add_enabled_ui(!is_on, |ui| {
                ui.set_max_width(240.0);
                let name = look.tr(inputs::DDS_AT);
                kit::edit_ui(ui, name, name, &mut self.interface);
            });
            let interface = self.interface.trim().to_owned();
            let missing = interface.is_empty() && !is_on;
            let missing = missing.then(|| look.tr(inputs::INTERFACE_WRONG));
            let action = Action::FindShared((!is_on).then_some(interface));
            let button = Button::text(look, text).disabled(missing);
            button.on_click(ui, pane, action);
        });
    }
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
