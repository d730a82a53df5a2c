//! `hold`: keeps an object between two forces. It moves the hand, so it requires `--arm`.

use crate::app::files::{pose_file, settings_file};
use crate::checkup::newtons_file;
use crate::cli::grip::gap;
use crate::cli::out::{Out, WrongUsage, notify};
use crate::cli::parse::{hand, seconds};
use crate::cli::session;
use crate::cli::trial::drive::ArmedHand;
use crate::hand::gap::Gap;
use crate::hand::grip::Tightened;
use crate::hand::newtons::N_PER_G;
use crate::hand::overshoot::{OvershootMap, Stiffness};
use crate::hand::statistics::mean;
use crate::hand::{Finger, Force, Moment, PerDof, Speed};
use crate::link::ArmRequest;
use crate::motion::drive::stop_words;
use crate::motion::hold::{
    HeldThing, HoldClose, HoldEnd, HoldForces, HoldPhase, HoldRun, HoldStart, HoldView,
};
use crate::motion::program::{Ended, Progress};
use crate::poses::starter::starter;
use crate::record::Abort;
use crate::transport::Endpoint;
use crate::trials::overshoot_file;
use anyhow::{Context as _, bail};
use clap::Args;
use serde_json::json;
use std::time::Duration;

/// Said when the user ends a hold.
const KEPT: &str = "ended by the user; the hand keeps its position and what it holds";
/// Interval of the lines that show the hold.
const LINE_INTERVAL: Duration = Duration::from_secs(1);

#[derive(Debug, Args)]
pub(crate) struct HoldArgs {
    #[arg(long, value_name = "URL", value_parser = hand)]
    pub(crate) hand: Endpoint,
    /// Move the hand: nothing but the object is in its way, and the 24 V switch is in reach
    #[arg(long)]
    pub(crate) arm: bool,
    /// Close to this pose of the library, until the object stops the fingers
    #[arg(long, value_name = "NAME", conflicts_with = "gap")]
    pub(crate) pose: Option<String>,
    /// Close thumb and index to this many mm between the pads, 3 to 120, until the object stops them
    #[arg(long, value_name = "MM", value_parser = gap, allow_negative_numbers = true)]
    pub(crate) gap: Option<Gap>,
    /// Force of each finger at least: g of this hand, or N with --newtons
    #[arg(
        long,
        value_name = "FORCE",
        default_value = "150",
        value_parser = force,
        allow_negative_numbers = true
    )]
    pub(crate) at_least: f64,
    /// Force of each finger at most
    #[arg(
        long,
        value_name = "FORCE",
        default_value = "400",
        value_parser = force,
        allow_negative_numbers = true
    )]
    pub(crate) at_most: f64,
    /// The forces are newtons, as measured with 'handscope scale'
    #[arg(long)]
    pub(crate) newtons: bool,
    /// Seconds to hold; without it, until Ctrl-C
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,
    /// Print JSON objects, one a line
    #[arg(long)]
    pub(crate) json: bool,
}

fn force(text: &str) -> Result<f64, String> {
    let force = text
        .parse()
        .ok()
        .filter(|force: &f64| force.is_finite() && *force >= 0.0);
    force.ok_or_else(|| {
        format!("'{text}' is not a force: write a number of g, or of N with --newtons")
    })
}

/// Holds. Fails if nothing was held, the object was lost, or it ended early.
pub(crate) async fn run(out: &mut Out, args: &HoldArgs) -> anyhow::Result<()> {
    let forces = forces(args)?;
    let close = close(args)?;
    let newtons = newtons(&args.hand)?;
    let reading_per_g = reading_per_g(args, &newtons)?;
    if !args.arm {
        bail!(
            "nothing was moved: this closes the hand at {} on an object and holds it with {} to {} g; when nothing but the object is in the way, add --arm",
            args.hand,
            forces.at_least().get(),
            forces.at_most().get()
        );
    }
    let limits = ArmRequest {
        speed: PerDof::splat(Speed::nearest(25)),
        force: PerDof::splat(forces.at_least()),
    };
    let mut hand = ArmedHand::ready(&args.hand, limits).await?;
    let start = HoldStart {
        close,
        forces,
        duration: args.duration,
        reading_per_g,
        locked: PerDof::splat(false),
        overshoot: overshoot(&args.hand),
        grip: session::grip_estimator(&args.hand),
    };
    let program = HoldRun::new(hand.armed.epoch, start, hand.armed.clock.now());
    let clock = hand.armed.clock;
    let mut lines = HoldLines {
        args,
        newtons,
        shown: None,
        due: clock.now(),
        view: None,
    };
    let driven = hand
        .run(program, |progress| {
            lines.report(out, clock.now(), progress).is_ok()
        })
        .await;
    let view = lines.view;
    let held = driven.program.held_for(clock.now());
    let done = match driven.end {
        Err(Abort::Person) if held.is_some() => {
            // Also with --json: whether the stop was confirmed is said where it is seen.
            notify(&format!("{KEPT}{}", stop_words(driven.stop)));
            Ok("")
        }
        end => outcome(end),
    };
    let object = json!({ "hold": {
        "hand": args.hand.to_string(),
        "end": end_name(driven.end),
        "seconds_held": held.map(|held| held.as_secs_f64()),
        "at_least_g": forces.at_least(),
        "at_most_g": forces.at_most(),
        "state": driven.program.grip().grasp.state,
        "last": view,
        "stop": driven.stop,
    }});
    let words = done.as_ref().ok().filter(|words| !words.is_empty());
    out.result(args.json, &object, words)?;
    out.flush()?;
    match done {
        Ok(_words) => Ok(()),
        Err(why) => bail!("{why}{}", stop_words(driven.stop)),
    }
}

/// Prints the hold while it lasts.
struct HoldLines<'a> {
    args: &'a HoldArgs,
    newtons: PerDof<Option<f64>>,
    shown: Option<HoldPhase>,
    /// Time of the next line.
    due: Moment,
    view: Option<HoldView>,
}

impl HoldLines<'_> {
    fn report(
        &mut self,
        out: &mut Out,
        now: Moment,
        progress: Progress<HoldView, Tightened>,
    ) -> anyhow::Result<()> {
        match progress {
            Progress::Event(tightened) if self.args.json => {
                out.stream_object(&json!({ "tightened": tightened }))?;
            }
            Progress::View(view) => {
                self.view = Some(view);
                let is_due = now >= self.due || self.shown != Some(view.phase);
                if is_due {
                    self.due = now.plus(LINE_INTERVAL);
                    self.shown = Some(view.phase);
                    if self.args.json {
                        out.stream_object(&json!({ "holding": view }))?;
                    } else {
                        out.stream_line(&self.line(&view))?;
                    }
                }
            }
            Progress::Event(_) | Progress::Sent(_) => {}
        }
        out.shown()
    }

    fn line(&self, view: &HoldView) -> String {
        let force = match view.mean_g() {
            None => "nothing yet".into(),
            Some(g) => format!("{g} g{}", self.in_newtons(view)),
        };
        let margin = view.margin_percent;
        let margin = margin.map_or("unknown".into(), |percent| format!("{percent} %"));
        let tightened = match view.last {
            None => "not tightened".into(),
            Some(last) => format!(
                "tightened {} times, last: {} ({})",
                view.tightened,
                last.finger.name(),
                last.cause.name()
            ),
        };
        let warm = if view.is_warm {
            "; a drive is warm"
        } else {
            ""
        };
        match view.phase {
            HoldPhase::Measuring => "measuring the zero of the force sensors".into(),
            HoldPhase::Closing => "closing".into(),
            HoldPhase::Holding => {
                let thing = view.thing.map_or(String::new(), |thing| held_words(&thing));
                format!("holding with {force}, margin {margin}; {tightened}{warm}{thing}")
            }
            HoldPhase::CannotHold => format!(
                "CANNOT HOLD within {} g: pressing with {force}, margin {margin}; {tightened}{warm}",
                view.forces.at_most().get()
            ),
        }
    }

    /// Mean force in newtons, if all fingers that hold were measured.
    fn in_newtons(&self, view: &HoldView) -> String {
        let held = view
            .force_g
            .iter()
            .filter_map(|(finger, g)| Some((finger, (*g)?)));
        let newtons: Option<Vec<f64>> = held
            .map(|(finger, g)| Some(f64::from(g) * self.newtons[finger.bend()]?))
            .collect();
        newtons
            .and_then(|all| mean(&all))
            .map_or(String::new(), |mean| format!(" ({mean:.1} N)"))
    }
}

/// What is held, as far as it is known.
fn held_words(thing: &HeldThing) -> String {
    let gap = thing.gap_mm.map(|mm| format!("pads {mm:.0} mm apart"));
    let stiffness = match thing.stiffness {
        Stiffness::Unknown => None,
        known => Some(known.name().to_owned()),
    };
    let load = thing.load_g.map(|g| format!("load {g} g"));
    let all: Vec<String> = [gap, stiffness, load].into_iter().flatten().collect();
    if all.is_empty() {
        String::new()
    } else {
        format!("; held: {}", all.join(", "))
    }
}

fn forces(args: &HoldArgs) -> anyhow::Result<HoldForces> {
    let (unit, per_g) = if args.newtons {
        ("N", N_PER_G)
    } else {
        ("g", 1.0)
    };
    let grams = |option: &str, value: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "the range is checked next")]
        let whole = (value / per_g).round() as i64;
        Force::new(whole).map_err(|_out| {
            let most = (f64::from(Force::MAX.get()) * per_g).floor();
            WrongUsage::error(format!(
                "--{option} {value} {unit} is more than a threshold can be: at most {most} {unit}"
            ))
        })
    };
    let (least, most) = (
        grams("at-least", args.at_least)?,
        grams("at-most", args.at_most)?,
    );
    HoldForces::new(least, most).map_err(|error| WrongUsage::error(error.to_string()))
}

fn close(args: &HoldArgs) -> anyhow::Result<HoldClose> {
    if let Some(gap) = args.gap {
        return Ok(HoldClose::Pinch(gap));
    }
    let Some(name) = &args.pose else {
        return Ok(HoldClose::TakeOver);
    };
    let own = settings_file::default_path().map(|settings| pose_file::path_beside(&settings));
    let own = own
        .filter(|path| path.exists())
        .map(|path| pose_file::read(&path));
    let own = own
        .transpose()
        .map_err(|error| anyhow::anyhow!("{error}"))?;
    let pose = own.as_ref().and_then(|own| own.pose_named(name));
    let pose = pose.or_else(|| starter().pose_named(name)).ok_or_else(|| {
        let names = starter().poses.iter().map(|pose| pose.name.as_str());
        let names: Vec<&str> = names.collect();
        WrongUsage::error(format!(
            "there is no pose '{name}': write one of the library's, such as {}",
            names.join(", ")
        ))
    })?;
    Ok(match pose.gap {
        Some(gap) => HoldClose::Pinch(gap),
        None => HoldClose::To(pose.targets()),
    })
}

/// Newtons of each joint for a reading of one gram, where they were measured.
fn newtons(hand: &Endpoint) -> anyhow::Result<PerDof<Option<f64>>> {
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| newtons_file::file_of(&settings, hand));
    let Some(file) = file else {
        return Ok(PerDof::splat(None));
    };
    let known =
        newtons_file::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
    Ok(known.per_g())
}

fn reading_per_g(args: &HoldArgs, newtons: &PerDof<Option<f64>>) -> anyhow::Result<PerDof<f64>> {
    if !args.newtons {
        return Ok(PerDof::splat(1.0));
    }
    let unknown = Finger::ALL
        .map(Finger::bend)
        .into_iter()
        .find(|dof| newtons[*dof].is_none());
    if let Some(dof) = unknown {
        bail!(
            "nothing was moved: the newtons of {} of this hand are not known; 'handscope scale --joint {}' measures them",
            dof.name(),
            dof.name()
        );
    }
    Ok(newtons.map(|newtons| newtons.map_or(1.0, |newtons| N_PER_G / newtons)))
}

fn overshoot(hand: &Endpoint) -> OvershootMap {
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| overshoot_file::file_of(&settings, hand));
    file.and_then(|file| overshoot_file::read(&file).ok())
        .unwrap_or_default()
}

/// The outcome in one sentence; `Err` for failures.
fn outcome(end: Ended<HoldEnd>) -> Result<&'static str, String> {
    match end {
        Ok(HoldEnd::Held) => Ok("held; the hand keeps its position and what it holds"),
        Ok(HoldEnd::Nothing) => Err(
            "the hand holds nothing: put the object in its place, and name a pose or a gap with --pose or --gap".into(),
        ),
        Ok(HoldEnd::Lost) => Err("the object left the hand".into()),
        Ok(HoldEnd::Late) => Err("the hand did not get there in time".into()),
        Err(why) => Err(why.to_string()),
    }
}

const fn end_name(end: Ended<HoldEnd>) -> &'static str {
    match end {
        Ok(HoldEnd::Held) => "held",
        Ok(HoldEnd::Nothing) => "nothing",
        Ok(HoldEnd::Lost) => "lost",
        Ok(HoldEnd::Late) => "late",
        Err(why) => session::early_end(why),
    }
}
