//! One pose of the library, large: its picture, name, tags, angles, speed and force. Every change is an action.

use crate::app::action::Action;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::poses::edit::{LibraryEdit, PoseEdit, Way};
use crate::poses::library::{NAME_CHARS_MAX, Pose};
use crate::ui::hand::panel;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left, take_right, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::kit::number::NumberField;
use crate::ui::kit::text_field::TextField;
use crate::ui::poses::tiles::{go_ui, shares};
use crate::ui::text::{Text, poses, words};
use crate::ui::theme;
use egui::{Id, Rect, Ui, vec2};

/// Characters of all tags.
const TAGS_MAX: usize = 120;

/// Draws the editor of one pose.
pub(crate) fn editor_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    typed: &mut Option<(Id, String)>,
    pose: &Pose,
) {
    let mut left = rect;
    let rows = 11.0;
    let fields = rows * (theme::CONTROL + theme::STEP) + theme::CONTROL_LARGE;
    let picture = take_top(
        &mut left,
        (rect.height() - fields - theme::GAP).clamp(theme::POSE_PICTURE.0, theme::POSE_PICTURE.1),
    );
    panel::pose_ui(ui, pane.look, picture, &shares(&pose.angles));
    let mut row = || {
        let row = take_top(&mut left, theme::CONTROL);
        left.min.y -= theme::STEP;
        row
    };
    for (caption, edit) in [(poses::NAME, true), (poses::TAGS, false)] {
        words_ui(ui, row(), pane, typed, (caption, edit, pose));
    }
    for dof in Dof::ALL {
        joint_ui(ui, row(), pane, pose, dof);
    }
    limits_ui(ui, row(), pane, pose);
    let (first, second) = (row(), row());
    order_ui(ui, first, second, pane, pose);
    let foot = left.with_max_y((left.top() + theme::CONTROL_LARGE).min(rect.bottom()));
    go_ui(ui, foot, pane, pose, "editor");
}

fn change(pane: &mut Pane<'_>, pose: &Pose, edit: PoseEdit) {
    let edit = LibraryEdit::Pose(pose.id, edit);
    pane.actions.push(Action::Library(edit));
}

fn words_ui(
    ui: &mut Ui,
    mut row: Rect,
    pane: &mut Pane<'_>,
    typed: &mut Option<(Id, String)>,
    (caption, is_name, pose): (Text, bool, &Pose),
) {
    let look = pane.look;
    let text = look.say(caption);
    Label::new(text, look.palette.muted).put(ui, take_left(&mut row, theme::POSE_CAPTION));
    let tags = pose.tags.join(", ");
    let field = TextField {
        name: text,
        hint: if is_name {
            ""
        } else {
            look.say(poses::TAGS_HINT)
        },
        value: if is_name { &pose.name } else { &tags },
        max: if is_name { NAME_CHARS_MAX } else { TAGS_MAX },
    };
    if let Some(text) = field.put(ui, typed, row, Id::unique((pose.id, is_name))) {
        let edit = if is_name {
            PoseEdit::Rename(text)
        } else {
            PoseEdit::Tags(text)
        };
        change(pane, pose, edit);
    }
}

fn joint_ui(ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, pose: &Pose, dof: Dof) {
    let look = pane.look;
    let leave = pose.leave[dof];
    let name = look.say(words::dof(dof));
    let text = look.say(poses::LEAVE);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let label = format!("{name} {text}");
    let button = Button::new(text, look.say(poses::LEAVE_TIP)).named(&label);
    let room = theme::POSE_CAPTION + theme::POSE_NUMBER + 3.0 * theme::GAP + width;
    row.max.x = row.right().min(row.left() + room);
    let place = take_right(&mut row, width);
    let id = Id::unique((pose.id, dof, "leave"));
    if button.choice(leave).put(ui, look, place, id).clicked() {
        change(pane, pose, PoseEdit::Leave(dof, !leave));
    }
    if let Some(angle) = angle_ui(ui, row, pane, ("pose", dof), Some(pose.angles[dof])) {
        change(pane, pose, PoseEdit::Angle(dof, angle));
    }
}

/// One joint's angle as a number behind its name; the number that was confirmed.
pub(crate) fn angle_ui(
    ui: &mut Ui,
    mut row: Rect,
    pane: &mut Pane<'_>,
    (of, dof): (&'static str, Dof),
    angle: Option<Angle>,
) -> Option<Angle> {
    let look = pane.look;
    let name = look.say(words::dof(dof));
    Label::new(name, look.palette.dof[dof]).put(ui, take_left(&mut row, theme::POSE_CAPTION));
    let label = format!("{name} {of} {}", look.say(poses::ANGLE));
    let field = NumberField {
        name: &label,
        tip: look.say(poses::ANGLE_TIP),
        disabled: None,
        value: angle.map(|angle| f64::from(angle.get())),
        range: 0.0..=1000.0,
        decimals: 0,
    };
    let place = take_left(&mut row, theme::POSE_NUMBER);
    let id = Id::unique((of, dof, "angle"));
    let typed = field.put(ui, look, pane.typing, place, id)?;
    Angle::new(whole(typed)).ok()
}

/// A typed whole number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a field lets only whole numbers of its range pass"
)]
pub(crate) const fn whole(number: f64) -> i64 {
    number as i64
}

fn limits_ui(ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>, pose: &Pose) {
    let look = pane.look;
    let mut number = |pane: &mut Pane<'_>, caption: Text, tip: Text, value: i16, max: f64| {
        let text = look.say(caption);
        let width = controls::text_width(ui, text, theme::body());
        Label::new(text, look.palette.muted).put(ui, take_left(&mut row, width));
        let label = format!("{} {text}", look.say(poses::POSE));
        let field = NumberField {
            name: &label,
            tip: look.say(tip),
            disabled: None,
            value: Some(f64::from(value)),
            range: 0.0..=max,
            decimals: 0,
        };
        let place = take_left(&mut row, theme::POSE_FIELD);
        field.put(
            ui,
            look,
            pane.typing,
            place,
            Id::unique((pose.id, caption.en)),
        )
    };
    let speed = number(
        pane,
        poses::SPEED,
        poses::SPEED_TIP,
        pose.speed.get(),
        1000.0,
    );
    let force = number(
        pane,
        poses::FORCE,
        poses::FORCE_TIP,
        pose.force.get(),
        3000.0,
    );
    if let Some(speed) = speed.and_then(|speed| Speed::new(whole(speed)).ok()) {
        change(pane, pose, PoseEdit::Speed(speed));
    }
    if let Some(force) = force.and_then(|force| Force::new(whole(force)).ok()) {
        change(pane, pose, PoseEdit::Force(force));
    }
}

fn order_ui(ui: &mut Ui, mut first: Rect, mut second: Rect, pane: &mut Pane<'_>, pose: &Pose) {
    let look = pane.look;
    let third = (first.width() - 2.0 * theme::GAP) / 3.0;
    let half = (first.width() - theme::GAP) / 2.0;
    let unknown = pane.state.hand().pose_now().is_none();
    let unknown = unknown.then(|| look.say(poses::CAPTURE_UNKNOWN));
    let recapture = Button::new(look.say(poses::RECAPTURE), look.say(poses::RECAPTURE_TIP));
    let id = |part: &'static str| Id::unique((pose.id, part));
    let place = take_left(&mut first, half);
    if recapture
        .disabled(unknown)
        .put(ui, look, place, id("recapture"))
        .clicked()
    {
        pane.actions.push(Action::Recapture(pose.id));
    }
    let duplicate = Button::new(look.say(poses::DUPLICATE), look.say(poses::DUPLICATE_TIP));
    if duplicate.put(ui, look, first, id("duplicate")).clicked() {
        change(pane, pose, PoseEdit::Duplicate);
    }
    for (text, tip, edit) in [
        (
            poses::EARLIER,
            poses::SHIFT_TIP,
            PoseEdit::Shift(Way::Earlier),
        ),
        (poses::LATER, poses::SHIFT_TIP, PoseEdit::Shift(Way::Later)),
        (poses::DELETE, poses::DELETE_TIP, PoseEdit::Delete),
    ] {
        let button = Button::new(look.say(text), look.say(tip));
        let place = take_left(&mut second, third);
        if button.put(ui, look, place, id(text.en)).clicked() {
            change(pane, pose, edit);
        }
    }
}

/// Six angles under each other, each to be typed; the new six if one was.
pub(crate) fn six_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    of: &'static str,
    angles: &PerDof<Option<Angle>>,
) -> Option<PerDof<Option<Angle>>> {
    let step = vec2(0.0, theme::CONTROL + theme::STEP);
    let mut row = rect.with_max_y(rect.top() + theme::CONTROL);
    let mut new = *angles;
    for dof in Dof::ALL {
        if let Some(angle) = angle_ui(ui, row, pane, (of, dof), angles[dof]) {
            new[dof] = Some(angle);
        }
        row = row.translate(step);
    }
    (new != *angles).then_some(new)
}
