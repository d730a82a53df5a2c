//! `scale`: newtons of a hand's joints, from presses on a kitchen scale. Only `--arm` moves the hand; otherwise it shows, exports or
//! forgets what is known.

use crate::app::files::settings_file;
use crate::checkup::newtons_file;
use crate::cli::out::failure::FailureKind;
use crate::cli::out::{Out, WrongUsage, notify};
use crate::cli::parse::{dof, hand, number};
use crate::cli::session;
use crate::cli::trial::drive::{ArmedHand, by_user};
use crate::hand::newtons::{
    Contradiction, ForceScale, JointPoints, LEAST_LIMIT_G, LOADS, MOST_LIMIT_G, NewtonsMap,
    READING_MAX_G, ScalePoint,
};
use crate::hand::{Dof, Finger, Force};
use crate::link::{ArmRequest, Stop};
use crate::motion::drive::stop_words;
use crate::motion::program::{Ended, Progress};
use crate::motion::scale::{ScaleEnd, ScaleEvent, ScaleInput, ScaleStart, calibrate};
use crate::record::Abort;
use crate::store::calendar::{day, since_1970};
use crate::transport::Endpoint;
use anyhow::{Context as _, bail};
use clap::Args;
use futures::{Stream, StreamExt as _, stream};
use serde_json::{Value, json};
use std::io::{BufRead as _, Read as _};
use std::path::{Path, PathBuf};
use tokio::sync::mpsc;

/// Capacity of the queue of typed lines.
const LINES_MAX: usize = 8;
/// Maximum length of a typed line, bytes; the rest is read as another one.
const LINE_MAX: u64 = 256;

#[derive(Debug, Args)]
pub(crate) struct ScaleArgs {
    #[arg(long, value_name = "URL", value_parser = hand)]
    pub(crate) hand: Endpoint,
    /// Joint that presses the scale: little, ring, middle, index, thumb_bend
    #[arg(long, value_name = "JOINT", value_parser = bending)]
    pub(crate) joint: Option<Dof>,
    /// Move the hand: nothing but the scale is in its way, and the 24 V switch is in reach
    #[arg(long, requires = "joint", conflicts_with_all = ["out", "forget"])]
    pub(crate) arm: bool,
    /// Largest force in g of the hand, 250 to 1000
    #[arg(long, value_name = "GRAMS", default_value = "400", value_parser = limit, allow_negative_numbers = true)]
    pub(crate) limit: Force,
    /// Print JSON objects
    #[arg(long)]
    pub(crate) json: bool,
    /// Also write what is known to this file: *.json, or else a table for spreadsheets
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Forget all of it once it is printed and written; with --joint only that joint
    #[arg(long)]
    pub(crate) forget: bool,
}

/// A joint that bends a finger: the thumb's rotation presses with no pad.
fn bending(text: &str) -> Result<Dof, String> {
    let joint = dof(text)?;
    match Finger::ALL.into_iter().any(|finger| finger.bend() == joint) {
        true => Ok(joint),
        false => Err("it presses with no fingertip: choose a joint that bends a finger".into()),
    }
}

fn limit(text: &str) -> Result<Force, String> {
    let what = format!("a limit of {LEAST_LIMIT_G} to {MOST_LIMIT_G} g");
    let grams = number(text, LEAST_LIMIT_G..=MOST_LIMIT_G, &what)?;
    Force::new(grams).map_err(|error| error.to_string())
}

/// Shows, exports or forgets the newtons of a hand, or measures those of a joint. Measuring fails unless all loads are accepted.
pub(crate) async fn run(out: &mut Out, args: &ScaleArgs) -> anyhow::Result<()> {
    let settings = settings_file::default_path();
    let file = settings.and_then(|settings| newtons_file::file_of(&settings, &args.hand));
    match args.joint {
        Some(joint) if args.arm => measure(out, args, joint, file.as_deref()).await,
        Some(joint) if !args.forget => Err(FailureKind::NotArmed.error(format!(
            "nothing was moved: this presses {} of the hand at {} on a kitchen scale with up to {} g; when nothing but the scale is in the way, add --arm",
            joint.name(),
            args.hand,
            args.limit.get()
        ))),
        _ if args.hand.is_sim() => Err(WrongUsage::error(
            "the built-in hand differs each time: nothing is stored for it; name the URL of a hand",
        )),
        _ => show(out, args, &file.context("no home folder to store it in")?),
    }
}

fn show(out: &mut Out, args: &ScaleArgs, file: &Path) -> anyhow::Result<()> {
    let known = match newtons_file::read(file) {
        Err(error) if args.forget && args.joint.is_none() => {
            notify(&format!("{} could not be read: {error}", file.display()));
            NewtonsMap::default()
        }
        read => {
            read.with_context(|| format!("cannot read {}; --forget removes it", file.display()))?
        }
    };
    let object = json!({ "newtons": {
        "hand": args.hand.to_string(),
        "joints": known.joints().map(joint_json).collect::<Vec<_>>(),
        "forgotten": args.forget,
    }});
    if let Some(path) = &args.out {
        let is_json = path.extension().is_some_and(|end| end == "json");
        let text = match is_json {
            true => format!("{object:#}\n"),
            false => newtons_file::csv(&known),
        };
        std::fs::write(path, text)
            .with_context(|| format!("cannot write {}; nothing was forgotten", path.display()))?;
    }
    let lines = if known.is_empty() {
        vec!["nothing was measured of this hand: 'handscope help scale' describes how".into()]
    } else {
        let head = "joint         N for 100 g   bound   loads  limit   measured";
        let rows = known.joints().map(joint_line);
        std::iter::once(head.to_owned()).chain(rows).collect()
    };
    out.result(args.json, &object, lines)?;
    out.flush()?;
    let forgotten = match args.joint {
        _ if !args.forget => Ok(()),
        Some(joint) => newtons_file::remove(file, joint),
        None => newtons_file::forget(file),
    };
    forgotten.with_context(|| format!("cannot change {}", file.display()))
}

fn joint_json((dof, joint): (Dof, &JointPoints)) -> Value {
    let scale = joint.scale();
    json!({
        "joint": dof,
        "day": joint.day,
        "limit_g": joint.limit,
        "points": joint.points,
        "newtons_per_g": scale.ok().map(|own| own.newtons_per_g),
        "bound": scale.ok().map(|own| own.bound),
        "fingertip_deviation": scale.ok().and_then(|own| own.tip_deviation),
        "missing": scale.err().map(|why| why.to_string()),
    })
}

fn joint_line((dof, joint): (Dof, &JointPoints)) -> String {
    let scale = joint.scale().ok();
    let newtons = scale.map_or("-".into(), |own| {
        format!("{:.3} N", 100.0 * own.newtons_per_g)
    });
    let bound = scale.map_or("-".into(), |own| format!("{:.1} %", 100.0 * own.bound));
    format!(
        "{:<12}  {newtons:>11}  {bound:>6}  {:>6}  {:>4} g  {}",
        dof.name(),
        joint.points.len(),
        joint.limit.get(),
        joint.day
    )
}

/// What a measurement came to.
struct MeasuredJoint {
    end: Ended<ScaleEnd>,
    points: Vec<ScalePoint>,
    stop: Option<Stop>,
}

async fn measure(
    out: &mut Out,
    args: &ScaleArgs,
    joint: Dof,
    file: Option<&Path>,
) -> anyhow::Result<()> {
    let known = file.map(newtons_file::read).transpose();
    let known = known.context("what is known of this hand cannot be read; --forget removes it")?;
    let known = known.unwrap_or_default();
    let stored = known.points(joint);
    let measured = match stored.filter(|own| own.scale().is_ok()) {
        Some(own) => {
            notify(&format!(
                "nothing was moved: {joint} was measured on {}; '--forget --joint {joint}' lets it be measured again",
                own.day,
                joint = joint.name()
            ));
            MeasuredJoint {
                end: Ok(ScaleEnd::Done),
                points: own.points.clone(),
                stop: None,
            }
        }
        None => {
            let same = stored.filter(|own| own.limit == args.limit);
            let points = same.map(|own| own.points.clone()).unwrap_or_default();
            press(out, args, (joint, points), file).await?
        }
    };
    let scale = ForceScale::fit(&measured.points);
    let object = json!({ "scale": {
        "hand": args.hand.to_string(),
        "joint": joint,
        "end": end_name(measured.end),
        "accepted": measured.points.len(),
        "newtons_per_g": scale.ok().map(|own| own.newtons_per_g),
        "bound": scale.ok().map(|own| own.bound),
        "fingertip_deviation": scale.ok().and_then(|own| own.tip_deviation),
        "stop": measured.stop,
    }});
    let lines = scale.ok().map(|own| result_lines(joint, &own));
    let shown = out
        .result(args.json, &object, lines.unwrap_or_default())
        .and_then(|()| out.flush());
    session::printed(shown, measured.end, measured.stop)?;
    match failure(measured.end, measured.points.len()) {
        None => Ok(()),
        Some(why) => bail!("{why}{}", stop_words(measured.stop)),
    }
}

/// Moves the hand.
async fn press(
    out: &mut Out,
    args: &ScaleArgs,
    (joint, points): (Dof, Vec<ScalePoint>),
    file: Option<&Path>,
) -> anyhow::Result<MeasuredJoint> {
    if !points.is_empty() {
        let count = points.len();
        notify(&format!("{count} of {LOADS} loads are measured already"));
    }
    let mut hand = ArmedHand::ready(&args.hand, ArmRequest::GENTLE).await?;
    let start = ScaleStart {
        dof: joint,
        limit: args.limit,
        points,
    };
    let inputs = stream::select(
        by_user(&mut hand.interrupt).map(ScaleInput::Abort),
        typed_lines(),
    );
    let report = |progress| {
        let Progress::Event(event) = progress else {
            return true;
        };
        let is_shown = show_event(out, args.json, &event).is_ok();
        is_shown && keep(args, joint, file, event)
    };
    let driven = calibrate(&hand.link, hand.armed, start, inputs, report).await;
    hand.release(driven.stop).await;
    Ok(MeasuredJoint {
        end: driven.end,
        points: driven.program.points().to_vec(),
        stop: driven.stop,
    })
}

/// Stores the points, if they changed; false if that failed.
fn keep(args: &ScaleArgs, joint: Dof, file: Option<&Path>, event: ScaleEvent) -> bool {
    let (ScaleEvent::Points(points), Some(file)) = (event, file) else {
        return true;
    };
    let points = JointPoints {
        limit: args.limit,
        day: day(since_1970()),
        points,
    };
    let kept = newtons_file::put(file, joint, points);
    if let Err(error) = &kept {
        notify(&format!("cannot store it in {}: {error}", file.display()));
    }
    kept.is_ok()
}

fn show_event(out: &mut Out, as_json: bool, event: &ScaleEvent) -> anyhow::Result<()> {
    match event {
        ScaleEvent::Asked { load, hand_g } => {
            let number = load + 1;
            let object = json!({ "ask": { "load": number, "of": LOADS, "hand_g": hand_g }});
            let line = format!(
                "load {number} of {LOADS}: the finger presses with {hand_g:.0} g of the hand; type what the scale shows in g, or 'again' or 'skip'"
            );
            out.result(as_json, &object, [line])
        }
        ScaleEvent::Doubted(why) => {
            let advice = match why {
                Contradiction::Point { .. } => {
                    ": the finger presses that load again, type it again"
                }
                _ => ": all five are discarded",
            };
            let object = json!({ "doubt": { "why": why.to_string() }});
            out.result(as_json, &object, [format!("{why}{advice}")])
        }
        ScaleEvent::NotAsked => {
            notify("that line came before the scale was to be read, and is not used");
            Ok(())
        }
        ScaleEvent::Points(_) => Ok(()),
    }
}

/// The user's answers from standard input. Its end ends the calibration.
fn typed_lines() -> impl Stream<Item = ScaleInput> {
    let (sender, answers) = mpsc::channel(LINES_MAX);
    std::thread::spawn(move || {
        let mut input = std::io::stdin().lock();
        let mut line = Vec::new();
        while let Ok(1..) = input.by_ref().take(LINE_MAX).read_until(b'\n', &mut line) {
            match answer(String::from_utf8_lossy(&line).trim()) {
                Some(answer) if sender.blocking_send(answer).is_err() => return,
                Some(_) => {}
                None => notify("that is no reading: type a number of g, 'again' or 'skip'"),
            }
            line.clear();
        }
    });
    let answers = stream::unfold(answers, |mut answers| async {
        let answer = answers.recv().await?;
        Some((answer, answers))
    });
    let finish = stream::once(async { ScaleInput::Finish });
    answers.chain(finish).chain(stream::pending())
}

fn answer(line: &str) -> Option<ScaleInput> {
    match line {
        "again" => return Some(ScaleInput::Again),
        "skip" => return Some(ScaleInput::Skip),
        _ => {}
    }
    let grams = line.strip_suffix('g').unwrap_or(line).trim_end();
    let grams: f64 = grams.replace(',', ".").parse().ok()?;
    let is_reading = (0.0..=READING_MAX_G).contains(&grams);
    is_reading.then_some(ScaleInput::Reading(grams))
}

fn result_lines(joint: Dof, scale: &ForceScale) -> Vec<String> {
    let newtons = 100.0 * scale.newtons_per_g;
    let bound = 100.0 * scale.bound;
    let name = joint.name();
    let result = format!("{name}: 100 g of the hand are {newtons:.3} N, within {bound:.1} %");
    let deviation = scale.tip_deviation.filter(|_| scale.tip_deviates());
    let deviation = deviation.map(|share| {
        let percent = 100.0 * share;
        format!("its fingertip reports {percent:+.0} % against that: the pad was not square on the scale, or its sensor is off")
    });
    std::iter::once(result).chain(deviation).collect()
}

/// Reason why not all loads are accepted; `None` if they are.
fn failure(end: Ended<ScaleEnd>, points: usize) -> Option<String> {
    let why = match end {
        Ok(ScaleEnd::Done) => return None,
        Ok(ScaleEnd::Incomplete) => {
            return Some(format!(
                "ended by the user: {points} of {LOADS} loads are measured; start it again for the others"
            ));
        }
        Ok(ScaleEnd::Contradicted) => "the readings contradict each other, and none was stored",
        Ok(ScaleEnd::NoContact) => "the finger met no scale: put it under the finger",
        Ok(ScaleEnd::ZeroOff) => {
            "the force reads less than -80 or more than 400 g without a load: calibrate the force sensors first"
        }
        Ok(ScaleEnd::NotOpened) => "something is in the way of the finger, so it did not open",
        Ok(ScaleEnd::Unsteady) => "the force did not become steady",
        Ok(ScaleEnd::Late) => "the finger did not get there in time",
        Ok(ScaleEnd::NoAnswer) => "no reading was typed for two minutes, so the finger let go",
        Err(why @ Abort::Fault { .. }) => {
            return Some(format!("{why}: 'handscope doctor' explains it"));
        }
        Err(why) => return Some(why.to_string()),
    };
    Some(why.into())
}

const fn end_name(end: Ended<ScaleEnd>) -> &'static str {
    match end {
        Ok(ScaleEnd::Done) => "done",
        Ok(ScaleEnd::Incomplete) => "incomplete",
        Ok(ScaleEnd::Contradicted) => "contradicted",
        Ok(ScaleEnd::NoContact) => "no_contact",
        Ok(ScaleEnd::ZeroOff) => "zero_off",
        Ok(ScaleEnd::NotOpened) => "not_opened",
        Ok(ScaleEnd::Unsteady) => "unsteady",
        Ok(ScaleEnd::Late) => "late",
        Ok(ScaleEnd::NoAnswer) => "no_answer",
        Err(Abort::Person) => "person",
        Err(Abort::OtherController { .. } | Abort::TakenOver) => "taken_over",
        Err(Abort::Fault { .. }) => "fault",
        Err(Abort::LinkLost) => "link_lost",
        // The other reasons disarm, or occur only in trials.
        Err(_) => "disarmed",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_grams_again_or_skip() {
        for (line, expected) in [
            ("312", Some(ScaleInput::Reading(312.0))),
            ("312,5 g", Some(ScaleInput::Reading(312.5))),
            ("0", Some(ScaleInput::Reading(0.0))),
            ("again", Some(ScaleInput::Again)),
            ("skip", Some(ScaleInput::Skip)),
            ("", None),
            ("-5", None),
            ("NaN", None),
            ("3 1 2", None),
            ("yes", None),
        ] {
            assert_eq!(answer(line), expected, "{line}");
        }
    }
}
