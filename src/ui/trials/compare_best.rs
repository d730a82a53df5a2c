//! The map of overshoot over speed and threshold, and the best setting by what a person wants. Writes nothing.

use crate::app::action::Action;
use crate::app::trials::{Comparison, TrialSession};
use crate::hand::Dof;
use crate::params::rows::{ParamId, Value};
use crate::trials::best::{Score, best};
use crate::trials::{Criterion, TrialSetting};
use crate::ui::kit::{Button, Label, NumberField, Pane};
use crate::ui::text::tune;
use crate::ui::theme;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_list;
use egui::{
    Align2, CornerRadius, Grid, Role, ScrollArea, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo,
    vec2,
};

/// Overshoot that the fastest may have, g.
const OVERSHOOT_G: f64 = 100.0;
/// The overshoot that is as hot as can be, g.
const HOTTEST_G: f64 = 1000.0;
/// From this share of the heat on its colour is strong.
const BRIGHT: f32 = 0.6;
/// Room for a speed or a threshold beside the map.
const HEAD: Vec2 = vec2(44.0, 17.0);
/// Between its cells.
const GAP: f32 = 2.0;

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
        pane: &mut Pane<'_>,
        comparison: &Comparison,
        focus: &TrialSession,
    ) {
        let look = pane.look;
        ui.horizontal_wrapped(|ui| {
            for (wanted, text) in [
                (Wanted::LeastOvershoot, tune::LEAST_OVER),
                (Wanted::Fastest, tune::FASTEST),
            ] {
                let button = Button::new(look.say(text), look.tip(tune::BEST));
                let button = button.choice(self.wanted == wanted);
                if button.ui(ui, look).clicked() {
                    self.wanted = wanted;
                }
            }
        });
        ui.horizontal(|ui| {
            let name = look.say(tune::HOLD_AT_LEAST);
            Label::new(name, look.palette.muted).small().ui(ui);
            let field = NumberField::new(name, look.say(tune::HOLD_TIP), 0.0..=4000.0);
            if let Some(steady_g) = field.ui(ui, pane, Some(self.steady_g)) {
                self.steady_g = steady_g;
            }
        });
        let best = best(&comparison.scores, self.criterion()).map(|score| score.setting);
        best_ui(ui, pane, comparison, best);
        if comparison.sessions().len() > 1 {
            of_ui(ui, pane, comparison, focus);
        }
        Label::note(look, tune::MAP).ui(ui);
        map_ui(ui, pane, &comparison.scores, best);
    }
}

fn best_ui(ui: &mut Ui, pane: &mut Pane<'_>, comparison: &Comparison, best: Option<TrialSetting>) {
    let (look, palette) = (pane.look, pane.look.palette);
    let none = look.say(tune::BEST_NONE);
    let (text, color) = match best {
        Some(setting) => (setting_words(setting), palette.ok),
        None => (none.to_owned(), palette.muted),
    };
    ui.horizontal_wrapped(|ui| {
        let label = Label::new(&text, color).named(look.say(tune::BEST));
        label.font(theme::title()).ui(ui);
        let button = Button::said(look, tune::PROMOTE);
        let button = button.disabled(best.is_none().then_some(none));
        let clicked = button.ui(ui, look).clicked();
        if let Some(setting) = best.filter(|_| clicked) {
            let joints = comparison.joints.iter();
            pane.actions
                .extend(joints.flat_map(|dof| staging(*dof, setting)));
        }
    });
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
fn of_ui(ui: &mut Ui, pane: &Pane<'_>, comparison: &Comparison, focus: &TrialSession) {
    let look = pane.look;
    let differences = comparison.differences.iter();
    let words: Vec<&str> = differences
        .map(|difference| look.say(tune::difference(*difference)))
        .collect();
    if words.is_empty() {
        Label::note(look, tune::TOGETHER).ui(ui);
        return;
    }
    let own = compare_list::name(look, focus.id);
    let text = look.fill(tune::ALONE, &[&own, &look.list(&words)]);
    let label = Label::new(&text, look.palette.warn).small().wrap();
    label.ui(ui).on_hover_text(look.tip(tune::ALONE));
}

/// Overshoot as colours with numbers: speeds below each other, thresholds side by side.
fn map_ui(ui: &mut Ui, pane: &Pane<'_>, scores: &[Score], best: Option<TrialSetting>) {
    let muted = pane.look.palette.muted;
    let mut speeds: Vec<i16> = scores.iter().map(|own| own.setting.speed.get()).collect();
    let mut forces: Vec<i16> = scores.iter().map(|own| own.setting.force.get()).collect();
    for list in [&mut speeds, &mut forces] {
        list.sort_unstable();
        list.dedup();
    }
    let count = f32::from(u8::try_from(forces.len().max(1)).unwrap_or(u8::MAX));
    let width = (ui.available_width() - HEAD.x) / count - GAP;
    let size = vec2(width.clamp(44.0, 84.0), 24.0);
    let head_ui = |ui: &mut Ui, size: Vec2, text: String| {
        let (_, place) = ui.allocate_space(size);
        let (middle, font) = (Align2::CENTER_CENTER, theme::number());
        ui.painter().text(place.center(), middle, text, font, muted);
    };
    let area = ScrollArea::horizontal().auto_shrink([false, true]);
    area.id_salt("map").show(ui, |ui| {
        let grid = Grid::new("overshoot").spacing(Vec2::splat(GAP));
        grid.min_row_height(HEAD.y).show(ui, |ui| {
            ui.allocate_space(HEAD);
            for force in &forces {
                head_ui(ui, vec2(size.x, HEAD.y), format!("{force} g"));
            }
            ui.end_row();
            for speed in &speeds {
                head_ui(ui, vec2(HEAD.x, size.y), speed.to_string());
                for force in &forces {
                    let is_own = |score: &&Score| {
                        let setting = score.setting;
                        setting.speed.get() == *speed && setting.force.get() == *force
                    };
                    if let Some(score) = scores.iter().find(is_own) {
                        cell_ui(ui, pane, (score, size), Some(score.setting) == best);
                    } else {
                        ui.allocate_space(size);
                    }
                }
                ui.end_row();
            }
        });
    });
}

fn cell_ui(ui: &mut Ui, pane: &Pane<'_>, (score, size): (&Score, Vec2), best: bool) {
    let palette = pane.look.palette;
    let over = score.overshoot_g.map(|spread| spread.max);
    let text = over.map_or_else(|| "-".to_owned(), |over| format!("{over:.0}"));
    let name = format!("{}: {text} g", setting_words(score.setting));
    let (cell, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
    response.on_hover_text(&name);
    #[expect(clippy::cast_possible_truncation, reason = "a share of a colour scale")]
    let level = over.map(|over| (over / HOTTEST_G).clamp(0.0, 1.0) as f32);
    let (ground, ink) = match level {
        Some(level) => (palette.heat(level), palette.on_heat(level >= BRIGHT)),
        None => (palette.sunken, palette.muted),
    };
    let round = CornerRadius::same(theme::ROUND_TINY);
    let edge = if best { theme::STRONG } else { 0.0 };
    let edge = Stroke::new(edge, palette.accent);
    ui.painter()
        .rect(cell, round, ground, edge, StrokeKind::Inside);
    let (middle, font) = (Align2::CENTER_CENTER, theme::number());
    ui.painter().text(cell.center(), middle, text, font, ink);
}
