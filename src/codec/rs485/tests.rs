//! Frames of the manual, whole, split, glued, damaged, in noise; and what holds for all bytes. Nothing but tests.
#![allow(clippy::cast_possible_truncation, reason = "a test may")]

use crate::codec::rs485::client::{
    ReplyDecoder, Rs485Reply, SaveResult, encode_read, encode_write,
};
use crate::codec::rs485::device::{
    RequestDecoder, Rs485Request, encode_read_reply, encode_save_result, encode_write_ack,
};
use crate::codec::rs485::framing::{BUFFER_LEN, Payload};
use crate::hand::{
    Force, HandCommand, HandId, PerDof, RegisterWrite, SerialSpeed, Setting, Span, Speed, Target,
    Trigger, Writes,
};
use proptest::prelude::*;

fn bytes(hex: &str) -> Vec<u8> {
    hex.split_whitespace()
        .map(|pair| u8::from_str_radix(pair, 16).unwrap())
        .collect()
}

fn payload(bytes: &[u8]) -> Payload {
    Payload::try_from(bytes).unwrap()
}

fn read(address: u16, data: &[u8]) -> Rs485Reply {
    Rs485Reply::Read {
        id: 1,
        address,
        bytes: payload(data),
    }
}

const fn ack(id: u8, address: u16) -> Rs485Reply {
    Rs485Reply::WriteAck {
        id,
        address,
        value: 1,
    }
}

/// 100, 100, 100, 100, 2000, 0 as the manual writes them.
const SIX: [u8; 12] = [0x64, 0, 0x64, 0, 0x64, 0, 0x64, 0, 0xD0, 0x07, 0, 0];

// Manual: every printed checksum of 2.2.1 and 2.2.2 follows the rule; none had to be mended.
fn printed_replies() -> Vec<(Vec<u8>, Rs485Reply)> {
    let save = |value| Rs485Reply::WriteAck {
        id: 1,
        address: 1005,
        value,
    };
    [
        (
            "90 EB 01 0F 11 0A 06 64 00 64 00 64 00 64 00 D0 07 00 00 98",
            read(1546, &SIX),
        ),
        ("90 EB 01 04 12 CE 05 01 EB", ack(1, 1486)),
        ("90 EB 01 04 12 ED 03 00 07", save(0)),
        ("90 EB 01 04 12 ED 03 FF 06", save(0xFF)),
        ("90 EB 01 04 11 ED 03 00 06", read(1005, &[0])),
        ("90 EB 02 04 12 E8 03 01 04", ack(2, 1000)),
        ("90 EB 01 04 12 EA 03 01 05", ack(1, 1002)),
        ("90 EB 01 04 12 ED 03 01 08", ack(1, 1005)),
        ("90 EB 01 04 12 F1 03 01 0C", ack(1, 1009)),
        ("90 EB 01 04 11 02 00 00 18", read(2, &[0])),
        ("90 EB 01 04 12 F2 05 01 0F", ack(1, 1522)),
        ("90 EB 01 04 12 DA 05 01 F7", ack(1, 1498)),
    ]
    .map(|(hex, reply)| (bytes(hex), reply))
    .to_vec()
}

fn write(address: u16, data: &[u8]) -> Rs485Request {
    Rs485Request::Write {
        id: 1,
        address,
        bytes: payload(data),
    }
}

fn printed_requests() -> Vec<(Vec<u8>, Rs485Request)> {
    let thousand = "E8 03 E8 03 E8 03 E8 03 E8 03 E8 03";
    let six_thousand = [0xE8, 0x03].repeat(6);
    let read = Rs485Request::Read {
        id: 1,
        span: Span::new(1546, 12),
    };
    let of = |hex: &str, request| (bytes(hex), request);
    vec![
        of("EB 90 01 04 11 0A 06 0C 32", read),
        of(
            "EB 90 01 0F 12 CE 05 64 00 64 00 64 00 64 00 D0 07 00 00 5C",
            write(1486, &SIX),
        ),
        of("EB 90 01 04 12 E8 03 02 04", write(1000, &[2])),
        of("EB 90 01 04 12 EA 03 01 05", write(1002, &[1])),
        of("EB 90 01 04 12 ED 03 01 08", write(1005, &[1])),
        of("EB 90 01 04 12 F1 03 01 0C", write(1009, &[1])),
        of(
            &format!("EB 90 01 0F 12 F2 05 {thousand} 9B"),
            write(1522, &six_thousand),
        ),
        of(
            &format!("EB 90 01 0F 12 DA 05 {thousand} 83"),
            write(1498, &six_thousand),
        ),
        of(
            &format!("EB 90 01 0F 12 CE 05 {thousand} 77"),
            write(1486, &six_thousand),
        ),
    ]
}

/// Feeds all bytes in pieces of these lengths (the last repeats) and gives all frames.
fn decode_in(decoder: &mut ReplyDecoder, mut rest: &[u8], pieces: &[usize]) -> Vec<Rs485Reply> {
    let mut out = Vec::new();
    let mut pieces = pieces.iter().copied().chain(std::iter::repeat(
        pieces.last().copied().unwrap_or(1).max(1),
    ));
    while !rest.is_empty() {
        let piece = pieces.next().unwrap_or(1).clamp(1, rest.len());
        let taken = decoder.push(&rest[..piece]);
        rest = &rest[taken..];
        while let Some(reply) = decoder.next() {
            out.push(reply);
        }
        assert!(decoder.buffered() < 260);
    }
    out
}

fn decode(bytes: &[u8]) -> Vec<Rs485Reply> {
    decode_in(&mut ReplyDecoder::default(), bytes, &[bytes.len().max(1)])
}

#[test]
fn printed_replies_decode_whole_and_byte_by_byte() {
    for (frame, reply) in printed_replies() {
        let mut decoder = ReplyDecoder::default();
        let reply = [reply];
        assert_eq!(decode_in(&mut decoder, &frame, &[1]), reply, "{frame:02X?}");
        assert_eq!(decode(&frame), reply, "{frame:02X?}");
        let counts = decoder.counts();
        assert_eq!(
            (counts.frames, counts.resyncs, counts.skipped_bytes),
            (1, 0, 0)
        );
        assert_eq!(decoder.buffered(), 0);
    }
}

#[test]
fn printed_replies_decode_glued_together() {
    let (glued, replies): (Vec<_>, Vec<_>) = printed_replies().into_iter().unzip();
    assert_eq!(decode(&glued.concat()), replies);
}

#[test]
fn printed_requests_decode_whole_byte_by_byte_and_glued() {
    let mut glued = RequestDecoder::default();
    for (frame, request) in printed_requests() {
        let mut decoder = RequestDecoder::default();
        for byte in &frame[..frame.len() - 1] {
            assert_eq!(decoder.push(&[*byte]), 1);
            assert_eq!(decoder.next(), None);
        }
        decoder.push(&frame[frame.len() - 1..]);
        assert_eq!(decoder.next().as_ref(), Some(&request));
        glued.push(&frame);
    }
    for (_, request) in printed_requests() {
        assert_eq!(glued.next(), Some(request));
    }
    assert_eq!(glued.next(), None);
}

fn only(writes: &Writes) -> RegisterWrite {
    assert_eq!(writes.len(), 1);
    writes[0].clone()
}

#[test]
fn requests_are_encoded_as_printed() {
    let id = HandId::new(1).unwrap();
    let printed: Vec<_> = printed_requests()
        .into_iter()
        .map(|(frame, _)| frame)
        .collect();
    let read = encode_read(id, Span::new(1546, 12)).unwrap();
    assert_eq!(read.as_slice(), printed[0]);
    let thousand = Speed::new(1000).unwrap();
    let angles = PerDof::splat(Target::Go(crate::hand::Angle::MAX));
    // Printed row 1 writes 2000 to an angle, which no command can express.
    for (row, writes) in [
        (2, Setting::Id(HandId::new(2).unwrap()).writes()),
        (3, Setting::SerialSpeed(SerialSpeed::ALL[1]).writes()),
        (4, Writes::from_iter([Trigger::Save.write()])),
        (5, Writes::from_iter([Trigger::CalibrateForce.write()])),
        (
            6,
            HandCommand::Speeds(PerDof::splat(Some(thousand))).writes(),
        ),
        (
            7,
            HandCommand::Forces(PerDof::splat(Some(Force::new(1000).unwrap()))).writes(),
        ),
        (8, HandCommand::Angles(angles.map(Some)).writes()),
    ] {
        let frame = encode_write(id, &only(&writes));
        assert_eq!(frame.as_slice(), printed[row], "{writes:?}");
    }
}

#[test]
fn replies_are_encoded_as_printed() {
    let of = |row: usize| printed_replies()[row].0.clone();
    assert_eq!(encode_read_reply(1, 1546, &SIX).unwrap().as_slice(), of(0));
    assert_eq!(encode_write_ack(1, 1486, 1).as_slice(), of(1));
    assert_eq!(encode_save_result(1, 0x12, true).as_slice(), of(2));
    assert_eq!(encode_save_result(1, 0x12, false).as_slice(), of(3));
    assert_eq!(encode_save_result(1, 0x11, true).as_slice(), of(4));
}

#[test]
fn impossible_lengths_are_not_encoded() {
    let id = HandId::new(1).unwrap();
    assert_eq!(encode_read(id, Span::new(3000, 0)), None);
    assert_eq!(encode_read(id, Span::new(3000, 253)), None);
    assert_eq!(encode_read_reply(1, 3000, &[]), None);
    assert_eq!(encode_read_reply(1, 3000, &[0; 253]), None);
    let longest = encode_read_reply(1, 3000, &[0xEB; 252]).unwrap();
    assert_eq!(longest.len(), 260);
    assert_eq!(decode(&longest), [read(3000, &[0xEB; 252])]);
}

#[test]
fn a_damaged_frame_is_never_taken_and_the_next_one_is() {
    let good = encode_write_ack(1, 1498, 1);
    for (frame, reply) in printed_replies() {
        for at in 0..frame.len() {
            for bit in 0..8 {
                let mut damaged = frame.clone();
                damaged[at] ^= 1 << bit;
                let mut decoder = ReplyDecoder::default();
                damaged.extend_from_slice(&good);
                let mut got = decode_in(&mut decoder, &damaged, &[damaged.len()]);
                decoder.flush_pending();
                got.extend(decoder.next());
                assert_eq!(got, [ack(1, 1498)], "{reply:?} byte {at} bit {bit}");
                assert!(decoder.counts().skipped_bytes > 0);
            }
        }
    }
}

#[test]
fn bad_checksum_is_skipped_and_counted_once() {
    let mut noisy = bytes("90 EB 01 04 12 CE 05 01 EC");
    noisy.extend(bytes("90 EB 01 04 12 DA 05 01 F7"));
    let mut decoder = ReplyDecoder::default();
    assert_eq!(decode_in(&mut decoder, &noisy, &[4]), [ack(1, 1498)]);
    let counts = decoder.counts();
    assert_eq!((counts.checksum_errors, counts.resyncs), (1, 1));
    assert_eq!((counts.skipped_bytes, counts.frames), (9, 1));
}

#[test]
fn header_bytes_before_and_inside_a_frame_do_no_harm() {
    let inside = read(3000, &bytes("90 EB 01 04 12 90 EB EB 90 01 90"));
    let Rs485Reply::Read { bytes: data, .. } = &inside else {
        unreachable!()
    };
    let frame = encode_read_reply(1, 3000, data).unwrap();
    for noise in [
        "",
        "90",
        "EB",
        "90 90",
        "EB EB 90 EB",
        "00 FF",
        "90 EB 01 02",
        "90 EB 01 04 33",
    ] {
        let mut stream = bytes(noise);
        stream.extend_from_slice(&frame);
        stream.extend_from_slice(&frame);
        let mut decoder = ReplyDecoder::default();
        let mut got = decode_in(&mut decoder, &stream, &[3]);
        decoder.flush_pending();
        while let Some(reply) = decoder.next() {
            got.push(reply);
        }
        assert_eq!(got, [inside.clone(), inside.clone()], "{noise}");
    }
}

#[test]
fn a_good_frame_inside_a_false_one_is_found_after_silence() {
    let mut stream = bytes("90 EB 07 FF 11");
    stream.extend(bytes("90 EB 01 04 12 DA 05 01 F7"));
    let mut decoder = ReplyDecoder::default();
    assert_eq!(decode_in(&mut decoder, &stream, &[2]), []);
    decoder.flush_pending();
    assert_eq!(decoder.next(), Some(ack(1, 1498)));
    assert_eq!(decoder.next(), None);
    assert_eq!(decoder.buffered(), 0);
    assert_eq!(decoder.counts().skipped_bytes, 5);
}

#[test]
fn a_flush_does_not_harm_what_comes_after_it() {
    let mut decoder = ReplyDecoder::default();
    decoder.push(&bytes("90 EB 07 FF 11"));
    assert_eq!(decoder.next(), None);
    decoder.flush_pending();
    let frame = bytes("90 EB 01 04 12 DA 05 01 F7");
    assert_eq!(decode_in(&mut decoder, &frame, &[1]), [ack(1, 1498)]);
}

#[test]
fn an_echoed_request_is_skipped_and_is_no_noise() {
    for (echo, _) in printed_requests() {
        let mut decoder = ReplyDecoder::default();
        let mut stream = echo.clone();
        stream.extend(bytes("90 EB 01 04 12 CE 05 01 EB"));
        assert_eq!(decode_in(&mut decoder, &stream, &[5]), [ack(1, 1486)]);
        let overheard = decoder.overheard();
        assert_eq!(overheard.as_deref(), Some(echo.as_slice()));
        assert_eq!(decoder.overheard(), None);
        let counts = decoder.counts();
        assert_eq!(
            (counts.echoes, counts.skipped_bytes, counts.resyncs),
            (1, 0, 0)
        );
    }
}

#[test]
fn the_save_result_has_two_spellings_and_is_not_the_acknowledgement() {
    for (hex, result) in [
        ("90 EB 01 04 12 ED 03 00 07", Some(SaveResult::Ok)),
        ("90 EB 01 04 12 ED 03 FF 06", Some(SaveResult::Failed)),
        ("90 EB 01 04 11 ED 03 00 06", Some(SaveResult::Ok)),
        ("90 EB 01 04 11 ED 03 FF 05", Some(SaveResult::Failed)),
        ("90 EB 01 04 12 ED 03 07 0E", Some(SaveResult::Other(7))),
        ("90 EB 01 04 12 ED 03 01 08", None),
        ("90 EB 01 04 12 CE 05 01 EB", None),
    ] {
        assert_eq!(decode(&bytes(hex))[0].save_result(), result, "{hex}");
    }
}

#[test]
fn a_full_buffer_takes_no_more_until_frames_are_fetched() {
    let mut decoder = ReplyDecoder::default();
    let flood = vec![0x00; 2 * BUFFER_LEN];
    assert_eq!(decoder.push(&flood), BUFFER_LEN);
    assert_eq!(decoder.push(&flood), 0);
    assert_eq!(decoder.next(), None);
    assert_eq!(decoder.push(&flood), BUFFER_LEN);
}

/// Bytes rich in headers, lengths and commands, so that false frames are common.
fn stream() -> impl Strategy<Value = Vec<u8>> {
    let good = (
        any::<u8>(),
        any::<u16>(),
        prop::collection::vec(any::<u8>(), 1..40),
    )
        .prop_map(|(id, address, data)| encode_read_reply(id, address, &data).unwrap().to_vec());
    let near = prop::collection::vec(
        prop::sample::select(vec![0x90, 0xEB, 0x01, 0x04, 0x11, 0x12, 0xFF, 0x06]),
        0..20,
    );
    let any = prop::collection::vec(any::<u8>(), 0..300);
    prop::collection::vec(prop_oneof![3 => good, 2 => near, 1 => any], 0..12)
        .prop_map(|parts| parts.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn any_chunking_gives_equal_frames_and_counts(
        stream in stream(),
        pieces in prop::collection::vec(1..80usize, 1..40),
    ) {
        let (mut one, mut other) = (ReplyDecoder::default(), ReplyDecoder::default());
        let whole = decode_in(&mut one, &stream, &[stream.len().max(1)]);
        prop_assert_eq!(decode_in(&mut other, &stream, &pieces), whole);
        prop_assert_eq!(one.counts(), other.counts());
    }

    #[test]
    fn an_accepted_frame_encodes_to_bytes_of_the_stream(stream in stream()) {
        let mut rest = stream.as_slice();
        for reply in decode(&stream) {
            let frame = match &reply {
                Rs485Reply::Read { id, address, bytes } => encode_read_reply(*id, *address, bytes).unwrap(),
                Rs485Reply::WriteAck { id, address, value } => encode_write_ack(*id, *address, *value),
            };
            let at = rest.windows(frame.len()).position(|window| window == frame.as_slice());
            prop_assert!(at.is_some());
            rest = &rest[at.unwrap() + frame.len()..];
        }
    }

    #[test]
    fn after_garbage_at_most_one_good_frame_is_lost(
        garbage in prop::collection::vec(any::<u8>(), 0..600),
        count in 1..8usize,
    ) {
        let frame = encode_read_reply(1, 1546, &SIX).unwrap();
        let mut stream = garbage;
        for _ in 0..count {
            stream.extend_from_slice(&frame);
        }
        let mut decoder = ReplyDecoder::default();
        let mut got = decode_in(&mut decoder, &stream, &[stream.len()]);
        decoder.flush_pending();
        while let Some(reply) = decoder.next() {
            got.push(reply);
        }
        let good = got.iter().filter(|reply| **reply == read(1546, &SIX)).count();
        prop_assert!(good + 1 >= count, "{good} of {count}");
    }
}
