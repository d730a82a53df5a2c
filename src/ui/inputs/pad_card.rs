//! The gamepad: device, assignment of its controls, and the pose it requests.

use crate::app::action::Action;
use crate::app::inputs::{InputAction, InputKind};
use crate::app::settings::Language;
use crate::app::state::State;
use crate::hand::{Angle, PerDof};
use crate::inputs::pad::PadControl;
use crate::inputs::pad::source::PadView;
use crate::motion::source::SourceKind;
use crate::ui::hand::tile::pose_ui;
use crate::ui::inputs::pad_picture::{PadShown, PoseName, pad_picture_ui};
use crate::ui::inputs::pad_table::pad_table_ui;
use crate::ui::inputs::source::{SourceRow, SourceSwitch, grant_ui};
use crate::ui::kit::{self, Look, Pane};
use crate::ui::text::{errors, inputs};
use crate::ui::theme;
use egui::{Role, ScrollArea, Sense, Ui, WidgetInfo, vec2};

/// Minimum width of the drawn hand, and its height.
const HAND_LEAST: f32 = 180.0;
const HAND: f32 = 380.0;

/// View state of the card: the selected control.
#[derive(Debug, Default)]
pub(crate) struct PadCard {
    chosen: Option<PadControl>,
}

impl PadCard {
    /// Draws the gamepad with what its controls do. False without a gamepad.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) -> bool {
        let look = pane.look;
        let view = pane.hand().inputs.pad_view.as_ref();
        let Some(view) = view.filter(|view| view.name.is_some()) else {
            return false;
        };
        kit::small_text_ui(ui, look.tr(inputs::PAD_CHANGE), look.palette.muted);
        let (map, poses) = (pane.state.settings.pad_map(), pose_names(pane.state, look));
        let shown = PadShown {
            state: Some(&view.state),
            map: &map,
            chosen: self.chosen,
            fingers: view.fingers,
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
            dry_run_ui(ui, pane, view);
        });
        true
    }
}

/// The row of the list.
pub(crate) fn pad_row(pane: &Pane<'_>) -> SourceRow {
    let look = pane.look;
    let view = pane.hand().inputs.pad_view.as_ref();
    let name = view.and_then(|view| view.name.as_ref());
    let words = match (view, name) {
        (None, _) => look.tr(inputs::OFF).to_owned(),
        (Some(_), Some(name)) => name.clone(),
        (Some(view), None) => match &view.trouble {
            Some(trouble) => errors::pad(look, trouble),
            None => look.tr(inputs::PLUG_IN).to_owned(),
        },
    };
    SourceRow {
        title: inputs::PAD,
        switch: Some(SourceSwitch {
            turns_on: inputs::READ_PAD,
            is_on: view.is_some(),
            action: InputAction::ReadPad(view.is_none()),
            wrong: None,
        }),
        kind: Some(InputKind::Source(SourceKind::Pad)),
        words,
    }
}

/// Draws the gamepad found, and the grant of control.
pub(crate) fn pad_source_ui(ui: &mut Ui, pane: &mut Pane<'_>, row: &SourceRow) {
    let view = pane.hand().inputs.pad_view.as_ref();
    let is_found = view.is_some_and(|view| view.name.is_some());
    row.state_ui(ui, pane);
    if view.is_none() {
        kit::small_text_ui(ui, pane.look.tr(inputs::PAD_OFF), pane.look.palette.muted);
    }
    let missing = (!is_found).then(|| pane.look.tr(inputs::NONE));
    grant_ui(ui, pane, SourceKind::Pad, missing);
}

/// Poses that can be assigned to a button.
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

/// Draws the hand in the pose that the gamepad requests, with or without control; joints it leaves unchanged are at their actual angles.
fn dry_run_ui(ui: &mut Ui, pane: &Pane<'_>, view: &PadView) {
    let room = ui.available_width();
    if room < HAND_LEAST {
        return;
    }
    let look = pane.look;
    let angle = pane.hand().readings.sample.angle;
    let shares = PerDof::from_fn(|dof| {
        let raw = view.aims[dof]
            .map(Angle::get)
            .or(angle?.value[dof].documented())?;
        Some(f32::from(raw) / f32::from(Angle::MAX.get()))
    });
    ui.vertical(|ui| {
        kit::small_text_ui(ui, look.tr(inputs::DRY_RUN), look.palette.muted);
        let (rect, response) = ui.allocate_exact_size(vec2(room, HAND), Sense::hover());
        pose_ui(ui, look, rect, &shares);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, look.tr(inputs::DRY_RUN)));
    });
}
