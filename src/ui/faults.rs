//! Faults with words, cause and advice, what each drive says, and messages. Clears nothing by itself.

use crate::app::action::Action;
use crate::app::faults::{FaultEntry, FaultKind};
use crate::app::notices::{Level, Notice};
use crate::app::state::Freshness;
use crate::hand::{Dof, Fault, Status};
use crate::ui::controls::{self, Button, Label, Weight, take_left, take_right};
use crate::ui::look::Pane;
use crate::ui::text::{main, notices, panels, words};
use crate::ui::{format, theme};
use egui::{Color32, Id, Rect, Ui, UiBuilder, pos2, vec2};

/// Height of a line of text in a list.
const LINE: f32 = 17.0;

/// The card of the overview: faults, then messages.
pub(crate) fn faults_card_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let (mut head, body) = controls::titled_card(ui, look, rect, look.say(panels::FAULTS));
    clear_ui(ui, &mut head, pane);
    list_ui(ui, body, pane, "faults card", &mut |ui, width, pane| {
        fault_list_ui(ui, width, pane);
        let rule = piece(ui, width, theme::GAP);
        let edge = egui::Stroke::new(1.0, look.palette.grid);
        ui.painter().hline(rule.x_range(), rule.top(), edge);
        messages_ui(ui, width, pane);
    });
}

fn messages_ui(ui: &mut Ui, width: f32, pane: &mut Pane<'_>) {
    if pane.state.notices.is_empty() {
        let look = pane.look;
        line_ui(
            ui,
            width,
            look.say(panels::MESSAGES_NONE),
            look.palette.faint,
        );
    }
    for notice in pane.state.notices.iter() {
        notice_ui(ui, width, pane, notice);
    }
}

/// The view of its own: faults and messages left, the drives' statuses right.
pub(crate) fn faults_view_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let (left, right) = rect.split_left_right_at_x(rect.left() + rect.width() * 0.56);
    let left = left.with_max_x(left.right() - theme::GAP);
    let (upper, lower) = left.split_top_bottom_at_y(left.top() + left.height() * 0.56);
    let upper = upper.with_max_y(upper.bottom() - theme::GAP);
    let (mut head, body) = controls::titled_card(ui, look, upper, look.say(panels::FAULTS));
    clear_ui(ui, &mut head, pane);
    forget_ui(ui, &mut head, pane);
    list_ui(ui, body, pane, "faults", &mut fault_list_ui);
    let (_, body) = controls::titled_card(ui, look, lower, look.say(panels::MESSAGES));
    list_ui(ui, body, pane, "messages", &mut messages_ui);
    let (_, body) = controls::titled_card(ui, look, right, look.say(panels::STATUS_LIST));
    list_ui(ui, body, pane, "statuses", &mut |ui, width, pane| {
        for dof in Dof::ALL {
            status_ui(ui, width, pane, dof);
        }
    });
}

type Lines<'a> = &'a mut dyn FnMut(&mut Ui, f32, &mut Pane<'_>);

/// A list that scrolls inside its place.
fn list_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, salt: &str, lines: Lines<'_>) {
    ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt(salt), |ui| {
        ui.shrink_clip_rect(rect);
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| lines(ui, rect.width() - theme::GAP, pane));
    });
}

fn clear_ui(ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let text = look.say(panels::CLEAR);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let place = take_right(head, width);
    let live = pane.state.link.state.is_live();
    let button = Button::new(text, look.say(panels::CLEAR_TIP))
        .disabled((!live).then(|| look.say(panels::NOT_LIVE)));
    if button
        .put(ui, look, place, Id::unique("clear errors"))
        .clicked()
    {
        pane.actions.push(Action::ClearErrors);
    }
}

fn forget_ui(ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let text = look.say(panels::FORGET);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let place = take_right(head, width);
    let any = pane.state.faults.iter().any(|entry| entry.until.is_some());
    let button = Button::new(text, look.say(panels::FORGET_TIP))
        .weight(Weight::Quiet)
        .disabled((!any).then(|| look.say(panels::FORGET_NONE)));
    if button
        .put(ui, look, place, Id::unique("forget faults"))
        .clicked()
    {
        pane.actions.push(Action::ForgetFaults);
    }
}

/// A piece of the list of the given height.
fn piece(ui: &mut Ui, width: f32, height: f32) -> Rect {
    ui.allocate_space(vec2(width, height)).1
}

fn line_ui(ui: &mut Ui, width: f32, text: &str, color: Color32) {
    let place = piece(ui, width, LINE);
    Label::new(text, color).small().put(ui, place);
}

/// Text over as many lines as it needs.
fn wrapped_ui(ui: &mut Ui, width: f32, indent: f32, text: &str, color: Color32) {
    let galley = ui
        .painter()
        .layout(text.to_owned(), theme::small(), color, width - indent);
    let place = piece(ui, width, galley.size().y + 2.0);
    let response = ui.interact(place, ui.next_auto_id().with(text), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, text));
    ui.painter()
        .galley(pos2(place.left() + indent, place.top()), galley, color);
}

fn fault_list_ui(ui: &mut Ui, width: f32, pane: &mut Pane<'_>) {
    let look = pane.look;
    let entries: Vec<FaultEntry> = pane.state.faults.iter().copied().collect();
    if entries.is_empty() {
        let asked = pane.state.sample.faults.map(|faults| faults.asked);
        let (text, color) = match pane.freshness(asked) {
            Freshness::Live => (panels::FAULTS_NONE, look.palette.ok),
            Freshness::Stale => (panels::FAULTS_NONE_OLD, look.palette.faint),
            Freshness::Unknown => (panels::FAULTS_UNKNOWN, look.palette.faint),
        };
        let place = piece(ui, width, LINE + 3.0);
        controls::lamp(ui, pos2(place.left() + 6.0, place.center().y), color);
        let place = place.with_min_x(place.left() + 17.0);
        Label::new(look.say(text), look.palette.muted).put(ui, place);
        wrapped_ui(
            ui,
            width,
            17.0,
            look.say(panels::FAULTS_NONE_HINT),
            look.palette.faint,
        );
        piece(ui, width, theme::GAP);
    }
    for entry in &entries {
        fault_ui(ui, width, pane, entry);
    }
}

fn fault_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, entry: &FaultEntry) {
    let look = pane.look;
    let palette = look.palette;
    let mut row = piece(ui, width, LINE + 3.0);
    let now = entry.until.is_none();
    let color = if now { palette.bad } else { palette.faint };
    controls::lamp(ui, pos2(row.left() + 6.0, row.center().y), color);
    row.min.x += 17.0;
    let when = match entry.until {
        None => {
            let lasted = format::age(pane.state.now.since(entry.since));
            format!("{} {lasted}", look.say(panels::FAULT_FOR))
        }
        Some(until) => {
            let ago = format::age(pane.state.now.since(until));
            format!(
                "{}, {ago} {}",
                look.say(panels::FAULT_OVER),
                look.say(panels::FAULT_AGO)
            )
        }
    };
    let when_width = controls::text_width(ui, &when, theme::small()) + 1.0;
    let place = take_right(&mut row, when_width);
    Label::new(&when, palette.muted)
        .small()
        .right()
        .put(ui, place);
    let words = notices::fault_kind(entry.what, look.language);
    let title = format!("{}: {}", look.say(words::dof(entry.dof)), words.title);
    let title_color = if now { palette.text } else { palette.muted };
    Label::new(&title, title_color).put(ui, row);
    if now {
        let text = format!("{} {}", words.cause, words.advice);
        wrapped_ui(ui, width, 17.0, &text, palette.muted);
        if entry.what == FaultKind::Fault(Fault::OverTemperature) {
            let text = look.say(panels::OVER_TEMPERATURE_STAYS);
            wrapped_ui(ui, width, 17.0, text, palette.warn);
        }
    }
    piece(ui, width, theme::STEP);
}

fn status_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, dof: Dof) {
    let look = pane.look;
    let palette = look.palette;
    let group = pane.state.sample.status;
    let freshness = pane.freshness(group.map(|group| group.asked));
    let mut row = piece(ui, width, LINE + 3.0);
    let name = take_left(&mut row, 96.0);
    Label::new(look.say(words::dof(dof)), palette.dof[dof]).put(ui, name);
    let Some(status) = group.map(|group| group.value[dof]) else {
        Label::new(format::UNKNOWN, palette.faint).put(ui, row);
        return;
    };
    let words = words::status(status, look.language);
    let live = if status.is_protective() {
        palette.bad
    } else {
        palette.text
    };
    let code = take_right(&mut row, 32.0);
    Label::new(&status.raw().to_string(), palette.faint)
        .number()
        .right()
        .put(ui, code);
    Label::new(words.title, look.value(freshness, live)).put(ui, row);
    wrapped_ui(ui, width, 96.0 + theme::GAP, words.cause, palette.muted);
    let well = matches!(
        status,
        Status::Releasing | Status::Grasping | Status::PositionReached
    );
    if !well {
        wrapped_ui(ui, width, 96.0 + theme::GAP, words.advice, palette.muted);
    }
    piece(ui, width, theme::PAD);
}

fn notice_ui(ui: &mut Ui, width: f32, pane: &mut Pane<'_>, notice: &Notice) {
    let look = pane.look;
    let palette = look.palette;
    let color = match notice.level {
        Level::Info => palette.accent,
        Level::Warn => palette.warn,
        Level::Alarm => palette.bad,
    };
    let mut text = notices::notice(look, &notice.what);
    if notice.count > 1 {
        text = format!("{text} ({} ×)", notice.count);
    }
    // Lamp, age and cross stand beside the text, whatever lines it needs.
    let (indent, aside) = (17.0, 20.0 + 48.0 + 2.0 * theme::GAP);
    let galley = ui.painter().layout(
        text.clone(),
        theme::small(),
        palette.text,
        (width - indent - aside).max(40.0),
    );
    let place = piece(ui, width, (galley.size().y + 6.0).max(LINE + 5.0));
    let mut row = place.with_max_y(place.top() + LINE + 5.0);
    controls::lamp(ui, pos2(row.left() + 6.0, row.center().y), color);
    let response = ui.interact(
        place,
        Id::unique(("notice", notice.id)),
        egui::Sense::hover(),
    );
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
    ui.painter().galley(
        pos2(row.left() + indent, row.top() + 3.0),
        galley,
        palette.text,
    );
    let close = controls::middle(take_right(&mut row, 20.0), 20.0);
    let name = format!("{}: {text}", look.say(main::DISMISS));
    let button = Button::new("×", look.say(main::DISMISS_TIP))
        .named(&name)
        .weight(Weight::Quiet);
    let id = Id::unique(("dismiss", notice.id));
    if button.put(ui, look, close, id).clicked() {
        pane.actions.push(Action::Dismiss(notice.id));
    }
    let age = format::age(pane.state.now.since(notice.at));
    let place = take_right(&mut row, 48.0);
    Label::new(&age, palette.faint)
        .small()
        .right()
        .put(ui, place);
}
