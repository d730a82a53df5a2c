//! `quirks`: what a hand is found to do in its own way, printed or written to a file. Reads only; keeps nothing.

use crate::app::QuirkSheet;
use crate::app::quirk_sheet::{gap_name, packing_name, touch_name};
use crate::cli::out::Out;
use crate::cli::session;
use crate::link::quirks::baud_of_code;
use crate::link::{Clock, PollRates, Quirks};
use crate::transport::Endpoint;
use anyhow::Context as _;
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;

/// The link asks for nothing once it knows the hand.
const NOTHING_MORE: PollRates = PollRates {
    state_hz: 0.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

#[derive(Debug, Args)]
pub(crate) struct QuirksArgs {
    /// The hand to get to know
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Endpoint,
    /// One JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Write the sheet to this file too
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

/// Gets to know the hand and prints what was found.
pub(crate) fn run(out: &mut Out, args: &QuirksArgs) -> anyhow::Result<()> {
    let quirks = session::runtime()?.block_on(async {
        let link = session::open(&args.hand, NOTHING_MORE, Clock::start());
        session::answered(&link, &args.hand).await?;
        anyhow::Ok(link.status().quirks)
    })?;
    if let Some(path) = &args.out {
        let sheet = QuirkSheet::new(&args.hand, &quirks, "");
        std::fs::write(path, sheet.to_toml())
            .with_context(|| format!("cannot write {}", path.display()))?;
    }
    if args.json {
        return out.line(&object(&args.hand, &quirks).to_string());
    }
    for line in lines(&args.hand, &quirks) {
        out.line(&line)?;
    }
    Ok(())
}

fn object(hand: &Endpoint, quirks: &Quirks) -> Value {
    json!({
        "hand": hand.to_string(),
        "hand_id": quirks.hand_id,
        "baud_code": quirks.baud_code,
        "packing": quirks.packing.map(packing_name),
        "gap": quirks.gap.map(gap_name),
        "touch": quirks.touch.map(touch_name),
    })
}

fn lines(hand: &Endpoint, quirks: &Quirks) -> Vec<String> {
    let number = |value: Option<u8>| value.map_or("unknown".into(), |value| value.to_string());
    let word = |value: Option<&'static str>| value.unwrap_or("unknown").to_owned();
    let is_can = matches!(hand, Endpoint::Can { .. } | Endpoint::Slcan { .. });
    let meant = quirks
        .baud_code
        .map(|code| match baud_of_code(code, is_can) {
            Some(baud) => format!(
                " ({baud} by the manual PRJ-02-TS-U-001 V1.0.0; other editions number differently)"
            ),
            None => " (no meaning in the manual PRJ-02-TS-U-001 V1.0.0)".into(),
        });
    let mut lines = vec![
        format!("hand       {hand}"),
        format!("HAND_ID    {}", number(quirks.hand_id)),
        format!(
            "REDU_RATIO {}{}",
            number(quirks.baud_code),
            meant.unwrap_or_default()
        ),
    ];
    if matches!(hand, Endpoint::Tcp { .. } | Endpoint::Rtu(_)) {
        lines.push(format!(
            "packing    {}",
            word(quirks.packing.map(packing_name))
        ));
    }
    lines.push(format!("gap        {}", word(quirks.gap.map(gap_name))));
    lines.push(format!("touch      {}", word(quirks.touch.map(touch_name))));
    lines
}
