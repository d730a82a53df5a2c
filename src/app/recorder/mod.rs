//! The flight recorder: what happened around each fault stays viewable. Writes no file and sends nothing.

mod book;
mod event;
mod recording;

pub use book::{AFTER, BEFORE, EVENTS_MAX, LONGEST_AFTER, Listed, RECORDINGS_MAX, Recorder};
pub use event::{Deed, Event, EventKind};
pub use recording::{DriveState, FaultAt, Recording, RecordingId};
