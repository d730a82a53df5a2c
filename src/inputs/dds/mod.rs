//! Commands from other programs over DDS, in the formats of Unitree's programs and of ROS 2.

pub mod ctrl;
pub mod motors;
pub mod ros;
pub mod source;
