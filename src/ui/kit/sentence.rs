//! A sentence whose figures are fields, edited in place.

use crate::ui::kit::controls::{Label, cell_ui, say_ui, text_width};
use crate::ui::style::Look;
use crate::ui::theme;
use egui::{Ui, UiBuilder, vec2};

/// Ends the words that belong to the field before them.
const MARKS: [char; 8] = ['.', ',', ';', ':', '。', '，', '；', '：'];

/// A sentence with a field at each `{}`.
#[derive(Debug, Clone)]
pub(crate) struct Sentence<'a> {
    words: &'a str,
    widths: &'a [f32],
    wrong: Option<(usize, String)>,
}

impl<'a> Sentence<'a> {
    /// With how wide each field is.
    pub(crate) const fn new(words: &'a str, widths: &'a [f32]) -> Self {
        Self {
            words,
            widths,
            wrong: None,
        }
    }

    /// Says below the field of this number why what stands in it cannot be.
    pub(crate) fn wrong(mut self, wrong: Option<(usize, String)>) -> Self {
        self.wrong = wrong;
        self
    }

    /// Draws it over the width of `ui`, in as many lines as it needs. `field_ui` draws a field, by its number; that is on one line
    /// with the words before it and the unit behind it.
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
                    // What is typed into a field stays there, whatever appears before it.
                    let own = UiBuilder::new().scope_id(id.with(number));
                    cell_ui(ui, vec2(*width, theme::CONTROL), |ui| {
                        ui.scope_builder(own, |ui| field_ui(ui, number));
                    });
                    words_ui(ui, unit, unit_width);
                });
                if let Some((_, why)) = self.wrong.as_ref().filter(|(at, _)| *at == number) {
                    ui.end_row();
                    say_ui(ui, why, look.palette.bad);
                    ui.end_row();
                }
                before = next.trim();
            }
        };
        ui.horizontal_wrapped(row);
        debug_assert!(before.is_empty(), "{} has more fields", self.words);
    }
}
