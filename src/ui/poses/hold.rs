//! A hold between two forces: a popup with its forces, the ways in which it begins, and its state.

use crate::app::action::Action;
use crate::app::hand::grasps::GraspState;
use crate::app::hand::hold::{HoldAction, HoldMotion};
use crate::hand::gap::Gap;
use crate::hand::hold_forces::HoldForces;
use crate::hand::newtons::ForceUnit;
use crate::hand::{Finger, Force};
use crate::motion::hold::{HoldClose, HoldPhase};
use crate::poses::starter::starter;
use crate::ui::hand::figures;
use crate::ui::kit::{self, Button, Label, Look, NumberField, Pane, Weight};
use crate::ui::text::{Text, hold, words};
use crate::ui::theme;
use egui::{CornerRadius, Id, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};

/// Width of the popup.
const POPUP: f32 = 420.0;
/// Highest force on the slider, g; the fields beside it go on to the limit.
const SLIDER_MOST: f32 = 1000.0;
/// Height of the list of grasps; it scrolls beyond.
const GRASPS: f32 = 120.0;
/// Decimals of a force in newtons.
const NEWTON_DECIMALS: usize = 1;
/// Radius of a handle.
const HANDLE: f32 = 8.0;
/// The shipped pose to which all fingers close.
const POWER: &str = "Power grasp";

/// Draws the button in the strip of poses, with its popup.
pub(crate) fn drawer_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let is_on = pane.hand().running.holds();
    let button = Button::text(look, hold::HOLD).switch(is_on).ui(ui, look);
    kit::popup_above(&button).width(POPUP).show(|ui| {
        ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::STEP);
        forces_ui(ui, pane);
        if pane.hand().running.holds() {
            let end = Button::text(look, hold::END).weight(Weight::Strong);
            ui.horizontal(|ui| {
                end.on_click(ui, pane, Action::Hold(HoldAction::End));
                put_down_ui(ui, pane);
            });
        } else {
            starts_ui(ui, pane);
            grasps_ui(ui, pane);
        }
        state_ui(ui, pane);
    });
}

/// Draws both forces: one slider with two handles, and a field for each.
fn forces_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let (look, controls) = (pane.look, &pane.hand().controls);
    let unit = controls.hold_unit(&pane.hand().newtons.all_per_g());
    let forces = controls.hold_forces_in(unit);
    let both = [forces.at_least(), forces.at_most()].map(|force| f32::from(force.get()));
    let running = pane.hand().running.holds();
    let slider = |ui: &mut Ui| slider_ui(ui, look, unit, both);
    let mut wanted = ui.add_enabled_ui(!running, slider).inner;
    ui.horizontal(|ui| {
        for (nth, (text, now)) in titles(unit).into_iter().zip(both).enumerate() {
            Label::muted(look, text).ui(ui);
            let typed = field_ui(ui, pane, (text, unit), now);
            if let Some(typed) = typed {
                let mut both = both;
                if let Some(own) = both.get_mut(nth) {
                    *own = typed;
                }
                wanted = Some(both);
            }
        }
        unit_ui(ui, pane, unit);
    });
    if unit == ForceUnit::Grams {
        newtons_ui(ui, pane, both);
    }
    if let Some(both) = wanted {
        #[expect(clippy::cast_possible_truncation, reason = "a force of at most 2000 g")]
        let [least, most] = both.map(|g| Force::nearest(g.round() as i64));
        let forces = HoldForces::nearest(least, most);
        let action = HoldAction::Forces(unit, forces);
        pane.actions.push(Action::Hold(action));
    }
}

/// Names of the two forces.
const fn titles(unit: ForceUnit) -> [Text; 2] {
    match unit {
        ForceUnit::Grams => [hold::AT_LEAST, hold::AT_MOST],
        ForceUnit::Newtons => [hold::AT_LEAST_N, hold::AT_MOST_N],
    }
}

/// Draws the field of a force in g; returns the force that was typed.
fn field_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    (text, unit): (Text, ForceUnit),
    now: f32,
) -> Option<f32> {
    let look = pane.look;
    let range = [HoldForces::LEAST, HoldForces::MOST].map(|g| f64::from(g) * unit.per_g());
    let field = NumberField::new(look.tr(text), look.tip(text), range[0]..=range[1]).needs_enter();
    let field = field.decimals(match unit {
        ForceUnit::Grams => 0,
        ForceUnit::Newtons => NEWTON_DECIMALS,
    });
    let running = pane.hand().running.holds();
    let refused = running.then(|| look.tr(hold::MOVES));
    let shown = f64::from(now) * unit.per_g();
    let typed = field.disabled(refused).ui(ui, pane, Some(shown))?;
    #[expect(clippy::cast_possible_truncation, reason = "a force of at most 2000 g")]
    let grams = (typed / unit.per_g()) as f32;
    Some(grams)
}

/// Draws the choice of the unit, of a hand whose fingers were all measured.
fn unit_ui(ui: &mut Ui, pane: &mut Pane<'_>, unit: ForceUnit) {
    let look = pane.look;
    let newtons = pane.hand().newtons.all_per_g();
    let is_known = ForceUnit::Newtons.reading_per_g(&newtons).is_some();
    let running = pane.hand().running.holds().then(|| look.tr(hold::MOVES));
    for (own, text) in [
        (ForceUnit::Grams, hold::UNIT_G),
        (ForceUnit::Newtons, hold::UNIT_N),
    ] {
        let unknown = (!is_known).then(|| look.tr(hold::UNIT_UNKNOWN));
        let button = Button::text(look, text).choice(own == unit);
        let button = button.disabled(running.or(unknown));
        button.on_click(ui, pane, Action::Hold(HoldAction::Unit(own)));
    }
}

/// Draws both forces in newtons of the fingers that were measured: each finger has its own.
fn newtons_ui(ui: &mut Ui, pane: &Pane<'_>, both: [f32; 2]) {
    let (look, per_g) = (pane.look, pane.hand().newtons.all_per_g());
    let known = Finger::ALL.map(|finger| Some((finger, per_g[finger.bend()]?)));
    let known: Vec<(Finger, f64)> = known.into_iter().flatten().collect();
    let factors = || known.iter().map(|(_, per_g)| *per_g);
    let Some((low, high)) = factors().reduce(f64::min).zip(factors().reduce(f64::max)) else {
        return;
    };
    let [least, most] = both.map(|grams| {
        let [low, high] = [low, high].map(|per_g| format!("{:.1}", f64::from(grams) * per_g));
        match low == high {
            true => format!("{low} N"),
            false => look.fill(hold::FROM_TO_N, &[&low, &high]),
        }
    });
    let fingers: Vec<&str> = known
        .iter()
        .map(|own| look.tr(words::finger(own.0)))
        .collect();
    let fingers = look.list(&fingers);
    let text = look.fill(hold::IN_NEWTONS, &[&least, &most, &fingers]);
    Label::new(&text, look.palette.muted).wrap().ui(ui);
}

/// A slider with two handles; returns both forces if one was dragged.
fn slider_ui(
    ui: &mut Ui,
    look: Look,
    unit: ForceUnit,
    [least, most]: [f32; 2],
) -> Option<[f32; 2]> {
    let size = vec2(ui.available_width(), 2.0 * HANDLE + 4.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let track = rect.shrink2(vec2(HANDLE, 0.0));
    let x = |g: f32| track.left() + track.width() * (g / SLIDER_MOST).clamp(0.0, 1.0);
    let line = |from: f32, to: f32| {
        let middle = rect.center().y;
        Rect::from_min_max(pos2(from, middle - 2.0), pos2(to, middle + 2.0))
    };
    let (palette, round) = (look.palette, CornerRadius::same(2));
    let painter = ui.painter().clone();
    painter.rect_filled(line(track.left(), track.right()), round, palette.control);
    painter.rect_filled(line(x(least), x(most)), round, palette.accent);
    let mut moved = None;
    let both = titles(unit).into_iter().zip([least, most]);
    for (nth, (text, now)) in both.enumerate() {
        let center = pos2(x(now), rect.center().y);
        let place = Rect::from_center_size(center, vec2(2.0 * HANDLE, rect.height()));
        let id = Id::unique(("hold force", nth));
        let handle = ui.interact(place, id, Sense::drag());
        let name = look.tr(text);
        handle.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::Slider, true, name);
            info.value = Some(now.into());
            info
        });
        let is_hot = handle.hovered() || handle.dragged();
        let fill = if is_hot { palette.text } else { palette.accent };
        painter.circle_filled(center, HANDLE, fill);
        if let Some(pointer) = handle.interact_pointer_pos().filter(|_| handle.dragged()) {
            let share = (pointer.x - track.left()) / track.width();
            let step = step_g(unit);
            let g = (share.clamp(0.0, 1.0) * SLIDER_MOST / step).round() * step;
            let room = f32::from(HoldForces::ROOM);
            moved = Some(match nth {
                0 => [g.min(most - room), most],
                _ => [least, g.max(least + room)],
            });
        }
        handle.on_hover_text(look.tip(text));
    }
    moved
}

/// Step of the slider, g: round numbers of its unit.
const fn step_g(unit: ForceUnit) -> f32 {
    match unit {
        ForceUnit::Grams => 10.0,
        // 0.1 N
        ForceUnit::Newtons => 10.197_162,
    }
}

/// Draws the ways in which a hold begins.
fn starts_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let state = figures::grip(pane).grasp.state;
    let holds = state.is_held();
    ui.horizontal(|ui| {
        let nothing = (!holds).then(|| look.tr(hold::END_NOTHING));
        let take = Button::text(look, hold::TAKE).disabled(pane.unready().or(nothing));
        let start = |close| Action::Hold(HoldAction::Start(close));
        take.on_click(ui, pane, start(HoldClose::TakeOver));
        if let Some(pose) = starter().pose_named(POWER) {
            let close = Button::text(look, hold::POWER).disabled(pane.unready());
            close.on_click(ui, pane, start(HoldClose::To(pose.targets())));
        }
        let pinch = Button::text(look, hold::PINCH).disabled(pane.unready());
        pinch.on_click(ui, pane, start(HoldClose::Pinch(Gap::MIN)));
    });
}

/// Draws the button by which the user says that the object stands, while a grasp is confirmed.
fn put_down_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let Some(run) = pane.hand().running.hold() else {
        return;
    };
    let (asks, is_confirmed) = (run.asks(), run.confirming.is_none());
    if is_confirmed {
        return;
    }
    let why = (!asks).then(|| look.tr(hold::PUT_DOWN_LOADED));
    let button = Button::text(look, hold::PUT_DOWN).disabled(why);
    button.on_click(ui, pane, Action::Hold(HoldAction::PutDown));
}

/// Draws the state of the hold, or how the last one ended.
fn state_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let (look, palette) = (pane.look, pane.look.palette);
    let Some(run) = pane.hand().running.hold() else {
        return;
    };
    let (words, color) = match run.end {
        Some(Ok(Err(doubt))) => (hold::doubted(look, doubt), palette.warn),
        Some(Ok(Ok(end))) => (hold::end(look, Ok(end)), palette.muted),
        Some(Err(why)) => (hold::end(look, Err(why)), palette.muted),
        None if run.view.phase == HoldPhase::CannotHold => {
            (hold::state(look, &run.view, run.unit), palette.warn)
        }
        None => (hold::state(look, &run.view, run.unit), palette.text),
    };
    if let Some(confirming) = run.confirming {
        let words = hold::confirming(look, confirming);
        Label::new(&words, palette.accent).wrap().ui(ui);
    }
    Label::new(&words, color).wrap().ui(ui);
}

/// Draws the saved grasps, each as a button that holds with it, and the button that saves the last hold.
fn grasps_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let saves = pane.hand().running.hold().is_some_and(HoldMotion::is_done);
    if saves {
        let run = pane.hand().running.hold();
        let why = run.and_then(HoldMotion::not_saved).map(hold::not_saved);
        let save = Button::text(look, hold::SAVE).disabled(why.map(|why| look.tr(why)));
        save.on_click(ui, pane, Action::Hold(HoldAction::Save));
    }
    let grasps = pane.hand().grasps.shown(pane.hand().newtons.all_per_g());
    if grasps.is_empty() {
        return;
    }
    Label::muted(look, hold::GRASPS).ui(ui);
    let shown = egui::ScrollArea::vertical().max_height(GRASPS);
    shown.show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            for grasp in grasps {
                let forces = [grasp.at_least, grasp.at_most].map(Force::get);
                let [least, most] = &forces;
                let (tip, doubt) = match grasp.state {
                    GraspState::Own => (look.fill(hold::GRASP_OWN, &[least, most]), None),
                    GraspState::Trusted => {
                        let made = look.fill(hold::GRASP_TRUSTED, &[&grasp.hand, least, most]);
                        (made, None)
                    }
                    GraspState::New => {
                        let made = look.fill(hold::GRASP_NEW, &[&grasp.hand, least, most]);
                        (made, None)
                    }
                    GraspState::Doubted(why) => (String::new(), Some(hold::doubted(look, why))),
                };
                let button = Button::new(&grasp.name, &tip);
                let button = button.disabled(pane.unready().or(doubt.as_deref()));
                let action = HoldAction::Repeat(grasp.name.clone());
                button.on_click(ui, pane, Action::Hold(action));
            }
        });
    });
}
