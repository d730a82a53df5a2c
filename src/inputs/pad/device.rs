//! The gamepads of this computer: detection and input, from a thread of its own. Linux only; elsewhere it reports so.

#[cfg(target_os = "linux")]
use crate::inputs::pad::evdev::SystemPads;
use crate::inputs::pad::facts::PadFacts;
#[cfg(target_os = "linux")]
use crate::inputs::pad::reader;
#[cfg(not(target_os = "linux"))]
use crate::inputs::pad::report::PadNews;
use crate::inputs::pad::report::{PadClock, PadReport, PadTrouble};
use std::path::PathBuf;
use std::sync::Arc;
use tokio::sync::mpsc::{Receiver, channel};

/// Folder of Linux's input devices.
pub const FOLDER: &str = "/dev/input";
/// Capacity of the report queue. While it is full the thread waits, and the kernel reports that it dropped events meanwhile.
pub(crate) const REPORTS_MAX: usize = 256;

/// Reads gamepads until dropped.
#[derive(Debug)]
pub struct PadReader {
    reports: Receiver<PadReport>,
}

/// Function that starts a reader whose reports are stamped with this clock.
pub type OpenPads = Arc<dyn Fn(PadClock) -> Result<PadReader, PadTrouble> + Send + Sync>;

/// Reads the gamepads of this computer.
pub fn system_pads() -> OpenPads {
    Arc::new(|clock| PadReader::start(PathBuf::from(FOLDER), clock))
}

impl PadReader {
    /// Wraps reports from another reader.
    pub const fn of(reports: Receiver<PadReport>) -> Self {
        Self { reports }
    }

    /// Searches a folder for gamepads and reads them.
    ///
    /// # Errors
    /// [`PadTrouble::NoThread`] if the system gives no thread.
    #[cfg(target_os = "linux")]
    pub fn start(folder: PathBuf, clock: PadClock) -> Result<Self, PadTrouble> {
        Self::with(folder, clock, Box::new(SystemPads))
    }

    /// Like [`Self::start`], with a custom opener of devices.
    ///
    /// # Errors
    /// [`PadTrouble::NoThread`] if the system gives no thread.
    #[cfg(target_os = "linux")]
    pub fn with(
        folder: PathBuf,
        clock: PadClock,
        opener: Box<dyn reader::OpenPad>,
    ) -> Result<Self, PadTrouble> {
        let (to, reports) = channel(REPORTS_MAX);
        reader::spawn(folder, clock, opener, to)?;
        Ok(Self { reports })
    }

    /// Reports that gamepads are not supported.
    ///
    /// # Errors
    /// None here.
    #[cfg(not(target_os = "linux"))]
    pub fn start(_folder: PathBuf, clock: PadClock) -> Result<Self, PadTrouble> {
        let (to, reports) = channel(REPORTS_MAX);
        let news = PadNews::Trouble(PadTrouble::LinuxOnly);
        // There is room for the first report.
        let _sent = to.try_send(PadReport { at: clock(), news });
        Ok(Self { reports })
    }

    /// Waits for the next report; `None` once the thread has ended.
    pub async fn report(&mut self) -> Option<PadReport> {
        self.reports.recv().await
    }

    /// Returns a report that is already queued.
    pub fn try_report(&mut self) -> Option<PadReport> {
        self.reports.try_recv().ok()
    }
}

/// Lists the connected gamepads.
///
/// # Errors
/// [`PadTrouble`] if none was found and a device or the folder could not be opened.
#[cfg(target_os = "linux")]
pub fn find(folder: &std::path::Path) -> Result<Vec<PadFacts>, PadTrouble> {
    reader::find(folder, &SystemPads)
}

/// Reports that gamepads are not supported.
///
/// # Errors
/// Always [`PadTrouble::LinuxOnly`].
#[cfg(not(target_os = "linux"))]
pub fn find(_folder: &std::path::Path) -> Result<Vec<PadFacts>, PadTrouble> {
    Err(PadTrouble::LinuxOnly)
}
