//! Detects drives that are too hot, or whose temperature is unknown, while the hand may move: the one rule for every
//! controller. Pure.

use crate::hand::heat::{HOT, MAX_AGE};
use crate::hand::{Dof, Group, Groups, HandSample, Moment};
use crate::link::lease::Owner;
use crate::record::Disarmed;

/// Consecutive implausible readings that count: one may be a corrupt reply that passed its checksum.
const IMPLAUSIBLE_MAX: u8 = 2;

/// Temperature state of the current arming.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HeatWatch {
    armed_at: Moment,
    /// The local user armed a hand that is not cool, and supervises it, for example to open it. Valid until it is cool.
    accepted: bool,
    /// Consecutive implausible readings.
    implausible: u8,
}

impl HeatWatch {
    /// Starts watching a hand that is armed now by this owner.
    pub(crate) fn arm(&mut self, sample: &HandSample, owner: Option<Owner>, now: Moment) {
        self.armed_at = now;
        // An exhibition opens the hand and rests it, by a stricter rule of its own.
        let may_open = matches!(owner, Some(Owner::Person | Owner::Exhibition));
        self.accepted = may_open && !is_cool(sample, now);
    }

    /// Applies a reading.
    pub(crate) fn apply(&mut self, sample: &HandSample, fresh: Groups, now: Moment) {
        if !fresh.contains(Group::Temperature) {
            return;
        }
        self.implausible = if is_plausible(sample) {
            0
        } else {
            self.implausible.saturating_add(1)
        };
        self.accepted &= !is_cool(sample, now);
    }

    /// Reason why an armed hand must be held now, if any.
    pub(crate) fn reason(&self, sample: &HandSample, now: Moment) -> Option<Disarmed> {
        if self.accepted {
            return None;
        }
        let read = sample.temperature.map(|read| read.received);
        let known_at = read.map_or(self.armed_at, |read| read.max(self.armed_at));
        if now.since(known_at) > MAX_AGE || self.implausible >= IMPLAUSIBLE_MAX {
            return Some(Disarmed::HeatUnknown);
        }
        let plausible = |dof: Dof| sample.temperature?.value[dof].documented();
        let hottest = Dof::ALL.into_iter().filter_map(plausible).max()?;
        (hottest >= HOT).then_some(Disarmed::Hot)
    }
}

fn is_plausible(sample: &HandSample) -> bool {
    let read = sample.temperature.map(|read| read.value);
    read.is_some_and(|read| read.iter().all(|(_, read)| read.documented().is_some()))
}

fn is_cool(sample: &HandSample, now: Moment) -> bool {
    let read = sample.temperature.filter(|read| read.age(now) <= MAX_AGE);
    let is_cool = |celsius: Option<u8>| celsius.is_some_and(|celsius| celsius < HOT);
    read.is_some_and(|read| {
        read.value
            .iter()
            .all(|(_, read)| is_cool(read.documented()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Reply;
    use std::time::Duration;

    fn at(seconds: f64) -> Moment {
        Moment::from_duration(Duration::from_secs_f64(seconds))
    }

    /// A hand that is armed at 1 s, after these temperatures were read from 0.8 s on, five times per second.
    struct Armed {
        watch: HeatWatch,
        sample: HandSample,
        now: Moment,
    }

    impl Armed {
        fn by(owner: Owner, celsius: Option<u8>) -> Self {
            let mut armed = Self {
                watch: HeatWatch::default(),
                sample: HandSample::default(),
                now: at(0.8),
            };
            if let Some(celsius) = celsius {
                armed.reads(celsius);
            }
            armed.now = at(1.0);
            armed.watch.arm(&armed.sample, Some(owner), armed.now);
            armed
        }

        fn reads(&mut self, celsius: u8) -> Option<Disarmed> {
            self.now = self.now.plus(Duration::from_millis(200));
            let fresh = self.sample.apply(&Reply {
                span: Group::Temperature.span(),
                bytes: &[30, 30, celsius, 30, 30, 30],
                asked: self.now,
                received: self.now,
            });
            self.watch.apply(&self.sample, fresh, self.now);
            self.reason()
        }

        fn passes(&mut self, seconds: f64) -> Option<Disarmed> {
            self.now = self.now.plus(Duration::from_secs_f64(seconds));
            self.reason()
        }

        fn reason(&self) -> Option<Disarmed> {
            self.watch.reason(&self.sample, self.now)
        }
    }

    const OWNERS: [Owner; 5] = [
        Owner::Person,
        Owner::Task,
        Owner::Gamepad,
        Owner::Mirror,
        Owner::Exhibition,
    ];

    #[test]
    fn whoever_moves_it_a_hand_that_grows_hot_is_held() {
        for owner in OWNERS {
            for (celsius, first, second) in [
                (69, None, None),
                (70, Some(Disarmed::Hot), Some(Disarmed::Hot)),
                (100, Some(Disarmed::Hot), Some(Disarmed::Hot)),
                (101, None, Some(Disarmed::HeatUnknown)),
                (130, None, Some(Disarmed::HeatUnknown)),
                (255, None, Some(Disarmed::HeatUnknown)),
            ] {
                let mut armed = Armed::by(owner, Some(40));
                let reasons = (armed.reads(celsius), armed.reads(celsius));
                assert_eq!(reasons, (first, second), "{owner:?} at {celsius}");
            }
        }
    }

    #[test]
    fn one_odd_reading_is_none() {
        let mut armed = Armed::by(Owner::Task, Some(40));
        for celsius in [255, 40, 255, 40, 101, 40] {
            assert_eq!(armed.reads(celsius), None);
        }
    }

    #[test]
    fn a_temperature_that_is_not_read_is_not_cool() {
        let limit = MAX_AGE.as_secs_f64();
        for first in [None, Some(40)] {
            let mut armed = Armed::by(Owner::Task, first);
            assert_eq!(armed.passes(limit - 0.1), None, "{first:?}");
            assert_eq!(armed.passes(0.2), Some(Disarmed::HeatUnknown), "{first:?}");
            assert_eq!(armed.reads(40), None, "{first:?}");
        }
    }

    #[test]
    fn only_the_user_and_an_exhibition_move_a_hand_that_is_hot_already() {
        for owner in OWNERS {
            let mut armed = Armed::by(owner, Some(75));
            let may = matches!(owner, Owner::Person | Owner::Exhibition);
            assert_eq!(armed.reason().is_none(), may, "{owner:?}");
            assert_eq!(armed.reads(76).is_none(), may, "{owner:?}");
            assert_eq!(armed.reads(65), None, "{owner:?}");
            // Once cool, the same rule applies to all owners.
            assert_eq!(armed.reads(70), Some(Disarmed::Hot), "{owner:?}");
        }
    }
}
