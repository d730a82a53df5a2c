//! The six joint rows: target over actual, threshold over force, speed, lamp, lock. Sends nothing by itself.

use crate::app::action::Action;
use crate::app::state::Freshness;
use crate::hand::Dof;
use crate::ui::controls::{self, Button, Label, take_right};
use crate::ui::joint_row::Row;
use crate::ui::look::Pane;
use crate::ui::text::main;
use crate::ui::{format, theme};
use egui::{Id, Rect, Ui, pos2, vec2};

/// No line of a row grows higher than this.
const LINE_MAX: f32 = 28.0;
/// No line of a row is lower than this; the list scrolls instead.
const LINE_MIN: f32 = 19.0;
/// Draws the column of joints.
pub(crate) fn joints_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let (mut head, mut rest) = controls::titled_card(ui, look, rect, look.say(main::JOINTS));
    age_ui(ui, &mut head, pane);
    let rows_height = rest.height() - theme::CONTROL_LARGE - theme::GAP;
    let fits = rows_height / 6.0 >= 3.0 * LINE_MIN + theme::GAP;
    let row_height = if fits {
        (rows_height / 6.0).min(4.0 * LINE_MAX + 2.0 * theme::GAP)
    } else {
        3.0 * LINE_MIN + theme::GAP
    };
    let list = controls::take_top(&mut rest, if fits { row_height * 6.0 } else { rows_height });
    if fits {
        rows_ui(ui, list, row_height, pane);
    } else {
        ui.scope_builder(egui::UiBuilder::new().max_rect(list), |ui| {
            egui::ScrollArea::vertical()
                .auto_shrink(false)
                .show(ui, |ui| {
                    let whole =
                        Rect::from_min_size(ui.cursor().min, vec2(list.width(), row_height * 6.0));
                    rows_ui(ui, whole, row_height, pane);
                });
        });
    }
    buttons_ui(ui, rest.with_max_y(rest.top() + theme::CONTROL_LARGE), pane);
}

fn age_ui(ui: &mut Ui, head: &mut Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let asked = pane.state.sample.angle.map(|angle| angle.asked);
    let (text, color) = match pane.freshness(asked) {
        Freshness::Live => return,
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

fn rows_ui(ui: &mut Ui, list: Rect, height: f32, pane: &mut Pane<'_>) {
    let mut top = list.top();
    for dof in Dof::ALL {
        let rect = Rect::from_min_size(pos2(list.left(), top), vec2(list.width(), height));
        Row::new(dof, pane).ui(ui, rect, pane);
        top += height;
    }
}

fn buttons_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let half = (rect.width() - theme::GAP) / 2.0;
    let (mut left, right) = rect.split_left_right_at_x(rect.left() + half);
    left.max.y = rect.bottom();
    let open = Button::new(look.say(main::OPEN), look.say(main::OPEN_TIP))
        .disabled((!pane.state.is_armed()).then(|| look.say(main::NOT_ARMED)));
    if open.put(ui, look, left, Id::unique("open all")).clicked() {
        pane.actions.push(Action::Open);
    }
    let right = right.with_min_x(right.left() + theme::GAP);
    let hold = Button::new(look.say(main::HOLD), look.say(main::HOLD_TIP));
    if hold.put(ui, look, right, Id::unique("hold")).clicked() {
        pane.actions.push(Action::Stop);
    }
}
