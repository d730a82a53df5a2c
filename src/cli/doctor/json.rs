//! A check-up as one JSON object; a contract with scripts, documented in `assets/manual/json.md`.

use crate::cli::doctor::checkup::{
    BlockTiming, ConnectionFacts, EDGES_MS, Examination, LinkMeasurements,
};
use crate::cli::doctor::findings::Diagnosis;
use crate::cli::watch::telemetry::stalls_json;
use crate::link::priority;
use serde::Serialize;
use serde_json::{Value, json};
use std::time::Duration;

/// The complete object. Unknown values are null.
pub(crate) fn object(checkup: &Examination, found: &[Diagnosis]) -> Value {
    let measured = checkup.answer.as_ref().ok();
    let (mut port, mut network, mut can) = (None, None, None);
    match &checkup.connection {
        ConnectionFacts::Port(facts) => {
            let timer = facts.usb.as_ref().and_then(|usb| usb.latency_timer_ms);
            port = Some(with(facts, "latency_timer_ms", json!(timer)));
        }
        ConnectionFacts::Net(route) => {
            let route = route.as_ref();
            network = route.map(|route| with(route, "direct", json!(route.is_direct())));
        }
        ConnectionFacts::Can(facts) => can = Some(facts),
        ConnectionFacts::BuiltIn => {}
    }
    let status = measured.map(|measured| &measured.status);
    json!({
        "hand": checkup.endpoint.to_string(),
        "well": !found.iter().any(|finding| finding.is_wrong),
        "port": port,
        "network": network,
        "can": can,
        "answers": measured.is_some(),
        "error": checkup.answer.as_ref().err(),
        "answered_after_ms": measured.map(|measured| millis(measured.answered_after)),
        "now_at": status.and_then(|status| status.moved_to.as_ref()),
        "adapter_echoes": status.map(|status| status.echoes),
        "other_controller": status.map(|status| status.other_controller),
        "foreign_setpoint": status.and_then(|status| status.foreign_setpoint),
        "latency_ticks": measured.map(|measured| measured.ticks_seen),
        "slow_ms": status.and_then(|status| status.slow_ms),
        "windows": measured.map(|measured| measured.windows.iter().map(window_json).collect::<Vec<_>>()),
        "errors": measured.map(errors_json),
        "findings": found,
    })
}

/// The facts with one additional derived field.
fn with(facts: &impl Serialize, name: &str, value: Value) -> Value {
    let mut object = json!(facts);
    if let Value::Object(fields) = &mut object {
        fields.insert(name.into(), value);
    }
    object
}

fn window_json(window: &BlockTiming) -> Value {
    let at = |percent| window.percentile(percent).map(millis);
    json!({
        "name": window.name,
        "address": window.span.address,
        "bytes": window.span.len,
        "reads": window.reads,
        "unanswered": window.failed,
        "refused": window.refused,
        "rtt_ms": {"min": at(0), "p50": at(50), "p99": at(99), "max": at(100)},
        "histogram": {"below_ms": EDGES_MS, "counts": window.histogram()},
        "hz": window.hz().map(tenths),
        "line_hz": window.line_hz().map(tenths),
    })
}

fn errors_json(measured: &LinkMeasurements) -> Value {
    let stats = &measured.stats;
    json!({
        "requests": measured.requests(),
        "timeouts": stats.timeouts,
        "checksum_errors": stats.checksum_errors,
        "resyncs": stats.resyncs,
        "foreign_replies": stats.foreign_replies,
        "late_replies": stats.late_replies,
        "foreign_requests": stats.foreign_requests,
        "refusals": stats.refusals,
        "readings": stats.readings,
        "implausible": stats.implausible,
        "reconnects": stats.reconnects,
        "stalls": stalls_json(stats),
        "priority_raised": priority::is_raised(),
    })
}

fn millis(value: Duration) -> f64 {
    (value.as_secs_f64() * 1e6).round() / 1e3
}

fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}
