//! Exports of recordings: tables, a rosbag2 folder, a data set for machine learning, a cut copy. Each reads the recording as a
//! stream, writes beside its destination, and is renamed only when complete. A new format is a file with its writer, and its
//! variant, properties and writer here; the window and the command line list what they find here.

pub(crate) mod arrow_schema;
pub(crate) mod columns;
pub(crate) mod csv;
pub mod cut;
pub(crate) mod frames;
pub(crate) mod lerobot;
pub mod output;
pub(crate) mod parquet;
pub(crate) mod rosbag;
pub mod source;
pub(crate) mod statistics;
pub(crate) mod targets;
pub(crate) mod unfollowed;

pub use crate::record::export::lerobot::{EpisodeStart, LeRobotPlan};
pub use crate::record::export::output::{
    Destination, EpisodeCounts, ExportError, ExportSummary, Exported,
};
pub use crate::record::export::source::ExportSource;

use crate::record::export::output::Folder;
use std::collections::BTreeSet;
use std::path::Path;

/// Export format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantArray)]
pub enum ExportFormat {
    /// Text table.
    Csv,
    /// Parquet table.
    Parquet,
    /// Folder for ROS 2.
    Rosbag,
    /// LeRobot data set folder, without video.
    LeRobot,
    /// Recording file, complete with its own index.
    Mcap,
}

/// Properties of a format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormatProperties {
    /// One word; the command line's flag.
    pub name: &'static str,
    /// The command line's help.
    pub description: &'static str,
    /// Suffix of a file's or folder's name.
    pub ending: &'static str,
    /// Unit of the number of rows.
    pub unit: &'static str,
    pub kind: OutputKind,
}

/// Kind of an export's output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutputKind {
    Text,
    Binary,
    Folder,
}

/// Options; each format reads its own.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ExportOptions {
    pub lerobot: LeRobotPlan,
}

/// Writer of one recording.
type WriteOne = fn(ExportSource<'_>, &Destination) -> Result<Exported, ExportError>;

impl ExportFormat {
    /// All formats, in the order of the window.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    pub const fn properties(self) -> FormatProperties {
        match self {
            Self::Csv => FormatProperties {
                name: "csv",
                description: "Comma-separated values, one line for each moment of receipt",
                ending: ".csv",
                unit: "lines",
                kind: OutputKind::Text,
            },
            Self::Parquet => FormatProperties {
                name: "parquet",
                description: "A Parquet table, one row for each reading",
                ending: ".parquet",
                unit: "rows",
                kind: OutputKind::Binary,
            },
            Self::Rosbag => FormatProperties {
                name: "rosbag",
                description: "A rosbag2 folder for ROS 2",
                ending: "-rosbag2",
                unit: "messages",
                kind: OutputKind::Folder,
            },
            Self::LeRobot => FormatProperties {
                name: "lerobot",
                description: "A LeRobot v3.0 data set without video",
                ending: "-lerobot",
                unit: "frames",
                kind: OutputKind::Folder,
            },
            Self::Mcap => FormatProperties {
                name: "mcap",
                description: "A recording file again, with its own index",
                ending: ".mcap",
                unit: "entries",
                kind: OutputKind::Binary,
            },
        }
    }

    /// Writes time ranges of recordings. Several are one data set, or in the other formats a folder with an export of each.
    ///
    /// # Errors
    /// [`ExportError`]; then there is no file or folder.
    pub fn write(
        self,
        sources: &[ExportSource<'_>],
        to: &Destination,
        options: &ExportOptions,
    ) -> Result<ExportSummary, ExportError> {
        let write: WriteOne = match self {
            Self::Csv => csv::write,
            Self::Parquet => parquet::write,
            Self::Rosbag => rosbag::write,
            Self::LeRobot => return lerobot::write(sources, to, &options.lerobot),
            Self::Mcap => cut::write,
        };
        let recordings = match sources {
            [source] => vec![write(*source, to)?],
            _ => self.write_each(sources, to, write)?,
        };
        Ok(ExportSummary {
            recordings,
            episodes: None,
        })
    }

    /// Writes each recording into a file or folder of its own, named after it.
    fn write_each(
        self,
        sources: &[ExportSource<'_>],
        to: &Destination,
        write: WriteOne,
    ) -> Result<Vec<Exported>, ExportError> {
        let folder = Folder::new(to)?;
        let FormatProperties { kind, ending, .. } = self.properties();
        // The folder of each recording has its plain name.
        let ending = if kind == OutputKind::Folder {
            ""
        } else {
            ending
        };
        let mut names = BTreeSet::new();
        let mut recordings = Vec::new();
        for source in sources {
            let path = source.file.path();
            let stem = if path == Path::new("-") {
                "stdin".into()
            } else {
                path.file_stem().unwrap_or_default().to_string_lossy()
            };
            let (mut name, mut number) = (format!("{stem}{ending}"), 1);
            // Recordings of different days may share a name.
            while !names.insert(name.clone()) {
                number += 1;
                name = format!("{stem}-{number}{ending}");
            }
            let to = Destination::Path(folder.path().join(name));
            recordings.push(match write(*source, &to) {
                // Other recordings may have data if this one has none.
                Err(ExportError::Empty) => Exported::default(),
                exported => exported?,
            });
        }
        folder.finish(recordings.iter().map(|one| one.rows).sum())?;
        Ok(recordings)
    }
}
