//! Stalls of this program's own loop: times when it did not service the wire. Such a time says nothing about the hand.

use crate::hand::Moment;
use crate::link::status::Stall;
use std::collections::VecDeque;
use std::pin::pin;
use std::time::Duration;
use tokio::time::{Instant, sleep_until};

/// A shorter delay is normal scheduler jitter.
pub(crate) const STALL_MIN: Duration = Duration::from_millis(20);
/// Interval at which a pending wait checks that it was woken in time.
const TICK: Duration = Duration::from_millis(10);
/// Stalls kept: more than fit into the longest time that any check looks back on.
const STALLS_MAX: usize = 64;

/// The stalls of one session.
#[derive(Debug, Default)]
pub(crate) struct StallMeter {
    recent: VecDeque<Stall>,
}

impl StallMeter {
    /// Records that the loop was `late` at `now`; returns the stall if it is long enough to count.
    pub(crate) fn late(&mut self, late: Duration, now: Moment) -> Option<Stall> {
        if late < STALL_MIN {
            return None;
        }
        if self.recent.len() == STALLS_MAX {
            self.recent.pop_front();
        }
        let stall = Stall {
            ended: now,
            lasted: late,
        };
        self.recent.push_back(stall);
        Some(stall)
    }

    /// Total stalled time since `then`.
    pub(crate) fn since(&self, then: Moment) -> Duration {
        let parts = self.recent.iter().map(|stall| {
            let passed = stall.ended.since(then);
            passed.min(stall.lasted)
        });
        parts.sum()
    }
}

/// Runs the future, and also returns for how long the loop stalled meanwhile.
pub(crate) async fn watched<T>(work: impl Future<Output = T>) -> (T, Duration) {
    let mut work = pin!(work);
    let mut stalled = Duration::ZERO;
    loop {
        let due = Instant::now() + TICK;
        let done = tokio::select! {
            biased;
            done = &mut work => Some(done),
            () = sleep_until(due) => None,
        };
        let late = Instant::now().saturating_duration_since(due);
        if late >= STALL_MIN {
            stalled += late;
        }
        if let Some(done) = done {
            return (done, stalled);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(millis: u64) -> Duration {
        Duration::from_millis(millis)
    }

    fn at(millis: u64) -> Moment {
        Moment::ZERO.plus(ms(millis))
    }

    #[test]
    fn only_the_part_of_a_stall_after_a_moment_counts_against_it() {
        let mut meter = StallMeter::default();
        assert_eq!(meter.late(STALL_MIN - ms(1), at(100)), None);
        assert!(meter.late(ms(200), at(1000)).is_some());
        meter.late(ms(50), at(1500));
        for (then, stalled) in [(0, 250), (800, 250), (900, 150), (1000, 50), (1600, 0)] {
            assert_eq!(meter.since(at(then)), ms(stalled), "{then}");
        }
    }

    #[tokio::test(start_paused = true)]
    async fn a_wait_that_was_not_woken_in_time_is_a_stall_and_a_long_one_is_none() {
        let (_, stalled) = watched(tokio::time::sleep(ms(500))).await;
        assert_eq!(stalled, Duration::ZERO);
        let busy = async {
            tokio::time::sleep(ms(100)).await;
            tokio::time::advance(ms(300)).await;
            tokio::time::sleep(ms(100)).await;
        };
        let ((), stalled) = watched(busy).await;
        assert!((ms(280)..=ms(300)).contains(&stalled), "{stalled:?}");
    }
}
