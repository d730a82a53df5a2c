//! Simulated hands behind the maker's own USB-CAN adapter, adapter included. Opens no port.

use crate::codec::usbcan::{PacketContent, PacketDecoder, encode};
use crate::sim::serve::can;
use crate::sim::serve::hands::SimHands;
use crate::transport::Wire;
use std::io;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

/// Bytes taken at once: many packets.
const CHUNK: usize = 512;

/// Answers on `wire` until the other side hangs up. Packets of other kinds, the adapter's settings among them, get no
/// answer: what the maker's adapter says to those is not known.
pub async fn serve(hands: impl Into<SimHands>, wire: impl Wire) {
    // The end of the wire is the only end there is, and the only error.
    let _hung_up = answer_all(&hands.into(), wire).await;
}

async fn answer_all(hands: &SimHands, mut wire: impl Wire) -> io::Result<()> {
    let mut decoder = PacketDecoder::default();
    let mut chunk = [0; CHUNK];
    loop {
        let got = wire.read(&mut chunk).await?;
        if got == 0 {
            return Ok(());
        }
        for byte in chunk.iter().take(got) {
            let Some(PacketContent::Frame(asked)) = decoder.push(*byte) else {
                continue;
            };
            for hand in hands.iter() {
                for reply in can::answer(hand, &asked).await {
                    wire.write_all(&encode(&reply)).await?;
                    wire.flush().await?;
                }
            }
        }
    }
}
