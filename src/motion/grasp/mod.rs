//! A grasp: a hold that worked, with the conditions under which it did. It is a file of the pose library, and another hand of known
//! newtons confirms it with five closes before it is trusted there.

pub mod confirm;
pub mod confirmed_file;
pub mod doubt;
pub mod file;
pub mod run;
pub mod saved;
pub mod seen;
