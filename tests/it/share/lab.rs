//! A lab at one hand: programs that read it, one that a person lets move it, and viewers. None notices the others.

use crate::setup::{hand, link};
use crate::share::foxglove::Client;
use crate::share::place::{config, until};
use handscope::hand::kinematics::Side;
use handscope::link::LinkHandle;
use handscope::record::LinkState;
use handscope::record::file::Opening;
use handscope::record::file::format::topic::Topic;
use handscope::share::foxglove::{FoxgloveConfig, FoxgloveServer};
use handscope::share::gateway::{ClientLease, Gateway, GatewayConfig};
use std::net::SocketAddr;
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::time::{Instant, sleep, sleep_until};
use tokio_modbus::client::{Context, Reader as _, Writer as _, tcp};
use tokio_modbus::prelude::Slave;

const LENGTH: Duration = Duration::from_secs(10);
const INDEX: u16 = 1486 + 6;

/// A program's turns, so many milliseconds apart; how many were answered as they should be.
async fn turns(ms: u64, mut turn: impl AsyncFnMut(u64) -> bool) -> u64 {
    let begun = Instant::now();
    let mut answered = 0;
    for nth in 1.. {
        sleep_until(begun + Duration::from_millis(ms * nth)).await;
        if begun.elapsed() >= LENGTH {
            break;
        }
        answered += u64::from(turn(nth).await);
    }
    answered
}

async fn client(address: SocketAddr) -> Context {
    tcp::connect_slave(address, Slave(255)).await.unwrap()
}

async fn reads(client: &mut Context, (address, count): (u16, u16), ms: u64) -> u64 {
    turns(ms, async |_| {
        let read = client.read_holding_registers(address, count).await;
        matches!(read, Ok(Ok(words)) if words.len() == usize::from(count))
    })
    .await
}

/// Bends the index finger and stretches it, a little each turn.
async fn moves(client: &mut Context) -> u64 {
    turns(50, async |nth| {
        let bend = 20 * u16::try_from(nth % 10).unwrap();
        let written = client.write_single_register(INDEX, 900 - bend).await;
        matches!(written, Ok(Ok(())))
    })
    .await
}

/// States that a viewer is shown.
async fn views(server: &FoxgloveServer) -> u64 {
    let (mut client, _) = Client::of(server).await;
    client.subscribe([Topic::State, Topic::Joints]).await;
    let over = Instant::now() + LENGTH;
    let mut states = 0;
    loop {
        tokio::select! {
            () = sleep_until(over) => return states,
            (topic, ..) = client.message() => states += u64::from(topic == Topic::State),
        }
    }
}

async fn pace(link: &LinkHandle) -> u64 {
    let before = link.stats().state_reads;
    sleep(LENGTH).await;
    link.stats().state_reads - before
}

#[tokio::test(start_paused = true)]
async fn three_programs_and_two_viewers_at_one_hand_do_not_notice_each_other() {
    let hand = hand::plain();
    let opened = link::config("tcp:hand", link::to_hand(hand.clone()));
    let moments = (opened.clock.now(), Duration::from_secs(1));
    let (link, _records) = handscope::link::open(opened, &Handle::current());
    until(|| link.status().state == LinkState::Monitoring).await;
    let config = GatewayConfig {
        silence: 60 * LENGTH,
        ..config()
    };
    let gateway = Gateway::open(link.clone(), config, &Handle::current()).unwrap();
    let shown = FoxgloveConfig {
        address: ([127, 0, 0, 1], 0).into(),
        opening: Opening::begin("sim:".into(), moments, Side::Right),
    };
    let mut server = FoxgloveServer::open(shown, &Handle::current()).unwrap();
    server.show(&link);
    let mut mover = client(gateway.address()).await;
    let mut fast = client(gateway.address()).await;
    let mut touch = client(gateway.address()).await;
    // Until it is known where the joints are.
    until(|| link.stats().state_reads > 20).await;
    let first = gateway.clients()[0].id;
    gateway.grant(first);
    let is_let = || matches!(gateway.clients()[0].lease, ClientLease::Held(_));
    until(is_let).await;

    let (angles, pads) = ((1546, 6), (3000, 50));
    // What moves a hand makes the link look more often what it keeps: that is no other's doing.
    let (moved, viewed, paced) = tokio::join!(moves(&mut mover), views(&server), pace(&link));
    let alone = [
        moved,
        reads(&mut fast, angles, 10).await,
        reads(&mut touch, pads, 33).await,
        viewed,
        paced,
    ];
    let (a, b, c, d, e, f) = tokio::join!(
        moves(&mut mover),
        reads(&mut fast, angles, 10),
        reads(&mut touch, pads, 33),
        views(&server),
        views(&server),
        pace(&link),
    );
    for (who, before, now) in [
        ("moves", alone[0], a),
        ("reads fast", alone[1], b),
        ("reads touch", alone[2], c),
        ("views", alone[3], d),
        ("views, too", alone[3], e),
        ("the link", alone[4], f),
    ] {
        assert!(before > 190, "{who}: {before}");
        assert!(
            before.saturating_sub(now) <= before / 15,
            "{who}: {before}, then {now}"
        );
    }
    assert!(is_let(), "nobody took the hand");
    assert!(server.viewers().iter().all(|viewer| viewer.missed == 0));
}
