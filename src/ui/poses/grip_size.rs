//! Grips by size: a popup with kind, gap, size of the held object, and the reference blocks that calibrate it.

use crate::app::action::Action;
use crate::app::hand::grip;
use crate::hand::Angle;
use crate::hand::gap::{Block, Gap, GripKind, gap_on_path};
use crate::poses::edit::LibraryEdit;
use crate::poses::library::LibraryPose;
use crate::ui::hand::{aim, figures};
use crate::ui::kit::{self, Button, Label, Look, NumberField, Pane};
use crate::ui::text::{main, poses};
use crate::ui::theme;
use egui::{Id, Slider, Ui, vec2};

/// Width of the popup.
const POPUP: f32 = 420.0;

/// Draws the button in the strip of poses, with its popup.
pub(crate) fn drawer_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let button = Button::text(look, poses::GRIP_SIZE).ui(ui, look);
    kit::popup_above(&button).width(POPUP).show(|ui| {
        ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
        kinds_ui(ui, pane);
        gap_ui(ui, pane);
        held_ui(ui, pane);
    });
}

/// Draws the kinds of grip. Only one has a gap; the tooltips of the others explain why they have none.
fn kinds_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    ui.horizontal(|ui| {
        for kind in GripKind::ALL {
            let offered = kind.offered();
            let button = Button::text(look, poses::kind(kind)).choice(offered.is_ok());
            let no_gap = offered.err().map(|why| look.tr(poses::no_gap(why)));
            button.disabled(no_gap).ui(ui, look);
        }
    });
}

/// Reason why no gap can be sent now; `None` if it is possible.
fn refusal(pane: &Pane<'_>) -> Option<&'static str> {
    let (look, hand) = (pane.look, pane.hand());
    let locked = grip::locks_pinch(hand).then(|| look.tr(main::LOCKED));
    let closed = (!grip::is_open_for_pinch(hand)).then(|| look.tr(poses::GAP_CLOSED));
    pane.unready().or(locked).or(closed)
}

/// Gap of the current target, else of the actual pose; the widest if the hand does not pinch.
fn gap_now(pane: &Pane<'_>) -> Gap {
    let hand = pane.hand();
    let targets = hand.controls.joints.map(|joint| joint.target).all();
    let sent = targets.map(|angles| angles.map(|angle: Angle| f32::from(angle.get())));
    let gap = [sent, grip::counts(hand)].into_iter().flatten();
    let gap = gap.filter_map(|counts| gap_on_path(&counts)).next();
    gap.map_or(Gap::MAX, Gap::nearest)
}

/// Draws the gap: sent while the hand is armed, else previewed on the drawn hand.
fn gap_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let is_armed = pane.hand().connection.is_armed();
    let refused = refusal(pane);
    let id = Id::unique(("gap in the drawer", pane.hand().label.slot));
    let wish: Option<f32> = ui.data(|data| data.get_temp(id)).filter(|_| !is_armed);
    let mut mm = wish.unwrap_or_else(|| gap_now(pane).mm().round());
    ui.spacing_mut().slider_width = POPUP / 2.0;
    let range = Gap::MIN.mm()..=Gap::MAX.mm();
    let text = look.tr(poses::GAP);
    let slider = Slider::new(&mut mm, range).fixed_decimals(0).text(text);
    let is_movable = !is_armed || refused.is_none();
    let slider = ui.add_enabled(is_movable, slider.show_value(true));
    let slider = slider.on_hover_text(look.tip(poses::GAP));
    let slider = slider.on_disabled_hover_text(refused.unwrap_or_default());
    if slider.changed() && is_armed {
        pane.actions.push(Action::Pinch(Gap::nearest(mm)));
    } else if slider.changed() {
        ui.data_mut(|data| data.insert_temp(id, mm));
    }
    if is_armed {
        ui.data_mut(|data| data.remove_temp::<f32>(id));
    } else if wish.is_some() {
        aim::wish(ui, Gap::nearest(mm));
    }
    // Its space is reserved, so that the slider stays under the pointer.
    ui.scope(|ui| {
        ui.set_min_height(theme::CONTROL);
        opening_ui(ui, pane, is_armed);
    });
    let keep = Button::text(look, poses::GAP_KEEP);
    let pose = Action::Library(LibraryEdit::Add(vec![pose(look, Gap::nearest(mm))]));
    keep.on_click(ui, pane, pose);
}

/// A gentle pose by size with this gap.
fn pose(look: Look, gap: Gap) -> LibraryPose {
    let mut pose = LibraryPose::at(gap.angles());
    pose.name = look.fill(poses::GAP_POSE, &[&gap.mm()]);
    pose.set_gap(Some(gap));
    pose
}

/// Draws the precondition of a gap: a note while disarmed, or the button that opens the hand.
fn opening_ui(ui: &mut Ui, pane: &mut Pane<'_>, is_armed: bool) {
    let (look, hand) = (pane.look, pane.hand());
    if !is_armed {
        Label::note(look, poses::GAP_WISH).wrap().ui(ui);
    } else if !grip::is_open_for_pinch(hand) {
        let locked = grip::locks_pinch(hand).then(|| look.tr(main::LOCKED));
        let button = Button::text(look, poses::GAP_OPEN).disabled(pane.unready().or(locked));
        button.on_click(ui, pane, Action::Pinch(Gap::MAX));
    }
}

/// Draws the size of the held object, and the measured blocks.
fn held_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let held = figures::held_size(pane);
    let none = look.tr(poses::HELD_NONE);
    let words = look.pair(look.tr(poses::HELD_SIZE), held.as_deref().unwrap_or(none));
    let label = Label::new(&words, look.palette.text).wrap().ui(ui);
    label.on_hover_text(look.tip(poses::HELD_SIZE));
    ui.horizontal(|ui| {
        Label::muted(look, poses::BLOCK).ui(ui);
        let (from, to) = (*Block::SIZES_MM.start(), *Block::SIZES_MM.end());
        let range = f64::from(from)..=f64::from(to);
        let field = NumberField::new(look.tr(poses::BLOCK), look.tip(poses::BLOCK), range);
        let not_held = held.is_none().then(|| look.tr(poses::BLOCK_NOT_HELD));
        let field = field.decimals(1).needs_enter().disabled(not_held);
        if let Some(size_mm) = field.ui(ui, pane, None) {
            #[expect(clippy::cast_possible_truncation, reason = "a size of at most 120 mm")]
            pane.actions.push(Action::MeasureBlock(size_mm as f32));
        }
    });
    let endpoint = pane.hand().connection.endpoint.as_ref();
    let blocks = pane.state.settings.size_blocks(endpoint);
    let sizes = blocks.blocks().iter();
    let sizes: Vec<String> = sizes.map(|own| format!("{} mm", own.size_mm)).collect();
    let known = if blocks.is_empty() {
        look.tr(poses::BLOCKS_NONE).to_owned()
    } else {
        look.list(&sizes)
    };
    ui.horizontal(|ui| {
        let known = look.fill(poses::BLOCKS, &[&known]);
        Label::new(&known, look.palette.muted).ui(ui);
        if !blocks.is_empty() {
            Button::text(look, poses::BLOCKS_FORGET).on_click(ui, pane, Action::ForgetBlocks);
        }
    });
}
