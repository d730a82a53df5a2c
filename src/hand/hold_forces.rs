//! The two forces between which an object is held.

use crate::hand::units::Force;
use serde::{Deserialize, Serialize};

/// Forces between which an object is held, g of this hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct HoldForces {
    at_least_g: Force,
    at_most_g: Force,
}

/// Two forces between which no hold is possible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "at least {at_least} g and at most {at_most} g leave no room for a hold: choose at least {} g or more, and at most {} to {} g, at least {} g above it",
    HoldForces::LEAST, HoldForces::LEAST + HoldForces::ROOM, HoldForces::MOST, HoldForces::ROOM
)]
pub struct NoRoom {
    /// *At least*, g.
    pub at_least: i16,
    /// *At most*, g.
    pub at_most: i16,
}

impl HoldForces {
    /// Smallest *at least*, g: less is not distinct from the noise of the sensors.
    pub const LEAST: i16 = 40;
    /// Largest *at most*, g: the rated grip.
    pub const MOST: i16 = 2000;
    /// Smallest difference, g: one step of the drive on a hard object is nearly as much.
    pub const ROOM: i16 = 60;

    /// Checks the two forces.
    ///
    /// # Errors
    /// [`NoRoom`].
    pub fn new(at_least: Force, at_most: Force) -> Result<Self, NoRoom> {
        let (least, most) = (at_least.get(), at_most.get());
        if least >= Self::LEAST && most <= Self::MOST && most - least >= Self::ROOM {
            Ok(Self {
                at_least_g: at_least,
                at_most_g: at_most,
            })
        } else {
            Err(NoRoom {
                at_least: least,
                at_most: most,
            })
        }
    }

    /// The nearest two forces that leave room for a hold.
    pub fn nearest(at_least: Force, at_most: Force) -> Self {
        let least = at_least.get().clamp(Self::LEAST, Self::MOST - Self::ROOM);
        let most = at_most.get().clamp(least + Self::ROOM, Self::MOST);
        Self {
            at_least_g: Force::nearest(least),
            at_most_g: Force::nearest(most),
        }
    }

    /// The same with at most this force, if that leaves room for a hold; *at least* gives way.
    #[must_use]
    pub fn limited(self, most: Force) -> Self {
        let most = self.at_most_g.get().min(most.get());
        let least = self.at_least_g.get().min(most - Self::ROOM);
        Self::nearest(Force::nearest(least), Force::nearest(most))
    }

    /// Force that each finger presses with at least.
    pub const fn at_least(self) -> Force {
        self.at_least_g
    }

    /// Force that no finger exceeds.
    pub const fn at_most(self) -> Force {
        self.at_most_g
    }
}

/// The two forces as a file has them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked {
    at_least_g: Force,
    at_most_g: Force,
}

impl TryFrom<Unchecked> for HoldForces {
    type Error = NoRoom;
    fn try_from(both: Unchecked) -> Result<Self, NoRoom> {
        Self::new(both.at_least_g, both.at_most_g)
    }
}
