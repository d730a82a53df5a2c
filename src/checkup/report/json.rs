//! A check-up as JSON, a stable format for scripts.

use crate::checkup::check::Check;
use crate::checkup::report::{CheckupReport, Keeping};
use crate::checkup::subject::Grade;
use serde_json::{Map, Value, json};

impl CheckupReport {
    /// `{"check": {…}}`. Unknown values are null.
    pub fn json(&self) -> Value {
        let usage = self.usage.as_ref().map(|usage| {
            let closes = usage.closes.iter();
            let closes = closes.map(|(dof, closes)| (dof.name().to_owned(), json!(closes)));
            json!({
                "recordings": usage.recordings,
                "since_1970_s": usage.since_1970_s,
                "recorded_s": usage.read_s,
                "moved_s": usage.moved_s,
                "closes": closes.collect::<Map<_, _>>(),
                "stalls": usage.stalls,
            })
        });
        json!({ "check": {
            "hand": self.hand,
            "at": self.at,
            "complete": self.aborted.is_none(),
            "aborted": self.aborted_words,
            "earlier": self.earlier,
            "kept": matches!(self.keeping, Keeping::Kept { .. }),
            "remarks": self.remarks(),
            "usage": usage,
            "checks": self.checks.iter().map(check).collect::<Vec<_>>(),
        }})
    }
}

fn check(check: &Check) -> Value {
    let row = check.measured.what.row();
    let past = check.trend.points.iter();
    let past = past.map(|point| json!({ "at": point.at, "value": point.value }));
    let drift = check.drift().map(|drift| {
        json!({ "from": drift.from, "to": drift.to, "checks": drift.checks, "since": drift.since })
    });
    json!({
        "what": check.measured.what,
        "of": check.measured.of.name(),
        "measured": check.measured.value,
        "channels": check.measured.channels,
        "unit": row.unit,
        "good": row.good,
        "first": check.first,
        "last": check.last,
        "past": past.collect::<Vec<_>>(),
        "drift": drift,
        "light": check.grade,
        "advice": (check.grade >= Grade::Watch).then_some(row.advice),
    })
}
