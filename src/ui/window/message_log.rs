//! The log of messages: filtered by words, of which the level is one, and copied as text. Its lines are measured once and not for each frame.

use crate::app::notices::{Level, Notice};
use crate::app::settings::Language;
use crate::hand::Moment;
use crate::ui::kit::{self, Button, Label, Look, Pane, format};
use crate::ui::text::{Text, faults, notices};
use crate::ui::theme;
use egui::{Align, Color32, Layout, Ui};
use egui_extras::{Column, TableBuilder};
use std::fmt::Write as _;

/// Room for the lamp and for the age of a message.
const LAMP: f32 = 12.0;
const AGE: f32 = 52.0;

/// What decides which lines there are and how high.
#[derive(Debug, Clone, PartialEq)]
struct LogKey {
    newest: Option<(u64, Moment)>,
    language: Language,
    words: String,
    width: f32,
}

/// One message, ready to draw.
#[derive(Debug)]
struct LogLine {
    at: Moment,
    level: Level,
    text: String,
    height: f32,
}

/// What the log needs between frames.
#[derive(Debug, Default)]
pub(crate) struct MessageLog {
    /// Messages of less weight are left out.
    words: String,
    key: Option<LogKey>,
    lines: Vec<LogLine>,
    /// Lines that were copied last, until the list changes.
    copied: Option<usize>,
}

const fn level_word(level: Level) -> Text {
    match level {
        Level::Info => faults::WORD_INFO,
        Level::Warn => faults::WORD_WARN,
        Level::Alarm => faults::WORD_ALARM,
    }
}

impl MessageLog {
    /// Draws the tools and the list.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        ui.horizontal(|ui| kit::right_ui(ui, |ui| self.tools_ui(ui, look)));
        self.update(ui, pane);
        if !self.lines.is_empty() {
            self.lines_ui(ui, pane);
            return;
        }
        let text = match pane.state.notices.log().next() {
            Some(_) => faults::LOG_NONE_PASS,
            None => faults::LOG_NONE,
        };
        Label::muted(look, text).ui(ui);
    }

    /// Copying, and words to look for.
    fn tools_ui(&mut self, ui: &mut Ui, look: Look) {
        let text = match self.copied {
            None => look.say(faults::COPY).to_owned(),
            Some(lines) => format!("{} ({lines})", look.say(faults::COPIED)),
        };
        let name = look.pair(look.say(faults::COPY), look.say(faults::LOG));
        let copy = Button::new(&text, look.tip(faults::COPY)).named(&name);
        let copy = copy.disabled_if(self.lines.is_empty(), look.say(faults::LOG_NONE));
        if copy.ui(ui, look).clicked() {
            ui.ctx().copy_text(self.text(look));
            self.copied = Some(self.lines.len());
        }
        kit::edit_ui(ui, look.both(faults::LOG_FILTER), &mut self.words);
    }

    /// Measures the lines anew if anything about them has changed.
    fn update(&mut self, ui: &Ui, pane: &Pane<'_>) {
        let log = &pane.state.notices;
        let key = LogKey {
            newest: log.log().next().map(|newest| (newest.id, newest.at)),
            language: pane.look.language,
            words: self.words.trim().to_lowercase(),
            width: ui.available_width() - LAMP - AGE - 3.0 * theme::GAP,
        };
        if self.key.as_ref() == Some(&key) {
            return;
        }
        self.copied = None;
        let line = |notice: &Notice| LogLine {
            at: notice.at,
            level: notice.level,
            text: words(pane.look, notice),
            height: 0.0,
        };
        self.lines = log.log().map(line).collect();
        self.lines.retain(|line| {
            let level = pane.look.say(level_word(line.level));
            let said = format!("{level} {}", line.text);
            said.to_lowercase().contains(&key.words)
        });
        for line in &mut self.lines {
            let (text, ink) = (line.text.clone(), Color32::PLACEHOLDER);
            let galley = ui.painter().layout(text, theme::small(), ink, key.width);
            line.height = galley.size().y + 4.0;
        }
        self.key = Some(key);
    }

    fn lines_ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let lost = pane.state.notices.log_dropped();
        if lost > 0 {
            let text = look.told(faults::LOG_LOST, lost);
            Label::new(&text, look.palette.muted).small().ui(ui);
        }
        ui.spacing_mut().item_spacing.y = 0.0;
        let room = self.key.as_ref().map_or(0.0, |key| key.width);
        let table = TableBuilder::new(ui)
            .cell_layout(Layout::left_to_right(Align::TOP))
            .auto_shrink(false)
            .column(Column::exact(LAMP))
            .column(Column::exact(room))
            .column(Column::exact(AGE));
        let heights = self.lines.iter().map(|line| line.height);
        table.body(|body| {
            body.heterogeneous_rows(heights, |mut row| {
                let Some(line) = self.lines.get(row.index()) else {
                    return;
                };
                row.col(|ui| {
                    kit::lamp_ui(ui, Some(look.level(line.level)));
                });
                row.col(|ui| {
                    let label = Label::new(&line.text, look.palette.text);
                    label.small().wrap().ui(ui);
                });
                row.col(|ui| {
                    let age = format::age(pane.state.now.since(line.at));
                    let right = Layout::right_to_left(Align::TOP);
                    let label = Label::new(&age, look.palette.muted).small();
                    ui.with_layout(right, |ui| label.ui(ui));
                });
            });
        });
    }

    /// The listed messages as text, a line each, newest first.
    fn text(&self, look: Look) -> String {
        let mut text = String::new();
        for line in &self.lines {
            let level = look.say(level_word(line.level));
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
