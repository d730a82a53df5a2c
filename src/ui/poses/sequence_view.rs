//! Sequences: a timeline of poses, the dry run on the drawn hand, and the real one. Every change and start is an action.

use crate::app::action::Action;
use crate::app::hand::Play;
use crate::hand::PerDof;
use crate::poses::edit::{LibraryEdit, SequenceEdit};
use crate::poses::library::{NAME_CHARS_MAX, PoseId, Sequence, SequenceId, Step};
use crate::poses::player::{End, Phase};
use crate::ui::hand::panel;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::kit::reorder::{Along, Reorder};
use crate::ui::kit::text_field::TextField;
use crate::ui::poses::sequence_step::{change, step_now, step_ui};
use crate::ui::text::poses;
use crate::ui::theme;
use egui::{Align2, Id, Rect, Ui, UiBuilder, pos2, vec2};
use std::time::Duration;

/// Time between two pictures of a dry run while nothing else is new.
const FRAME: Duration = Duration::from_millis(33);

/// What the sequences need between frames.
#[derive(Debug, Default)]
pub(crate) struct SequenceView {
    chosen: Option<SequenceId>,
    shown: Option<SequenceId>,
    adding: Option<PoseId>,
    order: Reorder,
}

impl SequenceView {
    /// Draws the list, and the chosen sequence.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        mut rect: Rect,
        pane: &mut Pane<'_>,
        typed: &mut Option<(Id, String)>,
    ) {
        let state = pane.state;
        let newest = state.poses.newest_sequence;
        if newest != self.shown {
            (self.shown, self.chosen) = (newest, newest);
        }
        let library = &state.poses.library;
        let first = library.sequences.first().map(|first| first.id);
        let known = self
            .chosen
            .filter(|chosen| library.sequence(*chosen).is_some());
        self.chosen = known.or(first);
        self.list_ui(ui, take_left(&mut rect, theme::SEQUENCE_LIST), pane);
        match self.chosen.and_then(|chosen| library.sequence(chosen)) {
            Some(sequence) => self.sequence_ui(ui, rect, pane, typed, sequence),
            None => empty_ui(ui, rect, pane),
        }
    }

    fn list_ui(&mut self, ui: &mut Ui, mut rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let new = Button::new(
            look.say(poses::NEW_SEQUENCE),
            look.say(poses::NEW_SEQUENCE_TIP),
        );
        let none = pane.state.poses.library.poses.is_empty();
        let new = new.disabled(none.then(|| look.say(poses::NEEDS_POSES)));
        let place = take_top(&mut rect, theme::CONTROL_LARGE);
        if new
            .put(ui, look, place, Id::unique("new sequence"))
            .clicked()
        {
            let name = look.say(poses::SEQUENCE).to_owned();
            pane.actions
                .push(Action::Library(LibraryEdit::NewSequence(name)));
        }
        let state = pane.state;
        scrolled(ui, rect, "sequences", |ui, width| {
            for sequence in &state.poses.library.sequences {
                let size = vec2(width, theme::CONTROL_LARGE);
                let (place, _) = ui.allocate_exact_size(size, egui::Sense::hover());
                let label = format!("{} {}", look.say(poses::SEQUENCE), sequence.name);
                let button = Button::new(&sequence.name, look.say(poses::SECTION_TIP));
                let button = button
                    .named(&label)
                    .choice(self.chosen == Some(sequence.id));
                if button
                    .put(ui, look, place, Id::unique(("sequence", sequence.id)))
                    .clicked()
                {
                    self.chosen = Some(sequence.id);
                }
            }
        });
    }

    fn sequence_ui(
        &mut self,
        ui: &mut Ui,
        mut rect: Rect,
        pane: &mut Pane<'_>,
        typed: &mut Option<(Id, String)>,
        sequence: &Sequence,
    ) {
        head_ui(
            ui,
            take_top(&mut rect, theme::CONTROL),
            pane,
            typed,
            sequence,
        );
        timeline_ui(ui, take_top(&mut rect, theme::CONTROL), pane, sequence);
        let height =
            (rect.height() * 0.4).clamp(theme::SEQUENCE_PICTURE.0, theme::SEQUENCE_PICTURE.1);
        picture_ui(ui, take_top(&mut rect, height), pane, sequence);
        let mut foot = rect.with_min_y(rect.bottom() - theme::CONTROL_LARGE);
        controls_ui(ui, &mut foot, pane, sequence);
        let rect = rect.with_max_y(rect.bottom() - theme::CONTROL_LARGE - theme::GAP);
        let add = rect.with_min_y(rect.bottom() - theme::CONTROL);
        self.add_ui(ui, add, pane, sequence);
        let steps = rect.with_max_y(add.top() - theme::GAP);
        if sequence.steps.is_empty() {
            Label::new(pane.look.say(poses::STEPS_EMPTY), pane.look.palette.muted)
                .center()
                .put(ui, steps);
            return;
        }
        scrolled(ui, steps, "steps", |ui, width| {
            self.order.begin();
            for (at, step) in sequence.steps.iter().enumerate() {
                let size = vec2(width, theme::STEP_ROW);
                let (place, _) = ui.allocate_exact_size(size, egui::Sense::hover());
                self.order
                    .place(ui, place, Id::unique((sequence.id, at, "step")));
                step_ui(ui, place, pane, sequence, (at, step));
            }
            if let Some((from, to)) = self.order.end(ui, pane.look, Along::Column) {
                change(pane, sequence, SequenceEdit::Move(from, to));
            }
        });
    }

    fn add_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, sequence: &Sequence) {
        let look = pane.look;
        let library = &pane.state.poses.library;
        let known = self.adding.filter(|pose| library.pose(*pose).is_some());
        let first = library.poses.first().map(|pose| pose.id);
        let mut chosen = known.or(first);
        let shown = chosen
            .and_then(|pose| library.pose(pose))
            .map(|pose| pose.name.as_str());
        let button = Button::new(look.say(poses::ADD), look.say(poses::ADD_TIP));
        let place = take_right(&mut row, theme::SEQUENCE_ADD);
        if button
            .put(ui, look, place, Id::unique("add step"))
            .clicked()
            && let Some(pose) = chosen
        {
            change(pane, sequence, SequenceEdit::Add(pose));
        }
        ui.scope_builder(UiBuilder::new().max_rect(row), |ui| {
            let combo = egui::ComboBox::from_id_salt("pose to add")
                .width(row.width())
                .selected_text(shown.unwrap_or_default())
                .truncate()
                .show_ui(ui, |ui| {
                    for pose in &pane.state.poses.library.poses {
                        ui.selectable_value(&mut chosen, Some(pose.id), &pose.name);
                    }
                });
            combo.response.accessible_name(look.say(poses::POSE));
        });
        self.adding = chosen;
    }
}

fn empty_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let rows = Rect::from_center_size(rect.center(), vec2(rect.width(), theme::SEQUENCE_EMPTY));
    let (title, body) = rows.split_top_bottom_at_fraction(0.5);
    Label::new(look.say(poses::SEQUENCE_EMPTY), look.palette.text)
        .font(theme::title())
        .center()
        .put(ui, title);
    Label::new(look.say(poses::SEQUENCE_EMPTY_BODY), look.palette.muted)
        .center()
        .put(ui, body);
}

/// A list that scrolls when it is longer than its place.
pub(crate) fn scrolled(ui: &mut Ui, rect: Rect, id: &str, add: impl FnOnce(&mut Ui, f32)) {
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        egui::ScrollArea::vertical()
            .id_salt(id)
            .auto_shrink([false, false])
            .max_height(rect.height())
            .show(ui, |ui| {
                ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
                add(ui, rect.width() - theme::GAP);
            });
    });
}

fn head_ui(
    ui: &mut Ui,
    mut row: Rect,
    pane: &mut Pane<'_>,
    typed: &mut Option<(Id, String)>,
    sequence: &Sequence,
) {
    let look = pane.look;
    let delete = Button::new(look.say(poses::DELETE), look.say(poses::DELETE_TIP));
    let place = take_right(&mut row, theme::SEQUENCE_BUTTON);
    if delete
        .put(ui, look, place, Id::unique("delete sequence"))
        .clicked()
    {
        change(pane, sequence, SequenceEdit::Delete);
    }
    let looped = Button::new(look.say(poses::LOOP), look.say(poses::LOOP_TIP));
    let place = take_right(&mut row, theme::SEQUENCE_BUTTON);
    let looped = looped.choice(sequence.looped);
    if looped.put(ui, look, place, Id::unique("loop")).clicked() {
        change(pane, sequence, SequenceEdit::Loop(!sequence.looped));
    }
    let name = format!("{} {}", look.say(poses::SEQUENCE), look.say(poses::NAME));
    let field = TextField {
        name: &name,
        hint: "",
        value: &sequence.name,
        max: NAME_CHARS_MAX,
    };
    if let Some(name) = field.put(ui, typed, row, Id::unique(("sequence name", sequence.id))) {
        change(pane, sequence, SequenceEdit::Rename(name));
    }
}

/// One piece for each step, as long as it stays there, the one of now lit.
fn timeline_ui(ui: &Ui, rect: Rect, pane: &Pane<'_>, sequence: &Sequence) {
    let look = pane.look;
    let now = step_now(pane, sequence);
    // A step without dwell is still seen; its way takes time as well.
    let length = |step: &Step| 600.0 + f64::from(step.dwell.get());
    let whole: f64 = sequence.steps.iter().map(length).sum();
    let mut x = rect.left();
    for (at, step) in sequence.steps.iter().enumerate() {
        let width = rect.width() * share(length(step) / whole);
        let piece = Rect::from_min_max(pos2(x, rect.top()), pos2(x + width, rect.bottom()));
        let lit = now == Some(at);
        let fill = if lit {
            look.palette.accent
        } else {
            look.palette.control
        };
        let color = if lit {
            look.palette.on_strong
        } else {
            look.palette.muted
        };
        let inner = piece.shrink2(vec2(1.0, 0.0));
        ui.painter()
            .rect_filled(inner, f32::from(theme::ROUND_SMALL), fill);
        let name = pane
            .state
            .poses
            .library
            .pose(step.pose)
            .map(|pose| pose.name.as_str());
        let text = format!("{} {}", at + 1, name.unwrap_or_default());
        let inner = inner.shrink2(vec2(theme::STEP, 0.0));
        controls::paint_text(
            ui,
            inner,
            Align2::CENTER_CENTER,
            &text,
            theme::small(),
            color,
        );
        x += width;
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a share between 0 and 1")]
const fn share(part: f64) -> f32 {
    part as f32
}

fn picture_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, sequence: &Sequence) {
    let look = pane.look;
    let state = pane.state;
    let preview = state
        .poses
        .preview
        .as_ref()
        .filter(|own| own.sequence == sequence.id);
    let shown = preview.map(|preview| preview.at(state.now));
    if shown.is_some_and(|shown| !shown.over) {
        ui.ctx().request_repaint_after(FRAME);
    }
    let actual = || {
        let angle = state.hand().sample.angle;
        PerDof::from_fn(|dof| Some(f32::from(angle?.value[dof].documented()?) / 1000.0))
    };
    let pose = shown.map_or_else(actual, |shown| shown.shares);
    ui.painter()
        .rect_filled(rect, f32::from(theme::ROUND), look.palette.sunken);
    let (text, color) = said(pane, sequence, shown.map(|shown| shown.step + 1));
    let mut left = rect.shrink(theme::GAP);
    let words = take_top(&mut left, theme::CONTROL);
    panel::pose_ui(ui, look, left, &pose);
    Label::new(&text, color)
        .named(look.say(poses::PICTURE))
        .put(ui, words);
}

fn said(pane: &Pane<'_>, sequence: &Sequence, dry: Option<usize>) -> (String, egui::Color32) {
    let look = pane.look;
    let palette = look.palette;
    if let Some(step) = dry {
        return (
            format!("{} {step}", look.say(poses::SAY_DRY)),
            palette.simulated,
        );
    }
    let run = pane.state.hand().sequence.as_ref();
    let Some(run) = run.filter(|run| run.sequence == sequence.id) else {
        return (look.say(poses::SAY_IDLE).into(), palette.muted);
    };
    let (text, color) = match run.view.phase {
        Phase::Moving { .. } => (poses::SAY_MOVING, palette.armed),
        Phase::Dwelling { .. } => (poses::SAY_DWELLING, palette.armed),
        Phase::Paused => (poses::SAY_PAUSED, palette.warn),
        Phase::Ended(End::Finished) => (poses::END_FINISHED, palette.ok),
        Phase::Ended(End::Person) => (poses::END_PERSON, palette.muted),
        Phase::Ended(End::Disarmed) => (poses::END_DISARMED, palette.warn),
        Phase::Ended(End::Fault) => (poses::END_FAULT, palette.bad),
        Phase::Ended(End::LinkLost) => (poses::END_LOST, palette.bad),
        Phase::Ended(End::TakenOver) => (poses::END_TAKEN, palette.warn),
    };
    let mut words = look.say(text).to_owned();
    if run.is_running() {
        words = format!("{words} {}", run.view.at + 1);
    }
    if run.view.late > 0 {
        words = format!("{words} · {} {}", look.say(poses::SAY_LATE), run.view.late);
    }
    (words, color)
}

fn controls_ui(ui: &mut Ui, row: &mut Rect, pane: &mut Pane<'_>, sequence: &Sequence) {
    let look = pane.look;
    let book = &pane.state.poses;
    let id = sequence.id;
    let own = pane
        .state
        .hand()
        .sequence
        .as_ref()
        .filter(|run| run.sequence == id);
    let running = own.is_some_and(|run| run.is_running());
    let paused = own.is_some_and(|run| run.is_paused());
    let dry = book
        .preview
        .as_ref()
        .is_some_and(|preview| preview.sequence == id);
    let empty = sequence.steps.is_empty().then(|| look.say(poses::NO_STEPS));
    let unarmed = pane.unready();
    let idle = (!running).then(|| look.say(poses::NOT_RUNNING));
    let cannot = empty.or(unarmed);
    let go_on = if paused {
        (poses::RESUME, poses::RESUME_TIP, idle, Play::Resume)
    } else {
        (poses::PAUSE, poses::PAUSE_TIP, idle, Play::Pause)
    };
    let dry_run = if dry {
        (poses::DRY_END, poses::DRY_TIP, None, Play::EndDry)
    } else {
        (poses::DRY, poses::DRY_TIP, empty, Play::Dry(id))
    };
    let all = [
        dry_run,
        (poses::START, poses::START_TIP, cannot, Play::Start(id)),
        (poses::STEP, poses::STEP_TIP, cannot, Play::Step(id)),
        go_on,
        (poses::END, poses::END_TIP, idle, Play::End),
    ];
    let width = (row.width() - 4.0 * theme::GAP) / 5.0;
    for (text, tip, disabled, play) in all {
        let mut button = Button::new(look.say(text), look.say(tip)).disabled(disabled);
        if text == poses::START {
            button = button.weight(Weight::Strong);
        }
        let place = take_left(row, width);
        if button
            .put(ui, look, place, Id::unique(("play", text.en)))
            .clicked()
        {
            pane.actions.push(Action::Play(play));
        }
    }
}
