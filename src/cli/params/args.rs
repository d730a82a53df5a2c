//! The command line of `params` as clap sees it, and what follows from it alone. Reaches no hand.

use crate::app::files::settings_file;
use crate::cli::out::WrongUsage;
use crate::params::backups::{Backups, folder_beside};
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::transport::Endpoint;
use anyhow::Context as _;
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
    /// Compare the hand's parameters with a file, the last save, or the factory values
    #[command(
        after_help = "Exit status: 0 no difference; 1 differences, or something could not be read; 2 wrong usage."
    )]
    Diff(DiffArgs),
    /// Write the rows of a file that differ, read each back, and report the outcome
    #[command(
        after_help = "A file is applied completely or not at all. A backup is made before anything is written. If a row cannot be applied, the others are restored, unless --partial is given. Nothing is in flash before 'handscope params save'.\n\nThe rows that decide where a hand answers (hand_id, redu_ratio, ip_address) are unchanged unless --only names them. hand_id and redu_ratio are changed one at a time, and the hand is then looked for at its new and its old place; a new id is refused if another hand has it. ip_address takes effect after a save and a power cycle. These rows, and speeds and forces that hit harder than before on a stiff object, need --yes."
    )]
    Apply(ApplyArgs),
    /// Write the hand's parameters to its flash, so that it starts with them
    #[command(
        after_help = "A backup is made first. On RS485 the hand reports the result; on Modbus and CAN it does not, and only the next power-up shows it ('handscope params diff --saved').\n\nExit status: 0 saved as far as this wire can tell; 1 failed, or not known."
    )]
    Save(FlashArgs),
    /// Return the hand to its factory parameters
    #[command(
        after_help = "A backup is made first; 'handscope params apply' restores it. The hand must be at rest. Id, serial speed and IP address return to their factory values too; the hand is then looked for, and its address printed.\n\nExit status: 0 reset and read back; 1 failed, ignored, or not known."
    )]
    Reset(FlashArgs),
    /// List the backups of a hand and its last save, without asking the hand
    Backups(Common),
}

/// The hand, the form of the output, and the folder of this program's records.
#[derive(Debug, Args)]
pub(crate) struct Common {
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Folder of records and backups [default: params, beside the window's settings]
    #[arg(long, value_name = "DIR")]
    pub(crate) folder: Option<PathBuf>,
}

impl Common {
    /// This program's files of the hand.
    pub(crate) fn backups(&self) -> anyhow::Result<Backups> {
        let beside_settings = || settings_file::default_path().as_deref().map(folder_beside);
        let folder = self.folder.clone().or_else(beside_settings);
        let folder =
            folder.context("no home folder for records and backups: name one with --folder")?;
        Ok(Backups::new(&folder, &self.hand))
    }
}

#[derive(Debug, Args)]
pub(crate) struct DumpArgs {
    #[command(flatten)]
    pub(crate) common: Common,
    /// Write a parameter file, which must not be there yet
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
    /// Compare with what this program saved last
    #[arg(long)]
    pub(crate) saved: bool,
    /// Compare with the factory values in the manual
    #[arg(long)]
    pub(crate) factory: bool,
    /// Also show rows that do not differ
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
    /// Only this row or group, for example default_speed.index or default_force; may be repeated
    #[arg(long, value_name = "ROW", value_parser = rows)]
    pub(crate) only: Vec<RowNames>,
    /// Keep the rows that were applied even if others fail
    #[arg(long)]
    pub(crate) partial: bool,
    /// Confirm changes of where the hand answers, and settings that hit hard
    #[arg(long)]
    pub(crate) yes: bool,
}

impl ApplyArgs {
    /// Rows of a file to write: those that --only names, else all except address rows.
    pub(crate) fn chosen(&self, params: &Params) -> Params {
        let is_named = |id| self.only.iter().any(|rows| rows.0.contains(&id));
        params.only(|id| {
            if self.only.is_empty() {
                !id.is_place()
            } else {
                is_named(id)
            }
        })
    }
}

#[derive(Debug, Args)]
pub(crate) struct FlashArgs {
    #[command(flatten)]
    pub(crate) common: Common,
    /// Confirm
    #[arg(long)]
    pub(crate) yes: bool,
}

impl FlashArgs {
    /// Refuses without --yes; `what` describes the effect.
    pub(crate) fn consented(&self, what: &str) -> anyhow::Result<()> {
        if self.yes {
            Ok(())
        } else {
            Err(WrongUsage::error(format!(
                "{what}: add --yes to confirm; nothing was written"
            )))
        }
    }
}

/// Rows that a name refers to.
#[derive(Debug, Clone)]
pub(crate) struct RowNames(pub(crate) Vec<ParamId>);

fn rows(name: &str) -> Result<RowNames, String> {
    let rows = ParamId::named(name);
    if rows.is_empty() {
        let all: Vec<String> = ParamId::all().into_iter().map(ParamId::name).collect();
        return Err(format!(
            "there is no such row; the rows are {}",
            all.join(", ")
        ));
    }
    Ok(RowNames(rows))
}
