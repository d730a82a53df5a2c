//! One fault in the list: name, duration, cause, advice, and whether clearing errors can help. Clears nothing.

use crate::app::action::Action;
use crate::app::readings::Freshness;
use crate::app::readings::fault_recorder::FaultRecordingId;
use crate::app::readings::faults::{FaultEntry, FaultKind};
use crate::hand::Dof;
use crate::ui::kit::{self, Button, Label, Pane, format};
use crate::ui::recordings::stretch::ReplayedStretch;
use crate::ui::text::{Text, notices, words};
use crate::ui::theme;
use egui::{
    Color32, CornerRadius, Frame, Margin, Pos2, Rect, Response, Role, ScrollArea, Sense, Stroke,
    Ui, Vec2, WidgetInfo, vec2,
};
use std::time::Duration;

/// Replayed duration of a fault that persists.
const SHOWN: Duration = Duration::from_secs(10);
/// Replayed time after a fault.
const AFTER: Duration = Duration::from_secs(2);

/// Indent of the content below a title line.
const INSET: Margin = Margin {
    left: 20,
    ..Margin::ZERO
};

/// Emphasis of an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Depth {
    Whole,
    /// Highlighted: the user selected its joint.
    Chosen,
}

/// Entries of a list. They keep their order while the pointer is over it; new ones are appended.
pub(crate) fn steady(
    ui: &Ui,
    pane: &Pane<'_>,
    wanted: impl Fn(&FaultEntry) -> bool,
) -> Vec<FaultEntry> {
    let faults = pane.hand().readings.faults.iter();
    let mut entries: Vec<FaultEntry> = faults.copied().filter(|entry| wanted(entry)).collect();
    let place = ui.scope_id().with("order");
    let seen = Rect::from_x_y_ranges(ui.max_rect().x_range(), ui.clip_rect().y_range());
    if ui.rect_contains_pointer(seen) {
        let before: Vec<(Dof, FaultKind)> =
            ui.data(|data| data.get_temp(place)).unwrap_or_default();
        let at = |entry: &FaultEntry| before.iter().position(|it| *it == (entry.dof, entry.what));
        entries.sort_by_key(|entry| at(entry).unwrap_or(usize::MAX));
    }
    let order: Vec<(Dof, FaultKind)> = entries
        .iter()
        .map(|entry| (entry.dof, entry.what))
        .collect();
    ui.data_mut(|data| data.insert_temp(place, order));
    entries
}

/// Draws one entry of the list. Returns its recording, if the user opens it.
pub(crate) fn entry_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    entry: &FaultEntry,
    depth: Depth,
) -> Option<FaultRecordingId> {
    let look = pane.look;
    let palette = look.palette;
    let mut ground = Frame::new().corner_radius(CornerRadius::same(theme::ROUND_SMALL));
    if depth == Depth::Chosen {
        ground = ground.fill(palette.wash(palette.accent));
    }
    let shown = ground.show(ui, |ui| {
        title_ui(ui, pane, entry);
        inset_ui(ui, |ui| {
            if entry.is_active() || !entry.seen || depth == Depth::Chosen {
                let words = notices::fault_kind(entry.what, look.language);
                kit::small_text_ui(ui, words.cause, palette.muted);
                let advice = look.tr_with(notices::TODO, words.advice);
                kit::small_text_ui(ui, &advice, palette.text);
            }
            foot_ui(ui, pane, entry)
        })
    });
    ui.add_space(theme::STEP);
    shown.inner
}

/// Draws content indented below a title with a lamp.
pub(crate) fn inset_ui<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let frame = Frame::new().inner_margin(INSET);
    frame.show(ui, |ui| ui.vertical(add).inner).inner
}

/// A scrollable list over the remaining space.
pub(crate) fn scroll_ui(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let scroll = ScrollArea::vertical()
        .auto_shrink(false)
        .min_scrolled_height(0.0);
    scroll.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = theme::STEP / 2.0;
        // The scroll bar would cover the end of the rows.
        ui.set_max_width(ui.available_width() - theme::GAP);
        add(ui);
    });
}

/// Draws lamp, joint, fault and state, and the button that marks it as seen.
fn title_ui(ui: &mut Ui, pane: &mut Pane<'_>, entry: &FaultEntry) {
    let look = pane.look;
    let palette = look.palette;
    let (word, color) = fault_state(pane, entry);
    ui.horizontal_wrapped(|ui| {
        let at = kit::lamp_ui(ui, entry.is_active().then_some(color));
        if !entry.is_active() {
            mark(ui, at, color);
        }
        let title = title(pane, entry.dof, entry.what);
        let ink = if entry.is_active() || !entry.seen {
            palette.text
        } else {
            palette.muted
        };
        Label::new(&title, ink).ui(ui);
        // Before the parts that change, so that it does not move.
        if !entry.seen {
            let text = look.tr(notices::SEEN);
            let name = format!("{text}: {title}");
            let button = Button::new(text, look.tip(notices::SEEN)).named(&name);
            button.on_click(ui, pane, Action::SeenFault(entry.dof, entry.what));
        }
        let when = format::age(entry.lasted(pane.state.now));
        let word = match entry.until {
            None => format!("{}, {when}", look.tr(word)),
            Some(_) => look.tr(word).to_owned(),
        };
        Label::new(&word, color).small().ui(ui);
    });
}

/// Draws the times, and the button that opens its recording, if there is one.
fn foot_ui(ui: &mut Ui, pane: &mut Pane<'_>, entry: &FaultEntry) -> Option<FaultRecordingId> {
    let look = pane.look;
    let text = times(pane, entry);
    let recorder = &pane.hand().measured.recorder;
    let recording = recorder.of(entry.dof, entry.what, entry.since);
    let mut replay = None;
    let pressed = ui.horizontal_wrapped(|ui| {
        if !text.is_empty() {
            kit::small_text_ui(ui, &text, look.palette.muted);
        }
        let recording = recording.filter(|_| {
            let words = look.tr(notices::RECORDING);
            let name = format!("{words}: {}", title(pane, entry.dof, entry.what));
            let button = Button::new(words, look.tip(notices::RECORDING_OPEN));
            button.named(&name).ui(ui, look).clicked()
        });
        let hand = pane.hand().connection.endpoint.as_ref();
        let hand = hand.map(ToString::to_string);
        let last = entry.last.min(entry.since.plus(SHOWN));
        let stretch = ReplayedStretch {
            title: &title(pane, entry.dof, entry.what),
            hand: &hand.unwrap_or_default(),
            stretch: Some((entry.since, last.plus(AFTER))),
        };
        replay = stretch.ui(ui, pane);
        recording
    });
    pane.actions.extend(replay.map(Action::Recording));
    pressed.inner.map(|recording| recording.id)
}

pub(crate) fn title(pane: &Pane<'_>, dof: Dof, what: FaultKind) -> String {
    let words = notices::fault_kind(what, pane.look.language);
    format!("{}: {}", pane.look.tr(words::dof(dof)), words.title)
}

/// State of a fault, active or past, with its colour.
fn fault_state(pane: &Pane<'_>, entry: &FaultEntry) -> (Text, egui::Color32) {
    let palette = pane.look.palette;
    let sample = &pane.hand().readings.sample;
    let asked = match entry.what {
        FaultKind::Fault(_) => sample.faults.map(|group| group.asked),
        FaultKind::Status(_) => sample.status.map(|group| group.asked),
    };
    match (entry.is_active(), entry.seen) {
        (true, _) if pane.freshness(asked) != Freshness::Live => {
            (notices::WHEN_READ, palette.faint)
        }
        (true, _) => (notices::NOW, palette.bad),
        (false, false) => (notices::OVER_UNSEEN, palette.warn),
        (false, true) => (notices::OVER, palette.faint),
    }
}

/// Draws a ring: a past fault.
pub(crate) fn mark(ui: &Ui, center: egui::Pos2, color: egui::Color32) {
    let stroke = egui::Stroke::new(1.6, color);
    ui.painter()
        .circle_stroke(center, theme::LAMP - 0.5, stroke);
}

/// Draws a ring if this joint has unseen faults.
pub(crate) fn unseen_mark_ui(ui: &mut Ui, pane: &Pane<'_>, dof: Dof) {
    let Some(first) = unseen_of(pane, dof) else {
        return;
    };
    let (place, response) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
    mark(ui, place.center(), unseen_color_of(pane, first));
    name_unseen(pane, &response, first);
}

/// Draws a ring around the lamp at this position if the joint has unseen faults: where a row is narrow.
pub(crate) fn unseen_ring_ui(ui: &mut Ui, pane: &Pane<'_>, dof: Dof, lamp: Pos2) {
    let id = ui.next_auto_id();
    ui.skip_ahead_auto_ids(1);
    let Some(first) = unseen_of(pane, dof) else {
        return;
    };
    let radius = theme::LAMP + theme::HALO;
    let stroke = Stroke::new(1.6, unseen_color_of(pane, first));
    ui.painter().circle_stroke(lamp, radius, stroke);
    let place = Rect::from_center_size(lamp, Vec2::splat(2.0 * radius));
    name_unseen(pane, &ui.interact(place, id, Sense::hover()), first);
}

fn unseen_of<'a>(pane: &Pane<'a>, dof: Dof) -> Option<&'a FaultEntry> {
    let mut unseen = pane.hand().readings.faults.unseen();
    unseen.find(|entry| entry.dof == dof)
}

const fn unseen_color_of(pane: &Pane<'_>, entry: &FaultEntry) -> Color32 {
    let palette = pane.look.palette;
    if entry.is_active() {
        palette.bad
    } else {
        palette.warn
    }
}

fn name_unseen(pane: &Pane<'_>, response: &Response, first: &FaultEntry) {
    let dof = first.dof;
    let joint = pane.look.tr(words::dof(dof));
    let name = format!("{joint} {}", pane.look.tr(notices::UNSEEN_MARK));
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    let tip = title(pane, dof, first.what);
    response
        .clone()
        .on_hover_text(format!("{tip}\n{}", pane.look.tr(notices::OVER_UNSEEN)));
}

/// Start, duration and count, as far as the title does not include them.
fn times(pane: &Pane<'_>, entry: &FaultEntry) -> String {
    let look = pane.look;
    let now = pane.state.now;
    let mut parts = Vec::new();
    if entry.until.is_some() {
        let age = format::age(now.since(entry.since));
        let lasted = format::age(entry.lasted(now));
        parts.push(look.fill(notices::BEGAN, &[&age]));
        parts.push(look.tr_with(notices::LASTED, lasted));
    }
    if entry.count > 1 {
        parts.push(look.fill(notices::CAME, &[&entry.count]));
    }
    parts.join(" · ")
}

/// Colour of the unseen faults: conspicuous while one is active. `None` if all were seen.
pub(crate) fn unseen_color(pane: &Pane<'_>) -> Option<Color32> {
    // Active faults come first.
    let first = pane.hand().readings.faults.unseen().next()?;
    Some(unseen_color_of(pane, first))
}

/// Draws the button that marks all faults as seen.
pub(crate) fn seen_all_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let none = pane.hand().readings.faults.unseen().next().is_none();
    let button = Button::text(look, notices::SEEN_ALL);
    let button = button.disabled_if(none, look.tr(notices::SEEN_NONE));
    button.on_click(ui, pane, Action::SeenFaults);
}
