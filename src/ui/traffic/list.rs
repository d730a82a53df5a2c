//! The table of frames: only the rows in sight are drawn. Which frames they are is decided elsewhere.

use crate::link::tap::Direction;
use crate::link::traffic::frame::{Frame, Kind};
use crate::ui::kit::controls;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::traffic;
use crate::ui::theme;
use egui::{
    Align, Align2, Color32, CornerRadius, Id, Key, Modifiers, Rect, Role, ScrollArea, Sense, Ui,
    UiBuilder, WidgetInfo, pos2, vec2,
};
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

/// The chosen frames, by number, and where the choice began.
#[derive(Debug, Default)]
pub(crate) struct Choice {
    pub(crate) numbers: BTreeSet<u64>,
    anchor: u64,
}

impl Choice {
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

    /// Goes one row up or down.
    fn step(&mut self, by: isize, frames: &VecDeque<Arc<Frame>>) {
        let at = frames.iter().position(|frame| frame.number == self.anchor);
        let next = at.and_then(|at| at.checked_add_signed(by));
        if let Some(frame) = next.and_then(|next| frames.get(next)) {
            self.anchor = frame.number;
            self.numbers = BTreeSet::from([frame.number]);
        }
    }
}

/// The columns of a row.
struct Columns {
    time: Rect,
    arrow: Rect,
    kind: Rect,
    sign: Rect,
    meaning: Rect,
    bytes: Rect,
}

impl Columns {
    fn of(row: Rect) -> Self {
        let mut rest = row.shrink2(vec2(theme::STEP, 0.0));
        let time = controls::take_left(&mut rest, theme::FRAME_TIME);
        let arrow = controls::take_left(&mut rest, theme::FRAME_ARROW);
        let kind = controls::take_left(&mut rest, theme::FRAME_KIND);
        let sign = controls::take_left(&mut rest, theme::FRAME_SIGN);
        let (meaning, bytes) = rest.split_left_right_at_x(rest.left() + rest.width() * 0.56);
        Self {
            time,
            arrow,
            kind,
            sign,
            meaning: meaning.with_max_x(meaning.right() - theme::GAP),
            bytes,
        }
    }
}

/// Whether the newest frame is kept in sight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sight {
    /// The newest.
    Newest,
    /// Wherever a person scrolled to.
    Scrolled,
}

/// Draws the head and the rows. What a person scrolls away from is no longer kept in sight.
pub(crate) fn list_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &Pane<'_>,
    frames: &VecDeque<Arc<Frame>>,
    choice: &mut Choice,
    sight: Sight,
) -> Sight {
    let look = pane.look;
    let (head, body) = rect.split_top_bottom_at_y(rect.top() + theme::FRAME_HEAD);
    head_ui(ui, head, look);
    // The scroll area draws a little past its edge.
    let body = body.with_min_y(body.top() + theme::STEP);
    keys(ui, frames, choice);
    let keys = ui.input(|input| input.modifiers);
    let sight = if scrolls(ui, body) {
        Sight::Scrolled
    } else {
        sight
    };
    let inside = UiBuilder::new().max_rect(body).id_salt("traffic rows");
    ui.scope_builder(inside, |ui| {
        ui.shrink_clip_rect(body);
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        let area = ScrollArea::vertical()
            .auto_shrink(false)
            .animated(false)
            .stick_to_bottom(sight == Sight::Newest);
        area.show_rows(ui, theme::FRAME_ROW, frames.len(), |ui, range| {
            for frame in frames.range(range.start..range.end.min(frames.len())) {
                let size = vec2(body.width(), theme::FRAME_ROW);
                let (_, place) = ui.allocate_space(size);
                let chosen = choice.numbers.contains(&frame.number);
                if row_ui(ui, place, look, frame, chosen) {
                    choice.press(frame.number, keys, frames);
                }
            }
            if sight == Sight::Newest {
                let below = rows_height(frames.len().saturating_sub(range.end));
                let end = pos2(body.left(), ui.cursor().top() + below);
                ui.scroll_to_rect(Rect::from_min_max(end, end), Some(Align::BOTTOM));
            }
        });
    });
    sight
}

/// A person turns the wheel back, or takes the scroll bar.
fn scrolls(ui: &Ui, body: Rect) -> bool {
    ui.rect_contains_pointer(body)
        && ui.input(|input| {
            let at = input.pointer.interact_pos();
            let on_bar = at.is_some_and(|at| at.x > body.right() - theme::FRAME_BAR);
            input.smooth_scroll_delta().y > 0.0 || on_bar && input.pointer.primary_down()
        })
}

fn rows_height(rows: usize) -> f32 {
    f32::from(u16::try_from(rows).unwrap_or(u16::MAX)) * theme::FRAME_ROW
}

/// Up and down move a choice while no field and no track has the keyboard.
fn keys(ui: &Ui, frames: &VecDeque<Arc<Frame>>, choice: &mut Choice) {
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

fn head_ui(ui: &Ui, rect: Rect, look: Look) {
    let columns = Columns::of(rect);
    for (place, text) in [
        (columns.time, traffic::HEAD_TIME),
        (columns.kind, traffic::HEAD_KIND),
        (columns.meaning, traffic::HEAD_MEANING),
        (columns.bytes, traffic::HEAD_BYTES),
    ] {
        let (text, color) = (look.say(text), look.palette.muted);
        let align = if place == columns.time {
            Align2::RIGHT_CENTER
        } else {
            Align2::LEFT_CENTER
        };
        controls::paint_text(ui, place, align, text, theme::small(), color);
    }
    let stroke = egui::Stroke::new(1.0, look.palette.edge);
    ui.painter().hline(rect.x_range(), rect.bottom(), stroke);
}

/// One row; true if it was pressed.
fn row_ui(ui: &mut Ui, rect: Rect, look: Look, frame: &Frame, chosen: bool) -> bool {
    let palette = look.palette;
    let id = Id::unique(("traffic row", frame.number));
    let response = ui.interact(rect, id, Sense::click());
    let said = said(look, frame);
    response.widget_info(|| {
        let name = format!(
            "{} {} {said}",
            frame.direction.arrow(),
            look.say(traffic::kind(frame.kind))
        );
        WidgetInfo::selected(Role::Row, true, chosen, name)
    });
    let ground = if chosen {
        palette.wash(palette.accent)
    } else if response.hovered() {
        palette.control
    } else if frame.wrong.is_some() {
        palette.wash(color_of(look, frame)).gamma_multiply(0.6)
    } else {
        Color32::TRANSPARENT
    };
    ui.painter()
        .rect_filled(rect, CornerRadius::same(theme::ROUND_TRACK), ground);
    let columns = Columns::of(rect);
    paint_row(ui, &columns, look, frame, &said);
    response.clicked()
}

fn paint_row(ui: &Ui, columns: &Columns, look: Look, frame: &Frame, said: &str) {
    let palette = look.palette;
    let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
    let time = format!("{:.3}", frame.at.secs());
    let number = theme::number();
    controls::paint_text(
        ui,
        columns.time,
        right,
        &time,
        number.clone(),
        palette.muted,
    );
    arrow(ui, columns.arrow, look, frame);
    let strong = color_of(look, frame);
    let kind = look.say(traffic::kind(frame.kind));
    controls::paint_text(ui, columns.kind, left, kind, theme::body(), strong);
    if frame.wrong.is_some() {
        let sign = Rect::from_center_size(columns.sign.center(), theme::FRAME_WRONG);
        controls::warning_sign(ui, sign, strong);
    }
    let color = if frame.wrong.is_some() {
        strong
    } else {
        palette.text
    };
    let font = if frame.wrong.is_some() {
        theme::body()
    } else {
        number
    };
    controls::paint_text(ui, columns.meaning, left, said, font, color);
    let hex = frame.hex();
    let small = theme::number_small();
    controls::paint_text(ui, columns.bytes, left, &hex, small, palette.muted);
}

/// What is wrong, else what it means.
fn said(look: Look, frame: &Frame) -> String {
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

/// To the hand points right, from it left; changes of the wire itself have a bar.
fn arrow(ui: &Ui, rect: Rect, look: Look, frame: &Frame) {
    let color = look.palette.muted;
    let stroke = egui::Stroke::new(theme::LINE, color);
    let (center, half) = (rect.center(), 6.0);
    let line = [
        pos2(center.x - half, center.y),
        pos2(center.x + half, center.y),
    ];
    if frame.bytes.is_empty() {
        let bar = egui::Stroke::new(theme::LINE, look.palette.faint);
        ui.painter().line_segment(line, bar);
        return;
    }
    ui.painter().line_segment(line, stroke);
    let (tip, back) = match frame.direction {
        Direction::ToHand => (center.x + half, center.x + half - theme::STEP),
        Direction::FromHand => (center.x - half, center.x - half + theme::STEP),
    };
    for y in [center.y - theme::BAR, center.y + theme::BAR] {
        let wing = [pos2(back, y), pos2(tip, center.y)];
        ui.painter().line_segment(wing, stroke);
    }
}
