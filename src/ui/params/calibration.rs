//! The card of a force sensor calibration: live preconditions, progress, and the offsets before and after.

use crate::app::procedures::{CalibrateProcedure, ProcedureAction, ProcedureStage};
use crate::app::state::State;
use crate::hand::{Dof, ForceReading};
use crate::record::Calibrated;
use crate::tasks::TaskStep;
use crate::tasks::calibrate::{CalibrateReport, CalibrationCondition, Checks, Offsets, TAKES};
use crate::ui::kit::{ButtonRole, Card, Look, format};
use crate::ui::params::choices::{asking, close, step};
use crate::ui::text::{Text, cards, errors, words};

pub(crate) fn card(state: &State, look: Look, run: &CalibrateProcedure) -> Card {
    let card = Card::new(look, cards::CALIBRATE_TITLE);
    match &run.stage {
        ProcedureStage::Asking => confirm(state, card, &run.checks),
        ProcedureStage::Doing(TaskStep::Measuring, _) => card.progress(1.0, cards::MEASURING),
        ProcedureStage::Doing(_, since) => {
            let part = state.now.since(*since).as_secs_f32() / TAKES.as_secs_f32();
            card.progress(part, cards::CALIBRATING)
        }
        ProcedureStage::Over(report) => over(look, card, run.before, report),
    }
}

fn confirm(state: &State, card: Card, run: &Checks) -> Card {
    let (hand, now) = (state.hand(), state.now);
    let (sample, link) = (&hand.readings.sample, &hand.connection.status);
    let mut card = card.words(cards::CALIBRATE_WORDS);
    for check in CalibrationCondition::ALL {
        card = card.check(run.check(check, sample, link, now), cards::check(check));
    }
    let force = sample.force.map(|force| force.value.map(ForceReading::raw));
    let card = offsets(card, &[(cards::OFFSET_NOW, force)]);
    let not_yet = (!run.is_ready(sample, link, now)).then_some(cards::CALIBRATE_NOT_YET);
    let begin = step(cards::CALIBRATE, ButtonRole::Main, ProcedureAction::Begin);
    asking(state, card, begin.disabled(not_yet))
}

fn over(look: Look, card: Card, before: Option<Offsets>, report: &CalibrateReport) -> Card {
    let card = match &report.end {
        Ok(Calibrated::Finished) => card.words(cards::CALIBRATED),
        Ok(Calibrated::Quiet) => card.words(cards::CALIBRATED_QUIET),
        Ok(Calibrated::Refused { reason }) => {
            card.warning((cards::CALIBRATED_REFUSED, errors::reason(look, *reason)))
        }
        Ok(Calibrated::Unknown { .. }) => card.warning(cards::CALIBRATED_UNKNOWN),
        Ok(Calibrated::NotSent(_)) | Err(_) => card.warning(cards::CALIBRATED_NOT_SENT),
    };
    let columns = [
        (cards::OFFSET_BEFORE, before),
        (cards::OFFSET_AFTER, report.after),
    ];
    offsets(card, &columns).choice(close())
}

/// Adds a table with a column of grams for each entry and a row for each joint.
fn offsets(card: Card, columns: &[(Text, Option<Offsets>)]) -> Card {
    let titles = columns.iter().map(|(title, _)| *title);
    let card = card.head([cards::JOINT].into_iter().chain(titles));
    Dof::ALL.into_iter().fold(card, |card, dof| {
        let grams =
            |(_, all): &(Text, Option<Offsets>)| format::whole(all.map(|all| all[dof].into()), 0);
        card.row(words::dof(dof), columns.iter().map(grams))
    })
}
