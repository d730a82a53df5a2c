//! The report of a day as one self-contained HTML page for the user, without scripts; its layout is `page.html` beside this file.
//! Writes no file itself.

use crate::exhibit::heat::HOT;
use crate::exhibit::report::DayReport;
use crate::hand::Dof;
use askama::Template;

/// Data for the template.
#[derive(Template)]
#[template(path = "page.html", config = "exhibit/report/askama.toml")]
struct DayPage<'a> {
    report: &'a DayReport,
}

/// Renders the page of a day.
///
/// # Errors
/// A template error.
pub fn html(report: &DayReport) -> Result<String, askama::Error> {
    // Control characters other than line breaks are not allowed in a page.
    let is_control = |letter: char| letter.is_control() && letter != '\n';
    let page = DayPage { report }.render()?;
    Ok(page.replace(is_control, "\u{FFFD}"))
}

impl DayPage<'_> {
    fn is_simulated(&self) -> bool {
        self.report
            .hands
            .iter()
            .any(|hand| hand.starts_with("sim:"))
    }

    fn hands(&self) -> String {
        let hands: Vec<&str> = self.report.hands.iter().map(String::as_str).collect();
        if hands.is_empty() {
            "-".into()
        } else {
            hands.join(", ")
        }
    }

    fn too_hot(&self, celsius: &u8) -> bool {
        f32::from(*celsius) > HOT
    }
}
