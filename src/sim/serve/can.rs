//! Simulated hands on a CAN bus (manual 2.3), over a wire of Linux's 16-byte frames. Opens no interface.

use crate::codec::can::{
    CanFrame, CanFunction, CanId, CanRecord, PIECE_MAX, RECORD_LEN, frame, from_record, to_record,
};
use crate::hand::Span;
use crate::sim::memory::AccessError;
use crate::sim::serve::hands::SimHands;
use crate::sim::serve::shared::SharedHand;
use crate::transport::Wire;
use arrayvec::ArrayVec;
use std::io;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::sleep;

/// Data byte of the reply to a write.
// Manual: 2.3.2 gives its length, 1, but not its content. One record of a sister hand shows 8 after a write of 8 bytes.
const ACK: u8 = 1;
/// Data byte that a hand might send instead to refuse a write.
const NAK: u8 = 0;

/// Answers on `wire` until it ends. Ignores other ids, other kinds of frames and ranges that the hand refuses.
///
/// # Errors
/// The error that ended the wire; `UnexpectedEof` if the other side closed it.
pub async fn serve(hands: impl Into<SimHands>, mut wire: impl Wire) -> io::Result<()> {
    let hands = hands.into();
    let mut record = [0; RECORD_LEN];
    loop {
        wire.read_exact(&mut record).await?;
        let CanRecord::Frame(asked) = from_record(&record) else {
            continue;
        };
        for hand in hands.iter() {
            for reply in answer(hand, &asked).await {
                wire.write_all(&to_record(&reply)).await?;
                wire.flush().await?;
            }
        }
    }
}

/// Replies of one hand to a frame, after its turnaround: none, or one reply once or twice.
pub(crate) async fn answer(hand: &SharedHand, asked: &CanFrame) -> ArrayVec<CanFrame, 2> {
    let Some(reply) = reply(hand, asked) else {
        return ArrayVec::new();
    };
    let manner = hand.with(|hand, _| hand.manner());
    if !manner.after.is_zero() {
        sleep(manner.after).await;
    }
    std::iter::repeat_n(reply, manner.copies.min(2)).collect()
}

fn reply(hand: &SharedHand, asked: &CanFrame) -> Option<CanFrame> {
    let CanId {
        way,
        address,
        hand: id,
    } = CanId::from_raw(asked.id)?;
    hand.with(|hand, now| {
        if id != u16::from(hand.id()) {
            return None;
        }
        match (way, asked.data.as_slice()) {
            (CanFunction::Read, [len]) => {
                let span = Span::new(address, u16::from(*len));
                if span.len > PIECE_MAX {
                    return None;
                }
                let bytes = hand.read(span, now).ok()?;
                frame(way, id, address, &bytes)
            }
            (CanFunction::Write, bytes @ [_, ..]) => {
                // Late frames with the result of a SAVE or a calibration exist on the serial line only.
                let effect = match hand.write_quietly(address, bytes, now) {
                    Ok(effect) => effect,
                    Err(AccessError::ReadOnly { .. }) => return frame(way, id, address, &[NAK]),
                    Err(_) => return None,
                };
                if !effect.is_acked {
                    return None;
                }
                frame(way, u16::from(effect.ack_id), address, &[ACK])
            }
            _ => None,
        }
    })
}
