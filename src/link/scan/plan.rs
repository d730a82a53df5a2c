//! Plan of a scan: its probes, their order, and the time they take; likely and cheap ones first. Sends nothing, and has
//! no clock.

use crate::hand::{HandId, SerialSpeed};
use crate::link::scan::hosts::Hosts;
use crate::transport::endpoint::{DEFAULT_BAUD, DEFAULT_BITRATE, DEFAULT_ID, DEFAULT_UNIT};
use crate::transport::tcp::CONNECT_DEADLINE;
use crate::transport::{Endpoint, SerialLine, UsbFound};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::Duration;

/// CAN bit rates that a hand can have (manual 2.6.2), the default first.
pub const BITRATES: [u32; 2] = [DEFAULT_BITRATE, 500_000];
/// Units probed at a TCP address: the manual's, and the default of other servers.
pub const UNITS: [u8; 2] = [DEFAULT_UNIT, 1];
/// Wait for a reply: a hand answers within 15 ms, behind a USB adapter twice 16 ms later; this leaves room.
pub const REPLY_WAIT: Duration = Duration::from_millis(60);
/// Wait for a reply from a network host, whose network may be slow.
const TCP_REPLY_WAIT: Duration = Duration::from_millis(500);
/// Time to open a serial CAN adapter.
const ADAPTER_TIME: Duration = Duration::from_millis(30);
/// Bytes of the read of one register byte and of its reply, in the longer of the two framings (manual 2.2, 2.4).
const EXCHANGE_BYTES: u64 = 18;
/// Bits of a byte on the line: start, eight, stop.
const BITS: u64 = 10;
/// Ports scanned concurrently. Each is a wire of its own; more would only load the USB bus.
pub const PORTS_AT_ONCE: usize = 8;
/// Addresses probed concurrently: well below the sockets that a process may have.
pub const HOSTS_AT_ONCE: usize = 64;

/// Protocol to probe behind a serial port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speaks {
    /// A hand, in the private framing and in Modbus RTU.
    Hand,
    /// A serial CAN adapter that speaks slcan.
    CanAdapter,
    /// The maker's own CAN adapter.
    MakersAdapter,
    /// Both: the adapter is tried first.
    Either,
}

/// One serial port to scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanPort {
    /// Path of the port, or its name on Windows.
    pub port: String,
    /// The USB device there, if it is one.
    pub usb: Option<UsbFound>,
    /// Protocols to try there.
    pub speaks: Speaks,
}

/// Places to scan.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ScanTargets {
    /// Serial ports.
    pub ports: Vec<ScanPort>,
    /// CAN interfaces.
    pub can: Vec<String>,
    /// Hosts.
    pub hosts: Vec<Hosts>,
}

/// The kind of a place, which limits how many are scanned concurrently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LaneKind {
    Port,
    Can,
    Host,
}

/// One probe, and the wait for its reply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Try {
    pub(crate) endpoint: Endpoint,
    pub(crate) limit: Duration,
    /// Time that it takes without a reply.
    pub(crate) cost: Duration,
}

/// All probes at one place, in sequence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lane {
    pub(crate) kind: LaneKind,
    /// Name for the user.
    pub(crate) place: String,
    pub(crate) usb: Option<UsbFound>,
    /// One address of a range: a missing device there is not reported.
    pub(crate) is_one_of_many: bool,
    pub(crate) tries: Vec<Try>,
}

/// All probes of a scan that gets no reply.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ScanPlan {
    pub(crate) lanes: Vec<Lane>,
    /// Places that this program's own link holds.
    pub(crate) held: Vec<String>,
}

impl ScanPlan {
    /// Plans a scan of these places and ids. `held` are the connected hands: the port of each is skipped, and so is its
    /// CAN interface, because its link would mistake our requests for those of another controller.
    pub fn new(places: &ScanTargets, ids: &[HandId], held: &[Endpoint]) -> Self {
        let mut plan = Self::default();
        for wish in &places.ports {
            plan.add(port_lane(wish, ids), held);
        }
        for interface in &places.can {
            plan.add(can_lane(interface, ids), held);
        }
        for hosts in &places.hosts {
            for host in hosts.iter() {
                plan.add(host_lane(host, hosts, ids), held);
            }
        }
        plan
    }

    fn add(&mut self, lane: Lane, held: &[Endpoint]) {
        if self.held.contains(&lane.place) {
            return;
        }
        // A place that is named twice is scanned once, with all its probes.
        if let Some(known) = self
            .lanes
            .iter_mut()
            .find(|known| known.place == lane.place)
        {
            for one in lane.tries {
                if !known.tries.contains(&one) {
                    known.tries.push(one);
                }
            }
            return;
        }
        let is_held = held.iter().any(|held| held.place() == lane.place);
        if is_held {
            self.held.push(lane.place)
        } else {
            self.lanes.push(lane)
        }
    }

    /// Maximum number of probes.
    pub fn tries(&self) -> usize {
        self.lanes.iter().map(|lane| lane.tries.len()).sum()
    }

    /// Number of places to scan.
    pub const fn places(&self) -> usize {
        self.lanes.len()
    }

    /// Time that the scan takes without a reply.
    pub fn estimate(&self) -> Duration {
        estimate(self.lanes.iter().map(|lane| (lane.kind, lane.cost())))
    }
}

impl Lane {
    /// Time that the lane takes without a reply.
    pub(crate) fn cost(&self) -> Duration {
        self.tries.iter().map(|one| one.cost).sum()
    }
}

/// Total time of lanes with these costs, those of one kind in parallel up to their limit.
pub(crate) fn estimate(lanes: impl Iterator<Item = (LaneKind, Duration)>) -> Duration {
    let (mut ports, mut hosts) = (Vec::new(), Vec::new());
    for (kind, cost) in lanes {
        match kind {
            LaneKind::Port | LaneKind::Can => ports.push(cost),
            LaneKind::Host => hosts.push(cost),
        }
    }
    beside(&ports, PORTS_AT_ONCE).max(beside(&hosts, HOSTS_AT_ONCE))
}

/// Total time if each starts as soon as a running one is done.
fn beside(costs: &[Duration], at_once: usize) -> Duration {
    let mut free_at = BinaryHeap::from(vec![Reverse(Duration::ZERO); at_once]);
    let mut end = Duration::ZERO;
    for cost in costs {
        let begun = free_at.pop().map_or(Duration::ZERO, |Reverse(at)| at);
        end = end.max(begun + *cost);
        free_at.push(Reverse(begun + *cost));
    }
    end
}

/// True if both use the same line and protocol, so that a hand that answers one shows that the other has the right settings.
pub(crate) fn same_line(one: &Endpoint, other: &Endpoint) -> bool {
    let line = one.with_bus_id(DEFAULT_ID);
    line.is_some() && line == other.with_bus_id(DEFAULT_ID)
}

/// The id that is probed first on every line, and all others: most hands have the default id.
fn first_and_rest(ids: &[HandId]) -> [&[HandId]; 2] {
    let (first, rest) = ids.split_at(ids.len().min(1));
    [first, rest]
}

fn port_lane(wish: &ScanPort, ids: &[HandId]) -> Lane {
    let mut tries = Vec::new();
    if wish.speaks == Speaks::MakersAdapter {
        tries.extend(ids.iter().map(|id| {
            bus_try(Endpoint::UsbCan {
                port: wish.port.clone(),
                baud: DEFAULT_BAUD,
                id: u16::from(id.get()),
            })
        }));
    }
    if matches!(wish.speaks, Speaks::CanAdapter | Speaks::Either) {
        for ids in first_and_rest(ids) {
            for bitrate in BITRATES {
                tries.extend(ids.iter().map(|id| adapter_try(&wish.port, bitrate, *id)));
            }
        }
    }
    if matches!(wish.speaks, Speaks::Hand | Speaks::Either) {
        for ids in first_and_rest(ids) {
            // By code, which is also the order of likelihood: the default first.
            for speed in SerialSpeed::ALL {
                for kind in [Endpoint::Rs485, Endpoint::Rtu] {
                    tries.extend(
                        ids.iter()
                            .map(|id| line_try(kind, &wish.port, speed.baud(), *id)),
                    );
                }
            }
        }
    }
    Lane {
        kind: LaneKind::Port,
        place: wish.port.clone(),
        usb: wish.usb.clone(),
        is_one_of_many: false,
        tries,
    }
}

fn can_lane(interface: &str, ids: &[HandId]) -> Lane {
    let tries = ids.iter().map(|id| {
        bus_try(Endpoint::Can {
            interface: interface.into(),
            id: u16::from(id.get()),
        })
    });
    Lane {
        kind: LaneKind::Can,
        place: interface.into(),
        usb: None,
        is_one_of_many: false,
        tries: tries.collect(),
    }
}

/// Modbus TCP first; at a single address then Modbus RTU over TCP, as a serial device server carries it.
fn host_lane(host: &str, hosts: &Hosts, ids: &[HandId]) -> Lane {
    let mut tries: Vec<Try> = UNITS
        .map(|unit| Try {
            endpoint: Endpoint::Tcp {
                packing: None,
                host: host.into(),
                port: hosts.port(),
                unit,
            },
            limit: TCP_REPLY_WAIT,
            // A host that does not accept the connection costs the connection time, and is not tried again.
            cost: CONNECT_DEADLINE / 2,
        })
        .into();
    let place = tries.first().map(|one| one.endpoint.place());
    let place = place.unwrap_or_default();
    if !hosts.is_range() {
        tries.extend(ids.iter().map(|id| Try {
            endpoint: Endpoint::RtuTcp(SerialLine {
                port: place.clone(),
                baud: DEFAULT_BAUD,
                id: id.get(),
                packing: None,
            }),
            limit: TCP_REPLY_WAIT,
            cost: TCP_REPLY_WAIT,
        }));
    }
    Lane {
        kind: LaneKind::Host,
        place,
        usb: None,
        is_one_of_many: hosts.is_range(),
        tries,
    }
}

fn line_try(kind: fn(SerialLine) -> Endpoint, port: &str, baud: u32, id: HandId) -> Try {
    let on_the_wire = EXCHANGE_BYTES * BITS * 1_000_000 / u64::from(baud);
    let limit = REPLY_WAIT + Duration::from_micros(on_the_wire);
    Try {
        endpoint: kind(SerialLine {
            packing: None,
            port: port.into(),
            baud,
            id: id.get(),
        }),
        limit,
        cost: limit,
    }
}

/// A probe on a bus that needs no setup.
const fn bus_try(endpoint: Endpoint) -> Try {
    Try {
        endpoint,
        limit: REPLY_WAIT,
        cost: REPLY_WAIT,
    }
}

fn adapter_try(port: &str, bitrate: u32, id: HandId) -> Try {
    Try {
        endpoint: Endpoint::Slcan {
            port: port.into(),
            bitrate,
            id: u16::from(id.get()),
        },
        limit: REPLY_WAIT,
        cost: ADAPTER_TIME + REPLY_WAIT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ids(last: usize) -> Vec<HandId> {
        HandId::all().take(last).collect()
    }

    fn port(name: &str, speaks: Speaks) -> ScanPort {
        ScanPort {
            port: name.into(),
            usb: None,
            speaks,
        }
    }

    fn ports(count: usize) -> ScanTargets {
        ScanTargets {
            ports: (0..count)
                .map(|nth| port(&format!("/dev/ttyUSB{nth}"), Speaks::Hand))
                .collect(),
            ..ScanTargets::default()
        }
    }

    fn hosts(text: &str) -> ScanTargets {
        ScanTargets {
            hosts: vec![text.parse().unwrap()],
            ..ScanTargets::default()
        }
    }

    fn spelled(lane: &Lane) -> Vec<String> {
        let tries = lane.tries.iter();
        tries.map(|one| one.endpoint.to_string()).collect()
    }

    #[test]
    fn a_port_is_asked_for_the_first_id_everywhere_before_the_others() {
        let plan = ScanPlan::new(&ports(1), &ids(3), &[]);
        let tries = spelled(&plan.lanes[0]);
        assert_eq!(tries.len(), 4 * 2 * 3);
        let start = [
            "rs485:/dev/ttyUSB0?baud=115200&id=1",
            "rtu:/dev/ttyUSB0?baud=115200&id=1",
            "rs485:/dev/ttyUSB0?baud=57600&id=1",
            "rtu:/dev/ttyUSB0?baud=57600&id=1",
            "rs485:/dev/ttyUSB0?baud=19200&id=1",
            "rtu:/dev/ttyUSB0?baud=19200&id=1",
            "rs485:/dev/ttyUSB0?baud=921600&id=1",
            "rtu:/dev/ttyUSB0?baud=921600&id=1",
            "rs485:/dev/ttyUSB0?baud=115200&id=2",
            "rs485:/dev/ttyUSB0?baud=115200&id=3",
            "rtu:/dev/ttyUSB0?baud=115200&id=2",
        ];
        assert_eq!(tries[..start.len()], start);
        let mut once = tries.clone();
        once.sort();
        once.dedup();
        assert_eq!(once.len(), tries.len(), "nothing is asked twice");
    }

    #[test]
    fn each_kind_of_place_is_asked_in_its_own_way() {
        let places = ScanTargets {
            ports: vec![
                port("COM3", Speaks::CanAdapter),
                port("COM4", Speaks::Either),
            ],
            can: vec!["can0".into()],
            hosts: vec!["127.0.0.1:6001".parse().unwrap()],
        };
        let plan = ScanPlan::new(&places, &ids(2), &[]);
        let kinds = |nth: usize| -> Vec<&str> {
            let mut kinds: Vec<_> = plan.lanes[nth]
                .tries
                .iter()
                .map(|one| one.endpoint.kind())
                .collect();
            kinds.dedup();
            kinds
        };
        assert_eq!(kinds(0), ["slcan"]);
        assert_eq!(kinds(1)[..3], ["slcan", "rs485", "rtu"]);
        assert_eq!(spelled(&plan.lanes[2]), ["can:can0?id=1", "can:can0?id=2"]);
        assert_eq!(
            spelled(&plan.lanes[3]),
            [
                "tcp:127.0.0.1:6001?unit=255",
                "tcp:127.0.0.1:6001?unit=1",
                "rtu+tcp:127.0.0.1:6001?baud=115200&id=1",
                "rtu+tcp:127.0.0.1:6001?baud=115200&id=2"
            ]
        );
        assert_eq!(plan.tries(), 4 + (4 + 16) + 2 + 4);
    }

    #[test]
    fn the_estimate_is_the_sum_of_a_ports_waits() {
        // 60 ms each, and 18 bytes of 10 bits at each speed: 1562, 3125, 9375 and 195 us.
        let on_the_wire = Duration::from_micros(1562 + 3125 + 9375 + 195);
        for count in [1, 10, 254] {
            let waits = Duration::from_millis(4 * 60) + on_the_wire;
            let whole = waits * 2 * u32::try_from(count).unwrap();
            let plan = ScanPlan::new(&ports(1), &ids(count), &[]);
            assert_eq!(plan.estimate(), whole, "{count} ids");
            // Ports are scanned in parallel, eight at a time.
            let eight = ScanPlan::new(&ports(PORTS_AT_ONCE), &ids(count), &[]);
            assert_eq!(eight.estimate(), whole);
            let nine = ScanPlan::new(&ports(PORTS_AT_ONCE + 1), &ids(count), &[]);
            assert_eq!(nine.estimate(), 2 * whole);
        }
    }

    #[test]
    fn addresses_take_one_call_each_sixty_four_at_a_time() {
        // A single address is also probed for Modbus RTU.
        let alone = ScanPlan::new(&hosts("127.0.0.1"), &ids(10), &[]);
        assert_eq!(alone.estimate(), CONNECT_DEADLINE + TCP_REPLY_WAIT * 10);
        for (range, calls) in [
            ("127.0.0.0/26", 1),
            ("127.0.0.0/25", 2),
            ("127.0.0.0/24", 4),
            ("127.0.0.0/22", 16),
        ] {
            let plan = ScanPlan::new(&hosts(range), &ids(10), &[]);
            assert_eq!(plan.estimate(), CONNECT_DEADLINE * calls, "{range}");
        }
        assert_eq!(ScanPlan::default().estimate(), Duration::ZERO);
    }

    #[test]
    fn no_address_is_planned_that_was_not_named() {
        let places = ScanTargets {
            can: vec!["can0".into()],
            ..ports(3)
        };
        let plan = ScanPlan::new(&places, &ids(254), &[]);
        let tcp = plan
            .lanes
            .iter()
            .flat_map(spelled)
            .filter(|one| one.starts_with("tcp:"));
        assert_eq!(tcp.count(), 0);
    }

    #[test]
    fn the_port_of_the_connected_hand_is_left_alone_and_none_is_looked_at_twice() {
        for (held, kept) in [
            ("rs485:/dev/ttyUSB0", vec!["/dev/ttyUSB1"]),
            ("slcan:/dev/ttyUSB1", vec!["/dev/ttyUSB0"]),
            ("rtu:/dev/ttyUSB7", vec!["/dev/ttyUSB0", "/dev/ttyUSB1"]),
            ("sim:", vec!["/dev/ttyUSB0", "/dev/ttyUSB1"]),
        ] {
            let mut places = ports(2);
            places.ports.extend(ports(2).ports);
            let plan = ScanPlan::new(&places, &ids(1), &[held.parse().unwrap()]);
            let left: Vec<_> = plan.lanes.iter().map(|lane| lane.place.as_str()).collect();
            assert_eq!(left, kept, "{held}");
            assert_eq!(plan.held.len(), 2 - kept.len());
        }
        let can = ScanTargets {
            can: vec!["can0".into(), "can1".into()],
            ..ScanTargets::default()
        };
        let plan = ScanPlan::new(&can, &ids(1), &["can:can1?id=9".parse().unwrap()]);
        assert_eq!((plan.places(), plan.held), (1, vec!["can1".to_owned()]));
        let held = "tcp:127.0.0.1:6000?unit=1".parse().unwrap();
        let plan = ScanPlan::new(&hosts("127.0.0.0/30"), &ids(1), &[held]);
        assert_eq!(plan.held, ["127.0.0.1:6000"]);
        assert_eq!(plan.places(), 1);
    }
}
