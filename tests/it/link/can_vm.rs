//! SocketCAN for real: the simulated hand and the link on an interface `vcan0`. Where there is none they are skipped;
//! `.ci/run` runs this inside a small guest that has one.

use crate::setup::hand;
use crate::setup::link::{self, Client, ended, pass};
use crate::setup::skipped::{can_interface, skipped};
use handscope::codec::can::RECORD_LEN;
use handscope::hand::{HandId, register};
use handscope::link::scan::{Local, ScanConfig, ScanEvent, start};
use handscope::link::{Clock, LinkStatus, LinkTrouble};
use handscope::sim::serve::can as served;
use handscope::transport::{Dial as _, SystemDial, TransportError, can};
use std::io;
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::task::JoinHandle;
use tokio::time::timeout;

/// Longer than anything here takes in an emulated processor.
const PATIENCE: Duration = Duration::from_secs(20);

fn serve(interface: &str, id: u8) -> JoinHandle<io::Result<()>> {
    let hand = hand::shared(hand::numbered(id));
    let wire = can::open(interface, None).unwrap();
    tokio::spawn(served::serve(hand, wire))
}

fn connect(endpoint: &str) -> Client {
    link::connect(endpoint, Arc::new(SystemDial))
}

async fn until(link: &mut Client, wanted: impl Fn(&LinkStatus) -> bool) {
    link::until(link, PATIENCE, wanted).await;
}

#[tokio::test]
async fn a_hand_on_a_real_interface_is_read_whole() {
    let Some(interface) = can_interface() else {
        return;
    };
    let (_seven, _other) = (serve(interface, 7), serve(interface, 8));
    let mut link = connect(&format!("can:{interface}?id=7"));
    let read = timeout(PATIENCE, async {
        loop {
            let stats = link.stats();
            if stats.state_reads > 50 && stats.tactile_reads > 10 {
                return stats;
            }
            pass(&mut link, Duration::from_millis(5)).await;
        }
    });
    let stats = read.await.unwrap();
    println!("{stats:?}");
    assert_eq!(stats.foreign_replies, 0, "own frames come back: {stats:?}");
    let told = ended(link.read(register::HAND_ID.span())).await;
    assert_eq!(told, Ok(vec![7]));
}

#[tokio::test]
async fn a_scan_of_the_interface_finds_each_hand_on_it() {
    let Some(interface) = can_interface() else {
        return;
    };
    let (_two, _five) = (serve(interface, 2), serve(interface, 5));
    let config = ScanConfig {
        local: Local::Named {
            ports: Vec::new(),
            can: vec![interface.into(), "nocan9".into()],
        },
        hosts: Vec::new(),
        ids: HandId::all().take(6).collect(),
        held: Vec::new(),
        clock: Clock::start(),
        dial: Arc::new(SystemDial),
        wake: Arc::new(|| ()),
    };
    assert!(
        SystemDial
            .interfaces()
            .await
            .contains(&interface.to_owned())
    );
    let mut scan = start(config, &tokio::runtime::Handle::current());
    let (mut found, mut troubles) = (Vec::new(), Vec::new());
    while let Some(event) = timeout(PATIENCE, scan.event()).await.unwrap() {
        match event {
            ScanEvent::Found(one) => found.push(one.endpoint.to_string()),
            ScanEvent::Trouble { error, .. } => troubles.push(error),
            _ => {}
        }
    }
    println!("{found:?}");
    for id in [2, 5] {
        let url = format!("can:{interface}?id={id}");
        assert!(found.contains(&url), "{found:?}");
    }
    let place = "nocan9".to_owned();
    assert_eq!(troubles, [TransportError::NoInterface { place }]);
}

#[tokio::test]
async fn the_filter_passes_frames_of_one_hand_with_long_identifiers_only() {
    let Some(interface) = can_interface() else {
        return;
    };
    let mut ours = can::open(interface, Some(7)).unwrap();
    let mut other = can::open(interface, None).unwrap();
    let record = |id: u32| {
        let mut record = [0; RECORD_LEN];
        for (at, byte) in record.iter_mut().zip(id.to_ne_bytes()) {
            *at = byte;
        }
        record
    };
    // Another hand, an 11-bit identifier, a remote frame, then ours.
    for id in [0x8184_0008, 0x0000_0007, 0xC184_0007, 0x8184_0007] {
        other.write_all(&record(id)).await.unwrap();
    }
    ours.write_all(&record(0x8184_0007)).await.unwrap();
    let mut got = [0; RECORD_LEN];
    timeout(PATIENCE, ours.read_exact(&mut got))
        .await
        .unwrap()
        .unwrap();
    assert_eq!(got, record(0x8184_0007));
    let more = timeout(Duration::from_millis(100), ours.read_exact(&mut got)).await;
    assert!(more.is_err(), "more came through: {got:?}");
}

fn ip(words: &str) -> bool {
    let run = |program: &str, first: &[&str]| {
        let ended = Command::new(program)
            .args(first)
            .args(words.split(' '))
            .output();
        ended.is_ok_and(|ended| ended.status.success())
    };
    run("ip", &[]) || run("busybox", &["ip"]) || run("/bin/busybox", &["ip"])
}

#[tokio::test]
async fn missing_down_and_taken_away_have_their_own_words() {
    if can_interface().is_none() {
        return;
    }
    let place = || "vcan9".to_owned();
    let told = |status: &LinkStatus| status.trouble.clone();
    let mut link = connect("can:vcan9");
    until(&mut link, |status| told(status).is_some()).await;
    let missing = TransportError::NoInterface { place: place() };
    assert_eq!(told(&link.status()), Some(LinkTrouble::Transport(missing)));
    if !ip("link add dev vcan9 type vcan") {
        skipped("vcan9", "no right to make interfaces");
        return;
    }
    let down = LinkTrouble::Transport(TransportError::InterfaceDown { place: place() });
    until(&mut link, |status| told(status).as_ref() == Some(&down)).await;
    assert!(ip("link set vcan9 up"));
    let hand = serve("vcan9", 1);
    until(&mut link, |status| status.state.is_live()).await;
    assert!(ip("link set vcan9 down"));
    until(&mut link, |status| told(status).as_ref() == Some(&down)).await;
    let ended = timeout(PATIENCE, hand).await.unwrap().unwrap();
    assert!(ended.unwrap_err().to_string().contains("is down"));
    assert!(ip("link set vcan9 up"));
    let _hand = serve("vcan9", 1);
    until(&mut link, |status| status.state.is_live()).await;
    assert!(ip("link del vcan9"));
    let gone = [
        LinkTrouble::Transport(TransportError::NoInterface { place: place() }),
        LinkTrouble::Transport(TransportError::InterfaceDown { place: place() }),
    ];
    until(&mut link, |status| {
        told(status).is_some_and(|told| gone.contains(&told))
    })
    .await;
}
