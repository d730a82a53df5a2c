//! What the link put on the wire, frame by frame, with the time; taken between the link and the faults.

use crate::device::{Protocol, crc};
use handscope::hand::Moment;
use handscope::link::Clock;
use handscope::transport::Wire;
use std::io;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

/// One request as it left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sent {
    pub at: Moment,
    pub address: u16,
    /// Bytes or words asked for; 0 for a write.
    pub len: u16,
    /// The bytes written, in memory order; `None` for a read.
    pub written: Option<Vec<u8>>,
}

impl Sent {
    /// True if the hand moves because of it.
    pub fn is_motion(&self) -> bool {
        self.written.is_some() && matches!(self.address, 1474..=1497 | 1008 | 2320 | 2322)
    }
}

#[derive(Clone)]
pub struct Log {
    clock: Clock,
    sent: Arc<Mutex<Vec<Sent>>>,
}

impl Log {
    pub fn new(clock: Clock) -> Self {
        Self {
            clock,
            sent: Arc::default(),
        }
    }

    pub fn sent(&self) -> Vec<Sent> {
        self.sent.lock().unwrap().clone()
    }

    fn note(&self, frame: &[u8], protocol: Protocol) {
        let at = self.clock.now();
        let (address, len, written) = match protocol {
            Protocol::Rs485 => rs485(frame),
            Protocol::Tcp => tcp(frame),
            Protocol::Rtu => rtu(frame),
        };
        self.sent.lock().unwrap().push(Sent {
            at,
            address,
            len,
            written,
        });
    }
}

fn rs485(frame: &[u8]) -> (u16, u16, Option<Vec<u8>>) {
    let [0xEB, 0x90, 1, len, command, low, high, data @ .., _sum] = frame else {
        panic!("not one whole request: {frame:02X?}")
    };
    assert_eq!(usize::from(*len), data.len() + 3);
    let written = match command {
        0x11 => None,
        0x12 => Some(data.to_vec()),
        other => panic!("command {other:#X}"),
    };
    let asked = written.is_none().then(|| u16::from(data[0]));
    (
        u16::from_le_bytes([*low, *high]),
        asked.unwrap_or(0),
        written,
    )
}

fn tcp(frame: &[u8]) -> (u16, u16, Option<Vec<u8>>) {
    let [_, _, 0, 0, _, _, 255, pdu @ ..] = frame else {
        panic!("not one whole request: {frame:02X?}")
    };
    modbus(pdu)
}

fn rtu(frame: &[u8]) -> (u16, u16, Option<Vec<u8>>) {
    let (body, check) = frame.split_last_chunk().unwrap();
    assert_eq!(crc(body), *check, "{frame:02X?}");
    assert_eq!(body[0], 1, "{frame:02X?}");
    modbus(&body[1..])
}

fn modbus(pdu: &[u8]) -> (u16, u16, Option<Vec<u8>>) {
    let [function, high, low, rest @ ..] = pdu else {
        panic!("not one whole request: {pdu:02X?}")
    };
    let written = match function {
        3 => None,
        6 => Some(vec![rest[1]]),
        16 => Some(
            rest[3..]
                .chunks(2)
                .flat_map(|pair| [pair[1], pair[0]])
                .collect(),
        ),
        other => panic!("function {other}"),
    };
    let asked = written
        .is_none()
        .then(|| u16::from_be_bytes([rest[0], rest[1]]));
    (
        u16::from_be_bytes([*high, *low]),
        asked.unwrap_or(0),
        written,
    )
}

/// A wire that notes what is written to it.
pub struct Tap<W> {
    wire: W,
    log: Log,
    protocol: Protocol,
}

impl<W> Tap<W> {
    pub fn new(wire: W, log: Log, protocol: Protocol) -> Self {
        Self {
            wire,
            log,
            protocol,
        }
    }
}

impl<W: Wire> AsyncRead for Tap<W> {
    fn poll_read(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        into: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().wire).poll_read(cx, into)
    }
}

impl<W: Wire> AsyncWrite for Tap<W> {
    fn poll_write(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let this = self.get_mut();
        let written = Pin::new(&mut this.wire).poll_write(cx, bytes);
        if let Poll::Ready(Ok(len)) = written {
            assert_eq!(len, bytes.len(), "the pipe takes a frame whole");
            this.log.note(bytes, this.protocol);
        }
        written
    }

    fn poll_flush(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().wire).poll_flush(cx)
    }

    fn poll_shutdown(self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().wire).poll_shutdown(cx)
    }
}
