//! The drawn hand in the window: turns state into a picture, and returns the finger that was clicked.

use crate::app::action::Action;
use crate::app::activity::Activity;
use crate::app::hand::Hand;
use crate::app::readings::Freshness;
use crate::draw::figure::shape::{Held, HeldPlace};
use crate::hand::heat::{HOT, WARM};
use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, Finger, Moment, PerDof, PerFinger, Status};
use crate::sim::Scenario;
use crate::sim::object::{NamedObject, Object};
use crate::transport::Endpoint;
use crate::ui::hand::fingertip::{Sense as Meant, Tip};
use crate::ui::hand::pointed::{self, PointedPlace};
use crate::ui::hand::scene::{HandPicture, Hurt, TipLoad};
use crate::ui::hand::view::{HandStage, HandView};
use crate::ui::hand::{aim, figures};
use crate::ui::kit::{self, Button, Look, Pane, Weight, format};
use crate::ui::text::{main, panels, window, words};
use crate::ui::theme;
use egui::{Rect, Role, Sense, Ui, WidgetInfo};

/// Minimum height of a drawn hand that fills the rest of a view.
const STILL_LEAST: f32 = 160.0;

/// The drawn hand, in the orientation chosen by the user.
#[derive(Debug, Clone, Default)]
pub(crate) struct HandPanel(HandView);

impl HandPanel {
    /// Draws the hand over the rest of `ui`, with labels of its fingers beside it. Dragging a finger sets its joint's target.
    /// Returns the finger that was clicked. `is_frontal`: the pads face the viewer.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        tips: &PerFinger<Option<Tip>>,
        is_frontal: bool,
    ) -> Option<Finger> {
        let look = pane.look;
        self.0.face(ui, is_frontal);
        let response = ui.allocate_response(ui.available_size(), Sense::click_and_drag());
        let place = response.rect;
        response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, look.tr(panels::HAND_PICTURE)));
        let picture = HandPicture {
            lit: pointed::pointed(ui, PointedPlace::Row),
            ..picture(pane.hand(), tips, pane.state.now)
        };
        let picture = wished(ui, pane, picture);
        let movable =
            |dof: Dof| picture.is_known(dof.finger()) && aim::refusal(pane, dof).is_none();
        let stage = HandStage {
            rect: figures::picture_place(place, picture.side),
            palette: look.palette,
            picture: &picture,
            movable: PerDof::from_fn(movable),
        };
        let used = self.0.ui(ui, &response, &stage);
        figures::figures_ui(ui, pane, &self.0, place);
        if picture.actual.all().is_some() {
            figures::grip_ui(ui, pane, place);
        } else {
            unknown_note(ui, look, place);
        }
        if let Some(dof) = used.joint {
            pointed::point(ui, PointedPlace::Hand, dof);
        }
        if let Some((dof, share)) = used.moved {
            send(ui, pane, dof, share);
            return None;
        }
        let clicked = response.clicked();
        // A tooltip would cover the finger that is dragged.
        if response.is_pointer_button_down_on() {
            return None;
        }
        let tip = used.joint.map(|dof| joint_tooltip(pane, dof));
        let general = || look.tip(panels::HAND_PICTURE).to_owned();
        response.on_hover_text_at_pointer(tip.unwrap_or_else(general));
        used.joint.map(Dof::finger).filter(|_| clicked)
    }
}

/// Adds the previewed gap as the ghost, while the hand is not armed.
fn wished(ui: &Ui, pane: &Pane<'_>, picture: HandPicture) -> HandPicture {
    let is_armed = pane.hand().connection.is_armed();
    match aim::wished(ui).filter(|_| !is_armed) {
        Some(gap) => HandPicture {
            target: gap
                .angles()
                .map(|angle| Some(f32::from(angle.get()) / 1000.0)),
            ..picture
        },
        None => picture,
    }
}

/// Sets a joint's target to the dragged position, unless it is the target already.
fn send(ui: &Ui, pane: &mut Pane<'_>, dof: Dof, share: f32) {
    #[expect(clippy::cast_possible_truncation, reason = "a share of at most 1")]
    let angle = Angle::nearest((share * f32::from(Angle::MAX.get())).round() as i16);
    if pane.hand().controls.joints[dof].target != Some(angle) {
        aim::send(pane, dof, angle, aim::is_linked(ui));
    }
}

/// The drawn hand in its default orientation, which the user cannot turn.
#[derive(Debug, Clone, Default)]
pub(crate) struct StillHand(HandView);

impl StillHand {
    pub(crate) fn ui(&mut self, ui: &Ui, place: Rect, look: Look, picture: &HandPicture) {
        let response = ui.interact(place, ui.scope_id().with("still hand"), Sense::hover());
        response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, look.tr(panels::HAND_PICTURE)));
        self.0.paint(ui, place, look.palette, picture);
    }

    /// Draws the shown hand over the rest of `ui`, with one joint in its colour; nothing where there is no space for a hand.
    pub(crate) fn rest_ui(
        &mut self,
        ui: &mut Ui,
        pane: &Pane<'_>,
        tips: &PerFinger<Option<Tip>>,
        lit: Option<Dof>,
    ) {
        let size = ui.available_size();
        if size.y < STILL_LEAST {
            return;
        }
        let (_, place) = ui.allocate_space(size);
        let shown = HandPicture {
            lit,
            ..picture(pane.hand(), tips, pane.state.now)
        };
        self.ui(ui, place, pane.look, &shown);
    }
}

/// Picture of a hand from its current state, with the load on its fingertips.
pub(crate) fn picture(state: &Hand, tips: &PerFinger<Option<Tip>>, now: Moment) -> HandPicture {
    let angle = state.readings.sample.angle;
    let actual = PerDof::from_fn(|dof| {
        let raw = angle?.value[dof].documented()?;
        Some(f32::from(raw) / 1000.0)
    });
    // Targets that this window does not set joint by joint are read from the hand's own register.
    let from_register = matches!(state.activity(), Activity::Series | Activity::Following(_));
    let register = state.readings.sample.angle_set.filter(|_| from_register);
    let target = PerDof::from_fn(|dof| {
        let sent = || state.controls.joints[dof].target;
        let target = register.map_or_else(sent, |held| held.value[dof]?.angle());
        let target = target.filter(|_| from_register || state.connection.is_armed())?;
        Some(f32::from(target.get()) / 1000.0)
    });
    let is_live = state.connection.is_live();
    let asked = angle.map(|angle| angle.asked);
    HandPicture {
        target,
        is_stale: state.readings.freshness(asked, is_live, now) == Freshness::Stale,
        tips: tips.map(|tip| tip.as_ref().map(load).unwrap_or_default()),
        held: state.connection.endpoint.as_ref().and_then(held),
        hurts: hurts(state, now),
        ..HandPicture::of(state.side, &actual)
    }
}

/// Faults and temperatures of the drives; empty for old values.
fn hurts(state: &Hand, now: Moment) -> PerDof<Hurt> {
    let sample = &state.readings.sample;
    let connected = state.connection.is_live();
    let freshness = |asked| state.readings.freshness(Some(asked), connected, now);
    let is_live = |asked: Moment| freshness(asked) == Freshness::Live;
    let faults = sample.faults.filter(|group| is_live(group.asked));
    let status = sample.status.filter(|group| is_live(group.asked));
    let heat = sample.temperature.filter(|group| is_live(group.asked));
    PerDof::from_fn(|dof| {
        let has_fault = faults.is_some_and(|group| group.value[dof].iter().next().is_some());
        let protects = status.is_some_and(|group| Status::is_protective(group.value[dof]));
        let degrees = heat.and_then(|group| group.value[dof].documented());
        let warm = degrees.and_then(|degrees| degrees.checked_sub(WARM));
        // Starts one step above cool, so that the first warm degree is visible.
        let heat = warm.map_or(0.0, |over| f32::from(over + 1) / f32::from(HOT - WARM + 1));
        Hurt {
            is_bad: has_fault || protects,
            heat: heat.min(1.0),
        }
    })
}

/// Load on a fingertip; empty for old values.
fn load(tip: &Tip) -> TipLoad {
    if tip.stale {
        return TipLoad::default();
    }
    let (shear, degrees) = tip.shear.unwrap_or_default();
    let (right, tipwards) = degrees.to_radians().sin_cos();
    let normal = tip.normal_n.filter(|_| tip.sense == Meant::Fine);
    TipLoad {
        heat: tip.heat.iter().flatten().copied().reduce(f32::max),
        force: normal.map(|normal| [normal, shear * tipwards, shear * right]),
    }
}

/// Thickness of the ball, the block and the cup that scenarios are named after, mm.
const BALL_MM: f64 = 71.0;
const BLOCK_MM: f64 = 48.0;
const CUP_MM: f64 = 54.4;

/// Object in front of the built-in simulated hand, known from its object or scenario; `None` for any other hand.
pub(super) fn held(endpoint: &Endpoint) -> Option<HeldPlace> {
    let Endpoint::Sim {
        scenario, object, ..
    } = endpoint
    else {
        return None;
    };
    let named = object.as_ref().and_then(|name| NamedObject::by_name(name));
    let (shape, thickness_mm, touched) = match named {
        Some(named) => (shape_of(named), named.size_mm(), named.object()),
        None => {
            let scenario = scenario.parse().ok()?;
            let (shape, thickness_mm) = match scenario {
                // The shape of an object in a file is not known.
                _ if object.is_some() => (Held::Ball, BALL_MM),
                Scenario::Free | Scenario::Touched | Scenario::Frozen => return None,
                Scenario::Rigid => (Held::Block, BLOCK_MM),
                Scenario::Fragile => (Held::Cup, CUP_MM),
                Scenario::Idle | Scenario::Grasp | Scenario::Faults | Scenario::Extremes => {
                    (Held::Ball, BALL_MM)
                }
            };
            let touched = match shape {
                Held::Ball => Object::soft_ball(),
                _ => Object::of(scenario),
            };
            (shape, thickness_mm, touched)
        }
    };
    let angles = (touched.contacts).map(|contact| contact.map(|contact| contact.angle));
    Some(HeldPlace::touched(shape, thickness_mm, &angles))
}

const fn shape_of(named: NamedObject) -> Held {
    match named {
        NamedObject::Cup => Held::Cup,
        NamedObject::Egg => Held::Ball,
        NamedObject::Sponge | NamedObject::Block => Held::Block,
        NamedObject::Tube | NamedObject::Can => Held::Tube,
    }
}

/// Explains grey fingers under the picture.
fn unknown_note(ui: &mut Ui, look: Look, picture: Rect) {
    let place = picture.with_min_y(picture.bottom() - theme::PAD);
    let note = kit::Label::note(look, panels::UNKNOWN);
    note.center().put(ui, place);
}

/// A button that names the side drawn and switches to the other one.
pub(crate) fn side_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let words = look.tr(match look.side {
        Side::Right => panels::RIGHT_HAND,
        Side::Left => panels::LEFT_HAND,
    });
    let button = Button::new(words, look.tr(panels::SIDE_TIP)).weight(Weight::Quiet);
    if button.ui(ui, look).clicked() {
        pane.actions.push(Action::Side(look.side.other()));
    }
}

/// Description of a joint and its drag, or the reason why it cannot be dragged, with the forces on its fingertip.
fn joint_tooltip(pane: &Pane<'_>, dof: Dof) -> String {
    let look = pane.look;
    let name = look.tr(words::dof(dof));
    let drag = match aim::refusal(pane, dof) {
        None => look.tr(panels::DRAG_FINGER),
        Some(_) if pane.unready() == Some(look.tr(main::NOT_ARMED)) => look.tr(window::ARM_FIRST),
        Some(reason) => reason,
    };
    format!("{}\n{}", look.pair(name, drag), felt(pane, dof.finger()))
}

/// Forces on a fingertip, as text.
pub(crate) fn felt(pane: &Pane<'_>, finger: Finger) -> String {
    let look = pane.look;
    let block = pane.hand().readings.sample.tactile[finger].map(|block| block.value);
    format!(
        "{} {} N, {} {} N",
        look.tr(panels::TIP_NORMAL),
        format::newtons(block.map(|block| block.normal_n)),
        look.tr(panels::TIP_SHEAR),
        format::newtons(block.map(|block| block.tangential_n)),
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    #[test]
    fn only_the_built_in_hand_has_an_object_drawn() {
        for (endpoint, wanted) in [
            ("sim:", Some(Held::Ball)),
            ("sim:?scenario=free", None),
            ("sim:?scenario=rigid", Some(Held::Block)),
            ("sim:?scenario=fragile", Some(Held::Cup)),
            ("sim:?scenario=grasp", Some(Held::Ball)),
            ("sim:?scenario=free&object=block", Some(Held::Block)),
            ("sim:?object=egg", Some(Held::Ball)),
            ("sim:?object=can", Some(Held::Tube)),
            ("sim:?object=own.toml", Some(Held::Ball)),
            ("tcp:127.0.0.1:6000", None),
            ("rs485:/dev/ttyUSB0", None),
        ] {
            let shown = held(&endpoint.parse().unwrap());
            assert_eq!(shown.map(|shown| shown.shape), wanted, "{endpoint}");
        }
    }

    #[test]
    fn old_or_senseless_forces_have_no_arrow() {
        let fine = Tip {
            heat: [
                Some(0.1),
                None,
                Some(0.7),
                None,
                None,
                None,
                None,
                Some(0.2),
            ],
            normal_n: Some(3.0),
            shear: Some((2.0, 90.0)),
            ..Tip::default()
        };
        let load_of = load(&fine);
        let [normal, tipwards, right] = load_of.force.unwrap();
        assert_eq!((load_of.heat, normal), (Some(0.7), 3.0));
        assert!(tipwards.abs() < 1e-5 && (right - 2.0).abs() < 1e-5);
        let beyond = Tip {
            sense: Meant::Beyond,
            ..fine
        };
        assert_eq!(load(&beyond).force, None);
        let old = Tip {
            stale: true,
            ..fine
        };
        assert_eq!(load(&old), TipLoad::default());
    }
}
