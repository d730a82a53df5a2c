//! The window's pixels without OpenGL: what egui drew goes through the rasteriser to the display. Knows no program.

use crate::shell::raster::Raster;
use egui::epaint::ClippedShape;
use egui_winit::winit::window::Window;
use softbuffer::{Context, SoftBufferError, Surface};
use std::num::NonZeroU32;
use std::rc::Rc;

/// A window's surface and the picture that is shown on it.
pub(crate) struct Screen {
    surface: Surface<Rc<Window>, Rc<Window>>,
    raster: Raster,
}

impl Screen {
    /// # Errors
    /// What the display system says.
    pub(crate) fn new(window: &Rc<Window>) -> Result<Self, SoftBufferError> {
        let context = Context::new(Rc::clone(window))?;
        Ok(Self {
            surface: Surface::new(&context, Rc::clone(window))?,
            raster: Raster::new(0, 0),
        })
    }

    /// Takes over changed textures, drawn or not.
    pub(crate) fn textures(&mut self, delta: &mut egui::TexturesDelta) {
        self.raster.apply_textures(delta);
    }

    /// Draws and shows a frame. Nothing happens while the window has no area.
    ///
    /// # Errors
    /// What the display system says.
    pub(crate) fn show(
        &mut self,
        window: &Window,
        ctx: &egui::Context,
        frame: Frame,
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
        let pixels = self.raster.pixels().as_chunks().0;
        for (to, [red, green, blue, _]) in buffer.iter_mut().zip(pixels) {
            *to = u32::from_be_bytes([0, *red, *green, *blue]);
        }
        window.pre_present_notify();
        buffer.present()
    }
}

/// What egui drew in one pass.
pub(crate) struct Frame {
    /// What is to be painted.
    pub(crate) shapes: Vec<ClippedShape>,
    /// Scale of the pass.
    pub(crate) pixels_per_point: f32,
}
