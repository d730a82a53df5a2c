//! The plan of a series as fields, each with what is wrong below it. Every change is one action with the whole plan.

use crate::app::action::Action;
use crate::app::trials::form::{ListError, PlanSide, list, set_target, tags, take_pose};
use crate::app::trials::{ApproachKind, PlanField, TrialAction};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::{Approach, TrialPlan, Until};
use crate::ui::kit::{self, Button, Label, NumberField, Pane, TextField, whole};
use crate::ui::text::{Text, trials, tune, words};
use crate::ui::theme;
use crate::ui::trials::line_ui;
use egui::{Align, Id, Layout, ScrollArea, Ui, vec2};
use std::time::Duration;

/// Characters of a list or all tags, and of a note.
const LIST_CHARS: usize = 80;
const NOTE_CHARS: usize = 300;
/// Width of a joint's button, of what stands before each other field, and of a head over a field.
const JOINT: f32 = 104.0;
const CAPTION: f32 = 156.0;
/// Speed of a fast part unless a person says otherwise: fast, and not rough yet.
const FAST: i16 = 250;

/// What the form needs between frames.
#[derive(Debug)]
pub(crate) struct TuneForm {
    typed: Option<(Id, String)>,
    refused: Option<(PlanField, ListError)>,
    /// Where each joint closed to when it took part last.
    targets: PerDof<Angle>,
    /// Speed of the fast part when there was one last.
    fast: Speed,
}

impl Default for TuneForm {
    fn default() -> Self {
        Self {
            typed: None,
            refused: None,
            targets: PerDof::splat(Angle::MIN),
            fast: Speed::nearest(FAST),
        }
    }
}

/// One pass over the form.
struct Pass<'a, 'p> {
    pane: &'a mut Pane<'p>,
    form: &'a mut TuneForm,
    plan: TrialPlan,
    wrong: Option<(PlanField, String)>,
    disabled: Option<&'static str>,
}

/// A number of the form: where it stands, what it is called and does, and what may be typed.
struct Number {
    field: PlanField,
    text: Text,
    range: (f64, f64),
    decimals: usize,
}

impl Number {
    const fn new(field: PlanField, text: Text, range: (f64, f64)) -> Self {
        Self {
            field,
            text,
            range,
            decimals: 0,
        }
    }

    const fn seconds(field: PlanField, text: Text) -> Self {
        Self {
            decimals: 1,
            ..Self::new(field, text, (0.0, 600.0))
        }
    }
}

impl TuneForm {
    /// Keeps what a person typed for choices that they may come back to.
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
        let wrong = error.map(|error| (PlanField::of(&error), trials::plan_error(look, &error)));
        let refused = self.refused;
        let refused = refused.map(|(field, why)| (field, trials::list_error(look, why)));
        let runs = pane.state.hand().runs_series();
        let mut pass = Pass {
            wrong: refused.or(wrong),
            pane,
            form: self,
            plan,
            disabled: runs.then(|| look.say(tune::RUNS)),
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
        ui.horizontal(|ui| {
            self.caption_ui(ui, tune::JOINTS, JOINT);
            for text in [tune::START, tune::CLOSE] {
                self.caption_ui(ui, text, theme::FIELD);
            }
        });
        for dof in Dof::ALL {
            ui.horizontal(|ui| self.joint_ui(ui, dof));
            self.trouble_ui(ui, PlanField::Way(dof));
        }
        self.trouble_ui(ui, PlanField::Joints);
        ui.horizontal_wrapped(|ui| self.poses_ui(ui));
        self.title_ui(ui, tune::SETTINGS);
        self.lists_ui(ui);
        self.approach_ui(ui);
        self.times_ui(ui);
        self.title_ui(ui, tune::LIMITS);
        self.limits_ui(ui);
        self.title_ui(ui, tune::KEEP_WITH);
        self.words_ui(ui);
    }

    fn title_ui(&self, ui: &mut Ui, text: Text) {
        let look = self.pane.look;
        ui.add_space(theme::STEP);
        Label::said(look, text).ui(ui);
    }

    /// What is wrong here, once.
    fn trouble_ui(&mut self, ui: &mut Ui, field: PlanField) {
        if let Some((_, why)) = self.wrong.take_if(|(at, _)| *at == field) {
            line_ui(ui, &why, self.pane.look.palette.bad);
        }
    }

    fn caption_ui(&self, ui: &mut Ui, text: Text, width: f32) {
        let look = self.pane.look;
        let row = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(width, theme::CONTROL), row, |ui| {
            ui.set_min_size(vec2(width, theme::CONTROL));
            Label::note(look, text).ui(ui);
        });
    }

    fn joint_ui(&mut self, ui: &mut Ui, dof: Dof) {
        let look = self.pane.look;
        let target = self.plan.close[dof];
        let takes_part = target.is_some();
        let joint = look.say(words::dof(dof));
        let name = look.fill(tune::JOINT_NAME, &[&joint]);
        let button = Button::new(joint, look.say(tune::JOINT_TIP))
            .named(&name)
            .disabled(self.disabled)
            .choice(takes_part);
        let wide = Layout::top_down_justified(Align::Center);
        let size = vec2(JOINT, theme::CONTROL);
        let pressed = ui.allocate_ui_with_layout(size, wide, |ui| button.ui(ui, look).clicked());
        if pressed.inner {
            let angle = self.form.targets[dof];
            set_target(&mut self.plan, dof, (!takes_part).then_some(angle));
        }
        let start = (tune::START_NAME, tune::START.tip());
        if let Some(angle) = self.angle_ui(ui, dof, start, self.plan.start[dof]) {
            self.plan.start[dof] = Some(angle);
        }
        let close = (tune::CLOSE_NAME, tune::CLOSE.tip());
        if takes_part && let Some(angle) = self.angle_ui(ui, dof, close, target) {
            self.plan.close[dof] = Some(angle);
        }
    }

    fn angle_ui(
        &mut self,
        ui: &mut Ui,
        dof: Dof,
        (name, tip): (Text, Text),
        angle: Option<Angle>,
    ) -> Option<Angle> {
        let look = self.pane.look;
        let name = look.fill(name, &[&look.say(words::dof(dof))]);
        let field = NumberField {
            name: &name,
            tip: look.say(tip),
            disabled: self.disabled,
            value: angle.map(|angle| f64::from(angle.get())),
            range: 0.0..=1000.0,
            decimals: 0,
        };
        let typed = field.ui(ui, look, self.pane.typing)?;
        Some(Angle::nearest(whole(typed)))
    }

    /// Starts and targets out of poses.
    fn poses_ui(&mut self, ui: &mut Ui) {
        let (look, state) = (self.pane.look, self.pane.state);
        for (side, text) in [
            (PlanSide::Start, tune::TAKE_START),
            (PlanSide::Close, tune::TAKE_CLOSE),
        ] {
            let button = Button::new(look.say(text), look.say(tune::TAKE_TIP));
            let response = button.disabled(self.disabled).ui(ui, look);
            let mut taken = None;
            egui::Popup::menu(&response).show(|ui| {
                ui.set_width(theme::MENU_WIDTH);
                let now = state.hand().pose_now();
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
        let speeds = grid.speeds.iter().map(|own| own.get()).collect();
        let forces = grid.forces.iter().map(|own| own.get()).collect();
        let texts = [tune::SPEEDS, tune::SPEEDS_NAME, tune::SPEEDS_HINT];
        let speeds = (speeds, Speed::MAX.get());
        if let Some(speeds) = self.list_ui(ui, PlanField::Speeds, texts, speeds) {
            self.plan.grid.speeds = speeds.into_iter().map(Speed::nearest).collect();
        }
        let texts = [tune::FORCES, tune::FORCES_NAME, tune::FORCES_HINT];
        let forces = (forces, Force::MAX.get());
        if let Some(forces) = self.list_ui(ui, PlanField::Forces, texts, forces) {
            self.plan.grid.forces = forces.into_iter().map(Force::nearest).collect();
        }
        let number = Number::new(PlanField::Repeats, tune::REPEATS, (1.0, 1000.0));
        let repeats = u16::try_from(self.plan.grid.repeats).unwrap_or(u16::MAX);
        if let Some(repeats) = self.number_ui(ui, &number, repeats.into()) {
            self.plan.grid.repeats = usize::try_from(whole(repeats)).unwrap_or(1);
        }
    }

    /// A list of numbers; it, once one that can be taken was typed.
    fn list_ui(
        &mut self,
        ui: &mut Ui,
        field: PlanField,
        [caption, name, hint]: [Text; 3],
        (numbers, most): (Vec<i16>, i16),
    ) -> Option<Vec<i16>> {
        let numbers: Vec<String> = numbers.iter().map(i16::to_string).collect();
        let shown = (&*numbers.join(", "), LIST_CHARS);
        let typed = self.text_ui(ui, caption, (name, hint), shown);
        let read = typed.map(|text| list(&text, most));
        match read {
            Some(Err(why)) => self.form.refused = Some((field, why)),
            Some(Ok(_)) => self.form.refused = None,
            None => {}
        }
        self.trouble_ui(ui, field);
        read.and_then(Result::ok)
    }

    fn text_ui(
        &mut self,
        ui: &mut Ui,
        caption: Text,
        (name, hint): (Text, Text),
        (value, max): (&str, usize),
    ) -> Option<String> {
        let look = self.pane.look;
        let field = TextField {
            name: look.say(name),
            hint: look.say(hint),
            value,
            max,
        };
        let row = ui.horizontal(|ui| {
            self.caption_ui(ui, caption, CAPTION);
            field.ui(ui, &mut self.form.typed)
        });
        row.inner
    }

    /// A number in a row of its own, over what is wrong with it.
    fn number_ui(&mut self, ui: &mut Ui, number: &Number, value: f64) -> Option<f64> {
        let look = self.pane.look;
        let name = number.text;
        let field = NumberField {
            name: look.say(name),
            tip: look.tip(name),
            disabled: self.disabled,
            value: Some(value),
            range: number.range.0..=number.range.1,
            decimals: number.decimals,
        };
        let row = ui.horizontal(|ui| {
            self.caption_ui(ui, name, CAPTION);
            field.ui(ui, look, self.pane.typing)
        });
        self.trouble_ui(ui, number.field);
        row.inner
    }

    fn approach_ui(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        let mut kind = ApproachKind::of(self.plan.approach);
        let all = ApproachKind::ALL.map(|kind| (kind, look.say(tune::approach(kind))));
        ui.horizontal(|ui| {
            self.caption_ui(ui, tune::APPROACH, 64.0);
            ui.spacing_mut().combo_width = ui.available_width();
            if kit::choose_ui(ui, look.say(tune::APPROACH), &mut kind, &all) {
                let fast = self.form.fast;
                self.plan.approach = match kind.usual() {
                    None => Approach::OneStage,
                    Some(until) => Approach::TwoStage { fast, until },
                };
            }
        });
        let Approach::TwoStage { fast, until } = self.plan.approach else {
            return;
        };
        let number = Number::new(PlanField::Fast, tune::FAST, (1.0, 1000.0));
        let typed = self.number_ui(ui, &number, fast.get().into());
        let fast = typed.map_or(fast, |typed| Speed::nearest(whole(typed)));
        let (text, most) = match until {
            Until::Measured { .. } => (tune::UNTIL_MARGIN, 500.0),
            Until::Angle(_) => (tune::UNTIL_ANGLE, 1000.0),
            Until::Proximity(_) => (tune::UNTIL_PROXIMITY, 16e6),
            Until::Touch(_) => (tune::UNTIL_TOUCH, 3000.0),
        };
        let number = Number::new(PlanField::Until, text, (0.0, most));
        let typed = self.number_ui(ui, &number, until.value().into());
        let typed = typed.and_then(|typed| Until::new(until.name(), whole(typed)).ok());
        let until = typed.unwrap_or(until);
        self.plan.approach = Approach::TwoStage { fast, until };
    }

    fn times_ui(&mut self, ui: &mut Ui) {
        let of = |seconds: f64| Duration::try_from_secs_f64(seconds).unwrap_or_default();
        let dwell = Number::seconds(PlanField::Dwell, tune::DWELL);
        if let Some(dwell) = self.number_ui(ui, &dwell, self.plan.dwell.as_secs_f64()) {
            self.plan.dwell = of(dwell);
        }
        let rest = Number::seconds(PlanField::Rest, tune::REST);
        if let Some(rest) = self.number_ui(ui, &rest, self.plan.grid.rest.as_secs_f64()) {
            self.plan.grid.rest = of(rest);
        }
    }

    fn limits_ui(&mut self, ui: &mut Ui) {
        let limits = self.plan.limits;
        let number = Number::new(PlanField::Ceiling, tune::CEILING_CAPTION, (1.0, 4000.0));
        if let Some(ceiling) = self.number_ui(ui, &number, limits.ceiling_g.into()) {
            self.plan.limits.ceiling_g = i16::try_from(whole(ceiling)).unwrap_or(i16::MAX);
        }
        let celsius = |typed: f64| u8::try_from(whole(typed)).unwrap_or(u8::MAX);
        let number = Number::new(PlanField::Heat, tune::START_C, (1.0, 100.0));
        if let Some(start) = self.number_ui(ui, &number, limits.start_c.into()) {
            self.plan.limits.start_c = celsius(start);
        }
        let text = tune::STOP_C;
        let number = Number { text, ..number };
        if let Some(stop) = self.number_ui(ui, &number, limits.stop_c.into()) {
            self.plan.limits.stop_c = celsius(stop);
        }
    }

    fn words_ui(&mut self, ui: &mut Ui) {
        let note = self.plan.note.clone();
        let texts = (tune::NOTE, tune::NOTE_HINT);
        if let Some(note) = self.text_ui(ui, tune::NOTE, texts, (&note, NOTE_CHARS)) {
            self.plan.note = note;
        }
        let own = self.plan.tags.join(", ");
        let texts = (tune::TAGS, tune::TAGS_HINT);
        if let Some(words) = self.text_ui(ui, tune::TAGS, texts, (&own, LIST_CHARS)) {
            self.plan.tags = tags(&words);
        }
    }
}
