//! The joints where they are not set: name, lamp, actual angle and force of each. Sets nothing.

use crate::app::action::Action;
use crate::app::layout::WindowRoom;
use crate::hand::{Dof, Quantity};
use crate::ui::joints::age_ui;
use crate::ui::joints::drive_lamp::DriveWords;
use crate::ui::joints::row::JointRow;
use crate::ui::kit::{self, Button, Label, Pane, format};
use crate::ui::text::{Text, main, window};
use crate::ui::theme;
use crate::ui::window::rooms::toggled;
use egui::{Align, Layout, Ui, vec2};

/// Draws the rail. Where joints can be set, its head opens their column.
pub(crate) fn rail_ui(ui: &mut Ui, pane: &mut Pane<'_>, can_open: bool) {
    let look = pane.look;
    kit::card_ui(ui, look, |ui| {
        ui.set_min_height(ui.available_height());
        let title = look.say(main::JOINTS);
        if can_open {
            let name = look.told(window::OPEN, title);
            let button = Button::new(title, look.tip(window::OPEN)).named(&name);
            let pressed = kit::wide_ui(ui, |ui| button.ui(ui, look));
            if pressed.clicked() {
                let layout = toggled(&pane.state.settings.layout, WindowRoom::Joints);
                pane.actions.push(Action::Layout(layout));
            }
        } else {
            Label::new(title, look.palette.text)
                .font(theme::title())
                .ui(ui);
        }
        // Its place is kept while there is nothing to tell.
        let size = vec2(ui.available_width(), theme::TEXT_LINE);
        let down = Layout::top_down(Align::Min);
        ui.allocate_ui_with_layout(size, down, |ui| {
            ui.set_min_height(size.y);
            age_ui(ui, pane);
        });
        for dof in Dof::ALL {
            joint_ui(ui, pane, dof);
            ui.add_space(theme::GAP);
        }
    });
}

fn joint_ui(ui: &mut Ui, pane: &Pane<'_>, dof: Dof) {
    let look = pane.look;
    let palette = look.palette;
    let row = JointRow::new(dof, pane);
    let shown = ui.horizontal(|ui| {
        ui.add_space(theme::BAR + theme::STEP);
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let drive = DriveWords::of(pane, dof);
            let status = format!("{}: {}", row.named(pane, main::STATUS), drive.title);
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = theme::STEP;
                kit::lamp_ui(ui, Some(drive.lamp));
                let name = Label::new(row.name, palette.text).small().ui(ui);
                name.on_hover_text(status);
            });
            ui.with_layout(Layout::top_down(Align::Max), |ui| {
                let number_ui = |ui: &mut Ui, text: &str, name: Text, freshness| {
                    let color = look.value(freshness, palette.text);
                    let name = row.named(pane, name);
                    Label::new(text, color).number().named(&name).ui(ui);
                };
                let (angle, freshness) = pane.newest(dof, pane.state.hand().sample.angle);
                let text = format::whole(angle.map(|angle| i64::from(angle.raw())), 4);
                number_ui(ui, &text, main::NAME_ANGLE_ACTUAL, freshness);
                let (force, freshness) = pane.newest(dof, pane.state.hand().sample.force);
                let force = force.map(|force| i64::from(force.raw()));
                let text = format::with_unit(force, 4, Quantity::Force.row().unit);
                number_ui(ui, &text, main::NAME_FORCE_ACTUAL, freshness);
            });
        });
    });
    let place = shown.response.rect;
    let bar = place.with_max_x(place.left() + theme::BAR);
    ui.painter().rect_filled(bar, theme::ROUND_TINY, row.color);
}
