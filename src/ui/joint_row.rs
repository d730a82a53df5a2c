//! One joint's row: target over actual, threshold over force, speed, lamp, lock. Knows nothing of the other rows.

use crate::app::action::Action;
use crate::app::state::Freshness;
use crate::hand::{Angle, Dof, Force, PerDof, Speed, Status, Timed};
use crate::ui::controls::{self, Label, Lock, take_left, take_right};
use crate::ui::look::Pane;
use crate::ui::number::NumberField;
use crate::ui::text::{Text, main, words};
use crate::ui::track::{Actual, Track};
use crate::ui::{format, theme};
use egui::{Color32, CornerRadius, Id, Rect, Sense, Ui, WidgetInfo, pos2, vec2};

/// Rows at least this high show force and speed on lines of their own.
const ROOMY: f32 = 104.0;
/// Width of a number field.
const FIELD: f32 = 52.0;
/// Width of the readings at the right.
const READING: f32 = 112.0;
/// Speed and threshold from which impacts were measured far above the threshold (protocol, choices).
const IMPACT_SPEED: i16 = 250;
/// See [`IMPACT_SPEED`].
const IMPACT_FORCE: i16 = 250;

/// The newest value of one joint, and how fresh it is.
fn newest<T: Copy>(
    pane: &Pane<'_>,
    dof: Dof,
    group: Option<Timed<PerDof<T>>>,
) -> (Option<T>, Freshness) {
    let freshness = pane.freshness(group.map(|group| group.asked));
    (group.map(|group| group.value[dof]), freshness)
}

/// One joint's row, with its names made once.
pub(crate) struct Row {
    dof: Dof,
    name: &'static str,
    color: Color32,
}

impl Row {
    /// The row of a joint.
    pub(crate) fn new(dof: Dof, pane: &Pane<'_>) -> Self {
        Self {
            dof,
            name: pane.look.say(words::dof(dof)),
            color: pane.look.palette.dof[dof],
        }
    }

    fn named(&self, pane: &Pane<'_>, what: Text) -> String {
        format!("{} {}", self.name, pane.look.say(what))
    }

    fn id(&self, part: &'static str) -> Id {
        Id::unique(("joint", self.dof, part))
    }

    /// Draws it.
    pub(crate) fn ui(&self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let palette = pane.look.palette;
        let roomy = rect.height() >= ROOMY;
        let bar = Rect::from_min_max(
            pos2(rect.left(), rect.top() + theme::STEP),
            pos2(rect.left() + 3.0, rect.bottom() - theme::STEP),
        );
        ui.painter()
            .rect_filled(bar, CornerRadius::same(2), self.color);
        let inner = rect
            .with_min_x(rect.left() + 12.0)
            .shrink2(vec2(0.0, theme::STEP));
        if self.dof != Dof::Little {
            let stroke = egui::Stroke::new(1.0, palette.grid);
            ui.painter()
                .hline(rect.left()..=rect.right(), rect.top(), stroke);
        }
        let lines = if roomy { 4.0 } else { 3.0 };
        let height = inner.height() / lines;
        let line = |n: f32| {
            let top = inner.top() + n * height;
            Rect::from_min_max(pos2(inner.left(), top), pos2(inner.right(), top + height))
        };
        self.head_ui(ui, line(0.0), pane, roomy);
        self.angle_ui(ui, line(1.0), pane);
        if roomy {
            let mut force = line(2.0);
            let reading = take_right(&mut force, READING);
            self.force_reading_ui(ui, reading, pane);
            self.force_ui(ui, force, pane);
            let mut speed = line(3.0);
            let reading = take_right(&mut speed, READING);
            self.drive_reading_ui(ui, reading, pane);
            self.speed_ui(ui, speed, pane);
        } else {
            let mut left = line(2.0);
            let right = take_right(&mut left, (inner.width() - theme::GAP) / 2.0);
            self.force_ui(ui, left, pane);
            self.speed_ui(ui, right, pane);
        }
    }

    fn head_ui(&self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, roomy: bool) {
        let palette = pane.look.palette;
        let mut rest = rect;
        let name = take_left(&mut rest, 84.0);
        Label::new(self.name, palette.text).put(ui, name);
        self.lock_ui(ui, take_right(&mut rest, 20.0), pane);
        if !roomy {
            rest.max.x += theme::STEP;
            let drive = take_right(&mut rest, 78.0);
            self.drive_reading_ui(ui, drive, pane);
            rest.max.x += theme::STEP;
            let force = take_right(&mut rest, 40.0);
            self.force_reading_ui(ui, force, pane);
            rest.max.x += theme::STEP;
        }
        self.impact_ui(ui, &mut rest, pane);
        self.status_ui(ui, rest, pane);
    }

    fn status_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let palette = look.palette;
        let (status, freshness) = newest(pane, self.dof, pane.state.sample.status);
        let fault = newest(pane, self.dof, pane.state.sample.faults).0;
        let fault = fault.and_then(|faults| faults.iter().next());
        let live = match (fault, status) {
            (Some(_), _) => palette.bad,
            (None, Some(status)) if status.is_protective() => palette.bad,
            (None, Some(Status::Releasing | Status::Grasping)) => palette.accent,
            (None, Some(Status::ForceReached)) => palette.warn,
            (None, Some(Status::PositionReached)) => palette.ok,
            (None, _) => palette.faint,
        };
        let words = match (fault, status) {
            (Some(fault), _) => Some(words::fault(fault, look.language)),
            (None, Some(status)) => Some(words::status(status, look.language)),
            (None, None) => None,
        };
        let color = look.value(freshness, live);
        controls::lamp(ui, pos2(rect.left() + 6.0, rect.center().y), color);
        let place = rect.with_min_x(rect.left() + 17.0);
        let mut title = words
            .map_or(format::UNKNOWN, |words| words.title)
            .to_owned();
        if let (None, Some(Status::Unknown(code))) = (fault, status) {
            title = format!("{title} ({code})");
        }
        let text_color = if live == palette.bad {
            color
        } else {
            look.value(freshness, palette.muted)
        };
        let name = self.named(pane, main::STATUS);
        let label = Label::new(&title, text_color)
            .small()
            .named(&name)
            .put(ui, place);
        if let Some(words) = words {
            label.on_hover_text(format!("{}\n{}", words.cause, words.advice));
        }
    }

    fn impact_ui(&self, ui: &mut Ui, rest: &mut Rect, pane: &Pane<'_>) {
        let joint = pane.state.joints[self.dof];
        if joint.speed.get() < IMPACT_SPEED || joint.force.get() < IMPACT_FORCE {
            return;
        }
        let place = take_right(rest, 16.0);
        let sign = controls::middle(place, 12.0).shrink2(vec2(1.0, 0.0));
        controls::warning_sign(ui, sign, pane.look.palette.warn);
        let name = self.named(pane, main::NAME_IMPACT);
        let response = ui.interact(place, self.id("impact"), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, &name));
        response.on_hover_text(pane.look.say(main::IMPACT_TIP));
    }

    fn lock_ui(&self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let locked = pane.state.joints[self.dof].locked;
        let place = controls::middle(rect, 20.0);
        let response = ui.interact(place, self.id("lock"), Sense::click());
        let name = self.named(pane, main::NAME_LOCK);
        response.widget_info(|| WidgetInfo::selected(egui::Role::CheckBox, true, locked, &name));
        let (kind, color) = match (locked, response.hovered()) {
            (true, _) => (Lock::Closed, look.palette.warn),
            (false, true) => (Lock::Open, look.palette.text),
            (false, false) => (Lock::Open, look.palette.faint),
        };
        controls::padlock(ui, place, color, kind);
        controls::focus_ring(ui, look, &response, place);
        if response.clicked() {
            pane.actions.push(Action::Lock(self.dof, !locked));
        }
        response
            .on_hover_text(look.say(main::LOCK_TIP))
            .on_hover_cursor(egui::CursorIcon::PointingHand);
    }

    fn caption(&self, ui: &mut Ui, line: &mut Rect, pane: &Pane<'_>, what: Text) {
        let place = take_left(line, 36.0);
        Label::new(pane.look.say(what), pane.look.palette.muted)
            .small()
            .put(ui, place);
    }

    fn angle_ui(&self, ui: &mut Ui, mut line: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        self.caption(ui, &mut line, pane, main::ANGLE);
        let reading = take_right(&mut line, READING);
        self.angle_reading_ui(ui, reading, pane);
        let field = controls::middle(take_right(&mut line, FIELD), theme::CONTROL);
        let joint = pane.state.joints[self.dof];
        let disabled = if !pane.state.is_armed() {
            Some(look.say(main::NOT_ARMED))
        } else {
            joint.locked.then(|| look.say(main::LOCKED))
        };
        let (angle, freshness) = newest(pane, self.dof, pane.state.sample.angle);
        let track = Track {
            name: &self.named(pane, main::NAME_ANGLE_TARGET),
            tip: look.say(main::ANGLE_TIP),
            disabled,
            max: 1000,
            step: 10,
            target: joint.target.map(Angle::get),
            actual: angle.and_then(|angle| angle.hold()).map(Angle::get),
            draws: Actual::Marker,
            color: look.value(freshness, self.color),
            tick: None,
        };
        let moved = track.put(ui, look, line, self.id("angle"));
        let field_ui = NumberField {
            name: &self.named(pane, main::NAME_ANGLE_NUMBER),
            tip: look.say(main::NUMBER_TIP),
            disabled,
            value: joint.target.map(Angle::get),
            range: 0..=1000,
        };
        let typed = field_ui.put(ui, look, pane.typing, field, self.id("angle number"));
        if let Some(value) = typed.or(moved) {
            pane.actions
                .push(Action::Target(self.dof, Angle::nearest(value)));
        }
    }

    fn angle_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (angle, freshness) = newest(pane, self.dof, pane.state.sample.angle);
        let raw = format::whole(angle.map(|angle| i64::from(angle.raw())), 4);
        let degrees = format::degrees(angle.and_then(|angle| angle.degrees(self.dof)));
        let odd = angle.is_some_and(|angle| angle.documented().is_none());
        let live = if odd {
            pane.look.palette.warn
        } else {
            pane.look.palette.text
        };
        let name = self.named(pane, main::NAME_ANGLE_ACTUAL);
        let (left, right) = rect.split_left_right_at_x(rect.right() - 52.0);
        Label::new(&raw, pane.look.value(freshness, live))
            .number()
            .right()
            .named(&name)
            .put(ui, left);
        let degrees_name = format!("{name} °");
        Label::new(
            &degrees,
            pane.look.value(freshness, pane.look.palette.muted),
        )
        .number()
        .right()
        .named(&degrees_name)
        .put(ui, right);
    }

    fn force_ui(&self, ui: &mut Ui, mut line: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        self.caption(ui, &mut line, pane, main::FORCE);
        let field = controls::middle(take_right(&mut line, FIELD), theme::CONTROL);
        let threshold = pane.state.joints[self.dof].force;
        let (force, freshness) = newest(pane, self.dof, pane.state.sample.force);
        let force = force.and_then(|force| force.documented());
        let over = force.is_some_and(|force| force >= threshold.get());
        let live = if over { look.palette.warn } else { self.color };
        let track = Track {
            name: &self.named(pane, main::NAME_FORCE_THRESHOLD),
            tip: &self.staged(pane, main::FORCE_TIP),
            disabled: None,
            max: 3000,
            step: 10,
            target: Some(threshold.get()),
            actual: force,
            draws: Actual::Bar,
            color: look.value(freshness, live),
            tick: Some(Force::RATED.get()),
        };
        let moved = track.put(ui, look, line, self.id("force"));
        let field_ui = NumberField {
            name: &self.named(pane, main::NAME_FORCE_NUMBER),
            tip: look.say(main::NUMBER_TIP),
            disabled: None,
            value: Some(threshold.get()),
            range: 0..=3000,
        };
        let typed = field_ui.put(ui, look, pane.typing, field, self.id("force number"));
        if let Some(value) = typed.or(moved) {
            pane.actions
                .push(Action::Force(self.dof, Force::nearest(value)));
        }
    }

    fn force_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (force, freshness) = newest(pane, self.dof, pane.state.sample.force);
        let odd = force.is_some_and(|force| force.documented().is_none());
        let live = if odd {
            pane.look.palette.warn
        } else {
            pane.look.palette.text
        };
        let text = format::with_unit(force.map(|force| i64::from(force.raw())), 4, "g");
        let name = self.named(pane, main::NAME_FORCE_ACTUAL);
        let label = Label::new(&text, pane.look.value(freshness, live))
            .number()
            .right();
        label.font(reading_font(rect)).named(&name).put(ui, rect);
    }

    fn drive_reading_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let (current, freshness) = newest(pane, self.dof, pane.state.sample.current);
        let (heat, heat_freshness) = newest(pane, self.dof, pane.state.sample.temperature);
        let odd = current.is_some_and(|current| current.documented().is_none())
            || heat.is_some_and(|heat| heat.documented().is_none());
        let live = if odd {
            pane.look.palette.warn
        } else {
            pane.look.palette.text
        };
        let both = if heat_freshness == Freshness::Live {
            freshness
        } else {
            heat_freshness
        };
        let current = format::with_unit(current.map(|value| i64::from(value.raw())), 4, "mA");
        let heat = format::whole(heat.map(|heat| i64::from(heat.raw())), 3);
        let unit = if rect.width() < READING { "°" } else { " °C" };
        let text = format!("{current} {heat}{unit}");
        let name = self.named(pane, main::NAME_DRIVE);
        let label = Label::new(&text, pane.look.value(both, live))
            .number()
            .right();
        label.font(reading_font(rect)).named(&name).put(ui, rect);
    }

    fn speed_ui(&self, ui: &mut Ui, mut line: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        self.caption(ui, &mut line, pane, main::SPEED);
        let field = controls::middle(take_right(&mut line, FIELD), theme::CONTROL);
        let speed = pane.state.joints[self.dof].speed.get();
        let track = Track {
            name: &self.named(pane, main::NAME_SPEED),
            tip: &self.staged(pane, main::SPEED_TIP),
            disabled: None,
            max: 1000,
            step: 10,
            target: Some(speed),
            actual: Some(speed),
            draws: Actual::Bar,
            color: look.palette.faint,
            tick: Some(IMPACT_SPEED),
        };
        let moved = track.put(ui, look, line, self.id("speed"));
        let field_ui = NumberField {
            name: &self.named(pane, main::NAME_SPEED_NUMBER),
            tip: look.say(main::NUMBER_TIP),
            disabled: None,
            value: Some(speed),
            range: 0..=1000,
        };
        let typed = field_ui.put(ui, look, pane.typing, field, self.id("speed number"));
        if let Some(value) = typed.or(moved) {
            pane.actions
                .push(Action::Speed(self.dof, Speed::nearest(value)));
        }
    }

    fn staged(&self, pane: &Pane<'_>, tip: Text) -> String {
        let tip = pane.look.say(tip);
        if pane.state.is_armed() {
            return tip.into();
        }
        format!("{tip}\n{}", pane.look.say(main::STAGED))
    }
}

fn reading_font(rect: Rect) -> egui::FontId {
    if rect.width() < READING {
        theme::number_small()
    } else {
        theme::number()
    }
}
