//! Settings of a link, one field each: another view of the address text of a hand.

use crate::app::action::Action;
use crate::hand::SerialSpeed;
use crate::hand::register::BytePacking;
use crate::link::scan::plan::BITRATES;
use crate::record::quirk_sheet::Fact;
use crate::sim::Scenario;
use crate::transport::Endpoint;
use crate::ui::kit::{self, Button, Label, Look, Pane};
use crate::ui::text::{panels, scan};
use egui::{CollapsingHeader, Ui};
use std::collections::BTreeMap;

/// Kinds of links as written in endpoints, with their settings as delivered (manual 1.3.2, 2.2, 2.3, 2.6.1), and the keys of
/// the settings, the address first if there is one.
pub(super) const KINDS: [(&str, &[&str]); 8] = [
    ("rs485:?baud=115200&id=1", &["port", "baud", "id"]),
    (
        "tcp:192.168.11.210:6000?unit=255",
        &["host", "unit", "packing"],
    ),
    ("rtu:?baud=115200&id=1", &["port", "baud", "id", "packing"]),
    (
        "rtu+tcp:?baud=115200&id=1",
        &["host", "baud", "id", "packing"],
    ),
    ("can:can0?id=1", &["interface", "id"]),
    ("slcan:?bitrate=1000000&id=1", &["port", "bitrate", "id"]),
    ("usbcan:?baud=115200&id=1", &["port", "baud", "id"]),
    ("sim:?seed=1&scenario=idle", &["scenario", "seed"]),
];
/// Keys of addresses.
const PLACES: [&str; 3] = ["port", "host", "interface"];
/// Keys of rarely used settings.
const RARE: [&str; 2] = ["seed", "packing"];

/// Parts of an endpoint's text, valid or not, by their keys.
#[derive(Debug)]
pub(super) struct LinkFields {
    kind: String,
    keys: &'static [&'static str],
    values: BTreeMap<&'static str, String>,
}

impl LinkFields {
    /// Splits an endpoint's text; missing settings are as delivered. `None` for an unknown kind of link.
    pub(super) fn of(spelled: &str) -> Option<Self> {
        let kind = spelled.split(':').next().unwrap_or_default();
        let mut kinds = KINDS.into_iter();
        let (first, keys) = kinds.find(|(first, _)| first.split(':').next() == Some(kind))?;
        let mut fields = Self {
            kind: kind.to_owned(),
            keys,
            values: BTreeMap::new(),
        };
        fields.fill(first);
        let full = spelled.parse::<Endpoint>().map(|it| it.to_string());
        fields.fill(full.as_deref().unwrap_or(spelled));
        Some(fields)
    }

    fn fill(&mut self, spelled: &str) {
        let (_, rest) = spelled.split_once(':').unwrap_or_default();
        let (place, query) = rest.split_once('?').unwrap_or((rest, ""));
        if let Some(key) = self.place() {
            self.values.insert(key, place.into());
        }
        for (key, value) in query.split('&').filter_map(|pair| pair.split_once('=')) {
            if let Some(known) = self.keys.iter().find(|known| **known == key) {
                self.values.insert(known, value.into());
            }
        }
    }

    /// Key of the address.
    fn place(&self) -> Option<&'static str> {
        let first = self.keys.first().copied();
        first.filter(|key| PLACES.contains(key))
    }

    fn value(&self, key: &str) -> &str {
        self.values.get(key).map_or("", |text| text.trim())
    }

    /// The endpoint in its canonical text form.
    pub(super) fn spelled(&self) -> String {
        let place = self.place().map_or("", |key| self.value(key));
        let keys = self.keys.iter().filter(|key| !PLACES.contains(key));
        let keys = keys.map(|key| (key, self.value(key)));
        // An unspecified packing is a choice, too.
        let keys = keys.filter(|(key, value)| **key != "packing" || !value.is_empty());
        let keys: Vec<String> = keys.map(|(key, value)| format!("{key}={value}")).collect();
        format!("{}:{place}?{}", self.kind, keys.join("&"))
    }

    /// The same address and settings over another kind of link.
    pub(super) fn over(mut self, kind: &str) -> Self {
        if let Some(fields) = Self::of(&format!("{kind}:")) {
            let before = std::mem::replace(&mut self, fields);
            let kept = before.values.into_iter();
            let keys = self.keys;
            let kept = kept.filter(|(key, _)| keys.contains(key));
            self.values.extend(kept);
        }
        self
    }

    /// Draws a row for each setting. True if Enter was pressed in one.
    pub(super) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) -> bool {
        let mut entered = false;
        for key in self.keys {
            if RARE.contains(key) {
                let expert = CollapsingHeader::new(pane.look.tr(panels::EXPERT));
                expert.show_unindented(ui, |ui| entered |= self.key_ui(ui, pane, key));
            } else {
                entered |= self.key_ui(ui, pane, key);
            }
        }
        entered
    }

    /// Draws one setting: a text field, or a list that includes the value in force. True if Enter was pressed in it.
    fn key_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, key: &'static str) -> bool {
        let look = pane.look;
        let mut all = choices(look, key);
        let text = self.values.entry(key).or_default();
        let caption = look.tr(panels::setting(key));
        let mut entered = false;
        row_ui(ui, look, caption, |ui| {
            if all.is_empty() {
                let field = kit::edit_ui(ui, caption, "", text);
                let enter = ui.input(|input| input.key_pressed(egui::Key::Enter));
                entered = enter && field.lost_focus();
                return;
            }
            if all.iter().all(|(value, _)| value != text) {
                all.push((text.clone(), text.clone()));
            }
            ui.spacing_mut().combo_width = ui.available_width();
            kit::choose_ui(ui, caption, text, &all);
        });
        if key == "port" {
            self.ports_ui(ui, pane);
        }
        if key == "packing" {
            let tip = look.tip(scan::fact(Fact::Packing));
            kit::small_text_ui(ui, tip, look.palette.muted);
        }
        entered
    }

    /// Draws the serial ports listed by the system.
    fn ports_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        row_ui(ui, look, "", |ui| {
            let find = Button::text(look, panels::PORTS_REFRESH);
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
                let button = Button::new(&port.path, look.tr(panels::PORT_PICK_TIP));
                let is_chosen = port.path == self.value("port");
                let button = button.named(name.trim()).choice(is_chosen);
                if button.ui(ui, look).clicked() {
                    self.values.insert("port", port.path.clone());
                }
                Label::new(&about, look.palette.muted).small().wrap().ui(ui);
            });
        }
    }
}

/// Values of a setting with a fixed choice, each with its label; empty for others.
fn choices(look: Look, key: &str) -> Vec<(String, String)> {
    let plain = |number: u32| (number.to_string(), number.to_string());
    let pair = |key: &str, text| (key.to_owned(), look.tr(text).to_owned());
    match key {
        "baud" => SerialSpeed::ALL.map(|speed| plain(speed.baud())).to_vec(),
        "bitrate" => BITRATES.map(plain).to_vec(),
        "scenario" => Scenario::ALL
            .map(|it| pair(it.name(), panels::scenario(it)))
            .to_vec(),
        "packing" => {
            let all = BytePacking::ALL.map(|it| pair(it.key(), scan::packing(it)));
            [pair("", scan::AS_FOUND)].into_iter().chain(all).collect()
        }
        _ => Vec::new(),
    }
}

/// Draws a caption with content beside it.
pub(super) fn row_ui<R>(
    ui: &mut Ui,
    look: Look,
    caption: &str,
    add: impl FnOnce(&mut Ui) -> R,
) -> R {
    let row = ui.horizontal(|ui| {
        Label::new(caption, look.palette.muted).cell_ui(ui, 104.0);
        add(ui)
    });
    row.inner
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_views_of_the_text_also_where_it_is_wrong() {
        for (spelled, again) in [
            ("tcp:10.0.0.1", "tcp:10.0.0.1:6000?unit=255"),
            ("tcp:?unit=3", "tcp:?unit=3"),
            ("rs485:", "rs485:?baud=115200&id=1"),
            ("rs485:COM3?id=", "rs485:COM3?baud=115200&id="),
            (
                "rtu:COM3?id=2&packing=low",
                "rtu:COM3?baud=115200&id=2&packing=low",
            ),
            ("sim:", "sim:?scenario=idle&seed=1"),
        ] {
            assert_eq!(LinkFields::of(spelled).unwrap().spelled(), again);
        }
        assert!(LinkFields::of("usb:COM3").is_none());
    }

    #[test]
    fn another_kind_keeps_what_both_have() {
        let fields = LinkFields::of("rs485:COM3?baud=9600&id=7").unwrap();
        assert_eq!(fields.over("rtu").spelled(), "rtu:COM3?baud=9600&id=7");
        let fields = LinkFields::of("rtu:COM3?id=7&packing=low").unwrap();
        let other = fields.over("rs485").spelled();
        assert_eq!(other, "rs485:COM3?baud=115200&id=7");
    }
}
