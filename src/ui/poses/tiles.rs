//! Poses as tiles with a drawn hand, in the library and in the overview's strip. Starts nothing by itself.

use crate::app::action::Action;
use crate::hand::{Angle, Dof, Gesture, GestureRoute, PerDof};
use crate::poses::edit::{LibraryEdit, PoseEdit};
use crate::poses::library::Pose;
use crate::ui::hand::panel;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_right};
use crate::ui::kit::look::{Look, Pane};
use crate::ui::kit::reorder;
use crate::ui::text::{main, panels, poses};
use crate::ui::theme;
use egui::{Align2, Id, Pos2, Rect, Ui, Vec2, pos2, vec2};

/// Width and least height of a pose in the overview: a finger's breadth.
const STRIP_TILE: Vec2 = theme::STRIP_TILE;

/// Shares of the way to open.
pub(crate) fn shares(angles: &PerDof<Angle>) -> PerDof<Option<f32>> {
    PerDof::from_fn(|dof| Some(f32::from(angles[dof].get()) / 1000.0))
}

/// Why this pose cannot be taken now.
pub(crate) fn refusal(pane: &Pane<'_>, pose: &Pose) -> Option<&'static str> {
    if let Some(unready) = pane.unready() {
        return Some(unready);
    }
    let moves = |dof: Dof| !pose.leave[dof] && !pane.state.hand().joints[dof].locked;
    let any = Dof::ALL.into_iter().any(moves);
    (!any).then(|| pane.look.say(main::LOCKED))
}

/// Why no gesture can be started now.
pub(crate) fn gesture_refusal(pane: &Pane<'_>) -> Option<&'static str> {
    if pane.state.settings.gesture_route == GestureRoute::Off {
        return Some(pane.look.say(panels::GESTURES_OFF));
    }
    pane.unready()
}

/// A button that takes a pose.
pub(crate) fn go_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    pose: &Pose,
    place: &'static str,
) {
    let look = pane.look;
    let name = format!("{} {}", look.say(poses::RECALL_NAME), pose.name);
    let button = Button::new(look.say(poses::RECALL), look.say(poses::RECALL_TIP))
        .named(&name)
        .disabled(refusal(pane, pose))
        .weight(Weight::Strong);
    if button
        .put(ui, look, rect, Id::unique((place, pose.id)))
        .clicked()
    {
        pane.actions.push(Action::Recall(pose.id));
    }
}

/// A tile of the library: picture, name, tags. True if it was chosen.
pub(crate) fn tile_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    pose: &Pose,
    chosen: bool,
) -> bool {
    let look = pane.look;
    let name = format!("{} {}", look.say(poses::POSE), pose.name);
    let mut button = Button::new(&pose.name, look.say(poses::SELECT_TIP)).named(&name);
    button.selected = Some(chosen);
    if chosen {
        button.weight = Weight::Chosen;
    }
    let (top, foot) = rect.split_top_bottom_at_y(rect.bottom() - theme::CONTROL - theme::STEP);
    let response = button.ground(ui, look, top, Id::unique(("pose", pose.id)));
    if response.clicked() {
        // So that Alt and the arrow keys move it from here.
        response.request_focus();
    }
    if let Some(way) = reorder::keyed(ui, &response) {
        let edit = LibraryEdit::Pose(pose.id, PoseEdit::Shift(way));
        pane.actions.push(Action::Library(edit));
    }
    let (picture, words) = top.split_top_bottom_at_y(top.bottom() - theme::POSE_WORDS);
    panel::pose_ui(ui, look, picture.shrink(theme::STEP), &shares(&pose.angles));
    let words = words.shrink2(vec2(theme::GAP, 0.0));
    let (upper, lower) = words.split_top_bottom_at_fraction(0.5);
    let center = Align2::CENTER_CENTER;
    controls::paint_text(
        ui,
        upper,
        center,
        &pose.name,
        theme::body(),
        look.palette.text,
    );
    let tags = pose.tags.join(" · ");
    let about = if tags.is_empty() {
        format!("{} · {} g", pose.speed.get(), pose.force.get())
    } else {
        tags
    };
    controls::paint_text(
        ui,
        lower,
        center,
        &about,
        theme::small(),
        look.palette.muted,
    );
    let foot = foot.with_min_y(foot.top() + theme::STEP);
    go_ui(ui, foot, pane, pose, "tile");
    response.clicked()
}

/// The overview's strip: the person's poses first, then named gestures, then the other numbers. True if all are wanted.
pub(crate) fn strip_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) -> bool {
    let look = pane.look;
    let title = look.say(poses::STRIP);
    let (mut head, body) = controls::titled_card(ui, look, rect, title);
    let text = look.say(poses::EVERY);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let all = Button::new(text, look.say(poses::EVERY_TIP));
    let place = take_right(&mut head, width);
    let opened = all.put(ui, look, place, Id::unique("all poses")).clicked();
    let wanted = Button::new(look.say(poses::CAPTURE), look.say(poses::CAPTURE_TIP));
    capture_button(ui, &mut head, pane, wanted);
    let gap = theme::STEP;
    let rows = ((body.height() + gap) / (STRIP_TILE.y + gap))
        .floor()
        .max(1.0);
    let height = (body.height() - gap * (rows - 1.0)) / rows;
    let mut flow = Flow::new(body, height, gap);
    let state = pane.state;
    for pose in &state.poses.library.poses {
        let Some(place) = flow.take(STRIP_TILE.x) else {
            return opened;
        };
        small_tile_ui(ui, place, pane, pose);
    }
    if state.poses.library.poses.is_empty() && rows > 1.0 {
        let hint = look.say(poses::STRIP_EMPTY);
        if let Some(place) = flow.take(body.width()) {
            Label::new(hint, look.palette.faint).put(ui, place);
        }
    }
    let (named, others): (Vec<Gesture>, Vec<Gesture>) =
        Gesture::all().partition(|gesture| state.settings.gesture_name(*gesture).is_some());
    if rows > 1.0 {
        flow.next_row();
    }
    let caption = look.say(poses::STRIP_GESTURES);
    let width = controls::text_width(ui, caption, theme::small()) + theme::GAP;
    if let Some(place) = flow.take(width) {
        let color = look.palette.muted;
        Label::new(caption, color).small().put(ui, place);
    }
    for gesture in named.into_iter().chain(others) {
        let name = state.settings.gesture_name(gesture).unwrap_or_default();
        let Some(place) = flow.take(gesture_width(ui, name)) else {
            break;
        };
        gesture_tile_ui(ui, place, pane, gesture);
    }
    opened
}

/// Places one after another, row by row, until there is no more room.
struct Flow {
    body: Rect,
    at: Pos2,
    height: f32,
    gap: f32,
}

impl Flow {
    const fn new(body: Rect, height: f32, gap: f32) -> Self {
        Self {
            body,
            at: body.min,
            height,
            gap,
        }
    }

    /// The next row, unless this one is empty.
    fn next_row(&mut self) {
        if self.at.x > self.body.left() {
            self.at = pos2(self.body.left(), self.at.y + self.height + self.gap);
        }
    }

    /// A place of this width; none once there is no room.
    fn take(&mut self, width: f32) -> Option<Rect> {
        if self.at.x + width > self.body.right() + 0.5 {
            self.next_row();
        }
        let fits = self.at.y + self.height <= self.body.bottom() + 0.5;
        let place = Rect::from_min_size(self.at, vec2(width, self.height));
        self.at.x += width + self.gap;
        fits.then_some(place)
    }
}

/// What a gesture's name and number take; a number alone is a square at least a finger wide.
fn gesture_width(ui: &Ui, name: &str) -> f32 {
    if name.is_empty() {
        return theme::GESTURE_TILE;
    }
    let name = controls::text_width(ui, name, theme::body());
    name + theme::GESTURE_NUMBER + 2.0 * theme::GAP + 1.0
}

/// Keeps the pose of now.
pub(crate) fn capture_button(
    ui: &mut Ui,
    head: &mut Rect,
    pane: &mut Pane<'_>,
    button: Button<'_>,
) {
    let look = pane.look;
    let width = controls::text_width(ui, button.text, theme::body()) + 2.0 * theme::PAD;
    let unknown = pane.state.hand().pose_now().is_none();
    let button = button.disabled(unknown.then(|| look.say(poses::CAPTURE_UNKNOWN)));
    let place = take_right(head, width);
    if button.put(ui, look, place, Id::unique("capture")).clicked() {
        let name = look.say(poses::POSE).to_owned();
        pane.actions.push(Action::Capture(name));
    }
}

fn small_tile_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, pose: &Pose) {
    let look = pane.look;
    let name = format!("{} {}", look.say(poses::RECALL_NAME), pose.name);
    let button = Button::new(&pose.name, look.say(poses::RECALL_TIP))
        .named(&name)
        .disabled(refusal(pane, pose));
    let response = button.ground(ui, look, rect, Id::unique(("go", pose.id)));
    let (picture, words) = rect.split_left_right_at_x(rect.left() + rect.height());
    panel::pose_ui(ui, look, picture.shrink(2.0), &shares(&pose.angles));
    let words = words.shrink2(vec2(theme::STEP, 0.0));
    let color = button.text_color(look);
    controls::paint_text(
        ui,
        words,
        Align2::LEFT_CENTER,
        &pose.name,
        theme::body(),
        color,
    );
    if response.clicked() {
        pane.actions.push(Action::Recall(pose.id));
    }
}

/// A gesture of the hand: its name, or its number.
pub(crate) fn gesture_tile_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, gesture: Gesture) {
    let look = pane.look;
    let name = pane
        .state
        .settings
        .gesture_name(gesture)
        .unwrap_or_default();
    let number = gesture.get().to_string();
    let label = format!("{} {number} {name}", look.say(panels::GESTURE));
    let tip = format!("{}\n{}", label.trim(), look.say(panels::GESTURE_RUN_TIP));
    let button = Button::new(&number, &tip)
        .named(label.trim())
        .disabled(gesture_refusal(pane));
    let response = button.ground(ui, look, rect, Id::unique(("gesture", gesture)));
    let color = button.text_color(look);
    gesture_text(ui, look, rect, &number, name, color);
    if response.clicked() {
        pane.actions.push(Action::Gesture(gesture));
    }
}

fn gesture_text(ui: &Ui, look: Look, rect: Rect, number: &str, name: &str, color: egui::Color32) {
    let inner = rect.shrink2(vec2(theme::GAP, 0.0));
    let (left, right) = (Align2::LEFT_CENTER, Align2::RIGHT_CENTER);
    if name.is_empty() {
        let center = Align2::CENTER_CENTER;
        controls::paint_text(ui, inner, center, number, theme::number(), color);
        return;
    }
    let (words, small) = inner.split_left_right_at_x(inner.right() - theme::GESTURE_NUMBER);
    controls::paint_text(ui, words, left, name, theme::body(), color);
    let font = theme::number_small();
    controls::paint_text(ui, small, right, number, font, look.palette.faint);
}
