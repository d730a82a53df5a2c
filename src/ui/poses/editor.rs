//! Editor of a library pose: picture, name, tags, angles, speed and force. Every change is an action.

use crate::app::action::Action;
use crate::hand::gap::{Gap, gap_on_path};
use crate::hand::grip::GripThresholds;
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, Dof, Force, Speed};
use crate::poses::edit::{LibraryEdit, PoseEdit};
use crate::poses::library::{EntryId, LibraryPose, NAME_CHARS_MAX};
use crate::ui::hand::tile;
use crate::ui::kit::{Button, Label, NumberField, Pane, TextField};
use crate::ui::poses::sequence_view::FIRST_GAP_MM;
use crate::ui::poses::tiles::{shares, start_ui};
use crate::ui::text::{Text, hold, poses, tune, words};
use crate::ui::theme;
use egui::{ScrollArea, Ui, vec2};

/// Maximum characters of all tags.
const TAGS_MAX: usize = 120;
/// Width of the captions.
const CAPTION: f32 = 88.0;
/// Height of all fields below the picture.
const FIELDS: f32 = 13.0 * (theme::CONTROL + theme::STEP) + 2.0 * theme::CONTROL_LARGE;

/// Draws the editor of one pose.
pub(crate) fn editor_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let height = (ui.available_height() - FIELDS).clamp(48.0, 320.0);
    let (_, picture) = ui.allocate_space(vec2(ui.available_width(), height));
    tile::pose_ui(ui, pane.look, picture, &shares(&pose.angles));
    ScrollArea::vertical().id_salt(pose.id).show(ui, |ui| {
        words_ui(ui, pane, pose);
        ui.horizontal(|ui| gap_ui(ui, pane, pose));
        for dof in Dof::ALL {
            ui.horizontal(|ui| joint_ui(ui, pane, pose, dof));
        }
        ui.horizontal(|ui| limits_ui(ui, pane, pose));
        ui.horizontal(|ui| hold_ui(ui, pane, pose));
        order_ui(ui, pane, pose);
        ui.vertical_centered_justified(|ui| start_ui(ui, pane, EntryId::Pose(pose.id)));
    });
}

fn change(pane: &mut Pane<'_>, pose: &LibraryPose, edit: PoseEdit) {
    let edit = LibraryEdit::Pose(pose.id, edit);
    pane.actions.push(Action::Library(edit));
}

fn words_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let look = pane.look;
    let tags = pose.tags.join(", ");
    let rename: fn(String) -> PoseEdit = PoseEdit::Rename;
    for (caption, max, value, edit) in [
        (poses::NAME, NAME_CHARS_MAX, &pose.name, rename),
        (tune::TAGS, TAGS_MAX, &tags, PoseEdit::Tags),
    ] {
        ui.horizontal(|ui| {
            Label::muted(look, caption).cell_ui(ui, CAPTION);
            let field = TextField::new(look.tr(caption), max).hint(look.tip(caption));
            if let Some(text) = field.ui(ui, pane, value) {
                change(pane, pose, edit(text));
            }
        });
    }
}

/// Draws the switch for a pose by size, its gap, and the thresholds of its grip.
fn gap_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let look = pane.look;
    let by_size = Button::text(look, poses::BY_SIZE).choice(pose.gap.is_some());
    if by_size.ui(ui, look).clicked() {
        let counts = pose.angles.map(|angle| f32::from(angle.get()));
        let near = gap_on_path(&counts).unwrap_or(FIRST_GAP_MM);
        let gap = pose.gap.is_none().then(|| Gap::nearest(near.round()));
        change(pane, pose, PoseEdit::Gap(gap));
    }
    if let Some(gap) = pose.gap
        && let Some(gap) = gap_field_ui(ui, pane, gap)
    {
        change(pane, pose, PoseEdit::Gap(Some(gap)));
    }
    if let Some(thresholds) = &pose.thresholds {
        let words = look.fill(poses::TOLD_BY, &[&thresholds_words(thresholds)]);
        let label = Label::new(&words, look.palette.muted).ui(ui);
        label.on_hover_text(look.tip(poses::TOLD_BY));
    }
}

/// Draws a gap in mm. Returns it once confirmed.
fn gap_field_ui(ui: &mut Ui, pane: &mut Pane<'_>, gap: Gap) -> Option<Gap> {
    let look = pane.look;
    let caption = look.tr(poses::GAP);
    Label::new(caption, look.palette.muted).ui(ui);
    let label = look.tr_with(poses::POSE, caption);
    let range = f64::from(Gap::MIN.mm())..=f64::from(Gap::MAX.mm());
    let field = NumberField::new(&label, look.tip(poses::GAP), range).decimals(1);
    #[expect(clippy::cast_possible_truncation, reason = "a gap of at most 120 mm")]
    let typed = field.ui(ui, pane, Some(gap.mm().into()))? as f32;
    Gap::new(typed).ok()
}

/// Thresholds that differ from the defaults, by their names in files.
fn thresholds_words(thresholds: &GripThresholds) -> String {
    let own = thresholds.unusual();
    let words: Vec<String> = own
        .map(|(one, is)| format!("{} {is}", one.name()))
        .collect();
    words.join(", ")
}

fn joint_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose, dof: Dof) {
    let look = pane.look;
    if let Some(angle) = angle_ui(ui, pane, pose, dof) {
        change(pane, pose, PoseEdit::Angle(dof, angle));
    }
    let text = look.tr(poses::LEAVE);
    let label = look.tr_with(words::dof(dof), text);
    let leave = pose.leave[dof];
    let pinches = pose.gap.is_some() && Gap::JOINTS.contains(&dof);
    let button = Button::new(text, look.tip(poses::LEAVE)).named(&label);
    let button = button.disabled_if(pinches, look.tr(poses::LEAVE_PINCHES));
    if button.choice(leave).ui(ui, look).clicked() {
        change(pane, pose, PoseEdit::Leave(dof, !leave));
    }
}

/// Draws one joint's angle as a number after its name. Returns it once confirmed.
fn angle_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose, dof: Dof) -> Option<Angle> {
    let look = pane.look;
    let name = look.tr(words::dof(dof));
    Label::new(name, look.palette.dof[dof]).cell_ui(ui, CAPTION);
    let label = format!("{name} pose {}", look.tr(poses::ANGLE));
    let fixed = pose.gap.map(|_| look.tr(poses::ANGLE_OF_GAP));
    let field = NumberField::new(&label, look.tip(poses::ANGLE), 0.0..=1000.0).disabled(fixed);
    let typed = field.whole_ui(ui, pane, Some(pose.angles[dof].get()))?;
    Angle::new(typed).ok()
}

fn limits_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let look = pane.look;
    let mut number = |pane: &mut Pane<'_>, caption: Text, value: i16, max: f64| {
        let text = look.tr(caption);
        Label::new(text, look.palette.muted).ui(ui);
        let label = look.tr_with(poses::POSE, text);
        let field = NumberField::new(&label, look.tip(caption), 0.0..=max);
        field.whole_ui(ui, pane, Some(value))
    };
    let speed = number(pane, poses::SPEED, pose.speed.get(), 1000.0);
    let force = number(pane, poses::FORCE, pose.force.get(), 3000.0);
    if let Some(speed) = speed.and_then(|speed| Speed::new(speed).ok()) {
        change(pane, pose, PoseEdit::Speed(speed));
    }
    if let Some(force) = force.and_then(|force| Force::new(force).ok()) {
        change(pane, pose, PoseEdit::Force(force));
    }
}

/// Draws the switch to end in a hold, and its forces.
fn hold_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let look = pane.look;
    let holds = Button::text(look, poses::ENDS_HOLD).choice(pose.hold.is_some());
    if holds.ui(ui, look).clicked() {
        let forces = pane.hand().controls.hold_forces();
        let forces = pose.hold.is_none().then_some(forces);
        change(pane, pose, PoseEdit::Hold(forces));
    }
    let Some(forces) = pose.hold else {
        return;
    };
    let mut typed = |caption: Text, now: Force| {
        let text = look.tr(caption);
        Label::new(text, look.palette.muted).ui(ui);
        let label = look.tr_with(poses::POSE, text);
        let range = f64::from(HoldForces::LEAST)..=f64::from(HoldForces::MOST);
        let field = NumberField::new(&label, look.tip(caption), range);
        let typed = field.whole_ui(ui, pane, Some(now.get()));
        typed.map(Force::nearest)
    };
    let least = typed(hold::AT_LEAST, forces.at_least());
    let most = typed(hold::AT_MOST, forces.at_most());
    if least.is_some() || most.is_some() {
        let least = least.unwrap_or(forces.at_least());
        let new = HoldForces::nearest(least, most.unwrap_or(forces.at_most()));
        change(pane, pose, PoseEdit::Hold(Some(new)));
    }
}

fn order_ui(ui: &mut Ui, pane: &mut Pane<'_>, pose: &LibraryPose) {
    let look = pane.look;
    let unknown = pane.hand().pose_now(pane.state.now).is_none();
    let edit = |edit| Action::Library(LibraryEdit::Pose(pose.id, edit));
    let at = pane.state.poses.library.place(pose.id).unwrap_or_default();
    let [earlier, later] = [at.saturating_sub(1), at + 1].map(|to| edit(PoseEdit::Move(to)));
    let (copy, delete) = (edit(PoseEdit::Duplicate), edit(PoseEdit::Delete));
    let again = Action::Recapture(pose.id);
    let [left, right] = [
        (poses::EARLIER, theme::TO_LEFT),
        (poses::LATER, theme::TO_RIGHT),
    ]
    .map(|(text, icon)| {
        Button::text(look, text)
            .tip(look.tr(poses::SHIFT_TIP))
            .icon(icon)
    });
    let retake =
        Button::text(look, poses::RECAPTURE).disabled_if(unknown, look.tr(poses::CAPTURE_UNKNOWN));
    let double = Button::text(look, poses::DUPLICATE);
    let away = Button::text(look, poses::DELETE);
    for row in [
        &[(retake, again), (double, copy)][..],
        &[(left, earlier), (right, later), (away, delete)],
    ] {
        ui.horizontal(|ui| {
            for (button, action) in row {
                button.on_click(ui, pane, action.clone());
            }
        });
    }
}
