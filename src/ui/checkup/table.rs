//! The values of a check-up: measured, good, first, last, their trend, and advice.

use crate::checkup::check::Check;
use crate::checkup::report::CheckupReport;
use crate::checkup::report::line::past_words;
use crate::checkup::subject::Grade;
use crate::ui::kit::{self, Label, Pane, format};
use crate::ui::text::{Text, checkup};
use crate::ui::theme;
use egui::{Color32, Response, ScrollArea, Sense, Stroke, Ui, pos2, vec2};
use egui_extras::{Column, TableRow};

const ROW: f32 = 22.0;
/// Widths of the columns: part, quantity, numbers, and the curve of a trend.
const PART: f32 = 80.0;
const WHAT: f32 = 272.0;
const NUMBER: f32 = 104.0;
const TREND: f32 = 72.0;
/// Minimum width of the advice.
const ADVICE: f32 = 160.0;

/// Colour of a grade.
pub(super) const fn color(pane: &Pane<'_>, grade: Grade) -> Color32 {
    let palette = pane.look.palette;
    match grade {
        Grade::Fine => palette.ok,
        Grade::Unknown => palette.muted,
        Grade::Watch => palette.warn,
        Grade::Act => palette.bad,
    }
}

/// Draws the values, or only those that are not fine. What a partial check-up did not come to is counted above, not listed.
pub(super) fn ui(ui: &mut Ui, pane: &Pane<'_>, report: &CheckupReport, only: bool) {
    let look = pane.look;
    let is_told = |own: &&Check| !only || own.grade != Grade::Fine || own.drift().is_some();
    let shown: Vec<&Check> = report.listed().filter(is_told).collect();
    if shown.is_empty() {
        if report.aborted.is_none() {
            kit::small_text_ui(ui, look.tr(checkup::ALL_FINE), look.palette.ok);
        }
        return;
    }
    let heads = [
        checkup::COLUMN_OF,
        checkup::COLUMN_WHAT,
        checkup::COLUMN_MEASURED,
        checkup::COLUMN_GOOD,
        checkup::COLUMN_FIRST,
        checkup::COLUMN_LAST,
        checkup::COLUMN_TREND,
        checkup::COLUMN_ADVICE,
    ];
    ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
        let table = kit::table(ui, "checkup")
            .auto_shrink(false)
            .min_scrolled_height(0.0)
            .column(Column::exact(PART))
            .column(Column::exact(WHAT))
            .columns(Column::exact(NUMBER), 4)
            .column(Column::exact(TREND))
            .column(Column::remainder().at_least(ADVICE).clip(true))
            .header(ROW, |mut row| {
                for head in heads {
                    Label::note(look, head).column_ui(&mut row);
                }
            });
        table.body(|body| {
            body.rows(ROW, shown.len(), |mut row| {
                if let Some(check) = shown.get(row.index()) {
                    row_ui(&mut row, pane, check);
                }
            });
        });
    });
}

fn row_ui(row: &mut TableRow<'_, '_>, pane: &Pane<'_>, check: &Check) {
    let (look, palette) = (pane.look, pane.look.palette);
    let of = look.tr(checkup::part(check.measured.of));
    let what = look.tr(checkup::subject(check.measured.what));
    let unit = check.measured.what.row();
    Label::new(of, palette.muted).column_ui(row);
    Label::new(what, palette.text).column_ui(row);
    let name = |column: Text| format!("{of} {what} {}", look.tr(column).to_lowercase());
    let channels = &check.measured.channels;
    let channels = (!channels.is_empty()).then(|| look.fill(checkup::CHANNELS, &[channels]));
    row.col(|ui| {
        let color = color(pane, check.grade);
        kit::lamp_ui(ui, Some(color));
        let value = check.measured.value.map(|value| unit.text(value));
        let value = value.unwrap_or_else(|| format::UNKNOWN.into());
        let label = Label::new(&value, palette.text).number();
        let shown = label.named(&name(checkup::COLUMN_MEASURED)).ui(ui);
        let grade = look.tr(checkup::grade(check.grade));
        let words = [grade.to_owned()].into_iter();
        let words: Vec<String> = words.chain(channels.clone()).collect();
        shown.on_hover_text(words.join(", "));
    });
    let before = [
        (checkup::COLUMN_GOOD, unit.range()),
        (checkup::COLUMN_FIRST, unit.known(&check.first)),
        (checkup::COLUMN_LAST, unit.known(&check.last)),
    ];
    for (column, value) in before {
        let label = Label::new(&value, palette.muted).number();
        label.named(&name(column)).column_ui(row);
    }
    row.col(|ui| drop(trend_ui(ui, pane, check)));
    row.col(|ui| {
        let to_do = checkup::to_do(look, check);
        let all: Vec<String> = channels.into_iter().chain([to_do]).collect();
        let all = all.join(": ");
        if !all.is_empty() {
            let name = name(checkup::COLUMN_ADVICE);
            let label = Label::new(&all, palette.text).named(&name);
            label.ui(ui).on_hover_text(&all);
        }
    });
}

/// Draws the value over the last check-ups; `None` with fewer than two of them.
fn trend_ui(ui: &mut Ui, pane: &Pane<'_>, check: &Check) -> Option<Response> {
    let points = &check.trend.points;
    let (least, most) = check.trend.range().filter(|_| points.len() >= 2)?;
    let (rect, response) = ui.allocate_exact_size(vec2(TREND - theme::GAP, ROW), Sense::hover());
    let place = rect.shrink2(vec2(1.0, theme::STEP));
    let places = points.iter().enumerate().map(|(nth, point)| {
        let x = egui::lerp(place.x_range(), kit::share(nth, points.len() - 1));
        // A constant value is drawn in the middle.
        let part = if most > least {
            (point.value - least) / (most - least)
        } else {
            0.5
        };
        let y = egui::remap(
            part,
            0.0..=1.0,
            f64::from(place.bottom())..=f64::from(place.top()),
        );
        #[expect(clippy::cast_possible_truncation, reason = "a place on the screen")]
        let y = y as f32;
        pos2(x, y)
    });
    let ink = if check.drift().is_some() {
        pane.look.palette.warn
    } else {
        pane.look.palette.muted
    };
    ui.painter()
        .line(places.collect(), Stroke::new(theme::LINE, ink));
    Some(response.on_hover_text(past_words(check)))
}
