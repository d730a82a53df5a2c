//! `quirks`: differences of a hand from others, printed or written to a file. Only reads from the hand.

use crate::cli::out::Out;
use crate::cli::out::file::{check_new_file, write_file};
use crate::cli::session::{self, ONLY_WHAT_IS_ASKED};
use crate::link::quirks::baud_of_code;
use crate::link::quirks::book::{self, QuirkBook};
use crate::record::quirk_sheet::QuirkSheet;
use crate::transport::Endpoint;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct QuirksArgs {
    /// The hand to examine
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Also write the sheet to this file
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

/// Identifies the hand and prints its quirks.
pub(crate) async fn run(out: &mut Out, args: &QuirksArgs) -> anyhow::Result<()> {
    if let Some(path) = &args.out {
        check_new_file(path, "--out")?;
    }
    let link = session::reach(&args.hand, ONLY_WHAT_IS_ASKED).await?;
    let quirks = link.status().quirks;
    let sheet = book::sheet(&args.hand, &quirks, "");
    if let Some(path) = &args.out {
        write_file(path, QuirkBook::of(sheet.clone()).to_toml().as_bytes())?;
    }
    let object = json!({
        "hand": args.hand.to_string(),
        "hand_id": sheet.hand_id,
        "baud_code": sheet.baud_code,
        "packing": sheet.packing,
        "gap": sheet.gap,
        "touch": sheet.touch,
    });
    out.result(args.json, &object, lines(&args.hand, sheet))
}

fn lines(hand: &Endpoint, sheet: QuirkSheet) -> Vec<String> {
    let row = |name: &str, value: Option<String>| {
        format!("{name:<11}{}", value.unwrap_or_else(|| "unknown".into()))
    };
    let is_can = hand.is_can();
    let code = sheet.baud_code.map(|code| match baud_of_code(code, is_can) {
        Some(baud) => format!(
            "{code} ({baud} by the manual PRJ-02-TS-U-001 V1.0.0; other editions number differently)"
        ),
        None => format!("{code} (no meaning in the manual PRJ-02-TS-U-001 V1.0.0)"),
    });
    let is_packed = matches!(
        hand,
        Endpoint::Tcp { .. } | Endpoint::Rtu(_) | Endpoint::RtuTcp(_)
    );
    let packing = is_packed.then(|| row("packing", sheet.packing));
    let head = [
        row("hand", Some(hand.to_string())),
        row("HAND_ID", sheet.hand_id.map(|id| id.to_string())),
        row("REDU_RATIO", code),
    ];
    let gap = (!is_can).then(|| row("gap", sheet.gap));
    let touch = [row("touch", sheet.touch)];
    let rows = head.into_iter().chain(packing).chain(gap).chain(touch);
    rows.collect()
}
