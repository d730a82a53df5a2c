//! Looking for hands: what to scan, how far it is, what was found. Asks for scans and connections; opens nothing.

use crate::app::action::Action;
use crate::app::scan::{IdRange, ScanRemark, ScanStage, ScanState, ScanWish};
use crate::link::scan::{Found, Hosts};
use crate::transport::{Endpoint, UsbFound};
use crate::ui::connection::figures::paragraph_ui;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::{Text, panels, scan};
use crate::ui::theme;
use egui::{Color32, Id, Rect, TextEdit, Ui, UiBuilder, pos2, vec2};

/// Addresses that hands were delivered with: the manual's (1.3.2), and two seen in the field. None is asked unasked.
const PRESETS: [(&str, Text); 3] = [
    ("192.168.11.210:6000", scan::PRESET_MAKER),
    ("192.168.123.210:6000", scan::PRESET_FIELD),
    ("192.168.123.211:6000", scan::PRESET_FIELD),
];

/// What was chosen and typed.
#[derive(Debug, Default)]
pub(crate) struct ScanPanel {
    open: bool,
    ids: IdRange,
    address: String,
}

impl ScanPanel {
    /// Draws the scan below the form, or instead of it where there is no room for both. What is left is the form's.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        form_height: f32,
        pane: &mut Pane<'_>,
    ) -> Option<Rect> {
        if rect.height() >= form_height + theme::SCAN_LEAST {
            let (upper, lower) = rect.split_top_bottom_at_y(rect.top() + form_height);
            self.card_ui(ui, lower.with_min_y(lower.top() + theme::GAP), pane);
            return Some(upper);
        }
        if self.open {
            let mut head = self.card_ui(ui, rect, pane);
            let (text, tip) = (pane.look.say(scan::FORM), pane.look.say(scan::FORM_TIP));
            let place = take_right(&mut head, width_of(ui, text));
            let button = Button::new(text, tip).weight(Weight::Quiet);
            self.open = !button
                .put(ui, pane.look, place, Id::unique("scan back"))
                .clicked();
            return None;
        }
        let bottom = rect.bottom() - theme::CONTROL_LARGE;
        let (upper, strip) = rect.split_top_bottom_at_y(bottom);
        let button = Button::new(pane.look.say(scan::FIND), pane.look.say(scan::FIND_TIP));
        self.open = button
            .put(ui, pane.look, strip, Id::unique("scan open"))
            .clicked();
        Some(upper.with_max_y(upper.bottom() - theme::GAP))
    }

    /// Draws it; what is free beside its title.
    fn card_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) -> Rect {
        let look = pane.look;
        let (head, mut body) = controls::titled_card(ui, look, rect, look.say(scan::FIND));
        self.ports_ui(ui, take_top(&mut body, theme::CONTROL_LARGE), pane);
        self.address_ui(ui, &mut body, pane);
        stage_ui(ui, &mut body, pane);
        results_ui(ui, body, pane);
        head
    }

    fn ports_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let text = look.say(scan::SCAN_PORTS);
        let place = take_left(&mut row, width_of(ui, text));
        if pane.state.scan.is_running() {
            cancel_ui(ui, place, pane);
        } else {
            let button = Button::new(text, look.say(scan::SCAN_PORTS_TIP)).weight(Weight::Strong);
            if button
                .put(ui, look, place, Id::unique("scan ports"))
                .clicked()
            {
                pane.actions.push(Action::Scan(ScanWish::Ports(self.ids)));
            }
        }
        let mut row = controls::middle(row, theme::CONTROL);
        let ranges = [(IdRange::All, scan::IDS_ALL), (IdRange::Few, scan::IDS_FEW)];
        for (range, text) in ranges {
            let place = take_right(&mut row, width_of(ui, look.say(text)));
            let name = format!("{}: {}", look.say(scan::IDS), look.say(text));
            let button = Button::new(look.say(text), look.say(scan::IDS_TIP))
                .named(&name)
                .choice(self.ids == range);
            if button
                .put(ui, look, place, Id::unique(("scan ids", text.en)))
                .clicked()
            {
                self.ids = range;
            }
        }
        Label::new(look.say(scan::IDS), look.palette.muted)
            .right()
            .put(ui, row);
    }

    fn address_ui(&mut self, ui: &mut Ui, body: &mut Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let mut row = take_top(body, theme::LINE_HIGH);
        let text = look.say(scan::SCAN_HOST);
        let place = take_right(&mut row, width_of(ui, text));
        self.field_ui(ui, row, look);
        let hosts = self.address.parse::<Hosts>();
        let reason = if pane.state.scan.is_running() {
            Some(scan::RUNNING)
        } else if self.address.trim().is_empty() {
            Some(scan::ADDRESS_EMPTY)
        } else {
            hosts.is_err().then_some(scan::ADDRESS_WRONG)
        };
        let button = Button::new(text, look.say(scan::SCAN_HOST_TIP))
            .disabled(reason.map(|reason| look.say(reason)));
        if button
            .put(ui, look, place, Id::unique("scan host"))
            .clicked()
            && let Ok(hosts) = &hosts
        {
            pane.actions
                .push(Action::Scan(ScanWish::Hosts(hosts.clone())));
        }
        self.presets_ui(ui, body, look);
        if let (Err(error), false) = (hosts, self.address.trim().is_empty()) {
            let text = format!("{} {error}.", look.say(scan::ADDRESS_WRONG));
            paragraph_ui(ui, body, &text, look.palette.warn);
        }
    }

    fn field_ui(&mut self, ui: &mut Ui, row: Rect, look: Look) {
        let name = look.say(scan::ADDRESS);
        let edit = TextEdit::singleline(&mut self.address)
            .id(Id::unique("scan address"))
            .hint_text(name)
            .char_limit(128)
            .align(egui::Align2::LEFT_CENTER)
            .margin(theme::FIELD_INSET)
            .min_size(row.size())
            .desired_width(row.width() - theme::FIELD_MARGIN);
        let response = ui.put(row, edit);
        let value = self.address.clone();
        response.widget_info(|| {
            let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, name);
            info.current_text_value = Some(value.clone());
            info
        });
    }

    /// Small buttons beside each other, in as many rows as they need.
    fn presets_ui(&mut self, ui: &mut Ui, body: &mut Rect, look: Look) {
        let mut row = take_top(body, theme::CONTROL);
        for (address, about) in PRESETS {
            let width = width_of(ui, address);
            if row.width() < width {
                row = take_top(body, theme::CONTROL);
            }
            let place = take_left(&mut row, width);
            let tip = format!("{}. {}", look.say(about), look.say(scan::PRESET_TIP));
            let is_typed = self.address == address;
            let weight = match is_typed {
                true => Weight::Chosen,
                false => Weight::Normal,
            };
            let button = Button::new(address, &tip).choice(is_typed).weight(weight);
            if button
                .put(ui, look, place, Id::unique(("scan preset", address)))
                .clicked()
            {
                address.clone_into(&mut self.address);
            }
        }
    }
}

fn width_of(ui: &Ui, text: &str) -> f32 {
    controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD
}

fn cancel_ui(ui: &mut Ui, place: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let button = Button::new(look.say(scan::CANCEL), look.say(scan::CANCEL_TIP));
    if button
        .put(ui, look, place, Id::unique("scan cancel"))
        .clicked()
    {
        pane.actions.push(Action::CancelScan);
    }
}

/// How far the scan is, or how it ended.
fn stage_ui(ui: &mut Ui, body: &mut Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let book = &pane.state.scan;
    let stroke = egui::Stroke::new(1.0, look.palette.grid);
    ui.painter().hline(body.x_range(), body.top(), stroke);
    body.min.y += theme::GAP;
    if book.is_running() {
        let row = take_top(body, theme::FIGURE_ROW);
        Label::new(&progress_words(look, book), look.palette.text)
            .named(look.say(scan::PROGRESS))
            .put(ui, row);
        bar_ui(ui, take_top(body, theme::SCAN_BAR), look, book);
        return;
    }
    let (text, color) = match ended(look, book) {
        Ok(text) => (text, look.palette.text),
        Err(text) => (look.say(text).to_owned(), look.palette.muted),
    };
    paragraph_ui(ui, body, &text, color);
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

fn bar_ui(ui: &Ui, rect: Rect, look: Look, book: &ScanState) {
    let count = |count: usize| f32::from(u16::try_from(count).unwrap_or(u16::MAX));
    let part = count(book.progress.tried) / count(book.progress.total).max(1.0);
    let done = rect.with_max_x(rect.left() + rect.width() * part.min(1.0));
    let painter = ui.painter();
    painter.rect_filled(rect, theme::ROUND_SMALL, look.palette.sunken);
    painter.rect_filled(done, theme::ROUND_SMALL, look.palette.accent);
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
        Some(ScanWish::Ports(IdRange::All)) => scan::NOTHING_AT_ALL,
        Some(ScanWish::Ports(IdRange::Few)) | None => scan::NOTHING,
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

/// The hands, then what else there is to say; scrolls.
fn results_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    if !rect.is_positive() {
        return;
    }
    ui.scope_builder(
        UiBuilder::new().max_rect(rect).id_salt("scan results"),
        |ui| {
            ui.shrink_clip_rect(rect);
            ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
            egui::ScrollArea::vertical()
                .auto_shrink(false)
                .show(ui, |ui| {
                    let width = rect.width() - theme::GAP;
                    for (nth, found) in pane.state.scan.found.iter().enumerate() {
                        hand_ui(ui, width, (nth, found), pane);
                    }
                    for remark in &pane.state.scan.remarks {
                        let color = match remark {
                            ScanRemark::Held { .. } => pane.look.palette.muted,
                            ScanRemark::Trouble(_) | ScanRemark::Hint(_) => pane.look.palette.warn,
                        };
                        remark_ui(ui, width, &scan::remark(pane.look, remark), color);
                    }
                    let more = pane.state.scan.left_out;
                    if more > 0 {
                        let text = format!("+ {more} {}", pane.look.say(scan::MORE));
                        remark_ui(ui, width, &text, pane.look.palette.muted);
                    }
                });
        },
    );
}

/// One found hand with the button that connects to it.
fn hand_ui(ui: &mut Ui, width: f32, (nth, found): (usize, &Found), pane: &mut Pane<'_>) {
    let (whole, _) =
        ui.allocate_exact_size(vec2(width, theme::SCAN_HAND_ROW), egui::Sense::hover());
    if !ui.is_rect_visible(whole) {
        return;
    }
    let look = pane.look;
    let mut row = whole.with_max_y(whole.bottom() - theme::STEP);
    let is_live = pane.state.hand().link.state.is_live();
    let is_now = is_live && pane.state.hand().endpoint.as_ref() == Some(&found.endpoint);
    let (text, tip) = match is_now {
        true => (scan::CONNECTED, scan::CONNECTED_TIP),
        false => (scan::USE, scan::USE_TIP),
    };
    let place = take_right(&mut row, width_of(ui, look.say(scan::CONNECTED)));
    let name = format!("{}: {}", look.say(text), found.endpoint);
    let button = Button::new(look.say(text), look.say(tip))
        .named(&name)
        .weight(if is_now {
            Weight::Chosen
        } else {
            Weight::Normal
        });
    let place = controls::middle(place, theme::CONTROL_LARGE - theme::STEP);
    let clicked = button
        .put(ui, look, place, Id::unique(("scan use", nth)))
        .clicked();
    if clicked && !is_now {
        pane.actions.push(Action::Connect(found.endpoint.clone()));
    }
    controls::lamp(
        ui,
        pos2(row.left() + theme::LAMP_AT, row.center().y),
        look.palette.ok,
    );
    row.min.x += theme::FIGURE_ROW;
    let (upper, lower) = row.split_top_bottom_at_y(row.center().y + 1.0);
    Label::new(&title(look, found), look.palette.text).put(ui, upper);
    Label::new(&place_words(found), look.palette.muted)
        .small()
        .put(ui, lower);
}

/// The way of speaking, its speed, and the id.
fn title(look: Look, found: &Found) -> String {
    let (kind, speed) = match &found.endpoint {
        Endpoint::Rs485(line) => (panels::KIND_RS485, Some(line.baud)),
        Endpoint::Rtu(line) => (panels::KIND_RTU, Some(line.baud)),
        Endpoint::Slcan { bitrate, .. } => (panels::KIND_SLCAN, Some(*bitrate)),
        Endpoint::UsbCan { baud, .. } => (panels::KIND_USBCAN, Some(*baud)),
        Endpoint::Can { .. } => (panels::KIND_CAN, None),
        Endpoint::Tcp { .. } => (panels::KIND_TCP, None),
        Endpoint::Sim { .. } => (panels::KIND_SIM, None),
    };
    let speed = speed.map(|speed| format!(", {speed}")).unwrap_or_default();
    format!("ID {}, {}{speed}", found.hand_id, look.say(kind))
}

/// Where it is, and behind which adapter.
fn place_words(found: &Found) -> String {
    let usb = found.usb.as_ref().map(usb_words).unwrap_or_default();
    format!("{}  {usb}", found.endpoint.place())
        .trim_end()
        .to_owned()
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

fn remark_ui(ui: &mut Ui, width: f32, text: &str, color: Color32) {
    let galley = ui
        .painter()
        .layout(text.to_owned(), theme::body(), color, width);
    let size = vec2(width, galley.size().y + theme::GAP);
    let (place, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, text));
    ui.painter().galley(place.min, galley, color);
}
