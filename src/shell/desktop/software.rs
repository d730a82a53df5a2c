//! The window without OpenGL: its event loop and draw timing. The screen module handles the pixels.

use crate::shell::desktop::failure::{DesktopError, cause_of};
use crate::shell::desktop::program::{Beginning, DesktopProgram, REPAINT_AT_LEAST, viewport};
use crate::shell::desktop::screen::{DrawnFrame, Screen};
use egui::{Context, RawInput, ViewportCommand, ViewportEvent, ViewportId, ViewportInfo};
use egui_winit::accesskit_winit::{self, WindowEvent as AccessEvent};
use egui_winit::winit::application::ApplicationHandler;
use egui_winit::winit::event::WindowEvent;
use egui_winit::winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use egui_winit::winit::window::{Window, WindowId};
use egui_winit::{State, create_window, process_viewport_commands, update_viewport_info};
use std::rc::Rc;
use std::time::Instant;

/// Events sent to the event loop.
enum LoopEvent {
    /// A change has to be drawn by this time.
    DrawBy(Instant),
    /// Request of a screen reader.
    Access(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for LoopEvent {
    fn from(event: accesskit_winit::Event) -> Self {
        Self::Access(event)
    }
}

/// Opens the window and runs until it is closed.
pub(crate) fn run(beginning: &Rc<Beginning>) -> Result<(), DesktopError> {
    let refused = |error: &dyn std::error::Error| DesktopError::of(&error.to_string());
    let events = EventLoop::<LoopEvent>::with_user_event()
        .build()
        .map_err(|error| refused(&error))?;
    let mut software = Software {
        ctx: Context::default(),
        beginning: Rc::clone(beginning),
        wishes: events.create_proxy(),
        open: None,
        failed: None,
    };
    events
        .run_app(&mut software)
        .map_err(|error| refused(&error))?;
    software.failed.map_or(Ok(()), Err)
}

struct Software {
    ctx: Context,
    beginning: Rc<Beginning>,
    wishes: EventLoopProxy<LoopEvent>,
    open: Option<OpenWindow>,
    failed: Option<DesktopError>,
}

/// State of the window after a frame.
#[derive(PartialEq, Eq)]
enum Stays {
    Open,
    Closes,
}

struct OpenWindow {
    window: Rc<Window>,
    state: State,
    screen: Screen,
    program: DesktopProgram,
    info: ViewportInfo,
    /// Input that no frame has consumed yet.
    pending: RawInput,
    covered: bool,
    /// Time of the next requested frame.
    due: Option<Instant>,
    /// Time of a redraw request that the display has not answered yet.
    asked: Option<Instant>,
}

impl Software {
    fn create_window(&self, events: &ActiveEventLoop) -> Result<OpenWindow, DesktopError> {
        // A screen reader must know the window before it is shown.
        let hidden = viewport(&self.beginning.layout()).with_visible(false);
        let window = create_window(&self.ctx, events, &hidden)
            .map_err(|error| DesktopError::of(&error.to_string()))?;
        let window = Rc::new(window);
        let scale = egui_winit::pixels_per_point(&self.ctx, &window);
        let theme = window.theme();
        let mut state = State::new(
            self.ctx.clone(),
            ViewportId::ROOT,
            &window,
            Some(scale),
            theme,
            None,
        );
        state.init_accesskit(events, &window, self.wishes.clone());
        let screen = Screen::new(&window).map_err(|error| no_surface(&error))?;
        let mut info = ViewportInfo::default();
        update_viewport_info(&mut info, &self.ctx, &window, true);
        let wishes = self.wishes.clone();
        self.ctx.set_request_repaint_callback(move |wanted| {
            // A loop that has ended draws nothing.
            let _sent = wishes.send_event(LoopEvent::DrawBy(Instant::now() + wanted.delay));
        });
        let program = self.beginning.begin(&self.ctx);
        let program = program.ok_or_else(|| DesktopError::of("it was opened twice"))?;
        window.set_visible(true);
        window.request_redraw();
        Ok(OpenWindow {
            window,
            state,
            screen,
            program,
            info,
            pending: RawInput::default(),
            covered: false,
            due: None,
            asked: Some(Instant::now()),
        })
    }

    fn follow(&mut self, events: &ActiveEventLoop, stays: Result<Stays, DesktopError>) {
        if let Err(error) = stays {
            self.failed = Some(error);
        } else if stays == Ok(Stays::Open) {
            return;
        }
        self.open = None;
        events.exit();
    }
}

impl ApplicationHandler<LoopEvent> for Software {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.create_window(events) {
                Ok(open) => self.open = Some(open),
                Err(error) => self.follow(events, Err(error)),
            }
        }
    }

    fn user_event(&mut self, _events: &ActiveEventLoop, wish: LoopEvent) {
        let Some(open) = &mut self.open else { return };
        match wish {
            LoopEvent::DrawBy(at) => open.draw_by(at),
            LoopEvent::Access(event) => {
                match event.window_event {
                    AccessEvent::InitialTreeRequested => self.ctx.enable_accesskit(),
                    AccessEvent::ActionRequested(asked) => {
                        open.state.on_accesskit_action_request(asked);
                    }
                    AccessEvent::AccessibilityDeactivated => self.ctx.disable_accesskit(),
                }
                open.draw_by(Instant::now());
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match event {
            WindowEvent::RedrawRequested => {
                let stays = open.frame(&self.ctx);
                self.follow(events, stays);
            }
            WindowEvent::CloseRequested => {
                open.info.events.push(ViewportEvent::Close);
                open.draw_by(Instant::now());
            }
            WindowEvent::Occluded(covered) => {
                open.covered = covered;
                open.draw_by(Instant::now());
            }
            event => {
                if open.state.on_window_event(&open.window, &event).repaint {
                    open.draw_by(Instant::now());
                }
            }
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        let (now, next) = (Instant::now(), open.next());
        if next.is_none_or(|next| next > now) {
            events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        } else if open.is_hidden() || open.asked.is_some() {
            let stays = open.logic(&self.ctx);
            self.follow(events, stays);
            events.set_control_flow(ControlFlow::Poll);
        } else {
            open.due = None;
            open.asked = Some(now);
            open.window.request_redraw();
            events.set_control_flow(ControlFlow::WaitUntil(now + REPAINT_AT_LEAST));
        }
    }
}

impl OpenWindow {
    fn draw_by(&mut self, at: Instant) {
        self.due = Some(self.due.map_or(at, |due| due.min(at)));
    }

    /// Time of the next action, drawn or not. Displays withhold frames from invisible windows, some silently, so a frame is
    /// awaited for at most [`REPAINT_AT_LEAST`].
    fn next(&self) -> Option<Instant> {
        self.asked
            .map_or(self.due, |asked| Some(asked + REPAINT_AT_LEAST))
    }

    fn is_hidden(&self) -> bool {
        self.covered || self.window.is_minimized() == Some(true)
    }

    fn input(&mut self, ctx: &Context) -> RawInput {
        update_viewport_info(&mut self.info, ctx, &self.window, false);
        let mut input = std::mem::take(&mut self.pending);
        input.append(self.state.take_egui_input(&self.window));
        input.viewports.insert(ViewportId::ROOT, self.info.take());
        input
    }

    /// Runs one frame and draws it.
    fn frame(&mut self, ctx: &Context) -> Result<Stays, DesktopError> {
        (self.due, self.asked) = (None, None);
        let input = self.input(ctx);
        let closing = input.viewport().close_requested();
        let program = &mut self.program;
        let mut output = ctx.run_ui(input, |ui| {
            program.logic(ui.ctx());
            program.ui(ui);
        });
        self.state
            .handle_platform_output(&self.window, output.platform_output);
        self.screen.textures(&mut output.textures_delta);
        let frame = DrawnFrame {
            shapes: output.shapes,
            pixels_per_point: output.pixels_per_point,
        };
        let shown = self.screen.show(&self.window, ctx, frame);
        shown.map_err(|error| no_surface(&error))?;
        let Some(root) = output.viewport_output.remove(&ViewportId::ROOT) else {
            return Ok(Stays::Open);
        };
        if let Some(at) = Instant::now().checked_add(root.repaint_delay) {
            self.draw_by(at);
        }
        Ok(self.apply_commands(ctx, root.commands, closing))
    }

    /// Runs a step while the window is invisible: drains the link and follows a stop, but draws nothing.
    fn logic(&mut self, ctx: &Context) -> Result<Stays, DesktopError> {
        (self.due, self.asked) = (None, None);
        let input = self.input(ctx);
        let closing = input.viewport().close_requested();
        let program = &mut self.program;
        let mut output = ctx.run_logic(&input, |ctx| program.logic(ctx));
        self.pending = input;
        self.draw_by(Instant::now() + REPAINT_AT_LEAST);
        let commands = output.viewport_commands.remove(&ViewportId::ROOT);
        Ok(self.apply_commands(ctx, commands.unwrap_or_default(), closing))
    }

    fn apply_commands(
        &mut self,
        ctx: &Context,
        commands: Vec<ViewportCommand>,
        closing: bool,
    ) -> Stays {
        if closing && !commands.contains(&ViewportCommand::CancelClose) {
            return Stays::Closes;
        }
        // Screenshots and similar commands are not used here.
        let mut others = Vec::new();
        process_viewport_commands(ctx, &mut self.info, commands, &self.window, &mut others);
        if !self.info.events.is_empty() {
            self.draw_by(Instant::now());
        }
        Stays::Open
    }
}

fn no_surface(error: &dyn std::error::Error) -> DesktopError {
    DesktopError::NoSurface {
        cause: cause_of(&error.to_string()),
    }
}
