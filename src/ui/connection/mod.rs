//! The connection: address, link and its statistics. Requests connections and scans; opens nothing.
mod detail;
pub(crate) mod figures;
pub(crate) mod hand_tiles;
pub(crate) mod link_words;
pub(crate) mod scan;
mod shared;

use crate::app::action::Action;
use crate::app::hand::list::HandsAction;
use crate::app::scan::ScanTarget;
use crate::link::scan::{Hosts, HostsError};
use crate::poses::library::NAME_CHARS_MAX;
use crate::transport::Endpoint;
use crate::transport::endpoint::typed::{TypedError, other_kind, recognise, shortest, spell};
use crate::ui::connection::detail::{KINDS, LinkFields, row_ui};
use crate::ui::connection::hand_tiles::tiles_ui;
use crate::ui::connection::scan::ScanPanel;
use crate::ui::hand::panel::StillHand;
use crate::ui::kit::{self, Button, Label, Look, Pane, TextField, Weight};
use crate::ui::text::{errors, main, panels, scan as scan_text, window};
use crate::ui::theme;
use crate::ui::touch::heat;
use egui::{Key, Panel, ScrollArea, Ui, Vec2, vec2};
use std::net::Ipv4Addr;

/// Minimum width of a link kind's tile, and its height.
const WAY: Vec2 = vec2(140.0, 40.0);

/// Width from which on the link is beside the address.
const WIDE: f32 = 976.0;

/// Result of parsing the typed text.
type Meaning = Result<Endpoint, TypedError>;

/// Text of a hand's address, and expanded sections.
#[derive(Debug, Default)]
pub(crate) struct ConnectionForm {
    typed: String,
    /// The settings of the link are shown as fields.
    is_unfolded: bool,
    scan: ScanPanel,
    hand: StillHand,
    /// Endpoint that the text was filled from, so that a new one replaces the text.
    filled_from: Option<Endpoint>,
    /// Serial ports were listed.
    has_looked: bool,
    /// Focus the text field in this frame.
    wants_focus: bool,
}

impl ConnectionForm {
    /// Focuses the address in the next frame.
    pub(crate) const fn focus_address(&mut self) {
        self.wants_focus = true;
    }

    /// Draws the address, the link's statistics, and hands to connect to.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let ports = &pane.state.ports;
        let hands = &pane.state.hands;
        let endpoint = pane.hand().connection.endpoint.as_ref();
        let is_open = |it: &Endpoint| {
            let mut all = hands.iter();
            all.any(|hand| hand.connection.endpoint.as_ref() == Some(it))
        };
        // The address of another open hand is not offered.
        if endpoint.is_none()
            && let Some(filled) = self.filled_from.take_if(|it| is_open(it))
            && self.typed == shortest(&filled, ports)
        {
            self.typed.clear();
        }
        if let Some(endpoint) = endpoint.filter(|it| Some(*it) != self.filled_from.as_ref()) {
            self.filled_from = Some(endpoint.clone());
            self.typed = shortest(endpoint, ports);
        }
        let may_look = pane.recorded().is_none() && !pane.hand().runs_series();
        if may_look && !std::mem::replace(&mut self.has_looked, true) && ports.is_empty() {
            pane.actions.push(Action::FindPorts);
        }
        let look = pane.look;
        let has_hand = endpoint.is_some();
        let is_wide = has_hand && ui.available_width() >= WIDE;
        if is_wide {
            let width = (ui.available_width() * 0.42).round();
            let panel = kit::bare(Panel::right("link"), width, theme::GAP_LEFT);
            panel.show(ui, |ui| {
                kit::full_card_ui(ui, look, |ui| self.link_ui(ui, pane));
            });
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = theme::GAP;
            kit::card_ui(ui, look, |ui| self.address_ui(ui, pane));
            if !is_wide {
                kit::card_ui(ui, look, |ui| figures::link_ui(ui, pane));
            }
            if let Some(address) = self.scan.ui(ui, pane) {
                self.typed = address;
            }
            if self.needs_help(pane) {
                self.kinds_ui(ui, pane);
            }
        });
    }

    /// True while the typed address is none, or no real hand is connected: then the kinds of links are explained.
    fn needs_help(&self, pane: &Pane<'_>) -> bool {
        let typed = recognise(&self.typed, &pane.state.ports);
        let connection = &pane.hand().connection;
        typed.is_err() || connection.endpoint.is_none() || connection.is_simulated()
    }

    /// Draws the link with its figures, above the hand at its other end.
    fn link_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            figures::link_ui(ui, pane);
            self.hand.rest_ui(ui, pane, &heat::tips(pane), None);
        });
    }

    fn address_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let title = look.tr(main::TAB_CONNECTION);
        kit::head_ui(ui, look, title, |ui| slots_ui(ui, pane));
        let name = look.tr(scan_text::ADDRESS);
        let field = kit::edit_ui(ui, name, name, &mut self.typed);
        if std::mem::take(&mut self.wants_focus) {
            field.request_focus();
        }
        let enter = ui.input(|input| input.key_pressed(Key::Enter));
        let mut entered = enter && field.lost_focus();
        let ports = &pane.state.ports;
        let meaning = recognise(&self.typed, ports);
        let is_typed = field.has_focus() || self.typed.trim().is_empty();
        let wrong = self.wrong(look, &meaning).filter(|_| !is_typed);
        self.meaning_ui(ui, look, &meaning, wrong.as_deref());
        let fields = spell(&self.typed, ports).ok();
        let fields = fields.and_then(|spelled| LinkFields::of(&spelled));
        ui.horizontal_wrapped(|ui| {
            self.buttons_ui(ui, pane, &meaning);
            let change = Button::text(look, scan_text::CHANGE).large();
            let change = change.switch(self.is_unfolded && fields.is_some());
            let none = look.tr(scan_text::CHANGE_NONE);
            let change = change.disabled_if(fields.is_none(), none);
            change.toggle(ui, look, &mut self.is_unfolded);
        });
        if let Some(mut fields) = fields.filter(|_| self.is_unfolded) {
            ui.add_space(theme::STEP);
            let before = fields.spelled();
            entered |= fields.ui(ui, pane);
            let spelled = fields.spelled();
            if spelled != before {
                self.typed.clone_from(&spelled);
            }
            row_ui(ui, look, look.tr(panels::ENDPOINT), |ui| {
                let label = Label::new(&spelled, look.palette.text).number().wrap();
                label.named(look.tr(panels::ENDPOINT)).ui(ui);
            });
        }
        let is_new = |endpoint: &&Endpoint| !is_connected_to(pane, endpoint);
        let wanted = meaning.as_ref().ok().filter(is_new);
        let wanted = wanted.filter(|_| entered && pane.recorded().is_none());
        let connect = wanted.cloned().map(Action::Connect);
        pane.actions.extend(connect);
        name_ui(ui, pane);
    }

    /// Draws the recognised endpoint, or, once typing has ended, the error; for a port, also the other kind of link.
    fn meaning_ui(&mut self, ui: &mut Ui, look: Look, meaning: &Meaning, wrong: Option<&str>) {
        let palette = look.palette;
        let (words, color) = match (meaning, wrong) {
            (Ok(endpoint), _) => (&*scan_text::recognised(look, endpoint), palette.text),
            (Err(_), None) => (look.tr(scan_text::EXAMPLES), palette.muted),
            (Err(_), Some(wrong)) if matches!(self.range(), Some(Ok(_))) => (wrong, palette.text),
            (Err(_), Some(wrong)) => (wrong, palette.warn),
        };
        ui.horizontal_wrapped(|ui| {
            ui.set_min_height(theme::CONTROL);
            Label::new(words, color).wrap().ui(ui);
            let Ok(endpoint) = meaning else { return };
            let Some(other) = other_kind(endpoint) else {
                return;
            };
            let words = look.fill(scan_text::INSTEAD, &[&look.tr(panels::kind(other))]);
            let button = Button::new(&words, look.tip(scan_text::INSTEAD));
            if button.ui(ui, look).clicked() {
                let fields = LinkFields::of(&endpoint.to_string());
                self.typed = fields.map_or_else(String::new, |fields| fields.over(other).spelled());
            }
        });
    }

    /// Reason why the text cannot be connected to; `None` if it can.
    fn wrong(&self, look: Look, meaning: &Meaning) -> Option<String> {
        let error = meaning.as_ref().err()?;
        Some(match self.range() {
            Some(Ok(_)) => look.tr(scan_text::RANGE).to_owned(),
            Some(Err(error)) => errors::hosts(look, &error),
            None => errors::typed(look, error),
        })
    }

    /// Addresses of the typed range, if it is one.
    fn range(&self) -> Option<Result<Hosts, HostsError>> {
        let (first, _) = self.typed.trim().split_once('/')?;
        first.parse::<Ipv4Addr>().ok()?;
        Some(self.typed.parse())
    }

    fn buttons_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, meaning: &Meaning) {
        let look = pane.look;
        let endpoint = meaning.as_ref().ok();
        let to_it = endpoint.filter(|endpoint| is_connected_to(pane, endpoint));
        if to_it.is_none() {
            let wrong = self.wrong(look, meaning);
            let connect = Button::text(look, panels::CONNECT).large();
            let connect = connect.weight(Weight::Strong);
            let connect = connect.disabled(pane.recorded().or(wrong.as_deref()));
            let pressed = connect.ui(ui, look).clicked();
            let connect = endpoint.filter(|_| pressed).cloned();
            pane.actions.extend(connect.map(Action::Connect));
        }
        if pane.hand().connection.endpoint.is_some() {
            let disconnect = Button::text(look, panels::DISCONNECT).large();
            disconnect.on_click(ui, pane, Action::Disconnect);
        }
        if let Some(target) = self.scan_target(endpoint) {
            let button = Button::text(look, panels::SCAN_HERE).large();
            if scan::start_ui(ui, pane, button) {
                pane.actions.push(Action::Scan(target));
            }
        }
    }

    /// Scan target of the typed address; `None` if it cannot be scanned.
    fn scan_target(&self, endpoint: Option<&Endpoint>) -> Option<ScanTarget> {
        let ids = self.scan.ids;
        match endpoint {
            Some(Endpoint::Sim { .. }) => None,
            Some(endpoint) => match (endpoint.port(), endpoint.interface()) {
                (Some(port), _) => Some(ScanTarget::Port(port.to_owned(), ids)),
                (_, Some(interface)) => Some(ScanTarget::Interface(interface.to_owned(), ids)),
                (None, None) => endpoint.place().parse().ok().map(ScanTarget::Hosts),
            },
            None => self.range()?.ok().map(ScanTarget::Hosts),
        }
    }

    /// Draws each kind of link with a hint; a click begins an address of that kind.
    fn kinds_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let ports = &pane.state.ports;
        let spelled = spell(&self.typed, ports).unwrap_or_default();
        kit::card_ui(ui, look, |ui| {
            kit::head_ui(ui, look, look.tr(scan_text::WAYS), |_| ());
            tiles_ui(ui, WAY, &KINDS, |ui, (id, place), (first, _)| {
                let kind = first.split(':').next().unwrap_or_default();
                let text = panels::kind(kind);
                let name = look.pair(look.tr(panels::CONNECTION_KIND), look.tr(text));
                let is_now = spelled.split(':').next() == Some(kind);
                let button = Button::new(look.tr(text), look.tip(text)).named(&name);
                let button = button.switch(is_now);
                if button.ground(ui, look, place, id).clicked() && !is_now {
                    self.typed = match first.parse() {
                        Ok(endpoint) => shortest(&endpoint, ports),
                        Err(_) => format!("{kind}:"),
                    };
                    (self.is_unfolded, self.wants_focus) = (true, true);
                }
                Label::text(look, text).center().paint(ui, place);
            });
        });
    }
}

/// True if the shown hand is connected to exactly this endpoint.
fn is_connected_to(pane: &Pane<'_>, endpoint: &Endpoint) -> bool {
    pane.hand().connection.endpoint.as_ref() == Some(endpoint)
}

/// Draws the buttons that add a hand to the window, and that remove this one of several.
fn slots_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, hands) = (pane.look, &pane.state.hands);
    let full = (!hands.has_room()).then(|| look.tr(window::ADD_HAND_FULL));
    let add = Button::text(look, window::ADD_HAND).disabled(full);
    add.on_click(ui, pane, Action::Hands(HandsAction::Add));
    if hands.is_several() {
        let remove = HandsAction::Remove(pane.hand().label.slot);
        let button = Button::text(look, window::REMOVE_HAND);
        button.on_click(ui, pane, Action::Hands(remove));
    }
}

/// Draws the name of this hand.
fn name_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, state) = (pane.look, pane.state);
    let hand = state.hand();
    let Some(endpoint) = &hand.connection.endpoint else {
        return;
    };
    let caption = look.tr(window::HAND_NAME);
    row_ui(ui, look, look.tr(window::HAND_NAME_SHORT), |ui| {
        let name = state.settings.hand_name(endpoint).unwrap_or_default();
        let field = TextField::new(caption, NAME_CHARS_MAX).hint(&hand.label.name);
        if let Some(name) = field.ui(ui, pane, name) {
            let named = HandsAction::Name(hand.label.slot, name);
            pane.actions.push(Action::Hands(named));
        }
    });
}
