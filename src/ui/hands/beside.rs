//! All hands side by side, each with its drawn hand, state, and current measurements.

use crate::app::hand::Hand;
use crate::app::settings::PlotKind;
use crate::app::slot::SlotId;
use crate::hand::{PerDof, PerFinger};
use crate::ui::hand::panel::{StillHand, picture};
use crate::ui::hands::strips::HandWords;
use crate::ui::kit::{self, Label, Pane};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartView, height_over_axis};
use crate::ui::plots::panels::PANELS;
use crate::ui::theme;
use egui::{Align, Layout, ScrollArea, Ui, UiBuilder, vec2};
use std::collections::BTreeMap;

/// Minimum column width: the plots need space beside their numbers.
const COLUMN_LEAST: f32 = 272.0;
/// Height of a plot, as a share of its column, and its minimum.
const PLOT_PART: f32 = 0.24;
const PLOT_LEAST: f32 = 96.0;
/// Plots of each hand, from top to bottom.
const PLOTS: [PlotKind; 2] = [PlotKind::Force, PlotKind::Angle];

/// View state of one column.
#[derive(Debug, Default)]
struct HandColumn {
    picture: StillHand,
    charts: ChartView,
}

/// View state of the columns, by hand.
#[derive(Debug, Default)]
pub(crate) struct BesideView(BTreeMap<SlotId, HandColumn>);

impl BesideView {
    /// Draws a column for each hand, with a scroll bar if they do not all fit.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let hands = &pane.state.hands;
        self.0
            .retain(|slot, _| hands.iter().any(|hand| hand.label.slot == *slot));
        let count = f32::from(u8::try_from(hands.count()).unwrap_or(u8::MAX));
        let room = ui.available_width() - theme::GAP * (count - 1.0);
        let width = (room / count).floor().max(COLUMN_LEAST);
        ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
            let height = ui.available_height();
            ui.spacing_mut().item_spacing.x = theme::GAP;
            ui.horizontal_top(|ui| {
                for (at, hand) in hands.iter().enumerate() {
                    let (_, rect) = ui.allocate_space(vec2(width, height));
                    // Columns scrolled out of view are not computed.
                    if !ui.is_rect_visible(rect) {
                        continue;
                    }
                    let slot = hand.label.slot;
                    let down = Layout::top_down(Align::Min);
                    let place = UiBuilder::new().max_rect(rect).id_salt(slot).layout(down);
                    let column = self.0.entry(slot).or_default();
                    ui.scope_builder(place, |ui| column.ui(ui, pane, at, hand));
                }
            });
        });
    }
}

impl HandColumn {
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
            });
            let whole = ui.available_height();
            let plot = (whole * PLOT_PART).max(PLOT_LEAST).floor();
            let plots = 2.0 * plot + theme::PLOT_TIME_AXIS + theme::GAP;
            let room = vec2(ui.available_width(), (whole - plots).max(1.0));
            let (_, place) = ui.allocate_space(room);
            let shown = picture(hand, &PerFinger::default(), pane.state.now);
            self.picture.ui(ui, place, look, &shown);
            self.plots_ui(ui, pane, hand, plot);
        });
    }

    fn plots_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, hand: &Hand, height: f32) {
        let look = pane.look;
        let (now_s, history) = (pane.state.now.secs(), &hand.measured.history);
        let window = pane.state.settings.plot_window.seconds();
        self.charts.advance(history, now_s, window);
        ui.spacing_mut().item_spacing.y = 0.0;
        let panels = PANELS.iter().filter(|panel| PLOTS.contains(&panel.kind));
        for panel in panels {
            let is_lowest = panel.kind == PlotKind::Angle;
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
