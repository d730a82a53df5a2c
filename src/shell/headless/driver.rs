//! The whole program without a window: advances time and takes pictures. A built-in hand runs in virtual time, so that seconds
//! take milliseconds and two runs give equal bytes. Leaves no file behind.

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

/// Interval of polling the link, like the window's frames at 50 Hz.
pub const STEP: Duration = Duration::from_millis(20);
/// Upper limit for arming.
const ARM_TIMEOUT: Duration = Duration::from_millis(400);
/// Upper limit for a small grid of grasps.
const GRASP_TIMEOUT: Duration = Duration::from_secs(300);
/// Upper limit for opening and seeking in a long recording on a slow disk.
const REPLAY_TIMEOUT: Duration = Duration::from_secs(60);
/// Upper limit for an answer of a hand; most answer much faster.
pub const ANSWER_TIMEOUT: Duration = Duration::from_secs(3);

/// Options of the pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    pub endpoint: Endpoint,
    /// Width and height in points.
    pub size: (u32, u32),
    /// Pixels per point.
    pub scale: f32,
    pub theme: Theme,
    /// Language of the window.
    pub language: Language,
}

/// Reason why there is nothing to show.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DriveError {
    /// The runtime could not be created.
    #[error("the program cannot start its runtime: {cause}")]
    Runtime {
        /// The system's error text.
        cause: String,
    },
    /// The folder for backups could not be created.
    #[error("the program cannot make a folder for backups: {cause}")]
    NoFolder {
        /// The system's error text.
        cause: String,
    },
    /// The link reports why the hand does not answer.
    #[error("no hand at {endpoint}: {trouble}")]
    NoHand {
        /// Endpoint of the hand.
        endpoint: Endpoint,
        /// Trouble reported by the link.
        trouble: Box<LinkTrouble>,
    },
    /// A recording could not be opened, or not in time.
    #[error("{} was not opened within {within_s} s", path.display())]
    NotReplayed {
        path: PathBuf,
        /// Time limit in seconds.
        within_s: u64,
    },
    /// The hand sent nothing in time.
    #[error(
        "no hand at {endpoint}: nothing came within {after_s} s; check power, cable, address and id"
    )]
    Unanswered {
        /// Endpoint of the hand.
        endpoint: Endpoint,
        /// Time limit in seconds.
        after_s: u64,
    },
}

/// A running program and the screen it is drawn on.
pub struct Driver {
    // Dropped first, because its link lives on the runtime.
    desktop_app: DesktopApp,
    canvas: Canvas,
    clock: Clock,
    endpoint: Endpoint,
    runtime: Runtime,
    /// Temporary settings folder, removed with the driver.
    _kept: Option<TempDir>,
}

impl Driver {
    /// Starts the program and begins to connect. Writes nothing to the hand, and neither reads nor saves settings.
    ///
    /// # Errors
    /// [`DriveError::Runtime`].
    pub fn start(scene: &Scene) -> Result<Self, DriveError> {
        Self::begin(scene, scene.endpoint.clone(), None)
    }

    /// Starts as [`Driver::start`] with a built-in hand on this line, and with a folder for backups, which is removed at the end.
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

    /// Renders a first frame, which installs fonts and style, and then disables animation.
    pub(crate) fn hold_still(&mut self) {
        let now = self.now();
        let desktop_app = &mut self.desktop_app;
        self.canvas.frame(now.secs(), |ui| desktop_app.ui(ui, now));
        self.canvas.hold_still();
    }

    /// Sets theme and language.
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

    /// Advances time by one [`STEP`], or by `left` if that is less.
    pub(crate) fn step(&mut self, left: Duration) {
        // A timer can be created only inside the runtime.
        self.runtime
            .block_on(async { tokio::time::sleep(left.min(STEP)).await });
        let now = self.now();
        let _inside = self.runtime.enter();
        self.desktop_app.logic(now);
        // Counts as drawn between two pictures.
        self.desktop_app.app().drawn(now);
    }

    /// Advances time until the hand answers.
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
                    trouble: Box::new(trouble),
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

    /// Advances time by `time` in steps.
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

    /// Performs an action of the user.
    pub fn act(&mut self, action: Action) {
        let now = self.now();
        let _inside = self.runtime.enter();
        self.desktop_app.app().act(action, now);
    }

    /// Advances time until the condition holds, by `within` at most.
    pub(crate) fn until(&mut self, within: Duration, so: impl Fn(&State) -> bool) {
        let begun = self.now();
        while !so(self.desktop_app.state()) && self.now().since(begun) < within {
            self.step(STEP);
        }
    }

    /// Replays a recording: shows its hand at the end of a time range, and exactly that range in the plots.
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
        // The plots start over with a hand that they see for the first time.
        self.hold_still();
        self.desktop_app.show_stretch((from, to));
        Ok(())
    }

    /// Reads the hand's stored parameters if due, and waits for them.
    pub(crate) fn read_rows(&mut self) {
        let now = self.now();
        if !self.desktop_app.state().hand().params.is_due(now) {
            return;
        }
        self.act(Action::Param(ParamAction::Read));
        self.until(ANSWER_TIMEOUT, |state| !state.hand().params.is_busy());
    }

    /// Runs a small grid of grasps on a built-in hand to its end: real trials, in virtual time.
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
        self.until(GRASP_TIMEOUT, |state| {
            state.hand().running.series().is_none()
        });
    }

    /// The whole window with this view open, in its current state. Time does not advance, except to wait for a view that reads
    /// from the hand when it is opened.
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
