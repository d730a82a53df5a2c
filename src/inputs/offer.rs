//! Targets that a source offers to a hand, and the channel from a source to its follower.

use crate::hand::gap::Gap;
use crate::hand::hold_forces::HoldForces;
use crate::hand::kinematics::Side;
use crate::hand::{Angle, Force, Moment, PerDof, Speed};
use crate::link::{ArmRequest, Clock, LinkHandle, Wake};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc::error::TrySendError;
use tokio::sync::{mpsc, watch};

/// A source that sends nothing new for this long is silent, and the hand holds …
pub const HOLD_TIMEOUT: Duration = Duration::from_millis(200);
/// … and after this time it loses control of the hand.
pub const END_TIMEOUT: Duration = Duration::from_secs(1);
/// Capacity of the queue: a follower is faster than a source can fill it.
const OFFERS_MAX: usize = 64;

/// What a source needs of the program that opens it.
#[derive(Clone)]
pub struct SourceSite {
    /// Side of the hand to which its messages are addressed.
    pub side: Side,
    /// The program's clock.
    pub clock: Clock,
    /// Stops the hand. Called for each message that requests it, from any sender, whether granted control or not.
    pub stop: Arc<dyn Fn() + Send + Sync>,
    /// Called when the view of the source changed. Must return at once.
    pub wake: Wake,
}

impl SourceSite {
    /// For a source whose messages are addressed to the hand of this link.
    pub fn of(link: &LinkHandle, side: Side, wake: Wake) -> Self {
        let stops = link.clone();
        Self {
            side,
            clock: link.clock(),
            stop: Arc::new(move || drop(stops.stop())),
            wake,
        }
    }
}

/// True if the source heard at `last` is not silent at `now`.
pub(crate) fn is_fresh(last: Moment, now: Moment) -> bool {
    now.since(last) < HOLD_TIMEOUT
}

/// Targets of a source at one time. No default: absent is not zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Offer {
    /// Receive time, by the program's clock.
    pub at: Moment,
    /// Target of each joint; `None` leaves the joint alone.
    pub aims: PerDof<Option<Angle>>,
    /// Target gap between the pads of thumb and index: the aims are its angles, and the hand moves there along the path on
    /// which the pads meet.
    pub gap: Option<Gap>,
    /// Forces of a hold: with targets the hand closes to them until an object stops it, without it takes over what it holds.
    pub hold: Option<HoldForces>,
    /// Requested speeds and forces.
    pub limits: OfferLimits,
    /// True while the dead-man is held; `None` for a source without one.
    pub held: Option<bool>,
    /// Equal for bitwise equal targets; `None` for a source that may legitimately repeat the same target.
    pub mark: Option<u64>,
}

/// Speeds and force thresholds requested by a source; `None` leaves the joint's value unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OfferLimits {
    /// Force thresholds.
    pub force: PerDof<Option<Force>>,
    pub speed: PerDof<Option<Speed>>,
}

impl OfferLimits {
    /// No limits.
    pub const NONE: Self = Self {
        force: PerDof::splat(None),
        speed: PerDof::splat(None),
    };

    /// True if no joint exceeds the speeds and forces that the user allowed.
    pub fn within(&self, allowed: &ArmRequest) -> bool {
        let mut forces = self.force.iter();
        let mut speeds = self.speed.iter();
        forces.all(|(dof, force)| force.is_none_or(|force| force <= allowed.force[dof]))
            && speeds.all(|(dof, speed)| speed.is_none_or(|speed| speed <= allowed.speed[dof]))
    }

    /// Overwrites with newer values, joint by joint.
    pub fn merge(&mut self, newer: &Self) {
        self.force = PerDof::from_fn(|dof| newer.force[dof].or(self.force[dof]));
        self.speed = PerDof::from_fn(|dof| newer.speed[dof].or(self.speed[dof]));
    }
}

/// Output of a source: delivers offers to the current follower, if there is one. Clones share the same follower.
#[derive(Debug, Clone)]
pub(crate) struct OfferOutlet(Arc<watch::Sender<Option<mpsc::Sender<Offer>>>>);

impl Default for OfferOutlet {
    fn default() -> Self {
        Self(Arc::new(watch::Sender::new(None)))
    }
}

impl OfferOutlet {
    /// Returns a receiver for all offers from now on; it replaces the previous follower.
    pub(crate) fn follow(&self) -> mpsc::Receiver<Offer> {
        let (offers, followed) = mpsc::channel(OFFERS_MAX);
        self.0.send_replace(Some(offers));
        followed
    }

    /// Delivers an offer; false if there is no follower. An offer is dropped if the follower's queue is full.
    pub(crate) fn offer(&self, offer: Offer) -> bool {
        let followed = self.0.borrow();
        followed
            .as_ref()
            .is_some_and(|offers| !matches!(offers.try_send(offer), Err(TrySendError::Closed(_))))
    }
}
