//! The command line of `tune` as clap sees it, and the goal that it defines.

use crate::cli::trial::args::SeriesArgs;
use crate::trials::search::SearchGoal;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    #[command(flatten)]
    pub(crate) series: SeriesArgs,
    /// Grams that the peak of each joint must stay under, 30 to 2000
    #[arg(long, value_name = "GRAMS")]
    limit: i16,
    /// Grams that each joint must still hold with, at most 80 % of the limit [default: 40 % of the limit]
    #[arg(long, value_name = "GRAMS")]
    hold: Option<i16>,
    /// Closes that confirm the setting, 5 to 100: 59 hold however the peaks vary, fewer take them to vary normally [default: 59]
    #[arg(long, value_name = "N")]
    closes: Option<usize>,
    /// Let the bound be the largest of fewer closes too, whatever their distribution: 22 closes prove 90 of 100, 59 prove 95
    #[arg(long)]
    distribution_free: bool,
}

impl TuneArgs {
    /// The goal, unchecked.
    pub(crate) fn goal(&self) -> SearchGoal {
        let series = &self.series;
        let usual = SearchGoal::new(series.joints(), self.limit);
        SearchGoal {
            hold_g: self.hold.unwrap_or(usual.hold_g),
            closes: self.closes.unwrap_or(usual.closes),
            distribution_free: self.distribution_free,
            start: series.start_pose(),
            close: series.closed(),
            limits: series.limits(usual.limits),
            note: series.note.clone(),
            tags: series.tags.clone(),
            ..usual
        }
    }
}
