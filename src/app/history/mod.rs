//! What was measured over the last minutes: cheap to add to, cheap to draw from. Draws nothing.

mod book;
#[cfg(test)]
mod book_tests;
mod column;
mod grid;
#[cfg(test)]
mod grid_tests;
mod mark;
mod reading;
mod ring;
mod table;
mod trace;
mod track;

pub use book::{CHANNEL_ROWS, HISTORY_ROWS, HISTORY_SECONDS, History, Quantity, Series, Touch};
pub use mark::{MARKS_MAX, Mark, MarkKind, NOTE_MAX};
pub use reading::{Reading, Spread, Summary};
pub use table::Table;
pub(crate) use table::TableGroup;
pub use trace::Trace;
