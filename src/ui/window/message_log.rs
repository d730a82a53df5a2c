//! The log of messages: filtered by level and words, copied as text. Its lines are laid out once and not for each frame.

use crate::app::notices::{Level, Notice};
use crate::app::settings::Language;
use crate::hand::Moment;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::list::{INDENT, LAMP_AT, line_ui, scroll_ui};
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::{Text, faults, notices};
use crate::ui::theme;
use egui::{Color32, Id, Rect, TextEdit, Ui, pos2, vec2};
use std::fmt::Write as _;

/// Most signs of a filter.
const FILTER_MAX: usize = 64;

/// What decides which lines there are and where.
#[derive(Debug, Clone, PartialEq)]
struct Key {
    newest: Option<(u64, Moment)>,
    language: Language,
    least: Option<Level>,
    words: String,
    width: f32,
}

/// One message, ready to draw.
#[derive(Debug)]
struct Line {
    at: Moment,
    level: Level,
    text: String,
    top: f32,
    height: f32,
}

/// What the log needs between frames.
#[derive(Debug, Default)]
pub(crate) struct MessageLog {
    /// Messages of less weight are left out.
    least: Option<Level>,
    words: String,
    key: Option<Key>,
    lines: Vec<Line>,
    /// Lines that were copied last, until the list changes.
    copied: Option<usize>,
}

/// A level's word and colour.
fn level_look(look: Look, level: Level) -> (Text, Color32) {
    match level {
        Level::Info => (faults::WORD_INFO, look.palette.accent),
        Level::Warn => (faults::WORD_WARN, look.palette.warn),
        Level::Alarm => (faults::WORD_ALARM, look.palette.bad),
    }
}

impl MessageLog {
    /// Draws the tools and the list.
    pub(crate) fn ui(&mut self, ui: &mut Ui, mut rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let left = self.tools_ui(ui, take_top(&mut rect, theme::CONTROL), look);
        let field = if left.width() < theme::MESSAGE_FIELD {
            take_top(&mut rect, theme::CONTROL)
        } else {
            left
        };
        filter_ui(ui, field, look, &mut self.words);
        self.update(ui, rect.width() - theme::GAP, pane);
        if self.lines.is_empty() {
            let any = pane.state.notices.log().next().is_some();
            let text = if any {
                faults::LOG_NONE_PASS
            } else {
                faults::LOG_NONE
            };
            let place = take_top(&mut rect, theme::CONTROL);
            Label::new(look.say(text), look.palette.faint).put(ui, place);
            return;
        }
        self.lines_ui(ui, rect, pane);
    }

    /// Levels and copying; the room that is left in the row.
    fn tools_ui(&mut self, ui: &mut Ui, mut row: Rect, look: Look) -> Rect {
        let (text, name) = match self.copied {
            None => (look.say(faults::COPY).to_owned(), look.say(faults::COPY)),
            Some(lines) => (
                format!("{} ({lines})", look.say(faults::COPIED)),
                look.say(faults::COPY),
            ),
        };
        let wide = controls::text_width(ui, &text, theme::body()) + 2.0 * theme::GAP;
        let name = format!("{name}: {}", look.say(faults::LOG));
        let none = self.lines.is_empty().then(|| look.say(faults::LOG_NONE));
        let copy = Button::new(&text, look.say(faults::COPY_TIP)).named(&name);
        let place = take_right(&mut row, wide);
        let id = Id::unique("copy messages");
        if copy.disabled(none).put(ui, look, place, id).clicked() {
            ui.ctx().copy_text(self.text(look));
            self.copied = Some(self.lines.len());
        }
        for (text, least) in [
            (faults::LEVEL_ALL, None),
            (faults::LEVEL_WARN, Some(Level::Warn)),
            (faults::LEVEL_ALARM, Some(Level::Alarm)),
        ] {
            let text = look.say(text);
            let wide = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
            let name = format!("{}: {text}", look.say(faults::LEVEL));
            let button = Button::new(text, look.say(faults::LEVEL_TIP)).named(&name);
            let place = take_left(&mut row, wide);
            row.min.x -= theme::STEP;
            let button = button.choice(self.least == least);
            let id = Id::unique(("message level", least));
            if button.put(ui, look, place, id).clicked() {
                self.least = least;
            }
        }
        row.with_min_x(row.left() + theme::STEP)
    }

    /// Lays the lines out anew if anything about them has changed.
    fn update(&mut self, ui: &Ui, width: f32, pane: &Pane<'_>) {
        let log = &pane.state.notices;
        let key = Key {
            newest: log.log().next().map(|newest| (newest.id, newest.at)),
            language: pane.look.language,
            least: self.least,
            words: self.words.trim().to_lowercase(),
            width,
        };
        if self.key.as_ref() == Some(&key) {
            return;
        }
        self.copied = None;
        self.lines.clear();
        let mut top = 0.0;
        for notice in log
            .log()
            .filter(|one| key.least.is_none_or(|least| one.level >= least))
        {
            let text = words(pane.look, notice);
            if !text.to_lowercase().contains(&key.words) {
                continue;
            }
            let ink = Color32::PLACEHOLDER;
            let room = width - INDENT - theme::MESSAGE_AGE - theme::GAP;
            let galley = ui.painter().layout(text.clone(), theme::small(), ink, room);
            let height = galley.size().y + 2.0 * theme::MESSAGE_AIR;
            self.lines.push(Line {
                at: notice.at,
                level: notice.level,
                text,
                top,
                height,
            });
            top += height;
        }
        self.key = Some(key);
    }

    fn lines_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let lost = pane.state.notices.log_dropped();
        let total = self.lines.last().map_or(0.0, |last| last.top + last.height);
        scroll_ui(ui, rect, "messages", |ui, width| {
            let place = ui.allocate_space(vec2(width, total)).1;
            let seen = ui.clip_rect();
            for line in &self.lines {
                let top = place.top() + line.top;
                if top > seen.bottom() || top + line.height < seen.top() {
                    continue;
                }
                let row = Rect::from_min_size(pos2(place.left(), top), vec2(width, line.height));
                line_of(ui, row, pane, line);
            }
            if lost > 0 {
                let text = format!("{} {lost}", look.say(faults::LOG_LOST));
                line_ui(ui, width, &text, look.palette.faint);
            }
        });
    }

    /// The listed messages as text, a line each, newest first.
    fn text(&self, look: Look) -> String {
        let mut text = String::new();
        for line in &self.lines {
            let level = look.say(level_look(look, line.level).0);
            // Writing to a string cannot fail.
            let _done = writeln!(text, "{:10.3} s  {level}  {}", line.at.secs(), line.text);
        }
        text
    }
}

/// A message with how often it came.
fn words(look: Look, notice: &Notice) -> String {
    let text = notices::notice(look, &notice.what);
    if notice.count > 1 {
        return format!("{text} ({} ×)", notice.count);
    }
    text
}

fn line_of(ui: &mut Ui, mut row: Rect, pane: &Pane<'_>, line: &Line) {
    let look = pane.look;
    let (_, color) = level_look(look, line.level);
    let first = row.top() + theme::MESSAGE_AIR + theme::MESSAGE_FIRST;
    controls::lamp(ui, pos2(row.left() + LAMP_AT, first), color);
    let age = format::age(pane.state.now.since(line.at));
    let mut place = take_right(&mut row, theme::MESSAGE_AGE);
    place.max.y = place.top() + 2.0 * theme::MESSAGE_AIR + theme::MESSAGE_LINE;
    let faint = look.palette.faint;
    Label::new(&age, faint).small().right().put(ui, place);
    let id = ui.next_auto_id();
    ui.skip_ahead_auto_ids(1);
    let response = ui.interact(row, id, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &line.text));
    let ink = look.palette.text;
    let room = row.width() - INDENT;
    let galley = ui
        .painter()
        .layout(line.text.clone(), theme::small(), ink, room);
    let at = pos2(row.left() + INDENT, row.top() + theme::MESSAGE_AIR);
    ui.painter().galley(at, galley, ink);
}

fn filter_ui(ui: &mut Ui, rect: Rect, look: Look, text: &mut String) {
    let edit = TextEdit::singleline(text)
        .id(Id::unique("message filter"))
        .font(theme::small())
        .hint_text(look.say(faults::LOG_FILTER_HINT))
        .char_limit(FILTER_MAX)
        .clip_text(true)
        .align(egui::Align2::LEFT_CENTER)
        .margin(theme::FIELD_INSET_LOW)
        .min_size(rect.size())
        .desired_width(rect.width() - theme::FIELD_MARGIN);
    let response = ui.put(rect, edit);
    let value = text.clone();
    response.widget_info(|| {
        let name = look.say(faults::LOG_FILTER);
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, name);
        info.current_text_value = Some(value.clone());
        info
    });
}
