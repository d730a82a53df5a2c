//! A grasp that another hand confirms, on a simulated hand in virtual time.

use crate::hand::newtons::N_PER_G;
use crate::hand::{HandCommand, PerDof};
use crate::link::LinkStatus;
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::grasp::run::{
    ConfirmStep, Confirming, GraspInput, GraspRun, GraspStart, Unconfirmed,
};
use crate::motion::grasp::saved::Grasp;
use crate::motion::grasp::seen::{GraspLabel, NoGrasp};
use crate::motion::hold::{HoldEnd, HoldStart};
use crate::motion::program::{Ended, Order, Program, Seen};
use crate::motion::tests::hold::{EPOCH, Hand, ball, start};
use crate::record::{Abort, LinkState};
use crate::sim::object::{HandTurn, listed};
use crate::sim::{Object, SimConfig};
use std::time::Duration;

/// A run that takes longer has failed.
const LONGEST: Duration = Duration::from_secs(300);

struct Bench {
    hand: Hand,
    program: GraspRun,
    /// All parts of the confirmation in order.
    steps: Vec<Confirming>,
    /// Parts in which the user says that the object stands.
    says: fn(ConfirmStep) -> bool,
    /// The object fell while the hand carried it.
    is_dropped: bool,
}

impl Bench {
    fn of(object: Object, unconfirmed: Option<Unconfirmed>, duration_s: u64) -> Self {
        let hand = Hand::new(SimConfig {
            object: Some(object),
            ..SimConfig::default()
        });
        let hold = HoldStart {
            duration: Some(Duration::from_secs(duration_s)),
            ..start()
        };
        let start = GraspStart { hold, unconfirmed };
        Self {
            program: GraspRun::new(EPOCH, start, hand.now),
            hand,
            steps: Vec::new(),
            says: |step| step == ConfirmStep::Release,
            is_dropped: false,
        }
    }

    fn run(&mut self) -> Ended<Result<HoldEnd, GraspDoubt>> {
        let status = LinkStatus {
            state: LinkState::Armed,
            armed: Some(EPOCH),
            ..LinkStatus::default()
        };
        let mut load_g = 0.0;
        let latest = self.hand.now.plus(LONGEST);
        while self.hand.now < latest {
            let program = &mut self.program;
            self.hand
                .step(|sample, fresh, now| program.read(sample, fresh, now));
            let truth = self.hand.sim.held();
            self.is_dropped |= truth.lost.is_some() && load_g > 5.0;
            load_g = match truth.lost {
                None => truth.external_g.length(),
                Some(_) => 0.0,
            };
            let seen = Seen {
                status: &status,
                sample: &self.hand.sample,
                stall: None,
                now: self.hand.now,
            };
            let confirming = self.program.view(self.hand.now).confirming;
            let says = confirming.is_some_and(|own| (self.says)(own.step));
            let said = says.then(|| self.program.input(GraspInput::PutDown, &seen));
            let order = said.flatten().or_else(|| self.program.tick(&seen));
            if let Some(Order::Set(setpoints)) = order {
                for write in setpoints.commands().iter().flat_map(HandCommand::writes) {
                    let (address, now) = (write.span().address, self.hand.now);
                    self.hand.sim.write(address, write.bytes(), now).unwrap();
                }
            }
            if let Some(confirming) = self.program.view(self.hand.now).confirming
                && self.steps.last() != Some(&confirming)
            {
                self.steps.push(confirming);
            }
            if let Some(end) = self.program.ended() {
                return end;
            }
        }
        panic!("{:?}", self.steps);
    }

    fn grasp(&self) -> Result<Grasp, NoGrasp> {
        let about = GraspLabel {
            name: "ball".into(),
            note: String::new(),
            day: "2026-11-30".into(),
            hand: "tcp:10.0.0.1".parse().unwrap(),
            pose: None,
            newtons: PerDof::splat(Some(N_PER_G)),
            claim: None,
        };
        self.program.grasp(about, self.hand.now)
    }
}

/// The grasp of a ball that was held by another hand.
fn unconfirmed() -> Unconfirmed {
    let mut bench = Bench::of(ball(10.0), None, 6);
    assert_eq!(bench.run(), Ok(Ok(HoldEnd::Held)));
    Unconfirmed {
        grasp: bench.grasp().unwrap(),
        newtons: PerDof::splat(Some(N_PER_G)),
    }
}

/// The ball is lifted, and put down again 3 s later.
fn put_down(stiffness: f64) -> Object {
    let mut object = ball(stiffness);
    let turn = |at_s, share| HandTurn {
        at_s,
        direction_deg: 270.0,
        share,
    };
    object.loads.turns = listed(&[turn(3.0, 1.0), turn(3.5, 0.0)]);
    object
}

#[test]
fn a_hold_is_saved_only_if_it_worked() {
    let grasp = unconfirmed().grasp;
    assert!(grasp.fingers.as_array().iter().all(Option::is_some));
    assert!(grasp.friction.held_ratio.unwrap() > 0.05, "{grasp:?}");
    let mut empty = Bench::of(Object::none(), None, 6);
    assert_eq!(empty.run(), Ok(Ok(HoldEnd::Nothing)));
    assert_eq!(empty.grasp(), Err(NoGrasp::Failed));
    let mut brief = Bench::of(ball(10.0), None, 1);
    brief.run().unwrap().unwrap();
    assert!(matches!(brief.grasp(), Err(NoGrasp::Short { .. })));
    let mut heavy = ball(10.0);
    heavy.mass_g = 1150.0;
    let mut heavy = Bench::of(heavy, None, 6);
    heavy.run().unwrap().unwrap();
    let why = heavy.grasp().unwrap_err();
    assert!(matches!(why, NoGrasp::CouldNotHold | NoGrasp::Failed));
    let mut aborted = Bench::of(ball(10.0), None, 6);
    aborted.program.abort(Abort::TakenOver, aborted.hand.now);
    assert_eq!(aborted.grasp(), Err(NoGrasp::Failed));
}

#[test]
fn five_closes_confirm_it_and_the_fifth_holds_on() {
    let mut bench = Bench::of(put_down(10.0), Some(unconfirmed()), 2);
    assert_eq!(bench.run(), Ok(Ok(HoldEnd::Held)), "{:?}", bench.steps);
    assert_eq!(bench.program.agreement().unwrap().closes, 5);
    let count = |step| bench.steps.iter().filter(|own| own.step == step).count();
    assert_eq!(
        (count(ConfirmStep::Close), count(ConfirmStep::Open)),
        (5, 4)
    );
    assert_eq!(count(ConfirmStep::Release), 4, "the last does not open");
    assert_eq!(bench.steps.last().unwrap().close, 5);
    assert!(!bench.is_dropped);
    assert!(bench.hand.sim.held().held, "it is not opened at the end");
}

#[test]
fn an_object_that_stays_lifted_is_kept_and_not_trusted() {
    let mut bench = Bench::of(ball(10.0), Some(unconfirmed()), 2);
    assert_eq!(bench.run(), Ok(Err(GraspDoubt::NoLoad { close: 1 })));
    let opens = |own: &Confirming| own.step == ConfirmStep::Open;
    assert!(!bench.steps.iter().any(opens), "{:?}", bench.steps);
    assert!(bench.hand.sim.held().held);
}

#[test]
fn a_load_that_is_gone_opens_nothing_until_the_user_says_so() {
    type Says = fn(ConfirmStep) -> bool;
    let cases: [Says; 2] = [|_| false, |step| step != ConfirmStep::Release];
    for says in cases {
        let mut bench = Bench::of(put_down(10.0), Some(unconfirmed()), 2);
        bench.says = says;
        assert_eq!(bench.run(), Ok(Err(GraspDoubt::NotReleased { close: 1 })));
        let steps: Vec<ConfirmStep> = bench.steps.iter().map(|own| own.step).collect();
        assert_eq!(steps.last(), Some(&ConfirmStep::Release), "{steps:?}");
        assert!(!steps.contains(&ConfirmStep::Open), "{steps:?}");
        assert!(bench.hand.sim.held().held);
    }
}

#[test]
fn an_object_that_is_lifted_again_is_not_asked_for_until_it_is_put_down_again() {
    let mut object = put_down(10.0);
    let turn = |at_s, share| HandTurn {
        at_s,
        direction_deg: 270.0,
        share,
    };
    let turns = [(3.0, 1.0), (3.5, 0.0), (6.0, 1.0), (7.0, 0.0)];
    object.loads.turns = listed(&turns.map(|(at_s, share)| turn(at_s, share)));
    let mut bench = Bench::of(object, Some(unconfirmed()), 2);
    bench.says = |_| false;
    assert_eq!(bench.run(), Ok(Err(GraspDoubt::NotReleased { close: 1 })));
    let steps: Vec<ConfirmStep> = bench.steps.iter().map(|own| own.step).collect();
    let again = [
        ConfirmStep::Release,
        ConfirmStep::PutDown,
        ConfirmStep::Release,
    ];
    assert!(steps.ends_with(&again), "{steps:?}");
}

#[test]
fn a_stiffer_object_is_not_trusted() {
    let mut bench = Bench::of(put_down(45.0), Some(unconfirmed()), 2);
    let end = bench.run();
    assert!(
        matches!(end, Ok(Err(GraspDoubt::Stiffness { .. }))),
        "{end:?}"
    );
    assert_eq!(bench.program.agreement(), None);
    assert!(!bench.is_dropped);
}
