//! Legend of the colours and line styles of a chart.

use crate::ui::kit::{self, Label, Look, dash};
use crate::ui::theme;
use egui::{Color32, Stroke, Ui, vec2};
use egui_plot::LineStyle;

/// Meaning of a colour and a line style.
pub(crate) struct LegendKey {
    pub(crate) words: String,
    pub(crate) color: Color32,
    pub(crate) style: LineStyle,
}

/// Draws the keys on one row, as many as fit, with the number of further ones.
pub(crate) fn legend_ui(ui: &mut Ui, look: Look, keys: &[LegendKey]) {
    ui.horizontal(|ui| {
        ui.set_height(theme::LIST_LINE);
        for (at, key) in keys.iter().enumerate() {
            let width = kit::text_width(ui, &key.words, theme::small());
            // Space for the sample, the gaps and the count of the remaining keys.
            if at > 0 && width + 2.0 * theme::KEY_SIGN + 3.0 * theme::GAP > ui.available_width() {
                let more = format!("+{}", keys.len() - at);
                Label::new(&more, look.palette.muted).small().ui(ui);
                break;
            }
            let (_, sign) = ui.allocate_space(vec2(theme::KEY_SIGN, theme::LIST_LINE));
            let stroke = Stroke::new(theme::STRONG, key.color);
            dash::sample(ui.painter(), sign, key.style, stroke);
            Label::new(&key.words, look.palette.text).small().ui(ui);
        }
    });
}
