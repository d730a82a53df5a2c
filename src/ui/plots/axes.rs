//! Scales and grids of the plots: rounded ends, few lines, numbers beside them. Knows no hand.

use crate::ui::kit::controls::paint_text;
use crate::ui::kit::look::Look;
use crate::ui::text::panels;
use crate::ui::theme;
use egui::{Align2, Color32, Pos2, Rect, Stroke, Ui, pos2, vec2};

/// Fewest and most numbers of a value axis.
pub(crate) const NUMBERS_COUNTS: (f32, f32) = (2.0, 5.0);

/// Smallest and largest of some numbers. Numbers that are none are left out.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Extent(Option<(f64, f64)>);

impl Extent {
    /// Takes a number in.
    pub(crate) fn include(&mut self, value: f64) {
        if value.is_finite() {
            let (low, high) = self.0.unwrap_or((value, value));
            self.0 = Some((low.min(value), high.max(value)));
        }
    }
}

/// The ends of a scale and the step between its lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Band {
    /// Lower end.
    pub(crate) low: f64,
    /// Upper end.
    pub(crate) high: f64,
    /// Between two lines.
    pub(crate) step: f64,
}

impl Band {
    /// From what is always shown and what the numbers span.
    pub(crate) fn of(least: (f64, f64), extent: &Extent) -> Self {
        let mut band = Self {
            low: least.0,
            high: least.1,
            step: 1.0,
        };
        if let Some((low, high)) = extent.0 {
            band.include(low);
            band.include(high);
        }
        band
    }

    /// Widens the band.
    pub(crate) fn include(&mut self, value: f64) {
        self.low = self.low.min(value);
        self.high = self.high.max(value);
    }

    /// Rounded outwards to a step that gives no more lines than there is room for, and no more than five.
    pub(crate) fn rounded(self, steps: [f64; 8], room: f32) -> Self {
        let most = f64::from(room.clamp(NUMBERS_COUNTS.0, NUMBERS_COUNTS.1) - 1.0);
        let span = self.high - self.low;
        let fits = |step: &f64| span / step <= most;
        let last = steps.last().copied().unwrap_or(1.0);
        let step = steps.into_iter().find(fits).unwrap_or(last);
        // Ends at half a step, so that little of the plot stays empty.
        let half = step / 2.0;
        // A value a hair below zero must not take a quarter of the plot.
        let low = if self.low < 0.0 && self.low > -step * 0.2 {
            -step * 0.2
        } else {
            (self.low / half).floor() * half
        };
        Self {
            low,
            high: (self.high / half).ceil() * half,
            step,
        }
    }

    /// The values with a line.
    pub(crate) fn lines(self) -> impl Iterator<Item = f64> {
        let first = (self.low / self.step).ceil();
        // No rounded band has more; the bound guards against a broken one.
        (0..32u8)
            .map(move |n| (first + f64::from(n)) * self.step)
            .take_while(move |value| *value <= self.high + self.step * 1e-6)
    }
}

/// Where a value stands between the ends of a rectangle.
pub(crate) fn y_of(rect: Rect, band: &Band, value: f64) -> f32 {
    let part = (value - band.low) / (band.high - band.low);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "0..=1 of a height in pixels"
    )]
    let part = part as f32;
    rect.bottom() - rect.height() * part
}

/// Where a time stands between the ends of a rectangle.
pub(crate) fn x_of(rect: Rect, span: (f64, f64), time_s: f64) -> f32 {
    let part = (time_s - span.0) / (span.1 - span.0);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "0..=1 of a width in pixels"
    )]
    let part = part as f32;
    rect.left() + rect.width() * part
}

/// Where points of a line stand: the same as [`x_of`] and [`y_of`], reckoned once for many of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placing {
    corner: Pos2,
    origin: [f64; 2],
    points_per: [f64; 2],
}

impl Placing {
    /// Between the ends of a rectangle.
    pub(crate) fn of(rect: Rect, span: (f64, f64), band: &Band) -> Self {
        let (width, height) = (f64::from(rect.width()), f64::from(rect.height()));
        Self {
            corner: rect.left_bottom(),
            origin: [span.0, band.low],
            points_per: [width / (span.1 - span.0), height / (band.high - band.low)],
        }
    }

    /// The place of one time and value.
    #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
    pub(crate) fn at(self, [time_s, value]: &[f64; 2]) -> Pos2 {
        let [from_s, low] = self.origin;
        let [per_s, per_unit] = self.points_per;
        let (right, up) = ((time_s - from_s) * per_s, (value - low) * per_unit);
        self.corner + vec2(right as f32, -up as f32)
    }
}

/// The time at a place; the other way round than [`x_of`].
pub(crate) fn time_of(rect: Rect, span: (f64, f64), x: f32) -> f64 {
    let part = f64::from(x - rect.left()) / f64::from(rect.width().max(1.0));
    span.0 + (span.1 - span.0) * part
}

/// A time of the program as a clock shows it, as fine as a stretch of `width_s` seconds needs.
pub(crate) fn clock(time_s: f64, width_s: f64) -> String {
    let digits: u8 = match width_s {
        width if width <= 1.0 => 3,
        width if width <= 20.0 => 2,
        width if width <= 120.0 => 1,
        _ => 0,
    };
    let unit = 10_f64.powi(i32::from(digits));
    // Rounded as a whole, so that 59.999 does not become 0:60.
    let time_s = (time_s.max(0.0) * unit).round() / unit;
    let (hours, minutes) = ((time_s / 3600.0).floor(), (time_s / 60.0).floor() % 60.0);
    let seconds = time_s % 60.0;
    let digits = usize::from(digits);
    let width = if digits == 0 { 2 } else { digits + 3 };
    if hours > 0.0 {
        format!("{hours:.0}:{minutes:02.0}:{seconds:0width$.digits$}")
    } else {
        format!("{minutes:.0}:{seconds:0width$.digits$}")
    }
}

/// The numbers left of a plot.
pub(crate) fn value_axis_ui(ui: &Ui, ground: Rect, look: Look, band: &Band) {
    numbers_ui(ui, ground, band, look.palette.faint);
}

/// The same in a colour.
pub(crate) fn numbers_ui(ui: &Ui, ground: Rect, band: &Band, color: Color32) {
    let digits = digits(band.step);
    for value in band.lines() {
        let y = y_of(ground, band, value);
        let y = y.clamp(
            ground.top() + theme::AXIS_MARGIN,
            ground.bottom() - theme::AXIS_MARGIN,
        );
        let place = Rect::from_center_size(
            pos2(
                ground.left() + theme::PLOT_AXIS / 2.0 - theme::AXIS_MARGIN / 2.0,
                y,
            ),
            vec2(theme::PLOT_AXIS - theme::AXIS_MARGIN, theme::AXIS_NUMBER),
        );
        // No "-0".
        let text = format!("{:.digits$}", value + 0.0);
        let font = theme::number_small();
        paint_text(ui, place, Align2::RIGHT_CENTER, &text, font, color);
    }
}

/// Digits after the point that tell numbers apart which are a step apart.
fn digits(step: f64) -> usize {
    [1.0, 0.1, 0.01]
        .iter()
        .take_while(|least| step < **least)
        .count()
}

/// The time axis of all plots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeAxis {
    /// From and to, in seconds.
    pub(crate) span: (f64, f64),
    /// The newest time, while it is followed: times are then told by how long ago they are.
    pub(crate) now: Option<f64>,
}

/// Seconds between two vertical lines: the least that gives no more than six of them.
const TIME_STEPS: [f64; 16] = [
    0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0,
];

impl TimeAxis {
    fn width_s(self) -> f64 {
        self.span.1 - self.span.0
    }

    fn step_s(self) -> f64 {
        let mut steps = TIME_STEPS.into_iter();
        let fits = |step: &f64| self.width_s() / step <= 6.0 + 1e-9;
        steps.find(fits).unwrap_or(600.0)
    }

    /// The times with a vertical line, newest first.
    fn lines(self) -> impl Iterator<Item = f64> {
        let step = self.step_s();
        let newest = match self.now {
            Some(now) => now,
            None => (self.span.1 / step).floor() * step,
        };
        (0..16u8)
            .map(move |n| newest - f64::from(n) * step)
            .take_while(move |time| *time >= self.span.0 - step * 1e-6)
    }

    fn text(self, time_s: f64) -> String {
        let Some(now) = self.now else {
            return clock(time_s, self.width_s());
        };
        let ago = now - time_s;
        if self.width_s() > 60.0 {
            format!("-{:.0} min", ago / 60.0)
        } else {
            format!("-{ago:.0} s")
        }
    }
}

/// The lines behind the curves.
pub(crate) fn grid(ui: &Ui, rect: Rect, look: Look, band: &Band, time: TimeAxis) {
    let painter = ui.painter();
    let stroke = Stroke::new(1.0, look.palette.grid);
    for value in band.lines() {
        let strong = value.abs() < band.step * 1e-6 && band.low < 0.0;
        let color = if strong {
            look.palette.edge
        } else {
            look.palette.grid
        };
        painter.hline(
            rect.x_range(),
            y_of(rect, band, value),
            Stroke::new(1.0, color),
        );
    }
    for time_s in time.lines() {
        painter.vline(x_of(rect, time.span, time_s), rect.y_range(), stroke);
    }
}

/// The numbers under the lowest plot.
pub(crate) fn time_axis_ui(ui: &Ui, rect: Rect, look: Look, time: TimeAxis) {
    let (font, color) = (theme::number_small(), look.palette.faint);
    for time_s in time.lines() {
        let x = x_of(rect, time.span, time_s);
        let is_now = time.now == Some(time_s);
        let text = if is_now {
            look.say(panels::NOW).to_owned()
        } else {
            time.text(time_s)
        };
        let place = Rect::from_center_size(pos2(x, rect.center().y), theme::AXIS_TIME);
        let place = place.translate(vec2((rect.right() - place.right()).min(0.0), 0.0));
        let align = if is_now {
            Align2::RIGHT_CENTER
        } else {
            Align2::CENTER_CENTER
        };
        if x - rect.left() > theme::AXIS_TIME_LEAST || is_now {
            paint_text(ui, place, align, &text, font.clone(), color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: [f64; 8] = [50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10_000.0];

    #[test]
    fn a_scale_always_holds_its_numbers_and_has_few_lines() {
        for (low, high) in [
            (0.0, 3.0),
            (-33.0, 812.0),
            (-4000.0, 4000.0),
            (0.0, 32_767.0),
        ] {
            let mut extent = Extent::default();
            extent.include(low);
            extent.include(high);
            let band = Band::of((0.0, 200.0), &extent).rounded(STEPS, 5.0);
            assert!(band.low <= low.min(0.0) && band.high >= high, "{band:?}");
            assert!((2..=10).contains(&band.lines().count()), "{band:?}");
        }
    }

    #[test]
    fn not_a_number_does_not_move_a_scale() {
        let mut extent = Extent::default();
        extent.include(f64::NAN);
        extent.include(f64::INFINITY);
        let band = Band::of((0.0, 200.0), &extent).rounded(STEPS, 5.0);
        assert_eq!((band.low, band.high), (0.0, 200.0));
    }

    #[test]
    fn a_clock_is_as_fine_as_it_needs_to_be() {
        for (time_s, width_s, text) in [
            (5.25, 10.0, "0:05.25"),
            (59.999, 10.0, "1:00.00"),
            (3_725.0, 600.0, "1:02:05"),
            (65.1234, 0.5, "1:05.123"),
            (-1.0, 600.0, "0:00"),
        ] {
            assert_eq!(clock(time_s, width_s), text);
        }
    }

    #[test]
    fn a_place_and_its_time_belong_together_and_lines_are_few() {
        let rect = Rect::from_min_size(pos2(40.0, 0.0), vec2(500.0, 100.0));
        for width_s in [0.02, 0.7, 5.0, 42.0, 600.0, 3600.0] {
            let span = (100.0, 100.0 + width_s);
            let time_s = time_of(rect, span, 165.0);
            assert!((x_of(rect, span, time_s) - 165.0).abs() < 0.01);
            for now in [None, Some(span.1)] {
                let count = TimeAxis { span, now }.lines().count();
                assert!((1..=8).contains(&count), "{width_s}: {count}");
            }
        }
    }
}
