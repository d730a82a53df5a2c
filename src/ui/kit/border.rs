//! The border between two rooms: dragged, nudged by arrow keys, double clicked for the first size, with buttons that shut
//! a room. Also the bar that is left of a room that is shut. Decides no place.

use crate::app::action::Action;
use crate::app::layout::{Layout, Room, RoomLayout};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Weight};
use crate::ui::kit::look::Pane;
use crate::ui::text::{Text, layout, main, panels};
use crate::ui::theme::{self, Icon};
use crate::ui::window::rooms::{Border, Side, toggled};
use egui::{
    Align2, CornerRadius, CursorIcon, EventFilter, Id, Key, Rect, Response, Role, Sense, Ui,
    WidgetInfo, pos2, vec2,
};

/// What a room is called.
pub(crate) const fn title(room: Room) -> Text {
    match room {
        Room::Joints => main::JOINTS,
        Room::Side => layout::SIDE,
        Room::Tips => panels::TOUCH,
        Room::Faults => panels::FAULTS,
        Room::Strip => main::TAB_POSES,
    }
}

/// Asks for another layout.
pub(crate) fn ask(pane: &mut Pane<'_>, layout: Layout) {
    if layout != pane.state.settings.layout {
        pane.actions.push(Action::Layout(layout));
    }
}

/// The sign on a button that shuts a room at this side.
const fn away(side: Side) -> Icon {
    match side {
        Side::Left => theme::TO_LEFT,
        Side::Right => theme::TO_RIGHT,
        Side::Top => theme::TO_TOP,
        Side::Bottom => theme::TO_BOTTOM,
    }
}

/// Draws a border whose rooms are both open. Before the rooms themselves, so that their controls lie above it.
pub(crate) fn border_ui(ui: &mut Ui, pane: &mut Pane<'_>, border: &Border) {
    let upright = border.side.is_upright();
    let (reach, cursor) = if upright {
        (vec2(theme::GRASP, 0.0), CursorIcon::ResizeHorizontal)
    } else {
        (vec2(0.0, theme::GRASP), CursorIcon::ResizeVertical)
    };
    let id = Id::unique(("border", border.room));
    let response = ui.interact(border.gap.expand2(reach), id, Sense::click_and_drag());
    let name = format!(
        "{}: {}",
        pane.look.say(layout::BORDER),
        pane.look.say(title(border.room))
    );
    response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, &name));
    paint(ui, pane, border, &response);
    move_it(ui, pane, border, &response);
    response
        .on_hover_cursor(cursor)
        .on_hover_text(pane.look.say(layout::BORDER_TIP));
    let rooms: &[(Room, Side)] = match border.room {
        Room::Tips => &[(Room::Tips, Side::Top), (Room::Faults, Side::Bottom)],
        _ => &[(border.room, border.side)],
    };
    let middle = border.gap.center();
    let places: &[f32] = if rooms.len() > 1 {
        &[-0.5, 0.5]
    } else {
        &[0.0]
    };
    for ((room, side), place) in rooms.iter().zip(places) {
        let at = place * (theme::GRIP + theme::GAP);
        let (center, size) = if upright {
            (middle + vec2(0.0, at), vec2(theme::GAP, theme::GRIP))
        } else {
            (middle + vec2(at, 0.0), vec2(theme::GRIP, theme::GAP))
        };
        let grip = Rect::from_center_size(center, size);
        grip_ui(ui, pane, grip, reach, (*room, *side));
    }
}

fn paint(ui: &Ui, pane: &Pane<'_>, border: &Border, response: &Response) {
    let palette = pane.look.palette;
    if !(response.hovered() || response.dragged() || response.has_focus()) {
        return;
    }
    let line = if border.side.is_upright() {
        vec2(theme::STRONG, border.gap.height())
    } else {
        vec2(border.gap.width(), theme::STRONG)
    };
    let line = Rect::from_center_size(border.gap.center(), line);
    ui.painter()
        .rect_filled(line, CornerRadius::ZERO, palette.accent);
}

fn move_it(ui: &Ui, pane: &mut Pane<'_>, border: &Border, response: &Response) {
    let layout = pane.state.settings.layout;
    let standing = layout.room(border.room);
    let share = if response.double_clicked() {
        Some(None)
    } else if let (true, Some(pointer)) = (response.dragged(), response.interact_pointer_pos()) {
        Some(Some(border.share_at(pointer)))
    } else {
        let steps = key_steps(ui, border, response);
        (steps != 0.0).then(|| Some(border.share_grown(steps * theme::NUDGE)))
    };
    let Some(share) = share else { return };
    let open = RoomLayout {
        share: None,
        ..standing
    };
    let standing = share.map_or(open, |share| open.with_share(share));
    ask(pane, layout.with(border.room, standing));
}

/// Steps by which the room grows.
fn key_steps(ui: &Ui, border: &Border, response: &Response) -> f32 {
    if !response.has_focus() {
        return 0.0;
    }
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let (grow, shrink) = match border.side {
        Side::Left => (Key::ArrowRight, Key::ArrowLeft),
        Side::Right => (Key::ArrowLeft, Key::ArrowRight),
        Side::Top => (Key::ArrowDown, Key::ArrowUp),
        Side::Bottom => (Key::ArrowUp, Key::ArrowDown),
    };
    ui.input(|input| {
        let steps = i64::try_from(input.num_presses(grow)).unwrap_or(0)
            - i64::try_from(input.num_presses(shrink)).unwrap_or(0);
        match steps {
            0 => 0.0,
            more if more > 0 => 1.0,
            _ => -1.0,
        }
    })
}

/// The button in a border that shuts a room.
fn grip_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    grip: Rect,
    reach: egui::Vec2,
    (room, side): (Room, Side),
) {
    let look = pane.look;
    let palette = look.palette;
    let id = Id::unique(("shut", room));
    let response = ui.interact(grip.expand2(reach), id, Sense::click());
    let name = format!("{} {}", look.say(layout::SHUT), look.say(title(room)));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    let (fill, sign) = if response.hovered() || response.has_focus() {
        (palette.accent, palette.on_strong)
    } else {
        (palette.edge, palette.muted)
    };
    let painter = ui.painter();
    painter.rect_filled(grip, CornerRadius::same(theme::ROUND_SMALL), fill);
    let font = theme::icon_small();
    painter.text(grip.center(), Align2::CENTER_CENTER, away(side), font, sign);
    if response.clicked() {
        ask(pane, toggled(&pane.state.settings.layout, room));
    }
    response
        .on_hover_cursor(CursorIcon::PointingHand)
        .on_hover_text(format!("{name}\n{}", look.say(layout::SHUT_TIP)));
}

/// What is left of a room that is shut: its name, all of it one button.
pub(crate) fn shut_ui(ui: &mut Ui, pane: &mut Pane<'_>, rect: Rect, room: Room, side: Side) {
    let look = pane.look;
    let text = look.say(title(room));
    let name = format!("{} {text}", look.say(layout::OPEN));
    let button = Button::new(text, look.say(layout::OPEN_TIP))
        .named(&name)
        .weight(Weight::Normal);
    let response = button.ground(ui, look, rect, Id::unique(("open", room)));
    let sign = match side {
        Side::Left => theme::TO_RIGHT,
        Side::Right => theme::TO_LEFT,
        Side::Top => theme::TO_BOTTOM,
        Side::Bottom => theme::TO_TOP,
    };
    let painter = ui.painter();
    let color = look.palette.muted;
    if side.is_upright() {
        let at = pos2(rect.center().x, rect.top() + theme::ICON_BUTTON / 2.0);
        painter.text(at, Align2::CENTER_CENTER, sign, theme::icon(), color);
        let galley = painter.layout_no_wrap(text.to_owned(), theme::body(), color);
        let at = pos2(
            rect.center().x + galley.size().y / 2.0,
            rect.top() + theme::ICON_BUTTON + theme::GAP,
        );
        let turned = egui::epaint::TextShape::new(at, galley, color);
        painter.add(turned.with_angle(std::f32::consts::FRAC_PI_2));
    } else {
        let at = rect.right_center() - vec2(theme::PAD + theme::GAP, 0.0);
        painter.text(at, Align2::CENTER_CENTER, sign, theme::icon(), color);
        let words = rect.shrink2(vec2(theme::PAD, 0.0));
        controls::paint_text(ui, words, Align2::LEFT_CENTER, text, theme::title(), color);
    }
    if response.clicked() {
        ask(pane, toggled(&pane.state.settings.layout, room));
    }
}
