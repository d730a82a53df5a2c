//! Holds as steps of a sequence, on a simulated hand in virtual time.

use crate::hand::gap::{Block, Gap, SizeBlocks};
use crate::hand::grip::{GripEstimator, GripState, Tightened};
use crate::hand::overshoot::OvershootMap;
use crate::hand::{Angle, ArmEpoch, Dof, Force, PerDof, Setpoints, Speed};
use crate::link::LinkStatus;
use crate::motion::hold::{self, HoldPhase};
use crate::motion::play::{PlayCommand, PlayStart, Playing, PlayingView};
use crate::motion::program::{Ended, Order, Program, Seen};
use crate::motion::tests::hold::{Hand, ball, forces, pulled_ball};
use crate::poses::library::{EntryId, SequenceId};
use crate::poses::player::{Cue, PlayEnd, PlayMode, PlayPhase, PlayPlan};
use crate::record::LinkState;
use crate::sim::{Object, Obstacle, SimConfig};
use std::time::Duration;

const EPOCH: ArmEpoch = ArmEpoch(1);
const HELD_FOR: Duration = Duration::from_secs(4);
/// A test that runs longer has failed.
const LONGEST: Duration = Duration::from_secs(60);

/// A step to this angle of the fingers and the bend of the thumb.
fn to(angle: i16) -> Cue {
    let fingers = |dof: Dof| (dof != Dof::ThumbRotate).then_some(Angle::nearest(angle));
    Cue {
        targets: PerDof::from_fn(fingers),
        gap: None,
        speed: Speed::nearest(200),
        force: Force::nearest(300),
        dwell: Duration::from_millis(100),
        limit: Duration::from_secs(6),
        until: None,
        thresholds: None,
        hold: None,
    }
}

/// The same, which ends in a hold.
fn held(cue: Cue) -> Cue {
    Cue {
        dwell: HELD_FOR,
        hold: Some(forces()),
        ..cue
    }
}

fn hand_with(object: Object) -> Hand {
    Hand::new(SimConfig {
        object: Some(object),
        ..SimConfig::default()
    })
}

/// These steps, played once on a hand of which nothing was measured.
fn start(cues: Vec<Cue>) -> PlayStart {
    PlayStart {
        plan: PlayPlan {
            entry: EntryId::Sequence(SequenceId(1)),
            cues,
            looped: false,
            reaction: None,
        },
        pace: PlayMode::Through,
        locked: PerDof::splat(false),
        grip: GripEstimator::default(),
        overshoot: OvershootMap::default(),
        blocks: SizeBlocks::default(),
        force_limit: Force::MAX,
    }
}

/// A sequence that plays on a simulated hand.
struct Bench {
    hand: Hand,
    program: Playing,
    status: LinkStatus,
    sent: Vec<Setpoints>,
    phases: Vec<PlayPhase>,
    tightened: Vec<Tightened>,
}

impl Bench {
    fn of(hand: Hand, cues: Vec<Cue>, grip: GripEstimator) -> Self {
        Self::limited(hand, cues, grip, Force::MAX)
    }

    fn limited(hand: Hand, cues: Vec<Cue>, grip: GripEstimator, force_limit: Force) -> Self {
        let start = PlayStart {
            grip,
            force_limit,
            ..start(cues)
        };
        Self::starting(hand, start)
    }

    fn starting(hand: Hand, start: PlayStart) -> Self {
        Self {
            program: Playing::new(EPOCH, start, hand.now),
            hand,
            status: LinkStatus {
                state: LinkState::Armed,
                armed: Some(EPOCH),
                ..LinkStatus::default()
            },
            sent: Vec::new(),
            phases: Vec::new(),
            tightened: Vec::new(),
        }
    }

    fn view(&self) -> PlayingView {
        self.program.view(self.hand.now)
    }

    fn order(&mut self, order: Option<Order>) {
        match order {
            None => {}
            Some(Order::Set(setpoints)) => {
                self.hand.set(&setpoints);
                if !setpoints.is_empty() {
                    self.sent.push(setpoints);
                }
            }
            Some(other) => panic!("control stays with the sequence: {other:?}"),
        }
    }

    fn command(&mut self, command: PlayCommand) {
        let seen = Seen {
            status: &self.status,
            sample: &self.hand.sample,
            stall: None,
            now: self.hand.now,
        };
        let order = self.program.input(command, &seen);
        self.order(order);
    }

    fn step(&mut self) {
        let program = &mut self.program;
        self.hand
            .step(|sample, fresh, now| program.read(sample, fresh, now));
        let seen = Seen {
            status: &self.status,
            sample: &self.hand.sample,
            stall: None,
            now: self.hand.now,
        };
        let order = self.program.tick(&seen);
        self.order(order);
        self.tightened
            .extend(std::iter::from_fn(|| self.program.event()));
        let phase = self.view().play.phase;
        if self.phases.last() != Some(&phase) {
            self.phases.push(phase);
        }
    }

    fn run_for(&mut self, duration: Duration) {
        let end = self.hand.now.plus(duration);
        while self.hand.now < end {
            self.step();
        }
    }

    fn run_until(&mut self, is_reached: impl Fn(&Self) -> bool) {
        let end = self.hand.now.plus(LONGEST);
        while !is_reached(self) {
            assert!(self.hand.now < end, "{:?}", self.view());
            self.step();
        }
    }

    fn run_until_held(&mut self) {
        self.run_until(|own| {
            let hold = own.view().hold;
            hold.is_some_and(|hold| hold.phase == HoldPhase::Holding)
        });
    }

    fn run_to_end(&mut self) -> Ended<PlayEnd> {
        self.run_until(|own| own.program.ended().is_some());
        self.program.ended().unwrap()
    }

    fn carries(&self) -> bool {
        self.hand.sim.held().held
    }
}

#[test]
fn a_step_that_ends_in_a_hold_closes_holds_for_its_time_and_the_next_step_opens() {
    let cues = vec![held(to(100)), to(1000)];
    let mut bench = Bench::of(hand_with(pulled_ball()), cues, GripEstimator::default());
    assert_eq!(bench.program.rates(), None);
    bench.run_until_held();
    assert_eq!(bench.program.rates(), Some(hold::RATES));
    let begun = bench.hand.now;
    bench.run_until(|own| own.view().play.at == 1);
    assert!(bench.hand.now.since(begun) >= HELD_FOR);
    assert!(bench.carries(), "it was held until then");
    assert!(!bench.tightened.is_empty(), "the pull is felt");
    assert_eq!(bench.run_to_end(), Ok(PlayEnd::Finished));
    assert!(!bench.carries());
    assert_eq!((bench.view().hold, bench.program.rates()), (None, None));
    let holds = bench.phases.iter();
    let holds = holds.filter(|phase| matches!(phase, PlayPhase::Holding { .. }));
    assert_eq!(holds.count(), 1, "{:?}", bench.phases);
}

#[test]
fn a_step_without_targets_takes_over_what_is_held() {
    let mut hand = hand_with(ball(10.0));
    let grip = hand.close(200);
    let nothing = Cue {
        targets: PerDof::splat(None),
        ..to(0)
    };
    let mut bench = Bench::of(hand, vec![held(nothing)], grip);
    assert_eq!(bench.run_to_end(), Ok(PlayEnd::Finished));
    assert!(bench.carries(), "the hand keeps it");
}

#[test]
fn a_hold_of_nothing_ends_the_sequence_and_the_next_step_does_not_follow() {
    let cues = vec![held(to(700)), to(1000)];
    let mut bench = Bench::of(hand_with(Object::none()), cues, GripEstimator::default());
    let end = bench.run_to_end();
    assert!(matches!(end, Ok(PlayEnd::NotHolding(_))), "{end:?}");
    assert_eq!(bench.view().play.at, 0);
    let last = bench.sent.last().unwrap();
    let at = bench.hand.sample.angle.unwrap().value[Dof::Index].raw();
    let target = last.angle[Dof::Index].unwrap().raw();
    assert!(target.abs_diff(at) <= 3, "it stays: {target} at {at}");
}

#[test]
fn an_object_that_is_taken_away_ends_the_sequence() {
    let mut object = ball(10.0);
    object.loads.taken_away_at_s = Some(2.0);
    let cues = vec![Cue {
        dwell: Duration::MAX,
        ..held(to(100))
    }];
    let mut bench = Bench::of(hand_with(object), cues, GripEstimator::default());
    let end = bench.run_to_end();
    let Ok(PlayEnd::NotHolding(grip)) = end else {
        panic!("{end:?}");
    };
    assert_ne!(grip, GripState::Holding);
}

#[test]
fn pause_and_end_keep_position_and_thresholds_of_a_hold_and_stop_one_that_closes() {
    for command in [PlayCommand::Pause, PlayCommand::End] {
        let cues = || vec![held(to(100))];
        let mut bench = Bench::of(hand_with(ball(10.0)), cues(), GripEstimator::default());
        bench.run_until_held();
        bench.run_for(Duration::from_secs(2));
        let sent = bench.sent.len();
        bench.command(command);
        bench.run_for(Duration::from_secs(2));
        assert_eq!(bench.sent.len(), sent, "{command:?}");
        assert!(bench.carries());
        let mut bench = Bench::of(hand_with(Object::none()), cues(), GripEstimator::default());
        let closes = |own: &Bench| own.view().hold.map(|hold| hold.phase);
        bench.run_until(|own| closes(own) == Some(HoldPhase::Closing));
        bench.run_for(Duration::from_secs(1));
        bench.command(command);
        bench.run_for(Duration::from_millis(500));
        let at = bench.hand.sim.true_angles()[Dof::Index];
        bench.run_for(Duration::from_secs(1));
        let later = bench.hand.sim.true_angles()[Dof::Index];
        assert!((at - later).abs() < 1.0, "{command:?}: {at} {later}");
    }
}

#[test]
fn a_resumed_hold_takes_over_what_is_held_for_its_whole_time() {
    let mut bench = Bench::of(
        hand_with(ball(10.0)),
        vec![held(to(100))],
        GripEstimator::default(),
    );
    bench.run_until_held();
    bench.run_for(Duration::from_secs(2));
    bench.command(PlayCommand::Pause);
    bench.run_for(Duration::from_secs(1));
    bench.command(PlayCommand::Resume(PlayMode::Through));
    let resumed = bench.hand.now;
    assert_eq!(bench.run_to_end(), Ok(PlayEnd::Finished));
    assert!(bench.hand.now.since(resumed) >= HELD_FOR);
    assert!(bench.carries());
}

#[test]
fn no_speed_or_threshold_of_a_hold_is_above_the_limits() {
    let cues = vec![Cue {
        speed: Speed::nearest(20),
        ..held(to(500))
    }];
    let limit = Force::nearest(350);
    let mut bench = Bench::limited(hand_with(ball(10.0)), cues, GripEstimator::default(), limit);
    bench.run_until_held();
    bench.run_for(Duration::from_secs(2));
    assert!(!bench.sent.is_empty());
    for setpoints in &bench.sent {
        for dof in Dof::ALL {
            assert!(setpoints.speed[dof].is_none_or(|speed| speed.get() <= 20));
            assert!(setpoints.force[dof].is_none_or(|force| force <= limit));
        }
    }
}

#[test]
fn a_joint_that_is_locked_meanwhile_receives_nothing_of_the_hold() {
    let mut bench = Bench::of(
        hand_with(pulled_ball()),
        vec![held(to(100))],
        GripEstimator::default(),
    );
    bench.run_until_held();
    let mut locked = PerDof::splat(false);
    locked[Dof::Ring] = true;
    bench.command(PlayCommand::Lock(locked));
    let sent = bench.sent.len();
    bench.run_to_end().unwrap();
    let later = &bench.sent[sent..];
    assert!(!later.is_empty());
    assert!(later.iter().all(|own| own.angle[Dof::Ring].is_none()));
}

#[test]
fn the_size_of_what_a_step_holds_is_corrected_by_the_blocks_of_the_hand() {
    let size_mm = |blocks: SizeBlocks| {
        let contacts = Object::contacts_of_size(40.0, Obstacle::at(0.0, 10.0));
        let pinches = |dof: Dof| matches!(dof, Dof::Index | Dof::ThumbBend);
        let mut object = ball(10.0);
        object.contacts = PerDof::from_fn(|dof| contacts[dof].filter(|_| pinches(dof)));
        let pinch = Cue {
            gap: Some(Gap::MIN),
            ..held(to(100))
        };
        let start = PlayStart {
            blocks,
            ..start(vec![pinch])
        };
        let mut bench = Bench::starting(hand_with(object), start);
        bench.run_until_held();
        bench.run_for(Duration::from_secs(2));
        let object = bench.view().hold.unwrap().object.unwrap();
        object.size_mm.unwrap().value
    };
    let mut blocks = SizeBlocks::default();
    for (size_mm, gap_mm) in [(22.0, 20.0), (72.0, 70.0)] {
        blocks.measure(Block { size_mm, gap_mm }).unwrap();
    }
    let (by_model, by_blocks) = (size_mm(SizeBlocks::default()), size_mm(blocks));
    assert!(
        (by_blocks - by_model - 2.0).abs() < 0.1,
        "{by_model} {by_blocks}"
    );
}
