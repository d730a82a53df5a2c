//! One fault as a person reads it: what, since when, why, what to do, and whether clearing errors can help. Clears nothing.

use crate::app::action::Action;
use crate::app::hand::Freshness;
use crate::app::readings::cooling;
use crate::app::readings::cooling::{Course, Goal, Source};
use crate::app::readings::fault_recorder::RecordingId;
use crate::app::readings::faults::{FaultEntry, FaultKind};
use crate::hand::{Dof, Fault};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_right};
use crate::ui::kit::format;
use crate::ui::kit::list::{INDENT, LAMP_AT, TITLE_LINE, piece, wrapped_ui};
use crate::ui::kit::look::Pane;
use crate::ui::text::{Text, faults, notices, words};
use crate::ui::theme;
use egui::{CornerRadius, Id, Shape, Ui, epaint::RectShape, pos2, vec2};
use std::time::Duration;

/// How much is said of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Depth {
    /// In the overview: what and what to do.
    Short,
    /// Everything.
    Whole,
    /// Everything, and it stands out: it was asked for.
    Chosen,
}

/// Draws one entry of the list; the recording of it that is to be opened.
pub(crate) fn entry_ui(
    ui: &mut Ui,
    width: f32,
    pane: &mut Pane<'_>,
    entry: &FaultEntry,
    depth: Depth,
) -> Option<RecordingId> {
    let look = pane.look;
    let palette = look.palette;
    let ground = ui.painter().add(Shape::Noop);
    let top = ui.cursor().top();
    let left = ui.cursor().left();
    title_ui(ui, width, pane, entry);
    let quiet = !entry.is_active() && entry.seen;
    let said = notices::fault_kind(entry.what, look.language);
    if !quiet || depth == Depth::Chosen {
        wrapped_ui(ui, width, INDENT, said.cause, palette.muted);
        let advice = format!("{} {}", look.say(faults::TODO), said.advice);
        wrapped_ui(ui, width, INDENT, &advice, palette.text);
    }
    if entry.is_active() {
        clear_words_ui(ui, width, pane, entry);
    }
    let asked = if depth == Depth::Short {
        None
    } else {
        foot_ui(ui, width, pane, entry)
    };
    if depth == Depth::Chosen {
        let place = egui::Rect::from_min_max(
            pos2(left - theme::STEP, top - theme::STEP / 2.0),
            pos2(
                left + width + theme::STEP,
                ui.cursor().top() + theme::STEP / 2.0,
            ),
        );
        let fill = palette.wash(palette.accent);
        let shape = RectShape::filled(place, CornerRadius::same(theme::ROUND_SMALL), fill);
        ui.painter().set(ground, shape);
    }
    piece(ui, width, theme::GAP);
    asked
}

/// Times, and the way to the recording of it, if there is one.
fn foot_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, entry: &FaultEntry) -> Option<RecordingId> {
    let look = pane.look;
    let text = times(pane, entry);
    let recorder = &pane.state.hand().recorder;
    let Some(recording) = recorder.of(entry.dof, entry.what, entry.since) else {
        if !text.is_empty() {
            wrapped_ui(ui, width, INDENT, &text, look.palette.faint);
        }
        return None;
    };
    let mut row = piece(ui, width, theme::CONTROL);
    row.min.x += INDENT;
    let words = look.say(faults::RECORDING);
    let wide = controls::text_width(ui, words, theme::body()) + 2.0 * theme::GAP;
    let name = format!("{words}: {}", title(pane, entry.dof, entry.what));
    let button = Button::new(words, look.say(faults::RECORDING_OPEN_TIP)).named(&name);
    let place = controls::middle(take_right(&mut row, wide), theme::CONTROL - 2.0);
    let id = Id::unique(("recording of", entry.dof, entry.what));
    let pressed = button.put(ui, look, place, id).clicked();
    Label::new(&text, look.palette.faint).small().put(ui, row);
    pressed.then_some(recording.id)
}

/// Lamp, joint and fault; whether it lasts; the button of one who has seen it.
fn title_ui(ui: &mut Ui, width: f32, pane: &mut Pane<'_>, entry: &FaultEntry) {
    let look = pane.look;
    let palette = look.palette;
    let height = if entry.seen {
        TITLE_LINE
    } else {
        theme::CONTROL
    };
    let mut row = piece(ui, width, height);
    let (word, color) = stand(pane, entry);
    let lamp_at = pos2(row.left() + LAMP_AT, row.center().y);
    if entry.is_active() {
        controls::lamp(ui, lamp_at, color);
    } else {
        mark(ui, lamp_at, color);
    }
    row.min.x += INDENT;
    let title = title(pane, entry.dof, entry.what);
    if !entry.seen {
        seen_ui(ui, &mut row, pane, entry, &title);
    }
    let when = format::age(entry.lasted(pane.state.now));
    let word = match entry.until {
        None => format!("{}, {when}", look.say(word)),
        Some(_) => look.say(word).to_owned(),
    };
    let word_width = controls::text_width(ui, &word, theme::small()) + 1.0;
    let title_width = controls::text_width(ui, &title, theme::body()) + theme::GAP;
    let beside = title_width + word_width <= row.width();
    if beside {
        let place = take_right(&mut row, word_width);
        Label::new(&word, color).small().right().put(ui, place);
    }
    let title_color = if entry.is_active() || !entry.seen {
        palette.text
    } else {
        palette.muted
    };
    Label::new(&title, title_color).put(ui, row);
    if !beside {
        wrapped_ui(ui, width, INDENT, &word, color);
    }
}

fn seen_ui(
    ui: &mut Ui,
    row: &mut egui::Rect,
    pane: &mut Pane<'_>,
    entry: &FaultEntry,
    title: &str,
) {
    let look = pane.look;
    let text = look.say(faults::SEEN);
    let button_width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
    let name = format!("{text}: {title}");
    let button = Button::new(text, look.say(faults::SEEN_TIP)).named(&name);
    let place = controls::middle(take_right(row, button_width), theme::CONTROL - 2.0);
    let id = Id::unique(("seen", entry.dof, entry.what));
    if button.put(ui, look, place, id).clicked() {
        pane.actions.push(Action::SeenFault(entry.dof, entry.what));
    }
}

/// Joint and fault.
pub(crate) fn title(pane: &Pane<'_>, dof: Dof, what: FaultKind) -> String {
    let words = notices::fault_kind(what, pane.look.language);
    format!("{}: {}", pane.look.say(words::dof(dof)), words.title)
}

/// Whether it lasts, and the colour of that.
fn stand(pane: &Pane<'_>, entry: &FaultEntry) -> (Text, egui::Color32) {
    let palette = pane.look.palette;
    let sample = &pane.state.hand().sample;
    let asked = match entry.what {
        FaultKind::Fault(_) => sample.faults.map(|group| group.asked),
        FaultKind::Status(_) => sample.status.map(|group| group.asked),
    };
    match (entry.is_active(), entry.seen) {
        (true, _) if pane.freshness(asked) != Freshness::Live => (faults::WHEN_READ, palette.faint),
        (true, _) => (faults::NOW, palette.bad),
        (false, false) => (faults::OVER_UNSEEN, palette.warn),
        (false, true) => (faults::OVER, palette.faint),
    }
}

/// A ring: something was wrong and is not any more.
pub(crate) fn mark(ui: &Ui, center: egui::Pos2, color: egui::Color32) {
    let stroke = egui::Stroke::new(theme::RING_LINE, color);
    ui.painter()
        .circle_stroke(center, theme::LAMP - 0.5, stroke);
}

/// When it began, how long it lasted, how often it came: what the title does not say already.
fn times(pane: &Pane<'_>, entry: &FaultEntry) -> String {
    let look = pane.look;
    let now = pane.state.now;
    let mut parts = Vec::new();
    if entry.until.is_some() {
        let (began, ago) = (look.say(faults::BEGAN), look.say(faults::AGO));
        let age = format::age(now.since(entry.since));
        let lasted = format::age(entry.lasted(now));
        parts.push(format!("{began} {age} {ago}"));
        parts.push(format!("{} {lasted}", look.say(faults::LASTED)));
    }
    if entry.count > 1 {
        let (came, times) = (look.say(faults::CAME), look.say(faults::TIMES));
        parts.push(format!("{came} {} {times}", entry.count));
    }
    parts.join(" · ")
}

/// Whether CLEAR_ERROR ends it; for heat, how long cooling takes.
fn clear_words_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, entry: &FaultEntry) {
    let look = pane.look;
    let (text, color) = match (entry.what.clearable(), entry.what) {
        (Some(true), _) => (faults::CLEAR_HELPS, look.palette.muted),
        (Some(false), _) => (faults::CLEAR_CANNOT, look.palette.warn),
        (None, FaultKind::Status(_)) => (faults::CLEAR_FOLLOWS, look.palette.muted),
        (None, FaultKind::Fault(_)) => (faults::CLEAR_UNSAID, look.palette.warn),
    };
    wrapped_ui(ui, width, INDENT, look.say(text), color);
    if entry.what == FaultKind::Fault(Fault::OverTemperature) {
        let (text, tip) = cooling_words(pane, entry.dof);
        wrapped_ui(ui, width, INDENT, &text, look.palette.text).on_hover_text(tip);
        wrapped_ui(ui, width, INDENT, tip, look.palette.faint);
    }
}

/// How warm the drive is and when it may work again; what that rests on.
fn cooling_words(pane: &Pane<'_>, dof: Dof) -> (String, &'static str) {
    let look = pane.look;
    let state = pane.state;
    let goal = Goal::of(state.hand().faults.worked_again_c(dof));
    let celsius = state
        .hand()
        .sample
        .temperature
        .map(|all| all.value[dof].raw());
    let celsius = format::whole(celsius.map(i64::from), 0);
    let until = format!("{:.0} °C", goal.celsius);
    let more = match cooling::course(&state.hand().history, dof, state.now.secs(), goal) {
        Course::Falling { left } if left >= cooling::LONGEST => {
            format!("{} {until}", look.say(faults::COOL_LONG))
        }
        Course::Falling { left } => format!(
            "{} {} {} {until}",
            look.say(faults::COOL_IN),
            rough(left),
            look.say(faults::COOL_TO)
        ),
        Course::NotFalling => look.say(faults::COOL_NOT).into(),
        Course::Unknown => look.say(faults::COOL_UNKNOWN).into(),
        Course::Reached => look.say(faults::COOL_THERE).into(),
    };
    let tip = match goal.source {
        Source::Assumed => faults::COOL_ASSUMED,
        Source::Observed => faults::COOL_OBSERVED,
    };
    let text = format!("{} {celsius} °C · {more}", look.say(faults::COOL_NOW));
    (text, look.say(tip))
}

/// A time that is only estimated: no finer than it can be known.
fn rough(left: Duration) -> String {
    let seconds = left.as_secs_f64();
    if seconds < 90.0 {
        format!("{:.0} s", ((seconds / 5.0).ceil() * 5.0).max(5.0))
    } else {
        format!("{:.0} min", (seconds / 60.0).ceil())
    }
}

/// How many faults nobody has seen, as a small badge with its right top corner here.
pub(crate) fn badge_ui(ui: &Ui, corner: egui::Pos2, pane: &Pane<'_>) {
    let Some(color) = unseen_color(pane) else {
        return;
    };
    let count = pane.state.hand().faults.unseen().count().to_string();
    let width =
        (controls::text_width(ui, &count, theme::tiny()) + theme::GAP).max(theme::FAULT_BADGE);
    let place =
        egui::Rect::from_min_size(corner - vec2(width, 0.0), vec2(width, theme::FAULT_BADGE));
    ui.painter()
        .rect_filled(place, theme::FAULT_BADGE / 2.0, color);
    let (font, ink) = (theme::tiny(), pane.look.palette.window);
    controls::paint_text(ui, place, egui::Align2::CENTER_CENTER, &count, font, ink);
}

/// The colour of what nobody has seen: loud while it lasts. `None` if all was seen.
pub(crate) fn unseen_color(pane: &Pane<'_>) -> Option<egui::Color32> {
    let palette = pane.look.palette;
    let mut unseen = pane.state.hand().faults.unseen();
    let first = unseen.next()?;
    // What lasts comes first.
    Some(if first.is_active() {
        palette.bad
    } else {
        palette.warn
    })
}

/// Marks all as seen.
pub(crate) fn seen_all_ui(ui: &mut Ui, head: &mut egui::Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let text = look.say(faults::SEEN_ALL);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let place = take_right(head, width);
    let none = pane.state.hand().faults.unseen().next().is_none();
    let button = Button::new(text, look.say(faults::SEEN_ALL_TIP))
        .weight(Weight::Normal)
        .disabled(none.then(|| look.say(faults::SEEN_NONE)));
    let id = Id::unique("seen all");
    if button.put(ui, look, place, id).clicked() {
        pane.actions.push(Action::SeenFaults);
    }
}
