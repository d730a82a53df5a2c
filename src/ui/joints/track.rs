//! The slider: a handle for the target over a bar or marker for the actual value. Independent of joints.

use crate::ui::kit::{self, Look};
use crate::ui::theme;
use egui::{
    Color32, EventFilter, Id, Key, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, Vec2,
    WidgetInfo, accesskit, pos2, vec2,
};

/// Height of the rail.
const RAIL: f32 = 6.0;
/// Radius of the handle.
const HANDLE: f32 = 7.0;
/// Size of the tick at a value that the hand holds.
const TICK: Vec2 = vec2(5.0, 14.0);
/// Distance that marks of the rail extend below it.
const BELOW: f32 = 5.0;

/// Style of the actual value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Actual {
    /// A marker on the rail; the gap to the handle is filled.
    Marker,
    /// A bar from the left end.
    Bar,
}

/// A slider with its values.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlideTrack<'a> {
    /// Accessible name.
    pub(crate) name: &'a str,
    /// Tooltip sentence.
    pub(crate) tip: &'a str,
    /// Reason why it cannot be moved now.
    pub(crate) disabled: Option<&'a str>,
    /// Maximum value; the minimum is 0.
    pub(crate) max: i16,
    /// Step of an arrow key.
    pub(crate) step: i16,
    /// Position of the handle; `None` if unknown.
    pub(crate) target: Option<i16>,
    /// Measured value, if it is known and plausible.
    pub(crate) actual: Option<i16>,
    /// Style of the measured value.
    pub(crate) draws: Actual,
    /// Colour of the measured value.
    pub(crate) color: Color32,
    /// A value marked with a small tick.
    pub(crate) tick: Option<i16>,
    /// Start of the zone up to the end that needs caution; painted on the rail.
    pub(crate) rough_from: Option<i16>,
    /// Highest recent measured value.
    pub(crate) peak: Option<i16>,
}

impl<'a> SlideTrack<'a> {
    /// A movable slider without values.
    pub(crate) const fn new(name: &'a str, max: i16, color: Color32) -> Self {
        Self {
            name,
            tip: "",
            disabled: None,
            max,
            step: 10,
            target: None,
            actual: None,
            draws: Actual::Bar,
            color,
            tick: None,
            rough_from: None,
            peak: None,
        }
    }

    /// Draws the slider. Returns the value that the user moved it to in this frame.
    pub(crate) fn put(self, ui: &mut Ui, look: Look, rect: Rect, id: Id) -> Option<i16> {
        let sense = match self.disabled {
            None => Sense::click_and_drag(),
            Some(_) => Sense::hover(),
        };
        let response = ui.interact(rect, id, sense);
        let moved = match self.disabled {
            None => self.moved(ui, &response, rail_of(rect)),
            Some(_) => None,
        };
        let shown = moved.or(self.target);
        self.name_it(ui, &response, shown);
        if ui.is_rect_visible(rect) {
            self.paint(ui, look, &response, shown);
        }
        if !was_held(ui, &response) {
            let reason = self.disabled.unwrap_or_default();
            response.on_hover_text(format!("{}\n{reason}", self.tip).trim());
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
            let set = accesskit::Action::SetValue;
            let requests = input.accesskit_action_requests(response.id, set);
            let value = |data: Option<&accesskit::ActionData>| match data {
                Some(accesskit::ActionData::NumericValue(value)) => Some(*value),
                _ => None,
            };
            requests.filter_map(|it| value(it.data.as_ref())).last()
        });
        if let Some(value) = asked {
            return Some(self.nearest(value));
        }
        let steps = self.key_steps(ui, response);
        // Without a handle there is no position to step from.
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
        // Only while it has the focus: a wheel turned while the pointer passes over it moves nothing.
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

    /// Rectangle of a tick at this value, on the slider in `rect`.
    pub(crate) fn tick_place(&self, rect: Rect, value: i16) -> Rect {
        let rail = rail_of(rect);
        Rect::from_center_size(pos2(self.x_of(rail, value), rail.center().y), TICK)
    }

    fn paint(&self, ui: &Ui, look: Look, response: &Response, shown: Option<i16>) {
        let (palette, painter) = (look.palette, ui.painter());
        let rail = rail_of(response.rect);
        let ground = rail.expand2(vec2(HANDLE - 1.0, 0.0));
        let edge = Stroke::new(1.0, palette.edge);
        painter.rect(ground, 3.0, palette.sunken, edge, StrokeKind::Inside);
        if let Some(from) = self.rough_from {
            paint_rough(ui, look, ground.with_min_x(self.x_of(rail, from)));
        }
        if let Some(tick) = self.tick {
            let below = rail.bottom() + 2.0..=rail.bottom() + BELOW;
            painter.vline(self.x_of(rail, tick), below, (1.0, palette.faint));
        }
        let target = shown.map(|value| self.x_of(rail, value));
        self.paint_actual(ui, rail, target);
        if let Some(peak) = self.peak.filter(|peak| *peak > 0) {
            let across = rail.y_range().expand(1.0);
            painter.vline(self.x_of(rail, peak), across, (2.0, self.color));
        }
        if let Some(x) = target {
            self.paint_handle(ui, look, response, pos2(x, rail.center().y));
        }
        kit::focus_ring(ui, look, response, ground.expand2(vec2(0.0, BELOW)));
    }

    fn paint_actual(&self, ui: &Ui, rail: Rect, target: Option<f32>) {
        let Some(actual) = self.actual else { return };
        let (painter, x) = (ui.painter(), self.x_of(rail, actual));
        match self.draws {
            Actual::Bar if actual > 0 => {
                let bar = rail.with_min_x(rail.left() - HANDLE + 1.0).with_max_x(x);
                painter.rect_filled(bar.shrink(1.0), 2.0, self.color);
            }
            Actual::Bar => {}
            Actual::Marker => {
                if let Some(target) = target {
                    let span = rail.with_min_x(x.min(target)).with_max_x(x.max(target));
                    let gap = self.color.gamma_multiply(0.45);
                    painter.rect_filled(span.shrink2(vec2(0.0, 1.0)), 0.0, gap);
                }
                let marker = Rect::from_center_size(pos2(x, rail.center().y), vec2(4.0, 16.0));
                painter.rect_filled(marker, 2.0, self.color);
            }
        }
    }

    fn paint_handle(&self, ui: &Ui, look: Look, response: &Response, center: Pos2) {
        let (palette, painter) = (look.palette, ui.painter());
        if self.disabled.is_some() {
            let edge = Stroke::new(1.2, palette.faint);
            painter.circle(center, HANDLE - theme::FOCUS_LINE, palette.card, edge);
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

/// Rectangle of the rail, along which the middle of the handle moves.
fn rail_of(rect: Rect) -> Rect {
    let width = (rect.width() - 2.0 * HANDLE).max(1.0);
    Rect::from_center_size(rect.center(), vec2(width, RAIL))
}

/// True from a press on the slider until the pointer has left it: a tooltip would cover the joint being set.
fn was_held(ui: &Ui, response: &Response) -> bool {
    let held = Id::unique("held track");
    let before = ui.data(|data| data.get_temp(held)) == Some(response.id);
    let down = response.is_pointer_button_down_on();
    let is_held = down || before && response.contains_pointer();
    if is_held && !before {
        ui.data_mut(|data| data.insert_temp(held, response.id));
    } else if before && !is_held {
        ui.data_mut(|data| data.remove::<Id>(held));
    }
    is_held
}

/// Hatches the far end of the rail, so that it differs in more than colour.
fn paint_rough(ui: &Ui, look: Look, zone: Rect) {
    let zone = zone.shrink(1.0);
    if zone.width() <= 0.0 {
        return;
    }
    let (painter, warn) = (ui.painter_at(zone), look.palette.warn);
    painter.rect_filled(zone, 0.0, look.palette.wash(warn));
    let stroke = Stroke::new(1.0, warn.gamma_multiply(0.45));
    let mut x = zone.left();
    while x < zone.right() + zone.height() {
        let low = pos2(x - zone.height(), zone.bottom());
        painter.line_segment([low, pos2(x, zone.top())], stroke);
        x += 5.0;
    }
}

/// Points of a touchpad that equal one notch of a wheel.
const NOTCH: f32 = 16.0;

/// Maximum steps in one frame; more cannot come from a human hand.
const MOST_STEPS: i16 = 100;

/// Whole notches of the wheel, removed from the input so that nothing scrolls as well.
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
    i16::try_from(count).map_or(MOST_STEPS, |count| count.min(MOST_STEPS))
}
