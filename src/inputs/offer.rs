//! What a source asks of a hand at a moment, and the way from a source to whoever follows it.

use crate::hand::gap::Gap;
use crate::hand::{Angle, Force, Moment, PerDof, Speed};
use crate::link::ArmRequest;
use std::sync::Arc;
use tokio::sync::mpsc::error::TrySendError;
use tokio::sync::{mpsc, watch};

/// Offers that may wait to be followed: one follows faster than this fills.
const OFFERS_MAX: usize = 64;

/// Where a source wants the joints, each time that it says so. No default: absent is not zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Offer {
    /// When it came in, by the program's clock.
    pub at: Moment,
    /// Where each joint should go; `None` leaves it alone.
    pub aims: PerDof<Option<Angle>>,
    /// A gap between the pads of thumb and index that is wanted: the aims are its angles, and the hand goes there along the path on
    /// which the pads meet.
    pub gap: Option<Gap>,
    /// How fast and how firmly.
    pub limits: OfferLimits,
    /// Whether its dead-man is held; `None` for a source without one.
    pub held: Option<bool>,
    /// The same for targets that are the same to the last bit; `None` for a source that may rightly stand still.
    pub mark: Option<u64>,
}

/// The speeds and force thresholds that a source asks for; `None` keeps what the joint has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OfferLimits {
    /// Force thresholds.
    pub force: PerDof<Option<Force>>,
    pub speed: PerDof<Option<Speed>>,
}

impl OfferLimits {
    /// Asks for none.
    pub const NONE: Self = Self {
        force: PerDof::splat(None),
        speed: PerDof::splat(None),
    };

    /// Whether no joint goes faster or firmer than the user allowed.
    pub fn within(&self, allowed: &ArmRequest) -> bool {
        let mut forces = self.force.iter();
        let mut speeds = self.speed.iter();
        forces.all(|(dof, force)| force.is_none_or(|force| force <= allowed.force[dof]))
            && speeds.all(|(dof, speed)| speed.is_none_or(|speed| speed <= allowed.speed[dof]))
    }

    /// Puts newer ones over older ones, joint by joint.
    pub fn merge(&mut self, newer: &Self) {
        self.force = PerDof::from_fn(|dof| newer.force[dof].or(self.force[dof]));
        self.speed = PerDof::from_fn(|dof| newer.speed[dof].or(self.speed[dof]));
    }
}

/// Where the offers of a source go: to whoever follows it, if anybody does. Copies are the same place.
#[derive(Debug, Clone)]
pub(crate) struct OfferOutlet(Arc<watch::Sender<Option<mpsc::Sender<Offer>>>>);

impl Default for OfferOutlet {
    fn default() -> Self {
        Self(Arc::new(watch::Sender::new(None)))
    }
}

impl OfferOutlet {
    /// All offers from now on; whoever followed before does no more.
    pub(crate) fn follow(&self) -> mpsc::Receiver<Offer> {
        let (offers, followed) = mpsc::channel(OFFERS_MAX);
        self.0.send_replace(Some(offers));
        followed
    }

    /// Gives an offer away; false if nobody follows. A follower that is not fast enough takes the next one.
    pub(crate) fn offer(&self, offer: Offer) -> bool {
        let followed = self.0.borrow();
        followed
            .as_ref()
            .is_some_and(|offers| !matches!(offers.try_send(offer), Err(TrySendError::Closed(_))))
    }
}
