//! `params`: what a hand keeps, read, compared, written, saved, reset. Nothing here moves the hand, and nothing is written but by
//! `apply`, `save` and `reset`.

mod apply;
mod args;
mod backups;
mod diff;
mod dump;
mod relocate;
mod reset;
mod save;
mod show;
mod talk;
mod words;

pub(crate) use args::ParamsArgs;

use crate::cli::out::Out;
use args::ParamsCommand;

/// Does what is asked of the parameters.
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
