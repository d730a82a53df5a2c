//! All hands side by side, each on a card with its drawn hand, state, and current measurements.

use crate::app::hand::Hand;
use crate::app::settings::PlotKind;
use crate::app::slot::SlotId;
use crate::hand::quantity::Quantity;
use crate::hand::{PerDof, PerFinger};
use crate::ui::hand::panel::{StillHand, picture};
use crate::ui::hands::strips::HandWords;
use crate::ui::kit::{self, Label, Pane, format};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartView, height_over_axis};
use crate::ui::plots::panels::PANELS;
use crate::ui::text::window;
use crate::ui::theme;
use egui::{Align, Layout, ScrollArea, StrokeKind, Ui, UiBuilder, Vec2, vec2};
use std::collections::BTreeMap;

/// Minimum size of a hand's card: the plots need space beside their numbers.
const CARD_LEAST: Vec2 = vec2(272.0, 280.0);
/// Minimum height of a card with both plots.
const BOTH_LEAST: f32 = 440.0;
/// Height of a plot, as a share of its card, and its minimum.
const PLOT_PART: f32 = 0.24;
const PLOT_LEAST: f32 = 96.0;
/// Plots of each hand, from top to bottom; a low card has the last one only.
const PLOTS: [PlotKind; 2] = [PlotKind::Angle, PlotKind::Force];

/// View state of one card.
#[derive(Debug, Default)]
struct BesideCard {
    picture: StillHand,
    charts: ChartView,
}

/// View state of the cards, by hand.
#[derive(Debug, Default)]
pub(crate) struct BesideView(BTreeMap<SlotId, BesideCard>);

impl BesideView {
    /// Draws a card for each hand, side by side; in several rows if they are too many, with a scroll bar if those are too high.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let hands = &pane.state.hands;
        self.0
            .retain(|slot, _| hands.iter().any(|hand| hand.label.slot == *slot));
        let (size, columns) = cards(ui.available_size(), hands.count());
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing = Vec2::splat(theme::GAP);
            let all: Vec<_> = hands.iter().enumerate().collect();
            for row in all.chunks(columns) {
                ui.horizontal_top(|ui| {
                    for (at, hand) in row {
                        let (_, rect) = ui.allocate_space(size);
                        // Cards scrolled out of view are not computed.
                        if !ui.is_rect_visible(rect) {
                            continue;
                        }
                        let slot = hand.label.slot;
                        let down = Layout::top_down(Align::Min);
                        let place = UiBuilder::new().max_rect(rect).id_salt(slot).layout(down);
                        let card = self.0.entry(slot).or_default();
                        ui.scope_builder(place, |ui| card.ui(ui, pane, *at, hand));
                        if slot == hands.shown().label.slot {
                            let line = (1.0, pane.look.palette.accent);
                            let inside = StrokeKind::Inside;
                            ui.painter().rect_stroke(rect, theme::ROUND, line, inside);
                        }
                    }
                });
            }
        });
    }
}

/// Size of the cards of so many hands, and their number in a row: as few rows as fit, of equal length.
fn cards(room: Vec2, hands: usize) -> (Vec2, usize) {
    let fitting = |columns: &usize| {
        let count = number(*columns);
        (room.x - theme::GAP * (count - 1.0)) / count >= CARD_LEAST.x
    };
    let most = (1..=hands).rev().find(fitting).unwrap_or(1);
    let rows = hands.div_ceil(most).max(1);
    let columns = hands.div_ceil(rows).max(1);
    let share = |room: f32, of: usize| {
        let of = number(of);
        ((room - theme::GAP * (of - 1.0)) / of).floor()
    };
    let size = vec2(share(room.x, columns), share(room.y, rows));
    (size.max(CARD_LEAST), columns)
}

fn number(count: usize) -> f32 {
    f32::from(u8::try_from(count).unwrap_or(u8::MAX))
}

impl BesideCard {
    fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, at: usize, hand: &Hand) {
        let look = pane.look;
        let words = HandWords::of(look, at, hand, pane.state.now);
        kit::full_card_ui(ui, look, |ui| {
            let title = format!("{}  {}", words.number, words.name);
            let [_, side] = words.side;
            kit::head_ui(ui, look, &title, |ui| Label::note(look, side).ui(ui));
            ui.horizontal(|ui| {
                kit::lamp_ui(ui, Some(words.color));
                Label::new(&words.state, look.palette.text).ui(ui);
                kit::right_ui(ui, |ui| highest_ui(ui, pane, hand));
            });
            let whole = ui.available_height();
            let plot = (whole * PLOT_PART).max(PLOT_LEAST).floor();
            let kinds = if whole < BOTH_LEAST {
                &PLOTS[1..]
            } else {
                &PLOTS
            };
            let plots = number(kinds.len()) * plot + theme::PLOT_TIME_AXIS + theme::GAP;
            let room = vec2(ui.available_width(), (whole - plots).max(1.0));
            let (_, place) = ui.allocate_space(room);
            let shown = picture(hand, &PerFinger::default(), pane.state.now);
            self.picture.ui(ui, place, look, &shown);
            self.plots_ui(ui, pane, hand, (kinds, plot));
        });
    }

    fn plots_ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        hand: &Hand,
        (kinds, height): (&[PlotKind], f32),
    ) {
        let look = pane.look;
        let (now_s, history) = (pane.state.now.secs(), &hand.measured.history);
        let window = pane.state.settings.plot_window.seconds();
        self.charts.advance(history, now_s, window);
        ui.spacing_mut().item_spacing.y = 0.0;
        let panel = |kind: &PlotKind| PANELS.iter().find(|panel| panel.kind == *kind);
        for panel in kinds.iter().filter_map(panel) {
            let is_lowest = Some(&panel.kind) == kinds.last();
            let lines = panel.measured(&PerDof::default());
            let curves = lines.iter().map(|line| ChartCurve {
                decimals: Some(panel.row.decimals),
                ..ChartCurve::measured(history, line.series, look.palette.dof[line.dof])
            });
            let chart = Chart {
                curves: curves.collect(),
                least: panel.row.least_scale,
                times: self.charts.times(look),
                is_lowest,
                ..Chart::new(look, panel.title, height_over_axis(height, is_lowest))
            };
            chart.ui(ui, &mut self.charts);
        }
    }
}

/// Draws the highest temperature, current and force of the six drives, from right to left; "-" for what is not known.
fn highest_ui(ui: &mut Ui, pane: &Pane<'_>, hand: &Hand) {
    let look = pane.look;
    let is_live = hand.connection.is_live();
    for (quantity, unit, name) in [
        (Quantity::Temperature, "°C", window::HIGHEST_TEMPERATURE),
        (Quantity::Current, "mA", window::HIGHEST_CURRENT),
        (Quantity::Force, "g", window::HIGHEST_FORCE),
    ] {
        let known = quantity.documented(&hand.readings.sample);
        let asked = known.map(|group| group.asked);
        let value = known.and_then(|group| group.value.iter().filter_map(|(_, one)| *one).max());
        let text = value.map_or_else(|| format::UNKNOWN.to_owned(), |value| value.to_string());
        let freshness = hand.readings.freshness(asked, is_live, pane.state.now);
        let color = look.value(freshness, look.palette.text);
        let text = format!("{text} {unit}");
        let label = Label::new(&text, color).number().named(look.tr(name));
        label.ui(ui).on_hover_text(look.tr(name));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cards_that_do_not_fit_side_by_side_go_to_another_row() {
        let wide = vec2(990.0, 800.0);
        for (room, hands, columns, rows) in [
            (wide, 1, 1, 1.0),
            (wide, 3, 3, 1.0),
            (wide, 4, 2, 2.0),
            (wide, 5, 3, 2.0),
            (wide, 8, 3, 3.0),
            (vec2(200.0, 800.0), 3, 1, 3.0),
        ] {
            let (size, own) = cards(room, hands);
            assert_eq!(own, columns, "{hands} hands in {room}");
            let across = size.x * number(columns) + theme::GAP * (number(columns) - 1.0);
            assert!(across <= room.x || columns == 1);
            let down = size.y * rows + theme::GAP * (rows - 1.0);
            assert!(down <= room.y || size.y == CARD_LEAST.y);
        }
    }
}
