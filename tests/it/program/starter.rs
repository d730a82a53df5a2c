//! The shipped library: whole, gentle, and no way between two of its poses on which the thumb meets a finger.

use glam::Vec3;
use handscope::hand::kinematics::{Segment, SegmentFrames, Side};
use handscope::hand::{Angle, Dof, PerDof};
use handscope::poses::library::LibraryPose;
use handscope::poses::starter::starter;
use handscope::poses::way::{Targets, way};
use std::collections::BTreeSet;

/// A round bar in the frame of its segment: from, to, radius, in millimetres. As thick as the drawn hand.
type Bar = ([f32; 3], [f32; 3], f32);

/// Half the thickness of the second segments, which become slim towards the tip.
fn finger(length: f32, thick: f32) -> [Bar; 3] {
    let along = |at: f32| 8.8 + (at - 8.8) * (length - 8.8) / (53.9 - 8.8);
    let at = |y: f32| [0.0, along(y), -6.1];
    [
        ([0.0, 0.0, -6.1], at(36.0), 8.3 * thick),
        (at(36.0), at(46.5), 7.2 * thick),
        (at(46.5), at(50.5), 5.2 * thick),
    ]
}

const FIRST: [Bar; 1] = [([0.0, 0.0, -6.65], [0.0, 32.6, -6.65], 8.9)];

fn thumb() -> Vec<(Segment, Bar)> {
    let bar = |segment, [x, y]: [f32; 2], from: f32, to: f32, radius| {
        let way = Vec3::new(x, y, 0.0).normalize();
        let at = |along: f32| (way * along + Vec3::Z * -7.2).to_array();
        (segment, (at(from), at(to), radius))
    };
    let tip = [0.93, 0.3676];
    vec![
        bar(Segment::Thumb2, [31.403, 21.069], 0.0, 37.8, 10.5),
        bar(Segment::Thumb3, [21.903, 12.816], 0.0, 25.4, 9.2),
        bar(Segment::Thumb4, tip, 0.0, 24.0, 8.8),
        bar(Segment::Thumb4, tip, 24.0, 30.0, 7.5),
        bar(Segment::Thumb4, tip, 30.0, 33.5, 4.6),
    ]
}

fn bars(dof: Dof) -> Vec<(Segment, Bar)> {
    let (first, second, length, thick) = match dof {
        Dof::Little => (Segment::Little1, Segment::Little2, 43.8, 0.9),
        Dof::Ring => (Segment::Ring1, Segment::Ring2, 53.9, 1.0),
        Dof::Middle => (Segment::Middle1, Segment::Middle2, 57.6, 1.0),
        _ => (Segment::Index1, Segment::Index2, 53.9, 1.0),
    };
    let second = finger(length, thick).map(|bar| (second, bar));
    FIRST
        .map(|bar| (first, bar))
        .into_iter()
        .chain(second)
        .collect()
}

/// The least distance of two lines between their ends.
fn apart([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> f32 {
    let (u, v, r) = (b - a, d - c, a - c);
    let (uu, vv, uv, ur, vr) = (u.dot(u), v.dot(v), u.dot(v), u.dot(r), v.dot(r));
    let det = uu * vv - uv * uv;
    let mut s = match det > 1e-6 {
        true => ((uv * vr - ur * vv) / det).clamp(0.0, 1.0),
        false => 0.0,
    };
    let mut t = (uv * s + vr) / vv;
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = ((uv * t - ur) / uu).clamp(0.0, 1.0);
    }
    (a + u * s).distance(c + v * t)
}

/// The room between thumb and a finger at these angles, in millimetres; negative where they are in each other.
pub(super) fn room(dof: Dof, angles: &PerDof<f32>) -> f32 {
    let frames = SegmentFrames::of_shares(Side::Right, &angles.map(|angle| angle / 1000.0));
    let placed = |(segment, (from, to, radius)): (Segment, Bar)| {
        let frame = frames.frame(segment);
        let ends = [from, to].map(|end| frame.transform_point3(Vec3::from_array(end)));
        (ends, radius)
    };
    let thumb: Vec<_> = thumb().into_iter().map(placed).collect();
    let mut least = f32::INFINITY;
    for (finger, radius) in bars(dof).into_iter().map(placed) {
        for (thumb, other) in &thumb {
            least = least.min(apart(finger, *thumb) - radius - other);
        }
    }
    least
}

/// The least room on the way from some angles to others, whichever joint is faster: all of the box between them.
pub(super) fn least_room(from: &PerDof<i16>, to: &PerDof<i16>) -> f32 {
    const STEPS: u8 = 4;
    let between = |dof: Dof| {
        let (from, to) = (f32::from(from[dof]), f32::from(to[dof]));
        let steps = if from == to { 0 } else { STEPS };
        (0..=steps).map(move |step| from + (to - from) * f32::from(step) / f32::from(steps.max(1)))
    };
    let mut least = f32::INFINITY;
    for dof in [Dof::Little, Dof::Ring, Dof::Middle, Dof::Index] {
        for finger in between(dof) {
            for bend in between(Dof::ThumbBend) {
                for rotate in between(Dof::ThumbRotate) {
                    let mut angles = PerDof::splat(1000.0);
                    angles[dof] = finger;
                    (angles[Dof::ThumbBend], angles[Dof::ThumbRotate]) = (bend, rotate);
                    least = least.min(room(dof, &angles));
                }
            }
        }
    }
    least
}

pub(super) fn along(from: &PerDof<i16>, legs: &[Targets]) -> f32 {
    let mut at = *from;
    let mut least = f32::INFINITY;
    for leg in legs {
        let next = PerDof::from_fn(|dof| leg[dof].map_or(at[dof], Angle::get));
        least = least.min(least_room(&at, &next));
        at = next;
    }
    least
}

fn angles(pose: &LibraryPose) -> PerDof<i16> {
    pose.angles.map(Angle::get)
}

#[test]
fn thumb_and_fingers_never_meet_on_the_way_between_two_shipped_poses() {
    let poses = &starter().poses;
    let mut direct_meets = 0;
    for from in poses {
        for to in poses.iter().filter(|to| to.id != from.id) {
            let legs = way(&angles(from).map(Some), &to.targets());
            let least = along(&angles(from), &legs);
            assert!(
                least >= 0.0,
                "{} -> {}: {least:.1} mm on {legs:?}",
                from.name,
                to.name
            );
            let direct = least_room(&angles(from), &angles(to));
            direct_meets += u32::from(direct < -1.0);
        }
    }
    assert!(
        direct_meets > 10,
        "the straight way may meet: {direct_meets}"
    );
}

#[test]
fn a_hand_that_is_at_a_pose_takes_it_again_without_moving_the_thumb_out() {
    for pose in &starter().poses {
        for noise in [-20, -3, 3, 20] {
            for (dof, other) in [(Dof::Index, Dof::ThumbBend), (Dof::ThumbBend, Dof::Index)] {
                let mut at = angles(pose);
                at[dof] += noise;
                at[other] -= noise;
                assert_eq!(way(&at.map(Some), &pose.targets()), [pose.targets()]);
            }
        }
    }
}

#[test]
fn a_way_ends_at_the_pose_and_touches_no_joint_that_is_left_alone() {
    for from in &starter().poses {
        for to in &starter().poses {
            for leave in Dof::ALL {
                let mut wanted = to.targets();
                wanted[leave] = None;
                let mut at = angles(from).map(Some);
                for leg in way(&at.clone(), &wanted) {
                    assert_eq!(leg[leave], None, "{} -> {}", from.name, to.name);
                    at = PerDof::from_fn(|dof| leg[dof].map(Angle::get).or(at[dof]));
                }
                for dof in Dof::ALL.into_iter().filter(|dof| *dof != leave) {
                    assert_eq!(at[dof], Some(to.angles[dof].get()));
                }
            }
        }
    }
}

#[test]
fn the_shipped_library_is_gentle_named_in_both_languages_and_has_a_key_each() {
    let library = starter();
    let mut keys = BTreeSet::new();
    for pose in &library.poses {
        assert!(
            pose.speed.get() <= 600 && pose.force.get() <= 500,
            "{pose:?}"
        );
        assert!(!pose.name_zh.is_empty());
        let is_demo = pose.is_for_demos();
        assert_eq!(pose.key.is_none(), is_demo, "{}", pose.name);
        assert!(pose.key.is_none_or(|key| keys.insert(key)), "{}", pose.name);
    }
    let steps = library.sequences.iter().flat_map(|own| &own.steps);
    assert!(steps.map(|step| step.speed.get()).max() <= Some(600));
    let names = library
        .entries()
        .map(|entry| library.named(entry).unwrap().text);
    let distinct: BTreeSet<_> = names.collect();
    assert_eq!(distinct.len(), library.entries().count(), "hidden by name");
    let named = library.sequences.iter().map(|own| (&own.name_zh, own.key));
    let named = named.chain(library.reactions.iter().map(|own| (&own.name_zh, own.key)));
    for (name_zh, key) in named {
        assert!(!name_zh.is_empty() && keys.insert(key.unwrap()));
    }
    let names = "Open, Fist, Point, V, OK, Thumbs up, Rock, Call, One, Two, Three, Four, Five, Power grasp, Tripod, Pinch, Lateral, Hook";
    for name in names.split(", ") {
        assert!(library.pose_named(name).is_some(), "{name}");
    }
    assert_eq!((library.sequences.len(), library.reactions.len()), (4, 1));
}
