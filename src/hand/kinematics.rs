//! Positions of the hand's segments for six driven angles: pure geometry, for rendering and for grips by size ([`crate::hand::gap`]).
//!
//! The numbers are those of a public model of the FTP right hand (unitreerobotics/unitree_ros,
//! `robots/g1_description/inspire_hand/FTP_right_hand.urdf`, BSD-3-Clause, Unitree Robotics): numbers only, no meshes.
//! Millimetres and radians; x towards the little finger, y out of the palm, z towards the fingertips, origin at the centre of
//! the wrist flange. The left hand is the mirror image in x.

use crate::hand::dof::{Dof, Finger, PerDof};
use glam::{Affine3, EulerRot, Mat3, Quat, Vec3};
use serde::{Deserialize, Serialize};
use std::f32::consts::FRAC_PI_2;

/// Left or right hand; the model is the same, mirrored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The thumb is on the left when looking at the back of the hand.
    #[default]
    Right,
    /// Its mirror image.
    Left,
}

impl Side {
    /// Number of motors of both hands, where they are numbered consecutively as in Unitree's messages.
    pub const MOTORS: usize = 2 * Dof::ALL.len();

    /// Index of this hand's first motor: the right hand's come first.
    pub const fn first_motor(self) -> usize {
        match self {
            Self::Right => 0,
            Self::Left => Dof::ALL.len(),
        }
    }

    /// Returns the other side.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }

    /// Frame of the palm. A left hand's frames are mirrored, so that one mesh fits both hands.
    pub fn frame(self) -> Affine3 {
        let x = if self == Self::Left { -1.0 } else { 1.0 };
        Affine3::from_scale(Vec3::new(x, 1.0, 1.0))
    }
}

/// A rigid part of the hand, numbered from the palm or the knuckle outwards. Each except the palm follows one of the twelve joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are the model's")]
pub enum Segment {
    Palm,
    Little1,
    Little2,
    Ring1,
    Ring2,
    Middle1,
    Middle2,
    Index1,
    Index2,
    Thumb1,
    Thumb2,
    Thumb3,
    Thumb4,
}

use Segment::{Index1, Little1, Middle1, Palm, Ring1, Thumb1, Thumb2, Thumb3};

impl Segment {
    /// All segments, each after its parent.
    #[rustfmt::skip]
    pub const ALL: [Self; 13] = [
        Palm, Little1, Self::Little2, Ring1, Self::Ring2, Middle1, Self::Middle2, Index1, Self::Index2,
        Thumb1, Thumb2, Thumb3, Self::Thumb4,
    ];

    /// Drive that moves this segment relative to its parent; `None` for the palm.
    pub const fn dof(self) -> Option<Dof> {
        Some(match self {
            Palm => return None,
            Little1 | Self::Little2 => Dof::Little,
            Ring1 | Self::Ring2 => Dof::Ring,
            Middle1 | Self::Middle2 => Dof::Middle,
            Index1 | Self::Index2 => Dof::Index,
            Thumb1 => Dof::ThumbRotate,
            Thumb2 | Thumb3 | Self::Thumb4 => Dof::ThumbBend,
        })
    }

    /// Finger to which it belongs; `None` for the palm.
    pub fn finger(self) -> Option<Finger> {
        self.dof().map(Dof::finger)
    }

    /// Returns the segment that carries the tip of a finger.
    pub const fn tip(finger: Finger) -> Self {
        match finger {
            Finger::Little => Self::Little2,
            Finger::Ring => Self::Ring2,
            Finger::Middle => Self::Middle2,
            Finger::Index => Self::Index2,
            Finger::Thumb => Self::Thumb4,
        }
    }
}

/// Travel of each drive's own joint from open (1000) to bent (0), radians.
pub const RANGE: PerDof<f32> = PerDof::new([1.4381, 1.4381, 1.4381, 1.4381, 0.5864, 1.1641]);

/// A segment's joint: parent, position (mm), orientation (roll, pitch, yaw), and rotation about z relative to its drive.
struct SegmentJoint {
    parent: Segment,
    at: [f32; 3],
    turned: [f32; 3],
    ratio: f32,
}

const fn joint(parent: Segment, at: [f32; 3], turned: [f32; 3], ratio: f32) -> SegmentJoint {
    SegmentJoint {
        parent,
        at,
        turned,
        ratio,
    }
}

/// Joints of all segments except the palm, in the order of [`Segment::ALL`].
#[rustfmt::skip]
const JOINTS: [SegmentJoint; 12] = [
    joint(Palm, [25.916, 0.565, 153.65], [1.4661, 0.0, -FRAC_PI_2], 1.0),
    joint(Little1, SECOND, [0.0; 3], 1.0843),
    joint(Palm, [4.530, 0.565, 156.83], [1.5184, 0.0, -FRAC_PI_2], 1.0),
    joint(Ring1, SECOND, [0.0; 3], 1.0843),
    joint(Palm, [-17.100, 0.565, 157.00], [FRAC_PI_2, 0.0, -FRAC_PI_2], 1.0),
    joint(Middle1, SECOND, [0.0; 3], 1.0843),
    joint(Palm, [-38.679, 0.565, 156.40], [1.6057, 0.0, -FRAC_PI_2], 1.0),
    joint(Index1, SECOND, [0.0; 3], 1.0843),
    joint(Palm, [-26.900, 21.010, 68.90], [0.0; 3], -1.0),
    joint(Thumb1, [-7.925, 9.060, 5.20], [FRAC_PI_2, 0.0, 2.8798], 1.0),
    joint(Thumb2, [31.403, 21.069, 0.95], [0.0; 3], 0.8024),
    joint(Thumb3, [21.903, 12.816, -0.30], [0.0; 3], 0.8024 * 0.9487),
];

/// Joint between a segment of the right hand and its parent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointPlace {
    /// Parent segment.
    pub parent: Segment,
    /// Position in the parent's frame, mm.
    pub at_mm: [f32; 3],
    /// Orientation in the parent's frame while the hand is open: roll, pitch and yaw, radians.
    pub turned: [f32; 3],
    /// Rotation about its z axis per radian of its drive; 1 or -1 for the drive's own joint.
    pub ratio: f32,
}

/// Returns the joint of a segment; `None` for the palm.
pub fn joint_place(segment: Segment) -> Option<JointPlace> {
    let at = (segment as usize).checked_sub(1)?;
    let own = JOINTS.get(at)?;
    Some(JointPlace {
        parent: own.parent,
        at_mm: own.at,
        turned: own.turned,
        ratio: own.ratio,
    })
}

/// Joint names in the order of [`Segment::ALL`], without side and suffix; in full: `right_little_1_joint`.
#[rustfmt::skip]
const JOINT_NAMES: [&str; 12] = [
    "little_1", "little_2", "ring_1", "ring_2", "middle_1", "middle_2", "index_1", "index_2",
    "thumb_1", "thumb_2", "thumb_3", "thumb_4",
];

/// Names of the twelve joints as in the manufacturer's model.
pub fn joint_names(side: Side) -> Vec<String> {
    let side = match side {
        Side::Right => "right",
        Side::Left => "left",
    };
    let name = |joint: &&str| format!("{side}_{joint}_joint");
    JOINT_NAMES.iter().map(name).collect()
}

/// Rotation of a driven joint in radians at this drive angle, 0..=1000: 0 open.
pub fn driven_radians(dof: Dof, angle: i16) -> f64 {
    (1.0 - f64::from(angle) / 1000.0) * f64::from(RANGE[dof])
}

/// Rotations of the twelve joints in radians at these drive angles, 0..=1000; NaN for an unknown angle.
pub fn joint_radians(angles: &PerDof<Option<i16>>) -> Vec<f64> {
    let turned = |(segment, joint): (Segment, &SegmentJoint)| {
        let dof = segment.dof()?;
        Some(driven_radians(dof, angles[dof]?) * f64::from(joint.ratio.abs()))
    };
    let joints = Segment::ALL.into_iter().skip(1).zip(&JOINTS);
    joints
        .map(|joint| turned(joint).unwrap_or(f64::NAN))
        .collect()
}

/// Position of the second joint of the four fingers, mm.
const SECOND: [f32; 3] = [-3.426, 32.596, -0.55];

/// Centre of a fingertip's pad in the frame of [`Segment::tip`], mm. This hand (capacitive) has no other pads.
pub const fn tip_pad(finger: Finger) -> Vec3 {
    match finger {
        Finger::Little => Vec3::new(-6.40, 42.71, -6.12),
        Finger::Ring | Finger::Index => Vec3::new(-8.62, 52.57, -6.10),
        Finger::Middle => Vec3::new(-9.83, 56.05, -6.10),
        Finger::Thumb => Vec3::new(28.99, 17.30, -7.35),
    }
}

/// Frames of all segments in the palm's frame: y along a straight finger, with the joint at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SegmentFrames([Affine3; 13]);

impl SegmentFrames {
    /// Computes the frames from the angles of the six drives in radians, 0 = open. Angles are clamped to [`RANGE`].
    pub fn of_radians(side: Side, angles: &PerDof<f32>) -> Self {
        let mut pose = Self([side.frame(); 13]);
        for (segment, joint) in Segment::ALL.into_iter().skip(1).zip(&JOINTS) {
            let angle = segment
                .dof()
                .map_or(0.0, |dof| angles[dof].clamp(0.0, RANGE[dof]));
            let [roll, pitch, yaw] = joint.turned;
            let standing = Quat::from_euler(EulerRot::ZYX, yaw, pitch, roll);
            let turn = Mat3::from_quat(standing * Quat::from_rotation_z(angle * joint.ratio));
            let frame =
                pose.frame(joint.parent) * Affine3::from_mat3_translation(turn, joint.at.into());
            if let Some(own) = pose.0.get_mut(segment as usize) {
                *own = frame;
            }
        }
        pose
    }

    /// Computes the frames from shares of the travel from bent (0) to open (1): ANGLE_ACT / 1000 (manual 2.6.11).
    pub fn of_shares(side: Side, shares: &PerDof<f32>) -> Self {
        let angles = PerDof::from_fn(|dof| (1.0 - shares[dof]) * RANGE[dof]);
        Self::of_radians(side, &angles)
    }

    /// Frame of a segment.
    pub fn frame(&self, segment: Segment) -> Affine3 {
        self.0.get(segment as usize).copied().unwrap_or_default()
    }

    /// Centre of a fingertip's pad in the palm's frame, mm.
    pub fn tip(&self, finger: Finger) -> Vec3 {
        self.frame(Segment::tip(finger))
            .transform_point3(tip_pad(finger))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may")]
    use super::*;

    /// 100 poses of the model, reckoned apart from this code.
    const POSES: &str = include_str!("../../tests/geometry/forward-kinematics.csv");
    const FINGERS: [Finger; 4] = [Finger::Little, Finger::Ring, Finger::Middle, Finger::Index];
    const KNUCKLES: [Segment; 4] = [Little1, Ring1, Middle1, Index1];

    fn poses() -> impl Iterator<Item = (PerDof<f32>, Vec<Vec3>)> {
        POSES.lines().skip(1).map(|line| {
            let numbers: Vec<f32> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let angles: [f32; 6] = numbers[..6].try_into().unwrap();
            let places = numbers[6..].chunks(3).map(Vec3::from_slice);
            (PerDof::new(angles), places.collect())
        })
    }

    /// The places of a line of the table.
    fn places(pose: &SegmentFrames) -> Vec<Vec3> {
        let joints = FINGERS
            .map(Segment::tip)
            .into_iter()
            .chain([Thumb2, Thumb3, Segment::Thumb4]);
        let tips = FINGERS.into_iter().chain([Finger::Thumb]);
        let joints = joints.map(|segment| pose.frame(segment).translation);
        joints.chain(tips.map(|finger| pose.tip(finger))).collect()
    }

    /// Radians between the segments of one joint.
    fn between(pose: &SegmentFrames, one: Segment, two: Segment) -> f32 {
        pose.frame(one)
            .matrix3
            .y_axis
            .angle_between(pose.frame(two).matrix3.y_axis)
    }

    #[test]
    fn joints_and_tips_are_where_the_model_has_them() {
        let mut count = 0;
        for (angles, wanted) in poses() {
            let right = places(&SegmentFrames::of_radians(Side::Right, &angles));
            let left = places(&SegmentFrames::of_radians(Side::Left, &angles));
            assert_eq!(right.len(), wanted.len());
            for ((right, left), wanted) in right.iter().zip(&left).zip(&wanted) {
                assert!(
                    right.distance(*wanted) < 0.05,
                    "{angles:?}: {right}, not {wanted}"
                );
                let mirrored = Vec3::new(-wanted.x, wanted.y, wanted.z);
                assert!(left.distance(mirrored) < 0.05, "{angles:?}: left {left}");
            }
            count += 1;
        }
        assert_eq!(count, 100);
    }

    #[test]
    fn lengths_and_couplings_are_those_of_the_table() {
        for (angles, _) in poses() {
            let pose = SegmentFrames::of_radians(Side::Right, &angles);
            for ((finger, first), tip) in FINGERS
                .into_iter()
                .zip(KNUCKLES)
                .zip([43.2, 53.3, 56.9, 53.3])
            {
                let second = Segment::tip(finger);
                let joint = pose.frame(second).translation;
                assert!((joint.distance(pose.frame(first).translation) - 32.78).abs() < 0.02);
                assert!(
                    (joint.distance(pose.tip(finger)) - tip).abs() < 0.7,
                    "{finger:?}"
                );
                let coupled = between(&pose, first, second) - angles[finger.bend()] * 1.0843;
                assert!(coupled.abs() < 1e-3, "{finger:?}: {coupled}");
            }
            let bend = angles[Dof::ThumbBend];
            let coupled = [
                between(&pose, Thumb2, Thumb3),
                between(&pose, Thumb3, Segment::Thumb4),
            ];
            assert!((coupled[0] - bend * 0.8024).abs() < 1e-3);
            assert!((coupled[1] - bend * 0.8024 * 0.9487).abs() < 1e-3);
        }
    }

    #[test]
    fn open_is_1000_and_what_lies_beyond_the_ends_is_drawn_at_them() {
        let pose = |share| SegmentFrames::of_shares(Side::Right, &PerDof::splat(share));
        assert_eq!((pose(1.7), pose(-0.2)), (pose(1.0), pose(0.0)));
        let (open, fist) = (pose(1.0), pose(0.0));
        assert_eq!(
            open,
            SegmentFrames::of_radians(Side::Right, &PerDof::splat(0.0))
        );
        for finger in FINGERS {
            assert!(open.tip(finger).z > 220.0 && fist.tip(finger).z < 115.0);
        }
        // The thumb swings from beside the palm to before it.
        assert!(open.tip(Finger::Thumb).x < -110.0 && fist.tip(Finger::Thumb).x > -40.0);
    }

    #[test]
    fn segments_stand_in_their_order() {
        for (at, segment) in Segment::ALL.into_iter().enumerate() {
            assert_eq!(segment as usize, at);
        }
    }
}
