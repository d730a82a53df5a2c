//! A recording, or a stretch of it, in a format of others: written off the window's thread into the folder of the day.

use crate::app::env::{Env, day_folder};
use crate::app::notices::NoticeKind;
use crate::hand::Moment;
use crate::record::export::lerobot::{EpisodeStart, LeRobotPlan};
use crate::record::export::{Destination, ExportError, Source, csv, cut, lerobot, parquet, rosbag};
use crate::record::file::RecordingFile;
use crate::record::file::reader::Stretch;
use crate::store::{BackgroundJob, calendar, on_thread};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Frames a second of a data set, as cameras have it.
const FPS: u32 = 30;

/// A format of others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecordingForm {
    /// A table as text.
    Csv,
    /// A table.
    Parquet,
    /// A folder for ROS 2.
    Rosbag,
    /// A folder for learners, without video.
    LeRobot,
    /// A recording file again, whole and with its own index.
    Mcap,
}

impl RecordingForm {
    pub const ALL: [Self; 5] = [
        Self::Csv,
        Self::Parquet,
        Self::Rosbag,
        Self::LeRobot,
        Self::Mcap,
    ];

    /// What stands behind the recording's name.
    const fn ending(self) -> &'static str {
        match self {
            Self::Csv => ".csv",
            Self::Parquet => ".parquet",
            Self::Rosbag => "-rosbag2",
            Self::LeRobot => "-lerobot",
            Self::Mcap => "-copy.mcap",
        }
    }

    /// Writes what is wanted of a recording; how many rows, messages or frames are in it.
    fn write(self, source: Source<'_>, to: &Path) -> Result<u64, ExportError> {
        let place = Destination::from(to);
        let written = match self {
            Self::Csv => csv::write(source, &place),
            Self::Parquet => parquet::write(source, &place),
            Self::Rosbag => rosbag::write(source, to),
            Self::Mcap => cut::write(source, &place),
            Self::LeRobot => {
                let plan = LeRobotPlan {
                    fps: FPS,
                    task: None,
                    episodes: EpisodeStart::Gap,
                };
                return Ok(lerobot::write(&[source], to, &plan)?.frames());
            }
        };
        Ok(written?.rows)
    }
}

/// What is to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordingExport {
    /// The recording.
    pub path: PathBuf,
    pub form: RecordingForm,
    /// From and to; `None` = all of it.
    pub stretch: Option<(Moment, Moment)>,
}

/// How far an export is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportProgress {
    pub export: RecordingExport,
    /// Of all that is to be read.
    pub percent: u8,
}

/// An export under way.
pub(crate) struct RunningExport {
    export: RecordingExport,
    percent: Arc<AtomicU8>,
    /// What to tell the user once it is done.
    pub(crate) job: Option<BackgroundJob<NoticeKind>>,
}

impl RunningExport {
    pub(crate) fn progress(&self) -> ExportProgress {
        ExportProgress {
            export: self.export.clone(),
            percent: self.percent.load(Ordering::Relaxed),
        }
    }
}

impl RecordingExport {
    /// What it is called: after the recording.
    fn file_name(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let part = if self.stretch.is_some() { "-part" } else { "" };
        format!("{stem}{part}{}", self.form.ending())
    }

    /// Writes it; what to tell the user of it.
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
        let stretch = Stretch {
            from,
            to: until,
            wire: self.form == RecordingForm::Mcap,
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
        let source = Source {
            watch: &watch,
            ..Source::new(&file, stretch)
        };
        match self.form.write(source, &to) {
            Ok(rows) => NoticeKind::Saved {
                path: to,
                entries: usize::try_from(rows).unwrap_or(usize::MAX),
            },
            Err(error) => NoticeKind::NotExported { path, error },
        }
    }

    /// Begins it.
    pub(crate) fn begin(self, env: &Env) -> RunningExport {
        let name = self.file_name();
        let folder = env.documents.as_ref().map(|documents| {
            let day = calendar::day(calendar::since_1970());
            day_folder::of_day(documents, &day)
        });
        let files = Arc::clone(&env.files);
        let percent = Arc::new(AtomicU8::new(0));
        let (export, progress) = (self.clone(), Arc::clone(&percent));
        let job = BackgroundJob::start(&env.runtime, &env.wake, async move {
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
        });
        RunningExport {
            export: self,
            percent,
            job: Some(job),
        }
    }
}
