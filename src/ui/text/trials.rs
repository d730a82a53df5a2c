//! Why a series or its plan is refused or ended, as sentences in the window's language. Decides nothing.

use crate::app::notices::NoticeKind;
use crate::app::settings::Language;
use crate::app::trials::ApproachKind;
use crate::app::trials::form::ListError;
use crate::hand::{Dof, Fault};
use crate::trials::{Abort, EarlyEnd, PlanError, Stage};
use crate::ui::kit::format;
use crate::ui::kit::look::Look;
use crate::ui::text::phrase::Text;
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
    let of = |dof: Dof, what: Text| format!("{} {}", joint(dof), look.say(what));
    let stop = match look.language {
        Language::En => ".",
        Language::Zh => "。",
    };
    match why {
        Abort::Person => look.say(tune::BY_PERSON).into(),
        Abort::Disarmed => look.say(tune::DISARMED).into(),
        Abort::LinkLost => look.say(tune::LINK_LOST).into(),
        Abort::NotKept => look.say(tune::NOT_KEPT).into(),
        Abort::Fault { dof, faults } => {
            let name = |fault: Fault| words::fault(fault, look.language).title;
            let names: Vec<&str> = faults.iter().map(name).collect();
            format!("{} {}{stop}", of(dof, tune::FAULT), names.join(", "))
        }
        Abort::Heat {
            dof,
            celsius,
            limit,
        } => format!("{} {limit} °C ({celsius} °C){stop}", of(dof, tune::HEAT)),
        Abort::Ceiling {
            dof,
            grams,
            ceiling,
        } => format!("{} {ceiling} g ({grams} g){stop}", of(dof, tune::CEILING)),
        Abort::Unreached { dof, target } => format!("{} {target}{stop}", of(dof, tune::UNREACHED)),
        Abort::LimitsRefused { dof } => of(dof, tune::LIMITS_REFUSED),
        Abort::Blind { what, dof } => {
            let what = look.say(group(what));
            format!("{} {what}{stop}", of(dof, tune::BLIND))
        }
        Abort::TooWarm {
            dof,
            celsius,
            limit,
        } => format!("{} {celsius} °C, {limit} °C{stop}", of(dof, tune::COOLING)),
        Abort::NoContact { dof } => of(dof, tune::NO_CONTACT),
    }
}

fn group(what: &str) -> Text {
    match what {
        "angle" => tune::ANGLE,
        "force" => tune::FORCE,
        "temperature" => tune::TEMPERATURE,
        _ => tune::FAULTS,
    }
}

/// Why a plan cannot be run.
pub(crate) fn plan_error(look: Look, error: &PlanError) -> String {
    let say = |text: Text| look.say(text).to_owned();
    let of = |dof: Dof, what: Text| format!("{} {}", look.say(words::dof(dof)), look.say(what));
    match *error {
        PlanError::NoJoint => say(tune::NO_JOINT),
        PlanError::NoWay { dof, .. } => of(dof, tune::NO_WAY),
        PlanError::NoStart { dof } => of(dof, tune::NO_START),
        PlanError::Stage {
            dof, start, close, ..
        } => {
            let joint = look.say(words::dof(dof));
            format!("{} {joint} ({start} - {close})", say(tune::BAD_STAGE))
        }
        PlanError::SlowApproach { speed, .. } => format!("{} {speed}", say(tune::SLOW_APPROACH)),
        PlanError::Until { most, .. } => format!("{} {most}", say(tune::BAD_UNTIL)),
        PlanError::NoTouch => say(tune::NO_TOUCH),
        PlanError::Empty => say(tune::NOTHING_TO_TRY),
        PlanError::NoSpeed => say(tune::SPEED_ZERO),
        PlanError::TooMany { got } => format!("{} {got}", say(tune::TOO_MANY)),
        PlanError::Dwell { .. } => say(tune::BAD_DWELL),
        PlanError::Rest { .. } => say(tune::BAD_REST),
        PlanError::Ceiling { least, .. } => format!("{} {least}", say(tune::BAD_CEILING)),
        PlanError::Temperature { .. } => say(tune::BAD_HEAT),
    }
}

/// Why a list of numbers is not taken.
pub(crate) fn list_error(look: Look, error: ListError) -> String {
    match error {
        ListError::NotInRange { most } => format!("{} {most}", look.say(tune::LIST_RANGE)),
        ListError::TooLong => look.say(tune::LIST_LONG).into(),
        ListError::Empty => look.say(tune::LIST_EMPTY).into(),
    }
}

/// What the hand does in a series.
pub(crate) const fn stage(stage: Stage) -> Text {
    match stage {
        Stage::Resting => tune::STAGE_RESTING,
        Stage::Preparing => tune::STAGE_PREPARING,
        Stage::Quiet => tune::STAGE_QUIET,
        Stage::Closing => tune::STAGE_CLOSING,
        Stage::Dwelling => tune::STAGE_DWELLING,
        Stage::Releasing => tune::STAGE_RELEASING,
        Stage::Over => tune::STAGE_OVER,
    }
}

/// How the object is reached.
pub(crate) const fn approach(kind: ApproachKind) -> Text {
    match kind {
        ApproachKind::OneStage => tune::ONE_STAGE,
        ApproachKind::Measured => tune::TWO_MEASURED,
        ApproachKind::Angle => tune::TWO_ANGLE,
        ApproachKind::Proximity => tune::TWO_PROXIMITY,
        ApproachKind::Touch => tune::TWO_TOUCH,
    }
}

/// What became of a series or of its files; empty for everything else.
pub(crate) fn notice(look: Look, what: &NoticeKind) -> String {
    let said = |text: Text| look.say(text).to_owned();
    match what {
        NoticeKind::SeriesEnded { trials, aborted } => match aborted {
            None => format!("{} {trials}", said(tune::ENDED)),
            Some(why) => {
                let why = abort(look, *why);
                format!("{} {trials}. {why}", said(tune::ENDED_EARLY))
            }
        },
        NoticeKind::SeriesRuns => said(tune::RUNS),
        NoticeKind::SessionOpened { path, trials } => {
            let what = said(tune::MEASURED);
            format!(
                "{} {} ({trials} {what})",
                said(tune::OPENED),
                path.display()
            )
        }
        NoticeKind::SessionRefused { path, message } => {
            let name = format!("{} {}", said(tune::REFUSED), path.display());
            look.pair(&name, &errors::system(look, message))
        }
        _ => String::new(),
    }
}
