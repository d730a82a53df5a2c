//! Poses as tiles with a drawn hand, in the library and in the overview's strip. Starts nothing by itself.

use crate::app::action::Action;
use crate::app::hand::grip;
use crate::app::hand::list::HandsAction;
use crate::app::poses::PoseState;
use crate::app::state::State;
use crate::hand::{Angle, Dof, PerDof};
use crate::poses::Play;
use crate::poses::library::{EntryId, LibraryPose, StepGoal};
use crate::ui::hand::tile;
use crate::ui::kit::{self, Button, Label, Pane, ViewRequest, Weight};
use crate::ui::poses::gestures;
use crate::ui::poses::grip_size;
use crate::ui::poses::hold;
use crate::ui::text::{Text, main, poses, window};
use crate::ui::theme;
use crate::ui::view::View;
use egui::{Id, Rect, ScrollArea, Stroke, StrokeKind, Ui, vec2};

/// Size of an entry in the strip, and its minimum height.
const TILE: egui::Vec2 = vec2(96.0, 84.0);
const TILE_LEAST: f32 = 56.0;
/// Width from which on the title of the strip has room beside the buttons for several hands.
const TITLED: f32 = 740.0;
/// Height of a tile's name.
const NAME_HEIGHT: f32 = 20.0;

/// Angles as shares of the way to open.
pub(crate) fn shares(angles: &PerDof<Angle>) -> PerDof<Option<f32>> {
    PerDof::from_fn(|dof| Some(f32::from(angles[dof].get()) / 1000.0))
}

/// Reason why this pose cannot be sent now; `None` if it can.
fn refusal(pane: &Pane<'_>, pose: &LibraryPose) -> Option<&'static str> {
    if let Some(unready) = pane.unready() {
        return Some(unready);
    }
    let moves = |dof: Dof| !pose.leave[dof] && !pane.hand().controls.joints[dof].locked;
    let any = Dof::ALL.into_iter().any(moves);
    let pinches = pose.gap.is_none() || !grip::locks_pinch(pane.hand());
    (!any || !pinches).then(|| pane.look.tr(main::LOCKED))
}

/// Draws a tile of the library: picture, name, tags. True if it was clicked.
pub(crate) fn tile_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose, chosen: bool) -> bool {
    let (look, rect) = (pane.look, ui.max_rect());
    let name = look.tr_with(poses::POSE, &pose.name);
    let button = Button::new(&pose.name, look.tr(poses::SELECT_TIP))
        .named(&name)
        .switch(chosen);
    ui.spacing_mut().item_spacing.y = theme::STEP;
    let high = rect.height() - theme::CONTROL - theme::STEP;
    let (_, top) = ui.allocate_space(vec2(rect.width(), high));
    let id = Id::unique(("pose", pose.id));
    let response = button.ground(ui, look, top, id);
    let (picture, words) = top.split_top_bottom_at_y(top.bottom() - 36.0);
    tile::sign_ui(ui, look, picture.shrink(theme::STEP), &shares(&pose.angles));
    let (upper, lower) = words
        .shrink2(vec2(theme::GAP, 0.0))
        .split_top_bottom_at_fraction(0.5);
    let limits = format!("{} · {} g", pose.speed.get(), pose.force.get());
    let about = if let Some(gap) = pose.gap {
        format!("{} mm · {limits}", gap.mm())
    } else if pose.tags.is_empty() {
        limits
    } else {
        pose.tags.join(" · ")
    };
    let name = Label::new(&pose.name, look.palette.text).center();
    name.paint(ui, upper);
    let about = Label::new(&about, look.palette.muted).small().center();
    about.paint(ui, lower);
    start_ui(ui, pane, EntryId::Pose(pose.id));
    response.clicked()
}

/// Draws the overview's strip: the user's poses first, then the shipped ones.
pub(crate) fn strip_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    kit::card_ui(ui, look, |ui| {
        // With several hands there is one button more.
        let has_room = !pane.state.hands.is_several() || ui.available_width() >= TITLED;
        let title = if has_room { look.tr(poses::STRIP) } else { "" };
        kit::head_ui(ui, look, title, |ui| {
            let every = Button::text(look, poses::EVERY);
            every.navigate(ui, pane, ViewRequest::View(View::Poses));
            let tip = look.tip(poses::CAPTURE);
            capture_ui(ui, pane, Button::new(look.tr(poses::CAPTURE), tip));
            gestures::menu_ui(ui, pane);
            grip_size::drawer_ui(ui, pane);
            hold::drawer_ui(ui, pane);
            for_all_ui(ui, pane);
        });
        shelf_ui(ui, pane);
    });
}

/// Draws the tiles in as many rows as fit; further columns are reached by scrolling, also with the wheel.
fn shelf_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (state, gap) = (pane.state, theme::STEP);
    let entries = state.poses.ready(&state.settings.hidden_poses);
    let count = f32::from(u16::try_from(entries.len()).unwrap_or(u16::MAX));
    let room = ui.available_size();
    let fit = ((room + vec2(gap, gap)) / (TILE + vec2(gap, gap))).floor();
    let columns = (count / fit.y.max(1.0)).ceil().max(fit.x.min(count));
    let size = vec2(TILE.x, room.y.clamp(TILE_LEAST, TILE.y));
    ui.style_mut().always_scroll_the_only_direction = true;
    // No tile is cut off at the end.
    let whole = (TILE.x + gap) * fit.x.max(1.0);
    let area = ScrollArea::horizontal().auto_shrink(false);
    area.max_width(whole).id_salt("strip").show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(gap, gap);
        ui.set_width(columns * (TILE.x + gap));
        ui.horizontal_wrapped(|ui| {
            for entry in entries {
                entry_tile_ui(ui, pane, entry, size);
            }
        });
    });
}

/// With several hands, draws the switch that sends a pose or demo to all armed hands.
pub(crate) fn for_all_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let hands = &pane.state.hands;
    if hands.is_several() {
        let on = hands.poses_for_all();
        let switch = Button::text(pane.look, window::POSES_FOR_ALL).switch(on);
        let action = Action::Hands(HandsAction::PosesForAll(!on));
        switch.on_click(ui, pane, action);
    }
}

/// Draws a button that stores the current pose.
pub(crate) fn capture_ui(ui: &mut Ui, pane: &mut Pane<'_>, button: Button<'_>) {
    let look = pane.look;
    let unknown = pane.hand().pose_now(pane.state.now).is_none();
    let button = button.disabled(unknown.then(|| look.tr(poses::CAPTURE_UNKNOWN)));
    let name = look.tr(poses::POSE).to_owned();
    button.on_click(ui, pane, Action::Capture(name));
}

/// Draws the tile of an entry, with its picture, name and key. A press starts it, or ends it while it runs.
fn entry_tile_ui(ui: &mut Ui, pane: &mut Pane<'_>, entry: EntryId, size: egui::Vec2) {
    let (look, state) = (pane.look, pane.state);
    let name = look.entry_name(&state.poses, entry);
    let key = state.poses.named(entry).and_then(|names| names.key);
    let runs = runs(state, entry);
    let verb = verb(state, entry);
    let refused = entry_refusal(pane, entry);
    let tip = match entry {
        EntryId::Pose(_) => look.tip(poses::RECALL),
        _ => look.tip(verb),
    };
    // The name may be truncated on its tile.
    let mut tip = look.pair(name, tip);
    if let Some(key) = key {
        tip = format!("{tip}\nShift+{}", key.get());
    }
    let label = look.tr_with(verb, name);
    let weight = if runs { Weight::Chosen } else { Weight::Normal };
    let button = Button::new(name, &tip)
        .named(&label)
        .weight(weight)
        .disabled(refused);
    let (id, rect) = ui.allocate_space(size);
    let response = button.ground(ui, look, rect, id);
    let inner = rect.shrink(theme::STEP);
    let (picture, words) = inner.split_top_bottom_at_y(inner.bottom() - NAME_HEIGHT);
    if let Some(angles) = pictured(&state.poses, entry) {
        // Space for the marks in the corners.
        let picture = picture.shrink2(vec2(theme::GAP, 0.0));
        tile::sign_ui(ui, look, picture, &shares(&angles));
    }
    let color = button.text_color(look);
    let words = words.expand2(vec2(theme::BAR, 0.0));
    Label::new(name, color).small().center().paint(ui, words);
    if !matches!(entry, EntryId::Pose(_)) {
        let corner = Rect::from_min_size(picture.left_top(), vec2(16.0, 16.0));
        let icon = if runs { theme::PAUSE } else { theme::PLAY };
        kit::sign(ui, corner, icon, color);
    }
    if let Some(key) = key {
        let corner = Rect::from_min_size(picture.right_top() - vec2(14.0, 0.0), vec2(14.0, 16.0));
        let key = key.get().to_string();
        let label = Label::new(&key, look.palette.muted).small();
        label.right().paint(ui, corner);
    }
    if runs {
        let ring = Stroke::new(3.0, look.palette.accent);
        let round = theme::ROUND_SMALL;
        ui.painter()
            .rect_stroke(rect, round, ring, StrokeKind::Inside);
    }
    if response.clicked() {
        pane.actions.push(press(state, entry));
    }
}

fn runs(state: &State, entry: EntryId) -> bool {
    let run = state.hand().running.sequence();
    run.is_some_and(|run| run.entry == entry && run.is_running())
}

fn verb(state: &State, entry: EntryId) -> Text {
    match entry {
        EntryId::Pose(_) => poses::RECALL_NAME,
        _ if runs(state, entry) => poses::END,
        _ => poses::START,
    }
}

/// Reason why this entry cannot be started now; `None` if it can.
fn entry_refusal(pane: &Pane<'_>, entry: EntryId) -> Option<&'static str> {
    match entry {
        EntryId::Pose(id) => {
            let pose = pane.state.poses.pose(id)?;
            refusal(pane, pose)
        }
        _ => pane.unready(),
    }
}

/// Draws a button that starts an entry, or ends it while it runs.
pub(crate) fn start_ui(ui: &mut Ui, pane: &mut Pane<'_>, entry: EntryId) {
    let (look, state) = (pane.look, pane.state);
    let verb = verb(state, entry);
    let label = look.tr_with(verb, look.entry_name(&state.poses, entry));
    let text = match entry {
        EntryId::Pose(_) => poses::RECALL,
        _ => verb,
    };
    let button = Button::text(look, text)
        .named(&label)
        .disabled(entry_refusal(pane, entry))
        .weight(Weight::Strong);
    button.on_click(ui, pane, press(state, entry));
}

/// Action of a press on an entry: starts it, or ends it while it runs. A pose is sent again.
pub(crate) fn press(state: &State, entry: EntryId) -> Action {
    match entry {
        EntryId::Pose(id) => Action::Recall(id),
        _ if runs(state, entry) => Action::Play(Play::End),
        _ => Action::Play(Play::Start(entry)),
    }
}

/// Angles that represent an entry in pictures.
pub(crate) fn pictured(library: &PoseState, entry: EntryId) -> Option<PerDof<Angle>> {
    let pose = |id| library.pose(id).map(|pose| pose.angles);
    match entry {
        EntryId::Pose(id) => pose(id),
        EntryId::Sequence(id) => {
            let goals = library.sequence(id)?.steps.iter().map(|step| step.goal);
            // A hold of what the hand has is no picture.
            let goals: Vec<StepGoal> = goals
                .filter(|goal| !matches!(goal, StepGoal::Hold(_)))
                .collect();
            match *goals.get(goals.len() / 2)? {
                StepGoal::Pose(id) => pose(id),
                StepGoal::Gap { gap, .. } => Some(gap.angles()),
                StepGoal::Hold(_) => None,
            }
        }
        EntryId::Reaction(id) => pose(library.reaction(id)?.touched),
    }
}
