//! What a person may ask about what a hand keeps. Says nothing about how it is done.

use crate::app::params::table::ParamId;
use crate::hand::Dof;
use std::path::PathBuf;

/// One thing a person asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DeviceWish {
    /// Read all rows. Writes nothing.
    Read,
    /// Write the staged rows that say nothing of where the hand is found, and read them back.
    Apply,
    /// Put back what the last apply changed, in the same way.
    Undo,
    /// Write the hand's parameters to its flash, after a backup.
    Save,
    /// Go on with what was asked about: the dangers that were shown are meant.
    Agree,
    /// Leave it: nothing is written.
    Decline,
    /// Stage the speed and force that the hand has now as those after power-up: of a joint, or of all. Writes nothing.
    CopyLive(Option<Dof>),
    /// Forget everything that is staged.
    UnstageAll,
    /// Ask where the parameters should go, and write the file.
    Dump,
    /// Ask for a file of parameters and show it beside the hand. Writes nothing.
    Open,
    /// Show a backup beside the hand. Writes nothing.
    OpenBackup(PathBuf),
    /// Tick a row of the file, or not.
    Tick(ParamId),
    /// Stage the rows that are ticked. Writes nothing.
    StageTicked,
    /// Show the file no more.
    CloseFile,
}
