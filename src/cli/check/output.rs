//! Text output of a check-up: its result and its progress.

use crate::checkup::check::Check;
use crate::checkup::report::CheckupReport;
use crate::checkup::report::line::{drift_words, value_words};
use crate::checkup::run::CheckupView;
use crate::checkup::subject::Grade;
use crate::cli::out::notify;

/// Findings with advice, and the summary.
pub(crate) fn lines(report: &CheckupReport) -> Vec<String> {
    let is_reported = |check: &&Check| check.grade != Grade::Fine || check.drift().is_some();
    let reported = report.listed().filter(is_reported);
    let mut lines: Vec<String> = reported.map(line).collect();
    lines.extend(report.remarks());
    lines.push(report.usage_words());
    lines.push(report.summary());
    lines
}

fn line(check: &Check) -> String {
    let row = check.measured.what.row();
    let (of, grade) = (check.measured.of.name(), check.grade.name());
    if check.measured.value.is_none() {
        return format!("{grade}: {of}: {} was not measured", row.name);
    }
    let first = check
        .first
        .map(|first| format!(", {} at first", row.text(first)));
    let advice = (check.grade != Grade::Fine).then(|| row.advice.to_owned());
    let advice: Vec<String> = advice.into_iter().chain(drift_words(check)).collect();
    format!(
        "{grade}: {of}: {} is {} (good: {}{}): {}",
        row.name,
        value_words(check),
        row.range(),
        first.unwrap_or_default(),
        advice.join("; ")
    )
}

/// Reports the current step, or the press requested from the user.
pub(crate) fn progress(view: CheckupView) {
    let what = match (view.press, view.joint) {
        (Some(finger), _) => format!(
            "press and release the {}'s fingertip; nothing moves now",
            finger.name()
        ),
        (None, Some(dof)) => dof.name().to_owned(),
        (None, None) => "all joints".to_owned(),
    };
    if view.done < view.total {
        notify(&format!("{} of {}: {what}", view.done + 1, view.total));
    }
}
