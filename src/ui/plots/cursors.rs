//! Two cursors in the plots, and the table of what lies between them. The figures come from all measurements.

use crate::history::Series;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left};
use crate::ui::kit::format::UNKNOWN;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::plots::axes as plot_axes;
use crate::ui::plots::axes::clock;
use crate::ui::plots::plot_rows::{Panel, PlotLine};
use crate::ui::plots::sight::Span;
use crate::ui::text::{Text, plots, words};
use crate::ui::theme;
use egui::{
    Align2, CornerRadius, CursorIcon, Id, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

/// Names of the cursors.
const NAMES: [(&str, Text); 2] = [("A", plots::CURSOR_A), ("B", plots::CURSOR_B)];
/// The columns of the table.
const COLUMNS: [Text; 7] = [
    plots::AT_A,
    plots::AT_B,
    plots::DIFFERENCE,
    plots::SLOPE,
    plots::SMALLEST,
    plots::LARGEST,
    plots::MEAN,
];

/// Where the cursors stand, if they are on.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Cursors {
    /// Seconds of A and B.
    pub(crate) at: Option<[f64; 2]>,
}

/// What two cursors say of one line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Figures {
    /// A, B, B - A, change a second, smallest, largest, mean; `None` = not known.
    pub(crate) values: [Option<f64>; 7],
}

impl Figures {
    /// Of one line between two times.
    pub(crate) fn of(pane: &Pane<'_>, series: Series, [a_s, b_s]: [f64; 2]) -> Self {
        let history = &pane.state.hand().history;
        let read = |at_s| {
            let reading = history.reading(series, at_s);
            reading.map(|reading| f64::from(reading.value))
        };
        let (a, b) = (read(a_s), read(b_s));
        let difference = a.zip(b).map(|(a, b)| b - a);
        let apart_s = b_s - a_s;
        let slope = difference
            .filter(|_| apart_s != 0.0)
            .map(|difference| difference / apart_s);
        let between = history.summary(series, a_s.min(b_s), a_s.max(b_s));
        Self {
            values: [
                a,
                b,
                difference,
                slope,
                between.map(|all| f64::from(all.min)),
                between.map(|all| f64::from(all.max)),
                between.map(|all| all.mean),
            ],
        }
    }
}

impl Cursors {
    /// On at a third and two thirds of what is shown, or off.
    pub(crate) fn toggle(&mut self, (from, to): Span) {
        let third = (to - from) / 3.0;
        self.at = match self.at {
            Some(_) => None,
            None => Some([from + third, to - third]),
        };
    }

    /// Height of the table for so many lines; 0 while the cursors are off.
    pub(crate) fn table_height(self, lines: usize) -> f32 {
        let lines = u8::try_from(lines).unwrap_or(u8::MAX);
        self.at.map_or(0.0, |_| {
            theme::CURSOR_HEAD + theme::CURSOR_ROW * (f32::from(lines) + 1.0) + theme::GAP
        })
    }

    /// The lines through all plots, and the flags under them by which they are moved.
    pub(crate) fn ui(&mut self, ui: &mut Ui, ground: Rect, axis: Rect, look: Look, span: Span) {
        let Some(at) = &mut self.at else { return };
        let pale = look.palette.wash(look.palette.accent);
        let [a, b] = at.map(|at_s| plot_axes::x_of(ground, span, at_s));
        let between = Rect::from_x_y_ranges(a.min(b)..=a.max(b), ground.y_range());
        ui.painter()
            .rect_filled(between.intersect(ground), 0.0, pale.gamma_multiply(0.6));
        for (at_s, (short, name)) in at.iter_mut().zip(NAMES) {
            let x = plot_axes::x_of(ground, span, *at_s);
            if ground.x_range().contains(x) {
                let stroke = Stroke::new(1.0, look.palette.accent);
                ui.painter().vline(x, ground.y_range(), stroke);
            }
            let x = x.clamp(
                axis.left() + theme::CURSOR_FLAG / 2.0,
                axis.right() - theme::CURSOR_FLAG / 2.0,
            );
            let flag = Rect::from_center_size(
                pos2(x, axis.top() + theme::CURSOR_FLAG_AT),
                vec2(theme::CURSOR_FLAG, theme::CURSOR_FLAG),
            );
            let response = ui.interact(flag, Id::unique(("cursor", short)), Sense::drag());
            response.widget_info(|| WidgetInfo::slider(true, *at_s, look.say(name)));
            let round = CornerRadius::same(theme::ROUND_SMALL);
            ui.painter().rect_filled(flag, round, look.palette.accent);
            let (font, color) = (theme::number_small(), look.palette.on_strong);
            controls::paint_text(ui, flag, Align2::CENTER_CENTER, short, font, color);
            if let Some(pointer) = response
                .interact_pointer_pos()
                .filter(|_| response.dragged())
            {
                *at_s = plot_axes::time_of(ground, span, pointer.x).clamp(span.0, span.1);
            }
            response
                .on_hover_text(format!(
                    "{} {}",
                    look.say(name),
                    clock(*at_s, span.1 - span.0)
                ))
                .on_hover_cursor(CursorIcon::ResizeHorizontal);
        }
    }

    /// The table. True if the next plot's figures are wanted.
    pub(crate) fn table_ui(
        self,
        ui: &mut Ui,
        rect: Rect,
        pane: &Pane<'_>,
        panel: &Panel,
        lines: &[PlotLine],
    ) -> bool {
        let Some(at) = self.at else { return false };
        let look = pane.look;
        let (mut head, mut body) = rect.split_top_bottom_at_y(rect.top() + theme::CURSOR_HEAD);
        let title = look.say(panel.title);
        let width = controls::text_width(ui, title, theme::body()) + 2.0 * theme::GAP;
        let width = width.min(head.width());
        let place = take_left(&mut head, width);
        let button =
            Button::new(title, look.say(plots::FIGURES_TIP)).named(look.say(plots::FIGURES));
        let next = button
            .put(ui, look, place, Id::unique("figures of"))
            .clicked();
        let apart = format!("B - A = {:.3} s", at[1] - at[0]);
        Label::new(&apart, look.palette.muted)
            .font(theme::number_small())
            .named(look.say(plots::APART))
            .put(ui, head);
        body.min.y += 2.0;
        let name_width = (body.width() * 0.2).clamp(theme::CURSOR_NAMES.0, theme::CURSOR_NAMES.1);
        let column = (body.width() - name_width) / 7.0;
        let cell = |row: Rect, n: u8| {
            let left = row.left() + name_width + f32::from(n) * column;
            Rect::from_min_size(
                pos2(left, row.top()),
                vec2(column - theme::CURSOR_COLUMN_GAP, row.height()),
            )
        };
        let (row, mut rest) = body.split_top_bottom_at_y(body.top() + theme::CURSOR_ROW);
        for (n, text) in (0..).zip(COLUMNS) {
            let (font, color) = (theme::tiny(), look.palette.faint);
            let place = cell(row, n);
            controls::paint_text(ui, place, Align2::RIGHT_CENTER, look.say(text), font, color);
        }
        for line in lines {
            let row;
            (row, rest) = rest.split_top_bottom_at_y(rest.top() + theme::CURSOR_ROW);
            let name = look.say(words::dof(line.dof));
            Label::new(name, look.palette.dof[line.dof])
                .small()
                .put(ui, row.with_max_x(row.left() + name_width));
            let figures = Figures::of(pane, line.series, at);
            let texts = figures.values.map(|value| match value {
                Some(value) => format!("{value:.*}", panel.row.decimals.max(1)),
                None => UNKNOWN.to_owned(),
            });
            for (n, text) in (0..).zip(&texts) {
                let (font, color) = (theme::number_small(), look.palette.text);
                controls::paint_text(ui, cell(row, n), Align2::RIGHT_CENTER, text, font, color);
            }
            row_node(ui, row, &format!("{name} {title}"), &texts);
        }
        next
    }
}

/// What a screen reader says of a row.
fn row_node(ui: &Ui, row: Rect, name: &str, texts: &[String]) {
    let response = ui.interact(row, Id::unique(("figures", name)), Sense::hover());
    let text = texts.join(" ");
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_label(name);
    });
}
