//! What a sequence sends and what ends it, on a hand that only notes what it is told.

use crate::fake::{Asked, FakeHand, Said, WELL};
use crate::hand::gap::{Gap, SizeBlocks};
use crate::hand::grip::GripEstimator;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Angle, ArmEpoch, Dof, Force, HandSample, PerDof, Setpoints, Speed, Target};
use crate::link::Owner;
use crate::motion::drive::Armed;
use crate::motion::play::{PlayCommand, PlayProgress, PlayStart, play};
use crate::motion::program::Ended;
use crate::motion::program::Progress;
use crate::poses::library::{EntryId, SequenceId};
use crate::poses::player::{Cue, PlayEnd, PlayMode, PlayPhase, PlayPlan, PlayView};
use crate::record::{Abort, Disarmed, LinkState};
use futures::stream::poll_fn;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::mpsc;
use tokio::task::JoinHandle;
use tokio::time::sleep;

fn cue(angle: i16) -> Cue {
    Cue {
        targets: PerDof::splat(Some(Angle::nearest(angle))),
        gap: None,
        speed: Speed::nearest(350),
        force: Force::nearest(900),
        dwell: Duration::from_millis(50),
        limit: Duration::from_secs(5),
        until: None,
        thresholds: None,
        hold: None,
    }
}

/// A sequence of two poses that plays, on a hand at 420.
struct Bench {
    hand: FakeHand,
    commands: Option<mpsc::Sender<PlayCommand>>,
    steps: Arc<Mutex<Vec<PlayProgress>>>,
    task: JoinHandle<Ended<PlayEnd>>,
}

impl Bench {
    fn start(pace: PlayMode, locked: PerDof<bool>) -> Self {
        Self::start_with(vec![cue(700), cue(200)], pace, locked)
    }

    fn start_with(cues: Vec<Cue>, pace: PlayMode, locked: PerDof<bool>) -> Self {
        let hand = FakeHand::new();
        hand.arm_as(1);
        let start = PlayStart {
            plan: PlayPlan {
                entry: EntryId::Sequence(SequenceId(1)),
                cues,
                looped: false,
                reaction: None,
            },
            pace,
            locked,
            grip: GripEstimator::default(),
            overshoot: OvershootMap::default(),
            blocks: SizeBlocks::default(),
            force_limit: Force::MAX,
        };
        let armed = Armed {
            epoch: ArmEpoch(1),
            lease: hand.grant(Owner::Task),
            seen: HandSample::default(),
            clock: hand.clock,
        };
        let (commands, mut wanted) = mpsc::channel(4);
        let wanted = poll_fn(move |context| wanted.poll_recv(context));
        let steps = Arc::new(Mutex::new(Vec::new()));
        let (told, link) = (Arc::clone(&steps), hand.clone());
        let task = tokio::spawn(async move {
            let tell = |step| told.lock().unwrap().push(step);
            play(&link, armed, start, wanted, tell).await
        });
        Self {
            hand,
            commands: Some(commands),
            steps,
            task,
        }
    }

    async fn playing() -> Self {
        let bench = Self::start(PlayMode::Through, PerDof::splat(false));
        sleep(Duration::from_millis(1)).await;
        bench.at(600, 1).await;
        bench
    }

    /// The hand is there for so many readings, 10 ms apart.
    async fn at(&self, angle: i16, readings: usize) {
        for _ in 0..readings {
            self.hand.says(Said { angle, ..WELL });
            sleep(Duration::from_millis(10)).await;
        }
    }

    async fn command(&self, command: PlayCommand) {
        let commands = self.commands.as_ref().unwrap();
        commands.send(command).await.unwrap();
        sleep(Duration::from_millis(1)).await;
    }

    fn moves(&self) -> Vec<Setpoints> {
        let asked = self.hand.asked().into_iter();
        let moves = asked.map(|asked| match asked {
            Asked::Move(setpoints) => setpoints,
            other => panic!("{other:?}"),
        });
        moves.collect()
    }

    /// Where the index finger was sent since the last call.
    fn sent(&self) -> Vec<Option<i16>> {
        let moves = self.moves().into_iter();
        moves
            .map(|all| all.angle[Dof::Index].map(Target::raw))
            .collect()
    }

    fn view(&self) -> PlayView {
        let steps = self.steps.lock().unwrap();
        let mut views = steps.iter().rev().filter_map(|step| match step {
            Progress::View(view) => Some(view.play),
            Progress::Sent(_) | Progress::Event(_) => None,
        });
        views.next().unwrap()
    }
}

#[tokio::test(start_paused = true)]
async fn a_grip_by_size_without_one_of_its_joints_ends_and_stays() {
    let mut locked = PerDof::splat(false);
    locked[Dof::ThumbBend] = true;
    let gap = Gap::nearest(30.0);
    let pinch = Cue {
        targets: gap.angles().map(Some),
        gap: Some(gap),
        ..cue(0)
    };
    for (locks, want) in [
        (PerDof::splat(false), None),
        (locked, Some(Ok(PlayEnd::Locked))),
    ] {
        let bench = Bench::start_with(vec![pinch.clone()], PlayMode::Through, locks);
        sleep(Duration::from_millis(1)).await;
        bench.at(1000, 3).await;
        let stays = bench.sent().iter().all(|to| *to == Some(1000));
        assert_eq!(stays, want.is_some(), "{want:?}");
        let ended = match bench.view().phase {
            PlayPhase::Ended(end) => Some(end),
            _ => None,
        };
        assert_eq!(ended, want);
    }
}

#[tokio::test(start_paused = true)]
async fn each_step_is_sent_with_its_own_speed_and_force() {
    let other = Cue {
        speed: Speed::nearest(120),
        force: Force::nearest(300),
        ..cue(200)
    };
    let free = PerDof::splat(false);
    let bench = Bench::start_with(vec![cue(700), other], PlayMode::Through, free);
    sleep(Duration::from_millis(1)).await;
    bench.at(700, 20).await;
    let of = |all: &Setpoints| {
        let dof = Dof::Index;
        (
            all.speed[dof].map(Speed::get),
            all.force[dof].map(Force::get),
        )
    };
    let sent: Vec<_> = bench.moves().iter().map(of).collect();
    assert_eq!(sent, [(Some(350), Some(900)), (Some(120), Some(300))]);
}

#[tokio::test(start_paused = true)]
async fn a_sequence_goes_from_pose_to_pose_and_ends() {
    let locked = PerDof::from_fn(|dof| dof == Dof::ThumbBend);
    let bench = Bench::start(PlayMode::Through, locked);
    sleep(Duration::from_millis(1)).await;
    bench.at(500, 1).await;
    bench.at(690, 3).await;
    let mut wanted = Setpoints::none(ArmEpoch(1));
    for dof in Dof::ALL.into_iter().filter(|dof| !locked[*dof]) {
        wanted.speed[dof] = Some(Speed::nearest(350));
        wanted.force[dof] = Some(Force::nearest(900));
        wanted.angle[dof] = Some(Target::Go(Angle::nearest(700)));
    }
    assert_eq!(bench.moves(), [wanted], "a locked joint is left alone");
    bench.at(690, 10).await;
    assert_eq!(bench.sent(), [Some(200)]);
    bench.at(200, 20).await;
    assert_eq!(bench.task.await.unwrap(), Ok(PlayEnd::Finished));
    assert_eq!(bench.hand.asked(), []);
}

#[tokio::test(start_paused = true)]
async fn whatever_ends_a_sequence_nothing_is_sent_afterwards() {
    type Break = fn(&mut Bench);
    let by = |why| Abort::Disarmed { why: Some(why) };
    let ways: [(Break, Ended<PlayEnd>); 7] = [
        (|bench| drop(bench.hand.stop()), Err(by(Disarmed::Stop))),
        (|bench| bench.hand.disarm(), Err(by(Disarmed::Person))),
        (
            |bench| bench.hand.change(|status| status.state = LinkState::Fault),
            Err(Abort::Fault { joint: None }),
        ),
        (
            |bench| {
                bench
                    .hand
                    .change(|status| status.state = LinkState::Offline)
            },
            Err(Abort::LinkLost),
        ),
        (|bench| bench.hand.arm_as(2), Err(Abort::ArmedAnew)),
        (|bench| drop(bench.commands.take()), Err(Abort::TakenOver)),
        (
            |bench| {
                let commands = bench.commands.as_ref().unwrap();
                commands.try_send(PlayCommand::End).unwrap();
            },
            Ok(PlayEnd::Person),
        ),
    ];
    for (break_off, want) in ways {
        let mut bench = Bench::playing().await;
        break_off(&mut bench);
        sleep(Duration::from_millis(20)).await;
        assert_eq!(bench.view().phase, PlayPhase::Ended(want));
        bench.hand.asked();
        // Even an arming later does not bring it back.
        bench.hand.arm_as(9);
        bench.at(700, 1000).await;
        assert_eq!(bench.hand.asked(), [], "{want:?}");
        assert_eq!(bench.task.await.unwrap(), want);
    }
}

#[tokio::test(start_paused = true)]
async fn whoever_takes_the_turn_ends_a_sequence() {
    let bench = Bench::playing().await;
    bench.hand.asked();
    let _another = bench.hand.grant(Owner::Person);
    bench.at(700, 20).await;
    assert_eq!(bench.hand.asked(), []);
    assert_eq!(bench.task.await.unwrap(), Err(Abort::TakenOver));
}

#[tokio::test(start_paused = true)]
async fn a_pause_holds_and_waits_for_a_person() {
    let bench = Bench::playing().await;
    bench.sent();
    bench.command(PlayCommand::Pause).await;
    assert_eq!(bench.sent(), [Some(600)], "holds where it is");
    bench.at(610, 1000).await;
    assert_eq!(bench.sent(), []);
    assert_eq!(bench.view().phase, PlayPhase::Paused);
    bench.command(PlayCommand::Resume(PlayMode::Through)).await;
    bench.at(610, 1).await;
    assert_eq!(bench.sent(), [Some(700)]);
}

#[tokio::test(start_paused = true)]
async fn nothing_is_sent_by_angles_that_are_old() {
    let bench = Bench::playing().await;
    bench.sent();
    sleep(Duration::from_millis(300)).await;
    bench.command(PlayCommand::Pause).await;
    assert_eq!(bench.sent(), [], "where it is now is not known");
}

#[tokio::test(start_paused = true)]
async fn one_step_pauses_after_one_pose() {
    let bench = Bench::start(PlayMode::OneStep, PerDof::splat(false));
    sleep(Duration::from_millis(1)).await;
    bench.at(690, 50).await;
    assert_eq!(bench.sent(), [Some(700)]);
    assert_eq!(bench.view().phase, PlayPhase::Paused);
}
