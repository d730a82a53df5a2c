//! One step of a sequence as a row: its pose, its times and its place. Every change is an action.

use crate::app::action::Action;
use crate::hand::Speed;
use crate::poses::edit::{LibraryEdit, SequenceEdit};
use crate::poses::library::{EntryId, Millis, Sequence, SequenceStep};
use crate::ui::hand::panel;
use crate::ui::kit::{self, Button, Label, Look, NumberField, Pane, Weight};
use crate::ui::poses::tiles::shares;
use crate::ui::text::{Text, main, poses};
use crate::ui::theme;
use egui::{Align, CursorIcon, Layout, Ui, UiBuilder, vec2};

/// Height of a row.
pub(crate) const ROW: f32 = 44.0;

/// Asks for a change of this sequence.
pub(crate) fn change(pane: &mut Pane<'_>, sequence: &Sequence, edit: SequenceEdit) {
    let edit = LibraryEdit::Sequence(sequence.id, edit);
    pane.actions.push(Action::Library(edit));
}

/// The step that is shown or run now.
pub(crate) fn step_now(pane: &Pane<'_>, sequence: &Sequence) -> Option<usize> {
    let preview = pane.state.poses.preview.as_ref();
    if let Some(preview) = preview.filter(|own| own.sequence == sequence.id) {
        return Some(preview.at(pane.state.now).step);
    }
    let run = pane.state.hand().sequence.as_ref();
    let run = run.filter(|run| run.entry == EntryId::Sequence(sequence.id))?;
    run.is_running().then_some(run.view.at)
}

/// Draws the row of one step.
pub(crate) fn step_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    sequence: &Sequence,
    (at, step): (usize, &SequenceStep),
) {
    let look = pane.look;
    let place = ui.max_rect();
    let fill = if step_now(pane, sequence) == Some(at) {
        look.palette.wash(look.palette.accent)
    } else {
        look.palette.sunken
    };
    ui.painter().rect_filled(place, theme::ROUND_SMALL, fill);
    let number = (at + 1).to_string();
    let right = Layout::right_to_left(Align::Center);
    let mut ui = ui.new_child(
        UiBuilder::new()
            .max_rect(place.shrink(theme::STEP))
            .layout(right),
    );
    let ui = &mut ui;
    ui.spacing_mut().item_spacing.x = theme::STEP;
    ui.set_min_height(ui.available_height());
    let [earlier, later] = [at.saturating_sub(1), at + 1].map(|to| SequenceEdit::Move(at, to));
    for (icon, caption, tip, edit) in [
        (
            theme::CLOSE,
            poses::REMOVE,
            poses::REMOVE.tip(),
            SequenceEdit::Remove(at),
        ),
        (theme::TO_BOTTOM, poses::LATER, poses::SHIFT_TIP, later),
        (theme::TO_TOP, poses::EARLIER, poses::SHIFT_TIP, earlier),
    ] {
        let label = look.told(caption, &number);
        let button = Button::new(&label, look.say(tip)).icon(icon);
        if button.weight(Weight::Quiet).ui(ui, look).clicked() {
            change(pane, sequence, edit);
        }
    }
    numbers_ui(ui, pane, sequence, (at, step));
    if let Some(pose) = pane.state.poses.library.pose(step.pose) {
        kit::left_ui(ui, |ui| {
            let (_, picture) = ui.allocate_space(vec2(36.0, 36.0));
            panel::sign_ui(ui, look, picture, &shares(&pose.angles));
            handle_ui(ui, look, at, &pose.name);
        });
    }
}

/// The part of a row that takes the keyboard and the pointer for putting the step elsewhere.
fn handle_ui(ui: &mut Ui, look: Look, at: usize, name: &str) {
    let label = format!("{} {}: {name}", look.say(poses::STEP_NAME), at + 1);
    let text = format!("{}  {name}", at + 1);
    let (id, rect) = ui.allocate_space(ui.available_size());
    let handle = Button::new(&text, look.say(poses::DRAG_TIP)).named(&label);
    let response = handle.weight(Weight::Quiet).ground(ui, look, rect, id);
    let words = rect.shrink2(vec2(theme::STEP, 0.0));
    Label::new(&text, look.palette.text).paint(ui, words);
    response.on_hover_cursor(CursorIcon::Grab);
}

/// From right to left.
fn numbers_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    sequence: &Sequence,
    (at, step): (usize, &SequenceStep),
) {
    let look = pane.look;
    let mut number = |pane: &mut Pane<'_>, caption: Text, tip: Text, (value, max): (f64, f64)| {
        let text = look.say(caption);
        let label = format!("{} {} {text}", look.say(poses::STEP), at + 1);
        let field = NumberField::new(&label, look.say(tip), 0.0..=max);
        let (size, down) = (vec2(58.0, 36.0), Layout::top_down(Align::Min));
        let typed = ui.allocate_ui_with_layout(size, down, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            ui.spacing_mut().interact_size.y = 20.0;
            Label::new(text, look.palette.muted).small().ui(ui);
            field.whole_ui(ui, pane, Some(value))
        });
        typed.inner
    };
    let millis = |time: Millis| (f64::from(time.get()), f64::from(Millis::MAX));
    let limit = number(pane, poses::LIMIT, poses::LIMIT.tip(), millis(step.limit));
    let dwell = number(pane, poses::DWELL, poses::DWELL.tip(), millis(step.dwell));
    let now = (f64::from(step.speed.get()), 1000.0);
    let speed = number(pane, main::NAME_SPEED, poses::SPEED.tip(), now);
    let time = |typed: i64| Millis::try_from(typed).ok();
    let new = SequenceStep {
        limit: limit.and_then(time).unwrap_or(step.limit),
        dwell: dwell.and_then(time).unwrap_or(step.dwell),
        speed: speed
            .and_then(|typed| Speed::new(typed).ok())
            .unwrap_or(step.speed),
        ..step.clone()
    };
    if new != *step {
        change(pane, sequence, SequenceEdit::Change(at, new));
    }
}
