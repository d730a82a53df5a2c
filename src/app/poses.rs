//! The library with what goes on around it: undo, the dry run, what was added last. Sends nothing.

use crate::app::notices::NoticeKind;
use crate::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit};
use crate::poses::library::{PoseId, PoseLibrary, SequenceId};
use crate::poses::preview::Preview;

/// The poses of a person, and what goes on with them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseState {
    /// Poses and sequences.
    pub library: PoseLibrary,
    /// The dry run, if there is one.
    pub preview: Option<Preview>,
    /// The pose that was recalled last.
    pub recalled: Option<PoseId>,
    /// The pose that was made last, for the view to show.
    pub newest: Option<PoseId>,
    /// Why the last file was not taken.
    pub refused: Option<NoticeKind>,
    /// The sequence that was made last, for the view to show.
    pub newest_sequence: Option<SequenceId>,
    before: Option<PoseLibrary>,
}

impl PoseState {
    /// With the library that was kept.
    #[must_use]
    pub fn new(library: PoseLibrary) -> Self {
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
    pub(crate) fn import(&mut self, library: PoseLibrary) {
        self.before = Some(self.library.clone());
        self.library.merge(library);
    }
}

#[cfg(test)]
mod tests;
