//! The map of overshoot over speed and threshold, and the best setting by the user's criterion, which can be made the default.
//! Writes nothing: a card asks first.

use crate::app::trials::{Comparison, TrialSession};
use crate::trials::Criterion;
use crate::trials::best::{MetricSpread, Score};
use crate::ui::kit::{self, Label, NumberField, Pane, Pick};
use crate::ui::text::tune;
use crate::ui::theme::{self, Palette};
use crate::ui::trials::compare_choice::ResultsPlace;
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_list;
use crate::ui::trials::promotion::Promotion;
use egui::{
    Align2, CornerRadius, Grid, Mesh, Role, ScrollArea, Sense, Ui, Vec2, WidgetInfo, pos2, vec2,
};

/// Maximum overshoot of the fastest setting, in grams.
const OVERSHOOT_G: f64 = 100.0;
/// Size and number of steps of the map's colour bar.
const SCALE: Vec2 = vec2(96.0, 8.0);
const SCALE_STEPS: u8 = 16;
/// Space for a speed or a threshold beside the map.
const HEAD: Vec2 = vec2(44.0, 17.0);
/// Gap between cells.
const GAP: f32 = 2.0;

/// Criterion chosen by the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum CriterionChoice {
    #[default]
    LeastOvershoot,
    Fastest,
}

/// View state of the best setting.
#[derive(Debug, Default)]
pub(crate) struct BestView {
    criterion: CriterionChoice,
    steady_g: f64,
}

impl BestView {
    /// Criterion of the best setting.
    pub(crate) fn criterion(&self) -> Criterion {
        let steady_g = self.steady_g;
        match self.criterion {
            CriterionChoice::LeastOvershoot => Criterion::LeastOvershoot { steady_g },
            CriterionChoice::Fastest => Criterion::Fastest {
                overshoot_g: OVERSHOOT_G,
                steady_g,
            },
        }
    }

    /// Draws the choice, the best setting, and the map.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        comparison: &Comparison,
        (focus, place): (&TrialSession, ResultsPlace),
    ) {
        let look = pane.look;
        if comparison.found.is_none() {
            self.choice_ui(ui, pane);
        }
        best_ui(ui, pane, comparison, place);
        let own = pane.hand().connection.name();
        if focus.head.hand != own {
            let words = look.fill(tune::TRIED_ON, &[&focus.head.hand]);
            kit::small_text_ui(ui, &words, look.palette.warn);
        }
        if comparison.sessions().len() > 1 {
            of_ui(ui, pane, comparison, focus);
        }
        ui.add_space(theme::STEP);
        Label::note(look, tune::MAP).ui(ui);
        map_ui(ui, pane, comparison);
    }

    /// Draws the choice of the criterion.
    fn choice_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.horizontal_wrapped(|ui| {
            let all = [
                (CriterionChoice::LeastOvershoot, tune::LEAST_OVER),
                (CriterionChoice::Fastest, tune::FASTEST),
            ];
            Pick::new(look, tune::BEST.tip()).ui(ui, &mut self.criterion, all);
        });
        ui.horizontal(|ui| {
            let name = look.tr(tune::HOLD_AT_LEAST);
            Label::new(name, look.palette.muted).small().ui(ui);
            let field = NumberField::new(name, look.tr(tune::HOLD_TIP), 0.0..=4000.0);
            if let Some(steady_g) = field.ui(ui, pane, Some(self.steady_g)) {
                self.steady_g = steady_g;
            }
        });
    }
}

/// Draws the best setting, and the button that makes it the default.
pub(crate) fn best_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    comparison: &Comparison,
    place: ResultsPlace,
) {
    let (look, palette) = (pane.look, pane.look.palette);
    let best = comparison.best.as_ref();
    let none = look.tr(tune::BEST_NONE);
    let (text, color) = match best {
        Some(best) => (setting_words(best.setting), palette.ok),
        None => (none.to_owned(), palette.muted),
    };
    let joints = comparison.joints.iter();
    let settings = joints.filter_map(|dof| Some((*dof, best?.setting)));
    let promotion = Promotion::of(pane, settings, best.is_none().then_some(none));
    // The plan has the button beside what the search found.
    let promotes = comparison.found.is_none() || place == ResultsPlace::Alone;
    ui.horizontal_wrapped(|ui| {
        if best.is_some() {
            let star = Label::new(theme::BEST, color).font(theme::icon());
            star.named(look.tr(tune::BEST_SIGN)).ui(ui);
        }
        let label = Label::new(&text, color).named(look.tr(tune::BEST));
        label.ui(ui);
        if promotes {
            promotion.button_ui(ui, pane, tune::PROMOTE);
        }
    });
    if let Some(over) = best.and_then(|best| best.overshoot_g) {
        let words = look.fill(tune::BEST_OVER, &[&format!("{:.0}", over.max)]);
        kit::small_text_ui(ui, &words, palette.text);
    }
    if promotes {
        promotion.end_ui(ui, pane);
    }
}

/// Draws the sessions covered by map and best setting, and the reason why not all are.
fn of_ui(ui: &mut Ui, pane: &Pane<'_>, comparison: &Comparison, focus: &TrialSession) {
    let look = pane.look;
    let differences = comparison.differences.iter();
    let words: Vec<&str> = differences
        .map(|difference| look.tr(tune::difference(*difference)))
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

/// Draws overshoot as coloured numbers: one row per speed, one column per threshold. The colour scale below spans the measured
/// range.
fn map_ui(ui: &mut Ui, pane: &Pane<'_>, comparison: &Comparison) {
    let muted = pane.look.palette.muted;
    let scores = &comparison.scores;
    let mut speeds: Vec<i16> = scores.iter().map(|own| own.setting.speed.get()).collect();
    let mut forces: Vec<i16> = scores.iter().map(|own| own.setting.force.get()).collect();
    for list in [&mut speeds, &mut forces] {
        list.sort_unstable();
        list.dedup();
    }
    let over = scores.iter().filter_map(|score| score.overshoot_g);
    let over: Vec<f64> = over.map(|spread| spread.max).collect();
    let span = MetricSpread::of(&over);
    let count = f32::from(u8::try_from(forces.len().max(1)).unwrap_or(u8::MAX));
    let width = (ui.available_width() - HEAD.x) / count - GAP;
    let size = vec2(width.clamp(44.0, 84.0), 24.0);
    let grid = ScoreGrid {
        pane,
        comparison,
        size,
        span,
    };
    let head_ui = |ui: &mut Ui, size: Vec2, text: String| {
        let (_, place) = ui.allocate_space(size);
        let (middle, font) = (Align2::CENTER_CENTER, theme::number());
        ui.painter().text(place.center(), middle, text, font, muted);
    };
    let area = ScrollArea::horizontal().auto_shrink([false, true]);
    area.id_salt("map").show(ui, |ui| {
        let cells = Grid::new("overshoot").spacing(Vec2::splat(GAP));
        cells.min_row_height(HEAD.y).show(ui, |ui| {
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
                    match scores.iter().find(is_own) {
                        Some(score) => grid.cell_ui(ui, score),
                        None => drop(ui.allocate_space(size)),
                    }
                }
                ui.end_row();
            }
        });
    });
    if let Some(span) = span.filter(|span| span.max > span.min) {
        scale_ui(ui, pane, span);
    }
}

/// Position of a value within the measured range, 0..=1.
fn part(value: f64, span: MetricSpread) -> f64 {
    let wide = span.max - span.min;
    if wide > 0.0 {
        (value - span.min) / wide
    } else {
        0.0
    }
}

/// Cells of the map: one for each tried pair of speed and force threshold.
struct ScoreGrid<'a, 'p> {
    pane: &'a Pane<'p>,
    comparison: &'a Comparison,
    /// Size of a cell.
    size: Vec2,
    /// Range of the overshoot over all cells, by which they are coloured.
    span: Option<MetricSpread>,
}

impl ScoreGrid<'_, '_> {
    fn cell_ui(&self, ui: &mut Ui, score: &Score) {
        let palette = self.pane.look.palette;
        let is_best = self.comparison.is_best(score.setting);
        let over = score.overshoot_g.map(|spread| spread.max);
        let text = over.map_or_else(|| "-".to_owned(), |over| format!("{over:.0}"));
        let name = format!("{}: {text} g", setting_words(score.setting));
        let (cell, response) = ui.allocate_exact_size(self.size, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
        response.on_hover_text(&name);
        let level = over.zip(self.span).map(|(over, span)| part(over, span));
        let (ground, ink) = match level {
            _ if is_best => (palette.ok, Palette::ink_on(palette.ok)),
            Some(level) => {
                let ground = palette.scale(level);
                (ground, Palette::ink_on(ground))
            }
            None => (palette.sunken, palette.muted),
        };
        ui.painter()
            .rect_filled(cell, CornerRadius::same(theme::ROUND_TINY), ground);
        let (middle, font) = (Align2::CENTER_CENTER, theme::number());
        ui.painter().text(cell.center(), middle, text, font, ink);
        if is_best {
            let at = cell.left_center() + vec2(theme::STEP, 0.0);
            let left = Align2::LEFT_CENTER;
            let font = theme::icon_high(theme::SIGN_SMALL);
            ui.painter().text(at, left, theme::BEST, font, ink);
        }
    }
}

/// Draws the colour scale of the map: minimum at the left, maximum at the right.
fn scale_ui(ui: &mut Ui, pane: &Pane<'_>, span: MetricSpread) {
    let (look, palette) = (pane.look, pane.look.palette);
    let [least, most] = [span.min, span.max].map(|grams| format!("{grams:.0} g"));
    ui.horizontal(|ui| {
        ui.add_space(HEAD.x + GAP);
        Label::new(&least, palette.muted).small().ui(ui);
        let (bar, response) = ui.allocate_exact_size(SCALE, Sense::hover());
        let name = format!("{}: {least} .. {most}", look.tr(tune::MAP));
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
        let mut mesh = Mesh::default();
        for step in 0..=SCALE_STEPS {
            let part = f32::from(step) / f32::from(SCALE_STEPS);
            let color = palette.scale(part.into());
            let x = egui::lerp(bar.x_range(), part);
            mesh.colored_vertex(pos2(x, bar.top()), color);
            mesh.colored_vertex(pos2(x, bar.bottom()), color);
            if step > 0 {
                let at = 2 * u32::from(step);
                mesh.add_triangle(at - 2, at - 1, at);
                mesh.add_triangle(at - 1, at, at + 1);
            }
        }
        ui.painter().add(mesh);
        Label::new(&most, palette.muted).small().ui(ui);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_uses_all_of_its_colours_for_what_was_measured() {
        let span = MetricSpread::of(&[5.0, 66.0, 637.0]).unwrap();
        assert_eq!(part(5.0, span), 0.0);
        assert_eq!(part(637.0, span), 1.0);
        assert!((0.05..0.2).contains(&part(66.0, span)));
        let one = MetricSpread::of(&[5.0]).unwrap();
        assert_eq!(part(5.0, one), 0.0, "one value alone is no range");
    }
}
