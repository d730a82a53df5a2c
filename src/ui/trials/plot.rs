//! Curves of trials over the time from a common moment, over each other, and what stands for what. Knows no trial.

use crate::ui::kit::controls;
use crate::ui::kit::controls::Label;
use crate::ui::kit::dash::Dash;
use crate::ui::kit::look::Look;
use crate::ui::plots::chart::{Chart, ChartResponse, ChartView, Curve, Times};
use crate::ui::plots::scales;
use crate::ui::text::Text;
use crate::ui::theme;
use egui::{Color32, Stroke, Ui, vec2};

/// The shortest time that is shown, s.
const LEAST_S: f64 = 0.1;

/// What is drawn.
pub(crate) struct TrialPlot<'a> {
    /// How it looks.
    pub(crate) look: Look,
    /// What it shows, with its unit.
    pub(crate) title: Text,
    /// Said where there is no line.
    pub(crate) empty: Text,
    /// The lines, the foremost last.
    pub(crate) curves: Vec<Curve<'a>>,
    /// Levels to compare with, and their colours.
    pub(crate) levels: Vec<(f64, Color32)>,
    /// What is always shown of the values.
    pub(crate) least: (f64, f64),
}

impl TrialPlot<'_> {
    /// Draws it over all that is left of `ui`; what was drawn, and the line at the pointer by its place in the list.
    pub(crate) fn ui(self, ui: &mut Ui, view: &mut ChartView) -> (ChartResponse, Option<usize>) {
        let levels = self.levels.iter().map(|(level, _)| (*level, *level));
        let mut extent = levels.fold(None, scales::joined);
        let mut span = None;
        for curve in &self.curves {
            for [at_s, value] in curve.points {
                let at_s = at_s - curve.zero[0];
                extent = scales::joined(extent, (*value, *value));
                span = scales::joined(span, (at_s, at_s));
            }
        }
        let (from_s, to_s) = span.unwrap_or_default();
        let to_s = to_s.max(from_s + LEAST_S);
        view.time.advance((from_s, to_s), to_s - from_s);
        let height = ui.available_height();
        let room = height - theme::PLOT_CAPTION - theme::PLOT_TIME_AXIS;
        let chart = Chart {
            title: self.title,
            curves: self.curves,
            levels: self.levels,
            scale: scales::rounded(self.least, extent, room),
            times: Some(Times::From(0.0, "0 s")),
            empty: self.empty,
            ..Chart::new(self.look, height)
        };
        let shown = chart.ui(ui, view);
        let near = chart.nearest(&shown);
        (shown, near)
    }
}

/// What a colour and a kind of stroke stand for.
pub(crate) struct Key {
    /// In words.
    pub(crate) words: String,
    /// The colour.
    pub(crate) color: Color32,
    /// The kind of stroke.
    pub(crate) dash: Dash,
}

impl Key {
    fn width(&self, ui: &Ui) -> f32 {
        let words = controls::text_width(ui, &self.words, theme::small());
        words + theme::KEY_SIGN + 2.0 * theme::GAP
    }
}

/// The room that keys need in one row.
pub(crate) fn keys_width(ui: &Ui, keys: &[Key]) -> f32 {
    keys.iter().map(|key| key.width(ui)).sum()
}

/// Keys in one row, as many as it has room for, and how many more there are.
pub(crate) fn legend_ui(ui: &mut Ui, look: Look, keys: &[Key]) {
    ui.horizontal(|ui| {
        ui.set_height(theme::LIST_LINE);
        for (at, key) in keys.iter().enumerate() {
            if at > 0 && key.width(ui) + theme::KEY_SIGN > ui.available_width() {
                let more = format!("+{}", keys.len() - at);
                Label::new(&more, look.palette.muted).small().ui(ui);
                break;
            }
            let (_, sign) = ui.allocate_space(vec2(theme::KEY_SIGN, theme::LIST_LINE));
            let stroke = Stroke::new(theme::STRONG, key.color);
            key.dash.sample(ui.painter(), sign, stroke);
            Label::new(&key.words, look.palette.text).small().ui(ui);
        }
    });
}
