//! The six joint rows: target over actual, threshold over force, speed, lamp, lock. Sends nothing by itself.
pub(crate) mod drive_lamp;
pub(crate) mod drive_tiles;
pub(crate) mod frame_menu;
pub(crate) mod newest;
pub(crate) mod rail;
pub(crate) mod readings;
pub(crate) mod row;
pub(crate) mod track;
pub(crate) mod tracks;

use crate::app::action::Action;
use crate::app::hand::Freshness;
use crate::app::hand::Preset;
use crate::app::settings::AngleUnit;
use crate::hand::Dof;
use crate::ui::joints::row::Row;
use crate::ui::joints::tracks::all_joints_ui;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right};
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::text::{layout, main};
use crate::ui::theme;
use egui::{Id, Rect, Ui, pos2, vec2};

/// No line of a row grows higher than this.
const LINE_MAX: f32 = theme::LINE_HIGH;

/// The column of joints.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct JointsView {
    /// The four fingers move together.
    linked: bool,
}

impl JointsView {
    /// Lets the four fingers move together, or not.
    pub(crate) const fn toggle_link(&mut self) {
        self.linked = !self.linked;
    }

    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let (mut head, mut rest) = controls::titled_card(ui, look, rect, look.say(main::JOINTS));
        self.head_ui(ui, &mut head, pane);
        let below = theme::CONTROL_LARGE + theme::CONTROL + 2.0 * theme::GAP;
        let height = rest.height() - below;
        let list = controls::take_top(&mut rest, height);
        self.list_ui(ui, list, pane);
        let all = controls::take_top(&mut rest, theme::CONTROL);
        all_joints_ui(ui, all, pane);
        buttons_ui(ui, rest.with_max_y(rest.top() + theme::CONTROL_LARGE), pane);
    }

    fn head_ui(&mut self, ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let unit = pane.state.settings.angle_unit;
        let text = look.say(match unit {
            AngleUnit::Raw => main::UNIT_RAW,
            AngleUnit::Degrees => main::UNIT_DEGREES,
            AngleUnit::Percent => main::UNIT_PERCENT,
        });
        let button_width =
            |ui: &Ui, text: &str| controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
        let place = take_right(head, button_width(ui, text));
        let button = Button::new(text, look.say(main::UNIT_TIP))
            .named(look.say(main::UNIT_NAME))
            .weight(Weight::Quiet);
        if button
            .put(ui, look, place, Id::unique("angle unit"))
            .clicked()
        {
            pane.actions.push(Action::AngleUnit(unit.next()));
        }
        let text = look.say(main::LINK_FINGERS);
        let place = take_right(head, theme::ICON_BUTTON);
        let button = Button::new(text, look.say(main::LINK_FINGERS_TIP))
            .icon(theme::LINKED)
            .choice(self.linked);
        if button
            .put(ui, look, place, Id::unique("link fingers"))
            .clicked()
        {
            self.toggle_link();
        }
        age_ui(ui, head, pane);
    }

    fn list_ui(&self, ui: &mut Ui, list: Rect, pane: &mut Pane<'_>) {
        let least = 3.0 * theme::least_line(ui.pixels_per_point()) + theme::GAP;
        let height = list.height() / 6.0;
        if height >= least {
            let height = height.min(4.0 * LINE_MAX + 2.0 * theme::GAP);
            self.rows_ui(ui, list, height, pane);
            return;
        }
        ui.scope_builder(egui::UiBuilder::new().max_rect(list), |ui| {
            egui::ScrollArea::vertical()
                .auto_shrink(false)
                .show(ui, |ui| {
                    let size = vec2(list.width(), least * 6.0);
                    let whole = Rect::from_min_size(ui.cursor().min, size);
                    self.rows_ui(ui, whole, least, pane);
                });
        });
    }

    fn rows_ui(&self, ui: &mut Ui, list: Rect, height: f32, pane: &mut Pane<'_>) {
        let mut top = list.top();
        for dof in Dof::ALL {
            let rect = Rect::from_min_size(pos2(list.left(), top), vec2(list.width(), height));
            Row::new(dof, pane).ui(ui, rect, pane, self.linked);
            top += height;
        }
    }
}

fn age_ui(ui: &mut Ui, head: &mut Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let asked = pane.state.hand().sample.angle.map(|angle| angle.asked);
    let (text, color) = match pane.freshness(asked) {
        Freshness::Live if pane.state.hand().is_armed() => return,
        // The bar says why it cannot be armed.
        Freshness::Live if pane.state.hand().arm_refusal().is_some() => return,
        // A first look must find what comes before moving.
        Freshness::Live => (look.say(layout::ARM_FIRST).to_owned(), look.palette.accent),
        Freshness::Unknown => (look.say(main::NEVER_READ).to_owned(), look.palette.muted),
        Freshness::Stale => {
            let age = asked.map(|asked| pane.state.now.since(asked));
            let age = format::age(age.unwrap_or_default());
            (format!("{} {age}", look.say(main::AGE)), look.palette.warn)
        }
    };
    let width = controls::text_width(ui, &text, theme::small()) + 1.0;
    let place = take_right(head, width);
    Label::new(&text, color)
        .small()
        .right()
        .put(ui, place)
        .on_hover_text(look.say(main::AGE_TIP));
}

fn buttons_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let width = (rect.width() - 3.0 * theme::GAP) / 4.0;
    let mut rest = rect;
    let not_armed = pane.unready();
    let presets = [
        (main::OPEN, main::OPEN_TIP, Preset::Open),
        (main::HALF, main::HALF_TIP, Preset::Half),
        (main::CLOSE, main::CLOSE_TIP, Preset::Close),
    ];
    for (text, tip, preset) in presets {
        let place = take_left(&mut rest, width);
        let button = Button::new(look.say(text), look.say(tip)).disabled(not_armed);
        let id = Id::unique(("preset", preset));
        if button.put(ui, look, place, id).clicked() {
            pane.actions.push(Action::Preset(preset));
        }
    }
    let hold = Button::new(look.say(main::HOLD), look.say(main::HOLD_TIP));
    let response = hold.put(ui, look, rest, Id::unique("hold"));
    if controls::pressed(ui, &response) {
        pane.actions.push(Action::Stop);
    }
}
