//! What the user asks about recordings.

use crate::app::recordings::export::RecordingExport;
use crate::hand::Moment;
use std::path::PathBuf;

/// What the user asks about recordings.
#[derive(Debug, Clone, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum RecordingAction {
    /// Record hands from now on, or no longer.
    Record(bool),
    /// Record built-in hands, too, or no longer.
    RecordSimulated(bool),
    /// Record into this folder from the next recording on; without a path the user is asked for one.
    ChooseFolder(Option<PathBuf>),
    /// Record into the user's documents again.
    DefaultFolder,
    /// Look again which recordings there are.
    Look,
    /// Replay this file: one of the list, or any other.
    Open(PathBuf),
    /// Replay this file from the first of two moments on, the stretch between them again and again.
    OpenAt(PathBuf, (Moment, Moment)),
    /// Go back to the live hand.
    Close,
    /// Show where this file lies, in the system's file manager.
    Reveal(PathBuf),
    /// Write a recording, or a stretch of it, in a format of others.
    Export(RecordingExport),
    /// Give a recording a name; empty takes it away.
    Name(PathBuf, String),
    /// Give a recording a star, or take it away.
    Star(PathBuf, bool),
    /// Ask whether this recording is to be deleted.
    AskDelete(PathBuf),
    /// Delete the recording that was asked about.
    Delete,
    /// Delete nothing.
    KeepIt,
    /// Delete what the budget has no room for, now.
    MakeRoom,
    /// Give a star to all that the budget has no room for.
    KeepPlanned,
    /// Show this moment.
    Seek(Moment),
    /// Let time go on, or stop it.
    Run(bool),
    /// How fast time goes, 0.1 to 10.
    Pace(f32),
    /// Go to the next reading, or to the one before.
    Step(bool),
    /// Play this stretch again and again, or all once.
    Loop(Option<(Moment, Moment)>),
    /// Draw this recording over the replayed one, or none any more.
    Beside(Option<PathBuf>),
    /// Align both: this moment of the replayed recording with that moment of the other.
    Align(Moment, Moment),
    /// Change the words of the note at a moment; of no words, take it away.
    EditNote(Moment, String),
}
