//! A text field for a file path, for systems without a file dialog. Opens nothing itself.

use crate::ui::kit::controls::{self, Button};
use crate::ui::style::Look;
use crate::ui::text::{Text, recordings, window};
use crate::ui::theme;
use egui::{Align, Id, Key, Layout, Ui};
use std::path::PathBuf;

/// Draws the field with its button. Returns the confirmed path, without the quotes around a pasted one.
pub(crate) fn path_ui(ui: &mut Ui, look: Look, id: &'static str) -> Option<PathBuf> {
    let field = PathField {
        id,
        name: window::PATH,
        button: window::PATH_OPEN,
    };
    field.ui(ui, look)
}

/// Same as [`path_ui`], for the folder of recordings.
pub(crate) fn folder_path_ui(ui: &mut Ui, look: Look) -> Option<PathBuf> {
    let field = PathField {
        id: "sessions folder",
        name: recordings::FOLDER_PATH,
        button: recordings::FOLDER_TAKE,
    };
    field.ui(ui, look)
}

/// A path field with its button.
struct PathField {
    id: &'static str,
    /// Accessible name and hint.
    name: Text,
    button: Text,
}

impl PathField {
    fn ui(self, ui: &mut Ui, look: Look) -> Option<PathBuf> {
        let id = Id::unique(("path", self.id));
        let mut typed = ui.data_mut(|data| data.get_temp::<String>(id).unwrap_or_default());
        let path = typed.trim().trim_matches(['"', '\'']).to_owned();
        let row = Layout::right_to_left(Align::Center);
        let size = egui::vec2(ui.available_width(), theme::CONTROL);
        let opened = ui.allocate_ui_with_layout(size, row, |ui| {
            let open = Button::text(look, self.button);
            let open = open.disabled_if(path.is_empty(), look.tr(window::PATH_NONE));
            let open = open.ui(ui, look).clicked();
            let field = controls::translated_edit_ui(ui, look, self.name, &mut typed);
            open || field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
        });
        ui.data_mut(|data| data.insert_temp(id, typed));
        (opened.inner && !path.is_empty()).then(|| path.into())
    }
}
