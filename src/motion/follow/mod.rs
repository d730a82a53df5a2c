//! A hand that follows a source (gamepad, stream, another hand) under a lease that the user granted. `inputs` decides when and how far
//! it moves; this program executes that.

pub mod step;
#[cfg(test)]
mod step_tests;

use crate::hand::gap::{Gap, SizeBlocks};
use crate::hand::grip::GripEstimator;
use crate::hand::hold_forces::HoldForces;
use crate::hand::overshoot::OvershootMap;
use crate::hand::{
    Angle, ArmEpoch, Dof, DriveHeat, Groups, HandSample, Moment, PerDof, Setpoints, Speed,
};
use crate::inputs::offer::HOLD_TIMEOUT;
use crate::inputs::{Offer, OfferLimits};
use crate::link::{ArmRequest, Clock, HoldToRun, Lease, LinkHandle, PollRates};
use crate::motion::drive::{ArmedBy, DriveStart, drive};
use crate::motion::follow::step::{Follow, FollowInput, FollowLimits, FollowPhase};
use crate::motion::hold::{self, HoldEnd, HoldStart, HoldView};
use crate::motion::hosted_hold::HostedHold;
use crate::motion::program::{AfterAbort, Ended, Order, Program, Progress, Seen};
use crate::record::{Abort, ArmRefusal, Disarmed};
use futures::stream::poll_fn;
use serde::Serialize;
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
    /// Speeds and forces to arm with; a hold exceeds neither.
    pub arm: ArmRequest,
    /// Grip estimate from the readings so far.
    pub grip: GripEstimator,
    /// Overshoot measured on this hand.
    pub overshoot: OvershootMap,
    /// Blocks measured with this hand, for the size of what a hold holds.
    pub blocks: SizeBlocks,
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
    /// The hold that the source requests; `None` while it requests none.
    pub hold: Option<FollowHold>,
}

/// A hold that a source requests, for display.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FollowHold {
    /// Its state.
    #[serde(flatten)]
    pub view: HoldView,
    /// How it ended; `None` while it runs. It does not begin again before the source requests something else.
    pub end: Option<HoldEnd>,
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
        hold: None,
        restores: PerDof::splat(false),
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
    /// The requested hold, also one that has ended.
    hold: Option<(HoldForces, HostedHold)>,
    /// Joints whose next target restores the speed and threshold of following.
    restores: PerDof<bool>,
    end: Option<Ended<()>>,
}

impl Program for FollowProgram {
    type Input = Offer;
    type Outcome = ();
    type View = Option<FollowView>;
    type Event = Infallible;
    const AFTER_ABORT: AfterAbort = AfterAbort::StopAfterLinkLoss;

    fn rates(&self) -> Option<PollRates> {
        self.hold.as_ref().map(|_| hold::RATES)
    }

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

    fn read(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        let read = sample.newest(fresh).unwrap_or_default();
        self.start.grip.apply(sample, fresh, read);
        if let Some((_, hold)) = &mut self.hold {
            hold.read(sample, fresh, now);
        }
    }

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
        match self.follow.phase() {
            FollowPhase::Holding => order = self.hold_on(seen, &terms),
            // Position and thresholds stay while the source is silent; a close is held as any other motion, and begins anew.
            FollowPhase::Silent if self.keeps_hold(seen.now) => {}
            _ => self.hold = None,
        }
        let order = match order {
            Some(Order::Set(setpoints)) if self.hold.is_none() => self.limit(setpoints),
            Some(Order::GiveBack(why)) => {
                self.end.get_or_insert(Ok(()));
                Some(Order::GiveBack(why))
            }
            order => order,
        };
        self.show(self.seen(&pose, seen), seen.now);
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
    /// True if the hold keeps an object, or has ended.
    fn keeps_hold(&self, now: Moment) -> bool {
        let hold = self.hold.as_ref();
        hold.is_some_and(|(_, hold)| hold.end().is_some() || hold.is_holding(now))
    }

    /// Advances the requested hold. Other forces begin another hold, with what is held; other targets do not.
    fn hold_on(&mut self, seen: &Seen<'_>, terms: &FollowTerms) -> Option<Order> {
        let ((forces, close), epoch) = self.follow.requested_hold().zip(seen.status.armed)?;
        let is_requested =
            |(own, hold): &(HoldForces, HostedHold)| *own == forces && hold.epoch() == epoch;
        if !self.hold.as_ref().is_some_and(is_requested) {
            let start = HoldStart {
                close,
                forces,
                duration: None,
                reading_per_g: PerDof::splat(1.0),
                locked: terms.locked,
                overshoot: self.start.overshoot.clone(),
                blocks: self.start.blocks.clone(),
                grip: self.start.grip.clone(),
            };
            let hold = HostedHold::new(epoch, start, self.hold_limits(terms), seen.now);
            self.hold = Some((forces, hold));
            self.restores = PerDof::splat(true);
        }
        let (_, hold) = self.hold.as_mut()?;
        let sent = hold.tick(seen, &terms.locked);
        if hold.is_holding(seen.now) || hold.end().is_some() {
            self.follow.enter();
        } else if let Some(sent) = &sent {
            self.follow.steer(&sent.angle);
        }
        sent.map(Order::Set)
    }

    /// Highest speeds and thresholds of a hold: those of the arming, and the maximum rate.
    fn hold_limits(&self, terms: &FollowTerms) -> ArmRequest {
        let rate = f64::from(terms.limits.within().rate);
        #[expect(clippy::cast_possible_truncation, reason = "a rate of at most 1700")]
        let fastest = Speed::nearest((rate / Speed::nearest(1).angle_per_s()) as i64);
        ArmRequest {
            speed: self.start.arm.speed.map(|speed| speed.min(fastest)),
            force: self.start.arm.force,
        }
    }

    /// Adds limits that were not sent under this arming yet; `None` if nothing remains to be sent.
    fn limit(&mut self, mut setpoints: Setpoints) -> Option<Order> {
        let epoch = setpoints.epoch;
        let is_new = self.limited != Some((epoch, self.limits));
        let is_silent = self.follow.phase() == FollowPhase::Silent;
        for dof in Dof::ALL {
            let restores = self.restores[dof];
            // A threshold that rises without a new target, or while the source is silent, would press harder.
            if restores && (is_silent || setpoints.angle[dof].is_none()) {
                continue;
            }
            if is_new || restores {
                let own = self.start.arm;
                let force = self.limits.force[dof];
                setpoints.force[dof] = force.or(restores.then_some(own.force[dof]));
                let speed = self.limits.speed[dof];
                setpoints.speed[dof] = speed.or(restores.then_some(own.speed[dof]));
                self.restores[dof] = false;
            }
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
        let hold = |view: FollowView| {
            view.hold
                .map(|hold| (hold.view.phase, hold.view.last, hold.end))
        };
        let is_shown = |(before, since): (FollowView, Moment)| {
            (view.phase, view.sent, hold(view)) == (before.phase, before.sent, hold(before))
                && now.since(since) < REPORT_INTERVAL
        };
        if !self.shown.is_some_and(is_shown) {
            self.shown = Some((view, now));
        }
    }

    fn seen(&self, pose: &PerDof<Option<Angle>>, seen: &Seen<'_>) -> FollowView {
        let lead = |dof: Dof| {
            let (to, at) = self.follow.sent()[dof].zip(pose[dof])?;
            Some(to.get().abs_diff(at.get()))
        };
        FollowView {
            phase: self.follow.phase(),
            sent: *self.follow.sent(),
            lead: Dof::ALL.into_iter().filter_map(lead).max().unwrap_or(0),
            delay_p99: self.delays.p99(),
            heat: seen.status.heat,
            hold: self.hold.as_ref().map(|(_, hold)| FollowHold {
                view: hold.view(seen.now),
                end: hold.end(),
            }),
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
