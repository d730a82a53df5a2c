//! The model as URDF: for RViz, Foxglove, Isaac, Pinocchio. Metres and radians.

use crate::hand::kinematics::Side;
use crate::hand::model::{
    ModelJoint, ModelLink, Rod, Shape, driven_joint, link_name, links, side_name, touch_name,
};
use glam::{EulerRot, Quat, Vec3};
use std::fmt::Write as _;

/// Limits of a joint, which URDF requires and for which no figures are published: N·m and rad/s.
const EFFORT: f32 = 1.0;
const VELOCITY: f32 = 3.0;

/// Writes the whole file.
pub fn urdf(side: Side) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<!-- {} -->\n<robot name=\"ftp_{}_hand\">\n",
        super::table::ABOUT,
        side_name(side)
    );
    for link in links(side) {
        text += &link_text(&link);
        if let Some(joint) = &link.joint {
            text += &joint_text(side, joint, &link.name);
        }
        if let Some((finger, at)) = link.touch_mm {
            let name = touch_name(side, finger);
            let _ = write!(
                text,
                "  <link name=\"{name}\"/>\n  <joint name=\"{name}_joint\" type=\"fixed\">\n    <parent link=\"{}\"/>\n    <child link=\"{name}\"/>\n    <origin xyz=\"{}\"/>\n  </joint>\n",
                link.name,
                metres(at)
            );
        }
    }
    text + "</robot>\n"
}

fn link_text(link: &ModelLink) -> String {
    let shape = shape_text(&link.shape);
    format!(
        "  <link name=\"{}\">\n    <visual>\n{shape}      <material name=\"grey\"><color rgba=\"0.72 0.74 0.77 1\"/></material>\n    </visual>\n    <collision>\n{shape}    </collision>\n  </link>\n",
        link.name
    )
}

fn shape_text(shape: &Shape) -> String {
    let (at, turned, shape) = match shape {
        Shape::Block(block) => (
            block.middle,
            [0.0; 3],
            format!("<box size=\"{}\"/>", metres(block.edges)),
        ),
        Shape::Rod(rod) => {
            let (middle, turned, length) = placed(rod);
            let [radius, length] = [rod.radius, length].map(|mm| mm / 1000.0);
            // URDF has no capsules.
            let shape = format!("<cylinder radius=\"{radius:.5}\" length=\"{length:.5}\"/>");
            (middle, turned, shape)
        }
    };
    format!(
        "      <origin xyz=\"{}\" rpy=\"{}\"/>\n      <geometry>{shape}</geometry>\n",
        metres(at),
        numbers(turned)
    )
}

/// Centre of a rod, its orientation (roll, pitch, yaw) relative to z, and its length.
fn placed(rod: &Rod) -> ([f32; 3], [f32; 3], f32) {
    let [from, to] = rod.ends.map(Vec3::from);
    let turn = Quat::from_rotation_arc(Vec3::Z, (to - from).normalize_or(Vec3::Z));
    let (yaw, pitch, roll) = turn.to_euler(EulerRot::ZYX);
    let middle = (from + to) / 2.0;
    (middle.to_array(), [roll, pitch, yaw], from.distance(to))
}

fn joint_text(side: Side, joint: &ModelJoint, child: &str) -> String {
    let axis = if joint.is_about_z { "0 0 1" } else { "0 0 -1" };
    let follows = joint.follows.map(|ratio| {
        let of = driven_joint(side, joint.dof);
        format!("    <mimic joint=\"{of}\" multiplier=\"{ratio:.6}\" offset=\"0\"/>\n")
    });
    format!(
        "  <joint name=\"{}\" type=\"revolute\">\n    <parent link=\"{}\"/>\n    <child link=\"{child}\"/>\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    <axis xyz=\"{axis}\"/>\n    <limit lower=\"0\" upper=\"{:.5}\" effort=\"{EFFORT}\" velocity=\"{VELOCITY}\"/>\n{}  </joint>\n",
        joint.name,
        link_name(side, joint.parent),
        metres(joint.at_mm),
        numbers(joint.turned),
        joint.range,
        follows.unwrap_or_default()
    )
}

/// Formats millimetres as metres.
pub(super) fn metres(mm: [f32; 3]) -> String {
    numbers(mm.map(|mm| mm / 1000.0))
}

pub(super) fn numbers(numbers: [f32; 3]) -> String {
    numbers.map(|number| format!("{number:.6}")).join(" ")
}
