//! A check-up as one HTML page, with nothing from elsewhere. Writes no file itself.

use crate::checkup::check::{Check, Light};
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
