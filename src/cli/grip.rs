//! `grip`: a grip by size on any hand. It moves the hand, so it requires `--arm`.

use crate::cli::out::Out;
use crate::cli::out::failure::FailureKind;
use crate::cli::parse::{hand, moving_speed, rated_force};
use crate::cli::session;
use crate::cli::trial::drive::{ArmedHand, by_user};
use crate::hand::PerDof;
use crate::hand::gap::{Gap, GripKind, HeldSize, SizeBlocks};
use crate::hand::{Force, Speed};
use crate::link::ArmRequest;
use crate::motion::drive::stop_words;
use crate::motion::grip::{self, GripEnd, GripReport, GripStart};
use crate::motion::program::Ended;
use crate::record::Abort;
use crate::transport::Endpoint;
use anyhow::bail;
use clap::Args;
use serde_json::{Value, json};

#[derive(Debug, Args)]
pub(crate) struct GripArgs {
    #[arg(long, value_name = "URL", value_parser = hand)]
    pub(crate) hand: Endpoint,
    /// Move the hand: nothing but the object is in its way, and the 24 V switch is in reach
    #[arg(long)]
    pub(crate) arm: bool,
    /// Kind of grip: pinch, between the pads of thumb and index; the others have no gap in this hand
    #[arg(long, value_name = "KIND", default_value = "pinch", value_parser = kind)]
    pub(crate) kind: GripKind,
    /// Millimetres between the pads to close to, 3 to 120; what stands between them stops the hand earlier
    #[arg(long, value_name = "MM", value_parser = gap, allow_negative_numbers = true)]
    pub(crate) gap: Gap,
    /// Speed of the faster joint, 1 to 1000
    #[arg(long, value_name = "SPEED", default_value = "200", value_parser = moving_speed, allow_negative_numbers = true)]
    pub(crate) speed: Speed,
    /// Force threshold in g, 0 to 2000
    #[arg(long, value_name = "GRAMS", default_value = "500", value_parser = rated_force, allow_negative_numbers = true)]
    pub(crate) force: Force,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

fn kind(text: &str) -> Result<GripKind, String> {
    let named = GripKind::ALL.into_iter().find(|kind| kind.name() == text);
    let kind = named.ok_or_else(|| {
        let known = GripKind::ALL.map(GripKind::name).join(", ");
        format!("it is not one of {known}")
    })?;
    kind.offered().map_err(|why| why.to_string())?;
    Ok(kind)
}

pub(crate) fn gap(text: &str) -> Result<Gap, String> {
    let mm = text
        .parse()
        .map_err(|_not_one| format!("'{text}' is not a number of millimetres"))?;
    Gap::new(mm).map_err(|error| error.to_string())
}

/// Grips. Fails if it ended early, or if something stopped the hand that it does not hold.
pub(crate) async fn run(out: &mut Out, args: &GripArgs) -> anyhow::Result<()> {
    if !args.arm {
        return Err(FailureKind::NotArmed.error(format!(
            "nothing was moved: this opens the hand at {} and closes thumb and index to {} mm; when nothing but the object is in the way, add --arm",
            args.hand,
            args.gap.mm()
        )));
    }
    let report = drive(args).await?;
    let blocks = session::size_blocks(&args.hand);
    let done = outcome(args, &report, &blocks);
    let object = object(args, &report, &blocks);
    out.result(args.json, &object, done.as_ref().ok())?;
    out.flush()?;
    match done {
        Ok(_words) => Ok(()),
        Err(why) => bail!("{why}{}", stop_words(report.stop)),
    }
}

async fn drive(args: &GripArgs) -> anyhow::Result<GripReport> {
    let limits = ArmRequest {
        speed: PerDof::splat(args.speed),
        force: PerDof::splat(args.force),
    };
    let mut hand = ArmedHand::ready(&args.hand, limits).await?;
    let start = GripStart {
        gap: args.gap,
        speed: args.speed,
        force: args.force,
        grip: session::grip_estimator(&args.hand),
    };
    let ends = by_user(&mut hand.interrupt);
    let report = grip::grip(&hand.link, hand.armed, start, ends).await;
    hand.release(report.stop).await;
    Ok(report)
}

/// Describes the object between the pads, and the shape that its size refers to.
fn held(report: &GripReport, blocks: &SizeBlocks) -> String {
    let Some(gap) = report.gap else {
        return "the distance between the pads is unknown".into();
    };
    let pads = format!("the pads are about {:.0} mm apart, by the model", gap.mm);
    match blocks.size(gap) {
        _ if report.end != Ok(GripEnd::Held) => pads,
        HeldSize::Block(mm) => format!("about {mm:.0} mm, measured with two blocks"),
        HeldSize::Ball(mm) => format!("a ball would have about {mm:.0} mm; {pads}"),
        HeldSize::Pads(_) => format!("{pads}, and their edges may be what touches"),
    }
}

/// The outcome in one sentence; `Err` for failures.
fn outcome(args: &GripArgs, report: &GripReport, blocks: &SizeBlocks) -> Result<String, String> {
    let (asked, held) = (args.gap.mm(), held(report, blocks));
    match report.end {
        Ok(GripEnd::Held) => Ok(format!("holds something: {held}")),
        Ok(GripEnd::Reached) => Ok(format!("at {asked} mm and holds nothing: {held}")),
        Ok(GripEnd::Stopped) => Err(format!(
            "something stopped the hand before {asked} mm, and thumb and index do not hold it: {held}"
        )),
        Ok(GripEnd::NotOpened) => Err(
            "something is in the way of thumb or fingers, so the hand did not open for the grip"
                .into(),
        ),
        Ok(GripEnd::Late) => Err("the hand did not get there in time".into()),
        Err(why @ Abort::OtherController { .. }) => {
            Err(format!("{why}: let one of them move the hand"))
        }
        Err(why @ Abort::Fault { .. }) => Err(format!("{why}: 'handscope doctor' explains it")),
        Err(why) => Err(why.to_string()),
    }
}

const fn end_name(end: Ended<GripEnd>) -> &'static str {
    match end {
        Ok(GripEnd::Held) => "held",
        Ok(GripEnd::Reached) => "reached",
        Ok(GripEnd::Stopped) => "stopped",
        Ok(GripEnd::NotOpened) => "not_opened",
        Ok(GripEnd::Late) => "late",
        Err(why) => session::early_end(why),
    }
}

/// The result: `{"grip": {…}}`. Unknown values are null.
fn object(args: &GripArgs, report: &GripReport, blocks: &SizeBlocks) -> Value {
    let held = report.gap.filter(|_| report.end == Ok(GripEnd::Held));
    let size = held.map(|gap| match blocks.size(gap) {
        HeldSize::Block(mm) => (Some(mm), "blocks", Some("block")),
        HeldSize::Ball(mm) => (Some(mm), "model", Some("ball")),
        HeldSize::Pads(_) => (None, "model", None),
    });
    json!({ "grip": {
        "hand": args.hand.to_string(),
        "kind": args.kind,
        "asked_mm": args.gap.mm(),
        "end": end_name(report.end),
        "gap_mm": report.gap.map(|gap| gap.mm),
        "size_mm": size.and_then(|(mm, ..)| mm),
        "size_by": size.map(|(_, by, _)| by),
        "size_of": size.and_then(|(.., shape)| shape),
        "state": report.grip.grasp.state,
        "stop": report.stop,
    }})
}
