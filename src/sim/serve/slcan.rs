//! Simulated hands behind a simulated serial CAN adapter (Lawicel protocol). Opens no port.

use crate::codec::can::CanFrame;
use crate::codec::slcan::{BITRATES, CommandDecoder, SlcanAnswer, SlcanCommand, encode_answer};
use crate::sim::serve::can;
use crate::sim::serve::hands::SimHands;
use crate::transport::Wire;
use std::io;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

/// Read size: many commands.
const CHUNK: usize = 512;
/// Factory bit rate of a hand (manual 2.3) …
const HAND_BITRATE: u32 = 1_000_000;
/// … and the matching timing registers, from the adapters' manual.
const HAND_TIMING: u16 = 0x0014;
/// Acknowledgement of a sent frame with an 11-bit id.
const SENT_SHORT: &[u8] = b"z\r";
/// Adapter identification, as from known adapters.
const VERSION: &[u8] = b"V1013\r";
const SERIAL: &[u8] = b"NSIM1\r";
const FLAGS: &[u8] = b"F00\r";

/// Answers on `wire` until the other side hangs up. At any bit rate other than the hand's the bus is empty.
pub async fn serve(hands: impl Into<SimHands>, wire: impl Wire) {
    let mut adapter = SlcanServer {
        hands: hands.into(),
        wire,
        mode: Mode::Closed,
        bitrate: Some(HAND_BITRATE),
    };
    // The only error is the end of the wire, which ends the server.
    let _hung_up = adapter.run().await;
}

/// Mode of the adapter on the bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Closed,
    Open,
    Listening,
}

struct SlcanServer<W> {
    hands: SimHands,
    wire: W,
    mode: Mode,
    /// `None` if it was set by timing registers that are not the hand's.
    bitrate: Option<u32>,
}

impl<W: Wire> SlcanServer<W> {
    async fn run(&mut self) -> io::Result<()> {
        let mut decoder = CommandDecoder::default();
        let mut chunk = [0; CHUNK];
        loop {
            let got = self.wire.read(&mut chunk).await?;
            if got == 0 {
                return Ok(());
            }
            for byte in chunk.iter().take(got) {
                match decoder.push(*byte) {
                    None => {}
                    Some(Ok(command)) => self.execute(command).await?,
                    Some(Err(_unreadable)) => self.reply(&SlcanAnswer::Failed).await?,
                }
            }
            self.wire.flush().await?;
        }
    }

    async fn execute(&mut self, command: SlcanCommand) -> io::Result<()> {
        let allowed = match &command {
            SlcanCommand::Open
            | SlcanCommand::Listen
            | SlcanCommand::Bitrate(_)
            | SlcanCommand::Timing(_) => self.mode == Mode::Closed,
            SlcanCommand::Close => self.mode != Mode::Closed,
            SlcanCommand::Send(_) | SlcanCommand::SendOther(_) => self.mode == Mode::Open,
            SlcanCommand::Other(_) => true,
        };
        if !allowed {
            return self.reply(&SlcanAnswer::Failed).await;
        }
        match command {
            SlcanCommand::Open => self.mode = Mode::Open,
            SlcanCommand::Listen => self.mode = Mode::Listening,
            SlcanCommand::Close => self.mode = Mode::Closed,
            SlcanCommand::Bitrate(code) => self.bitrate = BITRATES.get(usize::from(code)).copied(),
            SlcanCommand::Timing(registers) => {
                self.bitrate = (registers == HAND_TIMING).then_some(HAND_BITRATE);
            }
            SlcanCommand::Other(b'V') => return self.wire.write_all(VERSION).await,
            SlcanCommand::Other(b'N') => return self.wire.write_all(SERIAL).await,
            SlcanCommand::Other(b'F') => return self.wire.write_all(FLAGS).await,
            SlcanCommand::Other(_) => {}
            // Hands do not know such frames (manual 2.3): they are sent and remain unanswered.
            SlcanCommand::SendOther(b'R') => return self.reply(&SlcanAnswer::Sent).await,
            SlcanCommand::SendOther(_) => return self.wire.write_all(SENT_SHORT).await,
            SlcanCommand::Send(frame) => {
                self.reply(&SlcanAnswer::Sent).await?;
                return self.put_on_the_bus(&frame).await;
            }
        }
        self.reply(&SlcanAnswer::Done).await
    }

    async fn put_on_the_bus(&mut self, frame: &CanFrame) -> io::Result<()> {
        if self.bitrate != Some(HAND_BITRATE) {
            return Ok(());
        }
        let hands = self.hands.clone();
        for hand in hands.iter() {
            for reply in can::answer(hand, frame).await {
                self.reply(&SlcanAnswer::Frame(reply)).await?;
            }
        }
        Ok(())
    }

    async fn reply(&mut self, answer: &SlcanAnswer) -> io::Result<()> {
        match encode_answer(answer) {
            Some(line) => self.wire.write_all(&line).await,
            None => Ok(()),
        }
    }
}
