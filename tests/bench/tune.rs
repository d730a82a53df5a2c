//! The search for the fastest close under a limit, on bodies that it does not know, in virtual time: whether its claims hold in
//! closes to come, and how its closes compare with the best that could be claimed; then on a hand with other physics.

use crate::other_hand::{OtherHand, best_close_s, drawn};
use crate::report::{Aim, Failure, Report};
use crate::virtual_hand::{Case, STIFFNESSES, VirtualHand, case, object};
use handscope::hand::Dof;
use handscope::sim::body_params::random::random;
use handscope::trials::search::SearchGoal;

/// Bodies, each with every stiffness.
const BODIES: u64 = 20;
/// Closes that each claim is checked by, and how many of them may be above a bound for 95 of 100.
const CHECKS: usize = 60;
const ABOVE: usize = 3;
const LIMIT_G: i16 = 500;
/// What breaks, beyond this.
const BREAKS_AT_G: f64 = 700.0;

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let goal = SearchGoal::new(&[Dof::Index], LIMIT_G);
    let bodies = (0..BODIES).flat_map(|seed| STIFFNESSES.map(|own| (seed, own)));
    let cases: Vec<Case> = bodies
        .map(|(seed, stiffness)| case(seed, stiffness, (&goal, CHECKS)))
        .collect();
    let share = |is: &dyn Fn(&Case) -> bool| {
        let count: f64 = cases.iter().filter(|own| is(own)).map(|_| 1.0).sum();
        let all: f64 = cases.iter().map(|_| 1.0).sum();
        100.0 * count / all
    };
    let limit = f64::from(LIMIT_G);
    report.row(
        "searches that end with a claim",
        share(&|own| own.claims),
        "%",
        Aim::None,
    )?;
    let is_false = |own: &Case| own.above > ABOVE;
    report.row(
        "  claims that 60 more closes refute",
        share(&is_false),
        "%",
        Aim::AtMost(5.0),
    )?;
    let is_slow = |own: &Case| own.claims && own.close_s > 1.12 * own.best_s;
    report.row(
        "  closes over 12 % slower than the best",
        share(&is_slow),
        "%",
        Aim::AtMost(10.0),
    )?;
    let is_rough = |own: &Case| own.highest_g > 1.1 * limit;
    report.row(
        "  with a trial over 1.1 of the limit",
        share(&is_rough),
        "%",
        Aim::AtMost(5.0),
    )?;
    let is_over = |own: &Case| own.highest_g > limit;
    report.row(
        "  with a trial over the limit",
        share(&is_over),
        "%",
        Aim::None,
    )?;
    let mut took: Vec<f64> = cases.iter().map(|own| own.took_s).collect();
    took.sort_by(f64::total_cmp);
    let median = took.get(took.len() / 2).copied().unwrap_or_default();
    report.row(
        "  how long one takes, median",
        median,
        "s",
        Aim::AtMost(360.0),
    )?;
    let broken = (0..BODIES).filter(|seed| breaks(*seed, &goal)).map(|_| 1.0);
    report.row(
        "  fragile objects broken",
        broken.sum(),
        "",
        Aim::AtMost(0.0),
    )?;
    others(report, &goal)
}

/// Hands with other physics, whose force sensors have an offset.
const OTHERS: u64 = 200;
/// Of so many of them the best close is looked for.
const GRIDS: u64 = 20;

/// One search on a hand with other physics.
struct OtherCase {
    claims: bool,
    /// The highest peak of a close, of the limit.
    highest: f64,
    broke: bool,
    /// The time of the close, of the best.
    slower: Option<f64>,
}

fn other(seed: u64, goal: &SearchGoal) -> OtherCase {
    let limit = f64::from(goal.limit_g);
    let body = drawn(seed, limit);
    let mut hand = VirtualHand::of(OtherHand::new(body, seed));
    let claim = hand.tune(goal).finding.and_then(|own| own.result.ok());
    let best = || best_close_s(body, limit, goal.hold_g.into());
    OtherCase {
        claims: claim.is_some(),
        highest: hand.hand.highest_g() / limit,
        broke: hand.hand.broke(),
        slower: claim
            .filter(|_| seed < GRIDS)
            .map(|claim| claim.close_s / best()),
    }
}

fn others(report: &mut Report, goal: &SearchGoal) -> Result<(), Failure> {
    let cases: Vec<OtherCase> = (0..OTHERS).map(|seed| other(seed, goal)).collect();
    let share = |is: &dyn Fn(&OtherCase) -> bool| {
        let count: f64 = cases.iter().filter(|own| is(own)).map(|_| 1.0).sum();
        let all: f64 = cases.iter().map(|_| 1.0).sum();
        100.0 * count / all
    };
    let claims = share(&|own| own.claims);
    report.row("other physics: searches that claim", claims, "%", Aim::None)?;
    let rough = share(&|own| own.highest > 1.15);
    let aim = Aim::AtMost(3.0);
    report.row("  with a trial over 1.15 of the limit", rough, "%", aim)?;
    let broken: f64 = cases.iter().filter(|own| own.broke).map(|_| 1.0).sum();
    report.row("  fragile objects broken", broken, "", Aim::AtMost(0.0))?;
    let mut slower: Vec<f64> = cases.iter().filter_map(|own| own.slower).collect();
    slower.sort_by(f64::total_cmp);
    let at = |share: usize| slower.get(slower.len() * share / 100).copied();
    let percent = |share: usize| 100.0 * (at(share).unwrap_or_default() - 1.0);
    report.row(
        "  slower than the best, median",
        percent(50),
        "%",
        Aim::None,
    )?;
    let aim = Aim::AtMost(12.0);
    report.row("  slower than the best, 90 of 100", percent(90), "%", aim)
}

fn breaks(seed: u64, goal: &SearchGoal) -> bool {
    let mut hand = VirtualHand::counting(random(seed), seed, &object(20.0, Some(BREAKS_AT_G)));
    let run = hand.tune(goal);
    let joints = run.trials.iter().flat_map(|trial| &trial.summary.joints);
    let mut peaks = joints.filter_map(|joint| joint.peak_force_g);
    peaks.any(|peak| peak >= BREAKS_AT_G)
}
