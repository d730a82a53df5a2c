//! Sessions on disk: the one that is being recorded, the list of those there are, and one that is replayed.

pub mod about;
pub mod action;
pub mod beside;
pub mod budget;
pub mod export;
pub(crate) mod folder;
pub mod holding;
pub mod item;
pub mod list;
pub mod recording;
pub mod timeline;

pub use crate::app::sessions::about::{SessionAbout, SessionNote};
pub use crate::app::sessions::action::SessionAction;
pub use crate::app::sessions::beside::BesideSession;
pub use crate::app::sessions::budget::PlannedDeletion;
pub use crate::app::sessions::export::{ExportProgress, SessionExport, SessionForm};
pub use crate::app::sessions::holding::replay_of;
pub use crate::app::sessions::item::SessionItem;
pub use crate::app::sessions::list::{OwnSession, SessionsState};
pub use crate::app::sessions::timeline::Timeline;
