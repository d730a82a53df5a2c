//! Numbers of the five fingertips in rows: forces, deltas, channels. Draws no picture.

use crate::hand::{Finger, TactileBlock};
use crate::ui::kit::{self, Label, Look, Pane, format};
use crate::ui::text::{Text, panels, words};
use crate::ui::theme;
use egui::{Color32, Grid, Ui};

/// One row of the table.
pub(crate) struct TouchRow {
    caption: Text,
    name: Text,
    value: fn(&TactileBlock, Look) -> String,
}

/// The normal force, also used on its own.
const NORMAL: TouchRow = TouchRow {
    caption: panels::TOUCH_NORMAL,
    name: panels::TOUCH_NORMAL_NAME,
    value: |block, _| format!("{} N", format::newtons(Some(block.normal_n))),
};

const LINES: [TouchRow; 7] = [
    NORMAL,
    TouchRow {
        caption: panels::TOUCH_SHEAR,
        name: panels::TOUCH_SHEAR_NAME,
        value: |block, _| format!("{} N", format::newtons(Some(block.tangential_n))),
    },
    TouchRow {
        caption: panels::TOUCH_DIRECTION,
        name: panels::TOUCH_DIRECTION_NAME,
        value: direction,
    },
    TouchRow {
        caption: panels::TOUCH_PROXIMITY,
        name: panels::TOUCH_PROXIMITY_NAME,
        value: |block, _| format::counts(Some(block.proximity.into())),
    },
    TouchRow {
        caption: panels::TOUCH_CHECK,
        name: panels::TOUCH_CHECK_NAME,
        value: |block, look| {
            let word = if block.check_ok() {
                panels::TOUCH_OK
            } else {
                panels::TOUCH_DIFFERS
            };
            look.tr(word).into()
        },
    },
    TouchRow {
        caption: panels::TOUCH_DELTA_N,
        name: panels::TOUCH_DELTA_N,
        value: |block, _| format::counts(Some(block.normal_delta.into())),
    },
    TouchRow {
        caption: panels::TOUCH_DELTA_T,
        name: panels::TOUCH_DELTA_T,
        value: |block, _| format::counts(Some(block.tangential_delta.into())),
    },
];

/// The direction in degrees, or the reason why there is none.
fn direction(block: &TactileBlock, look: Look) -> String {
    match (block.direction_deg(), block.direction_raw) {
        (Some(degrees), _) => format!("{degrees}°"),
        (None, u16::MAX) => look.tr(panels::TOUCH_NO_CONTACT).into(),
        (None, raw) => format!("?{raw}"),
    }
}

/// Draws the normal force of one fingertip, smaller in a narrow column so that it stands apart from its neighbours.
pub(crate) fn normal_ui(ui: &mut Ui, pane: &Pane<'_>, finger: Finger) {
    let widest = kit::text_width(ui, "00.00 N", theme::number());
    let font = if ui.available_width() < widest + theme::GAP {
        theme::small()
    } else {
        theme::number()
    };
    let (name, text) = named_value(pane, finger, &NORMAL);
    let color = color(pane, finger);
    Label::new(&text, color).font(font).named(&name).ui(ui);
}

/// Draws one number of one fingertip.
fn value_ui(ui: &mut Ui, pane: &Pane<'_>, finger: Finger, line: &TouchRow) {
    let (name, text) = named_value(pane, finger, line);
    number_ui(ui, color(pane, finger), &name, &text);
}

/// Accessible name of a number, and the number or "-".
fn named_value(pane: &Pane<'_>, finger: Finger, line: &TouchRow) -> (String, String) {
    let look = pane.look;
    let block = pane.hand().readings.sample.tactile[finger];
    let text = block.map(|block| (line.value)(&block.value, look));
    let name = look.tr_with(words::finger(finger), look.tr(line.name));
    (name, text.unwrap_or_else(|| format::UNKNOWN.to_owned()))
}

/// Colour of a fingertip's numbers, by their freshness.
fn color(pane: &Pane<'_>, finger: Finger) -> Color32 {
    let freshness = pane.tip_freshness(finger);
    pane.look.value(freshness, pane.look.palette.text)
}

/// Draws a number with its accessible name.
fn number_ui(ui: &mut Ui, color: Color32, name: &str, text: &str) {
    Label::new(text, color).number().named(name).ui(ui);
}

/// Draws all values of all fingertips, below their names.
pub(crate) fn all_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let muted = look.palette.muted;
    let width = ui.available_width() / 6.0 - ui.spacing().item_spacing.x;
    let grid = Grid::new("all fingertips")
        .striped(true)
        .min_col_width(width);
    grid.show(ui, |ui| {
        ui.label("");
        for finger in Finger::ALL {
            let color = look.palette.dof[finger.bend()];
            Label::new(look.tr(words::finger(finger)), color).ui(ui);
        }
        ui.end_row();
        for line in &LINES {
            Label::new(look.tr(line.caption), muted).ui(ui);
            for finger in Finger::ALL {
                value_ui(ui, pane, finger, line);
            }
            ui.end_row();
        }
        for channel in 0..8 {
            let caption = look.tr_with(panels::TOUCH_CHANNEL, channel + 1);
            Label::new(&caption, muted).ui(ui);
            for finger in Finger::ALL {
                let text = channel_text(pane, finger, channel);
                let text = text.unwrap_or_else(|| format::UNKNOWN.to_owned());
                let name = look.tr_with(words::finger(finger), &caption);
                number_ui(ui, color(pane, finger), &name, &text);
            }
            ui.end_row();
        }
    });
}

/// Raw value of a channel, and its change from zero.
fn channel_text(pane: &Pane<'_>, finger: Finger, channel: usize) -> Option<String> {
    let hand = pane.hand();
    let raw = hand.readings.sample.tactile[finger]?.value.raw;
    let raw = i64::from(*raw.get(channel)?);
    let zero = hand.readings.tare.zero(finger);
    let zero = zero.and_then(|zero| zero.raw.get(channel).copied());
    let change = zero.map(|zero| raw - i64::from(zero));
    let sign = if change > Some(0) { "+" } else { "" };
    let change = format!("{sign}{}", format::counts(change));
    Some(format!("{:>6} {change:>7}", format::counts(Some(raw))))
}
