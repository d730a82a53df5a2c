//! What the program stands on: its runtime and clock, how wires are opened, how files are asked for, and tasks beside the window.

pub mod day_folder;
pub(crate) mod running;

use crate::inputs::pad::device::OpenPads;
use crate::link::{Clock, Wake};
use crate::transport::Dial;
use futures::future::BoxFuture;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What the program stands on.
#[derive(Clone)]
pub struct Env {
    /// Where links live, tasks run and files are written.
    pub runtime: tokio::runtime::Handle,
    /// The program's clock.
    pub clock: Clock,
    /// How wires are opened.
    pub dial: Arc<dyn Dial>,
    /// How gamepads are read.
    pub pads: OpenPads,
    /// Called when something new is there.
    pub wake: Wake,
    /// How the user is asked where a file should go.
    pub files: Arc<dyn ChooseFile>,
    /// How a file is shown in the system's file manager.
    pub reveal: Reveal,
    /// Where settings are kept; `None` = nowhere.
    pub settings_path: Option<PathBuf>,
    /// The user's documents: what nobody was asked about goes into a folder of the day in them; `None` = nowhere.
    pub documents: Option<PathBuf>,
    /// What the window did not look at in time.
    pub lost_steps: LostSteps,
}

/// Steps of tasks that the window did not look at in time. Copies are the same count.
#[derive(Debug, Clone, Default)]
pub struct LostSteps(Arc<AtomicU64>);

impl LostSteps {
    pub(crate) fn add(&self, count: u64) {
        self.0.fetch_add(count, Ordering::Relaxed);
    }

    /// How many since the last call.
    pub(crate) fn take(&self) -> u64 {
        self.0.swap(0, Ordering::Relaxed)
    }
}

/// Shows a file in the system's file manager. Called off the window's thread; comes back once it is known whether that began.
pub type Reveal = Arc<dyn Fn(&Path) -> io::Result<()> + Send + Sync>;

/// Where there is no file manager: says so.
pub fn no_reveal() -> Reveal {
    Arc::new(|_| Err(io::Error::other("there is no file manager")))
}

/// Asks the user where a file should go. Called on the window's thread; what it gives is awaited elsewhere.
pub trait ChooseFile: Send + Sync + 'static {
    /// Resolves to the chosen place; `None` if there was no choice. `suggested` is a file name.
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to a file that is there, to be read; `None` if there was no choice.
    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to a folder that is there, to put another into; `None` if there was no choice.
    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>>;
}

/// Where nobody can be asked: nothing is ever chosen.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoChoice;

impl ChooseFile for NoChoice {
    fn choose(&self, _suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }

    fn open(&self, _suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }

    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>> {
        Box::pin(std::future::ready(None))
    }
}
