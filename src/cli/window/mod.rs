//! Starts the window from the command line, or reports why there is none.

pub(crate) mod exhibit;
pub(crate) mod snapshot;

use crate::app::hand::list::HANDS_MAX;
use crate::cli::out::WrongUsage;
use crate::transport::Endpoint;
use clap::Args;
use std::path::PathBuf;

/// How the window opens.
#[derive(Debug, Default, Args)]
pub(crate) struct WindowArgs {
    #[command(flatten)]
    pub(crate) drawn: DrawnArgs,

    /// Record nothing in this run
    #[arg(long)]
    pub(crate) no_record: bool,

    /// A recording to replay in the window
    #[arg(value_name = "FILE.mcap", value_parser = recording)]
    pub(crate) replay: Option<PathBuf>,
}

/// The hand in the window, and what draws it.
#[derive(Debug, Default, Args)]
pub(crate) struct DrawnArgs {
    /// The hand to open in the window, for example tcp:192.168.11.210:6000; given several times, up to eight hands side by side
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Vec<Endpoint>,

    /// Draw the window without OpenGL; chosen automatically where OpenGL does not start or is only software
    #[arg(long, conflicts_with = "opengl")]
    pub(crate) software: bool,

    /// Draw the window with OpenGL even where no graphics card is found
    #[arg(long)]
    pub(crate) opengl: bool,

    /// The same as --software, with the reason for the window to show
    #[arg(long, value_name = "REASON", hide = true)]
    pub(crate) software_because: Option<String>,
}

impl DrawnArgs {
    /// Rejects more hands than can be shown.
    pub(crate) fn check(&self, most: usize) -> anyhow::Result<()> {
        let named = self.hand.len();
        if named <= most {
            return Ok(());
        }
        let words = format!("--hand was given {named} times, and may be given {most} times here");
        Err(WrongUsage(words).into())
    }
}

/// Accepts recordings only: a mistyped command must not be taken for a file.
fn recording(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("mcap") => Ok(path),
        Some("csv") => {
            Err("values are not a recording; 'handscope import' makes a recording of them".into())
        }
        _ => Err(
            "no such command, and a recording ends in .mcap; 'handscope --help' lists the commands"
                .into(),
        ),
    }
}

/// Opens the window and runs until it is closed. If OpenGL does not start, the window opens without it.
#[cfg(feature = "desktop")]
pub(crate) fn run(args: WindowArgs) -> anyhow::Result<()> {
    use crate::cli::recordings::recording_file;
    use std::ffi::OsString;
    args.drawn.check(HANDS_MAX)?;
    if let Some(path) = &args.replay {
        // Reports an error on the command line, before the window opens.
        recording_file::open(path)?;
    }
    let no_record = args.no_record.then(|| OsString::from("--no-record"));
    let words = no_record
        .into_iter()
        .chain(args.replay.iter().map(OsString::from));
    let words = words.collect();
    let shows = WindowShows {
        records: !args.no_record,
        replay: args.replay,
        exhibit: None,
        words,
    };
    open(args.drawn, shows)
}

/// Initial contents of the window, and the equivalent command line arguments.
#[cfg(feature = "desktop")]
pub(crate) struct WindowShows {
    pub(crate) records: bool,
    pub(crate) replay: Option<std::path::PathBuf>,
    pub(crate) exhibit: Option<crate::app::exhibit::Exhibition>,
    pub(crate) words: Vec<std::ffi::OsString>,
}

/// Opens the window with these contents.
#[cfg(feature = "desktop")]
pub(crate) fn open(args: DrawnArgs, shows: WindowShows) -> anyhow::Result<()> {
    use crate::app::files::settings_file::{Loaded, default_path, load};
    use crate::app::settings::Language;
    use crate::shell::desktop;
    use crate::shell::desktop::{DesktopError, DesktopStart, Renderer};
    let settings_path = default_path();
    let mut loaded = settings_path.as_deref().map_or_else(Loaded::default, load);
    if !loaded.found
        && let Some(locale) = sys_locale::get_locale()
    {
        // The user has not chosen a language yet.
        loaded.settings.language = Language::of_locale(&locale);
    }
    let drawing = match args.software_because {
        Some(reason) => Renderer::InPlaceOfOpenGl(reason),
        None if args.software => Renderer::Software,
        None if args.opengl || desktop::may_draw_with_a_card() => Renderer::OpenGl,
        None => Renderer::Software,
    };
    let mut again = shows.words;
    for hand in &args.hand {
        again.extend(["--hand".into(), hand.to_string().into()]);
    }
    let ended = desktop::run(DesktopStart {
        snap: crate::shell::headless::snap::snap,
        endpoints: args.hand,
        drawing,
        loaded,
        settings_path,
        records: shows.records,
        exhibit: shows.exhibit,
        replay: shows.replay,
    });
    match ended {
        Err(DesktopError::NoOpenGl { cause }) => {
            again.extend(["--software-because".into(), (&cause).into()]);
            restart_without_opengl(&again, &cause)
        }
        ended => Ok(ended?),
    }
}

/// A process can have only one event loop in its life, so the window without OpenGL opens in a new process.
#[cfg(feature = "desktop")]
fn restart_without_opengl(again: &[std::ffi::OsString], reason: &str) -> anyhow::Result<()> {
    use anyhow::Context as _;
    let mut program = std::process::Command::new(std::env::current_exe()?);
    program.args(again);
    let failed = || {
        format!(
            "OpenGL does not start ({reason}), and the program could not restart itself without it; start 'handscope --software'"
        )
    };
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt as _;
        Err(program.exec()).with_context(failed)
    }
    #[cfg(not(unix))]
    {
        let ended = program.status().with_context(failed)?;
        std::process::exit(ended.code().unwrap_or(1))
    }
}

/// Reports that this program was built without a window.
#[cfg(not(feature = "desktop"))]
pub(crate) fn run(args: WindowArgs) -> anyhow::Result<()> {
    args.drawn.check(HANDS_MAX)?;
    without_window()
}

/// The same for any command that needs a window.
#[cfg(not(feature = "desktop"))]
pub(crate) fn without_window() -> anyhow::Result<()> {
    anyhow::bail!(
        "this program was built without its window: use 'handscope snapshot' for pictures and 'handscope watch' for values"
    )
}
