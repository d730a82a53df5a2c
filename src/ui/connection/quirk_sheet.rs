//! What was found out about the hand that answers: shown and copied. Asks for nothing, changes nothing.

use crate::link::quirks::baud_of_code;
use crate::link::quirks::book::{self, QuirkBook};
use crate::transport::Endpoint;
use crate::ui::connection::figures as link_figures;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, take_left, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::params::flash::guarded_ui;
use crate::ui::text::{Text, quirks as text};
use crate::ui::theme;
use egui::{Id, Rect, Ui};

/// Height of the card: a title, six lines, and the button.
pub(crate) const HEIGHT: f32 = theme::FIGURES_CARD;
/// The edition of the manual by which a code is read; others number differently.
const EDITION: &str = "V1.0.0";
/// Width of the captions.
const CAPTION: f32 = theme::CAPTION_WIDE;
const COPY_WIDTH: f32 = theme::COPY_BUTTON;

/// Draws the card.
pub(crate) fn sheet_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let (_, mut body) = controls::titled_card(ui, look, rect, look.say(text::SHEET));
    let live = pane.state.hand().link.state.is_live();
    let color = if live {
        look.palette.text
    } else {
        look.palette.faint
    };
    for (caption, value) in lines(pane) {
        let caption = (look.say(caption), CAPTION);
        let value = (value.as_str(), theme::body(), color);
        link_figures::fact_ui(ui, &mut body, caption, look.palette.muted, value);
        body.min.y -= theme::GAP - 2.0;
    }
    body.min.y += theme::GAP;
    copy_ui(ui, body, pane);
    let foot = body.with_min_y(body.bottom() - theme::CONTROL);
    let right = egui::Layout::right_to_left(egui::Align::Center);
    let place = egui::UiBuilder::new().max_rect(foot).layout(right);
    ui.scope_builder(place, |ui| guarded_ui(ui, pane));
}

fn lines(pane: &Pane<'_>) -> Vec<(Text, String)> {
    let look = pane.look;
    let quirks = &pane.state.hand().link.quirks;
    let said = |text| look.say(text).to_owned();
    let or_unknown = |value: Option<String>| value.unwrap_or_else(|| said(text::UNKNOWN));
    let id = quirks.hand_id.map(|id| id.to_string());
    let mut lines = vec![
        (text::HAND_ID, or_unknown(id)),
        (
            text::BAUD_CODE,
            or_unknown(quirks.baud_code.map(|code| baud(pane, code))),
        ),
    ];
    if let Some(packing) = packing(pane) {
        lines.push((text::PACKING, packing));
    }
    let gap = quirks.gap.map(|gap| said(text::gap(gap)));
    let touch = quirks.touch.map(|touch| said(text::touch(touch)));
    // On CAN nobody asks for it.
    if !is_can(pane) {
        lines.push((text::GAP, or_unknown(gap)));
    }
    lines.push((text::TOUCH, or_unknown(touch)));
    if let Some(sheet) = &pane.state.hand().sheet {
        lines.push((
            text::SEEN,
            format!("{} .. {}", sheet.first_seen, sheet.last_seen),
        ));
    }
    lines
}

fn is_can(pane: &Pane<'_>) -> bool {
    pane.state
        .hand()
        .endpoint
        .as_ref()
        .is_some_and(Endpoint::is_can)
}

/// A code and what it means, never without saying by whose reading.
fn baud(pane: &Pane<'_>, code: u8) -> String {
    match baud_of_code(code, is_can(pane)) {
        Some(baud) => format!("{code} = {baud} ({EDITION})"),
        None => format!("{code} = {} ({EDITION})", pane.look.say(text::BAUD_NONE)),
    }
}

/// How bytes stand in words, where the wire has words: found, chosen, or not known.
fn packing(pane: &Pane<'_>) -> Option<String> {
    let look = pane.look;
    let chosen = match pane.state.hand().endpoint.as_ref()? {
        Endpoint::Tcp { packing, .. } => *packing,
        Endpoint::Rtu(line) => line.packing,
        _ => return None,
    };
    let found = match pane.state.hand().link.quirks.packing {
        Some(packing) => text::packing(packing),
        None => text::PACKING_UNKNOWN,
    };
    Some(match chosen {
        None => look.say(found).to_owned(),
        Some(chosen) => format!("{} ({chosen}: {})", look.say(found), look.say(text::CHOSEN)),
    })
}

fn copy_ui(ui: &mut Ui, mut body: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let mut row = take_top(&mut body, theme::CONTROL);
    let place = take_left(&mut row, COPY_WIDTH);
    let endpoint = pane.state.hand().endpoint.as_ref();
    let live = pane.state.hand().link.state.is_live();
    let off = (!live || endpoint.is_none()).then(|| look.say(text::COPY_OFF));
    let button = Button::new(look.say(text::COPY), look.say(text::COPY_TIP)).disabled(off);
    if button
        .put(ui, look, place, Id::unique("copy quirks"))
        .clicked()
        && let Some(endpoint) = endpoint
    {
        let found = || book::sheet(endpoint, &pane.state.hand().link.quirks, "");
        let sheet = pane.state.hand().sheet.clone().unwrap_or_else(found);
        ui.ctx().copy_text(QuirkBook::of(sheet).to_toml());
    }
}
