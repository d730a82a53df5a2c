//! The whole window: where each part stands, which keys act everywhere. Holds view state only, no hand.
pub(crate) mod banner;
pub(crate) mod key_list;
pub(crate) mod keys;
pub(crate) mod menu;
pub(crate) mod message_log;
pub(crate) mod note_bar;
pub(crate) mod rooms;
pub(crate) mod top_bar;

use crate::app::action::Action;
use crate::app::hand::{Play, Preset};
use crate::app::layout::Room;
use crate::app::params::action::ParamAction;
use crate::app::procedures::ProcedureAction;
use crate::app::settings::{Language, Theme};
use crate::app::state::State;
use crate::app::trials::TrialAction;

use crate::ui::connection::ConnectionForm;
use crate::ui::faults::{self, FaultsView};
use crate::ui::joints::JointsView;
use crate::ui::joints::rail as joint_rail;
use crate::ui::joints::row::Row;
use crate::ui::kit::border::{border_ui, shut_ui};
use crate::ui::kit::card::CardView;
use crate::ui::kit::look::{Explain, Look, Pane, Typing};
use crate::ui::params::DeviceView;
use crate::ui::params::card as device_card;
use crate::ui::params::procedures as guard;
use crate::ui::plots::PlotView;
use crate::ui::poses::PoseView;
use crate::ui::poses::tiles as pose_tiles;
use crate::ui::theme;
use crate::ui::trials::compare;
use crate::ui::trials::compare::CompareView;
use crate::ui::view::View;
use crate::ui::window::key_list::KeyList;
use crate::ui::window::keys::Wish;
use crate::ui::window::note_bar::NoteBar;
use crate::ui::window::rooms::{Body, Overview, Side};

use crate::ui::touch::{self, TouchView};
use crate::ui::traffic::TrafficView;
use crate::ui::trials::tune::TuneView;
use egui::{Rect, Ui, UiBuilder};

/// What the window remembers between frames: the open tab, text in progress, what is hidden.
#[derive(Debug, Default)]
pub struct Window {
    view: View,
    installed: Option<(Theme, Language)>,
    typing: Typing,
    joints: JointsView,
    plots: PlotView,
    faults: FaultsView,
    note: NoteBar,
    key_list: KeyList,
    cards: CardView,
    poses: PoseView,
    device: DeviceView,
    connection: ConnectionForm,
    touch: TouchView,
    traffic: TrafficView,
    tune: TuneView,
    compare: CompareView,
}

/// Puts fonts and style into a context. The window does it itself when the settings change.
pub fn install(ctx: &egui::Context, theme: Theme, _language: Language) {
    ctx.set_fonts(theme::fonts());
    restyle(ctx, theme);
}

fn restyle(ctx: &egui::Context, theme: Theme) {
    ctx.all_styles_mut(|style| *style = theme::style(theme, style));
}

impl Window {
    /// A window on its first view.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Opens a view.
    pub fn set_view(&mut self, view: View) {
        self.view = view;
    }

    /// The open view.
    #[must_use]
    pub const fn view(&self) -> View {
        self.view
    }

    /// Draws the window over all of `ui` and returns what the person asked for, stop first.
    pub fn ui(&mut self, ui: &mut Ui, state: &State) -> Vec<Action> {
        self.install_if_changed(ui, state);
        let mut actions = Vec::new();
        let mut wishes = if state.hand().runs_series() {
            keys::take_any(ui)
        } else {
            keys::take(ui)
        };
        if is_covered(state) {
            wishes.retain(|wish| *wish == Wish::Stop);
        }
        let stopped = wishes.contains(&Wish::Stop);
        let mut typing = std::mem::take(&mut self.typing);
        let mut explain = None;
        let mut pane = Pane {
            state,
            look: Look::of(state),
            actions: &mut actions,
            typing: &mut typing,
            explain: &mut explain,
        };
        for wish in wishes {
            self.obey(ui, &mut pane, wish);
        }
        self.parts_ui(ui, &mut pane);
        self.typing = typing;
        self.explain(explain);
        stop_first(actions, stopped)
    }

    /// Does what a key asks for, under the same conditions as the control that does it.
    fn obey(&mut self, ui: &Ui, pane: &mut Pane<'_>, wish: Wish) {
        let state = pane.state;
        let armed = state.hand().is_armed();
        let preset = |preset| armed.then_some(Action::Preset(preset));
        let action = match wish {
            // Goes ahead of all others, at the end of the frame.
            Wish::Stop => None,
            Wish::ArmOrNot if armed => Some(Action::Disarm),
            Wish::ArmOrNot => Some(Action::Arm),
            Wish::Open => preset(Preset::Open),
            Wish::Half => preset(Preset::Half),
            Wish::Close => preset(Preset::Close),
            Wish::AngleUnit => Some(Action::AngleUnit(state.settings.angle_unit.next())),
            Wish::Tare => state
                .hand()
                .link
                .state
                .is_live()
                .then_some(Action::Tare(None)),
            Wish::UndoTare => state.hand().tare.can_undo().then_some(Action::UndoTare),
            Wish::Language => Some(Action::Language(state.settings.language.other())),
            Wish::Theme => Some(Action::Theme(state.settings.theme.other())),
            Wish::Pause => Some(Action::PausePlots(self.plots.sight.toggle())),
            Wish::Joint(dof) => {
                Row::new(dof, pane).focus(ui, armed && !state.hand().joints[dof].locked);
                None
            }
            Wish::LinkFingers => {
                self.joints.toggle_link();
                None
            }
            Wish::Note => {
                self.note.open(state.now);
                None
            }
            Wish::View(view) => {
                self.view = view;
                None
            }
            Wish::List => {
                self.key_list.toggle();
                None
            }
        };
        pane.actions.extend(action);
    }

    fn explain(&mut self, explain: Option<Explain>) {
        let Some(explain) = explain else { return };
        self.view = View::Faults;
        self.faults.choose(match explain {
            Explain::Drive(dof) => Some(dof),
            Explain::Faults => None,
        });
    }

    fn install_if_changed(&mut self, ui: &mut Ui, state: &State) {
        let wanted = (state.settings.theme, state.settings.language);
        match self.installed.replace(wanted) {
            None => install(ui.ctx(), wanted.0, wanted.1),
            Some((theme, _)) if theme != wanted.0 => restyle(ui.ctx(), wanted.0),
            Some(_) => return,
        }
        let style = theme::style(wanted.0, ui.style());
        ui.set_style(style);
    }

    fn parts_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let whole = ui.max_rect();
        ui.painter()
            .rect_filled(whole, 0.0, pane.look.palette.window);
        let (bar, mut body) = whole.split_top_bottom_at_y(whole.top() + theme::TOP_BAR);
        let bar = top_bar::stop_first_ui(ui, bar, pane);
        if is_covered(pane.state) {
            self.key_list.hide();
            // The card's own veil dims what is below it; header and banners stay bright.
            ui.visuals_mut().disabled_alpha = 1.0;
            ui.disable();
        }
        if top_bar::top_bar_ui(ui, bar, pane) {
            self.view = View::Connection;
        }
        for banner in banner::banners(pane) {
            let height = banner.height(ui, body.width(), pane.look);
            let (place, rest) = body.split_top_bottom_at_y(body.top() + height);
            if let Some(view) = banner.ui(ui, place, pane.look) {
                self.view = view;
            }
            body = rest;
        }
        let covered = body;
        if self.note.is_open() {
            let (place, rest) = body.split_top_bottom_at_y(body.top() + theme::BANNER);
            self.note.ui(ui, place, pane);
            body = rest;
        }
        let below = body;
        let (tabs, body) = body.split_top_bottom_at_y(body.top() + theme::TABS);
        if top_bar::tabs_ui(ui, tabs, pane, &mut self.view) {
            self.key_list.toggle();
        }
        let body = Rect::from_min_max(body.min, body.max - egui::vec2(theme::GAP, theme::GAP));
        let body = body.with_min_x(body.left() + theme::GAP);
        let layout = pane.state.settings.layout;
        let body = Body::of(body, whole.width(), &layout);
        if layout.joints.shut {
            joint_rail::rail_ui(ui, body.joints, pane);
        } else {
            border_ui(ui, pane, &body.border);
            self.joints.ui(ui, body.joints, pane);
        }
        self.view_ui(ui, body.view, pane);
        self.key_list.ui(ui, below, pane.look);
        let card = guard::card_of(pane.state, pane.look);
        let card = card.or_else(|| device_card::card_of(pane.state, pane.look));
        let card = card.or_else(|| compare::card_of(pane.state, pane.look));
        let asked = self.cards.ui(ui, covered, pane.look, card);
        pane.actions.extend(asked);
    }

    fn view_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        match self.view {
            View::Live => self.live_ui(ui, rect, pane),
            View::Touch => self.touch.large_ui(ui, rect, pane),
            View::Tune => {
                if let Some(view) = self.tune.ui(ui, rect, pane) {
                    self.view = view;
                }
            }
            View::Compare => self.compare.ui(ui, rect, pane),
            View::Faults => self.faults.ui(ui, rect, pane),
            View::Poses => {
                let place = UiBuilder::new().max_rect(rect);
                ui.scope_builder(place, |ui| self.poses.ui(ui, pane));
            }
            View::Device => {
                let place = UiBuilder::new().max_rect(rect);
                ui.scope_builder(place, |ui| self.device.ui(ui, pane));
            }
            View::Connection => self.connection.ui(ui, rect, pane),
            View::Traffic => self.traffic.ui(ui, rect, pane),
        }
    }

    fn live_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        if self.plots.large {
            self.plots_ui(ui, rect, pane);
            return;
        }
        let layout = pane.state.settings.layout;
        let rooms = Overview::of(rect, &layout, touch::overview_height);
        for border in &rooms.borders {
            let shut = layout.room(border.room).shut;
            let inner = border.room == Room::Tips && (layout.side.shut || layout.faults.shut);
            if !shut && !inner {
                border_ui(ui, pane, border);
            }
        }
        if layout.strip.shut {
            shut_ui(ui, pane, rooms.strip, Room::Strip, Side::Bottom);
        } else {
            let place = UiBuilder::new().max_rect(rooms.strip);
            let opened = ui.scope_builder(place, |ui| pose_tiles::strip_ui(ui, pane));
            if opened.inner {
                self.view = View::Poses;
            }
        }
        self.plots_ui(ui, rooms.plots, pane);
        if layout.side.shut {
            shut_ui(ui, pane, rooms.side, Room::Side, Side::Right);
            return;
        }
        if layout.tips.shut {
            shut_ui(ui, pane, rooms.tips, Room::Tips, Side::Top);
        } else {
            self.touch.small_ui(ui, rooms.tips, pane);
        }
        if layout.faults.shut {
            shut_ui(ui, pane, rooms.faults, Room::Faults, Side::Bottom);
        } else {
            faults::faults_card_ui(ui, rooms.faults, pane);
        }
    }

    /// Draws the plots and nothing else, over all of `ui`, into a context of their own: for a picture.
    pub fn plots_alone_ui(&mut self, ui: &mut Ui, state: &State) {
        alone_ui(ui, state, |ui, rect, pane| self.plots.ui(ui, rect, pane));
    }

    /// Draws the hand and nothing else, over all of `ui`: for pictures and measurements.
    pub fn hand_alone_ui(&mut self, ui: &mut Ui, state: &State) {
        alone_ui(ui, state, |ui, rect, pane| {
            self.touch.hand_ui(ui, rect, pane)
        });
    }

    fn plots_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        self.plots.ui(ui, rect, pane);
        if std::mem::take(&mut self.plots.note_asked) {
            self.note.open(pane.state.now);
        }
    }
}

/// Gives one part of the window the whole place. What it asks for goes nowhere.
fn alone_ui(ui: &mut Ui, state: &State, part: impl FnOnce(&mut Ui, Rect, &mut Pane<'_>)) {
    let style = theme::style(state.settings.theme, ui.style());
    ui.set_style(style);
    let (mut actions, mut typing) = (Vec::new(), Typing::default());
    let mut pane = Pane {
        state,
        look: Look::of(state),
        actions: &mut actions,
        typing: &mut typing,
        explain: &mut None,
    };
    let whole = ui.max_rect();
    ui.painter()
        .rect_filled(whole, 0.0, pane.look.palette.window);
    part(ui, whole, &mut pane);
}

/// True while a card covers the body of the window.
fn is_covered(state: &State) -> bool {
    state.hand().procedure.is_some()
        || state.hand().params.question.is_some()
        || state.trials.to_confirm.is_some()
}

/// Stop goes ahead of everything, and nothing that moves the hand passes in the same frame.
fn stop_first(mut actions: Vec<Action>, stopped: bool) -> Vec<Action> {
    if !stopped && !actions.contains(&Action::Stop) {
        return actions;
    }
    actions.retain(|action| {
        !matches!(
            action,
            Action::Stop
                | Action::Arm
                | Action::Target(..)
                | Action::Preset(_)
                | Action::Gesture(_)
                | Action::Recall(_)
                | Action::TryAngles(_)
                | Action::Param(
                    ParamAction::Apply | ParamAction::Undo | ParamAction::Save | ParamAction::Agree
                )
                | Action::Trial(TrialAction::Start)
                | Action::Procedure(ProcedureAction::Begin | ProcedureAction::Save)
                | Action::Play(Play::Start(_) | Play::Step(_) | Play::Resume)
        )
    });
    actions.insert(0, Action::Stop);
    actions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Angle, Dof, Gesture, PerDof};
    use crate::poses::library::{PoseId, SequenceId};

    #[test]
    fn a_stop_goes_first_and_nothing_moves_in_the_same_frame() {
        let moves = || {
            vec![
                Action::Arm,
                Action::Target(Dof::Index, Angle::MAX),
                Action::Preset(Preset::Open),
                Action::Gesture(Gesture::MIN),
                Action::Recall(PoseId(1)),
                Action::Procedure(ProcedureAction::Begin),
                Action::TryAngles(PerDof::splat(Angle::MAX)),
                Action::Trial(TrialAction::Start),
                Action::Play(Play::Start(SequenceId(1))),
                Action::Play(Play::Step(SequenceId(1))),
                Action::Play(Play::Resume),
                Action::Param(ParamAction::Apply),
                Action::Param(ParamAction::Undo),
                Action::Param(ParamAction::Save),
                Action::Param(ParamAction::Agree),
                Action::FindPorts,
            ]
        };
        let stopped = [Action::Stop, Action::FindPorts];
        assert_eq!(stop_first(moves(), true), stopped);
        let mut with_button = moves();
        with_button.push(Action::Stop);
        assert_eq!(stop_first(with_button, false), stopped);
        assert_eq!(stop_first(moves(), false), moves());
    }

    #[test]
    fn every_view_is_found_by_its_name() {
        for view in View::ALL {
            assert_eq!(View::by_name(view.name()), Some(view));
        }
        assert_eq!(View::by_name("LIVE"), None);
    }
}
