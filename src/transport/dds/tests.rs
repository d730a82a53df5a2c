//! Participants without sockets: they meet, lose datagrams, and are told nonsense in the words of real ones.

use crate::transport::dds::message::{DdsMessage, DdsTopic};
use crate::transport::dds::participant::{Core, Places};
use crate::transport::dds::receive::{ASSEMBLED_MAX, Assemblies, Received};
use crate::transport::dds::wire::{
    Datagram, EndpointPair, EntityId, Fragment, Guid, Message, Prefix,
};
use crate::transport::dds::wire::{NumberSet, Submessage};
use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What others sent.
const PACKETS: &str = include_str!("../../../tests/interop/rtps_packets.txt");
const OWN: Prefix = [7; 12];
const TICK: Duration = Duration::from_millis(20);

fn packets() -> Vec<Vec<u8>> {
    let lines = PACKETS.lines().filter(|line| !line.starts_with('#'));
    let packet = |line: &str| -> Vec<u8> {
        let digits = line.as_bytes().chunks(2);
        let byte = |two: &[u8]| u8::from_str_radix(std::str::from_utf8(two).unwrap(), 16).unwrap();
        let mut bytes: Vec<u8> = digits.map(byte).collect();
        // They were of other domains, and for another participant.
        let domain = bytes.windows(4).position(|four| four == [0x0f, 0, 4, 0]);
        if let Some(at) = domain {
            bytes[at + 4..at + 8].fill(0);
        }
        if bytes[20] == 0x0e {
            bytes[24..36].copy_from_slice(&OWN);
        }
        bytes
    };
    lines.map(packet).collect()
}

fn topic(name: &str, type_name: &str) -> DdsTopic {
    DdsTopic {
        name: name.into(),
        type_name: type_name.into(),
    }
}

type Inbox = Arc<Mutex<Vec<DdsMessage>>>;

/// A participant, and what its readers got.
struct Peer {
    core: Core,
    port: u16,
    inbox: Inbox,
}

fn peer(number: u8, now: Instant) -> Peer {
    let at = |port| SocketAddrV4::new(Ipv4Addr::LOCALHOST, port);
    let port = 7410 + 2 * u16::from(number);
    let everyone = (0..4).map(|other| at(7410 + 2 * other));
    let places = Places {
        domain: 0,
        announcements: at(port),
        messages: at(port + 1),
        everyone: everyone.filter(|place| place.port() != port).collect(),
    };
    let prefix = if number == 0 { OWN } else { [number; 12] };
    Peer {
        core: Core::new(prefix, places, now),
        port,
        inbox: Inbox::default(),
    }
}

impl Peer {
    fn reads(&mut self, topic: &DdsTopic, now: Instant) -> EntityId {
        let inbox = Arc::clone(&self.inbox);
        let push = move |message| inbox.lock().unwrap().push(message);
        self.core.add_reader(topic, Box::new(push), now)
    }

    fn got(&self) -> Vec<Vec<u8>> {
        let all = self.inbox.lock().unwrap();
        all.iter().map(|message| message.bytes.clone()).collect()
    }
}

/// Lets participants talk for so long; `is_lost` decides for each datagram.
fn talk(
    peers: &mut [Peer],
    now: &mut Instant,
    length: Duration,
    mut is_lost: impl FnMut(&[u8]) -> bool,
) {
    let end = *now + length;
    while *now < end {
        peers.iter_mut().for_each(|peer| peer.core.tick(*now));
        // A word may be answered, and the answer too, but not for ever.
        for _ in 0..20 {
            let all: Vec<(SocketAddrV4, Vec<u8>)> = peers
                .iter_mut()
                .flat_map(|peer| peer.core.outgoing())
                .collect();
            for (place, bytes) in all.into_iter().filter(|(_, bytes)| !is_lost(bytes)) {
                let to = peers
                    .iter_mut()
                    .find(|peer| [peer.port, peer.port + 1].contains(&place.port()));
                if let Some(to) = to {
                    to.core.receive(&bytes, Ipv4Addr::LOCALHOST, *now);
                }
            }
        }
        *now += TICK;
    }
}

fn numbered(number: u32) -> Vec<u8> {
    [[0, 1, 0, 0], number.to_le_bytes()].concat()
}

#[test]
fn messages_arrive_in_order_whichever_end_came_first_and_whatever_is_lost() {
    for seed in 0..30 {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut now = Instant::now();
        let mut peers = [peer(0, now), peer(1, now)];
        let [writes, reads] = &mut peers;
        let topic = topic("rt/a", "t::T");
        let (early, late) = (seed % 2 == 0, seed % 3 == 0);
        let mut writer = early.then(|| writes.core.add_writer(&topic, (8, false), now));
        if late {
            reads.reads(&topic, now);
        }
        let mut lose = |_: &[u8]| random.u8(..10) < 3;
        talk(&mut peers, &mut now, Duration::from_secs(3), &mut lose);
        let [writes, reads] = &mut peers;
        if !late {
            reads.reads(&topic, now);
        }
        let writer = *writer.get_or_insert_with(|| writes.core.add_writer(&topic, (8, false), now));
        talk(&mut peers, &mut now, Duration::from_secs(12), &mut lose);
        for number in 0..50 {
            assert!(
                peers[0]
                    .core
                    .write(writer, numbered(number), Duration::ZERO, now)
            );
            talk(&mut peers, &mut now, TICK, |_| false);
        }
        let expected: Vec<Vec<u8>> = (0..50).map(numbered).collect();
        assert_eq!(peers[1].got(), expected, "seed {seed}");
    }
}

#[test]
fn one_that_leaves_or_falls_silent_is_forgotten() {
    let mut now = Instant::now();
    let mut peers = [peer(0, now), peer(1, now), peer(2, now)];
    talk(&mut peers, &mut now, Duration::from_secs(2), |_| false);
    assert_eq!(peers[0].core.known(), 2);
    peers[1].core.leave();
    talk(&mut peers, &mut now, TICK, |_| false);
    // It leaves with its last word, and is silent from then on.
    let mut rest: Vec<Peer> = peers.into_iter().filter(|peer| peer.port != 7412).collect();
    talk(&mut rest, &mut now, Duration::from_millis(100), |_| false);
    assert_eq!(rest[0].core.known(), 1);
    talk(&mut rest, &mut now, Duration::from_secs(130), |bytes| {
        bytes[8..20] == [2; 12]
    });
    assert_eq!(rest[0].core.known(), 0);
}

/// One that has met those of the recording, writes and reads what they do.
fn met(now: Instant) -> Peer {
    let mut own = peer(0, now);
    for (name, type_name) in [
        ("rt/b", "inspire::inspire_hand_ctrl"),
        ("x", "t::T"),
        ("l", "t::T"),
    ] {
        let writer = own
            .core
            .add_writer(&topic(name, type_name), (8, name == "l"), now);
        own.core
            .write(writer, vec![0, 1, 0, 0, 5, 0, 0, 0], Duration::ZERO, now);
    }
    own.reads(&topic("rt/a", "inspire::inspire_hand_ctrl"), now);
    own.reads(&topic("y", "t::T"), now);
    for packet in packets() {
        // The last ones of the recording say goodbye.
        let is_disposal = packet
            .windows(8)
            .any(|eight| eight == [0x71, 0, 4, 0, 0, 0, 0, 3]);
        if !is_disposal {
            own.core.receive(&packet, Ipv4Addr::LOCALHOST, now);
        }
    }
    own
}

/// More than a participant keeps of two others that have a dozen readers and writers.
const KEPT_MAX: usize = 1500;
/// More than one datagram makes it send.
const SENT_MAX: usize = 300;

/// Receives what was changed, and checks that little comes of it.
fn receive(own: &mut Peer, packet: &[u8], now: Instant, what: impl Fn() -> String) {
    own.core.receive(packet, Ipv4Addr::LOCALHOST, now);
    let sent = own.core.outgoing().len();
    assert!(sent <= SENT_MAX, "{}: {sent} datagrams", what());
    own.inbox.lock().unwrap().clear();
}

/// It still meets a new one, and hears it.
fn is_well(own: Peer, mut now: Instant, what: &str) {
    let kept = own.core.stored();
    assert!(kept < KEPT_MAX, "{what}: {kept} things are kept");
    let topic = topic("y", "t::T");
    let mut peers = [own, peer(3, now)];
    let writer = peers[1].core.add_writer(&topic, (8, false), now);
    talk(&mut peers, &mut now, Duration::from_secs(3), |_| false);
    assert!(
        peers[1]
            .core
            .write(writer, numbered(77), Duration::ZERO, now),
        "{what}"
    );
    talk(&mut peers, &mut now, Duration::from_secs(1), |_| false);
    assert_eq!(peers[0].got().last(), Some(&numbered(77)), "{what}");
}

#[test]
fn real_packets_are_understood() {
    let now = Instant::now();
    let own = met(now);
    assert_eq!(own.core.known(), 2);
    // CycloneDDS ends its message with three bytes that fill it up, of which it does not tell.
    for len in [4 + 4 * 16 + 1 + 3, 8] {
        let got = own.got();
        assert!(got.iter().any(|bytes| bytes.len() == len), "{got:?}");
    }
    is_well(own, now, "nothing was changed");
}

#[test]
fn a_field_of_a_real_packet_that_says_anything_takes_no_memory() {
    let now = Instant::now();
    let mut own = met(now);
    for (number, packet) in packets().iter().enumerate() {
        for at in (20..packet.len().saturating_sub(8)).step_by(2) {
            // As two bytes, four, and two halves of a sequence number.
            let all: [&[u8]; 7] = [
                &[0xff, 0xff],
                &[0, 0],
                &[0, 1, 0, 0],
                &[0xff, 0xff, 0xff, 0x7f],
                &[0xff; 4],
                &[0, 1, 0, 0, 0, 0, 0, 0],
                &[0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff],
            ];
            for bytes in all {
                let mut changed = packet.clone();
                changed[at..at + bytes.len()].copy_from_slice(bytes);
                let what = || format!("packet {number}, {bytes:x?} at {at}");
                receive(&mut own, &changed, now, what);
            }
        }
        let kept = own.core.stored();
        assert!(kept < KEPT_MAX, "packet {number}: {kept} things are kept");
    }
    is_well(own, now, "fields were changed");
}

#[test]
fn many_changes_of_real_packets_take_no_memory() {
    let originals = packets();
    for seed in 0..12 {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut now = Instant::now();
        let mut own = met(now);
        for nth in 0..3000 {
            let mut packet = originals[random.usize(..originals.len())].clone();
            for _ in 0..random.usize(1..6) {
                let at = random.usize(20..packet.len());
                match random.u8(..6) {
                    0 => packet[at] ^= 1 << random.u8(..8),
                    1 => packet[at] = random.u8(..),
                    2 => packet.truncate(at.max(21)),
                    3 => packet.extend_from_within(at..),
                    4 if at + 4 <= packet.len() => {
                        let value = [0, 1, u32::MAX, 1 << 31, 1 << 8][random.usize(..5)];
                        packet[at..at + 4].copy_from_slice(&u32::to_le_bytes(value));
                    }
                    _ => packet[8 + at % 12] ^= random.u8(..3),
                }
            }
            receive(&mut own, &packet, now, || {
                format!("seed {seed}, packet {nth}")
            });
            now += Duration::from_micros(random.u64(..2000));
            own.core.tick(now);
            own.core.outgoing();
        }
        is_well(own, now, &format!("seed {seed}"));
    }
}

#[test]
fn a_heartbeat_of_a_million_million_messages_is_asked_for_256_and_heals() {
    let mut now = Instant::now();
    let mut peers = [peer(0, now), peer(1, now)];
    talk(&mut peers, &mut now, Duration::from_secs(2), |_| false);
    let ends = EndpointPair {
        reader: EntityId::UNKNOWN,
        writer: EntityId::PUBLICATIONS_WRITER,
    };
    for range in [(1, 1 << 40), (1 << 40, 1 << 40), (1 << 40, (1 << 62) + 5)] {
        let forged = Datagram::new([1; 12], None)
            .heartbeat(ends, range, (1, true))
            .bytes();
        assert_eq!(forged.len(), 52);
        peers[0].core.receive(&forged, Ipv4Addr::LOCALHOST, now);
        let answers = peers[0].core.outgoing();
        assert_eq!(answers.len(), 1, "{range:?}");
        assert!(
            answers[0].1.len() < 120,
            "{range:?}: {} bytes",
            answers[0].1.len()
        );
    }
    // What the true one announces later is heard all the same.
    let topic = topic("rt/late", "t::T");
    let writer = peers[1].core.add_writer(&topic, (8, false), now);
    peers[0].reads(&topic, now);
    talk(&mut peers, &mut now, Duration::from_secs(6), |_| false);
    assert!(
        peers[1]
            .core
            .write(writer, numbered(3), Duration::ZERO, now)
    );
    talk(&mut peers, &mut now, Duration::from_secs(1), |_| false);
    assert_eq!(peers[0].got(), [numbered(3)]);
}

#[test]
fn what_is_missing_is_asked_for_until_it_came_or_will_not() {
    let mut received = Received::default();
    assert!(received.accept(1) && !received.accept(1));
    assert!(received.accept(4));
    let request = received.heartbeat((1, 5), true).unwrap();
    assert_eq!(
        (request.missing.base, request.missing.numbers),
        (2, vec![2, 3, 5])
    );
    let set = NumberSet {
        base: 3,
        numbers: vec![5],
    };
    received.gap(2, &set);
    let request = received.heartbeat((1, 5), false).unwrap();
    assert_eq!(
        (request.missing.base, request.missing.numbers),
        (3, vec![3])
    );
    assert!(received.accept(3));
    assert_eq!(received.heartbeat((1, 5), false), None);
    assert_eq!(received.heartbeat((1, 5), true).unwrap().missing.base, 6);
    // Gaps without end leave a window of 256.
    for start in [7, 1 << 30, 1 << 40] {
        let numbers = (start..start + 256).collect();
        received.gap(
            start,
            &NumberSet {
                base: start,
                numbers,
            },
        );
        assert!(received.stored() <= 256);
    }
}

#[test]
fn a_long_message_is_put_together_and_no_longer_one() {
    let writer = Guid {
        prefix: [1; 12],
        entity: EntityId([0, 0, 1, 3]),
    };
    let whole: Vec<u8> = (0..=249).cycle().take(2500).collect();
    let mut assemblies = Assemblies::default();
    let part = |first: usize| Fragment {
        number: 1,
        first,
        fragment_size: 1000,
        total_size: whole.len(),
        bytes: &whole[first * 1000..whole.len().min(first * 1000 + 1000)],
    };
    let key = (writer, EntityId::UNKNOWN);
    assert_eq!(assemblies.push(key, &part(2)), None);
    assert_eq!(assemblies.push(key, &part(0)), None);
    assert_eq!(assemblies.push(key, &part(1)).as_ref(), Some(&whole));
    let kinds = [(0, 1), (5, 1000), (usize::MAX - 1, 1), (0, 1000)];
    for (number, (first, fragment_size)) in (1..1000).zip(kinds.into_iter().cycle()) {
        for total_size in [ASSEMBLED_MAX, ASSEMBLED_MAX + 1, usize::MAX] {
            let part = Fragment {
                number,
                first,
                fragment_size,
                total_size,
                bytes: &[1, 2, 3],
            };
            assert_eq!(assemblies.push(key, &part), None);
        }
    }
    assert!(assemblies.stored() <= 8 * ASSEMBLED_MAX);
}

#[test]
fn what_is_written_is_read_as_it_was() {
    let ends = EndpointPair {
        reader: EntityId([0, 0, 1, 4]),
        writer: EntityId([0, 0, 2, 3]),
    };
    let set = NumberSet {
        base: (7 << 32) + 5,
        numbers: vec![(7 << 32) + 5, (7 << 32) + 100, (7 << 32) + 260],
    };
    let bytes = Datagram::new(OWN, Some([9; 12])).gap(ends, 3, &set).bytes();
    let message = Message::parse(&bytes).unwrap();
    assert_eq!(message.from, OWN);
    let all: Vec<Submessage<'_>> = message.collect();
    let start = 3;
    let gap = Submessage::Gap { ends, start, set };
    assert_eq!(all, [Submessage::Destination([9; 12]), gap]);
}
