//! The joints where they cannot be set: state and measurements of each drive. Sets nothing.

use crate::app::layout::WindowRoom;
use crate::hand::Dof;
use crate::ui::faults::entry::unseen_mark_ui;
use crate::ui::joints::age_ui;
use crate::ui::joints::row::JointRow;
use crate::ui::kit::DriveWords;
use crate::ui::kit::{self, Button, Label, Pane};
use crate::ui::text::{main, window};
use crate::ui::theme;
use egui::{Align, Frame, Layout, Ui, vec2};

/// Draws the rail. Where joints can be set, its heading opens their column.
pub(crate) fn rail_ui(ui: &mut Ui, pane: &mut Pane<'_>, can_open: bool) {
    let look = pane.look;
    kit::full_card_ui(ui, look, |ui| {
        let title = look.tr(main::JOINTS);
        if can_open {
            let name = look.tr_with(window::OPEN, title);
            let button = Button::new(title, look.tip(window::OPEN)).named(&name);
            let pressed = kit::wide_ui(ui, |ui| button.ui(ui, look));
            if pressed.clicked() {
                let layouts = pane.layouts(ui);
                pane.lay_out(ui, layouts.toggled(WindowRoom::Joints));
            }
        } else {
            Label::new(title, look.palette.text).ui(ui);
        }
        // Its space is reserved while there is nothing to show.
        let size = vec2(ui.available_width(), theme::TEXT_LINE);
        let down = Layout::top_down(Align::Min);
        ui.allocate_ui_with_layout(size, down, |ui| {
            ui.set_min_height(size.y);
            age_ui(ui, pane);
        });
        for dof in Dof::ALL {
            joint_ui(ui, pane, dof);
            ui.add_space(theme::STEP);
        }
    });
}

fn joint_ui(ui: &mut Ui, pane: &mut Pane<'_>, dof: Dof) {
    let (look, row) = (pane.look, JointRow::new(dof, pane));
    let drive = DriveWords::of(pane, dof);
    let frame = Frame::new().inner_margin(theme::GAP_LEFT);
    let shown = frame.show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(theme::STEP, 0.0);
        ui.spacing_mut().interact_size.y = theme::TEXT_LINE;
        ui.horizontal(|ui| {
            kit::lamp_ui(ui, Some(drive.lamp));
            Label::new(row.name, look.palette.text).small().ui(ui);
            unseen_mark_ui(ui, pane, dof);
        });
        let name = row.named(pane, main::STATUS);
        let status = Label::new(&drive.short, drive.text).small();
        status.named(&name).ui(ui);
        let line = vec2(ui.available_width(), theme::TEXT_LINE);
        let (_, place) = ui.allocate_space(line);
        row.short_reading_ui(ui, place, pane);
        let (_, place) = ui.allocate_space(line);
        row.drive_reading_ui(ui, place, pane);
    });
    let place = shown.response.rect;
    let bar = place.with_max_x(place.left() + theme::BAR);
    ui.painter().rect_filled(bar, theme::ROUND_TINY, row.color);
    row.explain_ui(ui, pane, place, &drive);
}
