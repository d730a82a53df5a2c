//! The drawn hand, large, and what its five fingertips feel.

use crate::app::exhibit::ExhibitState;
use crate::hand::{Finger, PerFinger};
use crate::ui::exhibit::large::PageLook;
use crate::ui::exhibit::places::{PagePlaces, above};
use crate::ui::hand::fingertip::{self, Tip};
use crate::ui::hand::panel::{StillHand, picture};
use crate::ui::kit::{Label, Pane};
use crate::ui::text::{exhibit, main, words};
use crate::ui::touch::heat;
use egui::{Align2, Rect, Ui, vec2};

/// The hand as it was drawn last.
#[derive(Debug, Default)]
pub(crate) struct HandCard(StillHand);

impl HandCard {
    /// Draws the card.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        exhibit: &ExhibitState,
        places: &PagePlaces,
    ) {
        let (unit, rect) = (places.unit, places.hand);
        let page = PageLook::of(pane, places);
        let tips = heat::tips(pane);
        page.card(ui, rect);
        let inner = rect.shrink(20.0 * unit);
        let below = (inner.height() * 0.34).min(300.0 * unit);
        let (hand, feels) = above(inner, inner.height() - below, 14.0 * unit);
        // A little to the right: the badge stands before the little finger.
        let hand = hand.with_min_x(hand.left() + 64.0 * unit);
        let shown = picture(pane.state.hand(), &tips, pane.state.now);
        self.0.ui(ui, hand, page.look, &shown);
        feels_ui(ui, page, feels, &tips);
        badges_ui(
            ui,
            page,
            inner.with_max_y(inner.top() + 48.0 * unit),
            (
                pane.state.hand().connection.is_simulated(),
                exhibit.view.is_slow,
            ),
        );
    }
}

/// What is to be known of this hand: that it is none of metal, that it goes slowly.
fn badges_ui(ui: &mut Ui, page: PageLook, row: Rect, (is_simulated, is_slow): (bool, bool)) {
    let palette = page.look.palette;
    if is_simulated {
        let colors = (palette.simulated, palette.on_accent);
        let said = page.look.say(main::SIMULATED);
        page.badge(ui, (row, Align2::LEFT_CENTER), said, colors);
    }
    if is_slow {
        let colors = (palette.warn, palette.on_accent);
        let said = page.look.say(exhibit::SLOW);
        page.badge(ui, (row, Align2::RIGHT_CENTER), said, colors);
    }
}

/// The five fingertips beside each other, under what they are.
fn feels_ui(ui: &mut Ui, page: PageLook, rect: Rect, tips: &PerFinger<Option<Tip>>) {
    let (look, unit) = (page.look, page.unit);
    let (caption, row) = rect.split_top_bottom_at_y(rect.top() + 40.0 * unit);
    let said = look.say(exhibit::FEELS);
    let label = Label::new(said, look.palette.muted).font(page.font(28.0));
    label.center().put(ui, caption);
    let step = vec2(row.width() / 5.0, 0.0);
    let first = row.with_max_x(row.left() + step.x);
    for (finger, place) in Finger::ALL
        .into_iter()
        .zip((0_u8..).map(|at| first.translate(step * f32::from(at))))
    {
        let (picture, name) = place.split_top_bottom_at_y(place.bottom() - 40.0 * unit);
        let tip = tips[finger].unwrap_or_default();
        fingertip::paint(ui.painter(), look, picture.shrink(6.0 * unit), &tip);
        let color = look.palette.dof[finger.bend()];
        let label = Label::new(look.say(words::finger(finger)), color).font(page.font(28.0));
        label.center().put(ui, name);
    }
}
