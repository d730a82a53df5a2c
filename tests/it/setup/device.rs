//! A hand behind an in-memory serial line or socket. The protocol is written by hand here, not by our codec.

use crate::setup::body::{Quirks, memory};
use handscope::hand::Span;
use handscope::sim::SharedHand;
use handscope::transport::Wire;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::time::{Duration, sleep};

pub(crate) async fn rs485(hand: SharedHand, mut wire: impl Wire, quirks: Quirks) {
    let mut held: Vec<u8> = Vec::new();
    let mut chunk = [0; 512];
    while let Ok(len @ 1..) = wire.read(&mut chunk).await {
        held.extend(&chunk[..len]);
        while let Some((request, used)) = rs485_request(&held) {
            held.drain(..used);
            let Some(reply) = rs485_answer(&hand, &quirks, &request) else {
                continue;
            };
            sleep(quirks.turnaround).await;
            if wire.write_all(&reply).await.is_err() {
                return;
            }
        }
        if held.len() > 600 {
            held.clear();
        }
    }
}

/// The next whole request `id, command, address, data`, and the bytes to drop up to its end.
fn rs485_request(held: &[u8]) -> Option<(Vec<u8>, usize)> {
    (0..held.len()).find_map(|at| {
        let frame = held[at..].strip_prefix(&[0xEB, 0x90])?;
        let len = usize::from(*frame.get(1)?);
        let body = frame.get(..len + 2)?;
        let sum = body.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
        (len >= 4 && *frame.get(len + 2)? == sum).then(|| (body.to_vec(), at + len + 5))
    })
}

fn rs485_answer(hand: &SharedHand, quirks: &Quirks, body: &[u8]) -> Option<Vec<u8>> {
    let (id, command) = (body[0], body[2]);
    if id != 1 {
        return None;
    }
    let address = u16::from_le_bytes([body[3], body[4]]);
    let data = match command {
        0x11 => memory(hand, quirks, Span::new(address, u16::from(body[5])))?,
        0x12 => {
            hand.with(|hand, now| hand.write(address, &body[5..], now))
                .ok()?;
            vec![1]
        }
        _ => return None,
    };
    let mut reply = vec![
        id,
        u8::try_from(data.len() + 3).ok()?,
        command,
        body[3],
        body[4],
    ];
    reply.extend(data);
    reply.push(reply.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte)));
    reply.splice(0..0, [0x90, 0xEB]);
    Some(reply)
}

pub(crate) async fn modbus_tcp(hand: SharedHand, mut wire: impl Wire, quirks: Quirks, seed: u64) {
    let mut rng = fastrand::Rng::with_seed(seed);
    loop {
        let mut head = [0; 7];
        if wire.read_exact(&mut head).await.is_err() {
            return;
        }
        let mut pdu = vec![0; usize::from(u16::from_be_bytes([head[4], head[5]])) - 1];
        if wire.read_exact(&mut pdu).await.is_err() {
            return;
        }
        sleep(quirks.turnaround).await;
        let mut head = [head[0], head[1], head[6]];
        let (answer, copies) = quirked(
            modbus_answer(&hand, &quirks, &pdu),
            &quirks,
            &mut rng,
            &mut head[1],
        )
        .await;
        let [high, low, unit] = head;
        let mut adu = vec![high, low, 0, 0];
        adu.extend(u16::try_from(answer.len() + 1).unwrap().to_be_bytes());
        adu.push(unit);
        adu.extend(answer);
        for _ in 0..copies {
            if wire.write_all(&adu).await.is_err() {
                return;
            }
        }
    }
}

/// Now and then: late, doubled, missing, someone else's, too short, refused. Gives the answer and its copies.
async fn quirked(
    mut answer: Vec<u8>,
    quirks: &Quirks,
    rng: &mut fastrand::Rng,
    whose: &mut u8,
) -> (Vec<u8>, usize) {
    if !quirks.strike(rng) {
        return (answer, 1);
    }
    match rng.u8(..6) {
        0 => sleep(Duration::from_millis(rng.u64(60..900))).await,
        1 => return (answer, 2),
        2 => return (answer, 0),
        3 => *whose ^= 0x55,
        // Too short to be what another read of the plan asks for: over RTU, where replies have no number, nobody
        // could tell those apart once it is late as well.
        4 if answer[0] == 3 && answer.len() > 20 => {
            answer.truncate(12);
            answer[1] = 10;
        }
        _ => answer = vec![answer[0] | 0x80, 6],
    }
    (answer, 1)
}

/// Check of Modbus RTU, bit by bit as the standard describes it.
pub(crate) fn crc(bytes: &[u8]) -> [u8; 2] {
    let mut register = 0xFFFFu16;
    for byte in bytes {
        register ^= u16::from(*byte);
        // Not `for`: without optimisation that takes ten times as long.
        let mut bits = 8;
        while bits > 0 {
            let out = register % 2 == 1;
            register /= 2;
            if out {
                register ^= 0xA001;
            }
            bits -= 1;
        }
    }
    register.to_le_bytes()
}

pub(crate) async fn modbus_rtu(hand: SharedHand, mut wire: impl Wire, quirks: Quirks, seed: u64) {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut held: Vec<u8> = Vec::new();
    let mut chunk = [0; 512];
    while let Ok(len @ 1..) = wire.read(&mut chunk).await {
        held.extend(&chunk[..len]);
        while let Some((pdu, used)) = rtu_request(&held) {
            held.drain(..used);
            sleep(quirks.turnaround).await;
            let mut unit = 1;
            let answer = modbus_answer(&hand, &quirks, &pdu);
            let (answer, copies) = quirked(answer, &quirks, &mut rng, &mut unit).await;
            let mut reply = vec![unit];
            reply.extend(answer);
            reply.extend(crc(&reply));
            for _ in 0..copies {
                if wire.write_all(&reply).await.is_err() {
                    return;
                }
            }
        }
        if held.len() > 600 {
            held.clear();
        }
    }
}

/// The next whole request to hand 1, and the bytes to drop up to its end.
fn rtu_request(held: &[u8]) -> Option<(Vec<u8>, usize)> {
    (0..held.len()).find_map(|at| {
        let frame = &held[at..];
        let len = match frame {
            [1, 3 | 6, ..] => 6,
            [1, 16, _, _, _, _, count, ..] => 7 + usize::from(*count),
            _ => return None,
        };
        let (body, check) = frame.get(..len + 2)?.split_last_chunk()?;
        (crc(body) == *check).then(|| (body[1..].to_vec(), at + len + 2))
    })
}

fn swap_pairs(bytes: &mut [u8]) {
    bytes.chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
}

fn modbus_answer(hand: &SharedHand, quirks: &Quirks, pdu: &[u8]) -> Vec<u8> {
    let word = |at: usize| u16::from_be_bytes([pdu[at], pdu[at + 1]]);
    match pdu[0] {
        3 => {
            let Some(mut bytes) = memory(hand, quirks, Span::new(word(1), word(3) * 2)) else {
                return vec![0x83, 2];
            };
            swap_pairs(&mut bytes);
            [&[3, u8::try_from(bytes.len()).unwrap()], bytes.as_slice()].concat()
        }
        6 => {
            let _taken = hand.with(|hand, now| hand.write(word(1), &[pdu[4]], now));
            pdu.to_vec()
        }
        16 => {
            let mut bytes = pdu[6..].to_vec();
            swap_pairs(&mut bytes);
            let _taken = hand.with(|hand, now| hand.write(word(1), &bytes, now));
            pdu[..5].to_vec()
        }
        other => vec![other | 0x80, 1],
    }
}
