//! One frame byte by byte, with names, values and errors.

use crate::link::traffic::fields::Field;
use crate::link::traffic::frame::{Frame, hex};
use crate::ui::kit::{self, Label, Look, format};
use crate::ui::text::traffic;
use egui::Ui;
use egui_extras::{Column, TableBuilder, TableRow};

/// Maximum number of bytes shown of a field; the list shows the whole frame.
const HEX_MAX: usize = 16;
/// Widths of a field's position in the frame, and of its name.
const WIDTHS: [f32; 2] = [58.0, 150.0];

/// Draws the frame, or a hint unless exactly one is selected.
pub(crate) fn detail_ui(ui: &mut Ui, look: Look, chosen: &[&Frame]) {
    let title = look.tr(traffic::DETAIL);
    let text = match chosen {
        [frame] => {
            kit::head_ui(ui, look, title, |ui| {
                Label::new(&about(look, frame), look.palette.muted).ui(ui)
            });
            verdict_ui(ui, look, frame);
            fields_ui(ui, look, frame);
            return;
        }
        [] => look.tr(traffic::DETAIL_HINT).to_owned(),
        many => {
            let bytes: usize = many.iter().map(|frame| frame.bytes.len()).sum();
            let chosen = look.tr(traffic::DETAIL_MANY);
            format!("{} {chosen}, {bytes} B", many.len())
        }
    };
    kit::head_ui(ui, look, title, |_| ());
    ui.vertical_centered(|ui| Label::new(&text, look.palette.muted).wrap().ui(ui));
}

fn about(look: Look, frame: &Frame) -> String {
    let kind = look.tr(traffic::kind(frame.kind));
    let text = format!("#{}  {:.6} s  {kind}", frame.number, frame.at.secs());
    let Some(took) = frame.took else { return text };
    let took = format::millis(Some(took));
    format!("{text}  {} {took} ms", look.tr(traffic::TOOK))
}

fn verdict_ui(ui: &mut Ui, look: Look, frame: &Frame) {
    let Some(wrong) = frame.wrong else {
        Label::new(look.tr(traffic::ALL_WELL), look.palette.ok).ui(ui);
        return;
    };
    let color = if wrong.is_damage() {
        look.palette.bad
    } else {
        look.palette.warn
    };
    ui.horizontal(|ui| {
        kit::warning_ui(ui, color);
        let words = traffic::wrong(look, wrong);
        Label::new(&words, color).wrap().ui(ui);
    });
}

fn fields_ui(ui: &mut Ui, look: Look, frame: &Frame) {
    let fields = frame.fields();
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut table = TableBuilder::new(ui)
        .id_salt("traffic fields")
        .auto_shrink(false);
    for width in WIDTHS {
        table = table.column(Column::exact(width));
    }
    let rest = Column::remainder().clip(true);
    table.columns(rest, 2).body(|body| {
        body.rows(17.0, fields.len(), |mut row| {
            if let Some(field) = fields.get(row.index()) {
                field_ui(&mut row, look, frame, field);
            }
        });
    });
}

fn field_ui(row: &mut TableRow<'_, '_>, look: Look, frame: &Frame, field: &Field) {
    let palette = look.palette;
    let color = match field.wrong {
        Some(_) => palette.bad,
        None => palette.text,
    };
    let last = field.at.end.saturating_sub(1);
    let place = match field.at.len() {
        1 => format!("{last}"),
        _ => format!("{}-{last}", field.at.start),
    };
    let name = match &field.register {
        Some(register) => register.as_str(),
        None => look.tr(traffic::field(field.name)),
    };
    let bytes = frame.bytes.get(field.at.clone()).unwrap_or_default();
    let mut shown = hex(bytes.get(..HEX_MAX.min(bytes.len())).unwrap_or_default());
    if bytes.len() > HEX_MAX {
        shown.push_str(" ..");
    }
    Label::new(&place, palette.muted).number().column_ui(row);
    Label::new(name, palette.muted).column_ui(row);
    Label::new(&shown, color).number().column_ui(row);
    row.col(|ui| {
        if field.wrong.is_some() {
            kit::warning_ui(ui, color);
        }
        if !field.value.is_empty() {
            Label::new(&field.value, color).number().named(name).ui(ui);
        }
    });
}
