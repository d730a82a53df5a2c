//! Flight recorder: retains the events around each fault for viewing. Writes no file and sends nothing.

pub(crate) mod book;
pub(crate) mod event;
pub(crate) mod recording;

pub use crate::app::readings::fault_recorder::book::{
    AFTER, AFTER_MAX, BEFORE, EVENTS_MAX, FaultRecorder, RECORDINGS_MAX,
};
pub use crate::app::readings::fault_recorder::event::{FaultEvent, FaultEventKind, UserAct};
pub use crate::app::readings::fault_recorder::recording::{
    DriveState, FaultAt, FaultRecording, FaultRecordingId,
};
