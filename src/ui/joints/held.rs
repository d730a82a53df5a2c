//! The line above the joints: speed and force that the hand holds in place of the user's, with a button that takes them over.

use crate::app::action::Action;
use crate::app::readings::Freshness;
use crate::hand::{Dof, Force, Speed};
use crate::ui::kit::{self, Button, Label, Pane};
use crate::ui::text::{Text, main, window};
use crate::ui::theme;
use egui::{Ui, vec2};

/// One setting of all joints: what the hand holds, and what the user set.
struct HeldSetting {
    title: Text,
    held: Vec<i16>,
    own: Vec<i16>,
}

impl HeldSetting {
    /// A setting of which the hand holds something else in at least one joint.
    fn new(title: Text, joints: impl Iterator<Item = (Option<i16>, Option<i16>)>) -> Option<Self> {
        let all: Vec<_> = joints.collect();
        let differs = all.iter().any(|(held, _)| held.is_some());
        let held = all.iter().filter_map(|(held, own)| held.or(*own));
        differs.then(|| Self {
            title,
            held: held.collect(),
            own: all.iter().filter_map(|(_, own)| *own).collect(),
        })
    }
}

/// Draws the line. Its space is reserved while there is nothing to tell.
pub(crate) fn held_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let size = vec2(ui.available_width(), theme::CONTROL);
    kit::cell_ui(ui, size, |ui| {
        let settings = settings(pane);
        if !settings.is_empty() {
            line_ui(ui, pane, &settings);
        } else if awaits_arming(pane) {
            let label = Label::new(pane.look.tr(window::ARM_FIRST), pane.look.palette.accent);
            label.small().ui(ui);
        }
    });
}

/// True if arming is the next step of a new user; if it is refused, the header shows the reason.
fn awaits_arming(pane: &Pane<'_>) -> bool {
    let hand = pane.hand();
    let asked = hand.readings.sample.angle.map(|angle| angle.asked);
    let is_live = pane.freshness(asked) == Freshness::Live && pane.recorded().is_none();
    is_live && !hand.connection.is_armed() && hand.arm_refusal(pane.state.now).is_none()
}

/// The settings that differ; none in a recording, where nothing is set.
fn settings(pane: &Pane<'_>) -> Vec<HeldSetting> {
    let hand = pane.hand();
    if pane.recorded().is_some() {
        return Vec::new();
    }
    let joints = hand.controls.joints;
    let held = |dof| hand.held_otherwise(dof);
    let speed = Dof::ALL.into_iter().map(|dof| {
        let held = held(dof).speed.map(Speed::get);
        (held, joints[dof].speed.map(Speed::get))
    });
    let force = Dof::ALL.into_iter().map(|dof| {
        let held = held(dof).force.map(Force::get);
        (held, joints[dof].force.map(Force::get))
    });
    let speed = HeldSetting::new(main::HELD_SPEED, speed);
    let force = HeldSetting::new(main::HELD_FORCE, force);
    speed.into_iter().chain(force).collect()
}

fn line_ui(ui: &mut Ui, pane: &mut Pane<'_>, settings: &[HeldSetting]) {
    let look = pane.look;
    let is_armed = pane.hand().connection.is_armed();
    let held: Vec<String> = settings
        .iter()
        .map(|setting| look.fill(setting.title, &[&span(&setting.held)]))
        .collect();
    let held = look.tr_with(main::HELD, look.list(&held));
    let own: Vec<String> = settings.iter().map(|setting| span(&setting.own)).collect();
    let own: Vec<&str> = own
        .iter()
        .map(String::as_str)
        .filter(|own| !own.is_empty())
        .collect();
    let sent = look.fill(main::ARM_SENDS, &[&look.list(&own)]);
    kit::right_ui(ui, |ui| {
        if !is_armed {
            take_ui(ui, pane);
        }
        let (_, place) = ui.allocate_space(ui.available_size());
        let mut words = held;
        // The sliders show what is sent.
        let full = format!("{words}{sent}");
        let fits = kit::text_width(ui, &full, theme::small()) <= place.width();
        if fits && !is_armed && !own.is_empty() {
            words = full;
        }
        let label = Label::new(&words, look.palette.muted).small();
        label
            .put(ui, place)
            .on_hover_text(look.tip(main::HAND_HOLDS));
    });
}

/// Draws the button that sets the user's speeds and forces to those of the hand. It sends nothing: the hand has them.
fn take_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let button = Button::text(pane.look, main::TAKE_HELD);
    if !button.ui(ui, pane.look).clicked() {
        return;
    }
    for dof in Dof::ALL {
        let held = pane.hand().held_otherwise(dof);
        let speed = held.speed.map(|speed| Action::Speed(Some(dof), speed));
        let force = held.force.map(|force| Action::Force(Some(dof), force));
        pane.actions.extend(speed.into_iter().chain(force));
    }
}

/// The common value of all joints, or the least and the greatest one.
fn span(values: &[i16]) -> String {
    match (values.iter().min(), values.iter().max()) {
        (Some(low), Some(high)) if low < high => format!("{low}…{high}"),
        (Some(low), _) => low.to_string(),
        _ => String::new(),
    }
}
