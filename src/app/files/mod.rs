//! Files of the program: settings, poses, what was found about hands, and what the user exports.

pub mod export;
pub(crate) mod open;
pub mod pose_file;
pub mod settings_file;
