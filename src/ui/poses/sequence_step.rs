//! One step of a sequence as a row: its pose, its times and its place. Every change is an action.

use crate::app::action::Action;
use crate::hand::Speed;
use crate::poses::edit::{LibraryEdit, SequenceEdit};
use crate::poses::library::{EntryId, Millis, Retries, Sequence, SequenceStep, UntilHolding};
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
    let named = |caption: Text| {
        let text = look.say(caption);
        format!("{} {} {text}", look.say(poses::STEP), at + 1)
    };
    let number = |ui: &mut Ui, pane: &mut Pane<'_>, (caption, tip): (Text, Text), (now, max)| {
        let label = named(caption);
        let field = NumberField::new(&label, look.say(tip), 0.0..=max);
        let (size, down) = (vec2(58.0, 36.0), Layout::top_down(Align::Min));
        let typed = ui.allocate_ui_with_layout(size, down, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            ui.spacing_mut().interact_size.y = 20.0;
            Label::new(look.say(caption), look.palette.muted)
                .small()
                .ui(ui);
            field.whole_ui(ui, pane, Some::<f64>(now))
        });
        typed.inner
    };
    let millis = |ui: &mut Ui, pane: &mut Pane<'_>, caption: Text, now: Millis| {
        let of = (f64::from(now.get()), f64::from(Millis::MAX));
        let typed = number(ui, pane, (caption, caption.tip()), of);
        let typed = typed.and_then(|typed| Millis::try_from(typed).ok());
        typed.unwrap_or(now)
    };
    let mut new = step.clone();
    if let Some(until) = &mut new.until {
        let of = (until.retries.get().into(), Retries::MAX.into());
        let typed = number(ui, pane, (poses::RETRIES, poses::RETRIES.tip()), of);
        let typed = typed.and_then(|typed| Retries::try_from(typed).ok());
        until.retries = typed.unwrap_or(until.retries);
        until.within = millis(ui, pane, poses::WITHIN, until.within);
    }
    let label = named(poses::UNTIL);
    let waits = Button::said(look, poses::UNTIL).named(&label);
    if waits.choice(step.until.is_some()).ui(ui, look).clicked() {
        new.until = match step.until {
            Some(_) => None,
            None => Some(UntilHolding::FIRST),
        };
    }
    new.limit = millis(ui, pane, poses::LIMIT, step.limit);
    new.dwell = millis(ui, pane, poses::DWELL, step.dwell);
    let now = (f64::from(step.speed.get()), 1000.0);
    let speed = number(ui, pane, (main::NAME_SPEED, poses::SPEED.tip()), now);
    let speed = speed.and_then(|typed| Speed::new(typed).ok());
    new.speed = speed.unwrap_or(step.speed);
    if new != *step {
        change(pane, sequence, SequenceEdit::Change(at, new));
    }
}
