//! The whole window: layout of its parts, and the keys that work everywhere. Holds view state only, no hand.
//!
//! ```text
//! +----------------------------------------------------------+
//! | Live Tune Recordings Hand Share   hand, link    arm, STOP |
//! | status: warning, what moves the hand, message, note      |
//! | several hands: a strip for each, with its STOP            |
//! +----------+----------------+------------------------------+
//! | joints   | drawn hand     | plots, or in their place a   |
//! |          | fingertips     | fingertip, poses, faults     |
//! |          +----------------+----------------------------- |
//! |          | poses and demos                               |
//! +----------+-----------------------------------------------+
//! | timeline of a replay                                     |
//! +----------------------------------------------------------+
//! ```
mod body;
mod cards;
pub(crate) mod header;
mod key_actions;
pub(crate) mod key_list;
pub(crate) mod keys;
mod palette;
pub(crate) mod rooms;
pub(crate) mod status;
mod stop_first;
pub(crate) mod timeline;

use crate::app::action::Action;
use crate::app::hand::Hand;
use crate::app::hand::mover::rests;
use crate::app::recordings::RecordingAction;
use crate::app::settings::{Language, Theme};
use crate::app::state::State;
use crate::hand::Moment;
use crate::ui::exhibit::{self, ExhibitPage};
use crate::ui::hands::strips;
use crate::ui::kit::{self, CardView, Look, Pane, Typing, ViewRequest};
use crate::ui::poses::tiles::press;
use crate::ui::theme;
use crate::ui::view::View;
use crate::ui::window::body::WindowViews;
use crate::ui::window::cards::{card_of, is_covered};
use crate::ui::window::key_actions::{held_key_action, key_action, zoom_action};
use crate::ui::window::key_list::KeyList;
use crate::ui::window::keys::{Escape, Wish};
use crate::ui::window::palette::{CommandPalette, PaletteCommand};
use crate::ui::window::stop_first::stop_first;
use egui::{Frame, Key, Margin, Panel, Rect, Stroke, Ui, UiBuilder, vec2};
use std::time::Duration;

/// Time after a field lost the focus in which a key may still be meant for it.
const ASTRAY: Duration = Duration::from_secs(1);

/// View state of the window between frames: the open tab, text in progress, hidden parts.
#[derive(Debug, Default)]
pub struct Window {
    body: WindowViews,
    installed: Option<(Theme, Language)>,
    /// Last time at which a field had the focus, in seconds of the window's time.
    typed_at: Option<f64>,
    typing: Typing,
    /// A field had the focus in the last frame: Esc removes it before the window can check.
    typed: bool,
    key_list: KeyList,
    palette: CommandPalette,
    cards: CardView,
    /// Exhibit page, shown in place of everything else.
    exhibit: Option<ExhibitPage>,
}

/// Installs fonts and style into a context. The window does this itself when the settings change.
pub fn install(ctx: &egui::Context, theme: Theme, _language: Language) {
    ctx.set_fonts(theme::fonts());
    restyle(ctx, theme);
}

fn restyle(ctx: &egui::Context, theme: Theme) {
    ctx.all_styles_mut(|style| *style = theme::style(theme, style));
}

impl Window {
    /// A window on its first view.
    pub fn new() -> Self {
        Self::default()
    }

    /// Opens a view.
    pub fn set_view(&mut self, view: View) {
        self.body.show(view);
    }

    /// Shows all hands side by side.
    pub fn show_all_hands(&mut self) {
        self.body.show_all(true);
    }

    /// Limits the plots to this time range, in seconds.
    pub const fn show_stretch(&mut self, stretch: (f64, f64)) {
        self.body.own.plots.pin(stretch);
    }

    /// The open view.
    pub const fn view(&self) -> View {
        self.body.view
    }

    /// Draws the window over all of `ui` and returns the requested actions, stop first.
    pub fn ui(&mut self, ui: &mut Ui, state: &State) -> Vec<Action> {
        if let Some(exhibit) = &state.exhibit {
            self.install_if_changed(ui, state);
            let page = self.exhibit.get_or_insert_default();
            return page.ui(ui, state, exhibit);
        }
        // The stored zoom applies from the second frame on.
        let zoomed = match self.exhibit.take() {
            Some(_) => {
                exhibit::leave(ui.ctx(), state.settings.zoom);
                None
            }
            None => self.installed.and_then(|_| zoom_action(ui, state)),
        };
        self.install_if_changed(ui, state);
        if ui.ctx().text_edit_focused() {
            self.typed_at = Some(ui.input(|input| input.time));
        }
        if self.body.follow_shown(state) {
            self.typing = Typing::default();
            cancel_interactions(ui);
        }
        let mut actions = Vec::from_iter(zoomed);
        let escape = self.escape(ui, state);
        let mut wishes = if state.hands.iter().any(Hand::runs_series) {
            keys::consume_any(ui)
        } else {
            keys::consume(ui, escape)
        };
        if self.may_be_typed(ui) {
            wishes.retain(|wish| !wish.moves());
        }
        if is_covered(state) {
            wishes.retain(|wish| *wish == Wish::Stop);
        }
        actions.extend(dropped_recording(ui));
        let mut stopped = wishes.contains(&Wish::Stop);
        actions.extend(held_key_action(ui, state, &wishes));
        let mut typing = std::mem::take(&mut self.typing);
        let mut opens = None;
        let mut pane = Pane {
            state,
            look: Look::of(state),
            actions: &mut actions,
            typing: &mut typing,
            opens: &mut opens,
        };
        let view = self.body.view;
        for wish in wishes {
            self.execute(ui, &mut pane, wish);
        }
        match self.parts_ui(ui, &mut pane) {
            Some(PaletteCommand::Wish(wish)) => {
                stopped |= wish == Wish::Stop;
                self.execute(ui, &mut pane, wish);
            }
            Some(PaletteCommand::Entry(entry)) if pane.unready().is_none() => {
                pane.actions.push(press(state, entry));
            }
            Some(PaletteCommand::Act(action)) => pane.actions.push(action),
            Some(PaletteCommand::Entry(_)) | None => {}
        }
        if let Some(opens) = opens {
            self.open(opens, state.now);
            ui.request_repaint();
        }
        let actions = stop_first(actions, stopped);
        typing.after(&actions);
        if view != self.body.view && typing.refused.is_some() {
            typing = Typing::default();
        }
        self.typing = typing;
        self.typed = ui.ctx().text_edit_focused();
        actions
    }

    /// True if a key may be meant for a field that had the focus a moment ago.
    fn may_be_typed(&self, ui: &Ui) -> bool {
        let now = ui.input(|input| input.time);
        self.typed_at
            .is_some_and(|at| now - at < ASTRAY.as_secs_f64())
    }

    /// Effect of Esc now: it closes what is open, and stops unless every hand is known to be at rest.
    fn escape(&mut self, ui: &Ui, state: &State) -> Escape {
        let is_open = self.key_list.is_open()
            || self.palette.is_open()
            || self.body.own.status.writes_note()
            || self.cards.informs()
            || self.typed
            || egui::Popup::is_any_open(ui.ctx());
        let closes = is_open && state.hands.iter().all(|hand| rests(hand, state.now));
        // Popups, fields and cards close themselves. A note being written survives a stop.
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.key_list.hide();
            self.palette.hide();
            if closes {
                self.body.own.status.drop_note();
            }
        }
        if closes {
            Escape::Closes
        } else {
            Escape::Stops
        }
    }

    /// Executes the effect of a key or command.
    fn execute(&mut self, ui: &Ui, pane: &mut Pane<'_>, wish: Wish) {
        if let Wish::Opens(opens) = wish {
            self.open(opens, pane.state.now);
        }
        let action = key_action(ui, pane, &mut self.body.own, wish);
        pane.actions.extend(action);
    }

    fn open(&mut self, opens: ViewRequest, now: Moment) {
        match opens {
            ViewRequest::Faults => self.body.toggle_faults(),
            ViewRequest::View(view) => self.body.show(view),
            ViewRequest::Tab(tab) => self.body.show_tab(tab),
            ViewRequest::Drive(dof) => {
                self.body.own.faults.choose(Some(dof));
                self.body.show(View::Faults);
            }
            ViewRequest::Note => self.body.own.status.open_note(now),
            ViewRequest::Keys => self.key_list.toggle(),
            ViewRequest::Palette => self.palette.toggle(),
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

    /// Draws all parts; returns the command chosen in the palette.
    fn parts_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) -> Option<PaletteCommand> {
        let palette = pane.look.palette;
        ui.painter().rect_filled(ui.max_rect(), 0.0, palette.window);
        let is_free = !is_covered(pane.state);
        if !is_free {
            // The card's own veil dims the part below it; the bars above stay bright.
            ui.visuals_mut().disabled_alpha = 1.0;
        }
        self.bars_ui(ui, pane, is_free);
        // Area that a card covers, below the bars.
        let covered = ui.available_rect_before_wrap();
        if !is_free {
            self.key_list.hide();
            self.palette.hide();
            ui.disable();
        }
        if let Some(line) = &pane.state.timeline {
            let frame = Frame::new().fill(palette.card).inner_margin(MARGIN);
            let bar = kit::bare(Panel::bottom("timeline"), timeline::HEIGHT, Margin::ZERO);
            bar.frame(frame)
                .show(ui, |ui| timeline::timeline_ui(ui, pane, line));
        }
        let below = ui.available_rect_before_wrap();
        let body = Frame::new().inner_margin(Margin { top: 4, ..MARGIN });
        egui::CentralPanel::no_frame()
            .frame(body)
            .show(ui, |ui| self.body.ui(ui, pane));
        self.key_list.ui(ui, below, pane.look);
        let asked = self.cards.ui(ui, covered, card_of(pane.state, pane.look));
        pane.actions.extend(asked);
        self.palette.ui(ui, below, pane)
    }

    /// Draws the bars at the top. STOP is enabled whatever card is open, the rest only if `is_free`.
    fn bars_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, is_free: bool) {
        let palette = pane.look.palette;
        let header = Frame::new()
            .fill(palette.card)
            .stroke(Stroke::new(1.0, palette.edge))
            .inner_margin(Margin::symmetric(12, 4));
        top_bar("header", theme::TOP_BAR, header).show(ui, |ui| {
            header::header_ui(ui, pane, self.body.view, is_free);
        });
        let hands = &pane.state.hands;
        let room = ui.available_width() - STRIPS_MARGIN.sum().x;
        let height = strips::height(room, hands.count());
        let wanted = strips::width(hands.count());
        // Few hands and the status share a row where both fit. The strips stay where they are either way.
        let is_one_row = hands.is_several() && room - wanted >= STATUS_LEAST;
        if hands.is_several() {
            let frame = Frame::new().fill(palette.card).inner_margin(STRIPS_MARGIN);
            top_bar("hands", height, frame).show(ui, |ui| {
                let place = ui.available_rect_before_wrap();
                let width = if is_one_row { wanted } else { place.width() };
                let (strips, status) = place.split_left_right_at_x(place.left() + width);
                ui.scope_builder(UiBuilder::new().max_rect(strips), |ui| {
                    let is_on = self.body.shows_all();
                    if strips::strips_ui(ui, pane, is_free, is_on) {
                        self.body.show_all(!is_on);
                    }
                });
                if is_one_row {
                    let size = vec2(status.width(), status::HEIGHT);
                    let status = Rect::from_center_size(status.center(), size);
                    let builder = UiBuilder::new().max_rect(status);
                    ui.scope_builder(builder, |ui| self.status_ui(ui, pane, is_free));
                }
            });
        }
        if !is_one_row {
            let status = Frame::new().fill(palette.card);
            let bar = top_bar("status", status::HEIGHT, status);
            bar.show(ui, |ui| self.status_ui(ui, pane, is_free));
        }
    }

    fn status_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, is_free: bool) {
        if !is_free {
            ui.disable();
        }
        self.body.own.status.ui(ui, pane);
    }

    /// Draws the plots alone over all of `ui`, into a context of their own: for pictures.
    pub fn plots_alone_ui(&mut self, ui: &mut Ui, state: &State) {
        alone_ui(ui, state, |ui, pane| self.body.own.plots.ui(ui, pane));
    }

    /// Draws the hand alone over all of `ui`: for pictures and measurements.
    pub fn hand_alone_ui(&mut self, ui: &mut Ui, state: &State) {
        alone_ui(ui, state, |ui, pane| {
            self.body.own.touch.hand_ui(ui, pane, false)
        });
    }
}

/// Minimum width of the status beside the strips of the hands.
const STATUS_LEAST: f32 = 440.0;
const MARGIN: Margin = Margin::same(8);
const STRIPS_MARGIN: Margin = Margin::symmetric(12, 4);

/// A row of the window with this name and height, over its whole width.
fn top_bar(name: &'static str, height: f32, frame: Frame) -> Panel {
    kit::bare(Panel::top(name), height, Margin::ZERO).frame(frame)
}

/// Action that opens a recording dropped onto the window, if there is one.
fn dropped_recording(ui: &Ui) -> Option<Action> {
    ui.input(|input| {
        let files = input.raw.dropped_files.iter();
        let mut paths = files.map(|file| file.path().to_owned());
        let path = paths.find(|path| path.extension().is_some_and(|ending| ending == "mcap"));
        path.map(|path| Action::Recording(RecordingAction::Open(path)))
    })
}

/// Cancels drags, focus and popups, so that nothing begun on one hand continues on another.
fn cancel_interactions(ui: &Ui) {
    ui.ctx().stop_dragging();
    ui.memory_mut(|memory| {
        if let Some(focused) = memory.focused() {
            memory.surrender_focus(focused);
        }
    });
    egui::Popup::close_all(ui.ctx());
}

/// Draws one part of the window over the whole area. Its actions are discarded.
fn alone_ui(ui: &mut Ui, state: &State, part: impl FnOnce(&mut Ui, &mut Pane<'_>)) {
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
    part(ui, &mut pane);
}
