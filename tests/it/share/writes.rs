//! What clients of a gateway may write, which of them may, and how that ends: always with a stop.

use crate::share::place::{Place, config, share_as, until};
use handscope::hand::{Dof, Fault};
use handscope::link::{LeaseRefusal, Owner, PollRates};
use handscope::record::{Disarmed, Hold, LinkState};
use handscope::share::gateway::{ClientLease, GatewayClient, GatewayConfig, WriteRefusal, Writers};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::sleep;
use tokio_modbus::ExceptionCode;
use tokio_modbus::client::{Context, Reader as _, Writer as _};

const BUSY: Result<(), ExceptionCode> = Err(ExceptionCode::ServerDeviceBusy);
/// The index finger's angle, and where it begins and is sent.
const INDEX: u16 = 1486 + 6;
const ARMING: [u16; 2] = [1522, 1498];
/// A drive has its dead time behind it, and far to go.
const MOVES_AFTER: Duration = Duration::from_millis(150);

async fn first_may() -> Place {
    silent_after(Duration::from_secs(60)).await
}

async fn silent_after(silence: Duration) -> Place {
    let first = GatewayConfig {
        writers: Writers::First,
        silence,
        ..config()
    };
    let place = share_as(first, PollRates::default(), Duration::ZERO).await;
    // Until the link has read what it arms with.
    until(|| place.link.stats().state_reads > 20).await;
    place
}

async fn put(client: &mut Context, address: u16, words: &[u16]) -> Result<(), ExceptionCode> {
    match words {
        [value] => client.write_single_register(address, *value).await,
        words => client.write_multiple_registers(address, words).await,
    }
    .unwrap()
}

async fn read(client: &mut Context, address: u16, count: u16) -> Vec<u16> {
    let read = client.read_holding_registers(address, count).await;
    read.unwrap().unwrap()
}

fn newest(place: &Place) -> GatewayClient {
    place.gateway.clients().pop().unwrap()
}

/// The targets that reached the hand for the index finger.
fn targets(place: &Place) -> Vec<i16> {
    place.hand.with(|hand, _| {
        let all = hand.journal().iter();
        // A stop tells all joints.
        let index = all.filter_map(|write| match (write.address, &write.bytes[..]) {
            (INDEX, [low, high]) | (1486, [_, _, _, _, _, _, low, high, ..]) => {
                Some(i16::from_le_bytes([*low, *high]))
            }
            _ => None,
        });
        index.collect()
    })
}

/// A client that moves the index finger.
async fn mover(place: &Place) -> Context {
    let mut client = place.client().await;
    assert_eq!(put(&mut client, INDEX, &[0]).await, Ok(()));
    assert_eq!(targets(place), [0]);
    let owner = Owner::Gateway(newest(place).address);
    assert_eq!(place.link.status().holder.unwrap().owner, owner);
    client
}

/// The hand was stopped on its way, and nobody may move it.
async fn is_stopped(place: &Place) {
    until(|| matches!(place.link.status().hold, Hold::Confirmed { .. })).await;
    let status = place.link.status();
    assert_eq!((status.armed, status.holder), (None, None));
    let last = *targets(place).last().unwrap();
    assert!((1..1000).contains(&last), "held where it was: {last}");
}

#[tokio::test]
async fn nobody_moves_the_hand_unless_a_person_grants_it() {
    let place = share_as(config(), PollRates::default(), Duration::ZERO).await;
    let mut client = place.client().await;
    for (address, words) in [
        (INDEX, &[0][..]),
        (1486, &[0; 6]),
        (1498, &[500; 6]),
        (1522, &[500]),
        (1004, &[1]),
        (1008, &[8]),
    ] {
        assert_eq!(put(&mut client, address, words).await, BUSY, "{address}");
    }
    let shown = newest(&place);
    assert_eq!((shown.writes, shown.refused), (0, 6));
    assert_eq!(shown.refusal, Some(WriteRefusal::NotGranted));
    assert_eq!(place.wires.writes(), Vec::<u16>::new());
    assert_eq!(place.link.status().state, LinkState::Monitoring);
}

#[tokio::test]
async fn two_clients_at_once_one_moves_the_hand_and_the_other_looks_on() {
    let place = first_may().await;
    let (mut mover, mut other) = (place.client().await, place.client().await);
    assert_eq!(put(&mut mover, INDEX, &[300]).await, Ok(()));
    assert_eq!(place.wires.writes(), [1522, 1498, INDEX]);
    assert_eq!(put(&mut other, INDEX, &[700]).await, BUSY);
    assert_eq!(put(&mut other, 1522, &[700]).await, BUSY);
    // What the hand holds is seen by both from then on.
    for client in [&mut mover, &mut other] {
        assert_eq!(read(client, INDEX, 1).await, [300]);
    }
    let speeds = [100, 200, 300, 400, 500, 600];
    assert_eq!(put(&mut mover, 1522, &speeds).await, Ok(()));
    assert_eq!(read(&mut other, 1522, 6).await, speeds);
    let all = [0xFFFF, 0xFFFF, 0xFFFF, 400, 0xFFFF, 0xFFFF];
    assert_eq!(put(&mut mover, 1486, &all).await, Ok(()));
    assert_eq!(targets(&place), [300, 400]);
    loop {
        let angle = read(&mut other, 1546 + 6, 1).await[0];
        if angle < 450 {
            break;
        }
        sleep(Duration::from_millis(5)).await;
    }
    let shown = place.gateway.clients();
    assert!(matches!(shown[0].lease, ClientLease::Held(_)));
    assert_eq!((shown[0].writes, shown[0].refused), (3, 0));
    assert_eq!((shown[1].writes, shown[1].refused), (0, 2));
    assert_eq!(shown[1].refusal, Some(WriteRefusal::Taken));
}

#[tokio::test]
async fn whoever_may_not_move_the_hand_stops_what_another_moves_and_may_not_move_it_by_that() {
    let place = first_may().await;
    let (mut mover, mut other) = (mover(&place).await, place.client().await);
    sleep(MOVES_AFTER).await;
    // A stop is six targets about where the joints are, which another program writes again until it sees rest.
    let five = read(&mut other, 1546, 5).await;
    assert_eq!(put(&mut other, 1486, &five).await, BUSY, "not all joints");
    let far = [700, 1000, 1000, 1000, 1000, 1000];
    assert_eq!(
        put(&mut other, 1486, &far).await,
        BUSY,
        "not where they are"
    );
    let before = targets(&place).len();
    for _ in 0..8 {
        let here = read(&mut other, 1546, 6).await;
        assert_eq!(put(&mut other, 1486, &here).await, Ok(()));
        sleep(Duration::from_millis(40)).await;
    }
    is_stopped(&place).await;
    assert!(targets(&place).len() > before, "the link held it");
    let shown = place.gateway.clients();
    let stop = LeaseRefusal::Ended(Disarmed::Stop);
    assert_eq!(shown[0].lease, ClientLease::Ended(stop));
    assert_eq!(shown[1].lease, ClientLease::Never);
    assert_eq!(put(&mut mover, INDEX, &[0]).await, BUSY, "it was ended");
    assert_eq!(put(&mut other, INDEX, &[0]).await, Ok(()), "the next may");
}

/// A request on the wire.
#[tokio::test]
async fn a_stop_is_obeyed_whatever_is_odd_about_its_request() {
    // Of who may not move the hand, and of who does.
    for own in [false, true] {
        for odd in 0..6 {
            let place = first_may().await;
            let mut button = TcpStream::connect(place.address()).await.unwrap();
            let mut reader = place.client().await;
            let _mover = if own {
                button.write_all(&set_index(0)).await.unwrap();
                button.read_exact(&mut [0; 12]).await.unwrap();
                None
            } else {
                Some(mover(&place).await)
            };
            sleep(MOVES_AFTER).await;
            let mut words = read(&mut reader, 1546, 6).await;
            let index = words[3];
            assert!((200..950).contains(&index), "on its way: {index}");
            let mut count = None;
            match odd {
                // As it was read of a joint that rests beyond its end.
                0 => words[0] = 1003,
                1 => words[5] = 0xFFFD,
                // No value at all, as a sender says NaN.
                2 => words[1] = 0x7FFF,
                // More than ANGLE_SET.
                3 => words.extend([500; 3]),
                // It announces more than there is, and less.
                4 => count = Some(9),
                _ => count = Some(2),
            }
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
            let count = count.unwrap_or(u16::try_from(words.len()).unwrap());
            let head = [1486u16.to_be_bytes(), count.to_be_bytes()].concat();
            let len = u8::try_from(bytes.len()).unwrap();
            let pdu = [&[16], head.as_slice(), &[len], &bytes].concat();
            button.write_all(&asked(&pdu)).await.unwrap();
            let mut said = [0; 12];
            button.read_exact(&mut said).await.unwrap();
            assert_eq!(said[7], 16, "{own} {odd}: no exception");
            is_stopped(&place).await;
            let shown = place.gateway.clients();
            let refusal = shown.iter().find_map(|client| client.refusal.clone());
            assert!(refusal.is_some(), "what was odd is told: {odd}");
        }
    }
}

fn asked(pdu: &[u8]) -> Vec<u8> {
    let len = 1 + pdu.len() as u8;
    [&[0, 1, 0, 0, 0, len, 255], pdu].concat()
}

fn set_index(angle: u16) -> Vec<u8> {
    let [high, low] = INDEX.to_be_bytes();
    asked(&[&[6, high, low], &angle.to_be_bytes()[..]].concat())
}

/// Reads for which the hand must be asked, and which are asked seldom.
fn slow_reads(count: u16) -> Vec<u8> {
    let addresses = (0..count).map(|nth| (2000 + 20 * nth).to_be_bytes());
    let reads = addresses.map(|[high, low]| asked(&[3, high, low, 0, 1]));
    reads.collect::<Vec<_>>().concat()
}

#[tokio::test]
async fn whoever_leaves_or_asks_too_much_behind_a_move_stops_the_hand_at_once() {
    let many_writes = (0..40).flat_map(|_| set_index(0)).collect();
    for (behind, leaves) in [
        (slow_reads(15), true),
        (slow_reads(40), true),
        (many_writes, false),
    ] {
        let place = first_may().await;
        let mut client = TcpStream::connect(place.address()).await.unwrap();
        client.write_all(&set_index(0)).await.unwrap();
        until(|| targets(&place) == [0]).await;
        sleep(MOVES_AFTER).await;
        client.write_all(&behind).await.unwrap();
        if leaves {
            client.shutdown().await.unwrap();
        }
        is_stopped(&place).await;
        let mut rest = Vec::new();
        // It hangs up.
        let _end = client.read_to_end(&mut rest).await;
        until(|| place.gateway.clients().is_empty()).await;
    }
}

#[tokio::test]
async fn a_stop_goes_past_what_its_client_asked_before() {
    let place = first_may().await;
    let mut other = place.client().await;
    let _mover = mover(&place).await;
    sleep(MOVES_AFTER).await;
    let here = read(&mut other, 1546, 6).await;
    let mut client = TcpStream::connect(place.address()).await.unwrap();
    let here: Vec<u8> = here.iter().flat_map(|angle| angle.to_be_bytes()).collect();
    let [high, low] = 1486_u16.to_be_bytes();
    let stop = asked(&[&[16, high, low, 0, 6, 12], &here[..]].concat());
    let behind = [slow_reads(40), stop].concat();
    client.write_all(&behind).await.unwrap();
    is_stopped(&place).await;
}

#[tokio::test]
async fn what_clients_may_not_write_never_reaches_the_wire() {
    let place = first_may().await;
    let mut client = mover(&place).await;
    let before = place.wires.writes();
    for address in [1000, 1002, 1005, 1006, 1009, 1020, 1032, 1044, 1066, 1474] {
        let told = put(&mut client, address, &[1]).await;
        assert_eq!(told, Err(ExceptionCode::IllegalDataAddress), "{address}");
    }
    for (address, words) in [
        (1004, &[1, 1][..]),
        (1486, &[500; 7]),
        (1487, &[500; 2]),
        (1546, &[500; 6]),
        (1700, &[0xA8C0, 0xD20B]),
        (2320, &[1]),
        (2322, &[1]),
        (3000, &[1]),
        (65535, &[1]),
    ] {
        let told = put(&mut client, address, words).await;
        assert_eq!(told, Err(ExceptionCode::IllegalDataAddress), "{address}");
    }
    for (address, value) in [
        (INDEX, 1001),
        (INDEX, 0xFFFE),
        (1498, 3001),
        (1522, 0xFFFF),
        (1004, 2),
        (1008, 41),
    ] {
        let told = put(&mut client, address, &[value]).await;
        assert_eq!(told, Err(ExceptionCode::IllegalDataValue), "{address}");
    }
    assert_eq!(place.wires.writes(), before);
    let shown = newest(&place);
    assert_eq!((shown.writes, shown.refused), (1, 25));
    let value = WriteRefusal::Value { address: 1008 };
    assert_eq!(shown.refusal, Some(value));
    assert!(matches!(shown.lease, ClientLease::Held(_)), "it keeps it");
}

#[tokio::test]
async fn a_client_that_goes_leaves_a_stopped_hand_and_the_right_to_the_next() {
    let place = first_may().await;
    let client = mover(&place).await;
    sleep(MOVES_AFTER).await;
    drop(client);
    is_stopped(&place).await;
    let mut next = place.client().await;
    let stopped = targets(&place).len();
    assert_eq!(put(&mut next, INDEX, &[900]).await, Ok(()));
    assert_eq!(targets(&place)[stopped..], [900]);
}

#[tokio::test]
async fn a_silent_client_may_no_more_until_it_connects_again() {
    let place = silent_after(Duration::from_millis(400)).await;
    let mut client = mover(&place).await;
    for _ in 0..8 {
        // Whoever reads is not silent.
        sleep(Duration::from_millis(100)).await;
        read(&mut client, 1546, 6).await;
    }
    assert!(matches!(newest(&place).lease, ClientLease::Held(_)));
    assert_eq!(put(&mut client, INDEX, &[1000]).await, Ok(()));
    sleep(Duration::from_millis(100)).await;
    until(|| newest(&place).lease == ClientLease::Ended(LeaseRefusal::Ended(Disarmed::Silent)))
        .await;
    until(|| matches!(place.link.status().hold, Hold::Confirmed { .. })).await;
    assert_eq!(put(&mut client, INDEX, &[0]).await, BUSY);
    assert_eq!(newest(&place).refusal, Some(WriteRefusal::Over));
    drop(client);
    drop(mover_again(&place).await);
}

/// A client that moves a hand that was moved before.
async fn mover_again(place: &Place) -> Context {
    let mut client = place.client().await;
    assert_eq!(put(&mut client, INDEX, &[500]).await, Ok(()));
    client
}

#[tokio::test]
async fn a_fault_ends_the_right_and_stops_the_hand() {
    let place = first_may().await;
    let mut client = mover(&place).await;
    sleep(MOVES_AFTER).await;
    place
        .hand
        .with(|hand, _| hand.inject_fault(Dof::Ring, Fault::OverCurrent));
    until(|| newest(&place).lease == ClientLease::Ended(LeaseRefusal::Ended(Disarmed::Fault)))
        .await;
    is_stopped(&place).await;
    let moved = targets(&place).len();
    assert_eq!(put(&mut client, INDEX, &[900]).await, BUSY);
    assert_eq!(newest(&place).refusal, Some(WriteRefusal::Over));
    // To clear the fault moves nothing; to move the hand it has to connect again.
    assert_eq!(put(&mut client, 1004, &[1]).await, Ok(()));
    until(|| place.link.status().state == LinkState::Monitoring).await;
    assert_eq!(put(&mut client, INDEX, &[900]).await, BUSY);
    assert!(!targets(&place)[moved..].contains(&900));
}

#[tokio::test]
async fn to_clear_errors_takes_the_right_as_any_write_but_while_a_fault_keeps_it_from_everybody() {
    let place = first_may().await;
    let (mut first, mut other) = (place.client().await, place.client().await);
    assert_eq!(put(&mut first, 1004, &[1]).await, Ok(()));
    let owner = place.link.status().holder.map(|holder| holder.owner);
    assert_eq!(
        owner,
        Some(Owner::Gateway(place.gateway.clients()[0].address))
    );
    assert_eq!(put(&mut other, 1004, &[1]).await, BUSY);
    place
        .hand
        .with(|hand, _| hand.inject_fault(Dof::Ring, Fault::OverCurrent));
    until(|| place.link.status().state == LinkState::Fault).await;
    until(|| place.link.status().holder.is_none()).await;
    assert_eq!(put(&mut other, INDEX, &[500]).await, BUSY);
    assert_eq!(put(&mut other, 1004, &[1]).await, Ok(()));
    until(|| place.link.status().state == LinkState::Monitoring).await;
    assert_eq!(
        place.link.status().holder,
        None,
        "to clear gave nobody a right"
    );
    // Once the stop is over.
    while put(&mut other, INDEX, &[500]).await == BUSY {
        sleep(Duration::from_millis(5)).await;
    }
}

#[tokio::test]
async fn a_lost_link_ends_the_right_and_nothing_goes_on_when_it_is_back() {
    let place = first_may().await;
    let mut client = mover(&place).await;
    place.wires.cut();
    until(|| !place.link.status().state.is_live()).await;
    let told = put(&mut client, INDEX, &[900]).await;
    assert!(told.is_err(), "{told:?}");
    place.wires.mend();
    until(|| place.link.status().state.is_live()).await;
    let ended = ClientLease::Ended(LeaseRefusal::Ended(Disarmed::LinkLost));
    until(|| newest(&place).lease == ended).await;
    assert_eq!(put(&mut client, INDEX, &[900]).await, BUSY);
    until(|| place.link.stats().state_reads > 60).await;
    assert_eq!(place.link.status().armed, None);
    assert!(!targets(&place).contains(&900));
}

/// A mover's stop while the hand falls silent: at once, once the link is known to be lost, and once it is back and goes on.
#[tokio::test]
async fn a_stop_of_a_mover_whose_hand_fell_silent_reaches_it_when_it_answers_again() {
    for when in 0..3 {
        let place = first_may().await;
        let mut client = mover(&place).await;
        // It is on its way for longer than the link is lost.
        assert_eq!(put(&mut client, 1522, &[50; 6]).await, Ok(()));
        let mut onlooker = place.client().await;
        sleep(MOVES_AFTER).await;
        let seen = read(&mut client, 1546, 6).await;
        let is_live = || place.link.status().state.is_live();
        place.wires.silent(true);
        if when > 0 {
            until(|| !is_live()).await;
        }
        if when < 2 {
            let told = put(&mut client, 1486, &seen).await;
            assert!(told.is_err(), "{when}: nothing was stopped yet");
            let told = put(&mut onlooker, 1486, &seen).await;
            assert!(told.is_err(), "{when}: nothing was stopped yet");
        }
        assert_eq!(targets(&place), [0], "{when}");
        place.wires.silent(false);
        until(is_live).await;
        if when == 2 {
            let seen = read(&mut client, 1546, 6).await;
            assert_eq!(put(&mut client, 1486, &seen).await, Ok(()));
        }
        is_stopped(&place).await;
        assert_eq!(put(&mut client, INDEX, &[900]).await, BUSY, "{when}");
    }
}

#[tokio::test]
async fn a_stop_by_a_person_ends_the_right() {
    let place = first_may().await;
    let mut client = mover(&place).await;
    sleep(MOVES_AFTER).await;
    place.link.stop();
    is_stopped(&place).await;
    assert_eq!(put(&mut client, INDEX, &[900]).await, BUSY);
    assert_eq!(newest(&place).refusal, Some(WriteRefusal::Over));
}

#[tokio::test]
async fn a_gateway_that_closes_stops_what_a_client_moves() {
    let place = first_may().await;
    let _client = mover(&place).await;
    sleep(MOVES_AFTER).await;
    let Place { gateway, link, .. } = &place;
    assert_eq!(gateway.clients().len(), 1);
    assert!(link.status().armed.is_some());
    let place = place.close();
    until(|| matches!(place.link.status().hold, Hold::Confirmed { .. })).await;
    assert_eq!(place.link.status().holder, None);
}

#[tokio::test]
async fn a_person_grants_it_to_the_client_of_choice_who_then_has_it_alone() {
    let place = share_as(config(), PollRates::default(), Duration::ZERO).await;
    until(|| place.link.stats().state_reads > 20).await;
    let (mut one, mut two) = (place.client().await, place.client().await);
    let ids = || -> Vec<_> {
        let clients = place.gateway.clients();
        clients.iter().map(|client| client.id).collect()
    };
    until(|| ids().len() == 2).await;
    let may = |nth: usize| matches!(place.gateway.clients()[nth].lease, ClientLease::Held(_));
    place.gateway.grant(ids()[1]);
    until(|| may(1) && place.link.status().armed.is_some()).await;
    assert_eq!(place.wires.writes(), ARMING, "nothing moves by a grant");
    assert_eq!(put(&mut one, INDEX, &[900]).await, BUSY);
    assert_eq!(put(&mut two, INDEX, &[800]).await, Ok(()));
    place.gateway.grant(ids()[0]);
    until(|| may(0)).await;
    assert_eq!(put(&mut two, INDEX, &[700]).await, BUSY);
    assert_eq!(put(&mut one, INDEX, &[600]).await, Ok(()));
    assert_eq!(targets(&place), [800, 600]);
}

#[tokio::test]
async fn clients_that_write_in_a_storm_get_one_lease_and_only_targets_reach_the_hand() {
    let place = first_may().await;
    let mut clients = tokio::task::JoinSet::new();
    for seed in 0..6 {
        let mut client = place.client().await;
        clients.spawn(async move {
            let mut rng = fastrand::Rng::with_seed(seed);
            let mut done = 0;
            for _ in 0..40 {
                let address = [1486, 1488, 1498, 1522, 1005, 1000, 1700, rng.u16(..)];
                let address = address[rng.usize(..address.len())];
                let words: Vec<u16> = (0..rng.usize(1..4)).map(|_| rng.u16(..1200)).collect();
                done += usize::from(put(&mut client, address, &words).await.is_ok());
            }
            (done > 0, client)
        });
    }
    let ends = clients.join_all().await;
    assert_eq!(ends.iter().filter(|(wrote, _)| *wrote).count(), 1);
    let known = [1486, 1498, 1522];
    let inside = |address: &u16| known.iter().any(|at| (*at..at + 12).contains(address));
    let writes = place.wires.writes();
    assert!(writes.len() > 5 && writes.iter().all(inside), "{writes:?}");
}
