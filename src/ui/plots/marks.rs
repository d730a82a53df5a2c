//! What happened, as lines across the plots with their words. Knows no curve.

use crate::history::{Mark, MarkKind};
use crate::ui::kit::controls;
use crate::ui::kit::look::Pane;
use crate::ui::plots::axes as plot_axes;
use crate::ui::plots::sight::Span;
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::{Align2, Color32, CornerRadius, Painter, Rect, Stroke, Ui, pos2, vec2};

/// Characters of a note beside its line; the rest is in the tooltip.
const NOTE_SHOWN: usize = 24;

/// The lines.
pub(crate) fn lines_ui(painter: &Painter, rect: Rect, pane: &Pane<'_>, span: Span) {
    for mark in pane.state.hand().history.marks(span.0, span.1) {
        let (_, color) = mark_look(pane, &mark.kind);
        let x = plot_axes::x_of(rect, span, mark.at.secs());
        painter.vline(x, rect.y_range(), Stroke::new(1.0, color));
    }
}

/// The words of the marks, once, in the topmost plot. Words that would overlap are left out.
pub(crate) fn words_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, span: Span) {
    let mut free_from = rect.left();
    for mark in pane.state.hand().history.marks(span.0, span.1) {
        let (_, color) = mark_look(pane, &mark.kind);
        let text: String = mark_text(pane, mark).chars().take(NOTE_SHOWN).collect();
        let x = plot_axes::x_of(rect, span, mark.at.secs());
        let width = controls::text_width(ui, &text, theme::small()) + 1.0;
        let flipped = x + width + theme::MARK_MARGIN > rect.right();
        let left = if flipped {
            x - width - theme::STEP
        } else {
            x + theme::STEP
        };
        if left < free_from {
            continue;
        }
        let place = Rect::from_min_size(
            pos2(left, rect.top() + 2.0),
            vec2(width, theme::MESSAGE_LINE),
        );
        let ground = pane.look.palette.sunken.gamma_multiply(0.8);
        let round = CornerRadius::same(2);
        ui.painter()
            .rect_filled(place.expand2(vec2(2.0, 0.0)), round, ground);
        let (font, align) = (theme::small(), Align2::LEFT_CENTER);
        controls::paint_text(ui, place, align, &text, font, color);
        free_from = left + width + theme::GAP;
    }
}

fn mark_look(pane: &Pane<'_>, kind: &MarkKind) -> (Text, Color32) {
    let palette = pane.look.palette;
    match kind {
        MarkKind::Armed => (panels::MARK_ARMED, palette.armed),
        MarkKind::Stop => (panels::MARK_STOP, palette.bad),
        MarkKind::StopNotSent => (panels::MARK_STOP_NOT_SENT, palette.bad),
        MarkKind::HoldConfirmed => (panels::MARK_HELD, palette.ok),
        MarkKind::Fault => (panels::MARK_FAULT, palette.warn),
        MarkKind::LinkLost => (panels::MARK_LOST, palette.bad),
        MarkKind::Reconnected => (panels::MARK_RECONNECT, palette.ok),
        MarkKind::Gesture(_) => (panels::MARK_GESTURE, palette.accent),
        MarkKind::Note(_) => (panels::MARK_NOTE, palette.text),
    }
}

fn mark_text(pane: &Pane<'_>, mark: &Mark) -> String {
    let text = pane.look.say(mark_look(pane, &mark.kind).0);
    match &mark.kind {
        MarkKind::Gesture(number) => format!("{text} {number}"),
        MarkKind::Note(words) => words.to_string(),
        _ => text.to_owned(),
    }
}

/// What happened where the pointer is, a line each.
pub(crate) fn near(pane: &Pane<'_>, ground: Rect, span: Span, x: f32) -> String {
    /// A line is easily missed by some pixels.
    const NEAR: f32 = theme::STEP;
    let (from, to) = (
        plot_axes::time_of(ground, span, x - NEAR),
        plot_axes::time_of(ground, span, x + NEAR),
    );
    let lines = pane.state.hand().history.marks(from, to).map(|mark| {
        let at = plot_axes::clock(mark.at.secs(), span.1 - span.0);
        format!("{at}  {}", mark_text(pane, mark))
    });
    lines.collect::<Vec<_>>().join("\n")
}
