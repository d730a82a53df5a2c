//! Measurements of a joint as numbers: angle, force, current, temperature. Moves nothing.

use crate::app::readings::Freshness;
use crate::app::settings::AngleUnit;
use crate::hand::Quantity;
use crate::hand::heat::{HOT, WARM};
use crate::ui::joints::row::{JointRow, READING};
use crate::ui::kit::{Label, Pane, format};
use crate::ui::text::main;
use crate::ui::theme;
use egui::{Rect, Ui};

/// Width of the second of two readings.
const DEGREES: f32 = theme::FIELD + theme::STEP;

impl JointRow {
    /// Draws the angle in raw units, and in degrees or percent.
    pub(crate) fn angle_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (left, right) = rect.split_left_right_at_x(rect.right() - DEGREES);
        self.angle_in_ui(ui, left, pane, AngleUnit::Raw);
        let other = match pane.state.settings.angle_unit {
            AngleUnit::Raw => AngleUnit::Degrees,
            chosen => chosen,
        };
        self.angle_in_ui(ui, right, pane, other);
    }

    /// For narrow rows: draws the angle in the chosen unit, and the force.
    pub(crate) fn short_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (left, right) = rect.split_left_right_at_x(rect.right() - DEGREES);
        self.angle_in_ui(ui, left, pane, pane.state.settings.angle_unit);
        self.force_reading_ui(ui, right, pane);
    }

    fn angle_in_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>, unit: AngleUnit) {
        let palette = pane.look.palette;
        let (angle, freshness) = pane.newest(self.dof, pane.hand().readings.sample.angle);
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
        let color = pane.look.value(freshness, live);
        number_ui(ui, rect, &name, Label::new(&text, color));
    }

    pub(crate) fn force_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let palette = pane.look.palette;
        let (force, freshness) = pane.newest(self.dof, pane.hand().readings.sample.force);
        let odd = force.is_some_and(|force| force.documented().is_none());
        let live = if odd { palette.warn } else { palette.text };
        let raw = force.map(|force| i64::from(force.raw()));
        let mut text = format::with_unit(raw, 4, Quantity::Force.row().unit);
        let per_g = pane.hand().newtons.per_g(self.dof);
        let newtons = force
            .zip(per_g)
            .map(|(force, per_g)| per_g * f64::from(force.raw()));
        // A narrow row has room for one unit, and a recording may be of another hand.
        let has_both = rect.width() >= READING && pane.recorded().is_none();
        if let Some(newtons) = newtons.filter(|_| has_both) {
            text = format!("{text} {newtons:>5.1} N");
        }
        let name = self.named(pane, main::NAME_FORCE_ACTUAL);
        let color = pane.look.value(freshness, live);
        number_ui(ui, rect, &name, Label::new(&text, color));
    }

    /// Draws current and temperature, in another colour if the drive is warm or hot.
    pub(crate) fn drive_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (look, palette) = (pane.look, pane.look.palette);
        let sample = &pane.hand().readings.sample;
        let (current, current_age) = pane.newest(self.dof, sample.current);
        let (heat, heat_age) = pane.newest(self.dof, sample.temperature);
        let raw = current.map(|current| i64::from(current.raw()));
        let milliamps = format::with_unit(raw, 4, Quantity::Current.row().unit);
        let degrees = format::whole(heat.map(|heat| i64::from(heat.raw())), 3);
        let unit = if rect.width() < READING { "°" } else { " °C" };
        let text = format!("{milliamps} {degrees}{unit}");
        let is_odd = current.is_some_and(|current| current.documented().is_none());
        let live = match heat.map(|heat| heat.documented()) {
            Some(Some(HOT..)) => palette.bad,
            Some(None | Some(WARM..)) => palette.warn,
            _ if is_odd => palette.warn,
            _ => palette.text,
        };
        let age = match heat_age {
            Freshness::Live => current_age,
            _ => heat_age,
        };
        let name = self.named(pane, main::NAME_DRIVE);
        number_ui(ui, rect, &name, Label::new(&text, look.value(age, live)));
    }
}

/// Draws a right-aligned reading.
fn number_ui(ui: &mut Ui, place: Rect, name: &str, reading: Label<'_>) {
    reading.named(name).number().right().put(ui, place);
}
