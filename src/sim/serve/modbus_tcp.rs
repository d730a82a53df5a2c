//! Simulated hands as a Modbus TCP server (manual 2.5). Binds nothing: the listener or the connection is passed in.

use crate::codec::mbap::{Adu, MbapSplitter};
use crate::sim::personality::{ReplyUnit, TcpClients};
use crate::sim::serve::hands::SimHands;
use crate::sim::serve::modbus;
use crate::transport::Wire;
use std::io;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpListener;
use tokio::task::JoinSet;
use tokio::time::sleep;

/// Concurrent clients. A real hand was seen to accept two; more lets tests and viewers connect as well.
pub const CLIENTS_MAX: usize = 16;
/// Read size: the longest request.
const CHUNK: usize = 260;
/// Exception code of a gateway whose target does not answer.
const TARGET_SILENT: u8 = 11;

/// Answers every client of `listener` until the future is dropped, which also closes all connections. A single hand answers
/// to every unit id; of several, 255 and 0 mean the first, other units the hand with that id, and a unit without a
/// hand gets the exception of a gateway whose target does not answer.
///
/// # Errors
/// Errors of the listener itself.
pub async fn serve(hands: impl Into<SimHands>, listener: TcpListener) -> io::Result<()> {
    let hands = hands.into();
    let mut clients = JoinSet::new();
    loop {
        tokio::select! {
            biased;
            Some(_ended) = clients.join_next() => {}
            accepted = listener.accept() => {
                let (stream, _peer) = accepted?;
                let most = match hands.first().with(|hand, _| hand.personality().tcp_clients) {
                    TcpClients::Many => CLIENTS_MAX,
                    TcpClients::One => 1,
                    TcpClients::Newest => {
                        clients.shutdown().await;
                        1
                    }
                };
                if clients.len() < most && stream.set_nodelay(true).is_ok() {
                    clients.spawn(serve_client(hands.clone(), stream));
                }
            }
        }
    }
}

/// Answers one client until it hangs up or sends an invalid header.
pub async fn serve_client(hands: impl Into<SimHands>, wire: impl Wire) {
    // A client's broken connection ends only that client.
    let _broken = answer_all(hands.into(), wire).await;
}

async fn answer_all(hands: SimHands, mut wire: impl Wire) -> io::Result<()> {
    let mut splitter = MbapSplitter::default();
    let mut chunk = [0; CHUNK];
    loop {
        let len = wire.read(&mut chunk).await?;
        if len == 0 {
            return Ok(());
        }
        let mut bytes = chunk.get(..len).unwrap_or_default();
        while !bytes.is_empty() {
            let taken = splitter.push(bytes);
            bytes = bytes.get(taken..).unwrap_or_default();
            while let Some(request) = splitter.next().map_err(io::Error::other)? {
                answer(&hands, &mut wire, &request).await?;
            }
        }
    }
}

async fn answer(hands: &SimHands, wire: &mut impl Wire, asked: &Adu) -> io::Result<()> {
    let Some(hand) = hands.unit(asked.unit) else {
        let refused = [asked.function() | 0x80, TARGET_SILENT];
        return wire.write_all(&asked.reply(asked.unit, &refused)).await;
    };
    let Some(reply) = modbus::answer(hand, asked.pdu()) else {
        return Ok(());
    };
    let (manner, unit) = hand.with(|hand, _| (hand.manner(), hand.personality().reply_unit));
    let unit = match unit {
        ReplyUnit::Echo => asked.unit,
        ReplyUnit::Ff => 255,
        ReplyUnit::Zero => 0,
    };
    if !manner.after.is_zero() {
        sleep(manner.after).await;
    }
    for _ in 0..manner.copies {
        wire.write_all(&asked.reply(unit, &reply)).await?;
    }
    wire.flush().await
}
