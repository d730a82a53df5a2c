//! What the link put on the wire, frame by frame, with the time; taken between the link and the faults.

use crate::setup::body::Protocol;
use crate::setup::device::crc;
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
pub(crate) struct Sent {
    pub(crate) at: Moment,
    pub(crate) address: u16,
    /// Bytes asked for; 0 for a write.
    pub(crate) len: u16,
    /// The bytes written, in memory order; `None` for a read.
    pub(crate) written: Option<Vec<u8>>,
}

impl Sent {
    /// True if the hand moves because of it.
    pub(crate) fn is_motion(&self) -> bool {
        self.written.is_some() && matches!(self.address, 1474..=1497 | 1008 | 2320 | 2322)
    }

    /// True for targets and limits.
    pub(crate) fn is_setpoint(&self) -> bool {
        self.written.is_some() && matches!(self.address, 1486..=1533)
    }

    /// Memory that it asks for; none for a write.
    pub(crate) fn asks(&self) -> Option<std::ops::Range<u16>> {
        (self.written.is_none()).then(|| self.address..self.address + self.len)
    }

    /// True if it asks for any of this.
    pub(crate) fn asks_in(&self, memory: std::ops::Range<u16>) -> bool {
        self.asks()
            .is_some_and(|asked| asked.start < memory.end && memory.start < asked.end)
    }
}

/// A lie about what was on the wire, to see that the oracles notice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Lie {
    #[default]
    None,
    /// Frames that hold are not seen.
    NoHold,
    /// Reads of fingertips are not seen.
    NoTips,
    /// Reads of fingertips are seen in front of every frame …
    TipsFirst,
    /// … of every write of targets that no stop makes …
    TipsBeforeWishes,
    /// … and of every job's read.
    TipsBeforeJobs,
    /// Angles are seen past the manual's range …
    TooFar,
    /// … and one beside what they were.
    OffPose,
}

#[derive(Clone)]
pub(crate) struct Log {
    clock: Clock,
    sent: Arc<Mutex<Vec<Sent>>>,
    lie: Lie,
}

impl Log {
    pub(crate) fn new(clock: Clock, lie: Lie) -> Self {
        Self {
            clock,
            sent: Arc::new(Mutex::new(Vec::with_capacity(1024))),
            lie,
        }
    }

    /// Everything sent, taken out.
    pub(crate) fn take(&self) -> Vec<Sent> {
        std::mem::take(&mut *self.sent.lock().unwrap())
    }

    pub(crate) fn sent(&self) -> Vec<Sent> {
        self.sent.lock().unwrap().clone()
    }

    fn note(&self, frame: &[u8], protocol: Protocol) {
        let parsed = match protocol {
            Protocol::Rs485 => Some(rs485(frame)),
            Protocol::Tcp => Some(tcp(frame)),
            Protocol::Rtu => Some(rtu(frame)),
            Protocol::Can => Some(can(frame)),
            Protocol::Slcan => slcan(frame),
        };
        let Some((address, len, written)) = parsed else {
            return;
        };
        let at = self.clock.now();
        let sent = Sent {
            at,
            address,
            len,
            written,
        };
        self.keep(sent);
    }

    fn keep(&self, mut sent: Sent) {
        let holds = sent.is_motion();
        let tips = sent.asks_in(3000..3290);
        // A stop is told to all joints.
        let wish = holds && sent.written.as_ref().is_some_and(|bytes| bytes.len() == 2);
        let job = sent.asks_in(1000..1070);
        let mut kept = self.sent.lock().unwrap();
        match self.lie {
            Lie::NoHold if holds => return,
            Lie::NoTips if tips => return,
            Lie::TipsFirst => tip_reads(&mut kept, &sent),
            Lie::TipsBeforeWishes if wish => tip_reads(&mut kept, &sent),
            Lie::TipsBeforeJobs if job => tip_reads(&mut kept, &sent),
            Lie::TooFar if holds => shift(&mut sent, 1001),
            Lie::OffPose if holds => shift(&mut sent, -1),
            _ => {}
        }
        kept.push(sent);
    }
}

/// Three, as one may have its turn.
fn tip_reads(kept: &mut Vec<Sent>, before: &Sent) {
    for _ in 0..3 {
        kept.push(Sent {
            at: before.at,
            address: 3000,
            len: 4,
            written: None,
        });
    }
}

/// Adds to all angles but those that leave a joint as it is.
fn shift(sent: &mut Sent, by: i16) {
    for pair in sent
        .written
        .iter_mut()
        .flat_map(|bytes| bytes.chunks_exact_mut(2))
    {
        let angle = i16::from_le_bytes([pair[0], pair[1]]);
        if angle > 0 {
            pair.copy_from_slice(&(angle + by).to_le_bytes());
        }
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

/// A frame of Linux's to hand 1, of the kind that the hand knows.
fn can(record: &[u8]) -> (u16, u16, Option<Vec<u8>>) {
    let (id, rest) = record.split_first_chunk().unwrap();
    let id = u32::from_ne_bytes(*id);
    let [len, 0, 0, 0, data @ ..] = rest else {
        panic!("not one whole frame: {record:02X?}")
    };
    assert_eq!((id >> 29, data.len()), (0b100, 8), "{record:02X?}");
    frame(id & 0x1FFF_FFFF, &data[..usize::from(*len)])
}

/// A line to an adapter; none for what is no frame.
fn slcan(line: &[u8]) -> Option<(u16, u16, Option<Vec<u8>>)> {
    let [b'T', digits @ .., b'\r'] = line else {
        assert!(
            [&b"\r"[..], b"O\r", b"C\r", b"S8\r"].contains(&line),
            "{line:?}"
        );
        return None;
    };
    let digits = std::str::from_utf8(digits).unwrap();
    let byte = |at: usize| u8::from_str_radix(&digits[9 + 2 * at..11 + 2 * at], 16).unwrap();
    let len: usize = digits[8..9].parse().unwrap();
    assert_eq!(digits.len(), 9 + 2 * len, "{digits}");
    let data: Vec<u8> = (0..len).map(byte).collect();
    Some(frame(u32::from_str_radix(&digits[..8], 16).unwrap(), &data))
}

fn frame(id: u32, data: &[u8]) -> (u16, u16, Option<Vec<u8>>) {
    assert_eq!(id & 0x3FFF, 1, "{id:#X}");
    let address = u16::try_from((id >> 14) & 0xFFF).unwrap();
    match (id >> 26, data) {
        (0, [len @ 1..=8]) => (address, u16::from(*len), None),
        (1, [_, ..]) => (address, 0, Some(data.to_vec())),
        _ => panic!("no such frame: {id:#X} {data:02X?}"),
    }
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
        .then(|| 2 * u16::from_be_bytes([rest[0], rest[1]]));
    (
        u16::from_be_bytes([*high, *low]),
        asked.unwrap_or(0),
        written,
    )
}

/// A wire that notes what is written to it.
pub(crate) struct Tap<W> {
    wire: W,
    log: Log,
    protocol: Protocol,
}

impl<W> Tap<W> {
    pub(crate) fn new(wire: W, log: Log, protocol: Protocol) -> Self {
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
