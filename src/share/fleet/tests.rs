//! What is told, what is believed of it, and when a hand is no longer there.

use super::*;
use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::record::LinkState;
use crate::record::file::format::cdr;
use crate::transport::dds::DdsWriterId;
use std::net::{Ipv4Addr, SocketAddr};

const LOOPBACK: Ipv4Addr = Ipv4Addr::LOCALHOST;
const ETHERNET: Ipv4Addr = Ipv4Addr::new(203, 0, 113, 5);

fn hand(name: &str, at: &str) -> FleetHand {
    FleetHand {
        card: FleetCard {
            host: "lab".into(),
            name: name.into(),
            side: Side::Left,
            at: at.parse().ok(),
            first_may_move: true,
            follows: false,
        },
        state: LinkState::Armed,
        owner: None,
    }
}

fn id(n: u16) -> DdsWriterId {
    let mut id = [0; 16];
    id[..2].copy_from_slice(&n.to_be_bytes());
    DdsWriterId(id)
}

fn ms(ms: u64) -> Moment {
    Moment::from_micros(ms * 1000)
}

#[test]
fn a_gateway_is_told_only_to_those_who_reach_it() {
    for (gateway, interface, announced) in [
        ("127.0.0.1:6001", LOOPBACK, "127.0.0.1:6001"),
        ("0.0.0.0:6001", LOOPBACK, "127.0.0.1:6001"),
        ("0.0.0.0:6001", ETHERNET, "203.0.113.5:6001"),
        ("203.0.113.5:6001", ETHERNET, "203.0.113.5:6001"),
        ("[::]:6001", ETHERNET, "203.0.113.5:6001"),
        // Another computer would find itself there, and perhaps another hand.
        ("127.0.0.1:6001", ETHERNET, ""),
        ("[::1]:6001", ETHERNET, ""),
        ("203.0.113.5:6001", LOOPBACK, ""),
    ] {
        let at = reachable(gateway.parse().unwrap(), interface);
        let wanted: Option<SocketAddr> = announced.parse().ok();
        assert_eq!(at, wanted, "{gateway} at {interface}");
        // Nor is it believed of another.
        let parsed = FleetHand::parse(&hand("egg", gateway).message(), interface);
        assert_eq!(parsed.unwrap().card.at, wanted, "{gateway} at {interface}");
    }
}

#[test]
fn a_notice_is_read_as_it_was_written_and_names_stay_on_their_line() {
    let announced = hand("egg", "127.0.0.1:6001");
    assert_eq!(
        FleetHand::parse(&announced.message(), LOOPBACK),
        Some(announced)
    );
    let long = "手".repeat(100);
    let parsed = FleetHand::parse(&hand(&long, "").message(), LOOPBACK);
    assert_eq!(parsed.unwrap().card.name.chars().count(), 60);
    let text = |name: &str| {
        let text = format!(
            r#"{{"v":1,"host":"a\nb","name":"{name}","side":"left","at":null,"first_may_move":false,"state":"armed","owner":null,"new":1}}"#
        );
        FleetHand::parse(&cdr::encode(&text), LOOPBACK)
    };
    let parsed = text("x\\u0007\u{202e}y").unwrap();
    assert_eq!(
        (parsed.card.host.as_str(), parsed.card.name.as_str()),
        ("ab", "xy")
    );
    assert_eq!(text(&"x".repeat(NOTICE_BYTES_MAX)), None);
    for wrong in [
        "",
        "{}",
        "[1]",
        r#"{"v":2,"host":"","name":"","side":"left","at":null,"first_may_move":false,"state":"armed","owner":null}"#,
        r#"{"v":1,"host":"","name":"","side":"up","at":null,"first_may_move":false,"state":"armed","owner":null}"#,
        r#"{"v":1,"host":"","name":"","side":"left","at":"nowhere","first_may_move":false,"state":"armed","owner":null}"#,
    ] {
        assert_eq!(
            FleetHand::parse(&cdr::encode(&wrong), LOOPBACK),
            None,
            "{wrong}"
        );
    }
}

#[test]
fn a_hand_is_there_for_as_long_as_it_is_told_of() {
    let mut book = FleetBook::default();
    assert!(book.apply(id(1), hand("b", ""), ms(0)));
    assert!(!book.apply(id(1), hand("b", ""), ms(400)), "nothing new");
    assert!(book.apply(id(2), hand("a", ""), ms(500)));
    let names = |book: &FleetBook| -> Vec<String> {
        let hands = book.list().into_iter();
        hands.map(|hand| hand.card.name).collect()
    };
    assert_eq!(names(&book), ["a", "b"]);
    assert!(book.apply(id(1), hand("c", ""), ms(800)));
    assert_eq!(names(&book), ["a", "c"]);
    assert!(!book.sweep(ms(1999)));
    assert!(book.sweep(ms(2000)), "1.5 s after it was heard");
    assert_eq!(names(&book), ["c"]);
    assert!(book.sweep(ms(60_000)));
    assert_eq!(names(&book), [""; 0]);
}

#[test]
fn no_more_hands_are_kept_than_a_list_has_room_for() {
    let mut book = FleetBook::default();
    for n in 0..1000 {
        book.apply(id(n), hand("x", ""), ms(0));
    }
    assert_eq!(book.list().len(), HANDS_MAX);
    // Those that are there still change.
    assert!(book.apply(id(3), hand("y", ""), ms(1)));
    assert!(!book.apply(id(999), hand("y", ""), ms(1)));
}
