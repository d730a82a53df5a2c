//! The real window: eframe around the cockpit, and the one thread that all links run on. Draws nothing itself.

use crate::app::config::Loaded;
use crate::app::{App, ChooseFile, Env, SimDial};
use crate::hand::Moment;
use crate::link::{Clock, Wake};
use crate::shell::{Cockpit, Snap};
use crate::transport::Endpoint;
use futures::future::BoxFuture;
use std::panic::AssertUnwindSafe;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Samples come faster than a display shows them: one repaint serves all that come within this time.
const REPAINT_WITHIN: Duration = Duration::from_millis(16);
/// Ages and countdowns move on this often when nothing comes in.
const REPAINT_AT_LEAST: Duration = Duration::from_millis(250);
/// The window as it first opens, in points.
const FIRST_SIZE: [f32; 2] = [1440.0, 900.0];
/// The smallest window that shows everything, in points.
const SMALLEST_SIZE: [f32; 2] = [1024.0, 640.0];

/// What the window starts with.
pub struct DesktopStart {
    /// The hand named on the command line.
    pub endpoint: Option<Endpoint>,
    /// What was kept from last time, and what is to be said about it.
    pub loaded: Loaded,
    /// Where it is kept.
    pub settings_path: Option<PathBuf>,
    /// What makes pictures of the plots.
    pub snap: Snap,
}

/// Why there is no window.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DesktopError {
    /// Neither X11 nor Wayland.
    #[error(
        "the window cannot open: there is no display here ({cause}); start it in a desktop session, or use 'handscope snapshot' for pictures and 'handscope watch' for values"
    )]
    NoDisplay {
        /// The system's words.
        cause: String,
    },
    /// A library that windows need is not installed.
    #[error(
        "the window cannot open: {cause}; on Debian and Ubuntu run 'sudo apt install libxcursor1 libxi6 libxkbcommon-x11-0 libgl1', or use 'handscope snapshot' for pictures"
    )]
    MissingLibrary {
        /// The system's words.
        cause: String,
    },
    /// The thread for the links could not be started.
    #[error("the program cannot start its link thread: {cause}")]
    Runtime {
        /// The system's words.
        cause: String,
    },
}

/// Opens the window and runs until it is closed.
///
/// # Errors
/// [`DesktopError`] if no window can be opened.
pub fn run(start: DesktopStart) -> Result<(), DesktopError> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .thread_name("links")
        .enable_all()
        .build()
        .map_err(|error| DesktopError::Runtime {
            cause: error.to_string(),
        })?;
    let clock = Clock::start();
    let handle = runtime.handle().clone();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Handscope")
            .with_app_id("handscope")
            .with_inner_size(FIRST_SIZE)
            .with_min_inner_size(SMALLEST_SIZE),
        ..eframe::NativeOptions::default()
    };
    let open = AssertUnwindSafe(|| {
        eframe::run_native(
            "handscope",
            options,
            Box::new(move |cc| Ok(Box::new(Desktop::new(&cc.egui_ctx, start, clock, handle)))),
        )
    });
    // Some graphics libraries panic where a part is missing; that must end in a sentence as well.
    let ended = match std::panic::catch_unwind(open) {
        Ok(ended) => ended.map_err(|error| failure(&error.to_string())),
        Err(panic) => Err(failure(&panic_words(panic.as_ref()))),
    };
    runtime.shutdown_timeout(Duration::from_millis(200));
    ended
}

fn failure(cause: &str) -> DesktopError {
    // The libraries put the place in their own source before what went wrong.
    let words = cause
        .rsplit_once(".rs:")
        .and_then(|(_, rest)| rest.split_once(": "));
    let cause = words.map_or(cause, |(_, words)| words);
    let cause = cause.trim().trim_end_matches('.').to_owned();
    let words = cause.to_lowercase();
    if [
        "wayland_display",
        "display is set",
        "xopendisplay",
        "could not connect",
        "open connection to x",
    ]
    .iter()
    .any(|part| words.contains(part))
    {
        return DesktopError::NoDisplay { cause };
    }
    DesktopError::MissingLibrary { cause }
}

fn panic_words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "the graphics system failed".into())
}

/// The system's own dialog.
struct NativeDialog;

impl ChooseFile for NativeDialog {
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        let dialog = rfd::AsyncFileDialog::new().set_file_name(suggested);
        // Begun here, on the window's thread, as some systems demand.
        let asked = dialog.save_file();
        Box::pin(async move { asked.await.map(|file| file.path().to_path_buf()) })
    }

    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        let dialog = rfd::AsyncFileDialog::new().set_file_name(suggested);
        let asked = dialog.pick_file();
        Box::pin(async move { asked.await.map(|file| file.path().to_path_buf()) })
    }
}

struct Desktop {
    cockpit: Cockpit,
    clock: Clock,
    titled: Option<String>,
    closing: bool,
}

impl Desktop {
    fn new(
        ctx: &egui::Context,
        start: DesktopStart,
        clock: Clock,
        runtime: tokio::runtime::Handle,
    ) -> Self {
        let repaint = ctx.clone();
        let wake: Wake = Arc::new(move || repaint.request_repaint_after(REPAINT_WITHIN));
        let env = Env {
            dial: Arc::new(SimDial::new(clock)),
            runtime,
            clock,
            wake,
            files: Arc::new(NativeDialog),
            settings_path: start.settings_path,
        };
        let mut app = App::new(env, start.loaded.settings);
        if let Some(notice) = start.loaded.notice {
            app.tell(notice, clock.now());
        }
        app.open(start.endpoint, clock.now());
        let cockpit = Cockpit::new(app).with_snap(start.snap);
        Self {
            cockpit,
            clock,
            titled: None,
            closing: false,
        }
    }

    /// Names the hand in the window's title, so that a simulated one is told apart in the task bar too.
    fn title(&mut self, ctx: &egui::Context) {
        let state = self.cockpit.state();
        let title = match &state.endpoint {
            Some(_) if state.is_simulated() => "Handscope - SIMULATED hand".to_owned(),
            Some(endpoint) => format!("Handscope - {endpoint}"),
            None => "Handscope".to_owned(),
        };
        if self.titled.as_ref() != Some(&title) {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.titled = Some(title);
        }
    }

    /// A moving hand is held before the window goes.
    fn close(&mut self, ctx: &egui::Context, now: Moment) {
        self.closing |= ctx.input(|input| input.viewport().close_requested());
        if !self.closing {
            return;
        }
        if self.cockpit.app().close(now) {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        } else {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            ctx.request_repaint_after(REPAINT_WITHIN);
        }
    }
}

impl eframe::App for Desktop {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        let now = self.clock.now();
        self.cockpit.logic(now);
        self.title(ctx);
        self.close(ctx, now);
        ctx.request_repaint_after(REPAINT_AT_LEAST);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.cockpit.ui(ui, self.clock.now());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_display_is_told_from_a_missing_library() {
        let none = failure(
            "winit EventLoopError: os error at /root/winit-0.30.13/src/mod.rs:765: neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set.",
        );
        let cause = "neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set".to_owned();
        assert_eq!(none, DesktopError::NoDisplay { cause });
        assert!(none.to_string().contains("snapshot"));
        let refused = failure("Failed to open connection to X server");
        assert!(matches!(refused, DesktopError::NoDisplay { .. }));
        let missing = failure("libXcursor.so.1: cannot open shared object file");
        assert!(matches!(missing, DesktopError::MissingLibrary { .. }));
        assert!(missing.to_string().contains("libxcursor1"));
    }
}
