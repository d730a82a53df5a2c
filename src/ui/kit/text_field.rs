//! A line of text that counts when it is left, and not when it is left with Esc. Knows nothing of what it names.

use crate::ui::kit::look::Look;
use crate::ui::theme;
use egui::{Id, Key, Rect, Role, TextEdit, Tooltip, Ui, WidgetInfo, vec2};

/// A text field at a place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextField<'a> {
    /// What a screen reader says.
    pub(crate) name: &'a str,
    /// Shown while nothing stands in it.
    pub(crate) hint: &'a str,
    /// What is in force.
    pub(crate) value: &'a str,
    /// Characters that fit.
    pub(crate) max: usize,
}

impl TextField<'_> {
    /// Draws it where `ui` is, over the width that is left. What was typed, once it was left with something new in it.
    pub(crate) fn ui(self, ui: &mut Ui, typed: &mut Option<(Id, String)>) -> Option<String> {
        let (id, rect) = ui.allocate_space(vec2(ui.available_width(), theme::CONTROL));
        self.put(ui, typed, rect, id)
    }

    /// Draws it. What was typed, once it was left with something new in it.
    pub(crate) fn put(
        self,
        ui: &mut Ui,
        typed: &mut Option<(Id, String)>,
        rect: Rect,
        id: Id,
    ) -> Option<String> {
        let mut text = match typed {
            Some((field, text)) if *field == id => text.clone(),
            _ => self.value.to_owned(),
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
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::TextInput, true, self.name);
            info.current_text_value = Some(text.clone());
            info
        });
        if response.changed() {
            *typed = Some((id, text.clone()));
        }
        if !response.lost_focus() {
            return None;
        }
        let escaped = ui.input(|input| input.key_pressed(Key::Escape));
        *typed = None;
        let text = text.trim();
        (!escaped && text != self.value).then(|| text.to_owned())
    }
}

/// Why what stands in a field was not taken, over what is below it, so that nothing moves under the pointer.
pub(crate) fn refused_ui(ui: &Ui, look: Look, (id, rect): (Id, Rect), words: &str) {
    let id = id.with("refused");
    let tooltip = Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id, rect);
    tooltip.show(|ui| ui.colored_label(look.palette.bad, words));
}
