//! A check-up as JSON, a contract with scripts, and as lines of text.

use crate::checkup::check::Check;
use crate::checkup::report::ReportHead;
use crate::checkup::run::CheckupView;
use crate::checkup::subject::Light;
use crate::cli::out::say;
use serde_json::{Value, json};

/// `{"check": {…}}`. What is not known is null.
pub(crate) fn json(head: &ReportHead, checks: &[Check]) -> Value {
    let checks = checks.iter().map(|check| {
        let row = check.measured.what.row();
        json!({
            "what": check.measured.what,
            "of": check.measured.of.name(),
            "measured": check.measured.value,
            "unit": row.unit,
            "good": row.good,
            "first": check.first,
            "last": check.last,
            "light": check.light,
            "advice": (check.light >= Light::Watch).then_some(row.advice),
        })
    });
    json!({ "check": {
        "hand": head.hand,
        "at": head.at,
        "complete": head.aborted.is_none(),
        "aborted": head.aborted,
        "earlier": head.earlier,
        "checks": checks.collect::<Vec<_>>(),
    }})
}

/// What is not as it should be, and what to do, with the summary.
pub(crate) fn lines(head: &ReportHead, checks: &[Check]) -> Vec<String> {
    // What a partial one did not come to is no news.
    let is_told = |light| match light {
        Light::Fine => false,
        Light::Unknown => head.aborted.is_none(),
        Light::Watch | Light::Act => true,
    };
    let told = checks.iter().filter(|check| is_told(check.light));
    let mut lines: Vec<String> = told.map(line).collect();
    lines.push(head.summary.clone());
    lines
}

fn line(check: &Check) -> String {
    let row = check.measured.what.row();
    let (of, light) = (check.measured.of.name(), check.light.name());
    let Some(value) = check.measured.value else {
        return format!("{light}: {of}: {} was not measured", row.name);
    };
    let first = check
        .first
        .map(|first| format!(", {} at first", row.text(first)));
    format!(
        "{light}: {of}: {} is {} (good: {}{}): {}",
        row.name,
        row.text(value),
        row.range(),
        first.unwrap_or_default(),
        row.advice
    )
}

/// What is done now.
pub(crate) fn progress(view: CheckupView) {
    let what = view.joint.map_or("all joints", |dof| dof.name());
    if view.done < view.total {
        say(&format!("{} of {}: {what}", view.done + 1, view.total));
    }
}
