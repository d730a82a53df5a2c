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
const NOTE_SHOWN: usize = 28;

/// Times and colours of the lines.
pub(crate) fn moments(pane: &Pane<'_>, (from_s, to_s): TimeSpan) -> Vec<(f64, Color32)> {
    let marks = pane.hand().measured.history.marks(from_s, to_s);
    let moment = |mark: &Mark| (mark.at.secs(), mark_text(pane.look, &mark.kind).1);
    marks.map(moment).collect()
}

/// Rows for labels at the top of the plot.
const ROWS: usize = 2;

/// Label of a line.
struct MarkWords {
    /// Position of the line.
    x: f32,
    text: String,
    color: Color32,
    /// Labels with a lower rank are placed first.
    rank: u8,
}

/// Draws the labels of the marks, in the topmost plot only: the worst first, each where it covers no other one. A mark without
/// space for its label has it in the tooltip of its line.
pub(crate) fn words_ui(ui: &Ui, pane: &Pane<'_>, shown: &ChartResponse) {
    let rect = *shown.transform.frame();
    let (from_s, to_s) = shown.transform.bounds().range_x().into_inner();
    let marks = pane.hand().measured.history.marks(from_s, to_s);
    let words = marks.map(|mark| {
        let x = shown.transform.position_from_point_x(mark.at.secs());
        let (text, color) = mark_text(pane.look, &mark.kind);
        let text = shortened(text);
        let rank = rank(&mark.kind);
        MarkWords {
            x,
            text,
            color,
            rank,
        }
    });
    let width = |text: &str| kit::text_width(ui, text, theme::small());
    let ground = pane.look.palette.sunken.gamma_multiply(0.8);
    for (place, words) in placed(words.collect(), rect, width) {
        ui.painter()
            .rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, ground);
        let label = Label::new(&words.text, words.color).small();
        label.paint(ui, place);
    }
}

/// The text, or its start with an ellipsis if it is too long for a label.
fn shortened(text: String) -> String {
    match text.char_indices().nth(NOTE_SHOWN) {
        Some((cut, _)) => format!("{}\u{2026}", text[..cut].trim_end()),
        None => text,
    }
}

/// How bad an event is, 0 = worst.
const fn rank(kind: &MarkKind) -> u8 {
    match kind {
        MarkKind::StopNotSent | MarkKind::LinkLost => 0,
        MarkKind::Fault(_) | MarkKind::Stop => 1,
        MarkKind::Disarmed | MarkKind::Note(_) => 2,
        MarkKind::Armed | MarkKind::Reconnected | MarkKind::Gesture(_) | MarkKind::Tightened(_) => {
            3
        }
        MarkKind::HoldConfirmed => 4,
    }
}

/// Places the labels within the plot: the worst first, of equal ones the newest first. Each is on the right of its line, else on the
/// left, in the first row with space.
fn placed(
    mut marks: Vec<MarkWords>,
    plot: Rect,
    width: impl Fn(&str) -> f32,
) -> Vec<(Rect, MarkWords)> {
    marks.sort_by(|one, other| (one.rank.cmp(&other.rank)).then(other.x.total_cmp(&one.x)));
    let mut all: Vec<(Rect, MarkWords)> = Vec::new();
    for words in marks {
        let size = vec2(width(&words.text) + 1.0, theme::TEXT_LINE);
        let sides = [words.x + theme::STEP, words.x - theme::STEP - size.x];
        let mut places = sides.into_iter().flat_map(|left| {
            let rows = (0..ROWS).scan(plot.top() + 2.0, move |top, _| {
                let corner = pos2(left, *top);
                *top += size.y;
                Some(Rect::from_min_size(corner, size))
            });
            rows.collect::<Vec<_>>()
        });
        let is_free = |place: &Rect| {
            let room = place.expand2(vec2(theme::STEP, 0.0));
            let is_covered = all
                .iter()
                .any(|(other, _)| room.intersects(other.shrink(0.5)));
            plot.x_range().contains(place.left()) && place.right() <= plot.right() && !is_covered
        };
        if let Some(place) = places.find(is_free) {
            all.push((place, words));
        }
    }
    all
}

/// Text and colour of a mark.
pub(crate) fn mark_text(look: Look, kind: &MarkKind) -> (String, Color32) {
    let palette = look.palette;
    let (text, color) = match kind {
        MarkKind::Armed => (panels::MARK_ARMED, palette.armed),
        MarkKind::Disarmed => (panels::MARK_DISARMED, palette.muted),
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
    fn a_label_that_is_cut_says_so() {
        let whole = "Thumb bend: Current limit";
        assert_eq!(shortened(whole.into()), whole);
        let cut = shortened("A note that is much too long for a label".into());
        assert_eq!(cut, "A note that is much too long\u{2026}");
    }

    #[test]
    fn of_crowded_marks_the_worst_keep_their_labels_and_none_covers_another() {
        // Ten points per letter.
        let width = |text: &str| text.chars().map(|_| 10.0).sum();
        let plot = Rect::from_min_max(pos2(0.0, 0.0), pos2(500.0, 200.0));
        let check = |marks: &[(f32, MarkKind)], wanted: &[&str]| {
            let marks = marks.iter().map(|(x, kind)| MarkWords {
                x: *x,
                text: kind.words(),
                color: Color32::WHITE,
                rank: rank(kind),
            });
            let all = placed(marks.collect(), plot, width);
            for (at, (one, _)) in all.iter().enumerate() {
                assert!(plot.contains_rect(*one));
                let inner = one.shrink(0.5);
                assert!(!all[..at].iter().any(|(other, _)| inner.intersects(*other)));
            }
            let shown: Vec<_> = all.iter().map(|(_, words)| words.text.as_str()).collect();
            assert_eq!(shown, wanted);
        };
        let (lost, again) = (MarkKind::LinkLost, MarkKind::Reconnected);
        check(
            &[(300.0, lost.clone()), (310.0, again.clone())],
            &["link lost", "reconnected"],
        );
        let all = [
            (200.0, MarkKind::Stop),
            (205.0, MarkKind::HoldConfirmed),
            (210.0, MarkKind::HoldConfirmed),
            (215.0, MarkKind::HoldConfirmed),
            (220.0, MarkKind::HoldConfirmed),
        ];
        check(&all, &["stop", "at rest", "at rest"]);
        // Without space on the right, a label is on the left of its line.
        check(&[(495.0, lost)], &["link lost"]);
    }
}
