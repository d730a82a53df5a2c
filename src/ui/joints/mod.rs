//! The six joint rows: target over actual angle, threshold over force, speed, lamp, lock. Sends nothing by itself.
pub(crate) mod held;
pub(crate) mod rail;
pub(crate) mod readings;
pub(crate) mod row;
pub(crate) mod row_view;
pub(crate) mod track;
pub(crate) mod tracks;

use crate::app::action::Action;
use crate::app::readings::Freshness;
use crate::hand::Dof;
use crate::poses::Preset;
use crate::ui::hand::aim;
use crate::ui::joints::row_view::{RowStyle, height, row_ui};
use crate::ui::joints::tracks::all_joints_ui;
use crate::ui::kit::{self, Button, Label, Pane, Weight, format};
use crate::ui::text::main;
use crate::ui::theme;
use egui::{ScrollArea, Ui};

/// Maximum height of a row's line.
const LINE_MAX: f32 = 28.0;

/// Minimum height of a row's line: a track fits in it, and on a touch screen a finger can hit it.
const fn least_line(pixels_per_point: f32) -> f32 {
    if pixels_per_point >= 1.5 { 30.0 } else { 19.0 }
}

/// View state of the column of joints.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct JointsView {
    /// The four fingers move together.
    linked: bool,
    /// Force and speed of each joint are shown; `None` = if they fit.
    each: Option<bool>,
}

impl JointsView {
    /// Links or unlinks the four fingers.
    pub(crate) const fn toggle_link(&mut self) {
        self.linked = !self.linked;
    }

    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::full_card_ui(ui, look, |ui| {
            let line = least_line(ui.pixels_per_point());
            let below = theme::CONTROL_LARGE + theme::CONTROL + 2.0 * theme::GAP;
            let above = 2.0 * (theme::CONTROL + theme::STEP);
            let room = ui.available_height() - above - below;
            let fits = room >= 6.0 * height(line, true);
            let each = self.each.unwrap_or(fits);
            let head = look.tr(main::JOINTS);
            kit::head_ui(ui, look, head, |ui| self.head_ui(ui, pane, each));
            held::held_ui(ui, pane);
            let lines = if each { 4.0 } else { 2.0 };
            let line = ((room / 6.0 - theme::GAP) / lines).clamp(line, LINE_MAX.max(line));
            let linked = self.linked;
            if linked {
                aim::link(ui);
            }
            let style = RowStyle { line, each, linked };
            kit::put_scroll_bar_in_margin(ui);
            let area = ScrollArea::vertical().max_height(room);
            area.auto_shrink(false).show(ui, |ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                for dof in Dof::ALL {
                    ui.push_id(dof, |ui| row_ui(ui, pane, dof, style));
                }
            });
            all_joints_ui(ui, pane);
            presets_ui(ui, pane);
        });
    }

    /// Draws the controls at the right of the title, from right to left.
    fn head_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, each: bool) {
        let look = pane.look;
        let unit = pane.state.settings.angle_unit;
        let text = look.tr(main::angle_unit(unit));
        let button = Button::new(text, look.tr(main::UNIT_TIP))
            .named(look.tr(main::UNIT_NAME))
            .weight(Weight::Quiet);
        button.on_click(ui, pane, Action::AngleUnit(unit.next()));
        let button = Button::text(look, main::LINK_FINGERS);
        let button = button.icon(theme::LINKED).choice(self.linked);
        if button.ui(ui, look).clicked() {
            self.toggle_link();
        }
        let button = Button::text(look, main::EACH);
        if button.icon(theme::TUNE).choice(each).ui(ui, look).clicked() {
            self.each = Some(!each);
        }
        age_ui(ui, pane);
    }
}

/// Draws the age of the angles, unless they are live.
pub(crate) fn age_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let angle = pane.hand().readings.sample.angle;
    let asked = angle.map(|angle| angle.asked);
    let (text, color) = match pane.freshness(asked) {
        Freshness::Live => return,
        Freshness::Unknown => (look.tr(main::NEVER_READ).to_owned(), look.palette.muted),
        Freshness::Stale => {
            let age = asked.map(|asked| pane.state.now.since(asked));
            let age = format::age(age.unwrap_or_default());
            (look.tr_with(main::AGE, age), look.palette.warn)
        }
    };
    let label = Label::new(&text, color).small().ui(ui);
    label.on_hover_text(look.tip(main::AGE));
}

fn presets_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let not_armed = pane.unready();
    let presets = [
        (main::OPEN, Preset::Open),
        (main::HALF, Preset::Half),
        (main::CLOSE, Preset::Close),
    ];
    ui.columns(presets.len(), |columns| {
        for (ui, (text, preset)) in columns.iter_mut().zip(presets) {
            let button = Button::text(look, text).large().disabled(not_armed);
            kit::wide_ui(ui, |ui| {
                button.on_click(ui, pane, Action::Preset(preset));
            });
        }
    });
}
