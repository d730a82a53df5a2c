//! A check-up as lines of text.

use crate::cli::doctor::checkup::{BlockTiming, ConnectionFacts, Examination, LinkMeasurements};
use crate::cli::doctor::findings::Diagnosis;
use crate::transport::can_facts::CanFacts;
use crate::transport::{PortFacts, Route, UsbFound};
use std::fmt::Display;
use std::time::Duration;

/// The complete text.
pub(crate) fn lines(checkup: &Examination, found: &[Diagnosis]) -> Vec<String> {
    let mut lines = vec![row("hand", checkup.endpoint.to_string())];
    lines.extend(connection(&checkup.connection));
    match &checkup.answer {
        Ok(measured) => lines.extend(answer(measured)),
        Err(_) => lines.push(row("answer", "none")),
    }
    lines.push(String::new());
    for finding in found {
        let caption = if finding.is_wrong { "WRONG" } else { "note" };
        lines.push(row(caption, &finding.what));
        if !finding.advice.is_empty() {
            lines.push(row("", &finding.advice));
        }
    }
    if found.iter().all(|finding| !finding.is_wrong) {
        lines.push(row("verdict", "all is well"));
    }
    lines
}

fn row(caption: &str, value: impl AsRef<str>) -> String {
    format!("{caption:<12}{}", value.as_ref())
}

/// A row whose value may be unknown.
fn known(caption: &str, value: Option<impl Display>, unknown: &str) -> String {
    row(
        caption,
        value.map_or(unknown.into(), |value| value.to_string()),
    )
}

fn connection(facts: &ConnectionFacts) -> Vec<String> {
    match facts {
        ConnectionFacts::BuiltIn => vec![row(
            "place",
            "built into this program, over a wire in memory",
        )],
        ConnectionFacts::Port(facts) => port(facts),
        ConnectionFacts::Net(way) => {
            let none = "none: this computer has no route to it";
            vec![known("route", way.as_ref().map(route), none)]
        }
        ConnectionFacts::Can(facts) => can(facts),
    }
}

fn port(facts: &PortFacts) -> Vec<String> {
    let usb = facts.usb.as_ref();
    let timer = usb.and_then(|usb| usb.latency_timer_ms);
    let no_adapter = "not on USB, or not listed by the system";
    vec![
        known("device", facts.device.as_ref(), "-"),
        known("adapter", usb.map(adapter), no_adapter),
        known("driver", facts.driver.as_ref(), "-"),
        known("rights", facts.rights.as_ref(), "-"),
        known("held by", facts.holder.as_ref(), "no other program seen"),
        known(
            "latency",
            timer.map(|ms| format!("{ms} ms")),
            "no timer known",
        ),
    ]
}

fn adapter(usb: &UsbFound) -> String {
    let location = usb.location.as_ref();
    let location = location.map(|location| format!(" at {location}"));
    format!("{usb}{}", location.unwrap_or_default())
}

fn route(way: &Route) -> String {
    let interface = way.interface.as_deref().unwrap_or("an unknown interface");
    let prefix = way.prefix.map(|bits| format!("/{bits}"));
    let prefix = prefix.unwrap_or_default();
    let words = match way.is_direct() {
        Some(true) => ", in the same network",
        Some(false) => ", in another network",
        None => "",
    };
    let (from, to) = (way.from, way.to);
    format!("from {from}{prefix} on {interface} to {to}{words}")
}

fn can(facts: &CanFacts) -> Vec<String> {
    if !facts.exists {
        return vec![row("interface", "missing")];
    }
    let is = match (facts.is_can, facts.is_up) {
        (Some(false), _) => "not a CAN interface",
        (_, Some(false)) => "down",
        (_, Some(true)) => "up",
        (_, None) => "-",
    };
    let rate = facts.bitrate.map(|rate| format!("{rate} bit/s"));
    let queue = facts.queue_len.map(|len| format!("{len} frames"));
    vec![
        row("interface", is),
        known("bit rate", rate, "-"),
        known("controller", facts.state.as_ref(), "-"),
        known("queue", queue, "-"),
    ]
}

fn answer(measured: &LinkMeasurements) -> Vec<String> {
    let status = &measured.status;
    let after = millis(measured.answered_after);
    let mut lines = vec![row("answer", format!("after {after} ms"))];
    lines.extend(status.moved_to.as_ref().map(|port| row("now at", port)));
    let (echo, others) = (status.echoes, status.other_controller);
    lines.extend([
        row("echo", if echo { "yes, ignored" } else { "none" }),
        row("others", if others { "another controller" } else { "none" }),
        row("errors", errors(measured)),
    ]);
    let slow = status
        .slow_ms
        .map(|ms| format!("replies take up to {ms} ms"));
    lines.extend(slow.map(|slow| row("delay", slow)));
    lines.extend([
        String::new(),
        format!(
            "{:<17}{:>5}{:>8}{:>8}{:>8}{:>8}{:>8}{:>16}{:>16}",
            "round trips, ms",
            "bytes",
            "reads",
            "min",
            "50 %",
            "99 %",
            "max",
            "reads a second",
            "the line alone"
        ),
    ]);
    lines.extend(measured.windows.iter().map(trips));
    lines
}

fn errors(measured: &LinkMeasurements) -> String {
    let stats = &measured.stats;
    format!(
        "of {} requests: {} without a reply, {} wrong checksums, {} bursts of noise, {} foreign replies, {} late replies, {} foreign requests, {} refused, {} of {} readings implausible, {} reconnects",
        measured.requests(),
        stats.timeouts,
        stats.checksum_errors,
        stats.resyncs,
        stats.foreign_replies,
        stats.late_replies,
        stats.foreign_requests,
        stats.refusals,
        stats.implausible,
        stats.readings,
        stats.reconnects
    )
}

fn trips(window: &BlockTiming) -> String {
    let at = |percent| {
        let trip = window.percentile(percent);
        trip.map_or_else(|| "-".into(), millis)
    };
    let hz = |value: Option<f64>| value.map_or_else(|| "-".into(), |hz| format!("{hz:.1}"));
    format!(
        "{:<17}{:>5}{:>8}{:>8}{:>8}{:>8}{:>8}{:>16}{:>16}",
        window.name,
        window.span.len,
        window.reads,
        at(0),
        at(50),
        at(99),
        at(100),
        hz(window.hz()),
        hz(window.line_hz())
    )
}

fn millis(value: Duration) -> String {
    format!("{:.2}", value.as_secs_f64() * 1000.0)
}
