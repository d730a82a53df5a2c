//! Curves of trials over the time from a common moment: lines over each other, levels to compare with, and the line at the
//! pointer. Knows no trial.

use crate::ui::kit::controls::{Label, paint_text};
use crate::ui::kit::dash::Dash;
use crate::ui::kit::look::Look;
use crate::ui::plots::axes as plot_axes;
use crate::ui::plots::axes::{Band, Extent, Placing};
use crate::ui::theme;
use egui::{
    Align2, Color32, CornerRadius, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

/// Steps of the value axis that fit any of the quantities.
const STEPS: [f64; 12] = [
    0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0,
];
/// Steps of the time axis, seconds.
const TIME_STEPS: [f64; 10] = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0];

/// The shortest time that is shown, s.
const LEAST_S: f64 = 0.1;

/// One line.
pub(crate) struct TrialLine<'a> {
    /// Seconds and values.
    pub(crate) points: &'a [[f64; 2]],
    /// Seconds that are taken from each.
    pub(crate) zero_s: f64,
    /// Its colour.
    pub(crate) color: Color32,
    /// Its width.
    pub(crate) width: f32,
    /// Its kind.
    pub(crate) dash: Dash,
}

/// What a person points at.
pub(crate) struct Pointed {
    /// The line, by its place in the list.
    pub(crate) line: Option<usize>,
    /// Whether it was pressed, or nothing was.
    pub(crate) clicked: bool,
}

/// What is drawn.
pub(crate) struct TrialPlot<'a> {
    /// How it looks.
    pub(crate) look: Look,
    /// What it shows, with its unit.
    pub(crate) name: &'a str,
    /// Said where there is no line.
    pub(crate) empty: &'a str,
    /// The lines, the foremost last.
    pub(crate) lines: Vec<TrialLine<'a>>,
    /// Levels to compare with, and their colours.
    pub(crate) levels: Vec<(f64, Color32)>,
    /// What is always shown of the values.
    pub(crate) least: (f64, f64),
}

impl TrialLine<'_> {
    fn places(&self, placing: Placing) -> Vec<Pos2> {
        let place = |[t, v]: &[f64; 2]| placing.at(&[t - self.zero_s, *v]);
        self.points.iter().map(place).collect()
    }
}

/// The line that passes next to a place, if one is near; of several the foremost.
fn nearest(lines: &[Vec<Pos2>], at: Pos2) -> Option<usize> {
    let apart = |places: &Vec<Pos2>| {
        let pairs = places.iter().zip(places.iter().skip(1));
        let apart = pairs.map(|(from, to)| distance(*from, *to, at));
        apart.reduce(f32::min)
    };
    let near = lines.iter().enumerate().rev();
    let near = near.filter_map(|(index, places)| Some((index, apart(places)?)));
    let near = near.filter(|(_, apart)| *apart <= theme::LINE_NEAR);
    let near = near.min_by(|(_, a), (_, b)| a.total_cmp(b));
    near.map(|(index, _)| index)
}

/// From a place to a piece of a line.
fn distance(from: Pos2, to: Pos2, at: Pos2) -> f32 {
    let way = to - from;
    let long = way.length_sq();
    let part = if long > 0.0 {
        ((at - from).dot(way) / long).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (from + way * part).distance(at)
}

impl TrialPlot<'_> {
    /// Draws it, and says what the pointer is at.
    pub(crate) fn ui(&self, ui: &mut Ui, rect: Rect) -> Pointed {
        let look = self.look;
        let ground = rect.with_max_y(rect.bottom() - theme::PLOT_TIME_AXIS);
        let plot = ground.with_min_x(ground.left() + theme::PLOT_AXIS);
        let response = ui.interact(
            plot,
            egui::Id::unique(("trial plot", self.name)),
            Sense::click(),
        );
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, self.name));
        ui.painter().rect_filled(
            plot,
            CornerRadius::same(theme::ROUND_TINY),
            look.palette.sunken,
        );
        let Some((span, band)) = self.ranges(plot) else {
            Label::new(self.empty, look.palette.faint)
                .small()
                .center()
                .put(ui, plot);
            return Pointed {
                line: None,
                clicked: false,
            };
        };
        plot_axes::value_axis_ui(ui, ground, look, &band);
        for value in band.lines() {
            let y = plot_axes::y_of(plot, &band, value);
            let stroke = Stroke::new(1.0, look.palette.grid);
            ui.painter().hline(plot.x_range(), y, stroke);
        }
        self.time_ui(ui, plot, span, rect.bottom());
        let painter = ui.painter().with_clip_rect(plot.intersect(ui.clip_rect()));
        for (level, color) in &self.levels {
            let y = plot_axes::y_of(plot, &band, *level);
            let ends = [pos2(plot.left(), y), pos2(plot.right(), y)];
            let stroke = Stroke::new(1.0, *color);
            painter.extend(egui::Shape::dashed_line(
                &ends,
                stroke,
                theme::GAP,
                theme::STEP,
            ));
        }
        let placing = Placing::of(plot, span, &band);
        let mut all: Vec<Vec<Pos2>> = self.lines.iter().map(|line| line.places(placing)).collect();
        let near = response.hover_pos().and_then(|at| nearest(&all, at));
        for (line, places) in self.lines.iter().zip(&mut all) {
            let stroke = Stroke::new(line.width, line.color);
            line.dash.line(&painter, std::mem::take(places), stroke);
        }
        if let Some(line) = near.and_then(|at| self.lines.get(at)) {
            let stroke = Stroke::new(theme::STRONG, line.color.to_opaque());
            line.dash.line(&painter, line.places(placing), stroke);
        }
        Pointed {
            line: near,
            clicked: response.clicked(),
        }
    }

    fn ranges(&self, plot: Rect) -> Option<((f64, f64), Band)> {
        let mut extent = Extent::default();
        let mut span: Option<(f64, f64)> = None;
        for line in &self.lines {
            for [t, v] in line.points {
                let t = t - line.zero_s;
                let (from, to) = span.unwrap_or((t, t));
                span = Some((from.min(t), to.max(t)));
                extent.include(*v);
            }
        }
        for (level, _) in &self.levels {
            extent.include(*level);
        }
        let (from, to) = span?;
        let wide = Band::of(self.least, &extent);
        // The finest eight steps that are not too fine, as the scales of the other plots have.
        let fine = STEPS
            .iter()
            .position(|step| (wide.high - wide.low) / step <= 8.0);
        let from_step = fine.unwrap_or(4).saturating_sub(1).min(4);
        let mut steps = [1.0; 8];
        for (step, own) in steps.iter_mut().zip(STEPS.into_iter().skip(from_step)) {
            *step = own;
        }
        let band = wide.rounded(steps, plot.height() / theme::TRIAL_NUMBER);
        Some(((from, to.max(from + LEAST_S)), band))
    }

    /// Seconds from the common moment.
    fn time_ui(&self, ui: &Ui, plot: Rect, span: (f64, f64), bottom: f32) {
        let look = self.look;
        let most = f64::from((plot.width() / theme::TRIAL_TIME).max(2.0));
        let mut steps = TIME_STEPS.into_iter();
        let step = steps.find(|step| (span.1 - span.0) / step <= most);
        let step = step.unwrap_or(120.0);
        let first = (span.0 / step).ceil();
        for number in 0..32_u8 {
            let at_s = (first + f64::from(number)) * step;
            if at_s > span.1 {
                break;
            }
            let x = plot_axes::x_of(plot, span, at_s);
            let zero = at_s.abs() < step * 0.5;
            let color = if zero {
                look.palette.muted
            } else {
                look.palette.grid
            };
            ui.painter()
                .vline(x, plot.y_range(), Stroke::new(1.0, color));
            let center = pos2(x, bottom - theme::PLOT_TIME_AXIS / 2.0);
            let size = vec2(theme::TRIAL_TIME, theme::PLOT_TIME_AXIS);
            let place = Rect::from_center_size(center, size);
            let over = (place.right() - plot.right()).max(0.0);
            // Pushed further aside it would be read as the time of another line, or run into its number.
            if over > theme::PAD {
                continue;
            }
            let place = place.translate(vec2(-over, 0.0));
            let digits = usize::from(step < 1.0) + usize::from(step < 0.1);
            let text = format!("{:.digits$} s", at_s + 0.0);
            let (font, color) = (theme::number_small(), look.palette.faint);
            paint_text(ui, place, Align2::CENTER_CENTER, &text, font, color);
        }
    }
}
