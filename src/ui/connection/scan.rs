//! Looking for hands: what to scan, how far it is, what was found. Asks for scans and connections; opens nothing.

use crate::app::action::Action;
use crate::app::scan::{IdRange, ScanRemark, ScanStage, ScanState, ScanWish};
use crate::link::scan::Hosts;
use crate::transport::{Endpoint, UsbFound};
use crate::ui::kit::controls::{self, Button, Label, Weight};
use crate::ui::kit::format;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::{Text, errors, panels, scan};
use crate::ui::theme;
use egui::{Align, Layout, ProgressBar, Ui, vec2};

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
        controls::card_ui(ui, look, |ui| {
            controls::head_ui(ui, look, look.say(scan::FIND), |_| ());
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
                let cancel = Button::new(look.say(scan::CANCEL), look.say(scan::CANCEL_TIP));
                if cancel.large().ui(ui, look).clicked() {
                    pane.actions.push(Action::CancelScan);
                }
            } else {
                let (text, tip) = (look.say(scan::SCAN_PORTS), look.say(scan::SCAN_PORTS_TIP));
                let button = Button::new(text, tip).weight(Weight::Strong).large();
                if start_ui(ui, pane, button, None) {
                    pane.actions.push(Action::Scan(ScanWish::Ports(self.ids)));
                }
            }
            Label::new(look.say(scan::IDS), look.palette.muted).ui(ui);
            for (range, text) in [(IdRange::Few, scan::IDS_FEW), (IdRange::All, scan::IDS_ALL)] {
                let name = format!("{}: {}", look.say(scan::IDS), look.say(text));
                let button = Button::new(look.say(text), look.say(scan::IDS_TIP)).named(&name);
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
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
            let width = ui.available_width() - width - theme::GAP;
            ui.allocate_ui(vec2(width, theme::CONTROL), |ui| {
                let name = look.say(scan::ADDRESS);
                controls::edit_ui(ui, name, name, &mut self.address)
            });
            let missing = self.address.trim().is_empty();
            let missing = missing.then_some(scan::ADDRESS_EMPTY);
            let button = Button::new(text, look.say(scan::SCAN_HOST_TIP));
            if start_ui(ui, pane, button, missing) {
                self.scan_hosts(pane, self.address.clone());
            }
        });
        ui.horizontal_wrapped(|ui| {
            for (address, about) in PRESETS {
                let tip = format!("{}\n{}", look.say(about), look.say(scan::PRESET_TIP));
                let mut button = Button::new(address, &tip);
                button.selected = Some(self.address == address);
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
            Ok(hosts) => pane.actions.push(Action::Scan(ScanWish::Hosts(hosts))),
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
    let (look, scan) = (pane.look, &pane.state.scan);
    if !scan.is_running() {
        let (text, color) = match ended(look, scan) {
            Ok(text) => (text, look.palette.text),
            Err(text) => (look.say(text).to_owned(), look.palette.muted),
        };
        Label::new(&text, color).wrap().ui(ui);
        return;
    }
    Label::new(&progress_words(look, scan), look.palette.text)
        .named(look.say(scan::PROGRESS))
        .ui(ui);
    let count = |count: usize| f32::from(u16::try_from(count).unwrap_or(u16::MAX));
    let part = count(scan.progress.tried) / count(scan.progress.total).max(1.0);
    ui.add(ProgressBar::new(part).desired_height(theme::STEP));
}

fn progress_words(look: Look, book: &ScanState) -> String {
    let progress = book.progress;
    if progress.total == 0 {
        return look.say(scan::LISTING).into();
    }
    // Never less than a second: what is nearly over is not worth a flicker.
    let left = progress.left.as_secs() + 1;
    format!(
        "{} / {} {}, {} {left} s",
        progress.tried,
        progress.total,
        look.say(scan::ASKED),
        look.say(scan::TIME_LEFT)
    )
}

/// What was found, or why there is nothing.
fn ended(look: Look, book: &ScanState) -> Result<String, Text> {
    let summary = match book.stage {
        ScanStage::Never | ScanStage::Running => return Err(scan::NEVER),
        ScanStage::Cancelled if book.found.is_empty() => return Err(scan::CANCELLED),
        ScanStage::Cancelled => {
            let found = found_words(look, book.found.len());
            return Ok(format!("{} {found}", look.say(scan::CANCELLED)));
        }
        ScanStage::Done(summary) => summary,
    };
    if !book.found.is_empty() {
        let found = found_words(look, book.found.len());
        return Ok(format!("{found}, {}", format::age(summary.took)));
    }
    Err(match &book.wish {
        _ if summary.places == 0 && !book.remarks.is_empty() => scan::NOWHERE,
        _ if summary.places == 0 => scan::NO_PLACES,
        Some(ScanWish::Hosts(_)) => scan::NOTHING_THERE,
        Some(ScanWish::Ports(ids) | ScanWish::Port(_, ids) | ScanWish::Interface(_, ids))
            if *ids == IdRange::All =>
        {
            scan::NOTHING_AT_ALL
        }
        Some(_) | None => scan::NOTHING,
    })
}

fn found_words(look: Look, found: usize) -> String {
    let words = if found == 1 {
        scan::FOUND_ONE
    } else {
        scan::FOUND_MANY
    };
    format!("{found} {}", look.say(words))
}

/// The hands, then what else there is to say.
fn results_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, state) = (pane.look, pane.state);
    for found in &state.scan.found {
        let usb = found.usb.as_ref().map(usb_words).unwrap_or_default();
        let place = format!("{}  {usb}", found.endpoint.place());
        let title = title(look, &found.endpoint, Some(found.hand_id.into()));
        hand_ui(ui, pane, &found.endpoint, (&title, place.trim_end()));
    }
    for remark in &state.scan.remarks {
        let color = match remark {
            ScanRemark::Held { .. } => look.palette.muted,
            ScanRemark::Trouble(_) | ScanRemark::Hint(_) => look.palette.warn,
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
    let hand = pane.state.hand();
    let is_now = hand.link.state.is_live() && hand.endpoint.as_ref() == Some(endpoint);
    let (text, tip, weight) = if is_now {
        (scan::CONNECTED, scan::CONNECTED_TIP, Weight::Chosen)
    } else {
        (scan::USE, scan::USE_TIP, Weight::Normal)
    };
    ui.horizontal(|ui| {
        let name = format!("{}: {endpoint}", look.say(text));
        let button = Button::new(look.say(text), look.say(tip)).named(&name);
        let size = vec2(theme::COUNT_COLUMN, theme::CONTROL_LARGE);
        let justified = Layout::top_down_justified(Align::Center);
        let button = ui.allocate_ui_with_layout(size, justified, |ui| {
            button.weight(weight).large().ui(ui, look)
        });
        if button.inner.clicked() && !is_now {
            pane.actions.push(Action::Connect(endpoint.clone()));
        }
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            Label::new(title, look.palette.text).wrap().ui(ui);
            if !place.is_empty() {
                Label::new(place, look.palette.muted).small().wrap().ui(ui);
            }
        });
    });
}

/// The id where it is known, the way of speaking, and its speed.
pub(crate) fn title(look: Look, endpoint: &Endpoint, id: Option<u16>) -> String {
    let (kind, speed) = match endpoint {
        Endpoint::Rs485(line) => (panels::KIND_RS485, Some(line.baud)),
        Endpoint::Rtu(line) => (panels::KIND_RTU, Some(line.baud)),
        Endpoint::Slcan { bitrate, .. } => (panels::KIND_SLCAN, Some(*bitrate)),
        Endpoint::UsbCan { baud, .. } => (panels::KIND_USBCAN, Some(*baud)),
        Endpoint::Can { .. } => (panels::KIND_CAN, None),
        Endpoint::Tcp { .. } => (panels::KIND_TCP, None),
        Endpoint::Sim { scenario, .. } => {
            return format!("{}, {scenario}", look.say(panels::KIND_SIM));
        }
    };
    let speed = speed.map(|speed| format!(", {speed}")).unwrap_or_default();
    let id = id.map(|id| format!("ID {id}, ")).unwrap_or_default();
    format!("{id}{}{speed}", look.say(kind))
}

fn usb_words(usb: &UsbFound) -> String {
    let named = [&usb.maker, &usb.product, &usb.serial]
        .into_iter()
        .flatten();
    let words: Vec<&str> = named.map(String::as_str).collect();
    format!(
        "{} USB {:04x}:{:04x}",
        words.join(" "),
        usb.vendor_id,
        usb.product_id
    )
    .trim_start()
    .to_owned()
}
