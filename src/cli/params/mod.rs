//! `params`: reads, compares, writes, saves and resets the hand's persistent parameters. Nothing here moves the hand, and only
//! `apply`, `save` and `reset` write to it.

mod apply;
mod args;
mod flash;
mod inspect;
mod patience;
mod place;
mod reach;
mod words;

pub(crate) use args::ParamsArgs;

use crate::cli::out::Out;
use args::ParamsCommand;

/// Runs one of the subcommands.
pub(crate) async fn run(out: &mut Out, args: &ParamsArgs) -> anyhow::Result<()> {
    match &args.command {
        ParamsCommand::Dump(args) => inspect::dump(out, args).await,
        ParamsCommand::Diff(args) => inspect::diff(out, args).await,
        ParamsCommand::Apply(args) => apply::run(out, args).await,
        ParamsCommand::Save(args) => flash::save(out, args).await,
        ParamsCommand::Reset(args) => flash::reset(out, args).await,
        ParamsCommand::Backups(args) => inspect::backups(out, args),
    }
}
