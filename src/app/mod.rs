//! Everything the program knows, without drawing: state, actions, history, faults, notices, settings.

mod act;
mod act_poses;
#[cfg(test)]
mod act_poses_tests;
pub mod action;
pub mod calendar;
pub mod calibration;
pub mod config;
pub mod connect;
pub mod cooling;
mod desk;
pub mod device;
#[cfg(test)]
mod fake_link;
pub mod faults;
pub mod gestures;
pub(crate) mod grip;
pub mod guard;
pub mod history;
pub mod layout;
#[cfg(test)]
mod live_tests;
pub mod notices;
pub mod params;
pub mod peaks;
pub mod poses;
pub mod program;
pub mod quirk_sheet;
pub mod recipe;
pub mod recorder;
pub mod save;
pub mod scan;
mod seam;
pub mod settings;
mod sheet_keeper;
pub mod state;
pub mod tare;
#[cfg(test)]
mod tests;
pub(crate) mod trails;
pub mod trial;
pub mod tuner;

pub use action::Action;
pub use connect::SimDial;
pub use faults::{FaultBook, FaultEntry, FaultKind};
pub use gestures::GestureBook;
pub use history::{History, Mark, MarkKind, Quantity, Series, Touch, Trace};
pub use notices::{Asked, Level, Notice, NoticeKind, Notices};
pub use program::{App, Env};
pub use quirk_sheet::{QuirkBook, QuirkSheet};
pub use recorder::{Recorder, Recording, RecordingId};
pub use save::{ChooseFile, Content, InFolder, NoChoice, TrafficForm};
pub use scan::{ScanBook, ScanWish};
pub use settings::Settings;
pub use state::State;
pub use tuner::{TrialWish, TunerBook};
