//! A whole session in a format of others, written off the window's thread into the folder of the day.

use crate::app::env::{Env, day_folder};
use crate::app::notices::NoticeKind;
use crate::record::export::lerobot::{EpisodeStart, LeRobotPlan};
use crate::record::export::{Destination, ExportError, Source, csv, cut, lerobot, parquet, rosbag};
use crate::record::file::SessionFile;
use crate::record::file::reader::Stretch;
use crate::store::{BackgroundJob, calendar, on_thread};
use std::io;
use std::path::{Path, PathBuf};

/// Frames a second of a data set, as cameras have it.
const FPS: u32 = 30;

/// A format of others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionForm {
    /// A table as text.
    Csv,
    /// A table.
    Parquet,
    /// A folder for ROS 2.
    Rosbag,
    /// A folder for learners, without video.
    LeRobot,
    /// A session file again, whole and with its own index.
    Mcap,
}

impl SessionForm {
    pub const ALL: [Self; 5] = [
        Self::Csv,
        Self::Parquet,
        Self::Rosbag,
        Self::LeRobot,
        Self::Mcap,
    ];

    /// What stands behind the session's name.
    const fn ending(self) -> &'static str {
        match self {
            Self::Csv => ".csv",
            Self::Parquet => ".parquet",
            Self::Rosbag => "-rosbag2",
            Self::LeRobot => "-lerobot",
            Self::Mcap => "-copy.mcap",
        }
    }

    /// Writes it; how many rows, messages or frames are in it.
    fn write(self, file: &SessionFile, to: &Path) -> Result<u64, ExportError> {
        let whole = Stretch {
            from: file.first(),
            to: file.last(),
            wire: self == Self::Mcap,
        };
        let (source, place) = (Source::new(file, whole), Destination::from(to));
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

/// Writes a session; what to tell a person of it.
pub(crate) fn export(path: PathBuf, form: SessionForm, env: &Env) -> BackgroundJob<NoticeKind> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("{stem}{}", form.ending());
    let folder = env.documents.as_ref().map(|documents| {
        let day = calendar::day(calendar::since_1970());
        day_folder::of_day(documents, &day)
    });
    let files = std::sync::Arc::clone(&env.files);
    BackgroundJob::start(&env.runtime, &env.wake, async move {
        let to = match folder {
            Some(folder) => day_folder::free_path(&folder, &name),
            None => match files.choose(&name).await {
                Some(to) => to,
                None => return NoticeKind::NoFileChosen,
            },
        };
        let place = to.clone();
        let write = move || {
            if let Some(folder) = place.parent() {
                std::fs::create_dir_all(folder)?;
            }
            let file = SessionFile::open(&path).map_err(io::Error::other)?;
            form.write(&file, &place).map_err(io::Error::other)
        };
        match on_thread(write).await {
            Ok(rows) => NoticeKind::Saved {
                path: to,
                entries: usize::try_from(rows).unwrap_or(usize::MAX),
            },
            Err(error) => NoticeKind::not_saved(to, &error),
        }
    })
}
