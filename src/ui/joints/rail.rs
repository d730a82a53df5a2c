//! The joints when their column is shut: name, lamp, actual angle and force of each. Sets nothing.

use crate::app::layout::Room;
use crate::hand::{Dof, Quantity};
use crate::ui::joints::drive_lamp::DriveWords;
use crate::ui::joints::newest::newest;
use crate::ui::joints::row::Row;
use crate::ui::kit::border::{ask, title};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight};
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::text::{layout, main};
use crate::ui::theme;
use crate::ui::window::rooms::toggled;
use egui::{Align2, CornerRadius, Id, Rect, Ui, pos2, vec2};

/// Lines of one joint: name, angle, force.
const LINES: u8 = 3;

/// Draws the rail.
pub(crate) fn rail_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let mut inner = controls::card(ui, look, rect);
    let head = controls::take_top(&mut inner, theme::CONTROL);
    let name = format!(
        "{} {}",
        look.say(layout::OPEN),
        look.say(title(Room::Joints))
    );
    let button = Button::new(look.say(main::JOINTS), look.say(layout::OPEN_TIP))
        .named(&name)
        .weight(Weight::Normal);
    let place = head.expand2(vec2(theme::STEP, 0.0));
    let response = button.ground(ui, look, place, Id::unique("open joints"));
    let words = place.shrink2(vec2(theme::GAP, 0.0));
    let color = look.palette.text;
    let left = Align2::LEFT_CENTER;
    controls::paint_text(
        ui,
        words,
        left,
        look.say(main::JOINTS),
        theme::body(),
        color,
    );
    let (right, sign) = (Align2::RIGHT_CENTER, theme::TO_RIGHT);
    ui.painter()
        .text(words.right_center(), right, sign, theme::icon(), color);
    if response.clicked() {
        ask(pane, toggled(&pane.state.settings.layout, Room::Joints));
    }
    let most = f32::from(LINES) * theme::CONTROL + theme::PAD;
    let height = (inner.height() / 6.0).min(most);
    for (at, dof) in Dof::ALL.into_iter().enumerate() {
        let top = inner.top() + height * f32::from(u8::try_from(at).unwrap_or(0));
        let place = Rect::from_min_size(pos2(inner.left(), top), vec2(inner.width(), height));
        joint_ui(ui, place.shrink2(vec2(0.0, theme::STEP / 2.0)), pane, dof);
    }
}

fn joint_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, dof: Dof) {
    let look = pane.look;
    let palette = look.palette;
    let row = Row::new(dof, pane);
    let bar = rect.with_max_x(rect.left() + theme::BAR);
    ui.painter()
        .rect_filled(bar, CornerRadius::same(theme::ROUND_TINY), row.color);
    let inner = rect.with_min_x(bar.right() + theme::GAP);
    let height = inner.height() / f32::from(LINES);
    let line = |n: f32| {
        let top = inner.top() + n * height;
        Rect::from_min_max(pos2(inner.left(), top), pos2(inner.right(), top + height))
    };
    let drive = DriveWords::of(pane, dof);
    let head = line(0.0);
    let lamp = pos2(head.right() - theme::LAMP, head.center().y);
    controls::lamp(ui, lamp, drive.lamp);
    let words = head.with_max_x(lamp.x - theme::GAP);
    let name = row.named(pane, main::STATUS);
    Label::new(row.name, palette.text)
        .small()
        .put(ui, words)
        .on_hover_text(format!("{name}: {}", drive.title));
    let (angle, freshness) = newest(pane, dof, pane.state.hand().sample.angle);
    let text = format::whole(angle.map(|angle| i64::from(angle.raw())), 4);
    Label::new(&text, look.value(freshness, palette.text))
        .number()
        .right()
        .named(&row.named(pane, main::NAME_ANGLE_ACTUAL))
        .put(ui, line(1.0));
    let (force, freshness) = newest(pane, dof, pane.state.hand().sample.force);
    let text = format::with_unit(
        force.map(|force| i64::from(force.raw())),
        4,
        Quantity::Force.row().unit,
    );
    Label::new(&text, look.value(freshness, palette.text))
        .number()
        .right()
        .named(&row.named(pane, main::NAME_FORCE_ACTUAL))
        .put(ui, line(2.0));
}
