//! How warm a drive may get. The manual names no limit, only a fault that ends by itself (2.6.3); the figures are ours.

use crate::hand::dof::Dof;
use crate::hand::feedback::sample::HandSample;
use crate::hand::moment::Moment;
use std::fmt;
use std::time::Duration;

/// From here on the user is warned, °C.
pub const WARM: u8 = 60;
/// From here on nothing moves the hand that no user watches over, °C.
pub const HOT: u8 = 70;
/// A temperature older than this is unknown.
pub const FRESH_FOR: Duration = Duration::from_secs(5);

/// A drive that is warm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct DriveHeat {
    /// Joint whose drive is warm.
    pub dof: Dof,
    /// °C, at least [`WARM`].
    pub celsius: u8,
}

impl DriveHeat {
    /// The warmest drive, if one is warm by what was read last.
    pub fn warmest(sample: &HandSample, now: Moment) -> Option<Self> {
        let read = sample
            .temperature
            .filter(|read| read.age(now) <= FRESH_FOR)?;
        let known = |dof: Dof| Some((dof, read.value[dof].documented()?));
        let all = Dof::ALL.into_iter().filter_map(known);
        let (dof, celsius) = all.max_by_key(|(_, celsius)| *celsius)?;
        (celsius >= WARM).then_some(Self { dof, celsius })
    }

    /// Whether it is too hot to go on.
    pub const fn is_hot(self) -> bool {
        self.celsius >= HOT
    }
}

impl fmt::Display for DriveHeat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { dof, celsius } = self;
        write!(f, "the drive of {} is at {celsius} °C", dof.name())
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
            // What the manual does not know says nothing.
            ([255, 101, 30, 30, 30, 30], None, false),
        ] {
            let mut sample = HandSample::default();
            sample.take(&Reply {
                span: Group::Temperature.span(),
                bytes: &celsius,
                asked: at,
                received: at,
            });
            let seen = DriveHeat::warmest(&sample, at);
            let wanted = warmest.map(|(dof, celsius)| DriveHeat { dof, celsius });
            assert_eq!(seen, wanted, "{celsius:?}");
            assert_eq!(seen.is_some_and(DriveHeat::is_hot), is_hot, "{celsius:?}");
            let later = at.plus(FRESH_FOR + Duration::from_micros(1));
            assert_eq!(DriveHeat::warmest(&sample, later), None);
        }
    }
}
