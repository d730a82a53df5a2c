//! Proves the library's file, its edits and its players. What they send is proven in `act_poses_tests`.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "a test may"
)]

use crate::app::config::{Kept, save};
use crate::app::notices::NoticeKind;
use crate::app::poses::book::PoseBook;
use crate::app::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit, Way};
use crate::app::poses::file::{read, write};
use crate::app::poses::library::{Library, Millis, NAME_CHARS_MAX, Pose, PoseId, SequenceId};
use crate::app::poses::player::{Cue, End, Pace, Phase, Player};
use crate::app::poses::preview::Preview;
use crate::app::poses::store::load;
use crate::hand::{Angle, Dof, Force, Moment, PerDof, Speed};
use proptest::prelude::*;
use std::time::Duration;

const GOOD: &str = r#"format = "handscope-poses"
version = 1
mood = "calm"

[[pose]]
name = "Pinch"
tags = ["demo"]
speed = 300
force = 800
leave = ["little"]
colour = "red"
[pose.angles]
little = 1000
ring = 1000
middle = 1000
index = 420
thumb_bend = 420
thumb_rotate = 200

[[sequence]]
name = "Wave"
loop = true
[[sequence.step]]
pose = "Pinch"
speed = 250
dwell_ms = 400
limit_ms = 3000
note = "slow"
"#;

#[test]
fn a_file_is_read_as_documented_and_unknown_keys_survive() {
    let library = read(GOOD).unwrap();
    let pose = &library.poses[0];
    assert_eq!(
        (pose.name.as_str(), pose.speed.get(), pose.force.get()),
        ("Pinch", 300, 800)
    );
    assert_eq!(pose.targets()[Dof::Little], None);
    assert_eq!(pose.targets()[Dof::Index], Angle::new(420).ok());
    let sequence = &library.sequences[0];
    assert!(sequence.looped);
    assert_eq!(sequence.steps[0].pose, pose.id);
    assert_eq!(sequence.steps[0].dwell, Millis::nearest(400));
    let again = write(&library).unwrap();
    for kept in ["mood = \"calm\"", "colour = \"red\"", "note = \"slow\""] {
        assert!(again.contains(kept), "{kept}\n{again}");
    }
    assert_eq!(read(&again).unwrap(), library);
}

#[test]
fn a_bad_file_is_refused_with_line_and_field() {
    for (from, to, line, field) in [
        ("index = 420", "index = 1001", 16, "index"),
        ("index = 420", "index = -1", 16, "index"),
        ("index = 420", "index = nan", 16, "index"),
        ("index = 420", "index = \"open\"", 16, "index"),
        ("index = 420\n", "", 12, "index"),
        ("index = 420", "index = 420\npinky = 3", 17, "pinky"),
        ("speed = 300", "speed = 1001", 8, "speed"),
        ("force = 800", "force = 3001", 9, "force"),
        ("[\"little\"]", "[\"pinky\"]", 10, "leave"),
        ("version = 1", "version = 2", 2, "version"),
        ("version = 1\n", "", 1, "version"),
        ("\"handscope-poses\"", "\"recipes\"", 1, "format"),
        ("name = \"Pinch\"", "name = \"\"", 6, "name"),
        ("name = \"Pinch\"", "name = \"a\\nb\"", 6, "name"),
        ("pose = \"Pinch\"", "pose = \"Fist\"", 24, "pose"),
        ("dwell_ms = 400", "dwell_ms = 600001", 26, "dwell_ms"),
        ("loop = true", "loop = 1", 22, "loop"),
    ] {
        let error = read(&GOOD.replacen(from, to, 1)).unwrap_err();
        assert_eq!(error.field.as_deref(), Some(field), "{to}: {error}");
        assert_eq!(error.line, Some(line), "{to}: {error}");
        let said = error.to_string();
        assert!(
            said.starts_with(&format!("line {line}, `{field}`: ")),
            "{said}"
        );
    }
    let twice = GOOD.replacen("[[sequence]]", "[[pose]]\nname = \"Pinch\"\nspeed = 1\nforce = 1\nangles = { little = 1, ring = 1, middle = 1, index = 1, thumb_bend = 1, thumb_rotate = 1 }\n[[sequence]]", 1);
    assert!(
        read(&twice)
            .unwrap_err()
            .to_string()
            .contains("there twice")
    );
    for garbage in [
        "",
        "\0\0",
        "= 3",
        "[[pose]]",
        "format = \"handscope-poses\"\nversion = 1\npose = 3",
    ] {
        read(garbage).unwrap_err();
    }
}

#[test]
fn a_bad_file_on_disk_is_put_aside_and_the_last_good_one_taken() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("poses.toml");
    assert_eq!(load(&path), (Library::default(), None));
    let good = read(GOOD).unwrap();
    save(&path, &good).unwrap();
    save(&path, &good).unwrap();
    std::fs::write(&path, "half a fi").unwrap();
    let (library, notice) = load(&path);
    assert_eq!(library, good);
    let Some(NoticeKind::PosesIgnored {
        kept_as: Some(aside),
        ..
    }) = notice
    else {
        panic!("{notice:?}")
    };
    assert_eq!(std::fs::read_to_string(aside).unwrap(), "half a fi");
}

#[test]
fn a_failed_write_leaves_the_file_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("poses.toml");
    let good = read(GOOD).unwrap();
    save(&path, &good).unwrap();
    // A folder where the new file would be made: the write fails before the old file is touched.
    std::fs::create_dir(path.with_extension("new.toml")).unwrap();
    assert!(save(&path, &Library::default()).is_err());
    assert_eq!(
        std::fs::read_to_string(&path).unwrap(),
        good.text().unwrap()
    );
}

fn name() -> impl Strategy<Value = String> {
    "[a-zA-Z0-9\"'\\\\=#. 手捏]{1,40}"
}

fn pose() -> impl Strategy<Value = (String, [i16; 6], [bool; 6], i16, i16, String)> {
    (
        name(),
        any::<[i16; 6]>(),
        any::<[bool; 6]>(),
        any::<i16>(),
        any::<i16>(),
        "[a-z,\" ]{0,30}",
    )
}

proptest! {
    #[test]
    fn any_library_comes_back_from_its_text(
        poses in prop::collection::vec(pose(), 0..6),
        steps in prop::collection::vec((0..6_usize, any::<u32>(), any::<i16>()), 0..8),
        looped: bool,
    ) {
        let mut library = Library::default();
        for (name, angles, leave, speed, force, tags) in poses {
            let mut pose = Pose::at(PerDof::new(angles.map(Angle::nearest)));
            pose.leave = PerDof::new(leave);
            (pose.speed, pose.force) = (Speed::nearest(speed), Force::nearest(force));
            let name = if name.trim().is_empty() { "x" } else { &name };
            let id = library.add_pose(name, pose).unwrap();
            library.edit_pose(id, PoseEdit::Tags(tags));
        }
        let ids: Vec<PoseId> = library.poses.iter().map(|pose| pose.id).collect();
        let own = library.add_sequence("own").unwrap();
        library.edit_sequence(own, SequenceEdit::Loop(looped));
        for (at, (pose, dwell, speed)) in steps.into_iter().filter(|(pose, ..)| *pose < ids.len()).enumerate() {
            library.edit_sequence(own, SequenceEdit::Add(ids[pose]));
            library.edit_sequence(own, SequenceEdit::Dwell(at, Millis::nearest(dwell)));
            library.edit_sequence(own, SequenceEdit::Speed(at, Speed::nearest(speed)));
        }
        let text = write(&library).unwrap();
        prop_assert_eq!(read(&text).unwrap(), library);
    }

    #[test]
    fn no_text_makes_the_reader_fail_in_another_way(text in "\\PC*", cut in 0..600_usize) {
        let _refused = read(&text);
        let _cut = read(&GOOD.chars().take(cut).collect::<String>());
    }
}

fn two() -> (PoseBook, PoseId, PoseId, SequenceId) {
    let mut library = Library::default();
    let a = library
        .add_pose("A", Pose::at(PerDof::splat(Angle::MAX)))
        .unwrap();
    let b = library
        .add_pose("B", Pose::at(PerDof::splat(Angle::MIN)))
        .unwrap();
    let own = library.add_sequence("S").unwrap();
    for pose in [a, b, a] {
        library.edit_sequence(own, SequenceEdit::Add(pose));
    }
    (PoseBook::new(library), a, b, own)
}

fn names(book: &PoseBook) -> Vec<&str> {
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
    book.edit(LibraryEdit::Pose(b, PoseEdit::Shift(Way::Later)));
    book.edit(LibraryEdit::Pose(b, PoseEdit::Shift(Way::Earlier)));
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
    let mut merged = book.library.clone();
    merged.merge(read(GOOD).unwrap());
    merged.merge(read(GOOD).unwrap());
    let last = merged.poses.last().unwrap();
    assert_eq!(last.name, "Pinch 2");
    assert_eq!(merged.sequences.last().unwrap().steps[0].pose, last.id);
}

fn cue(angle: i16) -> Cue {
    Cue {
        pose: PoseId(1),
        targets: PerDof::splat(Angle::new(angle).ok()),
        speed: Speed::MAX,
        force: Force::GENTLE,
        dwell: Duration::from_millis(200),
        limit: Duration::from_millis(1000),
    }
}

fn ms(millis: u64) -> Moment {
    Moment::from_micros(millis * 1000)
}

fn at(angle: i16) -> PerDof<Option<i16>> {
    PerDof::splat(Some(angle))
}

#[test]
fn a_player_waits_for_arrival_then_for_the_dwell_and_loops() {
    let mut player = Player::start(vec![cue(0), cue(1000)], true, Pace::Through, ms(0));
    let mut sent = |now, angle| {
        player
            .tick(ms(now), &at(angle))
            .map(|cue| cue.targets[Dof::Index])
    };
    assert_eq!(sent(0, 500), Some(Angle::new(0).ok()));
    assert_eq!(sent(300, 21), None, "not there yet");
    assert_eq!(sent(400, 20), None, "there");
    assert_eq!(sent(590, 20), None, "dwells");
    assert_eq!(sent(600, 20), Some(Angle::new(1000).ok()));
    assert_eq!(sent(1500, 20), None);
    assert_eq!(sent(1600, 20), None, "its time is over");
    assert_eq!(
        sent(1800, 20),
        Some(Angle::new(0).ok()),
        "from the start again"
    );
    assert_eq!(player.late(), 1);
}

#[test]
fn one_step_pauses_and_only_a_person_goes_on() {
    let mut player = Player::start(vec![cue(0), cue(1000)], false, Pace::OneStep, ms(0));
    assert!(player.tick(ms(0), &at(0)).is_some());
    player.tick(ms(10), &at(0));
    player.tick(ms(300), &at(0));
    assert!(player.is_paused());
    for later in [1000, 100_000] {
        assert_eq!(player.tick(ms(later), &at(0)), None);
    }
    player.resume(Pace::Through, ms(100_000));
    assert!(player.tick(ms(100_000), &at(0)).is_some(), "the next pose");
    assert!(player.pause());
    player.resume(Pace::Through, ms(100_500));
    assert_eq!(player.at(), 1);
    assert!(
        player.tick(ms(100_500), &at(0)).is_some(),
        "the same pose again"
    );
    player.end(End::Fault);
    player.resume(Pace::Through, ms(100_600));
    player.end(End::Person);
    assert_eq!(
        player.phase(),
        Phase::Ended(End::Fault),
        "the first reason stays"
    );
    assert_eq!(player.tick(ms(100_700), &at(1000)), None);
}

#[test]
fn a_dry_run_takes_as_long_as_the_speed_says() {
    let cues = vec![cue(0), cue(1000)];
    let preview = Preview::start(SequenceId(1), cues.clone(), false, at(1000), ms(0));
    let share = |preview: &Preview, now| preview.at(ms(now)).shares[Dof::Index].unwrap();
    assert!((share(&preview, 300) - 0.5).abs() < 0.01);
    assert!(share(&preview, 700) < 0.01, "dwells");
    assert!((share(&preview, 1100) - 0.5).abs() < 0.01);
    assert!(!preview.at(ms(1500)).over && preview.at(ms(1700)).over);
    let looped = Preview::start(SequenceId(1), cues, true, at(1000), ms(0));
    assert!((share(&looped, 1600 + 300) - 0.5).abs() < 0.01);
    assert!(!looped.at(ms(1_000_000)).over);
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
    let steps = |book: &PoseBook| -> Vec<PoseId> {
        let sequence = book.library.sequence(own).unwrap();
        sequence.steps.iter().map(|step| step.pose).collect()
    };
    let before = steps(&book);
    book.edit(LibraryEdit::Sequence(own, SequenceEdit::Move(0, 2)));
    let moved = [before[1], before[2], before[0]];
    assert_eq!(steps(&book), moved);
    book.edit(LibraryEdit::Sequence(own, SequenceEdit::Move(5, 0)));
    assert_eq!(steps(&book), moved);
}
