//! An error of the operating system as a value: an `io::Error` can be neither copied nor compared.

use std::io;

/// An error of the operating system, or of the standard library on its behalf.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{words}")]
pub struct SystemError {
    pub kind: io::ErrorKind,
    /// The system's error number, if the error came from the system itself.
    pub code: Option<i32>,
    /// Error text, in the system's language.
    pub words: String,
}

impl From<&io::Error> for SystemError {
    fn from(error: &io::Error) -> Self {
        Self {
            kind: error.kind(),
            code: error.raw_os_error(),
            words: error.to_string(),
        }
    }
}

impl From<io::Error> for SystemError {
    fn from(error: io::Error) -> Self {
        Self::from(&error)
    }
}
