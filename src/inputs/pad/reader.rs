//! The thread that searches a folder for gamepads, reads them, and detects disconnection at once.

use crate::inputs::pad::facts::PadFacts;
use crate::inputs::pad::report::{KernelEvent, PadClock, PadId, PadNews, PadReport, PadTrouble};
use crate::transport::permission::remedy;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, Metadata};
use std::io;
use std::os::fd::BorrowedFd;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};
use tokio::sync::mpsc::Sender;

/// Interval at which the folder is searched.
const POLL_INTERVAL: Duration = Duration::from_secs(1);
/// Interval of alive reports, milliseconds.
const ALIVE_EACH_MS: u16 = 50;
/// Longest wait without a gamepad before the thread checks whether to end, milliseconds.
const IDLE_MS: u16 = 250;
/// Gamepads that are read at once: more than a computer is likely to have.
const PADS_MAX: usize = 8;

/// Opens files of the folder.
pub trait OpenPad: Send {
    /// Opens the gamepad of a file; `None` if it is another device.
    ///
    /// # Errors
    /// The system's error.
    fn open(&self, path: &Path) -> io::Result<Option<Box<dyn PadDevice>>>;
}

/// An open gamepad.
pub trait PadDevice: Send {
    /// Its properties.
    fn facts(&self) -> &PadFacts;
    /// File descriptor that becomes readable when events are available.
    fn fd(&self) -> BorrowedFd<'_>;
    /// Present state of its controls.
    ///
    /// # Errors
    /// The system's error.
    fn now(&mut self) -> io::Result<Vec<KernelEvent>>;
    /// Events since the last call. Does not wait.
    ///
    /// # Errors
    /// The system's error; any error means that it was disconnected.
    fn read(&mut self) -> io::Result<Vec<DeviceSays>>;
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DeviceSays {
    /// A control moved.
    Event(KernelEvent),
    /// End of a group of events.
    Whole,
    /// The kernel dropped events. Events until [`Self::Whole`] are unreliable.
    Dropped,
}

/// Identifies the device behind a file: device numbers are reused.
type DeviceFileId = (u64, i64, i64);

struct OpenedPad {
    id: PadId,
    device: Box<dyn PadDevice>,
    /// Events were dropped, and the end of their group has not arrived yet.
    is_behind: bool,
}

struct PadThread {
    folder: PathBuf,
    clock: PadClock,
    opener: Box<dyn OpenPad>,
    to: Sender<PadReport>,
    pads: BTreeMap<PathBuf, OpenedPad>,
    /// Devices of other kinds, remembered so that they are not reopened.
    others: BTreeMap<PathBuf, DeviceFileId>,
    trouble: Option<PadTrouble>,
    next: u64,
}

/// The receiver of the reports was dropped.
struct NobodyListens;

/// Starts the thread.
pub(crate) fn spawn(
    folder: PathBuf,
    clock: PadClock,
    opener: Box<dyn OpenPad>,
    to: Sender<PadReport>,
) -> Result<(), PadTrouble> {
    let thread = PadThread {
        folder,
        clock,
        opener,
        to,
        pads: BTreeMap::new(),
        others: BTreeMap::new(),
        trouble: None,
        next: 0,
    };
    let named = thread::Builder::new().name("gamepads".into());
    let started = named.spawn(move || {
        // Ends silently when the receiver is dropped.
        let _ended = thread.run();
    });
    started
        .map(drop)
        .map_err(|error| PadTrouble::NoThread(error.into()))
}

/// Lists the connected gamepads.
pub(crate) fn find(folder: &Path, opener: &dyn OpenPad) -> Result<Vec<PadFacts>, PadTrouble> {
    let mut refused = BTreeSet::new();
    let mut found = Vec::new();
    for path in event_files(folder)? {
        match opener.open(&path) {
            Ok(Some(pad)) => found.push(pad.facts().clone()),
            Ok(None) => {}
            Err(error) => note_refused(&mut refused, &path, &error),
        }
    }
    match may_not_open(&refused) {
        Some(trouble) if found.is_empty() => Err(trouble),
        _ => Ok(found),
    }
}

impl PadThread {
    fn run(mut self) -> Result<(), NobodyListens> {
        let mut scanned: Option<Instant> = None;
        let mut alive_at = Instant::now();
        while !self.to.is_closed() {
            if scanned.is_none_or(|at| at.elapsed() >= POLL_INTERVAL) {
                scanned = Some(Instant::now());
                self.scan()?;
            }
            for path in self.wait() {
                self.read(&path)?;
            }
            if alive_at.elapsed() >= Duration::from_millis(ALIVE_EACH_MS.into()) {
                alive_at = Instant::now();
                let all: Vec<PadId> = self.pads.values().map(|pad| pad.id).collect();
                for pad in all {
                    self.send(PadNews::Alive(pad))?;
                }
            }
        }
        Ok(())
    }

    /// Opens new gamepads, and reports the reason if there is none.
    fn scan(&mut self) -> Result<(), NobodyListens> {
        let files = match event_files(&self.folder) {
            Ok(files) => files,
            Err(trouble) => return self.report(Some(trouble)),
        };
        self.others.retain(|path, _| files.contains(path));
        let mut refused = BTreeSet::new();
        for path in files {
            let Ok(mark) = fs::metadata(&path).map(|about| mark(&about)) else {
                continue;
            };
            let is_known = self.pads.contains_key(&path) || self.others.get(&path) == Some(&mark);
            if is_known || self.pads.len() >= PADS_MAX {
                continue;
            }
            match self.opener.open(&path) {
                Ok(Some(device)) => self.begin(path, device)?,
                Ok(None) => drop(self.others.insert(path, mark)),
                Err(error) => note_refused(&mut refused, &path, &error),
            }
        }
        let trouble = may_not_open(&refused).filter(|_| self.pads.is_empty());
        self.report(trouble)
    }

    fn begin(
        &mut self,
        path: PathBuf,
        mut device: Box<dyn PadDevice>,
    ) -> Result<(), NobodyListens> {
        // Disconnected already: the next search tries again.
        let Ok(now) = device.now() else { return Ok(()) };
        let id = PadId(self.next);
        self.next += 1;
        let news = PadNews::Found {
            pad: id,
            facts: device.facts().clone(),
            now,
        };
        let pad = OpenedPad {
            id,
            device,
            is_behind: false,
        };
        self.pads.insert(path, pad);
        self.send(news)
    }

    /// Waits, for a limited time, for gamepads with events.
    fn wait(&self) -> Vec<PathBuf> {
        let wanted = self.pads.values();
        let mut fds: Vec<PollFd<'_>> = wanted
            .map(|pad| PollFd::new(pad.device.fd(), PollFlags::POLLIN))
            .collect();
        let limit = if fds.is_empty() {
            IDLE_MS
        } else {
            ALIVE_EACH_MS
        };
        if poll(&mut fds, PollTimeout::from(limit)).is_err() {
            // A signal interrupted it; the next call returns the events.
            return Vec::new();
        }
        let ready = self.pads.keys().zip(&fds);
        // An error or a hang-up also shows on reading.
        let ready = ready.filter(|(_, fd)| fd.any() != Some(false));
        ready.map(|(path, _)| path.clone()).collect()
    }

    fn read(&mut self, path: &Path) -> Result<(), NobodyListens> {
        let Some(pad) = self.pads.get_mut(path) else {
            return Ok(());
        };
        match pad.news() {
            Ok(news) => news.into_iter().try_for_each(|news| self.send(news)),
            Err(_gone) => {
                let gone = PadNews::Gone(pad.id);
                self.pads.remove(path);
                self.send(gone)
            }
        }
    }

    /// Reports a problem if it is new.
    fn report(&mut self, trouble: Option<PadTrouble>) -> Result<(), NobodyListens> {
        if self.trouble == trouble {
            return Ok(());
        }
        self.trouble.clone_from(&trouble);
        trouble.map_or(Ok(()), |trouble| self.send(PadNews::Trouble(trouble)))
    }

    /// Blocks while the queue is full: the kernel reports that it dropped events meanwhile.
    fn send(&self, news: PadNews) -> Result<(), NobodyListens> {
        let at = (self.clock)();
        let sent = self.to.blocking_send(PadReport { at, news });
        sent.map_err(|_unsent| NobodyListens)
    }
}

impl OpenedPad {
    fn news(&mut self) -> io::Result<Vec<PadNews>> {
        let mut news = Vec::new();
        for message in self.device.read()? {
            match message {
                DeviceSays::Event(event) => {
                    let pad = self.id;
                    news.push(if self.is_behind {
                        PadNews::Doubtful { pad, event }
                    } else {
                        PadNews::Moved { pad, event }
                    });
                }
                DeviceSays::Dropped => {
                    self.is_behind = true;
                    // Held controls do not count from here on, even if the rest never arrives.
                    news.push(self.lost()?);
                }
                DeviceSays::Whole if self.is_behind => {
                    self.is_behind = false;
                    news.push(self.lost()?);
                }
                DeviceSays::Whole => {}
            }
        }
        Ok(news)
    }

    fn lost(&mut self) -> io::Result<PadNews> {
        let now = self.device.now()?;
        Ok(PadNews::Lost { pad: self.id, now })
    }
}

/// The event devices of the folder, sorted.
fn event_files(folder: &Path) -> Result<BTreeSet<PathBuf>, PadTrouble> {
    let trouble = |error: io::Error| PadTrouble::NoFolder {
        folder: folder.to_owned(),
        why: error.into(),
    };
    let mut files = BTreeSet::new();
    for entry in fs::read_dir(folder).map_err(trouble)? {
        let entry = entry.map_err(trouble)?;
        let name = entry.file_name();
        if name.to_str().is_some_and(|name| name.starts_with("event")) {
            files.insert(entry.path());
        }
    }
    Ok(files)
}

fn mark(about: &Metadata) -> DeviceFileId {
    (about.ino(), about.ctime(), about.ctime_nsec())
}

/// Records a device that the user may not open. Other errors come from devices that are being disconnected.
fn note_refused(refused: &mut BTreeSet<PathBuf>, path: &Path, error: &io::Error) {
    if error.kind() == io::ErrorKind::PermissionDenied {
        refused.insert(path.to_owned());
    }
}

fn may_not_open(refused: &BTreeSet<PathBuf>) -> Option<PadTrouble> {
    let first = refused.first()?;
    Some(PadTrouble::MayNotOpen {
        path: first.clone(),
        count: refused.len(),
        remedy: remedy(&first.to_string_lossy()),
    })
}
