//! A screen without a window: runs a `ui` until it settles, returns its picture and its labels. Reads no clock, drives no app.

use std::time::Duration;

use egui::accesskit::TreeUpdate;
use egui::epaint::ClippedShape;
use egui::{Context, RawInput, Rect, Theme, Ui, ViewportId, ViewportInfo, pos2, vec2};
use serde_json::Value;

use crate::draw::raster::Raster;
use crate::shell::headless::labels::labels_json;

/// Maximum number of passes of a picture. Layout is final at the second; a live view requests repaints for ever.
const MAX_PASSES: usize = 4;
/// Maximum pixels per side, so that a mistyped size does not exhaust the memory.
const MAX_SIDE: f32 = 16_384.0;

/// An egui context that yields the same bytes for the same `ui` at the same time: no animation, no blinking, no system fonts, a
/// fixed scale, dark unless a theme is set.
#[derive(Debug)]
pub struct Canvas {
    context: Context,
    raster: Raster,
    size: (u32, u32),
    scale: f32,
}

/// Output of one pass.
#[derive(Debug, Clone)]
pub struct FrameOut {
    pub shapes: Vec<ClippedShape>,
    /// Scale of the pass, pixels per point.
    pub pixels_per_point: f32,
    /// Everything accessible on screen.
    pub tree: Option<TreeUpdate>,
    /// Delay until egui's next pass; [`Duration::MAX`] for never.
    pub repaint_after: Duration,
}

/// A finished picture with its labels.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// RGB8, row by row from the top left: pictures are opaque.
    pub rgb: Vec<u8>,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// The list of [`labels_json`].
    pub labels: Value,
}

impl Canvas {
    /// A screen of `size` points (width, height) with `scale` pixels per point; the picture has `size * scale` pixels. A scale
    /// that is not a positive number counts as 1.
    pub fn new(size: (u32, u32), scale: f32) -> Self {
        let scale = if scale.is_finite() && scale > 0.0 {
            scale
        } else {
            1.0
        };
        let context = Context::default();
        context.enable_accesskit();
        context.options_mut(|options| options.fallback_theme = Theme::Dark);
        let (width, height) = size;
        let mut canvas = Self {
            context,
            raster: Raster::new(pixels(width, scale), pixels(height, scale)),
            size,
            scale,
        };
        canvas.hold_still();
        canvas
    }

    /// The context, for fonts and theme. After setting a whole style, call [`Canvas::hold_still`].
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// Disables animation and blinking in the current styles.
    pub fn hold_still(&mut self) {
        self.context.all_styles_mut(|style| {
            style.animation_time = 0.0;
            style.visuals.text_cursor.blink = false;
        });
    }

    /// Runs one pass at `time_s` seconds. The root `ui` covers the screen, without margin or background. Changed textures are
    /// applied even if the pass is never drawn.
    pub fn frame(&mut self, time_s: f64, ui: impl FnMut(&mut Ui)) -> FrameOut {
        let mut output = self.context.run_ui(self.input(time_s), ui);
        self.raster.apply_textures(&mut output.textures_delta);
        let root = output.viewport_output.get(&ViewportId::ROOT);
        FrameOut {
            repaint_after: root.map_or(Duration::MAX, |root| root.repaint_delay),
            shapes: output.shapes,
            pixels_per_point: output.pixels_per_point,
            tree: output.platform_output.accesskit_update,
        }
    }

    /// Runs passes at `time_s` seconds until egui requests no further one, at most `MAX_PASSES`, and draws the last.
    pub fn picture(&mut self, time_s: f64, mut ui: impl FnMut(&mut Ui)) -> Picture {
        let mut last = self.frame(time_s, &mut ui);
        for _ in 1..MAX_PASSES {
            if last.repaint_after == Duration::MAX {
                break;
            }
            last = self.frame(time_s, &mut ui);
        }
        self.draw(last)
    }

    fn draw(&mut self, frame: FrameOut) -> Picture {
        let background = self.context.global_style().visuals.panel_fill;
        let primitives = self
            .context
            .tessellate(frame.shapes, frame.pixels_per_point);
        let opaque = background.to_opaque().to_array();
        self.raster
            .draw(&primitives, frame.pixels_per_point, opaque);
        self.raster.free_textures();
        Picture {
            rgb: self.raster.rgb(),
            size: self.raster.size(),
            labels: frame
                .tree
                .as_ref()
                .map_or_else(|| Value::Array(Vec::new()), labels_json),
        }
    }

    fn input(&self, time_s: f64) -> RawInput {
        let (width, height) = self.size;
        let screen = Rect::from_min_size(pos2(0.0, 0.0), vec2(points(width), points(height)));
        let viewport = ViewportInfo {
            native_pixels_per_point: Some(self.scale),
            inner_rect: Some(screen),
            focused: Some(true),
            ..ViewportInfo::default()
        };
        RawInput {
            viewports: std::iter::once((ViewportId::ROOT, viewport)).collect(),
            screen_rect: Some(screen),
            time: Some(time_s),
            ..RawInput::default()
        }
    }
}

#[expect(
    clippy::cast_precision_loss,
    reason = "a screen has fewer than 2^24 points a side"
)]
fn points(side: u32) -> f32 {
    side as f32
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=MAX_SIDE just before"
)]
fn pixels(side: u32, scale: f32) -> u32 {
    (points(side) * scale).round().clamp(0.0, MAX_SIDE) as u32
}

#[cfg(test)]
mod tests {
    #![allow(clippy::cast_precision_loss, reason = "a test may")]

    use super::*;

    /// The pixels that differ from the first one, as column and row.
    fn lit(picture: &Picture) -> Vec<(usize, usize)> {
        let width = usize::try_from(picture.size.0).unwrap();
        let background = picture.rgb[..3].to_vec();
        let pixels = picture.rgb.chunks_exact(3).enumerate();
        pixels
            .filter(|(_, pixel)| *pixel != background)
            .map(|(at, _)| (at % width, at / width))
            .collect()
    }

    #[test]
    fn label_is_drawn_only_inside_its_rect_and_bytes_repeat() {
        for scale in [1.0, 2.0] {
            let mut places = Vec::new();
            let mut take = || {
                Canvas::new((200, 60), scale).picture(0.0, |ui| {
                    ui.add_space(10.0);
                    places.push(ui.label("Ring 42").rect);
                })
            };
            let (one, two) = (take(), take());
            assert_eq!(one, two);
            let rect = (*places.last().unwrap() * scale).expand(1.0);
            let lit = lit(&one);
            assert!(lit.len() > 50, "{} pixels lit", lit.len());
            for (x, y) in lit {
                assert!(
                    rect.contains(pos2(x as f32 + 0.5, y as f32 + 0.5)),
                    "{x} {y} {rect}"
                );
            }
            assert_eq!(one.labels[0]["name"], "Ring 42");
        }
    }

    #[test]
    fn root_has_no_margin_and_scale_multiplies_pixels() {
        let picture = Canvas::new((40, 30), 1.5).picture(0.0, |ui| {
            let rect = ui.max_rect();
            assert_eq!(rect, Rect::from_min_size(pos2(0.0, 0.0), vec2(40.0, 30.0)));
            ui.painter().rect_filled(rect, 0.0, egui::Color32::RED);
        });
        assert_eq!(picture.size, (60, 45));
        assert!(
            picture
                .rgb
                .chunks_exact(3)
                .all(|pixel| pixel == [255, 0, 0])
        );
    }

    #[test]
    fn still_ui_settles_and_restless_one_stops_at_the_limit() {
        let mut passes = 0;
        Canvas::new((80, 40), 1.0).picture(0.0, |ui| {
            passes += 1;
            ui.label("still");
        });
        assert!(passes <= 3, "{passes} passes");
        let mut passes = 0;
        Canvas::new((80, 40), 1.0).picture(0.0, |ui| {
            passes += 1;
            ui.request_repaint();
        });
        assert_eq!(passes, MAX_PASSES);
    }

    #[test]
    fn changes_of_an_undrawn_frame_show_in_the_next_picture() {
        let mut canvas = Canvas::new((80, 40), 1.0);
        let show = |ui: &mut Ui| {
            ui.label("8");
        };
        for _ in 0..3 {
            canvas.frame(0.0, show);
        }
        assert_eq!(
            canvas.picture(0.0, show),
            Canvas::new((80, 40), 1.0).picture(0.0, show)
        );
    }
}
