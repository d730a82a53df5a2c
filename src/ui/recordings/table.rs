//! The table of recordings: a row each, with its actions at the end.

use crate::app::action::Action;
use crate::app::recordings::{RecordingAction, RecordingExport, RecordingItem};
use crate::hand::{Moment, PerDof};
use crate::record::EventKind;
use crate::record::export::ExportFormat;
use crate::ui::hand::tile;
use crate::ui::kit::{self, Button, Label, Look, Pane, TextField, ViewRequest, Weight, format};
use crate::ui::plots::times::length;
use crate::ui::recordings::marks;
use crate::ui::recordings::strip;
use crate::ui::text::{Text, notices, recordings};
use crate::ui::theme;
use crate::ui::view::Tab;
use egui::{
    Align, Color32, Layout, Painter, Popup, Rangef, Rect, Role, Sense, SetOpenCommand, Stroke, Ui,
    Vec2, WidgetInfo, vec2,
};
use egui_extras::Column;
use std::path::PathBuf;
use std::time::Duration;

const ROW: f32 = 40.0;
/// Maximum characters of a name.
const NAME_MAX: usize = 80;
/// Minimum width of a name.
const NAME: f32 = 200.0;
/// Minimum and maximum width of the force strip; at maximum, one column per point.
const STRIP: (f32, f32) = (48.0, 308.0);
/// Maximum number of marks listed beside the pointer.
const MARKS_TOLD: usize = 3;
/// Size of the hand drawn beside the pointer.
const HAND: Vec2 = vec2(120.0, 112.0);

/// Columns with title and width; the strip gets the space left beside a minimum name, the name the rest.
const COLUMNS: [(Text, f32); 9] = [
    (recordings::STAR, 36.0),
    (recordings::NAME, 0.0),
    (recordings::LENGTH, 100.0),
    (recordings::FORCE, STRIP.0),
    (recordings::FAULTS, 52.0),
    (recordings::TRIALS, 52.0),
    (recordings::NOTES, 52.0),
    (recordings::SIZE, 72.0),
    (recordings::REPLAY, 100.0),
];

/// A time range marked on a recording's strip, as shares of its length.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MarkedStretch {
    path: PathBuf,
    from: f64,
    to: f64,
}

impl MarkedStretch {
    /// Duration of the range.
    fn length(&self, item: &RecordingItem) -> Duration {
        item.length.mul_f64(self.to - self.from)
    }

    fn stretch(&self, item: &RecordingItem) -> (Moment, Moment) {
        (item.moment(self.from), item.moment(self.to))
    }

    fn paint(&self, painter: &Painter, look: Look, place: Rect) {
        let x = |part: f64| {
            #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
            let part = part as f32;
            place.left() + part * place.width()
        };
        let xs = Rangef::new(x(self.from), x(self.to));
        let stretch = Rect::from_x_y_ranges(xs, place.y_range());
        painter.rect_filled(stretch, 0.0, look.palette.wash(look.palette.accent));
        let edge = Stroke::new(1.0, look.palette.accent);
        painter.vline(xs.min, place.y_range(), edge);
        painter.vline(xs.max, place.y_range(), edge);
    }
}

/// The table, with the marked range.
pub(crate) struct RecordingTable<'a> {
    pub(crate) marked: &'a mut Option<MarkedStretch>,
}

impl RecordingTable<'_> {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, items: &[&RecordingItem]) {
        let look = pane.look;
        ui.spacing_mut().item_spacing.x = theme::STEP;
        let strip = strip_width(ui.available_width());
        let table = kit::table(ui, "recorded").striped(true);
        let mut table = table.auto_shrink(false);
        for (title, width) in COLUMNS {
            table = table.column(match width {
                0.0 => Column::remainder().at_least(NAME).clip(true),
                _ if title == recordings::FORCE => Column::exact(strip),
                width => Column::exact(width),
            });
        }
        let table = table.header(theme::CONTROL, |mut row| {
            for (title, _) in COLUMNS {
                let is_named = title != recordings::REPLAY;
                let text = if is_named { look.tr(title) } else { "" };
                let label = Label::new(text, look.palette.muted);
                label.small().column_ui(&mut row);
            }
        });
        table.body(|body| {
            body.rows(ROW, items.len(), |mut row| {
                let Some(item) = items.get(row.index()) else {
                    return;
                };
                for column in 0..COLUMNS.len() {
                    row.col(|ui| self.cell_ui(ui, pane, item, column));
                }
            });
        });
    }

    fn cell_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, item: &RecordingItem, column: usize) {
        let palette = pane.look.palette;
        let count = |ui: &mut Ui, count: u64, color: Color32| {
            let color = if count == 0 { palette.faint } else { color };
            Label::new(&count.to_string(), color).number().ui(ui);
        };
        match column {
            0 => star_ui(ui, pane, item),
            1 => name_ui(ui, pane, item),
            2 => {
                let length = format::duration(pane.state.recordings.length(item));
                Label::new(&length, palette.text).number().ui(ui);
            }
            3 => self.strip_ui(ui, pane, item),
            4 => count(ui, item.counts.faults, palette.bad),
            5 => {
                let trials = item.count(EventKind::Trial);
                count(ui, u64::try_from(trials).unwrap_or_default(), palette.text);
            }
            6 => {
                let notes = item.notes().len();
                count(ui, u64::try_from(notes).unwrap_or_default(), palette.text);
            }
            7 => size_ui(ui, pane, item),
            _ => self.ends_ui(ui, pane, item),
        }
    }

    /// Draws the force strip: hovering shows the hand at that time, a drag marks a range and offers its export.
    fn strip_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, item: &RecordingItem) {
        let look = pane.look;
        let size = vec2(ui.available_width() - theme::GAP, ROW - theme::GAP);
        let (place, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        let name = look.pair(look.tr(recordings::STRIP), &item.title());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
        let part = |x: f32| f64::from(((x - place.left()) / place.width()).clamp(0.0, 1.0));
        if response.clicked() {
            *self.marked = None;
        }
        let origin = ui.input(|input| input.pointer.press_origin());
        let drag = origin.zip(response.interact_pointer_pos());
        if let Some((from, to)) = drag.filter(|_| response.dragged()) {
            let (one, other) = (part(from.x), part(to.x));
            *self.marked = Some(MarkedStretch {
                path: item.path.clone(),
                from: one.min(other),
                to: one.max(other),
            });
        }
        let painter = ui.painter();
        painter.rect_filled(place, theme::ROUND_TINY, look.palette.sunken);
        if let Some(marked) = self.of(item) {
            marked.paint(painter, look, place);
        }
        strip::strip(ui.painter(), look, place, &item.strip);
        strip::marks(ui.painter(), look, place, item);
        let is_marked = response.drag_stopped() && self.of(item).is_some();
        let open = is_marked.then_some(SetOpenCommand::Bool(true));
        let menu = Popup::from_response(&response).open_memory(open);
        let menu = menu
            .at_pointer_fixed()
            .layout(Layout::top_down_justified(Align::Min));
        menu.show(|ui| self.formats_ui(ui, pane, item));
        let pointed = response.hover_pos().map(|at| part(at.x));
        if let Some(part) = pointed.filter(|_| !response.dragged()) {
            response.on_hover_ui_at_pointer(|ui| moment_ui(ui, look, item, part));
        }
    }

    /// Marked range of a recording.
    fn of(&self, item: &RecordingItem) -> Option<&MarkedStretch> {
        self.marked
            .as_ref()
            .filter(|marked| marked.path == item.path)
    }

    /// Draws the export formats of a recording, or of its marked range.
    fn formats_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, item: &RecordingItem) {
        let look = pane.look;
        let marked = self.of(item);
        let title = match marked {
            Some(marked) => {
                let length = length(marked.length(item).as_secs_f64());
                look.fill(recordings::EXPORT_PART, &[&length])
            }
            None => look.tr(recordings::EXPORT).to_owned(),
        };
        ui.label(title);
        let stretch = marked.map(|marked| marked.stretch(item));
        let mut export = |ui: &mut Ui, format, uncommanded| {
            let export = RecordingExport {
                path: item.path.clone(),
                format,
                stretch,
                uncommanded,
            };
            pane.actions
                .push(Action::Recording(RecordingAction::Export(export)));
            ui.close();
        };
        for &format in ExportFormat::ALL {
            let label = look.tr(recordings::export_format(format));
            if ui.button(label).clicked() {
                export(ui, format, false);
            }
        }
        let uncommanded = ui.button(look.tr(recordings::UNCOMMANDED));
        let uncommanded = uncommanded.on_hover_text(look.tip(recordings::UNCOMMANDED));
        if uncommanded.clicked() {
            export(ui, ExportFormat::LeRobot, true);
        }
    }

    fn ends_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>, item: &RecordingItem) {
        let look = pane.look;
        let title = item.title();
        let named = look.pair(look.tr(recordings::REPLAY), &title);
        let replay = Button::text(look, recordings::REPLAY).named(&named);
        let open = RecordingAction::Open(item.path.clone());
        if replay.ui(ui, look).clicked() {
            pane.actions.push(Action::Recording(open));
            pane.open(ViewRequest::Tab(Tab::Live));
        }
        let named = look.pair(look.tr(recordings::MORE), &title);
        let more = Button::text(look, recordings::MORE).named(&named);
        let more = more.icon(theme::MORE).weight(Weight::Quiet).ui(ui, look);
        kit::lasting_popup(&more).show(|ui| {
            ui.set_width(260.0);
            let field = TextField::new(look.tr(recordings::RENAME), NAME_MAX);
            let field = field.hint(look.tip(recordings::RENAME));
            if let Some(name) = field.ui(ui, pane, &item.about.name) {
                let action = RecordingAction::Name(item.path.clone(), name.trim().to_owned());
                pane.actions.push(Action::Recording(action));
            }
            if kit::entry_ui(ui, look, recordings::REVEAL) {
                let reveal = RecordingAction::Reveal(item.path.clone());
                pane.actions.push(Action::Recording(reveal));
                ui.close();
            }
            ui.separator();
            self.formats_ui(ui, pane, item);
            ui.separator();
            if kit::entry_ui(ui, look, recordings::COPY_PATH) {
                ui.copy_text(item.path.display().to_string());
                ui.close();
            }
            if kit::entry_ui(ui, look, recordings::DELETE) {
                let ask = RecordingAction::AskDelete(item.path.clone());
                pane.actions.push(Action::Recording(ask));
                ui.close();
            }
        });
    }
}

/// Width of the force strip, such that all columns fit in the smallest window.
fn strip_width(room: f32) -> f32 {
    let others = COLUMNS.iter().map(|(_, width)| width + theme::STEP);
    let taken = others.sum::<f32>() - STRIP.0 + NAME;
    (room - taken - theme::GAP).clamp(STRIP.0, STRIP.1)
}

/// Draws the size, in another colour if the recording is due for deletion.
fn size_ui(ui: &mut Ui, pane: &Pane<'_>, item: &RecordingItem) {
    let look = pane.look;
    let mut planned = pane.state.recordings.planned.iter();
    let planned = planned.find(|planned| planned.path == item.path);
    let color = match planned {
        Some(_) => look.palette.warn,
        None => look.palette.muted,
    };
    let size = format::megabytes(item.bytes);
    let label = Label::new(&size, color).number().ui(ui);
    if let Some(planned) = planned {
        label.on_hover_text(look.fill(recordings::GOES, &[&planned.due()]));
    }
}

fn star_ui(ui: &mut Ui, pane: &mut Pane<'_>, item: &RecordingItem) {
    let look = pane.look;
    let star = item.about.star;
    let (icon, tip) = if star {
        (theme::STAR, look.tr(recordings::UNSTAR))
    } else {
        (theme::NO_STAR, look.tip(recordings::STAR))
    };
    let name = look.pair(look.tr(recordings::STAR), &item.title());
    let button = Button::new(look.tr(recordings::STAR), tip).named(&name);
    let button = button.icon(icon).weight(Weight::Quiet).selected(star);
    let action = RecordingAction::Star(item.path.clone(), !star);
    button.on_click(ui, pane, Action::Recording(action));
}

/// Draws the title, and the hand below it.
fn name_ui(ui: &mut Ui, pane: &mut Pane<'_>, item: &RecordingItem) {
    let look = pane.look;
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.add_space(theme::STEP);
        let title = recordings::title(look, pane.state, item);
        let label = Label::new(&title, look.palette.text).ui(ui);
        label.on_hover_text(item.path.display().to_string());
        let is_recorded = item.is_in(&pane.state.recordings.recorded);
        let simulated = item.opening.simulated.then_some(recordings::SIMULATED);
        let (state, color) = match item.closed {
            _ if is_recorded => (Some(recordings::RECORDS_NOW), look.palette.ok),
            true => (None, look.palette.muted),
            false => (Some(recordings::UNCLOSED), look.palette.warn),
        };
        let about = state.into_iter().chain(simulated).map(|text| look.tr(text));
        let about: Vec<&str> = about.chain([item.opening.hand.as_str()]).collect();
        let label = Label::new(&about.join("  "), color).small().ui(ui);
        if !item.closed {
            label.on_hover_text(look.tip(recordings::UNCLOSED));
        }
    });
}

/// Draws the hand at a share of the recording, with the time, the maximum force and the events at that point.
fn moment_ui(ui: &mut Ui, look: Look, item: &RecordingItem, part: f64) {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "a place in a short list"
    )]
    let column =
        ((item.strip.len() as f64 * part) as usize).min(item.strip.len().saturating_sub(1));
    if let Some(pose) = item.poses.get(column) {
        let (_, place) = ui.allocate_space(HAND);
        let shares = PerDof::from_fn(|dof| pose[dof].map(|angle| f32::from(angle) / 1000.0));
        tile::pose_ui(ui, look, place, &shares);
    }
    let at = item.moment(part);
    let force = item.strip.get(column).filter(|force| force.is_finite());
    let force = force.map_or_else(|| format::UNKNOWN.into(), |force| format!("{force:.0}"));
    let clock = marks::clock(at.since(item.first));
    let words = look.fill(recordings::AT_MOMENT, &[&clock, &force]);
    Label::new(&words, look.palette.text).number().ui(ui);
    let near = item.length.mul_f64(1.5 / f64::from(STRIP.1));
    let is_near = |moment: Moment| at.since(moment).max(moment.since(at)) <= near;
    let notes = item.notes().into_iter().filter(|note| is_near(note.at()));
    let marks = item.marks.iter().filter(|mark| is_near(mark.at));
    let marks = marks.filter_map(|mark| {
        let (text, _) = marks::shown(look, mark.kind)?;
        Some(match mark.kind {
            EventKind::Note => return None,
            EventKind::Fault => notices::fault_mark(look, &mark.words),
            _ => look.tr(text).to_owned(),
        })
    });
    for words in marks.chain(notes.map(|note| note.words)).take(MARKS_TOLD) {
        Label::new(&words, look.palette.muted).small().ui(ui);
    }
}
