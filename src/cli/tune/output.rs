//! Result of a search as JSON, a contract with scripts, and as lines of text. Pure.

use crate::cli::tune::args::TuneArgs;
use crate::hand::PerDof;
use crate::motion::drive::{EndReport, stop_words};
use crate::trials::search::{
    Claim, ComparedThreshold, Finding, FoundApproach, OpenQuestion, Tried,
};
use serde_json::{Value, json};

/// Result of a search.
pub(crate) struct SearchReport {
    /// End of its series.
    pub(crate) series: EndReport,
    /// The finding; `None` if the search ended early.
    pub(crate) finding: Option<Finding>,
    /// All closes that were tried, also if the search ended early.
    pub(crate) tried: Vec<Tried>,
    /// Newtons of a gram of each joint, where they are known.
    pub(crate) newtons_per_g: PerDof<Option<f64>>,
}

/// The last line: `{"tune": {…}}`. Unknown values are null.
pub(crate) fn json(args: &TuneArgs, report: &SearchReport) -> Value {
    let claim = claim(report);
    let goal = args.goal();
    json!({ "tune": {
        "hand": args.series.hand.to_string(),
        "folder": args.series.out.as_ref().map(|folder| folder.display().to_string()),
        "limit_g": goal.limit_g,
        "hold_g": goal.hold_g,
        "result": claim.map(ToString::to_string),
        "why": no_claim(report),
        "speed": claim.map(|claim| claim.setting.speed),
        "force_threshold_g": claim.map(|claim| claim.setting.force),
        "approach": claim.map(|claim| claim.approach),
        "contact_angle": claim.and_then(|claim| Some(claim.joints.first()?.contact_angle)),
        "close_s": claim.map(|claim| claim.close_s),
        "peak_bound_g": claim.map(Claim::peak_bound_g),
        "peak_bound_n": peak_bound_n(report),
        "confidence": claim.map(|claim| claim.assurance.confidence),
        "coverage": claim.map(|claim| claim.assurance.coverage),
        "distribution_free": claim.map_or(goal.distribution_free, |claim| claim.distribution_free),
        "closes": claim.map(|claim| claim.closes),
        "closes_here": claim.map(|claim| claim.here),
        "trials": report.tried.len(),
        "peaks_g": claim.map(peaks),
        "joints": claim.map(|claim| &claim.joints),
        "tried": report.tried,
        "compared": report.finding.as_ref().map(|finding| &finding.compared),
        "untold": open_questions(report).iter().map(ToString::to_string).collect::<Vec<_>>(),
        "aborted": report.series.aborted.map(|why| why.to_string()),
        "stop": report.series.stop,
    }})
}

/// The same as a table for `session.toml`.
pub(crate) fn table(args: &TuneArgs, report: &SearchReport) -> toml::Table {
    let json = json(args, report);
    let table = json.get("tune").map(without_nulls);
    let table = table.and_then(|known| toml::Table::try_from(known).ok());
    table.unwrap_or_default()
}

/// Removes unknown values, as TOML has no null.
fn without_nulls(value: &Value) -> Value {
    match value {
        Value::Object(map) => {
            let known = map.iter().filter(|(_, value)| !value.is_null());
            known
                .map(|(key, value)| (key.clone(), without_nulls(value)))
                .collect()
        }
        Value::Array(all) => all.iter().map(without_nulls).collect(),
        other => other.clone(),
    }
}

/// The same as text: closes tried, result, open questions.
pub(crate) fn lines(report: &SearchReport) -> Vec<String> {
    let Some(claim) = claim(report) else {
        return Vec::new();
    };
    let approach = match claim.approach {
        FoundApproach::OneStage => "in one stage".into(),
        FoundApproach::TwoStage { fast_speed, margin } => {
            format!("at {fast_speed} to {margin} before the contact, then slower")
        }
    };
    let contact = claim.joints.iter().map(|joint| {
        format!(
            "{} meets it at {:.0} and holds with {:.0} g or more",
            joint.dof.name(),
            joint.contact_angle,
            joint.hold_g
        )
    });
    let over = report.tried.iter().filter(|own| own.over_limit).count();
    let mut lines = vec![
        claim.to_string(),
        format!("{}, {approach}", claim.setting),
        contact.collect::<Vec<_>>().join("; "),
        format!(
            "{} closes in all, {over} of them over the limit",
            report.tried.len()
        ),
    ];
    lines.extend(
        peak_bound_n(report)
            .map(|newtons| format!("in newtons of this hand, the peak is at most {newtons:.1} N")),
    );
    lines.extend(compared(report).map(ToString::to_string));
    lines.extend(
        open_questions(report)
            .iter()
            .map(|own| format!("not determined: {own}")),
    );
    lines
}

/// Reason if there is no claim.
pub(crate) fn no_claim(report: &SearchReport) -> Option<String> {
    let aborted = report.series.aborted;
    let early = aborted.map(|why| {
        let closes = report.tried.len();
        let stop = stop_words(report.series.stop);
        format!("ended early after {closes} closes: {why}{stop}")
    });
    let none = report
        .finding
        .as_ref()
        .and_then(|finding| finding.result.as_ref().err());
    early.or_else(|| none.map(ToString::to_string))
}

/// Bound of the peak in newtons, where they are known.
fn peak_bound_n(report: &SearchReport) -> Option<f64> {
    claim(report)?.peak_bound_n(&report.newtons_per_g)
}

fn claim(report: &SearchReport) -> Option<&Claim> {
    let finding = report
        .finding
        .as_ref()
        .filter(|_| report.series.aborted.is_none());
    finding.and_then(|finding| finding.result.as_ref().ok())
}

fn open_questions(report: &SearchReport) -> &[OpenQuestion] {
    report
        .finding
        .as_ref()
        .map_or(&[], |finding| &finding.open_questions)
}

/// Findings about the drives that show a notable offset.
fn compared(report: &SearchReport) -> impl Iterator<Item = &ComparedThreshold> {
    let all = report.finding.iter().flat_map(|finding| &finding.compared);
    all.filter(|own| own.is_notable() && own.compared.is_some())
}

/// Peak over all joints of each confirming close, g.
fn peaks(claim: &Claim) -> Vec<f64> {
    let highest = |nth: usize| {
        let peaks = claim
            .joints
            .iter()
            .filter_map(|joint| joint.peaks_g.get(nth));
        peaks.copied().fold(0.0, f64::max)
    };
    (0..claim.here).map(highest).collect()
}
