//! The number field: nothing that is typed counts before Enter. Knows no joint.

use crate::ui::kit::format::UNKNOWN;
use crate::ui::kit::look::{Look, Typing};
use crate::ui::kit::text_field::refused_ui;
use crate::ui::text::main;
use crate::ui::theme;
use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Align2, Id, Key, Rect, Role, Stroke, TextEdit, Ui, UiBuilder, WidgetInfo, vec2};
use std::ops::RangeInclusive;

/// Characters that fit in a field.
const TYPED_MAX: usize = 8;

/// A number field at a place.
#[derive(Debug, Clone)]
pub(crate) struct NumberField<'a> {
    /// What a screen reader says.
    pub(crate) name: &'a str,
    /// What it does, in a sentence.
    pub(crate) tip: &'a str,
    /// Why nothing can be typed now.
    pub(crate) disabled: Option<&'a str>,
    /// What is in force; none is shown as "-".
    pub(crate) value: Option<f64>,
    /// What may be typed.
    pub(crate) range: RangeInclusive<f64>,
    /// Digits after the decimal mark; with none only whole numbers are taken.
    pub(crate) decimals: usize,
}

impl NumberField<'_> {
    /// Draws the field where `ui` is. The number that was typed and confirmed with Enter in this frame.
    pub(crate) fn ui(self, ui: &mut Ui, look: Look, typing: &mut Typing) -> Option<f64> {
        let height = theme::CONTROL.min(ui.spacing().interact_size.y);
        let place = ui.allocate_space(vec2(theme::FIELD, height));
        self.at(ui, look, typing, place)
    }

    fn at(
        self,
        ui: &mut Ui,
        look: Look,
        typing: &mut Typing,
        (id, rect): (Id, Rect),
    ) -> Option<f64> {
        let decimals = self.decimals;
        let shown = self
            .value
            .map_or_else(|| UNKNOWN.to_owned(), |value| format!("{value:.decimals$}"));
        if ui.memory(|memory| memory.has_focus(id)) && self.disabled.is_none() {
            if typing.field != Some(id) {
                *typing = Typing {
                    field: Some(id),
                    text: shown.clone(),
                    refused: None,
                };
            }
        } else if typing.field == Some(id)
            && (typing.refused != Some(id) || self.disabled.is_some())
        {
            *typing = Typing::default();
        }
        let mut text = if typing.field == Some(id) {
            typing.text.clone()
        } else {
            shown
        };
        let response = self.edit(ui, (look, typing), &mut text, (id, rect));
        if response.gained_focus() {
            select_all(ui, id, &text);
        }
        if typing.field == Some(id) {
            typing.text.clone_from(&text);
            typing.refused = typing.refused.filter(|_| !response.changed());
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let parsed = strict(&text, decimals).filter(|value| self.range.contains(value));
        let (from, to) = (self.range.start(), self.range.end());
        if typing.refused == Some(id) {
            let text = format!("{} {from}..{to}", look.say(main::ONLY_FROM_TO));
            refused_ui(ui, look, (id, response.rect), &text);
        } else {
            response.on_hover_text(match self.disabled {
                Some(reason) => reason.to_owned(),
                None => format!("{} {from}..{to}", self.tip),
            });
        }
        if !entered || typing.field != Some(id) {
            return None;
        }
        if parsed.is_none() {
            typing.refused = Some(id);
            return None;
        }
        *typing = Typing::default();
        parsed
    }

    fn edit(
        &self,
        ui: &mut Ui,
        (look, typing): (Look, &Typing),
        text: &mut String,
        (id, rect): (Id, Rect),
    ) -> egui::Response {
        let palette = look.palette;
        let enabled = self.disabled.is_none();
        let edge = if typing.refused == Some(id) {
            palette.bad
        } else if typing.field == Some(id) {
            palette.accent
        } else {
            palette.edge
        };
        let frame = egui::Frame::new()
            .fill(if enabled {
                palette.sunken
            } else {
                palette.card
            })
            .stroke(Stroke::new(1.0, edge))
            .corner_radius(theme::ROUND_SMALL)
            .inner_margin(theme::NUMBER_INSET);
        let edit = TextEdit::singleline(text)
            .id(id)
            .font(theme::number())
            .text_color(if enabled { palette.text } else { palette.faint })
            .align(Align2::RIGHT_CENTER)
            .char_limit(TYPED_MAX)
            .interactive(enabled)
            .frame(frame)
            .clip_text(true)
            .min_size(vec2(rect.width(), rect.height()))
            .desired_width(rect.width() - 14.0);
        let place = UiBuilder::new().max_rect(rect);
        let response = ui
            .scope_builder(place, |ui| {
                // A field is as high as its place, not as high as a button.
                ui.spacing_mut().interact_size.y = rect.height();
                ui.add(edit)
            })
            .inner;
        let value = text.clone();
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::TextInput, enabled, self.name);
            info.current_text_value = Some(value.clone());
            info
        });
        response
    }
}

/// A typed whole number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a field lets only whole numbers of its range pass"
)]
pub(crate) const fn whole(number: f64) -> i64 {
    number as i64
}

/// Marks all of the field's text, so that what is typed next takes its place.
fn select_all(ui: &Ui, id: Id, text: &str) {
    let mut state = TextEditState::load(ui.ctx(), id).unwrap_or_default();
    let end = CCursor::new(text.chars().count());
    let all = CCursorRange::two(CCursor::default(), end);
    state.cursor.set_char_range(Some(all));
    state.store(ui.ctx(), id);
}

/// A number written with plain digits and nothing else: no group marks, no full-width digit. Where decimals are wanted
/// a point or a comma may stand before them, and a minus before all.
fn strict(text: &str, decimals: usize) -> Option<f64> {
    let text = text.trim();
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    if decimals == 0 {
        return digits(text).then(|| text.parse().ok()).flatten();
    }
    let size = text.strip_prefix('-').unwrap_or(text);
    let (whole, part) = size.split_once(['.', ',']).unwrap_or((size, "0"));
    let plain = digits(whole) && digits(part) && part.len() <= decimals;
    plain.then(|| text.replace(',', ".").parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_digits_are_a_number() {
        for (text, value) in [
            ("500", Some(500.0)),
            (" 7 ", Some(7.0)),
            ("-1", None),
            ("1,000", None),
            ("1.5", None),
            ("５００", None),
            ("1e3", None),
            ("", None),
        ] {
            assert_eq!(strict(text, 0), value, "{text}");
        }
    }

    #[test]
    fn a_decimal_comma_is_understood_where_decimals_are() {
        for (text, value) in [
            ("72.5", Some(72.5)),
            ("72,5", Some(72.5)),
            ("-13", Some(-13.0)),
            ("1,000", None),
            ("1.2.3", None),
            (",5", None),
            ("5,", None),
            ("--1", None),
            ("", None),
        ] {
            assert_eq!(strict(text, 1), value, "{text}");
        }
    }
}
