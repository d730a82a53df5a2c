//! What happened, as lines across the plots with their words. Knows no curve.

use crate::history::{Mark, MarkKind};
use crate::ui::kit::{self, Label, Look, Pane};
use crate::ui::plots::chart::{ChartResponse, pointed_s};
use crate::ui::plots::times::clock;
use crate::ui::text::panels;
use crate::ui::theme;
use egui::{Color32, Rect, Ui, pos2, vec2};

/// Characters of a note beside its line; the rest is in the tooltip.
const NOTE_SHOWN: usize = 24;

/// The lines.
pub(crate) fn moments(pane: &Pane<'_>, (from_s, to_s): (f64, f64)) -> Vec<(f64, Color32)> {
    let marks = pane.state.hand().measured.history.marks(from_s, to_s);
    let moment = |mark: &Mark| (mark.at.secs(), told(pane.look, &mark.kind).1);
    marks.map(moment).collect()
}

/// The words of the marks, once, in the topmost plot. Words that would overlap are left out.
pub(crate) fn words_ui(ui: &Ui, pane: &Pane<'_>, shown: &ChartResponse) {
    let rect = *shown.transform.frame();
    let (from_s, to_s) = shown.transform.bounds().range_x().into_inner();
    let mut free_from = rect.left();
    for mark in pane.state.hand().measured.history.marks(from_s, to_s) {
        let x = shown.transform.position_from_point_x(mark.at.secs());
        if x < free_from {
            continue;
        }
        let (text, color) = told(pane.look, &mark.kind);
        let text: String = text.chars().take(NOTE_SHOWN).collect();
        let size = vec2(
            kit::text_width(ui, &text, theme::small()) + 1.0,
            theme::TEXT_LINE,
        );
        let right = x + size.x + theme::GAP <= rect.right();
        let left = if right {
            x + theme::STEP
        } else {
            x - size.x - theme::STEP
        };
        if left < free_from {
            continue;
        }
        let place = Rect::from_min_size(pos2(left, rect.top() + 2.0), size);
        let ground = pane.look.palette.sunken.gamma_multiply(0.8);
        ui.painter()
            .rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, ground);
        Label::new(&text, color).small().paint(ui, place);
        free_from = left + size.x + theme::GAP;
    }
}

/// What a mark says, and its colour.
pub(crate) fn told(look: Look, kind: &MarkKind) -> (String, Color32) {
    let palette = look.palette;
    let (text, color) = match kind {
        MarkKind::Armed => (panels::MARK_ARMED, palette.armed),
        MarkKind::Stop => (panels::MARK_STOP, palette.bad),
        MarkKind::StopNotSent => (panels::MARK_STOP_NOT_SENT, palette.bad),
        MarkKind::HoldConfirmed => (panels::MARK_HELD, palette.ok),
        MarkKind::Fault => (panels::MARK_FAULT, palette.warn),
        MarkKind::LinkLost => (panels::MARK_LOST, palette.bad),
        MarkKind::Reconnected => (panels::MARK_RECONNECT, palette.ok),
        MarkKind::Gesture(number) => {
            let text = look.told(panels::GESTURE, number);
            return (text, palette.accent);
        }
        MarkKind::Note(words) => return (words.to_string(), palette.text),
    };
    (look.say(text).to_owned(), color)
}

/// What happened where the pointer is, a line each.
pub(crate) fn near(pane: &Pane<'_>, shown: &ChartResponse) -> Option<String> {
    let at_s = pointed_s(shown)?;
    // A line is easily missed by some pixels.
    let per_point = shown.transform.dvalue_dpos()[0];
    let by_s = f64::from(theme::STEP) * per_point;
    let marks = pane
        .state
        .hand()
        .measured
        .history
        .marks(at_s - by_s, at_s + by_s);
    let lines = marks.map(|mark| {
        let at = clock(mark.at.secs(), per_point);
        format!("{at}  {}", told(pane.look, &mark.kind).0)
    });
    let lines: Vec<String> = lines.collect();
    (!lines.is_empty()).then(|| lines.join("\n"))
}
