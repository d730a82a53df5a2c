//! The model as MJCF, for MuJoCo: six position actuators, the other joints coupled by equalities. Metres and radians.

use crate::hand::kinematics::{Segment, Side};
use crate::hand::model::mass::DENSITY;
use crate::hand::model::urdf::metres;
use crate::hand::model::{ModelLink, Shape, driven_joint, links, side_name, touch_name};
use crate::hand::{Dof, Finger};
use glam::{EulerRot, Quat};
use std::fmt::Write as _;

/// Defaults of all joints: a stiff coupling or drive. No such figures are published.
fn defaults() -> String {
    format!(
        "  <default>
    <geom density=\"{DENSITY}\" rgba=\"0.72 0.74 0.77 1\" condim=\"4\" friction=\"1 0.02 0.0005\"/>
    <joint damping=\"0.02\" armature=\"0.002\"/>
    <position kp=\"6\" kv=\"0.15\" forcerange=\"-2 2\"/>
    <equality solref=\"0.004 1\" solimp=\"0.99 0.999 0.0001\"/>
  </default>
"
    )
}

/// Writes the whole file.
pub fn mjcf(side: Side) -> String {
    let all = links(side);
    let mut text = format!(
        "<!-- {} -->\n<mujoco model=\"ftp_{}_hand\">\n  <compiler angle=\"radian\"/>\n  <option timestep=\"0.001\" integrator=\"implicitfast\"/>\n{}  <worldbody>\n",
        super::table::ABOUT,
        side_name(side),
        defaults()
    );
    body(&mut text, side, &all, (Segment::Palm, 2));
    text += "  </worldbody>\n";
    text += &excludes(&all);
    text += "  <equality>\n";
    for joint in all.iter().filter_map(|link| link.joint.as_ref()) {
        if let Some(ratio) = joint.follows {
            let of = driven_joint(side, joint.dof);
            let _ = writeln!(
                text,
                "    <joint joint1=\"{}\" joint2=\"{of}\" polycoef=\"0 {ratio:.6} 0 0 0\"/>",
                joint.name
            );
        }
    }
    text += "  </equality>\n  <actuator>\n";
    for dof in Dof::ALL {
        let joint = driven_joint(side, dof);
        let range = crate::hand::kinematics::RANGE[dof];
        let _ = writeln!(
            text,
            "    <position name=\"{}\" joint=\"{joint}\" ctrlrange=\"0 {range:.5}\"/>",
            dof.name()
        );
    }
    text += "  </actuator>\n  <sensor>\n";
    for finger in Finger::ALL {
        let name = touch_name(side, finger);
        let _ = writeln!(text, "    <touch name=\"{name}\" site=\"{name}\"/>");
    }
    text + "  </sensor>\n</mujoco>\n"
}

/// Writes a body and all its descendants.
fn body(text: &mut String, side: Side, all: &[ModelLink], (segment, depth): (Segment, usize)) {
    let Some(link) = all.iter().find(|link| link.segment == segment) else {
        return;
    };
    let space = "  ".repeat(depth);
    let (at, quat) = match &link.joint {
        None => ([0.0; 3], Quat::IDENTITY),
        Some(joint) => {
            let [roll, pitch, yaw] = joint.turned;
            (
                joint.at_mm,
                Quat::from_euler(EulerRot::ZYX, yaw, pitch, roll),
            )
        }
    };
    let quat = [quat.w, quat.x, quat.y, quat.z].map(|part| format!("{part:.7}"));
    let _ = writeln!(
        text,
        "{space}<body name=\"{}\" pos=\"{}\" quat=\"{}\">",
        link.name,
        metres(at),
        quat.join(" ")
    );
    if let Some(joint) = &link.joint {
        let axis = if joint.is_about_z { "0 0 1" } else { "0 0 -1" };
        let _ = writeln!(
            text,
            "{space}  <joint name=\"{}\" type=\"hinge\" axis=\"{axis}\" range=\"0 {:.5}\"/>",
            joint.name, joint.range
        );
    }
    let geom = match &link.shape {
        Shape::Block(block) => {
            let half = block.edges.map(|edge| edge / 2.0);
            format!(
                "type=\"box\" pos=\"{}\" size=\"{}\"",
                metres(block.middle),
                metres(half)
            )
        }
        Shape::Rod(rod) => {
            let [from, to] = rod.ends.map(metres);
            format!(
                "type=\"capsule\" fromto=\"{from} {to}\" size=\"{:.5}\"",
                rod.radius / 1000.0
            )
        }
    };
    let _ = writeln!(text, "{space}  <geom {geom}/>");
    if let Some((finger, at)) = link.touch_mm {
        let _ = writeln!(
            text,
            "{space}  <site name=\"{}\" pos=\"{}\" type=\"sphere\" size=\"0.009\" rgba=\"0.2 0.6 1 0.3\"/>",
            touch_name(side, finger),
            metres(at)
        );
    }
    let hangs = |own: &&ModelLink| {
        own.joint
            .as_ref()
            .is_some_and(|joint| joint.parent == segment)
    };
    for child in all.iter().filter(hangs) {
        body(text, side, all, (child.segment, depth + 1));
    }
    let _ = writeln!(text, "{space}</body>");
}

/// Collision exclusions: the simplified shapes of one finger, and of the palm and its joints, overlap where the real ones do not.
fn excludes(all: &[ModelLink]) -> String {
    let of = |segment: Segment| segment.finger();
    let mut text = String::from("  <contact>\n");
    for (nth, one) in all.iter().enumerate() {
        for other in all.iter().skip(nth + 1) {
            let is_first = matches!(
                other.segment,
                Segment::Little1
                    | Segment::Ring1
                    | Segment::Middle1
                    | Segment::Index1
                    | Segment::Thumb1
                    | Segment::Thumb2
            );
            let on_palm = one.segment == Segment::Palm && is_first;
            if on_palm || of(one.segment).is_some() && of(one.segment) == of(other.segment) {
                let _ = writeln!(
                    text,
                    "    <exclude body1=\"{}\" body2=\"{}\"/>",
                    one.name, other.name
                );
            }
        }
    }
    text + "  </contact>\n"
}
