//! What the user asks for by keys that act everywhere.

use crate::app::action::Action;
use crate::app::hand::HoldKey;
use crate::app::hands::Hand;
use crate::app::hands::list::HandsAction;
use crate::app::settings::Zoom;
use crate::app::state::State;
use crate::poses::Preset;
use crate::ui::joints::row::JointRow;
use crate::ui::kit::Pane;
use crate::ui::poses::tiles as pose_tiles;
use crate::ui::window::body::HandViews;
use crate::ui::window::cards::is_covered;
use crate::ui::window::keys::{self, Wish};
use egui::Ui;

/// What a key asks for, under the same conditions as the control that does it.
pub(super) fn key_action(
    ui: &Ui,
    pane: &mut Pane<'_>,
    views: &mut HandViews,
    wish: Wish,
) -> Option<Action> {
    let state = pane.state;
    let armed = state.hand().connection.is_armed();
    let preset = |preset| armed.then_some(Action::Preset(preset));
    match wish {
        // These are not the views' own: what opens something, and what goes ahead of all others at the end of the frame.
        Wish::Opens(_) | Wish::Stop | Wish::HoldToRun => None,
        Wish::ArmOrNot if armed => Some(Action::Disarm),
        Wish::ArmOrNot => Some(Action::Arm),
        Wish::Open => preset(Preset::Open),
        Wish::Half => preset(Preset::Half),
        Wish::Close => preset(Preset::Close),
        Wish::Entry(key) => {
            let entry = state.poses.by_key(key, &state.settings.hidden_poses);
            let entry = entry.filter(|_| pane.unready().is_none());
            entry.map(|entry| pose_tiles::press(state, entry))
        }
        Wish::AngleUnit => Some(Action::AngleUnit(state.settings.angle_unit.next())),
        Wish::Tare if !state.hand().connection.status.state.is_live() => None,
        Wish::Tare => Some(Action::Tare(None)),
        Wish::UndoTare => {
            let tare = &state.hand().readings.tare;
            tare.can_undo().then_some(Action::UndoTare)
        }
        Wish::Language => Some(Action::Language(state.settings.language.other())),
        Wish::Theme => Some(Action::Theme(state.settings.theme.other())),
        Wish::Pause => {
            views.plots.view.time.toggle();
            None
        }
        // With the pointer still held, the next hand would go on with what was begun at this one.
        Wish::Hand(_) if ui.input(|input| input.pointer.any_down()) => None,
        Wish::Hand(at) if state.timeline.is_none() => {
            let hand = state.hands.iter().nth(at);
            hand.map(|hand| Action::Hands(HandsAction::Show(hand.label.slot)))
        }
        Wish::Hand(_) => None,
        Wish::Joint(dof) => {
            JointRow::new(dof, pane).focus(ui, armed && !state.hand().controls.joints[dof].locked);
            None
        }
        Wish::LinkFingers => {
            views.joints.toggle_link();
            None
        }
    }
}

/// What is done with the key that is held to run, if that is asked for.
pub(super) fn held_key_action(ui: &Ui, state: &State, wishes: &[Wish]) -> Option<Action> {
    if !state.settings.hold_to_run || state.timeline.is_some() {
        return None;
    }
    let key = if is_covered(state) {
        HoldKey::LetGo
    } else {
        keys::hold_key(ui, wishes)
    };
    let is_held = key != HoldKey::LetGo;
    if is_held {
        ui.request_repaint();
    }
    let is_believed = |hand: &Hand| hand.controls.held.is_held(state.now);
    (is_held || state.hands.iter().any(is_believed)).then_some(Action::HoldKey(key))
}

/// What the keys of the zoom did in the last frame, to be kept.
pub(super) fn zoom_action(ui: &Ui, state: &State) -> Option<Action> {
    let zoom = Zoom::from(ui.ctx().zoom_factor());
    (zoom != state.settings.zoom).then_some(Action::Zoom(zoom))
}
