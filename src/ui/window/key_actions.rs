//! Actions of the keys that work everywhere.

use crate::app::action::Action;
use crate::app::controls::HoldKey;
use crate::app::hand::Hand;
use crate::app::hand::list::HandsAction;
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

/// Returns the action of a key, under the same conditions as its control; `None` if it does not apply.
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
        // Handled by the window: opening views, and actions that precede all others at the end of the frame.
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
        // While the pointer is pressed, a drag begun on this hand would continue on the next one.
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

/// Action that reports the hold-to-run key. `None` if the setting is off, in a replay, and while the key is up and no hand
/// counts it as held.
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

/// Action that stores the zoom factor, if zoom keys changed it in the last frame.
pub(super) fn zoom_action(ui: &Ui, state: &State) -> Option<Action> {
    let zoom = Zoom::from(ui.ctx().zoom_factor());
    (zoom != state.settings.zoom).then_some(Action::Zoom(zoom))
}
