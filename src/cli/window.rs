//! The window, started from the command line; or why there is none. Draws nothing itself.

use crate::transport::Endpoint;

/// Opens the window and runs until it is closed.
#[cfg(feature = "desktop")]
pub(crate) fn run(endpoint: Option<Endpoint>) -> anyhow::Result<()> {
    use crate::app::config::{Loaded, default_path, load};
    use crate::desktop::{self, DesktopStart};
    let settings_path = default_path();
    let loaded = settings_path.as_deref().map_or_else(Loaded::default, load);
    desktop::run(DesktopStart {
        snap: crate::headless::snap::snap,
        endpoint,
        loaded,
        settings_path,
    })?;
    Ok(())
}

/// Says that this program was built without a window.
#[cfg(not(feature = "desktop"))]
pub(crate) fn run(_endpoint: Option<Endpoint>) -> anyhow::Result<()> {
    anyhow::bail!(
        "this program was built without its window: use 'handscope snapshot' for pictures and 'handscope watch' for values"
    )
}
