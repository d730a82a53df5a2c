//! Table of measurements, one row per trial and joint. Sorts, measures nothing.

use crate::app::recordings::RecordingAction;
use crate::app::settings::Language;
use crate::app::trials::{ComparedRow, Comparison, RowKey};
use crate::hand::PerDof;
use crate::trials::columns::Metric;
use crate::ui::kit::{self, Label, Pane, dash};
use crate::ui::recordings::stretch::ReplayedStretch;
use crate::ui::text::{Text, tune, words};
use crate::ui::theme;
use crate::ui::trials::compare_choice::TrialKey;
use crate::ui::trials::compare_columns::{
    ColumnUnit, ShownColumn, end_words, order, setting_words, shown,
};
use crate::ui::trials::compare_curves::color;
use crate::ui::trials::compare_list;
use egui::{Color32, RichText, Role, ScrollArea, Sense, Stroke, Ui, WidgetInfo, vec2};
use egui_extras::{Column, TableRow};

/// Height of a row, and of the headings.
const ROW: f32 = 20.0;
const HEADS: f32 = 36.0;
/// Minimum width of a trial's outcome.
const END: f32 = 88.0;

/// Height of a table of this many rows, with the gap above it.
pub(crate) fn height(rows: usize) -> f32 {
    let rows = f32::from(u16::try_from(rows).unwrap_or(u16::MAX));
    HEADS + rows * ROW + theme::GAP + theme::STEP
}

/// Sort key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum By {
    #[default]
    Trial,
    Number(Metric, ColumnUnit),
    End,
}

/// Sort key and direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Sorting {
    by: By,
    falling: bool,
}

/// Cached between frames: sorting and grouping thousands of rows in each frame is too slow.
#[derive(Debug, Default)]
pub(crate) struct TableView {
    sorting: Sorting,
    /// Rows in order, with the sorting and language they were sorted for.
    laid: Option<(Sorting, Language, Vec<RowKey>)>,
    /// The rows were sorted for another comparison.
    is_old: bool,
}

/// Clicks in the table.
struct Pressed<'a> {
    strong: &'a mut Option<TrialKey>,
    replay: Option<RecordingAction>,
}

/// Data for drawing the table.
struct TrialSheet<'a, 'b> {
    pane: &'a Pane<'b>,
    comparison: &'a Comparison,
    /// Newtons of a gram of each joint of the hand that is open.
    newtons: PerDof<Option<f64>>,
    /// The value columns that fit.
    columns: Vec<ShownColumn>,
}

impl TableView {
    /// Marks the rows as outdated, for another comparison.
    pub(crate) const fn forget(&mut self) {
        self.is_old = true;
    }

    /// Draws the table over all of `ui`. A click on a row highlights its curves. Returns the action that replays a trial.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: &mut Option<TrialKey>,
    ) -> Option<RecordingAction> {
        let width = ui.available_width();
        let first = (width * 0.2).clamp(184.0, 320.0);
        let number = (width * 0.063).clamp(52.0, 104.0);
        let fits = |columns: &usize| {
            first + END + number * f32::from(u8::try_from(*columns).unwrap_or(u8::MAX)) <= width
        };
        let mut sheet = TrialSheet {
            pane,
            comparison,
            newtons: pane.hand().newtons.all_per_g(),
            columns: Vec::new(),
        };
        sheet.columns = sheet.all_columns();
        let count = (1..=sheet.columns.len()).rfind(fits).unwrap_or(1);
        sheet.columns.truncate(count);
        let sheet = sheet;
        let is_pointed = ui.rect_contains_pointer(ui.available_rect_before_wrap());
        self.sort(&sheet, is_pointed);
        let order = self.laid.as_ref().map_or(&[][..], |(.., order)| order);
        let sorting = &mut self.sorting;
        let several = sheet.several();
        let palette = pane.look.palette;
        ui.visuals_mut().selection.bg_fill = palette.wash(palette.accent);
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        let mut pressed = Pressed {
            strong,
            replay: None,
        };
        ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
            let table = kit::table(ui, ("trials", several))
                .sense(Sense::click())
                .min_scrolled_height(0.0)
                .auto_shrink(false)
                .column(Column::exact(first))
                .columns(Column::exact(number), sheet.columns.len())
                .column(Column::remainder().at_least(END).clip(true))
                .header(HEADS, |mut row| sheet.head_ui(&mut row, sorting));
            table.body(|body| {
                body.rows(ROW, order.len(), |mut row| {
                    if let Some(key) = order.get(row.index()) {
                        sheet.row_ui(&mut row, *key, &mut pressed);
                    }
                });
            });
        });
        pressed.replay
    }

    /// Sorts the rows only when something changed; while the pointer is over the table, new rows are appended.
    fn sort(&mut self, sheet: &TrialSheet<'_, '_>, is_pointed: bool) {
        let (sorting, language) = (self.sorting, sheet.pane.look.language);
        let former = self.laid.take();
        let former = former.filter(|own| (own.0, own.1) == (sorting, language));
        let rows = &sheet.comparison.rows;
        let order = match former {
            Some((.., order)) if !self.is_old => order,
            Some((.., mut order)) if is_pointed => {
                order.retain(|key| rows.contains(key));
                let new = rows.iter().filter(|key| !order.contains(key));
                let new: Vec<RowKey> = new.copied().collect();
                order.extend(new);
                order
            }
            _ => {
                self.is_old = false;
                sheet.sorted(sorting)
            }
        };
        self.laid = Some((sorting, language, order));
    }
}

impl<'a> TrialSheet<'a, '_> {
    fn several(&self) -> bool {
        self.comparison.sessions().len() > 1
    }

    /// Newtons of a gram of the joint of a row; `None` where they are unknown, as those of any other hand.
    fn per_g(&self, seen: ComparedRow<'_>) -> Option<f64> {
        let is_own = seen.session.head.hand == self.pane.hand().connection.name();
        self.newtons[seen.joint.dof].filter(|_| is_own)
    }

    /// All columns; those in newtons only if a joint that was tried has newtons.
    fn all_columns(&self) -> Vec<ShownColumn> {
        let rows = self.comparison.rows.iter();
        let mut seen = rows.filter_map(|key| self.seen(*key));
        let has_newtons = self.newtons.iter().any(|(_, per_g)| per_g.is_some())
            && seen.any(|seen| self.per_g(seen).is_some());
        let columns = shown().filter(|own| has_newtons || own.unit == ColumnUnit::Own);
        columns.collect()
    }

    fn seen(&self, place: RowKey) -> Option<ComparedRow<'a>> {
        self.comparison.row(&self.pane.state.trials, place)
    }

    /// Rows in the order of `sorting`; unknown values go last in either direction.
    fn sorted(&self, sorting: Sorting) -> Vec<RowKey> {
        let value = |key: &RowKey| {
            let seen = self.seen(*key);
            match sorting.by {
                By::Trial => (u32::try_from(key.trial).ok().map(f64::from), None),
                By::End => (None, seen.map(|seen| self.end(seen))),
                By::Number(metric, unit) => {
                    let is_own =
                        |own: &ShownColumn| (own.column.metric, own.unit) == (metric, unit);
                    let cell = shown().find(is_own).zip(seen);
                    let value = |(own, seen): (ShownColumn, ComparedRow<'_>)| {
                        own.value(seen.joint, self.per_g(seen))
                    };
                    (cell.and_then(value), None)
                }
            }
        };
        let rows = self.comparison.rows.iter();
        let mut keyed: Vec<_> = rows.map(|key| (value(key), *key)).collect();
        keyed.sort_by(|((a, words), _), ((b, other), _)| {
            let words = if sorting.falling {
                other.cmp(words)
            } else {
                words.cmp(other)
            };
            order(*a, *b, sorting.falling).then(words)
        });
        keyed.into_iter().map(|(_, key)| key).collect()
    }

    fn end(&self, seen: ComparedRow<'_>) -> String {
        let look = self.pane.look;
        match &seen.trial.aborted {
            Some(why) => tune::ended(look, why),
            None => end_words(look, seen.joint.end_status.as_deref()),
        }
    }

    /// All values of a row, including those without a column.
    fn figures(&self, seen: ComparedRow<'_>) -> String {
        let figure = |own: ShownColumn| {
            let in_newtons = own.column.newtons(seen.joint, self.per_g(seen));
            let in_newtons = in_newtons.map(|newtons| format!(" ({newtons:.1} N)"));
            format!(
                "{}: {}{}",
                self.pane.look.tr(own.title),
                own.column.text(seen.joint),
                in_newtons.unwrap_or_default()
            )
        };
        let figures = shown().filter(|own| own.unit == ColumnUnit::Own);
        figures.map(figure).collect::<Vec<_>>().join("\n")
    }

    fn head_ui(&self, row: &mut TableRow<'_, '_>, sorting: &mut Sorting) {
        let by = |own: &ShownColumn| By::Number(own.column.metric, own.unit);
        let numbers = self.columns.iter().map(|own| (by(own), own.title));
        let heads = [(By::Trial, tune::COLUMN_TRIAL)].into_iter().chain(numbers);
        for (by, title) in heads.chain([(By::End, tune::COLUMN_END)]) {
            row.col(|ui| self.head_cell_ui(ui, by, title, sorting));
        }
    }

    /// Column heading above its unit. A click sorts by it.
    fn head_cell_ui(&self, ui: &mut Ui, by: By, title: Text, sorting: &mut Sorting) {
        let look = self.pane.look;
        let text = look.tr(title);
        let is_own = sorting.by == by;
        // The unit below its quantity, or an empty line, so that all headings have two lines.
        let unit = text.split_once(", ").or_else(|| text.split_once(' '));
        let (name, unit) = unit.unwrap_or((text, ""));
        let (arrow, way) = match (is_own, sorting.falling) {
            (false, _) => ("", ""),
            (true, true) => (" ▼", look.tr(tune::FALLING)),
            (true, false) => (" ▲", look.tr(tune::RISING)),
        };
        let words = RichText::new(format!("{name}\n{unit}{arrow}")).small();
        let button = egui::Button::selectable(is_own, words.color(look.palette.muted));
        let button = button.wrap_mode(egui::TextWrapMode::Extend);
        let response = ui.add_sized(ui.available_size(), button);
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_own, text));
        ui.ctx()
            .accesskit_node_builder(response.id, |node| node.set_value(way));
        let tip = format!("{}\n{}", look.tip(title), look.tr(tune::COLUMN_TIP));
        let response = response.on_hover_text(tip.trim());
        if response.clicked() {
            *sorting = Sorting {
                by,
                falling: is_own && !sorting.falling,
            };
        }
    }

    fn row_ui(&self, row: &mut TableRow<'_, '_>, place: RowKey, pressed: &mut Pressed<'_>) {
        let look = self.pane.look;
        let Some(seen) = self.seen(place) else { return };
        let (session, tried) = (seen.session.id, seen.trial);
        let key = Some((session, tried.number));
        let is_chosen = *pressed.strong == key;
        row.set_selected(is_chosen);
        let kind = if tried.is_probe() {
            look.tr(tune::PROBE).to_owned()
        } else {
            setting_words(tried.setting)
        };
        let joint = look.tr(words::dof(seen.joint.dof));
        let (text, number) = (look.palette.text, tried.number);
        let short = if self.several() {
            format!("{}: {number}", session.0)
        } else {
            number.to_string()
        };
        let whole = format!("{short}  {kind}  {joint}");
        row.col(|ui| {
            let size = vec2(theme::KEY_SIGN, ui.available_height());
            let (_, swatch) = ui.allocate_space(size);
            let color = color(self.pane, self.comparison, place, seen);
            let style = compare_list::style(self.comparison.sessions(), session);
            dash::sample(ui.painter(), swatch, style, Stroke::new(theme::BAR, color));
            ui.add_space(theme::STEP);
            if self.comparison.is_best(tried.setting) && tried.counts() {
                let star = Label::new(theme::BEST, look.palette.ok);
                let star = star.font(theme::icon_high(theme::SIGN_SMALL));
                star.named(look.tr(tune::BEST_SIGN)).ui(ui);
            }
            let label = Label::new(&whole, text).small().ui(ui);
            label.on_hover_text(self.figures(seen));
        });
        for own in &self.columns {
            let label = format!("{short} {}", look.tr(own.title));
            let value = own.text(seen.joint, self.per_g(seen));
            row.col(|ui| number_ui(ui, &label, &value, text));
        }
        row.col(|ui| {
            ui.add_space(theme::GAP);
            ui.spacing_mut().interact_size.y = ROW;
            let stretch = ReplayedStretch {
                title: &whole,
                hand: &seen.session.head.hand,
                stretch: seen.session.stretch(number),
            };
            let replay = stretch.ui(ui, self.pane);
            pressed.replay = pressed.replay.take().or(replay);
            let end = self.end(seen);
            Label::new(&end, look.palette.muted).small().ui(ui);
        });
        let response = row.response();
        response.widget_info(|| WidgetInfo::selected(Role::Row, true, is_chosen, &whole));
        if response.clicked() {
            *pressed.strong = key.filter(|_| !is_chosen);
        }
    }
}

/// A right-aligned number in its cell.
fn number_ui(ui: &mut Ui, label: &str, text: &str, color: Color32) {
    kit::right_ui(ui, |ui| {
        ui.add_space(theme::STEP);
        Label::new(text, color).number().named(label).ui(ui);
    });
}
