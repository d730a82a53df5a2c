//! The simulated hand on wires: frames and messages byte by byte, never through our own client.
#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "a test may"
)]

use handscope::hand::Dof;
#[cfg(unix)]
use handscope::sim::serve::pty;
use handscope::sim::serve::{can, modbus_tcp, rs485, slcan};
use handscope::sim::{Object, Personality, SharedHand, SimConfig, SimHand};
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
    let mut hand = SimHand::new(SimConfig {
        personality,
        ..SimConfig::default()
    });
    hand.set_object(&Object::none());
    SharedHand::new(hand, Instant::now())
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
    let mut byte = [0];
    let heard = timeout(Duration::from_millis(500), wire.read(&mut byte)).await;
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
        ("R018400011\r", "\r"),
        ("C\r", "\r"),
    ] {
        wire.write_all(request.as_bytes()).await.unwrap();
        let heard = hear(&mut wire, reply.len()).await;
        assert_eq!(heard, reply.as_bytes(), "{request}");
        silent(&mut wire).await;
    }
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
