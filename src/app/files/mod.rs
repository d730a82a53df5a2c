//! Files of the program: settings, poses, findings about hands, and exports.

pub mod export;
pub(crate) mod open;
pub mod pose_file;
pub mod settings_file;
