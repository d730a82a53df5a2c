//! The whole program with a window of 1440x900 that nobody sees, in virtual or in real time.

use crate::clock::cpu_ms;
use crate::report::Failure;
use egui::{
    Context, Event, Modifiers, PointerButton, Pos2, RawInput, Rect, ViewportId, ViewportInfo, pos2,
    vec2,
};
use handscope::app::action::Action;
use handscope::app::connect::SimDial;
use handscope::app::env::NoChoice;
use handscope::app::env::no_reveal;
use handscope::app::env::{Env, LostSteps};
use handscope::app::program::App;
use handscope::app::settings::PlotWindow;
use handscope::app::settings::Settings;
use handscope::app::state::State;
use handscope::draw::raster::Raster;
use handscope::hand::Moment;
use handscope::inputs::pad::device::system_pads;
use handscope::link::Clock;
use handscope::shell::{DesktopApp, REST_FRAME_INTERVAL, SOFTWARE_REST_FRAME_INTERVAL};
use handscope::transport::Endpoint;
use handscope::ui::View;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::Notify;

/// Pixels of the window.
const SIZE: [u16; 2] = [1440, 900];
/// The same where the processor draws them.
const SOFTWARE_SIZE: [u16; 2] = [1920, 1080];
/// How often the program looks at its link while nothing is drawn.
const LOOK_EACH: Duration = Duration::from_millis(20);

/// Which time the program lives in.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Time {
    Virtual,
    Real,
}

/// The program, its window and the screen.
pub(crate) struct Scene {
    news: Arc<Notify>,
    desktop_app: DesktopApp,
    context: Context,
    /// Draws the pixels too, where the graphics card does not.
    raster: Option<Raster>,
    clock: Clock,
    runtime: Runtime,
    size: [u16; 2],
    /// What the mouse does before the next frame.
    events: Vec<Event>,
}

impl Scene {
    /// Starts the program with the built-in hand that grasps.
    pub(crate) fn start(time: Time) -> Result<Self, Failure> {
        let hand = Endpoint::Sim {
            seed: 1,
            scenario: "grasp".into(),
            body: None,
            object: None,
        };
        Self::open(time, hand)
    }

    /// Starts the program with a hand.
    pub(crate) fn open(time: Time, hand: Endpoint) -> Result<Self, Failure> {
        Self::begin(time, hand, None)
    }

    /// Starts the program with a hand that is recorded in this folder.
    pub(crate) fn recorded(hand: Endpoint, folder: &Path) -> Result<Self, Failure> {
        Self::begin(Time::Real, hand, Some(folder.to_owned()))
    }

    fn begin(time: Time, hand: Endpoint, documents: Option<PathBuf>) -> Result<Self, Failure> {
        let news = Arc::new(Notify::new());
        let wakes = Arc::clone(&news);
        let runtime = match time {
            Time::Virtual => Builder::new_current_thread()
                .enable_all()
                .start_paused(true)
                .build()?,
            Time::Real => Builder::new_multi_thread()
                .worker_threads(1)
                .enable_all()
                .build()?,
        };
        let inside = runtime.enter();
        let clock = Clock::start();
        let env = Env {
            runtime: runtime.handle().clone(),
            clock,
            dial: Arc::new(SimDial::new(clock)),
            pads: system_pads(),
            wake: Arc::new(move || wakes.notify_one()),
            files: Arc::new(NoChoice),
            reveal: no_reveal(),
            settings_path: None,
            documents,
            lost_steps: LostSteps::default(),
        };
        let mut app = App::new(env, Settings::default());
        app.open(Some(hand), clock.now());
        drop(inside);
        Ok(Self {
            news,
            desktop_app: DesktopApp::new(app),
            context: Context::default(),
            raster: None,
            clock,
            runtime,
            size: SIZE,
            events: Vec::new(),
        })
    }

    pub(crate) fn state(&self) -> &State {
        self.desktop_app.state()
    }

    /// Seconds that the plots show.
    pub(crate) fn plot(&mut self, window: PlotWindow) {
        let now = self.now();
        self.desktop_app.app().act(Action::PlotWindow(window), now);
    }

    /// Opens further hands, each in a slot of its own.
    pub(crate) fn open_beside(&mut self, endpoints: Vec<Endpoint>) {
        let now = self.now();
        let _inside = self.runtime.enter();
        self.desktop_app.app().open_beside(endpoints, now);
    }

    /// Shows all hands side by side.
    pub(crate) fn show_all_hands(&mut self) {
        self.desktop_app.show_all_hands();
    }

    pub(crate) fn show(&mut self, view: View) {
        self.desktop_app.show(view);
    }

    /// Ends the link by a person's wish.
    pub(crate) fn disconnect(&mut self) {
        let now = self.now();
        let _inside = self.runtime.enter();
        self.desktop_app.app().act(Action::Disconnect, now);
    }

    /// Waits until the link has news, at most so long.
    pub(crate) fn wait(&mut self, most: Duration) {
        let news = Arc::clone(&self.news);
        // Without news the time is up: both end the waiting.
        let _late = self
            .runtime
            .block_on(async { tokio::time::timeout(most, news.notified()).await });
    }

    fn now(&self) -> Moment {
        let _inside = self.runtime.enter();
        self.clock.now()
    }

    /// Lets time pass without looking.
    pub(crate) fn pass(&mut self, time: Duration) {
        self.runtime
            .block_on(async { tokio::time::sleep(time).await });
    }

    /// Lets time pass with the window hidden.
    pub(crate) fn run(&mut self, time: Duration) {
        let until = self.now().plus(time);
        while self.now() < until {
            self.pass(LOOK_EACH);
            let now = self.now();
            let _inside = self.runtime.enter();
            self.desktop_app.logic(now);
        }
    }

    /// How soon news are to be drawn.
    pub(crate) fn frame_within(&self) -> Duration {
        let at_rest = if self.raster.is_some() {
            SOFTWARE_REST_FRAME_INTERVAL
        } else {
            REST_FRAME_INTERVAL
        };
        self.desktop_app.frame_within(at_rest)
    }

    /// From now on the pixels are drawn too, of a window of 1920x1080.
    pub(crate) fn paint(&mut self) {
        self.size = SOFTWARE_SIZE;
        let [width, height] = self.size;
        // Its textures come with the first frame of a context.
        self.context = Context::default();
        self.raster = Some(Raster::new(width.into(), height.into()));
    }

    /// From now on they are not.
    pub(crate) fn paint_not(&mut self) {
        self.raster = None;
        self.size = SIZE;
    }

    /// Presses or lets go of the mouse at a point before the next frame.
    pub(crate) fn press(&mut self, pos: Pos2, pressed: bool) {
        self.events.push(Event::PointerMoved(pos));
        self.events.push(Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }

    /// One frame, as far as the processor draws it. Gives processor milliseconds of logic, layout and triangles.
    pub(crate) fn frame(&mut self) -> [f64; 3] {
        let now = self.now();
        let _inside = self.runtime.enter();
        let (logic, ()) = cpu_ms(|| self.desktop_app.logic(now));
        let input = RawInput {
            events: std::mem::take(&mut self.events),
            ..screen(self.size, now)
        };
        let desktop_app = &mut self.desktop_app;
        let context = &self.context;
        let (layout, mut output) = cpu_ms(|| context.run_ui(input, |ui| desktop_app.ui(ui, now)));
        match &mut self.raster {
            Some(raster) => raster.apply_textures(&mut output.textures_delta),
            None => output.textures_delta.clear(),
        }
        let (triangles, meshes) =
            cpu_ms(|| context.tessellate(output.shapes, output.pixels_per_point));
        if let Some(raster) = &mut self.raster {
            raster.draw(&meshes, output.pixels_per_point, [0, 0, 0, 255]);
            raster.free_textures();
        }
        std::hint::black_box(meshes);
        [logic, layout, triangles]
    }
}

fn screen(size: [u16; 2], now: Moment) -> RawInput {
    let [width, height] = size.map(f32::from);
    let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
    let viewport = ViewportInfo {
        native_pixels_per_point: Some(1.0),
        inner_rect: Some(rect),
        focused: Some(true),
        ..ViewportInfo::default()
    };
    RawInput {
        viewports: std::iter::once((ViewportId::ROOT, viewport)).collect(),
        screen_rect: Some(rect),
        time: Some(now.secs()),
        ..RawInput::default()
    }
}
