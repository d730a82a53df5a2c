//! The plan of a series as sentences with number fields, each with its error below. Every change is one action with the
//! whole plan.

use crate::app::action::Action;
use crate::app::trials::TrialAction;
use crate::app::trials::form::{PlanSide, approaches, copy_pose, list, set_target, tags};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::plan::PlanField;
use crate::trials::{Approach, TrialPlan, Until};
use crate::ui::kit::{
    self, Button, Label, Look, NumberField, Pane, Sentence, TextField, Typing, Weight,
};
use crate::ui::text::{Text, main, tune, words};
use crate::ui::theme;
use egui::{ScrollArea, Ui, vec2};
use std::ops::RangeInclusive;
use std::time::Duration;

/// Maximum characters of a list or of all tags, and of a note.
const LIST_CHARS: usize = 80;
const NOTE_CHARS: usize = 300;
/// Maximum width of a list field.
const LIST_WIDTH: f32 = 200.0;
/// Default speed of a fast part: fast, but not rough yet.
const FAST: i16 = 250;

/// View state of the form.
#[derive(Debug)]
pub(crate) struct TuneForm {
    /// Last close target of each joint.
    targets: PerDof<Angle>,
    /// Last speed of the fast part.
    fast: Speed,
}

impl Default for TuneForm {
    fn default() -> Self {
        Self {
            targets: PerDof::splat(Angle::MIN),
            fast: Speed::nearest(FAST),
        }
    }
}

/// A number of the plan, or each of a list of them, with its name and range.
struct PlanNumber(PlanField, Text, RangeInclusive<i32>);

const SPEEDS: PlanNumber = PlanNumber(PlanField::Speeds, tune::SPEEDS, 1..=Speed::MAX.get() as i32);
const FORCES: PlanNumber = PlanNumber(PlanField::Forces, tune::FORCES, 0..=Force::MAX.get() as i32);
const REPEATS: PlanNumber = PlanNumber(PlanField::Repeats, tune::REPEATS, 1..=1000);
const FAST_SPEED: PlanNumber = PlanNumber(PlanField::Fast, tune::FAST, 1..=1000);
const DWELL: PlanNumber = PlanNumber(PlanField::Dwell, tune::DWELL, 0..=600);
const REST: PlanNumber = PlanNumber(PlanField::Rest, tune::REST, 0..=600);
const CEILING: PlanNumber = PlanNumber(PlanField::Ceiling, tune::CEILING_CAPTION, 1..=4000);
const START_C: PlanNumber = PlanNumber(PlanField::Heat, tune::START_C, 1..=100);
const STOP_C: PlanNumber = PlanNumber(PlanField::Heat, tune::STOP_C, 1..=100);

/// One pass over the form.
struct Pass<'a, 'p> {
    pane: &'a mut Pane<'p>,
    form: &'a mut TuneForm,
    plan: TrialPlan,
    wrong: Option<(PlanField, String)>,
    disabled: Option<&'static str>,
}

/// Draws a switch for each joint that can take part. Returns the joint whose switch was clicked.
pub(crate) fn joints_ui(
    ui: &mut Ui,
    look: Look,
    takes_part: &PerDof<bool>,
    disabled: Option<&str>,
) -> Option<Dof> {
    let mut pressed = None;
    let mut joint_ui = |ui: &mut Ui, dof: Dof, width: f32| {
        let joint = look.tr(words::dof(dof));
        let name = look.fill(tune::JOINT_NAME, &[&joint]);
        let button = Button::new(joint, look.tr(tune::JOINT_TIP)).named(&name);
        let button = button.disabled(disabled).switch(takes_part[dof]);
        let (id, place) = ui.allocate_space(vec2(width, theme::CONTROL));
        if button.put(ui, look, place, id).clicked() {
            pressed = Some(dof);
        }
    };
    Label::new(look.tr(tune::JOINTS), look.palette.text).ui(ui);
    let width = (ui.available_width() - 2.0 * theme::STEP) / 3.0;
    for row in Dof::ALL.chunks(3) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = theme::STEP;
            row.iter().for_each(|dof| joint_ui(ui, *dof, width));
        });
    }
    pressed
}

impl TuneForm {
    /// Remembers the user's values for choices that they may return to.
    fn remember(&mut self, plan: &TrialPlan) {
        for (dof, target) in self.targets.iter_mut() {
            *target = plan.close[dof].unwrap_or(*target);
        }
        if let Approach::TwoStage { fast, .. } = plan.approach {
            self.fast = fast;
        }
    }

    /// Draws the form over all of `ui`. A change is pushed as an action.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let plan = pane.state.trials.plan.clone();
        self.remember(&plan);
        let error = plan.check().err();
        let wrong = error.map(|error| (error.field(), tune::plan_error(look, &error)));
        let hand = pane.hand();
        let runs = hand.runs_series() || hand.running.awaits_arming();
        let mut pass = Pass {
            wrong,
            pane,
            form: self,
            plan,
            disabled: runs.then(|| look.tr(main::SERIES_RUNS)),
        };
        kit::put_scroll_bar_in_margin(ui);
        let area = ScrollArea::vertical().id_salt("plan").auto_shrink(false);
        area.show(ui, |ui| {
            if runs {
                ui.disable();
            }
            pass.all_ui(ui);
        });
        let plan = pass.plan;
        if plan != pane.state.trials.plan && !runs {
            *pane.typing = Typing::default();
            let action = TrialAction::Plan(Box::new(plan));
            pane.actions.push(Action::Trial(action));
        }
    }
}

impl Pass<'_, '_> {
    fn all_ui(&mut self, ui: &mut Ui) {
        self.joints_ui(ui);
        self.ways_ui(ui);
        ui.horizontal_wrapped(|ui| self.poses_ui(ui));
        ui.add_space(theme::STEP);
        self.grid_ui(ui);
        ui.add_space(theme::STEP);
        self.approach_ui(ui);
        ui.add_space(theme::STEP);
        self.limits_ui(ui);
        ui.add_space(theme::STEP);
        self.words_ui(ui);
    }

    fn is_wrong(&self, field: PlanField) -> bool {
        matches!(&self.wrong, Some((at, _)) if *at == field)
    }

    /// Index of the invalid field of a sentence, and the reason. Of two fields that are invalid together, the last.
    fn wrong_of(&self, fields: &[PlanField]) -> Option<(usize, String)> {
        let (wrong, why) = self.wrong.as_ref()?;
        let at = fields.iter().rposition(|field| field == wrong)?;
        Some((at, why.clone()))
    }

    /// Draws the joints that take part.
    fn joints_ui(&mut self, ui: &mut Ui) {
        let takes_part = self.plan.close.map(|target| target.is_some());
        if let Some(dof) = joints_ui(ui, self.pane.look, &takes_part, self.disabled) {
            let angle = (!takes_part[dof]).then_some(self.form.targets[dof]);
            set_target(&mut self.plan, dof, angle);
        }
        if let Some((_, why)) = self.wrong_of(&[PlanField::Joints]) {
            kit::small_text_ui(ui, &why, self.pane.look.palette.bad);
        }
    }

    /// Draws start and target of each closing joint, and the position of the others that have one.
    fn ways_ui(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        for dof in Dof::ALL {
            let closes = self.plan.close[dof].is_some();
            let (text, width) = if closes {
                (tune::WAY, theme::FIELD)
            } else if self.plan.start[dof].is_some() {
                (tune::STAYS, theme::CONTROL)
            } else {
                continue;
            };
            let words = look.tr(text).replacen("{}", look.tr(words::dof(dof)), 1);
            let widths = [theme::FIELD, width];
            let sentence = Sentence::new(&words, &widths);
            let sentence = sentence.wrong(self.wrong_of(&[PlanField::Way(dof); 2]));
            sentence.ui(ui, look, |ui, number| match number {
                0 => self.angle_ui(ui, dof, PlanSide::Start),
                _ if closes => self.angle_ui(ui, dof, PlanSide::Close),
                _ => self.leave_ui(ui, dof),
            });
        }
    }

    fn leave_ui(&mut self, ui: &mut Ui, dof: Dof) {
        let look = self.pane.look;
        let name = look.fill(tune::LEAVE, &[&look.tr(words::dof(dof))]);
        let button = Button::new(&name, look.tip(tune::LEAVE)).icon(theme::CLOSE);
        let button = button.weight(Weight::Quiet).disabled(self.disabled);
        if button.ui(ui, look).clicked() {
            self.plan.start[dof] = None;
        }
    }

    /// Draws the start or target of a joint.
    fn angle_ui(&mut self, ui: &mut Ui, dof: Dof, side: PlanSide) {
        let look = self.pane.look;
        let is_wrong = self.is_wrong(PlanField::Way(dof));
        let (name, of, angle) = match side {
            PlanSide::Start => (tune::START_NAME, tune::START, &mut self.plan.start[dof]),
            PlanSide::Close => (tune::CLOSE_NAME, tune::CLOSE, &mut self.plan.close[dof]),
        };
        let name = look.fill(name, &[&look.tr(words::dof(dof))]);
        let field = NumberField::new(&name, look.tip(of), 0.0..=1000.0).disabled(self.disabled);
        let field = field.wrong(is_wrong);
        if let Some(typed) = field.whole_ui(ui, self.pane, angle.map(Angle::get)) {
            *angle = Some(Angle::nearest(typed));
        }
    }

    /// Draws the menus that set starts and targets from poses.
    fn poses_ui(&mut self, ui: &mut Ui) {
        let (look, state) = (self.pane.look, self.pane.state);
        for (side, text) in [
            (PlanSide::Start, tune::TAKE_START),
            (PlanSide::Close, tune::TAKE_CLOSE),
        ] {
            let button = Button::text(look, text).tip(look.tr(tune::TAKE_TIP));
            let response = button.disabled(self.disabled).ui(ui, look);
            let mut taken = None;
            egui::Popup::menu(&response).show(|ui| {
                ui.set_width(220.0);
                let now = state.hand().pose_now(state.now);
                let button = egui::Button::new(look.tr(tune::TAKE_NOW));
                if ui.add_enabled(now.is_some(), button).clicked() {
                    taken = now.map(|angles| angles.map(Some));
                }
                for pose in &state.poses.library.poses {
                    if ui.button(&pose.name).clicked() {
                        taken = Some(pose.targets());
                    }
                }
            });
            if let Some(angles) = taken {
                copy_pose(&mut self.plan, side, &angles);
            }
        }
    }

    /// Draws speeds, thresholds and repeats.
    fn grid_ui(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        let grid = &self.plan.grid;
        let speeds: Vec<i16> = grid.speeds.iter().map(|own| own.get()).collect();
        let forces: Vec<i16> = grid.forces.iter().map(|own| own.get()).collect();
        let [speeds, forces] = [speeds, forces].map(|numbers| {
            let numbers: Vec<String> = numbers.iter().map(i16::to_string).collect();
            numbers.join(", ")
        });
        let repeats = i32::try_from(grid.repeats).unwrap_or(i32::MAX);
        let width = |list: &str| {
            let text = kit::text_width(ui, list, theme::body()) + 2.0 * theme::GAP;
            text.clamp(theme::FIELD, LIST_WIDTH)
        };
        let widths = [width(&speeds), width(&forces), theme::FIELD];
        let fields = [PlanField::Speeds, PlanField::Forces, PlanField::Repeats];
        let sentence = Sentence::new(look.tr(tune::GRID), &widths);
        let sentence = sentence.wrong(self.wrong_of(&fields));
        sentence.ui(ui, look, |ui, number| match number {
            0 => {
                if let Some(speeds) = self.list_ui(ui, &SPEEDS, &speeds) {
                    self.plan.grid.speeds = speeds.into_iter().map(Speed::nearest).collect();
                }
            }
            1 => {
                if let Some(forces) = self.list_ui(ui, &FORCES, &forces) {
                    self.plan.grid.forces = forces.into_iter().map(Force::nearest).collect();
                }
            }
            _ => {
                if let Some(repeats) = self.number_ui(ui, &REPEATS, repeats) {
                    self.plan.grid.repeats = usize::try_from(repeats).unwrap_or(1);
                }
            }
        });
    }

    /// Draws a list of numbers. Returns it once a valid one was typed.
    fn list_ui(&mut self, ui: &mut Ui, number: &PlanNumber, numbers: &str) -> Option<Vec<i16>> {
        let look = self.pane.look;
        let &PlanNumber(field, name, ref range) = number;
        let text = TextField::new(look.tr(name), LIST_CHARS).hint(look.tip(name));
        let text = text.wrong(self.is_wrong(field));
        let most = i16::try_from(*range.end()).unwrap_or(i16::MAX);
        let read = |text: &str| list(text, most).map_err(|why| tune::list_error(look, why));
        text.read_ui(ui, self.pane, numbers, read)
    }

    /// Draws a whole number. Returns it once one in its range was typed.
    fn number_ui(&mut self, ui: &mut Ui, number: &PlanNumber, value: i32) -> Option<i64> {
        let number = self.field(number);
        number.whole_ui(ui, self.pane, Some(value))
    }

    fn time_ui(&mut self, ui: &mut Ui, number: &PlanNumber, time: Duration) -> Duration {
        let number = self.field(number).decimals(1);
        let typed = number.ui(ui, self.pane, Some(time.as_secs_f64()));
        let typed = typed.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        typed.unwrap_or(time)
    }

    fn field(&self, PlanNumber(field, name, range): &PlanNumber) -> NumberField<'static> {
        let look = self.pane.look;
        let (from, to) = (f64::from(*range.start()), f64::from(*range.end()));
        let number = NumberField::new(look.tr(*name), look.tip(*name), from..=to);
        let number = number.disabled(self.disabled);
        number.wrong(self.is_wrong(*field))
    }

    fn approach_ui(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        let now = self.plan.approach;
        let name = |approach: Approach| approach.until().map(Until::name);
        let all = approaches(self.form.fast).map(|usual| {
            if name(usual) == name(now) {
                (now, look.tr(tune::approach(now)))
            } else {
                (usual, look.tr(tune::approach(usual)))
            }
        });
        ui.scope(|ui| {
            ui.spacing_mut().combo_width = ui.available_width();
            let name = look.tr(tune::APPROACH);
            kit::choose_ui(ui, name, &mut self.plan.approach, &all);
        });
        let Approach::TwoStage {
            mut fast,
            mut until,
        } = self.plan.approach
        else {
            return;
        };
        let (words, name, most) = match until {
            Until::Measured { .. } => (tune::MARGIN, tune::UNTIL_MARGIN, 500),
            Until::Angle(_) => (tune::ANGLE, tune::UNTIL_ANGLE, 1000),
            Until::Proximity(_) => (tune::PROXIMITY, tune::UNTIL_PROXIMITY, 16_000_000),
            Until::Touch(_) => (tune::TOUCH, tune::UNTIL_TOUCH, 3000),
        };
        let slows = PlanNumber(PlanField::Until, name, 0..=most);
        let sentence = Sentence::new(look.tr(words), &[theme::FIELD; 2]);
        let sentence = sentence.wrong(self.wrong_of(&[PlanField::Fast, PlanField::Until]));
        sentence.ui(ui, look, |ui, number| match number {
            0 => {
                let typed = self.number_ui(ui, &FAST_SPEED, fast.get().into());
                fast = typed.map_or(fast, Speed::nearest);
            }
            _ => {
                let typed = self.number_ui(ui, &slows, until.value());
                let typed = typed.and_then(|typed| Until::new(until.name(), typed).ok());
                until = typed.unwrap_or(until);
            }
        });
        self.plan.approach = Approach::TwoStage { fast, until };
    }

    /// Draws hold and rest times, and the limits that end a trial.
    fn limits_ui(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        let (dwell, rest, limits) = (self.plan.dwell, self.plan.grid.rest, self.plan.limits);
        let celsius = |typed: i64| u8::try_from(typed).unwrap_or(u8::MAX);
        let sentence = Sentence::new(look.tr(tune::TIMES), &[theme::FIELD; 5]);
        let numbers = [DWELL, REST, CEILING, START_C, STOP_C];
        let sentence = sentence.wrong(self.wrong_of(&numbers.map(|PlanNumber(field, ..)| field)));
        sentence.ui(ui, look, |ui, number| match number {
            0 => self.plan.dwell = self.time_ui(ui, &DWELL, dwell),
            1 => self.plan.grid.rest = self.time_ui(ui, &REST, rest),
            2 => {
                if let Some(ceiling) = self.number_ui(ui, &CEILING, limits.ceiling_g.into()) {
                    self.plan.limits.ceiling_g = i16::try_from(ceiling).unwrap_or(i16::MAX);
                }
            }
            3 => {
                if let Some(start) = self.number_ui(ui, &START_C, limits.start_c.into()) {
                    self.plan.limits.start_c = celsius(start);
                }
            }
            _ => {
                if let Some(stop) = self.number_ui(ui, &STOP_C, limits.stop_c.into()) {
                    self.plan.limits.stop_c = celsius(stop);
                }
            }
        });
    }

    fn words_ui(&mut self, ui: &mut Ui) {
        let note = self.plan.note.clone();
        if let Some(note) = self.text_ui(ui, tune::NOTE, &note, NOTE_CHARS) {
            self.plan.note = note;
        }
        let own = self.plan.tags.join(", ");
        if let Some(words) = self.text_ui(ui, tune::TAGS, &own, LIST_CHARS) {
            self.plan.tags = tags(&words);
        }
    }

    /// Draws a text field beside its name.
    fn text_ui(&mut self, ui: &mut Ui, name: Text, value: &str, max: usize) -> Option<String> {
        let look = self.pane.look;
        let field = TextField::new(look.tr(name), max).hint(look.tip(name));
        let row = ui.horizontal(|ui| {
            Label::note(look, name).cell_ui(ui, theme::FIELD);
            field.ui(ui, self.pane, value)
        });
        row.inner
    }
}
