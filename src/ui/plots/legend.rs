//! What the colours and strokes of a chart stand for.

use crate::ui::kit::{self, Label, Look, dash};
use crate::ui::theme;
use egui::{Color32, Stroke, Ui, vec2};
use egui_plot::LineStyle;

/// What a colour and a kind of stroke stand for.
pub(crate) struct LegendKey {
    pub(crate) words: String,
    pub(crate) color: Color32,
    /// The kind of stroke.
    pub(crate) style: LineStyle,
}

/// Keys in one row, as many as it has room for, and how many more there are.
pub(crate) fn legend_ui(ui: &mut Ui, look: Look, keys: &[LegendKey]) {
    ui.horizontal(|ui| {
        ui.set_height(theme::LIST_LINE);
        for (at, key) in keys.iter().enumerate() {
            let width = kit::text_width(ui, &key.words, theme::small());
            // Room for the sign, the gaps and the count of those that are left.
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
