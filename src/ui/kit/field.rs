//! Text and number fields. A value is applied when the field loses focus; values sent to a hand need Enter; Esc always cancels.
//! Independent of the meaning of the values.

use crate::ui::kit::controls;
use crate::ui::kit::pane::{Pane, Typing};
use crate::ui::style::Look;
use crate::ui::style::format::UNKNOWN;
use crate::ui::text::main;
use crate::ui::theme;
use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{
    Align2, Frame, Id, Key, Rect, Response, Stroke, TextEdit, Tooltip, Ui, UiBuilder, vec2,
};
use std::ops::RangeInclusive;

/// Maximum characters of a number field.
const TYPED_MAX: usize = 8;

/// Parsed value, or the reason why it is invalid.
type Read<T> = Result<T, String>;

/// Position of a field, and whether to mark its value as refused or invalid.
struct FieldPlace {
    id: Id,
    rect: Rect,
    is_refused: bool,
}

/// Common part of text and number fields.
#[derive(Debug, Clone, Copy)]
struct EditField<'a> {
    /// Accessible name.
    name: &'a str,
    hint: &'a str,
    tip: &'a str,
    disabled: Option<&'a str>,
    max: usize,
    is_number: bool,
    /// The value in force is invalid.
    is_wrong: bool,
    /// Applied when the field loses focus, not with Enter alone.
    counts_when_left: bool,
}

impl<'a> EditField<'a> {
    /// A text field of at most `max` characters.
    const fn new(name: &'a str, max: usize) -> Self {
        Self {
            name,
            hint: "",
            tip: "",
            disabled: None,
            max,
            is_number: false,
            is_wrong: false,
            counts_when_left: true,
        }
    }

    /// Draws it, showing `value`. Returns the parsed text once it is applied; invalid text stays, with the reason below it.
    fn ui<T>(
        self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        value: &str,
        read: impl FnOnce(&str) -> Read<T>,
    ) -> Option<T> {
        let line = theme::CONTROL.min(ui.spacing().interact_size.y);
        let (width, height) = if self.is_number {
            (theme::FIELD, line)
        } else {
            (ui.available_width(), theme::CONTROL)
        };
        let (id, rect) = ui.allocate_space(vec2(width, height));
        let own = std::mem::take(pane.typing);
        let (own, other) = match own.field.as_ref() {
            // Pressing Enter or Esc again restores the value in force.
            Some((field, _)) if *field == id && own.is_discarded(ui) => (Typing::default(), None),
            Some((field, _)) if *field == id && self.disabled.is_none() => (own, None),
            Some((field, _)) if *field == id => (Typing::default(), None),
            _ => (Typing::default(), Some(own)),
        };
        let typed = own.field.map(|(_, text)| text);
        let mut refused = own.refused;
        let mut text = typed.clone().unwrap_or_else(|| value.to_owned());
        let place = FieldPlace {
            id,
            rect,
            is_refused: self.is_wrong || refused.is_some(),
        };
        let response = self.edit_ui(ui, pane.look, &mut text, &place);
        let by_tab = ui.input(|input| input.key_pressed(Key::Tab));
        if (self.is_number || by_tab) && response.gained_focus() {
            select_all(ui, id, &text);
        }
        let mut is_typed = typed.is_some();
        if response.changed() {
            (is_typed, refused) = (true, None);
        }
        let key = |key| ui.input(|input| input.key_pressed(key));
        let mut new = None;
        // In the second pass of a frame the focus is lost again, but no key is down: refused text stays refused.
        if is_typed && refused.is_none() && response.lost_focus() {
            is_typed = if self.counts_when_left {
                !key(Key::Escape)
            } else {
                key(Key::Enter)
            };
            let read = is_typed.then(|| read(text.trim()));
            (new, refused) = match read {
                Some(Err(words)) => (None, Some(words)),
                Some(Ok(read)) => (Some(read), None),
                None => (None, None),
            };
        }
        is_typed = refused.is_some() || is_typed && response.has_focus();
        match &refused {
            Some(words) => refused_ui(ui, pane.look, (id, rect), words),
            None if self.tip.is_empty() => {}
            None => drop(response.on_hover_text(self.tip)),
        }
        let field = is_typed.then_some((id, text));
        *pane.typing = match (field, other) {
            (None, Some(other)) => other,
            (field, _) => Typing { field, refused },
        };
        new
    }

    fn edit_ui(self, ui: &mut Ui, look: Look, text: &mut String, place: &FieldPlace) -> Response {
        let (palette, rect) = (look.palette, place.rect);
        let enabled = self.disabled.is_none();
        let has_focus = ui.memory(|memory| memory.has_focus(place.id));
        let edge = match (place.is_refused, has_focus) {
            (true, _) => palette.bad,
            (false, true) => palette.accent,
            (false, false) => palette.edge,
        };
        let (ground, ink) = if enabled {
            (palette.sunken, palette.text)
        } else {
            (palette.card, palette.faint)
        };
        let (font, align) = if self.is_number {
            (theme::number(), Align2::RIGHT_CENTER)
        } else {
            (theme::body(), Align2::LEFT_CENTER)
        };
        let frame = Frame::new()
            .fill(ground)
            .stroke(Stroke::new(1.0, edge))
            .corner_radius(theme::ROUND_SMALL)
            .inner_margin(theme::NUMBER_INSET);
        let edit = TextEdit::singleline(text)
            .id(place.id)
            .font(font)
            .text_color(ink)
            .hint_text(self.hint)
            .align(align)
            .char_limit(self.max)
            .interactive(enabled)
            .frame(frame)
            .clip_text(true)
            .min_size(rect.size())
            .desired_width(rect.width() - 14.0);
        let place = UiBuilder::new().max_rect(rect);
        let shown = ui.scope_builder(place, |ui| {
            // The field is as high as its rectangle, not as a button.
            ui.spacing_mut().interact_size.y = rect.height();
            ui.add(edit)
        });
        controls::named_field(&shown.inner, self.name, enabled, text);
        shown.inner
    }
}

/// A one-line text field.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextField<'a>(EditField<'a>);

impl<'a> TextField<'a> {
    /// A field of at most `max` characters, with its accessible name.
    pub(crate) const fn new(name: &'a str, max: usize) -> Self {
        Self(EditField::new(name, max))
    }

    /// Shown while the field is empty.
    pub(crate) const fn hint(mut self, hint: &'a str) -> Self {
        self.0.hint = hint;
        self
    }

    /// Marks the value in force as invalid.
    pub(crate) const fn wrong(mut self, is_wrong: bool) -> Self {
        self.0.is_wrong = is_wrong;
        self
    }

    /// Draws it at the cursor of `ui`, over the remaining width, showing `value`. Returns the text once it is applied, if it differs.
    pub(crate) fn ui(self, ui: &mut Ui, pane: &mut Pane<'_>, value: &str) -> Option<String> {
        let new = self.read_ui(ui, pane, value, |text| Ok(text.to_owned()));
        new.filter(|new| new != value)
    }

    /// Same as [`Self::ui`], for text that has to be parsed.
    pub(crate) fn read_ui<T>(
        self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        value: &str,
        read: impl FnOnce(&str) -> Read<T>,
    ) -> Option<T> {
        self.0.ui(ui, pane, value, read)
    }
}

/// A number field, applied when it loses focus.
#[derive(Debug, Clone)]
pub(crate) struct NumberField<'a> {
    field: EditField<'a>,
    range: RangeInclusive<f64>,
    decimals: usize,
}

impl<'a> NumberField<'a> {
    /// A field for whole numbers of a range, with its accessible name and a tooltip sentence.
    pub(crate) const fn new(name: &'a str, tip: &'a str, range: RangeInclusive<f64>) -> Self {
        let field = EditField {
            tip,
            is_number: true,
            ..EditField::new(name, TYPED_MAX)
        };
        Self {
            field,
            range,
            decimals: 0,
        }
    }

    /// Disabled for this reason.
    pub(crate) const fn disabled(mut self, reason: Option<&'a str>) -> Self {
        self.field.disabled = reason;
        self
    }

    /// Marks the value in force as invalid.
    pub(crate) const fn wrong(mut self, is_wrong: bool) -> Self {
        self.field.is_wrong = is_wrong;
        self
    }

    /// Applied with Enter alone, not on loss of focus: the value is sent to a hand.
    pub(crate) const fn needs_enter(mut self) -> Self {
        self.field.counts_when_left = false;
        self
    }

    /// Maximum number of digits after the decimal mark.
    pub(crate) const fn decimals(mut self, decimals: usize) -> Self {
        self.decimals = decimals;
        self
    }

    /// Draws a field for whole numbers. Returns the number in the frame in which it is applied.
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

    /// Draws it at the cursor of `ui`; `None` is shown as "-". Returns the number in the frame in which it is applied.
    pub(crate) fn ui(self, ui: &mut Ui, pane: &mut Pane<'_>, value: Option<f64>) -> Option<f64> {
        let decimals = self.decimals;
        let shown = value.map_or_else(|| UNKNOWN.to_owned(), |value| format!("{value:.decimals$}"));
        let (from, to) = (self.range.start(), self.range.end());
        let only = pane.look.tr(main::ONLY_FROM_TO);
        let read = |text: &str| {
            let number = strict(text, decimals).filter(|value| self.range.contains(value));
            number.ok_or_else(|| format!("{only} {from}..{to}"))
        };
        let tip = match self.field.disabled {
            Some(reason) => reason.to_owned(),
            None => format!("{} {from}..{to}", self.field.tip),
        };
        let tip = tip.as_str();
        EditField { tip, ..self.field }.ui(ui, pane, &shown, read)
    }
}

/// Selects all of the field's text, so that typing replaces it.
fn select_all(ui: &Ui, id: Id, text: &str) {
    let mut state = TextEditState::load(ui.ctx(), id).unwrap_or_default();
    let end = CCursor::new(text.chars().count());
    let all = CCursorRange::two(CCursor::default(), end);
    state.cursor.set_char_range(Some(all));
    state.store(ui.ctx(), id);
}

/// Shows why the text was refused, over the content below the field, so that nothing moves under the pointer.
fn refused_ui(ui: &Ui, look: Look, (id, rect): (Id, Rect), words: &str) {
    let id = id.with("refused");
    let tooltip = Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id, rect);
    tooltip.show(|ui| ui.colored_label(look.palette.bad, words));
}

/// Parses a number of plain digits: no group marks, no full-width digits. With decimals, a point or comma and a leading
/// minus are accepted.
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
