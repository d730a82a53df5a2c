//! `doctor`: diagnoses a hand and the connection to it, and says what to do. Only reads.

mod checkup;
mod findings;
mod json;
mod measure;
mod text;

use crate::cli::out::Out;
use crate::cli::parse::seconds;
use crate::transport::Endpoint;
use anyhow::bail;
use std::time::Duration;

#[derive(Debug, clap::Args)]
pub(crate) struct DoctorArgs {
    /// The hand to examine
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Endpoint,
    /// Seconds to measure once it answers
    #[arg(long = "for", value_name = "SECONDS", default_value = "5", value_parser = seconds)]
    pub(crate) length: Duration,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Runs a check-up and prints it. Fails if something is wrong.
pub(crate) async fn run(out: &mut Out, args: &DoctorArgs) -> anyhow::Result<()> {
    let checkup = measure::check(&args.hand, args.length).await?;
    let found = findings::judge(&checkup);
    let object = json::object(&checkup, &found);
    out.result(args.json, &object, text::lines(&checkup, &found))?;
    match found.iter().filter(|finding| finding.is_wrong).count() {
        0 => Ok(()),
        1 => bail!("one thing is wrong with {}", args.hand),
        count => bail!("{count} things are wrong with {}", args.hand),
    }
}
