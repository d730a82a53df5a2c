//! Following a source: from the current position, with bounded lead and rate, and not at all once the source is silent, frozen or
//! released. Pure: offers, poses and time in, orders out.

use crate::hand::gap::Gap;
use crate::hand::hold_forces::HoldForces;
use crate::hand::{Angle, ArmEpoch, Dof, Moment, PerDof, Setpoints, Target};
use crate::inputs::offer::{END_TIMEOUT, HOLD_TIMEOUT, Offer};
use crate::link::ArmRequest;
use crate::motion::hold::HoldClose;
use crate::motion::pinch::{self, PinchAim, PinchStep, StepLimits};
use crate::motion::program::Order;
use crate::record::{Disarmed, LinkState};
use std::time::Duration;

/// Targets that are bit-identical for this long, away from the ends of the range, may mean that tracking is frozen.
pub const FREEZE_TIMEOUT: Duration = Duration::from_millis(500);
/// The target of a hold follows the hand for this long, because the hand acts late; then it stays.
const HOLD_FOLLOWS: Duration = Duration::from_millis(120);
/// Interval between arming requests.
const REARM_DELAY: Duration = Duration::from_millis(500);
/// A late step moves no further than a timely one.
const STEP_LONGEST: Duration = Duration::from_millis(40);

/// Maximum lead and rate of targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct FollowLimits {
    /// Maximum lead, counts, see [`Self::LEAD`].
    pub lead: u16,
    /// Maximum rate, counts per second, see [`Self::RATE`].
    pub rate: u16,
}

impl FollowLimits {
    /// Smallest and largest lead, counts.
    pub const LEAD: (u16, u16) = (20, 500);
    /// Smallest and largest rate, counts per second: the hand's own maximum is 1667 (manual 2.6.13).
    pub const RATE: (u16, u16) = (50, 1700);

    /// Returns the nearest valid limits.
    #[must_use]
    pub fn within(self) -> Self {
        Self {
            lead: self.lead.clamp(Self::LEAD.0, Self::LEAD.1),
            rate: self.rate.clamp(Self::RATE.0, Self::RATE.1),
        }
    }
}

impl Default for FollowLimits {
    fn default() -> Self {
        Self {
            lead: 150,
            rate: 800,
        }
    }
}

/// Phase of following.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FollowPhase {
    /// Nothing moves yet: there is no target, or the hand is not armed.
    Waiting,
    /// The hand follows.
    Following,
    /// The hand follows, and the source repeats the same bits.
    Frozen,
    /// The source requests a hold.
    Holding,
    /// The source is silent: the hand is held.
    Silent,
    /// The dead-man switch is released: the hand was stopped.
    Released,
}

/// State of the hand in one step.
#[derive(Debug, Clone, Copy)]
pub struct FollowInput {
    /// State of its link.
    pub state: LinkState,
    /// Arming under which the hand may move; `None` while it is disarmed.
    pub epoch: Option<ArmEpoch>,
    /// Limits to arm with.
    pub arm: ArmRequest,
    /// Fresh angles of the joints; `None` where there is none.
    pub pose: PerDof<Option<Angle>>,
    /// True while the user at this machine holds the key; `None` if none is required.
    pub held: Option<bool>,
}

/// One source that a hand follows.
#[derive(Debug, Clone)]
pub struct Follow {
    limits: FollowLimits,
    began: Moment,
    phase: FollowPhase,
    newest: Option<Offer>,
    /// Time since which targets have been bit-identical.
    same_since: Moment,
    /// Newest target of each joint, finer than counts; `None` starts from the joint's position.
    targets: PerDof<Option<f32>>,
    sent: PerDof<Option<Angle>>,
    /// Thumb and index were open for the requested gap, and now follow their path to it.
    is_pinching: bool,
    stepped: Moment,
    /// Time of the last arming request.
    asked_to_arm: Option<Moment>,
    /// An arming request has no answer yet.
    is_arming: bool,
}

impl Follow {
    /// Starts without an offer.
    pub fn new(limits: FollowLimits, now: Moment) -> Self {
        Self {
            limits: limits.within(),
            began: now,
            phase: FollowPhase::Waiting,
            newest: None,
            same_since: now,
            targets: PerDof::splat(None),
            sent: PerDof::splat(None),
            is_pinching: false,
            stepped: now,
            asked_to_arm: None,
            is_arming: false,
        }
    }

    /// Current phase.
    pub const fn phase(&self) -> FollowPhase {
        self.phase
    }

    /// Newest target sent to each joint.
    pub const fn sent(&self) -> &PerDof<Option<Angle>> {
        &self.sent
    }

    /// The hold that the newest offer requests, with what it closes to.
    pub(crate) fn requested_hold(&self) -> Option<(HoldForces, HoldClose)> {
        let offer = self.newest?;
        let has_aims = offer.aims.iter().any(|(_, aim)| aim.is_some());
        let close = match offer.gap {
            Some(gap) => HoldClose::Pinch(gap),
            None if has_aims => HoldClose::To(offer.aims),
            None => HoldClose::TakeOver,
        };
        Some((offer.hold?, close))
    }

    /// Notes the targets of a hold that closes: silence holds these joints where they are.
    pub(crate) fn steer(&mut self, targets: &PerDof<Option<Target>>) {
        for (dof, to) in targets.iter() {
            if let Some(to) = to.and_then(Target::angle) {
                self.targets[dof] = Some(f32::from(to.get()));
                self.sent[dof] = Some(to);
            }
        }
    }

    /// Changes the limits.
    pub fn limit(&mut self, limits: FollowLimits) {
        self.limits = limits.within();
    }

    /// Receives the answer to an arming request; after a refusal it is repeated.
    pub(crate) const fn answered(&mut self) {
        self.is_arming = false;
    }

    /// Receives a newer offer.
    pub fn offer(&mut self, offer: Offer) {
        let before = self.newest.replace(offer);
        let is_same = before.is_some_and(|before| {
            offer.mark.is_some() && before.mark == offer.mark && before.held == offer.held
        });
        if is_same {
            return;
        }
        self.same_since = offer.at;
        if self.phase == FollowPhase::Frozen {
            // The source may have moved meanwhile: start again as on entering.
            self.enter();
        }
    }

    /// Advances the time.
    pub fn tick(&mut self, seen: FollowInput, now: Moment) -> Option<Order> {
        let age = now.since(self.newest.map_or(self.began, |offer| offer.at));
        if age >= END_TIMEOUT {
            return Some(Order::GiveBack(Disarmed::Silent));
        }
        let offer = self.newest?;
        let is_silent = age >= HOLD_TIMEOUT;
        let is_let_go = [offer.held, seen.held].contains(&Some(false));
        if is_let_go || is_silent && offer.held.is_some() {
            let phase = if is_silent {
                FollowPhase::Silent
            } else {
                FollowPhase::Released
            };
            return self.halt(phase, seen.state);
        }
        if is_silent {
            return self.hold(seen, age);
        }
        let Some(epoch) = seen.epoch.filter(|_| seen.state == LinkState::Armed) else {
            self.enter();
            self.phase = FollowPhase::Waiting;
            let is_due = |at| !self.is_arming && now.since(at) >= REARM_DELAY;
            if seen.state == LinkState::Monitoring && self.asked_to_arm.is_none_or(is_due) {
                (self.asked_to_arm, self.is_arming) = (Some(now), true);
                return Some(Order::Arm(seen.arm));
            }
            return None;
        };
        (self.asked_to_arm, self.is_arming) = (None, false);
        let holds = offer.hold.is_some();
        if self.phase == FollowPhase::Silent || holds != (self.phase == FollowPhase::Holding) {
            self.enter();
        }
        if holds {
            // A hold steps by itself, and may request the same for a long time.
            self.phase = FollowPhase::Holding;
            return None;
        }
        // A gap is one number, which may legitimately stay the same for a long time.
        let is_frozen = offer.mark.is_some()
            && offer.gap.is_none()
            && now.since(self.same_since) >= FREEZE_TIMEOUT
            && is_away_from_ends(&offer.aims);
        self.phase = if is_frozen {
            FollowPhase::Frozen
        } else {
            FollowPhase::Following
        };
        self.step(epoch, &offer, &seen.pose, now)
    }

    /// Starts from the positions of the joints, discarding previous targets.
    pub(crate) fn enter(&mut self) {
        self.targets = PerDof::splat(None);
        self.sent = PerDof::splat(None);
        self.is_pinching = false;
    }

    /// Stops a hand that may move; once held again, following starts anew.
    fn halt(&mut self, phase: FollowPhase, state: LinkState) -> Option<Order> {
        self.enter();
        (self.asked_to_arm, self.is_arming) = (None, false);
        self.phase = phase;
        (state == LinkState::Armed).then_some(Order::Halt)
    }

    /// Makes the current position of the hand its target.
    fn hold(&mut self, seen: FollowInput, age: Duration) -> Option<Order> {
        let steered = self.targets.map(|target| target.is_some());
        let follows = age < HOLD_TIMEOUT + HOLD_FOLLOWS;
        let was_silent = std::mem::replace(&mut self.phase, FollowPhase::Silent);
        let epoch = seen.epoch.filter(|_| seen.state == LinkState::Armed);
        let Some(epoch) = epoch.filter(|_| follows || was_silent != FollowPhase::Silent) else {
            self.enter();
            return None;
        };
        let pose = PerDof::from_fn(|dof| seen.pose[dof].filter(|_| steered[dof]));
        self.send(epoch, pose)
    }

    fn step(
        &mut self,
        epoch: ArmEpoch,
        offer: &Offer,
        pose: &PerDof<Option<Angle>>,
        now: Moment,
    ) -> Option<Order> {
        let elapsed = now
            .since(std::mem::replace(&mut self.stepped, now))
            .min(STEP_LONGEST);
        let reach = StepLimits {
            step: f32::from(self.limits.rate) * elapsed.as_secs_f32(),
            lead: f32::from(self.limits.lead),
        };
        match offer.gap {
            Some(gap) => {
                // A locked or unchanged joint has no aim.
                let moves = offer.aims.map(|aim| aim.is_some());
                self.step_to_gap(PinchAim { gap, moves }, pose, reach);
            }
            None => {
                self.is_pinching = false;
                self.step_each(&offer.aims, pose, reach);
            }
        }
        let targets = PerDof::from_fn(|dof| {
            let target = self.targets[dof].filter(|_| pose[dof].is_some())?;
            #[expect(clippy::cast_possible_truncation, reason = "rounded, and in range")]
            Some(Angle::nearest(target.round() as i64))
        });
        self.send(epoch, targets)
    }

    /// Steps each joint independently.
    fn step_each(
        &mut self,
        aims: &PerDof<Option<Angle>>,
        pose: &PerDof<Option<Angle>>,
        reach: StepLimits,
    ) {
        for dof in Dof::ALL {
            let Some((aim, at)) = aims[dof].zip(pose[dof]) else {
                // A joint with unknown angle receives no target; a joint without an aim is unchanged.
                self.targets[dof] = self.targets[dof].filter(|_| aims[dof].is_some());
                continue;
            };
            let (aim, at) = (f32::from(aim.get()), f32::from(at.get()));
            self.targets[dof] = Some(match self.targets[dof] {
                None => at,
                Some(from) => {
                    let to = aim.clamp(at - reach.lead, at + reach.lead);
                    from + (to - from).clamp(-reach.step, reach.step)
                }
            });
        }
    }

    /// Steps thumb and index together along the path on which their pads meet, once they are open for it. If one of them is not known
    /// or may not move, neither advances.
    fn step_to_gap(&mut self, aim: PinchAim, pose: &PerDof<Option<Angle>>, reach: StepLimits) {
        let PinchAim { gap, moves } = aim;
        if !Gap::JOINTS.into_iter().all(|dof| moves[dof]) {
            return;
        }
        let Some(is_open) = pinch::is_open(pose) else {
            return;
        };
        if !self.is_pinching && is_open {
            self.is_pinching = true;
            for dof in Gap::JOINTS {
                self.targets[dof] = None;
            }
        }
        let at = pose.map(|at| f32::from(at.unwrap_or(Angle::MAX).get()));
        let sent = PerDof::from_fn(|dof| self.targets[dof].unwrap_or(at[dof]));
        let step = if self.is_pinching {
            pinch::along(&sent, gap)
        } else {
            pinch::opening(pose)
        };
        match step {
            PinchStep::Open(aims) => {
                let aims = PerDof::from_fn(|dof| aims[dof].filter(|_| moves[dof]));
                self.step_each(&aims, pose, reach);
            }
            PinchStep::Along(to) => {
                // As for single joints, a motion starts from the position of the joint.
                let begins = Gap::JOINTS
                    .into_iter()
                    .any(|dof| self.targets[dof].is_none());
                let share = match begins {
                    true => 0.0,
                    false => pinch::share(&sent, &to, &at, reach),
                };
                let aims = PerDof::from_fn(|dof| moves[dof].then_some(to[dof]));
                self.step_each(&aims, pose, reach);
                for dof in Gap::JOINTS {
                    let way = f32::from(to[dof].get()) - sent[dof];
                    self.targets[dof] = Some(sent[dof] + share * way);
                }
            }
        }
    }

    /// Sends the targets that changed.
    fn send(&mut self, epoch: ArmEpoch, targets: PerDof<Option<Angle>>) -> Option<Order> {
        let news = PerDof::from_fn(|dof| targets[dof].filter(|to| self.sent[dof] != Some(*to)));
        for (dof, to) in news.iter() {
            self.sent[dof] = to.or(self.sent[dof].filter(|_| self.targets[dof].is_some()));
        }
        let mut setpoints = Setpoints::none(epoch);
        setpoints.angle = news.map(|to| to.map(Target::Go));
        (!setpoints.is_empty()).then_some(Order::Set(setpoints))
    }
}

/// True if a target is away from the ends of its range: a fully open hand or a fist may legitimately be commanded for a long time.
fn is_away_from_ends(aims: &PerDof<Option<Angle>>) -> bool {
    let mut aims = aims.iter().filter_map(|(_, aim)| *aim);
    aims.any(|aim| aim != Angle::MIN && aim != Angle::MAX)
}
