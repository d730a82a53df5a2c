//! A sentence whose figures are fields, edited in place.

use crate::ui::kit::controls::{Label, cell_ui, text_width};
use crate::ui::style::Look;
use crate::ui::theme;
use egui::{Ui, vec2};

/// Ends the words that belong to the field before them.
const MARKS: [char; 8] = ['.', ',', ';', ':', '。', '，', '；', '：'];

/// Draws a sentence over the width of `ui`, in as many lines as it needs. `field` draws what stands at each `{}` of it, by its
/// number; it is as wide as `widths` says, and on one line with the words before it and the unit behind it.
pub(crate) fn sentence_ui(
    ui: &mut Ui,
    look: Look,
    (sentence, widths): (&str, &[f32]),
    mut field: impl FnMut(&mut Ui, usize),
) {
    let gap = theme::STEP;
    let color = look.palette.text;
    let mut parts = sentence.split("{}");
    let mut before = parts.next().unwrap_or_default().trim();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(gap, gap);
        for (number, (part, width)) in parts.zip(widths).enumerate() {
            let mut marks = part.char_indices().filter(|(_, sign)| MARKS.contains(sign));
            let end = marks.next().map_or(0, |(at, mark)| at + mark.len_utf8());
            let (unit, next) = part.split_at(end);
            let words = [before, unit.trim()].map(|words| {
                let width = text_width(ui, words, theme::body()).ceil();
                (words, width)
            });
            let shown = words.iter().filter(|(_, width)| *width > 0.0);
            let all = shown.fold(*width, |all, (_, width)| all + gap + width);
            cell_ui(ui, vec2(all, theme::CONTROL), |ui| {
                let words_ui = |ui: &mut Ui, (words, width): (&str, f32)| {
                    if width > 0.0 {
                        Label::new(words, color).cell_ui(ui, width);
                    }
                };
                let [before, unit] = words;
                words_ui(ui, before);
                cell_ui(ui, vec2(*width, theme::CONTROL), |ui| field(ui, number));
                words_ui(ui, unit);
            });
            before = next.trim();
        }
        if !before.is_empty() {
            Label::new(before, color).ui(ui);
        }
    });
}
