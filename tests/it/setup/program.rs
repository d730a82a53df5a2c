//! The program with its window, on a runtime of its own, with nobody to choose files and nothing on disk unless a test says so.

use crate::setup::time::Time;
use futures::future::BoxFuture;
use handscope::app::action::Action;
use handscope::app::connect::SimDial;
use handscope::app::env::no_reveal;
use handscope::app::env::{ChooseFile, NoChoice};
use handscope::app::env::{Env, LostSteps};
use handscope::app::exhibit::Exhibition;
use handscope::app::program::App;
use handscope::app::settings::Settings;
use handscope::app::state::State;
use handscope::hand::Moment;
use handscope::inputs::pad::device::system_pads;
use handscope::link::Clock;
use handscope::shell::DesktopApp;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::{EnterGuard, Handle, Runtime, RuntimeFlavor};

/// What a program is given in front of the built-in hand. Its time begins now.
pub(crate) fn env() -> Env {
    let runtime = Handle::current();
    // A runtime of one thread is one whose time is virtual.
    let clock = match runtime.runtime_flavor() {
        RuntimeFlavor::CurrentThread => Clock::start_virtual(),
        _ => Clock::start(),
    };
    Env {
        runtime,
        clock,
        dial: Arc::new(SimDial::new(clock)),
        pads: system_pads(),
        wake: Arc::new(|| ()),
        files: Arc::new(NoChoice),
        reveal: no_reveal(),
        settings_path: None,
        documents: None,
        lost_steps: LostSteps::default(),
    }
}

/// Starts a program, with this hand or the one of its settings.
pub(crate) fn start(env: Env, settings: Settings, hand: Option<&str>) -> App {
    let now = env.clock.now();
    let mut app = App::new(env, settings);
    app.open(hand.map(|hand| hand.parse().unwrap()), now);
    app
}

/// A program, its window and the time it lives in.
pub(crate) struct Program {
    pub(crate) desktop_app: DesktopApp,
    clock: Clock,
    runtime: Runtime,
}

impl Program {
    /// Starts with what `set_up` gives: it is called inside the runtime.
    pub(crate) fn start(
        time: Time,
        hand: Option<&str>,
        set_up: impl FnOnce() -> (Env, Settings),
    ) -> Self {
        let runtime = time.runtime();
        let inside = runtime.enter();
        let (env, settings) = set_up();
        let clock = env.clock;
        let desktop_app = DesktopApp::new(start(env, settings, hand));
        drop(inside);
        Self {
            desktop_app,
            clock,
            runtime,
        }
    }

    pub(crate) fn state(&self) -> &State {
        self.desktop_app.state()
    }

    /// For what needs the runtime's time.
    pub(crate) fn enter(&self) -> EnterGuard<'_> {
        self.runtime.enter()
    }

    pub(crate) fn now(&self) -> Moment {
        let _inside = self.runtime.enter();
        self.clock.now()
    }

    /// Asks for something as a view does.
    pub(crate) fn act(&mut self, action: Action) {
        let _inside = self.runtime.enter();
        self.desktop_app.app().act(action, self.clock.now());
    }

    /// Shows an exhibition, as the command line does.
    pub(crate) fn exhibit(&mut self, start: Exhibition) {
        let _inside = self.runtime.enter();
        let now = self.clock.now();
        self.desktop_app.app().enter_exhibit(start, now);
    }

    /// Time goes by, and the program looks at what came.
    pub(crate) fn tick(&mut self, step: Duration) {
        self.runtime
            .block_on(async { tokio::time::sleep(step).await });
        self.logic();
    }

    /// Time goes by, and the program does not look: its window is frozen, or hidden by another's dialog.
    pub(crate) fn pass_unseen(&mut self, step: Duration) {
        self.runtime
            .block_on(async { tokio::time::sleep(step).await });
    }

    /// So much time is over at once, as after a sleep of the computer. In virtual time only.
    pub(crate) fn skip(&mut self, length: Duration) {
        self.runtime.block_on(tokio::time::advance(length));
        self.logic();
    }

    /// The window is about to close. True once it may go.
    pub(crate) fn close(&mut self) -> bool {
        let _inside = self.runtime.enter();
        self.desktop_app.app().close(self.clock.now())
    }

    /// The program looks at what came.
    pub(crate) fn logic(&mut self) {
        let _inside = self.runtime.enter();
        let now = self.clock.now();
        self.desktop_app.logic(now);
        // A window draws as often.
        self.desktop_app.app().drawn(now);
    }

    /// Draws the window.
    pub(crate) fn ui(&mut self, ui: &mut egui::Ui) {
        let _inside = self.runtime.enter();
        self.desktop_app.ui(ui, self.clock.now());
    }
}

/// Without asking: always into one folder, under the suggested name.
#[derive(Debug, Clone)]
pub(crate) struct InFolder(pub(crate) PathBuf);

impl ChooseFile for InFolder {
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(Some(self.0.join(suggested))))
    }

    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        self.choose(suggested)
    }

    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(Some(self.0.clone())))
    }
}
