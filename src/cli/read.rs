//! `read`: registers by the manual's names, read one by one and decoded. Writes nothing to the hand.

use crate::cli::out::{Out, notify};
use crate::cli::parse;
use crate::cli::session::{self, ANSWER_TIMEOUT, ONLY_WHAT_IS_ASKED};
use crate::cli::value::{value_json, value_text};
use crate::hand::{Register, Span};
use crate::link::{LinkHandle, RequestError};
use crate::transport::Endpoint;
use anyhow::bail;
use serde_json::Map;
use tokio::time::timeout;

/// Bytes per request: nine stored gestures, which fit a frame of every protocol.
const PIECE: u16 = 108;

#[derive(Debug, clap::Args)]
pub(crate) struct ReadArgs {
    /// Registers by name, in any letter case
    #[arg(required = true, value_name = "NAME", value_parser = parse::register)]
    names: Vec<&'static Register>,
    /// The hand to read
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    hand: Endpoint,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Reads the registers and prints them. Fails if any could not be read.
pub(crate) async fn run(out: &mut Out, args: &ReadArgs) -> anyhow::Result<()> {
    let link = session::reach(&args.hand, ONLY_WHAT_IS_ASKED).await?;
    let mut values = Map::new();
    let mut failed = 0;
    for row in &args.names {
        let bytes = read_register(&link, row).await.unwrap_or_else(|error| {
            notify(&format!("cannot read {}: {error}", row.name));
            failed += 1;
            Vec::new()
        });
        if args.json {
            values.insert(row.name.into(), value_json(row, &bytes));
        } else if !bytes.is_empty() {
            out.line(&value_text(row, &bytes))?;
        }
    }
    if args.json {
        out.object(&values)?;
    }
    if failed > 0 {
        let all = args.names.len();
        bail!("{failed} of {all} registers could not be read");
    }
    Ok(())
}

/// Reads a register, in pieces if it is longer than a frame.
pub(crate) async fn read_register(
    link: &LinkHandle,
    row: &Register,
) -> Result<Vec<u8>, RequestError> {
    let mut bytes = Vec::new();
    let end = row.address + row.len;
    for address in (row.address..end).step_by(PIECE.into()) {
        let piece = Span::new(address, PIECE.min(end - address));
        let got = timeout(ANSWER_TIMEOUT, link.read(piece)).await;
        bytes.extend(got.unwrap_or_else(|_elapsed| {
            Err(RequestError::Timeout {
                address: row.address,
                after_ms: u64::try_from(ANSWER_TIMEOUT.as_millis()).unwrap_or(u64::MAX),
            })
        })?);
    }
    Ok(bytes)
}
