//! Content of a file: topics, messages and their ROS 2 encoding, and the opening that describes the hand.

pub mod cdr;
pub mod decode;
pub mod encode;
pub mod message;
pub mod opening;
mod robot;
pub mod topic;
