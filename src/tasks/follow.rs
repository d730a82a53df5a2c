//! A hand that follows a source under a lease that the user granted: gamepad, stream, another hand. When it moves, and how far, is decided
//! in `inputs`; here it is done.

use crate::hand::gap::Gap;
use crate::hand::{
    Angle, AngleReading, ArmEpoch, Dof, DriveHeat, HandSample, Moment, PerDof, Setpoints, Target,
};
use crate::inputs::follow::{
    Follow, FollowInput, FollowLimits, FollowOrder, FollowPhase, HOLDS_AFTER,
};
use crate::inputs::{Offer, OfferLimits};
use crate::link::{ArmRequest, Clock, HoldToRun, Lease, LeaseRefusal};
use crate::record::{Disarmed, Record, WriteCause};
use crate::tasks::hand::TaskHand;
use std::collections::VecDeque;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::sleep;

/// How often time is looked at where nothing is offered or read.
const TICK: Duration = Duration::from_millis(5);
/// The delay that is told is that of so many targets.
const DELAYS: usize = 512;
/// Offers and records that are looked at before the hand is again: whoever sends without a pause keeps nothing else waiting.
const AT_ONCE: usize = 64;
/// How often the view is told while only its figures change.
const TELL_EACH: Duration = Duration::from_millis(100);

/// What the user allows a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FollowTerms {
    /// How far and how fast.
    pub limits: FollowLimits,
    /// Joints that stay where they are.
    pub locked: PerDof<bool>,
    /// What the user here has to hold.
    pub hold: HoldToRun,
}

/// Settings and rights with which following begins.
#[derive(Debug, Clone)]
pub struct FollowStart {
    /// The right to move the hand, granted by the user for this source.
    pub lease: Lease,
    /// What the user allows, also while it goes on.
    pub terms: watch::Receiver<FollowTerms>,
    /// Speeds and forces to arm with.
    pub arm: ArmRequest,
    /// What was read until now.
    pub seen: HandSample,
    /// The program's clock.
    pub clock: Clock,
}

/// What is shown of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowView {
    /// Phase of following, as the window shows it.
    pub phase: FollowPhase,
    /// Where the joints were sent.
    pub sent: PerDof<Option<Angle>>,
    /// Counts that targets are ahead of their joints, at most.
    pub lead: u16,
    /// From a target's arrival to its first byte on the wire, 99 of 100.
    pub delay_p99: Option<Duration>,
    /// The warmest drive, if one is warm.
    pub heat: Option<DriveHeat>,
}

/// Why it ended. The hand was stopped, by this or by what ended it, unless another moves it now or its link was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FollowEnd {
    /// The source sent nothing for too long.
    Silent,
    /// The source was closed or unplugged.
    Gone,
    /// The lease ended, or another has it.
    Lease(LeaseRefusal),
}

/// Follows until the source or the lease ends.
pub async fn follow<H: TaskHand>(
    hand: &H,
    start: FollowStart,
    mut offers: mpsc::Receiver<Offer>,
    mut tell: impl FnMut(FollowView),
) -> FollowEnd {
    let clock = start.clock;
    let mut records = hand.records();
    let limits = start.terms.borrow().limits;
    let mut at = FollowRun {
        follow: Follow::new(limits, clock.now()),
        sample: start.seen,
        delays: Delays::default(),
        limits: OfferLimits::NONE,
        limited: None,
        hand,
        start,
    };
    let mut told: Option<(FollowView, Moment)> = None;
    loop {
        tokio::select! {
            biased;
            // Feedback comes at the hand's own pace, offers at any.
            Some(record) = records.next() => at.heard(&record),
            offer = offers.recv() => match offer {
                Some(offer) => at.take(offer),
                None => {
                    at.give_back(Disarmed::Silent);
                    return FollowEnd::Gone;
                }
            },
            () = sleep(TICK) => {}
        }
        for _ in 0..AT_ONCE {
            let (record, offer) = (records.try_next(), offers.try_recv().ok());
            if record.is_none() && offer.is_none() {
                break;
            }
            record.iter().for_each(|record| at.heard(record));
            // The newest of what waits.
            offer.into_iter().for_each(|offer| at.take(offer));
        }
        if let Err(refused) = hand.check(at.start.lease) {
            at.lease_ended(refused);
            return FollowEnd::Lease(refused);
        }
        if let Some(end) = at.go_on() {
            return end;
        }
        let now = clock.now();
        let is_due = |(view, when): (FollowView, Moment)| {
            view.phase != at.follow.phase()
                || view.sent != *at.follow.sent()
                || now.since(when) >= TELL_EACH
        };
        if told.is_none_or(is_due) {
            let view = at.view();
            told = Some((view, now));
            tell(view);
        }
    }
}

struct FollowRun<'a, H> {
    hand: &'a H,
    start: FollowStart,
    follow: Follow,
    sample: HandSample,
    delays: Delays,
    /// What the source asked for last.
    limits: OfferLimits,
    /// What the hand was told of it, under which arming.
    limited: Option<(ArmEpoch, OfferLimits)>,
}

impl<H: TaskHand> FollowRun<'_, H> {
    fn take(&mut self, mut offer: Offer) {
        let locked = self.start.terms.borrow().locked;
        for (dof, aim) in offer.aims.iter_mut() {
            *aim = aim.filter(|_| !locked[dof]);
        }
        if offer.gap.is_some() && Gap::JOINTS.into_iter().any(|dof| locked[dof]) {
            // Without one of them there is no path, and nothing is closed beside it.
            offer.gap = None;
            offer.aims = PerDof::splat(None);
        }
        if offer.held == Some(true) {
            // Should this task hang, the link stops the hand by itself. A lease that ended is seen in the next step.
            let _put_off = self
                .hand
                .run_until(self.start.lease, offer.at.plus(HOLDS_AFTER));
        }
        self.limits.merge(&offer.limits);
        self.follow.offer(offer);
        self.delays.offered = Some(offer.at);
    }

    fn heard(&mut self, record: &Record) {
        match record {
            Record::Reading { sample, .. } => self.sample = **sample,
            Record::Sent { at, cause, .. } if *cause == WriteCause::Setpoint => {
                self.delays.sent(*at);
            }
            _ => {}
        }
    }

    /// Where each joint is, if that is known freshly.
    fn pose(&self) -> PerDof<Option<Angle>> {
        let now = self.start.clock.now();
        let fresh_for = self.hand.status().fresh_for();
        let angle = self.sample.angle;
        let angle = angle.filter(|angle| angle.age(now) <= fresh_for);
        PerDof::from_fn(|dof| angle.and_then(|angle| AngleReading::hold(angle.value[dof])))
    }

    /// Does what is to be done now; why it ended, if it did.
    fn go_on(&mut self) -> Option<FollowEnd> {
        let terms = *self.start.terms.borrow();
        self.follow.limit(terms.limits);
        let status = self.hand.status();
        let seen = FollowInput {
            state: status.state,
            pose: self.pose(),
            held: terms.hold.is_held(self.start.clock.now()),
        };
        let lease = self.start.lease;
        let done = match self.follow.tick(seen, self.start.clock.now()) {
            Some(FollowOrder::Arm) => self.hand.arm(lease, self.start.arm),
            Some(FollowOrder::Halt) => self.hand.halt(lease),
            Some(FollowOrder::End) => {
                self.give_back(Disarmed::Silent);
                return Some(FollowEnd::Silent);
            }
            Some(FollowOrder::Aim(aims)) => self.set(status.armed?, &aims),
            None if self.follow.phase() == FollowPhase::Following => {
                self.set(status.armed?, &PerDof::splat(None))
            }
            None => return None,
        };
        let refused = done.err()?;
        self.lease_ended(refused);
        Some(FollowEnd::Lease(refused))
    }

    /// Sends targets, and limits that the hand was not told under this arming yet.
    fn set(&mut self, epoch: ArmEpoch, aims: &PerDof<Option<Angle>>) -> Result<(), LeaseRefusal> {
        let mut setpoints = Setpoints::none(epoch);
        setpoints.angle = aims.map(|aim| aim.map(Target::Go));
        if self.limited != Some((epoch, self.limits)) {
            (setpoints.force, setpoints.speed) = (self.limits.force, self.limits.speed);
        }
        if setpoints.is_empty() {
            return Ok(());
        }
        self.hand.set(self.start.lease, &setpoints)?;
        self.limited = Some((epoch, self.limits));
        if aims.iter().any(|(_, aim)| aim.is_some()) {
            self.delays.set();
        }
        Ok(())
    }

    /// The hand is stopped and the source may move it no more; if it may not any more already, it was.
    fn give_back(&self, why: Disarmed) {
        let _done = self.hand.give_back(self.start.lease, why);
    }

    /// Over a lost link the hand goes on to its last target: a stop waits for it.
    fn lease_ended(&self, refused: LeaseRefusal) {
        if refused == LeaseRefusal::Ended(Disarmed::LinkLost) {
            self.hand.stop();
        }
    }

    fn view(&self) -> FollowView {
        let pose = self.pose();
        let lead = |dof: Dof| {
            let (to, at) = self.follow.sent()[dof].zip(pose[dof])?;
            Some(to.get().abs_diff(at.get()))
        };
        FollowView {
            phase: self.follow.phase(),
            sent: *self.follow.sent(),
            lead: Dof::ALL.into_iter().filter_map(lead).max().unwrap_or(0),
            delay_p99: self.delays.p99(),
            heat: self.hand.status().heat,
        }
    }
}

/// From a target's arrival to the wire.
#[derive(Debug, Default)]
struct Delays {
    /// When the newest target came in, until it was set.
    offered: Option<Moment>,
    /// When the one came in that was set and is not on the wire yet.
    set: Option<Moment>,
    all: VecDeque<Duration>,
}

impl Delays {
    fn set(&mut self) {
        if let Some(offered) = self.offered.take() {
            // One that a newer one replaced before it was sent does not count as sent.
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
