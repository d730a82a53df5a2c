//! A session as one HTML page for a person: parameters, metrics, curves, the hand's quirks. One file, no script, nothing
//! from elsewhere. Writes no file itself.

use crate::app::trial::best::{Criterion, Score, Spread, best};
use crate::app::trial::curve::{Curve, JointCurves};
use crate::app::trial::metrics::JointMetrics;
use crate::app::trial::plan::Setting;
use crate::app::trial::recording::{What, seconds};
use crate::app::trial::series::Trial;
use crate::app::trial::session::{SessionFile, TrialRow};
use crate::app::trial::svg::{Line, Plot, escaped};
use crate::app::trial::together::{BEFORE_S, Together};
use crate::hand::Dof;
use std::fmt::Write as _;

/// Trials whose curves are drawn; the samples of the others lie beside the page.
pub const DRAWN_MAX: usize = 60;
/// A page on paper: light, with six strokes that differ in grey too. The window's theme is another matter.
const STYLE: &str = "body{font:14px/1.5 system-ui,sans-serif;margin:2em auto;max-width:70em;padding:0 1em;color:#1b1f24}\
table{border-collapse:collapse;margin:.5em 0}td,th{padding:.15em .7em;border-bottom:1px solid #d8dee4;text-align:right}\
th{font-weight:600}td:first-child,th:first-child{text-align:left}svg{width:100%;max-width:640px;display:block}\
svg text{font-size:10px;fill:#57606a}.end{text-anchor:end}.middle{text-anchor:middle}.frame{fill:none;stroke:#d8dee4}\
polyline{fill:none;stroke-width:1.2}.key{border-bottom:3px solid;margin-right:1em}.mark{stroke:#afb8c1;stroke-dasharray:2 3}.level{stroke:#57606a;stroke-dasharray:6 3}\
.s0{stroke:#0b5fa5;border-color:#0b5fa5}.s1{stroke:#b3470b;border-color:#b3470b}.s2{stroke:#2f7d32;border-color:#2f7d32}.s3{stroke:#7b3fa0;border-color:#7b3fa0}.s4{stroke:#8a6d00;border-color:#8a6d00}.s5{stroke:#444c56;border-color:#444c56}\
.bad{color:#b3261e}@media print{h2{break-after:avoid}}";

/// The curves of a session, drawn as its trials come.
#[derive(Debug, Default)]
pub struct Page {
    drawn: Vec<(usize, String)>,
    left_out: usize,
    together: Together,
}

impl Page {
    /// Draws one trial.
    pub fn add(&mut self, trial: &Trial) {
        self.together.add(trial);
        if self.drawn.len() >= DRAWN_MAX {
            self.left_out += 1;
            return;
        }
        self.drawn.push((trial.number, curves(trial)));
    }

    /// The page.
    #[must_use]
    pub fn text(
        &self,
        session: &SessionFile,
        scores: &[Score],
        criterion: Option<Criterion>,
    ) -> String {
        let mut out = format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Grasp trials, {}</title><style>{STYLE}</style></head><body>\n",
            escaped(&session.day)
        );
        head(&mut out, session);
        summary(&mut out, scores, criterion);
        map(&mut out, scores);
        metrics(&mut out, &session.trials);
        out.push_str(&self.together.text());
        out.push_str("<h2>Curves</h2>\n");
        legend(&mut out, session);
        for (number, curves) in &self.drawn {
            let row = session.trials.iter().find(|row| row.number == *number);
            let title = row.map_or_else(String::new, title);
            let _done = write!(out, "<h3>{}</h3>\n{curves}", escaped(&title));
        }
        if self.left_out > 0 {
            let _done = writeln!(
                out,
                "<p>{} further trials are not drawn; their samples lie beside this page.</p>",
                self.left_out
            );
        }
        quirks(&mut out, session);
        out.push_str("</body></html>\n");
        out
    }
}

fn title(row: &TrialRow) -> String {
    let what = if row.kind == "probe" {
        "contact sought"
    } else {
        "trial"
    };
    format!(
        "{} ({what}): speed {}, threshold {} g",
        row.number, row.speed, row.force_threshold_g
    )
}

fn pair(out: &mut String, name: &str, value: &str) {
    // Writing to a string cannot fail.
    let _done = writeln!(
        out,
        "<tr><td>{}</td><td>{}</td></tr>",
        escaped(name),
        escaped(value)
    );
}

fn head(out: &mut String, session: &SessionFile) {
    out.push_str("<h1>Grasp trials</h1>\n");
    if session.simulated {
        out.push_str("<p><strong>SIMULATED HAND</strong></p>\n");
    }
    if let Some(why) = &session.aborted {
        let _done = writeln!(out, "<p class=\"bad\">Ended early: {}</p>", escaped(why));
    }
    if !session.note.is_empty() {
        let _done = writeln!(out, "<p>{}</p>", escaped(&session.note));
    }
    out.push_str("<table>\n");
    pair(out, "Hand", &session.hand);
    pair(out, "Day (universal time)", &session.day);
    if !session.tags.is_empty() {
        pair(out, "Tags", &session.tags.join(", "));
    }
    let plan = &session.plan;
    let list = |values: &[i16]| {
        let words: Vec<String> = values.iter().map(i16::to_string).collect();
        words.join(", ")
    };
    let angles = |angles: &std::collections::BTreeMap<String, i16>| {
        let words: Vec<String> = angles
            .iter()
            .map(|(dof, at)| format!("{dof} {at}"))
            .collect();
        words.join(", ")
    };
    pair(out, "Start", &angles(&plan.start));
    pair(out, "Closes to", &angles(&plan.close));
    pair(out, "Speeds at the contact", &list(&plan.speeds));
    pair(out, "Force thresholds, g", &list(&plan.forces_g));
    let approach = match (plan.fast_speed, &plan.until, plan.until_value) {
        (Some(fast), Some(until), Some(value)) => format!("at {fast} until {until} {value}"),
        _ => "one stage".into(),
    };
    pair(out, "Approach", &approach);
    pair(out, "Trials of each", &plan.repeats.to_string());
    let times = format!("{} s, {} s", plan.dwell_s, plan.rest_s);
    pair(out, "Dwell, rest", &times);
    let limits = format!(
        "{} g, {} °C (begins below {} °C)",
        plan.ceiling_g, plan.stop_c, plan.start_c
    );
    pair(out, "Limits", &limits);
    out.push_str("</table>\n");
}

fn spread(spread: Option<Spread>, digits: usize) -> String {
    match spread {
        None => "-".into(),
        Some(Spread { median, min, max }) => {
            format!("{median:.digits$} ({min:.digits$} to {max:.digits$})")
        }
    }
}

fn row(out: &mut String, cells: &[String], tag: &str) {
    out.push_str("<tr>");
    for cell in cells {
        let _done = write!(out, "<{tag}>{}</{tag}>", escaped(cell));
    }
    out.push_str("</tr>\n");
}

fn header(out: &mut String, cells: &[&str]) {
    let cells: Vec<String> = cells.iter().map(|cell| (*cell).to_owned()).collect();
    row(out, &cells, "th");
}

/// What a criterion asks for, in words.
#[must_use]
pub fn criterion_words(criterion: Criterion) -> String {
    match criterion {
        Criterion::LeastOvershoot { steady_g } => {
            format!("least overshoot with a steady force of {steady_g} g or more")
        }
        Criterion::Fastest {
            overshoot_g,
            steady_g,
        } => format!(
            "shortest time to the stop with an overshoot of {overshoot_g} g or less and a steady force of {steady_g} g or more"
        ),
    }
}

fn summary(out: &mut String, scores: &[Score], criterion: Option<Criterion>) {
    out.push_str("<h2>Settings</h2>\n<table>\n");
    header(
        out,
        &[
            "Speed, threshold",
            "Trials",
            "Ended early",
            "Overshoot, g",
            "Steady force, g",
            "Time to stop, s",
        ],
    );
    for score in scores {
        let Setting { speed, force } = score.setting;
        let clipped = if score.clipped { " and more" } else { "" };
        let cells = [
            format!("{}, {} g", speed.get(), force.get()),
            score.trials.to_string(),
            score.aborted.to_string(),
            spread(score.overshoot_g, 0) + clipped,
            spread(score.steady_force_g, 0),
            spread(score.time_to_stop_s, 2),
        ];
        row(out, &cells, "td");
    }
    out.push_str("</table>\n<p>Middle (lowest to highest) over repeats and joints.</p>\n");
    let Some(criterion) = criterion else { return };
    let words = match best(scores, criterion).map(|score| score.setting) {
        Some(Setting { speed, force }) => {
            format!("speed {}, threshold {} g", speed.get(), force.get())
        }
        None => "no setting will do".into(),
    };
    let criterion = criterion_words(criterion);
    let _done = writeln!(
        out,
        "<p>Best by {}: <strong>{}</strong></p>",
        escaped(&criterion),
        escaped(&words)
    );
}

/// Overshoot by speed and threshold.
fn map(out: &mut String, scores: &[Score]) {
    let mut speeds: Vec<i16> = scores.iter().map(|s| s.setting.speed.get()).collect();
    let mut forces: Vec<i16> = scores.iter().map(|s| s.setting.force.get()).collect();
    for values in [&mut speeds, &mut forces] {
        values.sort_unstable();
        values.dedup();
    }
    if speeds.len() < 2 && forces.len() < 2 {
        return;
    }
    out.push_str("<h2>Overshoot, g, by speed and threshold</h2>\n<table>\n");
    let heads = forces.iter().map(|force| format!("{force} g"));
    let cells: Vec<String> = std::iter::once("Speed".into()).chain(heads).collect();
    row(out, &cells, "th");
    for speed in &speeds {
        let cell = |force: &i16| {
            let same =
                |s: &&Score| s.setting.speed.get() == *speed && s.setting.force.get() == *force;
            let over = scores.iter().find(same).and_then(|score| score.overshoot_g);
            over.map_or("-".into(), |over| format!("{:.0}", over.median))
        };
        let cells: Vec<String> = std::iter::once(speed.to_string())
            .chain(forces.iter().map(cell))
            .collect();
        row(out, &cells, "td");
    }
    out.push_str("</table>\n");
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or("-".into(), |value| format!("{value:.digits$}"))
}

fn metrics(out: &mut String, trials: &[TrialRow]) {
    out.push_str("<h2>Trials</h2>\n<table>\n");
    header(
        out,
        &[
            "Trial",
            "Joint",
            "Dead time, s",
            "To contact, s",
            "To touch, s",
            "Peak, g",
            "Overshoot, g",
            "Settles, s",
            "Steady, g",
            "Relaxes, g",
            "Slips",
            "Current, mA",
            "Warmer, °C",
            "Reads/s",
            "Ends as",
        ],
    );
    for trial in trials {
        for joint in &trial.joints {
            row(out, &metric_cells(trial, joint), "td");
        }
        if let Some(why) = &trial.aborted {
            let _done = writeln!(
                out,
                "<tr><td colspan=\"15\" class=\"bad\">{}</td></tr>",
                escaped(why)
            );
        }
    }
    out.push_str("</table>\n");
}

fn metric_cells(trial: &TrialRow, joint: &JointMetrics) -> [String; 15] {
    let clipped = if joint.clipped == Some(true) {
        "over "
    } else {
        ""
    };
    [
        title(trial),
        joint.dof.name().into(),
        number(joint.dead_time_s, 3),
        number(joint.time_to_contact_s, 3),
        number(joint.time_to_touch_s, 3),
        format!("{clipped}{}", number(joint.peak_force_g, 0)),
        number(joint.overshoot_g, 0),
        number(joint.settle_time_s, 2),
        number(joint.steady_force_g, 0),
        number(joint.relaxation_g, 0),
        joint
            .slip_count
            .map_or("-".into(), |count| count.to_string()),
        number(joint.peak_current_ma, 0),
        number(joint.temperature_rise_c, 0),
        number(joint.rate_hz, 0),
        joint.end_status.clone().unwrap_or("-".into()),
    ]
}

/// Which stroke is which joint, and what the straight lines are.
fn legend(out: &mut String, session: &SessionFile) {
    out.push_str("<p>");
    let closes = |dof: &Dof| session.plan.close.contains_key(dof.name());
    for dof in Dof::ALL.into_iter().filter(closes) {
        let _done = write!(
            out,
            "<span class=\"key s{}\">{}</span>",
            dof.index(),
            dof.name()
        );
    }
    out.push_str(
        "Time counts from the closing command. Dashed: the force threshold. Dotted: close, slow, stopped, release, released.</p>\n",
    );
}

fn curves(trial: &Trial) -> String {
    let recording = &trial.recording;
    let zero = recording.zero();
    let dofs: Vec<Dof> = trial.metrics.joints.iter().map(|joint| joint.dof).collect();
    let all: Vec<(Dof, JointCurves)> = dofs
        .into_iter()
        .map(|dof| (dof, JointCurves::of(recording, dof)))
        .collect();
    let last = recording
        .rows()
        .last()
        .map_or(0.0, |row| seconds(zero, row.at));
    let marks: Vec<(f64, String)> = recording
        .marks()
        .iter()
        .filter(|mark| !matches!(mark.what, What::Prepare | What::Limits))
        .map(|mark| (seconds(zero, mark.at), mark.what.name()))
        .collect();
    let plot = |name: &str, level: Option<f64>, pick: fn(&JointCurves) -> &Curve| {
        let line = |(dof, curves): &(Dof, JointCurves)| Line {
            stroke: dof.index(),
            curve: pick(curves)
                .between(-BEFORE_S, last)
                .map(|p| (p.t, p.v))
                .collect(),
        };
        let plot = Plot {
            name: name.into(),
            from_s: -BEFORE_S,
            to_s: last,
            lines: all.iter().map(line).collect(),
            level,
            marks: marks.clone(),
        };
        plot.svg()
    };
    let threshold = f64::from(trial.setting.force.get());
    plot("Force, g", Some(threshold), |curves| &curves.force)
        + &plot("Angle", None, |curves| &curves.angle)
        + &plot("Current, mA", None, |curves| &curves.current)
}

fn quirks(out: &mut String, session: &SessionFile) {
    let Some(sheet) = &session.quirks else { return };
    out.push_str("<h2>What was found about the hand</h2>\n<table>\n");
    let number = |value: Option<u8>| value.map_or("-".to_owned(), |value| value.to_string());
    let word = |value: &Option<String>| value.clone().unwrap_or("-".into());
    pair(out, "Place", &sheet.place);
    pair(out, "Id asked", &sheet.id.to_string());
    pair(out, "HAND_ID", &number(sheet.hand_id));
    pair(out, "REDU_RATIO", &number(sheet.baud_code));
    pair(out, "Bytes in words", &word(&sheet.packing));
    pair(out, "Unused addresses", &word(&sheet.gap));
    pair(out, "Fingertips", &word(&sheet.touch));
    out.push_str("</table>\n");
}
