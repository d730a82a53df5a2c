//! Operations of several steps that do not move an armed hand, each written once as an async function for window and command line. A
//! task reports its steps as they begin, asks the user where it has to ([`ask`]), and returns its result.
#![warn(missing_docs)]

pub mod apply;
pub mod ask;
pub mod calibrate;
pub mod hand;
pub mod place;
pub mod read;
pub mod reset;
pub mod save;
#[cfg(test)]
mod tests;

pub use crate::tasks::ask::{Question, Risks, User};
pub use crate::tasks::hand::Reach;

use crate::hand::Span;
use crate::link::RequestError;
use crate::params::changes::RowOutcome;
use crate::params::place::WhichPlace;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::system::SystemError;
use std::path::PathBuf;

/// Why a task ended before it wrote anything to the hand.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TaskError {
    /// A required row could not be read.
    #[error("cannot read {}: {why}", id.name())]
    NotRead {
        /// First parameter that could not be read.
        id: ParamId,
        /// Why the read failed.
        why: RequestError,
    },
    /// No hand answered at its address.
    #[error("the hand does not answer")]
    NotReached,
    /// The task would make joints hit harder than before, change the address of the hand, or write its flash, and the user did not
    /// confirm that.
    #[error("not confirmed")]
    Declined(Risks),
    /// Not all rows were applied, so that nothing was saved.
    #[error("not all rows were applied, so nothing was saved")]
    NotApplied,
    /// The backup, or the note that precedes a SAVE, could not be written.
    #[error("cannot make a backup, nothing was written to the hand: {0}")]
    NoBackup(BackupError),
    /// The link could not accept the request.
    #[error(transparent)]
    NotAsked(#[from] RequestError),
}

/// Reason for a missing backup.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BackupError {
    /// This program stores no files, so it has no folder for them.
    #[error("there is no folder for backups")]
    NoFolder,
    /// The system could not write it.
    #[error(transparent)]
    System(#[from] SystemError),
}

/// Progress of a task.
#[derive(Debug, Clone, PartialEq)]
pub enum TaskStep {
    /// A group of parameters was read.
    Read(Span, Vec<u8>),
    /// The parameters are being read and backed up; a SAVE of another program may be waited for.
    BackingUp,
    /// The backup was written to this path, with these parameters.
    BackedUp(PathBuf, Params),
    /// The hand, or another one, is searched for at this address.
    Looking(WhichPlace),
    /// The hand at this address is being written to.
    Writing(WhichPlace),
    /// A row was written, or was not.
    Row(RowOutcome),
    /// The previous value of an address is being written back.
    Returning,
    /// The user keeps a change of address; the hand is at this one.
    Kept(WhichPlace),
    /// SAVE is being sent, and its result awaited.
    Saving,
    /// RESET_PARA is being sent.
    Resetting,
    /// The request to calibrate is being sent, and nothing else uses the line.
    Calibrating,
    /// The offsets after a calibration are measured.
    Measuring,
}
