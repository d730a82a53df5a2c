//! Another hand of this window as leader of the shown one: which hand, scale, and control.

use crate::app::action::Action;
use crate::app::inputs::HandMirror;
use crate::app::inputs::InputAction;
use crate::app::slot::SlotId;
use crate::app::state::State;
use crate::inputs::mirror::MirrorScale;
use crate::motion::source::SourceKind;
use crate::ui::inputs::owner::leader_name;
use crate::ui::inputs::source::{SourceRow, SourceSwitch, grant_ui};
use crate::ui::kit::{self, Label, NumberField, Pane};
use crate::ui::text::{Text, inputs};
use egui::Ui;

/// Width of the captions.
const NAME: f32 = 100.0;

/// The row of the list.
pub(crate) fn mirror_row(pane: &Pane<'_>) -> SourceRow {
    let (look, state) = (pane.look, pane.state);
    let mirror = state.hand().inputs.mirror.as_ref();
    let first = others(state).into_iter().next();
    let first = first.map(|(leader, _)| (leader, MirrorScale::WHOLE));
    let words = match mirror {
        None => look.tr(inputs::OFF).to_owned(),
        Some(mirror) if mirror.view.owner(state.now).is_some() => {
            let rate = format!("{:.0}", mirror.view.rate_hz);
            look.fill(inputs::ANSWERS, &[&rate])
        }
        Some(_) => look.tr(inputs::LEADER_SILENT).to_owned(),
    };
    SourceRow {
        title: inputs::MIRROR,
        switch: Some(SourceSwitch {
            turns_on: inputs::WATCH,
            is_on: mirror.is_some(),
            action: InputAction::Mirror(first.filter(|_| mirror.is_none())),
            wrong: first.is_none().then_some(inputs::NO_OTHER_HAND),
        }),
        kind: None,
        words,
    }
}

/// Draws the choice of leader, the state of the other hand, and the grant of control.
pub(crate) fn mirror_ui(ui: &mut Ui, pane: &mut Pane<'_>, row: &SourceRow) {
    let (look, state) = (pane.look, pane.state);
    let mirror = state.hand().inputs.mirror.as_ref();
    let is_led = state.hand().leader().is_some();
    let choice = ui.add_enabled_ui(!is_led, |ui| {
        choice_ui(ui, pane, mirror);
    });
    let taken = look.tr(inputs::TAKEN);
    choice.response.on_disabled_hover_text(taken);
    row.state_ui(ui, pane);
    let missing = missing(state, mirror).map(|text| look.tr(text));
    grant_ui(ui, pane, SourceKind::Mirror, missing);
}

/// The other hands of the window, each with its name.
fn others(state: &State) -> Vec<(SlotId, String)> {
    let own = state.hand().label.slot;
    let slots = state.hands.iter().map(|hand| hand.label.slot);
    let slots = slots.filter(|slot| *slot != own);
    slots
        .filter_map(|slot| Some((slot, leader_name(state, slot)?)))
        .collect()
}

/// Draws the choice of the leader, and of the share of its bends that is followed.
fn choice_ui(ui: &mut Ui, pane: &mut Pane<'_>, mirror: Option<&HandMirror>) {
    let (look, state) = (pane.look, pane.state);
    let all = others(state).into_iter();
    let all: Vec<_> = all.map(|(slot, name)| (Some(slot), name)).collect();
    let mut leader = mirror.map(|mirror| mirror.leader);
    let mut scale = mirror.map_or(MirrorScale::WHOLE, |mirror| mirror.scale);
    let mut is_new = false;
    ui.horizontal(|ui| {
        Label::muted(look, inputs::LEADER).cell_ui(ui, NAME);
        ui.spacing_mut().combo_width = ui.available_width();
        is_new = kit::choose_ui(ui, look.tr(inputs::LEADER), &mut leader, &all);
    });
    let typed = ui.horizontal(|ui| {
        let text = inputs::MIRROR_SCALE;
        Label::muted(look, text).cell_ui(ui, NAME);
        let [least, most] = MirrorScale::PERCENT.map(f64::from);
        let reason = mirror.is_none().then(|| look.tr(inputs::CHOOSE_LEADER));
        let field = NumberField::new(look.tr(text), look.tip(text), least..=most);
        let field = field.disabled(reason);
        field.whole_ui(ui, pane, Some(scale.percent()))
    });
    let typed = typed.inner.and_then(|percent| u8::try_from(percent).ok());
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

/// Reason why the other hand cannot lead the shown one now; `None` if it can.
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
