//! The program behind either window: title, closing with the hand held, when to draw again. Opens no window.

use crate::app::action::Action;
use crate::app::connect::SimDial;
use crate::app::env::Env;
use crate::app::files::day_folder::documents;
use crate::app::layout::{Layout, WINDOW_LEAST, WindowSize};
use crate::app::notices::NoticeKind;
use crate::app::program::App;
use crate::hand::Moment;
use crate::link::Clock;
use crate::shell::Cockpit;
use crate::shell::desktop::dialog::NativeDialog;
use crate::shell::desktop::options::{DesktopStart, Drawing};
use egui::{ViewportBuilder, ViewportCommand};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// Ages and countdowns move on this often when nothing comes in.
pub(crate) const REPAINT_AT_LEAST: Duration = Duration::from_millis(250);

/// How the window is to stand.
pub(crate) fn viewport(size: WindowSize) -> ViewportBuilder {
    ViewportBuilder::default()
        .with_title("Handscope")
        .with_app_id("handscope")
        .with_inner_size(<[f32; 2]>::from(size))
        .with_clamp_size_to_monitor_size(true)
        .with_min_inner_size(WINDOW_LEAST)
}

/// What the program runs on.
pub(crate) struct Services {
    /// The thread of all links.
    pub(crate) runtime: tokio::runtime::Handle,
    /// The one clock.
    pub(crate) clock: Clock,
}

/// What becomes the program once there is a window to show it.
pub(crate) struct Beginning {
    waiting: RefCell<Option<(DesktopStart, Services)>>,
    stands: Arc<AtomicBool>,
}

impl Beginning {
    /// Sets `stands` when the program begins.
    pub(crate) fn new(start: DesktopStart, services: Services, stands: Arc<AtomicBool>) -> Self {
        Self {
            waiting: RefCell::new(Some((start, services))),
            stands,
        }
    }

    /// The size that the window had last time.
    pub(crate) fn window_size(&self) -> WindowSize {
        let waiting = self.waiting.borrow();
        let settings = waiting.as_ref().map(|(start, _)| &start.loaded.settings);
        settings.map_or_else(WindowSize::default, |settings| settings.layout.window)
    }

    /// The program; `None` if it began before.
    pub(crate) fn begin(&self, ctx: &egui::Context) -> Option<Program> {
        let (start, services) = self.waiting.take()?;
        self.stands.store(true, Ordering::Relaxed);
        Some(Program::new(ctx, start, services))
    }
}

/// The program behind the window.
pub(crate) struct Program {
    cockpit: Cockpit,
    clock: Clock,
    /// How soon news are drawn, in milliseconds.
    frame_within_ms: Arc<AtomicU64>,
    titled: Option<String>,
    closing: bool,
}

impl Program {
    fn new(ctx: &egui::Context, start: DesktopStart, services: Services) -> Self {
        let Services { runtime, clock } = services;
        let repaint = ctx.clone();
        let frame_within_ms = Arc::new(AtomicU64::new(0));
        let within = Arc::clone(&frame_within_ms);
        let wake = Arc::new(move || {
            let within = Duration::from_millis(within.load(Ordering::Relaxed));
            repaint.request_repaint_after(within);
        });
        let env = Env {
            dial: Arc::new(SimDial::new(clock)),
            runtime,
            clock,
            wake,
            files: Arc::new(NativeDialog),
            settings_path: start.settings_path,
            documents: documents(),
        };
        let mut app = App::new(env, start.loaded.settings);
        let without = match start.drawing {
            Drawing::InPlaceOfOpenGl(reason) => Some(NoticeKind::DrawnWithoutOpenGl { reason }),
            Drawing::OpenGl | Drawing::Software => None,
        };
        for notice in start.loaded.notice.into_iter().chain(without) {
            app.tell(notice, clock.now());
        }
        app.open(start.endpoint, clock.now());
        Self {
            cockpit: Cockpit::new(app).with_snap(start.snap),
            clock,
            frame_within_ms,
            titled: None,
            closing: false,
        }
    }

    /// Takes in what happened. To be called before each frame, and [`REPAINT_AT_LEAST`] often while nothing is drawn.
    pub(crate) fn logic(&mut self, ctx: &egui::Context) {
        let now = self.clock.now();
        self.cockpit.logic(now);
        let within = self.cockpit.frame_within();
        let within_ms = u64::try_from(within.as_millis()).unwrap_or(0);
        self.frame_within_ms.store(within_ms, Ordering::Relaxed);
        self.title(ctx);
        self.keep_size(ctx, now);
        self.close(ctx, now);
        ctx.request_repaint_after(REPAINT_AT_LEAST);
    }

    /// Draws one frame over all of `ui`.
    pub(crate) fn ui(&mut self, ui: &mut egui::Ui) {
        self.cockpit.ui(ui, self.clock.now());
    }

    /// Names the hand in the window's title, so that a simulated one is told apart in the task bar too.
    fn title(&mut self, ctx: &egui::Context) {
        let state = self.cockpit.state();
        let title = match &state.hand().endpoint {
            Some(_) if state.hand().is_simulated() => "Handscope - SIMULATED hand".to_owned(),
            Some(endpoint) => format!("Handscope - {endpoint}"),
            None => "Handscope".to_owned(),
        };
        if self.titled.as_ref() != Some(&title) {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.titled = Some(title);
        }
    }

    /// Keeps the size that a person gave the window; what the system made of it full screen is not kept.
    fn keep_size(&mut self, ctx: &egui::Context, now: Moment) {
        let shown = ctx.input(|input| {
            let view = input.viewport();
            let forced = [view.maximized, view.fullscreen, view.minimized];
            let own = forced.into_iter().all(|forced| forced != Some(true));
            view.inner_rect.filter(|_| own)
        });
        let Some(shown) = shown else { return };
        let cockpit = &mut self.cockpit;
        let layout = cockpit.state().settings.layout;
        let window = [shown.width(), shown.height()].into();
        if layout.window != window {
            let layout = Layout { window, ..layout };
            cockpit.app().act(Action::Layout(layout), now);
        }
    }

    /// A moving hand is held before the window goes.
    fn close(&mut self, ctx: &egui::Context, now: Moment) {
        self.closing |= ctx.input(|input| input.viewport().close_requested());
        if !self.closing {
            return;
        }
        if self.cockpit.app().close(now) {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        } else {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            ctx.request_repaint_after(self.cockpit.frame_within());
        }
    }
}
