//! The library as TOML, version 1 (assets/manual/files.md). A file is taken whole or not at all; keys that are not known are kept.

use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::poses::library::{
    ENTRIES_MAX, LibraryPose, Millis, PoseId, PoseLibrary, STEPS_MAX, Sequence, SequenceId,
    SequenceStep, TAGS_MAX, clean,
};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use toml::Spanned;

/// The format that a pose file names.
pub const FORMAT: &str = "handscope-poses";
/// The version that is written, and the only one that is read.
pub const VERSION: i64 = 1;

/// Why a pose file was rejected, as a whole.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{cause}", place(*.line, .field.as_ref()))]
pub struct PoseFileError {
    /// Line, 1 the first, where one is to blame.
    pub line: Option<usize>,
    /// Field, where one is to blame.
    pub field: Option<String>,
    /// What is wrong.
    pub cause: PoseFileCause,
}

/// What is wrong with a pose file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PoseFileCause {
    /// Not TOML, or a value that does not fit its field.
    #[error("{0}")]
    Toml(String),
    /// Another kind of file.
    #[error("this is not a pose file: its format is \"{got}\", not \"{FORMAT}\"")]
    Format {
        /// What it says it is.
        got: String,
    },
    /// Written by another version.
    #[error("version {got} cannot be read, only version {VERSION}")]
    Version {
        /// What it says.
        got: i64,
    },
    /// A name that is empty, too long, or has a line break.
    #[error("\"{name}\" is not a valid name: use 1 to 32 characters on one line")]
    Name {
        /// The name.
        name: String,
    },
    /// Two entries with one name.
    #[error("the name \"{name}\" is used twice")]
    Twice {
        /// The name.
        name: String,
    },
    /// A step names a pose that the file does not have.
    #[error("there is no pose \"{name}\" in this file")]
    NoSuchPose {
        /// The name.
        name: String,
    },
    /// More than a library holds.
    #[error("{got} are too many: at most {limit}")]
    TooMany {
        /// How many there are.
        got: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The system could not read it.
    #[error("it cannot be read: {0}")]
    Unreadable(String),
}

/// Line and field, as they stand before the cause.
fn place(line: Option<usize>, field: Option<&String>) -> String {
    let line = line.map(|line| format!("line {line}, "));
    let field = field.map(|field| format!("`{field}`: "));
    line.unwrap_or_default() + &field.unwrap_or_default()
}

impl From<PoseFileCause> for PoseFileError {
    fn from(cause: PoseFileCause) -> Self {
        Self {
            line: None,
            field: None,
            cause,
        }
    }
}

#[derive(Deserialize)]
struct FileHead {
    format: Spanned<String>,
    version: Spanned<i64>,
}

#[derive(Serialize, Deserialize)]
struct FileRow {
    format: String,
    version: i64,
    #[serde(default, rename = "pose")]
    poses: Vec<PoseRow>,
    #[serde(default, rename = "sequence")]
    sequences: Vec<SequenceRow>,
    #[serde(flatten)]
    others: toml::Table,
}

#[derive(Serialize, Deserialize)]
struct PoseRow {
    name: Spanned<String>,
    #[serde(default)]
    tags: Vec<String>,
    speed: Speed,
    force: Force,
    #[serde(default)]
    leave: Vec<Dof>,
    angles: AnglesRow,
    #[serde(flatten)]
    others: toml::Table,
}

/// All six joints, and no other: a pose of another hand is refused.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AnglesRow {
    little: Angle,
    ring: Angle,
    middle: Angle,
    index: Angle,
    thumb_bend: Angle,
    thumb_rotate: Angle,
}

#[derive(Serialize, Deserialize)]
struct SequenceRow {
    name: Spanned<String>,
    #[serde(default, rename = "loop")]
    looped: bool,
    #[serde(default, rename = "step")]
    steps: Vec<StepRow>,
    #[serde(flatten)]
    others: toml::Table,
}

#[derive(Serialize, Deserialize)]
struct StepRow {
    pose: Spanned<String>,
    speed: Speed,
    dwell_ms: Millis,
    limit_ms: Millis,
    #[serde(flatten)]
    others: toml::Table,
}

/// The library as text.
///
/// # Errors
/// What the TOML writer says; a library that was built by this program has no such value.
pub fn write(library: &PoseLibrary) -> Result<String, toml::ser::Error> {
    let poses = library.poses.iter().map(pose_row).collect();
    let sequences = library.sequences.iter();
    let sequences = sequences.map(|sequence| sequence_row(library, sequence));
    toml::to_string(&FileRow {
        format: FORMAT.into(),
        version: VERSION,
        poses,
        sequences: sequences.collect(),
        others: library.others.clone(),
    })
}

fn pose_row(pose: &LibraryPose) -> PoseRow {
    let angles = &pose.angles;
    let left = Dof::ALL.into_iter().filter(|dof| pose.leave[*dof]);
    PoseRow {
        name: unplaced(&pose.name),
        tags: pose.tags.clone(),
        speed: pose.speed,
        force: pose.force,
        leave: left.collect(),
        angles: AnglesRow {
            little: angles[Dof::Little],
            ring: angles[Dof::Ring],
            middle: angles[Dof::Middle],
            index: angles[Dof::Index],
            thumb_bend: angles[Dof::ThumbBend],
            thumb_rotate: angles[Dof::ThumbRotate],
        },
        others: pose.others.clone(),
    }
}

fn sequence_row(library: &PoseLibrary, sequence: &Sequence) -> SequenceRow {
    let steps = sequence.steps.iter().filter_map(|step| {
        Some(StepRow {
            pose: unplaced(&library.pose(step.pose)?.name),
            speed: step.speed,
            dwell_ms: step.dwell,
            limit_ms: step.limit,
            others: step.others.clone(),
        })
    });
    SequenceRow {
        name: unplaced(&sequence.name),
        looped: sequence.looped,
        steps: steps.collect(),
        others: sequence.others.clone(),
    }
}

fn unplaced(text: &str) -> Spanned<String> {
    Spanned::new(0..0, text.to_owned())
}

/// The library that a text holds.
///
/// # Errors
/// [`PoseFileError`] with line and field; nothing is taken of such a text.
pub fn read(text: &str) -> Result<PoseLibrary, PoseFileError> {
    let source = FileText(text);
    let head: FileHead = source.parse()?;
    if head.format.get_ref() != FORMAT {
        let got = head.format.get_ref().chars().take(40).collect();
        return Err(source.blame(head.format.span(), "format", PoseFileCause::Format { got }));
    }
    let got = *head.version.get_ref();
    if got != VERSION {
        let cause = PoseFileCause::Version { got };
        return Err(source.blame(head.version.span(), "version", cause));
    }
    source.library(source.parse()?)
}

/// The text that is being read, to say where in it something is wrong.
#[derive(Clone, Copy)]
struct FileText<'a>(&'a str);

impl FileText<'_> {
    fn parse<T: serde::de::DeserializeOwned>(self) -> Result<T, PoseFileError> {
        toml::from_str(self.0).map_err(|error| self.toml_error(&error))
    }

    fn toml_error(self, error: &toml::de::Error) -> PoseFileError {
        let said = error.message().trim().replace('\n', " ");
        let named = ["missing field `", "unknown field `"]
            .iter()
            .find_map(|start| {
                let rest = said.strip_prefix(start)?;
                rest.split('`').next().map(str::to_owned)
            });
        let span = error.span().unwrap_or(0..0);
        PoseFileError {
            field: named.or_else(|| self.key_before(span.start)),
            line: error.span().map(|span| self.line(span.start)),
            cause: PoseFileCause::Toml(said),
        }
    }

    fn blame(self, at: Range<usize>, field: &str, cause: PoseFileCause) -> PoseFileError {
        PoseFileError {
            line: Some(self.line(at.start)),
            field: Some(field.into()),
            cause,
        }
    }

    fn line(self, at: usize) -> usize {
        let before = self.0.bytes().take(at);
        1 + before.filter(|byte| *byte == b'\n').count()
    }

    /// The key whose value begins here.
    fn key_before(self, at: usize) -> Option<String> {
        let (before, _) = self.0.get(..at)?.rsplit_once('=')?;
        let key = before.rsplit(['\n', '{', ',']).next()?.trim();
        (!key.is_empty() && key.len() <= 40).then(|| key.to_owned())
    }

    fn library(self, file: FileRow) -> Result<PoseLibrary, PoseFileError> {
        few(file.poses.len(), ENTRIES_MAX)?;
        few(file.sequences.len(), ENTRIES_MAX)?;
        let mut library = PoseLibrary::default();
        library.others = file.others;
        for row in file.poses {
            self.pose(&mut library, row)?;
        }
        for row in file.sequences {
            self.sequence(&mut library, row)?;
        }
        Ok(library)
    }

    fn name(self, name: &Spanned<String>, taken: bool) -> Result<String, PoseFileError> {
        let text = name.get_ref().clone();
        if text.is_empty() || clean(&text) != text {
            let name_start = text.chars().take(40).collect();
            let cause = PoseFileCause::Name { name: name_start };
            return Err(self.blame(name.span(), "name", cause));
        }
        if taken {
            let cause = PoseFileCause::Twice { name: text };
            return Err(self.blame(name.span(), "name", cause));
        }
        Ok(text)
    }

    fn pose(self, library: &mut PoseLibrary, row: PoseRow) -> Result<(), PoseFileError> {
        let name = self.name(&row.name, library.pose_named(row.name.get_ref()).is_some())?;
        few(row.tags.len(), TAGS_MAX)?;
        if let Some(bad) = row
            .tags
            .iter()
            .find(|tag| tag.is_empty() || clean(tag) != **tag)
        {
            let cause = PoseFileCause::Name { name: bad.clone() };
            return Err(self.blame(row.name.span(), "tags", cause));
        }
        let angles = row.angles;
        let angles = PerDof::new([
            angles.little,
            angles.ring,
            angles.middle,
            angles.index,
            angles.thumb_bend,
            angles.thumb_rotate,
        ]);
        let id = PoseId(library.fresh());
        library.poses.push(LibraryPose {
            id,
            name,
            tags: row.tags,
            angles,
            leave: PerDof::from_fn(|dof| row.leave.contains(&dof)),
            speed: row.speed,
            force: row.force,
            others: row.others,
        });
        Ok(())
    }

    fn sequence(self, library: &mut PoseLibrary, row: SequenceRow) -> Result<(), PoseFileError> {
        let mut known = library.sequences.iter();
        let taken = known.any(|sequence| sequence.name == *row.name.get_ref());
        let name = self.name(&row.name, taken)?;
        few(row.steps.len(), STEPS_MAX)?;
        let steps = row.steps.into_iter().map(|step| self.step(library, step));
        let steps = steps.collect::<Result<Vec<SequenceStep>, PoseFileError>>()?;
        let id = SequenceId(library.fresh());
        library.sequences.push(Sequence {
            id,
            name,
            looped: row.looped,
            steps,
            others: row.others,
        });
        Ok(())
    }

    fn step(self, library: &PoseLibrary, row: StepRow) -> Result<SequenceStep, PoseFileError> {
        let Some(pose) = library.pose_named(row.pose.get_ref()) else {
            let name = row.pose.get_ref().chars().take(40).collect();
            let cause = PoseFileCause::NoSuchPose { name };
            return Err(self.blame(row.pose.span(), "pose", cause));
        };
        Ok(SequenceStep {
            pose: pose.id,
            speed: row.speed,
            dwell: row.dwell_ms,
            limit: row.limit_ms,
            others: row.others,
        })
    }
}

fn few(got: usize, limit: usize) -> Result<(), PoseFileError> {
    if got > limit {
        return Err(PoseFileCause::TooMany { got, limit }.into());
    }
    Ok(())
}
