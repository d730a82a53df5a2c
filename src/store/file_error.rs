//! Why a file was rejected: what is wrong, where, and what to do.

use crate::hand::Dof;
use crate::hand::gap::NotOffered;
use crate::system::SystemError;
use std::io;

/// The version of all formats that is written, and the only one that is read.
pub const VERSION: i64 = 1;

/// Why a file was rejected, as a whole.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{cause}", place(*.line, .field.as_ref()))]
pub struct FileError {
    /// Line, 1 the first, where one is to blame.
    pub line: Option<usize>,
    /// Field, where one is to blame.
    pub field: Option<String>,
    /// What is wrong.
    pub cause: FileCause,
}

/// A kind of value in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueKind {
    /// A number without a point.
    Whole,
    /// Any number.
    Number,
    /// True or false.
    Truth,
    /// Words in quotes.
    Text,
    /// Values in brackets.
    List,
    /// Keys with values.
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

/// What is wrong with a file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileCause {
    /// Not a row of a table, or a value that does not fit its field.
    #[error("{0}")]
    Malformed(String),
    /// Not TOML.
    #[error("this is not TOML, which has lines like key = value: {0}")]
    Syntax(String),
    /// One key twice.
    #[error("this key stands here twice: take one away")]
    KeyTwice,
    /// Two keys of which only one can be there.
    #[error("it cannot stand beside `{other}`: take one away")]
    Both {
        /// The other one.
        other: &'static str,
    },
    /// A key that has to be there.
    #[error("it is missing: add it")]
    Missing,
    /// A key that nothing here has.
    #[error("there is no such key here, only {known}: correct it, or take it away")]
    Unknown {
        /// Those that are.
        known: String,
    },
    /// A number beyond its range.
    #[error("{got} is outside {range}")]
    Range {
        /// What stands there.
        got: String,
        /// From where to where.
        range: String,
    },
    /// Another kind of value.
    #[error("{got} is not {}", wanted.words())]
    Kind {
        /// What stands there.
        got: String,
        /// What should.
        wanted: ValueKind,
    },
    /// A word that is not known there.
    #[error("\"{got}\" is not known here, only {known}")]
    Choice {
        /// The word.
        got: String,
        /// Those that are known.
        known: String,
    },
    /// A kind of grip that has no gap in this hand.
    #[error("{0}")]
    NotOffered(NotOffered),
    /// A joint that a grip by size cannot leave alone.
    #[error("a grip by size needs {}: take it away from here", dof.name())]
    Pinches {
        /// The joint.
        dof: Dof,
    },
    /// Another table.
    #[error("this is not a table of samples")]
    NotSamples,
    /// Not a picture.
    #[error("{0}")]
    Picture(String),
    /// Another kind of file.
    #[error("this is another kind of file: its format is \"{got}\", not \"{wanted}\"")]
    Format {
        /// What it says it is.
        got: String,
        /// What it should be.
        wanted: &'static str,
    },
    /// Written by another version.
    #[error("version {got} cannot be read, only version {VERSION}")]
    Version {
        /// What it says.
        got: i64,
    },
    /// A value that is not allowed there.
    #[error("{got} is not {allowed}")]
    Value {
        /// What stands there.
        got: String,
        /// What may.
        allowed: String,
    },
    /// Two entries with one name.
    #[error("the name \"{name}\" is used twice")]
    Twice { name: String },
    /// A name that the file does not have.
    #[error("there is no \"{name}\" in this file")]
    Absent { name: String },
    /// More than there may be.
    #[error("{got} are too many: at most {limit}")]
    TooMany {
        /// How many there are.
        got: usize,
        /// How many there may be.
        limit: usize,
    },
    /// It holds what nobody else may know, and others can read or change it.
    #[error("others can read this file: run 'chmod 600 {path}'")]
    NotPrivate {
        /// The file.
        path: String,
    },
    /// It names a file outside its own folder.
    #[error("{got} does not lie in the folder of this file, or below it")]
    Outside {
        /// The name.
        got: String,
    },
    /// A file that holds nothing of its kind.
    #[error("there is nothing in it")]
    Empty,
    /// The system could not read it.
    #[error("it cannot be read: {0}")]
    Unreadable(SystemError),
    /// A file that this one names is rejected.
    #[error("it cannot be read: {path}: {}", .error.reason())]
    Named { path: String, error: Box<FileError> },
}

impl FileError {
    /// The error of the file that names this one.
    pub fn of_named(self, path: String) -> Self {
        let error = Box::new(self);
        FileCause::Named { path, error }.into()
    }

    /// What is wrong, where it is said already that the file cannot be read.
    fn reason(&self) -> String {
        match &self.cause {
            FileCause::Unreadable(why) => why.to_string(),
            FileCause::Named { path, error } => format!("{path}: {}", error.reason()),
            _ => self.to_string(),
        }
    }
}

/// Line and field, as they stand before the cause.
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
