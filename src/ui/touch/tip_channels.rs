//! The eight channels of one fingertip over time, raw or relative to their zero.

use crate::hand::Finger;
use crate::history::Series;
use crate::ui::kit::{Look, Pane, Pick};
use crate::ui::plots::chart::{Chart, ChartCurve, ChartView};
use crate::ui::plots::legend::{LegendKey, legend_ui};
use crate::ui::plots::times::Times;
use crate::ui::text::{Text, panels};
use egui::{Color32, Ui};
use egui_plot::LineStyle;

/// Time windows, in seconds, with their names.
const WINDOWS: [(f64, Text); 3] = [
    (10.0, panels::LAST_10_S),
    (60.0, panels::LAST_MINUTE),
    (600.0, panels::LAST_10_MIN),
];
/// Range of counts that is always visible: variations within it are noise.
const LEAST: (f64, f64) = (-1000.0, 1000.0);

/// View state of the channels.
#[derive(Debug)]
pub(crate) struct TipChannels {
    /// Relative to the zero instead of raw.
    tared: bool,
    /// Visible time in seconds.
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

/// Colour of a channel.
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
    /// Draws choice, legend and plot.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, finger: Finger) {
        let look = pane.look;
        self.head_ui(ui, look);
        let key = |number: usize| LegendKey {
            words: (number + 1).to_string(),
            color: color(look, number),
            style: LineStyle::Solid,
        };
        legend_ui(ui, look, &std::array::from_fn::<_, 8, _>(key));
        self.plot_ui(ui, pane, finger);
    }

    fn head_ui(&mut self, ui: &mut Ui, look: Look) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let zeros = [(false, panels::RAW), (true, panels::TARED)];
            Pick::new(look, panels::TARED.tip()).ui(ui, &mut self.tared, zeros);
            let windows = Pick::new(look, panels::LAST_TIP);
            if windows.ui(ui, &mut self.window_s, WINDOWS) {
                self.chart.time.follow();
            }
        });
    }

    fn plot_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, finger: Finger) {
        let look = pane.look;
        let hand = pane.hand();
        let zero = hand.readings.tare.zero(finger).filter(|_| self.tared);
        let now = pane.state.now.secs();
        let history = &hand.measured.history;
        self.chart.advance(history, now, self.window_s);
        let curve = |(channel, number): (u8, usize)| {
            let zero = zero.and_then(|zero| zero.raw.get(number).copied());
            let series = Series::Channel(channel, finger);
            ChartCurve {
                zero: [0.0, zero.map_or(0.0, f64::from)],
                decimals: Some(0),
                ..ChartCurve::measured(history, series, color(look, number))
            }
        };
        let chart = Chart {
            curves: (0..8).zip(0..).map(curve).collect(),
            least: LEAST,
            times: Times::From(now, look.tr(panels::NOW)),
            ..Chart::new(look, panels::CHANNELS, ui.available_height())
        };
        chart.ui(ui, &mut self.chart);
    }
}
