//! The command line of `params` as clap sees it. Does nothing.

use crate::app::params::table::ParamId;
use crate::transport::Endpoint;
use clap::{Args, Subcommand};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ParamsArgs {
    #[command(subcommand)]
    pub(crate) command: ParamsCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ParamsCommand {
    /// Read all parameters, print them, and write them to a file
    Dump(DumpArgs),
    /// Compare what the hand holds with a file, with what was saved last, or with the factory's
    #[command(
        after_help = "Exit status: 0 no difference; 1 differences, or something could not be read; 2 wrong usage."
    )]
    Diff(DiffArgs),
    /// Write the rows of a file that differ, read each back, and say what came of it
    #[command(
        after_help = "A file is taken whole or not at all. Before anything is written, what the hand holds goes into a backup. If a row is not applied, the others are put back, unless --partial is given. Nothing is in flash before 'handscope params save'.\n\nRows that say where a hand is found (hand_id, redu_ratio, ip_address) are left alone unless --only names them; hand_id and redu_ratio are changed one at a time, and the hand is looked for at the new and at the old place; a new id is refused if another hand has it. ip_address acts once it was saved and the hand was switched off and on. Such rows, and speeds and forces that hit harder than before on a stiff object, need --yes."
    )]
    Apply(ApplyArgs),
    /// Write the hand's parameters to its flash, so that it wakes up with them
    #[command(
        after_help = "A backup is made first. On RS485 the hand says how it ended; on Modbus and CAN nothing does, and that is said: there only the next power-up shows it ('handscope params diff --saved').\n\nExit status: 0 saved as far as this wire can tell; 1 failed, or not known."
    )]
    Save(FlashArgs),
    /// Return the hand to the factory's parameters
    #[command(
        after_help = "A backup is made first; 'handscope params apply' brings it back. The hand must rest. Id, serial speed and IP address become the factory's too: where the hand answers then is looked up and said."
    )]
    Reset(FlashArgs),
    /// List the backups of a hand, and what was saved last. Asks the hand nothing
    Backups(BackupsArgs),
}

/// Which hand, how it is told, and where this program's records lie.
#[derive(Debug, Args)]
pub(crate) struct Common {
    /// The hand
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Endpoint,
    /// One JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Folder of records and backups [default: params, beside the window's settings]
    #[arg(long, value_name = "DIR")]
    pub(crate) folder: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct DumpArgs {
    #[command(flatten)]
    pub(crate) common: Common,
    /// Write a parameter file
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("other").required(true).args(["file", "saved", "factory"]))]
pub(crate) struct DiffArgs {
    #[command(flatten)]
    pub(crate) common: Common,
    /// A parameter file
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// What this program saved last
    #[arg(long)]
    pub(crate) saved: bool,
    /// What the manual says of delivery
    #[arg(long)]
    pub(crate) factory: bool,
    /// Show the rows without a difference too
    #[arg(long)]
    pub(crate) all: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ApplyArgs {
    /// A parameter file; a backup is one
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) common: Common,
    /// Only this row or group, for example default_speed.index or default_force; may be given several times
    #[arg(long, value_name = "ROW", value_parser = rows)]
    pub(crate) only: Vec<Rows>,
    /// Keep the rows that were applied even if others were not
    #[arg(long)]
    pub(crate) partial: bool,
    /// You mean it, also where the hand may be found elsewhere or will hit hard
    #[arg(long)]
    pub(crate) yes: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FlashArgs {
    #[command(flatten)]
    pub(crate) common: Common,
    /// You mean it
    #[arg(long)]
    pub(crate) yes: bool,
}

#[derive(Debug, Args)]
pub(crate) struct BackupsArgs {
    #[command(flatten)]
    pub(crate) common: Common,
}

/// The rows that one name means.
#[derive(Debug, Clone)]
pub(crate) struct Rows(pub(crate) Vec<ParamId>);

fn rows(name: &str) -> Result<Rows, String> {
    let rows = ParamId::named(name);
    if rows.is_empty() {
        let all: Vec<String> = ParamId::all().into_iter().map(ParamId::name).collect();
        return Err(format!(
            "there is no such row; there are {}",
            all.join(", ")
        ));
    }
    Ok(Rows(rows))
}
