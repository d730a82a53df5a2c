//! What clients of a gateway read, and what that costs the hand.

use crate::setup::hand;
use crate::share::place::{config, share, until};
use handscope::link::PollRates;
use handscope::share::gateway::Gateway;
use std::time::{Duration, Instant};
use tokio::task::JoinSet;
use tokio_modbus::ExceptionCode;
use tokio_modbus::client::{Context, Reader as _};
use tokio_modbus::prelude::SlaveContext as _;
use tokio_modbus::slave::Slave;

const MS: Duration = Duration::from_millis(1);
/// Nothing is due by itself but the motion state.
const MOTION: PollRates = PollRates {
    state_hz: 50.0,
    tactile_hz: 0.0,
    settings_hz: 0.0,
};

async fn read(client: &mut Context, address: u16, count: u16) -> Result<Vec<u16>, ExceptionCode> {
    let read = client.read_holding_registers(address, count).await;
    read.unwrap()
}

#[tokio::test]
async fn eight_clients_at_full_rate_cost_the_hand_no_read_more_than_one() {
    let place = share(MOTION, MS).await;
    let mut clients = JoinSet::new();
    let polls = || (place.link.stats().state_reads, place.wires.reads_of(1546));
    let before = polls();
    for _ in 0..8 {
        let mut client = place.client().await;
        clients.spawn(async move {
            for _ in 0..200 {
                let angles = read(&mut client, 1546, 6).await.unwrap();
                assert_eq!(angles, [1000; 6]);
            }
        });
    }
    clients.join_all().await;
    let after = polls();
    // A read is on the wire before it is counted.
    let (polled, asked) = (after.0 - before.0, (after.1 - before.1) as u64);
    assert!(asked.abs_diff(polled) <= 1, "{asked} of {polled}");
    assert!(asked < 800, "{asked} reads for 1600 answers");
    until(|| place.gateway.clients().is_empty()).await;
}

#[tokio::test]
async fn what_is_not_read_in_turn_is_asked_for_once_for_all_who_wait() {
    let place = share(MOTION, 5 * MS).await;
    let begun = Instant::now();
    let mut clients = JoinSet::new();
    for _ in 0..8 {
        let mut client = place.client().await;
        clients.spawn(async move {
            for _ in 0..50 {
                assert_eq!(read(&mut client, 1000, 1).await, Ok(vec![1]));
                let speeds = read(&mut client, 1032, 6).await;
                assert_eq!(speeds, Ok(vec![1000; 6]));
            }
        });
    }
    clients.join_all().await;
    // Each is kept for half a second.
    let most = 1 + begun.elapsed().as_millis() as usize / 500;
    for address in [1000, 1032] {
        let asked = place.wires.reads_of(address);
        // The link reads the id when it gets to know the hand.
        assert!(asked <= most + 3, "{asked} at {address}, not {most}");
    }
}

#[tokio::test(start_paused = true)]
async fn reads_here_and_there_cost_the_hand_a_few_requests_a_second_however_fast_it_answers() {
    let place = share(MOTION, Duration::ZERO).await;
    let polls = || (place.link.stats().state_reads, place.wires.reads());
    let mut clients = JoinSet::new();
    let (before, begun) = (polls(), tokio::time::Instant::now());
    for nth in 0..4 {
        let mut client = place.client().await;
        clients.spawn(async move {
            // Each stretch is another one, which nobody read before.
            for at in 0..10 {
                let _read = read(&mut client, 2000 + 200 * nth + 20 * at, 1).await;
            }
        });
    }
    clients.join_all().await;
    let (after, took) = (polls(), begun.elapsed().as_secs_f64());
    let by_itself = after.0 - before.0;
    let asked = (after.1 - before.1) as u64 - by_itself;
    // After a while without, a few go at once.
    let hz = (asked - 8) as f64 / took;
    println!("{asked} requests for 40 reads in {took} s, {hz} a second, beside {by_itself}");
    assert!(asked >= 40 && hz <= 5.5, "{hz} a second");
}

#[tokio::test(start_paused = true)]
async fn a_program_that_gets_to_know_the_hand_waits_for_none_of_its_reads() {
    let place = share(MOTION, Duration::ZERO).await;
    for _ in 0..2 {
        let mut client = place.client().await;
        for at in 0..7 {
            let begun = tokio::time::Instant::now();
            let _read = read(&mut client, 2000 + 20 * at, 1).await;
            assert!(begun.elapsed() < 50 * MS, "{at}: {:?}", begun.elapsed());
        }
        tokio::time::sleep(Duration::from_secs(2)).await;
    }
}

#[tokio::test]
async fn every_register_stands_where_the_hand_has_it_and_at_every_unit() {
    let place = share(PollRates::default(), Duration::ZERO).await;
    let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let own = listener.local_addr().unwrap();
    tokio::spawn(handscope::sim::serve::modbus_tcp::serve(
        place.hand.clone(),
        listener,
    ));
    let mut hand = tokio_modbus::client::tcp::connect(own).await.unwrap();
    let mut client = place.client().await;
    for (address, count) in [
        (1000, 1),
        (1005, 1),
        (1032, 12),
        (1066, 60),
        (1474, 6),
        (1486, 24),
        // What drivers of the hand read in one go, through the unused bytes.
        (1534, 12),
        (1558, 12),
        (1606, 3),
        (1700, 2),
        (1619, 1),
        (1, 125),
        (4094, 1),
    ] {
        for unit in [255, 1, 0, 77] {
            hand.set_slave(Slave(unit));
            client.set_slave(Slave(unit));
            let own = read(&mut hand, address, count).await;
            let ours = read(&mut client, address, count).await;
            assert_eq!(ours, own, "{count} at {address}, unit {unit}");
        }
    }
    for (address, count) in [(4095, 1), (9000, 2), (65535, 125), (1000, 0), (1000, 126)] {
        let own = read(&mut hand, address, count).await;
        let ours = read(&mut client, address, count).await;
        assert!(ours.is_err(), "{count} at {address}");
        assert_eq!(ours, own, "{count} at {address}");
    }
    // Live values differ from read to read, but not in their number.
    for (address, count) in [(1534, 45), (1546, 39), (3000, 125), (3116, 29)] {
        let words = read(&mut client, address, count).await.unwrap();
        assert_eq!(words.len(), usize::from(count));
    }
    let unknown = client
        .read_input_registers(1546, 6)
        .await
        .expect("an answer");
    assert_eq!(unknown, Err(ExceptionCode::IllegalFunction));
}

#[tokio::test]
async fn what_the_hand_refuses_is_refused_and_never_made_up() {
    use handscope::sim::{GapAnswer, Personality};
    let personality = Personality {
        gap: GapAnswer::Refused,
        ..Personality::default()
    };
    let hand = hand::shared(hand::like(personality));
    let dial = crate::setup::link::to_hand(hand);
    let link = crate::setup::link::config("tcp:hand", dial);
    let runtime = tokio::runtime::Handle::current();
    let (link, _records) = handscope::link::open(link, &runtime);
    let gateway = Gateway::open(link.clone(), config(), &runtime).unwrap();
    until(|| link.stats().state_reads > 10).await;
    let mut client = tokio_modbus::client::tcp::connect(gateway.address())
        .await
        .unwrap();
    assert!(read(&mut client, 1546, 6).await.is_ok());
    assert!(read(&mut client, 1582, 6).await.is_ok());
    let through = read(&mut client, 1546, 39).await;
    assert_eq!(through, Err(ExceptionCode::IllegalDataAddress));
}

#[tokio::test]
async fn a_lost_link_is_told_at_once_and_its_values_are_gone() {
    let place = share(MOTION, MS).await;
    let mut client = place.client().await;
    for address in [1546, 1000] {
        assert!(read(&mut client, address, 1).await.is_ok());
    }
    place.wires.cut();
    until(|| !place.link.status().state.is_live()).await;
    for address in [1546, 1000, 1486] {
        let begun = Instant::now();
        let told = read(&mut client, address, 1).await;
        assert_eq!(told, Err(ExceptionCode::GatewayPathUnavailable));
        assert!(begun.elapsed() < Duration::from_secs(1));
    }
    place.wires.mend();
    place.live().await;
    assert_eq!(read(&mut client, 1546, 6).await, Ok(vec![1000; 6]));
}

#[tokio::test]
async fn a_client_that_waits_when_the_link_is_lost_is_told_then() {
    let place = share(MOTION, MS).await;
    let mut client = place.client().await;
    let waits = tokio::spawn(async move {
        loop {
            let told = read(&mut client, 1546, 6).await;
            if let Err(error) = told {
                return error;
            }
        }
    });
    place.wires.cut();
    let told = waits.await.unwrap();
    let lost = [
        ExceptionCode::GatewayPathUnavailable,
        ExceptionCode::GatewayTargetDevice,
    ];
    assert!(lost.contains(&told), "{told:?}");
}
