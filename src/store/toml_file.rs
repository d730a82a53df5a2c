//! TOML files of the program: their format and version, and the position of errors. Independent of their content.

use crate::store::file_error::{FileCause, FileError};
use crate::store::read_text;
use crate::store::toml_words::plain;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::io;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

pub use crate::store::file_error::VERSION;

/// Reads a file that must exist and has at most `limit` bytes.
///
/// # Errors
/// The system's error or that of `read`.
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

/// Text being parsed, for locating errors in it.
#[derive(Debug, Clone, Copy)]
pub struct FileText<'a>(&'a str);

impl<'a> FileText<'a> {
    /// A text without a format header.
    pub const fn plain(text: &'a str) -> Self {
        Self(text)
    }

    /// A text with this format and the supported version.
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

    /// Parses the content.
    ///
    /// # Errors
    /// [`FileError`] with line and field.
    pub fn parse<T: DeserializeOwned>(self) -> Result<T, FileError> {
        toml::from_str(self.0).map_err(|error| self.toml_error(&error))
    }

    fn toml_error(self, error: &toml::de::Error) -> FileError {
        let message = error.message().trim();
        let (named, cause) = match self.0.parse::<toml::Table>() {
            Ok(_) => plain(message),
            Err(_) if message == "duplicate key" => (None, FileCause::KeyTwice),
            Err(_) => (None, FileCause::Syntax(message.into())),
        };
        let span = error.span().unwrap_or(0..0);
        FileError {
            field: match cause {
                // A syntax error does not belong to any key.
                FileCause::Syntax(_) => None,
                _ => named.or_else(|| self.key_before(span.start)),
            },
            line: error.span().map(|span| self.line(span.start)),
            cause,
        }
    }

    /// Builds the error of a field at this position.
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

    /// Key of the value that begins at this position.
    fn key_before(self, at: usize) -> Option<String> {
        let (before, _) = self.0.get(..at)?.rsplit_once('=')?;
        let key = before.rsplit(['\n', '{', ',']).next()?.trim();
        (!key.is_empty() && key.len() <= 40).then(|| key.to_owned())
    }
}
