//! Where the twelve joints of the hand are for six driven angles: pure geometry for pictures. Nothing here feeds control.
//!
//! Spans and couplings are those of the maker's robot description of the FTP hand (finger 1.4381 rad, coupled joint
//! 1.0843 times as much; thumb swing 1.1641, bend 0.5864, coupled 0.8024 and 0.9487 of that). Lengths are rounded from
//! photographs: the manual gives none. Manual: which end of the thumb's rotation lies across the palm is open; here 0 does.

use crate::hand::dof::{Dof, Finger, PerDof, PerFinger};
use std::sync::LazyLock;

/// A point in millimetres: x from the little finger to the thumb, y from wrist to fingertips, z out of the palm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Across the palm, towards the thumb.
    pub x: f32,
    /// Along the palm, towards the fingertips.
    pub y: f32,
    /// Out of the palm, towards who looks into it.
    pub z: f32,
}

/// The bones of one finger, from the knuckle to the tip: two bones for a finger, three for the thumb.
pub type Bones = arrayvec::ArrayVec<Point, 4>;

/// Proximal joint of a finger from open to bent, in radians.
const FINGER_SPAN: f32 = 1.4381;
/// Distal joint of a finger, as a part of the proximal one.
const FINGER_COUPLING: f32 = 1.0843;
/// The thumb's rotation, in radians.
const SWING_SPAN: f32 = 1.1641;
/// The thumb's rotation where it is open: a little out of the palm's plane already.
const SWING_OPEN: f32 = 0.25;
/// The thumb's first bend, in radians.
const THUMB_SPAN: f32 = 0.5864;
/// The thumb's coupled joints, each as a part of the one before.
const THUMB_COUPLING: [f32; 2] = [0.8024, 0.9487];
/// The thumb leaves the palm this far from the palm's long axis, in radians.
const THUMB_LEAN: f32 = 1.05;

/// Corners of the palm, seen from the front.
pub const PALM: [Point; 6] = [
    Point::flat(-38.0, 82.0),
    Point::flat(38.0, 88.0),
    Point::flat(40.0, 40.0),
    Point::flat(28.0, 0.0),
    Point::flat(-28.0, 0.0),
    Point::flat(-40.0, 40.0),
];

struct Build {
    knuckle: Point,
    bones: &'static [f32],
    /// Sideways lean of an open finger, in radians.
    fan: f32,
}

const fn build(finger: Finger) -> Build {
    let (knuckle, bones, fan): (_, &'static [f32], _) = match finger {
        Finger::Little => (Point::flat(-30.0, 78.0), &[28.0, 32.0], -0.10),
        Finger::Ring => (Point::flat(-10.0, 84.0), &[33.0, 38.0], -0.03),
        Finger::Middle => (Point::flat(10.0, 87.0), &[35.0, 40.0], 0.03),
        Finger::Index => (Point::flat(30.0, 84.0), &[33.0, 38.0], 0.08),
        Finger::Thumb => (Point::flat(28.0, 20.0), &[38.0, 30.0, 26.0], 0.0),
    };
    Build {
        knuckle,
        bones,
        fan,
    }
}

impl Point {
    const fn flat(x: f32, y: f32) -> Self {
        Self { x, y, z: 0.0 }
    }

    fn along(self, way: Self, length: f32) -> Self {
        Self {
            x: self.x + way.x * length,
            y: self.y + way.y * length,
            z: self.z + way.z * length,
        }
    }
}

/// The joints of each finger. A finger whose angle is not known has none: no pose is made up.
///
/// `angles` are shares of the way from bent (0.0) to open (1.0); values outside are cut, as the drives cannot pass their ends.
#[must_use]
pub fn joints(angles: &PerDof<Option<f32>>) -> PerFinger<Option<Bones>> {
    PerFinger::from_fn(|finger| match finger {
        Finger::Thumb => {
            let bend = bent(angles[Dof::ThumbBend])?;
            let swing = bent(angles[Dof::ThumbRotate])?;
            Some(thumb(bend, swing))
        }
        _ => Some(straight(finger, bent(angles[finger.bend()])?)),
    })
}

/// The way across a finger's pad, to the right of who looks onto it with its tip up: of length 1. `None` where the
/// thumb's rotation is not known.
#[must_use]
pub fn across(angles: &PerDof<Option<f32>>, finger: Finger) -> Option<Point> {
    if finger != Finger::Thumb {
        return Some(Point::flat(1.0, 0.0));
    }
    let (sin, cos) = swing(bent(angles[Dof::ThumbRotate])?).sin_cos();
    Some(Point {
        x: -sin,
        y: 0.0,
        z: cos,
    })
}

/// Steps from bent to open in which the poses are tried.
const STEPS: u8 = 8;

/// Where the fingers get to, in all poses: a picture that holds these holds them all, but for a millimetre or two.
pub static REACH: LazyLock<Vec<Point>> = LazyLock::new(|| {
    let shares = || (0..=STEPS).map(|step| f32::from(step) / f32::from(STEPS));
    let mut points = PALM.to_vec();
    for bend in shares() {
        for finger in [Finger::Little, Finger::Ring, Finger::Middle, Finger::Index] {
            points.extend(straight(finger, bend));
        }
        points.extend(shares().flat_map(|swung| thumb(bend, swung)));
    }
    points
});

/// Share of the way from open to bent.
fn bent(angle: Option<f32>) -> Option<f32> {
    Some(1.0 - angle?.clamp(0.0, 1.0))
}

fn straight(finger: Finger, bent: f32) -> Bones {
    let build = build(finger);
    let first = bent * FINGER_SPAN;
    let turns = [first, first * (1.0 + FINGER_COUPLING)];
    let lean = build.fan * (1.0 - bent);
    chain(&build, &turns, |turn| Point {
        x: lean.sin() * turn.cos(),
        y: lean.cos() * turn.cos(),
        z: turn.sin(),
    })
}

fn thumb(bent: f32, swung: f32) -> Bones {
    let build = build(Finger::Thumb);
    let swing = swing(swung);
    let first = bent * THUMB_SPAN;
    let second = first * THUMB_COUPLING[0];
    let third = second * THUMB_COUPLING[1];
    let turns = [first, first + second, first + second + third];
    // Bending turns the thumb in the plane of the palm's long axis and the swung thumb, towards that axis and over it.
    chain(&build, &turns, |turn| {
        let lean = THUMB_LEAN - turn;
        Point {
            x: lean.sin() * swing.cos(),
            y: lean.cos(),
            z: lean.sin() * swing.sin(),
        }
    })
}

/// The thumb's plane, in radians out of that of the palm.
fn swing(swung: f32) -> f32 {
    SWING_OPEN + swung * SWING_SPAN
}

fn chain(build: &Build, turns: &[f32], way: impl Fn(f32) -> Point) -> Bones {
    let mut points = Bones::new();
    let mut end = build.knuckle;
    points.push(end);
    for (length, turn) in build.bones.iter().zip(turns) {
        end = end.along(way(*turn), *length);
        points.push(end);
    }
    points
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]
    use super::*;

    fn tip(angles: &PerDof<Option<f32>>, finger: Finger) -> Point {
        *joints(angles)[finger].clone().unwrap().last().unwrap()
    }

    #[test]
    fn there_are_twelve_joints() {
        let all = joints(&PerDof::splat(Some(0.5)));
        let bones: usize = Finger::ALL
            .iter()
            .map(|finger| all[*finger].as_ref().unwrap().len() - 1)
            .sum();
        // One joint before each bone, and the thumb's rotation.
        assert_eq!(bones + 1, 12);
    }

    #[test]
    fn zero_is_a_fist_and_one_is_open() {
        let (open, fist) = (PerDof::splat(Some(1.0)), PerDof::splat(Some(0.0)));
        for finger in [Finger::Little, Finger::Ring, Finger::Middle, Finger::Index] {
            assert!(tip(&open, finger).y > 130.0 && tip(&open, finger).z.abs() < 1.0);
            assert!(tip(&fist, finger).y < 90.0 && tip(&fist, finger).z > 20.0);
        }
    }

    #[test]
    fn the_thumb_swings_from_beside_the_palm_to_before_it() {
        let mut angles = PerDof::splat(Some(1.0));
        let beside = tip(&angles, Finger::Thumb);
        angles[Dof::ThumbRotate] = Some(0.0);
        let before = tip(&angles, Finger::Thumb);
        assert!(beside.x > before.x + 20.0 && before.z > beside.z + 20.0);
    }

    #[test]
    fn the_way_across_a_pad_is_square_to_its_bone() {
        let angles = PerDof::splat(Some(0.4));
        for finger in Finger::ALL {
            let across = across(&angles, finger).unwrap();
            let bones = joints(&angles)[finger].clone().unwrap();
            let (from, to) = (bones[bones.len() - 2], bones[bones.len() - 1]);
            let along = (to.x - from.x, to.y - from.y, to.z - from.z);
            let dot = along.0 * across.x + along.1 * across.y + along.2 * across.z;
            // A finger that leans a little sideways is not quite square to the palm's width.
            assert!(dot.abs() < 3.0, "{finger:?}: {dot}");
            let length = across.x.hypot(across.y).hypot(across.z);
            assert!((length - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn no_pose_leaves_the_reach() {
        let most = |of: fn(&Point) -> f32| REACH.iter().map(of).fold(f32::MIN, f32::max);
        for step in 0..=20u8 {
            let mut angles = PerDof::splat(Some(f32::from(step) / 20.0));
            angles[Dof::ThumbRotate] = Some(1.0 - f32::from(step) / 20.0);
            for (_, bones) in joints(&angles).iter() {
                for point in bones.iter().flatten() {
                    assert!(point.x <= most(|point| point.x) + 2.0);
                    assert!(point.y <= most(|point| point.y) + 2.0);
                    assert!(point.z <= most(|point| point.z) + 2.0);
                }
            }
        }
    }

    #[test]
    fn an_unknown_angle_gives_no_finger_and_leaves_the_others() {
        let mut angles = PerDof::splat(Some(0.3));
        angles[Dof::Ring] = None;
        angles[Dof::ThumbRotate] = None;
        let all = joints(&angles);
        assert!(all[Finger::Ring].is_none() && all[Finger::Thumb].is_none());
        assert!(all[Finger::Index].is_some());
    }

    #[test]
    fn angles_beyond_their_ends_are_drawn_at_their_ends() {
        let (beyond, end) = (PerDof::splat(Some(1.7)), PerDof::splat(Some(1.0)));
        assert_eq!(joints(&beyond), joints(&end));
    }
}
