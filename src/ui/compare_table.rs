//! What was measured, one row a trial and joint, and one for each setting that was repeated. Sorts, measures nothing.

use crate::app::trial::{JointMetrics, Setting};
use crate::app::tuner::Session;
use crate::hand::Status;
use crate::ui::compare::color;
use crate::ui::controls::{self, Button, Label, take_left};
use crate::ui::list;
use crate::ui::look::{Look, Pane};
use crate::ui::text::{Text, trials, tune, words};
use crate::ui::{format, theme};
use egui::{Align2, Color32, CornerRadius, Id, Rect, Role, Sense, Ui, WidgetInfo};

/// One column.
struct Column {
    title: Text,
    digits: usize,
    value: fn(&JointMetrics) -> Option<f64>,
}

const fn column(title: Text, digits: usize, value: fn(&JointMetrics) -> Option<f64>) -> Column {
    Column {
        title,
        digits,
        value,
    }
}

/// All with a number.
static COLUMNS: [Column; 10] = [
    column(tune::COLUMN_OVER, 0, |own| own.overshoot_g),
    column(tune::COLUMN_PEAK, 0, |own| own.peak_force_g),
    column(tune::COLUMN_STEADY, 0, |own| own.steady_force_g),
    column(tune::COLUMN_CONTACT, 2, |own| own.time_to_contact_s),
    column(tune::COLUMN_SETTLE, 2, |own| own.settle_time_s),
    column(tune::COLUMN_DEAD, 3, |own| own.dead_time_s),
    column(tune::COLUMN_RELAX, 0, |own| own.relaxation_g),
    column(tune::COLUMN_SLIPS, 0, |own| {
        own.slip_count
            .and_then(|count| u32::try_from(count).ok())
            .map(f64::from)
    }),
    column(tune::COLUMN_CURRENT, 0, |own| own.peak_current_ma),
    column(tune::COLUMN_HEAT, 0, |own| own.temperature_rise_c),
];

/// What the rows are sorted by: a column, or the order of trial; and which way.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sorting {
    column: Option<usize>,
    falling: bool,
}

/// One row.
struct Row<'a> {
    number: usize,
    name: String,
    joint: &'a JointMetrics,
    end: String,
    color: Color32,
}

/// Draws the table. A pressed row stands out in the curves.
pub(crate) fn table_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &Pane<'_>,
    session: &Session,
    (sorting, strong): (&mut Sorting, &mut Option<usize>),
) {
    let rows = sorted(rows(pane, session), *sorting);
    let least = theme::TRIAL_FIRST_COLUMN + 11.0 * theme::TRIAL_COLUMN;
    let width = rect.width().max(least);
    let inside = egui::UiBuilder::new().max_rect(rect).id_salt("trial table");
    ui.scope_builder(inside, |ui| {
        ui.shrink_clip_rect(rect);
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        let area = egui::ScrollArea::both().auto_shrink(false);
        area.show(ui, |ui| {
            head_ui(ui, width, pane, sorting);
            for row in &rows {
                if row_ui(ui, width, pane, row, *strong == Some(row.number)) {
                    let same = *strong == Some(row.number);
                    *strong = (!same).then_some(row.number);
                }
            }
            repeats_ui(ui, width, pane, session);
        });
    });
}

fn rows<'a>(pane: &Pane<'_>, session: &'a Session) -> Vec<Row<'a>> {
    let look = pane.look;
    let mut rows = Vec::new();
    for tried in &session.trials {
        for joint in &tried.metrics.joints {
            let kind = match tried.repeat {
                None => look.say(tune::PROBE).to_owned(),
                Some(_) => setting_words(tried.setting),
            };
            let end = match &tried.ended {
                Some(why) => trials::ended(look, why),
                None => end_words(look, joint.end_status.as_deref()),
            };
            rows.push(Row {
                number: tried.number,
                name: format!(
                    "{}  {kind}  {}",
                    tried.number,
                    look.say(words::dof(joint.dof))
                ),
                joint,
                end,
                color: color(pane, session, tried.number, joint.dof),
            });
        }
    }
    rows
}

/// What the drive said in the end, in words; a name that this program does not know stays as it is.
fn end_words(look: Look, name: Option<&str>) -> String {
    let Some(name) = name else {
        return format::UNKNOWN.to_owned();
    };
    let mut known = (0..=u8::MAX).map(Status::from_raw);
    known
        .find(|status| !matches!(status, Status::Unknown(_)) && status.name() == name)
        .map_or_else(
            || name.to_owned(),
            |status| words::status(status, look.language).title.to_owned(),
        )
}

/// Speed and threshold.
pub(crate) fn setting_words(setting: Setting) -> String {
    format!("{} / {} g", setting.speed.get(), setting.force.get())
}

/// What is not known goes last, whichever way the rest is sorted.
fn sorted(mut rows: Vec<Row<'_>>, sorting: Sorting) -> Vec<Row<'_>> {
    let Some(column) = sorting.column.and_then(|at| COLUMNS.get(at)) else {
        if sorting.falling {
            rows.reverse();
        }
        return rows;
    };
    rows.sort_by(
        |a, b| match ((column.value)(a.joint), (column.value)(b.joint)) {
            (Some(a), Some(b)) if sorting.falling => b.total_cmp(&a),
            (Some(a), Some(b)) => a.total_cmp(&b),
            (a, b) => b.is_some().cmp(&a.is_some()),
        },
    );
    rows
}

fn cells(row: Rect) -> (Rect, Rect, f32) {
    let (first, rest) = row.split_left_right_at_x(row.left() + theme::TRIAL_FIRST_COLUMN);
    (first, rest, rest.width() / theme::TRIAL_COLUMNS)
}

fn head_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, sorting: &mut Sorting) {
    let look = pane.look;
    let row = list::piece(ui, width, theme::CONTROL);
    let (first, mut rest, each) = cells(row);
    let titles = COLUMNS.iter().map(|column| column.title);
    let all = std::iter::once((None, tune::COLUMN_TRIAL));
    let all = all.chain(titles.enumerate().map(|(at, title)| (Some(at), title)));
    for (at, title) in all {
        let place = match at {
            None => first,
            Some(_) => {
                let (cell, more) = rest.split_left_right_at_x(rest.left() + each);
                rest = more;
                cell
            }
        };
        let text = look.say(title);
        let button = Button::new(text, look.say(tune::COLUMN_TIP));
        let button = button.choice(sorting.column == at);
        let response = button.ground(ui, look, place, Id::unique(("trial column", title.en)));
        let (font, color) = (theme::small(), look.palette.muted);
        controls::paint_text(ui, place, Align2::CENTER_CENTER, text, font, color);
        if response.clicked() {
            let again = sorting.column == at;
            *sorting = Sorting {
                column: at,
                falling: again && !sorting.falling,
            };
        }
    }
    Label::new(look.say(tune::COLUMN_END), look.palette.muted)
        .small()
        .put(ui, rest.translate(egui::vec2(theme::GAP, 0.0)));
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(
        || "-".to_owned(),
        |value| format!("{:.digits$}", value + 0.0),
    )
}

fn row_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, row: &Row<'_>, chosen: bool) -> bool {
    let look = pane.look;
    let rect = list::piece(ui, width, theme::TRIAL_ROW);
    let id = Id::unique(("trial row", row.number, row.joint.dof));
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Row, true, chosen, &row.name));
    let ground = match (chosen, response.hovered()) {
        (true, _) => look.palette.wash(look.palette.accent),
        (false, true) => look.palette.control,
        (false, false) => Color32::TRANSPARENT,
    };
    let round = CornerRadius::same(theme::ROUND_TINY);
    ui.painter().rect_filled(rect, round, ground);
    let (mut first, mut rest, each) = cells(rect);
    let swatch = take_left(&mut first, theme::TRIAL_SWATCH);
    let bar = controls::middle(swatch, theme::BAR);
    ui.painter().rect_filled(bar, round, row.color);
    Label::new(&row.name, look.palette.text)
        .small()
        .put(ui, first);
    for column in &COLUMNS {
        let (cell, more) = rest.split_left_right_at_x(rest.left() + each);
        rest = more;
        let text = number((column.value)(row.joint), column.digits);
        let label = format!("{} {}", row.number, look.say(column.title));
        Label::new(&text, look.palette.text)
            .number()
            .right()
            .named(&label)
            .put(ui, cell.with_max_x(cell.right() - theme::GAP));
    }
    Label::new(&row.end, look.palette.muted)
        .small()
        .put(ui, rest.translate(egui::vec2(theme::GAP, 0.0)));
    response.clicked()
}

/// The spread of settings that were tried more than once.
fn repeats_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, session: &Session) {
    let look = pane.look;
    let scores = session.scores();
    let repeated: Vec<Setting> = scores
        .iter()
        .filter(|score| score.trials > 1)
        .map(|score| score.setting)
        .collect();
    if repeated.is_empty() {
        return;
    }
    list::piece(ui, width, theme::GAP);
    let title = look.say(tune::REPEATED);
    list::line_ui(ui, width, title, look.palette.muted);
    for setting in repeated {
        let rect = list::piece(ui, width, theme::FIGURE_ROW * 2.0);
        let (first, mut rest, each) = cells(rect);
        let text = setting_words(setting);
        Label::new(&text, look.palette.text).small().put(ui, first);
        let own = session.trials.iter();
        let own = own.filter(|tried| tried.setting == setting && tried.repeat.is_some());
        let joints: Vec<&JointMetrics> = own.flat_map(|tried| &tried.metrics.joints).collect();
        for column in &COLUMNS {
            let (cell, more) = rest.split_left_right_at_x(rest.left() + each);
            rest = more;
            let values: Vec<f64> = joints
                .iter()
                .filter_map(|own| (column.value)(own))
                .collect();
            let (mean, range) = spread(&values, column.digits);
            let (upper, lower) = cell
                .with_max_x(cell.right() - theme::GAP)
                .split_top_bottom_at_fraction(0.5);
            let label = format!("{text} {}", look.say(column.title));
            Label::new(&mean, look.palette.text)
                .number()
                .right()
                .named(&label)
                .put(ui, upper);
            Label::new(&range, look.palette.faint)
                .font(theme::number_small())
                .right()
                .put(ui, lower);
        }
    }
}

/// Mean, and lowest to highest; of nothing nothing.
fn spread(values: &[f64], digits: usize) -> (String, String) {
    let count = u32::try_from(values.len()).unwrap_or(u32::MAX);
    let low = values.iter().copied().reduce(f64::min);
    let high = values.iter().copied().reduce(f64::max);
    let (Some(low), Some(high)) = (low, high) else {
        return ("-".into(), String::new());
    };
    let mean = values.iter().sum::<f64>() / f64::from(count);
    let range = format!("{low:.digits$}..{high:.digits$}");
    (number(Some(mean), digits), range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_the_mean_and_the_ends_and_of_nothing_nothing() {
        let said = |mean: &str, range: &str| (mean.to_owned(), range.to_owned());
        assert_eq!(spread(&[10.0, 40.0, 25.0], 0), said("25", "10..40"));
        assert_eq!(spread(&[0.125, 0.5], 2), said("0.31", "0.12..0.50"));
        assert_eq!(spread(&[], 2), said("-", ""));
    }
}
