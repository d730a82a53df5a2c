//! Inputs and outputs besides the window: a list with their switches, and address, counts and control of the chosen one.

use crate::app::action::Action;
use crate::app::exhibit::ExhibitAction;
use crate::app::inputs::{InputAction, InputKind};
use crate::inputs::stream::StreamPlace;
use crate::link::Owner;
use crate::motion::source::SourceKind;
use crate::share::gateway::{ClientLease, GatewayClient};
use crate::ui::hand::panel::StillHand;
use crate::ui::inputs::mirror_card::{mirror_row, mirror_ui};
use crate::ui::inputs::pad_card::{PadCard, pad_row, pad_source_ui};
use crate::ui::inputs::source::{SourceRow, SourceSwitch, grant_client_ui, grant_ui};
use crate::ui::kit::{self, Button, Label, Look, Pane, Pick};
use crate::ui::text::{Text, errors, exhibit, inputs};
use crate::ui::theme;
use crate::ui::touch::heat;
use egui::{Panel, ScrollArea, Ui};
use std::net::{IpAddr, SocketAddr};

/// Width of the list.
const LIST: f32 = 300.0;
/// Maximum width of the settings of a source: longer lines are hard to read.
const SUBJECT_MAX: f32 = 640.0;

/// The chosen source, and text in progress.
#[derive(Debug)]
pub(crate) struct SourceCards {
    chosen: SourceCard,
    pad: PadCard,
    hand: StillHand,
    stream: String,
    is_tcp: bool,
    share: String,
    viewers: String,
    dds: String,
}

impl Default for SourceCards {
    /// Loopback by default; other addresses are the user's choice.
    fn default() -> Self {
        Self {
            chosen: SourceCard::Stream,
            pad: PadCard::default(),
            hand: StillHand::default(),
            stream: "127.0.0.1:6010".into(),
            is_tcp: false,
            share: "127.0.0.1:6001".into(),
            viewers: "127.0.0.1:8765".into(),
            dds: "127.0.0.1".into(),
        }
    }
}

/// One of the sources and readers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SourceCard {
    Stream,
    Dds,
    Gateway,
    Viewers,
    Mirror,
    Pad,
    Exhibition,
}

impl SourceCards {
    /// Draws the list, and the chosen source beside it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        use SourceCard::{Dds, Exhibition, Gateway, Mirror, Pad, Stream, Viewers};
        let mirror = pane.state.hands.is_several().then_some(Mirror);
        let all = [Stream, Dds, Pad].into_iter().chain(mirror);
        let all: Vec<SourceCard> = all.chain([Gateway, Viewers, Exhibition]).collect();
        if !all.contains(&self.chosen) {
            self.chosen = Stream;
        }
        let list = kit::bare(Panel::left("sources"), LIST, theme::GAP_RIGHT);
        list.show(ui, |ui| {
            kit::full_card_ui(ui, pane.look, |ui| {
                for source in all {
                    let row = self.row(pane, source);
                    if row.ui(ui, pane, source == self.chosen) {
                        self.chosen = source;
                    }
                }
            });
        });
        kit::full_card_ui(ui, pane.look, |ui| {
            let area = ScrollArea::vertical().auto_shrink(false);
            area.show(ui, |ui| self.chosen_ui(ui, pane));
        });
    }

    fn row(&self, pane: &Pane<'_>, source: SourceCard) -> SourceRow {
        match source {
            SourceCard::Stream => self.stream_row(pane),
            SourceCard::Dds => self.dds_row(pane),
            SourceCard::Gateway => self.gateway_row(pane),
            SourceCard::Viewers => self.viewers_row(pane),
            SourceCard::Mirror => mirror_row(pane),
            SourceCard::Pad => pad_row(pane),
            SourceCard::Exhibition => SourceRow {
                title: exhibit::ENTER,
                switch: None,
                kind: None,
                words: String::new(),
            },
        }
    }

    fn chosen_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let row = self.row(pane, self.chosen);
        ui.scope(|ui| {
            ui.set_max_width(SUBJECT_MAX.min(ui.available_width()));
            row.head_ui(ui, pane);
            match self.chosen {
                SourceCard::Stream => self.stream_ui(ui, pane, &row),
                SourceCard::Dds => self.dds_ui(ui, pane, &row),
                SourceCard::Gateway => self.gateway_ui(ui, pane, &row),
                SourceCard::Viewers => self.viewers_ui(ui, pane, &row),
                SourceCard::Mirror => mirror_ui(ui, pane, &row),
                SourceCard::Pad => pad_source_ui(ui, pane, &row),
                SourceCard::Exhibition => exhibition_ui(ui, pane),
            }
        });
        if self.chosen == SourceCard::Pad && self.pad.ui(ui, pane) {
            return;
        }
        self.hand.rest_ui(ui, pane, &heat::tips(pane), None);
    }

    fn stream_row(&self, pane: &Pane<'_>) -> SourceRow {
        let look = pane.look;
        let at = pane.hand().inputs.stream_at;
        let wanted = place(&self.stream).map(|at| {
            if self.is_tcp {
                StreamPlace::Tcp(at)
            } else {
                StreamPlace::Udp(at)
            }
        });
        let view = &pane.hand().inputs.stream_view;
        let sender = view.intake.sender.map(|(sender, _)| sender.to_string());
        let owner = stream_owner(pane);
        let words = match (at, owner.and(sender)) {
            (None, _) => look.tr(inputs::OFF).to_owned(),
            (Some(_), None) if view.is_refusing(pane.state.now) => {
                look.tr(inputs::ALL_REFUSED).to_owned()
            }
            (Some(_), None) => look.tr(inputs::NOBODY_SENDS).to_owned(),
            (Some(_), Some(sender)) => {
                let rate = format!("{:.0}", view.intake.rate_hz);
                look.fill(inputs::HZ_FROM, &[&rate, &sender])
            }
        };
        SourceRow {
            title: inputs::STREAM,
            switch: Some(SourceSwitch {
                turns_on: inputs::LISTEN,
                is_on: at.is_some(),
                action: InputAction::Listen(wanted.filter(|_| at.is_none())),
                wrong: wanted.is_none().then_some(inputs::ADDRESS_WRONG),
            }),
            kind: Some(InputKind::Source(SourceKind::Stream)),
            words,
        }
    }

    fn stream_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, row: &SourceRow) {
        let look = pane.look;
        let at = pane.hand().inputs.stream_at;
        ui.horizontal(|ui| {
            ui.add_enabled_ui(at.is_none(), |ui| {
                let both = [(false, inputs::UDP), (true, inputs::TCP)];
                Pick::new(look, inputs::STREAM).ui(ui, &mut self.is_tcp, both);
            });
            PlaceField::new(look, inputs::STREAM_AT, at.map(socket)).ui(ui, &mut self.stream);
        });
        row.state_ui(ui, pane);
        if at.is_some() {
            let view = &pane.hand().inputs.stream_view;
            let refused = view.intake.refused.iter();
            let refused = refused.map(|(fault, count)| (inputs::fault(*fault), *count));
            let counts = [
                (inputs::TAKEN_LINES, view.intake.taken),
                (inputs::NOT_GRANTED, view.not_granted),
            ];
            let odd = Some((inputs::ODD_STOPS, view.intake.odd_stops));
            let odd = odd.filter(|(_, count)| *count > 0);
            counts_ui(ui, pane, counts.into_iter().chain(odd).chain(refused));
        }
        let missing = silence(pane, stream_owner(pane));
        grant_ui(ui, pane, SourceKind::Stream, missing);
    }

    fn dds_row(&self, pane: &Pane<'_>) -> SourceRow {
        let look = pane.look;
        let view = pane.hand().inputs.dds_view.as_ref();
        let wanted = Some(self.dds.trim().to_owned()).filter(|name| !name.is_empty());
        let words = match (view, dds_owner(pane)) {
            (None, _) => look.tr(inputs::OFF).to_owned(),
            (Some(_), None) => look.tr(inputs::NOBODY_SENDS).to_owned(),
            (Some(view), Some(_)) => format!("{:.0} Hz", view.view.rate_hz),
        };
        SourceRow {
            title: inputs::DDS,
            switch: Some(SourceSwitch {
                turns_on: inputs::JOIN,
                is_on: view.is_some(),
                wrong: wanted.is_none().then_some(inputs::INTERFACE_WRONG),
                action: InputAction::JoinDds(wanted.filter(|_| view.is_none())),
            }),
            kind: Some(InputKind::Source(SourceKind::Dds)),
            words,
        }
    }

    fn dds_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, row: &SourceRow) {
        let look = pane.look;
        let view = pane.hand().inputs.dds_view.as_ref();
        let at = view.map(|view| (view.at.into(), view.at.to_string()));
        PlaceField::new(look, inputs::DDS_AT, at).ui(ui, &mut self.dds);
        row.state_ui(ui, pane);
        if let Some(view) = view {
            let counts = [
                (inputs::STATES, view.told.states),
                (inputs::COMMANDS, view.view.taken),
                (inputs::REFUSED, view.view.refused.values().sum()),
                (inputs::NOT_GRANTED, view.view.not_granted),
            ];
            let odd = Some((inputs::ODD_STOPS, view.view.odd_stops));
            let odd = odd.filter(|(_, count)| *count > 0);
            counts_ui(ui, pane, counts.into_iter().chain(odd));
            if let Some(newest) = view.view.refused.keys().next_back() {
                kit::small_text_ui(ui, look.tr(inputs::ctrl_fault(*newest)), look.palette.warn);
            }
        }
        let other = view.and_then(|view| view.other.as_ref());
        let other =
            other.map(|other| look.fill(inputs::OTHER_FOLLOWS, &[&other.host, &other.name]));
        let missing = other.as_deref().or(silence(pane, dds_owner(pane)));
        grant_ui(ui, pane, SourceKind::Dds, missing);
    }

    fn gateway_row(&self, pane: &Pane<'_>) -> SourceRow {
        let look = pane.look;
        let at = pane.hand().inputs.gateway_at;
        let wanted = place(&self.share);
        let words = match (at, pane.hand().inputs.clients.len()) {
            (None, _) => look.tr(inputs::OFF).to_owned(),
            (Some(_), 0) => look.tr(inputs::NO_CLIENTS).to_owned(),
            (Some(_), count) => look.fill(inputs::CLIENTS, &[&count]),
        };
        SourceRow {
            title: inputs::GATEWAY,
            switch: Some(SourceSwitch {
                turns_on: inputs::OPEN_GATEWAY,
                is_on: at.is_some(),
                action: InputAction::Share(wanted.filter(|_| at.is_none())),
                wrong: wanted.is_none().then_some(inputs::ADDRESS_WRONG),
            }),
            kind: Some(InputKind::Gateway),
            words,
        }
    }

    fn gateway_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, row: &SourceRow) {
        let look = pane.look;
        let at = pane.hand().inputs.gateway_at;
        PlaceField::new(look, inputs::GATEWAY_AT, at.map(socket)).ui(ui, &mut self.share);
        row.state_ui(ui, pane);
        if pane.state.settings.first_client_moves {
            kit::small_text_ui(ui, look.tr(inputs::FIRST_CLIENT), look.palette.warn);
        }
        for client in &pane.hand().inputs.clients {
            client_ui(ui, pane, client);
        }
    }

    fn viewers_row(&self, pane: &Pane<'_>) -> SourceRow {
        let look = pane.look;
        let served = pane.hand().inputs.foxglove_at;
        let wanted = place(&self.viewers);
        SourceRow {
            title: inputs::VIEWERS,
            switch: Some(SourceSwitch {
                turns_on: inputs::SHOW,
                is_on: served.is_some(),
                action: InputAction::Show(wanted.filter(|_| served.is_none())),
                wrong: wanted.is_none().then_some(inputs::ADDRESS_WRONG),
            }),
            kind: Some(InputKind::Viewers),
            words: match served {
                None => look.tr(inputs::OFF).to_owned(),
                Some((_, count)) => look.fill(inputs::VIEWERS_NOW, &[&count]),
            },
        }
    }

    fn viewers_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, row: &SourceRow) {
        let at = pane.hand().inputs.foxglove_at.map(|(at, _)| socket(at));
        PlaceField::new(pane.look, inputs::VIEWERS_AT, at).ui(ui, &mut self.viewers);
        row.state_ui(ui, pane);
    }
}

/// The program whose lines arrive; `None` if nobody sends.
fn stream_owner(pane: &Pane<'_>) -> Option<Owner> {
    let inputs = &pane.hand().inputs;
    let owner = inputs.stream_view.owner(pane.state.now);
    owner.filter(|_| inputs.stream_at.is_some())
}

/// The DDS sender whose commands arrive; `None` if nobody sends.
fn dds_owner(pane: &Pane<'_>) -> Option<Owner> {
    let view = pane.hand().inputs.dds_view.as_ref()?;
    view.view.owner(pane.state.now)
}

/// Draws the buttons that start the page for visitors.
fn exhibition_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    ui.horizontal_wrapped(|ui| {
        for (text, tip, action) in [
            (exhibit::START, exhibit::ENTER, ExhibitAction::Enter),
            (
                exhibit::ENTER_FILE,
                exhibit::ENTER_FILE,
                ExhibitAction::EnterFile,
            ),
        ] {
            let button = Button::new(look.tr(text), look.tip(tip)).large();
            button.on_click(ui, pane, Action::Exhibit(action));
        }
    });
}

fn place(text: &str) -> Option<SocketAddr> {
    text.trim().parse().ok()
}

fn socket(at: SocketAddr) -> (IpAddr, String) {
    (at.ip(), at.to_string())
}

/// Address at which a source is open or will be opened.
struct PlaceField {
    look: Look,
    name: Text,
    at: Option<(IpAddr, String)>,
}

impl PlaceField {
    const fn new(look: Look, name: Text, at: Option<(IpAddr, String)>) -> Self {
        Self { look, name, at }
    }

    fn ui(self, ui: &mut Ui, typed: &mut String) {
        let (look, name) = (self.look, self.look.tr(self.name));
        ui.horizontal(|ui| {
            ui.set_min_height(theme::CONTROL);
            match self.at {
                Some((ip, at)) if !ip.is_loopback() => {
                    let label = Label::new(&at, look.palette.warn).number().ui(ui);
                    label.on_hover_text(look.tr(inputs::OPEN_TO_ALL));
                }
                Some((_, at)) => drop(Label::new(&at, look.palette.text).number().ui(ui)),
                None => drop(kit::edit_ui(ui, name, name, typed)),
            }
        });
    }
}

/// Draws event counts in small text.
fn counts_ui(ui: &mut Ui, pane: &Pane<'_>, counts: impl IntoIterator<Item = (Text, u64)>) {
    let look = pane.look;
    let counts = counts.into_iter();
    let counts = counts.map(|(text, count)| look.pair(look.tr(text), &count.to_string()));
    let counts: Vec<String> = counts.collect();
    kit::small_text_ui(ui, &counts.join("  ·  "), look.palette.muted);
}

/// Reason why there is nothing to follow: no sender. `None` if there is one.
fn silence(pane: &Pane<'_>, owner: Option<Owner>) -> Option<&'static str> {
    let is_silent = owner.is_none();
    is_silent.then(|| pane.look.tr(inputs::NOBODY_SENDS))
}

fn client_ui(ui: &mut Ui, pane: &mut Pane<'_>, client: &GatewayClient) {
    let look = pane.look;
    ui.separator();
    let address = client.address.to_string();
    let holds = matches!(client.lease, ClientLease::Held(_));
    ui.horizontal_wrapped(|ui| {
        Label::new(&address, look.palette.text).number().ui(ui);
        if holds {
            Label::new(look.tr(inputs::MOVES), look.palette.accent).ui(ui);
        } else {
            grant_client_ui(ui, pane, client);
        }
    });
    let words = look.fill(
        inputs::CLIENT,
        &[&client.hz, &client.reads, &client.writes, &client.refused],
    );
    kit::small_text_ui(ui, &words, look.palette.muted);
    if let Some(refusal) = &client.refusal {
        kit::small_text_ui(ui, &errors::write_refusal(look, refusal), look.palette.warn);
    }
}
