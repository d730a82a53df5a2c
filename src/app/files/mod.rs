//! Files of the program: settings, poses, what was found about hands, and what a person exports.

pub mod choose;
pub mod day_folder;
pub mod exhibit_file;
pub mod export;
pub(crate) mod open;
pub mod pose_file;
pub(crate) mod quirk_notes;
pub mod reveal;
pub mod settings_file;
pub(crate) mod wrong_pins_file;
