//! `read`: registers by the manual's names, asked one by one and decoded. Writes nothing to the hand.

use crate::cli::args::ReadArgs;
use crate::cli::out::{Out, say};
use crate::cli::session::{self, ANSWER_WITHIN};
use crate::cli::value::{value_json, value_text};
use crate::hand::{Register, Span};
use crate::link::{
    Clock, LinkEvent, LinkHandle, Outcome, PollRates, Request, RequestError, Ticket,
};
use anyhow::bail;
use serde_json::{Map, Value};
use tokio::time::timeout;

/// The link asks for nothing by itself: the line belongs to the registers that were named.
const ONLY_WHAT_IS_ASKED: PollRates = PollRates {
    state_hz: 0.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

/// Bytes asked for at once: nine stored gestures, which fit a frame of every protocol.
const PIECE: u16 = 108;

/// Reads the registers and prints them. Fails if any could not be read.
pub(crate) fn run(out: &mut Out, args: ReadArgs) -> anyhow::Result<()> {
    session::runtime()?.block_on(read(out, &args))
}

async fn read(out: &mut Out, args: &ReadArgs) -> anyhow::Result<()> {
    let mut link = session::open(&args.hand, ONLY_WHAT_IS_ASKED, Clock::start());
    session::answered(&link, &args.hand).await?;
    let mut values = Map::new();
    let mut failed = 0;
    for row in &args.names {
        let bytes = match ask(&mut link, row).await {
            Ok(bytes) => bytes,
            Err(error) => {
                say(&format!("cannot read {}: {error}", row.name));
                failed += 1;
                Vec::new()
            }
        };
        if args.json {
            values.insert(row.name.into(), value_json(row, &bytes));
        } else if !bytes.is_empty() {
            out.line(&value_text(row, &bytes))?;
        }
    }
    if args.json {
        out.line(&Value::Object(values).to_string())?;
    }
    if failed > 0 {
        bail!(
            "{failed} of {} registers could not be read",
            args.names.len()
        );
    }
    Ok(())
}

/// Reads a register, in pieces if it is longer than a frame.
async fn ask(link: &mut LinkHandle, row: &Register) -> Result<Vec<u8>, RequestError> {
    let mut bytes = Vec::new();
    while let Some(left) = usize::from(row.len)
        .checked_sub(bytes.len())
        .filter(|left| *left > 0)
    {
        let done = row.len - u16::try_from(left).unwrap_or(row.len);
        let piece = Span::new(row.address + done, PIECE.min(row.len - done));
        let got = ask_piece(link, row, piece).await?;
        if got.is_empty() {
            break;
        }
        bytes.extend(got);
    }
    Ok(bytes)
}

async fn ask_piece(
    link: &mut LinkHandle,
    row: &Register,
    piece: Span,
) -> Result<Vec<u8>, RequestError> {
    let ticket = link.ask(Request::Read(piece))?;
    match timeout(ANSWER_WITHIN, end_of(link, ticket)).await {
        Ok(end) => end,
        Err(_elapsed) => Err(RequestError::Timeout {
            address: row.address,
            after_ms: u64::try_from(ANSWER_WITHIN.as_millis()).unwrap_or(u64::MAX),
        }),
    }
}

async fn end_of(link: &mut LinkHandle, asked: Ticket) -> Result<Vec<u8>, RequestError> {
    while let Some(event) = link.event().await {
        match event {
            LinkEvent::Done { ticket, result } if ticket == asked => {
                return match result? {
                    Outcome::Memory { bytes, .. } => Ok(bytes),
                    _ => Ok(Vec::new()),
                };
            }
            _ => {}
        }
    }
    Err(RequestError::LinkLost)
}
