//! One fingertip in detail: how near its grip is to slipping, and its forces over the last seconds.

use crate::app::history::{Series, Touch, Trace};
use crate::app::state::Freshness;
use crate::hand::{Finger, TactileBlock};
use crate::ui::controls::{self, Button, Label};
use crate::ui::look::{Look, Pane};
use crate::ui::text::{Text, panels, words};
use crate::ui::track::{Actual, Track};
use crate::ui::{format, theme};
use egui::{Align2, Id, Painter, Pos2, Rect, Shape, Stroke, Ui, Vec2, pos2, vec2};

/// Friction that is taken until a person chooses one, in percent: rubber on smooth plastic is about this.
const FRICTION_PERCENT: i16 = 50;
/// The largest friction that can be chosen, in percent.
const FRICTION_MAX: i16 = 150;
/// Below this normal force a ratio of forces says nothing, in newtons.
const CONTACT_N: f32 = 0.2;
/// Share of the friction from which a grip counts as near to slipping.
const NEAR: f32 = 0.8;
/// Seconds of force shown.
const SECONDS: f64 = 10.0;
/// The compass ends at this many times the chosen friction.
const COMPASS_END: f32 = 1.5;
/// Smallest end of the force axis, in newtons.
const FORCE_END: f64 = 1.0;

/// Which fingertip, and what friction is reckoned with.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TipDetail {
    /// The fingertip.
    pub(crate) finger: Finger,
    friction_percent: i16,
    trace: Trace,
}

impl Default for TipDetail {
    fn default() -> Self {
        Self {
            finger: Finger::Index,
            friction_percent: FRICTION_PERCENT,
            trace: Trace::default(),
        }
    }
}

/// How a grip stands against slipping.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Grip {
    /// Nothing known.
    Unknown,
    /// Too little force to say.
    Loose,
    /// Tangential over normal force.
    Ratio(f32),
}

impl Grip {
    fn of(block: Option<&TactileBlock>) -> Self {
        let forces = block.and_then(|block| block.normal().zip(block.tangential()));
        match forces {
            None => Self::Unknown,
            Some((normal, _)) if normal < CONTACT_N => Self::Loose,
            Some((normal, tangential)) => Self::Ratio(tangential.abs() / normal),
        }
    }

    /// How much of the friction is left, 1 = all, below 0 = more than there is.
    fn margin(self, friction: f32) -> Option<f32> {
        match self {
            Self::Ratio(ratio) if friction > 0.0 => Some(1.0 - ratio / friction),
            _ => None,
        }
    }
}

impl TipDetail {
    fn friction(&self) -> f32 {
        f32::from(self.friction_percent) / 100.0
    }

    /// The card.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let mut body = controls::card(ui, look, rect);
        let head = controls::take_top(&mut body, theme::CONTROL);
        self.head_ui(ui, head, look);
        let size = (body.height() * 0.58).min(body.width() * 0.42).round();
        let mut upper = controls::take_top(&mut body, size);
        let compass = controls::take_left(&mut upper, size);
        self.compass_ui(ui, compass, pane);
        self.readings_ui(ui, upper, pane);
        self.forces_ui(ui, body, pane);
    }

    /// Title and choice of the finger; the choice alone where the room is short.
    fn head_ui(&mut self, ui: &mut Ui, head: Rect, look: Look) {
        let title = look.say(panels::TIP);
        let title_width = controls::text_width(ui, title, theme::title()) + theme::GAP;
        let widest = Finger::ALL
            .map(|finger| controls::text_width(ui, look.say(words::finger(finger)), theme::body()))
            .into_iter()
            .fold(0.0, f32::max);
        let wanted = 5.0 * (widest + 2.0 * theme::GAP);
        let mut row = head;
        let mut font = theme::small();
        if head.width() >= title_width + wanted {
            Label::new(title, look.palette.text)
                .font(theme::title())
                .put(ui, head);
            row.min.x = row.max.x - wanted;
            font = theme::body();
        }
        let width = row.width() / 5.0;
        for (finger, at) in Finger::ALL.into_iter().zip(0u8..) {
            let left = row.left() + width * f32::from(at);
            let place = Rect::from_min_size(pos2(left, row.top()), vec2(width, row.height()));
            let name = look.say(words::finger(finger));
            let label = format!("{title}: {name}");
            let button = Button::new(name, look.say(panels::TIP_TIP))
                .named(&label)
                .choice(self.finger == finger);
            let id = Id::unique(("tip", finger));
            if button.ground(ui, look, place, id).clicked() {
                self.finger = finger;
            }
            let color = button.text_color(look);
            controls::paint_text(ui, place, Align2::CENTER_CENTER, name, font.clone(), color);
        }
    }

    fn block<'a>(&self, pane: &Pane<'a>) -> (Option<&'a TactileBlock>, Freshness) {
        let block = pane.state.sample.tactile[self.finger].as_ref();
        let freshness = pane.freshness(block.map(|block| block.asked));
        (block.map(|block| &block.value), freshness)
    }

    /// Looking onto the fingertip, tip up: the ring is the friction, the dot the force as it is now.
    fn compass_ui(&self, ui: &Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let palette = look.palette;
        let (center, radius) = (rect.center(), rect.width() / 2.0 - theme::STEP);
        let painter = ui.painter();
        painter.circle(
            center,
            radius,
            palette.sunken,
            Stroke::new(1.0, palette.edge),
        );
        for turn in 0..4u8 {
            let way = Vec2::angled(f32::from(turn) * std::f32::consts::FRAC_PI_2);
            painter.line_segment(
                [center, center + way * radius],
                Stroke::new(1.0, palette.grid),
            );
        }
        let ring = radius / COMPASS_END;
        painter.circle(
            center,
            ring,
            palette.wash(palette.ok),
            Stroke::new(1.5, palette.ok),
        );
        painter.circle_stroke(center, ring * NEAR, Stroke::new(1.0, palette.grid));
        let up = Rect::from_center_size(center - vec2(0.0, radius - theme::GAP), vec2(40.0, 12.0));
        let text = look.say(panels::TIP_UP);
        controls::paint_text(
            ui,
            up,
            Align2::CENTER_CENTER,
            text,
            theme::tiny(),
            palette.faint,
        );
        let (block, freshness) = self.block(pane);
        let (Grip::Ratio(ratio), Some(block)) = (Grip::of(block), block) else {
            return;
        };
        let Some(degrees) = block.direction_deg() else {
            return;
        };
        let color = look.value(freshness, self.grip_color(pane));
        let (sin, cos) = f32::from(degrees).to_radians().sin_cos();
        let part = (ratio / self.friction().max(0.01)).min(COMPASS_END);
        needle(painter, center, vec2(sin, -cos) * (ring * part), color);
    }

    fn grip_color(&self, pane: &Pane<'_>) -> egui::Color32 {
        let palette = pane.look.palette;
        match Grip::of(self.block(pane).0).margin(self.friction()) {
            None => palette.faint,
            Some(margin) if margin <= 0.0 => palette.bad,
            Some(margin) if margin <= 1.0 - NEAR => palette.warn,
            Some(_) => palette.ok,
        }
    }

    fn readings_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let mut rest = rect;
        let (block, freshness) = self.block(pane);
        let grip = Grip::of(block);
        let friction = self.friction();
        let newtons = |value: Option<f32>| format!("{} N", format::newtons(value));
        let ratio = match grip {
            Grip::Ratio(ratio) => format!("{ratio:.2}"),
            Grip::Unknown | Grip::Loose => format::UNKNOWN.into(),
        };
        let margin = grip.margin(friction).map_or_else(
            || format::UNKNOWN.to_owned(),
            |margin| format!("{:.0} %", margin * 100.0),
        );
        let plain = look.palette.text;
        let rows: [(Text, String, egui::Color32); 4] = [
            (
                panels::TIP_NORMAL,
                newtons(block.map(|block| block.normal_n)),
                plain,
            ),
            (
                panels::TIP_SHEAR,
                newtons(block.map(|block| block.tangential_n)),
                plain,
            ),
            (panels::TIP_RATIO, ratio, plain),
            (panels::TIP_MARGIN, margin, self.grip_color(pane)),
        ];
        let row = (rect.height() / 6.0).min(theme::CONTROL);
        for (caption, value, color) in &rows {
            let place = controls::take_top(&mut rest, row);
            rest.min.y -= theme::GAP;
            Label::new(look.say(*caption), look.palette.muted)
                .small()
                .put(ui, place);
            Label::new(value, look.value(freshness, *color))
                .number()
                .right()
                .named(look.say(*caption))
                .put(ui, place);
        }
        let said = self.verdict(grip, freshness);
        let place = controls::take_top(&mut rest, row);
        rest.min.y -= theme::GAP;
        let color = look.value(freshness, self.grip_color(pane));
        Label::new(look.say(said), color).put(ui, place);
        self.friction_ui(ui, rest.with_max_y(rest.top() + row), look);
    }

    fn verdict(&self, grip: Grip, freshness: Freshness) -> Text {
        match (grip, grip.margin(self.friction())) {
            _ if freshness == Freshness::Unknown => panels::TIP_UNKNOWN,
            (Grip::Unknown, _) => panels::TIP_UNKNOWN,
            (Grip::Loose, _) => panels::TIP_LOOSE,
            (_, Some(margin)) if margin <= 0.0 => panels::TIP_SLIPS,
            (_, Some(margin)) if margin <= 1.0 - NEAR => panels::TIP_NEAR,
            _ => panels::TIP_HOLDS,
        }
    }

    fn friction_ui(&mut self, ui: &mut Ui, rect: Rect, look: Look) {
        let caption = format!("{} {:.2}", look.say(panels::TIP_FRICTION), self.friction());
        let width = controls::text_width(ui, &caption, theme::small()) + theme::GAP;
        let (left, right) = rect.split_left_right_at_x(rect.left() + width);
        Label::new(&caption, look.palette.muted)
            .small()
            .put(ui, left);
        let track = Track {
            name: look.say(panels::TIP_FRICTION_NAME),
            tip: look.say(panels::TIP_FRICTION_TIP),
            disabled: None,
            max: FRICTION_MAX,
            step: 1,
            target: Some(self.friction_percent),
            actual: None,
            draws: Actual::Bar,
            color: look.palette.accent,
            tick: Some(FRICTION_PERCENT),
            rough_from: None,
            peak: None,
        };
        if let Some(percent) = track.put(ui, look, right, Id::unique("tip friction")) {
            self.friction_percent = percent.max(1);
        }
    }

    fn forces_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let palette = look.palette;
        let mut body = rect;
        let legend = controls::take_top(&mut body, 14.0);
        body.min.y -= theme::STEP;
        let lines = [
            (
                Touch::Normal,
                panels::TIP_NORMAL,
                palette.dof[self.finger.bend()],
            ),
            (Touch::Tangential, panels::TIP_SHEAR, palette.muted),
        ];
        let mut left = legend;
        for (_, text, color) in lines {
            let text = format!("{}, N", look.say(text));
            let width = controls::text_width(ui, &text, theme::small());
            let place = controls::take_left(&mut left, width + theme::PAD);
            let dash = pos2(place.left(), place.center().y);
            ui.painter().line_segment(
                [dash, dash + vec2(theme::GAP, 0.0)],
                Stroke::new(2.0, color),
            );
            Label::new(&text, palette.muted)
                .small()
                .put(ui, place.with_min_x(place.left() + theme::PAD));
        }
        ui.painter().rect_filled(body, 0.0, palette.sunken);
        let now = pane.state.now.secs();
        let span = (now - SECONDS, now);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to what a screen has"
        )]
        let columns = body.width().clamp(1.0, 8192.0) as usize;
        let history = &pane.state.history;
        let mut end = FORCE_END;
        for (touch, _, _) in lines {
            history.trace(
                Series::Tip(touch, self.finger),
                span.0,
                span.1,
                columns,
                &mut self.trace,
            );
            end = self
                .trace
                .points()
                .map(|point| point[1])
                .fold(end, f64::max);
        }
        let top = Rect::from_min_size(body.min + vec2(theme::STEP, 0.0), vec2(60.0, 14.0));
        for (touch, _, color) in lines {
            history.trace(
                Series::Tip(touch, self.finger),
                span.0,
                span.1,
                columns,
                &mut self.trace,
            );
            for segment in &self.trace.segments {
                let points = segment
                    .iter()
                    .map(|[at_s, value]| place_of(body, (at_s - span.0) / SECONDS, value / end))
                    .collect();
                let painter = ui.painter_at(body);
                painter.add(Shape::line(points, Stroke::new(theme::LINE, color)));
            }
        }
        Label::new(&format!("{end:.1}"), palette.faint)
            .font(theme::number_small())
            .put(ui, top);
    }
}

fn needle(painter: &Painter, from: Pos2, by: Vec2, color: egui::Color32) {
    painter.line_segment([from, from + by], Stroke::new(2.5, color));
    painter.circle_filled(from + by, theme::LAMP + 1.0, color);
}

/// A point of a plot by its shares of width and height.
fn place_of(rect: Rect, across: f64, up: f64) -> Pos2 {
    #[expect(clippy::cast_possible_truncation, reason = "shares of a screen")]
    let (across, up) = (across as f32, up as f32);
    pos2(
        rect.left() + rect.width() * across,
        rect.bottom() - rect.height() * up * 0.94,
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    fn block(normal_n: f32, tangential_n: f32) -> TactileBlock {
        let mut block = TactileBlock::decode(&[0; 58]).unwrap();
        block.normal_n = normal_n;
        block.tangential_n = tangential_n;
        block
    }

    #[test]
    fn the_margin_is_what_friction_leaves() {
        let grip = Grip::of(Some(&block(4.0, 1.0)));
        assert_eq!(grip, Grip::Ratio(0.25));
        assert_eq!(grip.margin(0.5), Some(0.5));
        assert!(grip.margin(0.2).unwrap() < 0.0);
        assert_eq!(grip.margin(0.0), None);
    }

    #[test]
    fn without_contact_or_sense_there_is_no_margin() {
        assert_eq!(Grip::of(Some(&block(0.05, 1.0))), Grip::Loose);
        assert_eq!(Grip::of(Some(&block(f32::NAN, 1.0))), Grip::Unknown);
        assert_eq!(Grip::of(None).margin(0.5), None);
    }
}
