//! `handscope exhibit`: checks an exhibition file and shows the exhibition in place of the window.

use crate::app::exhibit::Exhibition;
use crate::app::exhibit::exhibit_file;
use crate::cli::out::Out;
use crate::cli::window::DrawnArgs;
use anyhow::Context as _;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ExhibitArgs {
    /// What visitors can play, and how; without it, what is built in
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,

    /// Only look whether FILE is well, and say what it holds
    #[arg(long)]
    check: bool,

    #[command(flatten)]
    drawn: DrawnArgs,
}

pub(crate) fn run(out: &mut Out, args: ExhibitArgs) -> anyhow::Result<()> {
    args.drawn.check(1)?;
    let start = match &args.file {
        Some(path) => exhibit_file::read(path)
            .with_context(|| format!("the exhibition in {} cannot be shown", path.display()))?,
        None => exhibit_file::built_in().context("the built-in exhibition cannot be read")?,
    };
    if args.check {
        return out.line(&summary(&start));
    }
    show(args, start)
}

/// Contents of a file, in one line.
fn summary(start: &Exhibition) -> String {
    let plan = &start.plan;
    let names: Vec<&str> = plan
        .tiles
        .iter()
        .map(|tile| tile.name.en.as_str())
        .collect();
    let attract = match &plan.attract {
        Some(attract) => format!("attract loop of {}", attract.pieces.len()),
        None => "no attract loop".into(),
    };
    let pin = match plan.pin {
        Some(_) => "with a PIN",
        None => "PIN chosen at the start",
    };
    format!(
        "{} tiles: {}; speed {}, force {} g, {} s a visitor, {attract}, {pin}",
        names.len(),
        names.join(", "),
        plan.limits.speed.get(),
        plan.limits.force.get(),
        plan.visit.as_secs(),
    )
}

#[cfg(feature = "desktop")]
fn show(args: ExhibitArgs, start: Exhibition) -> anyhow::Result<()> {
    use crate::cli::window::{WindowShows, open};
    let command = std::iter::once("exhibit".into());
    let shows = WindowShows {
        records: true,
        replay: None,
        exhibit: Some(Exhibition {
            ends_program: true,
            ..start
        }),
        words: command
            .chain(args.file.into_iter().map(Into::into))
            .collect(),
    };
    open(args.drawn, shows)
}

#[cfg(not(feature = "desktop"))]
fn show(_args: ExhibitArgs, _start: Exhibition) -> anyhow::Result<()> {
    crate::cli::window::without_window()
}
