//! The open view beside the joints of the shown hand, and the view state of all hands.

use crate::app::layout::WindowRoom;
use crate::app::slot::SlotId;
use crate::app::state::State;
use crate::ui::checkup::CheckupPanel;
use crate::ui::connection::ConnectionForm;
use crate::ui::faults::FaultsView;
use crate::ui::hands::beside::BesideView;
use crate::ui::inputs::InputsView;
use crate::ui::joints::JointsView;
use crate::ui::joints::rail as joint_rail;
use crate::ui::kit::{self, Button, Pane, ViewRequest, Weight};
use crate::ui::params::DeviceView;
use crate::ui::plots::PlotView;
use crate::ui::poses::PoseView;
use crate::ui::poses::tiles as pose_tiles;
use crate::ui::recordings::RecordingsView;
use crate::ui::text::window;
use crate::ui::theme;
use crate::ui::touch::TouchView;
use crate::ui::traffic::TrafficView;
use crate::ui::trials::recorded;
use crate::ui::trials::tune::TuneView;
use crate::ui::view::{Tab, View};
use crate::ui::window::rooms::{RoomSize, Rooms};
use crate::ui::window::status::StatusLine;
use egui::{Align, Layout, Panel, Rect, Ui, UiBuilder, vec2};
use std::collections::BTreeMap;

/// Minimum width of the joints: every number fits.
const JOINTS_LEAST: f32 = 384.0;
/// Minimum width of the hand and its fingertips.
const STAGE_LEAST: f32 = 288.0;
/// Minimum width of the plots, and of each view that replaces them.
const PLOTS_LEAST: f32 = 320.0;
const FAULTS_LEAST: f32 = 480.0;
const FINGERTIP_LEAST: f32 = 640.0;
/// Minimum height of the view at which a replay shows poses, too.
const REPLAY_WITH_POSES: f32 = 480.0;
/// Width of the list of a recording's trials.
const TRIALS: f32 = 288.0;
/// Height of the strip of poses: a row of tiles below its heading.
const STRIP: f32 = 136.0;
/// Height in a low window, which is also the minimum.
const STRIP_LEAST: f32 = 88.0;

/// All views, and the open one.
#[derive(Debug, Default)]
pub(super) struct WindowViews {
    pub(super) view: View,
    /// View opened last in the Hand tab.
    hand_view: Option<View>,
    /// View to return to when the faults are closed.
    before_faults: View,
    /// Slot of the hand shown last, its view state, and the view states of the other hands.
    slot: SlotId,
    pub(super) own: HandViews,
    others: BTreeMap<SlotId, HandViews>,
    /// Show all hands side by side in place of the live view.
    shows_all: bool,
    all: BesideView,
    rooms: Rooms,
    poses: PoseView,
    tune: TuneView,
    recordings: RecordingsView,
}

/// View state of one hand. None of it is used for another hand.
#[derive(Debug, Default)]
pub(super) struct HandViews {
    pub(super) joints: JointsView,
    pub(super) plots: PlotView,
    pub(super) faults: FaultsView,
    pub(super) status: StatusLine,
    pub(super) device: DeviceView,
    pub(super) checkup: CheckupPanel,
    pub(super) connection: ConnectionForm,
    pub(super) inputs: InputsView,
    pub(super) touch: TouchView,
    pub(super) traffic: TrafficView,
}

impl WindowViews {
    /// Switches to the view state of the shown hand. True if another hand is shown now.
    pub(super) fn follow_shown(&mut self, state: &State) -> bool {
        let slot = state.hand().label.slot;
        if slot == self.slot {
            return false;
        }
        let next = self.others.remove(&slot);
        let is_new = next.is_none() && state.hand().connection.endpoint.is_none();
        let mut before = std::mem::replace(&mut self.own, next.unwrap_or_default());
        if is_new {
            // The address of a new hand was typed before its slot existed.
            self.own.connection = std::mem::take(&mut before.connection);
            self.own.connection.focus_address();
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

    /// Opens the live view, with all hands side by side or with the shown one alone.
    pub(super) const fn show_all(&mut self, on: bool) {
        (self.shows_all, self.view) = (on, View::Live);
    }

    pub(super) fn show(&mut self, view: View) {
        if view == View::Faults && self.view != view {
            self.before_faults = self.view;
        }
        self.view = view;
        if view.tab() == Tab::Hand {
            self.hand_view = Some(view);
        }
    }

    /// Opens a tab at its first view; the Hand tab at its last one.
    pub(super) fn show_tab(&mut self, tab: Tab) {
        let first = tab.views().first().copied().unwrap_or_default();
        let last = self.hand_view.filter(|_| tab == Tab::Hand);
        self.show(last.unwrap_or(first));
    }

    /// Opens the faults of all drives, or returns to the view that was open before.
    pub(super) fn toggle_faults(&mut self) {
        self.own.faults.choose(None);
        let back = self.view == View::Faults;
        self.show(if back {
            self.before_faults
        } else {
            View::Faults
        });
    }

    /// Draws the joints, and the open view beside them.
    pub(super) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.rooms.begin(pane.layouts(ui));
        self.joints_ui(ui, pane);
        let rect = ui.available_rect_before_wrap();
        self.view_ui(ui, rect, pane);
    }

    /// Draws the joints at the left of `ui`: in full where they can be set, else as a rail with their main values.
    fn joints_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let sets_joints = self.view.tab() == Tab::Live;
        if self.rooms.is_shut(WindowRoom::Joints) || !sets_joints {
            let rail = Panel::left("rail");
            let rail = kit::bare(rail, 144.0 + theme::GAP, theme::GAP_RIGHT);
            rail.show(ui, |ui| joint_rail::rail_ui(ui, pane, sets_joints));
            return;
        }
        let designed = ui.ctx().content_rect().width() * 0.295;
        let size = RoomSize {
            room: WindowRoom::Joints,
            designed: designed.clamp(JOINTS_LEAST, 520.0) + theme::GAP,
            least: JOINTS_LEAST + theme::GAP,
            rest: PLOTS_LEAST + theme::GAP + STAGE_LEAST,
        };
        let Self { rooms, own, .. } = self;
        rooms.room_ui(ui, pane, size, |ui, pane| own.joints.ui(ui, pane));
    }

    fn view_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        fade_in(ui, self.view.tab());
        if self.view != View::Recordings {
            self.recordings.leave();
        }
        if self.view.tab() == Tab::Hand {
            self.hand_views_ui(ui, pane);
        }
        match self.view {
            View::Live if self.shows_all && pane.state.hands.is_several() => {
                self.all_ui(ui, pane);
            }
            View::Live | View::Touch | View::Poses | View::Faults => self.live_ui(ui, rect, pane),
            View::Tune | View::Compare if pane.recorded().is_some() => {
                self.recorded_trials_ui(ui, pane);
            }
            View::Tune => self.tune.ui(ui, pane),
            View::Compare => self.tune.results_ui(ui, pane),
            View::Device => self.own.device.ui(ui, pane),
            View::Checkup => self.own.checkup.ui(ui, pane),
            View::Connection => self.own.connection.ui(ui, pane),
            View::Inputs => self.own.inputs.ui(ui, pane),
            View::Traffic => self.own.traffic.ui(ui, pane),
            View::Recordings => self.recordings.ui(ui, pane),
        }
    }

    /// Draws the buttons for the views of the Hand tab.
    fn hand_views_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        ui.horizontal(|ui| {
            for view in Tab::Hand.views() {
                let button = Button::text(pane.look, view.title());
                let button = button.choice(*view == self.view).large();
                button.navigate(ui, pane, ViewRequest::View(*view));
            }
        });
        ui.add_space(theme::STEP);
    }

    /// Draws the trials of a recording beside its plots.
    fn recorded_trials_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        if let Some(line) = &pane.state.timeline {
            let panel = kit::bare(Panel::left("trials"), TRIALS, theme::GAP_RIGHT);
            panel.show(ui, |ui| recorded::list_ui(ui, pane, line));
        }
        self.own.plots.ui(ui, pane);
    }

    /// Draws all hands side by side, above the poses.
    fn all_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let strip = strip_size(ui.available_height());
        let Self { rooms, all, .. } = self;
        rooms.room_ui(ui, pane, strip, pose_tiles::strip_ui);
        all.ui(ui, pane);
    }

    fn live_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let shows_plots = self.view == View::Live;
        if self.own.plots.large && shows_plots {
            self.plots_ui(ui, rect, pane);
            return;
        }
        let Self {
            view, rooms, own, ..
        } = self;
        let has_large = *view == View::Touch;
        let strip = strip_size(rect.height());
        // Below a timeline, a small window has room for measurements only; no pose can be sent there anyway.
        let has_room = pane.state.timeline.is_none() || rect.height() >= REPLAY_WITH_POSES;
        if has_room && self.view != View::Poses {
            rooms.room_ui(ui, pane, strip, pose_tiles::strip_ui);
        }
        let width = ui.available_width();
        let stage = RoomSize {
            room: WindowRoom::Stage,
            designed: (width * 0.45).clamp(STAGE_LEAST, 680.0) + theme::GAP,
            least: STAGE_LEAST + theme::GAP,
            rest: match self.view {
                View::Touch => FINGERTIP_LEAST,
                View::Faults => FAULTS_LEAST,
                View::Poses => self.poses.least_width(),
                _ => PLOTS_LEAST,
            },
        };
        if width >= stage.least + stage.rest {
            rooms.room_ui(ui, pane, stage, |ui, pane| {
                own.touch.small_ui(ui, pane, has_large);
            });
        }
        let rect = ui.available_rect_before_wrap();
        match self.view {
            View::Touch => {
                to_plots_ui(ui, pane);
                self.own.touch.large_ui(ui, pane);
            }
            View::Poses => {
                to_plots_ui(ui, pane);
                self.poses.ui(ui, pane);
            }
            View::Faults => self.own.faults.ui(ui, pane),
            _ => self.plots_ui(ui, rect, pane),
        }
    }

    fn plots_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            self.own.plots.ui(ui, pane)
        });
    }
}

/// Fades in the tab that was just opened, over the animation time of the style; at once if that is zero.
fn fade_in(ui: &mut Ui, open: Tab) {
    for tab in Tab::ALL {
        let id = ui.scope_id().with(("fade", tab));
        let share = ui.ctx().animate_bool(id, tab == open);
        if tab == open {
            ui.multiply_opacity(share);
        }
    }
}

/// Draws the button that returns to the plots, above the view that replaces them.
fn to_plots_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let size = vec2(ui.available_width(), theme::CONTROL);
    let row = Layout::right_to_left(Align::Center);
    ui.allocate_ui_with_layout(size, row, |ui| {
        let back = Button::text(pane.look, window::TO_PLOTS).weight(Weight::Quiet);
        back.navigate(ui, pane, ViewRequest::View(View::Live));
    });
}

/// Size of the strip of poses in a view of this height.
fn strip_size(view: f32) -> RoomSize {
    let designed = if view < 560.0 { STRIP_LEAST } else { STRIP };
    RoomSize {
        room: WindowRoom::Strip,
        designed: designed + theme::GAP,
        least: STRIP_LEAST + theme::GAP,
        rest: 300.0,
    }
}
