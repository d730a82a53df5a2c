//! One fingertip in detail: margin of its grip to slipping, its forces and channels over time.

use crate::app::readings::Freshness;
use crate::app::readings::friction::{FrictionState, FrictionUse, NEAR};
use crate::hand::Touch;
use crate::hand::{Finger, PerFinger, TactileBlock};
use crate::history::Series;
use crate::ui::joints::track::SlideTrack;
use crate::ui::kit::{self, Label, Look, Pane, format};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartView};
use crate::ui::plots::legend::{LegendKey, legend_ui};
use crate::ui::plots::times::Times;
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use crate::ui::touch::tip_channels::TipChannels;
use egui::{Color32, Id, Painter, Pos2, Rect, Stroke, Ui, Vec2, vec2};
use egui_plot::LineStyle;

/// Default friction in percent: about that of rubber on smooth plastic.
const FRICTION_PERCENT: i16 = 50;
/// Maximum friction that can be set, in percent.
const FRICTION_MAX: i16 = 150;
/// Range of the compass, as a multiple of the set friction.
const COMPASS_END_RATIO: f32 = 1.5;

/// View state: the fingertip shown, and the assumed friction.
#[derive(Debug)]
pub(crate) struct TipDetail {
    pub(crate) finger: Finger,
    friction_percent: i16,
    holds: PerFinger<FrictionState>,
    channels: TipChannels,
    chart: ChartView,
}

impl Default for TipDetail {
    fn default() -> Self {
        Self {
            finger: Finger::Index,
            friction_percent: FRICTION_PERCENT,
            holds: PerFinger::default(),
            channels: TipChannels::default(),
            chart: ChartView::default(),
        }
    }
}

impl TipDetail {
    fn friction(&self) -> f32 {
        f32::from(self.friction_percent) / 100.0
    }

    /// Updates the grip states of all fingertips, so that an alarm neither flickers nor waits until its fingertip is shown.
    pub(crate) fn follow(&mut self, pane: &Pane<'_>) {
        for finger in Finger::ALL {
            let block = pane.hand().readings.sample.tactile[finger];
            let live = pane.tip_freshness(finger) == Freshness::Live;
            let block = block.filter(|_| live).map(|block| block.value);
            self.holds[finger] =
                self.holds[finger].next(FrictionUse::of(block.as_ref()), self.friction());
        }
    }

    /// Last grip state of a fingertip.
    pub(crate) fn hold(&self, finger: Finger) -> FrictionState {
        self.holds[finger]
    }

    /// Draws compass, readings, forces and channels over time, as many as fit.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let room = ui.available_size();
        ui.horizontal_top(|ui| {
            if room.x >= 700.0 {
                let size = room.y.min(room.x * 0.22);
                let (_, compass) = ui.allocate_space(Vec2::splat(size));
                self.compass_ui(ui, compass, pane);
            }
            let width = (ui.available_width() * 0.28).clamp(150.0, 230.0);
            ui.allocate_ui(vec2(width, room.y), |ui| {
                ui.vertical(|ui| {
                    ui.set_width(width);
                    self.readings_ui(ui, pane);
                });
            });
            ui.add_space(theme::GAP);
            ui.vertical(|ui| {
                if room.y >= 270.0 {
                    let forces = vec2(ui.available_width(), room.y * 0.36);
                    ui.allocate_ui(forces, |ui| self.forces_ui(ui, pane));
                    ui.add_space(theme::GAP);
                }
                self.channels.ui(ui, pane, self.finger);
            });
        });
    }

    fn block<'a>(&self, pane: &Pane<'a>) -> (Option<&'a TactileBlock>, Freshness) {
        let block = pane.hand().readings.sample.tactile[self.finger].as_ref();
        let freshness = pane.tip_freshness(self.finger);
        (block.map(|block| &block.value), freshness)
    }

    /// Draws the fingertip seen from the front, tip up: the ring is the friction limit, the dot the current force.
    fn compass_ui(&self, ui: &Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let palette = look.palette;
        let (center, radius) = (rect.center(), rect.width() / 2.0 - theme::STEP);
        let painter = ui.painter();
        let (edge, grid) = ((1.0, palette.edge), (1.0, palette.grid));
        painter.circle(center, radius, palette.sunken, edge);
        for turn in 0..4u8 {
            let way = Vec2::angled(f32::from(turn) * std::f32::consts::FRAC_PI_2);
            painter.line_segment([center, center + way * radius], grid);
        }
        let ring = radius / COMPASS_END_RATIO;
        let firm = (theme::FOCUS_LINE, palette.ok);
        painter.circle(center, ring, palette.wash(palette.ok), firm);
        painter.circle_stroke(center, ring * (1.0 - NEAR), grid);
        let up = center - vec2(0.0, radius - theme::GAP);
        let up = Rect::from_center_size(up, vec2(40.0, 12.0));
        let text = look.tr(panels::TIP_UP);
        let label = Label::new(text, palette.faint).small();
        label.center().paint(ui, up);
        let (block, freshness) = self.block(pane);
        let (FrictionUse::Ratio(ratio), Some(block)) = (FrictionUse::of(block), block) else {
            return;
        };
        let Some(degrees) = block.direction_deg() else {
            return;
        };
        let color = look.value(freshness, color_of(self.hold(self.finger), palette));
        let (sin, cos) = f32::from(degrees).to_radians().sin_cos();
        let part = (ratio / self.friction().max(0.01)).min(COMPASS_END_RATIO);
        needle(painter, center, vec2(sin, -cos) * (ring * part), color);
    }

    fn readings_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let (block, freshness) = self.block(pane);
        let grip = FrictionUse::of(block);
        let unknown = || format::UNKNOWN.to_owned();
        let ratio = match grip {
            FrictionUse::Ratio(ratio) => format!("{ratio:.2}"),
            FrictionUse::Unknown | FrictionUse::Loose => unknown(),
        };
        let margin = grip.margin(self.friction());
        let margin = margin.map_or_else(unknown, |margin| format!("{:.0} %", margin * 100.0));
        let hold = self.hold(self.finger);
        let size = vec2(ui.available_width(), theme::CONTROL);
        ui.spacing_mut().item_spacing.y = 0.0;
        for (caption, value, color) in [
            (panels::TIP_RATIO, ratio, look.palette.text),
            (panels::TIP_MARGIN, margin, color_of(hold, look.palette)),
        ] {
            kit::cell_ui(ui, size, |ui| {
                Label::note(look, caption).ui(ui);
                kit::right_ui(ui, |ui| {
                    let label = Label::new(&value, look.value(freshness, color)).number();
                    label.named(look.tr(caption)).ui(ui);
                });
            });
        }
        let place = ui.allocate_space(size).1;
        self.verdict_ui(ui, place, look);
        kit::cell_ui(ui, size, |ui| self.friction_ui(ui, look));
    }

    fn verdict_ui(&self, ui: &mut Ui, place: Rect, look: Look) {
        let hold = self.hold(self.finger);
        let color = color_of(hold, look.palette);
        if hold == FrictionState::Slips {
            let ground = place.expand2(vec2(theme::STEP, 0.0));
            let wash = look.palette.wash(color);
            ui.painter().rect_filled(ground, theme::STEP, wash);
        }
        Label::new(look.tr(panels::hold(hold)), color).put(ui, place);
    }

    fn friction_ui(&mut self, ui: &mut Ui, look: Look) {
        let caption = format!("{} {:.2}", look.tr(panels::TIP_FRICTION), self.friction());
        Label::new(&caption, look.palette.muted).small().ui(ui);
        let name = look.tr(panels::TIP_FRICTION_NAME);
        let track = SlideTrack {
            tip: look.tip(panels::TIP_FRICTION),
            step: 1,
            target: Some(self.friction_percent),
            tick: Some(FRICTION_PERCENT),
            ..SlideTrack::new(name, FRICTION_MAX, look.palette.accent)
        };
        let place = ui.allocate_space(ui.available_size()).1;
        if let Some(percent) = track.put(ui, look, place, Id::unique("tip friction")) {
            self.friction_percent = percent.max(1);
        }
    }

    fn forces_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let history = &pane.hand().measured.history;
        let own = look.palette.dof[self.finger.bend()];
        let lines = [
            (Touch::Normal, panels::TIP_NORMAL, own),
            (Touch::Tangential, panels::TIP_SHEAR, look.palette.muted),
        ];
        let key = |(_, words, color): (Touch, Text, Color32)| LegendKey {
            words: look.tr(words).to_owned(),
            color,
            style: LineStyle::Solid,
        };
        legend_ui(ui, look, &lines.map(key));
        let now = pane.state.now.secs();
        self.chart.advance(history, now, 10.0);
        let curve = |(touch, _, color): (Touch, Text, Color32)| ChartCurve {
            decimals: Some(2),
            ..ChartCurve::measured(history, Series::Tip(touch, self.finger), color)
        };
        let chart = Chart {
            curves: lines.map(curve).to_vec(),
            least: (0.0, 1.0),
            times: Times::From(now, look.tr(panels::NOW)),
            ..Chart::new(look, panels::FORCES, ui.available_height())
        };
        chart.ui(ui, &mut self.chart);
    }
}

/// Colour of a grip state.
const fn color_of(hold: FrictionState, palette: &theme::Palette) -> egui::Color32 {
    match hold {
        FrictionState::Unknown | FrictionState::Loose => palette.faint,
        FrictionState::Firm => palette.ok,
        FrictionState::Near => palette.warn,
        FrictionState::Slips => palette.bad,
    }
}

fn needle(painter: &Painter, from: Pos2, by: Vec2, color: egui::Color32) {
    painter.line_segment([from, from + by], Stroke::new(2.5, color));
    painter.circle_filled(from + by, theme::LAMP + 1.0, color);
}
