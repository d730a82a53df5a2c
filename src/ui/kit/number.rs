//! The number field: nothing that is typed counts before Enter. Knows no joint.

use crate::ui::kit::controls;
use crate::ui::kit::format::UNKNOWN;
use crate::ui::kit::look::{Look, Pane, Typing};
use crate::ui::kit::text_field::refused_ui;
use crate::ui::text::main;
use crate::ui::theme;
use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Align2, Id, Key, Rect, Stroke, TextEdit, Ui, UiBuilder, vec2};
use std::ops::RangeInclusive;

/// Characters that fit in a field.
const TYPED_MAX: usize = 8;

/// A field for a number.
#[derive(Debug, Clone)]
pub(crate) struct NumberField<'a> {
    name: &'a str,
    tip: &'a str,
    disabled: Option<&'a str>,
    range: RangeInclusive<f64>,
    decimals: usize,
}

impl<'a> NumberField<'a> {
    /// A field for whole numbers of a range: what a screen reader says, and what it does, in a sentence.
    pub(crate) const fn new(name: &'a str, tip: &'a str, range: RangeInclusive<f64>) -> Self {
        Self {
            name,
            tip,
            disabled: None,
            range,
            decimals: 0,
        }
    }

    /// Nothing can be typed now, for this reason.
    pub(crate) const fn disabled(mut self, reason: Option<&'a str>) -> Self {
        self.disabled = reason;
        self
    }

    /// So many digits may stand after the decimal mark.
    pub(crate) const fn decimals(mut self, decimals: usize) -> Self {
        self.decimals = decimals;
        self
    }

    /// Draws a field for whole numbers. The one that was typed and confirmed with Enter in this frame.
    pub(crate) fn whole_ui(
        self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        value: Option<impl Into<f64>>,
    ) -> Option<i64> {
        let typed = self.ui(ui, pane, value.map(Into::into))?;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "only whole numbers of the range pass"
        )]
        let whole = typed as i64;
        Some(whole)
    }

    /// Draws it where `ui` is; what is in force is shown, none as "-". The number that was typed and confirmed with Enter
    /// in this frame.
    pub(crate) fn ui(self, ui: &mut Ui, pane: &mut Pane<'_>, value: Option<f64>) -> Option<f64> {
        let (look, typing) = (pane.look, &mut *pane.typing);
        let height = theme::CONTROL.min(ui.spacing().interact_size.y);
        let (id, rect) = ui.allocate_space(vec2(theme::FIELD, height));
        let decimals = self.decimals;
        let shown = value.map_or_else(|| UNKNOWN.to_owned(), |value| format!("{value:.decimals$}"));
        let is_disabled = self.disabled.is_some();
        let is_typed = ui.memory(|memory| memory.has_focus(id)) && !is_disabled;
        if is_typed && typing.field != Some(id) {
            typing.field = Some(id);
            typing.text.clone_from(&shown);
            typing.refused = None;
        }
        if !is_typed && typing.field == Some(id) && (typing.refused != Some(id) || is_disabled) {
            typing.field = None;
            typing.refused = None;
        }
        let mut text = match typing.field == Some(id) {
            true => typing.text.clone(),
            false => shown,
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
        let parsed = strict(&text, decimals).filter(|value| self.range.contains(value));
        match parsed {
            None => typing.refused = Some(id),
            Some(_) => typing.field = None,
        }
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
        let (ground, ink) = match enabled {
            true => (palette.sunken, palette.text),
            false => (palette.card, palette.faint),
        };
        let frame = egui::Frame::new()
            .fill(ground)
            .stroke(Stroke::new(1.0, edge))
            .corner_radius(theme::ROUND_SMALL)
            .inner_margin(theme::NUMBER_INSET);
        let edit = TextEdit::singleline(text)
            .id(id)
            .number()
            .text_color(ink)
            .align(Align2::RIGHT_CENTER)
            .char_limit(TYPED_MAX)
            .interactive(enabled)
            .frame(frame)
            .clip_text(true)
            .min_size(rect.size())
            .desired_width(rect.width() - 14.0);
        let place = UiBuilder::new().max_rect(rect);
        let shown = ui.scope_builder(place, |ui| {
            // A field is as high as its place, not as high as a button.
            ui.spacing_mut().interact_size.y = rect.height();
            ui.add(edit)
        });
        controls::named_field(&shown.inner, self.name, enabled, text);
        shown.inner
    }
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
