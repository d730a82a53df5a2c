//! The report of a day as one HTML page for the user: no script, nothing from elsewhere; how it looks stands in `page.html`
//! beside this file. Writes no file itself.

use crate::exhibit::heat::HOT;
use crate::exhibit::report::DayReport;
use crate::hand::Dof;
use askama::Template;

/// What the template is filled with.
#[derive(Template)]
#[template(path = "page.html", config = "exhibit/report/askama.toml")]
struct DayPage<'a> {
    report: &'a DayReport,
}

/// The page of a day.
///
/// # Errors
/// What the template says.
pub fn html(report: &DayReport) -> Result<String, askama::Error> {
    // No control sign but the break of lines has a place in a page.
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
