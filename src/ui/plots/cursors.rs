//! Two cursors in the plots, and the table of the values between them, computed from all measurements.

use crate::history::Series;
use crate::ui::kit::{Button, Label, Look, Pane, format};
use crate::ui::plots::chart::ChartResponse;
use crate::ui::plots::panels::{Panel, PanelLine};
use crate::ui::plots::time_window::TimeSpan;
use crate::ui::plots::times::clock;
use crate::ui::text::{Text, panels, words};
use crate::ui::theme;
use egui::{Align, CursorIcon, Grid, Id, Layout, Rect, Sense, Ui, WidgetInfo, pos2, vec2};

/// Width of a cursor's flag.
const CURSOR_FLAG: f32 = 16.0;
/// Width of the names in the cursor table.
const CURSOR_NAMES: f32 = 84.0;

const NAMES: [(&str, Text); 2] = [("A", panels::CURSOR_A), ("B", panels::CURSOR_B)];
/// Columns of the table.
const COLUMNS: [Text; 7] = [
    panels::AT_A,
    panels::AT_B,
    panels::DIFFERENCE,
    panels::SLOPE,
    panels::SMALLEST,
    panels::LARGEST,
    panels::MEAN,
];

/// Positions of cursors A and B in seconds; `None` while they are off.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Cursors(pub(crate) Option<[f64; 2]>);

/// Figures of one curve: at A, at B, B - A, change per second, minimum, maximum, mean; `None` = not known.
fn figures(pane: &Pane<'_>, series: Series, [a_s, b_s]: [f64; 2]) -> [Option<f64>; 7] {
    let history = &pane.hand().measured.history;
    let read = |at_s| {
        let reading = history.reading(series, at_s);
        reading.map(|reading| f64::from(reading.value))
    };
    let (a, b) = (read(a_s), read(b_s));
    let difference = a.zip(b).map(|(a, b)| b - a);
    let slope = difference.map(|difference| difference / (b_s - a_s));
    let between = history.summary(series, a_s.min(b_s), a_s.max(b_s));
    [
        a,
        b,
        difference,
        slope.filter(|slope| slope.is_finite()),
        between.map(|all| f64::from(all.min)),
        between.map(|all| f64::from(all.max)),
        between.map(|all| all.mean),
    ]
}

impl Cursors {
    /// Places the cursors at one and two thirds of the visible range, or turns them off.
    pub(crate) fn toggle(&mut self, (from, to): TimeSpan) {
        let third = (to - from) / 3.0;
        self.0 = match self.0 {
            Some(_) => None,
            None => Some([from + third, to - third]),
        };
    }

    /// Draws the flags below the lowest plot, with which the cursors are dragged.
    pub(crate) fn flags_ui(&mut self, ui: &Ui, look: Look, lowest: &ChartResponse) {
        let frame = *lowest.transform.frame();
        let half = CURSOR_FLAG / 2.0;
        let times = lowest.transform.bounds().range_x();
        for (at_s, (short, name)) in self.0.iter_mut().flatten().zip(NAMES) {
            let x = lowest.transform.position_from_point_x(*at_s);
            let x = x.clamp(frame.left() + half, frame.right() - half);
            let at = pos2(x, frame.bottom() + half);
            let flag = Rect::from_center_size(at, vec2(CURSOR_FLAG, CURSOR_FLAG));
            let response = ui.interact(flag, Id::unique(("cursor", short)), Sense::drag());
            response.widget_info(|| WidgetInfo::slider(true, *at_s, look.tr(name)));
            ui.painter()
                .rect_filled(flag, theme::ROUND_SMALL, look.palette.accent);
            let label = Label::new(short, look.palette.on_accent).center();
            label.number().paint(ui, flag);
            let pointer = response.interact_pointer_pos();
            if let Some(pointer) = pointer.filter(|_| response.dragged()) {
                let to_s = lowest.transform.value_from_position(pointer).x;
                *at_s = to_s.clamp(*times.start(), *times.end());
            }
            let at_text = clock(*at_s, lowest.transform.dvalue_dpos()[0]);
            response
                .on_hover_text(look.tr_with(name, at_text))
                .on_hover_cursor(CursorIcon::ResizeHorizontal);
        }
    }

    /// Draws the table. True if the user switches to the next plot's figures.
    pub(crate) fn table_ui(
        self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        panel: &Panel,
        lines: &[PanelLine],
    ) -> bool {
        let Some(at) = self.0 else { return false };
        let look = pane.look;
        let title = look.tr(panel.title);
        let head = ui.horizontal(|ui| {
            let button = Button::new(title, look.tip(panels::FIGURES));
            let button = button.named(look.tr(panels::FIGURES));
            let pressed = button.ui(ui, look).clicked();
            let apart = format!("B - A = {:.3} s", at[1] - at[0]);
            let label = Label::new(&apart, look.palette.muted).number();
            label.named(look.tr(panels::APART)).ui(ui);
            pressed
        });
        let width = (ui.available_width() - CURSOR_NAMES) / 7.0 - theme::STEP;
        let cell = |ui: &mut Ui, text: &str, name: Option<&str>| {
            let place = vec2(width, theme::TEXT_LINE);
            let right = Layout::right_to_left(Align::Center);
            ui.allocate_ui_with_layout(place, right, |ui| {
                ui.set_min_width(width);
                let color = match name {
                    Some(_) => look.palette.text,
                    None => look.palette.muted,
                };
                let label = Label::new(text, color).number();
                label.named(name.unwrap_or(text)).ui(ui);
            });
        };
        let grid = Grid::new("figures").spacing(vec2(theme::STEP, 0.0));
        grid.min_col_width(0.0).min_row_height(0.0).show(ui, |ui| {
            ui.allocate_space(vec2(CURSOR_NAMES, theme::TEXT_LINE));
            for text in COLUMNS {
                cell(ui, look.tr(text), None);
            }
            ui.end_row();
            for line in lines {
                let name = look.tr(words::dof(line.dof));
                Label::new(name, look.palette.dof[line.dof]).small().ui(ui);
                for (value, column) in figures(pane, line.series, at).into_iter().zip(COLUMNS) {
                    let text = value.map(|value| {
                        // Four digits fill the column in a narrow plot.
                        let is_long = value.abs() >= 1000.0;
                        let digits = panel.row.decimals.max(1);
                        let digits = if is_long { 0 } else { digits };
                        format!("{value:.digits$}")
                    });
                    let text = text.unwrap_or_else(|| format::UNKNOWN.into());
                    let named = look.pair(&format!("{name} {title}"), look.tr(column));
                    cell(ui, &text, Some(&named));
                }
                ui.end_row();
            }
        });
        head.inner
    }
}
