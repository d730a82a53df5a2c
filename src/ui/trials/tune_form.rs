//! The plan of a series as a sentence, line by line, whose figures are fields, each with what is wrong below it. Every
//! change is one action with the whole plan.

use crate::app::action::Action;
use crate::app::trials::TrialAction;
use crate::app::trials::form::{PlanSide, approaches, list, set_target, tags, take_pose};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::plan::PlanField;
use crate::trials::{Approach, TrialPlan, Until};
use crate::ui::kit::{self, Button, Label, Look, NumberField, Pane, TextField, Weight, format};
use crate::ui::text::{Text, main, tune, words};
use crate::ui::theme;
use egui::{CollapsingHeader, ScrollArea, Ui, vec2};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::time::Duration;

/// Characters of a list or all tags, and of a note.
const LIST_CHARS: usize = 80;
const NOTE_CHARS: usize = 300;
/// Width of the words before a field: all fields begin at one edge.
const CAPTION: f32 = 112.0;
/// Speed of a fast part unless the user says otherwise: fast, and not rough yet.
const FAST: i16 = 250;

/// What the form needs between frames.
#[derive(Debug)]
pub(crate) struct TuneForm {
    /// Where each joint closed to when it took part last.
    targets: PerDof<Angle>,
    /// Speed of the fast part when there was one last.
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

/// A list of numbers that are tried.
struct NumberList {
    field: PlanField,
    /// The words before it.
    caption: Text,
    /// What a screen reader says, with the hint.
    name: Text,
    /// The largest number.
    most: i16,
}

const SPEEDS: NumberList = NumberList {
    field: PlanField::Speeds,
    caption: tune::SPEEDS,
    name: tune::SPEEDS_NAME,
    most: Speed::MAX.get(),
};
const FORCES: NumberList = NumberList {
    field: PlanField::Forces,
    caption: tune::FORCES,
    name: tune::FORCES_NAME,
    most: Force::MAX.get(),
};

/// One pass over the form.
struct Pass<'a, 'p> {
    pane: &'a mut Pane<'p>,
    form: &'a mut TuneForm,
    plan: TrialPlan,
    wrong: Option<(PlanField, String)>,
    disabled: Option<&'static str>,
}

/// A field beside the words before it.
pub(crate) fn captioned_ui<R>(
    ui: &mut Ui,
    look: Look,
    caption: &str,
    field: impl FnOnce(&mut Ui) -> R,
) -> R {
    let row = ui.horizontal_top(|ui| {
        let caption = Label::new(caption, look.palette.muted).small();
        caption.cell_ui(ui, CAPTION);
        field(ui)
    });
    row.inner
}

/// A switch for each joint that can take part; the one that was pressed.
pub(crate) fn joints_ui(
    ui: &mut Ui,
    look: Look,
    takes_part: &PerDof<bool>,
    disabled: Option<&str>,
) -> Option<Dof> {
    let mut pressed = None;
    let mut joint_ui = |ui: &mut Ui, dof: Dof, width: f32| {
        let joint = look.say(words::dof(dof));
        let name = look.fill(tune::JOINT_NAME, &[&joint]);
        let button = Button::new(joint, look.say(tune::JOINT_TIP)).named(&name);
        let button = button.disabled(disabled).switch(takes_part[dof]);
        let (id, place) = ui.allocate_space(vec2(width, theme::CONTROL));
        if button.put(ui, look, place, id).clicked() {
            pressed = Some(dof);
        }
    };
    captioned_ui(ui, look, look.say(tune::JOINTS), |ui| {
        let width = (ui.available_width() - theme::STEP) / 2.0;
        ui.vertical(|ui| {
            for pair in Dof::ALL.chunks(2) {
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing.x = theme::STEP;
                    pair.iter().for_each(|dof| joint_ui(ui, *dof, width));
                });
            }
        });
    });
    pressed
}

impl TuneForm {
    /// Keeps what the user typed for choices that they may come back to.
    fn remember(&mut self, plan: &TrialPlan) {
        for (dof, target) in self.targets.iter_mut() {
            *target = plan.close[dof].unwrap_or(*target);
        }
        if let Approach::TwoStage { fast, .. } = plan.approach {
            self.fast = fast;
        }
    }

    /// Draws it over all of `ui`. What was changed is asked for.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let plan = pane.state.trials.plan.clone();
        self.remember(&plan);
        let error = plan.check().err();
        let wrong = error.map(|error| (error.field(), tune::plan_error(look, &error)));
        let hand = pane.hand();
        let runs = hand.runs_series() || hand.series_asked.is_some();
        let mut pass = Pass {
            wrong,
            pane,
            form: self,
            plan,
            disabled: runs.then(|| look.say(main::SERIES_RUNS)),
        };
        let area = ScrollArea::vertical().id_salt("plan").auto_shrink(false);
        area.show(ui, |ui| {
            if runs {
                ui.disable();
            }
            pass.all_ui(ui);
        });
        let plan = pass.plan;
        if plan != pane.state.trials.plan && !runs {
            let action = TrialAction::Plan(Box::new(plan));
            pane.actions.push(Action::Trial(action));
        }
    }
}

impl Pass<'_, '_> {
    fn all_ui(&mut self, ui: &mut Ui) {
        self.joints_ui(ui);
        self.ways_ui(ui);
        self.row_ui(ui, "", |pass, ui| {
            ui.vertical(|ui| pass.poses_ui(ui));
        });
        self.lists_ui(ui);
        let fold = CollapsingHeader::new(self.pane.look.say(tune::DETAILS)).id_salt("details");
        let is_wrong = matches!(
            self.wrong,
            Some((
                PlanField::Fast
                    | PlanField::Until
                    | PlanField::Dwell
                    | PlanField::Rest
                    | PlanField::Ceiling
                    | PlanField::Heat,
                _
            ))
        );
        let shown = fold
            .open(is_wrong.then_some(true))
            .show_unindented(ui, |ui| {
                self.approach_ui(ui);
                self.times_ui(ui);
                self.limits_ui(ui);
            });
        if shown.body_response.is_none() {
            let words = self.details();
            kit::say_ui(ui, &words, self.pane.look.palette.muted);
        }
        self.words_ui(ui);
    }

    /// What is folded away, as sentences.
    fn details(&self) -> String {
        let (look, plan) = (self.pane.look, &self.plan);
        let limits = plan.limits;
        let [dwell, rest] = [plan.dwell, plan.grid.rest].map(format::duration);
        let approach = look.say(tune::approach(plan.approach));
        let [start, stop] = [limits.start_c, limits.stop_c];
        let ceiling = limits.ceiling_g;
        let parts: [&dyn Display; 6] = [&approach, &dwell, &rest, &ceiling, &start, &stop];
        look.fill(tune::DETAILS_SHORT, &parts)
    }

    /// What is wrong here, once.
    fn trouble_ui(&mut self, ui: &mut Ui, field: PlanField) {
        if let Some((_, why)) = self.wrong.take_if(|(at, _)| *at == field) {
            kit::say_ui(ui, &why, self.pane.look.palette.bad);
        }
    }

    /// A field beside the words before it.
    fn row_ui<R>(
        &mut self,
        ui: &mut Ui,
        caption: &str,
        field: impl FnOnce(&mut Self, &mut Ui) -> R,
    ) -> R {
        captioned_ui(ui, self.pane.look, caption, |ui| field(self, ui))
    }

    /// Who closes.
    fn joints_ui(&mut self, ui: &mut Ui) {
        let takes_part = self.plan.close.map(|target| target.is_some());
        if let Some(dof) = joints_ui(ui, self.pane.look, &takes_part, self.disabled) {
            let angle = (!takes_part[dof]).then_some(self.form.targets[dof]);
            set_target(&mut self.plan, dof, angle);
        }
        self.trouble_ui(ui, PlanField::Joints);
    }

    /// From where to where each of them goes, and where others stand.
    fn ways_ui(&mut self, ui: &mut Ui) {
        for dof in Dof::ALL {
            let (start, close) = (self.plan.start[dof], self.plan.close[dof]);
            if start.is_none() && close.is_none() {
                continue;
            }
            let look = self.pane.look;
            let caption = if close.is_some() {
                tune::START_NAME
            } else {
                tune::STANDS
            };
            let caption = look.fill(caption, &[&look.say(words::dof(dof))]);
            self.row_ui(ui, &caption, |pass, ui| {
                ui.horizontal(|ui| pass.way_ui(ui, dof));
            });
            self.trouble_ui(ui, PlanField::Way(dof));
        }
    }

    fn way_ui(&mut self, ui: &mut Ui, dof: Dof) {
        let look = self.pane.look;
        if let Some(angle) = self.angle_ui(ui, dof, PlanSide::Start) {
            self.plan.start[dof] = Some(angle);
        }
        if self.plan.close[dof].is_none() {
            let name = look.fill(tune::LEAVE, &[&look.say(words::dof(dof))]);
            let button = Button::new(&name, look.tip(tune::LEAVE)).icon(theme::CLOSE);
            let button = button.weight(Weight::Quiet).disabled(self.disabled);
            if button.ui(ui, look).clicked() {
                self.plan.start[dof] = None;
            }
            return;
        }
        Label::note(look, tune::CLOSE).ui(ui);
        if let Some(angle) = self.angle_ui(ui, dof, PlanSide::Close) {
            self.plan.close[dof] = Some(angle);
        }
    }

    /// Where a joint begins or ends.
    fn angle_ui(&mut self, ui: &mut Ui, dof: Dof, side: PlanSide) -> Option<Angle> {
        let (look, plan) = (self.pane.look, &self.plan);
        let (name, of, angle) = match side {
            PlanSide::Start => (tune::START_NAME, tune::START, plan.start[dof]),
            PlanSide::Close => (tune::CLOSE_NAME, tune::CLOSE, plan.close[dof]),
        };
        let name = look.fill(name, &[&look.say(words::dof(dof))]);
        let field = NumberField::new(&name, look.tip(of), 0.0..=1000.0).disabled(self.disabled);
        let typed = field.whole_ui(ui, self.pane, angle.map(Angle::get))?;
        Some(Angle::nearest(typed))
    }

    /// Starts and targets out of poses.
    fn poses_ui(&mut self, ui: &mut Ui) {
        let (look, state) = (self.pane.look, self.pane.state);
        for (side, text) in [
            (PlanSide::Start, tune::TAKE_START),
            (PlanSide::Close, tune::TAKE_CLOSE),
        ] {
            let button = Button::said(look, text).tip(look.say(tune::TAKE_TIP));
            let response = button.disabled(self.disabled).ui(ui, look);
            let mut taken = None;
            egui::Popup::menu(&response).show(|ui| {
                ui.set_width(220.0);
                let now = state.hand().pose_now(state.now);
                let button = egui::Button::new(look.say(tune::TAKE_NOW));
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
                take_pose(&mut self.plan, side, &angles);
            }
        }
    }

    fn lists_ui(&mut self, ui: &mut Ui) {
        let grid = &self.plan.grid;
        let speeds: Vec<i16> = grid.speeds.iter().map(|own| own.get()).collect();
        let forces: Vec<i16> = grid.forces.iter().map(|own| own.get()).collect();
        if let Some(speeds) = self.list_ui(ui, &SPEEDS, &speeds) {
            self.plan.grid.speeds = speeds.into_iter().map(Speed::nearest).collect();
        }
        if let Some(forces) = self.list_ui(ui, &FORCES, &forces) {
            self.plan.grid.forces = forces.into_iter().map(Force::nearest).collect();
        }
        let repeats = i32::try_from(self.plan.grid.repeats).unwrap_or(i32::MAX);
        if let Some(repeats) = self.number_ui(ui, tune::REPEATS, 1..=1000, repeats) {
            self.plan.grid.repeats = usize::try_from(repeats).unwrap_or(1);
        }
        self.trouble_ui(ui, PlanField::Repeats);
    }

    /// A list of numbers; it, once one that can be taken was typed.
    fn list_ui(&mut self, ui: &mut Ui, of: &NumberList, numbers: &[i16]) -> Option<Vec<i16>> {
        let look = self.pane.look;
        let numbers: Vec<String> = numbers.iter().map(i16::to_string).collect();
        let text = TextField::new(look.say(of.name), LIST_CHARS).hint(look.tip(of.name));
        let read = |text: &str| list(text, of.most).map_err(|why| tune::list_error(look, why));
        let read = self.row_ui(ui, look.say(of.caption), |pass, ui| {
            text.read_ui(ui, pass.pane, &numbers.join(", "), read)
        });
        self.trouble_ui(ui, of.field);
        read
    }

    /// A line of text in a row of its own.
    fn text_ui(&mut self, ui: &mut Ui, name: Text, value: &str, max: usize) -> Option<String> {
        let look = self.pane.look;
        let field = TextField::new(look.say(name), max).hint(look.tip(name));
        self.row_ui(ui, look.say(name), |pass, ui| {
            field.ui(ui, pass.pane, value)
        })
    }

    /// A whole number in a row of its own.
    fn number_ui(
        &mut self,
        ui: &mut Ui,
        text: Text,
        range: RangeInclusive<i32>,
        value: i32,
    ) -> Option<i64> {
        let look = self.pane.look;
        let (from, to) = (f64::from(*range.start()), f64::from(*range.end()));
        let number = NumberField::new(look.say(text), look.tip(text), from..=to);
        let number = number.disabled(self.disabled);
        self.row_ui(ui, look.say(text), |pass, ui| {
            number.whole_ui(ui, pass.pane, Some(value))
        })
    }

    /// A time in a row of its own, over what is wrong with it.
    fn time_ui(&mut self, ui: &mut Ui, field: PlanField, text: Text, time: Duration) -> Duration {
        let look = self.pane.look;
        let number = NumberField::new(look.say(text), look.tip(text), 0.0..=600.0);
        let number = number.decimals(1).disabled(self.disabled);
        let seconds = Some(time.as_secs_f64());
        let typed = self.row_ui(ui, look.say(text), |pass, ui| {
            number.ui(ui, pass.pane, seconds)
        });
        self.trouble_ui(ui, field);
        let typed = typed.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        typed.unwrap_or(time)
    }

    fn approach_ui(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        let now = self.plan.approach;
        let name = |approach: Approach| approach.until().map(Until::name);
        let all = approaches(self.form.fast).map(|usual| {
            if name(usual) == name(now) {
                (now, look.say(tune::approach(now)))
            } else {
                (usual, look.say(tune::approach(usual)))
            }
        });
        let name = look.say(tune::APPROACH);
        self.row_ui(ui, name, |pass, ui| {
            ui.spacing_mut().combo_width = ui.available_width();
            kit::choose_ui(ui, name, &mut pass.plan.approach, &all);
        });
        let Approach::TwoStage { fast, until } = self.plan.approach else {
            return;
        };
        let typed = self.number_ui(ui, tune::FAST, 1..=1000, fast.get().into());
        self.trouble_ui(ui, PlanField::Fast);
        let fast = typed.map_or(fast, Speed::nearest);
        let (text, most) = match until {
            Until::Measured { .. } => (tune::UNTIL_MARGIN, 500),
            Until::Angle(_) => (tune::UNTIL_ANGLE, 1000),
            Until::Proximity(_) => (tune::UNTIL_PROXIMITY, 16_000_000),
            Until::Touch(_) => (tune::UNTIL_TOUCH, 3000),
        };
        let typed = self.number_ui(ui, text, 0..=most, until.value());
        self.trouble_ui(ui, PlanField::Until);
        let typed = typed.and_then(|typed| Until::new(until.name(), typed).ok());
        let until = typed.unwrap_or(until);
        self.plan.approach = Approach::TwoStage { fast, until };
    }

    fn times_ui(&mut self, ui: &mut Ui) {
        let (dwell, rest) = (self.plan.dwell, self.plan.grid.rest);
        self.plan.dwell = self.time_ui(ui, PlanField::Dwell, tune::DWELL, dwell);
        self.plan.grid.rest = self.time_ui(ui, PlanField::Rest, tune::REST, rest);
    }

    fn limits_ui(&mut self, ui: &mut Ui) {
        let limits = self.plan.limits;
        let ceiling = limits.ceiling_g.into();
        if let Some(ceiling) = self.number_ui(ui, tune::CEILING_CAPTION, 1..=4000, ceiling) {
            self.plan.limits.ceiling_g = i16::try_from(ceiling).unwrap_or(i16::MAX);
        }
        self.trouble_ui(ui, PlanField::Ceiling);
        let celsius = |typed: i64| u8::try_from(typed).unwrap_or(u8::MAX);
        if let Some(start) = self.number_ui(ui, tune::START_C, 1..=100, limits.start_c.into()) {
            self.plan.limits.start_c = celsius(start);
        }
        self.trouble_ui(ui, PlanField::Heat);
        if let Some(stop) = self.number_ui(ui, tune::STOP_C, 1..=100, limits.stop_c.into()) {
            self.plan.limits.stop_c = celsius(stop);
        }
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
}
