//! What was measured, one row a trial and joint, and one for each setting that was repeated. Sorts, measures nothing.

use crate::app::settings::Language;
use crate::app::trials::{ComparedRow, Comparison, RowKey, SessionId};
use crate::trials::columns::{Better, COLUMNS, Metric};
use crate::trials::{JointMetrics, TrialSetting};
use crate::ui::kit::{self, Label, Pane, dash};
use crate::ui::text::{Text, tune, words};
use crate::ui::theme;
use crate::ui::trials::compare_choice::TrialKey;
use crate::ui::trials::compare_columns::{end_words, order, setting_words, shown, spread};
use crate::ui::trials::compare_curves::color;
use crate::ui::trials::compare_list;
use egui::{
    Align, Color32, Layout, RichText, Role, ScrollArea, Sense, Stroke, Ui, WidgetInfo, vec2,
};
use egui_extras::{Column, TableBuilder, TableRow};

const ROW: f32 = 20.0;
/// Height of the head and of a mean over its range.
const ROW_HIGH: f32 = 36.0;
/// Width of the session's number, and least width of what the drive said in the end.
const SESSION: f32 = 56.0;
const END: f32 = 88.0;

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
        let own = COLUMNS.iter().find(|own| Self::Number(own.metric) == self);
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
    /// The comparison is another one than the rows were laid out for.
    is_old: bool,
}

#[derive(Debug)]
struct Laid {
    sorting: Sorting,
    language: Language,
    order: Vec<RowKey>,
    repeated: Vec<(SessionId, TrialSetting)>,
}

/// What every part of the table is drawn with.
struct TrialSheet<'a, 'b> {
    pane: &'a Pane<'b>,
    comparison: &'a Comparison,
}

impl TableView {
    /// The comparison is another one.
    pub(crate) const fn forget(&mut self) {
        self.is_old = true;
    }

    /// Draws the table over all of `ui`. A pressed row stands out in the curves.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: &mut Option<TrialKey>,
    ) {
        let sheet = TrialSheet { pane, comparison };
        let is_pointed = ui.rect_contains_pointer(ui.available_rect_before_wrap());
        let laid = self.laid(&sheet, is_pointed);
        let sorting = &mut self.sorting;
        let several = sheet.several();
        let palette = pane.look.palette;
        ui.visuals_mut().selection.bg_fill = palette.wash(palette.accent);
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        let width = ui.available_width();
        ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
            let mut table = TableBuilder::new(ui)
                .id_salt(("trials", several))
                .sense(Sense::click())
                .cell_layout(Layout::left_to_right(Align::Center))
                .min_scrolled_height(0.0)
                .auto_shrink(false);
            if several {
                table = table.column(Column::exact(SESSION));
            }
            let number = Column::exact((width * 0.063).clamp(52.0, 84.0));
            let table = table
                .column(Column::exact((width * 0.19).clamp(156.0, 260.0)))
                .columns(number, shown().count())
                .column(Column::remainder().at_least(END).clip(true))
                .header(ROW_HIGH, |mut row| sheet.head_ui(&mut row, sorting));
            let rows = laid.order.iter().map(|_| ROW);
            let heights = rows.chain(laid.repeated.iter().map(|_| ROW_HIGH));
            table.body(|body| {
                body.heterogeneous_rows(heights, |mut row| match laid.order.get(row.index()) {
                    Some(key) => sheet.row_ui(&mut row, *key, strong),
                    None => {
                        let at = row.index() - laid.order.len();
                        if let Some((id, setting)) = laid.repeated.get(at) {
                            sheet.repeat_ui(&mut row, *id, *setting);
                        }
                    }
                });
            });
        });
        self.laid = Some(laid);
    }

    /// The rows in their order, reckoned again only when something changed; what is new comes last while the pointer is on
    /// them.
    fn laid(&mut self, sheet: &TrialSheet<'_, '_>, is_pointed: bool) -> Laid {
        let (sorting, language) = (self.sorting, sheet.pane.look.language);
        let former = self.laid.take();
        let former = former.filter(|own| own.sorting == sorting && own.language == language);
        let mut order = match former {
            Some(own) if !self.is_old => return own,
            Some(own) if is_pointed => own.order,
            _ => {
                self.is_old = false;
                sheet.sorted(sorting)
            }
        };
        let rows = &sheet.comparison.rows;
        order.retain(|key| rows.contains(key));
        let new = rows.iter().filter(|key| !order.contains(key));
        let new: Vec<RowKey> = new.copied().collect();
        order.extend(new);
        Laid {
            sorting,
            language,
            order,
            repeated: sheet.repeated(),
        }
    }
}

impl<'a> TrialSheet<'a, '_> {
    fn several(&self) -> bool {
        self.comparison.sessions().len() > 1
    }

    fn seen(&self, place: RowKey) -> Option<ComparedRow<'a>> {
        self.comparison.row(&self.pane.state.trials, place)
    }

    /// The rows in the order that is asked for; what is not known goes last, whichever way the rest is sorted.
    fn sorted(&self, sorting: Sorting) -> Vec<RowKey> {
        let count = |number: usize| u32::try_from(number).ok().map(f64::from);
        let value = |key: &RowKey| match sorting.by {
            By::Session => count(key.session),
            By::Trial => count(key.trial),
            By::End => None,
            By::Number(metric) => {
                let own = COLUMNS.iter().find(|column| column.metric == metric)?;
                (own.value)(self.seen(*key)?.joint)
            }
        };
        let end = |key: &RowKey| match sorting.by {
            By::End => self.seen(*key).map(|seen| self.end(seen)),
            _ => None,
        };
        let rows = self.comparison.rows.iter();
        let mut keyed: Vec<_> = rows.map(|key| (value(key), end(key), *key)).collect();
        keyed.sort_by(|a, b| {
            let words = if sorting.falling {
                b.1.cmp(&a.1)
            } else {
                a.1.cmp(&b.1)
            };
            order(a.0, b.0, sorting.falling).then(words)
        });
        keyed.into_iter().map(|(_, _, key)| key).collect()
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
            Some(why) => tune::ended(look, why),
            None => end_words(look, seen.joint.end_status.as_deref()),
        }
    }

    fn head_ui(&self, row: &mut TableRow<'_, '_>, sorting: &mut Sorting) {
        let session = (By::Session, tune::COLUMN_SESSION);
        let first = [session, (By::Trial, tune::COLUMN_TRIAL)].into_iter();
        let numbers = shown().map(|(column, title)| (By::Number(column.metric), title));
        let heads = first.skip(usize::from(!self.several())).chain(numbers);
        for head in heads.chain([(By::End, tune::COLUMN_END)]) {
            row.col(|ui| self.head_cell_ui(ui, head, sorting));
        }
    }

    /// The head of a column over its unit. A click sorts by it.
    fn head_cell_ui(&self, ui: &mut Ui, (by, title): (By, Text), sorting: &mut Sorting) {
        let look = self.pane.look;
        let text = look.say(title);
        let is_own = sorting.by == by;
        // The unit below its quantity, or nothing, so that all heads are of two lines.
        let unit = text.split_once(", ").or_else(|| text.split_once(' '));
        let (name, unit) = unit.unwrap_or((text, ""));
        let (arrow, way) = match (is_own, sorting.falling) {
            (false, _) => ("", ""),
            (true, true) => (" ▼", look.say(tune::FALLING)),
            (true, false) => (" ▲", look.say(tune::RISING)),
        };
        let words = RichText::new(format!("{name}\n{unit}{arrow}")).small();
        let button = egui::Button::selectable(is_own, words.color(look.palette.muted));
        let response = ui.add_sized(ui.available_size(), button);
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_own, text));
        ui.ctx()
            .accesskit_node_builder(response.id, |node| node.set_value(way));
        let response = response.on_hover_text(look.say(tune::COLUMN_TIP));
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

    fn row_ui(&self, row: &mut TableRow<'_, '_>, place: RowKey, strong: &mut Option<TrialKey>) {
        let look = self.pane.look;
        let Some(seen) = self.seen(place) else { return };
        let (session, tried) = (seen.session.id, seen.trial);
        let key = Some((session, tried.number));
        let is_chosen = *strong == key;
        row.set_selected(is_chosen);
        let kind = match tried.is_probe() {
            true => look.say(tune::PROBE).to_owned(),
            false => setting_words(tried.setting),
        };
        let joint = look.say(words::dof(seen.joint.dof));
        let (text, number) = (look.palette.text, tried.number);
        let name = format!("{number}  {kind}  {joint}");
        let (short, whole) = match self.several() {
            true => (
                format!("{}: {number}", session.0),
                format!("{}: {name}", session.0),
            ),
            false => (number.to_string(), name.clone()),
        };
        if self.several() {
            let label = format!("{short} {}", look.say(tune::COLUMN_SESSION));
            row.col(|ui| number_ui(ui, &label, &session.0.to_string(), text));
        }
        row.col(|ui| {
            let size = vec2(theme::KEY_SIGN, ui.available_height());
            let (_, swatch) = ui.allocate_space(size);
            let color = color(self.pane, self.comparison, place, seen);
            let style = compare_list::style(self.comparison.sessions(), session);
            dash::sample(ui.painter(), swatch, style, Stroke::new(theme::BAR, color));
            ui.add_space(theme::STEP);
            Label::new(&name, text).small().ui(ui);
        });
        for (column, title) in shown() {
            let label = format!("{short} {}", look.say(title));
            row.col(|ui| number_ui(ui, &label, &column.text(seen.joint), text));
        }
        row.col(|ui| {
            ui.add_space(theme::GAP);
            let end = self.end(seen);
            Label::new(&end, look.palette.muted).small().ui(ui);
        });
        let response = row.response();
        response.widget_info(|| WidgetInfo::selected(Role::Row, true, is_chosen, &whole));
        if response.clicked() {
            *strong = key.filter(|_| !is_chosen);
        }
    }

    /// The mean and the spread of a setting that was tried more than once.
    fn repeat_ui(&self, row: &mut TableRow<'_, '_>, id: SessionId, setting: TrialSetting) {
        let look = self.pane.look;
        let Some(session) = self.pane.state.trials.session(id) else {
            return;
        };
        let own = session.trials.iter().map(|own| &own.summary);
        let own = own.filter(|tried| tried.setting == setting && !tried.is_probe());
        let count = own.clone().count();
        let joints: Vec<&JointMetrics> = own.flat_map(|tried| &tried.joints).collect();
        let mut name = setting_words(setting);
        let title = look.fill(tune::REPEATED, &[&count, &name]);
        if self.several() {
            name = format!("{}: {name}", id.0);
            let label = format!("{name} {}", look.say(tune::COLUMN_SESSION));
            row.col(|ui| number_ui(ui, &label, &id.0.to_string(), look.palette.text));
        }
        row.col(|ui| {
            ui.add_space(theme::KEY_SIGN + theme::STEP);
            Label::new(&title, look.palette.text).small().ui(ui);
        });
        for (column, title) in shown() {
            let values = joints.iter().filter_map(|own| (column.value)(own));
            let (mean, range) = spread(&values.collect::<Vec<f64>>(), column.decimals);
            let label = format!("{name} {}", look.say(title));
            row.col(|ui| {
                ui.with_layout(Layout::top_down(Align::Max), |ui| {
                    number_ui(ui, &label, &mean, look.palette.text);
                    let range = Label::new(&range, look.palette.muted);
                    range.number().ui(ui);
                });
            });
        }
        row.col(|_| ());
    }
}

/// A number against the right edge of its cell.
fn number_ui(ui: &mut Ui, label: &str, text: &str, color: Color32) {
    kit::right_ui(ui, |ui| {
        ui.add_space(theme::STEP);
        Label::new(text, color).number().named(label).ui(ui);
    });
}
