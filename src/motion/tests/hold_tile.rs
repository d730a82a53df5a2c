//! The tile of an exhibition that holds what a visitor gives it, on a simulated hand in virtual time.

use crate::exhibit::file;
use crate::exhibit::stage::{ExhibitHold, ExhibitStage, ExhibitView, ExhibitWish};
use crate::hand::gap::SizeBlocks;
use crate::hand::grip::GripEstimator;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{ArmEpoch, Dof, HandSample, PerDof, Setpoints};
use crate::link::{ArmRequest, Clock, LinkStatus};
use crate::motion::exhibit::{ExhibitRun, ExhibitStart, PageDrawn};
use crate::motion::hold;
use crate::motion::program::{Order, Program as _, Seen};
use crate::motion::tests::hold::{Hand, ball, pulled_ball};
use crate::record::LinkState;
use crate::sim::{Object, SimConfig};
use std::sync::Arc;
use std::time::Duration;

/// A test that runs longer has failed.
const LONGEST: Duration = Duration::from_secs(90);

/// An exhibition at a simulated hand, armed by staff.
struct Booth {
    hand: Hand,
    run: ExhibitRun,
    status: LinkStatus,
    drawn: Arc<PageDrawn>,
    limits: ArmRequest,
    tile: usize,
    sent: Vec<Setpoints>,
}

impl Booth {
    fn with(object: Object) -> Self {
        let plan = file::built_in().unwrap();
        let mut tiles = plan.tiles.iter();
        let tile = tiles.position(|piece| piece.name.en == "Pull it out");
        let limits = plan.limits.arm_request();
        let drawn = Arc::new(PageDrawn::default());
        let hand = Hand::new(SimConfig {
            object: Some(object),
            ..SimConfig::default()
        });
        let start = ExhibitStart {
            plan: Arc::new(plan),
            locked: PerDof::splat(false),
            seen: HandSample::default(),
            grip: GripEstimator::default(),
            overshoot: OvershootMap::default(),
            blocks: SizeBlocks::default(),
            clock: Clock::start(),
            drawn: Arc::clone(&drawn),
        };
        let mut booth = Self {
            run: ExhibitRun::new(start, hand.now),
            hand,
            status: LinkStatus {
                state: LinkState::Monitoring,
                ..LinkStatus::default()
            },
            drawn,
            limits,
            tile: tile.unwrap(),
            sent: Vec::new(),
        };
        booth.run_for(Duration::from_secs(1));
        booth.wish(ExhibitWish::Arm);
        booth.run_for(Duration::from_secs(3));
        booth
    }

    fn wish(&mut self, wish: ExhibitWish) {
        let seen = Seen {
            status: &self.status,
            sample: &self.hand.sample,
            stall: None,
            now: self.hand.now,
        };
        assert_eq!(self.run.input(wish, &seen), None);
    }

    fn step(&mut self) {
        self.drawn.mark(self.hand.now);
        let run = &mut self.run;
        self.hand
            .step(|sample, fresh, now| run.read(sample, fresh, now));
        let seen = Seen {
            status: &self.status,
            sample: &self.hand.sample,
            stall: None,
            now: self.hand.now,
        };
        match self.run.tick(&seen) {
            None | Some(Order::Grant(_)) => {}
            Some(Order::Arm(request)) => {
                let epoch = ArmEpoch(1);
                (self.status.state, self.status.armed) = (LinkState::Armed, Some(epoch));
                self.hand.set(&request.setpoints(epoch));
                assert_eq!(self.run.armed(Ok(epoch)), None);
            }
            Some(Order::Set(setpoints)) => {
                self.hand.set(&setpoints);
                self.sent.push(setpoints);
            }
            Some(Order::Rest) => {
                (self.status.state, self.status.armed) = (LinkState::Monitoring, None);
            }
            Some(other) => panic!("{other:?}"),
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

    fn view(&self) -> ExhibitView {
        self.run.view(self.hand.now)
    }

    fn holds(&self) -> bool {
        self.view().hold.is_some_and(|hold| hold.is_held)
    }

    fn index(&self) -> f64 {
        self.hand.sim.true_angles()[Dof::Index]
    }

    fn press(&mut self) {
        self.wish(ExhibitWish::Press(self.tile));
        self.run_for(Duration::from_millis(100));
        self.wish(ExhibitWish::Release);
    }

    /// Nothing is faster or firmer than the file of the exhibition allows.
    fn check_limits(&self) {
        assert!(!self.sent.is_empty());
        for setpoints in &self.sent {
            for dof in Dof::ALL {
                let (speed, force) = (self.limits.speed[dof], self.limits.force[dof]);
                assert!(setpoints.speed[dof].is_none_or(|own| own <= speed));
                assert!(setpoints.force[dof].is_none_or(|own| own <= force));
            }
        }
    }
}

#[test]
fn what_a_visitor_gives_is_held_and_shown_and_the_hand_opens_when_its_time_is_over() {
    let mut booth = Booth::with(pulled_ball());
    booth.press();
    // It waits open for the object first.
    assert_eq!(booth.view().hold, Some(ExhibitHold::default()));
    booth.run_until(Booth::holds);
    assert_eq!(booth.run.rates(), Some(hold::RATES));
    let begun = booth.hand.now;
    booth.run_until(|own| {
        let hold = own.view().hold.unwrap();
        hold.tightened > 0 && hold.force_g.is_some_and(|g| g > 100)
    });
    let last = booth.view().hold.unwrap().last;
    assert!(last.is_some(), "the finger and its reason are shown");
    booth.run_until(|own| !own.holds());
    assert!(booth.hand.now.since(begun) >= Duration::from_secs(19));
    booth.run_until(|own| own.index() > 990.0);
    booth.run_for(Duration::from_secs(3));
    assert_eq!((booth.view().hold, booth.run.rates()), (None, None));
    assert!(matches!(booth.view().stage, ExhibitStage::Visit { .. }));
    booth.check_limits();
}

#[test]
fn the_hand_opens_once_the_object_was_pulled_out_of_it() {
    let mut object = ball(10.0);
    object.loads.taken_away_at_s = Some(4.0);
    let mut booth = Booth::with(object);
    booth.press();
    booth.run_until(Booth::holds);
    let begun = booth.hand.now;
    booth.run_until(|own| own.hand.sim.held().lost.is_some());
    booth.run_until(|own| own.index() > 990.0);
    assert!(booth.hand.now.since(begun) < Duration::from_secs(15));
    assert!(matches!(booth.view().stage, ExhibitStage::Visit { .. }));
    booth.check_limits();
}

#[test]
fn an_empty_hand_closes_on_nothing_and_opens() {
    let mut booth = Booth::with(Object::none());
    booth.press();
    booth.run_until(|own| own.index() < 800.0);
    booth.run_until(|own| own.index() > 990.0);
    assert_eq!(booth.view().hold, None);
    booth.check_limits();
}

#[test]
fn another_tile_takes_the_place_of_a_hold_and_stop_keeps_what_is_held() {
    let mut booth = Booth::with(ball(10.0));
    booth.press();
    booth.run_until(Booth::holds);
    booth.wish(ExhibitWish::Press(0));
    booth.run_until(|own| own.index() > 990.0);
    assert_eq!(booth.view().hold, None);
    let mut booth = Booth::with(ball(10.0));
    booth.press();
    booth.run_until(Booth::holds);
    booth.run_for(Duration::from_secs(3));
    booth.wish(ExhibitWish::Stop);
    let seen = Seen {
        status: &booth.status,
        sample: &booth.hand.sample,
        stall: None,
        now: booth.hand.now,
    };
    assert_eq!(booth.run.tick(&seen), Some(Order::Stop));
    assert!(booth.hand.sim.held().held);
}
