//! Simulated hands as a Modbus RTU server (manual 2.4). Opens no port: the wire is passed in.

use crate::codec::modbus_rtu::crc16;
use crate::sim::personality::RtuReplyGap;
use crate::sim::serve::hands::SimHands;
use crate::sim::serve::modbus;
use crate::transport::Wire;
use arrayvec::ArrayVec;
use std::io;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::time::sleep;

/// Read size, and capacity for an incomplete request: twice the longest frame.
const CHUNK: usize = 512;
/// Silence after which an unfinished request is dropped: far longer than any gap inside one.
const SILENCE: Duration = Duration::from_millis(50);
/// Silence after noise before the server searches for a request again: shorter than any client's timeout.
const SILENCE_AFTER_NOISE: Duration = Duration::from_millis(10);
/// Pause inside a split reply: longer than the 1.5 characters that are allowed.
const PAUSE: Duration = Duration::from_millis(2);
/// Length of requests with functions 03 and 06: unit, function, two words, check.
const SHORT_LEN: usize = 8;
/// Length of a function 16 request without its data: unit, function, two words, length, check.
const LONG_FRAMING: usize = 9;

/// Answers on `wire` until the other side hangs up. Ignores other ids and bad frames.
pub async fn serve(hands: impl Into<SimHands>, wire: impl Wire) {
    let mut line = RtuServer {
        hands: hands.into(),
        wire,
        held: ArrayVec::new(),
        is_noisy: false,
    };
    // The only error is the end of the wire, which ends the server.
    let _hung_up = line.run().await;
}

struct RtuServer<W> {
    hands: SimHands,
    wire: W,
    held: ArrayVec<u8, CHUNK>,
    /// Input is discarded until the line is silent.
    is_noisy: bool,
}

impl<W: Wire> RtuServer<W> {
    async fn run(&mut self) -> io::Result<()> {
        let mut chunk = [0; CHUNK];
        loop {
            let silence = if self.is_noisy {
                SILENCE_AFTER_NOISE
            } else {
                SILENCE
            };
            tokio::select! {
                biased;
                read = self.wire.read(&mut chunk) => match read? {
                    0 => return Ok(()),
                    len => self.receive(chunk.get(..len).unwrap_or_default()).await?,
                },
                () = sleep(silence), if self.is_noisy || !self.held.is_empty() => {
                    self.held.clear();
                    self.is_noisy = false;
                }
            }
        }
    }

    async fn receive(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() && !self.is_noisy {
            let (now, later) = bytes.split_at(bytes.len().min(self.held.remaining_capacity()));
            self.held.extend(now.iter().copied());
            bytes = later;
            while let Front::Request(frame, used) = front(&self.held) {
                self.held.drain(..used);
                self.answer(&frame).await?;
            }
            self.is_noisy = matches!(front(&self.held), Front::Noise);
        }
        Ok(())
    }

    /// Answers `frame`, a request without its check.
    async fn answer(&mut self, frame: &[u8]) -> io::Result<()> {
        let Some((unit, request)) = frame.split_first() else {
            return Ok(());
        };
        let mut hands = self.hands.iter();
        let meant = hands.find(|hand| hand.with(|hand, _| hand.id()) == *unit);
        let Some(hand) = meant else { return Ok(()) };
        let Some(reply) = modbus::answer(hand, request) else {
            return Ok(());
        };
        let (manner, gap) = hand.with(|hand, _| (hand.manner(), hand.personality().rtu_reply));
        let mut reply = [&[*unit][..], &reply].concat();
        reply.extend(crc16(&reply).to_le_bytes());
        if !manner.after.is_zero() {
            sleep(manner.after).await;
        }
        for _ in 0..manner.copies {
            let half = match gap {
                RtuReplyGap::Whole => reply.len(),
                RtuReplyGap::Split => reply.len() / 2,
            };
            let (first, rest) = reply.split_at(half);
            self.wire.write_all(first).await?;
            if !rest.is_empty() {
                self.wire.flush().await?;
                sleep(PAUSE).await;
                self.wire.write_all(rest).await?;
            }
            self.wire.flush().await?;
        }
        Ok(())
    }
}

/// Content at the front of the bytes received since the last request or silence.
enum Front {
    /// A complete request without its check, and the length including the check.
    Request(Vec<u8>, usize),
    /// An incomplete request, or nothing.
    Open,
    /// Not a request.
    Noise,
}

/// Classifies the buffered bytes. A request begins after another one or after a silence, nowhere else: the data of a longer,
/// truncated one may look like a request, too.
fn front(held: &[u8]) -> Front {
    let len = match held {
        [] | [_] => return Front::Open,
        [_, 16, _, _, _, _, count, ..] => LONG_FRAMING + usize::from(*count),
        [_, 16, ..] => return Front::Open,
        // Other functions have their own formats; those without data get the exception for an unknown function.
        [_, 1..=0x7F, ..] => SHORT_LEN,
        _ => return Front::Noise,
    };
    match held.get(..len).and_then(<[u8]>::split_last_chunk) {
        None => Front::Open,
        Some((body, check)) if crc16(body).to_le_bytes() == *check => {
            Front::Request(body.to_vec(), len)
        }
        Some(_) => Front::Noise,
    }
}
