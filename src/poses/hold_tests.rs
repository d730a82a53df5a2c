//! Proves poses and steps that end in a hold: their file, their edits, and how a player waits for them.

use crate::hand::grip::GripEstimate;
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, Force, Moment, PerDof};
use crate::poses::edit::{PoseEdit, SequenceEdit};
use crate::poses::file::{read, write};
use crate::poses::library::{EntryId, LibraryPose, PoseLibrary, StepGoal};
use crate::poses::player::{PlayEnd, PlayMode, PlayPhase, Player, cues};
use std::time::Duration;

const FILE: &str = r#"format = "handscope-poses"
version = 1

[[pose]]
name = "Grasp"
speed = 200
force = 500
hold = { at_least_g = 150, at_most_g = 400 }
angles = { little = 1, ring = 1, middle = 1, index = 1, thumb_bend = 1, thumb_rotate = 1 }

[[sequence]]
name = "Show"
[[sequence.step]]
pose = "Grasp"
speed = 100
dwell_ms = 3000
limit_ms = 5000
[[sequence.step]]
pose = "Grasp"
hold = { at_least_g = 200, at_most_g = 600 }
speed = 100
dwell_ms = 3000
limit_ms = 5000
[[sequence.step]]
hold = { at_least_g = 100, at_most_g = 300 }
speed = 100
dwell_ms = 8000
limit_ms = 5000
"#;

fn forces(least: i16, most: i16) -> HoldForces {
    HoldForces::new(Force::nearest(least), Force::nearest(most)).unwrap()
}

#[test]
fn a_pose_a_step_and_a_step_of_its_own_hold_between_their_forces() {
    let library = read(FILE).unwrap();
    let pose = &library.poses[0];
    assert_eq!(pose.hold, Some(forces(150, 400)));
    let steps = &library.sequences[0].steps;
    assert_eq!(
        (steps[0].hold, steps[1].hold),
        (None, Some(forces(200, 600)))
    );
    assert_eq!(steps[2].goal, StepGoal::Hold(forces(100, 300)));
    let cues = cues(&library, library.sequences[0].id);
    let holds: Vec<_> = cues.iter().map(|cue| cue.hold.unwrap()).collect();
    assert_eq!(
        holds,
        [forces(150, 400), forces(200, 600), forces(100, 300)]
    );
    assert_eq!(cues[2].targets, PerDof::splat(None));
    assert_eq!(cues[2].dwell, Duration::from_secs(8));
    // Recalled alone it holds until the user ends it.
    let alone = library.plan(EntryId::Pose(pose.id)).unwrap();
    assert_eq!(alone.cues[0].dwell, Duration::MAX);
    let text = write(&library).unwrap();
    assert_eq!(read(&text).unwrap(), library, "{text}");
}

#[test]
fn a_hold_that_cannot_be_is_refused_with_line_and_field() {
    let until = "until = { grip = \"holding\", within_ms = 2000 }";
    for (from, to, line, field, said) in [
        (
            "at_most_g = 400",
            "at_most_g = 200",
            8,
            "hold",
            "leave no room for a hold",
        ),
        ("at_least_g = 150, ", "", 8, "at_least_g", "missing"),
        (
            "at_most_g = 400",
            "at_most_g = 400, kind = 1",
            8,
            "kind",
            "unknown",
        ),
        (
            "hold = { at_least_g = 200",
            &format!("{until}\nhold = {{ at_least_g = 200"),
            18,
            "until",
            "`hold`",
        ),
        (
            "hold = { at_least_g = 100",
            "force = 300\nhold = { at_least_g = 100",
            24,
            "force",
            "`hold`",
        ),
    ] {
        let error = read(&FILE.replacen(from, to, 1)).unwrap_err();
        let told = error.to_string();
        assert_eq!(error.line, Some(line), "{to}: {told}");
        assert_eq!(error.field.as_deref(), Some(field), "{to}: {told}");
        assert!(told.contains(said), "{to}: {told}");
    }
}

#[test]
fn holds_are_edited_and_a_reaction_has_none() {
    let mut library = PoseLibrary::default();
    let id = library
        .add_pose("A", LibraryPose::at(PerDof::splat(Angle::MIN)))
        .unwrap();
    library.edit_pose(id, PoseEdit::Hold(Some(forces(150, 400))));
    assert_eq!(library.pose(id).unwrap().hold, Some(forces(150, 400)));
    library.edit_pose(id, PoseEdit::Hold(None));
    assert_eq!(library.pose(id).unwrap().hold, None);
    let own = library.add_sequence("S").unwrap();
    library.edit_sequence(own, SequenceEdit::AddHold(forces(100, 300)));
    library.edit_pose(id, PoseEdit::Delete);
    let steps = &library.sequence(own).unwrap().steps;
    assert_eq!(steps[0].goal, StepGoal::Hold(forces(100, 300)));
    let reaction = FILE.to_owned()
        + "[[reaction]]\nname = \"R\"\nrest = \"Grasp\"\ntouched = \"Grasp\"\nthreshold_n = 0.5\n";
    let library = read(&reaction).unwrap();
    let plan = library.plan(EntryId::Reaction(library.reactions[0].id));
    assert!(plan.unwrap().cues().all(|cue| cue.hold.is_none()));
}

#[test]
fn a_player_sends_nothing_for_a_hold_and_goes_on_once_it_was_held() {
    let library = read(FILE).unwrap();
    let cues = cues(&library, library.sequences[0].id);
    let ms = |millis: u64| Moment::from_micros(millis * 1000);
    let mut player = Player::start(cues.clone(), false, PlayMode::Through, ms(0));
    let tick = |player: &mut Player, millis| {
        player.tick(
            ms(millis),
            &PerDof::splat(Some(1)),
            &GripEstimate::default(),
        )
    };
    for millis in [0, 10, 100_000] {
        assert_eq!(tick(&mut player, millis), None);
        assert_eq!(player.view().phase, PlayPhase::Holding { since: ms(0) });
    }
    player.held(ms(100_000));
    assert_eq!(player.view().at, 1);
    player.held(ms(100_100));
    player.held(ms(100_200));
    assert_eq!(player.view().phase, PlayPhase::Ended(Ok(PlayEnd::Finished)));
    // In single steps only the user goes on, and a pause begins the hold again.
    let mut player = Player::start(cues, false, PlayMode::OneStep, ms(0));
    player.held(ms(10));
    assert!(player.is_paused());
    player.resume(PlayMode::Through, ms(20));
    assert_eq!(player.view().at, 1);
    assert!(player.pause());
    player.held(ms(30));
    assert!(player.is_paused(), "it holds no longer");
    player.resume(PlayMode::Through, ms(40));
    assert_eq!(player.view().phase, PlayPhase::Holding { since: ms(40) });
    assert_eq!(player.view().at, 1);
}
