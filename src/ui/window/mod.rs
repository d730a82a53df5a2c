//! The whole window: where each part stands, which keys act everywhere. Holds view state only, no hand.
//!
//! ```text
//! +----------------------------------------------------------+
//! | header: hand, link, rates                      arm, STOP |
//! | several hands: a strip for each, with its STOP            |
//! | status: warning, what moves the hand, message, note      |
//! | tabs                              keys, theme, language, ≡ |
//! +----------+-----------------------------------------------+
//! | joints   | view                                          |
//! |          |   Live: plots         | hand and fingertips   |
//! |          |                       +---------------------- |
//! |          |                       | faults                |
//! |          |   --------------------+---------------------- |
//! |          |   poses and gestures                          |
//! +----------+-----------------------------------------------+
//! ```
pub(crate) mod header;
pub(crate) mod key_list;
pub(crate) mod keys;
pub(crate) mod message_log;
pub(crate) mod rooms;
pub(crate) mod status;
pub(crate) mod timeline;

use crate::app::action::Action;
use crate::app::hand::HandState;
use crate::app::hand::held_key::HoldKey;
use crate::app::hand::slot::SlotId;
use crate::app::hand::{Play, Preset};
use crate::app::hands::action::HandsAction;
use crate::app::inputs::InputAction;
use crate::app::layout::WindowRoom;
use crate::app::params::action::ParamAction;
use crate::app::procedures::ProcedureAction;
use crate::app::sessions::SessionAction;
use crate::app::settings::{Language, Theme, Zoom};
use crate::app::state::State;
use crate::app::trials::TrialAction;
use crate::hand::Moment;

use crate::ui::connection::ConnectionForm;
use crate::ui::exhibit::{self, ExhibitPage};
use crate::ui::faults::{self, FaultsView};
use crate::ui::hands::beside::BesideView;
use crate::ui::hands::strips;
use crate::ui::inputs::InputsView;
use crate::ui::joints::JointsView;
use crate::ui::joints::rail as joint_rail;
use crate::ui::joints::row::JointRow;
use crate::ui::kit::{self, Card, CardView, Choice, Look, Manner, Opens, Pane, Typing};
use crate::ui::params::DeviceView;
use crate::ui::params::card as device_card;
use crate::ui::params::procedures as guard;
use crate::ui::plots::PlotView;
use crate::ui::poses::PoseView;
use crate::ui::poses::tiles as pose_tiles;
use crate::ui::sessions::{self, SessionsView};
use crate::ui::text::window;
use crate::ui::theme;
use crate::ui::trials::compare;
use crate::ui::trials::compare::CompareView;
use crate::ui::view::View;
use crate::ui::window::key_list::KeyList;
use crate::ui::window::keys::{Escape, Wish};
use crate::ui::window::rooms::{RoomSize, Rooms};
use crate::ui::window::status::StatusLine;

use crate::ui::touch::TouchView;
use crate::ui::traffic::TrafficView;
use crate::ui::trials::tune::TuneView;
use egui::{Frame, Key, Margin, Panel, Rect, Stroke, Ui, UiBuilder};
use std::collections::BTreeMap;

/// The least width of the joints: every number in its place.
const JOINTS_LEAST: f32 = 384.0;
/// Its least width.
const SIDE_LEAST: f32 = 288.0;
/// The least width of the plots.
const PLOTS_LEAST: f32 = 320.0;
/// A replay shows poses, too, where the view is as high as this.
const REPLAY_WITH_POSES: f32 = 480.0;
/// Height of the strip in a low window, and its least one.
const STRIP_LEAST: f32 = 88.0;

/// What the window remembers between frames: the open tab, text in progress, what is hidden.
#[derive(Debug, Default)]
pub struct Window {
    view: View,
    installed: Option<(Theme, Language)>,
    typing: Typing,
    /// A field had the keyboard in the last frame: Esc takes it away before anybody can ask.
    typed: bool,
    /// The slot of the hand that was shown last, what its views remember, and what those of the others do.
    slot: SlotId,
    own: HandViews,
    others: BTreeMap<SlotId, HandViews>,
    /// All hands are shown side by side in place of the live view.
    shows_all: bool,
    all: BesideView,
    rooms: Rooms,
    key_list: KeyList,
    cards: CardView,
    poses: PoseView,
    tune: TuneView,
    compare: CompareView,
    sessions: SessionsView,
    /// The page that is shown in place of all else.
    exhibit: Option<ExhibitPage>,
}

/// What the views of one hand remember between frames. Nothing of it is taken for another hand's.
#[derive(Debug, Default)]
struct HandViews {
    joints: JointsView,
    plots: PlotView,
    faults: FaultsView,
    status: StatusLine,
    device: DeviceView,
    connection: ConnectionForm,
    inputs: InputsView,
    touch: TouchView,
    traffic: TrafficView,
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

    /// Shows all hands side by side.
    pub fn show_all_hands(&mut self) {
        (self.view, self.shows_all) = (View::Live, true);
    }

    /// Lets the plots show just this stretch of time, in seconds.
    pub const fn show_stretch(&mut self, stretch: (f64, f64)) {
        self.own.plots.pin(stretch);
    }

    /// The open view.
    #[must_use]
    pub const fn view(&self) -> View {
        self.view
    }

    /// Draws the window over all of `ui` and returns what the person asked for, stop first.
    pub fn ui(&mut self, ui: &mut Ui, state: &State) -> Vec<Action> {
        if let Some(exhibit) = &state.exhibit {
            self.install_if_changed(ui, state);
            let page = self.exhibit.get_or_insert_default();
            return page.ui(ui, state, exhibit);
        }
        // What is kept holds from the second frame on.
        let zoomed = match self.exhibit.take() {
            Some(_) => {
                exhibit::leave(ui.ctx(), state.settings.zoom);
                None
            }
            None => self.installed.and_then(|_| zoomed(ui, state)),
        };
        self.install_if_changed(ui, state);
        self.follow_shown(ui, state);
        let mut actions = Vec::from_iter(zoomed);
        let escape = self.escape(ui, state);
        let mut wishes = match state.hands.iter().any(HandState::runs_series) {
            true => keys::take_any(ui),
            false => keys::take(ui, escape),
        };
        if is_covered(state) {
            wishes.retain(|wish| *wish == Wish::Stop);
        }
        let dropped = ui.input(|input| {
            let files = input.raw.dropped_files.iter();
            let mut paths = files.map(|file| file.path().to_owned());
            paths.find(|path| path.extension().is_some_and(|ending| ending == "mcap"))
        });
        actions.extend(dropped.map(|path| Action::Session(SessionAction::Open(path))));
        let stopped = wishes.contains(&Wish::Stop);
        actions.extend(held(ui, state, &wishes));
        let mut typing = std::mem::take(&mut self.typing);
        let mut opens = None;
        let mut pane = Pane {
            state,
            look: Look::of(state),
            actions: &mut actions,
            typing: &mut typing,
            opens: &mut opens,
        };
        for wish in wishes {
            self.obey(ui, &mut pane, wish);
        }
        self.parts_ui(ui, &mut pane);
        self.typing = typing;
        self.typed = ui.ctx().text_edit_focused();
        if let Some(opens) = opens {
            self.open(opens, state.now);
            ui.request_repaint();
        }
        stop_first(actions, stopped)
    }

    /// Does what a key asks for, under the same conditions as the control that does it.
    fn obey(&mut self, ui: &Ui, pane: &mut Pane<'_>, wish: Wish) {
        let state = pane.state;
        let armed = state.hand().is_armed();
        let preset = |preset| armed.then_some(Action::Preset(preset));
        let action = match wish {
            // Goes ahead of all others, at the end of the frame.
            Wish::Stop | Wish::HoldToRun => None,
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
            Wish::Tare if !state.hand().link.state.is_live() => None,
            Wish::Tare => Some(Action::Tare(None)),
            Wish::UndoTare => state.hand().tare.can_undo().then_some(Action::UndoTare),
            Wish::Language => Some(Action::Language(state.settings.language.other())),
            Wish::Theme => Some(Action::Theme(state.settings.theme.other())),
            Wish::Pause => Some(Action::PausePlots(self.own.plots.view.time.toggle())),
            // With the pointer still held, the next hand would go on with what was begun at this one.
            Wish::Hand(_) if ui.input(|input| input.pointer.any_down()) => None,
            Wish::Hand(at) if state.timeline.is_none() => {
                let hand = state.hands.iter().nth(at);
                hand.map(|hand| Action::Hands(HandsAction::Show(hand.label.slot)))
            }
            Wish::Hand(_) => None,
            Wish::Joint(dof) => {
                JointRow::new(dof, pane).focus(ui, armed && !state.hand().joints[dof].locked);
                None
            }
            Wish::LinkFingers => {
                self.own.joints.toggle_link();
                None
            }
            Wish::Opens(opens) => {
                self.open(opens, state.now);
                None
            }
        };
        pane.actions.extend(action);
    }

    /// Another hand is shown: its views are as they were left, and nothing that was begun at the one before goes on at it.
    fn follow_shown(&mut self, ui: &Ui, state: &State) {
        let slot = state.hand().label.slot;
        if slot == self.slot {
            return;
        }
        let next = self.others.remove(&slot).unwrap_or_default();
        let before = std::mem::replace(&mut self.own, next);
        self.others
            .insert(std::mem::replace(&mut self.slot, slot), before);
        let is_there = |slot: &SlotId| state.hands.iter().any(|hand| hand.label.slot == *slot);
        self.others.retain(|slot, _| is_there(slot));
        self.typing = Typing::default();
        ui.ctx().stop_dragging();
        ui.memory_mut(|memory| {
            if let Some(focused) = memory.focused() {
                memory.surrender_focus(focused);
            }
        });
        egui::Popup::close_all(ui.ctx());
    }

    /// What Esc does now: it closes what is open while the hand rests for certain.
    fn escape(&mut self, ui: &Ui, state: &State) -> Escape {
        let is_open = self.key_list.is_open()
            || self.own.status.writes_note()
            || self.cards.informs()
            || self.typed
            || egui::Popup::is_any_open(ui.ctx());
        if !is_open || !state.hands.iter().all(HandState::rests) {
            return Escape::Stops;
        }
        // Popups, fields and cards do so themselves.
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.key_list.hide();
            self.own.status.drop_note();
        }
        Escape::Closes
    }

    fn open(&mut self, opens: Opens, now: Moment) {
        if let Opens::Faults | Opens::Drive(_) = opens {
            self.view = View::Faults;
        }
        match opens {
            Opens::View(view) => self.view = view,
            Opens::Faults => self.own.faults.choose(None),
            Opens::Drive(dof) => self.own.faults.choose(Some(dof)),
            Opens::Note => self.own.status.open_note(now),
            Opens::Keys => self.key_list.toggle(),
        }
    }

    fn install_if_changed(&mut self, ui: &mut Ui, state: &State) {
        let wanted = (state.settings.theme, state.settings.language);
        match self.installed.replace(wanted) {
            None => {
                install(ui.ctx(), wanted.0, wanted.1);
                ui.ctx().set_zoom_factor(state.settings.zoom.into());
            }
            Some((theme, _)) if theme != wanted.0 => restyle(ui.ctx(), wanted.0),
            Some(_) => return,
        }
        let style = theme::style(wanted.0, ui.style());
        ui.set_style(style);
    }

    fn parts_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let palette = pane.look.palette;
        ui.painter().rect_filled(ui.max_rect(), 0.0, palette.window);
        self.rooms.begin(pane.state.settings.layout);
        let is_free = !is_covered(pane.state);
        if !is_free {
            // The card's own veil dims what is below it; what is above stays bright.
            ui.visuals_mut().disabled_alpha = 1.0;
        }
        let header = Frame::new()
            .fill(palette.card)
            .stroke(Stroke::new(1.0, palette.edge))
            .inner_margin(Margin::symmetric(12, 8));
        bar_ui(ui, ("header", theme::TOP_BAR), header, |ui| {
            header::header_ui(ui, pane, is_free);
        });
        if let Some(line) = &pane.state.timeline {
            let frame = Frame::new().fill(palette.card).inner_margin(MARGIN);
            bar_ui(ui, ("timeline", timeline::HEIGHT), frame, |ui| {
                timeline::timeline_ui(ui, pane, line);
            });
        }
        if pane.state.hands.is_several() {
            let frame = Frame::new().fill(palette.card).inner_margin(STRIPS_MARGIN);
            let room = ui.available_width() - STRIPS_MARGIN.sum().x;
            let height = strips::height(room, pane.state.hands.count());
            bar_ui(ui, ("hands", height), frame, |ui| {
                let is_on = self.shows_all && self.view == View::Live;
                if strips::strips_ui(ui, pane, is_free, is_on) {
                    (self.shows_all, self.view) = (!is_on, View::Live);
                }
            });
        }
        let status = Frame::new().inner_margin(Margin {
            bottom: 0,
            ..MARGIN
        });
        let height = 40.0 + theme::GAP;
        bar_ui(ui, ("status", height), status, |ui| {
            if !is_free {
                ui.disable();
            }
            self.own.status.ui(ui, pane);
        });
        // What is below is covered by a card; what is above stays bright.
        let covered = ui.available_rect_before_wrap();
        if !is_free {
            self.key_list.hide();
            ui.disable();
        }
        let tabs = Frame::new().inner_margin(Margin::symmetric(8, 2));
        bar_ui(ui, ("tabs", 36.0), tabs, |ui| {
            header::tabs_ui(ui, pane, self.view);
        });
        let below = ui.available_rect_before_wrap();
        let body = Frame::new().inner_margin(Margin { top: 2, ..MARGIN });
        egui::CentralPanel::no_frame().frame(body).show(ui, |ui| {
            self.joints_ui(ui, pane);
            let rect = ui.available_rect_before_wrap();
            self.view_ui(ui, rect, pane);
        });
        self.key_list.ui(ui, below, pane.look);
        let card = guard::card_of(pane.state, pane.look);
        let card = card.or_else(|| device_card::card_of(pane.state, pane.look));
        let card = card.or_else(|| compare::card_of(pane.state, pane.look));
        let card = card.or_else(|| sessions::card_of(pane.state, pane.look));
        let card = leave_card(pane.state, pane.look).or(card);
        let asked = self.cards.ui(ui, covered, card);
        pane.actions.extend(asked);
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
            View::Compare => self.compare.ui(ui, pane),
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

    /// Draws the plots and nothing else, over all of `ui`, into a context of their own: for a picture.
    pub fn plots_alone_ui(&mut self, ui: &mut Ui, state: &State) {
        alone_ui(ui, state, |ui, rect, pane| {
            ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
                self.own.plots.ui(ui, pane)
            });
        });
    }

    /// Draws the hand and nothing else, over all of `ui`: for pictures and measurements.
    pub fn hand_alone_ui(&mut self, ui: &mut Ui, state: &State) {
        alone_ui(ui, state, |ui, _, pane| self.own.touch.hand_ui(ui, pane));
    }

    fn plots_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            self.own.plots.ui(ui, pane)
        });
    }
}

const MARGIN: Margin = Margin::same(8);
const STRIPS_MARGIN: Margin = Margin::symmetric(12, 4);

/// Height of the strip of poses in a view as high as this.
const fn strip_height(view: f32) -> f32 {
    if view < 640.0 { STRIP_LEAST } else { 212.0 }
}

/// A row of the window of this name and height, over its whole width.
fn bar_ui(
    ui: &mut Ui,
    (name, height): (&'static str, f32),
    frame: Frame,
    add: impl FnOnce(&mut Ui),
) {
    let bar = kit::bare(Panel::top(name), height, Margin::ZERO);
    bar.frame(frame).show(ui, add);
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
        opens: &mut None,
    };
    let whole = ui.max_rect();
    ui.painter()
        .rect_filled(whole, 0.0, pane.look.palette.window);
    part(ui, whole, &mut pane);
}

/// The question before the window closes and something is lost.
fn leave_card(state: &State, look: Look) -> Option<Card> {
    let question = state.leave?;
    let mut card = Card::new(look, window::LEAVE_TITLE);
    if question.series {
        card = card.warning(window::LEAVE_SERIES);
    }
    if question.edits > 0 {
        card = card.warning(look.fill(window::LEAVE_EDITS, &[&question.edits]));
    }
    let stay = Choice::new(window::STAY, Manner::Safe).does(Action::Stay);
    let leave = Choice::new(window::LEAVE, Manner::Danger).does(Action::Leave);
    Some(card.choice(stay).choice(leave))
}

/// What the keys of the zoom did in the last frame, to be kept.
fn zoomed(ui: &Ui, state: &State) -> Option<Action> {
    let zoom = Zoom::from(ui.ctx().zoom_factor());
    (zoom != state.settings.zoom).then_some(Action::Zoom(zoom))
}

/// True while a card covers the body of the window.
fn is_covered(state: &State) -> bool {
    state.hand().procedure.is_some()
        || state.hand().params.question.is_some()
        || state.trials.to_confirm.is_some()
        || state.sessions.to_delete.is_some()
        || state.leave.is_some()
}

/// What is done with the key that is held to run, if that is asked for.
fn held(ui: &Ui, state: &State, wishes: &[Wish]) -> Option<Action> {
    if !state.settings.hold_to_run || state.timeline.is_some() {
        return None;
    }
    let key = match is_covered(state) {
        true => HoldKey::LetGo,
        false => keys::hold_key(ui, wishes),
    };
    let is_held = key != HoldKey::LetGo;
    if is_held {
        ui.request_repaint();
    }
    (is_held || state.hands.iter().any(HandState::is_key_held)).then_some(Action::HoldKey(key))
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
                | Action::HoldKey(HoldKey::Pressed)
                | Action::Input(
                    InputAction::GrantStream
                        | InputAction::GrantDds
                        | InputAction::GrantPad
                        | InputAction::GrantClient(_)
                )
                | Action::Target(..)
                | Action::Preset(_)
                | Action::Gesture(_)
                | Action::Recall(_)
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
    use crate::hand::{Angle, Dof, Gesture};
    use crate::poses::library::{EntryId, PoseId, SequenceId};

    #[test]
    fn a_stop_goes_first_and_nothing_moves_in_the_same_frame() {
        let moves = || {
            vec![
                Action::Arm,
                Action::HoldKey(HoldKey::Pressed),
                Action::Input(InputAction::GrantStream),
                Action::Input(InputAction::GrantPad),
                Action::Input(InputAction::GrantDds),
                Action::Target(Dof::Index, Angle::MAX),
                Action::Preset(Preset::Open),
                Action::Gesture(Gesture::MIN),
                Action::Recall(PoseId(1)),
                Action::Procedure(ProcedureAction::Begin),
                Action::Trial(TrialAction::Start),
                Action::Play(Play::Start(EntryId::Sequence(SequenceId(1)))),
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
