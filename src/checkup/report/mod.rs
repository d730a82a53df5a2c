//! The result of a check-up and its page: one self-contained HTML file. Writes no file itself.

mod json;
pub mod line;

use crate::checkup::check::Check;
use crate::checkup::subject::Grade;
use crate::checkup::usage::Usage;
use crate::hand::Dof;
use crate::record::Abort;
use crate::store::calendar::day;
use askama::Template;
use std::time::Duration;

/// File names in the folder of a check-up: the page, the figures, the recording.
pub const PAGE_FILE: &str = "report.html";
pub const JSON_FILE: &str = "check.json";
pub const RECORDING_FILE: &str = "check.mcap";

/// Result of storing a check-up for later comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Keeping {
    /// Stored, after this many earlier ones.
    Kept { earlier: usize },
    /// Not stored: the built-in hand differs on each start.
    BuiltIn,
    /// Not stored: it ended early.
    Partial,
    /// Not stored as the first, the birth record: this joint did not complete its stroke, so something may be in the hand.
    NotAsFirst { dof: Dof },
    /// The file could not be written.
    Failed { error: String },
}

/// Result of a check-up.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckupReport {
    /// The hand, as an endpoint.
    pub hand: String,
    pub simulated: bool,
    /// Time of the check-up, UTC.
    pub at: String,
    /// Reason for an early end, and the same in English with the result of the stop.
    pub aborted: Option<Abort>,
    pub aborted_words: Option<String>,
    /// Number of earlier check-ups stored for this hand.
    pub earlier: usize,
    pub checks: Vec<Check>,
    /// Joints that were not moved because they could not have been stopped gently, with their zeros, g.
    pub left_alone: Vec<(Dof, f64)>,
    pub keeping: Keeping,
    /// Use of the hand; `None` without recordings of it.
    pub usage: Option<Usage>,
    /// True if the traffic is recorded beside it.
    pub recorded: bool,
}

#[derive(Template)]
#[template(path = "report.html", config = "checkup/report/askama.toml")]
struct CheckupReportPage<'a> {
    report: &'a CheckupReport,
}

impl CheckupReport {
    /// Renders the page.
    ///
    /// # Errors
    /// A template error.
    pub fn html(&self) -> Result<String, askama::Error> {
        CheckupReportPage { report: self }.render()
    }

    /// The figures to list: all, or those that a partial check-up measured. The others are only counted.
    pub fn listed(&self) -> impl Iterator<Item = &Check> {
        let is_listed = move |own: &&Check| self.aborted.is_none() || own.grade != Grade::Unknown;
        self.checks.iter().filter(is_listed)
    }

    /// The number of figures with this grade.
    pub fn count(&self, grade: Grade) -> usize {
        self.checks.iter().filter(|own| own.grade == grade).count()
    }

    /// The number of figures with each grade, as a sentence.
    pub fn summary(&self) -> String {
        let [fine, watch, act, unknown] =
            [Grade::Fine, Grade::Watch, Grade::Act, Grade::Unknown].map(|grade| self.count(grade));
        let all = self.checks.len();
        format!(
            "{all} figures: {fine} as they should be, {watch} to watch, {act} to act on, {unknown} not measured"
        )
    }

    /// Remarks besides the figures, a sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let left_alone = self.left_alone.iter().map(|(dof, zero_g)| {
            format!(
                "{} was skipped: its sensor reads {zero_g:.0} g at rest, so it could not be stopped gently; calibrate the force sensors with an empty hand (Hand > Device), and check again",
                dof.name()
            )
        });
        left_alone.chain(self.keeping.words()).collect()
    }

    /// Use of the hand, as a sentence.
    pub fn usage_words(&self) -> String {
        let Some(usage) = &self.usage else {
            return "Hours in use, closes and stalls: not known, there are no recordings of this hand".into();
        };
        let [read, moved] = usage.hours();
        let (dof, closes) = usage.most_closed();
        format!(
            "Recorded since {}: {read} hours, {moved} of them moving; {} closed most, {closes} times; {} stalls (recordings: {})",
            day(Duration::from_secs(usage.since_1970_s)),
            dof.name(),
            usage.stalls,
            usage.recordings,
        )
    }
}

impl Keeping {
    /// Reason why it was not stored; `None` where that needs no remark.
    fn words(&self) -> Option<String> {
        match self {
            Self::Kept { .. } | Self::BuiltIn | Self::Partial => None,
            Self::NotAsFirst { dof } => Some(format!(
                "It is not kept as this hand's first: {} did not go through its stroke; take out what is in its way, and check again",
                dof.name()
            )),
            Self::Failed { error } => Some(format!("It is not kept: {error}")),
        }
    }
}

impl<'a> CheckupReportPage<'a> {
    /// The listed figures grouped by joint, fingertip and hand, in order.
    fn groups(&self) -> Vec<(&'static str, Vec<&'a Check>)> {
        let listed: Vec<&Check> = self.report.listed().collect();
        let same = |a: &&Check, b: &&Check| a.measured.of == b.measured.of;
        let groups = listed.chunk_by(same);
        let named = groups.filter_map(|own| Some((own.first()?.measured.of.name(), own.to_vec())));
        named.collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::checkup::check::checks;
    use crate::checkup::kept::StoredCheckup;
    use crate::checkup::measure::Measured;
    use crate::checkup::subject::{HandPart, Subject};
    use crate::hand::PerDof;

    fn report(values: [Option<f64>; 3], earlier: &[StoredCheckup]) -> CheckupReport {
        let of = HandPart::Joint(Dof::Index);
        let [backlash, dead, open] = values;
        let measured = vec![
            Measured::new(Subject::Backlash, of, backlash),
            Measured::new(Subject::DeadTime, of, dead),
            Measured::new(Subject::OpenEnd, of, open),
        ];
        CheckupReport {
            hand: "tcp:<b>".into(),
            simulated: false,
            at: "2026-11-25T10:00:00Z".into(),
            aborted: None,
            aborted_words: None,
            earlier: earlier.len(),
            checks: checks(measured, "2026-11-25T10:00:00Z", earlier),
            left_alone: Vec::new(),
            keeping: Keeping::Partial,
            usage: None,
            recorded: false,
        }
    }

    fn stored(day: u32, backlash: f64) -> StoredCheckup {
        let of = HandPart::Joint(Dof::Index);
        StoredCheckup {
            at: format!("2026-11-{day:02}T10:00:00Z"),
            hand: "tcp:<b>".into(),
            figures: vec![Measured::new(Subject::Backlash, of, Some(backlash))],
            report: None,
        }
    }

    #[test]
    fn the_page_says_what_is_worn_what_is_not_known_and_that_it_is_partial() {
        let report = CheckupReport {
            aborted: Some(Abort::Person),
            aborted_words: Some("ended by the user".into()),
            left_alone: vec![(Dof::Ring, -600.0)],
            keeping: Keeping::NotAsFirst { dof: Dof::Index },
            ..report([Some(48.0), None, Some(1000.0)], &[stored(1, 4.0)])
        };
        let page = report.html().unwrap();
        for wanted in [
            "<td class=\"act\">48 counts</td><td>-8 to 14</td><td>4 counts</td><td>4 counts</td>",
            "<td>inspect the linkage",
            "<td class=\"fine\">1000</td><td>985 to 1000</td><td>-</td><td>-</td>",
            "Partial: it ended early, ended by the user",
            "3 figures: 1 as they should be, 0 to watch, 1 to act on, 1 not measured",
            "<h2>index</h2>",
            "ring was skipped: its sensor reads -600 g at rest",
            "not kept as this hand&#39;s first: index did not go through its stroke",
            "there are no recordings of this hand",
        ] {
            assert!(page.contains(wanted), "{wanted}\n{page}");
        }
        assert!(!page.contains("<b>"));
        let missing = "<td class=\"unknown\">-</td>";
        assert!(!page.contains(missing), "it did not come to it");
        let whole = CheckupReport {
            aborted: None,
            ..report
        };
        let page = whole.html().unwrap();
        assert!(page.contains(missing), "it could not be measured");
    }

    #[test]
    fn a_figure_that_drifts_is_drawn_over_the_days_and_told_with_them() {
        let earlier: Vec<StoredCheckup> = (1..=5_u32)
            .map(|day| stored(day, f64::from(day) + 1.0))
            .collect();
        let usage = Usage {
            recordings: 3,
            since_1970_s: 1_795_219_200,
            read_s: 7200,
            moved_s: 1800,
            closes: PerDof::from_fn(|dof| if dof == Dof::Middle { 40 } else { 3 }),
            stalls: 2,
        };
        let report = CheckupReport {
            usage: Some(usage),
            ..report([Some(7.0), None, None], &earlier)
        };
        let page = report.html().unwrap();
        for wanted in [
            "<polyline points=\"",
            "<title>2026-11-01: 2 counts\n",
            "2026-11-25: 7 counts</title>",
            "drifts from 2 counts to 7 counts over 6 check-ups since 2026-11-01",
            "Recorded since 2026-11-21: 2.0 hours, 0.5 of them moving; middle closed most, 40 times; 2 stalls (recordings: 3)",
        ] {
            assert!(page.contains(wanted), "{wanted}\n{page}");
        }
        let json = report.json();
        let check = &json["check"]["checks"][0];
        assert_eq!(check["past"].as_array().unwrap().len(), 6);
        assert_eq!(check["drift"]["since"], "2026-11-01");
        assert_eq!(json["check"]["usage"]["stalls"], 2);
        assert_eq!(json["check"]["usage"]["closes"]["middle"], 40);
    }
}
