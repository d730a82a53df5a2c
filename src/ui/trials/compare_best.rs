//! The map of overshoot over speed and threshold, and the best setting by what a person wants. Writes nothing.

use crate::app::action::Action;
use crate::app::trials::{Comparison, SessionDifference, TrialSession};
use crate::hand::Dof;
use crate::params::rows::{ParamId, Value};
use crate::trials::best::{Score, best};
use crate::trials::{Criterion, TrialSetting};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left, take_right, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::kit::number::NumberField;
use crate::ui::text::{Text, compare, tune};
use crate::ui::theme;
use crate::ui::trials::compare_choice::choice_ui;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_list;
use egui::{Align2, CornerRadius, Id, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2};

/// Overshoot that the fastest may have, g.
const OVERSHOOT_G: f64 = 100.0;
/// The overshoot that is as hot as can be, g.
const HOTTEST_G: f64 = 1000.0;

/// What is best.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Wanted {
    #[default]
    LeastOvershoot,
    Fastest,
}

/// What is wanted of the best.
#[derive(Debug, Default)]
pub(crate) struct BestView {
    wanted: Wanted,
    steady_g: f64,
}

impl BestView {
    /// What is best.
    pub(crate) fn criterion(&self) -> Criterion {
        let steady_g = self.steady_g;
        match self.wanted {
            Wanted::LeastOvershoot => Criterion::LeastOvershoot { steady_g },
            Wanted::Fastest => Criterion::Fastest {
                overshoot_g: OVERSHOOT_G,
                steady_g,
            },
        }
    }

    /// Draws the choice, the best, and the map.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        mut rect: Rect,
        pane: &mut Pane<'_>,
        comparison: &Comparison,
        focus: &TrialSession,
    ) {
        let look = pane.look;
        let mut row = take_top(&mut rect, theme::CONTROL);
        for (wanted, text) in [
            (Wanted::LeastOvershoot, tune::LEAST_OVER),
            (Wanted::Fastest, tune::FASTEST),
        ] {
            let texts = (look.say(text), look.say(tune::BEST_TIP));
            if choice_ui(ui, &mut row, pane, texts, self.wanted == wanted) {
                self.wanted = wanted;
            }
        }
        self.hold_ui(ui, take_top(&mut rect, theme::CONTROL), pane);
        let best = best(&comparison.scores, self.criterion()).map(|score| score.setting);
        let row = take_top(&mut rect, theme::CONTROL);
        best_ui(ui, row, pane, comparison, best);
        if comparison.sessions().len() > 1 {
            of_ui(
                ui,
                take_top(&mut rect, theme::LIST_LINE),
                pane,
                comparison,
                focus,
            );
        }
        map_ui(ui, rect, pane, &comparison.scores, best);
    }

    fn hold_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let name = look.say(tune::HOLD_AT_LEAST);
        let place = take_left(&mut row, theme::PLAN_CAPTION);
        Label::new(name, look.palette.muted).small().put(ui, place);
        let field = NumberField {
            name,
            tip: look.say(tune::HOLD_TIP),
            disabled: None,
            value: Some(self.steady_g),
            range: 0.0..=4000.0,
            decimals: 0,
        };
        let place = take_left(&mut row, theme::PLAN_ANGLE);
        let id = Id::unique("trial hold");
        if let Some(steady_g) = field.put(ui, look, pane.typing, place, id) {
            self.steady_g = steady_g;
        }
    }
}

fn best_ui(
    ui: &mut Ui,
    mut row: Rect,
    pane: &mut Pane<'_>,
    comparison: &Comparison,
    best: Option<TrialSetting>,
) {
    let look = pane.look;
    let none = look.say(tune::BEST_NONE);
    let words = look.say(tune::PROMOTE);
    let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::PAD;
    let place = take_right(&mut row, width);
    let button = Button::new(words, look.say(tune::PROMOTE_TIP));
    let button = button.disabled(best.is_none().then_some(none));
    let clicked = button.put(ui, look, place, Id::unique("promote"));
    if let Some(setting) = best.filter(|_| clicked.clicked()) {
        for dof in &comparison.joints {
            pane.actions.extend(staging(*dof, setting));
        }
    }
    let text = best.map_or_else(|| none.to_owned(), setting_words);
    let color = if best.is_some() {
        look.palette.ok
    } else {
        look.palette.muted
    };
    Label::new(&text, color)
        .named(look.say(tune::BEST))
        .put(ui, row);
}

/// What stages a setting as the one after power-up.
pub(crate) fn staging(dof: Dof, setting: TrialSetting) -> [Action; 2] {
    let speed = Value::Number(setting.speed.get().into());
    let force = Value::Number(setting.force.get().into());
    [
        Action::Stage(ParamId::DefaultSpeed(dof), Some(speed)),
        Action::Stage(ParamId::DefaultForce(dof), Some(force)),
    ]
}

/// Over which sessions map and best are, and why not over all.
fn of_ui(ui: &mut Ui, row: Rect, pane: &Pane<'_>, comparison: &Comparison, focus: &TrialSession) {
    let look = pane.look;
    let differences = &comparison.differences;
    if differences.is_empty() {
        Label::new(look.say(compare::TOGETHER), look.palette.muted)
            .small()
            .put(ui, row);
        return;
    }
    let words: Vec<&str> = differences
        .iter()
        .map(|difference| look.say(difference_words(*difference)))
        .collect();
    let own = compare_list::name(look, focus.id);
    let text = format!("{own} {} {}", look.say(compare::ALONE), words.join(", "));
    Label::new(&text, look.palette.warn)
        .small()
        .put(ui, row)
        .on_hover_text(look.say(compare::ALONE_TIP));
}

const fn difference_words(difference: SessionDifference) -> Text {
    match difference {
        SessionDifference::Hand => compare::HAND,
        SessionDifference::Joints => compare::JOINTS,
        SessionDifference::Way => compare::WAY,
        SessionDifference::Approach => compare::APPROACH,
        SessionDifference::Dwell => compare::DWELL,
    }
}

/// Overshoot as colours with numbers: speeds below each other, thresholds side by side.
fn map_ui(
    ui: &mut Ui,
    mut rect: Rect,
    pane: &Pane<'_>,
    scores: &[Score],
    best: Option<TrialSetting>,
) {
    let look = pane.look;
    let place = take_top(&mut rect, theme::LIST_LINE);
    let title = look.say(tune::MAP);
    Label::new(title, look.palette.muted).small().put(ui, place);
    let mut speeds: Vec<i16> = scores.iter().map(|own| own.setting.speed.get()).collect();
    let mut forces: Vec<i16> = scores.iter().map(|own| own.setting.force.get()).collect();
    for list in [&mut speeds, &mut forces] {
        list.sort_unstable();
        list.dedup();
    }
    let count = |list: &[i16]| f32::from(u8::try_from(list.len().max(1)).unwrap_or(u8::MAX));
    let room = (rect.width() - theme::MAP_HEAD) / count(&forces);
    let width = room.clamp(theme::MAP_CELL_LEAST, theme::MAP_CELL_MOST);
    let height = (rect.height() / (count(&speeds) + 1.0)).min(theme::MAP_CELL);
    let size = vec2(width, height);
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    let number = |center, text: String, color| {
        painter.text(
            center,
            Align2::CENTER_CENTER,
            text,
            theme::number_small(),
            color,
        )
    };
    let mut top = rect.min + vec2(theme::MAP_HEAD, 0.0);
    for force in &forces {
        let cell = Rect::from_min_size(top, size);
        number(cell.center(), format!("{force} g"), look.palette.faint);
        top.x += width;
    }
    for (at, speed) in (1_u8..).zip(&speeds) {
        let mut corner = rect.min + vec2(0.0, height * f32::from(at));
        let head = Rect::from_min_size(corner, vec2(theme::MAP_HEAD, height));
        number(head.center(), speed.to_string(), look.palette.faint);
        corner.x += theme::MAP_HEAD;
        for force in &forces {
            let cell = Rect::from_min_size(corner, size).shrink(1.0);
            corner.x += width;
            let is_own = |score: &&Score| {
                score.setting.speed.get() == *speed && score.setting.force.get() == *force
            };
            let score = scores.iter().find(is_own);
            let chosen = score.is_some_and(|score| Some(score.setting) == best);
            cell_ui(ui, cell.intersect(rect), pane, score, chosen);
        }
    }
}

fn cell_ui(ui: &Ui, cell: Rect, pane: &Pane<'_>, score: Option<&Score>, best: bool) {
    let look = pane.look;
    let Some(score) = score.filter(|_| cell.is_positive()) else {
        return;
    };
    let over = score.overshoot_g.map(|spread| spread.max);
    let text = over.map_or_else(|| "-".to_owned(), |over| format!("{over:.0}"));
    let name = format!("{}: {text} g", setting_words(score.setting));
    let id = Id::unique(("trial map", score.setting));
    let response = ui.interact(cell, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
    response.on_hover_text(&name);
    #[expect(clippy::cast_possible_truncation, reason = "a share of a colour scale")]
    let level = over.map(|over| (over / HOTTEST_G).clamp(0.0, 1.0) as f32);
    let ground = level.map_or(look.palette.sunken, |level| look.palette.heat(level));
    let round = CornerRadius::same(theme::ROUND_TINY);
    ui.painter().rect_filled(cell, round, ground);
    let ink = match level {
        Some(level) => look.palette.on_heat(level >= theme::HEAT_BRIGHT),
        None => look.palette.muted,
    };
    let font = theme::number_small();
    ui.painter()
        .text(cell.center(), Align2::CENTER_CENTER, text, font, ink);
    if best {
        let stroke = Stroke::new(theme::STRONG, look.palette.accent);
        ui.painter()
            .rect_stroke(cell, round, stroke, StrokeKind::Inside);
    }
}
