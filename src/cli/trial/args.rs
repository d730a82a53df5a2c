//! What `trial` is asked for, as clap sees it, and the plan that it means. Checks no plan.

use crate::app::trial::plan::MARGIN;
use crate::app::trial::{Approach, Criterion, Grid, Limits, TrialPlan, Until};
use crate::cli::args::seconds;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::transport::Endpoint;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;

/// Degrees below the limit at which trials begin.
const COOLER_C: u8 = 10;

#[derive(Debug, Args)]
pub(crate) struct TrialArgs {
    /// The hand to try
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Endpoint,
    /// Yes, move it: nothing but the object is in its way, and the 24 V switch is at hand
    #[arg(long)]
    pub(crate) arm: bool,
    /// Joints that close: little, ring, middle, index, thumb_bend, thumb_rotate; several with commas
    #[arg(long, value_name = "NAMES", required = true, value_delimiter = ',', value_parser = dof)]
    pub(crate) joint: Vec<Dof>,
    /// Where they begin, 1000 open
    #[arg(long, value_name = "ANGLE", default_value = "1000", value_parser = angle)]
    pub(crate) start: Angle,
    /// Where they close to, 0 bent; the force threshold stops them before
    #[arg(long, value_name = "ANGLE", default_value = "0", value_parser = angle)]
    pub(crate) close: Angle,
    /// Where another joint stands meanwhile, for example thumb_rotate=300; may be given several times
    #[arg(long, value_name = "NAME=ANGLE", value_parser = place)]
    pub(crate) pose: Vec<(Dof, Angle)>,
    /// Speeds at the contact, 1 to 1000; several with commas
    #[arg(long, value_name = "SPEEDS", default_value = "25", value_delimiter = ',', value_parser = speed)]
    pub(crate) speed: Vec<Speed>,
    /// Force thresholds in g, 0 to 3000; several with commas
    #[arg(long, value_name = "GRAMS", default_value = "500", value_delimiter = ',', value_parser = force)]
    pub(crate) force: Vec<Force>,
    /// Come at this speed at first, then go on at --speed
    #[arg(long, value_name = "SPEED", value_parser = speed)]
    pub(crate) approach: Option<Speed>,
    /// Until when: angle:520, proximity:8000 (counts more than at the start), touch:20 (g), or measured:40 (so far before
    /// the contact that a first, slow trial finds)
    #[arg(long, value_name = "WHAT", default_value = "measured", requires = "approach", value_parser = until)]
    pub(crate) until: Until,
    /// Seconds held after the stop
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = seconds)]
    pub(crate) dwell: Duration,
    /// Seconds between two trials
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = seconds)]
    pub(crate) rest: Duration,
    /// Trials of each speed with each threshold
    #[arg(long, value_name = "N", default_value = "1")]
    pub(crate) repeat: usize,
    /// Force in g above the reading at rest that ends everything with a stop
    #[arg(long, value_name = "GRAMS", default_value = "2000", value_parser = clap::value_parser!(i16).range(1..=4000))]
    pub(crate) ceiling: i16,
    /// Temperature that ends everything with a stop; trials begin 10 below it
    #[arg(long, value_name = "CELSIUS", default_value = "60", value_parser = clap::value_parser!(u8).range(30..=75))]
    pub(crate) max_temp: u8,
    /// Keep samples, metrics and a report in this folder, which must be new or empty
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// A sentence to keep with them
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub(crate) note: String,
    /// A word to find them by; may be given several times
    #[arg(long = "tag", value_name = "WORD")]
    pub(crate) tags: Vec<String>,
    /// Name the best setting by this
    #[arg(long, value_name = "CRITERION")]
    pub(crate) best: Option<BestArg>,
    /// Steady force in g that the best must hold
    #[arg(long, value_name = "GRAMS", default_value = "0", requires = "best", value_parser = grams)]
    pub(crate) hold: f64,
    /// Overshoot in g that the fastest may have
    #[arg(long, value_name = "GRAMS", default_value = "100", requires = "best", value_parser = grams)]
    pub(crate) overshoot: f64,
    /// One JSON object for each trial, and a last one for all
    #[arg(long)]
    pub(crate) json: bool,
}

/// What is best.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum BestArg {
    /// The least overshoot that still holds
    LeastOvershoot,
    /// The shortest time to the stop, within --overshoot, that still holds
    Fastest,
}

impl TrialArgs {
    /// What is asked for, unchecked.
    pub(crate) fn plan(&self) -> TrialPlan {
        let mut start = PerDof::splat(None);
        let mut close = PerDof::splat(None);
        for (dof, at) in &self.pose {
            start[*dof] = Some(*at);
        }
        for dof in &self.joint {
            start[*dof] = Some(self.start);
            close[*dof] = Some(self.close);
        }
        TrialPlan {
            start,
            close,
            approach: match self.approach {
                None => Approach::OneStage,
                Some(fast) => Approach::TwoStage {
                    fast,
                    until: self.until,
                },
            },
            dwell: self.dwell,
            grid: Grid {
                speeds: self.speed.clone(),
                forces: self.force.clone(),
                repeats: self.repeat,
                rest: self.rest,
            },
            limits: Limits {
                ceiling_g: self.ceiling,
                stop_c: self.max_temp,
                start_c: self.max_temp.saturating_sub(COOLER_C),
            },
        }
    }

    /// What is best, if that is asked.
    pub(crate) fn criterion(&self) -> Option<Criterion> {
        let steady_g = self.hold;
        self.best.map(|best| match best {
            BestArg::LeastOvershoot => Criterion::LeastOvershoot { steady_g },
            BestArg::Fastest => Criterion::Fastest {
                overshoot_g: self.overshoot,
                steady_g,
            },
        })
    }
}

fn dof(text: &str) -> Result<Dof, String> {
    let named = Dof::ALL.into_iter().find(|dof| dof.name() == text);
    named.ok_or_else(|| {
        let known = Dof::ALL.map(Dof::name).join(", ");
        format!("'{text}' is no joint: choose {known}")
    })
}

fn whole(text: &str) -> Result<i64, String> {
    text.parse()
        .map_err(|_not_one| format!("'{text}' is no whole number"))
}

fn angle(text: &str) -> Result<Angle, String> {
    Angle::new(whole(text)?).map_err(|error| error.to_string())
}

fn speed(text: &str) -> Result<Speed, String> {
    Speed::new(whole(text)?).map_err(|error| error.to_string())
}

fn force(text: &str) -> Result<Force, String> {
    Force::new(whole(text)?).map_err(|error| error.to_string())
}

fn grams(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(grams) if (0.0..=4000.0).contains(&grams) => Ok(grams),
        _ => Err(format!("'{text}' is no force between 0 and 4000 g")),
    }
}

fn place(text: &str) -> Result<(Dof, Angle), String> {
    let (name, at) = text
        .split_once('=')
        .ok_or_else(|| format!("'{text}' is no place: write NAME=ANGLE"))?;
    Ok((dof(name)?, angle(at)?))
}

fn until(text: &str) -> Result<Until, String> {
    let (kind, value) = text.split_once(':').unwrap_or((text, ""));
    match (kind, value) {
        ("measured", "") => Ok(Until::Measured { margin: MARGIN }),
        ("measured", margin) => i16::try_from(whole(margin)?)
            .map(|margin| Until::Measured { margin })
            .map_err(|_too_large| format!("a margin of {margin} is too large")),
        ("angle", at) => Ok(Until::Angle(angle(at)?)),
        ("proximity", counts) => i32::try_from(whole(counts)?)
            .map(Until::Proximity)
            .map_err(|_too_large| format!("{counts} counts are too many")),
        ("touch", at) => Ok(Until::Touch(force(at)?)),
        _ => Err(format!(
            "'{text}' is no end of an approach: write angle:520, proximity:8000, touch:20 or measured:40"
        )),
    }
}
