//! A field for the path of a file, for where the system offers no dialog. Opens nothing.

use crate::ui::kit::controls::{self, Button};
use crate::ui::style::Look;
use crate::ui::text::{Text, recordings, window};
use crate::ui::theme;
use egui::{Align, Id, Key, Layout, Ui};
use std::path::PathBuf;

/// Draws the field with its button. The path that was typed and confirmed; the quotes around a copied one are no part of it.
pub(crate) fn path_ui(ui: &mut Ui, look: Look, id: &'static str) -> Option<PathBuf> {
    let named = (look.say(window::PATH), look.say(window::PATH_HINT));
    typed_ui(ui, look, id, (named, window::PATH_OPEN))
}

/// The same for the folder of recordings.
pub(crate) fn folder_path_ui(ui: &mut Ui, look: Look) -> Option<PathBuf> {
    let words = (look.both(recordings::FOLDER_PATH), recordings::FOLDER_TAKE);
    typed_ui(ui, look, "sessions folder", words)
}

/// The name and hint of the field, and what its button says.
type FieldWords = ((&'static str, &'static str), Text);

fn typed_ui(
    ui: &mut Ui,
    look: Look,
    id: &'static str,
    (named, button): FieldWords,
) -> Option<PathBuf> {
    let id = Id::unique(("path", id));
    let mut typed = ui.data_mut(|data| data.get_temp::<String>(id).unwrap_or_default());
    let path = typed.trim().trim_matches(['"', '\'']).to_owned();
    let row = Layout::right_to_left(Align::Center);
    let size = egui::vec2(ui.available_width(), theme::CONTROL);
    let opened = ui.allocate_ui_with_layout(size, row, |ui| {
        let none = path.is_empty().then(|| look.say(window::PATH_NONE));
        let open = Button::said(look, button);
        let open = open.disabled(none).ui(ui, look).clicked();
        let field = controls::edit_ui(ui, named, &mut typed);
        open || field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
    });
    ui.data_mut(|data| data.insert_temp(id, typed));
    (opened.inner && !path.is_empty()).then(|| path.into())
}
