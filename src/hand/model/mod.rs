//! The hand as a model for other programs: links, joints, couplings and limits from the figures that also draw the hand
//! ([`crate::hand::kinematics`]), with simple shapes, whose masses stand for those of the parts. Pure.

pub mod frames;
pub mod mass;
pub mod mjcf;
pub mod table;
pub mod urdf;

use crate::hand::kinematics::{
    JointPlace, RANGE, Segment, Side, joint_names, joint_place, tip_pad,
};
use crate::hand::{Dof, Finger};

use Segment::{
    Index1, Index2, Little1, Little2, Middle1, Middle2, Palm, Ring1, Ring2, Thumb1, Thumb2, Thumb3,
    Thumb4,
};

/// A rod with round ends, in mm, in the frame of its segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rod {
    /// Centres of its ends.
    pub ends: [[f32; 3]; 2],
    /// Radius of the rod and of its ends.
    pub radius: f32,
}

/// A box, in mm, in the frame of its segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// Its centre.
    pub middle: [f32; 3],
    /// Lengths along x, y and z.
    pub edges: [f32; 3],
}

/// Bulk of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A phalanx.
    Rod(Rod),
    /// The palm.
    Block(Cuboid),
}

/// A joint between a link and its parent.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelJoint {
    /// Name as in the maker's model: `right_index_1_joint`.
    pub name: String,
    /// The drive that moves it.
    pub dof: Dof,
    /// The segment that carries it.
    pub parent: Segment,
    /// Position in the parent's frame, mm.
    pub at_mm: [f32; 3],
    /// Orientation of its link in the parent's frame while the hand is open: roll, pitch and yaw, radians.
    pub turned: [f32; 3],
    /// True if it turns about z, false if about -z.
    pub is_about_z: bool,
    /// Radians from open to bent.
    pub range: f32,
    /// Radians per radian of the drive's own joint; `None` for that joint itself.
    pub follows: Option<f32>,
}

/// A rigid part of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelLink {
    /// The segment of the hand.
    pub segment: Segment,
    /// `right_index_1`.
    pub name: String,
    /// Joint to its parent; `None` for the palm.
    pub joint: Option<ModelJoint>,
    /// Its bulk, in its own frame.
    pub shape: Shape,
    /// Centre of the fingertip's pad, mm; `None` for segments without a pad.
    pub touch_mm: Option<(Finger, [f32; 3])>,
}

/// Segment that the drive moves directly.
const fn driven(dof: Dof) -> Segment {
    match dof {
        Dof::Little => Little1,
        Dof::Ring => Ring1,
        Dof::Middle => Middle1,
        Dof::Index => Index1,
        Dof::ThumbBend => Thumb2,
        Dof::ThumbRotate => Thumb1,
    }
}

/// Name of the joint that a drive moves directly.
pub fn driven_joint(side: Side, dof: Dof) -> String {
    joint_name(side, driven(dof))
}

fn joint_name(side: Side, segment: Segment) -> String {
    let names = joint_names(side).into_iter();
    let own = Segment::ALL.into_iter().skip(1).zip(names);
    let mut own = own.filter(|(of, _)| *of == segment);
    own.next().map(|(_, name)| name).unwrap_or_default()
}

/// Name of a segment's link: `right_index_1`.
pub fn link_name(side: Side, segment: Segment) -> String {
    let joint = joint_name(side, segment);
    match joint.strip_suffix("_joint") {
        Some(name) => name.to_owned(),
        None => format!("{}_palm", side_name(side)),
    }
}

/// Name of the frame of a fingertip's pad.
pub fn touch_name(side: Side, finger: Finger) -> String {
    format!("{}_{}_touch", side_name(side), finger.name())
}

/// `right` or `left`.
pub const fn side_name(side: Side) -> &'static str {
    match side {
        Side::Right => "right",
        Side::Left => "left",
    }
}

/// All links, each after its parent. A left hand is the mirror image in x of a right one.
pub fn links(side: Side) -> Vec<ModelLink> {
    let link = |segment| ModelLink {
        segment,
        name: link_name(side, segment),
        joint: joint_place(segment).and_then(|place| joint(side, segment, place)),
        shape: mirrored_shape(side, shape(segment)),
        touch_mm: Finger::ALL
            .into_iter()
            .find(|finger| Segment::tip(*finger) == segment)
            .map(|finger| (finger, mirrored(side, tip_pad(finger).to_array()))),
    };
    Segment::ALL.into_iter().map(link).collect()
}

fn joint(side: Side, segment: Segment, place: JointPlace) -> Option<ModelJoint> {
    let dof = segment.dof()?;
    let [roll, pitch, yaw] = place.turned;
    let turned = match side {
        Side::Right => place.turned,
        Side::Left => [roll, -pitch, -yaw],
    };
    Some(ModelJoint {
        name: joint_name(side, segment),
        dof,
        parent: place.parent,
        at_mm: mirrored(side, place.at_mm),
        turned,
        is_about_z: (place.ratio > 0.0) == (side == Side::Right),
        range: RANGE[dof] * place.ratio.abs(),
        follows: (driven(dof) != segment).then_some(place.ratio.abs()),
    })
}

fn mirrored(side: Side, [x, y, z]: [f32; 3]) -> [f32; 3] {
    match side {
        Side::Right => [x, y, z],
        Side::Left => [-x, y, z],
    }
}

fn mirrored_shape(side: Side, shape: Shape) -> Shape {
    match shape {
        Shape::Rod(rod) => Shape::Rod(Rod {
            ends: rod.ends.map(|end| mirrored(side, end)),
            ..rod
        }),
        Shape::Block(block) => Shape::Block(Cuboid {
            middle: mirrored(side, block.middle),
            ..block
        }),
    }
}

/// The bulk of a segment: along it from its joint to the next one, or to the tip.
const fn shape(segment: Segment) -> Shape {
    /// A rod from the joint to a point along the segment, in the finger's middle plane.
    const fn rod(to: [f32; 2], plane: f32, radius: f32) -> Shape {
        Shape::Rod(Rod {
            ends: [[0.0, 0.0, plane], [to[0], to[1], plane]],
            radius,
        })
    }
    match segment {
        Palm => Shape::Block(Cuboid {
            middle: [-2.0, 0.0, 72.5],
            edges: [86.0, 34.0, 145.0],
        }),
        Little1 | Ring1 | Middle1 | Index1 => rod([-3.4, 32.6], -6.65, 8.5),
        Little2 => rod([0.0, 36.2], -6.1, 7.6),
        Ring2 | Index2 => rod([0.0, 45.8], -6.1, 8.1),
        Middle2 => rod([0.0, 49.5], -6.1, 8.1),
        Thumb1 => Shape::Rod(Rod {
            ends: [[0.0, 0.0, -6.0], [-6.0, 7.0, 4.0]],
            radius: 9.0,
        }),
        Thumb2 => rod([31.4, 21.1], -7.2, 10.0),
        Thumb3 => rod([21.9, 12.8], -7.2, 8.8),
        Thumb4 => rod([27.5, 11.0], -7.2, 8.0),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::PerDof;
    use crate::hand::kinematics::SegmentFrames;
    use glam::{Affine3A, EulerRot, Quat, Vec3};
    use std::collections::BTreeMap;

    /// Positions of the links, computed as a reader of the model does.
    fn frames(side: Side, angles: &PerDof<f32>) -> BTreeMap<String, Affine3A> {
        let mut frames = BTreeMap::new();
        for link in links(side) {
            let frame = match &link.joint {
                None => Affine3A::IDENTITY,
                Some(joint) => {
                    let parent: Affine3A = frames[&link_name(side, joint.parent)];
                    let [roll, pitch, yaw] = joint.turned;
                    let stands = Quat::from_euler(EulerRot::ZYX, yaw, pitch, roll);
                    let angle = angles[joint.dof] * joint.follows.unwrap_or(1.0);
                    let angle = if joint.is_about_z { angle } else { -angle };
                    let turn = stands * Quat::from_rotation_z(angle);
                    parent * Affine3A::from_rotation_translation(turn, joint.at_mm.into())
                }
            };
            frames.insert(link.name, frame);
        }
        frames
    }

    #[test]
    fn links_and_touch_frames_of_both_sides_are_where_the_drawn_hand_has_them() {
        let shares = [[0.0; 6], [1.0; 6], [0.3, 0.6, 0.1, 0.9, 0.5, 0.7]];
        for (side, share) in [Side::Right, Side::Left].into_iter().zip([shares; 2]) {
            for share in share {
                let share = PerDof::new(share);
                let angles = PerDof::from_fn(|dof| share[dof] * RANGE[dof]);
                let drawn = SegmentFrames::of_radians(side, &angles);
                let frames = frames(side, &angles);
                for link in links(side) {
                    let frame = frames[&link.name];
                    let wanted = drawn.frame(link.segment).translation;
                    let wanted = if link.segment == Palm {
                        Vec3::ZERO
                    } else {
                        wanted
                    };
                    let at: Vec3 = frame.translation.into();
                    assert!(at.distance(wanted) < 0.01, "{}: {at} {wanted}", link.name);
                    let Some((finger, touch)) = link.touch_mm else {
                        continue;
                    };
                    let at = frame.transform_point3(touch.into());
                    assert!(at.distance(drawn.tip(finger)) < 0.01, "{side:?} {finger:?}");
                }
            }
        }
    }

    #[test]
    fn each_drive_moves_one_joint_itself_and_the_others_follow_it() {
        let all = links(Side::Right);
        let joints: Vec<&ModelJoint> = all.iter().filter_map(|link| link.joint.as_ref()).collect();
        assert_eq!(joints.len(), 12);
        for dof in Dof::ALL {
            let own = driven_joint(Side::Right, dof);
            let itself = joints
                .iter()
                .filter(|joint| joint.dof == dof && joint.follows.is_none());
            let names: Vec<&str> = itself.map(|joint| joint.name.as_str()).collect();
            assert_eq!(names, [own.as_str()]);
        }
        assert_eq!(all.iter().filter(|link| link.touch_mm.is_some()).count(), 5);
    }
}
