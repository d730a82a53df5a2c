//! The program's one clock. Sessions and shells read it; everything else receives moments.

use crate::hand::Moment;
use std::time::Duration;
use tokio::time::Instant;

/// Shorter sleeps are ignored.
const MIN_SLEEP: Duration = Duration::from_secs(1);

/// A clock that never goes back, counted from its start. Copies count from the same start.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    start: Instant,
    asleep: fn() -> Option<Duration>,
    is_virtual: bool,
}

impl Clock {
    /// Starts counting now. Inside a paused tokio runtime this is virtual time.
    pub fn start() -> Self {
        Self::with_sleep(asleep)
    }

    /// The same inside a paused tokio runtime. Threads outside of it, for which this time passes too fast, are awaited.
    pub fn start_virtual() -> Self {
        Self {
            is_virtual: true,
            ..Self::start()
        }
    }

    /// True if it was started by [`Self::start_virtual`].
    pub const fn is_virtual(&self) -> bool {
        self.is_virtual
    }

    /// The same, with its own source for the total sleep time since the computer started; `None` if that is unknown.
    pub fn with_sleep(asleep: fn() -> Option<Duration>) -> Self {
        Self {
            start: Instant::now(),
            asleep,
            is_virtual: false,
        }
    }

    /// The present moment.
    pub fn now(&self) -> Moment {
        Moment::from_duration(self.start.elapsed())
    }

    /// The runtime's instant of a moment, for timers.
    pub fn instant(&self, at: Moment) -> Instant {
        self.start + Duration::from_micros(at.micros())
    }
}

/// Detects that the computer slept: of the system's two unsettable clocks, one continues during sleep and the other
/// does not. A step of the wall clock, by hand or by NTP, does not count as sleep.
#[derive(Debug)]
pub(crate) struct SleepWatch {
    source: fn() -> Option<Duration>,
    asleep: Option<Duration>,
}

impl SleepWatch {
    pub(crate) fn start(clock: Clock) -> Self {
        Self {
            source: clock.asleep,
            asleep: (clock.asleep)(),
        }
    }

    /// Time that the computer slept since the last call; `None` if it did not or the system does not report it.
    pub(crate) fn slept(&mut self) -> Option<Duration> {
        self.slept_at((self.source)())
    }

    fn slept_at(&mut self, asleep: Option<Duration>) -> Option<Duration> {
        let before = std::mem::replace(&mut self.asleep, asleep)?;
        let slept = asleep?.saturating_sub(before);
        (slept > MIN_SLEEP).then_some(slept)
    }
}

/// Total sleep time since the computer started.
#[cfg(target_os = "linux")]
fn asleep() -> Option<Duration> {
    use nix::time::{ClockId, clock_gettime};
    // In this order, time between the two calls does not count as sleep.
    let awake = Duration::from(clock_gettime(ClockId::CLOCK_MONOTONIC).ok()?);
    let all = Duration::from(clock_gettime(ClockId::CLOCK_BOOTTIME).ok()?);
    Some(all.saturating_sub(awake))
}

/// This system has no such pair of clocks: a sleep appears as a stall.
#[cfg(not(target_os = "linux"))]
fn asleep() -> Option<Duration> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_the_clock_that_goes_on_during_sleep_gained_is_sleep() {
        let mut watch = SleepWatch::start(Clock::start());
        let day = Duration::from_secs(86_400);
        watch.asleep = Some(day);
        let drift = Duration::from_millis(3);
        assert_eq!(watch.slept_at(Some(day + drift)), None);
        assert_eq!(watch.slept_at(Some(day * 8)), Some(day * 7 - drift));
        assert_eq!(watch.slept_at(Some(day * 8)), None);
        assert_eq!(watch.slept_at(None), None, "the system does not tell");
        assert_eq!(watch.slept_at(Some(day * 9)), None, "nor did it before");
    }

    #[test]
    fn a_thread_that_stands_still_is_no_sleep() {
        let mut watch = SleepWatch::start(Clock::start());
        std::thread::sleep(MIN_SLEEP + Duration::from_millis(50));
        assert_eq!(watch.slept(), None);
    }
}
