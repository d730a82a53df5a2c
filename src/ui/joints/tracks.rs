//! Settings of a joint: target angle, force threshold, speed, and the last two for all joints at once.

use crate::app::action::Action;
use crate::app::settings::AngleUnit;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::ui::hand::aim;
use crate::ui::joints::row::{CAPTION, JointRow, READING, cell};
use crate::ui::joints::track::{Actual, SlideTrack};
use crate::ui::kit::{Label, Look, NumberField, Pane};
use crate::ui::style::format::UNKNOWN;
use crate::ui::text::{Text, main};
use crate::ui::theme;
use egui::{Align, Id, Layout, Rect, Sense, Stroke, StrokeKind, Ui};

/// Minimum length of a track, in points.
const TRACK_LEAST: f32 = 48.0;

/// A caption, a slider and a number field in a row.
struct TrackRow<'a> {
    /// `None` if the caller filled its space.
    caption: Option<Text>,
    number_name: &'a str,
    id: Id,
    track: SlideTrack<'a>,
    scale: NumberScale,
    /// The hand's own setting, if it differs from the target.
    other: Option<i16>,
    /// Width to leave free after it in the row.
    after: f32,
}

impl TrackRow<'_> {
    /// Draws it. Returns the value that the user set in this frame.
    fn ui(&self, ui: &mut Ui, pane: &mut Pane<'_>) -> Option<i16> {
        let look = pane.look;
        if let Some(caption) = self.caption {
            let place = cell(ui, CAPTION);
            Label::note(look, caption).put(ui, place);
        }
        let width = ui.available_width() - theme::FIELD - theme::GAP - self.after;
        let place = cell(ui, width);
        // Shorter, it would be a knob without a way: the number alone is set.
        let is_useful = width >= TRACK_LEAST;
        let moved = is_useful.then(|| self.track.put(ui, look, place, self.id));
        let moved = moved.flatten();
        let (scale, tip) = (self.scale, look.tr(main::NUMBER_TIP));
        let number = NumberField::new(self.number_name, tip, scale.low..=scale.high)
            .needs_enter()
            .disabled(self.track.disabled)
            .decimals(scale.decimals);
        let value = self.track.target.map(|target| scale.shown(target));
        self.other_ui(ui, look, place);
        let typed = number.ui(ui, pane, value);
        typed.map(|typed| self.scale.raw(typed)).or(moved)
    }

    /// Marks the hand's differing setting on the slider with a hollow tick.
    fn other_ui(&self, ui: &mut Ui, look: Look, track: Rect) {
        let Some(other) = self.other else {
            // The next field keeps its id, and thus the focus.
            return ui.skip_ahead_auto_ids(1);
        };
        let (scale, decimals) = (self.scale, self.scale.decimals);
        let shown = |raw| format!("{:.decimals$}", scale.shown(raw));
        let text = look.tr_with(main::HAND_HOLDS, shown(other));
        let wanted = self.track.target.map_or_else(|| UNKNOWN.into(), shown);
        let name = format!("{} {wanted} · {text}", self.number_name);
        let place = self.track.tick_place(track, other);
        let edge = Stroke::new(1.0, look.palette.text);
        ui.painter()
            .rect_stroke(place, theme::ROUND_TINY, edge, StrokeKind::Inside);
        let id = ui.next_auto_id();
        ui.skip_ahead_auto_ids(1);
        let response = ui.interact(place, id, Sense::hover());
        let label = Label::new(&text, look.palette.text).named(&name);
        label.name_node(&response);
        response.on_hover_text(look.pair(&text, look.tip(main::HAND_HOLDS)));
    }
}

impl JointRow {
    /// Draws the target over the actual angle, after a caption unless the caller filled its space.
    pub(crate) fn angle_ui(
        &self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        linked: bool,
        caption: Option<Text>,
    ) {
        let (look, hand) = (pane.look, pane.hand());
        let joint = hand.controls.joints[self.dof];
        let (angle, freshness) = pane.newest(self.dof, hand.readings.sample.angle);
        let name = self.named(pane, main::NAME_ANGLE_TARGET);
        let setting = TrackRow {
            caption,
            number_name: &self.named(pane, main::NAME_ANGLE_NUMBER),
            id: self.id("angle"),
            track: SlideTrack {
                tip: look.tip(main::ANGLE),
                disabled: aim::refusal(pane, self.dof),
                target: joint.target.map(Angle::get),
                actual: angle.and_then(|angle| angle.hold()).map(Angle::get),
                draws: Actual::Marker,
                ..SlideTrack::new(&name, Angle::MAX.get(), look.value(freshness, self.color))
            },
            scale: NumberScale::of_angle(pane.state.settings.angle_unit, self.dof),
            other: hand.held_otherwise(self.dof).target.map(Angle::get),
            after: READING + theme::GAP,
        };
        if let Some(value) = setting.ui(ui, pane) {
            aim::send(pane, self.dof, Angle::nearest(value), linked);
        }
    }
}

/// Draws the threshold over the live force of one joint; without a row, the threshold of all joints.
pub(crate) fn force_ui(ui: &mut Ui, pane: &mut Pane<'_>, row: Option<&JointRow>) {
    let (look, hand) = (pane.look, pane.hand());
    let joints = hand.controls.joints;
    let name = named(pane, row, main::NAME_FORCE_THRESHOLD);
    let (runs, off) = (series(pane), pane.recorded().or(series(pane)));
    let value = value_of(row, joints.map(|joint| joint.force.map(Force::get)));
    let others = PerDof::from_fn(|dof| hand.held_otherwise(dof).force.map(Force::get));
    let mut track = SlideTrack {
        tip: &staged(pane, main::FORCE.tip()),
        disabled: off,
        target: value.filter(|_| runs.is_none()),
        tick: Some(Force::RATED.get()),
        ..SlideTrack::new(&name, Force::MAX.get(), look.palette.faint)
    };
    if let Some(row) = row {
        let joint = joints[row.dof];
        let (force, freshness) = pane.newest(row.dof, hand.readings.sample.force);
        track.actual = force.and_then(|force| force.documented());
        let over = track.actual.zip(
            hand.controls
                .stops_at(row.dof, hand.held_otherwise(row.dof)),
        );
        let over = over.is_some_and(|(now, stops_at)| now >= stops_at.get());
        let live = if over { look.palette.warn } else { row.color };
        track.color = look.value(freshness, live);
        let rough = joint.speed;
        let map = &hand.overshoot.map;
        let rough = rough.and_then(|speed| map.rough_from_threshold(row.dof, speed));
        track.rough_from = rough.map(Force::get);
        track.peak = hand.readings.peaks.get(row.dof).map(|(grams, _)| grams);
    }
    let newtons = row.zip(value).and_then(|(row, value)| {
        let per_g = hand.newtons.per_g(row.dof)?;
        let newtons = format!("{:.1}", per_g * f64::from(value));
        Some(look.fill(main::FORCE_NEWTONS, &[&value, &newtons]))
    });
    let tip = newtons.map(|newtons| format!("{newtons}\n{}", track.tip));
    track.tip = tip.as_deref().unwrap_or(track.tip);
    let setting = TrackRow {
        caption: Some(main::FORCE),
        number_name: &named(pane, row, main::NAME_FORCE_NUMBER),
        id: id_of(row, "force"),
        scale: NumberScale::whole(track.max),
        other: value_of(row, others),
        track,
        after: after(row),
    };
    if let Some(value) = setting.ui(ui, pane) {
        let force = Force::nearest(value);
        let dof = row.map(|row| row.dof);
        pane.actions.push(Action::Force(dof, force));
    }
}

/// Draws the speed of one joint; without a row, that of all joints.
pub(crate) fn speed_ui(ui: &mut Ui, pane: &mut Pane<'_>, row: Option<&JointRow>) {
    let hand = pane.hand();
    let joints = hand.controls.joints;
    let (runs, off) = (series(pane), pane.recorded().or(series(pane)));
    let value = value_of(row, joints.map(|joint| joint.speed.map(Speed::get)));
    let value = value.filter(|_| runs.is_none());
    let others = PerDof::from_fn(|dof| hand.held_otherwise(dof).speed.map(Speed::get));
    let rough = row.and_then(|row| {
        let threshold = joints[row.dof].force?;
        hand.overshoot.map.rough_from_speed(row.dof, threshold)
    });
    let name = named(pane, row, main::NAME_SPEED);
    let setting = TrackRow {
        caption: Some(main::SPEED),
        number_name: &named(pane, row, main::NAME_SPEED_NUMBER),
        id: id_of(row, "speed"),
        track: SlideTrack {
            tip: &staged(pane, main::SPEED.tip()),
            disabled: off,
            target: value,
            actual: value,
            rough_from: rough.map(Speed::get),
            ..SlideTrack::new(&name, Speed::MAX.get(), pane.look.palette.faint)
        },
        scale: NumberScale::whole(Speed::MAX.get()),
        other: value_of(row, others),
        after: after(row),
    };
    if let Some(value) = setting.ui(ui, pane) {
        let speed = Speed::nearest(value);
        let dof = row.map(|row| row.dof);
        pane.actions.push(Action::Speed(dof, speed));
    }
}

/// Draws force threshold and speed of all joints; values that differ between joints are shown as unknown.
pub(crate) fn all_joints_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let name = Label::text(pane.look, main::EVERY);
    ui.horizontal(|ui| {
        name.ui(ui);
        ui.columns(2, |columns| {
            for (ui, setting_ui) in columns.iter_mut().zip([force_ui, speed_ui]) {
                let row = Layout::left_to_right(Align::Center);
                let size = egui::vec2(ui.available_width(), theme::CONTROL);
                ui.allocate_ui_with_layout(size, row, |ui| setting_ui(ui, pane, None));
            }
        });
    });
}

/// Reason while a series runs: each trial sets its own force and speed, so the user's settings are not in force.
fn series(pane: &Pane<'_>) -> Option<&'static str> {
    let runs = pane.hand().runs_series();
    runs.then(|| pane.look.tr(main::SERIES_RUNS))
}

fn named(pane: &Pane<'_>, row: Option<&JointRow>, what: Text) -> String {
    let all = pane.look.tr(main::EVERY);
    let name = row.map_or(all, |row| row.name);
    format!("{name} {}", pane.look.tr(what))
}

fn id_of(row: Option<&JointRow>, part: &'static str) -> Id {
    row.map_or_else(|| Id::unique(("all joints", part)), |row| row.id(part))
}

fn after(row: Option<&JointRow>) -> f32 {
    row.map_or(0.0, |_| READING + theme::GAP)
}

/// Value of one joint, or the common value of all joints, if they have one.
fn value_of(row: Option<&JointRow>, values: PerDof<Option<i16>>) -> Option<i16> {
    let value = values[row.map_or(Dof::Little, |row| row.dof)];
    let is_shared = values.iter().all(|(_, other)| *other == value);
    value.filter(|_| row.is_some() || is_shared)
}

fn staged(pane: &Pane<'_>, tip: Text) -> String {
    let tip = pane.look.tr(tip);
    if pane.hand().connection.is_armed() {
        return tip.into();
    }
    format!("{tip}\n{}", pane.look.tr(main::STAGED))
}

/// Mapping of a register's values 0..=max to displayed numbers.
#[derive(Debug, Clone, Copy)]
struct NumberScale {
    low: f64,
    high: f64,
    max: f64,
    decimals: usize,
}

impl NumberScale {
    /// Raw values.
    fn whole(max: i16) -> Self {
        let max = f64::from(max);
        Self {
            low: 0.0,
            high: max,
            max,
            decimals: 0,
        }
    }

    /// Angles of one joint in the chosen unit.
    fn of_angle(unit: AngleUnit, dof: Dof) -> Self {
        let whole = Self::whole(Angle::MAX.get());
        let (low, high) = match unit {
            AngleUnit::Raw => return whole,
            AngleUnit::Percent => (0.0, 100.0),
            AngleUnit::Degrees => dof.degrees(),
        };
        Self {
            low: low.into(),
            high: high.into(),
            decimals: 1,
            ..whole
        }
    }

    fn shown(self, raw: i16) -> f64 {
        self.low + (self.high - self.low) * f64::from(raw) / self.max
    }

    fn raw(self, shown: f64) -> i16 {
        let part = (shown - self.low) / (self.high - self.low);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the field's range is that of the register"
        )]
        let raw = (part * self.max).round() as i16;
        raw
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_gives_back_the_angle_it_showed() {
        for unit in [AngleUnit::Raw, AngleUnit::Degrees, AngleUnit::Percent] {
            for dof in Dof::ALL {
                let scale = NumberScale::of_angle(unit, dof);
                for raw in 0..=1000 {
                    assert_eq!(scale.raw(scale.shown(raw)), raw, "{unit:?} {dof:?}");
                }
            }
        }
        let bend = NumberScale::of_angle(AngleUnit::Degrees, Dof::ThumbBend);
        assert_eq!((bend.low, bend.high), (-13.0, 70.0));
    }

    #[test]
    fn joints_that_differ_have_no_common_value() {
        assert_eq!(value_of(None, PerDof::splat(Some(7))), Some(7));
        for differs in [None, Some(8)] {
            let mut values = PerDof::splat(Some(7));
            values[Dof::ThumbRotate] = differs;
            assert_eq!(value_of(None, values), None);
        }
    }
}
