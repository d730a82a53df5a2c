//! What the window starts with.

use crate::app::exhibit::Exhibition;
use crate::app::files::settings_file::Loaded;
use crate::shell::Snap;
use crate::transport::Endpoint;
use std::path::PathBuf;

/// What draws the window.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Drawing {
    #[default]
    OpenGl,
    /// This program itself, on the processor, as the user asked for it.
    Software,
    /// The same, because OpenGL did not start, for this reason.
    InPlaceOfOpenGl(String),
}

/// What the window starts with.
pub struct DesktopStart {
    /// The hands named on the command line.
    pub endpoints: Vec<Endpoint>,
    pub drawing: Drawing,
    /// What was kept from last time, and what is to be said about it.
    pub loaded: Loaded,
    /// Where it is kept.
    pub settings_path: Option<PathBuf>,
    /// What makes pictures of the plots.
    pub snap: Snap,
    /// Whether what happens at hands is recorded, as far as the settings say so.
    pub records: bool,
    /// An exhibition to show in place of the window.
    pub exhibit: Option<Exhibition>,
    /// A recording to begin with.
    pub replay: Option<PathBuf>,
}
