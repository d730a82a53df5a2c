//! The open view beside the joints of the hand that is shown, and what the views remember between frames.

use crate::app::layout::WindowRoom;
use crate::app::slot::SlotId;
use crate::app::state::State;
use crate::ui::connection::ConnectionForm;
use crate::ui::faults::{self, FaultsView};
use crate::ui::hands::beside::BesideView;
use crate::ui::inputs::InputsView;
use crate::ui::joints::JointsView;
use crate::ui::joints::rail as joint_rail;
use crate::ui::kit::{self, Pane};
use crate::ui::params::DeviceView;
use crate::ui::plots::PlotView;
use crate::ui::poses::PoseView;
use crate::ui::poses::tiles as pose_tiles;
use crate::ui::sessions::SessionsView;
use crate::ui::theme;
use crate::ui::touch::TouchView;
use crate::ui::traffic::TrafficView;
use crate::ui::trials::tune::TuneView;
use crate::ui::view::View;
use crate::ui::window::rooms::{RoomSize, Rooms};
use crate::ui::window::status::StatusLine;
use egui::{Panel, Rect, Ui, UiBuilder};
use std::collections::BTreeMap;

/// The least width of the joints: every number in its place.
const JOINTS_LEAST: f32 = 384.0;
/// The least width of the hand and its fingertips beside the plots.
const SIDE_LEAST: f32 = 288.0;
/// The least width of the plots.
const PLOTS_LEAST: f32 = 320.0;
/// A replay shows poses, too, where the view is as high as this.
const REPLAY_WITH_POSES: f32 = 480.0;
/// Height of the strip of poses in a low window, and its least one.
const STRIP_LEAST: f32 = 88.0;

/// The views, and which one is open.
#[derive(Debug, Default)]
pub(super) struct Body {
    pub(super) view: View,
    /// The slot of the hand that was shown last, what its views remember, and what those of the others do.
    slot: SlotId,
    pub(super) own: HandViews,
    others: BTreeMap<SlotId, HandViews>,
    /// All hands are shown side by side in place of the live view.
    shows_all: bool,
    all: BesideView,
    rooms: Rooms,
    poses: PoseView,
    tune: TuneView,
    sessions: SessionsView,
}

/// What the views of one hand remember between frames. Nothing of it is taken for another hand's.
#[derive(Debug, Default)]
pub(super) struct HandViews {
    pub(super) joints: JointsView,
    pub(super) plots: PlotView,
    pub(super) faults: FaultsView,
    pub(super) status: StatusLine,
    pub(super) device: DeviceView,
    pub(super) connection: ConnectionForm,
    pub(super) inputs: InputsView,
    pub(super) touch: TouchView,
    pub(super) traffic: TrafficView,
}

impl Body {
    /// True if another hand is shown now: its views are as they were left.
    pub(super) fn follow_shown(&mut self, state: &State) -> bool {
        let slot = state.hand().label.slot;
        if slot == self.slot {
            return false;
        }
        let next = self.others.remove(&slot);
        let is_new = next.is_none() && state.hand().connection.endpoint.is_none();
        let mut before = std::mem::replace(&mut self.own, next.unwrap_or_default());
        if is_new {
            // Where the next hand is was typed before its place was made.
            self.own.connection = std::mem::take(&mut before.connection);
        }
        self.others
            .insert(std::mem::replace(&mut self.slot, slot), before);
        let is_there = |slot: &SlotId| state.hands.iter().any(|hand| hand.label.slot == *slot);
        self.others.retain(|slot, _| is_there(slot));
        true
    }

    /// True while all hands are shown side by side.
    pub(super) fn shows_all(&self) -> bool {
        self.shows_all && self.view == View::Live
    }

    /// Opens the live view with all hands side by side, or with the shown one alone.
    pub(super) const fn show_all(&mut self, on: bool) {
        (self.shows_all, self.view) = (on, View::Live);
    }

    /// Draws the joints, and beside them the open view.
    pub(super) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.rooms.begin(pane.state.settings.layout);
        self.joints_ui(ui, pane);
        let rect = ui.available_rect_before_wrap();
        self.view_ui(ui, rect, pane);
    }

    /// The joints at the left of `ui`: all of each where they are set, else a rail with what matters.
    fn joints_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let sets_joints = matches!(
            self.view,
            View::Live | View::Touch | View::Poses | View::Tune
        );
        if pane.state.settings.layout.joints.shut || !sets_joints {
            let rail = Panel::left("rail");
            let rail = kit::bare(rail, 144.0 + theme::GAP, theme::GAP_RIGHT);
            rail.show(ui, |ui| joint_rail::rail_ui(ui, pane, sets_joints));
            return;
        }
        let designed = ui.ctx().content_rect().width() * 0.29;
        let size = RoomSize {
            designed: designed.clamp(JOINTS_LEAST, 560.0) + theme::GAP,
            least: JOINTS_LEAST + theme::GAP,
            rest: PLOTS_LEAST + theme::GAP + SIDE_LEAST,
        };
        let Self { rooms, own, .. } = self;
        rooms.room_ui(ui, pane, (WindowRoom::Joints, size), |ui, pane| {
            own.joints.ui(ui, pane);
        });
    }

    fn view_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        if self.view != View::Sessions {
            self.sessions.leave();
        }
        match self.view {
            View::Live if self.shows_all && pane.state.hands.is_several() => {
                self.all_ui(ui, pane);
            }
            View::Live => self.live_ui(ui, rect, pane),
            View::Touch => self.own.touch.large_ui(ui, pane),
            View::Tune => self.tune.ui(ui, pane),
            View::Compare => self.tune.results_ui(ui, pane),
            View::Faults => self.own.faults.ui(ui, pane),
            View::Poses => self.poses.ui(ui, pane),
            View::Device => self.own.device.ui(ui, pane),
            View::Connection => self.own.connection.ui(ui, pane),
            View::Inputs => self.own.inputs.ui(ui, pane),
            View::Traffic => self.own.traffic.ui(ui, pane),
            View::Sessions => self.sessions.ui(ui, pane),
        }
    }

    /// All hands side by side, over the poses.
    fn all_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let strip = RoomSize {
            designed: strip_height(ui.available_height()) + theme::GAP,
            least: STRIP_LEAST + theme::GAP,
            rest: 300.0,
        };
        let Self { rooms, all, .. } = self;
        rooms.room_ui(ui, pane, (WindowRoom::Strip, strip), pose_tiles::strip_ui);
        all.ui(ui, pane);
    }

    fn live_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        if self.own.plots.large {
            self.plots_ui(ui, rect, pane);
            return;
        }
        let Self { rooms, own, .. } = self;
        let strip = RoomSize {
            designed: strip_height(rect.height()) + theme::GAP,
            least: STRIP_LEAST + theme::GAP,
            rest: 300.0,
        };
        // Under a time line, a small window has room for what was measured only; no pose can be taken there anyway.
        if pane.state.timeline.is_none() || rect.height() >= REPLAY_WITH_POSES {
            rooms.room_ui(ui, pane, (WindowRoom::Strip, strip), pose_tiles::strip_ui);
        }
        let side = (rect.width() * 0.4).clamp(SIDE_LEAST, 560.0);
        let side = RoomSize {
            designed: side + theme::GAP,
            least: SIDE_LEAST + theme::GAP,
            rest: PLOTS_LEAST,
        };
        rooms.room_ui(ui, pane, (WindowRoom::Side, side), |ui, pane| {
            let faults = RoomSize {
                designed: 104.0 + theme::GAP,
                least: 84.0 + theme::GAP,
                rest: 200.0,
            };
            rooms.room_ui(
                ui,
                pane,
                (WindowRoom::Faults, faults),
                faults::faults_card_ui,
            );
            own.touch.small_ui(ui, pane);
        });
        let rect = ui.available_rect_before_wrap();
        self.plots_ui(ui, rect, pane);
    }

    fn plots_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            self.own.plots.ui(ui, pane)
        });
    }
}

/// Height of the strip of poses in a view as high as this.
const fn strip_height(view: f32) -> f32 {
    if view < 640.0 { STRIP_LEAST } else { 212.0 }
}
