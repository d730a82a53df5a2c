//! Session files that a person names: how one is opened, its moments in seconds from its start, and what is missing in words.

use crate::cli::parse::seconds;
use crate::hand::Moment;
use crate::record::file::reader::{Damage, OpenError, Stretch};
use crate::record::file::{FLUSH_EACH, SessionFile};
use anyhow::{anyhow, bail};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A file of a recording.
#[derive(Debug, clap::Args)]
pub(crate) struct FileArgs {
    /// A session file, as 'handscope record' and the window write it
    #[arg(value_name = "FILE.mcap")]
    pub(crate) file: PathBuf,
}

/// A stretch of a recording, in seconds from its start.
#[derive(Debug, clap::Args)]
pub(crate) struct StretchArgs {
    /// Begin here, in seconds from the session's start [default: at its start]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    from: Option<Duration>,
    /// End here [default: at its end]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    to: Option<Duration>,
}

impl StretchArgs {
    /// The stretch of this file.
    pub(crate) fn of(&self, file: &SessionFile) -> anyhow::Result<Stretch> {
        let at = |step: Duration| file.first().plus(step);
        let from = self.from.map_or(Moment::ZERO, at);
        let to = self.to.map_or(file.last(), at);
        let length_s = length(file).as_secs_f64();
        if from > to {
            bail!(
                "there is nothing between --from and --to: the session is {length_s:.1} s long, and --from must be before --to"
            );
        }
        Ok(Stretch {
            from,
            to,
            wire: true,
        })
    }
}

/// Opens a file.
pub(crate) fn open(path: &Path) -> anyhow::Result<SessionFile> {
    SessionFile::open(path).map_err(|error| {
        let is_csv = path.extension().is_some_and(|ending| ending == "csv");
        let what_to_do = match error {
            OpenError::Unreadable { .. } => "check the path",
            OpenError::NotMcap if is_csv => "make a session file of it with 'handscope import'",
            OpenError::NotAFile | OpenError::NotMcap => {
                "name a session file of 'handscope record' or of the window"
            }
            OpenError::Foreign => "only sessions of Handscope can be opened",
            OpenError::Empty => "there is nothing to recover",
        };
        anyhow!("cannot open {}: {error}; {what_to_do}", path.display())
    })
}

/// How long a session is.
pub(crate) fn length(file: &SessionFile) -> Duration {
    file.last().since(file.first())
}

/// What could not be read, in words; `None` if all could.
pub(crate) fn lost(damage: Damage) -> Option<String> {
    let Damage { chunks, bytes } = damage;
    let chunks = (chunks > 0).then(|| {
        let (noun, verb) = if chunks == 1 {
            ("piece", "is")
        } else {
            ("pieces", "are")
        };
        let length_s = FLUSH_EACH.as_secs_f64();
        format!("{chunks} {noun} of about {length_s} s {verb} damaged and left out")
    });
    let bytes = (bytes > 0).then(|| format!("{bytes} bytes hold no record"));
    let words: Vec<String> = chunks.into_iter().chain(bytes).collect();
    (!words.is_empty()).then(|| words.join(", "))
}
