//! Exports a recording, or a time range of it, to another format, in the background, into the day's folder.

use crate::app::env::{Env, day_folder};
use crate::app::notices::NoticeKind;
use crate::hand::Moment;
use crate::record::export::{Destination, ExportFormat, ExportOptions, ExportSource, LeRobotPlan};
use crate::record::file::RecordingFile;
use crate::record::file::reader::TimeRange;
use crate::store::{calendar, on_thread};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// A requested export.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordingExport {
    pub path: PathBuf,
    pub format: ExportFormat,
    /// Start and end of the time range; `None` = the whole recording.
    pub stretch: Option<(Moment, Moment)>,
    /// True if a data set in which no joint was commanded is written nevertheless.
    pub uncommanded: bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportProgress {
    pub export: RecordingExport,
    /// Share of the source read so far, 0 to 100.
    pub percent: u8,
}

/// An export in progress.
pub(crate) struct RunningExport {
    /// Number of the export in this run of the program.
    pub(crate) number: u64,
    export: RecordingExport,
    percent: Arc<AtomicU8>,
}

impl RunningExport {
    pub(crate) fn new(number: u64, export: RecordingExport) -> Self {
        Self {
            number,
            export,
            percent: Arc::default(),
        }
    }

    pub(crate) fn progress(&self) -> ExportProgress {
        ExportProgress {
            export: self.export.clone(),
            percent: self.percent.load(Ordering::Relaxed),
        }
    }

    /// Exports off the window's thread; yields the notice for the user.
    pub(crate) fn work(&self, env: &Env) -> impl Future<Output = NoticeKind> + Send + use<> {
        let (export, progress) = (self.export.clone(), Arc::clone(&self.percent));
        let name = export.file_name();
        let folder = env.documents.as_ref().map(|documents| {
            let day = calendar::day(calendar::since_1970());
            day_folder::of_day(documents, &day)
        });
        let files = Arc::clone(&env.files);
        async move {
            let to = match folder {
                Some(folder) => day_folder::free_path(&folder, &name),
                None => match files.choose(&name).await {
                    Some(to) => to,
                    None => return NoticeKind::NoFileChosen,
                },
            };
            let place = to.clone();
            let written = on_thread(move || Ok(export.write(place, &progress))).await;
            written.unwrap_or_else(|error| NoticeKind::not_saved(to, &error))
        }
    }
}

impl RecordingExport {
    /// File name of the export, derived from the recording's.
    fn file_name(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let part = if self.stretch.is_some() { "-part" } else { "" };
        let copy = if self.format == ExportFormat::Mcap {
            "-copy"
        } else {
            ""
        };
        let ending = self.format.properties().ending;
        format!("{stem}{part}{copy}{ending}")
    }

    /// Writes the export and returns the notice for the user.
    fn write(&self, to: PathBuf, percent: &AtomicU8) -> NoticeKind {
        let made = to.parent().map(std::fs::create_dir_all);
        if let Some(Err(error)) = made {
            return NoticeKind::not_saved(to, &error);
        }
        let path = self.path.clone();
        let file = match RecordingFile::open(&path) {
            Ok(file) => file,
            Err(why) => return NoticeKind::RecordingRefused { path, why },
        };
        let (from, until) = self.stretch.unwrap_or((file.first(), file.last()));
        let stretch = TimeRange {
            from,
            to: until,
            wire: self.format == ExportFormat::Mcap,
        };
        let watch = |share: f64| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a share is 0 to 1"
            )]
            percent.store((share * 100.0) as u8, Ordering::Relaxed);
            ControlFlow::Continue(())
        };
        let source = ExportSource {
            watch: &watch,
            ..ExportSource::new(&file, stretch)
        };
        let place = Destination::Path(to.clone());
        let options = ExportOptions {
            lerobot: LeRobotPlan {
                uncommanded: self.uncommanded,
                ..LeRobotPlan::default()
            },
        };
        let written = self.format.write(&[source], &place, &options);
        match written {
            Ok(written) => NoticeKind::Saved {
                path: to,
                entries: usize::try_from(written.rows()).unwrap_or(usize::MAX),
            },
            Err(error) => NoticeKind::NotExported { path, error },
        }
    }
}
