//! Finding hands on wires in memory: what is asked, what is found, what is told, and that nothing is written. Virtual time.

use crate::setup::hand;
use futures::future::BoxFuture;
use handscope::codec::modbus_rtu::crc16;
use handscope::hand::HandId;
use handscope::link::Clock;
use handscope::link::scan::{
    Local, ScanConfig, ScanEvent, ScanHandle, ScanHint, ScanPort, ScanSummary, Speaks, start,
};
use handscope::sim::serve::{can, rs485, slcan};
use handscope::sim::{SharedHand, SimHands};
use handscope::transport::{
    BoxedWire, Dial, Endpoint, Pipe, PortFound, Remedy, TransportError, UsbFound, WireFailure, pair,
};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::Instant;

/// What is at a place.
#[derive(Clone)]
enum There {
    /// Hands in the private framing at this speed; at others they hear nothing that makes sense.
    Rs485(u32, SimHands),
    /// A Modbus RTU device at this speed, with these ids; its HAND_ID reads what is given here.
    Rtu(u32, Vec<(u8, u8)>),
    /// A serial CAN adapter with hands on its bus.
    Adapter(SimHands),
    /// A CAN bus.
    Can(SimHands),
    /// Opens, and nothing is ever heard.
    Nobody,
    /// Everything that is sent comes back.
    Echo,
    /// Says this whenever it is spoken to at this speed.
    Noise(u32, &'static [u8]),
    /// Cannot be opened.
    Shut(TransportError),
    /// Hangs up at the first question.
    HangsUp,
    /// Never opens and never fails.
    Pending,
}

type Sent = Vec<(String, Vec<u8>)>;

#[derive(Default)]
struct Street {
    there: Vec<(&'static str, There)>,
    /// What is at all other places.
    otherwise: Option<There>,
    usb: Option<UsbFound>,
    dialled: Mutex<Vec<String>>,
    /// Wires that are open now.
    open: Arc<AtomicUsize>,
    /// Everything that was sent, by place.
    sent: Arc<Mutex<Sent>>,
}

impl Street {
    fn new(there: Vec<(&'static str, There)>) -> Arc<Self> {
        Arc::new(Self {
            there,
            ..Self::default()
        })
    }

    fn at(&self, place: &str) -> There {
        let there = self.there.iter().find(|(name, _)| *name == place);
        let otherwise = self.otherwise.clone().unwrap_or(There::Nobody);
        there.map_or(otherwise, |(_, there)| there.clone())
    }

    fn listed(&self, is_meant: fn(&There) -> bool) -> Vec<String> {
        let meant = self.there.iter().filter(|(_, there)| is_meant(there));
        meant.map(|(name, _)| (*name).to_owned()).collect()
    }
}

/// Counts a wire as open while it lives.
struct Open(Arc<AtomicUsize>);

impl Drop for Open {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

impl Dial for Street {
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        self.dialled.lock().unwrap().push(endpoint.to_string());
        let open = Open(Arc::clone(&self.open));
        self.open.fetch_add(1, Ordering::SeqCst);
        let there = self.at(&endpoint.place());
        let endpoint = endpoint.clone();
        let sent = Arc::clone(&self.sent);
        Box::pin(async move {
            match there {
                There::Shut(error) => return Err(error),
                There::Pending => std::future::pending().await,
                _ => {}
            }
            let (ours, middle) = pair();
            let (far, its) = pair();
            let place = endpoint.place();
            tokio::spawn(async move { note(middle, far, place, &sent).await });
            tokio::spawn(async move {
                stand(there, &endpoint, its).await;
                drop(open);
            });
            Ok(Box::new(ours) as BoxedWire)
        })
    }

    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        let usb = self.usb.clone();
        let listed = self.listed(|there| !matches!(there, There::Can(_)));
        let listed = listed.into_iter().map(move |path| PortFound {
            path,
            usb: usb.clone(),
        });
        Box::pin(std::future::ready(listed.collect()))
    }

    fn interfaces(&self) -> BoxFuture<'static, Vec<String>> {
        Box::pin(std::future::ready(
            self.listed(|there| matches!(there, There::Can(_))),
        ))
    }
}

/// Carries bytes both ways and notes what is sent.
async fn note(mut near: Pipe, mut far: Pipe, place: String, sent: &Mutex<Sent>) {
    let (mut out, mut back) = ([0; 512], [0; 512]);
    loop {
        tokio::select! {
            biased;
            read = near.read(&mut out) => {
                let Ok(len @ 1..) = read else { return };
                sent.lock().unwrap().push((place.clone(), out[..len].to_vec()));
                if far.write_all(&out[..len]).await.is_err() { return; }
            }
            read = far.read(&mut back) => {
                let Ok(len @ 1..) = read else { return };
                if near.write_all(&back[..len]).await.is_err() { return; }
            }
        }
    }
}

fn baud(endpoint: &Endpoint) -> u32 {
    match endpoint {
        Endpoint::Rs485(line) | Endpoint::Rtu(line) => line.baud,
        _ => 0,
    }
}

async fn stand(there: There, endpoint: &Endpoint, mut wire: Pipe) {
    match there {
        There::Rs485(at, hands) if at == baud(endpoint) => rs485::serve(hands, wire).await,
        There::Rtu(at, ids) if at == baud(endpoint) => rtu(&ids, wire).await,
        There::Adapter(hands) => slcan::serve(hands, wire).await,
        There::Can(hands) => drop(can::serve(hands, wire).await),
        There::HangsUp => drop(wire.read(&mut [0; 64]).await),
        There::Echo => {
            let (mut from, mut to) = tokio::io::split(wire);
            drop(tokio::io::copy(&mut from, &mut to).await);
        }
        There::Noise(at, noise) => {
            while let Ok(1..) = wire.read(&mut [0; 64]).await {
                if at == baud(endpoint) {
                    wire.write_all(noise).await.unwrap();
                }
            }
        }
        _ => while let Ok(1..) = wire.read(&mut [0; 64]).await {},
    }
}

/// Answers function 03 at 1000 as the standard has it.
async fn rtu(ids: &[(u8, u8)], mut wire: Pipe) {
    let mut frame = [0; 64];
    while let Ok(len @ 1..) = wire.read(&mut frame).await {
        let known = ids.iter().find(|(id, _)| *id == frame[0]);
        let (Some((id, says)), 8) = (known, len) else {
            continue;
        };
        if frame[1..6] != [3, 3, 0xE8, 0, 1] {
            continue;
        }
        let mut reply = vec![*id, 3, 2, 0, *says];
        reply.extend(crc16(&reply).to_le_bytes());
        wire.write_all(&reply).await.unwrap();
    }
}

fn hands(ids: &[u8]) -> (SimHands, Vec<SharedHand>) {
    let all = ids.iter().map(|id| hand::shared(hand::numbered(*id)));
    let all: Vec<SharedHand> = all.collect();
    (SimHands::new(all[0].clone(), all[1..].to_vec()), all)
}

fn ids(count: usize) -> Vec<HandId> {
    HandId::all().take(count).collect()
}

fn begin(street: &Arc<Street>, local: Local, hosts: &[&str], ids: Vec<HandId>) -> ScanHandle {
    let config = ScanConfig {
        local,
        hosts: hosts.iter().map(|text| text.parse().unwrap()).collect(),
        ids,
        held: Vec::new(),
        clock: Clock::start(),
        dial: Arc::clone(street) as Arc<dyn Dial>,
        wake: Arc::new(|| ()),
    };
    start(config, &tokio::runtime::Handle::current())
}

fn none() -> Local {
    Local::Named {
        ports: Vec::new(),
        can: Vec::new(),
    }
}

/// Everything a scan tells, to its end.
async fn all(street: &Arc<Street>, local: Local, hosts: &[&str], count: usize) -> Told {
    let mut handle = begin(street, local, hosts, ids(count));
    let mut told = Told::default();
    while let Some(event) = handle.event().await {
        match event {
            ScanEvent::Begun { estimate, .. } => told.estimate = estimate,
            ScanEvent::Found(found) => told.found.push(found.endpoint.to_string()),
            ScanEvent::Trouble { error, .. } => told.troubles.push(error.to_string()),
            ScanEvent::Hint(hint) => told.hints.push(hint),
            ScanEvent::Held { place } => told.held.push(place),
            ScanEvent::Done(summary) => told.summary = Some(summary),
        }
    }
    let progress = handle.progress();
    assert_eq!(progress.tried, progress.total);
    assert_eq!(progress.left, Duration::ZERO);
    told
}

#[derive(Default)]
struct Told {
    estimate: Duration,
    found: Vec<String>,
    troubles: Vec<String>,
    hints: Vec<ScanHint>,
    held: Vec<String>,
    summary: Option<ScanSummary>,
}

#[tokio::test(start_paused = true)]
async fn hands_on_every_kind_of_wire_are_found_and_nothing_is_written() {
    let (line, on_line) = hands(&[1, 2, 7]);
    let (bus, on_bus) = hands(&[3]);
    let (behind, on_adapter) = hands(&[1, 2]);
    let street = Street::new(vec![
        ("/dev/ttyUSB0", There::Rs485(57_600, line)),
        ("/dev/ttyUSB1", There::Rtu(19_200, vec![(2, 2), (3, 3)])),
        ("/dev/ttyUSB2", There::Nobody),
        ("can0", There::Can(bus)),
        ("/dev/ttyACM0", There::Adapter(behind)),
    ]);
    let port = |port: &str, speaks| ScanPort {
        port: port.into(),
        usb: None,
        speaks,
    };
    let local = Local::Named {
        ports: vec![
            port("/dev/ttyUSB0", Speaks::Hand),
            port("/dev/ttyUSB1", Speaks::Hand),
            port("/dev/ttyUSB2", Speaks::Hand),
            port("/dev/ttyACM0", Speaks::CanAdapter),
        ],
        can: vec!["can0".into()],
    };
    let mut told = all(&street, local, &[], 10).await;
    told.found.sort();
    assert_eq!(
        told.found,
        [
            "can:can0?id=3",
            "rs485:/dev/ttyUSB0?baud=57600&id=1",
            "rs485:/dev/ttyUSB0?baud=57600&id=2",
            "rs485:/dev/ttyUSB0?baud=57600&id=7",
            "rtu:/dev/ttyUSB1?baud=19200&id=2",
            "rtu:/dev/ttyUSB1?baud=19200&id=3",
            "slcan:/dev/ttyACM0?bitrate=1000000&id=1",
            "slcan:/dev/ttyACM0?bitrate=1000000&id=2",
        ]
    );
    assert_eq!(told.troubles, Vec::<String>::new());
    assert_eq!(told.hints, []);
    let summary = told.summary.unwrap();
    assert_eq!((summary.found, summary.places, summary.failed), (8, 5, 0));
    for hand in on_line.iter().chain(&on_bus).chain(&on_adapter) {
        assert_eq!(hand.with(|hand, _| hand.journal().len()), 0);
    }
    assert_eq!(
        street.open.load(Ordering::SeqCst),
        0,
        "all wires are closed"
    );
}

#[tokio::test(start_paused = true)]
async fn every_byte_on_a_serial_line_is_a_read_and_silent_ids_are_asked_for_their_id_alone() {
    let (line, _) = hands(&[4]);
    let street = Street::new(vec![
        ("/dev/ttyUSB0", There::Rs485(921_600, line)),
        ("/dev/ttyUSB1", There::Nobody),
    ]);
    all(&street, Local::Listed, &[], 254).await;
    let sent = street.sent.lock().unwrap();
    assert!(sent.len() > 254 * 8);
    for (_, bytes) in sent.iter() {
        match bytes.as_slice() {
            // Manual 2.2.1: read, from 1000, one byte.
            [0xEB, 0x90, id, 4, 0x11, 0xE8, 0x03, 1, check] => {
                let sum = [*id, 4, 0x11, 0xE8, 0x03, 1]
                    .iter()
                    .fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
                assert_eq!(sum, *check);
            }
            // The one that answered is asked for more: drives, positions and angles.
            [0xEB, 0x90, 4, 4, 0x11, 0x46, 0x06, 18, _]
            | [0xEB, 0x90, 4, 4, 0x11, 0xFE, 0x05, 24, _] => {}
            // Manual 2.4.1: function 03, from 1000, one word. Its check never opens a frame of the other framing.
            [id, 3, 3, 0xE8, 0, 1, low, high] => {
                assert_eq!(crc16(&[*id, 3, 3, 0xE8, 0, 1]).to_le_bytes(), [*low, *high]);
                assert_ne!([*low, *high], [0xEB, 0x90]);
            }
            other => panic!("{other:02X?}"),
        }
    }
}

#[tokio::test(start_paused = true)]
async fn where_a_hand_answers_only_further_ids_of_its_line_are_asked() {
    let (line, _) = hands(&[1]);
    let street = Street::new(vec![("/dev/ttyUSB0", There::Rs485(115_200, line))]);
    let told = all(&street, Local::Listed, &[], 10).await;
    assert_eq!(told.found.len(), 1);
    let dialled = street.dialled.lock().unwrap().clone();
    assert_eq!(dialled, ["rs485:/dev/ttyUSB0?baud=115200&id=1"]);
    assert_eq!(told.summary.unwrap().asked, 10);
}

#[tokio::test(start_paused = true)]
async fn a_scan_that_finds_nobody_takes_as_long_as_was_estimated() {
    for (ports, count) in [(1, 10), (3, 4), (9, 2)] {
        let names: Vec<&'static str> =
            ["/a", "/b", "/c", "/d", "/e", "/f", "/g", "/h", "/i"].into();
        let there = names[..ports].iter().map(|name| (*name, There::Nobody));
        let street = Street::new(there.collect());
        let begun = Instant::now();
        let told = all(&street, Local::Listed, &[], count).await;
        let took = begun.elapsed();
        // The runtime's clock has a grain of one millisecond a wait.
        let tries = u32::try_from(8 * count * ports.div_ceil(8)).unwrap();
        let grain = Duration::from_millis(1) * tries;
        assert!(took >= told.estimate, "{took:?} {:?}", told.estimate);
        assert!(
            took <= told.estimate + grain,
            "{took:?} {:?}",
            told.estimate
        );
    }
}

#[tokio::test(start_paused = true)]
async fn the_estimate_only_ever_goes_down() {
    let (line, _) = hands(&[2]);
    let street = Street::new(vec![
        ("/dev/ttyUSB0", There::Rs485(57_600, line)),
        ("/dev/ttyUSB1", There::Nobody),
    ]);
    let mut handle = begin(&street, Local::Listed, &[], ids(3));
    let Some(ScanEvent::Begun { estimate, .. }) = handle.event().await else {
        panic!("a scan begins with its plan");
    };
    let mut before = handle.progress();
    assert!(before.left <= estimate);
    loop {
        tokio::time::sleep(Duration::from_millis(20)).await;
        let now = handle.progress();
        assert!(now.left <= before.left && now.tried >= before.tried);
        before = now;
        if now.left.is_zero() {
            return;
        }
    }
}

#[tokio::test(start_paused = true)]
async fn what_cannot_be_opened_is_told_once_and_the_scan_goes_on() {
    let (line, _) = hands(&[1]);
    let shut = [
        TransportError::Busy {
            place: "/dev/a".into(),
            holder: None,
        },
        TransportError::Permission {
            place: "/dev/b".into(),
            remedy: Remedy::Unknown,
        },
        TransportError::NotAPort {
            place: "/dev/c".into(),
        },
        TransportError::Io {
            place: "/dev/d".into(),
            failure: WireFailure::Recorded("no such speed".into()),
        },
    ];
    let mut there: Vec<_> = ["/dev/a", "/dev/b", "/dev/c", "/dev/d"]
        .into_iter()
        .zip(shut.iter().cloned().map(There::Shut))
        .collect();
    there.push(("/dev/e", There::Rs485(115_200, line)));
    there.push(("/dev/f", There::HangsUp));
    let street = Street::new(there);
    let mut told = all(&street, Local::Listed, &[], 10).await;
    assert_eq!(told.found, ["rs485:/dev/e?baud=115200&id=1"]);
    told.troubles.sort();
    let mut wanted: Vec<String> = shut.iter().map(ToString::to_string).collect();
    wanted.push(
        TransportError::HungUp {
            place: "/dev/f".into(),
        }
        .to_string(),
    );
    wanted.sort();
    assert_eq!(told.troubles, wanted);
    let summary = told.summary.unwrap();
    assert_eq!((summary.places, summary.failed), (2, 4));
    let dialled = street.dialled.lock().unwrap();
    let busy = dialled.iter().filter(|text| text.contains("/dev/a"));
    assert_eq!(busy.count(), 1, "a busy port is not knocked at again");
}

#[tokio::test(start_paused = true)]
async fn talk_that_is_no_answer_is_a_hint_and_an_echo_is_none() {
    let place = || "/dev/ttyUSB0".to_owned();
    for (there, hint) in [
        (
            There::Noise(57_600, b"\x00\xF8\x80"),
            Some(ScanHint::Garbled {
                place: place(),
                bauds: vec![57_600],
                bytes: 3 * 2 * 2,
            }),
        ),
        // The reply of hand 9 to a read of TEMP, sound in every way: 9 + 9 + 11 + 52 + 06 + 6 * 1E = 12F.
        (
            There::Noise(
                115_200,
                b"\x90\xEB\x09\x09\x11\x52\x06\x1E\x1E\x1E\x1E\x1E\x1E\x2F",
            ),
            Some(ScanHint::OtherTalk {
                endpoint: "rs485:/dev/ttyUSB0?baud=115200&id=1".parse().unwrap(),
            }),
        ),
        (
            There::Rtu(115_200, vec![(2, 77)]),
            Some(ScanHint::OtherId {
                endpoint: "rtu:/dev/ttyUSB0?baud=115200&id=2".parse().unwrap(),
                hand_id: 77,
            }),
        ),
        (There::Echo, None),
        (There::Nobody, None),
    ] {
        let street = Street::new(vec![("/dev/ttyUSB0", there)]);
        let told = all(&street, Local::Listed, &[], 2).await;
        assert_eq!(told.found, Vec::<String>::new());
        assert_eq!(told.hints, Vec::from_iter(hint));
    }
}

#[tokio::test(start_paused = true)]
async fn ending_a_scan_closes_every_wire_at_once() {
    let street = Street::new(vec![("/a", There::Nobody), ("/b", There::Nobody)]);
    let mut handle = begin(&street, Local::Listed, &[], ids(254));
    while street.open.load(Ordering::SeqCst) < 2 {
        tokio::time::sleep(Duration::from_millis(1)).await;
    }
    let dialled = street.dialled.lock().unwrap().len();
    assert!(handle.try_event().is_some());
    drop(handle);
    let begun = Instant::now();
    while street.open.load(Ordering::SeqCst) > 0 {
        tokio::time::sleep(Duration::from_millis(1)).await;
        assert!(begun.elapsed() < Duration::from_millis(20));
    }
    tokio::time::sleep(Duration::from_secs(60)).await;
    assert_eq!(street.dialled.lock().unwrap().len(), dialled);
}

#[tokio::test(start_paused = true)]
async fn addresses_are_called_sixty_four_at_a_time_and_ports_eight() {
    let street = Arc::new(Street {
        otherwise: Some(There::Pending),
        ..Street::default()
    });
    let ports = (0..30).map(|nth| ScanPort {
        port: format!("/dev/ttyUSB{nth}"),
        usb: None,
        speaks: Speaks::Hand,
    });
    let local = Local::Named {
        ports: ports.collect(),
        can: Vec::new(),
    };
    let _handle = begin(&street, local, &["127.0.0.0/24"], ids(1));
    tokio::time::sleep(Duration::from_secs(60)).await;
    let dialled = street.dialled.lock().unwrap();
    let calls = dialled.iter().filter(|text| text.starts_with("tcp:"));
    assert_eq!((calls.count(), dialled.len()), (64, 64 + 8));
}

#[tokio::test(start_paused = true)]
async fn the_silent_ones_of_a_range_say_nothing_and_one_that_was_named_is_told_of() {
    let street = Street::new(vec![(
        "127.0.0.9:6000",
        There::Shut(TransportError::Refused {
            place: "127.0.0.9:6000".into(),
        }),
    )]);
    let told = all(&street, none(), &["127.0.0.0/24"], 1).await;
    assert_eq!(told.troubles, Vec::<String>::new());
    assert_eq!(told.summary.unwrap().places, 254);
    let named = all(&street, none(), &["127.0.0.9"], 1).await;
    assert_eq!(named.troubles.len(), 1, "{:?}", named.troubles);
    assert_eq!(named.summary.unwrap().failed, 0);
}

#[tokio::test(start_paused = true)]
async fn nothing_is_dialled_but_what_was_named_or_listed() {
    let street = Street::new(vec![
        ("/a", There::Nobody),
        ("can0", There::Shut(TransportError::LinuxOnly)),
    ]);
    all(&street, Local::Listed, &["127.0.0.3:7"], 2).await;
    for text in street.dialled.lock().unwrap().iter() {
        let endpoint: Endpoint = text.parse().unwrap();
        assert!(
            ["/a", "can0", "127.0.0.3:7"].contains(&endpoint.place().as_str()),
            "{text}"
        );
    }
    let street = Street::new(vec![("/a", There::Pending)]);
    let told = all(&street, none(), &[], 254).await;
    assert_eq!(told.summary.unwrap().places, 0);
    assert!(street.dialled.lock().unwrap().is_empty());
}

#[tokio::test(start_paused = true)]
async fn what_looks_like_a_can_adapter_is_asked_as_one_and_its_facts_come_with_the_hand() {
    let (behind, _) = hands(&[1]);
    let usb = UsbFound {
        vendor_id: 0x16D0,
        product_id: 0x117E,
        serial: Some("001".into()),
        maker: Some("Protofusion Labs".into()),
        product: Some("CANable".into()),
        location: None,
        latency_timer_ms: None,
    };
    let street = Arc::new(Street {
        there: vec![("/dev/ttyACM0", There::Adapter(behind))],
        usb: Some(usb.clone()),
        ..Street::default()
    });
    let mut handle = begin(&street, Local::Listed, &[], ids(1));
    let mut found = Vec::new();
    while let Some(event) = handle.event().await {
        if let ScanEvent::Found(one) = event {
            found.push(one);
        }
    }
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].usb, Some(usb));
    assert_eq!(found[0].endpoint.kind(), "slcan");
    let dialled = street.dialled.lock().unwrap();
    assert!(
        dialled.iter().all(|text| text.starts_with("slcan:")),
        "{dialled:?}"
    );
}
