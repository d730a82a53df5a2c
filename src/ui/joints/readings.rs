//! What a joint measures, as numbers with small bars: angle, force, current, temperature. Moves nothing.

use crate::app::hand::Freshness;
use crate::app::settings::AngleUnit;
use crate::hand::Quantity;
use crate::ui::joints::row::{JointRow, READING};
use crate::ui::kit::{Label, Pane, format};
use crate::ui::text::main;
use crate::ui::theme;
use egui::{Color32, Rect, Ui, pos2};

/// The end of the current's bar: the documented range of the register, mA.
const CURRENT_END: i16 = 2000;
/// The temperature's bar: from a cool room to what the register can say, °C.
const HEAT: (i16, i16) = (20, 100);
/// From here a drive is warm; the figure is ours, the manual has none.
const WARM: u8 = 60;
/// From here a drive is hot; see [`WARM`].
const HOT: u8 = 70;

impl JointRow {
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
        let (angle, freshness) = pane.newest(self.dof, pane.state.hand().sample.angle);
        let documented = angle.and_then(|angle| angle.documented());
        let text = match unit {
            AngleUnit::Raw => format::whole(angle.map(|angle| i64::from(angle.raw())), 4),
            AngleUnit::Percent => format::percent(documented),
            AngleUnit::Degrees => format::degrees(angle.and_then(|angle| angle.degrees(self.dof))),
        };
        let name = self.named(pane, main::NAME_ANGLE_ACTUAL);
        let odd = angle.is_some() && documented.is_none();
        let (name, live) = match unit {
            AngleUnit::Raw => (name, if odd { palette.warn } else { palette.text }),
            AngleUnit::Degrees | AngleUnit::Percent => (format!("{name} °"), palette.muted),
        };
        let label = Label::new(&text, pane.look.value(freshness, live)).named(&name);
        label.number().right().put(ui, rect);
    }

    pub(crate) fn force_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let palette = pane.look.palette;
        let (force, freshness) = pane.newest(self.dof, pane.state.hand().sample.force);
        let odd = force.is_some_and(|force| force.documented().is_none());
        let live = if odd { palette.warn } else { palette.text };
        let raw = force.map(|force| i64::from(force.raw()));
        let text = format::with_unit(raw, 4, Quantity::Force.row().unit);
        let name = self.named(pane, main::NAME_FORCE_ACTUAL);
        let label = Label::new(&text, pane.look.value(freshness, live)).named(&name);
        label.number().right().put(ui, rect);
    }

    /// Current and temperature, each with its bar.
    pub(crate) fn drive_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (look, palette) = (pane.look, pane.look.palette);
        let (current, current_age) = pane.newest(self.dof, pane.state.hand().sample.current);
        let (heat, heat_age) = pane.newest(self.dof, pane.state.hand().sample.temperature);
        let raw = current.map(|current| i64::from(current.raw()));
        let milliamps = format::with_unit(raw, 4, Quantity::Current.row().unit);
        let degrees = format::whole(heat.map(|heat| i64::from(heat.raw())), 3);
        let unit = if rect.width() < READING { "°" } else { " °C" };
        let text = format!("{milliamps} {degrees}{unit}");
        let is_odd = current.is_some_and(|current| current.documented().is_none())
            || heat.is_some_and(|heat| heat.documented().is_none());
        let live = if is_odd { palette.warn } else { palette.text };
        let age = match heat_age {
            Freshness::Live => current_age,
            _ => heat_age,
        };
        let name = self.named(pane, main::NAME_DRIVE);
        let label = Label::new(&text, look.value(age, live)).named(&name);
        label.number().right().put(ui, rect);
        let current = current.and_then(|current| current.documented());
        let level = current.map(|current| share(current.saturating_abs(), (0, CURRENT_END)));
        let color = look.value(current_age, self.color);
        bar(ui, part(rect, 0.18, 0.60), level, color);
        let heat = heat.and_then(|heat| heat.documented());
        let color = match heat {
            Some(HOT..) => palette.bad,
            Some(WARM..) => palette.warn,
            _ => palette.ok,
        };
        let level = heat.map(|heat| share(heat.into(), HEAT));
        bar(
            ui,
            part(rect, 0.68, 1.0),
            level,
            look.value(heat_age, color),
        );
    }
}

/// Where a value stands between two ends, 0..=1.
fn share(value: i16, (low, high): (i16, i16)) -> f32 {
    (f32::from(value - low) / f32::from(high - low)).clamp(0.0, 1.0)
}

/// The place of a bar below a part of a number, in shares of its width.
fn part(rect: Rect, from: f32, to: f32) -> Rect {
    let x = |part: f32| rect.left() + rect.width() * part;
    let top = rect.center().y + 8.0;
    Rect::from_min_max(pos2(x(from), top), pos2(x(to), top + 2.0))
}

/// A thin bar; an empty one where the value is not known.
fn bar(ui: &Ui, rail: Rect, level: Option<f32>, color: Color32) {
    let ground = ui.visuals().window_stroke.color;
    ui.painter().rect_filled(rail, 1.0, ground);
    if let Some(level) = level {
        let filled = rail.with_max_x(rail.left() + rail.width() * level);
        ui.painter().rect_filled(filled, 1.0, color);
    }
}
