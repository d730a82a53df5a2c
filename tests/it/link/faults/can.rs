//! A hand on a CAN bus (manual 2.3), behind Linux's frames or behind a serial adapter's text. Written by hand here, not
//! by our codec.

use crate::setup::body::{Adapter, Quirks, memory};
use handscope::hand::Span;
use handscope::sim::SharedHand;
use handscope::transport::Wire;
use std::sync::Arc;
use tokio::io::{AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::sync::Mutex;
use tokio::time::{Duration, sleep};

const EXTENDED: u32 = 0x8000_0000;
const ERROR: u32 = 0x2000_0000;

/// A frame: identifier and data.
type Frame = (u32, Vec<u8>);

/// What hand 1 answers; none to others and to what it does not know.
fn answer(hand: &SharedHand, quirks: &Quirks, (id, data): &Frame) -> Option<Frame> {
    let address = u16::try_from((id >> 14) & 0xFFF).unwrap();
    if id & 0x3FFF != 1 {
        return None;
    }
    let reply = match (id >> 26, &data[..]) {
        (0, [len @ 1..=8]) => memory(hand, quirks, Span::new(address, u16::from(*len)))?,
        (1, bytes @ [_, ..]) => {
            hand.with(|hand, now| hand.write(address, bytes, now))
                .ok()?;
            vec![1]
        }
        _ => return None,
    };
    Some((*id, reply))
}

/// What became of a reply: how many at once, and one more after a while, in front of what comes later or behind it.
struct Fate {
    copies: usize,
    again_after: Option<Duration>,
}

const ONCE: Fate = Fate {
    copies: 1,
    again_after: None,
};

/// Now and then a reply is late, lost or doubled; a receiver that missed the end of a frame makes the controller send it
/// again at once, be it behind a frame that won the bus.
async fn fate(struck: bool, rng: &mut fastrand::Rng) -> Fate {
    if !struck {
        return ONCE;
    }
    match rng.u8(..4) {
        0 => {
            sleep(Duration::from_millis(rng.u64(60..900))).await;
            ONCE
        }
        1 => Fate { copies: 0, ..ONCE },
        2 => Fate { copies: 2, ..ONCE },
        _ => Fate {
            again_after: Some(Duration::from_millis(rng.u64(1..4))),
            ..ONCE
        },
    }
}

/// Writes bytes now or later; whether the wire took them does not matter to a bus.
async fn put(
    to: &Arc<Mutex<impl AsyncWrite + Unpin + Send + 'static>>,
    bytes: Vec<u8>,
    fate: &Fate,
) {
    for _ in 0..fate.copies {
        let _gone = to.lock().await.write_all(&bytes).await;
    }
    if let Some(after) = fate.again_after {
        let to = Arc::clone(to);
        tokio::spawn(async move {
            sleep(after).await;
            let _gone = to.lock().await.write_all(&bytes).await;
        });
    }
}

/// The hand on Linux's frames.
pub(crate) async fn records(hand: SharedHand, wire: impl Wire, quirks: Quirks, seed: u64) {
    let mut rng = fastrand::Rng::with_seed(seed);
    let (mut from, to) = tokio::io::split(wire);
    let to = Arc::new(Mutex::new(to));
    let mut record = [0; 16];
    while from.read_exact(&mut record).await.is_ok() {
        let id = u32::from_ne_bytes([record[0], record[1], record[2], record[3]]);
        assert_eq!(id & !0x1FFF_FFFF, EXTENDED, "{record:02X?}");
        let asked = (
            id & 0x1FFF_FFFF,
            record[8..8 + usize::from(record[4])].to_vec(),
        );
        let Some(reply) = answer(&hand, &quirks, &asked) else {
            continue;
        };
        sleep(quirks.turnaround).await;
        let struck = quirks.strike(&mut rng);
        let company = struck && rng.bool();
        if company {
            let bus_off = rng.u8(..16) == 0;
            let bytes = if bus_off {
                trouble(0x40, 0).to_vec()
            } else {
                others(&mut rng, &reply)
            };
            put(&to, bytes, &ONCE).await;
            if bus_off {
                // The controller sends no more until somebody restarts it.
                let _hung_up = to.lock().await.shutdown().await;
                return;
            }
        }
        let fate = fate(struck && !company, &mut rng).await;
        put(&to, as_record(&reply).to_vec(), &fate).await;
    }
}

fn as_record((id, data): &Frame) -> [u8; 16] {
    let mut record = [0; 16];
    record[..4].copy_from_slice(&(id | EXTENDED).to_ne_bytes());
    record[4] = u8::try_from(data.len()).unwrap();
    record[8..8 + data.len()].copy_from_slice(data);
    record
}

/// An error frame: its class, and the controller's state in byte 1.
fn trouble(class: u32, state: u8) -> [u8; 16] {
    let mut record = [0; 16];
    record[..4].copy_from_slice(&(ERROR | class).to_ne_bytes());
    (record[4], record[9]) = (8, state);
    record
}

/// What else is seen on a bus: the controller's complaints, another hand's reply, another kind of frame, an empty one.
fn others(rng: &mut fastrand::Rng, reply: &Frame) -> Vec<u8> {
    let (id, data) = reply;
    match rng.u8(..6) {
        0 => [trouble(4, 0x20), trouble(4, 0x40)].concat(),
        1 => trouble(4, 0x10).to_vec(),
        2 => as_record(&(id + 1, data.clone())).to_vec(),
        3 => as_record(&(id | 4 << 26, data.clone())).to_vec(),
        4 => {
            let mut short = as_record(&(0x123, data.clone()));
            short[..4].copy_from_slice(&0x123_u32.to_ne_bytes());
            short.to_vec()
        }
        _ => as_record(&(*id, Vec::new())).to_vec(),
    }
}

/// The hand behind a serial adapter: one line a command.
pub(crate) async fn text(hand: SharedHand, wire: impl Wire, quirks: Quirks, seed: u64) {
    let mut rng = fastrand::Rng::with_seed(seed);
    let (mut from, to) = tokio::io::split(wire);
    let to = Arc::new(Mutex::new(to));
    let (mut line, mut chunk) = (Vec::new(), [0; 512]);
    let mut open = false;
    while let Ok(len @ 1..) = from.read(&mut chunk).await {
        for byte in &chunk[..len] {
            if *byte != b'\r' {
                line.push(*byte);
                continue;
            }
            let said = std::mem::take(&mut line);
            if said.is_empty() {
                continue;
            }
            let done = match &said[..] {
                b"O" if !open => {
                    open = true;
                    true
                }
                b"C" if open => {
                    open = false;
                    true
                }
                b"S8" => !open,
                [b'T', frame @ ..] if open && let Some(asked) = frame_of(frame) => {
                    sent(&hand, &to, &quirks, &mut rng, &asked).await;
                    continue;
                }
                _ => false,
            };
            if !quirks.adapter.mute {
                put(&to, vec![if done { b'\r' } else { 7 }], &ONCE).await;
            }
        }
    }
}

/// The adapter was given a frame.
async fn sent(
    hand: &SharedHand,
    to: &Arc<Mutex<impl AsyncWrite + Unpin + Send + 'static>>,
    quirks: &Quirks,
    rng: &mut fastrand::Rng,
    asked: &Frame,
) {
    let Quirks { adapter, .. } = quirks;
    if adapter.echoes {
        put(to, as_line(asked, *adapter), &ONCE).await;
    }
    if !adapter.mute {
        put(to, b"Z\r".to_vec(), &ONCE).await;
    }
    let Some(reply) = answer(hand, quirks, asked) else {
        return;
    };
    sleep(quirks.turnaround).await;
    let struck = quirks.strike(rng);
    let mut line = as_line(&reply, *adapter);
    if struck && rng.bool() {
        spoil(&mut line, rng);
        return put(to, line, &ONCE).await;
    }
    let fate = fate(struck, rng).await;
    put(to, line, &fate).await;
}

/// Noise that a reader can see: the text has no check of its own, and a changed digit is another digit.
fn spoil(line: &mut Vec<u8>, rng: &mut fastrand::Rng) {
    let at = rng.usize(..line.len());
    match rng.u8(..4) {
        0 => line[at] |= 0x80,
        1 => drop(line.splice(0..0, [0xFF, b'T', b'0', 0])),
        2 => drop(line.splice(0..0, *b"F84\r\x07V1013\r")),
        _ => drop(line.splice(0..0, *b"t1232F401\r")),
    }
}

fn frame_of(text: &[u8]) -> Option<Frame> {
    let text = std::str::from_utf8(text).ok()?;
    let id = u32::from_str_radix(text.get(..8)?, 16).ok()?;
    let len: usize = text.get(8..9)?.parse().ok()?;
    let digits = text.get(9..).filter(|digits| digits.len() == 2 * len)?;
    let data = (0..len).map(|at| u8::from_str_radix(&digits[2 * at..2 * at + 2], 16).ok());
    Some((id, data.collect::<Option<_>>()?))
}

fn as_line((id, data): &Frame, adapter: Adapter) -> Vec<u8> {
    let mut line = format!("T{id:08X}{}", data.len());
    for byte in data {
        line += &format!("{byte:02X}");
    }
    if adapter.stamps {
        line += "12Ab";
    }
    line.push('\r');
    line.into_bytes()
}
