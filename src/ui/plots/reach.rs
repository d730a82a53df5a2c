//! The pointer in the plots: zooming, moving and marking in time, and what is measured where it stands.

use crate::ui::kit::controls;
use crate::ui::kit::format::UNKNOWN;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::plots::axes as plot_axes;
use crate::ui::plots::axes::{TimeAxis, clock};
use crate::ui::plots::plot_rows::{Panel, PlotLine};
use crate::ui::plots::sight::Sight;
use crate::ui::text::plots;
use crate::ui::theme;
use egui::{
    Align2, CornerRadius, Id, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke, Ui,
    WidgetInfo, pos2,
};

/// A stretch that is being marked, in points.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Reach {
    marked: Option<(f32, f32)>,
}

impl Reach {
    /// Wheel zooms, drag moves, shift or the right button marks what to zoom into, a double click follows again.
    pub(crate) fn act(&mut self, ui: &Ui, response: &Response, ground: Rect, sight: &mut Sight) {
        let (scroll, pinch, shift) = ui.input(|input| {
            let scroll = input.smooth_scroll_delta;
            (scroll, input.zoom_delta(), input.modifiers.shift)
        });
        let second_s = |points: f32| f64::from(points / ground.width()) * sight.width_s();
        if let Some(at) = response.hover_pos().filter(|_| !response.dragged()) {
            let at_s = plot_axes::time_of(ground, sight.span(), at.x);
            let wheel = f64::from(scroll.y / theme::PLOT_WHEEL) + f64::from(pinch).log2();
            let aside = second_s(scroll.x);
            if scroll.x != 0.0 {
                sight.pan(-aside);
            } else if wheel != 0.0 {
                sight.zoom(at_s, (-wheel).exp2());
            }
        }
        let marks = response.dragged_by(PointerButton::Secondary) || shift || self.marked.is_some();
        if let Some(at) = response
            .interact_pointer_pos()
            .filter(|_| response.dragged())
        {
            if marks {
                // A drag is known as one only after some way.
                let began = ui.input(|input| input.pointer.press_origin());
                let from = began.map_or(at.x, |began| began.x);
                self.marked = Some((from, at.x));
            } else if response.drag_delta().x != 0.0 {
                let by_s = f64::from(response.drag_delta().x / ground.width()) * sight.width_s();
                sight.pan(-by_s);
            }
        } else if let Some((from, to)) = self.marked.take() {
            let span = sight.span();
            let time =
                |x: f32| plot_axes::time_of(ground, span, x.clamp(ground.left(), ground.right()));
            if (from - to).abs() >= theme::PLOT_MARKED_LEAST {
                sight.show((time(from.min(to)), time(from.max(to))));
            }
        }
        if response.double_clicked() {
            sight.follow();
        }
    }

    /// What is marked.
    pub(crate) fn ui(self, ui: &Ui, ground: Rect, look: Look) {
        if let Some((from, to)) = self.marked {
            let marked = Rect::from_x_y_ranges(from.min(to)..=from.max(to), ground.y_range());
            let color = look.palette.wash(look.palette.accent);
            ui.painter()
                .rect_filled(marked.intersect(ground), 0.0, color);
        }
    }
}

/// A line through all plots where the pointer is, with its time.
pub(crate) fn pointer_ui(ui: &Ui, ground: Rect, at: Pos2, look: Look, time: TimeAxis) {
    let palette = look.palette;
    let line = Stroke::new(1.0, palette.faint);
    ui.painter().vline(at.x, ground.y_range(), line);
    let at_s = plot_axes::time_of(ground, time.span, at.x);
    let text = match time.now {
        Some(now) => format!("-{:.2} s", now - at_s),
        None => clock(at_s, time.span.1 - time.span.0),
    };
    let center = pos2(
        at.x.clamp(
            ground.left() + theme::REACH_NOTE.x / 2.0,
            ground.right() - theme::REACH_NOTE.x / 2.0,
        ),
        ground.bottom() + theme::PLOT_TIME_AXIS / 2.0,
    );
    let place = Rect::from_center_size(center, theme::REACH_NOTE);
    let round = CornerRadius::same(theme::ROUND_TRACK);
    ui.painter().rect_filled(place, round, palette.control);
    let align = Align2::CENTER_CENTER;
    let font = theme::number_small();
    controls::paint_text(ui, place, align, &text, font, palette.text);
}

/// The values of all lines at a time, at the right end of a caption; what is left of it.
pub(crate) fn readings_ui(
    ui: &Ui,
    rect: Rect,
    pane: &Pane<'_>,
    panel: &Panel,
    lines: &[PlotLine],
    at_s: f64,
) -> Rect {
    let look = pane.look;
    let texts: Vec<String> = lines
        .iter()
        .map(|line| {
            let reading = pane.state.hand().history.reading(line.series, at_s);
            reading.map_or_else(
                || UNKNOWN.to_owned(),
                |reading| panel.value(f64::from(reading.value)),
            )
        })
        .collect();
    let width = controls::text_width(ui, "00000 ", theme::number_small());
    let mut right = rect.right();
    for (line, text) in lines.iter().zip(&texts).rev() {
        let place = Rect::from_min_max(pos2(right - width, rect.top()), pos2(right, rect.bottom()));
        let color = look.palette.dof[line.dof];
        let (font, align) = (theme::number_small(), Align2::RIGHT_CENTER);
        controls::paint_text(ui, place, align, text, font, color);
        right -= width;
    }
    let place = rect.with_min_x(right);
    let response = ui.interact(
        place,
        Id::unique(("readings", panel.title.en)),
        Sense::hover(),
    );
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, texts.join(" ")));
    let name = format!(
        "{} {}",
        look.say(panel.title),
        look.say(plots::UNDER_POINTER)
    );
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_label(name);
    });
    rect.with_max_x(right)
}
