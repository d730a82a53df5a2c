//! A line of text that counts when it is left, and not when it is left with Esc. Knows nothing of what it names.

use crate::ui::kit::controls;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::theme;
use egui::{Id, Key, Rect, TextEdit, Tooltip, Ui, vec2};

/// A field for a line of text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextField<'a> {
    /// What a screen reader says.
    pub(crate) name: &'a str,
    hint: &'a str,
    max: usize,
    check: Check<'a>,
}

/// What passes, and the words beside what does not.
type Check<'a> = (fn(&str) -> bool, &'a str);

impl<'a> TextField<'a> {
    /// A field of at most so many characters.
    pub(crate) const fn new(name: &'a str, max: usize) -> Self {
        Self {
            name,
            hint: "",
            max,
            check: (|_| true, ""),
        }
    }

    /// Shows this while nothing stands in it.
    pub(crate) const fn hint(mut self, hint: &'a str) -> Self {
        self.hint = hint;
        self
    }

    /// What does not pass stays, with these words beside it, and is not given back.
    pub(crate) const fn check(mut self, passes: fn(&str) -> bool, words: &'a str) -> Self {
        self.check = (passes, words);
        self
    }

    /// Draws it where `ui` is, over the width that is left, with what is in force. What was typed, once it was left with
    /// something new in it.
    pub(crate) fn ui(self, ui: &mut Ui, pane: &mut Pane<'_>, value: &str) -> Option<String> {
        let (id, rect) = ui.allocate_space(vec2(ui.available_width(), theme::CONTROL));
        let written = &mut pane.typing.written;
        let mut text = match written {
            Some((field, text)) if *field == id => text.clone(),
            _ => value.to_owned(),
        };
        let edit = TextEdit::singleline(&mut text)
            .id(id)
            .font(theme::body())
            .hint_text(self.hint)
            .char_limit(self.max)
            .clip_text(true)
            .align(egui::Align2::LEFT_CENTER)
            .margin(theme::NUMBER_INSET)
            .min_size(rect.size())
            .desired_width(rect.width() - theme::PAD);
        let response = ui.put(rect, edit);
        controls::named_field(&response, self.name, true, &text);
        if response.changed() {
            *written = Some((id, text.clone()));
        }
        let (passes, words) = self.check;
        let is_refused = !text.trim().is_empty() && !passes(text.trim());
        if !response.has_focus()
            && is_refused
            && written.as_ref().is_some_and(|(field, _)| *field == id)
        {
            refused_ui(ui, pane.look, (id, rect), words);
        }
        if !response.lost_focus() {
            return None;
        }
        let escaped = ui.input(|input| input.key_pressed(Key::Escape));
        if is_refused && !escaped {
            return None;
        }
        *written = None;
        let text = text.trim();
        (!escaped && text != value).then(|| text.to_owned())
    }
}

/// Why what stands in a field was not taken, over what is below it, so that nothing moves under the pointer.
pub(crate) fn refused_ui(ui: &Ui, look: Look, (id, rect): (Id, Rect), words: &str) {
    let id = id.with("refused");
    let tooltip = Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id, rect);
    tooltip.show(|ui| ui.colored_label(look.palette.bad, words));
}
