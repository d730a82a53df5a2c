//! The command line of `trial` as clap sees it, the plan that it defines, and the options that `tune` shares with it.

use crate::cli::out::WrongUsage;
use crate::cli::parse::{angle, dof, force, number, seconds, speed, whole};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::transport::Endpoint;
use crate::trials::plan::MARGIN;
use crate::trials::{Approach, Criterion, Limits, TrialGrid, TrialPlan, Until};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::time::Duration;

/// Degrees below the limit at which trials start.
const COOLER_C: u8 = 10;

/// The options of every command that closes joints on an object: the hand, the joints, their poses, and where the results go.
#[derive(Debug, Args)]
pub(crate) struct SeriesArgs {
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Move the hand: nothing but the object is in its way, and the 24 V switch is in reach
    #[arg(long)]
    pub(crate) arm: bool,
    /// Joints that close, separated by commas: little, ring, middle, index, thumb_bend, thumb_rotate
    #[arg(long, value_name = "NAMES", required = true, value_delimiter = ',', value_parser = dof)]
    joint: Vec<Dof>,
    /// Angle where the joints start, 1000 is open
    #[arg(long, value_name = "ANGLE", default_value = "1000", value_parser = angle)]
    start: Angle,
    /// Angle that the joints close to at most, 0 is bent; the force threshold stops them earlier
    #[arg(long, value_name = "ANGLE", default_value = "0", value_parser = angle)]
    close: Angle,
    /// Angle of a joint that stays still, for example thumb_rotate=300; may be repeated
    #[arg(long, value_name = "NAME=ANGLE", value_parser = place)]
    pose: Vec<(Dof, Angle)>,
    /// Temperature at which the hand is stopped and the command ends; each trial starts at least 10 below it
    #[arg(long, value_name = "CELSIUS", default_value = "60", value_parser = clap::value_parser!(u8).range(30..=75))]
    max_temp: u8,
    /// Write samples, metrics and a report to this folder, which must be new or empty
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// A note to store with them
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub(crate) note: String,
    /// A tag to find them by; may be repeated
    #[arg(long = "tag", value_name = "WORD")]
    pub(crate) tags: Vec<String>,
    /// The hand that is reached by way of --hand, where that is shared: what is known of it applies
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand, hide = true)]
    known_as: Option<Endpoint>,
    /// Print one JSON object per trial, and a last one for the result
    #[arg(long)]
    pub(crate) json: bool,
}

impl SeriesArgs {
    /// The hand whose measurements apply, and to which the results belong.
    pub(crate) fn own_hand(&self) -> &Endpoint {
        self.known_as.as_ref().unwrap_or(&self.hand)
    }

    /// Joints that close.
    pub(crate) fn joints(&self) -> &[Dof] {
        &self.joint
    }

    /// Targets of the joints that close.
    pub(crate) fn closed(&self) -> PerDof<Option<Angle>> {
        PerDof::from_fn(|dof| self.joint.contains(&dof).then_some(self.close))
    }

    /// Targets before each trial, also of joints that stay still.
    pub(crate) fn start_pose(&self) -> PerDof<Option<Angle>> {
        let mut start = self.closed().map(|target| target.map(|_| self.start));
        for (dof, at) in &self.pose {
            start[*dof] = Some(*at);
        }
        start
    }

    /// These limits with the given temperature.
    pub(crate) fn limits(&self, limits: Limits) -> Limits {
        Limits {
            stop_c: self.max_temp,
            start_c: self.max_temp.saturating_sub(COOLER_C),
            ..limits
        }
    }

    /// Checks that each joint is named once: it either closes or stays still.
    pub(crate) fn check_joints(&self) -> anyhow::Result<()> {
        for dof in &self.joint {
            if self.joint.iter().filter(|one| *one == dof).count() > 1 {
                return Err(WrongUsage::error(format!(
                    "--joint names {} twice",
                    dof.name()
                )));
            }
        }
        for (dof, at) in &self.pose {
            let (name, at) = (dof.name(), at.get());
            if self.joint.contains(dof) {
                return Err(WrongUsage::error(format!(
                    "{name} closes and so cannot stay still: leave out --pose {name}={at}, or take {name} out of --joint"
                )));
            }
            if self.pose.iter().filter(|(one, _)| one == dof).count() > 1 {
                return Err(WrongUsage::error(format!("--pose names {name} twice")));
            }
        }
        Ok(())
    }
}

#[derive(Debug, Args)]
pub(crate) struct TrialArgs {
    #[command(flatten)]
    pub(crate) series: SeriesArgs,
    /// Speeds at the contact, 1 to 1000, separated by commas
    #[arg(long, value_name = "SPEEDS", default_value = "25", value_delimiter = ',', value_parser = speed)]
    speed: Vec<Speed>,
    /// Force thresholds in g, 0 to 3000, separated by commas
    #[arg(long, value_name = "GRAMS", default_value = "500", value_delimiter = ',', value_parser = force)]
    force: Vec<Force>,
    /// Approach at this speed, then continue at --speed
    #[arg(long, value_name = "SPEED", value_parser = speed)]
    approach: Option<Speed>,
    /// End of the approach: angle:520, proximity:8000 (counts above the start), touch:20 (g), or measured:40 (this far
    /// before the contact found by a first, slow trial)
    #[arg(long, value_name = "WHAT", default_value = "measured", requires = "approach", value_parser = until)]
    until: Until,
    /// Seconds to hold after the stop
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = seconds)]
    dwell: Duration,
    /// Seconds between two trials
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = seconds)]
    rest: Duration,
    /// Trials of each speed with each threshold
    #[arg(long, value_name = "N", default_value = "1")]
    repeat: usize,
    /// Force in g above the reading at rest at which the hand is stopped and the series ends
    #[arg(long, value_name = "GRAMS", default_value = "2000", value_parser = clap::value_parser!(i16).range(1..=4000))]
    ceiling: i16,
    /// Name the best setting by this criterion
    #[arg(long, value_name = "CRITERION")]
    best: Option<BestArg>,
    /// Steady force in g that the best must hold
    #[arg(long, value_name = "GRAMS", default_value = "0", requires = "best", value_parser = grams)]
    hold: f64,
    /// Overshoot in g that the fastest may have
    #[arg(long, value_name = "GRAMS", default_value = "100", requires = "best", value_parser = grams)]
    overshoot: f64,
}

/// A criterion for the best setting.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum BestArg {
    /// The least overshoot that still holds
    LeastOvershoot,
    /// The shortest time to the stop, within --overshoot, that still holds
    Fastest,
}

impl TrialArgs {
    /// The plan, unchecked.
    pub(crate) fn plan(&self) -> TrialPlan {
        let series = &self.series;
        TrialPlan {
            start: series.start_pose(),
            close: series.closed(),
            approach: match self.approach {
                None => Approach::OneStage,
                Some(fast) => Approach::TwoStage {
                    fast,
                    until: self.until,
                },
            },
            dwell: self.dwell,
            grid: TrialGrid {
                speeds: self.speed.clone(),
                forces: self.force.clone(),
                repeats: self.repeat,
                rest: self.rest,
            },
            limits: series.limits(Limits {
                ceiling_g: self.ceiling,
                ..Limits::default()
            }),
            note: series.note.clone(),
            tags: series.tags.clone(),
            ..TrialPlan::default()
        }
    }

    /// Criterion for the best setting, if given.
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

fn grams(text: &str) -> Result<f64, String> {
    number(text, 0.0..=4000.0, "a force between 0 and 4000 g")
}

fn place(text: &str) -> Result<(Dof, Angle), String> {
    let (name, at) = text
        .split_once('=')
        .ok_or_else(|| format!("'{text}' is not NAME=ANGLE"))?;
    Ok((dof(name)?, angle(at)?))
}

fn until(text: &str) -> Result<Until, String> {
    let (kind, value) = text.split_once(':').unwrap_or((text, ""));
    let value = match (kind, value) {
        ("measured", "") => MARGIN.into(),
        (_, value) => whole(value)?,
    };
    let name = if kind == "touch" { "touch_g" } else { kind };
    Until::new(name, value).map_err(|error| error.to_string())
}
