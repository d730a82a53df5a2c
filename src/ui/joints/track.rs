//! The sliding track: a handle for what is wanted over a bar for what is. Knows numbers, not joints.

use crate::ui::kit::controls::focus_ring;
use crate::ui::kit::look::Look;
use crate::ui::theme;
use egui::{
    Color32, CornerRadius, EventFilter, Id, Key, Rect, Response, Sense, Stroke, StrokeKind, Ui,
    WidgetInfo, accesskit, pos2, vec2,
};

/// Height of the rail.
const RAIL: f32 = theme::TRACK_RAIL;
/// Distance of the lines of the rough zone.
const HATCH: f32 = theme::HATCH;
/// Radius of the handle.
const HANDLE: f32 = theme::HANDLE;

/// How the actual value is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Actual {
    /// A marker on the rail; the gap to the handle is filled.
    Marker,
    /// A bar from the left end.
    Bar,
}

/// A track at a place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Track<'a> {
    /// What a screen reader says.
    pub(crate) name: &'a str,
    /// What it does, in a sentence.
    pub(crate) tip: &'a str,
    /// Why it cannot be moved now.
    pub(crate) disabled: Option<&'a str>,
    /// Largest value; the smallest is 0.
    pub(crate) max: i16,
    /// What one arrow key adds.
    pub(crate) step: i16,
    /// Where the handle stands; none if that is not known.
    pub(crate) target: Option<i16>,
    /// The measured value, if it is known and sensible.
    pub(crate) actual: Option<i16>,
    /// How the measured value is drawn.
    pub(crate) draws: Actual,
    /// Colour of what is measured.
    pub(crate) color: Color32,
    /// A value worth a small tick.
    pub(crate) tick: Option<i16>,
    /// From here to the end a person should think twice; painted on the rail.
    pub(crate) rough_from: Option<i16>,
    /// The highest measured value of late.
    pub(crate) peak: Option<i16>,
}

impl Track<'_> {
    /// Draws the track. The value that the person moved it to, if they did in this frame.
    pub(crate) fn put(self, ui: &mut Ui, look: Look, rect: Rect, id: Id) -> Option<i16> {
        let enabled = self.disabled.is_none();
        let sense = if enabled {
            Sense::click_and_drag()
        } else {
            Sense::hover()
        };
        let response = ui.interact(rect, id, sense);
        let rail = Rect::from_center_size(
            rect.center(),
            vec2((rect.width() - 2.0 * HANDLE).max(1.0), RAIL),
        );
        let moved = if enabled {
            self.moved(ui, &response, rail)
        } else {
            None
        };
        let shown = moved.or(self.target);
        self.name_it(ui, &response, shown);
        if ui.is_rect_visible(rect) {
            self.paint(ui, look, &response, rail, shown);
        }
        let tip = match self.disabled {
            Some(reason) => format!("{}\n{reason}", self.tip),
            None => self.tip.to_owned(),
        };
        if !response.dragged() {
            response.on_hover_text(tip);
        }
        moved.filter(|value| Some(*value) != self.target)
    }

    fn name_it(&self, ui: &Ui, response: &Response, shown: Option<i16>) {
        let value = shown.map_or(f64::NAN, f64::from);
        let enabled = self.disabled.is_none();
        response.widget_info(|| {
            let mut info = WidgetInfo::slider(enabled, value, self.name);
            info.value = shown.map(f64::from);
            info
        });
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_min_numeric_value(0.0);
            node.set_max_numeric_value(f64::from(self.max));
            node.set_numeric_value_step(f64::from(self.step));
            if enabled {
                node.add_action(accesskit::Action::SetValue);
                node.add_action(accesskit::Action::Increment);
                node.add_action(accesskit::Action::Decrement);
            }
        });
    }

    fn moved(&self, ui: &Ui, response: &Response, rail: Rect) -> Option<i16> {
        if let Some(pointer) = response.interact_pointer_pos() {
            if response.drag_started() || response.clicked() {
                response.request_focus();
            }
            if response.dragged() || response.clicked() {
                return Some(self.value_at(rail, pointer.x));
            }
        }
        let asked = ui.input(|input| {
            input
                .accesskit_action_requests(response.id, accesskit::Action::SetValue)
                .filter_map(|request| match request.data {
                    Some(accesskit::ActionData::NumericValue(value)) => Some(value),
                    _ => None,
                })
                .last()
        });
        if let Some(value) = asked {
            return Some(self.nearest(value));
        }
        let steps = self.key_steps(ui, response);
        // A handle that stands nowhere has no place to step from.
        let from = self.target?;
        (steps != 0).then(|| {
            from.saturating_add(steps.saturating_mul(self.step))
                .clamp(0, self.max)
        })
    }

    fn key_steps(&self, ui: &Ui, response: &Response) -> i16 {
        let by_reader =
            |action| ui.input(|input| input.num_accesskit_action_requests(response.id, action));
        let mut steps = clip(by_reader(accesskit::Action::Increment))
            - clip(by_reader(accesskit::Action::Decrement));
        if !response.has_focus() {
            return steps;
        }
        let filter = EventFilter {
            horizontal_arrows: true,
            vertical_arrows: false,
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        ui.input(|input| {
            let by_key =
                clip(input.num_presses(Key::ArrowRight)) - clip(input.num_presses(Key::ArrowLeft));
            steps += if input.modifiers.shift {
                by_key.saturating_mul(10)
            } else {
                by_key
            };
        });
        // Only with the keyboard on it: a wheel that turns while the pointer passes moves nothing.
        if response.hovered() {
            steps += ui.input_mut(wheel_steps);
        }
        steps
    }

    fn value_at(&self, rail: Rect, x: f32) -> i16 {
        let part = (x - rail.left()) / rail.width();
        self.nearest(f64::from(part) * f64::from(self.max))
    }

    fn nearest(&self, value: f64) -> i16 {
        let value = value.round().clamp(0.0, f64::from(self.max));
        #[expect(
            clippy::cast_possible_truncation,
            reason = "clamped to 0..=max; a NaN becomes 0 in the cast and is refused before"
        )]
        let whole = if value.is_nan() {
            self.target.unwrap_or(self.max)
        } else {
            value as i16
        };
        whole
    }

    fn x_of(&self, rail: Rect, value: i16) -> f32 {
        let part = f32::from(value) / f32::from(self.max.max(1));
        rail.left() + rail.width() * part.clamp(0.0, 1.0)
    }

    fn paint(&self, ui: &Ui, look: Look, response: &Response, rail: Rect, shown: Option<i16>) {
        let palette = look.palette;
        let painter = ui.painter();
        let round = CornerRadius::same(theme::ROUND_TRACK);
        let ground = rail.expand2(vec2(HANDLE - 1.0, 0.0));
        painter.rect(
            ground,
            round,
            palette.sunken,
            Stroke::new(1.0, palette.edge),
            StrokeKind::Inside,
        );
        if let Some(from) = self.rough_from {
            self.paint_rough(ui, look, ground, self.x_of(rail, from));
        }
        if let Some(tick) = self.tick {
            let x = self.x_of(rail, tick);
            let line = [
                pos2(x, rail.bottom() + 2.0),
                pos2(x, rail.bottom() + theme::TICK),
            ];
            painter.line_segment(line, Stroke::new(1.0, palette.faint));
        }
        let actual = self.actual.map(|value| self.x_of(rail, value));
        let target = shown.map(|value| self.x_of(rail, value));
        self.paint_actual(ui, ground, rail, actual, target);
        if let Some(peak) = self.peak.filter(|peak| *peak > 0) {
            let x = self.x_of(rail, peak);
            let line = [pos2(x, rail.top() - 1.0), pos2(x, rail.bottom() + 1.0)];
            painter.line_segment(line, Stroke::new(2.0, self.color));
        }
        if let Some(x) = target {
            self.paint_handle(ui, look, response, rail, x);
        }
        focus_ring(ui, look, response, ground.expand2(vec2(0.0, theme::TICK)));
    }

    /// Slanted lines on the far end of the rail: more than a colour.
    fn paint_rough(&self, ui: &Ui, look: Look, ground: Rect, from: f32) {
        let zone = ground.with_min_x(from).shrink(1.0);
        if zone.width() <= 0.0 {
            return;
        }
        let painter = ui.painter_at(zone);
        painter.rect_filled(
            zone,
            CornerRadius::ZERO,
            look.palette.wash(look.palette.warn),
        );
        let stroke = Stroke::new(1.0, look.palette.warn.gamma_multiply(0.45));
        let mut x = zone.left();
        while x < zone.right() + zone.height() {
            painter.line_segment(
                [pos2(x - zone.height(), zone.bottom()), pos2(x, zone.top())],
                stroke,
            );
            x += HATCH;
        }
    }

    fn paint_actual(
        &self,
        ui: &Ui,
        ground: Rect,
        rail: Rect,
        actual: Option<f32>,
        target: Option<f32>,
    ) {
        let painter = ui.painter();
        let Some(x) = actual else { return };
        match self.draws {
            Actual::Bar => {
                if self.actual.is_some_and(|value| value > 0) {
                    let bar = ground.with_max_x(x).shrink(1.0);
                    painter.rect_filled(bar, CornerRadius::same(2), self.color);
                }
            }
            Actual::Marker => {
                if let Some(target) = target {
                    let span = rail.with_min_x(x.min(target)).with_max_x(x.max(target));
                    let gap = self.color.gamma_multiply(0.45);
                    painter.rect_filled(span.shrink2(vec2(0.0, 1.0)), CornerRadius::ZERO, gap);
                }
                let marker = Rect::from_center_size(
                    pos2(x, rail.center().y),
                    vec2(theme::STEP, theme::MARKER),
                );
                painter.rect_filled(marker, CornerRadius::same(2), self.color);
            }
        }
    }

    fn paint_handle(&self, ui: &Ui, look: Look, response: &Response, rail: Rect, x: f32) {
        let palette = look.palette;
        let painter = ui.painter();
        let center = pos2(x, rail.center().y);
        if self.disabled.is_some() {
            painter.circle(
                center,
                HANDLE - theme::FOCUS_LINE,
                palette.card,
                Stroke::new(theme::LINE_THIN, palette.faint),
            );
            if self.draws == Actual::Marker && self.actual.is_some() {
                painter.circle_filled(center, 2.0, self.color);
            }
            return;
        }
        let hot = response.hovered() || response.dragged() || response.has_focus();
        let edge = if hot { palette.accent } else { palette.muted };
        painter.circle(center, HANDLE, palette.handle, Stroke::new(2.0, edge));
        painter.circle_filled(center, theme::HALO, palette.handle_dot);
    }
}

/// Points of a touchpad that count as one notch of a wheel.
const NOTCH: f32 = theme::NOTCH;

/// More steps than this in one frame are not made by a hand.
const MOST_STEPS: i16 = 100;

/// Whole notches of the wheel, taken out of the input so that nothing scrolls as well.
fn wheel_steps(input: &mut egui::InputState) -> i16 {
    let mut notches = 0.0;
    input.events.retain(|event| match event {
        egui::Event::MouseWheel { unit, delta, .. } => {
            notches += match unit {
                egui::MouseWheelUnit::Point => (delta.x + delta.y) / NOTCH,
                egui::MouseWheelUnit::Line | egui::MouseWheelUnit::Page => delta.x + delta.y,
            };
            false
        }
        _ => true,
    });
    if notches != 0.0 {
        input.smooth_scroll_delta = egui::Vec2::ZERO;
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to what a hand can turn"
    )]
    let steps = notches.clamp(-f32::from(MOST_STEPS), f32::from(MOST_STEPS)) as i16;
    steps
}

fn clip(count: usize) -> i16 {
    // More steps than this in one frame are not made by a hand.
    i16::try_from(count.min(100)).unwrap_or(100)
}
