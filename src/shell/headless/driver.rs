//! The whole program without a window: lets time pass and takes pictures. A built-in hand is driven in virtual time,
//! so that seconds take milliseconds and two runs give equal bytes. Leaves no file behind.

use crate::app::action::Action;
use crate::app::connect::SimDial;
use crate::app::env::NoChoice;
use crate::app::env::no_reveal;
use crate::app::env::{Env, LostSteps};
use crate::app::params::state::ParamAction;
use crate::app::program::App;
use crate::app::recordings::RecordingAction;
use crate::app::settings::Settings;
use crate::app::settings::{Language, Theme};
use crate::app::state::State;
use crate::app::trials::{SeriesKind, TrialAction};
use crate::hand::Moment;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::inputs::pad::device::system_pads;
use crate::link::{Clock, LinkTrouble};
use crate::shell::DesktopApp;
use crate::shell::headless::canvas::{Canvas, Picture};
use crate::shell::headless::snap::snap;
use crate::transport::Endpoint;
use crate::trials::{Limits, TrialGrid, TrialPlan};
use crate::ui::View;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;
use tokio::runtime::{Builder, Runtime};

/// Time between two looks at the link, as the window has between two frames at 50 Hz.
pub const STEP: Duration = Duration::from_millis(20);
/// Arming takes less.
const ARM_TIMEOUT: Duration = Duration::from_millis(400);
/// A small grid of grasps takes less.
const GRASP_TIMEOUT: Duration = Duration::from_secs(300);
/// Opening a recording and going to a moment in it: a long one is read from a slow disk.
const REPLAY_TIMEOUT: Duration = Duration::from_secs(60);
/// A hand that is there answers long before.
pub const ANSWER_TIMEOUT: Duration = Duration::from_secs(3);

/// What is to be shown, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The hand.
    pub endpoint: Endpoint,
    /// Width and height in points.
    pub size: (u32, u32),
    /// Pixels a point.
    pub scale: f32,
    /// Dark or light.
    pub theme: Theme,
    /// Language of the window.
    pub language: Language,
}

/// Why there is nothing to show.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DriveError {
    /// The runtime could not be made.
    #[error("the program cannot start its runtime: {cause}")]
    Runtime {
        /// The system's words.
        cause: String,
    },
    /// There is no room for what is kept meanwhile.
    #[error("the program cannot make a folder for backups: {cause}")]
    NoFolder {
        /// The system's words.
        cause: String,
    },
    /// The link says why the hand does not answer.
    #[error("no hand at {endpoint}: {trouble}")]
    NoHand {
        /// The hand that was wanted.
        endpoint: Endpoint,
        /// Why it is not there.
        trouble: LinkTrouble,
    },
    /// A recording was not opened in time, or not at all.
    #[error("{} was not opened within {within_s} s", path.display())]
    NotReplayed {
        /// The file.
        path: PathBuf,
        /// How long was waited.
        within_s: u64,
    },
    /// Nothing at all was heard in time.
    #[error(
        "no hand at {endpoint}: nothing came within {after_s} s; check power, cable, address and id"
    )]
    Unanswered {
        /// The hand that was wanted.
        endpoint: Endpoint,
        /// How long was waited.
        after_s: u64,
    },
}

/// A running program and the screen it is drawn on.
pub struct Driver {
    // The desktop_app's link lives on the runtime, so it goes first.
    desktop_app: DesktopApp,
    canvas: Canvas,
    clock: Clock,
    endpoint: Endpoint,
    runtime: Runtime,
    /// What a program without a home of its own keeps; it goes with the driver.
    _kept: Option<TempDir>,
}

impl Driver {
    /// Starts the program and begins to connect. Nothing is written to the hand, and no settings are read or kept.
    ///
    /// # Errors
    /// [`DriveError::Runtime`].
    pub fn start(scene: &Scene) -> Result<Self, DriveError> {
        Self::begin(scene, scene.endpoint.clone(), None)
    }

    /// As [`Driver::start`] with a built-in hand, which stands at the end of this line, and with a folder for backups, which is
    /// removed at the end.
    ///
    /// # Errors
    /// [`DriveError::Runtime`], [`DriveError::NoFolder`].
    pub fn start_on_line(scene: &Scene, line: Endpoint) -> Result<Self, DriveError> {
        let kept = TempDir::new().map_err(|error| DriveError::NoFolder {
            cause: error.to_string(),
        })?;
        Self::begin(scene, line, Some(kept))
    }

    fn begin(scene: &Scene, endpoint: Endpoint, kept: Option<TempDir>) -> Result<Self, DriveError> {
        let runtime = Builder::new_current_thread()
            .enable_all()
            .start_paused(scene.endpoint.is_sim())
            .build()
            .map_err(|error| DriveError::Runtime {
                cause: error.to_string(),
            })?;
        let inside = runtime.enter();
        let clock = Clock::start();
        let dial = match kept {
            None => SimDial::new(clock),
            Some(_) => SimDial::at_lines(clock, scene.endpoint.clone()),
        };
        let settings_path = kept.as_ref().map(|kept| kept.path().join("settings.toml"));
        let env = Env {
            runtime: runtime.handle().clone(),
            clock,
            dial: Arc::new(dial),
            pads: system_pads(),
            wake: Arc::new(|| ()),
            files: Arc::new(NoChoice),
            reveal: no_reveal(),
            settings_path,
            documents: None,
            lost_steps: LostSteps::default(),
        };
        let settings = Settings {
            theme: scene.theme,
            language: scene.language,
            ..Settings::default()
        };
        let mut app = App::new(env, settings);
        app.open(Some(endpoint.clone()), clock.now());
        drop(inside);
        let mut driver = Self {
            desktop_app: DesktopApp::new(app).with_snap(snap),
            canvas: Canvas::new(scene.size, scene.scale),
            clock,
            endpoint,
            runtime,
            _kept: kept,
        };
        driver.hold_still();
        Ok(driver)
    }

    /// The first frame puts fonts and style into the screen; they must hold still after that.
    pub(crate) fn hold_still(&mut self) {
        let now = self.now();
        let desktop_app = &mut self.desktop_app;
        self.canvas.frame(now.secs(), |ui| desktop_app.ui(ui, now));
        self.canvas.hold_still();
    }

    /// Puts on other colours and another language.
    pub fn dress(&mut self, theme: Theme, language: Language) {
        for wish in [Action::Theme(theme), Action::Language(language)] {
            self.act(wish);
        }
        self.hold_still();
    }

    /// The program's time, virtual with a built-in hand.
    pub fn now(&self) -> Moment {
        let _inside = self.runtime.enter();
        self.clock.now()
    }

    /// The program and its window.
    pub const fn desktop_app(&mut self) -> &mut DesktopApp {
        &mut self.desktop_app
    }

    /// Lets one [`STEP`] pass, or what is left if that is less.
    pub(crate) fn step(&mut self, left: Duration) {
        // A timer can be made only inside the runtime.
        self.runtime
            .block_on(async { tokio::time::sleep(left.min(STEP)).await });
        let now = self.now();
        let _inside = self.runtime.enter();
        self.desktop_app.logic(now);
        // What would be drawn between two pictures.
        self.desktop_app.app().drawn(now);
    }

    /// Lets time pass until the hand answers.
    ///
    /// # Errors
    /// [`DriveError::NoHand`] with the first trouble, [`DriveError::Unanswered`] after [`ANSWER_TIMEOUT`].
    pub fn connect(&mut self) -> Result<(), DriveError> {
        let begun = self.now();
        while !self
            .desktop_app
            .state()
            .hand()
            .connection
            .status
            .state
            .is_live()
        {
            if let Some(trouble) = self
                .desktop_app
                .state()
                .hand()
                .connection
                .status
                .trouble
                .clone()
            {
                return Err(DriveError::NoHand {
                    endpoint: self.endpoint.clone(),
                    trouble,
                });
            }
            if self.now().since(begun) >= ANSWER_TIMEOUT {
                return Err(DriveError::Unanswered {
                    endpoint: self.endpoint.clone(),
                    after_s: ANSWER_TIMEOUT.as_secs(),
                });
            }
            self.step(STEP);
        }
        Ok(())
    }

    /// Lets `time` pass in steps.
    pub fn run_for(&mut self, time: Duration) {
        let begun = self.now();
        loop {
            let done = self.now().since(begun);
            if done >= time {
                return;
            }
            self.step(time.saturating_sub(done));
        }
    }

    /// Asks for something as the user does.
    pub(crate) fn act(&mut self, action: Action) {
        let now = self.now();
        let _inside = self.runtime.enter();
        self.desktop_app.app().act(action, now);
    }

    /// Lets time pass until something is so, or for so long at most.
    pub(crate) fn until(&mut self, within: Duration, so: impl Fn(&State) -> bool) {
        let begun = self.now();
        while !so(self.desktop_app.state()) && self.now().since(begun) < within {
            self.step(STEP);
        }
    }

    /// Replays a recording: shows its hand as it was at the end of this stretch, and in the plots just the stretch.
    ///
    /// # Errors
    /// [`DriveError::NotReplayed`].
    pub fn replay(
        &mut self,
        path: PathBuf,
        (from, to): (Moment, Moment),
    ) -> Result<(), DriveError> {
        let within_s = REPLAY_TIMEOUT.as_secs();
        let open = RecordingAction::OpenAt(path.clone(), (from, to));
        self.act(Action::Recording(open));
        self.until(REPLAY_TIMEOUT, |state| state.timeline.is_some());
        self.act(Action::Recording(RecordingAction::Seek(to)));
        let is_there = |state: &State| {
            let line = state.timeline.as_ref();
            line.is_some_and(|line| line.at == to && !line.waits)
        };
        self.until(REPLAY_TIMEOUT, is_there);
        if !is_there(self.desktop_app.state()) {
            return Err(DriveError::NotReplayed { path, within_s });
        }
        // The plots begin anew with a hand they see for the first time.
        self.hold_still();
        self.desktop_app.show_stretch((from, to));
        Ok(())
    }

    /// Reads what the hand keeps, and waits for it.
    pub(crate) fn read_rows(&mut self) {
        let now = self.now();
        if !self.desktop_app.state().hand().params.is_due(now) {
            return;
        }
        self.act(Action::Param(ParamAction::Read));
        self.until(ANSWER_TIMEOUT, |state| !state.hand().params.is_busy());
    }

    /// Tries a small grid of grasps on a built-in hand, and lets it run to its end: real trials, in virtual time.
    pub fn try_grasps(&mut self) {
        let index = |angle| PerDof::from_fn(|dof| (dof == Dof::Index).then_some(angle));
        let first = TrialPlan::default();
        let plan = TrialPlan {
            start: index(Angle::nearest(620)),
            close: index(Angle::nearest(300)),
            grid: TrialGrid {
                speeds: [25, 100, 250].map(Speed::nearest).into(),
                forces: [250, 500].map(Force::nearest).into(),
                repeats: 2,
                ..first.grid
            },
            limits: Limits {
                ceiling_g: 4000,
                ..Limits::default()
            },
            ..first
        };
        let wishes = [
            Action::Arm,
            Action::Trial(TrialAction::Plan(Box::new(plan))),
            Action::Trial(TrialAction::Start(SeriesKind::Grid)),
        ];
        for wish in wishes {
            self.act(wish);
            self.run_for(ARM_TIMEOUT);
        }
        self.until(GRASP_TIMEOUT, |state| state.hand().series.is_none());
    }

    /// The whole window with this view open, as it is now. Time stands still, but for a view that reads from the hand when it is
    /// opened: that is waited for.
    pub fn picture(&mut self, view: View) -> Picture {
        let is_tried = !self.desktop_app.state().trials.sessions.is_empty();
        if view == View::Device || is_tried && matches!(view, View::Tune | View::Compare) {
            self.read_rows();
        }
        let now = self.now();
        self.desktop_app.show(view);
        let _inside = self.runtime.enter();
        let desktop_app = &mut self.desktop_app;
        self.canvas
            .picture(now.secs(), |ui| desktop_app.ui(ui, now))
    }
}
