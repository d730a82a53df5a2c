//! Why a series or its plan is refused or ended, as sentences in the window's language. Decides nothing.

use crate::app::notices::NoticeKind;
use crate::app::trials::form::ListError;
use crate::hand::{Dof, Fault};
use crate::trials::{Abort, EarlyEnd, PlanError};
use crate::ui::kit::{Look, format};
use crate::ui::text::{errors, tune, words};

/// Why something ended early. A file tells it in its own words.
pub(crate) fn ended(look: Look, why: &EarlyEnd) -> String {
    match why {
        EarlyEnd::Here(why) => abort(look, *why),
        EarlyEnd::FromFile(words) => format::sentence(words),
    }
}

/// Why a trial ended early.
pub(crate) fn abort(look: Look, why: Abort) -> String {
    let joint = |dof: Dof| look.say(words::dof(dof));
    match why {
        Abort::Person => look.say(tune::BY_PERSON).into(),
        Abort::Disarmed => look.say(tune::DISARMED).into(),
        Abort::LinkLost => look.say(tune::LINK_LOST).into(),
        Abort::NotKept => look.say(tune::NOT_KEPT).into(),
        Abort::Fault { dof, faults } => {
            let name = |fault: Fault| words::fault(fault, look.language).title;
            let names: Vec<&str> = faults.iter().map(name).collect();
            look.fill(tune::FAULT, &[&joint(dof), &look.list(&names)])
        }
        Abort::Heat {
            dof,
            celsius,
            limit,
        } => look.fill(tune::HEAT, &[&joint(dof), &celsius, &limit]),
        Abort::Ceiling {
            dof,
            grams,
            ceiling,
        } => look.fill(tune::CEILING, &[&joint(dof), &grams, &ceiling]),
        Abort::Unreached { dof, target } => look.fill(tune::UNREACHED, &[&joint(dof), &target]),
        Abort::LimitsRefused { dof } => look.fill(tune::LIMITS_REFUSED, &[&joint(dof)]),
        Abort::Blind { what, dof } => {
            look.fill(tune::BLIND, &[&joint(dof), &look.say(tune::group(what))])
        }
        Abort::TooWarm {
            dof,
            celsius,
            limit,
        } => look.fill(tune::COOLING, &[&joint(dof), &celsius, &limit]),
        Abort::NoContact { dof } => look.fill(tune::NO_CONTACT, &[&joint(dof)]),
    }
}

/// Why a plan cannot be run.
pub(crate) fn plan_error(look: Look, error: &PlanError) -> String {
    let joint = |dof: Dof| look.say(words::dof(dof));
    match *error {
        PlanError::NoJoint => look.say(tune::NO_JOINT).into(),
        PlanError::NoWay { dof, .. } => look.fill(tune::NO_WAY, &[&joint(dof)]),
        PlanError::NoStart { dof } => look.fill(tune::NO_START, &[&joint(dof)]),
        PlanError::Stage {
            dof, start, close, ..
        } => look.fill(tune::BAD_STAGE, &[&joint(dof), &start, &close]),
        PlanError::SlowApproach { speed, .. } => look.fill(tune::SLOW_APPROACH, &[&speed]),
        PlanError::Until { most, .. } => look.fill(tune::BAD_UNTIL, &[&most]),
        PlanError::NoTouch => look.say(tune::NO_TOUCH).into(),
        PlanError::Empty => look.say(tune::NOTHING_TO_TRY).into(),
        PlanError::NoSpeed => look.say(tune::SPEED_ZERO).into(),
        PlanError::TooMany { got } => look.fill(tune::TOO_MANY, &[&got]),
        PlanError::Dwell { .. } => look.say(tune::BAD_DWELL).into(),
        PlanError::Rest { .. } => look.say(tune::BAD_REST).into(),
        PlanError::Ceiling { least, .. } => look.fill(tune::BAD_CEILING, &[&least]),
        PlanError::Temperature { .. } => look.say(tune::BAD_HEAT).into(),
    }
}

/// Why a list of numbers is not taken.
pub(crate) fn list_error(look: Look, error: ListError) -> String {
    match error {
        ListError::NotInRange { most } => look.fill(tune::LIST_RANGE, &[&most]),
        ListError::TooLong => look.say(tune::LIST_LONG).into(),
        ListError::Empty => look.say(tune::LIST_EMPTY).into(),
    }
}

/// What became of a series or of its files; empty for everything else.
pub(crate) fn notice(look: Look, what: &NoticeKind) -> String {
    match what {
        NoticeKind::SeriesEnded { trials, aborted } => match aborted {
            None => look.fill(tune::ENDED, &[trials]),
            Some(why) => look.fill(tune::ENDED_EARLY, &[trials, &abort(look, *why)]),
        },
        NoticeKind::SeriesRuns => look.say(tune::RUNS).into(),
        NoticeKind::SessionOpened { path, trials } => {
            look.fill(tune::OPENED, &[&path.display(), trials])
        }
        NoticeKind::SessionRefused { path, message } => {
            let why = errors::system(look, message);
            look.fill(tune::REFUSED, &[&path.display(), &why])
        }
        _ => String::new(),
    }
}
