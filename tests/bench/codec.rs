//! Frames a second through the private framing, without any wire.

use crate::clock::cpu_ms;
use crate::report::{Aim, Failure, Report};
use handscope::codec::rs485::{
    ReplyDecoder, RequestDecoder, Rs485Reply, Rs485Request, encode_read, encode_read_reply,
};
use handscope::hand::register::{STATE, TOUCH};
use handscope::hand::{HandId, Span};

/// Replies that are decoded for one figure.
const REPLIES: u32 = 300_000;
/// Bytes that the system hands over at once.
const CHUNK: usize = 512;
/// What one full cycle reads.
const CYCLE: [Span; 3] = [
    STATE,
    Span::new(TOUCH.address, 232),
    Span::new(TOUCH.address + 232, 58),
];

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let frames: Vec<u8> = CYCLE.iter().flat_map(|span| reply_to(*span)).collect();
    let glued = frames.repeat(100);
    let (ms, decoded) = cpu_ms(|| {
        let mut decoded = 0;
        while decoded < REPLIES {
            decoded += decode(&glued);
        }
        decoded
    });
    let a_second = f64::from(decoded) * 1000.0 / ms;
    report.row(
        "rs485 replies decoded, glued together",
        a_second,
        "frames/s",
        Aim::None,
    )?;
    let (ms, exchanged) = cpu_ms(|| (0..REPLIES / 3).map(|_| exchange()).sum::<u32>());
    let a_second = f64::from(exchanged) * 1000.0 / ms;
    report.row(
        "rs485 exchanges: both frames encoded and decoded",
        a_second,
        "frames/s",
        Aim::None,
    )
}

fn reply_to(span: Span) -> Vec<u8> {
    let bytes: Vec<u8> = (0..=u8::MAX).cycle().take(usize::from(span.len)).collect();
    encode_read_reply(1, span.address, &bytes).map_or_else(Vec::new, |frame| frame.to_vec())
}

fn decode(stream: &[u8]) -> u32 {
    let mut decoder = ReplyDecoder::default();
    let mut decoded = 0;
    for mut chunk in stream.chunks(CHUNK) {
        while !chunk.is_empty() {
            let taken = decoder.push(chunk);
            chunk = chunk.get(taken..).unwrap_or_default();
            while let Some(reply) = decoder.next() {
                std::hint::black_box(&reply);
                decoded += 1;
            }
        }
    }
    decoded
}

/// Requests and replies of one cycle; gives the number of frames decoded.
fn exchange() -> u32 {
    let (mut hand, mut host) = (RequestDecoder::default(), ReplyDecoder::default());
    let memory = [7; 252];
    let mut decoded = 0;
    for span in CYCLE {
        if let Some(frame) = encode_read(HandId::nearest(1), span) {
            hand.push(&frame);
        }
        if let Some(Rs485Request::Read { id, span }) = hand.next() {
            decoded += 1;
            let bytes = memory.get(..usize::from(span.len)).unwrap_or_default();
            if let Some(frame) = encode_read_reply(id, span.address, bytes) {
                host.push(&frame);
            }
        }
        if let Some(Rs485Reply::Read { bytes, .. }) = host.next() {
            std::hint::black_box(&bytes);
            decoded += 1;
        }
    }
    decoded
}
