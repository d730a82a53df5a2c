//! The drawn hand in the window: what the state says goes into the picture, and the finger that was chosen comes out.

use crate::app::action::Action;
use crate::app::hands::Hand;
use crate::app::readings::Freshness;
use crate::hand::kinematics::Side;
use crate::hand::{Finger, Moment, PerDof, PerFinger};
use crate::sim::Scenario;
use crate::transport::Endpoint;
use crate::ui::hand::fingertip::{Sense as Meant, Tip};
use crate::ui::hand::pointed::{self, PointedPlace};
use crate::ui::hand::scene::{HandPicture, TipLoad};
use crate::ui::hand::shape::Held;
use crate::ui::hand::tile;
use crate::ui::hand::view::HandView;
use crate::ui::kit::{self, Button, Look, Pane, Weight, format};
use crate::ui::text::{panels, words};
use crate::ui::theme;
use egui::{Rect, Role, Sense, Ui, WidgetInfo, vec2};

/// The drawn hand, turned as a person wants it.
#[derive(Debug, Clone, Default)]
pub(crate) struct HandPanel(HandView);

impl HandPanel {
    /// Draws the hand over what is left of `ui` and returns the finger that was chosen.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        tips: &PerFinger<Option<Tip>>,
    ) -> Option<Finger> {
        let look = pane.look;
        let response = ui.allocate_response(ui.available_size(), Sense::click_and_drag());
        let place = response.rect;
        response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, look.say(panels::HAND_PICTURE)));
        let picture = HandPicture {
            lit: pointed::pointed(ui, PointedPlace::Row),
            ..picture(pane.state.hand(), tips, pane.state.now)
        };
        let (response, joint) = self.0.ui(ui, response, look.palette, &picture);
        unknown_note(ui, look, place, &picture);
        side_ui(ui, place, pane);
        if let Some(dof) = joint {
            pointed::point(ui, PointedPlace::Hand, dof);
        }
        let finger = joint.map(crate::hand::Dof::finger);
        let clicked = finger.filter(|_| response.clicked());
        response.on_hover_text(finger.map_or_else(
            || look.tip(panels::HAND_PICTURE).to_owned(),
            |finger| said(pane, finger),
        ));
        clicked
    }
}

/// The drawn hand that nobody turns, over a place of its own.
#[derive(Debug, Clone, Default)]
pub(crate) struct StillHand(HandView);

impl StillHand {
    pub(crate) fn ui(&mut self, ui: &Ui, place: Rect, look: Look, picture: &HandPicture) {
        let response = ui.interact(place, ui.scope_id().with("still hand"), Sense::hover());
        response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, look.say(panels::HAND_PICTURE)));
        self.0.paint(ui, place, look.palette, picture);
    }
}

/// Draws a pose alone: for tiles and dry runs. `shares` of the way to open; a finger with an unknown joint is a shell.
pub(crate) fn pose_ui(ui: &Ui, look: Look, rect: Rect, shares: &PerDof<Option<f32>>) {
    tile::pose_ui(ui, look.palette, rect, &HandPicture::of(look.side, shares));
}

/// A hand as it is known now, with what its fingertips feel.
pub(crate) fn picture(state: &Hand, tips: &PerFinger<Option<Tip>>, now: Moment) -> HandPicture {
    let angle = state.readings.sample.angle;
    let actual = PerDof::from_fn(|dof| {
        let raw = angle?.value[dof].documented()?;
        Some(f32::from(raw) / 1000.0)
    });
    let target = PerDof::from_fn(|dof| {
        let target = state.controls.joints[dof]
            .target
            .filter(|_| state.connection.is_armed())?;
        Some(f32::from(target.get()) / 1000.0)
    });
    HandPicture {
        target,
        is_stale: state.freshness(angle.map(|angle| angle.asked), now) == Freshness::Stale,
        tips: tips.map(|tip| tip.as_ref().map(load).unwrap_or_default()),
        held: state.connection.endpoint.as_ref().and_then(held),
        ..HandPicture::of(state.side, &actual)
    }
}

/// What a fingertip feels; nothing of old values.
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

/// What waits before the built-in hand: its scenario says so. Of any other hand nobody knows.
fn held(endpoint: &Endpoint) -> Option<Held> {
    let Endpoint::Sim { scenario, .. } = endpoint else {
        return None;
    };
    Some(match scenario.parse().ok()? {
        Scenario::Free | Scenario::Touched | Scenario::Frozen => return None,
        Scenario::Rigid => Held::Block,
        Scenario::Fragile => Held::Cup,
        Scenario::Idle | Scenario::Grasp | Scenario::Faults | Scenario::Extremes => Held::Ball,
    })
}

/// Says under the picture what a grey finger stands for.
fn unknown_note(ui: &mut Ui, look: Look, picture: Rect, shown: &HandPicture) {
    if shown.actual.all().is_none() {
        let place = picture.with_min_y(picture.bottom() - theme::PAD);
        kit::Label::note(look, panels::UNKNOWN)
            .center()
            .put(ui, place);
    }
}

/// In a corner of the picture: which hand is drawn, and the way to the other one.
fn side_ui(ui: &mut Ui, picture: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let words = look.say(match look.side {
        Side::Right => panels::RIGHT_HAND,
        Side::Left => panels::LEFT_HAND,
    });
    let width = kit::text_width(ui, words, theme::body()) + 2.0 * theme::GAP;
    let corner = picture.right_bottom() - vec2(width, theme::CONTROL);
    let place = Rect::from_min_size(corner, vec2(width, theme::CONTROL));
    let button = Button::new(words, look.say(panels::SIDE_TIP)).weight(Weight::Quiet);
    let id = ui.next_auto_id().with("side");
    if button.put(ui, look, place, id).clicked() {
        pane.actions.push(Action::Side(look.side.other()));
    }
}

/// A finger with its force, as a sentence reads it.
fn said(pane: &Pane<'_>, finger: Finger) -> String {
    let look = pane.look;
    let block = pane.state.hand().readings.sample.tactile[finger].map(|block| block.value);
    format!(
        "{}: {} {} N, {} {} N",
        look.say(words::finger(finger)),
        look.say(panels::TIP_NORMAL),
        format::newtons(block.map(|block| block.normal_n)),
        look.say(panels::TIP_SHEAR),
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
            ("tcp:127.0.0.1:6000", None),
            ("rs485:/dev/ttyUSB0", None),
        ] {
            assert_eq!(held(&endpoint.parse().unwrap()), wanted, "{endpoint}");
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
