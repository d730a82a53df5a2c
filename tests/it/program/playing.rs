//! Poses and sequences: what they send, and what ends them.

use crate::program::{ANGLE_SET, Bench, angles_told, shorts, spoil};
use crate::setup::line::Trouble;
use handscope::app::action::Action;
use handscope::app::notices::NoticeKind;
use handscope::app::state::State;
use handscope::hand::{Angle, Dof, Fault, Finger, Force, PerDof, Span, Speed};
use handscope::motion::program::Ended;
use handscope::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit};
use handscope::poses::library::{EntryId, Millis, PoseId, SequenceId, SequenceStep};
use handscope::poses::player::{PlayEnd, PlayPhase};
use handscope::poses::starter::starter;
use handscope::poses::{Play, Preset};
use handscope::record::{Abort, Disarmed};
use handscope::sim::Object;
use tokio::time::Duration;

/// Two poses, each captured and then edited, and a sequence of both.
pub(super) fn library(bench: &mut Bench) -> (PoseId, SequenceId) {
    let mut ids = Vec::new();
    for (name, angle) in [("A", 700), ("B", 300)] {
        bench.act(Action::Capture(name.into()));
        let id = bench.state().poses.newest.unwrap();
        for dof in Dof::ALL {
            let edit = PoseEdit::Angle(dof, Angle::nearest(angle));
            bench.act(Action::Library(LibraryEdit::Pose(id, edit)));
        }
        ids.push(id);
    }
    bench.act(Action::Library(LibraryEdit::NewSequence("S".into())));
    let own = bench.state().poses.newest_sequence.unwrap();
    for (at, pose) in ids.iter().enumerate() {
        let edit = |edit| Action::Library(LibraryEdit::Sequence(own, edit));
        bench.act(edit(SequenceEdit::Add(*pose)));
        let sequence = bench.state().poses.library.sequence(own).unwrap();
        let short = SequenceStep {
            dwell: Millis::try_from(50).unwrap(),
            ..sequence.steps[at]
        };
        bench.act(edit(SequenceEdit::Change(at, short)));
    }
    (ids[0], own)
}

/// SPEED_SET (manual 2.6.13).
const SPEED_SET: u16 = 1522;
/// FORCE_SET (manual 2.6.12).
const FORCE_SET: u16 = 1498;

/// What the hand holds in six shorts.
fn holds(bench: &Bench, address: u16) -> Vec<i16> {
    let read = |span| bench.hand.with(|hand, now| hand.read(span, now));
    let bytes = read(Span::new(address, 12)).unwrap();
    let (pairs, _) = bytes.as_chunks::<2>();
    pairs.iter().map(|pair| i16::from_le_bytes(*pair)).collect()
}

fn is_over(state: &State) -> bool {
    let run = state.hand().running.sequence();
    run.is_some_and(|run| matches!(run.view.phase, PlayPhase::Ended(_)))
}

#[tokio::test(start_paused = true)]
async fn what_is_played_runs_at_its_own_speed_and_force_and_gives_the_own_back() {
    let mut bench = Bench::live().await;
    let (pose, sequence) = library(&mut bench);
    for edit in [
        PoseEdit::Speed(Speed::nearest(600)),
        PoseEdit::Force(Force::nearest(900)),
    ] {
        bench.act(Action::Library(LibraryEdit::Pose(pose, edit)));
    }
    bench.arm().await;
    let wave = starter().entries().find(|entry| {
        starter()
            .named(*entry)
            .is_some_and(|names| names.text == "Wave")
    });
    let sequence = EntryId::Sequence(sequence);
    for (what, act) in [
        ("pose", Action::Recall(pose)),
        ("demo", Action::Play(Play::Start(wave.unwrap()))),
        ("sequence", Action::Play(Play::Start(sequence))),
    ] {
        bench.act(act);
        bench.run(150).await;
        // A step of a new sequence is as gentle as the person.
        let is_own = holds(&bench, SPEED_SET)[3] != 200;
        assert!(is_own || what == "sequence", "{what}");
        let wish = bench.hand().controls.joints[Dof::Index];
        assert_eq!(wish.speed, Some(Speed::GENTLE), "{what}");
        assert_eq!(wish.force, Some(Force::GENTLE), "{what}");
        if what == "demo" {
            bench.run(1500).await;
            bench.act(Action::Play(Play::End));
        }
        bench.until(what, is_over).await;
        bench.run(300).await;
        assert_eq!(holds(&bench, SPEED_SET), [200; 6], "{what}");
        assert_eq!(holds(&bench, FORCE_SET), [500; 6], "{what}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_joint_that_presses_after_a_pose_keeps_its_threshold_until_it_is_told_something_else() {
    let mut bench = Bench::live().await;
    bench
        .hand
        .with(|hand, _| hand.set_object(&Object::rigid(600.0)));
    let (pose, _) = library(&mut bench);
    for dof in Dof::ALL {
        let edit = PoseEdit::Angle(dof, Angle::nearest(300));
        bench.act(Action::Library(LibraryEdit::Pose(pose, edit)));
    }
    let edit = PoseEdit::Force(Force::nearest(300));
    bench.act(Action::Library(LibraryEdit::Pose(pose, edit)));
    bench.arm().await;
    bench.act(Action::Recall(pose));
    bench.until("pose", is_over).await;
    bench.run(3000).await;
    assert_eq!(holds(&bench, FORCE_SET)[3], 300, "it presses");
    let held = bench.hand().held_otherwise(Dof::Index);
    assert_eq!(held.force.map(Force::get), Some(300), "and that is shown");
    bench.act(Action::Target(Dof::Index, Angle::MAX));
    bench.run(100).await;
    let forces = holds(&bench, FORCE_SET);
    assert_eq!((forces[3], forces[2]), (500, 300), "told, and not told");
}

#[tokio::test(start_paused = true)]
async fn who_takes_a_joint_from_a_demo_leaves_the_others_what_they_were_sent_with() {
    let mut bench = Bench::live().await;
    let (pose, _) = library(&mut bench);
    for edit in [
        PoseEdit::Speed(Speed::nearest(25)),
        PoseEdit::Force(Force::nearest(300)),
    ] {
        bench.act(Action::Library(LibraryEdit::Pose(pose, edit)));
    }
    bench.arm().await;
    bench.act(Action::Recall(pose));
    bench.run(300).await;
    bench.act(Action::Target(Dof::Index, Angle::nearest(900)));
    bench.run(300).await;
    let (speeds, forces) = (holds(&bench, SPEED_SET), holds(&bench, FORCE_SET));
    assert_eq!((speeds[3], forces[3]), (200, 500), "the one that was taken");
    assert_eq!((speeds[2], forces[2]), (25, 300), "one that goes on");
    bench.run(12_000).await;
    let (speeds, forces) = (holds(&bench, SPEED_SET), holds(&bench, FORCE_SET));
    assert_eq!((speeds[2], forces[2]), (200, 500), "once it is there");
}

#[tokio::test(start_paused = true)]
async fn what_is_broken_off_gives_the_own_speed_and_force_back_before_the_hand_moves_again() {
    type Break = fn(&mut Bench);
    let ends: [(&str, Break); 6] = [
        ("stop", |bench| bench.act(Action::Stop)),
        ("end", |bench| bench.act(Action::Play(Play::End))),
        ("disarming", |bench| bench.act(Action::Disarm)),
        ("a preset", |bench| bench.act(Action::Preset(Preset::Open))),
        ("at once", |_| ()),
        ("pause", |bench| bench.act(Action::Play(Play::Pause))),
    ];
    for (what, end) in ends {
        let mut bench = Bench::live().await;
        let (pose, _) = library(&mut bench);
        let edit = PoseEdit::Speed(Speed::nearest(600));
        bench.act(Action::Library(LibraryEdit::Pose(pose, edit)));
        bench.arm().await;
        bench.act(Action::Recall(pose));
        if what != "at once" {
            bench.run(100).await;
            assert_eq!(holds(&bench, SPEED_SET), [600; 6], "{what}");
        }
        end(&mut bench);
        bench.run(1500).await;
        if !bench.hand().connection.is_armed() {
            bench.act(Action::Arm);
            bench.run(300).await;
            assert!(bench.hand().connection.is_armed(), "{what}");
        }
        bench.act(Action::Target(Dof::Index, Angle::nearest(900)));
        bench.run(300).await;
        assert_eq!(holds(&bench, SPEED_SET), [200; 6], "{what}");
        assert_eq!(holds(&bench, FORCE_SET), [500; 6], "{what}");
        let speed = bench.hand().controls.joints[Dof::Index].speed;
        assert_eq!(speed, Some(Speed::GENTLE), "{what}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_link_that_is_lost_in_a_pose_gives_the_own_speed_back_when_the_hand_is_armed_again() {
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    let (pose, _) = library(&mut bench);
    let edit = PoseEdit::Speed(Speed::nearest(600));
    bench.act(Action::Library(LibraryEdit::Pose(pose, edit)));
    bench.arm().await;
    bench.act(Action::Recall(pose));
    bench.run(100).await;
    spoil(&line, Trouble::Gone(Duration::from_secs(2)));
    bench.run(6000).await;
    assert_eq!(
        holds(&bench, SPEED_SET),
        [600; 6],
        "connecting writes nothing"
    );
    let told = bench.hand().held_otherwise(Dof::Index).speed;
    assert_eq!(told, Some(Speed::nearest(600)), "and that is said");
    bench.act(Action::Arm);
    bench.run(300).await;
    assert_eq!(holds(&bench, SPEED_SET), [200; 6]);
}

pub(super) fn phase(bench: &Bench) -> Option<PlayPhase> {
    let run = bench.hand().running.sequence();
    run.map(|run| run.view.phase)
}

#[tokio::test(start_paused = true)]
async fn a_captured_pose_is_the_one_the_hand_has_and_an_old_one_is_refused() {
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    bench.act(Action::Capture("Pose".into()));
    bench.act(Action::Capture("Pose".into()));
    let poses = &bench.state().poses.library.poses;
    let names: Vec<_> = poses.iter().map(|pose| pose.name.as_str()).collect();
    assert_eq!(names, ["Pose", "Pose 2"]);
    let at = PerDof::from_fn(|dof| Angle::nearest(bench.angle(dof)));
    assert_eq!(poses[0].angles, at);
    spoil(&line, Trouble::Gone(Duration::from_secs(60)));
    bench.run(1000).await;
    bench.act(Action::Capture("Pose".into()));
    assert_eq!(bench.state().poses.library.poses.len(), 2);
    assert!(bench.told().contains(&NoticeKind::PoseUnknown));
    assert_eq!(bench.addresses(), [0_u16; 0], "capturing sends nothing");
}

#[tokio::test(start_paused = true)]
async fn recalling_sends_speed_force_and_angle_of_free_joints_only_and_never_arms() {
    let mut bench = Bench::live().await;
    let (a, own) = library(&mut bench);
    for play in [
        Play::Start(EntryId::Sequence(own)),
        Play::Step(own),
        Play::Resume,
        Play::End,
    ] {
        bench.act(Action::Play(play));
    }
    bench.act(Action::Recall(a));
    bench.run(300).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
    assert!(!bench.hand().connection.is_armed() && bench.hand().running.sequence().is_none());
    bench.arm().await;
    bench.act(Action::Lock(Dof::Ring, true));
    for edit in [
        PoseEdit::Leave(Dof::Little, true),
        PoseEdit::Speed(Speed::nearest(350)),
        PoseEdit::Force(Force::nearest(900)),
    ] {
        bench.act(Action::Library(LibraryEdit::Pose(a, edit)));
    }
    bench.run(100).await;
    bench.forget();
    bench.act(Action::Recall(a));
    bench.run(300).await;
    let written = bench.written();
    let mut sent: Vec<_> = written
        .iter()
        .map(|one| (one.address, shorts(one)))
        .collect();
    sent.dedup();
    // SPEED_SET, FORCE_SET and ANGLE_SET from the middle finger on.
    assert_eq!(
        sent,
        [
            (1526, vec![350; 4]),
            (1502, vec![900; 4]),
            (ANGLE_SET + 4, vec![700; 4]),
        ]
    );
    assert_eq!(bench.target(Dof::Index), Some(700));
    assert_eq!(bench.target(Dof::Ring), Some(bench.angle(Dof::Ring)));
}

/// What ends a sequence, and how that is told.
pub(super) type Ending = (fn(&mut Bench), Ended<PlayEnd>);

pub(super) const ENDINGS: [Ending; 6] = [
    (
        |bench| bench.act(Action::Stop),
        Err(Abort::Disarmed {
            why: Some(Disarmed::Stop),
        }),
    ),
    (
        |bench| bench.act(Action::Disarm),
        Err(Abort::Disarmed {
            why: Some(Disarmed::Person),
        }),
    ),
    (
        |bench| {
            bench
                .hand
                .with(|hand, _| hand.inject_fault(Dof::Index, Fault::OverTemperature))
        },
        Err(Abort::Fault { joint: None }),
    ),
    (
        |bench| bench.act(Action::Play(Play::End)),
        Ok(PlayEnd::Person),
    ),
    (
        |bench| bench.act(Action::Target(Dof::Index, Angle::MAX)),
        Err(Abort::TakenOver),
    ),
    (
        |bench| bench.act(Action::Preset(Preset::Open)),
        Err(Abort::TakenOver),
    ),
];

/// A sequence is over in this way, and stays so: no arming later brings it back, nor what happens before it is asked to go on.
pub(super) async fn stays_ended(
    bench: &mut Bench,
    want: Ended<PlayEnd>,
    happens: impl FnOnce(&mut Bench),
) {
    bench.run(3000).await;
    let Some(PlayPhase::Ended(end)) = phase(bench) else {
        panic!("{want:?}: {:?}", phase(bench));
    };
    // Which joint it was is known once it was read.
    let by_fault = matches!(
        (want, end),
        (Err(Abort::Fault { .. }), Err(Abort::Fault { .. }))
    );
    assert!(end == want || by_fault, "{end:?} for {want:?}");
    bench.act(Action::Arm);
    bench.run(300).await;
    bench.forget();
    happens(bench);
    bench.act(Action::Play(Play::Resume));
    bench.run(5000).await;
    assert_eq!(bench.addresses(), [0_u16; 0], "{want:?}");
}

#[tokio::test(start_paused = true)]
async fn whatever_ends_a_sequence_nothing_is_sent_afterwards() {
    for (break_off, want) in ENDINGS {
        let mut bench = Bench::armed().await;
        let (_, own) = library(&mut bench);
        bench.act(Action::Play(Play::Start(EntryId::Sequence(own))));
        bench.run(200).await;
        assert!(bench.hand().running.sequence().unwrap().is_running());
        break_off(&mut bench);
        stays_ended(&mut bench, want, |_| ()).await;
    }
}

#[tokio::test(start_paused = true)]
async fn a_dry_run_sends_nothing_even_while_armed() {
    let mut bench = Bench::armed().await;
    let (_, own) = library(&mut bench);
    bench.act(Action::DryRun(Some(own)));
    assert!(bench.state().poses.preview.is_some());
    bench.run(5000).await;
    bench.act(Action::DryRun(None));
    assert_eq!(bench.addresses(), [0_u16; 0]);
}

fn shipped(name: &str) -> PoseId {
    starter().pose_named(name).unwrap().id
}

#[tokio::test(start_paused = true)]
async fn between_poses_whose_straight_way_crosses_the_thumb_goes_out_first_and_bends_last() {
    let mut bench = Bench::live_without_delay().await;
    bench.arm().await;
    bench.act(Action::Recall(shipped("Pinch")));
    bench.run(6000).await;
    assert_eq!(phase(&bench), Some(PlayPhase::Ended(Ok(PlayEnd::Finished))));
    assert_eq!(angles_told(&bench).len(), 1, "straight from the open hand");
    bench.forget();
    bench.act(Action::Recall(shipped("Fist")));
    bench.run(400).await;
    let run = bench.hand().running.sequence().unwrap();
    assert!(run.is_running() && run.entry == EntryId::Pose(shipped("Fist")));
    bench.run(8000).await;
    assert_eq!(phase(&bench), Some(PlayPhase::Ended(Ok(PlayEnd::Finished))));
    let told = angles_told(&bench);
    assert_eq!(
        told,
        [
            [-1, -1, -1, -1, 800, -1],
            [0, 0, 0, 0, -1, -1],
            [-1, -1, -1, -1, -1, 300],
            [-1, -1, -1, -1, 580, -1],
        ]
    );
    assert!((bench.angle(Dof::ThumbBend) - 580).abs() <= 20);
    bench.forget();
    bench.act(Action::Recall(shipped("Pinch")));
    bench.run(300).await;
    bench.act(Action::Stop);
    bench.run(300).await;
    bench.forget();
    bench.run(8000).await;
    let told = angles_told(&bench);
    assert!(told.is_empty(), "nothing after a stop: {told:?}");
}

#[tokio::test(start_paused = true)]
async fn a_touched_finger_bends_and_goes_back_once_it_is_let_go() {
    let mut bench = Bench::armed().await;
    let reaction = EntryId::Reaction(starter().reactions[0].id);
    bench
        .hand
        .with(|hand, _| hand.set_object(&handscope::sim::object::Object::none()));
    bench.act(Action::Play(Play::Start(reaction)));
    bench.run(4000).await;
    let rest = bench.angle(Dof::Middle);
    assert!((rest - 740).abs() <= 20, "{rest}");
    bench.forget();
    bench.run(3000).await;
    assert!(angles_told(&bench).is_empty(), "nobody touches it");
    bench
        .hand
        .with(|hand, _| hand.press_tip(Finger::Middle, 200.0));
    bench.run(2500).await;
    assert_eq!(angles_told(&bench), [[-1, -1, 250, -1, -1, -1]]);
    assert!((bench.angle(Dof::Middle) - 250).abs() <= 20);
    bench
        .hand
        .with(|hand, _| hand.press_tip(Finger::Middle, 0.0));
    bench.run(3000).await;
    assert!((bench.angle(Dof::Middle) - 740).abs() <= 20);
    assert!(bench.hand().running.sequence().unwrap().is_running());
    bench.act(Action::Stop);
    bench.run(500).await;
    bench.forget();
    bench
        .hand
        .with(|hand, _| hand.press_tip(Finger::Middle, 200.0));
    bench.run(3000).await;
    assert!(angles_told(&bench).is_empty(), "stopped");
}

#[tokio::test(start_paused = true)]
async fn a_copy_of_what_is_shipped_wins_and_deleting_it_brings_the_shipped_one_back() {
    let mut bench = Bench::live().await;
    let ready = |bench: &Bench| {
        let state = bench.state();
        let all = state.poses.ready(&state.settings.hidden_poses);
        let named = |id| state.poses.named(id).unwrap().text.to_owned();
        all.into_iter()
            .map(|id| (named(id), id))
            .collect::<Vec<_>>()
    };
    let count = ready(&bench).len();
    let fist = EntryId::Pose(shipped("Fist"));
    assert!(ready(&bench).contains(&("Fist".into(), fist)));
    bench.act(Action::Library(LibraryEdit::Copy(fist)));
    let own = bench.state().poses.newest.unwrap();
    assert_eq!(ready(&bench)[0], ("Fist".into(), EntryId::Pose(own)));
    assert_eq!(ready(&bench).len(), count, "it stands in the other's place");
    bench.act(Action::Library(LibraryEdit::Pose(own, PoseEdit::Delete)));
    assert!(ready(&bench).contains(&("Fist".into(), fist)));
    bench.act(Action::Library(LibraryEdit::Pose(
        shipped("Fist"),
        PoseEdit::Delete,
    )));
    bench.act(Action::HideShipped("Fist".into(), true));
    assert_eq!(ready(&bench).len(), count - 1);
    bench.act(Action::HideShipped("Fist".into(), false));
    assert_eq!(ready(&bench).len(), count, "never lost");
    let wave = EntryId::Sequence(starter().sequences[1].id);
    bench.act(Action::Library(LibraryEdit::Copy(wave)));
    let copied = &bench.state().poses.library;
    assert_eq!((copied.sequences.len(), copied.poses.len()), (1, 5));
    assert_eq!(bench.addresses(), [0_u16; 0]);
}
