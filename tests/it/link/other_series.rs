//! What answers like a hand and is none of this series: it is never live, never written to, and no hand of the series is taken for it.
//! Virtual time.

use crate::setup::device::crc;
use crate::setup::hand;
use crate::setup::link::{self, Client};
use crate::setup::referee::RefereeHand;
use handscope::codec::rs485::{RequestDecoder, Rs485Request, encode_read_reply, encode_write_ack};
use handscope::hand::{Angle, ArmEpoch, Dof, HandCommand, Setpoints, Target};
use handscope::link::{DeviceSeries, LinkStatus, LinkTrouble};
use handscope::record::LinkState;
use handscope::sim::{Personality, SWITCHES, SimConfig};
use handscope::transport::{Pipe, SystemDial};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Duration, sleep};

/// RH56F1: the same frames, but registers are words at addresses of their own.
fn rh56f1(at: u16) -> u16 {
    match at {
        1000 => 1,
        1022..1034 | 1046..1058 => 500,
        1034..1040 | 1058..1064 => 100,
        1040..1046 | 1064..1070 => 900,
        1070..1076 => 3,
        1088..1094 => 2,
        1094..1100 => 31,
        3000..3170 => ((at - 3000) / 34 * 34 + (at - 3000) % 34 * 7) & 0xFF,
        _ => 0,
    }
}

async fn serve_f1(mut wire: Pipe, writes: Arc<AtomicUsize>) {
    let mut decoder = RequestDecoder::default();
    let mut chunk = [0; 512];
    while let Ok(len @ 1..) = wire.read(&mut chunk).await {
        decoder.push(&chunk[..len]);
        while let Some(request) = decoder.next() {
            let reply = match &request {
                Rs485Request::Read { id, span } => {
                    let words = (span.address..).flat_map(|at| rh56f1(at).to_le_bytes());
                    let bytes: Vec<u8> = words.take(span.len.into()).collect();
                    encode_read_reply(*id, span.address, &bytes)
                }
                Rs485Request::Write { id, address, .. } => {
                    writes.fetch_add(1, Ordering::Relaxed);
                    Some(encode_write_ack(*id, *address, 1))
                }
            };
            sleep(Duration::from_millis(3)).await;
            wire.write_all(&reply.unwrap()).await.unwrap();
        }
    }
}

/// Another maker's device on Modbus RTU: every address has a value, and writes are taken.
async fn serve_meter(mut wire: Pipe, value: fn(u16) -> u16, writes: Arc<AtomicUsize>) {
    let mut request = [0; 300];
    while let Ok(len @ 1..) = wire.read(&mut request).await {
        let [1, function, a, b, c, d, ..] = request[..len] else {
            continue;
        };
        let (at, count) = (u16::from_be_bytes([a, b]), u16::from_be_bytes([c, d]));
        let mut reply = vec![1, function];
        if function == 3 {
            reply.push(u8::try_from(2 * count).unwrap());
            reply.extend((at..at + count).flat_map(|at| value(at).to_be_bytes()));
        } else {
            writes.fetch_add(1, Ordering::Relaxed);
            reply.extend([a, b, c, d]);
        }
        reply.extend(crc(&reply));
        wire.write_all(&reply).await.unwrap();
    }
}

/// Whatever the user tries, it stays offline and unwritten, and says why.
async fn is_never_written(mut link: Client, place: &str, writes: &AtomicUsize) {
    let is_other = |status: &LinkStatus| {
        let place = place.to_owned();
        status.trouble == Some(LinkTrouble::OtherSeries { place })
    };
    link::until(&mut link, Duration::from_secs(3), is_other).await;
    let mut setpoints = Setpoints::none(ArmEpoch(1));
    setpoints.angle[Dof::Index] = Some(Target::Go(Angle::MIN));
    for _ in 0..20 {
        link.stop();
        let _refused = std::ops::Deref::deref(&link).arm(link.lease(), link::gentle());
        link.set(&setpoints);
        let refused = link.write(HandCommand::ClearErrors).await;
        assert!(refused.is_err());
        link::pass(&mut link, Duration::from_millis(170)).await;
        let status = link.status();
        assert!(!status.state.is_live(), "{status:?}");
        assert_eq!(status.armed, None);
    }
    assert_eq!(writes.load(Ordering::Relaxed), 0);
    assert_eq!(link.stats().state_reads, 0);
}

#[tokio::test(start_paused = true)]
async fn a_hand_of_another_series_is_never_live_and_never_written() {
    let writes = Arc::new(AtomicUsize::default());
    let counted = Arc::clone(&writes);
    let dial = link::behind(move |_, far| drop(tokio::spawn(serve_f1(far, Arc::clone(&counted)))));
    let link = link::connect("rs485:/dev/ttyT0", dial);
    is_never_written(link, "/dev/ttyT0", &writes).await;
}

#[tokio::test(start_paused = true)]
async fn a_device_whose_registers_are_all_alike_is_never_live_and_never_written() {
    const VALUES: [fn(u16) -> u16; 3] = [|_| 1, |at| 230 + at % 7, |_| 0];
    for value in VALUES {
        let writes = Arc::new(AtomicUsize::default());
        let counted = Arc::clone(&writes);
        let dial = link::behind(move |_, far| {
            tokio::spawn(serve_meter(far, value, Arc::clone(&counted)));
        });
        let link = link::connect("rtu:/dev/ttyT0", dial);
        is_never_written(link, "/dev/ttyT0", &writes).await;
    }
}

const WIRES: [&str; 4] = [
    "rs485:/dev/ttyT0?baud=19200",
    "rtu:/dev/ttyT0",
    "tcp:127.0.0.1",
    "can:can0",
];

/// The link calls it a hand of the series before long, and never another.
async fn is_ours(config: SimConfig, wire: &str, what: &str) {
    let mut link = link::connect(wire, link::to_hand(hand::shared(config)));
    let ours = |status: &LinkStatus| status.series == DeviceSeries::Ours && status.state.is_live();
    let status = link::until(&mut link, Duration::from_secs(2), ours).await;
    assert_ne!(status.state, LinkState::Offline, "{what} {wire}");
}

#[tokio::test(start_paused = true)]
async fn every_simulated_hand_passes_whatever_it_does_and_however_cold_it_is() {
    for wire in WIRES {
        for scenario in handscope::transport::endpoint::SCENARIOS {
            let config = SimConfig {
                scenario: scenario.parse().unwrap(),
                ..SimConfig::default()
            };
            is_ours(config, wire, scenario).await;
        }
        let mut cold = SimConfig::default();
        for (_, joint) in cold.body.joints.iter_mut() {
            joint.warmer_by_c = -30.0;
        }
        is_ours(cold, wire, "cold").await;
    }
}

/// Over real sockets, in a process of its own.
#[tokio::test]
async fn the_hand_by_another_author_passes_warm_or_cold() {
    for keys in [&[][..], &["ambient=0"]] {
        let Some(referee) = RefereeHand::start(3, keys) else {
            return;
        };
        let mut link = link::connect(&referee.endpoint(), Arc::new(SystemDial));
        let ours =
            |status: &LinkStatus| status.series == DeviceSeries::Ours && status.state.is_live();
        link::until(&mut link, Duration::from_secs(20), ours).await;
    }
}

#[tokio::test(start_paused = true)]
async fn every_reading_of_the_manual_passes() {
    for wire in WIRES {
        for switch in SWITCHES {
            for value in switch.values {
                // Replies of another unit are nobody's.
                if switch.name == "reply-unit" && *value == "zero" && wire.starts_with("tcp") {
                    continue;
                }
                let mut personality = Personality::default();
                personality.set(switch.name, value).unwrap();
                let what = format!("{}={value}", switch.name);
                is_ours(hand::like(personality), wire, &what).await;
            }
        }
    }
}
