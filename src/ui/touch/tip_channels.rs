//! The eight channels of one fingertip over time, as sent or from their zero, each with its change and noise.

use crate::hand::Finger;
use crate::history::Series;
use crate::ui::kit::{self, Label, Look, Pane, format};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartView, Points};
use crate::ui::plots::times::Times;
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::{Align, Color32, Layout, Stroke, Ui, vec2};

/// What can be shown, in seconds, with its name.
const WINDOWS: [(f64, Text); 3] = [
    (10.0, panels::LAST_10_S),
    (60.0, panels::LAST_MINUTE),
    (600.0, panels::LAST_10_MIN),
];
/// Over this time mean and noise are taken, in seconds.
const SWING_S: f64 = 1.0;
/// Counts that are always shown: what stays between them is noise.
const LEAST: (f64, f64) = (-1000.0, 1000.0);

/// How the channels are shown.
#[derive(Debug)]
pub(crate) struct TipChannels {
    /// From the zero, or as the hand sends them.
    tared: bool,
    /// Seconds.
    window_s: f64,
    chart: ChartView,
}

impl Default for TipChannels {
    fn default() -> Self {
        Self {
            tared: true,
            window_s: 10.0,
            chart: ChartView::default(),
        }
    }
}

/// One colour for each channel.
fn color(look: Look, channel: usize) -> Color32 {
    let palette = look.palette;
    let joints = palette.dof.as_array();
    let joint = joints.get(channel).copied();
    joint.unwrap_or(if channel == 6 {
        palette.muted
    } else {
        palette.text
    })
}

impl TipChannels {
    /// Draws choice, plot and list.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, finger: Finger) {
        self.head_ui(ui, pane.look);
        ui.with_layout(Layout::right_to_left(Align::TOP), |ui| {
            if ui.available_width() >= 330.0 {
                let place = vec2(176.0, ui.available_height());
                let down = Layout::top_down(Align::Max);
                ui.allocate_ui_with_layout(place, down, |ui| list_ui(ui, pane, finger));
            }
            let down = Layout::top_down(Align::Min);
            ui.with_layout(down, |ui| self.plot_ui(ui, pane, finger));
        });
    }

    fn head_ui(&mut self, ui: &mut Ui, look: Look) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let zeros = [(false, panels::RAW), (true, panels::TARED)];
            kit::pick_ui(ui, look, (&mut self.tared, panels::TARED.tip()), zeros);
            if kit::pick_ui(ui, look, (&mut self.window_s, panels::LAST_TIP), WINDOWS) {
                self.chart.time.follow();
            }
        });
    }

    fn plot_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, finger: Finger) {
        let look = pane.look;
        let hand = pane.state.hand();
        let zero = hand.tare.zero(finger).filter(|_| self.tared);
        let now = pane.state.now.secs();
        let first = hand.history.first_secs().unwrap_or(now);
        self.chart
            .time
            .advance((first.min(now), now), self.window_s);
        let curve = |(channel, number): (u8, usize)| {
            let zero = zero.and_then(|zero| zero.raw.get(number).copied());
            let points = Points::Measured(&hand.history, Series::Channel(channel, finger));
            ChartCurve {
                zero: [0.0, zero.map_or(0.0, f64::from)],
                told: Some(0),
                ..ChartCurve::new(points, Stroke::new(theme::LINE, color(look, number)))
            }
        };
        let chart = Chart {
            curves: (0..8).zip(0..).map(curve).collect(),
            least: LEAST,
            times: Times::From(now, look.say(panels::NOW)),
            ..Chart::new(look, panels::CHANNELS, ui.available_height())
        };
        chart.ui(ui, &mut self.chart);
    }
}

/// Each channel with its change from zero and how far it swings, over the last second.
fn list_ui(ui: &mut Ui, pane: &Pane<'_>, finger: Finger) {
    let look = pane.look;
    let hand = pane.state.hand();
    ui.spacing_mut().item_spacing.y = 0.0;
    let head = Label::note(look, panels::SWING_HEAD);
    head.ui(ui).on_hover_text(look.tip(panels::SWING));
    let now = pane.state.now.secs();
    let zero = hand.tare.zero(finger);
    let row = (ui.available_height() / 8.0).min(20.0);
    for (channel, at) in (0..8u8).zip(0..) {
        let series = Series::Channel(channel, finger);
        let last = hand.history.summary(series, now - SWING_S, now);
        let zero = zero.and_then(|zero| zero.raw.get(at).copied());
        let change = last.zip(zero);
        let change = change.map(|(last, zero)| whole(last.mean - f64::from(zero)));
        let swing = last.map(|last| whole(f64::from(last.max - last.min)));
        let place = vec2(ui.available_width(), row);
        ui.allocate_ui_with_layout(place, Layout::right_to_left(Align::Center), |ui| {
            ui.set_min_height(row);
            let words = format!("{:>7} {:>6}", signed(change), format::counts(swing));
            let name = look.told(panels::SWING, channel + 1);
            let label = Label::new(&words, look.palette.text).font(theme::number_small());
            label.named(&name).ui(ui);
            kit::left_ui(ui, |ui| {
                let (_, sign) = ui.allocate_space(vec2(theme::PAD, row));
                let stroke = Stroke::new(theme::BAR, color(look, at));
                ui.painter().hline(sign.x_range(), sign.center().y, stroke);
                let number = (channel + 1).to_string();
                Label::new(&number, look.palette.muted).small().ui(ui);
            });
        });
    }
}

/// A change with its sign, shortened like counts.
pub(crate) fn signed(value: Option<i64>) -> String {
    match value {
        Some(value) if value > 0 => format!("+{}", format::counts(Some(value))),
        other => format::counts(other),
    }
}

fn whole(value: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "counts are far below 2^53")]
    let whole = value as i64;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_has_its_sign() {
        let words = [Some(1234), Some(-5), Some(0), None].map(signed);
        assert_eq!(words, ["+1234", "-5", "0", "-"]);
    }
}
