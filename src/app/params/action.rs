//! What the user may request in the Device view.

use crate::params::rows::ParamId;
use crate::params::values::Params;
use std::path::PathBuf;

/// One thing that the user asks for.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum ParamAction {
    /// Read all rows. Writes nothing.
    Read,
    /// Write the staged rows, except those that decide where the hand answers, and read them back.
    Apply,
    /// Put back what the last apply changed, in the same way.
    Undo,
    /// Write the hand's parameters to its flash, after a backup.
    Save,
    /// Stage these values and ask for the same. Declined, they are not staged any more.
    SaveWith(Params),
    /// Confirm: go on in spite of the dangers shown.
    Agree,
    /// Decline: nothing is written.
    Decline,
    /// Stage the hand's current speeds and forces as the defaults after power-up. Writes nothing.
    CopyLive,
    /// Drop everything that is staged.
    UnstageAll,
    /// Ask for a path, and write a parameter file there.
    Dump,
    /// Compare a parameter file with the hand: a backup or one whose path was typed, else one that is asked for. Writes nothing.
    Open(Option<PathBuf>),
    /// Tick a row of the file, or not.
    Tick(ParamId),
    /// Stage the rows that are ticked. Writes nothing.
    StageTicked,
    CloseFile,
}
