//! The card before what could hurt is written or saved: which joints, how the hand would wake up, what that was measured to press.
//! Nothing is written while it is open.

use crate::app::action::Action;
use crate::app::params::action::ParamAction;
use crate::app::params::state::{Question, Wanted};
use crate::app::state::State;
use crate::hand::impact::{NOTABLE_G, SLOWEST, overshoot_g};
use crate::params::danger::Danger;
use crate::ui::kit::{Card, Choice, Line, Look, Manner};
use crate::ui::params::table::value_text;
use crate::ui::text::{cards, device, verdicts, words};

/// The card of what waits for a yes, if something does.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let question = state.hand().params.question.as_ref()?;
    Some(card(state, look, question))
}

fn card(state: &State, look: Look, question: &Question) -> Card {
    let hurts = !question.dangers.is_empty();
    let staged = !state.hand().params.to_apply().is_empty();
    let (title, agree) = match question.what {
        Wanted::Apply(_) => (device::DANGER_APPLY, device::AGREE_APPLY),
        Wanted::Save if hurts => (device::DANGER_SAVE, device::AGREE_SAVE),
        Wanted::Save if staged => (device::SAVE_TITLE, device::AGREE_APPLY_SAVE),
        Wanted::Save => (device::SAVE_TITLE, device::AGREE),
    };
    let manner = match hurts {
        true => Manner::Danger,
        false => Manner::Main,
    };
    let why = state.hand().write_refusal();
    let why = why.map(|why| look.say(device::refusal(why)).to_owned());
    let back = Choice::new(device::DECLINE, Manner::Safe);
    let agree = Choice::new(agree, manner);
    let mut all = match question.what {
        Wanted::Apply(_) => Vec::new(),
        Wanted::Save => changes(state, look),
    };
    if hurts {
        all.extend(lines(look, &question.dangers));
    }
    Card {
        title: look.say(title).into(),
        lines: all,
        choices: vec![
            back.does(Action::Param(ParamAction::Decline)),
            agree.does(Action::Param(ParamAction::Agree)).disabled(why),
        ],
        ..Card::default()
    }
}

/// What a SAVE changes for the next power-up, row by row.
fn changes(state: &State, look: Look) -> Vec<Line> {
    let book = &state.hand().params;
    let say = |text| look.say(text).to_owned();
    let heads = [
        device::NAME,
        device::SAVE_FROM,
        device::LIVE,
        device::SAVE_TO,
    ];
    let mut lines = vec![
        Line::Words(say(device::SAVE_CHANGES)),
        Line::Head(heads.map(say).into()),
    ];
    lines.extend(book.unsaved().into_iter().map(|row| {
        let live = book.live(row.id).map(|(value, _)| value);
        let values = [row.ours, live, Some(row.theirs)];
        let name = [verdicts::whole_name(look, row.id)].into_iter();
        Line::Cells(
            name.chain(values.map(|value| value_text(row.id, value)))
                .collect(),
        )
    }));
    if !book.to_apply().is_empty() {
        lines.push(Line::Note(say(device::SAVE_STAGED)));
    }
    lines
}

/// What is dangerous about these joints, with the measured figures.
pub(crate) fn lines(look: Look, dangers: &[Danger]) -> Vec<Line> {
    let hard = dangers
        .iter()
        .filter(|danger| danger.overshoot_g >= NOTABLE_G);
    let slowly = hard.map(|danger| overshoot_g(SLOWEST, f64::from(danger.force_g)));
    let slowly = slowly.reduce(f64::max);
    let mut lines = Vec::new();
    if slowly.is_some() {
        lines.push(Line::Warning(look.say(device::DANGER_LATE).into()));
    }
    let strong = dangers.iter().filter(|danger| danger.is_above_rated());
    let strong: Vec<&str> = strong
        .map(|danger| look.say(words::dof(danger.dof)))
        .collect();
    if !strong.is_empty() {
        let joints = strong.join(", ");
        let words = format!("{} {joints}", look.say(device::DANGER_RATED));
        lines.push(Line::Warning(words));
    }
    let head = [
        cards::JOINT,
        device::DANGER_SPEED,
        device::DANGER_FORCE,
        device::DANGER_OVER,
        device::DANGER_PEAK,
    ];
    let head = head.map(|text| look.say(text).to_owned());
    lines.push(Line::Head(head.into()));
    lines.extend(dangers.iter().map(|danger| row(look, danger)));
    lines.push(Line::Note(look.say(device::DANGER_MEASURED).into()));
    if dangers.iter().any(|danger| danger.is_beyond_measured()) {
        lines.push(Line::Note(look.say(device::DANGER_BEYOND).into()));
    }
    if let Some(peak) = slowly {
        let words = format!("{} {peak:.0} g", look.say(device::DANGER_SLOWLY));
        lines.push(Line::Note(words));
    }
    lines
}

fn row(look: Look, danger: &Danger) -> Line {
    Line::Cells(vec![
        look.say(words::dof(danger.dof)).into(),
        danger.speed.to_string(),
        danger.force_g.to_string(),
        format!("+{:.0}", danger.overshoot_g),
        format!("{:.0}", danger.peak_g()),
    ])
}
