//! The card of a calibration of the force sensors: what must be so, live; how far it is; the offsets before and after.

use crate::app::action::Action;
use crate::app::calibration::{Calibration, Check, Offsets};
use crate::app::guard::GuardStep;
use crate::app::state::State;
use crate::hand::{Dof, ForceReading};
use crate::link::Calibrated;
use crate::ui::card::{Card, Choice, Line, Manner};
use crate::ui::guard::{cancel, close, reason, under_way};
use crate::ui::look::Look;
use crate::ui::text::{Text, cards, words};

/// The card.
pub(crate) fn card(state: &State, look: Look, run: &Calibration) -> Card {
    if run.is_measuring() {
        return under_way(
            look,
            cards::CALIBRATE_TITLE,
            look.say(cards::MEASURING),
            1.0,
        );
    }
    if run.is_sending() {
        let (words, part) = (look.say(cards::CALIBRATING), run.part(state.now));
        return under_way(look, cards::CALIBRATE_TITLE, words, part);
    }
    if run.is_over() {
        return over(look, run);
    }
    ask(state, look, run)
}

fn ask(state: &State, look: Look, run: &Calibration) -> Card {
    let (sample, link, now) = (&state.sample, &state.link, state.now);
    let mut lines = vec![Line::Words(look.say(cards::CALIBRATE_WORDS).into())];
    for check in Check::ALL {
        let is_so = run.check(check, sample, link, now);
        lines.push(Line::Check(is_so, look.say(check_words(check)).into()));
    }
    let force = sample.force.map(|force| force.value.map(ForceReading::raw));
    lines.push(head(look, &[cards::OFFSET_NOW]));
    lines.extend(Dof::ALL.map(|dof| row(look, dof, &[force])));
    let not_yet =
        (!run.is_ready(sample, link, now)).then(|| look.say(cards::CALIBRATE_NOT_YET).to_owned());
    let begin = Choice::new(cards::CALIBRATE, cards::CALIBRATE_TIP, Manner::Main)
        .does(Action::Guard(GuardStep::Begin))
        .disabled(reason(state, look).or(not_yet));
    Card {
        title: look.say(cards::CALIBRATE_TITLE).into(),
        lines,
        choices: vec![cancel(), begin],
        ..Card::default()
    }
}

fn over(look: Look, run: &Calibration) -> Card {
    let line = match run.end() {
        Some(Calibrated::Finished) => Line::Words(look.say(cards::CALIBRATED).into()),
        Some(Calibrated::Quiet) => Line::Words(look.say(cards::CALIBRATED_QUIET).into()),
        Some(Calibrated::Refused { reason }) => {
            Line::Warning(format!("{} {reason}", look.say(cards::CALIBRATED_REFUSED)))
        }
        Some(Calibrated::Unknown { .. }) => {
            Line::Warning(look.say(cards::CALIBRATED_UNKNOWN).into())
        }
        Some(Calibrated::NotSent(_)) | None => {
            Line::Warning(look.say(cards::CALIBRATED_NOT_SENT).into())
        }
    };
    let (before, after) = run.offsets();
    let mut lines = vec![
        line,
        head(look, &[cards::OFFSET_BEFORE, cards::OFFSET_AFTER]),
    ];
    lines.extend(Dof::ALL.map(|dof| row(look, dof, &[before, after])));
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

const fn check_words(check: Check) -> Text {
    match check {
        Check::Open => cards::CHECK_OPEN,
        Check::Still => cards::CHECK_STILL,
        Check::Untouched => cards::CHECK_UNTOUCHED,
        Check::Steady => cards::CHECK_STEADY,
        Check::NoFault => cards::CHECK_NO_FAULT,
        Check::Disarmed => cards::CHECK_DISARMED,
    }
}
