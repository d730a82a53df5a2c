//! The card before dangerous values are written or saved: joints, values at power-up, and the force measured with them.
//! Nothing is written while it is open.

use crate::app::params::rest_refusal;
use crate::app::state::State;
use crate::hand::impact::{NOTABLE_G, SLOWEST, overshoot_g};
use crate::hand::overshoot::MeasuredOn;
use crate::params::danger::Danger;
use crate::tasks::Question;
use crate::ui::kit::{ButtonRole, Card, Look};
use crate::ui::params::choices::answer;
use crate::ui::params::table::value_text;
use crate::ui::text::{cards, device, main, poses, tune, words};

/// Card of the question that a write asks, if there is one.
pub(crate) fn card_of(state: &State, look: Look) -> Option<Card> {
    let question = state.hand().params.question()?;
    let (Question::Apply(risks) | Question::Save(risks)) = question else {
        return None;
    };
    let hurts = !risks.dangers.is_empty();
    let is_save = matches!(question, Question::Save(_));
    let staged = !state.hand().params.to_apply().is_empty();
    let is_nothing = state.hand().params.unsaved().is_empty();
    let (title, agree) = match is_save {
        false => (device::DANGER_APPLY, device::AGREE_APPLY),
        true if hurts => (device::DANGER_SAVE, device::AGREE_SAVE),
        true if is_nothing => (device::SAVE_NOTHING, device::AGREE_SAVE),
        true if staged => (device::SAVE_TITLE, device::AGREE_APPLY_SAVE),
        true => (device::SAVE_TITLE, device::AGREE),
    };
    let mut card = Card::new(look, title);
    if is_save {
        card = changes(state, look, card);
    }
    let mut role = ButtonRole::Main;
    if hurts {
        card = dangers(look, card, &risks.dangers);
        role = ButtonRole::Danger;
    }
    if is_save && is_nothing && !hurts {
        role = ButtonRole::Plain;
    }
    let why = rest_refusal(&state.hand().connection.status).map(device::refusal);
    let decline = answer(device::DECLINE, ButtonRole::Safe, question, false);
    let agree = answer(agree, role, question, true);
    Some(card.choice(decline).choice(agree.disabled(why)))
}

/// Adds the changes that a SAVE makes for the next power-up, row by row.
fn changes(state: &State, look: Look, card: Card) -> Card {
    let book = &state.hand().params;
    if book.unsaved().is_empty() {
        return card.words(device::SAVE_NOTHING_BODY);
    }
    let card = card.words(device::SAVE_CHANGES).head([
        poses::NAME,
        device::SAVE_FROM,
        device::LIVE,
        device::SAVE_TO,
    ]);
    let card = book.unsaved().into_iter().fold(card, |card, row| {
        let live = book.live(row.id).map(|(value, _)| value);
        let values = [row.ours, live, Some(row.theirs)];
        let values = values.map(|value| value_text(row.id, value));
        card.row(device::whole_name(look, row.id), values)
    });
    if book.to_apply().is_empty() {
        card
    } else {
        card.note(device::SAVE_STAGED)
    }
}

/// Adds warnings about these joints, with the measured values.
pub(crate) fn dangers(look: Look, mut card: Card, dangers: &[Danger]) -> Card {
    let hard = dangers
        .iter()
        .filter(|danger| danger.expected.over_g >= NOTABLE_G);
    if hard.clone().next().is_some() {
        card = card.warning(device::DANGER_LATE);
    }
    let is_of_another = |danger: &&Danger| danger.expected.on == MeasuredOn::AnotherHand;
    let slowly = hard.filter(is_of_another);
    let slowly = slowly.map(|danger| overshoot_g(SLOWEST, f64::from(danger.force_g)));
    let slowly = slowly.reduce(f64::max);
    let strong = dangers.iter().filter(|danger| danger.is_above_rated());
    let strong: Vec<&str> = strong
        .map(|danger| look.tr(words::dof(danger.dof)))
        .collect();
    if !strong.is_empty() {
        card = card.warning((device::DANGER_RATED, strong.join(", ")));
    }
    card = card.head([
        cards::JOINT,
        main::SPEED,
        device::DANGER_FORCE,
        device::DANGER_OVER,
        tune::COLUMN_PEAK,
    ]);
    card = dangers.iter().fold(card, row);
    card = dangers.iter().fold(card, |card, danger| {
        if is_of_another(&danger) {
            return card;
        }
        let name = look.tr(words::dof(danger.dof));
        let measured = tune::measured_on(look, &danger.expected.on);
        card.note(format!("{name}: {measured}"))
    });
    if dangers.iter().any(|danger| is_of_another(&danger)) {
        card = card.note(device::DANGER_MEASURED);
    }
    if dangers.iter().any(|danger| danger.is_beyond_measured()) {
        card = card.note(device::DANGER_BEYOND);
    }
    match slowly {
        Some(peak) => card.note((device::DANGER_SLOWLY, format!("{peak:.0} g"))),
        None => card,
    }
}

fn row(card: Card, danger: &Danger) -> Card {
    let cells = [
        danger.speed.to_string(),
        danger.force_g.to_string(),
        format!("+{:.0}", danger.expected.over_g),
        format!("{:.0}", danger.peak_g()),
    ];
    card.row(words::dof(danger.dof), cells)
}
