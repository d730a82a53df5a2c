//! A sentence whose numbers are fields, edited in place.

use crate::ui::kit::controls::{Label, cell_ui, small_text_ui, text_width};
use crate::ui::style::Look;
use crate::ui::theme;
use egui::{Ui, UiBuilder, vec2};

/// Punctuation that ends the words kept with the field before them.
const MARKS: [char; 8] = ['.', ',', ';', ':', '。', '，', '；', '：'];

/// A sentence with a field at each `{}`.
#[derive(Debug, Clone)]
pub(crate) struct Sentence<'a> {
    words: &'a str,
    widths: &'a [f32],
    wrong: Option<(usize, String)>,
}

impl<'a> Sentence<'a> {
    /// `widths` holds the width of each field, in points.
    pub(crate) const fn new(words: &'a str, widths: &'a [f32]) -> Self {
        Self {
            words,
            widths,
            wrong: None,
        }
    }

    /// Shows below the field with this number why its value is invalid.
    pub(crate) fn wrong(mut self, wrong: Option<(usize, String)>) -> Self {
        self.wrong = wrong;
        self
    }

    /// Draws it over the width of `ui`, on as many lines as needed. `field_ui` draws the field with the given number, which stays
    /// on one line with the words before it and the unit after it.
    pub(crate) fn ui(self, ui: &mut Ui, look: Look, mut field_ui: impl FnMut(&mut Ui, usize)) {
        let words_ui = |ui: &mut Ui, words: &str, width: f32| {
            if width > 0.0 {
                Label::new(words, look.palette.text).cell_ui(ui, width);
            }
        };
        let mut parts = self.words.split("{}");
        let mut before = parts.next().unwrap_or_default().trim();
        let id = ui.scope_id().with(self.words);
        let row = |ui: &mut Ui| {
            ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
            for (number, (part, width)) in parts.zip(self.widths).enumerate() {
                let mark = part.match_indices(MARKS).next();
                let end = mark.map_or(0, |(at, mark)| at + mark.len());
                let (unit, next) = part.split_at(end);
                let unit = unit.trim();
                let width_of = |words| text_width(ui, words, theme::body()).ceil();
                let [before_width, unit_width] = [width_of(before), width_of(unit)];
                let shown = [before_width, *width, unit_width].into_iter();
                let shown = shown.filter(|width| *width > 0.0);
                let all = shown.fold(-theme::STEP, |all, width| all + width + theme::STEP);
                cell_ui(ui, vec2(all, theme::CONTROL), |ui| {
                    words_ui(ui, before, before_width);
                    // Own id scope: typed text stays in its field when a field appears or disappears before it.
                    let own = UiBuilder::new().scope_id(id.with(number));
                    cell_ui(ui, vec2(*width, theme::CONTROL), |ui| {
                        ui.scope_builder(own, |ui| field_ui(ui, number));
                    });
                    words_ui(ui, unit, unit_width);
                });
                if let Some((_, why)) = self.wrong.as_ref().filter(|(at, _)| *at == number) {
                    ui.end_row();
                    small_text_ui(ui, why, look.palette.bad);
                    ui.end_row();
                }
                before = next.trim();
            }
        };
        ui.horizontal_wrapped(row);
        debug_assert!(before.is_empty(), "{} has more fields", self.words);
    }
}
