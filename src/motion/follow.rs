//! A hand that follows a source (gamepad, stream, another hand) under a lease that the user granted. `inputs` decides when and how far
//! it moves; this program executes that.

use crate::hand::gap::Gap;
use crate::hand::{Angle, ArmEpoch, Dof, DriveHeat, Groups, HandSample, Moment, PerDof, Setpoints};
use crate::inputs::offer::HOLD_TIMEOUT;
use crate::inputs::{Offer, OfferLimits};
use crate::link::{ArmRequest, Clock, HoldToRun, Lease, LinkHandle};
use crate::motion::drive::{ArmedBy, DriveStart, drive};
use crate::motion::following::{Follow, FollowInput, FollowLimits, FollowPhase};
use crate::motion::program::{AfterAbort, Ended, Order, Program, Progress, Seen};
use crate::record::{Abort, ArmRefusal, Disarmed};
use futures::stream::poll_fn;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::time::Duration;
use tokio::sync::{mpsc, watch};

/// The reported delay covers this many targets.
const DELAYS: usize = 512;
/// Interval of view updates while only figures change.
const REPORT_INTERVAL: Duration = Duration::from_millis(100);

/// Limits that the user sets for a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FollowTerms {
    /// Maximum lead and rate.
    pub limits: FollowLimits,
    /// Locked joints, which do not move.
    pub locked: PerDof<bool>,
    /// Key that the user has to hold at this machine, if required.
    pub hold: HoldToRun,
}

/// Settings and rights with which following begins.
#[derive(Debug, Clone)]
pub struct FollowStart {
    /// The right to move the hand, granted by the user for this source.
    pub lease: Lease,
    /// Limits set by the user; they may change while the program runs.
    pub terms: watch::Receiver<FollowTerms>,
    /// Speeds and forces to arm with.
    pub arm: ArmRequest,
    /// Newest readings.
    pub seen: HandSample,
    /// The program's clock.
    pub clock: Clock,
}

/// State of following, for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowView {
    /// Phase of following, as the window shows it.
    pub phase: FollowPhase,
    /// Newest target of each joint; `None` if none was sent.
    pub sent: PerDof<Option<Angle>>,
    /// Largest difference between target and actual angle over all joints, counts.
    pub lead: u16,
    /// Delay between the arrival of a target and its first byte on the wire, 99th percentile.
    pub delay_p99: Option<Duration>,
    /// The warmest drive, if one is warm.
    pub heat: Option<DriveHeat>,
}

/// Follows a source until it falls silent or is closed, which stops the hand and gives control back, or the lease ends.
pub async fn follow(
    hand: &LinkHandle,
    start: FollowStart,
    mut offers: mpsc::Receiver<Offer>,
    mut report: impl FnMut(FollowView),
) -> Ended<()> {
    let clock = start.clock;
    let begin = DriveStart {
        armed_by: ArmedBy::Program,
        lease: Some(start.lease),
        seen: start.seen,
        clock,
    };
    let limits = start.terms.borrow().limits;
    let program = FollowProgram {
        follow: Follow::new(limits, clock.now()),
        shown: None,
        delays: Delays::default(),
        limits: OfferLimits::NONE,
        limited: None,
        end: None,
        start,
    };
    let offers = poll_fn(move |context| offers.poll_recv(context));
    let driven = drive(hand, begin, program, offers, |progress| {
        if let Progress::View(Some(view)) = progress {
            report(view);
        }
        true
    });
    driven.await.end
}

struct FollowProgram {
    start: FollowStart,
    follow: Follow,
    /// State for display, and the time of its last change.
    shown: Option<(FollowView, Moment)>,
    delays: Delays,
    /// Newest force and speed limits from the source.
    limits: OfferLimits,
    /// Limits that were sent to the hand, and the arming under which.
    limited: Option<(ArmEpoch, OfferLimits)>,
    end: Option<Ended<()>>,
}

impl Program for FollowProgram {
    type Input = Offer;
    type Outcome = ();
    type View = Option<FollowView>;
    type Event = Infallible;
    const AFTER_ABORT: AfterAbort = AfterAbort::StopAfterLinkLoss;

    fn input(&mut self, mut offer: Offer, _seen: &Seen<'_>) -> Option<Order> {
        let locked = self.start.terms.borrow().locked;
        for (dof, aim) in offer.aims.iter_mut() {
            *aim = aim.filter(|_| !locked[dof]);
        }
        if offer.gap.is_some() && Gap::JOINTS.into_iter().any(|dof| locked[dof]) {
            // If one of these joints is locked there is no path, and no other joint closes beside it.
            offer.gap = None;
            offer.aims = PerDof::splat(None);
        }
        self.limits.merge(&offer.limits);
        self.follow.offer(offer);
        self.delays.offered = Some(offer.at);
        // If this program hangs, the link stops the hand by itself.
        (offer.held == Some(true)).then(|| Order::RunUntil(offer.at.plus(HOLD_TIMEOUT)))
    }

    fn input_ended(&mut self, _seen: &Seen<'_>) -> Option<Order> {
        self.end.get_or_insert(Ok(()));
        Some(Order::GiveBack(Disarmed::Silent))
    }

    fn read(&mut self, _sample: &HandSample, _fresh: Groups, _now: Moment) {}

    fn armed(&mut self, _answer: Result<ArmEpoch, ArmRefusal>) -> Option<Order> {
        self.follow.answered();
        None
    }

    fn sent(&mut self, at: Moment) {
        self.delays.sent(at);
    }

    fn tick(&mut self, seen: &Seen<'_>) -> Option<Order> {
        let terms = *self.start.terms.borrow();
        self.follow.limit(terms.limits);
        let angle = seen.angles();
        let pose = PerDof::from_fn(|dof| angle.and_then(|angle| angle.value[dof].hold()));
        let input = FollowInput {
            state: seen.status.state,
            epoch: seen.status.armed,
            arm: self.start.arm,
            pose,
            held: terms.hold.is_held(seen.now),
        };
        let mut order = self.follow.tick(input, seen.now);
        if order.is_none() && self.follow.phase() == FollowPhase::Following {
            order = seen.status.armed.map(Setpoints::none).map(Order::Set);
        }
        let order = match order {
            Some(Order::Set(setpoints)) => self.limit(setpoints),
            Some(Order::GiveBack(why)) => {
                self.end.get_or_insert(Ok(()));
                Some(Order::GiveBack(why))
            }
            order => order,
        };
        self.show(self.seen(&pose, seen.status.heat), seen.now);
        order
    }

    fn abort(&mut self, why: Abort, _now: Moment) {
        self.end.get_or_insert(Err(why));
    }

    fn view(&self, _now: Moment) -> Option<FollowView> {
        self.shown.map(|(view, _)| view)
    }

    fn ended(&self) -> Option<Ended<()>> {
        self.end
    }
}

impl FollowProgram {
    /// Adds limits that were not sent under this arming yet; `None` if nothing remains to be sent.
    fn limit(&mut self, mut setpoints: Setpoints) -> Option<Order> {
        let epoch = setpoints.epoch;
        if self.limited != Some((epoch, self.limits)) {
            (setpoints.force, setpoints.speed) = (self.limits.force, self.limits.speed);
        }
        if setpoints.is_empty() {
            return None;
        }
        self.limited = Some((epoch, self.limits));
        if setpoints.angle.iter().any(|(_, aim)| aim.is_some()) {
            self.delays.set();
        }
        Some(Order::Set(setpoints))
    }

    /// Shows a new state at once if the phase or the targets changed, otherwise at [`REPORT_INTERVAL`].
    fn show(&mut self, view: FollowView, now: Moment) {
        let is_shown = |(before, since): (FollowView, Moment)| {
            (view.phase, view.sent) == (before.phase, before.sent)
                && now.since(since) < REPORT_INTERVAL
        };
        if !self.shown.is_some_and(is_shown) {
            self.shown = Some((view, now));
        }
    }

    fn seen(&self, pose: &PerDof<Option<Angle>>, heat: Option<DriveHeat>) -> FollowView {
        let lead = |dof: Dof| {
            let (to, at) = self.follow.sent()[dof].zip(pose[dof])?;
            Some(to.get().abs_diff(at.get()))
        };
        FollowView {
            phase: self.follow.phase(),
            sent: *self.follow.sent(),
            lead: Dof::ALL.into_iter().filter_map(lead).max().unwrap_or(0),
            delay_p99: self.delays.p99(),
            heat,
        }
    }
}

/// Delays between the arrival of targets and their transmission.
#[derive(Debug, Default)]
struct Delays {
    /// Arrival of the newest target, until it is set.
    offered: Option<Moment>,
    /// Arrival of the target that was set and is not on the wire yet.
    set: Option<Moment>,
    all: VecDeque<Duration>,
}

impl Delays {
    fn set(&mut self) {
        if let Some(offered) = self.offered.take() {
            // A target that a newer one replaced before transmission does not count as sent.
            self.set = Some(offered);
        }
    }

    fn sent(&mut self, at: Moment) {
        if let Some(offered) = self.set.take() {
            if self.all.len() >= DELAYS {
                self.all.pop_front();
            }
            self.all.push_back(at.since(offered));
        }
    }

    fn p99(&self) -> Option<Duration> {
        let mut sorted: Vec<Duration> = self.all.iter().copied().collect();
        sorted.sort_unstable();
        let last = sorted.len().checked_sub(1)?;
        sorted.get(last * 99 / 100).copied()
    }
}
