//! The connection: which hand, over what, and how well it goes. Asks to connect and to scan; opens nothing.
pub(crate) mod figures;
pub(crate) mod link_words;
mod rows;
pub(crate) mod scan;
mod shared;

use crate::app::action::Action;
use crate::app::hands::action::HandsAction;
use crate::app::scan::ScanTarget;
use crate::hand::SerialSpeed;
use crate::hand::register::BytePacking;
use crate::link::scan::plan::BITRATES;
use crate::poses::library::NAME_CHARS_MAX;
use crate::record::quirk_sheet::Fact;
use crate::sim::Scenario;
use crate::transport::Endpoint;
use crate::ui::connection::rows::{expert_ui, row_ui};
use crate::ui::connection::scan::ScanPanel;
use crate::ui::connection::shared::SharedPanel;
use crate::ui::kit::{self, Button, Label, Look, Pane, TextField, Weight, refused_ui};
use crate::ui::text::{errors, main, panels, scan as scan_text, window};
use crate::ui::theme;
use egui::{ScrollArea, Ui};
use std::collections::BTreeMap;
use std::net::Ipv4Addr;

/// What stands in the fields at first, as the hand is delivered (manual 1.3.2, 2.2, 2.3, 2.6.1).
const FIRST: [&str; 5] = [
    "rtu:?baud=115200&id=1",
    "slcan:?bitrate=1000000&id=1",
    "can:can0?id=1",
    "tcp:192.168.11.210:6000?unit=255",
    "sim:?seed=1&scenario=idle",
];

/// Kinds of links and their fields, both as endpoints spell them, the place first where there is one.
type EndpointKind = (&'static str, &'static [&'static str]);
static KINDS: [EndpointKind; 7] = [
    ("sim", &["scenario", "seed"]),
    ("rs485", &["port", "baud", "id"]),
    ("tcp", &["host", "unit", "packing"]),
    ("rtu", &["port", "baud", "id", "packing"]),
    ("can", &["interface", "id"]),
    ("slcan", &["port", "bitrate", "id"]),
    ("usbcan", &["port", "baud", "id"]),
];
/// Fields that say where the hand is.
const PLACES: [&str; 3] = ["port", "host", "interface"];
/// Fields that hardly anybody needs.
const RARE: [&str; 2] = ["seed", "packing"];

/// The form's fields as they are typed.
#[derive(Debug)]
pub(crate) struct ConnectionForm {
    kind: EndpointKind,
    /// By their keys; kinds share them.
    fields: BTreeMap<&'static str, String>,
    scan: ScanPanel,
    shared: SharedPanel,
    /// The spelling with which connecting was tried and that is no endpoint.
    refused: Option<String>,
    /// The endpoint that the fields were filled from, so that a new one fills them again.
    filled_from: Option<Endpoint>,
}

impl Default for ConnectionForm {
    fn default() -> Self {
        let mut form = Self {
            kind: ("", &[]),
            fields: BTreeMap::new(),
            scan: ScanPanel::default(),
            shared: SharedPanel::default(),
            refused: None,
            filled_from: None,
        };
        FIRST.into_iter().for_each(|spelled| form.fill(spelled));
        form
    }
}

impl ConnectionForm {
    /// Draws the form, the scan and, beside them, how the link goes.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let endpoint = pane.state.hand().connection.endpoint.as_ref();
        if let Some(endpoint) = endpoint.filter(|it| Some(*it) != self.filled_from.as_ref()) {
            self.filled_from = Some(endpoint.clone());
            self.fields.remove("packing");
            self.fill(&endpoint.to_string());
        }
        let is_wide = ui.available_width() >= 1400.0;
        ui.columns(if is_wide { 3 } else { 2 }, |columns| match columns {
            [left, middle, right] => {
                scroll_ui(left, "form", |ui| self.form_ui(ui, pane));
                scroll_ui(middle, "scan", |ui| self.find_ui(ui, pane));
                scroll_ui(right, "link", |ui| link_ui(ui, pane));
            }
            [left, right] => {
                scroll_ui(left, "form", |ui| {
                    self.form_ui(ui, pane);
                    self.find_ui(ui, pane);
                });
                scroll_ui(right, "link", |ui| link_ui(ui, pane));
            }
            _ => {}
        });
    }

    fn find_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.scan.ui(ui, pane);
        self.shared.ui(ui, pane);
    }

    /// Takes the fields from an endpoint's spelling.
    fn fill(&mut self, spelled: &str) {
        let (scheme, rest) = spelled.split_once(':').unwrap_or_default();
        if let Some(kind) = KINDS.iter().find(|(known, _)| *known == scheme) {
            self.kind = *kind;
        }
        let (place, query) = rest.split_once('?').unwrap_or((rest, ""));
        if let Some(key) = self.place() {
            self.fields.insert(key, place.into());
        }
        for (key, value) in query.split('&').filter_map(|pair| pair.split_once('=')) {
            if let Some(known) = self.kind.1.iter().find(|known| **known == key) {
                self.fields.insert(known, value.into());
            }
        }
    }

    /// The field that says where the hand is.
    fn place(&self) -> Option<&'static str> {
        let first = self.kind.1.first().copied();
        first.filter(|key| PLACES.contains(key))
    }

    fn field(&self, key: &str) -> &str {
        self.fields.get(key).map_or("", |text| text.trim())
    }

    /// The endpoint in the one spelling that is used everywhere.
    fn spelled(&self) -> String {
        let place = self.place().map_or("", |key| self.field(key));
        let keys = self.kind.1.iter().filter(|key| !PLACES.contains(key));
        let keys = keys.map(|key| (key, self.field(key)));
        // Nothing said of the packing is a choice, too.
        let keys = keys.filter(|(key, value)| **key != "packing" || !value.is_empty());
        let keys: Vec<String> = keys.map(|(key, value)| format!("{key}={value}")).collect();
        format!("{}:{place}?{}", self.kind.0, keys.join("&"))
    }

    fn form_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            kit::head_ui(ui, look, look.say(main::TAB_CONNECTION), |_| ());
            self.kinds_ui(ui, look);
            ui.add_space(theme::STEP);
            let mut entered = false;
            for key in self.kind.1 {
                if RARE.contains(key) {
                    expert_ui(ui, look, |ui| entered |= self.key_ui(ui, pane, key))
                } else {
                    entered |= self.key_ui(ui, pane, key)
                }
            }
            ui.add_space(theme::STEP);
            self.connect_ui(ui, pane, entered);
            let hint = look.tip(panels::kind(self.kind.0));
            Label::new(hint, look.palette.muted).wrap().ui(ui);
            ui.add_space(theme::STEP);
            hands_ui(ui, pane);
        });
        recent_ui(ui, pane);
    }

    fn kinds_ui(&mut self, ui: &mut Ui, look: Look) {
        ui.horizontal_wrapped(|ui| {
            for kind in KINDS {
                let text = panels::kind(kind.0);
                let name = format!("{}: {}", look.say(panels::CONNECTION_KIND), look.say(text));
                let button = Button::said(look, text).named(&name);
                let button = button.switch(kind.0 == self.kind.0);
                if button.ui(ui, look).clicked() {
                    self.kind = kind;
                }
            }
        });
    }

    /// Scans where the fields say, if they say where.
    fn scan_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let Some(key) = self.place() else { return };
        let (place, ids) = (self.field(key).to_owned(), self.scan.ids);
        let missing = place.is_empty().then_some(scan_text::ADDRESS_EMPTY);
        let button = Button::said(look, panels::SCAN_HERE).large();
        let wish = match key {
            _ if !scan::start_ui(ui, pane, button, missing) => return,
            "host" => return self.scan.scan_hosts(pane, place),
            "interface" => ScanTarget::Interface(place, ids),
            _ => ScanTarget::Port(place, ids),
        };
        pane.actions.push(Action::Scan(wish));
    }

    fn ports_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        row_ui(ui, look, "", |ui| {
            let find = Button::said(look, panels::PORTS_REFRESH);
            find.on_click(ui, pane, Action::FindPorts);
            if pane.state.ports.is_empty() {
                Label::note(look, panels::PORTS_NONE).wrap().ui(ui);
            }
        });
        for port in &pane.state.ports {
            let about = port.usb.as_ref().map(ToString::to_string);
            let about = about.unwrap_or_default();
            let name = format!("{}  {about}", port.path);
            row_ui(ui, look, "", |ui| {
                let button = Button::new(&port.path, look.say(panels::PORT_PICK_TIP));
                let button = button
                    .named(name.trim())
                    .choice(port.path == self.field("port"));
                if button.ui(ui, look).clicked() {
                    self.fields.insert("port", port.path.clone());
                }
                Label::new(&about, look.palette.muted).small().wrap().ui(ui);
            });
        }
    }

    /// One field: typed, or chosen where there are few; what is in force is among the choices. True if Enter was pressed in it.
    fn key_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, key: &'static str) -> bool {
        let look = pane.look;
        let plain = |number: u32| (number.to_string(), number.to_string());
        let said = |key: &str, text| (key.to_owned(), look.say(text).to_owned());
        let mut all = match key {
            "baud" => SerialSpeed::ALL.map(|speed| plain(speed.baud())).to_vec(),
            "bitrate" => BITRATES.map(plain).to_vec(),
            "scenario" => Scenario::ALL
                .map(|it| said(it.name(), panels::scenario(it)))
                .to_vec(),
            "packing" => {
                let all = BytePacking::ALL.map(|it| said(it.key(), scan_text::packing(it)));
                [said("", scan_text::AS_FOUND)]
                    .into_iter()
                    .chain(all)
                    .collect()
            }
            _ => Vec::new(),
        };
        let text = self.fields.entry(key).or_default();
        let caption = look.say(panels::setting(key));
        let mut entered = false;
        row_ui(ui, look, caption, |ui| {
            if all.is_empty() {
                let field = kit::edit_ui(ui, (caption, ""), text);
                let enter = ui.input(|input| input.key_pressed(egui::Key::Enter));
                entered = enter && field.lost_focus();
                if key == "host" && !field.has_focus() && is_wrong_ip(text) {
                    let words = look.say(panels::ADDRESS_WRONG);
                    refused_ui(ui, look, (field.id, field.rect), words);
                }
                return;
            }
            if all.iter().all(|(value, _)| value != text) {
                all.push((text.clone(), text.clone()));
            }
            let all = all
                .iter()
                .map(|(value, text)| (value.clone(), text.as_str()));
            let all: Vec<(String, &str)> = all.collect();
            ui.spacing_mut().combo_width = ui.available_width();
            kit::choose_ui(ui, caption, text, &all);
        });
        if key == "port" {
            self.ports_ui(ui, pane);
        }
        if key == "packing" {
            let tip = Label::new(look.tip(scan_text::fact(Fact::Packing)), look.palette.muted);
            tip.small().wrap().ui(ui);
        }
        entered
    }

    fn connect_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, entered: bool) {
        let look = pane.look;
        let spelled = self.spelled();
        let parsed = spelled.parse::<Endpoint>();
        row_ui(ui, look, look.say(panels::ENDPOINT), |ui| {
            let text = parsed.as_ref().map_or("-".to_owned(), Endpoint::to_string);
            let label = Label::new(&text, look.palette.text).number().wrap();
            label.named(look.say(panels::ENDPOINT)).ui(ui);
        });
        ui.horizontal_wrapped(|ui| {
            let connect = Button::said(look, panels::CONNECT);
            let recorded = pane.recorded();
            let connect = connect.weight(Weight::Strong).large().disabled(recorded);
            let pressed = connect.ui(ui, look).clicked();
            if pressed || entered && recorded.is_none() {
                match &parsed {
                    Ok(endpoint) => pane.actions.push(Action::Connect(endpoint.clone())),
                    Err(_) => self.refused = Some(spelled.clone()),
                }
            }
            let none = pane.state.hand().connection.endpoint.is_none();
            let disconnect = Button::said(look, panels::DISCONNECT)
                .disabled(none.then(|| look.say(panels::DISCONNECT_NONE)));
            disconnect.large().on_click(ui, pane, Action::Disconnect);
            self.scan_ui(ui, pane);
        });
        if let (Err(error), true) = (&parsed, self.refused.as_ref() == Some(&spelled)) {
            let text = errors::endpoint(look, error);
            Label::new(&text, look.palette.warn).wrap().ui(ui);
        }
    }
}

/// Another hand in the window; of several, the name of this one, and away with it.
fn hands_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, state) = (pane.look, pane.state);
    let (hands, hand) = (&state.hands, state.hand());
    let slot = hand.label.slot;
    if let Some(endpoint) = hand
        .connection
        .endpoint
        .as_ref()
        .filter(|_| hands.is_several())
    {
        let caption = look.say(window::HAND_NAME);
        row_ui(ui, look, look.say(window::HAND_NAME_SHORT), |ui| {
            let name = state.settings.hand_name(endpoint).unwrap_or_default();
            let field = TextField::new(caption, NAME_CHARS_MAX).hint(&hand.label.name);
            if let Some(name) = field.ui(ui, pane, name) {
                let named = HandsAction::Name(slot, name);
                pane.actions.push(Action::Hands(named));
            }
        });
    }
    ui.horizontal_wrapped(|ui| {
        let full = (!hands.has_room()).then(|| look.say(window::ADD_HAND_FULL));
        let add = Button::said(look, window::ADD_HAND).disabled(full);
        add.large()
            .on_click(ui, pane, Action::Hands(HandsAction::Add));
        if hands.is_several() {
            let remove = Button::said(look, window::REMOVE_HAND).large();
            let action = Action::Hands(HandsAction::Remove(slot));
            remove.on_click(ui, pane, action);
        }
    });
}

/// True for digits and dots that are no address; with letters it is a name. A port may stand behind it.
fn is_wrong_ip(text: &str) -> bool {
    let text = text.trim();
    let host = text.split_once(':').map_or(text, |(host, _)| host);
    let plain = |letter: char| letter.is_ascii_digit() || letter == '.';
    !host.is_empty() && host.chars().all(plain) && host.parse::<Ipv4Addr>().is_err()
}

/// A column that scrolls by itself.
fn scroll_ui(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui)) {
    ui.push_id(name, |ui| {
        let scroll = ScrollArea::vertical().auto_shrink(false);
        // The columns of egui are justified, which spreads the words of a text.
        scroll.show(ui, |ui| ui.vertical(add));
    });
}

/// How the link goes, what the line's time goes to, and what was found out about the hand.
fn link_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    figures::link_ui(ui, pane);
    figures::budget_ui(ui, pane);
}

/// Hands of before, one click each.
fn recent_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let recent = pane.state.settings.recent.iter();
    let recent: Vec<Endpoint> = recent.filter_map(|text| text.parse().ok()).collect();
    if recent.is_empty() {
        return;
    }
    kit::card_ui(ui, look, |ui| {
        kit::head_ui(ui, look, look.say(panels::RECENT), |_| ());
        for endpoint in recent {
            let (place, id) = match &endpoint {
                Endpoint::Sim { .. } => (String::new(), None),
                Endpoint::Tcp { .. } => (endpoint.place(), None),
                _ => (endpoint.place(), Some(endpoint.place_and_id().1)),
            };
            let title = scan_text::title(look, &endpoint, id);
            scan::hand_ui(ui, pane, &endpoint, (&title, &place));
        }
    });
}
