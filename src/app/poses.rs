//! The pose library and its view state: undo, dry run, newest entries. Sends nothing.

use crate::app::notices::NoticeKind;
use crate::inputs::pad::PadMap;
use crate::inputs::pad::input::{PadAim, PadPoses};
use crate::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit};
use crate::poses::library::{
    EntryId, EntryKey, EntryNames, LibraryPose, PoseId, PoseLibrary, Reaction, ReactionId,
    Sequence, SequenceId,
};
use crate::poses::player::PlayPlan;
use crate::poses::preview::Preview;
use crate::poses::starter::starter;
use std::collections::BTreeSet;

/// The user's library with the shipped one, and its view state.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PoseState {
    /// The user's own entries.
    pub library: PoseLibrary,
    /// The dry run, if active.
    pub preview: Option<Preview>,
    /// The last recalled pose.
    pub recalled: Option<PoseId>,
    /// The last added pose, for the view to show.
    pub newest: Option<PoseId>,
    /// Reason why the last file was rejected.
    pub refused: Option<NoticeKind>,
    /// The last added sequence, for the view to show.
    pub newest_sequence: Option<SequenceId>,
    before: Option<PoseLibrary>,
}

impl PoseState {
    /// Creates the state with the stored library.
    pub fn new(library: PoseLibrary) -> Self {
        Self {
            library,
            ..Self::default()
        }
    }

    /// A user's or shipped pose.
    pub fn pose(&self, id: PoseId) -> Option<&LibraryPose> {
        self.library.pose(id).or_else(|| starter().pose(id))
    }

    /// A user's or shipped sequence.
    pub fn sequence(&self, id: SequenceId) -> Option<&Sequence> {
        self.library_of(id).sequence(id)
    }

    /// A user's or shipped reaction.
    pub fn reaction(&self, id: ReactionId) -> Option<&Reaction> {
        let shipped = || starter().reaction(id);
        self.library.reaction(id).or_else(shipped)
    }

    /// The library that contains this sequence: the user's, else the shipped one.
    pub fn library_of(&self, id: SequenceId) -> &PoseLibrary {
        match self.library.sequence(id) {
            Some(_) => &self.library,
            None => starter(),
        }
    }

    /// Plan for playing a user's or shipped entry.
    pub fn plan(&self, entry: EntryId) -> Option<PlayPlan> {
        let shipped = || starter().plan(entry);
        self.library.plan(entry).or_else(shipped)
    }

    /// Names of a user's or shipped entry.
    pub fn named(&self, entry: EntryId) -> Option<EntryNames<'_>> {
        let shipped = || starter().named(entry);
        self.library.named(entry).or_else(shipped)
    }

    /// Shipped entries that are neither hidden nor overridden by a user's entry of the same name.
    pub fn shipped(&self, hidden: &BTreeSet<String>) -> impl Iterator<Item = EntryId> {
        let name = |entry| starter().named(entry).map_or("", |names| names.text);
        let is_overridden = move |entry: EntryId| {
            let mut own = self.library.entries().filter(|own| own.is_same_kind(entry));
            own.any(|own| self.named(own).is_some_and(|own| own.text == name(entry)))
        };
        let all = starter().entries();
        all.filter(move |entry| !hidden.contains(name(*entry)) && !is_overridden(*entry))
    }

    /// All poses: the user's, then the visible shipped ones.
    pub fn poses(&self, hidden: &BTreeSet<String>) -> impl Iterator<Item = &LibraryPose> {
        let shipped = self.shipped(hidden).filter_map(|entry| match entry {
            EntryId::Pose(id) => starter().pose(id),
            EntryId::Sequence(_) | EntryId::Reaction(_) => None,
        });
        self.library.poses.iter().chain(shipped)
    }

    /// Poses assigned to the buttons of a gamepad.
    pub fn on_pad(&self, map: &PadMap, hidden: &BTreeSet<String>) -> PadPoses {
        let all: Vec<&LibraryPose> = self.poses(hidden).collect();
        let named = map.poses().filter_map(|name| {
            let pose = all.iter().find(|pose| pose.name == name)?;
            Some((name.to_owned(), PadAim::of(pose)))
        });
        named.collect()
    }

    /// Entries that can be started with one press: poses except those used only by demos, then sequences and reactions; the
    /// user's before the shipped ones.
    pub fn ready(&self, hidden: &BTreeSet<String>) -> Vec<EntryId> {
        let is_demo = |entry: &EntryId| match entry {
            EntryId::Pose(id) => self.pose(*id).is_some_and(LibraryPose::is_for_demos),
            _ => false,
        };
        let all = self.library.entries().chain(self.shipped(hidden));
        let mut ready: Vec<EntryId> = all.filter(|entry| !is_demo(entry)).collect();
        ready.sort_by_key(|entry| match entry {
            EntryId::Pose(_) => 0,
            EntryId::Sequence(_) => 1,
            EntryId::Reaction(_) => 2,
        });
        ready
    }

    /// Entry started by a key.
    pub fn by_key(&self, key: EntryKey, hidden: &BTreeSet<String>) -> Option<EntryId> {
        let ready = self.ready(hidden);
        let has = |id: &EntryId| self.named(*id).is_some_and(|names| names.key == Some(key));
        ready.into_iter().find(has)
    }

    /// True if a deletion or an import can be undone.
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
            LibraryEdit::Copy(entry) => {
                let new = self.library.copy_from(starter(), entry);
                self.mark_newest(new);
            }
            LibraryEdit::Add(poses) => {
                let new = self.library.add_all(poses);
                self.mark_newest(new);
            }
            LibraryEdit::NewSequence(name) => {
                self.newest_sequence = self.library.add_sequence(&name);
            }
        }
        self.before = kept;
    }

    fn mark_newest(&mut self, new: Option<EntryId>) {
        match new {
            Some(EntryId::Pose(id)) => self.newest = Some(id),
            Some(EntryId::Sequence(id)) => self.newest_sequence = Some(id),
            Some(EntryId::Reaction(_)) | None => {}
        }
    }

    /// Merges an imported library; this can be undone.
    pub(crate) fn import(&mut self, library: PoseLibrary) {
        self.before = Some(self.library.clone());
        self.library.merge(library);
    }
}

#[cfg(test)]
mod tests;
