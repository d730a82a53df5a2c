//! The drawn hand, looked at by its mesh.
#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]
use crate::app::settings::Theme;
use crate::draw::figure::camera::Turn;
use crate::draw::figure::render::{SeenPlace, Sketch};
use crate::draw::figure::shape;
use crate::hand::kinematics::{Segment, SegmentFrames, Side, tip_pad};
use crate::hand::{Dof, Finger, PerDof};
use crate::sim::Scenario;
use crate::sim::object::{NamedObject, Object};
use crate::transport::Endpoint;
use crate::ui::hand::figures::{Figure, cross, picture_place};
use crate::ui::hand::finger_drag::FingerDrag;
use crate::ui::hand::panel::held;
use crate::ui::hand::scene::{HandPicture, Hurt};
use crate::ui::hand::view::{DrawSettings, FRONT, HandStage, HandUse, HandView, TURN, draw};
use crate::ui::theme::Palette;
use egui::{
    Context, Event, Id, Mesh, Modifiers, PointerButton, Pos2, RawInput, Rect, Sense, pos2, vec2,
};
use glam::Vec3;

const SIDES: [Side; 2] = [Side::Right, Side::Left];

fn setting(side: Side, size: f32) -> DrawSettings {
    DrawSettings {
        turn: HandView::default().turn(side),
        rect: Rect::from_min_size(pos2(30.0, 50.0), vec2(size, size)),
        theme: Theme::Dark,
        feather: 1.0,
    }
}

/// Fingers, bend and rotation of the thumb.
fn posed(side: Side, [fingers, bend, swing]: [f32; 3]) -> HandPicture {
    let shares = [fingers, fingers, fingers, fingers, bend, swing].map(Some);
    HandPicture::of(side, &PerDof::new(shares))
}

fn drawn(picture: &HandPicture, setting: &DrawSettings) -> (Sketch, Mesh) {
    let (mut sketch, mut mesh) = (Sketch::default(), Mesh::default());
    draw(&mut sketch, picture, setting, &mut mesh);
    (sketch, mesh)
}

#[test]
fn every_pose_is_finite_in_its_picture_and_within_its_triangles() {
    let turns = [
        TURN,
        Turn {
            yaw: 3.0,
            pitch: 1.2,
            roll: 0.0,
        },
        Turn {
            yaw: -1.6,
            pitch: -1.2,
            roll: 1.6,
        },
    ];
    for (side, turn) in SIDES
        .into_iter()
        .flat_map(|side| turns.map(|turn| (side, turn)))
    {
        for step in 0..=8u8 {
            let share = f32::from(step) / 8.0;
            let mut picture = posed(side, [share, 1.0 - share, share]);
            picture.held = held(&Endpoint::sim());
            let setting = DrawSettings {
                turn,
                ..setting(side, 400.0)
            };
            let (_, mesh) = drawn(
                &HandPicture {
                    held: None,
                    ..picture
                },
                &setting,
            );
            let (count, room) = (mesh.indices.len() / 3, setting.rect.expand(6.0));
            assert!(
                (3000..8000).contains(&count),
                "{count} triangles with their seams"
            );
            assert!(mesh.is_valid());
            for vertex in mesh.vertices {
                assert!(
                    room.contains(vertex.pos),
                    "{share} {turn:?}: {}",
                    vertex.pos
                );
            }
            let (_, small) = drawn(
                &picture,
                &DrawSettings {
                    rect: Rect::from_min_size(Pos2::ZERO, vec2(90.0, 90.0)),
                    ..setting
                },
            );
            assert!(small.vertices.iter().all(|vertex| !vertex.pos.any_nan()));
            assert!(small.indices.len() / 3 < count);
        }
    }
}

#[test]
fn fingers_close_towards_who_looks_from_the_front() {
    for side in SIDES {
        let front = DrawSettings {
            turn: FRONT,
            ..setting(side, 300.0)
        };
        let camera = front.camera(side);
        for finger in Finger::ALL {
            let near = |share: f32| {
                let picture = posed(side, [share, share, 1.0]);
                let pose = SegmentFrames::of_shares(side, &picture.actual.map(Option::unwrap));
                camera.hand.transform_point3(pose.tip(finger)).z
            };
            if finger != Finger::Thumb {
                assert!(near(0.75) > near(1.0) + 20.0 && near(0.5) > near(0.75) + 15.0);
                assert!(near(0.0) > near(1.0) + 30.0, "{side:?} {finger:?}");
            }
        }
    }
}

#[test]
fn a_close_is_seen_as_a_way_on_the_screen() {
    for side in SIDES {
        let camera = setting(side, 300.0).camera(side);
        for finger in Finger::ALL {
            let seen = |share: f32| {
                let picture = posed(side, [share, share, 1.0]);
                camera.place(picture.pose().tip(finger))
            };
            let steps = [1.0, 0.75, 0.5, 0.25, 0.0].map(seen);
            for pair in steps.windows(2) {
                let way = pair[0].distance(pair[1]);
                assert!(way > 8.0, "{side:?} {finger:?}: {way} points");
            }
        }
    }
}

#[test]
fn a_left_hand_is_the_mirror_image_on_the_screen() {
    let [right, left] = SIDES.map(|side| {
        let setting = setting(side, 300.0);
        let (_, mesh) = drawn(&posed(side, [0.4, 0.6, 0.8]), &setting);
        mesh.calc_bounds()
            .translate(-setting.rect.center().to_vec2())
    });
    assert!((right.left() + left.right()).abs() < 2.5 && (right.right() + left.left()).abs() < 2.5);
    assert!((right.top() - left.top()).abs() < 1.0 && (right.left() - left.left()).abs() > 20.0);
}

#[test]
fn the_joint_under_the_pointer_is_the_one_drawn_there() {
    for side in SIDES {
        let setting = setting(side, 400.0);
        let camera = setting.camera(side);
        // Open, the pads are seen; closed, the backs of the fingers.
        for (shares, out) in [([1.0; 3], 1.0), ([0.0, 1.0, 1.0], -16.0)] {
            let picture = posed(side, shares);
            let (sketch, mesh) = drawn(&picture, &setting);
            let pose = SegmentFrames::of_shares(side, &picture.actual.map(Option::unwrap));
            for finger in Finger::ALL {
                let [ahead, up] = shape::pad_ways(finger);
                let out = if finger == Finger::Thumb { 0.0 } else { out };
                let at = tip_pad(finger) + ahead * out - up * 6.0;
                let seen = pose.frame(Segment::tip(finger)).transform_point3(at);
                let place = camera.project(camera.hand.transform_point3(seen));
                let found = sketch.segment_at(&mesh, place);
                assert_eq!(
                    found.and_then(|seen| seen.segment.dof()),
                    Some(finger.bend()),
                    "{shares:?} {finger:?}"
                );
            }
            assert_eq!(sketch.segment_at(&mesh, setting.rect.right_top()), None);
            let palm = camera.project(camera.hand.transform_point3(Vec3::new(0.0, 14.0, 80.0)));
            let found = sketch.segment_at(&mesh, palm).map(|seen| seen.segment);
            assert_eq!(found, Some(Segment::Palm));
        }
    }
}

#[test]
fn only_what_is_off_target_has_a_ghost() {
    let palette = Palette::of(Theme::Light);
    let count = |dof: Dof, off: f32, is_known: bool| {
        let mut picture = posed(Side::Right, [0.5; 3]);
        picture.target = picture.actual;
        picture.target[dof] = Some(0.5 + off);
        if !is_known {
            picture.actual[Dof::Index] = None;
        }
        picture.parts(palette, false).1.len() - Segment::ALL.len()
    };
    assert_eq!(count(Dof::Index, 0.02, true), 0);
    assert_eq!(count(Dof::Index, 0.10, true), 2);
    assert_eq!(count(Dof::ThumbBend, -0.10, true), 3);
    assert_eq!(count(Dof::ThumbRotate, 0.10, true), 4);
    assert_eq!(count(Dof::Index, 0.10, false), 0);
}

#[test]
fn the_fingers_meet_what_is_drawn_before_them() {
    let mut all = vec![
        ("sim:".to_owned(), Object::of(Scenario::Idle)),
        (
            "sim:?scenario=rigid".to_owned(),
            Object::of(Scenario::Rigid),
        ),
        (
            "sim:?scenario=fragile".to_owned(),
            Object::of(Scenario::Fragile),
        ),
    ];
    all.extend(NamedObject::ALL.map(|own| (format!("sim:?object={}", own.name()), own.object())));
    for (endpoint, object) in all {
        let held = held(&endpoint.parse().expect("an address")).expect("an object");
        let solid = held.shape.solid();
        let places = || solid.corners.iter().map(|corner| corner.at);
        let (low, high) = (
            places().fold(Vec3::MAX, Vec3::min),
            places().fold(Vec3::MIN, Vec3::max),
        );
        let faces = || {
            let faces = solid.faces.iter();
            faces.filter(|face| face.offset > face.normal.dot(solid.middle))
        };
        #[expect(clippy::cast_possible_truncation, reason = "an angle of at most 1000")]
        let shares = object
            .contacts
            .map(|met| met.map_or(0.32, |met| met.angle as f32 / 1000.0));
        let pose = SegmentFrames::of_shares(Side::Right, &shares);
        let into = held.frame.inverse();
        let scale = held.frame.matrix3.x_axis.length();
        let fingers = [Finger::Little, Finger::Ring, Finger::Middle, Finger::Index];
        // An egg is narrower than the hand.
        let beside = |finger: &Finger| {
            let at = into.transform_point3(pose.tip(*finger)).x;
            (low.x..high.x).contains(&at)
        };
        let met: Vec<Finger> = fingers.into_iter().filter(beside).collect();
        assert!(met.len() >= 2, "{endpoint} {met:?}");
        for finger in met {
            let segment = Segment::tip(finger);
            let tip = shape::solid(segment, false).expect("each segment has a solid");
            let gap = tip.corners.iter().map(|corner| {
                let at = pose.frame(segment).transform_point3(corner.at);
                let at = into.transform_point3(at);
                let out = faces().map(|face| face.normal.dot(at) - face.offset);
                // The cup is open at an end.
                out.fold((low - at).max(at - high).max_element(), f32::max) * scale
            });
            let gap = gap.fold(f32::MAX, f32::min);
            assert!(
                (-8.0..8.0).contains(&gap),
                "{endpoint} {finger:?}: {gap} mm"
            );
        }
    }
}

/// A view of an open hand in a window of 300 by 300 points, driven by events.
struct DrivenView {
    context: Context,
    view: HandView,
    time: f64,
    movable: bool,
}

impl DrivenView {
    fn new(movable: bool) -> Self {
        Self {
            context: Context::default(),
            view: HandView::default(),
            time: 0.0,
            movable,
        }
    }

    fn pass(&mut self, events: Vec<Event>) -> HandUse {
        self.time += 0.05;
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(300.0, 300.0)));
        let input = RawInput {
            screen_rect,
            time: Some(self.time),
            events,
            ..RawInput::default()
        };
        let (view, movable) = (&mut self.view, self.movable);
        let mut used = HandUse::default();
        let mut output = self.context.run_ui(input, |ui| {
            let rect = ui.max_rect();
            let response = ui.interact(rect, Id::unique("hand"), Sense::click_and_drag());
            let picture = posed(Side::Right, [1.0; 3]);
            let stage = HandStage {
                rect,
                palette: Palette::of(Theme::Dark),
                picture: &picture,
                movable: PerDof::splat(movable),
            };
            used = view.ui(ui, &response, &stage);
        });
        output.textures_delta.clear();
        used
    }

    fn to(&mut self, at: Pos2) -> HandUse {
        self.pass(vec![Event::PointerMoved(at)])
    }

    fn button(&mut self, pressed: bool, at: Pos2) -> HandUse {
        self.pass(vec![Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }])
    }

    /// Where the tip of the index is seen.
    fn index(&self) -> Pos2 {
        self.view.points().unwrap().along[Finger::Index][0].unwrap() + vec2(0.0, 3.0)
    }
}

#[test]
fn the_lines_to_the_fingers_do_not_cross_in_any_pose() {
    let places = [vec2(300.0, 330.0), vec2(420.0, 500.0), vec2(640.0, 640.0)];
    let bends: Vec<[f32; 3]> = (0..=8u8)
        .map(|step| [f32::from(step) / 8.0, 0.6, 0.5])
        .chain([[0.0, 1.0, 1.0], [1.0, 0.0, 0.0]])
        .collect();
    for (side, turn) in SIDES
        .into_iter()
        .flat_map(|side| [TURN, FRONT].map(|turn| (side, turn)))
    {
        for (size, pose) in places
            .into_iter()
            .flat_map(|size| bends.iter().map(move |pose| (size, *pose)))
        {
            let place = Rect::from_min_size(Pos2::ZERO, size);
            let mut view = HandView::default();
            let setting = DrawSettings {
                rect: picture_place(place, side),
                turn: turn.of(side),
                ..setting(side, 1.0)
            };
            let picture = posed(side, pose);
            view.update(&picture, setting);
            let points = view.points().unwrap();
            let figures = Figure::all(place, &points);
            for one in Finger::ALL {
                for other in Finger::ALL.into_iter().filter(|other| *other != one) {
                    let both = figures[one].path.zip(figures[other].path);
                    assert!(
                        both.is_none_or(|(one, other)| !cross(one, other)),
                        "{side:?} {turn:?} {size} {pose:?}: {one:?} {other:?}"
                    );
                }
                // A line ends where its own finger is seen.
                if let Some(end) = figures[one].end {
                    let seen = view.sketch.segment_at(&view.mesh, end).unwrap();
                    assert_eq!(seen.segment.finger(), Some(one));
                }
            }
            let lines = Finger::ALL.map(|own| figures[own].path.is_some());
            let count = lines.into_iter().filter(|has| *has).count();
            assert!(count >= 3, "{side:?} {turn:?} {size} {pose:?}: {lines:?}");
            // In a small picture the labels are too close to each other for that.
            if pose[0] > 0.99 && size.x > 600.0 {
                for finger in [Finger::Little, Finger::Ring, Finger::Middle, Finger::Index] {
                    let end = figures[finger].path.map(|[.., end]| end);
                    let [tip, ..] = points.along[finger];
                    assert!(tip.is_some() && end == tip, "{finger:?}");
                }
            }
        }
    }
}

#[test]
fn each_finger_around_a_held_ball_has_its_line() {
    let place = Rect::from_min_size(Pos2::ZERO, vec2(420.0, 500.0));
    let setting = DrawSettings {
        rect: picture_place(place, Side::Right),
        turn: TURN,
        ..setting(Side::Right, 1.0)
    };
    let holding = [0.336, 0.372, 0.411, 0.391, 0.56, 0.1].map(Some);
    let mut view = HandView::default();
    view.update(
        &HandPicture::of(Side::Right, &PerDof::new(holding)),
        setting,
    );
    let points = view.points().unwrap();
    let figures = Figure::all(place, &points);
    for finger in Finger::ALL {
        let [tip, ..] = points.along[finger];
        assert!(tip.is_some(), "the tip of {finger:?} is seen");
        assert!(figures[finger].path.is_some(), "{finger:?} has no line");
    }
}

#[test]
fn a_drag_turns_the_hand_and_a_double_click_turns_it_back() {
    let mut driven = DrivenView::new(false);
    let at = |x: f32| pos2(x, 150.0);
    driven.to(at(150.0));
    driven.button(true, at(150.0));
    driven.to(at(190.0));
    driven.to(at(210.0));
    driven.button(false, at(210.0));
    let turned = driven.view.turn.unwrap();
    assert!((turned.yaw - TURN.yaw).abs() > 0.2 && (turned.pitch - TURN.pitch).abs() < 1e-3);
    for _ in 0..2 {
        driven.button(true, at(210.0));
        driven.button(false, at(210.0));
    }
    assert_eq!(driven.view.turn, None);
    // A finger is found where it is drawn, and lights up there.
    let index = driven.index();
    assert_eq!(driven.to(index).joint, Some(Dof::Index));
    assert_eq!(driven.view.drawn.unwrap().0.lit, Some(Dof::Index));
    assert_eq!(driven.to(pos2(5.0, 5.0)).joint, None);
    driven.to(pos2(5.0, 5.0));
    assert_eq!(driven.view.drawn.unwrap().0.lit, None);
}

#[test]
fn an_open_fingertip_is_seen_from_the_front_unless_the_user_turned_the_hand() {
    let context = Context::default();
    let mut view = HandView::default();
    let turn = |is_frontal: bool, view: &mut HandView| {
        let mut output = context.run_ui(RawInput::default(), |ui| {
            ui.style_mut().animation_time = 0.0;
            view.face(ui, is_frontal);
        });
        output.textures_delta.clear();
        view.turn(Side::Right)
    };
    assert_eq!(turn(false, &mut view), TURN);
    assert_eq!(turn(true, &mut view), FRONT);
    assert_eq!(turn(false, &mut view), TURN);
    let own = Turn { yaw: 1.0, ..TURN };
    view.turn = Some(own);
    assert_eq!(turn(true, &mut view), own);
}

#[test]
fn a_finger_is_dragged_only_while_it_may_be_moved_and_then_turns_nothing() {
    let mut driven = DrivenView::new(true);
    driven.to(pos2(5.0, 5.0));
    let from = driven.index();
    driven.to(from);
    driven.button(true, from);
    let mut last = 1.0;
    for step in 1..=8u8 {
        let used = driven.to(from + vec2(0.0, f32::from(step) * 8.0));
        let Some((dof, share)) = used.moved else {
            panic!("{step}: {used:?}")
        };
        assert_eq!(dof, Dof::Index);
        assert!(
            (0.0..=last).contains(&share),
            "{step}: {share} after {last}"
        );
        last = share;
    }
    assert!(last < 0.7, "{last}");
    // Disarmed meanwhile: nothing follows the pointer any more, also if it is armed again before it is let go.
    for movable in [false, true] {
        driven.movable = movable;
        let used = driven.to(from + vec2(f32::from(u8::from(movable)) * 30.0 + 9.0, 30.0));
        assert_eq!(used.moved, None, "{movable}");
    }
    assert_eq!(driven.view.turn, None);
    driven.button(false, from);
    // What may not be moved turns the picture.
    driven.movable = false;
    driven.to(from);
    driven.button(true, from);
    assert_eq!(driven.to(from + vec2(40.0, 0.0)).moved, None);
    assert!(driven.view.turn.is_some());
}

#[test]
fn a_dragged_place_follows_the_pointer_without_jumps_from_wherever_it_is_seen() {
    let front = TURN;
    let turned = Turn {
        yaw: -0.7,
        pitch: 0.3,
        roll: 0.0,
    };
    for (side, turn) in SIDES
        .into_iter()
        .flat_map(|side| [front, turned].map(|turn| (side, turn)))
    {
        let setting = DrawSettings {
            turn: turn.of(side),
            ..setting(side, 500.0)
        };
        let camera = setting.camera(side);
        for finger in Finger::ALL {
            let dof = finger.bend();
            let seen = |share: f32| {
                let mut picture = posed(side, [1.0; 3]);
                picture.actual[dof] = Some(share);
                let at = camera.hand.transform_point3(picture.pose().tip(finger));
                (picture, camera.project(at), at.z)
            };
            let (picture, from, depth) = seen(1.0);
            let hold = || {
                let segment = Segment::tip(finger);
                FingerDrag::new(&camera, &picture, SeenPlace { segment, depth }, from).unwrap()
            };
            // Along its own way it is where the pointer is.
            let mut drag = hold();
            for step in 1..=20u8 {
                let share = 1.0 - f32::from(step) / 20.0;
                let found = drag.follow(&camera, &picture, seen(share).1);
                assert!(
                    (found - share).abs() < 0.05,
                    "{side:?} {finger:?} {share}: {found}"
                );
            }
            // Straight to where it ends it goes that way only, in steps, and gets there.
            let (mut drag, mut last) = (hold(), 1.0);
            for step in 1..=100u8 {
                let to = from.lerp(seen(0.0).1, f32::from(step) / 100.0);
                let share = drag.follow(&camera, &picture, to);
                assert!(
                    share <= last + 1e-3,
                    "{side:?} {finger:?}: {share} after {last}"
                );
                assert!(
                    last - share < 0.06,
                    "{side:?} {finger:?}: {share} after {last}"
                );
                last = share;
            }
            assert!(last < 0.08, "{side:?} {finger:?}: {last}");
            // Beyond its end it stays there.
            let beyond = (seen(0.0).1 - from) * 9.0;
            let share = drag.follow(&camera, &picture, from + beyond);
            assert!((0.0..0.03).contains(&share), "{side:?} {finger:?}: {share}");
        }
    }
}

#[test]
fn a_fault_is_seen_before_warmth_and_neither_on_another_joint() {
    let palette = Palette::of(Theme::Dark);
    let mut picture = posed(Side::Right, [1.0; 3]);
    picture.hurts[Dof::Ring].heat = 0.5;
    picture.hurts[Dof::ThumbRotate] = Hurt {
        is_bad: true,
        heat: 1.0,
    };
    let (_, parts) = picture.parts(palette, false);
    let glow = |segment| {
        let mut own = parts.iter().filter(|part| part.segment == Some(segment));
        own.next().unwrap().coat.glow.map(|(color, _)| color)
    };
    assert_eq!(glow(Segment::Thumb1), Some(palette.bad));
    assert_eq!(glow(Segment::Thumb4), None);
    assert_eq!(glow(Segment::Index2), None);
    let warm = glow(Segment::Ring2).unwrap();
    assert!(warm != palette.bad && warm != palette.warn, "{warm:?}");
}
