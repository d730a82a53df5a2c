//! The plan of a series as fields, each with what is wrong beside it. Every change is one action with the whole plan.

use crate::app::action::Action;
use crate::app::trials::form::{ListError, PlanSide, list, set_target, take_pose};
use crate::app::trials::{ApproachKind, PlanField, TrialAction};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::trials::{Approach, TrialPlan, Until};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left};
use crate::ui::kit::list;
use crate::ui::kit::look::Pane;
use crate::ui::kit::number::NumberField;
use crate::ui::kit::text_field::TextField;
use crate::ui::text::{Text, trials, tune, words};
use crate::ui::theme;
use egui::{Id, Rect, Ui};
use std::time::Duration;

/// Characters of a list, a note, and all tags.
const LIST_CHARS: usize = 80;
const NOTE_CHARS: usize = 300;

/// What the form needs between frames.
#[derive(Debug)]
pub(crate) struct TuneForm {
    typed: Option<(Id, String)>,
    refused: Option<(PlanField, ListError)>,
    /// Where each joint closed to when it took part last.
    targets: PerDof<Angle>,
    /// The approaches as they were when each kind was chosen last, in the order of [`ApproachKind::ALL`].
    approaches: [Approach; 5],
}

impl Default for TuneForm {
    fn default() -> Self {
        /// Speed of a first stage unless a person says otherwise: fast, and not rough yet.
        const FAST: i16 = 250;
        let usual = |kind: ApproachKind| match kind.usual() {
            None => Approach::OneStage,
            Some(until) => Approach::TwoStage {
                fast: Speed::nearest(FAST),
                until,
            },
        };
        Self {
            typed: None,
            refused: None,
            targets: PerDof::splat(Angle::MIN),
            approaches: ApproachKind::ALL.map(usual),
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
    width: f32,
}

/// A number of the form.
#[derive(Clone, Copy)]
struct Number {
    name: Text,
    tip: Text,
    value: f64,
    range: (f64, f64),
    decimals: usize,
}

impl TuneForm {
    /// Keeps what a person typed for choices that they may come back to.
    fn remember(&mut self, plan: &TrialPlan) {
        for (dof, target) in self.targets.iter_mut() {
            *target = plan.close[dof].unwrap_or(*target);
        }
        let kind = ApproachKind::of(plan.approach);
        if let Some(own) = self.approaches.get_mut(kind as usize) {
            *own = plan.approach;
        }
        let Approach::TwoStage { fast: speed, .. } = plan.approach else {
            return;
        };
        for own in &mut self.approaches {
            if let Approach::TwoStage { fast, .. } = own {
                *fast = speed;
            }
        }
    }

    /// Draws it. What was changed is asked for.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let plan = pane.state.trials.plan.clone();
        self.remember(&plan);
        let error = plan.check().err();
        let wrong = error.map(|error| (PlanField::of(&error), trials::plan_error(look, &error)));
        let refused = self.refused;
        let refused = refused.map(|(field, why)| (field, trials::list_error(look, why)));
        let disabled = pane
            .state
            .hand()
            .runs_series()
            .then(|| look.say(tune::RUNS));
        let mut pass = Pass {
            wrong: refused.or(wrong),
            pane,
            form: self,
            plan,
            disabled,
            width: 0.0,
        };
        list::scroll_ui(ui, rect, "trial plan", |ui, width| {
            pass.width = width;
            pass.all(ui);
        });
        let plan = pass.plan;
        if plan != pane.state.trials.plan && disabled.is_none() {
            let action = TrialAction::Plan(Box::new(plan));
            pane.actions.push(Action::Trial(action));
        }
    }
}

impl Pass<'_, '_> {
    fn all(&mut self, ui: &mut Ui) {
        self.title(ui, tune::JOINTS);
        for dof in Dof::ALL {
            self.joint(ui, dof);
        }
        self.trouble(ui, PlanField::Joints);
        self.poses(ui);
        self.title(ui, tune::SETTINGS);
        self.lists(ui);
        self.title(ui, tune::APPROACH);
        self.approach(ui);
        self.title(ui, tune::TIMES);
        self.times(ui);
        self.title(ui, tune::LIMITS);
        self.limits(ui);
        self.title(ui, tune::KEEP_WITH);
        self.words(ui);
    }

    fn title(&self, ui: &mut Ui, text: Text) {
        let look = self.pane.look;
        list::piece(ui, self.width, theme::STEP);
        let place = list::piece(ui, self.width, theme::TITLE_LINE);
        Label::new(look.say(text), look.palette.muted)
            .small()
            .put(ui, place);
    }

    fn row(&self, ui: &mut Ui) -> Rect {
        // Before the row: a field takes the list's cursor to its own end.
        list::piece(ui, self.width, theme::STEP);
        list::piece(ui, self.width, theme::CONTROL)
    }

    /// What is wrong here.
    fn trouble(&self, ui: &mut Ui, field: PlanField) {
        if let Some((at, why)) = &self.wrong
            && *at == field
        {
            let color = self.pane.look.palette.bad;
            list::wrapped_ui(ui, self.width, 0.0, why, color);
        }
    }

    fn caption(&self, ui: &mut Ui, row: &mut Rect, text: Text, width: f32) {
        let look = self.pane.look;
        let place = take_left(row, width);
        Label::new(look.say(text), look.palette.text)
            .small()
            .put(ui, place);
    }

    fn joint(&mut self, ui: &mut Ui, dof: Dof) {
        let look = self.pane.look;
        let mut row = self.row(ui);
        let target = self.plan.close[dof];
        let takes_part = target.is_some();
        let name = look.say(words::dof(dof));
        let label = format!("{name}: {}", look.say(tune::JOINTS));
        let button = Button::new(name, look.say(tune::JOINT_TIP))
            .named(&label)
            .disabled(self.disabled)
            .choice(takes_part);
        let place = take_left(&mut row, theme::PLAN_JOINT);
        let id = Id::unique(("trial joint", dof));
        if button.put(ui, look, place, id).clicked() {
            let angle = self.form.targets[dof];
            set_target(&mut self.plan, dof, (!takes_part).then_some(angle));
        }
        let start = self.plan.start[dof];
        if let Some(angle) = self.angle(ui, &mut row, (dof, PlanSide::Start), start) {
            self.plan.start[dof] = Some(angle);
        }
        if takes_part && let Some(angle) = self.angle(ui, &mut row, (dof, PlanSide::Close), target)
        {
            self.plan.close[dof] = Some(angle);
        }
        self.trouble(ui, PlanField::Way(dof));
    }

    fn angle(
        &mut self,
        ui: &mut Ui,
        row: &mut Rect,
        (dof, side): (Dof, PlanSide),
        angle: Option<Angle>,
    ) -> Option<Angle> {
        let look = self.pane.look;
        let (caption, tip) = match side {
            PlanSide::Start => (tune::START, tune::START_TIP),
            PlanSide::Close => (tune::CLOSE, tune::CLOSE_TIP),
        };
        let words = look.say(caption);
        let width = controls::text_width(ui, words, theme::small()) + 1.0;
        self.caption(ui, row, caption, width);
        let label = format!("{} {words}", look.say(words::dof(dof)));
        let field = NumberField {
            name: &label,
            tip: look.say(tip),
            disabled: self.disabled,
            value: angle.map(|angle| f64::from(angle.get())),
            range: 0.0..=1000.0,
            decimals: 0,
        };
        let room = row.width().min(theme::PLAN_WAY);
        let place = take_left(row, room);
        let id = Id::unique(("trial angle", dof, side));
        let typed = field.put(ui, look, self.pane.typing, place, id)?;
        Some(Angle::nearest(whole(typed)))
    }

    /// Starts and targets out of poses.
    fn poses(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        let mut row = self.row(ui);
        let width = (row.width() - theme::GAP) / 2.0;
        for (side, text) in [
            (PlanSide::Start, tune::TAKE_START),
            (PlanSide::Close, tune::TAKE_CLOSE),
        ] {
            let place = take_left(&mut row, width);
            let button =
                Button::new(look.say(text), look.say(tune::TAKE_TIP)).disabled(self.disabled);
            let response = button.put(ui, look, place, Id::unique(("trial pose", side)));
            let state = self.pane.state;
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

    fn lists(&mut self, ui: &mut Ui) {
        let speeds = self.plan.grid.speeds.iter().map(|speed| speed.get());
        let texts = (tune::SPEEDS, tune::SPEEDS_NAME, tune::SPEEDS_HINT);
        let most = Speed::MAX.get();
        if let Some(speeds) = self.list(ui, PlanField::Speeds, texts, (speeds.collect(), most)) {
            self.plan.grid.speeds = speeds.into_iter().map(Speed::nearest).collect();
        }
        let forces = self.plan.grid.forces.iter().map(|force| force.get());
        let texts = (tune::FORCES, tune::FORCES_NAME, tune::FORCES_HINT);
        let most = Force::MAX.get();
        if let Some(forces) = self.list(ui, PlanField::Forces, texts, (forces.collect(), most)) {
            self.plan.grid.forces = forces.into_iter().map(Force::nearest).collect();
        }
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::REPEATS, theme::PLAN_CAPTION);
        let number = Number {
            name: tune::REPEATS,
            tip: tune::REPEATS_TIP,
            value: f64::from(u16::try_from(self.plan.grid.repeats).unwrap_or(u16::MAX)),
            range: (1.0, 1000.0),
            decimals: 0,
        };
        if let Some(repeats) = self.number(ui, &mut row, number) {
            self.plan.grid.repeats = usize::try_from(whole(repeats)).unwrap_or(1);
        }
        self.trouble(ui, PlanField::Repeats);
    }

    /// A list of numbers; it, once one that can be taken was typed.
    fn list(
        &mut self,
        ui: &mut Ui,
        field: PlanField,
        (caption, name, hint): (Text, Text, Text),
        (numbers, most): (Vec<i16>, i16),
    ) -> Option<Vec<i16>> {
        let mut row = self.row(ui);
        self.caption(ui, &mut row, caption, theme::PLAN_CAPTION);
        let numbers: Vec<String> = numbers.iter().map(i16::to_string).collect();
        let shown = numbers.join(", ");
        let typed = self.text(ui, row, (name, hint), (&shown, LIST_CHARS));
        let read = typed.map(|text| list(&text, most));
        match read {
            Some(Err(why)) => self.form.refused = Some((field, why)),
            Some(Ok(_)) => self.form.refused = None,
            None => {}
        }
        self.trouble(ui, field);
        read.and_then(Result::ok)
    }

    fn text(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        (name, hint): (Text, Text),
        (value, max): (&str, usize),
    ) -> Option<String> {
        let look = self.pane.look;
        if self.disabled.is_some() {
            Label::new(value, look.palette.faint).put(ui, rect);
            return None;
        }
        let field = TextField {
            name: look.say(name),
            hint: look.say(hint),
            value,
            max,
        };
        let id = Id::unique(("trial text", name.en));
        field.put(ui, &mut self.form.typed, rect, id)
    }

    fn number(&mut self, ui: &mut Ui, row: &mut Rect, number: Number) -> Option<f64> {
        let look = self.pane.look;
        let field = NumberField {
            name: look.say(number.name),
            tip: look.say(number.tip),
            disabled: self.disabled,
            value: Some(number.value),
            range: number.range.0..=number.range.1,
            decimals: number.decimals,
        };
        let room = row.width().min(theme::PLAN_ANGLE);
        let place = take_left(row, room);
        let id = Id::unique(("trial number", number.name.en));
        field.put(ui, look, self.pane.typing, place, id)
    }

    fn approach(&mut self, ui: &mut Ui) {
        let look = self.pane.look;
        let chosen = ApproachKind::of(self.plan.approach);
        let choices: Vec<(ApproachKind, Approach)> = ApproachKind::ALL
            .into_iter()
            .zip(self.form.approaches)
            .collect();
        for pair in choices.chunks(2) {
            let mut row = self.row(ui);
            let width = (row.width() - theme::GAP) / 2.0;
            for (kind, approach) in pair {
                let words = look.say(trials::approach(*kind));
                let button = Button::new(words, look.say(tune::APPROACH_TIP))
                    .choice(chosen == *kind)
                    .disabled(self.disabled);
                let place = take_left(&mut row, width);
                let id = Id::unique(("trial reach", kind));
                if button.put(ui, look, place, id).clicked() {
                    self.plan.approach = *approach;
                }
            }
        }
        let Approach::TwoStage { fast, until } = self.plan.approach else {
            return;
        };
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::FAST, theme::PLAN_CAPTION_SHORT);
        let number = Number {
            name: tune::FAST,
            tip: tune::FAST_TIP,
            value: fast.get().into(),
            range: (1.0, 1000.0),
            decimals: 0,
        };
        let typed = self.number(ui, &mut row, number);
        let fast = typed.map_or(fast, |typed| Speed::nearest(whole(typed)));
        let until = self.until(ui, &mut row, until);
        self.plan.approach = Approach::TwoStage { fast, until };
        self.trouble(ui, PlanField::Fast);
        self.trouble(ui, PlanField::Until);
    }

    /// When the fast stage ends, as it is now or was typed.
    fn until(&mut self, ui: &mut Ui, row: &mut Rect, until: Until) -> Until {
        let (name, tip, most) = match until {
            Until::Measured { .. } => (tune::UNTIL_MARGIN, tune::UNTIL_MARGIN_TIP, 500.0),
            Until::Angle(_) => (tune::UNTIL_ANGLE, tune::UNTIL_ANGLE_TIP, 1000.0),
            Until::Proximity(_) => (
                tune::UNTIL_PROXIMITY,
                tune::UNTIL_PROXIMITY_TIP,
                16_000_000.0,
            ),
            Until::Touch(_) => (tune::UNTIL_TOUCH, tune::UNTIL_TOUCH_TIP, 3000.0),
        };
        let words = self.pane.look.say(name);
        let width = controls::text_width(ui, words, theme::small()) + 1.0;
        self.caption(ui, row, name, width);
        let number = Number {
            name,
            tip,
            value: until.value().into(),
            range: (0.0, most),
            decimals: 0,
        };
        let typed = self.number(ui, row, number);
        let typed = typed.and_then(|typed| Until::new(until.name(), whole(typed)).ok());
        typed.unwrap_or(until)
    }

    fn times(&mut self, ui: &mut Ui) {
        let mut row = self.row(ui);
        let seconds = |name, tip, value: Duration| Number {
            name,
            tip,
            value: value.as_secs_f64(),
            range: (0.0, 600.0),
            decimals: 1,
        };
        let of = |seconds: f64| Duration::try_from_secs_f64(seconds).unwrap_or_default();
        self.caption(ui, &mut row, tune::DWELL, theme::PLAN_CAPTION_SHORT);
        let dwell = seconds(tune::DWELL, tune::DWELL_TIP, self.plan.dwell);
        if let Some(dwell) = self.number(ui, &mut row, dwell) {
            self.plan.dwell = of(dwell);
        }
        self.caption(ui, &mut row, tune::REST, theme::PLAN_CAPTION_SHORT);
        let rest = seconds(tune::REST, tune::REST_TIP, self.plan.grid.rest);
        if let Some(rest) = self.number(ui, &mut row, rest) {
            self.plan.grid.rest = of(rest);
        }
        self.trouble(ui, PlanField::Dwell);
        self.trouble(ui, PlanField::Rest);
    }

    fn limits(&mut self, ui: &mut Ui) {
        let number = |name, tip, value: i16, most: f64| Number {
            name,
            tip,
            value: value.into(),
            range: (1.0, most),
            decimals: 0,
        };
        let limits = self.plan.limits;
        let mut row = self.row(ui);
        let (name, tip) = (tune::CEILING_CAPTION, tune::CEILING_TIP);
        self.caption(ui, &mut row, name, theme::PLAN_CAPTION_SHORT);
        let ceiling = number(name, tip, limits.ceiling_g, 4000.0);
        if let Some(ceiling) = self.number(ui, &mut row, ceiling) {
            self.plan.limits.ceiling_g = i16::try_from(whole(ceiling)).unwrap_or(i16::MAX);
        }
        self.trouble(ui, PlanField::Ceiling);
        let mut row = self.row(ui);
        let celsius = |typed: f64| u8::try_from(whole(typed)).unwrap_or(u8::MAX);
        let (name, tip) = (tune::STOP_C, tune::STOP_C_TIP);
        self.caption(ui, &mut row, name, theme::PLAN_CAPTION_SHORT);
        let stop = number(name, tip, limits.stop_c.into(), 100.0);
        if let Some(stop) = self.number(ui, &mut row, stop) {
            self.plan.limits.stop_c = celsius(stop);
        }
        let (name, tip) = (tune::START_C, tune::START_C_TIP);
        self.caption(ui, &mut row, name, theme::PLAN_CAPTION_SHORT);
        let start = number(name, tip, limits.start_c.into(), 100.0);
        if let Some(start) = self.number(ui, &mut row, start) {
            self.plan.limits.start_c = celsius(start);
        }
        self.trouble(ui, PlanField::Heat);
    }

    fn words(&mut self, ui: &mut Ui) {
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::NOTE, theme::PLAN_CAPTION_SHORT);
        let note = self.plan.note.clone();
        let texts = (tune::NOTE, tune::NOTE_HINT);
        if let Some(note) = self.text(ui, row, texts, (&note, NOTE_CHARS)) {
            self.plan.note = note;
        }
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::TAGS, theme::PLAN_CAPTION_SHORT);
        let tags = self.plan.tags.join(", ");
        let texts = (tune::TAGS, tune::TAGS_HINT);
        if let Some(tags) = self.text(ui, row, texts, (&tags, LIST_CHARS)) {
            self.plan.tags = crate::app::trials::form::tags(&tags);
        }
    }
}

/// A typed whole number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a field lets only numbers of its range pass"
)]
fn whole(number: f64) -> i64 {
    number.round() as i64
}
