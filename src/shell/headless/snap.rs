//! One picture of a part of the window, while the real window keeps running. Chooses no path and writes no file.

use crate::app::settings::{Language, Theme};
use crate::shell::headless::canvas::Canvas;
use crate::shell::headless::png;
use crate::ui;

/// Pixels per point: twice as fine as most displays, for papers.
const SCALE: f32 = 2.0;

/// A [`crate::shell::Snap`].
pub fn snap(size: (u32, u32), at_s: f64, draw: &mut dyn FnMut(&mut egui::Ui)) -> Option<Vec<u8>> {
    let mut canvas = Canvas::new(size, SCALE);
    ui::install(canvas.context(), Theme::Dark, Language::En);
    canvas.hold_still();
    let picture = canvas.picture(at_s, draw);
    png::encode(&picture.rgb, picture.size).ok()
}
