//! Simulated hands behind a simulated USB-CAN adapter of the hand's maker. Opens no port.

use crate::codec::usbcan::{PacketContent, PacketDecoder, encode};
use crate::sim::serve::can;
use crate::sim::serve::hands::SimHands;
use crate::transport::Wire;
use std::io;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

/// Read size: many packets.
const CHUNK: usize = 512;

/// Answers on `wire` until the other side hangs up. Packets of other kinds, including adapter settings, are not
/// answered: the reply of the maker's adapter is not known.
pub async fn serve(hands: impl Into<SimHands>, wire: impl Wire) {
    // The only error is the end of the wire, which ends the server.
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
