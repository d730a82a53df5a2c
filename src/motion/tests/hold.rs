//! What a hold sends and how it ends, on a simulated hand in virtual time.

use crate::hand::gap::{Gap, SizeBlocks};
use crate::hand::grip::{GripEstimator, TightenCause};
use crate::hand::hold_forces::{HoldForces, NoRoom};
use crate::hand::overshoot::OvershootMap;
use crate::hand::register::{ANGLE_SET, FORCE_SET, SPEED_SET};
use crate::hand::{
    Angle, ArmEpoch, Dof, Finger, Force, ForceReading, Group, Groups, HandCommand, HandSample,
    Moment, PerDof, PerFinger, Reply, Setpoints, Target,
};
use crate::link::LinkStatus;
use crate::motion::hold::{HoldClose, HoldEnd, HoldPhase, HoldRun, HoldStart};
use crate::motion::program::{Order, Program, Seen};
use crate::record::{Abort, LinkState};
use crate::sim::object::{Friction, Loads, NamedObject, PullLoad, listed};
use crate::sim::personality::ForceCompared;
use crate::sim::{Object, Obstacle, Scenario, SimConfig, SimHand};
use std::time::Duration;

pub(super) const EPOCH: ArmEpoch = ArmEpoch(1);
const STEP: Duration = Duration::from_millis(5);
const AT_LEAST_G: i16 = 150;
const AT_MOST_G: i16 = 400;
/// Angle at which the fingers touch the object: near the open hand, so that the slow close is short.
const TOUCHES_AT: f64 = 850.0;
/// A test that runs longer has failed.
const LONGEST: Duration = Duration::from_secs(60);

/// An order, and the hand as it was read then.
#[derive(Debug, Clone, Copy)]
struct Sent {
    at: Moment,
    order: Order,
    angles: PerDof<i16>,
    phase: HoldPhase,
}

impl Sent {
    fn setpoints(&self) -> Option<Setpoints> {
        match self.order {
            Order::Set(setpoints) => Some(setpoints),
            _ => None,
        }
    }
}

/// A simulated hand that is read as a session reads it.
pub(super) struct Hand {
    pub(super) sim: SimHand,
    pub(super) sample: HandSample,
    pub(super) now: Moment,
    steps: u64,
}

impl Hand {
    pub(super) fn new(config: SimConfig) -> Self {
        Self {
            sim: SimHand::new(SimConfig {
                scenario: Scenario::Free,
                ..config
            }),
            sample: HandSample::default(),
            now: Moment::ZERO.plus(Duration::from_millis(10)),
            steps: 0,
        }
    }

    /// One step of time; each reading goes to `reader`.
    pub(super) fn step(&mut self, mut reader: impl FnMut(&HandSample, Groups, Moment)) {
        self.now = self.now.plus(STEP);
        self.steps += 1;
        let mut groups = Vec::new();
        if self.steps.is_multiple_of(2) {
            groups.extend([Group::Angle, Group::Force, Group::Current, Group::Status]);
        }
        if self.steps % 3 == 1 {
            groups.extend(Finger::ALL.map(Group::Tactile));
        }
        if self.steps % 40 == 1 {
            groups.extend([Group::Temperature, Group::Faults]);
        }
        for group in groups {
            let span = group.span();
            let bytes = self.sim.read(span, self.now).unwrap();
            let fresh = self.sample.apply(&Reply {
                span,
                bytes: &bytes,
                asked: self.now,
                received: self.now,
            });
            reader(&self.sample, fresh, self.now);
        }
    }

    fn write(&mut self, address: u16, values: PerDof<i16>) {
        let values = values.as_array().iter();
        let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
        self.sim.write(address, &bytes, self.now).unwrap();
    }

    /// Setpoints reach it.
    pub(super) fn set(&mut self, setpoints: &Setpoints) {
        for write in setpoints.commands().iter().flat_map(HandCommand::writes) {
            let address = write.span().address;
            self.sim.write(address, write.bytes(), self.now).unwrap();
        }
    }

    /// The user closes it before a hold begins; returns the grip estimate.
    pub(super) fn close(&mut self, force_g: i16) -> GripEstimator {
        self.write(SPEED_SET.address, PerDof::splat(50));
        self.write(FORCE_SET.address, PerDof::splat(force_g));
        let bent = PerDof::new([100, 100, 100, 100, 100, 1000]);
        self.write(ANGLE_SET.address, bent);
        let mut grip = GripEstimator::default();
        for _ in 0..1500 {
            self.step(|sample, fresh, now| {
                grip.apply(sample, fresh, now);
            });
        }
        grip
    }
}

/// A hold on a simulated hand.
struct Bench {
    hand: Hand,
    program: HoldRun,
    status: LinkStatus,
    sent: Vec<Sent>,
    peak_g: f64,
    /// What the force sensors read too much.
    drift_g: i16,
}

impl Bench {
    fn of(hand: Hand, start: HoldStart) -> Self {
        Self {
            program: HoldRun::new(EPOCH, start, hand.now),
            hand,
            status: LinkStatus {
                state: LinkState::Armed,
                armed: Some(EPOCH),
                ..LinkStatus::default()
            },
            sent: Vec::new(),
            peak_g: 0.0,
            drift_g: 0,
        }
    }

    /// A hold that closes on this object.
    fn closing_on(object: Object) -> Self {
        let hand = Hand::new(SimConfig {
            object: Some(object),
            ..SimConfig::default()
        });
        Self::of(hand, start())
    }

    fn step(&mut self) {
        let (program, drift_g) = (&mut self.program, self.drift_g);
        self.hand
            .step(|sample, fresh, now| program.read(&drifted(sample, drift_g), fresh, now));
        let forces = self.hand.sim.held().fingers.map(|finger| finger.normal_g);
        self.peak_g = forces
            .as_array()
            .iter()
            .copied()
            .fold(self.peak_g, f64::max);
        let seen = Seen {
            status: &self.status,
            sample: &drifted(&self.hand.sample, drift_g),
            stall: None,
            now: self.hand.now,
        };
        let Some(order) = self.program.tick(&seen) else {
            return;
        };
        let sent = Sent {
            at: self.hand.now,
            order,
            angles: self
                .hand
                .sample
                .angle
                .unwrap()
                .value
                .map(|angle| angle.raw()),
            phase: self.program.view(self.hand.now).phase,
        };
        let Some(setpoints) = sent.setpoints() else {
            self.sent.push(sent);
            return;
        };
        self.hand.set(&setpoints);
        if !setpoints.is_empty() {
            self.sent.push(sent);
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
            assert!(self.hand.now < end, "{:?}", self.sent.last());
            self.step();
        }
    }

    fn run_until_held(&mut self) {
        self.run_until(|own| own.program.held_for(own.hand.now).is_some());
    }

    fn run_to_end(&mut self) -> Result<HoldEnd, Abort> {
        self.run_until(|own| own.program.ended().is_some());
        self.program.ended().unwrap()
    }

    fn loads_g(&self) -> PerFinger<f64> {
        self.hand.sim.true_loads()
    }

    /// Targets of one angle as sent, with the measured one.
    fn angle_targets(&self) -> Vec<(Dof, i16, Sent)> {
        let sent = self.sent.iter();
        sent.filter_map(|sent| Some((sent, sent.setpoints()?)))
            .flat_map(|(sent, setpoints)| {
                let targets = setpoints.angle.map(|target| target.map(Target::raw));
                let own = move |dof| Some((dof, targets[dof]?, *sent));
                Dof::ALL.into_iter().filter_map(own)
            })
            .collect()
    }
}

/// A sample whose forces read too much.
fn drifted(sample: &HandSample, by_g: i16) -> HandSample {
    let mut sample = *sample;
    if let Some(forces) = &mut sample.force {
        forces.value = forces
            .value
            .map(|force| ForceReading::new(force.raw() + by_g));
    }
    sample
}

pub(super) fn forces() -> HoldForces {
    HoldForces::new(Force::nearest(AT_LEAST_G), Force::nearest(AT_MOST_G)).unwrap()
}

pub(super) fn start() -> HoldStart {
    let bent = PerDof::new([Some(100), Some(100), Some(100), Some(100), Some(100), None]);
    HoldStart {
        close: HoldClose::To(bent.map(|angle: Option<i16>| angle.map(Angle::nearest))),
        forces: forces(),
        duration: None,
        reading_per_g: PerDof::splat(1.0),
        locked: PerDof::splat(false),
        overshoot: OvershootMap::default(),
        blocks: SizeBlocks::default(),
        grip: GripEstimator::default(),
    }
}

/// A firm object of 60 g that is lifted 1.5 s after two fingers press it.
pub(super) fn ball(stiffness: f64) -> Object {
    let obstacle = Obstacle::at(TOUCHES_AT, stiffness);
    let contacts = PerDof::from_fn(|dof| (dof != Dof::ThumbRotate).then_some(obstacle));
    Object {
        mass_g: 60.0,
        friction: Friction {
            sticking: 0.6,
            sliding_ratio: 0.8,
            drag_per_mm_s: 0.0,
            scatter: 0.0,
        },
        loads: Loads {
            lift_after_s: Some(1.5),
            ..Loads::NONE
        },
        ..Object::touched_at(contacts)
    }
}

/// The same, heavier, and pulled once it is lifted.
pub(super) fn pulled_ball() -> Object {
    let mut ball = ball(10.0);
    ball.mass_g = 200.0;
    ball.loads.pulls = listed(&[PullLoad {
        at_s: 2.0,
        force_g: 400.0,
        direction_deg: 270.0,
        rise_ms: 300.0,
        lasts_ms: 1000.0,
    }]);
    ball
}

fn taken_over(object: Object, force_g: i16) -> Bench {
    let mut hand = Hand::new(SimConfig {
        object: Some(object),
        ..SimConfig::default()
    });
    let grip = hand.close(force_g);
    Bench::of(
        hand,
        HoldStart {
            close: HoldClose::TakeOver,
            grip,
            ..start()
        },
    )
}

#[test]
fn nothing_moves_while_the_zero_is_measured() {
    let mut bench = Bench::closing_on(ball(10.0));
    let begun = bench.hand.now;
    bench.run_until(|own| !own.sent.is_empty());
    let waited = bench.hand.now.since(begun);
    assert!(waited >= Duration::from_millis(400), "{waited:?}");
    assert!(waited < Duration::from_secs(1), "{waited:?}");
}

#[test]
fn an_empty_hand_takes_nothing_over_and_does_not_move() {
    let mut bench = taken_over(Object::none(), 300);
    assert_eq!(bench.run_to_end(), Ok(HoldEnd::Nothing));
    let orders: Vec<Order> = bench.sent.iter().map(|sent| sent.order).collect();
    assert_eq!(orders, [Order::Stop]);
}

#[test]
fn a_held_object_is_taken_over_without_opening() {
    for stiffness in [3.0, 20.0] {
        let mut bench = taken_over(ball(stiffness), 200);
        let begun = bench.hand.now;
        bench.run_for(Duration::from_secs(2));
        assert!(bench.program.held_for(bench.hand.now).is_some());
        let targets = bench.angle_targets();
        for (dof, to, sent) in &targets {
            let opens = to - sent.angles[*dof];
            assert!(opens <= 1, "{dof:?} {to} {sent:?} since {begun:?}");
        }
        let took = |finger: &Finger| targets.iter().any(|(dof, ..)| *dof == finger.bend());
        assert!(Finger::ALL.iter().all(took), "{targets:?}");
        assert!(bench.hand.sim.held().held);
    }
}

#[test]
fn thresholds_rise_to_at_most_after_the_held_position_was_sent() {
    let mut bench = Bench::closing_on(ball(20.0));
    bench.run_until_held();
    bench.step();
    let setpoints: Vec<(Sent, Setpoints)> = bench
        .sent
        .iter()
        .filter_map(|sent| Some((*sent, sent.setpoints()?)))
        .collect();
    let raises = |setpoints: &Setpoints| {
        let mut forces = setpoints.force.as_array().iter().flatten();
        forces.any(|force| force.get() > 2 * AT_LEAST_G)
    };
    let raised = setpoints.iter().position(|(_, own)| raises(own)).unwrap();
    let (before, held) = setpoints[raised - 1];
    let waited = setpoints[raised].0.at.since(before.at);
    assert!(waited >= Duration::from_millis(100), "{waited:?}");
    for finger in Finger::ALL {
        let dof = finger.bend();
        assert_eq!(held.angle[dof].map(Target::raw), Some(before.angles[dof]));
        assert_eq!(held.force[dof], None, "{held:?}");
        let raised = setpoints[raised].1.force[dof].map(Force::get);
        assert!(raised.is_some_and(|g| (350..=AT_MOST_G).contains(&g)));
    }
}

#[test]
fn a_drive_that_counts_the_zero_of_its_sensor_presses_enough() {
    for zero_g in [-60.0, 0.0, 200.0] {
        let mut config = SimConfig {
            object: Some(ball(20.0)),
            ..SimConfig::default()
        };
        config.personality.force_compared = ForceCompared::AsRead;
        for (_, joint) in config.body.joints.iter_mut() {
            joint.force_zero_g = zero_g;
        }
        let mut bench = Bench::of(Hand::new(config), start());
        bench.run_until_held();
        bench.run_for(Duration::from_secs(5));
        for (finger, load_g) in bench.loads_g().iter() {
            let least = 0.8 * f64::from(AT_LEAST_G);
            assert!(*load_g >= least, "zero {zero_g} {finger:?} {load_g}");
        }
        let over = bench.peak_g - f64::from(AT_MOST_G);
        assert!(over <= 20.0, "zero {zero_g}: {over} g over at most");
    }
}

#[test]
fn no_finger_presses_a_rigid_block_beyond_at_most() {
    for seed in 0..4 {
        let mut hand = Hand::new(SimConfig {
            seed,
            object: Some(Object::rigid(TOUCHES_AT)),
            ..SimConfig::default()
        });
        hand.step(|_, _, _| {});
        let mut bench = Bench::of(hand, start());
        bench.run_until_held();
        bench.run_for(Duration::from_secs(10));
        let over = bench.peak_g - f64::from(AT_MOST_G);
        assert!(over <= 20.0, "seed {seed}: {over} g over at most");
    }
}

#[test]
fn a_slip_tightens_the_fingers_at_once() {
    // Smoother than any object should be, and it creeps: no load announces this slip.
    let mut object = ball(10.0);
    object.friction = Friction {
        sticking: 0.15,
        sliding_ratio: 0.95,
        drag_per_mm_s: 0.02,
        scatter: 0.0,
    };
    object.loads.pulls = listed(&[PullLoad {
        at_s: 3.0,
        force_g: 80.0,
        direction_deg: 270.0,
        rise_ms: 500.0,
        lasts_ms: 5000.0,
    }]);
    let mut bench = Bench::closing_on(object);
    bench.run_until(|own| own.hand.sim.held().slides);
    while bench.program.event().is_some() {}
    bench.run_until(|own| own.hand.sim.held().slid_mm > 1.0);
    let shows = bench.hand.now;
    let mut slip = None;
    while slip.is_none() {
        bench.step();
        let late = bench.hand.now.since(shows);
        assert!(
            late <= Duration::from_millis(150),
            "{:?}",
            bench.hand.sim.held()
        );
        slip = bench.program.event();
    }
    assert_eq!(slip.unwrap().cause, TightenCause::Slip);
    bench.run_for(Duration::from_secs(2));
    let held = bench.hand.sim.held();
    assert!(held.held && !held.slides, "{held:?}");
}

#[test]
fn a_rigid_and_heavy_block_is_pinched_by_the_force_that_it_needs() {
    let mut hand = SimConfig {
        object: Some(NamedObject::Block.object()),
        ..SimConfig::default()
    };
    for seed in 1..4 {
        hand.seed = seed;
        let pinch = HoldStart {
            close: HoldClose::Pinch(Gap::MIN),
            ..start()
        };
        let mut bench = Bench::of(Hand::new(hand), pinch);
        bench.run_until_held();
        bench.run_for(Duration::from_secs(6));
        let held = bench.hand.sim.held();
        assert!(held.held && !held.slides, "seed {seed}: {held:?}");
        let over = bench.peak_g - f64::from(AT_MOST_G);
        assert!(over <= 64.0, "seed {seed}: {over} g over at most");
    }
}

#[test]
fn a_thumb_whose_drive_counts_its_zero_is_turned_before_the_pinch_closes() {
    let mut config = SimConfig {
        object: Some(Object::touched_at(Object::contacts_of_size(
            60.0,
            Obstacle::at(0.0, 10.0),
        ))),
        ..SimConfig::default()
    };
    config.personality.force_compared = ForceCompared::AsRead;
    config.body.joints[Dof::ThumbRotate].force_zero_g = 200.0;
    let hold = HoldStart {
        close: HoldClose::Pinch(Gap::MIN),
        ..start()
    };
    let mut bench = Bench::of(Hand::new(config), hold);
    bench.run_until(|own| own.hand.sim.true_angles()[Dof::Index] < 780.0);
    let rotation = bench.hand.sim.true_angles()[Dof::ThumbRotate];
    assert!(rotation < 40.0, "{rotation}");
}

#[test]
fn the_shown_force_is_the_one_it_holds_with_also_where_the_zeros_drift() {
    let mut bench = Bench::closing_on(ball(10.0));
    bench.run_until_held();
    bench.run_for(Duration::from_secs(5));
    for _ in 0..90 {
        bench.drift_g -= 1;
        bench.run_for(Duration::from_millis(500));
    }
    bench.run_for(Duration::from_secs(20));
    let shown = bench.program.view(bench.hand.now).force_g;
    for (finger, load_g) in bench.loads_g().iter() {
        let Some(shown_g) = shown[finger] else {
            continue;
        };
        let differs = (f64::from(shown_g) - load_g).abs();
        assert!(differs < 45.0, "{finger:?}: {shown_g} of {load_g}");
    }
    assert!(shown.as_array().iter().any(Option::is_some));
}

/// A hold whose object was just taken away.
fn robbed() -> Bench {
    let mut object = ball(10.0);
    object.loads.taken_away_at_s = Some(3.0);
    let mut bench = Bench::closing_on(object);
    bench.run_until(|own| own.hand.sim.held().lost.is_some());
    bench
}

#[test]
fn an_object_that_is_taken_away_is_lost_and_stops_the_hand() {
    let mut bench = robbed();
    let taken = bench.hand.now;
    assert_eq!(bench.run_to_end(), Ok(HoldEnd::Lost));
    let waited = bench.hand.now.since(taken);
    assert!(waited < Duration::from_secs(1), "{waited:?}");
    assert_eq!(bench.sent.last().unwrap().order, Order::Stop);
}

#[test]
fn an_object_that_leaves_the_fingertips_is_lost_whatever_the_drives_read() {
    let mut bench = robbed();
    bench.drift_g = AT_LEAST_G;
    assert_eq!(bench.run_to_end(), Ok(HoldEnd::Lost));
}

#[test]
fn a_finger_that_lost_the_object_opens_where_its_drive_reads_too_much() {
    let mut bench = robbed();
    // The fingertips are read meanwhile.
    bench.run_for(Duration::from_millis(50));
    let lost = bench.hand.now;
    bench.drift_g = 2 * AT_MOST_G;
    bench.run_to_end().unwrap();
    let steps = bench.angle_targets().into_iter();
    let mut later = steps.filter(|(_, _, sent)| sent.at > lost);
    assert!(later.any(|(dof, to, sent)| to > sent.angles[dof]));
}

#[test]
fn a_close_that_meets_nothing_stops_the_hand() {
    let mut bench = Bench::closing_on(Object::none());
    assert_eq!(bench.run_to_end(), Ok(HoldEnd::Nothing));
    assert_eq!(bench.sent.last().unwrap().order, Order::Stop);
}

#[test]
fn an_abort_ends_it_and_nothing_is_sent_afterwards() {
    for is_held in [false, true] {
        let mut bench = Bench::closing_on(ball(10.0));
        match is_held {
            true => bench.run_until_held(),
            false => bench.run_for(Duration::from_secs(1)),
        }
        let sent = bench.sent.len();
        bench.program.abort(Abort::Person, bench.hand.now);
        bench.run_for(Duration::from_secs(1));
        assert_eq!(bench.program.ended(), Some(Err(Abort::Person)));
        assert_eq!(bench.sent.len(), sent);
    }
}

#[test]
fn locked_joints_receive_nothing() {
    let hand = Hand::new(SimConfig {
        object: Some(ball(10.0)),
        ..SimConfig::default()
    });
    let mut locked = PerDof::splat(false);
    (locked[Dof::Little], locked[Dof::ThumbRotate]) = (true, true);
    let mut bench = Bench::of(hand, HoldStart { locked, ..start() });
    bench.run_until_held();
    bench.run_for(Duration::from_secs(5));
    for setpoints in bench.sent.iter().filter_map(Sent::setpoints) {
        for dof in [Dof::Little, Dof::ThumbRotate] {
            assert_eq!(setpoints.angle[dof], None, "{setpoints:?}");
            assert_eq!(setpoints.force[dof], None, "{setpoints:?}");
            assert_eq!(setpoints.speed[dof], None, "{setpoints:?}");
        }
    }
    assert!(bench.hand.sim.held().held);
}

#[test]
fn a_hold_ends_held_when_its_time_is_over() {
    let hand = Hand::new(SimConfig {
        object: Some(ball(10.0)),
        ..SimConfig::default()
    });
    let duration = Some(Duration::from_secs(5));
    let mut bench = Bench::of(
        hand,
        HoldStart {
            duration,
            ..start()
        },
    );
    assert_eq!(bench.run_to_end(), Ok(HoldEnd::Held));
    let last = bench.sent.last().unwrap();
    assert_eq!(
        (last.order, last.phase),
        (Order::Disarm, HoldPhase::Holding)
    );
    assert!(bench.program.held_for(bench.hand.now) >= duration);
    bench.run_for(Duration::from_secs(1));
    assert!(bench.hand.sim.held().held, "the hand keeps it");
}

#[test]
fn forces_without_room_for_a_hold_are_refused() {
    let hold = |least: i64, most: i64| HoldForces::new(Force::nearest(least), Force::nearest(most));
    for (least, most) in [(40, 100), (150, 400), (1940, 2000)] {
        let forces = hold(least, most).unwrap();
        assert_eq!(i64::from(forces.at_least().get()), least);
        assert_eq!(i64::from(forces.at_most().get()), most);
    }
    for (at_least, at_most) in [(39, 400), (0, 400), (150, 209), (400, 150), (150, 2001)] {
        let refused = hold(at_least.into(), at_most.into());
        assert_eq!(refused, Err(NoRoom { at_least, at_most }));
        let told = refused.unwrap_err().to_string();
        assert!(told.contains("leave no room for a hold"), "{told}");
    }
}
