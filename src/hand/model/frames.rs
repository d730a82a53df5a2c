//! Frames of the links in their parents' frames, as ROS 2's tf has them: metres, and quaternions.

use crate::hand::kinematics::{Side, driven_radians};
use crate::hand::model::{link_name, links, touch_name};
use crate::hand::{Dof, PerDof};
use glam::{EulerRot, Quat};

/// A link in its parent's frame.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkFrame {
    /// Name of the parent, as in the URDF.
    pub parent: String,
    /// Name of the link.
    pub child: String,
    /// Position in m.
    pub at_m: [f64; 3],
    /// Orientation: x, y, z, w of a quaternion.
    pub turn: [f64; 4],
}

/// A link that a drive turns.
#[derive(Debug, Clone, PartialEq)]
struct TurningLink {
    /// Frame while the hand is open.
    open: LinkFrame,
    standing: Quat,
    dof: Dof,
    /// Radians about z per radian of the drive's own joint.
    ratio: f64,
}

/// All frames of a hand below its palm.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameTree {
    turning: Vec<TurningLink>,
    fixed: Vec<LinkFrame>,
}

impl FrameTree {
    /// Frames of the hand of this side.
    pub fn new(side: Side) -> Self {
        let all = links(side);
        let turning = all.iter().filter_map(|link| {
            let joint = link.joint.as_ref()?;
            let [roll, pitch, yaw] = joint.turned;
            let standing = Quat::from_euler(EulerRot::ZYX, yaw, pitch, roll);
            let ratio = f64::from(joint.follows.unwrap_or(1.0));
            Some(TurningLink {
                open: LinkFrame {
                    parent: link_name(side, joint.parent),
                    child: link.name.clone(),
                    at_m: metres(joint.at_mm),
                    turn: turn(standing),
                },
                standing,
                dof: joint.dof,
                ratio: if joint.is_about_z { ratio } else { -ratio },
            })
        });
        let fixed = all.iter().filter_map(|link| {
            let (finger, at_mm) = link.touch_mm?;
            Some(LinkFrame {
                parent: link.name.clone(),
                child: touch_name(side, finger),
                at_m: metres(at_mm),
                turn: turn(Quat::IDENTITY),
            })
        });
        Self {
            turning: turning.collect(),
            fixed: fixed.collect(),
        }
    }

    /// Frames that never move: the pads of the fingertips.
    pub fn fixed(&self) -> &[LinkFrame] {
        &self.fixed
    }

    /// Frames at these drive angles, 0..=1000. A link whose drive has an unknown angle is left out.
    pub fn at(&self, angles: &PerDof<Option<i16>>) -> Vec<LinkFrame> {
        let frame = |link: &TurningLink| {
            let radians = driven_radians(link.dof, angles[link.dof]?) * link.ratio;
            #[expect(clippy::cast_possible_truncation, reason = "radians below 2")]
            let bent = Quat::from_rotation_z(radians as f32);
            Some(LinkFrame {
                turn: turn(link.standing * bent),
                ..link.open.clone()
            })
        };
        self.turning.iter().filter_map(frame).collect()
    }
}

fn metres(mm: [f32; 3]) -> [f64; 3] {
    mm.map(|mm| f64::from(mm) / 1000.0)
}

fn turn(quat: Quat) -> [f64; 4] {
    quat.to_array().map(f64::from)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::Finger;
    use crate::hand::kinematics::{Segment, SegmentFrames};
    use glam::{DAffine3, DQuat, DVec3};
    use std::collections::BTreeMap;

    /// Frames in the palm's frame, as a reader of tf chains them.
    fn chained(side: Side, all: &[LinkFrame]) -> BTreeMap<&str, DAffine3> {
        let palm = if side == Side::Right {
            "right_palm"
        } else {
            "left_palm"
        };
        let mut chained = BTreeMap::from([(palm, DAffine3::IDENTITY)]);
        for frame in all {
            let turn = DQuat::from_array(frame.turn);
            assert!((turn.length() - 1.0).abs() < 1e-5, "{frame:?}");
            let own = DAffine3::from_rotation_translation(turn, frame.at_m.into());
            let parent = chained[frame.parent.as_str()];
            chained.insert(&frame.child, parent * own);
        }
        chained
    }

    #[test]
    fn chained_frames_are_those_of_the_drawn_hand() {
        for side in [Side::Right, Side::Left] {
            let tree = FrameTree::new(side);
            for counts in [[1000; 6], [0; 6], [700, 400, 900, 100, 500, 300]] {
                let moving = tree.at(&PerDof::new(counts).map(Some));
                assert_eq!((moving.len(), tree.fixed().len()), (12, 5));
                let all = [moving, tree.fixed().to_vec()].concat();
                let chained = chained(side, &all);
                let shares = PerDof::new(counts).map(|count| f32::from(count) / 1000.0);
                let drawn = SegmentFrames::of_shares(side, &shares);
                let is_near = |name: &str, wanted: glam::Vec3| {
                    let at = chained[name].translation * 1000.0;
                    let wanted: DVec3 = wanted.into();
                    assert!(at.distance(wanted) < 0.02, "{name}: {at} {wanted}");
                };
                for segment in Segment::ALL.into_iter().skip(1) {
                    is_near(&link_name(side, segment), drawn.frame(segment).translation);
                }
                for finger in Finger::ALL {
                    is_near(&touch_name(side, finger), drawn.tip(finger));
                }
            }
        }
    }

    #[test]
    fn an_unknown_angle_has_no_frame() {
        let tree = FrameTree::new(Side::Left);
        let mut angles = PerDof::splat(Some(500));
        angles[Dof::ThumbBend] = None;
        let frames = tree.at(&angles);
        let thumb: Vec<&str> = frames.iter().map(|frame| frame.child.as_str()).collect();
        assert_eq!(thumb.len(), 9);
        assert!(thumb.contains(&"left_thumb_1") && !thumb.contains(&"left_thumb_2"));
        assert!(tree.at(&PerDof::splat(None)).is_empty());
    }
}
