//! One step of a sequence as a row: its pose, times and position. Every change is an action.

use crate::app::action::Action;
use crate::hand::gap::{Gap, GripKind};
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, Force, PerDof, Speed};
use crate::poses::edit::{LibraryEdit, SequenceEdit};
use crate::poses::library::{
    EntryId, Millis, Retries, Sequence, SequenceStep, StepGoal, UntilHolding,
};
use crate::ui::hand::tile;
use crate::ui::kit::{self, Button, Label, Look, NumberField, Pane, Weight};
use crate::ui::poses::tiles::shares;
use crate::ui::text::{Text, hold, main, poses};
use crate::ui::theme;
use egui::{Align, CursorIcon, Layout, Rect, Ui, UiBuilder, Vec2, vec2};
use std::ops::RangeInclusive;

/// Height of a row: pose and position, and the numbers below them.
pub(crate) const ROW: f32 = theme::CONTROL + NUMBER.y + 2.0 * theme::STEP;
/// Size of a number with its caption, and of the pose's picture.
const NUMBER: Vec2 = vec2(66.0, 36.0);
const PICTURE: f32 = 56.0;

/// Pushes a change of this sequence.
pub(crate) fn change(pane: &mut Pane<'_>, sequence: &Sequence, edit: SequenceEdit) {
    let edit = LibraryEdit::Sequence(sequence.id, edit);
    pane.actions.push(Action::Library(edit));
}

/// Index of the step that is previewed or run now.
pub(crate) fn step_now(pane: &Pane<'_>, sequence: &Sequence) -> Option<usize> {
    let preview = pane.state.poses.preview.as_ref();
    if let Some(preview) = preview.filter(|own| own.sequence == sequence.id) {
        return Some(preview.at(pane.state.now).step);
    }
    let run = pane.hand().running.sequence();
    let run = run.filter(|run| run.entry == EntryId::Sequence(sequence.id))?;
    run.is_running().then_some(run.view.at)
}

/// Draws the row of one step.
pub(crate) fn step_ui(ui: &mut Ui, pane: &mut Pane<'_>, sequence: &Sequence, at: usize) {
    let Some(step) = sequence.steps.get(at) else {
        return;
    };
    let look = pane.look;
    let place = ui.max_rect();
    let fill = if step_now(pane, sequence) == Some(at) {
        look.palette.wash(look.palette.accent)
    } else {
        look.palette.sunken
    };
    ui.painter().rect_filled(place, theme::ROUND_SMALL, fill);
    let (picture, rest) = place
        .shrink(theme::STEP)
        .split_left_right_at_x(place.left() + PICTURE);
    let rest = rest.with_min_x(rest.left() + theme::GAP);
    let (above, below) = rest.split_top_bottom_at_y(rest.top() + theme::CONTROL);
    let mut line = |rect: Rect, layout: Layout| {
        let mut line = ui.new_child(UiBuilder::new().max_rect(rect).layout(layout));
        line.spacing_mut().item_spacing.x = theme::STEP;
        line
    };
    let mut top = line(above, Layout::right_to_left(Align::Center));
    let mut bottom = line(below, Layout::left_to_right(Align::Min));
    let mut new = *step;
    place_ui(&mut top, pane, sequence, at);
    if !matches!(new.goal, StepGoal::Hold(_)) {
        until_ui(&mut top, look, at, &mut new);
        hold_ui(&mut top, pane, at, &mut new);
    }
    numbers_ui(&mut bottom, pane, at, &mut new);
    if let Some((name, angles)) = shown(pane, step.goal) {
        if let Some(angles) = angles {
            tile::sign_ui(ui, look, picture, &shares(&angles));
        }
        kit::left_ui(&mut top, |ui| handle_ui(ui, look, at, &name));
    }
    if new != *step {
        change(pane, sequence, SequenceEdit::Change(at, new));
    }
}

/// Name and angles of a step; a hold of what the hand has shows no angles.
fn shown(pane: &Pane<'_>, goal: StepGoal) -> Option<(String, Option<PerDof<Angle>>)> {
    match goal {
        StepGoal::Pose(id) => {
            let pose = pane.state.poses.library.pose(id)?;
            Some((pose.name.clone(), Some(pose.angles)))
        }
        StepGoal::Gap { gap, .. } => {
            let name = pane.look.tr(poses::kind(GripKind::Pinch));
            Some((format!("{name} {} mm", gap.mm()), Some(gap.angles())))
        }
        StepGoal::Hold(_) => Some((pane.look.tr(hold::TAKE).to_owned(), None)),
    }
}

/// Draws the buttons that remove or move the step, from right to left.
fn place_ui(ui: &mut Ui, pane: &mut Pane<'_>, sequence: &Sequence, at: usize) {
    let look = pane.look;
    let number = (at + 1).to_string();
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
        let label = look.tr_with(caption, &number);
        let button = Button::new(&label, look.tr(tip)).icon(icon);
        if button.weight(Weight::Quiet).ui(ui, look).clicked() {
            change(pane, sequence, edit);
        }
    }
}

/// Draws the part of a row that is focused or dragged to move the step.
fn handle_ui(ui: &mut Ui, look: Look, at: usize, name: &str) {
    let label = format!("{} {}: {name}", look.tr(poses::STEP_NAME), at + 1);
    let text = format!("{}  {name}", at + 1);
    let (id, rect) = ui.allocate_space(ui.available_size());
    let handle = Button::new(&text, look.tr(poses::DRAG_TIP)).named(&label);
    let response = handle.weight(Weight::Quiet).ground(ui, look, rect, id);
    let words = rect.shrink2(vec2(theme::STEP, 0.0));
    Label::new(&text, look.palette.text).paint(ui, words);
    response.on_hover_cursor(CursorIcon::Grab);
}

/// Accessible name of a step's number or button.
fn named(look: Look, at: usize, caption: Text) -> String {
    format!("{} {} {}", look.tr(poses::STEP), at + 1, look.tr(caption))
}

/// Draws the switch to wait until the hand holds something.
fn until_ui(ui: &mut Ui, look: Look, at: usize, step: &mut SequenceStep) {
    let label = named(look, at, poses::UNTIL);
    let waits = Button::text(look, poses::UNTIL).named(&label);
    if waits.choice(step.until.is_some()).ui(ui, look).clicked() {
        step.until = match step.until {
            Some(_) => None,
            None => Some(UntilHolding::FIRST),
        };
        step.hold = None;
    }
}

/// Draws the switch to end in a hold.
fn hold_ui(ui: &mut Ui, pane: &Pane<'_>, at: usize, step: &mut SequenceStep) {
    let look = pane.look;
    let label = named(look, at, poses::ENDS_HOLD);
    let holds = Button::text(look, poses::ENDS_HOLD).named(&label);
    if holds.choice(step.hold.is_some()).ui(ui, look).clicked() {
        step.hold = match step.hold {
            Some(_) => None,
            None => Some(pane.hand().controls.hold_forces()),
        };
        step.until = None;
    }
}

/// Draws the forces of a hold.
fn forces_ui(ui: &mut Ui, pane: &mut Pane<'_>, at: usize, forces: &mut HoldForces) {
    let [least, most] = [forces.at_least(), forces.at_most()];
    let mut grams = |caption: Text, now: Force| {
        let number = StepNumber {
            range: f64::from(HoldForces::LEAST)..=f64::from(HoldForces::MOST),
            ..StepNumber::whole(at, caption, now.get(), HoldForces::MOST)
        };
        number.whole_ui(ui, pane).map(Force::nearest)
    };
    let typed = (grams(hold::AT_LEAST, least), grams(hold::AT_MOST, most));
    *forces = match typed {
        (None, None) => return,
        (least_typed, most_typed) => {
            HoldForces::nearest(least_typed.unwrap_or(least), most_typed.unwrap_or(most))
        }
    };
}

/// A number of a step with its caption.
struct StepNumber {
    /// Index of the step.
    at: usize,
    caption: Text,
    tip: Text,
    now: f64,
    range: RangeInclusive<f64>,
    decimals: usize,
}

impl StepNumber {
    /// A whole number from 0 to `max`.
    fn whole(at: usize, caption: Text, now: impl Into<f64>, max: impl Into<f64>) -> Self {
        Self {
            at,
            caption,
            tip: caption.tip(),
            now: now.into(),
            range: 0.0..=max.into(),
            decimals: 0,
        }
    }

    /// Draws it. Returns the number once confirmed.
    fn ui(self, ui: &mut Ui, pane: &mut Pane<'_>) -> Option<f64> {
        let look = pane.look;
        let label = named(look, self.at, self.caption);
        let field = NumberField::new(&label, look.tr(self.tip), self.range);
        let field = field.decimals(self.decimals);
        let typed = ui.allocate_ui_with_layout(NUMBER, Layout::top_down(Align::Min), |ui| {
            ui.set_min_width(NUMBER.x);
            ui.spacing_mut().item_spacing.y = 0.0;
            ui.spacing_mut().interact_size.y = 20.0;
            Label::note(look, self.caption).ui(ui);
            field.ui(ui, pane, Some(self.now))
        });
        typed.inner
    }

    /// Same as [`Self::ui`], for a whole number.
    fn whole_ui(self, ui: &mut Ui, pane: &mut Pane<'_>) -> Option<i64> {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "only whole numbers of the range pass"
        )]
        self.ui(ui, pane).map(|typed| typed as i64)
    }
}

fn numbers_ui(ui: &mut Ui, pane: &mut Pane<'_>, at: usize, step: &mut SequenceStep) {
    if let StepGoal::Gap { gap, force } = &mut step.goal {
        gap_ui(ui, pane, at, gap);
        if step.hold.is_none() {
            let number = StepNumber::whole(at, poses::FORCE, force.get(), Force::MAX.get());
            set_if_valid(force, number.whole_ui(ui, pane).map(Force::new));
        }
    }
    let forces = match &mut step.goal {
        StepGoal::Hold(forces) => Some(forces),
        StepGoal::Pose(_) | StepGoal::Gap { .. } => step.hold.as_mut(),
    };
    let is_hold = forces.is_some();
    if let Some(forces) = forces {
        forces_ui(ui, pane, at, forces);
    }
    let number = StepNumber {
        caption: main::NAME_SPEED,
        ..StepNumber::whole(at, poses::SPEED, step.speed.get(), Speed::MAX.get())
    };
    set_if_valid(&mut step.speed, number.whole_ui(ui, pane).map(Speed::new));
    let mut millis = |caption: Text, time: &mut Millis| {
        let number = StepNumber::whole(at, caption, time.get(), Millis::MAX);
        set_if_valid(time, number.whole_ui(ui, pane).map(Millis::try_from));
    };
    millis(poses::DWELL, &mut step.dwell);
    if !is_hold {
        millis(poses::LIMIT, &mut step.limit);
    }
    if let Some(until) = &mut step.until {
        millis(poses::WITHIN, &mut until.within);
        let number = StepNumber::whole(at, poses::RETRIES, until.retries.get(), Retries::MAX);
        let typed = number.whole_ui(ui, pane).map(Retries::try_from);
        set_if_valid(&mut until.retries, typed);
    }
}

/// Sets `value` to the typed one, if there is one and it is valid.
fn set_if_valid<T, E>(value: &mut T, typed: Option<Result<T, E>>) {
    if let Some(Ok(typed)) = typed {
        *value = typed;
    }
}

/// Draws the gap of a grip by size.
fn gap_ui(ui: &mut Ui, pane: &mut Pane<'_>, at: usize, gap: &mut Gap) {
    let number = StepNumber {
        range: Gap::MIN.mm().into()..=Gap::MAX.mm().into(),
        decimals: 1,
        ..StepNumber::whole(at, poses::GAP, gap.mm(), Gap::MAX.mm())
    };
    #[expect(clippy::cast_possible_truncation, reason = "a gap of at most 120 mm")]
    let typed = number.ui(ui, pane).map(|typed| Gap::new(typed as f32));
    set_if_valid(gap, typed);
}
