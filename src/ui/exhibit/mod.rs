//! The page that visitors see in place of the window: hand, tiles, fingertips, STOP. Only the PIN of staff leads from it to
//! anything else.

mod hand_card;
mod keypad;
mod large;
mod places;
mod staff;
mod stage;
mod tiles;

use crate::app::action::Action;
use crate::app::exhibit::{ExhibitAction, ExhibitState, Logo, StaffPanel};
use crate::app::settings::{Language, Zoom};
use crate::app::state::State;
use crate::exhibit::stage::{ExhibitStage, ExhibitWish};
use crate::ui::exhibit::hand_card::HandCard;
use crate::ui::exhibit::large::{LargeButton, LargeText, Page};
use crate::ui::exhibit::places::PagePlaces;
use crate::ui::exhibit::staff::StaffView;
use crate::ui::kit::{Look, Pane, Typing, Weight};
use crate::ui::text::{exhibit, main};
use crate::ui::theme;
use egui::{
    ColorImage, Context, CursorIcon, Event, Key, PointerButton, TextureHandle, TextureOptions,
    TouchPhase, Ui, vec2,
};
use std::time::Duration;

/// Repaint interval of running bars and countdowns.
const FRAME: Duration = Duration::from_millis(50);

/// View state of the page.
#[derive(Default)]
pub(crate) struct ExhibitPage {
    begun: bool,
    logo: Option<TextureHandle>,
    hand: HandCard,
    staff: StaffView,
    /// A tile is pressed and not yet released.
    is_held: bool,
}

impl std::fmt::Debug for ExhibitPage {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_struct("ExhibitPage").finish_non_exhaustive()
    }
}

/// Touches and pointer presses of this frame.
#[derive(Default)]
struct Touches {
    went_down: bool,
    /// Nothing touches the screen at the end of the frame.
    ends_up: bool,
}

impl ExhibitPage {
    /// Draws the page over all of `ui`. Returns the requested actions, stop first.
    pub(crate) fn ui(&mut self, ui: &mut Ui, state: &State, exhibit: &ExhibitState) -> Vec<Action> {
        let keys = consume_keys(ui);
        self.begin(ui.ctx(), exhibit);
        let touches = Touches::of(ui);
        let (mut actions, mut typing) = (Vec::new(), Typing::default());
        let mut pane = Pane {
            state,
            look: Look::of(state),
            actions: &mut actions,
            typing: &mut typing,
            opens: &mut None,
        };
        let places = PagePlaces::of(ui.max_rect());
        let page = Page {
            look: pane.look,
            places,
            exhibit,
        };
        ui.painter()
            .rect_filled(places.whole, 0.0, pane.look.palette.window);
        let is_free = exhibit.staff == StaffPanel::Closed;
        let taken = ui.scope(|ui| {
            if !is_free {
                // The staff panel has a veil of its own.
                ui.visuals_mut().disabled_alpha = 1.0;
                ui.disable();
            }
            self.page_ui(ui, &mut pane, page)
        });
        self.staff.ui(ui, &mut pane, page, &keys);
        language_ui(ui, &mut pane, page);
        stop_ui(ui, &mut pane, page);
        let is_pressed = std::mem::replace(&mut self.is_held, false);
        self.is_held = (is_pressed || taken.inner) && !touches.ends_up;
        if touches.went_down && is_free && !taken.inner {
            actions.push(wish(ExhibitWish::Touch));
        }
        if (is_pressed || taken.inner) && !self.is_held {
            actions.push(wish(ExhibitWish::Release));
        }
        repaint(ui, exhibit);
        ui.ctx().set_cursor_icon(CursorIcon::None);
        stop_first(actions, &keys)
    }

    /// Draws the visitors' part. True if a tile or the lock was pressed.
    fn page_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, page: Page<'_>) -> bool {
        self.title_ui(ui, page);
        let lock = LargeButton {
            icon: Some(theme::LOCKED),
            size: 34.0,
            weight: Weight::Quiet,
            ..LargeButton::new(page.look.tr(exhibit::STAFF_BUTTON))
        };
        let asks = lock.ui(ui, page, page.places.lock);
        if asks {
            pane.actions.push(Action::Exhibit(ExhibitAction::AskPin));
        }
        self.hand.ui(ui, pane, page);
        stage::words_ui(ui, pane, page);
        tiles::tiles_ui(ui, pane, page) || asks
    }

    fn title_ui(&self, ui: &mut Ui, page: Page<'_>) {
        let place = page.places.title;
        let mut rest = place;
        if let Some(logo) = &self.logo {
            let size = logo.size_vec2();
            let part = place.size() * vec2(0.3, 1.0) / size;
            let size = size * part.min_elem();
            let (left, right) = place.split_left_right_at_x(place.left() + size.x);
            let picture = egui::Align2::LEFT_CENTER.align_size_within_rect(size, left);
            egui::Image::new(logo).paint_at(ui, picture);
            rest = right.with_min_x(right.left() + 24.0 * page.places.unit);
        }
        let own = tiles::words_of(&page.exhibit.plan.title, page.look.language);
        let title = match own {
            "" => page.look.tr(exhibit::TITLE),
            own => own,
        };
        let title = LargeText::new(title, 46.0, page.look.palette.text);
        page.line(ui, rest, title);
    }

    /// Drops the focus; on the first frame also resets zoom and popups, and loads the logo.
    fn begin(&mut self, ctx: &Context, exhibit: &ExhibitState) {
        if let Some(focused) = ctx.memory(egui::Memory::focused) {
            ctx.memory_mut(|memory| memory.surrender_focus(focused));
        }
        if std::mem::replace(&mut self.begun, true) {
            return;
        }
        ctx.options_mut(|options| options.zoom_with_keyboard = false);
        ctx.set_zoom_factor(1.0);
        egui::Popup::close_all(ctx);
        self.logo = exhibit.logo.as_ref().and_then(|logo| load(ctx, logo));
    }
}

/// Restores the window's zoom settings after the page.
pub(crate) fn leave(ctx: &Context, zoom: Zoom) {
    ctx.options_mut(|options| options.zoom_with_keyboard = true);
    ctx.set_zoom_factor(zoom.into());
}

fn load(ctx: &Context, logo: &Logo) -> Option<TextureHandle> {
    let [width, height] = logo.size;
    let most = ctx.input(|input| input.max_texture_side);
    let is_whole = width.checked_mul(height)?.checked_mul(4)? == logo.rgba.len();
    if !is_whole || width.min(height) == 0 || width.max(height) > most {
        return None;
    }
    let image = ColorImage::from_rgba_unmultiplied(logo.size, &logo.rgba);
    Some(ctx.load_texture("exhibit logo", image, TextureOptions::LINEAR))
}

const fn wish(wish: ExhibitWish) -> Action {
    Action::Exhibit(ExhibitAction::Wish(wish))
}

/// Draws STOP, above everything else.
fn stop_ui(ui: &Ui, pane: &mut Pane<'_>, page: Page<'_>) {
    let stop = LargeButton {
        note: page.look.tr(exhibit::STOP_NOTE),
        size: 60.0,
        weight: Weight::Stop,
        ..LargeButton::new(page.look.tr(main::STOP))
    };
    if stop.ui(ui, page, page.places.stop) {
        pane.actions.push(Action::Stop);
    }
}

/// Draws the button for the other language, labelled in that language.
fn language_ui(ui: &Ui, pane: &mut Pane<'_>, page: Page<'_>) {
    let words = match page.look.language {
        Language::En => "中文",
        Language::Zh => "English",
    };
    if LargeButton::new(words).ui(ui, page, page.places.language) {
        let other = page.look.language.other();
        pane.actions.push(Action::Language(other));
    }
}

impl Touches {
    fn of(ui: &Ui) -> Self {
        let mut all = Self::default();
        ui.input(|input| {
            for event in &input.events {
                match event {
                    Event::PointerButton {
                        button: PointerButton::Primary,
                        pressed: true,
                        ..
                    }
                    | Event::Touch {
                        phase: TouchPhase::Start,
                        ..
                    } => (all.went_down, all.ends_up) = (true, false),
                    Event::PointerButton {
                        button: PointerButton::Primary,
                        pressed: false,
                        ..
                    }
                    | Event::PointerGone
                    | Event::WindowFocused(false) => all.ends_up = true,
                    Event::Touch { phase, .. } if *phase != TouchPhase::Move => all.ends_up = true,
                    _ => {}
                }
            }
        });
        all
    }
}

/// Removes all keyboard events from the input before any widget sees them. Returns the keys that went down.
fn consume_keys(ui: &Ui) -> Vec<Key> {
    let mut keys = Vec::new();
    ui.input_mut(|input| {
        input.events.retain(|event| match event {
            Event::Key {
                key,
                pressed,
                repeat,
                ..
            } => {
                if *pressed && !repeat {
                    keys.push(*key);
                }
                false
            }
            Event::Text(_) | Event::Ime(_) | Event::Paste(_) | Event::Cut | Event::Copy => false,
            _ => true,
        });
    });
    keys
}

/// Repaints while bars and countdowns run.
fn repaint(ui: &Ui, exhibit: &ExhibitState) {
    let goes_on = exhibit.view.held.is_some()
        || exhibit.staff != StaffPanel::Closed
        || matches!(
            exhibit.view.stage,
            ExhibitStage::Visit { .. } | ExhibitStage::Cooling { .. }
        );
    if goes_on {
        ui.ctx().request_repaint_after(FRAME);
    }
}

/// Puts a stop before everything else; only the release of a tile passes with it.
fn stop_first(mut actions: Vec<Action>, keys: &[Key]) -> Vec<Action> {
    let is_stop = |key: &Key| matches!(key, Key::Space | Key::Escape);
    if keys.iter().any(is_stop) || actions.contains(&Action::Stop) {
        actions.retain(|action| *action == wish(ExhibitWish::Release));
        actions.insert(0, Action::Stop);
    }
    actions
}
