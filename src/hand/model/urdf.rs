//! The model as URDF: for RViz, Foxglove, Isaac, Pinocchio. Metres and radians.

use crate::hand::kinematics::Side;
use crate::hand::model::mass::{Inertia, inertia};
use crate::hand::model::{
    ModelJoint, ModelLink, Rod, Shape, driven_joint, link_name, links, side_name, touch_name,
};
use glam::{EulerRot, Quat, Vec3};
use std::fmt::Write as _;

/// Limits of a joint, which URDF requires and for which no figures are published: N·m and rad/s.
const EFFORT: f32 = 1.0;
const VELOCITY: f32 = 3.0;

/// Defined once, because a reader may refuse to define one again.
const MATERIALS: &str = "  <material name=\"shell\"><color rgba=\"0.72 0.74 0.77 1\"/></material>
  <material name=\"fingertip\"><color rgba=\"0.30 0.33 0.38 1\"/></material>
";

/// Writes the whole file.
pub fn urdf(side: Side) -> String {
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<!-- {} -->\n<robot name=\"ftp_{}_hand\">\n{MATERIALS}",
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
    let (origin, geometry) = shape_text(&link.shape);
    let material = match link.touch_mm {
        Some(_) => "fingertip",
        None => "shell",
    };
    let Inertia { mass, moments } = inertia(&link.shape);
    let [x, y, z] = moments;
    format!(
        "  <link name=\"{}\">\n    <inertial>\n{origin}      <mass value=\"{mass:.6}\"/>\n      <inertia ixx=\"{x:.6e}\" ixy=\"0\" ixz=\"0\" iyy=\"{y:.6e}\" iyz=\"0\" izz=\"{z:.6e}\"/>\n    </inertial>\n    <visual>\n{origin}{geometry}      <material name=\"{material}\"/>\n    </visual>\n    <collision>\n{origin}{geometry}    </collision>\n  </link>\n",
        link.name
    )
}

/// Origin and geometry.
fn shape_text(shape: &Shape) -> (String, String) {
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
    let origin = format!(
        "      <origin xyz=\"{}\" rpy=\"{}\"/>\n",
        metres(at),
        numbers(turned)
    );
    (origin, format!("      <geometry>{shape}</geometry>\n"))
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::model::mass::DENSITY;
    use crate::hand::model::mjcf::mjcf;

    /// Values of an attribute in the order of the file.
    fn values<'a>(text: &'a str, key: &'a str) -> impl Iterator<Item = &'a str> {
        let begin = format!(" {key}=\"");
        let places: Vec<usize> = text
            .match_indices(&begin)
            .map(|(at, _)| at + begin.len())
            .collect();
        places
            .into_iter()
            .map(|at| text[at..].split('"').next().unwrap())
    }

    fn all(text: &str) -> Vec<f64> {
        text.split(' ')
            .map(|number| number.parse().unwrap())
            .collect()
    }

    /// Mass of a geom as MuJoCo computes it from its size and the density of the file.
    fn mass_of_geom(line: &str) -> f64 {
        let size = all(values(line, "size").next().unwrap());
        if line.contains("type=\"box\"") {
            return DENSITY * size.iter().map(|half| half * 2.0).product::<f64>();
        }
        let ends = all(values(line, "fromto").next().unwrap());
        let (from, to) = ends.split_at(3);
        let squares = from.iter().zip(to).map(|(from, to)| (from - to).powi(2));
        let (long, radius) = (squares.sum::<f64>().sqrt(), size[0]);
        let area = std::f64::consts::PI * radius * radius;
        DENSITY * area * (long + radius * 4.0 / 3.0)
    }

    #[test]
    fn the_hand_weighs_as_much_as_in_mjcf() {
        for side in [Side::Right, Side::Left] {
            let (text, other) = (urdf(side), mjcf(side));
            assert_eq!(
                values(&other, "density").collect::<Vec<_>>(),
                [DENSITY.to_string()]
            );
            let geoms = other.lines().filter(|line| line.contains("<geom type"));
            let wanted: f64 = geoms.map(mass_of_geom).sum();
            let masses: Vec<f64> = values(&text, "value")
                .map(|mass| mass.parse().unwrap())
                .collect();
            assert_eq!(masses.len(), 13);
            let whole: f64 = masses.iter().sum();
            assert!(
                (whole - wanted).abs() < 2e-4,
                "{whole} kg, {wanted} in MJCF"
            );
            assert!((0.7..0.95).contains(&whole), "{whole}");
        }
    }

    #[test]
    fn inertias_are_those_of_bodies_that_can_exist() {
        let text = urdf(Side::Right);
        for inertia in text.lines().filter(|line| line.contains("<inertia ")) {
            let moment = |key| -> f64 { values(inertia, key).next().unwrap().parse().unwrap() };
            let [x, y, z] = ["ixx", "iyy", "izz"].map(moment);
            assert_eq!(["ixy", "ixz", "iyz"].map(moment), [0.0; 3]);
            // Positive definite, and no moment above the sum of the others.
            assert!(x > 0.0 && y > 0.0 && z > 0.0, "{inertia}");
            assert!(x < y + z && y < x + z && z < x + y, "{inertia}");
        }
    }

    #[test]
    fn each_material_is_defined_once_and_used() {
        let text = urdf(Side::Left);
        for name in ["shell", "fingertip"] {
            let defined = format!("<material name=\"{name}\"><color");
            assert_eq!(text.matches(&defined).count(), 1, "{name}");
            let used = text
                .matches(&format!("<material name=\"{name}\"/>"))
                .count();
            assert_eq!(used, if name == "shell" { 8 } else { 5 });
        }
    }
}
