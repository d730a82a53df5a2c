//! The window with OpenGL, by eframe.

use crate::shell::desktop::failure::{DesktopError, cause_of};
use crate::shell::desktop::program::{Beginning, DesktopProgram, viewport};
use std::rc::Rc;

/// Opens the window and runs until it is closed.
pub(crate) fn run(beginning: &Rc<Beginning>) -> Result<(), DesktopError> {
    let options = eframe::NativeOptions {
        viewport: viewport(&beginning.layout()),
        ..eframe::NativeOptions::default()
    };
    let beginning = Rc::clone(beginning);
    let create: eframe::AppCreator<'_> = Box::new(move |cc| {
        let program = beginning.begin(&cc.egui_ctx);
        let program = program.ok_or("the window was opened twice")?;
        Ok(Box::new(GlWindow(program)))
    });
    eframe::run_native("handscope", options, create).map_err(|error| failed(&error))
}

fn failed(error: &eframe::Error) -> DesktopError {
    let words = error.to_string();
    match error {
        // The template of the requested configuration does not help the user.
        eframe::Error::NoGlutinConfigs(_, error) => no_opengl(&error.to_string()),
        eframe::Error::Glutin(_) | eframe::Error::OpenGL(_) => no_opengl(&words),
        eframe::Error::AppCreation(_)
        | eframe::Error::Winit(_)
        | eframe::Error::WinitEventLoop(_) => DesktopError::of(&words),
    }
}

fn no_opengl(words: &str) -> DesktopError {
    DesktopError::NoOpenGl {
        cause: cause_of(words),
    }
}

struct GlWindow(DesktopProgram);

impl eframe::App for GlWindow {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.0.logic(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.0.ui(ui);
    }
}
