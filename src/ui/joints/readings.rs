//! What a joint measures, as numbers with small bars: angle, force, current, temperature. Moves nothing.

use crate::app::hand::Freshness;
use crate::app::settings::AngleUnit;
use crate::hand::Quantity;
use crate::ui::joints::newest::newest;
use crate::ui::joints::row::{READING, Row};
use crate::ui::kit::controls::Label;
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::text::main;
use crate::ui::theme;
use egui::{Color32, CornerRadius, Rect, Ui, pos2};

/// The end of the current's bar: the documented range of the register, mA.
const CURRENT_END: i16 = 2000;
/// The temperature's bar: from a cool room to what the register can say, with the marks of caution and of heat, °C.
const HEAT: (i16, i16) = (20, 100);
/// From here a drive is warm; the figure is ours, the manual has none.
const WARM: i16 = 60;
/// From here a drive is hot; see [`WARM`].
const HOT: i16 = 70;
/// Height of the bars.
const BAR: f32 = 2.0;
/// Places of the current and of the temperature in a reading, as shares of its width.
const CURRENT_PART: (f32, f32) = (0.18, 0.60);
const HEAT_PART: (f32, f32) = (0.68, 1.0);

impl Row {
    /// The angle as the hand says it and in degrees, or in percent.
    pub(crate) fn angle_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (left, right) = rect.split_left_right_at_x(rect.right() - theme::FIELD);
        self.angle_in_ui(ui, left, pane, AngleUnit::Raw);
        let other = match pane.state.settings.angle_unit {
            AngleUnit::Raw => AngleUnit::Degrees,
            chosen => chosen,
        };
        self.angle_in_ui(ui, right, pane, other);
    }

    /// Where room is short: the angle in the chosen unit, and the force.
    pub(crate) fn short_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (left, right) = rect.split_left_right_at_x(rect.right() - theme::FIELD);
        self.angle_in_ui(ui, left, pane, pane.state.settings.angle_unit);
        self.force_reading_ui(ui, right, pane);
    }

    fn angle_in_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>, unit: AngleUnit) {
        let palette = pane.look.palette;
        let (angle, freshness) = newest(pane, self.dof, pane.state.hand().sample.angle);
        let documented = angle.and_then(|angle| angle.documented());
        let text = match unit {
            AngleUnit::Raw => format::whole(angle.map(|angle| i64::from(angle.raw())), 4),
            AngleUnit::Percent => format::percent(documented),
            AngleUnit::Degrees => format::degrees(angle.and_then(|angle| angle.degrees(self.dof))),
        };
        let name = self.named(pane, main::NAME_ANGLE_ACTUAL);
        let (name, live) = match unit {
            AngleUnit::Raw if angle.is_some() && documented.is_none() => (name, palette.warn),
            AngleUnit::Raw => (name, palette.text),
            AngleUnit::Degrees | AngleUnit::Percent => (format!("{name} °"), palette.muted),
        };
        Label::new(&text, pane.look.value(freshness, live))
            .number()
            .right()
            .named(&name)
            .put(ui, rect);
    }

    pub(crate) fn force_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (force, freshness) = newest(pane, self.dof, pane.state.hand().sample.force);
        let odd = force.is_some_and(|force| force.documented().is_none());
        let live = if odd {
            pane.look.palette.warn
        } else {
            pane.look.palette.text
        };
        let text = format::with_unit(
            force.map(|force| i64::from(force.raw())),
            4,
            Quantity::Force.row().unit,
        );
        let name = self.named(pane, main::NAME_FORCE_ACTUAL);
        let label = Label::new(&text, pane.look.value(freshness, live))
            .number()
            .right();
        label.font(reading_font(rect)).named(&name).put(ui, rect);
    }

    /// Current and temperature, each with its bar.
    pub(crate) fn drive_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let palette = pane.look.palette;
        let (current, freshness) = newest(pane, self.dof, pane.state.hand().sample.current);
        let (heat, heat_freshness) = newest(pane, self.dof, pane.state.hand().sample.temperature);
        let odd = current.is_some_and(|current| current.documented().is_none())
            || heat.is_some_and(|heat| heat.documented().is_none());
        let live = if odd { palette.warn } else { palette.text };
        let both = if heat_freshness == Freshness::Live {
            freshness
        } else {
            heat_freshness
        };
        let milliamps = format::with_unit(
            current.map(|value| i64::from(value.raw())),
            4,
            Quantity::Current.row().unit,
        );
        let degrees = format::whole(heat.map(|heat| i64::from(heat.raw())), 3);
        let unit = if rect.width() < READING { "°" } else { " °C" };
        let text = format!("{milliamps} {degrees}{unit}");
        let name = self.named(pane, main::NAME_DRIVE);
        let label = Label::new(&text, pane.look.value(both, live))
            .number()
            .right();
        label.font(reading_font(rect)).named(&name).put(ui, rect);
        let current = current.and_then(|current| current.documented());
        let level = current.map(|current| share(current.saturating_abs(), (0, CURRENT_END)));
        let color = pane.look.value(freshness, self.color);
        bar(ui, pane, rect, CURRENT_PART, level, color);
        let heat = heat.and_then(|heat| heat.documented());
        let color = match heat {
            Some(heat) if i16::from(heat) >= HOT => palette.bad,
            Some(heat) if i16::from(heat) >= WARM => palette.warn,
            _ => palette.ok,
        };
        let level = heat.map(|heat| share(heat.into(), HEAT));
        bar(
            ui,
            pane,
            rect,
            HEAT_PART,
            level,
            pane.look.value(heat_freshness, color),
        );
    }
}

/// Where a value stands between two ends, 0..=1.
fn share(value: i16, (low, high): (i16, i16)) -> f32 {
    let part = f32::from(value.saturating_sub(low)) / f32::from((high - low).max(1));
    part.clamp(0.0, 1.0)
}

/// A thin bar below a number; an empty rail where the value is not known.
fn bar(ui: &Ui, pane: &Pane<'_>, rect: Rect, part: (f32, f32), level: Option<f32>, color: Color32) {
    let middle = rect.center().y + theme::BELOW_NUMBER;
    let x = |part: f32| rect.left() + rect.width() * part;
    let rail = Rect::from_min_max(pos2(x(part.0), middle), pos2(x(part.1), middle + BAR));
    let round = CornerRadius::same(1);
    ui.painter()
        .rect_filled(rail, round, pane.look.palette.edge);
    if let Some(level) = level {
        let filled = rail.with_max_x(rail.left() + rail.width() * level);
        ui.painter().rect_filled(filled, round, color);
    }
}

fn reading_font(rect: Rect) -> egui::FontId {
    if rect.width() < READING {
        theme::number_small()
    } else {
        theme::number()
    }
}
