//! The library with what goes on around it: undo, the running sequence, the dry run. Sends nothing.

use crate::app::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit};
use crate::app::poses::library::{Library, PoseId, SequenceId};
use crate::app::poses::player::Player;
use crate::app::poses::preview::Preview;
use crate::link::ArmEpoch;

/// A sequence that runs, or ran last.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Which.
    pub sequence: SequenceId,
    /// How far it is.
    pub player: Player,
    /// The arming it belongs to; in any other it is over.
    pub(crate) epoch: ArmEpoch,
}

/// The poses of a person, and what goes on with them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseBook {
    /// Poses and sequences.
    pub library: Library,
    /// The sequence that runs, or ran last.
    pub run: Option<Run>,
    /// The dry run, if there is one.
    pub preview: Option<Preview>,
    /// The pose that was recalled last.
    pub recalled: Option<PoseId>,
    /// The pose that was made last, for the view to show.
    pub newest: Option<PoseId>,
    /// The sequence that was made last, for the view to show.
    pub newest_sequence: Option<SequenceId>,
    before: Option<Library>,
}

impl PoseBook {
    /// With the library that was kept.
    #[must_use]
    pub fn new(library: Library) -> Self {
        Self {
            library,
            ..Self::default()
        }
    }

    /// True if a deletion or an import can be taken back.
    #[must_use]
    pub const fn can_undo(&self) -> bool {
        self.before.is_some()
    }

    /// True while a sequence is not over.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.run.as_ref().is_some_and(|run| !run.player.is_over())
    }

    /// Changes the library. Any change after a deletion makes the deletion final.
    pub fn edit(&mut self, edit: LibraryEdit) {
        let removes = matches!(
            edit,
            LibraryEdit::Pose(_, PoseEdit::Delete) | LibraryEdit::Sequence(_, SequenceEdit::Delete)
        );
        let before = self.before.take();
        let kept = removes.then(|| self.library.clone());
        match edit {
            LibraryEdit::Undo => {
                if let Some(before) = before {
                    self.library = before;
                }
            }
            LibraryEdit::Pose(id, edit) => self.library.edit_pose(id, edit),
            LibraryEdit::Sequence(id, edit) => self.library.edit_sequence(id, edit),
            LibraryEdit::NewSequence(name) => {
                self.newest_sequence = self.library.add_sequence(&name);
            }
        }
        self.before = kept;
    }

    /// Adds what a file holds; that can be taken back.
    pub(crate) fn import(&mut self, library: Library) {
        self.before = Some(self.library.clone());
        self.library.merge(library);
    }
}
