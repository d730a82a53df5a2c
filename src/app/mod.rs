//! Everything the program knows, without drawing: state, actions, history, faults, notices, settings.

pub mod action;
pub mod faults;
pub mod gestures;
pub mod history;
pub mod notices;
pub mod settings;
pub mod state;

pub use action::Action;
pub use faults::{FaultBook, FaultEntry, FaultKind};
pub use gestures::GestureBook;
pub use history::{History, Mark, MarkKind, Quantity, Series, Touch, Trace};
pub use notices::{Asked, Level, Notice, NoticeKind, Notices};
pub use settings::Settings;
pub use state::State;
