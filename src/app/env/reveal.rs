//! Showing a file where it lies, in the system's file manager. How that is started is the shell's matter.

use std::io;
use std::path::Path;
use std::sync::Arc;

/// Shows a file in the system's file manager. Called off the window's thread; comes back once it is known whether that began.
pub type Reveal = Arc<dyn Fn(&Path) -> io::Result<()> + Send + Sync>;

/// Where there is no file manager: says so.
pub fn no_reveal() -> Reveal {
    Arc::new(|_| Err(io::Error::other("there is no file manager")))
}
