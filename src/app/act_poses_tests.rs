//! Proves what poses, sequences and stored gestures send, against a link that only notes what it is told.

#![allow(
    clippy::unwrap_used,
    clippy::indexing_slicing,
    clippy::panic,
    reason = "a test may"
)]

use crate::app::action::{Play, Preset};
use crate::app::fake_link::*;
use crate::app::gestures::Verdict;
use crate::app::notices::NoticeKind;
use crate::app::poses::edit::{LibraryEdit, PoseEdit, SequenceEdit};
use crate::app::poses::library::{Millis, Pose, PoseId, SequenceId};
use crate::app::poses::player::{End, Phase};
use crate::hand::{Angle, Dof, Force, HandCommand, PerDof, Speed, Target, UserGesture};
use crate::link::{LinkEvent, LinkState, Outcome, Request, Ticket};

fn library(bench: &mut Bench) -> (PoseId, SequenceId) {
    let library = &mut bench.desk.state.poses.library;
    let a = library
        .add_pose("A", Pose::at(PerDof::splat(Angle::nearest(700))))
        .unwrap();
    let b = library
        .add_pose("B", Pose::at(PerDof::splat(Angle::nearest(200))))
        .unwrap();
    let own = library.add_sequence("S").unwrap();
    for (at, pose) in [a, b].into_iter().enumerate() {
        library.edit_sequence(own, SequenceEdit::Add(pose));
        library.edit_sequence(own, SequenceEdit::Dwell(at, Millis::nearest(50)));
    }
    (a, own)
}

fn sent_to(told: &[Told]) -> Vec<Option<i16>> {
    let sets = told.iter().map(|told| match told {
        Told::Set(all) => all.angle[Dof::Index].map(Target::raw),
        other => panic!("{other:?}"),
    });
    sets.collect()
}

#[test]
fn a_captured_pose_is_the_one_the_hand_has_and_an_old_one_is_refused() {
    let mut bench = Bench::monitoring(420);
    bench.desk.capture("Pose", bench.now());
    bench.desk.capture("Pose", bench.now());
    let poses = &bench.desk.state.poses;
    let names: Vec<_> = poses
        .library
        .poses
        .iter()
        .map(|pose| pose.name.clone())
        .collect();
    assert_eq!(names, ["Pose", "Pose 2"]);
    assert_eq!(
        poses.library.poses[0].angles,
        PerDof::splat(Angle::nearest(420))
    );
    bench.millis += 300;
    bench.step();
    bench.desk.capture("Pose", bench.now());
    assert_eq!(bench.desk.state.poses.library.poses.len(), 2);
    assert_eq!(bench.notices(), [NoticeKind::PoseUnknown]);
    assert_eq!(bench.told(), [], "capturing sends nothing");
}

#[test]
fn recalling_sends_speed_force_and_angle_of_free_joints_only_and_never_arms() {
    let mut bench = Bench::monitoring(420);
    let (a, own) = library(&mut bench);
    for play in [Play::Start(own), Play::Step(own), Play::Resume, Play::End] {
        bench.desk.play(play, bench.now());
    }
    bench.desk.recall(a);
    bench.desk.try_angles(PerDof::splat(Angle::MAX));
    assert_eq!(bench.told(), []);
    let mut bench = Bench::armed(420);
    let (a, _) = library(&mut bench);
    bench.desk.lock(Dof::Ring, true);
    for edit in [
        PoseEdit::Leave(Dof::Little, true),
        PoseEdit::Speed(Speed::nearest(350)),
        PoseEdit::Force(Force::nearest(900)),
    ] {
        bench.desk.state.poses.edit(LibraryEdit::Pose(a, edit));
    }
    bench.desk.recall(a);
    let want = set(1, |all| {
        for dof in Dof::ALL {
            if !matches!(dof, Dof::Ring | Dof::Little) {
                all.speed[dof] = Some(Speed::nearest(350));
                all.force[dof] = Some(Force::nearest(900));
                all.angle[dof] = Some(Target::Go(Angle::nearest(700)));
            }
        }
    });
    assert_eq!(bench.told(), [want]);
    assert_eq!(bench.target(Dof::Index), Some(700));
    assert_eq!(bench.target(Dof::Ring), Some(420));
}

#[test]
fn a_sequence_goes_from_pose_to_pose_and_ends() {
    let mut bench = Bench::armed(420);
    let (_, own) = library(&mut bench);
    bench.desk.lock(Dof::ThumbBend, true);
    bench.desk.play(Play::Start(own), bench.now());
    for angle in [500, 690, 690, 690] {
        bench.angles(angle);
        bench.step();
    }
    assert_eq!(sent_to(&bench.told()), [Some(700)]);
    for _ in 0..10 {
        bench.angles(690);
        bench.step();
    }
    assert_eq!(sent_to(&bench.told()), [Some(200)]);
    for _ in 0..20 {
        bench.angles(200);
        bench.step();
    }
    let run = bench.desk.state.poses.run.as_ref().unwrap();
    assert_eq!(run.player.phase(), Phase::Ended(End::Finished));
    assert_eq!(bench.told(), []);
}

#[test]
fn whatever_ends_a_sequence_nothing_is_sent_afterwards() {
    type Break = fn(&mut Bench);
    let ways: [(Break, End); 6] = [
        (|bench| bench.desk.stop(bench.now()), End::Disarmed),
        (|bench| bench.desk.disarm(bench.now()), End::Disarmed),
        (|bench| bench.state(LinkState::Fault), End::Fault),
        (|bench| bench.state(LinkState::Offline), End::LinkLost),
        (|bench| bench.epoch(2), End::Disarmed),
        (
            |bench| bench.desk.target(Dof::Index, Angle::MAX),
            End::TakenOver,
        ),
    ];
    for (break_off, want) in ways {
        let mut bench = Bench::armed(420);
        let (_, own) = library(&mut bench);
        bench.desk.play(Play::Start(own), bench.now());
        bench.angles(600);
        bench.step();
        break_off(&mut bench);
        bench.step();
        let run = bench.desk.state.poses.run.clone().unwrap();
        assert_eq!(run.player.phase(), Phase::Ended(want));
        bench.told();
        // Even an arming later does not bring it back.
        bench.epoch(9);
        for _ in 0..1000 {
            bench.angles(700);
            bench.step();
        }
        bench.desk.play(Play::Resume, bench.now());
        bench.step();
        assert_eq!(bench.told(), [], "{want:?}");
    }
}

#[test]
fn a_pause_holds_and_waits_for_a_person() {
    let mut bench = Bench::armed(420);
    let (_, own) = library(&mut bench);
    bench.desk.play(Play::Start(own), bench.now());
    bench.angles(600);
    bench.step();
    bench.told();
    bench.desk.play(Play::Pause, bench.now());
    assert_eq!(sent_to(&bench.told()), [Some(600)], "holds where it is");
    for _ in 0..1000 {
        bench.angles(610);
        bench.step();
    }
    assert_eq!(bench.told(), []);
    bench.desk.play(Play::Resume, bench.now());
    bench.step();
    assert_eq!(sent_to(&bench.told()), [Some(700)]);
    bench.desk.preset(Preset::Open);
    let run = bench.desk.state.poses.run.as_ref().unwrap();
    assert_eq!(run.player.phase(), Phase::Ended(End::TakenOver));
}

#[test]
fn a_dry_run_sends_nothing_even_while_armed() {
    let mut bench = Bench::armed(420);
    let (_, own) = library(&mut bench);
    bench.desk.play(Play::Dry(own), bench.now());
    assert!(bench.desk.state.poses.preview.is_some());
    for _ in 0..1000 {
        bench.angles(420);
        bench.step();
    }
    bench.desk.play(Play::EndDry, bench.now());
    assert_eq!(bench.told(), []);
}

#[test]
fn a_stored_gesture_is_written_read_back_and_judged() {
    let gesture = UserGesture::nearest(14);
    let angles = PerDof::splat(Angle::nearest(300));
    for (got, want) in [(300_i16, Verdict::Same), (0, Verdict::Differs)] {
        let mut bench = Bench::monitoring(420);
        bench.desk.store_gesture(gesture, angles, bench.now());
        let write = Request::Command(HandCommand::StoreGesture(gesture, angles));
        assert_eq!(bench.told(), [Told::Ask(write)]);
        let done = |outcome| LinkEvent::Done {
            ticket: Ticket(7),
            result: Ok(outcome),
        };
        let event = done(Outcome::Acknowledged);
        bench.wire.borrow_mut().events.push_back(event);
        bench.step();
        let span = crate::hand::command::stored_gesture(gesture);
        assert_eq!(bench.told(), [Told::Ask(Request::Read(span))]);
        let verdict = |bench: &Bench| bench.desk.state.gestures.upload.unwrap().verdict;
        assert_eq!(verdict(&bench), Verdict::ReadingBack);
        let bytes = got.to_le_bytes().repeat(6);
        let event = done(Outcome::Memory { span, bytes });
        bench.wire.borrow_mut().events.push_back(event);
        bench.step();
        assert_eq!(verdict(&bench), want);
    }
}

#[test]
fn a_gesture_is_neither_stored_nor_read_while_that_is_off() {
    let mut bench = Bench::monitoring(420);
    bench.desk.state.settings.gesture_store = crate::hand::GestureStore::Off;
    let gesture = UserGesture::nearest(14);
    bench
        .desk
        .store_gesture(gesture, PerDof::splat(Angle::MAX), bench.now());
    bench.desk.read_gesture(gesture, bench.now());
    assert_eq!(bench.told(), []);
    assert!(bench.desk.state.gestures.upload.is_none());
    let told = bench
        .desk
        .state
        .notices
        .iter()
        .next()
        .map(|notice| (notice.what.clone(), notice.count));
    assert_eq!(told, Some((NoticeKind::GestureStoreOff, 2)));
}
