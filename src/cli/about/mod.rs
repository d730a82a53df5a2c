//! Commands that need no hand: help, registers, models of the hand, a workspace of ROS 2, and files for packages and shells.

pub(crate) mod help;
pub(crate) mod model;
pub(crate) mod packaging;
pub(crate) mod registers;
pub(crate) mod ros2;
