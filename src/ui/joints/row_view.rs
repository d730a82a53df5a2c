//! One joint's row: name, status, lock, and below them its tracks and readings.

use crate::app::action::Action;
use crate::hand::Dof;
use crate::hand::impact::NOTABLE_G;
use crate::hand::overshoot::Stages;
use crate::ui::faults::entry::unseen_ring_ui;
use crate::ui::hand::pointed::{self, PointedPlace};
use crate::ui::joints::row::{CAPTION, JointRow, READING, cell};
use crate::ui::joints::tracks;
use crate::ui::kit::DriveWords;
use crate::ui::kit::{self, Button, Label, Pane, ViewRequest};
use crate::ui::text::{main, notices, tune};
use crate::ui::theme;
use egui::{
    Align, Color32, CursorIcon, Frame, Layout, Margin, Rect, Role, Sense, Ui, UiBuilder,
    WidgetInfo, pos2, vec2,
};

/// Layout of a row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowStyle {
    /// Height of a line, in points.
    pub(crate) line: f32,
    /// Force and speed have lines of their own.
    pub(crate) each: bool,
    /// The four fingers move together.
    pub(crate) linked: bool,
}

/// Height of a row with lines of this height.
pub(crate) fn height(line: f32, each: bool) -> f32 {
    let lines = if each { 4.0 } else { 2.0 };
    lines * line + theme::GAP
}

pub(crate) fn row_ui(ui: &mut Ui, pane: &mut Pane<'_>, dof: Dof, style: RowStyle) {
    let (row, palette) = (JointRow::new(dof, pane), pane.look.palette);
    let is_pointed = pointed::pointed(ui, PointedPlace::Hand) == Some(dof);
    let wash = palette.wash(row.color);
    let frame = Frame::new()
        .fill(if is_pointed {
            wash
        } else {
            Color32::TRANSPARENT
        })
        .corner_radius(theme::ROUND_SMALL)
        .inner_margin(Margin {
            left: 12,
            ..Margin::symmetric(0, 4)
        });
    let shown = frame.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.spacing_mut().interact_size.y = style.line.min(theme::CONTROL);
        line_ui(ui, style.line, |ui| head_ui(ui, pane, &row, style.each));
        line_ui(ui, style.line, |ui| {
            if style.each {
                row.angle_ui(ui, pane, style.linked, Some(main::ANGLE));
                let place = cell(ui, READING);
                row.angle_reading_ui(ui, place, pane)
            } else {
                warnings_ui(ui, pane, &row);
                row.angle_ui(ui, pane, style.linked, None);
                let place = cell(ui, READING);
                row.short_reading_ui(ui, place, pane)
            }
        });
        if style.each {
            line_ui(ui, style.line, |ui| {
                tracks::force_ui(ui, pane, Some(&row));
                let place = cell(ui, READING);
                row.force_reading_ui(ui, place, pane);
            });
            line_ui(ui, style.line, |ui| {
                tracks::speed_ui(ui, pane, Some(&row));
                kit::right_ui(ui, |ui| impact_ui(ui, pane, &row));
            });
        }
    });
    let rect = shown.response.rect;
    if ui.rect_contains_pointer(rect) {
        pointed::point(ui, PointedPlace::Row, dof);
    }
    let bar = rect.shrink2(vec2(0.0, theme::STEP));
    let bar = bar.with_max_x(rect.left() + theme::BAR);
    ui.painter().rect_filled(bar, theme::ROUND_TINY, row.color);
    if dof != Dof::Little {
        let line = (1.0, palette.grid);
        ui.painter().hline(rect.x_range(), rect.top(), line);
    }
}

fn line_ui(ui: &mut Ui, height: f32, add: impl FnOnce(&mut Ui)) {
    let size = vec2(ui.available_width(), height);
    kit::cell_ui(ui, size, add);
}

fn head_ui(ui: &mut Ui, pane: &mut Pane<'_>, row: &JointRow, each: bool) {
    let name = cell(ui, 90.0);
    Label::new(row.name, pane.look.palette.text).put(ui, name);
    kit::right_ui(ui, |ui| {
        lock_ui(ui, pane, row);
        let place = cell(ui, if each { READING } else { 96.0 });
        row.drive_reading_ui(ui, place, pane);
        status_ui(ui, pane, row);
    });
}

/// Draws the warnings of a narrow row where a wide one has the caption of its track: beside the state they would cut its words.
fn warnings_ui(ui: &mut Ui, pane: &Pane<'_>, row: &JointRow) {
    let place = cell(ui, CAPTION);
    let builder = UiBuilder::new()
        .max_rect(place)
        .layout(Layout::left_to_right(Align::Center));
    ui.scope_builder(builder, |ui| {
        impact_ui(ui, pane, row);
    });
}

/// Draws lamp and text of the drive: a click explains them.
fn status_ui(ui: &mut Ui, pane: &mut Pane<'_>, row: &JointRow) {
    let rect = cell(ui, ui.available_width());
    let drive = DriveWords::of(pane, row.dof);
    row.explain_ui(ui, pane, rect, &drive);
    let lamp = pos2(rect.left() + theme::LAMP_AT, rect.center().y);
    kit::lamp(ui, lamp, drive.lamp);
    unseen_ring_ui(ui, pane, row.dof, lamp);
    let name = row.named(pane, main::STATUS);
    let label = Label::new(&drive.short, drive.text).small().named(&name);
    label.put(ui, rect.with_min_x(rect.left() + 17.0));
}

impl JointRow {
    /// Turns the area of a drive's text into a button that opens the explanation.
    pub(crate) fn explain_ui(&self, ui: &Ui, pane: &mut Pane<'_>, rect: Rect, drive: &DriveWords) {
        let name = self.named(pane, notices::EXPLAIN);
        let response = ui.interact(rect, self.id("explain"), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        kit::focus_ring(ui, pane.look, &response, rect);
        if response.clicked() {
            pane.open(ViewRequest::Drive(self.dof));
        }
        let tip = pane.look.tip(notices::EXPLAIN);
        let (cause, advice) = drive.words.map_or(("", ""), |it| (it.cause, it.advice));
        response
            .on_hover_text(format!("{cause}\n{advice}\n{tip}").trim())
            .on_hover_cursor(CursorIcon::PointingHand);
    }
}

/// Draws a warning with the measured overshoot, if speed and threshold together are known to exceed the threshold far.
fn impact_ui(ui: &mut Ui, pane: &Pane<'_>, row: &JointRow) {
    let (hand, look) = (pane.hand(), pane.look);
    let joint = hand.controls.joints[row.dof];
    let Some((speed, force)) = joint.speed.zip(joint.force) else {
        return;
    };
    let (speed, force) = (speed.get(), force.get());
    let map = &hand.overshoot.map;
    let expected = map.expected(row.dof, Stages::One, speed.into(), force.into());
    let nobody_sets = hand.runs_series() || pane.recorded().is_some();
    if expected.over_g < NOTABLE_G || nobody_sets {
        return;
    }
    let response = kit::warning_ui(ui, pane.look.palette.warn);
    let name = row.named(pane, main::NAME_IMPACT);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    let peak_g = format!("{:.0}", expected.over_g);
    let exceeded = look.fill(main::IMPACT, &[&speed, &force, &peak_g]);
    let measured = tune::measured_on(look, &expected.on);
    let tip = look.tr(main::IMPACT_TIP);
    response.on_hover_text(format!("{exceeded}\n{measured}\n{tip}"));
}

fn lock_ui(ui: &mut Ui, pane: &mut Pane<'_>, row: &JointRow) {
    let look = pane.look;
    let locked = pane.hand().controls.joints[row.dof].locked;
    let (icon, tip) = if locked {
        (theme::LOCKED, main::UNLOCK_TIP)
    } else {
        (theme::UNLOCKED, main::LOCK_TIP)
    };
    let name = row.named(pane, main::NAME_LOCK);
    let mut button = Button::new(&name, look.tr(tip)).icon(icon).choice(locked);
    button.height = ui.spacing().interact_size.y;
    button.on_click(ui, pane, Action::Lock(row.dof, !locked));
}
