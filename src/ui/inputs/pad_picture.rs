//! Picture of a gamepad: held controls are highlighted, sticks and triggers show their deflection, and rows beside it show the
//! action of each control. A click selects a control.

use crate::hand::Dof;
use crate::inputs::pad::input::FingerChoice;
use crate::inputs::pad::state::FULL;
use crate::inputs::pad::{ControlKind, PadAction, PadControl, PadMap, PadState};
use crate::ui::inputs::pad_places::{CANVAS, CAP, CAP_WAY, cross_middle, outline, place};
use crate::ui::kit::{Label, Look, focus_ring, text_width};
use crate::ui::text::inputs;
use crate::ui::theme;
use egui::{
    Align2, Color32, CornerRadius, Mesh, Pos2, Rect, Response, Role, Sense, Shape, Stroke,
    StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2,
};

/// Height of a row.
const ROW: f32 = 30.0;
/// Width of a control's symbol in its row, and of the amount at the row's end.
const BADGE: f32 = 40.0;
const AMOUNT: f32 = 46.0;
/// Minimum and maximum points per unit of the picture: large enough to hit with a finger, but no poster.
const SCALE: [f32; 2] = [0.75, 1.5];
/// Controls with rows on the left, from the top; all others are on the right.
const AT_LEFT: [PadControl; 9] = [
    PadControl::LeftTrigger,
    PadControl::LeftBumper,
    PadControl::LeftStick,
    PadControl::LeftStickPress,
    PadControl::Select,
    PadControl::DpadUp,
    PadControl::DpadLeft,
    PadControl::DpadRight,
    PadControl::DpadDown,
];
const AT_RIGHT: [PadControl; 10] = [
    PadControl::RightTrigger,
    PadControl::RightBumper,
    PadControl::Home,
    PadControl::Start,
    PadControl::North,
    PadControl::West,
    PadControl::East,
    PadControl::South,
    PadControl::RightStick,
    PadControl::RightStickPress,
];

/// Name of a pose, in files and in the window's language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct PoseName {
    /// Name in files and maps.
    pub(crate) name: String,
    /// Name on screen.
    pub(crate) shown: String,
}

/// Content of the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PadShown<'a> {
    /// State of the controls; `None` without a gamepad.
    pub(crate) state: Option<&'a PadState>,
    /// Actions of the controls.
    pub(crate) map: &'a PadMap,
    /// The control being edited.
    pub(crate) chosen: Option<PadControl>,
    /// Fingers that a trigger closes.
    pub(crate) fingers: FingerChoice,
    /// Poses that can be assigned to a button.
    pub(crate) poses: &'a [PoseName],
}

impl PadShown<'_> {
    /// Action of a control as text.
    pub(crate) fn does(&self, look: Look, action: &PadAction) -> String {
        let PadAction::Pose(name) = action else {
            return look.tr(inputs::action(action)).to_owned();
        };
        match self.poses.iter().find(|pose| pose.name == *name) {
            Some(pose) => look.fill(inputs::POSE, &[&pose.shown]),
            None => look.fill(inputs::NO_POSE, &[name]),
        }
    }

    fn is_held(&self, control: PadControl) -> bool {
        self.state.is_some_and(|state| state.is_held(control))
    }

    /// Deflection of a control from rest, 0..=1.
    fn amount(&self, control: PadControl) -> f32 {
        let Some(state) = self.state else { return 0.0 };
        match control.kind() {
            ControlKind::Button => f32::from(u8::from(state.is_held(control))),
            ControlKind::Trigger => share(state.trigger(control)),
            ControlKind::Stick => self.way(control).length().min(1.0),
        }
    }

    /// Deflection of a stick in screen directions, of length 1 at most.
    fn way(&self, stick: PadControl) -> Vec2 {
        let place = self.state.map(|state| state.stick(stick));
        let place = place.unwrap_or_default();
        let way = vec2(share(place.right), -share(place.up));
        way / way.length().max(1.0)
    }

    /// True if the control has an action.
    fn is_used(&self, control: PadControl) -> bool {
        *self.map.action(control) != PadAction::Nothing
    }
}

/// Draws the gamepad between the rows of its controls. Returns the control that was clicked.
pub(crate) fn pad_picture_ui(ui: &mut Ui, look: Look, shown: &PadShown<'_>) -> Option<PadControl> {
    let [left, right] = [&AT_LEFT[..], &AT_RIGHT].map(|side| PadRows::of(ui, look, shown, side));
    let [least, most] = SCALE;
    let room = ui.available_width() - left.width - right.width - 2.0 * theme::PAD;
    let scale = (room / CANVAS.width()).clamp(least, most);
    let row = ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing = vec2(theme::PAD, 2.0);
        let by_left = left.ui(ui, look, shown);
        let by_pad = pad_ui(ui, look, scale, shown);
        by_left.or(by_pad).or(right.ui(ui, look, shown))
    });
    row.inner
}

/// Rows of the controls on one side that have an action.
struct PadRows {
    rows: Vec<PadRow>,
    width: f32,
}

/// Row of one control, with its action.
struct PadRow {
    control: PadControl,
    words: String,
}

impl PadRows {
    fn of(ui: &Ui, look: Look, shown: &PadShown<'_>, side: &[PadControl]) -> Self {
        let used = side.iter().copied();
        let used = used.filter(|control| shown.is_used(*control) || shown.chosen == Some(*control));
        let rows = used.map(|control| PadRow {
            control,
            words: shown.does(look, shown.map.action(control)),
        });
        let rows: Vec<PadRow> = rows.collect();
        let words = rows.iter();
        let words = words.map(|row| text_width(ui, &row.words, theme::body()));
        let width = BADGE + words.fold(0.0, f32::max) + AMOUNT + 2.0 * theme::PAD;
        Self { rows, width }
    }

    fn ui(&self, ui: &mut Ui, look: Look, shown: &PadShown<'_>) -> Option<PadControl> {
        let size = vec2(self.width, ROW);
        let column = ui.vertical(|ui| {
            let mut clicked = None;
            for row in &self.rows {
                let response = ui.allocate_response(size, Sense::click());
                if named(&response, look, row.control, shown).clicked() {
                    clicked = Some(row.control);
                }
                row.paint(ui, look, shown, &response);
            }
            clicked
        });
        column.inner
    }
}

/// Sets the accessible name and tooltip of a control from its action.
fn named(response: &Response, look: Look, control: PadControl, shown: &PadShown<'_>) -> Response {
    let action = shown.map.action(control);
    let name = look.tr(inputs::control(control));
    let words = look.pair(name, &shown.does(look, action));
    let is_chosen = shown.chosen == Some(control);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_chosen, &words));
    let tips = [look.tip(inputs::action(action)), look.tr(inputs::CHANGE)];
    let tips = [&[words.as_str()][..], &tips].concat().join("\n");
    let response = response.clone().on_hover_text(tips.replace("\n\n", "\n"));
    response.on_hover_cursor(egui::CursorIcon::PointingHand)
}

impl PadRow {
    /// Paints the control's symbol, action and deflection.
    fn paint(&self, ui: &Ui, look: Look, shown: &PadShown<'_>, response: &Response) {
        let (control, rect, palette) = (self.control, response.rect, look.palette);
        let ground = match (shown.chosen == Some(control), response.hovered()) {
            (true, _) => Some((palette.wash(palette.accent), palette.accent)),
            (false, true) => Some((palette.control, palette.edge)),
            (false, false) => None,
        };
        let round = CornerRadius::same(theme::ROUND_SMALL);
        if let Some((fill, edge)) = ground {
            let edge = Stroke::new(1.0, edge);
            ui.painter()
                .rect(rect, round, fill, edge, StrokeKind::Inside);
        }
        focus_ring(ui, look, response, rect);
        let rect = rect.shrink2(vec2(theme::STEP, 0.0));
        let (badge, rest) = rect.split_left_right_at_x(rect.left() + BADGE);
        let badge = Rect::from_center_size(badge.center(), vec2(BADGE, theme::CONTROL));
        let ink = Ink::of(look, control, shown);
        ui.painter()
            .rect(badge, round, ink.fill, ink.edge, StrokeKind::Inside);
        let badge_sign = Label::new(sign(control), ink.text).center();
        badge_sign.paint(ui, badge);
        let (text, amount) = rest.split_left_right_at_x(rest.right() - AMOUNT);
        let text = text.shrink2(vec2(theme::GAP, 0.0));
        let color = match shown.state {
            Some(_) => palette.text,
            None => palette.muted,
        };
        Label::new(&self.words, color).paint(ui, text);
        let percent = format!("{:.0} %", 100.0 * shown.amount(control));
        if control.kind() != ControlKind::Button && shown.state.is_some() {
            let label = Label::new(&percent, palette.muted).number().right();
            label.paint(ui, amount);
        }
    }
}

/// Symbol of a control, as printed on an Xbox pad.
const fn sign(control: PadControl) -> &'static str {
    match control {
        PadControl::South => "A",
        PadControl::East => "B",
        PadControl::West => "X",
        PadControl::North => "Y",
        PadControl::LeftBumper => "LB",
        PadControl::RightBumper => "RB",
        PadControl::LeftTrigger => "LT",
        PadControl::RightTrigger => "RT",
        PadControl::LeftStick => "LS",
        PadControl::RightStick => "RS",
        PadControl::LeftStickPress => "L3",
        PadControl::RightStickPress => "R3",
        PadControl::DpadUp => "\u{25B2}",
        PadControl::DpadDown => "\u{25BC}",
        PadControl::DpadLeft => "\u{25C0}",
        PadControl::DpadRight => "\u{25B6}",
        PadControl::Select => "\u{25C1}",
        PadControl::Start => "\u{2261}",
        PadControl::Home => "\u{25CB}",
    }
}

/// Colours of one control.
#[derive(Debug, Clone, Copy)]
struct Ink {
    fill: Color32,
    edge: Stroke,
    text: Color32,
}

impl Ink {
    /// Depends on action and state. STOP is always red, and the dead-man always has the colour of an armed hand.
    fn of(look: Look, control: PadControl, shown: &PadShown<'_>) -> Self {
        let palette = look.palette;
        let is_held = shown.is_held(control);
        let ink = |fill, edge, text| Self { fill, edge, text };
        let thin = |color| Stroke::new(1.0, color);
        let strong = |color| Stroke::new(theme::STRONG, color);
        if shown.state.is_none() {
            return ink(palette.card, thin(palette.edge), palette.faint);
        }
        match (shown.map.action(control), is_held) {
            (PadAction::Stop, false) => {
                ink(palette.stop, thin(palette.stop_edge), palette.on_strong)
            }
            (PadAction::Stop, true) => {
                ink(palette.stop_hover, strong(palette.text), palette.on_strong)
            }
            (PadAction::DeadMan, false) => ink(palette.sunken, strong(palette.armed), palette.text),
            (PadAction::DeadMan, true) => {
                ink(palette.armed, strong(palette.armed), palette.on_armed)
            }
            (_, true) => ink(palette.accent, thin(palette.accent), palette.on_accent),
            (PadAction::Nothing, false) => ink(palette.card, thin(palette.edge), palette.faint),
            (_, false) => ink(palette.sunken, thin(palette.faint), palette.text),
        }
    }
}

/// Draws the gamepad itself.
fn pad_ui(ui: &mut Ui, look: Look, scale: f32, shown: &PadShown<'_>) -> Option<PadControl> {
    let (rect, _) = ui.allocate_exact_size(CANVAS.size() * scale, Sense::hover());
    let drawing = PadPainter {
        ui,
        look,
        shown,
        origin: rect.min - CANVAS.min.to_vec2() * scale,
        scale,
    };
    // Parts behind the body are drawn first.
    let behind = [
        PadControl::LeftTrigger,
        PadControl::RightTrigger,
        PadControl::LeftBumper,
        PadControl::RightBumper,
    ];
    for control in behind {
        drawing.control(control);
    }
    drawing.body();
    for control in PadControl::ALL {
        if !behind.contains(&control) {
            drawing.control(control);
        }
    }
    if shown.state.is_none() {
        let (at, center) = (drawing.at(pos2(0.0, -115.0)), Align2::CENTER_CENTER);
        let (words, font) = (look.tr(inputs::NONE), theme::body());
        ui.painter()
            .text(at, center, words, font, look.palette.muted);
    }
    let mut clicked = None;
    for control in PadControl::ALL {
        let place = drawing.rect(place(control));
        // Round controls placed diagonally overlap in their corners.
        let inner = match control.kind() {
            ControlKind::Button => place.shrink(1.5),
            _ => place,
        };
        let id = ui.scope_id().with(("pad", control));
        let response = ui.interact(inner, id, Sense::click());
        let response = named(&response, look, control, shown);
        if response.clicked() {
            clicked = Some(control);
        }
        if shown.chosen == Some(control) || response.has_focus() || response.hovered() {
            let is_hovered = response.hovered();
            let width = if is_hovered { 1.0 } else { theme::STRONG };
            let stroke = Stroke::new(width, look.palette.accent);
            let round = CornerRadius::same(theme::ROUND);
            let outer = place.expand(4.0);
            ui.painter()
                .rect_stroke(outer, round, stroke, StrokeKind::Middle);
        }
    }
    clicked
}

/// Position and content of the drawing.
struct PadPainter<'a> {
    ui: &'a Ui,
    look: Look,
    shown: &'a PadShown<'a>,
    origin: Pos2,
    scale: f32,
}

impl PadPainter<'_> {
    fn at(&self, at: Pos2) -> Pos2 {
        self.origin + at.to_vec2() * self.scale
    }

    fn rect(&self, rect: Rect) -> Rect {
        Rect::from_min_max(self.at(rect.min), self.at(rect.max))
    }

    fn body(&self) {
        let palette = self.look.palette;
        let outline: Vec<Pos2> = outline().into_iter().map(|at| self.at(at)).collect();
        self.ui.painter().add(filled(&outline, palette.control));
        let edge = Stroke::new(theme::FOCUS_LINE, palette.faint);
        self.ui.painter().add(Shape::closed_line(outline, edge));
        let middle = self.rect(cross_middle()).expand(1.0);
        self.ui.painter().rect_filled(middle, 0.0, palette.sunken);
    }

    fn control(&self, control: PadControl) {
        let ink = Ink::of(self.look, control, self.shown);
        let rect = self.rect(place(control));
        match control {
            PadControl::LeftTrigger | PadControl::RightTrigger => self.trigger(control, rect, ink),
            PadControl::LeftStick | PadControl::RightStick => self.stick(control, rect, ink),
            PadControl::South
            | PadControl::East
            | PadControl::West
            | PadControl::North
            | PadControl::Home => {
                let radius = rect.width() / 2.0;
                let painter = self.ui.painter();
                painter.circle(rect.center(), radius, ink.fill, ink.edge);
                self.sign(control, rect, ink.text);
            }
            PadControl::LeftBumper | PadControl::RightBumper => {
                self.plate(rect, 8.0, ink);
                // Its lower edge is behind the body.
                self.sign(control, rect.translate(vec2(0.0, -1.0)), ink.text);
            }
            _ => {
                self.plate(rect, 5.0, ink);
                self.sign(control, rect, ink.text);
            }
        }
    }

    fn plate(&self, rect: Rect, round: f32, ink: Ink) {
        let (painter, round) = (self.ui.painter(), round * self.scale);
        painter.rect(rect, round, ink.fill, ink.edge, StrokeKind::Inside);
    }

    fn sign(&self, control: PadControl, rect: Rect, color: Color32) {
        let font = theme::small();
        let center = Align2::CENTER_CENTER;
        self.ui
            .painter()
            .text(rect.center(), center, sign(control), font, color);
    }

    /// Draws a trigger, filled from the bottom by its deflection.
    fn trigger(&self, control: PadControl, rect: Rect, ink: Ink) {
        let palette = self.look.palette;
        self.plate(rect, 10.0, ink);
        let amount = self.shown.amount(control);
        if amount > 0.0 {
            let inner = rect.shrink(2.0);
            let level = egui::lerp(inner.bottom()..=inner.top(), amount);
            let full = inner.with_min_y(level);
            let painter = self.ui.painter().with_clip_rect(full);
            let fill = palette.accent.gamma_multiply(0.35);
            painter.rect_filled(inner, 9.0 * self.scale, fill);
            let line = Stroke::new(theme::STRONG, palette.accent);
            let painter = self.ui.painter();
            painter.hline(inner.x_range().shrink(1.0), level, line);
        }
        self.sign(control, rect, ink.text);
    }

    /// Draws a cap that moves in its well.
    fn stick(&self, control: PadControl, rect: Rect, ink: Ink) {
        let (palette, painter) = (self.look.palette, self.ui.painter());
        let (center, radius) = (rect.center(), rect.width() / 2.0);
        painter.circle(center, radius, palette.sunken, ink.edge);
        match self.shown.map.action(control) {
            PadAction::ChooseFingers => self.fingers(center, radius),
            PadAction::RotateThumb => self.both_ways(center, radius),
            _ => {}
        }
        let way = self.shown.way(control);
        let cap = center + CAP_WAY * self.scale * way;
        let press = match control {
            PadControl::LeftStick => PadControl::LeftStickPress,
            _ => PadControl::RightStickPress,
        };
        let is_moved = way.length() > 0.0;
        let (fill, text) = match (self.shown.is_held(press), is_moved) {
            (true, _) => (palette.accent, palette.on_accent),
            (false, true) => (palette.control_hover, palette.text),
            (false, false) => (palette.control, ink.text),
        };
        let edge = if is_moved {
            Stroke::new(theme::STRONG, palette.accent)
        } else {
            Stroke::new(1.0, palette.faint)
        };
        painter.circle(cap, CAP * self.scale, fill, edge);
        let sign_at = Rect::from_center_size(cap, Vec2::ZERO);
        self.sign(control, sign_at, text);
    }

    /// Draws four arcs around a stick in the colours of the fingers; those closed by a trigger are bold.
    fn fingers(&self, center: Pos2, radius: f32) {
        let palette = self.look.palette;
        for (finger, middle) in [
            (Dof::Index, 180.0_f32),
            (Dof::Middle, 270.0),
            (Dof::Ring, 0.0),
            (Dof::Little, 90.0),
        ] {
            let fingers = self.shown.fingers;
            let is_on = [FingerChoice::All, FingerChoice::One(finger)].contains(&fingers);
            let (width, strength) = if is_on && self.shown.state.is_some() {
                (4.0, 1.0)
            } else {
                (2.0, 0.45)
            };
            let color = palette.dof[finger].gamma_multiply(strength);
            let points = (-6..=6_i8).map(|step| {
                let angle = (middle + 6.0 * f32::from(step)).to_radians();
                center + Vec2::angled(angle) * (radius - 4.5)
            });
            let line = Stroke::new(width, color);
            self.ui.painter().add(Shape::line(points.collect(), line));
        }
    }

    /// Draws arrows for a stick that is pushed left and right.
    fn both_ways(&self, center: Pos2, radius: f32) {
        let color = self.look.palette.dof[Dof::ThumbRotate];
        for side in [-1.0, 1.0] {
            let tip = center + vec2(side * (radius - 2.5), 0.0);
            let back = vec2(-side * 6.0, 0.0);
            let corners = vec![
                tip,
                tip + back + vec2(0.0, 5.0),
                tip + back - vec2(0.0, 5.0),
            ];
            let shape = Shape::convex_polygon(corners, color, Stroke::NONE);
            self.ui.painter().add(shape);
        }
    }
}

/// Fills a closed outline row by row, because egui fills only convex shapes. The outline's own stroke hides the steps.
fn filled(outline: &[Pos2], color: Color32) -> Mesh {
    let bounds = Rect::from_points(outline);
    let mut mesh = Mesh::default();
    let mut top = bounds.top();
    while top < bounds.bottom() {
        let bottom = (top + 1.0).min(bounds.bottom());
        let middle = (top + bottom) / 2.0;
        let next = outline.iter().cycle().skip(1);
        let edges = outline.iter().zip(next);
        let mut crossed: Vec<f32> = edges
            .filter(|(one, other)| (one.y <= middle) != (other.y <= middle))
            .map(|(one, other)| one.x + (middle - one.y) / (other.y - one.y) * (other.x - one.x))
            .collect();
        crossed.sort_by(f32::total_cmp);
        for pair in crossed.chunks_exact(2) {
            if let [left, right] = pair {
                let row = Rect::from_min_max(pos2(*left, top), pos2(*right, bottom));
                mesh.add_colored_rect(row, color);
            }
        }
        top = bottom;
    }
    mesh
}

/// Converts thousandths to a share of one.
fn share(thousandths: i16) -> f32 {
    f32::from(thousandths) / f32::from(FULL)
}
