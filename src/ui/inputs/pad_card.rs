//! The gamepad: which one is there, what its controls do, and where it wants the hand.

use crate::app::action::Action;
use crate::app::inputs::{InputAction, InputKind, InputSource};
use crate::app::settings::Language;
use crate::app::state::State;
use crate::hand::{Angle, PerDof};
use crate::inputs::pad::PadControl;
use crate::inputs::pad::source::PadView;
use crate::ui::hand::panel::pose_ui;
use crate::ui::inputs::cards::{grant_ui, no_hand, on_off};
use crate::ui::inputs::pad_picture::{PadShown, PoseName, pad_picture_ui};
use crate::ui::inputs::pad_table::pad_table_ui;
use crate::ui::kit::{self, Label, Look, Pane};
use crate::ui::text::{errors, inputs};
use crate::ui::theme;
use egui::{Role, ScrollArea, Sense, Ui, WidgetInfo, vec2};

/// The drawn hand needs at least this width, and has this height.
const HAND_LEAST: f32 = 180.0;
const HAND: f32 = 380.0;

/// The card, and the control that was chosen.
#[derive(Debug, Default)]
pub(crate) struct PadCard {
    chosen: Option<PadControl>,
}

impl PadCard {
    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            let view = pane.state.hand().inputs.pad_view.clone();
            kit::head_ui(ui, look, look.say(inputs::PAD), |_| ());
            kit::say_ui(ui, look.tip(inputs::PAD), look.palette.muted);
            pad_switch_ui(ui, pane, view.as_ref());
            let (map, poses) = (pane.state.settings.pad_map(), pose_names(pane.state, look));
            let there = view.as_ref().filter(|view| view.name.is_some());
            let shown = PadShown {
                state: there.map(|view| &view.state),
                map: &map,
                chosen: self.chosen,
                fingers: there.map(|view| view.fingers).unwrap_or_default(),
                poses: &poses,
            };
            let picture = ScrollArea::horizontal().id_salt("pad picture");
            let clicked = picture.show(ui, |ui| pad_picture_ui(ui, look, &shown));
            self.chosen = clicked.inner.or(self.chosen);
            ui.add_space(theme::STEP);
            ui.horizontal_top(|ui| {
                let changed = ui.vertical(|ui| pad_table_ui(ui, look, &shown)).inner;
                let map = changed.map(|map| Action::Input(InputAction::Map(map)));
                pane.actions.extend(map);
                dry_run_ui(ui, pane, there);
            });
        });
    }
}

/// The poses that a button can have.
fn pose_names(state: &State, look: Look) -> Vec<PoseName> {
    let poses = state.poses.poses(&state.settings.hidden_poses);
    let named = poses.map(|pose| PoseName {
        name: pose.name.clone(),
        shown: match look.language {
            Language::Zh if !pose.name_zh.is_empty() => pose.name_zh.clone(),
            _ => pose.name.clone(),
        },
    });
    named.collect()
}

/// Whether gamepads are looked for, which one is there, and whether it may move the hand.
fn pad_switch_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: Option<&PadView>) {
    let look = pane.look;
    ui.horizontal_wrapped(|ui| {
        let button = on_off(look, inputs::READ_PAD, view.is_some());
        let button = button.disabled(no_hand(pane)).large();
        let action = InputAction::ReadPad(view.is_none());
        button.on_click(ui, pane, Action::Input(action));
        let is_there = view.is_some_and(|view| view.name.is_some());
        let missing = (!is_there).then_some(look.say(inputs::NONE));
        grant_ui(
            ui,
            pane,
            (look.say(inputs::PAD), InputAction::Grant(InputSource::Pad)),
            missing,
        );
    });
    let Some(view) = view else {
        let refused = pane.state.hand().inputs.refused.as_ref();
        if let Some((_, why)) = refused.filter(|(kind, _)| *kind == InputKind::Pad) {
            let why = errors::not_opened(look, why);
            Label::new(&why, look.palette.warn).wrap().ui(ui);
        }
        return;
    };
    let (text, color) = match (&view.name, &view.trouble) {
        (Some(name), _) => (name.clone(), look.palette.text),
        (None, Some(trouble)) => (errors::pad(look, trouble), look.palette.warn),
        (None, None) => (look.say(inputs::PLUG_IN).to_owned(), look.palette.muted),
    };
    Label::new(&text, color).wrap().ui(ui);
}

/// Where the gamepad wants the hand, drawn, whether it may move it or not; joints that it leaves alone are where they are.
fn dry_run_ui(ui: &mut Ui, pane: &Pane<'_>, view: Option<&PadView>) {
    let room = ui.available_width();
    if room < HAND_LEAST {
        return;
    }
    let look = pane.look;
    let angle = pane.state.hand().readings.sample.angle;
    let shares = PerDof::from_fn(|dof| {
        let wanted = view.and_then(|view| view.aims[dof]);
        let raw = wanted.map(Angle::get).or(angle?.value[dof].documented())?;
        Some(f32::from(raw) / f32::from(Angle::MAX.get()))
    });
    ui.vertical(|ui| {
        kit::say_ui(ui, look.say(inputs::DRY_RUN), look.palette.muted);
        let (rect, response) = ui.allocate_exact_size(vec2(room, HAND), Sense::hover());
        pose_ui(ui, look, rect, &shares);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, look.say(inputs::DRY_RUN)));
    });
}
