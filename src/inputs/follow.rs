//! How a hand follows a source: from where it is, never far ahead and never fast, and not at all once the source is silent,
//! frozen or let go. Pure: offers, poses and time in, orders out.

use crate::hand::gap::Gap;
use crate::hand::{Angle, Dof, Moment, PerDof};
use crate::inputs::offer::Offer;
use crate::inputs::pinch::{self, PinchAim, PinchStep, StepLimits};
use crate::record::LinkState;
use std::time::Duration;

/// A source that says nothing new for this long is held …
pub const HOLD_TIMEOUT: Duration = Duration::from_millis(200);
/// … and after this it may move the hand no more.
pub const END_TIMEOUT: Duration = Duration::from_secs(1);
/// Targets that are the same to the last bit for this long, away from the ends of the range: tracking is frozen?
pub const FREEZE_TIMEOUT: Duration = Duration::from_millis(500);
/// A hold follows the hand for this long, as it acts late; then it stays.
const HOLD_FOLLOWS: Duration = Duration::from_millis(120);
/// Arming is asked for again after this.
const REARM_DELAY: Duration = Duration::from_millis(500);
/// A look that comes late moves no further than one in time.
const STEP_LONGEST: Duration = Duration::from_millis(40);

/// True if who was heard last at `last` still speaks at `now`.
pub(crate) fn is_fresh(last: Moment, now: Moment) -> bool {
    now.since(last) < HOLD_TIMEOUT
}

/// How far ahead of a joint its target may be, and how fast it may go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct FollowLimits {
    /// Counts ahead at most, see [`Self::LEAD`].
    pub lead: u16,
    /// Counts a second at most, see [`Self::RATE`].
    pub rate: u16,
}

impl FollowLimits {
    /// Smallest and largest lead, counts.
    pub const LEAD: (u16, u16) = (20, 500);
    /// Smallest and largest rate, counts a second: the hand's own is 1667 at most (manual 2.6.13).
    pub const RATE: (u16, u16) = (50, 1700);

    /// The nearest limits that make sense.
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

/// What goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FollowPhase {
    /// Nothing moves yet: no target came, or the hand is not armed yet.
    Waiting,
    /// The hand follows.
    Following,
    /// The hand follows, and the source repeats itself to the last bit.
    Frozen,
    /// The source said nothing for a while: the hand is held.
    Silent,
    /// The dead-man is not held: the hand was stopped.
    Released,
}

/// What is known of the hand.
#[derive(Debug, Clone, Copy)]
pub struct FollowInput {
    /// Where its link stands.
    pub state: LinkState,
    /// Where the joints are; `None` where that is not known freshly.
    pub pose: PerDof<Option<Angle>>,
    /// Whether the user here holds what has to be held, if that has to be.
    pub held: Option<bool>,
}

/// What is to be done at the hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FollowOrder {
    /// Let setpoints pass.
    Arm,
    /// These joints go here; the others are left alone.
    Aim(PerDof<Option<Angle>>),
    /// Stop the hand; whoever holds the dead-man again goes on.
    Halt,
    /// Stop the hand; the source may move it no more.
    End,
}

/// One source that a hand follows.
#[derive(Debug, Clone)]
pub struct Follow {
    limits: FollowLimits,
    began: Moment,
    phase: FollowPhase,
    newest: Option<Offer>,
    /// Since when targets are the same to the last bit.
    same_since: Moment,
    /// Where each joint was sent, finer than counts; `None` enters from where the joint is.
    targets: PerDof<Option<f32>>,
    sent: PerDof<Option<Angle>>,
    /// Thumb and index were open for the gap that is wanted, and go to it by their path.
    is_pinching: bool,
    stepped: Moment,
    asked_to_arm: Option<Moment>,
}

impl Follow {
    /// Begins with nothing offered.
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
        }
    }

    /// What goes on.
    pub const fn phase(&self) -> FollowPhase {
        self.phase
    }

    /// Where the joints were sent last.
    pub const fn sent(&self) -> &PerDof<Option<Angle>> {
        &self.sent
    }

    /// Other limits from now on.
    pub fn limit(&mut self, limits: FollowLimits) {
        self.limits = limits.within();
    }

    /// Takes a newer target.
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
            // Nobody knows where it went meanwhile: as on entering.
            self.enter();
        }
    }

    /// Time goes on.
    pub fn tick(&mut self, seen: FollowInput, now: Moment) -> Option<FollowOrder> {
        let age = now.since(self.newest.map_or(self.began, |offer| offer.at));
        if age >= END_TIMEOUT {
            return Some(FollowOrder::End);
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
        if seen.state != LinkState::Armed {
            self.enter();
            self.phase = FollowPhase::Waiting;
            let is_due = |at| now.since(at) >= REARM_DELAY;
            if seen.state == LinkState::Monitoring && self.asked_to_arm.is_none_or(is_due) {
                self.asked_to_arm = Some(now);
                return Some(FollowOrder::Arm);
            }
            return None;
        }
        self.asked_to_arm = None;
        if self.phase == FollowPhase::Silent {
            self.enter();
        }
        // A gap is one number, which may rightly stay the same for long.
        let is_frozen = offer.mark.is_some()
            && offer.gap.is_none()
            && now.since(self.same_since) >= FREEZE_TIMEOUT
            && is_away_from_ends(&offer.aims);
        self.phase = if is_frozen {
            FollowPhase::Frozen
        } else {
            FollowPhase::Following
        };
        self.step(&offer, &seen.pose, now)
    }

    /// From where the joints are, whatever they were told before.
    fn enter(&mut self) {
        self.targets = PerDof::splat(None);
        self.sent = PerDof::splat(None);
        self.is_pinching = false;
    }

    /// Stops what may move; what is held again begins anew.
    fn halt(&mut self, phase: FollowPhase, state: LinkState) -> Option<FollowOrder> {
        self.enter();
        self.asked_to_arm = None;
        self.phase = phase;
        (state == LinkState::Armed).then_some(FollowOrder::Halt)
    }

    /// Where the hand is becomes its target.
    fn hold(&mut self, seen: FollowInput, age: Duration) -> Option<FollowOrder> {
        let steered = self.targets.map(|target| target.is_some());
        let follows = age < HOLD_TIMEOUT + HOLD_FOLLOWS;
        let was_silent = std::mem::replace(&mut self.phase, FollowPhase::Silent);
        if seen.state != LinkState::Armed || !follows && was_silent == FollowPhase::Silent {
            self.enter();
            return None;
        }
        let pose = PerDof::from_fn(|dof| seen.pose[dof].filter(|_| steered[dof]));
        self.send(pose)
    }

    fn step(
        &mut self,
        offer: &Offer,
        pose: &PerDof<Option<Angle>>,
        now: Moment,
    ) -> Option<FollowOrder> {
        let elapsed = now
            .since(std::mem::replace(&mut self.stepped, now))
            .min(STEP_LONGEST);
        let reach = StepLimits {
            step: f32::from(self.limits.rate) * elapsed.as_secs_f32(),
            lead: f32::from(self.limits.lead),
        };
        match offer.gap {
            Some(gap) => {
                // What is locked or left alone has no aim.
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
        self.send(targets)
    }

    /// Each joint by itself.
    fn step_each(
        &mut self,
        aims: &PerDof<Option<Angle>>,
        pose: &PerDof<Option<Angle>>,
        reach: StepLimits,
    ) {
        for dof in Dof::ALL {
            let Some((aim, at)) = aims[dof].zip(pose[dof]) else {
                // One that is not known is sent nowhere; one that is not aimed at is left alone.
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

    /// Thumb and index together along the path on which their pads meet, once they are open for it. Where one of them is not known
    /// or may not move, nothing goes on.
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
                // As each joint by itself: what begins begins where the joint is.
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

    /// Sends what is news to the joints.
    fn send(&mut self, targets: PerDof<Option<Angle>>) -> Option<FollowOrder> {
        let news = PerDof::from_fn(|dof| targets[dof].filter(|to| self.sent[dof] != Some(*to)));
        for (dof, to) in news.iter() {
            self.sent[dof] = to.or(self.sent[dof].filter(|_| self.targets[dof].is_some()));
        }
        let any = news.iter().any(|(_, to)| to.is_some());
        any.then_some(FollowOrder::Aim(news))
    }
}

/// A hand that is told to be wide open or a fist may rightly be told so for long.
fn is_away_from_ends(aims: &PerDof<Option<Angle>>) -> bool {
    let mut aims = aims.iter().filter_map(|(_, aim)| *aim);
    aims.any(|aim| aim != Angle::MIN && aim != Angle::MAX)
}
