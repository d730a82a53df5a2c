//! A source that requests a hold, at a simulated hand with an object behind a real link, in virtual time.

use crate::inputs::follow::Stage;
use crate::setup::hand;
use crate::setup::time::in_virtual_time;
use handscope::hand::gap::{Block, Gap, SizeBlocks};
use handscope::hand::hold_forces::HoldForces;
use handscope::hand::{Angle, Dof, Force, PerDof};
use handscope::inputs::{Offer, OfferLimits};
use handscope::link::{Lease, Owner};
use handscope::motion::follow::step::FollowPhase;
use handscope::motion::follow::{FollowHold, FollowTerms, FollowView, follow};
use handscope::motion::hold::{HoldEnd, HoldPhase};
use handscope::motion::program::Ended;
use handscope::record::{Disarmed, LinkState, Record, WriteCause};
use handscope::sim::object::{Friction, Loads};
use handscope::sim::{Object, Obstacle, SharedHand, SimConfig, SimHand};
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;

const AT_MOST_G: i16 = 400;
const BENT: PerDof<Option<i16>> =
    PerDof::new([Some(300), Some(300), Some(300), Some(300), Some(300), None]);
const OPEN: PerDof<Option<i16>> = PerDof::splat(Some(1000));
const NONE: PerDof<Option<i16>> = PerDof::splat(None);

/// A light, firm object near the open hand, so that the slow close is short.
fn ball() -> Object {
    let obstacle = Obstacle::at(900.0, 10.0);
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

fn holding(object: Object) -> SharedHand {
    hand::begin(SimHand::new(SimConfig {
        object: Some(object),
        ..SimConfig::default()
    }))
}

fn forces() -> HoldForces {
    HoldForces::nearest(Force::nearest(150), Force::nearest(AT_MOST_G))
}

/// A source that may move the hand, and what is told of following it.
struct Source {
    hand: SharedHand,
    stage: Stage,
    offers: mpsc::Sender<Offer>,
    views: watch::Receiver<Option<FollowView>>,
    /// Phases of each hold, in order.
    holds: Vec<(HoldPhase, Option<HoldEnd>)>,
    dead_man: Option<bool>,
    gap: Option<Gap>,
    task: JoinHandle<Ended<()>>,
}

impl Source {
    async fn at(object: Object) -> Self {
        Self::with(object, |_| false).await
    }

    async fn with(object: Object, is_locked: impl Fn(Dof) -> bool) -> Self {
        Self::measured(object, is_locked, SizeBlocks::default()).await
    }

    async fn measured(object: Object, is_locked: impl Fn(Dof) -> bool, blocks: SizeBlocks) -> Self {
        let hand = holding(object);
        let stage = Stage::at(hand.clone()).await;
        let (offers, taken) = mpsc::channel(64);
        let (tell, views) = watch::channel(None);
        let lease: Lease = stage.link().grant(Owner::Gamepad);
        let terms = FollowTerms {
            locked: PerDof::from_fn(is_locked),
            ..FollowTerms::default()
        };
        let start = handscope::motion::follow::FollowStart {
            terms: watch::Sender::new(terms).subscribe(),
            blocks,
            ..stage.beginning(lease)
        };
        let link = stage.link().clone();
        let task = tokio::spawn(async move {
            follow(&link, start, taken, |view| {
                let _before = tell.send_replace(Some(view));
            })
            .await
        });
        Self {
            hand,
            stage,
            offers,
            views,
            holds: Vec::new(),
            dead_man: None,
            gap: None,
            task,
        }
    }

    fn view(&self) -> FollowView {
        self.views.borrow().expect("it follows")
    }

    fn hold(&self) -> Option<FollowHold> {
        self.view().hold
    }

    async fn pass(&mut self, ms: u64) {
        for _ in 0..ms / 10 {
            self.stage.pass(10).await;
            let hold = self.views.borrow().and_then(|view| view.hold);
            let step = hold.map(|hold| (hold.view.phase, hold.end));
            if let Some(step) = step.filter(|step| self.holds.last() != Some(step)) {
                self.holds.push(step);
            }
        }
    }

    /// Sends this a hundred times a second.
    async fn send(&mut self, aims: PerDof<Option<i16>>, hold: Option<HoldForces>, ms: u64) {
        for _ in 0..ms / 10 {
            let _sent = self.offers.try_send(Offer {
                at: self.stage.clock().now(),
                aims: aims.map(|aim| aim.map(Angle::nearest)),
                gap: self.gap,
                hold,
                limits: OfferLimits::NONE,
                held: self.dead_man,
                mark: Some(7),
            });
            self.pass(10).await;
        }
    }

    /// Requests a hold until it holds.
    async fn send_until(&mut self, aims: PerDof<Option<i16>>, phase: HoldPhase) {
        for _ in 0..3000 {
            self.send(aims, Some(forces()), 10).await;
            let is_there = |hold: FollowHold| hold.view.phase == phase;
            if self
                .views
                .borrow()
                .and_then(|view| view.hold)
                .is_some_and(is_there)
            {
                return;
            }
        }
        panic!("not {phase:?}: {:?}", self.views.borrow());
    }

    fn carries(&self) -> bool {
        self.hand.with(|hand, now| {
            hand.advance_to(now);
            hand.held().held
        })
    }

    /// Number of setpoints of the source that went out.
    fn setpoints(&self) -> usize {
        let is_setpoint = |record: &&Record| {
            let cause = WriteCause::Setpoint;
            matches!(record, Record::Sent { cause: own, .. } if *own == cause)
        };
        self.stage.records().iter().filter(is_setpoint).count()
    }

    fn thresholds(&self) -> PerDof<i16> {
        let set = self.stage.sample().force_set.unwrap().value;
        set.map(|force| force.unwrap().get())
    }
}

#[test]
fn a_hold_closes_on_the_object_and_the_next_target_opens_the_hand() {
    in_virtual_time(async {
        let mut source = Source::at(ball()).await;
        source.send_until(BENT, HoldPhase::Holding).await;
        source.send(BENT, Some(forces()), 4000).await;
        assert!(source.carries(), "{:?}", source.hold());
        assert_eq!(source.view().phase, FollowPhase::Holding);
        assert_eq!(
            source.holds,
            [HoldPhase::Measuring, HoldPhase::Closing, HoldPhase::Holding].map(|one| (one, None)),
        );
        let thresholds = source.thresholds();
        for dof in [Dof::Index, Dof::ThumbBend] {
            assert!(thresholds[dof] <= AT_MOST_G, "{thresholds:?}");
        }
        source.send(OPEN, None, 4000).await;
        assert_eq!(source.view().phase, FollowPhase::Following);
        assert_eq!(source.hold(), None);
        assert!(!source.carries());
        let open = source.stage.sample().angle.unwrap().value;
        assert!(open[Dof::Index].raw() > 980, "{open:?}");
        // Following has its own thresholds again.
        let gentle = Force::GENTLE.get();
        assert_eq!(source.thresholds(), PerDof::splat(gentle));
    });
}

#[test]
fn a_hold_without_targets_takes_over_what_is_held_and_other_targets_do_not_close_it_again() {
    in_virtual_time(async {
        let mut source = Source::at(ball()).await;
        source.send_until(BENT, HoldPhase::Holding).await;
        source.send(BENT, Some(forces()), 3000).await;
        let before = source.holds.len();
        source.send(OPEN, Some(forces()), 1000).await;
        source.send(NONE, Some(forces()), 1000).await;
        assert_eq!(source.holds.len(), before, "{:?}", source.holds);
        // Other forces are another hold, which takes over.
        let firmer = HoldForces::nearest(Force::nearest(250), Force::nearest(450));
        source.send(NONE, Some(firmer), 3000).await;
        assert_eq!(source.hold().unwrap().view.forces, firmer);
        assert_eq!(source.holds.last(), Some(&(HoldPhase::Holding, None)));
        assert!(source.carries());
        // It ends without a target: the hand stays as it is.
        source.send(NONE, None, 100).await;
        let sent = source.setpoints();
        source.send(NONE, None, 1000).await;
        assert_eq!((source.hold(), source.setpoints()), (None, sent));
        assert!(source.carries());
    });
}

#[test]
fn an_empty_hand_takes_nothing_over_and_does_not_try_again() {
    in_virtual_time(async {
        let mut source = Source::at(Object::none()).await;
        source.send(NONE, Some(forces()), 4000).await;
        assert_eq!(source.hold().unwrap().end, Some(HoldEnd::Nothing));
        let ends = source.holds.iter().filter(|(_, end)| end.is_some());
        assert_eq!(ends.count(), 1, "{:?}", source.holds);
        let measured = source.holds.iter();
        let measured =
            measured.filter(|(phase, end)| *phase == HoldPhase::Measuring && end.is_none());
        assert_eq!(measured.count(), 1, "{:?}", source.holds);
    });
}

#[test]
fn silence_keeps_position_and_thresholds_of_a_hold_and_its_next_line_continues_it() {
    in_virtual_time(async {
        let mut source = Source::at(ball()).await;
        source.send_until(BENT, HoldPhase::Holding).await;
        source.send(BENT, Some(forces()), 5000).await;
        let (steps, thresholds) = (source.holds.len(), source.thresholds());
        source.pass(300).await;
        let sent = source.setpoints();
        source.pass(500).await;
        assert_eq!(source.setpoints(), sent, "no step while it is silent");
        assert_eq!(source.view().phase, FollowPhase::Silent);
        assert_eq!(source.thresholds(), thresholds);
        assert!(source.carries());
        source.send(BENT, Some(forces()), 500).await;
        assert_eq!(source.view().phase, FollowPhase::Holding);
        assert_eq!(source.holds.len(), steps, "{:?}", source.holds);
        // It stays silent: the hand is stopped, which keeps what it holds.
        source.pass(2000).await;
        assert_eq!(source.task.await.unwrap(), Ok(()));
        let status = source.stage.link().status();
        assert_eq!(status.disarmed, Some(Disarmed::Silent));
        assert_eq!((status.armed, status.holder), (None, None));
        source.hand.with(|hand, now| {
            hand.advance_to(now);
            assert!(hand.held().held);
        });
    });
}

#[test]
fn silence_while_a_hold_closes_holds_the_fingers_where_they_are() {
    in_virtual_time(async {
        let mut far = ball();
        far.contacts =
            PerDof::from_fn(|dof| (dof != Dof::ThumbRotate).then_some(Obstacle::at(500.0, 10.0)));
        let mut source = Source::at(far).await;
        source.send_until(BENT, HoldPhase::Closing).await;
        source.send(BENT, Some(forces()), 1500).await;
        source.pass(400).await;
        let index = |source: &Source| hand::true_angle(&source.hand, Dof::Index);
        let held = index(&source);
        source.pass(400).await;
        assert!((index(&source) - held).abs() < 2.0, "{held}");
        assert!(held > 700.0, "it closes still: {held}");
        source.send_until(BENT, HoldPhase::Closing).await;
        let begun = source.holds.iter();
        let begun = begun.filter(|(phase, _)| *phase == HoldPhase::Measuring);
        assert_eq!(begun.count(), 2, "{:?}", source.holds);
    });
}

#[test]
fn an_object_that_leaves_ends_the_hold_and_the_hand_stays_until_something_else_is_sent() {
    in_virtual_time(async {
        let mut object = ball();
        object.loads.taken_away_at_s = Some(3.0);
        let mut source = Source::at(object).await;
        source.send_until(BENT, HoldPhase::Holding).await;
        source.send(BENT, Some(forces()), 8000).await;
        let hold = source.hold().unwrap();
        assert_eq!(hold.end, Some(HoldEnd::Lost), "{:?}", source.holds);
        let (sent, state) = (source.setpoints(), source.stage.link().status().state);
        source.send(BENT, Some(forces()), 2000).await;
        assert_eq!(source.setpoints(), sent, "it does not close again");
        assert_eq!(state, LinkState::Armed, "control stays with the source");
        source.send(OPEN, None, 3000).await;
        source.send_until(BENT, HoldPhase::Closing).await;
    });
}

#[test]
fn a_released_dead_man_ends_a_hold_with_a_stop_that_keeps_the_object() {
    in_virtual_time(async {
        let mut source = Source::at(ball()).await;
        source.dead_man = Some(true);
        source.send_until(BENT, HoldPhase::Holding).await;
        source.send(BENT, Some(forces()), 3000).await;
        source.dead_man = Some(false);
        source.send(BENT, Some(forces()), 500).await;
        assert_eq!(source.view().phase, FollowPhase::Released);
        assert_eq!(source.hold(), None);
        assert_eq!(source.stage.link().status().armed, None);
        assert!(source.carries());
    });
}

#[test]
fn locked_joints_receive_nothing_of_a_hold() {
    in_virtual_time(async {
        let mut source = Source::with(ball(), |dof| dof == Dof::Index).await;
        source.send_until(BENT, HoldPhase::Holding).await;
        source.send(BENT, Some(forces()), 2000).await;
        assert!(
            source.stage.index().is_empty(),
            "{:?}",
            source.stage.index()
        );
    });
}

#[test]
fn the_size_of_what_is_held_is_corrected_by_the_blocks_of_the_hand() {
    in_virtual_time(async {
        let mut blocks = SizeBlocks::default();
        for (size_mm, gap_mm) in [(22.0, 20.0), (72.0, 70.0)] {
            blocks.measure(Block { size_mm, gap_mm }).unwrap();
        }
        let (mut by_model, mut by_blocks) = (0.0, 0.0);
        for (size_mm, blocks) in [
            (&mut by_model, SizeBlocks::default()),
            (&mut by_blocks, blocks),
        ] {
            let contacts = Object::contacts_of_size(40.0, Obstacle::at(0.0, 10.0));
            let pinches = |dof: Dof| matches!(dof, Dof::Index | Dof::ThumbBend);
            let contacts = PerDof::from_fn(|dof| contacts[dof].filter(|_| pinches(dof)));
            let object = Object { contacts, ..ball() };
            let mut source = Source::measured(object, |_| false, blocks).await;
            source.gap = Some(Gap::MIN);
            source.send_until(NONE, HoldPhase::Holding).await;
            source.send(NONE, Some(forces()), 2000).await;
            let object = source.hold().unwrap().view.object.unwrap();
            *size_mm = object.size_mm.unwrap().value;
        }
        let apart = by_blocks - by_model;
        assert!((apart - 2.0).abs() < 0.1, "{by_model} {by_blocks}");
    });
}
