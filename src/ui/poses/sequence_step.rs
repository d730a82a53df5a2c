//! One step of a sequence as a row: its pose, its times and its place. Every change is an action.

use crate::app::action::Action;
use crate::hand::Speed;
use crate::poses::edit::{LibraryEdit, SequenceEdit, Way};
use crate::poses::library::{Millis, Sequence, Step};
use crate::ui::hand::panel;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left, take_right};
use crate::ui::kit::look::Pane;
use crate::ui::kit::number::NumberField;
use crate::ui::kit::reorder;
use crate::ui::poses::editor::whole;
use crate::ui::poses::tiles::shares;
use crate::ui::text::{Text, poses};
use crate::ui::theme;
use egui::{Id, Rect, Ui, vec2};

/// Asks for a change of this sequence.
pub(crate) fn change(pane: &mut Pane<'_>, sequence: &Sequence, edit: SequenceEdit) {
    let edit = LibraryEdit::Sequence(sequence.id, edit);
    pane.actions.push(Action::Library(edit));
}

/// The step that is shown or run now.
pub(crate) fn step_now(pane: &Pane<'_>, sequence: &Sequence) -> Option<usize> {
    let book = &pane.state.poses;
    if let Some(preview) = book
        .preview
        .as_ref()
        .filter(|own| own.sequence == sequence.id)
    {
        return Some(preview.at(pane.state.now).step);
    }
    let run = pane.state.hand().sequence.as_ref();
    let run = run.filter(|run| run.sequence == sequence.id)?;
    run.is_running().then_some(run.view.at)
}

/// Draws the row of one step.
pub(crate) fn step_ui(
    ui: &mut Ui,
    mut row: Rect,
    pane: &mut Pane<'_>,
    sequence: &Sequence,
    (at, step): (usize, &Step),
) {
    let look = pane.look;
    let number = (at + 1).to_string();
    let lit = step_now(pane, sequence) == Some(at);
    let fill = if lit {
        look.palette.wash(look.palette.accent)
    } else {
        look.palette.sunken
    };
    ui.painter()
        .rect_filled(row, f32::from(theme::ROUND_SMALL), fill);
    row = row.shrink2(vec2(theme::STEP, 0.0));
    let id = |part: &'static str| Id::unique((sequence.id, at, part));
    for (text, caption, tip, edit) in [
        (
            "x",
            poses::REMOVE,
            poses::REMOVE_TIP,
            SequenceEdit::Remove(at),
        ),
        (
            ">",
            poses::LATER,
            poses::SHIFT_TIP,
            SequenceEdit::Shift(at, Way::Later),
        ),
        (
            "<",
            poses::EARLIER,
            poses::SHIFT_TIP,
            SequenceEdit::Shift(at, Way::Earlier),
        ),
    ] {
        let label = format!("{} {number}", look.say(caption));
        let button = Button::new(text, look.say(tip)).named(&label);
        let place = controls::middle(take_right(&mut row, theme::STEP_HANDLE), theme::CONTROL);
        row.max.x += theme::STEP;
        if button.put(ui, look, place, id(caption.en)).clicked() {
            change(pane, sequence, edit);
        }
    }
    numbers_ui(ui, &mut row, pane, sequence, (at, step));
    let pose = pane.state.poses.library.pose(step.pose);
    if let Some(pose) = pose {
        handle_ui(ui, row, pane, sequence, (at, &pose.name));
        let picture = take_left(&mut row, theme::STEP_ROW);
        panel::pose_ui(ui, look, picture.shrink(2.0), &shares(&pose.angles));
        let text = format!("{number}  {}", pose.name);
        Label::new(&text, look.palette.text).put(ui, row);
    }
}

/// The part of a row that takes the keyboard and the pointer for putting the step elsewhere.
fn handle_ui(
    ui: &Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    sequence: &Sequence,
    (at, name): (usize, &str),
) {
    let look = pane.look;
    let id = |at: usize| Id::unique((sequence.id, at, "handle"));
    let response = ui.interact(rect, id(at), egui::Sense::click());
    let label = format!("{} {}: {name}", look.say(poses::STEP_NAME), at + 1);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
    controls::focus_ring(ui, look, &response, rect.shrink(2.0));
    if response.clicked() {
        response.request_focus();
    }
    if let Some(way) = reorder::keyed(ui, &response) {
        let to = match way {
            Way::Earlier => at.saturating_sub(1),
            Way::Later => (at + 1).min(sequence.steps.len().saturating_sub(1)),
        };
        // The keyboard goes with the step.
        ui.memory_mut(|memory| memory.request_focus(id(to)));
        change(pane, sequence, SequenceEdit::Move(at, to));
    }
    response
        .on_hover_text(look.say(poses::DRAG_TIP))
        .on_hover_cursor(egui::CursorIcon::Grab);
}

fn numbers_ui(
    ui: &mut Ui,
    row: &mut Rect,
    pane: &mut Pane<'_>,
    sequence: &Sequence,
    (at, step): (usize, &Step),
) {
    let look = pane.look;
    let millis = |time: Millis| f64::from(time.get());
    let longest = f64::from(Millis::MAX);
    let mut number = |pane: &mut Pane<'_>, caption: Text, tip: Text, value: f64, max: f64| {
        let text = look.say(caption);
        let label = format!("{} {} {text}", look.say(poses::STEP), at + 1);
        let (words, place) = take_right(row, theme::STEP_FIGURE).split_top_bottom_at_fraction(0.4);
        row.max.x += theme::STEP;
        Label::new(text, look.palette.faint).small().put(ui, words);
        let field = NumberField {
            name: &label,
            tip: look.say(tip),
            disabled: None,
            value: Some(value),
            range: 0.0..=max,
            decimals: 0,
        };
        let id = Id::unique((sequence.id, at, caption.en));
        field.put(ui, look, pane.typing, place.shrink2(vec2(0.0, 1.0)), id)
    };
    let limit = number(
        pane,
        poses::LIMIT,
        poses::LIMIT_TIP,
        millis(step.limit),
        longest,
    );
    let dwell = number(
        pane,
        poses::DWELL,
        poses::DWELL_TIP,
        millis(step.dwell),
        longest,
    );
    let now = f64::from(step.speed.get());
    let speed = number(pane, poses::STEP_SPEED, poses::SPEED_TIP, now, 1000.0);
    let time = |typed: f64| Millis::try_from(whole(typed)).ok();
    if let Some(limit) = limit.and_then(time) {
        change(pane, sequence, SequenceEdit::Limit(at, limit));
    }
    if let Some(dwell) = dwell.and_then(time) {
        change(pane, sequence, SequenceEdit::Dwell(at, dwell));
    }
    if let Some(speed) = speed.and_then(|typed| Speed::new(whole(typed)).ok()) {
        change(pane, sequence, SequenceEdit::Speed(at, speed));
    }
}
