//! Sequences: their steps, the dry run on the drawn hand, and the real run. Every change and start is an action.

use crate::app::action::Action;
use crate::hand::PerDof;
use crate::hand::gap::Gap;
use crate::hand::newtons::ForceUnit;
use crate::poses::Play;
use crate::poses::edit::{LibraryEdit, SequenceEdit};
use crate::poses::library::{EntryId, NAME_CHARS_MAX, PoseId, Sequence, SequenceId};
use crate::poses::player::{PlayEnd, PlayPhase};
use crate::record::Abort;
use crate::ui::hand::tile;
use crate::ui::kit::{self, Button, Label, Pane, TextField, reorder};
use crate::ui::poses::sequence_step::{ROW, change, step_ui};
use crate::ui::text::tune::abort as abort_words;
use crate::ui::text::{hold, panels, poses};
use crate::ui::theme;
use egui::{Align, Layout, Panel, ScrollArea, Ui, UiBuilder, vec2};
use std::time::Duration;

/// Repaint interval of a dry run.
const FRAME: Duration = Duration::from_millis(33);

/// Initial gap of a grip by size, in mm.
pub(crate) const FIRST_GAP_MM: f32 = 30.0;

/// View state of the sequences.
#[derive(Debug, Default)]
pub(crate) struct SequenceView {
    chosen: Option<SequenceId>,
    shown: Option<SequenceId>,
    adding: Option<PoseId>,
    order: reorder::Reorder,
}

/// A panel at the right, with the gap between cards at its left.
pub(crate) fn beside(width: f32, id: &'static str) -> Panel {
    kit::bare(Panel::right(id), width, theme::GAP_LEFT)
}

impl SequenceView {
    /// Draws the list, and the chosen sequence.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let state = pane.state;
        let newest = state.poses.newest_sequence;
        if newest != self.shown {
            (self.shown, self.chosen) = (newest, newest);
        }
        let library = &state.poses.library;
        let known = self.chosen.and_then(|chosen| library.sequence(chosen));
        let chosen = known.or(library.sequences.first());
        self.chosen = chosen.map(|sequence| sequence.id);
        let width = ui.available_width() - 148.0;
        beside(width, "sequence").show(ui, |ui| match chosen {
            Some(sequence) => self.sequence_ui(ui, pane, sequence),
            None => empty_ui(ui, pane),
        });
        self.list_ui(ui, pane);
    }

    fn list_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let library = &pane.state.poses.library;
        let tip = look.tip(poses::NEW_SEQUENCE);
        let new = Button::new(look.tr(poses::NEW_SEQUENCE), tip);
        let none = library.poses.is_empty();
        let new = new.disabled(none.then(|| look.tr(poses::NEEDS_POSES)));
        ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
            if new.large().ui(ui, look).clicked() {
                let name = look.tr(poses::SEQUENCE).to_owned();
                let new = Action::Library(LibraryEdit::NewSequence(name));
                pane.actions.push(new);
            }
            ScrollArea::vertical().id_salt("sequences").show(ui, |ui| {
                for sequence in &library.sequences {
                    let label = look.tr_with(poses::SEQUENCE, &sequence.name);
                    let button = Button::new(&sequence.name, look.tr(poses::SECTION_TIP));
                    let button = button.named(&label).large();
                    let button = button.choice(self.chosen == Some(sequence.id));
                    if button.ui(ui, look).clicked() {
                        self.chosen = Some(sequence.id);
                    }
                }
            });
        });
    }

    fn sequence_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, sequence: &Sequence) {
        ui.horizontal(|ui| kit::right_ui(ui, |ui| head_ui(ui, pane, sequence)));
        picture_ui(ui, pane, sequence);
        let foot = theme::CONTROL + theme::CONTROL_LARGE + 4.0 * theme::STEP;
        let most = ui.available_height() - foot;
        if sequence.steps.is_empty() {
            Label::muted(pane.look, poses::STEPS_EMPTY).ui(ui);
        }
        let area = ScrollArea::vertical().auto_shrink([false, true]);
        let area = area
            .id_salt("steps")
            .max_height(most)
            .min_scrolled_height(0.0);
        area.show(ui, |ui| {
            for at in 0..sequence.steps.len() {
                let width = ui.available_width() - theme::GAP;
                let (id, place) = ui.allocate_space(vec2(width, ROW));
                let moved = self.order.place(ui, pane.look, at, (id, place));
                let builder = UiBuilder::new().max_rect(place).id_salt((sequence.id, at));
                step_ui(&mut ui.new_child(builder), pane, sequence, at);
                if let Some((from, to)) = moved {
                    change(pane, sequence, SequenceEdit::Move(from, to));
                }
            }
        });
        ui.horizontal(|ui| self.add_ui(ui, pane, sequence));
        ui.columns(5, |columns| controls_ui(columns, pane, sequence));
    }

    fn add_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, sequence: &Sequence) {
        let look = pane.look;
        let all = pane.state.poses.library.poses.iter();
        let all = all.map(|pose| (Some(pose.id), pose.name.as_str()));
        let all: Vec<(Option<PoseId>, &str)> = all.collect();
        if !all.iter().any(|(pose, _)| *pose == self.adding) {
            self.adding = all.first().and_then(|(pose, _)| *pose);
        }
        kit::choose_ui(ui, look.tr(poses::POSE), &mut self.adding, &all);
        let button = Button::text(look, poses::ADD);
        if button.ui(ui, look).clicked()
            && let Some(pose) = self.adding
        {
            change(pane, sequence, SequenceEdit::Add(pose));
        }
        if Button::text(look, poses::ADD_GRIP).ui(ui, look).clicked() {
            let gap = Gap::nearest(FIRST_GAP_MM);
            change(pane, sequence, SequenceEdit::AddGap(gap));
        }
        if Button::text(look, poses::ADD_HOLD).ui(ui, look).clicked() {
            let forces = pane.hand().controls.hold_forces();
            change(pane, sequence, SequenceEdit::AddHold(forces));
        }
    }
}

fn empty_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, palette) = (pane.look, pane.look.palette);
    ui.vertical_centered(|ui| {
        ui.add_space(ui.available_height() * 0.3);
        Label::text(look, poses::SEQUENCE_EMPTY).large().ui(ui);
        Label::muted(look, poses::SEQUENCE_EMPTY_BODY).wrap().ui(ui);
        if pane.state.poses.library.poses.is_empty() {
            Label::new(look.tr(poses::NEEDS_POSES), palette.warn).ui(ui);
        }
    });
}

/// Draws the actions from right to left.
fn head_ui(ui: &mut Ui, pane: &mut Pane<'_>, sequence: &Sequence) {
    let look = pane.look;
    let delete = Button::text(look, poses::DELETE);
    if delete.ui(ui, look).clicked() {
        change(pane, sequence, SequenceEdit::Delete);
    }
    let looped = Button::text(look, poses::LOOP);
    if looped.choice(sequence.looped).ui(ui, look).clicked() {
        change(pane, sequence, SequenceEdit::Loop(!sequence.looped));
    }
    let name = look.tr_with(poses::SEQUENCE, look.tr(poses::NAME));
    let field = TextField::new(&name, NAME_CHARS_MAX);
    if let Some(name) = field.ui(ui, pane, &sequence.name) {
        change(pane, sequence, SequenceEdit::Rename(name));
    }
}

fn picture_ui(ui: &mut Ui, pane: &Pane<'_>, sequence: &Sequence) {
    let (look, state) = (pane.look, pane.state);
    let preview = state.poses.preview.as_ref();
    let preview = preview.filter(|own| own.sequence == sequence.id);
    let shown = preview.map(|preview| preview.at(state.now));
    if shown.is_some_and(|shown| !shown.over) {
        ui.ctx().request_repaint_after(FRAME);
    }
    let actual = || {
        let angle = state.hand().readings.sample.angle;
        PerDof::from_fn(|dof| Some(f32::from(angle?.value[dof].documented()?) / 1000.0))
    };
    let pose = shown.map_or_else(actual, |shown| shown.shares);
    let (text, color) = state_text(pane, sequence, shown.map(|shown| shown.step + 1));
    let label = Label::new(&text, color);
    label.named(look.tr(poses::PICTURE)).ui(ui);
    let height = (ui.available_height() * 0.36).clamp(72.0, 360.0);
    let (_, rect) = ui.allocate_space(vec2(ui.available_width(), height));
    ui.painter()
        .rect_filled(rect, theme::ROUND, look.palette.sunken);
    tile::pose_ui(ui, look, rect.shrink(theme::STEP), &pose);
}

fn state_text(pane: &Pane<'_>, sequence: &Sequence, dry: Option<usize>) -> (String, egui::Color32) {
    let look = pane.look;
    let palette = look.palette;
    if let Some(step) = dry {
        return (look.tr_with(poses::SAY_DRY, step), palette.simulated);
    }
    let run = pane.hand().running.sequence();
    let Some(run) = run.filter(|run| run.entry == EntryId::Sequence(sequence.id)) else {
        return (look.tr(poses::SAY_IDLE).into(), palette.muted);
    };
    let (text, color) = match run.view.phase {
        PlayPhase::Moving { .. } => (poses::SAY_MOVING, palette.armed),
        PlayPhase::Waiting { .. } => (poses::SAY_WAITING, palette.armed),
        PlayPhase::Opening { .. } => (poses::SAY_OPENING, palette.armed),
        PlayPhase::Holding { .. } => (poses::SAY_HOLDING, palette.armed),
        PlayPhase::Dwelling { .. } => (poses::SAY_DWELLING, palette.armed),
        PlayPhase::Paused => (poses::SAY_PAUSED, palette.warn),
        PlayPhase::Ended(Ok(PlayEnd::Finished)) => (poses::END_FINISHED, palette.ok),
        PlayPhase::Ended(Ok(PlayEnd::Person)) => (poses::END_PERSON, palette.muted),
        PlayPhase::Ended(Ok(PlayEnd::Locked)) => (poses::END_LOCKED, palette.warn),
        PlayPhase::Ended(Err(why @ Abort::Fault { .. })) => {
            return (abort_words(look, why), palette.bad);
        }
        PlayPhase::Ended(Err(Abort::LinkLost)) => (poses::END_LOST, palette.bad),
        PlayPhase::Ended(Err(Abort::TakenOver)) => (poses::END_TAKEN, palette.warn),
        PlayPhase::Ended(Err(why)) => return (abort_words(look, why), palette.warn),
        PlayPhase::Ended(Ok(PlayEnd::NotHolding(grip))) => {
            let grip = look.tr(panels::grip(grip));
            return (look.fill(poses::END_NOT_HOLDING, &[&grip]), palette.warn);
        }
    };
    let mut words = look.tr(text).to_owned();
    if run.is_running() {
        words = format!("{words} {}", run.view.at + 1);
    }
    if let Some(view) = run.hold.as_ref().filter(|_| run.holds()) {
        words = format!("{words} · {}", hold::state(look, view, ForceUnit::Grams));
    }
    if run.view.late > 0 {
        words = format!("{words} · {} {}", look.tr(poses::SAY_LATE), run.view.late);
    }
    (words, color)
}

fn controls_ui(columns: &mut [Ui], pane: &mut Pane<'_>, sequence: &Sequence) {
    let look = pane.look;
    let id = sequence.id;
    let own = pane.hand().running.sequence();
    let own = own.filter(|run| run.entry == EntryId::Sequence(id));
    let running = own.is_some_and(|run| run.is_running());
    let paused = own.is_some_and(|run| run.is_paused());
    let preview = pane.state.poses.preview.as_ref();
    let dry = preview.is_some_and(|preview| preview.sequence == id);
    let empty = sequence.steps.is_empty();
    let empty = empty.then(|| look.tr(poses::STEPS_EMPTY));
    let idle = (!running).then(|| look.tr(poses::NOT_RUNNING));
    let cannot = empty.or(pane.unready());
    let go_on = if paused {
        (poses::RESUME, idle, Action::Play(Play::Resume))
    } else {
        (poses::PAUSE, idle, Action::Play(Play::Pause))
    };
    let dry_run = if dry {
        (poses::DRY_END, None, Action::DryRun(None))
    } else {
        (poses::DRY, empty, Action::DryRun(Some(id)))
    };
    let all = [
        dry_run,
        (
            poses::START,
            cannot,
            Action::Play(Play::Start(EntryId::Sequence(id))),
        ),
        (poses::STEP, cannot, Action::Play(Play::Step(id))),
        go_on,
        (poses::END, idle, Action::Play(Play::End)),
    ];
    for (ui, (text, disabled, action)) in columns.iter_mut().zip(all) {
        let button = Button::text(look, text).strong_if(text == poses::START);
        let button = button.large().disabled(disabled);
        button.on_click(ui, pane, action);
    }
}
