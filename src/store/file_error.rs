//! Reason for a rejected file: the problem, its position, and the remedy.

use crate::hand::Dof;
use crate::hand::gap::NotOffered;
use crate::system::SystemError;
use std::io;

/// Version of all formats that is written, and the only one that is read.
pub const VERSION: i64 = 1;

/// Reason why a file was rejected.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{cause}", place(*.line, .field.as_ref()))]
pub struct FileError {
    /// Line number from 1, if the problem is in a line.
    pub line: Option<usize>,
    /// Name of the field, if the problem is in a field.
    pub field: Option<String>,
    pub cause: FileCause,
}

/// A kind of value in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueKind {
    Whole,
    /// Integer or floating point.
    Number,
    Truth,
    Text,
    List,
    Table,
}

impl ValueKind {
    const fn words(self) -> &'static str {
        match self {
            Self::Whole => "a whole number that is allowed here",
            Self::Number => "a number",
            Self::Truth => "true or false",
            Self::Text => "a text in quotes",
            Self::List => "a list in [brackets]",
            Self::Table => "a table of keys and values",
        }
    }
}

/// Kind of problem in a file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileCause {
    /// Not a row of a table, or a value that does not fit its field.
    #[error("{0}")]
    Malformed(String),
    /// Not TOML.
    #[error("this is not TOML, which has lines like key = value: {0}")]
    Syntax(String),
    /// Duplicate key.
    #[error("duplicate key: remove one")]
    KeyTwice,
    /// Two mutually exclusive keys.
    #[error("it conflicts with `{other}`: remove one")]
    Both {
        /// The other key.
        other: &'static str,
    },
    /// Missing required key.
    #[error("it is missing: add it")]
    Missing,
    /// Unknown key.
    #[error("unknown key, known here: {known}; correct it, or remove it")]
    Unknown {
        /// Known keys.
        known: String,
    },
    /// A number beyond its range.
    #[error("{got} is outside {range}")]
    Range {
        /// Value found.
        got: String,
        /// Allowed range.
        range: String,
    },
    /// Wrong kind of value.
    #[error("{got} is not {}", wanted.words())]
    Kind {
        /// Value found.
        got: String,
        /// Expected kind.
        wanted: ValueKind,
    },
    /// Unknown word.
    #[error("\"{got}\" is unknown here, known: {known}")]
    Choice {
        /// Word found.
        got: String,
        /// Known words.
        known: String,
    },
    /// A kind of grip for which this hand has no gap.
    #[error("{0}")]
    NotOffered(NotOffered),
    /// A joint that a grip by size must control.
    #[error("a grip by size needs {}: remove it here", dof.name())]
    Pinches {
        /// Joint to remove from the file.
        dof: Dof,
    },
    /// Not a table of samples.
    #[error("this is not a table of samples")]
    NotSamples,
    /// Not a picture.
    #[error("{0}")]
    Picture(String),
    /// Another kind of file.
    #[error("this is another kind of file: its format is \"{got}\", not \"{wanted}\"")]
    Format {
        /// Format found.
        got: String,
        /// Expected format.
        wanted: &'static str,
    },
    /// Unsupported version.
    #[error("version {got} cannot be read, only version {VERSION}")]
    Version {
        /// Version found.
        got: i64,
    },
    /// A value that is not allowed for its field.
    #[error("{got} is not {allowed}")]
    Value {
        /// Value found.
        got: String,
        /// Allowed values.
        allowed: String,
    },
    /// Two entries with one name.
    #[error("the name \"{name}\" is used twice")]
    Twice { name: String },
    /// A name that the file does not define.
    #[error("there is no \"{name}\" in this file")]
    Absent { name: String },
    /// Too many entries.
    #[error("{got} are too many: at most {limit}")]
    TooMany {
        /// Number found.
        got: usize,
        /// Maximum number.
        limit: usize,
    },
    /// A file with secrets that other users can read or change.
    #[error("others can read this file: run 'chmod 600 {path}'")]
    NotPrivate {
        /// Path of the file.
        path: String,
    },
    /// A path outside the folder of this file.
    #[error("{got} is not in the folder of this file, or below it")]
    Outside {
        /// Path found.
        got: String,
    },
    /// A file that holds nothing of its kind.
    #[error("it is empty")]
    Empty,
    /// The system could not read the file.
    #[error("{0}")]
    Unreadable(SystemError),
    /// A file that this one refers to was rejected.
    #[error("{path}: {error}")]
    Named { path: String, error: Box<FileError> },
}

impl FileError {
    /// Wraps the error of a referenced file into that of the file that refers to it.
    pub fn of_named(self, path: String) -> Self {
        let error = Box::new(self);
        FileCause::Named { path, error }.into()
    }
}

/// Line and field, as a prefix to the cause.
fn place(line: Option<usize>, field: Option<&String>) -> String {
    let line = line.map(|line| format!("line {line}, "));
    let field = field.map(|field| format!("`{field}`: "));
    line.unwrap_or_default() + &field.unwrap_or_default()
}

impl From<FileCause> for FileError {
    fn from(cause: FileCause) -> Self {
        Self {
            line: None,
            field: None,
            cause,
        }
    }
}

impl From<io::Error> for FileError {
    fn from(error: io::Error) -> Self {
        FileCause::Unreadable(error.into()).into()
    }
}

impl From<FileError> for io::Error {
    fn from(error: FileError) -> Self {
        match &error.cause {
            FileCause::Unreadable(system) => Self::new(system.kind, error),
            _ => Self::new(io::ErrorKind::InvalidData, error),
        }
    }
}
