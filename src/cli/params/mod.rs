//! `params`: the parameters a hand keeps, read, compared, written, saved, reset. Nothing here moves the hand, and only `apply`,
//! `save` and `reset` write to it.

mod apply;
mod args;
mod backups;
mod diff;
mod dump;
mod place;
mod reach;
mod reset;
mod save;
mod words;

pub(crate) use args::ParamsArgs;

use crate::cli::out::Out;
use args::ParamsCommand;

/// Runs one of the subcommands.
pub(crate) fn run(out: &mut Out, args: &ParamsArgs) -> anyhow::Result<()> {
    match &args.command {
        ParamsCommand::Dump(args) => dump::run(out, args),
        ParamsCommand::Diff(args) => diff::run(out, args),
        ParamsCommand::Apply(args) => apply::run(out, args),
        ParamsCommand::Save(args) => save::run(out, args),
        ParamsCommand::Reset(args) => reset::run(out, args),
        ParamsCommand::Backups(args) => backups::run(out, args),
    }
}
