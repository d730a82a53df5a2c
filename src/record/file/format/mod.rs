//! What stands in a file: topics, messages and their encoding as ROS 2 has them, and what is told of the hand at its begin.

pub mod cdr;
pub mod decode;
pub mod encode;
pub mod message;
pub mod opening;
pub mod topic;
