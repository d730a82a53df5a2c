//! Operations of several steps that do not move an armed hand, each written once as an async function for window and command line. A
//! task reports its steps as they begin and returns its result; it asks the user nothing itself and draws nothing.
#![warn(missing_docs)]

pub mod apply;
pub mod calibrate;
pub mod hand;
pub mod place;
pub mod read;
pub mod reset;
pub mod save;
#[cfg(test)]
mod tests;

pub use crate::tasks::hand::Reach;

use crate::hand::Span;
use crate::link::RequestError;
use crate::params::changes::RowOutcome;
use crate::params::danger::Danger;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use crate::system::SystemError;

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
    /// The task would make joints hit harder than before, or change the address of the hand, and this was not confirmed.
    #[error("not confirmed")]
    NotMeant(Risks),
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

/// Progress of the tasks that read, apply and save parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum ParamStep {
    /// A group was read.
    Read(Span, Vec<u8>),
    /// The user agreed to these risks.
    Meant(Risks),
    /// Rows are being written.
    Writing,
    /// A row was written, or was not.
    Row(RowOutcome),
    /// The backup is being written, and a SAVE of another program may be waited for.
    BackingUp,
    /// SAVE is being sent, and its result awaited.
    Saving,
}

/// Risks that the user should confirm before a task continues.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Risks {
    /// Joints that will hit harder than before.
    pub dangers: Vec<Danger>,
    /// Rows that change the address of the hand, with their new values.
    pub places: Params,
}

/// Scope of the user's consent.
#[derive(Debug, Clone, PartialEq)]
pub enum Consent {
    /// To every risk of the task.
    Given,
    /// To these joints hitting harder, and to nothing else.
    To(Vec<Danger>),
}

impl Consent {
    /// Fails if the user did not agree to every risk.
    pub fn check(&self, risks: &Risks) -> Result<(), TaskError> {
        let is_meant = match self {
            Self::Given => true,
            Self::To(agreed) => {
                let mut dangers = risks.dangers.iter();
                dangers.all(|danger| agreed.contains(danger)) && risks.places.is_empty()
            }
        };
        if is_meant {
            Ok(())
        } else {
            Err(TaskError::NotMeant(risks.clone()))
        }
    }
}
