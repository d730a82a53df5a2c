//! The gamepads of this computer: which are there, and what they do, from a thread of its own. Linux only; elsewhere it says so.

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

/// Where Linux keeps its input devices.
pub const FOLDER: &str = "/dev/input";
/// Reports that wait to be taken. While it is full the thread waits, and the kernel says how much it dropped meanwhile.
pub(crate) const REPORTS_MAX: usize = 256;

/// Gamepads that are being read. Ends when it is dropped.
#[derive(Debug)]
pub struct PadReader {
    reports: Receiver<PadReport>,
}

/// How gamepads are read, with the time that their reports bear.
pub type OpenPads = Arc<dyn Fn(PadClock) -> Result<PadReader, PadTrouble> + Send + Sync>;

/// The gamepads of this computer.
pub fn system_pads() -> OpenPads {
    Arc::new(|clock| PadReader::start(PathBuf::from(FOLDER), clock))
}

impl PadReader {
    /// Of gamepads that something else reads.
    pub const fn of(reports: Receiver<PadReport>) -> Self {
        Self { reports }
    }

    /// Looks for gamepads in a folder and reads them.
    ///
    /// # Errors
    /// [`PadTrouble::NoThread`] if the system gives no thread.
    #[cfg(target_os = "linux")]
    pub fn start(folder: PathBuf, clock: PadClock) -> Result<Self, PadTrouble> {
        Self::with(folder, clock, Box::new(SystemPads))
    }

    /// The same with devices that something else opens.
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

    /// Says that there is none to read.
    ///
    /// # Errors
    /// None here.
    #[cfg(not(target_os = "linux"))]
    pub fn start(_folder: PathBuf, clock: PadClock) -> Result<Self, PadTrouble> {
        let (to, reports) = channel(REPORTS_MAX);
        let news = PadNews::Trouble(PadTrouble::LinuxOnly);
        // There is room for the first report.
        let _told = to.try_send(PadReport { at: clock(), news });
        Ok(Self { reports })
    }

    /// The next report; `None` once the thread has ended.
    pub async fn report(&mut self) -> Option<PadReport> {
        self.reports.recv().await
    }

    /// A report that is there already.
    pub fn try_report(&mut self) -> Option<PadReport> {
        self.reports.try_recv().ok()
    }
}

/// The gamepads that are there now.
///
/// # Errors
/// [`PadTrouble`] if none was found and something was in the way.
#[cfg(target_os = "linux")]
pub fn find(folder: &std::path::Path) -> Result<Vec<PadFacts>, PadTrouble> {
    reader::find(folder, &SystemPads)
}

/// Says that there is none to find.
///
/// # Errors
/// Always [`PadTrouble::LinuxOnly`].
#[cfg(not(target_os = "linux"))]
pub fn find(_folder: &std::path::Path) -> Result<Vec<PadFacts>, PadTrouble> {
    Err(PadTrouble::LinuxOnly)
}
