//! Simulated hands as a Modbus RTU server (manual 2.4). Opens no port: it is given a wire.

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

/// Bytes taken at once, and kept while a request is not whole: the longest frame, twice.
const CHUNK: usize = 512;
/// Silence after which an unfinished request is given up: far longer than any gap inside one.
const SILENCE: Duration = Duration::from_millis(50);
/// Silence behind noise after which a request is looked for again: shorter than any client's patience.
const SILENCE_AFTER_NOISE: Duration = Duration::from_millis(10);
/// The pause inside a reply of a hand that makes one: longer than the 1.5 characters that are allowed.
const PAUSE: Duration = Duration::from_millis(2);
/// Requests of functions 03 and 06: unit, function, two words, check.
const SHORT_LEN: usize = 8;
/// Of function 16 around its data: unit, function, two words, length, check.
const LONG_FRAMING: usize = 9;

/// Answers on `wire` until the other side hangs up. Silent for other ids and bad frames.
pub async fn serve(hands: impl Into<SimHands>, wire: impl Wire) {
    let mut line = RtuServer {
        hands: hands.into(),
        wire,
        held: ArrayVec::new(),
        is_noisy: false,
    };
    // The end of the wire is the only end there is, and the only error.
    let _hung_up = line.run().await;
}

struct RtuServer<W> {
    hands: SimHands,
    wire: W,
    held: ArrayVec<u8, CHUNK>,
    /// What comes is not listened to until the line is silent.
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
                    len => self.take(chunk.get(..len).unwrap_or_default()).await?,
                },
                () = sleep(silence), if self.is_noisy || !self.held.is_empty() => {
                    self.held.clear();
                    self.is_noisy = false;
                }
            }
        }
    }

    async fn take(&mut self, mut bytes: &[u8]) -> io::Result<()> {
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

    /// `frame` is a request without its check.
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

/// What stands at the front of the bytes since the last request or the last silence.
enum Front {
    /// A whole request, without its check, and its length with it.
    Request(Vec<u8>, usize),
    /// A request that is not whole yet, or nothing.
    Open,
    /// No request.
    Noise,
}

/// A request begins behind another one or behind a silence, nowhere else: the data of a longer one that was cut may look
/// like one too.
fn front(held: &[u8]) -> Front {
    let len = match held {
        [] | [_] => return Front::Open,
        [_, 16, _, _, _, _, count, ..] => LONG_FRAMING + usize::from(*count),
        [_, 16, ..] => return Front::Open,
        // Other functions have requests of their own; those without data are told that they are not known.
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
