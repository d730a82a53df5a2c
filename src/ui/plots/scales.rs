//! Value scales: rounded automatically, or set by the user with a drag or the wheel.

use crate::ui::kit::Look;
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::{CursorIcon, Response, Role, Ui, WidgetInfo};
use std::collections::BTreeMap;

/// Limit of both ends: more than the counts of a fingertip.
const MOST: f64 = 10_000_000.0;
/// The narrowest scale: a hundredth of the finest plot's resolution.
const NARROWEST: f64 = 0.01;
/// Points between two grid lines that `egui_plot` passes to its spacers as one step.
const BASE_PX: f64 = 8.0;
/// Points between two time labels.
const TIME_PX: f64 = 60.0;
/// Time for which the values must fit a narrower scale before the scale narrows.
const ROOMY_S: f64 = 2.0;
/// Duration of the transition to new ends.
const EASE_S: f32 = 0.12;
/// Time steps above a second, where decimal steps do not fit.
const LONG_STEPS: [f64; 8] = [10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0];

/// Rounds up to the next 1, 2 or 5 times a power of ten.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.max(NARROWEST / 10.0).log10().floor());
    let fits = |times: &f64| times * power >= least * (1.0 - 1e-9);
    [1.0, 2.0, 5.0].into_iter().find(fits).unwrap_or(10.0) * power
}

/// Seconds between two grid lines, from the seconds that eight points span.
pub(crate) fn time_step(base_s: f64) -> f64 {
    let least = base_s * TIME_PX / BASE_PX;
    let long = LONG_STEPS.into_iter().find(|step| *step >= least);
    if least <= 5.0 {
        round_step(least)
    } else {
        long.unwrap_or(3600.0)
    }
}

/// Distance of two grid lines of a scale, from the value that eight points span.
pub(crate) fn step((low, high): (f64, f64), base: f64) -> f64 {
    let room = (high - low) / base * BASE_PX / f64::from(theme::PLOT_NUMBER);
    round_step((high - low) / (room - 1.0).clamp(1.0, 4.0))
}

/// Union of the always visible range and the values' range, rounded outwards for a chart of this height.
pub(crate) fn rounded(least: (f64, f64), extent: Option<(f64, f64)>, height: f32) -> (f64, f64) {
    let (low, high) = extent.unwrap_or(least);
    let (low, high) = (low.min(least.0), high.max(least.1));
    let base = (high - low) / f64::from(height.max(1.0)) * BASE_PX;
    let step = step((low, high), base);
    // Ends at half a step, so that little of the plot is empty.
    let half = step / 2.0;
    // A value slightly below zero must not cost a quarter of the plot.
    let low = if low < 0.0 && low > -step * 0.2 {
        -step * 0.2
    } else {
        (low / half).floor() * half
    };
    (low, (high / half).ceil() * half)
}

/// Union of two ranges.
pub(crate) fn joined(one: Option<(f64, f64)>, (low, high): (f64, f64)) -> Option<(f64, f64)> {
    let (from, to) = one.unwrap_or((low, high));
    Some((from.min(low), to.max(high)))
}

/// Decimals that distinguish numbers one step apart.
pub(crate) fn digits(step: f64) -> usize {
    let digits = [1.0, 0.1, 0.01].iter();
    digits
        .take_while(|least| step < **least * (1.0 - 1e-9))
        .count()
}

/// Formats a number of a scale with the decimals that its step needs.
pub(crate) fn number(value: f64, step: f64) -> String {
    if step >= 10_000.0 && value != 0.0 {
        return format!("{}k", value / 1000.0);
    }
    let digits = digits(step);
    // Avoids "-0".
    format!("{:.digits$}", value + 0.0)
}

/// Current ends of a scale on their way to `aim`; `aim` at once if animations are off.
pub(crate) fn eased(ui: &Ui, title: Text, aim: (f64, f64)) -> (f64, f64) {
    if ui.style().animation_time <= 0.0 {
        return aim;
    }
    let id = ui.scope_id().with(title.en);
    let end = |name: &str, aim: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "shown for a tenth of a second"
        )]
        let near = aim as f32;
        let moved = ui
            .ctx()
            .animate_value_with_time(id.with(name), near, EASE_S);
        if moved == near { aim } else { f64::from(moved) }
    };
    (end("low", aim.0), end("high", aim.1))
}

/// Ends of a scale that follows its values, and the time in seconds since when a narrower one would do.
#[derive(Debug)]
struct SettledScale {
    ends: (f64, f64),
    roomy_since: Option<f64>,
}

/// The numbers beside a plot.
pub(crate) struct ScaleAxis<'a> {
    pub(crate) title: Text,
    pub(crate) ends: (f64, f64),
    pub(crate) response: &'a Response,
}

/// Scales set by the user; the others follow their values.
#[derive(Debug, Default)]
pub(crate) struct Scales {
    chosen: BTreeMap<&'static str, (f64, f64)>,
    settled: BTreeMap<&'static str, SettledScale>,
}

impl Scales {
    /// Ends set by the user; `None` if the scale follows its values.
    pub(crate) fn chosen(&self, title: Text) -> Option<(f64, f64)> {
        self.chosen.get(title.en).copied()
    }

    /// Ends of a scale that follows its values: it widens at once and narrows after [`ROOMY_S`]; without a time, at once as well.
    pub(crate) fn settled(
        &mut self,
        title: Text,
        wanted: (f64, f64),
        at_s: Option<f64>,
    ) -> (f64, f64) {
        let own = self.settled.entry(title.en).or_insert(SettledScale {
            ends: wanted,
            roomy_since: None,
        });
        let holds = own.ends.0 <= wanted.0 && wanted.1 <= own.ends.1;
        let Some(at_s) = at_s.filter(|_| own.ends != wanted) else {
            (own.ends, own.roomy_since) = (wanted, None);
            return wanted;
        };
        if !holds {
            own.ends = (own.ends.0.min(wanted.0), own.ends.1.max(wanted.1));
            own.roomy_since = None;
        } else if at_s - *own.roomy_since.get_or_insert(at_s) >= ROOMY_S {
            (own.ends, own.roomy_since) = (wanted, None);
        }
        own.ends
    }

    /// Sets the ends, limited to ±[`MOST`].
    pub(crate) fn choose(&mut self, title: Text, low: f64, high: f64) {
        let low = low.clamp(-MOST, MOST - NARROWEST);
        self.chosen
            .insert(title.en, (low, high.clamp(low + NARROWEST, MOST)));
    }

    /// Follows the values again.
    pub(crate) fn forget(&mut self, title: Text) {
        self.chosen.remove(title.en);
    }

    /// Handles input on the numbers beside a plot: drag pans, wheel zooms around the pointer, double click fits the values again.
    pub(crate) fn axis_ui(&mut self, ui: &Ui, look: Look, axis: &ScaleAxis<'_>) {
        let ScaleAxis {
            title,
            ends: (low, high),
            response,
        } = *axis;
        let per_point = (high - low) / f64::from(response.rect.height().max(1.0));
        let scroll = ui.input(|input| input.smooth_scroll_delta.y);
        if response.double_clicked() {
            self.forget(title);
        } else if response.dragged() && response.drag_delta().y != 0.0 {
            let by = f64::from(response.drag_delta().y) * per_point;
            self.choose(title, low + by, high + by);
        } else if let Some(at) = response.hover_pos().filter(|_| scroll != 0.0) {
            let factor = f64::from(-scroll / theme::PLOT_WHEEL).exp2();
            let value = low + f64::from(response.rect.bottom() - at.y) * per_point;
            let end = |end: f64| value + (end - value) * factor;
            self.choose(title, end(low), end(high));
        }
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
        }
        let name = look.pair(look.tr(panels::RANGE), look.tr(title));
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_value(format!("{low} to {high}"));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        for (least, step) in [(0.03, 0.05), (1.0, 1.0), (1.01, 2.0), (70.0, 100.0)] {
            assert!((round_step(least) - step).abs() < 1e-9, "{least}");
        }
        for (base_s, step_s) in [
            (0.0001, 0.001),
            (0.1, 1.0),
            (1.0, 10.0),
            (5.0, 60.0),
            (90.0, 1800.0),
        ] {
            assert!((time_step(base_s) - step_s).abs() < 1e-9, "{base_s}");
        }
    }

    #[test]
    fn a_scale_always_holds_its_numbers_and_has_few_lines() {
        for (low, high) in [
            (0.0, 3.0),
            (-33.0, 812.0),
            (-4000.0, 4000.0),
            (0.0, 32_767.0),
        ] {
            let band = rounded((0.0, 200.0), Some((low, high)), 110.0);
            assert!(band.0 <= low.min(0.0) && band.1 >= high, "{band:?}");
            let lines = (band.1 - band.0) / step(band, (band.1 - band.0) / 110.0 * BASE_PX);
            assert!((1.0..=5.0).contains(&lines), "{band:?} {lines}");
        }
        assert_eq!(rounded((0.0, 200.0), None, 110.0), (0.0, 200.0));
    }

    #[test]
    fn a_chosen_scale_stays_as_it_is_and_within_bounds() {
        let mut scales = Scales::default();
        for (low, high) in [(17.0, 23.5), (-4000.0, 4000.0), (-0.02, 0.02), (5.0, 5.0)] {
            scales.choose(panels::NORMAL, low, high);
            let (chosen, above) = scales.chosen(panels::NORMAL).unwrap_or_default();
            assert!((chosen - low).abs() < 1e-9 && above >= high && above > chosen);
        }
        scales.choose(panels::NORMAL, 1e12, -1e12);
        let (low, high) = scales.chosen(panels::NORMAL).unwrap_or_default();
        assert!(high <= MOST && low < high);
        assert_eq!(scales.chosen(panels::TANGENTIAL), None);
    }

    #[test]
    fn a_scale_grows_at_once_and_shrinks_only_after_a_while() {
        let mut scales = Scales::default();
        let mut settled = |wanted, at_s| scales.settled(panels::PLOT_FORCE, wanted, at_s);
        assert_eq!(settled((0.0, 200.0), Some(0.0)), (0.0, 200.0));
        assert_eq!(settled((0.0, 1000.0), Some(0.1)), (0.0, 1000.0));
        assert_eq!(settled((-100.0, 200.0), Some(0.2)), (-100.0, 1000.0));
        assert_eq!(settled((0.0, 200.0), Some(1.0)), (-100.0, 1000.0));
        // It is full again: the waiting time restarts.
        assert_eq!(settled((-100.0, 1000.0), Some(2.9)), (-100.0, 1000.0));
        assert_eq!(settled((0.0, 500.0), Some(3.0)), (-100.0, 1000.0));
        assert_eq!(settled((0.0, 200.0), Some(4.9)), (-100.0, 1000.0));
        assert_eq!(settled((0.0, 200.0), Some(5.1)), (0.0, 200.0));
        // A user who views past data sees it fitted at once.
        settled((0.0, 1000.0), Some(6.0));
        assert_eq!(settled((0.0, 300.0), None), (0.0, 300.0));
    }

    #[test]
    fn numbers_have_the_digits_that_their_steps_need() {
        for (value, step, text) in [
            (0.5, 0.5, "0.5"),
            (-0.0, 1.0, "0"),
            (1500.0, 500.0, "1500"),
            (-20_000.0, 10_000.0, "-20k"),
            (0.0, 10_000.0, "0"),
        ] {
            assert_eq!(number(value, step), text);
        }
    }
}
