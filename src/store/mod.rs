//! Files: replaced atomically, read within a limit, written when their content changed; and work off the window's thread. Knows
//! the header of our formats, but not their content.

pub mod calendar;
pub mod file;
mod file_error;
pub mod job;
pub mod saver;
pub mod toml_file;
mod toml_words;

pub use crate::store::file::{
    append_private, create_empty_folder, create_folder, last_of, read_text, replace,
    replace_keeping_last, set_aside, write_new, write_private,
};
pub use crate::store::file_error::{FileCause, FileError, ValueKind};
pub use crate::store::job::{Background, JobKind, Jobs, on_thread};
pub use crate::store::saver::Saver;
pub use crate::store::toml_file::FileText;
