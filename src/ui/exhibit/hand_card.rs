//! The drawn hand, large, with the load on its five fingertips.

use crate::hand::{Finger, PerFinger};
use crate::ui::exhibit::large::Page;
use crate::ui::exhibit::places::above;
use crate::ui::hand::fingertip::{self, Tip};
use crate::ui::hand::panel::{StillHand, picture};
use crate::ui::kit::{self, Label, Pane};
use crate::ui::text::{Text, exhibit, main, words};
use crate::ui::touch::heat;
use egui::{Align2, Color32, Rect, Ui, vec2};

/// The last drawn hand.
#[derive(Debug, Default)]
pub(crate) struct HandCard(StillHand);

impl HandCard {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, page: Page<'_>) {
        let (unit, rect) = (page.places.unit, page.places.hand);
        let tips = heat::tips(pane);
        page.card(ui, rect);
        let inner = rect.shrink(20.0 * unit);
        let below = (inner.height() * 0.34).min(300.0 * unit);
        let (hand, feels) = above(inner, inner.height() - below, 14.0 * unit);
        // Slightly to the right: the badge would cover the little finger.
        let hand = hand.with_min_x(hand.left() + 64.0 * unit);
        let shown = picture(pane.hand(), &tips, pane.state.now);
        self.0.ui(ui, hand, page.look, &shown);
        feels_ui(ui, page, feels, &tips);
        let row = inner.with_max_y(inner.top() + 48.0 * unit);
        let palette = page.look.palette;
        if pane.hand().connection.is_simulated() {
            let simulated = Badge {
                text: main::SIMULATED,
                fill: palette.simulated,
                side: Align2::LEFT_CENTER,
            };
            simulated.ui(ui, page, row);
        }
        if page.exhibit.view.is_slow {
            let slow = Badge {
                text: exhibit::SLOW,
                fill: palette.warn,
                side: Align2::RIGHT_CENTER,
            };
            slow.ui(ui, page, row);
        }
    }
}

/// A short text about the hand on a coloured background.
struct Badge {
    text: Text,
    fill: Color32,
    /// Alignment within its row.
    side: Align2,
}

impl Badge {
    /// Draws it as high as a row and at most as wide.
    fn ui(&self, ui: &mut Ui, page: Page<'_>, row: Rect) {
        let (text, palette) = (page.look.tr(self.text), page.look.palette);
        let font = page.font(28.0);
        let wide = kit::text_width(ui, text, font.clone()) + 36.0 * page.places.unit;
        let size = vec2(wide.min(row.width()), row.height());
        let place = self.side.align_size_within_rect(size, row);
        ui.painter()
            .rect_filled(place, place.height() / 2.0, self.fill);
        let label = Label::new(text, palette.on_accent).font(font);
        label.center().put(ui, place);
    }
}

/// Draws the five fingertips side by side, below a caption.
fn feels_ui(ui: &mut Ui, page: Page<'_>, rect: Rect, tips: &PerFinger<Option<Tip>>) {
    let (look, unit) = (page.look, page.places.unit);
    let (caption, row) = rect.split_top_bottom_at_y(rect.top() + 40.0 * unit);
    let text = look.tr(exhibit::FEELS);
    let label = Label::new(text, look.palette.muted).font(page.font(28.0));
    label.center().put(ui, caption);
    let step = vec2(row.width() / 5.0, 0.0);
    let first = row.with_max_x(row.left() + step.x);
    let places = (0_u8..).map(|at| first.translate(step * f32::from(at)));
    for (finger, place) in Finger::ALL.into_iter().zip(places) {
        let (picture, name) = place.split_top_bottom_at_y(place.bottom() - 40.0 * unit);
        let tip = tips[finger].unwrap_or_default();
        fingertip::paint(ui.painter(), look, picture.shrink(6.0 * unit), &tip);
        let color = look.palette.dof[finger.bend()];
        let label = Label::new(look.tr(words::finger(finger)), color).font(page.font(28.0));
        label.center().put(ui, name);
    }
}
