//! A check-up as one HTML page, with nothing from elsewhere. Writes no file itself.

use crate::checkup::check::Check;
use crate::checkup::subject::Light;
use askama::Template;

/// What a report begins with.
#[derive(Debug, Clone)]
pub struct ReportHead {
    /// The hand, as an endpoint.
    pub hand: String,
    pub simulated: bool,
    /// When, universal time.
    pub at: String,
    /// Why it is partial, if it is.
    pub aborted: Option<String>,
    /// How many check-ups of this hand were kept before.
    pub earlier: usize,
    /// How many figures are fine, and how many not.
    pub summary: String,
}

#[derive(Template)]
#[template(path = "report.html", config = "src/checkup/report/askama.toml")]
struct ReportPage<'a> {
    head: &'a ReportHead,
    checks: &'a [Check],
}

/// The page.
///
/// # Errors
/// What the template says.
pub fn html(head: &ReportHead, checks: &[Check]) -> Result<String, askama::Error> {
    ReportPage { head, checks }.render()
}

/// How many are of each light, in words.
pub fn summary(checks: &[Check]) -> String {
    let number = |light| checks.iter().filter(|own| own.light == light).count();
    let [fine, watch, act, unknown] =
        [Light::Fine, Light::Watch, Light::Act, Light::Unknown].map(number);
    let all = checks.len();
    format!(
        "{all} figures: {fine} as they should be, {watch} to watch, {act} to act on, {unknown} not measured"
    )
}

impl<'a> ReportPage<'a> {
    /// The checks of each joint, fingertip and the hand, in their order.
    fn groups(&self) -> Vec<(&'static str, &'a [Check])> {
        let same = |a: &Check, b: &Check| a.measured.of == b.measured.of;
        let groups = self.checks.chunk_by(same);
        let named = groups.filter_map(|own| Some((own.first()?.measured.of.name(), own)));
        named.collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::checkup::measure::Measured;
    use crate::checkup::subject::{Part, Subject};
    use crate::hand::Dof;

    #[test]
    fn the_page_says_what_is_worn_what_is_not_known_and_that_it_is_partial() {
        let of = Part::Joint(Dof::Index);
        let measured = |what, value| Measured { what, of, value };
        let checks = [
            measured(Subject::Backlash, Some(48.0)),
            measured(Subject::DeadTime, None),
            measured(Subject::OpenEnd, Some(1000.0)),
        ];
        let first = [measured(Subject::Backlash, Some(4.0))];
        let checks = checks.map(|own| Check::of(own, &first, &[]));
        let head = ReportHead {
            hand: "tcp:<b>".into(),
            simulated: false,
            at: "2026-11-25 10:00:00".into(),
            aborted: Some("ended by a person".into()),
            earlier: 1,
            summary: summary(&checks),
        };
        let page = html(&head, &checks).unwrap();
        for wanted in [
            "<td class=\"act\">48 counts</td><td>-8 to 14</td><td>4 counts</td><td>-</td><td>look at the linkage",
            "<td class=\"unknown\">-</td>",
            "<td class=\"fine\">1000</td><td>985 to 1000</td><td>-</td><td>-</td><td></td>",
            "Partial: it ended early, ended by a person",
            "3 figures: 1 as they should be, 0 to watch, 1 to act on, 1 not measured",
            "<h2>index</h2>",
        ] {
            assert!(page.contains(wanted), "{wanted}\n{page}");
        }
        assert!(!page.contains("<b>"));
    }
}
