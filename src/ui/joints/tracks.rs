//! What a person sets of a joint: target angle, force threshold, speed, and the last two for all joints at once.

use crate::app::action::Action;
use crate::app::settings::AngleUnit;
use crate::hand::{Angle, Dof, Force, HandCommand, PerDof, Speed, Target, impact};
use crate::ui::joints::frame_menu::frame_menu_ui;
use crate::ui::joints::newest::newest;
use crate::ui::joints::row::Row;
use crate::ui::joints::track::{Actual, Track};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, take_left, take_right};
use crate::ui::kit::look::Pane;
use crate::ui::kit::number::NumberField;
use crate::ui::text::{Text, main, tune};
use crate::ui::theme;
use egui::{Color32, Id, Rect, Ui};
use std::ops::RangeInclusive;

/// Width of a number field.
const FIELD: f32 = theme::FIELD;
/// Width of a caption.
const CAPTION: f32 = theme::CAPTION;
/// Fingers that move together when they are linked. The thumb is apart: its way is another.
const LINKED: [Dof; 4] = [Dof::Little, Dof::Ring, Dof::Middle, Dof::Index];

/// A track with its caption and number field: force threshold or speed.
struct Setting<'a> {
    caption: Text,
    name: &'a str,
    number_name: &'a str,
    tip: &'a str,
    max: i16,
    /// What is set; none where joints differ.
    value: Option<i16>,
    actual: Option<i16>,
    color: Color32,
    tick: Option<i16>,
    rough_from: Option<i16>,
    peak: Option<i16>,
    ids: (Id, Id),
    /// What the control sends as it stands.
    command: Option<HandCommand>,
}

impl Setting<'_> {
    /// Draws it. What the person set in this frame.
    fn ui(&self, ui: &mut Ui, mut line: Rect, pane: &mut Pane<'_>) -> Option<i16> {
        let look = pane.look;
        // Each trial sets its own: what a person set is not in force.
        let runs = pane.state.hand().runs_series();
        let disabled = runs.then(|| look.say(tune::RUNS));
        let value = self.value.filter(|_| !runs);
        caption_ui(ui, &mut line, pane, self.caption);
        let field = controls::middle(take_right(&mut line, FIELD), theme::CONTROL);
        let track = Track {
            name: self.name,
            tip: self.tip,
            disabled,
            max: self.max,
            step: 10,
            target: value,
            actual: self.actual,
            draws: Actual::Bar,
            color: self.color,
            tick: self.tick,
            rough_from: self.rough_from,
            peak: self.peak,
        };
        let moved = track.put(ui, look, line, self.ids.0);
        if let Some(command) = &self.command {
            frame_menu_ui(ui, pane, self.ids.0, command);
        }
        let number = NumberField {
            name: self.number_name,
            tip: look.say(main::NUMBER_TIP),
            disabled,
            value: value.map(f64::from),
            range: 0.0..=f64::from(self.max),
            decimals: 0,
        };
        let typed = number.put(ui, look, pane.typing, field, self.ids.1);
        typed.map(nearest).or(moved)
    }
}

impl Row {
    /// Target over actual.
    pub(crate) fn angle_ui(&self, ui: &mut Ui, mut line: Rect, pane: &mut Pane<'_>, linked: bool) {
        let look = pane.look;
        caption_ui(ui, &mut line, pane, main::ANGLE);
        let field = controls::middle(take_right(&mut line, FIELD), theme::CONTROL);
        let joint = pane.state.hand().joints[self.dof];
        let locked = joint.locked.then(|| look.say(main::LOCKED));
        let disabled = pane.unready().or(locked);
        let (angle, freshness) = newest(pane, self.dof, pane.state.hand().sample.angle);
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
            rough_from: None,
            peak: None,
        };
        let moved = track.put(ui, look, line, self.id("angle"));
        if let Some(target) = joint.target {
            let mut targets = PerDof::splat(Target::Leave);
            targets[self.dof] = Target::Go(target);
            frame_menu_ui(ui, pane, self.id("angle"), &HandCommand::Angles(targets));
        }
        let scale = AngleScale {
            unit: pane.state.settings.angle_unit,
            dof: self.dof,
        };
        let number = NumberField {
            name: &self.named(pane, main::NAME_ANGLE_NUMBER),
            tip: look.say(main::NUMBER_TIP),
            disabled,
            value: joint.target.map(|target| scale.shown(target)),
            range: scale.range(),
            decimals: scale.decimals(),
        };
        let typed = number.put(ui, look, pane.typing, field, self.id("angle number"));
        let wish = typed
            .map(|typed| scale.angle(typed))
            .or(moved.map(Angle::nearest));
        if let Some(angle) = wish {
            self.target(pane, angle, linked);
        }
    }

    /// Linked fingers go as far as this one does, each from where it stands.
    fn target(&self, pane: &mut Pane<'_>, angle: Angle, linked: bool) {
        let by = pane.state.hand().joints[self.dof]
            .target
            .map(|before| angle.get() - before.get());
        pane.actions.push(Action::Target(self.dof, angle));
        let Some(by) = by.filter(|_| linked && LINKED.contains(&self.dof)) else {
            return;
        };
        for dof in LINKED.into_iter().filter(|dof| *dof != self.dof) {
            let joint = pane.state.hand().joints[dof];
            if let Some(target) = joint.target.filter(|_| !joint.locked) {
                let angle = Angle::nearest(target.get().saturating_add(by));
                pane.actions.push(Action::Target(dof, angle));
            }
        }
    }

    /// Threshold over live force.
    pub(crate) fn force_ui(&self, ui: &mut Ui, line: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let joint = pane.state.hand().joints[self.dof];
        let (force, freshness) = newest(pane, self.dof, pane.state.hand().sample.force);
        let force = force.and_then(|force| force.documented());
        let over = force.is_some_and(|force| force >= joint.force.get());
        let live = if over { look.palette.warn } else { self.color };
        let setting = Setting {
            caption: main::FORCE,
            name: &self.named(pane, main::NAME_FORCE_THRESHOLD),
            number_name: &self.named(pane, main::NAME_FORCE_NUMBER),
            tip: &staged(pane, main::FORCE_TIP),
            max: Force::MAX.get(),
            value: Some(joint.force.get()),
            actual: force,
            color: look.value(freshness, live),
            tick: Some(Force::RATED.get()),
            rough_from: impact::rough_from_threshold(joint.speed).map(Force::get),
            peak: pane
                .state
                .hand()
                .peaks
                .get(self.dof)
                .map(|(grams, _)| grams),
            ids: (self.id("force"), self.id("force number")),
            command: Some(HandCommand::Forces(only(self.dof, joint.force))),
        };
        if let Some(value) = setting.ui(ui, line, pane) {
            let force = Force::nearest(value);
            pane.actions.push(Action::Force(self.dof, force));
        }
    }

    /// Speed.
    pub(crate) fn speed_ui(&self, ui: &mut Ui, line: Rect, pane: &mut Pane<'_>) {
        let joint = pane.state.hand().joints[self.dof];
        let runs = pane.state.hand().runs_series();
        let setting = Setting {
            caption: main::SPEED,
            name: &self.named(pane, main::NAME_SPEED),
            number_name: &self.named(pane, main::NAME_SPEED_NUMBER),
            tip: &staged(pane, main::SPEED_TIP),
            max: Speed::MAX.get(),
            value: Some(joint.speed.get()),
            actual: (!runs).then_some(joint.speed.get()),
            color: pane.look.palette.faint,
            tick: None,
            rough_from: impact::rough_from_speed(joint.force).map(Speed::get),
            peak: None,
            ids: (self.id("speed"), self.id("speed number")),
            command: Some(HandCommand::Speeds(only(self.dof, joint.speed))),
        };
        if let Some(value) = setting.ui(ui, line, pane) {
            let speed = Speed::nearest(value);
            pane.actions.push(Action::Speed(self.dof, speed));
        }
    }
}

/// Force threshold and speed of all joints; what differs from joint to joint is not known here.
pub(crate) fn all_joints_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let name = look.say(main::ALL_JOINTS);
    let width = controls::text_width(ui, name, theme::body()) + theme::GAP;
    let mut rest = rect;
    let title = take_left(&mut rest, width);
    Label::new(name, look.palette.text).put(ui, title);
    let mut left = rest;
    let right = take_right(&mut left, (rest.width() - theme::GAP) / 2.0);
    let joints = pane.state.hand().joints;
    let named = |what: Text| format!("{name} {}", look.say(what));
    let force = Setting {
        caption: main::FORCE,
        name: &named(main::NAME_FORCE_THRESHOLD),
        number_name: &named(main::NAME_FORCE_NUMBER),
        tip: &staged(pane, main::FORCE_TIP),
        max: Force::MAX.get(),
        value: same(joints.map(|joint| joint.force.get())),
        actual: None,
        color: look.palette.faint,
        tick: Some(Force::RATED.get()),
        rough_from: None,
        peak: None,
        ids: (Id::unique("all force"), Id::unique("all force number")),
        command: Some(HandCommand::Forces(joints.map(|joint| Some(joint.force)))),
    };
    if let Some(value) = force.ui(ui, left, pane) {
        pane.actions.push(Action::ForceOfAll(Force::nearest(value)));
    }
    let speed = same(joints.map(|joint| joint.speed.get()));
    let runs = pane.state.hand().runs_series();
    let speed = Setting {
        caption: main::SPEED,
        name: &named(main::NAME_SPEED),
        number_name: &named(main::NAME_SPEED_NUMBER),
        tip: &staged(pane, main::SPEED_TIP),
        max: Speed::MAX.get(),
        value: speed,
        actual: speed.filter(|_| !runs),
        color: look.palette.faint,
        tick: None,
        rough_from: None,
        peak: None,
        ids: (Id::unique("all speed"), Id::unique("all speed number")),
        command: Some(HandCommand::Speeds(joints.map(|joint| Some(joint.speed)))),
    };
    if let Some(value) = speed.ui(ui, right, pane) {
        pane.actions.push(Action::SpeedOfAll(Speed::nearest(value)));
    }
}

/// A value for one joint alone.
fn only<T: Copy>(dof: Dof, value: T) -> PerDof<Option<T>> {
    let mut values = PerDof::splat(None);
    values[dof] = Some(value);
    values
}

/// The value that all joints share, if they do.
fn same(values: PerDof<i16>) -> Option<i16> {
    let first = values[Dof::Little];
    values
        .iter()
        .all(|(_, value)| *value == first)
        .then_some(first)
}

fn caption_ui(ui: &mut Ui, line: &mut Rect, pane: &Pane<'_>, what: Text) {
    let place = take_left(line, CAPTION);
    Label::new(pane.look.say(what), pane.look.palette.muted)
        .small()
        .put(ui, place);
}

fn staged(pane: &Pane<'_>, tip: Text) -> String {
    let tip = pane.look.say(tip);
    if pane.state.hand().is_armed() {
        return tip.into();
    }
    format!("{tip}\n{}", pane.look.say(main::STAGED))
}

fn nearest(value: f64) -> i16 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the field's range is that of the register"
    )]
    let whole = value.round() as i16;
    whole
}

/// Angles of one joint in the unit that the person chose.
#[derive(Debug, Clone, Copy)]
struct AngleScale {
    unit: AngleUnit,
    dof: Dof,
}

impl AngleScale {
    /// The ends of the scale, bent first.
    fn ends(self) -> (f64, f64) {
        match self.unit {
            AngleUnit::Raw => (0.0, 1000.0),
            AngleUnit::Percent => (0.0, 100.0),
            AngleUnit::Degrees => {
                let (low, high) = self.dof.degrees();
                (low.into(), high.into())
            }
        }
    }

    fn range(self) -> RangeInclusive<f64> {
        let (low, high) = self.ends();
        low..=high
    }

    const fn decimals(self) -> usize {
        match self.unit {
            AngleUnit::Raw => 0,
            AngleUnit::Percent | AngleUnit::Degrees => 1,
        }
    }

    fn shown(self, angle: Angle) -> f64 {
        let (low, high) = self.ends();
        low + (high - low) * f64::from(angle.get()) / 1000.0
    }

    fn angle(self, shown: f64) -> Angle {
        let (low, high) = self.ends();
        Angle::nearest(nearest((shown - low) / (high - low) * 1000.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_gives_back_the_angle_it_showed() {
        for unit in [AngleUnit::Raw, AngleUnit::Degrees, AngleUnit::Percent] {
            for dof in Dof::ALL {
                let scale = AngleScale { unit, dof };
                for raw in 0..=1000 {
                    let angle = Angle::nearest(raw);
                    assert_eq!(scale.angle(scale.shown(angle)), angle, "{unit:?} {dof:?}");
                }
            }
        }
        let bend = AngleScale {
            unit: AngleUnit::Degrees,
            dof: Dof::ThumbBend,
        };
        assert_eq!(bend.range(), -13.0..=70.0);
    }

    #[test]
    fn joints_that_differ_have_no_common_value() {
        assert_eq!(same(PerDof::splat(7)), Some(7));
        assert_eq!(same(PerDof::new([7, 7, 7, 7, 7, 8])), None);
    }
}
