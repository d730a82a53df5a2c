//! Poses as tiles with a drawn hand, in the library and in the overview's strip. Starts nothing by itself.

use crate::app::action::Action;
use crate::hand::{Angle, Dof, Gesture, GestureRoute, PerDof};
use crate::poses::library::LibraryPose;
use crate::ui::hand::panel;
use crate::ui::kit::{self, Button, Label, Opens, Pane, Weight};
use crate::ui::text::{main, panels, poses};
use crate::ui::theme;
use crate::ui::view::View;
use egui::{Id, Rect, Response, ScrollArea, Ui, UiBuilder, vec2};

/// Width and least height of a pose in the overview: a finger's breadth.
const STRIP_TILE: egui::Vec2 = vec2(132.0, 38.0);

/// Shares of the way to open.
pub(crate) fn shares(angles: &PerDof<Angle>) -> PerDof<Option<f32>> {
    PerDof::from_fn(|dof| Some(f32::from(angles[dof].get()) / 1000.0))
}

/// Why this pose cannot be taken now.
fn refusal(pane: &Pane<'_>, pose: &LibraryPose) -> Option<&'static str> {
    if let Some(unready) = pane.unready() {
        return Some(unready);
    }
    let moves = |dof: Dof| !pose.leave[dof] && !pane.state.hand().joints[dof].locked;
    let any = Dof::ALL.into_iter().any(moves);
    (!any).then(|| pane.look.say(main::LOCKED))
}

/// Why no gesture can be started now.
fn gesture_refusal(pane: &Pane<'_>) -> Option<&'static str> {
    if pane.state.settings.gesture_route == GestureRoute::Off {
        return Some(pane.look.say(panels::GESTURES_OFF));
    }
    pane.unready()
}

/// A button that takes a pose.
pub(crate) fn go_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let look = pane.look;
    let name = look.told(poses::RECALL_NAME, &pose.name);
    let button = Button::said(look, poses::RECALL)
        .named(&name)
        .disabled(refusal(pane, pose))
        .weight(Weight::Strong);
    button.sends(ui, pane, Action::Recall(pose.id));
}

/// A tile of the library: picture, name, tags. True if it was chosen.
pub(crate) fn tile_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    (pose, chosen): (&LibraryPose, bool),
) -> bool {
    let look = pane.look;
    let name = look.told(poses::POSE, &pose.name);
    let button = Button::new(&pose.name, look.say(poses::SELECT_TIP))
        .named(&name)
        .switch(chosen);
    let builder = UiBuilder::new().id_salt(pose.id).max_rect(rect);
    let mut ui = ui.new_child(builder.layout(egui::Layout::top_down_justified(egui::Align::Min)));
    ui.spacing_mut().item_spacing.y = theme::STEP;
    let high = rect.height() - theme::CONTROL - theme::STEP;
    let (_, top) = ui.allocate_space(vec2(rect.width(), high));
    let id = Id::unique(("pose", pose.id));
    let response = button.ground(&mut ui, look, top, id);
    let (picture, words) = top.split_top_bottom_at_y(top.bottom() - 36.0);
    panel::pose_ui(
        &ui,
        look,
        picture.shrink(theme::STEP),
        &shares(&pose.angles),
    );
    let (upper, lower) = words
        .shrink2(vec2(theme::GAP, 0.0))
        .split_top_bottom_at_fraction(0.5);
    let about = match pose.tags.is_empty() {
        true => format!("{} · {} g", pose.speed.get(), pose.force.get()),
        false => pose.tags.join(" · "),
    };
    let name = Label::new(&pose.name, look.palette.text).center();
    name.paint(&ui, upper);
    let about = Label::new(&about, look.palette.muted).small().center();
    about.paint(&ui, lower);
    go_ui(&mut ui, pane, pose);
    response.clicked()
}

/// The overview's strip: the person's poses first, then named gestures, then the other numbers.
pub(crate) fn strip_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    kit::card_ui(ui, look, |ui| {
        kit::head_ui(ui, look, look.say(poses::STRIP), |ui| {
            if Button::said(look, poses::EVERY).ui(ui, look).clicked() {
                pane.open(Opens::View(View::Poses));
            }
            let tip = look.tip(poses::CAPTURE);
            capture_ui(ui, pane, Button::new(look.say(poses::CAPTURE), tip));
        });
        let area = ScrollArea::vertical().auto_shrink(false);
        area.id_salt("strip").show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
            ui.spacing_mut().interact_size.y = theme::CONTROL_LARGE;
            ui.horizontal_wrapped(|ui| strip_tiles_ui(ui, pane));
        });
    });
}

fn strip_tiles_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, state) = (pane.look, pane.state);
    let library = &state.poses.library;
    if library.poses.is_empty() {
        Label::muted(look, poses::STRIP_EMPTY).ui(ui);
    }
    for pose in &library.poses {
        small_tile_ui(ui, pane, pose);
    }
    ui.end_row();
    let caption = look.say(poses::STRIP_GESTURES);
    Label::new(caption, look.palette.muted).small().ui(ui);
    let (named, others): (Vec<Gesture>, Vec<Gesture>) =
        Gesture::all().partition(|gesture| state.settings.gesture_name(*gesture).is_some());
    for gesture in named.into_iter().chain(others) {
        gesture_ui(ui, pane, gesture);
    }
}

/// Keeps the pose of now.
pub(crate) fn capture_ui(ui: &mut Ui, pane: &mut Pane<'_>, button: Button<'_>) {
    let look = pane.look;
    let unknown = pane.state.hand().pose_now().is_none();
    let button = button.disabled(unknown.then(|| look.say(poses::CAPTURE_UNKNOWN)));
    if button.ui(ui, look).clicked() {
        let name = look.say(poses::POSE).to_owned();
        pane.actions.push(Action::Capture(name));
    }
}

fn small_tile_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let look = pane.look;
    let name = look.told(poses::RECALL_NAME, &pose.name);
    let button = Button::new(&pose.name, look.tip(poses::RECALL))
        .named(&name)
        .disabled(refusal(pane, pose));
    let (id, rect) = ui.allocate_space(STRIP_TILE);
    let response = button.ground(ui, look, rect, id);
    let (picture, words) = rect.split_left_right_at_x(rect.left() + rect.height());
    panel::pose_ui(ui, look, picture.shrink(2.0), &shares(&pose.angles));
    let words = words.shrink2(vec2(theme::STEP, 0.0));
    Label::new(&pose.name, button.text_color(look)).paint(ui, words);
    if response.clicked() {
        pane.actions.push(Action::Recall(pose.id));
    }
}

/// A gesture of the hand: its name, or quietly its number.
pub(crate) fn gesture_ui(ui: &mut Ui, pane: &mut Pane<'_>, gesture: Gesture) -> Response {
    let look = pane.look;
    let known = pane.state.settings.gesture_name(gesture);
    let number = gesture.get().to_string();
    let label = format!(
        "{} {number} {}",
        look.say(panels::GESTURE),
        known.unwrap_or_default()
    );
    let tip = format!("{}\n{}", label.trim(), look.say(panels::GESTURE_RUN_TIP));
    let text = known.map_or_else(|| number.clone(), |name| format!("{name}  {number}"));
    let weight = match known {
        Some(_) => Weight::Normal,
        None => Weight::Quiet,
    };
    let response = Button::new(&text, &tip)
        .named(label.trim())
        .weight(weight)
        .disabled(gesture_refusal(pane))
        .large()
        .ui(ui, look);
    if response.clicked() {
        pane.actions.push(Action::Gesture(gesture));
    }
    response
}
