//! The window's pixels without OpenGL: egui's output goes through the rasteriser to the display. Independent of the program.

use crate::draw::raster::{Changed, Raster};
use egui::epaint::ClippedShape;
use egui_winit::winit::window::Window;
use softbuffer::{Context, SoftBufferError, Surface};
use std::num::NonZeroU32;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// Interval of full redraws: a display that keeps no copy of a window loses covered parts without notice.
const WHOLE_EVERY: Duration = Duration::from_secs(1);

/// A window's surface and the picture that is shown on it.
pub(crate) struct Screen {
    surface: Surface<Rc<Window>, Rc<Window>>,
    raster: Raster,
    /// Time of the last full redraw.
    whole_at: Instant,
}

impl Screen {
    /// # Errors
    /// The display system's error.
    pub(crate) fn new(window: &Rc<Window>) -> Result<Self, SoftBufferError> {
        let context = Context::new(Rc::clone(window))?;
        Ok(Self {
            surface: Surface::new(&context, Rc::clone(window))?,
            raster: Raster::new(0, 0),
            whole_at: Instant::now(),
        })
    }

    /// Applies changed textures, whether the frame is drawn or not.
    pub(crate) fn textures(&mut self, delta: &mut egui::TexturesDelta) {
        self.raster.apply_textures(delta);
    }

    /// Draws and shows a frame. Does nothing while the window has no area.
    ///
    /// # Errors
    /// The display system's error.
    pub(crate) fn show(
        &mut self,
        window: &Window,
        ctx: &egui::Context,
        frame: DrawnFrame,
    ) -> Result<(), SoftBufferError> {
        let size = window.inner_size();
        let (Some(width), Some(height)) =
            (NonZeroU32::new(size.width), NonZeroU32::new(size.height))
        else {
            return Ok(());
        };
        self.raster.resize(size.width, size.height);
        let background = ctx.global_style().visuals.panel_fill.to_opaque();
        let primitives = ctx.tessellate(frame.shapes, frame.pixels_per_point);
        self.raster
            .draw(&primitives, frame.pixels_per_point, background.to_array());
        self.raster.free_textures();
        self.surface.resize(width, height)?;
        let mut buffer = self.surface.buffer_mut()?;
        let all = Changed {
            columns: 0..width.get() as usize,
            rows: 0..height.get() as usize,
        };
        let is_kept = buffer.age() == 1 && self.whole_at.elapsed() < WHOLE_EVERY;
        let changed = if is_kept {
            self.raster.changed()
        } else {
            self.whole_at = Instant::now();
            std::slice::from_ref(&all)
        };
        for changed in changed {
            copy(&self.raster, changed, &mut buffer);
        }
        if changed.is_empty() {
            return Ok(());
        }
        window.pre_present_notify();
        buffer.present_with_damage(&changed.iter().filter_map(damage).collect::<Vec<_>>())
    }
}

fn copy(raster: &Raster, changed: &Changed, to: &mut [u32]) {
    let (width, _) = raster.size();
    let width = width as usize;
    let pixels = raster.pixels().as_chunks().0;
    for row in changed.rows.clone() {
        let columns = row * width + changed.columns.start..row * width + changed.columns.end;
        let (Some(to), Some(from)) = (to.get_mut(columns.clone()), pixels.get(columns)) else {
            return;
        };
        for (to, [red, green, blue, _]) in to.iter_mut().zip(from) {
            *to = u32::from_be_bytes([0, *red, *green, *blue]);
        }
    }
}

fn damage(changed: &Changed) -> Option<softbuffer::Rect> {
    let number = |pixels: usize| u32::try_from(pixels).ok();
    Some(softbuffer::Rect {
        x: number(changed.columns.start)?,
        y: number(changed.rows.start)?,
        width: NonZeroU32::new(number(changed.columns.len())?)?,
        height: NonZeroU32::new(number(changed.rows.len())?)?,
    })
}

/// Output of one egui pass.
pub(crate) struct DrawnFrame {
    pub(crate) shapes: Vec<ClippedShape>,
    /// Scale of the pass, pixels per point.
    pub(crate) pixels_per_point: f32,
}
