//! A table of the joints: counts, radians, names, orders.

use crate::hand::Dof;
use crate::hand::kinematics::{RANGE, Side};
use crate::hand::model::{driven_joint, links};

/// Comment at the head of each file.
pub const ABOUT: &str = "FTP series hand, written by handscope model. Frames, couplings and limits after a public model of the hand (unitree_ros, inspire_hand FTP, BSD-3-Clause, Unitree Robotics); shapes are simple; masses are not published: those here are of the shapes";

/// The table as comma-separated values: one line per joint of the model.
pub fn csv(side: Side) -> String {
    let mut text = String::from(
        "joint,register_order,register_name,driven_by,radians_per_driver_radian,counts_open,counts_bent,radians_open,radians_bent,radians_per_count\n",
    );
    for joint in links(side).iter().filter_map(|link| link.joint.as_ref()) {
        let dof = joint.dof;
        let order = Dof::ALL.into_iter().position(|own| own == dof);
        let own = driven_joint(side, dof);
        let ratio = joint.follows.unwrap_or(1.0);
        text += &format!(
            "{},{},{},{own},{ratio:.6},1000,0,0,{:.5},{:.8}\n",
            joint.name,
            order.unwrap_or_default(),
            dof.name(),
            joint.range,
            -RANGE[dof] * ratio / 1000.0
        );
    }
    text
}
