//! Measurements of the last minutes: cheap to append, cheap to draw from. Draws nothing.

pub(crate) mod column;
pub(crate) mod grid;
#[cfg(test)]
pub(crate) mod grid_tests;
pub(crate) mod mark;
pub(crate) mod reading;
pub(crate) mod ring;
pub(crate) mod series;
#[cfg(test)]
pub(crate) mod series_tests;
pub(crate) mod status;
pub(crate) mod table;
pub(crate) mod trace;
pub(crate) mod track;

pub use crate::history::mark::{MARKS_MAX, Mark, MarkKind, NOTE_MAX};
pub use crate::history::reading::{Reading, Summary};
pub use crate::history::series::{CHANNEL_ROWS, HISTORY_ROWS, HISTORY_SECONDS, History, Series};
pub use crate::history::status::StatusRun;
pub use crate::history::table::Table;
pub use crate::history::table::TableGroup;
pub use crate::history::trace::Trace;
pub use crate::history::track::decimated;
