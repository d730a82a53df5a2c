//! Proves the library's file and its players. What they send is proven with the task that plays.

use crate::hand::grip::{GripEstimate, GripState};
use crate::hand::{Angle, Dof, Force, Moment, PerDof, Speed};
use crate::poses::edit::{PoseEdit, SequenceEdit};
use crate::poses::file::{read, write};
use crate::poses::library::{
    LibraryPose, Millis, PoseId, PoseLibrary, Retries, StepGoal, UntilHolding,
};
use crate::poses::player::{Cue, PlayEnd, PlayMode, PlayPhase, Player};
use crate::poses::preview::Preview;
use crate::poses::way::WayPart;
use crate::record::Abort;
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
until = { grip = "holding", within_ms = 2000, retries = 3 }
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
    assert_eq!(sequence.steps[0].goal, StepGoal::Pose(pose.id));
    assert_eq!(sequence.steps[0].dwell, Millis::try_from(400).unwrap());
    let until = sequence.steps[0].until.unwrap();
    assert_eq!((until.within.get(), until.retries.get()), (2000, 3));
    let again = write(&library).unwrap();
    for kept in ["mood = \"calm\"", "colour = \"red\""] {
        assert!(again.contains(kept), "{kept}\n{again}");
    }
    assert_eq!(read(&again).unwrap(), library);
}

#[test]
fn a_bad_file_is_refused_with_line_and_field() {
    for (from, to, line, field) in [
        ("retries = 3 }", "retries = 3 }\nunitl = 3", 29, "unitl"),
        ("until = {", "untill = {", 28, "untill"),
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
        ("\"holding\"", "\"open\"", 28, "grip"),
        ("within_ms = 2000", "within_ms = -1", 28, "within_ms"),
        ("retries = 3", "retries = 21", 28, "retries"),
        ("retries = 3", "retry = 3", 28, "retry"),
        ("colour = \"red\"", "key = \"A\"", 11, "key"),
        ("colour = \"red\"", "key = \"é\"", 11, "key"),
        ("colour = \"red\"", "name_zh = \"\"", 11, "name_zh"),
    ] {
        let error = read(&GOOD.replacen(from, to, 1)).unwrap_err();
        assert_eq!(error.field.as_deref(), Some(field), "{to}: {error}");
        assert_eq!(error.line, Some(line), "{to}: {error}");
        let said = error.to_string();
        assert!(
            said.starts_with(&format!("line {line}, `{field}`: ")),
            "{said}"
        );
        for word in ["variant", "struct", "TOML", "expected", "invalid type"] {
            assert!(!said.contains(word), "{said}");
        }
    }
    let twice = GOOD.replacen("[[sequence]]", "[[pose]]\nname = \"Pinch\"\nspeed = 1\nforce = 1\nangles = { little = 1, ring = 1, middle = 1, index = 1, thumb_bend = 1, thumb_rotate = 1 }\n[[sequence]]", 1);
    assert!(read(&twice).unwrap_err().to_string().contains("used twice"));
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
        let mut library = PoseLibrary::default();
        for (name, angles, leave, speed, force, tags) in poses {
            let mut pose = LibraryPose::at(PerDof::new(angles.map(Angle::nearest)));
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
            let mut step = library.sequence(own).unwrap().steps[at];
            step.dwell = Millis::try_from(i64::from(dwell.min(Millis::MAX))).unwrap();
            step.until = (dwell % 2 == 0).then_some(UntilHolding {
                within: step.dwell,
                retries: Retries::try_from(i64::from(dwell % 21)).unwrap(),
            });
            step.speed = Speed::nearest(speed);
            library.edit_sequence(own, SequenceEdit::Change(at, step));
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

fn cue(angle: i16) -> Cue {
    Cue {
        targets: PerDof::splat(Angle::new(angle).ok()),
        gap: None,
        speed: Speed::MAX,
        force: Force::GENTLE,
        dwell: Duration::from_millis(200),
        limit: Duration::from_millis(1000),
        until: None,
        thresholds: None,
        hold: None,
    }
}

fn ms(millis: u64) -> Moment {
    Moment::from_micros(millis * 1000)
}

fn at(angle: i16) -> PerDof<Option<i16>> {
    PerDof::splat(Some(angle))
}

/// One moment of a player that nobody tells a grip.
fn tick(player: &mut Player, millis: u64, angle: i16) -> Option<WayPart> {
    player.tick(ms(millis), &at(angle), &GripEstimate::default())
}

fn grasp(state: GripState, since: u64) -> GripEstimate {
    GripEstimate {
        state,
        since: ms(since),
        asked: Some(ms(since)),
    }
}

/// A step at 200 that waits at most a second and tries once more.
fn waiting_cue() -> Cue {
    Cue {
        until: Some(UntilHolding {
            within: Millis::try_from(1000).unwrap(),
            retries: Retries::try_from(1).unwrap(),
        }),
        ..cue(200)
    }
}

#[test]
fn only_an_object_at_rest_ends_a_wait_and_what_is_there_instead_is_told() {
    for state in GripState::ALL {
        let mut player = Player::start(vec![waiting_cue()], false, PlayMode::Through, ms(0));
        let mut seen = |millis| {
            let sent = player.tick(ms(millis), &at(200), &grasp(state, 0));
            (sent.is_some(), player.view().phase)
        };
        assert!(seen(0).0);
        assert!(matches!(seen(10), (false, PlayPhase::Waiting { .. })));
        let at_once = seen(20);
        seen(400);
        let end = seen(1010);
        match state {
            GripState::Holding | GripState::Touching => {
                assert!(matches!(at_once, (false, PlayPhase::Dwelling { .. })));
                assert_eq!(end.1, PlayPhase::Ended(Ok(PlayEnd::Finished)));
            }
            GripState::Empty => assert!(matches!(end.1, PlayPhase::Opening { .. })),
            _ => {
                let why = PlayPhase::Ended(Ok(PlayEnd::NotHolding(state)));
                assert_eq!((at_once.0, end), (false, (false, why)));
            }
        }
    }
}

#[test]
fn a_new_grip_ends_the_way_and_one_of_before_does_not() {
    let mut player = Player::start(vec![waiting_cue()], false, PlayMode::Through, ms(1000));
    let held = |player: &mut Player, now, since| {
        player.tick(ms(now), &at(500), &grasp(GripState::Holding, since));
        player.view().phase
    };
    held(&mut player, 1000, 500);
    let moving = PlayPhase::Moving { since: ms(1000) };
    assert_eq!(held(&mut player, 1500, 500), moving, "held before");
    assert_eq!(
        held(&mut player, 1600, 1100),
        moving,
        "it had not moved yet"
    );
    assert_eq!(
        held(&mut player, 1700, 1650),
        PlayPhase::Dwelling { since: ms(1700) }
    );
    assert_eq!(player.view().late, 0);
}

#[test]
fn a_player_waits_for_arrival_then_for_the_dwell_and_loops() {
    let mut player = Player::start(vec![cue(0), cue(1000)], true, PlayMode::Through, ms(0));
    let mut sent = |now, angle| {
        player
            .tick(ms(now), &at(angle), &GripEstimate::default())
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
    assert_eq!(player.view().late, 1);
}

#[test]
fn each_part_of_a_way_has_its_own_time() {
    let angles = |index, thumb_bend| {
        let mut all = at(500);
        (all[Dof::Index], all[Dof::ThumbBend]) = (Some(index), Some(thumb_bend));
        all[Dof::ThumbRotate] = Some(0);
        all
    };
    let targets = angles(0, 600).map(|angle| Angle::new(angle?).ok());
    let cues = vec![Cue { targets, ..cue(0) }];
    let mut player = Player::start(cues, false, PlayMode::Through, ms(0));
    let mut sent = |now, seen: PerDof<Option<i16>>| {
        let sent = player.tick(ms(now), &seen, &GripEstimate::default())?;
        Some(sent.targets.map(|angle| angle.map(Angle::get)))
    };
    let thumb = |angle| {
        let mut only = PerDof::splat(None);
        only[Dof::ThumbBend] = Some(angle);
        only
    };
    assert_eq!(sent(0, angles(500, 60)), Some(thumb(800)));
    assert_eq!(sent(800, angles(500, 700)), None);
    let others = sent(900, angles(500, 800)).unwrap();
    assert_eq!(
        (others[Dof::Index], others[Dof::ThumbBend]),
        (Some(0), None)
    );
    assert_eq!(
        sent(1800, angles(100, 800)),
        None,
        "a second after the first part"
    );
    assert_eq!(sent(1850, angles(0, 800)), Some(thumb(600)));
    assert_eq!(sent(2700, angles(0, 600)), None);
    assert_eq!(player.view().late, 0);
}

#[test]
fn one_step_pauses_and_only_a_person_goes_on() {
    let mut player = Player::start(vec![cue(0), cue(1000)], false, PlayMode::OneStep, ms(0));
    assert!(tick(&mut player, 0, 0).is_some());
    tick(&mut player, 10, 0);
    tick(&mut player, 300, 0);
    assert!(player.is_paused());
    for later in [1000, 100_000] {
        assert_eq!(tick(&mut player, later, 0), None);
    }
    player.resume(PlayMode::Through, ms(100_000));
    assert!(tick(&mut player, 100_000, 0).is_some(), "the next pose");
    assert!(player.pause());
    player.resume(PlayMode::Through, ms(100_500));
    assert_eq!(player.view().at, 1);
    assert!(
        tick(&mut player, 100_500, 0).is_some(),
        "the same pose again"
    );
    player.end(Err(Abort::LinkLost));
    player.resume(PlayMode::Through, ms(100_600));
    player.end(Ok(PlayEnd::Person));
    assert_eq!(
        player.view().phase,
        PlayPhase::Ended(Err(Abort::LinkLost)),
        "the first reason stays"
    );
    assert_eq!(tick(&mut player, 100_700, 1000), None);
}

#[test]
fn a_dry_run_takes_as_long_as_the_speed_says() {
    let dry = |looped: bool| {
        let pose = |name: &str, angle: i16| {
            let angles = Dof::ALL
                .map(|dof| format!("{} = {angle}\n", dof.name()))
                .concat();
            format!(
                "[[pose]]\nname = \"{name}\"\nspeed = 1000\nforce = 500\n[pose.angles]\n{angles}"
            )
        };
        let step = |name: &str| {
            format!(
                "[[sequence.step]]\npose = \"{name}\"\nspeed = 1000\ndwell_ms = 200\nlimit_ms = 1000\n"
            )
        };
        let library = [
            "format = \"handscope-poses\"\nversion = 1\n".to_owned(),
            pose("Fist", 0),
            pose("Flat", 1000),
            format!("[[sequence]]\nname = \"Pump\"\nloop = {looped}\n"),
            step("Fist"),
            step("Flat"),
        ];
        let library = read(&library.concat()).unwrap();
        Preview::of(&library, library.sequences[0].id, at(1000), ms(0)).unwrap()
    };
    let preview = dry(false);
    let share = |preview: &Preview, now| preview.at(ms(now)).shares[Dof::Index].unwrap();
    assert!((share(&preview, 329) - 0.5).abs() < 0.01);
    assert!(share(&preview, 700) < 0.01, "dwells");
    assert!((share(&preview, 1187) - 0.5).abs() < 0.01);
    assert!(!preview.at(ms(1650)).over && preview.at(ms(1750)).over);
    let looped = dry(true);
    assert!((share(&looped, 1716 + 329) - 0.5).abs() < 0.01);
    assert!(!looped.at(ms(1_000_000)).over);
}
