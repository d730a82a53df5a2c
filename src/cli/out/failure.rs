//! The end of a failed command: its kind, for scripts, and its report on standard error, as a sentence or as one JSON object.

use crate::cli::out::messages::{notify, push_line};
use crate::cli::out::{AlreadyReported, ReaderGone, WrongUsage};
use crate::printable;
use crate::record::export::ExportError;
use crate::record::file::reader::OpenError;
use crate::store::FileError;
use serde_json::json;
use std::ffi::OsString;
use std::io;
use std::process::ExitCode;

/// Exit status of wrong usage, as clap defines it.
const WRONG_USAGE: u8 = 2;

/// Kind of a failure, as in JSON. A contract with scripts, documented in `assets/manual/json.md`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "snake_case")]
pub(crate) enum FailureKind {
    /// Nothing was done: the command line is wrong.
    WrongUsage,
    /// Nothing was moved: `--arm` is missing.
    NotArmed,
    /// No hand answers.
    NoHand,
    /// A hand that answered no longer does.
    LinkLost,
    /// The user ended the command.
    Interrupted,
    /// A file exists already, cannot be read or written, or has the wrong content.
    File,
    /// The operating system refused something else.
    System,
    /// A bug of this program.
    Internal,
    /// Any other reason, which the message says.
    Failed,
}

/// A failure of a known kind.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{words}")]
pub(crate) struct Failure {
    kind: FailureKind,
    words: String,
}

impl FailureKind {
    /// Converts it into a command error.
    pub(crate) fn error(self, words: impl Into<String>) -> anyhow::Error {
        let words = words.into();
        Failure { kind: self, words }.into()
    }

    /// Kind of a command error: its own, or that of the first cause that has one.
    fn of(error: &anyhow::Error) -> Self {
        if error.is::<WrongUsage>() {
            return Self::WrongUsage;
        }
        if let Some(failure) = error.downcast_ref::<Failure>() {
            return failure.kind;
        }
        let kinds = error.chain().map(|cause| {
            let is_file = cause.is::<OpenError>() || cause.is::<FileError>();
            if is_file || cause.is::<ExportError>() {
                Some(Self::File)
            } else {
                cause.is::<io::Error>().then_some(Self::System)
            }
        });
        kinds.flatten().next().unwrap_or(Self::Failed)
    }
}

/// The way in which a command reports its failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FailureForm {
    /// One sentence.
    Text,
    /// One JSON object.
    Json,
}

impl FailureForm {
    /// The form that the command line asks for, even if it is wrong otherwise.
    pub(crate) fn requested(args: impl IntoIterator<Item = OsString>) -> Self {
        let mut options = args.into_iter().take_while(|arg| arg != "--");
        if options.any(|arg| arg == "--json") {
            Self::Json
        } else {
            Self::Text
        }
    }

    /// Reports a failure.
    pub(crate) fn report(self, kind: FailureKind, words: &str) {
        match self {
            Self::Text => notify(words),
            Self::Json => {
                let kind: &str = kind.into();
                let object = json!({ "error": { "kind": kind, "message": words } });
                push_line(&printable::json(&object.to_string()));
            }
        }
    }

    /// Exit status of a command. Its error is reported here, unless it was reported before.
    pub(crate) fn status(self, done: anyhow::Result<()>) -> ExitCode {
        match done {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) if error.is::<ReaderGone>() => ExitCode::SUCCESS,
            Err(error) if error.is::<AlreadyReported>() => ExitCode::FAILURE,
            Err(error) => {
                let kind = FailureKind::of(&error);
                self.report(kind, &format!("{error:#}"));
                match kind {
                    FailureKind::WrongUsage => ExitCode::from(WRONG_USAGE),
                    _ => ExitCode::FAILURE,
                }
            }
        }
    }

    /// Ends the program with what clap says of a command line: help, the version, or what is wrong.
    pub(crate) fn end_of_parse(self, said: &clap::Error) -> ! {
        if self == Self::Text || !said.use_stderr() {
            said.exit();
        }
        let words = said.to_string();
        let words = words.strip_prefix("error: ").unwrap_or(&words);
        self.report(FailureKind::WrongUsage, words.trim_end());
        crate::cli::out::finish_messages();
        std::process::exit(WRONG_USAGE.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::{Context as _, anyhow};

    #[test]
    fn the_first_cause_with_a_kind_gives_the_kind() {
        let system = || io::Error::other("no room");
        for (error, kind) in [
            (anyhow!("no"), FailureKind::Failed),
            (WrongUsage::error("no"), FailureKind::WrongUsage),
            (FailureKind::NoHand.error("no"), FailureKind::NoHand),
            (
                FailureKind::NoHand.error("no").context("at x"),
                FailureKind::NoHand,
            ),
            (anyhow::Error::new(system()), FailureKind::System),
            (
                Err::<(), _>(system())
                    .context("cannot write x")
                    .unwrap_err(),
                FailureKind::System,
            ),
            (ExportError::Empty.into(), FailureKind::File),
        ] {
            assert_eq!(FailureKind::of(&error), kind, "{error:#}");
        }
    }

    #[test]
    fn json_is_requested_before_the_end_of_the_options_only() {
        for (line, form) in [
            ("handscope watch --json", FailureForm::Json),
            ("handscope watch --jsonx --hand sim:", FailureForm::Text),
            ("handscope info -- --json", FailureForm::Text),
            ("handscope", FailureForm::Text),
        ] {
            let args = line.split(' ').map(OsString::from);
            assert_eq!(FailureForm::requested(args), form, "{line}");
        }
    }
}
