//! The table of frames. Only visible rows are drawn; filtering is done elsewhere.

use crate::link::traffic::compose::SnippetFormat;
use crate::link::traffic::frame::{Frame, Kind};
use crate::ui::kit::{self, Label, Look, Pane};
use crate::ui::text::traffic;
use crate::ui::theme;
use egui::{
    Align, Color32, FontId, Id, Key, Modifiers, Rect, Response, Role, Sense, Ui, WidgetInfo,
};
use egui_extras::{Column, TableBuilder, TableRow};
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

/// Widths of time, direction, kind, and error mark.
const WIDTHS: [f32; 4] = [78.0, 20.0, 92.0, 16.0];

/// Selected frames by number, and the start of the selection.
#[derive(Debug, Default)]
pub(crate) struct ChosenFrames {
    pub(crate) numbers: BTreeSet<u64>,
    anchor: u64,
}

impl ChosenFrames {
    fn press(&mut self, number: u64, keys: Modifiers, frames: &VecDeque<Arc<Frame>>) {
        if keys.shift && self.anchor != 0 {
            let (from, to) = (self.anchor.min(number), self.anchor.max(number));
            let between = frames.iter().map(|frame| frame.number);
            self.numbers = between.filter(|n| (from..=to).contains(n)).collect();
            return;
        }
        self.anchor = number;
        if keys.command {
            if !self.numbers.remove(&number) {
                self.numbers.insert(number);
            }
        } else {
            self.numbers = BTreeSet::from([number]);
        }
    }

    /// Moves the selection one row up or down.
    fn step(&mut self, by: isize, frames: &VecDeque<Arc<Frame>>) {
        let at = frames.iter().position(|frame| frame.number == self.anchor);
        let next = at.and_then(|at| at.checked_add_signed(by));
        if let Some(frame) = next.and_then(|next| frames.get(next)) {
            self.anchor = frame.number;
            self.numbers = BTreeSet::from([frame.number]);
        }
    }
}

/// The list of frames.
pub(crate) struct FrameList<'a> {
    pub(crate) frames: &'a VecDeque<Arc<Frame>>,
    pub(crate) choice: &'a mut ChosenFrames,
    /// Keeps the newest frame visible.
    pub(crate) follows: bool,
}

impl FrameList<'_> {
    /// Draws heading and rows. True if the user scrolls away from the newest.
    pub(crate) fn ui(self, ui: &mut Ui, pane: &Pane<'_>) -> bool {
        let look = pane.look;
        let Self {
            frames,
            choice,
            follows,
        } = self;
        keys(ui, frames, choice);
        let modifiers = ui.input(|input| input.modifiers);
        let scrolls = scrolls(ui, ui.available_rect_before_wrap());
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut table = TableBuilder::new(ui)
            .id_salt("traffic rows")
            .auto_shrink(false)
            .animate_scrolling(false);
        // The first cell draws the background of the whole row and senses its clicks, so it is not clipped.
        for (nth, width) in WIDTHS.into_iter().enumerate() {
            table = table.column(Column::exact(width).clip(nth > 0));
        }
        if follows && !scrolls {
            table = table.scroll_to_row(frames.len().saturating_sub(1), Some(Align::BOTTOM));
        }
        let rest = Column::remainder().clip(true);
        let heads = [
            Some(traffic::HEAD_TIME),
            None,
            Some(traffic::HEAD_KIND),
            None,
            Some(traffic::HEAD_MEANING),
            Some(traffic::HEAD_BYTES),
        ];
        let table = table.columns(rest, 2).header(theme::CONTROL, |mut row| {
            for head in heads {
                row.col(|ui| {
                    let text = head.map_or("", |head| look.tr(head));
                    paint(ui, text, theme::small(), look.palette.muted);
                });
            }
        });
        table.body(|body| {
            body.rows(19.0, frames.len(), |mut row| {
                let Some(frame) = frames.get(row.index()) else {
                    return;
                };
                let chosen = choice.numbers.contains(&frame.number);
                if row_ui(&mut row, pane, frame, chosen) {
                    choice.press(frame.number, modifiers, frames);
                }
            });
        });
        scrolls
    }
}

/// True if the user scrolls up with the wheel, or drags the scroll bar.
fn scrolls(ui: &Ui, body: Rect) -> bool {
    ui.rect_contains_pointer(body)
        && ui.input(|input| {
            let at = input.pointer.interact_pos();
            let on_bar = at.is_some_and(|at| at.x > body.right() - 12.0);
            input.smooth_scroll_delta().y > 0.0 || on_bar && input.pointer.primary_down()
        })
}

/// The up and down keys move the selection while no widget has the focus.
fn keys(ui: &Ui, frames: &VecDeque<Arc<Frame>>, choice: &mut ChosenFrames) {
    if choice.numbers.is_empty() || ui.memory(|memory| memory.focused().is_some()) {
        return;
    }
    let (up, down) = ui.input(|input| {
        let pressed = |key| input.num_presses(key) > 0;
        (pressed(Key::ArrowUp), pressed(Key::ArrowDown))
    });
    match (up, down) {
        (true, false) => choice.step(-1, frames),
        (false, true) => choice.step(1, frames),
        _ => {}
    }
}

/// Draws one row; true if it was clicked.
fn row_ui(row: &mut TableRow<'_, '_>, pane: &Pane<'_>, frame: &Frame, chosen: bool) -> bool {
    let look = pane.look;
    let palette = look.palette;
    let text = frame_text(look, frame);
    let strong = color_of(look, frame);
    let kind = look.tr(traffic::kind(frame.kind));
    let arrow = frame.direction.arrow();
    let way = if frame.bytes.is_empty() { "--" } else { arrow };
    let time = format!("{:>9.3}", frame.at.secs());
    let (font, color) = match frame.wrong {
        Some(_) => (theme::body(), strong),
        None => (theme::number(), palette.text),
    };
    let mut clicked = false;
    row.col(|ui| {
        let response = ground_ui(ui, look, frame, chosen);
        let name = format!("{arrow} {kind} {text}");
        response.widget_info(|| WidgetInfo::selected(Role::Row, true, chosen, &name));
        clicked = response.clicked();
        if !frame.bytes.is_empty() {
            response.context_menu(|ui| menu_ui(ui, pane, frame));
        }
        paint(ui, &time, theme::number(), palette.muted);
    });
    row.col(|ui| paint(ui, way, theme::number(), palette.muted));
    row.col(|ui| paint(ui, kind, theme::body(), strong));
    row.col(|ui| {
        if frame.wrong.is_some() {
            kit::warning_ui(ui, strong);
        }
    });
    row.col(|ui| paint(ui, &text, font, color));
    row.col(|ui| paint(ui, &frame.hex(), theme::number(), palette.muted));
    clicked
}

/// Draws the background of a row, which senses clicks. Its id is the frame's number, because rows move up as others arrive.
fn ground_ui(ui: &Ui, look: Look, frame: &Frame, chosen: bool) -> Response {
    let palette = look.palette;
    let rect = ui.max_rect().with_max_x(ui.clip_rect().right());
    let id = Id::unique(("traffic row", frame.number));
    let response = ui.interact(rect, id, Sense::click());
    let color = match frame.wrong {
        _ if chosen => palette.wash(palette.accent),
        _ if response.hovered() => palette.control,
        Some(_) => palette.wash(color_of(look, frame)).gamma_multiply(0.6),
        None => return response,
    };
    ui.painter().rect_filled(rect, 3.0, color);
    response
}

/// Draws the menu that copies one frame, also as program code.
fn menu_ui(ui: &mut Ui, pane: &Pane<'_>, frame: &Frame) {
    ui.label(pane.look.tr(traffic::COPY_AS));
    let endpoint = pane.hand().connection.endpoint.as_ref();
    for form in SnippetFormat::ALL {
        if let Some(text) = form.text(&frame.bytes, endpoint)
            && ui.button(form.name()).clicked()
        {
            ui.ctx().copy_text(text);
        }
    }
}

fn paint(ui: &Ui, text: &str, font: FontId, color: Color32) {
    Label::new(text, color).font(font).paint(ui, ui.max_rect());
}

/// Error of a frame with its meaning, or the meaning alone.
fn frame_text(look: Look, frame: &Frame) -> String {
    match frame.wrong {
        None => frame.meaning(),
        Some(wrong) => {
            let (why, about) = (traffic::wrong(look, wrong), frame.meaning());
            if about.is_empty() {
                why
            } else {
                format!("{why}  ({about})")
            }
        }
    }
}

fn color_of(look: Look, frame: &Frame) -> Color32 {
    let palette = look.palette;
    match (frame.wrong, frame.kind) {
        (Some(wrong), _) if wrong.is_damage() => palette.bad,
        (Some(_), _) => palette.warn,
        (None, Kind::Write | Kind::WriteReply | Kind::SaveResult) => palette.accent,
        (None, Kind::Read | Kind::ReadReply) => palette.text,
        (None, _) => palette.muted,
    }
}
