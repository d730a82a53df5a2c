//! What the drives say of themselves over the time of the plots: an instrument, a row of colours for each joint.

use crate::hand::Dof;
use crate::history::StatusRun;
use crate::ui::kit::{Label, Look, Pane, format};
use crate::ui::plots::time_window::TimeSpan;
use crate::ui::plots::times::clock;
use crate::ui::text::{panels, words};
use crate::ui::theme;
use egui::{Rangef, Rect, Role, Sense, Stroke, Ui, WidgetInfo, remap, vec2};
use std::time::Duration;

/// A row with the gap below it.
const ROW: f32 = 5.0;
/// A row.
const BAR: f32 = 4.0;

/// Height of the rows of so many joints.
pub(crate) fn height(joints: usize) -> f32 {
    ROW * f32::from(u8::try_from(joints).unwrap_or(u8::MAX)) + theme::STEP
}

/// Where the rows stand.
pub(crate) struct DrivesPlace<'a> {
    pub(crate) joints: &'a [Dof],
    pub(crate) span: TimeSpan,
    /// Room at the right of the plots.
    pub(crate) end: f32,
    /// The time that the pointer is at in a plot.
    pub(crate) pointed_s: Option<f64>,
}

impl DrivesPlace<'_> {
    /// Draws the rows as wide as `ui`.
    pub(crate) fn ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let size = vec2(ui.available_width(), height(self.joints.len()));
        let (whole, response) = ui.allocate_exact_size(size, Sense::hover());
        let name = look.say(panels::DRIVES);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
        let whole = whole.with_min_y(whole.top() + theme::STEP);
        let xs = Rangef::new(whole.left() + theme::PLOT_AXIS, whole.right() - self.end);
        let frame = Rect::from_x_y_ranges(xs, whole.y_range());
        let words = whole.with_max_x(xs.min - 2.0 * theme::STEP);
        Label::new(name, look.palette.muted)
            .small()
            .right()
            .paint(ui, words);
        let mut top = frame.top();
        for dof in self.joints {
            self.row(ui, pane, *dof, frame.with_min_y(top));
            top += ROW;
        }
        if let Some(at_s) = self.pointed_s {
            let stroke = Stroke::new(1.0, look.palette.faint);
            ui.painter()
                .vline(self.x(frame, at_s), frame.y_range(), stroke);
        }
        let at = response.hover_pos().filter(|at| frame.contains(*at));
        let told = at.and_then(|at| {
            let (from_s, to_s) = self.span;
            let part = f64::from((at.x - xs.min) / xs.span().max(1.0));
            let row = self.joints.iter().enumerate().find(|(row, _)| {
                let rows = height(row + 1) - theme::STEP;
                at.y < frame.top() + rows
            });
            told(pane, *row?.1, from_s + part * (to_s - from_s))
        });
        response
            .on_hover_text_at_pointer(told.unwrap_or_else(|| look.tip(panels::DRIVES).to_owned()));
    }

    /// One joint: the stretches of which something is known.
    fn row(&self, ui: &Ui, pane: &Pane<'_>, dof: Dof, frame: Rect) {
        let palette = pane.look.palette;
        let bar = Rect::from_min_size(frame.min, vec2(frame.width(), BAR));
        ui.painter().rect_filled(bar, 0.0, palette.sunken);
        let mark = bar.translate(vec2(-theme::STEP - BAR / 2.0, 0.0));
        let mark = mark.with_max_x(mark.left() + BAR);
        ui.painter().rect_filled(mark, 0.0, palette.dof[dof]);
        let history = &pane.state.hand().measured.history;
        let (from_s, to_s) = self.span;
        for run in history.status(dof, from_s, to_s) {
            let fault = run.faults.and_then(|faults| faults.iter().next());
            let color = palette.drive(fault, run.status);
            if color != palette.faint {
                let from = self.x(frame, run.from_s.max(from_s));
                let to = self.x(frame, run.until_s.min(to_s)).max(from + 1.0);
                let xs = Rangef::new(from, to.min(frame.right()));
                let stretch = Rect::from_x_y_ranges(xs, bar.y_range());
                ui.painter().rect_filled(stretch, 0.0, color);
            }
        }
    }

    fn x(&self, frame: Rect, at_s: f64) -> f32 {
        let (from_s, to_s) = self.span;
        let xs = f64::from(frame.left())..=f64::from(frame.right());
        #[expect(clippy::cast_possible_truncation, reason = "a place on a screen")]
        let x = remap(at_s, from_s..=to_s, xs) as f32;
        x
    }
}

/// What the drive of a joint said at a time, and since when.
fn told(pane: &Pane<'_>, dof: Dof, at_s: f64) -> Option<String> {
    let look = pane.look;
    let history = &pane.state.hand().measured.history;
    let run = history.status(dof, at_s, at_s).last()?;
    let lasted = Duration::from_secs_f64((run.until_s - run.from_s).max(0.0));
    let since = clock(run.from_s, 0.1);
    let since = look.fill(panels::DRIVE_SINCE, &[&since, &format::age(lasted)]);
    let said = look.pair(look.say(words::dof(dof)), &said(look, run));
    Some(format!("{said}\n{since}"))
}

fn said(look: Look, run: &StatusRun) -> String {
    let faults = run.faults.into_iter().flat_map(|faults| faults.iter());
    let faults = faults.map(|fault| words::fault(fault, look.language).title);
    let faults: Vec<&str> = faults.collect();
    match run.status {
        Some(status) if faults.is_empty() => words::status(status, look.language).title.into(),
        None if faults.is_empty() => format::UNKNOWN.into(),
        _ => faults.join(" + "),
    }
}
