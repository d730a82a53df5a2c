//! Another hand of this window that can lead the shown one: which one, how much of it is followed, and whether it may.

use crate::app::action::Action;
use crate::app::inputs::InputAction;
use crate::app::inputs::mirror::HandMirror;
use crate::app::slot::SlotId;
use crate::app::state::State;
use crate::inputs::mirror::MirrorScale;
use crate::ui::inputs::owner::{figures_ui, leader_name};
use crate::ui::kit::{self, Label, NumberField, Pane};
use crate::ui::text::{Text, inputs};
use crate::ui::theme;
use egui::{Ui, vec2};

/// Width of the names.
const NAME: f32 = 100.0;
/// Width of the choice of the hand that leads.
const LEADER: f32 = 220.0;

/// Draws the choice, how the other hand answers, and gives why it may not lead now, if it may not.
pub(crate) fn mirror_ui(ui: &mut Ui, pane: &mut Pane<'_>) -> Option<&'static str> {
    let (look, state) = (pane.look, pane.state);
    let mirror = state.hand().inputs.mirror.as_ref();
    let is_led = state.hand().inputs.leader().is_some();
    let choice = ui.add_enabled_ui(!is_led, |ui| {
        choice_ui(ui, pane, mirror);
    });
    let taken = look.say(inputs::TAKEN);
    choice.response.on_disabled_hover_text(taken);
    if let Some(mirror) = mirror {
        let answers = mirror.view.owner(state.now).is_some();
        let (answers, rate) = if answers {
            (inputs::ANSWERS, format!("{:.0} Hz", mirror.view.rate_hz))
        } else {
            (inputs::ANSWERS_NOT, "-".to_owned())
        };
        let rows = [
            (look.say(inputs::PHASE), look.say(answers).to_owned()),
            (look.say(inputs::RATE), rate),
        ];
        figures_ui(ui, look, "mirror figures", &rows);
    }
    missing(state, mirror).map(|text| look.say(text))
}

/// Which hand leads, and which share of its bends is followed.
fn choice_ui(ui: &mut Ui, pane: &mut Pane<'_>, mirror: Option<&HandMirror>) {
    let (look, state) = (pane.look, pane.state);
    let own = state.hand().label.slot;
    let slots = state.hands.iter().map(|hand| hand.label.slot);
    let slots = slots.filter(|slot| *slot != own);
    let named: Vec<(Option<SlotId>, String)> = slots
        .filter_map(|slot| Some((Some(slot), leader_name(state, slot)?)))
        .collect();
    let mut all = vec![(None, look.say(inputs::NO_LEADER))];
    all.extend(named.iter().map(|(slot, name)| (*slot, name.as_str())));
    let mut leader = mirror.map(|mirror| mirror.leader);
    let mut scale = mirror.map_or(MirrorScale::WHOLE, |mirror| mirror.scale);
    let mut is_new = row_ui(ui, pane, inputs::LEADER, |ui, _| {
        ui.spacing_mut().combo_width = LEADER;
        kit::choose_ui(ui, look.say(inputs::LEADER), &mut leader, &all)
    });
    let typed = row_ui(ui, pane, inputs::MIRROR_SCALE, |ui, pane| {
        let (name, tip) = (
            look.say(inputs::MIRROR_SCALE),
            look.tip(inputs::MIRROR_SCALE),
        );
        let [least, most] = MirrorScale::PERCENT.map(f64::from);
        let reason = mirror.is_none().then(|| look.say(inputs::CHOOSE_LEADER));
        let field = NumberField::new(name, tip, least..=most).disabled(reason);
        field.whole_ui(ui, pane, Some(scale.percent()))
    });
    let typed = typed.and_then(|percent| u8::try_from(percent).ok());
    if let Some(typed) = typed.and_then(MirrorScale::of_percent) {
        is_new |= typed != scale;
        scale = typed;
    }
    if is_new {
        let wanted = leader.map(|leader| (leader, scale));
        let action = Action::Input(InputAction::Mirror(wanted));
        pane.actions.push(action);
    }
}

/// A name, and a control behind it.
fn row_ui<T>(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    name: Text,
    add: impl FnOnce(&mut Ui, &mut Pane<'_>) -> T,
) -> T {
    let row = ui.horizontal(|ui| {
        let name = Label::muted(pane.look, name);
        ui.allocate_ui(vec2(NAME, theme::CONTROL), |ui| {
            ui.set_min_width(NAME);
            name.ui(ui);
        });
        add(ui, pane)
    });
    row.inner
}

/// Why the other hand may not lead the shown one now.
fn missing(state: &State, mirror: Option<&HandMirror>) -> Option<Text> {
    let hand = state.hand();
    match mirror {
        None => Some(inputs::CHOOSE_LEADER),
        Some(mirror) if state.hands.is_circle(mirror.leader, hand.label.slot) => {
            Some(inputs::CIRCLE)
        }
        Some(mirror) if mirror.view.owner(state.now).is_none() => Some(inputs::LEADER_SILENT),
        Some(_) => None,
    }
}
