//! The card of a calibration of the force sensors: what must be so, live; how far it is; the offsets before and after.

use crate::app::action::Action;
use crate::app::procedures::{CalibrateProcedure, ProcedureAction, ProcedureStage};
use crate::app::state::State;
use crate::hand::{Dof, ForceReading};
use crate::record::Calibrated;
use crate::tasks::calibrate::{CalibrateReport, CalibrateStep, Check, Checks, Offsets, TAKES};
use crate::ui::kit::{Card, Choice, Line, Look, Manner};
use crate::ui::params::choices::{cancel, close, reason, under_way};
use crate::ui::text::{Text, cards, errors, words};

/// The card.
pub(crate) fn card(state: &State, look: Look, run: &CalibrateProcedure) -> Card {
    let title = cards::CALIBRATE_TITLE;
    match &run.stage {
        ProcedureStage::Asking => ask(state, look, &run.checks),
        ProcedureStage::Doing(CalibrateStep::Calibrating, since) => {
            let part = state.now.since(*since).as_secs_f32() / TAKES.as_secs_f32();
            under_way(look, title, look.say(cards::CALIBRATING), part)
        }
        ProcedureStage::Doing(CalibrateStep::Measuring, _) => {
            under_way(look, title, look.say(cards::MEASURING), 1.0)
        }
        ProcedureStage::Over(report) => over(look, run.before, report),
    }
}

fn ask(state: &State, look: Look, run: &Checks) -> Card {
    let (sample, link, now) = (&state.hand().sample, &state.hand().link, state.now);
    let mut lines = vec![Line::Words(look.say(cards::CALIBRATE_WORDS).into())];
    for check in Check::ALL {
        let is_so = run.check(check, sample, link, now);
        lines.push(Line::Check(is_so, look.say(cards::check(check)).into()));
    }
    let force = sample.force.map(|force| force.value.map(ForceReading::raw));
    lines.push(head(look, &[cards::OFFSET_NOW]));
    lines.extend(Dof::ALL.map(|dof| row(look, dof, &[force])));
    let not_yet =
        (!run.is_ready(sample, link, now)).then(|| look.say(cards::CALIBRATE_NOT_YET).to_owned());
    let begin = Choice::new(cards::CALIBRATE, Manner::Main)
        .does(Action::Procedure(ProcedureAction::Begin))
        .disabled(reason(state, look).or(not_yet));
    Card {
        title: look.say(cards::CALIBRATE_TITLE).into(),
        lines,
        choices: vec![cancel(), begin],
        ..Card::default()
    }
}

fn over(look: Look, before: Option<Offsets>, report: &CalibrateReport) -> Card {
    let line = match &report.end {
        Ok(Calibrated::Finished) => Line::Words(look.say(cards::CALIBRATED).into()),
        Ok(Calibrated::Quiet) => Line::Words(look.say(cards::CALIBRATED_QUIET).into()),
        Ok(Calibrated::Refused { reason }) => {
            let reason = errors::reason(look, reason);
            Line::Warning(format!("{} {reason}", look.say(cards::CALIBRATED_REFUSED)))
        }
        Ok(Calibrated::Unknown { .. }) => Line::Warning(look.say(cards::CALIBRATED_UNKNOWN).into()),
        Ok(Calibrated::NotSent(_)) | Err(_) => {
            Line::Warning(look.say(cards::CALIBRATED_NOT_SENT).into())
        }
    };
    let mut lines = vec![
        line,
        head(look, &[cards::OFFSET_BEFORE, cards::OFFSET_AFTER]),
    ];
    lines.extend(Dof::ALL.map(|dof| row(look, dof, &[before, report.after])));
    Card {
        title: look.say(cards::CALIBRATE_TITLE).into(),
        lines,
        choices: vec![close()],
        ..Card::default()
    }
}

fn head(look: Look, columns: &[Text]) -> Line {
    let all = [cards::JOINT].into_iter().chain(columns.iter().copied());
    Line::Head(all.map(|text| look.say(text).to_owned()).collect())
}

fn row(look: Look, dof: Dof, columns: &[Option<Offsets>]) -> Line {
    let name = look.say(words::dof(dof)).to_owned();
    let grams = columns.iter().map(|all| match all {
        Some(all) => all[dof].to_string(),
        None => "-".into(),
    });
    Line::Cells([name].into_iter().chain(grams).collect())
}
