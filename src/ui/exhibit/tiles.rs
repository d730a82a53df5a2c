//! Tiles that visitors press. A press counts when the finger comes down.

use crate::app::action::Action;
use crate::app::exhibit::ExhibitAction;
use crate::app::settings::Language;
use crate::exhibit::plan::{BothWords, ExhibitPiece};
use crate::exhibit::stage::{ExhibitWish, HOLD_DURATION};
use crate::hand::Angle;
use crate::ui::exhibit::large::{LargeText, Page};
use crate::ui::exhibit::places::NAME;
use crate::ui::exhibit::stage;
use crate::ui::hand::tile;
use crate::ui::kit::{self, Pane};
use egui::{Id, Rect, Role, Stroke, StrokeKind, Ui, WidgetInfo};

/// Opacity of the veil on a disabled tile.
const VEIL: f32 = 0.62;
/// Opacity of the fill that rises in a held tile.
const RISEN: f32 = 0.35;

/// Text in the language of the page.
pub(crate) fn words_of(words: &BothWords, language: Language) -> &str {
    match language {
        Language::En => &words.en,
        Language::Zh => &words.zh,
    }
}

/// A tile and its content.
struct PieceTile<'a> {
    index: usize,
    piece: &'a ExhibitPiece,
    rect: Rect,
    refusal: Option<&'a str>,
    /// Share of the required hold time, where holding has an effect.
    held: Option<f32>,
    plays: bool,
}

/// Draws all tiles. True if one was pressed.
pub(crate) fn tiles_ui(ui: &mut Ui, pane: &mut Pane<'_>, page: Page<'_>) -> bool {
    let exhibit = page.exhibit;
    let refusal = stage::tile_refusal(pane.look, pane.state, exhibit);
    let restarts = stage::restarts(pane.state, exhibit);
    let tiles = &exhibit.plan.tiles;
    let mut pressed = None;
    let rects = page.places.tile_rects(tiles.len());
    for ((index, piece), rect) in tiles.iter().enumerate().zip(rects) {
        let held = exhibit.view.held;
        let held = held.filter(|(held, _)| *held == index && restarts);
        let part = |since| pane.state.now.since(since).as_secs_f32() / HOLD_DURATION.as_secs_f32();
        let tile = PieceTile {
            index,
            piece,
            rect,
            refusal: refusal.as_deref(),
            held: held.map(|(_, since)| part(since).min(1.0)),
            plays: exhibit.view.tile == Some(index),
        };
        if tile.ui(ui, page) {
            pressed = Some(index);
        }
    }
    pane.actions.extend(pressed.map(press));
    pressed.is_some()
}

fn press(tile: usize) -> Action {
    Action::Exhibit(ExhibitAction::Wish(ExhibitWish::Press(tile)))
}

impl PieceTile<'_> {
    /// Draws it; true in the frame in which it is pressed.
    fn ui(&self, ui: &mut Ui, page: Page<'_>) -> bool {
        let Self { rect, .. } = *self;
        let (palette, unit) = (page.look.palette, page.places.unit);
        let name = words_of(&self.piece.name, page.look.language);
        let enabled = self.refusal.is_none() && ui.is_enabled();
        let id = Id::unique(("exhibit tile", self.index));
        let response = ui.interact(rect, id, kit::click_if(enabled));
        response.widget_info(|| WidgetInfo::selected(Role::Button, enabled, self.plays, name));
        if let Some(reason) = self.refusal {
            ui.ctx()
                .accesskit_node_builder(response.id, |node| node.set_description(reason));
        }
        let is_down = response.is_pointer_button_down_on();
        let (fill, edge, color) = match (self.refusal, self.plays) {
            (Some(_), _) => (palette.card, palette.edge, palette.faint),
            (None, true) => (palette.control, palette.accent, palette.text),
            (None, false) if is_down => (palette.control_hover, palette.faint, palette.text),
            (None, false) => (palette.control, palette.edge, palette.text),
        };
        let wide = if self.plays { 5.0 } else { 2.0 };
        let round = 16.0 * unit;
        let edge = Stroke::new((wide * unit).max(1.0), edge);
        ui.painter()
            .rect(rect, round, fill, edge, StrokeKind::Inside);
        if self.plays {
            let wash = palette.wash(palette.accent);
            ui.painter().rect_filled(rect, round, wash);
        }
        if let Some(part) = self.held {
            self.held_ui(ui, page, part);
        }
        let inner = rect.shrink(8.0 * unit);
        let (picture, words) = inner.split_top_bottom_at_y(rect.bottom() - NAME * unit);
        self.picture_ui(ui, page, picture);
        page.paint(ui, words, LargeText::new(name, 30.0, color));
        self.refusal.is_none() && kit::pressed(ui, &response)
    }

    fn picture_ui(&self, ui: &Ui, page: Page<'_>, place: Rect) {
        // Joints that the pose leaves unchanged are drawn open.
        let share = |to: Option<Angle>| f32::from(to.unwrap_or(Angle::MAX).get()) / 1000.0;
        let shares = self.piece.shown().map(|to| Some(share(to)));
        tile::sign_ui(ui, page.look, place, &shares);
        if self.refusal.is_some() {
            let veil = page.look.palette.card.gamma_multiply(VEIL);
            ui.painter().rect_filled(place, 0.0, veil);
        }
    }

    /// Draws the hold time so far: the tile fills from below.
    fn held_ui(&self, ui: &Ui, page: Page<'_>, part: f32) {
        let (accent, round) = (page.look.palette.accent, 16.0 * page.places.unit);
        let full = self.rect;
        let risen = full.with_min_y(full.bottom() - full.height() * part);
        let painter = ui.painter().with_clip_rect(risen);
        painter.rect_filled(full, round, accent.gamma_multiply(RISEN));
        let edge = Stroke::new((5.0 * page.places.unit).max(2.0), accent);
        ui.painter()
            .rect_stroke(full, round, edge, StrokeKind::Inside);
    }
}
