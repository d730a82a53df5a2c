//! Check-ups of bodies that the check-up does not know, in virtual time: healthy ones, and each kind of wear at the size that it is
//! to be found at. Used by the tests and by the bench.

use super::virtual_hand::VirtualHand;
use handscope::checkup::check::checks;
use handscope::checkup::kept::StoredCheckup;
use handscope::checkup::{Check, Checkup, CheckupPlan, Grade, HandPart, Subject};
use handscope::hand::{ArmEpoch, Dof, Finger};
use handscope::sim::body_params::JointBody;
use handscope::sim::body_params::random::random;
use handscope::sim::{BodyParams, ForceCompared, Object};

pub(crate) const JOINT: Dof = Dof::Middle;
const TIP: Finger = Finger::Ring;

/// Checks a body; what it was at its first check-up is compared where it is given.
pub(crate) fn checked(body: BodyParams, seed: u64, first: &[Check]) -> Vec<Check> {
    checked_with(ForceCompared::default(), (body, seed), first)
}

/// The same of a body whose drives compare their thresholds so.
pub(crate) fn checked_with(
    compared: ForceCompared,
    (body, seed): (BodyParams, u64),
    first: &[Check],
) -> Vec<Check> {
    let mut hand = VirtualHand::with(compared, (body, seed), &Object::none());
    let (checkup, stopped) = hand.run(started(), |_, _| ());
    assert_eq!((checkup.aborted(), stopped), (None, false));
    let first = (!first.is_empty()).then(|| kept(first));
    checks(checkup.measured(), "", first.as_slice())
}

/// A check-up that begins.
pub(crate) fn started() -> Checkup {
    Checkup::start(ArmEpoch(1), CheckupPlan::default())
}

fn kept(first: &[Check]) -> StoredCheckup {
    StoredCheckup {
        at: String::new(),
        hand: String::new(),
        figures: first.iter().map(|check| check.measured).collect(),
        report: None,
    }
}

/// What is not as it should be.
pub(crate) fn told(checks: &[Check]) -> Vec<(Subject, HandPart, Option<f64>)> {
    let told = checks.iter().filter(|check| check.grade != Grade::Fine);
    let told = told.map(|check| (check.measured.what, check.measured.of, check.measured.value));
    told.collect()
}

/// A wear: what is worn how, and by which figure it is found.
pub(crate) type Wear = (&'static str, fn(&mut BodyParams), Subject);

fn joint(body: &mut BodyParams) -> &mut JointBody {
    &mut body.joints[JOINT]
}

pub(crate) const WEARS: [Wear; 14] = [
    (
        "backlash of 40 counts",
        |body| joint(body).backlash = 40.0,
        Subject::Backlash,
    ),
    (
        "closing takes 400 mA",
        |body| joint(body).friction_ma = 400.0,
        Subject::ClosingCurrent,
    ),
    (
        "opening takes 400 mA",
        |body| joint(body).opening_friction_ma = 400.0,
        Subject::OpeningCurrent,
    ),
    (
        "0.4 mA more a unit of speed",
        |body| joint(body).friction_ma_per_speed = 0.4,
        Subject::CurrentPerSpeed,
    ),
    (
        "a quarter slower",
        |body| joint(body).counts_per_speed = 2.3,
        Subject::ClosingSpeed,
    ),
    (
        "faster",
        |body| joint(body).counts_per_speed = 4.2,
        Subject::OpeningSpeed,
    ),
    (
        "120 ms late",
        |body| joint(body).latency_ms = 120.0,
        Subject::DeadTime,
    ),
    (
        "late by chance",
        |body| joint(body).latency_scatter_ms = 60.0,
        Subject::DeadTimeScatter,
    ),
    (
        "a zero of 300 g",
        |body| joint(body).force_zero_g = 320.0,
        Subject::ForceZero,
    ),
    (
        "noise of 25 g either way",
        |body| joint(body).force_noise_g = 25.0,
        Subject::ForceNoise,
    ),
    (
        "24 degrees warmer",
        |body| joint(body).warmer_by_c = 24.0,
        Subject::WarmerThanOthers,
    ),
    (
        "a dead channel",
        |body| body.fingertips[TIP].dead[3] = true,
        Subject::DeadChannels,
    ),
    (
        "a channel that drifts",
        |body| body.fingertips[TIP].drift[5] = -3000.0,
        Subject::ChannelDrift,
    ),
    (
        "a weak supply",
        |body| body.supply.sag = 0.4,
        Subject::SlowerTogether,
    ),
];

/// Whether a wear is found where it is.
pub(crate) fn finds((_, wear, subject): Wear, seed: u64) -> bool {
    let mut body = random(seed);
    wear(&mut body);
    let of = match subject {
        Subject::DeadChannels | Subject::ChannelDrift => HandPart::Fingertip(TIP),
        Subject::SlowerTogether => HandPart::Hand,
        _ => HandPart::Joint(JOINT),
    };
    let told = told(&checked(body, seed, &[]));
    told.iter().any(|own| (own.0, own.1) == (subject, of))
}
