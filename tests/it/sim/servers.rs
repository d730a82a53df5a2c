//! The simulated hand on wires: frames and messages byte by byte, never through our own client.

use crate::setup::hand;
use handscope::codec::modbus_rtu::crc16;
use handscope::hand::{Dof, Span};
#[cfg(unix)]
use handscope::sim::serve::pty;
use handscope::sim::serve::{can, modbus_rtu, modbus_tcp, rs485, slcan, usbcan};
use handscope::sim::{Personality, SharedHand};
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, timeout};

fn bytes(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

fn shared(personality: Personality) -> SharedHand {
    hand::begin(hand::free(hand::like(personality)))
}

fn line(hand: &SharedHand) -> DuplexStream {
    let (ours, theirs) = tokio::io::duplex(4096);
    tokio::spawn(rs485::serve(hand.clone(), theirs));
    ours
}

async fn say(wire: &mut DuplexStream, request: &str) {
    wire.write_all(&bytes(request)).await.unwrap();
}

async fn hear(wire: &mut DuplexStream, len: usize) -> Vec<u8> {
    let mut reply = vec![0; len];
    timeout(Duration::from_secs(5), wire.read_exact(&mut reply))
        .await
        .unwrap()
        .unwrap();
    reply
}

async fn silent(wire: &mut DuplexStream) {
    silent_for(wire, Duration::from_millis(500)).await;
}

async fn silent_for(wire: &mut DuplexStream, time: Duration) {
    let mut byte = [0];
    let heard = timeout(time, wire.read(&mut byte)).await;
    assert!(heard.is_err(), "not silent: {byte:02X?}");
}

#[tokio::test(start_paused = true)]
async fn the_manuals_frames_are_answered_byte_for_byte() {
    let hand = shared(Personality::default());
    let mut wire = line(&hand);
    let thousand = "E8 03 ".repeat(6);
    for (request, reply) in [
        (
            format!("EB 90 01 0F 12 F2 05 {thousand} 9B"),
            "90 EB 01 04 12 F2 05 01 0F",
        ),
        (
            format!("EB 90 01 0F 12 DA 05 {thousand} 83"),
            "90 EB 01 04 12 DA 05 01 F7",
        ),
        (
            format!("EB 90 01 0F 12 CE 05 {thousand} 77"),
            "90 EB 01 04 12 CE 05 01 EB",
        ),
        // The manual's own write example asks for an angle of 2000; the frame is acknowledged all the same.
        (
            "EB 90 01 0F 12 CE 05 64 00 64 00 64 00 64 00 D0 07 00 00 5C".into(),
            "90 EB 01 04 12 CE 05 01 EB",
        ),
        (
            "EB 90 01 04 12 EA 03 01 05".into(),
            "90 EB 01 04 12 EA 03 01 05",
        ),
        (
            "EB 90 01 04 12 F1 03 01 0C".into(),
            "90 EB 01 04 12 F1 03 01 0C",
        ),
    ] {
        say(&mut wire, &request).await;
        assert_eq!(hear(&mut wire, 9).await, bytes(reply), "{request}");
    }
    tokio::time::sleep(Duration::from_secs(2)).await;
    say(&mut wire, "EB 90 01 04 11 0A 06 0C 32").await;
    assert_eq!(
        hear(&mut wire, 20).await,
        bytes("90 EB 01 0F 11 0A 06 64 00 64 00 64 00 64 00 E8 03 00 00 AC")
    );
    // The id changes at once, and the acknowledgement carries the new one.
    say(&mut wire, "EB 90 01 04 12 E8 03 02 04").await;
    assert_eq!(
        hear(&mut wire, 9).await,
        bytes("90 EB 02 04 12 E8 03 01 04")
    );
    say(&mut wire, "EB 90 01 04 11 0A 06 0C 32").await;
    silent(&mut wire).await;
}

#[tokio::test(start_paused = true)]
async fn save_is_acknowledged_and_its_result_follows_a_second_later() {
    let hand = shared(Personality::default());
    let mut wire = line(&hand);
    say(&mut wire, "EB 90 01 04 12 ED 03 01 08").await;
    assert_eq!(
        hear(&mut wire, 9).await,
        bytes("90 EB 01 04 12 ED 03 01 08")
    );
    let acknowledged = Instant::now();
    assert_eq!(
        hear(&mut wire, 9).await,
        bytes("90 EB 01 04 12 ED 03 00 07")
    );
    let later = acknowledged.elapsed();
    assert!((900..1100).contains(&later.as_millis()), "{later:?}");
    silent(&mut wire).await;
}

#[tokio::test(start_paused = true)]
async fn the_state_is_read_in_one_window_and_fingertips_in_two() {
    let hand = shared(Personality::default());
    let mut wire = line(&hand);
    // 01 + 04 + 11 + 0A + 06 + 4E = 74
    say(&mut wire, "EB 90 01 04 11 0A 06 4E 74").await;
    let state = hear(&mut wire, 86).await;
    assert_eq!(state[..7], bytes("90 EB 01 51 11 0A 06")[..]);
    assert_eq!(state[19..43], [0; 24]);
    // 3000 = 0BB8, 232 = E8: 01 + 04 + 11 + B8 + 0B + E8 = 1C1
    say(&mut wire, "EB 90 01 04 11 B8 0B E8 C1").await;
    assert_eq!(hear(&mut wire, 240).await[3], 0xEB);
    // 3232 = 0CA0, 58 = 3A
    say(&mut wire, "EB 90 01 04 11 A0 0C 3A FC").await;
    assert_eq!(hear(&mut wire, 66).await[3], 61);
}

#[tokio::test(start_paused = true)]
async fn foreign_ids_bad_sums_and_runs_out_of_memory_meet_silence() {
    let hand = shared(Personality::default());
    let mut wire = line(&hand);
    for request in [
        "EB 90 02 04 11 0A 06 0C 33",
        "EB 90 01 04 11 0A 06 0C 33",
        // 4095 and two bytes; 1546 and no byte; 1546 and 253 bytes.
        "EB 90 01 04 11 FF 0F 02 26",
        "EB 90 01 04 11 0A 06 00 26",
        "EB 90 01 04 11 0A 06 FD 23",
    ] {
        say(&mut wire, request).await;
        silent(&mut wire).await;
    }
    say(&mut wire, "00 EB 90 01 FF 12").await;
    silent(&mut wire).await;
    say(&mut wire, "EB 90 01 04 11 0A 06 0C 32").await;
    assert_eq!(hear(&mut wire, 20).await[3], 15);
}

#[tokio::test(start_paused = true)]
async fn the_turnaround_is_kept_and_a_request_in_pieces_is_answered() {
    let hand = shared(Personality {
        turnaround: Duration::from_millis(8),
        ..Personality::default()
    });
    let mut wire = line(&hand);
    say(&mut wire, "EB 90 01 04").await;
    tokio::time::sleep(Duration::from_millis(10)).await;
    say(&mut wire, "11 0A 06 0C 32").await;
    let asked = Instant::now();
    hear(&mut wire, 20).await;
    assert!(asked.elapsed() >= Duration::from_millis(8));
}

#[tokio::test(start_paused = true)]
async fn serving_ends_when_the_wire_hangs_up() {
    let hand = shared(Personality::default());
    let (ours, theirs) = tokio::io::duplex(64);
    let served = tokio::spawn(rs485::serve(hand, theirs));
    drop(ours);
    timeout(Duration::from_secs(1), served)
        .await
        .unwrap()
        .unwrap();
}

#[tokio::test(start_paused = true)]
async fn a_can_adapter_and_the_hand_behind_it_answer_the_manuals_frames() {
    let hand = shared(Personality::default());
    hand.with(|hand, now| hand.write(1492, &[0x58, 0x02], now).unwrap());
    let (mut wire, theirs) = tokio::io::duplex(4096);
    tokio::spawn(slcan::serve(hand, theirs));
    for (request, reply) in [
        // Closed: nothing can be sent, and there is nothing to close.
        ("T01840001102\r", "\x07"),
        ("C\r", "\x07"),
        ("S8\r", "\r"),
        ("S9\r", "\x07"),
        ("O\r", "\r"),
        ("O\r", "\x07"),
        // ANGLE_SET(3), which holds 600, and the write of the same (2.3.2).
        ("T01750001102\r", "Z\rT0175000125802\r"),
        ("T0575000125802\r", "Z\rT05750001101\r"),
        // Other hands, the wrist, more than eight bytes, remote frames: no answer.
        ("T01840002102\r", "Z\r"),
        ("T11840001102\r", "Z\r"),
        ("T01840001109\r", "Z\r"),
        // Frames that no hand knows go out and are acknowledged; what is none is refused, and so is a new rate now.
        ("R018400011\r", "Z\r"),
        ("r1231\r", "z\r"),
        ("t1232AABB\r", "z\r"),
        ("t1232AA\r", "\x07"),
        ("t8000\r", "\x07"),
        ("r1239\r", "\x07"),
        ("R0184000\r", "\x07"),
        ("L\r", "\x07"),
        ("s0014\r", "\x07"),
        ("C\r", "\r"),
        ("t1230\r", "\x07"),
        // Another rate by its timing: nobody is there.
        ("s031C\r", "\r"),
        ("s03\r", "\x07"),
        ("O\r", "\r"),
        ("T01840001102\r", "Z\r"),
        ("C\r", "\r"),
        // The hand's own, but only listening: nothing can be sent.
        ("s0014\r", "\r"),
        ("L\r", "\r"),
        ("O\r", "\x07"),
        ("T01840001102\r", "\x07"),
        ("r1231\r", "\x07"),
        ("C\r", "\r"),
        ("O\r", "\r"),
        ("T01750001102\r", "Z\rT0175000125802\r"),
    ] {
        wire.write_all(request.as_bytes()).await.unwrap();
        let heard = hear(&mut wire, reply.len()).await;
        assert_eq!(heard, reply.as_bytes(), "{request}");
        silent(&mut wire).await;
    }
}

/// A packet of the maker's adapter: identifier, eight bytes, how many of them count; its sum is reckoned here.
fn packet(id: u32, data: [u8; 8], len: u8) -> Vec<u8> {
    let mut body = [&id.to_le_bytes()[..], &data, &[len, 0, 1, 0]].concat();
    body.push(body.iter().fold(0, |sum: u8, byte| sum.wrapping_add(*byte)));
    [&[0xAA, 0xAA][..], &body, &[0x55, 0x55]].concat()
}

#[tokio::test(start_paused = true)]
async fn the_makers_adapter_and_the_hand_behind_it_answer_as_its_demos_ask() {
    let hand = shared(Personality::default());
    let (mut wire, theirs) = tokio::io::duplex(4096);
    tokio::spawn(usbcan::serve(hand.clone(), theirs));
    let asked = |len| packet(0x0184_0001, [len, 0, 0, 0, 0, 0, 0, 0], 1);
    // Four speeds at once and then two, padded as the demos do; each is answered by one byte.
    for (id, data, len) in [
        (0x057C_8001, [100, 0, 101, 0, 102, 0, 103, 0], 8),
        (0x057E_8001, [104, 0, 105, 0, 255, 255, 255, 255], 4),
    ] {
        wire.write_all(&packet(id, data, len)).await.unwrap();
        let heard = hear(&mut wire, 21).await;
        assert_eq!(heard, packet(id, [1, 0, 0, 0, 0, 0, 0, 0], 1));
    }
    let speeds = hand.with(|hand, now| hand.read(Span::new(1522, 12), now).unwrap());
    let wanted: Vec<u8> = (100..106).flat_map(|speed| [speed, 0]).collect();
    assert_eq!(speeds, wanted);
    wire.write_all(&asked(2)).await.unwrap();
    let reply = packet(0x0184_0001, [0xE8, 3, 0, 0, 0, 0, 0, 0], 2);
    assert_eq!(hear(&mut wire, 21).await, reply);
    // A value of AA goes as it is from a demo, and comes back with A5 before it.
    wire.write_all(&packet(0x0576_8001, [0xAA, 1, 0, 0, 0, 0, 0, 0], 2))
        .await
        .unwrap();
    hear(&mut wire, 21).await;
    wire.write_all(&packet(0x0176_8001, [2, 0, 0, 0, 0, 0, 0, 0], 1))
        .await
        .unwrap();
    let heard = hear(&mut wire, 22).await;
    assert_eq!(heard[6..9], [0xA5, 0xAA, 1]);
    // More than eight bytes, another hand, the adapter's settings, a wrong sum: no answer.
    let mut wrong = asked(2);
    wrong[18] ^= 1;
    let mut settings = packet(0x01FF_FED0, [0x40, 0x42, 0x0F, 0, 0, 0, 0, 0], 4);
    (settings[15], settings[18]) = (0xFF, settings[18].wrapping_add(0xFF));
    for silence in [asked(9), packet(0x0184_0002, [2; 8], 1), settings, wrong] {
        wire.write_all(&silence).await.unwrap();
        silent(&mut wire).await;
    }
    wire.write_all(&asked(2)).await.unwrap();
    assert_eq!(hear(&mut wire, 21).await, reply);
}

/// Asks for a calibration over each wire but RS485.
async fn calibrate_elsewhere(hand: &SharedHand) {
    let (mut tcp, theirs) = tokio::io::duplex(64);
    tokio::spawn(modbus_tcp::serve_client(hand.clone(), theirs));
    say(&mut tcp, "00 01 00 00 00 06 FF 06 03 F1 00 01").await;
    assert_eq!(hear(&mut tcp, 12).await[7], 6);
    let mut rtu = rtu_line(hand);
    rtu.write_all(&checked("01 06 03 F1 00 01")).await.unwrap();
    assert_eq!(hear(&mut rtu, 8).await[1], 6);
    let (mut bus, theirs) = tokio::io::duplex(64);
    tokio::spawn(slcan::serve(hand.clone(), theirs));
    bus.write_all(b"O\rT04FC4001101\r").await.unwrap();
    assert_eq!(hear(&mut bus, 16).await, b"\rZ\rT04FC4001101\r"[..16]);
}

fn rtu_line(hand: &SharedHand) -> DuplexStream {
    let (ours, theirs) = tokio::io::duplex(1024);
    tokio::spawn(modbus_rtu::serve(hand.clone(), theirs));
    ours
}

/// A Modbus RTU frame with its check.
fn checked(body: &str) -> Vec<u8> {
    let body = bytes(body);
    [&body[..], &crc16(&body).to_le_bytes()].concat()
}

#[tokio::test(start_paused = true)]
async fn the_end_of_a_calibration_is_told_only_where_it_was_asked_for() {
    let hand = shared(Personality::default());
    let mut wire = line(&hand);
    calibrate_elsewhere(&hand).await;
    tokio::time::sleep(Duration::from_secs(8)).await;
    silent(&mut wire).await;
    // Asked for here, and begun anew by the others: it ends once, when the newest does.
    say(&mut wire, "EB 90 01 04 12 F1 03 01 0C").await;
    hear(&mut wire, 9).await;
    tokio::time::sleep(Duration::from_secs(2)).await;
    calibrate_elsewhere(&hand).await;
    let begun = Instant::now();
    tokio::time::sleep(Duration::from_millis(5900)).await;
    silent_for(&mut wire, Duration::from_millis(50)).await;
    assert_eq!(
        hear(&mut wire, 9).await,
        bytes("90 EB 01 04 11 02 00 00 18")
    );
    assert!(begun.elapsed() < Duration::from_millis(6100));
    tokio::time::sleep(Duration::from_secs(8)).await;
    silent(&mut wire).await;
}

#[tokio::test(start_paused = true)]
async fn an_rtu_request_inside_a_longer_one_that_was_cut_is_not_executed() {
    let hand = shared(Personality::default());
    let mut wire = rtu_line(&hand);
    // Six words to ANGLE_SET, whose data look like SAVE by function 06.
    let save = checked("01 06 03 ED 00 01");
    let long = [bytes("01 10 05 CE 00 06 0C 00 00"), save.clone()].concat();
    let read = checked("01 03 06 0A 00 01");
    for cut in [
        // The rest never comes; or another request comes right behind; or bytes are lost in the middle.
        long.clone(),
        [&long[..], &read].concat(),
        [&long[..], &[0, 0, 0, 0], &save[..]].concat(),
        // Noise before it.
        [&[0xFF][..], &save].concat(),
    ] {
        wire.write_all(&cut).await.unwrap();
        silent(&mut wire).await;
        let written = hand.with(|hand, _| hand.journal().to_vec());
        assert_eq!(written, [], "{cut:02X?}");
        wire.write_all(&read).await.unwrap();
        assert_eq!(hear(&mut wire, 7).await[..3], [1, 3, 2]);
    }
    // A client that does not wait long is heard all the same.
    for _ in 0..2 {
        wire.write_all(&long).await.unwrap();
        wire.write_all(&read).await.unwrap();
        silent_for(&mut wire, Duration::from_millis(20)).await;
        wire.write_all(&read).await.unwrap();
        assert_eq!(hear(&mut wire, 7).await[..3], [1, 3, 2]);
    }
    // Whole ones behind each other are all answered.
    wire.write_all(&[&read[..], &read, &read].concat())
        .await
        .unwrap();
    hear(&mut wire, 21).await;
}

#[tokio::test(start_paused = true)]
async fn save_over_can_has_no_late_frame() {
    let hand = shared(Personality::default());
    let (mut wire, theirs) = tokio::io::duplex(4096);
    tokio::spawn(can::serve(hand.clone(), theirs));
    // SAVE is 1005: write flag, 3ED, hand 1; one byte.
    let mut record = [0; 16];
    record[..4].copy_from_slice(&0x84FB_4001_u32.to_ne_bytes());
    record[4] = 1;
    record[8] = 1;
    wire.write_all(&record).await.unwrap();
    assert_eq!(hear(&mut wire, 16).await, record);
    tokio::time::sleep(Duration::from_secs(3)).await;
    silent(&mut wire).await;
    let journal = hand.with(|hand, _| hand.journal().last().cloned().unwrap());
    assert_eq!((journal.address, journal.bytes), (1005, vec![1]));
}

async fn listen(hand: &SharedHand) -> (TcpStream, tokio::task::JoinHandle<std::io::Result<()>>) {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let served = tokio::spawn(modbus_tcp::serve(hand.clone(), listener));
    (TcpStream::connect(address).await.unwrap(), served)
}

async fn exchange(stream: &mut TcpStream, request: &str) -> Vec<u8> {
    stream.write_all(&bytes(request)).await.unwrap();
    let mut head = [0; 6];
    stream.read_exact(&mut head).await.unwrap();
    let mut rest = vec![0; usize::from(u16::from_be_bytes([head[4], head[5]]))];
    stream.read_exact(&mut rest).await.unwrap();
    [&head[..], &rest].concat()
}

#[tokio::test]
async fn modbus_reads_and_writes_by_byte_address() {
    let hand = shared(Personality::default());
    hand.with(|hand, _| hand.warm(Dof::Ring, 41.0));
    hand.with(|hand, _| hand.warm(Dof::Little, 40.0));
    let (mut client, served) = listen(&hand).await;
    for (request, reply) in [
        // Six words at ANGLE_ACT (060A), transaction 0007, unit 255.
        (
            "00 07 00 00 00 06 FF 03 06 0A 00 06",
            "00 07 00 00 00 0F FF 03 0C 03 E8 03 E8 03 E8 03 E8 03 E8 03 E8",
        ),
        // One-byte group TEMP (0652), packed: low byte = lower address.
        (
            "00 08 00 00 00 06 01 03 06 52 00 01",
            "00 08 00 00 00 05 01 03 02 29 28",
        ),
        // FORCE_SET (05DA) of the little finger, then two words at once.
        (
            "00 09 00 00 00 06 FF 06 05 DA 01 F4",
            "00 09 00 00 00 06 FF 06 05 DA 01 F4",
        ),
        (
            "00 0A 00 00 00 0B FF 10 05 DC 00 02 04 00 64 00 C8",
            "00 0A 00 00 00 06 FF 10 05 DC 00 02",
        ),
        (
            "00 0B 00 00 00 06 FF 03 05 DA 00 03",
            "00 0B 00 00 00 09 FF 03 06 01 F4 00 64 00 C8",
        ),
        // An odd address: second byte of 500 and first of 100.
        (
            "00 0C 00 00 00 06 FF 03 05 DB 00 01",
            "00 0C 00 00 00 05 FF 03 02 64 01",
        ),
        // The IP: two words at 1700 (06A4), 10.1.2.3.
        (
            "00 0D 00 00 00 0B FF 10 06 A4 00 02 04 01 0A 03 02",
            "00 0D 00 00 00 06 FF 10 06 A4 00 02",
        ),
        (
            "00 0E 00 00 00 06 FF 03 06 A4 00 02",
            "00 0E 00 00 00 07 FF 03 04 01 0A 03 02",
        ),
        // Another function, no word, 126 words, beyond the memory.
        (
            "00 0F 00 00 00 06 FF 04 06 0A 00 06",
            "00 0F 00 00 00 03 FF 84 01",
        ),
        (
            "00 10 00 00 00 06 FF 03 06 0A 00 00",
            "00 10 00 00 00 03 FF 83 03",
        ),
        (
            "00 11 00 00 00 06 FF 03 06 0A 00 7E",
            "00 11 00 00 00 03 FF 83 03",
        ),
        (
            "00 12 00 00 00 06 FF 03 0F FF 00 01",
            "00 12 00 00 00 03 FF 83 02",
        ),
    ] {
        assert_eq!(
            exchange(&mut client, request).await,
            bytes(reply),
            "{request}"
        );
    }
    served.abort();
    assert!(served.await.is_err());
    let mut byte = [0];
    assert_eq!(client.read(&mut byte).await.unwrap_or(0), 0);
}

#[tokio::test]
async fn one_word_at_a_one_byte_register_writes_that_byte_alone() {
    let hand = shared(Personality::default());
    let (mut client, _served) = listen(&hand).await;
    for request in [
        // CLEAR_ERROR by function 06, SAVE by 06 and by 16, a speed code that does not fit a byte.
        "00 01 00 00 00 06 FF 06 03 EC 00 01",
        "00 02 00 00 00 06 FF 06 03 ED 00 01",
        "00 03 00 00 00 09 FF 10 03 ED 00 01 02 00 01",
        "00 04 00 00 00 06 FF 06 03 EA 01 01",
    ] {
        let reply = exchange(&mut client, request).await;
        assert_eq!(reply[7], bytes(request)[7], "{request}");
    }
    let written: Vec<_> = hand.with(|hand, _| {
        let entries = hand.journal().iter();
        entries
            .map(|entry| (entry.address, entry.bytes.clone()))
            .collect()
    });
    assert_eq!(written, [(1004, vec![1]), (1005, vec![1]), (1005, vec![1])]);
    // The late frame belongs to serial lines.
    assert_eq!(hand.with(|hand, _| hand.next_save_result()), None);
}

#[tokio::test]
async fn one_word_at_a_field_of_the_address_leaves_its_neighbour() {
    let hand = shared(Personality::default());
    let (mut client, _served) = listen(&hand).await;
    for (request, fields) in [
        // 10 to the first by function 06, 9 to the fourth and 1 to the third by 16.
        ("00 01 00 00 00 06 FF 06 06 A4 00 0A", [10, 168, 11, 210]),
        (
            "00 02 00 00 00 09 FF 10 06 A7 00 01 02 00 09",
            [10, 168, 11, 9],
        ),
        (
            "00 03 00 00 00 09 FF 10 06 A6 00 01 02 00 01",
            [10, 168, 1, 9],
        ),
        // Two fields in one word, low byte first, are two.
        ("00 04 00 00 00 06 FF 06 06 A4 03 02", [2, 3, 1, 9]),
    ] {
        exchange(&mut client, request).await;
        let held = hand.with(|hand, now| hand.read(Span::new(1700, 4), now).unwrap());
        assert_eq!(held, fields, "{request}");
    }
}

#[tokio::test]
async fn several_clients_share_one_hand() {
    let hand = shared(Personality::default());
    let (mut first, _served) = listen(&hand).await;
    let mut second = TcpStream::connect(first.peer_addr().unwrap())
        .await
        .unwrap();
    exchange(&mut first, "00 01 00 00 00 06 FF 06 05 DA 00 7B").await;
    let seen = exchange(&mut second, "00 02 00 00 00 06 FF 03 05 DA 00 01").await;
    assert_eq!(seen, bytes("00 02 00 00 00 05 FF 03 02 00 7B"));
}

#[tokio::test]
async fn a_client_that_talks_nonsense_loses_only_its_own_connection() {
    let hand = shared(Personality::default());
    let (first, _served) = listen(&hand).await;
    let address = first.peer_addr().unwrap();
    for nonsense in [
        "FF FF FF FF FF FF FF FF FF FF",
        "00 01 00 00 00 07 FF 10 05 DA 80 00 00",
        "00 01 00 00 00 02 FF 10",
    ] {
        let mut rude = TcpStream::connect(address).await.unwrap();
        rude.write_all(&bytes(nonsense)).await.unwrap();
        let mut end = [0; 64];
        let heard = timeout(Duration::from_millis(300), rude.read(&mut end)).await;
        assert!(!matches!(heard, Ok(Ok(64..))), "{nonsense}");
    }
    let mut polite = TcpStream::connect(address).await.unwrap();
    let seen = exchange(&mut polite, "00 02 00 00 00 06 FF 03 06 0A 00 01").await;
    assert_eq!(seen, bytes("00 02 00 00 00 05 FF 03 02 03 E8"));
}

#[cfg(unix)]
#[tokio::test]
async fn one_program_after_another_opens_the_pseudo_terminal() {
    use handscope::transport::{SerialLine, serial};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hand");
    let hand = shared(Personality::default());
    let served = tokio::spawn(pty::serve_rs485(hand, &path, None).unwrap());
    let place = SerialLine {
        port: path.to_str().unwrap().into(),
        baud: 115_200,
        id: 1,
        packing: None,
    };
    for _ in 0..3 {
        let mut port = serial::open(&place).unwrap();
        port.write_all(&bytes("EB 90 01 04 11 0A 06 0C 32"))
            .await
            .unwrap();
        let mut reply = [0; 20];
        timeout(Duration::from_secs(5), port.read_exact(&mut reply))
            .await
            .unwrap()
            .unwrap();
        assert_eq!(reply[..7], bytes("90 EB 01 0F 11 0A 06")[..]);
        // The program goes in the middle of a request; the next one must not suffer from it.
        port.write_all(&bytes("EB 90 01 FF 12")).await.unwrap();
        drop(port);
        tokio::time::sleep(Duration::from_millis(120)).await;
    }
    served.abort();
    assert!(served.await.is_err());
    assert!(std::fs::symlink_metadata(&path).is_err());
}

#[cfg(unix)]
#[tokio::test]
async fn adapters_answer_in_the_lines_time_so_that_who_clears_the_buffer_after_writing_loses_nothing()
 {
    use std::io::{Read as _, Write as _};
    use tokio::task::spawn_blocking;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let hand = shared(Personality::default());
    tokio::spawn(pty::serve_slcan(hand.clone(), &at("slcan")).unwrap());
    tokio::spawn(pty::serve_usbcan(hand, &at("usbcan")).unwrap());
    let packets = packet(0x0184_0001, [2, 0, 0, 0, 0, 0, 0, 0], 1);
    let reply = packet(0x0184_0001, [0xE8, 3, 0, 0, 0, 0, 0, 0], 2);
    for (path, begin, asked, reply, bytes_us) in [
        // A bus of 1 Mbit/s.
        (at("usbcan"), vec![], packets.clone(), reply, 10),
        (
            at("slcan"),
            b"S8\rO\r".to_vec(),
            b"T01840001102\r".to_vec(),
            b"Z\rT018400012E803\r".to_vec(),
            10,
        ),
    ] {
        spawn_blocking(move || {
            let mut port = std::fs::OpenOptions::new();
            let mut port = port.read(true).write(true).open(path).unwrap();
            let mut raw = rustix::termios::tcgetattr(&port).unwrap();
            raw.make_raw();
            rustix::termios::tcsetattr(&port, rustix::termios::OptionalActions::Now, &raw).unwrap();
            if !begin.is_empty() {
                port.write_all(&begin).unwrap();
                let mut done = [0; 2];
                port.read_exact(&mut done).unwrap();
                assert_eq!(done, *b"\r\r");
            }
            let begun = std::time::Instant::now();
            port.write_all(&asked).unwrap();
            let mut heard = vec![0; reply.len()];
            port.read_exact(&mut heard).unwrap();
            let took = begun.elapsed();
            assert_eq!(heard, reply);
            let line = bytes_us * (asked.len() + reply.len()) as u64;
            let least = Duration::from_micros(300 + line);
            assert!(took >= least, "{took:?} < {least:?}");
        })
        .await
        .unwrap();
    }
}
