//! Files of ours in TOML: of which format and version they are, and where in them something is wrong. Knows what stands in none
//! of them.

use crate::store::read_text;
use crate::system::SystemError;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::io;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

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

/// What is wrong with a file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileCause {
    /// Not TOML, or not a row of a table, or a value that does not fit its field.
    #[error("{0}")]
    Malformed(String),
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

/// Reads a file that must be there and has at most `limit` bytes.
///
/// # Errors
/// What the system or `read` says.
pub fn load<T>(
    path: &Path,
    limit: u64,
    read: impl FnOnce(&str) -> Result<T, FileError>,
) -> Result<T, FileError> {
    match read_text(path, limit)? {
        Some(text) => read(&text),
        None => Err(io::Error::new(io::ErrorKind::NotFound, "there is no such file").into()),
    }
}

#[derive(Deserialize)]
struct FileHead {
    format: Spanned<String>,
    version: Spanned<i64>,
}

/// The text that is being read, to say where in it something is wrong.
#[derive(Debug, Clone, Copy)]
pub struct FileText<'a>(&'a str);

impl<'a> FileText<'a> {
    /// A text that names no format.
    pub const fn plain(text: &'a str) -> Self {
        Self(text)
    }

    /// A text of this format and of the version that is read.
    ///
    /// # Errors
    /// [`FileError`] with line and field.
    pub fn of(text: &'a str, wanted: &'static str) -> Result<Self, FileError> {
        let source = Self(text);
        let head: FileHead = source.parse()?;
        if head.format.get_ref() != wanted {
            let got = head.format.get_ref().chars().take(40).collect();
            let cause = FileCause::Format { got, wanted };
            return Err(source.blame(head.format.span(), "format", cause));
        }
        let got = *head.version.get_ref();
        if got != VERSION {
            let cause = FileCause::Version { got };
            return Err(source.blame(head.version.span(), "version", cause));
        }
        Ok(source)
    }

    /// What it holds.
    ///
    /// # Errors
    /// [`FileCause::Malformed`] with line and field.
    pub fn parse<T: DeserializeOwned>(self) -> Result<T, FileError> {
        toml::from_str(self.0).map_err(|error| self.toml_error(&error))
    }

    fn toml_error(self, error: &toml::de::Error) -> FileError {
        let said = error.message().trim().replace('\n', " ");
        let named = ["missing field `", "unknown field `"]
            .iter()
            .find_map(|start| {
                let rest = said.strip_prefix(start)?;
                rest.split('`').next().map(str::to_owned)
            });
        let span = error.span().unwrap_or(0..0);
        FileError {
            field: named.or_else(|| self.key_before(span.start)),
            line: error.span().map(|span| self.line(span.start)),
            cause: FileCause::Malformed(said),
        }
    }

    /// The error of a field that stands here.
    pub fn blame(self, at: Range<usize>, field: &str, cause: FileCause) -> FileError {
        FileError {
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
}
