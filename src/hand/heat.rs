//! Temperature limits of a drive. The manual names no limit, only a fault that ends by itself (2.6.3); these limits are ours.

use crate::hand::dof::Dof;
use crate::hand::feedback::sample::HandSample;
use crate::hand::moment::Moment;
use std::fmt;
use std::time::Duration;

/// Temperature from which the user is warned, °C.
pub const WARM: u8 = 60;
/// Temperature from which a moving hand is held, °C.
pub const HOT: u8 = 70;
/// Age beyond which a temperature is unknown.
pub const MAX_AGE: Duration = Duration::from_secs(5);

/// A drive that is warm, or whose temperature is implausible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct DriveHeat {
    /// Joint whose drive it is.
    pub dof: Dof,
    /// Reading, °C: at least [`WARM`], and implausible above 100.
    pub celsius: u8,
}

impl DriveHeat {
    /// Returns the drive with the highest reading, if that reading is fresh and warm or implausible.
    pub fn warmest(sample: &HandSample, now: Moment) -> Option<Self> {
        let read = sample.temperature.filter(|read| read.age(now) <= MAX_AGE)?;
        let all = read.value.iter();
        let all = all.map(|(dof, read)| (dof, read.raw()));
        let (dof, celsius) = all.max_by_key(|(_, celsius)| *celsius)?;
        (celsius >= WARM).then_some(Self { dof, celsius })
    }

    /// True if the drive is too hot to continue, or its reading is implausible.
    pub const fn is_hot(self) -> bool {
        self.celsius >= HOT
    }

    /// True if the temperature is outside the manual's range (2.6.14).
    pub const fn is_implausible(self) -> bool {
        self.celsius > 100
    }
}

impl fmt::Display for DriveHeat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { dof, celsius } = self;
        let dof = dof.name();
        if self.is_implausible() {
            write!(
                f,
                "the temperature of {dof} reads {celsius} °C, which is implausible"
            )
        } else {
            write!(f, "the drive of {dof} is at {celsius} °C")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Group, Reply};

    #[test]
    fn the_warmest_drive_is_told_from_sixty_degrees_on_and_is_hot_from_seventy() {
        let at = Moment::from_micros(1);
        for (celsius, warmest, is_hot) in [
            ([28, 59, 30, 30, 30, 30], None, false),
            ([28, 60, 30, 61, 30, 30], Some((Dof::Index, 61)), false),
            (
                [69, 69, 69, 69, 69, 69],
                Some((Dof::ThumbRotate, 69)),
                false,
            ),
            ([28, 70, 30, 61, 30, 30], Some((Dof::Ring, 70)), true),
            // What the manual does not know is not cool.
            ([30, 101, 30, 70, 30, 30], Some((Dof::Ring, 101)), true),
            ([255, 101, 30, 30, 30, 30], Some((Dof::Little, 255)), true),
        ] {
            let mut sample = HandSample::default();
            sample.apply(&Reply {
                span: Group::Temperature.span(),
                bytes: &celsius,
                asked: at,
                received: at,
            });
            let seen = DriveHeat::warmest(&sample, at);
            let wanted = warmest.map(|(dof, celsius)| DriveHeat { dof, celsius });
            assert_eq!(seen, wanted, "{celsius:?}");
            assert_eq!(seen.is_some_and(DriveHeat::is_hot), is_hot, "{celsius:?}");
            let later = at.plus(MAX_AGE + Duration::from_micros(1));
            assert_eq!(DriveHeat::warmest(&sample, later), None);
        }
    }
}
