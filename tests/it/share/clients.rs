//! Clients of a gateway that keep neither to the protocol nor to the time, and what is left of them: nothing.

use crate::share::place::{Place, share, until};
use handscope::link::PollRates;
use handscope::share::gateway::client::REQUEST_TIMEOUT;
use handscope::share::gateway::{CLIENTS_MAX, ClientLease};
use std::time::{Duration, Instant};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};
use tokio_modbus::client::Reader as _;

/// A read of six words at ANGLE_ACT, unit 255.
const READ: [u8; 12] = [0, 7, 0, 0, 0, 6, 0xFF, 3, 6, 10, 0, 6];

async fn place() -> Place {
    share(PollRates::default(), Duration::ZERO).await
}

async fn connect(place: &Place) -> TcpStream {
    TcpStream::connect(place.address()).await.unwrap()
}

/// True once the other side hung up.
async fn is_closed(stream: &mut TcpStream, within: Duration) -> bool {
    let mut bytes = [0; 4096];
    let closed = timeout(within, async {
        while !matches!(stream.read(&mut bytes).await, Ok(0) | Err(_)) {}
    });
    closed.await.is_ok()
}

/// A client of good behaviour is answered.
async fn serves(place: &Place) {
    let mut client = place.client().await;
    let read = client.read_holding_registers(1546, 6).await;
    assert_eq!(read.unwrap(), Ok(vec![1000; 6]));
}

#[tokio::test]
async fn half_a_request_ends_at_its_deadline_however_slowly_it_goes_on() {
    let place = place().await;
    let (mut silent, mut slow) = (connect(&place).await, connect(&place).await);
    silent.write_all(&READ[..7]).await.unwrap();
    let begun = Instant::now();
    let drip = async {
        for byte in READ.iter().cycle() {
            // Whole requests would be answered; the last byte never comes in time.
            if slow.write_all(&[*byte]).await.is_err() {
                break;
            }
            sleep(REQUEST_TIMEOUT / 8).await;
            if begun.elapsed() > 2 * REQUEST_TIMEOUT {
                break;
            }
        }
        is_closed(&mut slow, REQUEST_TIMEOUT).await
    };
    let (silent, slow) = tokio::join!(is_closed(&mut silent, 4 * REQUEST_TIMEOUT), drip);
    assert!(silent && slow, "{silent} {slow}");
    serves(&place).await;
}

#[tokio::test]
async fn a_read_that_waits_for_the_hand_keeps_no_other_waiting() {
    let place = place().await;
    // Strange stretches are asked for at once only so often.
    let mut greedy = place.client().await;
    for at in 0..9 {
        let _read = greedy.read_holding_registers(2000 + 20 * at, 1).await;
    }
    let mut client = connect(&place).await;
    let strange = [0, 6, 0, 0, 0, 6, 0xFF, 3, 9, 0, 0, 1];
    client
        .write_all(&[strange, READ, READ].concat())
        .await
        .unwrap();
    let mut numbers = Vec::new();
    for _ in 0..3 {
        let mut head = [0; 6];
        client.read_exact(&mut head).await.unwrap();
        numbers.push(head[1]);
        let mut rest = vec![0; usize::from(head[5])];
        client.read_exact(&mut rest).await.unwrap();
    }
    assert_eq!(numbers, [7, 7, 6]);
}

#[tokio::test]
async fn who_asks_no_more_is_answered_all_the_same() {
    let place = place().await;
    let mut client = connect(&place).await;
    client.write_all(&READ).await.unwrap();
    client.shutdown().await.unwrap();
    let mut answer = Vec::new();
    client.read_to_end(&mut answer).await.unwrap();
    assert_eq!(answer.len(), 9 + 12, "{answer:?}");
}

#[tokio::test]
async fn what_is_no_modbus_ends_at_once() {
    let place = place().await;
    for nonsense in [
        &b"GET / HTTP/1.1\r\n\r\n"[..],
        // Longer than any message, and shorter.
        &[0, 1, 0, 0, 255, 255, 1, 3],
        &[0, 1, 0, 0, 0, 1, 1, 3],
        &[0xFF; 1000],
    ] {
        let mut client = connect(&place).await;
        client.write_all(nonsense).await.unwrap();
        assert!(is_closed(&mut client, REQUEST_TIMEOUT / 2).await);
    }
    serves(&place).await;
    until(|| place.gateway.clients().is_empty()).await;
}

#[tokio::test]
async fn whoever_takes_no_answers_is_ended_and_holds_up_nobody() {
    let place = place().await;
    let greedy = connect(&place).await;
    let (mut unread, mut asks) = greedy.into_split();
    let flood = tokio::spawn(async move {
        let many = READ.repeat(500);
        while asks.write_all(&many).await.is_ok() {}
    });
    let begun = Instant::now();
    while place
        .gateway
        .clients()
        .iter()
        .any(|client| client.reads < 100)
    {
        assert!(begun.elapsed() < Duration::from_secs(20));
        serves(&place).await;
    }
    timeout(Duration::from_secs(60), flood)
        .await
        .expect("the flood ends")
        .unwrap();
    until(|| place.gateway.clients().is_empty()).await;
    let mut rest = Vec::new();
    let _reset = unread.read_to_end(&mut rest).await;
    serves(&place).await;
}

#[tokio::test]
async fn a_storm_of_connections_is_turned_away_and_counted_and_the_old_clients_stay() {
    let place = place().await;
    let mut first = place.client().await;
    assert!(first.read_holding_registers(1546, 1).await.unwrap().is_ok());
    let mut storm = Vec::new();
    for _ in 0..200 {
        storm.push(connect(&place).await);
    }
    until(|| place.gateway.turned_away() == 201 - CLIENTS_MAX as u64).await;
    assert_eq!(place.gateway.clients().len(), CLIENTS_MAX);
    assert!(first.read_holding_registers(1546, 1).await.unwrap().is_ok());
    let mut late = storm.pop().unwrap();
    assert!(is_closed(&mut late, REQUEST_TIMEOUT).await);
    drop(storm);
    until(|| place.gateway.clients().len() == 1).await;
    serves(&place).await;
}

#[tokio::test]
async fn random_bytes_are_survived_and_nothing_is_written() {
    let place = place().await;
    let mut rng = fastrand::Rng::with_seed(7);
    for _ in 0..300 {
        let mut client = connect(&place).await;
        let mut bytes: Vec<u8> = Vec::new();
        for _ in 0..rng.usize(1..6) {
            // Messages with a good head and any function, address and length inside; then anything at all.
            let body: Vec<u8> = (0..rng.usize(1..40)).map(|_| rng.u8(..)).collect();
            let len = u16::try_from(body.len() + 2).unwrap();
            let function = [3, 6, 16, 23, rng.u8(..)][rng.usize(..5)];
            bytes.extend([0, rng.u8(..), 0, 0]);
            bytes.extend(len.to_be_bytes());
            bytes.extend([rng.u8(..), function]);
            bytes.extend(body);
        }
        let cut = rng.usize(..=bytes.len());
        bytes.truncate(cut);
        bytes.extend((0..rng.usize(..20)).map(|_| rng.u8(..)));
        let _closed = client.write_all(&bytes).await;
        if rng.bool() {
            let _some = timeout(Duration::from_millis(2), client.read(&mut [0; 64])).await;
        }
    }
    until(|| place.gateway.clients().is_empty()).await;
    serves(&place).await;
    assert_eq!(place.wires.writes(), Vec::<u16>::new());
    assert_eq!(place.hand.with(|hand, _| hand.journal().len()), 0);
    assert_eq!(place.link.stats().reconnects, 0);
}

#[tokio::test]
async fn a_dropped_gateway_leaves_no_listener_and_no_connection() {
    let place = place().await;
    let address = place.address();
    let mut client = connect(&place).await;
    client.write_all(&READ).await.unwrap();
    until(|| {
        place
            .gateway
            .clients()
            .iter()
            .any(|client| client.reads == 1)
    })
    .await;
    drop(place.gateway);
    assert!(is_closed(&mut client, Duration::from_secs(5)).await);
    until(|| std::net::TcpStream::connect(address).is_err()).await;
    assert!(place.link.status().state.is_live(), "the link stays");
}

#[tokio::test]
async fn clients_are_told_with_what_they_did() {
    let place = place().await;
    let mut client = place.client().await;
    for _ in 0..3 {
        assert!(
            client
                .read_holding_registers(1546, 6)
                .await
                .unwrap()
                .is_ok()
        );
    }
    assert!(
        client
            .read_holding_registers(1546, 0)
            .await
            .unwrap()
            .is_err()
    );
    let shown = place.gateway.clients();
    assert_eq!(shown.len(), 1);
    assert_eq!((shown[0].reads, shown[0].writes), (3, 0));
    assert!(shown[0].address.ip().is_loopback());
    assert_eq!(shown[0].lease, ClientLease::Never);
}
