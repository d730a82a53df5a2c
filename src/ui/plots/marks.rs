//! Events as vertical lines with labels in the plots. Independent of the curves.

use crate::history::{Mark, MarkKind};
use crate::ui::kit::{self, Label, Look, Pane};
use crate::ui::plots::chart::{ChartResponse, pointed_s};
use crate::ui::plots::time_window::TimeSpan;
use crate::ui::plots::times::clock;
use crate::ui::text::{hold, notices, panels};
use crate::ui::theme;
use egui::{Color32, Rect, Ui, pos2, vec2};

/// Characters of a note shown beside its line; the tooltip has the rest.
const NOTE_SHOWN: usize = 24;

/// Times and colours of the lines.
pub(crate) fn moments(pane: &Pane<'_>, (from_s, to_s): TimeSpan) -> Vec<(f64, Color32)> {
    let marks = pane.hand().measured.history.marks(from_s, to_s);
    let moment = |mark: &Mark| (mark.at.secs(), mark_text(pane.look, &mark.kind).1);
    marks.map(moment).collect()
}

/// Label beside a line: the newest of several that have no space of their own, with the number of the others.
struct MarkWords {
    x: f32,
    text: String,
    color: Color32,
    more: usize,
}

/// Draws the labels of the marks, in the topmost plot only. Overlapping labels are merged.
pub(crate) fn words_ui(ui: &Ui, pane: &Pane<'_>, shown: &ChartResponse) {
    let rect = *shown.transform.frame();
    let (from_s, to_s) = shown.transform.bounds().range_x().into_inner();
    let marks = pane.hand().measured.history.marks(from_s, to_s);
    let words = marks.map(|mark| {
        let x = shown.transform.position_from_point_x(mark.at.secs());
        let (text, color) = mark_text(pane.look, &mark.kind);
        MarkWords {
            x,
            text: text.chars().take(NOTE_SHOWN).collect(),
            color,
            more: 0,
        }
    });
    let width = |text: &str| kit::text_width(ui, text, theme::small());
    for words in joined(words.collect(), rect.right(), width) {
        words.ui(ui, pane.look, rect);
    }
}

/// Returns the labels that fit, from newest to oldest; the others are counted with the next newer one.
fn joined(mut marks: Vec<MarkWords>, right: f32, width: impl Fn(&str) -> f32) -> Vec<MarkWords> {
    marks.reverse();
    let more = width(" +99");
    let mut free_until = right;
    let mut all: Vec<MarkWords> = Vec::new();
    for words in marks {
        let (x, width) = (words.x, width(&words.text) + more);
        let fits = x + theme::STEP + width + theme::GAP <= free_until;
        match all.last_mut().filter(|_| !fits) {
            Some(newer) => newer.more += 1,
            None => {
                // The newest label is to the left of its line if it does not fit on the right.
                free_until = if fits { x } else { x - width - theme::GAP };
                all.push(words);
            }
        }
    }
    all
}

impl MarkWords {
    fn ui(&self, ui: &Ui, look: Look, rect: Rect) {
        let text = match self.more {
            0 => self.text.clone(),
            more => format!("{} +{more}", self.text),
        };
        let width = kit::text_width(ui, &text, theme::small()) + 1.0;
        let size = vec2(width, theme::TEXT_LINE);
        let is_right = self.x + theme::STEP + width <= rect.right();
        let left = if is_right {
            self.x + theme::STEP
        } else {
            self.x - width - theme::STEP
        };
        let place = Rect::from_min_size(pos2(left, rect.top() + 2.0), size);
        let ground = look.palette.sunken.gamma_multiply(0.8);
        ui.painter()
            .rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, ground);
        Label::new(&text, self.color).small().paint(ui, place);
    }
}

/// Text and colour of a mark.
pub(crate) fn mark_text(look: Look, kind: &MarkKind) -> (String, Color32) {
    let palette = look.palette;
    let (text, color) = match kind {
        MarkKind::Armed => (panels::MARK_ARMED, palette.armed),
        MarkKind::Stop => (panels::MARK_STOP, palette.bad),
        MarkKind::StopNotSent => (panels::MARK_STOP_NOT_SENT, palette.bad),
        MarkKind::HoldConfirmed => (panels::MARK_HELD, palette.ok),
        MarkKind::Fault(words) => return (notices::fault_mark(look, words), palette.warn),
        MarkKind::LinkLost => (panels::MARK_LOST, palette.bad),
        MarkKind::Reconnected => (panels::MARK_RECONNECT, palette.ok),
        MarkKind::Gesture(number) => {
            let text = look.tr_with(panels::GESTURE, number);
            return (text, palette.accent);
        }
        MarkKind::Tightened(tightened) => {
            return (hold::tightened(look, *tightened), palette.accent);
        }
        MarkKind::Note(words) => return (words.to_string(), palette.text),
    };
    (look.tr(text).to_owned(), color)
}

/// Events near the pointer, one per line.
pub(crate) fn near(pane: &Pane<'_>, shown: &ChartResponse) -> Option<String> {
    let at_s = pointed_s(shown)?;
    // Tolerance, because a line is easily missed by a few pixels.
    let per_point = shown.transform.dvalue_dpos()[0];
    let by_s = f64::from(theme::STEP) * per_point;
    let history = &pane.hand().measured.history;
    let marks = history.marks(at_s - by_s, at_s + by_s);
    let lines = marks.map(|mark| {
        let at = clock(mark.at.secs(), per_point);
        format!("{at}  {}", mark_text(pane.look, &mark.kind).0)
    });
    let lines: Vec<String> = lines.collect();
    (!lines.is_empty()).then(|| lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crowded_marks_are_counted_with_the_newest_and_none_is_lost() {
        let mark = |x: f32, text: &str| MarkWords {
            x,
            text: text.into(),
            color: Color32::WHITE,
            more: 0,
        };
        // Ten points per letter.
        let width = |text: &str| text.chars().map(|_| 10.0).sum();
        let check = |marks: &[(f32, &str)], wanted: &[(&str, usize)]| {
            let marks = marks.iter().map(|(x, text)| mark(*x, text));
            let all = joined(marks.collect(), 500.0, width);
            let shown: Vec<_> = all
                .iter()
                .map(|one| (one.text.as_str(), one.more))
                .collect();
            assert_eq!(shown, wanted);
        };
        check(
            &[(100.0, "stop"), (300.0, "armed")],
            &[("armed", 0), ("stop", 0)],
        );
        check(
            &[(300.0, "a"), (310.0, "b"), (320.0, "c"), (330.0, "d")],
            &[("d", 3)],
        );
        // The newest label is to the left of its line, covering the lines there.
        check(
            &[(100.0, "far"), (450.0, "near"), (495.0, "newest")],
            &[("newest", 1), ("far", 0)],
        );
    }
}
