//! Holds between two forces with the shown hand.

use crate::app::activity::RecordedPlay;
use crate::app::env::Ctx;
use crate::app::hand::Hand;
use crate::app::hand::grasps::RepeatedGrasp;
use crate::app::hand::hold::{HoldAction, HoldMotion};
use crate::app::hand::running::MotionRun;
use crate::app::notices::NoticeKind;
use crate::app::settings::Settings;
use crate::hand::newtons::ForceUnit;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Angle, PerDof};
use crate::motion::grasp::run::{GraspInput, GraspStart};
use crate::motion::grasp::seen::GraspLabel;
use crate::motion::hold::{HoldClose, HoldStart};
use crate::poses::library::free_name;
use crate::poses::starter::starter;
use crate::record::Abort;
use crate::store::calendar::{day, since_1970};

/// Name of a grasp that closes to no pose.
const PINCH: &str = "Pinch";

/// Carries out an action on a hold.
pub(super) fn hold(hand: &mut Hand, action: HoldAction, settings: &Settings, ctx: &mut Ctx<'_>) {
    match action {
        HoldAction::Forces(unit, forces) => hand.controls.set_hold_forces(unit, forces),
        HoldAction::Unit(unit) => hand.controls.set_hold_unit(unit),
        HoldAction::Start(close) => start(hand, (close, None), settings, ctx),
        HoldAction::Repeat(name) => repeat(hand, &name, settings, ctx),
        HoldAction::Save => save(hand, ctx),
        HoldAction::PutDown => {
            if let Some(run) = hand.running.hold().filter(|run| run.asks()) {
                run.input(GraspInput::PutDown);
            }
        }
        HoldAction::End => {
            if let Some(run) = hand.running.hold() {
                run.input(GraspInput::Abort(Abort::Person));
            }
        }
    }
}

/// Holds as a grasp of the library; another hand confirms it first.
fn repeat(hand: &mut Hand, name: &str, settings: &Settings, ctx: &mut Ctx<'_>) {
    let newtons = hand.newtons.all_per_g();
    let found = hand.grasps.all().iter().find(|grasp| grasp.name == name);
    let Some(repeated) = found.map(|grasp| hand.grasps.repeated(grasp, newtons)) else {
        return;
    };
    match repeated {
        Ok(repeated) => {
            let close = repeated.grasp.close.way;
            start(hand, (close, Some(repeated)), settings, ctx);
        }
        Err(doubt) => ctx.notify(NoticeKind::GraspDoubted(doubt)),
    }
}

/// Saves the hold that ended.
fn save(hand: &mut Hand, ctx: &Ctx<'_>) {
    let (run, endpoint) = (hand.running.hold(), hand.connection.endpoint.clone());
    let Some((run, endpoint)) = run.zip(endpoint) else {
        return;
    };
    let about = GraspLabel {
        name: String::new(),
        note: String::new(),
        day: day(since_1970()),
        hand: endpoint,
        pose: None,
        newtons: hand.newtons.all_per_g(),
        claim: None,
    };
    let Some(Ok(mut grasp)) = run.grasp(about) else {
        return;
    };
    grasp.close.pose = pose_of(&grasp.close.way);
    let repeated = run.repeats.as_ref().map(|repeated| repeated.name.clone());
    let wanted = repeated.or_else(|| grasp.close.pose.clone());
    let taken = |name: &str| hand.grasps.all().iter().any(|own| own.name == name);
    grasp.name = free_name(&wanted.unwrap_or_else(|| PINCH.into()), taken);
    hand.grasps.save(grasp, ctx);
}

/// Name of the shipped pose with these targets.
fn pose_of(way: &HoldClose) -> Option<String> {
    let HoldClose::To(targets) = way else {
        return None;
    };
    let mut poses = starter().poses.iter();
    let pose = poses.find(|pose| pose.targets() == *targets);
    pose.map(|pose| pose.name.clone())
}

/// Starts a hold that closes like this, perhaps as a grasp of the library, if the hand is armed.
fn start(
    hand: &mut Hand,
    (close, repeated): (HoldClose, Option<RepeatedGrasp>),
    settings: &Settings,
    ctx: &Ctx<'_>,
) {
    let Some((link, armed)) = hand.lend_armed(ctx.env.clock) else {
        return;
    };
    // The user's own speeds and thresholds are restored when the user moves a joint next.
    hand.controls
        .override_limits(&PerDof::splat(Some(Angle::MAX)));
    let newtons = hand.newtons.all_per_g();
    let unit = match repeated {
        // The forces of a grasp are g of the hand that made it.
        Some(_) => ForceUnit::Grams,
        None => hand.controls.hold_unit(&newtons),
    };
    let Some(reading_per_g) = unit.reading_per_g(&newtons) else {
        return;
    };
    let own = (hand.controls.hold_forces_in(unit), reading_per_g);
    let (forces, reading_per_g) = repeated.as_ref().map_or(own, |repeated| {
        (repeated.grasp.forces, repeated.reading_per_g)
    });
    let hold = HoldStart {
        close,
        forces,
        duration: None,
        reading_per_g,
        locked: hand.controls.locked(),
        overshoot: OvershootMap::clone(&hand.overshoot.map),
        blocks: settings.size_blocks(hand.connection.endpoint.as_ref()),
        grip: hand.readings.grip.clone(),
    };
    let (grasp, unconfirmed) = repeated.map_or((None, None), |repeated| {
        (Some(repeated.grasp), repeated.unconfirmed)
    });
    let start = GraspStart { hold, unconfirmed };
    let run = HoldMotion::begin(link, armed, (start, unit), grasp, ctx.env);
    hand.running.0 = Some(MotionRun::Hold(Box::new(run)));
    hand.record_play(&RecordedPlay::hold(), ctx.now);
}
