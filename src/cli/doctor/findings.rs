//! What is wrong with a hand or the way to it, and what to do, in words. Measures and prints nothing.

use crate::cli::doctor::checkup::{Checkup, Measured, Place};
use crate::transport::{Endpoint, PortFacts, Route};
use std::time::Duration;

/// Adapters that may keep what they got for longer than this halve the rate.
const TIMER_MS: u16 = 2;
/// Requests without reply that are too many, of a thousand: one is this computer being busy.
const TIMEOUTS_PER_MILLE: u64 = 10;
/// Wrong checksums that are too many, of a thousand (hazards: more than 1 in 1000 is a bad line).
const CHECKSUMS_PER_MILLE: u64 = 1;
/// A hand takes up to 15 ms, an adapter 16 more; beyond that feedback is too old to steer by.
const SLOW: Duration = Duration::from_millis(60);

/// One thing that a person should know.
pub(crate) struct Finding {
    /// True if it should not be so; false if it is only good to know.
    pub(crate) is_wrong: bool,
    /// What was found.
    pub(crate) what: String,
    /// What to do; empty if nothing is to be done.
    pub(crate) advice: String,
}

fn wrong(what: impl Into<String>, advice: impl Into<String>) -> Finding {
    Finding {
        is_wrong: true,
        what: what.into(),
        advice: advice.into(),
    }
}

fn hint(what: impl Into<String>, advice: impl Into<String>) -> Finding {
    Finding {
        is_wrong: false,
        ..wrong(what, advice)
    }
}

/// All findings, the worst first.
pub(crate) fn judge(checkup: &Checkup) -> Vec<Finding> {
    let mut found = Vec::new();
    match &checkup.answer {
        // The sentence says itself what to do.
        Err(why) => found.push(wrong(why, "")),
        Ok(measured) => answers(measured, &mut found),
    }
    match &checkup.place {
        Place::Port(facts) => port(
            &checkup.endpoint,
            facts,
            checkup.answer.as_ref().ok(),
            &mut found,
        ),
        Place::Net(way) => net(way.as_ref(), checkup.answer.is_ok(), &mut found),
        #[cfg(target_os = "linux")]
        Place::Can(facts) => can(&checkup.endpoint.place(), facts, &mut found),
        #[cfg(not(target_os = "linux"))]
        Place::NoCan => {}
        Place::BuiltIn => {}
    }
    found.sort_by_key(|finding| !finding.is_wrong);
    found
}

fn answers(measured: &Measured, found: &mut Vec<Finding>) {
    if let Some(why) = &measured.lost {
        found.push(wrong(
            format!("the link was lost while it was looked at: {why}"),
            "check plug, cable and the hand's power",
        ));
    }
    let requests = measured.requests().max(1);
    let per_mille = |count: u64| count * 1000 / requests;
    let stats = &measured.stats;
    if per_mille(stats.timeouts) > TIMEOUTS_PER_MILLE {
        found.push(wrong(
            format!(
                "{} of {requests} requests stayed without a reply",
                stats.timeouts
            ),
            "check cable, termination and whether two devices have one id",
        ));
    }
    if per_mille(stats.checksum_errors) > CHECKSUMS_PER_MILLE {
        found.push(wrong(
            format!("{} replies had a wrong checksum", stats.checksum_errors),
            "check termination, ground and cable length; over RS485 Modbus RTU is checked better than the maker's framing",
        ));
    }
    if measured.status.rival || stats.foreign_requests > 0 {
        found.push(wrong(
            format!(
                "another controller talks to this hand ({} times noticed)",
                stats.foreign_requests
            ),
            "close the other program or take the other master off the bus",
        ));
    }
    let slowest = measured
        .windows
        .iter()
        .filter_map(|window| window.percentile(50));
    if let Some(trip) = slowest.max().filter(|trip| *trip > SLOW) {
        found.push(wrong(
            format!("a reply takes {} ms", trip.as_millis()),
            "choose a higher baud, or look at the latency of adapter and network",
        ));
    }
    if measured.status.echoes {
        found.push(hint(
            "the adapter echoes: what is sent comes back, and is left out",
            "nothing has to be done; switching the echo off frees the line",
        ));
    }
}

fn port(
    endpoint: &Endpoint,
    facts: &PortFacts,
    measured: Option<&Measured>,
    found: &mut Vec<Finding>,
) {
    let port = endpoint.place();
    // A port that could not be opened because of it has been told of with this name already.
    if let Some(holder) = facts.holder.as_ref().filter(|_| measured.is_some()) {
        found.push(wrong(
            format!("{port} is also open in {holder}"),
            "close that program: two of them mix up their replies",
        ));
    }
    let timer = facts.usb.as_ref().and_then(|usb| usb.latency_timer_ms);
    match timer {
        Some(ms) if ms > TIMER_MS => found.push(wrong(
            format!("the USB adapter keeps replies back for up to {ms} ms (latency timer)"),
            timer_advice(facts, &port),
        )),
        // The driver says that the timer is short: then it is the hand that takes so long.
        Some(_) => {}
        None if measured.is_some_and(|measured| measured.ticks_seen) => found.push(wrong(
            "replies come every 16 ms, as from a USB adapter with a latency timer of 16 ms",
            timer_advice(facts, &port),
        )),
        None => {}
    }
}

/// The one line that cures it.
fn timer_advice(facts: &PortFacts, port: &str) -> String {
    let device = facts.device.as_deref().unwrap_or(port);
    let name = device.rsplit('/').next().unwrap_or(device);
    if cfg!(windows) {
        return format!(
            "in the Device Manager open {name}, Port Settings, Advanced, and set the latency timer to 1 ms"
        );
    }
    format!("run 'echo 1 | sudo tee /sys/bus/usb-serial/devices/{name}/latency_timer'")
}

fn net(way: Option<&Route>, is_answered: bool, found: &mut Vec<Finding>) {
    let Some(way) = way.filter(|way| way.is_direct() == Some(false)) else {
        return;
    };
    let interface = way.interface.as_deref().unwrap_or("the interface");
    let what = format!(
        "{} is not in the network of {} ({interface}): a router stands between, or nothing",
        way.to, way.from
    );
    let advice = format!(
        "give this computer an address beside the hand's, for example 'sudo ip addr add {} dev {interface}'",
        neighbour(way)
    );
    found.push(if is_answered {
        hint(what, "")
    } else {
        wrong(what, advice)
    });
}

/// An address in the hand's own network of 256 that is most likely free.
fn neighbour(way: &Route) -> String {
    match way.to {
        std::net::IpAddr::V4(to) => {
            let [a, b, c, last] = to.octets();
            let own = if last == 100 { 101 } else { 100 };
            format!("{a}.{b}.{c}.{own}/24")
        }
        std::net::IpAddr::V6(to) => format!("{to}/64"),
    }
}

#[cfg(target_os = "linux")]
fn can(interface: &str, facts: &crate::transport::can_facts::CanFacts, found: &mut Vec<Finding>) {
    use crate::transport::can_facts::QUEUE_LEN_USUAL;
    if let Some(state) = facts
        .state
        .as_deref()
        .filter(|state| *state != "ERROR-ACTIVE" && *state != "STOPPED")
    {
        found.push(wrong(
            format!("the controller of {interface} is {state}"),
            "check bit rate, cable and termination at both ends",
        ));
    }
    if facts
        .bitrate
        .is_some_and(|rate| rate != 1_000_000 && rate != 500_000)
    {
        found.push(hint(
            format!("{interface} runs at {} bit/s, where hands run at 1000000 as delivered", facts.bitrate.unwrap_or_default()),
            format!("run 'sudo ip link set {interface} down', then 'sudo ip link set {interface} up type can bitrate 1000000'"),
        ));
    }
    if facts.is_up == Some(true) && facts.queue_len.is_some_and(|len| len <= QUEUE_LEN_USUAL) {
        found.push(hint(
            format!(
                "{interface} lets {} frames wait",
                facts.queue_len.unwrap_or_default()
            ),
            format!("where frames are refused, run 'sudo ip link set {interface} txqueuelen 100'"),
        ));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::cli::doctor::checkup::Window;
    use crate::hand::Span;
    use crate::link::{LinkStats, LinkStatus};
    use crate::transport::UsbFound;

    fn healthy(endpoint: &Endpoint) -> Measured {
        let mut window = Window::new("angles", Span::new(1546, 12), endpoint);
        for _ in 0..1000 {
            window.took(Duration::from_millis(6));
        }
        Measured {
            answered_after: Duration::from_millis(9),
            status: LinkStatus::default(),
            stats: LinkStats::default(),
            windows: vec![window],
            ticks_seen: false,
            lost: None,
        }
    }

    fn told(place: Place, change: impl Fn(&mut Measured)) -> Vec<(bool, String)> {
        let endpoint: Endpoint = "rs485:/dev/ttyT0".parse().unwrap();
        let mut measured = healthy(&endpoint);
        change(&mut measured);
        let checkup = Checkup {
            endpoint,
            place,
            answer: Ok(measured),
        };
        let found = judge(&checkup);
        found
            .into_iter()
            .map(|finding| {
                (
                    finding.is_wrong,
                    format!("{}: {}", finding.what, finding.advice),
                )
            })
            .collect()
    }

    fn usb(latency_timer_ms: Option<u16>) -> Place {
        Place::Port(PortFacts {
            device: Some("/dev/ttyT0".into()),
            usb: Some(UsbFound {
                latency_timer_ms,
                ..UsbFound::default()
            }),
            ..PortFacts::default()
        })
    }

    #[test]
    fn a_healthy_hand_has_no_findings() {
        assert_eq!(told(Place::BuiltIn, |_| ()), []);
        assert_eq!(told(usb(Some(1)), |_| ()), []);
        // A few of a thousand are this computer being busy.
        assert_eq!(told(usb(None), |measured| measured.stats.timeouts = 3), []);
    }

    #[test]
    fn each_trouble_has_its_own_words_and_advice() {
        type Change = fn(&mut Measured);
        let cases: [(Place, Change, bool, &str); 9] = [
            (usb(Some(16)), |_| (), true, "/ttyT0/latency_timer"),
            (
                usb(None),
                |measured| measured.ticks_seen = true,
                true,
                "/ttyT0/latency_timer",
            ),
            (
                Place::BuiltIn,
                |measured| measured.stats.timeouts = 20,
                true,
                "without a reply",
            ),
            (
                Place::BuiltIn,
                |measured| measured.stats.checksum_errors = 5,
                true,
                "termination",
            ),
            (
                Place::BuiltIn,
                |measured| measured.status.rival = true,
                true,
                "another controller",
            ),
            (
                Place::BuiltIn,
                |measured| measured.status.echoes = true,
                false,
                "echoes",
            ),
            (
                Place::BuiltIn,
                |measured| measured.lost = Some("gone".into()),
                true,
                "gone",
            ),
            (
                Place::Port(PortFacts {
                    holder: Some("minicom (process 7)".into()),
                    ..PortFacts::default()
                }),
                |_| (),
                true,
                "minicom (process 7)",
            ),
            (
                Place::Net(Some(Route {
                    to: "192.168.11.210".parse().unwrap(),
                    from: "10.0.0.7".parse().unwrap(),
                    interface: Some("eth0".into()),
                    prefix: Some(24),
                })),
                |_| (),
                false,
                "not in the network of 10.0.0.7",
            ),
        ];
        for (place, change, is_wrong, part) in cases {
            let found = told(place, change);
            let [(wrong, words)] = found.as_slice() else {
                unreachable!("{part}: {found:?}");
            };
            assert_eq!(*wrong, is_wrong, "{words}");
            assert!(words.contains(part), "{words}");
        }
    }

    #[test]
    fn a_timer_that_the_driver_calls_short_is_not_suspected() {
        assert_eq!(
            told(usb(Some(1)), |measured| measured.ticks_seen = true),
            []
        );
    }

    #[test]
    fn an_unreachable_network_is_wrong_and_the_address_to_take_is_named() {
        let place = Place::Net(Some(Route {
            to: "192.168.11.210".parse().unwrap(),
            from: "10.0.0.7".parse().unwrap(),
            interface: Some("eth0".into()),
            prefix: Some(24),
        }));
        let checkup = Checkup {
            endpoint: "tcp:192.168.11.210".parse().unwrap(),
            place,
            answer: Err("nothing came".into()),
        };
        let found = judge(&checkup);
        assert_eq!(found.len(), 2);
        let advice: String = found.iter().map(|finding| finding.advice.clone()).collect();
        assert!(advice.contains("192.168.11.100/24 dev eth0"), "{advice}");
    }
}
