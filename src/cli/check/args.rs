//! The command line of `check` as clap sees it.

use crate::transport::Endpoint;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Move the hand: it is empty, nothing is in its way, and the 24 V switch is in reach
    #[arg(long)]
    pub(crate) arm: bool,
    /// Ask for a press of each fingertip, once the hand is at rest and not armed
    #[arg(long)]
    pub(crate) press: bool,
    /// Write the report as report.html and check.json, and the recording check.mcap, to this folder, which must be new or empty
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Folder of earlier check-ups, one file for each hand [default: beside the settings]
    #[arg(long, value_name = "DIR")]
    pub(crate) folder: Option<PathBuf>,
    /// Folder of recordings, from which hours in use, closes and stalls are counted [default: as in the window]
    #[arg(long, value_name = "DIR")]
    pub(crate) recordings: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}
