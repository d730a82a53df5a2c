//! What was measured over the last minutes: cheap to add to, cheap to draw from. Draws nothing.

mod book;
mod column;
mod mark;
mod ring;
mod trace;
mod track;

pub use book::{HISTORY_ROWS, HISTORY_SECONDS, History, Quantity, Series, Touch};
pub use mark::{MARKS_MAX, Mark, MarkKind};
pub use trace::Trace;
