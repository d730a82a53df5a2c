//! The program's one clock. Sessions and shells read it; everything else is given moments.

use crate::hand::Moment;
use std::time::{Duration, SystemTime};
use tokio::time::Instant;

/// A wall clock that runs this much ahead of the monotonic one means that the computer slept.
const SLEPT_AFTER: Duration = Duration::from_secs(1);

/// A clock that never goes back, counted from its start. Copies count from the same start.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    start: Instant,
}

impl Clock {
    /// Starts counting now. Inside a paused tokio runtime this is virtual time.
    pub fn start() -> Self {
        Self {
            start: Instant::now(),
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

/// Notices that the computer slept: the monotonic clock may stand still then, the wall clock does not. It looks at the
/// system's own monotonic clock: virtual time stands still while a picture is drawn, and that is no sleep.
#[derive(Debug)]
pub(crate) struct SleepWatch {
    wall: SystemTime,
    at: std::time::Instant,
}

impl SleepWatch {
    pub(crate) fn start() -> Self {
        Self {
            wall: SystemTime::now(),
            at: std::time::Instant::now(),
        }
    }

    /// How long the computer slept since the last call, if it did. A clock that was set back says nothing.
    pub(crate) fn slept(&mut self) -> Option<Duration> {
        self.slept_at(SystemTime::now(), std::time::Instant::now())
    }

    fn slept_at(&mut self, wall: SystemTime, at: std::time::Instant) -> Option<Duration> {
        let by_wall = wall.duration_since(self.wall).unwrap_or_default();
        let slept = by_wall.saturating_sub(at.saturating_duration_since(self.at));
        *self = Self { wall, at };
        (slept > SLEPT_AFTER).then_some(slept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_wall_clock_that_runs_ahead_means_sleep() {
        let mut watch = SleepWatch::start();
        let (wall, now) = (watch.wall, watch.at);
        let step = Duration::from_millis(20);
        assert_eq!(watch.slept_at(wall + step, now + step), None);
        let week = Duration::from_secs(7 * 86_400);
        let woken = wall + step + week;
        assert_eq!(watch.slept_at(woken, now + step * 2), Some(week - step));
        assert_eq!(watch.slept_at(woken - week, now + step * 3), None);
    }

    #[tokio::test(start_paused = true)]
    async fn virtual_time_that_stands_still_is_no_sleep() {
        let clock = Clock::start();
        let mut watch = SleepWatch::start();
        std::thread::sleep(SLEPT_AFTER + Duration::from_millis(50));
        assert_eq!(clock.now(), Moment::ZERO);
        assert_eq!(watch.slept(), None);
    }
}
