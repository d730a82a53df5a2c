//! Looking for hands: what to scan, how far it is, what was found. Asks for scans and connections; opens nothing.

use crate::app::action::Action;
use crate::app::scan::{IdRange, ScanTarget};
use crate::link::scan::{Hosts, ScanEvent};
use crate::transport::Endpoint;
use crate::ui::kit::{self, Button, Label, Pane, Weight};
use crate::ui::text::{Text, errors, panels, scan};
use crate::ui::theme;
use egui::{ProgressBar, Ui, vec2};

/// Addresses that hands were delivered with: the manual's (1.3.2), and two seen in the field. None is asked unasked.
const PRESETS: [(&str, Text); 3] = [
    ("192.168.11.210:6000", scan::PRESET_MAKER),
    ("192.168.123.210:6000", scan::PRESET_FIELD),
    ("192.168.123.211:6000", scan::PRESET_FIELD),
];

/// What was chosen and typed.
#[derive(Debug, Default)]
pub(crate) struct ScanPanel {
    /// Ids that are asked on every bus.
    pub(crate) ids: IdRange,
    address: String,
    /// What was to be scanned and names no hosts.
    refused: Option<String>,
}

impl ScanPanel {
    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            kit::head_ui(ui, look, look.say(scan::FIND), |_| ());
            self.ports_ui(ui, pane);
            self.address_ui(ui, pane);
            ui.separator();
            stage_ui(ui, pane);
            results_ui(ui, pane);
        });
    }

    fn ports_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.horizontal_wrapped(|ui| {
            if pane.state.scan.is_running() {
                let cancel = Button::said(look, scan::CANCEL);
                cancel.large().on_click(ui, pane, Action::CancelScan);
            } else {
                let (text, tip) = (look.say(scan::SCAN_PORTS), look.tip(scan::SCAN_PORTS));
                let button = Button::new(text, tip).weight(Weight::Strong).large();
                if start_ui(ui, pane, button, None) {
                    pane.actions.push(Action::Scan(ScanTarget::Ports(self.ids)));
                }
            }
            Label::muted(look, scan::IDS).ui(ui);
            for (range, text) in [(IdRange::Few, scan::IDS_FEW), (IdRange::All, scan::IDS_ALL)] {
                let name = format!("{}: {}", look.say(scan::IDS), look.say(text));
                let button = Button::said(look, text)
                    .tip(look.tip(scan::IDS))
                    .named(&name);
                if button.choice(self.ids == range).ui(ui, look).clicked() {
                    self.ids = range;
                }
            }
        });
    }

    fn address_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.horizontal(|ui| {
            let text = look.say(scan::SCAN_HOST);
            let width = kit::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
            let width = ui.available_width() - width - theme::GAP;
            ui.allocate_ui(vec2(width, theme::CONTROL), |ui| {
                let name = look.say(scan::ADDRESS);
                kit::edit_ui(ui, (name, name), &mut self.address)
            });
            let missing = self.address.trim().is_empty();
            let missing = missing.then_some(scan::ADDRESS_EMPTY);
            let button = Button::new(text, look.tip(scan::SCAN_HOST));
            if start_ui(ui, pane, button, missing) {
                self.scan_hosts(pane, self.address.clone());
            }
        });
        ui.horizontal_wrapped(|ui| {
            for (address, about) in PRESETS {
                let tip = format!("{}\n{}", look.say(about), look.say(scan::PRESET_TIP));
                let button = Button::new(address, &tip).selected(self.address == address);
                if button.ui(ui, look).clicked() {
                    address.clone_into(&mut self.address);
                }
            }
        });
        if let (Some(text), Err(error)) = (&self.refused, self.address.parse::<Hosts>())
            && *text == self.address
        {
            let text = errors::hosts(look, &error);
            Label::new(&text, look.palette.warn).wrap().ui(ui);
        }
    }

    /// Scans what was typed, or says why it cannot be.
    pub(crate) fn scan_hosts(&mut self, pane: &mut Pane<'_>, typed: String) {
        match typed.parse() {
            Ok(hosts) => pane.actions.push(Action::Scan(ScanTarget::Hosts(hosts))),
            Err(_) => self.refused = Some(typed.clone()),
        }
        self.address = typed;
    }
}

/// A button that starts a scan, if none runs and nothing is missing; true if one is wanted.
pub(crate) fn start_ui(
    ui: &mut Ui,
    pane: &Pane<'_>,
    button: Button<'_>,
    missing: Option<Text>,
) -> bool {
    let running = pane.state.scan.is_running().then_some(scan::RUNNING);
    let reason = running.or(missing).map(|reason| pane.look.say(reason));
    button.disabled(reason).ui(ui, pane.look).clicked()
}

/// How far the scan is, or how it ended.
fn stage_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, state) = (pane.look, &pane.state.scan);
    if !state.is_running() {
        let (text, color) = match scan::ended(look, state) {
            Ok(text) => (text, look.palette.text),
            Err(text) => (look.say(text).to_owned(), look.palette.muted),
        };
        Label::new(&text, color).wrap().ui(ui);
        return;
    }
    Label::new(&scan::progress(look, state), look.palette.text)
        .named(look.say(scan::PROGRESS))
        .ui(ui);
    let count = |count: usize| f32::from(u16::try_from(count).unwrap_or(u16::MAX));
    let part = count(state.progress.tried) / count(state.progress.total).max(1.0);
    ui.add(ProgressBar::new(part).desired_height(theme::STEP));
}

/// The hands, then what else there is to say.
fn results_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, state) = (pane.look, pane.state);
    for found in &state.scan.found {
        let usb = found.usb.as_ref().map(ToString::to_string);
        let usb = usb.unwrap_or_default();
        let place = format!("{}  {usb}", found.endpoint.place());
        let title = scan::title(look, &found.endpoint, Some(found.hand_id.into()));
        hand_ui(ui, pane, &found.endpoint, (&title, place.trim_end()));
    }
    for remark in &state.scan.remarks {
        let color = match remark {
            ScanEvent::Held { .. } => look.palette.muted,
            _ => look.palette.warn,
        };
        Label::new(&scan::remark(look, remark), color).wrap().ui(ui);
    }
    if state.scan.left_out > 0 {
        let text = format!("+ {} {}", state.scan.left_out, look.say(scan::MORE));
        Label::new(&text, look.palette.muted).ui(ui);
    }
}

/// A hand with the button that connects to it.
pub(crate) fn hand_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    endpoint: &Endpoint,
    (title, place): (&str, &str),
) {
    let look = pane.look;
    let name = endpoint.to_string();
    connect_ui(ui, pane, (Some(endpoint), &name, None), |ui| {
        Label::new(title, look.palette.text).wrap().ui(ui);
        if !place.is_empty() {
            Label::new(place, look.palette.muted).small().wrap().ui(ui);
        }
    });
}

/// The button that connects to this endpoint, unless it is refused, with the button's name; beside it what there is to say.
pub(crate) fn connect_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    (endpoint, name, refusal): (Option<&Endpoint>, &str, Option<Text>),
    about: impl FnOnce(&mut Ui),
) {
    let look = pane.look;
    let hand = pane.state.hand();
    let is_now = hand.connection.status.state.is_live()
        && endpoint.is_some()
        && hand.connection.endpoint.as_ref() == endpoint;
    let (text, weight) = if is_now {
        (scan::CONNECTED, Weight::Chosen)
    } else {
        (panels::CONNECT, Weight::Normal)
    };
    ui.horizontal(|ui| {
        let name = format!("{}: {name}", look.say(text));
        let button = Button::said(look, text).named(&name);
        let button = button.disabled(refusal.map(|reason| look.say(reason)));
        let button = button.weight(weight).large().ui(ui, look);
        if let Some(endpoint) = endpoint.filter(|_| button.clicked() && !is_now) {
            pane.actions.push(Action::Connect(endpoint.clone()));
        }
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            about(ui);
        });
    });
}
