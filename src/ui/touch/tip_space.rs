//! The force on one fingertip in space: the plane of the pads, the normal, the friction cone, the force and its shadows.

use crate::ui::kit::controls;
use crate::ui::kit::format;
use crate::ui::kit::look::Look;
use crate::ui::text::{panels, touch as text};
use crate::ui::theme;
use crate::ui::touch::fingertip::Tip;
use egui::{
    Align2, Color32, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

/// Half the pads' width and length in the picture, as shares of its force scale.
const PLANE: (f32, f32) = (0.42, 0.52);
/// Ends of the force axis in newtons.
const ENDS: [f32; 5] = [1.0, 2.0, 5.0, 10.0, 20.0];
/// Corners of the drawn circle.
const CORNERS: u8 = 36;
/// What is drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Force<'a> {
    /// The fingertip.
    pub(crate) tip: Option<&'a Tip>,
    /// The chosen friction.
    pub(crate) friction: f32,
    /// Of the force, by how the grip stands.
    pub(crate) color: Color32,
}

/// Newtons to the screen: x right and y towards the tip in the pads' plane, z out of it.
struct Space {
    origin: Pos2,
    per_newton: f32,
}

impl Space {
    fn at(&self, x: f32, y: f32, z: f32) -> Pos2 {
        // Looked at from the right and above: the tip points into the picture.
        let (right, up) = (x * 0.90 + y * 0.42, y * 0.36 - x * 0.16 + z * 0.86);
        self.origin + vec2(right, -up) * self.per_newton
    }

    fn circle(&self, radius: f32, z: f32) -> Vec<Pos2> {
        let full = std::f32::consts::TAU;
        (0..CORNERS)
            .map(|corner| f32::from(corner) / f32::from(CORNERS) * full)
            .map(|turn| self.at(radius * turn.sin(), radius * turn.cos(), z))
            .collect()
    }
}

/// Draws it, and names it for those who cannot see it.
pub(crate) fn ui(ui: &mut Ui, look: Look, rect: Rect, id: egui::Id, force: Force<'_>) {
    let palette = look.palette;
    let response = ui.interact(rect, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, look.say(text::SPACE)));
    response.on_hover_text(look.say(text::SPACE_TIP));
    let painter = ui.painter_at(rect);
    painter.rect(
        rect,
        theme::STEP,
        palette.sunken,
        Stroke::new(1.0, palette.edge),
        egui::StrokeKind::Inside,
    );
    let normal = force.tip.and_then(|tip| tip.normal_n);
    let end = end_of(normal.unwrap_or(0.0));
    let side = rect.width().min(rect.height());
    let space = Space {
        origin: pos2(rect.center().x, rect.center().y + side * 0.24),
        per_newton: side * 0.60 / end,
    };
    axes(&painter, look, &space, end);
    write(
        ui,
        look,
        space.at(0.0, 0.0, end) + vec2(theme::AXIS_ASIDE, theme::STEP),
        &format!("{end:.0} N"),
    );
    write(
        ui,
        look,
        space.at(0.0, end * (PLANE.1 * 1.3), 0.0),
        look.say(panels::TIP_UP),
    );
    let Some(normal) = normal else {
        write(
            ui,
            look,
            rect.center_top() + vec2(0.0, theme::PAD),
            format::UNKNOWN,
        );
        return;
    };
    let normal = normal.clamp(0.0, end);
    cone(&painter, look, &space, normal, force.friction);
    let fade = if force.tip.is_some_and(|tip| tip.stale) {
        0.4
    } else {
        1.0
    };
    let color = force.color.gamma_multiply(fade);
    let (shear, direction) = force.tip.and_then(|tip| tip.shear).unwrap_or((0.0, 0.0));
    let (sin, cos) = direction.to_radians().sin_cos();
    let (x, y) = (shear.abs().min(end) * sin, shear.abs().min(end) * cos);
    let (zero, head) = (space.at(0.0, 0.0, 0.0), space.at(x, y, normal));
    let thin = Stroke::new(theme::THIN, palette.muted.gamma_multiply(fade));
    for (from, to) in [
        (space.at(x, y, 0.0), head),
        (space.at(0.0, 0.0, normal), head),
    ] {
        painter.extend(Shape::dashed_line(&[from, to], thin, 3.0, 3.0));
    }
    painter.line_segment(
        [zero, space.at(x, y, 0.0)],
        Stroke::new(2.0, palette.muted.gamma_multiply(fade)),
    );
    painter.line_segment([zero, head], Stroke::new(theme::NEEDLE, color));
    painter.circle_filled(head, theme::LAMP + 1.0, color);
}

/// The end of the axis that holds this force.
fn end_of(normal: f32) -> f32 {
    let [.., last] = ENDS;
    ENDS.into_iter().find(|end| normal <= *end).unwrap_or(last)
}

fn axes(painter: &Painter, look: Look, space: &Space, end: f32) {
    let palette = look.palette;
    let (x, y) = (end * PLANE.0, end * PLANE.1);
    let corners = [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| space.at(x, y, 0.0));
    painter.add(Shape::convex_polygon(
        corners.to_vec(),
        palette.skin,
        Stroke::new(1.0, palette.edge),
    ));
    let line = Stroke::new(1.0, palette.grid);
    painter.line_segment([space.at(-x, 0.0, 0.0), space.at(x, 0.0, 0.0)], line);
    painter.line_segment([space.at(0.0, -y, 0.0), space.at(0.0, y, 0.0)], line);
    painter.line_segment(
        [space.at(0.0, 0.0, 0.0), space.at(0.0, 0.0, end)],
        Stroke::new(1.0, palette.faint),
    );
}

/// What friction can hold at this normal force.
fn cone(painter: &Painter, look: Look, space: &Space, normal: f32, friction: f32) {
    let palette = look.palette;
    let rim = space.circle(normal * friction, normal);
    let apex = space.at(0.0, 0.0, 0.0);
    let sides = |point: &&Pos2| point.x;
    let left = rim
        .iter()
        .min_by(|a, b| sides(a).total_cmp(&sides(b)))
        .copied();
    let right = rim
        .iter()
        .max_by(|a, b| sides(a).total_cmp(&sides(b)))
        .copied();
    let stroke = Stroke::new(theme::THIN, palette.ok);
    for side in left.into_iter().chain(right) {
        painter.line_segment([apex, side], stroke);
    }
    painter.add(Shape::convex_polygon(rim, palette.wash(palette.ok), stroke));
}

fn write(ui: &Ui, look: Look, at: Pos2, words: &str) {
    let place = Rect::from_center_size(at, vec2(theme::AXIS_WIDTH, theme::AXIS_HEIGHT));
    controls::paint_text(
        ui,
        place,
        Align2::CENTER_CENTER,
        words,
        theme::tiny(),
        look.palette.faint,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_ends_beyond_the_force_and_not_far_beyond() {
        for (force, end) in [
            (0.0, 1.0),
            (1.5, 2.0),
            (7.0, 10.0),
            (19.0, 20.0),
            (300.0, 20.0),
        ] {
            assert!((end_of(force) - end).abs() < 1e-6, "{force}");
        }
    }

    #[test]
    fn each_axis_has_a_way_of_its_own_on_the_screen() {
        let space = Space {
            origin: Pos2::ZERO,
            per_newton: 10.0,
        };
        let ways = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)];
        let ways = ways.map(|(x, y, z)| space.at(x, y, z).to_vec2().normalized());
        let [right, tip, out] = ways;
        for (one, other) in [(right, tip), (tip, out), (right, out)] {
            assert!(one.dot(other).abs() < 0.85, "{one} and {other}");
        }
        assert!(right.x > 0.8 && tip.y < 0.0 && out.y < -0.9);
    }
}
