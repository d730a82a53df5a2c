//! Proves the edits of the library, and that a deletion can be taken back.

use crate::app::poses::PoseState;
use crate::hand::{Angle, PerDof};
use crate::inputs::pad::input::PadAim;
use crate::inputs::pad::{PadAction, PadControl, PadMap};
use crate::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit};
use crate::poses::library::{
    LibraryPose, NAME_CHARS_MAX, PoseId, PoseLibrary, SequenceId, StepGoal,
};
use crate::poses::starter::starter;
use std::collections::BTreeSet;

fn two() -> (PoseState, PoseId, PoseId, SequenceId) {
    let mut library = PoseLibrary::default();
    let a = library
        .add_pose("A", LibraryPose::at(PerDof::splat(Angle::MAX)))
        .unwrap();
    let b = library
        .add_pose("B", LibraryPose::at(PerDof::splat(Angle::MIN)))
        .unwrap();
    let own = library.add_sequence("S").unwrap();
    for pose in [a, b, a] {
        library.edit_sequence(own, SequenceEdit::Add(pose));
    }
    (PoseState::new(library), a, b, own)
}

fn names(book: &PoseState) -> Vec<&str> {
    book.library
        .poses
        .iter()
        .map(|pose| pose.name.as_str())
        .collect()
}

#[test]
fn edits_keep_names_apart_and_steps_whole_and_a_deletion_can_be_undone() {
    let (mut book, a, b, own) = two();
    book.edit(LibraryEdit::Pose(a, PoseEdit::Duplicate));
    assert_eq!(names(&book), ["A", "A 2", "B"]);
    book.edit(LibraryEdit::Pose(b, PoseEdit::Rename("A".into())));
    assert_eq!(names(&book), ["A", "A 2", "A 3"]);
    book.edit(LibraryEdit::Pose(b, PoseEdit::Rename("  \n ".into())));
    book.edit(LibraryEdit::Pose(b, PoseEdit::Move(3)));
    book.edit(LibraryEdit::Pose(b, PoseEdit::Move(1)));
    assert_eq!(names(&book), ["A", "A 3", "A 2"]);
    book.edit(LibraryEdit::Pose(b, PoseEdit::Rename("长".repeat(99))));
    assert_eq!(
        book.library.pose(b).unwrap().name.chars().count(),
        NAME_CHARS_MAX
    );
    let before = book.library.clone();
    book.edit(LibraryEdit::Pose(a, PoseEdit::Delete));
    assert_eq!(book.library.sequence(own).unwrap().steps.len(), 1);
    assert!(book.can_undo());
    book.edit(LibraryEdit::Undo);
    assert_eq!(book.library, before);
    assert!(!book.can_undo());
    let (other, ..) = two();
    book.import(other.library.clone());
    book.import(other.library);
    let last = &book.library.poses[book.library.poses.len() - 2];
    assert_eq!(last.name, "A 4");
    let steps = &book.library.sequences.last().unwrap().steps;
    assert_eq!(
        steps[0].goal,
        StepGoal::Pose(last.id),
        "steps go along with their poses"
    );
}

#[test]
fn a_pose_and_a_step_go_to_a_place_and_those_between_make_room() {
    let (mut book, a, b, own) = two();
    book.edit(LibraryEdit::Pose(a, PoseEdit::Duplicate));
    book.edit(LibraryEdit::Pose(a, PoseEdit::Duplicate));
    assert_eq!(names(&book), ["A", "A 3", "A 2", "B"]);
    for (pose, to, want) in [
        (b, 0, ["B", "A", "A 3", "A 2"]),
        (b, 3, ["A", "A 3", "A 2", "B"]),
        (a, 1, ["A 3", "A", "A 2", "B"]),
        (a, 0, ["A", "A 3", "A 2", "B"]),
        (a, 0, ["A", "A 3", "A 2", "B"]),
        (a, 4, ["A", "A 3", "A 2", "B"]),
    ] {
        book.edit(LibraryEdit::Pose(pose, PoseEdit::Move(to)));
        assert_eq!(names(&book), want, "to {to}");
    }
    let steps = |book: &PoseState| -> Vec<PoseId> {
        let sequence = book.library.sequence(own).unwrap();
        let steps = sequence.steps.iter();
        let pose = |goal| match goal {
            StepGoal::Pose(id) => Some(id),
            StepGoal::Gap { .. } | StepGoal::Hold(_) => None,
        };
        steps.filter_map(|step| pose(step.goal)).collect()
    };
    let before = steps(&book);
    book.edit(LibraryEdit::Sequence(own, SequenceEdit::Move(0, 2)));
    let moved = [before[1], before[2], before[0]];
    assert_eq!(steps(&book), moved);
    book.edit(LibraryEdit::Sequence(own, SequenceEdit::Move(5, 0)));
    assert_eq!(steps(&book), moved);
}

#[test]
fn a_gamepad_goes_to_a_persons_own_poses_before_those_that_are_shipped_and_shown() {
    let (mut book, a, ..) = two();
    let map = PadMap::usual();
    let map = map.with(PadControl::Start, PadAction::Pose("A".into()));
    let map = map.unwrap();
    let shown = BTreeSet::new();
    let open = PerDof::splat(Some(Angle::MAX));
    let on_pad = |book: &PoseState, hidden| book.on_pad(&map, hidden);
    let names: Vec<String> = on_pad(&book, &shown).into_keys().collect();
    assert_eq!(names, ["A", "Open", "Pinch", "Point"], "B is on no button");
    assert_eq!(on_pad(&book, &shown)["A"], PadAim::joints(open));
    let shipped = starter().poses.iter().find(|pose| pose.name == "Pinch");
    assert_eq!(on_pad(&book, &shown)["Pinch"], PadAim::of(shipped.unwrap()));
    // Another name for it: the button's is gone, and that of a shipped one is the user's own now.
    book.edit(LibraryEdit::Pose(a, PoseEdit::Rename("Pinch".into())));
    let poses = on_pad(&book, &shown);
    assert_eq!(
        (poses.get("A"), poses["Pinch"]),
        (None, PadAim::joints(open))
    );
    book.edit(LibraryEdit::Pose(a, PoseEdit::Delete));
    assert_ne!(on_pad(&book, &shown)["Pinch"], PadAim::joints(open));
    let hidden = BTreeSet::from(["Pinch".to_owned()]);
    assert_eq!(on_pad(&book, &hidden).get("Pinch"), None);
}
