//! What was found out about the hand that answers: shown and copied. Asks for nothing, changes nothing.

use crate::link::quirks::baud_of_code;
use crate::link::quirks::book::{self, QuirkBook};
use crate::record::quirk_sheet::Fact;
use crate::transport::Endpoint;
use crate::ui::connection::rows::{expert_ui, row_ui};
use crate::ui::kit::{self, Button, Label, Pane, format};
use crate::ui::text::{Text, quirks as text};
use egui::Ui;

/// The edition of the manual by which a code is read; others number differently.
const EDITION: &str = "V1.0.0";

/// Draws the card.
pub(crate) fn sheet_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let color = match pane.state.hand().link.state.is_live() {
        true => look.palette.text,
        false => look.palette.faint,
    };
    let line = |ui: &mut Ui, caption: Text, value: Option<String>| {
        let caption = look.say(caption);
        let value = value.unwrap_or_else(|| format::UNKNOWN.to_owned());
        row_ui(ui, look, caption, |ui| {
            Label::new(&value, color).named(caption).wrap().ui(ui);
        });
    };
    let said = |text: Text| look.say(text).to_owned();
    let quirks = &pane.state.hand().link.quirks;
    kit::card_ui(ui, look, |ui| {
        kit::head_ui(ui, look, look.say(text::SHEET), |ui| copy_ui(ui, pane));
        line(
            ui,
            text::fact(Fact::HandId),
            quirks.hand_id.map(|id| id.to_string()),
        );
        if let Some(packing) = packing(pane) {
            line(ui, text::fact(Fact::Packing), Some(packing));
        }
        let touch = quirks.touch.map(|touch| said(text::touch(touch)));
        line(ui, text::fact(Fact::Touch), touch);
        if let Some(sheet) = &pane.state.hand().sheet {
            let seen = format!("{} .. {}", sheet.first_seen, sheet.last_seen);
            line(ui, text::SEEN, Some(seen));
        }
        expert_ui(ui, look, |ui| {
            let code = quirks.baud_code.map(|code| baud(pane, code));
            line(ui, text::fact(Fact::BaudCode), code);
            // On CAN nobody asks for it.
            if !is_can(pane) {
                line(
                    ui,
                    text::fact(Fact::Gap),
                    quirks.gap.map(|gap| said(text::gap(gap))),
                );
            }
        });
    });
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
        Some(chosen) => format!(
            "{} ({}: {})",
            look.say(found),
            chosen.key(),
            look.say(text::CHOSEN)
        ),
    })
}

fn copy_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let hand = pane.state.hand();
    let endpoint = hand.endpoint.as_ref().filter(|_| hand.link.state.is_live());
    let button =
        Button::said(look, text::COPY).disabled_if(endpoint.is_none(), look.say(text::COPY_OFF));
    if button.ui(ui, look).clicked()
        && let Some(endpoint) = endpoint
    {
        let found = || book::sheet(endpoint, &hand.link.quirks, "");
        let sheet = hand.sheet.clone().unwrap_or_else(found);
        ui.ctx().copy_text(QuirkBook::of(sheet).to_toml());
    }
}
