//! Commands from other programs over DDS, in the format of Unitree's programs.

pub mod ctrl;
pub mod motors;
pub mod source;
