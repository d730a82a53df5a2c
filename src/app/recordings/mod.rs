//! Recordings on disk: the one being made, the list of existing ones, and the replayed one.

pub mod about;
pub mod budget;
pub mod export;
pub mod holding;
pub mod item;
pub mod list;
pub mod recording;

pub use crate::app::recordings::about::{RecordingAbout, RecordingNote};
pub use crate::app::recordings::budget::PlannedDeletion;
pub use crate::app::recordings::export::{ExportProgress, RecordingExport};
pub use crate::app::recordings::holding::replay_of;
pub use crate::app::recordings::item::RecordingItem;
pub use crate::app::recordings::list::{OwnRecording, RecordingAction, RecordingsState, Timeline};
pub use crate::app::recordings::recording::BesideRecording;
