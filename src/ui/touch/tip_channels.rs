//! The eight channels of one fingertip over time, as sent or from their rest, each with its change and noise.

use crate::hand::Finger;
use crate::history::{Series, Trace};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label};
use crate::ui::kit::format;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::{Text, touch as text};
use crate::ui::theme;
use egui::{Color32, Id, Rect, Shape, Stroke, Ui, pos2, vec2};

/// What can be shown, in seconds, with its name.
const WINDOWS: [(f64, Text); 3] = [
    (10.0, text::LAST_10_S),
    (60.0, text::LAST_MINUTE),
    (600.0, text::LAST_10_MIN),
];
/// Over this time mean and noise are taken, in seconds.
const NOISE_S: f64 = 1.0;
/// Smallest height of the plot, in counts: less is noise.
const LEAST_SPAN: f64 = 2_000.0;
/// How the channels are shown.
#[derive(Debug, Clone)]
pub(crate) struct TipChannels {
    /// From the rest, or as the hand sends them.
    tared: bool,
    window: usize,
    traces: [Trace; 8],
}

impl Default for TipChannels {
    fn default() -> Self {
        Self {
            tared: true,
            window: 0,
            traces: Default::default(),
        }
    }
}

/// One colour for each channel.
fn color(look: Look, channel: usize) -> Color32 {
    let palette = look.palette;
    let joints = palette.dof.as_array();
    let joint = joints.get(channel).copied();
    joint.unwrap_or(if channel == 6 {
        palette.muted
    } else {
        palette.text
    })
}

impl TipChannels {
    /// Draws choice, plot and list.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>, finger: Finger) {
        let mut body = rect;
        let head = controls::take_top(&mut body, theme::CONTROL);
        self.head_ui(ui, head, pane);
        let list = (body.width() >= theme::CHANNELS_ROOMY)
            .then(|| controls::take_right(&mut body, theme::CHANNEL_LIST));
        let rest = pane.state.hand().tare.rest(finger).filter(|_| self.tared);
        let offset = |channel: usize| {
            let rest = rest.and_then(|rest| rest.raw.get(channel).copied());
            rest.map_or(0.0, f64::from)
        };
        self.plot_ui(ui, body, pane, finger, &offset);
        if let Some(list) = list {
            list_ui(ui, list, pane, finger);
        }
    }

    fn head_ui(&mut self, ui: &mut Ui, head: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let mut row = head;
        for (name, tip, tared) in [
            (text::RAW, text::RAW_TIP, false),
            (text::TARED, text::TARED_TIP, true),
        ] {
            if choice(ui, look, &mut row, (name, tip), self.tared == tared) {
                self.tared = tared;
            }
        }
        for (at, (_, name)) in WINDOWS.into_iter().enumerate() {
            if choice(
                ui,
                look,
                &mut row,
                (name, text::LAST_TIP),
                self.window == at,
            ) {
                self.window = at;
            }
        }
        let megabytes = pane.state.hand().history.channel_bytes().div_ceil(100_000);
        let kept = format!(
            "{}, {}.{} MB",
            look.say(text::KEPT),
            megabytes / 10,
            megabytes % 10
        );
        if row.width() >= controls::text_width(ui, &kept, theme::small()) {
            Label::new(&kept, look.palette.faint)
                .small()
                .right()
                .put(ui, row);
        }
    }

    fn plot_ui(
        &mut self,
        ui: &Ui,
        rect: Rect,
        pane: &Pane<'_>,
        finger: Finger,
        offset: &dyn Fn(usize) -> f64,
    ) {
        let look = pane.look;
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, look.palette.sunken);
        let seconds = WINDOWS.get(self.window).map_or(10.0, |window| window.0);
        let now = pane.state.now.secs();
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (channel, trace) in (0u8..).zip(&mut self.traces) {
            let series = Series::Channel(channel, finger);
            let history = &pane.state.hand().history;
            history.trace(series, now - seconds, now, columns(rect), trace);
            let offset = offset(usize::from(channel));
            for [_, value] in trace.points() {
                low = low.min(value - offset);
                high = high.max(value - offset);
            }
        }
        if low > high {
            let place = rect.shrink(theme::STEP);
            controls::paint_text(
                ui,
                place,
                egui::Align2::CENTER_CENTER,
                look.say(crate::ui::text::panels::PLOT_EMPTY),
                theme::small(),
                look.palette.faint,
            );
            return;
        }
        let (low, high) = widened(low, high);
        let place = |[at_s, value]: [f64; 2]| {
            #[expect(clippy::cast_possible_truncation, reason = "shares of a screen")]
            let (across, up) = (
                ((at_s - now + seconds) / seconds) as f32,
                ((value - low) / (high - low)) as f32,
            );
            pos2(
                rect.left() + rect.width() * across,
                rect.bottom() - rect.height() * up,
            )
        };
        if low < 0.0 && high > 0.0 {
            let zero = [place([now - seconds, 0.0]), place([now, 0.0])];
            painter.line_segment(zero, Stroke::new(1.0, look.palette.edge));
        }
        for (channel, trace) in self.traces.iter().enumerate() {
            let offset = offset(channel);
            let stroke = Stroke::new(theme::LINE, color(look, channel));
            for segment in &trace.segments {
                let points = segment
                    .iter()
                    .map(|[at_s, value]| place([*at_s, value - offset]));
                painter.add(Shape::line(points.collect(), stroke));
            }
        }
        let inner = rect.shrink(theme::STEP);
        let bottom = inner.left_bottom() - vec2(0.0, theme::AXIS_HEIGHT);
        for (corner, value) in [(inner.left_top(), high), (bottom, low)] {
            controls::paint_text(
                ui,
                Rect::from_min_size(corner, vec2(theme::AXIS_WIDTH, theme::AXIS_HEIGHT)),
                egui::Align2::LEFT_CENTER,
                &format::counts(Some(whole(value))),
                theme::number_small(),
                look.palette.muted,
            );
        }
    }
}

/// Each channel with its change from rest and its noise, over the last second.
fn list_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, finger: Finger) {
    let look = pane.look;
    let row = (rect.height() / 9.0).min(theme::CHANNEL_ROW);
    let mut top = rect.top();
    let mut next = || {
        let place = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), row));
        top += row;
        place
    };
    Label::new(look.say(text::NOISE_HEAD), look.palette.faint)
        .small()
        .right()
        .put(ui, next())
        .on_hover_text(look.say(text::NOISE_TIP));
    let now = pane.state.now.secs();
    let rest = pane.state.hand().tare.rest(finger);
    for channel in 0..8u8 {
        let place = next();
        let at = usize::from(channel);
        let dash = pos2(place.left(), place.center().y);
        let stroke = Stroke::new(theme::BAR, color(look, at));
        ui.painter()
            .line_segment([dash, dash + vec2(theme::PAD, 0.0)], stroke);
        let number = place.with_min_x(place.left() + theme::PAD + theme::STEP);
        Label::new(&format!("{}", channel + 1), look.palette.muted)
            .small()
            .put(ui, number);
        let spread =
            pane.state
                .hand()
                .history
                .spread(Series::Channel(channel, finger), now - NOISE_S, now);
        let rest = rest.and_then(|rest| rest.raw.get(at).copied());
        let change = spread
            .zip(rest)
            .map(|(spread, rest)| whole(spread.mean - f64::from(rest)));
        let noise = spread.map(|spread| whole(spread.deviation.round()));
        let name = format!("{} {}", look.say(text::NOISE), channel + 1);
        let words = format!("{:>7} {:>6}", signed(change), format::counts(noise));
        Label::new(&words, look.palette.text)
            .font(theme::number_small())
            .right()
            .named(&name)
            .put(ui, place);
    }
}

/// One of a row of choices, as wide as its words; true if it was pressed.
pub(crate) fn choice(
    ui: &mut Ui,
    look: Look,
    row: &mut Rect,
    (name, tip): (Text, Text),
    chosen: bool,
) -> bool {
    let words = look.say(name);
    let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::GAP;
    let place = controls::take_left(row, width);
    row.min.x -= theme::STEP;
    let button = Button::new(words, look.say(tip)).choice(chosen);
    button
        .put(ui, look, place, Id::unique(("tip choice", name.en)))
        .clicked()
}

/// A change with its sign, shortened like counts.
pub(crate) fn signed(value: Option<i64>) -> String {
    match value {
        Some(value) if value > 0 => format!("+{}", format::counts(Some(value))),
        other => format::counts(other),
    }
}

/// Points of a plot that are columns of pixels.
pub(crate) fn columns(rect: Rect) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to what a screen has"
    )]
    let columns = rect.width().clamp(1.0, theme::COLUMNS_MOST) as usize;
    columns
}

/// A span with room above and below, and never so narrow that noise fills it.
fn widened(low: f64, high: f64) -> (f64, f64) {
    let (middle, half) = (
        f64::midpoint(low, high),
        (high - low).max(LEAST_SPAN) * 0.54,
    );
    (middle - half, middle + half)
}

fn whole(value: f64) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "counts are far below 2^53")]
    let whole = value as i64;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_alone_does_not_fill_the_plot() {
        let (low, high) = widened(99.0, 101.0);
        assert!(high - low >= LEAST_SPAN && low < 99.0 && high > 101.0);
        let (low, high) = widened(0.0, 100_000.0);
        assert!(low < 0.0 && high > 100_000.0 && high - low < 110_000.0);
    }

    #[test]
    fn a_change_has_its_sign() {
        let words = [Some(1234), Some(-5), Some(0), None].map(signed);
        assert_eq!(words, ["+1234", "-5", "0", "-"]);
    }
}
