//! The plan of a series as fields, each with what is wrong beside it. Every change is one action with the whole plan.

use crate::app::action::Action;
use crate::app::tuner::draft::{ListError, Side, Take, list};
use crate::app::tuner::{Draft, Field, Reach, TrialWish};
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::ui::controls::{self, Button, Label, take_left};
use crate::ui::list;
use crate::ui::look::Pane;
use crate::ui::number::NumberField;
use crate::ui::text::{Text, trials, tune, words};
use crate::ui::text_field::TextField;
use crate::ui::theme;
use egui::{Id, Rect, Ui};
use std::time::Duration;

/// Characters of a list, a note, and all tags.
const LIST_CHARS: usize = 80;
const NOTE_CHARS: usize = 300;

/// What the form needs between frames.
#[derive(Debug, Default)]
pub(crate) struct TuneForm {
    typed: Option<(Id, String)>,
    refused: Option<(Field, ListError)>,
}

/// One pass over the form.
struct Pass<'a, 'p> {
    pane: &'a mut Pane<'p>,
    form: &'a mut TuneForm,
    draft: Draft,
    wrong: Option<(Field, String)>,
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
    /// Draws it. What was changed is asked for.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let tuner = &pane.state.tuner;
        let draft = tuner.draft.clone();
        let error = draft.plan().check().err();
        let wrong = error.map(|error| (Field::of(&error), trials::plan_error(look, &error)));
        let refused = self.refused;
        let refused = refused.map(|(field, why)| (field, trials::list_error(look, why)));
        let disabled = tuner.is_running().then(|| look.say(tune::RUNS));
        let mut pass = Pass {
            wrong: refused.or(wrong),
            pane,
            form: self,
            draft,
            disabled,
            width: 0.0,
        };
        list::scroll_ui(ui, rect, "trial plan", |ui, width| {
            pass.width = width;
            pass.all(ui);
        });
        let draft = pass.draft;
        if draft != pane.state.tuner.draft && disabled.is_none() {
            let wish = TrialWish::Draft(Box::new(draft));
            pane.actions.push(Action::Trial(wish));
        }
    }
}

impl Pass<'_, '_> {
    fn all(&mut self, ui: &mut Ui) {
        self.title(ui, tune::JOINTS);
        for dof in Dof::ALL {
            self.joint(ui, dof);
        }
        self.trouble(ui, Field::Joints);
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
    fn trouble(&self, ui: &mut Ui, field: Field) {
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
        let takes_part = self.draft.joints[dof];
        let name = look.say(words::dof(dof));
        let label = format!("{name}: {}", look.say(tune::JOINTS));
        let button = Button::new(name, look.say(tune::JOINT_TIP))
            .named(&label)
            .disabled(self.disabled)
            .choice(takes_part);
        let place = take_left(&mut row, theme::PLAN_JOINT);
        let id = Id::unique(("trial joint", dof));
        if button.put(ui, look, place, id).clicked() {
            let take = if takes_part { Take::NoPart } else { Take::Part };
            self.draft = self.draft.clone().with_joint(dof, take);
        }
        let start = self.draft.start[dof];
        if let Some(angle) = self.angle(ui, &mut row, (dof, Side::Start), start) {
            self.draft.start[dof] = Some(angle);
        }
        if takes_part {
            let close = Some(self.draft.close[dof]);
            if let Some(angle) = self.angle(ui, &mut row, (dof, Side::Close), close) {
                self.draft.close[dof] = angle;
            }
        }
        self.trouble(ui, Field::Way(dof));
    }

    fn angle(
        &mut self,
        ui: &mut Ui,
        row: &mut Rect,
        (dof, side): (Dof, Side),
        angle: Option<Angle>,
    ) -> Option<Angle> {
        let look = self.pane.look;
        let (caption, tip) = match side {
            Side::Start => (tune::START, tune::START_TIP),
            Side::Close => (tune::CLOSE, tune::CLOSE_TIP),
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
            (Side::Start, tune::TAKE_START),
            (Side::Close, tune::TAKE_CLOSE),
        ] {
            let place = take_left(&mut row, width);
            let button =
                Button::new(look.say(text), look.say(tune::TAKE_TIP)).disabled(self.disabled);
            let response = button.put(ui, look, place, Id::unique(("trial pose", side)));
            let state = self.pane.state;
            let mut taken = None;
            egui::Popup::menu(&response).show(|ui| {
                ui.set_width(theme::MENU_WIDTH);
                let now = state.pose_now();
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
                self.take(side, &angles);
            }
        }
    }

    fn take(&mut self, side: Side, angles: &PerDof<Option<Angle>>) {
        self.draft = self.draft.clone().with_pose(side, angles);
    }

    fn lists(&mut self, ui: &mut Ui) {
        let speeds = self.draft.speeds.iter().map(|speed| speed.get());
        let texts = (tune::SPEEDS, tune::SPEEDS_NAME, tune::SPEEDS_HINT);
        let most = Speed::MAX.get();
        if let Some(speeds) = self.list(ui, Field::Speeds, texts, (speeds.collect(), most)) {
            self.draft.speeds = speeds.into_iter().map(Speed::nearest).collect();
        }
        let forces = self.draft.forces.iter().map(|force| force.get());
        let texts = (tune::FORCES, tune::FORCES_NAME, tune::FORCES_HINT);
        let most = Force::MAX.get();
        if let Some(forces) = self.list(ui, Field::Forces, texts, (forces.collect(), most)) {
            self.draft.forces = forces.into_iter().map(Force::nearest).collect();
        }
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::REPEATS, theme::PLAN_CAPTION);
        let number = Number {
            name: tune::REPEATS,
            tip: tune::REPEATS_TIP,
            value: f64::from(u16::try_from(self.draft.repeats).unwrap_or(u16::MAX)),
            range: (1.0, 1000.0),
            decimals: 0,
        };
        if let Some(repeats) = self.number(ui, &mut row, number) {
            self.draft.repeats = usize::try_from(whole(repeats)).unwrap_or(1);
        }
        self.trouble(ui, Field::Repeats);
    }

    /// A list of numbers; it, once one that can be taken was typed.
    fn list(
        &mut self,
        ui: &mut Ui,
        field: Field,
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
        for pair in Reach::ALL.chunks(2) {
            let mut row = self.row(ui);
            let width = (row.width() - theme::GAP) / 2.0;
            for reach in pair {
                let button = Button::new(
                    look.say(trials::reach(*reach)),
                    look.say(tune::APPROACH_TIP),
                );
                let button = button.choice(self.draft.reach == *reach);
                let button = button.disabled(self.disabled);
                let place = take_left(&mut row, width);
                let id = Id::unique(("trial reach", reach));
                if button.put(ui, look, place, id).clicked() {
                    self.draft.reach = *reach;
                }
            }
        }
        if self.draft.reach == Reach::OneStage {
            return;
        }
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::FAST, theme::PLAN_CAPTION_SHORT);
        let number = Number {
            name: tune::FAST,
            tip: tune::FAST_TIP,
            value: self.draft.fast.get().into(),
            range: (1.0, 1000.0),
            decimals: 0,
        };
        if let Some(fast) = self.number(ui, &mut row, number) {
            self.draft.fast = Speed::nearest(whole(fast));
        }
        self.until(ui, &mut row);
        self.trouble(ui, Field::Fast);
        self.trouble(ui, Field::Until);
    }

    fn until(&mut self, ui: &mut Ui, row: &mut Rect) {
        let draft = &self.draft;
        let (name, tip, value, most) = match draft.reach {
            Reach::OneStage => return,
            Reach::Measured => (
                tune::UNTIL_MARGIN,
                tune::UNTIL_MARGIN_TIP,
                f64::from(draft.until_margin),
                500.0,
            ),
            Reach::Angle => (
                tune::UNTIL_ANGLE,
                tune::UNTIL_ANGLE_TIP,
                draft.until_angle.get().into(),
                1000.0,
            ),
            Reach::Proximity => (
                tune::UNTIL_PROXIMITY,
                tune::UNTIL_PROXIMITY_TIP,
                draft.until_proximity.into(),
                16_000_000.0,
            ),
            Reach::Touch => (
                tune::UNTIL_TOUCH,
                tune::UNTIL_TOUCH_TIP,
                draft.until_touch.get().into(),
                3000.0,
            ),
        };
        let words = self.pane.look.say(name);
        let width = controls::text_width(ui, words, theme::small()) + 1.0;
        self.caption(ui, row, name, width);
        let number = Number {
            name,
            tip,
            value,
            range: (0.0, most),
            decimals: 0,
        };
        let Some(typed) = self.number(ui, row, number).map(whole) else {
            return;
        };
        match self.draft.reach {
            Reach::OneStage => {}
            Reach::Measured => self.draft.until_margin = i16::try_from(typed).unwrap_or(i16::MAX),
            Reach::Angle => self.draft.until_angle = Angle::nearest(typed),
            Reach::Proximity => {
                self.draft.until_proximity = i32::try_from(typed).unwrap_or(i32::MAX);
            }
            Reach::Touch => self.draft.until_touch = Force::nearest(typed),
        }
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
        let dwell = seconds(tune::DWELL, tune::DWELL_TIP, self.draft.dwell);
        if let Some(dwell) = self.number(ui, &mut row, dwell) {
            self.draft.dwell = of(dwell);
        }
        self.caption(ui, &mut row, tune::REST, theme::PLAN_CAPTION_SHORT);
        let rest = seconds(tune::REST, tune::REST_TIP, self.draft.rest);
        if let Some(rest) = self.number(ui, &mut row, rest) {
            self.draft.rest = of(rest);
        }
        self.trouble(ui, Field::Dwell);
        self.trouble(ui, Field::Rest);
    }

    fn limits(&mut self, ui: &mut Ui) {
        let number = |name, tip, value: i16, most: f64| Number {
            name,
            tip,
            value: value.into(),
            range: (1.0, most),
            decimals: 0,
        };
        let limits = self.draft.limits;
        let mut row = self.row(ui);
        let (name, tip) = (tune::CEILING_CAPTION, tune::CEILING_TIP);
        self.caption(ui, &mut row, name, theme::PLAN_CAPTION_SHORT);
        let ceiling = number(name, tip, limits.ceiling_g, 4000.0);
        if let Some(ceiling) = self.number(ui, &mut row, ceiling) {
            self.draft.limits.ceiling_g = i16::try_from(whole(ceiling)).unwrap_or(i16::MAX);
        }
        self.trouble(ui, Field::Ceiling);
        let mut row = self.row(ui);
        let celsius = |typed: f64| u8::try_from(whole(typed)).unwrap_or(u8::MAX);
        let (name, tip) = (tune::STOP_C, tune::STOP_C_TIP);
        self.caption(ui, &mut row, name, theme::PLAN_CAPTION_SHORT);
        let stop = number(name, tip, limits.stop_c.into(), 100.0);
        if let Some(stop) = self.number(ui, &mut row, stop) {
            self.draft.limits.stop_c = celsius(stop);
        }
        let (name, tip) = (tune::START_C, tune::START_C_TIP);
        self.caption(ui, &mut row, name, theme::PLAN_CAPTION_SHORT);
        let start = number(name, tip, limits.start_c.into(), 100.0);
        if let Some(start) = self.number(ui, &mut row, start) {
            self.draft.limits.start_c = celsius(start);
        }
        self.trouble(ui, Field::Heat);
    }

    fn words(&mut self, ui: &mut Ui) {
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::NOTE, theme::PLAN_CAPTION_SHORT);
        let note = self.draft.note.clone();
        let texts = (tune::NOTE, tune::NOTE_HINT);
        if let Some(note) = self.text(ui, row, texts, (&note, NOTE_CHARS)) {
            self.draft.note = note;
        }
        let mut row = self.row(ui);
        self.caption(ui, &mut row, tune::TAGS, theme::PLAN_CAPTION_SHORT);
        let tags = self.draft.tags.join(", ");
        let texts = (tune::TAGS, tune::TAGS_HINT);
        if let Some(tags) = self.text(ui, row, texts, (&tags, LIST_CHARS)) {
            self.draft.tags = crate::app::tuner::draft::tags(&tags);
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
