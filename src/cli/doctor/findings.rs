//! Findings about a hand or the connection to it, with advice, as text.

use crate::cli::doctor::checkup::{ConnectionFacts, Examination, LinkMeasurements};
use crate::link::{LinkStats, priority};
use crate::transport::can_facts::{CanFacts, QUEUE_LEN_USUAL};
use crate::transport::{PortFacts, Route};
use serde::Serialize;
use std::time::Duration;

/// Latency timer in milliseconds above which an adapter halves the rate.
const TIMER_MS: u16 = 2;
/// Limit of requests without a reply, per thousand: a single one may be due to a busy computer.
const TIMEOUTS_PER_MILLE: u64 = 10;
/// Limit of wrong checksums, per thousand (hazards: more than 1 in 1000 is a bad line).
const CHECKSUMS_PER_MILLE: u64 = 1;
/// Limit of noise bursts, per thousand.
const NOISE_PER_MILLE: u64 = 10;
/// Limit of unsolicited replies, per thousand: one in sixteen is a hand that doubles replies, not a second master.
const FOREIGN_PER_MILLE: u64 = 100;
/// Limit of refusals, per thousand.
const REFUSALS_PER_MILLE: u64 = 10;
/// Limit of readings with an impossible value, per thousand.
const IMPLAUSIBLE_PER_MILLE: u64 = 10;
/// Advice on another controller.
const OTHER_MASTER: &str = "close the other program, or take the other master off the bus";
/// A hand needs up to 15 ms and an adapter 16 more; beyond this limit, feedback is too old for control.
const SLOW: Duration = Duration::from_millis(60);

/// A longer stall of this computer invalidates the measurement of a close.
const STALL_HARMFUL: Duration = Duration::from_millis(50);
/// Number of short stalls in a check that has the same meaning.
const STALLS_MANY: u64 = 50;

#[derive(Serialize)]
pub(crate) struct Diagnosis {
    /// True for a problem, false for a note.
    #[serde(rename = "wrong")]
    pub(crate) is_wrong: bool,
    /// Description of the finding.
    pub(crate) what: String,
    /// Advice; empty if none.
    pub(crate) advice: String,
}

fn wrong(what: impl Into<String>, advice: impl Into<String>) -> Diagnosis {
    Diagnosis {
        is_wrong: true,
        what: what.into(),
        advice: advice.into(),
    }
}

fn hint(what: impl Into<String>, advice: impl Into<String>) -> Diagnosis {
    Diagnosis {
        is_wrong: false,
        ..wrong(what, advice)
    }
}

/// Findings about stalls of this computer.
fn stalls(measured: &LinkMeasurements, found: &mut Vec<Diagnosis>) {
    let stats = &measured.stats;
    if stats.longest_stall < STALL_HARMFUL && stats.stalls < STALLS_MANY {
        return;
    }
    let priority = if priority::is_raised() {
        ""
    } else {
        "; the system grants this program no priority: 'ulimit -e 30' or LimitNICE=-10 in its unit would let it have some"
    };
    found.push(hint(
        format!(
            "this computer was too busy to attend to the hand {} times, {} ms at the longest",
            stats.stalls,
            stats.longest_stall.as_millis()
        ),
        format!("close other programs while the hand moves{priority}"),
    ));
}

/// All findings, problems first.
pub(crate) fn judge(checkup: &Examination) -> Vec<Diagnosis> {
    let mut found = Vec::new();
    let endpoint = &checkup.endpoint;
    match &checkup.answer {
        // The text includes the advice.
        Err(why) => found.push(wrong(why, "")),
        Ok(measured) => {
            answers(checkup, measured, &mut found);
            stalls(measured, &mut found);
        }
    }
    let measured = checkup.answer.as_ref().ok();
    match &checkup.connection {
        ConnectionFacts::Port(facts) => port(&endpoint.place(), facts, measured, &mut found),
        ConnectionFacts::Net(way) => net(way.as_ref(), measured.is_some(), &mut found),
        ConnectionFacts::Can(facts) => can(&endpoint.place(), facts, &mut found),
        ConnectionFacts::BuiltIn => {}
    }
    found.sort_by_key(|finding| !finding.is_wrong);
    found
}

fn answers(checkup: &Examination, measured: &LinkMeasurements, found: &mut Vec<Diagnosis>) {
    if let Some(why) = &measured.lost {
        found.push(wrong(
            format!("the link was lost during the check: {why}"),
            "check plug, cable and the hand's power",
        ));
    }
    let id = checkup.endpoint.id_or_unit();
    counters(measured, id, found);
    if measured.status.other_controller && measured.stats.foreign_requests == 0 {
        found.push(wrong("another controller talks to this hand", OTHER_MASTER));
    }
    if let Some(ms) = measured.status.slow_ms {
        found.push(hint(
            format!("replies take up to {ms} ms: feedback and a stop lag as much"),
            "check the path to the hand: relays, tunnels, wireless; 'handscope help wiring' says what a delay means for moving the hand",
        ));
    }
    let slowest = measured
        .windows
        .iter()
        .filter_map(|window| window.percentile(50));
    // A connection that is known to be slow has been reported already.
    let is_named = measured.status.slow_ms.is_some();
    if let Some(trip) = slowest.max().filter(|trip| *trip > SLOW && !is_named) {
        found.push(wrong(
            format!("a reply takes {} ms", trip.as_millis()),
            "choose a higher baud rate, or check the latency of adapter and network",
        ));
    }
    if measured.status.echoes {
        found.push(hint(
            "the adapter echoes what is sent; the echo is ignored",
            "nothing to do; switching the echo off would free the line",
        ));
    }
}

/// Judges every counter of the link. All fields are listed, so that a new one does not compile without a judgement.
fn counters(measured: &LinkMeasurements, id: u16, found: &mut Vec<Diagnosis>) {
    let LinkStats {
        timeouts,
        checksum_errors,
        resyncs,
        foreign_replies,
        late_replies,
        foreign_requests,
        refusals,
        readings,
        implausible,
        reconnects,
        writes,
        dropped_events,
        // Judged separately: they concern this computer.
        stalls: _,
        stalled: _,
        longest_stall: _,
        // Not errors, or judged as round trips.
        state_reads: _,
        tactile_reads: _,
        state_hz: _,
        tactile_hz: _,
        rtt_p50: _,
        rtt_p99: _,
        line: _,
    } = measured.stats;
    let requests = measured.requests().max(1);
    let is_over = |count: u64, per_mille: u64| count * 1000 / requests > per_mille;
    let mut judge = |is_found: bool, finding: Diagnosis| {
        if is_found {
            found.push(finding);
        }
    };
    judge(
        is_over(timeouts, TIMEOUTS_PER_MILLE),
        wrong(
            format!("{timeouts} of {requests} requests went without a reply"),
            "check the cable, the termination, and whether two devices share an id",
        ),
    );
    judge(
        is_over(checksum_errors, CHECKSUMS_PER_MILLE),
        wrong(
            format!("{checksum_errors} replies had a wrong checksum"),
            "check termination, ground and cable length; on RS485, Modbus RTU has a better check than the maker's framing",
        ),
    );
    judge(
        is_over(resyncs, NOISE_PER_MILLE),
        wrong(
            format!("bytes that belong to no frame came {resyncs} times in {requests} requests"),
            "check termination and ground, and that nothing else talks on this line",
        ),
    );
    judge(
        is_over(foreign_replies, FOREIGN_PER_MILLE),
        two_devices(id, foreign_replies, requests),
    );
    judge(
        is_over(late_replies, TIMEOUTS_PER_MILLE),
        hint(
            format!("{late_replies} replies came after they had been given up"),
            "check the path to the hand: relays, tunnels, wireless",
        ),
    );
    judge(
        foreign_requests > 0,
        wrong(
            format!("another controller talks to this hand ({foreign_requests} times noticed)"),
            OTHER_MASTER,
        ),
    );
    judge(
        is_over(refusals, REFUSALS_PER_MILLE),
        refused(measured, refusals, requests),
    );
    judge(
        implausible * 1000 > readings * IMPLAUSIBLE_PER_MILLE,
        wrong(
            format!("{implausible} of {readings} readings hold values that no hand should send"),
            "check cable and ground, and that this is a hand of this series: 'handscope watch --json' shows the values",
        ),
    );
    judge(
        reconnects > 0,
        wrong(
            format!("the link was lost and came back {reconnects} times"),
            "check plug, cable and the hand's power",
        ),
    );
    judge(
        writes > 0 || dropped_events > 0,
        hint(
            format!(
                "{writes} writes were sent and {dropped_events} records dropped, which this check never does"
            ),
            "please report this as a bug",
        ),
    );
}

fn two_devices(id: u16, replies: u64, requests: u64) -> Diagnosis {
    wrong(
        format!(
            "two devices answer as id {id}: {replies} unsolicited replies came to {requests} requests"
        ),
        "take one of the two off the line and give it another id; if there is only one, it or its adapter sends replies twice or too late",
    )
}

fn refused(measured: &LinkMeasurements, refusals: u64, requests: u64) -> Diagnosis {
    let blocks = whole_blocks(measured);
    wrong(
        format!("{refusals} of {requests} requests were refused{blocks}"),
        "a gateway that refuses occasionally loses frames on the hand's side: check that cable; a hand that always refuses the same registers does not have them",
    )
}

/// Names the blocks that were refused every time.
fn whole_blocks(measured: &LinkMeasurements) -> String {
    let refused = measured.windows.iter();
    let names: Vec<&str> = refused
        .filter(|window| window.refused > 0 && window.reads == 0)
        .map(|window| window.name)
        .collect();
    match names.as_slice() {
        [] => String::new(),
        names => format!(", always those for {}", names.join(" and ")),
    }
}

fn port(
    port: &str,
    facts: &PortFacts,
    measured: Option<&LinkMeasurements>,
    found: &mut Vec<Diagnosis>,
) {
    // The error of a port that could not be opened for this reason names the holder already.
    if let Some(holder) = facts.holder.as_ref().filter(|_| measured.is_some()) {
        found.push(wrong(
            format!("{port} is also open in {holder}"),
            "close that program: two programs mix up each other's replies",
        ));
    }
    let timer = facts.usb.as_ref().and_then(|usb| usb.latency_timer_ms);
    match timer {
        Some(ms) if ms > TIMER_MS => found.push(wrong(
            format!("the USB adapter holds replies back for up to {ms} ms (latency timer)"),
            timer_advice(facts, port),
        )),
        // The driver reports a short timer, so the hand itself causes the delay.
        Some(_) => {}
        None if measured.is_some_and(|measured| measured.ticks_seen) => found.push(wrong(
            "replies come every 16 ms, as from a USB adapter with a latency timer of 16 ms",
            timer_advice(facts, port),
        )),
        None => {}
    }
}

/// Command that sets the latency timer.
fn timer_advice(facts: &PortFacts, port: &str) -> String {
    let device = facts.device.as_deref().unwrap_or(port);
    let name = device.rsplit('/').next().unwrap_or(device);
    if cfg!(windows) {
        return format!(
            "in the Device Manager, open {name}, Port Settings, Advanced, and set the latency timer to 1 ms"
        );
    }
    format!("run 'echo 1 | sudo tee /sys/bus/usb-serial/devices/{name}/latency_timer'")
}

fn net(way: Option<&Route>, is_answered: bool, found: &mut Vec<Diagnosis>) {
    let Some(way) = way.filter(|way| way.is_direct() == Some(false)) else {
        return;
    };
    let interface = way.interface.as_deref().unwrap_or("the interface");
    let what = format!(
        "{} is not in the network of {} ({interface}): it is behind a router, or out of reach",
        way.to, way.from
    );
    let advice = format!(
        "give this computer an address in the hand's network, for example 'sudo ip addr add {} dev {interface}'",
        neighbour(way)
    );
    if is_answered {
        found.push(hint(what, ""))
    } else {
        found.push(wrong(what, advice))
    }
}

/// An address in the hand's own /24 network that is most likely free.
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

fn can(interface: &str, facts: &CanFacts, found: &mut Vec<Diagnosis>) {
    let is_well = |state: &&str| matches!(*state, "ERROR-ACTIVE" | "STOPPED");
    if let Some(state) = facts.state.as_deref().filter(|state| !is_well(state)) {
        found.push(wrong(
            format!("the controller of {interface} is {state}"),
            "check bit rate, cable, and termination at both ends",
        ));
    }
    let is_usual = |rate: &u64| matches!(*rate, 1_000_000 | 500_000);
    if let Some(rate) = facts.bitrate.filter(|rate| !is_usual(rate)) {
        found.push(hint(
            format!("{interface} runs at {rate} bit/s; hands are delivered with 1000000"),
            format!("run 'sudo ip link set {interface} down', then 'sudo ip link set {interface} up type can bitrate 1000000'"),
        ));
    }
    let queue_len = facts.queue_len.filter(|_| facts.is_up == Some(true));
    if let Some(len) = queue_len.filter(|len| *len <= QUEUE_LEN_USUAL) {
        found.push(hint(
            format!("{interface} queues only {len} frames"),
            format!("if frames are refused, run 'sudo ip link set {interface} txqueuelen 100'"),
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::doctor::checkup::BlockTiming;
    use crate::hand::Span;
    use crate::link::LinkStatus;
    use crate::transport::Endpoint;
    use crate::transport::UsbFound;

    fn healthy(endpoint: &Endpoint) -> LinkMeasurements {
        let mut window = BlockTiming::new("angles", Span::new(1546, 12), endpoint);
        for _ in 0..1000 {
            window.add(Duration::from_millis(6));
        }
        LinkMeasurements {
            answered_after: Duration::from_millis(9),
            status: LinkStatus::default(),
            stats: LinkStats::default(),
            windows: vec![window],
            ticks_seen: false,
            lost: None,
        }
    }

    fn findings(
        place: ConnectionFacts,
        change: impl Fn(&mut LinkMeasurements),
    ) -> Vec<(bool, String)> {
        let endpoint: Endpoint = "rs485:/dev/ttyT0".parse().unwrap();
        let mut measured = healthy(&endpoint);
        change(&mut measured);
        let checkup = Examination {
            endpoint,
            connection: place,
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

    fn usb(latency_timer_ms: Option<u16>) -> ConnectionFacts {
        ConnectionFacts::Port(PortFacts {
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
        assert_eq!(findings(ConnectionFacts::BuiltIn, |_| ()), []);
        assert_eq!(findings(usb(Some(1)), |_| ()), []);
        // A few of a thousand are this computer being busy.
        assert_eq!(
            findings(usb(None), |measured| measured.stats.timeouts = 3),
            []
        );
    }

    #[test]
    fn each_trouble_has_its_own_words_and_advice() {
        type Change = fn(&mut LinkMeasurements);
        let cases: [(ConnectionFacts, Change, bool, &str); 10] = [
            (
                ConnectionFacts::BuiltIn,
                |measured| measured.stats.longest_stall = Duration::from_millis(90),
                false,
                "90 ms at the longest",
            ),
            (usb(Some(16)), |_| (), true, "/ttyT0/latency_timer"),
            (
                usb(None),
                |measured| measured.ticks_seen = true,
                true,
                "/ttyT0/latency_timer",
            ),
            (
                ConnectionFacts::BuiltIn,
                |measured| measured.stats.timeouts = 20,
                true,
                "without a reply",
            ),
            (
                ConnectionFacts::BuiltIn,
                |measured| measured.stats.checksum_errors = 5,
                true,
                "termination",
            ),
            (
                ConnectionFacts::BuiltIn,
                |measured| measured.status.other_controller = true,
                true,
                "another controller",
            ),
            (
                ConnectionFacts::BuiltIn,
                |measured| measured.status.echoes = true,
                false,
                "echoes",
            ),
            (
                ConnectionFacts::BuiltIn,
                |measured| measured.lost = Some("gone".into()),
                true,
                "gone",
            ),
            (
                ConnectionFacts::Port(PortFacts {
                    holder: Some("minicom (process 7)".into()),
                    ..PortFacts::default()
                }),
                |_| (),
                true,
                "minicom (process 7)",
            ),
            (
                ConnectionFacts::Net(Some(Route {
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
            let found = findings(place, change);
            let [(wrong, words)] = found.as_slice() else {
                unreachable!("{part}: {found:?}");
            };
            assert_eq!(*wrong, is_wrong, "{words}");
            assert!(words.contains(part), "{words}");
        }
    }

    #[test]
    fn every_count_that_is_large_has_a_verdict() {
        type Count = fn(&mut LinkStats) -> &mut u64;
        // Named one by one: a count that is not here does not compile.
        let LinkStats {
            state_reads: _,
            tactile_reads: _,
            state_hz: _,
            tactile_hz: _,
            rtt_p50: _,
            rtt_p99: _,
            timeouts: _,
            checksum_errors: _,
            resyncs: _,
            foreign_replies: _,
            late_replies: _,
            foreign_requests: _,
            refusals: _,
            readings: _,
            implausible: _,
            reconnects: _,
            writes: _,
            dropped_events: _,
            stalls: _,
            stalled: _,
            longest_stall: _,
            line: _,
        } = LinkStats::default();
        let counts: [(Count, bool, &str); 12] = [
            (|stats| &mut stats.stalls, false, "too busy"),
            (|stats| &mut stats.timeouts, true, "without a reply"),
            (|stats| &mut stats.checksum_errors, true, "wrong checksum"),
            (|stats| &mut stats.resyncs, true, "no frame"),
            (
                |stats| &mut stats.foreign_replies,
                true,
                "two devices answer as id 1",
            ),
            (|stats| &mut stats.late_replies, false, "given up"),
            (
                |stats| &mut stats.foreign_requests,
                true,
                "another controller",
            ),
            (|stats| &mut stats.refusals, true, "were refused"),
            (|stats| &mut stats.implausible, true, "no hand should send"),
            (|stats| &mut stats.reconnects, true, "came back"),
            (|stats| &mut stats.writes, false, "writes were sent"),
            (|stats| &mut stats.dropped_events, false, "dropped"),
        ];
        for (count, is_wrong, part) in counts {
            let found = findings(ConnectionFacts::BuiltIn, |measured| {
                measured.stats.readings = 1000;
                *count(&mut measured.stats) = 564;
            });
            let [(wrong, words)] = found.as_slice() else {
                unreachable!("{part}: {found:?}");
            };
            assert_eq!((*wrong, words.contains(part)), (is_wrong, true), "{words}");
        }
    }

    #[test]
    fn a_few_of_a_thousand_are_no_finding() {
        let found = findings(ConnectionFacts::BuiltIn, |measured| {
            measured.stats = LinkStats {
                timeouts: 3,
                resyncs: 3,
                foreign_replies: 60,
                late_replies: 3,
                refusals: 3,
                readings: 1000,
                implausible: 3,
                ..LinkStats::default()
            };
        });
        assert_eq!(found, []);
    }

    #[test]
    fn a_timer_that_the_driver_calls_short_is_not_suspected() {
        assert_eq!(
            findings(usb(Some(1)), |measured| measured.ticks_seen = true),
            []
        );
    }

    #[test]
    fn an_unreachable_network_is_wrong_and_the_address_to_take_is_named() {
        let place = ConnectionFacts::Net(Some(Route {
            to: "192.168.11.210".parse().unwrap(),
            from: "10.0.0.7".parse().unwrap(),
            interface: Some("eth0".into()),
            prefix: Some(24),
        }));
        let checkup = Examination {
            endpoint: "tcp:192.168.11.210".parse().unwrap(),
            connection: place,
            answer: Err("nothing came".into()),
        };
        let found = judge(&checkup);
        assert_eq!(found.len(), 2);
        let advice: String = found.iter().map(|finding| finding.advice.clone()).collect();
        assert!(advice.contains("192.168.11.100/24 dev eth0"), "{advice}");
    }
}
