//! Simulated hands on a serial wire with private framing (manual 2.2). Opens no port.

use crate::codec::rs485::{
    READ_LEN_MAX, RequestDecoder, Rs485Frame, Rs485Request, encode_calibration_end,
    encode_read_reply, encode_save_result, encode_write_ack,
};
use crate::hand::Span;
use crate::sim::hand::SimHand;
use crate::sim::memory::AccessError;
use crate::sim::personality::{AnyId, LongRead};
use crate::sim::serve::hands::SimHands;
use crate::sim::serve::shared::SharedHand;
use crate::transport::Wire;
use std::io;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::time::{Instant, sleep, sleep_until};

/// Value in an acknowledgement (manual 2.2.2).
const ACK: u8 = 1;
/// Value that a hand might send instead to refuse a write.
// Manual: there is no negative acknowledgement.
const NAK: u8 = 0;
/// Read size: more than the longest request.
const CHUNK: usize = 512;
/// Silence after which an unfinished request is dropped: far longer than any gap between two bytes of one.
const SILENCE: Duration = Duration::from_millis(50);

/// Answers on `wire` until the other side hangs up. Ignores other ids, bad frames and ranges that the hand refuses.
pub async fn serve(hands: impl Into<SimHands>, wire: impl Wire) {
    let mut line = Rs485Server {
        hands: hands.into(),
        wire,
        decoder: RequestDecoder::default(),
    };
    // The only error is the end of the wire, which ends the server.
    let _hung_up = line.run().await;
}

struct Rs485Server<W> {
    hands: SimHands,
    wire: W,
    decoder: RequestDecoder,
}

impl<W: Wire> Rs485Server<W> {
    async fn run(&mut self) -> io::Result<()> {
        let mut chunk = [0; CHUNK];
        loop {
            let due = self.next_late_frame();
            tokio::select! {
                biased;
                () = sleep_until(due.unwrap_or_else(Instant::now)), if due.is_some() => {
                    self.send_late_frames().await?;
                }
                read = self.wire.read(&mut chunk) => match read? {
                    0 => return Ok(()),
                    len => self.receive(chunk.get(..len).unwrap_or_default()).await?,
                },
                () = sleep(SILENCE), if self.decoder.buffered() > 0 => {
                    self.decoder.flush_pending();
                    self.answer_all().await?;
                }
            }
        }
    }

    async fn receive(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            let taken = self.decoder.push(bytes);
            bytes = bytes.get(taken..).unwrap_or_default();
            self.answer_all().await?;
        }
        Ok(())
    }

    async fn answer_all(&mut self) -> io::Result<()> {
        while let Some(request) = self.decoder.next() {
            for hand in self.hands.iter() {
                let Some(frame) = answer(hand, &request) else {
                    continue;
                };
                let manner = hand.with(|hand, _| hand.manner());
                if !manner.after.is_zero() {
                    sleep(manner.after).await;
                }
                for _ in 0..manner.copies {
                    self.wire.write_all(&frame).await?;
                }
                self.wire.flush().await?;
            }
        }
        Ok(())
    }

    fn next_late_frame(&self) -> Option<Instant> {
        let due = self.hands.iter().filter_map(|hand| {
            let due = hand.with(|hand, _| {
                let two = [hand.next_save_result(), hand.next_calibration_end()];
                two.into_iter().flatten().min()
            })?;
            Some(hand.instant(due))
        });
        due.min()
    }

    async fn send_late_frames(&mut self) -> io::Result<()> {
        for hand in self.hands.iter() {
            let frame = hand.with(|hand, now| {
                let result = hand.late_save_result(now)?;
                Some(encode_save_result(hand.id(), result.command, result.ok))
            });
            if let Some(frame) = frame {
                self.wire.write_all(&frame).await?;
                self.wire.flush().await?;
            }
            let ended = hand.with(|hand, now| hand.late_calibration_end(now).then(|| hand.id()));
            if let Some(id) = ended {
                self.wire.write_all(&encode_calibration_end(id)).await?;
                self.wire.flush().await?;
            }
        }
        Ok(())
    }
}

fn answer(hand: &SharedHand, request: &Rs485Request) -> Option<Rs485Frame> {
    hand.with(|hand, now| match request {
        Rs485Request::Read { id, span } if is_meant(hand, *id) => {
            let cut = hand.personality().long_read == LongRead::Truncate;
            let len = match span.len {
                ..=READ_LEN_MAX => span.len,
                _ if cut => READ_LEN_MAX,
                _ => return None,
            };
            let bytes = hand.read(Span::new(span.address, len), now).ok()?;
            encode_read_reply(hand.id(), span.address, &bytes)
        }
        Rs485Request::Write { id, address, bytes } if is_meant(hand, *id) => {
            match hand.write(*address, bytes, now) {
                Ok(effect) => effect
                    .is_acked
                    .then(|| encode_write_ack(effect.ack_id, *address, ACK)),
                Err(AccessError::ReadOnly { .. }) => {
                    Some(encode_write_ack(hand.id(), *address, NAK))
                }
                Err(_) => None,
            }
        }
        _ => None,
    })
}

/// True if a frame to this id is for this hand.
// Manual: 2.6.1 allows ids 1 to 254, and does not define replies to 0 and 255.
fn is_meant(hand: &SimHand, id: u8) -> bool {
    let any = matches!(id, 0 | 255) && hand.personality().any_id == AnyId::Answered;
    any || id == hand.id()
}
