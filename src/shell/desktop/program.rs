//! The program behind either window: title, closing with the hand held, repaint timing. Opens no window.

use crate::app::action::Action;
use crate::app::connect::SimDial;
use crate::app::env::day_folder::documents;
use crate::app::env::{Env, LostSteps};
use crate::app::layout::{Layout, WINDOW_LEAST};
use crate::app::notices::NoticeKind;
use crate::app::program::App;
use crate::app::recordings::RecordingAction;
use crate::hand::Moment;
use crate::inputs::pad::device::system_pads;
use crate::link::{Clock, guard};
use crate::shell::desktop::dialog::NativeDialog;
use crate::shell::desktop::file_manager;
use crate::shell::desktop::icon::icon;
use crate::shell::desktop::options::{DesktopStart, Renderer};
use crate::shell::desktop::placing::{Fitting, Maximizing, REQUEST_INTERVAL};
use crate::shell::desktop::shutdown::{END_TIMEOUT, ShutdownState};
use crate::shell::{DesktopApp, REST_FRAME_INTERVAL, SOFTWARE_REST_FRAME_INTERVAL};
use egui::{Vec2, ViewportBuilder, ViewportCommand, ViewportInfo, WindowLevel};
use mundy::{Interest, Preferences, Subscription};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// Repaint interval without updates, for ages and countdowns.
pub(crate) const REPAINT_AT_LEAST: Duration = Duration::from_millis(250);

/// Duration of the fades of tabs, menus and cards, in seconds.
const FADE_S: f32 = 0.12;

/// Initial state of the window.
pub(crate) fn viewport(layout: &Layout) -> ViewportBuilder {
    ViewportBuilder::default()
        .with_title("Handscope")
        .with_app_id("handscope")
        .with_icon(icon())
        .with_inner_size(<[f32; 2]>::from(layout.window))
        .with_maximized(layout.maximized)
        .with_clamp_size_to_monitor_size(true)
        .with_min_inner_size(WINDOW_LEAST)
}

/// Services that the program runs on.
pub(crate) struct Services {
    /// Runtime of all links.
    pub(crate) runtime: tokio::runtime::Handle,
    pub(crate) clock: Clock,
    /// Signals the window that the program has to end.
    pub(crate) ending: Arc<ShutdownState>,
}

/// Becomes the program once its window exists.
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

    /// Layout of the window in the last run.
    pub(crate) fn layout(&self) -> Layout {
        let waiting = self.waiting.borrow();
        let settings = waiting.as_ref().map(|(start, _)| &start.loaded.settings);
        settings.map_or_else(Layout::default, |settings| settings.layout)
    }

    /// Starts the program; `None` if it was started before.
    pub(crate) fn begin(&self, ctx: &egui::Context) -> Option<DesktopProgram> {
        let (start, services) = self.waiting.take()?;
        self.stands.store(true, Ordering::Relaxed);
        Some(DesktopProgram::new(ctx, start, services))
    }
}

/// Enables fades unless the system requests reduced motion; active while the subscription exists.
fn follow_reduced_motion(ctx: &egui::Context) -> Subscription {
    let ctx = ctx.clone();
    Preferences::subscribe(Interest::ReducedMotion, move |wished| {
        let fade_s = if wished.reduced_motion.is_reduce() {
            0.0
        } else {
            FADE_S
        };
        ctx.all_styles_mut(|style| style.animation_time = fade_s);
        ctx.request_repaint();
    })
}

/// The program behind the window.
pub(crate) struct DesktopProgram {
    desktop_app: DesktopApp,
    clock: Clock,
    /// Maximum delay of a frame after an update while no hand moves.
    at_rest: Duration,
    /// Current maximum delay, in milliseconds.
    frame_within_ms: Arc<AtomicU64>,
    titled: Option<String>,
    fits: Fitting,
    maximizes: Maximizing,
    /// Full-screen state; `None` outside an exhibition.
    fills: Option<Filling>,
    closing: bool,
    ending: Arc<ShutdownState>,
    _reduced_motion: Subscription,
}

impl Drop for DesktopProgram {
    /// However the window ends, even by a panic: holds each hand that may move, and gives it time to rest.
    fn drop(&mut self) {
        self.ending.ended();
        guard::hold_all_within(END_TIMEOUT);
    }
}

impl DesktopProgram {
    fn new(ctx: &egui::Context, start: DesktopStart, services: Services) -> Self {
        let Services {
            runtime,
            clock,
            ending,
        } = services;
        ending.wakes(ctx);
        let repaint = ctx.clone();
        let frame_within_ms = Arc::new(AtomicU64::new(0));
        let within = Arc::clone(&frame_within_ms);
        let wake = Arc::new(move || {
            let within = Duration::from_millis(within.load(Ordering::Relaxed));
            repaint.request_repaint_after(within);
        });
        let env = Env {
            dial: Arc::new(SimDial::new(clock)),
            pads: system_pads(),
            runtime,
            clock,
            wake,
            files: Arc::new(NativeDialog),
            reveal: Arc::new(file_manager::show),
            settings_path: start.settings_path,
            documents: documents(),
            lost_steps: LostSteps::default(),
        };
        let was_maximized = start.loaded.settings.layout.maximized;
        let mut app = App::new(env, start.loaded.settings);
        let at_rest = match start.drawing {
            Renderer::OpenGl => REST_FRAME_INTERVAL,
            Renderer::Software | Renderer::InPlaceOfOpenGl(_) => SOFTWARE_REST_FRAME_INTERVAL,
        };
        let without = match start.drawing {
            Renderer::InPlaceOfOpenGl(reason) => Some(NoticeKind::DrawnWithoutOpenGl { reason }),
            Renderer::OpenGl | Renderer::Software => None,
        };
        for notice in start.loaded.notice.into_iter().chain(without) {
            app.notify(notice, clock.now());
        }
        if !start.records {
            app.record_nothing();
        }
        let mut endpoints = start.endpoints.into_iter();
        app.open(endpoints.next(), clock.now());
        app.open_beside(endpoints.collect(), clock.now());
        if let Some(exhibit) = start.exhibit {
            app.enter_exhibit(exhibit, clock.now());
        }
        if let Some(path) = start.replay {
            app.act(Action::Recording(RecordingAction::Open(path)), clock.now());
        }
        Self {
            desktop_app: DesktopApp::new(app).with_snap(start.snap),
            clock,
            at_rest,
            frame_within_ms,
            titled: None,
            fits: Fitting::default(),
            maximizes: Maximizing::new(was_maximized),
            fills: None,
            closing: false,
            ending,
            _reduced_motion: follow_reduced_motion(ctx),
        }
    }

    /// Applies updates. Call it before each frame, and at least every [`REPAINT_AT_LEAST`] while nothing is drawn.
    pub(crate) fn logic(&mut self, ctx: &egui::Context) {
        let now = self.clock.now();
        self.ending.lives(now);
        self.desktop_app.logic(now);
        let within = self.desktop_app.frame_within(self.at_rest);
        let within_ms = u64::try_from(within.as_millis()).unwrap_or(0);
        self.frame_within_ms.store(within_ms, Ordering::Relaxed);
        self.title(ctx);
        self.fill(ctx, now);
        if self.fills.is_none() {
            self.fit(ctx, now);
            if !self.maximizes.is_pending() {
                self.keep_size(ctx, now);
            }
        }
        self.close(ctx, now);
        ctx.request_repaint_after(REPAINT_AT_LEAST);
    }

    /// Draws one frame over all of `ui`.
    pub(crate) fn ui(&mut self, ui: &mut egui::Ui) {
        self.desktop_app.ui(ui, self.clock.now());
    }

    /// Names the hand in the window's title, so that a simulated one is also recognisable in the task bar.
    fn title(&mut self, ctx: &egui::Context) {
        let state = self.desktop_app.state();
        let title = match &state.hand().connection.endpoint {
            _ if state.timeline.is_some() => "Handscope - RECORDED".to_owned(),
            Some(_) if state.hand().connection.is_simulated() => {
                "Handscope - SIMULATED hand".to_owned()
            }
            Some(_) if state.hands.is_several() => {
                format!("Handscope - {} hands", state.hands.count())
            }
            Some(endpoint) => format!("Handscope - {endpoint}"),
            None => "Handscope".to_owned(),
        };
        if self.titled.as_ref() != Some(&title) {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.titled = Some(title);
        }
    }

    /// During an exhibition, keeps the window full-screen and on top, even if its state is changed from outside.
    fn fill(&mut self, ctx: &egui::Context, now: Moment) {
        let wanted = self.desktop_app.state().exhibit.is_some();
        let level = |level| ViewportCommand::WindowLevel(level);
        let commands = match &mut self.fills {
            None if !wanted => return,
            Some(_) if !wanted => {
                self.fills = None;
                vec![
                    ViewportCommand::Fullscreen(false),
                    ViewportCommand::MinInnerSize(WINDOW_LEAST.into()),
                    ViewportCommand::Decorations(true),
                    level(WindowLevel::Normal),
                ]
            }
            fills => {
                let filling = fills.get_or_insert_default();
                let view = ctx.input(|input| input.viewport().clone());
                if !filling.is_due(&view, now) {
                    return;
                }
                let mut commands = vec![
                    ViewportCommand::Minimized(false),
                    // A screen may be smaller than the window's minimum size.
                    ViewportCommand::MinInnerSize(Vec2::ZERO),
                    ViewportCommand::Decorations(false),
                    ViewportCommand::Fullscreen(true),
                    level(WindowLevel::AlwaysOnTop),
                    ViewportCommand::Focus,
                ];
                if let Some(screen) = view.monitor_size.filter(|_| filling.by_hand) {
                    commands.push(ViewportCommand::OuterPosition(egui::Pos2::ZERO));
                    commands.push(ViewportCommand::InnerSize(screen));
                }
                commands
            }
        };
        for command in commands {
            ctx.send_viewport_cmd(command);
        }
    }

    /// Maximises the window as it was in the last run, or shrinks it if it and its frame exceed the screen.
    fn fit(&mut self, ctx: &egui::Context, now: Moment) {
        let view = ctx.input(|input| input.viewport().clone());
        if self.maximizes.is_due(&view, now) {
            ctx.send_viewport_cmd(ViewportCommand::Maximized(true));
        }
        if self.maximizes.is_pending() || view.maximized == Some(true) {
            return;
        }
        if let Some(size) = self.fits.size(&view, now) {
            ctx.send_viewport_cmd(ViewportCommand::InnerSize(size));
            ctx.send_viewport_cmd(ViewportCommand::OuterPosition(egui::Pos2::ZERO));
        }
    }

    /// Saves the size that the user gave the window, and its maximised state; full-screen and minimised sizes are not saved.
    fn keep_size(&mut self, ctx: &egui::Context, now: Moment) {
        let (shown, maximized) = ctx.input(|input| {
            let view = input.viewport();
            let forced = view.fullscreen == Some(true) || view.minimized == Some(true);
            let maximized = view.maximized.filter(|_| !forced);
            (view.inner_rect.filter(|_| !forced), maximized)
        });
        // Without the zoom, which does not exist yet when the window is created.
        let shown = shown.map(|shown| shown.size() * ctx.zoom_factor());
        let Some(shown) = shown else { return };
        let desktop_app = &mut self.desktop_app;
        let before = desktop_app.state().settings.layout;
        let maximized = maximized.unwrap_or(before.maximized);
        let window = if maximized {
            before.window
        } else {
            [shown.x, shown.y].into()
        };
        let layout = Layout {
            window,
            maximized,
            ..before
        };
        if layout != before {
            desktop_app.app().act(Action::Layout(layout), now);
        }
    }

    /// Holds a moving hand before the window closes.
    fn close(&mut self, ctx: &egui::Context, now: Moment) {
        // A shutdown by the system shows no question.
        self.closing |= self.ending.is_wanted();
        if !self.closing {
            let asked = ctx.input(|input| input.viewport().close_requested());
            let app = self.desktop_app.app();
            if asked && app.asks_before_closing() {
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
                return;
            }
            self.closing = asked || app.leaves();
        }
        if !self.closing {
            return;
        }
        if self.desktop_app.app().close(now) {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        } else {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            ctx.request_repaint_after(self.desktop_app.frame_within(self.at_rest));
        }
    }
}

/// Full-screen state of a window.
#[derive(Debug, Default)]
struct Filling {
    /// Time of the last request.
    requested: Option<Moment>,
    /// True if there is no window manager to obey the request: size and position are set directly.
    by_hand: bool,
}

impl Filling {
    /// True if a request is due: at first, and later whenever the window is not as large as its screen.
    fn is_due(&mut self, view: &ViewportInfo, now: Moment) -> bool {
        let waits = |requested| now.since(requested) < REQUEST_INTERVAL;
        if self.requested.is_some_and(waits) {
            return false;
        }
        let sizes = view.monitor_size.zip(view.inner_rect);
        let differs =
            |(screen, inner): (Vec2, egui::Rect)| (screen - inner.size()).abs().max_elem() > 1.0;
        let is_other = sizes.is_some_and(differs);
        let was_requested = self.requested.is_some();
        self.by_hand |= was_requested && is_other && view.fullscreen == Some(true);
        let is_moved = view
            .inner_rect
            .is_some_and(|inner| inner.min != egui::Pos2::ZERO);
        let is_hidden = view.fullscreen == Some(false) || view.minimized == Some(true);
        let is_due = !was_requested || is_other || is_hidden || self.by_hand && is_moved;
        if is_due {
            self.requested = Some(now);
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws frames until this is so.
    fn until(
        ctx: &egui::Context,
        program: &mut DesktopProgram,
        what: &str,
        is_so: impl Fn(&DesktopProgram) -> bool,
    ) {
        let begun = std::time::Instant::now();
        while !is_so(program) {
            assert!(begun.elapsed() < Duration::from_secs(30), "{what}");
            let mut drawn = ctx.run_ui(egui::RawInput::default(), |ui| program.logic(ui.ctx()));
            drawn.textures_delta.clear();
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    #[test]
    fn a_panic_in_the_window_holds_the_hand_before_it_ends() {
        use crate::hand::Dof;
        use crate::poses::Preset;
        use crate::sim::serve::modbus_tcp;
        use crate::sim::{SharedHand, SimConfig, SimHand};
        let mut builder = tokio::runtime::Builder::new_multi_thread();
        let runtime = builder.worker_threads(1).enable_all().build().unwrap();
        let _inside = runtime.enter();
        let hand = SharedHand::new(
            SimHand::new(SimConfig::default()),
            tokio::time::Instant::now(),
        );
        let socket = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        socket.set_nonblocking(true).unwrap();
        let endpoint = format!("tcp:{}", socket.local_addr().unwrap());
        let listener = tokio::net::TcpListener::from_std(socket).unwrap();
        runtime.spawn(modbus_tcp::serve(hand.clone(), listener));
        let start = DesktopStart {
            endpoints: vec![endpoint.parse().unwrap()],
            drawing: Renderer::Software,
            loaded: crate::app::files::settings_file::Loaded::default(),
            settings_path: None,
            snap: crate::shell::headless::snap::snap,
            records: false,
            exhibit: None,
            replay: None,
        };
        let clock = Clock::start();
        let services = Services {
            runtime: runtime.handle().clone(),
            clock,
            ending: ShutdownState::new(clock),
        };
        let ctx = egui::Context::default();
        let mut program = DesktopProgram::new(&ctx, start, services);
        let angle = |program: &DesktopProgram| {
            let angle = program.desktop_app.state().hand().readings.sample.angle;
            angle.map_or(1000, |angle| angle.value[Dof::Index].raw())
        };
        let is_armed = |program: &DesktopProgram| {
            program
                .desktop_app
                .state()
                .hand()
                .connection
                .status
                .armed
                .is_some()
        };
        until(&ctx, &mut program, "it answers", |program| {
            let hand = program.desktop_app.state().hand();
            hand.connection.status.state.is_live() && hand.readings.sample.faults.is_some()
        });
        let now = clock.now();
        program.desktop_app.app().act(Action::Arm, now);
        until(&ctx, &mut program, "it is armed", is_armed);
        program
            .desktop_app
            .app()
            .act(Action::Preset(Preset::Close), now);
        until(&ctx, &mut program, "it moves", |program| {
            angle(program) < 900
        });
        let died = hand.now();
        let ended = std::panic::catch_unwind(std::panic::AssertUnwindSafe(move || {
            let _program = program;
            panic!("as if something were broken");
        }));
        assert!(ended.is_err());
        // The window is gone, and the hand was held before it went.
        let set = hand.with(|hand, _| {
            let later = hand.journal().iter().filter(|entry| entry.at > died);
            let angles = later.filter(|entry| entry.address == 1486 && entry.bytes.len() == 12);
            let index = |bytes: &[u8]| i16::from_le_bytes([bytes[6], bytes[7]]);
            angles.map(|entry| index(&entry.bytes)).collect::<Vec<_>>()
        });
        let held = set.last().copied().unwrap_or_default();
        assert!(held > 100, "{set:?}");
        let rests = hand.with(|hand, now| hand.read(crate::hand::Span::new(1546 + 6, 2), now));
        let rests = i16::from_le_bytes(rests.unwrap().try_into().unwrap());
        assert!(rests.abs_diff(held) < 20, "{rests} {set:?}");
    }

    #[test]
    fn the_window_is_known_to_the_system_by_name_and_icon() {
        let viewport = viewport(&Layout::default());
        assert_eq!(viewport.app_id.as_deref(), Some("handscope"));
        assert_eq!(viewport.icon, Some(icon()));
    }
}
