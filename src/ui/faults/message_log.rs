//! Messages as rows, and the log of all of them: filtered by words, including the level, and copied as text.

use crate::app::notices::Notice;
use crate::ui::kit::{self, Button, Label, Look, Pane, format};
use crate::ui::text::notices;
use egui::{Align, Layout, ScrollArea, Ui};
use std::fmt::Write as _;

/// Maximum number of rows drawn: older ones are found with the filter, and copied.
const DRAWN_MAX: usize = 200;

/// View state of the log.
#[derive(Debug, Default)]
pub(crate) struct MessageLog {
    words: String,
    /// Newest message at the last copy, and the number of lines copied.
    copied: Option<(Option<u64>, usize)>,
}

impl MessageLog {
    /// Draws the tools and the list.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ui.horizontal(|ui| kit::right_ui(ui, |ui| self.tools_ui(ui, pane)));
        let lost = pane.state.notices.log_dropped();
        if lost > 0 {
            let text = look.tr_with(notices::LOG_LOST, lost);
            Label::new(&text, look.palette.muted).small().ui(ui);
        }
        let shown: Vec<_> = self.passing(pane).take(DRAWN_MAX + 1).collect();
        if shown.is_empty() {
            let text = match pane.state.notices.log().next() {
                Some(_) => notices::LOG_NONE_PASS,
                None => notices::LOG_NONE,
            };
            Label::muted(look, text).ui(ui);
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for (notice, _) in shown.iter().take(DRAWN_MAX) {
                message_ui(ui, pane, notice, |_, _, _| ());
            }
            if shown.len() > DRAWN_MAX {
                Label::note(look, notices::LOG_MORE).wrap().ui(ui);
            }
        });
    }

    fn tools_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let newest = pane.state.notices.log().next().map(|newest| newest.id);
        let copied = self.copied.filter(|(at, _)| *at == newest);
        let text = match copied {
            None => look.tr(notices::COPY).to_owned(),
            Some((_, lines)) => format!("{} ({lines})", look.tr(notices::COPIED)),
        };
        let name = look.pair(look.tr(notices::COPY), look.tr(notices::LOG));
        let none = self.passing(pane).next().is_none();
        let copy = Button::new(&text, look.tip(notices::COPY)).named(&name);
        let copy = copy.disabled_if(none, look.tr(notices::LOG_NONE));
        if copy.ui(ui, look).clicked() {
            let mut text = String::new();
            for (notice, line) in self.passing(pane) {
                // Writing to a string cannot fail.
                let _done = writeln!(text, "{:10.3} s  {line}", notice.at.secs());
            }
            self.copied = Some((newest, text.lines().count()));
            ui.ctx().copy_text(text);
        }
        kit::translated_edit_ui(ui, look, notices::LOG_FILTER, &mut self.words);
    }

    /// Messages that contain the filter words, each with its level and text in a line, newest first.
    fn passing<'a>(&self, pane: &Pane<'a>) -> impl Iterator<Item = (&'a Notice, String)> + use<'a> {
        let (look, wanted) = (pane.look, self.words.trim().to_lowercase());
        let lines = pane.state.notices.log().map(move |notice| {
            let level = look.tr(notices::level(notice.level));
            (notice, format!("{level}  {}", words(look, notice)))
        });
        lines.filter(move |(_, line)| line.to_lowercase().contains(&wanted))
    }
}

/// Draws a message as a row: lamp, text, age, and the content of `end` at the right.
pub(crate) fn message_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    notice: &Notice,
    end: impl FnOnce(&mut Ui, &mut Pane<'_>, &str),
) {
    let look = pane.look;
    let text = words(look, notice);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::TOP), |ui| {
            end(ui, pane, &text);
            let age = format::age(pane.state.now.since(notice.at));
            Label::new(&age, look.palette.muted).small().ui(ui);
            ui.with_layout(Layout::left_to_right(Align::TOP), |ui| {
                kit::lamp_ui(ui, Some(look.level(notice.level)));
                kit::small_text_ui(ui, &text, look.palette.text);
            });
        });
    });
}

/// Text of a message with its count.
fn words(look: Look, notice: &Notice) -> String {
    let text = notices::notice_of(look, notice);
    match notice.count {
        0 | 1 => text,
        count => format!("{text} ({count} ×)"),
    }
}
