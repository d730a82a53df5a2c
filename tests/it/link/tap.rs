//! The tap: what went over each wire, cut into frames, with what is wrong about the wrong ones. Frames are the manual's
//! or reckoned by hand, not made by our encoder; live links run in virtual time.

use crate::setup::faulty::{FaultOdds, FaultPlan, faulty_pair};
use crate::setup::hand;
use crate::setup::link::{self, Client};
use handscope::hand::{Moment, Span};
use handscope::link::tap::WireTap;
use handscope::link::traffic::fields::FieldName;
use handscope::link::traffic::frame::{Frame, Kind, Wrong};
use handscope::link::traffic::reader::FRAMES_MAX;
use handscope::link::{Clock, Traffic};
use handscope::record::{Direction, PieceKind};
use handscope::sim::serve::{modbus_tcp, rs485};
use handscope::transport::{Dial, SystemDial};
use std::sync::Arc;
use tokio::time::{Duration, sleep};

const OUT: PieceKind = PieceKind::Bytes(Direction::ToHand);
const IN: PieceKind = PieceKind::Bytes(Direction::FromHand);

const RS485: &str = "rs485:/dev/ttyUSB0?id=1";
const RTU: &str = "rtu:/dev/ttyUSB0?id=1";
const TCP: &str = "tcp:127.0.0.1:6000?unit=255";
const SLCAN: &str = "slcan:/dev/ttyACM0?id=1";
const USBCAN: &str = "usbcan:/dev/ttyUSB0?id=1";

/// ANGLE_ACT of hand 1, 12 bytes: manual 2.2.1.
const ASK: [u8; 9] = [0xEB, 0x90, 1, 4, 0x11, 0x0A, 0x06, 12, 0x32];
const ANSWER: [u8; 20] = [
    0x90, 0xEB, 1, 15, 0x11, 0x0A, 0x06, 0xE8, 3, 0xE8, 3, 0xE8, 3, 0xE8, 3, 0xF4, 1, 0, 0, 0xE8,
];

fn micros(millis: u64) -> Moment {
    Moment::from_micros(millis * 1000)
}

/// The frames of these pieces, one a millisecond; then silence.
fn frames(endpoint: &str, pieces: &[(PieceKind, &[u8])]) -> Vec<Arc<Frame>> {
    let tap = WireTap::default();
    for (at, (kind, bytes)) in (1..).zip(pieces) {
        tap.record(micros(at), *kind, bytes);
    }
    let mut traffic = Traffic::of(tap, &endpoint.parse().unwrap());
    traffic.read_on(micros(60_000));
    traffic.frames().iter().cloned().collect()
}

type Told = (Kind, Option<Wrong>);

fn told(endpoint: &str, pieces: &[(PieceKind, &[u8])]) -> Vec<Told> {
    let all = frames(endpoint, pieces);
    all.iter().map(|frame| (frame.kind, frame.wrong)).collect()
}

fn answer() -> [u8; 20] {
    let mut frame = ANSWER;
    frame[19] = frame[2..19]
        .iter()
        .fold(0, |sum, byte| sum.wrapping_add(*byte));
    frame
}

#[test]
fn a_read_and_its_reply_say_registers_numbers_and_how_long_it_took() {
    let all = frames(
        RS485,
        &[(OUT, &ASK), (IN, &answer()[..7]), (IN, &answer()[7..])],
    );
    assert_eq!(all.len(), 2);
    assert_eq!(all[0].meaning(), "ANGLE_ACT");
    assert_eq!(all[0].span, Some(Span::new(1546, 12)));
    assert_eq!(all[1].meaning(), "ANGLE_ACT 1000 1000 1000 1000 500 0");
    assert_eq!((all[1].hand, all[1].at), (Some(1), micros(3)));
    assert_eq!(all[1].took, Some(Duration::from_millis(2)));
    assert_eq!(all[1].hex()[..8], *"90 EB 01");
    assert!(all.iter().all(|frame| frame.is_polling()));
}

#[test]
fn each_wrong_frame_on_rs485_says_what_is_wrong() {
    let good = answer();
    let mut bad_sum = good;
    bad_sum[19] ^= 0x40;
    let mut foreign = good;
    foreign[2] = 2;
    foreign[19] = foreign[19].wrapping_add(1);
    let mut elsewhere = good;
    elsewhere[5] += 2;
    elsewhere[19] = elsewhere[19].wrapping_add(2);
    let short = [0x90, 0xEB, 1, 5, 0x11, 0x0A, 0x06, 7, 0, 0x2E];
    let sum = Wrong::Checksum {
        got: bad_sum[19],
        want: good[19],
    };
    let cut_off = Wrong::CutOff {
        got: 11,
        want: Some(20),
    };
    let address = Wrong::Address {
        got: 1548,
        want: 1546,
    };
    let head = Wrong::BadHead {
        len: 2,
        command: Some(0x11),
    };
    let reply = Kind::ReadReply;
    let cases: [(&[u8], Kind, Wrong); 8] = [
        (&bad_sum, reply, sum),
        (&foreign, reply, Wrong::ForeignId { got: 2, want: 1 }),
        (&elsewhere, reply, address),
        (&short, reply, Wrong::Amount { got: 2, want: 12 }),
        (&good[..11], Kind::Noise, cut_off),
        (&[0, 0xFF, 7], Kind::Noise, Wrong::NoFrame { len: 3 }),
        (&[0x90, 0xEB, 1, 2, 0x11], Kind::Noise, head),
        (&ASK, Kind::Read, Wrong::Echo),
    ];
    for (bytes, kind, wrong) in cases {
        let all = told(RS485, &[(OUT, &ASK), (IN, bytes)]);
        assert!(all.contains(&(kind, Some(wrong))), "{all:?} lacks {wrong}");
        let asked_again = (Kind::Read, Some(Wrong::NoReply));
        let is_answer = matches!(wrong, Wrong::Amount { .. });
        assert_eq!(all.contains(&asked_again), !is_answer, "{wrong}: {all:?}");
    }
    let write = [0xEB, 0x90, 1, 5, 0x12, 0xCE, 5, 0xE8, 3, 0xD6];
    let not_taken = [0x90, 0xEB, 1, 4, 0x12, 0xCE, 5, 0, 0xEA];
    let refused = (Kind::WriteReply, Some(Wrong::NotTaken { value: 0 }));
    let all = told(RS485, &[(OUT, &write), (IN, &not_taken)]);
    assert_eq!(all, [(Kind::Write, None), refused]);
    assert_eq!(
        told(RS485, &[(IN, &good)]),
        [(reply, Some(Wrong::NotAsked))]
    );
}

#[test]
fn a_good_frame_behind_a_damaged_one_is_found() {
    let mut bytes = answer()[..9].to_vec();
    bytes.extend(answer());
    let all = told(RS485, &[(OUT, &ASK), (IN, &bytes)]);
    let kinds: Vec<_> = all
        .iter()
        .map(|(kind, wrong)| (*kind, wrong.is_some()))
        .collect();
    let good = (Kind::ReadReply, false);
    assert_eq!(kinds.first(), Some(&(Kind::Read, false)));
    assert_eq!(kinds.last(), Some(&good), "{all:?}");
    assert!(kinds[1..kinds.len() - 1].iter().all(|(_, wrong)| *wrong));
}

#[test]
fn a_reply_after_the_request_was_given_up_is_late_and_the_request_without_reply() {
    let all = told(
        RS485,
        &[(OUT, &ASK), (OUT, &ASK), (IN, &answer()), (IN, &answer())],
    );
    let late = Wrong::Late { after_ms: 3 };
    assert_eq!(
        all,
        [
            (Kind::Read, Some(Wrong::NoReply)),
            (Kind::Read, None),
            (Kind::ReadReply, None),
            (Kind::ReadReply, Some(late)),
        ]
    );
}

#[test]
fn the_late_result_of_a_save_is_told_from_its_acknowledgement() {
    // Manual 2.2.2: SAVE is 1005.
    let save = [0xEB, 0x90, 1, 4, 0x12, 0xED, 3, 1, 0x08];
    let taken = [0x90, 0xEB, 1, 4, 0x12, 0xED, 3, 1, 0x08];
    let failed = [0x90, 0xEB, 1, 4, 0x12, 0xED, 3, 0xFF, 0x06];
    let all = told(RS485, &[(OUT, &save), (IN, &taken), (IN, &failed)]);
    let not_saved = Wrong::NotSaved { value: 0xFF };
    assert_eq!(
        all,
        [
            (Kind::Write, None),
            (Kind::WriteReply, None),
            (Kind::SaveResult, Some(not_saved)),
        ]
    );
}

#[test]
fn modbus_rtu_is_cut_by_its_check_and_says_what_differs() {
    // Manual 2.4.1's read of two words at 1 and its reply, with the checks reckoned by the standard's table.
    let ask = [1, 3, 0, 1, 0, 2, 0x95, 0xCB];
    let reply = [1, 3, 4, 0, 1, 0, 2, 0x2A, 0x32];
    let mut bad = reply;
    bad[7] ^= 1;
    let crc = Wrong::Crc {
        got: 0x322B,
        want: 0x322A,
    };
    let refusal = [1, 0x83, 2, 0xC0, 0xF1];
    for (bytes, kind, wrong) in [
        (&reply[..], Kind::ReadReply, None),
        (&bad, Kind::ReadReply, Some(crc)),
        (&refusal, Kind::Refusal, Some(Wrong::Refused { code: 2 })),
        (&ask, Kind::Read, Some(Wrong::Echo)),
    ] {
        let all = told(RTU, &[(OUT, &ask), (IN, bytes)]);
        assert_eq!(all[1], (kind, wrong), "{bytes:?}");
    }
}

#[test]
fn modbus_tcp_replies_belong_to_their_number() {
    let ask = [0, 7, 0, 0, 0, 6, 255, 3, 0x06, 0x0A, 0, 1];
    let reply = [0, 7, 0, 0, 0, 5, 255, 3, 2, 0x03, 0xE8];
    let mut other = reply;
    other[1] = 9;
    let mut foreign = reply;
    foreign[6] = 1;
    let mut protocol = reply;
    protocol[3] = 1;
    let number = Wrong::Transaction { got: 9, want: 7 };
    let unit = Wrong::ForeignId { got: 1, want: 255 };
    for (bytes, kind, wrong) in [
        (reply, Kind::ReadReply, None),
        (other, Kind::ReadReply, Some(number)),
        (foreign, Kind::ReadReply, Some(unit)),
        (protocol, Kind::Noise, Some(Wrong::Protocol { got: 1 })),
    ] {
        let all = told(TCP, &[(OUT, &ask), (IN, &bytes)]);
        assert_eq!(all[1], (kind, wrong), "{bytes:?}");
    }
    let all = frames(TCP, &[(OUT, &ask), (IN, &reply)]);
    assert_eq!(all[1].meaning(), "ANGLE_ACT(0) 1000");
}

#[test]
fn lines_of_a_can_adapter_are_told_from_frames_of_the_hand() {
    // Manual 2.3.1: ANGLE_ACT(3) of hand 1 and its answer 500.
    let all = frames(
        SLCAN,
        &[
            (OUT, b"S8\r"),
            (IN, b"\r"),
            (OUT, b"O\r"),
            (IN, b"\x07"),
            (OUT, b"T01840001102\r"),
            (IN, b"Z\rT018400012F401\r"),
            (IN, b"T0184zz\r"),
        ],
    );
    let wrong: Vec<Told> = all.iter().map(|frame| (frame.kind, frame.wrong)).collect();
    assert_eq!(
        wrong,
        [
            (Kind::Adapter, None),
            (Kind::AdapterReply, None),
            (Kind::Adapter, None),
            (Kind::AdapterReply, Some(Wrong::AdapterFailed)),
            (Kind::Read, None),
            (Kind::AdapterReply, None),
            (Kind::ReadReply, None),
            (Kind::Noise, Some(Wrong::Line)),
        ]
    );
    assert_eq!(all[6].meaning(), "ANGLE_ACT(3) 500");
    assert_eq!(all[0].meaning(), "S8\\r");
}

#[test]
fn packets_of_the_makers_can_adapter_are_taken_apart() {
    // The same as a real hand said it; the sum is 55 and has A5 before it.
    let ask = hex("AA AA 01 00 84 01 02 00 00 00 00 00 00 00 01 00 01 00 8A 55 55");
    let answer = hex("AA AA 01 00 84 01 C9 03 00 00 00 00 00 00 02 00 01 00 A5 55 55 55");
    let setting = hex("AA AA D0 FE FF 01 40 42 0F 00 00 00 00 00 04 FF 01 00 63 55 55");
    let mut bad = ask.clone();
    bad[18] = 0x8B;
    let pieces: [(PieceKind, &[u8]); 7] = [
        (OUT, &ask[..]),
        (IN, &answer[..5]),
        (IN, &answer[5..]),
        (OUT, &setting),
        (IN, &ask),
        (IN, &bad),
        (IN, b"\x00\x01"),
    ];
    let all = frames(USBCAN, &pieces);
    let wrong: Vec<Told> = all.iter().map(|frame| (frame.kind, frame.wrong)).collect();
    let sum = Wrong::Checksum {
        got: 0x8B,
        want: 0x8A,
    };
    assert_eq!(
        wrong,
        [
            (Kind::Read, None),
            (Kind::ReadReply, None),
            (Kind::Adapter, None),
            (Kind::ReadReply, Some(Wrong::NotAsked)),
            (Kind::Noise, Some(sum)),
            (Kind::Noise, Some(Wrong::NoFrame { len: 2 })),
        ]
    );
    assert_eq!(all[1].meaning(), "ANGLE_ACT(3) 969");
    let fields = all[1].fields();
    let told: Vec<_> = fields
        .iter()
        .map(|field| (field.name, field.at.len(), field.value.as_str()))
        .collect();
    assert_eq!(
        told,
        [
            (FieldName::Header, 2, ""),
            (FieldName::CanId, 4, "01840001"),
            (FieldName::Data, 2, "969"),
            (FieldName::Filler, 6, ""),
            (FieldName::Length, 1, "2"),
            (FieldName::FrameKind, 3, ""),
            (FieldName::Checksum, 2, "55"),
            (FieldName::Tail, 2, ""),
        ]
    );
}

fn hex(text: &str) -> Vec<u8> {
    let bytes = text.split_whitespace();
    bytes
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

#[test]
fn the_fields_of_every_frame_are_all_its_bytes_in_order() {
    let packet = hex("AA AA A5 AA 00 75 05 A5 AA 02 00 00 00 00 00 00 02 00 01 00 D3 55 55");
    let rtu = [1, 3, 4, 0, 1, 0, 2, 0x2A, 0x32];
    let tcp = [0, 7, 0, 0, 0, 5, 255, 3, 2, 0x03, 0xE8];
    let cases: [(&str, &[u8]); 6] = [
        (RS485, &answer()),
        (RS485, &ASK),
        (RTU, &rtu),
        (TCP, &tcp),
        (SLCAN, b"T018400012F401\r"),
        (USBCAN, &packet),
    ];
    for (endpoint, bytes) in cases {
        for broken in [false, true] {
            let mut bytes = bytes.to_vec();
            if broken {
                *bytes.last_mut().unwrap() ^= 0x55;
            }
            for frame in frames(endpoint, &[(IN, &bytes)]) {
                let mut at = 0;
                let fields = frame.fields();
                for field in &fields {
                    assert_eq!(field.at.start, at, "{endpoint} {fields:?}");
                    at = field.at.end;
                }
                assert_eq!(at, frame.bytes.len());
                let blamed = fields.iter().any(|field| field.wrong.is_some());
                assert_eq!(blamed, frame.wrong.is_some(), "{endpoint} {fields:?}");
            }
        }
    }
}

#[test]
fn lines_for_files_are_as_documented() {
    let all = frames(RS485, &[(OUT, &ASK), (IN, &answer())]);
    assert_eq!(
        all[0].csv_line(),
        "1,0.001000,to_hand,read,1,1546,12,ANGLE_ACT,,,EB 90 01 04 11 0A 06 0C 32"
    );
    let json: serde_json::Value = serde_json::from_str(&all[1].json_line()).unwrap();
    assert_eq!(json["kind"], "read_reply");
    assert_eq!(json["took_ms"], 1.0);
    assert_eq!(json["meaning"], "ANGLE_ACT 1000 1000 1000 1000 500 0");
    assert!(json["wrong"].is_null());
    assert!(all[0].text_line().contains("-> read "));
}

#[test]
fn ten_thousand_frames_are_kept_and_what_was_lost_before_is_said() {
    let tap = WireTap::default();
    let mut traffic = Traffic::of(tap.clone(), &RS485.parse().unwrap());
    tap.record(micros(0), PieceKind::Opened, &[]);
    traffic.read_on(micros(0));
    for n in 0..15_000 {
        tap.record(micros(n), OUT, &ASK);
        tap.record(micros(n), IN, &answer());
    }
    traffic.read_on(micros(15_000));
    assert_eq!(traffic.frames().len(), FRAMES_MAX);
    assert_eq!(traffic.newest(), 20_002);
    let fresh = Traffic::of(tap, &RS485.parse().unwrap());
    assert!(fresh.frames().is_empty(), "nothing is decoded unasked");
}

fn connect(endpoint: &str, dial: Arc<dyn Dial>) -> (Client, Clock) {
    let config = link::config(endpoint, dial);
    let clock = config.clock;
    (link::open(config), clock)
}

fn read(link: &Client, clock: Clock, endpoint: &str) -> Traffic {
    let mut traffic = Traffic::of(link.tap(), &endpoint.parse().unwrap());
    traffic.read_on(clock.now());
    traffic
}

/// Polls until every group was read, and holds each frame to be understood.
async fn check_healthy(endpoint: &str) {
    let (link, clock) = connect(endpoint, link::to_hand(hand::plain()));
    let parts = ["ANGLE_ACT", "CURRENT", "FINGERFIV_TOUCH"];
    let has = |traffic: &Traffic, part: &str| {
        let mut frames = traffic.frames().iter();
        frames.any(|frame| frame.kind == Kind::ReadReply && frame.meaning().contains(part))
    };
    let mut traffic = Traffic::default();
    for _ in 0..200 {
        sleep(Duration::from_millis(50)).await;
        traffic = read(&link, clock, endpoint);
        if traffic.frames().len() > 200 && parts.iter().all(|part| has(&traffic, part)) {
            break;
        }
    }
    for part in parts {
        assert!(has(&traffic, part), "{endpoint} {part}");
    }
    // An adapter that is closed already refuses to close.
    let is_fine =
        |frame: &Frame| frame.wrong.is_none() || frame.wrong == Some(Wrong::AdapterFailed);
    let wrong = traffic.frames().iter().find(|frame| !is_fine(frame));
    assert!(
        wrong.is_none(),
        "{endpoint}: {}",
        wrong.unwrap().text_line()
    );
    let took = traffic.frames().iter().filter(|frame| frame.took.is_some());
    assert!(took.count() > 50, "{endpoint}");
}

#[tokio::test(start_paused = true)]
async fn every_frame_of_a_healthy_link_is_understood_on_every_wire_of_bytes() {
    for endpoint in [RS485, SLCAN, USBCAN, "can:can0?id=1"] {
        check_healthy(endpoint).await;
    }
}

/// The server of this wire stands on a pseudo-terminal, which keeps real time.
#[cfg(unix)]
#[tokio::test]
async fn every_frame_of_a_healthy_link_over_modbus_rtu_is_understood() {
    check_healthy(RTU).await;
}

#[tokio::test]
async fn every_frame_of_a_healthy_link_over_modbus_tcp_is_understood() {
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let endpoint = format!("tcp:{}", listener.local_addr().unwrap());
    tokio::spawn(modbus_tcp::serve(hand::plain(), listener));
    let (link, clock) = connect(&endpoint, Arc::new(SystemDial));
    for _ in 0..100 {
        sleep(Duration::from_millis(50)).await;
        let traffic = read(&link, clock, &endpoint);
        let frames = traffic.frames();
        let wrong = frames.iter().find(|frame| frame.wrong.is_some());
        assert!(wrong.is_none(), "{}", wrong.unwrap().text_line());
        if frames.iter().filter(|frame| frame.took.is_some()).count() > 90 {
            return;
        }
    }
    panic!("too few replies: {:?}", link.status());
}

#[tokio::test(start_paused = true)]
async fn what_the_link_counts_as_wrong_on_a_bad_line_is_shown_as_wrong() {
    let hand = hand::plain();
    let dial = link::dial(move |_| {
        let plan = FaultPlan {
            back: FaultOdds {
                corrupt: 0.03,
                ..FaultOdds::default()
            },
            ..FaultPlan::quiet(7)
        };
        let (near, far, _) = faulty_pair(plan);
        tokio::spawn(rs485::serve(hand.clone(), far));
        link::opened(near)
    });
    let (link, clock) = connect(RS485, dial);
    sleep(Duration::from_secs(3)).await;
    let traffic = read(&link, clock, RS485);
    let count = |is: fn(&Wrong) -> bool| {
        let wrongs = traffic.frames().iter().filter_map(|frame| frame.wrong);
        wrongs.filter(is).count()
    };
    assert!(count(|wrong| matches!(wrong, Wrong::Checksum { .. })) > 0);
    assert!(count(|wrong| matches!(wrong, Wrong::NoReply)) > 0);
    assert!(link.stats().timeouts > 0);
}
