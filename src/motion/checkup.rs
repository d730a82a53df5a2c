//! The surroundings of a check-up: earlier check-ups of the hand, its recording, report and files. The motion itself is in `series`.

use crate::checkup::check::{checks, stopped_early};
use crate::checkup::free_file;
use crate::checkup::kept::{self, StoredCheckup};
use crate::checkup::report::{CheckupReport, JSON_FILE, Keeping, PAGE_FILE, RECORDING_FILE};
use crate::checkup::usage::Usage;
use crate::checkup::{Checkup, Measured};
use crate::hand::grip::FreeForce;
use crate::hand::kinematics::Side;
use crate::link::entries::record;
use crate::link::{Clock, LinkObserver};
use crate::motion::drive::{Driven, stop_words};
use crate::record::file::{Opening, PART_LENGTH, Recorder, RecordingPlan, SystemDisk};
use crate::store::calendar::{since_1970, stamp};
use crate::store::{create_folder, replace};
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tokio_util::task::AbortOnDrop;

/// Locations of the files of a check-up.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CheckupFiles {
    /// Endpoint of the hand.
    pub hand: Endpoint,
    /// File of its earlier check-ups; `None` for the built-in hand, which is a new one each time.
    pub kept: Option<PathBuf>,
    /// File of the forces that its joints read while they touch nothing; `None` as with `kept`.
    pub free_force: Option<PathBuf>,
    /// Folder of its report; `None` if no report is written.
    pub report: Option<PathBuf>,
    /// Folder of recordings, from which the usage is counted.
    pub recordings: Option<PathBuf>,
}

impl CheckupFiles {
    /// File of the earlier check-ups of a hand, in the folder for all hands; `None` for the built-in hand.
    pub fn kept_in(folder: &Path, hand: &Endpoint) -> Option<PathBuf> {
        (!hand.is_sim()).then(|| kept::file_of(folder, hand))
    }

    /// Earlier check-ups, oldest first.
    ///
    /// # Errors
    /// As [`kept::read`].
    pub fn earlier(&self) -> io::Result<Vec<StoredCheckup>> {
        self.kept.as_deref().map_or(Ok(Vec::new()), kept::read)
    }

    /// Earlier check-ups, after ensuring that another one can be stored: the hand must not move for a result that cannot be kept.
    ///
    /// # Errors
    /// As [`kept::read`], or the folder cannot be created.
    pub fn prepare(&self) -> io::Result<Vec<StoredCheckup>> {
        let earlier = self.earlier()?;
        let folder = self.kept.as_deref().and_then(Path::parent);
        folder.map_or(Ok(()), create_folder)?;
        Ok(earlier)
    }

    /// Starts recording the hand, beside the report; `None` if no report is written.
    ///
    /// # Errors
    /// The system's error if it cannot start a thread.
    pub fn record(
        &self,
        observed: LinkObserver,
        clock: Clock,
    ) -> io::Result<Option<CheckupRecording>> {
        let Some(folder) = &self.report else {
            return Ok(None);
        };
        let moments = (clock.now(), since_1970());
        let plan = RecordingPlan {
            path: folder.join(RECORDING_FILE),
            opening: Opening::begin(self.hand.to_string(), moments, Side::default()),
            disk: Arc::new(SystemDisk),
            part_length: PART_LENGTH,
        };
        let recorder = Recorder::start(plan)?;
        let pump = tokio::spawn(record(observed, recorder.input(), clock));
        Ok(Some(CheckupRecording {
            recorder,
            _pump: AbortOnDrop::new(pump.abort_handle()),
        }))
    }

    /// Report of the last stored check-up; `None` if there is none.
    ///
    /// # Errors
    /// As [`kept::read`].
    pub fn last(&self) -> io::Result<Option<(CheckupReport, Option<PathBuf>)>> {
        let mut earlier = self.earlier()?;
        let Some(last) = earlier.pop() else {
            return Ok(None);
        };
        let report = CheckupReport {
            hand: last.hand,
            simulated: self.hand.is_sim(),
            checks: checks(last.figures, &last.at, &earlier),
            at: last.at,
            aborted: None,
            aborted_words: None,
            earlier: earlier.len(),
            left_alone: Vec::new(),
            keeping: Keeping::Kept {
                earlier: earlier.len(),
            },
            usage: self.usage(),
            recorded: false,
        };
        Ok(Some((report, last.report)))
    }

    fn usage(&self) -> Option<Usage> {
        Usage::of(self.recordings.as_deref()?, &self.hand)
    }
}

/// The recording of a running check-up. It ends when this is dropped.
#[derive(Debug)]
pub struct CheckupRecording {
    recorder: Recorder,
    _pump: AbortOnDrop,
}

/// A check-up that has ended.
#[derive(Debug)]
pub struct EndedCheckup {
    /// Its measurements and its outcome.
    pub driven: Driven<Checkup>,
    /// Its recording.
    pub recording: Option<CheckupRecording>,
}

/// The report of a check-up, and the error if its files could not be written.
#[derive(Debug)]
pub struct ConcludedCheckup {
    /// The report.
    pub report: CheckupReport,
    /// Folder of its report, or the error; `None` if no report was requested.
    pub written: Option<io::Result<PathBuf>>,
}

impl CheckupFiles {
    /// Judges an ended check-up, stores it, and writes its report. Blocks on the disk.
    pub fn conclude(&self, ended: EndedCheckup) -> ConcludedCheckup {
        let at = stamp(since_1970());
        let Driven {
            program: checkup,
            end,
            stop,
        } = ended.driven;
        let measured = checkup.measured();
        let why = end.err();
        let recorded = ended.recording.is_some();
        if let Some(recording) = ended.recording {
            let _ended = recording.recorder.end();
        }
        let (earlier, unread) = match self.earlier() {
            Ok(earlier) => (earlier, None),
            Err(error) => (Vec::new(), Some(error)),
        };
        let mut report = CheckupReport {
            hand: self.hand.to_string(),
            simulated: self.hand.is_sim(),
            aborted: why,
            aborted_words: why.map(|why| format!("{why}{}", stop_words(stop))),
            earlier: earlier.len(),
            checks: checks(measured.clone(), &at, &earlier),
            at,
            left_alone: checkup.left_alone(),
            keeping: Keeping::BuiltIn,
            usage: self.usage(),
            recorded,
        };
        report.keeping = match unread {
            Some(error) => Keeping::Failed {
                error: error.to_string(),
            },
            None => self.keep(&report, measured, checkup.free_force()),
        };
        let written = self
            .report
            .as_deref()
            .map(|folder| write(folder, &report).map(|()| folder.to_owned()));
        ConcludedCheckup { report, written }
    }

    /// Stores the free forces. Without them a grip is less certain but not wrong, so a failure is ignored.
    fn keep_free_force(&self, measured: &FreeForce) {
        if let Some(file) = &self.free_force {
            let mut known = free_file::read(file).unwrap_or_default();
            known.merge(measured);
            let _kept = free_file::keep(file, &known);
        }
    }

    fn keep(&self, report: &CheckupReport, figures: Vec<Measured>, free: &FreeForce) -> Keeping {
        if report.aborted.is_some() {
            return Keeping::Partial;
        }
        let Some(file) = &self.kept else {
            return Keeping::BuiltIn;
        };
        let earlier = report.earlier;
        match stopped_early(&report.checks).filter(|_| earlier == 0) {
            Some(dof) => Keeping::NotAsFirst { dof },
            None => {
                self.keep_free_force(free);
                let own = StoredCheckup {
                    at: report.at.clone(),
                    hand: report.hand.clone(),
                    figures,
                    report: self.report.clone(),
                };
                match kept::add(file, own) {
                    Ok(()) => Keeping::Kept { earlier },
                    Err(error) => Keeping::Failed {
                        error: format!("{}: {error}", file.display()),
                    },
                }
            }
        }
    }
}

fn write(folder: &Path, report: &CheckupReport) -> io::Result<()> {
    let page = report.html().map_err(io::Error::other)?;
    replace(&folder.join(PAGE_FILE), page.as_bytes())?;
    replace(
        &folder.join(JSON_FILE),
        format!("{}\n", report.json()).as_bytes(),
    )
}
