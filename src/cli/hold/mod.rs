//! `hold`: keeps an object between two forces. It moves the hand, so it requires `--arm`.

mod grasp;

use crate::app::files::{pose_file, settings_file};
use crate::checkup::newtons_file;
use crate::cli::consent::{ConsentFrom, can_answer};
use crate::cli::grip::gap;
use crate::cli::hold::grasp::{
    AskedClose, ChosenGrasp, GraspPlace, Trust, grasp_place, note, put_down,
};
use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, WrongUsage, notify};
use crate::cli::parse::{hand, seconds};
use crate::cli::session;
use crate::cli::trial::drive::{ArmedHand, by_user};
use crate::hand::gap::Gap;
use crate::hand::grip::Tightened;
use crate::hand::hold_forces::HoldForces;
use crate::hand::newtons::ForceUnit;
use crate::hand::overshoot::{OvershootMap, Stiffness};
use crate::hand::statistics::mean;
use crate::hand::{Dof, Finger, Force, Moment, PerDof, Speed};
use crate::link::ArmRequest;
use crate::motion::drive::{drive, stop_words};
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::grasp::run::{
    ConfirmStep, Confirming, GraspInput, GraspRun, GraspStart, GraspView,
};
use crate::motion::grasp::seen::GraspLabel;
use crate::motion::held_object::{Bounded, HeldObject};
use crate::motion::hold::{HoldClose, HoldEnd, HoldPhase, HoldStart, HoldView};
use crate::motion::program::{Ended, Progress};
use crate::poses::library::LibraryPose;
use crate::poses::starter::starter;
use crate::record::Abort;
use crate::store::calendar::{day, since_1970};
use crate::transport::Endpoint;
use crate::trials::overshoot_file;
use anyhow::{Context as _, anyhow, bail};
use clap::Args;
use futures::{StreamExt as _, stream};
use serde_json::json;
use std::cell::{Cell, RefCell};
use std::path::PathBuf;
use std::time::Duration;
use tokio::sync::watch;

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
    /// The forces are newtons, as measured with 'handscope scale'; needs both
    #[arg(long, requires_all = ["at_least", "at_most"])]
    pub(crate) newtons: bool,
    /// Seconds to hold; without it, until Ctrl-C
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) duration: Option<Duration>,
    /// Save the hold as a grasp if it works: a name for the pose library, or a new file *.grasp.toml
    #[arg(long, value_name = "NAME", value_parser = grasp_place)]
    pub(crate) save: Option<GraspPlace>,
    /// Note in the grasp file
    #[arg(long, value_name = "TEXT", requires = "save", value_parser = note)]
    pub(crate) note: Option<String>,
    /// Results of 'handscope tune --out' with this hand and object, whose claim the grasp file repeats
    #[arg(long, value_name = "FOLDER", requires = "save")]
    pub(crate) tuned: Option<PathBuf>,
    /// Hold as this grasp: a name of the pose library, or a file *.grasp.toml. Another hand confirms it first
    #[arg(
        long,
        value_name = "NAME",
        value_parser = grasp_place,
        conflicts_with_all = ["pose", "gap", "at_least", "at_most", "newtons"]
    )]
    pub(crate) grasp: Option<GraspPlace>,
    /// Take a line of standard input for the word that the object stands, also where that is no terminal: one that comes after the question
    #[arg(long, value_name = "FROM", requires = "grasp")]
    pub(crate) consent: Option<ConsentFrom>,
    /// The hand that is reached by way of --hand, where that is shared: what is known of it applies
    #[arg(long, value_name = "URL", value_parser = hand, hide = true)]
    pub(crate) known_as: Option<Endpoint>,
    /// Print JSON objects, one a line
    #[arg(long)]
    pub(crate) json: bool,
}

impl HoldArgs {
    const fn unit(&self) -> ForceUnit {
        match self.newtons {
            true => ForceUnit::Newtons,
            false => ForceUnit::Grams,
        }
    }

    /// The hand whose measurements and confirmations apply.
    fn own_hand(&self) -> &Endpoint {
        self.known_as.as_ref().unwrap_or(&self.hand)
    }
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
    let newtons = newtons(args.own_hand())?;
    let mut asked = AskedHold::of(args, newtons)?;
    if !args.arm {
        return Err(FailureKind::NotArmed.error(asked.unarmed(args)));
    }
    if asked.is_unconfirmed() {
        can_answer(args.consent).map_err(|nobody| anyhow!("nothing was moved: {nobody}"))?;
    }
    let limits = ArmRequest {
        speed: PerDof::splat(Speed::nearest(25)),
        force: PerDof::splat(asked.forces.at_least()),
    };
    let mut hand = ArmedHand::ready(&args.hand, limits).await?;
    let program = GraspRun::new(hand.armed.epoch, asked.start(args), hand.armed.clock.now());
    let clock = hand.armed.clock;
    let (question, questions) = watch::channel(None);
    let lines = RefCell::new(HoldLines {
        out,
        args,
        newtons,
        shown: None,
        due: clock.now(),
        view: None,
        question,
    });
    let refused = Cell::new(None);
    let words = put_down(questions, args.consent, |close| {
        lines.borrow_mut().ask(close);
    });
    let words = words.map(|word| match word {
        Ok(()) => GraspInput::PutDown,
        Err(nobody) => {
            refused.set(Some(nobody.to_string()));
            GraspInput::Abort(Abort::Person)
        }
    });
    let ends = by_user(&mut hand.interrupt).map(GraspInput::Abort);
    let report = |progress| lines.borrow_mut().report(clock.now(), progress).is_ok();
    let inputs = stream::select(ends, words);
    let driven = drive(&hand.link, hand.armed, program, inputs, report).await;
    hand.release(driven.stop).await;
    let HoldLines { out, view, .. } = lines.into_inner();
    let refused = refused.into_inner();
    let held = driven.program.held_for(clock.now());
    if let (Some(chosen), Some(agreement)) = (&mut asked.chosen, driven.program.agreement()) {
        chosen.keep(args.own_hand(), agreement);
    }
    let saved = asked.save(&driven.program, clock.now());
    let done = match driven.end {
        Err(Abort::Person) if refused.is_some() => {
            let nobody = refused.as_deref().unwrap_or_default();
            Err(format!(
                "the grasp is not confirmed, as {nobody}; the hand keeps its position"
            ))
        }
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
        "at_least_g": asked.forces.at_least(),
        "at_most_g": asked.forces.at_most(),
        "state": driven.program.grip().grasp.state,
        "last": view,
        "stop": driven.stop,
        "grasp": asked.chosen.as_ref().map(|chosen| &chosen.grasp.name),
        "trust": asked.chosen.as_ref().map(|chosen| chosen.trust),
        "agreement": driven.program.agreement(),
        "doubt": doubt(driven.end).map(|doubt| doubt.to_string()).or(refused),
        "saved": saved.as_ref().ok().and_then(|saved| saved.as_ref()?.to_str()),
        "not_saved": saved.as_ref().err().map(|why| format!("{why:#}")),
    }});
    let words = done.as_ref().ok().filter(|words| !words.is_empty());
    let path = saved.as_ref().ok().and_then(Option::as_ref);
    let line = path.map(|path| format!("saved in {}", path.display()));
    let lines = words
        .into_iter()
        .map(|words| (*words).to_owned())
        .chain(line);
    let shown = out
        .result(args.json, &object, lines)
        .and_then(|()| out.flush());
    session::printed(shown, driven.end, driven.stop)?;
    match (done, saved) {
        (Ok(_words), Ok(_path)) => Ok(()),
        (Ok(_words), Err(why)) => bail!("the grasp is not saved: {why:#}"),
        (Err(why), _) => bail!("{why}{}", stop_words(driven.stop)),
    }
}

/// A hold as the user asked for it.
struct AskedHold {
    close: HoldClose,
    forces: HoldForces,
    reading_per_g: PerDof<f64>,
    /// The grasp that it repeats.
    chosen: Option<ChosenGrasp>,
    /// The grasp that it becomes if it works, and its file.
    about: Option<(GraspLabel, PathBuf)>,
}

impl AskedHold {
    fn of(args: &HoldArgs, newtons: PerDof<Option<f64>>) -> anyhow::Result<Self> {
        let place = args.grasp.as_ref();
        let chosen = place.map(|place| ChosenGrasp::read(place, args.own_hand(), newtons));
        let chosen = chosen.transpose()?;
        let (close, forces, reading_per_g) = match &chosen {
            Some(own) => (own.grasp.close.way, own.grasp.forces, own.reading_per_g),
            None => (close(args)?, forces(args)?, reading_per_g(args, &newtons)?),
        };
        let repeated = chosen.as_ref().and_then(|own| own.grasp.close.pose.clone());
        let about = args.save.as_ref().map(|place| {
            let claim = args.tuned.as_ref();
            let claim = claim.map(|folder| grasp::claim(folder, args.own_hand()));
            let about = GraspLabel {
                name: place.name(),
                note: args.note.clone().unwrap_or_default(),
                day: day(since_1970()),
                hand: args.own_hand().clone(),
                pose: repeated.or_else(|| args.pose.clone()),
                newtons,
                claim: claim.transpose()?,
            };
            anyhow::Ok((about, place.free()?))
        });
        Ok(Self {
            close,
            forces,
            reading_per_g,
            chosen,
            about: about.transpose()?,
        })
    }

    /// True if the hand confirms the grasp first.
    fn is_unconfirmed(&self) -> bool {
        let chosen = self.chosen.as_ref();
        chosen.is_some_and(|own| own.trust == Trust::NotConfirmed)
    }

    fn unarmed(&self, args: &HoldArgs) -> String {
        let five = match &self.chosen {
            Some(own) if own.trust == Trust::NotConfirmed => {
                format!(" after five closes that confirm '{}'", own.grasp.name)
            }
            _ => String::new(),
        };
        format!(
            "nothing was moved: this closes the hand at {} on an object and holds it with {} to {} g{five}; when nothing but the object is in the way, add --arm",
            args.hand,
            self.forces.at_least().get(),
            self.forces.at_most().get()
        )
    }

    fn start(&self, args: &HoldArgs) -> GraspStart {
        GraspStart {
            hold: HoldStart {
                close: self.close,
                forces: self.forces,
                duration: args.duration,
                reading_per_g: self.reading_per_g,
                locked: PerDof::splat(false),
                overshoot: overshoot(args.own_hand()),
                blocks: session::size_blocks(args.own_hand()),
                grip: session::grip_estimator(args.own_hand()),
            },
            unconfirmed: self.chosen.as_ref().and_then(ChosenGrasp::unconfirmed),
        }
    }

    /// Saves the hold if the user asked for it. Returns the file.
    fn save(&self, run: &GraspRun, now: Moment) -> anyhow::Result<Option<PathBuf>> {
        let Some((about, path)) = &self.about else {
            return Ok(None);
        };
        let grasp = run.grasp(about.clone(), now)?;
        grasp::save(path, &grasp)?;
        Ok(Some(path.clone()))
    }
}

/// Prints the hold while it lasts, and what it asks.
struct HoldLines<'a> {
    out: &'a mut Out,
    args: &'a HoldArgs,
    newtons: PerDof<Option<f64>>,
    shown: Option<(HoldPhase, Option<Confirming>)>,
    /// Time of the next line.
    due: Moment,
    view: Option<GraspView>,
    /// The close that waits for the user's word.
    question: watch::Sender<AskedClose>,
}

impl HoldLines<'_> {
    /// Asks whether the object stands.
    fn ask(&mut self, Confirming { close, of, .. }: Confirming) {
        let how = match self.args.consent {
            None => "press Enter once the object stands by itself, Ctrl-C to keep it",
            Some(ConsentFrom::Stdin) => "enter a line once the object stands by itself",
        };
        notify(&format!(
            "confirming {close} of {of}: the load is gone; {how}: then the hand opens"
        ));
        if self.args.json {
            // A line that is not printed ends the hold with the next report.
            let _shown = self
                .out
                .object(&json!({ "ask": { "close": close, "of": of }}))
                .and_then(|()| self.out.flush());
        }
    }

    fn report(
        &mut self,
        now: Moment,
        progress: Progress<GraspView, Tightened>,
    ) -> anyhow::Result<()> {
        match progress {
            Progress::Event(tightened) if self.args.json => {
                self.out.stream_object(&json!({ "tightened": tightened }))?;
            }
            Progress::View(view) => {
                self.view = Some(view);
                let asked = view.confirming;
                let asked = asked.filter(|own| own.step == ConfirmStep::Release);
                self.question.send_replace(asked);
                let part = (view.hold.phase, view.confirming);
                let is_due = now >= self.due || self.shown != Some(part);
                if is_due {
                    self.due = now.plus(LINE_INTERVAL);
                    self.shown = Some(part);
                    if self.args.json {
                        self.out.stream_object(&json!({ "holding": view }))?;
                    } else {
                        let confirming = view.confirming.map_or(String::new(), confirm_words);
                        self.out
                            .stream_line(&format!("{confirming}{}", self.line(&view.hold)))?;
                    }
                }
            }
            Progress::Event(_) | Progress::Sent(_) => {}
        }
        self.out.shown()
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
                let object = view.object.map(|object| object_words(&object));
                let object = object.map_or(String::new(), |words| format!("; {words}"));
                format!("holding with {force}, margin {margin}; {tightened}{warm}{object}")
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

/// The close under way, and what the user does in it.
fn confirm_words(confirming: Confirming) -> String {
    let Confirming { close, of, step } = confirming;
    let step = match step {
        ConfirmStep::Close => "the object lies in its place",
        ConfirmStep::Lift => "LIFT the object and use it, without turning the hand",
        ConfirmStep::PutDown => "use it, then PUT IT DOWN",
        ConfirmStep::Release => "the load is gone; say so once the object stands by itself",
        ConfirmStep::Open => "opening; put the object back in its place",
    };
    format!("confirming {close} of {of}: {step}; ")
}

/// What the fingers cannot show.
const CANNOT_TELL: &str = "cannot tell";

/// What is in the hand.
fn object_words(object: &HeldObject) -> String {
    let bounded = |own: Option<Bounded>, unit: &str| match own {
        Some(own) => format!("{:.0} ±{:.0} {unit}", own.value, own.bound),
        None => CANNOT_TELL.into(),
    };
    let stiffness = match object.stiffness {
        Stiffness::Unknown => CANNOT_TELL,
        known => known.name(),
    };
    let yields = match object.yields {
        Some(true) => "yes",
        Some(false) => "no",
        None => CANNOT_TELL,
    };
    format!(
        "in the hand: size {}, stiffness {stiffness}, yields: {yields}, weight {}",
        bounded(object.size_mm, "mm"),
        bounded(object.weight_g, "g"),
    )
}

fn forces(args: &HoldArgs) -> anyhow::Result<HoldForces> {
    let unit = if args.newtons { "N" } else { "g" };
    let per_g = args.unit().per_g();
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
    let pose = pose(name)?;
    Ok(match pose.gap {
        Some(gap) => HoldClose::Pinch(gap),
        None => HoldClose::To(pose.targets()),
    })
}

/// The pose of this name.
pub(crate) fn pose(name: &str) -> anyhow::Result<LibraryPose> {
    let named = pose_file::named(name).map_err(|error| anyhow::anyhow!("{error}"))?;
    named.ok_or_else(|| {
        let names = starter().poses.iter().map(|pose| pose.name.as_str());
        let names: Vec<&str> = names.collect();
        WrongUsage::error(format!(
            "there is no pose '{name}': write one of the library's, such as {}",
            names.join(", ")
        ))
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
    if let Some(reading_per_g) = args.unit().reading_per_g(newtons) {
        return Ok(reading_per_g);
    }
    let unknown = Finger::ALL
        .map(Finger::bend)
        .into_iter()
        .find(|dof| newtons[*dof].is_none());
    let name = unknown.map_or("a finger", Dof::name);
    bail!(
        "nothing was moved: the newtons of {name} of this hand are not known; 'handscope scale --joint {name}' measures them"
    );
}

/// Overshoot measured on this hand. An unreadable file counts as missing.
pub(crate) fn overshoot(hand: &Endpoint) -> OvershootMap {
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| overshoot_file::file_of(&settings, hand));
    file.and_then(|file| overshoot_file::read(&file).ok())
        .unwrap_or_default()
}

/// The doubt that ended a confirmation.
const fn doubt(end: Ended<Result<HoldEnd, GraspDoubt>>) -> Option<GraspDoubt> {
    match end {
        Ok(Err(doubt)) => Some(doubt),
        _ => None,
    }
}

/// The outcome in one sentence; `Err` for failures.
fn outcome(end: Ended<Result<HoldEnd, GraspDoubt>>) -> Result<&'static str, String> {
    match end {
        Ok(Ok(HoldEnd::Held)) => Ok("held; the hand keeps its position and what it holds"),
        Ok(Ok(HoldEnd::Nothing)) => Err(
            "the hand holds nothing: put the object in its place, and name a pose or a gap with --pose or --gap".into(),
        ),
        Ok(Ok(HoldEnd::Lost)) => Err("the object left the hand".into()),
        Ok(Ok(HoldEnd::Late)) => Err("the hand did not get there in time".into()),
        Ok(Err(doubt)) => Err(format!(
            "the grasp is not trusted on this hand: {doubt}; the hand keeps its position"
        )),
        Err(why) => Err(why.to_string()),
    }
}

const fn end_name(end: Ended<Result<HoldEnd, GraspDoubt>>) -> &'static str {
    match end {
        Ok(Ok(HoldEnd::Held)) => "held",
        Ok(Ok(HoldEnd::Nothing)) => "nothing",
        Ok(Ok(HoldEnd::Lost)) => "lost",
        Ok(Ok(HoldEnd::Late)) => "late",
        Ok(Err(_)) => "not_confirmed",
        Err(why) => session::early_end(why),
    }
}
