//! What was measured, one row a trial and joint, and one for each setting that was repeated. Sorts, measures nothing.

use crate::app::settings::Language;
use crate::app::trials::{ComparedRow, Comparison, RowKey, SessionId, TrialSession};
use crate::trials::columns::{Better, COLUMNS, Metric};
use crate::trials::{JointMetrics, TrialSetting};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left};
use crate::ui::kit::dash;
use crate::ui::kit::look::Pane;
use crate::ui::text::{Text, compare, trials, tune, words};
use crate::ui::theme;
use crate::ui::trials::compare_choice::TrialKey;
use crate::ui::trials::compare_columns::{end_words, order, setting_words, shown, spread};
use crate::ui::trials::compare_curves::color;
use crate::ui::trials::compare_list;
use egui::{Align2, Color32, CornerRadius, Id, Rect, Role, Sense, Stroke, Ui, WidgetInfo, vec2};
use egui_plot::LineStyle;

/// What rows can be sorted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum By {
    Session,
    #[default]
    Trial,
    Number(Metric),
    End,
}

impl By {
    /// Which rows stand first when a person begins to sort by it.
    fn better(self) -> Better {
        let Self::Number(metric) = self else {
            return Better::Lower;
        };
        let own = COLUMNS.iter().find(|column| column.metric == metric);
        own.map_or(Better::Lower, |column| column.better)
    }
}

/// Where the rows begin, and which way they go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Sorting {
    by: By,
    falling: bool,
}

/// What is kept between frames: sorting and grouping thousands of rows is not for each of them.
#[derive(Debug, Default)]
pub(crate) struct TableView {
    sorting: Sorting,
    laid: Option<Laid>,
}

#[derive(Debug)]
struct Laid {
    sorting: Sorting,
    language: Language,
    order: Vec<RowKey>,
    repeated: Vec<(SessionId, TrialSetting)>,
}

/// One row.
struct Row<'a> {
    seen: ComparedRow<'a>,
    name: String,
    /// What names of its cells begin with.
    short: String,
    end: String,
    color: Color32,
    style: LineStyle,
}

/// What every part of the table is drawn with.
struct Sheet<'a, 'b> {
    pane: &'a Pane<'b>,
    comparison: &'a Comparison,
}

impl TableView {
    /// The comparison is another one.
    pub(crate) fn forget(&mut self) {
        self.laid = None;
    }

    /// Draws the table. A pressed row stands out in the curves.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: &mut Option<TrialKey>,
    ) {
        let sheet = Sheet { pane, comparison };
        let laid = self.laid(&sheet);
        let session = sheet.session_width();
        let least =
            session + theme::TRIAL_FIRST_COLUMN + theme::TRIAL_COLUMNS * theme::TRIAL_COLUMN;
        let width = rect.width().max(least);
        let inside = egui::UiBuilder::new().max_rect(rect).id_salt("trial table");
        let sorting = &mut self.sorting;
        ui.scope_builder(inside, |ui| {
            ui.shrink_clip_rect(rect);
            ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
            let area = egui::ScrollArea::both().auto_shrink(false);
            area.show_viewport(ui, |ui, seen| {
                let rows = vec2(width, height(&laid));
                let place = ui.allocate_space(rows).1;
                sheet.rows_ui(ui, place, &laid, strong);
                sheet.repeats_ui(ui, place, &laid);
                let top = place.top() + seen.top();
                let head = place.with_min_y(top).with_max_y(top + theme::CONTROL);
                sheet.head_ui(ui, head, sorting);
            });
        });
        self.laid = Some(laid);
    }

    /// The rows in their order, reckoned again only when something changed.
    fn laid(&mut self, sheet: &Sheet<'_, '_>) -> Laid {
        let (sorting, language) = (self.sorting, sheet.pane.look.language);
        let former = self.laid.take();
        let former = former.filter(|own| own.sorting == sorting && own.language == language);
        former.unwrap_or_else(|| Laid {
            sorting,
            language,
            order: sheet.sorted(sorting),
            repeated: sheet.repeated(),
        })
    }
}

/// Height of all of it.
fn height(laid: &Laid) -> f32 {
    repeats_top(laid) + count(laid.repeated.len()) * theme::FIGURE_ROW * 2.0
}

/// Where the part of repeats begins, below its title.
fn repeats_top(laid: &Laid) -> f32 {
    let rows = theme::CONTROL + count(laid.order.len()) * theme::TRIAL_ROW;
    match laid.repeated.is_empty() {
        true => rows,
        false => rows + theme::GAP + theme::LIST_LINE,
    }
}

fn count(number: usize) -> f32 {
    f32::from(u16::try_from(number).unwrap_or(u16::MAX))
}

impl<'a> Sheet<'a, '_> {
    fn several(&self) -> bool {
        self.comparison.sessions().len() > 1
    }

    /// A column of sessions is there if there are several.
    fn session_width(&self) -> f32 {
        match self.several() {
            true => theme::SESSION_COLUMN,
            false => 0.0,
        }
    }

    fn seen(&self, place: RowKey) -> Option<ComparedRow<'a>> {
        self.comparison.row(&self.pane.state.trials, place)
    }

    /// The rows in the order that is asked for; what is not known goes last, whichever way the rest is sorted.
    fn sorted(&self, sorting: Sorting) -> Vec<RowKey> {
        let mut rows = self.comparison.rows.to_vec();
        match sorting.by {
            By::Session => rows.sort_by_key(|place| place.session),
            By::Trial => rows.sort_by_key(|place| (place.trial, place.session)),
            By::End => rows.sort_by_cached_key(|place| {
                let seen = self.seen(*place);
                seen.map_or_else(String::new, |seen| self.end(seen))
            }),
            By::Number(metric) => {
                let own = COLUMNS.iter().find(|column| column.metric == metric);
                let value = own.map(|column| column.value);
                let value = |place: &RowKey| value?(self.seen(*place)?.joint);
                let mut known: Vec<(Option<f64>, RowKey)> =
                    rows.iter().map(|place| (value(place), *place)).collect();
                known.sort_by(|(a, _), (b, _)| order(*a, *b, sorting.falling));
                return known.into_iter().map(|(_, place)| place).collect();
            }
        }
        if sorting.falling {
            rows.reverse();
        }
        rows
    }

    /// Settings that a session tried more than once, session by session.
    fn repeated(&self) -> Vec<(SessionId, TrialSetting)> {
        let book = &self.pane.state.trials;
        let sessions = self.comparison.sessions();
        let sessions = sessions.filter_map(|id| book.session(id));
        let mut all = Vec::new();
        for session in sessions {
            let tried = session.trials.iter().map(|own| &own.summary);
            let tried = tried.filter(|own| !own.is_probe());
            let mut settings: Vec<TrialSetting> = tried.map(|own| own.setting).collect();
            settings.sort_unstable();
            let twice = settings.chunk_by(|a, b| a == b).filter(|own| own.len() > 1);
            all.extend(twice.filter_map(|own| Some((session.id, *own.first()?))));
        }
        all
    }

    fn end(&self, seen: ComparedRow<'_>) -> String {
        let look = self.pane.look;
        match &seen.trial.aborted {
            Some(why) => trials::ended(look, why),
            None => end_words(look, seen.joint.end_status.as_deref()),
        }
    }

    fn row(&self, place: RowKey) -> Option<Row<'a>> {
        let look = self.pane.look;
        let seen = self.seen(place)?;
        let (session, tried) = (seen.session, seen.trial);
        let kind = match tried.is_probe() {
            true => look.say(tune::PROBE).to_owned(),
            false => setting_words(tried.setting),
        };
        let joint = look.say(words::dof(seen.joint.dof));
        Some(Row {
            seen,
            name: format!("{}  {kind}  {joint}", tried.number),
            short: match self.several() {
                true => format!("{}: {}", session.id.0, tried.number),
                false => tried.number.to_string(),
            },
            end: self.end(seen),
            color: color(self.pane, self.comparison, place, seen),
            style: compare_list::style(self.comparison.sessions(), session.id),
        })
    }

    /// The rows that are seen.
    fn rows_ui(&self, ui: &mut Ui, place: Rect, laid: &Laid, strong: &mut Option<TrialKey>) {
        let mut top = place.top() + theme::CONTROL;
        for own in &laid.order {
            let rect = place.with_min_y(top).with_max_y(top + theme::TRIAL_ROW);
            top += theme::TRIAL_ROW;
            if !ui.is_rect_visible(rect) {
                continue;
            }
            let Some(row) = self.row(*own) else { continue };
            let key = Some((row.seen.session.id, row.seen.trial.number));
            if self.row_ui(ui, rect, &row, *strong == key) {
                *strong = key.filter(|_| *strong != key);
            }
        }
    }

    /// The parts of a row: the session, the trial, the numbers and the end, and the width of a number.
    fn cells(&self, row: Rect) -> (Rect, Rect, Rect, f32) {
        let (session, rest) = row.split_left_right_at_x(row.left() + self.session_width());
        let (first, rest) = rest.split_left_right_at_x(rest.left() + theme::TRIAL_FIRST_COLUMN);
        (session, first, rest, rest.width() / theme::TRIAL_COLUMNS)
    }

    fn head_ui(&self, ui: &mut Ui, row: Rect, sorting: &mut Sorting) {
        let palette = self.pane.look.palette;
        ui.painter()
            .rect_filled(row, CornerRadius::ZERO, palette.card);
        let (session, first, mut rest, each) = self.cells(row);
        if self.several() {
            self.head_cell_ui(ui, session, (By::Session, compare::COLUMN_SESSION), sorting);
        }
        self.head_cell_ui(ui, first, (By::Trial, tune::COLUMN_TRIAL), sorting);
        for (column, title) in shown() {
            let (cell, more) = rest.split_left_right_at_x(rest.left() + each);
            rest = more;
            self.head_cell_ui(ui, cell, (By::Number(column.metric), title), sorting);
        }
        self.head_cell_ui(ui, rest, (By::End, tune::COLUMN_END), sorting);
    }

    fn head_cell_ui(
        &self,
        ui: &mut Ui,
        cell: Rect,
        (by, title): (By, Text),
        sorting: &mut Sorting,
    ) {
        let look = self.pane.look;
        let text = look.say(title);
        let is_own = sorting.by == by;
        let button = Button::new(text, look.say(tune::COLUMN_TIP)).choice(is_own);
        let response = button.ground(ui, look, cell, Id::unique(("trial column", title.en)));
        let mut words = cell.shrink2(vec2(theme::STEP, 0.0));
        if is_own {
            let (arrow, way) = match sorting.falling {
                true => (theme::TO_BOTTOM, compare::FALLING),
                false => (theme::TO_TOP, compare::RISING),
            };
            let place = words.with_min_x(words.right() - theme::SORT_ARROW);
            words.max.x = place.min.x;
            let label = format!("{text}: {}", look.say(way));
            let sign = ui.interact(place, Id::unique("trial sorting"), Sense::hover());
            sign.widget_info(|| WidgetInfo::labeled(Role::Label, true, &label));
            controls::sign(ui, place, arrow, look.palette.accent);
        }
        let (font, color) = (theme::small(), look.palette.muted);
        controls::paint_text(ui, words, Align2::CENTER_CENTER, text, font, color);
        if response.clicked() {
            *sorting = Sorting {
                by,
                falling: match is_own {
                    true => !sorting.falling,
                    false => by.better() == Better::Higher,
                },
            };
        }
    }

    fn row_ui(&self, ui: &mut Ui, rect: Rect, row: &Row<'_>, chosen: bool) -> bool {
        let look = self.pane.look;
        let (tried, joint) = (row.seen.trial, row.seen.joint);
        let session = row.seen.session.id;
        let id = Id::unique(("trial row", session, tried.number, joint.dof));
        let response = ui.interact(rect, id, Sense::click());
        let name = match self.several() {
            true => format!("{}: {}", session.0, row.name),
            false => row.name.clone(),
        };
        response.widget_info(|| WidgetInfo::selected(Role::Row, true, chosen, &name));
        let ground = match (chosen, response.hovered()) {
            (true, _) => look.palette.wash(look.palette.accent),
            (false, true) => look.palette.control,
            (false, false) => Color32::TRANSPARENT,
        };
        let round = CornerRadius::same(theme::ROUND_TINY);
        ui.painter().rect_filled(rect, round, ground);
        let (place, mut first, mut rest, each) = self.cells(rect);
        if self.several() {
            let text = session.0.to_string();
            let label = format!("{} {}", row.short, look.say(compare::COLUMN_SESSION));
            Label::new(&text, look.palette.text)
                .number()
                .center()
                .named(&label)
                .put(ui, place);
        }
        let swatch = take_left(&mut first, theme::KEY_SIGN);
        let stroke = Stroke::new(theme::BAR, row.color);
        dash::sample(ui.painter(), swatch, row.style, stroke);
        Label::new(&row.name, look.palette.text)
            .small()
            .put(ui, first);
        for (column, title) in shown() {
            let (cell, more) = rest.split_left_right_at_x(rest.left() + each);
            rest = more;
            let text = column.text(joint);
            let label = format!("{} {}", row.short, look.say(title));
            Label::new(&text, look.palette.text)
                .number()
                .right()
                .named(&label)
                .put(ui, cell.with_max_x(cell.right() - theme::GAP));
        }
        Label::new(&row.end, look.palette.muted)
            .small()
            .put(ui, rest.translate(vec2(theme::GAP, 0.0)));
        response.clicked()
    }

    /// The spread of settings that were tried more than once.
    fn repeats_ui(&self, ui: &mut Ui, place: Rect, laid: &Laid) {
        if laid.repeated.is_empty() {
            return;
        }
        let look = self.pane.look;
        let mut top = place.top() + repeats_top(laid);
        let title = place.with_min_y(top - theme::LIST_LINE).with_max_y(top);
        Label::new(look.say(tune::REPEATED), look.palette.muted)
            .small()
            .put(ui, title);
        for (id, setting) in &laid.repeated {
            let rect = place
                .with_min_y(top)
                .with_max_y(top + theme::FIGURE_ROW * 2.0);
            top = rect.bottom();
            let session = self.pane.state.trials.session(*id);
            if let Some(session) = session.filter(|_| ui.is_rect_visible(rect)) {
                self.repeat_ui(ui, rect, session, *setting);
            }
        }
    }

    fn repeat_ui(&self, ui: &mut Ui, rect: Rect, session: &TrialSession, setting: TrialSetting) {
        let look = self.pane.look;
        let (place, first, mut rest, each) = self.cells(rect);
        let mut text = setting_words(setting);
        Label::new(&text, look.palette.text).small().put(ui, first);
        if self.several() {
            let number = session.id.0.to_string();
            text = format!("{number}: {text}");
            Label::new(&number, look.palette.text)
                .number()
                .center()
                .put(ui, place);
        }
        let own = session.trials.iter().map(|own| &own.summary);
        let own = own.filter(|tried| tried.setting == setting && !tried.is_probe());
        let joints: Vec<&JointMetrics> = own.flat_map(|tried| &tried.joints).collect();
        for (column, title) in shown() {
            let (cell, more) = rest.split_left_right_at_x(rest.left() + each);
            rest = more;
            let values: Vec<f64> = joints
                .iter()
                .filter_map(|own| (column.value)(own))
                .collect();
            let (mean, range) = spread(&values, column.decimals);
            let (upper, lower) = cell
                .with_max_x(cell.right() - theme::GAP)
                .split_top_bottom_at_fraction(0.5);
            let label = format!("{text} {}", look.say(title));
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
