//! Chooses one of the two windows, and starts the thread for all links. Opens no window itself.

use crate::link::Clock;
use crate::shell::desktop::failure::{DesktopError, panic_words};
use crate::shell::desktop::gl::run as run_opengl;
use crate::shell::desktop::options::{DesktopStart, Renderer};
use crate::shell::desktop::program::{Beginning, Services};
use crate::shell::desktop::shutdown::{ShutdownState, on_signals};
use crate::shell::desktop::software::run as run_software;
use std::panic::AssertUnwindSafe;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Opens the window and runs until it is closed.
///
/// # Errors
/// [`DesktopError`] if no window can be opened. After [`DesktopError::NoOpenGl`] one without OpenGL may still open, in a new
/// process: a second event loop in one process is refused.
pub fn run(start: DesktopStart) -> Result<(), DesktopError> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .thread_name("links")
        .on_thread_start(crate::link::priority::raise)
        .enable_all()
        .build()
        .map_err(|error| DesktopError::Runtime {
            cause: error.to_string(),
        })?;
    let clock = Clock::start();
    let ending = ShutdownState::new(clock);
    // Listens before there is a window.
    runtime.spawn(on_signals(Arc::clone(&ending)));
    let services = Services {
        runtime: runtime.handle().clone(),
        clock,
        ending,
    };
    let drawing = start.drawing.clone();
    let stands = Arc::new(AtomicBool::new(false));
    silence_until(&stands);
    let beginning = Rc::new(Beginning::new(start, services, Arc::clone(&stands)));
    let window = AssertUnwindSafe(|| match drawing {
        Renderer::OpenGl => run_opengl(&beginning),
        Renderer::Software | Renderer::InPlaceOfOpenGl(_) => run_software(&beginning),
    });
    let ended = std::panic::catch_unwind(window);
    runtime.shutdown_timeout(Duration::from_millis(200));
    match ended {
        Ok(ended) => ended,
        Err(panic) if stands.load(Ordering::Relaxed) => std::panic::resume_unwind(panic),
        Err(panic) => Err(DesktopError::of(&panic_words(panic.as_ref()))),
    }
}

/// Some graphics libraries panic if a part is missing. Until the window exists, that is reported as an error, so this thread's
/// panics print nothing; afterwards they print as usual.
fn silence_until(stands: &Arc<AtomicBool>) {
    let (stands, here) = (Arc::clone(stands), std::thread::current().id());
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if stands.load(Ordering::Relaxed) || std::thread::current().id() != here {
            before(panic);
        }
    }));
}
