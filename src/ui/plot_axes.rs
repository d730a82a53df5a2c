//! Scales and grids of the plots: rounded ends, few lines, numbers beside them. Knows no hand.

use crate::ui::controls::paint_text;
use crate::ui::look::Look;
use crate::ui::plots::AXIS;
use crate::ui::text::panels;
use crate::ui::theme;
use egui::{Align2, Rect, Stroke, Ui, pos2, vec2};

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
        let most = f64::from(room.clamp(2.0, 5.0) - 1.0);
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
fn y_of(rect: Rect, band: &Band, value: f64) -> f32 {
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

/// The numbers left of a plot.
pub(crate) fn value_axis_ui(ui: &Ui, ground: Rect, look: Look, band: &Band) {
    for value in band.lines() {
        let y = y_of(ground, band, value);
        let y = y.clamp(ground.top() + 6.0, ground.bottom() - 6.0);
        let place = Rect::from_center_size(
            pos2(ground.left() + AXIS / 2.0 - 3.0, y),
            vec2(AXIS - 6.0, 12.0),
        );
        let text = format!("{value:.0}");
        let (font, color) = (theme::number_small(), look.palette.faint);
        paint_text(ui, place, Align2::RIGHT_CENTER, &text, font, color);
    }
}

/// Seconds between two vertical lines.
fn time_step(window_s: f64) -> f64 {
    match window_s {
        s if s <= 5.0 => 1.0,
        s if s <= 10.0 => 2.0,
        s if s <= 30.0 => 5.0,
        s if s <= 60.0 => 10.0,
        s if s <= 300.0 => 60.0,
        s if s <= 600.0 => 120.0,
        s if s <= 1800.0 => 300.0,
        _ => 600.0,
    }
}

/// The vertical lines of a window, as seconds ago and place.
fn time_lines(rect: Rect, window_s: f64) -> impl Iterator<Item = (f64, f32)> {
    let step = time_step(window_s);
    (0..32u8)
        .map(move |n| f64::from(n) * step)
        .take_while(move |ago| *ago <= window_s)
        .map(move |ago| {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "0..=1 of a width in pixels"
            )]
            let part = (ago / window_s) as f32;
            (ago, rect.right() - rect.width() * part)
        })
}

/// The lines behind the curves.
pub(crate) fn grid(ui: &Ui, rect: Rect, look: Look, band: &Band, window_s: f64) {
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
    for (_, x) in time_lines(rect, window_s) {
        painter.vline(x, rect.y_range(), stroke);
    }
}

/// The numbers under the lowest plot.
pub(crate) fn time_axis_ui(ui: &Ui, rect: Rect, look: Look, window_s: f64) {
    let (font, color) = (theme::number_small(), look.palette.faint);
    for (ago, x) in time_lines(rect, window_s) {
        let text = match ago {
            0.0 => look.say(panels::NOW).to_owned(),
            ago if window_s > 60.0 => format!("-{:.0} min", ago / 60.0),
            ago => format!("-{ago:.0} s"),
        };
        let place = Rect::from_center_size(pos2(x, rect.center().y), vec2(56.0, 14.0));
        let place = place.translate(vec2((rect.right() - place.right()).min(0.0), 0.0));
        let align = if ago == 0.0 {
            Align2::RIGHT_CENTER
        } else {
            Align2::CENTER_CENTER
        };
        let room = x - rect.left() > 20.0 || ago == 0.0;
        if room {
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
}
