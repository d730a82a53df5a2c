//! Options of the window at its start.

use crate::app::exhibit::Exhibition;
use crate::app::files::settings_file::Loaded;
use crate::shell::Snap;
use crate::transport::Endpoint;
use std::path::PathBuf;

/// Renderer of the window.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Renderer {
    #[default]
    OpenGl,
    /// Rendered by the program on the processor, at the user's request.
    Software,
    /// Rendered by the program, because OpenGL did not start for this reason.
    InPlaceOfOpenGl(String),
}

/// Options of the window at its start.
pub struct DesktopStart {
    /// The hands named on the command line.
    pub endpoints: Vec<Endpoint>,
    pub drawing: Renderer,
    /// Settings of the last run, and a notice about loading them.
    pub loaded: Loaded,
    /// Path of the settings file.
    pub settings_path: Option<PathBuf>,
    /// Renders pictures of the plots.
    pub snap: Snap,
    /// True if sessions are recorded, subject to the settings.
    pub records: bool,
    /// An exhibition to show in place of the window.
    pub exhibit: Option<Exhibition>,
    /// A recording to open first.
    pub replay: Option<PathBuf>,
}
