//! State of the drives over the time range of the plots: one row of colours per joint.

use crate::hand::Dof;
use crate::history::StatusRun;
use crate::ui::kit::{self, Label, Look, Pane, format};
use crate::ui::plots::time_window::TimeSpan;
use crate::ui::plots::times::clock;
use crate::ui::text::{panels, words};
use crate::ui::theme;
use egui::{Color32, Rangef, Rect, Role, Sense, Stroke, Ui, WidgetInfo, remap, vec2};
use std::time::Duration;

/// Height of a row with the gap below it, and of one with words in it.
const ROW: f32 = 5.0;
const WORDED: f32 = 15.0;

/// Height of the rows of this number of joints.
pub(crate) fn height(joints: usize, has_words: bool) -> f32 {
    row_height(has_words) * f32::from(u8::try_from(joints).unwrap_or(u8::MAX)) + theme::STEP
}

const fn row_height(has_words: bool) -> f32 {
    if has_words { WORDED } else { ROW }
}

/// Length of a bar from which on a word may fit.
const WORD_LEAST: f32 = 30.0;

/// Position and time range of the rows.
pub(crate) struct DrivesPlace<'a> {
    pub(crate) joints: &'a [Dof],
    /// Each state that lasts long enough has its word in its bar.
    pub(crate) has_words: bool,
    pub(crate) span: TimeSpan,
    /// Space at the right of the plots.
    pub(crate) end: f32,
    /// Time at the pointer in a plot, in seconds.
    pub(crate) pointed_s: Option<f64>,
}

impl DrivesPlace<'_> {
    /// Draws the rows as wide as `ui`.
    pub(crate) fn ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let size = vec2(
            ui.available_width(),
            height(self.joints.len(), self.has_words),
        );
        let (whole, response) = ui.allocate_exact_size(size, Sense::hover());
        let name = look.tr(panels::DRIVES);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
        let whole = whole.with_min_y(whole.top() + theme::STEP);
        let xs = Rangef::new(whole.left() + theme::PLOT_AXIS, whole.right() - self.end);
        let frame = Rect::from_x_y_ranges(xs, whole.y_range());
        let words = whole.with_max_x(xs.min - 2.0 * theme::STEP);
        let label = Label::new(name, look.palette.muted).small();
        label.right().paint(ui, words);
        let mut top = frame.top();
        for dof in self.joints {
            self.row(ui, pane, *dof, frame.with_min_y(top));
            top += row_height(self.has_words);
        }
        if let Some(at_s) = self.pointed_s {
            let stroke = Stroke::new(1.0, look.palette.faint);
            ui.painter()
                .vline(self.x(frame, at_s), frame.y_range(), stroke);
        }
        let at = response.hover_pos().filter(|at| frame.contains(*at));
        let tip = at.and_then(|at| {
            let (from_s, to_s) = self.span;
            let part = f64::from((at.x - xs.min) / xs.span().max(1.0));
            let each = |row| height(row, self.has_words);
            let below = |row: usize| frame.top() + each(row + 1) - theme::STEP;
            let mut rows = self.joints.iter().enumerate();
            let row = rows.find(|(row, _)| at.y < below(*row));
            status_tooltip(pane, *row?.1, from_s + part * (to_s - from_s))
        });
        response
            .on_hover_text_at_pointer(tip.unwrap_or_else(|| look.tip(panels::DRIVES).to_owned()));
    }

    /// Draws the row of one joint: time ranges with a known state.
    fn row(&self, ui: &Ui, pane: &Pane<'_>, dof: Dof, frame: Rect) {
        let palette = pane.look.palette;
        let high = row_height(self.has_words) - 1.0;
        let bar = Rect::from_min_size(frame.min, vec2(frame.width(), high));
        ui.painter().rect_filled(bar, 0.0, palette.sunken);
        let mark = bar.translate(vec2(-1.5 * theme::STEP, 0.0));
        let mark = mark.with_max_x(mark.left() + theme::STEP);
        ui.painter().rect_filled(mark, 0.0, palette.dof[dof]);
        let history = &pane.hand().measured.history;
        let (from_s, to_s) = self.span;
        let runs = history.status(dof, from_s, to_s).map(|run| {
            let fault = run.faults.and_then(|faults| faults.iter().next());
            let ends = [run.from_s.max(from_s), run.until_s.min(to_s)];
            let [from, to] = ends.map(|at_s| self.x(frame, at_s));
            (Rangef::new(from, to), palette.drive(fault, run.status))
        });
        let known = runs.filter(|(_, color)| *color != palette.faint);
        for (xs, color) in seen(known, palette.bad) {
            let xs = Rangef::new(xs.min, xs.max.min(frame.right()));
            let stretch = Rect::from_x_y_ranges(xs, bar.y_range());
            ui.painter().rect_filled(stretch, 0.0, color);
        }
        if self.has_words {
            self.words(ui, pane, dof, bar);
        }
    }

    /// Writes the state into each bar that is long enough.
    fn words(&self, ui: &Ui, pane: &Pane<'_>, dof: Dof, bar: Rect) {
        let look = pane.look;
        let (from_s, to_s) = self.span;
        let xs = |run: &StatusRun| {
            let ends = [run.from_s.max(from_s), run.until_s.min(to_s)];
            ends.map(|at_s| self.x(bar, at_s))
        };
        let runs = pane.hand().measured.history.status(dof, from_s, to_s);
        for run in runs {
            let [from, to] = xs(run);
            if to - from < WORD_LEAST {
                continue;
            }
            let place = bar.with_min_x(from + theme::STEP).with_max_x(to);
            let text = status_text(look, run);
            if kit::text_width(ui, &text, theme::small()) <= place.width() {
                let label = Label::new(&text, look.palette.on_accent).small();
                label.paint(ui, place);
            }
        }
    }

    fn x(&self, frame: Rect, at_s: f64) -> f32 {
        let (from_s, to_s) = self.span;
        let xs = f64::from(frame.left())..=f64::from(frame.right());
        #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
        let x = remap(at_s, from_s..=to_s, xs) as f32;
        x
    }
}

/// Drops ranges that a display cannot show. Ranges come in time order; each is widened to at least one point, and of several
/// within a point only the first and those in `bad` remain. An hour of grasps has twenty thousand.
fn seen(
    runs: impl Iterator<Item = (Rangef, Color32)>,
    bad: Color32,
) -> impl Iterator<Item = (Rangef, Color32)> {
    let (mut until, mut last) = (f32::NEG_INFINITY, None);
    runs.filter_map(move |(xs, color)| {
        let is_hidden = xs.max <= until && (color != bad || last == Some(bad));
        if is_hidden {
            return None;
        }
        until = xs.max.max(xs.min + 1.0);
        last = Some(color);
        Some((Rangef::new(xs.min, until), color))
    })
}

/// State of a joint's drive at a time, and its start.
fn status_tooltip(pane: &Pane<'_>, dof: Dof, at_s: f64) -> Option<String> {
    let look = pane.look;
    let history = &pane.hand().measured.history;
    let run = history.status(dof, at_s, at_s).last()?;
    let lasted = Duration::from_secs_f64((run.until_s - run.from_s).max(0.0));
    let since = clock(run.from_s, 0.1);
    let since = look.fill(panels::DRIVE_SINCE, &[&since, &format::age(lasted)]);
    let status = look.pair(look.tr(words::dof(dof)), &status_text(look, run));
    Some(format!("{status}\n{since}"))
}

fn status_text(look: Look, run: &StatusRun) -> String {
    let faults = run.faults.into_iter().flat_map(|faults| faults.iter());
    let faults = faults.map(|fault| words::fault(fault, look.language).title);
    let faults: Vec<&str> = faults.collect();
    match run.status {
        Some(status) if faults.is_empty() => words::status(status, look.language).title.into(),
        None if faults.is_empty() => format::UNKNOWN.into(),
        _ => faults.join(" + "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_what_lies_within_a_point_the_first_and_the_bad_is_drawn() {
        let (fine, moves, bad) = (Color32::GREEN, Color32::BLUE, Color32::RED);
        let runs = (0_u16..20_000).map(|number| {
            let color = match number {
                7_001 => bad,
                _ if number % 2 == 0 => fine,
                _ => moves,
            };
            let from = f32::from(number) / 50.0;
            (Rangef::new(from, from + 0.02), color)
        });
        let drawn: Vec<_> = seen(runs, bad).collect();
        assert!(drawn.len() <= 402, "{} for 400 points", drawn.len());
        assert!(drawn.iter().any(|(_, color)| *color == bad));
        assert!(drawn.iter().all(|(xs, _)| xs.span() >= 0.99));
        let wide = [(0.0, 9.5, fine), (9.5, 30.0, moves), (30.0, 31.5, fine)];
        let wide = wide.map(|(from, to, color)| (Rangef::new(from, to), color));
        assert_eq!(seen(wide.into_iter(), bad).collect::<Vec<_>>(), wide);
    }
}
