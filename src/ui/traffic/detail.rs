//! One frame byte by byte: every byte with its name, its value, and which of them is wrong.

use crate::link::traffic::fields::Field;
use crate::link::traffic::frame::{Frame, hex};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, take_left};
use crate::ui::kit::format;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::traffic;
use crate::ui::theme;
use egui::{Rect, ScrollArea, Ui, UiBuilder, vec2};

/// Bytes of a field that are shown; the list shows the whole frame.
const HEX_MAX: usize = 16;

/// Draws the frame, or a hint where none or many are chosen.
pub(crate) fn detail_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, chosen: &[&Frame]) {
    let look = pane.look;
    let title = look.say(traffic::DETAIL);
    let (head, body) = controls::titled_card(ui, look, rect, title);
    match chosen {
        [frame] => {
            head_ui(ui, head, look, frame);
            fields_ui(ui, body, look, frame);
        }
        [] => {
            let hint = look.say(traffic::DETAIL_HINT);
            Label::new(hint, look.palette.faint)
                .center()
                .put(ui, controls::middle(body, theme::FIELD_ROW));
        }
        many => {
            let bytes: usize = many.iter().map(|frame| frame.bytes.len()).sum();
            let text = format!(
                "{} {}, {bytes} B",
                many.len(),
                look.say(traffic::DETAIL_MANY)
            );
            Label::new(&text, look.palette.muted)
                .center()
                .put(ui, controls::middle(body, theme::FIELD_ROW));
        }
    }
}

fn head_ui(ui: &mut Ui, rect: Rect, look: Look, frame: &Frame) {
    let mut text = format!(
        "#{}  {:.6} s  {}",
        frame.number,
        frame.at.secs(),
        look.say(traffic::kind(frame.kind))
    );
    if let Some(took) = frame.took {
        let took = format::millis(Some(took));
        text = format!("{text}  {} {took} ms", look.say(traffic::TOOK));
    }
    Label::new(&text, look.palette.muted).put(ui, rect);
}

fn fields_ui(ui: &mut Ui, rect: Rect, look: Look, frame: &Frame) {
    let mut rest = rect;
    let verdict = controls::take_top(&mut rest, theme::FIELD_ROW);
    verdict_ui(ui, verdict, look, frame);
    let fields = frame.fields();
    let inside = UiBuilder::new().max_rect(rest).id_salt("traffic fields");
    ui.scope_builder(inside, |ui| {
        ui.shrink_clip_rect(rest);
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        ScrollArea::vertical().auto_shrink(false).show_rows(
            ui,
            theme::FIELD_ROW,
            fields.len(),
            |ui, range| {
                for field in fields.get(range).unwrap_or_default() {
                    let (_, place) =
                        ui.allocate_space(vec2(rest.width() - theme::GAP, theme::FIELD_ROW));
                    field_ui(ui, place, look, frame, field);
                }
            },
        );
    });
}

fn verdict_ui(ui: &mut Ui, mut rect: Rect, look: Look, frame: &Frame) {
    let Some(wrong) = frame.wrong else {
        Label::new(look.say(traffic::ALL_WELL), look.palette.ok).put(ui, rect);
        return;
    };
    let color = if wrong.is_damage() {
        look.palette.bad
    } else {
        look.palette.warn
    };
    let sign = controls::middle(take_left(&mut rect, theme::WRONG_SIGN), theme::SIGN_SMALL);
    controls::warning_sign(ui, sign, color);
    Label::new(&traffic::wrong(look, wrong), color).put(ui, rect);
}

fn field_ui(ui: &mut Ui, mut rect: Rect, look: Look, frame: &Frame, field: &Field) {
    let palette = look.palette;
    let color = if field.wrong.is_some() {
        palette.bad
    } else {
        palette.text
    };
    let last = field.at.end.saturating_sub(1);
    let place = if field.at.len() == 1 {
        format!("{last}")
    } else {
        format!("{}-{last}", field.at.start)
    };
    let left = take_left(&mut rect, theme::FIELD_PLACE);
    Label::new(&place, palette.faint).number().put(ui, left);
    let name = match &field.register {
        Some(register) => register.as_str(),
        None => look.say(traffic::field(field.name)),
    };
    let left = take_left(&mut rect, theme::FIELD_NAME);
    Label::new(name, palette.muted).put(ui, left);
    let bytes = frame.bytes.get(field.at.clone()).unwrap_or_default();
    let mut shown = hex(bytes.get(..HEX_MAX.min(bytes.len())).unwrap_or_default());
    if bytes.len() > HEX_MAX {
        shown.push_str(" ..");
    }
    let (bytes, mut value) = rect.split_left_right_at_x(rect.left() + rect.width() * 0.5);
    Label::new(&shown, color).number().put(ui, bytes);
    if field.wrong.is_some() {
        let sign = controls::middle(take_left(&mut value, theme::WRONG_SIGN), theme::SIGN_SMALL);
        controls::warning_sign(ui, sign, color);
    }
    if !field.value.is_empty() {
        Label::new(&field.value, color)
            .number()
            .named(name)
            .put(ui, value);
    }
}
