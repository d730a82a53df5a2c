//! One joint's row: where its parts stand, its lamp and lock. Tracks and readings have files of their own.

use crate::app::action::Action;
use crate::app::settings::Language;
use crate::hand::{Dof, impact};
use crate::ui::hand::pointed::{self, Place};
use crate::ui::joints::drive_lamp::DriveWords;
use crate::ui::joints::drive_tiles;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, Lock, take_left, take_right};
use crate::ui::kit::look::{Explain, Pane};
use crate::ui::text::{Text, faults, main, words};
use crate::ui::theme;
use egui::{Color32, Id, Rect, Sense, Ui, WidgetInfo, pos2, vec2};

/// Width of the readings at the right.
pub(crate) const READING: f32 = theme::READING;

/// The height of a row of such lines.
pub(crate) fn height(line: f32, each: bool) -> f32 {
    let lines = if each { 4.0 } else { 2.0 };
    lines * line + theme::GAP
}

/// One joint's row, with its names made once.
pub(crate) struct Row {
    /// The joint.
    pub(crate) dof: Dof,
    /// What it is called.
    pub(crate) name: &'static str,
    /// Its colour.
    pub(crate) color: Color32,
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

    /// What a screen reader says of one of its parts.
    pub(crate) fn named(&self, pane: &Pane<'_>, what: Text) -> String {
        format!("{} {}", self.name, pane.look.say(what))
    }

    /// The id of one of its parts.
    pub(crate) fn id(&self, part: &'static str) -> Id {
        Id::unique(("joint", self.dof, part))
    }

    /// Gives the keyboard to the angle, or to the force threshold while the angle cannot be moved.
    pub(crate) fn focus(&self, ui: &Ui, movable: bool) {
        let part = if movable { "angle" } else { "force" };
        ui.memory_mut(|memory| memory.request_focus(self.id(part)));
    }

    /// Draws it in lines of this height: what it is and its angle, and if `each` its force and speed too.
    pub(crate) fn ui(
        &self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        (line, each): (f32, bool),
        linked: bool,
    ) {
        let palette = pane.look.palette;
        let size = vec2(ui.available_width(), height(line, each));
        let (_, rect) = ui.allocate_space(size);
        if ui.rect_contains_pointer(rect) {
            pointed::point(ui, Place::Row, self.dof);
        }
        if pointed::pointed(ui, Place::Hand) == Some(self.dof) {
            let wash = palette.wash(self.color);
            ui.painter().rect_filled(rect, theme::ROUND_SMALL, wash);
        }
        let inner = rect.shrink2(vec2(0.0, theme::STEP));
        let bar = inner.with_max_x(rect.left() + theme::BAR);
        ui.painter().rect_filled(bar, theme::ROUND_TINY, self.color);
        if self.dof != Dof::Little {
            let stroke = egui::Stroke::new(1.0, palette.grid);
            ui.painter().hline(rect.x_range(), rect.top(), stroke);
        }
        let mut rest = inner.with_min_x(rect.left() + theme::PAD);
        let mut next = || {
            let (first, others) = rest.split_top_bottom_at_y(rest.top() + line);
            rest = others;
            first
        };
        self.head_ui(ui, next(), pane, each);
        let mut angle = next();
        let reading = take_right(&mut angle, READING);
        self.angle_ui(ui, angle, pane, linked);
        if !each {
            self.short_reading_ui(ui, reading, pane);
            return;
        }
        self.angle_reading_ui(ui, reading, pane);
        let mut force = next();
        let reading = take_right(&mut force, READING);
        self.force_reading_ui(ui, reading, pane);
        self.force_ui(ui, force, pane);
        let mut speed = next();
        let reading = take_right(&mut speed, READING);
        self.drive_reading_ui(ui, reading, pane);
        self.speed_ui(ui, speed, pane);
    }

    fn head_ui(&self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, each: bool) {
        let palette = pane.look.palette;
        let mut rest = rect;
        let name = take_left(&mut rest, theme::NAME_COLUMN);
        Label::new(self.name, palette.text).put(ui, name);
        self.lock_ui(ui, take_right(&mut rest, theme::SMALL_BUTTON), pane);
        if !each {
            let drive = take_right(&mut rest, theme::DRIVE_COLUMN);
            self.drive_reading_ui(ui, drive, pane);
        }
        self.impact_ui(ui, &mut rest, pane);
        self.status_ui(ui, rest, pane);
    }

    /// Lamp and words of the drive; a click explains them.
    fn status_ui(&self, ui: &mut Ui, mut rect: Rect, pane: &mut Pane<'_>) {
        drive_tiles::unseen_mark_ui(ui, &mut rect, pane, self.dof);
        let said = DriveWords::of(pane, self.dof);
        let name = self.named(pane, faults::EXPLAIN);
        let response = ui.interact(rect, self.id("explain"), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &name));
        controls::focus_ring(ui, pane.look, &response, rect);
        if response.clicked() {
            *pane.explain = Some(Explain::Drive(self.dof));
        }
        controls::lamp(
            ui,
            pos2(rect.left() + theme::LAMP_AT, rect.center().y),
            said.lamp,
        );
        let place = rect.with_min_x(rect.left() + theme::INDENT);
        let name = self.named(pane, main::STATUS);
        Label::new(&said.title, said.text)
            .small()
            .named(&name)
            .shorter(&said.short)
            .put(ui, place);
        let tip = pane.look.say(faults::EXPLAIN_TIP);
        let tip = said.words.map_or_else(
            || tip.to_owned(),
            |words| format!("{}\n{}\n{tip}", words.cause, words.advice),
        );
        response
            .on_hover_text(tip)
            .on_hover_cursor(egui::CursorIcon::PointingHand);
    }

    /// A sign where speed and threshold together were measured to go far past the threshold, with the figure.
    fn impact_ui(&self, ui: &mut Ui, rest: &mut Rect, pane: &Pane<'_>) {
        let joint = pane.state.hand().joints[self.dof];
        let rough_from = impact::rough_from_speed(joint.force);
        let is_gentle = rough_from.is_none_or(|rough| joint.speed < rough);
        if is_gentle || pane.state.hand().runs_series() {
            return;
        }
        let place = take_right(rest, theme::SIGN);
        let sign = controls::middle(place, theme::SIGN_SMALL).shrink2(vec2(1.0, 0.0));
        controls::warning_sign(ui, sign, pane.look.palette.warn);
        let name = self.named(pane, main::NAME_IMPACT);
        let response = ui.interact(place, self.id("impact"), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, &name));
        let peak = impact::overshoot_g(joint.speed.get().into(), joint.force.get().into());
        let measured = match pane.look.language {
            Language::En => format!(
                "At speed {} a threshold of {} g was exceeded by about {peak:.0} g on a rigid object.",
                joint.speed.get(),
                joint.force.get(),
            ),
            Language::Zh => format!(
                "速度 {}、阈值 {} g 时，抓取刚性物体的实测峰值超出阈值约 {peak:.0} g。",
                joint.speed.get(),
                joint.force.get(),
            ),
        };
        response.on_hover_text(format!("{measured}\n{}", pane.look.say(main::IMPACT_TIP)));
    }

    fn lock_ui(&self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let locked = pane.state.hand().joints[self.dof].locked;
        let place = controls::middle(rect, theme::SMALL_BUTTON);
        let response = ui.interact(rect, self.id("lock"), Sense::click());
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
}
