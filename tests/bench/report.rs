//! The table: what was measured, the figure, the aim and whether it is met. Measures nothing.

use std::io::{self, Write as _};

/// Whatever kept a figure from being measured.
pub(crate) type Failure = Box<dyn std::error::Error>;

/// What a figure should be.
#[derive(Clone, Copy)]
pub(crate) enum Aim {
    /// Not less than this.
    AtLeast(f64),
    /// Not more than this.
    AtMost(f64),
    /// Told only.
    None,
}

/// The table while it is printed, row by row as the figures come.
pub(crate) struct Report {
    missed: u32,
}

impl Report {
    pub(crate) fn begin() -> Result<Self, Failure> {
        line(&format!(
            "{:<62}{:>12} {:<9}{:>10}",
            "what", "figure", "unit", "aim"
        ))?;
        Ok(Self { missed: 0 })
    }

    /// One figure.
    pub(crate) fn row(
        &mut self,
        what: &str,
        figure: f64,
        unit: &str,
        aim: Aim,
    ) -> Result<(), Failure> {
        // The sum of nothing is -0.
        let figure = figure + 0.0;
        let (met, aim) = match aim {
            Aim::AtLeast(least) => (figure >= least, format!(">= {}", short(least))),
            Aim::AtMost(most) => (figure <= most, format!("<= {}", short(most))),
            Aim::None => {
                return line(&format!(
                    "{what:<62}{:>12} {unit:<9}{:>10}",
                    short(figure),
                    "-"
                ));
            }
        };
        self.missed += u32::from(!met);
        let verdict = if met { "met" } else { "MISSED" };
        line(&format!(
            "{what:<62}{:>12} {unit:<9}{aim:>10}  {verdict}",
            short(figure)
        ))
    }

    /// Something that could not be measured here, and why.
    pub(crate) fn absent(&mut self, what: &str, why: &str) -> Result<(), Failure> {
        line(&format!("{what:<62}{:>12} ({why})", "n/a"))
    }

    /// Lines that belong to the figures before.
    pub(crate) fn text(&mut self, lines: &str) -> Result<(), Failure> {
        line(lines)
    }

    pub(crate) fn end(self) -> Result<(), Failure> {
        match self.missed {
            0 => line("every aim is met"),
            missed => line(&format!("{missed} missed")),
        }
    }
}

/// Three digits that count.
fn short(figure: f64) -> String {
    let digits = match figure.abs() {
        size if size >= 100.0 || size == size.trunc() => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        _ => 3,
    };
    format!("{figure:.digits$}")
}

pub(crate) fn complain(failure: &Failure) {
    // Nobody is left to tell if even this cannot be written.
    drop(writeln!(io::stderr().lock(), "cannot measure: {failure}"));
}

pub(crate) fn line(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    writeln!(out, "{text}")?;
    Ok(out.flush()?)
}
