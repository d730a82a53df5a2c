//! Each switch does what it says, seen on the wire.

use crate::setup::hand;
use handscope::codec::modbus_rtu::crc16;
use handscope::hand::register::{ANGLE_ACT, ANGLE_SET, DEFAULT_SPEED_SET, Register, SPEED_SET};
use handscope::hand::{Dof, Fault, Moment, Span, TactileBlock};
use handscope::sim::serve::{modbus_rtu, modbus_tcp, rs485};
use handscope::sim::{NoSwitch, Personality, SWITCHES, SharedHand, SimHand};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::timeout;

/// Longer than any answer that is not late on purpose.
const PATIENCE: Duration = Duration::from_millis(200);

fn hand(switches: &[(&str, &str)]) -> SimHand {
    let mut personality = Personality::default();
    for (name, value) in switches {
        personality.set(name, value).unwrap();
    }
    hand::free(hand::like(personality))
}

fn shared(switches: &[(&str, &str)]) -> SharedHand {
    hand::begin(hand(switches))
}

fn ms(ms: u64) -> Moment {
    Moment::ZERO.plus(Duration::from_millis(ms))
}

fn put(hand: &mut SimHand, row: &Register, value: i16, at: u64) {
    let bytes: Vec<u8> = [value; 6]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    hand.write(row.address, &bytes, ms(at)).unwrap();
}

fn first(hand: &mut SimHand, row: &Register, at: u64) -> i16 {
    let bytes = hand.read(Span::new(row.address, 2), ms(at)).unwrap();
    i16::from_le_bytes([bytes[0], bytes[1]])
}

async fn heard(wire: &mut DuplexStream) -> Vec<u8> {
    let mut all = Vec::new();
    let mut chunk = [0; 512];
    while let Ok(Ok(len @ 1..)) = timeout(PATIENCE, wire.read(&mut chunk)).await {
        all.extend(&chunk[..len]);
    }
    all
}

fn hex(text: &str) -> Vec<u8> {
    let bytes = text.split_whitespace();
    bytes
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

/// What a hand says over Modbus RTU, without unit and check; empty for silence.
async fn modbus(switches: &[(&str, &str)], request: &str) -> Vec<u8> {
    let (mut near, far) = tokio::io::duplex(2048);
    tokio::spawn(modbus_rtu::serve(shared(switches), far));
    let mut frame = [&[1], hex(request).as_slice()].concat();
    frame.extend(crc16(&frame).to_le_bytes());
    near.write_all(&frame).await.unwrap();
    let reply = heard(&mut near).await;
    match reply.as_slice() {
        [] => Vec::new(),
        [1, pdu @ .., _, _] => pdu.to_vec(),
        other => panic!("{other:02X?}"),
    }
}

/// What a hand says in the maker's framing within a time.
async fn serial(switches: &[(&str, &str)], request: &str, within: Duration) -> Vec<u8> {
    let (mut near, far) = tokio::io::duplex(2048);
    tokio::spawn(rs485::serve(shared(switches), far));
    near.write_all(&hex(request)).await.unwrap();
    tokio::time::sleep(within).await;
    heard(&mut near).await
}

#[test]
fn switches_are_set_by_name_and_unknown_ones_are_named() {
    let mut personality = Personality::default();
    for switch in SWITCHES {
        for value in switch.values {
            personality.set(switch.name, value).unwrap();
        }
        personality.set(switch.name, switch.values[0]).unwrap();
    }
    assert_eq!(
        personality,
        Personality::default(),
        "the first position is the default"
    );
    let name = "warp".into();
    assert_eq!(personality.set("warp", "9"), Err(NoSwitch::Name { name }));
    let wrong = personality.set("gap", "ajar").unwrap_err().to_string();
    assert!(wrong.contains("through, refused"), "{wrong}");
}

#[test]
fn minus_one_freezes_is_ignored_or_opens() {
    for (value, stays, ends) in [
        ("freeze", true, None),
        ("ignore", false, Some(0)),
        ("clamp", false, Some(1000)),
    ] {
        let mut hand = hand(&[("minus-one", value)]);
        put(&mut hand, &ANGLE_SET, 0, 0);
        put(&mut hand, &ANGLE_SET, -1, 300);
        let after = first(&mut hand, &ANGLE_ACT, 380);
        let end = first(&mut hand, &ANGLE_ACT, 3000);
        assert_eq!(end == after, stays, "{value}: {after} {end}");
        assert!(ends.is_none_or(|ends| ends == end), "{value}: {end}");
    }
}

#[test]
fn no_speed_freezes_creeps_or_is_not_taken() {
    for (value, speed, least, most) in [
        ("freeze", 0, 1000, 1000),
        ("slowest", 0, 900, 999),
        ("ignored", 1000, 0, 0),
    ] {
        let mut hand = hand(&[("speed-zero", value)]);
        put(&mut hand, &SPEED_SET, 0, 0);
        assert_eq!(first(&mut hand, &SPEED_SET, 1), speed, "{value}");
        put(&mut hand, &ANGLE_SET, 0, 1);
        let angle = first(&mut hand, &ANGLE_ACT, 3000);
        assert!((least..=most).contains(&angle), "{value}: {angle}");
    }
}

#[tokio::test(start_paused = true)]
async fn values_out_of_range_are_dropped_clamped_refused_or_wrapped() {
    for (value, kept, reply) in [
        ("drop", 1000, "06 05 CE 03 EB"),
        ("clamp", 1000, "06 05 CE 03 EB"),
        ("wrap", 2, "06 05 CE 03 EB"),
        ("exception", 1000, "86 03"),
    ] {
        let switches = [("out-of-range", value)];
        // 1003 to ANGLE_SET of the little finger; the range is 0 to 1000.
        assert_eq!(
            modbus(&switches, "06 05 CE 03 EB").await,
            hex(reply),
            "{value}"
        );
        let mut hand = hand(&switches);
        let _said = hand.write(1486, &1003i16.to_le_bytes(), ms(0));
        assert_eq!(first(&mut hand, &ANGLE_SET, 0), kept, "{value}");
    }
}

#[tokio::test(start_paused = true)]
async fn writes_to_what_can_only_be_read_are_acknowledged_refused_or_met_with_silence() {
    for (value, over_modbus, over_serial) in [
        ("ack", "06 06 0A 00 01", "90 EB 01 04 12 0A 06 01 28"),
        ("nak", "86 02", "90 EB 01 04 12 0A 06 00 27"),
        ("nothing", "", ""),
    ] {
        let switches = [("read-only", value)];
        assert_eq!(
            modbus(&switches, "06 06 0A 00 01").await,
            hex(over_modbus),
            "{value}"
        );
        let said = serial(&switches, "EB 90 01 05 12 0A 06 01 00 29", Duration::ZERO).await;
        assert_eq!(said, hex(over_serial), "{value}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_change_of_id_is_acknowledged_by_the_new_the_old_or_none() {
    for (value, reply) in [
        ("new", "90 EB 02 04 12 E8 03 01 04"),
        ("old", "90 EB 01 04 12 E8 03 01 03"),
        ("none", ""),
    ] {
        let switches = [("change-ack", value)];
        let said = serial(&switches, "EB 90 01 04 12 E8 03 02 04", Duration::ZERO).await;
        assert_eq!(said, hex(reply), "{value}");
        let said = modbus(&switches, "06 03 EA 00 01").await;
        assert_eq!(said.is_empty(), value == "none", "{value}");
    }
}

#[test]
fn a_new_id_and_speed_act_at_once_at_save_or_at_power_up() {
    for (value, steps) in [
        ("now", [7, 7, 7]),
        ("after-save", [1, 7, 7]),
        ("after-power", [1, 1, 7]),
    ] {
        let mut hand = hand(&[("id-effect", value), ("baud-effect", value)]);
        let mut seen = Vec::new();
        hand.write(1000, &[7], ms(0)).unwrap();
        hand.write(1002, &[3], ms(0)).unwrap();
        seen.push((hand.id(), hand.baud_code()));
        hand.write(1005, &[1], ms(1)).unwrap();
        seen.push((hand.id(), hand.baud_code()));
        hand.power_cycle(ms(2));
        seen.push((hand.id(), hand.baud_code()));
        let expected = steps.map(|id| (id, if id == 7 { 3 } else { 0 }));
        assert_eq!(seen, expected, "{value}");
    }
}

#[test]
fn the_result_of_save_comes_late_twice_never_or_says_no() {
    for (value, times, ok) in [
        ("command-12", &[1000][..], true),
        ("command-11", &[1000], true),
        ("late", &[5000], true),
        ("never", &[], true),
        ("twice", &[1000, 1100], true),
        ("failed", &[1000], false),
    ] {
        let mut hand = hand(&[("save-result", value)]);
        hand.write(1005, &[1], ms(0)).unwrap();
        let mut came = Vec::new();
        for at in (0..6000).step_by(50) {
            while let Some(frame) = hand.late_save_result(ms(at)) {
                assert_eq!(
                    (frame.ok, frame.command),
                    (ok, if value == "command-11" { 0x11 } else { 0x12 })
                );
                came.push(at);
            }
        }
        assert_eq!(came, times, "{value}");
    }
}

#[test]
fn what_is_saved_is_in_flash_at_once_or_after_a_second_with_power() {
    for (value, cut_at, kept) in [
        ("at-once", 1, 700),
        ("slowly", 900, 1000),
        ("slowly", 1100, 700),
    ] {
        let mut hand = hand(&[("flash", value)]);
        put(&mut hand, &DEFAULT_SPEED_SET, 700, 0);
        hand.write(1005, &[1], ms(0)).unwrap();
        hand.power_cycle(ms(cut_at));
        assert_eq!(
            first(&mut hand, &DEFAULT_SPEED_SET, cut_at),
            kept,
            "{value}"
        );
    }
}

#[tokio::test]
async fn defaults_are_taken_dropped_clamped_or_refused() {
    for (value, holds, reply) in [
        ("take", 700, "10 04 08 00 06"),
        ("drop", 1000, "10 04 08 00 06"),
        ("clamp", 500, "10 04 08 00 06"),
        ("exception", 1000, "90 03"),
    ] {
        let request = format!("10 04 08 00 06 0C{}", " 02 BC".repeat(6));
        assert_eq!(modbus(&[("defaults", value)], &request).await, hex(reply));
        let mut hand = hand(&[("defaults", value)]);
        let _refused = hand.write(1032, &[0xBC, 2].repeat(6), ms(0));
        assert_eq!(first(&mut hand, &DEFAULT_SPEED_SET, 1), holds, "{value}");
    }
}

#[tokio::test(start_paused = true)]
async fn single_bytes_stand_in_words_in_three_ways() {
    // Six words at TEMP, then one at HAND_ID.
    for (value, id) in [
        ("low-first", "03 02 00 01"),
        ("high-first", "03 02 01 00"),
        ("one-per-word", "03 02 00 01"),
    ] {
        let switches = [("byte-words", value)];
        let temperatures = modbus(&switches, "03 06 52 00 06").await;
        let alone = |pair: &[u8]| pair[0] == 0 && pair[1] > 0;
        assert_eq!(
            temperatures[2..].chunks(2).all(alone),
            value == "one-per-word",
            "{value}"
        );
        assert_eq!(
            modbus(&switches, "03 03 E8 00 01").await,
            hex(id),
            "{value}"
        );
    }
    // The hazard: SAVE = 1 lands in RESET_PARA.
    let hand = shared(&[("byte-words", "high-first")]);
    let (mut near, far) = tokio::io::duplex(256);
    tokio::spawn(modbus_rtu::serve(hand.clone(), far));
    let mut frame = hex("01 06 03 ED 00 01");
    frame.extend(crc16(&frame).to_le_bytes());
    near.write_all(&frame).await.unwrap();
    heard(&mut near).await;
    let written = hand.with(|hand, _| hand.journal()[0].clone());
    assert_eq!((written.address, written.bytes), (1005, vec![0, 1]));
}

#[tokio::test(start_paused = true)]
async fn an_address_inside_a_group_is_a_byte_an_index_or_refused() {
    // One word at 1472 + 2: the second POS_SET is at 1476, the second register counted from 1474 is 1475.
    for (value, reply) in [
        ("byte", "03 02 03 E8"),
        ("index", "03 02 00 00"),
        ("exception", "83 02"),
    ] {
        // The last ANGLE_ACT; as an index it leads to 1566, which is unused.
        let said = modbus(&[("inner-address", value)], "03 06 14 00 01").await;
        assert_eq!(said, hex(reply), "{value}");
        let base = modbus(&[("inner-address", value)], "03 06 0A 00 01").await;
        assert_eq!(base, hex("03 02 03 E8"), "{value}");
    }
}

#[tokio::test(start_paused = true)]
async fn reads_that_are_too_long_are_cut_refused_or_met_with_silence() {
    for (value, len) in [("exception", 2), ("truncate", 252), ("silence", 0)] {
        let switches = [("long-read", value)];
        assert_eq!(
            modbus(&switches, "03 0B B8 00 7E").await.len(),
            len,
            "{value}"
        );
        let request = "EB 90 01 04 11 B8 0B FF D8";
        let said = serial(&switches, request, Duration::ZERO).await;
        assert_eq!(
            !said.is_empty(),
            value == "truncate",
            "{value}: {}",
            said.len()
        );
    }
}

#[test]
fn the_unused_addresses_are_zeros_or_refused() {
    let read = |value| hand(&[("gap", value)]).read(Span::new(1546, 38), ms(0));
    assert_eq!(read("through").unwrap()[12..36], [0; 24]);
    assert!(read("refused").is_err());
}

#[tokio::test(start_paused = true)]
async fn beyond_the_memory_there_is_nothing_or_zeros() {
    for (value, over_modbus, over_serial) in [("refused", 2, 0), ("zeros", 18, 16)] {
        let switches = [("beyond", value)];
        // Eight words and bytes from 4092 on, and from 5000 on, where the resistive hand has its palm.
        for (words, bytes) in [
            ("03 0F FC 00 08", "EB 90 01 04 11 FC 0F 08 29"),
            ("03 13 88 00 08", "EB 90 01 04 11 88 13 08 B9"),
        ] {
            let said = modbus(&switches, words).await;
            assert_eq!(said.len(), over_modbus, "{value}: {said:02X?}");
            let said = serial(&switches, bytes, Duration::ZERO).await;
            assert_eq!(said.len(), over_serial, "{value}: {said:02X?}");
            let data = said.get(7..15).unwrap_or_default();
            assert!(data.iter().all(|byte| *byte == 0));
        }
        let last = modbus(&switches, "03 FF FE 00 01").await;
        assert_eq!(last.len() == 4, value == "zeros", "{value}: {last:02X?}");
        assert_eq!(modbus(&switches, "03 FF FF 00 01").await, hex("83 02"));
    }
}

#[tokio::test(start_paused = true)]
async fn ids_0_and_255_are_nobodys_or_every_hands() {
    for (value, reply) in [("silent", ""), ("answered", "90 EB 01 04 12 DA 05 01 F7")] {
        let switches = [("any-id", value)];
        for request in [
            "EB 90 00 05 12 DA 05 64 00 5A",
            "EB 90 FF 05 12 DA 05 64 00 59",
        ] {
            let said = serial(&switches, request, Duration::ZERO).await;
            assert_eq!(said, hex(reply), "{value}");
        }
        let said = serial(&switches, "EB 90 FF 04 11 E8 03 01 00", Duration::ZERO).await;
        assert_eq!(said.get(7).copied(), (value == "answered").then_some(1));
        let other = serial(&switches, "EB 90 02 04 11 E8 03 01 03", Duration::ZERO).await;
        assert!(other.is_empty(), "{value}");
    }
}

#[test]
fn a_calibration_takes_two_or_six_seconds() {
    for (value, takes_ms) in [("6s", 6000), ("2s", 2000)] {
        let mut hand = hand(&[("calibration", value)]);
        hand.write(1009, &[1], ms(100)).unwrap();
        assert_eq!(hand.next_calibration_end(), Some(ms(100 + takes_ms)));
        assert!(!hand.late_calibration_end(ms(99 + takes_ms)), "{value}");
        assert!(hand.late_calibration_end(ms(100 + takes_ms)), "{value}");
    }
}

#[test]
fn a_joint_stays_or_goes_on_after_its_errors_are_cleared() {
    for (value, goes_on) in [("stay", false), ("resume", true)] {
        let mut hand = hand(&[("clear-error", value)]);
        put(&mut hand, &ANGLE_SET, 0, 0);
        hand.advance_to(ms(250));
        hand.inject_fault(Dof::Little, Fault::Motor);
        let stopped = first(&mut hand, &ANGLE_ACT, 300);
        hand.write(1004, &[1], ms(400)).unwrap();
        let end = first(&mut hand, &ANGLE_ACT, 3000);
        assert_eq!(end == 0, goes_on, "{value}: {stopped} {end}");
        assert_eq!(end == stopped, !goes_on, "{value}: {stopped} {end}");
    }
}

#[tokio::test(start_paused = true)]
async fn an_rtu_reply_comes_whole_or_with_a_pause() {
    for (value, pieces) in [("whole", 1), ("split", 2)] {
        let (mut near, far) = tokio::io::duplex(256);
        tokio::spawn(modbus_rtu::serve(shared(&[("rtu-reply", value)]), far));
        let mut frame = hex("01 03 06 0A 00 06");
        frame.extend(crc16(&frame).to_le_bytes());
        near.write_all(&frame).await.unwrap();
        let (mut chunk, mut count, mut all) = ([0; 256], 0, 0);
        while let Ok(Ok(len @ 1..)) = timeout(PATIENCE, near.read(&mut chunk)).await {
            (count, all) = (count + 1, all + len);
        }
        assert_eq!((count, all), (pieces, 17), "{value}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_tcp_reply_carries_one_of_three_units() {
    for (value, unit) in [("echo", 9), ("ff", 255), ("zero", 0)] {
        let (mut near, far) = tokio::io::duplex(256);
        tokio::spawn(modbus_tcp::serve_client(
            shared(&[("reply-unit", value)]),
            far,
        ));
        near.write_all(&hex("00 07 00 00 00 06 09 03 03 E8 00 01"))
            .await
            .unwrap();
        let reply = heard(&mut near).await;
        assert_eq!(reply[..7], [0, 7, 0, 0, 0, 5, unit], "{value}");
    }
}

#[tokio::test(start_paused = true)]
async fn function_06_is_repeated_or_answered_by_zeros() {
    for (value, reply) in [("echo", "06 05 DA 01 F4"), ("zeros", "06 00 00 00 00")] {
        let said = modbus(&[("single-reply", value)], "06 05 DA 01 F4").await;
        assert_eq!(said, hex(reply), "{value}");
    }
}

#[tokio::test]
async fn one_client_keeps_others_out_or_yields_to_the_newest() {
    for (value, first_lives, second_lives) in [
        ("many", true, true),
        ("one", true, false),
        ("newest", false, true),
    ] {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        tokio::spawn(modbus_tcp::serve(
            shared(&[("tcp-clients", value)]),
            listener,
        ));
        let mut first = TcpStream::connect(address).await.unwrap();
        assert!(answers(&mut first).await, "{value}");
        let mut second = TcpStream::connect(address).await.unwrap();
        assert_eq!(answers(&mut second).await, second_lives, "{value}");
        assert_eq!(answers(&mut first).await, first_lives, "{value}");
    }
}

async fn answers(stream: &mut TcpStream) -> bool {
    let asked = stream
        .write_all(&hex("00 07 00 00 00 06 01 03 03 E8 00 01"))
        .await;
    let mut reply = [0; 11];
    asked.is_ok() && stream.read_exact(&mut reply).await.is_ok()
}

#[test]
fn the_check_of_a_fingertip_is_one_of_three() {
    for (value, is_sum, is_zero) in [
        ("block", true, false),
        ("sensor", false, false),
        ("zero", false, true),
    ] {
        let mut hand = hand(&[("tactile-check", value)]);
        let bytes = hand.read(Span::new(3000, 58), ms(100)).unwrap();
        let block = TactileBlock::decode(&bytes).unwrap();
        assert_eq!(
            (block.check_ok(), block.check == 0),
            (is_sum, is_zero),
            "{value}"
        );
    }
}

#[test]
fn answers_take_no_time_some_or_now_and_then_much() {
    for (value, least, most) in [("given", 0, 0), ("3-15ms", 3, 15), ("rare-500ms", 3, 500)] {
        let mut hand = hand(&[("thinking", value)]);
        let times: Vec<u128> = (0..8000).map(|_| hand.manner().after.as_millis()).collect();
        assert_eq!(times.iter().max(), Some(&most), "{value}");
        assert_eq!(times.iter().min(), Some(&least), "{value}");
        let slow = times.iter().filter(|time| **time == 500).count();
        assert!(
            slow < 70 && (slow > 10) == (value == "rare-500ms"),
            "{value}: {slow}"
        );
    }
}

#[test]
fn some_answers_come_twice() {
    for (value, some) in [("never", false), ("some", true)] {
        let mut hand = hand(&[("doubles", value)]);
        let twice = (0..1600).filter(|_| hand.manner().copies == 2).count();
        assert_eq!((50..200).contains(&twice), some, "{value}: {twice}");
    }
}

#[test]
fn the_power_fails_for_half_a_second_and_targets_are_gone() {
    let mut hand = hand(&[("power", "cut")]);
    put(&mut hand, &SPEED_SET, 20, 0);
    put(&mut hand, &ANGLE_SET, 0, 0);
    let before = first(&mut hand, &ANGLE_ACT, 2999);
    assert!(hand.read(Span::new(1546, 12), ms(3000)).is_err());
    assert!(hand.write(1486, &[0, 0], ms(3499)).is_err());
    assert_eq!(first(&mut hand, &ANGLE_ACT, 3500), before);
    assert_eq!(
        first(&mut hand, &ANGLE_ACT, 6000),
        before,
        "nothing moves on"
    );
    assert_eq!(first(&mut hand, &SPEED_SET, 6000), 1000);
}
