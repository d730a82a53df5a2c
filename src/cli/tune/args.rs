//! The command line of `tune` as clap sees it, and the goal that it defines.

use crate::cli::parse::{angle, dof};
use crate::cli::trial::args::place;
use crate::hand::{Angle, Dof, PerDof};
use crate::transport::Endpoint;
use crate::trials::Limits;
use crate::trials::search::SearchGoal;
use clap::Args;
use std::path::PathBuf;

/// Degrees below the limit at which closes start.
const COOLER_C: u8 = 10;

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Move the hand: nothing but the object is in its way, and the 24 V switch is in reach
    #[arg(long)]
    pub(crate) arm: bool,
    /// Joints that close, separated by commas: little, ring, middle, index, thumb_bend, thumb_rotate
    #[arg(long, value_name = "NAMES", required = true, value_delimiter = ',', value_parser = dof)]
    pub(crate) joint: Vec<Dof>,
    /// Grams that the peak of each joint must stay under, 30 to 2000
    #[arg(long, value_name = "GRAMS")]
    pub(crate) limit: i16,
    /// Grams that each joint must still hold with, at most 80 % of the limit [default: 40 % of the limit]
    #[arg(long, value_name = "GRAMS")]
    pub(crate) hold: Option<i16>,
    /// Closes that confirm the setting, 5 to 100: 59 hold however the peaks vary, fewer take them to vary normally [default: 59]
    #[arg(long, value_name = "N")]
    pub(crate) closes: Option<usize>,
    /// Let the bound be the largest of fewer closes too, whatever their distribution: 22 closes prove 90 of 100, 59 prove 95
    #[arg(long)]
    pub(crate) distribution_free: bool,
    /// Angle where the joints start, 1000 is open
    #[arg(long, value_name = "ANGLE", default_value = "1000", value_parser = angle)]
    pub(crate) start: Angle,
    /// Angle that the joints close to at most, 0 is bent
    #[arg(long, value_name = "ANGLE", default_value = "0", value_parser = angle)]
    pub(crate) close: Angle,
    /// Angle of a joint that stays still, for example thumb_rotate=300; may be repeated
    #[arg(long, value_name = "NAME=ANGLE", value_parser = place)]
    pub(crate) pose: Vec<(Dof, Angle)>,
    /// Temperature at which the hand is stopped and the search ends; each close starts at least 10 below it
    #[arg(long, value_name = "CELSIUS", default_value = "60", value_parser = clap::value_parser!(u8).range(30..=75))]
    pub(crate) max_temp: u8,
    /// Write samples, metrics, the result and a report to this folder, which must be new or empty
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// A note to store with them
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub(crate) note: String,
    /// A tag to find them by; may be repeated
    #[arg(long = "tag", value_name = "WORD")]
    pub(crate) tags: Vec<String>,
    /// Print one JSON object per close, and a last one for the result
    #[arg(long)]
    pub(crate) json: bool,
}

impl TuneArgs {
    /// The goal, unchecked.
    pub(crate) fn goal(&self) -> SearchGoal {
        let usual = SearchGoal::new(&self.joint, self.limit);
        let close = PerDof::from_fn(|dof| self.joint.contains(&dof).then_some(self.close));
        let mut start = close.map(|target| target.map(|_| self.start));
        for (dof, at) in &self.pose {
            start[*dof] = Some(*at);
        }
        SearchGoal {
            hold_g: self.hold.unwrap_or(usual.hold_g),
            closes: self.closes.unwrap_or(usual.closes),
            distribution_free: self.distribution_free,
            start,
            close,
            limits: Limits {
                stop_c: self.max_temp,
                start_c: self.max_temp.saturating_sub(COOLER_C),
                ..usual.limits
            },
            note: self.note.clone(),
            tags: self.tags.clone(),
            ..usual
        }
    }
}
