//! The timeline of a replayed recording: current moment, playback speed, and events.

use crate::app::action::Action;
use crate::app::activity::RecordedPlay;
use crate::app::recordings::{RecordingAction, Timeline};
use crate::hand::Moment;
use crate::record::EventKind;
use crate::ui::kit::{self, Button, Label, Look, Pane, Weight};
use crate::ui::recordings::marks::{clock, play_words, shown};
use crate::ui::recordings::{beside, strip};
use crate::ui::text::{panels, recordings};
use crate::ui::theme;
use egui::{
    Color32, Event, PointerButton, Popup, Pos2, Rect, Response, Role, ScrollArea, Sense, Stroke,
    Ui, WidgetInfo, pos2, vec2,
};
use std::collections::BTreeMap;
use std::time::Duration;

/// Height of the timeline with its controls, in points.
pub(crate) const HEIGHT: f32 = 84.0;
/// Height of the line alone.
const LINE: f32 = 36.0;
/// Playback speeds.
const PACES: [(f32, &str); 6] = [
    (0.1, "0.1x"),
    (0.5, "0.5x"),
    (1.0, "1x"),
    (2.0, "2x"),
    (5.0, "5x"),
    (10.0, "10x"),
];
pub(crate) fn timeline_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    if line.runs || line.waits {
        // A live hand may send no updates meanwhile.
        ui.ctx().request_repaint();
    }
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = theme::STEP;
        ui.horizontal(|ui| {
            ui.set_min_height(theme::CONTROL);
            controls_ui(ui, pane, line);
            kit::right_ui(ui, |ui| about_ui(ui, pane.look, line));
        });
        line_ui(ui, pane, line);
    });
}

fn recording(pane: &mut Pane<'_>, action: RecordingAction) {
    pane.actions.push(Action::Recording(action));
}

fn controls_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let look = pane.look;
    let (run, run_icon) = if line.runs {
        (recordings::PAUSE, theme::PAUSE)
    } else {
        (recordings::RUN, theme::PLAY)
    };
    for (text, icon, action) in [
        (
            recordings::STEP_BACK,
            theme::TO_LEFT,
            RecordingAction::Step(false),
        ),
        (run, run_icon, RecordingAction::Run(!line.runs)),
        (
            recordings::STEP_ON,
            theme::TO_RIGHT,
            RecordingAction::Step(true),
        ),
    ] {
        let button = Button::text(look, text).icon(icon);
        button.on_click(ui, pane, Action::Recording(action));
    }
    let mut pace = line.pace;
    let name = look.tr(recordings::PACE);
    ui.scope(|ui| {
        ui.spacing_mut().combo_width = 64.0;
        if kit::choose_ui(ui, name, &mut pace, &PACES) {
            recording(pane, RecordingAction::Pace(pace));
        }
    });
    if line.looped.is_some() {
        let off = Button::text(look, recordings::LOOP_OFF);
        off.on_click(ui, pane, Action::Recording(RecordingAction::Loop(None)));
    }
    let at = clock(line.at.since(line.first));
    let whole = clock(line.last.since(line.first));
    let color = if line.waits {
        look.palette.faint
    } else {
        look.palette.text
    };
    let words = format!("{at} / {whole}");
    Label::new(&words, color).number().ui(ui);
    marks_ui(ui, pane, line);
    beside::beside_ui(ui, pane, line);
    let note = Button::text(look, recordings::NOTE_HERE);
    note.navigate(ui, pane, kit::ViewRequest::Note);
    if line.damaged {
        kit::warning_ui(ui, look.palette.warn).on_hover_text(look.tr(recordings::DAMAGED));
    }
}

/// Name and origin of the recording.
fn about_ui(ui: &mut Ui, look: Look, line: &Timeline) {
    let words = format!("{}   {}   {}", line.title, line.began, line.hand);
    let label = Label::new(&words, look.palette.muted).small().right();
    label.ui(ui).on_hover_text(line.path.display().to_string());
}

/// One entry of the list of marks. Its text is built when it is visible: a long recording has a hundred thousand marks.
#[derive(Clone, Copy)]
struct TimelineEntry<'a> {
    at: Moment,
    kind: EventKind,
    words: &'a str,
    color: Color32,
}

impl TimelineEntry<'_> {
    fn is_note(self) -> bool {
        self.kind == EventKind::Note
    }

    fn text(self, look: Look) -> String {
        let play = (self.kind == EventKind::Play).then(|| RecordedPlay::read(self.words));
        if let Some(play) = play.flatten() {
            return play_words(look, &play);
        }
        match shown(look, self.kind).filter(|_| !self.is_note()) {
            Some((text, _)) if self.words.is_empty() => look.tr(text).to_owned(),
            Some((text, _)) => look.pair(look.tr(text), self.words),
            None => self.words.to_owned(),
        }
    }
}

/// All marks, and the notes in force; not in time order.
fn entries(look: Look, line: &Timeline) -> impl Iterator<Item = TimelineEntry<'_>> {
    let marks = line.marks.iter();
    let marks = marks.filter(|mark| mark.kind != EventKind::Note);
    let marks = marks.filter_map(move |mark| {
        let (_, color) = shown(look, mark.kind)?;
        Some(TimelineEntry {
            at: mark.at,
            kind: mark.kind,
            words: &mark.words,
            color,
        })
    });
    let notes = line.notes.iter().map(move |note| TimelineEntry {
        at: note.at(),
        kind: EventKind::Note,
        words: &note.words,
        color: look.palette.text,
    });
    marks.chain(notes)
}

/// Colour of each one-point column with a mark: of several in a column, that of the first of the worst kind.
fn columns(look: Look, place: Rect, line: &Timeline) -> BTreeMap<i32, (u8, Color32)> {
    let rank = |kind| match kind {
        EventKind::Fault | EventKind::LinkLost => 0,
        EventKind::Stop | EventKind::Recording => 1,
        EventKind::Note => 2,
        _ => 3,
    };
    let mut columns = BTreeMap::new();
    for entry in entries(look, line) {
        let column = x_of(place, line, entry.at).round();
        #[expect(clippy::cast_possible_truncation, reason = "a column of a screen")]
        let there = columns.entry(column as i32);
        let own = (rank(entry.kind), entry.color);
        let kept = there.or_insert(own);
        if own.0 < kept.0 {
            *kept = own;
        }
    }
    columns
}

fn marks_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let look = pane.look;
    let button = Button::text(look, recordings::EVENTS).ui(ui, look);
    Popup::menu(&button).show(|ui| {
        ui.set_min_width(320.0);
        let mut all: Vec<_> = entries(look, line).collect();
        all.sort_by_key(|entry| entry.at);
        if all.is_empty() {
            Label::muted(look, recordings::NO_EVENTS).ui(ui);
        }
        let height = ui.spacing().interact_size.y;
        let area = ScrollArea::vertical().max_height(320.0);
        area.show_rows(ui, height, all.len(), |ui, rows| {
            for entry in all.get(rows).unwrap_or_default() {
                entry_ui(ui, pane, line, *entry);
            }
        });
    });
}

fn entry_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline, entry: TimelineEntry<'_>) {
    let look = pane.look;
    ui.horizontal(|ui| {
        kit::lamp_ui(ui, Some(entry.color));
        let clock = clock(entry.at.since(line.first));
        if ui
            .button(format!("{clock}  {}", entry.text(look)))
            .clicked()
        {
            recording(pane, RecordingAction::Seek(entry.at));
        }
        if entry.is_note() {
            let delete = Button::text(look, panels::NOTE_DELETE).icon(theme::CLOSE);
            let none = RecordingAction::EditNote(entry.at, String::new());
            let delete = delete.weight(Weight::Quiet);
            delete.on_click(ui, pane, Action::Recording(none));
        }
    });
}

/// Draws the line: force, marks, the looped time range, and the current moment.
fn line_ui(ui: &mut Ui, pane: &mut Pane<'_>, line: &Timeline) {
    let look = pane.look;
    let size = vec2(ui.available_width(), LINE);
    let (place, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let at_s = line.at.since(line.first).as_secs_f64();
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Slider, true, look.tr(recordings::LINE));
        info.value = Some(at_s);
        info
    });
    let length = line.last.since(line.first);
    if let Some(pointer) = dragged_to(ui, &response) {
        let here = moment(line, length, share(place, pointer.x));
        let begun = ui.input(|input| {
            let origin = input.pointer.press_origin();
            origin.filter(|_| input.modifiers.shift)
        });
        match begun {
            Some(origin) => {
                let from = moment(line, length, share(place, origin.x));
                recording(pane, RecordingAction::Loop(Some((from, here))));
            }
            None => recording(pane, RecordingAction::Seek(here)),
        }
    }
    paint(ui, look, place, line);
    if let Some(pointer) = response.hover_pos() {
        let here = moment(line, length, share(place, pointer.x));
        let away = |entry: &TimelineEntry<'_>| (x_of(place, line, entry.at) - pointer.x).abs();
        let near = entries(look, line).filter(|entry| away(entry) < theme::STEP);
        let near = near.min_by(|one, other| away(one).total_cmp(&away(other)));
        let clock = clock(here.since(line.first));
        let words = near.map(|entry| entry.text(look));
        let words = words.unwrap_or_else(|| look.tip(recordings::LINE).to_owned());
        response.on_hover_text(format!("{clock}\n{words}"));
    }
}

/// Position to which the user drags, or at which the button was released. In a slow frame the pointer may have moved since then.
fn dragged_to(ui: &Ui, response: &Response) -> Option<Pos2> {
    let now = response.interact_pointer_pos()?;
    let released = ui.input(|input| {
        input.events.iter().find_map(|event| match event {
            Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed: false,
                ..
            } => Some(*pos),
            _ => None,
        })
    });
    Some(released.unwrap_or(now))
}

fn paint(ui: &Ui, look: Look, place: Rect, line: &Timeline) {
    let (painter, palette) = (ui.painter_at(place.expand(theme::STEP)), look.palette);
    painter.rect_filled(place, theme::ROUND_SMALL, palette.sunken);
    if let Some((from, to)) = line.looped {
        let xs = x_of(place, line, from)..=x_of(place, line, to);
        let stretch = Rect::from_x_y_ranges(xs, place.y_range());
        painter.rect_filled(stretch, 0.0, palette.accent.gamma_multiply(0.2));
    }
    let inner = place.shrink2(vec2(0.0, theme::STEP));
    strip::strip(&painter, look, inner, &line.strip);
    for (column, (_, color)) in columns(look, place, line) {
        #[expect(clippy::cast_precision_loss, reason = "a column of a screen")]
        let x = column as f32;
        painter.vline(x, place.y_range(), Stroke::new(1.0, color));
        painter.circle_filled(pos2(x, place.top() + theme::BAR), theme::BAR, color);
    }
    let x = x_of(place, line, line.at);
    let color = if line.waits {
        palette.faint
    } else {
        palette.text
    };
    painter.vline(x, place.y_range(), Stroke::new(theme::STRONG, color));
    painter.circle_filled(pos2(x, place.bottom() - theme::LAMP), theme::LAMP, color);
}

fn share(place: Rect, x: f32) -> f32 {
    ((x - place.left()) / place.width().max(1.0)).clamp(0.0, 1.0)
}

fn moment(line: &Timeline, length: Duration, share: f32) -> Moment {
    line.first.plus(length.mul_f64(f64::from(share)))
}

fn x_of(place: Rect, line: &Timeline, at: Moment) -> f32 {
    let length = line.last.since(line.first).as_secs_f32().max(1e-3);
    place.left() + at.since(line.first).as_secs_f32() / length * place.width()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::file::FileMark;
    use std::path::PathBuf;
    use std::sync::Arc;

    #[test]
    fn each_of_thousands_of_marks_is_drawn_and_no_column_twice() {
        let look = Look::of(&crate::app::state::State::default());
        let at = |second: u64| Moment::from_micros(second * 1_000_000);
        let mark = |second, kind| FileMark {
            at: at(second),
            kind,
            words: String::new(),
        };
        // Trials in the first half, and far behind them a fault at the same second as a trial.
        let mut marks: Vec<FileMark> = (0..5000).map(|nth| mark(nth, EventKind::Trial)).collect();
        marks.extend([mark(9000, EventKind::Trial), mark(9000, EventKind::Fault)]);
        let line = Timeline {
            path: PathBuf::new(),
            title: String::new(),
            began: String::new(),
            hand: String::new(),
            first: at(0),
            last: at(10_000),
            at: at(0),
            runs: false,
            pace: 1.0,
            looped: None,
            marks: Arc::new(marks),
            notes: Arc::default(),
            strip: Arc::default(),
            waits: false,
            damaged: false,
            live_needs_eyes: false,
        };
        let place = Rect::from_min_size(pos2(100.0, 0.0), vec2(1000.0, LINE));
        let drawn = columns(look, place, &line);
        assert_eq!(
            drawn.len(),
            502,
            "500 columns of the first half, its end, and the fault"
        );
        assert_eq!(drawn[&1000].1, look.palette.bad);
        assert_eq!(entries(look, &line).count(), 5002);
    }
}
