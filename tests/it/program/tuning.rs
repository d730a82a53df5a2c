//! Series of trials in the window: what they need, and what ends them.

use crate::program::{Bench, spoil};
use crate::setup::line::Trouble;
use crate::setup::window::{FORCE_SET, SPEED_SET};
use handscope::app::action::Action;
use handscope::app::notices::NoticeKind;
use handscope::app::trials::{SeriesKind, SessionOrigin, StartRefusal, TrialAction};
use handscope::hand::{Angle, Dof, Force, Speed};
use handscope::poses::Preset;
use handscope::record::Abort;
use handscope::record::Disarmed;
use handscope::trials::plan::TrialPlan;
use handscope::trials::session::load;
use handscope::trials::summary::EarlyEnd;
use std::path::{Path, PathBuf};
use tokio::time::Duration;

fn start(bench: &mut Bench) {
    bench.act(Action::Trial(TrialAction::Start(SeriesKind::Grid)));
}

/// A series that runs.
async fn running() -> Bench {
    let mut bench = Bench::armed().await;
    start(&mut bench);
    bench.run(300).await;
    assert!(bench.hand().running.series().is_some());
    bench
}

fn refusal(bench: &Bench) -> Option<StartRefusal> {
    bench
        .hand()
        .series_refusal(Some(&bench.state().trials.plan))
}

#[tokio::test(start_paused = true)]
async fn a_series_needs_an_arming_and_free_joints() {
    let mut bench = Bench::live().await;
    start(&mut bench);
    assert_eq!(refusal(&bench), Some(StartRefusal::NotArmed));
    assert!(bench.state().trials.sessions.is_empty());
    bench.run(300).await;
    assert_eq!(
        bench.addresses(),
        [0_u16; 0],
        "writing a plan and asking sends nothing"
    );
    bench.arm().await;
    bench.act(Action::Lock(Dof::Index, true));
    bench.run(100).await;
    bench.forget();
    start(&mut bench);
    assert_eq!(refusal(&bench), Some(StartRefusal::Locked(Dof::Index)));
    bench.run(300).await;
    assert_eq!(bench.addresses(), [0_u16; 0]);
}

#[tokio::test(start_paused = true)]
async fn what_starts_in_an_arming_arms_nothing_where_there_is_none() {
    for kind in [SeriesKind::Search, SeriesKind::Grid] {
        let mut bench = Bench::live().await;
        bench.act(Action::Trial(TrialAction::Start(kind)));
        bench.run(1000).await;
        assert!(!bench.hand().connection.is_armed(), "{kind:?}");
        assert!(bench.hand().running.series().is_none() && !bench.hand().running.awaits_arming());
        assert_eq!(bench.addresses(), [0_u16; 0], "{kind:?}");
    }
}

fn arm_and_start(bench: &mut Bench) {
    bench.act(Action::Trial(TrialAction::ArmAndStart(SeriesKind::Grid)));
}

#[tokio::test(start_paused = true)]
async fn one_act_arms_and_starts_once_the_arming_holds() {
    let mut bench = Bench::live().await;
    bench.act(Action::Speed(None, Speed::GENTLE));
    bench.act(Action::Force(None, Force::GENTLE));
    arm_and_start(&mut bench);
    assert!(bench.hand().running.series().is_none() && bench.hand().running.awaits_arming());
    bench.run(300).await;
    assert!(bench.hand().running.series().is_some() && !bench.hand().running.awaits_arming());
    let addresses = bench.addresses();
    let limits = addresses.iter().take(2).copied().collect::<Vec<u16>>();
    assert_eq!(
        limits,
        [SPEED_SET, FORCE_SET],
        "arming goes first: {addresses:?}"
    );
}

#[tokio::test(start_paused = true)]
async fn what_ends_the_wish_to_start_leaves_the_hand_at_rest() {
    type End = fn(&mut Bench);
    let ends: [(&str, End); 3] = [
        ("stop", |bench| bench.act(Action::Stop)),
        ("disarm", |bench| bench.act(Action::Disarm)),
        ("other plan", |bench| {
            let mut other = TrialPlan::default();
            other.grid.repeats = 3;
            bench.act(Action::Trial(TrialAction::Plan(Box::new(other))));
        }),
    ];
    for (why, end) in ends {
        let mut bench = Bench::live().await;
        arm_and_start(&mut bench);
        end(&mut bench);
        bench.run(3000).await;
        assert!(bench.hand().running.series().is_none(), "{why}");
        assert!(!bench.hand().running.awaits_arming(), "{why}");
        assert!(bench.state().trials.sessions.is_empty(), "{why}");
        let is_told = bench.told().contains(&NoticeKind::SeriesNotBegun);
        assert_eq!(is_told, why == "other plan", "{why}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_window_that_hung_since_starts_nothing_late() {
    let mut bench = Bench::live().await;
    arm_and_start(&mut bench);
    bench.hang(3000).await;
    bench.run(500).await;
    assert!(bench.hand().running.series().is_none() && !bench.hand().running.awaits_arming());
    assert!(bench.told().contains(&NoticeKind::SeriesNotBegun));
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_cannot_be_armed_begins_nothing_and_says_why() {
    let mut bench = Bench::live().await;
    bench.act(Action::Lock(Dof::Index, true));
    bench.forget();
    arm_and_start(&mut bench);
    bench.run(3000).await;
    assert!(
        !bench.hand().connection.is_armed(),
        "a locked joint would move"
    );
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    spoil(&line, Trouble::Gone(Duration::from_secs(5)));
    bench.run(300).await;
    arm_and_start(&mut bench);
    bench.run(8000).await;
    assert!(bench.hand().running.series().is_none() && !bench.hand().connection.is_armed());
    assert!(!bench.hand().running.awaits_arming());
    let why = |told: &NoticeKind| matches!(told, NoticeKind::ArmRefused(_));
    let told = bench.told();
    assert!(told.iter().any(why) || told.contains(&NoticeKind::SeriesNotBegun));
}

#[tokio::test(start_paused = true)]
async fn a_plan_that_makes_no_sense_sends_nothing() {
    let mut bench = Bench::armed().await;
    let mut senseless = TrialPlan::default();
    senseless.grid.speeds = vec![Speed::MIN];
    bench.act(Action::Trial(TrialAction::Plan(Box::new(senseless))));
    start(&mut bench);
    arm_and_start(&mut bench);
    bench.run(300).await;
    assert!(bench.hand().running.series().is_none() && !bench.hand().running.awaits_arming());
    assert_eq!(bench.addresses(), [0_u16; 0]);
}

#[tokio::test(start_paused = true)]
async fn nothing_else_moves_the_hand_while_a_series_runs() {
    let mut bench = running().await;
    bench.run(500).await;
    let others = |bench: &Bench| -> Vec<i16> {
        let dofs = Dof::ALL.into_iter().filter(|dof| *dof != Dof::Index);
        dofs.map(|dof| bench.angle(dof)).collect()
    };
    let before = others(&bench);
    for action in [
        Action::Target(Dof::Ring, Angle::MIN),
        Action::Preset(Preset::Close),
        Action::Speed(Some(Dof::Index), Speed::MAX),
    ] {
        bench.act(action);
    }
    bench.run(1000).await;
    assert!(bench.hand().running.series().is_some());
    assert!(bench.told().contains(&NoticeKind::SeriesRuns));
    for (now, before) in others(&bench).iter().zip(before) {
        assert!((now - before).abs() <= 3);
    }
    assert_ne!(
        bench.hand().controls.joints[Dof::Index].speed,
        Some(Speed::MAX)
    );
}

#[tokio::test(start_paused = true)]
async fn a_stop_a_disarming_a_lost_link_and_another_hand_end_a_series() {
    type Break = fn(&mut Bench);
    let ways: [(Break, Abort); 3] = [
        (|bench| bench.act(Action::Stop), Abort::Person),
        (
            |bench| bench.act(Action::Disarm),
            Abort::Disarmed {
                why: Some(Disarmed::Person),
            },
        ),
        (|bench| bench.act(Action::Disconnect), Abort::LinkLost),
    ];
    for (break_off, why) in ways {
        let mut bench = running().await;
        break_off(&mut bench);
        bench.run(5000).await;
        check_ended(&bench, why);
        bench.forget();
        bench.run(3000).await;
        assert_eq!(bench.addresses(), [0_u16; 0], "{why:?}");
    }
    let (mut bench, line) = Bench::on_line("rs485:x", 0).await;
    bench.arm().await;
    start(&mut bench);
    bench.run(300).await;
    spoil(&line, Trouble::Gone(Duration::from_secs(5)));
    // A stop stays pending for three seconds.
    bench.run(5000).await;
    check_ended(&bench, Abort::LinkLost);
}

fn check_ended(bench: &Bench, why: Abort) {
    let trials = &bench.state().trials;
    assert!(bench.hand().running.series().is_none() && !bench.hand().connection.is_armed());
    let [session] = &trials.sessions[..] else {
        panic!("{why:?}");
    };
    // A hand that is left is stopped by a person first.
    let by_stop =
        why == Abort::LinkLost && session.head.aborted == Some(EarlyEnd::Here(Abort::Person));
    assert!(
        session.head.aborted == Some(EarlyEnd::Here(why)) || by_stop,
        "{why:?}: {:?}",
        session.head.aborted
    );
    assert_eq!(trials.running, None);
}

/// The folder that the newest session was saved to, once it is there.
async fn saved(bench: &mut Bench) -> PathBuf {
    for _ in 0..500 {
        let session = bench.state().trials.sessions.last().unwrap();
        if let SessionOrigin::Saved(folder) = &session.origin {
            return folder.clone();
        }
        bench.run(20).await;
    }
    panic!("{:?}", bench.told());
}

#[tokio::test(start_paused = true)]
async fn what_was_tried_is_saved_by_itself_in_a_folder_of_the_day_with_its_words() {
    let mut places = Vec::new();
    let mut bench = running().await;
    for _ in 0..2 {
        while bench.hand().running.series().is_some() {
            bench.run(200).await;
        }
        let folder = saved(&mut bench).await;
        let id = bench.state().trials.sessions.last().unwrap().id;
        bench.act(Action::Trial(TrialAction::Note(id, "an egg".into())));
        let head = |folder: &Path| load(folder).unwrap().head;
        for _ in 0..500 {
            if head(&folder).note == "an egg" {
                break;
            }
            bench.run(20).await;
        }
        let day = folder.parent().unwrap();
        let own = head(&folder);
        assert_eq!((&*own.note, own.aborted), ("an egg", None));
        assert!(day.ends_with(format!("documents/Handscope/{}", own.day)));
        assert!(folder.join("trial-001.csv").is_file() && folder.join("report.html").is_file());
        places.push(folder);
        bench.arm().await;
        start(&mut bench);
        bench.run(300).await;
    }
    assert_ne!(places[0], places[1]);
}

#[tokio::test(start_paused = true)]
async fn a_window_that_closes_ends_the_series_and_saves_what_was_tried() {
    let mut bench = running().await;
    bench.run(12_000).await;
    assert!(
        bench.hand().running.series().is_some()
            && bench.state().trials.sessions[0].trials.is_empty()
    );
    while !bench.app.close(bench.clock.now()) {
        bench.run(20).await;
    }
    let session = &bench.state().trials.sessions[0];
    assert_eq!(session.head.aborted, Some(EarlyEnd::Here(Abort::Person)));
    let SessionOrigin::Saved(folder) = &session.origin else {
        panic!("{:?}", bench.told());
    };
    assert_eq!(load(folder).unwrap().trials.len(), session.trials.len());
}

#[tokio::test(start_paused = true)]
async fn where_nothing_can_be_written_it_is_said_and_the_session_stays() {
    let mut bench = running().await;
    bench.block_documents();
    while bench.hand().running.series().is_some() {
        bench.run(200).await;
    }
    for _ in 0..500 {
        if bench.state().trials.refused.is_some() {
            break;
        }
        bench.run(20).await;
    }
    let trials = &bench.state().trials;
    assert!(matches!(trials.refused, Some(NoticeKind::NotSaved { .. })));
    assert_eq!(trials.sessions[0].origin, SessionOrigin::Unsaved);
}

#[tokio::test(start_paused = true)]
async fn note_and_tags_stay_with_their_session() {
    let mut bench = running().await;
    // Nothing can be saved by itself.
    bench.block_documents();
    let id = bench.state().trials.running.unwrap();
    let session = |bench: &Bench| bench.state().trials.session(id).cloned();
    bench.act(Action::Trial(TrialAction::Note(id, "an egg".into())));
    bench.act(Action::Trial(TrialAction::Tags(id, " egg, raw ,".into())));
    let head = session(&bench).unwrap().head;
    assert_eq!(head.note, "an egg");
    assert_eq!(head.tags, ["egg", "raw"]);
    bench.act(Action::Trial(TrialAction::Forget(id)));
    assert_eq!(bench.state().trials.to_confirm, None);
    assert!(session(&bench).is_some(), "what runs is not forgotten");
    bench.act(Action::Stop);
    bench.run(2000).await;
    for (answer, is_left) in [
        (TrialAction::CancelForget, true),
        (TrialAction::ConfirmForget, false),
    ] {
        bench.act(Action::Trial(TrialAction::Forget(id)));
        assert_eq!(bench.state().trials.to_confirm, Some(id));
        bench.act(Action::Trial(answer));
        assert_eq!(session(&bench).is_some(), is_left);
        assert_eq!(bench.state().trials.to_confirm, None);
    }
    assert_eq!(bench.state().trials.plan, TrialPlan::default());
}
