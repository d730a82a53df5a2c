//! The connection: which hand, over what, and how well it goes. Asks to connect; opens nothing.
pub(crate) mod budget;
pub(crate) mod figures;
pub(crate) mod link_words;
pub(crate) mod packing_row;
pub(crate) mod quirk_sheet;
pub(crate) mod scan;

use crate::app::action::Action;
use crate::transport::endpoint::{
    DEFAULT_BAUD, DEFAULT_BITRATE, DEFAULT_ID, DEFAULT_SCENARIO, DEFAULT_TCP_PORT, DEFAULT_UNIT,
};
use crate::transport::{Endpoint, Packing};
use crate::ui::connection::figures as link_figures;
use crate::ui::connection::packing_row::packing_ui;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::look::Pane;

use crate::ui::connection::scan::ScanPanel;
use crate::ui::text::{Text, panels, quirks};
use crate::ui::theme;
use egui::{Id, Rect, TextEdit, Ui, vec2};

/// Width of the captions of the form.
const CAPTION: f32 = theme::CAPTION_WIDE;
/// Height of the longest form but that of Modbus RTU, with one row of ports.
const HEIGHT: f32 = theme::CONNECTION_CARD;
/// Rows of ports shown at once.
const PORTS_MAX: usize = 4;

/// One kind of link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Kind {
    #[default]
    Sim,
    Rs485,
    Tcp,
    Rtu,
    Can,
    Slcan,
    UsbCan,
}

impl Kind {
    const ALL: [Self; 7] = [
        Self::Sim,
        Self::Rs485,
        Self::Tcp,
        Self::Rtu,
        Self::Can,
        Self::Slcan,
        Self::UsbCan,
    ];

    const fn text(self) -> Text {
        match self {
            Self::Sim => panels::KIND_SIM,
            Self::Rs485 => panels::KIND_RS485,
            Self::Rtu => panels::KIND_RTU,
            Self::Tcp => panels::KIND_TCP,
            Self::Can => panels::KIND_CAN,
            Self::Slcan => panels::KIND_SLCAN,
            Self::UsbCan => panels::KIND_USBCAN,
        }
    }

    const fn hint(self) -> Text {
        match self {
            Self::Sim => panels::HINT_SIM,
            Self::Rs485 | Self::Rtu => panels::HINT_SERIAL,
            Self::Tcp => panels::HINT_TCP,
            Self::Can => panels::HINT_CAN,
            Self::Slcan => panels::HINT_SLCAN,
            Self::UsbCan => panels::HINT_USBCAN,
        }
    }
}

/// The form's fields as they are typed.
#[derive(Debug)]
pub(crate) struct ConnectionForm {
    kind: Kind,
    seed: String,
    scenario: String,
    port: String,
    baud: String,
    id: String,
    host: String,
    tcp_port: String,
    unit: String,
    packing: Option<Packing>,
    interface: String,
    bitrate: String,
    scan: ScanPanel,
    /// Whether the line's time is shown where the hand's own ways would be.
    shows_budget: bool,
    /// The endpoint that the fields were filled from, so that a new one fills them again.
    filled_from: Option<Endpoint>,
}

impl Default for ConnectionForm {
    fn default() -> Self {
        Self {
            kind: Kind::Sim,
            seed: "1".into(),
            scenario: DEFAULT_SCENARIO.into(),
            port: String::new(),
            baud: DEFAULT_BAUD.to_string(),
            id: DEFAULT_ID.to_string(),
            host: "192.168.11.210".into(),
            tcp_port: DEFAULT_TCP_PORT.to_string(),
            unit: DEFAULT_UNIT.to_string(),
            packing: None,
            interface: "can0".into(),
            bitrate: DEFAULT_BITRATE.to_string(),
            scan: ScanPanel::default(),
            shows_budget: false,
            filled_from: None,
        }
    }
}

/// Width of the button that swaps the card below the figures.
const SWAP: f32 = theme::SWAP;

impl ConnectionForm {
    /// Draws the form and, beside it, how the link goes.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        self.fill(pane.state.hand().endpoint.as_ref());
        let (left, right) = rect.split_left_right_at_x(rect.left() + rect.width() * 0.56);
        let left = left.with_max_x(left.right() - theme::GAP);
        let height = self.height(pane.state.ports.len());
        if let Some(left) = self.scan.ui(ui, left, height, pane) {
            self.form_ui(ui, left, pane);
        }
        self.link_ui(ui, right, pane);
    }

    /// How the link goes, and below it what was found out about the hand; or, where there is no room for both, what the
    /// line's time goes to.
    fn link_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let (figures, sheet) = rect.split_top_bottom_at_y(rect.bottom() - quirk_sheet::HEIGHT);
        let figures = figures.with_max_y(figures.bottom() - theme::GAP);
        let swaps = link_figures::has_budget(rect) && !link_figures::has_budget(figures);
        if swaps && self.shows_budget {
            link_figures::link_ui(ui, rect, pane);
        } else {
            link_figures::link_ui(ui, figures, pane);
            quirk_sheet::sheet_ui(ui, sheet, pane);
        }
        if !swaps {
            return;
        }
        let look = pane.look;
        let (other, tip) = if self.shows_budget {
            (quirks::SHORT, quirks::SHORT_TIP)
        } else {
            (panels::BUDGET, quirks::BUDGET_TIP)
        };
        let corner = sheet.right_top() + vec2(-theme::PAD, theme::PAD);
        let place =
            Rect::from_min_max(corner - vec2(SWAP, 0.0), corner + vec2(0.0, theme::CONTROL));
        let swap = Button::new(look.say(other), look.say(tip));
        if swap.put(ui, look, place, Id::unique("swap")).clicked() {
            self.shows_budget = !self.shows_budget;
        }
    }

    /// Height of the form with so many ports listed.
    fn height(&self, ports: usize) -> f32 {
        let more = (1..PORTS_MAX.min(ports)).map(|_| theme::CONTROL + theme::GAP);
        let packing = match self.kind {
            Kind::Rtu => packing_row::HEIGHT,
            _ => 0.0,
        };
        HEIGHT + packing + more.sum::<f32>()
    }

    fn fill(&mut self, endpoint: Option<&Endpoint>) {
        if endpoint.is_none() || endpoint == self.filled_from.as_ref() {
            return;
        }
        self.filled_from = endpoint.cloned();
        match endpoint {
            Some(Endpoint::Sim { seed, scenario }) => {
                self.kind = Kind::Sim;
                self.seed = seed.to_string();
                self.scenario.clone_from(scenario);
            }
            Some(Endpoint::Rs485(line) | Endpoint::Rtu(line)) => {
                self.kind = if matches!(endpoint, Some(Endpoint::Rtu(_))) {
                    Kind::Rtu
                } else {
                    Kind::Rs485
                };
                self.port.clone_from(&line.port);
                self.baud = line.baud.to_string();
                self.id = line.id.to_string();
                self.packing = line.packing;
            }
            Some(Endpoint::Tcp {
                host,
                port,
                unit,
                packing,
            }) => {
                self.packing = *packing;
                self.kind = Kind::Tcp;
                self.host.clone_from(host);
                self.tcp_port = port.to_string();
                self.unit = unit.to_string();
            }
            Some(Endpoint::Can { interface, id }) => {
                self.kind = Kind::Can;
                self.interface.clone_from(interface);
                self.id = id.to_string();
            }
            Some(Endpoint::Slcan { port, bitrate, id }) => {
                self.kind = Kind::Slcan;
                self.port.clone_from(port);
                self.bitrate = bitrate.to_string();
                self.id = id.to_string();
            }
            Some(Endpoint::UsbCan { port, baud, id }) => {
                self.kind = Kind::UsbCan;
                self.port.clone_from(port);
                self.baud = baud.to_string();
                self.id = id.to_string();
            }
            _ => {}
        }
    }

    /// The endpoint in the one spelling that is used everywhere.
    fn spelled(&self) -> String {
        let trimmed = |text: &String| text.trim().to_owned();
        match self.kind {
            Kind::Sim => format!(
                "sim:?seed={}&scenario={}",
                trimmed(&self.seed),
                trimmed(&self.scenario)
            ),
            Kind::Can => format!("can:{}?id={}", trimmed(&self.interface), trimmed(&self.id)),
            Kind::Slcan => format!(
                "slcan:{}?bitrate={}&id={}",
                trimmed(&self.port),
                trimmed(&self.bitrate),
                trimmed(&self.id)
            ),
            Kind::Rs485 | Kind::Rtu | Kind::UsbCan => format!(
                "{}:{}?baud={}&id={}{}",
                match self.kind {
                    Kind::Rtu => "rtu",
                    Kind::UsbCan => "usbcan",
                    _ => "rs485",
                },
                trimmed(&self.port),
                trimmed(&self.baud),
                trimmed(&self.id),
                self.packing_key()
            ),
            Kind::Tcp => {
                let host = trimmed(&self.host);
                let host = if host.contains(':') && !host.starts_with('[') {
                    format!("[{host}]")
                } else {
                    host
                };
                format!(
                    "tcp:{host}:{}?unit={}{}",
                    trimmed(&self.tcp_port),
                    trimmed(&self.unit),
                    self.packing_key()
                )
            }
        }
    }

    fn packing_key(&self) -> String {
        let has_words = matches!(self.kind, Kind::Rtu | Kind::Tcp);
        let chosen = self.packing.filter(|_| has_words);
        chosen.map_or_else(String::new, |packing| format!("&packing={packing}"))
    }

    fn form_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let (_, mut body) = controls::titled_card(ui, look, rect, look.say(panels::CONNECTION));
        let kinds = take_top(&mut body, 2.0 * theme::CONTROL_LARGE + theme::GAP);
        self.kinds_ui(ui, kinds, pane);
        take_top(&mut body, theme::STEP);
        match self.kind {
            Kind::Sim => {
                field_ui(
                    ui,
                    &mut body,
                    pane,
                    panels::SCENARIO,
                    "",
                    &mut self.scenario,
                );
                field_ui(ui, &mut body, pane, panels::SEED, "", &mut self.seed);
            }
            Kind::Rs485 | Kind::Rtu | Kind::Slcan | Kind::UsbCan => {
                let hint = look.say(panels::PORT_HINT);
                field_ui(ui, &mut body, pane, panels::PORT, hint, &mut self.port);
                self.ports_ui(ui, &mut body, pane);
                let (caption, speed) = match self.kind {
                    Kind::Slcan => (panels::BITRATE, &mut self.bitrate),
                    _ => (panels::BAUD, &mut self.baud),
                };
                field_ui(ui, &mut body, pane, caption, "", speed);
                field_ui(ui, &mut body, pane, panels::HAND_ID, "", &mut self.id);
                if self.kind == Kind::Rtu {
                    packing_ui(ui, &mut body, pane, CAPTION - theme::GAP, &mut self.packing);
                }
            }
            Kind::Can => {
                let interface = &mut self.interface;
                field_ui(ui, &mut body, pane, panels::INTERFACE, "can0", interface);
                field_ui(ui, &mut body, pane, panels::HAND_ID, "", &mut self.id);
            }
            Kind::Tcp => {
                field_ui(ui, &mut body, pane, panels::HOST, "", &mut self.host);
                field_ui(
                    ui,
                    &mut body,
                    pane,
                    panels::TCP_PORT,
                    "",
                    &mut self.tcp_port,
                );
                field_ui(ui, &mut body, pane, panels::UNIT, "", &mut self.unit);
                packing_ui(ui, &mut body, pane, CAPTION - theme::GAP, &mut self.packing);
            }
        }
        take_top(&mut body, theme::STEP);
        let spelled = self.spelled();
        let parsed: Result<Endpoint, _> = spelled.parse();
        let caption = (look.say(panels::ENDPOINT), CAPTION - theme::GAP);
        let value = (spelled.as_str(), theme::number(), look.palette.text);
        link_figures::fact_ui(ui, &mut body, caption, look.palette.muted, value);
        if let Err(error) = &parsed {
            let text = format!("{} {error}.", look.say(panels::FORM_WRONG));
            link_figures::paragraph_ui(ui, &mut body, &text, look.palette.warn);
        }
        take_top(&mut body, theme::STEP);
        connect_ui(
            ui,
            take_top(&mut body, theme::CONTROL_LARGE),
            pane,
            parsed.ok(),
        );
        take_top(&mut body, theme::STEP);
        link_figures::paragraph_ui(
            ui,
            &mut body,
            look.say(self.kind.hint()),
            look.palette.muted,
        );
    }

    fn kinds_ui(&mut self, ui: &mut Ui, mut rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let (upper, lower) = Kind::ALL.split_at(4);
        for kinds in [upper, lower] {
            let mut row = take_top(&mut rect, theme::CONTROL_LARGE);
            // Each as wide as its text, and an equal share of what is left.
            let texts: Vec<f32> = kinds
                .iter()
                .map(|kind| controls::text_width(ui, look.say(kind.text()), theme::body()))
                .collect();
            let taken: f32 = texts.iter().map(|text| text + theme::GAP).sum();
            let count: f32 = texts.iter().map(|_| 1.0).sum();
            let share = (row.width() + theme::GAP - taken) / count;
            for (kind, text) in kinds.iter().zip(texts) {
                let place = take_left(&mut row, text + share);
                self.kind_ui(ui, place, pane, *kind);
            }
        }
    }

    fn kind_ui(&mut self, ui: &mut Ui, place: Rect, pane: &Pane<'_>, kind: Kind) {
        let look = pane.look;
        let chosen = kind == self.kind;
        let text = look.say(kind.text());
        let name = format!("{}: {text}", look.say(panels::CONNECTION_KIND));
        let mut button = Button::new(text, look.say(panels::KIND_TIP))
            .named(&name)
            .weight(if chosen {
                Weight::Chosen
            } else {
                Weight::Normal
            });
        button.selected = Some(chosen);
        let id = Id::unique(("kind", kind.text().en));
        if button.put(ui, look, place, id).clicked() {
            self.kind = kind;
        }
    }

    fn ports_ui(&mut self, ui: &mut Ui, body: &mut Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let text = look.say(panels::PORTS_REFRESH);
        let mut row = take_top(body, theme::CONTROL);
        row.min.x += CAPTION;
        let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
        let place = take_right(&mut row, width);
        let button = Button::new(text, look.say(panels::PORTS_REFRESH_TIP));
        if button
            .put(ui, look, place, Id::unique("find ports"))
            .clicked()
        {
            pane.actions.push(Action::FindPorts);
        }
        if pane.state.ports.is_empty() {
            Label::new(look.say(panels::PORTS_NONE), look.palette.muted)
                .small()
                .put(ui, row);
            return;
        }
        for (n, port) in pane.state.ports.iter().take(PORTS_MAX).enumerate() {
            if n > 0 {
                row = take_top(body, theme::CONTROL);
                row.min.x += CAPTION;
            }
            let about = port.about.as_deref().unwrap_or_default();
            let name = format!("{}  {about}", port.path);
            let whole = controls::text_width(ui, name.trim(), theme::body()) + 2.0 * theme::GAP;
            let text = if whole > row.width() {
                &port.path
            } else {
                name.trim()
            };
            let tip = format!("{}\n{}", name.trim(), look.say(panels::PORT_PICK_TIP));
            let button = Button::new(text, &tip)
                .named(name.trim())
                .choice(port.path == self.port);
            if button.put(ui, look, row, Id::unique(("port", n))).clicked() {
                self.port.clone_from(&port.path);
            }
        }
    }
}

fn field_ui(
    ui: &mut Ui,
    body: &mut Rect,
    pane: &Pane<'_>,
    caption: Text,
    hint: &str,
    text: &mut String,
) {
    let look = pane.look;
    let mut row = take_top(body, theme::LINE_HIGH);
    let name = look.say(caption);
    let left = take_left(&mut row, CAPTION - theme::GAP);
    Label::new(name, look.palette.muted).put(ui, left);
    let edit = TextEdit::singleline(text)
        .id(Id::unique(("connection", caption.en)))
        .hint_text(hint.to_owned())
        .char_limit(128)
        .align(egui::Align2::LEFT_CENTER)
        .margin(theme::FIELD_INSET)
        .min_size(row.size())
        .desired_width(row.width() - theme::FIELD_MARGIN);
    let response = ui.put(row, edit);
    let value = text.clone();
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, name);
        info.current_text_value = Some(value.clone());
        info
    });
}

fn connect_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, endpoint: Option<Endpoint>) {
    let look = pane.look;
    let mut row = rect.with_min_x(rect.left() + CAPTION);
    let width = (row.width() - theme::GAP) / 2.0;
    let left = take_left(&mut row, width);
    let wrong = endpoint.is_none().then(|| look.say(panels::FORM_WRONG));
    let connect = Button::new(look.say(panels::CONNECT), look.say(panels::CONNECT_TIP))
        .weight(Weight::Strong)
        .disabled(wrong);
    if connect.put(ui, look, left, Id::unique("connect")).clicked()
        && let Some(endpoint) = endpoint
    {
        pane.actions.push(Action::Connect(endpoint));
    }
    let nothing = pane
        .state
        .hand()
        .endpoint
        .is_none()
        .then(|| look.say(panels::DISCONNECT_NONE));
    let disconnect = Button::new(
        look.say(panels::DISCONNECT),
        look.say(panels::DISCONNECT_TIP),
    )
    .disabled(nothing);
    if disconnect
        .put(ui, look, row, Id::unique("disconnect"))
        .clicked()
    {
        pane.actions.push(Action::Disconnect);
    }
}
