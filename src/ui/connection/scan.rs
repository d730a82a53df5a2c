//! Scanning for hands: targets, progress, results. Requests scans and connections; opens nothing.

use crate::app::action::Action;
use crate::app::scan::{IdRange, ScanTarget};
use crate::link::scan::ScanEvent;
use crate::ui::connection::hand_tiles::{hand_tiles_ui, known_hands};
use crate::ui::connection::shared;
use crate::ui::connection::shared::{SharedInterface, shared_hands};
use crate::ui::kit::{self, Button, Label, Pane};
use crate::ui::text::{Text, scan};
use crate::ui::theme;
use egui::{ProgressBar, Ui};

/// Factory addresses of hands: the manual's (1.3.2), and two seen in the field. None is polled without a request.
const PRESETS: [(&str, Text); 3] = [
    ("192.168.11.210:6000", scan::PRESET_MAKER),
    ("192.168.123.210:6000", scan::PRESET_FIELD),
    ("192.168.123.211:6000", scan::PRESET_FIELD),
];

/// View state of the search for hands.
#[derive(Debug, Default)]
pub(crate) struct ScanPanel {
    /// Ids polled on every bus.
    pub(crate) ids: IdRange,
    shared: SharedInterface,
}

impl ScanPanel {
    /// Draws the search, and the known, found and shared hands. Returns the address that the user chose.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) -> Option<String> {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            kit::head_ui(ui, look, look.tr(scan::HANDS), |_| ());
            self.search_ui(ui, pane);
            stage_ui(ui, pane);
            remarks_ui(ui, pane);
            shared::remark_ui(ui, pane);
            let mut tiles = known_hands(pane);
            tiles.extend(shared_hands(pane));
            hand_tiles_ui(ui, pane, &tiles);
            presets_ui(ui, pane)
        })
    }

    /// Draws the button that looks everywhere a hand may be, and its limits.
    fn search_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.horizontal_wrapped(|ui| {
            if pane.state.scan.is_running() {
                let cancel = Button::text(look, scan::CANCEL);
                cancel.large().on_click(ui, pane, Action::CancelScan);
            } else if start_ui(ui, pane, Button::text(look, scan::FIND).large()) {
                pane.actions.push(Action::Scan(ScanTarget::Ports(self.ids)));
                let is_off = pane.state.fleet.interface().is_none();
                let interface = self.shared.typed().filter(|_| is_off);
                let find = interface.map(|interface| Action::FindShared(Some(interface)));
                pane.actions.extend(find);
            }
            Label::muted(look, scan::IDS).ui(ui);
            for (range, text) in [(IdRange::Few, scan::IDS_FEW), (IdRange::All, scan::IDS_ALL)] {
                let name = format!("{}: {}", look.tr(scan::IDS), look.tr(text));
                let button = Button::text(look, text)
                    .tip(look.tip(scan::IDS))
                    .named(&name);
                if button.choice(self.ids == range).ui(ui, look).clicked() {
                    self.ids = range;
                }
            }
            ui.add_space(theme::GAP);
            self.shared.ui(ui, pane);
        });
    }
}

/// Draws the factory addresses. Returns the one that the user chose.
fn presets_ui(ui: &mut Ui, pane: &Pane<'_>) -> Option<String> {
    let look = pane.look;
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        Label::muted(look, scan::PRESETS).ui(ui);
        for (address, about) in PRESETS {
            let tip = format!("{}\n{}", look.tr(about), look.tr(scan::PRESET_TIP));
            if Button::new(address, &tip).ui(ui, look).clicked() {
                chosen = Some(address.to_owned());
            }
        }
    });
    chosen
}

/// Draws a button that starts a scan, disabled while one runs. True if it was clicked.
pub(crate) fn start_ui(ui: &mut Ui, pane: &Pane<'_>, button: Button<'_>) -> bool {
    let running = pane.state.scan.is_running().then_some(scan::RUNNING);
    let reason = running.map(|reason| pane.look.tr(reason));
    let reason = pane.recorded().or(reason);
    button.disabled(reason).ui(ui, pane.look).clicked()
}

/// Draws the progress of the scan, or its outcome.
fn stage_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, state) = (pane.look, &pane.state.scan);
    if !state.is_running() {
        let (text, color) = match scan::ended(look, state) {
            Ok(text) => (text, look.palette.text),
            Err(text) => (look.tr(text).to_owned(), look.palette.muted),
        };
        Label::new(&text, color).wrap().ui(ui);
        return;
    }
    let words = scan::progress(look, state);
    let label = Label::new(&words, look.palette.text);
    label.named(look.tr(scan::PROGRESS)).ui(ui);
    let part = kit::share(state.progress.tried, state.progress.total);
    ui.add(ProgressBar::new(part).desired_height(theme::STEP));
}

/// Draws the remarks of a scan other than hands.
fn remarks_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, state) = (pane.look, pane.state);
    for remark in &state.scan.remarks {
        let color = match remark {
            ScanEvent::Held { .. } => look.palette.muted,
            _ => look.palette.warn,
        };
        Label::new(&scan::remark(look, remark), color).wrap().ui(ui);
    }
    if state.scan.left_out > 0 {
        let text = format!("+ {} {}", state.scan.left_out, look.tr(scan::MORE));
        Label::new(&text, look.palette.muted).ui(ui);
    }
}
