//! The program's environment: runtime, clock, opening of wires, file dialogs, and background tasks; and the context of an
//! action on one hand.

pub mod day_folder;
pub(crate) mod motion_task;
pub(crate) mod running;

use crate::app::notices::{HandNotices, NoticeKind};
use crate::hand::Moment;
use crate::inputs::pad::device::OpenPads;
use crate::link::{Clock, Wake};
use crate::store::Background;
use crate::transport::Dial;
use futures::future::BoxFuture;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The program's environment.
#[derive(Clone)]
pub struct Env {
    /// Runtime for links, tasks and file access.
    pub runtime: tokio::runtime::Handle,
    pub clock: Clock,
    /// Opens wires.
    pub dial: Arc<dyn Dial>,
    /// Opens gamepads.
    pub pads: OpenPads,
    /// Called when there is something new to show.
    pub wake: Wake,
    /// Asks the user for file paths.
    pub files: Arc<dyn ChooseFile>,
    /// Reveals a file in the system's file manager.
    pub reveal: Reveal,
    /// Path of the settings file; `None` = settings are not stored.
    pub settings_path: Option<PathBuf>,
    /// The user's documents folder, for files saved without asking; `None` = none.
    pub documents: Option<PathBuf>,
    /// Number of task steps that the window missed.
    pub lost_steps: LostSteps,
}

impl Env {
    /// Runtime and wake of background jobs.
    pub(crate) const fn background(&self) -> Background<'_> {
        Background {
            runtime: &self.runtime,
            wake: &self.wake,
        }
    }
}

/// Context of an action on one hand: time, environment, and the sink for notices.
pub(crate) struct Ctx<'a> {
    pub(crate) now: Moment,
    pub(crate) env: &'a Env,
    pub(crate) notices: HandNotices<'a>,
}

impl Ctx<'_> {
    /// Publishes a notice about this hand.
    pub(crate) fn notify(&mut self, what: NoticeKind) {
        self.notices.push(self.now, what);
    }
}

/// Number of task steps that the window did not read in time. Clones share the count.
#[derive(Debug, Clone, Default)]
pub struct LostSteps(Arc<AtomicU64>);

impl LostSteps {
    pub(crate) fn add(&self, count: u64) {
        self.0.fetch_add(count, Ordering::Relaxed);
    }

    /// Returns the count since the last call.
    pub(crate) fn take(&self) -> u64 {
        self.0.swap(0, Ordering::Relaxed)
    }
}

/// Reveals a file in the system's file manager. Called off the window's thread; returns once the start has succeeded or
/// failed.
pub type Reveal = Arc<dyn Fn(&Path) -> io::Result<()> + Send + Sync>;

/// Used where there is no file manager; always fails.
pub fn no_reveal() -> Reveal {
    Arc::new(|_| Err(io::Error::other("there is no file manager")))
}

/// Asks the user for a file path. Called on the window's thread; the result is awaited elsewhere.
pub trait ChooseFile: Send + Sync + 'static {
    /// Resolves to the chosen path; `None` if the user chose none. `suggested` is a file name.
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to an existing file to read; `None` if the user chose none.
    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>>;

    /// Resolves to an existing folder to create another in; `None` if the user chose none.
    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>>;
}

/// Used where there are no dialogs; never chooses a path.
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
