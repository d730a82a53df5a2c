//! `overshoot`: prints, exports or clears the measured overshoot of a hand. Opens no link.

use crate::app::files::settings_file;
use crate::cli::out::{Out, WrongUsage, notify};
use crate::hand::overshoot::{MeasuredCloses, OvershootMap, Stages};
use crate::transport::Endpoint;
use crate::trials::overshoot_file;
use anyhow::Context as _;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct OvershootArgs {
    /// The hand whose trials are meant
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Also write it to this file, as a table for spreadsheets
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Forget all of it once it is printed and written
    #[arg(long)]
    pub(crate) forget: bool,
}

/// Prints the stored overshoot.
pub(crate) fn run(out: &mut Out, args: &OvershootArgs) -> anyhow::Result<()> {
    if args.hand.is_sim() {
        return Err(WrongUsage::error(
            "the built-in hand differs each time: nothing is stored for it; name the URL of a hand",
        ));
    }
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| overshoot_file::file_of(&settings, &args.hand));
    let file = file.context("no home folder to store it in")?;
    let map = match overshoot_file::read(&file) {
        Err(error) if args.forget => {
            notify(&format!("{} could not be read: {error}", file.display()));
            OvershootMap::default()
        }
        read => {
            read.with_context(|| format!("cannot read {}; --forget removes it", file.display()))?
        }
    };
    if let Some(path) = &args.out {
        std::fs::write(path, overshoot_file::csv(&map))
            .with_context(|| format!("cannot write {}; nothing was forgotten", path.display()))?;
    }
    let object = json!({ "overshoot": {
        "hand": args.hand.to_string(),
        "closes": map.closes(),
        "kinds": map.kinds(),
        "forgotten": args.forget,
    }});
    let lines = if map.is_empty() {
        vec![
            "nothing was measured of this hand: 'handscope trial' and 'handscope tune' measure it"
                .into(),
        ]
    } else {
        let head =
            "joint         stages  speed  threshold  object   closes  most over  mean over  last";
        let rows = map.kinds().iter().map(line);
        std::iter::once(head.to_owned()).chain(rows).collect()
    };
    out.result(args.json, &object, lines)?;
    out.flush()?;
    if args.forget {
        overshoot_file::forget(&file)
            .with_context(|| format!("cannot remove {}", file.display()))?;
    }
    Ok(())
}

fn line(own: &MeasuredCloses) -> String {
    let kind = own.kind;
    let stages = match kind.stages {
        Stages::One => "one",
        Stages::Two => "two",
    };
    format!(
        "{:<12}  {stages:<6}  {:5}  {:7} g  {:<7}  {:6}  {:7.0} g  {:7.0} g  {}",
        kind.dof.name(),
        kind.speed.get(),
        kind.threshold.get(),
        kind.stiffness.name(),
        own.closes,
        own.most_over_g,
        own.mean_over_g,
        own.last,
    )
}
