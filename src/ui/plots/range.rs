//! The value scale of each plot: by itself, or as a person set it by dragging, by the wheel or by typing its ends.

use crate::app::settings::PlotKind;
use crate::ui::kit::controls;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::kit::number::NumberField;
use crate::ui::plots::axes as plot_axes;
use crate::ui::plots::axes::{Band, NUMBERS_COUNTS};
use crate::ui::plots::plot_rows::Panel;
use crate::ui::text::plots;
use crate::ui::theme;
use egui::{
    CursorIcon, Id, Popup, PopupCloseBehavior, Rect, Response, Role, Sense, Ui, WidgetInfo,
};
use std::collections::BTreeMap;

/// No end lies beyond: far more than a hand can measure, and still a number of seven digits.
const MOST: f64 = 100_000.0;
/// The narrowest scale: a hundredth of what the finest plot tells.
const NARROWEST: f64 = 0.01;
/// Size of a field for an end.
const FIELD: egui::Vec2 = theme::RANGE_FIELD;

/// The scales that a person chose; others follow their values.
#[derive(Debug, Default)]
pub(crate) struct Ranges(BTreeMap<PlotKind, (f64, f64)>);

impl Ranges {
    /// True if a person chose this plot's scale.
    pub(crate) fn is_chosen(&self, kind: PlotKind) -> bool {
        self.0.contains_key(&kind)
    }

    /// The scale of a plot that would by itself span `auto`.
    pub(crate) fn band(&self, panel: &Panel, auto: Band, room: f32) -> Band {
        match self.0.get(&panel.kind) {
            Some((low, high)) => Band {
                low: *low,
                high: *high,
                step: round_step(
                    (high - low) / f64::from(room.clamp(NUMBERS_COUNTS.0, NUMBERS_COUNTS.1) - 1.0),
                ),
            },
            None => auto.rounded(panel.row.scale_steps, room),
        }
    }

    /// The numbers beside a plot, and what is done with them.
    pub(crate) fn axis_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &mut Pane<'_>,
        panel: &Panel,
        band: Band,
    ) {
        let look = pane.look;
        let id = Id::unique(("value scale", panel.kind));
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let name = named(look, panel, look.say(plots::RANGE));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        controls::focus_ring(ui, look, &response, rect);
        let color = match (self.is_chosen(panel.kind), response.hovered()) {
            (true, _) => look.palette.accent,
            (false, true) => look.palette.text,
            (false, false) => look.palette.faint,
        };
        plot_axes::numbers_ui(ui, rect, &band, color);
        self.act(ui, &response, panel.kind, band);
        let popup = Popup::from_toggle_button_response(&response);
        popup
            .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
            .show(|ui| self.ends_ui(ui, pane, panel, band));
        response
            .on_hover_text(look.say(plots::RANGE_TIP))
            .on_hover_cursor(CursorIcon::ResizeVertical);
    }

    /// Drag moves, the wheel zooms around the pointer, a double click goes back to automatic.
    fn act(&mut self, ui: &Ui, response: &Response, kind: PlotKind, band: Band) {
        let rect = response.rect;
        let per_point = (band.high - band.low) / f64::from(rect.height().max(1.0));
        if response.double_clicked() {
            self.0.remove(&kind);
            Popup::close_all(ui.ctx());
        } else if response.dragged() {
            let by = f64::from(response.drag_delta().y) * per_point;
            if by != 0.0 {
                self.choose(kind, band.low + by, band.high + by);
            }
        } else if let Some(at) = response.hover_pos() {
            let scroll = ui.input(|input| input.smooth_scroll_delta.y);
            if scroll != 0.0 {
                let factor = f64::from(-scroll / theme::PLOT_WHEEL).exp2();
                let value = band.low + f64::from(rect.bottom() - at.y) * per_point;
                let end = |end: f64| value + (end - value) * factor;
                self.choose(kind, end(band.low), end(band.high));
            }
        }
    }

    /// The ends as fields.
    fn ends_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, panel: &Panel, band: Band) {
        let look = pane.look;
        ui.label(look.say(panel.title));
        for (text, value, is_high) in [
            (plots::RANGE_HIGH, band.high, true),
            (plots::RANGE_LOW, band.low, false),
        ] {
            ui.horizontal(|ui| {
                let place = ui.allocate_exact_size(FIELD, Sense::hover()).0;
                let name = named(look, panel, look.say(text));
                let field = NumberField {
                    name: &name,
                    tip: look.say(plots::RANGE_END_TIP),
                    disabled: None,
                    value: Some(value),
                    range: -MOST..=MOST,
                    decimals: panel.row.decimals.max(1),
                };
                let id = Id::unique(("end of scale", panel.kind, is_high));
                if let Some(typed) = field.put(ui, look, pane.typing, place, id) {
                    let width = band.high - band.low;
                    if is_high {
                        // An end that passes the other one takes it along.
                        let low = if typed > band.low {
                            band.low
                        } else {
                            typed - width
                        };
                        self.choose(panel.kind, low, typed);
                    } else {
                        let high = if typed < band.high {
                            band.high
                        } else {
                            typed + width
                        };
                        self.choose(panel.kind, typed, high);
                    }
                }
                ui.label(look.say(text));
            });
        }
        let automatic = ui.button(look.say(plots::RANGE_AUTO));
        if automatic
            .on_hover_text(look.say(plots::RANGE_AUTO_TIP))
            .clicked()
        {
            self.0.remove(&panel.kind);
            Popup::close_all(ui.ctx());
        }
    }

    fn choose(&mut self, kind: PlotKind, low: f64, high: f64) {
        let low = low.clamp(-MOST, MOST - NARROWEST);
        let high = high.clamp(low + NARROWEST, MOST);
        self.0.insert(kind, (low, high));
    }
}

fn named(look: Look, panel: &Panel, what: &str) -> String {
    format!("{what}: {}", look.say(panel.title))
}

/// The next 1, 2 or 5 times a power of ten.
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.max(NARROWEST / 10.0).log10().floor());
    let fits = |times: &f64| times * power >= least * (1.0 - 1e-9);
    [1.0, 2.0, 5.0].into_iter().find(fits).unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::plots::axes::Extent;
    use crate::ui::plots::plot_rows::PANELS;

    #[test]
    fn steps_are_round() {
        for (least, step) in [(0.03, 0.05), (1.0, 1.0), (1.01, 2.0), (70.0, 100.0)] {
            assert!((round_step(least) - step).abs() < 1e-9, "{least}");
        }
    }

    #[test]
    fn a_chosen_scale_stays_as_it_is_and_has_few_lines() {
        let [panel, ..] = &PANELS;
        let mut ranges = Ranges::default();
        let auto = Band::of(panel.row.least_scale, &Extent::default());
        for (low, high) in [(17.0, 23.5), (-4000.0, 4000.0), (-0.02, 0.02), (5.0, 5.0)] {
            ranges.choose(panel.kind, low, high);
            let band = ranges.band(panel, auto, 5.0);
            assert!((band.low - low).abs() < 1e-9 && band.high >= high && band.high > band.low);
            assert!(band.lines().count() <= 6, "{band:?}");
        }
        ranges.choose(panel.kind, 1e12, -1e12);
        let band = ranges.band(panel, auto, 5.0);
        assert!(band.high <= MOST && band.low < band.high, "{band:?}");
    }
}
